//! What is run for the study of impulses: meshes, each from many starts.

use crate::study::Variant;
use crate::study::noise::variants::{ARC, FINE, LEAN, ONSET, POINTS, SPLINE, TRANSLATED, UNIFORM};

/// Until a millisecond behind the last start's exit.
const SHORT: [&str; 2] = ["solver.duration_ms=6.5", "output.frames=None"];

/// Name and meaning of each mesh, and its starts; the reference comes last.
pub(super) fn groups(starts: u16) -> Vec<(&'static str, &'static str, Vec<Variant>)> {
    let cure = [ARC, SPLINE, ONSET];
    let with = |set: &[&'static str]| -> Vec<&'static str> { cure.iter().chain(set).copied().collect() };
    vec![
        ("chords", "0.5 mm, graded, the default scene\u{2019}s method", all("chords", LEAN, &[], starts)),
        ("cured", "0.5 mm, graded, the cure", all("cured", LEAN, &with(&[POINTS]), starts)),
        ("uniform", "0.5 mm throughout, the cure", all("uniform", UNIFORM, &with(&[POINTS]), starts)),
        (
            "fine",
            "0.25 mm, graded, the cure with the contact\u{2019}s stiffness and damping over an area and its onset unchanged",
            all("fine", LEAN, &with(&FINE), starts),
        ),
    ]
}

fn all(name: &str, scene: &'static str, set: &[&str], starts: u16) -> Vec<Variant> {
    let start = |number: u16| {
        // To either side in turn, so that more starts keep those that there are.
        let hundredths = i32::from(number.div_ceil(2)) * if number.is_multiple_of(2) { 1 } else { -1 };
        let degrees = 94.0 + 0.01 * f64::from(hundredths);
        let set: Vec<&str> = set.iter().chain(&SHORT).copied().chain([TRANSLATED]).collect();
        Variant::new(format!("{name}-{number:03}"), scene, &set)
            .with(format!("bearing.first_roller_deg={degrees:.3}"))
    };
    (0..starts).map(start).collect()
}
