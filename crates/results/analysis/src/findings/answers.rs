//! The answers to the questions that are put to a record, one type each.

use stribeck_dsp::Spectrum;

use super::SensorSignal;
use super::passages::Passages;
use super::spectra::Enveloped;
use crate::artefacts::Artefact;
use crate::diagnosis::DiagnosisFinding;
use crate::duty::DutyFinding;
use crate::enveloping::EnvelopeFinding;
use crate::families::{Channel, FamilyFinding, RecordedMotion};
use crate::film::FilmFinding;
use crate::filtering::Filter;
use crate::kinematics::KinematicsFinding;
use crate::load::{Carried, LoadFinding};
use crate::prediction::StaticCurve;
use crate::summary::{Event, LevelsFinding, SpectrumFinding};
use crate::tones::{PredictedLine, Tone};

/// Results of one pass over all rollers.
pub(super) struct Rollers<'a> {
    pub(super) motion: KinematicsFinding,
    pub(super) carried: Carried,
    pub(super) passages: Passages<'a>,
}

/// Lines of the facets.
pub(super) struct MeshLines {
    pub(super) lines: Vec<PredictedLine>,
    /// As measured one by one, at every sensor.
    pub(super) tones: Vec<Tone>,
    /// As found by their whole families.
    pub(super) families: Vec<FamilyFinding>,
    /// Motion and accelerations [g] that the families were fitted to.
    pub(super) signals: (RecordedMotion, Vec<Channel>),
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

/// The envelope spectrum of the leading sensor [g⁴] and its lines.
#[derive(Default)]
pub(super) struct EnvelopeAnswer {
    pub(super) spectrum: Option<Spectrum>,
    pub(super) finding: Option<EnvelopeFinding>,
    pub(super) why_not: Option<String>,
}

impl EnvelopeAnswer {
    /// A note gives the reason where there is none.
    pub(super) fn with_note(enveloped: Option<Enveloped>, notes: &mut Vec<String>) -> Self {
        match enveloped {
            Some(Ok((spectrum, finding))) => {
                Self { spectrum: Some(spectrum), finding: Some(finding), why_not: None }
            }
            Some(Err(why)) => {
                notes.push(why.clone());
                Self { why_not: Some(why), ..Self::default() }
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
