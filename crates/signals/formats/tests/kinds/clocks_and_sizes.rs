//! Clocks, sizes, stamps of packets, and packings of people's files.

use std::io::Write;

use flate2::Compression;
use flate2::write::ZlibEncoder;
use stribeck_formats::{Channel, Error, Recording};
use stribeck_testing::{Scratch, assert_refused};

use crate::{RATE_HZ, notes, opened, signal, try_open};

const COUNT: usize = 4096;

fn rows(row: impl Fn(usize) -> String) -> String {
    (0..COUNT).map(|n| row(n) + "\n").collect()
}

/// Seconds and value of a sample, as texts write them.
fn at(n: usize) -> (f64, f64) {
    (n as f64 / RATE_HZ, signal(n))
}

fn sampled(found: &Recording, name: &str) -> Channel {
    let channel = found.channel(name).unwrap_or_else(|why| panic!("{why}; {:?}", found.notes)).clone();
    let rate_hz = channel.rate_hz.unwrap_or_else(|| panic!("{name}: no rate; {:?}", found.notes));
    assert!((rate_hz / RATE_HZ - 1.0).abs() < 1e-3, "{name}: {rate_hz}");
    channel
}

/// R leaves the names of rows without a heading: `time_ms` was set upon them, and the rate was 1000 Hz.
#[test]
fn issue_names_of_rows_shift_no_headings() {
    let desk = Scratch::create("second-row-names");
    let r = |quote: &str, head: &str, from: usize, separator: &str| {
        head.to_owned()
            + &rows(|n| {
                let (s, x) = at(n);
                let name = format!("{quote}{}{quote}", n + from);
                format!("{name}{separator}{:.6}{separator}{x:.4}", 1e3 * s)
            })
    };
    for text in [
        r("\"", "\"time_ms\" \"acc_g\"\n", 1, " "),
        r("", "time_ms acc_g\n", 1, " "),
        r("", "time_ms,acc_g\n", 0, ","),
        r("\"", "\"time_ms\";\"acc_g\"\n", 17, ";"),
        r("\"", "\"time_ms\"\t\"acc_g\"\n", 1, "\t"),
    ] {
        let found = opened(&desk, "r.txt", text.as_bytes());
        let channel = sampled(&found, "acc_g");
        assert_eq!((channel.len, channel.column), (COUNT as u64, Some(3)));
    }
    // Names that are words, numbers that fall or leave some out, a date: time is the column that rises.
    for name in [
        &(|n| format!("row{n}")) as &dyn Fn(usize) -> String,
        &|n| format!("{}", COUNT - n),
        &|n| format!("{}", 3 * n + n % 2),
        &|_| "2024-05-01".to_owned(),
    ] {
        let text = "time_s acc_g\n".to_owned()
            + &rows(|n| {
                let (s, x) = at(n);
                format!("{} {s:.7} {x:.4}", name(n))
            });
        let found = opened(&desk, "r.txt", text.as_bytes());
        assert_eq!(sampled(&found, "acc_g").column, Some(3));
        let first = found.channels.iter().find(|c| !c.is_time && c.unit.is_none()).unwrap();
        assert_eq!(first.name, "acc_g", "{}", found.names());
    }
    // A column without a name at the end takes none of the others.
    let text = "time_s,acc\n".to_owned()
        + &rows(|n| {
            let (s, x) = at(n);
            format!("{s:.7},{x:.4},{n}")
        });
    assert_eq!(sampled(&opened(&desk, "a.csv", text.as_bytes()), "acc").column, Some(2));
    // A separator at the end of all rows is no column, and takes no name.
    let text = "n,time_s,acc\n".to_owned()
        + &rows(|n| {
            let (s, x) = at(n);
            format!("{n},{s:.7},{x:.4},")
        });
    sampled(&opened(&desk, "a.csv", text.as_bytes()), "acc");
}

/// The size of a table above it was its first sample.
#[test]
fn issue_a_first_row_of_sizes_is_no_sample() {
    let desk = Scratch::create("second-sizes");
    let fractions = rows(|n| format!("{:.6},{:.6}", signal(n), signal(n + 1)));
    let whole = rows(|n| format!("{},{}", (50.0 * signal(n)) as i64, n % 7));
    let alone = rows(|n| format!("{:.6}", signal(n)));
    for (head, body, len) in [
        ("2,4096", &fractions, COUNT),
        ("4096,2", &fractions, COUNT),
        ("1,4096", &fractions, COUNT),
        ("2,4096", &whole, COUNT),
        ("4096", &alone, COUNT),
        ("4096.0", &alone, COUNT),
        // Counts the line that says it, too.
        ("4097,2", &fractions, COUNT),
        // Neither: samples.
        ("2,4000", &fractions, COUNT + 1),
        ("0,0", &fractions, COUNT + 1),
        ("17,4096", &whole, COUNT + 1),
    ] {
        let found = opened(&desk, "a.csv", format!("{head}\n{body}").as_bytes());
        assert_eq!(found.channel("column 1").unwrap().len, len as u64, "{head}");
        assert_eq!(found.notes.iter().any(|note| note.contains("how many samples")), len == COUNT, "{head}");
    }
}

/// Thousands that first came far below the first row were fractions, texts, or columns of their own.
#[test]
fn issue_thousands_that_come_late_are_thousands() {
    let desk = Scratch::create("second-thousands");
    // Beyond 1000 from row 40 on, and from row 300 on.
    for from in [40, 300] {
        let value = |n: usize| (if n < from { 900.0 } else { 5000.0 }) * signal(n);
        let grouped = |n: usize, sign: &str, point: &str, digits: usize| {
            let text = format!("{:.digits$}", value(n).abs());
            let (whole, rest) = text.split_once('.').map_or((&text[..], None), |(a, b)| (a, Some(b)));
            let minus = if text.contains(['1', '2', '3', '4', '5', '6', '7', '8', '9']) && value(n) < 0.0 {
                "-"
            } else {
                ""
            };
            let whole = match whole.len() {
                4.. => format!("{}{sign}{}", &whole[..whole.len() - 3], &whole[whole.len() - 3..]),
                _ => whole.to_owned(),
            };
            format!("{minus}{whole}{}", rest.map_or(String::new(), |rest| format!("{point}{rest}")))
        };
        let time = |n: usize, point: &str| format!("{:.8}", at(n).0).replace('.', point);
        for (name, text, off) in [
            ("points;", rows(|n| format!("{};{}", time(n, "."), grouped(n, ",", ".", 1))), 0.06),
            ("whole;", rows(|n| format!("{};{}", time(n, "."), grouped(n, ",", ".", 0))), 0.6),
            ("whole\t", rows(|n| format!("{}\t{}", time(n, "."), grouped(n, ",", ".", 0))), 0.6),
            ("German", rows(|n| format!("{};{}", time(n, ","), grouped(n, ".", ",", 1))), 0.06),
            ("German, whole", rows(|n| format!("{};{}", time(n, ","), grouped(n, ".", ",", 0))), 0.6),
            ("quoted", rows(|n| format!("{},\"{}\"", time(n, "."), grouped(n, ",", ".", 0))), 0.6),
            ("one", rows(|n| grouped(n, ",", ".", 1)), 0.06),
            ("one, whole", rows(|n| grouped(n, ",", ".", 0)), 0.6),
            ("one, quoted", rows(|n| format!("\"{}\"", grouped(n, ",", ".", 1))), 0.06),
        ] {
            let head = if name.starts_with("one") { "acc\n" } else { "time_s\tacc\n" };
            let found = opened(&desk, "a.csv", format!("{head}{text}").as_bytes());
            let channel =
                found.channel("acc").unwrap_or_else(|why| panic!("{name}: {why} {:?}", found.notes));
            let read = channel.read().unwrap();
            assert_eq!(read.len(), COUNT, "{name}: {:?}", found.notes);
            let wrong = read.iter().enumerate().find(|(n, x)| (*x - value(*n)).abs() > off);
            assert_eq!(wrong, None, "{name} {from}: {:?}", found.notes);
        }
    }
    // Three digits behind each comma, and no number without one: fractions.
    let text = "n;acc\n".to_owned() + &rows(|n| format!("{n};{},{:03}", 1 + n % 7, n % 1000));
    let found = opened(&desk, "b.csv", text.as_bytes());
    assert_eq!(found.channel("acc").unwrap().read().unwrap()[9], 3.009);
}

/// Only the first of them could be asked for.
#[test]
fn issue_names_that_occur_twice_are_told_apart() {
    let desk = Scratch::create("second-twice");
    let text = "time_s,acc,acc,acc (2)\n".to_owned()
        + &rows(|n| {
            let (s, x) = at(n);
            format!("{s:.7},{x:.4},{:.4},{:.4}", 2.0 * x, 3.0 * x)
        });
    let found = opened(&desk, "a.csv", text.as_bytes());
    for (name, factor) in [("acc", 1.0), ("acc (3)", 2.0), ("acc (2)", 3.0)] {
        let x = found.channel(name).unwrap().read().unwrap()[7];
        assert!((x - factor * signal(7)).abs() < 1e-4, "{name}: {x}");
    }
    assert!(found.notes.join("; ").contains("names occur twice"), "{:?}", found.notes);
}

/// A vector as one row of three million fields hung, and beyond 16 MiB a row was several channels.
#[test]
fn issue_one_long_row_is_one_channel() {
    let desk = Scratch::create("second-long-row");
    let count = 3_000_000;
    let text: String = (0..count).map(|n| if n % 2 == 0 { "-0.125," } else { "0.5," }).collect();
    let found = opened(&desk, "row.csv", format!("{}\n", text.trim_end_matches(',')).as_bytes());
    assert_eq!((found.channels.len(), found.channels[0].len), (1, count));
    assert_eq!(found.channels[0].read().unwrap()[count as usize - 1], 0.5);
    // Its name may stand before it.
    let row = (0..1000).map(|n| format!(",{:.2}", signal(n))).collect::<String>();
    let found = opened(&desk, "named.csv", format!("acc{row}\nspeed{row}\n").as_bytes());
    assert_eq!(
        (found.names(), found.channels[1].len),
        ("`acc` (1000 samples), `speed` (1000 samples)".into(), 1000)
    );
    // Fifty rows of ten thousand fields are fifty channels, and so are a hundred.
    for count in [50, 100] {
        let row = (0..10_000).map(|n| format!("{:.2}", signal(n))).collect::<Vec<_>>().join(",") + "\n";
        let found = opened(&desk, "rows.csv", row.repeat(count).as_bytes());
        assert_eq!((found.channels.len(), found.channels[0].len), (count, 10_000));
    }
    // A wide table of many rows is read once, and not once a column.
    let row = (0..500).map(|n| format!("{:.2}", signal(n))).collect::<Vec<_>>().join(",") + "\n";
    let found = opened(&desk, "wide.csv", row.repeat(1000).as_bytes());
    assert_eq!((found.channels.len(), found.channels[499].len), (500, 1000));
    assert_eq!(found.channels[3].read().unwrap()[999], (100.0 * signal(3)).round() / 100.0);
}

/// Sensors on radio stamp a packet; "does not say how fast" was all that was said.
#[test]
fn issue_stamps_of_packets_say_the_rate_and_what_lacks() {
    let desk = Scratch::create("second-packets");
    let epoch =
        |n: usize, size: usize| 1_714_550_400_000.0 + (1e3 * (n / size * size) as f64 / RATE_HZ).round();
    for size in [32, 64, 25] {
        let text = "epoch_ms,acc_g\n".to_owned() + &rows(|n| format!("{},{:.4}", epoch(n, size), signal(n)));
        let found = opened(&desk, "a.csv", text.as_bytes());
        sampled(&found, "acc_g");
        let said = found.notes.join("; ");
        assert!(said.contains(&format!("packets of {size} samples")) && !said.contains("uneven"), "{said}");
    }
    // A last packet that is cut off moves the rate no more, and neither do stamps of few digits.
    for (size, digits) in [(50, 6), (37, 5), (1, 3), (1, 4)] {
        let stamp = |n: usize| (n / size * size) as f64 / RATE_HZ;
        let text = "time_s,acc\n".to_owned() + &rows(|n| format!("{:.digits$},{:.4}", stamp(n), signal(n)));
        let rate_hz = sampled(&opened(&desk, "a.csv", text.as_bytes()), "acc").rate_hz.unwrap();
        assert!((rate_hz / RATE_HZ - 1.0).abs() < 2e-4, "{size}: {rate_hz}");
    }
    // Times of arrival say no rate, and what they are.
    let late = |n: usize| epoch(n, 128) + [0.0, 3.0, 7.0, 4.0, 8.0][n / 128 % 5];
    let text = "epoch_ms,acc\n".to_owned() + &rows(|n| format!("{},{:.4}", late(n), signal(n)));
    let found = opened(&desk, "a.csv", text.as_bytes());
    let said = found.notes.join("; ");
    assert!(said.contains("packets of about 128 samples"), "{said}");
    let kept = |n: usize| (n / 32) % 20 != 7;
    let text: String =
        (0..COUNT).filter(|n| kept(*n)).map(|n| format!("{},{:.4}\n", epoch(n, 32), signal(n))).collect();
    let found = opened(&desk, "lost.csv", format!("epoch_ms,acc_g\n{text}").as_bytes());
    sampled(&found, "acc_g");
    assert!(
        found.notes.join("; ").contains("packets lack: 6 of 127, the first after row 224"),
        "{:?}",
        found.notes
    );
}

#[test]
fn issue_times_that_say_no_rate_say_why() {
    let desk = Scratch::create("second-why");
    let stamped = |stamp: &dyn Fn(usize) -> f64| {
        "time_s,acc\n".to_owned() + &rows(|n| format!("{:.6},{:.4}", stamp(n), signal(n)))
    };
    for (text, words) in [
        (stamped(&|n| (COUNT - n) as f64 / RATE_HZ), "fall from row to row"),
        (stamped(&|n| (n % 1000) as f64 / RATE_HZ * if n < 2000 { 1.0 } else { -1.0 }), "go back at"),
        (stamped(&|n| ((n * n) as f64 / 1e4).floor() / 1e3), "uneven"),
    ] {
        let found = opened(&desk, "a.csv", text.as_bytes());
        assert_eq!(found.channel("acc").unwrap().rate_hz, None);
        assert!(found.notes.join("; ").contains(words), "{words}: {:?}", found.notes);
    }
}

#[test]
fn issue_durations_are_times() {
    let desk = Scratch::create("second-durations");
    let iso = |n: usize| format!("P0DT0H0M{:.9}S", at(n).0);
    for text in [
        "acc,t\n".to_owned()
            + &rows(|n| format!("{:.4},0 days 00:00:00.{:09}", signal(n), (1e9 * at(n).0) as u64)),
        "acc,t\n".to_owned() + &rows(|n| format!("{:.4},{}", signal(n), iso(n))),
    ] {
        sampled(&opened(&desk, "a.csv", text.as_bytes()), "acc");
    }
}

/// The clock of each channel counts: that of a struct, of a column, of a text's second column of times.
#[test]
fn issue_each_channel_begins_when_its_clock_says() {
    let desk = Scratch::create("second-clocks");
    let channel = |name: &str, from: usize| Channel::held(name, (from..from + COUNT).map(signal).collect());
    let (start, rate) = (Channel::held("tacho_start_s", vec![0.8]), Channel::held("fs", vec![RATE_HZ]));
    let path = desk.join("a.npz");
    stribeck_formats::npz::write(&path, &[channel("acc", 0), channel("tacho", 9), start, rate], &[]).unwrap();
    let found = Recording::open(&path).unwrap();
    assert_eq!(
        (found.channel("tacho").unwrap().start_s, found.channel("acc").unwrap().start_s),
        (Some(0.8), None)
    );
    // Dates in milliseconds, and lags in a unit of time.
    for (name, value) in [("tacho_start_timestamp", 1_714_550_400_800.0), ("tacho_offset_ms", 800.0)] {
        let start = Channel::held(name, vec![value]);
        stribeck_formats::npz::write(&path, &[channel("tacho", 9), start], &[]).unwrap();
        let start_s = Recording::open(&path).unwrap().channel("tacho").unwrap().start_s.unwrap();
        assert!((start_s % 100.0 - 0.8).abs() < 1e-6, "{name}: {start_s}");
    }
    // Two clocks in one table: by the name, and by the order.
    for head in ["time_acc_s,acc,time_tacho_s,tacho", "t_s,acc,t2_s,tacho"] {
        let text = format!("{head}\n")
            + &rows(|n| {
                let (s, x) = at(n);
                format!("{s:.7},{x:.4},{:.7},{x:.4}", s + 0.03)
            });
        let found = opened(&desk, "a.csv", text.as_bytes());
        let start = |name: &str| sampled(&found, name).start_s.unwrap();
        assert!(start("acc").abs() < 1e-6 && (start("tacho") - 0.03).abs() < 1e-6, "{head}");
    }
    // Times that begin later.
    let text = "time_s,acc\n".to_owned() + &rows(|n| format!("{:.7},{:.4}", 2.5 + at(n).0, signal(n)));
    let found = opened(&desk, "a.csv", text.as_bytes());
    let start_s = sampled(&found, "acc").start_s.unwrap();
    assert!((start_s - 2.5).abs() < 1e-6, "{start_s}");
}

fn wav(form: &[u8], says: u32, bytes: &[u8], behind: &[u8]) -> Vec<u8> {
    let mut all = [form, &(36 + bytes.len() as u32).to_le_bytes(), b"WAVEfmt "].concat();
    all.extend(16_u32.to_le_bytes());
    all.extend([1_u16, 1].map(u16::to_le_bytes).concat());
    all.extend([RATE_HZ as u32, 2 * RATE_HZ as u32].map(u32::to_le_bytes).concat());
    all.extend([2_u16, 16].map(u16::to_le_bytes).concat());
    all.extend(b"data");
    all.extend(says.to_le_bytes());
    all.extend(bytes);
    all.extend(behind);
    all
}

#[test]
fn issue_wav_whose_head_says_half_the_length_is_read_whole() {
    let desk = Scratch::create("second-wav");
    let bytes: Vec<u8> = (0..COUNT).flat_map(|n| ((20_000.0 * signal(n)) as i16).to_le_bytes()).collect();
    let whole = bytes.len() as u32;
    let list = [b"LIST", &4_u32.to_le_bytes()[..], b"INFO"].concat();
    for (form, says, behind, len, noted) in [
        (b"RIFF", whole / 2, &[][..], COUNT, true),
        (b"RIFF", whole, &list, COUNT, false),
        (b"RIFF", whole, &[0; 30], COUNT, false),
        (b"BW64", whole, &[], COUNT, false),
    ] {
        let found = opened(&desk, "a.wav", &wav(form, says, &bytes, behind));
        assert_eq!(
            (found.channels[0].len, found.notes.is_empty()),
            (len as u64, !noted),
            "{:?}",
            found.notes
        );
    }
}

#[test]
fn issue_files_beside_sound_ones_are_named() {
    let desk = Scratch::create("second-beside");
    let why = try_open(&desk, "a.tdms_index", b"TDSh\0\0\0\0").unwrap_err().to_string();
    assert!(why.contains("a.tdms`") && why.contains("open that"), "{why}");
    for (bytes, words) in
        [(&b"\x1f\x8b\x08\0rest"[..], "gunzip"), (b"BZh91AY", "bunzip2"), (b"CDF\x01\0\0", "nccopy")]
    {
        assert_refused(try_open(&desk, "a.csv", bytes), words);
    }
    // Tags before FLAC are looked behind, and what stands there is judged.
    let tag = [&b"ID3\x04\0\0\0\0\0\x0a"[..], &[0; 10], b"fLaC"].concat();
    assert_refused(try_open(&desk, "a.flac", &tag), "FLAC");
}

/// A workbook was called a zip archive to be unpacked, which leads to XML without samples.
#[test]
fn issue_a_workbook_is_named_with_the_way_to_csv() {
    let desk = Scratch::create("second-workbook");
    let archive = |names: &[&str]| {
        let mut zip = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
        for name in names {
            zip.start_file(*name, zip::write::SimpleFileOptions::default()).unwrap();
        }
        zip.finish().unwrap().into_inner()
    };
    let excel = archive(&["[Content_Types].xml", "xl/workbook.xml", "xl/worksheets/sheet1.xml"]);
    // Also under the name of a table.
    for name in ["a.xlsx", "a.csv"] {
        let why = try_open(&desk, name, &excel).unwrap_err().to_string();
        assert!(why.contains("workbook of Excel") && why.contains("as CSV"), "{why}");
    }
    let office = archive(&["mimetype", "content.xml"]);
    assert_refused(try_open(&desk, "a.ods", &office), "LibreOffice");
    assert_refused(try_open(&desk, "a.zip", &archive(&["a.csv"])), "unpack it first; it holds `a.csv`");
}

/// The head of a `.npy` array of `count` doubles.
fn npy_head(count: u64) -> Vec<u8> {
    let text = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({count},), }}");
    let text = format!("{text:<117}\n");
    [b"\x93NUMPY\x01\0", &(text.len() as u16).to_le_bytes()[..], text.as_bytes()].concat()
}

fn deflated(parts: &[&[u8]], zeros: usize) -> Vec<u8> {
    let mut packer = ZlibEncoder::new(Vec::new(), Compression::fast());
    parts.iter().for_each(|part| packer.write_all(part).unwrap());
    let block = vec![0; 1 << 20];
    (0..zeros >> 20).for_each(|_| packer.write_all(&block).unwrap());
    packer.finish().unwrap()
}

/// A file of megabytes that unpacks to gigabytes took them, and was then called damaged.
#[test]
fn refuses_what_unpacks_to_more_than_memory_may_hold_before_it_is_unpacked() {
    let desk = Scratch::create("second-bombs");
    // A deflated MATLAB array of 8 GB, of which 64 MB are there.
    let element = |kind: u32, data: &[u8]| {
        [
            &kind.to_le_bytes()[..],
            &(data.len() as u32).to_le_bytes(),
            data,
            &vec![0; data.len().next_multiple_of(8) - data.len()],
        ]
        .concat()
    };
    let count = 1_000_000_000_u32;
    let flags = element(6, &[6_u32, 0].map(u32::to_le_bytes).concat());
    let head = [flags, element(5, &[count, 1].map(u32::to_le_bytes).concat()), element(1, b"acc")].concat();
    let tags = [14, 0, 9, 0_u32].map(u32::to_le_bytes);
    let body = deflated(&[&tags[..2].concat(), &head, &tags[2..].concat()], 64 << 20);
    let mut mat = b"MATLAB 5.0 MAT-file".to_vec();
    mat.resize(124, b' ');
    mat.extend([0, 1, b'I', b'M']);
    mat.extend([15, body.len() as u32].map(u32::to_le_bytes).concat());
    mat.extend(body);
    // An archive with a deflated array of 8 GB by its directory.
    let mut npz = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    let options =
        zip::write::SimpleFileOptions::default().compression_method(zip::CompressionMethod::Deflated);
    npz.start_file("acc.npy", options).unwrap();
    npz.write_all(&npy_head(8 << 20)).unwrap();
    (0..64).for_each(|_| npz.write_all(&vec![0; 1 << 20]).unwrap());
    let npz = npz.finish().unwrap().into_inner();
    let size = (128 + (64_u32 << 20)).to_le_bytes();
    let claimed: Vec<u8> = {
        // Both heads of the entry say its size.
        let mut bytes = npz;
        let places: Vec<usize> = (0..bytes.len() - 4).filter(|at| bytes[*at..*at + 4] == size).collect();
        places.iter().for_each(|at| bytes[*at..*at + 4].copy_from_slice(&0xf000_0000_u32.to_le_bytes()));
        bytes
    };
    for (name, bytes) in [("a.mat", &mat), ("a.npz", &claimed)] {
        match try_open(&desk, name, bytes) {
            Err(Error::TooLarge { bytes, most, .. }) => assert!(bytes > most, "{name}"),
            other => panic!("{name}: {:?}", other.map(|found| found.names())),
        }
    }
}

/// Of two columns of time each is the clock of its channel; where the file does not say which, none is taken.
#[test]
fn issue_each_of_two_time_columns_is_the_clock_of_its_channel() {
    let desk = Scratch::create("two-clocks");
    let table = |head: &str, row: &dyn Fn(f64, f64, f64) -> String| {
        let row = |n: usize| row(n as f64 / RATE_HZ, 0.5 * n as f64 / RATE_HZ, at(n).1);
        opened(&desk, "a.csv", (head.to_owned() + "\n" + &rows(row)).as_bytes())
    };
    for found in [
        table("time1_s,acc1,time2_s,acc2", &|a, b, x| format!("{a:.8},{x:.4},{b:.8},{x:.4}")),
        table("time1_s,time2_s,acc1,acc2", &|a, b, x| format!("{a:.8},{b:.8},{x:.4},{x:.4}")),
    ] {
        let rate = |name: &str| found.channel(name).unwrap().rate_hz;
        assert_eq!((rate("acc1"), rate("acc2")), (Some(RATE_HZ), Some(2.0 * RATE_HZ)));
    }
    let unsaid = table("time_s,t_s,acc,vel", &|a, b, x| format!("{a:.8},{b:.8},{x:.4},{x:.4}"));
    assert_eq!(unsaid.channel("acc").unwrap().rate_hz, None);
    notes(&unsaid, &["`time_s` and `t_s` count differently", "clock of `acc`"]);
}

/// A join of two tables, each with times of its own: the empty fields of one are the rows of the other.
#[test]
fn issue_rows_of_another_clock_are_no_samples() {
    let desk = Scratch::create("joined-tables");
    let mut all: Vec<(f64, String)> = rows(|n| format!("{:.4},", at(n).1))
        .lines()
        .enumerate()
        .map(|(n, row)| (at(n).0, row.to_owned()))
        .collect();
    all.extend((0..300).map(|n| (3.3e-5 + n as f64 * 1e-3, ",1200".to_owned())));
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    let text: String = all.iter().map(|(s, row)| format!("{s:.7},{row}\n")).collect();
    let found = opened(&desk, "a.csv", ("time_s,acc_g,speed_rpm\n".to_owned() + &text).as_bytes());
    let acc = sampled(&found, "acc_g");
    assert_eq!(
        acc.read().unwrap(),
        rows(|n| format!("{:.4}", at(n).1)).lines().map(|x| x.parse().unwrap()).collect::<Vec<f64>>()
    );
    assert_eq!(found.channel("speed_rpm").unwrap().len, 300);
    notes(&found, &["`acc_g` or `speed_rpm` in turn"]);
}

#[test]
fn issue_rows_that_stand_twice_are_taken_once() {
    let desk = Scratch::create("rows-twice");
    let row = |n: usize| format!("{:.9},{:.6}", at(n).0, at(n).1);
    for (each, count) in [(100, 41), (1, COUNT)] {
        let text = rows(|n| if n % each == 0 { format!("{}\n{}", row(n), row(n)) } else { row(n) });
        let found = opened(&desk, "a.csv", ("time_s,acc_g\n".to_owned() + &text).as_bytes());
        let acc = sampled(&found, "acc_g");
        assert_eq!((acc.len, acc.rate_hz), (COUNT as u64, Some(RATE_HZ)));
        notes(&found, &[&format!("rows stand twice: {count}, the first of them row 2")]);
    }
}

/// Comments between rows, and the names once more, are no samples.
#[test]
fn issue_comments_and_repeated_headings_are_no_rows() {
    let desk = Scratch::create("asides");
    for (head, columns) in [("time_s,acc_g\n", 2), ("acc_g\n", 1)] {
        let row = |n: usize| match columns {
            1 => format!("{:.4}", at(n).1),
            _ => format!("{:.8},{:.4}", at(n).0, at(n).1),
        };
        for aside in ["# gain changed", "% page 2", head.trim()] {
            let text = rows(|n| if n == 1000 { format!("{aside}\n{}", row(n)) } else { row(n) });
            let found = opened(&desk, "a.csv", (head.to_owned() + &text).as_bytes());
            let acc = found.channel("acc_g").unwrap().read().unwrap();
            assert!(acc.len() == COUNT && acc.iter().all(|x| x.is_finite()), "{aside}: {}", acc.len());
            notes(&found, &["line 1002", "no row"]);
        }
    }
}

/// At midnight the day goes on from 5 to 6 or from 12 to 13, whatever stands first.
#[test]
fn issue_day_and_month_are_decided_once_for_the_file() {
    let desk = Scratch::create("midnight");
    for (before, behind) in
        [("05/11/2024", "06/11/2024"), ("12/11/2024", "13/11/2024"), ("11/05/2024", "11/06/2024")]
    {
        let stamp = |n: usize| match n as f64 / RATE_HZ - 0.1 {
            s if s < 0.0 => format!("{before} 23:59:{:.7}", 60.0 + s),
            s => format!("{behind} 00:00:{s:010.7}"),
        };
        let text = rows(|n| format!("{},{:.4}", stamp(n), at(n).1));
        let found = opened(&desk, "a.csv", ("time,acc\n".to_owned() + &text).as_bytes());
        assert_eq!(sampled(&found, "acc").len, COUNT as u64, "{before}");
        assert!(found.notes.is_empty(), "{before}: {:?}", found.notes);
    }
}

/// The name and the value of a rate that says none.
#[test]
fn issue_a_rate_that_is_odd_is_named_with_its_value() {
    let desk = Scratch::create("odd-rates");
    for (name, values, words) in [
        (
            "dt",
            vec![78.125],
            "`dt` is 78.125: as seconds that is 0.0128 Hz, as milliseconds 12.8 Hz, as microseconds 12800 Hz",
        ),
        ("fs", vec![f64::NAN], "`fs` is NaN"),
        ("fs", vec![-12_800.0], "`fs` is -12800"),
        ("fs", vec![12_800.0, 12_800.0, 6400.0], "`fs` has 3 values, from 6400 to 12800"),
    ] {
        let path = desk.join("a.npz");
        let channels = [Channel::held("acc", (0..COUNT).map(signal).collect()), Channel::held(name, values)];
        stribeck_formats::npz::write(&path, &channels, &[]).unwrap();
        let found = Recording::open(&path).unwrap();
        assert_eq!(found.channel("acc").unwrap().rate_hz, None, "{name}");
        notes(&found, &[words]);
    }
}

/// Samples in two pieces `data`, and a pipe.
#[test]
fn issue_pieces_of_a_wav_are_joined_and_pipes_are_refused() {
    let desk = Scratch::create("wav-pieces");
    let bytes = |from: i16| (from..from + 1000).flat_map(i16::to_le_bytes).collect::<Vec<u8>>();
    let second = [b"data".to_vec(), 2000_u32.to_le_bytes().to_vec(), bytes(1000)].concat();
    let found = opened(&desk, "a.wav", &wav(b"RIFF", 2000, &bytes(0), &second));
    let samples = found.channels[0].read().unwrap();
    assert!(
        samples.len() == 2000 && samples.iter().enumerate().all(|(n, x)| *x == n as f64 / 32_768.0),
        "{}",
        samples.len()
    );
    notes(&found, &["2 pieces"]);
    // A second format that differs says that the first does not hold.
    let mut twice = wav(b"RIFF", 2000, &bytes(0), &[]);
    let format = twice[12..36].to_vec();
    twice.splice(36..36, format);
    assert_eq!(opened(&desk, "same.wav", &twice).channels[0].len, 1000);
    twice[48] ^= 1;
    std::fs::write(desk.join("other.wav"), &twice).unwrap();
    assert_refused(Recording::open(desk.join("other.wav")), "says its format twice");
    #[cfg(unix)]
    assert_refused(Recording::open("/dev/null"), "a pipe or a device");
}

/// A timetable as MATLAB saves it: its name, what kind of object it is, and its class, without dimensions; then its
/// contents, a variable without a name.
#[test]
fn issue_a_matlab_object_leaves_its_neighbours_whole() {
    let desk = Scratch::create("matlab-object");
    let path = desk.join("a.mat");
    let acc = Channel::held("acc", (0..COUNT).map(signal).collect()).at_rate(Some(RATE_HZ));
    stribeck_formats::mat5::write(&path, &[acc], &[]).unwrap();
    let words = |words: &[u32]| words.iter().flat_map(|word| word.to_le_bytes()).collect::<Vec<u8>>();
    let variable = |body: Vec<u8>| [words(&[14, body.len() as u32]), body].concat();
    let object = [
        words(&[6, 8, 17, 0, 1, 1]),
        b"T\0\0\0\0\0\0\0".to_vec(),
        words(&[1, 4]),
        b"MCOS\0\0\0\0".to_vec(),
        words(&[1, 9]),
        b"timetable\0\0\0\0\0\0\0".to_vec(),
        words(&[14, 0]),
    ];
    let contents = [words(&[6, 8, 9, 0, 5, 8, 1, 8192, 1, 0, 2, 8192]), vec![7; 8192]];
    let file = std::fs::read(&path).unwrap();
    let found =
        opened(&desk, "b.mat", &[file, variable(object.concat()), variable(contents.concat())].concat());
    assert_eq!(sampled(&found, "acc").len, COUNT as u64);
    assert!(found.channels.iter().all(|channel| !channel.name.is_empty()), "{}", found.names());
    notes(&found, &["`T` is left out: it is a MATLAB object (timetable)"]);
}
