//! Steps of reduced bearings, with a sample after every few of them as in a run: the paper's in the modes
//! below 30 kHz, on polygons and on arcs, and a 6205 on arcs in a rigid housing, dry and with oil and
//! roughness. The modes are made once and kept in the folder for temporary files.

use std::path::Path;
use std::time::Instant;

use stribeck_reduced::motion::{BearingInMotion, Saved};
use stribeck_scene::scene::Scene;
use stribeck_simulation::reduced::{Prepared, prepared};

/// Samples before the first measurement: the start has been left, and rollers have passed the spall.
const FIRST: usize = 2000;

/// Samples that are measured, each by itself; the median counts.
const MEASURED: usize = 4000;

/// A 6205 on arcs, which is rigid but for its contacts.
const RIGID: [&str; 4] = [
    "contact.surface=arc",
    "contact.penalty_scale=1.1",
    "housing=rigid(mass_kg: 10)",
    "defect=(ring: outer, length_mm: 2, depth_mm: 0.1)",
];

/// Oil and roughness besides.
const OILED: [&str; 2] = [
    "film=()",
    "defects=[(on: outer, angle_deg: 250, form: roughness(rq_um: 0.05)), (on: inner, form: roughness(rq_um: \
     0.05, seed: 2))]",
];

fn main() {
    // `cargo test` runs benches too, with this flag: nothing to measure then.
    if !std::env::args().any(|argument| argument == "--bench") {
        return;
    }
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../fixtures/scenes");
    let scene = |file: &str, overrides: &[&str]| {
        let overrides: Vec<String> = overrides.iter().map(|&text| text.to_owned()).collect();
        let scene = Scene::read(scenes.join(file)).expect("a scene that can be read");
        scene.with_overrides(&overrides).expect("a scene").resolve()
    };
    for (name, scene) in [
        ("polygons", scene("reduced.ron", &["contact.surface=facet"])),
        ("arcs", scene("reduced.ron", &["contact.surface=arc"])),
        ("6205, rigid, arcs", scene("deep_groove.ron", &RIGID)),
        ("6205, rigid, arcs, oil", scene("deep_groove.ron", &[&RIGID[..], &OILED].concat())),
    ] {
        let kept = std::env::temp_dir().join("stribeck-bench");
        let Prepared { bearing, start, steps_per_sample, .. } =
            prepared(&scene, Some(&kept)).expect("the scene can be reduced");
        let saved = Saved::first(&bearing, start);
        let mut motion = BearingInMotion::new(bearing, saved);
        let sample = |motion: &mut BearingInMotion| motion.interval(steps_per_sample);
        (0..FIRST).for_each(|_| _ = sample(&mut motion));
        let mut times = [0.0; MEASURED].map(|_: f64| {
            let start = Instant::now();
            sample(&mut motion);
            start.elapsed().as_nanos() as f64 / steps_per_sample as f64
        });
        times.sort_by(f64::total_cmp);
        println!("{name:<24}{:>7.2} µs a step", 1e-3 * times[MEASURED / 2]);
    }
}
