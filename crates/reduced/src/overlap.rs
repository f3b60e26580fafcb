//! How far a roller sinks into a raceway, integrated exactly over the facets that overlap (THEORY §9.3).
//!
//! Both boundaries are heights h over u, and the penetration p(u) is the roller's less the raceway's.

use pulp::Simd;

use crate::{
    outline::{Facet, Parts, View, Walk},
    window::{self, Window},
};

/// How a raceway lies to a roller.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sides {
    /// Whether the vertices of the raceway go by along +t: those of the outer one do.
    pub along: bool,
    /// Height of the parabola over a segment of unit length [1/m]: half the relative curvature for arcs, 0 for chords.
    pub bulge: f64,
    /// Curvature of the roller [1/m]; 0 for chords.
    pub curvature: f64,
}

/// Integrals over the overlap, per unit of thickness.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Overlap {
    /// ∫ p du [m²].
    pub area: f64,
    /// ∫ p h′ du with the slope of the roller [m²]: force along t.
    pub across: f64,
    /// ∫ p (u + h h′) du [m³]: moment about the roller's centre.
    pub moment: f64,
    /// ∫ p² du [m³].
    pub square: f64,
    /// Length of the overlap [m].
    pub length: f64,
    /// ∫ u du over the overlap [m²].
    pub first: f64,
    /// ∫ u² du over the overlap [m³].
    pub second: f64,
    /// ∫ h′ du over the overlap [m].
    pub slope: f64,
    /// ∫ (u + h h′) du over the overlap [m²].
    pub arm: f64,
    /// ∫ p² h′ du, and ⅓ p³ where the overlap ends at a wall (minus where it begins) [m³]: by how much the square grows with a turn of d
    /// by one towards t.
    pub skew: f64,
    /// By how much the overlap is shorter for a shift [1]: the sum of 1/|p′| over its ends.
    pub ends: f64,
    /// Deepest penetration [m].
    pub deepest: f64,
}

impl Overlap {
    /// ∫ p du [m²] and the length [m] after a further small shift, to its second power.
    #[inline(always)]
    pub fn shifted_area(&self, shift: f64) -> [f64; 2] {
        let length = self.length - self.ends * shift;
        if length <= 0.0 {
            return [0.0; 2];
        }
        [(self.area - 0.5 * shift * (self.length + length)).max(0.0), length]
    }

    /// The overlap after a further small shift, whose area [m²] and length [m] are known.
    #[inline(always)]
    pub fn shifted(&self, shift: f64, [area, length]: [f64; 2]) -> Self {
        // p² falls by 2 ∫ p ds, and ∫ p ds holds two thirds of a step of the curvature (Simpson's rule on a parabola).
        let mean = self.area - shift * (0.5 * self.length - self.ends * shift / 6.0);
        let share = if self.length > 0.0 { length / self.length } else { 0.0 };
        let about = if self.length > 0.0 { self.first * self.first / self.length } else { 0.0 };
        Self {
            area,
            length,
            square: (self.square - 2.0 * shift * mean).max(0.0),
            across: self.across - 0.5 * (1.0 + share) * shift * self.slope,
            moment: self.moment - 0.5 * (1.0 + share) * shift * self.arm,
            first: share * self.first,
            second: share * about + share.powi(3) * (self.second - about),
            slope: share * self.slope,
            arm: share * self.arm,
            skew: self.skew,
            ends: self.ends,
            deepest: self.deepest - shift,
        }
    }
}

/// A roller and a raceway near their contact.
#[derive(Debug, Clone, Copy)]
pub struct Pair<'a> {
    /// The roller.
    pub roller: View<'a>,
    /// The raceway.
    pub raceway: View<'a>,
    /// How the raceway lies to the roller.
    pub sides: Sides,
    /// Roller and raceway again, eight facets at once.
    windows: [Window; 2],
    /// Whether they can be seen so.
    pub in_windows: bool,
}

impl<'a> Pair<'a> {
    /// Of two views, looked at in vectors where it can be.
    #[inline(always)]
    pub fn new<S: Simd>(simd: S, roller: View<'a>, raceway: View<'a>, sides: Sides) -> Self {
        let mut windows = [Window::default(); 2];
        let [first, second] = &mut windows;
        let in_windows = first.look(simd, &roller, true) && second.look(simd, &raceway, sides.along);
        Self { roller, raceway, sides, windows, in_windows }
    }

    /// The overlap of a roller that is pressed back by `shift` [m], looked for up to `reach` [m] to either side.
    #[inline(always)]
    pub fn overlap(&self, shift: f64, reach: f64) -> Overlap {
        let sides = self.sides;
        if sides.bulge == 0.0 && sides.curvature == 0.0 {
            self.taken(reach, Chords { sum: Overlap::default(), shift }).sum
        } else {
            self.taken(reach, Arcs { sum: Overlap::default(), sides, shift }).sum
        }
    }

    #[inline(always)]
    fn taken<P: Parts>(&self, reach: f64, mut parts: P) -> P {
        if !(self.in_windows && window::segments(&self.windows, reach, &mut parts)) {
            self.walk(reach, &mut parts);
        }
        parts
    }

    /// Walks along both boundaries, and hands over what lies between two places where neither has a vertex.
    #[inline(always)]
    fn walk(&self, reach: f64, parts: &mut impl Parts) {
        let mut u = -reach;
        let mut r = Walk::new(self.roller, true, u);
        let mut w = Walk::new(self.raceway, self.sides.along, u);
        let most = self.roller.outline.len() + self.raceway.outline.len();
        for _ in 0..most {
            let end = r.b[0].min(w.end).min(reach);
            if end > u {
                parts.add([u, end], r.facet(), w.facet());
                u = end;
            }
            if end >= reach {
                break;
            }
            // Walls of a groove may lean over: their facets hold no u.
            if r.b[0] <= w.end { r.step() } else { w.step() }
        }
    }
}

/// Adds up what lies between straight lines.
struct Chords {
    sum: Overlap,
    shift: f64,
}

impl Parts for Chords {
    #[inline(always)]
    fn add(&mut self, ends: [f64; 2], roller: Facet, raceway: Facet) {
        chords(&mut self.sum, ends, roller, raceway, self.shift);
    }
}

/// Adds up what lies between parabolas.
struct Arcs {
    sum: Overlap,
    sides: Sides,
    shift: f64,
}

impl Parts for Arcs {
    #[inline(always)]
    fn add(&mut self, ends: [f64; 2], roller: Facet, raceway: Facet) {
        arcs(&mut self.sum, ends, roller, raceway, self.sides, self.shift);
    }
}

/// Adds what lies between two straight lines.
#[inline(always)]
fn chords(sum: &mut Overlap, [u1, u2]: [f64; 2], r: Facet, w: Facet, shift: f64) {
    let Facet { slope, base, .. } = r;
    let (steep, gap) = (slope - w.slope, (base - w.base) - shift);
    let [p1, p2] = [gap + steep * u1, gap + steep * u2];
    if p1 <= 0.0 && p2 <= 0.0 {
        return;
    }
    let ([mut a, mut z], [mut pa, mut pz]) = ([u1, u2], [p1, p2]);
    if pa < 0.0 || pz < 0.0 {
        let flat = 1.0 / steep.abs();
        sum.ends += flat;
        if pa < 0.0 {
            (a, pa) = (a - pa * flat, 0.0);
        } else {
            (z, pz) = (z + pz * flat, 0.0);
        }
    }
    // p is linear from a to z: Simpson's rule is exact.
    let (width, middle, mean) = (z - a, 0.5 * (a + z), 0.5 * (pa + pz));
    let area = width * mean;
    let sixth = width * (1.0 / 6.0);
    let first = area * middle + sixth * (0.5 * width) * (pz - pa);
    let square = sixth * (pa * pa + pz * pz + 4.0 * mean * mean);
    let (lever, stand) = (base * slope, 1.0 + slope * slope);
    sum.area += area;
    sum.square += square;
    sum.length += width;
    sum.first += width * middle;
    sum.second += sixth * (a * a + z * z + 4.0 * middle * middle);
    sum.across += slope * area;
    sum.moment += lever * area + stand * first;
    sum.skew += slope * square + (pz * pz * pz - pa * pa * pa) * (1.0 / 3.0);
    sum.slope += slope * width;
    sum.arm += width * (lever + stand * middle);
    let higher = if p1 > p2 { p1 } else { p2 };
    sum.deepest = if sum.deepest > higher { sum.deepest } else { higher };
}

/// Adds what lies between two parabolas on chords.
#[inline(always)]
fn arcs(sum: &mut Overlap, [u1, u2]: [f64; 2], r: Facet, w: Facet, sides: Sides, shift: f64) {
    let (of_roller, base) = (r.slope, r.base);
    let curvature = sides.curvature * r.stretch();
    let bulge = 0.5 * curvature + (sides.bulge - 0.5 * sides.curvature) * w.stretch();
    let height = |u: f64| {
        let chords = (base - w.base) - shift + (of_roller - w.slope) * u;
        // What the arcs stand out from their chords.
        let of = |facet: Facet| (u - facet.from) * (facet.to - u);
        chords + 0.5 * curvature * of(r) + (bulge - 0.5 * curvature) * of(w)
    };
    let [p1, p2] = [height(u1), height(u2)];
    let length = u2 - u1;
    // p = p1 + b τ + c τ² over τ from 0 to 1.
    let c = -bulge * length * length;
    let b = p2 - p1 - c;
    let (from, to) = if p1 >= 0.0 && p2 >= 0.0 {
        (0.0, 1.0)
    } else if c == 0.0 {
        if p1 <= 0.0 && p2 <= 0.0 {
            return;
        }
        let root = p1 / (p1 - p2);
        sum.ends += length / b.abs();
        if p1 > 0.0 { (0.0, root) } else { (root, 1.0) }
    } else {
        let discriminant = b * b - 4.0 * c * p1;
        if discriminant <= 0.0 {
            return;
        }
        // c < 0: the parabola is positive between its roots.
        let root = discriminant.sqrt();
        let [low, high] = [(-b + root) / (2.0 * c), (-b - root) / (2.0 * c)];
        let [from, to] = [low.max(0.0), high.min(1.0)];
        if from >= to {
            return;
        }
        let cut = usize::from(low > 0.0) + usize::from(high < 1.0);
        sum.ends += cut as f64 * length / root;
        (from, to)
    };
    // ∫ τⁿ dτ.
    let (f2, z2) = (from * from, to * to);
    let (f3, z3) = (f2 * from, z2 * to);
    let [t0, t1, t2] = [to - from, 0.5 * (z2 - f2), (z3 - f3) * (1.0 / 3.0)];
    let mut i0 = p1 * t0 + b * t1;
    let mut i1 = p1 * t1 + b * t2;
    let mut square = p1 * p1 * t0 + 2.0 * p1 * b * t1 + b * b * t2;
    if c != 0.0 {
        let (f4, z4) = (f2 * f2, z2 * z2);
        let [t3, t4] = [0.25 * (z4 - f4), 0.2 * (z4 * to - f4 * from)];
        i0 += c * t2;
        i1 += c * t3;
        square += 2.0 * p1 * c * t2 + 2.0 * b * c * t3 + c * c * t4;
    }
    let first = length * (u1 * i0 + length * i1);
    let i0 = length * i0;
    sum.area += i0;
    let [a, z] = [u1 + from * length, u1 + to * length];
    let [width, middle] = [z - a, 0.5 * (z + a)];
    let square = length * square;
    sum.square += square;
    sum.length += width;
    sum.first += width * middle;
    // The slope of the parabola on the chord is lean − u/R: on a circle lean is what a parabola leaves out, in a defect more.
    // The height is taken in the middle: the part is short.
    let lean = of_roller + 0.5 * curvature * (r.from + r.to);
    let high = base + of_roller * middle + 0.5 * curvature * (middle - r.from) * (r.to - middle);
    let rest = 1.0 - curvature * high;
    sum.across += lean * i0 - curvature * first;
    sum.moment += lean * high * i0 + rest * first;
    let [pa, pz] = [from, to].map(|at| p1 + (b + c * at) * at);
    sum.skew += (lean - curvature * middle) * square + (pz * pz * pz - pa * pa * pa) * (1.0 / 3.0);
    sum.slope += width * (lean - curvature * middle);
    sum.arm += width * (lean * high + rest * middle);
    sum.second += (z * z * z - a * a * a) / 3.0;
    sum.deepest = sum.deepest.max(p1).max(p2);
}
