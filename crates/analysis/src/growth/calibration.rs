//! How long a spall is by what its record shows, learnt from records of other units whose spalls are known.

use stribeck_scene::dice::Dice;

use crate::records::normal;

/// A record of a unit whose spall is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Known {
    /// Number of the unit.
    pub unit: usize,
    /// Length of the spall [mm]; `None` of a sound unit.
    pub length_mm: Option<f64>,
    /// What the record shows.
    pub record: Record,
}

/// What a record shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Record {
    /// No defect.
    Sound,
    /// A defect of unknown size.
    Damaged,
    /// A defect with an indicator of its size.
    Indicates(f64),
}

/// From an indicator x to the length L of a spall, with its errors.
///
/// The line x = a + b ln L, by least squares over records of known spalls, is read backwards. A line of ln L
/// on x would read all lengths nearer to their mean, by as much as x errs. Records of one unit err together:
/// their sensor, clearance and depth are the same. The variance about the line is split into that of units
/// and that of records by the analysis of variance of one random factor (S. R. Searle, G. Casella and C. E.
/// McCulloch, *Variance Components*, Wiley 1992, §3.6).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Calibration {
    a: f64,
    b: f64,
    /// Standard deviation over units of what all records of one are off by, in ln L.
    pub of_units: f64,
    /// Standard deviation of a record about that, in ln L.
    pub of_records: f64,
    /// Units that show a spall's size.
    pub units: usize,
    /// Records that do.
    pub records: usize,
    /// Share of sound records that show a defect.
    pub false_claims: f64,
    /// Share of records of a spall that show none.
    pub missed: f64,
}

/// Fewest records of a calibration.
const LEAST_RECORDS: usize = 6;
/// No calibration is taken to be better than this.
const LEAST_ERROR: f64 = 0.02;

impl Calibration {
    /// From records of known spalls; `None` for fewer than six with an indicator, or where all lengths or all
    /// indicators are equal.
    pub fn of(known: &[Known]) -> Option<Self> {
        let told: Vec<(usize, f64, f64)> = known
            .iter()
            .filter_map(|known| match (known.record, known.length_mm) {
                (Record::Indicates(x), Some(length)) => Some((known.unit, length.ln(), x)),
                _ => None,
            })
            .collect();
        if told.len() < LEAST_RECORDS {
            return None;
        }
        let count = told.len() as f64;
        let mean = |of: fn(&(usize, f64, f64)) -> f64| told.iter().map(of).sum::<f64>() / count;
        let (ln, x) = (mean(|told| told.1), mean(|told| told.2));
        let squares: f64 = told.iter().map(|told| (told.1 - ln).powi(2)).sum();
        let products: f64 = told.iter().map(|told| (told.1 - ln) * (told.2 - x)).sum();
        let b = Some(products / squares).filter(|b| b.is_finite() && *b != 0.0)?;
        let left: Vec<(usize, f64)> =
            told.iter().map(|(unit, at, told)| (*unit, (told - x) / b - (at - ln))).collect();
        let (of_units, of_records, units) = errors(&left);
        let is_sound = |known: &&Known| known.length_mm.is_none();
        let is_claimed = |known: &Known| known.record != Record::Sound;
        Some(Self {
            a: x - b * ln,
            b,
            of_units,
            of_records: of_records.max(LEAST_ERROR),
            units,
            records: told.len(),
            false_claims: share(known.iter().filter(is_sound).map(is_claimed)),
            missed: share(known.iter().filter(|known| !is_sound(known)).map(|known| !is_claimed(known))),
        })
    }

    /// The length that belongs to an indicator [mm].
    pub fn length_mm(&self, indicator: f64) -> f64 {
        ((indicator - self.a) / self.b).exp()
    }

    /// What all records of a further unit may be off by, in ln L: Student's t with one degree of freedom less
    /// than the units that the scatter rests on, two at least, so that few units are not trusted too much.
    pub(super) fn drawn(&self, dice: &mut Dice) -> f64 {
        let freedom = self.units.saturating_sub(1).max(2);
        let chi: f64 = (0..freedom).map(|_| normal(dice).powi(2)).sum();
        let wider = (1.0 + 1.0 / self.units.max(1) as f64).sqrt();
        self.of_units * wider * normal(dice) / (chi / freedom as f64).sqrt()
    }
}

/// Standard deviation of units, that of records within a unit, and the number of units.
fn errors(left: &[(usize, f64)]) -> (f64, f64, usize) {
    let mut numbers: Vec<usize> = left.iter().map(|left| left.0).collect();
    numbers.sort_unstable();
    numbers.dedup();
    let (records, units) = (left.len() as f64, numbers.len() as f64);
    let groups: Vec<Vec<f64>> = numbers
        .iter()
        .map(|unit| left.iter().filter(|left| left.0 == *unit).map(|left| left.1).collect())
        .collect();
    let mean = |group: &[f64]| group.iter().sum::<f64>() / group.len() as f64;
    let within: f64 =
        groups.iter().map(|group| group.iter().map(|x| (x - mean(group)).powi(2)).sum::<f64>()).sum();
    if numbers.len() < 2 || left.len() <= numbers.len() + 1 {
        let all: f64 = left.iter().map(|left| left.1.powi(2)).sum();
        return (0.0, (all / (records - 2.0)).sqrt(), numbers.len());
    }
    // The slope of the line has taken a degree of freedom, too.
    let of_records = within / (records - units - 1.0);
    let between: f64 =
        groups.iter().map(|group| group.len() as f64 * mean(group).powi(2)).sum::<f64>() / (units - 1.0);
    let squares: f64 = groups.iter().map(|group| (group.len() as f64).powi(2)).sum();
    let size = (records - squares / records) / (units - 1.0);
    (((between - of_records) / size).max(0.0).sqrt(), of_records.sqrt(), numbers.len())
}

/// A share of which half a case more is known on either side, so that it is neither nothing nor all.
fn share(cases: impl Iterator<Item = bool>) -> f64 {
    let (count, true_ones) = cases.fold((0.0, 0.0), |(n, k), case| (n + 1.0, k + f64::from(u8::from(case))));
    (true_ones + 0.5) / (count + 1.0)
}
