//! The scene: the only input a user writes. Every number carries its unit in its field name.

mod bearing;
mod contact;
pub mod deviation;
pub mod housing;
pub mod machine;
mod mesh;
mod operation;
mod output;
mod solver;

use crate::{group, words};

pub use bearing::{
    AdapterScene, Assumed, BearingScene, CageScene, DefectRing, DefectScene, ElementKind, MaterialScene,
    PocketWalls, Quality, RollerProfile,
};
pub(crate) use contact::MOST_FRICTION;
pub use contact::{
    ContactFormula, ContactInterpolation, ContactMethod, ContactPasses, ContactScene, ContactSurface,
    FilmScene, ResistanceScene,
};
pub use deviation::DeviationScene;
pub use housing::HousingScene;
pub use mesh::{GradingScene, MeshScene, RingMeshScene, RollerCopies};
pub use operation::{HarmonicScene, OperationScene, ProfileScene, RampScene, RotatingLoadScene};
pub use output::{FramesScene, GuardsScene, OutputScene, RecordsScene, SensorScene};
pub use solver::{DampedBody, DampingFrame, LONGEST_RUN_S, SolverScene, Start, StructuralDampingScene};

group! {
    /// A complete scene. Every field has a default; `()` in a file is the paper's bearing in oil, as
    /// `fixtures/scenes/oiled_steel.ron` spells it out.
    pub struct Scene {
        /// Short name, also that of the run directory.
        pub name: String = "oiled_steel".into();
        /// Which model of the bearing runs.
        pub model: ModelScene = ModelScene::Full, before("full");
        /// Rings and rolling elements.
        pub bearing: BearingScene = BearingScene::default();
        /// The rigid cage; `None` leaves the rollers unguided.
        pub cage: Option<CageScene> = Some(CageScene::default());
        /// The block that carries the load to the outer ring.
        pub adapter: AdapterScene = AdapterScene::default();
        /// Housing, which holds the outer ring and takes the load.
        pub housing: HousingScene = HousingScene::Adapter, omitted();
        /// The mesh of the outer ring from a file; `None` for one that the program makes.
        pub outer_ring_mesh: Option<RingMeshScene> = None, omitted();
        /// The mesh of the inner ring from a file; `None` likewise.
        pub inner_ring_mesh: Option<RingMeshScene> = None, omitted();
        /// Spall on a raceway; `None` is a healthy bearing.
        pub defect: Option<DefectScene> = Some(DefectScene::default());
        /// Further defects of raceways and rolling elements, and other deviations from round.
        pub defects: Vec<DeviationScene> = Vec::new(), before("[]");
        /// Linear elastic material of every body.
        pub material: MaterialScene = MaterialScene::default();
        /// Discretisation.
        pub mesh: MeshScene = MeshScene::default();
        /// Load, speed and gravity.
        pub operation: OperationScene = OperationScene::default();
        /// Contact method and laws.
        pub contact: ContactScene = ContactScene::default();
        /// Oil between rollers and raceways; `None` leaves them dry.
        pub film: Option<FilmScene> = Some(FilmScene::default()), before("None");
        /// Time integration.
        pub solver: SolverScene = SolverScene::default();
        /// Sampling, sensors and frames.
        pub output: OutputScene = OutputScene::default();
        /// Limits of the guards.
        pub guards: GuardsScene = GuardsScene::default();
    }
}

words! {
    /// A model of the bearing.
    pub enum ModelScene: Default {
        /// All bodies in finite elements.
        #[default]
        Full = "full",
        /// Outer ring and housing in their modes below a frequency, rollers and cage rigid with local
        /// compliance: a second in a few seconds.
        Reduced(of: ReducedScene) = "reduced",
    }
}

group! {
    /// The reduced model.
    pub struct ReducedScene {
        /// Natural frequency up to which modes of outer ring and adapter are kept [kHz]. Of rings of another
        /// size than the paper's 30 √(220 mm/outside diameter).
        pub modes_khz: f64 = 30.0, within(2.0, 300.0);
        /// Longest time step [µs]; shortened so that a whole number of steps fits into a sampling interval, and where
        /// contacts, modes or edges of spalls need shorter ones.
        pub step_us: f64 = 4.0, within(0.05, 5.0);
    }
}
