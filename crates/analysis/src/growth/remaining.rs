//! Remaining life of a unit from its records, by a particle filter.

use stribeck_scene::dice::Dice;

use super::{Calibration, Course, Law, Record};
use crate::statistic::quantile;

/// What is left of a life [revolutions]: the median, and the ends of an interval of 90 %.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Remaining {
    /// Median.
    pub median: f64,
    /// From the 5 % quantile.
    pub low: f64,
    /// To the 95 % quantile.
    pub high: f64,
}

/// Courses that are followed: of 4000 too few distinct values of the error common to a unit remain.
const COURSES: usize = 16_000;
/// Courses that are followed to their ends.
const ENDED: usize = 1000;

/// A course, and what all readings of the unit are off by on it, in ln L.
#[derive(Debug, Clone, Copy)]
struct Followed {
    course: Course,
    off: f64,
}

/// Remaining life after each record of a unit, given its records so far, read by `calibration` and with its
/// errors. A missing record, `None`, says only that the unit was not at its end. The result is `None` before
/// the first record that shows a defect.
///
/// A particle filter: courses drawn from the law, each with an error that all readings of the unit share, are
/// weighted by the likelihood of the readings, resampled where few carry the weight, and run on to their
/// ends. Source: N. J. Gordon, D. J. Salmond and A. F. M. Smith, IEE Proc. F 140 (1993) 107.
pub fn remaining(
    law: &Law,
    shown: &[Option<Record>],
    calibration: &Calibration,
    seed: u64,
) -> Vec<Option<Remaining>> {
    let mut dice = Dice::new(seed);
    let mut followed: Vec<Followed> = (0..COURSES)
        .map(|_| Followed { course: law.unit(&mut dice), off: calibration.drawn(&mut dice) })
        .collect();
    let mut weights = vec![1.0; COURSES];
    let mut seen = false;
    let mut all = Vec::with_capacity(shown.len());
    for (n, record) in shown.iter().enumerate() {
        if n > 0 {
            followed.iter_mut().for_each(|followed| followed.course.advance(law, &mut dice));
        }
        for (followed, weight) in followed.iter().zip(&mut weights) {
            // A unit at its end has no record.
            let ended = followed.course.end().is_some();
            *weight *= if ended { 0.0 } else { likelihood(law, followed, *record, calibration) };
        }
        let sum: f64 = weights.iter().sum();
        if sum <= 0.0 {
            // No course of the law has made this.
            all.resize(shown.len(), None);
            return all;
        }
        weights.iter_mut().for_each(|weight| *weight /= sum);
        if weights.iter().map(|w| w * w).sum::<f64>() > 2.0 / COURSES as f64 {
            followed = drawn(COURSES, &followed, &weights, &mut dice);
            weights.fill(1.0);
        }
        seen |= record.is_some_and(|record| record != Record::Sound);
        all.push(seen.then(|| ends(law, &followed, &weights, &mut dice)));
    }
    all
}

/// Of a record, up to a factor that is the same for all courses.
fn likelihood(law: &Law, followed: &Followed, shown: Option<Record>, calibration: &Calibration) -> f64 {
    let Some(shown) = shown else { return 1.0 };
    // What is read from a sound record may be any length, each ratio of lengths as likely as the other.
    let anywhere = (calibration.of_records * std::f64::consts::TAU.sqrt()
        / (law.length_mm.1 / law.length_mm.0).ln())
    .min(1.0);
    match (followed.course.length_mm(law), shown) {
        (None, Record::Sound) => 1.0 - calibration.false_claims,
        (None, Record::Damaged) => calibration.false_claims,
        (None, Record::Indicates(_)) => calibration.false_claims * anywhere,
        (Some(_), Record::Sound) => calibration.missed,
        (Some(_), Record::Damaged) => 1.0 - calibration.missed,
        (Some(length), Record::Indicates(indicator)) => {
            let off =
                ((calibration.length_mm(indicator) / length).ln() - followed.off) / calibration.of_records;
            (1.0 - calibration.missed) * (-0.5 * off * off).exp()
        }
    }
}

/// A number of courses, each as often as its weight says, from one draw.
fn drawn(count: usize, courses: &[Followed], weights: &[f64], dice: &mut Dice) -> Vec<Followed> {
    let sum: f64 = weights.iter().sum();
    let step = sum / count as f64;
    let (mut at, mut passed) = (0, weights[0]);
    let first = dice.share();
    (0..count)
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

/// Most records that a course is followed further.
const FURTHEST: usize = 100_000;

fn ends(law: &Law, courses: &[Followed], weights: &[f64], dice: &mut Dice) -> Remaining {
    let of_each = drawn(ENDED, courses, weights, dice);
    let mut left: Vec<f64> = of_each
        .into_iter()
        .map(|Followed { mut course, .. }| {
            let now = course.revolutions();
            for _ in 0..FURTHEST {
                if course.end().is_some() {
                    break;
                }
                course.advance(law, dice);
            }
            course.end().unwrap_or(f64::INFINITY) - now
        })
        .collect();
    left.sort_by(f64::total_cmp);
    Remaining { median: quantile(&left, 0.5), low: quantile(&left, 0.05), high: quantile(&left, 0.95) }
}
