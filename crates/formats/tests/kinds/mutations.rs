//! Files of all formats with bytes changed at random: none makes a reader panic or hang.

use std::path::Path;
use std::time::{Duration, Instant};

use stribeck_formats::Recording;
use stribeck_testing::{Noise, Scratch};

use crate::{RATE_HZ, opened, signal};

/// Mutations of the tests; `STRIBECK_MUTATIONS` makes them more.
const MUTATIONS: usize = 10_000;

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
    let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/signals");
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

/// Bytes that are changed, left out, put in, doubled or set to the borders of their range.
fn mutated(good: &[u8], draw: &mut impl FnMut(usize) -> usize) -> Vec<u8> {
    let mut bytes = good.to_vec();
    for _ in 0..=draw(4) {
        if bytes.is_empty() {
            break;
        }
        // Heads hold the structure: half of the mutations are there.
        let among = if draw(2) == 0 { bytes.len().min(400) } else { bytes.len() };
        let at = draw(among);
        let end = (at + 1 + draw(9)).min(bytes.len());
        match draw(6) {
            0 => bytes[at] = draw(256) as u8,
            1 => bytes[at] ^= 1 << draw(8),
            2 => drop(bytes.drain(at..end)),
            3 => {
                let again = bytes[at..end].to_vec();
                bytes.splice(at..at, again);
            }
            4 => bytes[at..end].fill([0, 0xff, 0x7f, 0x80][draw(4)]),
            _ => bytes.truncate(at),
        }
    }
    bytes
}

#[test]
fn survives_mutations_of_every_format() {
    let desk = Scratch::create("formats-mutations");
    let all = good_files();
    for (name, bytes) in &all {
        let found = opened(&desk, name, bytes);
        assert!(found.channels.iter().any(|c| c.len > 1 && c.read().is_ok()), "{name}: {:?}", found.notes);
    }
    let count = std::env::var("STRIBECK_MUTATIONS").ok().and_then(|n| n.parse().ok()).unwrap_or(MUTATIONS);
    let mut noise = Noise::new(50);
    let mut draw = |among: usize| (((noise.uniform() + 1.0) / 2.0 * among as f64) as usize).min(among - 1);
    let (mut read, mut refused) = (0_usize, 0_usize);
    for n in 0..count {
        let (name, good) = &all[n % all.len()];
        let bytes = mutated(good, &mut draw);
        let path = desk.join(format!("mutated-{name}"));
        std::fs::write(&path, &bytes).unwrap();
        let began = Instant::now();
        let answer = std::panic::catch_unwind(|| match Recording::open(&path) {
            Ok(found) => {
                for channel in found.channels.iter().filter(|c| c.len < 1_000_000) {
                    if let Ok(samples) = channel.read() {
                        assert!(
                            samples.len() as u64 <= channel.len,
                            "`{}` holds more than it says",
                            channel.name
                        );
                    }
                }
                true
            }
            Err(why) => {
                assert!(why.to_string().contains("mutated-"), "{why}");
                false
            }
        });
        let Ok(answer) = answer else {
            panic!("mutation {n} of {name}: {:02x?}", &bytes[..bytes.len().min(4000)])
        };
        assert!(began.elapsed() < PATIENCE, "mutation {n} of {name} took {:?}", began.elapsed());
        if answer { read += 1 } else { refused += 1 }
    }
    println!("{count} mutations: {read} read, {refused} refused");
    assert!(read > 0 && refused > 0);
}
