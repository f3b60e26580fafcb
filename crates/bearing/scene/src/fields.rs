//! The table of all fields of a scene, which [`field`](crate::field) declares.
//!
//! Reading, ranges, suggestions for misspelt names, `--set`, the axes of campaigns, the identity of
//! a scene, the page of all fields and the schema for editors follow from it.

mod difference;
pub(crate) mod page;
pub(crate) mod schema;

use std::sync::LazyLock;

pub use crate::field::{Field, Group, Shape, Word, Words, tree, value};
pub use crate::{group, words};
pub use difference::differences;
pub use page::page;
pub use schema::{json_schema, to_json};

use crate::field::range::Range;
use crate::field::wording::list;
use crate::scene::Scene;
use tree::{Node, Step, join, steps};
use value::Value;

/// An entry of the table, found by its path.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Spot {
    /// What is written there.
    pub shape: Shape,
    /// Its limits and unit.
    pub range: Option<(Range, &'static str)>,
    /// The last field of the path, and its group.
    field: Option<(&'static Group, &'static Field)>,
    /// Whether it is an item of that field.
    is_item: bool,
}

impl Spot {
    /// The whole scene.
    pub(crate) const ROOT: Self = Self::of(Scene::SHAPE);

    /// The whole of a file.
    pub(crate) const fn of(shape: Shape) -> Self {
        Self { shape, range: None, field: None, is_item: false }
    }

    /// The field of a group in here.
    pub(crate) fn at(self, group: &'static Group, field: &'static Field) -> Self {
        Self {
            shape: field.shape,
            range: field.limits.resolved(field.unit(), self.range),
            field: Some((group, field)),
            is_item: false,
        }
    }

    /// An item of the list in here.
    pub(crate) fn item(self) -> Option<Self> {
        Some(Self { shape: self.shape.item()?, is_item: true, ..self })
    }

    /// What stands in brackets behind a word here.
    pub(crate) fn inside(self, shape: Shape) -> Self {
        Self { shape, is_item: true, ..self }
    }

    /// The same with another shape, that inside of an optional one.
    pub(crate) fn with(self, shape: Shape) -> Self {
        Self { shape, ..self }
    }

    /// The value where nothing is written.
    pub(crate) fn default(self) -> Option<Node> {
        let (group, field) = self.field.filter(|(_, field)| !self.is_item && !field.is_required)?;
        (group.default)().get(field.name).cloned()
    }

    /// Accepted values in words: the kind with its range, or the words.
    pub(crate) fn allowed(self) -> String {
        match (self.shape.there(), self.range) {
            (Shape::Words(words), _) => list(&words.names()),
            (Shape::Number | Shape::Count, Some((range, unit))) => {
                format!("{}, {}", self.shape.words(), range.in_words(unit, &Scene::default().write()))
            }
            _ => self.shape.words(),
        }
    }
}

/// The entry at a path; any item of a list stands for its siblings. Of several words, that of `tree` comes
/// first, then the first one that has such a field.
pub(crate) fn spot(path: &str, tree: Option<&Node>) -> Option<Spot> {
    let (mut spot, mut node) = (Spot::ROOT, tree);
    for step in steps(path) {
        let word = node.and_then(Node::word);
        node = node.and_then(|node| node.step(step));
        spot = match step {
            Step::Item(_) => spot.item()?,
            Step::Field(name) => {
                let of_word = match spot.shape.there() {
                    Shape::Words(words) => word.and_then(|word| words.get(word)?.inside),
                    _ => None,
                };
                let groups = of_word.into_iter().chain([spot.shape]).flat_map(Shape::groups);
                groups.filter_map(|group| Some(spot.at(group, group.get(name)?))).next()?
            }
        };
    }
    Some(spot)
}

/// Whether some scene has a field at this path that is a whole number.
pub fn counts(path: &str) -> bool {
    spot(path, None).is_some_and(|spot| spot.shape.counts())
}

/// Names of the fields directly inside a section (empty: the root) that a user may write.
pub(crate) fn names_in(section: &str) -> Vec<&'static str> {
    let inside = if section.is_empty() { Some(Spot::ROOT) } else { spot(section, None) };
    let mut names = Vec::new();
    for field in
        inside.map_or_else(Vec::new, |spot| spot.shape.groups()).iter().flat_map(|group| group.fields)
    {
        if !field.is_internal && !names.contains(&field.name) {
            names.push(field.name);
        }
    }
    names
}

/// Paths of all fields outside of lists, inner ones before the ones that contain them.
pub(crate) fn paths() -> &'static [String] {
    fn collect(shape: Shape, at: &str, into: &mut Vec<String>) {
        for field in shape.groups().iter().flat_map(|group| group.fields).filter(|field| !field.is_internal) {
            let path = join(at, field.name);
            collect(field.shape, &path, into);
            if !into.contains(&path) {
                into.push(path);
            }
        }
    }
    static PATHS: LazyLock<Vec<String>> = LazyLock::new(|| {
        let mut paths = Vec::new();
        collect(Scene::SHAPE, "", &mut paths);
        paths
    });
    &PATHS
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn invariant_every_number_of_a_scene_has_a_range_and_every_default_is_in_it() {
        fn check(spot: Spot, path: &str) {
            match spot.shape.there() {
                // Courses over time have their own rules for times.
                Shape::Number | Shape::Count => {
                    let (range, _) = spot.range.unwrap_or_else(|| panic!("{path} has no range"));
                    let default = spot.default().and_then(|node| f64::read(&node));
                    assert!(
                        default.is_none_or(|value| range.contains(value, &Scene::default().write())),
                        "{path}"
                    );
                }
                Shape::List(item) => check(Spot { is_item: true, ..spot.with(*item) }, path),
                Shape::Words(words) => {
                    words.words.iter().filter_map(|word| word.inside).for_each(|inside| {
                        check(Spot { is_item: true, ..spot.with(inside) }, path);
                    });
                }
                Shape::Group(group) => {
                    for field in group.fields {
                        check(spot.at(group, field), &format!("{path}.{}", field.name));
                    }
                }
                _ => {}
            }
        }
        check(Spot::ROOT, "");
    }

    #[test]
    fn invariant_a_path_leads_to_its_field() {
        for (path, words) in [
            ("mesh.size_mm", "a number, more than 0, at most 1000 mm"),
            ("defects[7].form.order", "a whole number, 1 to 10000"),
            ("operation.load_profile.to", "a number, more than 0, at most 1e9 N"),
            ("operation.speed_profile.amplitude", "a number, 0 to 100000 rpm"),
            ("defects[0].on", "`outer`, `inner`, `roller`"),
            ("mesh.grading", "a group `( … )` or `None`"),
        ] {
            assert_eq!(spot(path, None).map(Spot::allowed).as_deref(), Some(words), "{path}");
        }
        for none in ["", "mesh.", "mesh.size", "mesh..size_mm", "mesh[0]", "name.x"] {
            assert!(spot(none, None).is_none(), "{none}");
        }
    }
}
