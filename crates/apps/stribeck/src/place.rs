//! Paths of scenes and runs, and the name of the program.

use std::path::{Component, Path, PathBuf};
use std::time::SystemTime;

use anyhow::{Result, anyhow, bail};
use stribeck_scene::advice::doubts_of_material;
use stribeck_scene::catalogue;
use stribeck_scene::scene::Scene;
use stribeck_scene::scene_file::{Replaced, refused_at, replaced_by_bearing};
use stribeck_simulation::{Error, bearing::own_mesh};

use crate::out::{alert, caution, detail};

/// The variable by which `cargo xtask` says, when it hands a command on, which repository it is in.
pub const REPOSITORY: &str = "STRIBECK_REPOSITORY";

/// The surroundings of a command.
#[derive(Debug, Clone)]
pub struct Place {
    /// The program's name as the user types it before a command.
    pub program: &'static str,
    root: PathBuf,
}

impl Place {
    /// `stribeck` in the working folder: runs go to `runs/` below it.
    pub fn here() -> Self {
        Self { program: "stribeck", root: PathBuf::new() }
    }

    /// `program` in a repository: scenes and runs are found below `root` from whatever folder it was called.
    pub fn repository(program: &'static str, root: PathBuf) -> Self {
        Self { program, root }
    }

    /// The scene in a file under `overrides`; without a file the paper's run.
    pub fn scene(&self, file: Option<&Path>, overrides: &[String]) -> Result<Scene> {
        let scene = self.scene_quietly(file, overrides)?;
        if let Some(file) = file.map(|file| self.locate(file)) {
            detail!("scene `{}`", shown(&file));
            Self::say_replaced(&file, &replaced_by_bearing(&file, overrides));
        }
        Self::say_assumed(&scene);
        doubts_of_material(&scene).iter().for_each(|doubt| caution!("{doubt}"));
        Ok(scene)
    }

    /// As [`Place::scene`], without messages on replaced fields or assumed dimensions, to read a scene many
    /// times.
    pub fn scene_quietly(&self, file: Option<&Path>, overrides: &[String]) -> Result<Scene> {
        let file = file.map(|file| self.locate(file));
        let scene = match &file {
            Some(file) => Scene::read_with(file, overrides)?,
            None => Scene::singh2014().with_overrides(overrides)?,
        };
        Self::with_sound_meshes(scene, file.as_deref(), overrides)
    }

    /// Prints the fields of a scene file that another bearing replaces.
    fn say_replaced(file: &Path, replaced: &[Replaced]) {
        if replaced.is_empty() {
            return;
        }
        let told = replaced
            .iter()
            .map(|Replaced { field, written, now }| format!("`{field}` {now} instead of {written}"));
        let told = told.collect::<Vec<_>>().join(", ");
        caution!(
            "with another bearing than that of `{}` its surroundings change: {told}. Give with \
             --set what is to stay",
            file.display()
        );
    }

    /// Prints the assumed dimensions of the scene's bearing. For one of the catalogue they are in the report.
    pub(crate) fn say_assumed(scene: &Scene) {
        let own = Some(&scene.bearing).filter(|bearing| !bearing.assumed.is_empty());
        for note in own.into_iter().flat_map(catalogue::assumptions) {
            alert!("note: {note}");
        }
    }

    /// The scene that fields are without a file around them: the defaults under `overrides`.
    pub fn scene_of_fields(&self, overrides: &[String]) -> Result<Scene> {
        let scene = Self::with_sound_meshes(Scene::default().with_overrides(overrides)?, None, overrides)?;
        Self::say_assumed(&scene);
        Ok(scene)
    }

    /// A scene whose meshes can be read, before a folder is made for it.
    fn with_sound_meshes(scene: Scene, file: Option<&Path>, overrides: &[String]) -> Result<Scene> {
        own_mesh::check(&scene.resolve()).map_err(|error| match error {
            Error::MeshFile { ref field, .. } => {
                anyhow!(refused_at(file, overrides, field, error.to_string()))
            }
            other => anyhow!(other),
        })?;
        Ok(scene)
    }

    /// The folder of all runs.
    pub fn runs(&self) -> PathBuf {
        self.root.join("runs")
    }

    /// `path` as the user wrote it when that exists, else the same path below the root.
    pub fn locate(&self, path: &Path) -> PathBuf {
        let below_root = self.root.join(path);
        if !path.exists() && below_root.exists() { below_root } else { path.to_owned() }
    }

    /// Refuses the file of a scene where a run or a record is asked for.
    #[cfg(feature = "full")]
    pub(crate) fn refuse_scene(&self, path: &Path) -> Result<()> {
        anyhow::ensure!(
            path.extension().is_none_or(|end| end != "ron") || !path.is_file(),
            "`{0}` is a scene, and no run of it: `{1} simulate {0}` makes one, which has its name",
            path.display(),
            self.program
        );
        Ok(())
    }

    /// The folder of a run, given as a path, by its name below `runs/`, or by the scene file of that name.
    pub fn locate_run(&self, run: &Path) -> PathBuf {
        let of_scene = self.runs().join(run.file_stem().unwrap_or_default());
        if run.extension().is_some_and(|end| end == "ron") && run.is_file() && of_scene.is_dir() {
            return of_scene;
        }
        let by_name = self.runs().join(run);
        // A folder of the same name beside `runs/` hides a run only where it is one itself.
        let is_name = matches!(run.components().collect::<Vec<_>>().as_slice(), [Component::Normal(_)]);
        let hides =
            run.is_file() || ["scene.ron", "ensemble.json"].iter().any(|mark| run.join(mark).exists());
        if by_name.is_dir() && (!run.exists() || is_name && !hides) { by_name } else { self.locate(run) }
    }

    /// The run or ensemble below `runs/` whose `run.json` or `ensemble.json` was written last.
    pub fn newest_run(&self) -> Result<PathBuf> {
        self.newest(&["run.json", "ensemble.json"])
    }

    /// The newest run below `runs/` that is one of its own; where there are ensembles alone, the newest of
    /// those.
    pub fn newest_single_run(&self) -> Result<PathBuf> {
        self.newest(&["run.json"]).or_else(|_| self.newest_run())
    }

    /// The folder below `runs/` in which one of these files was written last.
    fn newest(&self, files: &[&str]) -> Result<PathBuf> {
        let folder = self.runs();
        let advice = format!("start one with `{} simulate`, or name a run's folder", self.program);
        // A folder that is not there yet holds none.
        let entries = std::fs::read_dir(&folder).into_iter().flatten();
        let written = |path: &Path| -> Option<SystemTime> {
            files.iter().filter_map(|name| path.join(name).metadata().ok()?.modified().ok()).max()
        };
        // A plan that was killed may have left its trial run.
        let entries = entries.flatten().filter(|entry| !entry.file_name().to_string_lossy().starts_with('.'));
        let runs = entries.filter_map(|entry| Some((written(&entry.path())?, entry.path())));
        match runs.max() {
            Some((_, path)) => Ok(path),
            None => bail!("no runs in `{}`: {advice}", folder.display()),
        }
    }
}

/// `path` relative to the current folder when it lies below it: shorter to read and to copy.
pub fn shown(path: &Path) -> String {
    let below =
        std::env::current_dir().ok().and_then(|here| path.strip_prefix(here).ok().map(Path::to_owned));
    below.unwrap_or_else(|| path.to_owned()).display().to_string()
}
