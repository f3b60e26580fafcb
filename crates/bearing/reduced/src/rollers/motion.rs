//! Rollers move under the forces on them (THEORY §9.4).

use crate::modal::parameters::DampingFrame;
use pulp::Simd;
use stribeck_simd::lanes::{Number, Vector, vector_starts};

use crate::{
    plane::Rotation,
    rollers::{Rollers, block::Block},
    row::{load, store},
    tally::Sums,
};

/// The frames of mass damping, for code that is made for each of them.
const ROLLING: u8 = 0;
const RIGID: u8 = 1;
const ABSOLUTE: u8 = 2;

impl Rollers {
    /// Rollers move under the forces on them, damped in the frame of the scene.
    #[inline(always)]
    pub(crate) fn advance<S: Simd>(
        &self,
        simd: S,
        dt: f64,
        block: &mut Block,
        last: bool,
        sums: &mut Sums<S>,
    ) {
        match self.frame {
            DampingFrame::Rolling => self.move_in_frame::<S, ROLLING>(simd, dt, block, last, sums),
            DampingFrame::RigidMotion => self.move_in_frame::<S, RIGID>(simd, dt, block, last, sums),
            DampingFrame::Absolute => self.move_in_frame::<S, ABSOLUTE>(simd, dt, block, last, sums),
        }
    }

    /// As [`Self::advance`], with the frame of mass damping known when it is compiled.
    #[inline(always)]
    fn move_in_frame<S: Simd, const FRAME: u8>(
        &self,
        simd: S,
        time_step: f64,
        block: &mut Block,
        last: bool,
        sums: &mut Sums<S>,
    ) {
        let all = |value: f64| Vector::all(simd, value);
        let [mass, inertia] = self.inertia;
        let (dt, half) = (all(time_step), all(0.5));
        let h = 0.5 * self.damping * time_step;
        let (kept, gain) = (all((1.0 - h) / (1.0 + h)), all(time_step / (1.0 + h)));
        let resisted = all(self.damping * time_step * mass);
        let weight = all(self.gravity * mass);
        for at in vector_starts(simd) {
            let present = Vector::load(simd, &block.present, at);
            let mut force = load(simd, &block.downhill, at);
            force[1] = force[1] - present * weight;
            for (by, sum) in block.force.iter().zip(&mut block.sums) {
                let by = load(simd, by, at);
                let [x, y] = load(simd, sum, at);
                store([x + by[0], y + by[1]], sum, at);
                force = [force[0] + by[0], force[1] + by[1]];
            }
            let per_mass = all(1.0 / mass);
            let a = [force[0] * per_mass, force[1] * per_mass];
            let turn = Vector::load(simd, &block.moment, at) * all(1.0 / inertia);
            let [vx, vy] = load(simd, &block.velocity, at);
            let spin = Vector::load(simd, &block.spin, at);
            let mut new = [dt.times_plus(a[0], vx), dt.times_plus(a[1], vy), dt.times_plus(turn, spin)];
            if FRAME == ROLLING {
                let [rx, ry] = load(simd, &block.radial, at);
                let (v, pull) = (vx.times_plus(rx, vy * ry), a[0].times_plus(rx, a[1] * ry));
                let slowed = kept.times_plus(v, gain * pull);
                let change = slowed - v - dt * pull;
                let mean = half * (slowed + v);
                let shadow = Vector::load(simd, &block.shadow, at);
                sums.damped = (resisted * mean).times_plus(mean - shadow, sums.damped);
                new = [change.times_plus(rx, new[0]), change.times_plus(ry, new[1]), new[2]];
            }
            if FRAME == ABSOLUTE {
                new = [
                    kept.times_plus(vx, gain * a[0]),
                    kept.times_plus(vy, gain * a[1]),
                    kept.times_plus(spin, gain * turn),
                ];
                let [mx, my, turning] = [half * (vx + new[0]), half * (vy + new[1]), half * (spin + new[2])];
                let square = mx.times_plus(mx, my.times_plus(my, all(inertia / mass) * turning * turning));
                sums.damped = resisted.times_plus(square, sums.damped);
            }
            sums.external = sums.external - present * half * dt * weight * (vy + new[1]);
            if last {
                let along = vx.times_plus(new[0], vy * new[1]);
                sums.kinetic =
                    all(mass).times_plus(along, (all(inertia) * spin).times_plus(new[2], sums.kinetic));
            }
            let [x, y] = load(simd, &block.centre, at);
            store([dt.times_plus(new[0], x), dt.times_plus(new[1], y)], &mut block.centre, at);
            store([new[0], new[1]], &mut block.velocity, at);
            new[2].store(&mut block.spin, at);
            let by = dt * new[2];
            (Vector::load(simd, &block.angle, at) + by).store(&mut block.angle, at);
            store(turn_by(load(simd, &block.turned, at), by), &mut block.turned, at);
        }
    }
}

/// Directions turned by small angles.
#[inline(always)]
fn turn_by<S: Simd>(direction: [Vector<S>; 2], angle: Vector<S>) -> [Vector<S>; 2] {
    let of = |value: f64| angle.constant(value);
    let square = angle * angle;
    let s = angle * (of(1.0) - square * of(1.0 / 6.0) * (of(1.0) - square * of(1.0 / 20.0)));
    let c = of(1.0) - of(0.5) * square * (of(1.0) - square * of(1.0 / 12.0));
    Rotation { cosine: c, sine: s }.forth(direction)
}
