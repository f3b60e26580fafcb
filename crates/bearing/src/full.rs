//! The full model in motion: elements, contact, recorder, guards and frames as the time loop drives them.

use std::sync::Arc;

use serde::{Deserialize, Serialize};
use stribeck_system::{Ledger, Snapshot};

use crate::{
    assembly::{Assembly, Machine, load},
    error::Error,
    frames::Frames,
    guards::{self, Guards},
    host::Host,
    recorder::{self, Recorder},
    time_loop::Motion,
};
use stribeck_scene::{duty::Duty, run_dir::RunDir, run_info::RunInfo, scene::Scene};

/// What a checkpoint holds of the full model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Saved {
    system: Snapshot,
    recorder: recorder::Memory,
}

/// The full model in motion.
pub(crate) struct Full<'a> {
    assembly: &'a Assembly,
    machine: Machine,
    recorder: Recorder,
    frames: Option<Frames>,
    guards: Guards,
    /// Speeds and load, where they change, and the load that a factor of one stands for [N].
    duty: Option<(Duty, f64)>,
    outer_turns: bool,
}

impl<'a> Full<'a> {
    /// Before its first step.
    pub(crate) fn start(
        scene: &Scene,
        assembly: &'a Assembly,
        mut machine: Machine,
        frames: Option<Frames>,
        host: &Host<'_>,
    ) -> Self {
        guards::arm(scene, &mut machine.system);
        host.ranks.iter().for_each(|ranks| machine.system.divide(Arc::clone(ranks)));
        Self {
            recorder: Recorder::new(scene, &machine),
            frames,
            guards: Guards::new(scene, assembly, &machine),
            duty: scene.varying_duty().map(|duty| (duty, scene.operation.load_n)),
            outer_turns: scene.operation.outer_turns(),
            assembly,
            machine,
        }
    }

    /// As it was saved.
    pub(crate) fn resume(
        scene: &Scene,
        assembly: &'a Assembly,
        mut machine: Machine,
        info: &RunInfo,
        saved: Saved,
        dir: Option<&RunDir>,
        host: &Host<'_>,
    ) -> Result<Self, Error> {
        let other = |what: String| Error::Resume {
            path: dir.map(|dir| dir.path().to_owned()).unwrap_or_default(),
            reason: format!("{what}. Continue it with the program that began it, or start it anew"),
        };
        let elsewhere =
            || other("this program makes another model of the scene than the checkpoint has".into());
        if info.mesh != assembly.mesh_info() {
            return Err(elsewhere());
        }
        guards::arm(scene, &mut machine.system);
        machine.system.restore(saved.system).map_err(|e| other(e.to_string()))?;
        host.ranks.iter().for_each(|ranks| machine.system.divide(Arc::clone(ranks)));
        Ok(Self {
            recorder: Recorder::resume(scene, &machine, saved.recorder).ok_or_else(elsewhere)?,
            frames: dir.and_then(|dir| Frames::of(scene, dir.frames())),
            guards: Guards::new(scene, assembly, &machine),
            duty: scene.varying_duty().map(|duty| (duty, scene.operation.load_n)),
            outer_turns: scene.operation.outer_turns(),
            assembly,
            machine,
        })
    }
}

impl Full<'_> {
    /// Speeds and load of the next step, where they change.
    fn drive(&mut self) -> Result<(), Error> {
        let Some((duty, load_n)) = &self.duty else { return Ok(()) };
        let system = &mut self.machine.system;
        let now = system.time();
        let next = now + system.time_step();
        system.set_rotation_rate(duty.mean_shaft_rad_s(now, next))?;
        if self.outer_turns {
            system.set_turning_rate(duty.mean_outer_rad_s(now, next))?;
        }
        load(system, duty, *load_n, now)
    }
}

impl Motion for Full<'_> {
    type Saved = Saved;

    fn interval(&mut self, steps: usize) -> Result<Ledger, Error> {
        for _ in 1..steps {
            self.drive()?;
            self.machine.system.step()?;
            self.recorder.after_step(&self.machine);
        }
        self.drive()?;
        // Sensors may lie on other ranks.
        self.machine.system.gather()?;
        self.recorder.before_step(&self.machine);
        let ledger = self.machine.system.step_with_ledger()?;
        self.recorder.after_step(&self.machine);
        Ok(ledger)
    }

    fn row(&mut self) -> &[f64] {
        self.recorder.sample(&self.machine)
    }

    fn steps(&self) -> u64 {
        self.machine.system.steps()
    }

    fn time(&self) -> f64 {
        self.machine.system.time()
    }

    fn balance(&self) -> [f64; 2] {
        let balance = self.machine.system.balance();
        [balance.peak_strain, balance.largest_error]
    }

    fn look(&mut self, info: &mut RunInfo) -> Option<String> {
        self.guards.look(info, &mut self.machine)
    }

    fn picture(&mut self, sample: usize) -> Result<(), Error> {
        if let Some(frames) = self.frames.as_ref().filter(|f| f.is_due(sample)) {
            frames.write(sample, self.assembly, &self.machine)?;
        }
        Ok(())
    }

    fn saved(&self) -> Saved {
        Saved { system: self.machine.system.snapshot(), recorder: self.recorder.memory().clone() }
    }
}
