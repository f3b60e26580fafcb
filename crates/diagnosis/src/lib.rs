//! A measured signal: is it valid, which defect families does it hold, and what may be concluded?
//!
//! It is a crate because it serves any measured record: it knows neither scenes nor runs.
//!
//! [`Analysis::of`] passes once over the samples, block by block, so that a record of hours takes no more
//! memory than one of seconds. Whether a family is claimed is decided in `families/decision.rs`, after what
//! `families/verdict.rs` has found; the sentence is made in `words/sentence.rs`. Source: THEORY §7.9.
//!
//! ```
//! use stribeck_diagnosis::{Analysis, Defect, Machine};
//! use stribeck_dsp::channel::Channel;
//! use stribeck_theory::catalogue::CatalogueBearing;
//!
//! // Knocks at 3.585 times 20 Hz that ring at 3 kHz, in noise.
//! let rate_hz = 12_800.0;
//! let mut seed = 1_u64;
//! let samples: Vec<f64> = (0..65_536)
//!     .map(|n| {
//!         seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
//!         let noise = (seed >> 40) as f64 / (1_u64 << 24) as f64 - 0.5;
//!         let since = (n as f64 / rate_hz).rem_euclid(1.0 / 71.7);
//!         noise + 2.0 * (-since / 1e-3).exp() * (std::f64::consts::TAU * 3_000.0 * since).sin()
//!     })
//!     .collect();
//! let machine = Machine {
//!     speed_rpm: Some(1200.0),
//!     bearing: Some(CatalogueBearing::parse("6205")?),
//!     ..Machine::default()
//! };
//! let analysis = Analysis::of(&Channel::held("housing", samples), rate_hz, &machine)?;
//! let families = analysis.findings.families.iter();
//! let claimed: Vec<Defect> = families.filter(|f| f.claimed).map(|f| f.name).collect();
//! assert_eq!(claimed, [Defect::Bpfo]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod families;
pub mod joint;
pub mod length;
pub mod record;
pub mod sources;
pub mod speed;
pub mod words;

mod error;

use serde::Serialize;
use stribeck_dsp::channel::Channel;
use stribeck_dsp::{BandEnvelope, BandEnvelopes};
use stribeck_theory::catalogue::CatalogueBearing;

pub use error::Error;
pub use families::defect::Defect;
pub use families::family::{Family, Reason};
pub use families::sidebands::sidebands_seen;
pub use families::unexplained::Unexplained;
use families::{halves, second, verdict};
pub use length::estimate::SHORTEST_S;
pub use length::pressed::{Pressed, usual_load_n};
pub use record::course::Course;
pub use record::enhanced::Enhanced;
use record::pass::Pass;
pub use record::screening::Health;
pub use record::unit::{AccelerationUnit, STANDARD_GRAVITY};
use record::velocity::VelocityLevel;
use record::{enhanced, zone};
pub use speed::angular::over_angle;
pub use speed::varying::Varying;
use speed::{estimate, half_speed, shaft};

/// Speed and bearing of the machine, as far as they are known.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Machine {
    /// Speed of the shaft, against the outer ring where that turns [1/min].
    pub speed_rpm: Option<f64>,
    /// Speed of the outer ring, positive where it turns as the shaft does against it [1/min].
    pub outer_speed_rpm: f64,
    /// Its bearing.
    pub bearing: Option<CatalogueBearing>,
    /// The speed is measured, or that of a run: the lines of the shaft do not correct it.
    pub speed_is_exact: bool,
    /// Radial load, least and most [N]; `None` for the usual loads of such bearings.
    pub load_n: Option<(f64, f64)>,
    /// Radial internal clearance in operation, least and most [µm]; `None` for none.
    pub clearance_um: Option<(f64, f64)>,
    /// Compliance of the outer ring and its housing at the loaded place, least and most [µm/kN]; `None` for a
    /// rigid one.
    pub housing_um_per_kn: Option<(f64, f64)>,
    /// How far an element is pressed together over a spall, by simulation; `None` to compute it for rigid
    /// rings from load, clearance and compliance.
    pub pressed: Option<Pressed>,
    /// Other shafts, gears and bearings.
    pub around: sources::Surroundings,
}

/// Contents of `findings.json`. A number that the record cannot yield is `null`, with the reason in `notes`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MeasuredFindings {
    /// The channel.
    pub channel: String,
    /// Its unit, if known.
    pub unit: Option<String>,
    /// Sample rate [Hz].
    pub rate_hz: f64,
    /// Samples read.
    pub samples: u64,
    /// Length of the record [s].
    pub duration_s: f64,
    /// Speed of the shaft that was taken [1/min].
    pub speed_rpm: Option<f64>,
    /// The user's speed, where the lines of the shaft correct it [1/min].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed_given_rpm: Option<f64>,
    /// Uncertainty of a speed that was found in the record alone [1/min].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed_uncertainty_rpm: Option<f64>,
    /// The bearing, in words.
    pub bearing: Option<String>,
    /// Resolution of the envelope spectra: one over the length of a segment [Hz].
    pub resolution_hz: f64,
    /// Segments averaged.
    pub segments: usize,
    /// Numbers that describe the signal as a whole.
    pub health: Health,
    /// Root mean square of the velocity from 10 to 1000 Hz [mm/s], for accelerations in m/s² or g.
    pub velocity_mm_s: Option<f64>,
    /// Its zone by ISO 20816-3, where group and foundation of the machine are known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub zone: Option<zone::Zoned>,
    /// The defect families; none without speed and bearing.
    pub families: Vec<Family>,
    /// A comb that knocks, is no family's of this bearing, and stands higher than all that are.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unexplained: Option<Unexplained>,
    /// The conclusion in one sentence.
    pub verdict: String,
    /// Length of a spall, from two events a passage [mm].
    pub spall_mm: Option<Interval>,
    /// Length of a spall longer than half of the distance of two elements, whose exit and the entry of the
    /// next element are as far apart as these events [mm].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spall_otherwise_mm: Option<Interval>,
    /// Time between these events [ms].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub event_spacing_ms: Option<f64>,
    /// Where a passage has a single event: the spall is shorter than this, if entry and exit both knock [mm].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spall_below_mm: Option<f64>,
    /// Limits of the conclusion.
    pub notes: Vec<String>,
}

impl MeasuredFindings {
    /// The unit of the channel; `None` where it is unknown, or not an acceleration.
    pub fn acceleration_unit(&self) -> Option<AccelerationUnit> {
        self.unit.as_deref().and_then(AccelerationUnit::parse)
    }
}

/// A value with its interval of 90 %.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Interval {
    /// Best estimate.
    pub value: f64,
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

/// The numbers and the curves that a report draws.
#[derive(Debug, Clone)]
pub struct Analysis {
    /// The numbers.
    pub findings: MeasuredFindings,
    /// The first samples, for a picture.
    pub beginning: Vec<f64>,
    /// Power spectral density: frequencies [Hz] and values [unit²/Hz].
    pub density: (Vec<f64>, Vec<f64>),
    /// Squared envelope spectra of all bands.
    pub bands: Vec<BandEnvelope>,
    /// The same over the period of the defect that stands highest; none without a defect.
    pub over: Vec<BandEnvelope>,
    /// Density over time.
    pub course: Course,
    /// Spectra over speed and angle where the speed varies; filled by the caller, which has the times of the
    /// turns.
    pub varying: Option<Varying>,
    /// Enhanced envelope spectrum of the beginning; `None` for a record too short for it.
    pub enhanced: Option<Enhanced>,
}

/// Levels of the dyadic tree of bands: halves, quarters, eighths.
const LEVELS: u32 = 3;
/// Lower end of the lowest bands as a part of half the sample rate: below lie the shaft and its multiples.
const LOWEST: f64 = 0.02;
/// Highest frequency of the envelope spectra [Hz]; bearings knock more slowly.
const HIGHEST_HZ: f64 = 4_000.0;
/// Samples kept for the picture.
const SHOWN: usize = 1 << 16;
/// Harmonics of the fastest family in the enhanced envelope spectrum.
const HARMONICS: f64 = 3.2;
/// Its highest frequency when no family is known [Hz].
const UNKNOWN_HZ: f64 = 500.0;
/// Shortest record that is analysed [samples].
const LEAST: usize = 1024;

impl Analysis {
    /// Analyses a channel sampled `rate_hz` times a second.
    ///
    /// # Errors
    /// [`Error::File`] when it cannot be read, [`Error::NoSignal`] for a record that is too short or
    /// constant, [`Error::Signal`] when it cannot be processed.
    pub fn of(channel: &Channel, rate_hz: f64, machine: &Machine) -> Result<Self, Error> {
        if !rate_hz.is_finite() || rate_hz <= 0.0 {
            return Err(Error::NoSignal(format!("a sample rate of {rate_hz} Hz; give one above 0")));
        }
        let len = usize::try_from(channel.len).unwrap_or(usize::MAX);
        if len < LEAST {
            return Err(Error::NoSignal(format!(
                "channel `{}` holds {len} samples; {LEAST} are the least",
                channel.name
            )));
        }
        let pass = Pass::over(channel, rate_hz, len)?;
        let segment = pass.segment;
        let mut notes = pass.notes(rate_hz);
        pass.refuse(channel, &notes)?;
        notes.extend(pass.remainder_note(rate_hz, len));
        let Pass { envelopes, density, tracing, velocity, screening, kept, .. } = pass;
        let density = density.finish();
        let Some(health) = screening.health(&density.1) else {
            return Err(Error::NoSignal(format!(
                "channel `{}` is constant; is the sensor connected?",
                channel.name
            )));
        };
        let (bands, segments) = (envelopes.bands(), envelopes.segments());
        // The steps below need memory for their own transforms.
        drop(envelopes);
        let resolution_hz = rate_hz / segment as f64;
        let (record_s, segment_s) = (screening.count() as f64 / rate_hz, segment as f64 / rate_hz);
        let found = found_speed(&kept, rate_hz, &bands, machine, &mut notes);
        let machine = &Machine {
            speed_rpm: machine.speed_rpm.or(found.map(|found| 60.0 * found.hz)),
            speed_is_exact: machine.speed_is_exact || found.is_some(),
            ..machine.clone()
        };
        let shaft = shaft_by_lines(&kept, rate_hz, machine);
        let given_rpm = machine.speed_rpm;
        let sharp = sharp_speed(shaft, &kept, rate_hz, &bands, machine);
        let corrected_hz = sharp.and_then(|sharp| sharp.correction(machine, &mut notes));
        let machine = &Machine {
            speed_rpm: corrected_hz.map_or(machine.speed_rpm, |hz| Some(60.0 * hz)),
            ..machine.clone()
        };
        let known = verdict::KnownSpeed {
            sharp_hz: sharp.map(|sharp| sharp.hz),
            by_its_lines: shaft.is_some_and(|shaft| shaft.is_distinct()),
        };
        let mut judged = verdict::judge(&bands, machine, &known, record_s, segment_s);
        let halved = half_speed::told(&judged, &kept, rate_hz, &bands, machine).and_then(|half| {
            let (machine, again) = half_speed::judge(half, &bands, machine, (record_s, segment_s))?;
            judged = again;
            Some((half, machine))
        });
        let machine = halved.as_ref().map_or(machine, |(_, machine)| machine);
        let mut over = Vec::new();
        if let Some(first) = &judged.first {
            over = over_period(channel, rate_hz, segment, first.comb_hz)?;
            second::tell(&mut judged.families, first, bands.first(), &over);
        }
        one_half_only(&mut judged.families, &kept, rate_hz)?;
        judged.conclude(&bands);
        let said = halved.as_ref().zip(given_rpm).map(|((half, _), rpm)| half_speed::sentence(*half, rpm));
        judged.verdict.extend(said.iter().flat_map(|said| [" ", said.as_str()]));
        notes.extend(judged.notes.iter().cloned());
        let spall = length::estimate::estimate(&kept, rate_hz, machine, &judged.families);
        notes.push(spall.note);
        let enhanced = enhanced::of(&kept, rate_hz, enhanced_up_to_hz(&judged.families))?;
        Ok(Self {
            findings: MeasuredFindings {
                channel: channel.name.clone(),
                unit: channel.unit.clone(),
                rate_hz,
                samples: screening.count(),
                duration_s: screening.count() as f64 / rate_hz,
                speed_rpm: machine.speed_rpm,
                speed_given_rpm: (corrected_hz.is_some() || halved.is_some()).then_some(given_rpm).flatten(),
                speed_uncertainty_rpm: found.map(|found| 60.0 * found.uncertainty_hz),
                bearing: machine.bearing.as_ref().map(|b| format!("{}: {b}", b.name)),
                resolution_hz,
                segments,
                health,
                velocity_mm_s: velocity.as_ref().and_then(VelocityLevel::finish),
                zone: None,
                families: judged.families,
                unexplained: judged.unexplained,
                verdict: judged.verdict,
                spall_mm: spall.length_mm,
                spall_otherwise_mm: spall.otherwise_mm,
                event_spacing_ms: spall.spacing_ms,
                spall_below_mm: spall.below_mm,
                notes,
            },
            beginning: kept.into_iter().take(SHOWN).collect(),
            density,
            bands,
            over,
            course: tracing.finish(),
            varying: None,
            enhanced,
        })
    }

    /// The band of the family that stands highest; without one that knocks most [Hz].
    pub fn leading_band_hz(&self) -> Option<(f64, f64)> {
        let there = self.findings.families.iter().filter(|f| f.is_there() && f.band_hz.is_some());
        let leading = there.min_by(|a, b| a.p_value.total_cmp(&b.p_value)).and_then(|f| f.band_hz);
        let most = self.bands.iter().max_by(|a, b| a.kurtosis.total_cmp(&b.kurtosis));
        leading.or_else(|| most.map(|band| (band.low_hz, band.high_hz)))
    }

    /// The band in which a family stands highest.
    pub fn band_of(&self, family: &Family) -> Option<&BandEnvelope> {
        let (low_hz, high_hz) = family.band_hz?;
        let bands = if family.over.is_some() { &self.over } else { &self.bands };
        bands.iter().find(|b| b.low_hz == low_hz && b.high_hz == high_hz)
    }
}

/// A speed found by the lines of a record.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Sharp {
    hz: f64,
    uncertainty_hz: f64,
    /// Which lines.
    by: &'static str,
}

impl Sharp {
    /// The speed [Hz] where it corrects a given one, with a note.
    fn correction(self, machine: &Machine, notes: &mut Vec<String>) -> Option<f64> {
        let rpm = machine.speed_rpm?;
        shaft::is_correction(self.hz, rpm / 60.0).then_some(())?;
        notes.push(format!(
            "{} stand at {:.1} ± {:.1} rpm, {:+.1} % from the {rpm:.1} rpm that were given, and are taken",
            self.by,
            60.0 * self.hz,
            60.0 * self.uncertainty_hz,
            100.0 * (60.0 * self.hz / rpm - 1.0)
        ));
        Some(self.hz)
    }
}

/// The speed by the lines of the shaft, or, where these do not decide, by those of shaft and bearing
/// together. An exact one is only refined.
fn sharp_speed(
    shaft: Option<shaft::Shaft>,
    samples: &[f64],
    rate_hz: f64,
    bands: &[BandEnvelope],
    machine: &Machine,
) -> Option<Sharp> {
    let given_hz = machine.speed_rpm.filter(|rpm| *rpm > 0.0)? / 60.0;
    if let Some(shaft) = shaft.filter(|shaft| shaft.is_distinct()) {
        let sharp =
            Sharp { hz: shaft.hz, uncertainty_hz: shaft.uncertainty_hz, by: "the lines of the shaft" };
        return Some(sharp)
            .filter(|sharp| !(machine.speed_is_exact && shaft::is_correction(sharp.hz, given_hz)));
    }
    let asked = !machine.speed_is_exact && machine.outer_speed_rpm == 0.0;
    let bearing = machine.bearing.as_ref().filter(|_| asked)?;
    samples.iter().all(|x| x.is_finite()).then_some(())?;
    let found =
        estimate::near(samples, rate_hz, bands, bearing, given_hz).filter(|found| found.is_accepted)?;
    let by = "the lines of the shaft and of the bearing together";
    Some(Sharp { hz: found.hz, uncertainty_hz: found.uncertainty_hz, by })
}

/// The speed by shaft and bearing together, where the user gives none; a note where it is not found.
fn found_speed(
    samples: &[f64],
    rate_hz: f64,
    bands: &[BandEnvelope],
    machine: &Machine,
    notes: &mut Vec<String>,
) -> Option<estimate::SpeedEstimate> {
    let bearing = machine.bearing.as_ref().filter(|_| machine.speed_rpm.is_none())?;
    samples.iter().all(|x| x.is_finite()).then_some(())?;
    let found = estimate::without_any_given(samples, rate_hz, bands, bearing)?;
    let (rpm, next_rpm, lead) = (60.0 * found.hz, 60.0 * found.next_hz, found.lead);
    notes.push(if found.is_accepted {
        format!(
            "no speed was given: the lines of the shaft and of the bearing together say {rpm:.1} ± {:.1} \
             rpm, of all speeds from {:.0} to {:.0} rpm. The next best is {next_rpm:.0} rpm, {lead:.0} \
             behind in the logarithm of the likelihood, where {:.0} are asked",
            60.0 * found.uncertainty_hz,
            60.0 * estimate::FROM_HZ,
            60.0 * estimate::TO_HZ,
            estimate::LEAST_LEAD
        )
    } else {
        format!(
            "the record does not determine the speed: {rpm:.0} and {next_rpm:.0} rpm, among others, explain \
             about as much of it"
        )
    });
    found.is_accepted.then_some(found)
}

/// The shaft by its lines, where a speed is given and the outer ring stands still.
fn shaft_by_lines(samples: &[f64], rate_hz: f64, machine: &Machine) -> Option<shaft::Shaft> {
    let rpm = machine.speed_rpm.filter(|rpm| *rpm > 0.0 && machine.outer_speed_rpm == 0.0)?;
    samples.iter().all(|x| x.is_finite()).then_some(())?;
    shaft::near(samples, rate_hz, rpm / 60.0)
}

/// Withdraws claims of families that stand in one half of the record only, but for those that no chance
/// makes.
fn one_half_only(families: &mut [Family], samples: &[f64], rate_hz: f64) -> Result<(), Error> {
    let asked = |f: &&mut Family| f.claimed && f.over.is_none() && f.noise_p_value >= halves::CERTAIN;
    for family in families.iter_mut().filter(asked) {
        let (Some(band_hz), Some(hz)) = (family.band_hz, family.measured_hz) else { continue };
        let comb_hz = family.name.shocks_per_period() * hz;
        let finite = samples.iter().all(|x| x.is_finite());
        if finite && !halves::agree(samples, rate_hz, band_hz, comb_hz)? {
            family.claimed = false;
            family.not_told_apart_from = None;
            family.reason = "it stands in one half of the record only".to_owned().into();
        }
    }
    Ok(())
}

/// Highest frequency of the enhanced envelope spectrum [Hz].
fn enhanced_up_to_hz(families: &[Family]) -> f64 {
    let fastest_hz = families.iter().map(|f| f.expected_hz).fold(0.0, f64::max);
    if fastest_hz > 0.0 { HARMONICS * fastest_hz } else { UNKNOWN_HZ }
}

/// The bands of a channel over the period of a frequency [Hz]: the samples are read again.
fn over_period(
    channel: &Channel,
    rate_hz: f64,
    segment: usize,
    frequency_hz: f64,
) -> Result<Vec<BandEnvelope>, Error> {
    let highest_hz = HIGHEST_HZ.min(0.5 * rate_hz);
    let mut envelopes = BandEnvelopes::new(rate_hz, segment, &bands(rate_hz), highest_hz)
        .and_then(|envelopes| envelopes.over_period(frequency_hz))
        .map_err(Error::Signal)?;
    let mut buffer: Vec<f64> = Vec::with_capacity(segment);
    let mut failed = None;
    channel.for_each_block(|mut block| {
        while !block.is_empty() && failed.is_none() {
            let (now, later) = block.split_at((segment - buffer.len()).min(block.len()));
            buffer.extend_from_slice(now);
            block = later;
            if buffer.len() == segment {
                // Segments with values that are not numbers have been left out before, too.
                let sound = buffer.iter().all(|x| x.is_finite());
                failed = if sound { envelopes.add(&buffer).err() } else { None };
                buffer.clear();
            }
        }
        failed.is_none()
    })?;
    failed.map_or_else(|| Ok(envelopes.bands()), |why| Err(Error::Signal(why)))
}

/// The whole range, its halves, quarters and eighths.
fn bands(rate_hz: f64) -> Vec<(f64, f64)> {
    let half = 0.5 * rate_hz;
    let level = |level: u32| {
        let count = 1_u32 << level;
        let end = move |n: u32| if n == 0 { LOWEST * half } else { half * f64::from(n) / f64::from(count) };
        (0..count).map(move |n| (end(n), end(n + 1)))
    };
    (0..=LEVELS).flat_map(level).collect()
}

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
