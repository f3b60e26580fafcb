//! The program as its users meet it: in a folder of their own, with runs that lie there already, with Ctrl-C.

use std::fs;
use std::path::PathBuf;
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use crate::common::{COARSE, Desk, STRIBECK, command, ctrl_c};
use stribeck_testing::{assert_has, said, says};

/// Its length, when it is to come to its end [ms].
const SHORT: &str = "--set=solver.duration_ms=0.2";

/// A length of which a plan tries every step: of a longer one it would take a second.
const BEGINNING: &str = "--set=solver.duration_ms=0.05";

/// Whatever takes longer has hung.
const PATIENCE: Duration = Duration::from_secs(120);

impl Desk {
    /// Starts a coarse simulation of `quick.ron`.
    fn simulation(&self, words: &[&str]) -> Command {
        let own = ["simulate", "quick.ron", "--threads=1", "--no-report"];
        command(self, &[&own, &COARSE[..], words].concat())
    }

    /// Simulates to the end.
    fn complete(&self, words: &[&str]) {
        let output = self.simulation(words).arg(SHORT).output().expect("it starts");
        assert!(output.status.success(), "{}", said(&output));
    }

    /// Interrupts `command` by Ctrl-C as soon as `file` is there.
    fn interrupt(&self, mut command: Command, file: &str) -> Output {
        let child = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("it starts");
        let began = Instant::now();
        while !self.join(file).exists() {
            assert!(began.elapsed() < PATIENCE, "the run does not come on");
            std::thread::sleep(Duration::from_millis(2));
        }
        ctrl_c(child.id());
        let output = child.wait_with_output().expect("it ends");
        assert_eq!(output.status.code(), Some(130), "{}", said(&output));
        output
    }

    fn bytes(&self, run: &str, name: &str) -> Vec<u8> {
        let path = self.join(run).join(name);
        fs::read(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
    }

    /// Every file of a run, with its name.
    fn files(&self, run: &str) -> Vec<(PathBuf, Vec<u8>)> {
        let mut files = Vec::new();
        let mut folders = vec![self.join(run)];
        while let Some(folder) = folders.pop() {
            for path in fs::read_dir(folder).expect("readable").flatten().map(|entry| entry.path()) {
                if path.is_dir() {
                    folders.push(path);
                } else {
                    files.push((path.clone(), fs::read(path).expect("readable")));
                }
            }
        }
        files.sort();
        files
    }

    fn exists(&self, path: &str) -> bool {
        self.join(path).exists()
    }
}

#[test]
fn invariant_a_finished_run_outlives_the_next_one() {
    let desk = Desk::with_scene("outlives");
    desk.complete(&["--out", "A"]);
    let before = desk.files("A");

    // Refused, with the ways out.
    let deeper = ["--set=defect.depth_mm=0.3", "--out", "A"];
    let refused = desk.simulation(&deeper).output().expect("it starts");
    assert_eq!(refused.status.code(), Some(1));
    says(&refused, &["complete run of 0.2 ms", "--overwrite", "`A-2`", "--resume A"]);
    assert!(desk.files("A") == before, "a refused run changed something");

    // Replaced only by a complete one.
    let mut command = desk.simulation(&deeper);
    command.args(["--overwrite", "--set=solver.duration_ms=50.0"]);
    let interrupted = desk.interrupt(command, "A.new/trace.npy");
    says(&interrupted, &["still holds the earlier run", "simulate --resume A.new"]);
    assert!(desk.files("A") == before, "an interrupted run changed the one that it was to replace");
    says(&desk.simulation(&deeper).arg("--overwrite").output().expect("it starts"), &["A.new", "--resume"]);
    desk.succeeds("report A.new");

    fs::remove_dir_all(desk.join("A.new")).expect("removable");
    desk.complete(&["--set=defect.depth_mm=0.3", "--out", "A", "--overwrite"]);
    desk.complete(&["--set=defect.depth_mm=0.3", "--out", "B"]);
    assert!(desk.bytes("A", "trace.npy") == desk.bytes("B", "trace.npy"));
    assert!(!desk.exists("A.new") && !desk.exists("A/.replaces"));
}

#[test]
fn invariant_runs_without_a_folder_are_numbered_even_when_they_start_together() {
    let desk = Desk::with_scene("numbered");
    let together: Vec<Child> = (0..3)
        .map(|_| {
            desk.simulation(&[SHORT]).stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("it starts")
        })
        .collect();
    for mut child in together {
        assert!(child.wait().expect("it ends").success());
    }
    let again = desk.simulation(&[SHORT]).output().expect("it starts");
    assert!(again.status.success());
    says(&again, &["`runs/quick` holds a complete run", "is kept", "→ runs/quick-4"]);
    for run in ["runs/quick-2", "runs/quick-3", "runs/quick-4"] {
        assert!(desk.bytes("runs/quick", "trace.npy") == desk.bytes(run, "trace.npy"), "{run}");
    }
    assert_eq!(fs::read_dir(desk.join("runs")).expect("readable").count(), 4);
}

#[test]
fn invariant_several_runs_share_a_tree_of_folders() {
    let desk = Desk::with_scene("xargs");
    let line = format!(
        "printf '0.1\\n0.2\\n0.3\\n' | xargs -P3 -I{{}} {} simulate quick.ron {} {SHORT} --set \
         defect.depth_mm={{}} --out deep/{{}}",
        STRIBECK,
        COARSE.join(" ") + " --threads=1 --no-report"
    );
    let output = Command::new("sh").args(["-c", &line]).current_dir(desk.path()).output().expect("a shell");
    assert!(output.status.success(), "{}", said(&output));
    for depth in ["0.1", "0.2", "0.3"] {
        let scene = String::from_utf8(desk.bytes(&format!("deep/{depth}"), "scene.ron")).expect("text");
        assert!(scene.contains(&format!("depth_mm: {depth}")), "{scene}");
    }
}

#[test]
fn refuses_to_go_on_with_another_scene_or_a_complete_run() {
    let desk = Desk::with_scene("longer");
    desk.complete(&["--out", "A"]);
    let other = ["simulate", "--resume", "A", "--set", "mesh.size_mm=1.0"];
    desk.refuses(&other, &["mesh.size_mm=1.0", "Only `solver.duration_ms` may change"]);
    let longer = ["simulate", "--resume", "A", "--no-report", "--set", "solver.duration_ms=0.4"];
    desk.succeeds(&longer);
    desk.refuses(&longer, &["it is complete", "solver.duration_ms"]);
}

#[test]
fn invariant_ctrl_c_before_the_first_step_ends_at_once_and_leaves_nothing() {
    let desk = Desk::with_scene("early");
    // The paper's scene takes seconds to be meshed and preloaded.
    let output =
        desk.interrupt(command(&desk, &["simulate", "--threads=1", "--out", "deep/A"]), "deep/A/.lock");
    says(&output, &["before the first step"]);
    assert!(!said(&output).contains("run …"), "it went on to the first step");
    assert!(!desk.exists("deep"), "a run that never began left a folder");
}

#[test]
fn invariant_a_report_is_of_the_scene_that_was_run_and_says_what_is_missing() {
    let desk = Desk::with_scene("report");
    desk.complete(&["--out", "A"]);
    let trace = desk.bytes("A", "trace.npy");
    fs::write(desk.join("A/trace.npy"), &trace[..trace.len() / 2]).expect("writable");
    let output = desk.succeeds("report A");
    says(&output, &["warning: `trace.npy` holds", "of the 20 samples", "cut off"]);
    let page = String::from_utf8(desk.bytes("A", "report.html")).expect("text");
    assert!(page.contains("of the 20 samples"), "the report does not say that samples are missing");

    let scene = String::from_utf8(desk.bytes("A", "scene.ron")).expect("text");
    let edited = scene.replace("speed_rpm: ", "speed_rpm: 1");
    assert_ne!(edited, scene);
    fs::write(desk.join("A/scene.ron"), edited).expect("writable");
    let output = desk.run("report A");
    assert_eq!(output.status.code(), Some(1));
    says(&output, &["changed after the run", "Put the run's own `scene.ron` back"]);
}

#[test]
fn invariant_the_program_says_what_it_is_and_needs_no_files() {
    let desk = Desk::with_scene("words");
    says(&desk.run("--version"), &["stribeck 0."]);
    says(&desk.run("--help"), &["rolling element bearings", "simulate", "report", "plan"]);
    // Without a scene the bearing of the paper, here on a coarse mesh.
    let plan = desk.succeeds(&["plan", "--set=mesh.size_mm=2.0", BEGINNING]);
    says(&plan, &["singh2014", "roller_vertices"]);
    let diverging = desk.run("plan quick.ron --set solver.time_step_factor=1.2");
    assert_eq!(diverging.status.code(), Some(1));
    says(&diverging, &["solver.time_step_factor", "below 1"]);
    says(&desk.run("simulate --threads two"), &["'two'", "whole number from 1 to 1024"]);
    says(&desk.run("report"), &["stribeck simulate"]);
    assert!(!desk.join("runs").exists());
}

/// A housing for another bearing is an error at the line of the scene that names it, and no command leaves a
/// folder.
#[test]
fn refuses_the_mesh_of_another_bearing_where_the_scene_names_it() {
    let desk = Desk::with_scene("another-housing");
    let block = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../fixtures/housings/pillow_block.msh");
    fs::copy(block, desk.join("block.msh")).expect("a mesh");
    let text =
        "(\n  bearing: \"NU 203\", film: None, defect: None,\n  housing: mesh(file: \"block.msh\"),\n)";
    fs::write(desk.join("other.ron"), text).expect("writable");
    for words in [
        &["simulate", "other.ron"][..],
        &["simulate", "other.ron", "--starts=2"],
        &["validate", "other.ron"],
        &["plan", "other.ron"],
    ] {
        desk.refuses(
            words,
            &["bore does not fit the outer ring", "other.ron:3:23", "housing: mesh(file: \"block.msh\")"],
        );
        assert!(!desk.join("runs").exists(), "{words:?}");
    }
    let set = desk.run(&[
        "simulate",
        "--set=housing=mesh(file: \"block.msh\")",
        "--set=bearing=NU 203",
        "--set=defect=None",
    ]);
    says(&set, &["bore does not fit the outer ring", "--set housing=mesh(file: \"block.msh\")"]);
}

/// A reduced run of a scene that names its bearing, as a user begins with: its plan has its steps, its mesh
/// goes to other programs, and another bearing on the command line says what it has replaced.
#[test]
fn behaves_a_reduced_run_from_its_plan_to_a_deck() {
    let desk = Desk::with_scene("reduced");
    let text =
        "(name: \"mine\", model: reduced(), bearing: \"NU 205\", defect: None, film: None, operation: \
        (load_n: 3000, speed_rpm: 1500),
        mesh: (size_mm: 1, roller_facets: 48), contact: (penalty_scale: 0.3), solver: (duration_ms: 0.2), \
        output: (frames: None))";
    fs::write(desk.join("mine.ron"), text).expect("writable");
    desk.succeeds("simulate mine.ron --no-report --threads=1");
    for (format, has) in [("inp", "ROLLER_13"), ("msh", "roller 13")] {
        desk.succeeds(&["export", "mine", "--to", format]);
        let deck = fs::read_to_string(desk.join(format!("runs/mine/mesh.{format}"))).expect("a deck");
        assert!(deck.contains(has), "{format}");
    }
    // The reduced model has no elements in motion, and decks for Radioss have names of their own.
    says(&desk.run("export mine --to=radioss"), &["`model: reduced`", "`model: full`"]);
    let full = ["export", "mine.ron", "--to=radioss", "--set=model=full"];
    says(&desk.run(&full), &["`contact.surface`", "`surface: facet`"]);
    let full = [&full[..], &["--set=contact.surface=facet"]].concat();
    says(&desk.run(&[&full[..], &["--out=full.rad"]].concat()), &["`_0000.rad`"]);
    says(&desk.run(&full), &["mine_0000.rad"]);
    let starter = desk.text("mine_0000.rad");
    assert_has(&starter, &["# left out: friction", "\nroller 13\n", "/INTER/TYPE3/27\n", "rim of roller 13"]);
    assert!(desk.join("mine_0002.rad").exists());
    // There are no frames to export, and only the full model makes some.
    says(&desk.run("export mine --to=pvd"), &["--set model=full", "output.frames=()"]);
    // Dampers that allow far shorter steps than the scene has.
    let stiff = ["mine.ron", "--set=housing=springs(damping_n_s_m: 1e6)", "--no-report", "--out=stiff"];
    desk.succeeds(&[&["simulate"][..], &stiff].concat());
    let info = desk.text("stiff/run.json");
    let steps = info.lines().find_map(|line| line.trim().strip_prefix("\"steps\": ")).expect("steps");
    let plan = desk.run("plan mine.ron '--set=housing=springs(damping_n_s_m: 1e6)'");
    says(&plan, &[&format!(", {} steps of 0.0", steps.trim_end_matches(',')), "the run takes about"]);
    let long =
        desk.run("plan mine.ron '--set=housing=springs(damping_n_s_m: 1e6)' --set=solver.duration_ms=1e5");
    says(&long, &["takes hours", "`housing.damping_n_s_m`"]);
    // Its steps are 200 times shorter than the scene says: it is tried for two seconds, and does not stop.
    assert!(!said(&long).contains("stops at once"), "{}", said(&long));

    let other = desk
        .succeeds("plan mine.ron --set=model=full '--set=bearing=NU 203, elements=11' --set=mesh.size_mm=1");
    says(
        &other,
        &[
            "warning: with another bearing than that of `mine.ron`",
            "instead of 3000",
            "`name` nu-203 instead of mine",
        ],
    );
    // A warning of the trial may name it, too.
    assert!(!said(&other).contains("`mesh.size_mm` "), "{}", said(&other));
}

/// The advice for an ensemble named no start of it, and the newest run to export was one.
#[test]
fn issue_an_ensemble_is_described_by_its_starts() {
    let desk = Desk::with_scene("ensemble-told");
    desk.complete(&["--starts=2", "--jobs=1", "--out=runs/ens"]);
    let told = ["`runs/ens` is an ensemble", "2 starts", "`runs/ens/start-001`"];
    for words in [&["export", "ens", "--to=csv"][..], &["export", "--to=csv"], &["analyse", "runs/ens"]] {
        desk.refuses(words, &told);
    }
    // Where there is a run of its own, that is exported, however old.
    desk.complete(&["--out=runs/one"]);
    desk.succeeds("simulate --resume=runs/ens --starts=3 --jobs=1 --no-report");
    desk.says("export --to=csv", &["runs/one/trace.csv"]);
}

/// `bearings` named an option that it does not have, and said "inf ms" of what does not turn.
#[test]
fn issue_hints_are_those_of_their_command() {
    let desk = Desk::with_scene("hints");
    let unknown = desk.run("bearings 6504");
    assert!(!unknown.status.success());
    let known = desk.succeeds("bearings NU312");
    says(&known, &["NU 312", "`\"NU 312, elements=…\"`"]);
    assert!(![&unknown, &known].iter().any(|output| said(output).contains("--bearing")));
    let still = desk.run(&["plan", "quick.ron", "--set=operation.speed_rpm=0", BEGINNING]);
    assert!(still.status.success() && !said(&still).contains("inf"), "{}", said(&still));
    says(&still, &["nothing turns"]);
    // From 300 to 1200 rpm; families were those of 300 beside lines of facets at the mean.
    let ramp = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../fixtures/scenes/ramp.ron");
    fs::copy(ramp, desk.join("ramp.ron")).expect("a scene");
    let ramp = desk.run("plan ramp.ron --no-trial");
    says(&ramp, &["families at the mean speed, without slip: BPFO 135.", "shaft 12.50"]);
}

/// A closed pipe, as after `| head`, ends a command quietly; a full disk is an error.
#[test]
fn survives_an_output_that_is_closed_or_full() {
    let desk = Desk::with_scene("closed");
    let closed = || {
        let (reader, writer) = std::io::pipe().expect("a pipe");
        drop(reader);
        writer
    };
    for words in [&["bearings"][..], &["bearings", "NU205"], &["plan", "--set=mesh.size_mm=2", BEGINNING]] {
        let output = command(&desk, words).stdout(closed()).output().expect("it starts");
        assert!(output.status.success() && output.stderr.is_empty(), "{words:?}: {}", said(&output));
    }
    if let Ok(full) = fs::File::options().write(true).open("/dev/full") {
        let output = command(&desk, &["bearings", "NU205"]).stdout(full).output().expect("it starts");
        assert_eq!(output.status.code(), Some(1), "{}", said(&output));
        says(&output, &["error: what the command says could not be written to standard output"]);
    }
}
