//! A speed that was given twice as high as the shaft turns: the number of poles of a motor, or of marks of a
//! tachometer, is easily taken for half of what it is.
//!
//! Where a comb stands at half the place of a raceway, what strikes comes half as often as elements pass, if
//! the speed is right. Where lines of the shaft stand at half the speed too, and between its multiples, the
//! speed is wrong and the comb is the raceway's (THEORY §7.9).

use crate::families::unrelated::SLIP;
use crate::families::verdict::{Candidates, Decided};
use crate::record::pass::Record;
use crate::speed::settled::SpeedByLines;
use crate::speed::{estimate, shaft};
use crate::{Defect, Machine};

/// Half the given speed, if both the raceway comb and the shaft lines support it.
pub(crate) fn detect_half_speed(
    candidates: &Candidates,
    record: &Record,
    machine: &Machine,
) -> Option<SpeedByLines> {
    let Record { kept: samples, rate_hz, bands, .. } = record;
    let rate_hz = *rate_hz;
    let asked = !machine.speed_is_exact && machine.outer_speed_rpm == 0.0;
    let (rpm, bearing) = (machine.speed_rpm?, machine.bearing.as_ref().filter(|_| asked)?);
    let comb_hz = candidates.unexplained.as_ref()?.hz;
    let is_half = |name: Defect| {
        let family = candidates.families.iter().find(|family| family.name == name);
        family.is_some_and(|family| (2.0 * comb_hz / family.expected_hz - 1.0).abs() < SLIP)
    };
    (is_half(Defect::Bpfo) || is_half(Defect::Bpfi)).then_some(())?;
    samples.iter().all(|x| x.is_finite()).then_some(())?;
    let half_hz = rpm / 120.0;
    let stands = |hz: f64| estimate::stands_at_half(samples, rate_hz, hz);
    let by_shaft = shaft::near(samples, rate_hz, half_hz, Some(bearing))
        .filter(|shaft| shaft.is_distinct() && stands(shaft.hz))
        .map(SpeedByLines::of_shaft);
    by_shaft.or_else(|| {
        let found = estimate::without_any_given(samples, rate_hz, bands, bearing)?;
        let agrees = found.is_accepted && (found.hz / half_hz - 1.0).abs() < SLIP && stands(found.hz);
        agrees.then_some(SpeedByLines::of_both(found))
    })
}

/// The machine at that speed, and what the rules say there, where they claim one raceway and nothing else.
pub(crate) fn decide_at_half(
    half: SpeedByLines,
    record: &Record,
    machine: &Machine,
) -> Option<(Machine, Decided)> {
    let slower = Machine { speed_rpm: Some(60.0 * half.hz), ..machine.clone() };
    let decided = Candidates::of(record, &slower, Some(half.hz), true).ok()?.decide();
    let claimed: Vec<Defect> = decided.families.iter().filter(|f| f.claimed).map(|f| f.name).collect();
    matches!(claimed.as_slice(), [Defect::Bpfo | Defect::Bpfi]).then_some((slower, decided))
}

/// What the verdict says on it.
pub(crate) fn sentence(half: SpeedByLines, given_rpm: f64) -> String {
    format!(
        "The shaft turns at half of the {given_rpm:.1} rpm that were given: {} stand at {:.1} ± {:.1} rpm, \
         and the comb of this raceway at half of its place.",
        half.by,
        60.0 * half.hz,
        60.0 * half.uncertainty_hz
    )
}
