//! Vectors and rotations in the plane, of one number or of several side by side.

use pulp::Simd;
use stribeck_simd::lanes::{Number, Vector};

/// A vector in the plane: x and y.
pub(crate) type Vec2<N = f64> = [N; 2];

/// A rotation, counter-clockwise positive: cosine and sine of its angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Rotation<N = f64> {
    pub(crate) cosine: N,
    pub(crate) sine: N,
}

impl Rotation {
    pub(crate) const NONE: Self = Self { cosine: 1.0, sine: 0.0 };

    /// By an angle [rad].
    #[inline(always)]
    pub(crate) fn by(angle: f64) -> Self {
        let (sine, cosine) = libm::sincos(angle);
        Self { cosine, sine }
    }

    /// The same for vectors side by side.
    #[inline(always)]
    pub(crate) fn side_by_side<S: Simd>(self, simd: S) -> Rotation<Vector<S>> {
        Rotation { cosine: Vector::all(simd, self.cosine), sine: Vector::all(simd, self.sine) }
    }
}

impl<N: Number> Rotation<N> {
    /// That turns the x axis into a direction.
    #[inline(always)]
    pub(crate) fn to([cosine, sine]: Vec2<N>) -> Self {
        Self { cosine, sine }
    }

    /// A vector, rotated.
    #[inline(always)]
    pub(crate) fn forth(self, [x, y]: Vec2<N>) -> Vec2<N> {
        let Self { cosine: c, sine: s } = self;
        [c.times_plus(x, -(s * y)), s.times_plus(x, c * y)]
    }

    /// A vector, rotated the other way: in the frame that is rotated by this.
    #[inline(always)]
    pub(crate) fn back(self, [x, y]: Vec2<N>) -> Vec2<N> {
        let Self { cosine: c, sine: s } = self;
        [c.times_plus(x, s * y), c.times_plus(y, -(s * x))]
    }
}

#[inline(always)]
pub(crate) fn dot(a: Vec2, b: Vec2) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// Component of the vector product along the axis: positive where `b` lies counter-clockwise from `a`.
#[inline(always)]
pub(crate) fn cross(a: Vec2, b: Vec2) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// A vector turned by a right angle, counter-clockwise.
#[inline(always)]
pub(crate) fn perpendicular([x, y]: Vec2) -> Vec2 {
    [-y, x]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_hand_a_rotation_and_back() {
        let rotation = Rotation::by(0.5 * std::f64::consts::PI);
        let [x, y] = rotation.forth([2.0, 1.0]);
        assert!((x + 1.0).abs() < 1e-15 && (y - 2.0).abs() < 1e-15);
        let [x, y] = rotation.back([x, y]);
        assert!((x - 2.0).abs() < 1e-15 && (y - 1.0).abs() < 1e-15);
        assert_eq!(Rotation::to([0.6, 0.8]).forth([1.0, 0.0]), [0.6, 0.8]);
        assert_eq!(perpendicular([2.0, 1.0]), [-1.0, 2.0]);
        assert_eq!((dot([1.0, 2.0], [3.0, 4.0]), cross([1.0, 2.0], [3.0, 4.0])), (11.0, -2.0));
    }
}
