//! Real processes that end before their run does: killed, or without space on the disk. `--resume` finishes
//! their run.

use std::{
    fs,
    path::Path,
    process::{Command, Output, Stdio},
    sync::OnceLock,
    time::{Duration, Instant},
};

use crate::common::{QUICK, STRIBECK};
use stribeck_testing::{Scratch, assert_has};

/// The coarse bearing, from rest: long enough to be killed in the middle, short enough for a test.
const SCENE: [&str; 5] =
    ["simulate", QUICK, "--set=solver.duration_ms=2.7", "--set=solver.start=sudden", "--no-report"];

/// The traces must have come this far before a run is killed [bytes]: beyond a checkpoint, with most still to
/// come.
const UNDER_WAY: u64 = 250_000;

/// A killed run that has not come this far has hung.
const PATIENCE: Duration = Duration::from_secs(120);

fn simulate(out: &Path, threads: &str) -> Command {
    let mut command = Command::new(STRIBECK);
    command.args(SCENE).args(["--threads", threads, "--out"]).arg(out);
    command.stdout(Stdio::null()).stderr(Stdio::null());
    command
}

fn resume(run: &Path, threads: &str) -> Output {
    let mut command = Command::new(STRIBECK);
    command.args(["simulate", "--no-report", "--threads", threads, "--resume"]).arg(run);
    command.output().expect("it starts")
}

fn words(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Starts a run in `out` and kills it as `kill -9` does, once it is under way.
fn start_and_kill(out: &Path) {
    let mut child = simulate(out, "2").spawn().expect("it starts");
    wait_until_under_way(out);
    assert!(child.try_wait().expect("it can be asked").is_none(), "the run ended too early to be killed");
    child.kill().expect("it was running");
    child.wait().expect("it is dead");
    assert!(out.join("checkpoint").exists());
}

fn wait_until_under_way(run: &Path) {
    let began = Instant::now();
    while fs::metadata(run.join("trace.npy")).map_or(0, |about| about.len()) < UNDER_WAY {
        assert!(began.elapsed() < PATIENCE, "the run does not come on");
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// What runs are compared by.
const FILES: [&str; 2] = ["trace.npy", "energy.npy"];

fn files(run: &Path) -> [Vec<u8>; 2] {
    FILES.map(|name| fs::read(run.join(name)).expect("readable"))
}

/// Holds a run in pieces against one in one piece, which is made once for all tests.
fn assert_same_files(pieces: &Path) {
    static WHOLE: OnceLock<[Vec<u8>; 2]> = OnceLock::new();
    let whole = WHOLE.get_or_init(|| {
        let folder = Scratch::create("whole");
        let whole = folder.join("run");
        assert!(simulate(&whole, "1").status().expect("it starts").success());
        files(&whole)
    });
    for ((name, a), b) in FILES.iter().zip(whole).zip(files(pieces)) {
        assert!(*a == b, "another {name}");
    }
}

#[test]
fn survives_kills_and_full_disks_without_loss() {
    let folder = Scratch::create("nothing");
    let killed = folder.join("killed");
    start_and_kill(&killed);

    // A limit on the length of files stands for a full disk: the checkpoint does not fit at once, the trace
    // soon not.
    let limited = Command::new("sh")
        .args([
            "-c",
            r#"trap "" XFSZ; ulimit -f 800; exec "$0" simulate --no-report --threads 1 --resume "$1""#,
        ])
        .args([Path::new(STRIBECK), &killed])
        .output()
        .expect("a shell");
    let said = words(&limited);
    assert!(!limited.status.success(), "the run ended well without space: {said}");
    assert_has(
        &said,
        &["trace.npy", "rows stay readable", "free some space", "continue the run from its checkpoint"],
    );

    let finished = resume(&killed, "2");
    assert!(finished.status.success(), "{}", words(&finished));
    assert_same_files(&killed);

    let again = resume(&killed, "1");
    assert!(!again.status.success() && words(&again).contains("it is complete"), "{}", words(&again));
}

#[test]
fn refuses_a_folder_that_cannot_be_written_at_once() {
    // The kernel's own folder takes no files, not even from root.
    let output =
        simulate(Path::new("/proc/stribeck"), "1").stderr(Stdio::piped()).output().expect("it starts");
    let said = words(&output);
    assert!(!output.status.success(), "{said}");
    assert_has(&said, &["/proc/stribeck", "Nothing was changed", "--out"]);
}

#[test]
fn behaves_a_continued_run_takes_its_scene_from_its_folder() {
    for other in [&["--set", "mesh.size_mm=1.0"][..], &["--out", "elsewhere"], &["fixtures/scenes/quick.ron"]]
    {
        let output = Command::new(STRIBECK)
            .args(["simulate", "--resume", "nowhere"])
            .args(other)
            .output()
            .expect("it starts");
        assert!(
            !output.status.success() && words(&output).contains("cannot be used with"),
            "{}",
            words(&output)
        );
    }
}
