//! The program in a folder of its own.

use std::fs;
use std::ops::Deref;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::Duration;

use stribeck_scene::scene::Scene;
use stribeck_simulation::run::host::Host;
use stribeck_simulation::simulate;
use stribeck_store::run_dir::RunDir;
use stribeck_store::run_info::{RunInfo, Status};
use stribeck_testing::{Scratch, said, says};

pub(crate) const STRIBECK: &str = env!("CARGO_BIN_EXE_stribeck");

pub(crate) const QUICK: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../fixtures/scenes/quick.ron");

/// What makes it very coarse, and start from rest.
pub(crate) const COARSE: [&str; 4] = [
    "--set=mesh.size_mm=4.0",
    "--set=mesh.roller_facets=40",
    "--set=solver.start=sudden",
    "--set=output.frames=None",
];

/// The words of a line, among which `'…'` is one, or words one by one.
pub(crate) trait Line {
    fn words(&self) -> Vec<&str>;
}

impl Line for str {
    fn words(&self) -> Vec<&str> {
        let parts = self.split('\'').enumerate();
        parts
            .flat_map(|(n, part)| if n % 2 == 0 { part.split_whitespace().collect() } else { vec![part] })
            .collect()
    }
}

impl Line for [&str] {
    fn words(&self) -> Vec<&str> {
        self.to_vec()
    }
}

impl<const N: usize> Line for [&str; N] {
    fn words(&self) -> Vec<&str> {
        self.to_vec()
    }
}

impl Line for Vec<&str> {
    fn words(&self) -> Vec<&str> {
        self.clone()
    }
}

/// The program with the words of a line, to be started in a folder.
pub(crate) fn command(desk: &Scratch, line: &(impl Line + ?Sized)) -> Command {
    let mut command = Command::new(STRIBECK);
    command.current_dir(desk.path()).args(line.words()).stdin(Stdio::null());
    command
}

/// Sends what Ctrl-C sends.
pub(crate) fn ctrl_c(process: u32) {
    let sent = Command::new("kill").args(["-INT", &process.to_string()]).status().expect("kill is there");
    assert!(sent.success());
}

/// Runs a scene to its end without the program.
pub(crate) fn complete(scene: &Scene, folder: &Path) -> RunInfo {
    let host = Host {
        threads: 1,
        version: "test".into(),
        commit: "test".into(),
        machine: "test".into(),
        wall_s: &|| 0.0,
        cpu_s: &|| 0.0,
    };
    let dir = RunDir::create(folder).expect("the folder is new");
    let info =
        simulate(scene, &dir, &host, &mut |_| std::ops::ControlFlow::Continue(())).expect("a valid scene");
    assert_eq!(info.status, Status::Complete, "{:?}", info.stop_reason);
    info
}

/// A folder of a user, and what is done there.
pub(crate) struct Desk {
    folder: Scratch,
    /// With which every line begins.
    begins: &'static [&'static str],
}

impl Deref for Desk {
    type Target = Scratch;

    fn deref(&self) -> &Scratch {
        &self.folder
    }
}

impl Desk {
    pub(crate) fn new(name: &str) -> Self {
        Self::of(name, &[])
    }

    /// An empty folder for one command.
    pub(crate) fn of(name: &str, begins: &'static [&'static str]) -> Self {
        Self { folder: Scratch::create(name), begins }
    }

    pub(crate) fn with_scene(name: &str) -> Self {
        let desk = Self::new(name);
        fs::copy(QUICK, desk.join("quick.ron")).expect("a scene");
        desk
    }

    pub(crate) fn command(&self, line: &(impl Line + ?Sized)) -> Command {
        command(self, &[self.begins, &line.words()].concat())
    }

    pub(crate) fn run(&self, line: &(impl Line + ?Sized)) -> Output {
        self.command(line).output().expect("it starts")
    }

    /// Starts it, and kills it after so many milliseconds, as `kill -9` does.
    pub(crate) fn kill(&self, line: &str, after_ms: f64) {
        let mut command = self.command(line);
        let mut child = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("it starts");
        std::thread::sleep(Duration::from_millis(after_ms as u64));
        child.kill().expect("it can be killed");
        child.wait().expect("it ends");
    }

    #[track_caller]
    pub(crate) fn succeeds(&self, line: &(impl Line + ?Sized)) -> Output {
        let output = self.run(line);
        assert!(output.status.success(), "{:?}: {}", line.words(), said(&output));
        output
    }

    /// Succeeds, and says this.
    #[track_caller]
    pub(crate) fn says(&self, line: &(impl Line + ?Sized), told: &[&str]) {
        says(&self.succeeds(line), told);
    }

    #[track_caller]
    pub(crate) fn refuses(&self, line: &(impl Line + ?Sized), told: &[&str]) {
        let output = self.run(line);
        assert!(!output.status.success(), "{:?}: {}", line.words(), said(&output));
        says(&output, told);
    }

    pub(crate) fn text(&self, name: &str) -> String {
        fs::read_to_string(self.folder.join(name)).unwrap_or_else(|why| panic!("{name}: {why}"))
    }

    pub(crate) fn json(&self, name: &str) -> serde_json::Value {
        serde_json::from_str(&self.text(name)).expect(name)
    }
}
