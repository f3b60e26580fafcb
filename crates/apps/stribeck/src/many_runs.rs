//! Runs of many scenes in one folder, each below `runs/` by the hash of its scene, so that equal scenes are
//! run once, and a scene that occurs again has its run.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use anyhow::{Result, bail, ensure};
use stribeck_analysis::findings::Findings;
use stribeck_analysis::record::Record;
use stribeck_scene::scene::Scene;
use stribeck_store::Error;
use stribeck_store::run_dir::{Keep, Run, RunDir, State, write_atomic};
use stribeck_store::run_info::Status;

use crate::interrupt::{Interrupt, Interrupted};
use crate::memory;
use crate::out::caution;
use crate::place::shown;
use crate::side_by_side::{Due, Jobs, Left, Shop};
use crate::simulate::{jobs, threads};

/// The folder that holds the runs.
#[derive(Debug, Clone)]
pub(crate) struct ManyRuns(pub(crate) PathBuf);

/// A scene to be run, with its number in the table, or the reason why it cannot be.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Wanted<'a> {
    pub(crate) number: usize,
    pub(crate) scene: Result<&'a Scene, &'a str>,
}

/// How far one run has come.
pub(crate) enum Stage {
    /// Its scene cannot be, or its run could not be made: the reason.
    Refused(String),
    Failed(String),
    /// At its end, but its numbers are not made, or more lies there than is to be kept.
    Ended,
    /// At its end; it may have diverged.
    Done,
    /// To be run or continued.
    Due,
}

/// How much of the machine the runs may take, as flags of their command.
#[derive(Debug, Clone, Copy, clap::Args)]
pub(crate) struct Share {
    /// Runs that go side by side [default: as many as cores]
    #[arg(long, value_name = "N", value_parser = jobs)]
    pub(crate) jobs: Option<usize>,
    /// Worker threads of all runs together [default: all cores]; the results do not depend on it
    #[arg(long, value_name = "N", value_parser = threads)]
    pub(crate) threads: Option<usize>,
    /// Most memory that runs side by side may take together [GB]; fewer go at a time where records are long
    /// [default: what the system has free]
    #[arg(long, value_name = "G", value_parser = gigabytes)]
    pub(crate) memory_gb: Option<f64>,
}

fn gigabytes(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|gb: &f64| gb.is_finite() && *gb > 0.0);
    number.ok_or_else(|| "not a positive number of gigabytes, such as 8".to_owned())
}

impl ManyRuns {
    /// The folder of a run: by its scene, so that equal scenes are run once.
    pub(crate) fn run(&self, scene: &Scene) -> PathBuf {
        self.0.join("runs").join(scene.hash())
    }

    /// Why a run cannot be made, if somebody has tried.
    fn failure(&self, scene: &Scene) -> PathBuf {
        self.0.join("failed").join(format!("{}.txt", scene.hash()))
    }

    /// Writes down why a run cannot be made.
    fn keep_failure(&self, scene: &Scene, why: &str) -> Result<()> {
        let path = self.failure(scene);
        path.parent().map_or(Ok(()), std::fs::create_dir_all)?;
        Ok(write_atomic(&path, why.as_bytes())?)
    }

    /// How far the run of a scene has come.
    pub(crate) fn stage(&self, keep: Keep, wanted: Wanted<'_>) -> Result<Stage> {
        let scene = match wanted.scene {
            Ok(scene) => scene,
            Err(why) => return Ok(Stage::Refused(why.to_owned())),
        };
        if let Ok(why) = std::fs::read_to_string(self.failure(scene)) {
            return Ok(Stage::Failed(why));
        }
        let path = self.run(scene);
        Ok(match State::of(&path, scene) {
            State::Done if is_settled(&path, keep)? => Stage::Done,
            State::Done => Stage::Ended,
            State::Other => bail!("`{}` holds a run of another scene: move it away", shown(&path)),
            State::New | State::Begun => Stage::Due,
        })
    }

    /// Selects the runs to be made; of runs that had ended when the program was killed only the summaries are
    /// made.
    pub(crate) fn due<'a>(
        &self,
        keep: Keep,
        wanted: impl Iterator<Item = Wanted<'a>>,
        interrupt: &Interrupt,
    ) -> Result<Vec<Due>> {
        let mut due = Vec::new();
        // Equal scenes are run once.
        let mut seen = HashSet::new();
        for wanted in wanted {
            let Ok(scene) = wanted.scene else { continue };
            match self.stage(keep, wanted)? {
                Stage::Due if seen.insert(self.run(scene)) => {
                    due.push(Due::new(wanted.number, scene.clone(), self.run(scene)));
                }
                // Remains of a kill; removing them may free the space that others need.
                Stage::Ended if !interrupt.is_pressed() => {
                    let Err(why) = settle(&self.run(scene), keep) else { continue };
                    let is_damaged = is_damaged(&why);
                    if is_damaged && seen.insert(self.run(scene)) {
                        let folder = self.run(scene);
                        due.push(Due { anew: true, ..Due::new(wanted.number, scene.clone(), folder) });
                    } else if !is_damaged {
                        caution!("{why:#}");
                    }
                }
                _ => {}
            }
        }
        Ok(due)
    }

    /// Runs those of `scenes` that are not at their end; `say` is called first with their number.
    pub(crate) fn make_all<'a>(
        &self,
        keep: Keep,
        scenes: impl Iterator<Item = &'a Scene>,
        (share, interrupt): (Share, &Interrupt),
        say: &dyn Fn(usize, Jobs),
    ) -> Result<()> {
        let wanted = scenes.enumerate().map(|(at, scene)| Wanted { number: at + 1, scene: Ok(scene) });
        let due = self.due(keep, wanted, interrupt)?;
        let left = self.make(keep, &due, share, interrupt, &|jobs| say(due.len(), jobs));
        ensure!(!interrupt.is_pressed(), Interrupted);
        if let Some(why) = left.refused {
            bail!(why);
        }
        ensure!(left.elsewhere == 0, "{} runs are being run by another program: wait for it", left.elsewhere);
        Ok(())
    }

    /// Runs the outstanding runs. `say` is called first with the number of simultaneous ones.
    pub(crate) fn make(
        &self,
        keep: Keep,
        due: &[Due],
        share: Share,
        interrupt: &Interrupt,
        say: &dyn Fn(Jobs),
    ) -> Left {
        let limit_gb = share.memory_gb.or_else(memory::free_gb).unwrap_or(f64::INFINITY);
        let need_gb = due.iter().map(|due| memory::need_gb(&due.scene)).fold(0.0, f64::max);
        if need_gb > limit_gb {
            caution!("a run may take {need_gb:.1} GB, and there are {limit_gb:.1} GB for it");
        }
        let fitting = ((limit_gb / need_gb) as usize).max(1);
        let jobs = Jobs::of(share.jobs, share.threads, due.len().min(fitting));
        say(jobs);
        Shop::new("run", due, jobs, interrupt).run(&|shop, due, error| {
            let kept = match error {
                Some(error) => self.keep_failure(&due.scene, &error.to_string()),
                // Each job makes the summary of its own run; the tables only collect them.
                None if matches!(State::of(&due.folder, &due.scene), State::Done) => {
                    settle(&due.folder, keep)
                }
                None => Ok(()),
            };
            if let Err(why) = kept {
                shop.warn(&why.to_string());
            }
        })
    }
}

/// Whether the files of a run that has ended are damaged, so that it has no numbers.
fn is_damaged(error: &anyhow::Error) -> bool {
    use Error::{Mesh, RunInfo, Trace};
    let of_store = match error.downcast_ref::<stribeck_analysis::Error>() {
        Some(stribeck_analysis::Error::Run(error)) => Some(error),
        _ => error.downcast_ref::<Error>(),
    };
    matches!(of_store, Some(Trace { .. } | Mesh { .. } | RunInfo { .. }))
}

/// Whether a finished run has its numbers and only the files that are to be kept. Where all is kept,
/// numbers can be made at any time.
fn is_settled(path: &Path, keep: Keep) -> Result<bool> {
    let dir = RunDir::open(path)?;
    Ok(keep == Keep::All || dir.summary().exists() && dir.keeps_only(keep))
}

/// Makes the summary of a finished run, and removes the files that are not kept.
fn settle(path: &Path, keep: Keep) -> Result<()> {
    // No other process reads the removed files.
    let dir = match RunDir::reopen(path) {
        Err(Error::FolderInUse { .. }) => return Ok(()),
        dir => dir?,
    };
    if dir.read_info()?.status == Status::Complete {
        crate::machine::keep(&dir)?;
    }
    if read_summary(&dir).is_none() {
        write_summary(&dir)?;
    }
    Ok(dir.keep_only(keep)?)
}

/// The summary of a run that has come to its end; it is made when it is not there.
pub(crate) fn summary_of(path: &Path) -> Result<serde_json::Value> {
    if let Some(there) = read_summary(&RunDir::open(path)?) {
        return Ok(there);
    }
    match RunDir::reopen(path) {
        // Another part makes the same one.
        Err(Error::FolderInUse { .. }) => Ok(serde_json::from_str(&summarise(path)?)?),
        dir => write_summary(&dir?),
    }
}

fn read_summary(dir: &RunDir) -> Option<serde_json::Value> {
    serde_json::from_slice(&std::fs::read(dir.summary()).ok()?).ok()
}

/// Makes the summary of a run whose folder is locked, so that nothing stays beside it when this one is
/// killed: the next one writes by the same name.
fn write_summary(dir: &RunDir) -> Result<serde_json::Value> {
    let text = summarise(dir.path())?;
    write_atomic(&dir.summary(), text.as_bytes())?;
    Ok(serde_json::from_str(&text)?)
}

fn summarise(path: &Path) -> Result<String> {
    let findings = Findings::of(&Record::new(&Run::read(path)?)?)?;
    Ok(serde_json::to_string_pretty(&findings.summary)? + "\n")
}
