//! The mesh: element size, facets of raceways and rolling elements, grading.

use serde::{Deserialize, Serialize};

/// Discretisation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MeshScene {
    /// Element edge [mm].
    pub size_mm: f64,
    /// Facets (= vertices) of a roller's boundary polygon.
    pub roller_facets: usize,
    /// Orientation of the 24 copies of the roller mesh.
    pub roller_copies: RollerCopies,
    /// Angle by which every roller's mesh is turned about its own centre, in addition [°].
    pub roller_phase_deg: f64,
    /// Facets of the outer raceway; `None` takes the circumference divided by the size.
    pub outer_facets: Option<usize>,
    /// Facets of the inner raceway; `None` takes the circumference divided by the size.
    pub inner_facets: Option<usize>,
    /// Larger elements away from the raceways; `None` gives every body elements of the size above.
    pub grading: Option<GradingScene>,
}

/// Larger elements away from the raceways and the rims of the rollers.
///
/// Facets that roll on each other keep their length, so a graded mesh has the same facet-passing tone. In the
/// rings three facets become one, as often as `coarse_mm` and the thickness of the ring allow. The adapter
/// continues the columns of the outer ring, the rollers get a coarser core.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct GradingScene {
    /// Element edge that is not exceeded in the rings and the rollers, and the height of the adapter's
    /// elements [mm].
    pub coarse_mm: f64,
    /// Layers of full fineness along the raceways; rollers get one more.
    pub fine_layers: usize,
}

/// How the mesh of one roller is copied around the pitch circle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RollerCopies {
    /// Every copy keeps the same orientation in space.
    Translated,
    /// Every copy is turned with its position on the pitch circle.
    Rotated,
}

/// Side of the squares inside a graded roller, in facets of its rim. With longer ones the triangles between
/// rim and core become needles, and little more is saved: most elements of a roller lie along its rim.
const CORE_FACETS: f64 = 3.0;

impl GradingScene {
    /// Side of the squares inside a roller whose facets are `facet_mm` long [mm].
    pub fn roller_core_mm(&self, facet_mm: f64) -> f64 {
        self.coarse_mm.min(CORE_FACETS * facet_mm)
    }
}

impl Default for MeshScene {
    fn default() -> Self {
        Self {
            size_mm: 0.5,
            roller_facets: 112,
            roller_copies: RollerCopies::Rotated,
            roller_phase_deg: 0.0,
            outer_facets: None,
            inner_facets: None,
            grading: None,
        }
    }
}

impl Default for GradingScene {
    fn default() -> Self {
        Self { coarse_mm: 2.0, fine_layers: 2 }
    }
}
