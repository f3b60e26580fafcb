//! What acts at a whole vector of points in contact, and what they remember: `touch.rs` for many.

use pulp::Simd;
use stribeck_solver::lanes::{Number, Vector};

use crate::{
    pass::Weights,
    touch::{Histories, Sum},
};

/// The law of a pass, the same in all lanes.
#[derive(Clone, Copy)]
pub(crate) struct Law<V: Simd> {
    simd: V,
    stiffness: Vector<V>,
    dashpot: Vector<V>,
    tangential: Vector<V>,
    /// Elastic slip at which a point slides, per penetration [-].
    ratio: Vector<V>,
    dt: Vector<V>,
    onset: Option<Onset<V>>,
}

/// The parabola with which the pressure sets in.
#[derive(Clone, Copy)]
struct Onset<V: Simd> {
    gap: Vector<V>,
    quarter: Vector<V>,
    work: Vector<V>,
}

/// A vector of points from the point `first` on, of which those act where `on` is one.
pub(crate) struct Touching<V: Simd> {
    pub(crate) first: usize,
    pub(crate) on: Vector<V>,
    pub(crate) gap: Vector<V>,
    /// Length of surface that each stands for [m].
    pub(crate) weight: Vector<V>,
    /// Rate of the gap, and tangential velocity to the left of the normal [m/s].
    pub(crate) opening: Vector<V>,
    pub(crate) along: Vector<V>,
}

/// Sums over points, lane by lane.
#[derive(Clone, Copy)]
pub(crate) struct Work<V: Simd> {
    stored: Vector<V>,
    friction: Vector<V>,
    damping: Vector<V>,
    penetration: Vector<V>,
}

impl<V: Simd> Work<V> {
    #[inline(always)]
    pub(crate) fn none(simd: V) -> Self {
        let zero = Vector::all(simd, 0.0);
        Self { stored: zero, friction: zero, damping: zero, penetration: zero }
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
    pub(crate) fn new(simd: V, w: &Weights, dt: f64) -> Self {
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
            simd,
            stiffness: Vector::all(simd, law.stiffness * w.thickness),
            dashpot: Vector::all(simd, law.damping * w.thickness),
            tangential: Vector::all(simd, law.tangential),
            ratio: Vector::all(simd, law.friction / law.tangential),
            dt: Vector::all(simd, dt),
            onset,
        }
    }

    /// Pressure, damping included, and shear forces [N], of use only where points are on; updates their histories.
    #[inline(always)]
    pub(crate) fn act(
        &self,
        points: &Touching<V>,
        histories: &mut Histories,
        work: &mut Work<V>,
    ) -> [Vector<V>; 2] {
        let &Touching { first, on, gap, weight, opening, along } = points;
        let (zero, half) = (on.constant(0.0), on.constant(0.5));
        let depth = -gap;
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
        let damping = (-(dashpot * opening)).max(-elastic);
        let before = Vector::load(self.simd, &histories.damping, first);
        let damping_heat = -(half * self.dt * (before + damping) * opening);
        let kt = self.tangential * k;
        let limit = self.ratio * depth;
        let slip = Vector::load(self.simd, &histories.slip, first);
        let moved = along * self.dt;
        let after = (slip + moved).max(-limit).min(limit);
        let (was, is) = (half * kt * slip * slip, half * kt * after * after);
        let friction_heat = half * kt * (slip + after) * moved - (is - was);
        zero.choose_below(on, damping, before).store(&mut histories.damping, first);
        zero.choose_below(on, after, slip).store(&mut histories.slip, first);
        work.stored = work.stored + zero.choose_below(on, stored + is, zero);
        work.friction = work.friction + zero.choose_below(on, friction_heat, zero);
        work.damping = work.damping + zero.choose_below(on, damping_heat, zero);
        work.penetration = work.penetration.max(zero.choose_below(on, depth, zero));
        [elastic + damping, -(kt * after)]
    }
}
