//! Springs and dampers between the nodes of a ring and a frame that moves without turning.

use stribeck_mesh::Surface;
use stribeck_scene::housing::SpringHousingScene;
use stribeck_solver::{
    Force,
    force::RankOne,
    state::{Energy, Moment, NodeForces},
};
use stribeck_system::Plan;

use crate::error::Error;

/// Ties every node of the ring's back to the frame, of which `held` is a node: each by its share of the
/// circumference.
pub(crate) fn suspend(
    plan: &mut Plan,
    springs: &SpringHousingScene,
    back: &Surface,
    held: u32,
) -> Result<(), Error> {
    let mesh = &plan.model.mesh;
    let between =
        |a: u32, b: u32| [mesh.x[b as usize] - mesh.x[a as usize], mesh.y[b as usize] - mesh.y[a as usize]];
    let facets = (0..back.facets()).map(|f| back.facet(f)).map(|[a, b]| between(a, b));
    let length: Vec<f64> = facets.map(|[x, y]| libm::hypot(x, y)).collect();
    let (around, n) = (length.iter().sum::<f64>(), length.len());
    let tie = |(i, &node): (usize, &u32)| {
        let share = 0.5 * (length[i] + length[(i + n - 1) % n]) / around;
        Tie {
            slot: node,
            apart: between(held, node),
            stiffness: 1e6 * share * springs.stiffness_n_um,
            damping: share * springs.damping_n_s_m,
        }
    };
    let ties: Vec<Tie> = back.nodes.iter().enumerate().map(tie).collect();
    let nodes = ties.iter().map(|tie| tie.slot).chain([held]).collect();
    plan.force("springs of the housing", nodes, move |slots| {
        let frame = slots[slots.len() - 1];
        let ties = ties.into_iter().zip(slots).map(|(tie, &slot)| Tie { slot, ..tie });
        Box::new(Suspension::new(ties.collect(), frame))
    })?;
    Ok(())
}

/// A spring and a damper from a node to the frame, at rest in the place where the node is at first.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Tie {
    /// The node, in the mesh first and its slot from when it is laid out.
    slot: u32,
    /// From the frame's node to this one at rest [m].
    apart: [f64; 2],
    /// Stiffness in every direction [N/m].
    stiffness: f64,
    /// Damping in every direction [N s/m].
    damping: f64,
}

/// All ties of a ring to one frame.
#[derive(Debug, Clone)]
struct Suspension {
    ties: Vec<Tie>,
    /// Slot of the node that stands for the frame.
    frame: usize,
    /// Energy of the springs now, heat of the dampers since the start [J].
    stored: f64,
    heat: f64,
}

impl Suspension {
    fn new(ties: Vec<Tie>, frame: u32) -> Self {
        Self { ties, frame: frame as usize, stored: 0.0, heat: 0.0 }
    }
}

impl Force for Suspension {
    fn accumulate(&mut self, at: Moment<'_>, force: &mut NodeForces) {
        let Moment { x, y, vx, vy, dt, .. } = at;
        let frame = self.frame;
        let (mut stored, mut loss) = (0.0, 0.0);
        let mut on_frame = [0.0; 2];
        for tie in &self.ties {
            let n = tie.slot as usize;
            let stretch = [x[n] - x[frame] - tie.apart[0], y[n] - y[frame] - tie.apart[1]];
            let rate = [vx[n] - vx[frame], vy[n] - vy[frame]];
            // Without a time step, in a search for equilibrium, velocities do not count.
            let damping = if dt > 0.0 { tie.damping } else { 0.0 };
            let [fx, fy] = [0, 1].map(|c| tie.stiffness * stretch[c] + damping * rate[c]);
            force.fx[n] -= fx;
            force.fy[n] -= fy;
            on_frame = [on_frame[0] + fx, on_frame[1] + fy];
            stored += 0.5 * tie.stiffness * (stretch[0] * stretch[0] + stretch[1] * stretch[1]);
            loss += damping * (rate[0] * rate[0] + rate[1] * rate[1]);
        }
        force.fx[frame] += on_frame[0];
        force.fy[frame] += on_frame[1];
        self.stored = stored;
        self.heat += dt * loss;
    }

    fn energy(&self) -> Energy {
        Energy { stored: self.stored, damping: self.heat, ..Energy::default() }
    }

    fn memory(&self) -> Vec<f64> {
        vec![self.heat]
    }

    fn recall(&mut self, memory: &[f64]) -> bool {
        if let [heat] = memory {
            self.heat = *heat;
        }
        memory.len() == 1
    }

    fn stiffness_bound(&self, dt: f64, bound: &mut [f64]) {
        for tie in &self.ties {
            // Damping acts half a step late. (a − b)² ≤ 2 a² + 2 b².
            let late = if dt > 0.0 { 2.0 * tie.damping / dt } else { 0.0 };
            let stiffness = 2.0 * (tie.stiffness + late);
            bound[tie.slot as usize] += stiffness;
            bound[self.frame] += stiffness;
        }
    }

    fn tangent(&self, _x: &[f64], _y: &[f64], visit: &mut dyn FnMut(RankOne<'_>)) {
        for tie in &self.ties {
            for direction in [[1.0, 0.0, -1.0, 0.0], [0.0, 1.0, 0.0, -1.0]] {
                let nodes = [tie.slot, self.frame as u32];
                visit(RankOne { nodes: &nodes, direction: &direction, stiffness: tie.stiffness });
            }
        }
    }
}
