//! The comb of one family at baseband: its columns, and the frequency of its carrier.

use std::f64::consts::{PI, TAU};

use super::kernels::{Complex, Shift, dot, orthogonalise, turned, unit};
use super::{RecordedMotion, SIDEBANDS, Source};

/// Highest multiple of twice the place angle: the load zone is a few rollers wide.
const ORDERS: i32 = 3;
/// Columns of a comb.
const COLUMNS: usize = 1 + 2 * ORDERS as usize;
/// Half width of the band at −6 dB, in BPFO.
const HALF_BAND: f64 = 8.0;
/// Samples of the band signal in the length of the low-pass filter, and of the baseband that it is made from.
const OVERLAP: usize = 4;
const FINE: usize = 8 * OVERLAP;
/// Least norm of a column, over that of the longest, after orthogonalisation: shorter ones are dropped as
/// dependent.
const INDEPENDENT: f64 = 1e-6;
/// Steps in a resolution in which the carrier is sought.
const CARRIER_STEPS: f64 = 20.0;

/// A family at baseband, turned back by the mean rate of its facets.
pub(super) struct BasebandComb {
    /// Mean rate of the facets at loaded contacts [Hz].
    pub(super) rate_hz: f64,
    /// The line of the comb next to it [Hz]: rollers that do not pass their facets together have none at the
    /// mean rate.
    pub(super) line_hz: f64,
    /// The baseband itself.
    pub(super) baseband: Baseband,
    /// Sums over all rollers, one a column: the terms of accelerations.
    sums: Vec<Vec<Complex>>,
    /// Contribution of each observed roller, one a column and roller: the terms of the force on it.
    own: Vec<Vec<Vec<Complex>>>,
}

/// Columns of one or more combs in a band: for accelerations, and for the forces on all rollers, one behind
/// the other.
#[derive(Debug, Clone, Default)]
pub(super) struct Columns {
    pub(super) sums: Vec<Vec<Complex>>,
    pub(super) own: Vec<Vec<Complex>>,
}

impl BasebandComb {
    /// `None` when no roller is loaded, the record is shorter than the filter, or the band does not fit below
    /// half the sampling rate. `observed` are the rollers whose forces are fitted.
    pub(super) fn of(motion: &RecordedMotion, source: Source, observed: &[usize]) -> Option<Self> {
        let samples = motion.samples();
        let dt = motion.interval_s;
        let phases: Vec<Vec<f64>> = motion
            .rollers
            .iter()
            .map(|roller| (0..samples).map(|n| source.phase(motion, roller, n)).collect())
            .collect();
        let rate_hz = mean_rate_hz(motion, &phases)?;
        let baseband = Baseband::new(motion, rate_hz);
        if !baseband.fits(motion, rate_hz) {
            return None;
        }
        let width = (1.0 / (rate_hz * dt)).round().max(1.0) as usize;
        let loads: Vec<Vec<f64>> = motion.rollers.iter().map(|r| smoothed(&r.load_n, width)).collect();
        let largest = loads.iter().flatten().copied().fold(0.0, f64::max);
        if largest <= 0.0 {
            return None;
        }
        let length = baseband.length(samples);
        let mut sums = vec![vec![(0.0, 0.0); length]; COLUMNS];
        let mut own = vec![vec![Vec::new(); observed.len()]; COLUMNS];
        for (number, ((roller, phase), load)) in motion.rollers.iter().zip(&phases).zip(&loads).enumerate() {
            let sound = |n: usize| {
                let weight = load[n] / largest;
                let turned = unit(phase[n]);
                (weight * turned.0, weight * turned.1)
            };
            let sound = baseband.of_samples(sound, samples);
            for column in 0..COLUMNS {
                let part: Vec<Complex> = sound
                    .iter()
                    .enumerate()
                    .map(|(n, value)| {
                        let by = of_place(column, roller.orbit[baseband.sample(n)]);
                        (by * value.0, by * value.1)
                    })
                    .collect();
                add(&mut sums[column], &part);
                if let Some(at) = observed.iter().position(|&heard| heard == number) {
                    own[column][at] = part;
                }
            }
        }
        let mut comb = Self { rate_hz, line_hz: rate_hz, baseband, sums, own };
        comb.line_hz += comb.nearest_line_hz(motion);
        Some(comb)
    }

    /// Its columns in the band about `centre_hz`, when it is detuned by `offset_hz`.
    pub(super) fn columns(&self, offset_hz: f64, centre_hz: f64) -> Columns {
        let length = self.sums.first().map_or(0, Vec::len);
        let mut shift = self.baseband.shift(self.rate_hz + offset_hz - centre_hz, length);
        let mut band = |values: &Vec<Complex>| shift.apply(values);
        Columns {
            sums: self.sums.iter().map(&mut band).collect(),
            own: self.own.iter().map(|rollers| rollers.iter().flat_map(&mut band).collect()).collect(),
        }
    }

    /// Where lines BPFO apart explain the sums best, within half a BPFO of the mean rate [Hz from it].
    fn nearest_line_hz(&self, motion: &RecordedMotion) -> f64 {
        let columns = self.columns(0.0, self.rate_hz).sums;
        let step_hz = motion.resolution_hz() / CARRIER_STEPS;
        let reach = (0.5 * motion.bpfo_hz / step_hz).floor() as i32;
        let steady = vec![(1.0, 0.0); self.baseband.length(motion.samples())];
        let lines: Vec<Vec<Complex>> = (-SIDEBANDS..=SIDEBANDS)
            .map(|m| self.baseband.shift(f64::from(m) * motion.bpfo_hz, steady.len()).apply(&steady))
            .collect();
        // Lines that are shifted together keep their angles: one basis serves all places, and columns are
        // shifted back.
        let mut basis = Vec::new();
        extend_basis(&mut basis, &lines);
        let interval_s = self.baseband.filter.step as f64 * self.baseband.interval_s;
        let explained = |hz: f64| -> f64 {
            columns.iter().map(|column| power(&basis, &turned(column, -hz, interval_s))).sum()
        };
        let all = (-reach..=reach).map(|n| f64::from(n) * step_hz).map(|hz| (hz, explained(hz)));
        all.max_by(|a, b| a.1.total_cmp(&b.1)).map_or(0.0, |(hz, _)| hz)
    }
}

/// Weight of a column at a place: 1, cos 2θ, sin 2θ, cos 4θ and so on.
fn of_place(column: usize, place: f64) -> f64 {
    let angle = 2.0 * column.div_ceil(2) as f64 * place;
    if column % 2 == 1 {
        angle.cos()
    } else if column == 0 {
        1.0
    } else {
        angle.sin()
    }
}

/// Signals turned back by a frequency and thinned out, and the low-pass filter that takes a band of
/// [`HALF_BAND`] BPFO on either side out of them.
pub(super) struct Baseband {
    centre_hz: f64,
    half_hz: f64,
    /// Samples of the record in one of these.
    thin: usize,
    /// Time between two of these [s].
    interval_s: f64,
    filter: LowPass,
}

impl Baseband {
    fn new(motion: &RecordedMotion, centre_hz: f64) -> Self {
        let half_hz = HALF_BAND * motion.bpfo_hz;
        let thin = ((1.0 / (half_hz * motion.interval_s)) as usize / FINE).max(1);
        let interval_s = thin as f64 * motion.interval_s;
        let filter = LowPass::new(half_hz, interval_s, motion.samples() / thin);
        Self { centre_hz, half_hz, thin, interval_s, filter }
    }

    /// Whether the band about `centre_hz` lies between zero and half the sampling rate, and the record
    /// outlasts the filter by more than a comb's columns.
    pub(super) fn fits(&self, motion: &RecordedMotion, centre_hz: f64) -> bool {
        centre_hz > self.half_hz
            && centre_hz + self.half_hz < 0.5 / motion.interval_s
            && self.filter.taps.len() >= OVERLAP
            && self.length(motion.samples()) > self.filter.taps.len() * (1 + COLUMNS)
    }

    fn length(&self, samples: usize) -> usize {
        samples / self.thin
    }

    /// The sample of the record in the middle of number `n`.
    fn sample(&self, n: usize) -> usize {
        n * self.thin + self.thin / 2
    }

    /// The mean of `at` over every few samples, turned back.
    fn of_samples(&self, at: impl Fn(usize) -> Complex, samples: usize) -> Vec<Complex> {
        let step_s = self.interval_s / self.thin as f64;
        let values: Vec<Complex> = (0..samples).map(at).collect();
        let turned = turned(&values, -self.centre_hz, step_s);
        let mean = |part: &[Complex]| {
            let sum = part.iter().fold((0.0, 0.0), |sum, v| (sum.0 + v.0, sum.1 + v.1));
            (sum.0 / self.thin as f64, sum.1 / self.thin as f64)
        };
        turned.chunks_exact(self.thin).map(mean).collect()
    }

    /// A recorded signal.
    pub(super) fn of_signal(&self, values: &[f64]) -> Vec<Complex> {
        self.of_samples(|n| (values[n], 0.0), values.len())
    }

    /// Band-pass filter for signals of `values` samples, after a shift up by `hz`.
    pub(super) fn shift(&self, hz: f64, values: usize) -> Shift<'_> {
        Shift::new(hz, self.interval_s, values, &self.filter.taps, self.filter.step)
    }
}

/// Adds `part` to `sum`.
fn add(sum: &mut [Complex], part: &[Complex]) {
    for (sum, part) in sum.iter_mut().zip(part) {
        *sum = (sum.0 + part.0, sum.1 + part.1);
    }
}

/// Load-weighted mean rate of the phases [Hz]; `None` when nothing is loaded or nothing turns.
fn mean_rate_hz(motion: &RecordedMotion, phases: &[Vec<f64>]) -> Option<f64> {
    let (mut turned, mut weight) = (0.0, 0.0);
    for (roller, phase) in motion.rollers.iter().zip(phases) {
        for n in 1..phase.len() {
            let load = (roller.load_n[n - 1] + roller.load_n[n]).max(0.0);
            turned += load * (phase[n] - phase[n - 1]);
            weight += load * motion.interval_s;
        }
    }
    (weight > 0.0).then(|| turned / weight / TAU).filter(|hz| *hz > 0.0)
}

/// Running mean of a load over `width` samples, cut at zero: the load without its tone.
pub(super) fn smoothed(load: &[f64], width: usize) -> Vec<f64> {
    let half = width / 2;
    let mut sums = vec![0.0];
    for value in load {
        sums.push(sums[sums.len() - 1] + value);
    }
    (0..load.len())
        .map(|n| {
            let (from, to) = (n.saturating_sub(half), (n + half + 1).min(load.len()));
            ((sums[to] - sums[from]) / (to - from) as f64).max(0.0)
        })
        .collect()
}

/// A Hann-shaped average, taken [`OVERLAP`] times in its length.
struct LowPass {
    taps: Vec<f64>,
    step: usize,
}

impl LowPass {
    fn new(half_band_hz: f64, interval_s: f64, samples: usize) -> Self {
        let length = ((1.0 / (half_band_hz * interval_s)).round() as usize).clamp(1, samples.max(1));
        let taps: Vec<f64> =
            (1..=length).map(|n| (PI * n as f64 / (length + 1) as f64).sin().powi(2)).collect();
        let sum: f64 = taps.iter().sum();
        Self { taps: taps.iter().map(|t| t / sum).collect(), step: (length / OVERLAP).max(1) }
    }
}

/// Power of a signal in the span of orthonormal columns.
pub(super) fn power(basis: &[Vec<Complex>], signal: &[Complex]) -> f64 {
    basis.iter().map(|q| dot(q, signal)).map(|c| c.0 * c.0 + c.1 * c.1).sum()
}

/// Extends `basis` by the part of `columns` that is orthogonal to it, normalised.
pub(super) fn extend_basis(basis: &mut Vec<Vec<Complex>>, columns: &[Vec<Complex>]) {
    let longest = columns.iter().map(|c| dot(c, c).0).fold(0.0, f64::max);
    for column in columns {
        let mut rest = column.clone();
        orthogonalise(&mut rest, basis);
        let length = dot(&rest, &rest).0;
        if length > INDEPENDENT * INDEPENDENT * longest {
            let scale = 1.0 / length.sqrt();
            basis.push(rest.iter().map(|r| (r.0 * scale, r.1 * scale)).collect());
        }
    }
}
