//! Many points of one chord: whole vectors of them against one chord of the other surface at a time (PERFORMANCE.md §2).
//!
//! What lies near the end of the other chord, near a corner, or does not touch is left over.

use std::ops::Range;

use pulp::Simd;
use stribeck_solver::{
    lanes::{LANES, Number, Vector},
    state::Moment,
};

use crate::{
    meeting::{Account, Chord, Laws, Meeting, Spots, ends},
    points::{Method, Points},
    shape::Push,
    surface::Surface,
    touch::Histories,
};

/// Room for the points of a facet: two of them may be corners.
const ROOM: usize = Method::MOST_POINTS + LANES;

/// The points of one facet of a pass.
pub(crate) struct Row<'a> {
    pub(crate) points: &'a Points,
    pub(crate) range: Range<usize>,
    /// Of all points of the pass: where they were found last, until when they doze, what they remember.
    pub(crate) nearest: &'a [u32],
    pub(crate) doze: &'a mut [f64],
    pub(crate) history: &'a mut Histories,
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

impl Row<'_> {
    /// Evaluates the points that certainly touch and pushes their forces.
    #[inline(always)]
    #[allow(clippy::too_many_arguments)] // a facet's whole situation
    pub(crate) fn touch<V: Simd, const MEMORY: bool>(
        self,
        simd: V,
        laws: &Laws<V>,
        now: f64,
        own: (usize, usize),
        primary: &Surface,
        at: &Moment<'_>,
        account: &mut Account<V>,
        push: &mut Vec<Push>,
    ) -> Outcome {
        let Self { points, range, nearest, doze, history } = self;
        let (n, len) = (range.len(), Vector::<V>::LEN);
        let mut outcome = Outcome::default();
        let mut open = [0.0; ROOM];
        let (zero, one) = (Vector::all(simd, 0.0), Vector::all(simd, 1.0));
        for start in (0..n).step_by(len) {
            let dozes = Vector::load(simd, doze, range.start + start);
            let awake = dozes.choose_below(Vector::all(simd, now + 1.0), one, zero).first(len.min(n - start));
            awake.store(&mut open, start);
            outcome.left |= awake.bits() << start;
        }
        let chord = Chord::all(simd, &ends(at, own));
        let mut untried = outcome.left;
        let mut tried = None;
        while untried != 0 {
            let k = untried.trailing_zeros() as usize;
            untried &= untried - 1;
            let facet = nearest[range.start + k] as usize;
            if tried == Some(facet) || primary.beside_corner[facet] {
                continue;
            }
            tried = Some(facet);
            // Feet follow one another: where first and last are on one facet, all are.
            if untried != 0 && nearest[range.start + untried.ilog2() as usize] as usize == facet {
                untried = 0;
            }
            let (a, b) = primary.ends(facet);
            let meeting = Meeting::new(laws, &chord, &Chord::all(simd, &ends(at, (a, b))));
            let mut force = [zero; 2];
            let (mut with_place, mut with_foot) = ([zero; 2], [zero; 2]);
            let (mut touches, mut done) = (false, 0);
            for start in (k / len * len..n).step_by(len) {
                let i = range.start + start;
                let spots = Spots {
                    open: Vector::load(simd, &open, start),
                    place: Vector::load(simd, &points.place, i),
                    weight: Vector::load(simd, &points.weight, i),
                    slip: if MEMORY { Vector::load(simd, &history.slip, i) } else { zero },
                    damping: if MEMORY { Vector::load(simd, &history.damping, i) } else { zero },
                };
                let acting = meeting.act::<MEMORY>(laws, &spots, account);
                let (on, apart) = (acting.on.bits() << start, acting.apart.bits() << start);
                if apart != 0 {
                    let dozes = Vector::load(simd, doze, i);
                    zero.choose_below(acting.apart, acting.doze, dozes).store(doze, i);
                }
                done |= on | apart;
                (spots.open - acting.on - acting.apart).store(&mut open, start);
                if on == 0 {
                    continue;
                }
                touches = true;
                if MEMORY {
                    acting.slip.store(&mut history.slip, i);
                    acting.damping.store(&mut history.damping, i);
                }
                let [fx, fy] = acting.force;
                force = [force[0] + fx, force[1] + fy];
                let [wx, wy] = with_place;
                with_place = [fx.times_plus(spots.place, wx), fy.times_plus(spots.place, wy)];
                let [wx, wy] = with_foot;
                with_foot = [fx.times_plus(acting.foot, wx), fy.times_plus(acting.foot, wy)];
            }
            outcome.left &= !done;
            untried &= !done;
            if !touches {
                continue;
            }
            outcome.touched = true;
            let [fx, fy] = [force[0].sum(), force[1].sum()];
            let [sx, sy] = [with_place[0].sum(), with_place[1].sum()];
            let [tx, ty] = [with_foot[0].sum(), with_foot[1].sum()];
            outcome.force = [outcome.force[0] + fx, outcome.force[1] + fy];
            push.push((own.0 as u32, [fx - sx, fy - sy]));
            push.push((own.1 as u32, [sx, sy]));
            push.push((a as u32, [tx - fx, ty - fy]));
            push.push((b as u32, [-tx, -ty]));
        }
        outcome
    }
}
