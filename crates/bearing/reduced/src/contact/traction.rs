//! Traction of loaded contacts through oil (THEORY §4.6): a film that flows, up to a limit.

use pulp::Simd;
use stribeck_simd::lanes::{LANES, Number, Vector};

use crate::modal::parameters as modal;

/// Exponent of pressure from which on oil is a solid, and the traction the limiting one.
const SOLID: f64 = 60.0;

/// Traction of a loaded contact: a film that flows, up to a limit, in series with the spring of friction.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Traction {
    /// Largest traction over the normal force [-].
    pub(crate) limit: f64,
    /// Half the width of Hertz's contact over the root of its force [m/√N].
    half_width: f64,
    /// 2ηL over the thickness of the film [N s/m²].
    flow: f64,
    /// α/2L [1/(Pa m)].
    thickens: f64,
}

impl Traction {
    /// Of a raceway whose films are `least` thick [m] over a length out of plane [m].
    pub(crate) fn new(
        resistance: &modal::Resistance,
        viscosity: f64,
        least: f64,
        relative: f64,
        length: f64,
    ) -> Self {
        let softness = std::f64::consts::PI * resistance.contact_modulus * length;
        Self {
            limit: resistance.limiting_traction,
            half_width: (4.0 * relative / softness).sqrt(),
            flow: 2.0 * viscosity * length / least,
            thickens: 0.5 * resistance.pressure_viscosity / length,
        }
    }

    /// Force over the speed of sliding [N s/m] under some normal forces [N]: the shear of a film as wide as
    /// Hertz's contact at the viscosity of its mean pressure, by C. Barus (Am. J. Sci. 45 (1893) 87).
    #[inline(always)]
    pub(crate) fn viscous<S: Simd>(&self, simd: S, normal: Vector<S>) -> Vector<S> {
        let all = |value: f64| Vector::all(simd, value);
        let root = normal.max(all(0.0)).sqrt();
        let mut thicker = [0.0; LANES];
        (root * all(self.thickens / self.half_width)).store(&mut thicker, 0);
        let thicker = thicker.map(|exponent| libm::exp(exponent.min(SOLID)));
        all(self.flow * self.half_width) * root * Vector::load(simd, &thicker, 0)
    }
}

#[cfg(test)]
mod tests {
    use pulp::Scalar;

    use super::*;

    const ROUNDING: f64 = 1e-12;

    /// Under the force at which Hertz's mean pressure is 0.5 GPa the film resists sliding with A η exp(αp)/h, and
    /// hardly under none.
    /// Source: C. Barus, Am. J. Sci. 45 (1893) 87; K. L. Johnson, Contact Mechanics, Cambridge 1985, §4.2.
    #[test]
    fn analytic_traction_flows_at_the_viscosity_of_its_pressure() {
        let [modulus, length, relative, film] = [114e9, 9e-3, 3e-3, 0.3e-6];
        let oil = modal::Resistance {
            limiting_traction: 0.05,
            pressure_viscosity: 20e-9,
            contact_modulus: modulus,
            density: 0.0,
        };
        let traction = Traction::new(&oil, 0.02, film, relative, length);
        let pressure = 0.5e9;
        // p = w/2b with b² = 4wR/πE.
        let half_width = 8.0 * pressure * relative / (std::f64::consts::PI * modulus);
        let force = pressure * 2.0 * half_width * length;
        let area = 2.0 * half_width * length;
        let expected = area * 0.02 * (20e-9 * pressure).exp() / film;
        let simd = Scalar::new();
        let mut found = [0.0; LANES];
        traction.viscous(simd, Vector::all(simd, force)).store(&mut found, 0);
        assert!((found[0] / expected - 1.0).abs() < ROUNDING, "{} N s/m, not {expected}", found[0]);
        traction.viscous(simd, Vector::all(simd, 0.0)).store(&mut found, 0);
        assert_eq!(found[0], 0.0);
    }
}
