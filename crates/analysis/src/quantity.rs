//! Every number of `summary.json`, declared in one place.
//!
//! The structures of a summary stand in `quantities!`, where one entry is one number: its comment, its name
//! with the unit at the end, and its type. Behind `=`, in a structure that names its function, is the
//! expression that measures it. Behind `=>` is its name in words, with which an ensemble's page lists it; a
//! number with a place, `at`, is a main one, which `compare` sets side by side and a campaign draws over its
//! fields.
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
//!
//! Reading and writing, the statistics of ensembles, the columns of campaigns, the targets of inferences, the
//! guide's page (`cargo xtask quantities`) and the schema for other programs follow from that entry.

pub(crate) mod schema;

use std::slice;

use serde_json::Value;
use stribeck_diagnosis::Defect;
use stribeck_scene::scene::DefectRing;
use stribeck_store::run_info::{MeshInfo, Status};

/// A number of `summary.json`.
#[derive(Debug, Clone, PartialEq)]
pub struct Quantity {
    /// Its path; of a number in each item of a list without the item, as in `events.floor_n`.
    pub path: String,
    /// Its comment.
    pub about: &'static str,
    /// Its name in words, where pages name it.
    pub words: Option<&'static str>,
    /// Its place among the main numbers; `None` where it is none.
    pub place: Option<usize>,
    /// Whether it stands in each item of a list.
    pub is_listed: bool,
}

/// A field of a structure of the summary.
#[derive(Debug)]
pub struct Entry {
    pub(crate) name: &'static str,
    pub(crate) about: &'static str,
    /// How it is written, by serde's words.
    pub(crate) written: &'static str,
    pub(crate) kind: Kind,
    pub(crate) words: Option<&'static str>,
    pub(crate) place: Option<usize>,
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
    fn single(self) -> Self {
        match self {
            Self::Optional(kind) | Self::Several(kind, _) | Self::Pair([_, kind]) => kind.single(),
            kind => kind,
        }
    }
}

/// A type that a summary is made of.
pub trait Part {
    /// Its content.
    const KIND: Kind = Kind::Text;
}

macro_rules! quantities {
    (@some) => { None };
    (@some $known:literal) => { Some($known) };
    (
        $(#[doc = $about:literal])+
        #[derive($($derive:ident),+)]
        pub struct $group:ident = $of:ident($($arg:ident: $from:ty),+) {
            $(
                $(#[doc = $doc:literal])+
                $(#[serde($($serde:tt)+)])?
                pub $name:ident: $kind:ty = $value:expr $(=> $words:literal $(at $place:literal)?)?,
            )+
        }
    ) => {
        quantities! {
            $(#[doc = $about])+
            #[derive($($derive),+)]
            pub struct $group {
                $(
                    $(#[doc = $doc])+
                    $(#[serde($($serde)+)])?
                    pub $name: $kind $(=> $words $(at $place)?)?,
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
                pub $name:ident: $kind:ty $(=> $words:literal $(at $place:literal)?)?,
            )+
        }
    ) => {
        $(#[doc = $about])+
        #[derive($($derive),+)]
        pub struct $group {
            $(
                $(#[doc = $doc])+
                $(#[serde($($serde)+)])?
                pub $name: $kind,
            )+
        }

        impl $crate::quantity::Part for $group {
            const KIND: $crate::quantity::Kind = $crate::quantity::Kind::Group(&[
                $($crate::quantity::Entry {
                    name: stringify!($name),
                    about: concat!($($doc),+),
                    written: concat!($(stringify!($($serde)+))?),
                    kind: <$kind as $crate::quantity::Part>::KIND,
                    words: quantities!(@some $($words)?),
                    place: quantities!(@some $($($place)?)?),
                }),+
            ]);
        }
    };
}
pub(crate) use quantities;

macro_rules! numbers {
    ($($kind:ident: $($of:ty),+;)+) => {
        $($(impl Part for $of {
            const KIND: Kind = Kind::$kind;
        })+)+
    };
}

numbers! {
    Number: f64;
    Whole: u64, u32, i32, usize;
    Flag: bool;
}

impl Part for String {}
impl Part for Status {}
impl Part for DefectRing {}
impl Part for Defect {}

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

impl Part for MeshInfo {
    const KIND: Kind = Kind::Group(&[
        counted("nodes", "Nodes."),
        counted("quads", "Quadrilaterals."),
        counted("triangles", "Triangles."),
        counted("roller_facets", "Facets on one roller."),
        counted("outer_facets", "Facets on the outer raceway, defect included."),
        counted("inner_facets", "Facets on the inner raceway."),
    ]);
}

const fn counted(name: &'static str, about: &'static str) -> Entry {
    Entry { name, about, written: "", kind: Kind::Whole, words: None, place: None }
}

/// The numbers of a structure, in its order.
pub(crate) fn of<T: Part>() -> Vec<Quantity> {
    let mut all = Vec::new();
    if let Kind::Group(sections) = T::KIND {
        list(sections, "", false, &mut all);
    }
    all
}

fn list(entries: &'static [Entry], path: &str, is_listed: bool, all: &mut Vec<Quantity>) {
    for entry in entries {
        let path = match (path, entry.written) {
            (path, "flatten") => path.to_owned(),
            ("", _) => entry.name.to_owned(),
            (path, _) => format!("{path}.{}", entry.name),
        };
        let (kind, is_listed) = match entry.kind.single() {
            Kind::List(items) => (items.single(), true),
            kind => (kind, is_listed),
        };
        match kind {
            Kind::Group(inner) => list(inner, &path, is_listed, all),
            Kind::Number | Kind::Whole | Kind::Flag => all.push(Quantity {
                path,
                about: entry.about.trim_start(),
                words: entry.words,
                place: entry.place,
                is_listed,
            }),
            _ => {}
        }
    }
}

impl Quantity {
    /// Its name without the sections that it stands in.
    pub fn name(&self) -> &str {
        self.path.rsplit('.').next().unwrap_or(&self.path)
    }

    /// Its unit; empty for none.
    pub fn unit(&self) -> &'static str {
        stem_and_unit(&self.path).1
    }

    /// Its comment as the page of all quantities has it, without links to code.
    pub fn about_in_markdown(&self) -> String {
        without_links(self.about).replace('|', "\\|")
    }

    /// Its value in a `summary.json`, in lists the mean of the items that have it.
    pub fn number(&self, summary: &Value) -> Option<f64> {
        let mut here = vec![summary];
        for name in self.path.split('.') {
            let inner = here.into_iter().filter_map(|value| value.get(name));
            here = inner
                .flat_map(|value| if self.is_listed { items(value) } else { slice::from_ref(value) })
                .collect();
        }
        let numbers: Vec<f64> = here.into_iter().filter_map(Value::as_f64).collect();
        (!numbers.is_empty()).then(|| numbers.iter().sum::<f64>() / numbers.len() as f64)
    }

    /// Whether it scatters so much between starts of one scene that its mean needs several: levels do.
    pub fn scatters(&self) -> bool {
        self.unit() == "g"
    }
}

/// A comment without links to code, and with the words of a file.
fn without_links(about: &str) -> String {
    about.replace("`None`", "`null`").replace("[`", "`").replace("`]", "`")
}

/// The items of a list; a value that is none by itself.
fn items(value: &Value) -> &[Value] {
    value.as_array().map_or(slice::from_ref(value), Vec::as_slice)
}

/// Units at the end of names, a longer one before those that it ends in.
const UNITS: [(&str, &str); 29] = [
    ("_kg_m3", "kg/m³"),
    ("_m_s2", "m/s²"),
    ("_per_gpa", "1/GPa"),
    ("_per_s", "1/s"),
    ("_pa_s", "Pa s"),
    ("_n_s_m", "N s/m"),
    ("_n_um", "N/µm"),
    ("_percent", "%"),
    ("_gpa", "GPa"),
    ("_mpa", "MPa"),
    ("_khz", "kHz"),
    ("_hz", "Hz"),
    ("_rpm", "rpm"),
    ("_deg", "°"),
    ("_db", "dB"),
    ("_kg", "kg"),
    ("_mm", "mm"),
    ("_um", "µm"),
    ("_nm", "nm"),
    ("_ms", "ms"),
    ("_us", "µs"),
    ("_ns", "ns"),
    ("_rad", "rad"),
    ("_j", "J"),
    ("_w", "W"),
    ("_n", "N"),
    ("_g", "g"),
    ("_s", "s"),
    ("_m", "m"),
];

/// The name of a number, field or column without its unit, and the unit that it ends in; empty for none.
pub fn stem_and_unit(name: &str) -> (&str, &'static str) {
    let found = UNITS.iter().find_map(|(end, unit)| Some((name.strip_suffix(end)?, *unit)));
    found.filter(|(stem, _)| !stem.is_empty()).unwrap_or((name, ""))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn behaves_units_are_read_from_names() {
        for (column, expected) in [
            ("sensor.side.ay_m_s2", "m/s²"),
            ("summary.levels.gap_rms_g", "g"),
            ("fault_size_mm", "mm"),
            ("n_samples", ""),
            ("bpfo_hz", "Hz"),
            ("scene.model.reduced.modes_khz", "kHz"),
        ] {
            assert_eq!(stem_and_unit(column).1, expected, "{column}");
        }
    }

    #[test]
    fn invariant_no_unit_hides_a_longer_one() {
        for (at, (end, _)) in UNITS.iter().enumerate() {
            assert!(UNITS[..at].iter().all(|(before, _)| !end.ends_with(before)), "{end}");
        }
    }
}
