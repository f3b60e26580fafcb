//! Von Mises stress of every element of a frame, from the positions of its nodes.

use std::collections::HashMap;

use stribeck_solver::Elastic;
use stribeck_store::frames::Frame;
use stribeck_store::mesh_file::RunMesh;
use stribeck_theory::material::Material;

pub use stribeck_solver::Stress;

/// One element of a frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Cell {
    /// Its corners now [m], counter-clockwise.
    pub corners: Vec<[f64; 2]>,
    /// Von Mises stress at its centre [Pa].
    pub von_mises: f64,
}

/// The elastic material of a scene.
///
/// # Panics
/// Never for that of a scene, whose fields have their ranges.
pub fn elastic(material: &Material) -> Elastic {
    Elastic::new(material.youngs_modulus, material.poissons_ratio, material.density)
        .expect("a scene's material is elastic")
}

/// Elements whose corners are all in the frame. Elements of the cage, which is rigid, are left out.
pub fn cells(mesh: &RunMesh, frame: &Frame, material: &Elastic) -> Vec<Cell> {
    let place: HashMap<u32, [f64; 2]> =
        frame.nodes.iter().copied().zip(frame.displacement.iter().copied()).collect();
    let mut cells = Vec::new();
    for body in mesh.bodies.iter().filter(|b| b.name != "cage") {
        for element in mesh.elements_of(body) {
            let reference: Vec<[f64; 2]> = element.iter().map(|&n| mesh.reference[n as usize]).collect();
            let moved: Option<Vec<[f64; 2]>> = element
                .iter()
                .zip(&reference)
                .map(|(n, at)| place.get(n).map(|u| [at[0] + u[0], at[1] + u[1]]))
                .collect();
            if let Some(corners) = moved {
                let von_mises = Stress::of(material, &reference, &corners).von_mises();
                cells.push(Cell { corners, von_mises });
            }
        }
    }
    cells
}
