//! The mesh of a run as a model for other finite element programs.

use std::path::PathBuf;

use anyhow::Result;
use stribeck_mesh::decks::{ContactPair, Deck, Model, Side};
use stribeck_mesh::{Body, Mesh};
use stribeck_scene::geometry::Geometry;
use stribeck_scene::housing::HousingScene;
use stribeck_scene::mesh_file::{self, RunMesh};
use stribeck_scene::run_dir::{Run, RunDir, write_atomic};
use stribeck_scene::scene::{MaterialScene, Scene};

use super::provenance;

/// The mesh of the run, each body a part or set of its name, with material, sections and contacts where the format has them.
pub(super) fn write(dir: &RunDir, run: &Run, deck: Deck, path: PathBuf) -> Result<PathBuf> {
    let whole = RunMesh::read(dir.mesh())?;
    let nodes = |body: &mesh_file::Body| {
        let quads = whole.quads[body.quads.clone()].iter().flatten();
        let corners = quads.chain(whole.triangles[body.triangles.clone()].iter().flatten());
        let (low, high) = corners.fold((u32::MAX, 0), |(low, high), &n| (low.min(n), high.max(n + 1)));
        low.min(high) as usize..high as usize
    };
    let bodies = whole.bodies.iter().map(|body| Body {
        name: body.name.clone(),
        nodes: nodes(body),
        quads: body.quads.clone(),
        triangles: body.triangles.clone(),
    });
    let mesh = Mesh {
        x: whole.reference.iter().map(|[x, _]| *x).collect(),
        y: whole.reference.iter().map(|[_, y]| *y).collect(),
        bodies: bodies.collect(),
        quads: whole.quads.clone(),
        triangles: whole.triangles.clone(),
    };
    let title = provenance(run).join("; ");
    write_atomic(&path, deck.write_model(&model(&run.scene, &mesh), &title).as_bytes())?;
    Ok(path)
}

/// What the scene says of the bodies of its mesh. The cage touches nothing here: its pockets are walls of the scene, not of the mesh.
fn model<'a>(scene: &Scene, mesh: &'a Mesh) -> Model<'a> {
    let MaterialScene { youngs_modulus_gpa, poissons_ratio, density_kg_m3 } = scene.material;
    let named = |name: &str| mesh.bodies.iter().position(|body| body.name == name);
    let (outer, inner) = (named("outer ring"), named("inner ring"));
    let mut contacts = Vec::new();
    let mut touch = |surfaces: [Option<(usize, Side)>; 2], friction: f64| {
        if let [Some(one), Some(other)] = surfaces {
            contacts.push(ContactPair { surfaces: [one, other], friction });
        }
    };
    for (body, _) in mesh.bodies.iter().enumerate().filter(|(_, body)| body.name.starts_with("roller ")) {
        for raceway in [outer.map(|ring| (ring, Side::Inside)), inner.map(|ring| (ring, Side::Outside))] {
            touch([Some((body, Side::Outside)), raceway], scene.contact.friction);
        }
    }
    // An adapter has its seat on its outer boundary, a block about the ring in its bore.
    let blocks = [("adapter", Side::Outside), ("pedestal", Side::Inside), ("housing", Side::Inside)];
    for (block, side) in blocks {
        let seat = named(block).map(|block| (block, side));
        touch([outer.map(|ring| (ring, Side::Outside)), seat], scene.contact.seat_friction);
    }
    let held = matches!(scene.housing, HousingScene::Rigid(_));
    Model {
        mesh,
        youngs_modulus: 1e9 * youngs_modulus_gpa,
        poissons_ratio,
        density: density_kg_m3,
        thickness: Geometry::of(scene).thickness,
        rigid: named("cage").into_iter().chain(outer.filter(|_| held)).collect(),
        contacts,
    }
}
