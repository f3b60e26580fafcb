//! Kinds of files that once gave wrong numbers in silence or were refused, each as a tiny input of our own.

use stribeck_formats::{Channel, Recording, uff58};
use stribeck_testing::Scratch;

use crate::{RATE_HZ, opened, signal};

/// Rows of times in milliseconds and of a signal, behind a head.
fn table(head: &str, separator: char, comma: bool, end: &str) -> String {
    let rows = (0..300).map(|n| {
        let row = format!("{:.5}{separator}{:.4}{end}\n", 1e3 * n as f64 / RATE_HZ, signal(n));
        if comma { row.replace('.', ",") } else { row }
    });
    head.to_owned() + &rows.collect::<String>()
}

/// The commonest head of all, and the unit in it was not read.
#[test]
fn issue_a_unit_in_the_name_of_a_column_is_its_unit() {
    let desk = Scratch::create("formats-kinds");
    for (name, unit) in [
        ("acc [g]", Some("g")),
        ("acc (m/s\u{b2})", Some("m/s\u{b2}")),
        ("acc [raw]", None),
        ("acc (2)", None),
        ("acc", None),
    ] {
        let text = table(&format!("time [ms],{name}\n"), ',', false, "");
        let found = opened(&desk, "a.csv", text.as_bytes());
        let channel = found.channels.iter().find(|c| !c.is_time).unwrap();
        assert_eq!((channel.name.as_str(), channel.unit.as_deref()), (name, unit));
        assert!((channel.rate_hz.unwrap() / RATE_HZ - 1.0).abs() < 1e-3);
    }
}

#[test]
fn issue_texts_keep_their_units_columns_and_rows() {
    let desk = Scratch::create("formats-kinds");
    for (head, separator, comma, end, name) in [
        ("Time,Acc\nms,m/s²\n", ',', false, "", "Acc"),
        ("Time,Acc\nms,mm/s2\n", ',', false, "", "Acc"),
        ("Time,Acc\nms,EU\n", ',', false, "", "Acc"),
        ("Time,Acc\nms,mV/g\n", ',', false, "", "Acc"),
        ("# t_ms acc_g\n", ' ', false, "", "acc_g"),
        ("\"Time, ms\",\"Acc, g\"\n", ',', false, "", "Acc, g"),
        ("time_ms,acc_g,comment\n", ',', false, ",", "acc_g"),
        ("Messung 7;\n;\nZeit [ms];Beschl. [g]\n", ';', true, "", "Beschl. [g]"),
        ("t [ms]|acc\n", '|', false, "", "acc"),
    ] {
        let text = table(head, separator, comma, end);
        let latin: Vec<u8> = text.chars().map(|c| c as u32 as u8).collect();
        let wide: Vec<u8> =
            [0xff, 0xfe].into_iter().chain(text.encode_utf16().flat_map(u16::to_le_bytes)).collect();
        let old = text.replace('\n', "\r").into_bytes();
        for bytes in [text.clone().into_bytes(), latin, wide, old] {
            let found = opened(&desk, "a.csv", &bytes);
            let channel = found.channels.iter().find(|c| !c.is_time).unwrap();
            assert_eq!((channel.name.as_str(), channel.len), (name, 300), "{head:?}");
            let hz = channel.rate_hz.unwrap_or_else(|| panic!("{head:?}: {:?}", found.notes));
            assert!((hz / RATE_HZ - 1.0).abs() < 1e-3, "{head:?}: {hz}");
            let samples = channel.read().unwrap();
            assert!(samples.iter().enumerate().all(|(n, x)| (x - signal(n)).abs() < 1e-4), "{head:?}");
        }
    }
}

#[test]
fn issue_one_column_stamps_and_headers_of_counts() {
    let desk = Scratch::create("formats-kinds-csv");
    let column: String = (0..300).map(|n| format!("{:.4}\n", signal(n)).replace('.', ",")).collect();
    let found = opened(&desk, "a.csv", format!("Beschleunigung\n{column}").as_bytes());
    assert_eq!((found.channels.len(), found.channels[0].name.as_str()), (1, "Beschleunigung"));
    assert_eq!(opened(&desk, "b.csv", column.as_bytes()).channels.len(), 1);
    let counted: String = (0..300).map(|n| format!("{0:.4},{0:.4},{0:.4}\n", signal(n))).collect();
    let found = opened(&desk, "c.csv", format!("0,1,2\n{counted}").as_bytes());
    assert_eq!((found.channels.len(), found.channels[2].len), (3, 300));
    // Whether the third column is called by its header or by its place.
    for asked in ["2", "column 3"] {
        assert_eq!(found.channel(asked).unwrap().name, "2");
    }
    let stamps: String =
        (0..300).map(|n| format!("2024-05-01 08:00:00.{:09},{:.4}\n", 78_125 * n, signal(n))).collect();
    let found = opened(&desk, "d.csv", format!("timestamp,acc\n{stamps}").as_bytes());
    assert!((found.channels[1].rate_hz.unwrap() / RATE_HZ - 1.0).abs() < 1e-4, "{:?}", found.notes);
    let gap = table("t [ms],acc\n", ',', false, "").replace("\n0.07812,", "\n0.07812,oops") + "23.5";
    let found = opened(&desk, "e.csv", gap.as_bytes());
    assert_eq!(found.channels[1].len, 300);
    assert!(
        found.notes.iter().any(|n| n.contains("`oops")) && found.notes.iter().any(|n| n.contains("cut off")),
        "{:?}",
        found.notes
    );
}

/// `n[0]`, as columns without names are called, was taken for a name with the unit `0`.
#[test]
fn issue_times_in_a_column_of_an_array_are_found() {
    let desk = Scratch::create("formats-kinds-columns");
    let mut header = "{'descr': '<f8', 'fortran_order': False, 'shape': (300, 2), }".to_owned();
    header += &" ".repeat((64 - (10 + header.len() + 1) % 64) % 64);
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16 + 1).to_le_bytes());
    bytes.extend((header + "\n").bytes());
    bytes.extend((0..300).flat_map(|n| [n as f64 / RATE_HZ, signal(n)]).flat_map(f64::to_le_bytes));
    let found = opened(&desk, "n.npy", &bytes);
    assert_eq!(found.channels[1].rate_hz, Some(RATE_HZ), "{:?}: {:?}", found.names(), found.notes);
}

#[test]
fn issue_records_of_numpy_have_any_names_and_padding() {
    let desk = Scratch::create("formats-kinds-npy");
    let file = |descr: &str, shape: &str, record: &dyn Fn(usize) -> Vec<u8>| {
        let header = format!("{{'descr': {descr}, 'fortran_order': False, 'shape': {shape}, }}\n");
        let header: Vec<u8> = header.chars().map(|c| c as u32 as u8).collect();
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((header.len() as u16).to_le_bytes());
        bytes.extend(header);
        bytes.extend((0..300).flat_map(record));
        bytes
    };
    let time = |n: usize| (n as f64 / RATE_HZ).to_le_bytes();
    let pair = |n: usize| [time(n), signal(n).to_le_bytes()].concat();
    let found = opened(&desk, "a.npy", &file("[('t (s)', '<f8'), ('acc [m/s²]', '<f8')]", "(300,)", &pair));
    assert_eq!((found.channels[1].name.as_str(), found.channels[1].rate_hz), ("acc [m/s²]", Some(RATE_HZ)));
    let padded = |n: usize| [&[1, 0, 0, 0, 0, 0, 0, 0][..], &signal(n).to_le_bytes()].concat();
    let found =
        opened(&desk, "b.npy", &file("[('n', '<i2'), ('', '|V6'), (\"it's\", '<f8')]", "(300,)", &padded));
    assert_eq!((found.channels[1].name.as_str(), found.channels[1].read().unwrap()[7]), ("it's", signal(7)));
}

#[test]
fn issue_wav_without_its_size_is_read_to_its_end() {
    let desk = Scratch::create("formats-kinds-wav");
    for size in [0_u32, u32::MAX] {
        for odd in [false, true] {
            let mut bytes = b"RIFF\0\0\0\0WAVE".to_vec();
            if odd {
                bytes.extend(b"LIST\x05\0\0\0INFOx");
            }
            bytes.extend(b"fmt \x10\0\0\0\x01\0\x01\0");
            bytes.extend(12_800_u32.to_le_bytes());
            bytes.extend(25_600_u32.to_le_bytes());
            bytes.extend([2, 0, 16, 0]);
            bytes.extend(b"data");
            bytes.extend(size.to_le_bytes());
            bytes.extend((0..300_i16).flat_map(i16::to_le_bytes));
            let found = opened(&desk, "a.wav", &bytes);
            assert_eq!((found.channels[0].len, found.channels[0].rate_hz), (300, Some(RATE_HZ)));
        }
    }
}

/// Numbers of 24 bits in four bytes each were read three bytes at a time.
#[test]
fn issue_wav_whose_numbers_do_not_fill_their_bytes_is_refused() {
    let desk = Scratch::create("formats-kinds-frames");
    let written = |frame: u8| {
        let mut bytes = b"RIFF\0\0\0\0WAVEfmt \x10\0\0\0\x01\0\x01\0".to_vec();
        bytes.extend([12_800_u32, 51_200].map(u32::to_le_bytes).concat());
        bytes.extend([frame, 0, 24, 0]);
        bytes.extend(b"data");
        bytes.extend(1200_u32.to_le_bytes());
        bytes.extend((0..300_i32).flat_map(i32::to_le_bytes));
        let path = desk.join("a.wav");
        std::fs::write(&path, bytes).unwrap();
        Recording::open(&path)
    };
    let why = written(4).map(|_| ()).expect_err("four bytes").to_string();
    assert!(why.contains("1 numbers of 24 bits in 4 bytes") && why.contains("fill their bytes"), "{why}");
    // Three bytes are the rule; some writers leave the number out.
    for frame in [3, 0] {
        assert_eq!(written(frame).expect("three bytes").channels[0].len, 400);
    }
}

/// Its step was taken for seconds, whatever its axis said.
#[test]
fn issue_steps_of_universal_files_have_the_unit_of_their_axis() {
    let desk = Scratch::create("formats-kinds-axis");
    let path = desk.join("a.uff");
    let samples = (0..300).map(signal).collect();
    uff58::write(&path, &[Channel::held("acc", samples).at_rate(Some(12.8))], &[]).unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    let axis = format!("{:<20} {:<20}", "Time", "s");
    assert_eq!(text.matches(&axis).count(), 1, "{text}");
    for (unit, rate_hz) in [("s", 12.8), ("ms", 12_800.0), ("NONE", 12.8)] {
        let other = text.replace(&axis, &format!("{:<20} {unit:<20}", "Time"));
        assert_eq!(opened(&desk, "b.uff", other.as_bytes()).channels[0].rate_hz, Some(rate_hz), "{unit}");
    }
    // And so has the place of their first sample, which was taken for 0.
    let begins = "  0.00000E+00  7.81250E-02";
    assert_eq!(text.matches(begins).count(), 1, "{text}");
    for (unit, start_s) in [("s", 0.8), ("ms", 0.8e-3)] {
        let other = text.replace(&axis, &format!("{:<20} {unit:<20}", "Time"));
        let other = other.replace(begins, "  8.00000E-01  7.81250E-02");
        let found = opened(&desk, "c.uff", other.as_bytes()).channels[0].start_s.unwrap();
        assert!((found - start_s).abs() < 1e-9, "{unit}: {found}");
    }
}

/// `12,800 Hz` was read as 12.8 Hz, and the 8 s of a whole record as the time between two samples.
#[test]
fn issue_a_rate_with_its_thousands_in_groups() {
    let desk = Scratch::create("formats-kinds-thousands");
    let rows = lines(|n| format!("{:.4}", signal(n)));
    let comma = lines(|n| format!("{:.4}", signal(n) + 1.5).replace('.', ","));
    for (head, rows, rate_hz) in [
        ("Sample rate: 12,800 Hz", &rows, Some(12_800.0)),
        ("Sample rate: 12.800 kHz", &rows, Some(12_800.0)),
        ("Sample rate: 1,024,000 Hz", &rows, Some(1_024_000.0)),
        ("Sample rate: 12800 Sa/s", &rows, Some(12_800.0)),
        ("Sample rate: 12.8 kS/s", &rows, Some(12_800.0)),
        ("Sample rate: 12800 samples/s", &rows, Some(12_800.0)),
        ("Sample rate: 12,800 Sa/s", &rows, Some(12_800.0)),
        ("Sample rate: 12,800 hz", &rows, Some(12_800.0)),
        ("Sample rate [Hz]: 12,800", &rows, Some(12_800.0)),
        ("Sample rate: 512.000 Hz", &rows, Some(512.0)),
        ("Sampling time: 8 s", &rows, None),
        ("Sampling time (s): 8", &rows, None),
        ("Sampling time (s): 0.0001", &rows, Some(10_000.0)),
        ("Sampling time: 2 ms", &rows, Some(500.0)),
        ("Sampling time: 0.1 ms", &rows, Some(10_000.0)),
        ("Sampling interval: 8 s", &rows, Some(0.125)),
        // Either is thousands or a fraction there.
        ("Sample rate: 12,800 Hz", &comma, None),
        ("Sample rate: 12.800 Hz", &comma, None),
        ("Sample rate: 12,8 kHz", &comma, Some(12_800.0)),
    ] {
        let (found, _) = samples(&desk, &format!("{head}\nacc\n{rows}"));
        assert_eq!(found, rate_hz, "{head}");
    }
}

/// Samples of the only channel that is no time.
fn samples(desk: &Scratch, text: &str) -> (Option<f64>, Vec<f64>) {
    let found = opened(desk, "a.csv", text.as_bytes());
    let mut signals = found.channels.iter().filter(|c| !c.is_time);
    let channel = signals.next().unwrap_or_else(|| panic!("{:?}", found.notes));
    assert!(signals.next().is_none(), "{}", found.names());
    (channel.rate_hz, channel.read().unwrap())
}

fn lines(row: impl Fn(usize) -> String) -> String {
    (0..300).map(|n| row(n) + "\n").collect()
}

#[test]
fn issue_one_column_with_decimal_commas_however_its_numbers_are_written() {
    let desk = Scratch::create("formats-kinds-column");
    let comma = |text: String| text.replace('.', ",");
    let exact = |n: usize| 1e3 * signal(n) - 0.5 * (n % 2) as f64;
    for (text, factor) in [
        (lines(|n| comma(format!("{:.6e}", exact(n)))), 1.0),
        ("acc\n".to_owned() + &lines(|n| comma(format!("{:.2}", exact(n)))), 1.0),
        ("acc\n".to_owned() + &lines(|n| format!("\"{}\"", comma(format!("{:.2}", exact(n))))), 1.0),
        // Thousands in groups; in every tenth row and more there is one.
        (
            "acc\n".to_owned()
                + &lines(|n| comma(format!("{:.2}", exact(n) + 500.0)).replace("1010,", "1.010,")),
            0.0,
        ),
    ] {
        // The first is without a name above: exponents and zeros show it.
        let text = if text.starts_with("acc") { text } else { "Messung 7\n".to_owned() + &text };
        let (_, found) = samples(&desk, &text);
        let shift = if factor == 0.0 { 500.0 } else { 0.0 };
        let good = found.iter().enumerate().all(|(n, x)| (x - exact(n) - shift).abs() < 1e-6);
        assert!(good && found.len() == 300, "{}", &text[..80]);
    }
    // One row that is damaged does not split the others.
    let row = |n: usize| if n == 3 { "-0;x6".to_owned() } else { comma(format!("{:.2}", signal(n))) };
    let (_, found) = samples(&desk, &("acc\n".to_owned() + &lines(row)));
    // Nor without a name above.
    let short = lines(|n| if n == 3 { "0,1".to_owned() } else { comma(format!("{:.2}", signal(n).abs())) });
    assert_eq!(samples(&desk, &short).1[3..5], [0.1, 0.06]);
    assert!(found[3].is_nan() && found[7] == 0.01 * (100.0 * signal(7)).round(), "{:?}", &found[..8]);
}

#[test]
fn issue_thousands_minus_signs_and_times_with_their_unit() {
    let desk = Scratch::create("formats-kinds-thousands");
    let value = |n: usize| 1500.0 * signal(n);
    let grouped = |n: usize, group: &str| {
        let (whole, cents) =
            ((value(n).abs() * 100.0).round() as u64 / 100, (value(n).abs() * 100.0).round() as u64 % 100);
        let sign = if value(n) < 0.0 { "-" } else { "" };
        let text = if whole > 999 {
            format!("{}{group}{:03}", whole / 1000, whole % 1000)
        } else {
            whole.to_string()
        };
        (format!("{sign}{text}"), format!("{cents:02}"))
    };
    let row = |n: usize, sign: char, group: &str, quote: &str, split: char| {
        let ((whole, cents), t) = (grouped(n, group), format!("{:.5}", 1e3 * n as f64 / RATE_HZ));
        format!("{}{split}{quote}{whole}{sign}{cents}{quote}", t.replace('.', &sign.to_string()))
    };
    for text in [
        lines(|n| row(n, ',', ".", "", ';')),
        lines(|n| row(n, '.', ",", "\"", ',')),
        lines(|n| row(n, '.', "'", "", ';')),
        lines(|n| row(n, ',', "\u{a0}", "", ';')),
        lines(|n| row(n, '.', "", "", ';').replace('-', "\u{2212}")),
    ] {
        let (rate_hz, found) = samples(&desk, &("t [ms];acc\n".to_owned() + &text));
        assert!((rate_hz.unwrap() / RATE_HZ - 1.0).abs() < 1e-3, "{}", &text[..60]);
        assert!(found.iter().enumerate().all(|(n, x)| (x - value(n)).abs() < 0.006), "{}", &text[..60]);
    }
    // A single group without a fraction may be a decimal point: no number.
    let found = Recording::open({
        let path = desk.join("b.csv");
        std::fs::write(&path, "t [ms];acc\n".to_owned() + &lines(|n| format!("{n};1,{:03}", 100 + n)))
            .unwrap();
        path
    });
    let read = found.unwrap().channels.iter().find(|c| c.name == "acc").map(|c| c.read().unwrap()[1]);
    assert_eq!(read, Some(1.101));
    // MATLAB writes the times of a timetable so.
    for (unit, second) in [(" sec", 1.0), (" ms", 1e-3), ("ms", 1e-3), (" min", 60.0)] {
        let text = lines(|n| format!("{:.9}{unit},{}", n as f64 / RATE_HZ / second, signal(n)));
        let (rate_hz, found) = samples(&desk, &("Time,Acc\n".to_owned() + &text));
        assert!(
            (rate_hz.unwrap() / RATE_HZ - 1.0).abs() < 1e-3 && found[7] == signal(7),
            "{unit}: {rate_hz:?}"
        );
    }
}

#[test]
fn issue_rows_that_are_no_samples_and_rows_that_are_channels() {
    let desk = Scratch::create("formats-kinds-rows");
    let table = lines(|n| format!("{:.9},{:.4}", n as f64 / RATE_HZ, signal(n)));
    // Sums below the table.
    for below in ["\nTotal,300\nMean,0.01\n", "Max,1\n", "\nSum;300\n"] {
        let (rate_hz, found) = samples(&desk, &format!("t [s],acc [g]\n{table}{below}"));
        assert_eq!((rate_hz, found.len(), found[299]), (Some(RATE_HZ), 300, signal(299)), "{below}");
    }
    // A damaged time at the end costs no sample.
    let (_, found) = samples(&desk, &format!("t [s],acc [g]\n{table}0.o3,0.5\n"));
    assert_eq!((found.len(), found[300]), (301, 0.5));
    // What an oscilloscope says of a record, beside its first samples.
    let words = ["Record Length,300,,", "Sample Interval,7.8125e-05,,", "Trigger Point,0,,", ",,,"];
    let row = |n: usize| {
        let beside = words.get(n).map_or(",,,", |words| words);
        format!("{beside}{:.9},{:.4}", (n as f64 - 150.0) / RATE_HZ, signal(n))
    };
    let found = opened(&desk, "b.csv", lines(row).as_bytes());
    let channel = found.channel("column 5").unwrap();
    assert_eq!((channel.rate_hz, channel.len), (Some(RATE_HZ), 300), "{:?}", found.notes);
    assert_eq!(channel.read().unwrap()[..3], [0, 1, 2].map(|n| (1e4 * signal(n)).round() / 1e4));
    // LabVIEW heads a column of comments that the rows leave out.
    let rows = lines(|n| format!("\t{:.4}\t{:.4}", signal(n), signal(n + 1)));
    let head = "LabVIEW Measurement\nX_Columns\tNo\n***End_of_Header***\t\n\t\nChannels\t2\t\n\
                Delta_X\t7.8125E-5\t7.8125E-5\n***End_of_Header***\t\t\t\n\
                X_Value\tone\ttwo\tComment\n";
    let found = opened(&desk, "c.lvm", (head.to_owned() + &rows).as_bytes());
    let channel = found.channel("two").unwrap();
    assert_eq!((channel.rate_hz, channel.read().unwrap()[7]), (Some(RATE_HZ), signal(8)));
    // A vector that was written as a row, and two.
    let vector: Vec<String> = (0..300).map(|n| signal(n).to_string()).collect();
    for (text, rows) in [(vector.join(",") + "\n", 1), (format!("{0}\n{0}\n", vector.join("\t")), 2)] {
        let found = opened(&desk, "d.csv", text.as_bytes());
        assert_eq!((found.channels.len(), found.channels[rows - 1].len), (rows, 300));
        assert_eq!(
            found.channels[rows - 1].read().unwrap()[..],
            (0..300).map(signal).collect::<Vec<_>>()[..]
        );
    }
}

#[test]
fn issue_times_since_1970_say_their_unit() {
    let desk = Scratch::create("formats-kinds-epoch");
    for (a_second, digits) in [(1e6, 3), (1e9, 0)] {
        let row = |n: usize| {
            format!("{:.digits$},{:.4}", a_second * (1.714_550_4e9 + n as f64 / RATE_HZ), signal(n))
        };
        let (rate_hz, _) = samples(&desk, &("timestamp,acc\n".to_owned() + &lines(row)));
        assert!((rate_hz.unwrap() / RATE_HZ - 1.0).abs() < 1e-3, "{a_second}: {rate_hz:?}");
    }
    // Milliseconds of a slow record.
    let row = |n: usize| format!("{:.0},{:.4}", 1.714_550_4e12 + 5.0 * n as f64, signal(n));
    assert_eq!(samples(&desk, &("timestamp,acc\n".to_owned() + &lines(row))).0, Some(200.0));
    // Others stay without a rate.
    let row = |n: usize| format!("{:.6},{:.4}", 4e12 + 78.125 * n as f64, signal(n));
    assert_eq!(samples(&desk, &("timestamp,acc\n".to_owned() + &lines(row))).0, None);
}

#[test]
fn issue_lines_above_a_table_say_its_rate() {
    let desk = Scratch::create("formats-kinds-rate");
    for head in [
        "# fs = 12800 Hz\nacc\n",
        "Abtastrate [Hz];12800\nacc\n",
        "Sampling Frequency: 12.8 kHz\nacc\n",
        "Record Length,300\nSample Interval,7.8125e-05\nacc\n",
        "Delta_X\t7,8125E-5\nacc\n",
        "Audacity Sample Data Export\nSample Rate: 12800 Hz. Sample values on linear scale. 1 channel \
         (mono).\n\n",
    ] {
        let (rate_hz, found) = samples(&desk, &(head.to_owned() + &lines(|n| format!("{:.4}", signal(n)))));
        assert_eq!((rate_hz, found.len(), found[7]), (Some(RATE_HZ), 300, signal(7)), "{head}");
    }
    // Two that contradict each other, an unknown unit, a sentence.
    for head in [
        "fs: 12800\nSample rate: 25600\nacc\n",
        "Sample rate: 3 turtles\nacc\n",
        "Sample rate: see page 12800\nacc\n",
        "Rate: 20\nacc\n",
    ] {
        let (rate_hz, _) = samples(&desk, &(head.to_owned() + &lines(|n| format!("{:.4}", signal(n)))));
        assert_eq!(rate_hz, None, "{head}");
    }
}
