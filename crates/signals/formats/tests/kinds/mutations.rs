//! Damaged files of all formats: none makes a reader panic or hang.

use std::cell::Cell;
use std::path::Path;
use std::time::{Duration, Instant};

use proptest::{prop_assert, test_runner::TestRunner};
use stribeck_formats::Recording;
use stribeck_testing::Scratch;
use stribeck_testing::damage::{cases, damaged};

use crate::{RATE_HZ, opened, signal};

/// Files that are tried; `PROPTEST_CASES` makes them more.
const CASES: u32 = 10_000;

/// An input that takes longer hangs.
const PATIENCE: Duration = Duration::from_secs(5);

/// Good files of all formats with their names: the corpus in `fixtures/signals`, and tables as programs write
/// them.
fn good_files() -> Vec<(String, Vec<u8>)> {
    let table = |head: &str, separator: &str, comma: bool| {
        let rows = (0..60).map(|n| format!("{:.6}{separator}{:.4}\n", n as f64 / RATE_HZ, signal(n)));
        let rows: String = rows.collect();
        head.to_owned() + &if comma { rows.replace('.', ",") } else { rows }
    };
    let stamps = (0..40).map(|n| format!("\"2024-05-01 08:00:00.{:09}\",\"{:.4}\"\n", 78_125 * n, signal(n)));
    let wide = table("t acc\n", "\t", false).encode_utf16().flat_map(u16::to_le_bytes).collect();
    let mut all = vec![
        ("a.csv".to_owned(), table("Time,Acc\nms,m/s2\n", ",", false).into_bytes()),
        ("b.csv".to_owned(), table("Messung;\n;\nZeit [ms];Beschl. [g]\n", ";", true).into_bytes()),
        ("c.csv".to_owned(), ("timestamp,acc\n".to_owned() + &stamps.collect::<String>()).into_bytes()),
        ("d.csv".to_owned(), wide),
    ];
    let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../fixtures/signals");
    for folder in [fixtures.join("small"), fixtures] {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let extension = path.extension().unwrap_or_default().to_string_lossy().into_owned();
            // Meshes and scripts.
            if path.is_file() && !["inp", "msh", "py"].contains(&&*extension) {
                let name = path.file_name().unwrap().to_string_lossy().into_owned();
                all.push((name, std::fs::read(&path).unwrap()));
            }
        }
    }
    all.sort();
    all
}

#[test]
fn survives_damage_to_every_format() {
    let desk = Scratch::create("formats-damage");
    let all = good_files();
    for (name, bytes) in &all {
        let found = opened(&desk, name, bytes);
        assert!(found.channels.iter().any(|c| c.len > 1 && c.read().is_ok()), "{name}: {:?}", found.notes);
    }
    let (read, refused) = (Cell::new(0_usize), Cell::new(0_usize));
    let done = TestRunner::new(cases(CASES)).run(&damaged(all), |(name, bytes)| {
        let path = desk.join(format!("damaged-{name}"));
        std::fs::write(&path, &bytes).unwrap();
        let began = Instant::now();
        match Recording::open(&path) {
            Ok(found) => {
                for channel in found.channels.iter().filter(|c| c.len < 1_000_000) {
                    if let Ok(samples) = channel.read() {
                        let (held, says) = (samples.len() as u64, channel.len);
                        prop_assert!(held <= says, "`{}` holds {held} samples, not {says}", channel.name);
                    }
                }
                read.set(read.get() + 1);
            }
            Err(why) => {
                prop_assert!(why.to_string().contains("damaged-"), "{why}");
                refused.set(refused.get() + 1);
            }
        }
        prop_assert!(began.elapsed() < PATIENCE, "{name} took {:?}", began.elapsed());
        Ok(())
    });
    done.unwrap_or_else(|why| panic!("{why}"));
    assert!(read.get() > 0 && refused.get() > 0, "{} read, {} refused", read.get(), refused.get());
}
