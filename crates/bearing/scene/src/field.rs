//! What a field of a scene is, and how one is declared: once, by [`group!`](crate::group) or
//! [`words!`](crate::words), with its name, type, default, range and a sentence that has its unit in brackets.
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

pub(crate) mod range;
pub mod tree;
pub mod value;
pub(crate) mod wording;

use range::{Limits, Most, Range};
use tree::Node;
use value::Value;

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

    /// Numbers from `low` to what `of` makes of the field `most` of the same scene.
    pub const fn up_to(self, low: f64, most: &'static str, of: fn(f64) -> f64) -> Self {
        let most = Most { path: most, of };
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
    pub(crate) fn item(self) -> Option<Self> {
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
            const FIELDS: &'static [$crate::field::Field] = &[
                $($crate::field::Field::new::<$type>(stringify!($field), &[$($doc),*])
                    $(.$rule($($with)*))*),*
            ];
            const GROUP: &'static $crate::field::Group = &$crate::field::Group {
                name: stringify!($name),
                about: &[$($about),*],
                fields: Self::FIELDS,
                default: || $crate::field::value::Value::write(&Self::default()),
            };
        }

        impl $crate::field::value::Value for $name {
            const SHAPE: $crate::field::Shape = $crate::field::Shape::Group(Self::GROUP);

            fn read(node: &$crate::field::tree::Node) -> Option<Self> {
                let mut read = Self::default();
                $(if let Some(node) = node.field(stringify!($field)) {
                    read.$field = $crate::field::value::Value::read(node)?;
                })*
                Some(read)
            }

            fn write(&self) -> $crate::field::tree::Node {
                $crate::field::tree::Node::group([
                    $((stringify!($field), $crate::field::value::Value::write(&self.$field))),*
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
            const WORDS: &'static $crate::field::Words = &$crate::field::Words {
                about: &[$($about),*],
                words: &[$($crate::field::Word {
                    word: $word,
                    about: &[$($doc),*],
                    inside: $crate::words!(@inside $($type)?),
                }),*],
            };
        }

        impl $crate::field::value::Value for $name {
            const SHAPE: $crate::field::Shape = $crate::field::Shape::Words(Self::WORDS);

            fn read(node: &$crate::field::tree::Node) -> Option<Self> {
                match node.word()? {
                    $($word => Some(Self::$variant $((
                        <$type as $crate::field::value::Value>::read(node.inside())?
                    ))?),)*
                    _ => None,
                }
            }

            fn write(&self) -> $crate::field::tree::Node {
                match self {
                    $(Self::$variant $(($of))? => $crate::words!(@write $word $(, $of)?),)*
                }
            }
        }
    };
    (@inside) => { None };
    (@inside $type:ty) => { Some(<$type as $crate::field::value::Value>::SHAPE) };
    (@write $word:literal) => { $crate::field::tree::Node::atom($word) };
    (@write $word:literal, $of:ident) => {
        $crate::field::tree::Node::behind($word, $crate::field::value::Value::write($of))
    };
}

pub use crate::{group, words};
