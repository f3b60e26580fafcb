//! From the samples of a run to its [`Summary`] and to the signals that the figures draw.

mod answers;
mod case;
mod levels;
mod passages;
mod sensors;
mod spectra;

use stribeck_dsp::Spectrum;

use self::answers::{Answers, EnvelopeAnswer, Rollers};
use self::case::Case;
use self::passages::crossing_forces;
use crate::Error;
use crate::diagnosis;
use crate::families::{Channel, RecordedMotion};
use crate::film::FilmFinding;
use crate::filtering::Filter;
use crate::load::Distribution;
use crate::prediction::{Prediction, StaticCurve};
use crate::record::Record;
use crate::summary::Summary;
use crate::tones;

/// Grid of the spectra [Hz]: the paper's 3 Hz. The resolution is that of the record.
const GRID_HZ: f64 = 3.0;
/// Harmonics of each facet line that are searched; the paper reports the fifth.
const HARMONICS: usize = 6;
/// Shortest record for a spectrum [samples].
const SHORTEST_SPECTRUM: usize = 64;

/// Results of a run: the numbers and the signals behind them.
#[derive(Debug)]
pub struct Findings {
    /// The numbers.
    pub summary: Summary,
    /// True for a scene of the paper's dimensions.
    pub of_paper: bool,
    /// Prediction from geometry and speed.
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
    /// Force of all rollers on the outer ring against the load at every sample [N]; empty where no roller was
    /// recorded.
    pub support_n: Vec<f64>,
    /// Mean roller force by angle.
    pub distribution: Distribution,
    /// Density of the leading sensor over the whole record [g²/Hz], where the segments of its other spectrum
    /// hold too few periods of the defect's family and the record enough.
    pub fine: Option<Spectrum>,
    /// Squared envelope spectrum of the leading sensor [g⁴]; `None` when the record is too short.
    pub envelope: Option<Spectrum>,
    /// Why there is none.
    pub no_envelope: Option<String>,
    /// Squared envelope spectrum of the leading sensor over the angle of the shaft [g⁴], its frequencies
    /// orders; `None` for a speed that does not change, or a record too short.
    pub orders: Option<Spectrum>,
    /// Static roller force by angle, when rigid rings find one.
    pub static_curve: Option<StaticCurve>,
    /// Recorded motion and accelerations [g] that the families of facet lines were fitted to.
    pub family_signals: (RecordedMotion, Vec<Channel>),
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
    /// The notch at this sensor's facet tone; where it has none, at that of the record.
    pub notch: Option<Filter>,
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
    /// Whether it is the vertical force of the outer raceway, as in the paper, or that along the normal of
    /// the spall's raceway.
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
    /// Analyses a record. An interrupted or diverged run is analysed as far as it has samples.
    ///
    /// # Errors
    /// [`Error::Run`] when the trace cannot be read, [`Error::Signal`] when a finite recorded signal is
    /// refused nevertheless.
    pub fn of(record: &Record<'_>) -> Result<Self, Error> {
        let case = Case::of(record);
        let mut notes = case.caveats();
        // The transforms of a whole record come before the signals of all sensors are in memory.
        let analysis = case.judged_by_itself()?;
        let Rollers { motion, carried, passages } = case.rollers()?;
        let diagnosis = analysis.map(|analysis| diagnosis::of(&case.run.scene, &motion, &analysis));
        let enveloped = case.envelope(&motion)?;
        let mut sensors = case.sensors(&mut notes)?;
        let mesh = case.mesh_lines(&motion, &sensors, &mut notes)?;
        let filter = case.notch(&mesh, &mut sensors, &mut notes)?;
        let at_rest = case.at_rest(&mut notes);
        let crossings = case.crossings(passages, &at_rest, (&sensors, &mesh), filter.as_ref(), &mut notes)?;
        let load = case.load(&carried, &at_rest, &motion, &mut notes);
        let spectrum = case.spectrum(&sensors)?;
        let artefacts = case.artefacts(&mesh, &motion, &sensors, &spectrum)?;
        let envelope = EnvelopeAnswer::with_note(enveloped, &mut notes);
        let orders = case.orders(&motion, &sensors, &mut notes)?;
        let film = FilmFinding::measure(case.run, record)?;
        let answers = Answers {
            motion,
            carried,
            diagnosis,
            sensors,
            mesh,
            filter,
            at_rest,
            crossings,
            load,
            spectrum,
            artefacts,
            envelope,
            orders,
            film,
            notes,
        };
        Ok(case.findings(answers))
    }

    /// The same with the forces of the first `most` passages, for pictures.
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
