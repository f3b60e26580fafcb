//! Damage costs the damaged part: the rest is read, with a note, and nothing is invented.

use stribeck_formats::Recording;
use stribeck_testing::Scratch;

use crate::{notes, opened, signal};

fn small(name: &str) -> Vec<u8> {
    let path = format!("{}/../../../fixtures/signals/small/{name}", env!("CARGO_MANIFEST_DIR"));
    std::fs::read(&path).unwrap_or_else(|why| panic!("{path}: {why}"))
}

#[test]
fn issue_a_damaged_row_of_a_text_costs_its_fields() {
    let desk = Scratch::create("formats-damaged-text");
    let good: Vec<String> =
        (0..100).map(|n| format!("\"{}.5\"|\"{}\"|\"{:.2}\"", n, signal(n), -signal(n))).collect();
    let damaged = |at: usize, row: &str| {
        let mut rows = good.clone();
        row.clone_into(&mut rows[at]);
        opened(&desk, "a.csv", (rows.join("\n") + "\n").as_bytes())
    };
    // The first row is no head because one of its fields is damaged.
    let found = damaged(0, "0.5|1e9x|-1.00");
    assert_eq!((found.channels.len(), found.channels[2].len), (3, 100), "{:?}", found.notes);
    assert!(found.channels[1].read().unwrap()[0].is_nan());
    notes(&found, &["`1e9x` in line 1"]);
    // A quote without its other half takes no field along.
    let found = damaged(40, "\"40\"0.5\"|\"-0.5\"|\"0.5\"");
    let all: Vec<Vec<f64>> = found.channels.iter().map(|c| c.read().unwrap()).collect();
    assert!(all[0][40].is_nan() && all[1][40] == -0.5 && all[2][40] == 0.5, "{:?}", found.notes);
    // Surplus cells of a row are noted.
    let found = damaged(40, "\"40.5\"|\"-0.5\"|\"0.5\"|\"41.5\"");
    assert_eq!((found.channels.len(), found.channels[0].len), (3, 100));
    notes(&found, &["rows with more than 3 fields: 1, the first in line 41"]);
    // One line that ends otherwise than the others.
    let old = good.join("\r") + "\r\n\r";
    let found = opened(&desk, "b.csv", old.as_bytes());
    assert_eq!(found.channels[0].len, 100, "{:?}", found.notes);
}

#[test]
fn issue_a_cut_universal_file_is_read_up_to_there() {
    let desk = Scratch::create("formats-damaged-uff");
    let text = String::from_utf8(small("text.uff")).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    let held = |found: &Recording, name: &str| found.channel(name).unwrap().read().unwrap();
    // The second set ends in the middle of its samples.
    let found = opened(&desk, "a.uff", (lines[..lines.len() - 4].join("\n") + "\n").as_bytes());
    let (first, second) = (held(&found, "x0"), held(&found, "x1"));
    assert!(first.len() == 48 && (first[7] - signal(7)).abs() < 1e-12);
    assert!(second.len() < 48 && second.len() > 30, "{}", second.len());
    notes(&found, &["it was cut off"]);
    // It ends in its head: the first remains.
    let head = lines.iter().rposition(|line| line.trim() == "58").unwrap();
    let found = opened(&desk, "b.uff", (lines[..head + 4].join("\n") + "\n").as_bytes());
    assert_eq!((found.channels.len(), held(&found, "x0").len()), (1, 48));
    notes(&found, &["it is left out"]);
    // A line too many.
    let mut more = lines.clone();
    more.insert(lines.len() - 3, lines[lines.len() - 3]);
    let found = opened(&desk, "c.uff", (more.join("\n") + "\n").as_bytes());
    assert_eq!(held(&found, "x1").len(), 48);
    notes(&found, &["more follow"]);
    // A number with a digit too many is that number, not the part of it in its columns.
    let wide = text.replacen("-6.00000000000e-02", "-6.000000000000e-02", 1);
    assert_ne!(wide, text);
    assert_eq!(held(&opened(&desk, "d.uff", wide.as_bytes()), "x0"), first);
}

#[test]
fn refuses_binary_universal_data_that_lack_bytes() {
    let desk = Scratch::create("formats-damaged-58b");
    let good = small("binary.uff");
    assert_eq!(opened(&desk, "a.uff", &good).channels.len(), 2);
    // The bytes of the delimiter would become samples.
    let mut short = good.clone();
    let end = good.len() - 60;
    short.drain(end..end + 5);
    let found = opened(&desk, "b.uff", &short);
    assert_eq!(found.channels.len(), 1, "{}", found.names());
    notes(&found, &["no delimiter"]);
}

#[test]
fn issue_a_tdms_file_that_was_not_closed_is_read_up_to_there() {
    let desk = Scratch::create("formats-damaged-tdms");
    let good = small("segments.tdms");
    let whole = opened(&desk, "a.tdms", &good);
    let all = whole.channel("g/acc").unwrap().read().unwrap();
    assert_eq!(all.len(), 48);
    let second = good.windows(4).skip(1).position(|w| w == b"TDSm").unwrap() + 1;
    // Within the metadata of the second segment, and within its samples: 28 bytes lead in, 42 describe.
    for (cut, count) in [(second + 40, 20), (second + 70 + 21, 22)] {
        let found = opened(&desk, "b.tdms", &good[..cut]);
        let read = found.channel("g/acc").unwrap().read().unwrap();
        assert_eq!(read, all[..count], "cut at {cut}");
        notes(&found, &["not closed, or is cut off"]);
    }
}

/// npTDMS reads the same numbers.
#[test]
fn peer_rows_of_daqmx_become_channels_by_their_scales() {
    let desk = Scratch::create("formats-daqmx");
    let good = small("daqmx.tdms");
    let whole = opened(&desk, "a.tdms", &good);
    // The rms of npTDMS 1.13.0.
    for (name, rms) in
        [("g/a", 0.631_215_758_147_191_2), ("g/b", 0.774_390_895_586_116), ("g/c", 0.968_138_387_576_900_1)]
    {
        let channel = whole.channel(name).unwrap_or_else(|why| panic!("{why} {:?}", whole.notes));
        assert_eq!((channel.rate_hz, channel.unit.as_deref(), channel.len), (Some(12_800.0), Some("g"), 48));
        let read = channel.read().unwrap();
        let ours = (read.iter().map(|x| x * x).sum::<f64>() / 48.0).sqrt();
        assert!((ours / rms - 1.0).abs() < 1e-12, "{name}: {ours}");
    }
    let first = whole.channel("g/a").unwrap().read().unwrap();
    assert!(first.iter().enumerate().all(|(n, x)| (x - 0.25 - signal(n)).abs() < 1.01e-3), "{first:?}");
    // Cut in its second chunk, of which the first card is whole.
    let found = opened(&desk, "b.tdms", &good[..good.len() - 20]);
    let lens = ["g/a", "g/b", "g/c"].map(|name| found.channel(name).unwrap().len);
    assert_eq!(lens, [48, 48, 24 + 19], "{:?}", found.notes);
    notes(&found, &["cut off"]);
}
