//! Structs that describe the axes of a signal beside its values, as Simcenter Testlab exports them:
//! `x_values.increment` with its unit in `x_values.quantity.label`, and the unit of the values in
//! `y_values.quantity.label`.

use crate::units::{rounded, seconds};
use crate::{Channel, Result};

/// Names of the struct of the first axis, and of its members.
const AXIS: &str = "x_values";
const STEP: &str = "increment";
const START: &str = "start_value";
/// Where a struct of an axis has its unit.
const UNIT: &str = "quantity.label";

/// Gives rate, start and unit to the channels of each struct that has them beside its values; `texts` are all texts of
/// the file by their names. An axis that is no time gives no rate: spectra have the same structs.
pub(crate) fn told(channels: &mut [Channel], texts: &[(String, String)]) -> Result<()> {
    let unit_of = |of: &str| {
        let name = format!("{of}.{UNIT}");
        texts.iter().find(|(text, _)| *text == name).map(|(_, unit)| unit.as_str())
    };
    let number = |name: &str| -> Result<Option<f64>> {
        let found = channels.iter().find(|c| c.len == 1 && c.name == name);
        Ok(found.map(Channel::read).transpose()?.and_then(|all| all.first().copied()))
    };
    let mut axes = Vec::new();
    for step in channels.iter().filter(|c| c.len == 1) {
        let Some(axis) = step.name.strip_suffix(STEP).and_then(|name| name.strip_suffix('.')) else {
            continue;
        };
        let Some(parent) = axis.strip_suffix(AXIS) else { continue };
        let Some((_, second)) = unit_of(axis).and_then(seconds) else { continue };
        let step_s = number(&step.name)?.filter(|step| *step > 0.0).map(|step| second * step);
        let start_s = number(&format!("{axis}.{START}"))?.map(|start| second * start);
        axes.extend(step_s.map(|step_s| (parent.to_owned(), rounded(1.0 / step_s), start_s)));
    }
    for channel in channels.iter_mut().filter(|c| c.len > 1) {
        let own = axes.iter().filter(|(parent, ..)| channel.name.starts_with(parent.as_str()));
        if let Some((_, rate_hz, start_s)) = own.max_by_key(|(parent, ..)| parent.len()) {
            (channel.rate_hz, channel.start_s) = (Some(*rate_hz), *start_s);
            let of = channel.name.rsplit_once('.').map_or("", |(of, _)| of);
            channel.unit = channel.unit.take().or(unit_of(of).map(str::to_owned));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_hand_a_struct_of_an_axis_of_time_says_rate_start_and_unit() {
        let of = |axis_unit: &str| {
            let one = |name: &str, value: f64| Channel::held(name, vec![value]);
            let mut channels = vec![
                one("Signal.x_values.start_value", 20.0),
                one("Signal.x_values.increment", 0.0390625),
                Channel::held("Signal.y_values.values(:,1)", vec![1.0, 2.0, 3.0]),
                Channel::held("other", vec![1.0, 2.0, 3.0]),
            ];
            let text = |name: &str, text: &str| (name.to_owned(), text.to_owned());
            let texts = [
                text("Signal.x_values.quantity.label", axis_unit),
                text("Signal.y_values.quantity.label", "g"),
            ];
            told(&mut channels, &texts).unwrap();
            (channels[2].rate_hz, channels[2].start_s, channels[2].unit.clone(), channels[3].rate_hz)
        };
        assert_eq!(of("ms"), (Some(25_600.0), Some(0.02), Some("g".to_owned()), None));
        assert_eq!(of("Hz"), (None, None, None, None), "the axis of a spectrum");
    }
}
