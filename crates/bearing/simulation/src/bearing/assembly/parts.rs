//! Bodies by themselves: the rings with their grooves, a rolling element, the pieces of the cage.

use std::f64::consts::{PI, TAU};

use serde::{Deserialize, Serialize};
use stribeck_mesh::{Annulus, ArcBlock, Circle, Disc, FormDeviation, Groove, Part};
use stribeck_scene::{
    deviation::Relief,
    resolved::{CageGeometry, DefectGeometry, ResolvedScene, pocket_half_width},
    scene::DefectRing,
};

use crate::bearing::{grading, own_mesh};
use crate::error::Error;

/// Element size of the cage [mm]. It moves as one piece: its elements carry mass only and may be coarse.
pub const CAGE_ELEMENT_MM: f64 = 2.0;

/// Meshes of the rings and of one roller, kept because meshing takes time. They have grooves, but no
/// deviations from round yet; the roller lies at the origin, not rotated.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MeshedParts {
    pub(super) outer: Part,
    pub(super) inner: Part,
    pub(super) disc: Part,
}

impl MeshedParts {
    /// Meshes them. They do not depend on the initial position of the rollers.
    pub fn new(scene: &ResolvedScene) -> Result<Self, Error> {
        let outer = ring(scene, DefectRing::Outer, true)?;
        let inner = ring(scene, DefectRing::Inner, true)?;
        let b = &scene.written.bearing;
        let facets = scene.written.mesh.roller_facets;
        let facet_mm = PI * b.roller_diameter_mm / facets as f64;
        let core = 1e-3 * grading::roller_core_mm(&scene.written.mesh, facet_mm);
        let disc = Disc { radius: scene.roller_radius, facets, size: core, rotation: 0.0 };
        let disc = match &scene.written.mesh.grading {
            None => disc.part()?,
            Some(scene) => disc.part_with_layers(grading::roller_layers(scene).min(disc.most_layers()))?,
        };
        Ok(Self { outer, inner, disc })
    }

    /// Parts without grooves, with those of a scene cut into them: of rings that do not deform.
    pub(crate) fn cut(mut self, scene: &ResolvedScene) -> Result<Self, Error> {
        for (part, which) in [(&mut self.outer, DefectRing::Outer), (&mut self.inner, DefectRing::Inner)] {
            if scene.grooves_of(which).next().is_some() {
                *part = ring(scene, which, false)?;
            }
        }
        Ok(self)
    }

    /// Vertices of the outer and of the inner raceway [m], counter-clockwise.
    pub(crate) fn raceways(&self) -> [Vec<[f64; 2]>; 2] {
        let of = |part: &Part, name: &str| -> Vec<[f64; 2]> {
            let surface = part.surface(name).expect("a ring names its surfaces");
            surface.nodes.iter().map(|&n| [part.x[n as usize], part.y[n as usize]]).collect()
        };
        // The mesh walks the outer raceway clockwise, with the solid on the left.
        let mut outer = of(&self.outer, "inner");
        outer.reverse();
        [outer, of(&self.inner, "outer")]
    }
}

/// One of the rings with its grooves, its cells `shaped` beside them or as they fall; graded ones are shaped anyhow.
fn ring(scene: &ResolvedScene, ring: DefectRing, shaped: bool) -> Result<Part, Error> {
    let (b, mesh) = (&scene.written.bearing, &scene.written.mesh);
    let (own, radii, thickness_mm, fine) = match ring {
        DefectRing::Outer => {
            let radius = scene.outer_race_radius;
            let radii = [radius, radius + scene.outer_ring_thickness];
            (&scene.written.outer_ring_mesh, radii, b.outer_ring_thickness_mm, Circle::Inner)
        }
        DefectRing::Inner => {
            let radius = scene.inner_race_radius;
            let radii = [radius - scene.inner_ring_thickness, radius];
            (&scene.written.inner_ring_mesh, radii, b.inner_ring_thickness_mm, Circle::Outer)
        }
    };
    if let Some(own) = own {
        return own_mesh::ring(own, ring, scene);
    }
    let annulus = Annulus {
        inner_radius: radii[0],
        outer_radius: radii[1],
        facets: facets_around(scene, ring),
        layers: grading::layers(mesh, thickness_mm),
        start_angle: 0.0,
        grooves: grooves_in(scene, ring),
    };
    Ok(match grading::ring(mesh, thickness_mm, fine) {
        Some(grading) => annulus.graded_part(&grading)?,
        None if shaped => annulus.part()?,
        None => annulus.unshaped_part()?,
    })
}

/// The part with the deviations from round of one of its surfaces.
pub(super) fn formed(
    part: Part,
    surface: &str,
    circle: Circle,
    relief: Option<&Relief>,
) -> Result<Part, Error> {
    let Some(relief) = relief else { return Ok(part) };
    let (depth, corners) = (|angle: f64| relief.depth(angle), relief.corners());
    Ok(FormDeviation { depth: &depth, corners: &corners, circle }.of_part(&part, surface)?)
}

/// Facets around the raceway of `ring`, before grooves are cut into it.
pub(super) fn facets_around(scene: &ResolvedScene, ring: DefectRing) -> usize {
    let (chosen, radius) = match ring {
        DefectRing::Outer => (scene.written.mesh.outer_facets, scene.outer_race_radius),
        DefectRing::Inner => (scene.written.mesh.inner_facets, scene.inner_race_radius),
    };
    chosen.unwrap_or_else(|| ((TAU * radius / scene.element_size).round() as usize).max(8))
}

/// The grooves in the raceway of `ring`.
fn grooves_in(scene: &ResolvedScene, ring: DefectRing) -> Vec<Groove> {
    let circle = match ring {
        DefectRing::Outer => Circle::Inner,
        DefectRing::Inner => Circle::Outer,
    };
    let cut = |d: &DefectGeometry| Groove {
        centre_angle: d.angle,
        length: d.length,
        depth: d.depth,
        slope: d.edge_slope,
        circle,
    };
    scene.grooves_of(ring).map(cut).collect()
}

/// All pieces of the cage as one body whose walls extend between two radii [m], for rollers on a circle of
/// radius `path` [m]. Surfaces in the order of the rollers: piece i lies between roller i and the next one
/// counter-clockwise.
pub(super) fn cage_part(
    scene: &ResolvedScene,
    cage: &CageGeometry,
    [inner, outer]: [f64; 2],
    path: f64,
) -> Result<Part, Error> {
    let reach = scene.roller_radius + cage.pocket_clearance;
    let half_width = pocket_half_width(inner, outer, path, reach);
    let pieces = scene.rollers;
    let gap = 2.0 * libm::asin(half_width / outer);
    let arc = (TAU / pieces as f64 - gap) * outer;
    let mut joined = Part::default();
    for i in 0..pieces {
        let piece = ArcBlock {
            inner_radius: inner,
            outer_radius: outer,
            right_line_angle: scene.pocket_angle(i),
            left_line_angle: scene.pocket_angle(i) + TAU / pieces as f64,
            half_width,
            rows: ((1e3 * (outer - inner) / CAGE_ELEMENT_MM).round() as usize).max(1),
            columns: ((1e3 * arc / CAGE_ELEMENT_MM).round() as usize).max(1),
        };
        let piece = piece.part()?;
        let first = joined.x.len() as u32;
        joined.x.extend(&piece.x);
        joined.y.extend(&piece.y);
        joined.quads.extend(piece.quads.iter().map(|q| q.map(|n| n + first)));
        let mut boundary = piece.surface("boundary").expect("an arc block names its boundary").clone();
        boundary.nodes.iter_mut().for_each(|n| *n += first);
        joined.surfaces.push((format!("piece {}", i + 1), boundary));
    }
    Ok(joined)
}
