//! What acts at a whole vector of points in contact, and what they remember: `touch.rs` for many.

use pulp::Simd;
use stribeck_simd::lanes::{Number, Vector};

use crate::{
    pass::{LONGEST_REST, SPEED_MARGIN, Weights},
    touch::Sum,
};

/// The law of a pass, the same in all lanes.
#[derive(Clone, Copy)]
pub(crate) struct Law<V: Simd> {
    stiffness: Vector<V>,
    dashpot: Vector<V>,
    tangential: Vector<V>,
    /// Elastic slip at which a point slides, per penetration [-].
    ratio: Vector<V>,
    dt: Vector<V>,
    /// Larger gaps than this carry nothing [m], deeper penetrations are no contacts.
    reach: Vector<V>,
    deepest: Vector<V>,
    onset: Option<Onset<V>>,
    /// What points that stay apart count on, see [`Weights::steps_apart`].
    pace: Vector<V>,
    margin: Vector<V>,
    least: Vector<V>,
    fastest: Vector<V>,
    now: Vector<V>,
    longest: Vector<V>,
}

/// The parabola with which the pressure sets in.
#[derive(Clone, Copy)]
struct Onset<V: Simd> {
    gap: Vector<V>,
    quarter: Vector<V>,
    work: Vector<V>,
}

/// Points whose feet are known, and what they remember.
pub(crate) struct Touching<V: Simd> {
    /// One where the foot holds and the point is awake; other lanes are let alone.
    pub(crate) within: Vector<V>,
    pub(crate) gap: Vector<V>,
    /// Length of surface that each stands for [m].
    pub(crate) weight: Vector<V>,
    /// Rate of the gap, and tangential velocity to the left of the normal [m/s].
    pub(crate) opening: Vector<V>,
    pub(crate) along: Vector<V>,
    pub(crate) slip: Vector<V>,
    pub(crate) damping: Vector<V>,
}

/// What becomes of them.
#[derive(Clone, Copy)]
pub(crate) struct Acts<V: Simd> {
    /// One where the point touches.
    pub(crate) on: Vector<V>,
    /// Forces [N], of use only where points are on.
    pub(crate) pressure: Vector<V>,
    pub(crate) shear: Vector<V>,
    /// What all remember now.
    pub(crate) slip: Vector<V>,
    pub(crate) damping: Vector<V>,
    /// One where the point stands off and has nothing to settle; it dozes until then.
    pub(crate) apart: Vector<V>,
    pub(crate) doze: Vector<V>,
}

/// Sums over points, lane by lane.
#[derive(Clone, Copy)]
pub(crate) struct Work<V: Simd> {
    stored: Vector<V>,
    friction: Vector<V>,
    damping: Vector<V>,
    penetration: Vector<V>,
    /// Fastest opening or closing [m/s].
    pace: Vector<V>,
}

impl<V: Simd> Work<V> {
    #[inline(always)]
    pub(crate) fn none(simd: V) -> Self {
        let zero = Vector::all(simd, 0.0);
        Self { stored: zero, friction: zero, damping: zero, penetration: zero, pace: zero }
    }

    #[inline(always)]
    pub(crate) fn pace(&self) -> f64 {
        self.pace.largest()
    }

    #[inline(always)]
    pub(crate) fn add_to(&self, sum: &mut Sum) {
        sum.stored += self.stored.sum();
        sum.friction += self.friction.sum();
        sum.damping += self.damping.sum();
        sum.penetration = sum.penetration.max(self.penetration.largest());
    }
}

impl<V: Simd> Law<V> {
    #[inline(always)]
    pub(crate) fn new(simd: V, w: &Weights, dt: f64, deepest: f64, now: f64, pace: f64) -> Self {
        let (law, e) = (&w.law, w.law.onset);
        // No closures: what they do would not be compiled for the vectors' instruction set.
        let onset = if e > 0.0 {
            let [gap, quarter, work] = [e, 0.25 / e, e * e / 6.0];
            Some(Onset {
                gap: Vector::all(simd, gap),
                quarter: Vector::all(simd, quarter),
                work: Vector::all(simd, work),
            })
        } else {
            None
        };
        Self {
            stiffness: Vector::all(simd, law.stiffness * w.thickness),
            dashpot: Vector::all(simd, law.damping * w.thickness),
            tangential: Vector::all(simd, law.tangential),
            ratio: Vector::all(simd, law.friction / law.tangential),
            dt: Vector::all(simd, dt),
            reach: Vector::all(simd, w.reach()),
            deepest: Vector::all(simd, deepest),
            onset,
            pace: Vector::all(simd, pace),
            margin: Vector::all(simd, SPEED_MARGIN),
            least: Vector::all(simd, w.least_speed()),
            fastest: Vector::all(simd, w.fastest),
            now: Vector::all(simd, now),
            longest: Vector::all(simd, LONGEST_REST),
        }
    }

    /// What acts, and its energies. Without `MEMORY` the penalty alone.
    #[inline(always)]
    pub(crate) fn act<const MEMORY: bool>(&self, points: &Touching<V>, work: &mut Work<V>) -> Acts<V> {
        let &Touching { within, gap, weight, opening, along, .. } = points;
        let (zero, half) = (within.constant(0.0), within.constant(0.5));
        let depth = -gap;
        let shallow = depth.choose_below(self.deepest, within, zero);
        let on = gap.choose_below(self.reach, shallow, zero);
        let pace = within * opening.max(-opening);
        work.pace = work.pace.max(pace);
        let still = points.slip * points.slip + points.damping * points.damping;
        let apart = gap.choose_below(self.reach, zero, zero.choose_below(still, zero, within));
        let mut doze = zero;
        if apart.bits() != 0 {
            let closing = (self.pace.max(pace) + along.max(-along)).times_plus(self.margin, self.least);
            let steps = (gap - self.reach) / (closing.min(self.fastest) * self.dt);
            doze = self.now + steps.min(self.longest);
        }
        let dashpot = self.dashpot * weight;
        let k = self.stiffness * weight;
        let (depth, elastic, dashpot, stored) = match &self.onset {
            None => {
                let elastic = k * depth;
                (depth, elastic, dashpot, half * elastic * depth)
            }
            Some(Onset { gap: e, quarter, work }) => {
                let t = *e - gap;
                let (rising, slope) = (*quarter * t * t, (*quarter + *quarter) * t);
                let third = e.constant(1.0 / 3.0);
                let partial = *quarter * t * t * t * third;
                let whole = (half * gap).times_plus(gap, *work);
                let deep = gap.choose_below(-*e, depth, rising);
                let dashpot = dashpot * gap.choose_below(-*e, e.constant(1.0), slope);
                (deep, k * deep, dashpot, k * gap.choose_below(-*e, whole, partial))
            }
        };
        work.penetration = work.penetration.max(zero.choose_below(on, depth, zero));
        if !MEMORY {
            work.stored = work.stored + zero.choose_below(on, stored, zero);
            return Acts { on, pressure: elastic, shear: zero, slip: zero, damping: zero, apart, doze };
        }
        let damping = (-(dashpot * opening)).max(-elastic);
        let damping_heat = -(half * self.dt * (points.damping + damping) * opening);
        let kt = self.tangential * k;
        let limit = self.ratio * depth;
        let moved = along * self.dt;
        let slip = (points.slip + moved).max(-limit).min(limit);
        let (was, is) = (half * kt * points.slip * points.slip, half * kt * slip * slip);
        let friction_heat = half * kt * (points.slip + slip) * moved - (is - was);
        work.stored = work.stored + zero.choose_below(on, stored + is, zero);
        work.friction = work.friction + zero.choose_below(on, friction_heat, zero);
        work.damping = work.damping + zero.choose_below(on, damping_heat, zero);
        Acts {
            on,
            pressure: elastic + damping,
            shear: -(kt * slip),
            slip: zero.choose_below(on, slip, points.slip),
            damping: zero.choose_below(on, damping, points.damping),
            apart,
            doze,
        }
    }
}
