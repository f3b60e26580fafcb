//! Both models of one scene beside each other, as their users see it.

use std::fs;
use std::ops::Deref;
use std::process::Command;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};

use crate::common::{Desk, STRIBECK};
use serde_json::Value;
use stribeck_analysis::agreement::Agreement;
use stribeck_scene::scene::Scene;
use stribeck_store::run_dir::Run;
use stribeck_store::trace::{Trace, TraceWriter};
use stribeck_testing::{said, says};

/// The paper's bearing, coarse, dry and short.
const SCENE: &str = "(
    name: \"coarse\",
    model: reduced(modes_khz: 15.0),
    bearing: (thickness_mm: 20.0),
    mesh: (size_mm: 4.0, roller_facets: 88),
    cage: (pocket: corners),
    contact: (points_per_facet: 4),
    film: None,
    solver: (duration_ms: 3.0, mass_damping_per_s: 5000.0, structural_damping: None),
    output: (frames: None),
)";

/// What validates the scene with two starts.
const VALIDATE: [&str; 5] = ["validate", "scene.ron", "--starts=2", "--jobs=2", "--threads=1"];

fn desk(name: &str) -> Desk {
    let desk = Desk::new(name);
    fs::write(desk.join("scene.ron"), SCENE).unwrap();
    desk
}

/// A folder in which both models have run from two starts, shared by the tests that wait for their turn in it.
struct Validated {
    desk: Arc<Desk>,
    _turn: MutexGuard<'static, ()>,
}

impl Deref for Validated {
    type Target = Desk;

    fn deref(&self) -> &Desk {
        &self.desk
    }
}

fn validated() -> Validated {
    static SHARED: Mutex<Weak<Desk>> = Mutex::new(Weak::new());
    static TURN: Mutex<()> = Mutex::new(());
    let mut shared = SHARED.lock().unwrap_or_else(PoisonError::into_inner);
    let desk = shared.upgrade().unwrap_or_else(|| {
        let desk = Arc::new(desk("validated"));
        let first = desk.succeeds(&VALIDATE);
        let words = ["4 runs to make", "forces on the rollers", "mean load on the rollers", "processor time"];
        says(&first, &words);
        *shared = Arc::downgrade(&desk);
        desk
    });
    drop(shared);
    Validated { desk, _turn: TURN.lock().unwrap_or_else(PoisonError::into_inner) }
}

/// The scene of the shared reduced run, and that run.
fn reduced(desk: &Desk) -> (Scene, impl Fn() -> Run) {
    let path = desk.join("runs/coarse-validation/reduced/start-001");
    (Scene::read(path.join("scene.ron")).unwrap(), move || Run::read(&path).unwrap())
}

#[test]
fn analytic_both_models_carry_the_load_of_the_scene() {
    // Statics bind both (THEORY §6.2).
    let desk = validated();
    let table = desk.json("runs/coarse-validation/validation.json");
    let off = |name: &str| {
        let rows = table["rows"].as_array().unwrap();
        let row = rows.iter().find(|row| row["name"] == name).unwrap_or_else(|| panic!("{name}: {table}"));
        row["difference"]["mean"].as_f64().unwrap()
    };
    assert!(off("load_percent").abs() < 1.0 && off("forces_percent") < 5.0, "{table}");
}

#[test]
fn behaves_existing_runs_are_not_repeated_and_make_the_same_page() {
    let desk = validated();
    let page = desk.text("runs/coarse-validation/report.html");
    says(&desk.succeeds(&VALIDATE), &["0 runs to make"]);
    assert_eq!(desk.text("runs/coarse-validation/report.html"), page);
    // Another seed makes other starts, which have no place here.
    let other = [&VALIDATE[..], &["--seed=2"]].concat();
    desk.refuses(&other, &["holds a run of another scene, seed or duration"]);
}

#[test]
fn behaves_other_modes_are_compared_with_the_full_runs_that_are_there() {
    let desk = validated();
    let with = |more: &[&'static str]| [&VALIDATE[..], more].concat();
    const FULL: &str = "--full=runs/coarse-validation/full";
    let fewer = desk.succeeds(&with(&["--set=model.modes_khz=10", FULL, "--out=others/fewer"]));
    says(&fewer, &["2 runs to make", "forces on the rollers"]);
    assert!(!desk.join("others/fewer/full").exists());
    let lighter = with(&["--set=operation.load_n=40000", FULL, "--out=others/lighter"]);
    desk.refuses(&lighter, &["full/start-001", "another scene, seed or duration", "`--full`"]);
    let same = with(&["--full=runs/coarse-validation/reduced"]);
    desk.refuses(&same, &["`--full` is where runs of the reduced model go"]);
}

#[test]
fn behaves_the_page_of_a_reduced_run_states_the_measured_error() {
    let desk = validated();
    let near = ["simulate", "scene.ron", "--set", "operation.load_n=45000", "--out=runs/near", "--threads=1"];
    desk.succeeds(&near);
    let page = desk.text("runs/near/report.html");
    assert!(page.contains("differs in operation.load_n (45000 here, 50000 there)"), "{page}");
    // From the folder that holds both, too, where its name has no folder before it.
    let mut report = Command::new(STRIBECK);
    let report = report.current_dir(desk.join("runs")).args(["report", "near"]).output().expect("it starts");
    assert!(report.status.success(), "{}", said(&report));
    assert_eq!(desk.text("runs/near/report.html"), page);
    desk.succeeds("simulate scene.ron --out=alone/run --threads=1");
    assert!(desk.text("alone/run/report.html").contains("no validation of a scene like it"));
}

#[test]
fn invariant_a_run_agrees_with_itself() {
    let desk = validated();
    let (scene, own) = reduced(&desk);
    let same = Agreement::of(&scene, &[[own(), own()]]).unwrap();
    assert!(same.failures().next().is_none() && same.rows.iter().all(|row| row.difference.most.abs() < 1e-9));
    assert!(
        same.correlations.len() == 2 && same.correlations.iter().all(|c| (c.value.mean - 1.0).abs() < 1e-9)
    );
    assert!(same.peaks.len() == scene.output.sensors.len());
    assert!(same.peaks.iter().all(|p| p.full_g == p.reduced_g && p.difference_percent() == (0.0, None)));
    // One start has no scatter, and decides nothing.
    assert!(same.rows.iter().all(|row| !row.decided));
    let twice = Agreement::of(&scene, &[[own(), own()], [own(), own()]]).unwrap();
    assert!(twice.rows.iter().all(|row| row.decided && row.within), "{twice:?}");
}

/// The full run is sampled five times as often, and agrees with the means of its own samples.
#[test]
fn invariant_a_run_agrees_with_the_means_of_its_samples() {
    let desk = validated();
    let (scene, _) = reduced(&desk);
    let full = desk.join("runs/coarse-validation/full/start-001");
    let coarse = fivefold(&full, &desk.join("coarse"));
    let thinned = Agreement::of(&scene, &[[Run::read(&full).unwrap(), coarse]]).unwrap();
    for name in ["forces_percent", "load_percent"] {
        let off = thinned.rows.iter().find(|row| row.name == name).unwrap();
        assert!(off.difference.mean.abs() < 1e-9, "{off:?}");
    }
    let correlations = &thinned.correlations;
    assert!(correlations.iter().all(|c| (c.value.mean - 1.0).abs() < 1e-9), "{correlations:?}");
    // Third octaves of the two differ by what sampling aliases down, and by little else at 500 Hz.
    let octaves = &thinned.sensors[0];
    assert!((octaves.reduced_db[0] - octaves.full_db[0]).abs() < 0.5, "{octaves:?}");
}

/// Forces and accelerations that are 2 % larger: 2 % of the load, 20 lg 1.02 dB in every band, and 2 % of the
/// largest acceleration.
#[test]
fn by_hand_a_change_of_two_per_cent_is_reported() {
    let desk = validated();
    let (scene, own) = reduced(&desk);
    let (path, louder) = (desk.join("runs/coarse-validation/reduced/start-001"), desk.join("louder"));
    fs::create_dir(&louder).unwrap();
    for name in ["scene.ron", "run.json", "energy.npy"] {
        fs::copy(path.join(name), louder.join(name)).unwrap();
    }
    let trace = Trace::read(path.join("trace.npy")).unwrap();
    let gain = |name: &String| {
        let louder = name.contains("_fx_n") || name.contains("_fy_n") || name.contains("_m_s2");
        if louder { 1.02 } else { 1.0 }
    };
    let gains: Vec<f64> = trace.names.iter().map(gain).collect();
    let mut writer = TraceWriter::create(louder.join("trace.npy"), &trace.names).unwrap();
    for n in 0..trace.len() {
        let row: Vec<f64> = trace.columns.iter().zip(&gains).map(|(column, gain)| gain * column[n]).collect();
        writer.push(&row).unwrap();
    }
    writer.finish().unwrap();
    let other = Agreement::of(&scene, &[[own(), Run::read(&louder).unwrap()]]).unwrap();
    let of = |name: &str| other.rows.iter().find(|row| row.name == name).unwrap();
    assert!((of("load_percent").difference.mean - 2.0).abs() < 1e-9 && !of("load_percent").within);
    let side = of(&format!("octaves_{}_db", scene.output.sensors[0].name));
    assert!((side.difference.mean - 20.0 * 1.02_f64.log10()).abs() < 1e-9, "{side:?}");
    assert!(other.peaks.iter().all(|p| (p.difference_percent().0 - 2.0).abs() < 1e-9), "{:?}", other.peaks);
    // 2 % of the root mean square of all forces.
    assert!((0.05..2.0).contains(&of("forces_percent").difference.mean));
}

/// A copy of a run, sampled a fifth as often.
fn fivefold(from: &std::path::Path, to: &std::path::Path) -> Run {
    fs::create_dir(to).unwrap();
    for name in ["scene.ron", "energy.npy"] {
        fs::copy(from.join(name), to.join(name)).unwrap();
    }
    let mut info: Value = serde_json::from_slice(&fs::read(from.join("run.json")).unwrap()).unwrap();
    info["interval_s"] = (5.0 * info["interval_s"].as_f64().unwrap()).into();
    info["samples"] = (info["samples"].as_u64().unwrap() / 5).into();
    fs::write(to.join("run.json"), info.to_string()).unwrap();
    let trace = Trace::read(from.join("trace.npy")).unwrap();
    let mut writer = TraceWriter::create(to.join("trace.npy"), &trace.names).unwrap();
    for n in 0..trace.len() / 5 {
        let of = |(name, column): (&String, &Vec<f64>)| {
            let part = &column[5 * n..5 * (n + 1)];
            let is_mean = !name.contains("instant") && (name.ends_with("_n") || name.ends_with("_m_s2"));
            if is_mean { part.iter().sum::<f64>() / 5.0 } else { part[4] }
        };
        writer.push(&trace.names.iter().zip(&trace.columns).map(of).collect::<Vec<f64>>()).unwrap();
    }
    writer.finish().unwrap();
    Run::read(to).unwrap()
}

#[test]
fn refuses_scenes_that_the_reduced_model_cannot_have() {
    let desk = desk("validate-refused");
    let of = |set| ["validate", "scene.ron", "--set", set, "--starts=1"];
    desk.refuses(&of("solver.start=sudden"), &["`solver.start` is `sudden`", "the reduced model"]);
    desk.refuses(&of("solver.duration_ms=1.9"), &["solver.duration_ms", "1.9", "at least 2"]);
    desk.refuses("validate", &["<SCENE>"]);
    // A run may take half an hour: all of this is refused before the first.
    assert!(!desk.join("runs").exists());
}

/// Its page had plots without a line in them.
#[test]
fn issue_a_record_that_holds_no_third_octaves_says_so() {
    let desk = desk("validate-short");
    let words = ["validate", "scene.ron", "--set=solver.duration_ms=2.0", "--starts=1", "--threads=1"];
    let short = desk.succeeds(&words);
    says(&short, &["third octaves are compared on records of 2.3 ms at least, all of them of 27 ms"]);
    assert!(!desk.text("runs/coarse-validation/report.html").contains("Third octaves at"));
}

#[test]
fn refuses_to_compare_a_run_that_diverged() {
    let desk = desk("validate-diverged");
    let words = ["validate", "scene.ron", "--starts=1", "--threads=2", "--set=solver.time_step_factor=1.5"];
    desk.refuses(&words, &["full/start-001", "did not come to its end"]);
}

/// `validate` and `analyse` put their page in the place of a run's report, and `campaign` its runs among what
/// lay in a folder.
#[test]
fn issue_no_command_writes_over_a_run_or_among_foreign_files() {
    let desk = Desk::new("products");
    fs::write(desk.join("scene.ron"), SCENE).unwrap();
    desk.succeeds("simulate scene.ron --set=solver.duration_ms=0.3 --out=runs/mine");
    let campaign = "(name: \"c\", scene: \"scene.ron\", set: [\"solver.duration_ms=0.3\"], variants: grid([
        (field: \"operation.load_n\", values: [20000]),
    ]))";
    fs::write(desk.join("c.ron"), campaign).unwrap();
    let table: String = (0..4000).map(|n| format!("{}\n", f64::from(n).sin())).collect();
    fs::write(desk.join("a.csv"), format!("x\n{table}")).unwrap();
    fs::create_dir(desk.join("thesis")).unwrap();
    fs::write(desk.join("thesis/campaign.ron"), campaign).unwrap();
    let files = |folder: &str| {
        let entries = fs::read_dir(desk.join(folder)).unwrap().flatten();
        let mut files: Vec<_> = entries.map(|e| (e.file_name(), fs::read(e.path()).ok())).collect();
        files.sort();
        files
    };
    let before = ["runs/mine", "thesis"].map(files);
    for command in [
        &["validate", "scene.ron", "--starts=1"][..],
        &["analyse", "a.csv", "--rate-hz=1000"],
        &["analyse", "a.csv", "a.csv", "--rate-hz=1000"],
        &["campaign", "c.ron"],
    ] {
        for (out, words) in
            [("runs/mine", ["a complete run", "runs/mine-2"]), ("thesis", ["campaign.ron", "--out"])]
        {
            let refused = desk.run(&[command, &["--out", out]].concat());
            assert!(!refused.status.success(), "{command:?} {out}: {}", said(&refused));
            says(&refused, &words);
        }
    }
    assert_eq!(before, ["runs/mine", "thesis"].map(files));
    // Folders of users are left alone, and no run is put there.
    for (command, words) in [
        (&["analyse", "a.csv", "--rate-hz=1000"][..], "report"),
        (&["analyse", "a.csv", "a.csv", "--rate-hz=1000", "--out=both"], "report: both"),
        (&["campaign", "c.ron", "--out=runs/c"], "1 of 1"),
    ] {
        for _ in 0..2 {
            says(&desk.run(command), &[words]);
        }
    }
    desk.refuses("simulate scene.ron --out=runs/c", &["files of something else", "--out"]);
}
