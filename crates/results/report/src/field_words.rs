//! A field of a scene in words, with its unit: `operation.load_n` is a load in newtons.

use stribeck_analysis::quantity::stem_and_unit;

use crate::page::capital;

/// Title of a field on an axis or in a heading.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct FieldWords {
    /// The quantity, with a capital.
    pub(crate) words: String,
    /// Its unit; empty without one.
    pub(crate) unit: &'static str,
}

/// Words of the fields whose names alone say too little, by their path.
const KNOWN: [(&str, &str); 20] = [
    ("bearing", "Bearing"),
    ("operation.load_angle_deg", "Direction of the load"),
    ("operation.outer_speed_rpm", "Speed of the outer ring"),
    ("operation.gravity_m_s2", "Gravity"),
    ("bearing.rollers", "Rolling elements"),
    ("bearing.roller_diameter_mm", "Diameter of the rolling elements"),
    ("bearing.thickness_mm", "Length of the rolling elements, with balls width of the rings"),
    ("bearing.outer_race_diameter_mm", "Diameter of the outer raceway"),
    ("bearing.inner_race_diameter_mm", "Diameter of the inner raceway"),
    ("bearing.clearance_change_um", "Change of the clearance"),
    ("bearing.pitch_mm", "Pitch diameter"),
    ("bearing.outside_mm", "Outside diameter"),
    ("contact.friction", "Coefficient of friction"),
    ("contact.seat_friction", "Coefficient of friction in the seat"),
    ("contact.penalty_scale", "Penalty stiffness over that of the formula"),
    ("mesh.size_mm", "Element size"),
    ("output.interval_us", "Sampling interval"),
    ("solver.duration_ms", "Duration"),
    ("solver.time_step_factor", "Time step over the critical one"),
    ("model.step_us", "Time step"),
];

/// Groups whose name belongs to the words of their fields.
const GROUPS: [(&str, &str); 7] = [
    ("defect", "the defect"),
    ("cage", "the cage"),
    ("adapter", "the adapter"),
    ("housing", "the housing"),
    ("film", "the oil film"),
    ("material", "the material"),
    ("operation.rotating_load", "the rotating load"),
];

impl FieldWords {
    /// Of a field by its dotted path.
    pub(crate) fn of(field: &str) -> Self {
        let (group, name) = field.rsplit_once('.').unwrap_or(("", field));
        let (stem, unit) = stem_and_unit(name);
        if let Some((_, words)) = KNOWN.iter().find(|(path, _)| *path == field) {
            return Self { words: (*words).to_owned(), unit };
        }
        let mut words = capital(&stem.replace('_', " "));
        // An item of a list belongs to the group of the list.
        let group = group.split('[').next().unwrap_or(group);
        let group = if group == "defects" { "defect" } else { group };
        if let Some((_, of)) = GROUPS.iter().find(|(name, _)| *name == group) {
            words += &format!(" of {of}");
        }
        Self { words, unit }
    }

    /// Inside a sentence, where only abbreviations and names keep their capital.
    pub(crate) fn inside(&self) -> String {
        let mut letters = self.words.chars();
        let first: String = letters.next().into_iter().flat_map(char::to_lowercase).collect();
        first + letters.as_str()
    }

    /// With the unit, for the head of a column.
    pub(crate) fn with_unit(&self) -> String {
        if self.unit.is_empty() { self.words.clone() } else { format!("{}, {}", self.words, self.unit) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn behaves_fields_have_words_and_units() {
        for (field, title) in [
            ("operation.load_n", "Load, N"),
            ("operation.speed_rpm", "Speed, rpm"),
            ("defect.length_mm", "Length of the defect, mm"),
            ("defects[0].form.depth_mm", "Depth of the defect, mm"),
            ("bearing.rollers", "Rolling elements"),
            ("bearing.clearance_change_um", "Change of the clearance, µm"),
            ("contact.friction", "Coefficient of friction"),
            ("contact.damping_ratio", "Damping ratio"),
            ("film.viscosity_pa_s", "Viscosity of the oil film, Pa s"),
            ("housing.stiffness_n_um", "Stiffness of the housing, N/µm"),
            ("mesh.roller_facets", "Roller facets"),
            ("bearing", "Bearing"),
        ] {
            assert_eq!(FieldWords::of(field).with_unit(), title, "{field}");
        }
        assert_eq!(FieldWords::of("operation.load_n").inside(), "load");
    }
}
