//! The speed of a shaft by the verdict at each speed that the lines of a record support.
//!
//! The lines of shaft and bearing often support several speeds in simple ratios. At the right one a damaged
//! raceway stands at its place, deep and above everything else; at a wrong one the same comb is nobody's
//! (THEORY §7.9).

use crate::families::limits::ALPHA;
use crate::families::verdict::Candidates;
use crate::record::pass::Record;
use crate::speed::estimate::{LEAST_LEAD, Supported};
use crate::{Defect, Machine};

/// A speed at which one raceway is claimed and nothing stands higher.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SpeedByVerdict {
    pub(crate) speed: Supported,
    /// The raceway.
    pub(crate) name: Defect,
    /// Its comb [Hz], and the height of that [dB].
    comb_hz: f64,
    height_db: f64,
    /// Probability that a healthy bearing shows as much at this speed.
    p_value: f64,
}

/// Multiples of a comb that are no comb of their own, and how far from a whole number they may be.
const MULTIPLES: f64 = 8.0;
const WHOLE: f64 = 2e-3;

/// The speed at which a raceway is claimed, with the speeds that were tried; `None` where it is claimed at
/// none, or another raceway at a speed that the lines support as well.
pub(crate) fn find(record: &Record, machine: &Machine, supported: &[Supported]) -> Option<SpeedByVerdict> {
    let claims: Vec<SpeedByVerdict> =
        supported.iter().filter_map(|speed| claim(record, machine, *speed)).collect();
    let own: Vec<&SpeedByVerdict> =
        claims.iter().filter(|claim| !claims.iter().any(|other| claim.is_multiple_of(other))).collect();
    let best = **own.iter().max_by(|a, b| a.speed.score.total_cmp(&b.speed.score))?;
    let leads = |other: &&SpeedByVerdict| {
        other.name == best.name || best.speed.score - other.speed.score >= LEAST_LEAD
    };
    // Of several speeds one is as good by chance more often than one alone.
    let is_sure = best.p_value * (supported.len() as f64) < ALPHA;
    (is_sure && own.iter().all(leads)).then_some(best)
}

/// The raceway that the rules claim at a speed, where they claim nothing else.
fn claim(record: &Record, machine: &Machine, speed: Supported) -> Option<SpeedByVerdict> {
    let at = Machine { speed_rpm: Some(60.0 * speed.hz), ..machine.clone() };
    let decided = Candidates::of(record, &at, Some(speed.hz), true).ok()?.decide();
    let mut claimed = decided.families.iter().filter(|family| family.claimed);
    let (Some(family), None, None) = (claimed.next(), claimed.next(), decided.unexplained) else {
        return None;
    };
    let is_raceway = matches!(family.name, Defect::Bpfo | Defect::Bpfi);
    let comb_hz = family.measured_hz.filter(|_| is_raceway)?;
    let (p_value, height_db) = (family.p_value, family.score_db());
    Some(SpeedByVerdict { speed, name: family.name, comb_hz, height_db, p_value })
}

impl SpeedByVerdict {
    /// Whether its comb is a multiple of another one that stands as high.
    fn is_multiple_of(&self, other: &Self) -> bool {
        let ratio = self.comb_hz / other.comb_hz;
        let whole = ratio.round();
        (2.0..=MULTIPLES).contains(&whole)
            && (ratio / whole - 1.0).abs() < WHOLE
            && other.height_db >= self.height_db
    }

    /// The note on it where another speed was given [1/min].
    pub(crate) fn note_beside(&self, given_rpm: f64) -> String {
        format!(
            "at the {given_rpm:.1} rpm that were given no family stands, and at {:.1} ± {:.1} rpm, which the lines of \
             shaft and bearing support, too, a defect of {} stands above everything else: that speed is taken",
            60.0 * self.speed.hz,
            60.0 * self.speed.uncertainty_hz,
            self.name.part()
        )
    }

    /// The note on it.
    pub(crate) fn note(&self, tried: usize) -> String {
        format!(
            "no speed was given: of {tried} speeds that the lines of the shaft and of the bearing support, \
             {:.1} ± {:.1} rpm is the one at which a defect of {} stands above everything else",
            60.0 * self.speed.hz,
            60.0 * self.speed.uncertainty_hz,
            self.name.part()
        )
    }
}
