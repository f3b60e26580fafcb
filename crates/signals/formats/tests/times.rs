//! Channels of time are distinguished from signals, and the sample rate follows from them.

use stribeck_formats::{Channel, Recording, npz, parquet};
use stribeck_testing::{Noise, Scratch};

const RATE_HZ: f64 = 12_800.0;

/// A table of times, as `time` writes each, and of noise beside them.
fn table(head: &str, separator: &str, rows: usize, time: impl Fn(usize) -> String) -> String {
    let mut noise = Noise::new(3);
    let row = |n| format!("{}{separator}{:.5}\n", time(n), noise.uniform());
    head.to_owned() + &(0..rows).map(row).collect::<String>()
}

fn opened(desk: &Scratch, text: &str) -> Recording {
    let path = desk.join("a.csv");
    std::fs::write(&path, text).unwrap();
    Recording::open(path).unwrap()
}

/// Which channels are times, and the rate of the last.
fn read(recording: &Recording) -> (Vec<bool>, Option<f64>) {
    let times = recording.channels.iter().map(|c| c.is_time).collect();
    (times, recording.channels.last().unwrap().rate_hz)
}

/// The time column of `t,acc` was taken for the signal, and that in milliseconds for one in seconds.
#[test]
fn issue_times_are_recognised_by_how_they_rise_and_in_any_unit() {
    let desk = Scratch::create("formats-times");
    for (head, separator, per_second, digits) in [
        ("t,acc\n", ",", 1.0, 7),
        ("t [s],acc\n", ",", 1.0, 7),
        ("", ",", 1.0, 7),
        ("\u{feff}time_s,acc\n", ",", 1.0, 7),
        ("\u{feff}", ",", 1.0, 7),
        ("X_Value\tacc\n", "\t", 1.0, 7),
        ("Zeit [s];Beschleunigung [g]\n", ";", 1.0, 5),
        ("Zeit;Beschleunigung\n[s];[g]\n", ";", 1.0, 5),
        ("zeit,acc\nms,g\n", ",", 1e3, 5),
        ("time_ms,acc\n", ",", 1e3, 4),
        ("time [us],acc\n", ",", 1e6, 0),
        ("t/µs,acc\n", ",", 1e6, 1),
        ("Time (ns),acc\n", ",", 1e9, 0),
        ("t_min,acc\n", ",", 1.0 / 60.0, 9),
        ("t [h],acc\n", ",", 1.0 / 3600.0, 11),
        // Several rows have one time.
        ("t,acc\n", ",", 1.0, 3),
        ("acc_time,acc\n", ",", 1.0, 6),
    ] {
        let text =
            table(head, separator, 30_000, |n| format!("{:.digits$}", n as f64 / RATE_HZ * per_second));
        let (times, rate_hz) = read(&opened(&desk, &text));
        assert_eq!(times, [true, false], "{head:?}");
        let rate_hz = rate_hz.unwrap_or_else(|| panic!("no rate from {head:?}"));
        // The last digit of a thousandth in 2.3 s.
        assert!((rate_hz / RATE_HZ - 1.0).abs() < 5e-4, "{head:?} gives {rate_hz}");
    }
    for (head, separator) in [
        ("t/ms,a/g\n", ","),
        ("Kanal,Messung 3\nt/ms,a/g\n", ","),
        ("t/ms;a/g\n\n", ";"),
        ("t (msec);a/g\n", ";"),
    ] {
        let found =
            opened(&desk, &table(head, separator, 20_000, |n| format!("{:.5}", n as f64 / RATE_HZ * 1e3)));
        assert_eq!((found.channels[1].name.as_str(), read(&found).1), ("a/g", Some(RATE_HZ)), "{head:?}");
    }
    let units = opened(&desk, &table("Zeit;a\n[s];[g]\n", ";", 20, |n| n.to_string()));
    assert_eq!((units.channels[1].name.as_str(), units.channels[1].unit.as_deref()), ("a", Some("g")));
}

#[test]
fn issue_a_rate_that_contradicts_the_times_is_none() {
    let desk = Scratch::create("formats-contradiction");
    let times = |n: usize| format!("{:.6}", n as f64 / RATE_HZ);
    for (head, agrees) in [("# fs = 12800 Hz\n", true), ("# fs = 25.6k\n", false), ("# fs = 6400\n", false)] {
        let found = opened(&desk, &table(&format!("{head}time_s,acc\n"), ",", 20_000, times));
        assert_eq!(found.channels[1].rate_hz, agrees.then_some(RATE_HZ), "{head}");
        assert_eq!(
            found.notes.iter().any(|note| note.contains("give the one that holds")),
            !agrees,
            "{head}"
        );
    }
}

#[test]
fn issue_a_count_is_no_signal_and_says_no_rate() {
    let desk = Scratch::create("formats-counts");
    let recording = opened(&desk, &table(",acc\n", ",", 3000, |n| n.to_string()));
    assert_eq!(read(&recording), (vec![true, false], None));
    assert!(recording.notes[0].contains("does not say its unit: no rate follows"), "{:?}", recording.notes);
    // Nor does an angle.
    let recording =
        opened(&desk, &table("shaft_rad,acc\n", ",", 3000, |n| format!("{:.5}", 0.01 * n as f64)));
    assert_eq!(read(&recording), (vec![true, false], None));
}

/// What moves slowly, falls again or lies in noise is a signal, whatever its beginning looks like.
#[test]
fn planted_a_signal_is_no_time() {
    let desk = Scratch::create("formats-signals");
    let mut noise = Noise::new(2);
    let signals: [Box<dyn FnMut(f64) -> f64>; 5] = [
        Box::new(|n| (1e-4 * n).sin()),
        Box::new(|n| f64::from(n > 500.0)),
        Box::new(|n| (n / 50.0).floor() % 2.0),
        Box::new(move |n| 1e-4 * n + noise.uniform()),
        Box::new(|n| n % 50.0),
    ];
    for (at, mut signal) in signals.into_iter().enumerate() {
        let samples: Vec<f64> = (0..40_000).map(|n| signal(f64::from(n))).collect();
        let path = desk.join("a.npz");
        npz::write(&path, &[Channel::held("t", samples)], &[]).unwrap();
        assert!(!Recording::open(&path).unwrap().channels[0].is_time, "{at}");
    }
}

/// A gap after the first thousand rows went unnoticed, and so did another rate.
#[test]
fn issue_gaps_and_changes_of_the_rate_are_noted_with_their_place() {
    let desk = Scratch::create("formats-gaps");
    let note = |time: &dyn Fn(usize) -> f64| {
        let text = table("t [s],acc\n", ",", 20_000, |n| format!("{:.7}", time(n)));
        let recording = opened(&desk, &text);
        let (times, rate_hz) = read(&recording);
        assert_eq!(times, [true, false]);
        (recording.notes.join("; "), rate_hz)
    };
    let (none, rate_hz) = note(&|n| n as f64 / RATE_HZ);
    assert_eq!((none.as_str(), rate_hz), ("", Some(RATE_HZ)));
    for (after, missing) in [(300, 1), (6400, 250), (12_800, 6400), (19_996, 20)] {
        let (gap, rate_hz) = note(&|n| (n + if n >= after { missing } else { 0 }) as f64 / RATE_HZ);
        let place = format!(
            "a gap after row {after} ({:.6} s): missing samples: {missing}.",
            (after - 1) as f64 / RATE_HZ
        );
        assert!(gap.contains(&place), "{gap}");
        assert!((rate_hz.unwrap() / RATE_HZ - 1.0).abs() < 1e-6, "{rate_hz:?}");
    }
    let (two, _) = note(&|n| (n + n / 7000 * 90) as f64 / RATE_HZ);
    assert!(two.contains("after row 7000") && two.contains("and so at 1 more places"), "{two}");
    let (back, _) = note(&|n| (n % 13_000) as f64 / RATE_HZ);
    assert!(back.contains("after row 13000") && back.contains("they fall back"), "{back}");
    let (slower, rate_hz) =
        note(&|n| n.min(9500) as f64 / RATE_HZ + n.saturating_sub(9500) as f64 / 12_000.0);
    assert!(slower.contains("from about row 9001 (0.703125 s) on: cut the file there"), "{slower}");
    assert_eq!(rate_hz, None);
}

/// Tables of others say no rate; their times do.
#[test]
fn roundtrip_a_foreign_table_has_its_rate_from_its_times() {
    let desk = Scratch::create("formats-foreign-times");
    let columns = [
        parquet::Column::numbers("time_s", (0..5000).map(|n| f64::from(n) / RATE_HZ).collect()),
        parquet::Column::numbers("acc", (0..5000).map(|n| f64::from(n).sin()).collect()),
    ];
    parquet::write_table(&desk.join("a.parquet"), &columns, &[]).unwrap();
    let found = Recording::open(desk.join("a.parquet")).unwrap();
    assert_eq!(read(&found), (vec![true, false], Some(RATE_HZ)));
}

/// A late sample is not a missing one: the next step is shorter by the same amount.
#[test]
fn issue_times_that_jitter_have_no_gaps() {
    let desk = Scratch::create("formats-jitter");
    let mut noise = Noise::new(5);
    let mut gaussian = || (0..12).map(|_| noise.uniform()).sum::<f64>() / 2.0;
    let late: Vec<f64> = (0..30_000).map(|_| 0.1 * gaussian()).collect();
    let found = opened(
        &desk,
        &table("t,acc\n", ",", late.len(), |n| format!("{:.9}", (n as f64 + late[n]) / RATE_HZ)),
    );
    let (times, rate_hz) = read(&found);
    assert_eq!(times, [true, false]);
    assert!((rate_hz.expect("a rate") / RATE_HZ - 1.0).abs() < 1e-4, "{rate_hz:?}");
    assert!(!found.notes.iter().any(|note| note.contains("a gap")), "{:?}", found.notes);
}
