//! How far a roller sinks into a raceway, integrated exactly over the facets that overlap (THEORY §9.3).
//!
//! Seen from the roller's centre, d points to the raceway and t is d turned by a right angle; a point is (u, h), u along t and
//! h along d. Both boundaries are heights over u, and the penetration p(u) is the roller's less the raceway's.

/// Closed boundary of a raceway or roller, counter-clockwise, in the frame of its body.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Outline {
    /// Abscissae of the vertices [m].
    pub x: Vec<f64>,
    /// Ordinates of the vertices [m].
    pub y: Vec<f64>,
}

impl Outline {
    /// Of vertices in counter-clockwise order.
    pub fn new(vertices: &[[f64; 2]]) -> Self {
        Self { x: vertices.iter().map(|v| v[0]).collect(), y: vertices.iter().map(|v| v[1]).collect() }
    }

    /// Vertices.
    pub fn len(&self) -> usize {
        self.x.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.x.is_empty()
    }

    #[inline(always)]
    fn next(&self, i: usize) -> usize {
        if i + 1 == self.x.len() { 0 } else { i + 1 }
    }

    #[inline(always)]
    fn before(&self, i: usize) -> usize {
        if i == 0 { self.x.len() - 1 } else { i - 1 }
    }

    /// The facet that the ray from `from` along `d` goes through, near facet `hint`. With `sign` −1 seen from outside, where
    /// vertices go by the other way.
    #[inline(always)]
    pub fn facet_along(&self, from: [f64; 2], d: [f64; 2], hint: usize, sign: f64) -> usize {
        let side = |i: usize| sign * (d[0] * (self.y[i] - from[1]) - d[1] * (self.x[i] - from[0]));
        let mut facet = if hint < self.x.len() { hint } else { 0 };
        // A whole turn at most, should nothing fit.
        for _ in 0..self.x.len() {
            if side(facet) > 0.0 {
                facet = self.before(facet);
            } else if side(self.next(facet)) <= 0.0 {
                facet = self.next(facet);
            } else {
                break;
            }
        }
        facet
    }

    /// Where the ray from the origin along `d` goes through a facet: the share of its second vertex.
    #[inline(always)]
    pub fn share(&self, facet: usize, d: [f64; 2]) -> f64 {
        let side = |i: usize| d[0] * self.y[i] - d[1] * self.x[i];
        let [a, b] = [side(facet), side(self.next(facet))];
        if b > a { (-a / (b - a)).clamp(0.0, 1.0) } else { 0.0 }
    }

    /// How deep the point at `distance` from the centre in the direction `d` lies within a regular polygon [m], and the sine of
    /// the angle from `d` to the normal of the facet above it.
    #[inline(always)]
    pub fn depth(&self, d: [f64; 2], distance: f64) -> (f64, f64) {
        let n = self.x.len();
        let facet = std::f64::consts::TAU / n as f64;
        let middle = ((d[1].atan2(d[0]) / facet).floor() + 0.5) * facet;
        let tilt = middle - d[1].atan2(d[0]);
        (self.x[0] * (0.5 * facet).cos() - distance * tilt.cos(), tilt.sin())
    }
}

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
    /// ∫ p² h′ du [m³]: by how much the square grows with a turn of d by one towards t.
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

/// A roller or a raceway, seen from the roller's centre.
#[derive(Debug, Clone, Copy)]
pub struct View<'a> {
    /// The boundary.
    pub outline: &'a Outline,
    /// The roller's centre in its frame [m].
    pub from: [f64; 2],
    /// The direction d in its frame.
    pub d: [f64; 2],
    /// The facet that the ray along d goes through.
    pub facet: usize,
}

impl View<'_> {
    #[inline(always)]
    fn see(&self, vertex: usize) -> [f64; 2] {
        let [x, y] = [self.outline.x[vertex] - self.from[0], self.outline.y[vertex] - self.from[1]];
        [self.d[0] * y - self.d[1] * x, self.d[0] * x + self.d[1] * y]
    }
}

/// Walks along vertices with growing u.
struct Walk<'a> {
    view: View<'a>,
    along: bool,
    /// The vertex that comes next.
    vertex: usize,
    /// Ends of the present facet, and where the next one ends.
    a: [f64; 2],
    b: [f64; 2],
    next: [f64; 2],
    slope: f64,
    /// How much more an arc on the facet curves over u than along it: one over the cube of the cosine of its slope, as a series.
    stretch: f64,
    /// How far the facet is seen: a wall behind it may lean over it.
    end: f64,
}

impl<'a> Walk<'a> {
    /// Begins with the facet that holds u = `start`, which is negative.
    #[inline(always)]
    fn new(view: View<'a>, along: bool, start: f64) -> Self {
        let outline = view.outline;
        // The end of the facet with the smaller u.
        let mut first = if along { view.facet } else { outline.next(view.facet) };
        let mut a = view.see(first);
        for _ in 0..outline.len() {
            if a[0] <= start {
                break;
            }
            first = if along { outline.before(first) } else { outline.next(first) };
            a = view.see(first);
        }
        let mut walk =
            Self { view, along, vertex: first, a, b: a, next: a, slope: 0.0, stretch: 1.0, end: a[0] };
        walk.look();
        walk.step();
        walk
    }

    /// Sees one vertex further.
    #[inline(always)]
    fn look(&mut self) {
        self.vertex = if self.along {
            self.view.outline.next(self.vertex)
        } else {
            self.view.outline.before(self.vertex)
        };
        self.next = self.view.see(self.vertex);
    }

    /// Goes on to the next facet.
    #[inline(always)]
    fn step(&mut self) {
        (self.a, self.b) = (self.b, self.next);
        self.look();
        let width = self.b[0] - self.a[0];
        self.slope = if width > 0.0 { (self.b[1] - self.a[1]) / width } else { 0.0 };
        let square = self.slope * self.slope;
        // Walls are no part of a circle.
        self.stretch = if square > 1.0 { 0.0 } else { 1.0 + square * (1.5 + 0.375 * square) };
        let hidden = self.next[0] < self.b[0] && self.next[1] < self.b[1];
        self.end = if hidden { self.next[0] } else { self.b[0] };
    }
}

/// The overlap of a roller that is pressed back by `shift` [m], looked for up to `reach` [m] to either side.
#[inline(always)]
pub fn overlap(roller: View<'_>, raceway: View<'_>, sides: Sides, shift: f64, reach: f64) -> Overlap {
    let mut sum = Overlap::default();
    let mut u = -reach;
    let mut r = Walk::new(roller, true, u);
    let mut w = Walk::new(raceway, sides.along, u);
    let most = roller.outline.len() + raceway.outline.len();
    for _ in 0..most {
        let end = r.b[0].min(w.end).min(reach);
        if end > u {
            segment(&mut sum, [u, end], &r, &w, sides, shift);
            u = end;
        }
        if end >= reach {
            break;
        }
        // Walls of a groove may lean over: their facets hold no u.
        if r.b[0] <= w.end { r.step() } else { w.step() }
    }
    sum
}

/// Adds what lies between two places where neither boundary has a vertex.
#[inline(always)]
fn segment(sum: &mut Overlap, [u1, u2]: [f64; 2], r: &Walk<'_>, w: &Walk<'_>, sides: Sides, shift: f64) {
    let [of_roller, of_raceway] = [r.slope, w.slope];
    let base = r.a[1] - of_roller * r.a[0];
    let curvature = sides.curvature * r.stretch;
    let bulge = 0.5 * curvature + (sides.bulge - 0.5 * sides.curvature) * w.stretch;
    let height = |u: f64| {
        let chords = base + of_roller * u - (w.a[1] + of_raceway * (u - w.a[0])) - shift;
        if sides.bulge == 0.0 {
            return chords;
        }
        // What the arcs stand out from their chords.
        let of = |walk: &Walk<'_>| (u - walk.a[0]) * (walk.b[0] - u);
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
    if sides.curvature == 0.0 {
        sum.across += of_roller * i0;
        sum.moment += base * of_roller * i0 + (1.0 + of_roller * of_roller) * first;
        sum.skew += of_roller * square;
        sum.slope += of_roller * width;
        sum.arm += width * (base * of_roller + (1.0 + of_roller * of_roller) * middle);
    } else {
        // The slope of the parabola on the chord is lean − u/R: on a circle lean is what a parabola leaves out, in a defect more.
        // The height is taken in the middle: the part is short.
        let lean = of_roller + 0.5 * curvature * (r.a[0] + r.b[0]);
        let high = base + of_roller * middle + 0.5 * curvature * (middle - r.a[0]) * (r.b[0] - middle);
        let rest = 1.0 - curvature * high;
        sum.across += lean * i0 - curvature * first;
        sum.moment += lean * high * i0 + rest * first;
        sum.skew += (lean - curvature * middle) * square;
        sum.slope += width * (lean - curvature * middle);
        sum.arm += width * (lean * high + rest * middle);
    }
    sum.second += (z * z * z - a * a * a) / 3.0;
    sum.deepest = sum.deepest.max(p1).max(p2);
}
