//! The samples of a run, up to the first that is not a number, and its channels under their names.

use std::borrow::Cow;
use std::ops::Range;

use stribeck_scene::scene::DefectRing;
use stribeck_store::run_dir::Run;
use stribeck_store::trace::Trace;

use crate::Error;
use stribeck_diagnosis::STANDARD_GRAVITY;
use stribeck_diagnosis::words::numbers::significant;

/// Channels of rollers that are in memory at once, at most [bytes]; one roller always is.
const ROLLERS_AT_ONCE_BYTES: usize = 256 << 20;

/// Samples that are looked at, at most: of a longer record the last ones, so that memory does not grow with
/// it.
const LONGEST: usize = 1 << 21;

/// Channels of a roller that are read.
const OF_ROLLER: [&str; 7] =
    ["x_m", "y_m", "spin_rad", "outer_fx_n", "outer_fy_n", "inner_fx_n", "inner_fy_n"];

/// Channels of a roller that are there where the bearing has oil.
const OIL_OF_ROLLER: [&str; 2] = ["outer_film_m", "inner_film_m"];

/// A run's samples, up to the last one before any channel stops being finite. Some channels are in memory,
/// the others on disk.
#[derive(Debug)]
pub struct Record<'a> {
    run: &'a Run,
    /// Channels in memory.
    held: Trace,
    /// Its samples lie behind this one of the run.
    first: usize,
    len: usize,
    discarded: usize,
}

/// Recorded motion and forces of one roller, all slices of one length.
///
/// Forces act on the roller. The outer raceway pushes it inwards, the inner raceway outwards.
#[derive(Debug, Clone, Copy)]
pub struct Roller<'a> {
    /// Number, from 1.
    pub number: usize,
    /// Centre [m].
    pub x: &'a [f64],
    /// Centre [m].
    pub y: &'a [f64],
    /// Accumulated rotation [rad], counter-clockwise.
    pub spin: &'a [f64],
    /// Force of the outer raceway, x [N].
    pub outer_fx: &'a [f64],
    /// Force of the outer raceway, y [N].
    pub outer_fy: &'a [f64],
    /// Force of the inner raceway, x [N].
    pub inner_fx: &'a [f64],
    /// Force of the inner raceway, y [N].
    pub inner_fy: &'a [f64],
    /// Thickness of the oil on the outer and on the inner raceway [m]; `None` for a dry bearing.
    pub films: Option<[&'a [f64]; 2]>,
}

/// Angle of the shaft against the outer ring [rad], of the angles of both.
pub fn against<'a>(shaft: &'a [f64], outer: Option<&[f64]>) -> Cow<'a, [f64]> {
    match outer {
        Some(outer) => shaft.iter().zip(outer).map(|(shaft, outer)| shaft - outer).collect(),
        None => Cow::Borrowed(shaft),
    }
}

fn of_rollers(numbers: &[usize]) -> impl Fn(&str) -> bool {
    let of_one = OF_ROLLER.iter().chain(&OIL_OF_ROLLER);
    let name = |number| of_one.clone().map(move |what| format!("roller.{number}.{what}"));
    let names: Vec<String> = numbers.iter().flat_map(name).collect();
    move |name| names.iter().any(|wanted| wanted == name)
}

impl<'a> Record<'a> {
    /// All samples up to the first that is not finite in any channel; of a record of more than two million
    /// the last ones. Channels of rollers and sensors, which are most, stay on disk.
    pub fn new(run: &'a Run) -> Result<Self, Error> {
        Self::between(run, f64::NEG_INFINITY..f64::INFINITY)
    }

    /// The same of a stretch of time [s].
    ///
    /// # Errors
    /// As [`Record::new`], and [`Error::NoSignal`] for a stretch that holds nothing of the record.
    pub fn between(run: &'a Run, time_s: Range<f64>) -> Result<Self, Error> {
        let start_s = run.trace.read(0..1, |name| name == "time_s")?;
        let start_s = start_s.get("time_s").and_then(|time| time.first().copied()).unwrap_or(0.0);
        // The sample at or behind a time; an infinite time, or one beyond the record, is its end.
        let row = |at_s: f64| ((at_s - start_s) / run.info.interval_s - 1e-6).ceil().max(0.0) as usize;
        let end = row(time_s.end).min(run.trace.len());
        let first = row(time_s.start).max(end.saturating_sub(LONGEST));
        if first >= end && !run.trace.is_empty() {
            let whole_s = start_s + (run.trace.len() - 1) as f64 * run.info.interval_s;
            return Err(Error::NoSignal(format!(
                "the record is {} s long and holds nothing {}",
                significant(whole_s, 6),
                match (time_s.start.is_finite(), time_s.end.is_finite()) {
                    (true, true) => format!("from {} to {} s", time_s.start, time_s.end),
                    (true, false) => format!("from {} s on", time_s.start),
                    _ => format!("up to {} s", time_s.end),
                }
            )));
        }
        let held = |name: &str| !name.starts_with("roller.") && !name.starts_with("sensor.");
        Self::with(run, first.min(end)..end, held)
    }

    /// The same with all channels in memory, which a long record may not fit into.
    pub fn whole(run: &'a Run) -> Result<Self, Error> {
        Self::with(run, 0..run.trace.len(), |_| true)
    }

    fn with(run: &'a Run, rows: Range<usize>, held: impl Fn(&str) -> bool) -> Result<Self, Error> {
        let held = run.trace.read_finite(rows.clone(), |name| name == "time_s" || held(name))?;
        let len = held.len();
        Ok(Self { run, held, first: rows.start, len, discarded: rows.len().saturating_sub(len) })
    }

    /// Some of the samples, with those channels in memory whose name is `wanted`: one pass over the file.
    pub fn part(&self, samples: Range<usize>, wanted: impl Fn(&str) -> bool) -> Result<Self, Error> {
        let [start, end] = [samples.start, samples.end].map(|at| self.first + at.min(self.len));
        let held = self.run.trace.read(start..end, wanted)?;
        let len = end.saturating_sub(start);
        Ok(Self { run: self.run, held, first: start, len, discarded: self.discarded })
    }

    /// Some of the samples, with these rollers in memory.
    pub fn with_rollers(&self, numbers: &[usize], samples: Range<usize>) -> Result<Self, Error> {
        self.part(samples, of_rollers(numbers))
    }

    /// The first sample of the run, which may lie before this record, with these rollers in memory.
    pub fn at_start(&self, numbers: &[usize]) -> Result<Self, Error> {
        Self::with(self.run, 0..1, of_rollers(numbers))
    }

    /// Hands every roller whose channels are there to `visit`, in the order of their numbers. A few are in
    /// memory at a time.
    pub fn each_roller(&self, mut visit: impl FnMut(&Roller<'_>)) -> Result<(), Error> {
        let of_one = 8 * (OF_ROLLER.len() + OIL_OF_ROLLER.len()) * self.len.max(1);
        for numbers in self.roller_numbers().chunks((ROLLERS_AT_ONCE_BYTES / of_one).max(1)) {
            self.with_rollers(numbers, 0..self.len)?.rollers().iter().for_each(&mut visit);
        }
        Ok(())
    }

    /// Numbers of the rollers whose channels are there, ascending, in memory or on disk.
    pub fn roller_numbers(&self) -> Vec<usize> {
        let names = self.run.trace.names();
        let there = |name: String| names.contains(&name);
        let in_place = self.run.scene.written.rollers_in_place();
        in_place
            .filter(|number| OF_ROLLER.iter().all(|what| there(format!("roller.{number}.{what}"))))
            .collect()
    }

    /// The run that was recorded.
    pub fn run(&self) -> &'a Run {
        self.run
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.len
    }

    /// True when there is no usable sample.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// True when samples before or after these are left out.
    pub fn is_part(&self) -> bool {
        self.len + self.discarded < self.run.trace.len()
    }

    /// Samples that were written but are not numbers, or follow one that is not.
    pub fn discarded(&self) -> usize {
        self.discarded
    }

    /// Sampling interval [s], the recorded one, or that of `run.json` when there are fewer than two samples.
    pub fn interval_s(&self) -> f64 {
        match self.time_s() {
            [first, .., last] if last > first => (last - first) / (self.len - 1) as f64,
            _ => self.run.info.interval_s,
        }
    }

    /// When it begins and ends [s]: with the run, or a sampling interval before its first sample, and with
    /// its last one.
    pub fn stretch_s(&self) -> [f64; 2] {
        let [first, last] = [self.time_s().first(), self.time_s().last()].map(|t| t.copied().unwrap_or(0.0));
        [if self.first == 0 { 0.0 } else { first - self.interval_s() }, last]
    }

    /// Sampling rate [Hz].
    pub fn sample_rate_hz(&self) -> f64 {
        // The file's rounding of times moves the rate by far less than a tenth of a hertz.
        (10.0 / self.interval_s()).round() / 10.0
    }

    /// Times [s].
    pub fn time_s(&self) -> &[f64] {
        self.channel("time_s").unwrap_or(&[])
    }

    /// Angle of the shaft against the outer ring at each sample [rad]; `None` when it was not recorded.
    pub fn relative_angle(&self) -> Option<Cow<'_, [f64]>> {
        Some(against(self.channel("shaft.angle_rad")?, self.channel("outer_ring.angle_rad")))
    }

    /// Values of a channel that is in memory.
    pub fn channel(&self, name: &str) -> Option<&[f64]> {
        self.held.get(name)
    }

    /// Values of a channel, which is in memory no longer.
    pub fn take(&mut self, name: &str) -> Option<Vec<f64>> {
        self.held.take(name)
    }

    /// Acceleration `ax` or `ay` of a sensor [g], mean over each interval.
    pub fn acceleration_g(&self, sensor: &str, component: &str) -> Option<Vec<f64>> {
        let values = self.channel(&format!("sensor.{sensor}.{component}_m_s2"))?;
        Some(values.iter().map(|a| a / STANDARD_GRAVITY).collect())
    }

    /// Roller `number`, from 1; `None` when one of its channels is not in memory.
    pub fn roller(&self, number: usize) -> Option<Roller<'_>> {
        let [x, y, spin, outer_fx, outer_fy, inner_fx, inner_fy] =
            OF_ROLLER.map(|what| self.channel(&format!("roller.{number}.{what}")));
        let [outer_film, inner_film] =
            OIL_OF_ROLLER.map(|what| self.channel(&format!("roller.{number}.{what}")));
        Some(Roller {
            number,
            x: x?,
            y: y?,
            spin: spin?,
            outer_fx: outer_fx?,
            outer_fy: outer_fy?,
            inner_fx: inner_fx?,
            inner_fy: inner_fy?,
            films: outer_film.zip(inner_film).map(<[&[f64]; 2]>::from),
        })
    }

    /// Places for rollers in the cage, with those where one is missing.
    pub fn pockets(&self) -> usize {
        self.run.scene.written.bearing.rollers
    }

    /// All rollers whose channels are in memory.
    pub fn rollers(&self) -> Vec<Roller<'_>> {
        self.run.scene.written.rollers_in_place().filter_map(|number| self.roller(number)).collect()
    }
}

impl<'a> Roller<'a> {
    /// The same over some of the samples.
    pub fn within(&self, samples: Range<usize>) -> Self {
        let part = |all: &'a [f64]| &all[samples.clone()];
        Self {
            number: self.number,
            x: part(self.x),
            y: part(self.y),
            spin: part(self.spin),
            outer_fx: part(self.outer_fx),
            outer_fy: part(self.outer_fy),
            inner_fx: part(self.inner_fx),
            inner_fy: part(self.inner_fy),
            films: self.films.map(|films| films.map(part)),
        }
    }

    /// Orbital angle about the bearing's centre [rad], counter-clockwise from the x axis, without jumps.
    pub fn orbit(&self) -> Vec<f64> {
        let mut turns = 0.0;
        let mut last: Option<f64> = None;
        self.x
            .iter()
            .zip(self.y)
            .map(|(x, y)| {
                let angle = y.atan2(*x);
                let jump = last.map_or(0.0, |before| angle - before);
                if jump > std::f64::consts::PI {
                    turns -= 1.0;
                } else if jump < -std::f64::consts::PI {
                    turns += 1.0;
                }
                last = Some(angle);
                angle + turns * std::f64::consts::TAU
            })
            .collect()
    }

    /// Normal force between roller and the raceway of a ring [N], compression positive.
    pub fn normal(&self, ring: DefectRing) -> Vec<f64> {
        match ring {
            DefectRing::Outer => self.outer_normal(),
            DefectRing::Inner => self.inner_normal(),
        }
    }

    /// Thickness of the oil on the raceway of a ring [m]; `None` for a dry bearing.
    pub fn film(&self, ring: DefectRing) -> Option<&'a [f64]> {
        let [outer, inner] = self.films?;
        Some(match ring {
            DefectRing::Outer => outer,
            DefectRing::Inner => inner,
        })
    }

    /// Normal force between roller and outer raceway [N], compression positive.
    pub fn outer_normal(&self) -> Vec<f64> {
        radial(self.x, self.y, self.outer_fx, self.outer_fy, -1.0)
    }

    /// Normal force between roller and inner raceway [N], compression positive.
    pub fn inner_normal(&self) -> Vec<f64> {
        radial(self.x, self.y, self.inner_fx, self.inner_fy, 1.0)
    }
}

/// Component of a force along the outward radius through (x, y), times `sign`.
fn radial(x: &[f64], y: &[f64], fx: &[f64], fy: &[f64], sign: f64) -> Vec<f64> {
    (0..x.len())
        .map(|n| {
            let radius = x[n].hypot(y[n]);
            if radius > 0.0 { sign * (fx[n] * x[n] + fy[n] * y[n]) / radius } else { 0.0 }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn planted_a_turning_roller() {
        let angle: Vec<f64> = (0..1000).map(|n| 1.6 - 0.02 * n as f64).collect();
        let (x, y): (Vec<f64>, Vec<f64>) = angle.iter().map(|a| (0.09 * a.cos(), 0.09 * a.sin())).unzip();
        let (fx, fy): (Vec<f64>, Vec<f64>) = angle.iter().map(|a| (-5.0 * a.cos(), -5.0 * a.sin())).unzip();
        let none = vec![0.0; 1000];
        let roller = Roller {
            number: 1,
            x: &x,
            y: &y,
            spin: &none,
            outer_fx: &fx,
            outer_fy: &fy,
            inner_fx: &fx,
            inner_fy: &fy,
            films: None,
        };
        // More than three turns without a jump.
        assert!(roller.orbit().iter().zip(&angle).all(|(found, a)| (found - a).abs() < 1e-12));
        assert!(roller.outer_normal().iter().all(|f| (f - 5.0).abs() < 1e-12));
        assert!(roller.inner_normal().iter().all(|f| (f + 5.0).abs() < 1e-12));
    }
}
