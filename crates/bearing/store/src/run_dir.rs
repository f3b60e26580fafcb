//! The folder of one run: its lock, its files, and how it is read again.
//!
//! ```text
//! runs/x/  scene.ron  run.json  trace.npy  energy.npy  mesh.vtu  checkpoint  frames/   written by the run
//!          report.html  report.pdf  lab.html  summary.json  figures/                   written by the report
//!          machine.npy                                  what the sensor of a scene's machine records of it
//!          .lock                                                                       held while the run writes
//! ```
//!
//! An ensemble of many starts has `ensemble.json` and a folder for each start, `start-001`, `start-002` …,
//! which is the folder of a run, in place of `run.json` and the files of a run.
//!
//! A run is never written over another one that holds samples: [`RunDir::create`] refuses such a folder,
//! [`RunDir::create_numbered`] takes the next free one, and [`RunDir::replace`] keeps the earlier run until
//! the new one is complete. Results that other commands make from runs never go into the folder of a run
//! ([`check_folder`]).
//!
//! A run is planned, running, complete and reported ([`Stage`]). `summary.json` is the last file of a report,
//! and its mark.
//!
//! The checkpoint is there from the first step of a run on. After a kill the folder can be read, and
//! continued from the last checkpoint: traces never hold fewer samples than it counts. A complete run keeps
//! its last one, so that it can be made longer.

mod earlier;
mod ensemble;
mod files;
mod kept;
mod product;
mod replacement;
mod reservation;
mod run;
mod stage;

use std::path::{Path, PathBuf};

use crate::error::Error;
use crate::run_info::{RunInfo, Status};
use stribeck_scene::scene::Scene;

use earlier::Earlier;
pub use ensemble::{Ensemble, State};
pub use files::{write_atomic, write_whole};
pub use kept::{Keep, SENSOR};
pub use product::check_folder;
pub use reservation::Reservation;
pub use run::Run;
pub use stage::Stage;

const SCENE: &str = "scene.ron";
const INFO: &str = "run.json";
const ENSEMBLE: &str = "ensemble.json";
const TRACE: &str = "trace.npy";
const SIGNALS: &str = "signals.npy";
const MACHINE: &str = "machine.npy";
const ENERGY: &str = "energy.npy";
const MESH: &str = "mesh.vtu";
const CHECKPOINT: &str = "checkpoint";
const REPORT: &str = "report.html";
const SUMMARY: &str = "summary.json";
const PDF: &str = "report.pdf";
/// The page in which the bearing of a run runs (`stribeck report --lab`).
pub const LAB: &str = "lab.html";
const FIGURES: &str = "figures";
const FRAMES: &str = "frames";
const LOCK: &str = ".lock";
/// Suffix of a file while it is written; it is then renamed over the target, so that a reader sees the old
/// file or the new one, never a part. Before it stands the process that writes it, where several may.
const PARTIAL: &str = ".part";

/// Every file that a run or its report writes, in the order of removal: without `run.json` a folder is no
/// run, so it is removed first, and a half removed run is not taken for a result.
const FILES: [&str; 13] =
    [INFO, ENSEMBLE, REPORT, PDF, LAB, SUMMARY, TRACE, SIGNALS, MACHINE, ENERGY, MESH, CHECKPOINT, SCENE];

/// What is made from the samples of a run: it goes when the run goes on, so that none is older than its run.
const DERIVED: [&str; 6] = [REPORT, PDF, LAB, SUMMARY, SIGNALS, MACHINE];

/// Folders that a run or its report fills, and their files; GIFs stand in runs of earlier versions, which are removed, too.
const FOLDERS: [(&str, &[&str]); 2] = [(FIGURES, &["svg", "png", "gif"]), (FRAMES, &["npy"])];

const UNTOUCHED: &str = "Nothing was changed; choose a folder that can be written with --out";

/// More runs of one name are something else than an experiment.
const MOST_NUMBERS: usize = 100_000;

/// The folder of one run. While it is being written, an operating-system lock keeps every other run out of
/// it; the lock dies with its process, so a killed run never blocks the next one.
#[derive(Debug)]
pub struct RunDir {
    path: PathBuf,
    reservation: Reservation,
    /// The run whose place it takes when it is complete.
    replaces: Option<PathBuf>,
}

impl RunDir {
    /// Reserves the folder at `path` for a new run, making it when it is missing. Files of a run that never
    /// took a sample stay untouched until [`RunDir::start`].
    ///
    /// # Errors
    ///
    /// [`Error::FolderHoldsRun`] when an earlier run left samples there; [`Error::ForeignFolder`] when it
    /// holds something other than a run; [`Error::FolderInUse`] when another run writes it; [`Error::Io`]
    /// when it cannot be written.
    pub fn create(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref().to_owned();
        let reservation = Reservation::new(&path)?;
        if let Some(earlier) = Earlier::of(&path) {
            let mut ways: Vec<String> = earlier.way_on(&path).into_iter().collect();
            ways.push("replace it with --overwrite once the new run is complete".to_owned());
            let free = free_name(&path);
            return Err(Error::FolderHoldsRun { path, found: earlier.name(), ways, free });
        }
        reservation.sign()?;
        Ok(Self { path, reservation, replaces: None })
    }

    /// As [`RunDir::create`], but where there is a run already takes the first free folder of `path-2`,
    /// `path-3` ….
    ///
    /// # Errors
    ///
    /// As [`RunDir::create`], for other reasons than a run.
    pub fn create_numbered(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        let mut number = 1;
        loop {
            match Self::create(numbered(path, number)) {
                // The first name is the user's own; a numbered one is only a proposal.
                Err(Error::FolderHoldsRun { .. } | Error::FolderInUse { .. }) if number < MOST_NUMBERS => {}
                Err(Error::ForeignFolder { .. }) if (2..MOST_NUMBERS).contains(&number) => {}
                done => return done,
            }
            number += 1;
        }
    }

    /// Reserves a folder for a new run that takes the place of the one at `path` when it is complete
    /// ([`RunDir::take_place`]); until then it lies beside it, in `path.new`. Where there is nothing to keep,
    /// the folder at `path` itself.
    ///
    /// # Errors
    ///
    /// As [`RunDir::create`], for `path.new`.
    pub fn replace(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        match Self::create(path) {
            Err(Error::FolderHoldsRun { .. }) => {}
            done => return done,
        }
        let old = path.canonicalize().map_err(|e| files::cannot("read", path, UNTOUCHED, e))?;
        let new = replacement::beside(&old);
        match Self::create(&new) {
            Ok(dir) => Ok(Self { replaces: Some(old), ..dir }),
            Err(Error::FolderHoldsRun { path: new, found, free, .. }) => {
                let found = format!("{found} and was to replace `{}`", path.display());
                let way_on = Earlier::of(&new).and_then(|earlier| earlier.way_on(&new));
                let ways = way_on.into_iter().chain(["remove it".to_owned()]).collect();
                Err(Error::FolderHoldsRun { path: new, found, ways, free })
            }
            Err(other) => Err(other),
        }
    }

    /// Moves a complete run to the place of the one that it replaces ([`RunDir::replace`]), also after it was
    /// continued. Files that the owner added to the earlier folder stay there. Nothing happens to other runs.
    ///
    /// # Errors
    ///
    /// [`Error::FolderInUse`] when another process writes the earlier run, [`Error::Io`] when the system
    /// refuses: both runs are then still there.
    pub fn take_place(mut self) -> Result<Self, Error> {
        if let Some(old) = self.replaces.take() {
            replacement::swap(&self.path, &old)?;
            self.path = old;
        }
        Ok(self)
    }

    /// The run whose place this one takes when it is complete.
    pub fn replaces(&self) -> Option<&Path> {
        self.replaces.as_deref()
    }

    /// The reservation of the folder until the run starts.
    pub fn reservation(&self) -> Reservation {
        self.reservation.clone()
    }

    /// Removes the files of a run without samples and writes `scene.ron` and `run.json` of this one.
    ///
    /// Call it when mesh and preload have succeeded and the time loop is about to begin.
    ///
    /// # Errors
    ///
    /// [`Error::Io`] when a file cannot be removed or written.
    pub fn start(&self, scene: &Scene, info: &RunInfo) -> Result<(), Error> {
        self.begin()?;
        write_atomic(&self.scene(), scene.to_ron().as_bytes())?;
        self.write_info(info)
    }

    /// From here on the folder is that of this run: files of an earlier one are removed.
    fn begin(&self) -> Result<(), Error> {
        self.reservation.start();
        files::remove_run(&self.path)?;
        self.replaces.as_deref().map_or(Ok(()), |old| replacement::mark(&self.path, old))
    }

    /// Writes `scene.ron` and `run.json` of a continued run, whose duration may be longer than before. What was
    /// made from its samples until then is removed.
    ///
    /// Call it when the state of the checkpoint is restored and the time loop is about to begin.
    pub fn go_on(&self, scene: &Scene, info: &RunInfo) -> Result<(), Error> {
        self.reservation.start();
        files::remove_partial(&self.path)?;
        files::remove_derived(&self.path)?;
        // The scene first: with it and the checkpoint alone a run can be continued.
        let text = scene.to_ron();
        if std::fs::read(self.scene()).ok().as_deref() != Some(text.as_bytes()) {
            write_atomic(&self.scene(), text.as_bytes())?;
        }
        self.write_info(info)
    }

    /// Replaces `run.json`, whole or not at all.
    ///
    /// # Errors
    ///
    /// [`Error::Io`] when the disk refuses; the earlier `run.json` is then still there.
    pub fn write_info(&self, info: &RunInfo) -> Result<(), Error> {
        if info.status != Status::Running {
            // A report from before is one of a shorter run.
            files::remove(&self.summary())?;
        }
        let path = self.info();
        let mut text = serde_json::to_vec_pretty(info)
            .map_err(|source| Error::RunInfo { path: path.clone(), source })?;
        text.push(b'\n');
        write_atomic(&path, &text)
    }

    /// Takes away the mark of an earlier report, `summary.json`, which is written again when all others of its
    /// files are, and what a killed report has left of them.
    ///
    /// # Errors
    ///
    /// [`Error::Io`] when a file cannot be removed.
    pub fn begin_report(&self) -> Result<(), Error> {
        files::remove(&self.summary())?;
        files::remove_partial_report(&self.path)
    }

    /// Reserves the folder of a run, to continue it. Without a `run.json`, a checkpoint is enough.
    ///
    /// # Errors
    ///
    /// [`Error::NotARun`] when `scene.ron` or both others are missing; [`Error::FolderInUse`] when the run is
    /// still going; [`Error::Io`] when the folder cannot be written.
    pub fn reopen(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        if !path.join(CHECKPOINT).is_file() {
            is_run(path, &[SCENE, INFO])?;
        }
        is_run(path, &[SCENE])?;
        let reservation = Reservation::of_run(path)?;
        reservation.sign()?;
        Ok(Self { path: path.to_owned(), reservation, replaces: replacement::marked(path) })
    }

    /// Reads `run.json`.
    ///
    /// # Errors
    ///
    /// [`Error::Io`] when it cannot be read; [`Error::RunInfo`] when it cannot be understood.
    pub fn read_info(&self) -> Result<RunInfo, Error> {
        files::read_info(&self.info())
    }

    /// Opens the folder of an existing run for reading. It may still be running.
    ///
    /// # Errors
    ///
    /// [`Error::NotARun`] when `scene.ron` or `run.json` is missing; [`Error::Ensemble`] when it is that of
    /// many starts.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        is_run(path, &[SCENE, INFO])?;
        Ok(Self { path: path.to_owned(), reservation: Reservation::of_reader(path), replaces: None })
    }

    /// True once the time loop has begun, anew or again: the files in the folder are those of this run.
    pub fn has_started(&self) -> bool {
        self.reservation.has_started()
    }

    /// The folder itself.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The complete scene of the run.
    pub fn scene(&self) -> PathBuf {
        self.path.join(SCENE)
    }

    /// Provenance, sizes and cost.
    pub fn info(&self) -> PathBuf {
        self.path.join(INFO)
    }

    /// Sampled channels.
    pub fn trace(&self) -> PathBuf {
        self.path.join(TRACE)
    }

    /// Sampled energy ledger.
    pub fn energy(&self) -> PathBuf {
        self.path.join(ENERGY)
    }

    /// The mesh for ParaView.
    pub fn mesh(&self) -> PathBuf {
        self.path.join(MESH)
    }

    /// The state from which a run continues.
    pub fn checkpoint(&self) -> PathBuf {
        self.path.join(CHECKPOINT)
    }

    /// The report.
    pub fn report(&self) -> PathBuf {
        self.path.join(REPORT)
    }

    /// The report's numbers.
    pub fn summary(&self) -> PathBuf {
        self.path.join(SUMMARY)
    }

    /// Folder of the frames about the defect; it need not exist.
    pub fn frames(&self) -> PathBuf {
        self.path.join(FRAMES)
    }

    /// Folder of the report's pictures; it need not exist.
    pub fn figures(&self) -> PathBuf {
        self.path.join(FIGURES)
    }
}

/// Whether all of these are there.
fn is_run(path: &Path, names: &[&'static str]) -> Result<(), Error> {
    match names.iter().find(|name| !path.join(name).is_file()) {
        Some(&INFO) if RunDir::is_ensemble(path) => {
            Err(Error::Ensemble { path: path.to_owned(), starts: files::start_folders(path).len() })
        }
        Some(&INFO) if path.join(LOCK).exists() || path.join(CHECKPOINT).exists() => {
            let next = Stage::of(path).next(path).unwrap_or_default();
            Err(Error::Unfinished { path: path.to_owned(), next })
        }
        Some(missing) => Err(Error::NotARun { path: path.to_owned(), missing }),
        None => Ok(()),
    }
}

/// `path` for the first, `path-2` for the second ….
fn numbered(path: &Path, number: usize) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    match (number, name.is_empty()) {
        (0 | 1, _) | (_, true) => path.to_owned(),
        _ => {
            name.push(format!("-{number}"));
            path.with_file_name(name)
        }
    }
}

/// The first numbered folder that is not there.
fn free_name(path: &Path) -> PathBuf {
    (2..MOST_NUMBERS).map(|n| numbered(path, n)).find(|p| !p.exists()).unwrap_or_else(|| path.to_owned())
}

#[cfg(test)]
mod tests;
