//! What roller and raceway give under a film: penalty on a round contact, and in series with it the bodies behind (THEORY §9.3).

use stribeck_contact::Spring;

use crate::compliance::{Compliance, Curve};

/// Corrections of the force at a depth at most, and what they may leave of it.
const CORRECTIONS: usize = 30;
const ACCURACY: f64 = 1e-14;

/// Penalty and compliance of a round contact in series.
#[derive(Debug, Clone)]
pub(crate) struct Give {
    /// Force over the penetration's 3/2nd power [N/m^{3/2}].
    hardness: f64,
    compliance: Compliance,
    curve: Curve,
    stiffest: f64,
}

impl Give {
    /// Of bodies with the relative radius R [m] on a penalty [N/m²].
    pub(crate) fn new(penalty: f64, radius: f64, compliance: &Compliance) -> Self {
        Self {
            hardness: 4.0 / 3.0 * penalty * (2.0 * radius).sqrt(),
            compliance: compliance.clone(),
            curve: compliance.curve(),
            stiffest: compliance.stiffest(penalty, radius),
        }
    }
}

impl Spring for Give {
    fn force(&self, depth: f64) -> f64 {
        if depth <= 0.0 {
            return 0.0;
        }
        // Newton's method for the cube root of the force, in which the depth is convex.
        let per = self.hardness.powf(-2.0 / 3.0);
        let mut root = (depth / per).sqrt();
        for _ in 0..CORRECTIONS {
            let square = root * root;
            let ([given, give], _) = self.curve.approach(square * root);
            let by = (per * square + given - depth) / (2.0 * per * root + 3.0 * square * give);
            root -= by;
            if by.abs() <= ACCURACY * root {
                break;
            }
        }
        root * root * root
    }

    fn depth(&self, force: f64) -> (f64, f64) {
        let root = (force / self.hardness).cbrt();
        let ([given, give], _) = self.curve.approach(force);
        (root * root + given, 1.0 / (1.5 * self.hardness * root) + give)
    }

    fn stiffest(&self) -> f64 {
        self.stiffest
    }

    fn energy(&self, depth: f64) -> f64 {
        let force = self.force(depth);
        let root = (force / self.hardness).cbrt();
        0.4 * force * root * root + self.compliance.energy(force)
    }
}
