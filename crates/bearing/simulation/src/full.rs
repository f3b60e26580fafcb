//! The full model: elements, contact, recorder, guards and frames as the time loop drives them.

mod frames;
mod guards;
mod recorder;

use std::ops::ControlFlow;

use crate::bearing::{
    assembly::{Assembly, BearingSystem, load},
    own_mesh,
    start::{damp, launch, preload},
};
use crate::run::{channels::Sample, host::Progress, setup::Setup, time_loop::Motion};
use serde::{Deserialize, Serialize};
use stribeck_scene::{resolved::ResolvedScene, scene::Start};
use stribeck_store::run_info::{RunInfo, Topic, Warning};
use stribeck_system::{Ledger, Snapshot};
use stribeck_theory::duty::Duty;

use crate::{
    error::Error,
    mesh_file::mesh_file,
    model::{Misfit, Model, Preparation},
};
use frames::Frames;
use guards::Guards;
use recorder::Recorder;

/// A bearing of finite elements before its first step.
pub(crate) struct Full {
    assembly: Assembly,
    bearing: BearingSystem,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Saved {
    system: Snapshot,
    recorder: recorder::Memory,
}

impl Full {
    /// Meshed and laid out.
    fn assemble(with: &mut Preparation<'_>) -> Result<Self, Error> {
        let assembly = Assembly::new(with.scene)?;
        let bearing = assembly.build(with.scene, with.host.threads)?;
        let mesh = assembly.mesh_info();
        with.progress.elements = mesh.quads + mesh.triangles;
        Ok(Self { assembly, bearing })
    }

    /// Mass of the outer ring and its housing [kg].
    fn carried_mass(&self) -> f64 {
        let system = &self.bearing.system;
        let mass = |body: usize| system.nodes_of(body).map(|n| system.mass(n)).sum::<f64>();
        std::iter::once(self.bearing.outer).chain(self.bearing.housing).map(mass).sum()
    }

    /// The model in motion, with its duty and guards.
    fn moving(self, with: &Preparation<'_>, recorder: Recorder) -> FullMotion {
        let Self { assembly, bearing } = self;
        let scene = with.scene;
        FullMotion {
            recorder,
            frames: Frames::of(scene, with.dir.frames()),
            guards: Guards::new(scene, &assembly, &bearing),
            duty: scene.varying_duty().map(|duty| (duty.clone(), scene.written.operation.load_n)),
            outer_turns: scene.written.operation.outer_turns(),
            assembly,
            bearing,
        }
    }
}

impl Model for Full {
    type Saved = Saved;
    type Motion = FullMotion;

    const SHARED: bool = true;

    fn prepare(
        with: &mut Preparation<'_>,
        watch: &mut dyn FnMut(&Progress) -> ControlFlow<()>,
    ) -> Result<(Self, Setup), Error> {
        let started = (with.host.wall_s)();
        let mut full = Self::assemble(with)?;
        with.enter("preload", watch);
        let (scene, Self { assembly, bearing }) = (with.scene, &mut full);
        let preloaded = match scene.written.solver.start {
            Start::Preloaded => preload(bearing, scene, &assembly.kinematics)?,
            Start::Sudden => None,
        };
        let critical = bearing.system.critical_time_step();
        let interval = scene.interval;
        let steps_per_sample =
            (interval / (scene.written.solver.time_step_factor * critical)).ceil().max(1.0) as usize;
        let dt = interval / steps_per_sample as f64;
        bearing.system.set_time_step(dt, Some(critical))?;
        launch(bearing, &assembly.kinematics);
        damp(scene, bearing)?;
        let setup = Setup {
            time_step: dt,
            critical_time_step: critical,
            steps_per_sample,
            mesh: assembly.mesh_info(),
            reduced: None,
            wall_s: (with.host.wall_s)() - started,
            carried_mass: full.carried_mass(),
            notes: own_mesh::notes(&scene.written),
            warnings: Vec::from_iter(preloaded.map(|words| Topic::Start.warning(words))),
        };
        Ok((full, setup))
    }

    fn prepare_again(with: &mut Preparation<'_>, info: &RunInfo) -> Result<Self, Error> {
        let mut full = Self::assemble(with)?;
        full.bearing.system.set_time_step(info.time_step_s, Some(info.critical_time_step_s))?;
        damp(with.scene, &mut full.bearing)?;
        Ok(full)
    }

    fn warnings(&self, scene: &ResolvedScene, info: &RunInfo) -> Vec<Warning> {
        Guards::before(scene, self.assembly.steel(), info)
    }

    fn mesh_file(&self, _scene: &ResolvedScene) -> Result<Vec<u8>, Error> {
        mesh_file(&self.assembly, &|node| self.bearing.system.position(node))
    }

    fn start(mut self, with: &Preparation<'_>) -> FullMotion {
        guards::arm(with.scene, &mut self.bearing.system);
        let recorder = Recorder::new(with.scene, &self.bearing);
        self.moving(with, recorder)
    }

    fn go_on(mut self, with: &Preparation<'_>, info: &RunInfo, saved: Saved) -> Result<FullMotion, Misfit> {
        if info.mesh != self.assembly.mesh_info() {
            return Err(Misfit::other_model());
        }
        guards::arm(with.scene, &mut self.bearing.system);
        self.bearing.system.restore(saved.system).map_err(|error| Misfit(error.to_string()))?;
        let recorder = Recorder::resume(with.scene, &self.bearing, saved.recorder);
        Ok(self.moving(with, recorder.ok_or_else(Misfit::other_model)?))
    }
}

/// A bearing of finite elements in motion.
pub(crate) struct FullMotion {
    assembly: Assembly,
    bearing: BearingSystem,
    recorder: Recorder,
    frames: Option<Frames>,
    guards: Guards,
    /// Speeds and load, where they change, and the load that a factor of one stands for [N].
    duty: Option<(Duty, f64)>,
    outer_turns: bool,
}

impl FullMotion {
    /// Speeds and load of the next step, where they change.
    fn drive(&mut self) -> Result<(), Error> {
        let Some((duty, load_n)) = &self.duty else { return Ok(()) };
        let system = &mut self.bearing.system;
        let now = system.time();
        let next = now + system.time_step();
        system.set_rotation_rate(duty.mean_shaft_rad_s(now, next))?;
        if self.outer_turns {
            system.set_turning_rate(duty.mean_outer_rad_s(now, next))?;
        }
        Ok(load(system, duty, *load_n, now)?)
    }
}

impl Motion for FullMotion {
    type Saved = Saved;

    fn interval(&mut self, steps: usize) -> Result<Ledger, Error> {
        for _ in 1..steps {
            self.drive()?;
            self.bearing.system.step()?;
            self.recorder.after_step(&self.bearing);
        }
        self.drive()?;
        self.recorder.before_step(&self.bearing);
        let ledger = self.bearing.system.step_with_ledger()?;
        self.recorder.after_step(&self.bearing);
        Ok(ledger)
    }

    fn sample(&mut self) -> &Sample {
        self.recorder.sample(&self.bearing)
    }

    fn steps(&self) -> u64 {
        self.bearing.system.steps()
    }

    fn time(&self) -> f64 {
        self.bearing.system.time()
    }

    fn balance(&self) -> [f64; 2] {
        let balance = self.bearing.system.balance();
        [balance.peak_strain, balance.largest_error]
    }

    fn look(&mut self, info: &mut RunInfo) -> Option<String> {
        self.guards.look(info, &mut self.bearing)
    }

    fn picture(&mut self, sample: usize) -> Result<(), Error> {
        if let Some(frames) = self.frames.as_ref().filter(|f| f.is_due(sample)) {
            frames.write(sample, &self.assembly, &self.bearing)?;
        }
        Ok(())
    }

    fn saved(&self) -> Saved {
        Saved { system: self.bearing.system.snapshot(), recorder: self.recorder.memory().clone() }
    }
}
