//! Default and range of every field of a scene, for the reference.

use super::limits;
use super::schema::Schema;

/// Defaults and ranges of all fields.
pub struct FieldReference {
    schema: &'static Schema,
}

/// Default and range of a field.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Field {
    /// Its default, as it would be written.
    pub default: Option<String>,
    /// Range of a number, `3 to 400`, with its unit.
    pub range: Option<String>,
}

impl std::fmt::Debug for FieldReference {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("FieldReference").finish_non_exhaustive()
    }
}

impl Default for FieldReference {
    fn default() -> Self {
        Self::new()
    }
}

impl FieldReference {
    /// From the default scene.
    pub fn new() -> Self {
        Self { schema: Schema::get() }
    }

    /// The field at a dotted path, `mesh.size_mm`; of lists the first item stands for all.
    pub fn of(&self, path: &str) -> Field {
        // Fields written only where they are used are absent from the default scene.
        let default = match LATER.iter().find(|(later, _)| *later == path) {
            Some((_, default)) => Some((*default).to_owned()),
            None => self.schema.default_of(path).map(str::to_owned),
        };
        Field { default, range: limits::allowed(path) }
    }

    /// The field `name` of the group behind `word` at `path`: `inside("housing", "springs", "mass_kg")`.
    pub fn inside(&self, path: &str, word: &str, name: &str) -> Field {
        let Some((scene, path, default)) = self.schema.behind(path, word, name) else {
            return Field::default();
        };
        let later = LATER.iter().find(|(later, _)| *later == format!("{word}.{name}"));
        let default = later.map_or(default, |(_, default)| default);
        Field { default: Some(default.to_owned()), range: limits::allowed_in(scene, &path) }
    }
}

/// Fields that are absent where they have these values.
const LATER: [(&str, &str); 8] = [
    ("operation.load_angle_deg", "270.0"),
    ("operation.outer_speed_rpm", "0.0"),
    ("bearing.clearance_change_um", "0.0"),
    ("bearing.pitch_mm", "None"),
    ("bearing.bore_mm", "None"),
    ("bearing.outside_mm", "None"),
    ("bearing.width_mm", "None"),
    ("roughness.slope", "2.0"),
];
