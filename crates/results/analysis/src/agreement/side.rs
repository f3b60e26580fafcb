//! One run, reduced to the quantities that are compared.

use stribeck_dsp::{Detrend, Scaling, Sensor, Welch, WelchOptions, running_mean};
use stribeck_store::run_dir::Run;

use super::{FROM_S, LEAST_MEANS, MEAN_S, thirds};
use crate::Error;
use crate::findings::Findings;
use crate::load::support;
use crate::record::Record;
use crate::summary::Summary;

/// Lines of BPFO that are compared, and the periods of it that a record must hold for them.
pub(super) const LINES: usize = 5;
pub(super) const PERIODS: f64 = 10.0;
/// How much finer than its resolution the grid of the spectrum is from which lines are read: half a grid step
/// beside its place, Hann's window lowers a line by less than 0.02 %.
const FINER: usize = 32;

/// Largest accelerations are compared as a recorder of this rate shows them [Hz], which passes four tenths of
/// it.
pub(super) const RECORDER_HZ: f64 = 25_000.0;

/// Quantities of one run.
pub(super) struct Side {
    pub(super) summary: Summary,
    /// Smoothed forces of the outer raceway on each roller, x and y [N].
    pub(super) forces: Vec<[Vec<f64>; 2]>,
    /// Largest of them [N].
    pub(super) largest_n: f64,
    /// Mean force of all rollers against the load [N].
    pub(super) support_n: f64,
    /// Amplitudes of the first lines of BPFO at the first sensor [g].
    pub(super) lines_g: Option<Vec<f64>>,
    /// Vertical acceleration of the first sensor [g], and its rate [Hz].
    pub(super) waveform: Option<(String, Vec<f64>, f64)>,
    /// Largest acceleration of each sensor [g].
    pub(super) peaks_g: Vec<Option<f64>>,
    /// Middles of the bands [Hz].
    pub(super) centres_hz: Vec<f64>,
    /// Power of each sensor in each band [g²].
    pub(super) powers: Vec<(String, Vec<f64>)>,
    /// Processor time of a simulated millisecond [s].
    pub(super) cpu_s_per_ms: f64,
}

/// The part of a record that is compared.
struct Compared {
    /// Samples of this run in one interval of comparison.
    together: usize,
    /// First sample.
    from: usize,
    /// Samples of a mean force.
    width: usize,
}

impl Compared {
    /// Of a record, in intervals of `interval_s`.
    fn of(record: &Record<'_>, interval_s: f64) -> Result<Self, Error> {
        let together = (interval_s / record.interval_s()).round().max(1.0) as usize;
        // The first interval that ends there.
        let from =
            (together * ((FROM_S / interval_s - 1e-9).ceil() as usize).saturating_sub(1)).min(record.len());
        let width = together * (MEAN_S / interval_s).round().max(1.0) as usize;
        if record.len() - from < LEAST_MEANS * width {
            return Err(Error::NoSignal(format!(
                "the record of `{}` ends {:.2} ms after the start; models are compared from {:.0} ms on",
                record.run().scene.written.name,
                1e3 * record.interval_s() * record.len() as f64,
                1e3 * FROM_S
            )));
        }
        Ok(Self { together, from, width })
    }

    /// Running means of a force, one an interval.
    fn smoothed(&self, values: &[f64]) -> Vec<f64> {
        running_mean(&values[self.from..], self.width).into_iter().step_by(self.together).collect()
    }

    /// Means of a signal over the intervals.
    fn means(&self, signal: &[f64]) -> Vec<f64> {
        let mean = |part: &[f64]| part.iter().sum::<f64>() / self.together as f64;
        signal.chunks_exact(self.together).map(mean).collect()
    }
}

impl Side {
    /// Of a run, whose samples may be closer than `interval_s`, in which both models are compared.
    pub(super) fn of(run: &Run, interval_s: f64) -> Result<Self, Error> {
        let record = Record::whole(run)?;
        let summary = Findings::of(&record)?.summary;
        let compared = Compared::of(&record, interval_s)?;
        let forces: Vec<[Vec<f64>; 2]> = record
            .rollers()
            .iter()
            .map(|r| [compared.smoothed(r.outer_fx), compared.smoothed(r.outer_fy)])
            .collect();
        let sizes = forces.iter().flat_map(|[x, y]| x.iter().zip(y).map(|(x, y)| x.hypot(*y)));
        let support_n = support(&record, run.scene.written.load_direction());
        let support_n = &support_n[compared.from..];
        let mut side = Self {
            largest_n: sizes.fold(0.0, f64::max),
            support_n: support_n.iter().sum::<f64>() / support_n.len() as f64,
            cpu_s_per_ms: run.info.loop_cpu_s / summary.run.simulated_ms,
            centres_hz: thirds::centres((record.len() - compared.from) / compared.together, 1.0 / interval_s),
            forces,
            lines_g: None,
            waveform: None,
            peaks_g: Vec::new(),
            powers: Vec::new(),
            summary,
        };
        for sensor in &run.scene.written.output.sensors {
            let component =
                |name: &str| record.acceleration_g(&sensor.name, name).map(|a| a[compared.from..].to_vec());
            if let (Some(x), Some(y)) = (component("ax"), component("ay")) {
                side.add_sensor(&sensor.name, [&x, &y], record.sample_rate_hz(), &compared, interval_s)?;
            }
        }
        Ok(side)
    }

    /// One sensor more, with both components of its acceleration [g].
    fn add_sensor(
        &mut self,
        name: &str,
        [x, y]: [&[f64]; 2],
        rate_hz: f64,
        compared: &Compared,
        interval_s: f64,
    ) -> Result<(), Error> {
        let motion = &self.summary.kinematics;
        let bpfo_hz = motion.bpfo_hz.unwrap_or(motion.expected_bpfo_hz);
        if self.lines_g.is_none() && y.len() as f64 / rate_hz * bpfo_hz >= PERIODS {
            self.lines_g = Some(harmonics(y, rate_hz, bpfo_hz)?);
        }
        self.peaks_g.push(largest(x, y, rate_hz));
        self.waveform.get_or_insert_with(|| (name.to_owned(), compared.means(y), 1.0 / interval_s));
        let [x, y] = [x, y].map(|signal| thirds::powers(signal, rate_hz, &self.centres_hz));
        self.powers.push((name.to_owned(), x?.iter().zip(y?).map(|(x, y)| x + y).collect()));
        Ok(())
    }
}

/// Largest magnitude of an acceleration as a recorder shows it; `None` for one that is sampled more slowly.
fn largest(x: &[f64], y: &[f64], rate_hz: f64) -> Option<f64> {
    let recorder = Sensor::ideal(RECORDER_HZ);
    let [x, y] = [recorder.record(x, rate_hz).ok()?, recorder.record(y, rate_hz).ok()?];
    x.iter().zip(&y).map(|(x, y)| x.hypot(*y)).reduce(f64::max)
}

/// Amplitudes at the first multiples of a frequency [unit of the signal], through a Hann window over the
/// whole signal.
fn harmonics(signal: &[f64], rate_hz: f64, fundamental_hz: f64) -> Result<Vec<f64>, Error> {
    let options = WelchOptions {
        detrend: Detrend::None,
        scaling: Scaling::Spectrum,
        nfft: (FINER * signal.len()).next_power_of_two(),
        ..WelchOptions::new(signal.len())
    };
    let mut welch = Welch::new(rate_hz, signal.len(), &options).map_err(Error::Signal)?;
    let spectrum = welch.estimate(signal).map_err(Error::Signal)?;
    let amplitude = |order: usize| {
        let bin = (order as f64 * fundamental_hz / spectrum.resolution().grid_hz).round() as usize;
        spectrum.values().get(bin).map_or(f64::NAN, |power| (2.0 * power).sqrt())
    };
    Ok((1..=LINES).map(amplitude).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Five lines of known amplitudes at frequencies between those of the record's own grid, on a mean that
    /// is not zero.
    #[test]
    fn planted_lines_between_grid_points_have_their_amplitudes() {
        // At most half a step of the finer grid beside its place; sidelobes of the neighbours are a hundred
        // times smaller.
        const CLOSE: f64 = 2e-4;
        let wanted = [1.0, 0.5, 2.0, 0.25, 0.8];
        let line = |n: u32, order: usize| {
            let turns = order as f64 * 43.37 * f64::from(n) / 10_000.0;
            wanted[order - 1] * (std::f64::consts::TAU * turns + order as f64).cos()
        };
        let signal: Vec<f64> =
            (0..20_000).map(|n| 0.1 + (1..=LINES).map(|order| line(n, order)).sum::<f64>()).collect();
        for (found, wanted) in harmonics(&signal, 10_000.0, 43.37).unwrap().iter().zip(wanted) {
            assert!((found / wanted - 1.0).abs() < CLOSE, "{found} {wanted}");
        }
    }
}
