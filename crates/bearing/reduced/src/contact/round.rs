//! Penetration of round rollers into a raceway of arcs, eight rollers side by side (THEORY §9.3).
//!
//! A raceway is a circle with a relief: the depth of its vertices below that circle, which grows in
//! proportion from one to the next. Neighbours of one depth are one piece, so that a roller away from
//! defects is over a single one, and its contact is that of two circles. Penetration over the tangential
//! coordinate u is a parabola on each piece, about the place where the piece is nearest to the middle of the
//! contact.

use pulp::Simd;
use stribeck_simd::lanes::{LANES, Number, Vector, vector_starts};

use crate::{
    contact::{outline::Outline, penetration::Penetration},
    dense,
    row::{Row, Rows, lanes, load, of_one},
};

/// Depths that differ by less are one [m]: far above rounding, and far below the height of any form.
const ONE_DEPTH: f64 = 1e-12;

/// Cosine of the angle that a piece takes at most: seen from a roller over one of two neighbours, both ends
/// lie to either side.
const WIDEST: f64 = 0.5;

/// Facets whose cosine to the circle is smaller are walls: the penetration jumps there.
const WALL: f64 = 0.5;

/// A circle and the relief on it, about its own centre.
#[derive(Debug, Clone)]
pub(crate) struct Relief {
    /// Radius of the circle and of the rollers [m].
    radius: f64,
    roller: f64,
    /// +1 where rollers are inside of it, −1 where they are outside.
    outwards: f64,
    /// In the order of growing u.
    pieces: Vec<Piece>,
    /// The piece of each facet; of walls the one before them.
    of_facet: Vec<u32>,
}

/// A part of a raceway over which the depth grows in proportion: both ends with growing u, and how much
/// farther from rollers than the circle the raceway is there [m].
#[derive(Debug, Clone, Copy)]
struct Piece {
    ends: [[f64; 2]; 2],
    depth: [f64; 2],
    /// Which of both ends is the upper end of a wall.
    edge: [bool; 2],
}

/// A piece as it is seen from a roller: u of both ends and their heights along d from the centre of the
/// raceway, and depths there, all in [m].
#[derive(Debug, Clone, Copy)]
struct Seen<N> {
    u: [N; 2],
    height: [N; 2],
    depth: [N; 2],
}

/// Pieces under eight rollers, each as far as its contact may reach, kept from step to step of a sample.
#[derive(Debug, Clone, Default)]
pub(crate) struct RoundParts {
    parts: Vec<Part>,
    /// How many each roller has, and any of those of interest at most.
    counts: [usize; LANES],
    count: usize,
    /// Where the first of them begins and the last one ends.
    fences: [Rows; 2],
}

/// One piece under each of eight rollers; where there is none both ends are the centre of the raceway.
#[derive(Debug, Clone, Copy, Default)]
struct Part {
    ends: [Rows; 2],
    depth: Rows,
    /// Those whose depth grows, a bit for each.
    sloped: u64,
    /// The penetration in this step: p, q, c and 1/2c of [`Parabola`], and both ends.
    curve: [Row; 6],
}

/// The penetration over a piece: p + q v − c v² over v, u from the place of the piece that is nearest to the
/// middle of the contact.
#[derive(Debug, Clone, Copy)]
struct Parabola<N> {
    p: N,
    q: N,
    c: N,
    /// Third derivative.
    third: N,
    per_twice: N,
    middle: N,
    ends: [N; 2],
    /// Whether a piece is beside the middle in any lane.
    aside: bool,
    /// By how much the depth grows with u, and the width of the piece; of sloped ones alone.
    grows: N,
    width: N,
}

/// Where eight rollers are, in the frame of a raceway, and what is known of their contacts.
pub(crate) struct Contacts<'a> {
    /// Directions to the contacts.
    pub(crate) d: &'a Rows,
    /// Distances from the centre of the circle [m].
    pub(crate) distance: &'a Row,
    /// How far contacts may reach at the forces to start from [m].
    pub(crate) reach: &'a Row,
    /// How much of ragged edges is gone where the rollers meet them [m].
    pub(crate) ragged: &'a Row,
    /// Those of interest, a bit for each.
    pub(crate) these: u64,
}

/// Pieces are known this much farther than a contact reaches at the force to start from: that force may be
/// smaller.
const MARGIN: f64 = 1.25;

impl Relief {
    /// Of an outline about the centre of the circle, whose radius is `radius` [m], for round rollers [m].
    /// `along` is whether vertices follow with growing u; facets beside walls are pieces of their own where edges
    /// are `ragged`.
    pub(crate) fn new(outline: &Outline, radius: f64, roller: f64, along: bool, ragged: bool) -> Self {
        let n = outline.len();
        let outwards = if along { 1.0 } else { -1.0 };
        let place = |vertex: usize| [outline.x[vertex], outline.y[vertex]];
        let depth = |vertex: usize| outwards * (libm::hypot(outline.x[vertex], outline.y[vertex]) - radius);
        let mut relief = Self { radius, roller, outwards, pieces: Vec::new(), of_facet: vec![0; n] };
        let mut joins = false;
        for step in 0..n {
            let facet = if along { step } else { n - 1 - step };
            let [a, b] = if along { [facet, outline.next(facet)] } else { [outline.next(facet), facet] };
            let [[ax, ay], [bx, by]] = [place(a), place(b)];
            let (length, far) = (libm::hypot(bx - ax, by - ay), libm::hypot(ax + bx, ay + by));
            let around = outwards * ((by - ay) * (ax + bx) - (bx - ax) * (ay + by));
            if around <= WALL * length * far {
                joins = false;
            } else {
                let [from, to] = [depth(a), depth(b)];
                let level = (to - from).abs() < ONE_DEPTH;
                let goes_on = |last: &&mut Piece| {
                    let [x, y] = last.ends[0];
                    let near = x * bx + y * by > WIDEST * libm::hypot(x, y) * libm::hypot(bx, by);
                    let depths = [last.depth[0], last.depth[1], to];
                    near && level && !ragged && depths.iter().all(|depth| (depth - from).abs() < ONE_DEPTH)
                };
                match relief.pieces.last_mut().filter(|last| joins && goes_on(last)) {
                    Some(last) => last.ends[1] = [bx, by],
                    None => {
                        let depth = if level { [from; 2] } else { [from, to] };
                        relief.pieces.push(Piece { ends: [[ax, ay], [bx, by]], depth, edge: [false; 2] });
                    }
                }
                joins = true;
            }
            relief.of_facet[facet] = relief.pieces.len().saturating_sub(1) as u32;
        }
        if ragged {
            // Only walls are between pieces that do not meet.
            let n = relief.pieces.len();
            for i in 0..n {
                let next = (i + 1) % n;
                let rise = relief.pieces[i].depth[1] - relief.pieces[next].depth[0];
                relief.pieces[i].edge[1] = rise < -ONE_DEPTH;
                relief.pieces[next].edge[0] = rise > ONE_DEPTH;
            }
        }
        relief
    }

    /// The pieces from `−reach` to `reach` [m], as a roller over `facet` in the direction `d` has them.
    fn under(&self, facet: usize, d: [f64; 2], reach: f64) -> impl Iterator<Item = &Piece> {
        let n = self.pieces.len();
        let u = move |[x, y]: [f64; 2]| d[0] * y - d[1] * x;
        let mut first = self.of_facet[facet] as usize;
        for _ in 0..n {
            if u(self.pieces[first].ends[0]) <= -reach {
                break;
            }
            first = if first == 0 { n - 1 } else { first - 1 };
        }
        let mut reached = false;
        (0..n).map(move |step| &self.pieces[(first + step) % n]).take_while(move |piece| {
            let goes_on = !reached;
            reached = u(piece.ends[1]) >= reach;
            goes_on
        })
    }

    /// The overlap of one roller over a facet that is pressed back by `shift` [m].
    pub(crate) fn overlap(
        &self,
        facet: usize,
        d: [f64; 2],
        distance: f64,
        shift: f64,
        reach: f64,
    ) -> Penetration {
        let mut sum = Penetration::none(0.0);
        for piece in self.under(facet, d, reach) {
            let seen = Seen::of(piece.ends, piece.depth, d);
            let sloped = piece.depth[0] != piece.depth[1];
            self.add(&mut sum, &seen, self.outwards * distance - shift, sloped, 1);
        }
        self.per_path(sum, distance)
    }

    /// Finds the pieces under eight rollers, and their penetration without the deflection of the bodies.
    /// `facet` says over which facet a roller is whose pieces are no longer known.
    #[inline(always)]
    pub(crate) fn look<S: Simd>(
        &self,
        simd: S,
        contacts: &Contacts<'_>,
        pieces: &mut RoundParts,
        mut facet: impl FnMut(usize) -> usize,
    ) {
        for lane in lanes(pieces.stale(simd, contacts) & contacts.these) {
            let reach = MARGIN * contacts.reach[lane];
            pieces.list(self, facet(lane), lane, of_one(contacts.d, lane), [reach, contacts.ragged[lane]]);
        }
        pieces.count = 0;
        for lane in lanes(contacts.these) {
            pieces.count = pieces.count.max(pieces.counts[lane]);
        }
        for at in vector_starts(simd) {
            let d = load(simd, contacts.d, at);
            let base = Vector::all(simd, self.outwards) * Vector::load(simd, contacts.distance, at);
            for part in &mut pieces.parts[..pieces.count] {
                let seen = part.seen(simd, at, d);
                let parabola = self.penetration(&seen, base, part.sloped != 0, contacts.these >> at);
                let Parabola { p, q, c, per_twice, ends, .. } = parabola;
                let [p_row, q_row, c_row, per_row, left, right] = &mut part.curve;
                p.store(p_row, at);
                q.store(q_row, at);
                c.store(c_row, at);
                per_twice.store(per_row, at);
                ends[0].store(left, at);
                ends[1].store(right, at);
            }
        }
    }

    /// Overlaps of the rollers in the lanes from `at` on, which are pressed back by `shift` [m].
    #[inline(always)]
    pub(crate) fn overlaps<S: Simd>(
        &self,
        simd: S,
        at: usize,
        Contacts { d, distance, these, .. }: &Contacts<'_>,
        pieces: &RoundParts,
        shift: Vector<S>,
    ) -> Penetration<Vector<S>> {
        let (d, distance) = (load(simd, d, at), Vector::load(simd, distance, at));
        let base = Vector::all(simd, self.outwards).times_plus(distance, -shift);
        let mut sum = Penetration::none(Vector::all(simd, 0.0));
        for part in &pieces.parts[..pieces.count] {
            self.add(&mut sum, &part.seen(simd, at, d), base, part.sloped != 0, these >> at);
        }
        self.per_path(sum, distance)
    }

    /// Forces along the path from what the energy changes by with the angle.
    #[inline(always)]
    fn per_path<N: Number>(&self, sum: Penetration<N>, distance: N) -> Penetration<N> {
        let per = distance.constant(self.outwards) / distance;
        Penetration { across: sum.across * per, slope: sum.slope * per, ..sum }
    }

    /// Heights of roller over raceway at u, without depth and the distance of their centres: value, first
    /// derivative, half the curvature with the other sign, third derivative.
    #[inline(always)]
    fn clearance<N: Number>(&self, u: N) -> [N; 4] {
        let of = |value: f64| u.constant(value);
        let [roller, race] = [1.0 / self.roller, 1.0 / self.radius];
        let square = u * u;
        let (at_roller, at_race) = (square * of(roller * roller), square * of(race * race));
        let (i, j) = (inverse_cosine(at_roller), inverse_cosine(at_race));
        let (i2, j2, one) = (i * i, j * j, of(1.0));
        let (k, l) = (i * of(roller), j * of(self.outwards * race));
        let (k3, l3) = (k * i2, l * j2);
        let (k5, l5) = (k3 * i2 * of(roller * roller), l3 * j2 * of(race * race));
        let height =
            of(self.roller) * (one - at_roller) * i - of(self.outwards * self.radius) * (one - at_race) * j;
        [height, -(u * (k - l)), of(0.5) * (k3 - l3), -(of(3.0) * u * (k5 - l5))]
    }

    /// The penetration over a piece. `base` is the distance of roller and raceway, positive outside of
    /// rollers, less the shift [m]. `these` are the lanes of interest.
    #[inline(always)]
    fn penetration<N: Number>(&self, seen: &Seen<N>, base: N, sloped: bool, these: u64) -> Parabola<N> {
        let of = |value: f64| base.constant(value);
        let (zero, half) = (of(0.0), of(0.5));
        let Seen { u: [a, b], depth: [depth_a, depth_b], .. } = *seen;
        let middle = a.max(zero).min(b);
        let aside = (zero.bits_below(middle) | middle.bits_below(zero)) & these != 0;
        let curvature = 1.0 / self.roller - self.outwards / self.radius;
        let mut height = of(self.roller - self.outwards * self.radius);
        let (mut q, mut c, mut third, mut per_twice) = (zero, of(0.5 * curvature), zero, of(1.0 / curvature));
        if aside {
            [height, q, c, third] = self.clearance(middle);
            per_twice = half / c;
        }
        let (mut depth, mut grows, mut width) = (depth_a, zero, zero);
        if sloped {
            width = (b - a).max(of(1e-12));
            grows = (depth_b - depth_a) / width;
            depth = grows.times_plus(middle - a, depth_a);
            q = q - grows;
        }
        let (p, ends) = (base + height - depth, [a - middle, b - middle]);
        Parabola { p, q, c, third, per_twice, middle, ends, aside, grows, width }
    }

    /// Adds the overlap with a piece. `across` and `slope` receive what ½ ∫ p² du falls by with the angle of
    /// the roller about the raceway, and by how much less that is a metre of shift.
    #[inline(always)]
    fn add<N: Number>(&self, sum: &mut Penetration<N>, seen: &Seen<N>, base: N, sloped: bool, these: u64) {
        let of = |value: f64| base.constant(value);
        let (zero, one, two, half) = (of(0.0), of(1.0), of(2.0), of(0.5));
        let Seen { u: [a, b], height: [height_a, height_b], .. } = *seen;
        let parabola = self.penetration(seen, base, sloped, these);
        let Parabola { p, q, c, third, per_twice, middle, ends: [left, right], aside, grows, width } =
            parabola;
        let discriminant = q.times_plus(q, of(4.0) * c * p);
        let root = discriminant.max(of(1e-30)).sqrt();
        let (twice, per_root) = (two * c, one / root);
        let (low, high) = ((q - root) * per_twice, (q + root) * per_twice);
        let (from, to) = (low.max(left), high.min(right));
        let length = zero.choose_below(discriminant, (to - from).max(zero), zero);
        let touches = |yes: N| zero.choose_below(length, yes, zero);
        let free = left.choose_below(low, one, zero) + high.choose_below(right, one, zero);
        sum.ends = sum.ends + touches(free * per_root);
        // About the middle of the overlap.
        let (o, h) = (half * (from + to), half * length);
        let (tip, tilt) = (p + o * (q - c * o), q - twice * o);
        let square = h * h;
        let spread = of(1.0 / 3.0) * square;
        let area = length * (tip - c * spread);
        let u = middle + o;
        let (along, moment) = (length * u, length * spread * tilt);
        let flat = square * square * of(0.2);
        let squares = tip.times_plus(tip, (tilt * tilt - two * tip * c).times_plus(spread, c * c * flat));
        sum.area = sum.area + area;
        sum.square = length.times_plus(squares, sum.square);
        sum.length = sum.length + length;
        sum.first = sum.first + along;
        sum.second = along.times_plus(u, length.times_plus(spread, sum.second));
        let top = (q * per_twice).max(from).min(to);
        sum.deepest = sum.deepest.max(touches(p + top * (q - c * top)));
        // Ends of the piece move with the angle by their heights, the depth between them with both, and so
        // does the place about which the parabola lies.
        let (first, last) = ((tip - h * (tilt + c * h)).max(zero), (tip + h * (tilt - c * h)).max(zero));
        let (of_first, of_last) = (first * height_a, last * height_b);
        let mut falls = half * last.times_plus(of_last, -(first * of_first));
        let mut less = of_last - of_first;
        if sloped {
            let share = grows / width;
            let both = share * height_a.times_plus(b, -(height_b * a));
            let of_first = share * (height_b - height_a);
            falls = both.times_plus(area, of_first.times_plus(u.times_plus(area, moment), falls));
            less = both.times_plus(length, of_first.times_plus(along, less));
        }
        if aside {
            let height = zero.choose_below(a, height_a, b.choose_below(zero, height_b, zero));
            let bends = half * third * height;
            let curved = length * square * (of(1.0 / 3.0) * tip - of(0.2) * c * square);
            falls = bends.times_plus(o.times_plus(o.times_plus(area, two * moment), curved), falls);
            less = bends.times_plus(length * o.times_plus(o, spread), less);
        }
        sum.across = sum.across + falls;
        sum.slope = sum.slope + less;
    }
}

impl<N: Number> Seen<N> {
    #[inline(always)]
    fn of(ends: [[N; 2]; 2], depth: [N; 2], [dx, dy]: [N; 2]) -> Self {
        let [[ax, ay], [bx, by]] = ends;
        let (across_a, across_b) = (dx.times_plus(ay, -(dy * ax)), dx.times_plus(by, -(dy * bx)));
        let (along_a, along_b) = (dx.times_plus(ax, dy * ay), dx.times_plus(bx, dy * by));
        Self { u: [across_a, across_b], height: [along_a, along_b], depth }
    }
}

/// Of (1 − x)^(−½), from the eighth power of x down.
const SERIES: [f64; 9] = [
    6435.0 / 32768.0,
    429.0 / 2048.0,
    231.0 / 1024.0,
    63.0 / 256.0,
    35.0 / 128.0,
    5.0 / 16.0,
    3.0 / 8.0,
    0.5,
    1.0,
];

/// One over the cosine of an angle, from the square of its sine.
#[inline(always)]
fn inverse_cosine<N: Number>(square: N) -> N {
    let of = |value: f64| square.constant(value);
    let one = of(1.0);
    let mut sum = of(12155.0 / 65536.0);
    for next in SERIES {
        sum = sum.times_plus(square, of(next));
    }
    // The series is off by 4·10⁻⁹ there. Each lane chooses for itself, whatever lies beside it.
    let far = of(0.15);
    if far.bits_below(square) == 0 {
        return sum;
    }
    far.choose_below(square, one / (one - square).max(of(1e-4)).sqrt(), sum)
}

impl Part {
    #[inline(always)]
    fn seen<S: Simd>(&self, simd: S, at: usize, d: [Vector<S>; 2]) -> Seen<Vector<S>> {
        let ends = [load(simd, &self.ends[0], at), load(simd, &self.ends[1], at)];
        Seen::of(ends, load(simd, &self.depth, at), d)
    }
}

impl RoundParts {
    /// ∫ p du [m²] and the length [m] of overlaps that are pressed back by `shift` [m].
    #[inline(always)]
    pub(crate) fn area<S: Simd>(&self, simd: S, at: usize, shift: Vector<S>) -> [Vector<S>; 2] {
        let of = |value: f64| Vector::all(simd, value);
        let (zero, half, twelfth) = (of(0.0), of(0.5), of(1.0 / 12.0));
        let (mut area, mut whole) = (zero, zero);
        for part in &self.parts[..self.count] {
            let [p, q, c, per_twice, left, right] = &part.curve;
            let (p, q) = (Vector::load(simd, p, at) - shift, Vector::load(simd, q, at));
            let (c, per_twice) = (Vector::load(simd, c, at), Vector::load(simd, per_twice, at));
            let (left, right) = (Vector::load(simd, left, at), Vector::load(simd, right, at));
            let root = q.times_plus(q, of(4.0) * c * p).max(zero).sqrt();
            let from = ((q - root) * per_twice).max(left);
            let to = ((q + root) * per_twice).min(right);
            let length = (to - from).max(zero);
            let middle = half * (from + to);
            let tip = middle.times_plus(q - c * middle, p) - c * length * length * twelfth;
            area = length.times_plus(tip, area);
            whole = whole + length;
        }
        [area, whole]
    }

    /// Has all of them listed anew in the next step: how far they are known beyond a contact depends on when
    /// they were listed, and counts where a contact grows farther than the force to start from says.
    pub(crate) fn forget(&mut self) {
        self.fences = Default::default();
    }

    /// Rollers whose contacts may reach beyond their pieces, a bit for each.
    #[inline(always)]
    fn stale<S: Simd>(&self, simd: S, contacts: &Contacts<'_>) -> u64 {
        let mut stale = 0;
        for at in vector_starts(simd) {
            let [dx, dy] = load(simd, contacts.d, at);
            let reach = Vector::all(simd, MARGIN) * Vector::load(simd, contacts.reach, at);
            let [[ax, ay], [bx, by]] = [load(simd, &self.fences[0], at), load(simd, &self.fences[1], at)];
            let (first, last) = (dx.times_plus(ay, -(dy * ax)), dx.times_plus(by, -(dy * bx)));
            stale |= ((-reach).bits_below(first) | last.bits_below(reach)) << at;
        }
        stale
    }

    /// Lists the pieces under one roller, with what is gone of ragged edges for it.
    #[inline(never)]
    fn list(&mut self, relief: &Relief, facet: usize, lane: usize, d: [f64; 2], [reach, ragged]: [f64; 2]) {
        let bit = 1 << lane;
        let mut count = 0;
        for piece in relief.under(facet, d, reach) {
            let [from, to] = [0, 1].map(|end| piece.depth[end] + if piece.edge[end] { ragged } else { 0.0 });
            let begins = count == 0 || from != to || {
                let before = &self.parts[count - 1];
                let apart = of_one(&before.ends[1], lane) != piece.ends[0];
                apart || before.sloped & bit != 0 || (before.depth[1][lane] - from).abs() > ONE_DEPTH
            };
            if begins {
                if count == self.parts.len() {
                    self.parts.push(Part::default());
                }
                let part = &mut self.parts[count];
                (part.ends[0][0][lane], part.ends[0][1][lane]) = (piece.ends[0][0], piece.ends[0][1]);
                (part.depth[0][lane], part.depth[1][lane]) = (from, to);
                part.sloped = (part.sloped & !bit) | if from != to { bit } else { 0 };
                if count == 0 {
                    (self.fences[0][0][lane], self.fences[0][1][lane]) = (piece.ends[0][0], piece.ends[0][1]);
                }
                count += 1;
            }
            // A level piece goes on with the one before.
            let part = &mut self.parts[count - 1];
            (part.ends[1][0][lane], part.ends[1][1][lane]) = (piece.ends[1][0], piece.ends[1][1]);
            (self.fences[1][0][lane], self.fences[1][1][lane]) = (piece.ends[1][0], piece.ends[1][1]);
        }
        self.counts[lane] = count;
        for part in &mut self.parts[count..] {
            for c in 0..2 {
                (part.ends[c][0][lane], part.ends[c][1][lane]) = (0.0, 0.0);
                part.depth[c][lane] = 0.0;
            }
            part.sloped &= !bit;
        }
    }
}

/// Fits of a circle, each without what stands off the one before.
const FITS: usize = 6;

/// Centre [m] and radius [m] of the circle that most vertices of an outline lie on: least squares without
/// those that stand off by more than three times the median. `radius` is near to its own.
pub(crate) fn circle_of(outline: &Outline, radius: f64) -> ([f64; 2], f64) {
    let (mut centre, mut found) = ([0.0; 2], radius);
    let mut within = f64::INFINITY;
    for _ in 0..FITS {
        // x² + y² = 2 x cx + 2 y cy + r² − c², in units of the radius.
        let (mut matrix, mut right) = ([0.0; 9], [0.0; 3]);
        for (x, y) in outline.x.iter().zip(&outline.y) {
            if (libm::hypot(x - centre[0], y - centre[1]) - found).abs() > within {
                continue;
            }
            let [x, y] = [x / radius, y / radius];
            let row = [2.0 * x, 2.0 * y, 1.0];
            for (i, of) in row.iter().enumerate() {
                row.iter().enumerate().for_each(|(j, other)| matrix[3 * i + j] += of * other);
                right[i] += of * (x * x + y * y);
            }
        }
        let solved = dense::solve(&matrix, &right);
        centre = [radius * solved[0], radius * solved[1]];
        found = radius * (solved[2] + solved[0] * solved[0] + solved[1] * solved[1]).sqrt();
        let off = |(x, y): (&f64, &f64)| (libm::hypot(x - centre[0], y - centre[1]) - found).abs();
        let mut all: Vec<f64> = outline.x.iter().zip(&outline.y).map(off).collect();
        all.sort_by(f64::total_cmp);
        within = 3.0 * all[all.len() / 2] + ONE_DEPTH;
    }
    (centre, found)
}

#[cfg(test)]
mod tests {
    use pulp::{Arch, Scalar, WithSimd};

    use super::*;
    use crate::contact::{
        eight_facets::EightFacets,
        outline::View,
        penetration::{Pair, Sides},
    };

    const ROLLER: f64 = 3.97e-3;
    const OUTER: f64 = 23.5e-3;
    const INNER: f64 = 15.55e-3;

    /// A raceway as it is meshed, of a depth over the angle below a circle [m] and of another one between two
    /// walls.
    fn outline(radius: f64, facets: usize, depth: impl Fn(f64) -> f64, spall: f64) -> Outline {
        let mut vertices = Vec::new();
        let mut before = 0.0;
        for i in 0..facets {
            let angle = std::f64::consts::TAU * i as f64 / facets as f64;
            let (s, c) = angle.sin_cos();
            let here = if (1.0..1.05).contains(&angle) { spall } else { 0.0 };
            if here != before {
                let r = radius + depth(angle) + before;
                vertices.push([r * c, r * s]);
            }
            before = here;
            let r = radius + depth(angle) + here;
            vertices.push([r * c, r * s]);
        }
        Outline::new(&vertices)
    }

    /// Two waves and a spall, whose height is `wave` and depth `spall` [m], signed.
    fn worn(radius: f64, along: bool, wave: f64, spall: f64) -> (Outline, Relief) {
        let depth = |angle: f64| wave * (37.0 * angle).sin() + 0.3 * wave * (101.0 * angle).cos();
        let outline = outline(radius, 660, depth, spall);
        let relief = Relief::new(&outline, radius, ROLLER, along, false);
        (outline, relief)
    }

    /// The overlap of a roller at an angle and a distance from the centre [m], with the direction to it.
    fn at(outline: &Outline, relief: &Relief, angle: f64, distance: f64) -> ([f64; 2], usize, Penetration) {
        let (s, c) = angle.sin_cos();
        let d = [relief.outwards * c, relief.outwards * s];
        let hint = (angle / std::f64::consts::TAU * outline.len() as f64) as usize;
        let facet = outline.facet_along([distance * c, distance * s], d, hint, relief.outwards);
        (d, facet, relief.overlap(facet, d, distance, 0.0, 0.8e-3))
    }

    /// A circle in and on a circle: the penetration is δ − u²/2R over the relative radius R but for the
    /// fourth power of u, and nothing pushes along the path. Source: own, plane geometry.
    #[test]
    fn by_hand_a_round_roller_sinks_into_a_round_raceway() {
        for (radius, along, relative) in [
            (OUTER, true, 1.0 / (1.0 / ROLLER - 1.0 / OUTER)),
            (INNER, false, 1.0 / (1.0 / ROLLER + 1.0 / INNER)),
        ] {
            let outline = outline(radius, 660, |_| 0.0, 0.0);
            let relief = Relief::new(&outline, radius, ROLLER, along, false);
            assert!(relief.pieces.len() < 8, "as many as a circle takes: {}", relief.pieces.len());
            for (angle, depth) in [(0.3, 1e-6), (1.7, 5e-6), (5.0, 12e-6)] {
                let distance = radius - relief.outwards * (ROLLER - depth);
                let (_, _, found) = at(&outline, &relief, angle, distance);
                let half = (2.0 * relative * depth).sqrt();
                let close = |found: f64, by_hand: f64| (found / by_hand - 1.0).abs() < 1e-9;
                assert!(close(found.area, 4.0 / 3.0 * depth * half), "{found:?}");
                assert!(close(found.square, 16.0 / 15.0 * depth * depth * half), "{found:?}");
                assert!(close(found.length, 2.0 * half), "{found:?}");
                assert!(close(found.second, 2.0 / 3.0 * half.powi(3)), "{found:?}");
                assert!(close(found.ends, 2.0 * relative / half), "{found:?}");
                assert!(close(found.deepest, depth), "{found:?}");
                assert!(found.across.abs() < 1e-12 * found.area, "{found:?}");
                assert!(found.first.abs() < 1e-9 * half * half, "{found:?}");
            }
        }
    }

    /// Force and energy: ½ ∫ p² du falls along the path and across it by `across` and `area`, over waves, at
    /// the edge of a spall and between two edges. Source: own, the force of a spring is the slope of its
    /// energy.
    #[test]
    fn analytic_forces_of_round_rollers_are_slopes_of_the_energy() {
        for (radius, along) in [(OUTER, true), (INNER, false)] {
            let outwards = if along { 1.0 } else { -1.0 };
            let (outline, relief) = worn(radius, along, 0.4e-6, outwards * 8e-6);
            let mut most = 0.0_f64;
            for n in 0..400 {
                let angle = 0.93 + 0.2 * f64::from(n) / 400.0;
                let distance = radius - outwards * (ROLLER - 9e-6);
                let energy =
                    |angle: f64, distance: f64| 0.5 * at(&outline, &relief, angle, distance).2.square;
                let (_, _, found) = at(&outline, &relief, angle, distance);
                let step = 1e-10;
                let deeper =
                    energy(angle, distance + outwards * step) - energy(angle, distance - outwards * step);
                let force = deeper / (2.0 * step);
                assert!((force / found.area - 1.0).abs() < 1e-5, "{angle}: {force} and {}", found.area);
                let turn = 1e-7;
                let gained = energy(angle + turn, distance) - energy(angle - turn, distance);
                // t points along the path at the outer raceway, and against it at the inner one.
                let push = -gained / (2.0 * turn * distance) * outwards;
                let off = (push - found.across).abs();
                assert!(off < 1e-5 * found.area, "{angle}: {push} and {}", found.across);
                most = most.max(found.across.abs() / found.area);
            }
            assert!(most > 1e-2, "edges push rollers along: {most}");
        }
    }

    /// Beside the general integration, which sees the roller as arcs on 112 facets of its own: parabolas on
    /// these and about the nearest places of pieces are both some nanometres from the circle.
    #[test]
    fn behaves_round_rollers_press_as_arcs_on_facets_do() {
        let rim = outline(ROLLER, 112, |_| 0.0, 0.0);
        for (radius, along) in [(OUTER, true), (INNER, false)] {
            let outwards = if along { 1.0 } else { -1.0 };
            let (outline, relief) = worn(radius, along, 0.2e-6, outwards * 50e-6);
            let [curvature, race] = [1.0 / ROLLER, outwards / radius];
            let sides = Sides { along, bulge: 0.5 * (curvature - race), curvature };
            let mut touched = 0;
            for n in 0..300 {
                let angle = 0.9 + 0.25 * f64::from(n) / 300.0;
                let distance = radius - outwards * (ROLLER - 12e-6);
                let (d, facet, found) = at(&outline, &relief, angle, distance);
                let centre = [outwards * distance * d[0], outwards * distance * d[1]];
                let own = rim.facet_along([0.0; 2], d, 0, 1.0);
                let roller = View { outline: &rim, from: [0.0; 2], d, facet: own };
                let raceway = View { outline: &outline, from: centre, d, facet };
                let mut eights = [EightFacets::default(); 2];
                let pair = Pair::new(Scalar::new(), roller, raceway, sides, &mut eights);
                let general = pair.penetration(0.0, 0.45e-3);
                if general.area == 0.0 {
                    // Between the edges of the spall, and clear of its floor.
                    assert!(found.area < 1e-4 * 1e-8, "{angle}: {found:?}");
                    continue;
                }
                touched += 1;
                // A parabola leaves u⁴/8R³ of a circle, 27 nm at the end of a contact 12 µm deep, and a fifth
                // of it in the mean; arcs on facets leave 1 nm.
                let [end, depth] = [3e-8, 1e-8];
                let off = [
                    (found.area - general.area) / (depth * general.length),
                    (found.square - general.square) / (2.0 * depth * general.area),
                    (found.length - general.length) / (end * general.ends),
                ];
                assert!(off.iter().all(|off| off.abs() < 1.0), "{angle}: {off:?}");
            }
            assert!(touched > 200, "{touched} places with contact");
        }
    }

    /// Eight rollers side by side over a worn raceway, and each alone.
    struct SideBySide;

    impl WithSimd for SideBySide {
        type Output = ();

        #[inline(always)]
        fn with_simd<S: Simd>(self, simd: S) {
            let (outline, relief) = worn(OUTER, true, 0.4e-6, 8e-6);
            let mut pieces = RoundParts::default();
            for n in 0..500 {
                let (mut d, mut distance, mut reach) =
                    (Rows::default(), Row::default(), Row([0.5e-3; LANES]));
                let angle = |lane: usize| 0.9 + 0.02 * lane as f64 + 4e-4 * f64::from(n);
                for lane in 0..LANES {
                    (d[1][lane], d[0][lane]) = angle(lane).sin_cos();
                    distance[lane] = OUTER - ROLLER + 2e-6 * lane as f64 - 1e-6;
                    reach[lane] *= 1.0 + 0.01 * f64::from(n % 7);
                }
                let facet = |lane: usize| at(&outline, &relief, angle(lane), distance[lane]).1;
                let (ragged, these) = (Row::default(), 0xff);
                let contacts = Contacts { d: &d, distance: &distance, reach: &reach, ragged: &ragged, these };
                relief.look(simd, &contacts, &mut pieces, facet);
                let mut found = Penetration::<Row>::default();
                let mut areas = Rows::default();
                for start in vector_starts(simd) {
                    let shift = Vector::all(simd, 0.0);
                    relief.overlaps(simd, start, &contacts, &pieces, shift).store(&mut found, start);
                    let [area, length] = pieces.area(simd, start, shift);
                    area.store(&mut areas[0], start);
                    length.store(&mut areas[1], start);
                }
                for lane in 0..LANES {
                    let alone = at(&outline, &relief, angle(lane), distance[lane]).2;
                    let size = alone.area.max(1e-12);
                    let off = [
                        (found.area[lane] - alone.area) / size,
                        (areas[0][lane] - alone.area) / size,
                        (found.across[lane] - alone.across) / size,
                        (found.length[lane] - alone.length) / 1e-4,
                        (areas[1][lane] - alone.length) / 1e-4,
                        (found.square[lane] - alone.square) / (size * 1e-6),
                        (found.slope[lane] - alone.slope) / 1e-6,
                    ];
                    assert!(off.iter().all(|off| off.abs() < 1e-8), "{n} {lane}: {off:?}");
                }
            }
        }
    }

    /// One over the cosine in each lane, whatever lies beside it: vectors of any width give the same.
    struct EachForItself;

    impl WithSimd for EachForItself {
        type Output = ();

        #[inline(always)]
        fn with_simd<S: Simd>(self, simd: S) {
            let squares = Row([0.0, 0.01, 0.1, 0.149, 0.151, 0.3, 0.9, 0.05]);
            for at in vector_starts(simd) {
                let mut found = Row::default();
                inverse_cosine(Vector::<S>::load(simd, &squares, at)).store(&mut found, at);
                for lane in at..at + Vector::<S>::LEN {
                    let square = squares[lane];
                    let mut alone = Row::default();
                    inverse_cosine(Vector::all(simd, square)).store(&mut alone, at);
                    assert_eq!(found[lane].to_bits(), alone[at].to_bits(), "{square}");
                    assert!((found[lane] * (1.0 - square).sqrt() - 1.0).abs() < 5e-9, "{square}");
                }
            }
        }
    }

    #[test]
    fn issue_a_roller_beside_another_rounds_as_alone() {
        Arch::new().dispatch(EachForItself);
    }

    #[test]
    fn invariant_overlaps_of_eight_rollers_are_those_of_one() {
        Arch::new().dispatch(SideBySide);
        SideBySide.with_simd(Scalar::new());
    }

    /// A circle beside the origin with a spall, as a ring that its load has moved.
    #[test]
    fn by_hand_the_circle_of_a_raceway_is_found_beside_its_defects() {
        let shifted = outline(OUTER, 660, |_| 0.0, 1e-4).about([4e-6, -25e-6]);
        let ([x, y], radius) = circle_of(&shifted, OUTER);
        assert!((x + 4e-6).hypot(y - 25e-6) < 1e-15 && (radius - OUTER).abs() < 1e-15, "{x} {y} {radius}");
    }
}
