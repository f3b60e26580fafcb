//! The folder of an ensemble: `scene.ron`, `ensemble.json`, and one folder for each start, which holds a run.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::{ENSEMBLE, RunDir, SCENE, files, is_run, replacement, reservation::Reservation, write_atomic};
use crate::error::Error;
use crate::run_info::Status;
use serde::{Deserialize, Serialize};
use stribeck_scene::ensemble::folder_name;
use stribeck_scene::scene::Scene;

/// Contents of `ensemble.json`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ensemble {
    /// Version of the program.
    pub version: String,
    /// Commit it was built from, `unknown` outside a checkout.
    pub commit: String,
    /// Hash of the scene that all starts have in common ([`Scene::hash`]).
    pub scene_hash: String,
    /// Seed of the draws.
    pub seed: u64,
    /// Number of starts requested; they are numbered from 1.
    pub starts: usize,
    /// Starts that could not be run, by number, and why. One that diverged is recorded in its own `run.json`.
    pub failed: BTreeMap<usize, String>,
}

/// How far the run of a scene has come in a folder.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum State {
    /// Nothing there that could be continued.
    New,
    /// Ended early, or shorter than wanted; can be continued.
    Begun,
    /// At its end, or diverged.
    Done,
    /// The folder holds samples of another scene.
    Other,
}

impl RunDir {
    /// Whether the folder holds an ensemble, or remains of one.
    pub fn is_ensemble(path: impl AsRef<Path>) -> bool {
        path.as_ref().join(ENSEMBLE).is_file()
    }

    /// Removes the files of a run without samples and writes `scene.ron` and `ensemble.json` of an ensemble.
    ///
    /// # Errors
    ///
    /// [`Error::Io`] when a file cannot be removed or written.
    pub fn start_ensemble(&self, scene: &Scene, ensemble: &Ensemble) -> Result<(), Error> {
        self.begin()?;
        self.write_ensemble(scene, ensemble)
    }

    /// Removes what was made from the samples of an ensemble whose starts go on, and writes its files.
    ///
    /// # Errors
    ///
    /// As [`RunDir::start_ensemble`].
    pub fn go_on_ensemble(&self, scene: &Scene, ensemble: &Ensemble) -> Result<(), Error> {
        files::remove_derived(&self.path)?;
        self.write_ensemble(scene, ensemble)
    }

    /// Replaces `scene.ron` and `ensemble.json`, each whole or not at all.
    ///
    /// # Errors
    ///
    /// [`Error::Io`] when the disk refuses; the earlier files are then still there.
    pub fn write_ensemble(&self, scene: &Scene, ensemble: &Ensemble) -> Result<(), Error> {
        self.reservation.start();
        write_atomic(&self.scene(), scene.to_ron().as_bytes())?;
        let path = self.path.join(ENSEMBLE);
        let mut text = serde_json::to_vec_pretty(ensemble)
            .map_err(|source| Error::RunInfo { path: path.clone(), source })?;
        text.push(b'\n');
        write_atomic(&path, &text)
    }

    /// Reads the scene and `ensemble.json`.
    ///
    /// # Errors
    ///
    /// [`Error::Io`] or [`Error::Scene`] when one of them cannot be read, [`Error::RunInfo`] when it cannot
    /// be understood, [`Error::OtherScene`] when the scene was changed.
    pub fn read_ensemble(&self) -> Result<(Scene, Ensemble), Error> {
        let ensemble: Ensemble = files::read_json(&self.path.join(ENSEMBLE))?;
        let scene = Scene::read(self.scene())?;
        let (found, expected) = (scene.hash(), ensemble.scene_hash.clone());
        if found != expected {
            return Err(Error::OtherScene { path: self.path.clone(), found, expected });
        }
        Ok((scene, ensemble))
    }

    /// Opens the folder of an ensemble for reading. Its starts may still be running.
    ///
    /// # Errors
    ///
    /// [`Error::NotARun`] when `scene.ron` or `ensemble.json` is missing.
    pub fn open_ensemble(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        is_run(path, &[SCENE, ENSEMBLE])?;
        Ok(Self { path: path.to_owned(), reservation: Reservation::of_reader(path), replaces: None })
    }

    /// Reserves the folder of an ensemble, to continue it.
    ///
    /// # Errors
    ///
    /// As [`RunDir::open_ensemble`]; [`Error::FolderInUse`] when it is still going; [`Error::Io`] when the
    /// folder cannot be written.
    pub fn reopen_ensemble(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        is_run(path, &[SCENE, ENSEMBLE])?;
        let reservation = Reservation::of_run(path)?;
        reservation.sign()?;
        Ok(Self { path: path.to_owned(), reservation, replaces: replacement::marked(path) })
    }

    /// Folder of start `number`, from 1; it need not exist.
    pub fn start_folder(&self, number: usize) -> PathBuf {
        self.path.join(folder_name(number))
    }

    /// Reserves a folder for a new run, whatever run lies there: it is removed when the new one takes its
    /// first step.
    ///
    /// # Errors
    ///
    /// As [`RunDir::create`], for other reasons than a run.
    pub fn create_over(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref().to_owned();
        let reservation = Reservation::new(&path)?;
        reservation.sign()?;
        Ok(Self { path, reservation, replaces: None })
    }
}

impl State {
    /// Of the run of `scene` in `folder`, whatever its name and duration.
    pub fn of(folder: &Path, scene: &Scene) -> Self {
        let Ok(dir) = RunDir::open(folder) else { return Self::New };
        let (Ok(info), Ok(mut there)) = (dir.read_info(), Scene::read(dir.scene())) else { return Self::New };
        let duration_ms = std::mem::replace(&mut there.solver.duration_ms, scene.solver.duration_ms);
        there.name.clone_from(&scene.name);
        let shorter = duration_ms < scene.solver.duration_ms;
        let can_go_on = dir.checkpoint().exists();
        match info.status {
            _ if there != *scene => Self::Other,
            Status::Diverged => Self::Done,
            Status::Complete if !shorter => Self::Done,
            _ if can_go_on => Self::Begun,
            _ => Self::New,
        }
    }
}
