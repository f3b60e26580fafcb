//! Housings, which hold the outer ring and take the load: the paper's adapter, and others.
//!
//! The inner ring turns about a fixed centre, and the load pushes the housing towards it, as on a wheel or
//! under the paper's adapter. A load on the shaft in a stationary housing is the same seen from the shaft.

use serde::{Deserialize, Serialize};

/// The housing, which holds the outer ring and takes the load.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum HousingScene {
    /// The block of `adapter` on top of the ring, loaded on its top edge.
    #[default]
    Adapter,
    /// A block with a bore for the ring, loaded on its base.
    Pedestal(PedestalScene),
    /// An elastic housing of any shape, whose mesh is read from a file.
    Mesh(MeshHousingScene),
    /// A housing that does not deform, nor does the ring in it; the only one that may turn.
    Rigid(RigidHousingScene),
    /// Springs and dampers all around the ring, to a frame that does not deform and takes the load.
    Springs(SpringHousingScene),
}

/// A block with a bore for the ring. Its base is guided: it moves up and down, not sideways.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct PedestalScene {
    /// Width [mm].
    pub width_mm: f64,
    /// From the centre of the bearing down to the base [mm].
    pub base_mm: f64,
    /// From the centre of the bearing up to the top [mm].
    pub top_mm: f64,
}

/// An elastic housing from a Gmsh, Abaqus or LS-DYNA file of plane quadrilaterals and triangles, with the
/// centre of the bearing in the origin. Its material is that of the bearing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MeshHousingScene {
    /// The file, `.msh`, `.inp` or `.k`; its path counts from the folder of the scene.
    pub file: String,
    /// Length unit of the file [mm]: 1 for files in millimetres, 1000 for metres.
    pub unit_mm: f64,
    /// Content of the file, inserted when a scene is read, so that a run holds its complete scene.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub text: String,
    /// Name of the set of nodes along the bore.
    pub bore: String,
    /// Name of the set of nodes along the edge that takes the load, and is guided up and down.
    pub loaded: String,
}

/// A housing that does not deform, nor does the ring in it. It may move in any direction.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RigidHousingScene {
    /// Mass that moves with the outer ring, on top of the ring's own [kg].
    pub mass_kg: f64,
}

/// Springs and dampers all around the ring, evenly spread, to a frame that does not deform or turn and takes
/// the load. Each spring holds its node of the ring in every direction.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SpringHousingScene {
    /// Stiffness of all springs together against a shift of the ring [N/µm].
    pub stiffness_n_um: f64,
    /// Damping of all dampers together against a shift of the ring [N s/m].
    pub damping_n_s_m: f64,
    /// Mass of the frame [kg].
    pub mass_kg: f64,
}

impl HousingScene {
    /// One of each form that has fields.
    pub(crate) fn of_every_form() -> [Self; 4] {
        [
            Self::Pedestal(PedestalScene::default()),
            Self::Mesh(MeshHousingScene::default()),
            Self::Rigid(RigidHousingScene::default()),
            Self::Springs(SpringHousingScene::default()),
        ]
    }

    /// Whether it is the paper's.
    pub fn is_adapter(&self) -> bool {
        *self == Self::Adapter
    }

    /// Whether the outer ring does not deform.
    pub fn is_rigid(&self) -> bool {
        matches!(self, Self::Rigid(_))
    }

    /// Whether the outer ring sits in it, and may slip.
    pub fn has_seat(&self) -> bool {
        matches!(self, Self::Adapter | Self::Pedestal(_) | Self::Mesh(_))
    }

    /// Whether the load may come from any direction. Edges of elastic housings are guided up and down.
    pub fn takes_any_direction(&self) -> bool {
        matches!(self, Self::Rigid(_) | Self::Springs(_))
    }
}

impl Default for PedestalScene {
    fn default() -> Self {
        Self { width_mm: 320.0, base_mm: 160.0, top_mm: 140.0 }
    }
}

impl Default for MeshHousingScene {
    fn default() -> Self {
        Self {
            file: String::new(),
            unit_mm: 1.0,
            text: String::new(),
            bore: "bore".into(),
            loaded: "loaded".into(),
        }
    }
}

impl Default for SpringHousingScene {
    fn default() -> Self {
        Self { stiffness_n_um: 1000.0, damping_n_s_m: 1000.0, mass_kg: 10.0 }
    }
}

/// Direction of the load that the adapter takes [°]: downwards.
pub const DOWN_DEG: f64 = 270.0;

/// Whether an angle is [`DOWN_DEG`], the default, which is not written.
pub(crate) fn is_down(angle_deg: &f64) -> bool {
    *angle_deg == DOWN_DEG
}

/// Whether a number is zero, the default, which is not written.
pub(crate) fn is_zero(value: &f64) -> bool {
    *value == 0.0
}
