//! Critical time step from the largest natural frequency of the whole model, contact included (THEORY §2.4).

use crate::{
    dynamics::Dynamics,
    force::{Force, RankOne},
};

/// Result of the frequency iteration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Critical {
    /// Critical time step 2 / ω_max [s], ω_max taken at its upper bound.
    pub time_step: f64,
    /// Upper bound of the largest natural frequency [rad/s].
    pub frequency: f64,
    /// Lanczos iterations.
    pub iterations: usize,
    /// Bound of the error of ω², relative.
    pub residual: f64,
}

/// Relative residual of ω² at which the iteration stops.
const ACCURACY: f64 = 2e-3;

/// Most Lanczos iterations.
const ITERATIONS: usize = 400;

/// Displacement of a probe over the shortest edge: strains of about 1e-6, where the response is linear and
/// rounding is 1e-8 of it.
const PROBE: f64 = 2e-6;

/// Far from the origin positions round to more than that; a probe is this many of their last digits at least.
const DIGITS: f64 = 1e5;

/// Critical time step [s] under stiffness damping `beta` [s] of all stiffness, from the undamped one [s]
/// (THEORY §2.7).
pub fn damped_time_step(undamped: f64, beta: f64) -> f64 {
    if beta > 0.0 { undamped * undamped / (beta + libm::hypot(beta, undamped)) } else { undamped }
}

impl Dynamics {
    /// Critical time step of elements and forces at the present positions.
    ///
    /// The largest eigenvalue of M⁻½ (K + D) M⁻½ by Lanczos iteration, where D bounds the stiffness of the
    /// forces in any configuration ([`Force::stiffness_bound`]) for the time step `dt` (used for damping
    /// terms, zero leaves them out). Rigid bodies have no K: D over their mass and inertia bounds theirs.
    /// Infinite when nothing has stiffness. Stiffness damping makes K larger by 1 + 2β/`dt`;
    /// [`damped_time_step`] guesses that `dt`. Structural damping makes it larger by the stiffness of its
    /// branches.
    pub fn critical_time_step(&self, forces: &[&dyn Force], dt: f64) -> Critical {
        let mut bound = vec![0.0; self.state.x.len()];
        forces.iter().for_each(|f| f.stiffness_bound(dt, &mut bound));
        let rigid = self.rigid_frequency_bound(&bound).sqrt();
        let free: Vec<usize> = self.elastic_slots();
        let mut operator = Operator::new(self, bound, free, Vec::new());
        if dt > 0.0 {
            let damping = 2.0 * self.stiffness_damping() / dt;
            operator.stiffer.iter_mut().for_each(|stiffer| *stiffer += damping);
        }
        let elastic = operator.largest();
        // D couples no two bodies, so the larger of the two is that of the whole.
        if elastic.frequency >= rigid {
            return elastic;
        }
        Critical { time_step: 2.0 / rigid, frequency: rigid, residual: 0.0, ..elastic }
    }

    /// Critical time step of the elements with the *present* stiffness of the forces, at the positions last
    /// given to them: sharp, but good for this configuration alone. Damping and rigid bodies are left out.
    pub fn present_critical_time_step(&self, forces: &[&dyn Force]) -> Critical {
        let mut springs = Vec::new();
        let (x, y) = (&self.state.x, &self.state.y);
        forces.iter().for_each(|f| f.tangent(x, y, &mut |piece| springs.push(Spring::new(&piece))));
        Operator::new(self, vec![0.0; self.state.x.len()], self.elastic_slots(), springs).largest()
    }
}

struct Operator<'a> {
    dynamics: &'a Dynamics,
    bound: Vec<f64>,
    free: Vec<usize>,
    answers: Vec<bool>,
    /// Displacement of a probe [m].
    probe: f64,
    /// Factor of K at each of `free`.
    stiffer: Vec<f64>,
    springs: Vec<Spring>,
}

/// A piece of stiffness.
struct Spring {
    /// Slots; in an operator places in `free`, none for those that do not answer to forces.
    nodes: Vec<Option<usize>>,
    direction: Vec<f64>,
    stiffness: f64,
}

impl Spring {
    fn new(piece: &RankOne<'_>) -> Self {
        let nodes = piece.nodes.iter().map(|&n| Some(n as usize)).collect();
        Self { nodes, direction: piece.direction.to_vec(), stiffness: piece.stiffness }
    }
}

/// Positions and forces of a probe.
#[derive(Default, Clone)]
struct Probe {
    x: Vec<f64>,
    y: Vec<f64>,
}

impl<'a> Operator<'a> {
    fn new(dynamics: &'a Dynamics, bound: Vec<f64>, free: Vec<usize>, mut springs: Vec<Spring>) -> Self {
        let mut place = vec![None; dynamics.state.x.len()];
        free.iter().enumerate().for_each(|(i, &s)| place[s] = Some(i));
        let nodes = springs.iter_mut().flat_map(|s| &mut s.nodes);
        nodes.for_each(|n| *n = n.and_then(|slot| place[slot]));
        let answers =
            (0..2).flat_map(|k| free.iter().map(move |&s| dynamics.free_components(s)[k])).collect();
        let stiffening = dynamics.stiffening();
        let stiffer = free.iter().map(|&s| stiffening[s]).collect();
        Self { dynamics, bound, free, answers, probe: probe(dynamics), stiffer, springs }
    }

    /// out = M⁻½ (K + D) M⁻½ v, with K from central differences of the elastic forces.
    fn apply(&self, v: &[f64], out: &mut [f64], at: &mut Probe, force: &mut [Probe; 2]) {
        let d = self.dynamics;
        let (mass, n) = (d.mass(), self.free.len());
        let largest = v.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
        let lightest = self.free.iter().map(|&s| mass[s]).fold(f64::INFINITY, f64::min);
        let h = self.probe * lightest.sqrt() / largest;
        for (side, sign) in force.iter_mut().zip([1.0, -1.0]) {
            at.x.copy_from_slice(&d.state.x);
            at.y.copy_from_slice(&d.state.y);
            for (i, &s) in self.free.iter().enumerate() {
                let scale = sign * h / mass[s].sqrt();
                at.x[s] += scale * v[i];
                at.y[s] += scale * v[n + i];
            }
            side.x.fill(0.0);
            side.y.fill(0.0);
            d.elastic_forces(&at.x, &at.y, &mut side.x, &mut side.y);
        }
        let [plus, minus] = force;
        for (i, &s) in self.free.iter().enumerate() {
            let root = mass[s].sqrt();
            let diagonal = self.bound[s] / mass[s];
            let stiffness = self.stiffer[i] / (2.0 * h * root);
            out[i] = (minus.x[s] - plus.x[s]) * stiffness + diagonal * v[i];
            out[n + i] = (minus.y[s] - plus.y[s]) * stiffness + diagonal * v[n + i];
        }
        for Spring { nodes, direction, stiffness } in &self.springs {
            let component = |k: usize| nodes[k / 2].map(|i| (i + (k % 2) * n, mass[self.free[i]].sqrt()));
            let each = 0..direction.len();
            let parts =
                || each.clone().filter_map(|k| component(k).map(|(at, root)| (at, direction[k] / root)));
            let stretch: f64 = parts().map(|(at, d)| d * v[at]).sum();
            parts().for_each(|(at, d)| out[at] += stiffness * d * stretch);
        }
        out.iter_mut().zip(&self.answers).filter(|(_, answers)| !**answers).for_each(|(o, _)| *o = 0.0);
    }

    fn largest(&self) -> Critical {
        let n = 2 * self.free.len();
        if !self.answers.contains(&true) {
            return Critical { time_step: f64::INFINITY, frequency: 0.0, iterations: 0, residual: 0.0 };
        }
        let slots = self.dynamics.state.x.len();
        let field = || Probe { x: vec![0.0; slots], y: vec![0.0; slots] };
        let (mut at, mut force) = (field(), [field(), field()]);
        // A fixed start vector of pseudo-random numbers has a part along every mode.
        let mut seed = 0x2545_f491_4f6c_dd1d_u64;
        let mut v: Vec<f64> = (0..n)
            .map(|_| {
                seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                (seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
            })
            .collect();
        v.iter_mut().zip(&self.answers).filter(|(_, answers)| !**answers).for_each(|(v, _)| *v = 0.0);
        normalise(&mut v);
        let (mut before, mut w) = (vec![0.0; n], vec![0.0; n]);
        let (mut alpha, mut beta) = (Vec::new(), Vec::new());
        let mut critical =
            Critical { time_step: f64::NAN, frequency: f64::NAN, iterations: 0, residual: 1.0 };
        for k in 1..=ITERATIONS.min(n) {
            self.apply(&v, &mut w, &mut at, &mut force);
            let last_beta = beta.last().copied().unwrap_or(0.0);
            let a: f64 = w.iter().zip(&v).map(|(p, q)| p * q).sum();
            for i in 0..n {
                w[i] -= a * v[i] + last_beta * before[i];
            }
            alpha.push(a);
            let b = w.iter().map(|p| p * p).sum::<f64>().sqrt();
            let (value, tail) = largest_of_tridiagonal(&alpha, &beta);
            let residual = b * tail.abs() / value;
            let frequency = (value * (1.0 + residual)).sqrt();
            critical = Critical { time_step: 2.0 / frequency, frequency, iterations: k, residual };
            if residual < ACCURACY || b <= 1e-12 * value {
                break;
            }
            beta.push(b);
            before.copy_from_slice(&v);
            v.iter_mut().zip(&w).for_each(|(v, w)| *v = w / b);
        }
        critical
    }
}

/// Displacement [m] that is small in the smallest element, and large against rounding.
fn probe(dynamics: &Dynamics) -> f64 {
    let (x, y) = (&dynamics.state.x, &dynamics.state.y);
    let (mut shortest, mut farthest) = (f64::INFINITY, 0.0_f64);
    let mut take = |corners: &[u32]| {
        for (i, &a) in corners.iter().enumerate() {
            let (a, b) = (a as usize, corners[(i + 1) % corners.len()] as usize);
            shortest = shortest.min(libm::hypot(x[b] - x[a], y[b] - y[a]));
            farthest = farthest.max(x[a].abs().max(y[a].abs()));
        }
    };
    let elements = dynamics.elements();
    elements.quads.iter().for_each(|(c, _)| take(c));
    elements.triangles.iter().for_each(|(c, _)| take(c));
    (PROBE * shortest).max(DIGITS * f64::EPSILON * farthest)
}

fn normalise(v: &mut [f64]) {
    let length = v.iter().map(|p| p * p).sum::<f64>().sqrt();
    v.iter_mut().for_each(|p| *p /= length);
}

/// Largest eigenvalue of a symmetric tridiagonal matrix, by bisection on the sign count, and the last
/// component of its unit eigenvector.
fn largest_of_tridiagonal(alpha: &[f64], beta: &[f64]) -> (f64, f64) {
    let n = alpha.len();
    let off = |i: usize| if i == 0 || i > beta.len() { 0.0 } else { beta[i - 1] };
    let (mut low, mut high) = (f64::NEG_INFINITY, f64::NEG_INFINITY);
    for i in 0..n {
        low = low.max(alpha[i]);
        high = high.max(alpha[i] + off(i).abs() + if i + 1 < n { off(i + 1).abs() } else { 0.0 });
    }
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        // Number of negative pivots = number of eigenvalues below `middle`.
        let mut pivot = 1.0;
        let mut below = 0;
        for i in 0..n {
            let b = off(i);
            pivot = alpha[i] - middle - b * b / pivot;
            if pivot == 0.0 {
                pivot = f64::MIN_POSITIVE;
            }
            below += usize::from(pivot < 0.0);
        }
        if below == n { high = middle } else { low = middle }
    }
    let value = high;
    // Eigenvector by the recurrence from the first row, scaled as it goes.
    let (mut previous, mut current, mut squares) = (0.0, 1.0, 1.0);
    for i in 1..n {
        let next = ((value - alpha[i - 1]) * current - off(i - 1) * previous) / off(i);
        previous = current;
        current = next;
        squares += next * next;
        if squares > 1e200 {
            let scale = 1.0 / squares.sqrt();
            previous *= scale;
            current *= scale;
            squares = 1.0;
        }
    }
    (value, current / squares.sqrt())
}
