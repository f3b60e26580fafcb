//! RON text → [`Scene`], with RON's errors turned into ours: the field, its value, what belongs there.

use ron::error::SpannedError;

use super::outline::Outline;
use super::problem::{Place, Problem, SceneError, offset, place_in_file};
use super::{dialect, suggest};
use crate::scene::{GradingScene, Scene};

/// Every field that a scene has, from the defaults.
pub(crate) struct Schema {
    text: String,
    outline: Outline,
}

impl Schema {
    pub(crate) fn new() -> Self {
        let mut scene = Scene::default();
        // Absent by default, but its fields must be known.
        scene.mesh.grading = Some(GradingScene::default());
        let text = scene.to_ron();
        let outline = Outline::of(&text);
        Self { text, outline }
    }

    /// Dotted paths of all fields, list items left out.
    pub(crate) fn paths(&self) -> Vec<&str> {
        self.outline
            .entries
            .iter()
            .map(|entry| entry.path.as_str())
            .filter(|path| !path.contains('['))
            .collect()
    }

    /// The default of `path` as text; any item of a list stands for its siblings.
    pub(crate) fn default_of(&self, path: &str) -> Option<&str> {
        let path = first_item(path);
        self.outline.get(&path).map(|entry| &self.text[entry.value.clone()])
    }

    /// Names valid directly inside `section` (empty: the root).
    pub(crate) fn names_in(&self, section: &str) -> Vec<&str> {
        let section = first_item(section);
        let prefix = if section.is_empty() { String::new() } else { format!("{section}.") };
        let names = self.outline.entries.iter().filter_map(|entry| entry.path.strip_prefix(&prefix));
        names.filter(|name| !name.contains(['.', '['])).collect()
    }

    /// True when `value` is a number and `path` takes one: then the fault lies behind it.
    fn accepts(&self, path: &str, value: &str) -> bool {
        let default = self.default_of(path).unwrap_or_default();
        if default == "None" || default.parse::<u64>().is_ok() {
            value.parse::<u64>().is_ok()
        } else {
            // Rust also reads `nan` and `infinity`, RON does not.
            let starts_like_one = value.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c));
            default.parse::<f64>().is_ok() && value.parse::<f64>().is_ok() && starts_like_one
        }
    }

    /// What belongs into `path`, in words.
    pub(crate) fn kind(&self, path: &str) -> &'static str {
        let value = self.default_of(path).unwrap_or_default();
        match value.chars().next() {
            // The two optional counts are `None` by default; so is nothing else.
            _ if value == "None" => "a whole number, or `None`",
            Some('"') => "a text in double quotes",
            Some('(') if ["cage", "defect"].contains(&path) => "a group `( … )`, or `None`",
            Some('(') => "a group `( … )`",
            Some('[') => "a list `[ … ]`",
            _ if value.parse::<u64>().is_ok() => "a whole number of 0 or more",
            _ if value.parse::<f64>().is_ok() => "a number",
            _ => "one of the listed words, without quotes",
        }
    }
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

/// Reads the types of a scene; its meaning is checked later.
pub(crate) fn parse(text: &str, file: &str) -> Result<Scene, SceneError> {
    deserialize(text).map_err(|fault| {
        let place = place_in_file(file, text, fault.range.clone());
        fault.problem(place).into()
    })
}

/// An error of syntax or type, its place still a byte range.
pub(crate) struct Fault {
    pub(crate) field: String,
    pub(crate) range: std::ops::Range<usize>,
    message: String,
    allowed: String,
    suggestion: String,
}

impl Fault {
    pub(crate) fn problem(self, place: Place) -> Problem {
        Problem {
            field: self.field,
            message: self.message,
            allowed: self.allowed,
            suggestion: self.suggestion,
            place,
        }
    }
}

pub(crate) fn deserialize(text: &str) -> Result<Scene, Box<Fault>> {
    let options = dialect();
    let whole = |e: SpannedError| Box::new(fault(text, "", &e));
    let mut source = ron::Deserializer::from_str_with_options(text, &options).map_err(whole)?;
    match serde_path_to_error::deserialize::<_, Scene>(&mut source) {
        Ok(scene) => {
            source.end().map_err(|code| Box::new(fault(text, "", &source.span_error(code))))?;
            Ok(scene)
        }
        Err(e) => {
            let path = e.path().to_string();
            Err(Box::new(fault(text, &path, &source.span_error(e.into_inner()))))
        }
    }
}

/// Words for one error of RON.
fn fault(text: &str, path: &str, error: &SpannedError) -> Fault {
    use ron::Error as E;
    let schema = Schema::new();
    let outline = Outline::of(text);
    let start = offset(text, error.span.start.line, error.span.start.col);
    let end = offset(text, error.span.end.line, error.span.end.col).max(start);
    let section = path.rsplit_once('.').map_or("", |(section, _)| section);
    let join = |section: &str, name: &str| match section {
        "" => name.to_owned(),
        section => format!("{section}.{name}"),
    };
    let mut fault = Fault {
        field: String::new(),
        range: start..end,
        message: format!("the scene cannot be read: {}", error.code),
        allowed: String::new(),
        suggestion: String::new(),
    };
    match &error.code {
        E::NoSuchStructField { expected, found, .. } => {
            // The path ends in the section, or in the unknown name, depending on how far serde came.
            let home = if path.ends_with(found.as_str()) { section } else { path };
            fault.field = join(home, found);
            let named =
                outline.entries.iter().find(|entry| entry.path == fault.field && entry.key.end <= end + 1);
            fault.range = named.map_or(start..end, |entry| entry.key.clone());
            let inside = if home.is_empty() { "a scene".to_owned() } else { format!("`{home}`") };
            fault.message = format!("unknown field `{found}` in {inside}");
            fault.allowed = suggest::list(expected);
            fault.suggestion = suggest::field(found, expected, &schema.paths());
        }
        E::NoSuchEnumVariant { expected, found, .. } => {
            fault.field = path.to_owned();
            fault.message = format!("`{path}` is `{found}`, which is not one of its words");
            fault.allowed = suggest::list(expected);
            fault.suggestion = match suggest::nearest(found, expected) {
                Some(near) => format!("did you mean `{near}`?"),
                None => schema.default_of(path).map(|v| format!("the default is {v}")).unwrap_or_default(),
            };
        }
        E::DuplicateStructField { field, .. } => {
            fault.field = (*field).to_owned();
            fault.message = format!("field `{field}` is given twice");
            fault.suggestion = "keep one of the two lines".to_owned();
        }
        E::MissingStructField { field, .. } => {
            fault.field = join(path, field);
            fault.message = format!("`{path}` has no field `{field}`, which has no default");
            fault.suggestion = format!("add `{field}: …` ({})", schema.kind(&fault.field));
        }
        E::ExpectedDifferentStructName { found, .. } if text[end..].trim_start().starts_with('(') => {
            fault.message = format!("`{found}(` is no part of a scene");
            fault.suggestion = "leave the name in front of the bracket out: `( … )`".to_owned();
        }
        _ if text.trim().is_empty() => {
            fault.message = "the scene is empty".to_owned();
            fault.suggestion = "`()` is the complete default scene; is the file cut off?".to_owned();
        }
        _ if error.code == E::Eof || (outline.root.is_none() && text[end..].trim().is_empty()) => {
            fault.message = "the scene ends too early: a closing bracket or a value is missing".to_owned();
            fault.suggestion = "is the file cut off? Every `(` needs its `)`".to_owned();
        }
        _ => value_fault(text, path, &outline, &schema, &mut fault),
    }
    fault
}

/// A value of the wrong type: RON names the character that surprised it, the user wants the field.
fn value_fault(text: &str, path: &str, outline: &Outline, schema: &Schema, fault: &mut Fault) {
    let candidates = [outline.get(path), outline.at(fault.range.end), outline.at(fault.range.start)];
    let culprit = candidates.into_iter().flatten().find(|entry| {
        let is_group =
            outline.entries.iter().any(|inner| inner.path.starts_with(&format!("{}.", entry.path)));
        !is_group
            && schema.default_of(&entry.path).is_some()
            && !schema.accepts(&entry.path, &text[entry.value.clone()])
    });
    let Some(entry) = culprit else {
        fault.field = path.to_owned();
        fault.suggestion = "look for a missing comma, bracket or quote near the mark".to_owned();
        return;
    };
    let value = &text[entry.value.clone()];
    let shown: String = value.chars().take(40).collect();
    let dots = if shown.len() < value.len() { "…" } else { "" };
    fault.field.clone_from(&entry.path);
    fault.range = entry.value.clone();
    fault.message = format!("`{}` is `{shown}{dots}`, which is not {}", entry.path, schema.kind(&entry.path));
    fault.allowed = schema.kind(&entry.path).to_owned();
    if value.eq_ignore_ascii_case("none") && fault.allowed.contains("`None`") {
        fault.suggestion = "`None`, with a capital letter".to_owned();
    } else if let Some(default) = schema.default_of(&entry.path).filter(|default| !default.contains('\n')) {
        fault.suggestion = format!("the default is {default}");
    }
}
