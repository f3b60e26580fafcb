//! The speed that an analysis takes: the one that was given, corrected by the lines of the record, or found in
//! it.

use stribeck_dsp::BandEnvelope;

use crate::Machine;
use crate::record::pass::Record;
use crate::speed::{by_verdict, estimate, shaft};

/// The speed, and where it is from.
pub(crate) struct Settled {
    /// The machine at this speed.
    pub(crate) machine: Machine,
    /// The speed before its correction [1/min].
    pub(crate) given_rpm: Option<f64>,
    /// The lines of the record correct the speed.
    pub(crate) is_corrected: bool,
    /// Uncertainty of a speed that was found in the record alone [1/min].
    pub(crate) uncertainty_rpm: Option<f64>,
    /// The speed by the lines of the record [Hz].
    pub(crate) lines_hz: Option<f64>,
    /// The lines of the shaft stand at this speed, so that only slip can move a family.
    pub(crate) by_shaft: bool,
    /// What the record says of the speed.
    pub(crate) notes: Vec<String>,
}

impl Settled {
    /// The speed of a machine, by a record.
    pub(crate) fn of(record: &Record, machine: &Machine) -> Self {
        let Record { kept, rate_hz, bands, .. } = record;
        let FoundSpeed { found, note: found_note } = FoundSpeed::of(record, machine);
        let taken = Machine {
            speed_rpm: machine.speed_rpm.or(found.map(|(hz, _)| 60.0 * hz)),
            speed_is_exact: machine.speed_is_exact || found.is_some(),
            ..machine.clone()
        };
        let shaft = shaft_by_lines(kept, *rate_hz, &taken);
        let lines = by_lines(shaft, kept, *rate_hz, bands, &taken);
        let correction = lines.and_then(|lines| lines.correction(&taken));
        Self {
            given_rpm: taken.speed_rpm,
            is_corrected: correction.is_some(),
            uncertainty_rpm: found.map(|(_, uncertainty_hz)| 60.0 * uncertainty_hz),
            lines_hz: lines.map(|lines| lines.hz),
            by_shaft: shaft.is_some_and(|shaft| shaft.is_distinct()),
            notes: found_note.into_iter().chain(correction).collect(),
            machine: Machine {
                // A measured speed is better than a given one however near it is; an exact one stays.
                speed_rpm: match lines.filter(|_| !taken.speed_is_exact) {
                    Some(lines) => Some(60.0 * lines.hz),
                    None => taken.speed_rpm,
                },
                ..taken
            },
        }
    }
}

/// A speed found by the lines of a record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SpeedByLines {
    pub(crate) hz: f64,
    pub(crate) uncertainty_hz: f64,
    /// Which lines.
    pub(crate) by: &'static str,
    /// How far they lead any other speed: decibels by the shaft, and by shaft and bearing together the
    /// logarithm of the likelihood.
    pub(crate) lead: f64,
}

const BY_SHAFT: &str = "the lines of the shaft";

impl SpeedByLines {
    pub(crate) fn of_shaft(shaft: shaft::Shaft) -> Self {
        Self { hz: shaft.hz, uncertainty_hz: shaft.uncertainty_hz, by: BY_SHAFT, lead: shaft.lead_db }
    }

    pub(crate) fn of_both(found: estimate::SpeedEstimate) -> Self {
        let by = "the lines of the shaft and of the bearing together";
        Self { hz: found.hz, uncertainty_hz: found.uncertainty_hz, by, lead: found.lead }
    }

    /// The note on the speed where it corrects a given one.
    fn correction(self, machine: &Machine) -> Option<String> {
        let rpm = machine.speed_rpm?;
        shaft::is_correction(self.hz, rpm / 60.0).then_some(())?;
        Some(format!(
            "{} stand at {:.1} ± {:.1} rpm, {:+.1} % from the {rpm:.1} rpm that were given, and are taken: no \
             other speed within 7 % comes nearer than {:.0}{}, multiples at which the bearing has lines left aside",
            self.by,
            60.0 * self.hz,
            60.0 * self.uncertainty_hz,
            100.0 * (60.0 * self.hz / rpm - 1.0),
            self.lead,
            if self.by == BY_SHAFT { " dB" } else { " in the logarithm of the likelihood" }
        ))
    }
}

/// The speed by the lines of the shaft, or, where these do not decide, by those of shaft and bearing
/// together. An exact one is only refined.
fn by_lines(
    shaft: Option<shaft::Shaft>,
    samples: &[f64],
    rate_hz: f64,
    bands: &[BandEnvelope],
    machine: &Machine,
) -> Option<SpeedByLines> {
    let given_hz = machine.speed_rpm.filter(|rpm| *rpm > 0.0)? / 60.0;
    if let Some(shaft) = shaft.filter(|shaft| shaft.is_distinct()) {
        let lines = SpeedByLines::of_shaft(shaft);
        return Some(lines)
            .filter(|lines| !(machine.speed_is_exact && shaft::is_correction(lines.hz, given_hz)));
    }
    let asked = !machine.speed_is_exact && machine.outer_speed_rpm == 0.0;
    let bearing = machine.bearing.as_ref().filter(|_| asked)?;
    samples.iter().all(|x| x.is_finite()).then_some(())?;
    let near = estimate::near(samples, rate_hz, bands, bearing, given_hz).filter(|found| found.is_accepted);
    // What is found among all speeds, and lies near the given one, needs no lead over its nearest neighbours.
    let of_all = || {
        let found = estimate::without_any_given(samples, rate_hz, bands, bearing)?;
        (found.is_accepted && (found.hz / given_hz - 1.0).abs() < estimate::REACH).then_some(found)
    };
    near.or_else(of_all).map(SpeedByLines::of_both)
}

/// The speed of a record for which the user gives none.
#[derive(Debug, Default)]
struct FoundSpeed {
    /// The speed and its uncertainty [Hz], where it is found.
    found: Option<(f64, f64)>,
    /// What the record says of it.
    note: Option<String>,
}

impl FoundSpeed {
    /// The speed at which a raceway is claimed, of those that the lines support; without one, that of which the
    /// lines of shaft and bearing together leave no doubt.
    fn of(record: &Record, machine: &Machine) -> Self {
        let Record { kept, rate_hz, bands, .. } = record;
        let asked = machine.bearing.as_ref().filter(|_| machine.speed_rpm.is_none());
        let asked = asked.filter(|_| kept.iter().all(|x| x.is_finite()));
        let searched = asked.and_then(|bearing| estimate::search(kept, *rate_hz, bands, bearing));
        let Some((by_lines, supported)) = searched else { return Self::default() };
        if let Some(found) = by_verdict::find(record, machine, &supported) {
            let speed = found.speed;
            let note = Some(found.note(supported.len()));
            return Self { found: Some((speed.hz, speed.uncertainty_hz)), note };
        }
        let speed = (by_lines.hz, by_lines.uncertainty_hz);
        Self { found: Some(speed).filter(|_| by_lines.is_accepted), note: Some(note_on(&by_lines)) }
    }
}

/// The note on a speed by shaft and bearing together.
fn note_on(found: &estimate::SpeedEstimate) -> String {
    let (rpm, next_rpm, lead) = (60.0 * found.hz, 60.0 * found.next_hz, found.lead);
    if found.is_accepted {
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
    }
}

/// The shaft by its lines, where a speed is given and the outer ring stands still.
fn shaft_by_lines(samples: &[f64], rate_hz: f64, machine: &Machine) -> Option<shaft::Shaft> {
    let rpm = machine.speed_rpm.filter(|rpm| *rpm > 0.0 && machine.outer_speed_rpm == 0.0)?;
    samples.iter().all(|x| x.is_finite()).then_some(())?;
    shaft::near(samples, rate_hz, rpm / 60.0, machine.bearing.as_ref())
}
