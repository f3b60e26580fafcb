//! The housing that stands still: the two translations among the modes, which the shaft prescribes.

use crate::modal::Reduction;

use crate::{error::Error, modes::Modes, state::State, tally::Tally};

/// ω² below which a mode is free [rad²/s²]: 5 Hz. Rings on springs begin at hundreds of hertz.
const FREE: f64 = 1e3;

/// Two vertices of a body that moves as one piece differ by no more than this share of a shape.
const UNIFORM: f64 = 1e-3;

/// The two translations of ring and housing.
#[derive(Debug, Clone)]
pub(crate) struct Housing {
    modes: [usize; 2],
    /// Coordinates of both by a unit of displacement along x and along y [√kg].
    by_displacement: [[f64; 2]; 2],
    /// Centre of the outer raceway where all coordinates are zero [m].
    centre: [f64; 2],
}

impl Housing {
    /// Finds them.
    pub(crate) fn of(reduction: &Reduction, centre: [f64; 2]) -> Result<Self, Error> {
        let (r, shapes) = (reduction.padded, &reduction.shapes);
        let free: Vec<usize> = (0..reduction.modes).filter(|k| reduction.squares[*k] < FREE).collect();
        let &[a, b] = &free[..] else { return Err(Error::HousingNotFree) };
        let at = |vertex: &[f64], k: usize| [vertex[k], vertex[r + k]];
        for k in [a, b] {
            let mut vertices = shapes.chunks_exact(2 * r).map(|vertex| at(vertex, k));
            let [x, y] = vertices.next().ok_or(Error::HousingNotFree)?;
            let most = UNIFORM * libm::hypot(x, y);
            if !vertices.all(|[vx, vy]| libm::hypot(vx - x, vy - y) <= most) {
                return Err(Error::HousingNotFree);
            }
        }
        let ([ax, ay], [bx, by]) = (at(shapes, a), at(shapes, b));
        let determinant = ax * by - bx * ay;
        if determinant.abs() < UNIFORM * libm::hypot(ax, ay) * libm::hypot(bx, by) {
            return Err(Error::HousingNotFree);
        }
        let by_displacement = [[by / determinant, -bx / determinant], [-ay / determinant, ax / determinant]];
        Ok(Self { modes: [a, b], by_displacement, centre })
    }

    /// Takes what resists them out of a reduction: they are prescribed.
    pub(crate) fn let_go(&self, reduction: &mut Reduction) {
        let r = reduction.padded;
        for k in self.modes {
            reduction.squares[k] = 0.0;
        }
        for (i, row) in reduction.dampers.chunks_exact_mut(r).enumerate() {
            for (j, damper) in row.iter_mut().enumerate() {
                if self.modes.contains(&i) || self.modes.contains(&j) {
                    *damper = 0.0;
                }
            }
        }
    }

    /// Coordinates of both modes by a vector in the plane.
    fn coordinates(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        self.by_displacement.map(|[by_x, by_y]| by_x * x + by_y * y)
    }

    /// Coordinates where the shaft is displaced: the housing lies the other way.
    fn places(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        self.coordinates([-x - self.centre[0], -y - self.centre[1]])
    }

    /// Places the housing beside a shaft that is displaced [m].
    pub(crate) fn place(&self, q: &mut [f64], shaft: [f64; 2]) {
        for (k, to) in self.modes.into_iter().zip(self.places(shaft)) {
            q[k] = to;
        }
    }

    /// Lets the housing move past a shaft with this velocity [m/s].
    pub(crate) fn drive(&self, v: &mut [f64], [x, y]: [f64; 2]) {
        for (k, to) in self.modes.into_iter().zip(self.coordinates([-x, -y])) {
            v[k] = to;
        }
    }

    /// Takes both modes out of a system of equations for an equilibrium.
    pub(crate) fn hold(&self, matrix: &mut [f64], force: &mut [f64]) {
        let r = force.len();
        for k in self.modes {
            (0..r).for_each(|n| (matrix[k * r + n], matrix[n * r + k]) = (0.0, 0.0));
            (matrix[k * r + k], force[k]) = (1.0, 0.0);
        }
    }

    /// Replaces the forces on both modes by those that bring the housing to its place beside a shaft that is
    /// displaced after a step of `dt` [s], and counts their work. Mass damping [1/s] does not act on a
    /// housing that stands still.
    #[inline(always)]
    pub(crate) fn push(
        &self,
        dt: f64,
        mass_damping: f64,
        shaft: [f64; 2],
        state: &State,
        modes: &mut Modes,
        tally: &mut Tally,
    ) {
        let h = 0.5 * mass_damping * dt;
        let rows = modes.push.iter_mut().flat_map(|row| row.iter_mut());
        for (k, push) in rows.enumerate() {
            let Some(which) = self.modes.iter().position(|mode| *mode == k) else { continue };
            let (q, v) = (state.q[k], state.v[k]);
            let new = (self.places(shaft)[which] - q) / dt;
            let mean = 0.5 * (v + new);
            tally.spent.external += dt * mean * ((new - v) / dt - *push);
            tally.spent.damped -= dt * mass_damping * mean * mean;
            *push = ((1.0 + h) * new - (1.0 - h) * v) / dt;
        }
    }
}
