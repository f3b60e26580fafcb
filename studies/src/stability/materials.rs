//! Poisson's ratio from 0 to nearly incompressible.

use std::f64::consts::TAU;

use anyhow::Result;
use stribeck_mesh::{Annulus, Part};
use stribeck_solver::Elastic;
use stribeck_system::{Plan, Preload};

use super::{Case, Chapter};
use crate::rig::{THICKNESS, rectangle, stir, stop_reason};

/// Inner and outer radius of the cylinder [m].
const CYLINDER: [f64; 2] = [0.05, 0.1];
/// Internal pressure [Pa].
const PRESSURE: f64 = 10e6;

/// Displacement of the bore of a thick cylinder under internal pressure over Lamé's
/// (Timoshenko and Goodier, *Theory of Elasticity*, 3rd ed. 1970, §28, plane strain).
pub(crate) fn cylinder(material: Elastic, facets: usize, layers: usize) -> Result<f64> {
    let [inner_radius, outer_radius] = CYLINDER;
    let ring = Annulus { inner_radius, outer_radius, facets, layers, start_angle: 0.0, grooves: Vec::new() };
    cylinder_of(&ring.part()?, material, facets)
}

/// The same for a mesh of that cylinder with `facets` on its bore.
pub(crate) fn cylinder_of(part: &Part, material: Elastic, facets: usize) -> Result<f64> {
    let [a, b] = CYLINDER;
    let mut plan = Plan::new(THICKNESS);
    plan.add("cylinder", part, material)?;
    let bore = plan.nodes("cylinder.inner")?;
    // The pressure on a chord is that on its arc's projection.
    let share = PRESSURE * THICKNESS * a * (TAU / facets as f64).sin();
    let mesh = &plan.model.mesh;
    let push = |n: usize| [share * mesh.x[n] / a, share * mesh.y[n] / a];
    let loads = bore.iter().map(|&n| (n, push(n as usize))).collect();
    plan.load_nodes("pressure", loads)?;
    let mut system = plan.build(1)?;
    system.settle(&Preload { longest_step: 1e-3, ..Preload::default() })?;
    let radii = bore.iter().map(|&n| system.position(n)).map(|[x, y]| x.hypot(y));
    let radius = radii.sum::<f64>() / bore.len() as f64;
    let (e, nu) = (material.youngs_modulus(), material.poissons_ratio());
    let lame = PRESSURE * a * a / (e * (b * b - a * a)) * (1.0 + nu) * ((1.0 - 2.0 * nu) * a + b * b / a);
    Ok((radius - a) / lame)
}

pub(super) fn chapter() -> Result<Chapter> {
    let mut cases = Vec::new();
    for nu in [0.0, 0.3, 0.49, 0.499, 0.4999] {
        let material = Elastic::new(208e9, nu, 7800.0)?;
        let ratio = cylinder(material, 96, 12);
        let (right, seen) = match &ratio {
            Ok(r) => ((r - 1.0).abs() < 0.01, format!("bore of a thick cylinder moves {r:.4} × Lamé")),
            Err(e) => (true, format!("static start refused: {e}")),
        };
        let mut plan = Plan::new(THICKNESS);
        plan.add("block", &rectangle([0.0; 2], [0.01, 0.008], [10, 8])?, material)?;
        let mut system = plan.build(1)?;
        system.set_time_step_factor(0.9)?;
        stir(&mut system, 0.01);
        let stop = stop_reason(system.run(50_000, 50, |_, _| ())?);
        cases.push(Case::of(
            format!("ν = {nu}: 50 000 steps of a stirred block"),
            system.balance().largest_error,
            stop,
            right,
            seen,
        ));
    }
    Ok(Chapter {
        title: "Poisson's ratio",
        words: "A free block whose nodes start with random velocities, and the static bore of a thick \
            cylinder against Lamé. The \
                one-point quadrilateral does not lock as ν approaches one half; the time step shrinks with \
                the pressure wave.",
        cases,
        figures: Vec::new(),
    })
}
