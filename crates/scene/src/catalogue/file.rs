//! Bearings of the user's own, by name: `bearings.ron` in the working folder, or in the configuration folder.

use std::path::{Path, PathBuf};

use ron::extensions::Extensions;
use serde::Deserialize;

use super::{Boundary, CatalogueBearing, Element};

/// Name of the file in either folder.
const NAME: &str = "bearings.ron";
/// Folder of the program in that of the configuration.
const FOLDER: &str = "stribeck";

/// One bearing of such a file. Lengths in mm.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    name: String,
    #[serde(default)]
    element: Kind,
    #[serde(default)]
    elements: Option<u32>,
    diameter_mm: f64,
    pitch_mm: f64,
    #[serde(default)]
    angle_deg: f64,
    #[serde(default)]
    bore_mm: Option<f64>,
    #[serde(default)]
    outside_mm: Option<f64>,
    #[serde(default)]
    width_mm: Option<f64>,
    #[serde(default)]
    source: String,
}

#[derive(Debug, Default, Clone, Copy, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Kind {
    #[default]
    Roller,
    Ball,
}

/// Example of such a file.
const EXAMPLE: &str = "[(name: \"mine\", element: roller, elements: 16, diameter_mm: 9.0, pitch_mm: 68.5, \
    bore_mm: 50, outside_mm: 85, width_mm: 20)]";

/// Bearings of the files that there are: those of the working folder first.
///
/// # Errors
/// Words on a file that is there and cannot be read.
pub(super) fn bearings() -> Result<Vec<CatalogueBearing>, String> {
    let mut all = Vec::new();
    for path in paths() {
        if path.is_file() {
            all.extend(read(&path)?);
        }
    }
    Ok(all)
}

fn paths() -> Vec<PathBuf> {
    let folder = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    let home = || folder("HOME").map(|home| home.join(".config"));
    let configuration = folder("XDG_CONFIG_HOME").or_else(|| folder("APPDATA")).or_else(home);
    let of_user = configuration.map(|folder| folder.join(FOLDER).join(NAME));
    std::iter::once(PathBuf::from(NAME)).chain(of_user).collect()
}

fn read(path: &Path) -> Result<Vec<CatalogueBearing>, String> {
    let shown = path.display();
    let text = std::fs::read_to_string(path).map_err(|why| format!("`{shown}` cannot be read: {why}"))?;
    // Some editors write a byte order mark first.
    let text = text.trim_start_matches('\u{feff}');
    let dialect = ron::Options::default().with_default_extension(Extensions::IMPLICIT_SOME);
    let entries: Vec<Entry> = dialect
        .from_str(text)
        .map_err(|why| format!("`{shown}` is no list of bearings: {why}. Such a list is `{EXAMPLE}`"))?;
    entries.into_iter().map(|entry| entry.bearing(path)).collect()
}

impl Entry {
    fn bearing(self, path: &Path) -> Result<CatalogueBearing, String> {
        let boundary = match (self.bore_mm, self.outside_mm, self.width_mm) {
            (Some(bore_mm), Some(outside_mm), Some(width_mm)) => {
                Some(Boundary { bore_mm, outside_mm, width_mm })
            }
            (None, None, None) => None,
            _ => {
                return Err(format!(
                    "`{}` in `{}` has some of `bore_mm`, `outside_mm` and `width_mm`: give all three, or \
                     none for its frequencies alone",
                    self.name,
                    path.display()
                ));
            }
        };
        let source = if self.source.is_empty() { path.display().to_string() } else { self.source };
        let bearing = CatalogueBearing {
            name: self.name,
            element: match self.element {
                Kind::Roller => Element::Roller,
                Kind::Ball => Element::Ball,
            },
            elements: self.elements,
            diameter_mm: self.diameter_mm,
            pitch_mm: self.pitch_mm,
            angle_deg: self.angle_deg,
            boundary,
            source,
        };
        let rings = bearing.boundary.is_none_or(|b| {
            let [inner, outer] = [-1.0, 1.0].map(|side| bearing.pitch_mm + side * bearing.diameter_mm);
            b.bore_mm > 0.0 && b.bore_mm < inner && outer < b.outside_mm && b.width_mm > 0.0
        });
        let letters = super::names::plain(&bearing.name);
        if letters.is_empty() || !bearing.is_sane() || !rings {
            return Err(format!(
                "`{}` in `{}` is no bearing: it needs a `name` with letters or digits, `diameter_mm`, a \
                 larger `pitch_mm` with room for its `elements`, and rings around them: `bore_mm` < pitch − \
                 diameter, pitch + diameter < `outside_mm`",
                bearing.name,
                path.display()
            ));
        }
        Ok(bearing)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use stribeck_testing::Scratch;

    fn of(text: &str) -> Result<Vec<CatalogueBearing>, String> {
        let folder = Scratch::create("bearings");
        let path = folder.join(NAME);
        std::fs::write(&path, text).expect("writable");
        read(&path)
    }

    #[test]
    fn behaves_bearings_of_ones_own_have_names() {
        let bearings = of(EXAMPLE).expect("the example");
        assert_eq!(bearings.len(), 1);
        let orders = bearings[0].orders().expect("16 rollers");
        assert!((orders.bpfo - 8.0 * (1.0 - 9.0 / 68.5)).abs() < 1e-12);
        assert!(bearings[0].source.ends_with(NAME));
        let found = super::super::names::find("Mine-2RS", bearings, "").expect("known");
        assert_eq!(found.name, "mine");
    }

    #[test]
    fn refuses_lists_that_are_none_and_bearings_that_cannot_be() {
        for (text, words) in [
            ("(name: \"x\")", "is no list of bearings"),
            ("[(name: \"x\", diameter_mm: 9)]", "pitch_mm"),
            ("[(name: \"x\", diameter_mm: 9, pitch_mm: 8)]", "is no bearing"),
            ("[(name: \"x\", diameter_mm: 9, pitch_mm: 68, elements: 99)]", "is no bearing"),
            ("[(name: \"-\", diameter_mm: 9, pitch_mm: 68)]", "is no bearing"),
            ("[(name: \"x\", diameter_mm: 9, pitch_mm: 68, bore_mm: 50)]", "all three"),
            (
                "[(name: \"x\", diameter_mm: 9, pitch_mm: 68, bore_mm: 60, outside_mm: 90, width_mm: 9)]",
                "rings",
            ),
        ] {
            let why = of(text).unwrap_err();
            assert!(why.contains(words) && why.contains(NAME), "{text}: {why}");
        }
    }
}
