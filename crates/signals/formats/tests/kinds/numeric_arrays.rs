//! Numbers of every kind in both byte orders; arrays of MATLAB 4 and 5 and of NumPy: their shapes, and both
//! byte orders.

use stribeck_formats::{Kind, Number, Recording};
use stribeck_testing::Scratch;

use crate::{COUNT, RATE_HZ, holds, notes, opened, signal};

#[test]
fn roundtrip_every_kind_in_both_byte_orders() {
    let cases: [(Kind, Vec<u8>, f64); 10] = [
        (Kind::F16, vec![0x00, 0xc1], -2.5),
        (Kind::F16, vec![0x01, 0x00], 5.960_464_477_539_063e-8),
        (Kind::I8, (-5_i8).to_le_bytes().to_vec(), -5.0),
        (Kind::U16, 65_000_u16.to_le_bytes().to_vec(), 65_000.0),
        (Kind::I16, (-300_i16).to_le_bytes().to_vec(), -300.0),
        (Kind::I24, vec![0xfe, 0xff, 0xff], -2.0),
        (Kind::I32, (-70_000_i32).to_le_bytes().to_vec(), -70_000.0),
        (Kind::U32, u32::MAX.to_le_bytes().to_vec(), 4_294_967_295.0),
        (Kind::F32, 1.5_f32.to_le_bytes().to_vec(), 1.5),
        (Kind::F64, (-0.1_f64).to_le_bytes().to_vec(), -0.1),
    ];
    for (kind, bytes, value) in cases {
        assert_eq!(Number::little(kind).decode(&bytes), value, "{kind:?}");
        let turned: Vec<u8> = bytes.iter().rev().copied().collect();
        assert_eq!(Number { kind, big_endian: true }.decode(&turned), value, "{kind:?}");
    }
}

/// An element of a MATLAB 5 file.
fn mat5_element(kind: u32, data: &[u8]) -> Vec<u8> {
    let mut out = [kind, data.len() as u32].map(u32::to_le_bytes).concat();
    out.extend(data);
    out.resize(out.len().next_multiple_of(8), 0);
    out
}

pub(crate) fn mat5_matrix(name: &str, shape: &[i32], values: impl Iterator<Item = f64>) -> Vec<u8> {
    let parts = [
        mat5_element(6, &[6_u32, 0].map(u32::to_le_bytes).concat()),
        mat5_element(5, &shape.iter().flat_map(|n| n.to_le_bytes()).collect::<Vec<u8>>()),
        mat5_element(1, name.as_bytes()),
        mat5_element(9, &values.flat_map(f64::to_le_bytes).collect::<Vec<u8>>()),
    ];
    mat5_element(14, &parts.concat())
}

#[test]
fn issue_arrays_of_matlab_5_keep_their_shape() {
    let desk = Scratch::create("formats-mat5-shape");
    let mut head = b"MATLAB 5.0 MAT-file".to_vec();
    head.resize(124, b' ');
    head.extend([0, 1, b'I', b'M']);
    let bytes = [
        head,
        mat5_matrix("cube", &[2, 3, 50], (0..COUNT).map(signal)),
        mat5_matrix("thin", &[1, 1, 300], (0..COUNT).map(signal)),
        mat5_matrix("two", &[150, 2], (0..COUNT).map(signal)),
        mat5_matrix("fs", &[1, 1], std::iter::once(RATE_HZ)),
    ];
    let found = opened(&desk, "a.mat", &bytes.concat());
    assert!(!found.channels.iter().any(|c| c.name.contains("cube")), "{}", found.names());
    notes(&found, &["`cube` is left out", "3 dimensions, 2 × 3 × 50"]);
    holds(found.channel("thin").unwrap(), COUNT, signal);
    holds(found.channel("two(:,2)").unwrap(), 150, |n| signal(150 + n));
    assert_eq!(found.channel("thin").unwrap().rate_hz, Some(RATE_HZ));
}

#[test]
fn issue_matlab_4_is_read_in_both_byte_orders() {
    let desk = Scratch::create("formats-mat4");
    for is_big in [false, true] {
        let word = |n: u32| if is_big { n.to_be_bytes() } else { n.to_le_bytes() };
        let matrix = |name: &str, kind: u32, rows: u32, columns: u32, data: Vec<u8>| {
            let kind = kind + if is_big { 1000 } else { 0 };
            let head = [kind, rows, columns, 0, name.len() as u32 + 1].map(word).concat();
            [head, name.as_bytes().to_vec(), vec![0], data].concat()
        };
        let double = |x: f64| if is_big { x.to_be_bytes() } else { x.to_le_bytes() };
        let short = |x: i16| if is_big { x.to_be_bytes() } else { x.to_le_bytes() };
        let bytes = [
            matrix("acc", 0, COUNT as u32, 1, (0..COUNT).flat_map(|n| double(signal(n))).collect()),
            matrix("counts", 30, 2, 150, (0..COUNT).flat_map(|n| short(n as i16 - 9)).collect()),
            matrix("sr", 0, 1, 1, double(RATE_HZ).to_vec()),
        ];
        let found = opened(&desk, "a.mat", &bytes.concat());
        holds(found.channel("acc").unwrap(), COUNT, signal);
        assert_eq!(found.channel("acc").unwrap().rate_hz, Some(RATE_HZ));
        holds(found.channel("counts(2,:)").unwrap(), 150, |n| (2 * n + 1) as f64 - 9.0);
    }
}

#[test]
fn issue_arrays_of_numpy_keep_their_shape() {
    let desk = Scratch::create("formats-npy-shape");
    let file = |shape: &str| {
        let header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}\n");
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((header.len() as u16).to_le_bytes());
        bytes.extend(header.into_bytes());
        bytes.extend((0..COUNT).flat_map(|n| signal(n).to_le_bytes()));
        bytes
    };
    holds(&opened(&desk, "a.npy", &file("(1, 300, 1)")).channels[0], COUNT, signal);
    let path = desk.join("b.npy");
    std::fs::write(&path, file("(2, 3, 50)")).unwrap();
    let said = match Recording::open(&path) {
        Err(why) => why.to_string(),
        Ok(found) => {
            assert!(found.channels.is_empty(), "{}", found.names());
            found.notes.join("; ")
        }
    };
    assert!(said.contains("3 dimensions, 2 × 3 × 50"), "{said}");
}

/// libsndfile counts the tag of the last numbers twice; the file was called damaged.
#[test]
fn issue_matlab_5_of_libsndfile_counts_a_tag_twice() {
    let desk = Scratch::create("formats-mat5-sndfile");
    let mut bytes = b"MATLAB 5.0 MAT-file".to_vec();
    bytes.resize(124, b' ');
    bytes.extend([0, 1, b'I', b'M']);
    bytes.extend(mat5_matrix("samplerate", &[1, 1], std::iter::once(RATE_HZ)));
    let mut wave = mat5_matrix("wavedata", &[1, COUNT as i32], (0..COUNT).map(signal));
    let length = wave.len() as u32 - 8;
    for (more, is_read) in [(0, true), (8, true), (9, false)] {
        wave[4..8].copy_from_slice(&(length + more).to_le_bytes());
        let path = desk.join("a.mat");
        std::fs::write(&path, [&bytes[..], &wave].concat()).unwrap();
        match Recording::open(&path) {
            Ok(found) => {
                let channel = found.channel("wavedata").unwrap();
                assert_eq!((is_read, channel.rate_hz), (true, Some(RATE_HZ)), "{more}: {:?}", found.notes);
                holds(channel, COUNT, signal);
            }
            Err(why) => assert!(!is_read, "{more}: {why}"),
        }
    }
}

/// A struct of MATLAB 5 with its members.
fn mat5_struct(name: &str, members: &[(&str, Vec<u8>)]) -> Vec<u8> {
    const LONGEST: usize = 32;
    let names = members.iter().flat_map(|(name, _)| {
        let mut padded = name.as_bytes().to_vec();
        padded.resize(LONGEST, 0);
        padded
    });
    let parts = [
        mat5_element(6, &[2_u32, 0].map(u32::to_le_bytes).concat()),
        mat5_element(5, &[1_i32, 1].map(i32::to_le_bytes).concat()),
        mat5_element(1, name.as_bytes()),
        mat5_element(5, &(LONGEST as i32).to_le_bytes()),
        mat5_element(1, &names.collect::<Vec<u8>>()),
        members.iter().flat_map(|(_, bytes)| bytes.clone()).collect(),
    ];
    mat5_element(14, &parts.concat())
}

/// A text of MATLAB 5.
fn mat5_text(text: &str) -> Vec<u8> {
    let letters: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
    let parts = [
        mat5_element(6, &[4_u32, 0].map(u32::to_le_bytes).concat()),
        mat5_element(5, &[1_i32, text.len() as i32].map(i32::to_le_bytes).concat()),
        mat5_element(1, b""),
        mat5_element(4, &letters),
    ];
    mat5_element(14, &parts.concat())
}

/// A struct of Simcenter Testlab was refused: it "does not say how fast it was sampled".
#[test]
fn issue_structs_of_axes_say_rate_and_unit() {
    let desk = Scratch::create("formats-mat5-axes");
    let one = |value: f64| mat5_matrix("", &[1, 1], std::iter::once(value));
    let quantity = |unit: &str| mat5_struct("", &[("label", mat5_text(unit))]);
    let x = [("start_value", one(0.0)), ("increment", one(1.0 / 25_600.0)), ("quantity", quantity("s"))];
    let y = [("values", mat5_matrix("", &[150, 2], (0..COUNT).map(signal))), ("quantity", quantity("g"))];
    let all = [("x_values", mat5_struct("", &x)), ("y_values", mat5_struct("", &y))];
    let mut bytes = b"MATLAB 5.0 MAT-file".to_vec();
    bytes.resize(124, b' ');
    bytes.extend([0, 1, b'I', b'M']);
    bytes.extend(mat5_struct("Signal", &all));
    let recording = opened(&desk, "testlab.mat", &bytes);
    let signals: Vec<_> = recording.channels.iter().filter(|c| c.len == 150).collect();
    assert_eq!(signals.len(), 2, "{recording:?}");
    for channel in signals {
        assert_eq!((channel.rate_hz, channel.unit.as_deref()), (Some(25_600.0), Some("g")), "{channel:?}");
    }
}
