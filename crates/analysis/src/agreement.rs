//! How far the reduced model of a scene is from the full one: the same starts by both, quantity by quantity.
//!
//! Each quantity has a limit, which is what a user of the reduced model may count on, and a verdict. Pairs of runs have the
//! same start, so what differs is the model, and what chance makes of a small difference: the waveform of one impact is
//! chaotic, which is why accelerations are compared by the power of third octaves over all starts.

use std::f64::consts::{PI, TAU};

use serde::{Deserialize, Serialize};
use stribeck_dsp::{Sensor, Welch, WelchOptions};
use stribeck_scene::run_dir::Run;
use stribeck_scene::scene::Scene;

use crate::Error;
use crate::findings::Findings;
use crate::load::running_mean;
use crate::record::Record;
use crate::statistic::Statistic;
use crate::summary::Summary;
use crate::words::significant;

/// The record is compared from here on [s]: before, both models still settle.
pub const FROM_S: f64 = 1e-3;
/// Forces are means over this time [s], a low pass that is 3 dB down at 1.8 kHz.
pub const MEAN_S: f64 = 0.25e-3;
/// A record must hold so many means …
const LEAST_MEANS: usize = 4;
/// … and be so long [s].
pub const LEAST_S: f64 = FROM_S + LEAST_MEANS as f64 * MEAN_S;
/// Third octaves, as steps of a third from 1 kHz: 500 Hz to 10 kHz.
const THIRDS: std::ops::RangeInclusive<i32> = -3..=10;
/// Samples of the full model that are no farther apart than this leave its third octaves as they are [s]. Nodes of the seat ring above
/// 50 kHz, and the mean over an interval of 10 µs folds a part of that down (THEORY §9.1).
pub const FINE_S: f64 = 2e-6;
/// Largest difference of a third octave that is agreement [dB].
pub const BAND_LIMIT_DB: f64 = 1.5;
/// Bins that a third octave must hold, and its width over its middle.
const LEAST_BINS: f64 = 3.0;
const WIDTH: f64 = 0.23;
/// Waveforms are compared below these frequencies [Hz], over so many samples at most.
const BELOW_HZ: [f64; 2] = [500.0, 2000.0];
const WAVEFORM: usize = 50_000;
/// Largest accelerations are compared as a recorder of this rate shows them [Hz], which passes four tenths of it.
const RECORDER_HZ: f64 = 25_000.0;
/// Systems count processor time in ticks of this length [s].
const TICK_S: f64 = 0.01;
/// Lines of BPFO that are compared, and the periods of it that a record must hold for them.
const LINES: usize = 5;
const PERIODS: f64 = 10.0;

/// The models of one scene beside each other; contents of `validation.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Agreement {
    /// Name of the scene.
    pub scene: String,
    /// Hash of the scene with the reduced model.
    pub scene_hash: String,
    /// Pairs of runs.
    pub starts: usize,
    /// Time on record [ms].
    pub simulated_ms: f64,
    /// Time step of the reduced model [µs].
    pub step_us: f64,
    /// Processor time of a simulated millisecond [s], the median over the starts: full, reduced.
    pub cpu_s_per_ms: [f64; 2],
    /// Every quantity.
    pub rows: Vec<Row>,
    /// Third octaves of every sensor.
    pub sensors: Vec<Octaves>,
    /// How alike the waveforms of the first sensor are.
    #[serde(default)]
    pub correlations: Vec<Correlation>,
    /// Largest accelerations of every sensor.
    #[serde(default)]
    pub peaks: Vec<Peak>,
    /// What could not be compared, and why.
    pub notes: Vec<String>,
}

/// On which scale a quantity is compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Scale {
    /// Forces, relative to the largest one.
    #[serde(rename = "% of the largest")]
    OfLargestForce,
    /// A number of the reduced model, relative to that of the full one.
    #[serde(rename = "%")]
    Relative,
    /// The time of an event.
    #[serde(rename = "ms")]
    EventTime,
    /// Levels of third octaves.
    #[serde(rename = "dB")]
    ThirdOctaves,
}

/// One quantity.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Stable name, the unit at its end.
    pub name: String,
    /// In words.
    pub quantity: String,
    /// What is compared; in files its unit.
    #[serde(rename = "unit")]
    pub scale: Scale,
    /// The difference, reduced less full; over the starts, or for third octaves over the bands.
    pub difference: Statistic,
    /// Largest difference that is still agreement.
    pub limit: f64,
    /// Whether it is kept: by the mean of the starts, or by every band.
    pub within: bool,
    /// Whether so many starts can tell: their interval, or the error of each band, leaves no other answer.
    #[serde(default)]
    pub told: bool,
}

/// How alike the vertical accelerations of both models are below a frequency, from equal starts.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Correlation {
    /// Sensor.
    pub sensor: String,
    /// Only what is below this frequency counts [Hz].
    pub below_hz: f64,
    /// Correlation of full and reduced model over the starts [-].
    pub value: Statistic,
}

/// The largest acceleration of a record below a frequency, by both models. No limit is set to it: it is that of one impact, whose
/// waveform is chaotic, so that means over many starts are all that can be compared.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Peak {
    /// Sensor.
    pub sensor: String,
    /// Only what is below this frequency counts [Hz].
    pub below_hz: f64,
    /// Magnitude of both components, by the full model [g].
    pub full_g: Statistic,
    /// The same by the reduced one [g].
    pub reduced_g: Statistic,
}

impl Peak {
    /// How far the mean of the reduced model is from that of the full one, and the standard error of that [%]; no error of a single start.
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

impl Scale {
    /// Unit of a difference.
    pub fn unit(self) -> &'static str {
        match self {
            Self::OfLargestForce => "% of the largest",
            Self::Relative => "%",
            Self::EventTime => "ms",
            Self::ThirdOctaves => "dB",
        }
    }
}

impl Row {
    /// Of the differences over the starts.
    fn over_starts(name: String, quantity: String, scale: Scale, difference: Statistic, limit: f64) -> Self {
        let told = difference
            .low
            .zip(difference.high)
            .is_some_and(|(low, high)| low.abs().max(high.abs()) <= limit || low > limit || high < -limit);
        let within = difference.mean.abs() <= limit;
        Self { name, quantity, scale, within, told, difference, limit }
    }

    /// The verdict in words.
    pub fn verdict(&self, starts: usize) -> String {
        match (self.told, self.within) {
            (true, true) => "yes".to_owned(),
            (true, false) => "no".to_owned(),
            (false, _) if starts == 1 => "one start cannot tell".to_owned(),
            (false, _) => format!("{starts} starts cannot tell"),
        }
    }

    /// Where the difference lies: the 95 % interval of the mean of the starts, or from the least to the most of the bands; `None`
    /// of a single value.
    pub fn range(&self) -> Option<[f64; 2]> {
        let d = &self.difference;
        let interval = if self.over_bands() { None } else { d.low.zip(d.high) };
        interval.or((d.count > 1).then_some((d.least, d.most))).map(<[f64; 2]>::from)
    }

    /// Whether values are those of bands, not of starts.
    pub fn over_bands(&self) -> bool {
        self.scale == Scale::ThirdOctaves
    }
}

/// Power of a sensor in third octaves, both components together, mean over the starts.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Octaves {
    /// Sensor.
    pub sensor: String,
    /// Middles of the bands [Hz].
    pub centres_hz: Vec<f64>,
    /// Level by the full model [dB re 1 g].
    pub full_db: Vec<f64>,
    /// Level by the reduced one [dB re 1 g].
    pub reduced_db: Vec<f64>,
    /// Standard error of their difference by the scatter of the starts [dB]; empty for a single start.
    pub error_db: Vec<f64>,
}

/// What one run says.
struct Side {
    summary: Summary,
    /// Smoothed forces of the outer raceway on each roller, x and y.
    forces: Vec<[Vec<f64>; 2]>,
    /// Largest of them [N].
    largest_n: f64,
    support_n: f64,
    /// Amplitudes of the first lines of BPFO at the first sensor [g].
    lines_g: Option<Vec<f64>>,
    /// Vertical acceleration of the first sensor [g], and its rate [Hz].
    waveform: Option<(String, Vec<f64>, f64)>,
    /// Largest acceleration of each sensor [g].
    peaks_g: Vec<Option<f64>>,
    /// Middles of the bands [Hz], and of each sensor the power in each band [g²].
    centres_hz: Vec<f64>,
    powers: Vec<(String, Vec<f64>)>,
    cpu_s_per_ms: f64,
}

impl Agreement {
    /// Of pairs of runs, full and reduced, of the same starts of `scene`.
    ///
    /// # Errors
    /// [`Error::NoSignal`] without a pair or when records are too short, [`Error::Signal`] when one cannot be processed.
    pub fn of(scene: &Scene, pairs: &[[Run; 2]]) -> Result<Self, Error> {
        let Some([_, first]) = pairs.first() else {
            return Err(Error::NoSignal("no pair of runs".to_owned()));
        };
        let mut sides = Vec::new();
        for [full, reduced] in pairs {
            let interval_s = full.info.interval_s.max(reduced.info.interval_s);
            sides.push([Side::of(full, interval_s)?, Side::of(reduced, interval_s)?]);
        }
        let mut notes = Vec::new();
        let sampled_s = pairs[0][0].info.interval_s;
        if sampled_s > 1.01 * FINE_S {
            notes.push(format!(
                "samples of the full model every {:.3} µs fold down what nodes ring with above {:.0} kHz, at the seat above all: its third \
                 octaves are higher than they should be. A shorter record is sampled every {:.0} µs",
                1e6 * sampled_s,
                5e-4 / sampled_s,
                1e6 * FINE_S
            ));
        }
        let mut rows = vec![
            forces(&sides),
            share("load", "mean load on the rollers", 0.1, &sides, |s| Some(s.support_n)),
        ];
        rows.push(share("cage", "speed of the cage", 0.2, &sides, |s| s.summary.kinematics.cage_hz));
        let mut rows: Vec<Row> = rows.into_iter().flatten().collect();
        rows.extend(events(&sides));
        let sensors = octaves(&sides);
        if sides[0][0].centres_hz.is_empty() {
            let long_enough_ms = |step: i32| 1e3 * (FROM_S + LEAST_BINS / (WIDTH * middle_hz(step)));
            notes.push(format!(
                "third octaves are compared on records of {:.1} ms at least, all of them of {:.0} ms",
                long_enough_ms(*THIRDS.end()),
                long_enough_ms(*THIRDS.start())
            ));
        }
        rows.extend(sensors.iter().filter_map(Octaves::row));
        let lines: Vec<Row> = (0..LINES).filter_map(|n| line(n, &sides)).collect();
        if lines.is_empty() {
            notes.push(format!(
                "lines of BPFO are compared on records of {PERIODS:.0} periods: {:.0} ms",
                1e3 * PERIODS / sides[0][0].summary.kinematics.expected_bpfo_hz
            ));
        }
        rows.extend(lines);
        let cost = |which: usize| {
            let all: Vec<f64> = sides.iter().map(|pair| pair[which].cpu_s_per_ms).collect();
            Statistic::of(&all, all.len()).map_or(f64::NAN, |s| s.median)
        };
        Ok(Self {
            scene: scene.name.clone(),
            scene_hash: scene.hash(),
            starts: pairs.len(),
            simulated_ms: sides[0][1].summary.run.simulated_ms,
            step_us: 1e6 * first.info.time_step_s,
            cpu_s_per_ms: [cost(0), cost(1)],
            rows,
            sensors,
            correlations: BELOW_HZ.into_iter().filter_map(|hz| alike(hz, &sides)).collect(),
            peaks: peaks(&sides),
            notes,
        })
    }

    /// What a simulated millisecond costs, in words: by the full model, by the reduced one, and how many times less that is. Less than a
    /// tick of the clock is not told from nothing.
    pub fn cost(&self) -> [String; 3] {
        let tick_s = TICK_S / self.simulated_ms;
        let [full, reduced] = self.cpu_s_per_ms;
        let said = |cost_s: f64, digits: usize| match cost_s < tick_s {
            true => format!("less than {} s", significant(tick_s, 2)),
            false => format!("{cost_s:.digits$} s"),
        };
        let times = match (full < tick_s, reduced < tick_s) {
            (true, _) => "too little to compare".to_owned(),
            (false, true) => format!("more than {:.0} times less", (full / tick_s).floor()),
            (false, false) => format!("{:.0} times less", full / reduced),
        };
        [said(full, 3), said(reduced, 4), times]
    }

    /// Rows that do not keep their limit.
    pub fn failures(&self) -> impl Iterator<Item = &Row> {
        self.rows.iter().filter(|row| row.told && !row.within)
    }

    /// Rows of which the starts do not tell whether they keep it.
    pub fn open(&self) -> impl Iterator<Item = &Row> {
        self.rows.iter().filter(|row| !row.told)
    }
}

impl Side {
    /// Of a run, whose samples may be closer than `interval_s`, in which both models are compared.
    fn of(run: &Run, interval_s: f64) -> Result<Self, Error> {
        let record = Record::whole(run)?;
        let summary = Findings::of(&record)?.summary;
        let together = (interval_s / record.interval_s()).round().max(1.0) as usize;
        // The first interval that ends there.
        let from =
            (together * ((FROM_S / interval_s - 1e-9).ceil() as usize).saturating_sub(1)).min(record.len());
        let width = together * (MEAN_S / interval_s).round().max(1.0) as usize;
        if record.len() - from < LEAST_MEANS * width {
            return Err(Error::NoSignal(format!(
                "the record of `{}` ends {:.2} ms after the start; models are compared from {:.0} ms on",
                run.scene.written.name,
                1e3 * record.interval_s() * record.len() as f64,
                1e3 * FROM_S
            )));
        }
        let mean = |values: &[f64]| -> Vec<f64> {
            running_mean(&values[from..], width).into_iter().step_by(together).collect()
        };
        let centres_hz = centres((record.len() - from) / together, 1.0 / interval_s);
        let forces: Vec<[Vec<f64>; 2]> =
            record.rollers().iter().map(|r| [mean(r.outer_fx), mean(r.outer_fy)]).collect();
        let sizes = forces.iter().flat_map(|[x, y]| x.iter().zip(y).map(|(x, y)| x.hypot(*y)));
        let support: Vec<f64> =
            crate::load::support(&record, run.scene.written.load_direction())[from..].to_vec();
        let mut powers = Vec::new();
        let mut lines_g = None;
        let mut waveform = None;
        let mut peaks_g = Vec::new();
        for sensor in &run.scene.written.output.sensors {
            let component =
                |name: &str| record.acceleration_g(&sensor.name, name).map(|a| a[from..].to_vec());
            let (Some(x), Some(y)) = (component("ax"), component("ay")) else { continue };
            if lines_g.is_none() {
                let bpfo_hz = summary.kinematics.bpfo_hz.unwrap_or(summary.kinematics.expected_bpfo_hz);
                let periods = y.len() as f64 * record.interval_s() * bpfo_hz;
                lines_g = (periods >= PERIODS).then(|| {
                    (1..=LINES).map(|n| amplitude(&y, n as f64 * bpfo_hz * record.interval_s())).collect()
                });
            }
            peaks_g.push(largest(&x, &y, record.sample_rate_hz()));
            let [x, y] = {
                let rate_hz = record.sample_rate_hz();
                let powers = [bands(&x, rate_hz, &centres_hz)?, bands(&y, rate_hz, &centres_hz)?];
                let means = y.chunks_exact(together).map(|part| part.iter().sum::<f64>() / together as f64);
                waveform.get_or_insert_with(|| (sensor.name.clone(), means.collect(), 1.0 / interval_s));
                powers
            };
            powers.push((sensor.name.clone(), x.iter().zip(&y).map(|(x, y)| x + y).collect()));
        }
        Ok(Self {
            largest_n: sizes.fold(0.0, f64::max),
            support_n: support.iter().sum::<f64>() / support.len() as f64,
            cpu_s_per_ms: run.info.loop_cpu_s / summary.run.simulated_ms,
            centres_hz,
            forces,
            lines_g,
            waveform,
            peaks_g,
            powers,
            summary,
        })
    }
}

/// Largest magnitude of an acceleration as a recorder shows it; `None` of one that is sampled more slowly.
fn largest(x: &[f64], y: &[f64], rate_hz: f64) -> Option<f64> {
    let recorder = Sensor::ideal(RECORDER_HZ);
    let [x, y] = [recorder.record(x, rate_hz).ok()?, recorder.record(y, rate_hz).ok()?];
    x.iter().zip(&y).map(|(x, y)| x.hypot(*y)).reduce(f64::max)
}

/// Amplitude of a line at `turns` a sample, through a Hann window.
fn amplitude(values: &[f64], turns: f64) -> f64 {
    let [re, im] = phasor(values, turns);
    re.hypot(im)
}

/// Its cosine and minus its sine.
fn phasor(values: &[f64], turns: f64) -> [f64; 2] {
    let n = values.len() as f64;
    let (mut re, mut im, mut weight) = (0.0, 0.0, 0.0);
    for (k, value) in values.iter().enumerate() {
        let hann = 0.5 - 0.5 * (TAU * (k as f64 + 0.5) / n).cos();
        let (sin, cos) = (TAU * (turns * k as f64).fract()).sin_cos();
        (re, im, weight) = (re + hann * value * cos, im - hann * value * sin, weight + hann);
    }
    [2.0 * re / weight, 2.0 * im / weight]
}

/// Correlation of two signals below a frequency: of their lines there, through a Hann window.
fn correlation(a: &[f64], b: &[f64], below_hz: f64, rate_hz: f64) -> Option<f64> {
    let lines = (below_hz * a.len() as f64 / rate_hz) as usize;
    let [mut both, mut first, mut second] = [0.0; 3];
    for line in 1..=lines {
        let turns = line as f64 / a.len() as f64;
        let ([x, y], [u, v]) = (phasor(a, turns), phasor(b, turns));
        (both, first, second) = (both + x * u + y * v, first + x * x + y * y, second + u * u + v * v);
    }
    (first * second > 0.0).then(|| both / (first * second).sqrt())
}

/// Middles of the third octaves [Hz] that a record of this length and rate holds.
fn centres(samples: usize, rate_hz: f64) -> Vec<f64> {
    let grid_hz = rate_hz / samples as f64;
    let all = THIRDS.map(middle_hz);
    all.filter(|hz| hz * WIDTH >= LEAST_BINS * grid_hz && 1.13 * hz < 0.5 * rate_hz).collect()
}

/// The middle of a third octave, so many thirds above 1 kHz [Hz].
fn middle_hz(step: i32) -> f64 {
    1000.0 * (f64::from(step) / 3.0).exp2()
}

/// Mean square in third octaves, of what the means over a sampling interval were taken of.
fn bands(values: &[f64], rate_hz: f64, centres_hz: &[f64]) -> Result<Vec<f64>, Error> {
    let options = WelchOptions::new(values.len());
    let mut welch = Welch::new(rate_hz, values.len(), &options).map_err(Error::Signal)?;
    let spectrum = welch.estimate(values).map_err(Error::Signal)?;
    let edge = (1.0_f64 / 6.0).exp2();
    let power = |hz: &f64| {
        let half_turn = PI * hz / rate_hz;
        let of_means = half_turn.sin() / half_turn;
        Ok((spectrum.band_rms(hz / edge, hz * edge).map_err(Error::Signal)? / of_means).powi(2))
    };
    centres_hz.iter().map(power).collect()
}

fn statistic(values: impl Iterator<Item = Option<f64>>, of: usize) -> Option<Statistic> {
    let there: Vec<f64> = values.flatten().filter(|v| v.is_finite()).collect();
    Statistic::of(&there, of)
}

/// Root mean square over rollers and time of what the forces differ by, of the largest force.
fn forces(sides: &[[Side; 2]]) -> Option<Row> {
    let off = |[full, reduced]: &[Side; 2]| {
        let (mut sum, mut count) = (0.0, 0.0);
        for (a, b) in full.forces.iter().zip(&reduced.forces) {
            for component in 0..2 {
                for (a, b) in a[component].iter().zip(&b[component]) {
                    (sum, count) = (sum + (a - b).powi(2), count + 0.5);
                }
            }
        }
        Some(100.0 * (sum / f64::max(count, 1.0)).sqrt() / full.largest_n)
    };
    let difference = statistic(sides.iter().map(off), sides.len())?;
    let quantity = format!("forces on the rollers, rms, means over {:.2} ms", 1e3 * MEAN_S);
    Some(Row::over_starts("forces_percent".to_owned(), quantity, Scale::OfLargestForce, difference, 1.0))
}

/// A relative difference [%].
fn share(
    name: &str,
    quantity: &str,
    limit: f64,
    sides: &[[Side; 2]],
    of: impl Fn(&Side) -> Option<f64>,
) -> Option<Row> {
    let off = |[full, reduced]: &[Side; 2]| Some(100.0 * (of(reduced)? / of(full)? - 1.0));
    let difference = statistic(sides.iter().map(off), sides.len())?;
    Some(Row::over_starts(format!("{name}_percent"), quantity.to_owned(), Scale::Relative, difference, limit))
}

/// When rollers unload and reload.
fn events(sides: &[[Side; 2]]) -> Vec<Row> {
    const LIMIT_MS: f64 = 0.05;
    let mut rows = Vec::new();
    let Some([full, _]) = sides.first() else { return rows };
    for (n, event) in full.summary.events.iter().enumerate() {
        let twice = full.summary.events[..n].iter().filter(|e| e.roller == event.roller).count();
        let again = if twice > 0 { format!(", passage {}", twice + 1) } else { String::new() };
        let suffix = if twice > 0 { format!("_{}", twice + 1) } else { String::new() };
        type Of = fn(&crate::summary::Event) -> Option<f64>;
        let kinds: [(&str, Of); 2] = [("unloads", |e| e.entry_ms), ("reloads", |e| e.exit_ms)];
        for (what, of) in kinds {
            let off = |[full, reduced]: &[Side; 2]| {
                let at =
                    |s: &Side| of(s.summary.events.iter().filter(|e| e.roller == event.roller).nth(twice)?);
                Some(at(reduced)? - at(full)?)
            };
            let Some(difference) = statistic(sides.iter().map(off), sides.len()) else { continue };
            let name = format!("roller_{}{suffix}_{what}_ms", event.roller);
            let quantity = format!("roller {} {what}{again}", event.roller);
            rows.push(Row::over_starts(name, quantity, Scale::EventTime, difference, LIMIT_MS));
        }
    }
    rows
}

/// A line of BPFO at the first sensor.
fn line(number: usize, sides: &[[Side; 2]]) -> Option<Row> {
    let of = |s: &Side| s.lines_g.as_ref()?.get(number).copied();
    let order = number + 1;
    share(&format!("bpfo_{order}"), &format!("line at {order} × BPFO, first sensor, y"), 10.0, sides, of)
}

/// How alike the waveforms of the first sensor are below a frequency.
fn alike(below_hz: f64, sides: &[[Side; 2]]) -> Option<Correlation> {
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

/// Of correlations, with the interval of Fisher's z = artanh r, which leaves no correlation above 1. Source: R. A. Fisher, On the
/// "probable error" of a coefficient of correlation deduced from a small sample, Metron 1 (1921) 3–32.
fn of_correlations(values: &[f64], of: usize) -> Option<Statistic> {
    /// Beyond it z is not finite.
    const MOST: f64 = 1.0 - 1e-12;
    let z: Vec<f64> = values.iter().map(|r| r.clamp(-MOST, MOST).atanh()).collect();
    let (plain, z) = (Statistic::of(values, of)?, Statistic::of(&z, of)?);
    Some(Statistic { low: z.low.map(f64::tanh), high: z.high.map(f64::tanh), ..plain })
}

/// The largest acceleration of every sensor.
fn peaks(sides: &[[Side; 2]]) -> Vec<Peak> {
    let of = |which: usize, at: usize| {
        statistic(sides.iter().map(|pair| *pair[which].peaks_g.get(at)?), sides.len())
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

fn octaves(sides: &[[Side; 2]]) -> Vec<Octaves> {
    let Some([first, _]) = sides.first().filter(|[full, _]| !full.centres_hz.is_empty()) else {
        return Vec::new();
    };
    let n = sides.len() as f64;
    let mut all = Vec::new();
    for (at, (sensor, powers)) in first.powers.iter().enumerate() {
        let of = |which: usize, band: usize| -> Vec<f64> {
            sides.iter().filter_map(|pair| Some(*pair[which].powers.get(at)?.1.get(band)?)).collect()
        };
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len().max(1) as f64;
        let level = |which: usize, band: usize| 10.0 * mean(&of(which, band)).log10();
        // Relative standard error of the mean power, in decibels.
        let error = |which: usize, band: usize| {
            let values = of(which, band);
            let m = mean(&values);
            let spread = values.iter().map(|v| (v / m - 1.0).powi(2)).sum::<f64>() / (n - 1.0);
            10.0 / std::f64::consts::LN_10 * (spread / n).sqrt()
        };
        let bands = 0..powers.len();
        let wide = bands.clone().map(|band| error(0, band).hypot(error(1, band)));
        all.push(Octaves {
            sensor: sensor.clone(),
            centres_hz: first.centres_hz.clone(),
            full_db: bands.clone().map(|band| level(0, band)).collect(),
            reduced_db: bands.clone().map(|band| level(1, band)).collect(),
            error_db: if sides.len() > 1 { wide.collect() } else { Vec::new() },
        });
    }
    all
}

impl Octaves {
    fn row(&self) -> Option<Row> {
        let off: Vec<f64> = self.reduced_db.iter().zip(&self.full_db).map(|(r, f)| r - f).collect();
        let difference = Statistic::of(&off, off.len())?;
        // Twice the standard error of a band may be on either side.
        let sure = |sign: f64| {
            off.iter().zip(&self.error_db).map(move |(off, error)| off.abs() + sign * 2.0 * error)
        };
        let told = !self.error_db.is_empty()
            && (sure(1.0).all(|most| most <= BAND_LIMIT_DB) || sure(-1.0).any(|least| least > BAND_LIMIT_DB));
        Some(Row {
            name: format!("octaves_{}_db", self.sensor),
            quantity: format!("third octaves at the sensor {}, 0.5 to 10 kHz", self.sensor),
            scale: Scale::ThirdOctaves,
            within: difference.most.max(-difference.least) <= BAND_LIMIT_DB,
            told,
            difference,
            limit: BAND_LIMIT_DB,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A short run of the reduced model took no tick of the clock, and its page said that it takes "inf times less".
    #[test]
    fn issue_less_than_a_tick_of_the_clock_is_no_division_by_zero() {
        let of = |cpu_s_per_ms| {
            let agreement = Agreement {
                scene: String::new(),
                scene_hash: String::new(),
                starts: 1,
                simulated_ms: 5.0,
                step_us: 2.0,
                cpu_s_per_ms,
                rows: Vec::new(),
                sensors: Vec::new(),
                correlations: Vec::new(),
                peaks: Vec::new(),
                notes: Vec::new(),
            };
            agreement.cost()
        };
        assert_eq!(of([0.8, 0.004]), ["0.800 s", "0.0040 s", "200 times less"]);
        assert_eq!(of([0.8, 0.0]), ["0.800 s", "less than 0.002 s", "more than 400 times less"]);
        assert_eq!(of([0.0, 0.0])[2], "too little to compare");
    }

    #[test]
    fn invariant_a_scale_is_its_unit_in_files() {
        for scale in [Scale::OfLargestForce, Scale::Relative, Scale::EventTime, Scale::ThirdOctaves] {
            assert_eq!(serde_json::to_value(scale).unwrap(), scale.unit());
        }
    }

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
}
