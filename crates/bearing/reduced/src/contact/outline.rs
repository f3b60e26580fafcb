//! Boundaries of raceways and rollers, as projected from a roller's centre (THEORY §9.3): d points to the
//! raceway and t is d turned by a right angle; a point is (u, h), u along t and h along d.

use stribeck_simd::lanes::Number;

/// Vertices repeated before the first and after the last one, for vector loads.
pub(crate) const PAD: usize = 16;

/// Closed boundary of a raceway or roller, counter-clockwise, in the frame of its body.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Outline {
    /// Abscissae of the vertices [m].
    pub x: Vec<f64>,
    /// Ordinates of the vertices [m].
    pub y: Vec<f64>,
    /// Both again, with vertices repeated: counter-clockwise and clockwise.
    ahead: [Vec<f64>; 2],
    back: [Vec<f64>; 2],
    /// Whether neither the facet nor its neighbours are walls, facet by facet.
    plain: Vec<bool>,
}

/// Facets whose cosine to the circle through them is smaller are walls.
const WALL: f64 = 0.5;

impl Outline {
    /// Of vertices in counter-clockwise order.
    pub fn new(vertices: &[[f64; 2]]) -> Self {
        let n = vertices.len();
        // Vertex −i is the last but i − 1, of as many rounds as it takes.
        let repeated = |c: usize| -> Vec<f64> {
            let count = if n == 0 { 0 } else { n + 2 * PAD };
            (0..count).map(|i| vertices[(i + n * PAD - PAD) % n][c]).collect()
        };
        let reversed = |c: usize| repeated(c).into_iter().rev().collect();
        let is_wall = |i: usize| {
            let [[ax, ay], [bx, by]] = [vertices[i % n], vertices[(i + 1) % n]];
            let (length, radius) = (libm::hypot(bx - ax, by - ay), libm::hypot(ax + bx, ay + by));
            (by - ay) * (ax + bx) - (bx - ax) * (ay + by) <= WALL * length * radius
        };
        Self {
            x: vertices.iter().map(|v| v[0]).collect(),
            y: vertices.iter().map(|v| v[1]).collect(),
            ahead: [0, 1].map(repeated),
            back: [0, 1].map(reversed),
            plain: (0..n).map(|i| ![n - 1, n, n + 1].iter().any(|&beside| is_wall(i + beside))).collect(),
        }
    }

    /// Abscissae and ordinates; vertex 0 is number [`PAD`], and vertices before and after it are repeated.
    #[inline(always)]
    pub(crate) fn ahead(&self) -> [&[f64]; 2] {
        [&self.ahead[0], &self.ahead[1]]
    }

    /// The same clockwise; the last vertex is number [`PAD`].
    #[inline(always)]
    pub(crate) fn back(&self) -> [&[f64]; 2] {
        [&self.back[0], &self.back[1]]
    }

    /// The same about another origin [m].
    pub(crate) fn about(&self, [x, y]: [f64; 2]) -> Self {
        let moved: Vec<_> = self.x.iter().zip(&self.y).map(|(vx, vy)| [vx - x, vy - y]).collect();
        Self::new(&moved)
    }

    /// Distances of the vertices from the origin [m].
    pub(crate) fn radii(&self) -> impl Iterator<Item = f64> {
        self.x.iter().zip(&self.y).map(|(x, y)| libm::hypot(*x, *y))
    }

    /// Vertices.
    pub fn len(&self) -> usize {
        self.x.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.x.is_empty()
    }

    /// Whether neither a facet nor its neighbours are walls: seen from a roller that it is near to, it goes
    /// by with growing u.
    #[inline(always)]
    pub(crate) fn is_plain(&self, facet: usize) -> bool {
        self.plain[facet]
    }

    #[inline(always)]
    pub(crate) fn next(&self, i: usize) -> usize {
        if i + 1 == self.x.len() { 0 } else { i + 1 }
    }

    #[inline(always)]
    pub(crate) fn before(&self, i: usize) -> usize {
        if i == 0 { self.x.len() - 1 } else { i - 1 }
    }

    /// The facet that the ray from `from` along `d` goes through, near facet `hint`. With `sign` −1 seen from
    /// outside, where vertices go by the other way.
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

/// A facet in the frame of the contact: the line h = base + slope u, between two values of u [m].
#[derive(Debug, Clone, Copy)]
pub(crate) struct Facet<N = f64> {
    pub(crate) from: N,
    pub(crate) to: N,
    pub(crate) slope: N,
    pub(crate) base: N,
}

impl<N: Number> Facet<N> {
    /// Product of the distances of u from both ends [m²].
    #[inline(always)]
    pub(crate) fn inside(&self, u: N) -> N {
        (u - self.from) * (self.to - u)
    }

    /// Ratio of an arc's curvature over u to that along the facet: one over the cube of the cosine of its
    /// slope, as a series.
    #[inline(always)]
    pub(crate) fn stretch(&self) -> N {
        let square = self.slope * self.slope;
        let (zero, one) = (square.constant(0.0), square.constant(1.0));
        let (a, b) = (square.constant(1.5), square.constant(0.375));
        // Walls are no part of a circle.
        one.choose_below(square, zero, square.times_plus(b.times_plus(square, a), one))
    }
}

/// Receiver of the segments between two vertices of either boundary. A trait, because closures
/// are compiled without the vectors' instruction set.
pub(crate) trait Parts {
    /// Adds the segment between two values of u [m], on these facets of roller and raceway.
    fn add(&mut self, ends: [f64; 2], roller: Facet, raceway: Facet);
    /// Adds an overhanging wall of the roller: at `u` one facet of the roller ends and another continues,
    /// higher or lower.
    fn jump(&mut self, u: f64, roller: [Facet; 2], raceway: Facet);
}

/// Walks along vertices with growing u.
pub(crate) struct Walk<'a> {
    view: View<'a>,
    along: bool,
    /// The next vertex.
    vertex: usize,
    /// Ends of the present facet, and where the next one ends.
    a: [f64; 2],
    pub(crate) b: [f64; 2],
    next: [f64; 2],
    slope: f64,
    /// 1 where lower facets hide those behind them, as on raceways, −1 where higher ones do, as on rollers.
    hides: f64,
    /// Where the visible part of the facet ends: a wall behind it may overhang it.
    pub(crate) end: f64,
    /// Whether an overhanging wall was passed; reading resets it.
    pub(crate) jumps: bool,
}

impl<'a> Walk<'a> {
    /// Begins with the facet of a roller that holds u = `start`, which is negative.
    #[inline(always)]
    pub(crate) fn of_roller(view: View<'a>, start: f64) -> Self {
        Self::new(view, true, -1.0, start)
    }

    /// The same of a raceway.
    #[inline(always)]
    pub(crate) fn of_raceway(view: View<'a>, along: bool, start: f64) -> Self {
        Self::new(view, along, 1.0, start)
    }

    #[inline(always)]
    fn new(view: View<'a>, along: bool, hides: f64, start: f64) -> Self {
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
            Self { view, along, vertex: first, a, b: a, next: a, slope: 0.0, hides, end: a[0], jumps: false };
        walk.look();
        walk.step();
        walk.jumps = false;
        walk
    }

    /// Projects one more vertex.
    #[inline(always)]
    fn look(&mut self) {
        self.vertex = if self.along {
            self.view.outline.next(self.vertex)
        } else {
            self.view.outline.before(self.vertex)
        };
        self.next = self.view.see(self.vertex);
    }

    /// Advances to the next facet.
    #[inline(always)]
    pub(crate) fn step(&mut self) {
        (self.a, self.b) = (self.b, self.next);
        self.look();
        let width = self.b[0] - self.a[0];
        self.slope = if width > 0.0 { (self.b[1] - self.a[1]) / width } else { 0.0 };
        self.jumps |= width <= 0.0;
        let hidden = self.next[0] < self.b[0] && self.hides * (self.next[1] - self.b[1]) < 0.0;
        self.end = if hidden { self.next[0] } else { self.b[0] };
    }

    #[inline(always)]
    pub(crate) fn facet(&self) -> Facet {
        let base = self.a[1] - self.slope * self.a[0];
        Facet { from: self.a[0], to: self.b[0], slope: self.slope, base }
    }
}
