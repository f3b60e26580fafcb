//! One run: from a scene to a run directory.

use std::ops::ControlFlow;

use serde::{Serialize, de::DeserializeOwned};
use stribeck_mesh::vtu;
use stribeck_solver::damping::{Frame, MassDamping};

pub use crate::host::{Host, Progress};
use crate::{
    assembly::{Assembly, Machine},
    checkpoint::{Checkpoint, identity},
    error::Error,
    frames::Frames,
    full::{Full, Saved},
    guards::Guards,
    ranks::{called_to, lead},
    start::{launch, preload},
    time_loop::Run,
};
use stribeck_scene::{
    geometry::Geometry,
    mesh_file::REFERENCE,
    run_dir::{RunDir, write_atomic},
    run_info::{EnergyInfo, GuardInfo, MeshInfo, RunInfo, Status},
    scene::{DampingFrame, Scene, Start},
};

/// What is known of a run before its first step.
pub struct Setup {
    /// Time step [s].
    pub time_step: f64,
    /// Critical time step [s].
    pub critical_time_step: f64,
    /// Steps in a sampling interval.
    pub steps_per_sample: usize,
    /// The mesh.
    pub mesh: MeshInfo,
    /// How long it took so far [s].
    pub wall_s: f64,
    /// Vertical force that the rollers must carry [N].
    pub expected_support: f64,
}

impl Setup {
    /// What `run.json` says at the start.
    pub fn info(self, scene: &Scene, host: &Host<'_>) -> RunInfo {
        let Geometry { interval, duration, .. } = Geometry::of(scene);
        let samples = (duration / interval).round().max(1.0) as usize;
        RunInfo {
            version: host.version.clone(),
            commit: host.commit.clone(),
            scene_hash: scene.hash(),
            machine: host.machine.clone(),
            threads: host.threads,
            status: Status::Running,
            stop_reason: None,
            time_step_s: self.time_step,
            critical_time_step_s: self.critical_time_step,
            steps: 0,
            steps_planned: (samples * self.steps_per_sample) as u64,
            interval_s: interval,
            samples: 0,
            simulated_s: 0.0,
            reduced: None,
            mesh: self.mesh,
            wall_s: 0.0,
            cpu_s: 0.0,
            loop_cpu_s: 0.0,
            setup_s: self.wall_s,
            resumed_at_s: Vec::new(),
            energy: EnergyInfo { max_relative_error: 0.0, peak_strain_j: 0.0, heat_j: 0.0 },
            guards: GuardInfo::default(),
            expected_support_n: self.expected_support,
            warnings: Vec::new(),
        }
    }
}

/// Runs a scene and leaves its results in `dir`.
///
/// `watch` is told about every sample and may break off the run, which then ends as [`Status::Interrupted`]. A checkpoint
/// is written at the start, now and then, and at an interruption; [`resume`] continues from it.
///
/// # Errors
/// When the scene cannot be meshed or preloaded, or the traces cannot be written. A run that diverges is not an error:
/// its status and reason are in the returned [`RunInfo`]. A checkpoint that cannot be written is a warning there.
pub fn simulate(
    scene: &Scene,
    dir: &RunDir,
    host: &Host<'_>,
    watch: &mut dyn FnMut(&Progress) -> ControlFlow<()>,
) -> Result<RunInfo, Error> {
    let mut progress = Progress::begin();
    let _ = watch(&progress);
    lead(host, scene, None)?;
    let prepared = prepare(scene, host, &mut |elements| {
        (progress.phase, progress.elements) = ("preload", elements);
        let _ = watch(&progress);
    })?;
    let Prepared { assembly, machine, setup, preloaded } = prepared;
    let mut info = setup.info(scene, host);
    info.warnings.extend(preloaded);
    info.warnings.extend(Guards::before(scene, assembly.steel(), &info));
    dir.start(scene, &info)?;
    write_mesh(&assembly, &machine, dir)?;
    let full = Full::start(scene, &assembly, machine, Frames::of(scene, dir.frames()), host);
    Run::start(scene, full, info, dir)?.finish(dir, host, progress, watch)
}

/// A run before its first step.
struct Prepared {
    assembly: Assembly,
    machine: Machine,
    setup: Setup,
    /// What is to be said of the preload.
    preloaded: Option<String>,
}

/// Sets a run up; `meshed` is told how many elements there are.
fn prepare(scene: &Scene, host: &Host<'_>, meshed: &mut dyn FnMut(usize)) -> Result<Prepared, Error> {
    let started = (host.wall_s)();
    let assembly = Assembly::new(scene)?;
    let mut machine = assembly.machine(scene, host.threads)?;
    let mesh = assembly.mesh_info();
    meshed(mesh.quads + mesh.triangles);
    let preloaded = match scene.solver.start {
        Start::Preloaded => preload(&mut machine, scene, &assembly.kinematics)?,
        Start::Sudden => None,
    };
    let critical = machine.system.critical_time_step();
    let Geometry { interval, .. } = Geometry::of(scene);
    let steps_per_sample = (interval / (scene.solver.time_step_factor * critical)).ceil().max(1.0) as usize;
    let dt = interval / steps_per_sample as f64;
    machine.system.set_time_step(dt, Some(critical))?;
    launch(&mut machine, &assembly.kinematics);
    damp(scene, &mut machine)?;
    let setup = Setup {
        time_step: dt,
        critical_time_step: critical,
        steps_per_sample,
        mesh,
        wall_s: (host.wall_s)() - started,
        expected_support: expected_support(scene, &machine),
    };
    Ok(Prepared { assembly, machine, setup, preloaded })
}

/// Continues the run in `dir` from its checkpoint. Its files become those of an unbroken run, byte for byte, whatever
/// the number of threads; the mesh is made again, the preload is not.
///
/// `watch` as for [`simulate`].
///
/// # Errors
/// [`Error::Resume`] when there is nothing to continue or nothing to continue from; otherwise as [`simulate`].
pub fn resume(
    dir: &RunDir,
    host: &Host<'_>,
    watch: &mut dyn FnMut(&Progress) -> ControlFlow<()>,
) -> Result<RunInfo, Error> {
    go_on(dir, Scene::read(dir.scene())?, host, watch)
}

/// Continues the run in `dir` to another duration, also when it is complete. Its files become those of an unbroken run
/// of this duration.
///
/// `watch` as for [`simulate`].
///
/// # Errors
/// [`Error::Resume`] when the run is longer already; otherwise as [`resume`].
pub fn extend(
    dir: &RunDir,
    duration_ms: f64,
    host: &Host<'_>,
    watch: &mut dyn FnMut(&Progress) -> ControlFlow<()>,
) -> Result<RunInfo, Error> {
    let mut scene = Scene::read(dir.scene())?;
    scene.solver.duration_ms = duration_ms;
    scene.validate()?;
    go_on(dir, scene, host, watch)
}

fn go_on(
    dir: &RunDir,
    scene: Scene,
    host: &Host<'_>,
    watch: &mut dyn FnMut(&Progress) -> ControlFlow<()>,
) -> Result<RunInfo, Error> {
    let started = (host.wall_s)();
    let checkpoint = read_saved::<Saved>(dir, &scene)?;
    let mut progress = Progress::begin();
    let _ = watch(&progress);
    lead(host, &scene, Some(&checkpoint))?;
    let Checkpoint { mut info, motion: saved } = checkpoint;
    let (assembly, machine) = prepare_again(&scene, host, &info)?;
    let mesh = assembly.mesh_info();
    progress.elements = mesh.quads + mesh.triangles;

    take_over(&mut info, &scene, host);
    let full = Full::resume(&scene, &assembly, machine, &info, saved, Some(dir), host)?;
    let mut run = Run::resume(&scene, full, info, dir)?;
    run.info.setup_s += (host.wall_s)() - started;
    dir.go_on(&scene, &run.info)?;
    run.finish(dir, host, progress, watch)
}

/// Sets a run up that goes on.
fn prepare_again(scene: &Scene, host: &Host<'_>, info: &RunInfo) -> Result<(Assembly, Machine), Error> {
    let assembly = Assembly::new(scene)?;
    let mut machine = assembly.machine(scene, host.threads)?;
    machine.system.set_time_step(info.time_step_s, Some(info.critical_time_step_s))?;
    damp(scene, &mut machine)?;
    Ok((assembly, machine))
}

/// Takes part in the run that the first of several ranks begins or continues, to its end, and writes nothing. For all ranks
/// but the first.
///
/// # Errors
/// Where the first rank has one, too, but for those of its files.
pub fn follow(host: &Host<'_>) -> Result<(), Error> {
    let Some(ranks) = &host.ranks else { return Ok(()) };
    let (scene, checkpoint) = called_to(&**ranks)?;
    match checkpoint {
        None => {
            let Prepared { assembly, machine, setup, .. } = prepare(&scene, host, &mut |_| {})?;
            let full = Full::start(&scene, &assembly, machine, None, host);
            Run::follow(full, setup.info(&scene, host), host)
        }
        Some(Checkpoint { info, motion }) => {
            let (assembly, machine) = prepare_again(&scene, host, &info)?;
            let full = Full::resume(&scene, &assembly, machine, &info, motion, None, host)?;
            Run::follow(full, info, host)
        }
    }
}

/// Hands the run of a checkpoint over to this program.
pub fn take_over(info: &mut RunInfo, scene: &Scene, host: &Host<'_>) {
    if (&info.version, &info.commit) != (&host.version, &host.commit) {
        info.warnings.push(format!(
            "version {} ({}) began this run and version {} ({}) continued it: its bits may differ from those of an \
             unbroken run",
            info.version, info.commit, host.version, host.commit
        ));
    }
    info.version.clone_from(&host.version);
    info.commit.clone_from(&host.commit);
    info.machine.clone_from(&host.machine);
    info.threads = host.threads;
    info.scene_hash = scene.hash();
    info.status = Status::Running;
    info.stop_reason = None;
    info.resumed_at_s.push(info.samples as f64 * info.interval_s);
}

/// Simulated time [s] from which [`resume`] would continue the run in `dir`; everything that can be checked without
/// making the mesh is.
///
/// # Errors
/// As [`resume`].
pub fn saved_until(dir: &RunDir) -> Result<f64, Error> {
    let info = read_saved::<Saved>(dir, &Scene::read(dir.scene())?)?.info;
    Ok(info.samples as f64 * info.interval_s)
}

/// The checkpoint in `dir`, to continue from under `scene`.
///
/// # Errors
/// [`Error::Resume`] when there is nothing to continue or nothing to continue from.
pub fn read_saved<S: Serialize + DeserializeOwned>(
    dir: &RunDir,
    scene: &Scene,
) -> Result<Checkpoint<S>, Error> {
    let doubt = may_go_on(dir, scene)?;
    let mut saved = Checkpoint::read(&dir.checkpoint(), &identity(scene))?;
    saved.info.steps_planned = check_counts(dir, scene, &saved.info)?;
    saved.info.warnings.extend(doubt);
    Ok(saved)
}

/// Steps of the whole run. Steps and samples of a checkpoint must be those of its scene: forged ones could ask for any
/// number of steps.
fn check_counts(dir: &RunDir, scene: &Scene, info: &RunInfo) -> Result<u64, Error> {
    let refused = |reason: String| Err(Error::Resume { path: dir.path().to_owned(), reason });
    let Geometry { interval, duration, .. } = Geometry::of(scene);
    let per_sample = (info.interval_s / info.time_step_s).round();
    let samples = (duration / interval).round().max(1.0);
    let fits = info.interval_s == interval
        && (1.0..=MOST_STEPS).contains(&per_sample)
        && info.steps as f64 == info.samples as f64 * per_sample;
    if !fits {
        return refused(
            "its checkpoint counts steps and samples that its scene does not have: it was damaged. Otherwise start it anew from its \
             `scene.ron`; its samples stay readable until then"
                .to_owned(),
        );
    }
    if info.samples as f64 > samples {
        return refused(format!(
            "its checkpoint holds {} ms, and `solver.duration_ms` asks for {}: a run can be made longer, not shorter. \
             Otherwise start it anew",
            // To the nanosecond, so that it reads as it was written.
            (1e9 * interval * info.samples as f64).round() / 1e6,
            scene.solver.duration_ms
        ));
    }
    Ok((samples * per_sample) as u64)
}

/// More steps in a sample than any scene has: a second in steps of a nanosecond.
const MOST_STEPS: f64 = 1e9;

/// Refuses runs that ended by themselves, as far as `run.json` tells; a warning when it does not. Scene and checkpoint are
/// enough to continue.
fn may_go_on(dir: &RunDir, scene: &Scene) -> Result<Option<String>, Error> {
    let info = match dir.read_info() {
        Ok(info) => info,
        Err(error) => return Ok(Some(format!("`run.json` was made anew from the checkpoint: {error}"))),
    };
    let reason = match info.status {
        Status::Diverged => {
            "it diverged, and the same steps would diverge again. `run.json` says why and what to change"
        }
        Status::Complete if info.scene_hash == scene.hash() => {
            "it is complete. A longer one: `--resume` with `--set solver.duration_ms=…`"
        }
        Status::Complete if !dir.checkpoint().exists() => {
            "it is complete, and without its checkpoint it cannot be made longer. Start a longer one anew"
        }
        _ => return Ok(None),
    };
    Err(Error::Resume { path: dir.path().to_owned(), reason: reason.to_owned() })
}

fn expected_support(scene: &Scene, machine: &Machine) -> f64 {
    let system = &machine.system;
    let mass = |body: usize| system.nodes_of(body).map(|n| system.mass(n)).sum::<f64>();
    let load = scene.duty().mean_load_n(Geometry::of(scene).duration);
    let [_, up] = scene.load_direction();
    let held = std::iter::once(machine.outer).chain(machine.housing);
    load - up * scene.operation.gravity_m_s2 * held.map(mass).sum::<f64>()
}

/// Sets the mass damping of the scene, if it has one.
fn damp(scene: &Scene, machine: &mut Machine) -> Result<(), Error> {
    let rate = scene.solver.mass_damping_per_s;
    if rate == 0.0 {
        return Ok(());
    }
    let (standing, rolling) = match scene.solver.damping_frame {
        DampingFrame::Rolling => (Frame::Rest, Frame::Tangential { centre: [0.0; 2] }),
        DampingFrame::RigidMotion => (Frame::OwnMotion, Frame::OwnMotion),
        DampingFrame::Absolute => (Frame::Rest, Frame::Rest),
    };
    // The inner ring's bore is driven: what is damped there would only be fed in again.
    let held = std::iter::once(machine.outer).chain(machine.housing);
    let mut frames: Vec<(usize, Frame)> = held.map(|body| (body, standing)).collect();
    frames.extend(machine.rollers.iter().map(|r| (r.body, rolling)));
    machine.system.set_mass_damping(&MassDamping::new(rate, frames)?);
    Ok(())
}

/// Writes the mesh at the start of the run: as the preload has left it, and free of stress
/// ([`stribeck_scene::mesh_file`]).
fn write_mesh(assembly: &Assembly, machine: &Machine, dir: &RunDir) -> Result<(), Error> {
    let file = mesh_file(assembly, &|node| machine.system.position(node))?;
    Ok(write_atomic(&dir.mesh(), &file)?)
}

/// The file of a mesh whose nodes stand at these places [m].
///
/// # Errors
/// When the mesh cannot be written as a file.
pub fn mesh_file(assembly: &Assembly, place: &dyn Fn(u32) -> [f64; 2]) -> Result<Vec<u8>, Error> {
    let mut mesh = assembly.model.mesh.clone();
    let reference: Vec<[f64; 3]> = mesh.x.iter().zip(&mesh.y).map(|(&x, &y)| [x, y, 0.0]).collect();
    for n in 0..mesh.x.len() {
        [mesh.x[n], mesh.y[n]] = place(n as u32);
    }
    let moved: Vec<[f64; 3]> = reference
        .iter()
        .enumerate()
        .map(|(n, from)| [mesh.x[n] - from[0], mesh.y[n] - from[1], 0.0])
        .collect();
    let fields =
        [vtu::Field::vector("displacement_m", &moved), vtu::Field::exact_vector(REFERENCE, &reference)];
    let mut file = Vec::new();
    vtu::write(&mut file, &mesh, &fields, &[])?;
    Ok(file)
}
