//! Many facets with few points each, as in a seat: a facet in each lane.
//!
//! What lies near the end of the other chord or near a corner is left over.

use pulp::Simd;
use stribeck_simd::lanes::{LANES, Number, Vector};
use stribeck_solver::state::Moment;

use crate::{
    meeting::{Chord, Joined, Joints, Meeting, Spots, gather},
    pass::Candidate,
    points::Points,
    shape::Push,
    surface::Surface,
    touch::Histories,
    touch_row::{Law, Work},
};

/// Facets with more points than this fill vectors of their own.
pub(crate) const MOST_POINTS: usize = 4;

/// Some facets of a pass, at most as many as there are lanes, whose points lie side by side.
pub(crate) struct Band<'a> {
    pub(crate) points: &'a Points,
    pub(crate) candidates: &'a [Candidate],
    /// Of all points of the pass: where they were found last, until when they doze, what they remember.
    pub(crate) nearest: &'a [u32],
    pub(crate) doze: &'a mut [f64],
    pub(crate) history: &'a mut Histories,
}

/// What became of a band's facets; bits are those of lanes.
pub(crate) struct BandOutcome<V: Simd> {
    /// Facets of which a point touches.
    pub(crate) touched: u64,
    /// Facets whose first, second and so on point is awake and left over.
    pub(crate) left: [u64; MOST_POINTS],
    /// When the next point of each facet wakes; of use where none touches and none is left.
    pub(crate) soonest: Vector<V>,
    /// Sum of the forces on the facets [N].
    pub(crate) force: [f64; 2],
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
    ) -> BandOutcome<V> {
        let Self { points, candidates, nearest, doze, history } = self;
        let (zero, one) = (Vector::all(simd, 0.0), Vector::all(simd, 1.0));
        let soon = Vector::all(simd, now + 1.0);
        let base = candidates[0].first as usize;
        // Lanes without a facet go along with the first one; their points never wake.
        let lanes = Vector::<V>::LEN;
        let mut pattern = [candidates[0].pattern.first; LANES];
        let mut alike = true;
        let own = Joined::new(lanes, |l| {
            let candidate = candidates.get(l).unwrap_or(&candidates[0]);
            pattern[l] = candidate.pattern.first;
            alike &= pattern[l] == pattern[0];
            candidate.ends
        });
        let mut chord = None;
        let mut on_own = OnChords::none(simd, own);
        let mut met: Option<(Facing, Meeting<V>, OnChords<V>)> = None;
        let (mut touched, mut left) = (0, [0; MOST_POINTS]);
        let mut soonest = Vector::all(simd, f64::INFINITY);
        for k in 0..points.most {
            let i = base + k * LANES;
            let mut dozes = Vector::load(simd, doze, i);
            let awake = dozes.choose_below(soon, one, zero);
            left[k] = awake.bits();
            if left[k] == 0 {
                soonest = soonest.min(dozes);
                continue;
            }
            // Points of a facet mostly meet the same chord.
            let facets = &nearest[i..i + lanes];
            if met.as_ref().is_none_or(|(facing, ..)| facing.facets[..lanes] != *facets) {
                if let Some((.., on_other)) = &met {
                    on_other.flush(push);
                }
                let mine = match chord {
                    Some(mine) => mine,
                    None => Chord::each(simd, at, &own),
                };
                chord = Some(mine);
                let facing = Facing::new(primary, facets);
                let meeting = Meeting::new(&mine, &Chord::each(simd, at, &facing.chords));
                let on_other = OnChords::none(simd, facing.chords);
                met = Some((facing, meeting, on_other));
            }
            let Some((facing, meeting, on_other)) = &mut met else { continue };
            let (place, weight) = if alike {
                let i = pattern[0] as usize + k;
                (Vector::all(simd, points.place[i]), Vector::all(simd, points.weight[i]))
            } else {
                // Facets with fewer points never wake here.
                let of = pattern.map(|first| (first + k as u32).min(points.place.len() as u32 - 1));
                (gather(simd, &points.place, &of), gather(simd, &points.weight, &of))
            };
            let spots = Spots {
                open: Vector::ones(simd, left[k] & !facing.beside_corner),
                place,
                weight,
                slip: if MEMORY { Vector::load(simd, &history.slip, i) } else { zero },
                damping: if MEMORY { Vector::load(simd, &history.damping, i) } else { zero },
            };
            let acting = meeting.act::<MEMORY>(law, &spots, work);
            let (on, apart) = (acting.acts.on.bits(), acting.acts.apart.bits());
            if apart != 0 {
                dozes = zero.choose_below(acting.acts.apart, acting.acts.doze, dozes);
                dozes.store(doze, i);
            }
            soonest = soonest.min(dozes);
            left[k] &= !(on | apart);
            if on == 0 {
                continue;
            }
            touched |= on;
            if MEMORY {
                acting.acts.slip.store(&mut history.slip, i);
                acting.acts.damping.store(&mut history.damping, i);
            }
            let [fx, fy] = acting.force;
            on_own.add(on, [fx, fy], spots.place);
            on_other.add(on, [-fx, -fy], acting.foot);
        }
        if let Some((.., on_other)) = &met {
            on_other.flush(push);
        }
        on_own.flush(push);
        BandOutcome { touched, left, soonest, force: [on_own.force[0].sum(), on_own.force[1].sum()] }
    }
}

/// The chords that a band's points face.
struct Facing {
    facets: [u32; LANES],
    chords: Joined,
    /// Bits of those beside a corner.
    beside_corner: u64,
}

impl Facing {
    #[inline(always)]
    fn new(primary: &Surface, found: &[u32]) -> Self {
        let mut facets = [0; LANES];
        facets[..found.len()].copy_from_slice(found);
        let mut beside_corner = 0;
        let chords = Joined::new(found.len(), |l| {
            let facet = found[l] as usize;
            beside_corner |= u64::from(primary.beside_corner[facet]) << l;
            let (a, b) = primary.ends(facet);
            [a as u32, b as u32]
        });
        Self { facets, chords, beside_corner }
    }
}

/// Forces on a chord in each lane.
#[derive(Clone, Copy)]
struct OnChords<V: Simd> {
    chords: Joined,
    /// Sum of the forces, and of their products with their place on the chord.
    force: [Vector<V>; 2],
    with_place: [Vector<V>; 2],
    /// Bits of lanes with forces.
    lanes: u64,
}

impl<V: Simd> OnChords<V> {
    #[inline(always)]
    fn none(simd: V, chords: Joined) -> Self {
        let zero = [Vector::all(simd, 0.0); 2];
        Self { chords, force: zero, with_place: zero, lanes: 0 }
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
        let [first, second] = self.chords.ends;
        let on_second = self.with_place;
        let on_first = [self.force[0] - on_second[0], self.force[1] - on_second[1]];
        let zero = on_first[0].constant(0.0);
        let (nodes, [fx, fy], last, [lx, ly]) = match self.chords.joints {
            Joints::Ahead { .. } => {
                let on = [
                    on_first[0] + on_second[0].shifted_in(zero),
                    on_first[1] + on_second[1].shifted_in(zero),
                ];
                (first, on, Some(second), on_second)
            }
            Joints::Back => {
                let on = [
                    on_second[0] + on_first[0].shifted_in(zero),
                    on_second[1] + on_first[1].shifted_in(zero),
                ];
                (second, on, Some(first), on_first)
            }
            Joints::None => (first, on_first, None, on_second),
        };
        let [mut x, mut y] = [[0.0; LANES]; 2];
        fx.store(&mut x, 0);
        fy.store(&mut y, 0);
        let [mut u, mut v] = [[0.0; LANES]; 2];
        lx.store(&mut u, 0);
        ly.store(&mut v, 0);
        let lanes = Vector::<V>::LEN;
        if let Some(last) = last {
            push.extend((0..lanes).map(|l| (nodes[l], [x[l], y[l]])));
            push.push((last[lanes - 1], [u[lanes - 1], v[lanes - 1]]));
        } else {
            for l in (0..lanes).filter(|l| self.lanes >> l & 1 == 1) {
                push.push((first[l], [x[l], y[l]]));
                push.push((second[l], [u[l], v[l]]));
            }
        }
    }
}
