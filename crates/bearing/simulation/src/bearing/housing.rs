//! What holds the outer ring, from the scene: the paper's adapter, a pedestal, a mesh from a file, a frame on
//! springs.

use std::f64::consts::TAU;

use stribeck_mesh::{Annulus, BoredBlock, Mesh, Part, SeatedBlock, Surface};
use stribeck_scene::{
    housing::{HousingScene, PedestalScene, SpringHousingScene},
    resolved::ResolvedScene,
    scene::ContactSurface,
};

use crate::bearing::{grading, own_mesh};
use crate::error::Error;

/// Height of the flattest cells over the wanted size: rings and rollers have cells as narrow, and one that is
/// narrower would set the time step.
const FLATTEST: f64 = 0.91;

/// Rows of elements in which the wall of a housing bends as steel does: with four the largest force on a roller is off
/// by 3 %.
const TO_BEND: usize = 8;

/// Distance of a frame on springs from the ring, and its thickness, in radii of its bore: both are for
/// pictures and its mass alone.
const FRAME_GAP: f64 = 0.02;
const FRAME_THICKNESS: f64 = 0.04;

/// A body around or on top of the outer ring.
pub(crate) struct Housing {
    /// Its name in files and messages.
    pub(crate) name: &'static str,
    pub(crate) part: Part,
    /// Name of the surface that touches the outer ring; none of a frame on springs.
    pub(crate) seat: Option<&'static str>,
    /// Name of the surface that takes the load.
    pub(crate) loaded: &'static str,
    /// Density as a multiple of the bearing's.
    pub(crate) density: f64,
}

/// Whether facets of the seat, and of the ring in it, stand for arcs. Chords of different lengths on one circle do not
/// fit: a long one presses on the vertices between its ends.
pub(crate) fn seat_is_round(scene: &ResolvedScene) -> bool {
    scene.written.contact.surface != ContactSurface::Facet
}

/// The housing of a scene; none where the outer ring does not deform, because it moves as one with it. `back`
/// is the outer ring's outer surface in `mesh`.
pub(crate) fn housing(scene: &ResolvedScene, mesh: &Mesh, back: &Surface) -> Result<Option<Housing>, Error> {
    let back = &polygon(scene, mesh, back);
    let made = match &scene.written.housing {
        HousingScene::Adapter => Housing {
            name: "adapter",
            part: adapter(scene, back)?,
            seat: Some("seat"),
            loaded: "top",
            density: 1.0,
        },
        HousingScene::Pedestal(pedestal) => Housing {
            name: "pedestal",
            part: pedestal_part(pedestal, scene, back)?,
            seat: Some("bore"),
            loaded: "base",
            density: 1.0,
        },
        HousingScene::Mesh(file) => Housing {
            name: "housing",
            part: own_mesh::housing(file, scene)?,
            seat: Some("bore"),
            loaded: "loaded",
            density: 1.0,
        },
        HousingScene::Springs(springs) => frame(springs, scene, back)?,
        HousingScene::Rigid(_) | HousingScene::Machine(_) => return Ok(None),
    };
    Ok(Some(made))
}

/// The bore that holds the outer ring: its own polygon, so that both fit facet to facet; around a ring from a
/// file, which may have notches there, as many facets on its circle, or about it where they are chords.
fn polygon(scene: &ResolvedScene, mesh: &Mesh, back: &Surface) -> Vec<[f64; 2]> {
    if scene.written.outer_ring_mesh.is_none() {
        return back.nodes.iter().map(|&n| [mesh.x[n as usize], mesh.y[n as usize]]).collect();
    }
    let facet = TAU / back.nodes.len() as f64;
    let around = if seat_is_round(scene) { 1.0 } else { libm::cos(0.5 * facet) };
    let radius = (scene.outer_race_radius + scene.outer_ring_thickness) / around;
    (0..back.nodes.len())
        .map(|i| libm::sincos(i as f64 * facet))
        .map(|(s, c)| [radius * c, radius * s])
        .collect()
}

/// The adapter. In a graded mesh its seat is the polygon of the outer ring, whose back surface is given.
fn adapter(scene: &ResolvedScene, back: &[[f64; 2]]) -> Result<Part, Error> {
    let size = scene.element_size;
    let mut adapter = SeatedBlock {
        width: scene.adapter_width,
        height: scene.adapter_height,
        seat_radius: scene.outer_race_radius + scene.outer_ring_thickness,
        columns: ((scene.adapter_width / size).round() as usize).max(2),
        rows: rows(scene, scene.adapter_height, size),
    };
    let Some(coarse) = scene.coarse_size else { return Ok(adapter.part()?) };
    let seat = grading::seat(back, 0.5 * adapter.width, size, seat_is_round(scene));
    adapter.columns = seat.len() - 1;
    adapter.rows = rows(scene, adapter.height, coarse);
    Ok(adapter.part_on(&seat)?)
}

/// Rows of elements over a height [m]: as many as leave no cell much flatter than the wanted size, and more where that
/// would leave too few to bend. Columns of an adapter are shortest at the crown.
fn rows(scene: &ResolvedScene, height: f64, size: f64) -> usize {
    let fit = |size: f64| (height / (FLATTEST * size)) as usize;
    fit(size).max(fit(scene.element_size).min(TO_BEND)).max(2)
}

/// A pedestal whose bore is the polygon of the outer ring.
fn pedestal_part(pedestal: &PedestalScene, scene: &ResolvedScene, back: &[[f64; 2]]) -> Result<Part, Error> {
    let [width, base, top] = [pedestal.width_mm, pedestal.base_mm, pedestal.top_mm].map(|mm| 1e-3 * mm);
    let wall = (0.5 * width).min(base).min(top) - (scene.outer_race_radius + scene.outer_ring_thickness);
    let size = scene.coarse_size.unwrap_or(scene.element_size);
    Ok(BoredBlock { bore: back, width, base, top, rows: rows(scene, wall, size) }.part()?)
}

/// A frame that stands off the ring, of one row of cells.
fn frame(springs: &SpringHousingScene, scene: &ResolvedScene, back: &[[f64; 2]]) -> Result<Housing, Error> {
    let radius = scene.outer_race_radius + scene.outer_ring_thickness;
    let inner_radius = (1.0 + FRAME_GAP) * radius;
    let ring = Annulus {
        inner_radius,
        outer_radius: inner_radius + FRAME_THICKNESS * radius,
        facets: back.len(),
        layers: 1,
        start_angle: 0.0,
        grooves: Vec::new(),
    };
    let part = ring.part()?;
    let density = springs.mass_kg / (part.area() * scene.thickness * scene.material.density);
    Ok(Housing { name: "frame", part, seat: None, loaded: "outer", density })
}
