//! The verdict in words.

use crate::Defect;
use crate::families::family::Family;
use crate::families::unexplained::Unexplained;

/// A frequency beside that of rolling without slip, in words.
fn beside(hz: f64, without_slip_hz: f64) -> String {
    let off = 100.0 * (hz / without_slip_hz - 1.0);
    match off.abs() {
        percent if percent < 0.05 => "as rolling without slip has it".to_owned(),
        percent => {
            let side = if off > 0.0 { "above" } else { "below" };
            format!("{percent:.1} % {side} that of rolling without slip")
        }
    }
}

/// The verdict in words.
pub(crate) fn conclude(families: &[Family], unexplained: Option<&Unexplained>) -> String {
    // Two families that cannot be distinguished are reported under the name of the first.
    let spoken_for = |at: usize, family: &Family| {
        families[..at].iter().any(|f| f.claimed && f.not_told_apart_from == Some(family.name))
    };
    let claimed: Vec<String> = families
        .iter()
        .enumerate()
        .filter(|(at, f)| f.claimed && !spoken_for(*at, f))
        .map(|(_, f)| {
            let hz = f.measured_hz.unwrap_or(f.expected_hz);
            let beside = beside(hz, f.expected_hz);
            let other = families.iter().find(|other| f.not_told_apart_from == Some(other.name));
            match other {
                Some(_) if f.name == Defect::Ftf => format!(
                    "a defect of the cage or of one rolling element, which the record cannot distinguish \
                     (something knocks once a turn of the cage, {} at {hz:.2} Hz, {beside})",
                    f.name
                ),
                None => format!("a defect of {} ({} at {hz:.2} Hz, {beside})", f.name.part(), f.name),
                Some(other) => format!(
                    "a defect of {} or of {}, which the record cannot distinguish ({} at {hz:.2} Hz, \
                     {beside}, and {} times {} stand within a resolution)",
                    f.name.part(),
                    other.name.part(),
                    f.name,
                    other.name.shocks_per_period() / f.name.shocks_per_period(),
                    other.name
                ),
            }
        })
        .collect();
    if !claimed.is_empty() {
        return format!("The record shows {}.", claimed.join(" and "));
    }
    if let Some(other) = unexplained {
        return format!(
            "The record knocks at {:.2} Hz, {:.3} times the shaft, which is no family of this bearing: slip, \
             speed or bearing is not what was given, or another part of the machine knocks.",
            other.hz, other.order
        );
    }
    let highest = families.iter().filter(|f| f.knocks()).max_by(|a, b| a.height_db.total_cmp(&b.height_db));
    if let Some(highest) = highest {
        return format!(
            "The record has knocks, and does not show where: {} stands highest, but combs at other spacings \
             stand as high. A longer record, or one nearer to the bearing, may tell.",
            highest.name
        );
    }
    let weak: Vec<&str> = families.iter().filter(|f| f.is_there()).map(|f| f.name.name()).collect();
    let unheard: Vec<&str> = families.iter().filter(|f| f.band_hz.is_none()).map(|f| f.name.name()).collect();
    let hidden: Vec<&str> = families.iter().filter(|f| f.undecided).map(|f| f.name.name()).collect();
    if unheard.len() == families.len() {
        return "The record cannot tell whether there is a defect: it is too short, or sampled too slowly, \
            for every family. The reasons say which length or rate would do."
            .to_owned();
    }
    let mut verdict = if hidden.is_empty() {
        "The record shows no defect.".to_owned()
    } else {
        format!(
            "The record does not decide about {}, whose place is that of the machine's own lines, and shows no \
             other defect.",
            hidden.join(" and ")
        )
    };
    if !weak.is_empty() {
        let above_db = families.iter().filter(|f| f.is_there()).filter_map(Family::above_unrelated_db);
        verdict += &format!(
            " {} can be seen, up to {:.0} dB above combs at other spacings, without deep knocks: records of the sound \
             machine (`--baseline`) decide, or the trend.",
            weak.join(" and "),
            above_db.fold(0.0, f64::max)
        );
    }
    let unheard: Vec<&str> = unheard.into_iter().filter(|name| !hidden.contains(name)).collect();
    if !unheard.is_empty() {
        verdict += &format!(" It does not decide about {}.", unheard.join(" and "));
    }
    verdict
}

/// A probability in words.
pub(crate) fn probability(p: f64) -> String {
    if p >= 0.95 {
        "nearly 1".to_owned()
    } else if p >= 0.1 {
        format!("{p:.1}")
    } else {
        format!("{p:.3}")
    }
}
