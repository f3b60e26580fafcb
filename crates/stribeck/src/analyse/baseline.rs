//! A reference record of the sound machine, drawn behind another one.

use std::path::Path;

use anyhow::{Context, Result, ensure};
use stribeck_diagnosis::Analysis;
use stribeck_report::Baseline;

use super::{Options, examine};
use crate::place::{Place, shown};

/// Reads and analyses the reference record; remarks on both go to the notes of the other one.
pub(super) fn of(file: &Path, options: &Options, analysis: &mut Analysis, place: &Place) -> Result<Baseline> {
    let mut reading = options.reading.clone();
    if options.baseline_rpm.is_some() {
        (reading.speed_rpm, reading.tacho) = (options.baseline_rpm, None);
    }
    let name = file.file_name().map_or_else(|| "record".into(), |n| n.to_string_lossy()).into_owned();
    let sound = examine(file, &reading, place).with_context(|| format!("--baseline {}", shown(file)))?;
    let (here, there) = (&analysis.findings, &sound.findings);
    ensure!(
        here.unit == there.unit,
        "--baseline {}: its samples are in {}, those of the record in {}: give both the same `--unit`",
        shown(file),
        there.unit.as_deref().unwrap_or("no unit"),
        here.unit.as_deref().unwrap_or("no unit")
    );
    let mut notes = Vec::new();
    let claimed: Vec<&str> = there.families.iter().filter(|f| f.claimed).map(|f| f.name.name()).collect();
    if !claimed.is_empty() {
        notes.push(format!(
            "the baseline `{name}` is no sound machine by its own verdict: it shows {}",
            claimed.join(", ")
        ));
    }
    if here.rate_hz != there.rate_hz {
        notes.push(format!(
            "the baseline was sampled at {} Hz, the record at {} Hz: levels of the whole signal compare only \
             below half of the lower rate",
            there.rate_hz, here.rate_hz
        ));
    }
    let speeds = here.speed_rpm.zip(there.speed_rpm);
    if let Some((a, b)) = speeds.filter(|(a, b)| (a / b - 1.0).abs() > SAME_SPEED) {
        notes.push(format!(
            "the baseline turned at {b:.1} rpm, the record at {a:.1}: its envelope spectra are drawn at the \
             record's speed, and its levels belong to its own"
        ));
    }
    analysis.findings.notes.extend(notes);
    Ok(Baseline { name, analysis: sound })
}

/// Speeds that differ by less than this part leave levels alone.
const SAME_SPEED: f64 = 0.01;
