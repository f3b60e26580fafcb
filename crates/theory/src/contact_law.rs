//! Approach of a rolling element and each of its raceways under a force, by either contact law.

use std::f64::consts::PI;

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
    /// With the length of the contacts [m].
    Line { contacts: LineContacts, length: f64 },
    /// δ = factor Q^power at the outer and the inner contact, factor in [m/N^power].
    Power { factors: [f64; 2], power: f64 },
}

impl ContactLaw {
    /// Of a bearing's rolling elements.
    pub fn of(bearing: impl Into<Bearing>, kind: ContactLawKind) -> Self {
        let bearing = bearing.into();
        Self(match kind {
            ContactLawKind::Line => {
                Law::Line { contacts: LineContacts::of(bearing), length: bearing.thickness }
            }
            ContactLawKind::Ball => {
                let (r, groove) = (bearing.roller_radius, 2.0 * CONFORMITY * bearing.roller_radius);
                let modulus = 2.0 * bearing.material.contact_modulus();
                let across = [-bearing.outer_race_radius, bearing.inner_race_radius];
                let factors = across.map(|across| point_contact::approach(r, across, groove, 1.0, modulus));
                Law::Power { factors, power: 2.0 / 3.0 }
            }
            ContactLawKind::Palmgren => {
                let factor = 3.84e-8 * (1e3 * bearing.thickness).powf(-0.8);
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
            Law::Line { contacts, length } => {
                let (approach, slope) = contacts.approach_at(side, force / length);
                (approach, slope / length)
            }
            Law::Power { factors, power } => {
                let approach = factors[side] * force.powf(*power);
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
            Law::Line { contacts, length } => {
                let (w, slope) = contacts.load(delta)?;
                Some((w * length, slope * length, length * contacts.energy(w, delta)))
            }
            Law::Power { factors: [outer, inner], power } => {
                let force = (delta / (outer + inner)).powf(power.recip());
                Some((force, force / (power * delta), power / (1.0 + power) * force * delta))
            }
        }
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

/// Mass of a rolling element [kg]: of a ball, or of a cylinder as long as the model is thick.
pub fn element_mass(bearing: &Bearing, kind: ContactLawKind) -> f64 {
    let (r, rho) = (bearing.roller_radius, bearing.material.density);
    match kind {
        ContactLawKind::Ball => rho * 4.0 / 3.0 * PI * r.powi(3),
        ContactLawKind::Line | ContactLawKind::Palmgren => rho * PI * r * r * bearing.thickness,
    }
}
