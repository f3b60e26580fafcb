//! Normal forces between rollers and a raceway: penetration on the penalty, in series with the local
//! compliance of the bodies (THEORY §9.3). Eight rollers side by side, and one in scalar arithmetic where its
//! force is far from the expected one.

use pulp::Simd;
use stribeck_simd::lanes::{LANES, Number, Vector, vector_starts};

use crate::{
    contact::eight_facets::EightFacets,
    contact::outline::View,
    contact::penetration::{Pair, Penetration},
    contact::raceway::Raceway,
    contact::round::Contacts,
    contact::segments::Pose,
    law::ContactLaw,
    rollers::{
        Rim, Rollers,
        block::{Block, RacewayContacts},
    },
    row::{Row, lanes, load, of_one, store},
};

/// Most integrations over the overlap for the force of a contact in one time step, and steps of Newton's
/// method after each.
const SEARCHES: usize = 4;
const NEWTON: usize = 2;

/// Where the force differs by less than this share, or by less than this [N], from that at which the overlap
/// was integrated, its series leaves an error of the third power.
const ENOUGH: f64 = 3e-2;
const LITTLE: f64 = 1e-2;

/// Most steps of Newton's method for round rollers, whose overlaps are known at any force; and the last one,
/// as a share of the force and in [N], whose square is what it leaves.
const STEPS: usize = 8;
const STILL: f64 = 1e-5;

/// One contact of a roller with a raceway in the present step.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct NormalForce {
    /// Normal force of penalty and compliance [N].
    pub(crate) normal: f64,
    /// Derivative of the compliance's approach there [m/N].
    flexibility: f64,
    /// Deflection of the bodies [m].
    deflection: f64,
    /// Penetration at that force.
    overlap: Penetration,
}

/// A roller beside a raceway, in the frame of the raceway's outline.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RollerOnRaceway<'a> {
    pub(crate) raceway: &'a Raceway,
    pub(crate) rim: &'a Rim,
    pub(crate) centre: [f64; 2],
    /// Direction of the roller's vertex 0.
    pub(crate) spin: [f64; 2],
    /// Circle that nothing of the raceway stands out from there [m].
    pub(crate) bound: f64,
    /// By how much the roller's radius exceeds that of its rim [m].
    pub(crate) larger: f64,
    /// Force that is expected from the steps before [N].
    pub(crate) before: f64,
}

impl ContactLaw {
    /// Finds the normal forces between all rollers and both raceways, when centres and directions of vertex
    /// 0 are known in their frames. Every stage is taken for all groups of contacts before the next one:
    /// each waits for divisions and roots, and the processor computes others meanwhile. `parts` is scratch.
    #[inline(always)]
    pub(crate) fn normal_forces<S: Simd>(
        &self,
        simd: S,
        rollers: &Rollers,
        raceways: &[Raceway; 2],
        blocks: &mut [Block],
        parts: &mut [Penetration<Row>; LANES],
    ) {
        for block in &mut *blocks {
            let Block { top, larger, bits, round, contacts, .. } = block;
            for (raceway, contacts) in raceways.iter().zip(contacts) {
                Self::approach(simd, raceway, [top, larger], [*bits, *round], contacts);
            }
        }
        for block in &mut *blocks {
            for (raceway, contacts) in raceways.iter().zip(&mut block.contacts) {
                if contacts.near != 0 {
                    Self::predict(simd, raceway, contacts);
                }
            }
        }
        for block in &mut *blocks {
            for (raceway, contacts) in raceways.iter().zip(&mut block.contacts) {
                if contacts.near != contacts.near_round {
                    self.search_others(simd, rollers, raceway, block.first, contacts, parts);
                }
                Self::look_at_round(simd, raceway, contacts);
            }
        }
        for block in &mut *blocks {
            for (raceway, contacts) in raceways.iter().zip(&mut block.contacts) {
                if contacts.near_round != 0 {
                    self.search_round(simd, raceway, contacts);
                }
            }
        }
        for block in &mut *blocks {
            for (raceway, contacts) in raceways.iter().zip(&mut block.contacts) {
                Self::integrate_round(simd, raceway, contacts);
                for at in vector_starts(simd) {
                    let normal = Vector::load(simd, &contacts.normal, at);
                    (normal - Vector::load(simd, &contacts.force, at)).store(&mut contacts.growth, at);
                    normal.store(&mut contacts.force, at);
                }
            }
        }
    }

    /// Directions to the contacts of eight rollers, of which those `present` are there and those `round` have
    /// round rims, and those that may touch.
    #[inline(always)]
    fn approach<S: Simd>(
        simd: S,
        raceway: &Raceway,
        [top, larger]: [&Row; 2],
        [present, round]: [u64; 2],
        contacts: &mut RacewayContacts,
    ) {
        let all = |value: f64| Vector::all(simd, value);
        let zero = all(0.0);
        let outwards = all(raceway.outwards());
        let mut deep = 0;
        for at in vector_starts(simd) {
            let [x, y] = load(simd, &contacts.centre, at);
            let (x, y) = (x - all(raceway.centre[0]), y - all(raceway.centre[1]));
            let distance = x.times_plus(x, y * y).sqrt();
            let per = outwards / distance;
            // A larger roller meets a raceway as one does that is nearer to it.
            let distance = outwards.times_plus(Vector::load(simd, larger, at), distance);
            let bound = Vector::load(simd, &contacts.bound, at);
            let most = outwards.times_plus(distance - bound, Vector::load(simd, top, at));
            distance.store(&mut contacts.distance, at);
            let d = [x * per, y * per];
            store(d, &mut contacts.d, at);
            store(turned_back(load(simd, &contacts.spin, at), d), &mut contacts.own, at);
            most.store(&mut contacts.most, at);
            let start = Vector::load(simd, &contacts.force, at) + Vector::load(simd, &contacts.growth, at);
            start.max(zero).store(&mut contacts.start, at);
            zero.store(&mut contacts.normal, at);
            deep |= zero.bits_below(most) << at;
        }
        contacts.near = deep & present;
        contacts.near_round = if raceway.relief.is_some() { contacts.near & round } else { 0 };
    }

    /// Forces of rollers on chords, and of those whose rims are not round: by the parts of each, and one by
    /// one where that does not do. `parts` is scratch.
    #[inline(always)]
    fn search_others<S: Simd>(
        &self,
        simd: S,
        rollers: &Rollers,
        raceway: &Raceway,
        first: usize,
        contacts: &mut RacewayContacts,
        parts: &mut [Penetration<Row>; LANES],
    ) {
        let alone = Self::integrate(simd, rollers, raceway, first, contacts, parts);
        let again = self.search(simd, contacts);
        for lane in lanes(alone) {
            contacts.normal[lane] = contacts.start[lane];
        }
        for lane in lanes((again | alone) & !contacts.near_round) {
            let rim = rollers.rim(first + lane);
            let before = contacts.normal[lane];
            let (centre, spin) = (of_one(&contacts.centre, lane), of_one(&contacts.spin, lane));
            let (bound, larger) = (contacts.bound[lane], rollers.larger[first + lane]);
            let near = RollerOnRaceway { raceway, rim, centre, spin, bound, larger, before };
            let found = self.normal_force(simd, near, &mut contacts.hints[lane]);
            contacts.normal[lane] = found.normal;
            contacts.flexibility[lane] = found.flexibility;
            contacts.shift[lane] = found.deflection;
            contacts.overlap.set(lane, &found.overlap);
        }
    }

    /// Forces of round rollers whose pieces are known, by Newton's method: each goes on until it is still itself,
    /// whichever others are beside it in a vector, so that vectors of any width give the same.
    #[inline(always)]
    fn search_round<S: Simd>(&self, simd: S, raceway: &Raceway, contacts: &mut RacewayContacts) {
        let all = |value: f64| Vector::all(simd, value);
        let (zero, one, half, penalty) = (all(0.0), all(1.0), all(0.5), all(self.penalty));
        let round = contacts.near_round;
        for at in vector_starts(simd) {
            let mut force = Vector::load(simd, &contacts.start, at);
            let mut shift = Vector::load(simd, &contacts.shift, at);
            let mut flexibility = Vector::load(simd, &contacts.flexibility, at);
            let mut moving = (round >> at) & ((1 << Vector::<S>::LEN) - 1);
            for _ in 0..STEPS {
                let [area, length] = contacts.pieces.area(simd, at, shift);
                let left = penalty.times_plus(area, -force);
                let by = left / (penalty * length).times_plus(flexibility, one);
                let these = Vector::ones(simd, moving);
                force = half.choose_below(these, (force + by).max(zero), force);
                let root = force.sqrt();
                let (knot, next) =
                    (Vector::load(simd, &contacts.knot, at), Vector::load(simd, &contacts.next, at));
                let on_piece = root.bits_below(next) & !root.bits_below(knot);
                let off = (round >> at) & ((1 << Vector::<S>::LEN) - 1) & !on_piece;
                if off != 0 {
                    root.store(&mut contacts.root, at);
                    contacts.look_up(raceway, off << at);
                }
                let knot = Vector::load(simd, &contacts.knot, at);
                let (first, slope) =
                    (Vector::load(simd, &contacts.first, at), Vector::load(simd, &contacts.slope, at));
                let g = slope.times_plus(root - knot, first);
                shift = force * g;
                flexibility = (half * root).times_plus(slope, g);
                let still = all(STILL).times_plus(force, all(STILL));
                moving &= still.bits_below(by.max(-by));
                if moving == 0 {
                    break;
                }
            }
            let these = Vector::ones(simd, round >> at);
            let rows = [
                (force, &mut contacts.normal),
                (shift, &mut contacts.shift),
                (flexibility, &mut contacts.flexibility),
            ];
            for (found, row) in rows {
                half.choose_below(these, found, Vector::load(simd, row, at)).store(row, at);
            }
        }
    }

    /// Overlaps of round rollers at the forces that have been found.
    #[inline(always)]
    fn integrate_round<S: Simd>(simd: S, raceway: &Raceway, contacts: &mut RacewayContacts) {
        let (Some(relief), true) = (&raceway.relief, contacts.near_round != 0) else { return };
        for at in vector_starts(simd) {
            let RacewayContacts { d, distance, reach, ragged, .. } = &*contacts;
            let seen = Contacts { d, distance, reach, ragged, these: contacts.near_round };
            let shift = Vector::load(simd, &contacts.shift, at);
            let mut found = relief.overlaps(simd, at, &seen, &contacts.pieces, shift);
            // The whole of what the turning direction adds is in `across`.
            found.skew = -(shift + shift) * found.across;
            let these = Vector::ones(simd, contacts.near_round >> at);
            found.chosen(these, contacts.overlap.load(simd, at)).store(&mut contacts.overlap, at);
        }
    }

    /// Deflection of the bodies at the forces to start from, and how far from their middles contacts may then
    /// reach.
    #[inline(always)]
    fn predict<S: Simd>(simd: S, raceway: &Raceway, contacts: &mut RacewayContacts) {
        let all = |value: f64| Vector::all(simd, value);
        let (zero, half) = (all(0.0), all(0.5));
        let mut on_piece = 0;
        for at in vector_starts(simd) {
            let root = Vector::load(simd, &contacts.start, at).sqrt();
            root.store(&mut contacts.root, at);
            let (knot, next) =
                (Vector::load(simd, &contacts.knot, at), Vector::load(simd, &contacts.next, at));
            on_piece |= (root.bits_below(next) & !root.bits_below(knot)) << at;
        }
        // Mostly it is the piece of the step before.
        contacts.look_up(raceway, contacts.near & !on_piece);
        let mut reaches = 0;
        for at in vector_starts(simd) {
            let (start, root) =
                (Vector::load(simd, &contacts.start, at), Vector::load(simd, &contacts.root, at));
            let (knot, first) =
                (Vector::load(simd, &contacts.knot, at), Vector::load(simd, &contacts.first, at));
            let slope = Vector::load(simd, &contacts.slope, at);
            let g = slope.times_plus(root - knot, first);
            let shift = start * g;
            let depth = Vector::load(simd, &contacts.most, at) - shift;
            shift.store(&mut contacts.shift, at);
            (half * root).times_plus(slope, g).store(&mut contacts.flexibility, at);
            raceway.reach(depth).store(&mut contacts.reach, at);
            reaches |= zero.bits_below(depth) << at;
        }
        // Where nothing would overlap at that force, the search begins without one.
        for lane in lanes(contacts.near & !reaches) {
            let [knot, first, slope, next] = raceway.curve.piece_at(0.0);
            (contacts.knot[lane], contacts.first[lane]) = (knot, first);
            (contacts.slope[lane], contacts.next[lane]) = (slope, next);
            (contacts.start[lane], contacts.shift[lane], contacts.flexibility[lane]) = (0.0, 0.0, first);
            contacts.reach[lane] = raceway.reach(contacts.most[lane]);
        }
    }

    /// Finds what round rollers are over, as far as they may reach.
    #[inline(always)]
    fn look_at_round<S: Simd>(simd: S, raceway: &Raceway, contacts: &mut RacewayContacts) {
        let (Some(relief), true) = (&raceway.relief, contacts.near_round != 0) else { return };
        let RacewayContacts { centre, d, distance, reach, ragged, hints, pieces, near_round, .. } = contacts;
        let seen = Contacts { d, distance, reach, ragged, these: *near_round };
        let facet = |lane: usize| {
            let under = Self::under(raceway, of_one(centre, lane), of_one(d, lane), hints[lane][1]);
            hints[lane][1] = under as u32;
            under
        };
        relief.look(simd, &seen, pieces, facet);
    }

    /// Integrates over all overlaps but those of round rollers at the predicted forces, as far as they may
    /// reach then; `parts` is scratch. Returns those that need the general integration, because a wall is
    /// near.
    #[inline(always)]
    fn integrate<S: Simd>(
        simd: S,
        rollers: &Rollers,
        raceway: &Raceway,
        first: usize,
        contacts: &mut RacewayContacts,
        parts: &mut [Penetration<Row>; LANES],
    ) -> u64 {
        let mut alone = 0;
        for lane in lanes(contacts.near & !contacts.near_round) {
            let (centre, d) = (of_one(&contacts.centre, lane), of_one(&contacts.d, lane));
            let (shift, reach) = (contacts.shift[lane], contacts.reach[lane]);
            let segments = &mut contacts.segments[lane];
            let pose = Pose { own: of_one(&contacts.own, lane), d, from: centre };
            for look in 0..2 {
                if segments.penetration(simd, raceway.sides, &pose, shift, reach, &mut parts[lane]) {
                    break;
                }
                if look == 0 {
                    let near = RollerOnRaceway {
                        raceway,
                        rim: rollers.rim(first + lane),
                        centre,
                        spin: of_one(&contacts.spin, lane),
                        bound: raceway.bound,
                        larger: 0.0,
                        before: 0.0,
                    };
                    let views = Self::views(&near, d, &mut contacts.hints[lane]);
                    segments.list(&views, raceway.sides.along, reach);
                } else {
                    alone |= 1 << lane;
                }
            }
        }
        contacts.overlap.sum_up(simd, parts);
        alone
    }

    /// Takes steps of Newton's method for the forces, with each penetration after a further shift. Returns
    /// those that need further steps; their `normal` is the first guess.
    #[inline(always)]
    fn search<S: Simd>(&self, simd: S, contacts: &mut RacewayContacts) -> u64 {
        let all = |value: f64| Vector::all(simd, value);
        let (zero, one, half, penalty) = (all(0.0), all(1.0), all(0.5), all(self.penalty));
        let mut again = 0;
        for at in vector_starts(simd) {
            let near = Vector::ones(simd, contacts.near >> at);
            let shift = Vector::load(simd, &contacts.shift, at);
            let start = Vector::load(simd, &contacts.start, at);
            let found = contacts.overlap.load(simd, at);
            let (knot, next) =
                (Vector::load(simd, &contacts.knot, at), Vector::load(simd, &contacts.next, at));
            let (first, slope) =
                (Vector::load(simd, &contacts.first, at), Vector::load(simd, &contacts.slope, at));
            let (mut force, mut flexibility) = (start, Vector::load(simd, &contacts.flexibility, at));
            let (mut now, mut more) = ([found.area, found.length], zero);
            let mut sure = one;
            for _ in 0..NEWTON {
                let [area, length] = now;
                let left = penalty.times_plus(area, -force);
                let stiff = (penalty * length).times_plus(flexibility, one);
                force = (force + left / stiff).max(zero);
                let y = force.sqrt();
                sure = y.choose_below(knot, zero, y.choose_below(next, sure, zero));
                let g = slope.times_plus(y - knot, first);
                more = force.times_plus(g, -shift);
                flexibility = (half * y).times_plus(slope, g);
                now = found.shifted_area(more);
            }
            // It may have moved to another piece of the compliance.
            let before = (Vector::load(simd, &contacts.force, at) + Vector::load(simd, &contacts.growth, at))
                .max(zero);
            let off = (force - start).max(start - force);
            let far = all(ENOUGH).times_plus(force, all(LITTLE)).choose_below(off, one, zero);
            let open = half.choose_below(sure, far, one);
            again |= (open.bits() << at) & contacts.near;
            let force = half.choose_below(sure, force, before);
            half.choose_below(near, force, zero).store(&mut contacts.normal, at);
            flexibility.store(&mut contacts.flexibility, at);
            (shift + more).store(&mut contacts.shift, at);
            found.shifted(more, now).store(&mut contacts.overlap, at);
        }
        again
    }

    /// Contact of one roller with a raceway. `hints` are the facets found last.
    #[inline(always)]
    pub(crate) fn normal_force<S: Simd>(
        &self,
        simd: S,
        near: RollerOnRaceway<'_>,
        hints: &mut [u32; 2],
    ) -> NormalForce {
        let RollerOnRaceway { raceway, rim, centre, bound, larger, before, .. } = near;
        let [x, y] = [centre[0] - raceway.centre[0], centre[1] - raceway.centre[1]];
        let distance = (x * x + y * y).sqrt();
        let outwards = raceway.outwards();
        let d = [outwards * x / distance, outwards * y / distance];
        let distance = distance + outwards * larger;
        let most = outwards * (distance - bound) + rim.top;
        if most <= 0.0 {
            return NormalForce::default();
        }
        let mut eights = [EightFacets::default(); 2];
        let [of_roller, of_raceway] = Self::views(&near, d, hints);
        let under = of_raceway.facet;
        let relief = raceway.relief.as_ref().filter(|_| rim.is_round);
        let pair = Pair::new(simd, of_roller, of_raceway, raceway.sides, &mut eights);
        let mut force = before;
        let mut found = Penetration::default();
        let (mut flexibility, mut deflection) = (0.0, 0.0);
        for _ in 0..SEARCHES {
            let ([shift, slope], piece) = raceway.curve.approach(force);
            flexibility = slope;
            let depth = most - shift;
            if depth <= 0.0 {
                (found, force) = (Penetration::default(), 0.0);
                continue;
            }
            let reach = raceway.reach(depth);
            found = match relief {
                Some(relief) => relief.overlap(under, d, distance, shift, reach),
                None => pair.penetration(shift, reach),
            };
            // Newton's method with the penetration after a further shift.
            let start = force;
            let (mut more, mut now) = (0.0, [found.area, found.length]);
            for _ in 0..NEWTON {
                let [area, length] = now;
                let left = self.penalty * area - force;
                force = (force + left / (1.0 + self.penalty * length * flexibility)).max(0.0);
                let [there, slope] = raceway.curve.approach_near(force, piece);
                (more, flexibility) = (there - shift, slope);
                now = found.shifted_area(more);
            }
            found = found.shifted(more, now);
            deflection = shift + more;
            if (force - start).abs() <= ENOUGH * force + LITTLE {
                break;
            }
        }
        if relief.is_some() {
            found.skew = -2.0 * deflection * found.across;
        }
        NormalForce { normal: force, flexibility, deflection, overlap: found }
    }

    /// The facet of a raceway that a roller is over, near that of a hint.
    #[inline(always)]
    fn under(raceway: &Raceway, centre: [f64; 2], d: [f64; 2], hint: u32) -> usize {
        raceway.outline.facet_along(centre, d, hint as usize, raceway.outwards())
    }

    /// Roller and raceway near their contact, in the direction `d`, with the facets that it goes through.
    #[inline(always)]
    fn views<'a>(near: &RollerOnRaceway<'a>, d: [f64; 2], hints: &mut [u32; 2]) -> [View<'a>; 2] {
        let RollerOnRaceway { raceway, rim, centre, spin, .. } = *near;
        let own = turned_back(spin, d);
        let facet = rim.outline.facet_along([0.0; 2], own, hints[0] as usize, 1.0);
        let under = Self::under(raceway, centre, d, hints[1]);
        *hints = [facet as u32, under as u32];
        let roller = View { outline: &rim.outline, from: [0.0; 2], d: own, facet };
        let raceway = View { outline: &raceway.outline, from: centre, d, facet: under };
        [roller, raceway]
    }
}

/// A direction in the roller's own frame: turned back by its spin. Products are rounded here, so that eight
/// rollers side by side see the bits of one.
#[inline(always)]
fn turned_back<N: Number>([c, s]: [N; 2], d: [N; 2]) -> [N; 2] {
    [c * d[0] + s * d[1], c * d[1] - s * d[0]]
}
