//! Bearings by name: those of the user's own, in `bearings.ron` in the working folder or in `stribeck` below
//! that of the configuration, and those of the catalogue; and the assumptions that a bearing rests on.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use stribeck_theory::catalogue::{self, ADVICE, Boundary, CatalogueBearing, Element, plain};

use crate::group;
use crate::reading::{self, without_mark};
use crate::scene::{Assumed, BearingScene, ElementKind, Scene};

/// Name of the file in either folder.
const NAME: &str = "bearings.ron";
/// Folder of the program in that of the configuration.
const FOLDER: &str = "stribeck";

group! {
    /// One bearing of such a file. Lengths in mm.
    struct Entry {
        /// Its name.
        name: String = String::new(), required();
        element: ElementKind = ElementKind::Roller;
        /// How many there are.
        elements: Option<u64> = None;
        /// Their diameter [mm].
        diameter_mm: f64 = 0.0, required();
        /// Pitch diameter [mm].
        pitch_mm: f64 = 0.0, required();
        /// Contact angle [°].
        angle_deg: f64 = 0.0;
        /// Bore [mm].
        bore_mm: Option<f64> = None;
        /// Outside diameter [mm].
        outside_mm: Option<f64> = None;
        /// Width [mm].
        width_mm: Option<f64> = None;
        /// Where its numbers are from.
        source: String = String::new();
    }
}

/// The file.
const FILE: reading::Kind =
    reading::Kind { noun: "a list of bearings", example: EXAMPLE, for_fields_of_scenes: Some("") };

/// Example of such a file.
const EXAMPLE: &str = "[(name: \"mine\", element: roller, elements: 16, diameter_mm: 9.0, pitch_mm: 68.5, \
    bore_mm: 50, outside_mm: 85, width_mm: 20)]";

/// All bearings that have a name: those of the user's own files, then those of the catalogue.
///
/// # Errors
/// Words on a file of the user's own that cannot be read.
pub fn known() -> Result<Cow<'static, [CatalogueBearing]>, String> {
    let own = bearings()?;
    Ok(if own.is_empty() { catalogue::all().into() } else { [&own, catalogue::all()].concat().into() })
}

/// Those of [`known`] whose names begin as `text` does: `NU`, `62`.
pub fn beginning_with(text: &str) -> Result<Vec<CatalogueBearing>, String> {
    Ok(catalogue::beginning_with(text, &known()?))
}

/// A bearing by its name among [`known`], by its numbers, or both, as [`CatalogueBearing::parse`].
///
/// # Errors
/// As there, and words on a file of the user's own that cannot be read.
pub fn parse(text: &str) -> Result<CatalogueBearing, String> {
    parse_or_advise(text, ADVICE)
}

/// As [`parse`], with other advice where a name is unknown.
pub fn parse_or_advise(text: &str, advice: &str) -> Result<CatalogueBearing, String> {
    CatalogueBearing::parse_among(text, known, advice)
}

/// The bearing of a scene, as far as its frequencies go.
pub fn of_scene(scene: &Scene) -> CatalogueBearing {
    let b = &scene.bearing;
    CatalogueBearing {
        name: scene.name.clone(),
        element: Element::Roller,
        elements: u32::try_from(b.rollers).ok(),
        diameter_mm: b.roller_diameter_mm,
        pitch_mm: 0.5 * (b.outer_race_diameter_mm + b.inner_race_diameter_mm),
        angle_deg: 0.0,
        boundary: None,
        source: "the scene".to_owned(),
    }
}

/// Assumptions of a scene: dimensions that no catalogue prints, and dimensions that the fields of a bearing
/// left out.
pub fn assumptions(bearing: &BearingScene) -> Vec<String> {
    let own_balls = (bearing.element == ElementKind::Ball).then(|| as_cylinders("this bearing"));
    if !bearing.assumed.is_empty() || own_balls.is_some() {
        return bearing.assumed.iter().map(|what| assumption(*what, bearing)).chain(own_balls).collect();
    }
    // A file that can no longer be read does not concern the scene.
    let bearings = self::known().unwrap_or_else(|_| catalogue::all().into());
    let Some(known) = bearings.iter().find(|known| known.name == bearing.designation) else {
        return Vec::new();
    };
    let (name, length) = (&known.name, bearing.thickness_mm);
    let mut notes = Vec::new();
    // Another number is the user's.
    if known.elements.is_none() && known.usual_elements() == bearing.rollers {
        notes.push(format!(
            "makers fit different numbers of rolling elements into {name}; unless `elements` gave them, {} \
             are assumed here",
            bearing.rollers
        ));
    }
    if known.has_balls_by_rule() {
        notes.push(format!(
            "no source is known here for the balls of {name}: they are assumed to be 0.3 (outside − bore) in \
             diameter, half-way between bore and outside, which is right to some 6 %"
        ));
    }
    if known.has_raceways_in_proportion() {
        notes.push(format!(
            "no catalogue known here prints the raceways of {name}; they are assumed to lie where those of \
             its next larger size do, between bore and outside"
        ));
    }
    match known.element {
        Element::Roller => notes.push(format!(
            "clearance, cage and the length of the rollers, {length} mm, are usual ones for {name}, not its \
             maker's"
        )),
        Element::Ball => notes.push(as_cylinders(name) + ", and clearance and cage are usual ones"),
    }
    notes
}

/// The note on balls, which a plane model has as cylinders.
fn as_cylinders(name: &str) -> String {
    format!(
        "the balls of {name} are cylinders with the mass of balls between rings as wide as real ones, and raceways \
         approach each other as with balls; pressures and stresses in pictures are those of lines, not of points"
    )
}

/// An assumption about a bearing given by its own fields, in words.
fn assumption(what: Assumed, b: &BearingScene) -> String {
    let mm = |mm: f64| (1e4 * mm).round() / 1e4;
    match what {
        Assumed::Clearance => format!(
            "nobody gave the clearance of this bearing: {:.0} µm are assumed, the middle of the normal group \
             (ISO 5753-1), between raceways of {} and {} mm and rolling elements of {} mm",
            1e3 * (b.outer_race_diameter_mm - b.inner_race_diameter_mm - 2.0 * b.roller_diameter_mm),
            mm(b.outer_race_diameter_mm),
            mm(b.inner_race_diameter_mm),
            mm(b.roller_diameter_mm)
        ),
        Assumed::Pitch => format!(
            "nobody gave the pitch diameter of this bearing: {} mm are assumed, half-way between bore and \
             outside diameter, which is right to some 2 %",
            mm(0.5 * (b.outer_race_diameter_mm + b.inner_race_diameter_mm))
        ),
        Assumed::OuterRing => format!(
            "nobody gave `outside_mm` or the thickness of the outer ring: {} mm are assumed, 0.4 of a roller",
            mm(b.outer_ring_thickness_mm)
        ),
        Assumed::InnerRing => format!(
            "nobody gave `bore_mm` or the thickness of the inner ring: {} mm are assumed, 0.4 of a roller",
            mm(b.inner_ring_thickness_mm)
        ),
        Assumed::Rollers => format!(
            "nobody gave the number of rolling elements: {} are assumed, with {} of the pitch circle free, and \
             all frequencies of defects but that of the cage follow it",
            b.rollers,
            if b.element == ElementKind::Ball { "as much as it takes to fill them in" } else { "a fifth" }
        ),
        Assumed::Length => format!(
            "nobody gave {}",
            if b.element == ElementKind::Ball {
                format!("`width_mm`: {} mm are assumed, a ball over 0.6", mm(b.thickness_mm))
            } else {
                format!(
                    "the length of the rollers, `thickness_mm`: {} mm are assumed, 0.6 of `width_mm` or, without \
                     it, a roller's diameter",
                    mm(b.thickness_mm)
                )
            }
        ),
    }
}

/// Bearings of the files that there are: those of the working folder first.
fn bearings() -> Result<Vec<CatalogueBearing>, String> {
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
    let (entries, _): (Vec<Entry>, _) = reading::read_as(without_mark(&text), &shown.to_string(), &FILE)
        .map_err(|why| format!("`{shown}` is no list of bearings, such as `{EXAMPLE}`:\n{why}"))?;
    entries.into_iter().map(|entry| entry.bearing(path)).collect()
}

impl From<ElementKind> for Element {
    fn from(kind: ElementKind) -> Self {
        match kind {
            ElementKind::Roller => Self::Roller,
            ElementKind::Ball => Self::Ball,
        }
    }
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
            element: self.element.into(),
            // No bearing has room for that many.
            elements: self.elements.map(|count| u32::try_from(count).unwrap_or(u32::MAX)),
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
        let letters = plain(&bearing.name);
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
        let found = CatalogueBearing::parse_among("Mine-2RS", || Ok(bearings.into()), "").expect("known");
        assert_eq!(found.name, "mine");
    }

    #[test]
    fn refuses_lists_that_are_none_and_bearings_that_cannot_be() {
        for (text, words) in [
            ("(name: \"x\")", "a list `[ … ]` is expected here"),
            ("[(name: \"x\", diameter_mm: 9, pitch_mm: 68, elements: 5000000000)]", "is no bearing"),
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
        let why = of("[(name: \"x\", diameter_mm: 9, pitch_mm: 68, rollers: 9)]").unwrap_err();
        assert!(why.contains("unknown field `rollers`") && !why.contains("belongs in"), "{why}");
    }

    #[test]
    fn behaves_a_number_that_was_counted_is_not_assumed() {
        for (text, assumed) in [("NU 305", true), ("NU 305, elements=12", false)] {
            let scene = Scene::parse(&format!("(bearing: \"{text}\")"), "mine").unwrap();
            let notes = assumptions(&scene.bearing);
            assert_eq!(
                notes.iter().any(|note| note.contains("are assumed here")),
                assumed,
                "{text}: {notes:?}"
            );
        }
    }
}
