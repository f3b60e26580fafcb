//! **One run** of the model that a scene names: from its start, or from a checkpoint.

use std::ops::ControlFlow;

use crate::run::{
    checkpoint::Checkpoint,
    host::{Host, Progress},
    resume::{read_saved, take_over},
    time_loop::Run,
};
use stribeck_scene::{
    advice,
    resolved::ResolvedScene,
    scene::{ModelScene, Scene},
};
use stribeck_store::{
    run_dir::{RunDir, write_atomic},
    run_info::{RunInfo, Topic},
};

use crate::{
    error::Error,
    full::Full,
    model::{Misfit, Model, Preparation},
    reduced::Reduced,
};

/// Called at every sample; may stop the run.
pub type Watch<'a> = &'a mut dyn FnMut(&Progress) -> ControlFlow<()>;

/// Something that is done with the model of a scene.
trait Task {
    type Output;
    fn with<M: Model>(self) -> Self::Output;
}

/// Does it with the model that the scene names.
fn dispatch<T: Task>(scene: &ResolvedScene, task: T) -> T::Output {
    match scene.written.model {
        ModelScene::Full => task.with::<Full>(),
        ModelScene::Reduced(_) => task.with::<Reduced>(),
    }
}

/// Runs a scene and leaves its results in `dir`.
///
/// `watch` is called at every sample and may stop the run, which then ends as
/// [`Interrupted`](stribeck_store::run_info::Status::Interrupted). A checkpoint is written at the start, now
/// and then, and at an interruption; [`resume`] continues from it.
///
/// # Errors
/// When the scene cannot be meshed, preloaded or reduced, or the traces cannot be written. A run that
/// diverges is not an error: its status and reason are in the returned [`RunInfo`]. A checkpoint that cannot
/// be written is a warning there.
pub fn simulate(scene: &Scene, dir: &RunDir, host: &Host<'_>, watch: Watch<'_>) -> Result<RunInfo, Error> {
    let scene = &scene.resolve();
    dispatch(scene, Begin { scene, dir, host, watch })
}

/// Continues the run in `dir` from its checkpoint. Its files become those of an unbroken run, byte for byte,
/// whatever the number of threads; the mesh is made again, the preload is not.
///
/// `watch` as for [`simulate`].
///
/// # Errors
/// [`Error::Resume`] when there is nothing to continue or nothing to continue from; otherwise as
/// [`simulate`].
pub fn resume(dir: &RunDir, host: &Host<'_>, watch: Watch<'_>) -> Result<RunInfo, Error> {
    let scene = &Scene::read(dir.scene())?.resolve();
    dispatch(scene, Continue { scene, dir, host, watch })
}

/// Continues the run in `dir` to another duration, also when it is complete. Its files become those of an
/// unbroken run of this duration.
///
/// `watch` as for [`simulate`].
///
/// # Errors
/// [`Error::Resume`] when the run is longer already; otherwise as [`resume`].
pub fn extend(dir: &RunDir, duration_ms: f64, host: &Host<'_>, watch: Watch<'_>) -> Result<RunInfo, Error> {
    let mut scene = Scene::read(dir.scene())?;
    scene.solver.duration_ms = duration_ms;
    scene.validate()?;
    let scene = &scene.resolve();
    dispatch(scene, Continue { scene, dir, host, watch })
}

/// Simulated time [s] from which [`resume`] would continue the run in `dir`; everything that can be checked
/// without making the model is.
pub fn saved_until(dir: &RunDir) -> Result<f64, Error> {
    let scene = &Scene::read(dir.scene())?.resolve();
    dispatch(scene, SavedUntil { scene, dir })
}

struct Begin<'a> {
    scene: &'a ResolvedScene,
    dir: &'a RunDir,
    host: &'a Host<'a>,
    watch: Watch<'a>,
}

impl Task for Begin<'_> {
    type Output = Result<RunInfo, Error>;

    fn with<M: Model>(self) -> Self::Output {
        let Self { scene, dir, host, watch } = self;
        let alone = host.on_one_thread();
        let working = if M::SHARED { host } else { &alone };
        let mut with = Preparation { scene, host: working, dir, progress: Progress::begin() };
        with.enter("mesh", watch);
        let (model, setup) = M::prepare(&mut with, watch)?;
        let mut info = setup.info(scene, host);
        scene.doubts().into_iter().for_each(|words| info.warn(Topic::Contact.warning(words)));
        let undamped = advice::undamped_housing(&scene.written);
        undamped.into_iter().for_each(|words| info.warn(Topic::TimeStep.warning(words)));
        model.warnings(scene, &info).into_iter().for_each(|warning| info.warn(warning));
        dir.start(&scene.written, &info)?;
        write_atomic(&dir.mesh(), &model.mesh_file(scene)?)?;
        let motion = model.start(&with);
        Run::start(scene, motion, info, dir)?.finish(dir, working, with.progress, watch)
    }
}

struct Continue<'a> {
    scene: &'a ResolvedScene,
    dir: &'a RunDir,
    host: &'a Host<'a>,
    watch: Watch<'a>,
}

impl Task for Continue<'_> {
    type Output = Result<RunInfo, Error>;

    fn with<M: Model>(self) -> Self::Output {
        let Self { scene, dir, host, watch } = self;
        let started = (host.wall_s)();
        let alone = host.on_one_thread();
        let working = if M::SHARED { host } else { &alone };
        let Checkpoint { mut info, motion: saved } = read_saved::<M::Saved>(dir, scene)?;
        let mut with = Preparation { scene, host: working, dir, progress: Progress::begin() };
        with.enter("mesh", watch);
        let model = M::prepare_again(&mut with, &info)?;
        take_over(&mut info, scene, host);
        let motion = model.go_on(&with, &info, saved).map_err(|Misfit(what)| Error::Resume {
            path: dir.path().to_owned(),
            reason: format!("{what}. Continue it with the program that began it, or start it anew"),
        })?;
        let mut run = Run::resume(scene, motion, info, dir)?;
        run.info.setup_s += (host.wall_s)() - started;
        dir.go_on(&scene.written, &run.info)?;
        run.finish(dir, working, with.progress, watch)
    }
}

struct SavedUntil<'a> {
    scene: &'a ResolvedScene,
    dir: &'a RunDir,
}

impl Task for SavedUntil<'_> {
    type Output = Result<f64, Error>;

    fn with<M: Model>(self) -> Self::Output {
        let info = read_saved::<M::Saved>(self.dir, self.scene)?.info;
        Ok(info.samples as f64 * info.interval_s)
    }
}
