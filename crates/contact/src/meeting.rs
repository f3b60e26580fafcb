//! Points of chords against chords, a vector of them at a time.
//!
//! On chords everything is linear in the place of a point, so all points take the same few operations, whether they lie
//! on one facet ([`row`](crate::row)) or on many ([`band`](crate::band)). The loop over single points in
//! [`evaluation`](crate::evaluation) does the same for what is left over; a test holds the two together.

use pulp::Simd;
use stribeck_simd::lanes::{LANES, Number, Vector};
use stribeck_solver::state::Moment;

use crate::{
    patch_row::pick,
    projection::NEAR_END,
    touch_row::{Acts, Law, Touching, Work},
};

/// Numbers of the moment that belong to one chord: the x, y, v_x, v_y of its first node and of its second.
pub(crate) type Ends = [f64; 8];

/// Reads them.
#[inline(always)]
pub(crate) fn ends(at: &Moment<'_>, (a, b): (usize, usize)) -> Ends {
    [at.x[a], at.y[a], at.vx[a], at.vy[a], at.x[b], at.y[b], at.vx[b], at.vy[b]]
}

/// A chord in motion: its first node and how much the second is beyond it.
#[derive(Clone, Copy)]
pub(crate) struct Chord<V: Simd> {
    position: [[Vector<V>; 2]; 2],
    velocity: [[Vector<V>; 2]; 2],
}

/// Pairs of chords that meet; lane by lane, or the same in all lanes.
#[derive(Clone, Copy)]
pub(crate) struct Meeting<V: Simd> {
    /// Point of place 0 relative to the other chord's first node [m], and how it changes to place 1.
    from: [[Vector<V>; 2]; 2],
    /// The other chord over its squared length [1/m], and its normal.
    other: [Vector<V>; 2],
    normal: [Vector<V>; 2],
    inverse: Vector<V>,
    /// Velocities at place 0 and their change to place 1 [m/s].
    own_motion: [[Vector<V>; 2]; 2],
    other_motion: [[Vector<V>; 2]; 2],
}

/// Points that may touch: 1 in `open` where they do.
#[derive(Clone, Copy)]
pub(crate) struct Spots<V: Simd> {
    pub(crate) open: Vector<V>,
    pub(crate) place: Vector<V>,
    /// Length of surface that a point stands for [m].
    pub(crate) weight: Vector<V>,
    pub(crate) slip: Vector<V>,
    pub(crate) damping: Vector<V>,
}

/// What acts between them.
pub(crate) struct Acting<V: Simd> {
    pub(crate) acts: Acts<V>,
    /// Force on each point [N]; zero where it does not touch.
    pub(crate) force: [Vector<V>; 2],
    /// Place on the other chord; zero likewise.
    pub(crate) foot: Vector<V>,
}

impl<V: Simd> Chord<V> {
    /// A chord in each lane.
    #[inline(always)]
    pub(crate) fn each(simd: V, at: &Moment<'_>, chords: &Joined) -> Self {
        let [[ax, bx], [ay, by]] = [both(simd, at.x, chords), both(simd, at.y, chords)];
        let [[au, bu], [av, bv]] = [both(simd, at.vx, chords), both(simd, at.vy, chords)];
        Self { position: [[ax, ay], [bx - ax, by - ay]], velocity: [[au, av], [bu - au, bv - av]] }
    }
}

/// A chord in each lane, by the slots of its ends.
#[derive(Clone, Copy)]
pub(crate) struct Joined {
    pub(crate) ends: [[u32; LANES]; 2],
    pub(crate) joints: Joints,
}

/// How chords in neighbouring lanes hang together.
#[derive(Clone, Copy)]
pub(crate) enum Joints {
    /// Each begins where the one in the lane before ends.
    Ahead {
        /// And their nodes lie in this order in memory, without a gap.
        in_a_row: bool,
    },
    /// Each ends where the one in the lane before begins.
    Back,
    None,
}

impl Joined {
    /// From the slots of each chord's ends, in so many lanes. They are compared one after the other: whole vectors would wait
    /// for slots that are on their way to memory.
    #[inline(always)]
    pub(crate) fn new(lanes: usize, mut ends_of: impl FnMut(usize) -> [u32; 2]) -> Self {
        let mut ends = [[0; LANES]; 2];
        let (mut ahead, mut back, mut in_a_row) = (true, true, true);
        let mut before = [0; 2];
        for l in 0..lanes {
            let [a, b] = ends_of(l);
            (ends[0][l], ends[1][l]) = (a, b);
            in_a_row &= b == a + 1;
            if l > 0 {
                ahead &= a == before[1];
                back &= b == before[0];
            }
            before = [a, b];
        }
        let joints = match () {
            () if ahead => Joints::Ahead { in_a_row },
            () if back => Joints::Back,
            () => Joints::None,
        };
        Self { ends, joints }
    }
}

/// A number of a field at both ends of each chord; what two chords share is read once.
#[inline(always)]
fn both<V: Simd>(simd: V, field: &[f64], Joined { ends: [a, b], joints }: &Joined) -> [Vector<V>; 2] {
    let before = |first: u32| Vector::all(simd, field[first as usize]);
    match joints {
        Joints::Ahead { in_a_row: true } => {
            let first = a[0] as usize;
            [Vector::load(simd, field, first), Vector::load(simd, field, first + 1)]
        }
        Joints::Ahead { .. } => {
            let ends = gather(simd, field, b);
            [ends.shifted_in(before(a[0])), ends]
        }
        Joints::Back => {
            let begins = gather(simd, field, a);
            [begins, begins.shifted_in(before(b[0]))]
        }
        Joints::None => [gather(simd, field, a), gather(simd, field, b)],
    }
}

/// A number of a field in each lane.
#[inline(always)]
pub(crate) fn gather<V: Simd>(simd: V, field: &[f64], at: &[u32; LANES]) -> Vector<V> {
    // Spelled out, so that it stays in registers.
    let [a, b, c, d, e, f, g, h] = *at;
    let n = |at: u32| field[at as usize];
    Vector::load(simd, &[n(a), n(b), n(c), n(d), n(e), n(f), n(g), n(h)], 0)
}

impl<V: Simd> Meeting<V> {
    /// The same two chords in all lanes: one root and one division instead of one a lane, which take five times as long.
    #[inline(always)]
    pub(crate) fn all(simd: V, own: &Ends, other: &Ends) -> Self {
        let (tx, ty) = (other[4] - other[0], other[5] - other[1]);
        let inverse = 1.0 / (tx * tx + ty * ty).sqrt();
        let squared = inverse * inverse;
        let pair = |x: f64, y: f64| [Vector::all(simd, x), Vector::all(simd, y)];
        let motion = |e: &Ends| [pair(e[2], e[3]), pair(e[6] - e[2], e[7] - e[3])];
        Self {
            from: [pair(own[0] - other[0], own[1] - other[1]), pair(own[4] - own[0], own[5] - own[1])],
            other: pair(tx * squared, ty * squared),
            normal: pair(ty * inverse, -tx * inverse),
            inverse: Vector::all(simd, inverse),
            own_motion: motion(own),
            other_motion: motion(other),
        }
    }

    #[inline(always)]
    pub(crate) fn new(own: &Chord<V>, other: &Chord<V>) -> Self {
        let [start, [tx, ty]] = other.position;
        let [first, along] = own.position;
        let square = tx.times_plus(tx, ty * ty);
        let inverse = tx.constant(1.0) / square.sqrt();
        let squared = inverse * inverse;
        Self {
            from: [[first[0] - start[0], first[1] - start[1]], along],
            other: [tx * squared, ty * squared],
            normal: [ty * inverse, -(tx * inverse)],
            inverse,
            own_motion: own.velocity,
            other_motion: other.velocity,
        }
    }

    /// `yes` in the lanes that are one, `no` in those that are zero.
    #[inline(always)]
    pub(crate) fn chosen(lanes: Vector<V>, yes: &Self, no: &Self) -> Self {
        Self {
            from: [pick(lanes, yes.from[0], no.from[0]), no.from[1]],
            other: pick(lanes, yes.other, no.other),
            normal: pick(lanes, yes.normal, no.normal),
            inverse: lanes.constant(0.0).choose_below(lanes, yes.inverse, no.inverse),
            own_motion: no.own_motion,
            other_motion: [
                pick(lanes, yes.other_motion[0], no.other_motion[0]),
                pick(lanes, yes.other_motion[1], no.other_motion[1]),
            ],
        }
    }

    /// One where points at these places have their feet beyond the other chord, behind its end or before its beginning.
    #[inline(always)]
    pub(crate) fn beyond(&self, s: Vector<V>, end: bool) -> Vector<V> {
        let (zero, one) = (s.constant(0.0), s.constant(1.0));
        let r = along(&self.from, s);
        let foot = r[0].times_plus(self.other[0], r[1] * self.other[1]);
        if end { one.choose_below(foot, one, zero) } else { foot.choose_below(zero, one, zero) }
    }

    /// What acts on a vector of points, and its energies; without `MEMORY` the penalty alone.
    #[inline(always)]
    pub(crate) fn act<const MEMORY: bool>(
        &self,
        law: &Law<V>,
        at: &Spots<V>,
        work: &mut Work<V>,
    ) -> Acting<V> {
        let Spots { place: s, weight, slip, damping, .. } = *at;
        let (zero, one) = (s.constant(0.0), s.constant(1.0));
        let [nx, ny] = self.normal;
        let r = along(&self.from, s);
        let foot = r[0].times_plus(self.other[0], r[1] * self.other[1]);
        let gap = r[0].times_plus(nx, r[1] * ny);
        // As in `Shape::holds`.
        let margin = s.constant(NEAR_END) * gap.max(-gap) * self.inverse;
        let within = margin.choose_below(foot, foot.choose_below(one - margin, at.open, zero), zero);
        let (v, u) = (along(&self.own_motion, s), along(&self.other_motion, foot));
        let relative = [v[0] - u[0], v[1] - u[1]];
        let opening = relative[0].times_plus(nx, relative[1] * ny);
        let sliding = relative[1] * nx - relative[0] * ny;
        let points = Touching { within, gap, weight, opening, along: sliding, slip, damping };
        let acts = law.act::<MEMORY>(&points, work);
        let fx = acts.pressure * nx - acts.shear * ny;
        let fy = acts.pressure * ny + acts.shear * nx;
        // Chosen, not multiplied: a lane that is closed may hold no number.
        let force = [zero.choose_below(acts.on, fx, zero), zero.choose_below(acts.on, fy, zero)];
        Acting { acts, force, foot: zero.choose_below(acts.on, foot, zero) }
    }
}

/// A linear field at a place.
#[inline(always)]
fn along<V: Simd>([first, change]: &[[Vector<V>; 2]; 2], place: Vector<V>) -> [Vector<V>; 2] {
    [place.times_plus(change[0], first[0]), place.times_plus(change[1], first[1])]
}
