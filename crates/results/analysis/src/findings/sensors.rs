//! Signals of a record: accelerations of the sensors with their densities, and the motion and accelerations
//! that facet lines are fitted to.

use stribeck_dsp::Welch;
use stribeck_store::run_dir::Run;

use super::{GRID_HZ, SHORTEST_SPECTRUM, SensorSignal};
use crate::Error;
use crate::families::{self, Channel, RecordedMotion, RollerTrack};
use crate::kinematics;
use crate::prediction::Prediction;
use crate::record::{Record, Roller};
use stribeck_diagnosis::STANDARD_GRAVITY;

/// Vertical acceleration of the first sensor that was recorded.
pub(super) fn leading_channel(run: &Run) -> Option<String> {
    let mut vertical = run.scene.written.output.sensors.iter().map(|s| format!("sensor.{}.ay_m_s2", s.name));
    vertical.find(|name| run.trace.names().contains(name))
}

/// Raw signals and densities of every sensor of the scene that was recorded.
pub(super) fn sensor_signals(
    run: &Run,
    record: &Record<'_>,
    notes: &mut Vec<String>,
) -> Result<Vec<SensorSignal>, Error> {
    let mut welch = None;
    if record.len() >= SHORTEST_SPECTRUM {
        welch = Some(Welch::for_grid(record.sample_rate_hz(), record.len(), GRID_HZ).map_err(Error::Signal)?);
    } else {
        notes.push(format!(
            "{} samples are too few for a spectrum, which needs {SHORTEST_SPECTRUM}",
            record.len()
        ));
    }
    let means = |name: &str| {
        name.starts_with("sensor.") && [".ax_m_s2", ".ay_m_s2"].iter().any(|end| name.ends_with(end))
    };
    let mut recorded = record.part(0..record.len(), means)?;
    let mut acceleration_g = |sensor: &str, component: &str| {
        let mut values = recorded.take(&format!("sensor.{sensor}.{component}_m_s2"))?;
        values.iter_mut().for_each(|a| *a /= STANDARD_GRAVITY);
        Some(values)
    };
    let mut signals = Vec::new();
    for sensor in &run.scene.written.output.sensors {
        let Some(raw_g) = acceleration_g(&sensor.name, "ay") else {
            notes.push(format!("sensor `{}` is in the scene but not in the trace", sensor.name));
            continue;
        };
        let raw_density = welch.as_mut().map(|w| w.estimate(&raw_g)).transpose().map_err(Error::Signal)?;
        signals.push(SensorSignal {
            name: sensor.name.clone(),
            angle_deg: sensor.angle_deg,
            across_g: acceleration_g(&sensor.name, "ax").unwrap_or_default(),
            raw_g,
            notch: None,
            filtered_g: Vec::new(),
            raw_density,
            filtered_density: None,
        });
    }
    Ok(signals)
}

/// Motion and accelerations of the part of a record in which families of facet lines are sought; a note where
/// that is not all of it.
pub(super) fn tracks_and_channels(
    record: &Record<'_>,
    prediction: &Prediction,
    motion: &kinematics::KinematicsFinding,
    sensors: &[SensorSignal],
    steady: bool,
    notes: &mut Vec<String>,
) -> Result<(RecordedMotion, Vec<Channel>), Error> {
    let interval_s = record.interval_s();
    let bpfo_hz = motion.bpfo_hz.filter(|hz| *hz > 0.0).unwrap_or(prediction.kinematics.bpfo_hz);
    let early = families::too_early(record.len(), interval_s, bpfo_hz).unwrap_or(0);
    if early > 0 && steady {
        notes.push(format!(
            "the mesh\u{2019}s families of lines are sought in the last {:.3} s of the record, {:.0} periods \
             of BPFO",
            interval_s * (record.len() - early) as f64,
            families::MOST_PERIODS
        ));
    }
    // Families are defined for a shaft that turns clockwise; one that turns the other way is mirrored.
    let sense = prediction.kinematics.sense();
    let numbers = record.roller_numbers();
    let (start, late) = (record.at_start(&numbers)?, record.with_rollers(&numbers, early..record.len())?);
    let track = |(first, late): (Roller<'_>, Roller<'_>)| {
        let place = first.orbit().first().map_or(0.0, |angle| sense * angle);
        let orbit = late.orbit().into_iter().map(|angle| sense * angle).collect();
        let spin = late.spin.iter().map(|angle| sense * angle).collect();
        RollerTrack { place, orbit, spin, load_n: late.outer_normal() }
    };
    let tracks = RecordedMotion {
        interval_s,
        shaft_rad_s: sense * prediction.kinematics.shaft_rad_s,
        outer_rad_s: sense * prediction.kinematics.outer_rad_s,
        bpfo_hz,
        rollers: start.rollers().into_iter().zip(late.rollers()).map(track).collect(),
    };
    let channels = sensors.iter().flat_map(|sensor| {
        [("ay", &sensor.raw_g), ("ax", &sensor.across_g)].map(|(component, values)| Channel {
            sensor: sensor.name.clone(),
            component: component.to_owned(),
            values: values.get(early..).unwrap_or_default().to_vec(),
        })
    });
    Ok((tracks, channels.filter(|channel| !channel.values.is_empty()).collect()))
}
