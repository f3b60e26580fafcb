//! One run of the model that a scene asks for: from a scene to a run directory.

use std::{ops::ControlFlow, path::Path};

use stribeck_bearing::{
    assembly::Assembly,
    checkpoint::Checkpoint,
    simulation::{self as full, Host, Progress, Setup, mesh_file, read_saved, take_over},
    time_loop::Run,
};
use stribeck_scene::{
    geometry::Geometry,
    run_dir::{RunDir, write_atomic},
    run_info::{ReducedInfo, RunInfo},
    scene::{ModelScene, ReducedScene, Scene},
};

use stribeck_modal::{ModalBearing, Reduction};
use stribeck_reduction::{cache, dense, modal_bearing};

use crate::{
    bearing::Bearing,
    error::Error,
    guards::Guards,
    motion::{Motion, Saved},
    state::State,
};

/// Is told about every sample and may break off the run.
type Watch<'a> = &'a mut dyn FnMut(&Progress) -> ControlFlow<()>;

/// Runs a scene and leaves its results in `dir`, as [`stribeck_bearing::simulation::simulate`] does for the full model.
///
/// # Errors
/// When the scene cannot be meshed, preloaded or reduced, or the traces cannot be written.
pub fn simulate(scene: &Scene, dir: &RunDir, host: &Host<'_>, watch: Watch<'_>) -> Result<RunInfo, Error> {
    let ModelScene::Reduced(reduced) = &scene.model else {
        return Ok(full::simulate(scene, dir, host, watch)?);
    };
    let started = (host.wall_s)();
    let mut progress = Progress::begin();
    let _ = watch(&progress);
    let (mesh, from_cache) = cache::reduced_mesh(scene, dir.path().parent())?;
    progress.phase = "preload";
    let _ = watch(&progress);
    let reduction = mesh.reduction;
    let summary = ReducedInfo {
        modes: reduction.modes,
        highest_hz: reduction.squares.iter().copied().fold(0.0, f64::max).sqrt() / std::f64::consts::TAU,
        from_cache,
    };
    let assembly = Assembly::of(scene, &mesh.parts)?;
    let [_, up] = scene.load_direction();
    let expected = scene.duty().mean_load_n(Geometry::of(scene).duration)
        - up * scene.operation.gravity_m_s2 * reduction.structure_mass;
    let (bearing, steps) = in_steps(scene, reduced, reduction)?;
    let (step, most) = (bearing.time_step, bearing.critical_time_step());
    let state = bearing.at_start(&dense::solve)?;
    let setup = Setup {
        time_step: step,
        critical_time_step: most,
        steps_per_sample: steps,
        mesh: assembly.mesh_info(),
        wall_s: (host.wall_s)() - started,
        expected_support: expected,
    };
    let mut info = setup.info(scene, host);
    info.reduced = Some(summary);
    info.warnings.extend(mesh.warning.clone());
    if step < 1e-6 * reduced.step_us && most < 1e-6 * reduced.step_us {
        info.warnings.push(format!(
            "`model.step_us` is {}, and steps are {:.3} µs: the critical one of modes and contacts is {:.3} µs. A smaller `model.modes_khz` or \
             `contact.penalty_scale` allows longer ones",
            reduced.step_us,
            1e6 * step,
            1e6 * most
        ));
    }
    info.warnings.extend(Guards::before(scene, &bearing));
    dir.start(scene, &info)?;
    write_mesh(&assembly, scene, &mesh.moved, &state, dir)?;
    let saved = Saved::first(&bearing, state);
    let motion = Motion::new(scene, bearing, saved);
    Ok(Run::start(scene, motion, info, dir)?.finish(dir, &on_one_thread(host), progress, watch)?)
}

/// Steps in a sample of a run of the scene, which has a reduced model. `runs` is where the folder of the run would lie: a reduction that
/// earlier runs made is there, and one that must be made is kept there.
///
/// # Errors
/// When the scene cannot be meshed, preloaded or reduced.
pub fn steps_in_a_sample(scene: &Scene, runs: Option<&Path>) -> Result<usize, Error> {
    let reduced = match &scene.model {
        ModelScene::Reduced(reduced) => reduced.clone(),
        ModelScene::Full => ReducedScene::default(),
    };
    let (mesh, _) = cache::reduced_mesh(scene, runs)?;
    Ok(in_steps(scene, &reduced, mesh.reduction)?.1)
}

/// The bearing in steps as long as the scene wants them and its critical time step allows, and how many there are in a sample.
fn in_steps(scene: &Scene, reduced: &ReducedScene, reduction: Reduction) -> Result<(Bearing, usize), Error> {
    let interval = Geometry::of(scene).interval;
    let steps = steps_per_sample(scene, 1e-6 * reduced.step_us);
    let modal: ModalBearing = modal_bearing(scene, reduction)?;
    let bearing = Bearing::new(modal.clone(), interval / steps as f64)?;
    let most = bearing.critical_time_step();
    if bearing.time_step <= most {
        return Ok((bearing, steps));
    }
    let steps = steps_per_sample(scene, most);
    Ok((Bearing::new(modal, interval / steps as f64)?, steps))
}

/// Continues the run in `dir` from its checkpoint, as [`stribeck_bearing::simulation::resume`].
///
/// # Errors
/// When there is nothing to continue or nothing to continue from; otherwise as [`simulate`].
pub fn resume(dir: &RunDir, host: &Host<'_>, watch: Watch<'_>) -> Result<RunInfo, Error> {
    let scene = read(dir)?;
    match &scene.model {
        ModelScene::Full => Ok(full::resume(dir, host, watch)?),
        ModelScene::Reduced(_) => go_on(dir, scene, host, watch),
    }
}

/// Continues the run in `dir` to another duration, as [`stribeck_bearing::simulation::extend`].
///
/// # Errors
/// When the run is longer already; otherwise as [`resume`].
pub fn extend(dir: &RunDir, duration_ms: f64, host: &Host<'_>, watch: Watch<'_>) -> Result<RunInfo, Error> {
    let mut scene = read(dir)?;
    if scene.model == ModelScene::Full {
        return Ok(full::extend(dir, duration_ms, host, watch)?);
    }
    scene.solver.duration_ms = duration_ms;
    scene.validate()?;
    go_on(dir, scene, host, watch)
}

/// Simulated time [s] from which [`resume`] would continue the run in `dir`.
///
/// # Errors
/// As [`resume`].
pub fn saved_until(dir: &RunDir) -> Result<f64, Error> {
    let scene = read(dir)?;
    if scene.model == ModelScene::Full {
        return Ok(full::saved_until(dir)?);
    }
    let info = read_saved::<Saved>(dir, &scene)?.info;
    Ok(info.samples as f64 * info.interval_s)
}

fn read(dir: &RunDir) -> Result<Scene, Error> {
    Ok(Scene::read(dir.scene())?)
}

fn go_on(dir: &RunDir, scene: Scene, host: &Host<'_>, watch: Watch<'_>) -> Result<RunInfo, Error> {
    let started = (host.wall_s)();
    let Checkpoint { mut info, motion: saved } = read_saved::<Saved>(dir, &scene)?;
    let progress = Progress::begin();
    let _ = watch(&progress);
    let (mesh, _) = cache::reduced_mesh(&scene, dir.path().parent())?;
    let elsewhere = info.mesh != Assembly::of(&scene, &mesh.parts)?.mesh_info();
    let bearing = Bearing::new(modal_bearing(&scene, mesh.reduction)?, info.time_step_s)?;
    if elsewhere || !saved.fits(&bearing) {
        return Err(stribeck_bearing::error::Error::Resume {
            path: dir.path().to_owned(),
            reason: "this program makes another model of the scene than the checkpoint has. Continue it with the program that began it, \
                     or start it anew"
                .to_owned(),
        }
        .into());
    }
    take_over(&mut info, &scene, host);
    info.setup_s += (host.wall_s)() - started;
    let motion = Motion::new(&scene, bearing, saved);
    let run = Run::resume(&scene, motion, info, dir)?;
    dir.go_on(&scene, &run.info)?;
    Ok(run.finish(dir, &on_one_thread(host), progress, watch)?)
}

/// Writes the mesh at the start of the run: rings and housing as the preload of the reduction has left them, rollers and cage, which do
/// not deform, where they are ([`stribeck_scene::mesh_file`]).
fn write_mesh(
    assembly: &Assembly,
    scene: &Scene,
    moved: &[[f64; 2]],
    state: &State,
    dir: &RunDir,
) -> Result<(), Error> {
    let (g, mesh) = (Geometry::of(scene), &assembly.model.mesh);
    let mut moved = moved.to_vec();
    moved.resize(mesh.x.len(), [0.0; 2]);
    let rollers = mesh.bodies.iter().filter(|body| body.name.starts_with("roller "));
    for ((body, number), (x, y)) in rollers.zip(scene.rollers_in_place()).zip(state.x.iter().zip(&state.y)) {
        let path = g.outer_race_radius - g.roller_radius;
        let (s, c) = g.roller_angle(number - 1).sin_cos();
        moved[body.nodes.clone()].fill([x - path * c, y - path * s]);
    }
    let file = mesh_file(assembly, &|node| {
        let n = node as usize;
        [mesh.x[n] + moved[n][0], mesh.y[n] + moved[n][1]]
    })?;
    Ok(write_atomic(&dir.mesh(), &file)?)
}

/// A step is too short to share: further threads would wait, and keep their cores busy with it.
fn on_one_thread<'a>(host: &Host<'a>) -> Host<'a> {
    let Host { version, commit, machine, wall_s, cpu_s, .. } = host;
    Host {
        threads: 1,
        version: version.clone(),
        commit: commit.clone(),
        machine: machine.clone(),
        wall_s: *wall_s,
        cpu_s: *cpu_s,
        ranks: None,
    }
}

/// A whole number of steps, none longer than `longest` [s], and two at least: what a sensor hears beyond the modes is a difference
/// between two steps of a sample.
fn steps_per_sample(scene: &Scene, longest: f64) -> usize {
    // A quotient of 5.000…1 is no sixth step.
    (1e-6 * scene.output.interval_us / longest - 1e-9).ceil().max(2.0) as usize
}
