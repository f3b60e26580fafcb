//! Bearings of the catalogue: each is meshed, and rests as theory says.

use stribeck_scene::{catalogue, scene::Scene};
use stribeck_simulation::bearing::{assembly::Assembly, start::preload};
use stribeck_testing::side_by_side;

/// Light and medium series from a bore of 15 to one of 60 mm, by three places of their flanges.
#[test]
fn behaves_cylindrical_roller_bearings_of_two_series_are_meshed_and_say_what_is_assumed() {
    let names: Vec<String> = ["NU", "N", "NJ"]
        .iter()
        .flat_map(|flanges| (202..=212).chain(302..=312).map(move |size| format!("{flanges} {size}")))
        .collect();
    assert_eq!(names.len(), 66);
    let scenes: Vec<Scene> = names
        .iter()
        .map(|name| {
            let text = format!("(bearing: \"{name}\", mesh: (roller_facets: 48, grading: ()))");
            Scene::parse(&text, "here").unwrap_or_else(|why| panic!("{name}: {why}"))
        })
        .collect();
    // The first third is meshed; the others are the same but for their names.
    let sizes = scenes.len() / 3;
    let elements = side_by_side(&scenes[..sizes], |scene| {
        let name = &scene.bearing.designation;
        let assembly = Assembly::new(&scene.resolve()).unwrap_or_else(|why| panic!("{name}: {why}"));
        assembly.model.mesh.elements()
    });
    for (at, (name, scene)) in names.iter().zip(&scenes).enumerate() {
        let (elements, meshed) = (elements[at % sizes], &scenes[at % sizes]);
        assert!(elements > 1000, "{name}: {elements} elements");
        assert_eq!(&scene.bearing.designation, name);
        let mut same = scene.clone();
        same.name.clone_from(&meshed.name);
        same.bearing.designation.clone_from(&meshed.bearing.designation);
        assert_eq!(&same, meshed, "{name}");
        let notes = catalogue::assumptions(&scene.bearing);
        let says = |words: &str| notes.iter().any(|note| note.contains(words) && note.contains(name));
        assert!(says(&format!("{} are assumed here", scene.bearing.rollers)), "{name}: {notes:?}");
        assert!(says("clearance, cage and the length of the rollers"), "{name}: {notes:?}");
        assert_eq!(says("no catalogue known here prints the raceways"), name.ends_with("302"), "{name}");
        // ISO 15: bores of 15 and 17 mm have codes of their own, those above are five times theirs.
        let size: f64 = name[name.len() - 2..].parse().expect("two digits");
        let bore = scene.bearing.inner_race_diameter_mm - 2.0 * scene.bearing.inner_ring_thickness_mm;
        let expected = if size < 4.0 { [15.0, 17.0][size as usize - 2] } else { 5.0 * size };
        assert!((bore - expected).abs() < 1e-3, "{name}: a bore of {bore} mm");
    }
}

/// Rigid rings at rest, with contact as any bearing but the paper's has it.
const RIGID: [&str; 8] = [
    "film=None",
    "defect=None",
    "housing=rigid()",
    "operation.speed_rpm=0",
    "operation.gravity_m_s2=0",
    "mesh.grading=()",
    "contact.surface=arc",
    "contact.formula=hertz",
];

/// How far the forces on rollers are from theory at most, in parts of the largest, and that largest force
/// [N].
fn off_from_rigid_rings(scene: &Scene) -> (f64, f64) {
    let scene = scene.resolve();
    let bearing = &scene.written.name;
    let assembly = Assembly::new(&scene).expect("a mesh");
    let mut machine = assembly.build(&scene, 1).expect("a machine");
    let warning = preload(&mut machine, &scene, &assembly.kinematics).expect("an equilibrium");
    assert_eq!(warning, None, "{bearing}");
    let _ = machine.system.contact_forces();
    let force: Vec<f64> = machine.system.resultants().map(|r| r.force[0].hypot(r.force[1])).collect();
    let theory = scene.static_load().expect("an equilibrium");
    let largest = theory.max_roller_n();
    let off = theory
        .roller_n
        .iter()
        .enumerate()
        .map(|(i, expected)| (force[machine.pairs.outer(i)] - expected).abs() / largest);
    (off.fold(0.0, f64::max), largest)
}

/// Every bearing of the catalogue that a plane model has, one of those that differ by their flanges alone,
/// and one that lacks the roller under the load.
/// Source: Stribeck and Sjövall's distribution between rigid rings with Johnson's approach of line contacts and
/// Hertz's of balls, THEORY §6.2.
#[test]
fn analytic_rollers_between_rigid_rings() {
    const SHARE: f64 = 0.02;
    let of_flanges = |name: &str| ["NJ ", "NUP ", "N "].iter().any(|flanges| name.starts_with(flanges));
    let mut cases: Vec<(String, &str)> = stribeck_theory::catalogue::all()
        .iter()
        .filter(|bearing| bearing.angle_deg == 0.0 && !of_flanges(&bearing.name))
        .filter(|bearing| bearing.boundary.is_some() || bearing.name == stribeck_theory::catalogue::PAPER)
        .map(|bearing| (bearing.name.clone(), ""))
        .collect();
    // Narrow and wide series have the same rollers, and further sizes differ by their size alone.
    let one_of_many = |name: &str| {
        let wide = name.starts_with("NU ") && name.len() == 7;
        let large = (13..20).any(|size| name == format!("NU 2{size}") || name == format!("NU 3{size}"));
        let sized = ["6", "160", "UC"].iter().any(|series| name.starts_with(series));
        let kept = [
            "NU 2210", "NU 1010", "6004", "6203", "6205", "6206", "6209", "6305", "6320", "UC206", "62205",
            "6410", "6812", "6905", "16012",
        ];
        (wide || large || sized) && !kept.contains(&name)
    };
    cases.retain(|(name, _)| !one_of_many(name));
    assert!(cases.len() > 27, "{cases:?}");
    cases.push(("NU 205".into(), "(on: roller(1), form: missing)"));
    let off = side_by_side(&cases, |(bearing, defects)| {
        let set = [format!("bearing={bearing}"), format!("defects=[{defects}]")];
        let set: Vec<&str> = RIGID.into_iter().chain(set.iter().map(String::as_str)).collect();
        let scene = Scene::default().with_overrides(&set).expect("valid");
        let (off, largest) = off_from_rigid_rings(&scene);
        println!("{bearing} {defects}: {:.2} % of {largest:.0} N", 100.0 * off);
        off
    });
    for ((bearing, defects), off) in cases.iter().zip(off) {
        assert!(off < SHARE, "{bearing} {defects}: off by {off} of the largest force");
    }
}

/// A ball of the mesh has the mass of a ball, its rings that of their width.
#[test]
fn by_hand_masses_of_a_ball_bearing() {
    let scene = Scene::default().with_overrides(&RIGID).expect("valid");
    let scene = scene.with_overrides(&["bearing=6305", "mesh.roller_facets=80"]).expect("valid").resolve();
    let machine = Assembly::new(&scene).expect("a mesh").build(&scene, 1).expect("a machine");
    let mass = |body: usize| machine.system.nodes_of(body).map(|n| machine.system.mass(n)).sum::<f64>();
    let (r, pi, rho) = (scene.roller_radius, std::f64::consts::PI, scene.material.density);
    let (race, bore) = (scene.inner_race_radius, scene.inner_race_radius - scene.inner_ring_thickness);
    for (body, expected, tolerance) in [
        (machine.rollers[0].body, 4.0 / 3.0 * pi * r.powi(3) * rho, 2e-3),
        (machine.inner, pi * (race * race - bore * bore) * 17e-3 * rho, 2e-3),
    ] {
        let off = mass(body) / expected - 1.0;
        assert!(off.abs() < tolerance, "{off}");
    }
}

/// Ten bearings by their own fields, from 4 to 30 rollers and from 5 to 300 mm of bore, each as its file has
/// it but between rigid rings.
/// Source: as above, THEORY §6.2; 5 % is the limit of the rule for own bearings, whichever of their fields
/// were assumed.
#[test]
fn analytic_own_bearings_between_rigid_rings() {
    const SHARE: f64 = 0.05;
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../fixtures/scenes/own");
    let mut files: Vec<_> =
        std::fs::read_dir(folder).expect("fixtures").flatten().map(|entry| entry.path()).collect();
    files.sort();
    assert_eq!(files.len(), 10);
    let off = side_by_side(&files, |file| {
        let scene = Scene::read_with(file, &RIGID).unwrap_or_else(|why| panic!("{why}"));
        let (off, largest) = off_from_rigid_rings(&scene);
        println!("{}: {:.2} % of {largest:.0} N", scene.name, 100.0 * off);
        off
    });
    for (file, off) in files.iter().zip(off) {
        assert!(off < SHARE, "{}: off by {off} of the largest force", file.display());
    }
}
