//! One run over several ranks writes the bytes of one process, and goes on from a checkpoint over any other
//! number of them.

mod common;

use std::{fs, ops::ControlFlow, path::Path};

use common::{coarse, host, ranks::together};
use stribeck_scene::scene::{Scene, Start};
use stribeck_simulation::run::host::{Host, Progress};
use stribeck_simulation::{follow, resume, simulate};
use stribeck_store::{run_dir::RunDir, run_info::Status};
use stribeck_testing::Scratch;

/// Runs a scene, or the rest of the run in the folder, over `count` ranks; breaks off after `samples` unless
/// that is zero.
fn run(scene: Option<&Scene>, folder: &Path, ranks: usize, threads: usize, samples: usize) {
    let mut seen = 0;
    let mut watch = |progress: &Progress| {
        seen += usize::from(progress.phase == "run");
        if seen == samples { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let mut lead = |host: Host<'_>| match scene {
        Some(scene) => simulate(scene, &RunDir::create(folder).expect("a new folder"), &host, &mut watch),
        None => resume(&RunDir::reopen(folder).expect("a run"), &host, &mut watch),
    };
    let info = match ranks {
        0 => lead(host(threads)),
        _ => together(
            ranks,
            |ranks| lead(Host { ranks: Some(ranks), ..host(threads) }),
            |ranks| follow(&Host { ranks: Some(ranks), ..host(threads) }).expect("the scene is sound"),
        ),
    };
    let wanted = if samples == 0 { Status::Complete } else { Status::Interrupted };
    assert_eq!(info.expect("the scene is sound").status, wanted);
}

/// A bearing whose bytes are looked at, and nothing else: with the fewest elements that turn.
fn bytes_alone() -> Scene {
    let mut scene = coarse(0.3);
    (scene.mesh.size_mm, scene.mesh.roller_facets) = (4.0, 40);
    scene
}

/// A copy of an interrupted run.
fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).expect("writable");
    for entry in fs::read_dir(from).expect("a folder").flatten().filter(|entry| entry.file_name() != ".lock")
    {
        let (path, to) = (entry.path(), to.join(entry.file_name()));
        if path.is_dir() { copy(&path, &to) } else { fs::copy(path, to).map(drop).expect("writable") }
    }
}

/// The state in a checkpoint, behind what `run.json` says.
fn state(folder: &Path) -> Vec<u8> {
    fs::read(folder.join("checkpoint")).expect("a checkpoint")
}

fn assert_same(whole: &Path, other: &Path, how: &str) {
    for name in ["trace.npy", "energy.npy"] {
        assert!(fs::read(whole.join(name)).ok() == fs::read(other.join(name)).ok(), "{how}: another {name}");
    }
    for frame in fs::read_dir(whole.join("frames")).into_iter().flatten().flatten() {
        let same = fs::read(frame.path()).ok() == fs::read(other.join("frames").join(frame.file_name())).ok();
        assert!(same, "{how}: another {:?}", frame.file_name());
    }
}

/// Contact, friction, films, a cage that moves as one piece, structural damping, gravity: over 1, 2, 3 and 5
/// ranks, with one thread and two on each. The wall clock stands still and every sample is saved.
#[test]
fn invariant_any_number_of_ranks_writes_the_same_bytes() {
    let scene = bytes_alone();
    let folder = Scratch::new("ranks");
    let whole = folder.join("whole");
    run(Some(&scene), &whole, 0, 1, 0);
    for (ranks, threads) in [(1, 1), (2, 1), (3, 2), (5, 1)] {
        let other = folder.join(format!("{ranks}"));
        run(Some(&scene), &other, ranks, threads, 0);
        assert_same(&whole, &other, &format!("{ranks} ranks"));
        assert!(threads > 1 || state(&whole) == state(&other), "{ranks} ranks: another checkpoint");
    }
}

/// Bodies of several tiles, cut by ranks, in a scene whose elements are as fine as the paper's, mass damping
/// included.
#[test]
fn invariant_ranks_cut_through_bodies() {
    let mut scene = Scene { name: "cut".into(), ..Scene::default() };
    scene.solver.start = Start::Sudden;
    scene.solver.duration_ms = 0.03;
    (scene.solver.mass_damping_per_s, scene.output.frames) = (300.0, None);
    let folder = Scratch::new("cut");
    let whole = folder.join("whole");
    run(Some(&scene), &whole, 0, 1, 0);
    for ranks in [2, 5] {
        let other = folder.join(format!("{ranks}"));
        run(Some(&scene), &other, ranks, 1, 0);
        assert_same(&whole, &other, &format!("{ranks} ranks"));
        assert!(state(&whole) == state(&other), "{ranks} ranks: another checkpoint");
    }
}

/// A run of three ranks goes on over one, two, five, and in a process of its own.
#[test]
fn invariant_a_run_goes_on_over_other_ranks() {
    let scene = bytes_alone();
    let folder = Scratch::new("ranks on");
    let [whole, begun] = ["whole", "begun"].map(|name| folder.join(name));
    run(Some(&scene), &whole, 0, 1, 0);
    run(Some(&scene), &begun, 3, 1, 7);
    for ranks in [0, 1, 2, 5] {
        let pieces = folder.join(format!("{ranks}"));
        copy(&begun, &pieces);
        run(None, &pieces, ranks, 1, 9);
        run(None, &pieces, if ranks == 0 { 2 } else { 0 }, 1, 0);
        assert_same(&whole, &pieces, &format!("3, then {ranks} ranks"));
    }
}
