//! Bearings of the catalogue: each is meshed, and rests as theory says.

use std::{
    num::NonZero,
    sync::atomic::{AtomicUsize, Ordering},
};

use stribeck_bearing::{assembly::Assembly, start::preload};
use stribeck_scene::{catalogue, scene::Scene, static_load};

/// What `of` makes of each case, in their order, on as many threads as there are cores.
fn side_by_side<T: Sync, R: Send>(cases: &[T], of: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let next = AtomicUsize::new(0);
    let one_after_another = || {
        let mut done = Vec::new();
        loop {
            let at = next.fetch_add(1, Ordering::Relaxed);
            let Some(case) = cases.get(at) else { return done };
            done.push((at, of(case)));
        }
    };
    let threads = std::thread::available_parallelism().map_or(1, NonZero::get);
    let mut all: Vec<(usize, R)> = std::thread::scope(|scope| {
        let working: Vec<_> = (0..threads).map(|_| scope.spawn(one_after_another)).collect();
        working.into_iter().flat_map(|one| one.join().expect("no case panics")).collect()
    });
    all.sort_by_key(|(at, _)| *at);
    all.into_iter().map(|(_, result)| result).collect()
}

/// Light and medium series from a bore of 15 to one of 60 mm, by three places of their flanges.
#[test]
fn example_cylindrical_roller_bearings_of_two_series_are_meshed_and_say_what_is_assumed() {
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

/// How far the forces on rollers are from theory at most, in parts of the largest, and that largest force
/// [N].
fn off_from_rigid_rings(bearing: &str, defects: &str) -> (f64, f64) {
    // Penalty by ten times the stiffness of an element leaves the approach to the bodies; elements in
    // proportion to the rollers.
    let text = format!(
        "(bearing: \"{bearing}\", film: None, defect: None, housing: rigid(), operation: (speed_rpm: 0, \
         gravity_m_s2: 0),
          defects: [{defects}],
          mesh: (roller_facets: 160, grading: ()), contact: (surface: arc, penalty_scale: 10))"
    );
    let scene = Scene::parse(&text, "here").expect("valid").resolve();
    let assembly = Assembly::new(&scene).expect("a mesh");
    let mut machine = assembly.machine(&scene, 1).expect("a machine");
    let warning = preload(&mut machine, &scene, &assembly.kinematics).expect("an equilibrium");
    assert_eq!(warning, None, "{bearing} {defects}");
    let _ = machine.system.contact_forces();
    let force: Vec<f64> = machine.system.resultants().map(|r| r.force[0].hypot(r.force[1])).collect();
    let theory = static_load::at_start(&scene).expect("an equilibrium");
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
/// Source: Stribeck and Sjövall's distribution between rigid rings with Johnson's approach of line contacts,
/// THEORY §6.2.
#[test]
fn analytic_rollers_between_rigid_rings() {
    const SHARE: f64 = 0.02;
    let of_flanges = |name: &str| ["NJ ", "NUP ", "N "].iter().any(|flanges| name.starts_with(flanges));
    let mut cases: Vec<(String, &str)> = catalogue::all()
        .into_iter()
        .filter(|bearing| bearing.angle_deg == 0.0 && !of_flanges(&bearing.name))
        .map(|bearing| (bearing.name, ""))
        .collect();
    assert!(cases.len() > 27, "{cases:?}");
    cases.push(("NU 205".into(), "(on: roller(1), form: missing)"));
    let off = side_by_side(&cases, |(bearing, defects)| {
        let (off, largest) = off_from_rigid_rings(bearing, defects);
        println!("{bearing} {defects}: {:.2} % of {largest:.0} N", 100.0 * off);
        off
    });
    for ((bearing, defects), off) in cases.iter().zip(off) {
        assert!(off < SHARE, "{bearing} {defects}: off by {off} of the largest force");
    }
}
