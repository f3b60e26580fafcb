//! Levels about and between the passages of rollers, and the lines of the facets, sensor by sensor: each as
//! if it were the only one of the scene.

use super::SensorSignal;
use crate::Error;
use crate::filtering::Filter;
use crate::levels::{self, Phase, Visit};
use crate::summary::{ComponentLevels, Event, LevelsFinding, PhaseLevels, SensorLevels};
use crate::tones::{self, NearestLine, PredictedLine};

/// Multiple of the facet tone that the paper sees beside it.
const FIFTH: f64 = 5.0;

/// Levels at every sensor; fills in the impulse of each event at the leading one.
/// `tone` is that of the rollers' vertices.
///
/// # Errors
/// [`Error::Signal`] when a density cannot be searched.
pub(super) fn level_finding(
    time: &[f64],
    (sensors, tone): (&[SensorSignal], Option<&PredictedLine>),
    events: &mut [Event],
    filter: Option<&Filter>,
    notes: &mut Vec<String>,
) -> Result<LevelsFinding, Error> {
    let visits: Vec<Visit> = events.iter().map(Event::visit).collect();
    let phases = levels::phases(time, &visits);
    let start = time.first().copied().unwrap_or(0.0);
    let settled = |notch: Option<&Filter>| start + notch.map_or(0.0, Filter::transient_s);
    let exits: Vec<f64> = events.iter().filter_map(Event::left_ms).map(|t| 1e-3 * t).collect();
    let impulses: Vec<_> = exits.iter().map(|&t| levels::impulse_span(time, t)).collect();
    let quiet = levels::gap_spans(time, &phases, start);

    let mut finding = LevelsFinding::default();
    for (number, sensor) in sensors.iter().enumerate() {
        let impulse = levels::level(&sensor.raw_g, &impulses);
        let between = levels::level(&sensor.raw_g, &quiet);
        let quiet_settled = levels::gap_spans(time, &phases, settled(sensor.notch.as_ref()));
        let filtered = levels::level(&sensor.filtered_g, &quiet_settled);
        let [fundamental, fifth] = facet_lines(sensor, tone)?;
        if number == 0 {
            finding.sensor = Some(sensor.name.clone());
            finding.phases = by_phase(&sensor.raw_g, &phases);
            finding.impulse_g = impulse.map(|l| l.peak);
            finding.impulse_filtered_g = levels::level(&sensor.filtered_g, &impulses).map(|l| l.peak);
            finding.between_g = between.map(|l| l.peak);
            finding.between_p99_g = between.map(|l| l.p99);
            finding.between_rms_g = between.map(|l| l.rms);
            finding.between_filtered_g = filtered.map(|l| l.peak);
            finding.between_filtered_p99_g = filtered.map(|l| l.p99);
            finding.between_filtered_rms_g = filtered.map(|l| l.rms);
            for event in events.iter_mut() {
                let span = event.left_ms().map(|t| levels::impulse_span(time, 1e-3 * t));
                event.impulse_g = span.and_then(|s| levels::level(&sensor.raw_g, &[s])).map(|l| l.peak);
            }
        }
        finding.sensors.push(SensorLevels {
            sensor: sensor.name.clone(),
            angle_deg: sensor.angle_deg,
            phases: by_phase(&sensor.raw_g, &phases),
            components: components(sensor, &phases),
            impulse_g: impulse.map(|l| l.peak),
            between_g: between.map(|l| l.peak),
            between_rms_g: between.map(|l| l.rms),
            between_filtered_g: filtered.map(|l| l.peak),
            between_filtered_rms_g: filtered.map(|l| l.rms),
            tone_hz: fundamental.hz,
            tone_g: fundamental.level_g,
            tone_db: fundamental.above_db,
            fifth_hz: fifth.hz,
            fifth_g: fifth.level_g,
            fifth_db: fifth.above_db,
            notch_hz: sensor.notch.map(|notch| notch.centre_hz()),
            notch_db: sensor.notch.and_then(|notch| notch.attenuation_db(&sensor.raw_g, &sensor.filtered_g)),
        });
    }
    if filter.is_some() && !sensors.is_empty() && finding.between_filtered_g.is_none() {
        notes.push(format!(
            "no filtered level between events: after the notch's transient of {:.2} ms no sample is free of \
             events",
            1e3 * (settled(filter) - start)
        ));
    }
    Ok(finding)
}

/// The line of the rollers' vertices at a sensor that is nearest to where the recorded motion puts it, and
/// that nearest to its fifth harmonic.
fn facet_lines(sensor: &SensorSignal, tone: Option<&PredictedLine>) -> Result<[NearestLine; 2], Error> {
    let (Some(density), Some(tone)) = (&sensor.raw_density, tone) else { return Ok(Default::default()) };
    let expected_hz = tone.from_motion_hz.unwrap_or(tone.predicted_hz);
    let fundamental = tones::nearest(density, expected_hz)?;
    let fifth = tones::nearest(density, FIFTH * fundamental.hz.unwrap_or(expected_hz))?;
    Ok([fundamental, fifth])
}

/// When the start-up is over [s].
pub(super) fn start_up_end_s(time: &[f64], events: &[Event]) -> f64 {
    let visits: Vec<Visit> = events.iter().map(Event::visit).collect();
    let first = levels::phases(time, &visits).iter().position(|p| *p != Phase::StartUp);
    first.or(time.len().checked_sub(1)).map_or(0.0, |n| time[n])
}

/// Peak and root mean square of every phase.
fn by_phase(signal: &[f64], phases: &[Phase]) -> PhaseLevels {
    let of = |phase| {
        levels::phase_level(signal, phases, phase).map_or((None, None), |l| (Some(l.peak), Some(l.rms)))
    };
    let [start, entry, defect, exit, gap] =
        [Phase::StartUp, Phase::Entry, Phase::Defect, Phase::Exit, Phase::Gap].map(of);
    PhaseLevels {
        start_g: start.0,
        start_rms_g: start.1,
        entry_g: entry.0,
        entry_rms_g: entry.1,
        defect_g: defect.0,
        defect_rms_g: defect.1,
        exit_g: exit.0,
        exit_rms_g: exit.1,
        gap_g: gap.0,
        gap_rms_g: gap.1,
    }
}

/// Levels along and across the radius at the sensor's place.
fn components(sensor: &SensorSignal, phases: &[Phase]) -> Vec<ComponentLevels> {
    let turned = [("radial", sensor.radial_g()), ("tangential", sensor.tangential_g())];
    let level = |(component, signal): (&str, Option<Vec<f64>>)| {
        Some(ComponentLevels { component: component.into(), phases: by_phase(&signal?, phases) })
    };
    turned.into_iter().filter_map(level).collect()
}
