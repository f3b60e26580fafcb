//! Suggestions: the nearest name, with the unit of its field.

use crate::fields::{paths, spot};

/// Names closer than this (Jaro–Winkler, 1 is equal) are worth proposing.
const NEAR: f64 = 0.80;

/// A word of this many letters with one of them wrong, too many, missing or in the place of its neighbour is
/// worth proposing, too; the similarity of short words is low.
const SLIP: usize = 3;

/// A part of a name has as many letters at least.
const PART: usize = 4;

/// Words of catalogues that a file may use in `bearing`, and our names.
pub(crate) const ACCEPTED: [(&str, &str); 4] = [
    ("balls", "rollers"),
    ("elements", "rollers"),
    ("ball_diameter_mm", "roller_diameter_mm"),
    ("element_diameter_mm", "roller_diameter_mm"),
];

/// Words that are typed for fields whose names are not like them.
const TYPED: [(&str, &str); 7] = [
    ("outer_diameter_mm", "outside_mm"),
    ("inner_diameter_mm", "bore_mm"),
    ("rate_hz", "interval_us"),
    ("sampling_rate_hz", "interval_us"),
    ("rpm", "speed_rpm"),
    ("seconds", "duration_ms"),
    ("duration_s", "duration_ms"),
];

/// The name in `valid` that is most like `found`, when one is.
pub fn nearest<'a, S: AsRef<str>>(found: &str, valid: &'a [S]) -> Option<&'a str> {
    let found = found.to_lowercase();
    let likeness = |name: &str| {
        let slip = found.len().min(name.len()) >= SLIP && strsim::osa_distance(&found, name) <= 1;
        strsim::jaro_winkler(&found, name).max(if slip { NEAR } else { 0.0 })
    };
    let rated = valid.iter().map(AsRef::as_ref).map(|name| (likeness(&name.to_lowercase()), name));
    let best = rated.max_by(|a, b| a.0.total_cmp(&b.0))?;
    (best.0 >= NEAR).then_some(best.1)
}

/// Advice on the unknown field `found` of `section`, which has the fields `siblings`; of a scene a field of another
/// section may be meant. `None` where no name is like it.
pub(crate) fn field(section: &str, found: &str, siblings: &[&str], of_scene: bool) -> Option<String> {
    let leaf = |path: &'static String| path.rsplit('.').next().unwrap_or(path);
    let leaves: Vec<&str> = if of_scene { paths().iter().map(leaf).collect() } else { Vec::new() };
    let ours =
        ACCEPTED.iter().chain(&TYPED).find(|(typed, _)| *typed == found).map_or(found, |(_, name)| name);
    let exact = |names: &[&'static str]| names.iter().copied().find(|name| *name == ours);
    // `clearance_um` in a cage is `pocket_clearance_um`.
    let part = || siblings.iter().copied().find(|name| ours.len() >= PART && name.contains(ours));
    let here = siblings.iter().copied().find(|name| *name == ours).or_else(part);
    let here = here.or_else(|| nearest(ours, siblings).filter(|_| exact(&leaves).is_none()));
    let path = match (here, of_scene) {
        (Some(name), _) if section.is_empty() => name.to_owned(),
        (Some(name), _) => format!("{section}.{name}"),
        (None, false) => return None,
        (None, true) => {
            let name = exact(&leaves).or_else(|| nearest(ours.rsplit('.').next()?, &leaves))?;
            paths().iter().find(|path| leaf(path) == name)?.clone()
        }
    };
    let unit = spot(&path, None).and_then(|spot| spot.range).map_or("", |(_, unit)| unit);
    let unit = if of_scene && !unit.is_empty() { format!(" [{unit}]") } else { String::new() };
    let rate = if path.ends_with("interval_us") { ": 1e6 over the rate in Hz" } else { "" };
    Some(format!("did you mean `{path}`{unit}{rate}?"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fields::names_in;

    fn said(section: &str, found: &str) -> Option<String> {
        field(section, found, &names_in(section), true)
    }

    #[test]
    fn behaves_the_nearest_field_is_named_with_its_unit() {
        for (section, found, ours) in [
            ("", "load", "operation.load_n` [N]"),
            ("operation", "load", "operation.load_n` [N]"),
            ("operation", "load_kn", "operation.load_n` [N]"),
            ("operation", "sped_rpm", "operation.speed_rpm` [rpm]"),
            ("operation", "rpm", "operation.speed_rpm"),
            ("operation", "size_mm", "mesh.size_mm` [mm]"),
            ("output", "rate_hz", "output.interval_us` [µs]: 1e6 over the rate"),
            ("", "seconds", "solver.duration_ms` [ms]"),
            ("bearing", "elements", "bearing.rollers"),
            ("bearing", "outer_diameter_mm", "bearing.outside_mm"),
        ] {
            let said = said(section, found).unwrap_or_default();
            assert!(said.contains(ours), "{section}.{found}: {said}");
        }
        assert_eq!(said("operation", "qqq"), None);
        assert_eq!(field("", "lenght", &["length"], false).as_deref(), Some("did you mean `length`?"));
    }

    #[test]
    fn refuses_a_typing_error_and_recognises_it() {
        assert_eq!(nearest("acr", &["facet", "arc", "nagata"]), Some("arc"));
        assert_eq!(nearest("arx", &["facet", "arc", "nagata"]), Some("arc"));
    }
}
