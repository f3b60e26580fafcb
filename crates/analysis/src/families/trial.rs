//! How well a comb explains the channels of a record, where it belongs and elsewhere.

use super::comb::{Band, Comb, Complex, dot, extend_basis, smoothed};
use super::{Channel, LEAST_LEAD, Motion};

/// What is left of a channel counts as this share of it at least: a fit to 98 % is not bettered by one to 99 %, which follows
/// the channel's noise.
const LEAST_REST: f64 = 0.02;
/// How far a carrier may stand from the recorded motion, in resolutions.
const AT_HOME: f64 = 1.0;
/// Half width of the part of the scan that is taken in small steps, and the steps of it, in resolutions.
const CLOSE: f64 = 1.5;
const CLOSE_STEP: f64 = 0.1;
/// A comb must fit best where it belongs over this many BPFO: one that stands a spacing off shares all lines but the outermost.
const SCAN: f64 = 1.5;
/// Beside combs in the fit, copies of a comb up to this many BPFO off are rivals: what the fit misses lies there.
const BESIDE: f64 = 5.0;
/// Detuned combs, in BPFO on either side of the carrier: beyond the band that a comb shares with its copy.
const DETUNED: std::ops::RangeInclusive<i32> = 10..=40;
/// Two of them in a BPFO.
const DETUNED_STEP: f64 = 0.5;
/// Rollers that carry at least this part of the fullest one's mean load are listened to.
const LOADED: f64 = 0.25;
/// A contact sounds while it carries at least this part of the largest load.
const PRESSED: f64 = 0.1;

/// Every signal in which combs are sought, accelerations first, then forces on rollers.
pub(super) struct Channels {
    values: Vec<Vec<f64>>,
    accelerations: usize,
}

/// A comb tried on the channels.
#[derive(Debug, Clone)]
pub(super) struct Trial {
    /// Offset of the best fit within a resolution [Hz].
    pub(super) offset_hz: f64,
    /// Offset of the best fit of the whole scan [Hz].
    pub(super) highest_hz: f64,
    /// Standard deviation of the single channels' best offsets [Hz].
    pub(super) scatter_hz: f64,
    /// Score of the best fit within a resolution.
    pub(super) score: f64,
    /// Highest score of a comb that is off its place.
    pub(super) rival: f64,
    /// Whether the scan has its maximum within a resolution.
    pub(super) at_home: bool,
    /// Share explained of the accelerations.
    pub(super) explained: f64,
    /// Share explained of the forces.
    pub(super) explained_forces: f64,
}

impl Trial {
    /// How far the score leads that of combs off their place.
    pub(super) fn lead(&self) -> f64 {
        self.score - self.rival
    }

    /// Whether it explains clearly more where it belongs than elsewhere.
    pub(super) fn stands(&self) -> bool {
        self.at_home && self.lead() >= LEAST_LEAD
    }
}

impl Channels {
    /// The accelerations less their mean, and what the forces on loaded rollers do besides their running mean over two
    /// periods of the slowest comb. `None` without combs.
    pub(super) fn of<'a>(
        motion: &Motion,
        accelerations: &[Channel],
        combs: impl Iterator<Item = &'a Comb>,
    ) -> Option<Self> {
        let slowest_hz = combs.map(|c| c.rate_hz).reduce(f64::min)?;
        let centred = |channel: &Channel| {
            let mean = channel.values.iter().sum::<f64>() / channel.values.len().max(1) as f64;
            channel.values.iter().map(|v| v - mean).collect()
        };
        let mut values: Vec<Vec<f64>> = accelerations.iter().map(centred).collect();
        let mean = |load: &[f64]| load.iter().sum::<f64>() / load.len().max(1) as f64;
        let fullest = motion.rollers.iter().map(|r| mean(&r.load_n)).fold(0.0, f64::max);
        let width = (2.0 / (slowest_hz * motion.interval_s)).round() as usize;
        for roller in motion.rollers.iter().filter(|r| mean(&r.load_n) >= LOADED * fullest) {
            let slow = smoothed(&roller.load_n, width);
            let least = PRESSED * slow.iter().copied().fold(0.0, f64::max);
            let pairs = roller.load_n.iter().zip(&slow);
            values.push(pairs.map(|(load, slow)| if *slow > least { load - slow } else { 0.0 }).collect());
        }
        Some(Self { values, accelerations: accelerations.len() })
    }

    /// Tries a comb beside those that are in the fit with their offsets [Hz].
    pub(super) fn try_comb(&self, motion: &Motion, comb: &Comb, in_fit: &[(&Comb, f64)]) -> Trial {
        let resolution_hz = motion.resolution_hz();
        let band = Band::new(motion, comb.rate_hz);
        let signals = self.in_band(&band);
        let fit = basis_of(&band, in_fit);
        let shares = |offset_hz: f64| shares(&signals, &fit, &band.columns(comb, offset_hz));
        let scan: Vec<(f64, Vec<f64>)> = offsets(motion, !in_fit.is_empty())
            .into_iter()
            .map(|offset_hz| (offset_hz, shares(offset_hz)))
            .collect();
        let at_home = |offset_hz: f64| offset_hz.abs() <= (AT_HOME + 1e-9) * resolution_hz;
        let score = |n: usize| self.score(&scan[n].1);
        let best_of = |all: &dyn Fn(f64) -> bool, score: &dyn Fn(usize) -> f64| {
            let allowed = (0..scan.len()).filter(|&n| all(scan[n].0));
            allowed.max_by(|&a, &b| score(a).total_cmp(&score(b))).unwrap_or(0)
        };
        let best = best_of(&at_home, &score);
        let highest = best_of(&|offset_hz| offset_hz.abs() <= SCAN * motion.bpfo_hz, &score);
        let beside = |offset_hz: f64| !in_fit.is_empty() && offset_hz.abs() > (CLOSE + 1e-9) * resolution_hz;
        let near = (0..scan.len()).filter(|&n| beside(scan[n].0)).map(score);
        let rival = near.chain(self.detuned(motion, comb, in_fit)).fold(0.0, f64::max);
        let close = |offset_hz: f64| offset_hz.abs() <= (CLOSE + 1e-9) * resolution_hz;
        let squares = (0..self.values.len()).map(|channel| {
            let single = best_of(&close, &|n| scan[n].1[channel]);
            (scan[single].0 - scan[best].0).powi(2)
        });
        let (accelerations, forces) = scan[best].1.split_at(self.accelerations);
        Trial {
            offset_hz: scan[best].0,
            highest_hz: scan[highest].0,
            scatter_hz: (squares.sum::<f64>() / self.values.len() as f64).sqrt(),
            score: score(best),
            rival,
            at_home: at_home(scan[highest].0),
            explained: mean(accelerations),
            explained_forces: mean(forces),
        }
    }

    /// Scores of the comb where it does not belong.
    fn detuned(&self, motion: &Motion, comb: &Comb, in_fit: &[(&Comb, f64)]) -> Vec<f64> {
        let offsets = DETUNED.flat_map(|n| [-n, n]).map(|n| f64::from(n) * DETUNED_STEP * motion.bpfo_hz);
        let bands = offsets.map(|offset_hz| (offset_hz, Band::new(motion, comb.rate_hz + offset_hz)));
        bands
            .filter(|(_, band)| band.fits(motion))
            .map(|(offset_hz, band)| {
                let columns = band.columns(comb, offset_hz);
                self.score(&shares(&self.in_band(&band), &basis_of(&band, in_fit), &columns))
            })
            .collect()
    }

    fn in_band(&self, band: &Band) -> Vec<Vec<Complex>> {
        self.values.iter().map(|values| band.signal(values)).collect()
    }

    /// Mean of −ln(1 − R² + [`LEAST_REST`]) over the accelerations plus that over the forces.
    fn score(&self, shares: &[f64]) -> f64 {
        let scores: Vec<f64> = shares.iter().map(|r2| -(1.0 - r2 + LEAST_REST).ln()).collect();
        let (accelerations, forces) = scores.split_at(self.accelerations);
        mean(accelerations) + mean(forces)
    }
}

/// Orthonormal columns of combs in the fit.
fn basis_of(band: &Band, in_fit: &[(&Comb, f64)]) -> Vec<Vec<Complex>> {
    let mut basis = Vec::new();
    for (comb, offset_hz) in in_fit {
        extend_basis(&mut basis, &band.columns(comb, *offset_hz));
    }
    basis
}

/// Share of each signal that `columns` explain, of what `fit` leaves of it, 0 to 1.
fn shares(signals: &[Vec<Complex>], fit: &[Vec<Complex>], columns: &[Vec<Complex>]) -> Vec<f64> {
    let mut basis = fit.to_vec();
    extend_basis(&mut basis, columns);
    let power = |part: &[Vec<Complex>], signal: &[Complex]| -> f64 {
        part.iter().map(|q| dot(q, signal)).map(|c| c.0 * c.0 + c.1 * c.1).sum()
    };
    signals
        .iter()
        .map(|signal| {
            let left = dot(signal, signal).0 - power(fit, signal);
            if left > 0.0 { (power(&basis[fit.len()..], signal) / left).min(1.0) } else { 0.0 }
        })
        .collect()
}

/// Offsets of the scan [Hz], ascending; `beside` combs in the fit they reach farther.
fn offsets(motion: &Motion, beside: bool) -> Vec<f64> {
    let resolution_hz = motion.resolution_hz();
    let close = (CLOSE / CLOSE_STEP).round() as i32;
    let mut offsets: Vec<f64> = (-close..=close).map(|n| f64::from(n) * CLOSE_STEP * resolution_hz).collect();
    let step_hz = 0.5 * resolution_hz;
    let reach_hz = motion.bpfo_hz * if beside { BESIDE } else { SCAN };
    let mut offset_hz = CLOSE * resolution_hz + step_hz;
    while offset_hz <= reach_hz {
        offsets.extend([-offset_hz, offset_hz]);
        // Beyond the scan rivals are samples, not a curve.
        offset_hz +=
            if offset_hz < SCAN * motion.bpfo_hz { step_hz } else { step_hz.max(motion.bpfo_hz / 6.0) };
    }
    offsets.sort_unstable_by(f64::total_cmp);
    offsets
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}
