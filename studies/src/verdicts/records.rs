//! The records of the study: file names of four public collections, and the known state of each.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use stribeck_analysis::measured::Defect;
use stribeck_formats::{Channel, Recording};
use stribeck_scene::catalogue;
use stribeck_theory::catalogue::CatalogueBearing;

/// Half of the records: thresholds are chosen on one, and the other is quoted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Part {
    /// Bearings 6205, of both rigs that have one.
    Chosen,
    /// All other bearings and rigs.
    Quoted,
}

/// One channel of a record, with its label.
#[derive(Debug, Clone)]
pub(super) struct Labelled {
    /// File and channel.
    pub(super) name: String,
    /// Rig and bearing.
    pub(super) set: &'static str,
    pub(super) part: Part,
    /// The defect; `None` for a sound bearing.
    pub(super) truth: Option<Defect>,
    /// Sound, and beside a damaged bearing at the other end of the shaft.
    pub(super) beside: bool,
    pub(super) rate_hz: f64,
    pub(super) speed_rpm: f64,
    pub(super) bearing: CatalogueBearing,
    /// Length of the defect along the raceway [mm].
    pub(super) length_mm: Option<f64>,
    /// Radial load, as it is taken to be [N].
    pub(super) load_n: Option<(f64, f64)>,
    pub(super) samples: Vec<f64>,
}

/// Names of the sets.
pub(super) const HIT: &str = "HIT-SM, 6205";
pub(super) const DRIVE_END: &str = "CWRU drive end, 6205";
pub(super) const FAN_END: &str = "CWRU fan end, 6203";
pub(super) const UESTC: &str = "UESTC, UER204";
pub(super) const MFPT: &str = "MFPT";
pub(super) const SETS: [&str; 5] = [HIT, DRIVE_END, FAN_END, UESTC, MFPT];

/// Speed of the CWRU motor at 0, 1, 2 and 3 hp, for files that do not hold it [1/min].
const CWRU_RPM: [f64; 4] = [1797.0, 1772.0, 1750.0, 1730.0];
/// Files of CWRU that are named by their number: defects of the drive-end bearing and their size [mm].
const NUMBERED: [(&str, Option<Defect>, Option<f64>); 5] = [
    ("97", None, None),
    ("106", Some(Defect::Bpfi), Some(0.1778)),
    ("119", Some(Defect::Bsf), None),
    ("131", Some(Defect::Bpfo), Some(0.1778)),
    ("210", Some(Defect::Bpfi), Some(0.5334)),
];
/// The load of HIT-SM, which its authors do not give and the lengths of the outer raceways suit [N].
pub(super) const HIT_LOAD_N: (f64, f64) = (50.0, 150.0);
/// Raceway diameters of a 6205 [mm]: outer, inner.
const RACEWAYS_6205: [f64; 2] = [46.98, 31.10];

/// All records below `folder`, in the order of their names.
///
/// # Errors
/// When a file cannot be read, or none is there.
pub(super) fn read(folder: &Path) -> Result<Vec<Labelled>> {
    let mut records = Vec::new();
    for (within, of) in [
        ("hit-sm", hit as Reader),
        ("cwru", cwru),
        ("cwru-more", cwru_more),
        ("uestc", uestc),
        ("mfpt", mfpt),
    ] {
        for file in files(&folder.join(within))? {
            let stem = file.file_stem().map_or_else(String::new, |s| s.to_string_lossy().into_owned());
            let recording = Recording::open(&file).with_context(|| file.display().to_string())?;
            let found = of(&stem, &recording).with_context(|| file.display().to_string())?;
            records.extend(found);
        }
    }
    ensure!(
        !records.is_empty(),
        "`{}` holds no record: give a folder with `hit-sm`, `cwru`, `cwru-more`, `uestc` or `mfpt` in it",
        folder.display()
    );
    Ok(records)
}

type Reader = fn(&str, &Recording) -> Result<Vec<Labelled>>;

/// The MATLAB files of a folder; none where there is no folder.
fn files(folder: &Path) -> Result<Vec<PathBuf>> {
    if !folder.is_dir() {
        return Ok(Vec::new());
    }
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        if path.extension().is_some_and(|e| e == "mat") {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}

/// Properties that the records of a set share.
fn labelled(
    name: String,
    set: &'static str,
    truth: Option<Defect>,
    rate_hz: f64,
    speed_rpm: f64,
    channel: &Channel,
) -> Result<Labelled> {
    let bearing = match set {
        FAN_END => "6203",
        UESTC => "elements=8, diameter_mm=7.938, pitch_mm=33.5",
        MFPT => "elements=8, diameter_mm=5.969, pitch_mm=31.623",
        _ => "6205",
    };
    Ok(Labelled {
        name,
        set,
        part: if matches!(set, HIT | DRIVE_END) { Part::Chosen } else { Part::Quoted },
        truth,
        beside: false,
        rate_hz,
        speed_rpm,
        bearing: catalogue::parse(bearing).map_err(anyhow::Error::msg)?,
        length_mm: None,
        load_n: (set == HIT).then_some(HIT_LOAD_N),
        samples: channel.read()?,
    })
}

/// The longest channel.
fn longest(recording: &Recording) -> Result<&Channel> {
    recording.channels.iter().max_by_key(|c| c.len).context("it holds no channel")
}

/// A number in a file name.
fn number(text: &str) -> Result<f64> {
    text.parse().with_context(|| format!("`{text}` in the file's name is no number"))
}

/// `OR5_900`: outer raceway, 5° of arc, 900 rpm; the shaft of the sound records turns at 1204 rpm.
fn hit(stem: &str, recording: &Recording) -> Result<Vec<Labelled>> {
    let (what, rpm) = stem.split_once('_').context("its name has no speed")?;
    let raceway = ["OR", "IR"].iter().position(|r| what.starts_with(r));
    let truth = raceway.map(|at| [Defect::Bpfo, Defect::Bpfi][at]);
    let rpm = if truth.is_some() { number(rpm)? } else { 1204.0 };
    let mut record = labelled(stem.to_owned(), HIT, truth, 51_200.0, rpm, longest(recording)?)?;
    if let Some(at) = raceway {
        record.length_mm = Some(number(&what[2..])? / 360.0 * std::f64::consts::PI * RACEWAYS_6205[at]);
    }
    Ok(vec![record])
}

/// The speed that a file of CWRU holds, or that of its load.
fn cwru_rpm(stem: &str, recording: &Recording) -> Result<f64> {
    let held = recording.channels.iter().find(|c| c.len == 1 && c.name.contains("RPM"));
    if let Some(channel) = held {
        return channel.read()?.first().copied().context("its RPM is empty");
    }
    let load = stem.rsplit('_').next().and_then(|load| load.parse::<usize>().ok());
    load.and_then(|load| CWRU_RPM.get(load))
        .copied()
        .context("neither its name nor its contents give a speed")
}

/// Both ends of a CWRU record whose defect, if any, is at `end`.
fn both_ends(
    stem: &str,
    recording: &Recording,
    end: Option<&'static str>,
    truth: Option<Defect>,
    length_mm: Option<f64>,
) -> Result<Vec<Labelled>> {
    let rpm = cwru_rpm(stem, recording)?;
    let mut both = Vec::new();
    for (of, set) in [("DE", DRIVE_END), ("FE", FAN_END)] {
        let Some(channel) = recording.channels.iter().find(|c| c.name.ends_with(&format!("{of}_time")))
        else {
            continue;
        };
        let here = end == Some(of);
        let own = truth.filter(|_| here);
        let mut record = labelled(format!("{stem} {of}"), set, own, 12_000.0, rpm, channel)?;
        record.beside = truth.is_some() && !here;
        record.length_mm = length_mm.filter(|_| here && truth != Some(Defect::Bsf));
        both.push(record);
    }
    Ok(both)
}

fn cwru(stem: &str, recording: &Recording) -> Result<Vec<Labelled>> {
    let digits: String = stem.chars().take_while(char::is_ascii_digit).collect();
    let of = NUMBERED.iter().find(|(number, ..)| *number == digits);
    let (_, truth, length_mm) = of.context("its number is not known")?;
    both_ends(stem, recording, truth.map(|_| "DE"), *truth, *length_mm)
}

/// `FE-OR-007-at6-294_0`: end, element, diameter in thousandths of an inch, place, number, load.
fn cwru_more(stem: &str, recording: &Recording) -> Result<Vec<Labelled>> {
    let words: Vec<&str> = stem.split('-').collect();
    let end = if words.first() == Some(&"FE") { "FE" } else { "DE" };
    let truth = match words.get(1).copied() {
        Some("B") => Defect::Bsf,
        Some("IR") => Defect::Bpfi,
        Some("OR") => Defect::Bpfo,
        _ => anyhow::bail!("its name does not say which part is damaged"),
    };
    let mils = number(words.get(2).copied().unwrap_or_default())?;
    both_ends(stem, recording, Some(end), Some(truth), Some(25.4e-3 * mils))
}

/// `O_800_2`: outer raceway, 800 rpm nominal, second record.
fn uestc(stem: &str, recording: &Recording) -> Result<Vec<Labelled>> {
    let words: Vec<&str> = stem.split('_').collect();
    let truth = match words.first().copied() {
        Some("O") => Some(Defect::Bpfo),
        Some("I") => Some(Defect::Bpfi),
        Some("B") => Some(Defect::Bsf),
        _ => None,
    };
    let rpm = number(words.get(1).copied().unwrap_or_default())?;
    let mut record = labelled(stem.to_owned(), UESTC, truth, 20_000.0, rpm, longest(recording)?)?;
    record.length_mm = (truth == Some(Defect::Bpfo)).then_some(0.55);
    Ok(vec![record])
}

fn mfpt(stem: &str, recording: &Recording) -> Result<Vec<Labelled>> {
    let truth = if stem.starts_with("Inner") {
        Some(Defect::Bpfi)
    } else if stem.starts_with("Outer") {
        Some(Defect::Bpfo)
    } else {
        None
    };
    let channel = longest(recording)?;
    Ok(vec![labelled(stem.to_owned(), MFPT, truth, 48_828.0, 1500.0, channel)?])
}
