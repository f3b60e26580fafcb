//! The comb of one family at baseband: its columns, and the frequency of its carrier.

use std::f64::consts::TAU;

use super::kernels::{Complex, LowPass, Signal, dot, orthogonalise, square, times, turned, unit};
use super::products::products;
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
pub(super) const INDEPENDENT: f64 = 1e-6;
/// Shifts for which signals are read together: their tables lie near the processor, and what comes of them is
/// in memory at once.
pub(super) const AT_ONCE: usize = 8;
/// Averages of which inner products are added up: they change with the offset as little as one average does.
const AVERAGES_A_BLOCK: usize = 8;
/// Steps in a resolution in which the carrier is sought.
const CARRIER_STEPS: f64 = 20.0;

/// A family at baseband, turned back by the mean rate of its facets.
pub(super) struct BasebandComb {
    /// Mean rate of the facets at loaded contacts [Hz].
    pub(super) rate_hz: f64,
    /// The line of the comb next to it [Hz]: rollers that do not pass their facets together have none at the
    /// mean rate.
    pub(super) line_hz: f64,
    pub(super) baseband: Baseband,
    /// Sums over all rollers, one a column: the terms of accelerations.
    sums: Vec<Signal>,
    /// Contribution of each observed roller, one a column and roller: the terms of the force on it.
    own: Vec<Vec<Signal>>,
}

/// Columns of one or more combs in a band: for accelerations, and for the forces on all rollers, one behind
/// the other.
#[derive(Debug, Clone, Default)]
pub(super) struct Columns {
    pub(super) sums: Vec<Signal>,
    pub(super) own: Vec<Signal>,
}

impl Columns {
    /// The part of `columns` that is orthogonal to these, orthonormal.
    pub(super) fn extension(&self, columns: Self) -> Self {
        Self { sums: extension(&self.sums, columns.sums), own: extension(&self.own, columns.own) }
    }

    pub(super) fn append(&mut self, more: Self) {
        self.sums.extend(more.sums);
        self.own.extend(more.own);
    }
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
        let mut sums = vec![Signal::constant((0.0, 0.0), length); COLUMNS];
        let mut own = vec![vec![Signal::default(); observed.len()]; COLUMNS];
        for (number, ((roller, phase), load)) in motion.rollers.iter().zip(&phases).zip(&loads).enumerate() {
            let sound = |n: usize| {
                let weight = load[n] / largest;
                let turned = unit(phase[n]);
                (weight * turned.0, weight * turned.1)
            };
            let sound = baseband.of_samples(sound, samples);
            for column in 0..COLUMNS {
                let part: Signal = sound
                    .iter()
                    .enumerate()
                    .map(|(n, value)| {
                        let by = of_place(column, roller.orbit[baseband.sample(n)]);
                        (by * value.0, by * value.1)
                    })
                    .collect();
                sums[column].add(&part);
                if let Some(at) = observed.iter().position(|&heard| heard == number) {
                    own[column][at] = part;
                }
            }
        }
        let mut comb = Self { rate_hz, line_hz: rate_hz, baseband, sums, own };
        comb.line_hz += comb.nearest_line_hz(motion);
        Some(comb)
    }

    /// Its columns for each pair of `detuned`: how far it is detuned, and the centre of the band [Hz].
    pub(super) fn columns(&self, detuned: impl Iterator<Item = (f64, f64)>) -> Vec<Columns> {
        let signals: Vec<&Signal> = self.sums.iter().chain(self.own.iter().flatten()).collect();
        let shift = |(offset_hz, centre_hz): (f64, f64)| self.rate_hz + offset_hz - centre_hz;
        let hz: Vec<f64> = detuned.map(shift).collect();
        let rollers = self.own.first().map_or(0, Vec::len);
        let columns = |averages: Vec<Signal>| {
            let mut averages = averages.into_iter();
            let sums = averages.by_ref().take(COLUMNS).collect();
            let own = (0..COLUMNS).map(|_| Signal::joined(averages.by_ref().take(rollers))).collect();
            Columns { sums, own }
        };
        self.baseband.bands(&signals, &hz).into_iter().map(columns).collect()
    }

    pub(super) fn blocks(&self) -> Blocks {
        self.baseband.blocks(self.sums[0].len())
    }

    /// Where lines BPFO apart explain the sums best, within half a BPFO of the mean rate [Hz from it].
    fn nearest_line_hz(&self, motion: &RecordedMotion) -> f64 {
        let sums: Vec<&Signal> = self.sums.iter().collect();
        let columns = self.baseband.bands(&sums, &[0.0]).remove(0);
        let step_hz = motion.resolution_hz() / CARRIER_STEPS;
        let reach = (0.5 * motion.bpfo_hz / step_hz).floor() as i32;
        let steady = Signal::constant((1.0, 0.0), self.baseband.length(motion.samples()));
        let places: Vec<f64> = (-SIDEBANDS..=SIDEBANDS).map(|m| f64::from(m) * motion.bpfo_hz).collect();
        let lines = self.baseband.bands(&[&steady], &places).into_iter().flatten().collect();
        // Lines that are shifted together keep their angles: one basis serves all places, and columns are
        // shifted back.
        let basis = extension(&[], lines);
        let interval_s = self.baseband.filter.step() as f64 * self.baseband.interval_s;
        let explained = |hz: f64| -> f64 {
            columns.iter().map(|column| power(&basis, &turned(column.clone(), -hz, interval_s))).sum()
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
        let samples = (1.0 / (half_hz * interval_s)).round() as usize;
        let filter = LowPass::new(samples.clamp(1, (motion.samples() / thin).max(1)), OVERLAP);
        Self { centre_hz, half_hz, thin, interval_s, filter }
    }

    /// Whether the band about `centre_hz` lies between zero and half the sampling rate, and the record
    /// outlasts the filter by more than a comb's columns.
    pub(super) fn fits(&self, motion: &RecordedMotion, centre_hz: f64) -> bool {
        centre_hz > self.half_hz
            && centre_hz + self.half_hz < 0.5 / motion.interval_s
            && self.filter.length() >= OVERLAP
            && self.length(motion.samples()) > self.filter.length() * (1 + COLUMNS)
    }

    fn length(&self, samples: usize) -> usize {
        samples / self.thin
    }

    /// The sample of the record in the middle of number `n`.
    fn sample(&self, n: usize) -> usize {
        n * self.thin + self.thin / 2
    }

    /// The mean of `at` over every few samples, turned back.
    fn of_samples(&self, at: impl Fn(usize) -> Complex, samples: usize) -> Signal {
        let step_s = self.interval_s / self.thin as f64;
        let turned = turned((0..samples).map(at).collect(), -self.centre_hz, step_s);
        let mut turned = turned.iter();
        let mean = |_| {
            let part = turned.by_ref().take(self.thin);
            let sum = part.fold((0.0, 0.0), |sum, v| (sum.0 + v.0, sum.1 + v.1));
            (sum.0 / self.thin as f64, sum.1 / self.thin as f64)
        };
        (0..self.length(samples)).map(mean).collect()
    }

    pub(super) fn of_signal(&self, values: &[f64]) -> Signal {
        self.of_samples(|n| (values[n], 0.0), values.len())
    }

    /// Signals of the baseband in the band about its centre, after a shift up by each of `hz`.
    pub(super) fn bands(&self, signals: &[&Signal], hz: &[f64]) -> Vec<Vec<Signal>> {
        hz.chunks(AT_ONCE).flat_map(|hz| self.filter.shifted(signals, hz, self.interval_s)).collect()
    }

    /// Blocks of the averages over `samples` of the baseband.
    fn blocks(&self, samples: usize) -> Blocks {
        let filter_s = (self.filter.length() - 1) as f64 * self.interval_s;
        let block_s = (AVERAGES_A_BLOCK - 1) as f64 * self.filter.step() as f64 * self.interval_s;
        Blocks {
            averages: self.filter.count(samples),
            interval_s: (AVERAGES_A_BLOCK * self.filter.step()) as f64 * self.interval_s,
            middle_s: 0.5 * (filter_s + block_s),
            reach_s: 0.5 * filter_s + 0.5 * block_s.max(filter_s),
        }
    }
}

/// Blocks of [`AVERAGES_A_BLOCK`] averages of a band.
pub(super) struct Blocks {
    averages: usize,
    /// From one to the next [s].
    interval_s: f64,
    /// Middle of the first, from the beginning [s].
    middle_s: f64,
    /// Longest time from a sample to the middle of its block, or to another sample of the same average [s].
    pub(super) reach_s: f64,
}

impl Blocks {
    pub(super) fn count(&self) -> usize {
        self.averages.div_ceil(AVERAGES_A_BLOCK)
    }

    /// Σ ā b over each block; over signals that lie one behind the other, too.
    pub(super) fn sums(&self, a: &Signal, b: &Signal) -> Signal {
        products(a, b, self.averages, AVERAGES_A_BLOCK)
    }

    /// One value a block, times exp 2πi f t.
    pub(super) fn turned(&self, values: Signal, hz: f64) -> Signal {
        let first = unit(TAU * hz * self.middle_s);
        turned(values, hz, self.interval_s).iter().map(|value| times(first, value)).collect()
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

/// Power of a signal in the span of orthonormal columns.
pub(super) fn power(basis: &[Signal], signal: &Signal) -> f64 {
    basis.iter().map(|q| square(dot(q, signal))).sum()
}

/// The part of `columns` that is orthogonal to `basis`, orthonormal.
fn extension(basis: &[Signal], columns: Vec<Signal>) -> Vec<Signal> {
    let longest = columns.iter().map(|c| dot(c, c).0).fold(0.0, f64::max);
    let mut more = Vec::new();
    for mut rest in columns {
        orthogonalise(&mut rest, [basis, &more]);
        let length = dot(&rest, &rest).0;
        if length > INDEPENDENT * INDEPENDENT * longest {
            more.push(rest.scaled(1.0 / length.sqrt()));
        }
    }
    more
}
