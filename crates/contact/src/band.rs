//! Many facets with few points each, as in a seat: a facet in each lane.
//!
//! What lies near the end of the other chord, near a corner, or does not touch is left over.

use pulp::Simd;
use stribeck_solver::{
    lanes::{LANES, Number, Vector},
    state::Moment,
};

use crate::{
    meeting::{Chord, Meeting, Spots, gather},
    pass::Candidate,
    points::Points,
    row::Outcome,
    shape::Push,
    surface::Surface,
    touch::Histories,
    touch_row::{Law, Work},
};

/// Facets with more points than this fill vectors of their own.
pub(crate) const MOST_POINTS: usize = 4;

/// Some facets of a pass, at most as many as there are lanes.
pub(crate) struct Band<'a> {
    pub(crate) secondary: &'a Surface,
    pub(crate) points: &'a Points,
    /// Facets, and bits of those that are awake.
    pub(crate) candidates: &'a [Candidate],
    pub(crate) awake: u64,
    /// Of all points of the pass: where they were found last, until when they doze, what they remember.
    pub(crate) nearest: &'a [u32],
    pub(crate) doze: &'a mut [f64],
    pub(crate) history: &'a mut Histories,
}

impl Band<'_> {
    /// Evaluates the points that certainly touch and pushes their forces.
    #[inline(always)]
    #[allow(clippy::too_many_arguments)] // the facets' whole situation
    pub(crate) fn touch<V: Simd, const MEMORY: bool>(
        self,
        simd: V,
        law: &Law<V>,
        now: f64,
        primary: &Surface,
        at: &Moment<'_>,
        work: &mut Work<V>,
        push: &mut Vec<Push>,
    ) -> [Outcome; LANES] {
        let Self { secondary, points, candidates, awake, nearest, doze, history } = self;
        let mut outcomes = [Outcome::default(); LANES];
        let mut own = [[0; LANES]; 2];
        let (mut begin, mut pattern) = ([0; LANES], [0; LANES]);
        let mut len = [0; LANES];
        for l in 0..LANES {
            // Lanes without a facet go along with the first one, closed.
            let candidate = candidates.get(l).unwrap_or(&candidates[0]);
            let (a, b) = secondary.ends(candidate.facet as usize);
            (own[0][l], own[1][l]) = (a as u32, b as u32);
            (begin[l], pattern[l], len[l]) =
                (candidate.first, candidate.pattern.first, candidate.pattern.points);
        }
        let alike = pattern == [pattern[0]; LANES];
        let chord = Chord::each(simd, at, &own);
        let zero = Vector::all(simd, 0.0);
        let (mut force, mut with_place) = ([zero; 2], [zero; 2]);
        let mut any = false;
        for k in 0..points.most as u32 {
            let mut other = [[0; LANES]; 2];
            let mut point = begin;
            let mut open = 0;
            for l in 0..LANES {
                let there = awake >> l & 1 == 1 && k < len[l];
                // So do lanes without a point, with the first one of their facet.
                let step = if there { k } else { 0 };
                point[l] += step;
                let i = point[l] as usize;
                let facet = nearest[i] as usize;
                if there && doze[i] < now + 1.0 {
                    outcomes[l].left |= 1 << k;
                    open |= u64::from(!primary.beside_corner[facet]) << l;
                }
                let (a, b) = primary.ends(facet);
                (other[0][l], other[1][l]) = (a as u32, b as u32);
            }
            let (place, weight) = if alike {
                let i = (pattern[0] + k) as usize;
                (Vector::all(simd, points.place[i]), Vector::all(simd, points.weight[i]))
            } else {
                let mut i = pattern;
                i.iter_mut().zip(&len).for_each(|(i, len)| *i += if k < *len { k } else { 0 });
                (gather(simd, &points.place, &i), gather(simd, &points.weight, &i))
            };
            let spots = Spots {
                open: Vector::ones(simd, open),
                place,
                weight,
                slip: if MEMORY { gather(simd, &history.slip, &point) } else { zero },
                damping: if MEMORY { gather(simd, &history.damping, &point) } else { zero },
            };
            let meeting = Meeting::new(&chord, &Chord::each(simd, at, &other));
            let acting = meeting.act::<MEMORY>(law, &spots, work);
            let (on, apart) = (acting.acts.on.bits(), acting.acts.apart.bits());
            if apart != 0 {
                let mut dozes = [0.0; LANES];
                acting.acts.doze.store(&mut dozes, 0);
                for l in (0..Vector::<V>::LEN).filter(|l| apart >> l & 1 == 1) {
                    doze[point[l] as usize] = dozes[l];
                    outcomes[l].left &= !(1 << k);
                }
            }
            if on == 0 {
                continue;
            }
            any = true;
            let [fx, fy] = acting.force;
            force = [force[0] + fx, force[1] + fy];
            let [wx, wy] = with_place;
            with_place = [fx.times_plus(spots.place, wx), fy.times_plus(spots.place, wy)];
            let [mut slip, mut damping] = [[0.0; LANES]; 2];
            acting.acts.slip.store(&mut slip, 0);
            acting.acts.damping.store(&mut damping, 0);
            let (second_x, second_y) = (fx * acting.foot, fy * acting.foot);
            let [mut first_fx, mut first_fy, mut second_fx, mut second_fy] = [[0.0; LANES]; 4];
            (second_x - fx).store(&mut first_fx, 0);
            (second_y - fy).store(&mut first_fy, 0);
            (-second_x).store(&mut second_fx, 0);
            (-second_y).store(&mut second_fy, 0);
            for l in 0..Vector::<V>::LEN {
                if on >> l & 1 == 0 {
                    continue;
                }
                let i = point[l] as usize;
                if MEMORY {
                    (history.slip[i], history.damping[i]) = (slip[l], damping[l]);
                }
                outcomes[l].touched = true;
                outcomes[l].left &= !(1 << k);
                push.push((other[0][l], [first_fx[l], first_fy[l]]));
                push.push((other[1][l], [second_fx[l], second_fy[l]]));
            }
        }
        if any {
            let [mut fx, mut fy, mut sx, mut sy] = [[0.0; LANES]; 4];
            force[0].store(&mut fx, 0);
            force[1].store(&mut fy, 0);
            with_place[0].store(&mut sx, 0);
            with_place[1].store(&mut sy, 0);
            for l in 0..Vector::<V>::LEN {
                if outcomes[l].touched {
                    outcomes[l].force = [fx[l], fy[l]];
                    push.push((own[0][l], [fx[l] - sx[l], fy[l] - sy[l]]));
                    push.push((own[1][l], [sx[l], sy[l]]));
                }
            }
        }
        outcomes
    }
}
