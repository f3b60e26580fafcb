//! The share of records in which a defect is found, over its length: a logistic curve, and the length from which
//! on nine of ten are found.

use serde::{Deserialize, Serialize};
use stribeck_scene::dice::Dice;

use crate::statistic::{Share, quantile};

/// Share of the records in which a defect of the length sought is found.
pub const WANTED: f64 = 0.9;
/// Version of [`Detection`] as a file.
pub const VERSION: u32 = 1;

/// Weight of the squared slope beside the logarithm of the likelihood: where the found and the missed lengths do
/// not overlap any slope that is steep enough is as likely, and this one keeps it finite.
const FLAT: f64 = 0.005;
/// Repetitions of the parametric bootstrap, and the part of them in the interval.
const REPETITIONS: usize = 400;
const WITHIN: [f64; 2] = [0.05, 0.95];
/// Newton steps of a fit.
const STEPS: usize = 60;

/// Records of one length.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct OfLength {
    /// Length of the spall [mm].
    pub length_mm: f64,
    /// Records in which it is found.
    pub found: Share,
    /// Share by the curve.
    pub by_curve: f64,
}

/// The length from which on nine of ten records show the defect.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Smallest {
    /// Between the lengths that were tried: the length, and its 90 % interval [mm]; an end beyond the tried
    /// lengths is `null`.
    Between {
        /// The length [mm].
        length_mm: f64,
        /// Lower end.
        low_mm: Option<f64>,
        /// Upper end.
        high_mm: Option<f64>,
    },
    /// The shortest that was tried is found in more records.
    Below(f64),
    /// The longest that was tried is found in fewer.
    Above(f64),
}

/// Contents of `detect.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Detection {
    /// Version of this file.
    pub version: u32,
    /// Name of the scene.
    pub scene: String,
    /// Family that is looked for.
    pub family: String,
    /// What the records are of, in words.
    pub of: String,
    /// Length of a record [s].
    pub record_s: f64,
    /// Seed of the starts and of the background.
    pub seed: u64,
    /// Each length, ascending.
    pub lengths: Vec<OfLength>,
    /// Records of the healthy bearing in which the same family is claimed.
    pub sound: Option<Share>,
    /// Whether the machine has no background, so that nothing but the sensor's noise hides a spall.
    #[serde(default)]
    pub silent: bool,
    /// The answer.
    pub smallest: Smallest,
}

/// Logistic curve over the logarithm of the length, which does not fall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Curve {
    /// Logarithm of the length [ln mm] at which half of the records show it.
    middle: f64,
    slope: f64,
}

impl Curve {
    /// The likeliest of (length [mm], found, of).
    pub fn of(records: &[(f64, usize, usize)]) -> Self {
        let logs: Vec<f64> = records.iter().map(|(mm, ..)| mm.ln()).collect();
        let centre = logs.iter().sum::<f64>() / logs.len().max(1) as f64;
        let (mut a, mut b) = (0.0, 1.0);
        for _ in 0..STEPS {
            let (mut ga, mut gb, mut haa, mut hab, mut hbb) = (-FLAT * a, -FLAT * b, FLAT, 0.0, FLAT);
            for ((_, found, of), log) in records.iter().zip(&logs) {
                let x = log - centre;
                let p = logistic(a + b * x);
                let (rest, weight) = (*found as f64 - *of as f64 * p, *of as f64 * p * (1.0 - p));
                (ga, gb) = (ga + rest, gb + rest * x);
                (haa, hab, hbb) = (haa + weight, hab + weight * x, hbb + weight * x * x);
            }
            let determinant = haa * hbb - hab * hab;
            let step = [(hbb * ga - hab * gb) / determinant, (haa * gb - hab * ga) / determinant];
            let short = (2.0 / step[0].abs().max(step[1].abs())).min(1.0);
            (a, b) = (a + short * step[0], (b + short * step[1]).max(LEAST_SLOPE));
        }
        Self { middle: centre - a / b, slope: b }
    }

    /// Share of the records that show a length [mm].
    pub fn at(self, length_mm: f64) -> f64 {
        logistic(self.slope * (length_mm.ln() - self.middle))
    }

    /// Length that a share of the records shows [mm].
    pub fn length_mm(self, share: f64) -> f64 {
        (self.middle + (share / (1.0 - share)).ln() / self.slope).exp()
    }
}

/// A curve that does not rise at all has no middle.
const LEAST_SLOPE: f64 = 1e-3;

fn logistic(x: f64) -> f64 {
    1.0 / (1.0 + (-x).exp())
}

/// The curve of (length [mm], found, of), which ascend, and the length of nine in ten, with an interval by a
/// parametric bootstrap.
pub fn smallest(records: &[(f64, usize, usize)], seed: u64) -> Option<(Curve, Smallest)> {
    let (&(first, ..), &(last, ..)) = (records.first()?, records.last()?);
    let curve = Curve::of(records);
    let best = curve.length_mm(WANTED);
    if best < first {
        return Some((curve, Smallest::Below(first)));
    }
    if best > last {
        return Some((curve, Smallest::Above(last)));
    }
    let mut dice = Dice::new(seed);
    let mut drawn: Vec<f64> = (0..REPETITIONS)
        .map(|_| {
            let again: Vec<(f64, usize, usize)> = records
                .iter()
                .map(|&(mm, _, of)| (mm, (0..of).filter(|_| dice.share() < curve.at(mm)).count(), of))
                .collect();
            Curve::of(&again).length_mm(WANTED)
        })
        .collect();
    drawn.sort_by(f64::total_cmp);
    let [low, high] = WITHIN.map(|part| quantile(&drawn, part));
    let inside = |mm: f64| Some(mm).filter(|mm| (first..=last).contains(mm));
    let length = Smallest::Between { length_mm: best, low_mm: inside(low), high_mm: inside(high) };
    Some((curve, length))
}

/// What every answer leaves out.
pub const CAUTION: &str = "A spall without `defect.width_mm` takes the whole contact, and simulated blows differ less \
    from one another than real ones, so that lines stand too high: a machine shows spalls later than this curve says";

/// How many of the records of one length show the spall.
fn counted(of: Option<&OfLength>, record_s: f64) -> String {
    of.map_or_else(String::new, |OfLength { found, .. }| {
        let [low, high] = [found.low, found.high].map(|share| 100.0 * share);
        let Share { count, of, .. } = found;
        format!(
            "{count} of {of} records of {record_s:.1} s (95 % interval of the share: {low:.0} to {high:.0} %)"
        )
    })
}

/// The answer in a sentence.
pub fn in_words(detection: &Detection) -> String {
    let Detection { record_s, smallest, .. } = detection;
    let of = detection.of.as_str();
    let silent = if detection.silent {
        " The machine has no background, in which a spall shows later: `stribeck machine` with a record of the healthy \
         machine gives it one."
    } else {
        ""
    };
    let answer = match smallest {
        Smallest::Between { length_mm, low_mm, high_mm } => {
            let interval = match (low_mm, high_mm) {
                (Some(low), Some(high)) => format!("90 % between {low:.2} and {high:.2} mm"),
                (None, Some(high)) => format!("at most {high:.2} mm, 95 %"),
                (Some(low), None) => format!("at least {low:.2} mm, 95 %"),
                (None, None) => "an interval as wide as all lengths".to_owned(),
            };
            format!(
                "A spall of {length_mm:.2} mm ({interval}) is found in nine of ten records of {record_s:.1} s, {of}."
            )
        }
        Smallest::Below(mm) => format!(
            "Even the shortest spall that was tried, {mm:.2} mm, is found in {}, {of}. Shorter ones were not tried.",
            counted(detection.lengths.first(), *record_s)
        ),
        Smallest::Above(mm) => format!(
            "Even the longest spall that was tried, {mm:.2} mm, is found in {} only, {of}: it takes a longer one, or a nearer sensor.",
            counted(detection.lengths.last(), *record_s)
        ),
    };
    answer + silent
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawn(middle_mm: f64, slope: f64, of: usize, seed: u64) -> Vec<(f64, usize, usize)> {
        let curve = Curve { middle: middle_mm.ln(), slope };
        let mut dice = Dice::new(seed);
        [0.3, 0.5, 0.7, 1.0, 1.5, 2.2, 3.3, 5.0]
            .map(|mm| (mm, (0..of).filter(|_| dice.share() < curve.at(mm)).count(), of))
            .into()
    }

    /// Of a hundred curves of 20 records a length the interval holds the length that was put in as often as it
    /// says, within three standard errors of its share.
    #[test]
    fn planted_the_interval_holds_the_length_of_nine_in_ten() {
        let truth = Curve { middle: 1.1_f64.ln(), slope: 4.0 }.length_mm(WANTED);
        let held = (1..=100)
            .filter(|seed| {
                let (_, found) = smallest(&drawn(1.1, 4.0, 20, *seed), *seed).expect("lengths");
                matches!(found, Smallest::Between { low_mm, high_mm, .. }
                    if low_mm.is_none_or(|low| low <= truth) && high_mm.is_none_or(|high| truth <= high))
            })
            .count();
        assert!((81..=99).contains(&held), "{held} of 100");
    }

    #[test]
    fn invariant_the_curve_rises_and_is_that_of_its_seed() {
        let records = drawn(1.1, 4.0, 20, 3);
        let (curve, found) = smallest(&records, 1).expect("lengths");
        assert!(records.windows(2).all(|pair| curve.at(pair[0].0) < curve.at(pair[1].0)));
        assert_eq!(smallest(&records, 1), Some((curve, found)));
    }

    #[test]
    fn behaves_the_answer_says_that_a_machine_has_no_background() {
        let answer = |silent| {
            in_words(&Detection {
                version: VERSION,
                scene: "a".to_owned(),
                family: "BPFO".to_owned(),
                of: "of a 6205".to_owned(),
                record_s: 1.0,
                seed: 1,
                lengths: Vec::new(),
                sound: None,
                silent,
                smallest: Smallest::Below(0.3),
            })
        };
        assert!(answer(true).ends_with("gives it one.") && answer(true).contains("has no background"));
        assert!(!answer(false).contains("background"));
    }

    #[test]
    fn behaves_lengths_beyond_those_tried_are_not_claimed() {
        let all = [(0.3, 20, 20), (1.0, 20, 20), (3.0, 20, 20)];
        assert_eq!(smallest(&all, 1).expect("three").1, Smallest::Below(0.3));
        let none = [(0.3, 0, 20), (1.0, 1, 20), (3.0, 0, 20)];
        assert_eq!(smallest(&none, 1).expect("three").1, Smallest::Above(3.0));
        assert!(smallest(&[], 1).is_none());
        // Without overlap the length lies between the last missed and the first found one.
        let step = [(0.5, 0, 20), (1.0, 0, 20), (2.0, 20, 20), (4.0, 20, 20)];
        let (_, found) = smallest(&step, 1).expect("four");
        assert!(
            matches!(found, Smallest::Between { length_mm, .. } if (1.0..2.2).contains(&length_mm)),
            "{found:?}"
        );
    }
}
