//! Forces of both raceways on a group of rollers (THEORY §9.4).

use pulp::Simd;
use stribeck_simd::lanes::{Number, Vector, vector_starts};

use crate::{
    contact::raceway::Raceway,
    drive::Drive,
    law::{ContactLaw, force::Rolling},
    rollers::block::{Block, RacewayContacts},
    row::{load, store},
    tally::Sums,
};

impl ContactLaw {
    /// Normal forces, damping and friction of both raceways, the normal parts of which are known.
    #[inline(always)]
    pub(crate) fn push_rollers<S: Simd>(
        &self,
        simd: S,
        raceways: &[Raceway; 2],
        block: &mut Block,
        drive: &Drive,
        sums: &mut Sums<S>,
    ) {
        let Drive { outer, inner, .. } = *drive;
        let all = |value: f64| Vector::all(simd, value);
        let (arm, rate) = (all(self.arm), all(inner.rate));
        let size = |number: Vector<S>| number.max(-number);
        let [on_outer, on_inner] = &mut block.contacts;
        for at in vector_starts(simd) {
            let distance = Vector::load(simd, &block.distance, at);
            let (centre, radial) = (load(simd, &block.centre, at), load(simd, &block.radial, at));
            let (velocity, spin) = (load(simd, &block.velocity, at), Vector::load(simd, &block.spin, at));
            let (moving, tilt) = (load(simd, &block.moving, at), load(simd, &block.tilt, at));
            // The raceway under the roller moves with the modes, and because the roller goes on to another
            // place of it.
            let orbit = velocity[1].times_plus(radial[0], -(velocity[0] * radial[1])) / distance;
            let mut relative =
                [velocity[0] - moving[0] - orbit * tilt[0], velocity[1] - moving[1] - orbit * tilt[1]];
            let mut race = all(0.0);
            if let Some(outer) = outer {
                // It turns about its own centre, which the load has moved: drive and friction see the same
                // velocity of it.
                race = all(outer.rate);
                let along = race * (Vector::load(simd, &on_outer.distance, at) + arm);
                let (d, [rx, ry]) = (load(simd, &on_outer.d, at), outer.back(simd, relative));
                relative = [along.times_plus(d[1], rx), ry - along * d[0]];
            }
            let pace = size(orbit - race) * (distance + arm);
            // The force on the roller, and its growth in the last step, bring its contacts to fourth order.
            let pressed = |contacts: &RacewayContacts| {
                Vector::load(simd, &contacts.normal, at) + Vector::load(simd, &contacts.passive[1], at)
            };
            let thrust = pressed(on_inner) - pressed(on_outer);
            let growth = |contacts: &RacewayContacts| Vector::load(simd, &contacts.growth, at);
            let shadow = all(2.0 * self.ahead / self.time_step) * (growth(on_inner) - growth(on_outer));
            shadow.store(&mut block.shadow, at);
            let rolling = Rolling { relative, spin, race, pace, thrust, shadow };
            let by_outer = self.push(simd, &raceways[0], on_outer, at, &rolling, sums);
            let mut force = by_outer.force;
            if let Some(outer) = outer {
                force = outer.forth(simd, force);
                let by = load(simd, &block.by, at);
                let [x, y] = [centre[0] - by[0], centre[1] - by[1]];
                sums.drive[0] = sums.drive[0] + x * force[1] - y * force[0] + by_outer.moment;
            }
            let [fx, fy] = force;
            store(force, &mut block.force[0], at);
            // Along its path the roller meets the raceway displaced more or less: it goes downhill (THEORY
            // §9.3).
            let downhill = -(fx.times_plus(tilt[0], fy * tilt[1]) / distance);
            let uphill = [-(downhill * radial[1]), downhill * radial[0]];
            store(uphill, &mut block.downhill, at);

            // Where the inner raceway is touched, it moves across the radius.
            let along = rate * (distance - arm);
            let [rx, ry] = [along.times_plus(radial[1], velocity[0]), velocity[1] - along * radial[0]];
            let relative = inner.back(simd, [rx, ry]);
            let pace = size((orbit - rate) * (distance - arm));
            let rolling = Rolling { relative, spin, race: rate, pace, thrust: -thrust, shadow: -shadow };
            let by_inner = self.push(simd, &raceways[1], on_inner, at, &rolling, sums);
            let [fx, fy] = inner.forth(simd, by_inner.force);
            store([fx, fy], &mut block.force[1], at);
            // The drive balances the moment of the roller on the ring.
            sums.drive[1] = sums.drive[1] + centre[0] * fy - centre[1] * fx + by_inner.moment;
            (by_outer.moment + by_inner.moment).store(&mut block.moment, at);
        }
    }
}
