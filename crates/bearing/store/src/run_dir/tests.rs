use std::path::Path;

use stribeck_testing::{Scratch, assert_has, assert_refused};

use super::*;
use crate::run_info::{EnergyInfo, MeshInfo, Status};
use crate::trace::{Trace, TraceWriter};

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
        simulated_s: 0.0,
        reduced: None,
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
        loop_cpu_s: 2.0,
        setup_s: 0.5,
        energy: EnergyInfo {
            max_relative_error: 1e-3,
            peak_strain_j: 2.0,
            heat_j: 3.0,
            ..EnergyInfo::default()
        },
        guards: crate::run_info::GuardInfo::default(),
        expected_support_n: 50_100.0,
        resumed_at_s: vec![1e-5],
        notes: Vec::new(),
        warnings: vec!["one".into()],
        warned_of: Vec::new(),
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
    write_run(folder.path());
    let run = Run::read(folder.path()).expect("complete");
    assert_eq!(run.scene.written, Scene::default());
    assert_eq!(run.info, info(Status::Complete));
    assert_eq!(run.trace.channel("x").expect("readable"), Some(vec![1.0]));
    assert_eq!(run.energy.len(), 1);
}

fn bytes(path: &Path) -> Vec<u8> {
    [INFO, SCENE, TRACE, ENERGY].map(|name| std::fs::read(path.join(name)).expect("readable")).concat()
}

#[test]
fn invariant_samples_are_never_written_over() {
    let folder = Scratch::new("earlier");
    write_run(folder.path());
    let before = bytes(folder.path());
    let error = RunDir::create(folder.path()).expect_err("taken").to_string();
    assert_eq!(bytes(folder.path()), before);
    assert_has(&error, &["complete run of", "--out", "--overwrite", "earlier-2`"]);
    let second = RunDir::create_numbered(folder.path()).expect("free");
    assert!(second.path().ends_with(format!("{}-2", folder.path().file_name().expect("a name").display())));
    // The second is not there yet, and yet the third gets another.
    let third = RunDir::create_numbered(folder.path()).expect("free");
    assert_ne!(second.path(), third.path());
    let paths = [second.path().to_owned(), third.path().to_owned()];
    drop((second, third));
    assert!(paths.iter().all(|path| !path.exists()), "runs that never started left folders");
    // A run that has no samples is not worth a word.
    TraceWriter::create(folder.join(TRACE), &["time_s"]).expect("writable");
    let dir = RunDir::create(folder.path()).expect("free");
    dir.start(&Scene::default(), &info(Status::Running)).expect("writable");
    assert!(dir.has_started() && !dir.trace().exists());
}

#[test]
fn invariant_a_run_is_replaced_when_the_new_one_is_complete() {
    let folder = Scratch::new("replaced");
    let [run, new] = ["x", "x.new"].map(|name| folder.join(name));
    write_run(&run);
    let mine = ["my notes.txt", "figures/mine.txt"].map(|name| run.join(name));
    std::fs::create_dir_all(run.join(FIGURES)).expect("writable");
    mine.iter().for_each(|file| std::fs::write(file, "mine").expect("writable"));
    std::fs::write(run.join(FIGURES).join("old.svg"), "old").expect("writable");
    let before = bytes(&run);

    let dir = RunDir::replace(&run).expect("a place beside it");
    assert!(dir.path().ends_with("x.new") && dir.replaces().is_some());
    dir.start(&Scene::default(), &info(Status::Running)).expect("writable");
    let mut trace = TraceWriter::create(dir.trace(), &["time_s", "x"]).expect("writable");
    trace.push(&[0.0, 2.0]).expect("writable");
    trace.finish().expect("writable");
    drop(dir);
    assert_eq!(bytes(&run), before);
    // Interrupted: a second one would destroy the first.
    let error = RunDir::replace(&run).expect_err("one is there").to_string();
    assert!(error.contains("x.new") && !error.contains("--resume"), "no checkpoint: {error}");
    std::fs::write(new.join(CHECKPOINT), "there").expect("writable");
    let error = RunDir::replace(&run).expect_err("one is there").to_string();
    assert!(error.contains("x.new") && error.contains("--resume"), "{error}");
    // One that diverged would diverge again.
    let dir = RunDir::reopen(&new).expect("a run");
    dir.write_info(&info(Status::Diverged)).expect("writable");
    drop(dir);
    let error = RunDir::replace(&run).expect_err("one is there").to_string();
    assert!(
        error.contains("diverged") && error.contains("remove it") && !error.contains("--resume"),
        "{error}"
    );

    // A continued run still replaces the same folder.
    let dir = RunDir::reopen(&new).expect("a run").take_place().expect("complete");
    assert_eq!(dir.path().canonicalize().expect("there"), run.canonicalize().expect("there"));
    assert_eq!(Trace::read(run.join(TRACE)).expect("readable").get("x"), Some(&[2.0][..]));
    assert!(!new.exists() && !run.join(".replaces").exists() && !run.join(ENERGY).exists());
    assert!(mine.iter().all(|file| file.exists()), "what the owner added is gone");
    assert!(!run.join(FIGURES).join("old.svg").exists());
    assert_eq!(std::fs::read_dir(folder.path()).expect("readable").count(), 1);
}

#[test]
fn invariant_a_run_that_never_starts_takes_away_the_folders_above_it() {
    let folder = Scratch::new("above");
    let dir = RunDir::create(folder.join("a/b")).expect("free");
    let mut ended = false;
    dir.reservation().unless_started(|| ended = true);
    assert!(ended && !folder.path().exists());
}

#[test]
fn behaves_of_a_run_its_signals_stay() {
    let folder = Scratch::new("kept");
    for (keep, left) in [
        (Keep::All, &[CHECKPOINT, ENERGY, FRAMES, MESH, INFO, SCENE, SUMMARY, TRACE][..]),
        (Keep::Signals, &[INFO, SCENE, SIGNALS, SUMMARY]),
        (Keep::Numbers, &[INFO, SCENE, SUMMARY]),
    ] {
        let path = folder.join(format!("{keep:?}"));
        let dir = RunDir::create(&path).expect("free");
        dir.start(&Scene::default(), &info(Status::Running)).expect("writable");
        for file in [dir.trace(), dir.energy()] {
            let mut trace =
                TraceWriter::create(file, &["time_s", "x", "sensor.a.ay_m_s2"]).expect("writable");
            trace.push(&[0.0, 1.0, 2.0]).expect("writable");
            trace.push(&[1.0, f64::NAN, 3.0]).expect("writable");
        }
        std::fs::create_dir_all(dir.frames()).expect("writable");
        let others = [dir.mesh(), dir.checkpoint(), dir.summary(), dir.frames().join("000000.npy")];
        dir.write_info(&info(Status::Complete)).expect("writable");
        others.iter().for_each(|file| std::fs::write(file, "bytes").expect("writable"));
        for _ in 0..2 {
            dir.keep_only(keep).expect("writable");
            assert!(dir.keeps_only(keep));
        }
        let names = std::fs::read_dir(&path).expect("readable").flatten().map(|entry| entry.file_name());
        let mut names: Vec<String> = names.map(|name| name.to_string_lossy().into_owned()).collect();
        names.retain(|name| name != LOCK);
        names.sort();
        let mut left = left.to_vec();
        left.sort_unstable();
        assert_eq!(names, left);
        if keep == Keep::Signals {
            let signals = Trace::read(dir.signals()).expect("readable");
            assert_eq!(signals.names, ["time_s", "sensor.a.ay_m_s2"]);
            assert_eq!(signals.columns, [[0.0, 1.0], [2.0, 3.0]]);
        }
        drop(dir);
        // It is a run as before, and done.
        assert_eq!(State::of(&path, &Scene::default()), State::Done);
        assert!(matches!(RunDir::create(&path), Err(Error::FolderHoldsRun { .. })));
    }
}

#[test]
fn invariant_many_at_once_get_a_folder_each() {
    let folder = Scratch::new("many");
    let path = folder.join("runs/x");
    let paths = std::sync::Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for n in 0..16 {
            let (path, paths) = (&path, &paths);
            scope.spawn(move || {
                let dir = RunDir::create_numbered(path).expect("free");
                // Every other one never starts, and removes its folder while the others use it.
                if n % 2 == 0 {
                    dir.start(&Scene::default(), &info(Status::Running)).expect("writable");
                    let mut trace = TraceWriter::create(dir.trace(), &["time_s"]).expect("writable");
                    trace.push(&[0.0]).expect("writable");
                    paths.lock().expect("no panic").push(dir.path().to_owned());
                }
            });
        }
    });
    let mut paths = paths.into_inner().expect("no panic");
    paths.sort();
    paths.dedup();
    assert_eq!(paths.len(), 8);
    assert!(paths.iter().all(|path| RunDir::open(path).is_ok()));
}

#[test]
fn refuses_two_runs_in_one_folder() {
    let folder = Scratch::new("shared");
    let first = RunDir::create(folder.path()).expect("free");
    let error = RunDir::create(folder.path()).expect_err("taken").to_string();
    assert!(error.contains(&format!("process {}", std::process::id())), "{error}");
    drop(first);
    assert!(RunDir::create(folder.path()).is_ok());
}

#[test]
fn survives_the_lock_of_a_dead_process() {
    let folder = Scratch::new("dead");
    std::fs::create_dir_all(folder.path()).expect("temporary folder");
    std::fs::write(folder.join(LOCK), "999999999\n").expect("writable");
    assert!(RunDir::create(folder.path()).is_ok());
}

#[test]
fn refuses_foreign_folders_and_leaves_them_alone() {
    let folder = Scratch::new("foreign");
    std::fs::create_dir_all(folder.path()).expect("temporary folder");
    std::fs::write(folder.join("thesis.tex"), "years of work").expect("writable");
    let error = RunDir::create(folder.path()).expect_err("foreign").to_string();
    assert!(error.contains("thesis.tex") && error.contains("--out"), "{error}");
    assert_eq!(std::fs::read_dir(folder.path()).expect("readable").count(), 1);
}

/// A validation filled any folder, and its page took the place of a run's report.
#[test]
fn issue_what_is_made_of_runs_takes_no_folder_of_others() {
    const MARKS: &[&str] = &["page.json", "full/start-001"];
    let folder = Scratch::new("product");
    let path = folder.join("x");
    assert!(check_folder(&path, MARKS).is_ok() && !path.exists());
    write_run(&path);
    let error = check_folder(&path, MARKS).expect_err("a run").to_string();
    assert!(
        error.contains("a complete run of") && error.contains("x-2`") && !error.contains("can ,"),
        "{error}"
    );
    std::fs::remove_file(path.join(TRACE)).expect("it is there");
    assert_refused(check_folder(&path, MARKS), "holds a run without samples");
    let other = folder.join("other");
    std::fs::create_dir_all(&other).expect("writable");
    std::fs::write(other.join(".hidden"), "").expect("writable");
    assert!(check_folder(&other, MARKS).is_ok());
    std::fs::write(other.join("thesis.tex"), "years of work").expect("writable");
    let error = check_folder(&other, MARKS).expect_err("foreign").to_string();
    assert!(error.contains("thesis.tex") && error.contains("--out"), "{error}");
    // A command continues in its own output folder, whatever files were added.
    std::fs::create_dir_all(other.join("full/start-001")).expect("writable");
    assert!(check_folder(&other, MARKS).is_ok());
}

#[test]
fn behaves_a_run_that_never_starts_leaves_no_folder() {
    let folder = Scratch::new("never");
    drop(RunDir::create(folder.path()).expect("free"));
    assert!(!folder.path().exists());
}

#[test]
fn refuses_missing_and_broken_runs() {
    let folder = Scratch::new("broken");
    assert_refused(Run::read(folder.path()), "`scene.ron` is missing");
    write_run(folder.path());
    std::fs::write(folder.join(INFO), "{\"version\": 3").expect("writable");
    let error = Run::read(folder.path()).expect_err("broken").to_string();
    assert!(error.contains("run.json") && error.contains("line 1"), "{error}");
    let file = folder.join(SCENE);
    assert_refused(RunDir::create(file.join("x")), "--out");
    assert_refused(write_atomic(&file.join("x"), b""), "cannot write");
    assert!(partial_files(folder.path()).is_empty());
}

/// Names of files that were not written to their end.
fn partial_files(folder: &Path) -> Vec<String> {
    let names = std::fs::read_dir(folder).expect("a folder").flatten().map(|entry| entry.file_name());
    names.filter_map(|name| name.into_string().ok()).filter(|name| name.ends_with(PARTIAL)).collect()
}

#[test]
fn survives_many_writers_of_one_file() {
    let folder = Scratch::create("writers");
    let path = folder.join("campaign.ron");
    let text = |writer: usize| vec![b'a' + writer as u8; 20_000];
    std::thread::scope(|scope| {
        for writer in 0..8 {
            let path = &path;
            scope.spawn(move || {
                for _ in 0..40 {
                    write_atomic(path, &text(writer)).expect("another writer takes nothing away");
                    // Whole, whichever writer was last.
                    let there = std::fs::read(path).expect("there is always one");
                    assert_eq!(there, text(usize::from(there[0] - b'a')));
                }
            });
        }
    });
    assert!(partial_files(folder.path()).is_empty());
    // A target that cannot be replaced leaves nothing either.
    std::fs::create_dir_all(folder.join("taken/within")).expect("writable");
    assert_refused(write_atomic(&folder.join("taken"), b"x"), "cannot write");
    assert!(partial_files(folder.path()).is_empty());
}

#[test]
fn survives_files_that_a_killed_writer_left() {
    let folder = Scratch::new("left");
    write_run(folder.path());
    let own = format!(".run.json.{}-", std::process::id());
    // The names that this process takes next, and those of others.
    for name in (0..200).map(|n| format!("{own}{n}{PARTIAL}")).chain([".trace.npy.7-0.part".to_owned()]) {
        std::fs::write(folder.join(name), "{").expect("writable");
    }
    std::fs::write(folder.join(".notes.7-0.part"), "the owner's").expect("writable");
    write_atomic(&folder.join(INFO), b"{}").expect("it takes another name");
    super::files::remove_partial(folder.path()).expect("they can be removed");
    assert_eq!(partial_files(folder.path()), [".notes.7-0.part"]);
}

/// A run that was made longer kept the record of its machine, and was judged by its first tenth.
#[test]
fn issue_what_was_made_from_a_shorter_run_goes_when_it_goes_on() {
    let folder = Scratch::new("stale");
    let run = folder.join("x");
    write_run(&run);
    std::fs::create_dir_all(run.join(FIGURES)).expect("writable");
    let made = DERIVED.map(|name| run.join(name)).into_iter().chain([run.join(FIGURES).join("a.svg")]);
    let made: Vec<_> = made.collect();
    let mine = run.join(FIGURES).join("mine.txt");
    made.iter().chain([&mine]).for_each(|file| std::fs::write(file, "old").expect("writable"));
    let dir = RunDir::reopen(&run).expect("a run");
    assert!(made.iter().all(|file| file.exists()), "a run that has not gone on has all");
    dir.go_on(&Scene::default(), &info(Status::Running)).expect("writable");
    assert!(made.iter().all(|file| !file.exists()) && mine.exists() && dir.trace().exists());
}
