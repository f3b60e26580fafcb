//! The bodies: rings, rolling elements, cage, adapter, their material, and the spall.

use serde::{Deserialize, Serialize};

use crate::housing;

/// Rings and rolling elements (paper, Table 1).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct BearingScene {
    /// Designation; a scene that says `bearing: "NU 205"` has all numbers from the catalogue
    /// ([`catalogue`](crate::catalogue)), and one that gives them may name the bearing here.
    pub designation: String,
    /// Diameter of the outer raceway [mm].
    pub outer_race_diameter_mm: f64,
    /// Radial thickness of the outer ring [mm].
    pub outer_ring_thickness_mm: f64,
    /// Diameter of the inner raceway [mm].
    pub inner_race_diameter_mm: f64,
    /// Radial thickness of the inner ring [mm].
    pub inner_ring_thickness_mm: f64,
    /// Change of the diametral clearance by fits, temperature or adjustment [µm], added to that of the
    /// diameters; negative reduces it, and beyond it preloads the rollers. It is applied to the inner
    /// raceway; absent for 0.
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
    /// Pitch diameter [mm], instead of a raceway: a bearing that is not of the catalogue may give this and
    /// the next three, from which reading a scene completes the fields above; absent afterwards.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pitch_mm: Option<f64>,
    /// Bore [mm], instead of the inner ring's thickness.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bore_mm: Option<f64>,
    /// Outside diameter [mm], instead of the outer ring's thickness.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub outside_mm: Option<f64>,
    /// Width of the rings [mm], instead of `thickness_mm`: rollers are usually 0.6 of it long.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub width_mm: Option<f64>,
    /// Dimensions that the user did not give and the program assumed; written by the program.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub assumed: Vec<Assumed>,
}

/// A dimension of a bearing that the user did not give.
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
    /// The length of the rollers: 0.6 of the width, or, where that is unknown, their diameter.
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
    /// The part between the cage's diameters. Off the pitch circle the corners touch rollers above or below
    /// their centres, and push them radially, too.
    Corners,
    /// The flanks: walls extend across the pitch circle, and push tangentially only. The mass of the cage is
    /// that between its diameters.
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
