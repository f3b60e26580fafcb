//! Coulomb friction: sliding to a stop, sticking on a slope, from sliding to rolling; penalty and flight. One
//! problem a file.

#[path = "../common/mod.rs"]
mod common;

mod block_on_a_slope_slides;
mod block_on_a_slope_sticks;
mod block_slides_to_a_stop;

mod disc_from_sliding_to_rolling;

mod bouncing_disc;
mod column_on_a_floor;

use stribeck_contact::{Contacts, Law, Method};
use stribeck_mesh::Part;
use stribeck_solver::{Behaviour, Dynamics, Model, NodeMotion};

use common::*;

/// Acceleration of gravity [m/s²].
const G: f64 = 9.81;

/// Penalty stiffness [Pa/m] under light bodies: they sink by less than 0.1 µm.
const STIFFNESS: f64 = 1e11;

/// Time step [s]: nothing deforms, and the bodies on their springs are a hundred times slower.
const STEP: f64 = 1e-6;

/// A rigid body on a fixed floor.
struct OnFloor {
    d: Dynamics,
    contacts: Contacts,
    model: Model,
}

impl OnFloor {
    fn new(part: &Part, surface: &str, law: Law, method: Method, gravity: [f64; 2]) -> Self {
        let mut scene = Scene::default();
        let body = scene.add("body", part, surface);
        // No node of the floor lies below the centre of a disc: inside a polygon the nearest point is on one
        // of the two sides of a corner, not the corner, and the second pass would have to choose one.
        let floor = scene.add("floor", &rectangle([-0.0205, -1e-3], 0.08, 1e-3, 80, 1), "top");
        scene.pair(body, floor, law, method);
        let mut model = scene.model();
        model.behaviour[body] = Behaviour::Rigid;
        model.motion[model.mesh.bodies[floor].nodes.clone()].fill(NodeMotion::Held);
        model.gravity = gravity;
        let (mut d, contacts) = scene.lay_out(&model);
        d.set_time_step(STEP).expect("a positive time step");
        Self { d, contacts, model }
    }

    fn mass(&self) -> f64 {
        self.model.mesh.bodies[0].nodes.clone().map(|n| self.d.mass()[slot(&self.d, n)]).sum()
    }

    /// Runs for `span` [s].
    fn run(&mut self, span: f64) {
        for _ in 0..(span / STEP) as usize {
            self.d.step(&mut [&mut self.contacts]);
        }
    }

    fn velocity(&self) -> [f64; 2] {
        self.d.rigid[0].velocity
    }

    fn centre(&self) -> [f64; 2] {
        self.d.rigid[0].centre
    }
}

/// A block of 10 × 5 mm that already rests in the floor as deep as its weight presses it.
fn block(friction: f64, method: Method, slope: f64) -> OnFloor {
    let law = Law::penalty(STIFFNESS)
        .and_then(|l| l.with_friction(friction))
        .and_then(|l| l.with_damping(0.5, steel().density() * 5e-3))
        .expect("a possible law");
    let sunk = steel().density() * 5e-3 * G * slope.cos() / STIFFNESS;
    let part = rectangle([0.0, -sunk], 0.01, 5e-3, 10, 5);
    OnFloor::new(&part, "bottom", law, method, [G * slope.sin(), -G * slope.cos()])
}
