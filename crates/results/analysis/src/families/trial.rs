//! How well a comb explains the channels of a record, at its predicted frequency and elsewhere.

use super::comb::{AT_ONCE, BasebandComb, Columns, smoothed};
use super::kernels::Signal;
use super::shares::Signals;
use super::{Channel, LEAST_LEAD, RecordedMotion};

/// Floor of the residual's share: a fit of 99 % is no better than one of 98 %, because the rest is the
/// channel's noise.
const LEAST_REST: f64 = 0.02;
/// How far a carrier may stand from the recorded motion, in resolutions: its frequency is known to some
/// tenths, and the lines of three families lie less than a resolution apart when their combs are laid over
/// each other.
const AT_HOME: f64 = 0.5;
/// Half width of the part of the scan that is taken in small steps, and the steps of it, in resolutions.
const CLOSE: f64 = 1.0;
const CLOSE_STEP: f64 = 0.05;
/// A comb must fit best where it belongs over this many BPFO: one that stands a spacing off shares all lines
/// but the outermost.
const SCAN: f64 = 1.5;
/// With combs in the fit, copies of a comb up to this many BPFO off are rivals: the residual of the fit lies
/// there.
const BESIDE: f64 = 5.0;
/// Detuned combs, in BPFO on either side of the carrier: beyond the band that a comb shares with its copy.
const DETUNED: std::ops::RangeInclusive<i32> = 10..=40;
/// Two of them in a BPFO.
const DETUNED_STEP: f64 = 0.5;
/// Forces are fitted on rollers that carry at least this part of the largest mean load, the most loaded of
/// them.
const LOADED: f64 = 0.25;
const OBSERVED: usize = 8;
/// A contact counts while it carries at least this part of the largest load.
const PRESSED: f64 = 0.1;

/// Every signal in which combs are sought.
pub(super) struct Channels {
    accelerations: Vec<Vec<f64>>,
    /// Forces on rollers, which are one channel: the effect of facets at a place does not depend on the
    /// roller.
    forces: Vec<Vec<f64>>,
}

/// A comb tried on the channels.
#[derive(Debug, Clone)]
pub(super) struct Trial {
    /// Offset of the best fit at home [Hz].
    pub(super) offset_hz: f64,
    /// Offset of the best fit of the whole scan [Hz].
    pub(super) highest_hz: f64,
    /// Standard deviation of the single channels' best offsets [Hz].
    pub(super) scatter_hz: f64,
    /// Score of the best fit at home.
    pub(super) score: f64,
    /// Highest score of a comb that is off its place.
    pub(super) rival: f64,
    /// Whether the scan has its maximum at home.
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

/// Numbers of the rollers whose forces are looked at, from 0, ascending.
pub(super) fn observed(motion: &RecordedMotion) -> Vec<usize> {
    let mean = |n: usize| mean(&motion.rollers[n].load_n);
    let mut rollers: Vec<usize> = (0..motion.rollers.len()).collect();
    rollers.sort_by(|&a, &b| mean(b).total_cmp(&mean(a)));
    let fullest = rollers.first().map_or(0.0, |&n| mean(n));
    rollers.retain(|&n| fullest > 0.0 && mean(n) >= LOADED * fullest);
    rollers.truncate(OBSERVED);
    rollers.sort_unstable();
    rollers
}

impl Channels {
    /// The accelerations less their mean, and the forces on the rollers `observed` less their running mean
    /// over two periods of `slowest_hz`.
    pub(super) fn of(
        motion: &RecordedMotion,
        accelerations: &[Channel],
        observed: &[usize],
        slowest_hz: f64,
    ) -> Self {
        let centred = |channel: &Channel| {
            let mean = mean(&channel.values);
            channel.values.iter().map(|v| v - mean).collect()
        };
        let width = (2.0 / (slowest_hz * motion.interval_s)).round() as usize;
        let ripple = |&n: &usize| {
            let load = &motion.rollers[n].load_n;
            let slow = smoothed(load, width);
            let least = PRESSED * slow.iter().copied().fold(0.0, f64::max);
            load.iter().zip(&slow).map(|(l, s)| if *s > least { l - s } else { 0.0 }).collect()
        };
        Self {
            accelerations: accelerations.iter().map(centred).collect(),
            forces: observed.iter().map(ripple).collect(),
        }
    }

    /// Tries a comb beside those that are in the fit with their offsets [Hz].
    pub(super) fn try_comb(
        &self,
        motion: &RecordedMotion,
        comb: &BasebandComb,
        in_fit: &[(&BasebandComb, f64)],
    ) -> Trial {
        let resolution_hz = motion.resolution_hz();
        let base = self.at_baseband(comb);
        let home = fit(in_fit, &[comb.rate_hz]).remove(0);
        let signals = base.in_band(comb, &[0.0]).remove(0);
        let offsets_hz = offsets(motion, !in_fit.is_empty());
        let shares = signals.scanned(comb, &home, &offsets_hz);
        let scan: Vec<(f64, Vec<f64>)> = offsets_hz.into_iter().zip(shares).collect();
        let within =
            |hz: f64| move |n: &usize, scan: &[(f64, Vec<f64>)]| scan[*n].0.abs() <= hz * (1.0 + 1e-9);
        let best_of = |reach_hz: f64, score: &dyn Fn(usize) -> f64| {
            let allowed = (0..scan.len()).filter(|n| within(reach_hz)(n, &scan));
            allowed.max_by(|&a, &b| score(a).total_cmp(&score(b))).unwrap_or(0)
        };
        let whole = |n: usize| score(&scan[n].1);
        let best = best_of(AT_HOME * resolution_hz, &whole);
        let highest = best_of(SCAN * motion.bpfo_hz, &whole);
        let beside = (0..scan.len())
            .filter(|n| !in_fit.is_empty() && !within(CLOSE * resolution_hz)(n, &scan))
            .map(whole);
        // About its own centre a detuned comb has the columns that it has at home.
        let own = comb.columns([(0.0, comb.rate_hz)].into_iter()).remove(0);
        let alone = Columns::default().extension(own.clone());
        let detuned: Vec<f64> = DETUNED
            .flat_map(|n| [-n, n])
            .map(|n| f64::from(n) * DETUNED_STEP * motion.bpfo_hz)
            .filter(|offset_hz| comb.baseband.fits(motion, comb.rate_hz + offset_hz))
            .collect();
        let detuned = detuned.chunks(AT_ONCE).flat_map(|offsets_hz| {
            let centres_hz: Vec<f64> = offsets_hz.iter().map(|offset_hz| comb.rate_hz + offset_hz).collect();
            base.in_band(comb, offsets_hz).into_iter().zip(fit(in_fit, &centres_hz))
        });
        let detuned = detuned.map(|(signals, fit)| {
            let more = if in_fit.is_empty() { &alone } else { &fit.extension(own.clone()) };
            score(&signals.shares(&fit, more))
        });
        let rival = beside.chain(detuned).fold(0.0, f64::max);
        let channels = scan[best].1.len();
        let squares = (0..channels).map(|channel| {
            let single = best_of(CLOSE * resolution_hz, &|n| scan[n].1[channel]);
            (scan[single].0 - scan[best].0).powi(2)
        });
        let (forces, accelerations) = scan[best].1.split_last().unwrap_or((&0.0, &[]));
        Trial {
            offset_hz: scan[best].0,
            highest_hz: scan[highest].0,
            scatter_hz: (squares.sum::<f64>() / channels as f64).sqrt(),
            score: whole(best),
            rival,
            at_home: within(AT_HOME * resolution_hz)(&highest, &scan),
            explained: mean(accelerations),
            explained_forces: *forces,
        }
    }

    /// At the baseband of a comb.
    fn at_baseband(&self, comb: &BasebandComb) -> Base {
        let of = |values: &Vec<f64>| comb.baseband.of_signal(values);
        Base {
            accelerations: self.accelerations.iter().map(of).collect(),
            forces: self.forces.iter().map(of).collect(),
        }
    }
}

/// Orthonormal columns of combs with their offsets [Hz], in the bands about each of `centres_hz`.
fn fit(combs: &[(&BasebandComb, f64)], centres_hz: &[f64]) -> Vec<Columns> {
    let mut fits = vec![Columns::default(); centres_hz.len()];
    for (comb, offset_hz) in combs {
        let columns = comb.columns(centres_hz.iter().map(|centre_hz| (*offset_hz, *centre_hz)));
        for (fit, columns) in fits.iter_mut().zip(columns) {
            let more = fit.extension(columns);
            fit.append(more);
        }
    }
    fits
}

/// The channels at the baseband of a comb.
struct Base {
    accelerations: Vec<Signal>,
    forces: Vec<Signal>,
}

impl Base {
    /// In the bands each of `offsets_hz` off the comb's own.
    fn in_band(&self, comb: &BasebandComb, offsets_hz: &[f64]) -> Vec<Signals> {
        let all: Vec<&Signal> = self.accelerations.iter().chain(&self.forces).collect();
        let hz: Vec<f64> = offsets_hz.iter().map(|offset_hz| -offset_hz).collect();
        let signals = |averages: Vec<Signal>| {
            let mut averages = averages.into_iter();
            let accelerations = averages.by_ref().take(self.accelerations.len()).collect();
            Signals { accelerations, forces: Signal::joined(averages) }
        };
        comb.baseband.bands(&all, &hz).into_iter().map(signals).collect()
    }
}

/// Mean of −ln(1 − R² + [`LEAST_REST`]) over the accelerations plus that of the forces, which are the last.
fn score(shares: &[f64]) -> f64 {
    let scores: Vec<f64> = shares.iter().map(|r2| -(1.0 - r2 + LEAST_REST).ln()).collect();
    let (forces, accelerations) = scores.split_last().unwrap_or((&0.0, &[]));
    mean(accelerations) + forces
}

/// Offsets of the scan [Hz], ascending; `beside` combs in the fit they reach farther.
fn offsets(motion: &RecordedMotion, beside: bool) -> Vec<f64> {
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
