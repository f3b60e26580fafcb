//! What acts at points in contact, and what they remember (THEORY §4.2–4.3), over any [`Number`]: at single points and at whole
//! vectors of them.

use stribeck_simd::lanes::Number;

use crate::{
    foot::Sliding,
    law::Onset,
    pass_law::{MOST_STEPS_APART, PassLaw, SPEED_MARGIN},
    plane::{choose, magnitude},
};

/// The law of a pass, the same in all lanes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LawKernel<N> {
    /// Per weight of a point: what [`PointState::weight`] is multiplied by.
    stiffness: N,
    dashpot: N,
    tangential: N,
    /// Elastic slip at which a point slides, per penetration [-].
    ratio: N,
    dt: N,
    /// Larger gaps than this carry nothing [m], deeper penetrations are no contacts.
    reach: N,
    deepest: N,
    onset: Option<Onset<N>>,
    /// Fastest that a point of the pass opened or closed of late [m/s].
    pub(crate) pace: N,
    margin: N,
    least: N,
    fastest: N,
    now: N,
    longest: N,
}

/// Points whose feet are known, and what they remember.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PointState<N> {
    /// One where the foot holds and the point is looked at; nothing acts on the others.
    pub(crate) within: N,
    /// [m]
    pub(crate) gap: N,
    /// How much surface each stands for: a length [m], or an area [m²] where the law has no thickness.
    pub(crate) weight: N,
    pub(crate) sliding: Sliding<N>,
    /// Elastic part of the tangential displacement [m].
    pub(crate) slip: N,
    /// Damping force of the step before [N].
    pub(crate) damping: N,
}

/// What becomes of them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reaction<N> {
    /// One where the point touches.
    pub(crate) on: N,
    /// Forces [N], of use only where points are on: against the normal, damping included, and to its left.
    pub(crate) pressure: N,
    pub(crate) shear: N,
    /// What all remember now.
    pub(crate) slip: N,
    pub(crate) damping: N,
    /// One where the point stands off and has nothing to settle; it is inactive until then.
    pub(crate) apart: N,
    pub(crate) inactive_until: N,
}

/// Sums over points, lane by lane.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Totals<N> {
    /// Elastic energy [J].
    pub(crate) stored: N,
    /// Heat of friction and of damping in the last step [J].
    pub(crate) friction: N,
    pub(crate) damping: N,
    /// Deepest effective penetration [m].
    pub(crate) penetration: N,
    /// Fastest opening or closing [m/s].
    pub(crate) pace: N,
}

impl<N: Number> Totals<N> {
    #[inline(always)]
    pub(crate) fn none(like: N) -> Self {
        let zero = like.constant(0.0);
        Self { stored: zero, friction: zero, damping: zero, penetration: zero, pace: zero }
    }
}

impl<N: Number> LawKernel<N> {
    /// Of the kind of `like`, per length of surface for the thickness [m] of a pass, per area for a thickness of one.
    #[inline(always)]
    pub(crate) fn new(
        like: N,
        w: &PassLaw,
        thickness: f64,
        dt: f64,
        deepest: f64,
        now: f64,
        pace: f64,
    ) -> Self {
        let law = &w.law;
        Self {
            stiffness: like.constant(law.stiffness * thickness),
            dashpot: like.constant(law.damping * thickness),
            tangential: like.constant(law.tangential),
            ratio: like.constant(law.friction / law.tangential),
            dt: like.constant(dt),
            reach: like.constant(w.reach()),
            deepest: like.constant(deepest),
            onset: Onset::new(like, law.onset),
            pace: like.constant(pace),
            margin: like.constant(SPEED_MARGIN),
            least: like.constant(w.least_speed()),
            fastest: like.constant(w.fastest),
            now: like.constant(now),
            longest: like.constant(MOST_STEPS_APART),
        }
    }

    /// Flag where a gap is one of contact, zero elsewhere.
    #[inline(always)]
    pub(crate) fn touches(&self, gap: N, flag: N) -> N {
        let zero = flag.constant(0.0);
        let shallow = (-gap).choose_below(self.deepest, flag, zero);
        gap.choose_below(self.reach, shallow, zero)
    }

    /// Steps after the search before which a point at a distance [m] from contact cannot touch (THEORY §4.1).
    #[inline(always)]
    pub(crate) fn inactive_until(&self, distance: N, sliding: Sliding<N>) -> N {
        let pace = self.pace.max(magnitude(sliding.opening));
        let closing = (pace + magnitude(sliding.along)).times_plus(self.margin, self.least);
        let steps = distance / (closing.min(self.fastest) * self.dt);
        self.now + steps.min(self.longest)
    }

    /// Distance of a gap from contact [m]; beyond `deepest` it is one as well.
    #[inline(always)]
    pub(crate) fn distance(&self, gap: N) -> N {
        magnitude(gap - self.reach)
    }

    /// What acts, and its energies. Without `MEMORY` the penalty alone.
    #[inline(always)]
    pub(crate) fn act<const MEMORY: bool>(
        &self,
        points: &PointState<N>,
        totals: &mut Totals<N>,
    ) -> Reaction<N> {
        let &PointState { within, gap, weight, sliding, .. } = points;
        let Sliding { opening, along } = sliding;
        let (zero, half) = (within.constant(0.0), within.constant(0.5));
        let on = self.touches(gap, within);
        totals.pace = totals.pace.max(within * magnitude(opening));
        let still = points.slip * points.slip + points.damping * points.damping;
        let apart = gap.choose_below(self.reach, zero, zero.choose_below(still, zero, within));
        let mut inactive_until = zero;
        if apart.bits() != 0 {
            inactive_until = self.inactive_until(gap - self.reach, sliding);
        }
        let dashpot = self.dashpot * weight;
        let k = self.stiffness * weight;
        let (depth, elastic, dashpot, stored) = match &self.onset {
            None => {
                let elastic = k * -gap;
                (-gap, elastic, dashpot, half * elastic * -gap)
            }
            Some(onset) => {
                let [depth, slope, work] = onset.depth(gap);
                (depth, k * depth, dashpot * slope, k * work)
            }
        };
        totals.penetration = totals.penetration.max(choose(on, depth, zero));
        if !MEMORY {
            totals.stored = totals.stored + choose(on, stored, zero);
            return Reaction {
                on,
                pressure: elastic,
                shear: zero,
                slip: zero,
                damping: zero,
                apart,
                inactive_until,
            };
        }
        // Damping sets in with the stiffness and never pulls: the sum of both stays a pressure.
        let damping = (-(dashpot * opening)).max(-elastic);
        // Work of a force over a step is the mean of its two ends times the displacement (THEORY §2.5).
        let damping_heat = -(half * self.dt * (points.damping + damping) * opening);
        let kt = self.tangential * k;
        // µ · elastic / kt, without the division.
        let limit = self.ratio * depth;
        let moved = along * self.dt;
        let slip = (points.slip + moved).max(-limit).min(limit);
        let (was, is) = (half * kt * points.slip * points.slip, half * kt * slip * slip);
        let friction_heat = half * kt * (points.slip + slip) * moved - (is - was);
        totals.stored = totals.stored + choose(on, stored + is, zero);
        totals.friction = totals.friction + choose(on, friction_heat, zero);
        totals.damping = totals.damping + choose(on, damping_heat, zero);
        Reaction {
            on,
            pressure: elastic + damping,
            shear: -(kt * slip),
            slip: choose(on, slip, points.slip),
            damping: choose(on, damping, points.damping),
            apart,
            inactive_until,
        }
    }

    /// Points that lost contact: settles the last half step of what they remember.
    #[inline(always)]
    pub(crate) fn release(&self, points: &PointState<N>, totals: &mut Totals<N>) {
        let &PointState { weight, sliding, slip, damping, .. } = points;
        let half = weight.constant(0.5);
        let kt = self.tangential * (self.stiffness * weight);
        totals.damping = totals.damping - half * self.dt * damping * sliding.opening;
        totals.friction = totals.friction + half * kt * slip * (sliding.along * self.dt + slip);
    }
}
