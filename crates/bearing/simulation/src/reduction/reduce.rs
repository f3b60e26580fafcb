//! From a scene to a reduced mesh, stage by stage (THEORY §9.1–9.3).

use std::{collections::BTreeSet, f64::consts::TAU};

use crate::bearing::{
    assembly::{Assembly, MeshedParts},
    start::preload,
};
use serde::{Deserialize, Serialize};
use stribeck_mesh::Mesh;
use stribeck_reduced::modal::{GROUP, Reduction, Seat};
use stribeck_scene::{housing::HousingScene, resolved::ResolvedScene};
use stribeck_system::Parts;
use stribeck_theory::bearing::Bearing;
use stribeck_theory::contact_law::{ContactLawKind, element_mass};

use crate::error::Error;
use crate::reduction::{
    cache::{preload_n, reference},
    compliances::{Compliances, Patches},
    extraction::{Extraction, Preload},
    loads::{Loads, dampers, frame},
    raceway::{self, RacewayNode},
    seat,
    sensors::sensors,
    structure::Structure,
};

/// A mesh that has been preloaded and reduced: the same for every start, speed and duration, and where the outer ring
/// does not deform also for every load and spall.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ReducedMesh {
    /// The reduced rings, rollers and cage.
    pub reduction: Reduction,
    /// Rings and a roller as they were meshed.
    pub parts: MeshedParts,
    /// Displacements of the nodes of rings and housing at the preload [m].
    pub moved: Vec<[f64; 2]>,
    /// What bends between the rollers at the preload in none of the modes [m], largest radial displacement of
    /// the raceway: no roller feels it of another.
    pub between_rollers: f64,
    /// Warning of a preload that did not quite come to rest.
    pub warning: Option<String>,
    /// Flexibilities from which compliances follow.
    patches: Patches,
}

impl ReducedMesh {
    /// The reduced mesh of a scene.
    ///
    /// # Errors
    /// When the scene cannot be meshed or preloaded, or modes are not found.
    pub fn new(scene: &ResolvedScene) -> Result<Self, Error> {
        Self::of_reference(&reference(&scene.written).resolve())?.of_scene(scene)
    }

    /// Makes the full model of a [`reference`], preloads it and reduces it. A ring that does not deform needs no
    /// preload: nothing is linearised there.
    pub(crate) fn of_reference(scene: &ResolvedScene) -> Result<Self, Error> {
        let meshed = MeshedParts::new(scene)?;
        let assembly = Assembly::of(scene, &meshed)?;
        let mut bearing = assembly.build(scene, 1)?;
        let warning = match scene.written.housing.is_rigid() {
            true => None,
            false => preload(&mut bearing, scene, &assembly.kinematics)?,
        };
        let mesh = &assembly.model.mesh;
        let (mut extraction, mut parts) = Extraction::of(scene, bearing, mesh)?;
        let moved = std::mem::take(&mut extraction.moved);
        let (reduction, patches, between_rollers) = reduce(scene, mesh, &extraction, &mut parts)?;
        Ok(Self { reduction, parts: meshed, moved, between_rollers, warning, patches })
    }

    /// What the reduction of its reference becomes in a scene: where the outer ring does not deform, grooves are cut
    /// into the raceways, forces are those of the scene's load, and compliances reach up to it.
    pub(crate) fn of_scene(mut self, scene: &ResolvedScene) -> Result<Self, Error> {
        if !scene.written.housing.is_rigid() {
            return Ok(self);
        }
        self.parts = self.parts.cut(scene)?;
        let Reduction { outer, inner, constant, external, load, .. } = &mut self.reduction;
        [*outer, *inner] = self.parts.raceways();
        let load_n = preload_n(&scene.written);
        let share = load_n / load.force;
        for (force, along) in constant.iter_mut().chain(external).zip(load.along.iter().chain(&load.along)) {
            *force += (share - 1.0) * along;
        }
        load.force = load_n;
        load.along.iter_mut().chain(&mut load.across).for_each(|force| *force *= share);
        let Compliances { outer, inner, wall } = self.patches.compliances(scene);
        // What the bodies store under the load at rest, by which the ledger's error is measured.
        let stored = [outer.curve(), inner.curve()];
        let under = |force: &f64| stored.iter().map(|curve| curve.energy(*force)).sum::<f64>();
        self.reduction.strain = scene.static_load().map_or(0.0, |load| load.roller_n.iter().map(under).sum());
        self.reduction.outer_compliance = outer;
        self.reduction.inner_compliance = inner;
        self.reduction.wall_compliance = wall;
        Ok(self)
    }
}

/// Reduces a bearing that has been taken apart at its preload. Returns the patches of its contacts and what bends
/// between rollers beyond the modes, too [m].
fn reduce(
    scene: &ResolvedScene,
    mesh: &Mesh,
    from: &Extraction,
    parts: &mut Parts,
) -> Result<(Reduction, Patches, f64), Error> {
    let count = parts.dynamics.state.x.len();
    let preload = Preload::of(from, parts, mesh, may_close(scene));
    let mut structure = Structure::of(scene, from, &preload, &parts.dynamics)?;
    let nodes = raceway::nodes(from);
    let springs = panels(scene, from, &preload, parts, &nodes, &mut structure)?;
    let modes = structure.squares().len();
    let padded = modes.next_multiple_of(GROUP);
    let rollers = raceway::roller_forces(from, count);
    let loads = Loads::of(
        &structure,
        &preload,
        &nodes,
        springs.as_ref(),
        &rollers,
        (scene.written.operation.load_n, padded),
    );
    let dents = raceway::dents(from, &mut structure, rollers);
    let between_rollers = raceway::between_rollers(&nodes, &dents, scene.rollers);
    let outer = raceway::without_dents(from, &dents);
    let sensors = sensors(from, &mut structure, &outer, count, padded);
    let patches = Patches::of(scene, from, &parts.dynamics, &mut structure, &outer)?;
    let compliances = patches.compliances(scene);
    let mut squares = vec![0.0; padded];
    squares[..modes].copy_from_slice(structure.squares());
    let reduction = Reduction {
        modes,
        padded,
        squares,
        shapes: raceway::shapes(&nodes, &structure, springs.as_ref(), padded),
        outer,
        // As it was meshed: it turns on as a rigid body.
        inner: from.nodes.inner.iter().map(|&n| [mesh.x[n as usize], mesh.y[n as usize]]).collect(),
        roller: round_rim(scene.roller_radius, from.nodes.rim.len()),
        sensors,
        constant: if scene.written.housing.is_rigid() { loads.external.clone() } else { loads.constant },
        external: loads.external,
        load: loads.load,
        dampers: dampers(scene, &structure, &preload, padded),
        frame: frame(from, &structure, padded),
        strain: preload.strain,
        outer_compliance: compliances.outer,
        inner_compliance: compliances.inner,
        wall_compliance: compliances.wall,
        roller_inertia: element_inertia(scene).unwrap_or(from.roller.mass_and_moment),
        cage: from.cage.map(|cage| (cage.mass_and_moment, cage.centre)),
        structure_mass: from.structure_mass,
        seat: from.seat,
        springs,
    };
    Ok((reduction, patches, between_rollers))
}

/// Mass [kg] and moment of inertia [kg m²] of balls, for which cylinders of another mass are meshed; `None` for
/// rollers.
fn element_inertia(scene: &ResolvedScene) -> Option<[f64; 2]> {
    (scene.contact_law == ContactLawKind::Ball).then(|| {
        let mass = element_mass(&Bearing::from(scene), ContactLawKind::Ball);
        [mass, 0.4 * mass * scene.roller_radius.powi(2)]
    })
}

/// Part of the approach of the most loaded roller below which a gap in the seat may close as rollers pass.
const MAY_CLOSE: f64 = 0.1;

/// Gap at the preload below which a contact point of the seat may come to carry [m]. A pedestal is all around
/// the ring, and what it presses reaches as far as the rollers that are loaded; an adapter ends before them.
fn may_close(scene: &ResolvedScene) -> f64 {
    match scene.written.housing {
        HousingScene::Pedestal(_) => {
            scene.static_load().map_or(0.0, |load| MAY_CLOSE * load.max_approach_m())
        }
        _ => 0.0,
    }
}

/// Divides the seat into panels; the modes become those of a seat that holds.
fn panels(
    scene: &ResolvedScene,
    from: &Extraction,
    preload: &Preload,
    parts: &Parts,
    raceway: &[RacewayNode],
    structure: &mut Structure,
) -> Result<Option<Seat>, Error> {
    let on_ring: BTreeSet<u32> = from.slots(&from.nodes.outer_ring).into_iter().collect();
    let back: Vec<(u32, [f64; 2])> =
        from.nodes.back.iter().map(|&n| (from.slot(n), from.contact_forces[n as usize])).collect();
    let seat = seat::Parts {
        raceway,
        springs: &preload.seat,
        gaps: &preload.gaps,
        friction: scene.written.contact.seat_friction > 0.0,
        x: &parts.dynamics.state.x,
        y: &parts.dynamics.state.y,
        back: &back,
        sensors: &from.slots(&from.nodes.sensors),
        of_ring: &|slot| on_ring.contains(&slot),
        thickness: scene.outer_ring_thickness,
    };
    seat::of(structure, &seat)
}

/// Vertices of a round roller that is not turned, counter-clockwise [m].
fn round_rim(radius: f64, facets: usize) -> Vec<[f64; 2]> {
    (0..facets)
        .map(|i| libm::sincos(TAU * i as f64 / facets as f64))
        .map(|(s, c)| [radius * c, radius * s])
        .collect()
}
