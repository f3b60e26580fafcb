//! Points of chords against chords, a vector of them at a time: the sharp penalty law, damping and friction.
//!
//! On chords everything is linear in the place of a point, so all points take the same few operations, whether they lie
//! on one facet ([`row`](crate::row)) or on many ([`band`](crate::band)). The loop over single points in
//! [`evaluation`](crate::evaluation) does the same for what is left over; a test holds the two together.

use pulp::Simd;
use stribeck_solver::{
    lanes::{LANES, Number, Vector},
    state::Moment,
};

use crate::{
    pass::{NEVER, SPEED_MARGIN, Weights},
    projection::NEAR_END,
    touch::Sum,
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

/// The law, in all lanes.
#[derive(Clone, Copy)]
pub(crate) struct Laws<V: Simd> {
    zero: Vector<V>,
    one: Vector<V>,
    half: Vector<V>,
    dt: Vector<V>,
    half_dt: Vector<V>,
    near_end: Vector<V>,
    deepest: Vector<V>,
    /// Penalty and damping times the thickness, tangential over normal stiffness, friction over that.
    stiffness: Vector<V>,
    dashpot: Vector<V>,
    tangential: Vector<V>,
    ratio: Vector<V>,
    /// Now, in steps since the search, and what points that stay apart count on (`Weights::steps_apart`).
    now: Vector<V>,
    never: Vector<V>,
    pace: Vector<V>,
    margin: Vector<V>,
    least: Vector<V>,
    fastest: Vector<V>,
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

/// What acts on points in contact.
#[derive(Clone, Copy)]
pub(crate) struct Acting<V: Simd> {
    /// 1 where the point certainly touches this chord, 0 elsewhere: there forces are zero and memories as they were.
    pub(crate) on: Vector<V>,
    pub(crate) force: [Vector<V>; 2],
    /// 1 where the point certainly stands off this chord, and has nothing to settle; until then it dozes.
    pub(crate) apart: Vector<V>,
    pub(crate) doze: Vector<V>,
    /// Place on the other chord.
    pub(crate) foot: Vector<V>,
    pub(crate) slip: Vector<V>,
    pub(crate) damping: Vector<V>,
}

/// Energies of all points, and the deepest penetration.
#[derive(Clone, Copy)]
pub(crate) struct Account<V: Simd> {
    stored: Vector<V>,
    friction: Vector<V>,
    damping: Vector<V>,
    penetration: Vector<V>,
    /// Fastest opening or closing [m/s].
    pace: Vector<V>,
}

impl<V: Simd> Chord<V> {
    /// The same chord in all lanes.
    #[inline(always)]
    pub(crate) fn all(simd: V, e: &Ends) -> Self {
        let v = |k: usize| Vector::all(simd, e[k]);
        Self {
            position: [[v(0), v(1)], [Vector::all(simd, e[4] - e[0]), Vector::all(simd, e[5] - e[1])]],
            velocity: [[v(2), v(3)], [Vector::all(simd, e[6] - e[2]), Vector::all(simd, e[7] - e[3])]],
        }
    }

    /// A chord in each lane, from the slots of their ends.
    #[inline(always)]
    pub(crate) fn each(simd: V, at: &Moment<'_>, [a, b]: &[[u32; LANES]; 2]) -> Self {
        let first = [gather(simd, at.x, a), gather(simd, at.y, a)];
        let velocity = [gather(simd, at.vx, a), gather(simd, at.vy, a)];
        Self {
            position: [first, [gather(simd, at.x, b) - first[0], gather(simd, at.y, b) - first[1]]],
            velocity: [
                velocity,
                [gather(simd, at.vx, b) - velocity[0], gather(simd, at.vy, b) - velocity[1]],
            ],
        }
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

impl<V: Simd> Laws<V> {
    #[inline(always)]
    pub(crate) fn new(simd: V, w: &Weights, dt: f64, deepest: f64, now: f64, pace: f64) -> Self {
        let law = &w.law;
        Self {
            zero: Vector::all(simd, 0.0),
            one: Vector::all(simd, 1.0),
            half: Vector::all(simd, 0.5),
            dt: Vector::all(simd, dt),
            half_dt: Vector::all(simd, 0.5 * dt),
            near_end: Vector::all(simd, NEAR_END),
            deepest: Vector::all(simd, deepest),
            stiffness: Vector::all(simd, law.stiffness * w.thickness),
            dashpot: Vector::all(simd, law.damping * w.thickness),
            tangential: Vector::all(simd, law.tangential),
            ratio: Vector::all(simd, law.friction / law.tangential),
            now: Vector::all(simd, now),
            never: Vector::all(simd, NEVER),
            pace: Vector::all(simd, pace),
            margin: Vector::all(simd, SPEED_MARGIN),
            least: Vector::all(simd, w.least_speed()),
            fastest: Vector::all(simd, w.fastest),
        }
    }
}

impl<V: Simd> Account<V> {
    #[inline(always)]
    pub(crate) fn new(simd: V) -> Self {
        let zero = Vector::all(simd, 0.0);
        Self { stored: zero, friction: zero, damping: zero, penetration: zero, pace: zero }
    }

    #[inline(always)]
    pub(crate) fn pace(&self) -> f64 {
        self.pace.largest()
    }

    #[inline(always)]
    pub(crate) fn add_to(self, sum: &mut Sum) {
        sum.stored += self.stored.sum();
        sum.friction += self.friction.sum();
        sum.damping += self.damping.sum();
        sum.penetration = sum.penetration.max(self.penetration.largest());
    }
}

impl<V: Simd> Meeting<V> {
    #[inline(always)]
    pub(crate) fn new(laws: &Laws<V>, own: &Chord<V>, other: &Chord<V>) -> Self {
        let [start, [tx, ty]] = other.position;
        let [first, along] = own.position;
        let square = tx.times_plus(tx, ty * ty);
        let inverse = laws.one / square.sqrt();
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

    /// What acts on a vector of points, and its energies; without `MEMORY` the penalty alone.
    #[inline(always)]
    pub(crate) fn act<const MEMORY: bool>(
        &self,
        laws: &Laws<V>,
        at: &Spots<V>,
        account: &mut Account<V>,
    ) -> Acting<V> {
        let Laws { zero, one, half, .. } = *laws;
        let Spots { place: s, weight, .. } = *at;
        let [nx, ny] = self.normal;
        let r = along(&self.from, s);
        let foot = r[0].times_plus(self.other[0], r[1] * self.other[1]);
        let gap = r[0].times_plus(nx, r[1] * ny);
        let depth = -gap;
        // As in `Shape::holds`.
        let margin = laws.near_end * depth.max(gap) * self.inverse;
        let within = margin.choose_below(foot, foot.choose_below(one - margin, at.open, zero), zero);
        let on = gap.choose_below(zero, depth.choose_below(laws.deepest, within, zero), zero);
        let (v, u) = (along(&self.own_motion, s), along(&self.other_motion, foot));
        let relative = [v[0] - u[0], v[1] - u[1]];
        let opening = relative[0].times_plus(nx, relative[1] * ny);
        let sliding = relative[1] * nx - relative[0] * ny;
        // As in `Weights::steps_apart`; a point that remembers something settles it first.
        let pace = within * opening.max(-opening);
        let still = at.slip * at.slip + at.damping * at.damping;
        let apart = zero.choose_below(still, zero, gap.choose_below(zero, zero, within));
        let approach = laws.pace.max(pace) + sliding.max(-sliding);
        let closing = approach.times_plus(laws.margin, laws.least).min(laws.fastest);
        let doze = (laws.now + gap / (closing * laws.dt)).min(laws.never);
        account.pace = account.pace.max(pace);
        let k = laws.stiffness * weight;
        let elastic = k * depth;
        account.penetration = account.penetration.max(on * depth);
        if !MEMORY {
            account.stored = on.times_plus(half * elastic * depth, account.stored);
            let pressure = on * elastic;
            return Acting {
                on,
                apart,
                doze,
                force: [pressure * nx, pressure * ny],
                foot,
                slip: zero,
                damping: zero,
            };
        }
        let damping = (-(laws.dashpot * weight * opening)).max(-elastic);
        let damping_heat = -(laws.half_dt * (at.damping + damping) * opening);
        let kt = laws.tangential * k;
        let limit = laws.ratio * depth;
        let moved = sliding * laws.dt;
        let slip = (at.slip + moved).max(-limit).min(limit);
        let (was, is) = (half * kt * at.slip * at.slip, half * kt * slip * slip);
        let friction_heat = half * kt * (at.slip + slip) * moved - (is - was);
        let (normal, shear) = (elastic + damping, -(kt * slip));
        account.stored = on.times_plus(half * elastic * depth + is, account.stored);
        account.friction = on.times_plus(friction_heat, account.friction);
        account.damping = on.times_plus(damping_heat, account.damping);
        Acting {
            on,
            force: [on * (normal * nx - shear * ny), on * (normal * ny + shear * nx)],
            apart,
            doze,
            foot,
            slip: zero.choose_below(on, slip, at.slip),
            damping: zero.choose_below(on, damping, at.damping),
        }
    }
}

/// A linear field at a place.
#[inline(always)]
fn along<V: Simd>([first, change]: &[[Vector<V>; 2]; 2], place: Vector<V>) -> [Vector<V>; 2] {
    [place.times_plus(change[0], first[0]), place.times_plus(change[1], first[1])]
}
