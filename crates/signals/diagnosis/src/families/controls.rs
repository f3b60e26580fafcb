//! The unrelated combs of a spectrum that a family must stand above.

use stribeck_dsp::{Comb, CombTest, Whitened};

use crate::families::machine_lines::OwnLines;
use crate::families::unrelated::{SLIP, is_the_same, unrelated_hz};

/// Largest part of unrelated combs that may stand as high.
pub(crate) const MOST_AS_HIGH: f64 = 0.1;

/// Part of the unrelated combs that stand as high as this one; `None` when none can be tried.
pub(crate) fn rank(
    comb: &Comb,
    comb_hz: f64,
    spectrum: &Whitened,
    first_hz: Option<f64>,
    own: Option<&OwnLines>,
) -> Option<f64> {
    part_as_high(comb, &controls(comb, comb_hz, spectrum, first_hz, own))
}

pub(crate) fn part_as_high(comb: &Comb, controls: &[Comb]) -> Option<f64> {
    let as_high = controls.iter().filter(|control| control.height >= comb.height).count();
    (!controls.is_empty()).then(|| as_high as f64 / controls.len() as f64)
}

/// The highest combs about fundamentals unrelated to a comb's: control combs, which see the same signal of
/// the rest of the machine. Fundamentals of the `first` family [Hz], of the machine itself (`own`) and
/// sidebands of this one are left out, and a comb that is found from several sides counts once.
pub(crate) fn controls(
    comb: &Comb,
    comb_hz: f64,
    spectrum: &Whitened,
    first_hz: Option<f64>,
    own: Option<&OwnLines>,
) -> Vec<Comb> {
    let width_hz = 1.5 * spectrum.grid_hz();
    let of_the_first = |hz: f64| first_hz.is_some_and(|first_hz| is_the_same(hz, first_hz));
    let beside = |hz: f64| {
        let spacings = own.iter().flat_map(|own| [Some(own.shaft_hz), own.cage_hz]).flatten();
        let mut sidebands =
            spacings.flat_map(|spacing| [-2.0, -1.0, 1.0, 2.0].map(|k| comb.fundamental_hz + k * spacing));
        sidebands.any(|sideband| (hz - sideband).abs() < width_hz)
    };
    // In a short record fundamentals that are apart by more than slip may share lines.
    let shares_lines = |hz: f64| {
        let mut parts = (1..=5).flat_map(|p| (1..=5).map(move |q| f64::from(p) / f64::from(q)));
        parts.any(|part| (hz - part * comb.fundamental_hz).abs() < width_hz)
    };
    let mut found: Vec<Comb> = unrelated_hz(comb_hz)
        .filter(|hz| !of_the_first(*hz) && !shares_lines(*hz))
        .filter_map(|hz| CombTest::FOUR_OF_FIVE.search(spectrum, (1.0 - SLIP) * hz, (1.0 + SLIP) * hz).ok())
        .filter(|control| own.is_none_or(|own| !own.holds(control.fundamental_hz)))
        .filter(|control| !beside(control.fundamental_hz))
        .collect();
    found.sort_by(|a, b| a.fundamental_hz.total_cmp(&b.fundamental_hz));
    found.dedup_by(|a, b| (a.fundamental_hz - b.fundamental_hz).abs() < width_hz);
    found
}
