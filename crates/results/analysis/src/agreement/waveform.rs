//! Waveforms of the accelerations: their correlation at low frequencies, and their largest values as a
//! recorder shows them.

use serde::{Deserialize, Serialize};
use stribeck_dsp::{Detrend, Welch, WelchOptions};

use super::over_starts;
use super::side::{RECORDER_HZ, Side};
use crate::statistic::Statistic;
use stribeck_diagnosis::words::numbers::significant;

/// Waveforms are compared below these frequencies [Hz].
pub(super) const BELOW_HZ: [f64; 2] = [500.0, 2000.0];
/// Most samples of which a correlation is taken.
const WAVEFORM: usize = 50_000;
/// How alike the vertical accelerations of both models are below a frequency, from equal starts.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Correlation {
    /// Sensor.
    pub sensor: String,
    /// Upper end of the compared band [Hz].
    pub below_hz: f64,
    /// Correlation of full and reduced model over the starts [-].
    pub value: Statistic,
}

/// The largest acceleration of a record below a frequency, by both models. No limit is set to it: it is that
/// of one impact, whose waveform is chaotic, so that means over many starts are all that can be compared.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Peak {
    /// Sensor.
    pub sensor: String,
    /// Upper end of the compared band [Hz].
    pub below_hz: f64,
    /// Magnitude of both components, by the full model [g].
    pub full_g: Statistic,
    /// The same by the reduced one [g].
    pub reduced_g: Statistic,
}

impl Peak {
    /// How far the mean of the reduced model is from that of the full one, and the standard error of that
    /// [%]; no error of a single start.
    pub fn difference_percent(&self) -> (f64, Option<f64>) {
        let ratio = self.reduced_g.mean / self.full_g.mean;
        let error = |s: &Statistic| Some(s.deviation? / s.mean / (s.count as f64).sqrt());
        let error = error(&self.full_g).zip(error(&self.reduced_g)).map(|(f, r)| 100.0 * ratio * f.hypot(r));
        (100.0 * (ratio - 1.0), error)
    }

    /// Means by the full and by the reduced model with half of their 95 % intervals, in words [g].
    pub fn levels(&self) -> [String; 2] {
        [&self.full_g, &self.reduced_g].map(|level| {
            let half = level
                .high
                .map_or(String::new(), |high| format!(" \u{b1} {}", significant(high - level.mean, 2)));
            significant(level.mean, 3) + &half
        })
    }

    /// The difference in words.
    pub fn difference(&self) -> String {
        let (mean, error) = self.difference_percent();
        error.map_or(format!("{mean:+.0} %"), |error| format!("{mean:+.0} \u{b1} {error:.0} %"))
    }
}

/// Correlation below a frequency at the first sensor; `None` where the records hold no period of it.
pub(super) fn correlated(below_hz: f64, sides: &[[Side; 2]]) -> Option<Correlation> {
    let of = |[full, reduced]: &[Side; 2]| {
        let ((_, a, rate_hz), (_, b, _)) = (full.waveform.as_ref()?, reduced.waveform.as_ref()?);
        let len = a.len().min(b.len()).min(WAVEFORM);
        correlation(&a[..len], &b[..len], below_hz, *rate_hz)
    };
    let values: Vec<f64> = sides.iter().filter_map(of).filter(|v| v.is_finite()).collect();
    let value = of_correlations(&values, sides.len())?;
    let (sensor, ..) = sides.first()?[0].waveform.as_ref()?;
    Some(Correlation { sensor: sensor.clone(), below_hz, value })
}

/// Correlation of two equally long signals in the band from their first line to `below_hz`, through a Hann
/// window.
///
/// The cross power of a and b is half the excess of the power of a + b over the sum of both powers.
fn correlation(a: &[f64], b: &[f64], below_hz: f64, rate_hz: f64) -> Option<f64> {
    let options = WelchOptions { detrend: Detrend::None, ..WelchOptions::new(a.len()) };
    let mut welch = Welch::new(rate_hz, a.len(), &options).ok()?;
    let mut power = |signal: &[f64]| -> Option<f64> {
        let spectrum = welch.estimate(signal).ok()?;
        // The mean is no line.
        let rms = spectrum.band_rms(0.5 * spectrum.resolution().grid_hz, below_hz).ok()?;
        Some(rms * rms)
    };
    let sum: Vec<f64> = a.iter().zip(b).map(|(a, b)| a + b).collect();
    let (first, second, both) = (power(a)?, power(b)?, power(&sum)?);
    (first * second > 0.0).then(|| 0.5 * (both - first - second) / (first * second).sqrt())
}

/// Statistic of correlations, with the interval of Fisher's z = artanh r, which leaves no correlation above
/// one. Source: R. A. Fisher, On the "probable error" of a coefficient of correlation deduced from a small
/// sample, Metron 1 (1921) 3–32.
fn of_correlations(values: &[f64], of: usize) -> Option<Statistic> {
    /// Beyond it z is not finite.
    const MOST: f64 = 1.0 - 1e-12;
    let z: Vec<f64> = values.iter().map(|r| r.clamp(-MOST, MOST).atanh()).collect();
    let (plain, z) = (Statistic::of(values, of)?, Statistic::of(&z, of)?);
    Some(Statistic { low: z.low.map(f64::tanh), high: z.high.map(f64::tanh), ..plain })
}

/// Largest acceleration of every sensor, by both models.
pub(super) fn peaks(sides: &[[Side; 2]]) -> Vec<Peak> {
    let of = |model: usize, at: usize| {
        over_starts(sides.iter().map(|pair| *pair[model].peaks_g.get(at)?), sides.len())
    };
    let sensors = sides.first().map_or(&[][..], |pair| &pair[0].powers);
    let peak = |(at, (sensor, _)): (usize, &(String, Vec<f64>))| {
        Some(Peak {
            sensor: sensor.clone(),
            below_hz: 0.4 * RECORDER_HZ,
            full_g: of(0, at)?,
            reduced_g: of(1, at)?,
        })
    };
    sensors.iter().enumerate().filter_map(peak).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Four correlations whose mean is 0.922: an interval about it by Student's t reaches 1.018.
    #[test]
    fn issue_the_interval_of_a_correlation_ends_below_one() {
        let values = [0.99, 0.85, 0.89, 0.958];
        let plain = Statistic::of(&values, 4).expect("four");
        let of = of_correlations(&values, 4).expect("four");
        assert!(plain.high > Some(1.0), "{plain:?}");
        let (low, high) = of.low.zip(of.high).expect("four");
        assert!(low < of.mean && of.mean < high && high < 1.0, "{of:?}");
        assert_eq!((of.mean, of.median), (plain.mean, plain.median));
        // The same thing twice is one.
        let same = of_correlations(&[1.0, 1.0], 2).expect("two");
        assert!(same.low > Some(0.999) && same.high <= Some(1.0), "{same:?}");
    }

    /// Two sines of 100 Hz, sixty degrees apart, beside tones of 3 kHz that differ: below 500 Hz the
    /// correlation is cos 60°.
    #[test]
    fn planted_only_what_lies_below_the_frequency_is_correlated() {
        use std::f64::consts::{FRAC_PI_3, TAU};
        let signal = |lag: f64, high: f64| -> Vec<f64> {
            let tone = |t: f64| (TAU * 100.0 * t - lag).sin() + high * (TAU * 3000.0 * t).sin();
            (0..4000).map(|n| tone(f64::from(n) / 20_000.0)).collect()
        };
        let (a, b) = (signal(0.0, 2.0), signal(FRAC_PI_3, -2.0));
        let low = correlation(&a, &b, 500.0, 20_000.0).expect("a hundred lines");
        assert!((low - 0.5).abs() < 1e-9, "{low}");
        let all = correlation(&a, &b, 9000.0, 20_000.0).expect("many lines");
        assert!((all - (0.5 - 4.0) / 5.0).abs() < 1e-9, "{all}");
        // A record of 2 ms has no line below 400 Hz.
        assert_eq!(correlation(&a[..40], &b[..40], 400.0, 20_000.0), None);
    }
}
