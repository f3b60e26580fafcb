//! What people's files hold, a second round: clocks that begin later, names that steer terminals, archives larger
//! than memory, files of others among ours.

use std::fs;
use std::process::Command;

use crate::common::{Desk, STRIBECK};
use stribeck_formats::{Channel, npz};
use stribeck_testing::{Noise, said, says};

const RATE_HZ: f64 = 12_800.0;

/// A record and its tachometer of a shaft that goes from 15 to 25 Hz, outer-race impacts of a 6205 in it.
fn run_up() -> (Vec<f64>, Vec<f64>) {
    let (mut noise, mut turns) = (Noise::new(1), 0.0);
    let count = 1 << 16;
    (0..count)
        .map(|n| {
            let hz = 15.0 + 10.0 * n as f64 / count as f64;
            turns += hz / RATE_HZ;
            let since = (turns * 3.5848) % 1.0 / (hz * 3.5848);
            let impact = 2.0 * (-since / 1e-3).exp() * (std::f64::consts::TAU * 3000.0 * since).sin();
            (0.7 * noise.uniform() + impact, f64::from(turns % 1.0 < 0.1))
        })
        .unzip()
}

/// A tachometer whose clock began 0.8 s later was laid at the record's start: the defect was lost, and a false
/// comb named.
#[test]
fn issue_a_tachometer_that_starts_later_is_laid_where_its_clock_says() {
    let desk = Desk::new("late-tachometer");
    let (record, tacho) = run_up();
    let later = (0.8 * RATE_HZ) as usize;
    let channels = |start_s: f64| {
        [
            Channel::held("acc", record.clone()).at_rate(Some(RATE_HZ)),
            Channel::held("acc_start_s", vec![2.0]),
            Channel::held("tacho", tacho[later..].to_vec()),
            Channel::held("tacho_start_s", vec![start_s]),
        ]
    };
    let words = ["analyse", "a.npz", "--channel=acc", "--tacho=tacho", "--bearing=6205", "--out=o"];
    npz::write(&desk.join("a.npz"), &channels(2.8), &[]).expect("room");
    let told = desk.run(&words);
    says(&told, &["a defect of the outer raceway", "`tacho` begins 0.8000 s after `acc`"]);
    npz::write(&desk.join("a.npz"), &channels(90.0), &[]).expect("room");
    says(&desk.run(&words), &["have no time in common", "88.000 s after"]);
}

#[test]
fn issue_a_velocity_has_its_zone_and_a_voltage_a_reason() {
    let desk = Desk::new("zones");
    let mut noise = Noise::new(2);
    let sine = (0..1 << 15).map(|n| (std::f64::consts::TAU * 100.0 * f64::from(n) / RATE_HZ).sin());
    let samples: Vec<f64> = sine.map(|x| 4.0 * 2.0_f64.sqrt() * x + 1e-3 * noise.uniform()).collect();
    let acc = Channel::held("acc", samples).at_rate(Some(RATE_HZ));
    npz::write(&desk.join("a.npz"), &[acc], &[]).expect("room");
    let asked = |unit: &str| {
        let words = ["analyse", "a.npz", "--iso-group=2", "--foundation=rigid", "--out=o", "-q", unit];
        let told = said(&desk.run(&words));
        (told, desk.text("o/findings.json"))
    };
    let (told, findings) = asked("--unit=mm/s");
    assert!(told.contains("zone C") && findings.contains("\"zone\": \"C\""), "{told}");
    let (told, findings) = asked("--unit=V");
    assert!(
        told.contains("no zone") && findings.contains("`V` is no unit of acceleration or velocity"),
        "{told}"
    );
}

#[test]
fn issue_names_in_files_and_of_files_do_not_steer_a_terminal() {
    let desk = Desk::new("escapes");
    let name = "\u{1b}[31mACC\u{7} \u{202e}gpj";
    let rows: String =
        (0..2000).map(|n| format!("{:.6},{},1\n", f64::from(n) / RATE_HZ, (n * 37) % 101)).collect();
    fs::write(desk.join("a\u{1b}[2J.csv"), format!("time_s,{name},b\n{rows}")).expect("room");
    fs::write(desk.join("bad.ron"), "(name: \"\u{1b}[31m\", be\u{1b}[2Jaring: 3)").expect("room");
    for words in [
        &["analyse", "a\u{1b}[2J.csv", "--out=o", "-v"][..],
        &["analyse", "a\u{1b}[2J.csv", "--channel=no\u{9b}", "--out=o"],
        &["analyse", "gone\u{1b}[2J", "--out=o"],
        &["compare", "a\u{1b}[2J.csv", "a\u{1b}[2J.csv", "--out=c"],
        &["simulate", "bad.ron"],
        &["rm", "y\u{1b}[2J", "-y"],
        &["list", "--\u{1b}[2J"],
    ] {
        let told = said(&desk.run(words));
        let steers = |c: char| c.is_control() && c != '\n' && c != '\t' || c == '\u{202e}';
        assert!(!told.contains(steers), "{words:?}: {told:?}");
        assert!(
            ["\\x1b", "\\u009b", "0x1b"].iter().any(|word| told.contains(word))
                || told.contains("a defect")
                || words[0] == "list",
            "{words:?}: {told}"
        );
    }
}

#[test]
fn issue_a_speed_that_no_shaft_has_is_out_of_range_at_once() {
    let desk = Desk::new("speeds");
    let mut noise = Noise::new(4);
    let acc: Vec<f64> = (0..4096).map(|_| noise.uniform()).collect();
    let named = Channel::held("rpm", vec![1e9]);
    let channels = [Channel::held("acc", acc).at_rate(Some(RATE_HZ)), named];
    npz::write(&desk.join("a.npz"), &channels, &[]).expect("room");
    let began = std::time::Instant::now();
    for words in [&["--speed-rpm=1e9"][..], &["--speed-rpm=1..1e9"], &[]] {
        let words = [&["analyse", "a.npz", "--bearing=6205", "--out=o"], words].concat();
        says(&desk.run(&words), &["shafts turn 0.001 to 1000000 times a minute"]);
    }
    // Families far beyond half the rate take no time.
    let words = [
        "analyse",
        "a.npz",
        "--bearing=elements=20, diameter_mm=0.1, pitch_mm=1e5",
        "--speed-rpm=1e5",
        "--out=o",
    ];
    says(&desk.run(&words), &["far above half of the 12800 samples a second"]);
    assert!(began.elapsed().as_secs_f64() < 30.0, "{:?}", began.elapsed());
}

/// An archive of 8 MB took 4.1 GB, and was then called damaged.
#[cfg(target_os = "linux")]
#[test]
fn refuses_a_file_larger_than_memory_in_words_and_not_by_an_abort() {
    let desk = Desk::new("bombs");
    // Two numbers in three bits: ten million zeros in some kilobytes.
    let head = "{'descr': '<f8', 'fortran_order': False, 'shape': (30000000,), }";
    let head = format!("{head:<117}\n");
    let bytes =
        [b"\x93NUMPY\x01\0", &118_u16.to_le_bytes()[..], head.as_bytes(), &vec![0; 240_000_000]].concat();
    let mut archive = zip::ZipWriter::new(fs::File::create(desk.join("a.npz")).expect("room"));
    let options =
        zip::write::SimpleFileOptions::default().compression_method(zip::CompressionMethod::Deflated);
    archive.start_file("acc.npy", options).expect("room");
    std::io::Write::write_all(&mut archive, &bytes).expect("room");
    archive.finish().expect("room");
    let limited = |kib: u64, words: &str| {
        let line = format!("ulimit -v {kib}; exec {STRIBECK} analyse a.npz --rate-hz 12800 --out o {words}");
        Command::new("sh").current_dir(desk.path()).args(["-c", &line]).output().expect("a shell")
    };
    for (kib, words) in [(1_000_000, ""), (4_000_000, "--max-memory 100MB")] {
        let told = limited(kib, words);
        assert_eq!(told.status.code(), Some(1), "{}", said(&told));
        says(&told, &["array `acc` would take 480.0 MB", "`--max-memory` allows more"]);
    }
    says(&limited(4_000_000, "--max-memory 2GB"), &["is constant"]);
    let refused = desk.run("analyse a.npz --max-memory=much");
    says(&refused, &["is no size of memory, such as 500MB"]);
}

/// A limit on the size of files ended a run by a signal, without a word.
#[cfg(target_os = "linux")]
#[test]
fn survives_a_limit_on_the_size_of_files_with_words() {
    let desk = Desk::new("file-limit");
    fs::copy(crate::common::QUICK, desk.join("quick.ron")).expect("room");
    let line = format!(
        "ulimit -f 4; exec {STRIBECK} simulate quick.ron --threads 1 --no-report --set solver.duration_ms=0.3"
    );
    let told = Command::new("sh").current_dir(desk.path()).args(["-c", &line]).output().expect("a shell");
    assert_eq!(told.status.code(), Some(1), "{}", said(&told));
    says(&told, &["error:", "too large"]);
}
