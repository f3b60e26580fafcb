//! The mesh of a run as a model for other finite element programs.

use std::path::PathBuf;

use anyhow::{Result, bail};
use stribeck_mesh::decks::{ContactPair, Deck, Model, Side, Step};
use stribeck_mesh::{Body, Mesh};
use stribeck_scene::housing::HousingScene;
use stribeck_scene::resolved::ResolvedScene;
use stribeck_scene::scene::MaterialScene;
use stribeck_simulation::bearing::assembly::Assembly;
use stribeck_store::mesh_file::{self, RunMesh};
use stribeck_store::run_dir::{Run, RunDir, write_atomic};

use super::provenance;

/// The mesh of the run, each body a part or set of its name, with material, sections and contacts where the
/// format has them.
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
    // Gmsh's files have no place for it.
    let step = if deck == Deck::Gmsh { None } else { Some(step(&run.scene, &mesh)?) };
    let model = Model { step, ..model(&run.scene, &mesh) };
    write_atomic(&path, deck.write_model(&model, &title).as_bytes())?;
    Ok(path)
}

/// Materials and constraints of the scene for the bodies of its mesh. The cage touches nothing here: its
/// pockets are walls of the scene, not of the mesh.
fn model<'a>(scene: &ResolvedScene, mesh: &'a Mesh) -> Model<'a> {
    let MaterialScene { youngs_modulus_gpa, poissons_ratio, density_kg_m3 } = scene.written.material;
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
            touch([Some((body, Side::Outside)), raceway], scene.written.contact.friction);
        }
    }
    // An adapter has its seat on its outer boundary, a block about the ring in its bore.
    let blocks = [("adapter", Side::Outside), ("pedestal", Side::Inside), ("housing", Side::Inside)];
    for (block, side) in blocks {
        let seat = named(block).map(|block| (block, side));
        touch([outer.map(|ring| (ring, Side::Outside)), seat], scene.written.contact.seat_friction);
    }
    let held = scene.written.housing.is_rigid();
    Model {
        mesh,
        youngs_modulus: 1e9 * youngs_modulus_gpa,
        poissons_ratio,
        density: density_kg_m3,
        thickness: scene.thickness,
        rigid: named("cage").into_iter().chain(outer.filter(|_| held)).collect(),
        contacts,
        step: None,
    }
}

/// The step of the scene: loads, speeds and contacts, as far as decks can express them.
fn step(scene: &ResolvedScene, mesh: &Mesh) -> Result<Step> {
    let assembly = Assembly::new(scene)?;
    let (own, k) = (&assembly.model.mesh, &assembly.kinematics);
    if (&own.x, &own.y) != (&mesh.x, &mesh.y) {
        bail!(
            "another version of the program has made this run, which meshes the scene otherwise: repeat the \
             run, or `--to msh`, which has the mesh alone"
        );
    }
    let duty = &scene.duty;
    let guided = assembly.guided();
    let mut velocity = vec![[0.0; 2]; mesh.x.len()];
    for body in &mesh.bodies {
        let roller = body.name.strip_prefix("roller ").and_then(|number| number.parse::<usize>().ok());
        let (centre, rate, orbit) = match (body.name.as_str(), roller) {
            (_, Some(number)) => {
                let (s, c) = scene.roller_angle(number - 1).sin_cos();
                let path = scene.outer_race_radius - scene.roller_radius;
                ([path * c, path * s], k.roller_rad_s, k.cage_rad_s)
            }
            ("inner ring", _) => ([0.0; 2], k.shaft_rad_s, 0.0),
            ("outer ring", _) => ([0.0; 2], k.outer_rad_s, 0.0),
            ("cage", _) => ([0.0; 2], k.cage_rad_s, 0.0),
            _ => ([0.0; 2], 0.0, 0.0),
        };
        for n in body.nodes.clone() {
            let [rx, ry] = [mesh.x[n] - centre[0], mesh.y[n] - centre[1]];
            velocity[n] = [-orbit * centre[1] - rate * ry, orbit * centre[0] + rate * rx];
        }
    }
    let [x, y] = scene.written.load_direction();
    let load = duty.load_n(0.0);
    // A guided housing takes the load on its top; a body without guide takes it around its surface.
    let loaded = if guided.is_empty() { all_around(mesh) } else { guided.clone() };
    Ok(Step {
        duration: 1e-3 * scene.written.solver.duration_ms,
        gravity: [0.0, -scene.written.operation.gravity_m_s2],
        load: (loaded, [load * x, load * y]),
        guided,
        turning: vec![(assembly.turned_by_the_shaft(), k.shaft_rad_s)],
        velocity,
        left_out: left_out(scene),
    })
}

/// Nodes along the outside of the outermost ring: of the frame on springs, or of a rigid outer ring.
fn all_around(mesh: &Mesh) -> Vec<u32> {
    let named = |name: &str| mesh.bodies.iter().find(|body| body.name == name);
    let Some(ring) = named("frame").or_else(|| named("outer ring")) else { return Vec::new() };
    let radius = |n: &usize| mesh.x[*n].hypot(mesh.y[*n]);
    let most = ring.nodes.clone().map(|n| radius(&n)).fold(0.0, f64::max);
    ring.nodes.clone().filter(|n| radius(n) > (1.0 - 1e-6) * most).map(|n| n as u32).collect()
}

/// Parts of a scene that a deck does not have.
fn left_out(scene: &ResolvedScene) -> Vec<String> {
    let o = &scene.written.operation;
    let profiles = o.speed_profile.is_some() || o.outer_speed_profile.is_some() || o.load_profile.is_some();
    let all = [
        (true, "the preload: the load is there from the start, and the bodies are free of stress"),
        (scene.written.cage.is_some(), "contact of the rollers with the cage"),
        (profiles, "profiles of speed and load: they stay as they are at the start"),
        (o.rotating_load.is_some(), "the load that turns with the shaft"),
        (scene.written.film.is_some(), "oil films"),
        (
            scene.element_share() != 1.0,
            "mass and approach of balls: cylinders as long as the rings are wide are heavier and stiffer",
        ),
        (scene.written.solver.structural_damping.is_some(), "structural damping"),
        (scene.written.solver.mass_damping_per_s > 0.0, "mass damping"),
        (scene.written.solver.stiffness_damping_ns > 0.0, "stiffness damping"),
        (
            matches!(scene.written.housing, HousingScene::Springs(_)),
            "the springs and dampers of the housing, which hold the ring",
        ),
        (scene.written.housing.is_rigid(), "the mass of the housing beyond that of the ring"),
    ];
    all.into_iter().filter(|(there, _)| *there).map(|(_, what)| what.to_owned()).collect()
}
