//! A run directory made of closed forms: every number that the report should find is written down here.
#![allow(dead_code, reason = "each test file uses its own part of it")]

mod mesh;

use std::f64::consts::TAU;
use std::path::Path;

use stribeck_scene::ensemble::start;
use stribeck_scene::scene::{ContactSurface, Scene};
use stribeck_store::run_dir::Ensemble;
use stribeck_store::run_dir::RunDir;
use stribeck_store::run_info::{EnergyInfo, RunInfo, Status};
use stribeck_store::trace::TraceWriter;
use stribeck_testing::Noise;
use stribeck_theory::kinematics::Crossing;

/// Standard acceleration of gravity [m/s²].
pub(crate) const G: f64 = 9.806_65;
/// Facet tone [Hz], 0.05 % above the prediction.
pub(crate) const TONE_HZ: f64 = 4674.0;
/// Its amplitude at the leading sensor [g].
pub(crate) const TONE_G: f64 = 40.0;
/// Peak of each impulse before tone and noise are added [g].
pub(crate) const IMPULSE_G: f64 = 180.0;
/// Half width of the uniform noise [g].
pub(crate) const NOISE_G: f64 = 8.0;
/// Delay of unloading behind the leading edge [s].
pub(crate) const ENTRY_LAG_S: f64 = 0.15e-3;
/// Lead of re-stressing before the trailing edge [s].
pub(crate) const EXIT_LEAD_S: f64 = 0.20e-3;
/// Fraction by which the cage is slower than rolling without slip.
pub(crate) const SLIP: f64 = 0.001;
/// Vertical force through the rollers [N].
pub(crate) const SUPPORT_N: f64 = 50_120.0;
/// Oil films of rollers without load, at the outer and at the inner raceway [m].
pub(crate) const FLOATING_M: [f64; 2] = [30e-6, 45e-6];
/// Force of the inner raceway on a roller without load [N].
pub(crate) const WEIGHT_N: f64 = 0.39;
/// Power that oil takes [W].
pub(crate) const OIL_W: f64 = 0.5;
/// Sampling interval [s].
pub(crate) const INTERVAL_S: f64 = 1e-5;

/// What `run.json` says.
pub(crate) fn info(status: Status, samples: usize) -> RunInfo {
    RunInfo {
        version: "0.1.0".into(),
        commit: "synthetic".into(),
        scene_hash: Scene::default().hash(),
        machine: "closed forms".into(),
        threads: 2,
        status,
        stop_reason: (status == Status::Diverged)
            .then(|| "energy imbalance 3.1 % at step 4000, t = 3.2 ms, near roller 1".into()),
        time_step_s: 31e-9,
        critical_time_step_s: 33e-9,
        steps: 968_000,
        steps_planned: 968_000,
        interval_s: INTERVAL_S,
        samples,
        simulated_s: 0.0,
        reduced: None,
        mesh: mesh::counts(),
        wall_s: 300.0,
        cpu_s: 590.0,
        loop_cpu_s: 590.0,
        setup_s: 4.0,
        resumed_at_s: Vec::new(),
        energy: EnergyInfo {
            max_relative_error: 2.5e-3,
            peak_strain_j: 0.8,
            heat_j: 0.4,
            ..EnergyInfo::default()
        },
        guards: Default::default(),
        expected_support_n: SUPPORT_N,
        notes: Vec::new(),
        warnings: vec!["the sensor `seat` lies under the adapter".into()],
        warned_of: Vec::new(),
    }
}

/// Writes the paper's scene with `samples` samples into `path`.
pub(crate) fn write(path: &Path, status: Status, samples: usize) {
    write_scene(path, &Scene::default(), status, samples, 1.0);
}

/// Writes an ensemble of `starts` starts into `path`, drawn from the seed 5: as many complete ones as there
/// are gains, one that diverged when there is a fourth, and a failure for the fifth.
pub(crate) fn write_ensemble(path: &Path, gains: &[f64], starts: usize) {
    let scene = Scene::default();
    let dir = RunDir::create(path).expect("a free folder");
    let failed = (starts > 4).then(|| (5, "the preload found no equilibrium".to_owned()));
    let ensemble = Ensemble {
        version: "0.1.0".into(),
        commit: "synthetic".into(),
        scene_hash: scene.hash(),
        seed: 5,
        starts,
        failed: failed.into_iter().collect(),
    };
    dir.start_ensemble(&scene, &ensemble).expect("a writable folder");
    for number in 1..=starts.min(4) {
        let (drawn, path) = (start(&scene, 5, number), dir.start_folder(number));
        match gains.get(number - 1) {
            Some(gain) => write_scene(&path, &drawn, Status::Complete, 3000, *gain),
            None => write_scene(&path, &drawn, Status::Diverged, 300, 1.0),
        }
    }
}

/// Writes a scene of the paper's bearing with `samples` samples into `path`, accelerations `gain` times as
/// strong.
pub(crate) fn write_scene(path: &Path, scene: &Scene, status: Status, samples: usize, gain: f64) {
    let dir = RunDir::create(path).expect("a free folder");
    let info = RunInfo { scene_hash: scene.hash(), ..info(status, samples) };
    dir.start(scene, &info).expect("a writable folder");
    write_trace(&dir, scene, samples, gain);
    write_energy(&dir, scene, samples);
    mesh::write(&dir.mesh());
}

fn crossings(scene: &Scene) -> Vec<Crossing> {
    let of = |defect| scene.kinematics().crossings(defect, &scene.roller_angles_deg(), 40e-3);
    scene.defect.as_ref().map_or(Vec::new(), of)
}

fn write_trace(dir: &RunDir, scene: &Scene, samples: usize, gain: f64) {
    let mut names = vec!["time_s".to_owned()];
    for sensor in &scene.output.sensors {
        for component in ["ax", "ay", "ax_instant", "ay_instant"] {
            names.push(format!("sensor.{}.{component}_m_s2", sensor.name));
        }
    }
    let per_roller = [
        "x_m",
        "y_m",
        "spin_rad",
        "outer_fx_n",
        "outer_fy_n",
        "inner_fx_n",
        "inner_fy_n",
        "cage_fx_n",
        "cage_fy_n",
    ];
    for roller in 1..=scene.bearing.rollers {
        names.extend(per_roller.iter().map(|what| format!("roller.{roller}.{what}")));
    }
    names.extend(["cage.x_m", "cage.y_m", "cage.angle_rad", "seat.fx_n", "seat.fy_n"].map(str::to_owned));
    let duty = scene.duty();
    names.extend(scene.operation.load_varies().then(|| "adapter.load_n".to_owned()));
    let (films, oiled) = (scene.resolve().loaded_films().expect("a load"), scene.roller_angles_deg());
    if films.is_some() {
        for roller in 1..=scene.bearing.rollers {
            names.extend(["outer", "inner"].map(|ring| format!("roller.{roller}.{ring}_film_m")));
        }
    }
    let mut writer = TraceWriter::create(dir.trace(), &names).expect("a writable folder");
    let mut noise = Noise::new(3);
    let crossings = crossings(scene);
    // Contact on arcs has no corners, and so no tone.
    let tone = if scene.contact.surface == ContactSurface::Facet { TONE_G } else { 0.0 };
    for n in 0..samples {
        let t = n as f64 * INTERVAL_S;
        let mut row = vec![t];
        for (number, _) in scene.output.sensors.iter().enumerate() {
            let ay = gain * G * acceleration_g(t, number, tone, &crossings, &mut noise);
            let instant = ay + 2000.0 * G * noise.uniform();
            row.extend([0.3 * ay, ay, 0.3 * instant, instant]);
        }
        rollers(scene, t, &crossings, &mut row);
        let cage = -TAU * scene.kinematics().cage_hz * (1.0 - SLIP) * t;
        row.extend([0.0, 0.0, cage, 0.0, -SUPPORT_N + 60.0]);
        row.extend(scene.operation.load_varies().then(|| duty.load_n(t)));
        if let Some(films) = &films {
            for angle in &oiled {
                // The lowest ones stay below the axis of the bearing, without load.
                let floats = angle.to_radians().sin() < -0.9;
                row.extend([0, 1].map(|ring| if floats { FLOATING_M[ring] } else { films[ring].least }));
            }
        }
        writer.push(&row).expect("a writable folder");
    }
    writer.finish().expect("a writable folder");
}

/// Tone, impulses at the exits and noise.
fn acceleration_g(t: f64, sensor: usize, tone_g: f64, crossings: &[Crossing], noise: &mut Noise) -> f64 {
    let strength = [1.0, 1.4, 0.7, 2.0][sensor % 4];
    let tone = tone_g * (TAU * TONE_HZ * t).sin() + 0.2 * tone_g * (6.0 * TAU * TONE_HZ * t).sin();
    let impulse: f64 = crossings
        .iter()
        .map(|c| t - (c.exit_s - EXIT_LEAD_S))
        .filter(|&since| since >= 0.0)
        .map(|since| IMPULSE_G * (-since / 0.25e-3).exp() * (TAU * 9000.0 * since).cos())
        .sum();
    strength * (tone + impulse + NOISE_G * noise.uniform())
}

/// Motion and forces of all rollers: the upper ones share the load by the cosine, those in the defect carry
/// nothing.
fn rollers(scene: &Scene, t: f64, crossings: &[Crossing], row: &mut Vec<f64>) {
    let k = scene.kinematics();
    let count = scene.bearing.rollers;
    let start = scene.roller_angles_deg();
    let angle_of = |roller: usize| start[roller].to_radians() - TAU * k.cage_hz * (1.0 - SLIP) * t;
    let unloaded = |roller: usize| {
        crossings
            .iter()
            .any(|c| c.roller == roller + 1 && (c.entry_s + ENTRY_LAG_S..c.exit_s - EXIT_LEAD_S).contains(&t))
    };
    let share = |roller: usize| if unloaded(roller) { 0.0 } else { angle_of(roller).sin().max(0.0) };
    let vertical: f64 = (0..count).map(|r| share(r) * angle_of(r).sin()).sum();
    let ripple = 1.0 + 0.1 * (TAU * TONE_HZ * t).sin();
    for roller in 0..count {
        let (sin, cos) = angle_of(roller).sin_cos();
        let force = SUPPORT_N * share(roller) / vertical * ripple;
        let spin = TAU * (k.roller_spin_hz - k.cage_hz * (1.0 - SLIP)) * t;
        row.extend([91e-3 * cos, 91e-3 * sin, spin]);
        row.extend([-force * cos, -force * sin, force * cos, force * sin + WEIGHT_N, 0.0, 0.0]);
    }
}

fn write_energy(dir: &RunDir, scene: &Scene, samples: usize) {
    let mut names = vec![
        "time_s",
        "kinetic_j",
        "strain_j",
        "hourglass_j",
        "contact_j",
        "friction_j",
        "damping_j",
        "contact_damping_j",
        "external_j",
        "drive_j",
        "relative_error",
    ];
    let oil = scene.film.is_some();
    names.extend(oil.then_some("film_j"));
    let mut writer = TraceWriter::create(dir.energy(), &names).expect("a writable folder");
    for n in 0..samples {
        let t = n as f64 * INTERVAL_S;
        let strain = 0.7 + 0.05 * (TAU * 90.0 * t).sin();
        let friction = 12.0 * t;
        let mut row = vec![
            t,
            30.0 - 0.05 * (TAU * 90.0 * t).sin(),
            strain,
            0.002,
            0.1,
            friction,
            1.5 * t,
            0.8 * t,
            0.3 * t,
            14.0 * t,
            2.5e-3 * t / 30e-3,
        ];
        row.extend(oil.then_some(OIL_W * t));
        writer.push(&row).expect("a writable folder");
    }
    writer.finish().expect("a writable folder");
}
