//! Rings whose mesh comes from a file.

use serde::{Deserialize, Serialize};

/// A ring from a Gmsh, Abaqus or LS-DYNA file of plane quadrilaterals and triangles, with the centre of the
/// bearing in the origin. Its material is that of the bearing, its raceway the circle of `bearing`, with the
/// cut-outs of the file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RingMeshScene {
    /// The file, `.msh`, `.inp` or `.k`; its path counts from the folder of the scene.
    pub file: String,
    /// Length unit of the file [mm]: 1 for files in millimetres, 1000 for metres.
    pub unit_mm: f64,
    /// Content of the file, inserted when a scene is read, so that a run holds its complete scene.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub text: String,
    /// Name of the set of nodes all along the raceway.
    pub raceway: String,
    /// Name of the set of nodes all along the other side: the outer ring's back, which sits in the housing,
    /// or the inner ring's bore, which turns with the shaft.
    pub fit: String,
}

impl Default for RingMeshScene {
    fn default() -> Self {
        Self {
            file: String::new(),
            unit_mm: 1.0,
            text: String::new(),
            raceway: "raceway".into(),
            fit: "fit".into(),
        }
    }
}
