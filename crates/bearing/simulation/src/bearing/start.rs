//! How a run starts: static equilibrium under load, then the velocities of rolling without slip (THEORY §3).

use stribeck_solver::damping::{Frame, MassDamping};
use stribeck_system::{Preload, UndecidedMotion};

use crate::bearing::assembly::BearingSystem;
use crate::error::Error;
use stribeck_scene::{resolved::ResolvedScene, scene::DampingFrame};
use stribeck_theory::kinematics::Kinematics;

/// Diametral clearance for which the stages of a preload serve [m]; in a larger one they grow with it.
const CLEARANCE: f64 = 40e-6;

/// Accelerations [m/s²] of every node in rolling without slip: the inner ring turns, the rollers run and
/// spin.
fn rolling_acceleration(bearing: &BearingSystem, k: &Kinematics) -> Vec<[f64; 2]> {
    let system = &bearing.system;
    let mut acceleration = vec![[0.0; 2]; system.node_count()];
    for (body, rate) in [(bearing.inner, k.shaft_rad_s), (bearing.outer, k.outer_rad_s)] {
        let square = rate * rate;
        if square > 0.0 {
            for n in system.nodes_of(body) {
                let [x, y] = system.position(n);
                acceleration[n as usize] = [-square * x, -square * y];
            }
        }
    }
    let (orbit, spin) = (k.cage_rad_s * k.cage_rad_s, k.roller_rad_s * k.roller_rad_s);
    for roller in &bearing.rollers {
        let [cx, cy] = system.position(roller.centre);
        for n in system.nodes_of(roller.body) {
            let [x, y] = system.position(n);
            acceleration[n as usize] = [-orbit * cx - spin * (x - cx), -orbit * cy - spin * (y - cy)];
        }
    }
    acceleration
}

/// Brings the bearing to equilibrium under load, gravity and the inertia of rolling; a warning when it came
/// only near.
///
/// # Errors
/// When there is no equilibrium to be found.
pub fn preload(
    bearing: &mut BearingSystem,
    scene: &ResolvedScene,
    k: &Kinematics,
) -> Result<Option<String>, Error> {
    let mut undecided = Vec::new();
    // A ring that sits without friction may turn.
    if bearing.pairs.seat().is_some() {
        undecided.push(UndecidedMotion { body: bearing.outer, along: None, rotation: true });
    }
    for roller in &bearing.rollers {
        let (s, c) = libm::sincos(scene.roller_angle(roller.pocket));
        undecided.push(UndecidedMotion { body: roller.body, along: Some([-s, c]), rotation: true });
    }
    let mut preload = Preload {
        load: Some(scene.duty.load_n(0.0).max(1.0)),
        undecided,
        acceleration: rolling_acceleration(bearing, k),
        ..Preload::default()
    };
    // A rounded contact law first: both sides of its clearance then act on an idle body, which settles
    // between them. In a wide clearance the law is rounded over a larger gap.
    let wide = (scene.clearance / CLEARANCE).max(1.0);
    preload.softness.iter_mut().for_each(|softness| *softness *= wide);
    let settled = bearing.system.settle(&preload)?;
    Ok(settled.unbalanced.map(|force| {
        format!(
            "the preload left a force of {force:.2e} N unbalanced, {:.1e} of the load: the start rings a \
             little. A softer `contact.penalty_scale` converges better",
            force / scene.duty.load_n(0.0)
        )
    }))
}

/// Velocities [m/s] of every node in rolling without slip, at the start; those of a rigid cage are not among
/// them.
pub fn rolling_velocity(bearing: &BearingSystem, k: &Kinematics) -> Vec<[f64; 2]> {
    let system = &bearing.system;
    let mut velocity: Vec<[f64; 2]> = (0..system.node_count()).map(|n| system.velocity(n as u32)).collect();
    for n in system.nodes_of(bearing.inner) {
        let [x, y] = system.position(n);
        velocity[n as usize] = [-k.shaft_rad_s * y, k.shaft_rad_s * x];
    }
    for roller in &bearing.rollers {
        let [cx, cy] = system.position(roller.centre);
        for n in system.nodes_of(roller.body) {
            let [x, y] = system.position(n);
            let (rx, ry) = (x - cx, y - cy);
            velocity[n as usize] =
                [-k.cage_rad_s * cy - k.roller_rad_s * ry, k.cage_rad_s * cx + k.roller_rad_s * rx];
        }
    }
    velocity
}

/// Gives every body its rolling velocity, half a step before the start.
pub fn launch(bearing: &mut BearingSystem, k: &Kinematics) {
    let half = 0.5 * bearing.system.time_step();
    let start = rolling_velocity(bearing, k).into_iter().zip(rolling_acceleration(bearing, k));
    let system = &mut bearing.system;
    for (n, ([vx, vy], a)) in start.enumerate() {
        system.set_velocity(n as u32, [vx - half * a[0], vy - half * a[1]]);
    }
    if let Some(cage) = bearing.cage {
        system.launch(cage, [0.0; 2], k.cage_rad_s);
    }
}

/// Sets the mass damping of the scene, if it has one.
///
/// # Errors
/// When its rate is no damping.
pub fn damp(scene: &ResolvedScene, bearing: &mut BearingSystem) -> Result<(), Error> {
    let rate = scene.written.solver.mass_damping_per_s;
    if rate == 0.0 {
        return Ok(());
    }
    let (standing, rolling) = match scene.written.solver.damping_frame {
        DampingFrame::Rolling => (Frame::Rest, Some(Frame::Tangential { centre: [0.0; 2] })),
        DampingFrame::Standing => (Frame::Rest, None),
        DampingFrame::RigidMotion => (Frame::OwnMotion, Some(Frame::OwnMotion)),
        DampingFrame::Absolute => (Frame::Rest, Some(Frame::Rest)),
    };
    // The inner ring's bore is driven: damping there would only take energy that the drive supplies again.
    let held = std::iter::once(bearing.outer).chain(bearing.housing);
    let mut frames: Vec<(usize, Frame)> = held.map(|body| (body, standing)).collect();
    frames.extend(bearing.rollers.iter().filter_map(|r| Some((r.body, rolling?))));
    bearing.system.set_mass_damping(&MassDamping::new(rate, frames)?);
    Ok(())
}
