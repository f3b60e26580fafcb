//! Rows of points on one chord: whole vectors of them, each against the one of two chords of the other
//! surface that is below it (PERFORMANCE.md §2).
//!
//! Points near the end of the other chord or near a corner are left to scalar code.

use pulp::Simd;
use stribeck_simd::lanes::{Number, Vector};

use super::{
    chord_pair::{ChordPair, ChordPoints, MovingChord},
    law::{LawKernel, Totals},
    row::{Outcome, Row},
};
use stribeck_surface::{foot::Push, plane::choose};

impl Row<'_> {
    /// Chords against chords: evaluates the points that certainly touch and pushes their forces; those that
    /// certainly do not are inactive for a while. Feet follow one another, mostly on one chord or on two:
    /// each point takes the one below it.
    #[inline(always)]
    pub(crate) fn touch_chords<V: Simd, const MEMORY: bool>(
        self,
        simd: V,
        law: &LawKernel<Vector<V>>,
        totals: &mut Totals<Vector<V>>,
        push: &mut Vec<Push>,
    ) -> Outcome {
        let (mut active, left) = self.active(simd);
        let mut outcome = Outcome { left, ..Outcome::default() };
        let Self { candidate, points, nearest, inactive_until, history, primary, at, .. } = self;
        let (range, pattern) = (candidate.range(), candidate.pattern.first as usize);
        let (n, len) = (range.len(), Vector::<V>::LEN);
        let own = (candidate.ends[0] as usize, candidate.ends[1] as usize);
        let zero = Vector::all(simd, 0.0);
        let chord = MovingChord::between(at, own);
        let mut untried = left;
        let mut tried = None;
        while untried != 0 {
            let k = untried.trailing_zeros() as usize;
            let last = untried.ilog2() as usize;
            untried &= untried - 1;
            let [a, b] = [k, last].map(|k| nearest[range.start + k] as usize);
            if tried == Some(a) || primary.beside_corner()[a] {
                continue;
            }
            tried = Some(a);
            let b = if primary.beside_corner()[b] { a } else { b };
            if primary.adjoin(a, b) {
                untried = 0;
            }
            let (near_ends, far_ends) = (primary.ends(a), primary.ends(b));
            let near = ChordPair::new(&chord, &MovingChord::between(at, near_ends)).spread(zero);
            let far = if a == b {
                None
            } else {
                Some(ChordPair::new(&chord, &MovingChord::between(at, far_ends)).spread(zero))
            };
            let follows = near_ends.1 == far_ends.0;
            let mut force = [zero; 2];
            let (mut with_place, mut with_foot) = ([zero; 2], [zero; 2]);
            let (mut on_far, mut with_far_foot) = ([zero; 2], [zero; 2]);
            let (mut touches, mut done) = (false, 0);
            for start in (k / len * len..n).step_by(len) {
                if outcome.left >> start & ((1 << len) - 1) == 0 {
                    continue;
                }
                let i = range.start + start;
                let of_row = ChordPoints {
                    active: Vector::load(simd, &active, start),
                    place: Vector::load(simd, &points.place, pattern + start),
                    weight: Vector::load(simd, &points.weight, pattern + start),
                    slip: if MEMORY { Vector::load(simd, &history.slip, i) } else { zero },
                    damping: if MEMORY { Vector::load(simd, &history.damping, i) } else { zero },
                };
                let (mut pair, mut is_far) = (near, zero);
                if let Some(far) = &far {
                    is_far = near.beyond(of_row.place, follows);
                    pair = ChordPair::chosen(is_far, far, &near);
                }
                let acting = pair.act::<MEMORY>(law, &of_row, totals);
                let (on, apart) = (acting.acts.on.bits() << start, acting.acts.apart.bits() << start);
                if apart != 0 {
                    let until = Vector::load(simd, inactive_until, i);
                    choose(acting.acts.apart, acting.acts.inactive_until, until).store(inactive_until, i);
                }
                (of_row.active - acting.acts.on - acting.acts.apart).store(&mut active, start);
                done |= on | apart;
                if on == 0 {
                    continue;
                }
                touches = true;
                if MEMORY {
                    acting.acts.slip.store(&mut history.slip, i);
                    acting.acts.damping.store(&mut history.damping, i);
                }
                let [fx, fy] = acting.force;
                force = [force[0] + fx, force[1] + fy];
                let [wx, wy] = with_place;
                with_place = [fx.times_plus(of_row.place, wx), fy.times_plus(of_row.place, wy)];
                let [wx, wy] = with_foot;
                with_foot = [fx.times_plus(acting.foot, wx), fy.times_plus(acting.foot, wy)];
                if far.is_some() {
                    let [fx, fy] = [is_far * fx, is_far * fy];
                    on_far = [on_far[0] + fx, on_far[1] + fy];
                    let [wx, wy] = with_far_foot;
                    with_far_foot = [fx.times_plus(acting.foot, wx), fy.times_plus(acting.foot, wy)];
                }
            }
            outcome.left &= !done;
            untried &= !done;
            if !touches {
                continue;
            }
            outcome.touched = true;
            let [fx, fy] = [force[0].sum(), force[1].sum()];
            let [sx, sy] = [with_place[0].sum(), with_place[1].sum()];
            let [mut tx, mut ty] = [with_foot[0].sum(), with_foot[1].sum()];
            outcome.force = [outcome.force[0] + fx, outcome.force[1] + fy];
            push.push((own.0 as u32, [fx - sx, fy - sy]));
            push.push((own.1 as u32, [sx, sy]));
            let (mut gx, mut gy) = (fx, fy);
            if far.is_some() {
                let [fx, fy] = [on_far[0].sum(), on_far[1].sum()];
                let [sx, sy] = [with_far_foot[0].sum(), with_far_foot[1].sum()];
                push.push((far_ends.0 as u32, [sx - fx, sy - fy]));
                push.push((far_ends.1 as u32, [-sx, -sy]));
                (gx, gy, tx, ty) = (gx - fx, gy - fy, tx - sx, ty - sy);
            }
            push.push((near_ends.0 as u32, [tx - gx, ty - gy]));
            push.push((near_ends.1 as u32, [-tx, -ty]));
        }
        outcome
    }
}
