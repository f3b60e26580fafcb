//! One run: from a scene to a run directory.

use std::{fs::File, io::BufWriter, ops::ControlFlow};

use stribeck_mesh::vtu;
use stribeck_solver::{
    Force,
    damping::{Frame, MassDamping},
};

use crate::{
    assembly::{Assembly, Machine},
    error::Error,
    recorder::Recorder,
    run_dir::RunDir,
    run_info::{EnergyInfo, RunInfo, Status},
    scene::{DampingFrame, Scene, Start},
    start::{launch, preload},
    trace::TraceWriter,
};

/// What a library may not know by itself.
pub struct Host<'a> {
    /// Worker threads.
    pub threads: usize,
    /// Program version.
    pub version: String,
    /// Commit the program was built from.
    pub commit: String,
    /// Processor and operating system, in words.
    pub machine: String,
    /// Wall-clock time since some moment [s].
    pub wall_s: &'a dyn Fn() -> f64,
    /// Processor time of this process so far, all threads [s].
    pub cpu_s: &'a dyn Fn() -> f64,
}

/// How far a run is.
#[derive(Debug, Clone, Copy)]
pub struct Progress {
    /// What is going on: `mesh`, `preload`, `run`.
    pub phase: &'static str,
    /// Steps taken.
    pub step: u64,
    /// Steps planned.
    pub steps: u64,
    /// Simulated time [s].
    pub time_s: f64,
    /// Energy imbalance over the peak strain energy [-].
    pub energy_error: f64,
    /// Elements.
    pub elements: usize,
}

/// Columns of `energy.npy`.
const ENERGY_COLUMNS: [&str; 11] = [
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

/// A run stops when the imbalance of energy passes this share of the peak strain energy.
const WORST_IMBALANCE: f64 = 0.25;

/// `run.json` is rewritten this often, in samples.
const INFO_EVERY: usize = 100;

/// Energies at one moment [J].
#[derive(Debug, Clone, Copy, Default)]
struct Ledger {
    kinetic: f64,
    strain: f64,
    hourglass: f64,
    contact: f64,
    friction: f64,
    damping: f64,
    contact_damping: f64,
    external: f64,
    drive: f64,
}

impl Ledger {
    /// What is in the model and what has left it, less what came in.
    fn balance(&self) -> f64 {
        self.kinetic
            + self.strain
            + self.hourglass
            + self.contact
            + self.friction
            + self.damping
            + self.contact_damping
            - self.external
            - self.drive
    }
}

/// Runs a scene and leaves its results in `dir`.
///
/// `watch` is told about every sample and may break off the run, which then ends as [`Status::Interrupted`].
///
/// # Errors
/// When the scene cannot be meshed or preloaded, or a file cannot be written. A run that diverges is not an error:
/// its status and reason are in the returned [`RunInfo`].
pub fn simulate(
    scene: &Scene,
    dir: &RunDir,
    host: &Host<'_>,
    watch: &mut dyn FnMut(&Progress) -> ControlFlow<()>,
) -> Result<RunInfo, Error> {
    let started = (host.wall_s)();
    let mut progress =
        Progress { phase: "mesh", step: 0, steps: 0, time_s: 0.0, energy_error: 0.0, elements: 0 };
    let _ = watch(&progress);
    let assembly = Assembly::new(scene)?;
    let mut machine = assembly.machine(scene, host.threads)?;
    let mesh = assembly.mesh_info();
    progress.elements = mesh.quads + mesh.triangles;
    progress.phase = "preload";
    let _ = watch(&progress);
    if scene.solver.start == Start::Preloaded {
        preload(&mut machine, scene, &assembly.kinematics)?;
    }
    let critical = critical_time_step(&machine);
    let interval = 1e-6 * scene.output.interval_us;
    let steps_per_sample = (interval / (scene.solver.time_step_factor * critical)).ceil().max(1.0) as usize;
    let dt = interval / steps_per_sample as f64;
    machine.dynamics.set_time_step(dt)?;
    launch(&mut machine, &assembly.kinematics);
    if let Some(damping) = mass_damping(scene, &machine)? {
        machine.dynamics.set_mass_damping(&damping);
    }

    let samples = ((1e-3 * scene.solver.duration_ms) / interval).round().max(1.0) as usize;
    progress.steps = (samples * steps_per_sample) as u64;
    progress.phase = "run";
    let mut info = RunInfo {
        version: host.version.clone(),
        commit: host.commit.clone(),
        scene_hash: scene.hash(),
        machine: host.machine.clone(),
        threads: host.threads,
        status: Status::Running,
        stop_reason: None,
        time_step_s: dt,
        critical_time_step_s: critical,
        steps: 0,
        steps_planned: progress.steps,
        interval_s: interval,
        samples: 0,
        mesh,
        wall_s: 0.0,
        cpu_s: 0.0,
        setup_s: (host.wall_s)() - started,
        energy: EnergyInfo { max_relative_error: 0.0, peak_strain_j: 0.0 },
        expected_support_n: expected_support(scene, &machine),
        warnings: Vec::new(),
    };
    dir.start(scene, &info)?;
    write_mesh(&assembly, &machine, dir)?;

    let mut run = Run {
        recorder: Recorder::new(scene, &machine),
        trace: TraceWriter::create(dir.trace(), &Recorder::names(scene))?,
        energy: TraceWriter::create(dir.energy(), &ENERGY_COLUMNS)?,
        machine,
        baseline: None,
        before: Before::default(),
        external0: 0.0,
    };
    let pool = workers(host.threads)?;
    let loop_started = (host.wall_s)();
    for sample in 1..=samples {
        // The steps of an interval run inside the pool: a fork from outside costs much more than one within.
        let ledger = match &pool {
            Some(pool) => pool.install(|| run.interval(steps_per_sample)),
            None => run.interval(steps_per_sample),
        };
        let error = run.account(&ledger, &mut info)?;
        info.steps = run.machine.dynamics.state.step;
        info.samples = sample;
        info.wall_s = (host.wall_s)() - loop_started;
        info.cpu_s = (host.cpu_s)();
        progress.step = info.steps;
        progress.time_s = run.machine.dynamics.state.time;
        progress.energy_error = error;
        if error > WORST_IMBALANCE {
            info.status = Status::Diverged;
            info.stop_reason = Some(run.why_stopped(error, &assembly));
            break;
        }
        if watch(&progress).is_break() {
            info.status = Status::Interrupted;
            info.stop_reason = Some(format!("interrupted at {:.4} ms", 1e3 * progress.time_s));
            break;
        }
        if sample % INFO_EVERY == 0 {
            dir.write_info(&info)?;
        }
    }
    if info.status == Status::Running {
        info.status = Status::Complete;
    }
    run.trace.finish()?;
    run.energy.finish()?;
    dir.write_info(&info)?;
    Ok(info)
}

/// A pool for the time loop; none for one thread.
fn workers(threads: usize) -> Result<Option<rayon::ThreadPool>, Error> {
    if threads < 2 {
        return Ok(None);
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.map(Some).map_err(|e| Error::Threads { threads, source: e })
}

/// A run in its time loop.
struct Run {
    machine: Machine,
    recorder: Recorder,
    trace: TraceWriter,
    energy: TraceWriter,
    baseline: Option<f64>,
    before: Before,
    external0: f64,
}

/// Velocities before a step, for the kinetic energy at its start.
#[derive(Default)]
struct Before {
    vx: Vec<f64>,
    vy: Vec<f64>,
    rigid: Vec<stribeck_solver::rigid::RigidState>,
}

impl Run {
    /// Takes the steps of one sampling interval; the last one is accounted for.
    fn interval(&mut self, steps: usize) -> Ledger {
        if self.baseline.is_none() {
            self.external0 = self.machine.dynamics.gravity_work();
        }
        let mut ledger = Ledger::default();
        for s in 0..steps {
            let last = s + 1 == steps;
            let first = self.baseline.is_none();
            if last {
                self.recorder.before_step(&self.machine);
            }
            if last || first {
                ledger = self.step_with_ledger();
                if first {
                    self.baseline = Some(ledger.balance());
                }
            } else {
                self.step();
            }
            self.recorder.after_step(&self.machine);
        }
        ledger
    }

    fn step(&mut self) {
        let m = &mut self.machine;
        m.dynamics.step(&mut [&mut m.load, &mut m.contacts]);
    }

    fn step_with_ledger(&mut self) -> Ledger {
        let d = &self.machine.dynamics;
        self.before.vx.clone_from(&d.state.vx);
        self.before.vy.clone_from(&d.state.vy);
        self.before.rigid.clone_from(&d.rigid);
        let elastic = d.elastic_energy();
        let gravity = d.gravity_work();
        self.step();
        let m = &self.machine;
        let contact = m.contacts.energy();
        Ledger {
            kinetic: m.dynamics.kinetic_energy(&self.before.vx, &self.before.vy, &self.before.rigid),
            strain: elastic.strain,
            hourglass: elastic.hourglass,
            contact: contact.stored,
            friction: contact.friction,
            damping: m.dynamics.heat.at_last_positions(),
            contact_damping: contact.damping,
            external: m.load.energy().supplied + (gravity - self.external0),
            drive: m.dynamics.drive.at_last_positions(),
        }
    }

    /// Writes one sample; returns the relative imbalance.
    fn account(&mut self, l: &Ledger, info: &mut RunInfo) -> Result<f64, Error> {
        let energy = &mut info.energy;
        energy.peak_strain_j = energy.peak_strain_j.max(l.strain);
        let imbalance = (l.balance() - self.baseline.unwrap_or(0.0)).abs();
        let scale = if energy.peak_strain_j > 0.0 { energy.peak_strain_j } else { 1.0 };
        let error = if imbalance.is_finite() { imbalance / scale } else { f64::INFINITY };
        energy.max_relative_error = energy.max_relative_error.max(error);
        let time = self.machine.dynamics.state.time - self.machine.dynamics.time_step();
        self.energy.push(&[
            time,
            l.kinetic,
            l.strain,
            l.hourglass,
            l.contact,
            l.friction,
            l.damping,
            l.contact_damping,
            l.external,
            l.drive,
            error,
        ])?;
        let row = self.recorder.sample(&self.machine);
        self.trace.push(row)?;
        Ok(error)
    }

    fn why_stopped(&self, error: f64, assembly: &Assembly) -> String {
        let d = &self.machine.dynamics;
        let s = &d.state;
        let speed = |n: usize| s.vx[n].hypot(s.vy[n]);
        let worse = |a: usize, b: usize| if speed(a) >= speed(b) || speed(a).is_nan() { a } else { b };
        let worst = (0..s.x.len()).filter(|&n| d.mass()[n] > 0.0).reduce(worse).unwrap_or(0);
        let node = d.layout().node_of_slot[worst].unwrap_or(0) as usize;
        let mesh = &assembly.model.mesh;
        let body = mesh.bodies.iter().find(|b| b.nodes.contains(&node)).map_or("", |b| b.name.as_str());
        format!(
            "energy is out of balance by {:.1} % of the peak strain energy (limit {:.0} %) at step {}, t = {:.5} ms; the \
             fastest node is in the {body} at x = {:.3} mm, y = {:.3} mm with {:.3e} m/s. Try a smaller \
             `solver.time_step_factor`, a smaller `contact.penalty_scale`, or look for bodies that overlap",
            100.0 * error,
            100.0 * WORST_IMBALANCE,
            s.step,
            1e3 * s.time,
            1e3 * s.x[worst],
            1e3 * s.y[worst],
            speed(worst),
        )
    }
}

/// Critical time step with contact; its damping acts half a step late and counts with the step it is used at.
fn critical_time_step(machine: &Machine) -> f64 {
    let forces: [&dyn Force; 1] = [&machine.contacts];
    let first = machine.dynamics.critical_time_step(&forces, 0.0).time_step;
    machine.dynamics.critical_time_step(&forces, 0.9 * first).time_step
}

fn expected_support(scene: &Scene, machine: &Machine) -> f64 {
    let mass = |slots: &[u32]| slots.iter().map(|&n| machine.dynamics.mass()[n as usize]).sum::<f64>();
    scene.operation.load_n + scene.operation.gravity_m_s2 * (mass(&machine.outer) + mass(&machine.adapter))
}

fn mass_damping(scene: &Scene, machine: &Machine) -> Result<Option<MassDamping>, Error> {
    let rate = scene.solver.mass_damping_per_s;
    if rate == 0.0 {
        return Ok(None);
    }
    let (standing, rolling) = match scene.solver.damping_frame {
        DampingFrame::Rolling => (Frame::Rest, Frame::Track),
        DampingFrame::RigidMotion => (Frame::OwnMotion, Frame::OwnMotion),
        DampingFrame::Absolute => (Frame::Rest, Frame::Rest),
    };
    // The inner ring's bore is driven: what is damped there would only be fed in again.
    let mut frames: Vec<(usize, Frame)> = machine.standing_bodies.iter().map(|&b| (b, standing)).collect();
    frames.extend(machine.rollers.iter().map(|r| (r.body, rolling)));
    Ok(Some(MassDamping::new(rate, frames)?))
}

/// Writes the mesh at the start of the run, as the preload has left it.
fn write_mesh(assembly: &Assembly, machine: &Machine, dir: &RunDir) -> Result<(), Error> {
    let layout = machine.dynamics.layout();
    let mut mesh = assembly.model.mesh.clone();
    let reference = (mesh.x.clone(), mesh.y.clone());
    for (n, &slot) in layout.slot_of_node.iter().enumerate() {
        mesh.x[n] = machine.dynamics.state.x[slot as usize];
        mesh.y[n] = machine.dynamics.state.y[slot as usize];
    }
    let moved: Vec<[f64; 3]> =
        (0..mesh.x.len()).map(|n| [mesh.x[n] - reference.0[n], mesh.y[n] - reference.1[n], 0.0]).collect();
    let path = dir.mesh();
    let io = |source| Error::Io {
        action: "write",
        path: path.clone(),
        kept: "The mesh picture is missing; nothing else is lost".into(),
        source,
    };
    let mut sink = BufWriter::new(File::create(&path).map_err(io)?);
    vtu::write(&mut sink, &mesh, &[vtu::Field::vector("displacement_m", &moved)], &[])?;
    Ok(())
}
