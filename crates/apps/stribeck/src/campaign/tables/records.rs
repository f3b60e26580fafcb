//! The records of a data set: a row a record, in single precision, in parts of equally many rows.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use stribeck_analysis::runs::OneOfMany;
use stribeck_formats::parquet::{Column, Values, Writer};
use stribeck_scene::scene::Scene;
use stribeck_store::run_dir::RunDir;
use stribeck_store::trace::TraceFile;

use super::{RECORDS, replace};

/// A record as the data set has it.
struct Record<'a> {
    one: &'a OneOfMany,
    /// Acceleration [m/s²].
    samples: Vec<f32>,
    rate_hz: f64,
    /// Times of the pulses of a tachometer from the first sample on, one a turn of the shaft [s].
    turns_s: Vec<f32>,
}

/// Writes the parts and returns their names. What an earlier text of the campaign left is removed.
pub(super) fn write(
    folder: &Path,
    rows: &[OneOfMany],
    parts: usize,
    notes: &[(String, String)],
) -> Result<Vec<String>> {
    let complete: Vec<&OneOfMany> =
        rows.iter().filter(|one| one.is_complete() && machine(folder, one).is_some()).collect();
    let within = folder.join(RECORDS);
    std::fs::create_dir_all(&within)?;
    let names: Vec<String> =
        (0..parts.min(complete.len())).map(|part| format!("{RECORDS}/part-{part:03}.parquet")).collect();
    for entry in std::fs::read_dir(&within)?.flatten() {
        let path = entry.path();
        let is_ours = path.extension().is_some_and(|end| end == "parquet");
        if is_ours && !names.iter().any(|name| folder.join(name) == path) {
            std::fs::remove_file(path)?;
        }
    }
    for (part, name) in names.iter().enumerate() {
        let [first, last] = [part, part + 1].map(|part| part * complete.len() / names.len());
        replace(&folder.join(name), |path| {
            let mut writer = Writer::create(path, &columns(&[]), notes)?;
            for group in complete[first..last].chunks(GROUP) {
                let records = group.iter().map(|one| read(folder, one)).collect::<Result<Vec<_>>>()?;
                writer.add(columns(&records))?;
            }
            Ok(writer.finish()?)
        })?;
    }
    Ok(names)
}

/// Records that are in memory at a time.
const GROUP: usize = 64;

/// The record of a run's machine, where there is one.
fn machine(folder: &Path, one: &OneOfMany) -> Option<PathBuf> {
    let file = RunDir::open(folder.join(one.folder.as_ref()?)).ok()?.machine();
    file.exists().then_some(file)
}

fn read<'a>(folder: &Path, one: &'a OneOfMany) -> Result<Record<'a>> {
    let file = machine(folder, one).context("the record of a run is gone")?;
    let trace = TraceFile::open(&file)?;
    let times = trace.channel("time_s")?.unwrap_or_default();
    let samples = trace.channel(stribeck_analysis::machine::CHANNEL)?.unwrap_or_default();
    let scene = one.scene.as_ref().context("a run has its scene")?;
    let (first, last) = (times.first().copied().unwrap_or(0.0), times.last().copied().unwrap_or(0.0));
    Ok(Record {
        one,
        // They have at most the 24 bits that these hold.
        samples: samples.into_iter().map(|x| x as f32).collect(),
        rate_hz: scene.housing.machine().map_or(0.0, |machine| machine.sensor.rate_hz),
        turns_s: turns(scene, first, last).into_iter().map(|at| (at - first) as f32).collect(),
    })
}

/// When the shaft has turned by whole turns, between two times [s].
fn turns(scene: &Scene, first: f64, last: f64) -> Vec<f64> {
    let duty = scene.duty();
    let turned = |at: f64| (duty.shaft_rad(at) / std::f64::consts::TAU).abs();
    // A pulse lies in every stretch in which the count of turns grows; it is found there by halving.
    let mut pulses = Vec::new();
    let mut next = turned(first).ceil();
    let mut from = first;
    while turned(last) >= next {
        let (mut low, mut high) = (from, last);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if turned(middle) >= next { high = middle } else { low = middle }
        }
        pulses.push(high);
        (from, next) = (high, next + 1.0);
    }
    pulses
}

fn columns(records: &[Record<'_>]) -> Vec<Column> {
    let column = |name: &str, values| Column { name: name.to_owned(), values };
    let truth = |of: &dyn Fn(&stribeck_analysis::runs::Truth) -> String| {
        Values::Text(records.iter().map(|record| record.one.row.truth.as_ref().map(of)).collect())
    };
    vec![
        column("run", Values::Count(records.iter().map(|r| i64::try_from(r.one.row.run).ok()).collect())),
        column("split", Values::Text(records.iter().map(|r| Some(r.one.row.split.clone())).collect())),
        column("bearing", truth(&|truth| truth.bearing.clone())),
        column("fault_location", truth(&|truth| truth.fault_location.clone())),
        column("rate_hz", Values::Number(records.iter().map(|r| Some(r.rate_hz)).collect())),
        column("a_m_s2", Values::Series(records.iter().map(|r| r.samples.clone()).collect())),
        column("turns_s", Values::Series(records.iter().map(|r| r.turns_s.clone()).collect())),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 1200 rpm are 20 turns a second; the pulses of a ramp come at the roots of its quadratic.
    #[test]
    fn by_hand_a_pulse_stands_at_every_turn() {
        let steady = Scene::singh2014().with_overrides(&["operation.speed_rpm=1200"]).expect("a scene");
        let pulses = turns(&steady, 0.051, 0.249);
        assert_eq!(pulses.len(), 3);
        assert!(pulses.iter().zip([0.1, 0.15, 0.2]).all(|(a, b)| (a - b).abs() < 1e-9), "{pulses:?}");
        let ramp = ["operation.speed_rpm=0", "operation.speed_profile=ramp(to_ms: 1000.0, to: 600.0)"];
        let ramp = Scene::singh2014().with_overrides(&ramp).expect("a scene");
        // 10 t²/2 turns.
        let pulses = turns(&ramp, 0.0, 0.9);
        assert!((pulses[1] - 0.2_f64.sqrt()).abs() < 1e-9 && pulses.len() == 5, "{pulses:?}");
    }
}
