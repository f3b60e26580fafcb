//! The operations of a model by which a run begins and continues.

use std::{ops::ControlFlow, path::Path};

use crate::run::{
    host::{Host, Progress},
    setup::Setup,
    time_loop::Motion,
};
use serde::{Serialize, de::DeserializeOwned};
use stribeck_scene::resolved::ResolvedScene;
use stribeck_store::{
    run_dir::RunDir,
    run_info::{RunInfo, Warning},
};

use crate::error::Error;

/// The run of a scene that is being prepared.
pub(crate) struct Preparation<'a> {
    pub(crate) scene: &'a ResolvedScene,
    /// The program, with the threads that the model makes use of.
    pub(crate) host: &'a Host<'a>,
    pub(crate) dir: &'a RunDir,
    pub(crate) progress: Progress,
}

impl Preparation<'_> {
    /// The folder in which the run's folder lies.
    pub(crate) fn runs(&self) -> Option<&Path> {
        self.dir.path().parent()
    }

    /// Reports the start of a phase to `watch`, whose answer is ignored: a run cannot end before its first
    /// sample.
    pub(crate) fn enter(&mut self, phase: &'static str, watch: &mut dyn FnMut(&Progress) -> ControlFlow<()>) {
        self.progress.phase = phase;
        let _ = watch(&self.progress);
    }
}

/// A model of a bearing between its preload and its first step.
pub(crate) trait Model: Sized {
    /// Its state in a checkpoint.
    type Saved: Serialize + DeserializeOwned;

    type Motion: Motion<Saved = Self::Saved>;

    /// Whether threads share its steps.
    const SHARED: bool;

    /// The model of a scene in equilibrium under its load, with rolling velocities.
    fn prepare(
        with: &mut Preparation<'_>,
        watch: &mut dyn FnMut(&Progress) -> ControlFlow<()>,
    ) -> Result<(Self, Setup), Error>;

    /// The same model without its preload, for a checkpoint of a run with this `info`.
    fn prepare_again(with: &mut Preparation<'_>, info: &RunInfo) -> Result<Self, Error>;

    /// Warnings before the first step.
    fn warnings(&self, scene: &ResolvedScene, info: &RunInfo) -> Vec<Warning>;

    /// Content of `mesh.vtu` at the start.
    fn mesh_file(&self, scene: &ResolvedScene) -> Result<Vec<u8>, Error>;

    /// Sets it in motion.
    fn start(self, with: &Preparation<'_>) -> Self::Motion;

    /// Sets it in motion from a checkpoint, if that is one of this model.
    fn go_on(
        self,
        with: &Preparation<'_>,
        info: &RunInfo,
        saved: Self::Saved,
    ) -> Result<Self::Motion, Misfit>;
}

/// Why a checkpoint is of another model than this program makes of the scene.
pub(crate) struct Misfit(pub(crate) String);

impl Misfit {
    /// Meshes, nodes or modes differ.
    pub(crate) fn other_model() -> Self {
        Self("this program makes another model of the scene than the checkpoint has".to_owned())
    }
}
