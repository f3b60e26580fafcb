//! Points of one chord against another chord: feet, motion and forces, over any [`Number`].
//!
//! On chords everything is linear in the place of a point, so all points need the same few operations,
//! whether they lie on one facet ([`chord_row`](super::chord_row)) or on many
//! ([`chord_band`](super::chord_band)). Points near the end of the other chord are left for
//! [`single_points`](super::single_points).

use stribeck_simd::lanes::Number;

use super::law::{LawKernel, PointState, Reaction, Totals};
use stribeck_surface::{
    chord::within_chord,
    foot::Sliding,
    plane::{choose, choose_each, cross, dot, force_of, minus, unit_normal},
    polynomial::{Coefficients, Polynomial},
};

/// A chord in motion: its first node and how much the second is beyond it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct MovingChord<N> {
    /// [m]
    pub(crate) position: Polynomial<N, 2>,
    /// [m/s]
    pub(crate) velocity: Polynomial<N, 2>,
}

/// Two chords that face each other; lane by lane, or the same in all lanes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ChordPair<N> {
    /// Point of place 0 relative to the other chord's first node [m], and how it changes to place 1.
    from: Polynomial<N, 2>,
    /// The other chord over its squared length [1/m], and its normal.
    other: [N; 2],
    normal: [N; 2],
    inverse: N,
    /// [m/s]
    own_motion: Polynomial<N, 2>,
    other_motion: Polynomial<N, 2>,
}

/// Points of the first chord that may touch: one in `active` where they do.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ChordPoints<N> {
    pub(crate) active: N,
    pub(crate) place: N,
    /// Length of surface that a point stands for [m].
    pub(crate) weight: N,
    /// See [`PointState`].
    pub(crate) slip: N,
    pub(crate) damping: N,
}

/// Law between them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ChordReaction<N> {
    pub(crate) acts: Reaction<N>,
    /// Force on each point [N]; zero where it does not touch.
    pub(crate) force: [N; 2],
    /// Place on the other chord; zero likewise.
    pub(crate) foot: N,
}

impl ChordPair<f64> {
    /// The same in all lanes: one root and one division instead of one a lane, which take five times as long.
    #[inline(always)]
    pub(crate) fn spread<N: Number>(&self, like: N) -> ChordPair<N> {
        ChordPair {
            from: spread(like, &self.from),
            other: [like.constant(self.other[0]), like.constant(self.other[1])],
            normal: [like.constant(self.normal[0]), like.constant(self.normal[1])],
            inverse: like.constant(self.inverse),
            own_motion: spread(like, &self.own_motion),
            other_motion: spread(like, &self.other_motion),
        }
    }
}

#[inline(always)]
fn spread<N: Number>(like: N, Polynomial([a, b]): &Polynomial<f64, 2>) -> Polynomial<N, 2> {
    Polynomial([[like.constant(a[0]), like.constant(a[1])], [like.constant(b[0]), like.constant(b[1])]])
}

impl<N: Number> ChordPair<N> {
    #[inline(always)]
    pub(crate) fn new(own: &MovingChord<N>, other: &MovingChord<N>) -> Self {
        let Polynomial([start, along]) = other.position;
        let Polynomial([first, change]) = own.position;
        let (normal, inverse) = unit_normal(along);
        let squared = inverse * inverse;
        Self {
            from: Polynomial([minus(first, start), change]),
            other: [along[0] * squared, along[1] * squared],
            normal,
            inverse,
            own_motion: own.velocity,
            other_motion: other.velocity,
        }
    }

    /// `yes` where the flag is one, `no` where it is zero: pairs of one chord with two others.
    #[inline(always)]
    pub(crate) fn chosen(flag: N, yes: &Self, no: &Self) -> Self {
        let (Polynomial(from), Polynomial(motion)) = (no.from, no.other_motion);
        Self {
            from: Polynomial([choose_each(flag, yes.from.0[0], from[0]), from[1]]),
            other: choose_each(flag, yes.other, no.other),
            normal: choose_each(flag, yes.normal, no.normal),
            inverse: choose(flag, yes.inverse, no.inverse),
            own_motion: no.own_motion,
            other_motion: Polynomial([
                choose_each(flag, yes.other_motion.0[0], motion[0]),
                choose_each(flag, yes.other_motion.0[1], motion[1]),
            ]),
        }
    }

    /// One where points at these places have their feet beyond the other chord, behind its end or before its
    /// beginning.
    #[inline(always)]
    pub(crate) fn beyond(&self, place: N, end: bool) -> N {
        let (zero, one) = (place.constant(0.0), place.constant(1.0));
        let foot = dot(self.from.value(place), self.other);
        if end { one.choose_below(foot, one, zero) } else { foot.choose_below(zero, one, zero) }
    }

    /// Forces on points, and energies; without `MEMORY` of the penalty alone.
    #[inline(always)]
    pub(crate) fn act<const MEMORY: bool>(
        &self,
        law: &LawKernel<N>,
        points: &ChordPoints<N>,
        totals: &mut Totals<N>,
    ) -> ChordReaction<N> {
        let ChordPoints { active, place, weight, slip, damping } = *points;
        let zero = place.constant(0.0);
        let r = self.from.value(place);
        let (foot, gap) = (dot(r, self.other), dot(r, self.normal));
        let within = within_chord(foot, gap, self.inverse, active);
        let relative = minus(self.own_motion.value(place), self.other_motion.value(foot));
        let sliding = Sliding { opening: dot(relative, self.normal), along: cross(self.normal, relative) };
        let acts = law.act::<MEMORY>(&PointState { within, gap, weight, sliding, slip, damping }, totals);
        let force = force_of(self.normal, acts.pressure, acts.shear);
        ChordReaction {
            acts,
            force: choose_each(acts.on, force, [zero; 2]),
            foot: choose(acts.on, foot, zero),
        }
    }
}
