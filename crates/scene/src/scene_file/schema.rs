//! Every field of a scene, with its default and the kind of its value.

use std::sync::LazyLock;

use super::limits::{LOAD_PROFILE, OUTER_SPEED_PROFILE, SPEED_PROFILE};
use super::outline::Outline;
use crate::deviation::DeviationScene;
use crate::housing::HousingScene;
use crate::scene::{
    Assumed, FilmScene, GradingScene, HarmonicScene, ModelScene, ProfileScene, RampScene, RecordsScene,
    ReducedScene, RingMeshScene, RotatingLoadScene, Scene, StructuralDampingScene,
};

/// Groups that a scene may lack.
const OPTIONAL_GROUPS: [&str; 10] = [
    "cage",
    "defect",
    "film",
    "mesh.grading",
    "operation.rotating_load",
    "solver.structural_damping",
    "output.frames",
    "output.records",
    "outer_ring_mesh",
    "inner_ring_mesh",
];

/// Fields that describe another bearing than the default one.
const OF_ANOTHER: [&str; 4] =
    ["bearing.pitch_mm", "bearing.bore_mm", "bearing.outside_mm", "bearing.width_mm"];

/// Every field that a scene has, from the defaults.
pub(crate) struct Schema {
    /// A scene with everything, and one for each further form of the housing: a field is looked for in their
    /// order.
    scenes: Vec<Complete>,
}

/// A complete scene, and the same as text.
struct Complete {
    scene: Scene,
    text: String,
    outline: Outline,
}

impl Complete {
    fn of(scene: &Scene) -> Self {
        let text = scene.to_ron();
        let outline = Outline::of(&text);
        Self { scene: scene.clone(), text, outline }
    }
}

impl Schema {
    /// The same for all scenes: put together once, when it is asked for first.
    pub(crate) fn get() -> &'static Self {
        static SCHEMA: LazyLock<Schema> = LazyLock::new(Schema::new);
        &SCHEMA
    }

    fn new() -> Self {
        // A word by default, but the fields of the other variants must be known.
        let mut scene = Scene { model: ModelScene::Reduced(ReducedScene::default()), ..Scene::default() };
        // Absent by default, but its fields must be known.
        scene.mesh.grading = Some(GradingScene::default());
        scene.solver.structural_damping = Some(StructuralDampingScene::default());
        // Empty by default, but an item must have a kind.
        scene.cage.iter_mut().for_each(|cage| cage.roller_offsets_um.push(0.0));
        scene.defects = DeviationScene::of_every_form();
        scene.film = Some(FilmScene::default());
        scene.output.records = Some(RecordsScene::default());
        // One profile shows the fields of a ramp, the other those of a sine.
        scene.operation.speed_profile = Some(ProfileScene::Ramp(RampScene::default()));
        scene.operation.load_profile = Some(ProfileScene::Harmonic(HarmonicScene::default()));
        scene.outer_ring_mesh = Some(RingMeshScene::default());
        scene.inner_ring_mesh = Some(RingMeshScene::default());
        scene.operation.rotating_load = Some(RotatingLoadScene::default());
        // Not written by default.
        (scene.operation.load_angle_deg, scene.operation.outer_speed_rpm) = (0.5, 0.5);
        scene.bearing.clearance_change_um = 0.5;
        scene.bearing.pitch_mm = Some(181.98);
        scene.bearing.bore_mm = Some(143.96);
        scene.bearing.outside_mm = Some(220.0);
        scene.bearing.width_mm = Some(50.0);
        scene.bearing.assumed = vec![Assumed::Clearance];
        let of_housing = |housing| {
            scene.operation.outer_speed_profile.clone_from(&scene.operation.speed_profile);
            let complete = Complete::of(&Scene { housing, ..scene.clone() });
            // The next one shows the other kind of each profile.
            std::mem::swap(&mut scene.operation.speed_profile, &mut scene.operation.load_profile);
            complete
        };
        Self { scenes: HousingScene::of_every_form().into_iter().map(of_housing).collect() }
    }

    /// Dotted paths of all fields, list items left out.
    pub(crate) fn paths(&self) -> Vec<&str> {
        let mut paths: Vec<&str> = Vec::new();
        for path in
            self.scenes.iter().flat_map(|scene| &scene.outline.entries).map(|entry| entry.path.as_str())
        {
            if !path.contains('[') && !paths.contains(&path) {
                paths.push(path);
            }
        }
        paths
    }

    /// Text of a scene that has such a field, and where its value stands in it.
    fn find(&self, path: &str) -> Option<(&str, std::ops::Range<usize>)> {
        self.scenes
            .iter()
            .find_map(|scene| Some((scene.text.as_str(), scene.outline.get(path)?.value.clone())))
    }

    /// The path of the first item of a list that has such a field.
    fn item_with(&self, path: &str) -> String {
        let first = first_item(path);
        if self.find(&first).is_some() {
            return first;
        }
        forms_of(&first).find(|path| self.find(path).is_some()).unwrap_or(first)
    }

    /// The default of `path` as text; any item of a list stands for its siblings.
    pub(crate) fn default_of(&self, path: &str) -> Option<&str> {
        let path = self.item_with(path);
        let (text, value) = self.find(&path).or_else(|| self.find(&in_other_profile(&path)?))?;
        Some(&text[value])
    }

    /// The field `name` of the group behind `word` at `path`: the scene that has such a group, the field's
    /// path there and its value.
    pub(crate) fn behind(&self, path: &str, word: &str, name: &str) -> Option<(&Scene, String, &str)> {
        let path = &first_item(path);
        let groups: Vec<String> =
            std::iter::once(path.clone()).chain(in_other_profile(path)).chain(forms_of(path)).collect();
        groups.iter().find_map(|group| {
            self.scenes.iter().find_map(|complete| {
                let value = |path: &str| Some(&complete.text[complete.outline.get(path)?.value.clone()]);
                value(group).filter(|value| value.split('(').next() == Some(word))?;
                let field = format!("{group}.{name}");
                let default = value(&field)?;
                Some((&complete.scene, field, default))
            })
        })
    }

    /// The default of `path` where it is one word, text or number of its own.
    pub(crate) fn plain_default(&self, path: &str) -> Option<&str> {
        let has_one = !path.contains('[') && !OF_ANOTHER.contains(&path);
        self.default_of(path).filter(|default| has_one && !default.contains(['(', '[']))
    }

    /// Names valid directly inside `section` (empty: the root).
    pub(crate) fn names_in(&self, section: &str) -> Vec<&str> {
        let section = first_item(section);
        let prefix = if section.is_empty() { String::new() } else { format!("{section}.") };
        let prefixes = std::iter::once(prefix.clone()).chain(forms_of(&prefix));
        let mut names: Vec<&str> = Vec::new();
        for prefix in prefixes {
            let entries = self.scenes.iter().flat_map(|scene| &scene.outline.entries);
            let inside = entries.filter_map(|entry| entry.path.strip_prefix(&prefix));
            for name in inside.filter(|name| !name.contains(['.', '['])) {
                if !names.contains(&name) {
                    names.push(name);
                }
            }
        }
        names
    }

    /// True when `value` is a number and `path` takes one: then the fault lies behind it.
    pub(crate) fn accepts(&self, path: &str, value: &str) -> bool {
        let default = self.default_of(path).unwrap_or_default();
        if default == "None" || default.parse::<u64>().is_ok() {
            value.parse::<u64>().is_ok()
        } else {
            // Rust also reads `nan` and `infinity`, RON does not.
            let starts_like_one = value.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c));
            default.parse::<f64>().is_ok() && value.parse::<f64>().is_ok() && starts_like_one
        }
    }

    /// Kind of value at `path`.
    pub(crate) fn kind(&self, path: &str) -> Kind {
        let value = self.default_of(path).unwrap_or_default();
        match value.chars().next() {
            // The two optional counts are `None` by default; so is nothing else.
            _ if value == "None" => Kind::OptionalCount,
            Some('"') => Kind::Text,
            Some('(') if OPTIONAL_GROUPS.contains(&path) => Kind::OptionalGroup,
            Some('(') => Kind::Group,
            Some('[') => Kind::List,
            _ if value.parse::<u64>().is_ok() => Kind::Count,
            _ if value.parse::<f64>().is_ok() => Kind::Number,
            _ => Kind::Word,
        }
    }

    /// The complete default scene with `value` at `path`, as text; `None` for a field that no scene has.
    pub(crate) fn text_with(&self, path: &str, value: &str) -> Option<String> {
        let (text, place) = self.find(&self.item_with(path))?;
        Some(format!("{}{value}{}", &text[..place.start], &text[place.end..]))
    }
}

/// The same field of the other profile.
fn in_other_profile(path: &str) -> Option<String> {
    let other = |from: &str, to: &str| {
        let rest = path.strip_prefix(from)?;
        (rest.is_empty() || rest.starts_with('.')).then(|| format!("{to}{rest}"))
    };
    [(SPEED_PROFILE, LOAD_PROFILE), (OUTER_SPEED_PROFILE, LOAD_PROFILE), (LOAD_PROFILE, SPEED_PROFILE)]
        .into_iter()
        .find_map(|(from, to)| other(from, to))
}

/// A kind of value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Number,
    Count,
    OptionalCount,
    Text,
    Word,
    Group,
    OptionalGroup,
    List,
}

impl Kind {
    /// In words, with an article.
    pub(crate) fn words(self) -> &'static str {
        match self {
            Self::Number => "a number",
            Self::Count => "a whole number",
            Self::OptionalCount => "a whole number or `None`",
            Self::Text => "a text in double quotes",
            Self::Word => "one of the words allowed here",
            Self::Group => "a group `( … )`",
            Self::OptionalGroup => "a group `( … )` or `None`",
            Self::List => "a list `[ … ]`",
        }
    }
}

/// The same path in deviations of the other forms.
fn forms_of(path: &str) -> impl Iterator<Item = String> + use<> {
    let of_defects = path.strip_prefix("defects[0]").map(str::to_owned);
    let others = 1..DeviationScene::of_every_form().len();
    of_defects.into_iter().flat_map(move |rest| others.clone().map(move |i| format!("defects[{i}]{rest}")))
}

/// `sensors[7].name` → `sensors[0].name`.
fn first_item(path: &str) -> String {
    let mut inside = false;
    let mut out = String::with_capacity(path.len());
    for c in path.chars() {
        match c {
            '[' => {
                inside = true;
                out.push_str("[0");
            }
            ']' => {
                inside = false;
                out.push(']');
            }
            _ if inside => {}
            _ => out.push(c),
        }
    }
    out
}
