//! Files of runs, and runs in pieces: the same bytes.

use super::*;

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
    let of_each = assert_goes_on_with_the_same_bytes(&scene, &folder, 117);
    let [kept, again] = of_each.map(|info| info.reduced.expect("what was kept"));
    // Modes of a seat that slides lie below 15 kHz; friction makes them faster.
    assert!(!kept.from_cache && kept.modes > 8 && kept.highest_hz < 30e3, "{kept:?}");
    assert!(again.from_cache);
}

/// Round rollers over spalls and dents, whose contacts outgrow in a step what was known of the raceway.
#[test]
fn issue_round_rollers_over_defects_in_pieces_write_the_same_bytes() {
    let folder = Scratch::create("reduced-pitted-pieces");
    let scene = of("pitted.ron", &["solver.duration_ms=6"]);
    assert_goes_on_with_the_same_bytes(&scene, &folder, 37);
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

/// In pieces a run over a profile has the same bytes.
#[test]
fn invariant_a_run_over_a_profile_in_pieces_writes_the_same_bytes() {
    let folder = Scratch::create("reduced-profile-pieces");
    let mut scene = guided(3.0);
    scene.operation.speed_profile =
        Some(ProfileScene::Points(vec![(0.0, 200.0), (1.5, 900.0), (2.0, -50.0)]));
    scene.operation.rotating_load = Some(RotatingLoadScene::default());
    assert_goes_on_with_the_same_bytes(&scene, &folder, 117);
}

/// Modes that a healthy bearing in a machine has left serve a spall on either ring, a pit, another load and speed, and
/// the run has the bytes of one that made them for itself.
#[test]
fn invariant_one_reduction_serves_every_spall_load_and_speed_of_a_machine() {
    let desk = Scratch::create("one-reduction");
    let base = "bearing: \"6203\", model: reduced(), film: None, housing: machine(), mesh: (size_mm: 0.8, \
        roller_facets: 64), solver: (duration_ms: 4, mass_damping_per_s: 5000, structural_damping: None)";
    let scene = |name: &str, rest: &str| {
        Scene::parse(&format!("(name: \"{name}\", {base}, {rest})"), "here").expect("a scene")
    };
    let healthy = scene("healthy", "defect: None, operation: (load_n: 300, speed_rpm: 1500)");
    assert!(!run(&healthy, &desk, "healthy", 1).reduced.expect("reduced").from_cache);
    for (name, rest) in [
        (
            "outer",
            "defect: (ring: outer, length_mm: 2.5, depth_mm: 0.1), operation: (load_n: 120, speed_rpm: 900)",
        ),
        (
            "inner",
            "defect: (ring: inner, angle_deg: 80, length_mm: 3, depth_mm: 0.05), operation: (load_n: 900)",
        ),
        (
            "pit",
            "defect: (length_mm: 2, width_mm: 0.4, depth_mm: 0.1), operation: (load_n: 500, rotating_load: (force_n: 50))",
        ),
    ] {
        let scene = scene(name, rest);
        assert!(run(&scene, &desk, name, 1).reduced.expect("reduced").from_cache, "{name}");
        let alone = Scratch::create(&format!("one-reduction-{name}"));
        assert!(!run(&scene, &alone, name, 1).reduced.expect("reduced").from_cache);
        for file in ["trace.npy", "energy.npy", "mesh.vtu"] {
            let read = |folder: &Scratch| fs::read(folder.join(name).join(file)).expect("a run");
            assert_eq!(read(&desk), read(&alone), "{file} of {name}");
        }
    }
}
