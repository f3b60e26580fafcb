//! Static equilibrium under loads and contact, the start of a run without ringing (THEORY §3).
//!
//! Newton's method on the positions with a sparse Cholesky factorisation. Bodies that nothing holds yet are slowed
//! by a mass-proportional term as large as their own unbalanced force asks for, which vanishes at equilibrium.
//! Motions that statics cannot decide (a rolling body along its track) are left to inertia: their unbalanced force
//! is spread over the mass as in a free fall, so nothing rings when the run begins.

use faer::{
    Mat, Par, Side,
    linalg::solvers::Solve,
    sparse::{
        SparseColMat, Triplet,
        linalg::solvers::{Llt, SymbolicLlt},
        ops::add,
    },
};

use crate::{
    block::Block,
    dynamics::Dynamics,
    element::{QuadReference, Stiffness, TriangleReference},
    error::Error,
    force::Force,
    rigid::RigidMotion,
    state::{Moment, NodeForces},
};

/// A rigid motion of one body that statics leaves alone.
#[derive(Debug, Clone)]
pub struct Undecided {
    /// Slots of the body.
    pub slots: Vec<u32>,
    /// Translation along this direction, if any.
    pub along: Option<[f64; 2]>,
    /// Rotation about the centre of mass.
    pub rotation: bool,
}

/// Mass-proportional stiffness [1/s²] along the track of an undecided motion while the iteration runs.
const TRACK_HOLD: f64 = 1e10;

/// The same for a motion that is a rotation alone: a ring bends at lower frequencies than a disc.
const TURN_HOLD: f64 = 1e7;

/// What to solve.
#[derive(Debug, Clone)]
pub struct Statics {
    /// Slots of each elastic body, with its name.
    pub bodies: Vec<(String, Vec<u32>)>,
    /// Motions left to inertia.
    pub undecided: Vec<Undecided>,
    /// Acceleration of each slot in the motion that follows [m/s²] (d'Alembert); empty for none.
    pub acceleration: Vec<[f64; 2]>,
    /// Farthest that a body may move as a whole in one iteration [m].
    pub longest_step: f64,
    /// Unbalanced force allowed on the worst node [N].
    pub tolerance: f64,
    /// Most iterations.
    pub iterations: usize,
}

/// How the iteration went.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Equilibrium {
    /// Newton iterations.
    pub iterations: usize,
    /// Largest unbalanced force on a node [N].
    pub residual: f64,
}

/// Least mass-proportional stiffness [1/s²]: keeps the matrix definite where nothing else does.
const LEAST_HOLD: f64 = 1e5;

/// Finds static equilibria of one model; the elastic stiffness is assembled once for all of them.
pub struct Equilibrator {
    unknowns: Unknowns,
    elastic: Matrix,
    factor: Option<Factor>,
}

impl std::fmt::Debug for Equilibrator {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Equilibrator").field("equations", &self.unknowns.equations).finish_non_exhaustive()
    }
}

/// A factorisation serves until an iteration leaves more than this share of the unbalanced force.
const GOOD_ENOUGH: f64 = 0.6;

impl Equilibrator {
    /// Assembles the elastic stiffness at the present positions.
    ///
    /// # Errors
    /// When memory runs out.
    pub fn new(dynamics: &Dynamics) -> Result<Self, Error> {
        let unknowns = Unknowns::new(dynamics);
        let elastic = unknowns.elastic(dynamics)?;
        Ok(Self { unknowns, elastic, factor: None })
    }

    /// Moves the nodes of `dynamics`, the model of [`Equilibrator::new`], to static equilibrium. The step and time
    /// stay; velocities are not used.
    ///
    /// # Errors
    /// When the iteration does not converge or the matrix cannot be factorised.
    pub fn equilibrate(
        &mut self,
        dynamics: &mut Dynamics,
        forces: &mut [&mut dyn Force],
        statics: &Statics,
    ) -> Result<Equilibrium, Error> {
        let mut residual = Residual::new(dynamics);
        residual.evaluate(dynamics, forces, statics);
        let mut iterations = 0;
        let mut before = 0.0;
        loop {
            let (worst, at) = residual.worst(&self.unknowns);
            if worst <= statics.tolerance {
                return Ok(Equilibrium { iterations, residual: worst });
            }
            if iterations == statics.iterations || !worst.is_finite() {
                return Err(no_equilibrium(dynamics, statics, iterations, worst, at));
            }
            if self.factor.is_none() || iterations == 0 || worst > GOOD_ENOUGH * before {
                self.factor = None;
                self.factor =
                    Some(self.unknowns.factorise(dynamics, forces, statics, &residual, &self.elastic)?);
            }
            let Some(factor) = &self.factor else { continue };
            let step = self.unknowns.step(dynamics, statics, &residual, factor);
            dynamics.search_along(forces, statics, &mut residual, &self.unknowns, &step);
            before = worst;
            iterations += 1;
        }
    }
}

impl Dynamics {
    /// Moves the nodes to static equilibrium, see [`Equilibrator::equilibrate`].
    ///
    /// # Errors
    /// When the iteration does not converge or the matrix cannot be factorised.
    pub fn equilibrate(
        &mut self,
        forces: &mut [&mut dyn Force],
        statics: &Statics,
    ) -> Result<Equilibrium, Error> {
        Equilibrator::new(self)?.equilibrate(self, forces, statics)
    }

    /// Goes along `step` to where the residual no longer points along it.
    fn search_along(
        &mut self,
        forces: &mut [&mut dyn Force],
        statics: &Statics,
        residual: &mut Residual,
        unknowns: &Unknowns,
        step: &[[f64; 2]],
    ) {
        let start: Vec<[f64; 2]> =
            unknowns.slots.iter().map(|&s| [self.state.x[s as usize], self.state.y[s as usize]]).collect();
        let slope0 = residual.along(unknowns, step);
        let (mut low, mut slope_low) = (0.0, slope0);
        let (mut factor, mut high) = (1.0, f64::INFINITY);
        for _ in 0..12 {
            for (i, &s) in unknowns.slots.iter().enumerate() {
                self.state.x[s as usize] = start[i][0] + factor * step[i][0];
                self.state.y[s as usize] = start[i][1] + factor * step[i][1];
            }
            residual.evaluate(self, forces, statics);
            let slope = residual.along(unknowns, step);
            // The potential is convex along a line: its slope falls through zero once.
            if slope.abs() <= 0.5 * slope0.abs() || (slope > 0.0 && high.is_infinite()) {
                return;
            }
            if slope < 0.0 {
                high = factor;
                let secant = low + (factor - low) * slope_low / (slope_low - slope);
                factor = secant.clamp(low + 0.1 * (high - low), high - 0.1 * (high - low));
            } else {
                low = factor;
                slope_low = slope;
                factor = 0.5 * (low + high);
            }
        }
    }
}

fn no_equilibrium(d: &Dynamics, statics: &Statics, iterations: usize, residual_n: f64, slot: usize) -> Error {
    let body = statics.bodies.iter().find(|(_, slots)| slots.contains(&(slot as u32)));
    Error::NoEquilibrium {
        iterations,
        residual_n,
        allowed_n: statics.tolerance,
        body: body.map_or_else(String::new, |(name, _)| name.clone()),
        x_mm: 1e3 * d.state.x[slot],
        y_mm: 1e3 * d.state.y[slot],
        advice: "check that the load can reach a support through bodies that touch; try a smaller load, a softer \
                 contact or a start without preload",
    }
}

/// Unbalanced forces.
struct Residual {
    force: NodeForces,
}

impl Residual {
    fn new(d: &Dynamics) -> Self {
        let n = d.state.x.len();
        Self { force: NodeForces::zeros(n) }
    }

    fn evaluate(&mut self, d: &Dynamics, forces: &mut [&mut dyn Force], statics: &Statics) {
        let NodeForces { fx, fy } = &mut self.force;
        fx.fill(0.0);
        fy.fill(0.0);
        let at = Moment { dt: 0.0, ..d.moment() };
        for f in forces {
            f.accumulate(at, &mut self.force);
        }
        let NodeForces { fx, fy } = &mut self.force;
        d.elastic_forces(&d.state.x, &d.state.y, fx, fy);
        let (mass, [gx, gy]) = (d.mass(), d.gravity());
        for (_, slots) in &statics.bodies {
            for &s in slots {
                let s = s as usize;
                let [ax, ay] = statics.acceleration.get(s).copied().unwrap_or_default();
                fx[s] += mass[s] * (gx - ax);
                fy[s] += mass[s] * (gy - ay);
            }
        }
        for motion in &statics.undecided {
            motion.take_from_forces(d, fx, fy);
        }
    }

    fn worst(&self, unknowns: &Unknowns) -> (f64, usize) {
        let mut worst = (0.0, 0);
        for (i, &s) in unknowns.slots.iter().enumerate() {
            let s = s as usize;
            for (c, f) in [self.force.fx[s], self.force.fy[s]].into_iter().enumerate() {
                if unknowns.number[i][c].is_some() && (f.abs() > worst.0 || f.is_nan()) {
                    worst = (f.abs(), s);
                }
            }
        }
        worst
    }

    fn along(&self, unknowns: &Unknowns, step: &[[f64; 2]]) -> f64 {
        let f = &self.force;
        unknowns.slots.iter().zip(step).map(|(&s, d)| f.fx[s as usize] * d[0] + f.fy[s as usize] * d[1]).sum()
    }
}

impl Undecided {
    fn centre(&self, d: &Dynamics) -> [f64; 2] {
        let s = &d.state;
        RigidMotion::of(
            self.slots.iter().map(|&n| (d.mass()[n as usize], [s.x[n as usize], s.y[n as usize]], [0.0; 2])),
        )
        .centre
    }

    /// The modes as fields over the slots, mass-orthogonal by construction (translation of the centre, rotation
    /// about it): calls `f` with each slot's direction and the mode's mass.
    fn modes(&self, d: &Dynamics) -> Vec<(Vec<[f64; 2]>, f64)> {
        let s = &d.state;
        let body = RigidMotion::of(
            self.slots.iter().map(|&n| (d.mass()[n as usize], [s.x[n as usize], s.y[n as usize]], [0.0; 2])),
        );
        let mut modes = Vec::new();
        if let Some(direction) = self.along {
            modes.push((vec![direction; self.slots.len()], body.mass));
        }
        if self.rotation {
            let turn = |&n: &u32| [body.centre[1] - s.y[n as usize], s.x[n as usize] - body.centre[0]];
            modes.push((self.slots.iter().map(turn).collect(), body.inertia));
        }
        modes
    }

    /// Spreads the resultant along each mode over the mass: what is left does not move it.
    fn take_from_forces(&self, d: &Dynamics, fx: &mut [f64], fy: &mut [f64]) {
        for (mode, inertia) in self.modes(d) {
            let resultant: f64 = self
                .slots
                .iter()
                .zip(&mode)
                .map(|(&n, m)| fx[n as usize] * m[0] + fy[n as usize] * m[1])
                .sum();
            let a = resultant / inertia;
            for (&n, m) in self.slots.iter().zip(&mode) {
                fx[n as usize] -= d.mass()[n as usize] * a * m[0];
                fy[n as usize] -= d.mass()[n as usize] * a * m[1];
            }
        }
    }

    /// Removes the mode from a displacement field.
    fn take_from_step(&self, d: &Dynamics, step: &mut [[f64; 2]], index: &[u32]) {
        for (mode, inertia) in self.modes(d) {
            let weighted = |(&n, m): (&u32, &[f64; 2])| {
                let u = step[index[n as usize] as usize];
                d.mass()[n as usize] * (u[0] * m[0] + u[1] * m[1])
            };
            let a = self.slots.iter().zip(&mode).map(weighted).sum::<f64>() / inertia;
            for (&n, m) in self.slots.iter().zip(&mode) {
                let u = &mut step[index[n as usize] as usize];
                u[0] -= a * m[0];
                u[1] -= a * m[1];
            }
        }
    }
}

/// Numbering of what is solved for.
struct Unknowns {
    /// Slots that may move.
    slots: Vec<u32>,
    /// Position in `slots` of each slot.
    index: Vec<u32>,
    /// Equation of (x, y) of each of them.
    number: Vec<[Option<usize>; 2]>,
    equations: usize,
}

type Matrix = SparseColMat<usize, f64>;
type Factor = Llt<usize, f64>;

/// Strain of one mode [1/m] that a unit displacement of a node gives, from its shape gradient and the component.
type StrainOf = fn([f64; 2], usize) -> f64;

impl Unknowns {
    fn new(d: &Dynamics) -> Self {
        let mut unknowns = Self {
            slots: Vec::new(),
            index: vec![u32::MAX; d.state.x.len()],
            number: Vec::new(),
            equations: 0,
        };
        for slot in d.elastic_slots() {
            let free = d.free_components(slot);
            if free == [false; 2] {
                continue;
            }
            let number = free.map(|f| {
                f.then(|| {
                    unknowns.equations += 1;
                    unknowns.equations - 1
                })
            });
            unknowns.index[slot] = unknowns.slots.len() as u32;
            unknowns.slots.push(slot as u32);
            unknowns.number.push(number);
        }
        unknowns
    }

    /// Equation of a component of the nodes' displacements, if it is free.
    fn equation(&self, nodes: &[u32], component: usize) -> Option<usize> {
        let index = self.index[nodes[component / 2] as usize];
        if index == u32::MAX { None } else { self.number[index as usize][component % 2] }
    }

    /// Pushes k · d dᵀ (lower triangle).
    fn rank_one(&self, nodes: &[u32], direction: &[f64], k: f64, out: &mut Vec<Triplet<usize, usize, f64>>) {
        for i in 0..direction.len() {
            let Some(row) = self.equation(nodes, i).filter(|_| direction[i] != 0.0) else { continue };
            for j in 0..direction.len() {
                let Some(col) = self.equation(nodes, j).filter(|_| direction[j] != 0.0) else { continue };
                if row >= col {
                    out.push(Triplet { row, col, val: k * direction[i] * direction[j] });
                }
            }
        }
    }

    fn matrix(&self, triplets: &[Triplet<usize, usize, f64>]) -> Result<Matrix, Error> {
        Matrix::try_new_from_triplets(self.equations, self.equations, triplets)
            .map_err(|e| Error::Factorisation(format!("{e:?}")))
    }

    /// Elastic stiffness at the present positions, lower triangle.
    fn elastic(&self, d: &Dynamics) -> Result<Matrix, Error> {
        let (x, y) = (&d.state.x, &d.state.y);
        let corner = |n: u32| [x[n as usize], y[n as usize]];
        let elements = d.elements();
        let mut triplets = Vec::with_capacity(40 * elements.quads.len());
        for body in &elements.bodies {
            for (nodes, reference) in &elements.quads[body.quads.clone()] {
                self.quad(nodes, nodes.map(corner), reference, &body.stiffness, &mut triplets);
            }
            for (nodes, reference) in &elements.triangles[body.triangles.clone()] {
                self.triangle(nodes, nodes.map(corner), reference, &body.stiffness, &mut triplets);
            }
        }
        self.matrix(&triplets)
    }

    fn quad(
        &self,
        nodes: &[u32; 4],
        c: [[f64; 2]; 4],
        reference: &QuadReference,
        k: &Stiffness,
        out: &mut Vec<Triplet<usize, usize, f64>>,
    ) {
        let twice = (c[2][0] - c[0][0]) * (c[3][1] - c[1][1]) - (c[3][0] - c[1][0]) * (c[2][1] - c[0][1]);
        let b1 = [(c[1][1] - c[3][1]) / twice, (c[3][0] - c[1][0]) / twice];
        let b2 = [(c[2][1] - c[0][1]) / twice, (c[0][0] - c[2][0]) / twice];
        let b = [b1, b2, [-b1[0], -b1[1]], [-b2[0], -b2[1]]];
        self.strain_modes(nodes, &b, reference.volume, k, out);
        if k.hourglass > 0.0 {
            let gamma = [1.0 - reference.s1, -1.0 - reference.s2, 1.0 + reference.s1, -1.0 + reference.s2];
            for component in 0..2 {
                let direction: [f64; 8] =
                    std::array::from_fn(|i| if i % 2 == component { gamma[i / 2] } else { 0.0 });
                self.rank_one(nodes, &direction, k.hourglass, out);
            }
        }
    }

    fn triangle(
        &self,
        nodes: &[u32; 3],
        c: [[f64; 2]; 3],
        reference: &TriangleReference,
        k: &Stiffness,
        out: &mut Vec<Triplet<usize, usize, f64>>,
    ) {
        let twice = (c[1][0] - c[0][0]) * (c[2][1] - c[0][1]) - (c[2][0] - c[0][0]) * (c[1][1] - c[0][1]);
        let gradient = |i: usize| {
            let (p, q) = (c[(i + 1) % 3], c[(i + 2) % 3]);
            [(p[1] - q[1]) / twice, (q[0] - p[0]) / twice]
        };
        self.strain_modes(nodes, &[gradient(0), gradient(1), gradient(2)], reference.volume, k, out);
    }

    /// Plane-strain stiffness as a sum of rank-one pieces: dilatation, two shears.
    fn strain_modes<const N: usize>(
        &self,
        nodes: &[u32; N],
        b: &[[f64; 2]; N],
        volume: f64,
        k: &Stiffness,
        out: &mut Vec<Triplet<usize, usize, f64>>,
    ) {
        // λ tr² + 2µ (exx² + eyy² + 2 exy²) = (λ + µ)(exx + eyy)² + µ (exx − eyy)² + µ (2 exy)².
        let shear = 0.5 * k.two_shear;
        let modes: [(StrainOf, f64); 3] = [
            (|b, c| b[c], k.lame + shear),
            (|b, c| if c == 0 { b[0] } else { -b[1] }, shear),
            (|b, c| b[1 - c], shear),
        ];
        for (mode, stiffness) in modes {
            let mut direction = [0.0; 8];
            for i in 0..2 * N {
                direction[i] = mode(b[i / 2], i % 2);
            }
            self.rank_one(nodes, &direction[..2 * N], stiffness * volume, out);
        }
    }

    /// Factorises the tangent stiffness at the present positions.
    fn factorise(
        &self,
        d: &Dynamics,
        forces: &[&mut dyn Force],
        statics: &Statics,
        residual: &Residual,
        elastic: &Matrix,
    ) -> Result<Factor, Error> {
        let mut triplets = Vec::new();
        let mut block = Block::default();
        for f in forces {
            f.tangent(&d.state.x, &d.state.y, &mut |r| {
                if block.nodes() != r.nodes {
                    block.hand_over(|nodes, i| self.equation(nodes, i), &mut triplets);
                    block.begin(r.nodes);
                }
                block.add(r.direction, r.stiffness);
            });
        }
        block.hand_over(|nodes, i| self.equation(nodes, i), &mut triplets);
        for (_, slots) in &statics.bodies {
            let hold = hold(d, slots, &residual.force, statics.longest_step);
            for &s in slots {
                let index = self.index[s as usize];
                if index == u32::MAX {
                    continue;
                }
                for row in self.number[index as usize].into_iter().flatten() {
                    triplets.push(Triplet { row, col: row, val: hold * d.mass()[s as usize] });
                }
            }
        }
        for motion in &statics.undecided {
            let centre = motion.centre(d);
            // Springs along the track hold translation and rotation without resisting anything across it. They
            // must be soft against the body's elasticity, or they would hide it from the iteration.
            for &s in &motion.slots {
                let n = s as usize;
                let (direction, hold) = match motion.along {
                    Some(along) => (along, TRACK_HOLD),
                    None => {
                        let r = [d.state.x[n] - centre[0], d.state.y[n] - centre[1]];
                        let length = r[0].hypot(r[1]).max(f64::MIN_POSITIVE);
                        ([-r[1] / length, r[0] / length], TURN_HOLD)
                    }
                };
                self.rank_one(&[s], &direction, hold * d.mass()[n], &mut triplets);
            }
        }
        let other = self.matrix(&triplets)?;
        let failed = |e: &dyn std::fmt::Debug| Error::Factorisation(format!("{e:?}"));
        let matrix = add(elastic.as_ref(), other.as_ref()).map_err(|e| failed(&e))?;
        // One thread: the factorisation's bits then do not depend on how many there are.
        faer::set_global_parallelism(Par::Seq);
        let symbolic = SymbolicLlt::try_new(matrix.symbolic(), Side::Lower).map_err(|e| failed(&e))?;
        Llt::try_new_with_symbolic(symbolic, matrix.as_ref(), Side::Lower).map_err(|e| failed(&e))
    }

    /// One Newton step for the present residual.
    fn step(&self, d: &Dynamics, statics: &Statics, residual: &Residual, factor: &Factor) -> Vec<[f64; 2]> {
        let mut rhs = Mat::<f64>::zeros(self.equations, 1);
        for (&s, number) in self.slots.iter().zip(&self.number) {
            let f = [residual.force.fx[s as usize], residual.force.fy[s as usize]];
            for c in 0..2 {
                if let Some(row) = number[c] {
                    rhs[(row, 0)] = f[c];
                }
            }
        }
        factor.solve_in_place(&mut rhs);
        let mut step: Vec<[f64; 2]> =
            self.number.iter().map(|number| number.map(|n| n.map_or(0.0, |row| rhs[(row, 0)]))).collect();
        for motion in &statics.undecided {
            motion.take_from_step(d, &mut step, &self.index);
        }
        step
    }
}

/// Mass-proportional stiffness [1/s²] that keeps a body's unbalanced resultant from moving it farther than `step`.
fn hold(d: &Dynamics, slots: &[u32], force: &NodeForces, step: f64) -> f64 {
    let s = &d.state;
    let body = RigidMotion::of(
        slots.iter().map(|&n| (d.mass()[n as usize], [s.x[n as usize], s.y[n as usize]], [0.0; 2])),
    );
    let (mut fx, mut fy, mut torque) = (0.0, 0.0, 0.0);
    for &n in slots {
        let n = n as usize;
        let [free_x, free_y] = d.free_components(n);
        let (px, py) = (if free_x { force.fx[n] } else { 0.0 }, if free_y { force.fy[n] } else { 0.0 });
        fx += px;
        fy += py;
        torque += (s.x[n] - body.centre[0]) * py - (s.y[n] - body.centre[1]) * px;
    }
    let gyration = (body.inertia / body.mass).sqrt();
    let push = (fx.hypot(fy)).max(torque.abs() / gyration);
    (push / (body.mass * step)).max(LEAST_HOLD)
}
