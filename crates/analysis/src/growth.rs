//! A spall that grows: its law, the units that are drawn from it, and the remaining life of a unit by its
//! records.
//!
//! Progress goes from 0, where the spall begins, to 1, where the unit is at its end: dL/dN ∝ Lᵐ makes
//! L¹⁻ᵐ, or for m = 1 ln L, go evenly over the revolutions N (P. C. Paris and F. Erdogan, J. Basic Eng. 85
//! (1963) 528, with the spall's length in place of a crack's). A unit draws its onset and its rate, and each
//! interval between two records a factor of its own.

use stribeck_scene::dice::Dice;

use crate::records::normal;
use crate::statistic::quantile;

/// How a spall grows. Scatters are standard deviations of the logarithm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Law {
    /// Median revolutions to the onset, and their scatter.
    pub onset: (f64, f64),
    /// Median revolutions from onset to end, and their scatter.
    pub life: (f64, f64),
    /// Scatter of the rate from one record to the next.
    pub wander: f64,
    /// Length at the onset and at the end [mm].
    pub length_mm: (f64, f64),
    /// Exponent m of dL/dN ∝ Lᵐ: 1 is exponential growth.
    pub exponent: f64,
    /// Revolutions between two records.
    pub every: f64,
}

/// One unit on its way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Course {
    onset: f64,
    rate: f64,
    now: f64,
    progress: f64,
    end: Option<f64>,
}

impl Law {
    /// Length [mm] at a progress between 0 and 1.
    pub fn length_mm(&self, progress: f64) -> f64 {
        let (start, end, power) = (self.length_mm.0, self.length_mm.1, 1.0 - self.exponent);
        if power.abs() < 1e-9 {
            return start * (end / start).powf(progress);
        }
        let (a, b) = (start.powf(power), end.powf(power));
        (a + (b - a) * progress).powf(1.0 / power)
    }

    /// A unit at its first record, which is at no revolutions.
    pub fn unit(&self, dice: &mut Dice) -> Course {
        let mut drawn = |(median, scatter): (f64, f64)| median * (scatter * normal(dice)).exp();
        let (onset, life) = (drawn(self.onset), drawn(self.life));
        Course { onset, rate: 1.0 / life, now: 0.0, progress: 0.0, end: None }
    }
}

impl Course {
    /// To the next record; a unit at its end stays there.
    pub fn advance(&mut self, law: &Law, dice: &mut Dice) {
        let rate = self.rate * (law.wander * normal(dice)).exp();
        let (from, to) = (self.now.max(self.onset), self.now + law.every);
        self.now = to;
        if self.end.is_none() && from < to {
            let left = (1.0 - self.progress) / rate;
            if left <= to - from {
                (self.end, self.progress) = (Some(from + left), 1.0);
            } else {
                self.progress += (to - from) * rate;
            }
        }
    }

    /// Revolutions so far.
    pub fn revolutions(&self) -> f64 {
        self.now
    }

    /// Revolutions at which the spall began or will begin.
    pub fn onset(&self) -> f64 {
        self.onset
    }

    /// Revolutions at the end, once it is reached.
    pub fn end(&self) -> Option<f64> {
        self.end
    }

    /// Length [mm]; `None` before the onset.
    pub fn length_mm(&self, law: &Law) -> Option<f64> {
        (self.progress > 0.0).then(|| law.length_mm(self.progress))
    }
}

/// From an indicator to the length of a spall: ln L = a + b x, by least squares over records of other units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Calibration {
    a: f64,
    b: f64,
    /// Standard deviation of ln L about the line.
    pub sigma: f64,
    /// Number of its records.
    pub records: usize,
}

/// Fewest records of a calibration.
const LEAST_RECORDS: usize = 6;
/// Smallest residual that a calibration is taken to have.
const LEAST_SIGMA: f64 = 0.02;

impl Calibration {
    /// From indicators and lengths [mm]; `None` for fewer than six records or indicators that are all one.
    pub fn of(records: &[(f64, f64)]) -> Option<Self> {
        let count = records.len() as f64;
        if records.len() < LEAST_RECORDS {
            return None;
        }
        let (x, y) = (
            records.iter().map(|r| r.0).sum::<f64>() / count,
            records.iter().map(|r| r.1.ln()).sum::<f64>() / count,
        );
        let xx: f64 = records.iter().map(|r| (r.0 - x).powi(2)).sum();
        let xy: f64 = records.iter().map(|r| (r.0 - x) * (r.1.ln() - y)).sum();
        let b = Some(xy / xx).filter(|b| b.is_finite())?;
        let left: f64 = records.iter().map(|r| (r.1.ln() - y - b * (r.0 - x)).powi(2)).sum();
        let sigma = (left / (count - 2.0)).sqrt().max(LEAST_SIGMA);
        Some(Self { a: y - b * x, b, sigma, records: records.len() })
    }

    /// Length of the spall by its indicator [mm].
    pub fn length_mm(&self, indicator: f64) -> f64 {
        (self.a + self.b * indicator).exp()
    }
}

/// Remaining life [revolutions]: the median, and the ends of an interval of 90 %.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Remaining {
    /// Median.
    pub median: f64,
    /// From the 5 % quantile.
    pub low: f64,
    /// To the 95 % quantile.
    pub high: f64,
}

/// Number of particles.
const COURSES: usize = 4000;
/// Share of sound records in which a defect is claimed, and of damaged ones in which none is, whatever the
/// length.
const MISTAKEN: f64 = 0.01;

/// Remaining life after each record of a unit by the readings of its records so far: `None` for a record
/// that shows no defect, else the length [mm]; `sigma` is the error of its logarithm. `None` before the first
/// record that shows one.
///
/// A particle filter: courses drawn from the law are weighted by the likelihood of the lengths, resampled
/// when few of them carry the weight, and continued to their ends. Source: N. J. Gordon, D. J. Salmond and A. F.
/// M. Smith, IEE Proc. F 140 (1993) 107.
pub fn remaining(law: &Law, read: &[Option<f64>], sigma: f64, seed: u64) -> Vec<Option<Remaining>> {
    let mut dice = Dice::new(seed);
    let mut courses: Vec<Course> = (0..COURSES).map(|_| law.unit(&mut dice)).collect();
    let mut weights = vec![1.0; COURSES];
    let mut seen = false;
    let mut all = Vec::with_capacity(read.len());
    for (n, length) in read.iter().enumerate() {
        if n > 0 {
            courses.iter_mut().for_each(|course| course.advance(law, &mut dice));
        }
        for (course, weight) in courses.iter().zip(&mut weights) {
            // A unit at its end has no record.
            *weight *= if course.end.is_some() { 0.0 } else { likelihood(law, course, *length, sigma) };
        }
        let sum: f64 = weights.iter().sum();
        if sum <= 0.0 {
            // No course of the law is consistent with the records.
            all.resize(read.len(), None);
            return all;
        }
        weights.iter_mut().for_each(|weight| *weight /= sum);
        if weights.iter().map(|w| w * w).sum::<f64>() > 2.0 / COURSES as f64 {
            courses = resampled(&courses, &weights, &mut dice);
            weights.fill(1.0);
        }
        seen |= length.is_some();
        all.push(seen.then(|| ends(law, &courses, &weights, &mut dice)));
    }
    all
}

fn likelihood(law: &Law, course: &Course, read: Option<f64>, sigma: f64) -> f64 {
    match (course.length_mm(law), read) {
        (None, None) => 1.0 - MISTAKEN,
        (None, Some(_)) | (Some(_), None) => MISTAKEN,
        (Some(length), Some(read)) => {
            (1.0 - MISTAKEN) * (-0.5 * ((read / length).ln() / sigma).powi(2)).exp()
        }
    }
}

/// As many courses, each in proportion to its weight, from one draw (systematic resampling).
fn resampled(courses: &[Course], weights: &[f64], dice: &mut Dice) -> Vec<Course> {
    let sum: f64 = weights.iter().sum();
    let step = sum / courses.len() as f64;
    let (mut at, mut passed) = (0, weights[0]);
    let first = dice.share();
    (0..courses.len())
        .map(|n| {
            let place = (n as f64 + first) * step;
            while passed < place && at + 1 < courses.len() {
                at += 1;
                passed += weights[at];
            }
            courses[at]
        })
        .collect()
}

/// Most further records of a course.
const FURTHEST: usize = 100_000;

fn ends(law: &Law, courses: &[Course], weights: &[f64], dice: &mut Dice) -> Remaining {
    let of_each = resampled(courses, weights, dice);
    let mut left: Vec<f64> = of_each
        .into_iter()
        .map(|mut course| {
            let now = course.now;
            for _ in 0..FURTHEST {
                if course.end.is_some() {
                    break;
                }
                course.advance(law, dice);
            }
            course.end.unwrap_or(f64::INFINITY) - now
        })
        .collect();
    left.sort_by(f64::total_cmp);
    Remaining { median: quantile(&left, 0.5), low: quantile(&left, 0.05), high: quantile(&left, 0.95) }
}
