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
        let Self { points, candidates, awake, nearest, doze, history } = self;
        let mut outcomes = [Outcome::default(); LANES];
        let mut own = [[0; LANES]; 2];
        let (mut begin, mut pattern) = ([0; LANES], [0; LANES]);
        let mut len = [0; LANES];
        for l in 0..LANES {
            // Lanes without a facet go along with the first one, closed.
            let candidate = candidates.get(l).unwrap_or(&candidates[0]);
            [own[0][l], own[1][l]] = candidate.ends;
            (begin[l], pattern[l], len[l]) =
                (candidate.first, candidate.pattern.first, candidate.pattern.points);
        }
        let alike = pattern == [pattern[0]; LANES];
        let chord = Chord::each(simd, at, &own);
        let mut on_own = OnChords::none(simd, own);
        let mut met: Option<(Meeting<V>, OnChords<V>)> = None;
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
            let zero = Vector::all(simd, 0.0);
            let spots = Spots {
                open: Vector::ones(simd, open),
                place,
                weight,
                slip: if MEMORY { gather(simd, &history.slip, &point) } else { zero },
                damping: if MEMORY { gather(simd, &history.damping, &point) } else { zero },
            };
            // Points of a facet mostly meet the same chord.
            if met.as_ref().is_none_or(|(_, on_other)| on_other.ends != other) {
                if let Some((_, on_other)) = &met {
                    on_other.flush(push);
                }
                let meeting = Meeting::new(&chord, &Chord::each(simd, at, &other));
                met = Some((meeting, OnChords::none(simd, other)));
            }
            let Some((meeting, on_other)) = &mut met else { continue };
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
            let [fx, fy] = acting.force;
            on_own.add(on, [fx, fy], spots.place);
            on_other.add(on, [-fx, -fy], acting.foot);
            let [mut slip, mut damping] = [[0.0; LANES]; 2];
            if MEMORY {
                acting.acts.slip.store(&mut slip, 0);
                acting.acts.damping.store(&mut damping, 0);
            }
            for l in (0..Vector::<V>::LEN).filter(|l| on >> l & 1 == 1) {
                let i = point[l] as usize;
                if MEMORY {
                    (history.slip[i], history.damping[i]) = (slip[l], damping[l]);
                }
                outcomes[l].touched = true;
                outcomes[l].left &= !(1 << k);
            }
        }
        if let Some((_, on_other)) = &met {
            on_other.flush(push);
        }
        let [mut fx, mut fy] = [[0.0; LANES]; 2];
        on_own.force[0].store(&mut fx, 0);
        on_own.force[1].store(&mut fy, 0);
        (0..Vector::<V>::LEN).for_each(|l| outcomes[l].force = [fx[l], fy[l]]);
        on_own.flush(push);
        outcomes
    }
}

/// Forces on a chord in each lane.
#[derive(Clone, Copy)]
struct OnChords<V: Simd> {
    /// Slots of its ends.
    ends: [[u32; LANES]; 2],
    /// Sum of the forces, and of their products with their place on the chord.
    force: [Vector<V>; 2],
    with_place: [Vector<V>; 2],
    /// Bits of lanes with forces.
    lanes: u64,
}

impl<V: Simd> OnChords<V> {
    #[inline(always)]
    fn none(simd: V, ends: [[u32; LANES]; 2]) -> Self {
        let zero = [Vector::all(simd, 0.0); 2];
        Self { ends, force: zero, with_place: zero, lanes: 0 }
    }

    #[inline(always)]
    fn add(&mut self, lanes: u64, [fx, fy]: [Vector<V>; 2], place: Vector<V>) {
        self.lanes |= lanes;
        self.force = [self.force[0] + fx, self.force[1] + fy];
        let [wx, wy] = self.with_place;
        self.with_place = [fx.times_plus(place, wx), fy.times_plus(place, wy)];
    }

    /// Hands the forces over to the nodes; what neighbouring chords do to a node that they share, at once.
    #[inline(always)]
    fn flush(&self, push: &mut Vec<Push>) {
        if self.lanes == 0 {
            return;
        }
        let [mut ax, mut ay, mut bx, mut by] = [[0.0; LANES]; 4];
        (self.force[0] - self.with_place[0]).store(&mut ax, 0);
        (self.force[1] - self.with_place[1]).store(&mut ay, 0);
        self.with_place[0].store(&mut bx, 0);
        self.with_place[1].store(&mut by, 0);
        let mut held: Option<Push> = None;
        for l in (0..Vector::<V>::LEN).filter(|l| self.lanes >> l & 1 == 1) {
            let (mut first, mut second) =
                ((self.ends[0][l], [ax[l], ay[l]]), (self.ends[1][l], [bx[l], by[l]]));
            match held {
                Some((node, f)) if node == first.0 => first.1 = [first.1[0] + f[0], first.1[1] + f[1]],
                Some((node, f)) if node == second.0 => {
                    second.1 = [second.1[0] + f[0], second.1[1] + f[1]];
                    (first, second) = (second, first);
                }
                Some(other) => push.push(other),
                None => {}
            }
            push.push(first);
            held = Some(second);
        }
        push.extend(held);
    }
}
