//! The mesh: element size, facets of raceways and rolling elements, grading.

use crate::{group, words};

group! {
    /// Discretisation.
    pub struct MeshScene {
        /// Element edge [mm].
        pub size_mm: f64 = 0.5, positive(1_000.0);
        /// Facets (= vertices) of a roller's boundary polygon.
        pub roller_facets: usize = 112, within(8.0, 100_000.0);
        /// Orientation of the 24 copies of the roller mesh.
        pub roller_copies: RollerCopies = RollerCopies::Rotated;
        /// Angle by which every roller's mesh is turned about its own centre, in addition [°].
        pub roller_phase_deg: f64 = 0.0, within(-360.0, 360.0), before("0.0");
        /// Facets of the outer raceway; `None` takes the circumference divided by the size.
        pub outer_facets: Option<usize> = None, within(16.0, 1e6);
        /// Facets of the inner raceway; `None` takes the circumference divided by the size.
        pub inner_facets: Option<usize> = None, within(16.0, 1e6);
        /// Larger elements away from the raceways; `None` gives every body elements of the size above.
        pub grading: Option<GradingScene> = None;
    }
}

group! {
    /// Larger elements away from the raceways and the rims of the rollers.
    ///
    /// Facets that roll on each other keep their length, so a graded mesh has the same facet-passing tone. In
    /// the rings three facets become one, as often as `coarse_mm` and the thickness of the ring allow. The
    /// adapter continues the columns of the outer ring, the rollers get a coarser core.
    pub struct GradingScene {
        /// Element edge that is not exceeded in the rings and the rollers, and the height of the adapter's
        /// elements [mm].
        pub coarse_mm: f64 = 2.0, positive(1_000.0);
        /// Layers of full fineness along the raceways; rollers get one more.
        pub fine_layers: usize = 2, within(1.0, 1_000.0);
    }
}

words! {
    /// How the mesh of one roller is copied around the pitch circle.
    pub enum RollerCopies: Copy, Eq {
        /// Every copy keeps the same orientation in space.
        Translated = "translated",
        /// Every copy is turned with its position on the pitch circle.
        Rotated = "rotated",
    }
}

group! {
    /// A ring from a Gmsh or Abaqus file of plane quadrilaterals and triangles, with the centre of
    /// the bearing in the origin. Its material is that of the bearing, its raceway the circle of `bearing`,
    /// with the cut-outs of the file.
    pub struct RingMeshScene {
        /// The file, `.msh` or `.inp`; its path counts from the folder of the scene.
        pub file: String = String::new();
        /// Length unit of the file [mm]: 1 for files in millimetres, 1000 for metres.
        pub unit_mm: f64 = 1.0, positive(1e6);
        /// Content of the file, inserted when a scene is read, so that a run holds its complete scene.
        pub text: String = String::new(), internal(), omitted();
        /// Name of the set of nodes all along the raceway.
        pub raceway: String = "raceway".into();
        /// Name of the set of nodes all along the other side: the outer ring's back, which sits in the
        /// housing, or the inner ring's bore, which turns with the shaft.
        pub fit: String = "fit".into();
    }
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
