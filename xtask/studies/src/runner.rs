//! Runs the variants of a study, each once.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use anyhow::{Context, Result};
use serde_json::{Value, json};
use stribeck_analysis::findings::Findings;
use stribeck_analysis::record::Record;
use stribeck_analysis::summary::Summary;
use stribeck_scene::resolved::ResolvedScene;
use stribeck_scene::scene::Scene;
use stribeck_store::run_dir::{Run, RunDir};
use stribeck_store::run_info::{RunInfo, Status, clock};

use crate::Host;
use crate::host::Job;

/// Flags of every study that runs scenes.
#[derive(Debug, Clone, clap::Args)]
pub struct Flags {
    /// Worker threads [default: all cores]; the results do not depend on it
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Runs this many variants at a time, each on one thread, for machines with many cores
    #[arg(long, value_name = "N", conflicts_with = "threads", default_value_t = 1,
        value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: u16,
    /// Runs only variants whose name contains this; may be repeated. The others are shown when they have been
    /// run
    #[arg(long, value_name = "TEXT")]
    only: Vec<String>,
    /// Runs nothing: makes the tables from finished runs
    #[arg(long)]
    tables_only: bool,
}

impl Flags {
    pub(crate) fn wants(&self, name: &str) -> bool {
        self.only.is_empty() || self.only.iter().any(|text| name.contains(text.as_str()))
    }

    /// Whether tables alone are wanted.
    pub(crate) fn runs_nothing(&self) -> bool {
        self.tables_only
    }

    /// The same for a command that runs several scenes itself, side by side unless a flag forbids it.
    pub(crate) fn of_a_command(&self) -> Vec<String> {
        let jobs = if self.jobs > 1 { Some(format!("--jobs={}", self.jobs)) } else { None };
        let threads = self.threads.or((self.jobs > 1).then_some(self.jobs)).map(|n| format!("--threads={n}"));
        jobs.into_iter().chain(threads).collect()
    }
}

/// A scene with overrides.
#[derive(Debug, Clone)]
pub(crate) struct Variant {
    /// Its name in the table; its folder is called alike.
    pub(crate) name: String,
    /// Scene file, below the repository's root.
    pub(crate) scene: String,
    /// Overrides, as `--set` takes them.
    pub(crate) set: Vec<String>,
}

/// A variant that has been run, or could not be.
#[derive(Debug)]
pub(crate) struct Finished {
    pub(crate) variant: Variant,
    pub(crate) folder: PathBuf,
    /// The scene that it stands for, in SI.
    pub(crate) scene: ResolvedScene,
    /// The same in the units of its file.
    pub(crate) written: Scene,
    /// Its numbers, or why there are none.
    pub(crate) summary: Result<Summary, String>,
    /// `run.json` of its run.
    pub(crate) info: Option<RunInfo>,
}

/// Runs variants into `runs/study/STUDY`.
pub(crate) struct Runner<'a> {
    pub(crate) study: &'static str,
    pub(crate) folder: PathBuf,
    pub(crate) flags: Flags,
    pub(crate) host: &'a Host,
}

impl Variant {
    /// A variant of `scene` under the overrides `set`.
    pub(crate) fn new(name: impl Into<String>, scene: &str, set: &[&str]) -> Self {
        Self {
            name: name.into(),
            scene: scene.to_owned(),
            set: set.iter().map(|s| (*s).to_owned()).collect(),
        }
    }

    /// The same with one override more.
    pub(crate) fn with(mut self, set: impl Into<String>) -> Self {
        self.set.push(set.into());
        self
    }

    fn scene(&self, root: &Path) -> Result<Scene> {
        let file = root.join(&self.scene);
        let mut scene = Scene::read_with(&file, &self.set)
            .with_context(|| format!("variant `{}` is not a scene", self.name))?;
        scene.name = scene_name(&self.name);
        Ok(scene)
    }
}

/// The name of a variant without the signs that a scene's name may not have.
pub(crate) fn scene_name(variant: &str) -> String {
    let kept = variant.replace(|c: char| !c.is_ascii_alphanumeric() && c != '_', "-");
    kept.trim_start_matches(['-', '_']).to_owned()
}

impl Finished {
    /// The numbers of a complete run.
    pub(crate) fn numbers(&self) -> Option<&Summary> {
        self.summary.as_ref().ok()
    }

    /// All of its samples.
    pub(crate) fn trace(&self) -> Option<Run> {
        self.numbers()?;
        Run::read(&self.folder).ok()
    }

    /// Summary, `run.json` and scene as one tree.
    pub(crate) fn tree(&self) -> Value {
        json!({"summary": self.numbers(), "info": self.info, "scene": stribeck_scene::fields::to_json(&self.written)})
    }
}

impl<'a> Runner<'a> {
    pub(crate) fn new(study: &'static str, flags: &Flags, host: &'a Host) -> Self {
        Self { study, folder: host.root().join("runs/study").join(study), flags: flags.clone(), host }
    }

    /// Runs every variant that has not been run and returns all that have been, in their order. A variant
    /// that fails has its reason in the table and does not end the study.
    pub(crate) fn run(&self, variants: &[Variant]) -> Result<Vec<Finished>> {
        let planned: Vec<Planned> =
            variants.iter().map(|variant| self.plan(variant)).collect::<Result<_>>()?;
        let jobs = usize::from(self.flags.jobs);
        let due: Vec<(usize, &Planned)> = planned.iter().enumerate().filter(|(_, p)| p.due).collect();
        self.host.each(&due, jobs, |(number, planned)| {
            self.host.say(&format!("{} of {}: {}", number + 1, variants.len(), planned.variant.name));
            if let Err(error) = self.run_one(planned) {
                self.host.say(&format!("{}: {error:#}", planned.variant.name));
                let _ = planned.failed.set(format!("{error:#}"));
            }
        })?;
        let shown: Vec<&Planned> = planned.iter().filter(|p| p.due || p.state == State::Done).collect();
        self.host.each(&shown, jobs, |planned| finished(planned))
    }

    /// Work to be done for a variant.
    fn plan(&self, variant: &Variant) -> Result<Planned> {
        let flags = &self.flags;
        let scene = variant.scene(self.host.root())?;
        // Names are words of the table; folders have none of the signs that a file system may refuse.
        let folder = self.folder.join(variant.name.replace(|c: char| !c.is_alphanumeric() && c != '_', "-"));
        let state = state_of(&folder, &scene);
        let due = state != State::Done && flags.wants(&variant.name) && !flags.tables_only;
        Ok(Planned { variant: variant.clone(), scene, folder, state, due, failed: OnceLock::new() })
    }

    fn run_one(&self, planned: &Planned) -> Result<()> {
        let alone = self.flags.jobs == 1;
        let threads = if alone { self.flags.threads.map(usize::from) } else { Some(1) };
        let begun = planned.state == State::Begun;
        let Planned { scene, folder, .. } = planned;
        if planned.state == State::New {
            // A run of another scene, from before the study was changed.
            std::fs::remove_dir_all(folder).ok();
        }
        let info = self.host.run(&Job { scene, folder, begun, threads, alone })?;
        let (name, seconds) = (&planned.variant.name, clock(info.wall_s + info.setup_s));
        self.host.say(&format!("  {name}: {:?} after {seconds}", info.status));
        Ok(())
    }
}

/// A variant and the work to be done for it.
struct Planned {
    variant: Variant,
    scene: Scene,
    folder: PathBuf,
    state: State,
    /// Whether it is to be run.
    due: bool,
    /// Why it could not be.
    failed: OnceLock<String>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum State {
    /// Not run, or run from another scene.
    New,
    /// Ended early; can be continued.
    Begun,
    /// At its end, or diverged.
    Done,
}

fn state_of(folder: &Path, scene: &Scene) -> State {
    let Ok(run) = RunDir::open(folder).and_then(|dir| dir.read_info().map(|info| (dir, info))) else {
        return State::New;
    };
    let (dir, info) = run;
    match info.status {
        _ if info.scene_hash != scene.hash() => State::New,
        Status::Complete | Status::Diverged => State::Done,
        Status::Running | Status::Interrupted if dir.checkpoint().exists() => State::Begun,
        _ => State::New,
    }
}

/// Analyses a run again, so that a table is never older than the analysis.
fn finished(planned: &Planned) -> Finished {
    let Planned { variant, folder, scene, failed, .. } = planned;
    let run = match failed.get() {
        Some(why) => Err(why.clone()),
        None => Run::read(folder).map_err(|error| error.to_string()),
    };
    let info = run.as_ref().ok().map(|run| run.info.clone());
    let summary = run.and_then(|run| match run.info.status {
        Status::Complete => {
            let findings = Record::new(&run).and_then(|record| Findings::of(&record));
            findings.map(|f| f.summary).map_err(|error| error.to_string())
        }
        _ => Err(run.info.stop_reason.unwrap_or_else(|| "did not complete".to_owned())),
    });
    Finished {
        variant: variant.clone(),
        folder: folder.clone(),
        scene: scene.resolve(),
        written: scene.clone(),
        summary,
        info,
    }
}
