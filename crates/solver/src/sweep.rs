//! One pass over a tile: element forces, then each finished row of nodes moves while it is still in cache
//! (THEORY §2.3; cost in PERFORMANCE.md).

use std::ops::Range;

use multiversion::multiversion;

use crate::{
    damping::LaneFrames,
    element::{QuadReference, Stiffness, quad_forces, triangle_forces},
    layout::LANES,
    model::Motion,
    tile::{Strip, StripReferences, Tile, TileDamping, VaryingReferences},
};

/// Elements of a strip between two additions to the nodes: the buffers stay in the first-level cache.
const BLOCK: usize = 128;

/// The node fields of one tile.
pub(crate) struct TileFields<'a> {
    pub(crate) x: &'a mut [f64],
    pub(crate) y: &'a mut [f64],
    pub(crate) vx: &'a mut [f64],
    pub(crate) vy: &'a mut [f64],
    /// Forces from outside the elements; read and reset at loaded nodes.
    pub(crate) fx: &'a mut [f64],
    pub(crate) fy: &'a mut [f64],
}

/// What a worker thread may scribble on.
#[derive(Debug, Clone)]
pub(crate) struct Scratch {
    /// Forces on the nodes of the tile at hand; all zero between tiles.
    fx: Vec<f64>,
    fy: Vec<f64>,
    corner: [[f64; BLOCK]; 8],
}

impl Scratch {
    pub(crate) fn new(slots: usize) -> Self {
        Self { fx: vec![0.0; slots], fy: vec![0.0; slots], corner: [[0.0; BLOCK]; 8] }
    }
}

/// What moves nodes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Drive {
    pub(crate) dt: f64,
    pub(crate) gravity: [f64; 2],
}

/// What a sweep counts [J], each from half a step before to half a step after the positions' time.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Counted {
    /// Work of prescribed motion.
    pub(crate) work: f64,
    /// Heat of mass damping.
    pub(crate) heat: f64,
}

impl std::ops::Add for Counted {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { work: self.work + other.work, heat: self.heat + other.heat }
    }
}

/// Computes the forces of one tile and takes its nodes one step on.
#[multiversion(targets("x86_64+avx512f+avx512vl+avx512dq+avx512bw+avx512cd+avx2+bmi2", "x86_64+avx2+bmi2"))]
pub(crate) fn sweep(tile: &Tile, fields: TileFields<'_>, scratch: &mut Scratch, drive: Drive) -> Counted {
    let TileFields { x, y, vx, vy, fx: outer_x, fy: outer_y } = fields;
    let n = tile.slots.len();
    let (fx, fy) = (&mut scratch.fx[..n], &mut scratch.fy[..n]);
    for &node in &tile.loaded {
        let node = node as usize;
        fx[node] = outer_x[node];
        fy[node] = outer_y[node];
        outer_x[node] = 0.0;
        outer_y[node] = 0.0;
    }
    if tile.congruent {
        congruent_quads(tile, x, y, fx, fy);
        congruent_triangles(tile, x, y, fx, fy);
    } else {
        single_elements(tile, x, y, fx, fy);
    }
    let mut finish = tile.finish.iter().peekable();
    let mut counted = Counted::default();
    for done in 0..=tile.strips.len() {
        while let Some(f) = finish.next_if(|f| f.after == done) {
            let r = f.nodes.clone();
            let step_over_mass = &tile.step_over_mass[r.clone()];
            let damping = tile.damping.as_ref().map(|d| Damping::new(d, r.clone(), tile.congruent, drive.dt));
            let nodes = Nodes {
                x: &mut x[r.clone()],
                y: &mut y[r.clone()],
                vx: &mut vx[r.clone()],
                vy: &mut vy[r.clone()],
                fx: &mut fx[r.clone()],
                fy: &mut fy[r],
            };
            counted = counted + advance(nodes, step_over_mass, f.motion, drive, damping);
        }
        if let Some(strip) = tile.strips.get(done) {
            strip_forces(strip, &tile.varying, &tile.stiffness, x, y, fx, fy, &mut scratch.corner);
        }
    }
    fx[tile.own..].fill(0.0);
    fy[tile.own..].fill(0.0);
    counted
}

/// Fields of consecutive nodes that move alike.
struct Nodes<'a> {
    x: &'a mut [f64],
    y: &'a mut [f64],
    vx: &'a mut [f64],
    vy: &'a mut [f64],
    fx: &'a mut [f64],
    fy: &'a mut [f64],
}

/// Central difference: v += Δt·a, x += Δt·v; leaves the forces at zero for the next use of the scratch.
#[inline(always)]
fn advance(
    nodes: Nodes<'_>,
    step_over_mass: &[f64],
    motion: Motion,
    drive: Drive,
    damping: Option<Damping<'_>>,
) -> Counted {
    let (free_x, free_y) = match motion {
        Motion::Free => (true, true),
        Motion::HeldX => (false, true),
        Motion::HeldY => (true, false),
        Motion::Held => (false, false),
        Motion::Rotating { centre, rate } => {
            return Counted { work: rotate(nodes, step_over_mass, centre, rate, drive), heat: 0.0 };
        }
    };
    let [gx, gy] = drive.gravity;
    let heat = match damping {
        None => {
            advance_component(free_x, nodes.x, nodes.vx, nodes.fx, step_over_mass, drive.dt, gx);
            advance_component(free_y, nodes.y, nodes.vy, nodes.fy, step_over_mass, drive.dt, gy);
            0.0
        }
        Some(damping) => advance_damped(nodes, step_over_mass, [free_x, free_y], drive, damping),
    };
    Counted { work: 0.0, heat }
}

#[inline(always)]
fn advance_component(
    free: bool,
    x: &mut [f64],
    v: &mut [f64],
    f: &mut [f64],
    step_over_mass: &[f64],
    dt: f64,
    g: f64,
) {
    let n = x.len();
    let (v, f, m) = (&mut v[..n], &mut f[..n], &step_over_mass[..n]);
    if !free {
        f.fill(0.0);
        return;
    }
    let dt_g = dt * g;
    for i in 0..n {
        let vi = v[i] + (f[i] * m[i] + dt_g);
        v[i] = vi;
        x[i] += dt * vi;
        f[i] = 0.0;
    }
}

/// Damping of consecutive nodes.
#[derive(Clone, Copy)]
struct Damping<'a> {
    /// (1 − αΔt/2)/(1 + αΔt/2): what is left of the relative velocity after a step.
    keep: f64,
    /// 1/(1 + αΔt/2): the share of a force that becomes velocity.
    gain: f64,
    /// αΔt: heat over mass and squared velocity.
    loss: f64,
    frames: &'a LaneFrames,
    mass: &'a [f64],
    /// Lane of the first node.
    lane: usize,
}

impl<'a> Damping<'a> {
    #[inline(always)]
    fn new(d: &'a TileDamping, nodes: Range<usize>, congruent: bool, dt: f64) -> Self {
        let half = 0.5 * d.rate * dt;
        let gain = 1.0 / (1.0 + half);
        Self {
            keep: (1.0 - half) * gain,
            gain,
            loss: 2.0 * half,
            frames: &d.frames,
            // In a tile of one body all lanes are alike.
            lane: if congruent { nodes.start % LANES } else { 0 },
            mass: &d.mass[nodes],
        }
    }

    /// Velocity half a step after, from that half a step before, the frame's velocity and the push Δt·a.
    #[inline(always)]
    fn velocity(&self, before: f64, frame: f64, push: f64) -> f64 {
        frame + (self.keep * (before - frame) + self.gain * push)
    }
}

/// Central difference with damping relative to a rigid motion; returns its heat [J].
#[inline(always)]
fn advance_damped(
    nodes: Nodes<'_>,
    step_over_mass: &[f64],
    free: [bool; 2],
    drive: Drive,
    damping: Damping<'_>,
) -> f64 {
    let n = nodes.x.len();
    let whole = if damping.lane == 0 { n - n % LANES } else { 0 };
    let mut heat = [0.0; LANES];
    for i in (0..whole).step_by(LANES) {
        let group = [*lanes(nodes.x, i), *lanes(nodes.y, i), *lanes(nodes.vx, i), *lanes(nodes.vy, i)];
        let force = [*lanes(nodes.fx, i), *lanes(nodes.fy, i)];
        let mass = [*lanes(step_over_mass, i), *lanes(damping.mass, i)];
        let [x, y, vx, vy] = damped_lanes(group, force, mass, free, drive, &damping, &mut heat);
        *lanes_mut(nodes.x, i) = x;
        *lanes_mut(nodes.y, i) = y;
        *lanes_mut(nodes.vx, i) = vx;
        *lanes_mut(nodes.vy, i) = vy;
    }
    for i in whole..n {
        // What is left over goes through the same kernel, alone in its lane.
        let l = (damping.lane + i) % LANES;
        let alone = |v: f64| {
            let mut lane = [0.0; LANES];
            lane[l] = v;
            lane
        };
        let group = [&nodes.x, &nodes.y, &nodes.vx, &nodes.vy].map(|v| alone(v[i]));
        let force = [&nodes.fx, &nodes.fy].map(|v| alone(v[i]));
        let mass = [alone(step_over_mass[i]), alone(damping.mass[i])];
        let [x, y, vx, vy] = damped_lanes(group, force, mass, free, drive, &damping, &mut heat);
        [nodes.x[i], nodes.y[i], nodes.vx[i], nodes.vy[i]] = [x[l], y[l], vx[l], vy[l]];
    }
    nodes.fx.fill(0.0);
    nodes.fy.fill(0.0);
    damping.loss * heat.iter().sum::<f64>()
}

/// [`advance_damped`] for one node in each lane: from (x, y, vx, vy) and forces to the next (x, y, vx, vy); adds the
/// heat over αΔt.
#[inline(always)]
fn damped_lanes(
    [mut x, mut y, mut vx, mut vy]: [Lanes; 4],
    [fx, fy]: [Lanes; 2],
    [step_over_mass, mass]: [Lanes; 2],
    [free_x, free_y]: [bool; 2],
    drive: Drive,
    damping: &Damping<'_>,
    heat: &mut Lanes,
) -> [Lanes; 4] {
    let frames = damping.frames;
    let (dt, [gx, gy]) = (drive.dt, drive.gravity);
    let (go_x, go_y) = (f64::from(u8::from(free_x)), f64::from(u8::from(free_y)));
    for l in 0..LANES {
        let ux = frames.origin_x[l] - frames.spin[l] * y[l];
        let uy = frames.origin_y[l] + frames.spin[l] * x[l];
        let qx = go_x * damping.velocity(vx[l], ux, fx[l] * step_over_mass[l] + dt * gx);
        let qy = go_y * damping.velocity(vy[l], uy, fy[l] * step_over_mass[l] + dt * gy);
        // Damping acts on, and works with, the velocity between the two half steps.
        let (sx, sy) = (0.5 * (vx[l] + qx), 0.5 * (vy[l] + qy));
        heat[l] += mass[l] * ((sx - ux) * sx + (sy - uy) * sy);
        vx[l] = qx;
        vy[l] = qy;
        x[l] += dt * qx;
        y[l] += dt * qy;
    }
    [x, y, vx, vy]
}

/// Turns nodes about a centre by the exact angle of one step; the reaction is what mass and forces leave over.
#[inline(always)]
fn rotate(nodes: Nodes<'_>, step_over_mass: &[f64], centre: [f64; 2], rate: f64, drive: Drive) -> f64 {
    let Drive { dt, gravity } = drive;
    // cos − 1 without cancellation: the angle of a step is about 1e-6.
    let half = (0.5 * rate * dt).sin();
    let (c1, s) = (-2.0 * half * half, (rate * dt).sin());
    let mut work = 0.0;
    for i in 0..nodes.x.len() {
        let (rx, ry) = (nodes.x[i] - centre[0], nodes.y[i] - centre[1]);
        let (dx, dy) = (c1 * rx - s * ry, s * rx + c1 * ry);
        let (vx, vy) = (dx / dt, dy / dt);
        let m = dt / step_over_mass[i];
        let reaction_x = m * ((vx - nodes.vx[i]) / dt - gravity[0]) - nodes.fx[i];
        let reaction_y = m * ((vy - nodes.vy[i]) / dt - gravity[1]) - nodes.fy[i];
        work += 0.5 * dt * (reaction_x * (vx + nodes.vx[i]) + reaction_y * (vy + nodes.vy[i]));
        nodes.x[i] += dx;
        nodes.y[i] += dy;
        nodes.vx[i] = vx;
        nodes.vy[i] = vy;
        nodes.fx[i] = 0.0;
        nodes.fy[i] = 0.0;
    }
    work
}

/// Where a strip's kernel finds the reference of its i-th element.
trait References: Copy {
    fn at(&self, i: usize) -> QuadReference;
}

#[derive(Clone, Copy)]
struct Same(QuadReference);

impl References for Same {
    #[inline(always)]
    fn at(&self, _: usize) -> QuadReference {
        self.0
    }
}

#[derive(Clone, Copy)]
struct Each<'a> {
    b1x: &'a [f64],
    b1y: &'a [f64],
    b2x: &'a [f64],
    b2y: &'a [f64],
    s1: &'a [f64],
    s2: &'a [f64],
    volume: &'a [f64],
}

impl<'a> Each<'a> {
    #[inline(always)]
    fn new(v: &'a VaryingReferences, start: usize, n: usize) -> Self {
        let cut = |a: &'a [f64]| &a[start..start + n];
        Self {
            b1x: cut(&v.b1x),
            b1y: cut(&v.b1y),
            b2x: cut(&v.b2x),
            b2y: cut(&v.b2y),
            s1: cut(&v.s1),
            s2: cut(&v.s2),
            volume: cut(&v.volume),
        }
    }
}

impl References for Each<'_> {
    #[inline(always)]
    fn at(&self, i: usize) -> QuadReference {
        QuadReference {
            b1: [self.b1x[i], self.b1y[i]],
            b2: [self.b2x[i], self.b2y[i]],
            s1: self.s1[i],
            s2: self.s2[i],
            volume: self.volume[i],
        }
    }
}

#[inline(always)]
#[allow(clippy::too_many_arguments)] // the arrays of one kernel
fn strip_forces(
    strip: &Strip,
    varying: &VaryingReferences,
    stiffness: &Stiffness,
    x: &[f64],
    y: &[f64],
    fx: &mut [f64],
    fy: &mut [f64],
    corner: &mut [[f64; BLOCK]; 8],
) {
    let mut done = 0;
    while done < strip.len {
        let n = (strip.len - done).min(BLOCK);
        let [c1, c2, c3, c4] = strip.corners.map(|c| c as usize + done);
        match strip.references {
            StripReferences::Uniform(q) => block(Same(q), stiffness, x, y, [c1, c2, c3, c4], n, corner),
            StripReferences::Varying(start) => {
                let each = Each::new(varying, start + done, n);
                block(each, stiffness, x, y, [c1, c2, c3, c4], n, corner);
            }
        }
        let [f1x, f2x, f3x, f4x, f1y, f2y, f3y, f4y] = corner;
        add_row(&mut fx[c1..=c1 + n], f1x, f2x);
        add_row(&mut fx[c4..=c4 + n], f4x, f3x);
        add_row(&mut fy[c1..=c1 + n], f1y, f2y);
        add_row(&mut fy[c4..=c4 + n], f4y, f3y);
        done += n;
    }
}

/// Corner forces of up to [`BLOCK`] neighbouring elements.
#[inline(always)]
fn block<R: References>(
    references: R,
    stiffness: &Stiffness,
    x: &[f64],
    y: &[f64],
    c: [usize; 4],
    n: usize,
    corner: &mut [[f64; BLOCK]; 8],
) {
    let xs = c.map(|c| &x[c..c + n]);
    let ys = c.map(|c| &y[c..c + n]);
    let k = *stiffness;
    let [f1x, f2x, f3x, f4x, f1y, f2y, f3y, f4y] = corner;
    let (f1x, f2x, f3x, f4x) = (&mut f1x[..n], &mut f2x[..n], &mut f3x[..n], &mut f4x[..n]);
    let (f1y, f2y, f3y, f4y) = (&mut f1y[..n], &mut f2y[..n], &mut f3y[..n], &mut f4y[..n]);
    for i in 0..n {
        let px = [xs[0][i], xs[1][i], xs[2][i], xs[3][i]];
        let py = [ys[0][i], ys[1][i], ys[2][i], ys[3][i]];
        let [f1, f2, f3, f4] = quad_forces(px, py, &references.at(i), &k);
        f1x[i] = f1[0];
        f2x[i] = f2[0];
        f3x[i] = f3[0];
        f4x[i] = f4[0];
        f1y[i] = f1[1];
        f2y[i] = f2[1];
        f3y[i] = f3[1];
        f4y[i] = f4[1];
    }
}

/// Adds to a row of n + 1 nodes what its n elements push at their left and right corners.
#[inline(always)]
fn add_row(f: &mut [f64], left: &[f64; BLOCK], right: &[f64; BLOCK]) {
    let n = f.len() - 1;
    f[0] += left[0];
    let (middle, l, r) = (&mut f[1..n], &left[1..n], &right[..n - 1]);
    for i in 0..middle.len() {
        middle[i] += l[i] + r[i];
    }
    f[n] += right[n - 1];
}

/// The gather path: elements one by one.
#[inline(always)]
fn single_elements(tile: &Tile, x: &[f64], y: &[f64], fx: &mut [f64], fy: &mut [f64]) {
    for (corners, reference) in &tile.quads {
        let c = corners.map(|c| c as usize);
        let f = quad_forces(c.map(|c| x[c]), c.map(|c| y[c]), reference, &tile.stiffness);
        for (c, f) in c.into_iter().zip(f) {
            fx[c] += f[0];
            fy[c] += f[1];
        }
    }
    for (corners, reference) in &tile.triangles {
        let c = corners.map(|c| c as usize);
        let [f1, f2] = triangle_forces(c.map(|c| x[c]), c.map(|c| y[c]), reference, &tile.stiffness);
        fx[c[0]] += f1[0];
        fy[c[0]] += f1[1];
        fx[c[1]] += f2[0];
        fy[c[1]] += f2[1];
        fx[c[2]] -= f1[0] + f2[0];
        fy[c[2]] -= f1[1] + f2[1];
    }
}

type Lanes = [f64; LANES];

#[inline(always)]
fn lanes(v: &[f64], at: usize) -> &Lanes {
    v[at..at + LANES].try_into().expect("a slice of LANES values")
}

#[inline(always)]
fn lanes_mut(v: &mut [f64], at: usize) -> &mut Lanes {
    (&mut v[at..at + LANES]).try_into().expect("a slice of LANES values")
}

#[inline(always)]
fn add_lanes(v: &mut [f64], at: usize, f: &Lanes) {
    let v = lanes_mut(v, at);
    for l in 0..LANES {
        v[l] += f[l];
    }
}

/// The same quadrilateral of [`LANES`] congruent bodies at a time.
#[inline(always)]
fn congruent_quads(tile: &Tile, x: &[f64], y: &[f64], fx: &mut [f64], fy: &mut [f64]) {
    let k = tile.stiffness;
    for (corners, reference) in &tile.quads {
        let c = corners.map(|c| c as usize);
        let xs = c.map(|c| lanes(x, c));
        let ys = c.map(|c| lanes(y, c));
        let ([mut f1x, mut f2x, mut f3x, mut f4x], [mut f1y, mut f2y, mut f3y, mut f4y]) =
            ([[0.0; LANES]; 4], [[0.0; LANES]; 4]);
        for l in 0..LANES {
            let px = [xs[0][l], xs[1][l], xs[2][l], xs[3][l]];
            let py = [ys[0][l], ys[1][l], ys[2][l], ys[3][l]];
            let [f1, f2, f3, f4] = quad_forces(px, py, reference, &k);
            [f1x[l], f2x[l], f3x[l], f4x[l]] = [f1[0], f2[0], f3[0], f4[0]];
            [f1y[l], f2y[l], f3y[l], f4y[l]] = [f1[1], f2[1], f3[1], f4[1]];
        }
        for (c, f) in c.into_iter().zip([&f1x, &f2x, &f3x, &f4x]) {
            add_lanes(fx, c, f);
        }
        for (c, f) in c.into_iter().zip([&f1y, &f2y, &f3y, &f4y]) {
            add_lanes(fy, c, f);
        }
    }
}

/// The same triangle of [`LANES`] congruent bodies at a time.
#[inline(always)]
fn congruent_triangles(tile: &Tile, x: &[f64], y: &[f64], fx: &mut [f64], fy: &mut [f64]) {
    let k = tile.stiffness;
    for (corners, reference) in &tile.triangles {
        let c = corners.map(|c| c as usize);
        let xs = c.map(|c| lanes(x, c));
        let ys = c.map(|c| lanes(y, c));
        let ([mut f1x, mut f2x, mut f3x], [mut f1y, mut f2y, mut f3y]) =
            ([[0.0; LANES]; 3], [[0.0; LANES]; 3]);
        for l in 0..LANES {
            let px = [xs[0][l], xs[1][l], xs[2][l]];
            let py = [ys[0][l], ys[1][l], ys[2][l]];
            let [f1, f2] = triangle_forces(px, py, reference, &k);
            [f1x[l], f2x[l], f3x[l]] = [f1[0], f2[0], -f1[0] - f2[0]];
            [f1y[l], f2y[l], f3y[l]] = [f1[1], f2[1], -f1[1] - f2[1]];
        }
        for (c, f) in c.into_iter().zip([&f1x, &f2x, &f3x]) {
            add_lanes(fx, c, f);
        }
        for (c, f) in c.into_iter().zip([&f1y, &f2y, &f3y]) {
            add_lanes(fy, c, f);
        }
    }
}
