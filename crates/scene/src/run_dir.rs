//! The folder of one run: who may write it, what lies in it, how it is read again.
//!
//! ```text
//! runs/x/  scene.ron  run.json  trace.npy  energy.npy  mesh.vtu  checkpoint  frames/   written by the run
//!          report.html  summary.json  figures/                                         written by the report
//!          .lock                                                                       held while the run writes
//! ```
//!
//! The checkpoint is there from the first step of a run to its end. Whatever kills the run in between, the folder can be
//! read, and continued from the last checkpoint: traces never hold fewer samples than it counts.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use crate::error::Error;
use crate::run_info::RunInfo;
use crate::scene::Scene;
use crate::trace::Trace;

const SCENE: &str = "scene.ron";
const INFO: &str = "run.json";
const TRACE: &str = "trace.npy";
const ENERGY: &str = "energy.npy";
const MESH: &str = "mesh.vtu";
const CHECKPOINT: &str = "checkpoint";
const REPORT: &str = "report.html";
const SUMMARY: &str = "summary.json";
const FIGURES: &str = "figures";
const FRAMES: &str = "frames";
const LOCK: &str = ".lock";
/// Written beside a file, then renamed over it: a reader sees the old file or the new one, never half of either.
const PARTIAL: &str = ".part";

/// Everything that a run or its report writes, in the order of removal: without `run.json` a folder is no run, so it
/// goes first and nothing half removed is taken for a result.
const FILES: [&str; 8] = [INFO, REPORT, SUMMARY, TRACE, ENERGY, MESH, CHECKPOINT, SCENE];

/// `run.json` holds a page of text and at most some thousand warnings.
const MAX_INFO_BYTES: u64 = 1 << 24;

/// The folder of one run. While it is being written, an operating-system lock keeps every other run out of it; the lock
/// dies with its process, so a killed run never blocks the next one.
#[derive(Debug)]
pub struct RunDir {
    path: PathBuf,
    /// Held by the writer of a run, `None` for readers.
    lock: Option<File>,
    /// The folder is ours to remove when the run never starts.
    made_folder: bool,
    started: std::cell::Cell<bool>,
}

impl RunDir {
    /// Reserves the folder at `path` for a new run, making it when it is missing.
    ///
    /// The files of an earlier run stay untouched until [`RunDir::start`]: a scene that fails in meshing or preload
    /// costs nobody their results.
    ///
    /// # Errors
    ///
    /// [`Error::ForeignFolder`] when it holds something other than a run; [`Error::FolderInUse`] when another run
    /// writes it; [`Error::Io`] when it cannot be written.
    pub fn create(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref().to_owned();
        let made_folder = !path.exists();
        std::fs::create_dir_all(&path).map_err(|e| cannot("create", &path, UNTOUCHED, e))?;
        if let Some(found) = foreign_file(&path)? {
            return Err(Error::ForeignFolder { path, found });
        }
        let lock = lock(&path)?;
        Ok(Self { path, lock: Some(lock), made_folder, started: false.into() })
    }

    /// Removes what an earlier run left and writes `scene.ron` and `run.json` of this one.
    ///
    /// Call it when mesh and preload have succeeded and the time loop is about to begin.
    ///
    /// # Errors
    ///
    /// [`Error::Io`] when a file cannot be removed or written.
    pub fn start(&self, scene: &Scene, info: &RunInfo) -> Result<(), Error> {
        for name in FILES {
            remove(&self.path.join(name))?;
        }
        remove_files(&self.figures(), &["svg", "png", "gif"])?;
        remove_files(&self.frames(), &["npy"])?;
        write_atomic(&self.scene(), scene.to_ron().as_bytes())?;
        self.write_info(info)?;
        self.started.set(true);
        Ok(())
    }

    /// Writes `run.json` of a run that goes on.
    ///
    /// Call it when the state of the checkpoint is restored and the time loop is about to begin.
    ///
    /// # Errors
    ///
    /// [`Error::Io`] when the disk refuses.
    pub fn go_on(&self, info: &RunInfo) -> Result<(), Error> {
        self.write_info(info)?;
        self.started.set(true);
        Ok(())
    }

    /// Replaces `run.json`, whole or not at all.
    ///
    /// # Errors
    ///
    /// [`Error::Io`] when the disk refuses; the earlier `run.json` is then still there.
    pub fn write_info(&self, info: &RunInfo) -> Result<(), Error> {
        let path = self.info();
        let mut text = serde_json::to_vec_pretty(info)
            .map_err(|source| Error::RunInfo { path: path.clone(), source })?;
        text.push(b'\n');
        write_atomic(&path, &text)
    }

    /// Reserves the folder of a run that ended early, to continue it.
    ///
    /// # Errors
    ///
    /// [`Error::NotARun`] when `scene.ron` or `run.json` is missing; [`Error::FolderInUse`] when the run is still going;
    /// [`Error::Io`] when the folder cannot be written.
    pub fn reopen(path: impl AsRef<Path>) -> Result<Self, Error> {
        let mut dir = Self::open(path)?;
        dir.lock = Some(lock(&dir.path)?);
        dir.started.set(false);
        Ok(dir)
    }

    /// Reads `run.json`.
    ///
    /// # Errors
    ///
    /// [`Error::Io`] when it cannot be read; [`Error::RunInfo`] when it cannot be understood.
    pub fn read_info(&self) -> Result<RunInfo, Error> {
        read_info(&self.info())
    }

    /// Removes the checkpoint of a run that has come to its end. One that stays does no harm: such a run is not
    /// continued.
    pub fn remove_checkpoint(&self) {
        std::fs::remove_file(self.checkpoint()).ok();
    }

    /// Opens the folder of an existing run for reading. It may still be running.
    ///
    /// # Errors
    ///
    /// [`Error::NotARun`] when `scene.ron` or `run.json` is missing.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref().to_owned();
        for missing in [SCENE, INFO] {
            if !path.join(missing).is_file() {
                return Err(Error::NotARun { path, missing });
            }
        }
        Ok(Self { path, lock: None, made_folder: false, started: true.into() })
    }

    /// True once the time loop has begun, anew or again: the files in the folder are those of this run.
    pub fn has_started(&self) -> bool {
        self.started.get()
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

impl Drop for RunDir {
    /// A folder made for a run that never started is taken away again.
    fn drop(&mut self) {
        if self.lock.is_some() && self.made_folder && !self.started.get() {
            std::fs::remove_file(self.path.join(LOCK)).ok();
            std::fs::remove_dir(&self.path).ok();
        }
    }
}

/// A run as the report sees it.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// The complete scene.
    pub scene: Scene,
    /// Provenance, sizes and cost.
    pub info: RunInfo,
    /// Sampled channels.
    pub trace: Trace,
    /// Sampled energy ledger.
    pub energy: Trace,
}

impl Run {
    /// Reads the run in the folder `path`, also one that was interrupted, killed or is still going.
    ///
    /// # Errors
    ///
    /// [`Error::NotARun`], or what is wrong with the first file that cannot be read.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, Error> {
        let dir = RunDir::open(path)?;
        Ok(Self {
            scene: Scene::read(dir.scene())?,
            info: dir.read_info()?,
            trace: Trace::read(dir.trace())?,
            energy: Trace::read(dir.energy())?,
        })
    }
}

/// Replaces the file at `path` by `bytes`, whole or not at all.
///
/// # Errors
///
/// [`Error::Io`] when the disk refuses; the earlier file, if any, is then still there.
pub fn write_atomic(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    const KEPT: &str =
        "What was there before is still there; check the free space and the permissions of the folder";
    let mut partial = path.as_os_str().to_owned();
    partial.push(PARTIAL);
    let partial = PathBuf::from(partial);
    let written = File::create(&partial).and_then(|mut file| {
        file.write_all(bytes)?;
        // The name must not reach the disk before the content.
        file.sync_data()
    });
    written.and_then(|()| std::fs::rename(&partial, path)).map_err(|e| {
        std::fs::remove_file(&partial).ok();
        cannot("write", path, KEPT, e)
    })
}

const UNTOUCHED: &str = "Nothing was changed; choose a folder that can be written with --out";

fn cannot(action: &'static str, path: &Path, kept: &str, source: std::io::Error) -> Error {
    Error::Io { action, path: path.to_owned(), kept: kept.to_owned(), source }
}

/// A file in the folder that no run writes; hidden files are nobody's business.
fn foreign_file(path: &Path) -> Result<Option<String>, Error> {
    let read = |e| cannot("read", path, UNTOUCHED, e);
    let mut names = Vec::new();
    for entry in std::fs::read_dir(path).map_err(read)? {
        names.push(entry.map_err(read)?.file_name().to_string_lossy().into_owned());
    }
    // A folder with run.json is a run, and what its owner added to it is left alone.
    if names.iter().any(|name| name == INFO || name == LOCK) {
        return Ok(None);
    }
    names.sort();
    let known = |name: &String| FILES.contains(&name.trim_end_matches(PARTIAL)) || name.starts_with('.');
    Ok(names.into_iter().find(|name| !known(name)))
}

/// Takes the lock of the folder and writes our process number into it, for the message of whoever comes second.
fn lock(path: &Path) -> Result<File, Error> {
    let name = path.join(LOCK);
    let io = |e| cannot("write", &name, UNTOUCHED, e);
    let mut file =
        OpenOptions::new().read(true).write(true).create(true).truncate(false).open(&name).map_err(io)?;
    match file.try_lock() {
        Ok(()) => {}
        Err(TryLockError::WouldBlock) => {
            let mut owner = String::new();
            (&file).take(20).read_to_string(&mut owner).ok();
            return Err(Error::FolderInUse { path: path.to_owned(), owner: owner.trim().to_owned() });
        }
        // Some network file systems know no locks; a run there is unprotected rather than impossible.
        Err(TryLockError::Error(e)) if e.kind() == std::io::ErrorKind::Unsupported => {}
        Err(TryLockError::Error(e)) => return Err(io(e)),
    }
    file.set_len(0).map_err(io)?;
    file.seek(SeekFrom::Start(0)).map_err(io)?;
    writeln!(file, "{}", std::process::id()).map_err(io)?;
    Ok(file)
}

fn remove(path: &Path) -> Result<(), Error> {
    match std::fs::remove_file(path) {
        Err(e) if e.kind() != std::io::ErrorKind::NotFound => {
            Err(cannot("remove", path, "The other files of the earlier run may already be gone", e))
        }
        _ => Ok(()),
    }
}

/// Removes what an earlier run or report left in a folder, by its extensions, and only that.
fn remove_files(folder: &Path, extensions: &[&str]) -> Result<(), Error> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Ok(()) };
    for entry in entries.flatten() {
        let path = entry.path();
        if path.extension().and_then(|e| e.to_str()).is_some_and(|e| extensions.contains(&e)) {
            remove(&path)?;
        }
    }
    Ok(())
}

fn read_info(path: &Path) -> Result<RunInfo, Error> {
    let io = |e| cannot("read", path, "Nothing was changed", e);
    let mut text = Vec::new();
    File::open(path).map_err(io)?.take(MAX_INFO_BYTES).read_to_end(&mut text).map_err(io)?;
    serde_json::from_slice(&text).map_err(|source| Error::RunInfo { path: path.to_owned(), source })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run_info::{EnergyInfo, MeshInfo, Status};
    use crate::trace::TraceWriter;

    /// A folder that is removed at the end.
    struct Scratch(PathBuf);

    impl Scratch {
        fn new(name: &str) -> Self {
            let path = std::env::temp_dir().join(format!("stribeck-run-{}-{name}", std::process::id()));
            std::fs::remove_dir_all(&path).ok();
            Self(path)
        }
    }

    impl Drop for Scratch {
        fn drop(&mut self) {
            std::fs::remove_dir_all(&self.0).ok();
        }
    }

    fn info(status: Status) -> RunInfo {
        RunInfo {
            version: "0.1.0".into(),
            commit: "unknown".into(),
            scene_hash: Scene::default().hash(),
            machine: "a machine".into(),
            threads: 2,
            status,
            stop_reason: None,
            time_step_s: 31e-9,
            critical_time_step_s: 0.1 + 0.2,
            steps: 10,
            steps_planned: 20,
            interval_s: 1e-5,
            samples: 2,
            mesh: MeshInfo {
                nodes: 4,
                quads: 1,
                triangles: 0,
                roller_facets: 112,
                outer_facets: 1257,
                inner_facets: 1030,
            },
            wall_s: 1.0,
            cpu_s: 2.0,
            setup_s: 0.5,
            energy: EnergyInfo { max_relative_error: 1e-3, peak_strain_j: 2.0 },
            guards: crate::run_info::GuardInfo::default(),
            expected_support_n: 50_100.0,
            resumed_at_s: vec![1e-5],
            warnings: vec!["one".into()],
        }
    }

    fn write_run(path: &Path) {
        let dir = RunDir::create(path).expect("free");
        dir.start(&Scene::default(), &info(Status::Running)).expect("writable");
        for file in [dir.trace(), dir.energy()] {
            let mut trace = TraceWriter::create(file, &["time_s", "x"]).expect("writable");
            trace.push(&[0.0, 1.0]).expect("writable");
        }
        dir.write_info(&info(Status::Complete)).expect("writable");
    }

    #[test]
    fn roundtrip_a_run_reads_back_equal() {
        let folder = Scratch::new("equal");
        write_run(&folder.0);
        let run = Run::read(&folder.0).expect("complete");
        assert_eq!(run.scene, Scene::default());
        assert_eq!(run.info, info(Status::Complete));
        assert_eq!(run.trace.get("x"), Some(&[1.0][..]));
        assert_eq!(run.energy.len(), 1);
    }

    #[test]
    fn survives_an_earlier_run_until_the_new_one_starts() {
        let folder = Scratch::new("earlier");
        write_run(&folder.0);
        std::fs::write(folder.0.join(REPORT), "old").expect("writable");
        std::fs::write(folder.0.join("my notes.txt"), "mine").expect("writable");
        drop(RunDir::create(&folder.0).expect("free"));
        assert!(Run::read(&folder.0).is_ok(), "a run that failed before its start destroyed the earlier one");
        let dir = RunDir::create(&folder.0).expect("free");
        assert!(!dir.has_started());
        dir.start(&Scene::default(), &info(Status::Running)).expect("writable");
        assert!(dir.has_started());
        assert!(!dir.report().exists() && !dir.trace().exists());
        assert!(folder.0.join("my notes.txt").exists());
    }

    #[test]
    fn refuses_two_runs_in_one_folder() {
        let folder = Scratch::new("shared");
        let first = RunDir::create(&folder.0).expect("free");
        let error = RunDir::create(&folder.0).expect_err("taken").to_string();
        assert!(error.contains(&format!("process {}", std::process::id())), "{error}");
        drop(first);
        assert!(RunDir::create(&folder.0).is_ok());
    }

    #[test]
    fn survives_the_lock_of_a_dead_process() {
        let folder = Scratch::new("dead");
        std::fs::create_dir_all(&folder.0).expect("temporary folder");
        std::fs::write(folder.0.join(LOCK), "999999999\n").expect("writable");
        assert!(RunDir::create(&folder.0).is_ok());
    }

    #[test]
    fn refuses_foreign_folders_and_leaves_them_alone() {
        let folder = Scratch::new("foreign");
        std::fs::create_dir_all(&folder.0).expect("temporary folder");
        std::fs::write(folder.0.join("thesis.tex"), "years of work").expect("writable");
        let error = RunDir::create(&folder.0).expect_err("foreign").to_string();
        assert!(error.contains("thesis.tex") && error.contains("--out"), "{error}");
        assert_eq!(std::fs::read_dir(&folder.0).expect("readable").count(), 1);
    }

    #[test]
    fn example_a_run_that_never_starts_leaves_no_folder() {
        let folder = Scratch::new("never");
        drop(RunDir::create(&folder.0).expect("free"));
        assert!(!folder.0.exists());
    }

    #[test]
    fn refuses_missing_and_broken_runs() {
        let folder = Scratch::new("broken");
        let error = Run::read(&folder.0).expect_err("missing").to_string();
        assert!(error.contains("`scene.ron` is missing"), "{error}");
        write_run(&folder.0);
        std::fs::write(folder.0.join(INFO), "{\"version\": 3").expect("writable");
        let error = Run::read(&folder.0).expect_err("broken").to_string();
        assert!(error.contains("run.json") && error.contains("line 1"), "{error}");
        let file = folder.0.join(SCENE);
        let error = RunDir::create(file.join("x")).expect_err("below a file").to_string();
        assert!(error.contains("--out"), "{error}");
        assert!(write_atomic(&file.join("x"), b"").is_err());
        assert!(!folder.0.join("scene.ron.part").exists());
    }
}
