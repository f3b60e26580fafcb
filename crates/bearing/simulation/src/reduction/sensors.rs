//! Responses of sensors: to the modes, and quasi-statically to forces on the raceway.

use stribeck_reduced::modal::reduction::Sensor;
use stribeck_solver::state::NodeForces;

use crate::reduction::{direction, extraction::Extraction, structure::Structure};

/// Sensors in the order of the scene, beside the vertices of the raceway [m]; `count` slots hold all nodes.
pub(crate) fn sensors(
    extraction: &Extraction,
    structure: &mut Structure,
    raceway: &[[f64; 2]],
    count: usize,
    padded: usize,
) -> Vec<Sensor> {
    let slots = extraction.slots(&extraction.nodes.sensors);
    // By reciprocity: a unit force at a sensor moves the raceway as one there moves the sensor.
    let units: Vec<NodeForces> = slots
        .iter()
        .flat_map(|&slot| [[1.0, 0.0], [0.0, 1.0]].map(|along| (slot as usize, along)))
        .map(|(slot, along)| {
            let mut unit = NodeForces::zeros(count);
            [unit.fx[slot], unit.fy[slot]] = along;
            unit
        })
        .collect();
    let residuals = structure.residuals(&units, &extraction.slots(&extraction.nodes.outer));
    let sensor = |(&slot, moved): (&u32, &[Vec<[f64; 2]>])| {
        let residual = raceway.iter().enumerate().map(|(vertex, place)| {
            let [nx, ny] = direction(*place);
            [0, 1].map(|component: usize| {
                let [x, y] = moved[component][vertex];
                nx * x + ny * y
            })
        });
        Sensor { shape: structure.shape_at(slot, padded), residual: residual.collect() }
    };
    slots.iter().zip(residuals.chunks_exact(2)).map(sensor).collect()
}
