//! The table of all fields of a scene: each is declared once, by [`group!`] or [`words!`], with its name,
//! type, default, range and a sentence that has its unit in brackets.
//!
//! ```text
//! group! {
//!     /// Oil between rollers and raceways, fully flooded.
//!     pub struct FilmScene {
//!         /// Composite roughness of roller and raceway, √(Rq₁² + Rq₂²) [µm].
//!         pub roughness_um: f64 = 0.3, within(0.01, 10.0);
//!     }
//! }
//! ```
//!
//! Reading, ranges, suggestions for misspelt names, `--set`, the axes of campaigns, the identity of
//! a scene, the page of all fields and the schema for editors follow from it.

mod difference;
pub(crate) mod page;
pub(crate) mod range;
pub(crate) mod schema;
pub mod tree;
pub mod value;

use std::sync::LazyLock;

pub use difference::differences;
pub use page::page;
use range::{Limits, Range};
pub use schema::{json_schema, to_json};
use tree::{Node, Step, join, steps};
use value::Value;

use crate::scene::Scene;
use crate::scene_file::wording::list;

/// What is written for a value.
#[derive(Debug, Clone, Copy)]
pub enum Shape {
    /// Any value.
    Any,
    /// A number.
    Number,
    /// A whole number, 0 or more.
    Count,
    /// A text in double quotes.
    Text,
    /// Two numbers in brackets.
    Pair,
    /// The same, or `None`.
    Optional(&'static Shape),
    /// A list of such values.
    List(&'static Shape),
    /// One of several words, some with more in brackets.
    Words(&'static Words),
    /// Named fields in brackets.
    Group(&'static Group),
}

/// Named fields in brackets.
#[derive(Debug)]
pub struct Group {
    /// Name of its type.
    pub name: &'static str,
    /// Lines of its description.
    pub about: &'static [&'static str],
    /// Its fields in order.
    pub fields: &'static [Field],
    /// The values of omitted fields.
    pub default: fn() -> Node,
}

/// Several words of which one is written.
#[derive(Debug)]
pub struct Words {
    /// Lines of their description.
    pub about: &'static [&'static str],
    /// The words.
    pub words: &'static [Word],
}

/// A word, and what stands in brackets behind it.
#[derive(Debug)]
pub struct Word {
    /// As it is written.
    pub word: &'static str,
    /// Lines of its description.
    pub about: &'static [&'static str],
    /// What stands in its brackets, if it has any.
    pub inside: Option<Shape>,
}

/// A field of a group.
#[derive(Debug, Clone, Copy)]
pub struct Field {
    /// As it is written.
    pub name: &'static str,
    /// Lines of its description.
    pub about: &'static [&'static str],
    /// What is written for it.
    pub shape: Shape,
    pub(crate) limits: Limits,
    /// It has no default.
    pub is_required: bool,
    /// The program writes it, not the user.
    pub is_internal: bool,
    /// It is left out of a written scene where it has its default, and so out of the scene's identity.
    pub is_omitted: bool,
    /// Value with which the scene is as it was before there was this field: it is left out of the identity.
    pub before: Option<&'static str>,
}

impl Field {
    /// A field of any values of its type.
    pub const fn new<T: Value>(name: &'static str, about: &'static [&'static str]) -> Self {
        let (limits, before) = (Limits::None, None);
        let (is_required, is_internal, is_omitted) = (false, false, false);
        Self { name, about, shape: T::SHAPE, limits, is_required, is_internal, is_omitted, before }
    }

    /// Numbers above 0, up to `high`.
    pub const fn positive(self, high: f64) -> Self {
        self.range(Range { low: 0.0, low_included: false, high, high_included: true, most: None })
    }

    /// Numbers from `low` to `high`.
    pub const fn within(self, low: f64, high: f64) -> Self {
        self.range(Range { low, low_included: true, high, high_included: true, most: None })
    }

    /// Numbers from `low` to below `high`.
    pub const fn below(self, low: f64, high: f64) -> Self {
        self.range(Range { low, low_included: true, high, high_included: false, most: None })
    }

    /// Numbers from `low` to a limit that other fields set.
    pub const fn up_to(self, low: f64, most: fn(&Scene) -> f64) -> Self {
        self.range(Range { low, low_included: true, high: f64::NAN, high_included: true, most: Some(most) })
    }

    const fn range(mut self, range: Range) -> Self {
        self.limits = Limits::Own(range);
        self
    }

    /// A value of the field that the group varies.
    pub const fn varied(mut self) -> Self {
        self.limits = Limits::Varied;
        self
    }

    /// An amplitude of the field that the group varies.
    pub const fn amplitude(mut self) -> Self {
        self.limits = Limits::Amplitude;
        self
    }

    /// There is no default.
    pub const fn required(mut self) -> Self {
        self.is_required = true;
        self
    }

    /// The program writes it, not the user.
    pub const fn internal(mut self) -> Self {
        self.is_internal = true;
        self
    }

    /// Not written where it has its default.
    pub const fn omitted(mut self) -> Self {
        self.is_omitted = true;
        self
    }

    /// Without effect where it has this value.
    pub const fn before(mut self, value: &'static str) -> Self {
        self.before = Some(value);
        self
    }

    /// Unit in brackets in its description; empty without one.
    pub(crate) fn unit(&self) -> &'static str {
        let in_brackets = |line: &&'static str| {
            let (_, rest) = line.split_once('[').filter(|(_, rest)| !rest.starts_with('`'))?;
            rest.split_once(']').map(|(unit, _)| unit)
        };
        self.about.iter().find_map(in_brackets).filter(|unit| *unit != "-").unwrap_or_default()
    }
}

impl Shape {
    /// In words, with an article.
    pub(crate) fn words(self) -> String {
        match self {
            Self::Any => "a value".to_owned(),
            Self::Number => "a number".to_owned(),
            Self::Count => "a whole number".to_owned(),
            Self::Text => "a text in double quotes".to_owned(),
            Self::Pair => "two numbers in brackets `( …, … )`".to_owned(),
            Self::Words(_) => "one of the words allowed here".to_owned(),
            Self::Group(_) => "a group `( … )`".to_owned(),
            Self::List(_) => "a list `[ … ]`".to_owned(),
            Self::Optional(Self::Words(_)) => "one of the words allowed here".to_owned(),
            Self::Optional(inner) => format!("{} or `None`", inner.words()),
        }
    }

    /// The same where it is there.
    pub(crate) fn there(self) -> Self {
        if let Self::Optional(inner) = self { *inner } else { self }
    }

    /// Whether it is a whole number.
    pub(crate) fn counts(self) -> bool {
        matches!(self.there(), Self::Count)
    }

    /// Groups of fields directly inside, one for each word that has some.
    pub(crate) fn groups(self) -> Vec<&'static Group> {
        match self.there() {
            Self::Group(group) => vec![group],
            Self::Words(words) => {
                words.words.iter().filter_map(|word| word.inside).flat_map(Self::groups).collect()
            }
            _ => Vec::new(),
        }
    }

    /// The shape of the items of a list, also of one behind a word.
    fn item(self) -> Option<Self> {
        match self.there() {
            Self::List(item) => Some(*item),
            Self::Words(words) => words.words.iter().filter_map(|word| word.inside?.item()).next(),
            _ => None,
        }
    }
}

impl Words {
    /// The word that is written so.
    pub(crate) fn get(&self, word: &str) -> Option<&'static Word> {
        self.words.iter().find(|known| known.word == word)
    }

    /// All of them.
    pub(crate) fn names(&self) -> Vec<&'static str> {
        self.words.iter().map(|word| word.word).collect()
    }
}

impl Group {
    pub(crate) fn get(&self, name: &str) -> Option<&'static Field> {
        self.fields.iter().find(|field| field.name == name)
    }

    pub(crate) fn omits(&self, field: &Field, node: &Node) -> bool {
        field.is_omitted && (self.default)().field(field.name) == Some(node)
    }
}

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
                format!("{}, {}", self.shape.words(), range.in_words(unit, &Scene::default()))
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

/// Declares a group of fields: the structure, its default, and its part of the table. Behind the default of a
/// field stand its range and other rules, which are methods of [`Field`].
#[macro_export]
macro_rules! group {
    ($(#[doc = $about:literal])* $vis:vis struct $name:ident $(: $($also:ident),+)? {
        $($(#[doc = $doc:literal])*
        $of:vis $field:ident: $type:ty = $default:expr $(, $rule:ident($($with:tt)*))*;)*
    }) => {
        $(#[doc = $about])*
        #[derive(Debug, Clone, PartialEq $(, $($also),+)?)]
        $vis struct $name {
            $($(#[doc = $doc])* $of $field: $type,)*
        }

        impl Default for $name {
            fn default() -> Self {
                Self { $($field: $default),* }
            }
        }

        impl $name {
            const FIELDS: &'static [$crate::fields::Field] = &[
                $($crate::fields::Field::new::<$type>(stringify!($field), &[$($doc),*])
                    $(.$rule($($with)*))*),*
            ];
            const GROUP: &'static $crate::fields::Group = &$crate::fields::Group {
                name: stringify!($name),
                about: &[$($about),*],
                fields: Self::FIELDS,
                default: || $crate::fields::value::Value::write(&Self::default()),
            };
        }

        impl $crate::fields::value::Value for $name {
            const SHAPE: $crate::fields::Shape = $crate::fields::Shape::Group(Self::GROUP);

            fn read(node: &$crate::fields::tree::Node) -> Option<Self> {
                let mut read = Self::default();
                $(if let Some(node) = node.field(stringify!($field)) {
                    read.$field = $crate::fields::value::Value::read(node)?;
                })*
                Some(read)
            }

            fn write(&self) -> $crate::fields::tree::Node {
                $crate::fields::tree::Node::group([
                    $((stringify!($field), $crate::fields::value::Value::write(&self.$field))),*
                ])
            }
        }
    };
}

/// Declares words of which one is written: the enumeration and its part of the table.
#[macro_export]
macro_rules! words {
    ($(#[doc = $about:literal])* $(#[serde($($serde:tt)*)])?
    $vis:vis enum $name:ident $(: $($also:ident),+)? {
        $(
            $(#[doc = $doc:literal])* $(#[default $($first:tt)*])?
            $variant:ident $(($of:ident: $type:ty))? = $word:literal,
        )*
    }) => {
        $(#[doc = $about])*
        #[derive(Debug, Clone, PartialEq $(, $($also),+)?)]
        $(#[serde($($serde)*)])?
        $vis enum $name {
            $($(#[doc = $doc])* $(#[default $($first)*])? $variant $(($type))?,)*
        }

        impl $name {
            const WORDS: &'static $crate::fields::Words = &$crate::fields::Words {
                about: &[$($about),*],
                words: &[$($crate::fields::Word {
                    word: $word,
                    about: &[$($doc),*],
                    inside: $crate::words!(@inside $($type)?),
                }),*],
            };
        }

        impl $crate::fields::value::Value for $name {
            const SHAPE: $crate::fields::Shape = $crate::fields::Shape::Words(Self::WORDS);

            fn read(node: &$crate::fields::tree::Node) -> Option<Self> {
                match node.word()? {
                    $($word => Some(Self::$variant $((
                        <$type as $crate::fields::value::Value>::read(node.inside())?
                    ))?),)*
                    _ => None,
                }
            }

            fn write(&self) -> $crate::fields::tree::Node {
                match self {
                    $(Self::$variant $(($of))? => $crate::words!(@write $word $(, $of)?),)*
                }
            }
        }
    };
    (@inside) => { None };
    (@inside $type:ty) => { Some(<$type as $crate::fields::value::Value>::SHAPE) };
    (@write $word:literal) => { $crate::fields::tree::Node::atom($word) };
    (@write $word:literal, $of:ident) => {
        $crate::fields::tree::Node::behind($word, $crate::fields::value::Value::write($of))
    };
}

pub use crate::{group, words};

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
                    assert!(default.is_none_or(|value| range.contains(value, &Scene::default())), "{path}");
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
