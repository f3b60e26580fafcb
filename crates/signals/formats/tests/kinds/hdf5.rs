//! HDF5 and netCDF: objects that cannot be read beside others, damage, rates, times and scale factors.

use stribeck_formats::Recording;
use stribeck_testing::Scratch;

use crate::{COUNT, RATE_HZ, holds, notes, signal};

/// Files that h5py wrote, by `fixtures/signals/make.py`.
fn fixture(name: &str) -> Recording {
    let path = format!("{}/../../../fixtures/signals/{name}", env!("CARGO_MANIFEST_DIR"));
    Recording::open(&path).unwrap_or_else(|why| panic!("{name}: {why}"))
}

#[test]
fn issue_one_object_of_hdf5_does_not_spoil_the_others() {
    for (file, name, words) in [
        ("links.h5", "raw.acc", &["`alias` is left out", "link"][..]),
        ("blosc.h5", "acc", &["`packed` is left out", "blosc"]),
        ("btree2.h5", "acc", &["`two` is left out"]),
        ("virtual.h5", "acc", &["`put_together` is left out", "virtual"]),
        ("cube.h5", "acc", &["`cube` is left out", "3 dimensions, 10 × 2 × 3"]),
        ("table.h5", "acc", &["`table` is left out", "records (t, a)"]),
    ] {
        let found = fixture(file);
        let channel = found.channel(name).unwrap_or_else(|why| panic!("{file}: {why} {:?}", found.notes));
        holds(channel, COUNT, |n| signal(n) as f32 as f64);
        notes(&found, words);
    }
}

#[test]
fn issue_a_damaged_object_of_hdf5_costs_that_object_only() {
    let desk = Scratch::create("formats-damaged-object");
    for (file, sets) in [("few.h5", 3), ("many.h5", 60)] {
        let path = format!("{}/../../../fixtures/signals/{file}", env!("CARGO_MANIFEST_DIR"));
        let (good, all) = (std::fs::read(path).unwrap(), fixture(file));
        assert_eq!(all.channels.len(), sets);
        let headers: Vec<usize> = (0..good.len() - 4).filter(|at| good[*at..].starts_with(b"OHDR")).collect();
        // Those of the sets, of the group and of the root.
        assert_eq!(headers.len(), sets + 2);
        let mut costs = Vec::new();
        for at in headers {
            // The name of the header, its checksum's sum, or its end: the file is cut off there.
            for damage in 0..2 {
                let mut bytes = good.clone();
                bytes[at + 12 * damage] ^= 0x55;
                let path = desk.join("a.h5");
                std::fs::write(&path, &bytes).unwrap();
                let found = Recording::open(&path);
                let there = found.as_ref().map_or(&[][..], |found| &found.channels);
                let kept = |name: &str| there.iter().find(|c| c.name == name);
                let lost: Vec<_> = all.channels.iter().filter(|c| kept(&c.name).is_none()).collect();
                for of in &all.channels {
                    if let Some(channel) = kept(&of.name) {
                        assert_eq!(channel.read().unwrap(), of.read().unwrap());
                    }
                }
                if let (Ok(found), [only]) = (&found, &lost[..]) {
                    notes(found, &[&format!("`{}` is left out", only.name)]);
                }
                costs.push(lost.len());
            }
        }
        costs.sort_unstable();
        // Every set but those that lie in the group, and the root.
        let in_group = if sets == 3 { 2 } else { 60 };
        let mut expected = vec![1; 2 * sets];
        expected.extend([in_group, in_group, sets, sets]);
        assert_eq!(costs, expected, "{file}");
    }
}

#[test]
fn issue_attributes_of_hdf5_say_rate_and_unit() {
    let found = fixture("attributes.h5");
    let channel = found.channel("near.acc").unwrap();
    assert_eq!((channel.rate_hz, channel.unit.as_deref()), (Some(RATE_HZ), Some("g")), "{:?}", found.notes);
    // A group has a rate of its own.
    assert_eq!(found.channel("far.acc").unwrap().rate_hz, Some(3200.0), "{:?}", found.notes);
}

#[test]
fn issue_times_of_netcdf_count_from_a_date() {
    let found = fixture("since.h5");
    let channel = found.channel("acc").unwrap();
    assert_eq!((channel.rate_hz, channel.len), (Some(RATE_HZ), COUNT as u64), "{:?}", found.notes);
}

#[test]
fn issue_scale_factors_of_hdf5_are_applied() {
    let found = fixture("scaled.h5");
    holds(found.channel("acc").unwrap(), COUNT, |n| 0.5 + 0.001 * (1000.0 * signal(n)).round());
}

/// All sets were laid at one start, and a tachometer that began 0.8 s later shifted the angle.
#[test]
fn issue_sets_of_hdf5_begin_when_their_attributes_say() {
    let found = fixture("started.h5");
    let start = |name: &str| found.channel(name).unwrap().start_s;
    assert_eq!((start("acc"), start("tacho")), (Some(2.5), Some(3.3)), "{:?}", found.notes);
}

/// They became samples of -32.768.
#[test]
fn issue_fill_values_of_netcdf_are_no_numbers() {
    let found = fixture("missing.h5");
    let is_missing = |n: usize| (100..103).contains(&n);
    holds(found.channel("acc").unwrap(), COUNT, |n| if is_missing(n) { f64::NAN } else { signal(n) });
}

/// `_FillValue` is a list of one number where netCDF's own library writes it, and counted as none.
#[test]
fn issue_packed_pieces_of_hdf5_2_and_lists_of_marks_are_read() {
    let found = fixture("packed.h5");
    for name in ["one", "fixed", "growing"] {
        holds(found.channel(name).unwrap_or_else(|why| panic!("{why} {:?}", found.notes)), COUNT, signal);
    }
    let marked = found.channel("marked").unwrap();
    holds(marked, COUNT, |n| if [100, 101, 200].contains(&n) { f64::NAN } else { signal(n) });
    assert_eq!(marked.unit, None);
    holds(fixture("behind.h5").channel("acc").unwrap(), COUNT, |n| signal(n) as f32 as f64);
}

/// It was refused in the words of the library, which advised a programmer.
#[test]
fn issue_a_file_of_hdf5_that_is_being_written_is_read() {
    let found = fixture("in_use.h5");
    holds(found.channel("acc").unwrap(), COUNT, |n| signal(n) as f32 as f64);
    notes(&found, &["did not close it", "still writes"]);
}

/// A file of 9 kB whose head claims a piece of 4 GB took them for 48 numbers.
#[test]
fn refuses_a_piece_of_hdf5_that_no_memory_should_hold() {
    let desk = Scratch::create("formats-hdf5-piece");
    let path = format!("{}/../../../fixtures/signals/small/old.h5", env!("CARGO_MANIFEST_DIR"));
    let mut bytes = std::fs::read(path).unwrap();
    // The layout of `gzip`, of version 3: pieces of 16 numbers of 8 bytes, behind the address of their index.
    let sizes = [16, 8_u32].map(u32::to_le_bytes).concat();
    let is_layout =
        |at: &usize| bytes[*at..].starts_with(&[3, 2, 2]) && bytes[*at + 11..].starts_with(&sizes);
    let at = (0..bytes.len() - 19).find(is_layout).unwrap();
    let path = desk.join("a.h5");
    let tree = u64::from_le_bytes(bytes[at + 3..at + 11].try_into().unwrap()) as usize;
    assert!(bytes[tree..].starts_with(b"TREE"));
    // The size of a piece, and how many bytes its first one takes by the index.
    for (place, with, why) in [
        (at + 11, 0x1f00_0010_u32, "in pieces of 520093712 numbers"),
        (tree + 24, u32::MAX, "ends behind the end of the file"),
    ] {
        let before = bytes[place..place + 4].to_vec();
        bytes[place..place + 4].copy_from_slice(&with.to_le_bytes());
        std::fs::write(&path, &bytes).unwrap();
        let found = Recording::open(&path).unwrap();
        notes(&found, &["`gzip` is left out", why]);
        assert!(found.channel("plain").is_ok());
        bytes[place..place + 4].copy_from_slice(&before);
    }
}
