//! Both models of one scene beside each other, as their users see it.

use std::fs;
use std::process::{Command, Output, Stdio};

use serde_json::Value;
use stribeck_analysis::agreement::Agreement;
use stribeck_scene::scene::Scene;
use stribeck_store::run_dir::Run;
use stribeck_store::trace::{Trace, TraceWriter};
use stribeck_testing::{Scratch, said, says};

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

fn run(desk: &Scratch, words: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_stribeck"));
    command.current_dir(desk.path()).args(words).stdin(Stdio::null()).output().expect("it starts")
}

#[test]
fn behaves_both_models_from_the_same_starts() {
    let desk = Scratch::create("validate");
    fs::write(desk.join("scene.ron"), SCENE).unwrap();
    let words = ["validate", "scene.ron", "--starts=2", "--jobs=2", "--threads=1"];
    let first = run(&desk, &words);
    assert!(first.status.success(), "{}", said(&first));
    says(&first, &["4 runs to make", "forces on the rollers", "mean load on the rollers", "processor time"]);
    let folder = desk.join("runs/coarse-validation");
    let table: Value = serde_json::from_slice(&fs::read(folder.join("validation.json")).unwrap()).unwrap();
    let row = |name: &str| {
        let rows = table["rows"].as_array().unwrap();
        rows.iter().find(|row| row["name"] == name).unwrap_or_else(|| panic!("{name}: {table}")).clone()
    };
    // Statics bind both: the load is that of the scene.
    assert!(row("load_percent")["difference"]["mean"].as_f64().unwrap().abs() < 1.0, "{table}");
    assert!(row("forces_percent")["difference"]["mean"].as_f64().unwrap() < 5.0, "{table}");
    let page = fs::read(folder.join("report.html")).unwrap();

    // Existing runs are not repeated, and make the same page.
    let again = run(&desk, &words);
    says(&again, &["0 runs to make"]);
    assert_eq!(fs::read(folder.join("report.html")).unwrap(), page);

    // Another seed makes other starts, which have no place here.
    let other = run(&desk, &[&words[..], &["--seed=2"]].concat());
    assert!(!other.status.success());
    says(&other, &["holds a run of another scene, seed or duration"]);

    // Other modes are compared with the runs of the full model that are there.
    let fewer = ["--set=model.modes_khz=10", "--full=runs/coarse-validation/full", "--out=runs/fewer"];
    let fewer = run(&desk, &[&words[..], &fewer].concat());
    assert!(fewer.status.success(), "{}", said(&fewer));
    says(&fewer, &["2 runs to make", "forces on the rollers"]);
    assert!(!desk.join("runs/fewer/full").exists());
    let lighter =
        ["--set=operation.load_n=40000", "--full=runs/coarse-validation/full", "--out=runs/lighter"];
    let lighter = run(&desk, &[&words[..], &lighter].concat());
    assert!(!lighter.status.success());
    says(&lighter, &["full/start-001", "another scene, seed or duration", "`--full`"]);
    let same = run(&desk, &[&words[..], &["--full=runs/coarse-validation/reduced"]].concat());
    assert!(!same.status.success());
    says(&same, &["`--full` is where runs of the reduced model go"]);
    fs::remove_dir_all(desk.join("runs/fewer")).unwrap();
    fs::remove_dir_all(desk.join("runs/lighter")).unwrap();

    // The page of a reduced run beside it states its measured error.
    let near = ["simulate", "scene.ron", "--set", "operation.load_n=45000", "--out=runs/near", "--threads=1"];
    let near = run(&desk, &near);
    assert!(near.status.success(), "{}", said(&near));
    let page = fs::read_to_string(desk.join("runs/near/report.html")).unwrap();
    assert!(page.contains("differs in operation.load_n (45000.0 here, 50000.0 there)"), "{page}");
    // From the folder that holds both, too, where its name has no folder before it.
    let mut report = Command::new(env!("CARGO_BIN_EXE_stribeck"));
    let report = report.current_dir(desk.join("runs")).args(["report", "near"]).output().expect("it starts");
    assert!(report.status.success(), "{}", said(&report));
    assert_eq!(fs::read_to_string(desk.join("runs/near/report.html")).unwrap(), page);
    let alone = run(&desk, &["simulate", "scene.ron", "--out=alone/run", "--threads=1"]);
    assert!(alone.status.success(), "{}", said(&alone));
    let page = fs::read_to_string(desk.join("alone/run/report.html")).unwrap();
    assert!(page.contains("no validation of a scene like it"));

    // A run agrees with itself, and a change of its forces is reported.
    let path = folder.join("reduced/start-001");
    let scene = Scene::read(path.join("scene.ron")).unwrap();
    let own = || Run::read(&path).unwrap();
    let same = Agreement::of(&scene, &[[own(), own()]]).unwrap();
    assert!(same.failures().next().is_none() && same.rows.iter().all(|row| row.difference.most.abs() < 1e-9));
    assert!(
        same.correlations.len() == 2 && same.correlations.iter().all(|c| (c.value.mean - 1.0).abs() < 1e-9)
    );
    // The full run is sampled five times as often, and agrees with the means of its own samples.
    let fine = || Run::read(folder.join("full/start-001")).unwrap();
    let coarse = fivefold(&folder.join("full/start-001"), &desk.join("coarse"));
    let thinned = Agreement::of(&scene, &[[fine(), coarse]]).unwrap();
    for name in ["forces_percent", "load_percent"] {
        let off = thinned.rows.iter().find(|row| row.name == name).unwrap();
        assert!(off.difference.mean.abs() < 1e-9, "{off:?}");
    }
    assert!(
        thinned.correlations.iter().all(|c| (c.value.mean - 1.0).abs() < 1e-9),
        "{:?}",
        thinned.correlations
    );
    // Third octaves of the two differ by what sampling aliases down, and by little else at 500 Hz.
    let octaves = &thinned.sensors[0];
    assert!((octaves.reduced_db[0] - octaves.full_db[0]).abs() < 0.5, "{octaves:?}");
    // One start has no scatter, and decides nothing.
    assert!(same.rows.iter().all(|row| !row.decided));
    let twice = Agreement::of(&scene, &[[own(), own()], [own(), own()]]).unwrap();
    assert!(twice.rows.iter().all(|row| row.decided && row.within), "{twice:?}");
    let louder = desk.join("louder");
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
    // So is the largest acceleration, and that of a run beside itself is its own.
    assert!(same.peaks.len() == scene.output.sensors.len());
    assert!(same.peaks.iter().all(|p| p.full_g == p.reduced_g && p.difference_percent() == (0.0, None)));
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
    let desk = Scratch::create("validate-refused");
    fs::write(desk.join("scene.ron"), SCENE).unwrap();
    let sudden = run(&desk, &["validate", "scene.ron", "--set", "solver.start=sudden"]);
    assert!(!sudden.status.success());
    says(&sudden, &["`solver.start` is `sudden`", "the reduced model"]);
    let short = run(&desk, &["validate", "scene.ron", "--set", "solver.duration_ms=1.9", "--starts=1"]);
    assert!(!short.status.success());
    says(&short, &["solver.duration_ms", "1.9", "at least 2"]);
    // A run may take half an hour: all of this is refused before the first.
    assert!(!desk.join("runs").exists());
}

/// Its page had plots without a line in them.
#[test]
fn issue_a_record_that_holds_no_third_octaves_says_so() {
    let desk = Scratch::create("validate-short");
    fs::write(desk.join("scene.ron"), SCENE).unwrap();
    let words = ["validate", "scene.ron", "--set=solver.duration_ms=2.0", "--starts=1", "--threads=1"];
    let short = run(&desk, &words);
    assert!(short.status.success(), "{}", said(&short));
    says(&short, &["third octaves are compared on records of 2.3 ms at least, all of them of 27 ms"]);
    let page = fs::read_to_string(desk.join("runs/coarse-validation/report.html")).unwrap();
    assert!(!page.contains("Third octaves at"));
}

#[test]
fn refuses_to_compare_a_run_that_diverged() {
    let desk = Scratch::create("validate-diverged");
    fs::write(desk.join("scene.ron"), SCENE).unwrap();
    let words = ["validate", "scene.ron", "--starts=1", "--threads=2", "--set=solver.time_step_factor=1.5"];
    let diverged = run(&desk, &words);
    assert!(!diverged.status.success());
    says(&diverged, &["full/start-001", "did not come to its end"]);
    let nothing = run(&desk, &["validate"]);
    assert!(!nothing.status.success());
    says(&nothing, &["<SCENE>"]);
}

/// `validate` and `analyse` put their page in the place of a run's report, and `campaign` its runs among what
/// lay in a folder.
#[test]
fn issue_no_command_writes_over_a_run_or_among_foreign_files() {
    let desk = Scratch::create("products");
    fs::write(desk.join("scene.ron"), SCENE).unwrap();
    let made = run(&desk, &["simulate", "scene.ron", "--set=solver.duration_ms=0.3", "--out=runs/mine"]);
    assert!(made.status.success(), "{}", said(&made));
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
            let refused = run(&desk, &[command, &["--out", out]].concat());
            assert!(!refused.status.success(), "{command:?} {out}: {}", said(&refused));
            says(&refused, &words);
        }
    }
    assert_eq!(before, ["runs/mine", "thesis"].map(files));
    // Folders of users are left alone, and no run is put there.
    for (command, words) in [
        (&["analyse", "a.csv", "--rate-hz=1000"][..], "report"),
        (&["analyse", "a.csv", "a.csv", "--rate-hz=1000", "--out=both"], "side by side"),
        (&["campaign", "c.ron", "--out=runs/c"], "1 of 1"),
    ] {
        for _ in 0..2 {
            says(&run(&desk, command), &[words]);
        }
    }
    let refused = run(&desk, &["simulate", "scene.ron", "--out=runs/c"]);
    assert!(!refused.status.success());
    says(&refused, &["files of something else", "--out"]);
}
