//! The record of a machine's sensor, in the folder of its run.

#[cfg(feature = "full")]
use std::path::Path;

use anyhow::{Context, Result};
#[cfg(feature = "full")]
use stribeck_analysis::machine::Force;
use stribeck_analysis::machine::{self, CHANNEL, MachineRecord};
#[cfg(feature = "full")]
use stribeck_formats::Channel;
#[cfg(feature = "full")]
use stribeck_scene::machine::MachineScene;
use stribeck_store::run_dir::{Run, RunDir};
use stribeck_store::trace::TraceWriter;

#[cfg(feature = "full")]
use crate::place::Place;

/// Writes the record of the machine of a complete run, unless it is there or its scene has no machine.
pub(crate) fn keep(dir: &RunDir) -> Result<()> {
    let file = dir.machine();
    if file.exists() || !dir.trace().exists() {
        return Ok(());
    }
    let run = Run::read(dir.path())?;
    let Some(record) = machine::of_run(&run).context("no record of the machine's sensor")? else {
        return Ok(());
    };
    // The name of a whole file: one that is there is not made again.
    let beside = file.with_extension("npy.part");
    let mut writer = TraceWriter::create(&beside, &["time_s", CHANNEL])?;
    for (time, sample) in times(&record).zip(&record.samples) {
        writer.push(&[time, *sample])?;
    }
    writer.finish()?;
    std::fs::rename(&beside, &file).with_context(|| format!("cannot write `{}`", file.display()))
}

/// What the sensor of a machine records of a run: of that in a file, or of its scene's.
#[cfg(feature = "full")]
pub(crate) fn channels(run: &Run, file: Option<&Path>, place: &Place) -> Result<Vec<Channel>> {
    let machine = match file {
        Some(file) => MachineScene::read(&place.locate(file))?,
        None => run.scene.written.housing.machine().cloned().with_context(|| {
            format!(
                "the scene of `{}` has no machine: name a file, `--machine FILE`, that `{} machine` wrote",
                run.scene.written.name, place.program
            )
        })?,
    };
    let force = Force::of_run(run, machine.direction_deg)?;
    let record = machine::record(&machine, &run.scene.written.bearing, &force)?;
    let rate_hz = Some(record.rate_hz);
    Ok(vec![
        Channel::held("time_s", times(&record).collect()).at_rate(rate_hz),
        Channel::held(CHANNEL, record.samples).at_rate(rate_hz),
    ])
}

fn times(record: &MachineRecord) -> impl Iterator<Item = f64> {
    let (from_s, rate_hz, count) = (record.from_s, record.rate_hz, record.samples.len());
    (0..count).map(move |n| from_s + n as f64 / rate_hz)
}
