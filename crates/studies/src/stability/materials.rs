//! Poisson's ratio from 0 to nearly incompressible.

use std::f64::consts::TAU;

use anyhow::Result;
use stribeck_mesh::{Annulus, Part};
use stribeck_solver::{
    Elastic,
    force::NodalLoad,
    statics::{Equilibrator, Statics},
};

use super::{Case, Chapter};
use crate::rig::{Plan, THICKNESS, rectangle};

/// Inner and outer radius of the cylinder [m].
const CYLINDER: [f64; 2] = [0.05, 0.1];
/// Internal pressure [Pa].
const PRESSURE: f64 = 10e6;

/// Displacement of the bore of a thick cylinder under internal pressure over Lamé's
/// (Timoshenko and Goodier, *Theory of Elasticity*, 3rd ed. 1970, §28, plane strain).
pub(crate) fn cylinder(material: Elastic, facets: usize, layers: usize) -> Result<f64> {
    let [inner_radius, outer_radius] = CYLINDER;
    let ring = Annulus { inner_radius, outer_radius, facets, layers, start_angle: 0.0, groove: None };
    cylinder_of(&ring.part()?, material, facets)
}

/// The same for a mesh of that cylinder with `facets` on its bore.
pub(crate) fn cylinder_of(part: &Part, material: Elastic, facets: usize) -> Result<f64> {
    let [a, b] = CYLINDER;
    let mut plan = Plan::default();
    let body = plan.add(part);
    let bore = plan.nodes(body, "inner").nodes.clone();
    let mut rig = plan.lay_out(&plan.model(material)?)?;
    let d = &mut rig.dynamics;
    let slots: Vec<usize> = bore.iter().map(|&n| d.layout().slot_of_node[n as usize] as usize).collect();
    // The pressure on a chord is that on its arc's projection.
    let share = PRESSURE * THICKNESS * a * (TAU / facets as f64).sin();
    let loads = slots.iter().map(|&s| {
        let (x, y) = (d.state.x[s] / a, d.state.y[s] / a);
        (s as u32, share * x, share * y)
    });
    let mut load = NodalLoad::new(loads.collect());
    let statics = Statics {
        bodies: vec![("cylinder".to_owned(), rig.bodies[0].clone())],
        undecided: Vec::new(),
        acceleration: Vec::new(),
        longest_step: 1e-3,
        tolerance: 1e-3,
        iterations: 60,
    };
    Equilibrator::new(d).equilibrate(d, &mut [&mut load], &statics)?;
    let radius = slots.iter().map(|&s| d.state.x[s].hypot(d.state.y[s])).sum::<f64>() / slots.len() as f64;
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
        let mut plan = Plan::default();
        plan.add(&rectangle([0.0; 2], [0.01, 0.008], [10, 8])?);
        let mut rig = plan.lay_out(&plan.model(material)?)?;
        rig.set_step(0.9)?;
        rig.stir(0.01);
        let stop = rig.run(50_000, 50, |_, _| {});
        cases.push(Case::of(
            format!("ν = {nu}: 50 000 steps of a stirred block"),
            rig.worst,
            stop,
            right,
            seen,
        ));
    }
    Ok(Chapter {
        title: "Poisson's ratio",
        words: "A free block whose nodes start with random velocities, and the static bore of a thick cylinder against Lamé. The \
                one-point quadrilateral does not lock as ν approaches one half; the time step shrinks with the pressure wave.",
        cases,
        figures: Vec::new(),
    })
}
