//! Approach of a rolling element and each of its raceways under a force, by either contact law.

use std::f64::consts::{LN_2, PI};

use serde::{Deserialize, Serialize};

use crate::bearing::Bearing;
use crate::catalogue::Element;
use crate::line_contact::LineContacts;
use crate::point_contact::{self, CONFORMITY};

/// A law of contact of rolling elements and raceways.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ContactLawKind {
    /// Line contact in plane strain, down to the thickness of the rings: the law of both models (THEORY
    /// §6.2).
    Line,
    /// The same of rollers whose ends are relieved by the logarithmic profile of ISO/TS 16281.
    Profiled,
    /// Point contact of balls in grooves, after Hertz.
    Ball,
    /// Palmgren's measured law of rollers of finite length.
    Palmgren,
}

impl ContactLawKind {
    /// The one that such elements have: points for balls, lines for rollers.
    pub fn of(element: Element) -> Self {
        match element {
            Element::Ball => Self::Ball,
            Element::Roller => Self::Line,
        }
    }

    /// In words, with its source.
    pub fn spoken(self) -> &'static str {
        match self {
            Self::Line => "line contact in plane strain (Johnson 1985, \u{a7}5.6)",
            Self::Profiled => {
                "line contact in plane strain (Johnson 1985, \u{a7}5.6) of rollers with the logarithmic \
                 profile of ISO/TS 16281"
            }
            Self::Ball => "point contact of Hertz, grooves of 0.52 diameters (Hamrock and Brewe 1983)",
            Self::Palmgren => {
                "line contact by Palmgren, \u{3b4} = 3.84e-5 Q^0.9/l^0.8 in mm and N (Harris 2001)"
            }
        }
    }
}

/// The law of both contacts of one rolling element.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactLaw(Law);

#[derive(Debug, Clone, Copy, PartialEq)]
enum Law {
    /// With the length of the contacts, and the scale of the profile that relieves their ends: the logarithm's
    /// factor, zero for straight rollers [m].
    Line { contacts: LineContacts, length: f64, relief: f64 },
    /// δ = factor Q^power at the outer and the inner contact, factor in [m/N^power].
    Power { factors: [f64; 2], power: f64 },
}

impl ContactLaw {
    /// Of a bearing's rolling elements.
    pub fn of(bearing: impl Into<Bearing>, kind: ContactLawKind) -> Self {
        let bearing = bearing.into();
        Self(match kind {
            ContactLawKind::Line | ContactLawKind::Profiled => {
                let is_straight = kind == ContactLawKind::Line;
                let relief = if is_straight { 0.0 } else { PROFILE * 2.0 * bearing.roller_radius };
                Law::Line { contacts: LineContacts::of(bearing), length: bearing.thickness, relief }
            }
            ContactLawKind::Ball => {
                let (r, groove) = (bearing.roller_radius, 2.0 * CONFORMITY * bearing.roller_radius);
                let modulus = 2.0 * bearing.material.contact_modulus();
                let across = [-bearing.outer_race_radius, bearing.inner_race_radius];
                let factors = across.map(|across| point_contact::approach(r, across, groove, 1.0, modulus));
                Law::Power { factors, power: 2.0 / 3.0 }
            }
            ContactLawKind::Palmgren => {
                let factor = 3.84e-8 * libm::pow(1e3 * bearing.thickness, -0.8);
                Law::Power { factors: [factor; 2], power: 0.9 }
            }
        })
    }

    /// Approach at one contact [m], 0 the outer and 1 the inner one, under a force [N], and its derivative
    /// [m/N]; nothing without force.
    pub fn approach(&self, side: usize, force: f64) -> (f64, f64) {
        if force <= 0.0 {
            return (0.0, 0.0);
        }
        match &self.0 {
            Law::Line { contacts, length, relief } => {
                let (straight, slope) = contacts.approach_at(side, force / length);
                let (approach, steeper) = relieved(straight, *relief);
                (approach, steeper * slope / length)
            }
            Law::Power { factors, power } => {
                let approach = factors[side] * libm::pow(force, *power);
                (approach, power * approach / force)
            }
        }
    }

    /// Approach of both raceways [m] under a force [N] through both contacts.
    pub fn both(&self, force: f64) -> f64 {
        self.approach(0, force).0 + self.approach(1, force).0
    }

    /// Force [N] through both contacts at the approach `delta` > 0 of the raceways [m], its derivative [N/m],
    /// and the energy of the contacts [J]; `None` where the law ends.
    pub(crate) fn between(&self, delta: f64) -> Option<(f64, f64, f64)> {
        match &self.0 {
            Law::Line { contacts, length, relief: 0.0 } => {
                let (w, slope) = contacts.load(delta)?;
                Some((w * length, slope * length, length * contacts.energy(w, delta)))
            }
            Law::Line { .. } => {
                let (force, stiffness) = self.force(delta, 0.0)?;
                Some((force, stiffness, force * delta - self.complement(force)))
            }
            Law::Power { factors: [outer, inner], power } => {
                let force = libm::pow(delta / (outer + inner), power.recip());
                Some((force, force / (power * delta), power / (1.0 + power) * force * delta))
            }
        }
    }

    /// ∫ δ dQ of both contacts up to a force [J], by Simpson's rule over the root ∛Q, in which it is smooth.
    fn complement(&self, force: f64) -> f64 {
        const INTERVALS: usize = 64;
        let at = |n: usize| {
            let s = n as f64 / INTERVALS as f64;
            3.0 * s * s * self.both(force * s.powi(3))
        };
        let inner: f64 = (1..INTERVALS).map(|n| if n % 2 == 1 { 4.0 } else { 2.0 } * at(n)).sum();
        force * (at(0) + inner + at(INTERVALS)) / (3.0 * INTERVALS as f64)
    }

    /// Force at the inner contact [N] and its derivative [N/m], where the raceways have come `approach` [m]
    /// nearer than the element is thick and `outwards` [N] presses it to the outer raceway besides; `None`
    /// where the law ends. Nothing as long as the inner raceway is not touched.
    pub fn force(&self, approach: f64, outwards: f64) -> Option<(f64, f64)> {
        const HALVINGS: usize = 60;
        let both = |force: f64| {
            let (outer, inner) = (self.approach(0, force + outwards), self.approach(1, force));
            (outer.0 + inner.0 - approach, outer.1 + inner.1)
        };
        if approach <= self.approach(0, outwards).0 {
            return Some((0.0, 0.0));
        }
        // The approach is concave over the force, so Newton's method from below never overshoots.
        let mut force = 1.0;
        for _ in 0..HALVINGS {
            if both(force).0 <= 0.0 {
                break;
            }
            force *= 0.1;
        }
        for _ in 0..200 {
            let (left, slope) = both(force);
            if slope <= 0.0 || !slope.is_finite() {
                return None;
            }
            let step = -left / slope;
            force += step;
            // A small force beside a large one outwards is known no better than the approach is.
            if step.abs() <= 1e-13 * force || left.abs() <= 4.0 * f64::EPSILON * approach {
                return Some((force, 1.0 / both(force).1));
            }
        }
        None
    }
}

/// Factor of the logarithm in the profile of rollers no longer than 2.5 diameters, over their diameter
/// (ISO/TS 16281).
const PROFILE: f64 = 0.000_35;

/// Approach at a contact whose ends are relieved [m], where without relief it is `straight` [m], and by how much
/// steeper than that it grows.
///
/// ```text
/// P(x) = a ln 1/(1 − (2x/l)²)      y − tanh y = δ_straight/2a      δ = 2a ln cosh y
/// ```
///
/// Slices of the contact give way independently, as much as the whole one does under the mean load, so that
/// Q = c ∫ (δ − P) dx over where the profile is touched. Source: profile ISO/TS 16281; integral own (THEORY
/// §6.2).
fn relieved(straight: f64, a: f64) -> (f64, f64) {
    if a <= 0.0 || straight <= 0.0 {
        return (straight, 1.0);
    }
    let f = straight / (2.0 * a);
    // Never below the root, from where Newton's method does not pass it.
    let mut y = f + libm::cbrt(3.0 * f).min(1.0);
    for _ in 0..50 {
        let t = libm::tanh(y);
        let square = y * y;
        let series = 1.0 / 3.0 - square * (2.0 / 15.0 - square * (17.0 / 315.0 - square * 62.0 / 2835.0));
        let over = if y < 0.02 { y * square * series } else { y - t };
        let step = (over - f) / (t * t);
        y -= step;
        if step <= 1e-15 * y {
            break;
        }
    }
    let log_cosh = if y < 1.0 {
        0.5 * libm::log1p(libm::sinh(y).powi(2))
    } else {
        y - LN_2 + libm::log1p(libm::exp(-2.0 * y))
    };
    (2.0 * a * log_cosh, libm::tanh(y).recip())
}

/// Mass of a rolling element [kg]: of a ball, or of a cylinder as long as the model is thick.
pub fn element_mass(bearing: &Bearing, kind: ContactLawKind) -> f64 {
    let (r, rho) = (bearing.roller_radius, bearing.material.density);
    match kind {
        ContactLawKind::Ball => rho * 4.0 / 3.0 * PI * r.powi(3),
        ContactLawKind::Line | ContactLawKind::Profiled | ContactLawKind::Palmgren => {
            rho * PI * r * r * bearing.thickness
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::Material;

    /// About an NU 205.
    const BEARING: Bearing = Bearing {
        outer_race_radius: 23.25e-3,
        outer_ring_thickness: Some(2.75e-3),
        inner_race_radius: 15.75e-3,
        inner_ring_thickness: 3.25e-3,
        clearance: 0.0,
        rollers: 13,
        roller_radius: 3.75e-3,
        thickness: 9e-3,
        material: Material { youngs_modulus: 206e9, poissons_ratio: 0.3, density: 7850.0 },
    };

    /// Force of slices that give way independently, with the stiffness of the whole line: 1e-4 is the sum's error.
    /// Source: THEORY §6.2, (6.3b).
    #[test]
    fn analytic_a_relieved_roller_is_the_sum_of_its_slices() {
        const SLICES: usize = 200_000;
        let [straight, relieved] =
            [ContactLawKind::Line, ContactLawKind::Profiled].map(|kind| ContactLaw::of(BEARING, kind));
        let a = 0.000_35 * 2.0 * BEARING.roller_radius;
        for force in [1e-3, 1.0, 50.0, 1e3, 2e4] {
            let stiffness = force / straight.approach(0, force).0;
            let delta = relieved.approach(0, force).0;
            let slice = |n: usize| {
                let x = (n as f64 + 0.5) / SLICES as f64;
                (delta + a * (1.0 - x * x).ln()).max(0.0)
            };
            let sum = stiffness * (0..SLICES).map(slice).sum::<f64>() / SLICES as f64;
            assert!((sum / force - 1.0).abs() < 1e-4, "{sum} N instead of {force} N");
        }
    }

    /// What the profile adds to the approach of both raceways, beside the slices of ISO/TS 16281. Theirs are of
    /// Palmgren's law, c (δ − 2P)^(10/9): 2 % is what the logarithm of (6.2) differs from its power.
    /// Source: ISO/TS 16281:2008, profile and law of slices; THEORY §6.2.
    #[test]
    fn analytic_the_profile_adds_what_it_does_by_iso_16281() {
        const SLICES: usize = 20_000;
        let (length_mm, a_mm) = (1e3 * BEARING.thickness, 0.35e-3 * 2e3 * BEARING.roller_radius);
        let c = 35_948.0 * length_mm.powf(8.0 / 9.0);
        let iso = |delta_mm: f64| {
            let slice = |n: usize| {
                let x = (n as f64 + 0.5) / SLICES as f64;
                (delta_mm + 2.0 * a_mm * (1.0 - x * x).ln()).max(0.0).powf(10.0 / 9.0)
            };
            c * (0..SLICES).map(slice).sum::<f64>() / SLICES as f64
        };
        let [straight, relieved] =
            [ContactLawKind::Line, ContactLawKind::Profiled].map(|kind| ContactLaw::of(BEARING, kind));
        for delta_mm in [1e-3, 3e-3, 10e-3, 20e-3] {
            let force = iso(delta_mm);
            let theirs = delta_mm - (force / c).powf(0.9);
            let ours = 1e3 * (relieved.both(force) - straight.both(force));
            assert!((ours / theirs - 1.0).abs() < 0.02, "{force:.0} N: {ours} instead of {theirs} mm");
        }
    }

    /// The energy that static loads are found by is that of the forces: 1e-6 is the error of the differences.
    #[test]
    fn invariant_force_is_the_gradient_of_the_energy() {
        for kind in [ContactLawKind::Line, ContactLawKind::Profiled, ContactLawKind::Ball] {
            let law = ContactLaw::of(BEARING, kind);
            for delta in [1e-8, 1e-6, 2e-5] {
                let at = |delta: f64| law.between(delta).expect("a force");
                let step = 1e-4 * delta;
                let [less, here, more] = [delta - step, delta, delta + step].map(at);
                let by_energy = (more.2 - less.2) / (2.0 * step);
                assert!((by_energy / here.0 - 1.0).abs() < 1e-6, "{kind:?} {delta}: {by_energy} {}", here.0);
                let by_force = (more.0 - less.0) / (2.0 * step);
                assert!((by_force / here.1 - 1.0).abs() < 1e-6, "{kind:?} {delta}: {by_force} {}", here.1);
            }
        }
    }
}
