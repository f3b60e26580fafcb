//! What stands under a verdict: its probability, the length of the spall, and the impacts that the record would have
//! shown.

use crate::MeasuredFindings;
use crate::families::power::Limit;
use crate::words::numbers::{chance, significant};

/// The lines under the verdict; none where no family was looked for.
pub fn beneath(findings: &MeasuredFindings) -> Vec<String> {
    let claimed: Vec<_> = findings.families.iter().filter(|f| f.claimed).collect();
    let looked = findings.families.iter().filter(|f| f.rank.is_some());
    let nearest = looked.min_by(|a, b| a.p_value.total_cmp(&b.p_value)).filter(|_| claimed.is_empty());
    let mut lines: Vec<String> = claimed
        .iter()
        .map(|f| {
            format!("{}: a healthy bearing shows as much with a probability of {}", f.name, chance(f.p_value))
        })
        .collect();
    lines.extend(nearest.map(|f| format!("nearest to a claim: {}, false alarm {}", f.name, f.false_alarm())));
    if !claimed.is_empty() {
        lines.push(match findings.spall_mm {
            Some(spall) => format!(
                "length of the spall: {:.2} mm, 90 % between {:.2} and {:.2} mm",
                spall.value, spall.low, spall.high
            ),
            None => "length of the spall: not determined".to_owned(),
        });
    }
    let unit = findings.unit.as_deref();
    let limits = findings.families.iter().filter_map(|f| Some((f.name.shocks_name(), f.limit?)));
    let limits: Vec<String> =
        limits.map(|(name, limit)| format!("{name} {}", in_words(limit, unit))).collect();
    if !limits.is_empty() {
        lines
            .push(format!("impacts that the record would have shown, from a peak of: {}", limits.join("; ")));
    }
    lines
}

/// A limit with its band; without a unit over the root mean square alone.
fn in_words(Limit { peak, over_rms, band_hz: (low_hz, high_hz) }: Limit, unit: Option<&str>) -> String {
    let [low, high] = [low_hz, high_hz].map(|hz| significant(1e-3 * hz, 2));
    let peak = unit.map_or(String::new(), |unit| format!("{} {unit}, ", significant(peak, 2)));
    format!("{peak}{} times the RMS ({low} to {high} kHz)", significant(over_rms, 2))
}
