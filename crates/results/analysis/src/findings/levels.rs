//! Levels about and between the passages of rollers, and the lines of the facets, sensor by sensor: each
//! sensor independently of the others.

use std::ops::Range;

use super::SensorSignal;
use crate::Error;
use crate::families::FamilyFinding;
use crate::filtering::Filter;
use crate::levels::{self, Phase, SignalLevel, Visit};
use crate::summary::{ComponentLevels, Event, LevelsFinding, PhaseLevels, RecordLevels, SensorLevels, Shape};
use crate::tones::{self, NearestLine, PredictedLine};

/// Multiple of the facet tone that the paper reports.
const FIFTH: f64 = 5.0;

/// Parts of a record.
struct Spans<'a> {
    time: &'a [f64],
    phases: Vec<Phase>,
    /// About the exits.
    impulses: Vec<Range<usize>>,
    /// Gaps between the events.
    quiet: Vec<Range<usize>>,
}

/// Levels of one sensor [g]: of the impulses at the exits, and of the gaps between events.
struct QuietAndImpulse {
    impulse: Option<SignalLevel>,
    between: Option<SignalLevel>,
    /// Level of the gaps behind the notch, without its transient.
    filtered: Option<SignalLevel>,
}

/// Levels at every sensor; fills in the impulse of each event at the leading one. `tone` is that of the
/// rollers' vertices.
pub(super) fn level_finding(
    time: &[f64],
    (sensors, tone): (&[SensorSignal], Option<&PredictedLine>),
    events: &mut [Event],
    filter: Option<&Filter>,
    notes: &mut Vec<String>,
) -> Result<LevelsFinding, Error> {
    let spans = Spans::of(time, events);
    let mut finding = LevelsFinding::default();
    for (number, sensor) in sensors.iter().enumerate() {
        let found = spans.levels(sensor);
        if number == 0 {
            finding = spans.leading(sensor, &found);
            for event in events.iter_mut() {
                let span = event.left_ms().map(|t| levels::impulse_span(time, 1e-3 * t));
                event.impulse_g = span.and_then(|s| levels::level(&sensor.raw_g, &[s])).map(|l| l.peak);
            }
        }
        finding.sensors.push(spans.of_sensor(sensor, &found, facet_lines(sensor, tone)?));
    }
    if let Some(filter) = filter.filter(|_| !sensors.is_empty() && finding.between_filtered_g.is_none()) {
        notes.push(format!(
            "no filtered level between events: after the notch's transient of {:.2} ms no sample is free of \
             events",
            1e3 * filter.transient_s()
        ));
    }
    Ok(finding)
}

/// Share of a record's power below which what its lines leave is not known.
const LEAST_REST: f64 = 1e-3;

/// The strongest line of the mesh in a_y of the leading sensor over what no line of the mesh explains there [dB], at
/// most 30.
pub(super) fn mesh_over_rest_db(families: &[FamilyFinding], levels: &LevelsFinding) -> Option<f64> {
    let (sensor, record) = (levels.sensor.as_ref()?, levels.record.as_ref()?);
    let lines = families.iter().filter(|family| family.found).flat_map(|family| &family.lines);
    let here = lines.filter(|line| line.sensor == *sensor && line.component == "ay");
    let powers: Vec<f64> = here.filter_map(|line| line.level_g).map(|peak| 0.5 * peak * peak).collect();
    let most = powers.iter().copied().reduce(f64::max)?;
    let all = record.rms_g * record.rms_g;
    let rest = (all - powers.iter().sum::<f64>()).max(LEAST_REST * all);
    Some(10.0 * (most / rest).log10())
}

impl<'a> Spans<'a> {
    fn of(time: &'a [f64], events: &[Event]) -> Self {
        let visits: Vec<Visit> = events.iter().map(Event::visit).collect();
        let phases = levels::phases(time, &visits);
        let exits = events.iter().filter_map(Event::left_ms).map(|t| 1e-3 * t);
        let impulses = exits.map(|t| levels::impulse_span(time, t)).collect();
        let quiet = levels::gap_spans(time, &phases, time.first().copied().unwrap_or(0.0));
        Self { time, phases, impulses, quiet }
    }

    fn levels(&self, sensor: &SensorSignal) -> QuietAndImpulse {
        let start = self.time.first().copied().unwrap_or(0.0);
        let settled = start + sensor.notch.as_ref().map_or(0.0, Filter::transient_s);
        let quiet_settled = levels::gap_spans(self.time, &self.phases, settled);
        QuietAndImpulse {
            impulse: levels::level(&sensor.raw_g, &self.impulses),
            between: levels::level(&sensor.raw_g, &self.quiet),
            filtered: levels::level(&sensor.filtered_g, &quiet_settled),
        }
    }

    /// Numbers of the leading sensor alone.
    fn leading(&self, sensor: &SensorSignal, found: &QuietAndImpulse) -> LevelsFinding {
        let QuietAndImpulse { impulse, between, filtered } = found;
        LevelsFinding {
            sensor: Some(sensor.name.clone()),
            phases: by_phase(&sensor.raw_g, &self.phases),
            impulse_g: impulse.map(|l| l.peak),
            impulse_filtered_g: levels::level(&sensor.filtered_g, &self.impulses).map(|l| l.peak),
            between_g: between.map(|l| l.peak),
            between_p99_g: between.map(|l| l.p99),
            between_rms_g: between.map(|l| l.rms),
            between_filtered_g: filtered.map(|l| l.peak),
            between_filtered_p99_g: filtered.map(|l| l.p99),
            between_filtered_rms_g: filtered.map(|l| l.rms),
            record: Shape::of(&sensor.raw_g).as_ref().map(RecordLevels::of),
            mesh_over_rest_db: None,
            sensors: Vec::new(),
        }
    }

    fn of_sensor(
        &self,
        sensor: &SensorSignal,
        found: &QuietAndImpulse,
        [tone, fifth]: [NearestLine; 2],
    ) -> SensorLevels {
        let QuietAndImpulse { impulse, between, filtered } = found;
        SensorLevels {
            sensor: sensor.name.clone(),
            angle_deg: sensor.angle_deg,
            phases: by_phase(&sensor.raw_g, &self.phases),
            components: components(sensor, &self.phases),
            impulse_g: impulse.map(|l| l.peak),
            between_g: between.map(|l| l.peak),
            between_rms_g: between.map(|l| l.rms),
            between_filtered_g: filtered.map(|l| l.peak),
            between_filtered_rms_g: filtered.map(|l| l.rms),
            tone_hz: tone.hz,
            tone_g: tone.level_g,
            tone_db: tone.above_db,
            fifth_hz: fifth.hz,
            fifth_g: fifth.level_g,
            fifth_db: fifth.above_db,
            notch_hz: sensor.notch.map(|notch| notch.centre_hz()),
            notch_db: sensor.notch.and_then(|notch| notch.attenuation_db(&sensor.raw_g, &sensor.filtered_g)),
        }
    }
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
    let [start, entry, defect, exit, gap] =
        [Phase::StartUp, Phase::Entry, Phase::Defect, Phase::Exit, Phase::Gap]
            .map(|phase| levels::phase_level(signal, phases, phase));
    PhaseLevels::of(start, entry, defect, exit, gap)
}

/// Levels along and across the radius at the sensor's place.
fn components(sensor: &SensorSignal, phases: &[Phase]) -> Vec<ComponentLevels> {
    let turned = [("radial", sensor.radial_g()), ("tangential", sensor.tangential_g())];
    let level = |(component, signal): (&str, Option<Vec<f64>>)| {
        Some(ComponentLevels { component: component.into(), phases: by_phase(&signal?, phases) })
    };
    turned.into_iter().filter_map(level).collect()
}
