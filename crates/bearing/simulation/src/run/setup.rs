//! The set-up of a run: everything known before its first step.

use stribeck_scene::resolved::ResolvedScene;
use stribeck_store::run_info::{EnergyInfo, GuardInfo, MeshInfo, ReducedInfo, RunInfo, Status, Warning};

use crate::run::host::Host;

/// A model that is ready to take its first step.
#[derive(Debug, Clone)]
pub struct Setup {
    /// Time step [s].
    pub time_step: f64,
    /// Critical time step [s].
    pub critical_time_step: f64,
    /// Steps in a sampling interval.
    pub steps_per_sample: usize,
    /// The mesh.
    pub mesh: MeshInfo,
    /// Modes of a reduced model.
    pub reduced: Option<ReducedInfo>,
    /// How long the set-up took [s].
    pub wall_s: f64,
    /// Mass of the outer ring and its housing [kg]: the rollers carry its weight besides the load.
    pub carried_mass: f64,
    /// Parts of the scene's mesh files that were ignored.
    pub notes: Vec<String>,
    /// Warnings of the preload and of the model.
    pub warnings: Vec<Warning>,
}

impl Setup {
    /// `run.json` before the first step.
    pub fn info(self, scene: &ResolvedScene, host: &Host<'_>) -> RunInfo {
        let &ResolvedScene { interval, duration, .. } = scene;
        let samples = (duration / interval).round().max(1.0) as usize;
        let mut info = RunInfo {
            version: host.version.clone(),
            commit: host.commit.clone(),
            scene_hash: scene.written.hash(),
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
            reduced: self.reduced,
            mesh: self.mesh,
            wall_s: 0.0,
            cpu_s: 0.0,
            loop_cpu_s: 0.0,
            setup_s: self.wall_s,
            resumed_at_s: Vec::new(),
            energy: EnergyInfo::default(),
            guards: GuardInfo::default(),
            expected_support_n: expected_support(scene, self.carried_mass),
            notes: self.notes,
            warnings: Vec::new(),
            warned_of: Vec::new(),
        };
        self.warnings.into_iter().for_each(|warning| info.warn(warning));
        info
    }
}

/// Mean force that the rollers carry [N]: the load, and the weight of a mass [kg] that rests on them.
fn expected_support(scene: &ResolvedScene, carried_mass: f64) -> f64 {
    let load = scene.duty.mean_load_n(scene.duration);
    let [_, up] = scene.written.load_direction();
    load - up * scene.gravity * (carried_mass - scene.on_foundation)
}
