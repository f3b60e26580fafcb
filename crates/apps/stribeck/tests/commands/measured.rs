//! Measured signals and exported runs, as users meet them.

use crate::common::Desk;
use stribeck_formats::{Channel, Recording, mat5};
use stribeck_testing::{Noise, assert_has, said, says};

/// Impacts of an outer raceway of a 6205 at 1200 rpm.
fn impacts(rate_hz: f64) -> Vec<f64> {
    let mut noise = Noise::new(5);
    (0..100_000)
        .map(|n| {
            let since = (f64::from(n) / rate_hz).rem_euclid(1.0 / 71.5);
            noise.uniform() + 3.0 * (-since / 1e-3).exp() * (std::f64::consts::TAU * 3_000.0 * since).sin()
        })
        .collect()
}

/// Writes a record of `housing` at 12.8 kHz, beside numbers.
fn write(desk: &Desk, file: &str, samples: Vec<f64>, numbers: &[(&str, f64)]) {
    let mut channels = vec![Channel::held("housing", samples).at_rate(Some(12_800.0))];
    channels.extend(numbers.iter().map(|(name, number)| Channel::held(*name, vec![*number])));
    mat5::write(&desk.join(file), &channels, &[]).unwrap();
}

/// The first number whose name has `rpm` in it was the speed, `max_rpm` beside `rpm`, too, and 0 was one.
#[test]
fn issue_the_speed_is_that_of_rpm_and_not_of_another_number() {
    let desk = Desk::new("measured-rpm");
    for (numbers, says) in [
        (&[("max_rpm", 6000.0), ("rpm", 1200.0)][..], "the speed of 1200 rpm is that of `rpm`"),
        (&[("rpm_a", 1200.0), ("rpm_b", 0.0)], "the speed of 1200 rpm is that of `rpm_a`"),
        (
            &[("rpm_a", 1200.0), ("rpm_b", 900.0)],
            "`rpm_a` is 1200 and `rpm_b` is 900: neither is taken for the speed; give `--speed-rpm`",
        ),
    ] {
        write(&desk, "a.mat", impacts(12_800.0), numbers);
        let words = ["analyse", "a.mat", "--rate-hz=12800", "--bearing=6205", "--channel=housing"];
        let text = said(&desk.run(&words));
        assert!(text.contains(says), "{text}");
    }
}

#[test]
fn planted_a_record_gives_a_verdict_findings_and_a_page() {
    let desk = Desk::new("measured");
    write(&desk, "a.mat", impacts(12_800.0), &[("shaft_rpm", 1200.0)]);
    let text = said(&desk.succeeds("analyse a.mat --rate-hz 12800 --bearing 6205 --channel housing"));
    assert!(text.contains("a defect of the outer raceway (BPFO at 71.50 Hz"), "{text}");
    assert!(text.contains("the speed of 1200 rpm is that of `shaft_rpm`"), "{text}");
    let findings = desk.json("a-analysis/findings.json");
    assert_eq!(findings["families"][0]["name"], "BPFO");
    assert_eq!(findings["families"][0]["claimed"], true);
    // A passage has one impact, which is no length.
    assert!(findings["spall_mm"].is_null() && findings["spall_below_mm"].as_f64().is_some_and(|mm| mm > 0.0));
    assert!(text.contains("no second event follows each impact"), "{text}");
    for key in ["rate_hz", "speed_rpm", "resolution_hz", "verdict"] {
        assert!(!findings[key].is_null(), "{key}");
    }
    for key in ["expected_hz", "measured_hz", "harmonics", "level_db", "p_value"] {
        assert!(findings["families"][0][key].is_number(), "{key}");
    }
    let page = desk.text("a-analysis/report.html");
    assert_has(
        &page,
        &["Squared envelope spectrum about BPFO", "Enhanced envelope spectrum", "id=\"spectrogram\""],
    );
    // Probability and length stand under the heading.
    let places = ["<h1>", "healthy bearing shows as much", "Not determined: one impact", "<h2"];
    let places = places.map(|words| page.find(words).expect(words));
    assert!(places.is_sorted(), "{places:?}");
}

/// The sheet for whoever decides: without a browser it says where it is, and a later analysis leaves no older one.
#[test]
fn behaves_the_verdict_on_one_page_is_written_beside_the_report() {
    let desk = Desk::new("measured-pdf");
    write(&desk, "a.mat", impacts(12_800.0), &[("shaft_rpm", 1200.0)]);
    let words = "analyse a.mat --rate-hz 12800 --bearing 6205 --channel housing";
    let mut command = desk.command(format!("{words} --pdf").as_str());
    let output = command.env("STRIBECK_BROWSER", "/nowhere/chromium").output().expect("it starts");
    let text = said(&output);
    assert!(!output.status.success() && text.contains("/nowhere/chromium"), "{text}");
    let sheet = desk.text("a-analysis/verdict.html");
    assert_has(&sheet, &["Defect of the outer raceway", "How sure", "How long", "Not seen", "Next", "a.mat"]);
    desk.succeeds(words);
    assert!(!desk.join("a-analysis/verdict.html").exists());
}

#[test]
fn refuses_a_record_with_what_to_give() {
    let desk = Desk::new("measured-refused");
    let table: String = (0..2000).map(|n| format!("{},{}\n", f64::from(n).sin(), n % 7)).collect();
    std::fs::write(desk.join("a.csv"), format!("x,y\n{table}")).unwrap();
    std::fs::write(desk.join("b.csv"), "x,y\n1,2\n3,oops\n").unwrap();
    let timed: String =
        (0..2000).map(|n| format!("{},{}\n", f64::from(n) / 25_600.0, f64::from(n).sin())).collect();
    std::fs::write(desk.join("t.csv"), format!("time_s,x\n{timed}")).unwrap();
    desk.succeeds("analyse t.csv --rate-hz 25600");
    for (words, says) in [
        (
            vec!["analyse", "t.csv", "--rate-hz", "12000"],
            "was sampled at 25600 Hz, and `--rate-hz` says 12000 Hz",
        ),
        (vec!["analyse", "a.csv"], "give `--rate-hz`"),
        (vec!["analyse", "a.csv", "--channel", "z"], "it has `x` (2000 samples), `y` (2000 samples)"),
        (vec!["analyse", "a.csv", "--rate-hz", "100", "--bearing", "6999"], "no bearing `6999` is known"),
        (vec!["analyse", "a.csv", "--rate-hz", "0"], "give one above 0"),
        (vec!["analyse", "b.csv", "--rate-hz", "100", "--channel", "y"], "1024 are the least"),
        (vec!["analyse", "c.csv"], "`c.csv` cannot be read"),
    ] {
        desk.refuses(&words, &[says]);
    }
}

#[test]
fn behaves_a_run_is_exported_and_read_back() {
    let desk = Desk::new("exported");
    std::fs::copy(
        concat!(env!("CARGO_MANIFEST_DIR"), "/../../../fixtures/scenes/quick.ron"),
        desk.join("quick.ron"),
    )
    .unwrap();
    let coarse = [
        "simulate",
        "quick.ron",
        "--set=mesh.size_mm=4.0",
        "--set=mesh.roller_facets=40",
        "--set=solver.start=sudden",
        "--threads=1",
        "--no-report",
        "--set=output.frames=(from_ms: 0.1, to_ms: 0.2, every_us: 50.0, half_width_mm: 12.0)",
        "--set=solver.duration_ms=0.5",
    ];
    desk.succeeds(&coarse);
    let trace = Recording::open(desk.join("runs/quick/trace.npy")).unwrap();
    let name = trace.channels.iter().map(|c| c.name.clone()).find(|n| n.ends_with("ay_m_s2")).unwrap();
    for (format, end) in [("csv", "csv"), ("npz", "npz"), ("mat", "mat"), ("uff", "uff"), ("wav64", "wav")] {
        desk.succeeds(&["export", "quick", "--to", format, "--channel", &name]);
        let path = desk.join(format!("runs/quick/trace.{end}"));
        let found = Recording::open(&path).unwrap();
        let read = found
            .channels
            .iter()
            .find(|c| c.len == trace.channel(&name).unwrap().len && !c.name.starts_with("time"))
            .unwrap();
        let (ours, theirs) = (read.read().unwrap(), trace.channel(&name).unwrap().read().unwrap());
        // A universal file has thirteen digits.
        assert!(ours.iter().zip(&theirs).all(|(a, b)| (a - b).abs() <= 5e-13 * b.abs()), "{format}");
    }
    // The first sample is not at zero, whatever is chosen, and in a sensor's record neither.
    let first = trace.channel("time_s").unwrap().read().unwrap()[0];
    for more in
        [&["--channel=roller.1"][..], &["--sensor=", "--channel=ay"], &["--sensor=rate_hz=20000"], &[]]
    {
        let words = [&["export", "quick", "--to=csv", "--out=tables/some.csv"], more].concat();
        desk.succeeds(&words);
        let table = Recording::open(desk.join("tables/some.csv")).unwrap();
        // A table has fifteen digits.
        let begins = table.channel("time_s").unwrap().read().unwrap()[0];
        assert!((begins - first).abs() <= 1e-15 * first, "{more:?}: {begins}");
    }
    // A file of another kind is not written over, and a run neither.
    for out in ["runs/quick/scene.ron", "runs/quick/trace.npy", "runs", "quick.ron"] {
        let before = std::fs::read(desk.join(out)).ok();
        let output = desk.run(&["export", "quick", "--to=csv", "--out", out]);
        assert!(!output.status.success(), "{out}");
        says(&output, &["is there and is no `.csv` file"]);
        assert_eq!(std::fs::read(desk.join(out)).ok(), before, "{out}");
    }
    let output = desk.run("export quick --to=pvd --out=runs/quick");
    says(&output, &["is the folder of a run"]);
    for word in ["pvd", "vtu"] {
        let output = desk.succeeds(&["export", "quick", "--to", word]);
        says(&output, &["runs/quick/paraview/frames.pvd"]);
    }
    let index = desk.text("runs/quick/paraview/frames.pvd");
    assert_eq!(index.matches("<DataSet").count(), 3, "{index}");
    let grid = std::fs::read(desk.join("runs/quick/paraview/frame-00000.vtu")).unwrap();
    assert!(String::from_utf8_lossy(&grid[..4000.min(grid.len())]).contains("von_mises_pa"));
    desk.succeeds("export quick --to npz --out s.npz --sensor 'rate_hz=50000, bits=16, range=5000'");
    assert_eq!(Recording::open(desk.join("s.npz")).unwrap().channels[0].rate_hz, Some(50_000.0));
    let output = desk.run("export quick --to csv --channel nothing");
    assert!(said(&output).contains("no channel contains `nothing`"), "{}", said(&output));
}

#[test]
fn planted_a_speed_that_varies_is_followed_and_the_record_taken_over_the_angle() {
    let desk = Desk::new("ridge");
    let mut noise = Noise::new(8);
    let rate_hz = 12_800.0;
    // From 1200 to 1500 rpm in 24 s, an outer raceway of a 6205 with impacts, and a weak line of the shaft.
    let samples = (0..300_000)
        .map(|n| {
            let t = f64::from(n) / rate_hz;
            let turns = 20.0 * t + 0.5 * (5.0 / 24.0) * t * t;
            let speed = 20.0 + 5.0 / 24.0 * t;
            let since = (3.575 * turns).fract() / (3.575 * speed);
            noise.uniform()
                + 0.3 * (std::f64::consts::TAU * turns).sin()
                + 3.0 * (-since / 1e-3).exp() * (std::f64::consts::TAU * 3_000.0 * since).sin()
        })
        .collect();
    write(&desk, "a.mat", samples, &[]);
    let words = |speed: &'static str, out: &'static str| {
        ["analyse", "a.mat", "--rate-hz=12800", "--bearing=6205", "--channel=housing", speed, out]
    };
    let told = ["a defect of the outer raceway", "taken over the angle of the shaft"];
    desk.says(&words("--speed-rpm=1100..1700", "--out=followed"), &told);
    // Held at its mean the speed smears the family.
    desk.succeeds(&words("--speed-rpm=1350", "--out=held"));
    let level = |folder: &str| {
        desk.json(&format!("{folder}/findings.json"))["families"][0]["level_db"].as_f64().unwrap()
    };
    assert!(level("followed") > level("held") + 10.0, "{} {}", level("followed"), level("held"));
    let none = desk.run(&words("--speed-rpm=2000..2400", "--out=none"));
    says(&none, &["no line stands out between 2000 and 2400 rpm"]);
}

#[test]
fn issue_a_tachometer_outlasts_its_record_or_says_the_speed() {
    let desk = Desk::new("measured-tacho");
    let rate_hz = 12_800.0;
    // 18 t + 0.3 t² turns: the record lasts 5.12 s, the tachometer 6.25 s.
    let turns = |n: usize| 18.0 * n as f64 / rate_hz + 0.3 * (n as f64 / rate_hz).powi(2);
    let acc = impacts(rate_hz)[..65_536].to_vec();
    let tacho = (0..80_000).map(|n| f64::from(turns(n).fract() < 0.1)).collect();
    let speed = (0..acc.len()).map(|n| 60.0 * (18.0 + 0.6 * n as f64 / rate_hz)).collect();
    let channels = [("acc", acc), ("tacho", tacho), ("n_rpm", speed), ("fs", vec![rate_hz])];
    let channels = channels.map(|(name, samples)| Channel::held(name, samples));
    mat5::write(&desk.join("a.mat"), &channels, &[]).unwrap();
    for tacho in ["tacho", "n_rpm"] {
        let line = format!("analyse a.mat --channel=acc --tacho {tacho} --bearing=6205 --out {tacho}");
        desk.says(line.as_str(), &["the record was taken over the angle of the shaft"]);
        let findings = desk.json(&format!("{tacho}/findings.json"));
        // The mean speed of the record: 18 + 0.3 · 5.12 turns a second, to a turn of 100.
        let rpm = findings["speed_rpm"].as_f64().unwrap();
        assert!((rpm / (60.0 * (18.0 + 0.3 * 5.12)) - 1.0).abs() < 0.01, "{tacho}: {rpm}");
    }
}

/// Whether a level of a record is within its limits.
fn state<'a>(found: &'a serde_json::Value, at: usize, quantity: &str) -> &'a str {
    let alarms = found["records"][at]["alarms"].as_array().unwrap();
    let judged = alarms.iter().find(|alarm| alarm["quantity"] == quantity);
    judged.unwrap_or_else(|| panic!("{quantity}: {alarms:?}"))["state"].as_str().unwrap()
}

#[test]
fn behaves_limits_are_given_or_follow_from_sound_records() {
    let desk = Desk::new("alarm");
    let mut noise = Noise::new(10);
    for n in 0..6 {
        let loud = if n == 5 { 2.0 } else { 1.0 + 0.01 * f64::from(n) };
        let samples: Vec<f64> = (0..40_000).map(|_| loud * noise.uniform()).collect();
        write(&desk, &format!("{n}.mat"), samples, &[]);
    }
    let line =
        "analyse 0.mat 1.mat 2.mat 3.mat 4.mat 5.mat --rate-hz=12800 --unit=m/s² --out=T --channel=housing";
    let text = said(&desk.succeeds(format!("{line} --reference=4 --alarm=kurtosis=1.5..9").as_str()));
    let (_, last) = text.split_once("  5.mat: ").expect("a line of each record");
    assert!(last.contains("\n    rms 1.1") && text.contains("ALARM: rms in record 6."), "{text}");
    let (_, fifth) = text.split_once("  4.mat: ").expect("a line of each record");
    let fifth = fifth.split("  5.mat: ").next().unwrap_or(fifth);
    assert!(!fifth.contains("rms"), "{text}");
    assert!(fifth.contains("kurtosis 1.") && fifth.contains("WARNING, from 1.5000"), "{text}");
    let found = desk.json("T/findings.json");
    assert_eq!((state(&found, 4, "rms"), state(&found, 5, "rms")), ("good", "alarm"));
    assert!(found["records"][5]["findings"]["velocity_mm_s"].is_number());
    let page = desk.text("T/report.html");
    assert!(page.contains("Alarm bands"));
    for (more, says) in [
        ("--reference=2", "at least 3"),
        ("--reference=6", "6 files were given"),
        ("--alarm=rms=1", "NAME=WARNING..ALARM"),
        ("--speed-rpm=1500..1400", "must ascend"),
    ] {
        desk.refuses(format!("{line} {more}").as_str(), &[says]);
    }
}

/// `--reference` gave no limits for families, because none stands out in a healthy record.
#[test]
fn issue_sound_records_give_limits_for_each_family() {
    let desk = Desk::new("alarm-families");
    let mut noise = Noise::new(11);
    for n in 0..7 {
        let samples =
            if n == 6 { impacts(12_800.0) } else { (0..100_000).map(|_| noise.uniform()).collect() };
        write(&desk, &format!("{n}.mat"), samples, &[]);
    }
    desk.succeeds(
        "analyse 0.mat 1.mat 2.mat 3.mat 4.mat 5.mat 6.mat --rate-hz=12800 --bearing=6205 --speed-rpm=1200 \
         --reference=6 --out=T",
    );
    let found = desk.json("T/findings.json");
    for name in ["BPFO", "BPFI", "BSF", "FTF"] {
        assert_eq!(state(&found, 0, name), "good", "a record of the reference");
    }
    assert_eq!(state(&found, 6, "BPFO"), "alarm");
}

#[test]
fn behaves_several_records_are_a_series() {
    let desk = Desk::new("trend");
    let mut noise = Noise::new(9);
    let sound: Vec<f64> = (0..100_000).map(|_| noise.uniform()).collect();
    // The second one is cut off at half of its largest value.
    let whole = impacts(12_800.0);
    let rail = 0.5 * whole.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let clipped = whole.iter().map(|x| x.clamp(-rail, rail)).collect();
    for (name, samples) in [("before.mat", sound), ("after.mat", clipped)] {
        write(&desk, name, samples, &[("shaft_rpm", 1200.0)]);
    }
    let words =
        ["analyse", "before.mat", "after.mat", "none.mat", "--rate-hz=12800", "--bearing=6205", "--out=T"];
    // The others are analysed, and the missing one is reported once.
    let output = desk.run(&words);
    let text = said(&output);
    assert!(!output.status.success() && text.contains("1 of 3 records could not be analysed"), "{text}");
    assert_eq!((text.matches("No such file").count(), text.matches("none.mat").count()), (1, 2), "{text}");
    assert!(text.contains("In 1 of 2 records a sensor has spoilt samples"), "{text}");
    let found = desk.json("T/findings.json");
    let claimed = |at: usize| {
        let families = found["records"][at]["findings"]["families"].as_array().unwrap();
        families
            .iter()
            .filter(|f| f["claimed"] == true)
            .map(|f| f["name"].as_str().unwrap().to_owned())
            .collect::<Vec<_>>()
    };
    assert_eq!((claimed(0), claimed(1)), (vec![], vec!["BPFO".to_owned()]));
    assert!(
        found["records"][2]["findings"].is_null()
            && found["records"][2]["error"].as_str().unwrap().contains("none.mat")
    );
    let page = desk.text("T/report.html");
    assert!(page.contains("2-after/report.html"));
    assert!(desk.join("T/1-before/findings.json").exists());
}

/// Snapshots of one channel whose outer raceway strikes from the seventh on, in the forms of two public
/// collections of runs to failure: tables without a header, times in four columns, and files without a sample
/// rate whose names are times.
#[test]
fn planted_a_folder_is_a_series_with_an_onset() {
    let desk = Desk::new("series");
    let mut noise = Noise::new(12);
    let impacts = impacts(12_800.0);
    let loud = |n: usize| if n < 7 { 0.0 } else { 0.2 * (n - 5) as f64 };
    for (folder, separator) in [("times", ","), ("semicolons", ";"), ("names", "\t")] {
        std::fs::create_dir(desk.join(folder)).unwrap();
        for n in 1..=10 {
            let row = |(at, impact): (usize, &f64)| {
                let x = noise.uniform() + loud(n) * impact;
                let us = (1e6 * at as f64 / 12_800.0).round() + 999_000.0;
                let (s, us) = (12 + us as u64 / 1_000_000, us as u64 % 1_000_000);
                let clock = [9.to_string(), 39.to_string(), s.to_string(), us.to_string()];
                let values = [format!("{x:.5}"), "0.000".to_owned()];
                let all = if folder == "names" { values.to_vec() } else { [&clock[..], &values].concat() };
                all.join(separator) + "\n"
            };
            let text: String = impacts.iter().take(40_000).enumerate().map(row).collect();
            let name =
                if folder == "names" { format!("2004.02.12.{n}.52.39") } else { format!("acc_{n}.csv") };
            std::fs::write(desk.join(folder).join(name), text).unwrap();
        }
        let rate: &[&str] = if folder == "names" { &["--rate-hz=12800"] } else { &[] };
        let words = ["analyse", folder, "--bearing=6205", "--speed-rpm=1200", "--reference=4", "--out"];
        let out = format!("{folder}-out");
        let output = desk.run(&[&words[..], &[&out], rate].concat());
        let text = said(&output);
        assert!(output.status.success(), "{text}");
        let read = std::fs::read(desk.join(&out).join("findings.json")).unwrap();
        let found: serde_json::Value = serde_json::from_slice(&read).unwrap();
        let outer = &found["series"]["families"][0];
        assert_eq!((&outer["name"], &outer["claimed"]), (&"BPFO".into(), &true.into()), "{text}");
        assert_eq!(outer["onset"]["record"], 7, "{text}");
        let last = found["records"][9]["file"].as_str().unwrap();
        assert!(last.contains("10"), "numbers count by their value: {last}");
        let page = std::fs::read_to_string(desk.join(&out).join("report.html")).unwrap();
        assert!(page.contains("from record 7 on"), "{folder}");
    }
    desk.refuses("analyse . --bearing=6205", &["folder of files of signals"]);
}

#[test]
fn planted_channels_of_one_machine_make_one_verdict() {
    let desk = Desk::new("together");
    let mut noise = Noise::new(9);
    let impacts = impacts(12_800.0);
    let far: Vec<f64> = impacts.iter().map(|x| 0.2 * x + 0.2 * noise.uniform()).collect();
    let channels = [("drive_end", impacts), ("fan_end", far)];
    let channels = channels.map(|(name, samples)| Channel::held(name, samples).at_rate(Some(12_800.0)));
    mat5::write(&desk.join("both.mat"), &channels, &[]).unwrap();
    mat5::write(&desk.join("one.mat"), &channels[..1], &[]).unwrap();
    let of = |file: &str| {
        let words = ["analyse", file, "--together", "--rate-hz=12800", "--bearing=6205", "--speed-rpm=1200"];
        let output = desk.run(&[&words[..], &["--out=J"]].concat());
        (output.status.success(), said(&output))
    };
    let (done, text) = of("both.mat");
    assert!(done && text.contains("2 channels together show a defect of the outer raceway"), "{text}");
    assert!(text.contains("drive_end is nearest"), "{text}");
    let joint = desk.json("J/joint.json");
    assert_eq!(joint["families"][0]["nearest"], "drive_end");
    assert!(desk.join("J/joint.html").exists() && desk.join("J/2-fan_end/findings.json").exists());
    let (done, text) = of("one.mat");
    assert!(!done && text.contains("takes two at least"), "{text}");
}

/// Impacts beside their times, as a table.
fn table(head: &str, rate_hz: f64, time: impl Fn(f64) -> String) -> String {
    let row = |(n, x): (usize, f64)| format!("{},{x:.6}\n", time(n as f64 / rate_hz));
    head.to_owned() + &impacts(rate_hz).into_iter().enumerate().map(row).collect::<String>()
}

/// The time column was diagnosed, and showed no defect; one in milliseconds was read in seconds.
#[test]
fn issue_a_column_of_times_is_no_signal_and_says_the_rate() {
    let desk = Desk::new("measured-times");
    let text = table("t,a\n[ms],[g]\n", 12_800.0, |t| format!("{:.7}", t * 1e3));
    std::fs::write(desk.join("a.csv"), text).unwrap();
    for more in [&[][..], &["--rate-hz=12800"]] {
        let words = [&["analyse", "a.csv", "--bearing=6205", "--speed-rpm=1200"], more].concat();
        let output = desk.succeeds(&words);
        says(&output, &["a defect of the outer raceway (BPFO at 71.5"]);
    }
    desk.refuses("analyse a.csv --channel t", &["it is no signal"]);
    // In milliseconds without a word of it no rate follows, and the one that is given decides.
    std::fs::write(desk.join("b.csv"), table("", 12_800.0, |t| format!("{:.4}", 1e3 * t))).unwrap();
    let words = ["analyse", "b.csv", "--bearing=6205", "--speed-rpm=1200"];
    let output = desk.run(&words);
    assert!(!output.status.success(), "{}", said(&output));
    let either = "12.8 Hz if these are seconds, 12800 Hz if they are milliseconds: no rate follows";
    says(&output, &["does not say how fast it was sampled: give `--rate-hz`", either]);
    let output = desk.run(&[&words[..], &["--rate-hz=12800"]].concat());
    says(&output, &["a defect of the outer raceway", either]);
    // The message on a rate that is too low names a sufficient one.
    let output = desk.run(&[&words[..], &["--rate-hz=12.8"]].concat());
    says(
        &output,
        &["cannot tell whether there is a defect", "harmonics of 71.7 Hz: sample at 610 Hz or faster"],
    );
}

#[test]
fn issue_a_wrong_rate_in_a_file_can_be_overruled() {
    let desk = Desk::new("measured-force");
    let text = table("t [s],acc\n", 12_800.0, |t| format!("{t:.7}"));
    std::fs::write(desk.join("a.csv"), text).unwrap();
    // Twice the rate is twice the speed.
    let words = ["analyse", "a.csv", "--bearing=6205", "--speed-rpm=2400", "--rate-hz=25600"];
    let output = desk.run(&words);
    assert!(!output.status.success() && said(&output).contains("`--force-rate`"), "{}", said(&output));
    let output = desk.run(&[&words[..], &["--force-rate"]].concat());
    says(&output, &["a defect of the outer raceway (BPFO at 142.9", "the file says 12800 Hz"]);
}

/// What we export as `.mat` did not say its rate when it was analysed.
#[test]
fn roundtrip_an_exported_record_says_its_rate() {
    let desk = Desk::new("measured-export");
    write(&desk, "ex.mat", impacts(12_800.0), &[]);
    let words = ["analyse", "ex.mat", "--channel=housing", "--bearing=6205", "--speed-rpm=1200"];
    says(&desk.run(&words), &["a defect of the outer raceway"]);
    // A limit of the velocity asks for the unit that it needs.
    let limited = [&words[..], &["--alarm=velocity=2.8..7.1"]].concat();
    says(&desk.run(&limited), &["velocity: the samples have no unit of an acceleration; give `--unit g`"]);
    for (scale, says) in
        [("0", "`0`: must be a number above 0 or below 0"), ("nan", "`nan`: must be"), ("x", "`x`: must be")]
    {
        desk.refuses(&[&words[..], &["--scale", scale]].concat(), &[says]);
    }
    desk.succeeds(&[&words[..], &["--scale", "-0.5"]].concat());
}

/// Two impacts 2.5 ms apart each time an element of a 6205 at 1200 rpm passes, never quite on time.
fn edges(rate_hz: f64) -> Vec<f64> {
    let mut noise = Noise::new(7);
    let mut signal: Vec<f64> = (0..150_000).map(|_| 0.5 * noise.uniform()).collect();
    for k in 1..200 {
        let at = (f64::from(k) + 0.02 * noise.uniform()) / 71.7;
        for (start, strength) in [(at, 1.0), (at + 2.5e-3, 0.7)] {
            let first = (start * rate_hz).ceil() as usize;
            for (n, x) in signal.iter_mut().enumerate().skip(first).take(60) {
                let since = n as f64 / rate_hz - start;
                let rings = |hz: f64| (std::f64::consts::TAU * hz * since).sin();
                *x += strength * (-since / 0.2e-3).exp() * (6.0 * rings(9_000.0) + 3.0 * rings(14_000.0));
            }
        }
    }
    signal
}

/// The bearing in its housing says how far it presses an element together: in a rigid one between half of
/// what the formula says and one and a half times as much (THEORY §7.9), with less of an interval.
#[test]
fn planted_a_length_by_a_simulated_scene_of_the_bearing() {
    let desk = Desk::new("simulated-length");
    let channel = Channel::held("housing", edges(51_200.0)).at_rate(Some(51_200.0));
    mat5::write(&desk.join("a.mat"), &[channel], &[]).unwrap();
    let scene = "(bearing: \"6205\", model: reduced(step_us: 5.0), housing: rigid(), film: None, mesh: \
                 (size_mm: 0.5, roller_facets: 50), contact: (surface: arc, penalty_scale: 1))";
    std::fs::write(desk.join("rigid.ron"), scene).unwrap();
    let words = ["analyse", "a.mat", "--rate-hz=51200", "--bearing=6205", "--speed-rpm=1200", "--load-n=100"];
    let spall = |more: &[&str], out: &str| {
        desk.succeeds(&[&words[..], more, &["--out", out]].concat());
        let findings = std::fs::read_to_string(desk.join(out).join("findings.json")).unwrap();
        let findings: serde_json::Value = serde_json::from_str(&findings).unwrap();
        ["value", "low", "high"].map(|key| findings["spall_mm"][key].as_f64().expect("a length"))
    };
    let (computed, simulated) = (spall(&[], "computed"), spall(&["--simulate=rigid.ron"], "simulated"));
    assert!(computed[1] < simulated[0] && simulated[0] < computed[2], "{simulated:?} {computed:?}");
    assert!(simulated[1] < simulated[0] && simulated[0] < simulated[2], "{simulated:?}");
    assert!(simulated[2] - simulated[1] < computed[2] - computed[1], "{simulated:?} {computed:?}");
    desk.refuses(&[&words[..], &["--simulate=none.ron"]].concat(), &["none.ron"]);
}
