//! Deflection of roller and raceway under a film: penalty on a round contact in series with the local
//! compliance (THEORY §9.3).

use crate::modal::compliance::{Compliance, Curve};
use pulp::Simd;
use stribeck_simd::lanes::{LANES, Number, Vector};
use stribeck_surface::film::{Spring, SpringInLanes};

use crate::row::lanes;

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
            softness: libm::pow(4.0 / 3.0 * penalty * (2.0 * radius).sqrt(), -2.0 / 3.0),
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
        if depth > 0.0 && guess > 0.0 { self.seek(depth, libm::cbrt(guess)) } else { self.force(depth) }
    }

    fn depth(&self, force: f64) -> (f64, f64) {
        let root = libm::cbrt(force);
        let ([given, give], _) = self.curve.approach(force);
        (self.softness * root * root + given, self.softness / (1.5 * root) + give)
    }

    fn stiffest(&self) -> f64 {
        self.stiffest
    }

    fn energy(&self, depth: f64) -> f64 {
        let force = self.force(depth);
        let root = libm::cbrt(force);
        0.4 * self.softness * force * root * root + self.curve.energy(force)
    }
}

impl SpringInLanes for BodySpring {
    #[inline(always)]
    fn depth_of<S: Simd>(&self, simd: S, root: Vector<S>) -> [Vector<S>; 2] {
        let all = |value: f64| Vector::all(simd, value);
        let square = root * root;
        let force = square * root;
        let y = force.sqrt();
        // Most films press with next to nothing: on the first piece.
        let [_, g, grows, _] = self.curve.piece_at(0.0);
        let (mut knot, mut first, mut slope) = (all(0.0), all(g), all(grows));
        let beyond = all(self.curve.spacing()).bits_below(y);
        if beyond != 0 {
            let mut roots = [0.0; LANES];
            let mut columns = [[0.0; LANES], [g; LANES], [grows; LANES]];
            y.store(&mut roots, 0);
            for lane in lanes(beyond) {
                let [knot, g, grows, _] = self.curve.piece_at(roots[lane]);
                (columns[0][lane], columns[1][lane], columns[2][lane]) = (knot, g, grows);
            }
            knot = Vector::load(simd, &columns[0], 0);
            first = Vector::load(simd, &columns[1], 0);
            slope = Vector::load(simd, &columns[2], 0);
        }
        let g = slope.times_plus(y - knot, first);
        let give = (all(0.5) * y).times_plus(slope, g);
        let softness = all(self.softness);
        let by_root = (all(2.0) * softness).times_plus(root, all(3.0) * square * give);
        [softness.times_plus(square, force * g), by_root]
    }

    #[inline(always)]
    fn largest_root<S: Simd>(&self, simd: S, depth: Vector<S>) -> Vector<S> {
        (depth * Vector::all(simd, 1.0 / self.softness)).sqrt()
    }

    #[inline(always)]
    fn energy_at<S: Simd>(&self, simd: S, root: Vector<S>) -> Vector<S> {
        let square = root * root;
        let mut forces = [0.0; LANES];
        (square * root).store(&mut forces, 0);
        let penalty = Vector::all(simd, 0.4 * self.softness) * square * square * root;
        for force in &mut forces[..Vector::<S>::LEN] {
            *force = self.curve.energy(*force);
        }
        penalty + Vector::load(simd, &forces, 0)
    }
}
