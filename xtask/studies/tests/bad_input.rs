//! Scenes, overrides, tables, campaigns, runs, meshes and dimensions as a user may get them wrong: every one
//! gets a value or an error with words, and none a panic or an endless search. Files of signals are damaged in
//! `formats/tests/kinds/mutations.rs`. `PROPTEST_CASES` makes any number of each.

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use proptest::prelude::*;
use proptest::test_runner::{TestCaseResult, TestRunner};
use stribeck::host;
use stribeck_mesh::decks::Deck;
use stribeck_mesh::{Annulus, ArcBlock, Circle, Disc, Grading, Groove, Mesh, Rectangle, SeatedBlock};
use stribeck_scene::scene::Scene;
use stribeck_simulation as simulation;
use stribeck_simulation::bearing::assembly::Assembly;
use stribeck_simulation::run::host::Progress;
use stribeck_solver::{Dynamics, Elastic, Model};
use stribeck_store::campaign::Campaign;
use stribeck_store::run_dir::{Run, RunDir};
use stribeck_testing::Scratch;
use stribeck_testing::damage::{any_number, cases, damaged, damaged_text};

/// An answer that takes longer hangs: the largest takes a tenth of that on a busy machine.
const PATIENCE: Duration = Duration::from_secs(20);

/// A scene of everything that goes over time.
const DUTY: &str =
    "(operation: (speed_rpm: -300, speed_profile: points([(0.0, 500.0), (20.5, -1e2), (30, 0)]),
    load_profile: harmonic(amplitude: 5000.0, hz: 25.0, phase_deg: 90.0), rotating_load: (force_n: 1000.0)))";
const TABLE: &str = "time_ms, value # by hand\n0.0, 500.0\n10, 600\n20.25, 1e2\n30,-50.5\n";
const CAMPAIGN: &str =
    "(name: \"x\", scene: \"scene.ron\", set: [\"cage=None\", \"mesh.size_mm=4.0\"], seed: 3,
    starts: 2, split: (train: 0.5, validation: 0.25, test: 0.25), keep: numbers,
    variants: sobol(count: 4, over: [(field: \"operation.load_n\", from: 5e3, to: 5e4, log: true),
    (field: \"defects\", values: [[], [(on: roller(1), form: dent())]])]))";

/// Bytes before the content of a checkpoint; length and checksum are the last twelve.
const HEADER: usize = 52;

/// Largest product of numbers of elements along the sides of what is meshed.
const SMALL: f64 = 3e4;

fn fixture(path: &str) -> String {
    let path = stribeck_studies::root().join("fixtures").join(path);
    std::fs::read_to_string(&path).unwrap_or_else(|why| panic!("{}: {why}", path.display()))
}

/// Tries many inputs; a failure shrinks, and says its input.
fn survives<S: Strategy>(count: u32, inputs: S, attempt: impl Fn(S::Value) -> TestCaseResult) {
    let timed = |input| {
        let began = Instant::now();
        attempt(input)?;
        prop_assert!(began.elapsed() < PATIENCE, "it took {:?}", began.elapsed());
        Ok(())
    };
    TestRunner::new(cases(count)).run(&inputs, timed).unwrap_or_else(|why| panic!("{why}"));
}

/// The value; an error must have words.
fn answered<T, E: std::fmt::Display>(result: Result<T, E>) -> Result<Option<T>, TestCaseError> {
    match result {
        Ok(value) => Ok(Some(value)),
        Err(why) => {
            prop_assert!(why.to_string().len() > 10, "refused without words: {why}");
            Ok(None)
        }
    }
}

/// Whether a scene's mesh is small enough to be made hundreds of times.
fn small(scene: &Scene) -> bool {
    let (b, size) = (&scene.bearing, scene.mesh.size_mm);
    let area = 8.0 * b.outer_race_diameter_mm * (b.outer_ring_thickness_mm + b.inner_ring_thickness_mm)
        + scene.adapter.width_mm * (scene.adapter.height_mm + b.outer_race_diameter_mm);
    let cage = scene.cage.as_ref().map_or(0.0, |c| 10.0 * c.outer_diameter_mm * c.thickness_mm);
    let given = scene.mesh.outer_facets.unwrap_or(0).max(scene.mesh.inner_facets.unwrap_or(0)) as f64;
    let given = given * (b.outer_ring_thickness_mm.max(b.inner_ring_thickness_mm) / size).max(1.0);
    let rollers = b.rollers as f64 * (scene.mesh.roller_facets as f64).powi(2) / 8.0;
    area / (size * size) + rollers + cage + given < SMALL
}

#[test]
fn survives_damaged_scenes() {
    let files = ["singh2014", "oiled_steel", "lean", "quick", "ramp", "pitted"];
    let mut texts: Vec<String> = files.iter().map(|name| fixture(&format!("scenes/{name}.ron"))).collect();
    texts.push(DUTY.to_owned());
    let texts: Vec<&str> = texts.iter().map(String::as_str).collect();
    survives(4000, (damaged_text(&texts), 0..20), |(text, build)| {
        let Some(scene) = answered(Scene::parse(&text, "damaged.ron"))? else { return Ok(()) };
        // Now and then its bodies are made, too.
        if build == 0 && small(&scene) {
            let scene = scene.resolve();
            if let Some(assembly) = answered(Assembly::new(&scene))? {
                answered(assembly.build(&scene, 1))?;
            }
        }
        Ok(())
    });
}

#[test]
fn survives_damaged_overrides() {
    #[rustfmt::skip]
    let fields = [
        "mesh.size_mm", "bearing.rollers", "cage", "cage.thickness_mm", "defect", "defect.length_mm", "solver.start",
        "output.sensors", "output.sensors[0].angle_deg", "mesh.grading", "mesh.outer_facets", "name", "operation",
        "operation.speed_profile", "operation.speed_profile.hz", "operation.load_profile", "film.viscosity_pa_s", "",
    ];
    let values = [
        "ramp(from_ms: 0.0, to_ms: 20.0, to: 900.0)",
        "Some((coarse_mm: 2.0, fine_layers: 2))",
        "[(name: \"side\", angle_deg: 0.0)]",
    ];
    let value =
        prop_oneof![damaged_text(&values), any_number().prop_map(|v| format!("{v:?}")), Just("x".to_owned())];
    let scene = Scene::parse(&fixture("scenes/quick.ron"), "quick").expect("a scene");
    survives(2000, (prop::sample::select(fields.to_vec()), value), |(field, value)| {
        answered(scene.with_overrides(&[format!("{field}={value}")])).map(drop)
    });
}

#[test]
fn survives_damaged_tables_of_profiles() {
    let folder = Scratch::create("tables");
    let scenes = [
        "(operation: (speed_profile: table(\"damaged.csv\")))",
        "(operation: (load_profile: table(\"damaged.csv\")))",
        "(film: None, defect: None, defects: [(form: profile(file: \"damaged.csv\"))])",
    ];
    let depth = TABLE.replace("time_ms", "position_mm").replace("value", "depth_um");
    let tables = [TABLE, &depth];
    let bytes = tables.iter().map(|text| ("table".to_owned(), text.as_bytes().to_vec())).collect();
    let table = prop_oneof![3 => damaged_text(&tables).prop_map(String::into_bytes), 1 => damaged(bytes).prop_map(|d| d.1)];
    survives(1000, (prop::sample::select(scenes.to_vec()), table), |(scene, table)| {
        std::fs::write(folder.join("damaged.csv"), table)?;
        std::fs::write(folder.join("table.ron"), scene)?;
        let Some(scene) = answered(Scene::read(folder.join("table.ron")))? else { return Ok(()) };
        let duty = scene.duty();
        let (angle, load) = (duty.shaft_rad(0.02), duty.load_n(0.02));
        prop_assert!(angle.is_finite() && load > 0.0, "an angle of {angle} rad, a load of {load} N");
        Ok(())
    });
}

#[test]
fn survives_damaged_campaigns() {
    let folder = Scratch::create("campaigns");
    std::fs::write(folder.join("scene.ron"), "()").expect("writable");
    let points = "operation.load_n, defect.ring\n5e3, outer\n20000.0, inner\n";
    let table = "(name: \"x\", variants: table(\"points.csv\"))".to_owned();
    let campaign = prop_oneof![
        damaged_text(&[CAMPAIGN]).prop_map(move |text| (text, points.to_owned())),
        damaged_text(&[points]).prop_map(move |points| (table.clone(), points)),
    ];
    survives(400, campaign, |(text, points)| {
        // Counts that are large and allowed make large campaigns, as they should.
        let digits =
            |rest: &str| rest.trim_start().chars().take_while(|c| c.is_ascii_digit() || *c == '_').count();
        prop_assume!(["count:", "starts:"].iter().all(|key| text.split(key).skip(1).all(|r| digits(r) < 4)));
        std::fs::write(folder.join("points.csv"), points)?;
        std::fs::write(folder.join("campaign.ron"), text)?;
        answered(Campaign::read(&folder.join("campaign.ron"))).map(drop)
    });
}

/// A run that was broken off, of which one file at a time is damaged; some checkpoints that can be read are
/// continued: numbers that are none must stop the run, not the program.
#[test]
fn survives_damaged_runs() {
    let folder = Scratch::create("damaged-run");
    let path = folder.join("run");
    let set = ["solver.start=sudden", "solver.duration_ms=0.1", "mesh.size_mm=4.0", "mesh.roller_facets=40"];
    let scene = Scene::parse(&fixture("scenes/quick.ron"), "quick").expect("a scene");
    let scene = scene.with_overrides(&set.map(String::from)).expect("valid fields");
    let dir = RunDir::create(&path).expect("a new folder");
    let mut samples = 0;
    let mut watch = |progress: &Progress| {
        samples += usize::from(progress.phase == "run");
        if samples == 2 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    host::with(1, |host| simulation::simulate(&scene, &dir, host, &mut watch)).expect("a run");
    let names = ["trace.npy", "energy.npy", "checkpoint", "run.json", "scene.ron", "mesh.vtu"];
    let good: Vec<(String, Vec<u8>)> = names
        .iter()
        .map(|name| (name.to_string(), std::fs::read(path.join(name)).expect("a file of the run")))
        .collect();
    let checkpoint = good[2].1.clone();
    drop(dir);
    survives(1200, (damaged(good.clone()), 0..4, 0..20), |((name, mut bytes), fits, goes_on)| {
        if name == "checkpoint" && bytes.len() > HEADER && fits > 0 {
            // Length and checksum fit, so that the damage is deeper.
            let length = ((bytes.len() - HEADER) as u64).to_le_bytes();
            let checksum = crc32fast::hash(&bytes[HEADER..]).to_le_bytes();
            bytes[..HEADER - 12].copy_from_slice(&checkpoint[..HEADER - 12]);
            bytes[HEADER - 12..HEADER - 4].copy_from_slice(&length);
            bytes[HEADER - 4..HEADER].copy_from_slice(&checksum);
        }
        for (name, bytes) in &good {
            std::fs::write(path.join(name), bytes)?;
        }
        std::fs::write(path.join(&name), bytes)?;
        if let Some(run) = answered(Run::read(&path))? {
            answered(run.trace.read_all())?;
        }
        let Some(dir) = answered(RunDir::open(&path))? else { return Ok(()) };
        let saved = answered(simulation::saved_until(&dir))?;
        drop(dir);
        if name != "checkpoint" || saved.is_none() || goes_on > 0 {
            return Ok(());
        }
        // A checkpoint may claim any number of samples to come.
        let began = Instant::now();
        let mut watch = |_: &Progress| {
            if began.elapsed().as_secs() > 0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        let Some(dir) = answered(RunDir::reopen(&path))? else { return Ok(()) };
        answered(host::with(1, |host| simulation::resume(&dir, host, &mut watch))).map(drop)
    });
}

#[test]
fn survives_damaged_meshes() {
    let folder = stribeck_studies::root().join("fixtures/signals/small");
    let read = |name: &str| (name.to_owned(), std::fs::read(folder.join(name)).expect("a mesh"));
    let good = ["binary.msh", "four.msh", "two.msh", "meshio.inp"].map(read).to_vec();
    survives(2000, damaged(good), |(name, bytes)| {
        let deck = Deck::of_extension(&name[name.len() - 3..]).expect("a format that is read");
        answered(deck.read_bytes(&bytes)).map(drop)
    });
}

/// Dimensions and counts of any size for every generator; the solver accepts whatever they make.
#[test]
fn survives_shapes_of_any_size() {
    let length = || prop_oneof![1 => any_number(), 1 => 0.0..1e-6_f64, 4 => 0.0..0.2_f64];
    // Counts that are large and allowed make large meshes, as they should; they are left out.
    let count = || prop_oneof![1 => 0..3_usize, 1 => (40..63_u32).prop_map(|n| 1 << n), 6 => 0..150_usize];
    let groove = (0.0..7.0_f64, length(), 0.0..0.02_f64, 0.0..1.6_f64, any::<bool>());
    let grooves = prop::collection::vec(groove, 0..4);
    let lengths = prop::array::uniform4(length());
    let numbers = (lengths, prop::array::uniform4(count()), 0..6, grooves, any_number());
    survives(600, numbers, |([a, b, c, d], [n, m, k, l], shape, grooves, angle)| {
        let part = match shape {
            0 => Rectangle { x0: a, y0: b, width: c, height: d, columns: n, rows: m }.part(),
            1 => {
                // Fine squares that are allowed make a large core.
                let size = if b < 0.02 * a && b > 1e-4 * a { 0.02 * a } else { b };
                let disc = Disc { radius: a, facets: n, size, rotation: angle };
                if k % 2 == 0 { disc.part() } else { disc.part_with_layers(m) }
            }
            2 | 3 => {
                let side = |inner| if inner { Circle::Inner } else { Circle::Outer };
                let grooves: Vec<Groove> = grooves
                    .iter()
                    .map(|&(centre_angle, length, depth, slope, inner)| Groove {
                        centre_angle,
                        length,
                        depth,
                        slope,
                        circle: side(inner),
                    })
                    .collect();
                let outer_radius = if k % 4 == 0 { b } else { a + b.min(0.05) };
                // Relaxing the cells around a deep groove takes seconds for a hundred layers.
                let layers = if grooves.is_empty() { m } else { m % 30 };
                let start_angle = angle.rem_euclid(1.0);
                let ring = Annulus { inner_radius: a, outer_radius, facets: n, layers, start_angle, grooves };
                let grading = Grading { fine: side(k % 2 == 0), fine_layers: k, transitions: l % 14 };
                if shape == 2 { ring.part() } else { ring.graded_part(&grading) }
            }
            4 => {
                let (right_line_angle, left_line_angle) = (5.0 * c, 10.0 * d);
                let [inner_radius, outer_radius] = [a, b];
                let half_width = 0.1 * angle;
                ArcBlock {
                    inner_radius,
                    outer_radius,
                    right_line_angle,
                    left_line_angle,
                    half_width,
                    rows: n,
                    columns: m,
                }
                .part()
            }
            _ => SeatedBlock { width: a, height: b, seat_radius: c, columns: n, rows: m }.part(),
        };
        let Some(part) = answered(part)? else { return Ok(()) };
        prop_assert!(part.x.iter().chain(&part.y).all(|v| v.is_finite()), "a node that is no number");
        if part.x.len() < 3000 {
            let mut mesh = Mesh::new();
            mesh.add("body", &part);
            let nodes = mesh.x.len();
            let steel = Elastic::new(208e9, 0.3, 7800.0).expect("steel");
            let dynamics =
                Model::new(mesh, steel, 0.01).and_then(|m| Dynamics::new(&m, &vec![false; nodes], 1));
            prop_assert!(dynamics.is_ok(), "{:?}", dynamics.err());
        }
        Ok(())
    });
}
