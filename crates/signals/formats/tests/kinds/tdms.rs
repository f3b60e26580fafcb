//! TDMS of LabVIEW: scales, segments in which a channel pauses, and rates of channels, groups and files.

use stribeck_testing::{Scratch, assert_refused};

use crate::{COUNT, RATE_HZ, holds, notes, opened, signal};

/// A property of a TDMS object.
pub(crate) enum Is<'a> {
    Number(f64),
    Word(u32),
    Text(&'a str),
}

/// Index of the data of a TDMS object in a segment.
pub(crate) enum Index {
    /// A type and a number of values.
    Of(u32, u64),
    AsBefore,
    NoData,
}

fn tdms_text(text: &str) -> Vec<u8> {
    [&(text.len() as u32).to_le_bytes()[..], text.as_bytes()].concat()
}

pub(crate) fn tdms_object(path: &str, index: &Index, properties: &[(&str, Is<'_>)]) -> Vec<u8> {
    let mut out = tdms_text(path);
    match index {
        Index::Of(kind, count) => {
            out.extend([20_u32, *kind, 1].into_iter().flat_map(u32::to_le_bytes));
            out.extend(count.to_le_bytes());
        }
        Index::AsBefore => out.extend(0_u32.to_le_bytes()),
        Index::NoData => out.extend(u32::MAX.to_le_bytes()),
    }
    out.extend((properties.len() as u32).to_le_bytes());
    for (name, value) in properties {
        out.extend(tdms_text(name));
        match value {
            Is::Number(x) => {
                out.extend(10_u32.to_le_bytes());
                out.extend(x.to_le_bytes());
            }
            Is::Word(n) => out.extend([7, *n].into_iter().flat_map(u32::to_le_bytes)),
            Is::Text(text) => {
                out.extend(0x20_u32.to_le_bytes());
                out.extend(tdms_text(text));
            }
        }
    }
    out
}

pub(crate) fn tdms_segment(objects: &[Vec<u8>], is_new: bool, data: &[u8]) -> Vec<u8> {
    let metadata = [&(objects.len() as u32).to_le_bytes()[..], &objects.concat()].concat();
    let mut out = b"TDSm".to_vec();
    out.extend([if is_new { 14_u32 } else { 10 }, 4713].into_iter().flat_map(u32::to_le_bytes));
    out.extend([(metadata.len() + data.len()) as u64, metadata.len() as u64].map(u64::to_le_bytes).concat());
    out.extend(metadata);
    out.extend(data);
    out
}

pub(crate) const F64: u32 = 10;
const I16: u32 = 2;

#[test]
fn by_hand_a_channel_of_tdms_begins_at_its_offset() {
    let desk = Scratch::create("formats-tdms-offset");
    let data: Vec<u8> = (0..COUNT).flat_map(|n| signal(n).to_le_bytes()).collect();
    let begins = [("wf_increment", Is::Number(1.0 / RATE_HZ)), ("wf_start_offset", Is::Number(0.75))];
    let object = tdms_object("/'g'/'acc'", &Index::Of(F64, COUNT as u64), &begins);
    let found = opened(&desk, "a.tdms", &tdms_segment(&[object], true, &data));
    assert_eq!(found.channel("g/acc").unwrap().start_s, Some(0.75));
}

#[test]
fn issue_steps_of_tdms_in_milliseconds_are_no_seconds() {
    let desk = Scratch::create("formats-tdms-milliseconds");
    let data: Vec<u8> = (0..COUNT).flat_map(|n| signal(n).to_le_bytes()).collect();
    for (unit, second) in [("s", 1.0), ("ms", 1e3), ("us", 1e6), ("", 1.0)] {
        let step = [("wf_increment", Is::Number(second / RATE_HZ)), ("wf_xunit_string", Is::Text(unit))];
        let object = tdms_object("/'g'/'acc'", &Index::Of(F64, COUNT as u64), &step);
        let found = opened(&desk, "a.tdms", &tdms_segment(&[object], true, &data));
        assert_eq!(found.channel("g/acc").unwrap().rate_hz, Some(RATE_HZ), "{unit}");
    }
}

#[test]
fn issue_scales_of_tdms_are_applied_or_named() {
    let desk = Scratch::create("formats-tdms-scales");
    let counts: Vec<u8> = (0..COUNT).flat_map(|n| ((1000.0 * signal(n)) as i16).to_le_bytes()).collect();
    let stored = |n: usize| f64::from((1000.0 * signal(n)) as i16);
    let read = |scales: Vec<(&str, Is<'_>)>| {
        let mut properties =
            vec![("wf_increment", Is::Number(1.0 / RATE_HZ)), ("unit_string", Is::Text("g"))];
        properties.extend(scales);
        let object = tdms_object("/'g'/'acc'", &Index::Of(I16, COUNT as u64), &properties);
        let plain = tdms_object("/'g'/'plain'", &Index::Of(I16, COUNT as u64), &[]);
        opened(
            &desk,
            "a.tdms",
            &tdms_segment(&[object, plain], true, &[counts.clone(), counts.clone()].concat()),
        )
    };
    let linear = || {
        vec![
            ("NI_Number_Of_Scales", Is::Word(1)),
            ("NI_Scaling_Status", Is::Text("unscaled")),
            ("NI_Scale[0]_Scale_Type", Is::Text("Linear")),
            ("NI_Scale[0]_Linear_Slope", Is::Number(0.001)),
            ("NI_Scale[0]_Linear_Y_Intercept", Is::Number(0.5)),
            ("NI_Scale[0]_Linear_Input_Source", Is::Word(u32::MAX)),
        ]
    };
    let found = read(linear());
    let channel = found.channel("g/acc").unwrap();
    assert_eq!((channel.unit.as_deref(), channel.rate_hz), (Some("g"), Some(RATE_HZ)));
    holds(channel, COUNT, |n| 0.5 + 0.001 * stored(n));
    holds(found.channel("g/plain").unwrap(), COUNT, stored);

    // A polynomial of the result of the line.
    let mut chain = linear();
    chain[0].1 = Is::Word(2);
    chain.extend([
        ("NI_Scale[1]_Scale_Type", Is::Text("Polynomial")),
        ("NI_Scale[1]_Polynomial_Coefficients_Size", Is::Word(3)),
        ("NI_Scale[1]_Polynomial_Coefficients[0]", Is::Number(1.0)),
        ("NI_Scale[1]_Polynomial_Coefficients[1]", Is::Number(0.0)),
        ("NI_Scale[1]_Polynomial_Coefficients[2]", Is::Number(2.0)),
        ("NI_Scale[1]_Polynomial_Input_Source", Is::Word(0)),
    ]);
    holds(read(chain).channel("g/acc").unwrap(), COUNT, |n| 1.0 + 2.0 * (0.5 + 0.001 * stored(n)).powi(2));

    // A table of two pairs is a line between them.
    let table = vec![
        ("NI_Number_Of_Scales", Is::Word(1)),
        ("NI_Scale[0]_Scale_Type", Is::Text("Table")),
        ("NI_Scale[0]_Table_Pre_Scaled_Values_Size", Is::Word(2)),
        ("NI_Scale[0]_Table_Pre_Scaled_Values[0]", Is::Number(-2000.0)),
        ("NI_Scale[0]_Table_Pre_Scaled_Values[1]", Is::Number(2000.0)),
        ("NI_Scale[0]_Table_Scaled_Values_Size", Is::Word(2)),
        ("NI_Scale[0]_Table_Scaled_Values[0]", Is::Number(-4.0)),
        ("NI_Scale[0]_Table_Scaled_Values[1]", Is::Number(4.0)),
        ("NI_Scale[0]_Table_Input_Source", Is::Word(u32::MAX)),
    ];
    let found = read(table);
    let channel = found.channel("g/acc").unwrap();
    holds(channel, COUNT, |n| 0.002 * stored(n));

    let sensor = vec![
        ("NI_Number_Of_Scales", Is::Word(1)),
        ("NI_Scale[0]_Scale_Type", Is::Text("Thermocouple")),
        ("NI_Scale[0]_Thermocouple_Thermocouple_Type", Is::Word(10073)),
    ];
    let found = read(sensor);
    assert_refused(found.channel("g/acc"), "has no channel `g/acc`");
    notes(&found, &["`g/acc` is left out", "Thermocouple"]);
    holds(found.channel("g/plain").unwrap(), COUNT, stored);
}

#[test]
fn issue_tdms_objects_without_data_take_none() {
    let desk = Scratch::create("formats-tdms-objects");
    let part =
        |from: usize| -> Vec<u8> { (from..from + 100).flat_map(|n| signal(n).to_le_bytes()).collect() };
    let warm = 70.0_f64.to_le_bytes().repeat(100);
    let of = |name: &str, index| tdms_object(&format!("/'g'/'{name}'"), &index, &[]);
    let rate = [("wf_increment", Is::Number(1.0 / RATE_HZ))];
    let acc = tdms_object("/'g'/'acc'", &Index::Of(F64, 100), &rate);
    let bytes = [
        tdms_segment(&[acc, of("temp", Index::Of(F64, 100))], true, &[part(0), warm.clone()].concat()),
        // `temp` pauses for a segment, and comes back.
        tdms_segment(&[of("temp", Index::NoData)], false, &part(100)),
        tdms_segment(&[of("temp", Index::AsBefore)], false, &[part(200), warm].concat()),
    ];
    let found = opened(&desk, "a.tdms", &bytes.concat());
    holds(found.channel("g/acc").unwrap(), 300, signal);
    holds(found.channel("g/temp").unwrap(), 200, |_| 70.0);
    assert_eq!(found.channel("g/acc").unwrap().rate_hz, Some(RATE_HZ));
}

#[test]
fn issue_channels_of_tdms_have_rates_of_their_own() {
    let desk = Scratch::create("formats-tdms-rates");
    let of = |name: &str, hz: f64| {
        tdms_object(name, &Index::Of(F64, COUNT as u64), &[("wf_increment", Is::Number(1.0 / hz))])
    };
    let data: Vec<u8> = (0..2 * COUNT).flat_map(|n| signal(n % COUNT).to_le_bytes()).collect();
    let objects = [of("/'g'/'acc'", RATE_HZ), of("/'g'/'tacho'", 3200.0)];
    let found = opened(&desk, "a.tdms", &tdms_segment(&objects, true, &data));
    let rates: Vec<_> = found.channels.iter().map(|c| c.rate_hz).collect();
    assert_eq!(rates, [Some(RATE_HZ), Some(3200.0)]);
}

#[test]
fn issue_properties_and_channels_of_tdms_say_the_rate() {
    let desk = Scratch::create("formats-tdms-rates");
    let data: Vec<u8> = (0..COUNT).flat_map(|n| signal(n).to_le_bytes()).collect();
    let of = |index| tdms_object("/'g'/'acc'", &index, &[]);
    for (path, name, value) in [
        ("/'g'", "SamplingRate", RATE_HZ),
        ("/", "Sampling Rate", RATE_HZ),
        ("/", "sample_interval", 1.0 / RATE_HZ),
    ] {
        let parent = tdms_object(path, &Index::NoData, &[(name, Is::Number(value))]);
        let segment = tdms_segment(&[parent, of(Index::Of(F64, COUNT as u64))], true, &data);
        let found = opened(&desk, "a.tdms", &segment);
        assert_eq!(found.channel("g/acc").unwrap().rate_hz, Some(RATE_HZ), "{path} {name}");
    }
    // A channel of times in the group, whose path is no unit.
    for (name, second) in [("Time", 1.0), ("t [ms]", 1e-3)] {
        let times: Vec<u8> = (0..COUNT).flat_map(|n| (n as f64 / RATE_HZ / second).to_le_bytes()).collect();
        let time = tdms_object(&format!("/'g'/'{name}'"), &Index::Of(F64, COUNT as u64), &[]);
        let segment =
            tdms_segment(&[time, of(Index::Of(F64, COUNT as u64))], true, &[times, data.clone()].concat());
        let found = opened(&desk, "a.tdms", &segment);
        let hz = found.channel("g/acc").unwrap().rate_hz.unwrap_or_else(|| panic!("{:?}", found.notes));
        assert!((hz / RATE_HZ - 1.0).abs() < 1e-6, "{name}: {hz}");
    }
}
