//! Many points of one chord: whole vectors of them, each against the one of two chords of the other surface that is below it
//! (PERFORMANCE.md §2).
//!
//! What lies near the end of the other chord, near a corner, or does not touch is left over.

use pulp::Simd;
use stribeck_simd::lanes::{LANES, Number, Vector};
use stribeck_solver::state::Moment;

use crate::{
    meeting::{Meeting, Spots, ends},
    pass::Candidate,
    points::{Method, Points},
    shape::Push,
    surface::Surface,
    touch::Histories,
    touch_row::{Law, Work},
};

/// Room for the points of a facet: two of them may be corners.
const ROOM: usize = Method::MOST_POINTS + LANES;

/// The points of one facet of a pass.
pub(crate) struct Row<'a> {
    pub(crate) candidate: &'a Candidate,
    pub(crate) points: &'a Points,
    /// Of all points of the pass: where they were found last, until when they doze, what they remember.
    pub(crate) nearest: &'a [u32],
    pub(crate) doze: &'a mut [f64],
    pub(crate) history: &'a mut Histories,
    /// Surfaces whose points and facets meet, and when: the moment, and steps since the search.
    pub(crate) secondary: &'a Surface,
    pub(crate) primary: &'a Surface,
    pub(crate) at: &'a Moment<'a>,
    pub(crate) now: f64,
}

/// How far vectors of points came.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Outcome {
    /// Whether a point touches.
    pub(crate) touched: bool,
    /// Bits of the awake points that are left over.
    pub(crate) left: u64,
    /// Force on the facet [N].
    pub(crate) force: [f64; 2],
}

/// One where a point is awake and not done yet, for all points of a row.
pub(crate) type Open = [f64; ROOM];

impl Row<'_> {
    /// Points that are awake, and their bits.
    #[inline(always)]
    pub(crate) fn open<V: Simd>(&self, simd: V) -> (Open, u64) {
        let (range, len) = (self.candidate.range(), Vector::<V>::LEN);
        let n = range.len();
        let (zero, one) = (Vector::all(simd, 0.0), Vector::all(simd, 1.0));
        let (mut open, mut bits) = ([0.0; ROOM], 0);
        for start in (0..n).step_by(len) {
            let dozes = Vector::load(simd, self.doze, range.start + start);
            let awake = dozes.choose_below(Vector::all(simd, self.now + 1.0), one, zero);
            let awake = awake.first(len.min(n - start));
            awake.store(&mut open, start);
            bits |= awake.bits() << start;
        }
        (open, bits)
    }

    /// Chords against chords: evaluates the points that certainly touch and pushes their forces, lets those doze that
    /// certainly do not. Feet follow one another, mostly on one chord or on two: each point takes the one below it.
    #[inline(always)]
    pub(crate) fn touch<V: Simd, const MEMORY: bool>(
        self,
        simd: V,
        law: &Law<V>,
        work: &mut Work<V>,
        push: &mut Vec<Push>,
    ) -> Outcome {
        let (mut open, left) = self.open(simd);
        let mut outcome = Outcome { left, ..Outcome::default() };
        let Self { candidate, points, nearest, doze, history, primary, at, .. } = self;
        let (range, pattern) = (candidate.range(), candidate.pattern.first as usize);
        let (n, len) = (range.len(), Vector::<V>::LEN);
        let own = (candidate.ends[0] as usize, candidate.ends[1] as usize);
        let zero = Vector::all(simd, 0.0);
        let chord = ends(at, own);
        let mut untried = left;
        let mut tried = None;
        while untried != 0 {
            let k = untried.trailing_zeros() as usize;
            let last = untried.ilog2() as usize;
            untried &= untried - 1;
            let [a, b] = [k, last].map(|k| nearest[range.start + k] as usize);
            if tried == Some(a) || primary.beside_corner[a] {
                continue;
            }
            tried = Some(a);
            let b = if primary.beside_corner[b] { a } else { b };
            if primary.adjoin(a, b) {
                untried = 0;
            }
            let (near_ends, far_ends) = (primary.ends(a), primary.ends(b));
            let near = Meeting::all(simd, &chord, &ends(at, near_ends));
            let far = if a == b { None } else { Some(Meeting::all(simd, &chord, &ends(at, far_ends))) };
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
                let spots = Spots {
                    open: Vector::load(simd, &open, start),
                    place: Vector::load(simd, &points.place, pattern + start),
                    weight: Vector::load(simd, &points.weight, pattern + start),
                    slip: if MEMORY { Vector::load(simd, &history.slip, i) } else { zero },
                    damping: if MEMORY { Vector::load(simd, &history.damping, i) } else { zero },
                };
                let (mut meeting, mut is_far) = (near, zero);
                if let Some(far) = &far {
                    is_far = near.beyond(spots.place, follows);
                    meeting = Meeting::chosen(is_far, far, &near);
                }
                let acting = meeting.act::<MEMORY>(law, &spots, work);
                let (on, apart) = (acting.acts.on.bits() << start, acting.acts.apart.bits() << start);
                if apart != 0 {
                    let dozes = Vector::load(simd, doze, i);
                    zero.choose_below(acting.acts.apart, acting.acts.doze, dozes).store(doze, i);
                }
                (spots.open - acting.acts.on - acting.acts.apart).store(&mut open, start);
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
                with_place = [fx.times_plus(spots.place, wx), fy.times_plus(spots.place, wy)];
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
