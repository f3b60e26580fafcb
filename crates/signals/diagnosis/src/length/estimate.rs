//! Length of a spall, from the time between the events at its edges and the approach of the element to the
//! raceways under load (THEORY §7.9).

use std::f64::consts::PI;

use stribeck_dsp::{EventSpacing, Spacing, passage_spacing};
use stribeck_theory::catalogue::CatalogueBearing;

use crate::length::pressed::{Loading, Pressed};
use crate::{Defect, Family, Interval, Machine};

/// Events closer than this cannot be distinguished from the ringing of one [s].
const SHORTEST_S: f64 = 0.4e-3;
/// Longest distance of two events over that of two passages: a longer one is the shorter distance of the exit
/// and the next entry.
const LONGEST: f64 = 0.5;
/// A second event that is missed is nearer to the first than this part of what would have shown.
const MISSED: f64 = 2.0;

#[derive(Debug, Default)]
pub(crate) struct SpallLength {
    /// From two events a passage [mm].
    pub(crate) length_mm: Option<Interval>,
    /// Of a spall longer than half of the distance of two elements that would make impacts in the same rhythm [mm].
    pub(crate) otherwise_mm: Option<Interval>,
    /// Time between them [ms].
    pub(crate) spacing_ms: Option<f64>,
    /// From one event a passage: the spall is shorter than this, if entry and exit both impact [mm].
    pub(crate) below_mm: Option<f64>,
    /// On what this rests, or why there is nothing.
    pub(crate) note: String,
}

impl SpallLength {
    fn none(why: &str) -> Self {
        Self { note: format!("no length of a spall: {why}"), ..Self::default() }
    }
}

/// The length by the distance of two events, a bound by a single one, or the reason for neither.
pub(crate) fn estimate(samples: &[f64], rate_hz: f64, machine: &Machine, families: &[Family]) -> SpallLength {
    let claimed = families.iter().filter(|f| f.claimed).collect::<Vec<_>>();
    let ([family], Some(bearing)) = (claimed.as_slice(), &machine.bearing) else {
        let why = if claimed.is_empty() { "no defect is claimed" } else { "more than one defect is claimed" };
        return SpallLength::none(why);
    };
    let Some(passing_hz) = family.measured_hz.filter(|_| matches!(family.name, Defect::Bpfo | Defect::Bpfi))
    else {
        return SpallLength::none("it is estimated on raceways only");
    };
    let speed = contact_speed_mm_s(bearing, family.name, passing_hz);
    if samples.iter().any(|x| !x.is_finite()) {
        return SpallLength::none("the first samples are not all numbers");
    }
    let apart_mm = speed / passing_hz;
    match passage_spacing(samples, rate_hz, passing_hz, SHORTEST_S, LONGEST / passing_hz) {
        Ok(EventSpacing::Pairs(spacing)) => {
            of_two_events(spacing, speed, apart_mm, bearing, family.name, machine)
        }
        Ok(EventSpacing::Alone { clear_from_s }) => of_one_event(MISSED * speed * clear_from_s, apart_mm),
        Ok(EventSpacing::Unknown) => SpallLength::none(
            "the record is too noisy, or rings too long, to tell a second event after each impact",
        ),
        Err(why) => SpallLength::none(&why.to_string()),
    }
}

fn of_two_events(
    spacing: Spacing,
    speed_mm_s: f64,
    apart_mm: f64,
    bearing: &CatalogueBearing,
    raceway: Defect,
    machine: &Machine,
) -> SpallLength {
    let (run, off) = (speed_mm_s * spacing.lag_s, speed_mm_s * spacing.uncertainty_s);
    let (loading, is_given) =
        Loading::of(bearing, machine.load_n, machine.clearance_um, machine.housing_um_per_kn);
    let simulated = machine.pressed.map(Pressed::with_error);
    let (pressed, least, most) = simulated.unwrap_or_else(|| loading.pressed_mm(bearing, raceway));
    let advice = if is_given { "" } else { "; `--load-n` with a narrower range narrows the interval" };
    let (stiff, soft) = loading.housing_um_per_kn;
    let housing = if simulated.is_some() {
        "the housing of a simulated scene".to_owned()
    } else if soft > 0.0 {
        format!("a housing that gives {stiff:.0} to {soft:.0} µm/kN")
    } else {
        "a rigid housing".to_owned()
    };
    let longer = |run: f64| Interval { value: run + pressed, low: run + least - off, high: run + most + off };
    let otherwise = longer(apart_mm - run);
    let note = format!(
        "the length of the spall is the {run:.2} ± {off:.2} mm that the contact runs between two events and \
         the {pressed:.2} mm ({least:.2} to {most:.2}) over which a bearing loaded by {:.0} to {:.0} N in \
         {housing} presses the element together{advice}. It holds for a spall shorter than half of the \
         {apart_mm:.1} mm between two elements: one of {:.1} mm ({:.1} to {:.1}), whose exit and the entry of \
         the next element are as far apart, would make impacts in the same rhythm, and the record does not say which",
        loading.load_n.0, loading.load_n.1, otherwise.value, otherwise.low, otherwise.high
    );
    SpallLength {
        length_mm: Some(longer(run)),
        otherwise_mm: Some(otherwise),
        spacing_ms: Some(1e3 * spacing.lag_s),
        below_mm: None,
        note,
    }
}

/// A single event bounds a length and does not determine it.
fn of_one_event(below_mm: f64, apart_mm: f64) -> SpallLength {
    let note = format!(
        "no second event follows each impact: one of entry and exit is heard, the record does not say which, \
         and it gives no length. A spall that is shallow, or crossed under so heavy a load that no element \
         comes free, or whose entry is soft, makes one impact whatever its length, up to the {apart_mm:.1} mm \
         between two elements"
    );
    SpallLength { below_mm: Some(below_mm), note, ..SpallLength::default() }
}

/// Speed of the contact along the damaged raceway [mm/s].
fn contact_speed_mm_s(bearing: &CatalogueBearing, family: Defect, passing_hz: f64) -> f64 {
    let elements = f64::from(bearing.elements.unwrap_or(1));
    let across = bearing.diameter_mm * bearing.angle_deg.to_radians().cos();
    let diameter = if family == Defect::Bpfo { bearing.pitch_mm + across } else { bearing.pitch_mm - across };
    PI * diameter * passing_hz / elements
}
