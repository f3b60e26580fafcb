//! MDF 4: samples that are marked invalid, and channels of time.

use stribeck_testing::Scratch;

use crate::{COUNT, RATE_HZ, holds, notes, opened, signal};

pub(crate) struct MdfChannel<'a> {
    pub(crate) name: &'a str,
    pub(crate) unit: &'a str,
    /// 0 fixed length, 2 master, 3 virtual master.
    pub(crate) sort: u8,
    /// 0 unsigned, 4 float; and bits.
    pub(crate) kind: (u8, u32),
    /// Byte in the record.
    pub(crate) place: u32,
    /// Offset and slope.
    pub(crate) line: Option<(f64, f64)>,
    /// Bit that says that a sample is invalid.
    pub(crate) invalid: Option<u32>,
}

/// One group of an MDF file: its channels, bytes of data and of invalidation bits in a record, and its
/// records.
pub(crate) type MdfGroup<'a> = (&'a [MdfChannel<'a>], u32, u32, Vec<Vec<u8>>);

pub(crate) fn mdf(groups: &[MdfGroup<'_>]) -> Vec<u8> {
    let mut bytes = b"MDF     4.10    tests   \0\0\0\0\x9a\x01".to_vec();
    bytes.resize(64, 0);
    /// Puts a block at the end, and says where it is.
    fn put(bytes: &mut Vec<u8>, sort: &[u8; 4], links: &[u64], data: &[u8]) -> u64 {
        let at = bytes.len() as u64;
        bytes.extend(sort);
        bytes.extend([0; 4]);
        bytes.extend((24 + 8 * links.len() as u64 + data.len() as u64).to_le_bytes());
        bytes.extend((links.len() as u64).to_le_bytes());
        links.iter().for_each(|link| bytes.extend(link.to_le_bytes()));
        bytes.extend(data);
        bytes.resize(bytes.len().next_multiple_of(8), 0);
        at
    }
    // The header block stands first; its link to the groups is filled in at the end.
    let header = put(&mut bytes, b"##HD", &[0; 6], &[0; 32]);
    let mut next_group = 0;
    for (channels, data_bytes, invalid_bytes, records) in groups.iter().rev() {
        let mut next = 0;
        for of in channels.iter().rev() {
            let text = |bytes: &mut Vec<u8>, text: &str| {
                put(bytes, b"##TX", &[], &[text.as_bytes(), b"\0"].concat())
            };
            let name = text(&mut bytes, of.name);
            let unit = if of.unit.is_empty() { 0 } else { text(&mut bytes, of.unit) };
            let conversion = of.line.map_or(0, |(offset, slope)| {
                let mut data = vec![1, 0, 0, 0, 0, 0, 2, 0];
                data.extend([0.0, 0.0, offset, slope].into_iter().flat_map(f64::to_le_bytes));
                put(&mut bytes, b"##CC", &[0; 4], &data)
            });
            let mut data = vec![of.sort, u8::from(of.sort >= 2), of.kind.0, 0];
            let flags = if of.invalid.is_some() { 2 } else { 0 };
            let words = [of.place, of.kind.1, flags, of.invalid.unwrap_or(0)];
            data.extend(words.into_iter().flat_map(u32::to_le_bytes));
            data.resize(72, 0);
            next = put(&mut bytes, b"##CN", &[next, 0, name, 0, conversion, 0, unit, 0], &data);
        }
        let mut data = 0_u64.to_le_bytes().to_vec();
        data.extend((records.len() as u64).to_le_bytes());
        data.extend([0; 8]);
        data.extend([*data_bytes, *invalid_bytes].into_iter().flat_map(u32::to_le_bytes));
        let group = put(&mut bytes, b"##CG", &[0, next, 0, 0, 0, 0], &data);
        let samples = put(&mut bytes, b"##DT", &[], &records.concat());
        next_group = put(&mut bytes, b"##DG", &[next_group, group, samples, 0], &[0; 8]);
    }
    let at = header as usize + 24;
    bytes[at..at + 8].copy_from_slice(&next_group.to_le_bytes());
    bytes
}

const FLOAT: (u8, u32) = (4, 64);

pub(crate) fn mdf_channel(name: &str, place: u32) -> MdfChannel<'_> {
    MdfChannel { name, unit: "", sort: 0, kind: FLOAT, place, line: None, invalid: None }
}

/// Records of a time, as `time` gives it, and of the signal.
pub(crate) fn timed(time: impl Fn(usize) -> f64) -> Vec<Vec<u8>> {
    (0..COUNT).map(|n| [time(n).to_le_bytes(), signal(n).to_le_bytes()].concat()).collect()
}

#[test]
fn issue_invalid_samples_of_mdf_are_no_numbers() {
    let desk = Scratch::create("formats-mdf-invalid");
    let channels = [
        MdfChannel { unit: "s", sort: 2, ..mdf_channel("time", 0) },
        MdfChannel { unit: "g", invalid: Some(1), ..mdf_channel("acc", 8) },
        MdfChannel { invalid: Some(0), ..mdf_channel("other", 8) },
    ];
    let is_bad = |n: usize| (40..70).contains(&n);
    let records = timed(|n| n as f64 / RATE_HZ).into_iter().enumerate();
    let records = records.map(|(n, record)| [&record[..], &[if is_bad(n) { 2 } else { 0 }]].concat());
    let found = opened(&desk, "a.mf4", &mdf(&[(&channels, 16, 1, records.collect())]));
    let channel = found.channel("acc").unwrap();
    assert_eq!((channel.rate_hz, channel.unit.as_deref()), (Some(RATE_HZ), Some("g")));
    holds(channel, COUNT, |n| if is_bad(n) { f64::NAN } else { signal(n) });
    // The bit of another channel does not count.
    holds(found.channel("other").unwrap(), COUNT, signal);
}

#[test]
fn issue_masters_of_mdf_may_be_virtual_scaled_and_jitter() {
    let desk = Scratch::create("formats-mdf-masters");
    let acc = || mdf_channel("acc", 8);
    let rate = |name: &str, master: MdfChannel<'_>, time: &dyn Fn(usize) -> f64| {
        let found = opened(&desk, name, &mdf(&[(&[master, acc()], 16, 0, timed(time))]));
        let channel = found.channel("acc").unwrap();
        holds(channel, COUNT, signal);
        (channel.rate_hz, found.notes.join("; "))
    };
    let time = || mdf_channel("time", 0);
    let of_virtual = MdfChannel { sort: 3, kind: (0, 0), line: Some((0.0, 1.0 / RATE_HZ)), ..time() };
    assert_eq!(rate("a.mf4", of_virtual, &|_| 0.0).0, Some(RATE_HZ));
    let scaled = MdfChannel { sort: 2, line: Some((5.0, 1.0 / RATE_HZ)), ..time() };
    assert_eq!(rate("b.mf4", scaled, &|n| n as f64).0, Some(RATE_HZ));
    let milliseconds = MdfChannel { sort: 2, unit: "ms", ..time() };
    assert_eq!(rate("c.mf4", milliseconds, &|n| 1e3 * n as f64 / RATE_HZ).0, Some(RATE_HZ));
    let jitter = |n: usize| (n as f64 + 0.03 * signal(7 * n)) / RATE_HZ;
    let (hz, said) = rate("d.mf4", MdfChannel { sort: 2, ..time() }, &jitter);
    assert!((hz.unwrap() / RATE_HZ - 1.0).abs() < 1e-3 && !said.contains("gap"), "{hz:?}: {said}");
    let gap = |n: usize| (n + if n >= 120 { 50 } else { 0 }) as f64 / RATE_HZ;
    let (hz, said) = rate("e.mf4", MdfChannel { sort: 2, ..time() }, &gap);
    assert!((hz.unwrap() / RATE_HZ - 1.0).abs() < 1e-6, "{hz:?}");
    assert!(said.contains("a gap after row 120") && said.contains("missing samples: 50"), "{said}");
}

#[test]
fn issue_groups_of_mdf_have_masters_of_their_own() {
    let desk = Scratch::create("formats-mdf-groups");
    let group = |name| [MdfChannel { sort: 2, ..mdf_channel("time", 0) }, mdf_channel(name, 8)];
    let (acc, tacho) = (group("acc"), group("tacho"));
    let found = opened(
        &desk,
        "a.mf4",
        &mdf(&[
            (&acc, 16, 0, timed(|n| n as f64 / RATE_HZ)),
            (&tacho, 16, 0, timed(|n| 0.8 + n as f64 / 3200.0)),
        ]),
    );
    assert_eq!(found.channel("acc").unwrap().rate_hz, Some(RATE_HZ), "{:?}", found.notes);
    assert_eq!(found.channel("tacho").unwrap().rate_hz, Some(3200.0), "{:?}", found.notes);
    // Each begins when its own master says: the later one was laid at the start of the other.
    let start_s = |name: &str| found.channel(name).unwrap().start_s.unwrap_or(f64::NAN);
    assert!(start_s("acc").abs() < 1e-9 && (start_s("tacho") - 0.8).abs() < 1e-9, "{}", start_s("tacho"));
}

/// A recorder that was switched off has neither finished the head nor counted the records.
#[test]
fn issue_a_file_that_its_recorder_did_not_finish_is_read() {
    let desk = Scratch::create("formats-mdf-unfinished");
    let channels = [MdfChannel { sort: 2, ..mdf_channel("time", 0) }, mdf_channel("acc", 8)];
    let mut bytes = mdf(&[(&channels, 16, 0, timed(|n| n as f64 / RATE_HZ))]);
    bytes[..8].copy_from_slice(b"UnFinMF ");
    // The number of records, behind the six links of the group's block.
    let group = bytes.windows(4).position(|w| w == b"##CG").unwrap();
    bytes[group + 24 + 8 * 6 + 8..][..8].fill(0);
    let found = opened(&desk, "a.mf4", &bytes);
    let channel = found.channel("acc").unwrap();
    assert_eq!(channel.rate_hz, Some(RATE_HZ), "{:?}", found.notes);
    holds(channel, COUNT, signal);
    notes(&found, &["did not finish the file"]);
}
