//! Many starts made of closed forms: the numbers of all of them together, and the page that is made from
//! their files.

mod synthetic;

use std::fs;
use std::path::Path;

use stribeck_analysis::ensemble::{Ended, EnsembleSummary, Merged};
use stribeck_report as report;
use stribeck_scene::ensemble::start;
use stribeck_scene::scene::Scene;
use stribeck_store::run_info::Status;
use stribeck_testing::{Scratch, assert_has, assert_refused};

/// Five starts: three complete, as loud as given; one diverged; one that could not be run.
fn ensemble(name: &str, gains: [f64; 3]) -> (Scratch, EnsembleSummary) {
    let folder = Scratch::new(name);
    synthetic::write_ensemble(folder.path(), &gains, 5);
    let summary = report::write_ensemble(folder.path()).expect("a report");
    (folder, summary)
}

fn json(folder: &Path) -> serde_json::Value {
    let text = fs::read_to_string(folder.join("summary.json")).expect("readable");
    serde_json::from_str(&text).expect("valid")
}

#[test]
fn planted_numbers_of_three_starts_that_differ_by_their_gain() {
    let (folder, summary) = ensemble("gains", [0.8, 1.0, 1.2]);
    assert_eq!((summary.count(Ended::Complete), summary.count(Ended::Diverged)), (3, 1));
    assert_eq!((summary.starts[4].ended, summary.starts[3].ended), (Ended::Failed, Ended::Diverged));
    let said = summary.notes.join("\n");
    assert_has(&said, &["start 4 diverged", "energy imbalance", "start 5 failed", "no equilibrium"]);

    // Start angles move impulses between samples, so that peaks differ by a little more than the gains.
    let peak = summary.number("levels.exit_g").expect("three");
    let of_each: Vec<f64> = summary.starts[..3].iter().map(|s| s.exit_g.expect("complete")).collect();
    assert!((peak.mean - of_each.iter().sum::<f64>() / 3.0).abs() < 1e-9, "{peak:?}");
    assert_eq!((peak.least, peak.median, peak.most), (of_each[0], of_each[1], of_each[2]));
    assert_eq!((peak.count, peak.of), (3, 3));
    // Student's t of two degrees of freedom, (2p − 1)/√(2p(1 − p)) at p = 0.975, is 4.302653.
    let spread: f64 = of_each.iter().map(|v| (v - peak.mean).powi(2)).sum();
    let half = 4.302_653 * (spread / 2.0 / 3.0).sqrt();
    assert!((peak.high.expect("three") - peak.mean - half).abs() < 1e-6 * half, "{peak:?}");

    // The same under its name in summary.json, for whoever reads it with other tools.
    let file = json(folder.path());
    assert_eq!(file["ensemble"]["levels"]["exit_g"]["mean"].as_f64(), Some(peak.mean));
    assert_eq!(file["ensemble"]["levels"]["exit_g"]["low"].as_f64(), peak.low);
    assert_eq!(file["starts"].as_array().map(Vec::len), Some(5));
    assert!(file.get("levels").is_none(), "numbers of one start would be taken for those of all");

    // Three rollers cross in every start; none touches a floor, because the synthetic one carries nothing
    // there.
    let events = summary.ensemble.items("events");
    assert_eq!(events.len(), 3);
    assert_eq!(events[2].get("roller"), Some(&Merged::Same(3.into())));
    assert_eq!(events[0].number("entry_ms").map(|s| s.count), Some(3));
    assert_eq!(events[0].get("floor_ms"), Some(&Merged::Nothing));
    let Some(Merged::Share(found)) = summary.ensemble.items("families")[0].get("found") else {
        panic!("no verdict")
    };
    assert_eq!(found.of, 3);
}

#[test]
fn behaves_the_page_says_first_what_is_chosen_and_how_much_starts_scatter() {
    let (folder, _) = ensemble("page", [0.9, 1.0, 1.1]);
    let page = fs::read_to_string(folder.join("report.html")).expect("a page");
    let place = |words: &str| page.find(words).unwrap_or_else(|| panic!("`{words}` is missing"));
    let order = [
        "3 of 5 starts are complete",
        "Calibrated.",
        "an out-of-plane thickness of 30 mm",
        "Predicted.",
        "Scatter of starts.",
        "Events.",
        "The paper, figure by figure",
        "Ours, mean ± 95 %",
        "Mean ± 95 %",
        "id=\"levels\"",
        "id=\"spectra\"",
        "id=\"forces\"",
        "start-004",
        "Seed",
    ];
    let places = order.map(place);
    assert!(places.is_sorted(), "{places:?}");
    for figure in
        ["levels", "acceleration", "spectrum", "spectrum-zoom", "events", "force-1", "paper-2", "paper-8c"]
    {
        let file = folder.join("figures").join(format!("{figure}.svg"));
        assert!(file.exists(), "{} is missing", file.display());
    }
    assert!(!page.contains(">NaN") && !page.contains(" NaN "), "a number is none");
}

#[test]
fn invariant_the_same_starts_give_the_same_page() {
    let (folder, _) = ensemble("again", [0.9, 1.0, 1.1]);
    let names = ["report.html", "summary.json", "figures/levels.svg", "figures/spectrum.svg"];
    let bytes = || names.map(|name| fs::read(folder.join(name)).expect("readable"));
    let before = bytes();
    for name in ["report.html", "summary.json"] {
        fs::remove_file(folder.join(name)).expect("removable");
    }
    fs::remove_dir_all(folder.join("figures")).expect("removable");
    report::write_ensemble(folder.path()).expect("a report");
    assert!(bytes() == before, "another page from the same files");
}

#[test]
fn survives_starts_that_are_cut_off_or_changed() {
    let (folder, _) = ensemble("damaged", [0.9, 1.0, 1.1]);
    let trace = folder.join("start-001/trace.npy");
    let bytes = fs::read(&trace).expect("readable");
    fs::write(&trace, &bytes[..bytes.len() / 2]).expect("writable");
    // A start that was made of another scene, and one whose scene is no scene.
    let other = Scene::default().with_overrides(&["operation.load_n=40000"]).expect("valid");
    fs::remove_dir_all(folder.join("start-002")).expect("removable");
    synthetic::write_scene(&folder.join("start-002"), &start(&other, 5, 2), Status::Complete, 300, 1.0);
    fs::write(folder.join("start-003/scene.ron"), "(mesh: (size_mm: -1").expect("writable");
    let summary = report::write_ensemble(folder.path()).expect("a report");
    assert_eq!(summary.count(Ended::Complete), 0);
    let said = summary.notes.join("\n");
    assert_has(
        &said,
        &[
            "start 1 failed",
            "cut off",
            "start 2 failed",
            "differs in more than what is drawn",
            "start 3 failed",
        ],
    );
    assert_eq!(summary.ensemble, Merged::Nothing);
}

#[test]
fn refuses_an_ensemble_whose_scene_was_changed() {
    let (folder, _) = ensemble("changed", [0.9, 1.0, 1.1]);
    let scene = folder.join("scene.ron");
    let text = fs::read_to_string(&scene).expect("readable");
    fs::write(&scene, text.replace("load_n: 50000.0", "load_n: 40000.0")).expect("writable");
    assert_refused(report::write_ensemble(folder.path()), "was changed after the run");
    fs::write(folder.join("ensemble.json"), "{\"seed\": ").expect("writable");
    assert_refused(report::write_ensemble(folder.path()), "ensemble.json");
}
