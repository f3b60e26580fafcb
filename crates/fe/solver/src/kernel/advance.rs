//! Moving nodes: central difference, with damping where there is some, and prescribed rotation (THEORY §2.3,
//! §2.6).

use std::marker::PhantomData;

use prefetch_index::prefetch_index;
use pulp::Simd;

use crate::kernel::frames::{LaneFrames, LaneMotion};
use stribeck_simd::lanes::{LANES, Number, Vector};

/// Parameters of a step, the same for all tiles.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StepParameters {
    pub(crate) dt: f64,
    pub(crate) gravity: [f64; 2],
    /// β of the stiffness damping [s].
    pub(crate) beta: f64,
    /// Time since damping frames were placed [s].
    pub(crate) since_placed: f64,
    /// Whether the heat of damping is counted in this step.
    pub(crate) count_heat: bool,
    /// Whether strips prefetch the data that they read next.
    pub(crate) fetch: bool,
    /// Whether tiles are swept in the opposite order, the last ones of the step before first.
    pub(crate) back: bool,
}

/// Parameters of a tile, the same for all its nodes.
pub(crate) struct Step<S: Simd> {
    dt: Vector<S>,
    /// Velocity gained by gravity in a step [m/s].
    fall: [Vector<S>; 2],
    /// Factor of a velocity after a step, (1 − αΔt/2)/(1 + αΔt/2).
    keep: Vector<S>,
    /// Velocity that the frame of each lane gives back in a step, at the origin [m/s] and by place [1/s]; the
    /// first with gravity.
    drift_x: [f64; LANES],
    drift_y: [f64; LANES],
    turn: [f64; LANES],
    /// How the frames move.
    frames: LaneMotion,
    /// αΔt: heat over mass and squared velocity.
    loss: f64,
    /// Whether strips prefetch the data that they read next.
    pub(crate) fetch: bool,
}

impl<S: Simd> Step<S> {
    /// A step with damping at `rate` [1/s].
    #[inline(always)]
    pub(crate) fn new(simd: S, parameters: &StepParameters, rate: f64, frames: &LaneFrames) -> Self {
        let &StepParameters { dt, gravity, fetch, since_placed, .. } = parameters;
        let frames = frames.after(since_placed);
        let half = 0.5 * rate * dt;
        let gain = gain(rate, dt);
        let fall = gravity.map(|g| dt * gain * g);
        let given = 2.0 * half * gain;
        Self {
            dt: Vector::all(simd, dt),
            fall: [Vector::all(simd, fall[0]), Vector::all(simd, fall[1])],
            keep: Vector::all(simd, (1.0 - half) * gain),
            drift_x: frames.origin_x.map(|v| fall[0] + given * v),
            drift_y: frames.origin_y.map(|v| fall[1] + given * v),
            turn: frames.spin.map(|w| given * w),
            frames,
            loss: 2.0 * half,
            fetch,
        }
    }

    /// A step in which nothing moves.
    #[inline(always)]
    pub(crate) fn still(simd: S, fetch: bool) -> Self {
        let zero = Vector::all(simd, 0.0);
        Self {
            dt: zero,
            fall: [zero; 2],
            keep: zero,
            drift_x: [0.0; LANES],
            drift_y: [0.0; LANES],
            turn: [0.0; LANES],
            frames: LaneMotion::default(),
            loss: 0.0,
            fetch,
        }
    }

    /// Heat of damping [J] from what [`advance`] counts.
    #[inline(always)]
    pub(crate) fn heat(&self, counted: Vector<S>) -> f64 {
        self.loss * counted.sum()
    }
}

/// The share of a push that becomes velocity in a step [s] with damping at `rate` [1/s]: 1/(1 + αΔt/2).
pub(crate) fn gain(rate: f64, dt: f64) -> f64 {
    1.0 / (1.0 + 0.5 * rate * dt)
}

/// Fields of a tile, and the forces summed so far. All are longer by a group of lanes than the last node that
/// counts.
pub(crate) struct Nodes<'a> {
    /// Positions that elements see [m].
    pub(crate) x: &'a mut [f64],
    pub(crate) y: &'a mut [f64],
    /// Positions of the nodes [m] where elements see others, with stiffness damping; else empty.
    pub(crate) own_x: &'a mut [f64],
    pub(crate) own_y: &'a mut [f64],
    pub(crate) vx: &'a mut [f64],
    pub(crate) vy: &'a mut [f64],
    pub(crate) fx: &'a mut [f64],
    pub(crate) fy: &'a mut [f64],
    /// Forces [N] that structural damping holds; empty where there is none.
    pub(crate) held_x: &'a [f32],
    pub(crate) held_y: &'a [f32],
    /// Time step times [`gain`] over mass [s/kg].
    pub(crate) step_over_mass: &'a [f64],
    /// Mass [kg]; only read where heat is counted.
    pub(crate) mass: &'a [f64],
}

/// How many nodes ahead a strip prefetches, so that their values have come from memory when the strip reaches
/// them.
pub(crate) const FETCH: usize = 128;

impl Nodes<'_> {
    /// Prefetches data that a strip will read later: positions of the row `high`, and the rest of the row
    /// `low` if it moves.
    #[inline(always)]
    pub(crate) fn fetch(&self, low: usize, high: usize, moves: bool) {
        prefetch_index(&*self.x, high + FETCH);
        prefetch_index(&*self.y, high + FETCH);
        if moves {
            prefetch_index(&*self.vx, low + FETCH);
            prefetch_index(&*self.vy, low + FETCH);
            prefetch_index(self.step_over_mass, low + FETCH);
            if !self.held_x.is_empty() {
                prefetch_index(self.held_x, low + FETCH);
                prefetch_index(self.held_y, low + FETCH);
            }
        }
    }

    /// The same arrays, cut to one length, so that the compiler checks bounds once.
    #[inline(always)]
    pub(crate) fn alike<D: Damping>(&mut self) -> Nodes<'_> {
        let n = self.x.len();
        let own = if D::STIFFNESS { n } else { 0 };
        let held = if D::HOLDS { n } else { 0 };
        Nodes {
            x: &mut self.x[..n],
            y: &mut self.y[..n],
            own_x: &mut self.own_x[..own],
            own_y: &mut self.own_y[..own],
            vx: &mut self.vx[..n],
            vy: &mut self.vy[..n],
            fx: &mut self.fx[..n],
            fy: &mut self.fy[..n],
            held_x: &self.held_x[..held],
            held_y: &self.held_y[..held],
            step_over_mass: &self.step_over_mass[..n],
            mass: self.mass,
        }
    }
}

/// How nodes are damped, known when the program is compiled: an undamped tile runs no damping code.
pub(crate) trait Damping {
    /// Whether velocities decay.
    const DAMPS: bool;
    /// Whether the heat of that is counted.
    const COUNTS: bool;
    /// Whether there is stiffness damping: elements see positions that are not those of the nodes.
    const STIFFNESS: bool = false;
    /// Whether there is structural damping, which holds a force at each node.
    const HOLDS: bool = false;
}

/// No damping.
pub(crate) struct Undamped;
/// Damping whose heat is not counted in this step.
pub(crate) struct Damped;
/// Damping and its heat.
pub(crate) struct Counted;
/// The same, and stiffness damping.
pub(crate) struct WithStiffness<D>(PhantomData<D>);
/// The same, and structural damping.
pub(crate) struct WithHeld<D>(PhantomData<D>);

impl Damping for Undamped {
    const DAMPS: bool = false;
    const COUNTS: bool = false;
}

impl Damping for Damped {
    const DAMPS: bool = true;
    const COUNTS: bool = false;
}

impl Damping for Counted {
    const DAMPS: bool = true;
    const COUNTS: bool = true;
}

impl<D: Damping> Damping for WithStiffness<D> {
    const DAMPS: bool = D::DAMPS;
    const COUNTS: bool = D::COUNTS;
    const STIFFNESS: bool = true;
}

impl<D: Damping> Damping for WithHeld<D> {
    const DAMPS: bool = D::DAMPS;
    const COUNTS: bool = D::COUNTS;
    const HOLDS: bool = true;
}

/// Takes a group of nodes from `at` on one step on under forces x, y [N]: v += Δt·a, x += Δt·v. With `LAST`,
/// only the first `n` of them.
///
/// `lane` is that of the first node, zero where all lanes have one frame. `free` is one for a component that
/// answers to forces, zero for one that is held. Forces summed in `nodes` become zero. Adds to `heat` what,
/// times αΔt, is the heat of damping.
#[inline(always)]
#[allow(clippy::too_many_arguments)] // all that a group of nodes has
pub(crate) fn advance<S: Simd, D: Damping, const LAST: bool>(
    simd: S,
    nodes: &mut Nodes<'_>,
    at: usize,
    lane: usize,
    n: usize,
    [mut fx, mut fy]: [Vector<S>; 2],
    free: [f64; 2],
    step: &Step<S>,
    heat: &mut Vector<S>,
) {
    if D::HOLDS {
        fx = fx + Vector::load_single(simd, nodes.held_x, at);
        fy = fy + Vector::load_single(simd, nodes.held_y, at);
    }
    let [own_x, own_y] =
        if D::STIFFNESS { [&mut *nodes.own_x, &mut *nodes.own_y] } else { [&mut *nodes.x, &mut *nodes.y] };
    let (x, y) = (Vector::load(simd, own_x, at), Vector::load(simd, own_y, at));
    let (vx, vy) = (Vector::load(simd, nodes.vx, at), Vector::load(simd, nodes.vy, at));
    let m = Vector::load(simd, nodes.step_over_mass, at);
    let (mut ux, mut uy) = if D::DAMPS {
        let turn = Vector::load(simd, &step.turn, lane);
        let drift_x = (-turn).times_plus(y, Vector::load(simd, &step.drift_x, lane));
        let drift_y = turn.times_plus(x, Vector::load(simd, &step.drift_y, lane));
        (
            step.keep.times_plus(vx, fx.times_plus(m, drift_x)),
            step.keep.times_plus(vy, fy.times_plus(m, drift_y)),
        )
    } else {
        (vx + fx.times_plus(m, step.fall[0]), vy + fy.times_plus(m, step.fall[1]))
    };
    if free[0] != 1.0 {
        ux = ux * Vector::all(simd, free[0]);
    }
    if free[1] != 1.0 {
        uy = uy * Vector::all(simd, free[1]);
    }
    if D::COUNTS {
        // Damping acts on, and works with, the velocity between the two half steps.
        let half = Vector::all(simd, 0.5);
        let (sx, sy) = (half * (vx + ux), half * (vy + uy));
        let spin = Vector::load(simd, &step.frames.spin, lane);
        let rx = sx - (-spin).times_plus(y, Vector::load(simd, &step.frames.origin_x, lane));
        let ry = sy - spin.times_plus(x, Vector::load(simd, &step.frames.origin_y, lane));
        let warm = Vector::load(simd, nodes.mass, at) * rx.times_plus(sx, ry * sy);
        *heat = *heat + if LAST { warm.first(n) } else { warm };
    }
    let zero = Vector::all(simd, 0.0);
    put::<S, LAST>(ux.times_plus(step.dt, x), n, own_x, at);
    put::<S, LAST>(uy.times_plus(step.dt, y), n, own_y, at);
    put::<S, LAST>(ux, n, nodes.vx, at);
    put::<S, LAST>(uy, n, nodes.vy, at);
    put::<S, LAST>(zero, n, nodes.fx, at);
    put::<S, LAST>(zero, n, nodes.fy, at);
}

#[inline(always)]
fn put<S: Simd, const LAST: bool>(value: Vector<S>, n: usize, to: &mut [f64], at: usize) {
    if LAST { value.store_first(n, to, at) } else { value.store(to, at) }
}

/// Takes a row of nodes one step on under the forces summed so far. `lanes` says that they are of bodies in
/// lanes.
#[inline(always)]
#[allow(clippy::too_many_arguments)] // see `advance`
pub(crate) fn advance_row<S: Simd, D: Damping>(
    simd: S,
    nodes: &mut Nodes<'_>,
    row: std::ops::Range<usize>,
    lanes: bool,
    free: [f64; 2],
    step: &Step<S>,
    heat: &mut Vector<S>,
) {
    let len = Vector::<S>::LEN;
    for at in row.clone().step_by(len) {
        let force = [Vector::load(simd, nodes.fx, at), Vector::load(simd, nodes.fy, at)];
        let (lane, n) = (if lanes { at % LANES } else { 0 }, row.end - at);
        if n >= len {
            advance::<S, D, false>(simd, nodes, at, lane, len, force, free, step, heat);
        } else {
            advance::<S, D, true>(simd, nodes, at, lane, n, force, free, step, heat);
        }
    }
}

/// Turns a row about a centre [m] by the exact angle of one step at `rate` [rad/s]; returns the work [J] of
/// the drive, whose force is what mass and other forces leave over. `gain` is that of the nodes'
/// `step_over_mass`.
#[inline(always)]
pub(crate) fn rotate<D: Damping>(
    nodes: &mut Nodes<'_>,
    row: std::ops::Range<usize>,
    centre: [f64; 2],
    rate: f64,
    dt: f64,
    gain: f64,
    gravity: [f64; 2],
) -> f64 {
    // cos − 1 without cancellation: the angle of a step is about 1e-6.
    let half = libm::sin(0.5 * rate * dt);
    let (c1, s) = (-2.0 * half * half, libm::sin(rate * dt));
    let [x, y] =
        if D::STIFFNESS { [&mut *nodes.own_x, &mut *nodes.own_y] } else { [&mut *nodes.x, &mut *nodes.y] };
    let mut work = 0.0;
    for i in row {
        let (rx, ry) = (x[i] - centre[0], y[i] - centre[1]);
        let (dx, dy) = (c1 * rx - s * ry, s * rx + c1 * ry);
        let (vx, vy) = (dx / dt, dy / dt);
        let m = gain * dt / nodes.step_over_mass[i];
        let held = if D::HOLDS { [nodes.held_x[i], nodes.held_y[i]] } else { [0.0, 0.0] };
        let [held_x, held_y] = held.map(f64::from);
        let reaction_x = m * ((vx - nodes.vx[i]) / dt - gravity[0]) - nodes.fx[i] - held_x;
        let reaction_y = m * ((vy - nodes.vy[i]) / dt - gravity[1]) - nodes.fy[i] - held_y;
        work += 0.5 * dt * (reaction_x * (vx + nodes.vx[i]) + reaction_y * (vy + nodes.vy[i]));
        x[i] += dx;
        y[i] += dy;
        nodes.vx[i] = vx;
        nodes.vy[i] = vy;
        nodes.fx[i] = 0.0;
        nodes.fy[i] = 0.0;
    }
    work
}
