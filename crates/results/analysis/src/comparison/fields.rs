//! Fields in which scenes differ.

use serde::Serialize;
use stribeck_scene::fields;
use stribeck_scene::scene::Scene;

/// A field that is not the same in all scenes.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FieldDifference {
    /// Its path, as `--set` takes it.
    pub field: String,
    /// Its value in each, as a scene has it; `None` where there is no scene.
    pub values: Vec<Option<String>>,
}

/// Fields in which `scenes` differ, in the order of their names. The name of a scene makes no difference.
pub fn differences(scenes: &[Option<&Scene>]) -> Vec<FieldDifference> {
    let fields = fields::differences(scenes).into_iter().filter(|(field, _)| field != "name");
    let mut found: Vec<FieldDifference> =
        fields.map(|(field, values)| FieldDifference { field, values }).collect();
    // Fields drawn for each start come last.
    found.sort_by_key(|difference| DRAWN.contains(&difference.field.as_str()));
    found
}

/// Fields that a start draws.
const DRAWN: [&str; 3] = ["bearing.first_roller_deg", "cage.roller_offsets_um", "mesh.roller_phase_deg"];
