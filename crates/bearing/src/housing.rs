//! What holds the outer ring, from the scene: the paper's adapter, a pedestal, a mesh from a file, a frame on springs.

use std::path::Path;

use stribeck_mesh::{Annulus, BoredBlock, Mesh, Part, SeatedBlock, Surface, decks::Deck};
use stribeck_scene::{
    geometry::Geometry,
    housing::{HousingScene, MeshHousingScene, PedestalScene, SpringHousingScene},
    scene::Scene,
};

use crate::{error::Error, grading};

/// Height of the flattest cells over the wanted size: rings and rollers have cells as narrow, and one that is narrower
/// would set the time step.
const FLATTEST: f64 = 0.91;

/// A frame on springs stands so far off the ring, and is so thick, in radii of its bore: it is drawn, and has a mass, no more.
const FRAME_GAP: f64 = 0.02;
const FRAME_THICKNESS: f64 = 0.04;

/// Nodes of a bore lie within this part of its radius around the outer ring.
const LOOSE: f64 = 0.01;

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

/// The housing of a scene; none where the outer ring does not deform, because it moves as one with it. `back` is the outer
/// ring's outer surface in `mesh`.
///
/// # Errors
/// When it cannot be meshed, or its file says something else.
pub(crate) fn housing(
    scene: &Scene,
    g: &Geometry,
    mesh: &Mesh,
    back: &Surface,
) -> Result<Option<Housing>, Error> {
    let made = match &scene.housing {
        HousingScene::Adapter => Housing {
            name: "adapter",
            part: adapter(g, mesh, back)?,
            seat: Some("seat"),
            loaded: "top",
            density: 1.0,
        },
        HousingScene::Pedestal(pedestal) => Housing {
            name: "pedestal",
            part: pedestal_part(pedestal, g, mesh, back)?,
            seat: Some("bore"),
            loaded: "base",
            density: 1.0,
        },
        HousingScene::Mesh(file) => Housing {
            name: "housing",
            part: from_file(file, g)?,
            seat: Some("bore"),
            loaded: "loaded",
            density: 1.0,
        },
        HousingScene::Springs(springs) => frame(springs, g, back)?,
        HousingScene::Rigid(_) => return Ok(None),
    };
    Ok(Some(made))
}

/// The adapter. In a graded mesh its seat is the polygon of the outer ring, whose back surface is given.
fn adapter(g: &Geometry, mesh: &Mesh, back: &Surface) -> Result<Part, Error> {
    let size = g.element_size;
    let mut adapter = SeatedBlock {
        width: g.adapter_width,
        height: g.adapter_height,
        seat_radius: g.outer_race_radius + g.outer_ring_thickness,
        columns: ((g.adapter_width / size).round() as usize).max(2),
        rows: adapter_rows(g, size),
    };
    let Some(coarse) = g.coarse_size else { return Ok(adapter.part()?) };
    let seat = grading::seat(back, &mesh.x, &mesh.y, 0.5 * adapter.width, size);
    adapter.columns = seat.len() - 1;
    adapter.rows = adapter_rows(g, coarse);
    Ok(adapter.part_on(&seat)?)
}

/// Rows of the adapter: as many as leave no cell much flatter than the wanted size. Columns are shortest at the crown.
fn adapter_rows(g: &Geometry, size: f64) -> usize {
    ((g.adapter_height / (FLATTEST * size)) as usize).max(2)
}

/// A pedestal whose bore is the polygon of the outer ring.
fn pedestal_part(pedestal: &PedestalScene, g: &Geometry, mesh: &Mesh, back: &Surface) -> Result<Part, Error> {
    let bore: Vec<[f64; 2]> = back.nodes.iter().map(|&n| [mesh.x[n as usize], mesh.y[n as usize]]).collect();
    let [width, base, top] = [pedestal.width_mm, pedestal.base_mm, pedestal.top_mm].map(|mm| 1e-3 * mm);
    let wall = (0.5 * width).min(base).min(top) - (g.outer_race_radius + g.outer_ring_thickness);
    let size = g.coarse_size.unwrap_or(g.element_size);
    let rows = ((wall / (FLATTEST * size)) as usize).max(2);
    Ok(BoredBlock { bore: &bore, width, base, top, rows }.part()?)
}

/// A frame that stands off the ring, of one row of cells.
fn frame(springs: &SpringHousingScene, g: &Geometry, back: &Surface) -> Result<Housing, Error> {
    let radius = g.outer_race_radius + g.outer_ring_thickness;
    let inner_radius = (1.0 + FRAME_GAP) * radius;
    let ring = Annulus {
        inner_radius,
        outer_radius: inner_radius + FRAME_THICKNESS * radius,
        facets: back.nodes.len(),
        layers: 1,
        start_angle: 0.0,
        grooves: Vec::new(),
    };
    let part = ring.part()?;
    let density = springs.mass_kg / (part.area() * g.thickness * g.material.density);
    Ok(Housing { name: "frame", part, seat: None, loaded: "outer", density })
}

/// The mesh of a file, with its bore and its loaded edge.
fn from_file(housing: &MeshHousingScene, g: &Geometry) -> Result<Part, Error> {
    let refuse = |what: String| Error::HousingFile { file: housing.file.clone(), what };
    let extension = Path::new(&housing.file).extension().and_then(|e| e.to_str()).unwrap_or_default();
    let deck = Deck::of_extension(extension)
        .ok_or_else(|| refuse("its name ends in neither `.msh`, `.inp` nor `.k`".to_owned()))?;
    let read = deck.read(&housing.text).map_err(|fault| refuse(fault.to_string()))?;
    let mut part = read.part().map_err(|error| refuse(error.to_string()))?;
    let unit = 1e-3 * housing.unit_mm;
    part.x.iter_mut().chain(&mut part.y).for_each(|place| *place *= unit);
    for (surface, name) in [("bore", &housing.bore), ("loaded", &housing.loaded)] {
        let sets = || read.node_sets.keys().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
        let nodes = read.node_sets.get(name).ok_or_else(|| {
            let there = if read.node_sets.is_empty() { "none".to_owned() } else { sets() };
            refuse(format!("it has no set of nodes `{name}`, which `housing.{surface}` names; sets: {there}"))
        })?;
        let mut pieces = part.boundary_along(nodes);
        pieces.sort_by_key(|piece| std::cmp::Reverse(piece.facets()));
        let Some(longest) = pieces.first() else {
            return Err(refuse(format!("no edge of an element lies along the set `{name}`")));
        };
        if surface == "bore" && !(longest.closed && pieces.len() == 1) {
            let places = pieces.len();
            return Err(refuse(format!(
                "the set `{name}` is no closed bore, but {places} pieces of boundary"
            )));
        }
        if surface == "bore" {
            let ring = g.outer_race_radius + g.outer_ring_thickness;
            let radius = |n: &u32| part.x[*n as usize].hypot(part.y[*n as usize]);
            let off = longest.nodes.iter().map(radius).find(|radius| (radius / ring - 1.0).abs() > LOOSE);
            if let Some(radius) = off {
                return Err(refuse(format!(
                    "its bore does not fit the outer ring: a node lies {:.4} mm from the centre, the ring is {:.4} mm in radius. Look at \
                     `housing.unit_mm`; the bearing's centre is the origin of the mesh",
                    1e3 * radius,
                    1e3 * ring
                )));
            }
        }
        part.surfaces.push((surface.to_owned(), longest.clone()));
    }
    Ok(part)
}
