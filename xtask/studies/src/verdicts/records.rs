//! The records of the study, and the known state of each: `data/verdicts.ron` lists them.

use std::path::Path;

use anyhow::{Context, Result, ensure};
use serde::Deserialize;
use stribeck_diagnosis::Defect;
use stribeck_formats::{Channel, Recording};
use stribeck_scene::catalogue;
use stribeck_theory::catalogue::CatalogueBearing;

/// Half of the records: thresholds are chosen on one, and the other is quoted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Part {
    /// Bearings 6205, of both rigs that have one, and half of the bearings of Paderborn.
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
    pub(super) set: String,
    pub(super) part: Part,
    /// The defect; `None` for a healthy bearing.
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

/// The list: properties that the records of a set share, and those of each.
#[derive(Debug, Deserialize)]
struct List {
    sets: Vec<Set>,
    records: Vec<Entry>,
    series: Vec<SeriesEntry>,
}

#[derive(Debug, Deserialize)]
struct Set {
    name: String,
    chosen: bool,
    bearing: String,
    rate_hz: f64,
    load_n: Option<(f64, f64)>,
}

/// File, end of the channel's name, name, set, defect, whether the other end of the shaft is damaged, speed,
/// length of the defect.
type Entry = (String, String, String, usize, Option<String>, bool, Option<f64>, Option<f64>);

/// Beginning of the files of a series of records, speed [1/min], whether the bearing is damaged.
type SeriesEntry = (String, f64, bool);

/// Records of a tenth of a second of one bearing, one behind the other.
#[derive(Debug, Clone)]
pub(super) struct ShortRecords {
    /// Beginning of their files.
    pub(super) name: String,
    pub(super) speed_rpm: f64,
    pub(super) is_damaged: bool,
    pub(super) records: Vec<Vec<f64>>,
}

/// FEMTO: bearing, sample rate [Hz] and channel of the series.
pub(super) const SHORT_BEARING: &str = "elements=13, diameter_mm=3.5, pitch_mm=25.6";
pub(super) const SHORT_RATE_HZ: f64 = 25_600.0;
const SHORT_CHANNEL: &str = "h";
const SHORT_RECORDS: usize = 8;

pub(super) const SETS: [&str; 8] = [
    "HIT-SM, 6205",
    "CWRU drive end, 6205",
    "CWRU fan end, 6203",
    "UESTC, UER204",
    "MFPT",
    "Paderborn K001, KA04, KI14, 6203",
    "Paderborn K003, KA30, KI18, 6203",
    "IMS, ZA-2115",
];
pub(super) const UESTC: &str = SETS[3];

fn list() -> Result<List> {
    let path = crate::package().join("data/verdicts.ron");
    let text = std::fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
    ron::from_str(&text).with_context(|| path.display().to_string())
}

/// All series of the list that are below `folder`.
pub(super) fn read_series(folder: &Path) -> Result<Vec<ShortRecords>> {
    let mut series = Vec::new();
    for (name, speed_rpm, is_damaged) in list()?.series {
        let files = (1..=SHORT_RECORDS).map(|n| folder.join(format!("{name}_{n}.npz")));
        let records = files.filter(|file| file.exists()).map(|file| {
            let recording = Recording::open(&file)?;
            let channel = recording.channels.iter().find(|c| c.name == SHORT_CHANNEL);
            Ok(channel.with_context(|| format!("{}: no such channel", file.display()))?.read()?)
        });
        let records = records.collect::<Result<Vec<_>>>()?;
        if !records.is_empty() {
            series.push(ShortRecords { name, speed_rpm, is_damaged, records });
        }
    }
    Ok(series)
}

/// All records of the list that are below `folder`.
pub(super) fn read(folder: &Path) -> Result<Vec<Labelled>> {
    let list = list()?;
    let mut records = Vec::new();
    for entry in &list.records {
        let file = folder.join(&entry.0);
        if file.exists() {
            let set = list.sets.get(entry.3).context("a record of no set")?;
            records.push(labelled(&file, entry, set).with_context(|| file.display().to_string())?);
        }
    }
    ensure!(
        !records.is_empty(),
        "`{}` holds no record: give a folder with `hit-sm`, `cwru`, `cwru-more`, `uestc`, `mfpt`, `paderborn` or `ims` in it",
        folder.display()
    );
    Ok(records)
}

fn labelled(
    file: &Path,
    (_, channel, name, _, defect, beside, rpm, length_mm): &Entry,
    set: &Set,
) -> Result<Labelled> {
    let recording = Recording::open(file)?;
    let all = &recording.channels;
    let chosen: Option<&Channel> = if channel.is_empty() {
        all.iter().max_by_key(|c| c.len)
    } else {
        all.iter().find(|c| c.name.ends_with(channel.as_str()))
    };
    // Files with channels of both ends hold their speed, most of them.
    let held = all.iter().find(|c| !channel.is_empty() && c.len == 1 && c.name.contains("RPM"));
    let held = held.map(Channel::read).transpose()?.and_then(|rpm| rpm.first().copied());
    let truth =
        defect.as_ref().map(|name| Defect::ALL.into_iter().find(|d| d.name() == name).context("no defect"));
    Ok(Labelled {
        name: name.clone(),
        set: set.name.clone(),
        part: if set.chosen { Part::Chosen } else { Part::Quoted },
        truth: truth.transpose()?,
        beside: *beside,
        rate_hz: set.rate_hz,
        speed_rpm: held.or(*rpm).context("neither the list nor the file gives a speed")?,
        bearing: catalogue::parse(&set.bearing).map_err(anyhow::Error::msg)?,
        length_mm: *length_mm,
        load_n: set.load_n,
        samples: chosen.context("it has no such channel")?.read()?,
    })
}
