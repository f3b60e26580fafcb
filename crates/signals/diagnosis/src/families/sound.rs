//! Records of the same machine when it was healthy, and what they say of a family.
//!
//! The score of a record is how far the family that does so most stands above unrelated combs. Scores of sound
//! records of one machine are exchangeable: by their order alone, a further one exceeds all of n with a
//! probability of 1 in n + 1; by their scatter, as Student's distribution has it, farther away more rarely
//! (THEORY §7.9).

use statrs::distribution::{ContinuousCDF, StudentsT};

use crate::families::family::Family;
use crate::{Defect, Reason};

/// Fewest healthy records by which a family is claimed: one more exceeds all of seven once in eight.
pub const LEAST_SOUND: usize = 7;
/// Fewer, two at least, claim one by its distance from the highest of them [dB]: of 24 healthy records of IMS beside
/// two of the same channel none stands more than 1.5 dB above both.
pub(crate) const LEAST_FEW: usize = 2;
const ABOVE_FEW_DB: f64 = 3.1;
/// Largest probability that a further healthy record has as high a score, with which a family is claimed.
pub(crate) const BEYOND_SOUND: f64 = 0.01;

/// A score beside those of healthy records.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct BesideSound {
    /// The family that stands farthest above unrelated combs.
    pub(crate) name: Defect,
    /// By how much [dB].
    pub(crate) score_db: f64,
    /// Healthy records, and those of them with as high a score.
    pub(crate) records: usize,
    pub(crate) as_high: usize,
    /// The highest of their scores [dB].
    pub(crate) highest_db: f64,
    /// Probability that a further one has as high a score, by their scatter.
    pub(crate) p_value: f64,
}

/// The rolling family that stands farthest above unrelated combs, of those whose lines are its own, and by how
/// much [dB].
pub(crate) fn farthest(families: &[Family]) -> Option<(Defect, f64)> {
    let own = families.iter().filter(|f| f.name != Defect::Ftf && f.reason == Reason::Undecided);
    let scored = own.filter_map(|f| Some((f.name, f.above_unrelated_db()?)));
    scored.max_by(|a, b| a.1.total_cmp(&b.1))
}

impl BesideSound {
    /// Beside the scores of healthy records [dB]; `None` without any.
    pub(crate) fn of(families: &[Family], sound_db: &[f64]) -> Option<Self> {
        let (name, score_db) = farthest(families)?;
        let records = sound_db.len();
        if records == 0 {
            return None;
        }
        let n = records as f64;
        let mean = sound_db.iter().sum::<f64>() / n;
        let deviation = (sound_db.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (n - 1.0)).sqrt();
        let off = (score_db - mean) / (deviation * (1.0 + 1.0 / n).sqrt()).max(f64::MIN_POSITIVE);
        // A single one has no scatter.
        let p_value = StudentsT::new(0.0, 1.0, n - 1.0).map_or(1.0, |student| 1.0 - student.cdf(off));
        Some(Self {
            name,
            score_db,
            records,
            as_high: sound_db.iter().filter(|sound| **sound >= score_db).count(),
            highest_db: sound_db.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            p_value,
        })
    }

    /// Whether it is beyond what healthy records of the machine show.
    pub(crate) fn is_beyond(&self) -> bool {
        self.is_above_few() || self.records >= LEAST_SOUND && self.as_high == 0 && self.p_value < BEYOND_SOUND
    }

    /// Whether it is that by its distance from few of them.
    pub(crate) fn is_above_few(&self) -> bool {
        let few = (LEAST_FEW..LEAST_SOUND).contains(&self.records);
        few && self.score_db - self.highest_db >= ABOVE_FEW_DB
    }

    /// How many healthy records show as much, in words.
    pub(crate) fn note(&self) -> String {
        let Self { name, score_db, records, as_high, .. } = self;
        let few = format!("; at least {LEAST_FEW} of them enter the verdict");
        format!(
            "{name} stands {score_db:.1} dB above combs at other spacings, and {as_high} of {records} records of the sound \
             machine have a family that stands as far{}",
            if *records < LEAST_FEW { few.as_str() } else { "" }
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_hand_a_score_beyond_those_of_sound_records() {
        // −1, 0 and 1 scatter by 1; a score of 2√(1 + 1/3) is two of them away, and Student's distribution of
        // two degrees of freedom has (1 − 2/√(2 + 2²))/2 beyond 2 (Student, Biometrika 6 (1908) 1–25).
        let of = |score_db: f64, sound_db: &[f64]| {
            let family = Family {
                height_db: score_db,
                controls: vec![(1.0, 0.0)],
                ..Family::expected(Defect::Bpfo, 1.0)
            };
            BesideSound::of(&[family], sound_db)
        };
        let found = of(2.0 * (4.0_f64 / 3.0).sqrt(), &[-1.0, 0.0, 1.0]).unwrap();
        assert!((found.p_value - 0.5 * (1.0 - 2.0 / 6.0_f64.sqrt())).abs() < 1e-9, "{found:?}");
        assert!(found.as_high == 0 && !found.is_beyond());
        // Of few the distance from the highest counts; a single one has no scatter.
        assert!(of(4.2, &[-1.0, 0.0, 1.0]).unwrap().is_beyond(), "3.2 dB above the highest of three");
        assert!(!of(4.0, &[-1.0, 0.0, 1.0]).unwrap().is_beyond() && !of(30.0, &[0.0]).unwrap().is_beyond());
        let seven = [-1.0, 0.0, 1.0, -1.0, 0.0, 1.0, 0.5];
        assert!(of(30.0, &seven).unwrap().is_beyond() && !of(1.1, &seven).unwrap().is_beyond());
        assert_eq!(of(0.0, &seven).unwrap().as_high, 5);
        assert!(of(0.0, &[]).is_none() && of(0.0, &[-1.0]).unwrap().p_value == 1.0);
    }
}
