//! The verdict in words.

use crate::Defect;
use crate::conclusion::{Conclusion, Doubt, Open, open};
use crate::families::family::Family;
use crate::families::limits::IMPACT;
use crate::families::power::Limit;
use crate::families::unexplained::Unexplained;
use crate::families::unrelated::SLIP;
use crate::words::numbers::significant;

/// A frequency beside that of rolling without slip, in words.
fn beside(hz: f64, without_slip_hz: f64) -> String {
    let off = 100.0 * (hz / without_slip_hz - 1.0);
    match off.abs() {
        percent if percent < 0.05 => "as rolling without slip has it".to_owned(),
        percent => {
            let side = if off > 0.0 { "above" } else { "below" };
            format!("{percent:.1} % {side} that of rolling without slip")
        }
    }
}

/// Whether a comb may be that of a family, or its second or third harmonic.
fn may_be_of(family: &Family, hz: f64) -> bool {
    let comb_hz = family.name.shocks_per_period() * family.expected_hz;
    let times = (hz / comb_hz).round();
    (1.0..=3.0).contains(&times) && (hz / (times * comb_hz) - 1.0).abs() < SLIP
}

/// What the verdict in words takes beside families.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Told<'a> {
    pub(crate) doubt: Option<Doubt>,
    pub(crate) conclusion: &'a Conclusion,
    /// Unit of the channel.
    pub(crate) unit: Option<&'a str>,
    /// Speed of the shaft [1/min], and samples a second.
    pub(crate) speed_rpm: f64,
    pub(crate) rate_hz: f64,
}

#[cfg(test)]
impl<'a> Told<'a> {
    /// Of a conclusion at 1500 rpm.
    pub(crate) fn of(conclusion: &'a Conclusion) -> Self {
        Self { doubt: None, conclusion, unit: None, speed_rpm: 1500.0, rate_hz: 12_800.0 }
    }
}

/// The length of a counter or a buffer [samples], a power of two, of which this is one but for chance.
fn block(samples: f64) -> Option<f64> {
    const NEAR: f64 = 5e-4;
    let whole = samples.log2().round().exp2();
    ((16.0..=65_536.0).contains(&whole) && (samples / whole - 1.0).abs() < NEAR).then_some(whole)
}

/// Farthest that a speed, or a rate, is off in such a hypothesis, as a part of it.
const OFF: f64 = 0.07;

/// The raceway whose place is beside a comb, and the speed or the rate at which it would be there.
fn hypothesis(families: &[Family], hz: f64, told: Told<'_>) -> Option<String> {
    let raceways = families.iter().filter(|f| matches!(f.name, Defect::Bpfo | Defect::Bpfi));
    let off = |f: &&Family| (hz / f.expected_hz - 1.0).abs();
    let nearest = raceways.min_by(|a, b| off(a).total_cmp(&off(b))).filter(|f| off(f) < OFF)?;
    let times = hz / nearest.expected_hz;
    Some(format!(
        "{} is {:.1} % away: it is {}, if the speed is {:.0} rpm or the rate {:.0} Hz",
        nearest.name,
        100.0 * (times - 1.0).abs(),
        nearest.name.part(),
        times * told.speed_rpm,
        told.rate_hz / times
    ))
}

/// The verdict in words.
pub(crate) fn conclude(families: &[Family], unexplained: Option<&Unexplained>, told: Told<'_>) -> String {
    let Told { doubt, conclusion, unit, .. } = told;
    // Two families that cannot be distinguished are reported under the name of the first.
    let spoken_for = |at: usize, family: &Family| {
        families[..at].iter().any(|f| f.claimed && f.not_told_apart_from == Some(family.name))
    };
    let claimed: Vec<String> = families
        .iter()
        .enumerate()
        .filter(|(at, f)| f.claimed && !spoken_for(*at, f))
        .map(|(_, f)| {
            let hz = f.measured_hz.unwrap_or(f.expected_hz);
            let beside = beside(hz, f.expected_hz);
            let other = families.iter().find(|other| f.not_told_apart_from == Some(other.name));
            match other {
                Some(_) if f.name == Defect::Ftf => format!(
                    "a defect of the cage or of one rolling element, which the record cannot distinguish \
                     (something strikes once a turn of the cage, {} at {hz:.2} Hz, {beside})",
                    f.name
                ),
                None => format!("a defect of {} ({} at {hz:.2} Hz, {beside})", f.name.part(), f.name),
                Some(other) => format!(
                    "a defect of {} or of {}, which the record cannot distinguish ({} at {hz:.2} Hz, \
                     {beside}, and {} times {} stand within a resolution)",
                    f.name.part(),
                    other.name.part(),
                    f.name,
                    other.name.shocks_per_period() / f.name.shocks_per_period(),
                    other.name
                ),
            }
        })
        .collect();
    if !claimed.is_empty() {
        return format!("The record shows {}.", claimed.join(" and "));
    }
    if let Some(other) = unexplained {
        if let Some(hidden) = families.iter().find(|f| f.undecided && may_be_of(f, other.hz)) {
            return format!(
                "No bearing defect claimed: the record has impacts at {:.2} Hz, {:.3} times the shaft, where {} lies beside one \
                 of the machine's own lines: a measured speed or a longer record would tell them apart.",
                other.hz, other.order, hidden.name
            );
        }
        let at = format!(
            "No bearing defect claimed: the record has impacts at {:.2} Hz, {:.3} times the shaft",
            other.hz, other.order
        );
        return match hypothesis(families, other.hz, told) {
            Some(words) => format!("{at}. {words}; a measured speed would tell."),
            None if let Some(samples) = block(told.rate_hz / other.hz) => format!(
                "{at}, once every {samples} samples, which is no family of this bearing: a counter or a buffer of the \
                 recorder has such a length. Look at the samples there."
            ),
            None => format!(
                "{at}, which is no family of this bearing: another part of the machine has them, its converter or \
                 another bearing, or speed or bearing is not what was given. Records of the healthy machine \
                 (`--baseline`) set aside what stands in them, too."
            ),
        };
    }
    let highest =
        families.iter().filter(|f| f.has_impacts()).max_by(|a, b| a.height_db.total_cmp(&b.height_db));
    if let Some(highest) = highest {
        return format!(
            "The record has impacts, and does not show where: {} stands highest, but combs at other spacings \
             stand as high. A longer record, or one nearer to the bearing, may tell.",
            highest.name
        );
    }
    if families.iter().all(|f| f.band_hz.is_none()) {
        // What one raceway lacks the other does, too.
        let why =
            families.first().map_or(String::new(), |family| format!("; {}: {}", family.name, family.reason));
        return format!(
            "The record cannot tell whether there is a defect: it is too short, or sampled too slowly, for every \
             family{why}."
        );
    }
    match open(families, unexplained, doubt).first() {
        None => no_defect(conclusion, unit),
        Some(open) => format!("The record cannot tell whether a raceway is damaged: {}.", why(open, unit)),
    }
}

/// "No defect", with the impacts that would have been claimed and what the method misses.
pub(crate) fn no_defect(conclusion: &Conclusion, unit: Option<&str>) -> String {
    let one_in = conclusion.elements.share.map_or(f64::NAN, |share| (1.0 / share).round());
    let exceed = match (conclusion.raceways.limit, conclusion.raceways.limit_band_hz) {
        (Some(peak), Some(band_hz)) => format!(" whose impacts exceed {}", strength(peak, band_hz, unit)),
        _ => String::new(),
    };
    format!("No defect of a raceway{exceed}; of damaged rolling elements this method finds one in {one_in}.")
}

/// A peak and its band.
pub(crate) fn strength(peak: f64, (low_hz, high_hz): (f64, f64), unit: Option<&str>) -> String {
    let [low, high] = [low_hz, high_hz].map(|hz| significant(1e-3 * hz, 2));
    format!("{} {} (peak, {low} to {high} kHz)", significant(peak, 2), unit.unwrap_or("of its unit"))
}

/// Why the record cannot tell, and what would.
fn why(open: &Open<'_>, unit: Option<&str>) -> String {
    match *open {
        Open::Doubt(Doubt::Samples) => "its samples are spoilt".to_owned(),
        Open::Doubt(Doubt::SoughtSpeed) => {
            "its speed was sought in the record, and at a wrong speed no defect \
            shows; a measured speed would tell"
                .to_owned()
        }
        Open::Doubt(Doubt::Short) => {
            "it holds too few turns of the shaft; a longer record, or a series of them, \
            would tell"
                .to_owned()
        }
        Open::Impacts => "something else has impacts that are stronger".to_owned(),
        Open::NotLookedFor(family) if family.undecided => {
            format!("it does not decide about {}, {}", family.name, family.reason)
        }
        Open::NotLookedFor(family) => format!("{} was not looked for, {}", family.name, family.reason),
        Open::Near(family) => format!(
            "{} stands {:.0} dB above combs at other spacings, and the power of its band varies by {:.0} % of its mean; \
             {:.0} % would be a defect. Records of the healthy machine (`--baseline`), more load or the trend would tell",
            family.name,
            family.above_unrelated_db().unwrap_or(0.0),
            100.0 * family.depth.unwrap_or(0.0),
            100.0 * IMPACT
        ),
        Open::Weak(Some(Limit { peak, over_rms, band_hz })) => format!(
            "impacts below {}, {} times its RMS, would not show, and those of spalls are weaker; a longer record, one \
             nearer to the bearing or records of the healthy machine (`--baseline`) would tell",
            strength(peak, band_hz, unit),
            significant(over_rms, 2)
        ),
        Open::Weak(None) => {
            "no band could show its impacts; a longer record, or one sampled faster, would tell".to_owned()
        }
    }
}

pub(crate) fn probability(p: f64) -> String {
    if p >= 0.95 {
        "nearly 1".to_owned()
    } else if p >= 0.1 {
        format!("{p:.1}")
    } else {
        format!("{p:.3}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ball of a 6203 impacts 3.99 times a turn of the shaft: the record was said to impact at no frequency of the
    /// bearing.
    #[test]
    fn issue_impacts_beside_a_multiple_of_the_shaft_are_not_those_of_no_family() {
        let bsf = Family { undecided: true, ..Family::expected(Defect::Bsf, 49.861) };
        let says = |family: &Family, hz: f64| {
            let other = Unexplained { hz, order: hz / 25.0, height_db: 20.0, band_hz: (1e3, 2e3) };
            conclude(std::slice::from_ref(family), Some(&other), Told::of(&Conclusion::default()))
        };
        assert!(says(&bsf, 99.47).contains("where BSF lies beside one of the machine's own lines"));
        assert!(says(&bsf, 90.0).contains("no family of this bearing"));
        assert!(says(&Family::expected(Defect::Bsf, 49.861), 99.47).contains("no family of this bearing"));
        // At 12 800 samples a second.
        assert!(
            says(&bsf, 200.02).contains("once every 64 samples") && !says(&bsf, 201.0).contains("every 64")
        );
    }
}
