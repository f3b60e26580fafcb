//! The scene: the only input a user writes. Every number carries its unit in its field name.

mod bearing;
mod contact;
mod mesh;
mod operation;
mod output;
mod solver;

use serde::{Deserialize, Serialize};

pub use crate::deviation::DeviationScene;
pub use crate::housing::HousingScene;
pub use crate::records::RecordsScene;
pub use crate::ring_mesh::RingMeshScene;
pub use bearing::{
    AdapterScene, Assumed, BearingScene, CageScene, DefectRing, DefectScene, MaterialScene, PocketWalls,
};
pub use contact::{
    ContactFormula, ContactInterpolation, ContactMethod, ContactPasses, ContactScene, ContactSurface,
    FilmScene,
};
pub use mesh::{GradingScene, MeshScene, RollerCopies};
pub use operation::{HarmonicScene, OperationScene, ProfileScene, RampScene, RotatingLoadScene};
pub use output::{FramesScene, GuardsScene, OutputScene, SensorScene};
pub use solver::{DampedBody, DampingFrame, SolverScene, Start, StructuralDampingScene};

/// A complete scene. Every field has a default; `()` in a file is the paper's bearing in oil, as
/// `fixtures/scenes/oiled_steel.ron` spells it out.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Scene {
    /// Short name, also that of the run directory.
    pub name: String,
    /// Which model of the bearing runs.
    pub model: ModelScene,
    /// Rings and rolling elements.
    pub bearing: BearingScene,
    /// The rigid cage; `None` leaves the rollers unguided.
    pub cage: Option<CageScene>,
    /// The block that carries the load to the outer ring.
    pub adapter: AdapterScene,
    /// Housing, which holds the outer ring and takes the load; absent for `adapter`.
    #[serde(skip_serializing_if = "HousingScene::is_adapter")]
    pub housing: HousingScene,
    /// The mesh of the outer ring from a file; absent for one that the program makes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub outer_ring_mesh: Option<RingMeshScene>,
    /// The mesh of the inner ring from a file; absent for one that the program makes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub inner_ring_mesh: Option<RingMeshScene>,
    /// Spall on a raceway; `None` is a sound bearing.
    pub defect: Option<DefectScene>,
    /// Further defects of raceways and rolling elements, and other deviations from round.
    pub defects: Vec<DeviationScene>,
    /// Linear elastic material of every body.
    pub material: MaterialScene,
    /// Discretisation.
    pub mesh: MeshScene,
    /// Load, speed and gravity.
    pub operation: OperationScene,
    /// Contact method and laws.
    pub contact: ContactScene,
    /// Oil between rollers and raceways; `None` leaves them dry.
    pub film: Option<FilmScene>,
    /// Time integration.
    pub solver: SolverScene,
    /// Sampling, sensors and frames.
    pub output: OutputScene,
    /// Limits of the guards.
    pub guards: GuardsScene,
}

/// A model of the bearing.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ModelScene {
    /// All bodies in finite elements.
    #[default]
    Full,
    /// Outer ring and housing in their modes below a frequency, rollers and cage rigid with local compliance:
    /// a second in a few seconds.
    Reduced(ReducedScene),
}

/// The reduced model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ReducedScene {
    /// Natural frequency up to which modes of outer ring and adapter are kept [kHz]. Of rings of another size
    /// than the paper's 30 (220 mm/outside diameter)^¾.
    pub modes_khz: f64,
    /// Longest time step [µs]; shortened so that a whole number of steps fits into a sampling interval.
    pub step_us: f64,
}

impl Default for Scene {
    fn default() -> Self {
        Self {
            name: "oiled_steel".into(),
            model: ModelScene::Full,
            bearing: BearingScene::default(),
            cage: Some(CageScene::default()),
            adapter: AdapterScene::default(),
            housing: HousingScene::Adapter,
            outer_ring_mesh: None,
            inner_ring_mesh: None,
            defect: Some(DefectScene::default()),
            defects: Vec::new(),
            material: MaterialScene::default(),
            mesh: MeshScene::default(),
            operation: OperationScene::default(),
            contact: ContactScene::default(),
            film: Some(FilmScene::default()),
            solver: SolverScene::default(),
            output: OutputScene::default(),
            guards: GuardsScene::default(),
        }
    }
}

impl Default for ReducedScene {
    fn default() -> Self {
        Self { modes_khz: 30.0, step_us: 2.0 }
    }
}
