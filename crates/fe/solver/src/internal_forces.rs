//! Elastic forces of all elements at any positions, for statics and the critical time step. A step has
//! kernels of its own.

use pulp::{Arch, Simd, WithSimd};

use crate::{
    dynamics::Dynamics,
    element::{QuadReference, Stiffness, any_quad_forces, triangle_forces},
    kernel::batch::{BATCH, Corners, QuadBatch, Quads, scatter},
};
use stribeck_simd::lanes::Vector;

impl Dynamics {
    /// Elastic forces [N] of all elements at positions `x`, `y` [m], added to `fx`, `fy`.
    pub fn elastic_forces(&self, x: &[f64], y: &[f64], fx: &mut [f64], fy: &mut [f64]) {
        let elements = self.elements();
        for body in &elements.bodies {
            let (quads, stiffness) = (&elements.quads[body.quads.clone()], &body.stiffness);
            Arch::new().dispatch(QuadForces { quads, stiffness, x, y, fx, fy });
            for (c, reference) in &elements.triangles[body.triangles.clone()] {
                let c = c.map(|n| n as usize);
                let [f, g] = triangle_forces(c.map(|n| x[n]), c.map(|n| y[n]), reference, stiffness);
                for (n, f) in c.into_iter().zip([f, g, [-f[0] - g[0], -f[1] - g[1]]]) {
                    fx[n] += f[0];
                    fy[n] += f[1];
                }
            }
        }
    }
}

struct QuadForces<'a> {
    quads: &'a [([u32; 4], QuadReference)],
    stiffness: &'a Stiffness,
    x: &'a [f64],
    y: &'a [f64],
    fx: &'a mut [f64],
    fy: &'a mut [f64],
}

impl WithSimd for QuadForces<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { quads, stiffness, x, y, fx, fy } = self;
        let k = &stiffness.of(Vector::all(simd, 0.0));
        let mut batch = QuadBatch::EMPTY;
        let (mut of_x, mut of_y): (Corners, Corners) = ([[0.0; BATCH]; 4], [[0.0; BATCH]; 4]);
        for elements in quads.chunks(BATCH) {
            batch.gather(elements, x, y);
            for at in (0..elements.len()).step_by(Vector::<S>::LEN) {
                let Quads { x, y, b, s, volume } = batch.at(simd, at);
                let forces = any_quad_forces(x, y, b, s, volume, k);
                for c in 0..4 {
                    forces[c][0].store(&mut of_x[c], at);
                    forces[c][1].store(&mut of_y[c], at);
                }
            }
            scatter(elements.iter().map(|(corners, _)| corners), [&of_x, &of_y], fx, fy);
        }
    }
}
