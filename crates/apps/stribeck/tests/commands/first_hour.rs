//! The first hour of somebody new, from an empty folder: a scene of one's own, two runs compared, a sweep, a
//! sound, and what lies below `runs/`; each with the mistakes that are made most often.

use std::fs;
use std::io::Write;
use std::process::{Output, Stdio};

use crate::common::{COARSE, Desk, command};
use stribeck_formats::{Channel, Recording, mat5};
use stribeck_testing::{Noise, assert_has, said, says};

/// A very coarse bearing, from rest, for 0.3 ms.
const SHORT: [&str; 5] = {
    let [size, facets, start, frames] = COARSE;
    [size, facets, start, frames, "--set=solver.duration_ms=0.3"]
};

/// Runs the coarse scene.
fn simulate(desk: &Desk, out: &str, words: &[&str]) {
    let out = format!("--out=runs/{out}");
    let own = ["simulate", "quick.ron", "--threads=1", "--no-report", &out];
    desk.succeeds(&[&own[..], &SHORT, words].concat());
}

fn json(output: &Output) -> serde_json::Value {
    serde_json::from_slice(&output.stdout).unwrap_or_else(|why| panic!("{why}: {}", said(output)))
}

/// The scene that the README begins with, shorter: its spall is claimed at BPFO, and the page of the record
/// plays it.
#[test]
fn behaves_the_first_look_shows_its_spall() {
    let desk = Desk::new("first-look");
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../fixtures/scenes/first_look.ron");
    desk.succeeds(&["simulate", scene, "-q", "--no-report", "--set=solver.duration_ms=400"]);
    let found = json(&desk.succeeds("analyse first_look --json"));
    let claimed: Vec<&str> = found["families"]
        .as_array()
        .expect("families")
        .iter()
        .filter(|family| family["claimed"] == true)
        .filter_map(|family| family["name"].as_str())
        .collect();
    assert_eq!(claimed, ["BPFO"]);
    assert!(desk.text("first_look-analysis/report.html").contains("How it sounds"));
}

#[test]
fn behaves_runs_and_an_ensemble_beside_each_other() {
    let desk = Desk::with_scene("compare");
    simulate(&desk, "a", &[]);
    simulate(&desk, "b", &["--set=operation.load_n=20000"]);
    simulate(&desk, "c", &["--starts=3", "--jobs=1"]);
    let output = desk.succeeds("compare a b");
    says(&output, &["The scenes differ in 1 field: operation.load_n 50000 → 20000", "one signal each"]);
    let found = desk.json("a-and-b-compared/compare.json");
    assert_eq!(found["fields"][0]["values"][1], "20000");
    let row = |found: &serde_json::Value, name: &str| {
        found["rows"].as_array().and_then(|rows| rows.iter().find(|row| row["name"] == name)).cloned()
    };
    let force = row(&found, "support_n").expect("a force");
    assert_eq!(force["against_first"][0]["verdict"], "unknown");
    let page = desk.text("a-and-b-compared/report.html");
    assert_has(&page, &["What was changed", "Signals over time", "Force of all rollers on the outer ring"]);
    assert!(!page.contains("src=\"http") && !page.contains("href=\"http"), "the page needs a network");

    says(&desk.succeeds("compare a a --out=same"), &["The scenes are the same", "No number differs"]);

    // The run is one of the ensemble's scene, and has its forces within their scatter or not, which is said.
    desk.succeeds("compare c a b --out=all");
    let found = desk.json("all/compare.json");
    assert_eq!(
        (found["sides"][0]["kind"].as_str(), found["sides"][0]["signals"].as_u64()),
        (Some("ensemble"), Some(3))
    );
    let force = row(&found, "support_n").expect("a force");
    assert!(force["values"][0]["deviation"].is_number() && force["against_first"][1]["low"].is_number());
    // The same command writes its page again.
    desk.succeeds("compare c a b --out=all");
}

#[test]
fn refuses_what_cannot_be_compared() {
    let desk = Desk::with_scene("compare-refused");
    simulate(&desk, "a", &[]);
    fs::create_dir(desk.join("other")).expect("a folder");
    fs::write(desk.join("other/thesis.txt"), "text").expect("writable");
    desk.refuses("compare a bb", &["`bb` is no file and no run", "`a`"]);
    desk.refuses("compare a quick.ron", &["is a scene, and no run of it", "stribeck simulate"]);
    desk.refuses("compare a runs", &["is a folder, and no run"]);
    desk.refuses("compare a a --channel=left", &["no sensor channel contains `left`", "sensor."]);
    desk.refuses("compare a a --out=other", &["thesis.txt"]);
    desk.refuses(&[&["compare"][..], &["a"; 9]].concat(), &["9 sides were given", "compare fewer"]);
    assert!(!desk.join("other/compare.json").exists());
}

/// A plan for a script; the same numbers as for a person, and without a trial no cost.
#[test]
fn behaves_a_plan_is_written_for_scripts() {
    let desk = Desk::with_scene("plan-json");
    let plan = |words: &[&str]| json(&desk.succeeds(&[&["plan", "quick.ron", "--json"][..], words].concat()));
    let bare = plan(&["--no-trial"]);
    assert!(bare["cost"].is_null() && bare["loads"]["static_safety"].as_f64().is_some_and(|s| s > 5.0));
    assert!((bare["families_hz"]["bpfo"].as_f64().expect("a number") - 90.1).abs() < 0.1, "{bare}");
    let coarse = plan(&SHORT);
    let of = |path: &str| coarse.pointer(path).and_then(serde_json::Value::as_f64).expect(path);
    assert!(of("/cost/run/quiet_s") > 0.0 && of("/cost/run/busy_s") >= of("/cost/run/quiet_s"));
    assert!((of("/cost/steps") * of("/cost/step_us") / 300.0 - 1.0).abs() < 1e-6, "{coarse}");
    desk.refuses("plan absent.ron --json", &["absent.ron"]);
}

/// Impacts of an outer raceway of a 6205 at 1200 rpm.
pub(crate) fn impacts(height: f64, seed: u64) -> Vec<f64> {
    let mut noise = Noise::new(seed);
    (0..60_000)
        .map(|n| {
            let since = (f64::from(n) / 12_800.0).rem_euclid(1.0 / 71.5);
            noise.uniform() + height * (-since / 1e-3).exp() * (std::f64::consts::TAU * 3_000.0 * since).sin()
        })
        .collect()
}

#[test]
fn planted_a_sound_and_a_damaged_record() {
    let desk = Desk::new("compare-records");
    for (name, height) in [("sound.mat", 0.0), ("damaged.mat", 3.0)] {
        let channel = Channel::held("housing", impacts(height, 7)).in_unit(Some("g".to_owned()));
        mat5::write(&desk.join(name), &[channel], &[]).expect("writable");
    }
    let machine = ["--bearing=6205", "--speed-rpm=1200", "--rate-hz=12800", "--unit=g"];
    let output = desk.succeeds(&[&["compare", "sound.mat", "damaged.mat"][..], &machine].concat());
    says(&output, &["root mean square [g]", "a defect of the outer raceway (BPFO at 71.5"]);
    let page = desk.text("sound-and-damaged-compared/report.html");
    assert!(page.contains("Squared envelope spectra") && page.contains("sound none, damaged BPFO"));
    // The findings of one record, and nothing else, on standard output.
    let found = desk.succeeds(&[&["analyse", "damaged.mat", "--json", "-q"][..], &machine].concat());
    assert_eq!(json(&found)["families"][0]["claimed"], true);
    let both = desk.succeeds(&[&["analyse", "damaged.mat", "sound.mat", "--json"][..], &machine].concat());
    assert_eq!(json(&both)["records"].as_array().map(Vec::len), Some(2));
    let page = desk.text("damaged-analysis/report.html");
    assert!(page.contains("data:audio/wav;base64,"), "the record cannot be heard");
    // The same over the healthy one, and with the mistakes that are made with it.
    let over = |baseline: &str, more: &[&str]| {
        let own = ["analyse", "damaged.mat", "--out=over", "--baseline", baseline];
        desk.run(&[&own[..], &machine, more].concat())
    };
    let output = over("sound.mat", &["--baseline-rpm=1188"]);
    assert!(output.status.success(), "{}", said(&output));
    says(&output, &["the baseline turned at 1188.0 rpm"]);
    let page = desk.text("over/report.html");
    assert!(page.contains("In grey behind it: sound.mat") && page.contains("at the speed of this record"));
    says(
        &over("damaged.mat", &[]),
        &["the baseline `damaged.mat` is left out: by its own verdict it has a defect, BPFO"],
    );
    let output = over("absent.mat", &[]);
    assert!(!output.status.success());
    says(&output, &["--baseline absent.mat"]);
    desk.refuses("analyse damaged.mat --baseline-rpm=900", &["--baseline <FILE>"]);
}

#[test]
fn behaves_a_sweep_has_a_page_and_takes_further_values() {
    let desk = Desk::with_scene("sweep");
    let sweep = |values: &str| {
        let set = format!("--set=operation.load_n={values}");
        desk.succeeds(&[&["sweep", "quick.ron", "--threads=2", &set][..], &SHORT].concat())
    };
    says(&sweep("20000,30000"), &["2 of operation.load_n: 2 runs", "2 of 2 runs are complete", "index.html"]);
    let folder = "runs/quick-by-load_n";
    let runs = || fs::read_dir(desk.join(folder).join("runs")).expect("runs").count();
    assert_eq!(runs(), 2);
    says(&sweep("20000,30000,40000"), &["3 runs, 1 of them to be run here", "3 of 3 runs are complete"]);
    assert_eq!(runs(), 3);
    // Other values: the tables are theirs, and the runs stay for whoever asks for them again.
    says(&sweep("20000,50000"), &["2 runs, 1 of them to be run here"]);
    says(&sweep("20000,30000,40000"), &["3 runs, 0 of them to be run here"]);
    assert_eq!(runs(), 4);
    let fewer = [
        &["sweep", "quick.ron", "--keep=numbers", "--set=operation.load_n=60000,70000", "--out=few"][..],
        &SHORT,
    ]
    .concat();
    desk.succeeds(&fewer);
    let more = [
        &["sweep", "quick.ron", "--keep=all", "--set=operation.load_n=60000,70000", "--out=few"][..],
        &SHORT,
    ]
    .concat();
    desk.refuses(&more, &["made with `--keep numbers`", "give the same `--keep`"]);
    says(&desk.succeeds(&fewer), &["2 runs, 0 of them to be run here"]);
    // Names that a person can read lead to the runs, and commands take them.
    let named = |name: &str| desk.join(folder).join("by_name").join(name);
    assert!(
        named("2-load_n=30000").join("summary.json").exists()
            || named("2-load_n=30000").join("run.json").exists()
    );
    let by_name = format!("{folder}/by_name/3-load_n=40000");
    says(&desk.succeeds(&["report", &by_name]), &["report.html"]);
    let page = desk.text(&format!("{folder}/index.html"));
    assert_has(&page, &["Root mean square over the load", "<code>operation.load_n</code>", "runs.parquet"]);
    let table = Recording::open(desk.join(folder).join("runs.parquet")).expect("a table");
    assert!(table.channels.iter().any(|c| c.name == "summary.levels.record.kurtosis"), "{}", table.names());
    // Its file is a campaign like any other.
    let campaign = format!("{folder}/campaign.ron");
    says(&desk.succeeds(&["campaign", &campaign, "--out", folder]), &["3 runs, 0 of them to be run here"]);
    // Three bearings, one warning.
    let printed = desk.succeeds("sweep quick.ron '--set=bearing=NU 205,NU 206,NU 207' --print");
    assert_eq!(said(&printed).matches("warning:").count(), 1, "{}", said(&printed));
    let printed = desk.succeeds("sweep quick.ron --set=defect.ring=outer,inner --print");
    says(&printed, &["scene: \"quick.ron\"", "values: [outer, inner]"]);
}

#[test]
fn refuses_what_is_no_sweep() {
    let desk = Desk::with_scene("sweep-refused");
    let refuses =
        |set: &[&str], told: &[&str]| desk.refuses(&[&["sweep", "quick.ron"][..], set].concat(), told);
    refuses(&["--set=defect.length_mm=2,4000"], &["longer than the whole raceway"]);
    refuses(&["--set=operation.load_n=1,2", "--set=operation.load_n=3,4"], &["is set twice"]);
    refuses(&["--set=operation.load_n 1,2"], &["has no `=`"]);
    assert!(!desk.join("runs").exists(), "a refused sweep left a folder");
}

#[test]
fn behaves_a_run_is_heard() {
    let desk = Desk::with_scene("sound");
    simulate(&desk, "a", &[]);
    // Channels, samples a second, bits.
    let format = |name: &str| {
        let bytes = fs::read(desk.join(name)).expect(name);
        let half = |n: usize| u32::from(u16::from_le_bytes([bytes[n], bytes[n + 1]]));
        [half(22), half(24) | half(26) << 16, half(34)]
    };
    says(&desk.succeeds("export a --to=wav"), &["are a click", "sound.wav"]);
    assert_eq!(format("runs/a/sound.wav"), [1, 48_000, 16]);
    desk.succeeds("export a --to=wav --slow=500 --rate-hz=44100 --out=slow.wav");
    assert_eq!(format("slow.wav"), [1, 44_100, 16]);
    let slow = Recording::open(desk.join("slow.wav")).expect("a sound");
    let samples = slow.channels[0].read().expect("samples");
    // 30 samples at 100 kHz, 500 times slower.
    assert_eq!(samples.len(), (0.3e-3_f64 * 500.0 * 44_100.0).round() as usize);
    let peak = samples.iter().fold(0.0_f64, |most, x| x.abs().max(most));
    assert!((0.88..0.9).contains(&peak), "{peak}");
    let sensor = "--sensor=rate_hz=50000, range=5000, bits=16";
    desk.succeeds(&["export", "a", "--to=wav", sensor, "--channel=ay_m_s2", "--out=recorded.wav"]);
    assert_eq!(format("recorded.wav")[1..], [50_000, 16]);

    desk.refuses("export a --to=wav --slow=0.5", &["1 to 1000 times slower"]);
    desk.refuses("export a --to=csv --slow=2", &["use it with `--to wav`"]);
    desk.refuses("export a --to=wav --channel=left", &["no channel contains `left`"]);
    desk.refuses("export a --to=wav '--sensor=rate_hz=50000, bits=16'", &["the range must be above 0"]);
}

#[test]
fn behaves_a_scene_of_ones_own_is_written_once() {
    let desk = Desk::new("new");
    let made = desk.succeeds("new '--bearing=SKF NU 205 ECP' --load-n=3000 --defect=inner");
    says(&made, &["nu205-inner.ron", "BPFI", "stribeck simulate nu205-inner.ron"]);
    let text = desk.text("nu205-inner.ron");
    assert_has(
        &text,
        &[
            "designation: \"NU 205\"",
            "clearance_change_um: -10.0",
            "roller_profile: logarithmic",
            "quality: normal",
            "load_n: 3000.0",
            "ring: inner",
            "// ",
        ],
    );
    desk.refuses("new nu205-inner.ron", &["is there already and is kept"]);
    desk.refuses("new --bearing=6x05", &["no bearing `6x05`", "stribeck bearings"]);
    desk.refuses("new --load-n=1e9", &["--load-n", "at most 7886 N", "static rating"]);
    desk.refuses("new --speed-rpm=1e7", &["--speed-rpm", "51221 rpm"]);
    desk.refuses("new --duration-s=0.001", &["--duration-s", "0.112 to 100 s"]);
    assert_eq!(desk.text("nu205-inner.ron"), text);
    assert_eq!(fs::read_dir(desk.path()).expect("readable").count(), 1);
}

/// Answers that were led into the command were not read.
#[test]
fn issue_answers_from_a_pipe_are_read() {
    let desk = Desk::new("piped");
    let mut command = command(&desk, &["new", "piped.ron"]);
    let mut child =
        command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("it starts");
    let answers = b"NU 205\n3000\n1200\ninner\n1.5\n";
    child.stdin.take().expect("a pipe").write_all(answers).expect("written");
    assert!(child.wait().expect("it ends").success());
    let text = desk.text("piped.ron");
    assert_has(
        &text,
        &[
            "\"NU 205\"",
            "load_n: 3000.0",
            "speed_rpm: 1200.0",
            "ring: inner, length_mm: 1.5",
            "duration_ms: 1000.0",
        ],
    );
}

/// Healthy bearings made tens of g by their facets, and were called damaged; so were rollers without a profile, which
/// enter the load with an impact.
#[test]
fn issue_a_sound_bearing_of_ones_own_is_judged_sound() {
    const MOST_G: f64 = 2.0;
    let desk = Desk::new("sound");
    for (bearing, load_n) in [("6305", "1000"), ("NU 205", "1000"), ("NU 2204", "300")] {
        let name = format!("sound-{bearing}").replace(' ', "-");
        let file = format!("{name}.ron");
        let words = ["--defect=none", "--yes", "--bearing", bearing, "--load-n", load_n];
        desk.succeeds(&[&["new", file.as_str()][..], &words].concat());
        desk.succeeds(&["simulate", &file, "-q"]);
        let summary: serde_json::Value =
            serde_json::from_str(&desk.text(&format!("runs/{name}/summary.json"))).expect("JSON");
        let verdict = summary["diagnosis"]["verdict"].as_str().expect("a verdict");
        assert!(!verdict.contains("shows a defect"), "{bearing}: {verdict}");
        let rms_g = summary["levels"]["record"]["rms_g"].as_f64().expect("a level");
        assert!(rms_g > 1e-3 && rms_g < MOST_G, "{bearing}: {rms_g} g");
    }
}

#[test]
fn behaves_runs_are_listed_opened_and_removed_after_asking() {
    let desk = Desk::with_scene("shelf");
    says(&desk.succeeds("list"), &["no runs in `runs`"]);
    desk.refuses("open", &["has a page"]);
    simulate(&desk, "a", &[]);
    simulate(&desk, "b", &["--starts=2", "--jobs=1"]);
    let listed = json(&desk.succeeds("list --json"));
    let mut kinds: Vec<&str> =
        listed.as_array().expect("a list").iter().filter_map(|i| i["kind"].as_str()).collect();
    kinds.sort_unstable();
    assert_eq!(kinds, ["ensemble", "run"]);
    says(&desk.succeeds("list"), &["complete, 0.3 ms", "2 starts of 0.3 ms", "no page"]);
    desk.refuses("open a", &["has no page yet", "stribeck report"]);
    desk.succeeds("report a -q");
    says(&desk.succeeds("open --print"), &["runs/a/report.html"]);
    assert!(desk.text("runs/a/report.html").contains("data:audio/wav;base64,"), "the run cannot be heard");

    fs::create_dir(desk.join("runs/thesis")).expect("a folder");
    fs::write(desk.join("runs/thesis/draft.txt"), "text").expect("writable");
    desk.refuses("rm a", &["nothing was removed", "--yes"]);
    desk.refuses("rm thesis --yes", &["holds no run", "Nothing was removed"]);
    desk.refuses("rm aa --yes", &["did you mean `a`?"]);
    // One that cannot be removed keeps the others.
    desk.refuses("rm a quick.ron --yes", &["`quick.ron` holds no run"]);
    std::os::unix::fs::symlink("a", desk.join("runs/link")).expect("a link");
    desk.refuses("rm link --yes", &["is a link"]);
    assert!(desk.join("runs/a/trace.npy").exists() && desk.join("runs/thesis/draft.txt").exists());
    fs::write(desk.join("runs/b/notes.txt"), "mine").expect("writable");
    says(&desk.succeeds("rm a b --yes"), &["stays, as it is not of Stribeck: notes.txt", "removed"]);
    assert!(desk.join("runs/b/notes.txt").exists() && !desk.join("runs/b/ensemble.json").exists());
    assert!(!desk.join("runs/a").exists() && !desk.join("runs/b/start-001").exists());
}

#[test]
fn behaves_shells_readers_and_scripts_get_what_they_take() {
    let desk = Desk::new("shells");
    for (shell, word) in
        [("bash", "complete"), ("zsh", "#compdef stribeck"), ("fish", "complete -c stribeck")]
    {
        says(&desk.succeeds(&["completions", shell]), &[word, "compare", "sweep"]);
    }
    let all = json(&desk.succeeds("bearings --json"));
    let known =
        all.as_array().expect("a list").iter().find(|b| b["name"] == "6205").expect("of the catalogue");
    assert!((known["bpfo"].as_f64().expect("an order") - 3.585).abs() < 5e-3, "{known}");
    assert_eq!(json(&desk.succeeds("bearings 'NU 205, elements=13' --json"))["elements"], 13);
    desk.refuses("bearings 6999 --json", &["no bearing `6999`"]);
}

#[test]
fn behaves_the_demonstration_leaves_pages_sound_and_a_verdict() {
    let desk = Desk::new("demo");
    let shown = desk.succeeds("demo");
    says(&shown, &["$ stribeck simulate stribeck-demo/bearing.ron", "shows a defect of the inner raceway"]);
    let verdict = desk.json("stribeck-demo/verdict/findings.json");
    let [low, high] = ["low", "high"].map(|end| verdict["spall_mm"][end].as_f64().expect("a length"));
    assert!(low < 2.0 && 2.0 < high && high - low < 1.5, "{low} to {high} mm");
    for file in ["run/report.html", "verdict/report.html", "sound.wav", "record.csv"] {
        assert!(desk.join("stribeck-demo").join(file).is_file(), "{file}");
    }
    desk.refuses("demo", &["is there already and is kept"]);
}
