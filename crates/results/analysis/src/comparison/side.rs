//! One side of a comparison: a run, many starts of a scene, or a measured record.

use std::path::Path;

use serde::Serialize;
use serde_json::Value;
use stribeck_dsp::BandEnvelope;
use stribeck_dsp::channel::Channel;
use stribeck_scene::resolved::ResolvedScene;
use stribeck_scene::scene::Scene;
use stribeck_store::run_dir::{Run, RunDir};
use stribeck_store::run_info::Status;

use crate::Error;
use crate::diagnosis;
use crate::ensemble::{EnsembleFindings, Merged};
use crate::findings::{Findings, SensorSignal};
use crate::load::Distribution;
use crate::record::Record;
use crate::summary::Shape;
use stribeck_diagnosis::Defect;
use stribeck_diagnosis::STANDARD_GRAVITY;
use stribeck_diagnosis::{AccelerationUnit, Analysis, Family, Machine};

/// Samples that are kept of a trace, for a picture.
const SHOWN: usize = 1 << 16;

/// Kind of a side.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// One run.
    Run,
    /// Many starts of one scene.
    Ensemble,
    /// A measured record.
    Record,
}

/// A run, an ensemble or a record, as it is compared.
#[derive(Debug, Clone, Serialize)]
pub struct Side {
    /// Its label.
    pub label: String,
    /// Its kind.
    pub kind: Kind,
    /// The signal that is compared.
    pub channel: String,
    /// Its unit: g where it is an acceleration.
    pub unit: String,
    /// Samples a second [Hz].
    pub rate_hz: f64,
    /// Length of one signal [s].
    pub duration_s: f64,
    /// Speed of the shaft against the outer ring [1/s]; `None` where it is unknown or changes.
    pub shaft_hz: Option<f64>,
    /// The bearing in words, where it is known.
    pub bearing: Option<String>,
    /// Load [N], where it is known.
    pub load_n: Option<f64>,
    /// Signals: starts that are complete, or one.
    pub signals: usize,
    /// Verdict of each signal, or where signals disagree, the number of signals with each verdict; empty
    /// where none is long enough.
    pub verdict: String,
    /// Cautions.
    pub notes: Vec<String>,
    /// The scene of a run.
    #[serde(skip)]
    pub scene: Option<Scene>,
    /// Each signal.
    #[serde(skip)]
    pub members: Vec<Member>,
}

/// One signal of a side.
#[derive(Debug, Clone)]
pub struct Member {
    /// Its beginning.
    pub trace: Sampled,
    /// Its statistics; `None` for a constant one.
    pub shape: Option<Shape>,
    /// Root mean square of the velocity from 10 to 1000 Hz [mm/s], of an acceleration.
    pub velocity_mm_s: Option<f64>,
    /// The defect families, where speed and bearing are known.
    pub families: Vec<Family>,
    /// Power spectral density [unit²/Hz].
    pub density: Option<Sampled>,
    /// Squared envelope spectra by band.
    pub bands: Vec<BandEnvelope>,
    /// Mean force on a roller by angle; empty for a record.
    pub distribution: Distribution,
    /// Force of all rollers on the outer ring against the load [N]; empty for a record.
    pub support_n: Sampled,
    /// Numbers of `summary.json`; null for a record.
    pub summary: Value,
    /// Its verdict, without the scene.
    pub verdict: Option<String>,
}

/// Values at a constant step.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Sampled {
    /// Where the first one stands: time [s] or frequency [Hz].
    pub start: f64,
    /// Distance of the next one.
    pub step: f64,
    /// The values.
    pub values: Vec<f64>,
}

impl Member {
    /// Level of a family that is there [dB].
    pub fn level_db(&self, defect: Defect) -> Option<f64> {
        self.families.iter().find(|f| f.name == defect && f.is_there())?.level_db
    }

    /// Families that are claimed.
    pub fn claimed(&self) -> impl Iterator<Item = &Family> {
        self.families.iter().filter(|family| family.claimed)
    }

    /// The signal of a run at its sensor number `sensor`, with the run's numbers.
    fn of_findings(scene: &ResolvedScene, findings: Findings, sensor: usize) -> Result<Self, Error> {
        let SensorSignal { name, raw_g, raw_density, .. } = &findings.sensors[sensor];
        let shape = Shape::of(raw_g);
        let (start, step) = (findings.start_s, findings.interval_s);
        let analysis = judged(scene, &channel_name(name), raw_g, 1.0 / step)?;
        let density = match (&analysis, raw_density) {
            (Some(analysis), _) => density(analysis, 1.0),
            (None, Some(spectrum)) => Some(Sampled {
                start: 0.0,
                step: spectrum.resolution().grid_hz,
                values: spectrum.values().to_vec(),
            }),
            (None, None) => None,
        };
        let beginning =
            |values: &[f64]| Sampled { start, step, values: values[..values.len().min(SHOWN)].to_vec() };
        let (velocity_mm_s, families, verdict, bands) = match analysis {
            Some(Analysis { findings: f, bands, .. }) => {
                (f.velocity_mm_s, f.families, Some(f.verdict), bands)
            }
            None => (None, Vec::new(), None, Vec::new()),
        };
        Ok(Self {
            trace: beginning(raw_g),
            shape,
            velocity_mm_s,
            families,
            density,
            bands,
            support_n: beginning(&findings.support_n),
            summary: serde_json::to_value(&findings.summary).map_err(Error::Summary)?,
            distribution: findings.distribution,
            verdict,
        })
    }
}

/// Verdict of a run's signal, without the scene; `None` where it is too short, or constant. Where the speed
/// changes no family has a frequency.
fn judged(
    scene: &ResolvedScene,
    name: &str,
    signal_g: &[f64],
    rate_hz: f64,
) -> Result<Option<Analysis>, Error> {
    let machine = if scene.written.operation.speed_varies() {
        Machine::default()
    } else {
        diagnosis::machine(scene, &scene.written.kinematics())
    };
    let unit = AccelerationUnit::Gravity.symbol().to_owned();
    let channel = Channel::held(name.to_owned(), signal_g.to_vec()).in_unit(Some(unit));
    // The file's rounding of times moves the rate by far less than a tenth of a hertz.
    match Analysis::of(&channel, (10.0 * rate_hz).round() / 10.0, &machine) {
        Err(stribeck_diagnosis::Error::NoSignal(_)) => Ok(None),
        analysis => Ok(Some(analysis?)),
    }
}

/// The density of a record whose unit is `factor` of the one that is shown.
fn density(analysis: &Analysis, factor: f64) -> Option<Sampled> {
    let (frequencies, values) = &analysis.density;
    let step = *frequencies.get(1)?;
    Some(Sampled { start: 0.0, step, values: values.iter().map(|p| factor * factor * p).collect() })
}

fn channel_name(sensor: &str) -> String {
    format!("sensor.{sensor}.ay_m_s2")
}

/// Number of the sensor whose channel name contains `asked`; without one, the leading one.
fn sensor(findings: &Findings, asked: Option<&str>) -> Result<usize, Error> {
    let names: Vec<String> = findings.sensors.iter().map(|s| channel_name(&s.name)).collect();
    let found = names.iter().position(|name| asked.is_none_or(|asked| name.contains(asked)));
    found.ok_or_else(|| {
        Error::NoSignal(match (names.is_empty(), asked) {
            (true, _) | (_, None) => {
                "the run recorded no sensor; give its scene an `output.sensors`".to_owned()
            }
            (false, Some(asked)) => {
                format!("no sensor channel contains `{asked}`; the run has `{}`", names.join("`, `"))
            }
        })
    })
}

impl Side {
    /// The run or ensemble in `folder`, called `label`, by the sensor whose channel contains `channel`.
    ///
    /// # Errors
    /// [`Error::Run`] when the folder holds neither or its scene was changed, [`Error::NoSignal`] when no
    /// start is complete, or no sensor was recorded.
    pub fn of_folder(label: &str, folder: &Path, channel: Option<&str>) -> Result<Self, Error> {
        if RunDir::is_ensemble(folder) {
            let all = EnsembleFindings::of(folder)?;
            if all.complete.is_empty() {
                return Err(Error::NoSignal(format!("no start of `{label}` is complete")));
            }
            let findings = all.complete.into_iter().map(|(_, findings)| findings).collect();
            let mut side = Self::of_starts(label, Kind::Ensemble, &all.scene, findings, channel)?;
            side.notes = all.summary.notes;
            return Ok(side);
        }
        let run = Run::read(folder)?;
        run.check_scene(folder)?;
        let findings = Findings::of(&Record::new(&run)?)?;
        let mut side = Self::of_starts(label, Kind::Run, &run.scene, vec![findings], channel)?;
        side.notes = run.damage();
        if run.info.status != Status::Complete {
            let why = run.info.stop_reason.as_deref().unwrap_or("it was stopped");
            side.notes.push(format!("the run did not come to its end: {why}"));
        }
        side.notes.extend(run.info.warnings.iter().map(|warning| format!("warning of the run: {warning}")));
        Ok(side)
    }

    fn of_starts(
        label: &str,
        kind: Kind,
        scene: &ResolvedScene,
        findings: Vec<Findings>,
        channel: Option<&str>,
    ) -> Result<Self, Error> {
        let written = &scene.written;
        let (mut members, mut name) = (Vec::new(), String::new());
        let (mut duration_s, mut rate_hz) = (0.0, 0.0);
        for findings in findings {
            let number = sensor(&findings, channel)?;
            let signal = &findings.sensors[number];
            rate_hz = (10.0 / findings.interval_s).round() / 10.0;
            duration_s = findings.interval_s * signal.raw_g.len() as f64;
            name = channel_name(&signal.name);
            members.push(Member::of_findings(scene, findings, number)?);
        }
        let steady = !written.operation.speed_varies();
        let designation = written.bearing.designation.as_str();
        Ok(Self {
            label: label.to_owned(),
            kind,
            channel: name,
            unit: AccelerationUnit::Gravity.symbol().to_owned(),
            rate_hz,
            duration_s,
            shaft_hz: steady
                .then(|| (written.operation.speed_rpm - written.operation.outer_speed_rpm).abs() / 60.0),
            bearing: Some(if designation.is_empty() {
                format!("{} rollers", written.bearing.rollers)
            } else {
                designation.to_owned()
            }),
            load_n: (!written.operation.load_varies()).then_some(written.operation.load_n),
            signals: members.len(),
            verdict: verdict(&members),
            notes: Vec::new(),
            scene: Some(written.clone()),
            members,
        })
    }

    /// A measured record, called `label`.
    pub fn of_record(label: &str, analysis: &Analysis) -> Self {
        let f = &analysis.findings;
        let unit = f.acceleration_unit();
        // Accelerations are shown in g, whatever their record has.
        let factor = unit.map_or(1.0, |unit| unit.in_m_s2() / STANDARD_GRAVITY);
        let name = match unit {
            Some(_) => AccelerationUnit::Gravity.symbol().to_owned(),
            None => f.unit.clone().unwrap_or_default(),
        };
        let beginning = &analysis.beginning[..analysis.beginning.len().min(SHOWN)];
        let member = Member {
            trace: Sampled {
                start: 0.0,
                step: 1.0 / f.rate_hz,
                values: beginning.iter().map(|x| factor * x).collect(),
            },
            shape: Some(Shape {
                rms: factor * f.health.rms,
                peak: factor * f.health.peak,
                kurtosis: f.health.kurtosis,
            }),
            velocity_mm_s: f.velocity_mm_s,
            families: f.families.clone(),
            density: density(analysis, factor),
            bands: analysis.bands.clone(),
            distribution: Distribution::default(),
            support_n: Sampled::default(),
            summary: Value::Null,
            verdict: Some(f.verdict.clone()),
        };
        Self {
            label: label.to_owned(),
            kind: Kind::Record,
            channel: f.channel.clone(),
            unit: name,
            rate_hz: f.rate_hz,
            duration_s: f.duration_s,
            shaft_hz: f.speed_rpm.map(|rpm| rpm / 60.0),
            bearing: f.bearing.clone(),
            load_n: None,
            signals: 1,
            verdict: f.verdict.clone(),
            notes: f.notes.clone(),
            scene: None,
            members: vec![member],
        }
    }

    /// The numbers of all its runs as one; nothing for a record.
    pub(super) fn merged(&self) -> Result<Merged, Error> {
        Merged::of(self.members.iter().map(|member| &member.summary).filter(|summary| !summary.is_null()))
    }
}

/// One verdict for all signals of a side.
fn verdict(members: &[Member]) -> String {
    let all: Vec<&str> = members.iter().filter_map(|m| m.verdict.as_deref()).collect();
    let [first, ..] = &all[..] else { return String::new() };
    if members.len() == 1 {
        return (*first).to_owned();
    }
    let count = |defect: Defect| members.iter().filter(|m| m.claimed().any(|f| f.name == defect)).count();
    let claimed = Defect::ALL.into_iter().filter(|d| count(*d) > 0);
    let words: Vec<String> =
        claimed.map(|d| format!("{} is claimed in {} of {} starts", d, count(d), members.len())).collect();
    if words.is_empty() {
        format!("No defect is claimed in any of {} starts.", members.len())
    } else {
        words.join(", ") + "."
    }
}
