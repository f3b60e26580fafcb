//! Records of the healthy machine: the first is drawn behind another one, and all calibrate its verdict.

use std::path::PathBuf;

use anyhow::{Context, Result, ensure};
use stribeck_diagnosis::Analysis;
use stribeck_report::Baseline;

use super::{Options, examine};
use crate::place::{Place, shown};

/// Reads and analyses the records of the healthy machine.
pub(super) fn read(options: &Options, place: &Place) -> Result<Vec<Baseline>> {
    let mut reading = options.reading.clone();
    if options.baseline_rpm.is_some() {
        (reading.speed_rpm, reading.tacho) = (options.baseline_rpm, None);
    }
    let of = |file: &PathBuf| {
        let analysis =
            examine(file, &reading, place).with_context(|| format!("--baseline {}", shown(file)))?;
        let name = file.file_name().map_or_else(|| "record".into(), |n| n.to_string_lossy()).into_owned();
        Ok(Baseline { name, analysis })
    };
    options.baseline.iter().map(of).collect()
}

/// The scores by which they calibrate the verdict on another record [dB].
pub(super) fn scores(sound: &[Baseline]) -> Vec<f64> {
    let healthy = sound.iter().filter(|baseline| claim(&baseline.analysis).is_none());
    healthy.filter_map(|baseline| baseline.analysis.findings.score_db).collect()
}

/// Combs of healthy records that are no family's [Hz]: the machine has them.
pub(super) fn shared_hz(sound: &[Baseline]) -> Vec<f64> {
    let healthy = sound.iter().filter(|baseline| claim(&baseline.analysis).is_none());
    healthy.filter_map(|baseline| Some(baseline.analysis.findings.unexplained.as_ref()?.hz)).collect()
}

/// The defect that a record of the healthy machine claims itself, in words.
pub(super) fn claim(analysis: &Analysis) -> Option<String> {
    let claimed = analysis.findings.families.iter().filter(|f| f.claimed).map(|f| f.name.name());
    let names: Vec<&str> = claimed.collect();
    (!names.is_empty()).then(|| format!("by its own verdict it has a defect, {}", names.join(", ")))
}

/// Notes on all of them that claim a defect themselves, and are left out.
fn left_out(sound: &[Baseline]) -> impl Iterator<Item = String> {
    sound.iter().filter_map(|baseline| {
        Some(format!("the baseline `{}` is left out: {}", baseline.name, claim(&baseline.analysis)?))
    })
}

/// Remarks on a record and the healthy ones behind it, of which the first is drawn, in its notes.
pub(super) fn beside(analysis: &mut Analysis, all: &[Baseline]) -> Result<()> {
    let Some(sound) = all.first() else { return Ok(()) };
    let name = &sound.name;
    let sound = &sound.analysis;
    let (here, there) = (&analysis.findings, &sound.findings);
    ensure!(
        here.unit == there.unit,
        "--baseline {name}: its samples are in {}, those of the record in {}: give both the same `--unit`",
        there.unit.as_deref().unwrap_or("no unit"),
        here.unit.as_deref().unwrap_or("no unit")
    );
    let mut notes: Vec<String> = left_out(all).collect();
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
    Ok(())
}

/// Speeds that differ by less than this part leave levels alone.
const SAME_SPEED: f64 = 0.01;
