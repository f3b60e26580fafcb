//! Runs that end early and go on: the same bytes as an unbroken run, and clear words when that is impossible.

use std::{fs, ops::ControlFlow, path::Path};

use crate::common::{coarse, host, run_watched};
use proptest::prelude::*;
use stribeck_scene::scene::{Scene, Start};
use stribeck_simulation::run::host::{Host, Progress};
use stribeck_simulation::{Error, extend, resume, saved_until, simulate};
use stribeck_store::{
    run_dir::RunDir,
    run_info::{RunInfo, Status},
    trace::TraceFile,
};
use stribeck_testing::{Scratch, assert_refused};

/// Bytes before the content of a checkpoint: name, version, scene hash, length, checksum.
const HEADER: usize = 20 + 4 + 16 + 8 + 4;

/// The coarse bearing with the fewest elements that turn, whose files are looked at, and nothing else.
fn coarsest(duration_ms: f64) -> Scene {
    let mut scene = coarse(duration_ms);
    (scene.mesh.size_mm, scene.mesh.roller_facets) = (4.0, 40);
    scene
}

/// The coarse bearing, short and without a preload.
fn sudden() -> Scene {
    let mut scene = coarse(0.1);
    scene.solver.start = Start::Sudden;
    scene
}

fn bytes(folder: &Scratch, name: &str) -> Vec<u8> {
    fs::read(folder.join(name)).expect("readable")
}

/// Breaks a run off after a number of samples of its own, counting the steps of the coarse scene.
fn until(samples: usize) -> impl FnMut(&Progress) -> ControlFlow<()> {
    let mut seen = 0;
    move |progress| {
        seen += usize::from(progress.phase == "run");
        if seen == samples { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

fn go_on(
    folder: &Path,
    threads: usize,
    watch: &mut dyn FnMut(&Progress) -> ControlFlow<()>,
) -> Result<RunInfo, Error> {
    resume(&RunDir::reopen(folder)?, &host(threads), watch)
}

/// Message of a refused continuation.
fn refusal(folder: &Scratch) -> String {
    go_on(folder.path(), 1, &mut |_| ControlFlow::Continue(())).expect_err("it cannot go on").to_string()
}

/// A run that was broken off after two samples.
fn broken_off() -> Scratch {
    let folder = Scratch::new("resume");
    let info = run_watched(&sudden(), 1, &folder, &mut until(2));
    assert_eq!((info.status, info.samples), (Status::Interrupted, 2));
    folder
}

fn assert_same_files(whole: &Scratch, pieces: &Scratch, how: &str) {
    for name in ["trace.npy", "energy.npy"] {
        assert!(bytes(whole, name) == bytes(pieces, name), "{how}: another {name}");
    }
    let mut frames = 0;
    for frame in fs::read_dir(whole.join("frames")).into_iter().flatten().flatten() {
        let other = pieces.join("frames").join(frame.file_name());
        assert!(fs::read(frame.path()).ok() == fs::read(&other).ok(), "{how}: another {}", other.display());
        frames += 1;
    }
    assert!(frames > 2, "the scene asks for frames, and there are {frames}");
}

/// A run in pieces, on one thread and two by turns, writes the same files as one in one piece. Damping frames
/// are placed at every 64th step; the breaks lie elsewhere.
#[test]
fn invariant_a_run_in_pieces_writes_the_same_bytes() {
    let scene = coarse(0.5);
    let whole = Scratch::new("resume");
    let unbroken = run_watched(&scene, 1, &whole, &mut until(0));
    assert_eq!(unbroken.status, Status::Complete);
    let steps_per_sample = unbroken.steps_planned / 50;

    let pieces = Scratch::new("resume");
    let info = run_watched(&scene, 1, &pieces, &mut until(1));
    assert_eq!((info.status, info.steps), (Status::Interrupted, steps_per_sample));
    let mut breaks = vec![info.samples];
    for (threads, samples) in [(2, 6), (1, 14), (2, 8)] {
        let info = go_on(pieces.path(), threads, &mut until(samples)).expect("it goes on");
        assert_eq!((info.status, info.threads), (Status::Interrupted, threads));
        breaks.push(info.samples);
    }
    assert_eq!(breaks, [1, 7, 21, 29]);
    let between = breaks.iter().filter(|&&n| !(n as u64 * steps_per_sample).is_multiple_of(64)).count();
    assert!(between >= 3, "{steps_per_sample} steps a sample");
    let info = go_on(pieces.path(), 1, &mut until(0)).expect("it goes on");
    assert_same_files(&whole, &pieces, "in pieces");
    assert_eq!(info.resumed_at_s.len(), 4);
    assert_eq!((info.steps, info.status, info.stop_reason), (unbroken.steps, Status::Complete, None));
    assert_eq!(info.energy, unbroken.energy);
    assert!(info.warnings.is_empty(), "{:?}", info.warnings);
}

/// A complete run is made longer from its last state; the files are those of a run that was as long from the
/// start.
#[test]
fn invariant_a_run_made_longer_writes_the_bytes_of_a_long_one() {
    let (short, long) = (Scratch::new("resume"), Scratch::new("resume"));
    let info = run_watched(&coarsest(0.3), 1, &short, &mut until(0));
    assert_eq!((info.status, info.samples), (Status::Complete, 30));
    let unbroken = run_watched(&coarsest(0.5), 2, &long, &mut until(0));
    let longer = |ms: f64| {
        let dir = RunDir::reopen(short.path()).expect("a run");
        extend(&dir, ms, &host(2), &mut until(0))
    };
    let words = longer(0.2).expect_err("it is longer already").to_string();
    assert!(words.contains("0.3 ms") && words.contains("not shorter"), "{words}");
    assert_refused(longer(0.3), "it is complete");
    assert_eq!(info.samples, TraceFile::open(short.join("trace.npy")).expect("a trace").len());

    let info = longer(0.5).expect("it goes on");
    assert_same_files(&long, &short, "made longer");
    assert!(bytes(&long, "scene.ron") == bytes(&short, "scene.ron"));
    assert_eq!((info.steps_planned, &info.scene_hash), (unbroken.steps_planned, &unbroken.scene_hash));
    assert_eq!((info.status, info.samples, info.energy), (Status::Complete, 50, unbroken.energy));
    assert_eq!(info.resumed_at_s, [30.0 * info.interval_s]);
}

/// Scene and checkpoint are enough: a `run.json` that is damaged or gone costs a warning.
#[test]
fn invariant_a_damaged_run_json_does_not_block_a_checkpoint() {
    for damage in [Some(&b"{"[..]), None] {
        let (whole, folder) = (Scratch::new("resume"), broken_off());
        run_watched(&sudden(), 1, &whole, &mut until(0));
        match damage {
            Some(bytes) => fs::write(folder.join("run.json"), bytes).expect("writable"),
            None => fs::remove_file(folder.join("run.json")).expect("it was there"),
        }
        let info = go_on(folder.path(), 1, &mut until(0)).expect("it goes on");
        assert!(bytes(&whole, "trace.npy") == bytes(&folder, "trace.npy"), "another trace");
        let [warning] = info.warnings.as_slice() else { panic!("{:?}", info.warnings) };
        assert!(warning.contains("run.json") && warning.contains("anew from the checkpoint"), "{warning}");
    }
}

/// Copies the files of a folder, if there is one, but not its lock.
fn copy(from: &Path, to: &Path) {
    let Ok(entries) = fs::read_dir(from) else { return };
    fs::create_dir_all(to).expect("writable");
    for file in entries.flatten().filter(|f| f.path().is_file() && f.file_name() != ".lock") {
        fs::copy(file.path(), to.join(file.file_name())).expect("writable");
    }
}

/// `kill -9` leaves the files of that moment: the run continues from the last checkpoint, of the start or of
/// the hundredth sample, and drops the samples after it.
#[test]
fn survives_a_kill_and_goes_on_from_its_last_checkpoint() {
    let scene = coarsest(1.25);
    let whole = Scratch::new("resume");
    let killed = [(3, Scratch::new("resume")), (104, Scratch::new("resume"))];
    let mut seen = 0;
    run_watched(&scene, 2, &whole, &mut |progress| {
        seen += usize::from(progress.phase == "run");
        for (_, left) in killed.iter().filter(|(sample, _)| *sample == seen) {
            fs::create_dir_all(left.path()).expect("writable");
            copy(whole.path(), left.path());
            copy(&whole.join("frames"), &left.join("frames"));
        }
        ControlFlow::Continue(())
    });
    for ((_, left), from) in killed.iter().zip([0.0, 100.0]) {
        // As if more had reached the disk before the end.
        for name in ["trace.npy", "energy.npy"] {
            fs::write(left.join(name), [bytes(left, name), vec![7; 5000]].concat()).expect("writable");
        }
        let info = go_on(left.path(), 1, &mut until(0)).expect("it goes on");
        assert_eq!(info.resumed_at_s, [from * info.interval_s]);
        assert_same_files(&whole, left, &format!("from sample {from}"));
    }
}

/// A checkpoint that was cut off, at any length, is refused with advice and the traces are left alone.
#[test]
fn refuses_a_checkpoint_cut_anywhere() {
    let folder = broken_off();
    let (whole, trace) = (bytes(&folder, "checkpoint"), bytes(&folder, "trace.npy"));
    let steps = (whole.len() - HEADER) / 60;
    for length in (0..HEADER + 5).chain((HEADER..whole.len()).step_by(steps)).chain([whole.len() - 1]) {
        fs::write(folder.join("checkpoint"), &whole[..length]).expect("writable");
        let words = refusal(&folder);
        assert!(words.contains("checkpoint") && words.contains("start it anew"), "cut at {length}: {words}");
    }
    assert!(trace == bytes(&folder, "trace.npy"), "a refused run lost samples");
    fs::write(folder.join("checkpoint"), &whole).expect("writable");
    assert_eq!(go_on(folder.path(), 1, &mut until(0)).expect("whole again").status, Status::Complete);
}

/// One wrong byte anywhere is noticed.
#[test]
fn refuses_a_damaged_checkpoint() {
    let folder = broken_off();
    let whole = bytes(&folder, "checkpoint");
    let steps = (whole.len() - HEADER) / 60;
    for at in (0..HEADER).chain((HEADER..whole.len()).step_by(steps)) {
        let mut damaged = whole.clone();
        damaged[at] ^= 0x41;
        fs::write(folder.join("checkpoint"), &damaged).expect("writable");
        let words = refusal(&folder);
        assert!(words.contains("checkpoint") && words.contains("start it anew"), "byte {at}: {words}");
    }
}

/// Damage under a length and a checksum that fit: it is found later, and gets a message too. A
/// failure shrinks to the fewest bytes.
#[test]
fn refuses_a_forged_checkpoint() {
    let folder = broken_off();
    let whole = bytes(&folder, "checkpoint");
    let dir = RunDir::open(folder.path()).expect("a run");
    let damage = (0..whole.len() - HEADER, proptest::collection::vec(any::<u8>(), 0..12), 0_usize..20);
    let config = ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(150) };
    let mut runner = proptest::test_runner::TestRunner::new(config);
    let done = runner.run(&proptest::collection::vec(damage, 1..4), |damage| {
        let mut content = whole[HEADER..].to_vec();
        for (at, bytes, cut) in damage {
            // Lengths of lists stand near the front; damage there matters most.
            let at = if cut % 2 == 0 { at } else { at % 400 }.min(content.len());
            let end = (at + cut).min(content.len());
            content.splice(at..end, bytes);
        }
        let mut forged = whole[..HEADER - 12].to_vec();
        forged.extend((content.len() as u64).to_le_bytes());
        forged.extend(crc32fast::hash(&content).to_le_bytes());
        forged.extend(content);
        fs::write(folder.join("checkpoint"), forged).expect("writable");
        if let Err(error) = saved_until(&dir) {
            let words = error.to_string();
            prop_assert!(words.contains("checkpoint") && words.contains("start it anew"), "{}", words);
        }
        Ok(())
    });
    done.expect("an answer to every one");
}

/// Every reason has its own words, and says what to do.
#[test]
fn refuses_what_cannot_go_on_and_says_why() {
    let folder = broken_off();
    let checkpoint = bytes(&folder, "checkpoint");
    let with = |name: &str, other: &[u8]| {
        let before = bytes(&folder, name);
        fs::write(folder.join(name), other).expect("writable");
        let words = refusal(&folder);
        fs::write(folder.join(name), before).expect("writable");
        words
    };
    let says = |words: String, expected: &[&str]| {
        for e in expected {
            assert!(words.contains(e), "`{e}` is missing in: {words}");
        }
    };

    let present = u32::from_le_bytes(checkpoint[20..24].try_into().expect("four bytes"));
    for version in [present - 1, present + 1] {
        let mut other = checkpoint.clone();
        other[20..24].copy_from_slice(&version.to_le_bytes());
        says(
            with("checkpoint", &other),
            &[&format!("version {version}"), "program that began it", "run.json"],
        );
    }

    let other = coarse(0.2);
    says(with("scene.ron", other.to_ron().as_bytes()), &["another scene", "scene.ron", "new run"]);

    let text = String::from_utf8(bytes(&folder, "run.json")).expect("text");
    says(
        with("run.json", text.replace("interrupted", "complete").as_bytes()),
        &["it is complete", "duration_ms"],
    );
    says(
        with("run.json", text.replace("interrupted", "diverged").as_bytes()),
        &["diverge again", "run.json"],
    );

    let trace = bytes(&folder, "trace.npy");
    says(with("trace.npy", &trace[..trace.len() - 8]), &["trace.npy", "holds 1 samples", "counts 2", "anew"]);
    says(with("trace.npy", &bytes(&folder, "energy.npy")), &["trace.npy", "other channels"]);

    let held = RunDir::reopen(folder.path()).expect("free");
    says(refusal(&folder), &["another run", &std::process::id().to_string()]);
    drop(held);

    fs::remove_file(folder.join("checkpoint")).expect("it was there");
    says(refusal(&folder), &["no checkpoint", "before its first step", "scene.ron"]);
    let nothing = Scratch::new("resume");
    says(refusal(&nothing), &["is not a run", "scene.ron"]);
    assert!(!nothing.path().exists(), "a refused resume made a folder");
}

/// Clocks that are set back, jump ahead or stand still change times in `run.json` and nothing else:
/// checkpoints are still written, and no time runs backwards.
#[test]
fn survives_a_clock_that_jumps() {
    let whole = Scratch::new("resume");
    run_watched(&coarsest(1.25), 1, &whole, &mut until(0));
    for jump in [-1e9, 1e9, f64::NAN, 0.0] {
        let folder = Scratch::new("resume");
        let calls = std::cell::Cell::new(0);
        let clock = || {
            calls.set(calls.get() + 1);
            // Every third look at the clock finds it somewhere else.
            f64::from(calls.get()) + if calls.get() % 3 == 0 { jump } else { 0.0 }
        };
        let host = Host { wall_s: &clock, cpu_s: &clock, ..host(1) };
        let dir = RunDir::create(folder.path()).expect("the folder is new");
        let mut saved = Vec::new();
        let info = simulate(&coarsest(1.25), &dir, &host, &mut |progress| {
            if progress.phase == "run" {
                saved.push(
                    fs::metadata(folder.join("checkpoint")).and_then(|m| m.modified()).expect("there is one"),
                );
            }
            ControlFlow::Continue(())
        })
        .expect("the scene is sound");
        assert_eq!(info.status, Status::Complete);
        assert!(info.wall_s >= 0.0 && info.cpu_s >= 0.0, "{} s, {} s", info.wall_s, info.cpu_s);
        assert_same_files(&whole, &folder, &format!("clock jumps by {jump} s"));
        if jump < 0.0 {
            assert!(saved.last() > saved.first(), "no checkpoint was written after the clock was set back");
        }
    }
}

/// Where no checkpoint can be written the run continues, with one warning.
#[test]
fn survives_a_checkpoint_that_cannot_be_written() {
    let folder = Scratch::new("resume");
    // From the first sample on a folder in the place of the file stands for a disk that refuses it.
    let (checkpoint, mut stop) = (folder.join("checkpoint"), until(3));
    let info = run_watched(&sudden(), 1, &folder, &mut |progress| {
        if progress.phase == "run" && checkpoint.is_file() {
            fs::remove_file(&checkpoint).and_then(|()| fs::create_dir(&checkpoint)).expect("writable");
            fs::write(checkpoint.join("in the way"), "").expect("writable");
        }
        stop(progress)
    });
    fs::remove_dir_all(&checkpoint).expect("nobody took it away");
    assert_eq!((info.status, info.samples), (Status::Interrupted, 3));
    let [warning] = info.warnings.as_slice() else { panic!("{:?}", info.warnings) };
    assert!(warning.contains("no checkpoint at 0.030 ms") && warning.contains("went on"), "{warning}");
    assert!(
        RunDir::open(folder.path()).and_then(|dir| dir.read_info()).expect("readable").warnings
            == info.warnings
    );
    assert!(refusal(&folder).contains("no checkpoint"));
}
