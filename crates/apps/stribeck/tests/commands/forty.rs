//! Sixty things that somebody new types in the first hour, in their order and as a shell takes them: each does
//! what was meant, or is answered with the line that does.

use std::fs;
use std::process::{Command, Stdio};

use crate::common::{Desk, STRIBECK};
use crate::first_hour::impacts;
use stribeck_formats::{Channel, mat5, wav};
use stribeck_testing::said;

/// What follows.
#[derive(Clone, Copy)]
enum Then {
    /// It succeeds, and says this.
    Works(&'static str),
    /// It fails, and the answer has this.
    Answers(&'static str),
    /// Either: there may be no browser.
    Says(&'static str),
}
use Then::{Answers, Says, Works};

/// An own bearing in the words of a catalogue.
const CATALOGUE_WORDS: &str = "(bearing: (bore_mm: 8, outer_diameter_mm: 22, width_mm: 7, balls: 7, \
    ball_diameter: 3.969, pitch_diameter_mm: 15), operation: (load_n: 100, rpm: 1500))";

const FORTY: [(&str, Then); 59] = [
    ("stribeck --version", Works("stribeck 0.")),
    ("stribeck help sweep", Works("<FIELD=V1,V2,…>")),
    ("stribeck demo --help", Works("ten seconds")),
    // A scene.
    ("stribeck bearings 6205", Works("BPFO 3.5848")),
    ("stribeck bearing NU205", Works("rollers of 7.5 mm")),
    ("stribeck 6205", Answers("try: stribeck bearings NAME")),
    ("stribeck new mine.ron --bearing 6205 --defect outer", Works("run it: stribeck simulate mine.ron")),
    (r"printf 'NU 205\n2000\n1200\ninner\n1.5\n' | stribeck new piped.ron", Works("piped.ron")),
    ("stribeck new skate.ron --bearing 608-2RS", Works("BPFO")),
    ("stribeck new a.ron --bearing 6205 --load-kn 2", Answers("--load-n, in N")),
    ("stribeck new a.ron --bearing 6205 --load-n 2kN", Answers("`2kN` is no number above 0")),
    ("stribeck new a.ron --speed-hz 25", Answers("--speed-rpm, in rpm")),
    ("stribeck new a.ron --defect inner-race", Answers("try: outer, inner, roller or none")),
    ("stribeck plan catalogue.ron", Answers("did you mean `bearing.outside_mm` [mm]?")),
    ("stribeck plan catalogue.ron", Answers("did you mean `operation.speed_rpm` [rpm]?")),
    ("stribeck plan mine.ron --no-trial", Works("BPFO 89.62 Hz")),
    ("stribeck bearings --search ball", Answers("stribeck bearings 62")),
    ("stribeck fields operation.load_n", Works("operation.load_n = ")),
    ("stribeck fields no_such_field", Answers("lists all")),
    // Its run.
    ("stribeck simulate mine.ron", Works("report: runs/mine/report.html")),
    ("stribeck run mine.ron", Works("which is kept")),
    ("stribeck simulat mine.ron", Answers("'simulate'")),
    ("stribeck mine.ron", Answers("try: stribeck simulate SCENE.ron")),
    ("stribeck simulate 6205", Answers("`stribeck new --bearing 6205` writes a scene")),
    ("stribeck simulate mine.ron --rpm 1800", Answers("--set operation.speed_rpm=…")),
    ("stribeck simulate mine.ron --set load_kn=2", Answers("operation.load_n")),
    ("stribeck simulate mine.ron --set operation.load_n=900 --out runs/other --no-report", Works("complete")),
    ("stribeck simulate mine.ron --name second", Works("runs/second/report.html")),
    ("stribeck version", Answers("try: stribeck --version")),
    ("stribeck list", Works("other")),
    ("stribeck list --json", Works("\"name\": \"mine\"")),
    ("stribeck ls", Works("other")),
    ("stribeck open mine", Says("runs/mine/report.html")),
    ("stribeck plot mine", Says("runs/mine/report.html")),
    ("stribeck analyse mine.ron", Works("report: ")),
    // Many runs.
    ("stribeck compare mine other", Works("operation.load_n 790 → 900")),
    ("stribeck sweep mine.ron --set defect.length_mm=1,2", Works("2 of 2 runs are complete")),
    ("stribeck sweep mine.ron --length 1,2", Answers("--set defect.length_mm=…")),
    ("stribeck sweep mine.ron", Answers("--set operation.load_n=1000,2000,4000")),
    ("stribeck campaign", Answers("stribeck sweep SCENE.ron --set")),
    // Other programs.
    ("stribeck export mine --to csv", Works("runs/mine/trace.csv")),
    ("stribeck export mine csv", Answers("try: stribeck export RUN --to FORMAT")),
    ("stribeck export mine --to wav", Works("runs/mine/sound.wav")),
    ("stribeck export mine --to pvd", Answers("output.frames=()")),
    ("stribeck export record.csv --to npz", Works("record.npz")),
    ("stribeck export record.csv --to pvd", Answers("is a record")),
    ("stribeck list --max-memory 1GB", Answers("unexpected argument")),
    // Records.
    ("stribeck analyse record.csv --list-channels", Answers("--channel ?, which lists them")),
    ("stribeck analyse record.csv --channel '?'", Answers("`acc_g` (60000 samples)")),
    ("stribeck analyse record.csv --bearing 6205 --speed-rpm 1200", Works("a defect of the outer raceway")),
    (
        "stribeck analyze record.mat --bearing SKF6205-2RS --speed-rpm 1200",
        Works("a defect of the outer raceway"),
    ),
    ("stribeck analyse record.npy --bearing 6205 --speed-rpm 1200", Answers("--rate-hz")),
    ("stribeck analyse record.npy --bearing 6205 --speed-rpm 1200 --fs 12800", Answers("try: --rate-hz HZ")),
    ("stribeck record.wav", Answers("try: stribeck analyse FILE")),
    // The end of the hour.
    ("stribeck resume mine", Answers("try: stribeck simulate --resume RUN")),
    ("stribeck simulate --resume mine", Answers("--set solver.duration_ms=")),
    (
        "stribeck simulate --resume mine --no-report --set solver.duration_ms=70 && ! ls runs/mine/summary.json",
        Works("No such file"),
    ),
    ("stribeck delete other --force", Answers("--yes of rm")),
    ("stribeck rm other --yes", Works("removed 1 folder")),
];

#[test]
fn behaves_the_first_hour_of_somebody_new() {
    let desk = Desk::new("forty");
    let samples = impacts(3.0, 7);
    let rows = |form: &dyn Fn(usize, f64) -> String| -> String {
        samples.iter().enumerate().map(|(n, x)| form(n, *x)).collect()
    };
    let csv = rows(&|n, x| format!("{:.8},{x:.6}\n", n as f64 / 12_800.0));
    fs::write(desk.join("record.csv"), format!("time_s,acc_g\n{csv}")).expect("room");
    let channel = Channel::held("acc", samples.clone()).at_rate(Some(12_800.0));
    mat5::write(&desk.join("record.mat"), std::slice::from_ref(&channel), &[]).expect("room");
    wav::write(&desk.join("record.wav"), &[channel], &[]).expect("room");
    let head = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({},), }}", samples.len());
    let head = format!("\u{93}NUMPY\u{1}\u{0}v\u{0}{head:<117}\n");
    let mut npy: Vec<u8> = head.chars().map(|c| c as u8).collect();
    npy.extend(samples.iter().flat_map(|x| x.to_le_bytes()));
    fs::write(desk.join("record.npy"), npy).expect("room");
    fs::write(desk.join("catalogue.ron"), CATALOGUE_WORDS).expect("room");
    let mut wrong = Vec::new();
    for (line, then) in FORTY {
        let program = format!("'{STRIBECK}'");
        let typed = line.replacen("stribeck", &program, 1);
        let mut shell = Command::new("sh");
        let shell = shell.current_dir(desk.path()).args(["-c", &typed]).stdin(Stdio::null());
        let output = shell.output().expect("a shell");
        let (answer, works) = (said(&output), output.status.success());
        let is_right = match then {
            Works(words) => works && answer.contains(words),
            Answers(words) => !works && answer.contains(words),
            Says(words) => answer.contains(words),
        };
        if !is_right || answer.contains("panicked") {
            wrong.push(format!("$ {line}\n{answer}"));
        }
        if line.starts_with("stribeck new mine.ron") {
            // A second of it takes longer than all the others.
            let text = desk.text("mine.ron").replace("duration_ms: 1000", "duration_ms: 60");
            fs::write(desk.join("mine.ron"), text).expect("room");
        }
    }
    assert!(wrong.is_empty(), "{} of {}\n{}", wrong.len(), FORTY.len(), wrong.join("\n"));
}
