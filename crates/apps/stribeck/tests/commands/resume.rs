//! Real processes that end before their run does: killed, or without space on the disk. `--resume` finishes
//! their run.

use std::{
    fs,
    path::Path,
    process::{Command, Output, Stdio},
    sync::OnceLock,
    time::{Duration, Instant},
};

use crate::common::{COARSE, Desk, QUICK, STRIBECK};
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

fn listed(desk: &Desk) -> serde_json::Value {
    serde_json::from_slice(&desk.succeeds("list . --json").stdout).expect("JSON")
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

/// A kill between the last step and the end of the report left a run that `--resume` called complete and whose page no
/// command named. The report is begun anew: figures cut off, hidden halves of files, no `summary.json`.
#[test]
fn survives_a_kill_while_the_report_is_written() {
    let desk = Desk::new("reporting");
    let run = [&["simulate", QUICK, "--out=A"][..], &COARSE, &["--set=solver.duration_ms=0.3"]].concat();
    desk.succeeds(&run);
    let stage = || listed(&desk)[0]["stage"].as_str().map(str::to_owned);
    assert_eq!(stage().as_deref(), Some("reported"));
    desk.says("list .", &["reported, 0.3 ms"]);
    let report = ["A/summary.json", "A/report.html"].map(|name| (name, desk.text(name)));
    let figure = fs::read_dir(desk.join("A/figures")).expect("figures").flatten().map(|entry| entry.path());
    let figure = figure.min().expect("a figure");
    let drawn = fs::read(&figure).expect("readable");

    let break_off = || {
        fs::remove_file(desk.join("A/summary.json")).expect("it is there");
        fs::write(&figure, &drawn[..drawn.len() / 2]).expect("writable");
        for half in ["A/.report.html.1-0.part", "A/figures/.energy.svg.1-0.part"] {
            fs::write(desk.join(half), "half").expect("writable");
        }
        assert_eq!(stage().as_deref(), Some("complete"));
        desk.says("list .", &["complete, 0.3 ms", "next: ", " report ./A"]);
    };
    let healed = || {
        assert_eq!(stage().as_deref(), Some("reported"));
        report.iter().for_each(|(name, text)| assert!(desk.text(name) == *text, "another {name}"));
        assert!(fs::read(&figure).expect("readable") == drawn, "the figure is cut off");
        for half in ["A/.report.html.1-0.part", "A/figures/.energy.svg.1-0.part"] {
            assert!(!desk.join(half).exists(), "{half} is left");
        }
    };
    break_off();
    desk.refuses("simulate --resume A --no-report", &["it is complete", "stribeck report"]);
    desk.says("simulate --resume A", &["complete: ", "report: A/report.html"]);
    healed();
    break_off();
    desk.says("report A", &["report: A/report.html"]);
    healed();
    desk.refuses("simulate --resume A", &["it is complete", "solver.duration_ms"]);

    // Made longer, it has no report of its length until that is written.
    desk.succeeds("simulate --resume A --no-report --set solver.duration_ms=0.4");
    assert_eq!(stage().as_deref(), Some("complete"));
}

/// A kill before the complete run was moved to the place of an earlier one left both, for ever.
#[test]
fn survives_a_kill_before_a_run_takes_the_place_of_another() {
    let desk = Desk::new("replacing");
    let run = [&["simulate", QUICK, "--no-report", "--set=solver.duration_ms=0.3"][..], &COARSE].concat();
    desk.succeeds(&[&run[..], &["--out=A"]].concat());
    desk.succeeds(&[&run[..], &["--out=A.new", "--set=operation.load_n=1000"]].concat());
    fs::write(desk.join("A.new/.replaces"), "A").expect("writable");
    desk.says("list .", &["next: ", " simulate --resume ./A.new"]);
    desk.succeeds("simulate --resume A.new --no-report");
    assert!(!desk.join("A.new").exists());
    assert!(desk.text("A/scene.ron").contains("load_n: 1000"), "A is still the earlier run");
}

/// A run that was killed before its first checkpoint is planned, and says what begins it.
#[test]
fn survives_a_kill_before_the_first_step() {
    let desk = Desk::new("planned");
    fs::create_dir(desk.join("A")).expect("writable");
    fs::copy(QUICK, desk.join("A/scene.ron")).expect("writable");
    fs::write(desk.join("A/.lock"), "1\n").expect("writable");
    for command in ["report A", "simulate --resume A"] {
        desk.refuses(command, &["no `run.json`", "stribeck simulate A/scene.ron --out A"]);
    }
    let begin =
        [&["simulate", "A/scene.ron", "--out=A", "--set=solver.duration_ms=0.3"][..], &COARSE].concat();
    desk.succeeds(&begin);
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
