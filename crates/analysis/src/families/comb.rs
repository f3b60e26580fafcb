//! The comb of one family at baseband: what it is made of, and how much of a signal it explains.

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

/// Columns of a family, turned back by the carrier.
pub(super) struct Comb {
    /// Mean rate of the facets, weighted by load [Hz].
    pub(super) carrier_hz: f64,
    /// Half width of the band in which signals are looked at [Hz].
    pub(super) half_band_hz: f64,
    columns: Vec<Vec<Complex>>,
    filter: LowPass,
    /// Orthonormal columns of the band signals, and the columns that they are made of.
    basis: Vec<Vec<Complex>>,
    band: Vec<Vec<Complex>>,
}

impl Comb {
    /// `None` when no roller is loaded, the record is shorter than the filter, or the band does not fit below half the
    /// sampling rate.
    pub(super) fn of(motion: &Motion, source: Source) -> Option<Self> {
        let samples = motion.samples();
        let dt = motion.interval_s;
        let half_band_hz = HALF_BAND * motion.bpfo_hz;
        let filter = LowPass::new(half_band_hz, dt, samples)?;
        let phases: Vec<Vec<f64>> = motion
            .rollers
            .iter()
            .map(|roller| (0..samples).map(|n| source.phase(motion, roller, n)).collect())
            .collect();
        let carrier_hz = carrier(motion, &phases)?;
        if carrier_hz - half_band_hz <= 0.0 || carrier_hz + half_band_hz >= 0.5 / dt {
            return None;
        }
        let width = (1.0 / (carrier_hz * dt)).round().max(1.0) as usize;
        let loads: Vec<Vec<f64>> = motion.rollers.iter().map(|r| smoothed(&r.load_n, width)).collect();
        let largest = loads.iter().flatten().copied().fold(0.0, f64::max);
        if largest <= 0.0 {
            return None;
        }
        let count = 1 + 2 * ORDERS as usize;
        let mut columns = vec![vec![(0.0, 0.0); samples]; count];
        for ((roller, phase), load) in motion.rollers.iter().zip(&phases).zip(&loads) {
            for n in 0..samples {
                let weight = load[n] / largest;
                if weight <= 0.0 {
                    continue;
                }
                let turned = unit(phase[n] - TAU * carrier_hz * dt * n as f64);
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
        let band: Vec<Vec<Complex>> = columns.iter().map(|c| filter.apply(|n| c[n])).collect();
        let basis = orthonormal(&band);
        Some(Self { carrier_hz, half_band_hz, columns, filter, basis, band })
    }

    /// Share R² of `signal` in the band about the carrier and `offset_hz` that the columns explain, 0 to 1.
    pub(super) fn explained(&self, signal: &[f64], interval_s: f64, offset_hz: f64) -> f64 {
        let seen = self.to_band(signal, interval_s, offset_hz);
        let total = dot(&seen, &seen).0;
        if total <= 0.0 {
            return 0.0;
        }
        let explained: f64 = self.basis.iter().map(|q| dot(q, &seen)).map(|c| c.0 * c.0 + c.1 * c.1).sum();
        (explained / total).min(1.0)
    }

    /// Power of a signal in the band about the carrier, in any unit.
    pub(super) fn power(&self, signal: &[f64], interval_s: f64) -> f64 {
        let seen = self.to_band(signal, interval_s, 0.0);
        dot(&seen, &seen).0
    }

    /// Weights of the columns that explain `signal` best.
    pub(super) fn weights(&self, signal: &[f64], interval_s: f64, offset_hz: f64) -> Vec<Complex> {
        let seen = self.to_band(signal, interval_s, offset_hz);
        least_squares(&self.band, &seen)
    }

    /// Weighted sum of the columns at sample `n`.
    pub(super) fn sum(&self, weights: &[Complex], n: usize) -> Complex {
        weights.iter().zip(&self.columns).fold((0.0, 0.0), |sum, (w, c)| {
            let term = times(*w, c[n]);
            (sum.0 + term.0, sum.1 + term.1)
        })
    }

    fn to_band(&self, signal: &[f64], interval_s: f64, offset_hz: f64) -> Vec<Complex> {
        let step = unit(-TAU * (self.carrier_hz + offset_hz) * interval_s);
        let mut turn: Complex = (1.0, 0.0);
        let mixed: Vec<Complex> = signal
            .iter()
            .map(|v| {
                let mixed = (v * turn.0, v * turn.1);
                turn = times(turn, step);
                mixed
            })
            .collect();
        self.filter.apply(|n| mixed[n])
    }
}

/// Load-weighted mean rate of the phases [Hz]; `None` when nothing is loaded or nothing turns.
fn carrier(motion: &Motion, phases: &[Vec<f64>]) -> Option<f64> {
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

/// Running mean over `width` samples, cut at zero: the load without its tone.
fn smoothed(load: &[f64], width: usize) -> Vec<f64> {
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
    samples: usize,
}

impl LowPass {
    fn new(half_band_hz: f64, interval_s: f64, samples: usize) -> Option<Self> {
        let length = (1.0 / (half_band_hz * interval_s)).round() as usize;
        if length < OVERLAP || length + OVERLAP * 2 * (1 + 2 * ORDERS as usize) > samples {
            return None;
        }
        let taps: Vec<f64> = (1..=length)
            .map(|n| (std::f64::consts::PI * n as f64 / (length + 1) as f64).sin().powi(2))
            .collect();
        let sum: f64 = taps.iter().sum();
        Some(Self { taps: taps.iter().map(|t| t / sum).collect(), step: (length / OVERLAP).max(1), samples })
    }

    fn apply(&self, at: impl Fn(usize) -> Complex) -> Vec<Complex> {
        (0..=self.samples - self.taps.len())
            .step_by(self.step)
            .map(|from| {
                self.taps.iter().enumerate().fold((0.0, 0.0), |sum, (n, tap)| {
                    let value = at(from + n);
                    (sum.0 + tap * value.0, sum.1 + tap * value.1)
                })
            })
            .collect()
    }
}

/// Gram–Schmidt, twice for rounding; what depends on earlier columns is left out.
fn orthonormal(columns: &[Vec<Complex>]) -> Vec<Vec<Complex>> {
    let longest = columns.iter().map(|c| dot(c, c).0).fold(0.0, f64::max);
    let mut basis: Vec<Vec<Complex>> = Vec::new();
    for column in columns {
        let mut rest = column.clone();
        for _ in 0..2 {
            for q in &basis {
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
    basis
}

/// Weights of `columns` whose sum is nearest to `wanted`, by the normal equations; a column that adds nothing weighs nothing.
fn least_squares(columns: &[Vec<Complex>], wanted: &[Complex]) -> Vec<Complex> {
    let count = columns.len();
    let mut rows: Vec<Vec<Complex>> = columns
        .iter()
        .map(|row| columns.iter().map(|column| dot(row, column)).chain([dot(row, wanted)]).collect())
        .collect();
    let largest = (0..count).map(|n| rows[n][n].0).fold(0.0, f64::max);
    let mut weights = vec![(0.0, 0.0); count];
    let mut used = vec![false; count];
    // The matrix is Hermitian and not negative, so its diagonal serves as pivots.
    for n in 0..count {
        if rows[n][n].0 <= INDEPENDENT * INDEPENDENT * largest {
            continue;
        }
        used[n] = true;
        let pivot = 1.0 / rows[n][n].0;
        let own: Vec<Complex> = rows[n].iter().map(|v| (v.0 * pivot, v.1 * pivot)).collect();
        for (m, row) in rows.iter_mut().enumerate() {
            if m == n {
                row.clone_from(&own);
            } else {
                let by = row[n];
                for (value, own) in row.iter_mut().zip(&own) {
                    let part = times(by, *own);
                    *value = (value.0 - part.0, value.1 - part.1);
                }
            }
        }
    }
    for n in (0..count).filter(|&n| used[n]) {
        weights[n] = rows[n][count];
    }
    weights
}

/// Σ ā b.
fn dot(a: &[Complex], b: &[Complex]) -> Complex {
    a.iter()
        .zip(b)
        .fold((0.0, 0.0), |sum, (a, b)| (sum.0 + a.0 * b.0 + a.1 * b.1, sum.1 + a.0 * b.1 - a.1 * b.0))
}

pub(super) fn times(a: Complex, b: Complex) -> Complex {
    (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0)
}

/// e^{iφ}.
pub(super) fn unit(phase: f64) -> Complex {
    let (sin, cos) = phase.sin_cos();
    (cos, sin)
}
