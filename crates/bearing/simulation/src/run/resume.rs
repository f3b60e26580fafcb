//! Continuing a run: the choice of its checkpoint, and the content of `run.json` from there on.

use serde::{Serialize, de::DeserializeOwned};
use stribeck_scene::resolved::ResolvedScene;
use stribeck_store::{
    run_dir::{RunDir, Stage},
    run_info::{RunInfo, Status, Topic},
};

use crate::error::Error;
use crate::run::{
    checkpoint::{Checkpoint, identity},
    host::Host,
};

/// Hands the run of a checkpoint over to this program.
pub fn take_over(info: &mut RunInfo, scene: &ResolvedScene, host: &Host<'_>) {
    if (&info.version, &info.commit) != (&host.version, &host.commit) {
        info.warn(Topic::Files.warning(format!(
            "version {} ({}) began this run and version {} ({}) continued it: its bits may differ from those \
             of an unbroken run",
            info.version, info.commit, host.version, host.commit
        )));
    }
    info.version.clone_from(&host.version);
    info.commit.clone_from(&host.commit);
    info.machine.clone_from(&host.machine);
    info.threads = host.threads;
    info.scene_hash = scene.written.hash();
    info.status = Status::Running;
    info.stop_reason = None;
    info.resumed_at_s.push(info.samples as f64 * info.interval_s);
}

/// The checkpoint in `dir`, to continue from under `scene`.
///
/// # Errors
/// [`Error::Resume`] when there is nothing to continue or nothing to continue from.
pub fn read_saved<S: Serialize + DeserializeOwned>(
    dir: &RunDir,
    scene: &ResolvedScene,
) -> Result<Checkpoint<S>, Error> {
    let doubt = may_go_on(dir, scene)?;
    let mut saved = Checkpoint::read(&dir.checkpoint(), &identity(&scene.written))?;
    saved.info.steps_planned = check_counts(dir, scene, &saved.info)?;
    if let Some(doubt) = doubt {
        saved.info.warn(Topic::Files.warning(doubt));
    }
    Ok(saved)
}

/// Steps of the whole run. Steps and samples of a checkpoint must be those of its scene: forged ones could
/// ask for any number of steps.
fn check_counts(dir: &RunDir, scene: &ResolvedScene, info: &RunInfo) -> Result<u64, Error> {
    let refused = |reason: String| Err(Error::Resume { path: dir.path().to_owned(), reason });
    let &ResolvedScene { interval, duration, .. } = scene;
    let per_sample = (info.interval_s / info.time_step_s).round();
    let samples = (duration / interval).round().max(1.0);
    let fits = info.interval_s == interval
        && (1.0..=MOST_STEPS).contains(&per_sample)
        && info.steps as f64 == info.samples as f64 * per_sample;
    if !fits {
        return refused(
            "its checkpoint counts steps and samples that its scene does not have: it was damaged. Otherwise \
             start it anew from its `scene.ron`; its samples stay readable until then"
                .to_owned(),
        );
    }
    if info.samples as f64 > samples {
        return refused(format!(
            "its checkpoint holds {} ms, and `solver.duration_ms` asks for {}: a run can be made longer, not \
             shorter. Otherwise start it anew",
            // To the nanosecond, so that it reads as it was written.
            (1e9 * interval * info.samples as f64).round() / 1e6,
            scene.written.solver.duration_ms
        ));
    }
    Ok((samples * per_sample) as u64)
}

/// More steps in a sample than any scene has: a second in steps of a nanosecond.
const MOST_STEPS: f64 = 1e9;

/// Refuses runs that ended on their own according to `run.json`; a warning when that cannot be read. Scene
/// and checkpoint are enough to continue.
fn may_go_on(dir: &RunDir, scene: &ResolvedScene) -> Result<Option<String>, Error> {
    let info = match dir.read_info() {
        Ok(info) => info,
        Err(error) => return Ok(Some(format!("`run.json` was made anew from the checkpoint: {error}"))),
    };
    let reason = match info.status {
        Status::Diverged => {
            "it diverged, and the same steps would diverge again. `run.json` says why and what to change"
        }
        Status::Complete
            if info.scene_hash == scene.written.hash() && Stage::of(dir.path()) == Stage::Complete =>
        {
            "it is complete, and only its report is missing: `stribeck report` writes it. A longer run: \
             `--resume` with `--set solver.duration_ms=…`"
        }
        Status::Complete if info.scene_hash == scene.written.hash() => {
            "it is complete. A longer one: `--resume` with `--set solver.duration_ms=…`"
        }
        Status::Complete if !dir.checkpoint().exists() => {
            "it is complete, and without its checkpoint it cannot be made longer. Start a longer one anew"
        }
        _ => return Ok(None),
    };
    Err(Error::Resume { path: dir.path().to_owned(), reason: reason.to_owned() })
}
