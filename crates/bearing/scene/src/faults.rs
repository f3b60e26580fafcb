//! Which surfaces of a scene have defects, and which of them a report treats first.

use std::f64::consts::PI;

use crate::deviation::{DeviationScene, FormScene, RollingSurface};
use crate::scene::{DefectRing, DefectScene, Scene};

impl Scene {
    /// Numbers of the rollers that are not missing, from 1.
    pub fn rollers_in_place(&self) -> impl Iterator<Item = usize> {
        let missing = |number: usize| {
            let of = |deviation: &DeviationScene| {
                deviation.on == RollingSurface::Roller(number) && deviation.form == FormScene::Missing
            };
            self.defects.iter().any(of)
        };
        (1..=self.bearing.rollers).filter(move |number| !missing(*number))
    }

    /// Spalls with steep walls, which meshes of raceways are cut with: `defect`, then those of `defects` in
    /// their order.
    pub fn grooves(&self) -> Vec<DefectScene> {
        self.defect.iter().cloned().chain(self.defects.iter().filter_map(DeviationScene::groove)).collect()
    }

    /// Spalls of raceways, whose entries and exits a report looks for: `defect`, then those of `defects` in
    /// their order.
    pub fn spalls(&self) -> Vec<DefectScene> {
        let of_defects = self.defects.iter().filter_map(|deviation| {
            let FormScene::Spall(spall) = &deviation.form else { return None };
            if let Some(groove) = deviation.groove() {
                return Some(groove);
            }
            let ring = deviation.on.ring()?;
            let [_, facet] = rolling_circle(self, deviation.on);
            let edge = if spall.edge_mm > 0.0 { spall.edge_mm } else { facet };
            Some(DefectScene {
                ring,
                length_mm: spall.length_mm,
                depth_mm: spall.depth_mm,
                angle_deg: deviation.angle_deg,
                edge_slope_deg: libm::atan2(spall.depth_mm, edge).to_degrees(),
                width_mm: None,
            })
        });
        self.defect.iter().cloned().chain(of_defects).collect()
    }

    /// Whether rolling elements strike edges: of spalls in rings, or of those that are their own.
    pub fn has_edges(&self) -> bool {
        let is_spall = |deviation: &DeviationScene| matches!(deviation.form, FormScene::Spall(_));
        self.defect.is_some() || self.defects.iter().any(is_spall)
    }

    /// The first of [`Scene::spalls`].
    pub fn leading_spall(&self) -> Option<DefectScene> {
        self.spalls().into_iter().next()
    }

    /// Surfaces with a defect that strikes once a passage: spalls, dents and profiles, each surface once, the
    /// outer raceway first and rollers last. Waves and other diameters are none.
    pub fn faults(&self) -> Vec<RollingSurface> {
        let of_defect = self.defect.iter().map(|defect| match defect.ring {
            DefectRing::Outer => RollingSurface::Outer,
            DefectRing::Inner => RollingSurface::Inner,
        });
        let local = self.defects.iter().filter(|deviation| deviation.form.length_mm().is_some());
        let mut faults: Vec<RollingSurface> = of_defect.chain(local.map(|deviation| deviation.on)).collect();
        faults.sort_unstable();
        faults.dedup();
        faults
    }
}

impl RollingSurface {
    /// The ring whose raceway it is.
    pub fn ring(self) -> Option<DefectRing> {
        match self {
            Self::Outer => Some(DefectRing::Outer),
            Self::Inner => Some(DefectRing::Inner),
            Self::Roller(_) => None,
        }
    }
}

impl DeviationScene {
    /// The groove that a mesh is cut with, where it is one.
    pub fn groove(&self) -> Option<DefectScene> {
        let FormScene::Spall(spall) = &self.form else { return None };
        let (length_mm, depth_mm, angle_deg) = (spall.length_mm, spall.depth_mm, self.angle_deg);
        let ring = self.on.ring().filter(|_| self.is_cut())?;
        Some(DefectScene { ring, length_mm, depth_mm, angle_deg, edge_slope_deg: 90.0, width_mm: None })
    }
}

/// Diameter of a rolling surface and length of its facets [mm].
pub(crate) fn rolling_circle(scene: &Scene, on: RollingSurface) -> [f64; 2] {
    let (b, mesh) = (&scene.bearing, &scene.mesh);
    let (diameter, facets) = match on {
        RollingSurface::Outer => (b.outer_race_diameter_mm, mesh.outer_facets),
        RollingSurface::Inner => (b.inner_race_diameter_mm, mesh.inner_facets),
        RollingSurface::Roller(_) => (b.roller_diameter_mm, Some(mesh.roller_facets)),
    };
    [diameter, facets.map_or(mesh.size_mm, |n| PI * diameter / n as f64)]
}
