//! Variants: meshes, steps and contacts of one bearing, each from several starts.

use crate::Variant;

/// The default bearing, graded and with elements of one size.
const LEAN: &str = "fixtures/scenes/lean.ron";
const UNIFORM: &str = "fixtures/scenes/oiled_steel.ron";

/// Until a millisecond behind the last start's exit.
const SHORT: [&str; 2] = ["solver.duration_ms=6.5", "output.frames=None"];

/// Element size of the scene as it is [mm].
const BASE_MM: f64 = 0.5;

/// Contact with the circles that the polygons stand for.
const ARCS: [&str; 4] = [
    "contact.surface=arc",
    "contact.interpolation=spline",
    "contact.points_per_facet=8",
    "contact.onset_um=8.0",
];

/// One way to simulate the bearing, and its starts.
pub(super) struct Choice {
    /// Points of one curve differ in their element size alone.
    pub(super) curve: &'static str,
    pub(super) name: String,
    pub(super) shows: &'static str,
    /// Whether the others are held against this one.
    pub(super) reference: bool,
    pub(super) starts: Vec<Variant>,
}

/// The scene at another element size under the same contact: stiffness and damping over an area stay, facets
/// and layers are as many as elements of that size make.
fn sized(size_mm: f64) -> Vec<String> {
    let finer = BASE_MM / size_mm;
    let count = |base: f64| (base * finer).round().max(1.0) as usize;
    vec![
        format!("mesh.size_mm={size_mm:?}"),
        format!("mesh.roller_facets={}", count(28.0) * 4),
        format!("contact.penalty_scale={:?}", 0.05 / finer),
        format!("contact.damping_ratio={:?}", 0.1 * finer.sqrt()),
        format!("contact.points_per_facet={}", count(16.0).clamp(4, 16)),
    ]
}

fn graded(size_mm: f64) -> Vec<String> {
    let layers = (2.0 * BASE_MM / size_mm).round().max(2.0);
    let mut set = sized(size_mm);
    set.push(format!("mesh.grading.fine_layers={layers}"));
    // Elements are never larger far from the contacts than near them.
    set.push(format!("mesh.grading.coarse_mm={:?}", size_mm.max(0.5) * 4.0));
    set
}

/// All choices; `starts` of each, and `few` of the reference, whose elements are of `finest` [mm] at the
/// contacts.
pub(super) fn choices(starts: u16, few: u16, finest: f64) -> Vec<Choice> {
    let owned = |set: &[&str]| set.iter().map(|s| (*s).to_owned()).collect::<Vec<String>>();
    let choice = |curve, name: &str, shows, scene, set: Vec<String>, starts: u16| {
        let id: String =
            name.chars().filter(|c| !matches!(c, ',' | '.')).collect::<String>().replace(' ', "-");
        let id = id.replace('Δ', "d").replace('×', "x").replace('µ', "u");
        let variant = |k: u16| {
            let all = set
                .iter()
                .fold(Variant::new(format!("{id}-{k:03}"), scene, &SHORT), |v, s| v.with(s.clone()));
            all.with(format!("bearing.first_roller_deg={:.3}", first_roller_deg(k)))
        };
        let starts = (0..starts).map(variant).collect();
        Choice { curve, name: name.to_owned(), shows, reference: false, starts }
    };
    let mut all = Vec::new();
    for (name, size) in [("uniform, 2 mm", 2.0), ("uniform, 1 mm", 1.0), ("uniform, 0.5 mm", 0.5)] {
        let shows =
            if size == BASE_MM { "the paper\u{2019}s mesh" } else { "elements of one size throughout" };
        all.push(choice("uniform", name, shows, UNIFORM, sized(size), starts));
    }
    for size in [2.0, 1.0, 0.5, 0.25, 0.125].into_iter().filter(|&size| size >= finest) {
        let reference = size == finest;
        let (shows, starts) = if reference {
            ("the reference", few)
        } else {
            ("fine elements at the raceways and rims only", starts)
        };
        let named = format!("graded, {size} mm");
        all.push(Choice { reference, ..choice("graded", &named, shows, LEAN, graded(size), starts) });
    }
    let lean = [
        ("half the step", "Δt × 0.5", "0.49 of the critical step", owned(&["solver.time_step_factor=0.49"])),
        ("collocated", "collocated", "pressure lumped at nodes", owned(&["contact.method=collocated"])),
        ("4 points", "4 points a facet", "instead of 16", owned(&["contact.points_per_facet=4"])),
        ("arcs", "arcs", "contact that sees neither facets nor nodes", owned(&ARCS)),
    ];
    for (curve, name, shows, set) in lean {
        let all_set = graded(BASE_MM).into_iter().chain(set).collect();
        all.push(choice(curve, &format!("graded, 0.5 mm, {name}"), shows, LEAN, all_set, starts));
    }
    let arcs = graded(1.0).into_iter().chain(owned(&ARCS)).collect();
    all.push(choice("arcs", "graded, 1 mm, arcs", "the same on coarser elements", LEAN, arcs, starts));
    let mut reduced = |curve, [khz, step_us]: [f64; 2], shows, name: &str, mesh: Vec<String>| {
        let model = format!("model=reduced(modes_khz: {khz:?}, step_us: {step_us:?})");
        let name = format!("reduced, {khz} kHz, {step_us} µs{name}");
        all.push(choice(curve, &name, shows, LEAN, mesh.into_iter().chain([model]).collect(), starts));
    };
    for (step_us, shows) in [
        (5.0, "its longest step"),
        (2.0, "the reduced model"),
        (1.0, "half its step"),
        (0.5, "a quarter of it"),
    ] {
        reduced("reduced", [30.0, step_us], shows, "", graded(BASE_MM));
    }
    for (khz, shows) in [(5.0, "fewer modes"), (15.0, "fewer modes"), (60.0, "more modes")] {
        reduced("its modes", [khz, 1.0], shows, "", graded(BASE_MM));
    }
    for size in [2.0, 1.0] {
        reduced("its facets", [30.0, 1.0], "fewer facets", &format!(", {size} mm"), graded(size));
    }
    let arcs = graded(BASE_MM).into_iter().chain(owned(&ARCS)).collect();
    reduced("on arcs", [30.0, 1.0], "without facets", ", arcs", arcs);
    all
}

/// Angle of the first roller in start `k` [°]: 0.01° of the cage apart, to either side in turn, so that more
/// starts keep those that there are.
fn first_roller_deg(k: u16) -> f64 {
    94.0 + 0.01 * f64::from(k.div_ceil(2)) * if k.is_multiple_of(2) { 1.0 } else { -1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_hand_a_finer_mesh_keeps_the_stiffness_of_an_area() {
        let set = graded(0.25);
        for field in ["mesh.roller_facets=224", "contact.penalty_scale=0.025", "mesh.grading.fine_layers=4"] {
            assert!(set.iter().any(|s| s == field), "{field} is not in {set:?}");
        }
        let names: Vec<String> = choices(3, 1, 0.125).iter().map(|c| c.starts[0].name.clone()).collect();
        let mut once = names.clone();
        once.sort_unstable();
        once.dedup();
        assert_eq!(once.len(), names.len(), "{names:?}");
        for finest in [0.125, 0.25] {
            let all = choices(3, 1, finest);
            let reference = all.iter().find(|c| c.reference).expect("a reference");
            assert_eq!(
                (reference.name.as_str(), reference.starts.len()),
                (&*format!("graded, {finest} mm"), 1)
            );
        }
    }
}
