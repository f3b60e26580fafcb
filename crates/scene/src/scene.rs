//! The scene: the only input a user writes. Every number carries its unit in its field name.

use serde::{Deserialize, Serialize};

use crate::housing;

pub use crate::deviation::DeviationScene;
pub use crate::housing::HousingScene;
pub use crate::records::RecordsScene;
pub use crate::ring_mesh::RingMeshScene;

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
    /// What holds the outer ring and takes the load; absent for `adapter`.
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
    /// What is recorded.
    pub output: OutputScene,
    /// What is watched.
    pub guards: GuardsScene,
}

/// A model of the bearing.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ModelScene {
    /// All bodies of finite elements.
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
    /// Natural frequency up to which modes of outer ring and adapter are kept [kHz].
    pub modes_khz: f64,
    /// Longest time step [µs]; shortened so that a whole number of steps fits into a sampling interval.
    pub step_us: f64,
}

/// Rings and rolling elements (paper, Table 1).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct BearingScene {
    /// Designation; a scene that says `bearing: "NU 205"` has all numbers from the catalogue
    /// ([`catalogue`](crate::catalogue)), and one that gives them may say here what it is.
    pub designation: String,
    /// Diameter of the outer raceway [mm].
    pub outer_race_diameter_mm: f64,
    /// Radial thickness of the outer ring [mm].
    pub outer_ring_thickness_mm: f64,
    /// Diameter of the inner raceway [mm].
    pub inner_race_diameter_mm: f64,
    /// Radial thickness of the inner ring [mm].
    pub inner_ring_thickness_mm: f64,
    /// What fits, temperature or an adjustment add to the diametral clearance that the diameters leave [µm];
    /// below zero they take from it, and beyond it they press the rollers between the raceways. The inner
    /// raceway has it; absent for 0.
    #[serde(skip_serializing_if = "housing::is_zero")]
    pub clearance_change_um: f64,
    /// Number of rolling elements.
    pub rollers: usize,
    /// Diameter of a rolling element [mm].
    pub roller_diameter_mm: f64,
    /// Out-of-plane thickness of the plane-strain model [mm]; the paper does not state it.
    pub thickness_mm: f64,
    /// Angle of the centre of roller 1 [°], counter-clockwise from the x axis; the others follow
    /// counter-clockwise.
    pub first_roller_deg: f64,
    /// Pitch diameter [mm], in the place of a raceway: a bearing of one's own may give this and the next
    /// three, from which reading a scene completes the fields above; absent then.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pitch_mm: Option<f64>,
    /// Bore [mm], in the place of the inner ring's thickness.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bore_mm: Option<f64>,
    /// Outside diameter [mm], in the place of the outer ring's thickness.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub outside_mm: Option<f64>,
    /// Width of the rings [mm], in the place of `thickness_mm`: rollers are usually 0.6 of it long.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub width_mm: Option<f64>,
    /// What nobody gave of a bearing of one's own and was assumed; the program writes it.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub assumed: Vec<Assumed>,
}

/// A number of a bearing of one's own that nobody gave.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Assumed {
    /// The clearance: the middle of the normal group (ISO 5753-1).
    Clearance,
    /// The pitch diameter: half-way between bore and outside diameter.
    Pitch,
    /// The thickness of the outer ring: 0.4 of a roller.
    OuterRing,
    /// The thickness of the inner ring: 0.4 of a roller.
    InnerRing,
    /// The number of rollers: with a fifth of the pitch circle free between them.
    Rollers,
    /// The length of the rollers: 0.6 of the width, or where that is not known their diameter.
    Length,
}

/// Rigid cage: a ring cut into as many pieces as there are pockets.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct CageScene {
    /// Outer diameter [mm].
    pub outer_diameter_mm: f64,
    /// Radial thickness [mm].
    pub thickness_mm: f64,
    /// Gap between a centred roller and its pocket wall [µm].
    pub pocket_clearance_um: f64,
    /// Which part of a roller the walls of its pocket touch.
    pub pocket: PocketWalls,
    /// How far each roller starts from the middle of its pocket along its path, counter-clockwise, roller 1
    /// first [µm]; empty: all in the middle.
    pub roller_offsets_um: Vec<f64>,
}

/// Which part of a roller the walls of its pocket touch.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PocketWalls {
    /// That which lies between the cage's diameters. Off the pitch circle corners touch rollers above or
    /// below their centres, and push them across their track too.
    Corners,
    /// Their flanks: walls reach across the pitch circle, and push along the track alone. The mass of the
    /// cage is that of its diameters.
    Straight,
}

/// Block with a concave seat on top of the outer ring.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct AdapterScene {
    /// Width [mm].
    pub width_mm: f64,
    /// Height above the crown of the seat [mm].
    pub height_mm: f64,
}

/// Spall on a raceway.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct DefectScene {
    /// Ring on whose raceway it lies; on the inner one it turns with the shaft.
    pub ring: DefectRing,
    /// Circumferential length [mm], measured on the raceway.
    pub length_mm: f64,
    /// Depth [mm].
    pub depth_mm: f64,
    /// Angle of its centre at the start [°]; 90 is the top, in the middle of the load zone.
    pub angle_deg: f64,
    /// Angle between its edges and the raceway [°]; 90 for radial walls, 22 or more under oil.
    pub edge_slope_deg: f64,
}

/// One of the two rings.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DefectRing {
    /// The outer ring.
    #[default]
    Outer,
    /// The inner ring, which turns with the shaft.
    Inner,
}

impl DefectRing {
    /// In words: `outer` or `inner`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Outer => "outer",
            Self::Inner => "inner",
        }
    }
}

/// Linear elastic, isotropic, plane strain.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MaterialScene {
    /// Young's modulus [GPa].
    pub youngs_modulus_gpa: f64,
    /// Poisson's ratio [-].
    pub poissons_ratio: f64,
    /// Density [kg/m³].
    pub density_kg_m3: f64,
}

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
    /// Angle by which every roller's mesh is turned about its own centre, on top of that [°].
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

/// Operating point.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct OperationScene {
    /// Load on the top edge of the adapter, downwards, or on another housing [N].
    pub load_n: f64,
    /// Direction in which the load pushes the housing [°], counter-clockwise from the x axis; absent for 270,
    /// downwards, with the load zone at the top. A pedestal and a housing from a mesh take 90, too, a rigid
    /// one and springs any.
    #[serde(skip_serializing_if = "housing::is_down")]
    pub load_angle_deg: f64,
    /// Speed of the inner ring [rpm]; positive clockwise, negative counter-clockwise.
    pub speed_rpm: f64,
    /// Speed of the outer ring with its housing, which must be rigid then [rpm], counted likewise; absent for
    /// 0.
    #[serde(skip_serializing_if = "housing::is_zero")]
    pub outer_speed_rpm: f64,
    /// Gravity, downwards [m/s²].
    pub gravity_m_s2: f64,
    /// How the speed goes over time, in rpm; absent for `speed_rpm` all the time.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed_profile: Option<ProfileScene>,
    /// How the speed of the outer ring goes over time, in rpm; absent for `outer_speed_rpm` all the time.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub outer_speed_profile: Option<ProfileScene>,
    /// How the load goes over time, in N; absent for `load_n` all the time.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub load_profile: Option<ProfileScene>,
    /// A force that turns with the inner ring, on top of the load; absent for none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rotating_load: Option<RotatingLoadScene>,
}

/// How speed or load goes over time ([`duty`](crate::duty)). Values have the unit of the field that they
/// vary.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ProfileScene {
    /// From the field's value along a straight line to another one, which stays.
    Ramp(RampScene),
    /// The field's value with a sine about it.
    Harmonic(HarmonicScene),
    /// Times [ms], ascending, and values: straight lines between them, the first and the last value before
    /// and behind them. The field itself has no part in it.
    Points(Vec<(f64, f64)>),
    /// The same from a CSV file, whose first line names its columns, `time_ms` and `value`. Its path counts
    /// from the folder of the scene. When a scene is read its points take the place of the file, so a run
    /// holds all of its scene.
    Table(String),
}

/// A change at a constant rate.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RampScene {
    /// When it begins [ms].
    pub from_ms: f64,
    /// When it is over [ms].
    pub to_ms: f64,
    /// Value at its end and from then on.
    pub to: f64,
}

/// A sine about a mean.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct HarmonicScene {
    /// Amplitude.
    pub amplitude: f64,
    /// Frequency [Hz].
    pub hz: f64,
    /// Phase at the start [°]; 0 begins at the mean, upwards.
    pub phase_deg: f64,
}

/// A force on the housing that turns with the inner ring, as that of an unbalanced shaft. Where the housing
/// is guided up and down it takes the vertical part; the horizontal one goes into the guide.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RotatingLoadScene {
    /// Its magnitude [N].
    pub force_n: f64,
    /// Its direction at the start [°], counter-clockwise from the x axis.
    pub angle_deg: f64,
}

/// Contact method and laws.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ContactScene {
    /// Where the penalty acts.
    pub method: ContactMethod,
    /// What the facets of raceways and rollers stand for.
    pub surface: ContactSurface,
    /// How the surfaces of raceways and rollers move with their nodes.
    pub interpolation: ContactInterpolation,
    /// Integration points on a facet (`integrated` only).
    pub points_per_facet: usize,
    /// Whose points are evaluated where rollers touch.
    pub passes: ContactPasses,
    /// By which formula stiffness and critical damping are reckoned.
    pub formula: ContactFormula,
    /// Penalty stiffness as a multiple of what the formula names [-].
    pub penalty_scale: f64,
    /// Gap at which contact of rollers sets in [µm]: up to as deep a penetration the pressure rises as a
    /// parabola, beyond it in proportion. Zero for a sharp corner.
    pub onset_um: f64,
    /// Normal contact damping as a fraction of critical [-].
    pub damping_ratio: f64,
    /// Coulomb coefficient of rollers on raceways and cage [-].
    pub friction: f64,
    /// Coulomb coefficient of the adapter on the outer ring [-].
    pub seat_friction: f64,
}

/// By which formula the stiffness and the critical damping of contact are reckoned, for squares of the mesh's
/// size.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ContactFormula {
    /// `penalty_scale` × E / element size; critical damping of two equal surface layers on that spring.
    ElementLayer,
    /// LS-DYNA's standard penalty: `penalty_scale` (`SLSFAC` × `SFS`, usually 0.1) × bulk modulus × area² /
    /// volume of the element behind a segment, on each pass. `damping_ratio` is `VDC` / 100, whose critical
    /// damping is 2 m ω.
    LsdynaStandard,
    /// LS-DYNA's segment-based penalty (`SOFT` = 2): `penalty_scale` (likewise) × ½ m₁m₂/(m₁ + m₂) / Δt², of
    /// segments with half an element each. `damping_ratio` as in the standard penalty.
    LsdynaSegment,
}

/// What the facets of raceways and rollers stand for. Corners (walls of the defect, cage) stay sharp in any
/// case.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ContactSurface {
    /// Themselves: contact is with the chords.
    Facet,
    /// Arcs about the centre of the ring or roller.
    Arc,
    /// Nagata patches, from the directions of neighbouring facets alone.
    Nagata,
}

/// How a contact surface moves with its nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ContactInterpolation {
    /// Every facet with its own two nodes.
    Linear,
    /// As a cubic spline of smoothed nodes, six to a facet: a load that rolls over it does not see where
    /// nodes are.
    Spline,
}

/// Whose points are evaluated where rollers touch; the seat takes both sides in any case.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ContactPasses {
    /// Those of both bodies, each with half of the stiffness.
    Two,
    /// Those of the roller alone, with the whole stiffness: half the work, for points that stand closer than
    /// the features of a raceway.
    One,
}

/// Where the contact penalty acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ContactMethod {
    /// At the nodes of both surfaces against the facets of the other (two-pass node-to-segment).
    Collocated,
    /// Integrated over the facets of both surfaces.
    Integrated,
}

/// Oil between rollers and raceways, as much as they take up.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct FilmScene {
    /// Dynamic viscosity of the oil at the temperature of the bearing and ambient pressure [Pa s].
    pub viscosity_pa_s: f64,
    /// Pressure–viscosity coefficient α [1/GPa].
    pub pressure_viscosity_per_gpa: f64,
    /// Composite roughness of roller and raceway, √(Rq₁² + Rq₂²) [µm].
    pub roughness_um: f64,
}

/// Time integration.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SolverScene {
    /// Simulated time [ms].
    pub duration_ms: f64,
    /// Fraction of the critical time step that is used [-]; above 1 a run diverges, and stops by itself.
    pub time_step_factor: f64,
    /// Hourglass stiffness as a multiple of the exact bending stiffness of a square [-].
    pub hourglass_scale: f64,
    /// Mass-proportional damping [1/s]; 2·ζ·ω for a damping ratio ζ at ω.
    pub mass_damping_per_s: f64,
    /// What the mass damping is relative to.
    pub damping_frame: DampingFrame,
    /// Stiffness-proportional damping β [ns]; 2·ζ/ω for a damping ratio ζ at ω. Each nanosecond costs time
    /// step.
    pub stiffness_damping_ns: f64,
    /// Damping of chosen bodies at nearly one ratio over a band of frequencies.
    pub structural_damping: Option<StructuralDampingScene>,
    /// How the run starts.
    pub start: Start,
}

/// Structural damping: the loss of a body's material and joints, which hardly depends on frequency. Each
/// branch costs memory traffic, all of them about 5 % of the time step for 2 %.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct StructuralDampingScene {
    /// Damping ratio in the band, a share of critical [%].
    pub ratio_percent: f64,
    /// Lower end of the band [kHz]; below it the ratio falls in proportion to the frequency.
    pub from_khz: f64,
    /// Upper end of the band [kHz]; above it the ratio falls as one over the frequency.
    pub to_khz: f64,
    /// Maxwell branches beside every element, 1 to 3: over a factor of 20 in frequency the ratio is within
    /// −49 and +25 % with one, −8 and +4 % with two, 1 % with three.
    pub branches: usize,
    /// Which bodies.
    pub bodies: Vec<DampedBody>,
}

/// A body, or bodies of a kind, with structural damping.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DampedBody {
    /// The outer ring.
    OuterRing,
    /// The inner ring.
    InnerRing,
    /// The adapter.
    Adapter,
    /// All rollers.
    Rollers,
}

/// Motion that mass-proportional damping leaves alone.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DampingFrame {
    /// A roller's motion along the raceways and its spin: what drives and brakes rolling stays friction
    /// alone, while rattling across the clearance is damped, as oil would. Outer ring and adapter: rest.
    Rolling,
    /// The rigid motion of each body: only its vibration is damped.
    RigidMotion,
    /// Rest (what LS-DYNA's global damping does): brakes rolling.
    Absolute,
}

/// How the run starts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Start {
    /// Static equilibrium under load, then the kinematic rolling velocities.
    Preloaded,
    /// Undeformed, kinematic velocities, the load applied at once.
    Sudden,
}

/// What is recorded.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct OutputScene {
    /// Sampling interval [µs]; 10 µs is 100 kHz.
    pub interval_us: f64,
    /// Sensors on the outer surface of the outer ring; the first is the one that the report leads with.
    pub sensors: Vec<SensorScene>,
    /// Pictures of the stress about the defect; `None` writes none.
    pub frames: Option<FramesScene>,
    /// What records of a machine tell of the passages over the defect; `None` for a run that is not to be
    /// held against one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub records: Option<RecordsScene>,
}

/// Displacements of all nodes near the middle of the defect (the top of a sound bearing) at several times.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct FramesScene {
    /// Time of the first frame [ms].
    pub from_ms: f64,
    /// No frame is later [ms].
    pub to_ms: f64,
    /// Time between two frames [µs], rounded to whole samples.
    pub every_us: f64,
    /// Half the side of the square that is kept, about the path of the rollers' centres [mm].
    pub half_width_mm: f64,
}

/// One sensor: a node on the outer surface of the outer ring.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SensorScene {
    /// Name in the trace, letters, digits and `_`.
    pub name: String,
    /// Angle [°], counter-clockwise from the x axis.
    pub angle_deg: f64,
}

/// What is watched at every sample, and when a run is warned of or stopped (`guards.rs`).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct GuardsScene {
    /// Imbalance of energy over the peak strain energy above which the run carries a warning [%]; of a
    /// reduced run, over the larger of the most that rings and contacts have stored and of its heat.
    pub energy_warning_percent: f64,
    /// … and above which it stops [%]; a reduced run does so only when it is off by a hundredth of its heat,
    /// too.
    pub energy_stop_percent: f64,
    /// Hourglass energy over strain energy above which the run carries a warning [%].
    pub hourglass_warning_percent: f64,
    /// Penetration over the element size above which the run carries a warning [%].
    pub penetration_warning_percent: f64,
    /// … and above which it stops [%]; at 200 % contact takes a point for one on the far side of a body and
    /// lets go.
    pub penetration_stop_percent: f64,
    /// Area of an element over its area at rest below which the run stops [%].
    pub area_stop_percent: f64,
    /// Time for which no roller may carry anything before the run carries a warning [ms].
    pub unsupported_warning_ms: f64,
}

/// Side of the squares inside a graded roller, in facets of its rim. With longer ones the triangles between
/// rim and core become needles, and nothing is left to save: most elements of a roller lie along its rim.
const CORE_FACETS: f64 = 3.0;

impl GradingScene {
    /// Side of the squares inside a roller whose facets are `facet_mm` long [mm].
    pub fn roller_core_mm(&self, facet_mm: f64) -> f64 {
        self.coarse_mm.min(CORE_FACETS * facet_mm)
    }
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

impl Default for BearingScene {
    fn default() -> Self {
        Self {
            designation: String::new(),
            outer_race_diameter_mm: 200.0,
            outer_ring_thickness_mm: 10.0,
            inner_race_diameter_mm: 163.96,
            inner_ring_thickness_mm: 10.0,
            clearance_change_um: 0.0,
            rollers: 24,
            roller_diameter_mm: 18.0,
            thickness_mm: 30.0,
            first_roller_deg: 94.0,
            pitch_mm: None,
            bore_mm: None,
            outside_mm: None,
            width_mm: None,
            assumed: Vec::new(),
        }
    }
}

impl Default for CageScene {
    fn default() -> Self {
        Self {
            outer_diameter_mm: 196.0,
            thickness_mm: 4.0,
            pocket_clearance_um: 100.0,
            pocket: PocketWalls::Straight,
            roller_offsets_um: Vec::new(),
        }
    }
}

impl Default for AdapterScene {
    fn default() -> Self {
        Self { width_mm: 160.0, height_mm: 40.0 }
    }
}

impl Default for DefectScene {
    fn default() -> Self {
        Self {
            ring: DefectRing::Outer,
            length_mm: 10.0,
            depth_mm: 0.2,
            angle_deg: 90.0,
            edge_slope_deg: 90.0,
        }
    }
}

impl Default for MaterialScene {
    fn default() -> Self {
        Self { youngs_modulus_gpa: 200.0, poissons_ratio: 0.3, density_kg_m3: 7850.0 }
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

impl Default for OperationScene {
    fn default() -> Self {
        Self {
            load_n: 50_000.0,
            load_angle_deg: housing::DOWN_DEG,
            speed_rpm: 500.0,
            outer_speed_rpm: 0.0,
            gravity_m_s2: 9.81,
            speed_profile: None,
            outer_speed_profile: None,
            load_profile: None,
            rotating_load: None,
        }
    }
}

impl Default for RampScene {
    fn default() -> Self {
        Self { from_ms: 0.0, to_ms: 100.0, to: 1000.0 }
    }
}

impl Default for HarmonicScene {
    fn default() -> Self {
        Self { amplitude: 50.0, hz: 10.0, phase_deg: 0.0 }
    }
}

impl Default for RotatingLoadScene {
    fn default() -> Self {
        Self { force_n: 1000.0, angle_deg: 0.0 }
    }
}

impl Default for ContactScene {
    fn default() -> Self {
        Self {
            method: ContactMethod::Integrated,
            surface: ContactSurface::Facet,
            interpolation: ContactInterpolation::Linear,
            points_per_facet: 16,
            passes: ContactPasses::Two,
            formula: ContactFormula::ElementLayer,
            penalty_scale: 0.05,
            onset_um: 0.0,
            damping_ratio: 0.1,
            friction: 0.005,
            seat_friction: 0.1,
        }
    }
}

impl Default for FilmScene {
    fn default() -> Self {
        Self { viscosity_pa_s: 0.05, pressure_viscosity_per_gpa: 22.0, roughness_um: 0.3 }
    }
}

impl Default for SolverScene {
    fn default() -> Self {
        Self {
            duration_ms: 30.0,
            time_step_factor: 0.98,
            hourglass_scale: 1.0,
            mass_damping_per_s: 0.0,
            damping_frame: DampingFrame::Rolling,
            stiffness_damping_ns: 0.0,
            structural_damping: Some(StructuralDampingScene::default()),
            start: Start::Preloaded,
        }
    }
}

impl Default for StructuralDampingScene {
    fn default() -> Self {
        Self {
            ratio_percent: 2.0,
            from_khz: 2.0,
            to_khz: 40.0,
            branches: 1,
            bodies: vec![DampedBody::OuterRing, DampedBody::InnerRing, DampedBody::Adapter],
        }
    }
}

impl Default for OutputScene {
    fn default() -> Self {
        let sensor = |name: &str, angle_deg| SensorScene { name: name.into(), angle_deg };
        Self {
            interval_us: 10.0,
            sensors: vec![
                sensor("side", 0.0),
                sensor("shoulder", 22.0),
                sensor("seat", 90.0),
                sensor("bottom", 270.0),
            ],
            frames: Some(FramesScene::default()),
            records: None,
        }
    }
}

impl Default for GuardsScene {
    fn default() -> Self {
        Self {
            energy_warning_percent: 0.5,
            energy_stop_percent: 25.0,
            hourglass_warning_percent: 10.0,
            penetration_warning_percent: 10.0,
            penetration_stop_percent: 100.0,
            area_stop_percent: 20.0,
            unsupported_warning_ms: 0.5,
        }
    }
}

impl Default for FramesScene {
    fn default() -> Self {
        Self { from_ms: 0.2, to_ms: 5.6, every_us: 100.0, half_width_mm: 14.0 }
    }
}
