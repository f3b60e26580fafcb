//! Projection of a point onto a surface, and the signed gap (THEORY §4.1, §4.4).

use pulp::Simd;

use crate::{
    row::{Outcome, Row},
    shape::{Poly, Push, Shape, Side, Spot},
    smooth::{Rise, height, slope},
    spline::Patch,
    spline_row::Feet,
    surface::Surface,
    touch_row::{Law, Work},
};

/// Where a point projects.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Projection {
    /// Gap [m]. Positive when apart, negative when penetrating: the signed distance to a polyline, or the height above
    /// the curve of a smooth surface.
    pub gap: f64,
    /// Gradient of the gap with respect to the point: the outward normal of the primary surface.
    pub normal: [f64; 2],
    /// Facet of the primary surface.
    pub facet: usize,
    /// Place on the facet, 0 at its first node, 1 at its second.
    pub place: f64,
    /// How the gap falls as the facet's polynomial turns: −∂gap/∂(n·c′) [-].
    pub(crate) turn: f64,
    /// Height of the foot above the polynomial [m].
    pub(crate) height: f64,
    /// Unit normal of the polynomial there.
    pub(crate) curve_normal: [f64; 2],
    /// One over the length of its derivative [1/m].
    pub(crate) inverse: f64,
}

/// A point at the distance d from a facet is compared with the neighbour where it stands closer to an end than this
/// times d: the line that halves the angle at a joint leans by half the turn there, at most 0.175 at what is no corner.
pub(crate) const NEAR_END: f64 = 0.25;

/// Walks at most this many facets from the starting one.
const LONGEST_WALK: usize = 8;

/// A facet in present positions, its chord as polynomial.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Frame {
    pub(crate) facet: usize,
    /// Slots of its ends.
    pub(crate) ends: (usize, usize),
    /// Its first node [m].
    pub(crate) origin: [f64; 2],
    /// From its first node to its second [m].
    pub(crate) along: [f64; 2],
    /// One over its length [1/m].
    pub(crate) inverse: f64,
    /// Unit normal of the chord, outwards.
    pub(crate) normal: [f64; 2],
    rise: Rise,
}

impl Shape for Frame {
    type Coefficients = Poly<2>;

    #[inline(always)]
    fn new(surface: &Surface, x: &[f64], y: &[f64], facet: usize) -> Self {
        let (a, b) = surface.ends(facet);
        let along = [x[b] - x[a], y[b] - y[a]];
        let inverse = 1.0 / (along[0] * along[0] + along[1] * along[1]).sqrt();
        Self {
            facet,
            ends: (a, b),
            origin: [x[a], y[a]],
            along,
            inverse,
            normal: [along[1] * inverse, -along[0] * inverse],
            rise: surface.rise[facet],
        }
    }

    #[inline(always)]
    fn facet(&self) -> usize {
        self.facet
    }

    #[inline(always)]
    fn touch_row<V: Simd, const MEMORY: bool>(
        simd: V,
        row: Row<'_>,
        _own: &mut Option<Side<Self>>,
        _feet: &mut Feet<V>,
        law: &Law<V>,
        work: &mut Work<V>,
        push: &mut Vec<Push>,
    ) -> Outcome {
        row.touch::<V, MEMORY>(simd, law, work, push)
    }

    #[inline(always)]
    fn spot(&self, place: f64, height: f64) -> Spot {
        let Self { origin: [ax, ay], along: [tx, ty], normal, inverse, .. } = *self;
        let at = [ax + place * tx + height * normal[0], ay + place * ty + height * normal[1]];
        Spot { at, place, height, normal, inverse }
    }

    #[inline(always)]
    fn project(&mut self, surface: &Surface, x: &[f64], y: &[f64], p: [f64; 2]) -> Option<Projection> {
        let to = self.above(p, self.place(p));
        if !surface.beside_corner[self.facet] && self.holds(&to) {
            return Some(to);
        }
        walk(surface, x, y, p, self)
    }

    #[inline(always)]
    fn holds(&self, to: &Projection) -> bool {
        let margin = NEAR_END * to.gap.abs() * self.inverse;
        to.place > margin && to.place < 1.0 - margin
    }

    #[inline(always)]
    fn foot(&mut self, p: [f64; 2]) -> Foot {
        let place = self.place(p);
        let to = self.above(p, place);
        if (0.0..=1.0).contains(&place) {
            return Foot { to, distance: to.gap.abs(), inside: true };
        }
        let end = if place < 0.0 { 0.0 } else { 1.0 };
        let dx = p[0] - self.origin[0] - end * self.along[0];
        let dy = p[1] - self.origin[1] - end * self.along[1];
        Foot { to, distance: (dx * dx + dy * dy).sqrt(), inside: false }
    }

    /// Beyond the line that halves the angle between the two chords.
    fn is_past(&self, _to: &Projection, other: &Self, forward: bool, p: [f64; 2]) -> bool {
        let vertex = if forward { other.origin } else { self.origin };
        let t = [0, 1].map(|k| self.along[k] * self.inverse + other.along[k] * other.inverse);
        let along = (p[0] - vertex[0]) * t[0] + (p[1] - vertex[1]) * t[1];
        if forward { along > 0.0 } else { along < 0.0 }
    }

    #[inline(always)]
    fn gather(&self, _surface: &Surface, x: &[f64], y: &[f64]) -> Poly<2> {
        let (a, b) = self.ends;
        Poly([[x[a], y[a]], [x[b] - x[a], y[b] - y[a]]])
    }

    #[inline(always)]
    fn scatter(&self, _surface: &Surface, forces: &Poly<2>, push: &mut Vec<Push>) {
        let Poly([all, second]) = *forces;
        push.push((self.ends.0 as u32, [all[0] - second[0], all[1] - second[1]]));
        push.push((self.ends.1 as u32, second));
    }
}

impl Frame {
    /// Place on the chord below `p`.
    #[inline(always)]
    fn place(&self, p: [f64; 2]) -> f64 {
        let r = [p[0] - self.origin[0], p[1] - self.origin[1]];
        (r[0] * self.along[0] + r[1] * self.along[1]) * (self.inverse * self.inverse)
    }

    /// Projection of `p` on the facet's curve, which goes on beyond its ends.
    #[inline(always)]
    fn above(&self, p: [f64; 2], place: f64) -> Projection {
        let Self { facet, origin, along: [tx, ty], inverse, normal: [nx, ny], rise, .. } = *self;
        let off = (p[0] - origin[0]) * nx + (p[1] - origin[1]) * ny;
        let (h, dh) = (height(rise, place), slope(rise, place));
        let square = inverse * inverse;
        // The chord's tangent falls with the curve's slope.
        let fall = dh * square;
        let normal = [nx - fall * tx, ny - fall * ty];
        Projection {
            gap: off - h,
            normal,
            facet,
            place,
            turn: dh * off * square,
            height: h,
            curve_normal: [nx, ny],
            inverse,
        }
    }
}

/// Projects `p` onto `surface`, starting the walk at `facet`. `None` beyond the ends of an open surface.
pub fn project(surface: &Surface, x: &[f64], y: &[f64], p: [f64; 2], facet: usize) -> Option<Projection> {
    if surface.spline.is_some() {
        Patch::new(surface, x, y, facet).project(surface, x, y, p)
    } else {
        Frame::new(surface, x, y, facet).project(surface, x, y, p)
    }
}

/// The nearest point of one facet.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Foot {
    pub(crate) to: Projection,
    /// Unsigned distance [m].
    pub(crate) distance: f64,
    /// False when the nearest point is an end.
    pub(crate) inside: bool,
}

#[inline(never)]
pub(crate) fn walk<S: Shape>(
    surface: &Surface,
    x: &[f64],
    y: &[f64],
    p: [f64; 2],
    frame: &mut S,
) -> Option<Projection> {
    let mut best = frame.foot(p);
    for _ in 0..LONGEST_WALK {
        let at = frame.facet();
        if !surface.beside_corner[at] && frame.holds(&best.to) {
            break;
        }
        let mut nearer = *frame;
        for forward in [false, true] {
            let Some(next) = surface.neighbour(at, forward) else { continue };
            let smooth = surface.smooth[if forward { surface.second(at) } else { at }];
            if smooth && best.to.facet != at {
                continue;
            }
            let mut other = S::new(surface, x, y, next);
            let foot = other.foot(p);
            let better = if smooth {
                frame.is_past(&best.to, &other, forward, p)
            } else {
                // A foot inside a facet wins a tie against the vertex that both share.
                foot.distance < best.distance
                    || (foot.distance == best.distance && foot.inside && !best.inside)
            };
            if better {
                (best, nearer) = (foot, other);
            }
        }
        if nearer.facet() == at {
            break;
        }
        *frame = nearer;
    }
    if best.inside {
        return Some(best.to);
    }
    let forward = best.to.place > 1.0;
    let vertex = if forward { surface.second(frame.facet()) } else { frame.facet() };
    if surface.smooth[vertex] {
        // Curves that join without a kink leave no wedge: either goes on a little beyond its end.
        return Some(best.to);
    }
    at_vertex(surface, x, y, p, &Frame::new(surface, x, y, frame.facet()), forward)
}

/// The nearest point is a vertex: the gap is the distance to it, its sign that of the normals around it.
fn at_vertex(
    surface: &Surface,
    x: &[f64],
    y: &[f64],
    p: [f64; 2],
    frame: &Frame,
    forward: bool,
) -> Option<Projection> {
    let other = surface.neighbour(frame.facet, forward)?;
    let second = Frame::new(surface, x, y, other);
    let vertex = if forward { frame.ends.1 } else { frame.ends.0 };
    let r = [p[0] - x[vertex], p[1] - y[vertex]];
    let distance = (r[0] * r[0] + r[1] * r[1]).sqrt();
    let mean = [frame.normal[0] + second.normal[0], frame.normal[1] + second.normal[1]];
    let sign = if r[0] * mean[0] + r[1] * mean[1] < 0.0 { -1.0 } else { 1.0 };
    let normal = if distance > 0.0 { [sign * r[0] / distance, sign * r[1] / distance] } else { frame.normal };
    let place = if forward { 1.0 } else { 0.0 };
    Some(Projection { gap: sign * distance, normal, place, turn: 0.0, height: 0.0, ..frame.above(p, place) })
}
