//! What a pass needs of a facet, whatever its curve: points on it, feet on it, its motion and the forces on it.
//!
//! A facet's curve is a polynomial c(s), linear in the positions of some nodes, plus a height e along its normal n:
//! x = c(s) + e(s) n. Its variation is δx = δc − e t (n·δc′)/|c′|, with the unit tangent t: the height turns with the
//! curve. Velocities follow from the same two terms, forces go the same way back (THEORY §4.4).

use pulp::Simd;
use stribeck_solver::state::Moment;

use crate::{
    projection::{Foot, Projection},
    row::{Outcome, Row},
    spline_row::Feet,
    surface::Surface,
    touch::Slide,
    touch_row::{Law, Work},
};

/// A force on a node: slot, x [N], y [N].
pub(crate) type Push = (u32, [f64; 2]);

/// A polynomial in the plane; as a sum of forces, what each coefficient gets.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Poly<const K: usize>(pub(crate) [[f64; 2]; K]);

/// A point of a facet in present positions.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Spot {
    /// Position [m].
    pub(crate) at: [f64; 2],
    pub(crate) place: f64,
    /// Height above the polynomial [m].
    pub(crate) height: f64,
    /// Unit normal of the polynomial there.
    pub(crate) normal: [f64; 2],
    /// One over the length of its derivative [1/m].
    pub(crate) inverse: f64,
}

/// A facet in present positions.
pub(crate) trait Shape: Copy {
    /// Coefficients of the facet's polynomial.
    type Coefficients: Copy + Coefficients;

    fn new(surface: &Surface, x: &[f64], y: &[f64], facet: usize) -> Self;

    fn facet(&self) -> usize;

    /// Evaluates those of a row's points that can be done together. What acts on the other surface may wait in `feet`;
    /// the facet in motion is left in `own` where it was needed.
    #[allow(clippy::too_many_arguments)] // a facet's whole situation
    fn touch_row<V: Simd, const MEMORY: bool>(
        simd: V,
        row: Row<'_>,
        own: &mut Option<Side<Self>>,
        feet: &mut Feet<V>,
        law: &Law<V>,
        work: &mut Work<V>,
        push: &mut Vec<Push>,
    ) -> Outcome;

    fn spot(&self, place: f64, height: f64) -> Spot;

    /// Projects `p`, walking on to the facet where its foot is; `None` beyond the ends of an open surface.
    fn project(&mut self, surface: &Surface, x: &[f64], y: &[f64], p: [f64; 2]) -> Option<Projection>;

    /// The nearest point of this facet alone.
    fn foot(&mut self, p: [f64; 2]) -> Foot;

    /// Whether a foot lies so far within the facet that no neighbour is nearer, unless there is a corner between.
    fn holds(&self, to: &Projection) -> bool;

    /// Whether `p`, whose foot on this facet is `to`, belongs to the neighbour beyond a joint without a kink.
    fn is_past(&self, to: &Projection, other: &Self, forward: bool, p: [f64; 2]) -> bool;

    /// Coefficients of a node field.
    fn gather(&self, surface: &Surface, x: &[f64], y: &[f64]) -> Self::Coefficients;

    /// Hands forces on coefficients over to the nodes: the transpose of `gather`.
    fn scatter(&self, surface: &Surface, forces: &Self::Coefficients, push: &mut Vec<Push>);
}

/// Values and forces of a polynomial's coefficients.
pub(crate) trait Coefficients {
    fn zero() -> Self;
    fn value(&self, s: f64) -> [f64; 2];
    fn slope(&self, s: f64) -> [f64; 2];
    /// Adds a force that acts on the value, and one that acts on the slope at `s`.
    fn add(&mut self, s: f64, on_value: [f64; 2], on_slope: [f64; 2]);
    /// Adds forces that others have got.
    fn add_all(&mut self, forces: &Self);
}

impl<const K: usize> Coefficients for Poly<K> {
    #[inline(always)]
    fn zero() -> Self {
        Self([[0.0; 2]; K])
    }

    #[inline(always)]
    fn value(&self, s: f64) -> [f64; 2] {
        let mut v = self.0[K - 1];
        for k in (0..K - 1).rev() {
            v = [v[0] * s + self.0[k][0], v[1] * s + self.0[k][1]];
        }
        v
    }

    #[inline(always)]
    fn slope(&self, s: f64) -> [f64; 2] {
        let top = (K - 1) as f64;
        let mut v = [top * self.0[K - 1][0], top * self.0[K - 1][1]];
        for k in (1..K - 1).rev() {
            v = [v[0] * s + k as f64 * self.0[k][0], v[1] * s + k as f64 * self.0[k][1]];
        }
        v
    }

    #[inline(always)]
    fn add_all(&mut self, forces: &Self) {
        for k in 0..K {
            self.0[k] = [self.0[k][0] + forces.0[k][0], self.0[k][1] + forces.0[k][1]];
        }
    }

    #[inline(always)]
    fn add(&mut self, s: f64, on_value: [f64; 2], on_slope: [f64; 2]) {
        let (mut power, mut lower) = (1.0, 0.0);
        for k in 0..K {
            let steep = k as f64 * lower;
            self.0[k][0] += power * on_value[0] + steep * on_slope[0];
            self.0[k][1] += power * on_value[1] + steep * on_slope[1];
            lower = power;
            power *= s;
        }
    }
}

/// A facet in motion, and the forces on it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Side<S: Shape> {
    pub(crate) shape: S,
    velocity: S::Coefficients,
    forces: S::Coefficients,
    /// Sum of the forces [N].
    pub(crate) force: [f64; 2],
    used: bool,
}

impl<S: Shape> Side<S> {
    #[inline(always)]
    pub(crate) fn new(shape: S, surface: &Surface, at: &Moment<'_>) -> Self {
        let velocity = shape.gather(surface, at.vx, at.vy);
        Self { shape, velocity, forces: S::Coefficients::zero(), force: [0.0; 2], used: false }
    }

    /// Velocity of the curve and rate of its swing, n·ċ′, at a place with the normal `n` [m/s].
    #[inline(always)]
    fn motion(&self, place: f64, n: [f64; 2]) -> ([f64; 2], f64) {
        let d = self.velocity.slope(place);
        (self.velocity.value(place), n[0] * d[0] + n[1] * d[1])
    }

    /// Velocity of a point [m/s].
    #[inline(always)]
    pub(crate) fn velocity(&self, spot: &Spot) -> [f64; 2] {
        let (v, swing) = self.motion(spot.place, spot.normal);
        off_curve(v, swing, spot.height, spot.normal, spot.inverse)
    }

    /// How a point with the velocity `v` moves against its foot on this facet.
    #[inline(always)]
    pub(crate) fn slide(&self, v: [f64; 2], to: &Projection) -> Slide {
        let (u, swing) = self.motion(to.place, to.curve_normal);
        let [nx, ny] = to.normal;
        let foot = off_curve(u, swing, to.height, to.curve_normal, to.inverse);
        Slide {
            opening: nx * (v[0] - u[0]) + ny * (v[1] - u[1]) - to.turn * swing,
            along: nx * (v[1] - foot[1]) - ny * (v[0] - foot[0]),
        }
    }

    /// Coefficients of its motion [m/s].
    #[inline(always)]
    pub(crate) fn coefficients_of_motion(&self) -> S::Coefficients {
        self.velocity
    }

    /// Adds forces on many points: what each coefficient gets.
    #[inline(always)]
    pub(crate) fn push_all(&mut self, forces: &S::Coefficients) {
        self.forces.add_all(forces);
        let all = forces.value(0.0);
        self.force = [self.force[0] + all[0], self.force[1] + all[1]];
        self.used = true;
    }

    /// Adds a force on a point.
    #[inline(always)]
    pub(crate) fn push_point(&mut self, spot: &Spot, f: [f64; 2]) {
        let [nx, ny] = spot.normal;
        // The tangent lies to the left of the normal.
        let lever = -spot.height * (f[1] * nx - f[0] * ny) * spot.inverse;
        self.forces.add(spot.place, f, [lever * nx, lever * ny]);
        self.force = [self.force[0] + f[0], self.force[1] + f[1]];
        self.used = true;
    }

    /// Adds the reaction to `f`, the sum of a pressure and a shear force on a point whose foot is here.
    #[inline(always)]
    pub(crate) fn push_foot(&mut self, to: &Projection, f: [f64; 2], pressure: f64, shear: f64) {
        let ([nx, ny], [mx, my]) = (to.normal, to.curve_normal);
        // The shear's own direction, (−n_y, n_x), along the curve's tangent, (−m_y, m_x).
        let along = nx * mx + ny * my;
        let lever = to.height * shear * along * to.inverse - to.turn * pressure;
        self.forces.add(to.place, [-f[0], -f[1]], [lever * mx, lever * my]);
        self.used = true;
    }

    /// Hands the forces over to the nodes.
    #[inline(always)]
    pub(crate) fn flush(&self, surface: &Surface, push: &mut Vec<Push>) {
        if self.used {
            self.shape.scatter(surface, &self.forces, push);
        }
    }
}

/// Velocity at a height above a curve that moves with `v` and swings.
#[inline(always)]
fn off_curve(v: [f64; 2], swing: f64, height: f64, [nx, ny]: [f64; 2], inverse: f64) -> [f64; 2] {
    let back = height * swing * inverse;
    [v[0] + back * ny, v[1] - back * nx]
}
