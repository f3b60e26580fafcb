//! Penetration of a roller into a raceway, integrated exactly over the facets that overlap (THEORY §9.3).
//!
//! Frame: origin in the roller's centre, d the unit vector from there towards the raceway, t the same turned
//! counter-clockwise by a right angle, u the coordinate along t. Both boundaries are heights h(u) along d,
//! and the penetration p(u) is the roller's height less the raceway's. Between two adjacent vertices of
//! either boundary p is linear, or parabolic on arcs: the integrals are sums of closed forms over such
//! segments.

use pulp::Simd;
use stribeck_simd::lanes::{LANES, Number, Vector, fused};

use crate::{
    contact::eight_facets::{self, EightFacets},
    contact::outline::{Facet, Parts, View, Walk},
    row::Row,
};

/// Orientation and curvature of a raceway relative to a roller.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sides {
    /// Whether u grows from one vertex of the raceway to the next: true for the outer one.
    pub along: bool,
    /// Half the relative curvature of roller and raceway [1/m]; 0 for chords.
    pub bulge: f64,
    /// Curvature of the roller [1/m]; 0 for chords.
    pub curvature: f64,
}

impl Sides {
    /// Whether roller and raceway are arcs.
    #[inline(always)]
    pub(crate) fn are_round(self) -> bool {
        self.bulge != 0.0 || self.curvature != 0.0
    }
}

/// Integrals over the overlap, per unit of thickness: of one contact, or of several side by side.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Penetration<N = f64> {
    /// ∫ p du [m²].
    pub area: N,
    /// ∫ p h′ du with the slope of the roller [m²]: force along t.
    pub across: N,
    /// ∫ p (u + h h′) du [m³]: moment about the roller's centre.
    pub moment: N,
    /// ∫ p² du [m³].
    pub square: N,
    /// Length of the overlap [m].
    pub length: N,
    /// ∫ u du over the overlap [m²].
    pub first: N,
    /// ∫ u² du over the overlap [m³].
    pub second: N,
    /// ∫ h′ du over the overlap [m].
    pub slope: N,
    /// ∫ (u + h h′) du over the overlap [m²].
    pub arm: N,
    /// Derivative of `square` with respect to a rotation of d towards t [m³]: ∫ p² h′ du, plus ⅓ p³ where the
    /// overlap ends at a wall (minus where it begins), less the part of arcs that rotates with them.
    pub skew: N,
    /// Decrease of `length` with a shift [-]: the sum of 1/|p′| over both ends.
    pub ends: N,
    /// Deepest penetration [m].
    pub deepest: N,
}

impl<N: Number> Penetration<N> {
    /// No penetration; `zero` gives the kind of number.
    #[inline(always)]
    pub fn none(zero: N) -> Self {
        Self {
            area: zero,
            across: zero,
            moment: zero,
            square: zero,
            length: zero,
            first: zero,
            second: zero,
            slope: zero,
            arm: zero,
            skew: zero,
            ends: zero,
            deepest: zero,
        }
    }

    /// ∫ p du [m²] and the length [m] after a further small shift, to its second power.
    #[inline(always)]
    pub fn shifted_area(&self, shift: N) -> [N; 2] {
        let (zero, half) = (shift.constant(0.0), shift.constant(0.5));
        let length = (self.length - self.ends * shift).max(zero);
        let lost = half * shift * (self.length + length);
        [zero.choose_below(length, (self.area - lost).max(zero), zero), length]
    }

    /// The overlap after a further small shift, whose area [m²] and length [m] are known.
    #[inline(always)]
    pub fn shifted(&self, shift: N, [area, length]: [N; 2]) -> Self {
        let (zero, half, sixth) = (shift.constant(0.0), shift.constant(0.5), shift.constant(1.0 / 6.0));
        // p² falls by 2 ∫ p ds, and ∫ p ds holds two thirds of a step of the curvature (Simpson's rule on a
        // parabola).
        let mean = self.area - shift * (half * self.length - sixth * self.ends * shift);
        let over = zero.choose_below(self.length, self.length, shift.constant(1.0));
        let share = zero.choose_below(self.length, length / over, zero);
        let about = self.first * self.first / over;
        let lost = half * shift * (shift.constant(1.0) + share);
        Self {
            area,
            length,
            square: (self.square - (shift + shift) * mean).max(zero),
            across: self.across - lost * self.slope,
            moment: self.moment - lost * self.arm,
            first: share * self.first,
            second: share * about + share * share * share * (self.second - about),
            slope: share * self.slope,
            arm: share * self.arm,
            skew: self.skew,
            ends: self.ends,
            deepest: self.deepest - shift,
        }
    }
}

impl Penetration<Row> {
    /// The overlaps of the lanes from `at` on.
    #[inline(always)]
    pub(crate) fn load<S: Simd>(&self, simd: S, at: usize) -> Penetration<Vector<S>> {
        Penetration {
            area: Vector::load(simd, &self.area, at),
            across: Vector::load(simd, &self.across, at),
            moment: Vector::load(simd, &self.moment, at),
            square: Vector::load(simd, &self.square, at),
            length: Vector::load(simd, &self.length, at),
            first: Vector::load(simd, &self.first, at),
            second: Vector::load(simd, &self.second, at),
            slope: Vector::load(simd, &self.slope, at),
            arm: Vector::load(simd, &self.arm, at),
            skew: Vector::load(simd, &self.skew, at),
            ends: Vector::load(simd, &self.ends, at),
            deepest: Vector::load(simd, &self.deepest, at),
        }
    }

    /// Sums the segments of eight contacts: those of contact i are the lanes of `parts[i]`.
    #[inline(always)]
    pub(crate) fn sum_up<S: Simd>(&mut self, simd: S, parts: &[Self; LANES]) {
        let of = |number: fn(&Self) -> &Row| parts.each_ref().map(|parts| &number(parts)[..]);
        Vector::store_sums(simd, of(|of| &of.area), &mut self.area.0);
        Vector::store_sums(simd, of(|of| &of.across), &mut self.across.0);
        Vector::store_sums(simd, of(|of| &of.moment), &mut self.moment.0);
        Vector::store_sums(simd, of(|of| &of.square), &mut self.square.0);
        Vector::store_sums(simd, of(|of| &of.length), &mut self.length.0);
        Vector::store_sums(simd, of(|of| &of.first), &mut self.first.0);
        Vector::store_sums(simd, of(|of| &of.second), &mut self.second.0);
        Vector::store_sums(simd, of(|of| &of.slope), &mut self.slope.0);
        Vector::store_sums(simd, of(|of| &of.arm), &mut self.arm.0);
        Vector::store_sums(simd, of(|of| &of.skew), &mut self.skew.0);
        Vector::store_sums(simd, of(|of| &of.ends), &mut self.ends.0);
        Vector::store_largest(simd, of(|of| &of.deepest), &mut self.deepest.0);
    }

    /// Replaces the overlap in one lane.
    pub(crate) fn set(&mut self, lane: usize, by: &Penetration) {
        self.area[lane] = by.area;
        self.across[lane] = by.across;
        self.moment[lane] = by.moment;
        self.square[lane] = by.square;
        self.length[lane] = by.length;
        self.first[lane] = by.first;
        self.second[lane] = by.second;
        self.slope[lane] = by.slope;
        self.arm[lane] = by.arm;
        self.skew[lane] = by.skew;
        self.ends[lane] = by.ends;
        self.deepest[lane] = by.deepest;
    }
}

impl<S: Simd> Penetration<Vector<S>> {
    /// These where `these` is one, and the others elsewhere.
    #[inline(always)]
    pub(crate) fn chosen(self, these: Vector<S>, others: Self) -> Self {
        let half = these.constant(0.5);
        Self {
            area: half.choose_below(these, self.area, others.area),
            across: half.choose_below(these, self.across, others.across),
            moment: half.choose_below(these, self.moment, others.moment),
            square: half.choose_below(these, self.square, others.square),
            length: half.choose_below(these, self.length, others.length),
            first: half.choose_below(these, self.first, others.first),
            second: half.choose_below(these, self.second, others.second),
            slope: half.choose_below(these, self.slope, others.slope),
            arm: half.choose_below(these, self.arm, others.arm),
            skew: half.choose_below(these, self.skew, others.skew),
            ends: half.choose_below(these, self.ends, others.ends),
            deepest: half.choose_below(these, self.deepest, others.deepest),
        }
    }

    /// Writes them to the lanes from `at` on.
    #[inline(always)]
    pub(crate) fn store(self, to: &mut Penetration<Row>, at: usize) {
        self.area.store(&mut to.area, at);
        self.across.store(&mut to.across, at);
        self.moment.store(&mut to.moment, at);
        self.square.store(&mut to.square, at);
        self.length.store(&mut to.length, at);
        self.first.store(&mut to.first, at);
        self.second.store(&mut to.second, at);
        self.slope.store(&mut to.slope, at);
        self.arm.store(&mut to.arm, at);
        self.skew.store(&mut to.skew, at);
        self.ends.store(&mut to.ends, at);
        self.deepest.store(&mut to.deepest, at);
    }
}

/// A roller and a raceway near their contact.
#[derive(Debug, Clone, Copy)]
pub struct Pair<'a, S> {
    simd: S,
    /// The roller.
    pub roller: View<'a>,
    /// The raceway.
    pub raceway: View<'a>,
    /// Orientation and curvature of the raceway.
    pub sides: Sides,
    /// Roller and raceway again, as vectors of eight facets.
    eights: &'a [EightFacets; 2],
    /// Whether those vectors hold the whole contact.
    pub in_eights: bool,
}

impl<'a, S: Simd> Pair<'a, S> {
    /// A pair, as vectors of eight facets where they suffice; `eights` is scratch space for them.
    #[inline(always)]
    pub fn new(
        simd: S,
        roller: View<'a>,
        raceway: View<'a>,
        sides: Sides,
        eights: &'a mut [EightFacets; 2],
    ) -> Self {
        let [first, second] = &mut *eights;
        let in_eights = first.look(simd, &roller, true) && second.look(simd, &raceway, sides.along);
        Self { simd, roller, raceway, sides, eights, in_eights }
    }

    /// The overlap of a roller that is pressed back by `shift` [m], looked for up to `reach` [m] to either
    /// side.
    #[inline(always)]
    pub fn penetration(&self, shift: f64, reach: f64) -> Penetration {
        let sides = self.sides;
        if sides.are_round() {
            self.taken(reach, Arcs { sum: Penetration::default(), sides, shift }).sum
        } else {
            self.taken(reach, Chords { sum: Penetration::default(), shift }).sum
        }
    }

    #[inline(always)]
    fn taken<P: Parts>(&self, reach: f64, mut parts: P) -> P {
        if !(self.in_eights && eight_facets::segments(self.simd, self.eights, reach, &mut parts)) {
            self.walk(reach, &mut parts);
        }
        parts
    }

    /// Walks along both boundaries and passes on their segments: the intervals of u in which neither boundary
    /// has a vertex.
    #[inline(always)]
    fn walk(&self, reach: f64, parts: &mut impl Parts) {
        let mut u = -reach;
        let mut r = Walk::of_roller(self.roller, u);
        let mut w = Walk::of_raceway(self.raceway, self.sides.along, u);
        let most = self.roller.outline.len() + self.raceway.outline.len();
        let mut before = None;
        for _ in 0..most {
            let end = r.end.min(w.end).min(reach);
            if end > u {
                let roller = r.facet();
                if std::mem::take(&mut r.jumps)
                    && let Some(before) = before
                {
                    parts.jump(u, [before, roller], w.facet());
                }
                parts.add([u, end], roller, w.facet());
                before = Some(roller);
                u = end;
            }
            if end >= reach {
                break;
            }
            // Walls of a groove may lean over: their facets hold no u.
            if r.end <= w.end { r.step() } else { w.step() }
        }
    }
}

/// Sums over parts between straight lines.
struct Chords {
    sum: Penetration,
    shift: f64,
}

impl Parts for Chords {
    #[inline(always)]
    fn add(&mut self, [u1, u2]: [f64; 2], roller: Facet, raceway: Facet) {
        let p = straight([u1, u2], roller, raceway, self.shift);
        chords(&mut self.sum, [u1, u2], p, roller, raceway);
    }

    #[inline(always)]
    fn jump(&mut self, u: f64, roller: [Facet; 2], raceway: Facet) {
        let places = roller.map(|r| [straight([u, u], r, raceway, self.shift)[0], fused(r.slope, u, r.base)]);
        jump(&mut self.sum, places);
    }
}

/// Sums over parts between parabolas.
struct Arcs {
    sum: Penetration,
    sides: Sides,
    shift: f64,
}

impl Parts for Arcs {
    #[inline(always)]
    fn add(&mut self, ends: [f64; 2], roller: Facet, raceway: Facet) {
        let seen = round(ends, roller, raceway, self.sides, self.shift);
        arcs(&mut self.sum, ends, seen, roller, raceway);
    }

    #[inline(always)]
    fn jump(&mut self, u: f64, roller: [Facet; 2], raceway: Facet) {
        let places = roller.map(|r| {
            let seen = round([u, u], r, raceway, self.sides, self.shift);
            [seen.p[0], 0.5 * seen.curvature * r.inside(u) + fused(r.slope, u, r.base)]
        });
        jump(&mut self.sum, places);
    }
}

/// Adds the contribution of an overhanging wall of the roller to the overlap, though no part holds it: its
/// upper corner hides the points below, and there the penetration goes from one value to another [m]. Both
/// come with the height of the roller.
#[inline(always)]
fn jump(sum: &mut Penetration, [[p1, h1], [p2, h2]]: [[f64; 2]; 2]) {
    let [corner, deepest] = [h1.max(h2), p1.max(p2)];
    let (a, b) = (p1.max(0.0), p2.max(0.0));
    let [length, area] = [b - a, 0.5 * (b * b - a * a)];
    sum.slope += length;
    sum.arm += corner * length;
    sum.across += area;
    sum.moment += corner * area;
    // The place of the corner, unlike that of a wall of the raceway, is not where the penetration is zero.
    sum.skew += 2.0 * deepest * area;
}

/// Adds a part, where `present` is one; elsewhere there is no penetration.
#[inline(always)]
pub(crate) fn add_between<N: Number>(
    sum: &mut Penetration<N>,
    ends: [N; 2],
    roller: Facet<N>,
    raceway: Facet<N>,
    sides: Sides,
    shift: N,
    present: N,
) {
    let (half, outside) = (shift.constant(0.5), shift.constant(-1.0));
    let choose =
        |[p1, p2]: [N; 2]| [half.choose_below(present, p1, outside), half.choose_below(present, p2, outside)];
    if sides.are_round() {
        let mut seen = round(ends, roller, raceway, sides, shift);
        seen.p = choose(seen.p);
        arcs(sum, ends, seen, roller, raceway);
    } else {
        let p = choose(straight(ends, roller, raceway, shift));
        chords(sum, ends, p, roller, raceway);
    }
}

/// Penetration at both ends of a part between two straight lines [m].
#[inline(always)]
fn straight<N: Number>([u1, u2]: [N; 2], r: Facet<N>, w: Facet<N>, shift: N) -> [N; 2] {
    let (steep, gap) = (r.slope - w.slope, (r.base - w.base) - shift);
    [steep.times_plus(u1, gap), steep.times_plus(u2, gap)]
}

/// Adds the part between two straight lines, with the penetration at both ends.
#[inline(always)]
fn chords<N: Number>(sum: &mut Penetration<N>, [u1, u2]: [N; 2], [p1, p2]: [N; 2], r: Facet<N>, w: Facet<N>) {
    let (zero, one, half, four) = (u1.constant(0.0), u1.constant(1.0), u1.constant(0.5), u1.constant(4.0));
    let (third, sixth) = (u1.constant(1.0 / 3.0), u1.constant(1.0 / 6.0));
    let (lower, higher) = (p1.min(p2), p1.max(p2));
    let steep = r.slope - w.slope;
    // Where p falls below zero in between the overlap ends, 1/|p′| times what p is below zero from there.
    let flat = zero.choose_below(higher, one / steep.max(-steep), zero);
    let flat = lower.choose_below(zero, flat, zero);
    sum.ends = sum.ends + flat;
    let (a, z) = (flat.times_plus(-p1.min(zero), u1), flat.times_plus(p2.min(zero), u2));
    let (pa, pz) = (p1.max(zero), p2.max(zero));
    // p is linear from a to z: Simpson's rule is exact.
    let width = zero.choose_below(higher, z - a, zero);
    let (middle, mean) = (half * (a + z), half * (pa + pz));
    let area = width * mean;
    let weight = width * sixth;
    let first = area.times_plus(middle, weight * (half * width) * (pz - pa));
    let square = weight * pa.times_plus(pa, pz.times_plus(pz, four * mean * mean));
    let (lever, stand) = (r.base * r.slope, r.slope.times_plus(r.slope, one));
    sum.area = sum.area + area;
    sum.square = sum.square + square;
    sum.length = sum.length + width;
    sum.first = width.times_plus(middle, sum.first);
    sum.second = weight.times_plus(a.times_plus(a, z.times_plus(z, four * middle * middle)), sum.second);
    sum.across = r.slope.times_plus(area, sum.across);
    sum.moment = lever.times_plus(area, stand.times_plus(first, sum.moment));
    let walls = (pz * pz).times_plus(pz, -(pa * pa * pa));
    sum.skew = r.slope.times_plus(square, third.times_plus(walls, sum.skew));
    sum.slope = r.slope.times_plus(width, sum.slope);
    sum.arm = width.times_plus(stand.times_plus(middle, lever), sum.arm);
    sum.deepest = sum.deepest.max(higher);
}

/// A part between two parabolas on chords: penetration at both ends [m], the curvature of the roller and half
/// the relative one over u [1/m].
#[derive(Clone, Copy)]
struct Round<N> {
    p: [N; 2],
    curvature: N,
    bulge: N,
}

#[inline(always)]
fn round<N: Number>(ends: [N; 2], r: Facet<N>, w: Facet<N>, sides: Sides, shift: N) -> Round<N> {
    let half = shift.constant(0.5);
    let curvature = shift.constant(sides.curvature) * r.stretch();
    let of_raceway = shift.constant(sides.bulge - 0.5 * sides.curvature) * w.stretch();
    let ([u1, u2], [p1, p2]) = (ends, straight(ends, r, w, shift));
    // Heights of the arcs above their chords.
    let (of_r, of_w) = (half * curvature, of_raceway);
    let p1 = p1 + of_r * r.inside(u1) + of_w * w.inside(u1);
    let p2 = p2 + of_r * r.inside(u2) + of_w * w.inside(u2);
    // A wall of the roller is no arc, and the curvature of a raceway over it, narrow as it is, no more than
    // rounding.
    let bulge = half.times_plus(curvature, of_raceway).max(shift.constant(0.0));
    Round { p: [p1, p2], curvature, bulge }
}

/// The outer points of Gauss' rule with three of them, √0.6.
const GAUSS: f64 = 0.774_596_669_241_483_4;

/// Penetration at τ, times the height of the roller's arc over its chord and the slope of that height, less
/// the same of the raceway; with half of both curvatures over u [1/m].
#[inline(always)]
fn leaning<N: Number>(
    tau: N,
    [u1, length]: [N; 2],
    [p1, b, c]: [N; 3],
    [of_r, of_w]: [N; 2],
    [r, w]: [Facet<N>; 2],
) -> N {
    let u = length.times_plus(tau, u1);
    let twice = u + u;
    let of_roller = of_r * of_r * r.inside(u) * (r.from + r.to - twice);
    let of_raceway = of_w * of_w * w.inside(u) * (w.from + w.to - twice);
    c.times_plus(tau, b).times_plus(tau, p1) * (of_roller - of_raceway)
}

/// Adds the part between two parabolas on chords.
#[inline(always)]
fn arcs<N: Number>(sum: &mut Penetration<N>, [u1, u2]: [N; 2], seen: Round<N>, r: Facet<N>, w: Facet<N>) {
    let Round { p: [p1, p2], curvature, bulge } = seen;
    let (zero, one) = (u1.constant(0.0), u1.constant(1.0));
    let (two, three) = (u1.constant(2.0), u1.constant(3.0));
    let (half, third) = (u1.constant(0.5), u1.constant(1.0 / 3.0));
    let above = |number: N, yes: N, no: N| zero.choose_below(number, yes, no);
    let length = u2 - u1;
    // p = p1 + b τ + c τ² over τ from 0 to 1.
    let c = -bulge * length * length;
    let b = p2 - p1 - c;
    let is_curved = c.max(-c);
    // c < 0: the parabola is positive between its roots, if it has any.
    let discriminant = b.times_plus(b, -(two + two) * c * p1);
    let root = discriminant.max(zero).sqrt();
    let per = one / (two * c);
    let (low, high) = ((root - b) * per, -(root + b) * per);
    let [mut from, mut to] = [low.max(zero), high.min(one)];
    let mut ends = (above(low, one, zero) + high.choose_below(one, one, zero)) * length / root;
    let none = above(discriminant, from.choose_below(to, zero, one), one);
    // A straight line has one root.
    let crossing = p1 / (p1 - p2);
    from = above(is_curved, from, above(p1, zero, crossing));
    to = above(is_curved, to, above(p1, crossing, one));
    ends = above(is_curved, ends, length / b.max(-b));
    let none = above(is_curved, none, above(p1.max(p2), zero, one));
    // Both ends deep in: all of it is.
    let lower = p1.min(p2);
    from = lower.choose_below(zero, above(none, zero, from), zero);
    to = lower.choose_below(zero, above(none, zero, to), one);
    sum.ends = sum.ends + lower.choose_below(zero, above(none, zero, ends), zero);
    // ∫ τⁿ dτ.
    let (f2, z2) = (from * from, to * to);
    let (f3, z3) = (f2 * from, z2 * to);
    let (f4, z4) = (f2 * f2, z2 * z2);
    let [t0, t1, t2] = [to - from, half * (z2 - f2), third * (z3 - f3)];
    let [t3, t4] = [u1.constant(0.25) * (z4 - f4), u1.constant(0.2) * z4.times_plus(to, -(f4 * from))];
    let i0 = length * p1.times_plus(t0, b.times_plus(t1, c * t2));
    let i1 = p1.times_plus(t1, b.times_plus(t2, c * t3));
    let linear = p1 * p1 * t0 + two * p1 * b * t1 + b * b * t2;
    let square = length * (linear + two * c * (p1 * t2 + b * t3) + c * c * t4);
    let first = u1.times_plus(i0, length * length * i1);
    let [a, z] = [from.times_plus(length, u1), to.times_plus(length, u1)];
    let [width, middle] = [z - a, half * (z + a)];
    sum.area = sum.area + i0;
    sum.square = sum.square + square;
    sum.length = sum.length + width;
    sum.first = width.times_plus(middle, sum.first);
    // The slope of the parabola on the chord is lean − u/R: on a circle lean is the difference to a parabola,
    // in a defect more.
    let lean = (half * curvature).times_plus(r.from + r.to, r.slope);
    sum.across = lean.times_plus(i0, sum.across) - curvature * first;
    // Growth of the roller's height h with its angle: u + h h′, but for the product of the arc's
    // height over the chord and the slope of that, because a parabola on a chord that turns stays one. Over τ
    // it is a₀ + a₁ τ + a₂ τ².
    let (before, behind) = (u1 - r.from, r.to - u1);
    let (chord, tip) = (r.slope.times_plus(u1, r.base), curvature * (behind - before));
    let inside = half * (curvature * r.slope * before * behind + chord * tip);
    let arm0 = r.slope.times_plus(chord, u1) + inside;
    let arm1 = length * (r.slope.times_plus(r.slope + tip, one) - curvature * chord);
    let arm2 = -(half * three * curvature * r.slope * length * length);
    let i2 = p1.times_plus(t2, b.times_plus(t3, c * t4));
    sum.moment = arm0.times_plus(i0, length.times_plus(arm1.times_plus(i1, arm2 * i2), sum.moment));
    sum.arm = length.times_plus(arm0.times_plus(t0, arm1.times_plus(t1, arm2 * t2)), sum.arm);
    let (pa, pz) = (c.times_plus(from, b).times_plus(from, p1), c.times_plus(to, b).times_plus(to, p1));
    let skewed = (lean - curvature * middle).times_plus(square, third * (pz * pz * pz - pa * pa * pa));
    // As in the moment, but for both bodies and with d: parabolas on chords stay parabolas. Gauss' rule with
    // three points is exact.
    let of_both = [half * curvature, bulge - half * curvature];
    let (beside, centre) = (u1.constant(0.5 * GAUSS) * (to - from), half * (from + to));
    let first = leaning(centre - beside, [u1, length], [p1, b, c], of_both, [r, w]);
    let second = leaning(centre, [u1, length], [p1, b, c], of_both, [r, w]);
    let last = leaning(centre + beside, [u1, length], [p1, b, c], of_both, [r, w]);
    let outer = u1.constant(5.0 / 9.0) * (first + last);
    let stays = width * u1.constant(8.0 / 9.0).times_plus(second, outer);
    sum.skew = sum.skew + (skewed - stays);
    sum.slope = width.times_plus(lean - curvature * middle, sum.slope);
    sum.second = third.times_plus(z * z * z - a * a * a, sum.second);
    sum.deepest = sum.deepest.max(p1).max(p2);
}
