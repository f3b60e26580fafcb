//! Stiffness damping: elements see each node where it would be a time β later, so that their forces hold β K
//! v (THEORY §2.7).

use pulp::{Simd, WithSimd};

use crate::kernel::{
    advance::{Nodes, StepParameters},
    fields::TileFields,
    gather::Gathered,
    strip::StripForces,
    tile::Tile,
};
use stribeck_simd::{field::Field, lanes::Number};

/// Where the elements of the tile at hand see its nodes, and what that changes about their forces.
#[derive(Debug, Clone, Default)]
pub(crate) struct Extrapolated {
    /// Positions x + β v, or those from which the branches of structural damping pull [m].
    pub(crate) x: Field,
    pub(crate) y: Field,
    /// Damping force [N], in steps that count its heat or evaluate branches.
    pub(crate) fx: Field,
    pub(crate) fy: Field,
}

impl Extrapolated {
    /// For tiles of at most this many slots.
    pub(crate) fn new(slots: usize) -> Self {
        let zeros = || Field::zeros(slots);
        Self { x: zeros(), y: zeros(), fx: zeros(), fy: zeros() }
    }

    /// Power [W] that the damping force takes from the first `own` nodes at these velocities [m/s].
    pub(crate) fn power(&self, own: usize, vx: &[f64], vy: &[f64]) -> f64 {
        -(0..own).map(|n| self.fx[n] * vx[n] + self.fy[n] * vy[n]).sum::<f64>()
    }
}

/// Finds [`Extrapolated`] for one tile. Ghosts must have positions and velocities.
pub(crate) struct Extrapolate<'a> {
    pub(crate) tile: &'a Tile,
    pub(crate) fields: TileFields<'a>,
    pub(crate) extrapolated: &'a mut Extrapolated,
    pub(crate) parameters: StepParameters,
}

impl WithSimd for Extrapolate<'_> {
    /// Power [W] that damping takes at the velocities before the step; zero where heat is not counted.
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        let Self { tile, fields, extrapolated, parameters } = self;
        let TileFields { x, y, vx, vy, .. } = fields;
        let n = tile.slots.len();
        for (to, at, v) in [(&mut extrapolated.x, &*x, &*vx), (&mut extrapolated.y, &*y, &*vy)] {
            for ((to, at), v) in to[..n].iter_mut().zip(at).zip(v) {
                *to = parameters.beta.times_plus(*v, *at);
            }
        }
        if !parameters.count_heat {
            return 0.0;
        }
        extrapolated.fx[..n].fill(0.0);
        extrapolated.fy[..n].fill(0.0);
        // Forces where elements see the nodes less those where the nodes are: −f of the latter, plus f of the
        // former.
        for extrapolate in [false, true] {
            let (x, y) = if extrapolate {
                (&mut extrapolated.x[..n], &mut extrapolated.y[..n])
            } else {
                (&mut *x, &mut *y)
            };
            let (fx, fy) = (&mut extrapolated.fx[..n], &mut extrapolated.fy[..n]);
            tile_forces(simd, tile, [x, y, vx, vy], [fx, fy], parameters.fetch);
            if !extrapolate {
                let (fx, fy) = (&mut extrapolated.fx[..n], &mut extrapolated.fy[..n]);
                [fx, fy].into_iter().flatten().for_each(|f| *f = -*f);
            }
        }
        extrapolated.power(tile.own, vx, vy)
    }
}

/// Adds the forces of a tile's elements [N] at any positions of its nodes, and moves nothing.
#[inline(always)]
pub(crate) fn tile_forces<S: Simd>(
    simd: S,
    tile: &Tile,
    [x, y, vx, vy]: [&mut [f64]; 4],
    [fx, fy]: [&mut [f64]; 2],
    fetch: bool,
) {
    simd.vectorize(Gathered { tile, x, y, fx, fy });
    let (own_x, own_y, held_x, held_y) = (&mut [][..], &mut [][..], &[][..], &[][..]);
    let (mass, step_over_mass) = (&[][..], &tile.step_over_mass);
    let nodes = &mut Nodes { x, y, own_x, own_y, vx, vy, fx, fy, held_x, held_y, step_over_mass, mass };
    for strip in &tile.strips {
        simd.vectorize(StripForces { strip, tile, nodes, fetch });
    }
}
