//! Records that are short, damaged, diverged or only a part, and folders that are no run.

use std::fs;

use stribeck_report as report;
use stribeck_store::run_info::Status;

use crate::synthetic::{self, INTERVAL_S};
use crate::{SAMPLES, close, read, whole};
use stribeck_testing::{Scratch, assert_refused};

#[test]
fn invariant_a_run_whose_mesh_cannot_be_read_has_a_report_without_its_pictures() {
    let folder = Scratch::new("no-mesh");
    synthetic::write(folder.path(), Status::Complete, 500);
    let file = folder.join("mesh.vtu");
    let sound = fs::read(&file).expect("readable");
    let with = |old: &str, new: &str| -> Vec<u8> {
        let at = sound.windows(old.len()).position(|window| window == old.as_bytes()).expect("it is there");
        [&sound[..at], new.as_bytes(), &sound[at + old.len()..]].concat()
    };
    let points = format!("NumberOfPoints=\"{}\"", synthetic::info(Status::Complete, 500).mesh.nodes);
    // A node far out, and all of them in one place, would ask for a picture of any size.
    let far = [&sound[..sound.len() / 2], &1e300_f64.to_le_bytes().repeat(sound.len() / 16)].concat();
    for (bytes, words) in [
        (None, "cannot read"),
        (Some(with("reference_m", "positions_m")), "no `reference_m`: a version"),
        (Some(sound[..sound.len() / 2].to_vec()), "it ends before"),
        (Some(with(&points, "NumberOfPoints=\"9\"")), "does not fit its counts"),
        (Some(far), "mesh.vtu"),
        (Some(sound.clone()), ""),
    ] {
        match &bytes {
            Some(bytes) => fs::write(&file, bytes).expect("writable"),
            None => fs::remove_file(&file).expect("it is there"),
        }
        let summary = report::write(folder.path()).expect("a report");
        let note = summary.notes.iter().find(|note| note.contains("no pictures of the mesh"));
        let page = read(folder.path(), "report.html");
        assert_eq!(note.is_some(), !words.is_empty(), "{words}: {:?}", summary.notes);
        assert!(note.is_none_or(|note| note.contains(words)), "{note:?} instead of {words}");
        assert_eq!(page.contains("<figure id=\"mesh\""), words.is_empty(), "{words}");
    }
    // The mesh of another run.
    let mut info = synthetic::info(Status::Complete, 500);
    info.mesh.nodes += 1;
    fs::write(folder.join("run.json"), serde_json::to_vec(&info).expect("JSON")).expect("writable");
    let summary = report::write(folder.path()).expect("a report");
    assert!(
        summary.notes.iter().any(|note| note.contains("it belongs to another run")),
        "{:?}",
        summary.notes
    );
}

#[test]
fn invariant_a_stretch_of_a_record_shows_what_the_whole_shows_there() {
    /// A median is cut off where the record is, and a path has no crossing before.
    const BY_ENDS_MS: f64 = 0.01;
    let (folder, all) = whole("stretch");
    let from_ms = all.events[0].exit_ms.expect("it leaves the defect") + 1.0;
    let part = report::write_between(folder.path(), 1e-3 * from_ms..f64::INFINITY).expect("a report");
    assert_eq!(part.run.samples, SAMPLES - (1e-3 * from_ms / INTERVAL_S).ceil() as usize);
    assert_eq!(part.events.iter().map(|e| e.roller).collect::<Vec<_>>(), [2, 3]);
    for (found, wanted) in part.events.iter().zip(&all.events[1..]) {
        close(found.entry_ms, wanted.entry_ms.expect("an entry"), BY_ENDS_MS, "entry");
        close(found.exit_ms, wanted.exit_ms.expect("an exit"), BY_ENDS_MS, "exit");
    }
    close(part.kinematics.cage_hz, all.kinematics.cage_hz.expect("a cage"), 1e-6, "cage");
    assert!(part.notes[..].iter().any(|n| n.contains("--from-s")), "{:?}", part.notes);
    assert!(all.notes.iter().all(|n| !n.contains("--from-s")), "{:?}", all.notes);
    close(Some(part.run.simulated_ms), 1e3 * INTERVAL_S * part.run.samples as f64, 1e-6, "time on record");
}

#[test]
fn refuses_a_stretch_that_holds_nothing_and_keeps_the_report() {
    let (folder, _) = whole("beyond");
    let before = read(folder.path(), "report.html");
    for (from_s, to_s, words) in [
        (5.0, f64::INFINITY, "is 0.02999 s long and holds nothing from 5 s on"),
        (f64::NEG_INFINITY, -1.0, "up to -1 s"),
        (5.0, 6.0, "from 5 to 6 s"),
    ] {
        assert_refused(report::write_between(folder.path(), from_s..to_s), words);
    }
    assert!(before == read(folder.path(), "report.html"), "the page changed");
}

#[test]
fn behaves_a_diverged_run_is_reported_with_a_banner_and_nothing_invented() {
    let folder = Scratch::new("diverged");
    // 4 ms: roller 1 has entered the defect and not left it.
    synthetic::write(folder.path(), Status::Diverged, 400);
    let summary = report::write(folder.path()).expect("a report");
    let page = read(folder.path(), "report.html");
    assert!(page.contains("This run diverged") && page.contains("near roller 1"), "no banner");
    assert_eq!(summary.events.len(), 1);
    assert!(summary.events[0].entry_ms.is_some() && summary.events[0].exit_ms.is_none());
    assert_eq!((summary.levels.impulse_g, summary.levels.between_filtered_g), (None, None));
    assert!(summary.notes.iter().any(|n| n.contains("until the record ends")), "{:?}", summary.notes);
    assert!(summary.notes.iter().any(|n| n.contains("no impulse level")), "{:?}", summary.notes);
}

#[test]
fn survives_a_trace_cut_inside_a_row_or_of_no_row() {
    for (name, samples, cut) in [("cut", 500, 12_345), ("none", 0, 0), ("one", 1, 0)] {
        let folder = Scratch::new(name);
        synthetic::write(folder.path(), Status::Interrupted, samples);
        let trace = folder.join("trace.npy");
        let length = fs::metadata(&trace).expect("a trace").len();
        let file = fs::OpenOptions::new().write(true).open(&trace).expect("a trace");
        file.set_len(length - cut).expect("a shorter trace");
        let summary = report::write(folder.path()).expect("a report");
        assert!(summary.run.samples + usize::from(cut > 0) <= samples, "{name}: {}", summary.run.samples);
        assert!(read(folder.path(), "report.html").contains("was interrupted"), "{name}");
        if samples < 2 {
            assert_eq!((summary.kinematics.cage_hz, summary.spectrum), (None, None), "{name}");
        }
    }
}

#[test]
fn survives_samples_after_a_bad_number() {
    let folder = Scratch::new("nan");
    synthetic::write(folder.path(), Status::Diverged, 300);
    let trace = folder.join("trace.npy");
    let mut bytes = fs::read(&trace).expect("a trace");
    // The last value of the last row but nine.
    let channels = 1 + 4 * 4 + 24 * 11 + 5;
    let at = bytes.len() - 9 * channels * 8 - 8;
    bytes[at..at + 8].copy_from_slice(&f64::NAN.to_le_bytes());
    fs::write(&trace, bytes).expect("a writable folder");
    let summary = report::write(folder.path()).expect("a report");
    assert_eq!(summary.run.samples, 290);
    assert!(summary.notes.iter().any(|n| n.contains("10 samples")), "{:?}", summary.notes);
}

#[test]
fn refuses_what_is_no_run_with_advice() {
    let folder = Scratch::new("absent");
    let error = report::write(folder.path()).expect_err("nothing there").to_string();
    assert!(error.contains("is not a run") && error.contains("`scene.ron` is missing"), "{error}");
    synthetic::write(folder.path(), Status::Complete, 10);
    fs::write(folder.join("trace.npy"), "no trace").expect("a writable folder");
    assert_refused(report::write(folder.path()), "trace.npy");
    assert!(!folder.join("report.html").exists());
}
