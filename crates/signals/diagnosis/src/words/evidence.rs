//! The evidence for a verdict: the mean over a period of the impacts, and the changes that would reverse it.

use stribeck_dsp::Envelope;

use crate::Error;
use crate::families::controls::MOST_AS_HIGH;
use crate::families::limits::{ALPHA, IMPACT};
use crate::families::unrelated::unrelated_hz;
use crate::words::numbers::chance;
use crate::{Analysis, Family, MeasuredFindings};

/// Steps of a period, at most.
const STEPS: usize = 72;
/// Least samples of a step.
const SAMPLES_A_STEP: f64 = 2.0;
/// Periods of a mean, at least.
const LEAST_PERIODS: f64 = 10.0;
/// Rates that are tried, over two resolutions of the samples about the one that was measured.
const RATES: usize = 41;
/// A speed that is wrong by more than this factor is not worth a word.
const FAR: f64 = 2.0;
/// Which of the unrelated rates is the control: well above the measured one.
const ABOVE: f64 = 1.2;

/// Power of a band over one period, averaged over many.
#[derive(Debug, Clone, PartialEq)]
pub struct SynchronousMean {
    /// Rate of the period, of those within a resolution the one whose mean swings most [Hz].
    pub hz: f64,
    /// Power at each step of the period over its mean; the highest is a quarter behind the beginning.
    pub power: Vec<f64>,
    /// Periods averaged.
    pub periods: usize,
}

/// The mean over the period of a family's impacts, and that over an unrelated period, sought and turned in the
/// same way, which shows the contribution of the search alone. From the beginning of the record, in the band
/// in which the family stands highest. `None` for a family without a band, a record too short, or a rate too
/// low.
///
/// # Errors
/// [`Error::Signal`] when the envelope cannot be made.
pub fn synchronous(
    analysis: &Analysis,
    family: &Family,
) -> Result<Option<(SynchronousMean, SynchronousMean)>, Error> {
    let Some((low_hz, high_hz)) = family.band_hz else { return Ok(None) };
    let (rate_hz, signal) = (analysis.findings.rate_hz, &analysis.beginning);
    let hz = family.name.shocks_per_period() * family.measured_hz.unwrap_or(family.expected_hz);
    // Lengths of few small factors are quick to transform.
    let len = if signal.is_empty() { 0 } else { 1 << signal.len().ilog2() };
    if hz.is_nan() || hz <= 0.0 || len as f64 / rate_hz * hz < LEAST_PERIODS {
        return Ok(None);
    }
    let mut power = vec![0.0; len];
    let mut planned = Envelope::in_band(rate_hz, len, low_hz, high_hz).map_err(Error::Signal)?;
    planned.process(&signal[..len], &mut power).map_err(Error::Signal)?;
    power.iter_mut().for_each(|a| *a *= *a);
    let control_hz = unrelated_hz(hz).find(|other| *other > ABOVE * hz);
    let means =
        control_hz.and_then(|other| Some((mean(&power, rate_hz, hz)?, mean(&power, rate_hz, other)?)));
    Ok(means)
}

/// The mean of `power` over the period that makes it swing most, within a resolution about `hz`.
fn mean(power: &[f64], rate_hz: f64, hz: f64) -> Option<SynchronousMean> {
    let steps = ((rate_hz / hz / SAMPLES_A_STEP) as usize).min(STEPS);
    let all = power.iter().sum::<f64>() / power.len() as f64;
    if steps < 4 || all <= 0.0 {
        return None;
    }
    let resolution_hz = rate_hz / power.len() as f64;
    let tried = (0..RATES).map(|n| hz + resolution_hz * (2.0 * n as f64 / (RATES - 1) as f64 - 1.0));
    let over = |hz: f64| {
        // A sample counts for both steps beside it, the more the nearer: whole ones, a few a step in a rhythm
        // of their own, would let other rates in.
        let mut sums = vec![(0.0, 0.0); steps];
        for (n, power) in power.iter().enumerate() {
            let place = (n as f64 / rate_hz * hz).fract() * steps as f64;
            let (step, beyond) = (place as usize, place.fract());
            for (step, share) in [(step, 1.0 - beyond), (step + 1, beyond)] {
                let step = &mut sums[step % steps];
                step.0 += share * power;
                step.1 += share;
            }
        }
        sums.iter()
            .map(|(sum, shares)| sum / f64::max(*shares, f64::MIN_POSITIVE) / all)
            .collect::<Vec<f64>>()
    };
    let swing = |power: &[f64]| power.iter().map(|p| (p - 1.0).powi(2)).sum::<f64>();
    let best = tried.map(|hz| (hz, over(hz))).max_by(|a, b| swing(&a.1).total_cmp(&swing(&b.1)));
    let (hz, mut power_of) = best?;
    let highest = (0..steps).max_by(|a, b| power_of[*a].total_cmp(&power_of[*b]))?;
    power_of.rotate_left((highest + steps - steps / 4) % steps);
    let periods = (power.len() as f64 / rate_hz * hz) as usize;
    Some(SynchronousMean { hz, power: power_of, periods })
}

/// What would change the verdict, a sentence each: the limits that each family passes or fails, and the
/// speeds at which the comb that stands would be another family's.
pub fn what_would_change(findings: &MeasuredFindings) -> Vec<String> {
    let mut said = Vec::new();
    for family in findings.families.iter().filter(|f| f.claimed) {
        said.push(format!(
            "{} is claimed as long as each of these holds: probability of a false alarm {} (limit \
             {}), {:.0} % of combs at other spacings as high (limit {:.0} %), power that varies by {:.0} % \
             of its mean (limit {:.0} %).",
            family.name,
            family.false_alarm(),
            chance(ALPHA),
            100.0 * family.rank.unwrap_or(1.0),
            100.0 * MOST_AS_HIGH,
            100.0 * family.depth.unwrap_or(0.0),
            100.0 * IMPACT
        ));
        said.extend(other_speeds(findings, family));
    }
    if !findings.families.iter().any(|f| f.claimed) {
        let looked = findings.families.iter().filter(|f| f.rank.is_some());
        let nearest = looked.min_by(|a, b| a.p_value.total_cmp(&b.p_value));
        said.extend(nearest.map(missing));
    }
    if let (Some(found), Some(rpm)) = (&findings.unexplained, findings.speed_rpm) {
        let each = findings.families.iter().filter(|f| f.expected_hz > 0.0).map(|f| {
            let shocks_hz = f.name.shocks_per_period() * f.expected_hz;
            format!("{} at {:.1} rpm", f.name.shocks_name(), rpm * found.hz / shocks_hz)
        });
        said.push(format!(
            "The comb at {:.2} Hz would be {}: a measured speed settles it.",
            found.hz,
            each.collect::<Vec<_>>().join(", ")
        ));
    }
    said.push(format!(
        "A longer record narrows the lines ({:.3} Hz now) and lets lower combs stand out of the noise.",
        findings.resolution_hz
    ));
    said
}

/// How far a family is from being called a defect.
fn missing(family: &Family) -> String {
    let mut lacks = Vec::new();
    if family.p_value >= ALPHA {
        lacks.push(format!(
            "a probability of a false alarm below {} ({} now)",
            chance(ALPHA),
            family.false_alarm()
        ));
    }
    if let Some(rank) = family.rank.filter(|rank| *rank > MOST_AS_HIGH) {
        lacks.push(format!(
            "at most {:.0} % of combs at other spacings as high ({:.0} % now)",
            100.0 * MOST_AS_HIGH,
            100.0 * rank
        ));
    }
    if let Some(depth) = family.depth.filter(|depth| *depth < IMPACT) {
        lacks.push(format!(
            "power that varies by {:.0} % of its mean ({:.0} % now)",
            100.0 * IMPACT,
            100.0 * depth
        ));
    }
    if lacks.is_empty() {
        return format!("{} is nearest to a claim: {}.", family.name, family.reason);
    }
    format!("{} is nearest to a claim, which would need {}.", family.name, lacks.join(", and "))
}

/// The speeds at which the comb of a family would be another's.
fn other_speeds(findings: &MeasuredFindings, family: &Family) -> Option<String> {
    let rpm = findings.speed_rpm?;
    let comb_hz = family.name.shocks_per_period() * family.measured_hz?;
    let others = findings.families.iter().filter(|f| f.name != family.name && f.expected_hz > 0.0);
    let each: Vec<String> = others
        .map(|other| (other, comb_hz / (other.name.shocks_per_period() * other.expected_hz)))
        .filter(|(_, times)| (1.0 / FAR..FAR).contains(times))
        .map(|(other, times)| {
            format!("{} at {:.1} rpm ({:+.1} %)", other.name, rpm * times, 100.0 * (times - 1.0))
        })
        .collect();
    let words = format!(
        "The place rests on a speed of {rpm:.1} rpm and on the bearing named; the same lines would be those \
         of {}.",
        each.join(", ")
    );
    (!each.is_empty()).then(|| words.replace("(-", "(−"))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Power that swings by 1 + 0.8 cos at 50.02 Hz, sought at 50 Hz in 4 s: the rate is found to a twentieth
    /// of a resolution, the swing is that of the power less what steps of 5° average, and an unrelated
    /// rate shows nothing.
    #[test]
    fn planted_the_mean_over_a_period_is_the_modulation() {
        const RATE_HZ: f64 = 8_000.0;
        /// Averaging over a step of 1/72 of a period, and a rate off by a fortieth of a resolution.
        const LOST: f64 = 0.01;
        let at = |n: usize| std::f64::consts::TAU * 50.02 * n as f64 / RATE_HZ;
        let power: Vec<f64> = (0..32_000).map(|n| 3.0 * (1.0 + 0.8 * at(n).cos())).collect();
        let found = mean(&power, RATE_HZ, 50.0).unwrap();
        assert!((found.hz - 50.02).abs() < 0.0126, "{}", found.hz);
        assert_eq!((found.periods, found.power.len()), (200, STEPS));
        let highest = found.power.iter().copied().fold(0.0, f64::max);
        assert!((highest - 1.8).abs() < LOST, "{highest}");
        assert!((found.power[STEPS / 4] - highest).abs() < f64::EPSILON);
        let unrelated = mean(&power, RATE_HZ, 61.7).unwrap();
        assert!(unrelated.power.iter().all(|p| (p - 1.0).abs() < LOST), "{unrelated:?}");
    }
}
