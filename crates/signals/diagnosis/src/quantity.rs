//! Results as they are declared: structures of which one entry is one number, with its comment, its name with
//! the unit at the end, and its type.
//!
//! Files, their schemas and pages of their names follow from these entries. Behind `=`, in a structure that
//! names its function, is the expression that measures a number. Behind `as` is the content of a type of
//! another crate. Behind `=>` is its name in words, with which an ensemble's page lists it; a number with a
//! place, `at`, is a main one, which `compare` sets side by side and a campaign draws over its fields.
//!
//! ```text
//! quantities! {
//!     /// Numbers of a record about its mean.
//!     #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
//!     pub struct RecordLevels = of(signal: &Shape) {
//!         /// Largest distance from the mean [g].
//!         pub peak_g: f64 = signal.peak => "peak" at 1,
//!     }
//! }
//! ```

use crate::record::zone::{Foundation, Group, Zone};
use crate::record::{alarm, quality};
use crate::{Answer, Defect, Reason};

/// A field of a structure.
#[derive(Debug)]
pub struct Entry {
    /// Its name in files.
    pub name: &'static str,
    /// Its comment.
    pub about: &'static str,
    /// How it is written, by serde's words.
    pub written: &'static str,
    /// Its content.
    pub kind: Kind,
    /// Its name in words, where pages name it.
    pub words: Option<&'static str>,
    /// Its place among the main numbers.
    pub place: Option<usize>,
}

/// Content of a field.
#[derive(Debug, Clone, Copy)]
pub enum Kind {
    /// A number; `null` in a file where it is not finite.
    Number,
    /// A whole number.
    Whole,
    /// Yes or no.
    Flag,
    /// Words.
    Text,
    /// A structure.
    Group(&'static [Entry]),
    /// Items of one kind.
    List(&'static Kind),
    /// One kind, or nothing.
    Optional(&'static Kind),
    /// As many of one kind.
    Several(&'static Kind, usize),
    /// A pair of numbers, or a name with its number.
    Pair([&'static Kind; 2]),
}

impl Kind {
    /// The kind of each of several, and of what may be missing.
    pub fn single(self) -> Self {
        match self {
            Self::Optional(kind) | Self::Several(kind, _) | Self::Pair([_, kind]) => kind.single(),
            kind => kind,
        }
    }
}

/// A type that results are made of.
pub trait Part {
    /// Its content.
    const KIND: Kind = Kind::Text;
}

/// Declares structures: each number once, with its comment, unit and type.
#[macro_export]
macro_rules! quantities {
    (@kind $kind:ty) => { <$kind as $crate::quantity::Part>::KIND };
    (@kind $kind:ty as $said:ident) => { $said };
    (@some) => { None };
    (@some $known:literal) => { Some($known) };
    (
        $(#[doc = $about:literal])+
        #[derive($($derive:ident),+)]
        pub struct $group:ident = $of:ident($($arg:ident: $from:ty),+) {
            $(
                $(#[doc = $doc:literal])+
                $(#[serde($($serde:tt)+)])?
                pub $name:ident: $kind:ty $(as $said:ident)? = $value:expr $(=> $words:literal $(at $place:literal)?)?,
            )+
        }
    ) => {
        $crate::quantities! {
            $(#[doc = $about])+
            #[derive($($derive),+)]
            pub struct $group {
                $(
                    $(#[doc = $doc])+
                    $(#[serde($($serde)+)])?
                    pub $name: $kind $(as $said)? $(=> $words $(at $place)?)?,
                )+
            }
        }

        impl $group {
            /// Measures each number.
            pub fn $of($($arg: $from),+) -> Self {
                Self { $($name: $value),+ }
            }
        }
    };
    (
        $(#[doc = $about:literal])+
        #[derive($($derive:ident),+)]
        pub struct $group:ident {
            $(
                $(#[doc = $doc:literal])+
                $(#[serde($($serde:tt)+)])?
                $seen:vis $name:ident: $kind:ty $(as $said:ident)? $(=> $words:literal $(at $place:literal)?)?,
            )+
        }
    ) => {
        $(#[doc = $about])+
        #[derive($($derive),+)]
        pub struct $group {
            $(
                $(#[doc = $doc])+
                $(#[serde($($serde)+)])?
                $seen $name: $kind,
            )+
        }

        impl $crate::quantity::Part for $group {
            const KIND: $crate::quantity::Kind = $crate::quantity::Kind::Group(&[
                $($crate::quantity::Entry {
                    name: stringify!($name),
                    about: concat!($($doc),+),
                    written: concat!($(stringify!($($serde)+))?),
                    kind: $crate::quantities!(@kind $kind $(as $said)?),
                    words: $crate::quantities!(@some $($words)?),
                    place: $crate::quantities!(@some $($($place)?)?),
                }),+
            ]);
        }
    };
}

macro_rules! contents {
    ($($kind:ident: $($of:ty),+;)+) => {
        $($(impl Part for $of {
            const KIND: Kind = Kind::$kind;
        })+)+
    };
}

contents! {
    Number: f64;
    Whole: u64, u32, i32, usize;
    Flag: bool;
    Text: String, &'static str, Answer, Defect, Reason, Group, Foundation, Zone, quality::Kind, alarm::Quantity, alarm::State;
}

impl<T: Part> Part for Option<T> {
    const KIND: Kind = Kind::Optional(&T::KIND);
}

impl<T: Part> Part for Vec<T> {
    const KIND: Kind = Kind::List(&T::KIND);
}

impl<T: Part, const N: usize> Part for [T; N] {
    const KIND: Kind = Kind::Several(&T::KIND, N);
}

impl<A: Part, B: Part> Part for (A, B) {
    const KIND: Kind = Kind::Pair([&A::KIND, &B::KIND]);
}
