//! Campaigns as their users meet them: killed, split over machines, with variants that cannot be.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;
use stribeck_testing::assert_has;

use crate::common::{Desk, QUICK, STRIBECK};
use stribeck_formats::Recording;
use stribeck_testing::{
    Noise,
    peer::{absent, python_with},
    said, says,
};

/// Eight very short runs of a very coarse bearing.
const CAMPAIGN: &str = "(
    name: \"eight\",
    scene: \"quick.ron\",
    set: [\"mesh.size_mm=4.0\", \"mesh.roller_facets=40\", \"solver.start=sudden\", \"solver.duration_ms=0.3\",
        \"output.frames=None\"],
    variants: latin_hypercube(count: 8, over: [
        (field: \"operation.load_n\", from: 5000, to: 50000),
        (field: \"defect.ring\", values: [outer, inner]),
    ]),
)";

fn desk(name: &str, campaign: &str) -> Desk {
    let desk = Desk::of(name, &["campaign", "campaign.ron"]);
    fs::copy(QUICK, desk.join("quick.ron")).expect("a scene");
    fs::write(desk.join("campaign.ron"), campaign).expect("a campaign");
    desk
}

/// What a campaign makes of its runs.
const TABLES: [&str; 4] = ["runs.parquet", "events.parquet", "signals.parquet", "DATASHEET.md"];

fn tables(folder: &Path) -> [Vec<u8>; 4] {
    TABLES.map(|name| fs::read(folder.join(name)).unwrap_or_else(|e| panic!("{name}: {e}")))
}

/// Tables of [`CAMPAIGN`] in one piece, made once for all tests.
fn unbroken() -> &'static [Vec<u8>; 4] {
    static MADE: OnceLock<[Vec<u8>; 4]> = OnceLock::new();
    MADE.get_or_init(|| {
        let desk = desk("campaign-unbroken", CAMPAIGN);
        desk.says("--out=A", &["8 of 8 runs are complete"]);
        tables(&desk.join("A"))
    })
}

/// Puts the tables of the unbroken campaign into a folder.
fn put_unbroken(folder: &Path) {
    fs::create_dir(folder).expect("a new folder");
    for (name, bytes) in TABLES.iter().zip(unbroken()) {
        fs::write(folder.join(name), bytes).expect("writable");
    }
}

#[test]
fn survives_ten_kills_and_any_split_with_the_bytes_of_an_unbroken_campaign() {
    let desk = desk("campaign-kills", CAMPAIGN);
    desk.says("--out=A --jobs=2 --threads=2", &["8 of 8 runs are complete"]);
    assert_eq!(&tables(&desk.join("A")), unbroken(), "with two threads each");
    let mut noise = Noise::new(3);
    for _ in 0..10 {
        desk.kill("--out=B --jobs=2", 200.0 + 400.0 * noise.uniform().abs());
    }
    let last = desk.run("--out=B --resume");
    assert!(last.status.success(), "{}", said(&last));
    assert_eq!(tables(&desk.join("A")), tables(&desk.join("B")));
    // Three parts; those that end first leave the tables to the last.
    for part in ["--shard=2/3", "--shard=1/3"] {
        let early = desk.run(&["--out=C", part]);
        says(&early, &["this part is done", "runs of others are not at their end"]);
        assert!(early.status.success() && !desk.join("C/runs.parquet").exists());
    }
    desk.succeeds("--out=C --shard=3/3");
    assert_eq!(tables(&desk.join("A")), tables(&desk.join("C")));
    // Eight parts that begin at the same time in a folder that is not there yet.
    let parts: Vec<_> = (1..=8)
        .map(|part| {
            desk.command(&["--out=D", "--jobs=1", &format!("--shard={part}/8")]).spawn().expect("it starts")
        })
        .collect();
    for mut part in parts {
        assert!(part.wait().expect("it ends").success());
    }
    assert_eq!(tables(&desk.join("A")), tables(&desk.join("D")));
    let table = Recording::open(desk.join("A/runs.parquet")).expect("a table");
    let loads = table.channel("scene.operation.load_n").expect("a column").read().expect("numbers");
    assert_eq!(loads.len(), 8);
    // Once more: nothing is run, and the tables stay; files that a kill has left do not, and files of
    // the owner's do.
    let (left, own) = (desk.join("A/runs.4711.new"), desk.join("A/notes.new"));
    for path in [&left, &own] {
        fs::write(path, "half").expect("it can be written");
    }
    says(&desk.run("--out=A"), &["0 of them to be run", "8 of 8"]);
    assert!(!left.exists() && own.exists());
    assert_eq!(tables(&desk.join("A")), tables(&desk.join("B")));
}

/// A full disk put the path of a folder and a warning into the data set.
#[test]
fn issue_what_a_disk_refused_is_not_in_the_tables() {
    let desk = desk("campaign-refused", CAMPAIGN);
    desk.succeeds("--out=A");
    let path = runs(&desk.join("A"))[3].join("run.json");
    let mut info: serde_json::Value = serde_json::from_slice(&fs::read(&path).expect("a run")).expect("JSON");
    for (list, what) in [("warnings", "no checkpoint at 0.300 ms"), ("warned_of", "checkpoint")] {
        info[list].as_array_mut().expect("a list").push(what.into());
    }
    fs::write(&path, info.to_string()).expect("writable");
    fs::remove_file(desk.join("A/runs.parquet")).expect("a table");
    desk.succeeds("--out=A");
    assert_eq!(&tables(&desk.join("A")), unbroken());
}

/// A run that was half written when its program was ended could neither go on nor begin anew, for ever.
#[test]
fn issue_a_run_that_cannot_go_on_is_made_again() {
    let desk = desk("campaign-half", CAMPAIGN);
    desk.succeeds("--out=A");
    let run = &runs(&desk.join("A"))[3];
    let info = fs::read_to_string(run.join("run.json")).expect("a run");
    fs::write(run.join("run.json"), info.replace("\"complete\"", "\"running\"")).expect("writable");
    fs::write(run.join("checkpoint"), "half").expect("writable");
    fs::remove_file(desk.join("A/runs.parquet")).expect("a table");
    desk.says("--out=A", &["1 of them to be run here", "8 of 8 runs are complete"]);
    assert_eq!(&tables(&desk.join("A")), unbroken());
}

/// `-q` failed on a full disk without a byte on either stream.
#[test]
fn issue_a_quiet_campaign_says_why_it_fails() {
    let desk = desk("campaign-quiet", CAMPAIGN);
    fs::create_dir(desk.join("A")).expect("a folder");
    // The mark of a campaign, and what no folder can be made in.
    for name in [".turn", "runs"] {
        fs::write(desk.join("A").join(name), "").expect("writable");
    }
    desk.refuses("--out=A -q", &["8 of 8 runs are not at their end: cannot", "The same command goes on"]);
}

#[test]
fn behaves_a_flag_keeps_less_than_the_file_says() {
    let desk = desk("campaign-flag", CAMPAIGN);
    desk.succeeds("--out=A --keep=numbers");
    assert!(
        desk.text("A/campaign.ron").contains("keep: numbers") && !desk.join("A/signals.parquet").exists()
    );
    desk.says("--out=A --keep=numbers", &["0 of them to be run", "8 of 8"]);
    desk.refuses("--out=A", &["another `--keep`"]);
}

/// The campaign with `keep: what`.
fn keeping(what: &str) -> String {
    CAMPAIGN.replace("    variants:", &format!("    keep: {what},\n    variants:"))
}

/// Folders of the runs of a campaign, in the order of their names.
fn runs(folder: &Path) -> Vec<PathBuf> {
    let mut runs: Vec<PathBuf> =
        fs::read_dir(folder.join("runs")).expect("runs").flatten().map(|entry| entry.path()).collect();
    runs.sort();
    runs
}

fn files(run: &Path) -> Vec<String> {
    let names = fs::read_dir(run).expect("a run").flatten().map(|entry| entry.file_name());
    let mut names: Vec<String> = names.map(|name| name.to_string_lossy().into_owned()).collect();
    names.retain(|name| name != ".lock");
    names.sort();
    names
}

/// Names and numbers of a table, a missing one as not a number.
fn numbers(table: PathBuf) -> Vec<(String, Vec<u64>)> {
    let table = Recording::open(table).expect("a table");
    let bits = |values: Vec<f64>| values.into_iter().map(f64::to_bits).collect();
    table.channels.iter().map(|c| (c.name.clone(), bits(c.read().expect("numbers")))).collect()
}

#[test]
fn invariant_what_is_kept_of_runs_does_not_change_the_tables() {
    let desk = desk("campaign-kept", &keeping("signals"));
    put_unbroken(&desk.join("all"));
    desk.succeeds("--out=signals --jobs=2");
    for table in ["runs.parquet", "signals.parquet"] {
        assert!(
            numbers(desk.join("all").join(table)) == numbers(desk.join("signals").join(table)),
            "{table}"
        );
    }
    for kept in runs(&desk.join("signals")) {
        assert_eq!(files(&kept), ["run.json", "scene.ron", "signals.npy", "summary.json"]);
    }
    // Nothing is run again, and the tables are made of the remaining runs; by parts, too.
    let before = tables(&desk.join("signals"));
    says(&desk.run("--out=signals"), &["0 of them to be run", "8 of 8"]);
    assert_eq!(before, tables(&desk.join("signals")));
    for part in ["--shard=2/3", "--shard=1/3", "--shard=3/3"] {
        desk.succeeds(&["--out=parts", part]);
    }
    assert_eq!(before, tables(&desk.join("parts")));

    fs::write(desk.join("campaign.ron"), keeping("numbers")).expect("a campaign");
    desk.succeeds("--out=numbers");
    for table in ["runs.parquet", "events.parquet"] {
        assert!(
            numbers(desk.join("all").join(table)) == numbers(desk.join("numbers").join(table)),
            "{table}"
        );
    }
    assert!(!desk.join("numbers/signals.parquet").exists());
    let kept = runs(&desk.join("numbers"));
    assert_eq!(files(&kept[0]), ["run.json", "scene.ron", "summary.json"]);
    // A removed run is named when it is asked for.
    let report = Command::new(STRIBECK).arg("report").arg(&kept[0]).output().expect("it starts");
    assert!(!report.status.success());
    says(&report, &["trace.npy", "`keep`"]);
}

#[test]
fn survives_kills_while_samples_are_removed_and_repeats_no_run() {
    let desk = desk("campaign-kept-kills", &keeping("signals"));
    desk.succeeds("--out=A --jobs=2");
    let provenance = |folder: &str| -> Vec<(PathBuf, Vec<u8>)> {
        let finished = runs(&desk.join(folder)).into_iter().filter(|run| run.join("signals.npy").exists());
        finished.map(|run| (run.clone(), fs::read(run.join("run.json")).expect("a run"))).collect()
    };
    let mut noise = Noise::new(5);
    let mut finished = Vec::new();
    for _ in 0..10 {
        desk.kill("--out=B --jobs=2", 200.0 + 400.0 * noise.uniform().abs());
        if desk.join("B/runs").exists() {
            finished = provenance("B");
        }
    }
    desk.succeeds("--out=B");
    assert_eq!(tables(&desk.join("A")), tables(&desk.join("B")));
    // Seconds of wall clock in `run.json` would differ.
    let last = provenance("B");
    assert!(finished.iter().all(|run| last.contains(run)), "a finished run was run again");
    assert_eq!(last.len(), 8);

    // Killed when the run had ended, when its numbers were made, and when its signals were written beside.
    let whole = desk.join("whole");
    fs::write(desk.join("campaign.ron"), CAMPAIGN).expect("a campaign");
    desk.succeeds("--out=whole");
    fs::write(desk.join("campaign.ron"), keeping("signals")).expect("a campaign");
    for (at, gone) in [&["summary.json", "signals.npy"][..], &["signals.npy"], &[]].into_iter().enumerate() {
        let run = &runs(&desk.join("B"))[at];
        let from = whole.join("runs").join(run.file_name().expect("a name"));
        for name in ["trace.npy", "energy.npy", "mesh.vtu", "checkpoint"] {
            fs::copy(from.join(name), run.join(name)).expect("the same run");
        }
        gone.iter().for_each(|name| fs::remove_file(run.join(name)).expect("there"));
    }
    says(&desk.run("--out=B"), &["0 of them to be run", "8 of 8"]);
    assert_eq!(tables(&desk.join("A")), tables(&desk.join("B")));
    assert_eq!(provenance("B"), last);
    for kept in runs(&desk.join("B")) {
        assert_eq!(files(&kept), ["run.json", "scene.ron", "signals.npy", "summary.json"]);
    }
}

#[test]
fn refuses_to_keep_what_it_does_not_know() {
    let desk = desk("campaign-kept-refused", &keeping("most"));
    desk.refuses("--out=A", &["campaign.ron:6:", "`keep`", "`most`", "`all`", "`signals`", "`numbers`"]);
    assert!(!desk.join("A").exists());
}

#[test]
fn refuses_fields_that_no_scene_has_before_anything_runs() {
    for (right, wrong, line) in [
        ("operation.load_n", "operation.laod_n", "campaign.ron:7:17"),
        ("mesh.size_mm=4.0", "mesh.sise_mm=4.0", "campaign.ron:4:11"),
    ] {
        let desk = desk("campaign-misspelt", &CAMPAIGN.replace(right, wrong));
        let refused = desk.run("--out=A");
        assert!(!refused.status.success() && !desk.join("A").exists(), "{}", said(&refused));
        let field = wrong.split('=').next().expect("a field");
        let did_you_mean = format!("did you mean `{}`", right.split('=').next().expect("a field"));
        says(&refused, &[line, field, &did_you_mean]);
    }
}

#[test]
fn behaves_variants_that_cannot_be_are_rows_with_their_reason() {
    let text = CAMPAIGN.replace("latin_hypercube(count: 8, over: [", "grid([").replace(
        "(field: \"operation.load_n\", from: 5000, to: 50000),",
        "(field: \"bearing.roller_diameter_mm\", values: [18.0, 19.0]),",
    );
    let desk = desk("campaign-refused", &text);
    let before = "2 of 4 runs cannot be, and get a row with their reason in place of a run:";
    let done = desk.succeeds("--out=A -q");
    says(&done, &[before, "inner race: 1, outer race: 1", "2 of 4 runs are complete"]);
    // When none can be, the command fails.
    fs::write(desk.join("campaign.ron"), text.replace("[18.0, 19.0]", "[19.0]")).expect("a campaign");
    desk.refuses("--out=B", &["0 of 2 runs are complete"]);
    // Another campaign's folder is left alone.
    desk.refuses("--out=A", &["holds another campaign", "--out"]);
}

/// The numbers of a table's column.
fn column(table: &Path, name: &str) -> Vec<f64> {
    let table = Recording::open(table).expect("a table");
    table.channel(name).unwrap_or_else(|why| panic!("{why}")).read().expect("numbers")
}

#[test]
fn behaves_a_run_that_fails_at_set_up_is_a_row_and_the_others_go_on() {
    // As soft as rubber, beyond the law of a line contact: there is no static distribution.
    let text = CAMPAIGN.replace("latin_hypercube(count: 8, over: [", "grid([").replace(
        "(field: \"operation.load_n\", from: 5000, to: 50000),",
        "(field: \"material.youngs_modulus_gpa\", values: [0.05, 207]),",
    );
    let desk = desk("campaign-set-up", &text);
    desk.says(
        "--out=A --jobs=1",
        &["run 1", "failed", "no static load distribution", "2 of 4 runs are complete"],
    );
    // Once more, nothing is tried again.
    says(&desk.run("--out=A"), &["0 of them to be run", "2 of 4 runs are complete"]);
}

#[test]
fn behaves_equal_scenes_are_run_once_and_what_two_programs_have_run_stays() {
    let text = keeping("numbers").replace("from: 5000, to: 50000", "values: [10000, 1e4, 20000]");
    let desk = desk("campaign-equal", &text.replace("count: 8", "count: 24"));
    // Programs that find the same runs due, and take them up at their own pace.
    let programs: Vec<_> =
        (0..2).map(|_| desk.command(&["--out=A", "--jobs=1"]).spawn().expect("it starts")).collect();
    let whole = desk.run("--out=B --jobs=2");
    says(&whole, &["24 runs, 4 of them to be run here", "24 of 24 runs are complete"]);
    assert!(!said(&whole).contains("another program"), "{}", said(&whole));
    for mut program in programs {
        // The first to end may have left runs to the other.
        program.wait().expect("it ends");
    }
    let times = |folder: &str| -> Vec<Vec<u8>> {
        runs(&desk.join(folder)).iter().map(|run| fs::read(run.join("run.json")).expect("a run")).collect()
    };
    let before = times("A");
    desk.succeeds("--out=A");
    assert_eq!((times("A"), before.len()), (before, 4));
    assert_eq!(
        fs::read(desk.join("A/runs.parquet")).expect("a table"),
        fs::read(desk.join("B/runs.parquet")).expect("a table")
    );
}

#[test]
fn refuses_a_folder_whose_table_or_scene_was_changed() {
    let text = "(name: \"x\", scene: \"quick.ron\", set: [\"mesh.size_mm=4.0\", \"mesh.roller_facets=40\",
        \"solver.start=sudden\", \"solver.duration_ms=0.1\", \"output.frames=None\"], variants: \
        table(\"t.csv\"))";
    let desk = desk("campaign-changed", text);
    fs::write(desk.join("t.csv"), "operation.load_n\n10000\n20000\n").expect("a table");
    desk.succeeds("--out=A");
    let before = tables(&desk.join("A"));
    fs::write(desk.join("t.csv"), "operation.load_n\n10000\n30000\n").expect("a table");
    desk.refuses("--out=A", &["other scenes", "run 2", "--out"]);
    assert_eq!(before, tables(&desk.join("A")));
    // The same values, written in another way, are the same campaign.
    fs::write(desk.join("t.csv"), "operation.load_n\n1e4\n20000.0\n").expect("a table");
    desk.succeeds("--out=A");
    // A folder of an earlier version has no list, and gets one.
    fs::remove_file(desk.join("A/scenes.txt")).expect("it is there");
    assert!(desk.run("--out=A").status.success() && desk.join("A/scenes.txt").exists());
}

#[test]
fn behaves_a_run_that_diverges_has_a_row_and_no_signals() {
    let text = CAMPAIGN.replace("latin_hypercube(count: 8, over: [", "grid([").replace(
        "(field: \"operation.load_n\", from: 5000, to: 50000),",
        "(field: \"guards.energy_stop_percent\", values: [25, 0.00001]),",
    );
    let desk = desk("campaign-diverged", &text);
    let done = desk.run("--out=A");
    says(&done, &["diverged", "(limit 0.00001 %)", "2 of 4 runs are complete"]);
    let of = column(&desk.join("A/signals.parquet"), "run");
    assert!(!of.is_empty() && of.iter().all(|run| *run <= 2.0), "{of:?}");
    let sheet = desk.text("A/DATASHEET.md");
    let columns = sheet.split("## Columns of `signals.parquet`").nth(1).expect("its columns");
    assert_has(columns, &["| `run` |  | Number", "| `split` |  | Part", "| `time_s` | s | Time"]);
    assert_has(
        &sheet,
        &["| runs with warnings | ", "one that diverged has no signals", "| `warnings` |  | What"],
    );
}

#[test]
fn behaves_scripts_for_engines_name_every_part() {
    let desk = desk("campaign-emit", CAMPAIGN);
    for (engine, words) in [
        ("slurm", ["--array=1-8", "$SLURM_ARRAY_TASK_ID/8", "--cpus-per-task=1\n", "--threads 1\n"]),
        ("pbs", ["#PBS -J 1-8\n", "$PBS_ARRAY_INDEX/8", "select=1:ncpus=1\n", "--threads 1\n"]),
        ("hq", ["--array=1-8", "$HQ_TASK_ID/8", "--cpus=1 ", "--threads 1'"]),
    ] {
        let output = desk.run(&["--emit", engine, "--shards=16"]);
        assert!(output.status.success(), "{}", said(&output));
        says(&output, &words);
        says(&output, &["8 parts in place of 16: as many as runs"]);
        // A part that fails is one that the engine says has failed.
        assert!(!said(&output).contains("|| true"), "{}", said(&output));
        assert!(!desk.join("runs").exists());
    }
    says(&desk.run("--emit=slurm"), &["##SBATCH --time=", "up to 1 runs", "stribeck plan"]);
    says(&desk.run("--emit=pbs --shards=4"), &["##PBS -l walltime=", "up to 2 runs"]);
    // PBS refuses an array of one.
    let alone = desk.run("--emit=pbs --shards=1");
    says(&alone, &["--shard 1/1"]);
    assert!(!said(&alone).contains("#PBS -J"), "{}", said(&alone));
    // Eight runs are eight parts by default, and parts get the flags of the command.
    let limits = ["--threads=4", "--jobs=2", "--memory-gb=1.5"];
    let told = |engine| desk.run(&[&["--emit", engine][..], &limits].concat());
    let to_program = "/8 --jobs 2 --threads 4 --memory-gb 1.5";
    says(&told("slurm"), &["--array=1-8", "--cpus-per-task=4", "--mem=1431M", to_program]);
    says(&told("pbs"), &["-J 1-8", "select=1:ncpus=4:mem=1431mb", to_program]);
    says(&told("hq"), &["--array=1-8", "--cpus=4", to_program]);
    says(&desk.run("--emit=hq --jobs=2"), &["--jobs 2 --threads 2", "--cpus=2"]);
    says(&desk.run("--shards=3"), &["--emit"]);
    // Whatever a folder is called, a shell takes its name and runs nothing of it.
    let out = "--out=it's `touch ran` $(touch ran)";
    let script = String::from_utf8(desk.run(&["--emit=slurm", out]).stdout).expect("a text");
    let line = script.lines().last().expect("a command").replace(STRIBECK, "echo");
    let echoed = Command::new("sh").current_dir(desk.path()).args(["-c", &line]).output().expect("a shell");
    says(&echoed, &["it's `touch ran` $(touch ran) --shard /8"]);
    assert!(!desk.join("ran").exists());
    says(&desk.run("--shard=4/3"), &["I from 1 to N"]);
}

#[test]
fn peer_tables_open_in_pandas_polars_and_duckdb() {
    // pandas 3.1.1, polars 2.1.0 and DuckDB 2.0.0, where the interpreter in STRIBECK_PYTHON (or python3) has
    // them.
    let Some(python) = python_with(&["pandas", "pyarrow", "polars", "duckdb"]) else { return };
    let desk = desk("campaign-peers", CAMPAIGN);
    put_unbroken(&desk.join("A"));
    let script = "
import pandas, polars, duckdb
a = pandas.read_parquet('A/runs.parquet')
b = polars.read_parquet('A/runs.parquet')
n = duckdb.execute(\"select count(*), sum(load_n) from 'A/runs.parquet' where status = \
'complete'\").fetchone()
assert len(a) == len(b) == n[0] == 8 and abs(a.load_n.sum() - n[1]) < 1e-6, (len(a), n)
assert list(a.columns) == b.columns and a.split.isin(['train', 'validation', 'test']).all()
s = pandas.read_parquet('A/signals.parquet')
assert s.groupby('run').size().tolist() == a.n_samples.tolist(), s.groupby('run').size()
assert s['sensor.side.ay_m_s2'].abs().max() > 0
print('agreed')
";
    let output =
        Command::new(&python).current_dir(desk.path()).args(["-c", script]).output().expect("it starts");
    says(&output, &["agreed"]);
}

#[test]
fn peer_hyperqueue_runs_the_parts_to_the_same_bytes() {
    // HyperQueue 0.27.0 with a server and two workers, where the interpreter in STRIBECK_PYTHON (or python3)
    // has it.
    let Some(python) = python_with(&["hyperqueue"]) else { return };
    let desk = desk("campaign-hyperqueue", CAMPAIGN);
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../fixtures/peers/hyperqueue_campaign.py");
    let words = [script, STRIBECK, "campaign.ron", "B", "4"];
    let output = Command::new(&python).current_dir(desk.path()).args(words).output().expect("it starts");
    says(&output, &["done"]);
    // The same command completes the run that the lost worker left unfinished.
    desk.says("--out=B", &["8 of 8 runs are complete"]);
    assert_eq!(unbroken(), &tables(&desk.join("B")));
}

/// The variable that says that Slurm must be there.
const NEED_SLURM: &str = "STRIBECK_NEED_SLURM";

#[test]
fn peer_slurm_runs_the_parts_to_the_same_bytes() {
    // Slurm 22.05.8, as Debian 12 has it, with a controller and a node of its own, for which it takes root.
    let has = |program: &str| Command::new(program).arg("-V").output().is_ok_and(|o| o.status.success());
    let root = Command::new("id").arg("-u").output().is_ok_and(|o| o.stdout == b"0\n");
    let clients = Command::new("sh").args(["-c", "command -v sbatch squeue scontrol sinfo"]).output();
    let clients = clients.is_ok_and(|o| o.status.success());
    if !root || !clients || !["slurmctld", "slurmd", "munged"].into_iter().all(has) {
        return absent(NEED_SLURM, "Slurm is not installed, or this is not root").unwrap_or_default();
    }
    let desk = desk("campaign-slurm", CAMPAIGN);
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../fixtures/peers/slurm_campaign.sh");
    let words = [script, STRIBECK, "campaign.ron", "B", "4"];
    let output = Command::new("sh").current_dir(desk.path()).args(words).output().expect("it starts");
    if output.status.code() == Some(77) {
        let why = format!("the daemons of Slurm do not come up: {}", said(&output));
        return absent(NEED_SLURM, &why).unwrap_or_default();
    }
    says(&output, &["done"]);
    assert_eq!(unbroken(), &tables(&desk.join("B")));
}

#[test]
fn peer_dask_and_snakemake_run_the_parts_to_the_same_bytes() {
    // Dask 2026.8.0 and Snakemake 9.27.1, where the interpreter in STRIBECK_PYTHON (or python3) has them.
    let (program, recipes) = (STRIBECK, concat!(env!("CARGO_MANIFEST_DIR"), "/../../../fixtures/clusters"));
    let dask = [&format!("{recipes}/campaign_dask.py"), program, "campaign.ron", "B", "4"]
        .map(str::to_owned)
        .to_vec();
    let settings =
        [&format!("program={program}"), "campaign=campaign.ron", "out=B", "parts=4"].map(str::to_owned);
    let snakefile = format!("{recipes}/Snakefile");
    let snakemake = ["-m", "snakemake", "-s", &snakefile, "--cores", "2", "--config"].map(str::to_owned);
    let snakemake = snakemake.into_iter().chain(settings).collect();
    for (module, words) in [("distributed", dask), ("snakemake", snakemake)] {
        let Some(python) = python_with(&[module]) else { continue };
        let desk = desk(&format!("campaign-{module}"), CAMPAIGN);
        let output = Command::new(&python).current_dir(desk.path()).args(&words).output().expect("it starts");
        assert!(output.status.success(), "{module}: {}", said(&output));
        assert_eq!(unbroken(), &tables(&desk.join("B")), "{module}");
    }
}
