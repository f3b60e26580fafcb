//! How a run starts: static equilibrium under load, then the velocities of rolling without slip (THEORY §3).

use stribeck_solver::{
    Force,
    statics::{Equilibrator, Statics, Undecided},
};

use crate::{
    assembly::{Machine, roller_angle},
    error::Error,
};
use stribeck_scene::{kinematics::Kinematics, scene::Scene};

/// A body moves at most this far as a whole in one iteration of the preload [m]: about the clearance.
const LONGEST_STEP: f64 = 2e-5;

/// Unbalanced force allowed on the worst node, as a share of the load.
const TOLERANCE: f64 = 1e-7;

/// Contacts that change sides for ever keep a preload from its tolerance. Where less than this share of the load is
/// unbalanced on the worst node, the run starts all the same, with a warning.
const ENOUGH: f64 = 1e-4;

/// The same for a stage before the last.
const ON_THE_WAY: f64 = 1e-2;

/// Most iterations of the preload.
const ITERATIONS: usize = 80;

/// Gaps over which the contact law is rounded, stage by stage [m]; the last stage is the law itself.
const SOFTNESS: [f64; 5] = [2e-6, 2e-7, 2e-8, 2e-9, 0.0];

/// Diametral clearance for which these serve [m]; in a larger one they grow with it.
const CLEARANCE: f64 = 40e-6;

/// Stages before the last need not be exact: this multiple of the tolerance will do.
const ROUGH: f64 = 1e4;

/// Accelerations [m/s²] of every slot in rolling without slip: the inner ring turns, the rollers run and spin.
fn rolling_acceleration(machine: &Machine, k: &Kinematics) -> Vec<[f64; 2]> {
    let state = &machine.dynamics.state;
    let mut acceleration = vec![[0.0; 2]; state.x.len()];
    let shaft = k.shaft_rad_s * k.shaft_rad_s;
    for &n in &machine.inner {
        let n = n as usize;
        acceleration[n] = [-shaft * state.x[n], -shaft * state.y[n]];
    }
    let (orbit, spin) = (k.cage_rad_s * k.cage_rad_s, k.roller_rad_s * k.roller_rad_s);
    for roller in &machine.rollers {
        let c = roller.centre as usize;
        let (cx, cy) = (state.x[c], state.y[c]);
        for &n in &roller.all {
            let n = n as usize;
            acceleration[n] =
                [-orbit * cx - spin * (state.x[n] - cx), -orbit * cy - spin * (state.y[n] - cy)];
        }
    }
    acceleration
}

/// Diametral clearance [mm].
fn clearance_mm(scene: &Scene) -> f64 {
    let b = &scene.bearing;
    b.outer_race_diameter_mm - b.inner_race_diameter_mm - 2.0 * b.roller_diameter_mm
}

/// Brings the machine to equilibrium under load, gravity and the inertia of rolling; a warning when it came only near.
pub(crate) fn preload(machine: &mut Machine, scene: &Scene, k: &Kinematics) -> Result<Option<String>, Error> {
    let mut undecided = vec![Undecided { slots: machine.outer.clone(), along: None, rotation: true }];
    for (i, roller) in machine.rollers.iter().enumerate() {
        let (s, c) = roller_angle(scene, i).sin_cos();
        undecided.push(Undecided { slots: roller.all.clone(), along: Some([-s, c]), rotation: true });
    }
    let mut bodies = vec![
        ("outer ring".to_owned(), machine.outer.clone()),
        ("inner ring".to_owned(), machine.inner.clone()),
        ("adapter".to_owned(), machine.adapter.clone()),
    ];
    for (i, roller) in machine.rollers.iter().enumerate() {
        bodies.push((format!("roller {}", i + 1), roller.all.clone()));
    }
    let statics = Statics {
        bodies,
        undecided,
        acceleration: rolling_acceleration(machine, k),
        longest_step: LONGEST_STEP,
        tolerance: TOLERANCE * scene.operation.load_n.max(1.0),
        iterations: ITERATIONS,
    };
    // A rounded contact law first: idle bodies then feel both sides of their clearance and settle between them.
    let mut solver = Equilibrator::new(&machine.dynamics);
    let load = scene.operation.load_n.max(1.0);
    let mut warning = None;
    // Rollers in a wide clearance feel its sides from farther away.
    let wide = (1e-3 * clearance_mm(scene) / CLEARANCE).max(1.0);
    for softness in SOFTNESS.map(|e| e * wide) {
        machine.contacts.set_preload(Some(softness));
        let tolerance = if softness > 0.0 { ROUGH * statics.tolerance } else { statics.tolerance };
        let statics = Statics { tolerance, ..statics.clone() };
        let forces: &mut [&mut dyn Force] = &mut [&mut machine.load, &mut machine.contacts];
        match solver.equilibrate(&mut machine.dynamics, forces, &statics) {
            Ok(_) => warning = None,
            // A stage on the way may end a little short: the next one goes on from there.
            Err(stribeck_solver::Error::NoEquilibrium { residual_n, .. })
                if residual_n <= load * if softness > 0.0 { ON_THE_WAY } else { ENOUGH } =>
            {
                warning = Some(format!(
                    "the preload left a force of {residual_n:.2e} N unbalanced, {:.1e} of the load: the start rings a little. A softer \
                     `contact.penalty_scale` converges better",
                    residual_n / scene.operation.load_n
                ));
            }
            Err(error) => return Err(error.into()),
        }
    }
    machine.contacts.set_preload(None);
    Ok(warning)
}

/// Gives every body its rolling velocity, half a step before the start.
pub(crate) fn launch(machine: &mut Machine, k: &Kinematics) {
    let acceleration = rolling_acceleration(machine, k);
    let half = 0.5 * machine.dynamics.time_step();
    let state = &mut machine.dynamics.state;
    for &n in &machine.inner {
        let n = n as usize;
        state.vx[n] = -k.shaft_rad_s * state.y[n];
        state.vy[n] = k.shaft_rad_s * state.x[n];
    }
    for roller in &machine.rollers {
        let c = roller.centre as usize;
        let (cx, cy) = (state.x[c], state.y[c]);
        for &n in &roller.all {
            let n = n as usize;
            state.vx[n] = -k.cage_rad_s * cy - k.roller_rad_s * (state.y[n] - cy);
            state.vy[n] = k.cage_rad_s * cx + k.roller_rad_s * (state.x[n] - cx);
        }
    }
    for (n, a) in acceleration.iter().enumerate() {
        state.vx[n] -= half * a[0];
        state.vy[n] -= half * a[1];
    }
    if let Some(cage) = machine.cage {
        machine.dynamics.launch_rigid(cage, [0.0; 2], k.cage_rad_s);
    }
}
