//! Variants of the study of impulses: meshes, each from many starts.

use crate::Variant;
use crate::noise::variants::{ARC, FINE, LEAN, ONSET, POINTS, SPLINE, TRANSLATED, UNIFORM};

/// Until a millisecond behind the last start's exit.
const SHORT: [&str; 2] = ["solver.duration_ms=6.5", "output.frames=None"];

/// Pockets in which a roller has hardly any room.
const TIGHT: &str = "cage.pocket_clearance_um=10.0";

/// Meshes under one cage; the reference comes last.
pub(super) struct Family {
    pub(super) name: &'static str,
    /// Prefix of its pictures' names.
    pub(super) id: &'static str,
    pub(super) meshes: Vec<Mesh>,
}

/// A mesh and its starts.
pub(super) struct Mesh {
    pub(super) name: &'static str,
    pub(super) shows: &'static str,
    pub(super) starts: Vec<Variant>,
}

/// Compared meshes, with the number of starts of each, and half as many in tight pockets, where the scatter
/// is smaller.
pub(super) fn families(starts: u16) -> [Family; 2] {
    let few = (starts / 2).max(2);
    let cure = [ARC, SPLINE, ONSET];
    let with = |set: &[&'static str]| -> Vec<&'static str> { cure.iter().chain(set).copied().collect() };
    let (cured, fine) = (with(&[POINTS]), with(&FINE));
    let tight = |set: &[&'static str]| -> Vec<&'static str> { set.iter().copied().chain([TIGHT]).collect() };
    let pockets = vec![
        all("chords", "0.5 mm, graded, the default scene\u{2019}s method", LEAN, &[], starts),
        all("cured", "0.5 mm, graded, the cure", LEAN, &cured, starts),
        all("uniform", "0.5 mm throughout, the cure", UNIFORM, &cured, starts),
        all(
            "fine",
            "0.25 mm, graded, the cure with the contact\u{2019}s stiffness and damping over an area and its \
             onset unchanged",
            LEAN,
            &fine,
            starts,
        ),
    ];
    let tight_pockets = vec![
        all("tight-cured", "as cured, in tight pockets", LEAN, &tight(&cured), few),
        all("tight-fine", "as fine, in tight pockets", LEAN, &tight(&fine), few),
    ];
    [
        Family { name: "pockets with 0.1 mm of room", id: "", meshes: pockets },
        Family { name: "pockets with 0.01 mm of room", id: "tight-", meshes: tight_pockets },
    ]
}

fn all(name: &'static str, shows: &'static str, scene: &'static str, set: &[&str], starts: u16) -> Mesh {
    let start = |number: u16| {
        // To either side in turn, so that more starts keep those that there are.
        let hundredths = i32::from(number.div_ceil(2)) * if number.is_multiple_of(2) { 1 } else { -1 };
        let degrees = 94.0 + 0.01 * f64::from(hundredths);
        let set: Vec<&str> = set.iter().chain(&SHORT).copied().chain([TRANSLATED]).collect();
        Variant::new(format!("{name}-{number:03}"), scene, &set)
            .with(format!("bearing.first_roller_deg={degrees:.3}"))
    };
    Mesh { name, shows, starts: (0..starts).map(start).collect() }
}
