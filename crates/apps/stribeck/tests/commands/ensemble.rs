//! Ensembles as their users meet them: drawn from a seed, interrupted, continued, grown, refused.

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

use crate::common::{COARSE, Desk, QUICK, STRIBECK, command, ctrl_c};
use stribeck_testing::{said, says};

/// A very coarse bearing, from rest, for half a millisecond.
fn coarse() -> Vec<&'static str> {
    [&["simulate", QUICK, "--set=solver.duration_ms=0.3", "--threads=2"], &COARSE[..]].concat()
}

/// Whatever takes longer has hung.
const PATIENCE: Duration = Duration::from_secs(180);

fn simulate(desk: &Desk, words: &[&str]) -> Output {
    let mut command = command(desk, &coarse());
    command.args(words).output().expect("it starts")
}

#[track_caller]
fn succeeds(output: &Output) {
    assert!(output.status.success(), "{}", said(output));
}

fn bytes(desk: &Desk, name: &str) -> Vec<u8> {
    fs::read(desk.join(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
}

#[test]
fn invariant_a_seed_draws_the_same_starts_and_each_runs_alone_to_the_same_bytes() {
    let desk = Desk::new("seeds");
    succeeds(&simulate(&desk, &["--starts=3", "--jobs=2", "--out=A"]));
    succeeds(&simulate(&desk, &["--starts=3", "--jobs=1", "--seed=1", "--out=B"]));
    succeeds(&simulate(&desk, &["--starts=2", "--seed=2", "--out=C", "--no-report"]));
    let traces = |run: &str| ["001", "002"].map(|n| bytes(&desk, &format!("{run}/start-{n}/trace.npy")));
    assert!(traces("A") == traces("B"), "the same seed, other bytes");
    assert!(traces("A")[0] != traces("A")[1], "two starts, the same bytes");
    assert!(traces("C")[0] != traces("A")[0], "another seed, the same bytes");
    assert!(!desk.join("C/report.html").exists());

    desk.succeeds("simulate A/start-002/scene.ron --out=alone --no-report");
    for name in ["trace.npy", "energy.npy", "scene.ron"] {
        assert!(
            bytes(&desk, &format!("alone/{name}")) == bytes(&desk, &format!("A/start-002/{name}")),
            "{name}"
        );
    }

    // The report again, from the files alone; without a name that of the newest run, whether one start or
    // many.
    let page = bytes(&desk, "A/report.html");
    fs::remove_file(desk.join("A/report.html")).expect("removable");
    fs::remove_file(desk.join("A/summary.json")).expect("removable");
    desk.succeeds("report A");
    assert!(bytes(&desk, "A/report.html") == page);
    desk.succeeds("report A/start-001");
    assert_eq!(desk.json("A/start-001/summary.json")["scene"], "quick-start-001");

    let numbers = desk.json("A/summary.json");
    let peak = &numbers["ensemble"]["levels"]["start_g"];
    assert!(peak["low"].as_f64() < peak["mean"].as_f64() && peak["mean"].as_f64() < peak["high"].as_f64());
    assert_eq!((peak["count"].as_u64(), peak["of"].as_u64()), (Some(3), Some(3)));
}

/// Interrupts by Ctrl-C as soon as one start is complete and another under way.
fn interrupt(desk: &Desk, mut command: Command, folder: &str) -> Output {
    let child = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("it starts");
    let began = Instant::now();
    let complete = |n: usize| {
        let info = fs::read_to_string(desk.join(format!("{folder}/start-{n:03}/run.json")));
        info.is_ok_and(|text| text.contains("\"complete\""))
    };
    while !(complete(1) && desk.join(format!("{folder}/start-002/trace.npy")).exists()) {
        assert!(began.elapsed() < PATIENCE, "the run does not come on");
        std::thread::sleep(Duration::from_millis(2));
    }
    ctrl_c(child.id());
    child.wait_with_output().expect("it ends")
}

#[test]
fn survives_an_interruption_and_goes_on_with_what_is_missing() {
    let desk = Desk::new("interrupted");
    let longer = "--set=solver.duration_ms=1.0";
    succeeds(&simulate(&desk, &["--starts=3", "--jobs=1", "--out=whole", "--no-report", longer]));
    let mut command = command(&desk, &coarse());
    command.args(["--starts=3", "--jobs=1", "--out=pieces", longer]);
    let output = interrupt(&desk, command, "pieces");
    assert_eq!(output.status.code(), Some(130), "{}", said(&output));
    says(&output, &["starts are not at their end", "simulate --resume pieces"]);
    let first =
        fs::metadata(desk.join("pieces/start-001/trace.npy")).and_then(|m| m.modified()).expect("there");

    // Complete starts are readable, and count.
    let summary_then = desk.json("pieces/summary.json");
    assert_eq!(summary_then["starts"][0]["ended"], "complete");
    assert_eq!(summary_then["ensemble"]["levels"]["start_g"]["count"].as_u64(), Some(1));

    // More starts at the same time.
    desk.succeeds("simulate --resume pieces --starts=4 --jobs=2");
    for n in 1..=3 {
        for name in ["trace.npy", "energy.npy", "scene.ron"] {
            let [a, b] = ["whole", "pieces"].map(|run| bytes(&desk, &format!("{run}/start-{n:03}/{name}")));
            assert!(a == b, "another {name} of start {n}");
        }
    }
    assert!(desk.join("pieces/start-004/trace.npy").exists());
    let again =
        fs::metadata(desk.join("pieces/start-001/trace.npy")).and_then(|m| m.modified()).expect("there");
    assert_eq!(first, again, "a complete start was run again");

    // Longer ones.
    let set = "--set=solver.duration_ms=1.1";
    desk.succeeds(&["simulate", "--resume", "pieces", set, "--no-report"]);
    desk.succeeds("simulate pieces/start-003/scene.ron --out=long --no-report");
    assert!(bytes(&desk, "long/trace.npy") == bytes(&desk, "pieces/start-003/trace.npy"));
}

#[test]
fn refuses_flags_that_do_not_go_together() {
    let desk = Desk::new("flags");
    succeeds(&simulate(&desk, &["--starts=1", "--out=E", "--no-report"]));
    succeeds(&simulate(&desk, &["--out=one", "--no-report"]));
    let before = bytes(&desk, "E/ensemble.json");
    for (words, answers) in [
        (&["simulate", "--starts=0"][..], &["whole number from 1 to 10000"][..]),
        (&["simulate", "--starts=many"], &["whole number from 1 to 10000"]),
        (&["simulate", "--jobs=2"], &["--jobs", "--starts N", "--threads"]),
        (&["simulate", "--seed=2"], &["--seed", "--starts N"]),
        (&["simulate", "--starts=2", "--jobs=0"], &["from 1 to 1024"]),
        (&["simulate", "--starts=2", "--seed=-1"], &["seed"]),
        (&["simulate", "--resume=one", "--starts=3"], &["single run", "simulate one/scene.ron --starts 3"]),
        (&["simulate", "--resume=one", "--jobs=3"], &["--starts N"]),
        (&["simulate", "--resume=E", "--seed=2"], &["drawn from the seed 1"]),
        (&["simulate", "--resume=E", "--set=mesh.size_mm=3"], &["solver.duration_ms"]),
        (&["simulate", "--resume=E", "--set=solver.duration_ms=0.1"], &["longer, not shorter"]),
    ] {
        let output = desk.run(words);
        assert!(!output.status.success(), "{words:?}");
        says(&output, answers);
    }
    desk.succeeds("simulate --resume=E --starts=2 --no-report");
    says(&desk.run("simulate --resume=E --starts=1"), &["larger, not smaller"]);
    assert!(before != bytes(&desk, "E/ensemble.json"));

    // An ensemble that is there is kept, as a run is; --overwrite waits for the new one.
    let there = simulate(&desk, &["--starts=1", "--out=E"]);
    assert!(!there.status.success());
    says(&there, &["ensemble with 2 of 2 starts", "--overwrite", "--resume E --starts"]);
    succeeds(&simulate(&desk, &["--starts=1", "--seed=9", "--out=E", "--overwrite", "--no-report"]));
    assert!(!desk.join("E.new").exists() && !desk.join("E/start-002").exists());
    assert!(String::from_utf8_lossy(&bytes(&desk, "E/ensemble.json")).contains("\"seed\": 9"));
    succeeds(&simulate(&desk, &["--out=E", "--overwrite", "--no-report"]));
    assert!(!desk.join("E/ensemble.json").exists() && !desk.join("E/start-001").exists());
}

/// A time step above the critical one diverges in every start; they are counted and reported, and nothing is
/// lost.
#[test]
fn survives_starts_that_diverge() {
    let desk = Desk::new("diverge");
    let output = simulate(&desk, &["--starts=2", "--jobs=2", "--out=D", "--set=solver.time_step_factor=1.3"]);
    assert_eq!(output.status.code(), Some(1), "{}", said(&output));
    says(&output, &["start 1 diverged and does not count", "no start is complete", "report: D/report.html"]);
    assert_eq!(desk.json("D/summary.json")["starts"][1]["ended"], "diverged");
    // Nothing is left to do: the same steps would diverge again.
    says(&desk.run("simulate --resume D"), &["0 to run"]);
}

/// A limit on the length of files stands for a full disk: the traces do not fit.
#[test]
fn survives_a_full_disk_and_goes_on_when_there_is_space() {
    let desk = Desk::new("full");
    // A megabyte of samples: mesh and checkpoint are smaller.
    let longer = ["--set=solver.duration_ms=1.0", "--set=output.interval_us=1"];
    let program = Path::new(STRIBECK);
    let script = r#"trap "" XFSZ; ulimit -f 2400; exec "$0" "$@""#;
    let mut command = Command::new("sh");
    command.current_dir(desk.path()).args(["-c", script]).arg(program).args(coarse());
    let output = command
        .args(["--starts=2", "--jobs=1", "--out=F", "--no-report"])
        .args(longer)
        .output()
        .expect("a shell");
    assert!(!output.status.success(), "{}", said(&output));
    says(&output, &["start 1 (1 of 2): failed", "2 of 2 starts are not at their end", "--resume F"]);
    desk.succeeds("simulate --resume F");
    desk.succeeds("simulate F/start-001/scene.ron --out=whole --no-report");
    assert!(bytes(&desk, "F/start-001/trace.npy") == bytes(&desk, "whole/trace.npy"));
}
