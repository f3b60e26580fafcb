//! How long a spall is, from the time between the events at its edges and what the element is pressed
//! together (THEORY §7.9).

use std::f64::consts::PI;

use stribeck_dsp::{EventSpacing, event_spacing};
use stribeck_scene::catalogue::CatalogueBearing;

use super::pressed::Loading;
use super::{Defect, Family, Interval, Machine};
use crate::Error;

/// Events closer than this cannot be distinguished from the ringing of one [s].
const SHORTEST_S: f64 = 0.4e-3;
/// Longest spall over the distance of two rolling elements: with a longer one the next element enters before
/// one leaves.
const LONGEST: f64 = 0.45;
/// A second event that is missed is nearer to the first than this part of what would have shown.
const MISSED: f64 = 2.0;

/// The length [mm], or none; and a note on its limits.
pub(super) fn estimate(
    samples: &[f64],
    rate_hz: f64,
    machine: &Machine,
    families: &[Family],
) -> Result<(Option<Interval>, Option<String>), Error> {
    let claimed = families.iter().filter(|f| f.claimed).collect::<Vec<_>>();
    let ([family], Some(bearing)) = (claimed.as_slice(), &machine.bearing) else {
        let why = if claimed.is_empty() { "no defect is claimed" } else { "more than one defect is claimed" };
        return Ok((None, Some(format!("no length of a spall: {why}"))));
    };
    let Some(passing_hz) = family.measured_hz.filter(|_| matches!(family.name, Defect::Bpfo | Defect::Bpfi))
    else {
        return Ok((None, Some("no length of a spall: it is estimated on raceways only".to_owned())));
    };
    let speed = contact_speed_mm_s(bearing, family.name, passing_hz);
    if samples.iter().any(|x| !x.is_finite()) {
        return Ok((None, Some("no length of a spall: the first samples are not all numbers".to_owned())));
    }
    let found = event_spacing(samples, rate_hz, SHORTEST_S, LONGEST / passing_hz);
    let apart = speed / passing_hz;
    Ok(match found {
        Ok(EventSpacing::Pairs(spacing)) => {
            let run = speed * spacing.lag_s;
            let (loading, is_given) = Loading::of(bearing, machine.load_n, machine.clearance_um);
            let (pressed, least, most) = loading.pressed_mm(bearing, family.name);
            let advice =
                if is_given { "" } else { "; `--load-n` with a narrower range narrows the interval" };
            let why = format!(
                "the length of the spall is the {run:.2} mm that the contact runs between two events and the \
                 {pressed:.2} mm ({least:.2} to {most:.2}) over which a bearing loaded by {:.0} to {:.0} N \
                 in a rigid housing presses the element together{advice}. It holds for a spall shorter than \
                 half of the {apart:.1} mm between two elements: one of {:.1} mm, whose exit and the entry \
                 of the next element are as far apart, would knock in the same rhythm",
                loading.load_n.0,
                loading.load_n.1,
                apart - run + pressed
            );
            let length = Interval { value: run + pressed, low: run + least, high: run + most };
            (Some(length), Some(why))
        }
        Ok(EventSpacing::Alone { clear_from_s }) => {
            let both = MISSED * speed * clear_from_s;
            let why = format!(
                "no second event follows each knock: if entry and exit both knock, the spall is shorter than \
                 {both:.2} mm, and the value given is \
                 the middle of that. One that is shallow, or crossed under so heavy a load that no element \
                 comes free, or whose entry is \
                 soft, knocks once whatever its length, and the record does not say which: so the interval \
                 leaves all lengths up to the \
                 {apart:.1} mm between two elements, and takes it that the spall is no longer than that"
            );
            (Some(Interval { value: 0.5 * both, low: 0.0, high: apart.max(both) }), Some(why))
        }
        Ok(EventSpacing::Unknown) => {
            let why = "no length of a spall: the record is too noisy, or rings too long, to tell a second \
                event after each knock";
            (None, Some(why.to_owned()))
        }
        Err(why) => (None, Some(format!("no length of a spall: {why}"))),
    })
}

/// Speed of the contact along the damaged raceway [mm/s].
fn contact_speed_mm_s(bearing: &CatalogueBearing, family: Defect, passing_hz: f64) -> f64 {
    let elements = f64::from(bearing.elements.unwrap_or(1));
    let across = bearing.diameter_mm * bearing.angle_deg.to_radians().cos();
    let diameter = if family == Defect::Bpfo { bearing.pitch_mm + across } else { bearing.pitch_mm - across };
    PI * diameter * passing_hz / elements
}
