//! Mass, momentum and inertia of a tile's bodies, for the frames of mass damping.

use pulp::{Arch, Simd, WithSimd};

use crate::{rigid::RigidMotion, state::State};
use stribeck_simd::lanes::{LANES, Number, Vector};

/// Sums over nodes, about the origin.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct MassSums {
    mass: f64,
    /// Σ m x, Σ m y.
    first: [f64; 2],
    /// Σ m (x² + y²).
    second: f64,
    /// Σ m v.
    momentum: [f64; 2],
    /// Σ m (x v_y − y v_x).
    angular: f64,
}

pub(crate) type LaneSums = [MassSums; LANES];

impl MassSums {
    /// The motion of a rigid body with these sums.
    pub(crate) fn motion(&self) -> RigidMotion {
        let Self { mass, first, second, momentum, angular } = *self;
        let centre = [first[0] / mass, first[1] / mass];
        let velocity = [momentum[0] / mass, momentum[1] / mass];
        let inertia = second - (centre[0] * first[0] + centre[1] * first[1]);
        let about_centre = angular - (centre[0] * momentum[1] - centre[1] * momentum[0]);
        RigidMotion { mass, centre, velocity, inertia, spin: about_centre / inertia }
    }
}

impl std::ops::AddAssign for MassSums {
    fn add_assign(&mut self, other: Self) {
        self.mass += other.mass;
        self.second += other.second;
        self.angular += other.angular;
        for k in 0..2 {
            self.first[k] += other.first[k];
            self.momentum[k] += other.momentum[k];
        }
    }
}

/// Sums over slots, whose number is a multiple of [`LANES`], with `mass` each; ghosts and padding have none.
pub(crate) fn lane_sums(mass: &[f64], state: &State, slots: std::ops::Range<usize>) -> LaneSums {
    Arch::new().dispatch(Summation {
        mass,
        x: &state.x[slots.clone()],
        y: &state.y[slots.clone()],
        vx: &state.vx[slots.clone()],
        vy: &state.vy[slots],
    })
}

struct Summation<'a> {
    mass: &'a [f64],
    x: &'a [f64],
    y: &'a [f64],
    vx: &'a [f64],
    vy: &'a [f64],
}

impl WithSimd for Summation<'_> {
    type Output = LaneSums;

    #[inline(always)]
    fn with_simd<V: Simd>(self, simd: V) -> LaneSums {
        let mut sums = LaneSums::default();
        let len = Vector::<V>::LEN;
        for first in (0..LANES).step_by(len) {
            let zero = Vector::all(simd, 0.0);
            let (mut mass, mut second, mut angular) = (zero, zero, zero);
            let (mut mx, mut my, mut px, mut py) = (zero, zero, zero, zero);
            let mut i = first;
            while i + len <= self.mass.len() {
                let m = Vector::load(simd, self.mass, i);
                let (x, y) = (Vector::load(simd, self.x, i), Vector::load(simd, self.y, i));
                let (u, v) = (Vector::load(simd, self.vx, i), Vector::load(simd, self.vy, i));
                mass = mass + m;
                (mx, my) = (m.times_plus(x, mx), m.times_plus(y, my));
                (px, py) = (m.times_plus(u, px), m.times_plus(v, py));
                second = m.times_plus(x.times_plus(x, y * y), second);
                angular = m.times_plus(x.times_plus(v, -(y * u)), angular);
                i += LANES;
            }
            let mut columns = [[0.0; LANES]; 7];
            mass.store(&mut columns[0], 0);
            mx.store(&mut columns[1], 0);
            my.store(&mut columns[2], 0);
            second.store(&mut columns[3], 0);
            px.store(&mut columns[4], 0);
            py.store(&mut columns[5], 0);
            angular.store(&mut columns[6], 0);
            for l in 0..len {
                let [mass, mx, my, second, px, py, angular] = columns.map(|column| column[l]);
                sums[first + l] = MassSums { mass, first: [mx, my], second, momentum: [px, py], angular };
            }
        }
        sums
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn invariant_mass_sums_give_the_motion_of_the_nodes() {
        // Sixteen nodes, four of them without mass, far from the origin and turning.
        let mut state = State::default();
        let mut mass = Vec::new();
        for n in 0..16_u32 {
            let t = f64::from(n);
            let (x, y) = (0.1 + 0.01 * (1.7 * t).sin(), -0.2 + 0.01 * (2.3 * t).cos());
            let own = [x, y, 3.0 - 40.0 * y, -1.0 + 40.0 * x];
            for (field, value) in
                [&mut state.x, &mut state.y, &mut state.vx, &mut state.vy].into_iter().zip(own)
            {
                *field = field.iter().copied().chain([value]).collect();
            }
            mass.push(if n % 4 == 3 { 0.0 } else { 1.0 + 0.1 * t });
        }
        let mut sum = MassSums::default();
        lane_sums(&mass, &state, 0..16).into_iter().for_each(|lane| sum += lane);
        let found = sum.motion();
        let nodes = (0..16).map(|n| (mass[n], [state.x[n], state.y[n]], [state.vx[n], state.vy[n]]));
        let expected = RigidMotion::of(nodes);
        // The centre lies twenty radii of gyration from the origin: four hundred times the rounding.
        let close = |a: f64, b: f64| (a - b).abs() <= 400.0 * 16.0 * f64::EPSILON * b.abs();
        assert!(close(found.mass, expected.mass) && close(found.inertia, expected.inertia), "{found:?}");
        assert!(close(found.spin, expected.spin) && close(found.spin, 40.0), "{found:?}, {expected:?}");
        for k in 0..2 {
            assert!(close(found.centre[k], expected.centre[k]), "{found:?}, {expected:?}");
            assert!(close(found.velocity[k], expected.velocity[k]), "{found:?}, {expected:?}");
        }
    }
}
