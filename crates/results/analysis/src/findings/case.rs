//! The questions that are put to a record, one function each. [`Findings::of`] asks them in turn.

use stribeck_dsp::PeriodCount;
use stribeck_store::run_dir::Run;
use stribeck_store::run_info::Status;

use super::answers::{Answers, AtRest, Crossings, LeadingSpectrum, MeshLines, Orders, Rollers};
use super::levels::{level_finding, mesh_over_rest_db, start_up_end_s};
use super::passages::Passages;
use super::sensors::{leading_channel, sensor_signals, tracks_and_channels};
use super::spectra::{
    Enveloped, envelope, filter, filter_sensors, fine_density, measured_tones, order_spectrum,
};
use super::{Findings, HARMONICS, SensorSignal};
use crate::Error;
use crate::artefacts::{self, Artefact};
use crate::diagnosis;
use crate::duty::{self, DutyFinding};
use crate::families;
use crate::filtering::Filter;
use crate::kinematics::{KinematicsFinding, Turning};
use crate::load::{Carried, LoadFinding};
use crate::paper;
use crate::prediction::Prediction;
use crate::reading::CursorReading;
use crate::record::Record;
use crate::ring;
use crate::rolling;
use crate::summary::{EnergyFinding, RunCost, SpectrumFinding, Summary};
use crate::tones;
use stribeck_diagnosis::Analysis;

/// The facet line of the rollers.
const ROLLER_VERTICES: &str = "roller_vertices";

/// A record, with the predictions from geometry and speed.
pub(super) struct Case<'a> {
    pub(super) record: &'a Record<'a>,
    pub(super) run: &'a Run,
    pub(super) prediction: Prediction,
    /// True for a scene of the paper's dimensions.
    pub(super) of_paper: bool,
    /// Whether all speeds are constant: otherwise no line of the mesh or of the defect has a frequency.
    steady: bool,
}

impl<'a> Case<'a> {
    pub(super) fn of(record: &'a Record<'a>) -> Self {
        let run = record.run();
        let operation = &run.scene.written.operation;
        Self {
            record,
            run,
            prediction: Prediction::of(&run.scene, &run.info.mesh),
            of_paper: paper::is_scene_of(&run.scene.written) && !operation.varies(),
            steady: !operation.speed_varies(),
        }
    }

    /// Which warnings precede all numbers?
    pub(super) fn caveats(&self) -> Vec<String> {
        let (run, record) = (self.run, self.record);
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
                "only {from_s:.3} to {to_s:.3} s of the record of {:.3} s are looked at: `stribeck report \
                 --from-s --to-s` chooses others",
                run.info.simulated_s
            ));
        }
        notes.extend(run.info.notes.iter().cloned());
        notes.extend(stribeck_scene::catalogue::assumptions(&run.scene.written.bearing));
        notes
    }

    /// What is the verdict on the sensor of the machine, or else on the leading one, without the scene? `None` for a record of fewer than ten
    /// periods, or of a speed that changes.
    pub(super) fn judged_by_itself(&self) -> Result<Option<Analysis>, Error> {
        let [begin_s, end_s] = self.record.stretch_s();
        let long = (end_s - begin_s) * self.prediction.kinematics.bpfo_hz >= PeriodCount::ENOUGH;
        if !self.steady || !long {
            return Ok(None);
        }
        if let Some(analysis) = diagnosis::analysis_at_the_machine(self.run, &self.prediction.kinematics)? {
            return Ok(Some(analysis));
        }
        match leading_channel(self.run) {
            Some(name) => {
                diagnosis::analysis(&self.run.scene, self.record, &self.prediction.kinematics, &name)
            }
            None => Ok(None),
        }
    }

    /// How do rollers turn, what is their load, and when do they pass the defect? Their channels are read one
    /// after the other.
    pub(super) fn rollers(&self) -> Result<Rollers<'_>, Error> {
        let (scene, record, prediction) = (&self.run.scene, self.record, &self.prediction);
        let mut turning = Turning::new(record, &prediction.kinematics);
        let mut carried = Carried::new(record, scene.written.load_direction(), prediction.facet_period_s());
        let mut passages = Passages::new(scene, record.time_s(), prediction);
        record.each_roller(|roller| {
            let (orbit, outer_normal) = (roller.orbit(), roller.outer_normal());
            turning.add(roller, &orbit, &outer_normal);
            carried.add(roller, &outer_normal);
            passages.add(roller, &orbit);
        })?;
        let motion = turning.finding(&prediction.kinematics, record.pockets());
        Ok(Rollers { motion, carried, passages })
    }

    /// Do the defect's shocks stand in the envelope spectrum of the leading sensor? `None` for a speed that
    /// changes, or no sensor.
    pub(super) fn envelope(&self, motion: &KinematicsFinding) -> Result<Option<Enveloped>, Error> {
        match leading_channel(self.run).filter(|_| self.steady) {
            Some(name) => envelope(self.record, &self.prediction, motion, &name),
            None => Ok(None),
        }
    }

    /// What did the sensors record?
    pub(super) fn sensors(&self, notes: &mut Vec<String>) -> Result<Vec<SensorSignal>, Error> {
        sensor_signals(self.run, self.record, notes)
    }

    /// Which lines of its facets does the record hold? None are sought where the speed changes.
    pub(super) fn mesh_lines(
        &self,
        motion: &KinematicsFinding,
        sensors: &[SensorSignal],
        notes: &mut Vec<String>,
    ) -> Result<MeshLines, Error> {
        let (record, prediction) = (self.record, &self.prediction);
        let facet_lines = if self.steady { &prediction.facet_lines[..] } else { &[] };
        let mut lines = tones::harmonics(facet_lines, HARMONICS, 0.5 * record.sample_rate_hz());
        for line in &mut lines {
            line.from_motion_hz = motion.ratio(&line.name).map(|ratio| ratio * line.predicted_hz);
        }
        let tones = measured_tones(sensors, &lines, notes)?;
        let (tracks, channels) =
            tracks_and_channels(record, prediction, motion, sensors, self.steady, notes)?;
        let candidates = match self.steady {
            true => prediction.candidates(&self.run.scene, &self.run.info.mesh),
            false => Vec::new(),
        };
        let families = families::identify(&tracks, &candidates, &channels)?;
        Ok(MeshLines { lines, tones, families, signals: (tracks, channels) })
    }

    /// Where is the notch, and what are the sensors' signals behind it?
    pub(super) fn notch(
        &self,
        mesh: &MeshLines,
        sensors: &mut [SensorSignal],
        notes: &mut Vec<String>,
    ) -> Result<Option<Filter>, Error> {
        if !self.steady {
            return Ok(None);
        }
        let filter =
            filter(self.run, self.record, &self.prediction, sensors, (&mesh.tones, &mesh.families), notes)?;
        if let Some(filter) = &filter {
            filter_sensors(filter, &mesh.tones, self.record, sensors)?;
        }
        Ok(filter)
    }

    /// How would rigid rings at rest share the load?
    pub(super) fn at_rest(&self, notes: &mut Vec<String>) -> AtRest {
        let expected_n = duty::expected_support_n(self.run, self.record);
        let curve = self.prediction.static_curve(&self.run.scene, expected_n);
        let curve = curve.map_err(|why| notes.push(format!("no static load distribution: {why}"))).ok();
        AtRest { expected_n, curve }
    }

    /// Which events and levels has a passage over the defect?
    pub(super) fn crossings(
        &self,
        passages: Passages<'_>,
        at_rest: &AtRest,
        (sensors, mesh): (&[SensorSignal], &MeshLines),
        filter: Option<&Filter>,
        notes: &mut Vec<String>,
    ) -> Result<Crossings, Error> {
        let fullest_n = at_rest.curve.as_ref().map_or(0.0, |curve| curve.largest_sound_n);
        let mut events = passages.events(self.record, fullest_n, notes)?;
        let tone = mesh.lines.iter().find(|line| line.name == ROLLER_VERTICES && line.harmonic == 1);
        let mut levels = level_finding(self.record.time_s(), (sensors, tone), &mut events, filter, notes)?;
        levels.mesh_over_rest_db = mesh_over_rest_db(&mesh.families, &levels);
        if !sensors.is_empty() && levels.impulse_g.is_none() && !self.prediction.spalls.is_empty() {
            notes.push("no impulse level: no roller leaves a spall under load within the record".into());
        }
        Ok(Crossings { events, levels })
    }

    /// What is the load distribution, beside that of rigid rings, and does the bearing roll?
    pub(super) fn load(
        &self,
        carried: &Carried,
        at_rest: &AtRest,
        motion: &KinematicsFinding,
        notes: &mut Vec<String>,
    ) -> LoadFinding {
        let (scene, record) = (&self.run.scene, self.record);
        let mut load = carried.finding(record, at_rest.expected_n);
        if let Some(curve) = &at_rest.curve {
            load.static_max_roller_n = Some(curve.largest_sound_n);
            load.static_max_roller_defect_n = Some(curve.largest_n);
            load.static_loaded_rollers = Some(curve.loaded_rollers);
            load.least_rolling_n = rolling::least_support_n(scene, curve, load.expected_n);
        }
        notes.extend(rolling::warnings(load.expected_n, load.least_rolling_n, motion));
        let cage = record.channel("cage.x_m").zip(record.channel("cage.y_m"));
        notes.extend(cage.and_then(|(x, y)| rolling::straying(scene, x, y)));
        load
    }

    /// What does the spectrum of the leading sensor resolve, and would a longer record resolve the defect's
    /// family?
    pub(super) fn spectrum(&self, sensors: &[SensorSignal]) -> Result<LeadingSpectrum, Error> {
        let leading = sensors.first().and_then(|sensor| Some((sensor, sensor.raw_density.as_ref()?)));
        let fine = match self.prediction.shocks.zip(leading) {
            Some((shocks, (sensor, density))) => fine_density(&sensor.raw_g, density, shocks.hz)?,
            None => None,
        };
        let finding = leading.map(|(_, density)| SpectrumFinding {
            fine_resolution_hz: fine.as_ref().map(|fine| fine.resolution().resolution_hz),
            ..SpectrumFinding::of(density.resolution())
        });
        Ok(LeadingSpectrum { finding, fine })
    }

    /// Which line of the leading sensor has which cause? None where the speed changes.
    pub(super) fn artefacts(
        &self,
        mesh: &MeshLines,
        motion: &KinematicsFinding,
        sensors: &[SensorSignal],
        spectrum: &LeadingSpectrum,
    ) -> Result<Vec<Artefact>, Error> {
        let leading = sensors.first().and_then(|sensor| Some((sensor, sensor.raw_density.as_ref()?)));
        let Some((sensor, density)) = leading.filter(|_| self.steady) else { return Ok(Vec::new()) };
        let seen = artefacts::Seen {
            tones: &mesh.tones,
            families: &mesh.families,
            sensor: &sensor.name,
            density,
            fine: spectrum.fine.as_ref(),
        };
        artefacts::ledger(&self.run.scene, &self.prediction, motion, &seen)
    }

    /// How did speed and load go, and does the defect's family stand over the angle where the speed changes?
    pub(super) fn orders(
        &self,
        motion: &KinematicsFinding,
        sensors: &[SensorSignal],
        notes: &mut Vec<String>,
    ) -> Result<Orders, Error> {
        let mut duty = DutyFinding::of(&self.run.scene, self.record);
        if self.steady {
            return Ok(Orders { duty, spectrum: None });
        }
        notes.push(
            "the speed changes: families have orders and no frequencies, and the tables and figures of lines \
             at constant frequencies, the notch among them, are left out. Other frequencies are those at the \
             mean speed"
                .into(),
        );
        notes.extend(duty::note(&self.run.scene.written));
        let spectrum = order_spectrum(self.run, self.record, motion, sensors, duty.as_mut(), notes)?;
        Ok(Orders { duty, spectrum })
    }

    /// Which frequencies can the paper's cursor read at this sample rate? `None` for another scene than the
    /// paper's.
    pub(super) fn cursor(&self) -> Option<CursorReading> {
        if !self.of_paper {
            return None;
        }
        let element_size = self.run.scene.element_size;
        let pair = self.prediction.kinematics.paper_noise_hz(element_size);
        CursorReading::of(paper::CURSOR_HZ, self.record.sample_rate_hz(), paper::TONE_HZ, pair)
    }

    /// All answers together: the numbers and the signals behind them.
    pub(super) fn findings(self, answers: Answers) -> Findings {
        let record = self.record;
        let (start_s, interval_s) = (record.time_s().first().copied().unwrap_or(0.0), record.interval_s());
        let start_up_end_s = start_up_end_s(record.time_s(), &answers.crossings.events);
        let notch = answers.filter.as_ref().zip(answers.sensors.first());
        let notch = notch.map(|(f, s)| f.finding(&s.raw_g, &s.filtered_g, self.of_paper));
        let [begin_s, end_s] = record.stretch_s();
        let (run, cursor) = (self.run, self.cursor());
        let mut summary = Summary {
            scene: run.scene.written.name.clone(),
            status: run.info.status,
            mesh: run.info.mesh.clone(),
            run: RunCost::of(&run.info, record.len(), end_s - begin_s),
            energy: EnergyFinding::of(&run.info.energy),
            kinematics: answers.motion,
            duty: answers.orders.duty,
            events: answers.crossings.events,
            load: answers.load,
            families: answers.mesh.families,
            film: answers.film,
            tones: answers.mesh.tones,
            levels: answers.crossings.levels,
            notch,
            spectrum: answers.spectrum.finding,
            artefacts: answers.artefacts,
            envelope: answers.envelope.finding,
            diagnosis: answers.diagnosis,
            cursor,
            paper: Vec::new(),
            notes: answers.notes,
        };
        if self.of_paper {
            summary.paper = paper::rows(&run.scene, &run.info.mesh, &self.prediction, &summary);
        }
        Findings {
            summary,
            of_paper: self.of_paper,
            start_up_end_s,
            lines: answers.mesh.lines,
            modes: ring::outer_ring_modes(&run.scene, artefacts::LAST_MODE),
            start_s,
            interval_s,
            sensors: answers.sensors,
            crossings: Vec::new(),
            distribution: answers.carried.distribution(),
            support_n: answers.carried.into_support(),
            fine: answers.spectrum.fine,
            envelope: answers.envelope.spectrum,
            no_envelope: answers.envelope.why_not,
            orders: answers.orders.spectrum,
            static_curve: answers.at_rest.curve,
            family_signals: answers.mesh.signals,
            filter: answers.filter,
            prediction: self.prediction,
        }
    }
}
