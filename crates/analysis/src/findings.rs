//! From the samples of a run to its [`Summary`] and to the signals that the figures draw.

use stribeck_bearing::kinematics::Crossing;
use stribeck_bearing::run_dir::Run;
use stribeck_bearing::run_info::Status;
use stribeck_dsp::{PeriodCount, PeriodVerdict, Spectrum, Welch};

use crate::Error;
use crate::events::{self, Passage};
use crate::filtering::{Filter, PAPER_CENTRE_HZ};
use crate::kinematics;
use crate::levels;
use crate::load::{self, Distribution};
use crate::prediction::{Prediction, StaticCurve};
use crate::record::Record;
use crate::summary::{EnergyFinding, Event, LevelsFinding, RunCost, SensorLevels, SpectrumFinding, Summary};
use crate::tones::{self, Tone};

/// Grid of the spectra [Hz]: the paper's 3 Hz. The resolution is that of the record.
const GRID_HZ: f64 = 3.0;
/// Harmonics of each facet line that are looked for; the paper sees the fifth.
const HARMONICS: usize = 6;
/// Shortest record of which a spectrum is made [samples].
const SHORTEST_SPECTRUM: usize = 64;

/// What a run shows: the numbers and the signals behind them.
#[derive(Debug)]
pub struct Findings {
    /// The numbers.
    pub summary: Summary,
    /// What geometry predicts.
    pub prediction: Prediction,
    /// Predicted facet lines with harmonics.
    pub lines: Vec<tones::Line>,
    /// Time of the first usable sample [s].
    pub start_s: f64,
    /// Sampling interval [s].
    pub interval_s: f64,
    /// One entry a sensor, the leading one first.
    pub sensors: Vec<SensorSignal>,
    /// Vertical outer-raceway forces of the rollers that cross the defect, in order of entry.
    pub crossings: Vec<CrossingForce>,
    /// Mean roller force by angle.
    pub distribution: Distribution,
    /// Static roller force by angle, when rigid rings find one.
    pub static_curve: Option<StaticCurve>,
}

/// a_y of one sensor [g] and its spectra [g²/Hz].
#[derive(Debug)]
pub struct SensorSignal {
    /// Name.
    pub name: String,
    /// Mean over each interval.
    pub raw_g: Vec<f64>,
    /// Behind the notch; empty when there is none.
    pub filtered_g: Vec<f64>,
    /// Instantaneous nodal acceleration; empty when it was not recorded.
    pub instant_g: Vec<f64>,
    /// Density of `raw_g`.
    pub raw_density: Option<Spectrum>,
    /// Density of `filtered_g`.
    pub filtered_density: Option<Spectrum>,
}

/// Vertical force between outer raceway and one roller [N], compression positive.
#[derive(Debug)]
pub struct CrossingForce {
    /// Roller, from 1.
    pub roller: usize,
    /// As recorded, mean over each interval.
    pub raw_n: Vec<f64>,
    /// Behind the notch; empty when there is none.
    pub filtered_n: Vec<f64>,
}

impl Findings {
    /// Analyses `run`. An interrupted or diverged run yields what its samples hold.
    ///
    /// # Errors
    /// [`Error::Signal`] when a finite recorded signal is refused all the same.
    pub fn of(run: &Run) -> Result<Self, Error> {
        let record = Record::new(run);
        let prediction = Prediction::of(&run.scene, &run.info.mesh);
        let time = record.time_s();
        let mut notes = notes_on(run, &record);

        let mut sensors = sensor_signals(run, &record, &mut notes)?;
        let lines = tones::harmonics(&prediction.facet_lines, HARMONICS, 0.5 * record.sample_rate_hz());
        let measured = measured_tones(&sensors, &lines, &mut notes)?;
        let filter = filter(&record, &prediction, &measured, &mut notes)?;
        if let Some(filter) = &filter {
            filter_sensors(filter, &record, &mut sensors)?;
        }

        let mut events = picked_events(&record, &prediction, &mut notes);
        let levels = level_finding(time, &sensors, &mut events, filter.as_ref(), &mut notes);
        let crossings = crossing_forces(&record, &events, filter.as_ref())?;
        let notch = filter.as_ref().zip(sensors.first()).map(|(f, s)| f.finding(&s.raw_g, &s.filtered_g));
        let spectrum = sensors.first().and_then(|s| s.raw_density.as_ref());
        let mut load = load::measure(&record, run.info.expected_support_n, prediction.facet_period_s());
        let static_curve = match prediction.static_curve(&run.scene, run.info.expected_support_n) {
            Ok(curve) => Some(curve),
            Err(why) => {
                notes.push(format!("no static load distribution: {why}"));
                None
            }
        };
        load.static_max_roller_n = static_curve.as_ref().map(|c| c.largest_sound_n);
        load.static_max_roller_defect_n = static_curve.as_ref().map(|c| c.largest_n);
        load.static_loaded_rollers = static_curve.as_ref().map(|c| c.loaded_rollers);
        let span = time.last().copied().unwrap_or(0.0);
        note_on_envelope(span, prediction.kinematics.bpfo_hz, &mut notes);

        let summary = Summary {
            scene: run.scene.name.clone(),
            status: run.info.status,
            mesh: run.info.mesh.clone(),
            run: RunCost::of(&run.info, record.len(), span),
            energy: EnergyFinding {
                max_relative_error: run.info.energy.max_relative_error,
                peak_strain_j: run.info.energy.peak_strain_j,
            },
            kinematics: kinematics::measure(&record, &prediction.kinematics),
            events,
            load,
            tones: measured,
            levels,
            notch,
            spectrum: spectrum.map(|s| SpectrumFinding::of(s.resolution())),
            notes,
        };
        Ok(Self {
            summary,
            lines,
            start_s: time.first().copied().unwrap_or(0.0),
            interval_s: record.interval_s(),
            sensors,
            crossings,
            distribution: load::distribution(&record),
            static_curve,
            prediction,
        })
    }

    /// Length of the notch's transient [s]; zero without a notch.
    pub fn transient_s(&self) -> f64 {
        self.summary.notch.as_ref().map_or(0.0, |n| n.transient_s)
    }
}

/// What must be said before any number is read.
fn notes_on(run: &Run, record: &Record<'_>) -> Vec<String> {
    let mut notes = Vec::new();
    if run.info.status != Status::Complete {
        let why = run.info.stop_reason.as_deref().unwrap_or("no reason was recorded");
        notes.push(format!("the run did not complete: {why}"));
    }
    if record.discarded() > 0 {
        notes.push(format!(
            "{} samples from {:.3} ms on are left out: a channel is not a number there",
            record.discarded(),
            1e3 * record.time_s().last().copied().unwrap_or(0.0)
        ));
    }
    if record.is_empty() {
        notes.push("the trace holds no usable sample".into());
    }
    notes
}

/// Raw signals and densities of every sensor of the scene that was recorded.
fn sensor_signals(
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
    let mut signals = Vec::new();
    for sensor in &run.scene.output.sensors {
        let Some(raw_g) = record.acceleration_g(&sensor.name, "ay") else {
            notes.push(format!("sensor `{}` is in the scene but not in the trace", sensor.name));
            continue;
        };
        let raw_density = welch.as_mut().map(|w| w.estimate(&raw_g)).transpose().map_err(Error::Signal)?;
        signals.push(SensorSignal {
            name: sensor.name.clone(),
            instant_g: record.acceleration_g(&sensor.name, "ay_instant").unwrap_or_default(),
            raw_g,
            filtered_g: Vec::new(),
            raw_density,
            filtered_density: None,
        });
    }
    Ok(signals)
}

/// Every line at every sensor.
fn measured_tones(
    sensors: &[SensorSignal],
    lines: &[tones::Line],
    notes: &mut Vec<String>,
) -> Result<Vec<Tone>, Error> {
    let mut all = Vec::new();
    for sensor in sensors {
        if let Some(density) = &sensor.raw_density {
            all.extend(tones::measure(&sensor.name, lines, density)?);
        }
    }
    if let Some(merged) = all.first().filter(|t| !t.unresolved_from.is_empty()) {
        notes.push(format!(
            "this record cannot tell {} ×1 from {}: they are searched as one line",
            merged.name,
            merged.unresolved_from.join(" and ")
        ));
    }
    Ok(all)
}

/// A notch at the dominant facet tone of the leading sensor, or at the predicted one when none is measured.
fn filter(
    record: &Record<'_>,
    prediction: &Prediction,
    measured: &[Tone],
    notes: &mut Vec<String>,
) -> Result<Option<Filter>, Error> {
    if record.is_empty() {
        return Ok(None);
    }
    let leading = measured.first().map(|t| t.sensor.clone());
    let of_leading: Vec<Tone> =
        measured.iter().filter(|t| Some(&t.sensor) == leading.as_ref()).cloned().collect();
    let centre = tones::dominant(&of_leading).and_then(|t| t.measured_hz);
    let predicted = prediction.facet_lines.first().map(|l| l.1).filter(|&hz| hz > 0.0);
    let centre_hz = centre.or(predicted).unwrap_or(PAPER_CENTRE_HZ);
    if centre.is_none() {
        notes.push(format!(
            "no facet tone stands {} dB above its surroundings at the leading sensor: the notch is at the predicted \
             {centre_hz:.1} Hz",
            tones::LEAST_PROMINENCE_DB
        ));
    }
    if centre_hz >= 0.5 * record.sample_rate_hz() {
        notes.push(format!(
            "no notch: {centre_hz} Hz is not below half the sampling rate, {} Hz",
            0.5 * record.sample_rate_hz()
        ));
        return Ok(None);
    }
    Filter::new(record.sample_rate_hz(), centre_hz).map(Some)
}

fn filter_sensors(filter: &Filter, record: &Record<'_>, sensors: &mut [SensorSignal]) -> Result<(), Error> {
    for sensor in sensors {
        sensor.filtered_g = filter.acceleration(&sensor.raw_g)?;
        if record.len() >= SHORTEST_SPECTRUM {
            let mut welch =
                Welch::for_grid(record.sample_rate_hz(), record.len(), GRID_HZ).map_err(Error::Signal)?;
            sensor.filtered_density = Some(welch.estimate(&sensor.filtered_g).map_err(Error::Signal)?);
        }
    }
    Ok(())
}

/// One event for every passage that begins within the record.
fn picked_events(record: &Record<'_>, prediction: &Prediction, notes: &mut Vec<String>) -> Vec<Event> {
    let Some(edges) = prediction.defect else { return Vec::new() };
    let time = record.time_s();
    let last = time.last().copied().unwrap_or(f64::NEG_INFINITY);
    let mut events = Vec::new();
    for passage in prediction.passages.iter().filter(|p| p.entry_s < last) {
        let mut event = Event::expected(passage);
        match record.roller(passage.roller) {
            None => notes.push(format!("roller {} is not in the trace", passage.roller)),
            Some(roller) => {
                let orbit = roller.orbit();
                let near = |edge: f64, expected: f64| {
                    let all = events::crossings(time, &orbit, edge.to_radians());
                    let gap = |t: &f64| (t - expected).abs();
                    let traverse = passage.exit_s - passage.entry_s;
                    all.into_iter().min_by(|a, b| gap(a).total_cmp(&gap(b))).filter(|t| gap(t) < traverse)
                };
                let path_entry = near(edges.leading_deg, passage.entry_s);
                let path_exit = near(edges.trailing_deg, passage.exit_s);
                let seen = Passage {
                    entry_s: passage.entry_s,
                    exit_s: passage.exit_s,
                    middle_s: near(edges.middle_deg, passage.centre_s).unwrap_or(passage.centre_s),
                    smoothing_s: prediction.smoothing_s(passage.exit_s - passage.entry_s),
                };
                let picked = events::pick(time, &roller.outer_normal(), &seen);
                notes.extend(picked.notes.iter().map(|n| format!("roller {}: {n}", passage.roller)));
                event.entry_ms = picked.entry_s.map(|t| 1e3 * t);
                event.exit_ms = picked.exit_s.map(|t| 1e3 * t);
                event.level_n = picked.level_n;
                event.path_entry_ms = path_entry.map(|t| 1e3 * t);
                event.path_exit_ms = path_exit.map(|t| 1e3 * t);
            }
        }
        events.push(event);
    }
    events
}

/// Levels at every sensor; fills in the impulse of each event at the leading one.
fn level_finding(
    time: &[f64],
    sensors: &[SensorSignal],
    events: &mut [Event],
    filter: Option<&Filter>,
    notes: &mut Vec<String>,
) -> LevelsFinding {
    let passages: Vec<(f64, f64)> = events.iter().map(Event::extent_s).collect();
    let start = time.first().copied().unwrap_or(0.0);
    let settled = start + filter.map_or(0.0, Filter::transient_s);
    let exits: Vec<f64> = events.iter().filter_map(|e| e.exit_ms).map(|t| 1e-3 * t).collect();
    let impulses: Vec<_> = exits.iter().map(|&t| levels::impulse_span(time, t)).collect();
    let quiet = levels::quiet_spans(time, &passages, start);
    let quiet_settled = levels::quiet_spans(time, &passages, settled);

    let mut finding = LevelsFinding::default();
    for (number, sensor) in sensors.iter().enumerate() {
        let impulse = levels::level(&sensor.raw_g, &impulses);
        let between = levels::level(&sensor.raw_g, &quiet);
        let filtered = levels::level(&sensor.filtered_g, &quiet_settled);
        if number == 0 {
            finding.sensor = Some(sensor.name.clone());
            finding.impulse_g = impulse.map(|l| l.peak);
            finding.impulse_filtered_g = levels::level(&sensor.filtered_g, &impulses).map(|l| l.peak);
            finding.between_g = between.map(|l| l.peak);
            finding.between_p99_g = between.map(|l| l.p99);
            finding.between_rms_g = between.map(|l| l.rms);
            finding.between_filtered_g = filtered.map(|l| l.peak);
            finding.between_filtered_p99_g = filtered.map(|l| l.p99);
            finding.between_filtered_rms_g = filtered.map(|l| l.rms);
            for event in events.iter_mut() {
                let span = event.exit_ms.map(|t| levels::impulse_span(time, 1e-3 * t));
                event.impulse_g = span.and_then(|s| levels::level(&sensor.raw_g, &[s])).map(|l| l.peak);
            }
        }
        finding.sensors.push(SensorLevels {
            sensor: sensor.name.clone(),
            impulse_g: impulse.map(|l| l.peak),
            between_g: between.map(|l| l.peak),
            between_rms_g: between.map(|l| l.rms),
            between_filtered_g: filtered.map(|l| l.peak),
            between_filtered_rms_g: filtered.map(|l| l.rms),
        });
    }
    if !sensors.is_empty() && finding.impulse_g.is_none() {
        notes.push("no impulse level: no roller leaves the defect within the record".into());
    }
    if !sensors.is_empty() && finding.between_filtered_g.is_none() {
        notes.push(format!(
            "no filtered level between events: after the notch's transient of {:.2} ms no sample is free of events",
            1e3 * (settled - start)
        ));
    }
    finding
}

fn crossing_forces(
    record: &Record<'_>,
    events: &[Event],
    filter: Option<&Filter>,
) -> Result<Vec<CrossingForce>, Error> {
    let mut forces = Vec::new();
    for event in events {
        let Some(roller) = record.roller(event.roller) else { continue };
        let raw_n: Vec<f64> = roller.outer_fy.iter().map(|f| -f).collect();
        let filtered_n = filter.map(|f| f.force(&raw_n)).transpose()?.unwrap_or_default();
        forces.push(CrossingForce { roller: event.roller, raw_n, filtered_n });
    }
    Ok(forces)
}

/// Says whether the record is long enough for envelope analysis instead of drawing one that means nothing.
fn note_on_envelope(record_s: f64, bpfo_hz: f64, notes: &mut Vec<String>) {
    let Ok(count) = PeriodCount::new(record_s, bpfo_hz) else { return };
    if count.verdict() == PeriodVerdict::TooFew {
        notes.push(format!("no envelope spectrum: {count}"));
    }
}

impl Event {
    /// An event of which only the expected times are known.
    fn expected(passage: &Crossing) -> Self {
        Self {
            roller: passage.roller,
            entry_ms: None,
            exit_ms: None,
            expected_entry_ms: 1e3 * passage.entry_s,
            expected_exit_ms: 1e3 * passage.exit_s,
            path_entry_ms: None,
            path_exit_ms: None,
            level_n: None,
            impulse_g: None,
        }
    }

    /// Earliest and latest time [s] that belongs to the passage, measured or expected.
    fn extent_s(&self) -> (f64, f64) {
        let entry = self.entry_ms.map_or(self.expected_entry_ms, |t| t.min(self.expected_entry_ms));
        let exit = self.exit_ms.map_or(self.expected_exit_ms, |t| t.max(self.expected_exit_ms));
        (1e-3 * entry, 1e-3 * exit)
    }
}
