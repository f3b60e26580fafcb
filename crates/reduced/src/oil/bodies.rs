//! Deflection of roller and raceway under a film: penalty on a round contact in series with the local
//! compliance (THEORY §9.3).

use stribeck_film::Spring;
use stribeck_modal::compliance::{Compliance, Curve};

/// Corrections of the force at a depth at most, and the share of it below which the last one leaves its
/// square: nothing.
const CORRECTIONS: usize = 30;
const ENOUGH: f64 = 1e-8;

/// Penalty and compliance of a round contact in series.
#[derive(Debug, Clone)]
pub(crate) struct BodySpring {
    /// Penetration over the force's 2/3rd power [m/N^{2/3}].
    softness: f64,
    curve: Curve,
    stiffest: f64,
}

impl BodySpring {
    /// Of bodies with the relative radius R [m] on a penalty [N/m²].
    pub(crate) fn new(penalty: f64, radius: f64, compliance: &Compliance) -> Self {
        Self {
            softness: (4.0 / 3.0 * penalty * (2.0 * radius).sqrt()).powf(-2.0 / 3.0),
            curve: compliance.curve(),
            stiffest: compliance.stiffest(penalty, radius),
        }
    }

    /// Growth of a force with the depth [N/m].
    pub(crate) fn stiffness(&self, force: f64) -> f64 {
        if force > 0.0 { 1.0 / self.depth(force).1 } else { 0.0 }
    }

    /// Force at a depth above zero: Newton's method for the cube root of it, in which the depth is convex.
    fn seek(&self, depth: f64, mut root: f64) -> f64 {
        let most = (depth / self.softness).sqrt();
        for _ in 0..CORRECTIONS {
            let square = root * root;
            let ([given, give], _) = self.curve.approach(square * root);
            let slope = 2.0 * self.softness * root + 3.0 * square * give;
            let by = (self.softness * square + given - depth) / slope;
            // No more than penalty alone would take.
            root = (root - by).min(most);
            if by.abs() <= ENOUGH * root {
                break;
            }
        }
        root * root * root
    }
}

impl Spring for BodySpring {
    fn force(&self, depth: f64) -> f64 {
        if depth > 0.0 { self.seek(depth, (depth / self.softness).sqrt()) } else { 0.0 }
    }

    fn force_near(&self, depth: f64, guess: f64) -> f64 {
        if depth > 0.0 && guess > 0.0 { self.seek(depth, guess.cbrt()) } else { self.force(depth) }
    }

    fn depth(&self, force: f64) -> (f64, f64) {
        let root = force.cbrt();
        let ([given, give], _) = self.curve.approach(force);
        (self.softness * root * root + given, self.softness / (1.5 * root) + give)
    }

    fn stiffest(&self) -> f64 {
        self.stiffest
    }

    fn energy(&self, depth: f64) -> f64 {
        let force = self.force(depth);
        let root = force.cbrt();
        0.4 * self.softness * force * root * root + self.curve.energy(force)
    }
}
