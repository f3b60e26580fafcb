//! Short records of one machine as one: the mean of their squared envelope spectra, in which lines of a defect
//! stay and noise scatters less, without a phase from one record to the next.

use stribeck_dsp::BandEnvelope;

use crate::families::verdict::Candidates;
use crate::record::pass::Record;
use crate::{Analysis, Course, Family, Health, Machine};

/// Records that hold fewer turns are pooled.
const TURNS: f64 = 100.0;
/// Speeds that differ by less than this part have their lines at the same places.
const SAME_SPEED: f64 = 1e-4;

/// Sums over the last four, eight and so on records of a series, and over all.
#[derive(Debug, Default)]
pub struct Pool {
    sums: Vec<Sum>,
    /// The machine of the first record, at whose speed the lines are.
    machine: Option<Machine>,
    /// The last record that was added.
    last: Option<LastRecord>,
    rate_hz: f64,
}

/// Density, course, levels and samples of a record.
type LastRecord = ((Vec<f64>, Vec<f64>), Course, Health, u64);

#[derive(Debug)]
struct Sum {
    /// The first record that counts.
    from: usize,
    records: usize,
    bands: Vec<BandEnvelope>,
}

/// Families of several records together.
#[derive(Debug, Clone, PartialEq)]
pub struct Pooled {
    /// Records at the end of the series.
    pub last: usize,
    /// What the rules say of their mean spectra.
    pub families: Vec<Family>,
}

impl Pool {
    /// For `records` records, of which the first `healthy` are left out.
    pub fn new(records: usize, healthy: usize) -> Self {
        let all = records.saturating_sub(healthy);
        let halves = std::iter::successors(Some(4), |last| Some(2 * last)).take_while(|last| *last < all);
        let ends = halves.chain(Some(all).filter(|all| *all > 1));
        let sums = ends.map(|last| Sum { from: records - last, records: 0, bands: Vec::new() });
        Self { sums: sums.collect(), ..Self::default() }
    }

    /// Adds the record at place `at` of the series, if it is short and its samples are not spoilt.
    pub fn add(&mut self, at: usize, analysis: &Analysis) {
        let Analysis { findings, bands, machine, .. } = analysis;
        let Some(shaft_hz) = findings.speed_rpm.map(|rpm| rpm / 60.0) else { return };
        let is_spoilt = findings.quality.iter().any(|found| found.kind.spoils_verdicts());
        if findings.duration_s * shaft_hz >= TURNS || machine.bearing.is_none() || is_spoilt {
            return;
        }
        let first = self.machine.get_or_insert_with(|| machine.clone());
        let faster = 60.0 * shaft_hz / first.speed_rpm.unwrap_or(f64::NAN);
        self.rate_hz = findings.rate_hz;
        self.last =
            Some((analysis.density.clone(), analysis.course.clone(), findings.health, findings.samples));
        for sum in self.sums.iter_mut().filter(|sum| at >= sum.from) {
            sum.add(bands, faster);
        }
    }

    /// The families of every end of the series of which two records at least were added.
    pub fn judged(self) -> Vec<Pooled> {
        let (Some(machine), Some((density, course, health, count))) = (self.machine, self.last) else {
            return Vec::new();
        };
        let rate_hz = self.rate_hz;
        let of = |sum: Sum| {
            let grid_hz = sum.bands.first()?.grid_hz;
            let record = Record {
                rate_hz,
                count,
                segment: (rate_hz / grid_hz).round() as usize,
                segments: sum.records,
                bands: sum.bands,
                density: density.clone(),
                course: course.clone(),
                velocity_mm_s: None,
                health,
                kept: Vec::new(),
                notes: Vec::new(),
                quality: Vec::new(),
            };
            let families = Candidates::of(&record, &machine, None, false).ok()?.decide().families;
            Some(Pooled { last: sum.records, families })
        };
        self.sums.into_iter().filter(|sum| sum.records > 1).filter_map(of).collect()
    }
}

impl Sum {
    /// Adds the spectra of a record at `faster` times the speed of the first; one of another length or rate is left
    /// out.
    fn add(&mut self, bands: &[BandEnvelope], faster: f64) {
        if self.bands.is_empty() {
            self.bands = bands.to_vec();
            self.bands.iter_mut().for_each(|band| {
                band.values = over_orders(&band.values, faster);
                band.segments = 1;
            });
            self.records = 1;
            return;
        }
        let is_alike =
            |(a, b): (&BandEnvelope, &BandEnvelope)| a.grid_hz == b.grid_hz && a.low_hz == b.low_hz;
        if bands.len() != self.bands.len() || !self.bands.iter().zip(bands).all(is_alike) {
            return;
        }
        let before = self.records as f64;
        self.records += 1;
        let mean = |of_before: f64, of_this: f64| (before * of_before + of_this) / (before + 1.0);
        for (sum, band) in self.bands.iter_mut().zip(bands) {
            let values = over_orders(&band.values, faster);
            sum.values.iter_mut().zip(values).for_each(|(all, this)| *all = mean(*all, this));
            sum.rms = mean(sum.rms.powi(2), band.rms.powi(2)).sqrt();
            sum.segments = self.records;
        }
    }
}

/// Lines of a spectrum at a speed `faster` times that of others, where theirs are.
fn over_orders(values: &[f64], faster: f64) -> Vec<f64> {
    if (faster - 1.0).abs() < SAME_SPEED {
        return values.to_vec();
    }
    let at = |n: usize| {
        let place = n as f64 * faster;
        let (line, beyond) = (place as usize, place.fract());
        let [a, b] = [line, line + 1].map(|n| values.get(n).or(values.last()).copied().unwrap_or(0.0));
        (1.0 - beyond) * a + beyond * b
    };
    (0..values.len()).map(at).collect()
}
