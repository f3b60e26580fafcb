//! Positions and velocities of nodes and bodies, in node numbers and names.

use stribeck_solver::rigid::{RigidMotion, RigidState};

use crate::{error::Error, names::nodes_of, system::System};

impl System {
    /// Position of a node [m].
    pub fn position(&self, node: u32) -> [f64; 2] {
        let (n, s) = (self.slot(node), &self.dynamics.state);
        [s.x[n], s.y[n]]
    }

    /// Velocity of a node, half a step before its position [m/s].
    pub fn velocity(&self, node: u32) -> [f64; 2] {
        let (n, s) = (self.slot(node), &self.dynamics.state);
        [s.vx[n], s.vy[n]]
    }

    /// Sets the velocity of a node of an elastic body [m/s]; a rigid body is moved by [`System::launch`]. The
    /// ledger counts from the next step.
    pub fn set_velocity(&mut self, node: u32, velocity: [f64; 2]) {
        let n = self.slot(node);
        [self.dynamics.state.vx[n], self.dynamics.state.vy[n]] = velocity;
        self.balance.reference = None;
    }

    /// Mass of a node [kg].
    pub fn mass(&self, node: u32) -> f64 {
        self.dynamics.mass()[self.slot(node)]
    }

    /// Nodes of the mesh.
    pub fn node_count(&self) -> usize {
        self.dynamics.layout().slot_of_node.len()
    }

    /// Number of the body of that name.
    ///
    /// # Errors
    /// When there is none.
    pub fn body(&self, name: &str) -> Result<usize, Error> {
        self.names.body(name)
    }

    /// Nodes of a body, a surface or a mark.
    ///
    /// # Errors
    /// When nothing has that name.
    pub fn nodes(&self, name: &str) -> Result<Vec<u32>, Error> {
        self.names.nodes(name)
    }

    /// Nodes of a body, by its number in the mesh.
    pub fn nodes_of(&self, body: usize) -> std::ops::Range<u32> {
        nodes_of(&self.names.bodies[body])
    }

    /// The rigid part of a body's motion: mass, centre, velocity, inertia, spin.
    pub fn motion_of(&self, body: usize) -> RigidMotion {
        self.dynamics.rigid_motion(&self.body_slots(body))
    }

    /// Place, angle and motion of a body that moves as one piece; none for an elastic one.
    pub fn rigid(&self, body: usize) -> Option<&RigidState> {
        self.rigid_number(body).map(|at| &self.dynamics.rigid[at])
    }

    /// Gives a body a velocity [m/s] and a spin about its centre of mass [rad/s], in place of those that it
    /// has. The ledger counts from the next step; the nodes of a rigid body take the velocity up in it.
    pub fn launch(&mut self, body: usize, velocity: [f64; 2], spin: f64) {
        self.balance.reference = None;
        if let Some(at) = self.rigid_number(body) {
            return self.dynamics.launch_rigid(at, velocity, spin);
        }
        let [cx, cy] = self.motion_of(body).centre;
        for node in self.nodes_of(body) {
            let [x, y] = self.position(node);
            self.set_velocity(node, [velocity[0] - spin * (y - cy), velocity[1] + spin * (x - cx)]);
        }
    }

    /// Fastest node and its speed [m/s]; one whose velocity is no number is faster than all others.
    pub fn fastest_node(&self) -> (u32, f64) {
        let d = &self.dynamics;
        let s = &d.state;
        let speed = |n: usize| libm::hypot(s.vx[n], s.vy[n]);
        let worse = |a: usize, b: usize| if speed(a) >= speed(b) || speed(a).is_nan() { a } else { b };
        let worst = (0..s.x.len()).filter(|&n| d.mass()[n] > 0.0).reduce(worse).unwrap_or(0);
        (d.layout().node_of_slot[worst].unwrap_or(0), speed(worst))
    }

    /// Name of the body that a node belongs to.
    pub(crate) fn body_of(&self, node: u32) -> &str {
        let body = self.names.bodies.iter().find(|body| body.nodes.contains(&(node as usize)));
        body.map_or("", |body| body.name.as_str())
    }

    /// Place of a node in the arrays of the solver.
    pub(crate) fn slot(&self, node: u32) -> usize {
        self.dynamics.layout().slot_of_node[node as usize] as usize
    }

    /// Places of a body's nodes.
    pub(crate) fn body_slots(&self, body: usize) -> Vec<u32> {
        self.nodes_of(body).map(|node| self.slot(node) as u32).collect()
    }

    fn rigid_number(&self, body: usize) -> Option<usize> {
        if self.behaviour[body].is_elastic() {
            return None;
        }
        self.dynamics.rigid_body_numbers().position(|b| b == body)
    }
}
