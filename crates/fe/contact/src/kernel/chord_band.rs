//! Bands of chords with few points each: a chord in each lane.
//!
//! Points near the end of the other chord or near a corner are left to scalar code.

use pulp::Simd;
use stribeck_simd::lanes::{LANES, Number, Vector};
use stribeck_solver::state::Moment;

use super::{
    chord_lanes::{ChordLanes, Joints, gather},
    chord_pair::{ChordPair, ChordPoints, MovingChord},
    law::{LawKernel, Totals},
};
use crate::{
    memory::{Candidate, Histories},
    points::{FEW_POINTS, Points},
};
use stribeck_surface::{Surface, foot::Push, plane::choose};

/// Some facets of a pass, at most as many as there are lanes, whose points lie side by side.
pub(crate) struct ChordBand<'a> {
    pub(crate) points: &'a Points,
    pub(crate) candidates: &'a [Candidate],
    /// Of all points of the pass: last facet, time until which they are inactive, and history.
    pub(crate) nearest: &'a [u32],
    pub(crate) inactive_until: &'a mut [f64],
    pub(crate) history: &'a mut Histories,
}

/// Results of a band's facets; one bit a lane.
pub(crate) struct BandOutcome<V: Simd> {
    /// Facets of which a point touches.
    pub(crate) touched: u64,
    /// Facets whose first, second and so on point is active and left to scalar code.
    pub(crate) left: [u64; FEW_POINTS],
    /// When the next point of each facet becomes active; valid where none touches and none is left.
    pub(crate) soonest: Vector<V>,
    /// Sum of the forces on the facets [N].
    pub(crate) force: [f64; 2],
}

impl ChordBand<'_> {
    /// Evaluates the points that certainly touch and pushes their forces.
    #[inline(always)]
    #[allow(clippy::too_many_arguments)] // the facets' whole situation
    pub(crate) fn touch<V: Simd, const MEMORY: bool>(
        self,
        simd: V,
        law: &LawKernel<Vector<V>>,
        now: f64,
        primary: &Surface,
        at: &Moment<'_>,
        totals: &mut Totals<Vector<V>>,
        push: &mut Vec<Push>,
    ) -> BandOutcome<V> {
        let Self { points, candidates, nearest, inactive_until, history } = self;
        let (zero, one) = (Vector::all(simd, 0.0), Vector::all(simd, 1.0));
        let soon = Vector::all(simd, now + 1.0);
        let base = candidates[0].first as usize;
        // Lanes without a facet repeat the first one; their points are never active.
        let lanes = Vector::<V>::LEN;
        let mut pattern = [candidates[0].pattern.first; LANES];
        let mut alike = true;
        let own = ChordLanes::new(lanes, |l| {
            let candidate = candidates.get(l).unwrap_or(&candidates[0]);
            pattern[l] = candidate.pattern.first;
            alike &= pattern[l] == pattern[0];
            candidate.ends
        });
        let mut chord = None;
        let mut on_own = OnChords::none(simd, own);
        let mut met: Option<(Facing, ChordPair<Vector<V>>, OnChords<V>)> = None;
        let (mut touched, mut left) = (0, [0; FEW_POINTS]);
        let mut soonest = Vector::all(simd, f64::INFINITY);
        for k in 0..points.most {
            let i = base + k * LANES;
            let mut until = Vector::load(simd, inactive_until, i);
            let active = until.choose_below(soon, one, zero);
            left[k] = active.bits();
            if left[k] == 0 {
                soonest = soonest.min(until);
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
                    None => MovingChord::each(simd, at, &own),
                };
                chord = Some(mine);
                let facing = Facing::new(primary, facets);
                let pair = ChordPair::new(&mine, &MovingChord::each(simd, at, &facing.chords));
                let on_other = OnChords::none(simd, facing.chords);
                met = Some((facing, pair, on_other));
            }
            let Some((facing, pair, on_other)) = &mut met else { continue };
            let (place, weight) = if alike {
                let i = pattern[0] as usize + k;
                (Vector::all(simd, points.place[i]), Vector::all(simd, points.weight[i]))
            } else {
                // Facets with fewer points are never active here.
                let of = pattern.map(|first| (first + k as u32).min(points.place.len() as u32 - 1));
                (gather(simd, &points.place, &of), gather(simd, &points.weight, &of))
            };
            let of_band = ChordPoints {
                active: Vector::ones(simd, left[k] & !facing.beside_corner),
                place,
                weight,
                slip: if MEMORY { Vector::load(simd, &history.slip, i) } else { zero },
                damping: if MEMORY { Vector::load(simd, &history.damping, i) } else { zero },
            };
            let acting = pair.act::<MEMORY>(law, &of_band, totals);
            let (on, apart) = (acting.acts.on.bits(), acting.acts.apart.bits());
            if apart != 0 {
                until = choose(acting.acts.apart, acting.acts.inactive_until, until);
                until.store(inactive_until, i);
            }
            soonest = soonest.min(until);
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
            on_own.add(on, [fx, fy], of_band.place);
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
    chords: ChordLanes,
    /// Bits of those beside a corner.
    beside_corner: u64,
}

impl Facing {
    #[inline(always)]
    fn new(primary: &Surface, found: &[u32]) -> Self {
        let mut facets = [0; LANES];
        facets[..found.len()].copy_from_slice(found);
        let mut beside_corner = 0;
        let chords = ChordLanes::new(found.len(), |l| {
            let facet = found[l] as usize;
            beside_corner |= u64::from(primary.beside_corner()[facet]) << l;
            let (a, b) = primary.ends(facet);
            [a as u32, b as u32]
        });
        Self { facets, chords, beside_corner }
    }
}

/// Forces on a chord in each lane.
#[derive(Clone, Copy)]
struct OnChords<V: Simd> {
    chords: ChordLanes,
    /// Sum of the forces, and of their products with their place on the chord.
    force: [Vector<V>; 2],
    with_place: [Vector<V>; 2],
    /// Bits of lanes with forces.
    lanes: u64,
}

impl<V: Simd> OnChords<V> {
    #[inline(always)]
    fn none(simd: V, chords: ChordLanes) -> Self {
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

    /// Adds the forces to the nodes; those of neighbouring chords on a shared node in one addition.
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
