//! The reduced bearing of a scene for a shaft that another program moves (THEORY §9.7).

use std::path::Path;

use crate::bearing::assembly::Assembly;
use crate::reduction::{cache, modal_bearing};
use stribeck_reduced::modal::Reduction;
use stribeck_reduced::shaft::OnShaft;
use stribeck_scene::resolved::ResolvedScene;

use super::{in_steps, wanted};
use crate::error::Error;

/// Numbers of the bearing of a scene for a shaft that is moved; steps are those of a run of the scene. `runs`
/// as for [`prepared`](super::prepared).
///
/// # Errors
/// When the scene cannot be meshed, preloaded or reduced.
pub fn on_shaft(scene: &ResolvedScene, runs: Option<&Path>) -> Result<OnShaft, Error> {
    let (mesh, _) = cache::reduced_mesh(&scene.written, runs)?;
    let assembly = Assembly::of(scene, &mesh.parts)?;
    let bodies = &assembly.model.mesh.bodies;
    let held = bodies.iter().find(|body| body.name == "frame").or(bodies.first());
    let moved = held.and_then(|body| mesh.moved.get(body.nodes.start)).copied().unwrap_or_default();
    let relaxed = relaxed(&mesh.reduction);
    let centre = [moved[0] + relaxed[0], moved[1] + relaxed[1]];
    let modal = modal_bearing(scene, mesh.reduction)?;
    let (bearing, ..) = in_steps(scene, &wanted(scene), modal.clone())?;
    Ok(OnShaft { modal, time_step: bearing.time_step, centre })
}

/// By how much the frame around springs moves on from the preload when load, weight and rollers are taken
/// away and the common centre of mass stays where it is [m]: ring and frame are concentric then.
fn relaxed(reduction: &Reduction) -> [f64; 2] {
    let Some(frame) = &reduction.frame else { return [0.0; 2] };
    let (x, y) = frame.shape.split_at(reduction.padded);
    let mut sum = [0.0; 2];
    for k in (0..reduction.modes).filter(|k| reduction.squares[*k] > ELASTIC) {
        let q = (reduction.constant[k] - reduction.external[k]) / reduction.squares[k];
        sum = [sum[0] + q * x[k], sum[1] + q * y[k]];
    }
    sum
}

/// ω² from which on a mode is elastic [rad²/s²]: translations have zero, but for rounding.
const ELASTIC: f64 = 1e3;
