//! Every number of `summary.json`, by its path.
//!
//! Reading and writing, the statistics of ensembles, the columns of campaigns, the guide's page
//! (`cargo xtask quantities`) and the schema for other programs follow from the declarations in `quantities!`
//! ([`stribeck_diagnosis::quantity`]).

pub mod schema;

use std::slice;

use serde_json::Value;
use stribeck_diagnosis::quantity::{Entry, Kind, Part};

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

/// The numbers of a structure, in its order.
pub(crate) fn of<T: Part>() -> Vec<Quantity> {
    let mut all = Vec::new();
    if let Kind::Group(sections) = T::KIND {
        list(sections, "", false, &mut all);
    }
    all
}

/// The columns of a table whose rows are of this type: its entries outside of lists, those of groups that are written
/// without a name of their own among them.
pub fn columns<T: Part>() -> Vec<&'static Entry> {
    fn add(kind: Kind, all: &mut Vec<&'static Entry>) {
        let Kind::Group(entries) = kind.single() else { return };
        for entry in entries {
            match (entry.written, entry.kind.single()) {
                ("flatten", inside) => add(inside, all),
                (_, Kind::Group(_) | Kind::List(_)) => {}
                _ => all.push(entry),
            }
        }
    }
    let mut all = Vec::new();
    add(T::KIND, &mut all);
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
        in_markdown(self.about)
    }

    /// Whether it is a column of the table of many runs: one that stands once, and is none of a clock's.
    pub fn is_of_table(&self) -> bool {
        !self.is_listed && !self.path.starts_with("run.")
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

/// A comment in a table of a page.
pub fn in_markdown(about: &str) -> String {
    without_links(about.trim_start()).replace('|', "\\|")
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
