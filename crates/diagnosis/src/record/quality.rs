//! What sensor, amplifier, converter and recorder did to the samples: clipping, gaps that were filled, a
//! channel that died, too few levels, a limited slew rate, a mean that drifts, mains hum, and content that no
//! anti-alias filter let pass.
//!
//! All of it is found in the pass in which a record is read anyway, in memory that does not grow with it. Each
//! rule compares the record with itself, so that none needs the range or the unit of the sensor.

mod flat;
mod histogram;
mod inspection;
mod jumps;
mod rails;
mod similarity;
mod spectral;

use serde::Serialize;
use stribeck_dsp::channel::Channel;
use stribeck_dsp::{Welch, WelchOptions};

pub(crate) use self::inspection::Inspection;
pub(crate) use self::spectral::folded;
use crate::Error;
use crate::quantities;

/// What is wrong with samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// Samples pile up at a rail.
    Clipped,
    /// Samples stand still at a value inside the range: gaps filled with zeros, a mark, or the last value.
    Held,
    /// The channel stands still, or is silent, from the beginning or to the end.
    Dead,
    /// The converter resolves a few levels of the signal only.
    FewLevels,
    /// Steps from sample to sample pile up at the largest.
    SlewLimited,
    /// The mean moves by more than the signal.
    Drift,
    /// Lines of the mains stand out.
    Hum,
    /// Much of the power lies just below half the sample rate, where an anti-alias filter leaves none.
    Aliased,
    /// Values leave the range at one end and come back at the other.
    Wrapped,
    /// Negative values were read or written without their sign.
    SignLost,
    /// The bytes of the numbers stand in the other order.
    Swapped,
    /// One value stands more often than any that is measured.
    Marked,
    /// A stretch stands a second time.
    Repeated,
    /// Samples held, stuffed with zeros, interpolated, or of channels in turn.
    Pattern,
    /// Samples pile up at rails that drift.
    DriftingRails,
    /// Gain or offset change at once.
    Jump,
}

quantities! {
    /// A finding on the quality of a record.
    #[derive(Debug, Clone, PartialEq, Serialize)]
    pub struct Quality {
        /// What it is.
        pub kind: Kind,
        /// Share of the samples that it concerns, from 0 to 1.
        pub share: f64,
        /// The first of them [s].
        pub first_s: f64,
        /// In words, with what to do.
        pub words: String,
    }
}

impl Kind {
    /// Whether levels, knocks and lines of such samples are no longer those of the machine.
    pub fn spoils_verdicts(self) -> bool {
        !matches!(self, Self::Drift | Self::Hum | Self::Aliased)
    }

    /// In a few words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Clipped => "clipped",
            Self::Held => "filled gaps",
            Self::Dead => "dead channel",
            Self::FewLevels => "few levels",
            Self::SlewLimited => "limited slew rate",
            Self::Drift => "drifting mean",
            Self::Hum => "mains hum",
            Self::Aliased => "aliasing",
            Self::Wrapped => "wrapped values",
            Self::SignLost => "sign lost",
            Self::Swapped => "bytes swapped",
            Self::Marked => "one value too often",
            Self::Repeated => "repeated stretches",
            Self::Pattern => "not samples of one signal",
            Self::DriftingRails => "clipped at rails that drift",
            Self::Jump => "gain or offset changed",
        }
    }
}

impl Quality {
    /// Whether such samples are no record of a signal, so that neither a defect nor its absence follows from them:
    /// gaps and dead stretches from half of the record on.
    pub fn is_no_signal(&self) -> bool {
        match self.kind {
            Kind::Held | Kind::Dead => self.share > 0.5,
            Kind::Clipped | Kind::FewLevels | Kind::SlewLimited | Kind::Drift | Kind::Hum | Kind::Aliased => false,
            _ => true,
        }
    }
}

/// The headline of samples that are no record of a signal, with what to do; `None` where they are one.
pub fn no_signal(found: &[Quality]) -> Option<String> {
    let why = found.iter().find(|of| of.is_no_signal())?;
    Some(format!("No verdict: the samples are no record of a signal. Why: {}.", why.words))
}

/// The quality of a channel sampled `rate_hz` times a second; `speed_rpm` is that of the shaft, where it is
/// known and does not vary.
///
/// # Errors
/// [`Error::File`] when it cannot be read, [`Error::Signal`] when it cannot be processed.
pub fn of(channel: &Channel, rate_hz: f64, speed_rpm: Option<f64>) -> Result<Vec<Quality>, Error> {
    let len = usize::try_from(channel.len).unwrap_or(usize::MAX);
    let mut inspection = Inspection::new(rate_hz, len);
    let mut kept = Vec::new();
    channel.for_each_block(|block| {
        inspection.add(block);
        kept.extend(block.iter().take(KEPT - kept.len()));
        true
    })?;
    let mut found = inspection.finish(&kept);
    found.extend(hum_of(&kept, rate_hz, speed_rpm)?);
    Ok(found)
}

/// Samples that are kept for the lines of the mains, and the length of their segments [s].
const KEPT: usize = 1 << 20;
const SEGMENT_S: f64 = 4.0;

/// Lines of the mains in the first samples of a record.
pub(crate) fn hum_of(kept: &[f64], rate_hz: f64, speed_rpm: Option<f64>) -> Result<Option<Quality>, Error> {
    let kept = &kept[..kept.iter().position(|x| !x.is_finite()).unwrap_or(kept.len())];
    let segment = kept.len().min((SEGMENT_S * rate_hz) as usize);
    if segment < MINIMUM {
        return Ok(None);
    }
    let mut welch = Welch::new(rate_hz, kept.len(), &WelchOptions::new(segment)).map_err(Error::Signal)?;
    let density = welch.estimate(kept).map_err(Error::Signal)?;
    Ok(spectral::hum(&density, speed_rpm.map(|rpm| rpm / 60.0)))
}

/// Fewest samples of a spectrum.
const MINIMUM: usize = 1024;

/// The sentence by which a verdict says that it rests on such samples; `None` for sound ones.
pub(crate) fn reservation(found: &[Quality]) -> Option<String> {
    let spoils: Vec<String> = found
        .iter()
        .filter(|of| of.kind.spoils_verdicts())
        .map(|of| format!("{} ({} of the samples)", of.kind.name(), percent(of.share)))
        .collect();
    (!spoils.is_empty())
        .then(|| format!("The record is not sound, and the verdict rests on it: {}.", spoils.join(", ")))
}

fn percent(share: f64) -> String {
    match 100.0 * share {
        all if all > 99.95 => "100 %".to_owned(),
        more if more >= 0.95 => format!("{more:.1} %"),
        less => format!("{less:.2} %"),
    }
}

/// The middle one, the upper of two.
fn median(all: &[f64]) -> Option<f64> {
    let mut sorted = all.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use stribeck_testing::Noise;

    use super::*;

    const RATE_HZ: f64 = 12_800.0;
    const COUNT: usize = 1 << 16;

    /// Nearly Gaussian, of unit variance.
    fn gaussian(noise: &mut Noise) -> f64 {
        (0..12).map(|_| noise.share()).sum::<f64>() - 6.0
    }

    /// Noise, and knocks that ring at 3 kHz: a sound record of a damaged bearing.
    fn sound() -> Vec<f64> {
        let mut noise = Noise::new(5);
        let ring = |s: f64| 3.0 * (-s / 1e-3).exp() * (TAU * 3000.0 * s).sin();
        (0..COUNT).map(|n| 0.4 * gaussian(&mut noise) + ring((n as f64 / RATE_HZ) % (1.0 / 71.7))).collect()
    }

    fn found(samples: &[f64]) -> Vec<Quality> {
        let mut inspection = Inspection::new(RATE_HZ, samples.len());
        samples.chunks(777).for_each(|block| inspection.add(block));
        inspection.finish()
    }

    fn kinds(samples: &[f64]) -> Vec<Kind> {
        found(samples).into_iter().map(|of| of.kind).collect()
    }

    /// Up to 11 of 100 samples at a rail in runs of one to three had no word.
    #[test]
    fn issue_clipping_in_short_runs_is_found_by_its_density() {
        let x = sound();
        let (mut dither, lsb) = (Noise::new(9), 0.8 / 2048.0);
        let clip = |low: f64, high: f64| x.iter().map(|x| x.clamp(low, high)).collect::<Vec<f64>>();
        let hard = clip(-0.8, 0.8);
        let stepped = |samples: Vec<f64>| samples.into_iter().map(|x| (x / lsb).round() * lsb).collect();
        let held: Vec<f64> = (0..COUNT).map(|n| hard[n / 4 * 4]).collect();
        for (name, samples, sides) in [
            ("hard", hard.clone(), 2.0),
            ("12 bits", stepped(clip(-0.8, 0.8 - lsb)), 2.0),
            ("dither", hard.iter().map(|x| x + 2e-4 * gaussian(&mut dither)).collect(), 2.0),
            ("more of it", hard.iter().map(|x| x + 1e-3 * gaussian(&mut dither)).collect(), 2.0),
            ("one side", clip(f64::NEG_INFINITY, 0.8), 1.0),
            ("whole numbers", hard.iter().map(|x| (x * 40_960.0).round().min(32_767.0)).collect(), 2.0),
            ("held fourfold", held, 2.0),
            (
                "a glitch beyond",
                hard.iter().enumerate().map(|(n, x)| if n == 777 { 9.0 } else { *x }).collect(),
                2.0,
            ),
        ] {
            let all = found(&samples);
            assert!(all.len() == 1 && all[0].kind == Kind::Clipped, "{name}: {all:?}");
            let share =
                x.iter().filter(|x| **x >= 0.8 || sides > 1.0 && **x <= -0.8).count() as f64 / COUNT as f64;
            assert!((all[0].share / share - 1.0).abs() < 0.1, "{name}: {} of {share}", all[0].share);
        }
        // A rail that a sample in four hundred reaches.
        assert_eq!(kinds(&clip(-2.5, 2.5)), [Kind::Clipped]);
    }

    #[test]
    fn issue_filled_gaps_and_dead_channels_are_named() {
        let x = sound();
        let gap = |fill: &dyn Fn(usize) -> f64, length: usize| {
            let mut y = x.clone();
            for from in (5000..65_000).step_by(10_000) {
                (from..from + length).for_each(|n| y[n] = fill(from));
            }
            y
        };
        let share = |samples: &[f64], kind: Kind| {
            let all = found(samples);
            assert!(all.len() == 1 && all[0].kind == kind, "{kind:?}: {all:?}");
            all[0].share
        };
        let part = |n: usize| n as f64 / COUNT as f64;
        let near = |a: f64, b: f64| assert!((a - b).abs() < 2e-4, "{a} {b}");
        near(share(&gap(&|_| 0.0, 800), Kind::Held), part(4800));
        near(share(&gap(&|_| 0.0, 50), Kind::Held), part(300));
        near(share(&gap(&|_| 0.0, 20), Kind::Held), part(120));
        // A few zeros at a time, and zeros in a signal that never comes near them.
        let often = |every: usize, length: usize| {
            (0..COUNT).map(|n| if n % every < length { 0.0 } else { x[n] }).collect::<Vec<f64>>()
        };
        near(share(&often(1000, 8), Kind::Held), part(8 * COUNT.div_ceil(1000)));
        let offset: Vec<f64> = gap(&|_| -9.81, 800).iter().map(|x| x + 9.81).collect();
        near(share(&offset, Kind::Held), part(4800));
        near(share(&gap(&|at| x[at - 1], 800), Kind::Held), part(4806));
        near(share(&gap(&|_| -999.0, 800), Kind::Held), part(4800));
        near(share(&gap(&|_| 1e6, 800), Kind::Held), part(4800));
        let tail = |value: &dyn Fn(f64) -> f64| {
            x.iter().enumerate().map(|(n, x)| if n < 40_000 { *x } else { value(*x) }).collect::<Vec<f64>>()
        };
        near(share(&tail(&|_| 0.0), Kind::Dead), part(COUNT - 40_000));
        near(share(&tail(&|_| 7.0), Kind::Dead), part(COUNT - 40_000));
        assert!((share(&tail(&|x| 1e-4 * x), Kind::Dead) - 0.39).abs() < 0.02);
        let bridged: Vec<f64> = (0..COUNT)
            .map(
                |n| if (20_000..20_800).contains(&n) { x[20_000] + (n - 20_000) as f64 * 1e-4 } else { x[n] },
            )
            .collect();
        near(share(&bridged, Kind::Held), part(800));
    }

    #[test]
    fn issue_converters_amplifiers_and_means_are_named() {
        let x = sound();
        let rounded = |step: f64| x.iter().map(|x| (x / step).round() * step).collect::<Vec<f64>>();
        assert_eq!(kinds(&rounded(1.0)), [Kind::FewLevels]);
        let mut at = 0.0;
        let slow: Vec<f64> = x
            .iter()
            .map(|x| {
                at += (x - at).clamp(-0.25, 0.25);
                at
            })
            .collect();
        assert_eq!(kinds(&slow), [Kind::SlewLimited]);
        let moved = |by: &dyn Fn(f64) -> f64| {
            x.iter().enumerate().map(|(n, x)| x + by(n as f64 / RATE_HZ)).collect::<Vec<f64>>()
        };
        assert_eq!(kinds(&moved(&|s| 5.0 * s)), [Kind::Drift]);
        assert_eq!(kinds(&moved(&|s| 10.0 * (-s).exp())), [Kind::Drift]);
        assert_eq!(kinds(&moved(&|_| 500.0)), []);
    }

    /// What looks like these, and is none of them.
    #[test]
    fn behaves_sound_records_have_no_findings() {
        let x = sound();
        let of =
            |make: &dyn Fn(f64) -> f64| (0..COUNT).map(|n| make(n as f64 / RATE_HZ)).collect::<Vec<f64>>();
        let knock = |s: f64| 3.0 * (-s / 1e-3).exp() * (TAU * 3000.0 * s).sin();
        for (name, samples) in [
            ("noise and knocks", x.clone()),
            ("12 bits", x.iter().map(|x| (x / 0.01).round() * 0.01).collect()),
            ("48 levels", x.iter().map(|x| (x / 0.15).round() * 0.15).collect()),
            ("sample and hold", (0..COUNT).map(|n| x[n / 16 * 16]).collect()),
            ("sine", of(&|s| (TAU * 100.3 * s).sin())),
            ("sine in step with the samples", of(&|s| (TAU * 100.0 * s).sin())),
            ("beating", of(&|s| (1.0 + 0.5 * (TAU * 3.0 * s).sin()) * (TAU * 1000.7 * s).sin())),
            ("knocks without noise", of(&|s| knock(s % (1.0 / 71.7)))),
            (
                "knocks in step with the samples",
                (0..COUNT).map(|n| knock((n % 180) as f64 / RATE_HZ)).collect(),
            ),
            ("a period again and again", (0..COUNT).map(|n| x[n % 1024]).collect()),
        ] {
            assert_eq!(found(&samples), [], "{name}");
        }
    }

    #[test]
    fn planted_lines_of_the_mains_and_power_below_half_the_rate_are_named() {
        let mut noise = Noise::new(3);
        let mut with = |hz: f64, height: f64, third: f64| -> Vec<f64> {
            let of = |n: usize, hz: f64| (TAU * hz * n as f64 / RATE_HZ).sin();
            (0..COUNT).map(|n| gaussian(&mut noise) + height * of(n, hz) + third * of(n, 3.0 * hz)).collect()
        };
        let named = |samples: &[f64], rpm| hum_of(samples, RATE_HZ, rpm).unwrap().map(|of| of.kind);
        assert_eq!(named(&with(50.0, 0.5, 0.2), None), Some(Kind::Hum));
        assert_eq!(named(&with(60.02, 3.0, 0.0), Some(1200.0 * 1.1)), Some(Kind::Hum));
        assert_eq!(named(&with(50.0, 3.0, 0.5), Some(3000.0)), None, "the shaft turns as fast");
        assert_eq!(named(&with(48.0, 3.0, 0.5), None), None);
        assert_eq!(named(&with(50.0, 0.0, 0.0), None), None);
        // A strong line of the machine beside a harmonic of a weak hum is none of it, and the harmonic is.
        for (hz, is_hum) in [(301.5, None), (300.0, Some(Kind::Hum))] {
            let line = |n: usize| 2.0 * (TAU * hz * n as f64 / RATE_HZ).sin();
            let samples: Vec<f64> =
                with(60.0, 0.2, 0.0).iter().enumerate().map(|(n, x)| x + line(n)).collect();
            assert_eq!(named(&samples, None), is_hum, "{hz}");
        }
        let high = with(6200.0, 2.0, 0.0);
        let record = |samples: Vec<f64>| {
            let channel = Channel::held("a", samples);
            crate::record::pass::Record::read(&channel, RATE_HZ).unwrap().quality
        };
        assert!(record(high).iter().any(|of| of.kind == Kind::Aliased));
        assert_eq!(record(with(3000.0, 2.0, 0.0)), []);
    }

    #[test]
    fn behaves_a_verdict_says_that_it_rests_on_spoilt_samples() {
        let clipped: Vec<f64> = sound().iter().map(|x| x.clamp(-0.8, 0.8)).collect();
        let channel = Channel::held("a", clipped);
        let findings = crate::Analysis::of(&channel, RATE_HZ, &crate::Machine::default()).unwrap().findings;
        assert!(
            findings.verdict.contains("not sound") && findings.verdict.contains("clipped ("),
            "{}",
            findings.verdict
        );
        assert!(findings.notes.iter().any(|note| note.starts_with("clipped:")), "{:?}", findings.notes);
    }
}
