//! Unbalanced forces, and the motions that statics leaves to inertia.

use super::{Statics, Undecided, unknowns::Unknowns};
use crate::{
    dynamics::Dynamics,
    force::Force,
    rigid::RigidMotion,
    state::{Moment, NodeForces},
};

/// Unbalanced forces.
pub(super) struct Residual {
    pub(super) force: NodeForces,
}

impl Residual {
    pub(super) fn new(d: &Dynamics) -> Self {
        let n = d.state.x.len();
        Self { force: NodeForces::zeros(n) }
    }

    pub(super) fn evaluate(
        &mut self,
        d: &Dynamics,
        forces: &mut [&mut dyn Force],
        statics: &Statics,
        unknowns: &Unknowns,
    ) {
        let NodeForces { fx, fy } = &mut self.force;
        fx.fill(0.0);
        fy.fill(0.0);
        let at = Moment { dt: 0.0, ..d.moment() };
        for f in forces {
            f.accumulate(at, &mut self.force);
        }
        let NodeForces { fx, fy } = &mut self.force;
        d.elastic_forces(&d.state.x, &d.state.y, fx, fy);
        let (mass, [gx, gy]) = (d.mass(), d.gravity());
        for (_, slots) in &statics.bodies {
            for &s in slots {
                let s = s as usize;
                let [ax, ay] = statics.acceleration.get(s).copied().unwrap_or_default();
                fx[s] += mass[s] * (gx - ax);
                fy[s] += mass[s] * (gy - ay);
            }
        }
        for motion in &statics.undecided {
            motion.take_from_forces(d, fx, fy);
        }
        // What moves as one piece answers to the sum.
        for piece in &unknowns.pieces {
            let slots = piece.start as usize..piece.end as usize;
            for force in [&mut *fx, &mut *fy] {
                let sum = force[slots.clone()].iter().sum();
                force[slots.clone()].fill(0.0);
                force[slots.start] = sum;
            }
        }
    }

    pub(super) fn worst(&self, unknowns: &Unknowns) -> (f64, usize) {
        let mut worst = (0.0, 0);
        for (i, &s) in unknowns.slots.iter().enumerate() {
            let s = s as usize;
            for (c, f) in [self.force.fx[s], self.force.fy[s]].into_iter().enumerate() {
                if unknowns.free[i][c] && (f.abs() > worst.0 || f.is_nan()) {
                    worst = (f.abs(), s);
                }
            }
        }
        worst
    }

    pub(super) fn along(&self, unknowns: &Unknowns, step: &[[f64; 2]]) -> f64 {
        let f = &self.force;
        unknowns.slots.iter().zip(step).map(|(&s, d)| f.fx[s as usize] * d[0] + f.fy[s as usize] * d[1]).sum()
    }
}

impl Undecided {
    pub(super) fn centre(&self, d: &Dynamics) -> [f64; 2] {
        let s = &d.state;
        RigidMotion::of(
            self.slots.iter().map(|&n| (d.mass()[n as usize], [s.x[n as usize], s.y[n as usize]], [0.0; 2])),
        )
        .centre
    }

    /// The modes as fields over the slots, mass-orthogonal by construction (translation of the centre,
    /// rotation about it): calls `f` with each slot's direction and the mode's mass.
    fn modes(&self, d: &Dynamics) -> Vec<(Vec<[f64; 2]>, f64)> {
        let s = &d.state;
        let body = RigidMotion::of(
            self.slots.iter().map(|&n| (d.mass()[n as usize], [s.x[n as usize], s.y[n as usize]], [0.0; 2])),
        );
        let mut modes = Vec::new();
        if let Some(direction) = self.along {
            modes.push((vec![direction; self.slots.len()], body.mass));
        }
        if self.rotation {
            let turn = |&n: &u32| [body.centre[1] - s.y[n as usize], s.x[n as usize] - body.centre[0]];
            modes.push((self.slots.iter().map(turn).collect(), body.inertia));
        }
        modes
    }

    /// Spreads the resultant along each mode over the mass: the remaining forces do not move it.
    fn take_from_forces(&self, d: &Dynamics, fx: &mut [f64], fy: &mut [f64]) {
        for (mode, inertia) in self.modes(d) {
            let resultant: f64 = self
                .slots
                .iter()
                .zip(&mode)
                .map(|(&n, m)| fx[n as usize] * m[0] + fy[n as usize] * m[1])
                .sum();
            let a = resultant / inertia;
            for (&n, m) in self.slots.iter().zip(&mode) {
                fx[n as usize] -= d.mass()[n as usize] * a * m[0];
                fy[n as usize] -= d.mass()[n as usize] * a * m[1];
            }
        }
    }

    /// Removes the mode from a displacement field.
    pub(super) fn take_from_step(&self, d: &Dynamics, step: &mut [[f64; 2]], unknowns: &Unknowns) {
        for (mode, inertia) in self.modes(d) {
            let weighted = |(&n, m): (&u32, &[f64; 2])| {
                let u = unknowns.of(n).map_or([0.0; 2], |i| step[i]);
                d.mass()[n as usize] * (u[0] * m[0] + u[1] * m[1])
            };
            let a = self.slots.iter().zip(&mode).map(weighted).sum::<f64>() / inertia;
            for (&n, m) in self.slots.iter().zip(&mode) {
                let Some(i) = unknowns.of(n) else { continue };
                step[i][0] -= a * m[0];
                step[i][1] -= a * m[1];
            }
        }
    }
}
