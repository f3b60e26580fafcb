//! Suggestions: the nearest name, the missing or other unit, the section where a name belongs.

use super::wording::number;

/// Names closer than this (Jaro–Winkler, 1 is equal) are worth proposing.
const NEAR: f64 = 0.80;

/// A word of this many letters with one of them wrong, too many, missing or in the place of its neighbour is
/// worth proposing, too; the similarity of short words is low.
const SLIP: usize = 3;

/// A part of a name has as many letters at least.
const PART: usize = 4;

/// Unit suffixes: text, dimension, size in the first unit of that dimension.
const UNITS: &[(&str, &str, f64)] = &[
    ("m", "length", 1.0),
    ("cm", "length", 1e-2),
    ("mm", "length", 1e-3),
    ("um", "length", 1e-6),
    ("nm", "length", 1e-9),
    ("in", "length", 0.0254),
    ("n", "force", 1.0),
    ("kn", "force", 1e3),
    ("lbf", "force", 4.448_221_615_260_5),
    ("s", "time", 1.0),
    ("ms", "time", 1e-3),
    ("us", "time", 1e-6),
    ("ns", "time", 1e-9),
    ("pa", "pressure", 1.0),
    ("kpa", "pressure", 1e3),
    ("mpa", "pressure", 1e6),
    ("gpa", "pressure", 1e9),
    ("deg", "angle", 1.0),
    ("rad", "angle", 180.0 / std::f64::consts::PI),
    ("rpm", "speed", 1.0),
    ("hz", "speed", 60.0),
    ("rad_s", "speed", 30.0 / std::f64::consts::PI),
    ("kg_m3", "density", 1.0),
    ("g_cm3", "density", 1e3),
    ("m_s2", "acceleration", 1.0),
    ("g", "acceleration", 9.806_65),
    ("per_s", "rate", 1.0),
    ("per_ms", "rate", 1e3),
];

/// Words of catalogues that a file may use in `bearing`, and our names.
pub(crate) const ACCEPTED: [(&str, &str); 5] = [
    ("balls", "rollers"),
    ("elements", "rollers"),
    ("rolling_elements", "rollers"),
    ("ball_diameter_mm", "roller_diameter_mm"),
    ("element_diameter_mm", "roller_diameter_mm"),
];

/// What catalogues and other programs call a field besides, and its name here.
const SYNONYMS: [(&str, &str); 18] = [
    ("number_of_balls", "rollers"),
    ("number_of_rollers", "rollers"),
    ("number_of_elements", "rollers"),
    ("Z", "rollers"),
    ("Dw", "roller_diameter_mm"),
    ("outer_diameter_mm", "outside_mm"),
    ("outside_diameter_mm", "outside_mm"),
    ("D", "outside_mm"),
    ("inner_diameter_mm", "bore_mm"),
    ("bore_diameter_mm", "bore_mm"),
    ("d", "bore_mm"),
    ("B", "width_mm"),
    ("pitch_diameter_mm", "pitch_mm"),
    ("Dpw", "pitch_mm"),
    ("kind", "element"),
    ("type", "element"),
    ("clearance_um", "clearance_change_um"),
    ("revolutions_per_minute", "speed_rpm"),
];

/// A name without its unit, and the unit.
fn split_unit(name: &str) -> (&str, Option<&'static (&'static str, &'static str, f64)>) {
    let longest = UNITS
        .iter()
        .filter(|unit| name.strip_suffix(unit.0).is_some_and(|stem| stem.ends_with('_') && stem.len() > 1))
        .max_by_key(|unit| unit.0.len());
    match longest {
        Some(unit) => (&name[..name.len() - unit.0.len() - 1], Some(unit)),
        None => (name, None),
    }
}

/// True when two names differ in their unit at most.
pub(crate) fn same_quantity(a: &str, b: &str) -> bool {
    split_unit(a).0 == split_unit(b).0
}

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

/// Replacement for the unknown field `found`; `None` where none is similar.
///
/// `siblings` are the names valid in that place, `all` the dotted paths of every field there is.
pub(crate) fn field(found: &str, siblings: &[&str], all: &[String]) -> Option<String> {
    let (stem, unit) = split_unit(found);
    let is_meant = |other: &str| other == found || split_unit(other).0 == stem;
    let mut synonyms = ACCEPTED.iter().chain(&SYNONYMS);
    if let Some((_, name)) = synonyms.find(|(other, name)| siblings.contains(name) && is_meant(other)) {
        return Some(format!("did you mean `{name}`?"));
    }
    // `rpm` for `speed_rpm`.
    if let Some(name) = siblings.iter().find(|name| split_unit(name).1.is_some_and(|unit| unit.0 == found)) {
        return Some(format!("did you mean `{name}`?"));
    }
    if let Some(name) = siblings.iter().find(|name| split_unit(name).0 == stem) {
        return Some(match (unit, split_unit(name).1) {
            (None, Some(_)) => format!("did you mean `{name}`? The unit is part of the name"),
            (Some(ours), Some(theirs)) if ours.1 == theirs.1 && ours.2 != theirs.2 => {
                let factor = number(ours.2 / theirs.2);
                format!("did you mean `{name}`? 1 in `{found}` is {factor} in `{name}`")
            }
            _ => format!("did you mean `{name}`?"),
        });
    }
    // `roller_count` for `rollers` is near; so is `diameter` inside `roller_diameter_mm`, once the unit is
    // off.
    if let Some(name) = nearest(found, siblings) {
        return Some(format!("did you mean `{name}`?"));
    }
    if let Some(name) = siblings.iter().find(|name| stem.len() >= PART && split_unit(name).0.contains(stem)) {
        return Some(format!("did you mean `{name}`?"));
    }
    let elsewhere = all.iter().find_map(|path| {
        let (section, name) = path.rsplit_once('.')?;
        (name == found || split_unit(name).0 == stem).then_some((section, name))
    });
    if let Some((section, name)) = elsewhere {
        return Some(format!("`{name}` belongs in `{section}: ( … )`"));
    }
    let stems: Vec<&str> = siblings.iter().map(|name| split_unit(name).0).collect();
    let near = nearest(stem, &stems)?;
    let name = siblings.iter().find(|name| split_unit(name).0 == near)?;
    Some(format!("did you mean `{name}`?"))
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIBLINGS: &[&str] = &["load_n", "speed_rpm", "gravity_m_s2"];
    const ALL: [&str; 4] = ["bearing.rollers", "mesh.size_mm", "operation.load_n", "solver.duration_ms"];

    fn said(found: &str) -> String {
        field(found, SIBLINGS, &ALL.map(str::to_owned)).expect("something is like it")
    }

    #[test]
    fn refuses_a_missing_unit_and_proposes_it() {
        assert!(said("load").contains("`load_n`"));
    }

    #[test]
    fn refuses_the_words_of_catalogues_and_names_ours() {
        let siblings = ["rollers", "roller_diameter_mm", "outer_race_diameter_mm", "outside_mm"];
        for (found, ours) in [
            ("balls", "rollers"),
            ("ball_diameter_mm", "roller_diameter_mm"),
            ("outer_diameter_mm", "outside_mm"),
            ("ball_diameter", "roller_diameter_mm"),
            ("D", "outside_mm"),
        ] {
            assert_eq!(field(found, &siblings, &[]), Some(format!("did you mean `{ours}`?")));
        }
        // Where there is no such field, the nearest name.
        assert!(
            field("outer_diameter_mm", &["outer_race_diameter_mm"], &[]).is_some_and(|s| s.contains("race"))
        );
    }

    #[test]
    fn refuses_another_unit_and_converts_it() {
        assert_eq!(said("load_kn"), "did you mean `load_n`? 1 in `load_kn` is 1000 in `load_n`");
        assert!(said("gravity_g").contains("9.80665 in `gravity_m_s2`"));
    }

    #[test]
    fn refuses_a_unit_alone_and_names_its_field() {
        assert_eq!(said("rpm"), "did you mean `speed_rpm`?");
    }

    #[test]
    fn refuses_a_typing_error_and_recognises_it() {
        assert_eq!(said("sped_rpm"), "did you mean `speed_rpm`?");
        assert_eq!(nearest("acr", &["facet", "arc", "nagata"]), Some("arc"));
        assert_eq!(nearest("arx", &["facet", "arc", "nagata"]), Some("arc"));
    }

    #[test]
    fn refuses_a_name_in_the_wrong_section_and_says_where_it_belongs() {
        assert_eq!(said("size_mm"), "`size_mm` belongs in `mesh: ( … )`");
        assert_eq!(said("duration"), "`duration_ms` belongs in `solver: ( … )`");
    }

    #[test]
    fn behaves_to_a_stranger_nothing_is_like() {
        assert_eq!(field("qqq", SIBLINGS, &ALL.map(str::to_owned)), None);
    }
}
