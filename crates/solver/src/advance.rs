//! Moving nodes: central difference, with damping where there is some, and prescribed rotation (THEORY §2.3, §2.6).

use crate::{
    damping::LaneFrames,
    lanes::{LANES, Lanes, lanes, lanes_mut},
};

/// What is the same for all nodes of a row.
#[derive(Clone, Copy)]
pub(crate) struct Step<'a> {
    pub(crate) dt: f64,
    /// Time step times gravity [m/s].
    pub(crate) fall: [f64; 2],
    /// One for a component that answers to forces, zero for one that is held.
    pub(crate) free: [f64; 2],
    pub(crate) damping: Option<Damping<'a>>,
}

/// Mass-proportional damping of a tile.
#[derive(Clone, Copy)]
pub(crate) struct Damping<'a> {
    /// (1 − αΔt/2)/(1 + αΔt/2): what is left of the relative velocity after a step.
    keep: f64,
    /// 1/(1 + αΔt/2): the share of a push that becomes velocity.
    gain: f64,
    /// αΔt: heat over mass and squared velocity.
    loss: f64,
    frames: &'a LaneFrames,
}

impl<'a> Damping<'a> {
    pub(crate) fn new(rate: f64, frames: &'a LaneFrames, dt: f64) -> Self {
        let half = 0.5 * rate * dt;
        let gain = 1.0 / (1.0 + half);
        Self { keep: (1.0 - half) * gain, gain, loss: 2.0 * half, frames }
    }
}

/// Fields of a row of nodes; the first is in lane 0 of its tile.
pub(crate) struct Row<'a> {
    pub(crate) x: &'a mut [f64],
    pub(crate) y: &'a mut [f64],
    pub(crate) vx: &'a mut [f64],
    pub(crate) vy: &'a mut [f64],
    /// Time step over mass [s/kg].
    pub(crate) step_over_mass: &'a [f64],
    /// Mass [kg]; only read with damping.
    pub(crate) mass: &'a [f64],
}

/// Where the forces on a row come from. Taking leaves zeros behind.
pub(crate) trait Forces {
    /// Forces x and y on a group of nodes from `at` on.
    fn take(&mut self, at: usize) -> (Lanes, Lanes);
    /// The same for one node.
    fn take_one(&mut self, at: usize) -> (f64, f64);
}

/// Forces summed in scratch.
pub(crate) struct Summed<'a> {
    pub(crate) fx: &'a mut [f64],
    pub(crate) fy: &'a mut [f64],
}

impl Forces for Summed<'_> {
    #[inline(always)]
    fn take(&mut self, at: usize) -> (Lanes, Lanes) {
        (std::mem::take(lanes_mut(self.fx, at)), std::mem::take(lanes_mut(self.fy, at)))
    }

    #[inline(always)]
    fn take_one(&mut self, at: usize) -> (f64, f64) {
        (std::mem::take(&mut self.fx[at]), std::mem::take(&mut self.fy[at]))
    }
}

/// Takes a row one step on; returns the heat of damping [J].
#[inline(always)]
pub(crate) fn advance(row: Row<'_>, forces: impl Forces, step: &Step<'_>) -> f64 {
    // The choice is made here, once a row, not once a node.
    match &step.damping {
        Some(damping) => damping.loss * each_group::<true>(row, forces, step, damping),
        None => each_group::<false>(row, forces, step, &Damping::new(0.0, &REST, step.dt)),
    }
}

static REST: LaneFrames = LaneFrames::REST;

#[inline(always)]
fn each_group<const DAMPED: bool>(
    row: Row<'_>,
    mut forces: impl Forces,
    step: &Step<'_>,
    damping: &Damping<'_>,
) -> f64 {
    let n = row.x.len();
    let whole = n - n % LANES;
    let frames = damping.frames;
    let mut heat = [0.0; LANES];
    for i in (0..whole).step_by(LANES) {
        let (fx, fy) = forces.take(i);
        let (x, y, vx, vy) = (lanes(row.x, i), lanes(row.y, i), lanes(row.vx, i), lanes(row.vy, i));
        let m = lanes(row.step_over_mass, i);
        let mass = if DAMPED { lanes(row.mass, i) } else { m };
        let (mut ux, mut uy, mut px, mut py) = ([0.0; LANES], [0.0; LANES], [0.0; LANES], [0.0; LANES]);
        for l in 0..LANES {
            let frame = [frames.origin_x[l], frames.origin_y[l], frames.spin[l]];
            let (place, speed) = ([x[l], y[l]], [vx[l], vy[l]]);
            let moved = node::<DAMPED>(place, speed, [fx[l], fy[l]], m[l], mass[l], step, damping, frame);
            [px[l], py[l], ux[l], uy[l]] = [moved[0], moved[1], moved[2], moved[3]];
            heat[l] += moved[4];
        }
        *lanes_mut(row.x, i) = px;
        *lanes_mut(row.y, i) = py;
        *lanes_mut(row.vx, i) = ux;
        *lanes_mut(row.vy, i) = uy;
    }
    for i in whole..n {
        // Rows that are not whole groups belong to tiles of one body, whose lanes are all alike.
        let (fx, fy) = forces.take_one(i);
        let frame = [frames.origin_x[0], frames.origin_y[0], frames.spin[0]];
        let (place, speed) = ([row.x[i], row.y[i]], [row.vx[i], row.vy[i]]);
        let mass = if DAMPED { row.mass[i] } else { 0.0 };
        let m = row.step_over_mass[i];
        let moved = node::<DAMPED>(place, speed, [fx, fy], m, mass, step, damping, frame);
        [row.x[i], row.y[i], row.vx[i], row.vy[i]] = [moved[0], moved[1], moved[2], moved[3]];
        heat[0] += moved[4];
    }
    heat.iter().sum()
}

/// One node: v += Δt·a, x += Δt·v; returns the new (x, y, vx, vy) and the heat over αΔt.
#[inline(always)]
#[allow(clippy::too_many_arguments)] // all that one node has
fn node<const DAMPED: bool>(
    [x, y]: [f64; 2],
    [vx, vy]: [f64; 2],
    [fx, fy]: [f64; 2],
    step_over_mass: f64,
    mass: f64,
    step: &Step<'_>,
    damping: &Damping<'_>,
    [origin_x, origin_y, spin]: [f64; 3],
) -> [f64; 5] {
    let (push_x, push_y) = (fx * step_over_mass + step.fall[0], fy * step_over_mass + step.fall[1]);
    if !DAMPED {
        let (qx, qy) = (step.free[0] * (vx + push_x), step.free[1] * (vy + push_y));
        return [x + step.dt * qx, y + step.dt * qy, qx, qy, 0.0];
    }
    let (ux, uy) = (origin_x - spin * y, origin_y + spin * x);
    let qx = step.free[0] * (ux + (damping.keep * (vx - ux) + damping.gain * push_x));
    let qy = step.free[1] * (uy + (damping.keep * (vy - uy) + damping.gain * push_y));
    // Damping acts on, and works with, the velocity between the two half steps.
    let (sx, sy) = (0.5 * (vx + qx), 0.5 * (vy + qy));
    let heat = mass * ((sx - ux) * sx + (sy - uy) * sy);
    [x + step.dt * qx, y + step.dt * qy, qx, qy, heat]
}

/// Turns a row about a centre [m] by the exact angle of one step at `rate` [rad/s]; returns the work [J] of the drive,
/// whose force is what mass and other forces leave over.
#[inline(always)]
pub(crate) fn rotate(
    row: Row<'_>,
    forces: Summed<'_>,
    centre: [f64; 2],
    rate: f64,
    dt: f64,
    gravity: [f64; 2],
) -> f64 {
    // cos − 1 without cancellation: the angle of a step is about 1e-6.
    let half = (0.5 * rate * dt).sin();
    let (c1, s) = (-2.0 * half * half, (rate * dt).sin());
    let mut work = 0.0;
    for i in 0..row.x.len() {
        let (rx, ry) = (row.x[i] - centre[0], row.y[i] - centre[1]);
        let (dx, dy) = (c1 * rx - s * ry, s * rx + c1 * ry);
        let (vx, vy) = (dx / dt, dy / dt);
        let m = dt / row.step_over_mass[i];
        let reaction_x = m * ((vx - row.vx[i]) / dt - gravity[0]) - forces.fx[i];
        let reaction_y = m * ((vy - row.vy[i]) / dt - gravity[1]) - forces.fy[i];
        work += 0.5 * dt * (reaction_x * (vx + row.vx[i]) + reaction_y * (vy + row.vy[i]));
        row.x[i] += dx;
        row.y[i] += dy;
        row.vx[i] = vx;
        row.vy[i] = vy;
    }
    forces.fx.fill(0.0);
    forces.fy.fill(0.0);
    work
}
