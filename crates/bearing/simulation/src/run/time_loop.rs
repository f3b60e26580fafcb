//! The time loop: samples, energy ledger, when to stop, when to save.

use std::ops::ControlFlow;

use serde::{Serialize, de::DeserializeOwned};
use stribeck_system::{Ledger, Workers};
use stribeck_theory::duty::Duty;

use crate::error::Error;
use crate::run::{
    channels::{self, Channels, Sample},
    checkpoint::{Checkpoint, identity},
    host::{Host, Progress},
};
use stribeck_scene::resolved::ResolvedScene;
use stribeck_store::{
    run_dir::{RunDir, write_atomic},
    run_info::{RunInfo, Status, Topic},
    trace::TraceWriter,
};

/// A model of a bearing in motion, which the time loop drives from sample to sample.
pub trait Motion: Send {
    /// State from which it continues after a sample.
    type Saved: Serialize + DeserializeOwned;

    /// Takes the steps of one sampling interval; the last one is accounted for.
    ///
    /// # Errors
    /// When the model cannot take steps at all.
    fn interval(&mut self, steps: usize) -> Result<Ledger, Error>;

    /// The sample at the end of the interval. Called once an interval: the next means and changes start from
    /// here.
    fn sample(&mut self) -> &Sample;

    /// Steps taken.
    fn steps(&self) -> u64;

    /// Time of the positions [s].
    fn time(&self) -> f64;

    /// Peak of the strain energy so far [J], and the largest imbalance of energy over it [-].
    fn balance(&self) -> [f64; 2];

    /// Looks at the state after a sample: adds warnings to `info`; the reason to stop, if there is one.
    fn look(&mut self, info: &mut RunInfo) -> Option<String>;

    /// Writes the picture of a sample, if one is due.
    fn picture(&mut self, _sample: usize) -> Result<(), Error> {
        Ok(())
    }

    /// State to continue from.
    fn saved(&self) -> Self::Saved;
}

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
fn columns(scene: &ResolvedScene) -> Vec<&'static str> {
    let film = scene.written.film.is_some().then_some(FILM);
    COLUMNS.into_iter().chain(film).collect()
}

fn passages_a_turn(scene: &ResolvedScene) -> f64 {
    scene.rollers as f64 * scene.inner_race_radius / (scene.inner_race_radius + scene.outer_race_radius)
}

/// A run in its time loop.
pub struct Run<M> {
    /// Content of `run.json`.
    pub info: RunInfo,
    /// Identity of its checkpoints.
    identity: String,
    motion: M,
    channels: Channels,
    row: Vec<f64>,
    trace: TraceWriter,
    energy: TraceWriter,
    /// Whether the ledger has a column for oil.
    oiled: bool,
    duty: Duty,
    /// Elements that pass a place of the outer ring in a turn of the inner one against it, without slip.
    passages_a_turn: f64,
    energy_warning_percent: f64,
}

/// Time of the last checkpoint, and how long writing it took.
#[derive(Default)]
struct Saved {
    sample: usize,
    wall_s: f64,
    cost_s: f64,
    /// A checkpoint could not be written, and a warning was given.
    failed: bool,
}

impl Saved {
    /// Whether it is time to save after a sample. The clock is read only when enough samples have passed.
    fn is_due(&self, sample: usize, wall_s: impl FnOnce() -> f64) -> bool {
        if sample - self.sample < SAVE_EVERY {
            return false;
        }
        let passed = wall_s() - self.wall_s;
        // A clock that was set back, or that stands still, must not postpone saving.
        let counts = passed >= 0.0 && self.cost_s >= 0.0;
        !counts || SAVE_SHARE * passed >= self.cost_s
    }
}

impl<M: Motion> Run<M> {
    /// A run before its first step.
    ///
    /// # Errors
    /// When the traces cannot be written.
    pub fn start(scene: &ResolvedScene, motion: M, info: RunInfo, dir: &RunDir) -> Result<Self, Error> {
        Ok(Self {
            trace: TraceWriter::create(dir.trace(), &channels::names(scene))?,
            energy: TraceWriter::create(dir.energy(), &columns(scene))?,
            oiled: scene.written.film.is_some(),
            duty: scene.duty.clone(),
            passages_a_turn: passages_a_turn(scene),
            energy_warning_percent: scene.written.guards.energy_warning_percent,
            identity: identity(&scene.written),
            channels: Channels::of(scene),
            row: Vec::new(),
            info,
            motion,
        })
    }

    /// A run as it was saved. Samples that were written after the checkpoint are cut off; they will come
    /// again.
    ///
    /// # Errors
    /// When the traces cannot be written, or hold fewer samples.
    pub fn resume(scene: &ResolvedScene, motion: M, info: RunInfo, dir: &RunDir) -> Result<Self, Error> {
        let rows = info.samples as u64;
        Ok(Self {
            trace: TraceWriter::resume(dir.trace(), &channels::names(scene), rows)?,
            energy: TraceWriter::resume(dir.energy(), &columns(scene), rows)?,
            oiled: scene.written.film.is_some(),
            duty: scene.duty.clone(),
            passages_a_turn: passages_a_turn(scene),
            energy_warning_percent: scene.written.guards.energy_warning_percent,
            identity: identity(&scene.written),
            channels: Channels::of(scene),
            row: Vec::new(),
            info,
            motion,
        })
    }

    /// Runs the remaining steps and closes the files.
    ///
    /// # Errors
    /// When samples cannot be written.
    pub fn finish(
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
        // Read when they are written: asking the system for processor time takes as long as several steps of
        // a small model.
        let note_times = |info: &mut RunInfo| {
            // Clocks may jump; times that are written only grow.
            info.wall_s = info.wall_s.max(earlier.0 + (host.wall_s)() - began);
            let cpu = (host.cpu_s)();
            info.cpu_s = info.cpu_s.max(earlier.1 + cpu);
            info.loop_cpu_s = info.loop_cpu_s.max(earlier.2 + cpu - set_up_cpu);
        };
        let mut saved = Saved { sample: self.info.samples, wall_s: began, ..Saved::default() };
        if self.info.samples == 0 {
            // The preload need not be repeated, whatever happens from now on.
            self.save(dir, &mut saved, host)?;
        }
        progress.phase = "run";
        progress.steps = self.info.steps_planned;
        for sample in self.info.samples + 1..=samples {
            // The steps of an interval run inside the pool: a fork from outside costs much more than one
            // within.
            let ledger = workers.run(|| self.motion.interval(steps_per_sample))?;
            self.write(&ledger)?;
            self.motion.picture(sample)?;
            self.info.steps = self.motion.steps();
            self.info.samples = sample;
            self.info.simulated_s = sample as f64 * self.info.interval_s;
            progress.step = self.motion.steps();
            progress.time_s = self.motion.time();
            let stop = self.motion.look(&mut self.info);
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
            if saved.is_due(sample, || (host.wall_s)()) {
                note_times(&mut self.info);
                self.save(dir, &mut saved, host)?;
            }
        }
        note_times(&mut self.info);
        // A diverged run keeps the one before: that is the state before things went wrong. A complete one can
        // be made longer.
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
        self.judge_energy();
        self.trace.finish()?;
        self.energy.finish()?;
        dir.write_info(&self.info)?;
        Ok(self.info)
    }

    /// Warns of an imbalance, once the passages say what it is compared with.
    fn judge_energy(&mut self) {
        self.info.take_back(Topic::Energy);
        let (energy, limit) = (&self.info.energy, self.energy_warning_percent);
        if energy.passages < 1.0 || 100.0 * energy.share() <= limit {
            return;
        }
        let field = if self.info.reduced.is_some() { "model.step_us" } else { "solver.time_step_factor" };
        let words =
            format!("energy is off by {} (limit {limit} %): take a smaller `{field}`", energy.in_words());
        self.info.warn(Topic::Energy.warning(words));
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
            let at = 1e3 * self.motion.time();
            let words = format!("no checkpoint at {at:.3} ms, the run went on: {error}");
            self.info.warn(Topic::Checkpoint.warning(words));
        }
        saved.sample = self.info.samples;
        saved.wall_s = (host.wall_s)();
        saved.cost_s = saved.wall_s - began;
        Ok(())
    }

    fn checkpoint(&self) -> Checkpoint<M::Saved> {
        Checkpoint { info: self.info.clone(), motion: self.motion.saved() }
    }

    fn write(&mut self, l: &Ledger) -> Result<(), Error> {
        [self.info.energy.peak_strain_j, self.info.energy.max_relative_error] = self.motion.balance();
        let energy = &mut self.info.energy;
        energy.contact_heat_j = l.friction + l.contact_damping + l.film;
        energy.heat_j = energy.contact_heat_j + l.damping;
        energy.passages = self.passages_a_turn * self.duty.relative_turns(l.time).abs();
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
        if self.oiled {
            row.push(l.film);
        }
        self.energy.push(&row)?;
        self.channels.write(self.motion.sample(), &mut self.row);
        Ok(self.trace.push(&self.row)?)
    }
}
