//! Motion of rollers, cage and rings, beside the full model and closed forms.

use super::*;

/// Modes up to 100 kHz do not take steps of 5 µs.
/// Rollers that cannot touch the outer raceway are not looked at for a while. Where all are looked at in
/// every step, all that is computed is the same.
#[test]
fn invariant_rollers_that_are_not_looked_at_do_not_touch() {
    const BEFORE: usize = 2000;
    const STEPS: usize = 300;
    let scene = coarse(10.0);
    let mesh = ReducedMesh::new(&scene.resolve()).expect("modes");
    let modal = modal_bearing(&scene.resolve(), mesh.reduction).expect("a valid scene");
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
fn behaves_a_step_beyond_the_critical_one_is_shortened() {
    let folder = Scratch::create("reduced-step");
    let text = "(bearing: \"NU 205\", model: reduced(modes_khz: 100.0, step_us: 5.0), film: None,
        operation: (load_n: 3000.0, speed_rpm: 1500.0), mesh: (size_mm: 0.5, roller_facets: 56), output: \
        (frames: None),
        solver: (duration_ms: 1.0, mass_damping_per_s: 5000.0, structural_damping: None))";
    let info = run(&Scene::parse(text, "here").expect("a valid scene"), &folder, "stiff", 1);
    assert_eq!(info.status, Status::Complete, "{:?}", info.stop_reason);
    assert!(info.time_step_s < info.critical_time_step_s && info.critical_time_step_s < 5e-6, "{info:?}");
    assert!(
        info.warnings.iter().any(|w| w.contains("none longer than 0.8 of the critical")),
        "{:?}",
        info.warnings
    );
}

/// Over defects on raceways and rollers, in both models from one start: the same forces, and the energy
/// balances.
#[test]
fn peer_defects_are_felt_as_by_the_full_model() {
    // Means over a quarter of a millisecond, of the largest of them: where nodes of a coarse mesh lie changes
    // the stiffness of contacts by ±4 % (THEORY §9.6).
    const FORCES: f64 = 0.03;
    let mut scene = Scene { mesh: fine_where_it_rolls(4.0).mesh, ..coarse(4.0) };
    scene.defect = None;
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
    assert_eq!(run(&full, &folder, "full", 1).status, Status::Complete);
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

/// Rollers of other diameters, which stay round, carry as those do whose rims are outlines of their own: waves of
/// no height make them so.
#[test]
fn invariant_a_larger_roller_is_one_with_a_larger_rim() {
    for film in ["None", "()"] {
        larger_by_radius_or_rim(film);
    }
}

fn larger_by_radius_or_rim(film: &str) {
    let text = "(bearing: (designation: \"NU 205\", diameter_variation_um: 8), model: reduced(), film: FILM, \
        defect: None, housing: rigid(mass_kg: 1), operation: (load_n: 2000, speed_rpm: 1000), \
        output: (frames: None), solver: (duration_ms: 5))";
    let text = text.replace("FILM", film);
    let by_radius = Scene::parse(&text, "here").expect("a valid scene");
    let waves = |i| format!("(on: roller({i}), form: waviness(order: 2, amplitude_um: 0.0))");
    let waves: Vec<String> = (1..=by_radius.bearing.rollers).map(waves).collect();
    let by_rim = by_radius.with_overrides(&[format!("defects=[{}]", waves.join(", "))]).expect("a scene");
    let alike = by_radius.with_overrides(&["bearing.diameter_variation_um=0"]).expect("a scene");
    let folder = Scratch::create(&format!("reduced-larger-{}", film.len()));
    let forces = |scene: &Scene, name: &str| -> Vec<f64> {
        assert_eq!(run(scene, &folder, name, 1).status, Status::Complete);
        let trace = trace(&folder, name);
        let of = |i: usize, c: &str| channel(&trace, &format!("roller.{i}.outer_f{c}_n")).to_vec();
        let size = |(x, y): (f64, f64)| x.hypot(y);
        (1..=scene.bearing.rollers).flat_map(|i| of(i, "x").into_iter().zip(of(i, "y")).map(size)).collect()
    };
    let [by_radius, by_rim, alike] = [(&by_radius, "radius"), (&by_rim, "rim"), (&alike, "alike")]
        .map(|(scene, name)| forces(scene, name));
    let largest = by_rim.iter().copied().fold(0.0, f64::max);
    let apart = |a: &[f64], b: &[f64]| {
        let square: f64 = a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>() / a.len() as f64;
        square.sqrt() / largest
    };
    let (off, felt) = (apart(&by_radius, &by_rim), apart(&alike, &by_rim));
    assert!(off < 2e-3, "film {film}: {off}");
    assert!(felt > 20.0 * off, "film {film}: diameters make {felt}, the ways differ by {off}");
}

/// Where edges are ragged, passages differ more, and a run that goes on draws the same for each.
#[test]
fn behaves_ragged_edges_make_passages_differ() {
    let text = "(bearing: \"6205\", model: reduced(), film: None, defect: None, housing: rigid(mass_kg: 10), \
        defects: [(form: spall(length_mm: 1, depth_mm: 0.05, edge: rectangular, ragged_um: 20))], \
        operation: (load_n: 500, speed_rpm: 1800, gravity_m_s2: 0), output: (frames: None, interval_us: 20), \
        solver: (duration_ms: 500, mass_damping_per_s: 5000))";
    let scene = |text: &str| Scene::parse(text, "here").expect("a scene");
    let (ragged, straight) = (scene(text), scene(&text.replace(", ragged_um: 20", "")));
    let folder = Scratch::create("reduced-ragged");
    // Standard deviation of the blows over their mean: the range of the force of all elements in each passage.
    let scatter = |scene: &Scene, name: &str| {
        assert_eq!(run(scene, &folder, name, 1).status, Status::Complete);
        let trace = trace(&folder, name);
        let mut force = vec![0.0; channel(&trace, "roller.1.outer_fy_n").len()];
        for i in 1..=scene.bearing.rollers {
            let of = channel(&trace, &format!("roller.{i}.outer_fy_n"));
            force.iter_mut().zip(of).for_each(|(sum, f)| *sum += f);
        }
        let passage = (scene.kinematics().bpfo_hz * 20e-6).recip() as usize;
        let range = |part: &[f64]| {
            part.iter().copied().fold(f64::MIN, f64::max) - part.iter().copied().fold(f64::MAX, f64::min)
        };
        let blows: Vec<f64> = force[5000..].chunks_exact(passage).map(range).collect();
        let mean = blows.iter().sum::<f64>() / blows.len() as f64;
        (blows.iter().map(|blow| (blow / mean - 1.0).powi(2)).sum::<f64>() / blows.len() as f64).sqrt()
    };
    let (of_straight, of_ragged) = (scatter(&straight, "straight"), scatter(&ragged, "ragged"));
    // Blows of straight edges differ, too: the ring still moves from the one before.
    assert!(of_ragged > 1.5 * of_straight, "{of_ragged} and {of_straight}");
    let short = ragged.with_overrides(&["solver.duration_ms=60"]).expect("a scene");
    assert_goes_on_with_the_same_bytes(&short, &Scratch::create("reduced-ragged-on"), 2000);
}

/// From one start, full and reduced model carry the load on the same rollers at first.
#[test]
fn peer_the_reduced_model_starts_as_the_full_one() {
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

/// Turned back, with rollers at mirrored places, the bearing is its mirror image about the y axis: places
/// across and spins change their sign, and so do forces across.
#[test]
fn invariant_a_bearing_that_turns_back_is_the_mirror_image() {
    // Meshes of 314 and 258 facets from the x axis on, rollers turned with their places and a defect at the
    // top mirror into themselves, but the preload that both runs share is found to 1e-7 of the load only,
    // which grows a little as idle rollers touch and let go. Of 0.1 m, 0.2 rad and 10 kN, until roller 1 goes
    // into the defect.
    const TOLERANCE: f64 = 5e-5;
    // Vibration until then is the residue of the preload.
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

/// A bearing that hardly anything loads: one or two rollers carry, and the ring would swing far before they
/// touch. They carry the load, and the ring stays within its clearance.
#[test]
fn behaves_light_loads() {
    for load_n in [300, 30, 3] {
        let text = format!(
            "(bearing: \"NU 205\", model: reduced(step_us: 0.5), film: None, defect: None, \
             operation: (load_n: {load_n}, speed_rpm: 1500),
              cage: (outer_diameter_mm: 44.85, thickness_mm: 1.65, pocket: corners), \
             mesh: (roller_facets: 56), output: (frames: None),
              contact: (surface: arc, friction: 0.05), \
             solver: (duration_ms: 20, mass_damping_per_s: 5000, structural_damping: None))"
        );
        let scene = Scene::parse(&text, "here").expect("a valid scene");
        let folder = Scratch::create("reduced-light");
        let info = run(&scene, &folder, "run", 1);
        assert_eq!(info.status, Status::Complete, "{load_n} N: {:?}", info.stop_reason);
        assert!(info.guards.penetration_share < 0.1, "{load_n} N: {}", info.guards.penetration_share);
        let trace = trace(&folder, "run");
        // Under three newtons contacts as stiff as steel ring by some per cent from the first step on.
        let mean = |of: &[f64]| of.iter().sum::<f64>() / of.len() as f64;
        let carried: f64 = (1..=13).map(|i| -mean(channel(&trace, &format!("roller.{i}.outer_fy_n")))).sum();
        // Rollers press outwards with what their way around weighs, all around.
        assert!((carried / info.expected_support_n - 1.0).abs() < 0.01, "{load_n} N: {carried} N");
    }
}

/// A ring that does not deform leaves the compliance to the rollers and the inner ring, which theory takes as
/// two half-spaces. Source: Stribeck and Sjövall's distribution between rigid rings with Johnson's approach
/// of line contacts, THEORY §6.2; the load comes back as the sum of the rollers' forces.
#[test]
fn analytic_rollers_in_a_rigid_housing() {
    for bearing in ["NU 205", "NU 305"] {
        let text = format!(
            "(bearing: \"{bearing}\", model: reduced(step_us: 0.5), film: None, defect: None, \
             housing: rigid(mass_kg: 1),
              operation: (load_n: 3000, load_angle_deg: 215, speed_rpm: 100, gravity_m_s2: 0), \
             output: (frames: None),
              mesh: (size_mm: 0.2, roller_facets: 160, grading: (coarse_mm: 2)), \
             contact: (surface: arc, penalty_scale: 10),
              solver: (duration_ms: 2))"
        );
        let scene = Scene::parse(&text, "here").expect("a valid scene");
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
        let theory = scene.resolve().static_load().expect("an equilibrium");
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

/// Rings as narrow as the cylinders that stood for balls bent after a ball and held it in its spall.
#[test]
fn issue_a_ball_passes_the_spall_of_a_bearing_by_name() {
    let text = "(bearing: \"6305\", model: reduced(), output: (frames: None), solver: (duration_ms: 25))";
    let scene = Scene::parse(text, "here").expect("a valid scene");
    let folder = Scratch::create("reduced-passes");
    let info = run(&scene, &folder, "run", 1);
    assert_eq!(info.status, Status::Complete, "{:?}", info.stop_reason);
    let trace = trace(&folder, "run");
    let roller = |of: &str| channel(&trace, &format!("roller.1.{of}"));
    let (fx, fy, x, y) = (roller("outer_fx_n"), roller("outer_fy_n"), roller("x_m"), roller("y_m"));
    let force = fx.iter().zip(fy).map(|(x, y)| x.hypot(*y));
    assert!(force.fold(f64::INFINITY, f64::min) < 0.5 * fx[0].hypot(fy[0]));
    let angle = |n: usize| y[n].atan2(x[n]);
    let turned = angle(0) - angle(x.len() - 1);
    let rolling = 0.025 * scene.kinematics().cage_rad_s.abs();
    assert!((turned / rolling - 1.0).abs() < 0.05, "{turned} instead of {rolling}");
}

/// Bearings by their names carry as Hertz's contacts between rigid rings do, balls in points and rollers in
/// lines, straight or relieved, under light and heavy loads.
/// Source: Stribeck and Sjövall's distribution, THEORY §6.2, with Hertz's points (Hamrock and Brewe 1983) or
/// Johnson's lines, and the profile of ISO/TS 16281.
#[test]
fn analytic_bearings_by_name_carry_as_hertz_says() {
    const SHARE: f64 = 0.02;
    let folder = Scratch::create("reduced-by-name");
    for (name, load_n, profile) in [
        ("6205", 200.0, "straight"),
        ("6205", 1600.0, "straight"),
        ("6311", 8000.0, "straight"),
        ("NU 205", 3000.0, "straight"),
        ("NU 210", 800.0, "straight"),
        ("NU 205", 3000.0, "logarithmic"),
        ("NU 210", 300.0, "logarithmic"),
    ] {
        let text = format!(
            "(bearing: (designation: \"{name}\", roller_profile: {profile}), model: reduced(), film: None, defect: None, housing: rigid(mass_kg: 1), \
             operation: (load_n: {load_n:?}, speed_rpm: 0, gravity_m_s2: 0), output: (frames: None),
             solver: (duration_ms: 0.05, structural_damping: None))"
        );
        let scene = Scene::parse(&text, "here").expect("a valid scene");
        let at = format!("{}-{load_n}-{profile}", scene.name);
        let info = run(&scene, &folder, &at, 1);
        assert_eq!(info.status, Status::Complete, "{:?}", info.stop_reason);
        let trace = Trace::read(folder.join(&at).join("trace.npy")).expect("a trace");
        let expected = scene.resolve().static_load().expect("an equilibrium");
        let largest = expected.max_roller_n();
        for (i, expected) in expected.roller_n.iter().enumerate() {
            let [x, y] = ["x", "y"]
                .map(|c| trace.get(&format!("roller.{}.outer_f{c}_n", i + 1)).expect("recorded")[0]);
            let off = (x.hypot(y) - expected).abs() / largest;
            assert!(off < SHARE, "{name} {profile} {load_n} N, roller {}: {expected} N, off by {off}", i + 1);
        }
    }
}
