//! Deflection of the surfaces under a film.

use pulp::Simd;
use stribeck_simd::lanes::Vector;

/// Deepest indentation at which the force follows the growing contact; beyond it the force is linear, so that
/// the stiffness has a bound for the critical time step [m]. A film under such a force collapses within
/// microseconds.
const DEEPEST: f64 = 2e-6;

/// Compliance of two surfaces under a film between them.
pub trait Spring {
    /// Force [N] at a depth of zero or more [m].
    fn force(&self, depth: f64) -> f64;

    /// The same when it is about `guess` [N], for springs whose force has to be sought.
    fn force_near(&self, depth: f64, guess: f64) -> f64 {
        let _ = guess;
        self.force(depth)
    }

    /// Depth [m] under a force of zero or more [N], and its derivative [m/N].
    fn depth(&self, force: f64) -> (f64, f64);

    /// No stiffness is above this [N/m].
    fn stiffest(&self) -> f64;

    /// Energy at a depth of zero or more [J].
    fn energy(&self, depth: f64) -> f64;
}

/// Compliance of surfaces under several films side by side.
pub trait SpringInLanes: Spring {
    /// Depths [m] under forces whose cube roots these are [N^⅓], and the derivatives by the roots.
    fn depth_of<S: Simd>(&self, simd: S, root: Vector<S>) -> [Vector<S>; 2];

    /// Upper bound of the cube root of the force [N^⅓] at a depth of zero or more [m].
    fn largest_root<S: Simd>(&self, simd: S, depth: Vector<S>) -> Vector<S>;

    /// Energies [J] under forces whose cube roots these are.
    fn energy_at<S: Simd>(&self, simd: S, root: Vector<S>) -> Vector<S>;
}

/// A cylinder that is pressed into a bed of springs, those of penalty contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bed {
    /// Force over depth^{3/2} [N/m^{3/2}].
    hardness: f64,
    /// Force at the deepest.
    bend: f64,
    /// Stiffness from there on [N/m].
    stiffest: f64,
}

impl Bed {
    /// Springs of `stiffness` a length [N/m²] under a cylinder of the relative radius `radius` [m]: a strip
    /// of the half-width √(2Rd) is pressed in, ∫ k (d − x²/2R) dx = 4/3 k √(2R) d^{3/2}.
    pub fn new(stiffness: f64, radius: f64) -> Self {
        let hardness = 4.0 / 3.0 * stiffness * (2.0 * radius).sqrt();
        let root = DEEPEST.sqrt();
        Self { hardness, bend: hardness * DEEPEST * root, stiffest: 1.5 * hardness * root }
    }

    /// Stiffness [N/m].
    #[inline]
    pub fn stiffness(&self, depth: f64) -> f64 {
        1.5 * self.hardness * depth.min(DEEPEST).sqrt()
    }
}

impl Spring for Bed {
    #[inline]
    fn force(&self, depth: f64) -> f64 {
        if depth < DEEPEST {
            self.hardness * depth * depth.sqrt()
        } else {
            self.bend + self.stiffest * (depth - DEEPEST)
        }
    }

    #[inline]
    fn depth(&self, force: f64) -> (f64, f64) {
        if force < self.bend {
            let root = libm::cbrt(force / self.hardness);
            (root * root, 1.0 / (1.5 * self.hardness * root))
        } else {
            (DEEPEST + (force - self.bend) / self.stiffest, 1.0 / self.stiffest)
        }
    }

    #[inline]
    fn stiffest(&self) -> f64 {
        self.stiffest
    }

    #[inline]
    fn energy(&self, depth: f64) -> f64 {
        let (curved, rest) = (depth.min(DEEPEST), (depth - DEEPEST).max(0.0));
        0.4 * self.hardness * curved * curved * curved.sqrt()
            + (self.bend + 0.5 * self.stiffest * rest) * rest
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A bed of springs under a cylinder, up to 2 µm and straight from there on; stiffness is the derivative of
    /// the force, energy its integral, and depth its inverse.
    /// Source: THEORY §4.6, (4.24).
    #[test]
    fn analytic_a_cylinder_in_a_bed_of_springs() {
        const STEPS: u32 = 4000;
        let (k, radius) = (6e11, 9e-3);
        let bed = Bed::new(k, radius);
        let parabola = |depth: f64| 4.0 / 3.0 * k * (2.0 * radius).sqrt() * depth.powf(1.5);
        let steepest = 2.0 * k * (2.0 * radius * 2e-6).sqrt();
        let close = |a: f64, b: f64, by: f64| assert!((a / b - 1.0).abs() < by, "{a:e}, not {b:e}");
        for depth in [0.3e-6, 1.9e-6, 2.1e-6, 7e-6] {
            let straight = parabola(2e-6) + steepest * (depth - 2e-6);
            close(bed.force(depth), if depth < 2e-6 { parabola(depth) } else { straight }, 1e-12);
            close(bed.force_near(depth, 0.0), bed.force(depth), 1e-15);
            let slope = (bed.force(depth + 1e-11) - bed.force(depth - 1e-11)) / 2e-11;
            close(bed.stiffness(depth), slope, 1e-4);
            let (found, per_force) = bed.depth(bed.force(depth));
            close(found, depth, 1e-12);
            close(per_force, 1.0 / bed.stiffness(depth), 1e-12);
            let middles = (0..STEPS).map(|n| (f64::from(n) + 0.5) / f64::from(STEPS) * depth);
            close(
                bed.energy(depth),
                middles.map(|d| bed.force(d)).sum::<f64>() * depth / f64::from(STEPS),
                1e-5,
            );
        }
        close(bed.stiffest(), steepest, 1e-12);
        assert_eq!((bed.force(0.0), bed.energy(0.0)), (0.0, 0.0));
    }
}
