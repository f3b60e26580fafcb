//! Anything that pushes on nodes besides the elements: contact, loads.

use crate::state::{Energy, Moment, NodeForces};

/// One rank-one piece of a tangent stiffness, k · d dᵀ over a few nodes.
#[derive(Debug, Clone, Copy)]
pub struct RankOne<'a> {
    /// Slots; one may appear more than once.
    pub nodes: &'a [u32],
    /// Direction, (x, y) of each node in turn.
    pub direction: &'a [f64],
    /// Stiffness [N/m].
    pub stiffness: f64,
}

/// Anything that pushes on nodes.
pub trait Force {
    /// Adds this force [N] to every node it touches.
    fn accumulate(&mut self, at: Moment<'_>, force: &mut NodeForces);

    /// Energy stored now; dissipated and supplied since the start [J].
    fn energy(&self) -> Energy {
        Energy::default()
    }

    /// Its state besides positions and velocities, for a snapshot.
    fn memory(&self) -> Vec<f64> {
        Vec::new()
    }

    /// Restores a state of [`Force::memory`]; false when it belongs to another force.
    fn recall(&mut self, memory: &[f64]) -> bool {
        memory.is_empty()
    }

    /// Adds to each node an upper bound of the stiffness [N/m] that this force can give it, damping included:
    /// the sum over nodes of bound · |u|² is never below the force's own quadratic form (THEORY §2.4).
    fn stiffness_bound(&self, _dt: f64, _bound: &mut [f64]) {}

    /// Visits the tangent stiffness at positions `x`, `y` [m], those last given to `accumulate`.
    fn tangent(&self, _x: &[f64], _y: &[f64], _visit: &mut dyn FnMut(RankOne<'_>)) {}
}

/// Constant forces on nodes.
#[derive(Debug, Clone, Default)]
pub struct NodalLoad {
    loads: Vec<(u32, f64, f64)>,
    /// Work done since the start [J]: all that a constant load remembers.
    pub supplied: f64,
}

impl NodalLoad {
    /// A total force [N] spread evenly along an edge: each node takes its share of the edge's length.
    ///
    /// `slots` lists the nodes along the edge; `x`, `y` [m] are positions by slot.
    pub fn on_edge(slots: &[u32], x: &[f64], y: &[f64], total: [f64; 2]) -> Self {
        let length = |pair: &[u32]| {
            let (a, b) = (pair[0] as usize, pair[1] as usize);
            libm::hypot(x[b] - x[a], y[b] - y[a])
        };
        let whole: f64 = slots.windows(2).map(length).sum();
        let mut share = vec![0.0; slots.len()];
        for (i, pair) in slots.windows(2).enumerate() {
            let half = 0.5 * length(pair) / whole;
            share[i] += half;
            share[i + 1] += half;
        }
        let loads = slots.iter().zip(share).map(|(&s, part)| (s, part * total[0], part * total[1]));
        Self::new(loads.collect())
    }

    /// Loads as (slot, force x [N], force y [N]).
    pub fn new(loads: Vec<(u32, f64, f64)>) -> Self {
        Self { loads, supplied: 0.0 }
    }

    /// The loads as (slot, force x [N], force y [N]).
    pub fn loads(&self) -> &[(u32, f64, f64)] {
        &self.loads
    }
}

impl Force for NodalLoad {
    fn accumulate(&mut self, at: Moment<'_>, force: &mut NodeForces) {
        for &(node, fx, fy) in &self.loads {
            let n = node as usize;
            force.fx[n] += fx;
            force.fy[n] += fy;
            // The velocity times the step is the displacement since the last call.
            self.supplied += at.dt * (fx * at.vx[n] + fy * at.vy[n]);
        }
    }

    fn energy(&self) -> Energy {
        Energy { supplied: self.supplied, ..Energy::default() }
    }
}
