//! `mesh.vtu`: the mesh at the start of a run, deformed by its preload, with the places of its nodes free of
//! stress.

use crate::bearing::assembly::Assembly;
use crate::error::Error;
use stribeck_mesh::vtu;
use stribeck_store::mesh_file::REFERENCE;

/// The file of a mesh whose nodes stand at these places [m].
pub(crate) fn mesh_file(assembly: &Assembly, place: &dyn Fn(u32) -> [f64; 2]) -> Result<Vec<u8>, Error> {
    let mut mesh = assembly.model.mesh.clone();
    let reference: Vec<[f64; 3]> = mesh.x.iter().zip(&mesh.y).map(|(&x, &y)| [x, y, 0.0]).collect();
    for n in 0..mesh.x.len() {
        [mesh.x[n], mesh.y[n]] = place(n as u32);
    }
    let moved: Vec<[f64; 3]> = reference
        .iter()
        .enumerate()
        .map(|(n, from)| [mesh.x[n] - from[0], mesh.y[n] - from[1], 0.0])
        .collect();
    let fields =
        [vtu::Field::vector("displacement_m", &moved), vtu::Field::exact_vector(REFERENCE, &reference)];
    let mut file = Vec::new();
    vtu::write(&mut file, &mesh, &fields, &[])?;
    Ok(file)
}
