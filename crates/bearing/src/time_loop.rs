//! The time loop: samples, the energy ledger, when to stop, when to save.

use std::ops::ControlFlow;

use stribeck_system::{Ledger, Workers};

use crate::{
    assembly::{Assembly, Machine},
    checkpoint::{Checkpoint, identity},
    error::Error,
    frames::Frames,
    guards::{self, Guards},
    host::{Host, Progress},
    recorder::Recorder,
};
use stribeck_scene::{
    run_dir::{RunDir, write_atomic},
    run_info::{RunInfo, Status},
    scene::Scene,
    trace::TraceWriter,
};

/// Columns of `energy.npy`; with oil, one of its heat follows.
const COLUMNS: [&str; 11] = [
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

/// The column of a scene with oil.
const FILM: &str = "film_j";

/// Checkpoint and `run.json` are written again after this many samples …
const SAVE_EVERY: usize = 100;

/// … but not so often that it would take more than this share of the time.
const SAVE_SHARE: f64 = 0.005;

/// Names of the columns of `energy.npy`.
fn columns(scene: &Scene) -> Vec<&'static str> {
    let film = scene.film.is_some().then_some(FILM);
    COLUMNS.into_iter().chain(film).collect()
}

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
        mut machine: Machine,
        info: RunInfo,
        dir: &RunDir,
    ) -> Result<Self, Error> {
        guards::arm(scene, &mut machine.system);
        Ok(Self {
            recorder: Recorder::new(scene, &machine),
            trace: TraceWriter::create(dir.trace(), &Recorder::names(scene))?,
            energy: TraceWriter::create(dir.energy(), &columns(scene))?,
            frames: Frames::of(scene, dir.frames()),
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
        if saved.info.mesh != assembly.mesh_info() {
            return Err(elsewhere());
        }
        guards::arm(scene, &mut machine.system);
        machine.system.restore(saved.system).map_err(|e| other(e.to_string()))?;
        let recorder = Recorder::resume(&machine, saved.recorder).ok_or_else(elsewhere)?;
        let rows = saved.info.samples as u64;
        Ok(Self {
            recorder,
            trace: TraceWriter::resume(dir.trace(), &Recorder::names(scene), rows)?,
            energy: TraceWriter::resume(dir.energy(), &columns(scene), rows)?,
            frames: Frames::of(scene, dir.frames()),
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
        let earlier = (self.info.wall_s, self.info.cpu_s, self.info.loop_cpu_s);
        let workers = Workers::new(host.threads)?;
        let (began, set_up_cpu) = ((host.wall_s)(), (host.cpu_s)());
        let mut saved = Saved { sample: self.info.samples, wall_s: began, ..Saved::default() };
        if self.info.samples == 0 {
            // The preload need not be repeated, whatever happens from now on.
            self.save(dir, &mut saved, host)?;
        }
        progress.phase = "run";
        progress.steps = self.info.steps_planned;
        for sample in self.info.samples + 1..=samples {
            // The steps of an interval run inside the pool: a fork from outside costs much more than one within.
            let ledger = workers.run(|| self.interval(steps_per_sample))?;
            self.write(&ledger)?;
            if let Some(frames) = self.frames.as_ref().filter(|f| f.is_due(sample)) {
                frames.write(sample, self.assembly, &self.machine)?;
            }
            let system = &self.machine.system;
            self.info.steps = system.steps();
            self.info.samples = sample;
            // Clocks may jump; times that are written only grow.
            self.info.wall_s = self.info.wall_s.max(earlier.0 + (host.wall_s)() - began);
            let cpu = (host.cpu_s)();
            self.info.cpu_s = self.info.cpu_s.max(earlier.1 + cpu);
            self.info.loop_cpu_s = self.info.loop_cpu_s.max(earlier.2 + cpu - set_up_cpu);
            progress.step = system.steps();
            progress.time_s = system.time();
            progress.energy_error = ledger.relative_error;
            let stop = self.guards.look(&mut self.info, &mut self.machine);
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
            let at = 1e3 * self.machine.system.time();
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
            system: self.machine.system.snapshot(),
            recorder: self.recorder.memory().clone(),
        }
    }

    /// Takes the steps of one sampling interval; the last one is accounted for.
    fn interval(&mut self, steps: usize) -> Result<Ledger, Error> {
        for _ in 1..steps {
            self.machine.system.step()?;
            self.recorder.after_step(&self.machine);
        }
        self.recorder.before_step(&self.machine);
        let ledger = self.machine.system.step_with_ledger()?;
        self.recorder.after_step(&self.machine);
        Ok(ledger)
    }

    /// Writes one sample.
    fn write(&mut self, l: &Ledger) -> Result<(), Error> {
        let balance = self.machine.system.balance();
        self.info.energy.peak_strain_j = balance.peak_strain;
        self.info.energy.max_relative_error = balance.largest_error;
        let mut row = vec![
            l.time,
            l.kinetic,
            l.strain,
            l.hourglass,
            l.contact,
            l.friction,
            l.damping,
            l.contact_damping,
            l.external,
            l.drive,
            l.relative_error,
        ];
        if self.machine.oiled {
            row.push(l.film);
        }
        self.energy.push(&row)?;
        Ok(self.trace.push(self.recorder.sample(&self.machine))?)
    }
}
