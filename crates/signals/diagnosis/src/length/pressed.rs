//! How far behind the first edge of a spall an element comes free, and as far before the second it is caught.
//!
//! Rings press an element together. Over a spall the ring above it sinks until its neighbours carry the load,
//! and the element stays between the rings as long as the gap below its centre is shallower than the approach
//! δ that this leaves: at `s` behind an edge the gap is s²/2R, so that it comes free at `s = √(2Rδ)` and is
//! caught as far before the second edge (THEORY §7.9):
//!
//! ```text
//! L = v Δt + D,   D = 2 √(2Rδ)
//! ```
//!
//! Rigid rings in a rigid housing; Palmgren's approach of an element between both raceways. Source: A.
//! Palmgren, Ball and Roller Bearing Engineering, 3rd ed., Burbank 1959; T. A. Harris, Rolling Bearing
//! Analysis, 4th ed., Wiley 2001, chapters 6 and 7; D is own.

use std::f64::consts::TAU;

use stribeck_theory::catalogue::{CatalogueBearing, Element};

use crate::Defect;

/// Load of a bearing over its static rating, where none is given.
const USUAL: (f64, f64) = (2e-3, 0.1);
/// The model's own error, as parts of D: a housing that bends makes it longer, an element that has not
/// settled shorter. By simulated spalls and the outer raceways of HIT-SM.
const MODEL: (f64, f64) = (0.5, 1.5);
/// Factors of ISO 76 for the static rating: of deep-groove balls, and of rollers [N/mm²].
const STATIC_BALL: f64 = 13.0;
const STATIC_ROLLER: f64 = 44.0;
/// Elements in an even ring, where the bearing does not say how many.
const ELEMENTS: u32 = 9;

/// How far a bearing presses an element together over a spall, D [mm], where that has been simulated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pressed {
    /// As it is expected.
    pub expected_mm: f64,
    /// Over the ranges of load and clearance, without the model's own error.
    pub least_mm: f64,
    /// The most of them.
    pub most_mm: f64,
}

/// The load of a bearing [N] and its radial internal clearance [µm], as ranges.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Loading {
    pub(crate) load_n: (f64, f64),
    pub(crate) clearance_um: (f64, f64),
    /// How far the outer ring and its housing give at the loaded place [µm/kN].
    pub(crate) housing_um_per_kn: (f64, f64),
}

impl Loading {
    /// The given values, or those that bearings usually have; and whether the load was given.
    pub(crate) fn of(
        bearing: &CatalogueBearing,
        load_n: Option<(f64, f64)>,
        clearance_um: Option<(f64, f64)>,
        housing_um_per_kn: Option<(f64, f64)>,
    ) -> (Self, bool) {
        let loading = Self {
            load_n: load_n.unwrap_or_else(|| usual_load_n(bearing)),
            clearance_um: clearance_um.unwrap_or((0.0, 0.0)),
            housing_um_per_kn: housing_um_per_kn.unwrap_or((0.0, 0.0)),
        };
        (loading, load_n.is_some())
    }

    /// D on a raceway [mm]: as it is expected, and its ends with the model's own error.
    pub(crate) fn pressed_mm(&self, bearing: &CatalogueBearing, raceway: Defect) -> (f64, f64, f64) {
        // 1 µm/kN is 1e-6 mm/N.
        let of = |load_n: f64, clearance_um: f64, um_per_kn: f64| {
            let approach = approach_mm(bearing, load_n, clearance_um) + 1e-6 * um_per_kn * load_n;
            2.0 * (2.0 * effective_radius_mm(bearing, raceway) * approach).sqrt()
        };
        let (stiff, soft) = self.housing_um_per_kn;
        let (loose_um, tight_um) = (self.clearance_um.1, self.clearance_um.0);
        let (least, most) = (of(self.load_n.0, loose_um, stiff), of(self.load_n.1, tight_um, soft));
        let middle_n = (self.load_n.0 * self.load_n.1).sqrt();
        let expected_mm = of(middle_n, 0.5 * (loose_um + tight_um), 0.5 * (stiff + soft));
        Pressed { expected_mm, least_mm: least, most_mm: most }.with_error()
    }
}

impl Pressed {
    /// As it is expected, and its ends with the model's own error [mm].
    pub(crate) fn with_error(self) -> (f64, f64, f64) {
        (self.expected_mm, MODEL.0 * self.least_mm, MODEL.1 * self.most_mm)
    }
}

/// Radial load that such a bearing usually carries, least and most [N]: 0.2 to 10 % of its static rating.
pub fn usual_load_n(bearing: &CatalogueBearing) -> (f64, f64) {
    let rating = static_rating_n(bearing);
    (USUAL.0 * rating, USUAL.1 * rating)
}

fn elements(bearing: &CatalogueBearing) -> u32 {
    bearing.elements.unwrap_or(ELEMENTS).max(3)
}

/// Length of a roller [mm]: that of its diameter, as in most cylindrical roller bearings.
fn roller_length_mm(bearing: &CatalogueBearing) -> f64 {
    bearing.diameter_mm
}

/// Static load rating by ISO 76 [N].
fn static_rating_n(bearing: &CatalogueBearing) -> f64 {
    let (d, z) = (bearing.diameter_mm, f64::from(elements(bearing)));
    let across = bearing.angle_deg.to_radians().cos();
    match bearing.element {
        Element::Ball => STATIC_BALL * z * d * d * across,
        Element::Roller => {
            STATIC_ROLLER * (1.0 - d * across / bearing.pitch_mm) * z * roller_length_mm(bearing) * d * across
        }
    }
}

/// Radius of a cylinder on a plane that gapes as an element does on a raceway, along it [mm].
fn effective_radius_mm(bearing: &CatalogueBearing, raceway: Defect) -> f64 {
    let (r, across) = (0.5 * bearing.diameter_mm, bearing.diameter_mm * bearing.angle_deg.to_radians().cos());
    match raceway {
        Defect::Bpfo => 1.0 / (1.0 / r - 2.0 / (bearing.pitch_mm + across)),
        _ => 1.0 / (1.0 / r + 2.0 / (bearing.pitch_mm - across)),
    }
}

/// Approach of both rings at the most loaded place, where the element there carries nothing and its
/// neighbours all of the load [mm].
fn approach_mm(bearing: &CatalogueBearing, load_n: f64, clearance_um: f64) -> f64 {
    let play = 0.5e-3 * clearance_um;
    let z = elements(bearing);
    let d = bearing.diameter_mm;
    // Load of an element by the approach of both contacts.
    let element_n = |approach: f64| match bearing.element {
        Element::Ball => d.sqrt() * (approach / 4.37e-4).powf(1.5),
        Element::Roller => (approach * roller_length_mm(bearing).powf(0.8) / 3.84e-5).powf(1.0 / 0.9),
    };
    let carried_n = |sunk: f64| {
        let of = |n: u32| {
            let place = (TAU * f64::from(n) / f64::from(z)).cos();
            let approach = sunk * place - play;
            if place > 0.0 && approach > 0.0 { element_n(approach) * place } else { 0.0 }
        };
        (1..z).map(of).sum::<f64>()
    };
    let (mut low, mut high) = (0.0, d);
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        if carried_n(middle) < load_n { low = middle } else { high = middle }
    }
    (0.5 * (low + high) - play).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_the_sink_onto_two_neighbours() {
        // Palmgren (1959): δ = 4.37e-4 Q^(2/3)/D^(1/3) for a ball between both raceways, in mm and N. Of nine
        // balls the two at 40° carry nearly all: 2 Q cos 40° = F and x cos 40° = δ.
        let bearing = CatalogueBearing::parse("6205").unwrap();
        let (load_n, slope) = (100.0, 40_f64.to_radians().cos());
        let sunk = 4.37e-4 * (load_n / (2.0 * slope)).powf(2.0 / 3.0) / 7.94_f64.cbrt() / slope;
        let found = approach_mm(&bearing, load_n, 0.0);
        // The next two, at 80°, take 3 % of it.
        assert!(found < sunk && found > 0.95 * sunk, "{found} {sunk}");
        assert!(approach_mm(&bearing, load_n, 10.0) > 0.0);
        // C0 of a 6205 is 7.8 kN in makers' catalogues.
        assert!((static_rating_n(&bearing) / 7800.0 - 1.0).abs() < 0.1);
    }

    #[test]
    fn invariant_a_heavier_load_and_the_outer_raceway_press_farther() {
        let bearing = CatalogueBearing::parse("6205").unwrap();
        let at = |load_n: f64, raceway| {
            let (loading, _) = Loading::of(&bearing, Some((load_n, load_n)), None, None);
            loading.pressed_mm(&bearing, raceway)
        };
        let (light, heavy, inner) = (at(50.0, Defect::Bpfo), at(400.0, Defect::Bpfo), at(50.0, Defect::Bpfi));
        // δ goes with the load to 2/3, D with its root.
        assert!((heavy.0 / light.0 - 2.0).abs() < 0.01 && inner.0 < light.0, "{light:?} {heavy:?} {inner:?}");
        assert!(light.1 < light.0 && light.0 < light.2);
        // A housing that gives 10 µm under 1 kN sinks by 1 µm under 100 N, beside the 4.5 of the contacts.
        let of = |housing| {
            Loading::of(&bearing, Some((100.0, 100.0)), None, housing).0.pressed_mm(&bearing, Defect::Bpfo)
        };
        let (rigid, soft) = (of(None), of(Some((0.0, 10.0))));
        let sunk = approach_mm(&bearing, 100.0, 0.0);
        assert!(
            (soft.2 / rigid.2 - (1.0 + 1e-3 / sunk).sqrt()).abs() < 1e-9 && soft.1 == rigid.1,
            "{soft:?}"
        );
    }
}
