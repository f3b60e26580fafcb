//! Whole runs of the reduced bearing: what they leave, that they go on to the same bytes, and how near the
//! full model they are.

mod common;

use std::{f64::consts::TAU, fs, ops::ControlFlow};

use common::{host, run, trace};
use stribeck_bearing::assembly::Assembly;
use stribeck_reduced::{
    bearing::Bearing,
    motion::{BearingInMotion, Saved},
};
use stribeck_reduction::{ReducedMesh, dense, modal_bearing};
use stribeck_run::host::Progress;
use stribeck_scene::{
    kinematics::Kinematics,
    mesh_file::RunMesh,
    run_dir::RunDir,
    run_info::Status,
    scene::{
        ContactFormula, HarmonicScene, ModelScene, PocketWalls, ProfileScene, RampScene, ReducedScene,
        RotatingLoadScene, Scene,
    },
    static_load,
    trace::Trace,
};
use stribeck_simulation::{
    reduced::{Prepared, prepared},
    resume, simulate,
};
use stribeck_testing::Scratch;

/// The paper's bearing, coarse.
fn coarse(duration_ms: f64) -> Scene {
    let mut scene = Scene { name: "coarse".into(), ..Scene::default() };
    scene.model = ModelScene::Reduced(ReducedScene { modes_khz: 15.0, ..ReducedScene::default() });
    scene.mesh.size_mm = 2.0;
    scene.mesh.roller_facets = 88;
    scene.bearing.thickness_mm = 20.0;
    scene.contact.penalty_scale = 1.0;
    scene.contact.points_per_facet = 4;
    // Dry, and quiet by mass damping.
    scene.film = None;
    (scene.solver.mass_damping_per_s, scene.solver.structural_damping) = (5000.0, None);
    scene.solver.duration_ms = duration_ms;
    scene.output.frames = None;
    scene
}

fn bytes(folder: &Scratch, name: &str, file: &str) -> Vec<u8> {
    fs::read(folder.join(name).join(file)).expect("readable")
}

/// What another program drives by itself is the bearing of a run: the same bits.
#[test]
fn invariant_a_prepared_bearing_is_that_of_a_run() {
    let folder = Scratch::create("reduced-prepared");
    let scene = coarse(1.0);
    run(&scene, &folder, "run", 1);
    let trace = trace(&folder, "run");
    let Prepared { steps_per_sample, bearing, start, .. } =
        prepared(&scene.resolve(), None).expect("the scene is sound");
    let start = Saved::first(&bearing, start);
    let mut motion = BearingInMotion::new(bearing, start);
    for sample in 0..trace.len() {
        motion.interval(steps_per_sample);
        for (number, roller) in motion.rollers().enumerate() {
            let channel = format!("roller.{}.outer_fy_n", number + 1);
            let there = trace.get(&channel).expect("recorded")[sample];
            assert_eq!(roller.outer[1].to_bits(), there.to_bits(), "{channel} of sample {sample}");
        }
    }
}

/// In pieces, from modes made anew or kept, with more threads: the same trace and ledger.
#[test]
fn invariant_a_run_in_pieces_writes_the_same_bytes() {
    let folder = Scratch::create("reduced-pieces");
    let scene = coarse(3.0);
    let whole = run(&scene, &folder, "whole", 1);
    assert_eq!(whole.status, Status::Complete, "{:?}", whole.stop_reason);
    let kept = whole.reduced.expect("what was kept");
    // Modes of a seat that slides lie below 15 kHz; friction makes them faster.
    assert!(!kept.from_cache && kept.modes > 8 && kept.highest_hz < 30e3, "{kept:?}");
    let dir = RunDir::create(folder.join("pieces")).expect("the folder is new");
    let mut seen = 0;
    let mut stop = |progress: &Progress| {
        seen += usize::from(progress.phase == "run");
        if seen == 117 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let broken = simulate(&scene, &dir, &host(2), &mut stop).expect("the scene is sound");
    assert_eq!((broken.status, broken.samples), (Status::Interrupted, 117));
    assert!(broken.reduced.expect("what was kept").from_cache);
    drop(dir);
    let dir = RunDir::reopen(folder.join("pieces")).expect("it is there");
    let done = resume(&dir, &host(1), &mut |_| ControlFlow::Continue(())).expect("it goes on");
    assert_eq!(done.status, Status::Complete);
    for file in ["trace.npy", "energy.npy"] {
        assert!(bytes(&folder, "whole", file) == bytes(&folder, "pieces", file), "{file}");
    }
}

/// Modes up to 100 kHz do not take steps of 5 µs.
/// Rollers that cannot touch the outer raceway are not looked at for a while. Where all are looked at in
/// every step, all that is computed is the same.
#[test]
fn invariant_rollers_that_are_not_looked_at_do_not_touch() {
    const BEFORE: usize = 2000;
    const STEPS: usize = 300;
    let scene = coarse(10.0);
    let mesh = ReducedMesh::new(&scene.resolve()).expect("modes");
    let modal = modal_bearing(&scene.resolve(), mesh.reduction).expect("a sound scene");
    let bearing = Bearing::new(modal, 2e-6).expect("a bearing");
    let saved = Saved::first(&bearing, bearing.at_start(&dense::solve).expect("an equilibrium"));
    let mut motion = BearingInMotion::new(bearing.clone(), saved);
    motion.interval(BEFORE);
    let mut anew = motion.saved();
    for step in 0..STEPS {
        motion.interval(1);
        let mut one = BearingInMotion::new(bearing.clone(), anew);
        one.interval(1);
        anew = one.saved();
        assert!(motion.saved().state == anew.state, "step {step}");
    }
}

#[test]
fn example_a_step_beyond_the_critical_one_is_shortened() {
    let folder = Scratch::create("reduced-step");
    let text = "(bearing: \"NU 205\", model: reduced(modes_khz: 100.0, step_us: 5.0), film: None,
        operation: (load_n: 3000.0, speed_rpm: 1500.0), mesh: (size_mm: 0.5, roller_facets: 56), output: \
        (frames: None),
        solver: (duration_ms: 1.0, mass_damping_per_s: 5000.0, structural_damping: None))";
    let info = run(&Scene::parse(text, "here").expect("a sound scene"), &folder, "stiff", 1);
    assert_eq!(info.status, Status::Complete, "{:?}", info.stop_reason);
    assert!(info.time_step_s < info.critical_time_step_s && info.critical_time_step_s < 5e-6, "{info:?}");
    assert!(info.warnings.iter().any(|w| w.contains("the critical one")), "{:?}", info.warnings);
}

/// Load, cage and energy of a run of two periods of the rollers.
#[test]
fn conserves_energy_and_carries_the_load() {
    // The ledger of a full run closes to a few tenths of a per cent.
    const ENERGY: f64 = 0.005;
    const LOAD: f64 = 0.002;
    let folder = Scratch::create("reduced-load");
    let mut scene = coarse(22.0);
    // It goes with the step: from three starts 0.50 to 0.67 % at 2 µs, 0.08 to 0.36 % at 1 µs, 0.05 to 0.09 %
    // at 0.5 µs.
    scene.model = ModelScene::Reduced(ReducedScene { modes_khz: 15.0, step_us: 1.0 });
    let info = run(&scene, &folder, "run", 1);
    assert_eq!(info.status, Status::Complete, "{:?}", info.stop_reason);
    assert!((info.simulated_s - 0.022).abs() < 1e-9, "{}", info.simulated_s);
    assert!(info.energy.max_relative_error < ENERGY, "{}", info.energy.max_relative_error);
    let trace = Trace::read(folder.join("run").join("trace.npy")).expect("a trace");
    let mut sum = 0.0;
    for i in 1..=24 {
        let force = trace.get(&format!("roller.{i}.outer_fy_n")).expect("a channel");
        sum += force.iter().sum::<f64>() / force.len() as f64;
    }
    assert!((-sum / info.expected_support_n - 1.0).abs() < LOAD, "{sum} N");
}

/// The spring of friction, which nothing is in series with, is stiffer than the contact on which it stands:
/// with steps that contacts alone allow, 3.3 µs, this is off by 42 % of the peak strain energy.
#[test]
fn issue_steps_are_short_enough_for_springs_of_friction() {
    let folder = Scratch::create("reduced-friction");
    let text = "(bearing: \"NU 205\", model: reduced(modes_khz: 10, step_us: 5), film: None, defect: None, \
        cage: None,
        mesh: (size_mm: 0.7, roller_facets: 56), operation: (load_n: 10000, speed_rpm: 1500), output: \
        (frames: None),
        contact: (surface: arc, penalty_scale: 0.2, friction: 0.5), solver: (duration_ms: 10, \
        structural_damping: None))";
    let scene = Scene::parse(text, "here").expect("a sound scene");
    let info = run(&scene, &folder, "run", 1);
    assert_eq!(info.status, Status::Complete, "{:?}", info.stop_reason);
    println!("steps of {:.2e} s, off by {:.2e}", info.time_step_s, info.energy.max_relative_error);
    assert!(info.energy.max_relative_error < 1e-3, "{:?}", info.energy);
    // Without friction there is none.
    let smooth = scene.with_overrides(&["contact.friction=0", "solver.duration_ms=0.1"]).expect("valid");
    assert!(run(&smooth, &folder, "smooth", 1).time_step_s > info.time_step_s);
}

/// A penalty that hangs on the full model's step is the penalty of another reduction with another step.
#[test]
fn issue_a_penalty_by_the_time_step_has_reductions_of_its_own() {
    let folder = Scratch::create("reduced-segment");
    let cached = |factor: f64, formula: ContactFormula| {
        let mut scene = coarse(0.02);
        (scene.contact.formula, scene.solver.time_step_factor) = (formula, factor);
        let name = format!("{factor}-{formula:?}");
        run(&scene, &folder, &name, 1).reduced.is_some_and(|kept| kept.from_cache)
    };
    let [segment, layer] = [ContactFormula::LsdynaSegment, ContactFormula::ElementLayer];
    assert!(!cached(0.9, segment) && !cached(0.5, segment));
    assert!(!cached(0.9, layer) && cached(0.5, layer));
}

/// Runs that began side by side each made the reduction that one could have left to the others.
#[test]
fn issue_runs_that_begin_together_make_one_reduction() {
    let folder = Scratch::create("reduced-together");
    let scene = coarse(0.02);
    let made = std::thread::scope(|scope| {
        let begun = ["a", "b", "c"].map(|name| scope.spawn(|| run(&scene, &folder, name, 1)));
        let runs = begun.map(|run| run.join().expect("it runs").reduced.expect("what was kept"));
        runs.iter().filter(|kept| !kept.from_cache).count()
    });
    assert_eq!(made, 1);
    let left = fs::read_dir(folder.join(".reduced")).expect("it is there").count();
    assert_eq!(left, 1, "the lock goes with the run that made it");
}

/// One reduction serves all starts, and every run has the mesh of its own: as the scene makes it, with
/// rollers, of which one may be missing, where they begin.
#[test]
fn issue_a_reduced_run_writes_its_rollers_where_it_starts() {
    let folder = Scratch::create("reduced-meshes");
    for (name, first_deg, missing) in [("a", 106.0, 0), ("b", 101.0, 5)] {
        let mut scene = coarse(0.1);
        (scene.bearing.first_roller_deg, scene.mesh.roller_phase_deg) = (first_deg, 1.3);
        if missing > 0 {
            let set = format!("defects=[(on: roller({missing}), form: missing)]");
            scene = scene.with_overrides(&[set]).expect("valid");
        }
        let info = run(&scene, &folder, name, 1);
        assert_eq!(info.reduced.as_ref().map(|kept| kept.from_cache), Some(name == "b"));
        let kept = RunMesh::read(folder.join(name).join("mesh.vtu")).expect("a mesh");
        assert_eq!(kept.reference.len(), info.mesh.nodes);
        let made = Assembly::new(&scene.resolve()).expect("a mesh").model.mesh;
        assert!(kept.reference.iter().zip(made.x.iter().zip(&made.y)).all(|([x, y], at)| (x, y) == at));
        for body in made.bodies.iter().filter(|body| body.name.starts_with("roller ")) {
            let mean = |axis: usize| {
                let all = body.nodes.clone();
                all.clone().map(|n| kept.start[n][axis] - kept.reference[n][axis]).sum::<f64>()
                    / all.len() as f64
            };
            // Pressed against the raceway by tens of micrometres.
            assert!(mean(0).hypot(mean(1)) < 2e-4, "{name}, {}", body.name);
        }
        let rings = kept.start.iter().zip(&kept.reference).take(made.bodies[0].nodes.end);
        let most = rings.map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1])).fold(0.0, f64::max);
        assert!((1e-6..5e-4).contains(&most), "the ring is under load: {most} m");
    }
}

/// One of the scenes that come with the program, with some fields of its own.
fn of(file: &str, fields: &[&str]) -> Scene {
    let scenes = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/scenes/");
    Scene::read_with(format!("{scenes}{file}"), fields).expect("valid")
}

/// Thin rings open and slip in their seats under every roller that falls onto a floor. Passes over the panels
/// that end early, and rollers that answer a step late, are off by 2 to 26 % of the peak strain energy here.
#[test]
fn conserves_energy_while_the_seat_opens_under_rollers() {
    let folder = Scratch::create("reduced-opens");
    for (name, bearing, cage, defects) in [
        (
            "nu203",
            "bearing=NU 203",
            ["cage.outer_diameter_mm=33.674", "cage.thickness_mm=1.426"],
            "defects=[(on: outer, form: spall(length_mm: 2.5935, depth_mm: 0.0519)), (on: inner, form: \
             spall(length_mm: 2.5935, depth_mm: 0.0519))]",
        ),
        (
            "nu210",
            "bearing=NU 210",
            ["cage.outer_diameter_mm=79.085", "cage.thickness_mm=2.415"],
            "defects=[(on: outer, form: spall(length_mm: 4.3912, depth_mm: 0.0878))]",
        ),
    ] {
        let scene = of("atlas.ron", &[bearing, cage[0], cage[1], defects, "solver.duration_ms=150"]);
        let info = run(&scene, &folder, name, 1);
        println!("{name}: off by {:.2e} of the peak strain energy", info.energy.max_relative_error);
        assert_eq!(info.status, Status::Complete, "{name}: {:?}", info.stop_reason);
        assert!(info.energy.max_relative_error < 5e-3, "{name}: {:?}", info.energy);
    }
}

/// Rollers that the cage guides, without friction and damping in a rigid housing, so that nothing becomes
/// heat: corners of the pockets roll over arcs, and over the rounded vertices of facets. Over sharp ones the
/// step is off by 3 to 15 thousandths of the energy of the contacts.
#[test]
fn conserves_energy_while_corners_of_the_cage_pass_vertices() {
    let folder = Scratch::create("reduced-corners");
    for (surface, bound) in [("arc", 5e-4), ("facet", 4e-3)] {
        let surface_is = format!("contact.surface={surface}");
        let fields = [
            "housing=rigid()",
            "defect=None",
            "solver.duration_ms=60",
            "solver.mass_damping_per_s=0",
            "contact.damping_ratio=0",
            "contact.friction=0",
            "operation.load_n=12500",
            "operation.speed_rpm=800",
            "model.step_us=1",
            &surface_is,
        ];
        let scene = of("reduced.ron", &fields);
        let info = run(&scene, &folder, surface, 1);
        assert_eq!(info.status, Status::Complete, "{surface}: {:?}", info.stop_reason);
        let energy = Trace::read(folder.join(surface).join("energy.npy")).expect("a ledger");
        let contacts = energy.get("contact_j").expect("a channel")[0];
        let off = info.energy.max_relative_error * info.energy.peak_strain_j;
        println!("{surface}: off by {off:.1e} J of {contacts:.3} J in contacts");
        assert!(off < bound * contacts, "{surface}: {off} J of {contacts} J");
    }
}

/// What the seat slips by in time, the ring's creep in its housing, costs no energy that the ledger does not
/// know of.
#[test]
fn conserves_energy_while_the_ring_creeps_in_its_seat() {
    // Of the heat. Rollers that found the raceway displaced only after they had come into contact won 1 % in
    // half a second. Walls with another displacement at each end win too little in this time to be seen here:
    // a second of the paper's mesh shows them (notes). The step leaves half of the bound, and twice as much
    // at 1 µs.
    const OF_HEAT: f64 = 5e-4;
    let folder = Scratch::create("reduced-creep");
    let mut scene = coarse(200.0);
    scene.model = ModelScene::Reduced(ReducedScene { modes_khz: 15.0, step_us: 0.5 });
    scene.solver.mass_damping_per_s = 1000.0;
    // Straight pockets let the cage wander in that time (THEORY §9.6).
    scene.cage.iter_mut().for_each(|cage| cage.pocket = PocketWalls::Corners);
    let mut held = scene.clone();
    held.contact.seat_friction = 2.0;
    let friction = |scene: &Scene, name: &str| {
        let info = run(scene, &folder, name, 1);
        assert_eq!(info.status, Status::Complete, "{:?}", info.stop_reason);
        let energy = Trace::read(folder.join(name).join("energy.npy")).expect("a ledger");
        let last = |channel: &str| *energy.get(channel).expect("a channel").last().expect("a row");
        let heat = last("friction_j") + last("damping_j") + last("contact_damping_j");
        let stored = ["kinetic_j", "strain_j", "hourglass_j", "contact_j"];
        let stored: f64 =
            stored.iter().map(|name| last(name) - energy.get(name).expect("a channel")[0]).sum();
        let off = stored + heat - last("external_j") - last("drive_j");
        assert!(off.abs() < OF_HEAT * heat, "{name}: {off} J of {heat} J");
        last("friction_j")
    };
    let (slips, holds) = (friction(&scene, "slips"), friction(&held, "holds"));
    assert!(slips > 1.05 * holds, "{slips} J where it slips, {holds} J where it holds");
}

/// Over defects on raceways and rollers, in both models from one start: the same forces, and the energy
/// balances.
#[test]
fn example_defects_are_felt_as_by_the_full_model() {
    // Means over a quarter of a millisecond, of the largest of them: where nodes of a coarse mesh lie changes
    // the stiffness of contacts by ±4 % (THEORY §9.6).
    const FORCES: f64 = 0.03;
    let mut scene = coarse(4.0);
    scene.defect = None;
    (scene.mesh.size_mm, scene.mesh.roller_facets) = (1.0, 112);
    let defects = "(on: outer, angle_deg: 92.0, form: spall(length_mm: 6.0, depth_mm: 0.1)), \
        (on: inner, angle_deg: 72.0, form: dent(length_mm: 6.0, depth_mm: 0.05, rim_um: 5.0)), \
        (on: roller(23), angle_deg: -20.0, form: spall(length_mm: 4.0, depth_mm: 0.05)), \
        (on: roller(2), form: diameter(larger_um: -10.0)), \
        (on: inner, form: waviness(order: 9, amplitude_um: 3.0))";
    let scene = scene.with_overrides(&[format!("defects=[{defects}]")]).expect("a scene");
    let folder = Scratch::create("reduced-defects");
    let reduced = run(&scene, &folder, "reduced", 1);
    assert_eq!(reduced.status, Status::Complete, "{:?}", reduced.stop_reason);
    assert!(reduced.energy.max_relative_error < 0.01, "{}", reduced.energy.max_relative_error);
    let full = Scene { model: ModelScene::Full, ..scene.clone() };
    assert_eq!(run(&full, &folder, "full", 2).status, Status::Complete);
    let sound = Scene { defects: Vec::new(), ..scene };
    assert_eq!(run(&sound, &folder, "sound", 1).status, Status::Complete);
    let means = |name: &str| -> Vec<f64> {
        let trace = Trace::read(folder.join(name).join("trace.npy")).expect("a trace");
        (1..=24)
            .flat_map(|i| {
                let [x, y] =
                    ["x", "y"].map(|c| trace.get(&format!("roller.{i}.outer_f{c}_n")).expect("recorded"));
                let forces: Vec<f64> = x.iter().zip(y).map(|(x, y)| x.hypot(*y)).collect();
                forces.chunks(25).map(|part| part.iter().sum::<f64>() / part.len() as f64).collect::<Vec<_>>()
            })
            .collect()
    };
    let [reduced, full, sound] = ["reduced", "full", "sound"].map(means);
    let largest = full.iter().copied().fold(0.0, f64::max);
    let apart = |a: &[f64], b: &[f64]| {
        let square: f64 = a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>() / a.len() as f64;
        square.sqrt() / largest
    };
    let (off, felt) = (apart(&reduced, &full), apart(&sound, &full));
    assert!(off < FORCES, "{off}, where the defects make {felt}");
    assert!(felt > 3.0 * off, "the defects make {felt}, the models differ by {off}");
}

/// From one start, full and reduced model carry the load on the same rollers at first.
#[test]
fn example_the_reduced_model_starts_as_the_full_one() {
    // Of the largest roller force. Where nodes of a mesh of 2 mm lie under a contact changes its stiffness by
    // ±4 % at the largest force and ±5 % at light ones; the reduced model has the mean (THEORY §9.6).
    const TOLERANCE: f64 = 0.04;
    let folder = Scratch::create("reduced-start");
    let scene = coarse(0.05);
    run(&scene, &folder, "reduced", 1);
    run(&Scene { model: ModelScene::Full, ..scene }, &folder, "full", 1);
    let first = |name: &str| -> Vec<f64> {
        let trace = Trace::read(folder.join(name).join("trace.npy")).expect("a trace");
        let channel =
            |i: usize, c: &str| trace.get(&format!("roller.{i}.outer_f{c}_n")).expect("a channel")[0];
        (1..=24).map(|i| channel(i, "x").hypot(channel(i, "y"))).collect()
    };
    let (full, reduced) = (first("full"), first("reduced"));
    let largest = full.iter().copied().fold(0.0, f64::max);
    for (i, (full, reduced)) in full.iter().zip(&reduced).enumerate() {
        assert!((full - reduced).abs() < TOLERANCE * largest, "roller {}: {full} N and {reduced} N", i + 1);
    }
}

fn channel<'a>(trace: &'a Trace, name: &str) -> &'a [f64] {
    trace.get(name).unwrap_or_else(|| panic!("the trace has no `{name}`"))
}

/// Turned back, with rollers at mirrored places, the bearing is its mirror image about the y axis: places
/// across and spins change their sign, and so do forces across.
#[test]
fn invariant_a_bearing_that_turns_back_is_the_mirror_image() {
    // Meshes of 314 and 258 facets from the x axis on, rollers turned with their places and a defect at the
    // top mirror into themselves, but the preload that both runs share is found to 1e-7 of the load only,
    // which grows a little as idle rollers touch and let go. Of 0.1 m, 0.2 rad and 10 kN, until roller 1 goes
    // into the defect.
    const TOLERANCE: f64 = 5e-5;
    // What sounds until then is what the preload left over.
    const OF_ACCELERATION: f64 = 0.2;
    let folder = Scratch::create("reduced-mirror");
    let there = coarse(0.8);
    run(&there, &folder, "there", 1);
    let mut back = there.clone();
    back.operation.speed_rpm = -500.0;
    // Roller 1 at 94°; now at 86°, and the others with it.
    back.bearing.first_roller_deg = 86.0;
    run(&back, &folder, "back", 1);
    let (there, back) = (trace(&folder, "there"), trace(&folder, "back"));
    for i in 1..=24_usize {
        // Counter-clockwise numbers from the mirrored roller 1 run backwards.
        let other = (25 - i) % 24 + 1;
        let channels = [
            ("x_m", -1.0, 0.1),
            ("y_m", 1.0, 0.1),
            ("spin_rad", -1.0, 0.2),
            ("outer_fx_n", -1.0, 10e3),
            ("outer_fy_n", 1.0, 10e3),
        ];
        for (c, sign, scale) in channels {
            let ours = channel(&there, &format!("roller.{i}.{c}"));
            let theirs = channel(&back, &format!("roller.{other}.{c}"));
            for (n, (a, b)) in ours.iter().zip(theirs).enumerate() {
                let off = (a - sign * b).abs() / scale;
                assert!(off < TOLERANCE, "sample {n}, roller {i}, {c}: {a} {b}");
            }
        }
    }
    let along = [channel(&there, "sensor.seat.ay_m_s2"), channel(&back, "sensor.seat.ay_m_s2")];
    let largest = along[0].iter().fold(0.0_f64, |most, a| most.max(a.abs()));
    for (n, (a, b)) in along[0].iter().zip(along[1]).enumerate() {
        assert!((a - b).abs() < OF_ACCELERATION * largest, "sample {n}: {a} {b}");
    }
}

/// The coarse bearing without a defect, its cage guided by the rollers: pockets with corners keep it from
/// floating away before all rollers run.
fn guided(duration_ms: f64) -> Scene {
    let mut scene = coarse(duration_ms);
    scene.defect = None;
    scene.cage.iter_mut().for_each(|cage| cage.pocket = PocketWalls::Corners);
    scene
}

/// From rest along a ramp the shaft has the angle ½αt² of a constant acceleration; loaded rollers roll
/// without slip and take the cage along.
/// Source: THEORY §5.1, rolling without slip; (6.4), a constant acceleration.
#[test]
fn analytic_a_start_from_rest_takes_the_rollers_along() {
    // The clearance of a pocket is 1.1 mrad. The cage lies some ten of them behind: rollers outside the load
    // zone are pushed by its corners until they have come round.
    const BEHIND: f64 = 0.02;
    // Roller 3 goes from 124° to 75°, under the load all the way.
    const ROLLING: f64 = 0.01;
    const ENERGY: f64 = 0.005;
    let folder = Scratch::create("reduced-ramp");
    let mut scene = guided(60.0);
    scene.operation.speed_rpm = 0.0;
    let ramp = RampScene { from_ms: 0.0, to_ms: 60.0, to: 600.0 };
    scene.operation.speed_profile = Some(ProfileScene::Ramp(ramp));
    let info = run(&scene, &folder, "ramp", 1);
    assert_eq!(info.status, Status::Complete, "{:?}", info.stop_reason);
    assert!(info.energy.max_relative_error < ENERGY, "{}", info.energy.max_relative_error);
    let trace = trace(&folder, "ramp");
    let (time, shaft) = (channel(&trace, "time_s"), channel(&trace, "shaft.angle_rad"));
    let acceleration = -600.0 / 60.0 * TAU / 0.06;
    for (t, angle) in time.iter().zip(shaft) {
        assert!((angle - 0.5 * acceleration * t * t).abs() < 1e-12, "{angle} rad after {t} s");
    }
    assert!(trace.get("adapter.load_n").is_none());
    let share = Kinematics::new(&scene.bearing, 60.0).cage_hz;
    let last = time.len() - 1;
    let cage = channel(&trace, "cage.angle_rad")[last];
    assert!((cage - share * shaft[last]).abs() < BEHIND, "{cage} of {}", share * shaft[last]);
    let [x, y] = ["x_m", "y_m"].map(|c| channel(&trace, &format!("roller.3.{c}")));
    let place = |n: usize| y[n].atan2(x[n]);
    let rolled = (place(last) - place(0)) / (shaft[last] - shaft[0]);
    assert!((rolled / share - 1.0).abs() < ROLLING, "{rolled} of {share}");
}

/// A load over time is carried at each of its values, and its work is in the ledger.
#[test]
fn conserves_energy_under_a_load_that_swells() {
    // As for a constant load; the work of the load goes back and forth by a multiple of the strain energy's
    // change.
    const ENERGY: f64 = 0.005;
    // What the ring's lowest modes add to the forces at a time, of the load then; none of it in the mean.
    const SWING: f64 = 0.08;
    const MEAN: f64 = 0.002;
    let folder = Scratch::create("reduced-swell");
    let mut scene = guided(40.0);
    let sine = HarmonicScene { amplitude: 20e3, hz: 50.0, phase_deg: 0.0 };
    scene.operation.load_profile = Some(ProfileScene::Harmonic(sine));
    scene.operation.rotating_load = Some(RotatingLoadScene { force_n: 500.0, angle_deg: 90.0 });
    let info = run(&scene, &folder, "load", 1);
    assert_eq!((info.status, info.warnings.len()), (Status::Complete, 0), "{:?}", info.warnings);
    assert!(info.energy.max_relative_error < ENERGY, "{}", info.energy.max_relative_error);
    let trace = trace(&folder, "load");
    let (time, load) = (channel(&trace, "time_s"), channel(&trace, "adapter.load_n"));
    let weight = info.expected_support_n - 50e3;
    let mut sums = [0.0; 2];
    for n in 0..time.len() {
        let turned = 0.25 * TAU - TAU * 500.0 / 60.0 * time[n];
        let wanted = 50e3 + 20e3 * (TAU * 50.0 * time[n]).sin() - 500.0 * turned.sin();
        assert!((load[n] - wanted).abs() < 1e-6, "{} N instead of {wanted} N", load[n]);
        let carried: f64 = (1..=24).map(|i| -channel(&trace, &format!("roller.{i}.outer_fy_n"))[n]).sum();
        assert!(
            (carried - weight - wanted).abs() < SWING * wanted,
            "{carried} N at {} s, {wanted} N",
            time[n]
        );
        sums = [sums[0] + carried, sums[1] + wanted + weight];
    }
    assert!((sums[0] / sums[1] - 1.0).abs() < MEAN, "{sums:?}");
}

/// In pieces a run over a profile has the same bytes.
#[test]
fn invariant_a_run_over_a_profile_in_pieces_writes_the_same_bytes() {
    let folder = Scratch::create("reduced-profile-pieces");
    let mut scene = guided(3.0);
    scene.operation.speed_profile =
        Some(ProfileScene::Points(vec![(0.0, 200.0), (1.5, 900.0), (2.0, -50.0)]));
    scene.operation.rotating_load = Some(RotatingLoadScene::default());
    run(&scene, &folder, "whole", 1);
    let dir = RunDir::create(folder.join("pieces")).expect("the folder is new");
    let mut seen = 0;
    let mut stop = |progress: &Progress| {
        seen += usize::from(progress.phase == "run");
        if seen == 117 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    simulate(&scene, &dir, &host(1), &mut stop).expect("the scene is sound");
    drop(dir);
    let dir = RunDir::reopen(folder.join("pieces")).expect("it is there");
    resume(&dir, &host(1), &mut |_| ControlFlow::Continue(())).expect("it goes on");
    for file in ["trace.npy", "energy.npy"] {
        assert!(bytes(&folder, "whole", file) == bytes(&folder, "pieces", file), "{file}");
    }
}

/// A bearing that hardly anything loads: one or two rollers carry, and the ring would swing far before they
/// touch. What they carry is the load, and the ring stays where its clearance lets it.
#[test]
fn example_light_loads() {
    for load_n in [300, 30, 3] {
        let text = format!(
            "(bearing: \"NU 205\", model: reduced(step_us: 0.5), film: None, defect: None, operation: \
             (load_n: {load_n}, speed_rpm: 1500),
              cage: (outer_diameter_mm: 44.85, thickness_mm: 1.65, pocket: corners), mesh: (roller_facets: \
              56), output: (frames: None),
              contact: (surface: arc, friction: 0.05), solver: (duration_ms: 2, mass_damping_per_s: 5000, \
              structural_damping: None))"
        );
        let scene = Scene::parse(&text, "here").expect("a sound scene");
        let folder = Scratch::create("reduced-light");
        let info = run(&scene, &folder, "run", 1);
        assert_eq!(info.status, Status::Complete, "{load_n} N: {:?}", info.stop_reason);
        assert!(info.guards.penetration_share < 0.1, "{load_n} N: {}", info.guards.penetration_share);
        let trace = trace(&folder, "run");
        let at_start: f64 = (1..=13).map(|i| -channel(&trace, &format!("roller.{i}.outer_fy_n"))[0]).sum();
        // Rollers press outwards with what their way around weighs, all around.
        assert!((at_start / info.expected_support_n - 1.0).abs() < 0.01, "{load_n} N: {at_start} N");
    }
}

/// A ring that does not deform leaves the compliance to the rollers and the inner ring, which theory takes as
/// two half-spaces. Source: Stribeck and Sjövall's distribution between rigid rings with Johnson's approach
/// of line contacts, THEORY §6.2; the load comes back as the sum of the rollers' forces.
#[test]
fn analytic_rollers_in_a_rigid_housing() {
    for bearing in ["NU 205", "6305"] {
        let text = format!(
            "(bearing: \"{bearing}\", model: reduced(step_us: 0.5), film: None, defect: None, housing: \
             rigid(mass_kg: 1),
              operation: (load_n: 3000, load_angle_deg: 215, speed_rpm: 100, gravity_m_s2: 0), output: \
              (frames: None),
              mesh: (size_mm: 0.2, roller_facets: 160, grading: (coarse_mm: 2)), contact: (surface: arc, \
              penalty_scale: 10),
              solver: (duration_ms: 2))"
        );
        let scene = Scene::parse(&text, "here").expect("a sound scene");
        let folder = Scratch::create("reduced-rigid");
        let info = run(&scene, &folder, "run", 1);
        assert_eq!(info.status, Status::Complete, "{:?}", info.stop_reason);
        assert_eq!(info.reduced.expect("what was kept").modes, 2);
        assert!(info.energy.max_relative_error < 1e-3, "{bearing}: {}", info.energy.max_relative_error);
        let trace = trace(&folder, "run");
        assert!(trace.get("seat.fx_n").is_none());
        let force = |roller: usize, n: usize| {
            ["x", "y"].map(|c| channel(&trace, &format!("roller.{roller}.outer_f{c}_n"))[n])
        };
        let theory = static_load::at_start(&scene.resolve()).expect("an equilibrium");
        for (i, expected) in theory.roller_n.iter().enumerate() {
            let [x, y] = force(i + 1, 0);
            let off = (x.hypot(y) - expected).abs() / theory.max_roller_n();
            assert!(off < 0.02, "{bearing}, roller {}: {} N instead of {expected}", i + 1, x.hypot(y));
        }
        let [lx, ly] = scene.load_direction();
        let samples = channel(&trace, "time_s").len();
        let sums = (0..samples).map(|n| {
            (1..=scene.bearing.rollers).map(|i| force(i, n)).map(|[x, y]| lx * x + ly * y).sum::<f64>()
        });
        let mean = sums.sum::<f64>() / samples as f64;
        assert!((mean / info.expected_support_n - 1.0).abs() < 1e-3, "{bearing}: {mean} N");
    }
}

/// Rings in a rigid housing store next to nothing: beside what contacts store, what the step leaves is small,
/// and no divergence.
#[test]
fn issue_a_light_load_in_a_rigid_housing_is_no_divergence() {
    let text = "(name: \"light\", housing: rigid(mass_kg: 18.08), model: reduced(step_us: 2.0), film: None, \
        defect: None,
        defects: [(on: outer, angle_deg: 334.8, form: waviness(order: 7, amplitude_um: 0.79))], cage: \
        (pocket: corners),
        operation: (load_n: 193, speed_rpm: 535), solver: (duration_ms: 10), output: (interval_us: 50, \
        frames: None))";
    let scene = Scene::parse(text, "here").expect("a sound scene");
    let info = run(&scene, &Scratch::create("reduced-rigid-light"), "run", 1);
    assert_eq!(info.status, Status::Complete, "{:?}", info.stop_reason);
    assert!(info.energy.max_relative_error > 0.25, "{}", info.energy.max_relative_error);
}
