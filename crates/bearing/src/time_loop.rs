//! The time loop: samples, the energy ledger, when to stop, when to save.

use std::ops::ControlFlow;

use stribeck_solver::{Force, Velocities};

use crate::{
    assembly::{Assembly, Machine},
    checkpoint::{Checkpoint, identity},
    error::Error,
    frames::Frames,
    guards::Guards,
    ledger::{COLUMNS, Ledger, Reference},
    recorder::Recorder,
    simulation::{Host, Progress},
};
use stribeck_scene::{
    run_dir::{RunDir, write_atomic},
    run_info::{RunInfo, Status},
    scene::Scene,
    trace::TraceWriter,
};

/// Imbalance is never measured against less than this share of the kinetic energy.
const ROUNDING: f64 = 1e-9;

/// Checkpoint and `run.json` are written again after this many samples …
const SAVE_EVERY: usize = 100;

/// … but not so often that it would take more than this share of the time.
const SAVE_SHARE: f64 = 0.005;

/// Rounds of waiting until a thread that has nothing to do goes to sleep: about a millisecond.
const SPINS_BEFORE_SLEEP: usize = 20_000;

/// A run in its time loop.
pub(crate) struct Run<'a> {
    pub(crate) info: RunInfo,
    /// What its checkpoints belong to.
    identity: String,
    assembly: &'a Assembly,
    machine: Machine,
    recorder: Recorder,
    trace: TraceWriter,
    energy: TraceWriter,
    frames: Option<Frames>,
    reference: Reference,
    /// Velocities before a step, for the kinetic energy at its start.
    before: Velocities,
    guards: Guards,
}

/// When a run was last saved, and what that cost.
#[derive(Default)]
struct Saved {
    sample: usize,
    wall_s: f64,
    cost_s: f64,
    /// A checkpoint could not be written, and that was said.
    failed: bool,
}

impl Saved {
    fn is_due(&self, sample: usize, wall_s: f64) -> bool {
        let passed = wall_s - self.wall_s;
        // A clock that was set back, or that is none, must not put off saving.
        let counts = passed >= 0.0 && self.cost_s >= 0.0;
        sample - self.sample >= SAVE_EVERY && (!counts || SAVE_SHARE * passed >= self.cost_s)
    }
}

impl<'a> Run<'a> {
    /// A run before its first step.
    pub(crate) fn start(
        scene: &Scene,
        assembly: &'a Assembly,
        machine: Machine,
        info: RunInfo,
        dir: &RunDir,
    ) -> Result<Self, Error> {
        Ok(Self {
            recorder: Recorder::new(scene, &machine),
            trace: TraceWriter::create(dir.trace(), &Recorder::names(scene))?,
            energy: TraceWriter::create(dir.energy(), &COLUMNS)?,
            frames: Frames::of(scene, dir.frames()),
            reference: Reference::default(),
            before: Velocities::default(),
            guards: Guards::new(scene, assembly, &machine),
            identity: identity(scene),
            info,
            assembly,
            machine,
        })
    }

    /// A run as it was saved. Samples that were written after the checkpoint are cut off; they will come again.
    pub(crate) fn resume(
        scene: &Scene,
        assembly: &'a Assembly,
        mut machine: Machine,
        saved: Checkpoint,
        dir: &RunDir,
    ) -> Result<Self, Error> {
        let other = |what: String| Error::Resume {
            path: dir.path().to_owned(),
            reason: format!("{what}. Continue it with the program that began it, or start it anew"),
        };
        let elsewhere =
            || other("this program makes another model of the scene than the checkpoint has".into());
        if saved.info.mesh != assembly.mesh_info() || !machine.contacts.restore(saved.contacts) {
            return Err(elsewhere());
        }
        machine.dynamics.restore(saved.motion).map_err(|e| other(e.to_string()))?;
        machine.load.supplied = saved.load_work_j;
        let recorder = Recorder::resume(&machine, saved.recorder).ok_or_else(elsewhere)?;
        let rows = saved.info.samples as u64;
        Ok(Self {
            recorder,
            trace: TraceWriter::resume(dir.trace(), &Recorder::names(scene), rows)?,
            energy: TraceWriter::resume(dir.energy(), &COLUMNS, rows)?,
            frames: Frames::of(scene, dir.frames()),
            reference: saved.reference,
            before: Velocities::default(),
            guards: Guards::new(scene, assembly, &machine),
            identity: identity(scene),
            info: saved.info,
            assembly,
            machine,
        })
    }

    /// Takes all steps that are left and closes the files.
    pub(crate) fn finish(
        mut self,
        dir: &RunDir,
        host: &Host<'_>,
        mut progress: Progress,
        watch: &mut dyn FnMut(&Progress) -> ControlFlow<()>,
    ) -> Result<RunInfo, Error> {
        let steps_per_sample = (self.info.interval_s / self.info.time_step_s).round().max(1.0) as usize;
        let samples = self.info.steps_planned as usize / steps_per_sample;
        let earlier = (self.info.wall_s, self.info.cpu_s);
        let pool = workers(host.threads)?;
        let began = (host.wall_s)();
        let mut saved = Saved { sample: self.info.samples, wall_s: began, ..Saved::default() };
        if self.info.samples == 0 {
            // The preload need not be repeated, whatever happens from now on.
            self.save(dir, &mut saved, host)?;
        }
        progress.phase = "run";
        progress.steps = self.info.steps_planned;
        for sample in self.info.samples + 1..=samples {
            // The steps of an interval run inside the pool: a fork from outside costs much more than one within.
            let ledger = match &pool {
                Some(pool) => pool.install(|| self.interval(steps_per_sample)),
                None => self.interval(steps_per_sample),
            };
            let error = self.account(&ledger)?;
            if let Some(frames) = self.frames.as_ref().filter(|f| f.is_due(sample)) {
                frames.write(sample, self.assembly, &self.machine)?;
            }
            let state = &self.machine.dynamics.state;
            self.info.steps = state.step;
            self.info.samples = sample;
            // Clocks may jump; times that are written only grow.
            self.info.wall_s = self.info.wall_s.max(earlier.0 + (host.wall_s)() - began);
            self.info.cpu_s = self.info.cpu_s.max(earlier.1 + (host.cpu_s)());
            progress.step = state.step;
            progress.time_s = state.time;
            progress.energy_error = error;
            let stop = self.guards.look(&mut self.info, self.assembly, &self.machine, &ledger, error);
            if stop.is_some() {
                self.info.status = Status::Diverged;
                self.info.stop_reason = stop;
                break;
            }
            if watch(&progress).is_break() {
                self.info.status = Status::Interrupted;
                self.info.stop_reason = Some(format!("interrupted at {:.4} ms", 1e3 * progress.time_s));
                break;
            }
            if saved.is_due(sample, (host.wall_s)()) {
                self.save(dir, &mut saved, host)?;
            }
        }
        // A diverged run keeps the one before: that is the state before things went wrong. A complete one can be made longer.
        if self.info.status != Status::Diverged {
            self.save(dir, &mut saved, host)?;
        }
        self.close(dir)
    }

    /// Ends the run in good order.
    fn close(mut self, dir: &RunDir) -> Result<RunInfo, Error> {
        if self.info.status == Status::Running {
            self.info.status = Status::Complete;
        }
        self.trace.finish()?;
        self.energy.finish()?;
        dir.write_info(&self.info)?;
        Ok(self.info)
    }

    /// Brings samples, checkpoint and `run.json` to disk: a run that is killed continues from here.
    ///
    /// Samples that cannot be written end the run; a checkpoint that cannot be written is worth a warning.
    fn save(&mut self, dir: &RunDir, saved: &mut Saved, host: &Host<'_>) -> Result<(), Error> {
        let began = (host.wall_s)();
        // Samples first: the checkpoint must not count rows that the disk has not.
        self.trace.sync()?;
        self.energy.sync()?;
        let written = self.checkpoint().encode(&dir.checkpoint(), &self.identity);
        let written = written.and_then(|bytes| Ok(write_atomic(&dir.checkpoint(), &bytes)?));
        if let Err(error) = written.and_then(|()| Ok(dir.write_info(&self.info)?))
            && !saved.failed
        {
            saved.failed = true;
            let at = 1e3 * self.machine.dynamics.state.time;
            self.info.warnings.push(format!("no checkpoint at {at:.3} ms, the run went on: {error}"));
        }
        saved.sample = self.info.samples;
        saved.wall_s = (host.wall_s)();
        saved.cost_s = saved.wall_s - began;
        Ok(())
    }

    fn checkpoint(&self) -> Checkpoint {
        Checkpoint {
            info: self.info.clone(),
            motion: self.machine.dynamics.snapshot(),
            contacts: self.machine.contacts.state(),
            load_work_j: self.machine.load.supplied,
            recorder: self.recorder.memory().clone(),
            reference: self.reference,
        }
    }

    /// Takes the steps of one sampling interval; the last one is accounted for.
    fn interval(&mut self, steps: usize) -> Ledger {
        if self.reference.balance.is_none() {
            self.reference.gravity_work = self.machine.dynamics.gravity_work();
        }
        let mut ledger = Ledger::default();
        for s in 0..steps {
            let last = s + 1 == steps;
            let first = self.reference.balance.is_none();
            if last {
                self.recorder.before_step(&self.machine);
            }
            if last || first {
                ledger = self.step_with_ledger();
                if first {
                    self.reference.balance = Some(ledger.balance());
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
        d.velocities_into(&mut self.before);
        let elastic = d.elastic_energy();
        let gravity = d.gravity_work();
        self.step();
        let m = &self.machine;
        let contact = m.contacts.energy();
        Ledger {
            kinetic: m.dynamics.kinetic_energy(&self.before),
            strain: elastic.strain,
            hourglass: elastic.hourglass,
            contact: contact.stored,
            friction: contact.friction,
            damping: m.dynamics.heat.at_last_positions(),
            contact_damping: contact.damping,
            external: m.load.energy().supplied + (gravity - self.reference.gravity_work),
            drive: m.dynamics.drive.at_last_positions(),
        }
    }

    /// Writes one sample; returns the relative imbalance.
    fn account(&mut self, l: &Ledger) -> Result<f64, Error> {
        let energy = &mut self.info.energy;
        energy.peak_strain_j = energy.peak_strain_j.max(l.strain);
        let imbalance = (l.balance() - self.reference.balance.unwrap_or(0.0)).abs();
        // Where nothing is strained, the rounding of a large kinetic energy is no imbalance.
        let scale = energy.peak_strain_j.max(ROUNDING * l.kinetic.abs());
        let scale = if scale > 0.0 { scale } else { 1.0 };
        let error = if imbalance.is_finite() { imbalance / scale } else { f64::INFINITY };
        energy.max_relative_error = energy.max_relative_error.max(error);
        let time = self.machine.dynamics.state.time - self.machine.dynamics.time_step();
        self.energy.push(&l.row(time, error))?;
        self.trace.push(self.recorder.sample(&self.machine))?;
        Ok(error)
    }
}

/// A pool for the time loop; none for one thread.
///
/// The thread that calls is one of them. The others wait awake between two forks, which are some ten microseconds apart:
/// put to sleep, they would come back too late for every one of them.
fn workers(threads: usize) -> Result<Option<micropool::ThreadPool>, Error> {
    if threads < 2 {
        return Ok(None);
    }
    try_threads(threads - 1).map_err(|source| Error::Threads { threads, source })?;
    let pool = micropool::ThreadPoolBuilder::default().num_threads(threads - 1);
    Ok(Some(pool.idle_spin_cycles(SPINS_BEFORE_SLEEP).build()))
}

/// Starts and ends so many threads at a time, because a pool cannot say that it got fewer.
fn try_threads(threads: usize) -> std::io::Result<()> {
    let gate = std::sync::Arc::new(std::sync::RwLock::new(()));
    let closed = gate.write();
    let started: Vec<_> = (0..threads)
        .map(|_| {
            let gate = gate.clone();
            std::thread::Builder::new().spawn(move || drop(gate.read()))
        })
        .collect();
    drop(closed);
    started.into_iter().try_for_each(|thread| {
        // A thread that only waits for a gate cannot fail.
        let _ = thread?.join();
        Ok(())
    })
}
