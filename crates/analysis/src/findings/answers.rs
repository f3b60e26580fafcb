//! The answers to the questions of [`Case`](super::case::Case), and what they come to together.

use stribeck_dsp::Spectrum;

use super::case::Case;
use super::passages::{Passages, start_up_end_s};
use super::spectra::Enveloped;
use super::{Findings, SensorSignal};
use crate::artefacts::{self, Artefact};
use crate::diagnosis::DiagnosisFinding;
use crate::duty::DutyFinding;
use crate::enveloping::EnvelopeFinding;
use crate::families::{Channel, FamilyFinding, Motion};
use crate::film::FilmFinding;
use crate::filtering::Filter;
use crate::kinematics::KinematicsFinding;
use crate::load::{Carried, LoadFinding};
use crate::paper;
use crate::prediction::StaticCurve;
use crate::ring;
use crate::summary::{EnergyFinding, Event, LevelsFinding, RunCost, SpectrumFinding, Summary};
use crate::tones::{PredictedLine, Tone};

/// What one pass over all rollers yields.
pub(super) struct Rollers<'a> {
    pub(super) motion: KinematicsFinding,
    pub(super) carried: Carried,
    pub(super) passages: Passages<'a>,
}

/// Lines of the facets.
pub(super) struct MeshLines {
    /// As predicted.
    pub(super) lines: Vec<PredictedLine>,
    /// As measured one by one, at every sensor.
    pub(super) tones: Vec<Tone>,
    /// As found by their whole families.
    pub(super) families: Vec<FamilyFinding>,
    /// Motion and accelerations [g] that the families were fitted to.
    pub(super) signals: (Motion, Vec<Channel>),
}

/// The load between rigid rings.
pub(super) struct AtRest {
    /// Force of all rollers along the load [N].
    pub(super) expected_n: f64,
    /// Its distribution; `None` where the rings find no equilibrium.
    pub(super) curve: Option<StaticCurve>,
}

/// Passages of rollers over spalls.
pub(super) struct Crossings {
    pub(super) events: Vec<Event>,
    pub(super) levels: LevelsFinding,
}

/// The spectrum of the leading sensor.
pub(super) struct LeadingSpectrum {
    pub(super) finding: Option<SpectrumFinding>,
    /// Density of the whole record [g²/Hz], where only this shows the defect's family.
    pub(super) fine: Option<Spectrum>,
}

/// The envelope spectrum of the leading sensor [g⁴] and what stands in it.
#[derive(Default)]
pub(super) struct EnvelopeAnswer {
    spectrum: Option<Spectrum>,
    finding: Option<EnvelopeFinding>,
}

impl EnvelopeAnswer {
    /// A note says why there is none.
    pub(super) fn with_note(enveloped: Option<Enveloped>, notes: &mut Vec<String>) -> Self {
        match enveloped {
            Some(Ok((spectrum, finding))) => Self { spectrum: Some(spectrum), finding: Some(finding) },
            Some(Err(why)) => {
                notes.push(why);
                Self::default()
            }
            None => Self::default(),
        }
    }
}

/// Speed and load over time, and the order spectrum.
pub(super) struct Orders {
    pub(super) duty: Option<DutyFinding>,
    /// Squared envelope spectrum over the angle of the shaft [g⁴].
    pub(super) spectrum: Option<Spectrum>,
}

/// All answers to the questions that are put to a record.
pub(super) struct Answers {
    pub(super) motion: KinematicsFinding,
    pub(super) carried: Carried,
    pub(super) diagnosis: Option<DiagnosisFinding>,
    pub(super) sensors: Vec<SensorSignal>,
    pub(super) mesh: MeshLines,
    pub(super) filter: Option<Filter>,
    pub(super) at_rest: AtRest,
    pub(super) crossings: Crossings,
    pub(super) load: LoadFinding,
    pub(super) spectrum: LeadingSpectrum,
    pub(super) artefacts: Vec<Artefact>,
    pub(super) envelope: EnvelopeAnswer,
    pub(super) orders: Orders,
    pub(super) film: Option<FilmFinding>,
    pub(super) notes: Vec<String>,
}

impl Answers {
    /// Numbers and signals of the case.
    pub(super) fn findings(self, case: Case<'_>) -> Findings {
        let record = case.record;
        let (start_s, interval_s) = (record.time_s().first().copied().unwrap_or(0.0), record.interval_s());
        let start_up_end_s = start_up_end_s(record.time_s(), &self.crossings.events);
        let notch = self.filter.as_ref().zip(self.sensors.first());
        let notch = notch.map(|(f, s)| f.finding(&s.raw_g, &s.filtered_g, case.of_paper));
        let [begin_s, end_s] = record.stretch_s();
        let (run, cursor) = (case.run, case.cursor());
        let mut summary = Summary {
            scene: run.scene.name.clone(),
            status: run.info.status,
            mesh: run.info.mesh.clone(),
            run: RunCost::of(&run.info, record.len(), end_s - begin_s),
            energy: EnergyFinding::of(&run.info.energy),
            kinematics: self.motion,
            duty: self.orders.duty,
            events: self.crossings.events,
            load: self.load,
            families: self.mesh.families,
            film: self.film,
            tones: self.mesh.tones,
            levels: self.crossings.levels,
            notch,
            spectrum: self.spectrum.finding,
            artefacts: self.artefacts,
            envelope: self.envelope.finding,
            diagnosis: self.diagnosis,
            cursor,
            paper: Vec::new(),
            notes: self.notes,
        };
        if case.of_paper {
            summary.paper = paper::rows(&run.scene, &run.info.mesh, &case.prediction, &summary);
        }
        Findings {
            summary,
            of_paper: case.of_paper,
            start_up_end_s,
            lines: self.mesh.lines,
            modes: ring::outer_ring_modes(&run.scene, artefacts::LAST_MODE),
            start_s,
            interval_s,
            sensors: self.sensors,
            crossings: Vec::new(),
            distribution: self.carried.distribution(),
            support_n: self.carried.into_support(),
            fine: self.spectrum.fine,
            envelope: self.envelope.spectrum,
            orders: self.orders.spectrum,
            static_curve: self.at_rest.curve,
            family_signals: self.mesh.signals,
            filter: self.filter,
            prediction: case.prediction,
        }
    }
}
