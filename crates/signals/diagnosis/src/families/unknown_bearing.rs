//! What strikes in a record whose bearing nobody named, and how many rolling elements would make it.

use stribeck_dsp::{BandEnvelope, CombTest, Whitened};

use crate::families::machine_lines::OwnLines;
use crate::families::unexplained::{self, NAMED};

/// Turns of a cage over those of the shaft, where elements are 0.08 to 0.28 of their pitch circle (own).
const CAGE: [f64; 2] = [0.36, 0.46];
/// Highest family over the shaft that is looked for: BPFI of 24 elements.
const HIGHEST: f64 = 14.0;
/// Part by which a whole number of elements may be missed.
const WHOLE: f64 = 0.02;

/// The comb that strikes highest, as a raceway's of a bearing with so many elements, and how many they are where
/// the cage stands, too; `None` where nothing strikes but the machine's own lines.
pub(crate) fn sentence(bands: &[(&BandEnvelope, Whitened)], own: &OwnLines) -> Option<String> {
    let shaft_hz = own.shaft_hz;
    let combs = unexplained::of_each_band(bands, own, f64::NAN, HIGHEST * shaft_hz, &[], &|_| false);
    let highest = combs.iter().max_by(|a, b| a.comb.height.total_cmp(&b.comb.height))?;
    let standing = bands.iter().filter_map(|(_, spectrum)| {
        let [least, most] = CAGE.map(|order| order * shaft_hz);
        CombTest::FOUR_OF_FIVE.search(spectrum, least, most).ok()
    });
    let cage = standing.max_by(|a, b| a.height.total_cmp(&b.height));
    let cage = cage.filter(|comb| comb.p_value * (bands.len() as f64) < NAMED);
    // Every second or third line of a comb may stand higher than the others.
    let (_, spectrum) = &bands[highest.band];
    let parts = [2.0, 3.0, 4.0].map(|part| highest.comb.fundamental_hz / part);
    let whole = parts.iter().filter(|hz| !own.holds(**hz)).filter_map(|hz| {
        let near = CombTest::FOUR_OF_FIVE.search(spectrum, hz - spectrum.grid_hz(), hz + spectrum.grid_hz());
        near.ok().filter(|comb| comb.p_value < NAMED)
    });
    let whole = whole.max_by(|a, b| a.height.total_cmp(&b.height));
    let hz = whole.map_or(highest.comb.fundamental_hz, |comb| comb.fundamental_hz);
    let order = hz / shaft_hz;
    let fitting = bearings(order, cage.map(|comb| comb.fundamental_hz / shaft_hz));
    Some(format!("Something strikes at {hz:.2} Hz, {order:.3} times the shaft: {fitting}"))
}

/// The bearings whose raceway passes so often in a turn of the shaft; `cage` has the turns of the cage.
fn bearings(order: f64, cage: Option<f64>) -> String {
    let [least, most] = CAGE;
    let of = |name: &str, [least, most]: [f64; 2], cage: Option<f64>| {
        let (from, to) = ((order / most).ceil() as u32, (order / least).floor() as u32);
        let whole = |times: f64| ((order / times).round() / (order / times) - 1.0).abs() < WHOLE;
        match cage {
            Some(times) if whole(times) => Some(format!("{name} of a bearing of {:.0}", order / times)),
            Some(_) => None,
            None if from < to => Some(format!("{name} of a bearing of {from} to {to}")),
            None if from == to => Some(format!("{name} of a bearing of {from}")),
            None => None,
        }
    };
    let outer = of("BPFO", [least, most], cage);
    let inner = of("BPFI", [1.0 - most, 1.0 - least], cage.map(|cage| 1.0 - cage));
    let found: Vec<String> = [outer, inner].into_iter().flatten().collect();
    let by_cage = cage.map_or(String::new(), |cage| format!(", whose cage turns {cage:.3} times"));
    match found.is_empty() {
        true => "no usual bearing makes it".to_owned(),
        false => format!("{} rolling elements{by_cage}", found.join(", or ")),
    }
}

#[cfg(test)]
mod tests {
    use super::bearings;

    /// A 6203: 8 balls, BPFO 3.053, BPFI 4.947, FTF 0.382.
    #[test]
    fn by_hand_orders_of_a_6203_are_those_of_eight_elements() {
        assert_eq!(
            bearings(3.053, None),
            "BPFO of a bearing of 7 to 8, or BPFI of a bearing of 5 rolling elements"
        );
        let outer = bearings(3.053, Some(0.382));
        assert!(outer.starts_with("BPFO of a bearing of 8") && outer.contains("cage turns 0.382"), "{outer}");
        assert!(bearings(4.947, Some(0.382)).contains("BPFI of a bearing of 8 rolling"));
        assert_eq!(bearings(1.3, Some(0.382)), "no usual bearing makes it");
    }
}
