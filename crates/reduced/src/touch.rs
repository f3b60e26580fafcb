//! How hard a roller and a raceway press on each other: what overlaps, in series with what the bodies give way by (THEORY §9.3).
//! The forces of all contacts of a step are found side by side, in vectors over contacts.

use pulp::Simd;
use stribeck_simd::lanes::{LANES, Number, Vector};

use crate::{
    bearing::{Bearing, Rim, Track},
    outline::View,
    overlap::{Overlap, Pair},
};

/// Most integrations over the overlap for the force of a contact in one time step, and steps of Newton's method after each.
const SEARCHES: usize = 4;
const NEWTON: usize = 2;

/// Where the force differs by less than this share, or by less than this [N], from that at which the overlap was integrated, its
/// series leaves an error of the third power.
const ENOUGH: f64 = 3e-2;
const LITTLE: f64 = 1e-2;

/// One contact of a roller with a raceway in the present step.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Touch {
    /// Normal force of penalty and compliance [N].
    pub(crate) normal: f64,
    /// Force of the same along t [N].
    pub(crate) across: f64,
    /// Derivative of the compliance's approach there [m/N].
    pub(crate) give: f64,
    /// What overlaps at that force.
    pub(crate) overlap: Overlap,
    pub(crate) d: [f64; 2],
}

/// A roller by a raceway, seen in the frame of the raceway's outline.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Near<'a> {
    pub(crate) track: &'a Track,
    pub(crate) rim: &'a Rim,
    pub(crate) centre: [f64; 2],
    /// Direction of the roller's vertex 0.
    pub(crate) spin: [f64; 2],
    /// Force that is expected from the steps before [N].
    pub(crate) before: f64,
}

/// A contact whose overlap is known at the force of the step before, and whose force is not.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Begun {
    d: [f64; 2],
    distance: f64,
    overlap: Overlap,
    /// What the bodies give way by at the force with which the search began [m], and that force [N].
    shift: f64,
    start: f64,
    /// Its place among those whose forces are sought; none where nothing touches.
    row: Option<u32>,
}

/// Numbers of contacts side by side, and the forces that are found from them.
#[derive(Debug, Clone, Default)]
pub(crate) struct Sought {
    count: usize,
    columns: Vec<[[f64; LANES]; COLUMNS]>,
}

const COLUMNS: usize = 11;
/// Columns: what is known …
const AREA: usize = 0;
const LENGTH: usize = 1;
const ENDS: usize = 2;
const SHIFT: usize = 3;
/// … of the piece of the compliance: its beginning over √F, its flexibility there, how that grows, and where the piece ends …
const KNOT: usize = 4;
const FIRST: usize = 5;
const SLOPE: usize = 6;
const NEXT: usize = 7;
/// … and what is found: force, derivative of the compliance's approach, and one where the piece was never left. AREA, LENGTH and
/// SHIFT become those at the force.
const FORCE: usize = 8;
const GIVE: usize = 9;
const SURE: usize = 10;

impl Sought {
    /// Room for so many contacts.
    pub(crate) fn new(contacts: usize) -> Self {
        Self { count: 0, columns: vec![[[0.0; LANES]; COLUMNS]; contacts.div_ceil(LANES)] }
    }

    /// Forgets the contacts of the step before.
    pub(crate) fn clear(&mut self) {
        self.count = 0;
    }

    #[inline(always)]
    fn add(&mut self, numbers: [f64; COLUMNS]) -> Option<u32> {
        let row = self.count;
        self.count += 1;
        let group = &mut self.columns[row / LANES];
        for (column, number) in group.iter_mut().zip(numbers) {
            column[row % LANES] = number;
        }
        Some(row as u32)
    }

    #[inline(always)]
    fn found(&self, row: u32, column: usize) -> f64 {
        self.columns[row as usize / LANES][column][row as usize % LANES]
    }

    /// Newton's method for all forces, with what each overlap becomes by a further shift.
    #[inline(always)]
    pub(crate) fn solve<S: Simd>(&mut self, simd: S, penalty: f64) {
        let all = |value: f64| Vector::all(simd, value);
        let (zero, one, half, penalty) = (all(0.0), all(1.0), all(0.5), all(penalty));
        for group in &mut self.columns[..self.count.div_ceil(LANES)] {
            let mut at = 0;
            while at < LANES {
                let length0 = Vector::load(simd, &group[LENGTH], at);
                let area0 = Vector::load(simd, &group[AREA], at);
                let ends = Vector::load(simd, &group[ENDS], at);
                let shift = Vector::load(simd, &group[SHIFT], at);
                let knot = Vector::load(simd, &group[KNOT], at);
                let first = Vector::load(simd, &group[FIRST], at);
                let slope = Vector::load(simd, &group[SLOPE], at);
                let next = Vector::load(simd, &group[NEXT], at);
                let mut force = Vector::load(simd, &group[FORCE], at);
                let mut give = Vector::load(simd, &group[GIVE], at);
                let (mut area, mut length, mut further) = (area0, length0, zero);
                let mut sure = one;
                for _ in 0..NEWTON {
                    let left = penalty.times_plus(area, -force);
                    let stiff = (penalty * length).times_plus(give, one);
                    force = (force + left / stiff).max(zero);
                    let y = force.sqrt();
                    sure = y.choose_below(knot, zero, y.choose_below(next, sure, zero));
                    let g = slope.times_plus(y - knot, first);
                    further = force.times_plus(g, -shift);
                    give = (half * y).times_plus(slope, g);
                    length = (-ends).times_plus(further, length0).max(zero);
                    let lost = half * further * (length0 + length);
                    area = zero.choose_below(length, (area0 - lost).max(zero), zero);
                }
                force.store(&mut group[FORCE], at);
                give.store(&mut group[GIVE], at);
                further.store(&mut group[SHIFT], at);
                area.store(&mut group[AREA], at);
                length.store(&mut group[LENGTH], at);
                sure.store(&mut group[SURE], at);
                at += Vector::<S>::LEN;
            }
        }
    }
}

impl Bearing {
    /// Looks at what overlaps at the force of the step before. `hints` are the facets found last.
    #[inline(always)]
    pub(crate) fn begin<S: Simd>(
        &self,
        simd: S,
        near: Near<'_>,
        hints: &mut [u32; 2],
        sought: &mut Sought,
    ) -> Begun {
        let Near { track, rim, centre, .. } = near;
        let distance = (centre[0] * centre[0] + centre[1] * centre[1]).sqrt();
        let outwards = track.outwards();
        let d = [outwards * centre[0] / distance, outwards * centre[1] / distance];
        let most = outwards * (distance - track.bound) + rim.top;
        let mut begun = Begun { d, distance, ..Begun::default() };
        if most <= 0.0 {
            return begun;
        }
        let pair = self.pair(simd, &near, d, hints);
        let mut start = near.before;
        let (mut known, mut piece) = track.curve.approach(start);
        if most <= known[0] {
            // Nothing would overlap at that force.
            start = 0.0;
            (known, piece) = track.curve.approach(start);
        }
        let [shift, give] = known;
        let found = pair.overlap(shift, track.reach(most - shift));
        let [knot, first, slope, next] = track.curve.piece(piece);
        begun.row = sought.add([
            found.area,
            found.length,
            found.ends,
            shift,
            knot,
            first,
            slope,
            next,
            start,
            give,
            0.0,
        ]);
        (begun.overlap, begun.shift, begun.start) = (found, shift, start);
        begun
    }

    /// The contact at the force that was found, or searched for further where that is far from the one before.
    #[inline(always)]
    pub(crate) fn end<S: Simd>(
        &self,
        simd: S,
        near: Near<'_>,
        begun: &Begun,
        hints: &mut [u32; 2],
        sought: &Sought,
    ) -> Touch {
        let Some(row) = begun.row else { return Touch { d: begun.d, ..Touch::default() } };
        let force = sought.found(row, FORCE);
        // It may have gone on to another piece of the compliance.
        let sure = sought.found(row, SURE) > 0.5;
        if !sure || (force - begun.start).abs() > ENOUGH * force + LITTLE {
            let before = if sure { force } else { near.before };
            return self.touch(simd, Near { before, ..near }, hints);
        }
        let further = sought.found(row, SHIFT);
        let now = [sought.found(row, AREA), sought.found(row, LENGTH)];
        let overlap = begun.overlap.shifted(further, now);
        let given = begun.shift + further;
        self.touched(near.track, begun.d, begun.distance, force, sought.found(row, GIVE), overlap, given)
    }

    /// Contact of a roller with a raceway, by itself. `hints` are the facets found last.
    #[inline(always)]
    pub(crate) fn touch<S: Simd>(&self, simd: S, near: Near<'_>, hints: &mut [u32; 2]) -> Touch {
        let Near { track, rim, centre, before, .. } = near;
        let distance = (centre[0] * centre[0] + centre[1] * centre[1]).sqrt();
        let outwards = track.outwards();
        let d = [outwards * centre[0] / distance, outwards * centre[1] / distance];
        let most = outwards * (distance - track.bound) + rim.top;
        if most <= 0.0 {
            return Touch { d, ..Touch::default() };
        }
        let pair = self.pair(simd, &near, d, hints);
        let mut force = before;
        let mut found = Overlap::default();
        let (mut give, mut given) = (0.0, 0.0);
        for _ in 0..SEARCHES {
            let ([shift, slope], piece) = track.curve.approach(force);
            give = slope;
            let depth = most - shift;
            if depth <= 0.0 {
                (found, force) = (Overlap::default(), 0.0);
                continue;
            }
            found = pair.overlap(shift, track.reach(depth));
            // Newton's method with what the overlap becomes by a further shift.
            let start = force;
            let (mut further, mut now) = (0.0, [found.area, found.length]);
            for _ in 0..NEWTON {
                let [area, length] = now;
                let left = self.penalty * area - force;
                force = (force + left / (1.0 + self.penalty * length * give)).max(0.0);
                let [there, slope] = track.curve.approach_near(force, piece);
                (further, give) = (there - shift, slope);
                now = found.shifted_area(further);
            }
            found = found.shifted(further, now);
            given = shift + further;
            if (force - start).abs() <= ENOUGH * force + LITTLE {
                break;
            }
        }
        self.touched(track, d, distance, force, give, found, given)
    }

    /// Roller and raceway near their contact, in the direction `d`.
    #[inline(always)]
    fn pair<'a, S: Simd>(&self, simd: S, near: &Near<'a>, d: [f64; 2], hints: &mut [u32; 2]) -> Pair<'a> {
        let Near { track, rim, centre, spin: [c, s], .. } = *near;
        // The roller's own frame: turned back by its spin.
        let own = [c * d[0] + s * d[1], c * d[1] - s * d[0]];
        let facet = rim.outline.facet_along([0.0; 2], own, hints[0] as usize, 1.0);
        let under = track.outline.facet_along(centre, d, hints[1] as usize, track.outwards());
        *hints = [facet as u32, under as u32];
        let roller = View { outline: &rim.outline, from: [0.0; 2], d: own, facet };
        let raceway = View { outline: &track.outline, from: centre, d, facet: under };
        Pair::new(simd, roller, raceway, track.sides)
    }

    /// `given` is what the bodies have given way by [m].
    #[inline(always)]
    #[expect(clippy::too_many_arguments, reason = "one contact, with all that is known of it")]
    fn touched(
        &self,
        track: &Track,
        d: [f64; 2],
        distance: f64,
        force: f64,
        give: f64,
        overlap: Overlap,
        given: f64,
    ) -> Touch {
        // d turns as the roller moves along, and what the bodies have given way by with it.
        let turning = track.outwards() * (0.5 * overlap.skew + given * overlap.across) / distance;
        let across = self.penalty * (overlap.across - turning);
        Touch { normal: force, across, give, overlap, d }
    }
}
