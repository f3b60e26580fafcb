//! The law at points in contact, with their history (THEORY §4.2–4.3), over any [`Number`]: at single points
//! and at whole vectors of them.

use stribeck_simd::lanes::Number;

use crate::pass_law::{MOST_STEPS_APART, PassLaw, SPEED_MARGIN};
use stribeck_surface::{
    foot::Sliding,
    law::Onset,
    plane::{choose, magnitude},
};

/// The law of a pass, the same in all lanes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LawKernel<N> {
    /// Per weight of a point: the factor of [`PointState::weight`].
    stiffness: N,
    dashpot: N,
    /// Part of a damping force that is left after a step [-].
    kept: N,
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

/// Points with known feet, and their history.
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

#[derive(Debug, Clone, Copy)]
pub(crate) struct Reaction<N> {
    /// One where the point touches.
    pub(crate) on: N,
    /// Forces [N], valid only where points are in contact: against the normal, damping included, and to its
    /// left.
    pub(crate) pressure: N,
    pub(crate) shear: N,
    /// New history.
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
    /// Of the kind of `like`, per length of surface for the thickness [m] of a pass, per area for a thickness
    /// of one.
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
        let kept = law.damping_kept(dt);
        Self {
            stiffness: like.constant(law.stiffness * thickness),
            kept: like.constant(kept),
            dashpot: like.constant((1.0 - kept) * law.damping * thickness),
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

    /// Forces, and energies. Without `MEMORY` of the penalty alone.
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
        // Damping sets in with the stiffness, and the sum of both is never tensile.
        let damping = self.kept.times_plus(points.damping, -(dashpot * opening)).max(-elastic);
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

    /// Points that lost contact: accounts for the last half step of their history.
    #[inline(always)]
    pub(crate) fn release(&self, points: &PointState<N>, totals: &mut Totals<N>) {
        let &PointState { weight, sliding, slip, damping, .. } = points;
        let half = weight.constant(0.5);
        let kt = self.tangential * (self.stiffness * weight);
        totals.damping = totals.damping - half * self.dt * damping * sliding.opening;
        totals.friction = totals.friction + half * kt * slip * (sliding.along * self.dt + slip);
    }
}

#[cfg(test)]
mod tests {
    use pulp::{Arch, Scalar, Simd, WithSimd};
    use stribeck_simd::lanes::{LANES, Vector};

    use super::*;
    use stribeck_surface::Law;
    use stribeck_testing::Noise;

    const DT: f64 = 1e-4;
    const THICKNESS: f64 = 0.02;

    /// A point of surface: gap, weight, opening, along, slip and damping force of the step before.
    type State = [f64; 6];

    /// Forces and history: pressure, shear, slip, damping force; stored energy, heat of friction and of
    /// damping.
    type Acted = [f64; 7];

    /// The law as a textbook has it, branch by branch: a penalty with a parabola about the corner, a dashpot
    /// behind a spring, both of which never pull, and Coulomb friction by return mapping (Wriggers,
    /// Computational Contact Mechanics, 2nd ed., §§5.2, 6.5).
    fn textbook(law: &Law, [gap, weight, opening, along, slip, damping]: State) -> Acted {
        let (k, c, e) = (law.stiffness * weight * THICKNESS, law.damping * weight * THICKNESS, law.onset);
        if gap >= e {
            return [0.0, 0.0, slip, damping, 0.0, 0.0, 0.0];
        }
        // The pressure is the integral of its slope, the energy that of the pressure.
        let (depth, slope, energy) = if gap <= -e {
            (-gap, 1.0, 0.5 * gap * gap + e * e / 6.0)
        } else {
            let share = (e - gap) / (2.0 * e);
            (e * share * share, share, 2.0 * e * e * share * share * share / 3.0)
        };
        let kept = law.damping_kept(DT);
        let mut dashpot = kept * damping - (1.0 - kept) * c * slope * opening;
        if k * depth + dashpot < 0.0 {
            dashpot = -k * depth;
        }
        let kt = law.tangential * k;
        let trial = kt * (slip + along * DT);
        let limit = law.friction * k * depth;
        let shear = if trial.abs() <= limit { trial } else { limit * trial.signum() };
        let elastic = [slip, shear / kt].map(|slip| 0.5 * kt * slip * slip);
        // Work of the mean force over the step, less the energy stored in the spring.
        let friction = 0.5 * (kt * slip + shear) * along * DT - (elastic[1] - elastic[0]);
        let heat = -0.5 * (damping + dashpot) * opening * DT;
        [k * depth + dashpot, -shear, shear / kt, dashpot, k * energy + elastic[1], friction, heat]
    }

    /// Random states about contact, of points that stick and of points that slide.
    fn states() -> Vec<State> {
        let mut noise = Noise::new(1882);
        let mut random = |scale: f64| scale * noise.uniform();
        (0..50 * LANES)
            .map(|_| {
                [
                    random(1e-3),
                    0.02 + random(0.01),
                    random(2.0),
                    random(5.0),
                    random(3e-4),
                    random(2.0).max(0.0),
                ]
            })
            .collect()
    }

    fn kernel<N: Number>(like: N, law: &Law) -> LawKernel<N> {
        let pass = PassLaw { law: *law, thickness: THICKNESS, fastest: 10.0, softness: 0.0, together: true };
        LawKernel::new(like, &pass, THICKNESS, DT, 1.0, 0.0, 0.0)
    }

    fn act<N: Number>(law: &Law, [gap, weight, opening, along, slip, damping]: [N; 6]) -> [N; 8] {
        let sliding = Sliding { opening, along };
        let state = PointState { within: gap.constant(1.0), gap, weight, sliding, slip, damping };
        let mut totals = Totals::none(gap);
        let acts = kernel(gap, law).act::<true>(&state, &mut totals);
        let Totals { stored, friction, damping, .. } = totals;
        [acts.on, acts.pressure, acts.shear, acts.slip, acts.damping, stored, friction, damping]
    }

    fn check(what: &str, law: &Law, state: State, found: [f64; 8]) {
        // Some twenty roundings, of terms of these sizes.
        const ROUNDING: f64 = 2e-14;
        let expected = textbook(law, state);
        let on = state[0] < law.onset;
        assert_eq!(found[0] == 1.0, on, "{what}: {state:?}");
        // Forces are of use only where points are on.
        let counted = if on { 0 } else { 2 };
        let k = law.stiffness * state[1] * THICKNESS;
        let force = k * 1e-3;
        let sizes = [force, force, 1e-3, force, force * 1e-3, force * 1e-3, force * 1e-3];
        for i in counted..expected.len() {
            let off = (found[i + 1] - expected[i]).abs();
            assert!(
                off <= ROUNDING * sizes[i],
                "{what}, number {i}: {state:?} gives {found:?}, not {expected:?}"
            );
        }
    }

    struct InLanes<'a>(&'a Law);

    impl WithSimd for InLanes<'_> {
        type Output = usize;

        fn with_simd<S: Simd>(self, simd: S) -> usize {
            let len = Vector::<S>::LEN;
            for group in states().chunks_exact(len) {
                let mut columns = [Vector::all(simd, 0.0); 6];
                for (i, column) in columns.iter_mut().enumerate() {
                    let numbers: Vec<f64> = group.iter().map(|state| state[i]).collect();
                    *column = Vector::load(simd, &numbers, 0);
                }
                let mut found = [[0.0; LANES]; 8];
                for (vector, numbers) in act(self.0, columns).into_iter().zip(&mut found) {
                    vector.store(numbers, 0);
                }
                for (l, state) in group.iter().enumerate() {
                    check(&format!("lane {l} of {len}"), self.0, *state, found.map(|numbers| numbers[l]));
                }
            }
            len
        }
    }

    #[test]
    fn analytic_law_of_a_textbook_at_single_points_and_in_every_lane() {
        let plain = Law::penalty(1e6).expect("a positive stiffness");
        let damped = plain.with_damping(0.1, 1.0).expect("a possible ratio");
        let rough = damped.with_friction(0.2).expect("a possible coefficient");
        for law in [plain, damped, rough, rough.with_onset(2e-4).expect("a possible onset")] {
            let (mut sticks, mut slides) = (0, 0);
            for state in states() {
                check("single point", &law, state, act(&law, state));
                let [pressure, shear, _, damping, ..] = textbook(&law, state);
                let limit = law.friction * (pressure - damping) * (1.0 - 1e-12);
                sticks += usize::from(shear != 0.0 && shear.abs() < limit);
                slides += usize::from(shear != 0.0 && shear.abs() >= limit);
            }
            assert!(law.friction == 0.0 || (sticks > 10 && slides > 10), "{sticks} stick, {slides} slide");
            assert_eq!(InLanes(&law).with_simd(Scalar), 1);
            #[cfg(target_arch = "x86_64")]
            if let Some(avx2) = pulp::x86::V3::try_new() {
                assert_eq!(Simd::vectorize(avx2, InLanes(&law)), 4);
            }
            assert!(Arch::new().dispatch(InLanes(&law)) <= LANES);
        }
    }
}
