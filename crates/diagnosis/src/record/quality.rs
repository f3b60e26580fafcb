//! What sensor, amplifier, converter and recorder did to the samples: clipping, gaps that were filled, a
//! channel that died, too few levels, a limited slew rate, a mean that drifts, mains hum, and content that no
//! anti-alias filter let pass.
//!
//! All of it is found in the pass in which a record is read anyway, in memory that does not grow with it. Each
//! rule compares the record with itself, so that none needs the range or the unit of the sensor.

mod flat;
mod rails;
mod spectral;

use serde::Serialize;
use stribeck_dsp::channel::Channel;
use stribeck_dsp::{Welch, WelchOptions};

use self::flat::{Flat, Lines, Run};
use self::rails::{Rail, Rails};
pub(crate) use self::spectral::folded;
use crate::Error;

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
}

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

impl Kind {
    /// Whether levels, knocks and lines of such samples are no longer those of the machine.
    pub fn spoils_verdicts(self) -> bool {
        matches!(self, Self::Clipped | Self::Held | Self::Dead | Self::FewLevels | Self::SlewLimited)
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
        }
    }
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
    let mut found = inspection.finish();
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
    Ok(spectral::hum(density.frequencies_hz(), density.values(), speed_rpm.map(|rpm| rpm / 60.0)))
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

/// A share in words.
fn percent(share: f64) -> String {
    match 100.0 * share {
        all if all > 99.95 => "100 %".to_owned(),
        more if more >= 0.95 => format!("{more:.1} %"),
        less => format!("{less:.2} %"),
    }
}

/// Stretches over which mean and level are followed, at most, and the shortest [s].
const STRETCHES: usize = 200;
const SHORTEST_S: f64 = 0.1;

/// Sums over a stretch of the record.
#[derive(Debug, Clone, Copy, Default)]
struct Stretch {
    count: f64,
    sum: f64,
    squares: f64,
}

impl Stretch {
    fn mean(&self) -> f64 {
        self.sum / self.count
    }

    fn deviation(&self) -> f64 {
        (self.squares / self.count - self.mean().powi(2)).max(0.0).sqrt()
    }
}

/// Stretches that stand still.
#[derive(Debug, Default)]
struct Stays {
    /// At the least or the largest value.
    at_rail: Vec<Run>,
    /// From the beginning, or to the end.
    ends: Vec<Run>,
    /// All others.
    gaps: Vec<Run>,
}

/// Part of the record from which on a channel that stands still at its end is dead.
const LEAST_END: f64 = 0.01;

/// What gaps mean, and what to do.
const NO_SIGNAL: &str = "there is no signal in them, and levels and kurtosis are not those of the machine. Leave \
                         the field empty in their place, or cut the record there";

/// An inspection in the making.
#[derive(Debug)]
pub(crate) struct Inspection {
    rate_hz: f64,
    values: Rails,
    steps: Rails,
    flat: Flat,
    lines: Lines,
    stretches: Vec<Stretch>,
    /// Samples of a stretch.
    length: usize,
    /// First value, from which stretches count, and the last one.
    origin: Option<f64>,
    last: Option<f64>,
    count: u64,
}

impl Inspection {
    /// Of a record of `len` samples.
    pub(crate) fn new(rate_hz: f64, len: usize) -> Self {
        let longest = (len as f64 / rate_hz / SHORTEST_S) as usize;
        let length = len.div_ceil(longest.clamp(8, STRETCHES)).max(1);
        Self {
            rate_hz,
            values: Rails::with_levels(),
            steps: Rails::default(),
            flat: Flat::default(),
            lines: Lines::default(),
            stretches: vec![Stretch::default(); len.div_ceil(length).max(1)],
            length,
            origin: None,
            last: None,
            count: 0,
        }
    }

    /// Samples as they follow.
    pub(crate) fn add(&mut self, block: &[f64]) {
        for &x in block {
            let at = self.count;
            self.count += 1;
            if !x.is_finite() {
                self.flat.interrupt();
                self.lines.interrupt();
                self.last = None;
                continue;
            }
            let is_new = self.last != Some(x);
            self.values.add(x, is_new);
            self.flat.add(x, at, is_new, self.values.is_extreme(x));
            if let Some(last) = self.last
                && (x - last).is_finite()
            {
                self.steps.add(x - last, true);
                self.lines.add(last, x - last, at);
            }
            self.last = Some(x);
            let d = x - *self.origin.get_or_insert(x);
            let place = (at as usize / self.length).min(self.stretches.len() - 1);
            let stretch = &mut self.stretches[place];
            stretch.count += 1.0;
            stretch.sum += d;
            stretch.squares += d * d;
        }
    }

    /// The findings that need no spectrum.
    pub(crate) fn finish(mut self) -> Vec<Quality> {
        self.flat.interrupt();
        self.lines.interrupt();
        let few = self.values.few_levels();
        let Stays { at_rail, ends, gaps } = self.stays(few.is_some());
        let mut found: Vec<Quality> = self.clipped(few.is_some(), &at_rail, &ends).into_iter().collect();
        found.extend(ends.iter().map(|run| self.dead(run)));
        if few.is_none() {
            found.extend(self.held(&gaps));
        }
        found.extend(self.straight());
        if ends.is_empty() {
            found.extend(self.silent());
        }
        match few {
            Some(levels) => found.push(self.coarse(levels)),
            // A gap makes steps of its own.
            None if found.is_empty() => found.extend(self.slewing()),
            None => {}
        }
        // What was filled in moves the mean, too.
        if found.iter().all(|of| !matches!(of.kind, Kind::Held | Kind::Dead)) {
            found.extend(self.drift());
        }
        found
    }

    /// The stretches that stand still, by what they mean.
    fn stays(&self, few_levels: bool) -> Stays {
        let least = LEAST_END * self.count as f64;
        let mut stays = Stays::default();
        for run in self.flat.stretches(self.count) {
            let at_end = run.to_end || run.from_start;
            // A mark of missing samples is no rail.
            let is_rail = self.values.is_extreme(run.value) && !self.values.is_far(run.value);
            if at_end && run.count as f64 > least {
                stays.ends.push(run);
            } else if is_rail && !at_end && !few_levels {
                stays.at_rail.push(run);
            } else {
                stays.gaps.push(run);
            }
        }
        stays
    }

    /// Samples at the ends of the range; a long stay there is clipping, too.
    fn clipped(&self, few_levels: bool, at_rail: &[Run], ends: &[Run]) -> Option<Quality> {
        let (low, high) = self.values.clipped(self.flat.natural(), few_levels);
        // A channel that stands at its largest value to the end is dead, and not clipped.
        let stands = |rail: &Rail| ends.iter().any(|run| run.value == rail.value);
        let rails: Vec<Rail> = [low, high].into_iter().flatten().filter(|rail| !stands(rail)).collect();
        let held: u64 = at_rail.iter().map(|run| run.count).sum();
        let samples = held.max(rails.iter().map(|rail| rail.samples).sum());
        if samples == 0 {
            return None;
        }
        let places = rails.iter().map(|rail| (rail.first, rail.value));
        let places: Vec<(u64, f64)> = places.chain(at_rail.iter().map(|run| (run.from, run.value))).collect();
        let first = places.iter().map(|(first, _)| *first).min().unwrap_or(0);
        let mut values: Vec<String> = places.iter().map(|(_, value)| spelt(*value)).collect();
        values.dedup();
        values.truncate(2);
        let share = self.part(samples);
        let words = format!(
            "clipped: {} of the samples stand at {}, the end of the range; levels, crest and kurtosis are too \
             low, the clipping makes harmonics, and a length from two events is not to be trusted. Measure \
             again with a larger range",
            percent(share),
            values.join(" and ")
        );
        Some(self.quality(Kind::Clipped, share, first, words))
    }

    /// A channel that stands still at its beginning or to its end.
    fn dead(&self, run: &Run) -> Quality {
        let share = self.part(run.count);
        let words = format!(
            "dead channel: the {} {:.2} s ({} of the samples) stand at {}; there is no signal, and levels and \
             kurtosis are not those of the machine. Cut the record to its sound part",
            if run.to_end { "last" } else { "first" },
            run.count as f64 / self.rate_hz,
            percent(share),
            spelt(run.value)
        );
        self.quality(Kind::Dead, share, run.from, words)
    }

    /// Gaps that were filled with one value, or with the last one.
    fn held(&self, gaps: &[Run]) -> Option<Quality> {
        let first = gaps.first()?;
        let share = self.part(gaps.iter().map(|run| run.count).sum());
        let longest = gaps.iter().map(|run| run.count).max().unwrap_or(0);
        let with = if gaps.iter().any(|run| run.value != first.value) {
            "the value before, as a recorder bridges gaps".to_owned()
        } else if first.value == 0.0 {
            "zero, as a recorder fills gaps".to_owned()
        } else {
            format!("{}, as a recorder marks gaps", spelt(first.value))
        };
        let words = format!(
            "filled gaps: {} of up to {longest} samples ({} of the samples) stand still at {with}; {NO_SIGNAL}",
            stretches(gaps.len()),
            percent(share)
        );
        Some(self.quality(Kind::Held, share, first.from, words))
    }

    /// Gaps that were filled with straight lines.
    fn straight(&self) -> Option<Quality> {
        let kept = self.lines.kept();
        let first = kept.first()?;
        let share = self.part(kept.iter().map(|run| run.count).sum());
        let words = format!(
            "filled gaps: {} of {} samples and more ({} of the samples) are straight lines, as a recorder \
             bridges gaps; {NO_SIGNAL}",
            stretches(kept.len()),
            flat::STRAIGHT,
            percent(share)
        );
        Some(self.quality(Kind::Held, share, first.from, words))
    }

    /// A converter of a few levels.
    fn coarse(&self, levels: usize) -> Quality {
        let words = format!(
            "few levels: {levels} values make up 99 % of all samples; the converter hardly resolves the \
             signal, and its steps make noise and lines of their own. Measure again with a smaller range or a \
             more sensitive sensor"
        );
        self.quality(Kind::FewLevels, 1.0, 0, words)
    }

    /// Steps from sample to sample that pile up at the largest, upwards and downwards.
    fn slewing(&self) -> Option<Quality> {
        let (Some(up), Some(down)) = self.steps.clipped(1, false) else { return None };
        let share = self.part(up.samples + down.samples);
        let rate = 0.5 * (up.value - down.value).abs() * self.rate_hz;
        let words = format!(
            "limited slew rate: {} of the steps from sample to sample are the largest, {} a second; the \
             amplifier cannot follow the signal, levels are too low, and lines of its own appear. Use a \
             smaller gain, or an amplifier that is faster",
            percent(share),
            spelt(rate)
        );
        let first = up.first.min(down.first);
        (share > SLEWING).then(|| self.quality(Kind::SlewLimited, share, first, words))
    }

    /// A number of samples as a part of all.
    fn part(&self, samples: u64) -> f64 {
        samples as f64 / self.count.max(1) as f64
    }

    fn quality(&self, kind: Kind, share: f64, first: u64, words: String) -> Quality {
        Quality { kind, share, first_s: first as f64 / self.rate_hz, words }
    }

    /// Level from which on a channel is silent, over that of most of the record, and how much of it must be.
    fn silent(&self) -> Option<Quality> {
        let deviations: Vec<f64> =
            self.stretches.iter().filter(|s| s.count > 1.0).map(Stretch::deviation).collect();
        let usual = median(&deviations)?;
        let quiet = |d: &&f64| **d < SILENT * usual;
        let first = deviations.iter().take_while(quiet).count();
        let last = deviations.iter().rev().take_while(quiet).count();
        let (count, from, side) =
            if last >= first { (last, deviations.len() - last, "last") } else { (first, 0, "first") };
        let share = count as f64 / deviations.len() as f64;
        (share > 0.05).then(|| {
            let seconds = (count * self.length) as f64 / self.rate_hz;
            self.quality(Kind::Dead, share, (from * self.length) as u64, format!(
                "dead channel: the {side} {seconds:.2} s ({} of the samples) have less than a hundredth of \
                 the level of the rest; the machine stood still, or the sensor came loose. Cut the record \
                 to its sound part",
                percent(share)
            ))
        })
    }

    /// A mean that moves by more than the signal swings.
    fn drift(&self) -> Option<Quality> {
        let some: Vec<&Stretch> =
            self.stretches.iter().filter(|s| s.count >= 0.5 * self.length as f64).collect();
        if some.len() < 8 || (self.length as f64) < SHORTEST_S * self.rate_hz {
            return None;
        }
        let deviations: Vec<f64> = some.iter().map(|s| s.deviation()).collect();
        let usual = median(&deviations)?;
        // Over an eighth of the record each, so that one knock or step inside moves it little.
        let eighth = some.len() / 8;
        let mean = |part: &[&Stretch]| part.iter().map(|s| s.mean()).sum::<f64>() / part.len() as f64;
        let means: Vec<f64> = some.chunks(eighth).filter(|c| c.len() == eighth).map(mean).collect();
        let (low, high) =
            means.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), m| (l.min(*m), h.max(*m)));
        (usual > 0.0 && high - low > DRIFTING * usual).then(|| {
            self.quality(
                Kind::Drift,
                1.0,
                0,
                format!(
                    "drifting mean: it moves by {} over the record, {:.1} times the root mean square of the \
                 signal about it; the sensor warms up, or its bias is not settled. Levels about the mean of \
                 the whole record are too high",
                    spelt(high - low),
                    (high - low) / usual
                ),
            )
        })
    }
}

/// Share of steps at the largest ones from which on the slew rate is limited.
const SLEWING: f64 = 0.02;
/// Part of the usual level below which a stretch is silent.
const SILENT: f64 = 0.01;
/// How far the mean moves over the usual root mean square.
const DRIFTING: f64 = 3.0;

fn median(all: &[f64]) -> Option<f64> {
    let mut sorted = all.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied()
}

/// A number of stretches in words.
fn stretches(count: usize) -> String {
    if count == 1 { "1 stretch".to_owned() } else { format!("{count} stretches") }
}

/// A value with six digits.
fn spelt(value: f64) -> String {
    let rounded: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    format!("{rounded}")
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
