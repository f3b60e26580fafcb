//! Files of other programs, read by those programs and by us: equal samples, rates and rms, or a refusal with
//! its reason.

use std::collections::BTreeSet;
use std::process::Command;

use stribeck_formats::Recording;
use stribeck_testing::Scratch;
use stribeck_testing::peer::python_with;

/// Largest difference of two rms, over the rms: soundfile scales whole numbers in single precision.
const SAME_RMS: f64 = 1e-6;
/// Largest difference of two rates, over the rate: times in texts have seven digits.
const SAME_RATE: f64 = 1e-4;

/// How one format compares.
#[derive(Default)]
struct Tally {
    equal: usize,
    refused: Vec<String>,
    different: Vec<String>,
}

/// numpy 2.4.6, scipy 1.17.1, h5py 3.16.0, npTDMS 1.13.0, asammdf 8.8.28, pyarrow 26.0.1, pandas 3.1.1,
/// soundfile 0.14.0 and pyuff 2.5.8, where the interpreter in `STRIBECK_PYTHON` (or python3) has them.
#[test]
fn peer_readers_of_each_format_read_the_same() {
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../fixtures/peers/signals_by_format.py");
    let desk = Scratch::create("formats-peers");
    let mut table = Vec::new();
    for (kind, modules) in [
        ("npy", &["numpy"][..]),
        ("mat", &["scipy.io"]),
        ("h5", &["h5py"]),
        ("tdms", &["nptdms"]),
        ("mf4", &["asammdf"]),
        ("parquet", &["pyarrow", "pandas"]),
        ("csv", &["pandas"]),
        ("sound", &["soundfile"]),
        ("uff", &["pyuff"]),
    ] {
        let Some(python) = python_with(modules) else { continue };
        let run = Command::new(python).args([script, desk.path().to_str().unwrap(), kind]).output().unwrap();
        assert!(run.status.success(), "{kind}: {}", String::from_utf8_lossy(&run.stderr));
        let said = String::from_utf8_lossy(&run.stdout).into_owned();
        let mut tally = Tally::default();
        for line in said.lines().filter(|line| line.matches('|').count() == 4) {
            compare(&desk, line, &mut tally);
        }
        assert!(tally.equal > 0, "{kind}: {said}");
        table.push((kind, tally));
    }
    println!("| format | channels equal | refused with a reason | different |\n|---|---|---|---|");
    for (kind, of) in &table {
        println!("| {kind} | {} | {} | {} |", of.equal, of.refused.len(), of.different.len());
    }
    for (kind, of) in &table {
        of.refused.iter().for_each(|what| println!("{kind}, refused: {what}"));
        of.different.iter().for_each(|what| println!("{kind}, different: {what}"));
    }
    let different: Vec<_> = table.iter().flat_map(|(_, of)| &of.different).collect();
    assert!(different.is_empty(), "{different:#?}");
    // What was read once stays read: these alone are refused.
    let refused: BTreeSet<&str> =
        table.iter().flat_map(|(_, of)| &of.refused).filter_map(|what| what.split(':').next()).collect();
    let known = BTreeSet::from(REFUSED);
    assert!(refused.is_subset(&known), "{refused:?}");
}

/// Channels that the others read and we do not.
const REFUSED: [&str; 1] = [
    // A sensor's law, not a scale.
    "scales.tdms g/rtd",
];

/// Compares one channel with what its program reads: FILE|CHANNEL|SAMPLES|RATE|RMS.
fn compare(desk: &Scratch, line: &str, tally: &mut Tally) {
    let [file, name, count, rate, rms] = line.split('|').collect::<Vec<_>>()[..] else { panic!("{line}") };
    let found = match Recording::open(desk.join(file)) {
        Ok(found) => found,
        Err(why) => return tally.refused.push(format!("{file}: {why}")),
    };
    let Some(channel) = found.channels.iter().find(|c| c.name == name) else {
        let noted = found.notes.iter().find(|note| note.contains(&format!("`{name}`")));
        match noted {
            Some(note) => tally.refused.push(format!("{file} {name}: {note}")),
            None => {
                tally.different.push(format!("{file}: no `{name}` in {}; {:?}", found.names(), found.notes))
            }
        }
        return;
    };
    let samples = match channel.read() {
        Ok(samples) => samples,
        Err(why) => return tally.refused.push(format!("{file} {name}: {why}")),
    };
    let numbers: Vec<f64> = samples.iter().copied().filter(|x| x.is_finite()).collect();
    let ours = (numbers.iter().map(|x| x * x).sum::<f64>() / numbers.len() as f64).sqrt();
    let theirs: f64 = rms.parse().unwrap();
    let same_rate = match (rate.parse::<f64>(), channel.rate_hz) {
        (Ok(theirs), Some(ours)) => (ours / theirs - 1.0).abs() <= SAME_RATE,
        // A time that counts itself says no rate.
        (Err(_), None) => true,
        (Err(_), Some(_)) => channel.is_time,
        (Ok(_), None) => false,
    };
    let same = samples.len().to_string() == count && (ours - theirs).abs() <= SAME_RMS * theirs && same_rate;
    if same {
        tally.equal += 1;
    } else {
        let rate_hz = channel.rate_hz;
        tally.different.push(format!(
            "{file} {name}: {count} samples, {rate} Hz, rms {theirs}; ours {} samples, {rate_hz:?} Hz, rms \
             {ours}",
            samples.len()
        ));
    }
}
