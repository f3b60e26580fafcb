//! Chords read from the node fields: one, or one in each lane.

use pulp::Simd;
use stribeck_simd::lanes::{LANES, Number, Vector};
use stribeck_solver::state::Moment;

use super::chord_pair::MovingChord;
use stribeck_surface::{plane::minus, polynomial::Polynomial};

impl MovingChord<f64> {
    /// The chord between two slots.
    #[inline(always)]
    pub(crate) fn between(at: &Moment<'_>, (a, b): (usize, usize)) -> Self {
        Self::from_ends([at.x[a], at.y[a]], [at.x[b], at.y[b]], [at.vx[a], at.vy[a]], [at.vx[b], at.vy[b]])
    }
}

impl<N: Number> MovingChord<N> {
    #[inline(always)]
    fn from_ends(a: [N; 2], b: [N; 2], va: [N; 2], vb: [N; 2]) -> Self {
        Self { position: Polynomial([a, minus(b, a)]), velocity: Polynomial([va, minus(vb, va)]) }
    }
}

impl<V: Simd> MovingChord<Vector<V>> {
    /// A chord in each lane.
    #[inline(always)]
    pub(crate) fn each(simd: V, at: &Moment<'_>, chords: &ChordLanes) -> Self {
        let [[ax, bx], [ay, by]] = [both(simd, at.x, chords), both(simd, at.y, chords)];
        let [[au, bu], [av, bv]] = [both(simd, at.vx, chords), both(simd, at.vy, chords)];
        Self::from_ends([ax, ay], [bx, by], [au, av], [bu, bv])
    }
}

/// A chord in each lane, by the slots of its ends.
#[derive(Clone, Copy)]
pub(crate) struct ChordLanes {
    pub(crate) ends: [[u32; LANES]; 2],
    pub(crate) joints: Joints,
}

/// How chords in neighbouring lanes share nodes.
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

impl ChordLanes {
    /// From the slots of each chord's ends. They are compared one by one: vector loads would wait for stores
    /// of slots still in flight.
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

/// A number of a field at both ends of each chord; a shared node is read once.
#[inline(always)]
fn both<V: Simd>(simd: V, field: &[f64], ChordLanes { ends: [a, b], joints }: &ChordLanes) -> [Vector<V>; 2] {
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
