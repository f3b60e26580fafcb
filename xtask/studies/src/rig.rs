//! Common parts of the small models of several studies: a few bodies, contacts and loads, without a bearing.

use anyhow::{Context, Result};
use stribeck_contact::{Law, Method};
use stribeck_mesh::{Part, Rectangle};
use stribeck_scene::dice::Dice;
use stribeck_solver::Elastic;
use stribeck_system::{Finding, Pair, System};

/// Out-of-plane thickness of every model [m].
pub(crate) const THICKNESS: f64 = 0.01;

/// E = 208 GPa, ν = 0.3, ρ = 7800 kg/m³.
pub(crate) fn steel() -> Elastic {
    Elastic::new(208e9, 0.3, 7800.0).expect("steel is a possible material")
}

/// A rectangle from its lower left corner [m].
pub(crate) fn rectangle([x0, y0]: [f64; 2], size: [f64; 2], cells: [usize; 2]) -> Result<Part> {
    let [columns, rows] = cells;
    Ok(Rectangle { x0, y0, width: size[0], height: size[1], columns, rows }.part()?)
}

/// A law as stiff as a cell of `size` [m] of `material`, times `scale`.
pub(crate) fn penalty(material: &Elastic, size: f64, scale: f64) -> Result<Law> {
    Law::penalty(scale * material.plane_strain_modulus() / size).context("a penalty stiffness")
}

/// Two surfaces that may touch, evaluated by `method`.
pub(crate) fn pair(first: &str, second: &str, law: Law, method: Method) -> Pair {
    Pair { method, ..Pair::new(first, second, law) }
}

/// Whether any contact pair pushed in the last step.
pub(crate) fn touching(system: &System) -> bool {
    system.resultants().any(|resultant| resultant.force != [0.0; 2])
}

/// Adds a random velocity of up to `speed` [m/s] to every node: every mode is excited.
pub(crate) fn stir(system: &mut System, speed: f64) {
    let mut dice = Dice::new(11);
    for node in 0..system.node_count() as u32 {
        let velocity = system.velocity(node).map(|v| v + speed * (2.0 * dice.share() - 1.0));
        system.set_velocity(node, velocity);
    }
}

/// Why a run ended early, if it did.
pub(crate) fn stop_reason(findings: Vec<Finding>) -> Option<String> {
    findings.into_iter().find(|finding| finding.stops).map(|finding| finding.message)
}
