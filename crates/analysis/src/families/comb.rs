//! The comb of one family at baseband: what it is made of, and where its carrier stands.

use std::f64::consts::TAU;

use super::{Motion, Source};

/// Real and imaginary part.
pub(super) type Complex = (f64, f64);

/// Highest multiple of twice the place angle: the load zone is a few rollers wide.
const ORDERS: i32 = 3;
/// Half width of the band at −6 dB, in BPFO.
const HALF_BAND: f64 = 8.0;
/// Samples of the band signal in the length of the low-pass filter.
const OVERLAP: usize = 4;
/// Columns shorter than this part of the longest, after what they share with the others is taken off, carry nothing new.
const INDEPENDENT: f64 = 1e-6;
/// Steps in a resolution in which the carrier is sought.
const CARRIER_STEPS: f64 = 20.0;

/// Columns of a family, turned back by the mean rate of its facets.
pub(super) struct Comb {
    /// Mean rate of the facets at loaded contacts [Hz].
    pub(super) rate_hz: f64,
    /// The line of the comb next to it [Hz]: rollers that do not pass their facets together have none at the mean rate.
    pub(super) line_hz: f64,
    columns: Vec<Vec<Complex>>,
}

impl Comb {
    /// `None` when no roller is loaded, the record is shorter than the filter, or the band does not fit below half the
    /// sampling rate.
    pub(super) fn of(motion: &Motion, source: Source) -> Option<Self> {
        let samples = motion.samples();
        let dt = motion.interval_s;
        let phases: Vec<Vec<f64>> = motion
            .rollers
            .iter()
            .map(|roller| (0..samples).map(|n| source.phase(motion, roller, n)).collect())
            .collect();
        let rate_hz = mean_rate_hz(motion, &phases)?;
        if !Band::new(motion, rate_hz).fits(motion) {
            return None;
        }
        let width = (1.0 / (rate_hz * dt)).round().max(1.0) as usize;
        let loads: Vec<Vec<f64>> = motion.rollers.iter().map(|r| smoothed(&r.load_n, width)).collect();
        let largest = loads.iter().flatten().copied().fold(0.0, f64::max);
        if largest <= 0.0 {
            return None;
        }
        let count = 1 + 2 * ORDERS as usize;
        let mut columns = vec![vec![(0.0, 0.0); samples]; count];
        for ((roller, phase), load) in motion.rollers.iter().zip(&phases).zip(&loads) {
            for n in (0..samples).filter(|&n| load[n] > 0.0) {
                let weight = load[n] / largest;
                let turned = unit(phase[n] - TAU * rate_hz * dt * n as f64);
                let mut add = |column: usize, by: f64| {
                    let sum = &mut columns[column][n];
                    *sum = (sum.0 + by * turned.0, sum.1 + by * turned.1);
                };
                add(0, weight);
                for q in 1..=ORDERS {
                    let (sin, cos) = (2.0 * f64::from(q) * roller.orbit[n]).sin_cos();
                    add(2 * q as usize - 1, weight * cos);
                    add(2 * q as usize, weight * sin);
                }
            }
        }
        let line_hz = rate_hz + strongest_hz(&columns[0], motion);
        Some(Self { rate_hz, line_hz, columns })
    }
}

/// A band of [`HALF_BAND`] BPFO on either side of a frequency, at baseband.
pub(super) struct Band {
    centre_hz: f64,
    half_hz: f64,
    interval_s: f64,
    filter: LowPass,
}

impl Band {
    pub(super) fn new(motion: &Motion, centre_hz: f64) -> Self {
        let half_hz = HALF_BAND * motion.bpfo_hz;
        let filter = LowPass::new(half_hz, motion.interval_s, motion.samples());
        Self { centre_hz, half_hz, interval_s: motion.interval_s, filter }
    }

    /// Whether it lies between zero and half the sampling rate, and the record outlasts its filter by more than a comb's
    /// columns.
    pub(super) fn fits(&self, motion: &Motion) -> bool {
        let columns = 1 + 2 * ORDERS as usize;
        self.centre_hz > self.half_hz
            && self.centre_hz + self.half_hz < 0.5 / self.interval_s
            && self.filter.taps.len() >= OVERLAP
            && motion.samples() > self.filter.taps.len() * (1 + columns)
    }

    /// A signal in the band.
    pub(super) fn signal(&self, values: &[f64]) -> Vec<Complex> {
        let mixed =
            turning(-self.centre_hz, self.interval_s).zip(values).map(|(turn, v)| (v * turn.0, v * turn.1));
        self.filter.apply(&mixed.collect::<Vec<_>>())
    }

    /// Columns of a comb that is detuned by `offset_hz`, in the band.
    pub(super) fn columns(&self, comb: &Comb, offset_hz: f64) -> Vec<Vec<Complex>> {
        let shift_hz = comb.rate_hz + offset_hz - self.centre_hz;
        let turned = |column: &Vec<Complex>| {
            let turned =
                turning(shift_hz, self.interval_s).zip(column).map(|(turn, value)| times(turn, *value));
            self.filter.apply(&turned.collect::<Vec<_>>())
        };
        comb.columns.iter().map(turned).collect()
    }
}

/// exp 2πi f t, sample by sample.
fn turning(hz: f64, interval_s: f64) -> impl Iterator<Item = Complex> {
    let step = unit(TAU * hz * interval_s);
    std::iter::successors(Some((1.0, 0.0)), move |turn| Some(times(*turn, step)))
}

/// Where the spectrum of a column is highest within half a BPFO [Hz], with a Hann window.
fn strongest_hz(column: &[Complex], motion: &Motion) -> f64 {
    let step_hz = motion.resolution_hz() / CARRIER_STEPS;
    let reach = (0.5 * motion.bpfo_hz / step_hz).floor() as i32;
    let window = |n: usize| (std::f64::consts::PI * (n as f64 + 0.5) / column.len() as f64).sin().powi(2);
    let windowed: Vec<Complex> =
        column.iter().enumerate().map(|(n, v)| (window(n) * v.0, window(n) * v.1)).collect();
    let power = |hz: f64| {
        let sum = turning(-hz, motion.interval_s).zip(&windowed).fold((0.0, 0.0), |sum, (turn, value)| {
            let term = times(turn, *value);
            (sum.0 + term.0, sum.1 + term.1)
        });
        sum.0 * sum.0 + sum.1 * sum.1
    };
    let highest = (-reach..=reach).map(|n| f64::from(n) * step_hz).map(|hz| (hz, power(hz)));
    highest.max_by(|a, b| a.1.total_cmp(&b.1)).map_or(0.0, |(hz, _)| hz)
}

/// Load-weighted mean rate of the phases [Hz]; `None` when nothing is loaded or nothing turns.
fn mean_rate_hz(motion: &Motion, phases: &[Vec<f64>]) -> Option<f64> {
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
        let tap = |n: usize| (std::f64::consts::PI * n as f64 / (length + 1) as f64).sin().powi(2);
        let taps: Vec<f64> = (1..=length).map(tap).collect();
        let sum: f64 = taps.iter().sum();
        Self { taps: taps.iter().map(|t| t / sum).collect(), step: (length / OVERLAP).max(1) }
    }

    fn apply(&self, values: &[Complex]) -> Vec<Complex> {
        let average = |part: &[Complex]| {
            let pairs = self.taps.iter().zip(part);
            pairs.fold((0.0, 0.0), |sum, (tap, value)| (sum.0 + tap * value.0, sum.1 + tap * value.1))
        };
        values.windows(self.taps.len()).step_by(self.step).map(average).collect()
    }
}

/// Adds what `columns` hold beyond `basis` to it, orthonormal: Gram–Schmidt, twice for rounding.
pub(super) fn extend_basis(basis: &mut Vec<Vec<Complex>>, columns: &[Vec<Complex>]) {
    let longest = columns.iter().map(|c| dot(c, c).0).fold(0.0, f64::max);
    for column in columns {
        let mut rest = column.clone();
        for _ in 0..2 {
            for q in basis.iter() {
                let share = dot(q, &rest);
                for (r, q) in rest.iter_mut().zip(q) {
                    let part = times(share, *q);
                    *r = (r.0 - part.0, r.1 - part.1);
                }
            }
        }
        let length = dot(&rest, &rest).0;
        if length > INDEPENDENT * INDEPENDENT * longest {
            let scale = 1.0 / length.sqrt();
            basis.push(rest.iter().map(|r| (r.0 * scale, r.1 * scale)).collect());
        }
    }
}

/// Σ ā b.
pub(super) fn dot(a: &[Complex], b: &[Complex]) -> Complex {
    a.iter()
        .zip(b)
        .fold((0.0, 0.0), |sum, (a, b)| (sum.0 + a.0 * b.0 + a.1 * b.1, sum.1 + a.0 * b.1 - a.1 * b.0))
}

fn times(a: Complex, b: Complex) -> Complex {
    (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0)
}

/// e^{iφ}.
fn unit(phase: f64) -> Complex {
    let (sin, cos) = phase.sin_cos();
    (cos, sin)
}
