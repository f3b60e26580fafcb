//! What sensor, amplifier, converter and recorder did to the samples: clipping, gaps that were filled, a channel
//! that died, too few levels, a limited slew rate, a mean that drifts, mains hum, and content that no
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
    (!spoils.is_empty()).then(|| format!("The record is not sound, and the verdict rests on it: {}.", spoils.join(", ")))
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
        let mut found = Vec::new();
        let all = self.count.max(1) as f64;
        let few = self.values.few_levels();
        let natural = self.flat.natural();
        let flats = self.flat.stretches(self.count);
        let clipped = self.values.clipped(natural, few.is_some());
        let is_mark = |value: f64| self.values.is_far(value);
        // A long stay at the largest value is clipping, too, unless that value is a mark of missing samples.
        let (at_rail, inside): (Vec<_>, Vec<_>) =
            flats.into_iter().partition(|run| self.values.is_extreme(run.value) && !is_mark(run.value) && few.is_none() && !run.to_end && !run.from_start);
        let rails = [clipped.0, clipped.1].into_iter().flatten().collect::<Vec<_>>();
        let ends: Vec<Run> = inside.iter().filter(|run| run.count as f64 > 0.01 * all && (run.to_end || run.from_start)).copied().collect();
        let gaps: Vec<Run> = inside.into_iter().filter(|run| !ends.contains(run)).collect();
        // A channel that stands at its largest value to the end is dead, and not clipped.
        let rails: Vec<Rail> = rails.into_iter().filter(|rail| ends.iter().all(|run| run.value != rail.value)).collect();
        let held: u64 = at_rail.iter().map(|run| run.count).sum();
        let at: u64 = rails.iter().map(|rail| rail.samples).sum();
        if at.max(held) > 0 {
            let share = at.max(held) as f64 / all;
            let first = rails.iter().map(|r| r.first).chain(at_rail.iter().map(|r| r.from)).min().unwrap_or(0);
            let values: Vec<String> = rails.iter().map(|r| spelt(r.value)).chain(at_rail.iter().map(|r| spelt(r.value))).collect();
            let mut values = values;
            values.dedup();
            values.truncate(2);
            found.push(self.quality(Kind::Clipped, share, first, format!(
                "clipped: {} of the samples stand at {}, the end of the range; levels, crest and kurtosis are too low, the clipping makes harmonics, and a length from two events is not to be trusted. Measure again with a larger range",
                percent(share), values.join(" and ")
            )));
        }
        for run in &ends {
            let share = run.count as f64 / all;
            let seconds = run.count as f64 / self.rate_hz;
            let side = if run.to_end { "last" } else { "first" };
            found.push(self.quality(Kind::Dead, share, run.from, format!(
                "dead channel: the {side} {seconds:.2} s ({} of the samples) stand at {}; there is no signal, and levels and kurtosis are not those of the machine. Cut the record to its sound part",
                percent(share), spelt(run.value)
            )));
        }
        if let Some(first) = gaps.first()
            && few.is_none()
        {
            let total: u64 = gaps.iter().map(|run| run.count).sum();
            let share = total as f64 / all;
            let one = gaps.iter().all(|run| run.value == first.value);
            let longest = gaps.iter().map(|run| run.count).max().unwrap_or(0);
            let with = match (one, first.value) {
                (true, v) if v == 0.0 => "zero, as a recorder fills gaps".to_owned(),
                (true, v) => format!("{}, as a recorder marks gaps", spelt(v)),
                _ => "the value before, as a recorder bridges gaps".to_owned(),
            };
            found.push(self.quality(Kind::Held, share, first.from, format!(
                "filled gaps: {} of up to {longest} samples ({} of the samples) stand still at {with}; there is no signal in them, and levels and kurtosis are not those of the machine. Leave the field empty in their place, or cut the record there",
                stretches(gaps.len()), percent(share)
            )));
        }
        if let [first, ..] = self.lines.kept() {
            let total: u64 = self.lines.kept().iter().map(|run| run.count).sum();
            let share = total as f64 / all;
            found.push(self.quality(Kind::Held, share, first.from, format!(
                "filled gaps: {} of {} samples and more ({} of the samples) are straight lines, as a recorder bridges gaps; there is no signal in them, and levels and kurtosis are not those of the machine. Leave the field empty in their place, or cut the record there",
                stretches(self.lines.kept().len()), flat::STRAIGHT, percent(share)
            )));
        }
        if ends.is_empty() {
            found.extend(self.silent());
        }
        if let Some(levels) = few {
            found.push(self.quality(Kind::FewLevels, 1.0, 0, format!(
                "few levels: {levels} values make up 99 % of all samples; the converter hardly resolves the signal, and its steps make noise and lines of their own. Measure again with a smaller range or a more sensitive sensor"
            )));
        } else if found.is_empty()
            && let (Some(up), Some(down)) = self.steps.clipped(1, false)
        {
            let share = (up.samples + down.samples) as f64 / all;
            if share > SLEWING {
                let rate = 0.5 * (up.value - down.value) * self.rate_hz;
                found.push(self.quality(Kind::SlewLimited, share, up.first.min(down.first), format!(
                    "limited slew rate: {} of the steps from sample to sample are the largest, {} a second; the amplifier cannot follow the signal, levels are too low, and lines of its own appear. Use a smaller gain, or an amplifier that is faster",
                    percent(share), spelt(rate)
                )));
            }
        }
        // What was filled in moves the mean, too.
        if found.iter().all(|of| !matches!(of.kind, Kind::Held | Kind::Dead)) {
            found.extend(self.drift());
        }
        found
    }

    fn quality(&self, kind: Kind, share: f64, first: u64, words: String) -> Quality {
        Quality { kind, share, first_s: first as f64 / self.rate_hz, words }
    }

    /// Level from which on a channel is silent, over that of most of the record, and how much of it must be.
    fn silent(&self) -> Option<Quality> {
        let deviations: Vec<f64> = self.stretches.iter().filter(|s| s.count > 1.0).map(Stretch::deviation).collect();
        let usual = median(&deviations)?;
        let quiet = |d: &&f64| **d < SILENT * usual;
        let first = deviations.iter().take_while(quiet).count();
        let last = deviations.iter().rev().take_while(quiet).count();
        let (count, from, side) = if last >= first { (last, deviations.len() - last, "last") } else { (first, 0, "first") };
        let share = count as f64 / deviations.len() as f64;
        (share > 0.05).then(|| {
            let seconds = (count * self.length) as f64 / self.rate_hz;
            self.quality(Kind::Dead, share, (from * self.length) as u64, format!(
                "dead channel: the {side} {seconds:.2} s ({} of the samples) have less than a hundredth of the level of the rest; the machine stood still, or the sensor came loose. Cut the record to its sound part",
                percent(share)
            ))
        })
    }

    /// A mean that moves by more than the signal swings.
    fn drift(&self) -> Option<Quality> {
        let some: Vec<&Stretch> = self.stretches.iter().filter(|s| s.count >= 0.5 * self.length as f64).collect();
        if some.len() < 8 || (self.length as f64) < SHORTEST_S * self.rate_hz {
            return None;
        }
        let deviations: Vec<f64> = some.iter().map(|s| s.deviation()).collect();
        let usual = median(&deviations)?;
        // Over an eighth of the record each, so that one knock or step inside moves it little.
        let eighth = some.len() / 8;
        let mean = |part: &[&Stretch]| part.iter().map(|s| s.mean()).sum::<f64>() / part.len() as f64;
        let means: Vec<f64> = some.chunks(eighth).filter(|c| c.len() == eighth).map(mean).collect();
        let (low, high) = means.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), m| (l.min(*m), h.max(*m)));
        (usual > 0.0 && high - low > DRIFTING * usual).then(|| {
            self.quality(Kind::Drift, 1.0, 0, format!(
                "drifting mean: it moves by {} over the record, {:.1} times the root mean square of the signal about it; the sensor warms up, or its bias is not settled. Levels about the mean of the whole record are too high",
                spelt(high - low), (high - low) / usual
            ))
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
