//! Forces of a raceway on eight rollers: normal force, damping and friction (THEORY §9.4).

use pulp::Simd;
use stribeck_simd::lanes::{Number, Vector};

use super::ContactLaw;
use crate::{
    contact::raceway::Raceway,
    rollers::block::RacewayContacts,
    row::{lanes, load},
    state::Stored,
    tally::Sums,
};

/// How rollers move on a raceway.
pub(crate) struct Rolling<V> {
    /// Velocity of their centres less that of the raceway, in the frame in which it is touched [m/s].
    pub(crate) relative: [V; 2],
    /// Angular velocities of the rollers and of the raceway [rad/s].
    pub(crate) spin: V,
    pub(crate) race: V,
    /// Speed of the contacts along the raceway [m/s].
    pub(crate) pace: V,
    /// Force of both raceways on them towards this one [N].
    pub(crate) thrust: V,
    /// By how much the speed of approach exceeds that at which dampers take energy (THEORY §9.4) [m/s].
    pub(crate) shadow: V,
}

/// Action of a raceway on rollers: force [N] in the frame of the raceway, and moment [N m].
pub(crate) struct Pushed<V> {
    pub(crate) force: [V; 2],
    pub(crate) moment: V,
}

impl ContactLaw {
    /// Forces on the rollers in the lanes from `at` on, whose normal forces are known. Of `sums`
    /// heat and shadow grow.
    #[inline(always)]
    pub(crate) fn push<S: Simd>(
        &self,
        simd: S,
        raceway: &Raceway,
        contacts: &mut RacewayContacts,
        at: usize,
        rolling: &Rolling<Vector<S>>,
        sums: &mut Sums<S>,
    ) -> Pushed<Vector<S>> {
        let all = |value: f64| Vector::all(simd, value);
        let (zero, one, half) = (all(0.0), all(1.0), all(0.5));
        let Rolling { relative, spin, race, pace, thrust, shadow } = *rolling;
        let normal = Vector::load(simd, &contacts.normal, at);
        let o = contacts.overlap.load(simd, at);
        let d = load(simd, &contacts.d, at);
        let t = [-d[1], d[0]];
        let [old_drag, old_damping, old_about] = &contacts.passive;
        let old_drag = Vector::load(simd, old_drag, at);
        let (old_damping, old_about) =
            (Vector::load(simd, old_damping, at), Vector::load(simd, old_about, at));
        let touches = zero.choose_below(normal, zero.choose_below(o.area, one, zero), zero);
        let where_it_touches = |number: Vector<S>| half.choose_below(touches, number, zero);

        let closing = relative[0].times_plus(d[0], relative[1] * d[1]);
        let turning = spin - race;
        let arm = all(self.arm);
        let sliding = relative[0].times_plus(t[0], relative[1].times_plus(t[1], spin * arm));
        let penalty = all(self.penalty);
        let length = half.choose_below(touches, o.length, one);
        // The compliance behind the penalty takes its part of the approach.
        let flexibility = Vector::load(simd, &contacts.flexibility, at);
        let part = one / (penalty * length).times_plus(flexibility, one);
        let stiffness_there = where_it_touches(penalty * length * part);
        let ahead = all(self.ahead) * thrust;
        let now = all(6.0 / self.time_step).times_plus(ahead, closing);
        sums.shadow = (all(self.shadow) * stiffness_there * now).times_plus(now, sums.shadow);
        sums.shadow = (all(0.25) * ahead).times_plus(thrust, sums.shadow);
        let normal = stiffness_there.times_plus(ahead, normal);
        let resistance = all(self.damping);
        let lost = resistance * (part * closing).times_plus(length, -(turning * o.first));
        let damping = where_it_touches(lost.max(-normal));
        let spread = (o.second - o.first * o.first / length).max(zero);
        let about = where_it_touches(resistance * turning * spread);
        // Friction: a spring whose stretch leaves with the material that leaves the contact (THEORY §9.4).
        let dt = all(self.time_step);
        let left = one - (all(2.0) * pace * dt / length).min(one);
        let stiffness = all(self.sticking) * length * part;
        let friction = raceway.traction.map_or(self.friction, |traction| traction.limit);
        let most = all(friction) * normal / stiffness;
        let mut slip = Vector::load(simd, &contacts.slip, at).times_plus(left, dt * sliding);
        if let Some(traction) = &raceway.traction {
            // The film behind the spring flows, as far as it does in a step (implicit Euler).
            let viscous = traction.viscous(simd, normal);
            slip = slip * viscous / (stiffness * dt + viscous);
        }
        let slip = where_it_touches(slip.min(most).max(-most));
        let drag = -(stiffness * slip);
        sums.heat[0] = sums.heat[0] - (old_drag + drag) * sliding;
        sums.heat[1] = (old_damping + damping)
            .times_plus(closing - shadow, (old_about + about).times_plus(turning, sums.heat[1]));
        slip.store(&mut contacts.slip, at);
        drag.store(&mut contacts.passive[0], at);
        damping.store(&mut contacts.passive[1], at);
        about.store(&mut contacts.passive[2], at);

        // d rotates as the roller moves along, and the deflection of the bodies with it.
        let deflection = Vector::load(simd, &contacts.shift, at);
        let per = all(raceway.outwards()) / Vector::load(simd, &contacts.distance, at);
        let turned = (half * o.skew + deflection * o.across) * per;
        let across = (o.slope * part).times_plus(ahead, o.across);
        let along = where_it_touches(penalty * (across - turned)) + drag;
        let against = where_it_touches(normal + damping);
        let area = half.choose_below(touches, o.area, one);
        let pressed = where_it_touches(normal / area * o.moment);
        Pushed {
            force: [along * t[0] - against * d[0], along * t[1] - against * d[1]],
            moment: arm.times_plus(drag, pressed - about),
        }
    }

    /// Energy of the contacts with a raceway that penalty, compliance and springs of friction store.
    pub(crate) fn stored_in_contacts(
        &self,
        raceway: &Raceway,
        contacts: &RacewayContacts,
        energy: &mut Stored,
    ) {
        for lane in lanes(contacts.near) {
            let (normal, overlap) = (contacts.normal[lane], &contacts.overlap);
            if normal > 0.0 && overlap.area[lane] > 0.0 {
                let slip = contacts.slip[lane];
                let length = overlap.length[lane];
                let part = 1.0 / (1.0 + self.penalty * length * contacts.flexibility[lane]);
                let stuck = 0.5 * self.sticking * length * part * slip * slip;
                energy.contact +=
                    0.5 * self.penalty * overlap.square[lane] + raceway.curve.energy(normal) + stuck;
                energy.sticking += stuck;
            }
        }
    }

    /// Deepest penetration of rollers in contact with a raceway [m].
    #[inline(always)]
    pub(crate) fn deepest(contacts: &RacewayContacts) -> f64 {
        let mut deepest = 0.0_f64;
        for lane in lanes(contacts.near) {
            deepest = deepest.max(contacts.overlap.deepest[lane]);
        }
        deepest
    }
}
