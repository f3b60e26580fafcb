//! From the samples of a run to its [`Summary`] and to the signals that the figures draw.

mod passages;
mod spectra;

use stribeck_dsp::{PeriodCount, Spectrum, Welch};
use stribeck_scene::run_dir::Run;
use stribeck_scene::run_info::Status;

use self::passages::{Passages, crossing_forces, level_finding, start_up_end_s};
use self::spectra::{envelope, filter, filter_sensors, fine_density, measured_tones, order_spectrum};
use crate::Error;
use crate::artefacts;
use crate::diagnosis;
use crate::duty::{self, DutyFinding};
use crate::families::{self, Channel, Motion, RollerTrack};
use crate::film::FilmFinding;
use crate::filtering::Filter;
use crate::kinematics::{self, Turning};
use crate::levels::STANDARD_GRAVITY;
use crate::load::{Carried, Distribution, LoadFinding};
use crate::paper;
use crate::prediction::{Prediction, StaticCurve};
use crate::reading::CursorReading;
use crate::record::{Record, Roller};
use crate::ring;
use crate::rolling;
use crate::summary::{EnergyFinding, RunCost, SpectrumFinding, Summary};
use crate::tones;

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
    /// True for a scene of the paper's dimensions.
    pub of_paper: bool,
    /// What geometry predicts.
    pub prediction: Prediction,
    /// Predicted facet lines with harmonics.
    pub lines: Vec<tones::PredictedLine>,
    /// Bending modes of the free outer ring: waves around it, frequency [Hz].
    pub modes: Vec<(u32, f64)>,
    /// Time of the first usable sample [s].
    pub start_s: f64,
    /// When the start-up is over [s]; no level of events or gaps contains it.
    pub start_up_end_s: f64,
    /// Sampling interval [s].
    pub interval_s: f64,
    /// One entry a sensor, the leading one first.
    pub sensors: Vec<SensorSignal>,
    /// Vertical outer-raceway forces of the rollers that cross the defect, in order of entry; empty before
    /// [`Findings::with_crossings`].
    pub crossings: Vec<CrossingForce>,
    /// Force of all rollers on the outer ring against the load at every sample [N]; empty where no roller was recorded.
    pub support_n: Vec<f64>,
    /// Mean roller force by angle.
    pub distribution: Distribution,
    /// Density of the leading sensor over the whole record [g²/Hz], where the segments of its other spectrum hold too few periods of the
    /// defect's family and the record enough.
    pub fine: Option<Spectrum>,
    /// Squared envelope spectrum of the leading sensor [g⁴]; `None` when the record is too short.
    pub envelope: Option<Spectrum>,
    /// Squared envelope spectrum of the leading sensor over the angle of the shaft [g⁴], its frequencies orders; `None` for a
    /// speed that does not change, or a record too short.
    pub orders: Option<Spectrum>,
    /// Static roller force by angle, when rigid rings find one.
    pub static_curve: Option<StaticCurve>,
    /// Recorded motion and accelerations [g] that the families of facet lines were fitted to.
    pub family_signals: (Motion, Vec<Channel>),
    filter: Option<Filter>,
}

/// a_y of one sensor [g] and its spectra [g²/Hz].
#[derive(Debug)]
pub struct SensorSignal {
    /// Name.
    pub name: String,
    /// Its angle, counter-clockwise from the x axis [°].
    pub angle_deg: f64,
    /// a_y, mean over each interval.
    pub raw_g: Vec<f64>,
    /// a_x, mean over each interval; empty when it was not recorded.
    pub across_g: Vec<f64>,
    /// Behind the notch; empty when there is none.
    pub filtered_g: Vec<f64>,
    /// Density of `raw_g`.
    pub raw_density: Option<Spectrum>,
    /// Density of `filtered_g`.
    pub filtered_density: Option<Spectrum>,
}

/// Vertical force between outer raceway and one roller [N], compression positive.
#[derive(Debug)]
pub struct CrossingForce {
    /// Which spall, from 1.
    pub spall: usize,
    /// Roller, from 1.
    pub roller: usize,
    /// Whether it is the vertical force of the outer raceway, as in the paper, or that along the normal of the spall's raceway.
    pub vertical: bool,
    /// As recorded, mean over each interval.
    pub raw_n: Vec<f64>,
    /// Behind the notch; empty when there is none.
    pub filtered_n: Vec<f64>,
}

impl SensorSignal {
    /// Acceleration outwards at the sensor's angle [g]; `None` without a_x.
    pub fn radial_g(&self) -> Option<Vec<f64>> {
        let (sin, cos) = self.angle_deg.to_radians().sin_cos();
        self.turned(cos, sin)
    }

    /// Acceleration along the circle, counter-clockwise [g]; `None` without a_x.
    pub fn tangential_g(&self) -> Option<Vec<f64>> {
        let (sin, cos) = self.angle_deg.to_radians().sin_cos();
        self.turned(-sin, cos)
    }

    fn turned(&self, of_x: f64, of_y: f64) -> Option<Vec<f64>> {
        let turned = || self.across_g.iter().zip(&self.raw_g).map(|(x, y)| of_x * x + of_y * y).collect();
        (!self.across_g.is_empty()).then(turned)
    }
}

impl Findings {
    /// Analyses a record. An interrupted or diverged run yields what its samples hold.
    ///
    /// # Errors
    /// [`Error::Run`] when the trace cannot be read, [`Error::Signal`] when a finite recorded signal is refused all the same.
    pub fn of(record: &Record<'_>) -> Result<Self, Error> {
        let run = record.run();
        let prediction = Prediction::of(&run.scene, &run.info.mesh);
        let time = record.time_s();
        let mut notes = notes_on(run, record);

        // Where the speed changes no line of the mesh or of the defect has a frequency.
        let steady = !run.scene.written.operation.speed_varies();
        let [begin_s, end_s] = record.stretch_s();
        let span = end_s - begin_s;
        // Ten periods, or nothing could be said of a record.
        let long = span * prediction.kinematics.bpfo_hz >= PeriodCount::ENOUGH;
        let leading = leading_channel(run);
        // The transforms of a whole record come before the signals of all sensors are in memory.
        let analysis = match leading.as_ref().filter(|_| steady && long) {
            Some(name) => diagnosis::analysis(&run.scene, record, &prediction.kinematics, name)?,
            None => None,
        };

        let along = run.scene.written.load_direction();
        let mut turning = Turning::new(record, &prediction.kinematics);
        let mut carried = Carried::new(record, along, prediction.facet_period_s());
        let mut passages = Passages::new(&run.scene, time, &prediction);
        record.each_roller(|roller| {
            let (orbit, outer_normal) = (roller.orbit(), roller.outer_normal());
            turning.add(roller, &orbit, &outer_normal);
            carried.add(roller, &outer_normal);
            passages.add(roller, &orbit);
        })?;
        let motion = turning.finding(&prediction.kinematics, record.pockets());
        let diagnosis = analysis.map(|analysis| diagnosis::of(&run.scene, &motion, &analysis));
        let envelope = match leading.filter(|_| steady) {
            Some(name) => envelope(record, &prediction, &motion, &name)?,
            None => None,
        };

        let mut sensors = sensor_signals(run, record, &mut notes)?;
        let facet_lines = if steady { &prediction.facet_lines[..] } else { &[] };
        let mut lines = tones::harmonics(facet_lines, HARMONICS, 0.5 * record.sample_rate_hz());
        for line in &mut lines {
            line.from_motion_hz = motion.ratio(&line.name).map(|ratio| ratio * line.predicted_hz);
        }
        let measured = measured_tones(&sensors, &lines, &mut notes)?;
        let (tracks, channels) =
            tracks_and_channels(record, &prediction, &motion, &sensors, steady, &mut notes)?;
        let candidates = if steady { prediction.candidates(&run.scene, &run.info.mesh) } else { Vec::new() };
        let families = families::identify(&tracks, &candidates, &channels)?;
        let filter = if steady {
            filter(run, record, &prediction, &sensors, (&measured, &families), &mut notes)?
        } else {
            None
        };
        if let Some(filter) = &filter {
            filter_sensors(filter, record, &mut sensors)?;
        }

        let expected_n = duty::expected_support_n(run, record);
        let static_curve = static_curve(run, &prediction, expected_n, &mut notes);
        let fullest_n = static_curve.as_ref().map_or(0.0, |curve| curve.largest_sound_n);
        let mut events = passages.events(record, fullest_n, &mut notes)?;
        let levels = level_finding(time, &sensors, &mut events, filter.as_ref(), &mut notes);
        if !sensors.is_empty() && levels.impulse_g.is_none() && !prediction.spalls.is_empty() {
            notes.push("no impulse level: no roller leaves a spall under load within the record".into());
        }
        let of_paper = paper::is_scene_of(&run.scene.written) && !run.scene.written.operation.varies();
        let notch = filter.as_ref().zip(sensors.first());
        let notch = notch.map(|(f, s)| f.finding(&s.raw_g, &s.filtered_g, of_paper));
        let spectrum = sensors.first().and_then(|s| s.raw_density.as_ref());
        let load = load_finding(&carried, record, expected_n, static_curve.as_ref());
        notes.extend(rolling::warnings(load.expected_n, load.least_rolling_n, &motion));
        let cage = record.channel("cage.x_m").zip(record.channel("cage.y_m"));
        notes.extend(cage.and_then(|(x, y)| rolling::straying(&run.scene, x, y)));
        let fine = match (prediction.family, sensors.first().zip(spectrum)) {
            (Some((_, hz)), Some((sensor, density))) => fine_density(&sensor.raw_g, density, hz)?,
            _ => None,
        };
        let artefacts = match sensors.first().zip(spectrum).filter(|_| steady) {
            Some((sensor, density)) => {
                let (sensor, fine) = (sensor.name.as_str(), fine.as_ref());
                let seen = artefacts::Seen { tones: &measured, families: &families, sensor, density, fine };
                artefacts::ledger(&run.scene, &prediction, &motion, &seen)?
            }
            None => Vec::new(),
        };
        let mut duty = DutyFinding::of(&run.scene, record);
        let mut orders = None;
        let (envelope, enveloped) = match envelope {
            Some(Ok((spectrum, finding))) => (Some(spectrum), Some(finding)),
            Some(Err(why)) => {
                notes.push(why);
                (None, None)
            }
            None => (None, None),
        };
        if !steady {
            notes.push(
                "the speed changes: families have orders and no frequencies, and the tables and figures of lines at constant frequencies, \
                 the notch among them, are left out. Other frequencies are those at the mean speed"
                    .into(),
            );
            notes.extend(duty::note(&run.scene.written));
            orders = order_spectrum(run, record, &motion, &sensors, duty.as_mut(), &mut notes)?;
        }
        let cursor = of_paper.then(|| cursor(record, &prediction)).flatten();

        let mut summary = Summary {
            scene: run.scene.written.name.clone(),
            status: run.info.status,
            mesh: run.info.mesh.clone(),
            run: RunCost::of(&run.info, record.len(), span),
            energy: EnergyFinding::of(&run.info.energy),
            kinematics: motion,
            duty,
            events,
            load,
            families,
            film: FilmFinding::measure(run, record)?,
            tones: measured,
            levels,
            notch,
            spectrum: spectrum.map(|s| SpectrumFinding {
                fine_resolution_hz: fine.as_ref().map(|fine| fine.resolution().resolution_hz),
                ..SpectrumFinding::of(s.resolution())
            }),
            artefacts,
            envelope: enveloped,
            diagnosis,
            cursor,
            paper: Vec::new(),
            notes,
        };
        if of_paper {
            summary.paper = paper::rows(&run.scene, &run.info.mesh, &prediction, &summary);
        }
        Ok(Self {
            of_paper,
            start_up_end_s: start_up_end_s(time, &summary.events),
            summary,
            lines,
            modes: ring::outer_ring_modes(&run.scene, artefacts::LAST_MODE),
            start_s: time.first().copied().unwrap_or(0.0),
            interval_s: record.interval_s(),
            sensors,
            crossings: Vec::new(),
            distribution: carried.distribution(),
            support_n: carried.into_support(),
            fine,
            envelope,
            orders,
            static_curve,
            family_signals: (tracks, channels),
            filter,
            prediction,
        })
    }

    /// The same with the forces of the first `most` passages, for pictures.
    ///
    /// # Errors
    /// As [`Findings::of`].
    pub fn with_crossings(mut self, record: &Record<'_>, most: usize) -> Result<Self, Error> {
        let (events, filter) = (&self.summary.events, self.filter.as_ref());
        self.crossings = crossing_forces(record, &self.prediction, events, filter, most)?;
        Ok(self)
    }

    /// Length of the notch's transient [s]; zero without a notch.
    pub fn transient_s(&self) -> f64 {
        self.summary.notch.as_ref().map_or(0.0, |n| n.transient_s)
    }
}

/// Which channel is the vertical acceleration of the first sensor that was recorded?
fn leading_channel(run: &Run) -> Option<String> {
    let mut vertical = run.scene.written.output.sensors.iter().map(|s| format!("sensor.{}.ay_m_s2", s.name));
    vertical.find(|name| run.trace.names().contains(name))
}

/// How do rigid rings share the load?
fn static_curve(
    run: &Run,
    prediction: &Prediction,
    expected_n: f64,
    notes: &mut Vec<String>,
) -> Option<StaticCurve> {
    match prediction.static_curve(&run.scene, expected_n) {
        Ok(curve) => Some(curve),
        Err(why) => {
            notes.push(format!("no static load distribution: {why}"));
            None
        }
    }
}

/// What do rollers carry, beside rigid rings?
fn load_finding(
    carried: &Carried,
    record: &Record<'_>,
    expected_n: f64,
    curve: Option<&StaticCurve>,
) -> LoadFinding {
    let mut load = carried.finding(record, expected_n);
    load.static_max_roller_n = curve.map(|c| c.largest_sound_n);
    load.static_max_roller_defect_n = curve.map(|c| c.largest_n);
    load.static_loaded_rollers = curve.map(|c| c.loaded_rollers);
    load.least_rolling_n =
        curve.and_then(|curve| rolling::least_support_n(&record.run().scene, curve, load.expected_n));
    load
}

/// What can the paper's cursor read at this sample rate?
fn cursor(record: &Record<'_>, prediction: &Prediction) -> Option<CursorReading> {
    let pair = prediction.kinematics.paper_noise_hz(record.run().scene.element_size);
    CursorReading::of(paper::CURSOR_HZ, record.sample_rate_hz(), paper::TONE_HZ, pair)
}

/// What must be said before any number is read.
fn notes_on(run: &Run, record: &Record<'_>) -> Vec<String> {
    let mut notes = Vec::new();
    match (run.info.status, &run.info.stop_reason) {
        (Status::Complete, _) => {}
        (Status::Running, _) => notes.push("the run is still going, or was killed".into()),
        (_, Some(why)) => notes.push(format!("the run did not complete: {why}")),
        (_, None) => notes.push("the run did not complete; no reason was recorded".into()),
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
    } else if record.is_part() {
        let time = record.time_s();
        let [from_s, to_s] = [time.first(), time.last()].map(|t| t.copied().unwrap_or(0.0));
        notes.push(format!(
            "only {from_s:.3} to {to_s:.3} s of the record of {:.3} s are looked at: `stribeck report --from-s --to-s` chooses others",
            run.info.simulated_s
        ));
    }
    notes.extend(run.info.notes.iter().cloned());
    notes.extend(stribeck_scene::catalogue::assumptions(&run.scene.written.bearing));
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
            filtered_g: Vec::new(),
            raw_density,
            filtered_density: None,
        });
    }
    Ok(signals)
}

/// Motion and accelerations of the part of a record in which families of facet lines are sought; a note where that is not all of it.
fn tracks_and_channels(
    record: &Record<'_>,
    prediction: &Prediction,
    motion: &kinematics::KinematicsFinding,
    sensors: &[SensorSignal],
    steady: bool,
    notes: &mut Vec<String>,
) -> Result<(Motion, Vec<Channel>), Error> {
    let interval_s = record.interval_s();
    let bpfo_hz = motion.bpfo_hz.filter(|hz| *hz > 0.0).unwrap_or(prediction.kinematics.bpfo_hz);
    let early = families::too_early(record.len(), interval_s, bpfo_hz).unwrap_or(0);
    if early > 0 && steady {
        notes.push(format!(
            "the mesh\u{2019}s families of lines are sought in the last {:.3} s of the record, {:.0} periods of BPFO",
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
    let tracks = Motion {
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
