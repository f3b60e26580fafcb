//! RON text → [`Scene`], with RON's errors turned into ours: the field, its value, the expected kind of
//! value.

use ron::error::SpannedError;

use super::dialect::dialect;
use super::outline::Outline;
use super::problem::{Place, Problem, SceneError, offset, place_in_file};
use super::schema::{Kind, Schema};
use super::wording::{list, number, shown};
use super::{foreign, limits, suggest};
use crate::catalogue::CatalogueBearing;
use crate::scene::Scene;

/// Reads the types of a scene; its meaning is checked later. `written` is the user's text; places in it are
/// those of `text`.
pub(crate) fn parse(text: &str, written: &str, file: &str) -> Result<Scene, SceneError> {
    deserialize(text).map_err(|fault| {
        let place = place_in_file(file, written, fault.range.clone());
        fault.problem(place).into()
    })
}

/// An error of syntax or type, its place still a byte range.
pub(crate) struct Fault {
    pub(crate) field: String,
    pub(crate) range: std::ops::Range<usize>,
    message: String,
    allowed: String,
    /// Remedy in words.
    suggestion: String,
    /// Proposed value of the field, and the reason.
    proposal: Option<(String, &'static str)>,
}

impl Fault {
    pub(crate) fn problem(self, place: Place) -> Problem {
        let mut problem = Problem::new(self.message, place);
        problem.field.clone_from(&self.field);
        problem.allowed = self.allowed;
        problem.suggestion = self.suggestion;
        if let Some((value, note)) = self.proposal {
            problem.propose(&self.field, &value, note);
        }
        problem
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

/// Content of a mesh file, which the program writes into the scene of a run.
const HELD: &str = "text";

/// Words for one error of RON.
fn fault(text: &str, path: &str, error: &SpannedError) -> Fault {
    use ron::Error as E;
    let schema = Schema::get();
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
        proposal: None,
    };
    if let Some(habit) = foreign::other_format(text) {
        return Fault { range: habit.range, message: habit.message, suggestion: habit.suggestion, ..fault };
    }
    match &error.code {
        E::NoSuchStructField { expected, found, .. } => {
            // The path ends in the section, or in the unknown name, depending on how far serde came.
            let home = if path.ends_with(found.as_str()) { section } else { path };
            fault.field = join(home, found);
            let named =
                outline.entries.iter().find(|entry| entry.path == fault.field && entry.key.end <= end + 1);
            fault.range = named.map_or(start..end, |entry| entry.key.clone());
            let inside = if home.is_empty() { "a scene".to_owned() } else { format!("`{home}`") };
            fault.message = format!("unknown field `{}` in {inside}", shown(found));
            let expected: Vec<&str> = expected.iter().copied().filter(|name| *name != HELD).collect();
            fault.allowed = list(&expected);
            fault.suggestion = suggest::field(found, &expected, &schema.paths()).unwrap_or_default();
        }
        E::NoSuchEnumVariant { expected, found, .. } => {
            fault.field = path.to_owned();
            fault.message = format!("`{path}` is `{}`, which is not one of its words", shown(found));
            fault.allowed = list(expected);
            match suggest::nearest(found, expected) {
                Some(near) => fault.suggestion = format!("did you mean `{near}`?"),
                None => {
                    fault.proposal = schema.plain_default(path).map(|word| (word.to_owned(), "the default"))
                }
            }
        }
        E::DuplicateStructField { field, .. } => {
            fault.field = (*field).to_owned();
            fault.message = format!("field `{field}` is given twice");
            fault.suggestion = "keep one of the two lines".to_owned();
        }
        E::MissingStructField { field, .. } => {
            fault.field = join(path, field);
            fault.message = format!("`{path}` has no field `{field}`, which has no default");
            fault.suggestion = format!("add `{field}: …` ({})", schema.kind(&fault.field).words());
        }
        E::ExpectedDifferentStructName { found, .. } if text[end..].trim_start().starts_with('(') => {
            fault.message = format!("`{}(` is no part of a scene", shown(found));
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
        E::ExpectedNamedStructLike(_) | E::ExpectedStructLike => {
            value_fault(text, path, &outline, schema, &mut fault);
            if fault.allowed.is_empty() {
                fault.message = "a group `( … )` is expected here".to_owned();
            }
        }
        _ => value_fault(text, path, &outline, schema, &mut fault),
    }
    fault
}

/// A value of the wrong type: RON names a character, the user needs the field.
fn value_fault(text: &str, path: &str, outline: &Outline, schema: &Schema, fault: &mut Fault) {
    if let Some((entry, habit)) = foreign::decimal_comma(text, outline, fault.range.start) {
        fault.field.clone_from(&entry.path);
        fault.range = habit.range;
        fault.message = habit.message;
        fault.allowed = allowed(schema, &entry.path);
        fault.proposal = Some((habit.suggestion, foreign::comma_note(&text[fault.range.clone()])));
        return;
    }
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
        fault.suggestion = hint(text, fault.range.start).to_owned();
        return;
    };
    let value = &text[entry.value.clone()];
    let kind = schema.kind(&entry.path);
    fault.field.clone_from(&entry.path);
    fault.range = entry.value.clone();
    let is_count = matches!(kind, Kind::Count | Kind::OptionalCount);
    let too_large = is_count && value.bytes().all(|b| b.is_ascii_digit());
    let not = if too_large { "too large".to_owned() } else { format!("not {}", kind.words()) };
    fault.message = format!("`{}` is `{}`, which is {not}", entry.path, shown(value));
    fault.allowed = allowed(schema, &entry.path);
    let word = value.trim_matches('"');
    let is_word = kind == Kind::Word && words_of(schema, &entry.path).is_some_and(|all| all.contains(&word));
    let reads = |value: &str| {
        let text = schema.text_with(&entry.path, value);
        text.is_some_and(|text| dialect().from_str::<Scene>(&text).is_ok())
    };
    let ways = [
        (format!("{word}()"), "with brackets for its fields"),
        (format!("{word}(1)"), "with its number"),
        (word.to_owned(), "without quotes"),
    ];
    fault.proposal = ways
        .into_iter()
        .find(|(written, _)| is_word && written != value && (written == word || reads(written)))
        .or_else(|| of_bearing(&entry.path, word))
        .or_else(|| proposal(value, kind))
        .or_else(|| schema.plain_default(&entry.path).map(|default| (default.to_owned(), "the default")));
}

/// A bearing of the catalogue by its name, which is written in quotes.
fn of_bearing(path: &str, word: &str) -> Option<(String, &'static str)> {
    let known = CatalogueBearing::parse(word).ok().filter(|_| path == "bearing")?;
    Some((format!("\"{}\"", known.name), "the name of a bearing of the catalogue, in quotes"))
}

/// Accepted values of `path`: its range or its words.
fn allowed(schema: &Schema, path: &str) -> String {
    let kind = schema.kind(path);
    match kind {
        Kind::Word => words_of(schema, path).map_or_else(|| kind.words().to_owned(), list),
        _ => match limits::allowed(path) {
            Some(range) => format!("{}, {range}", kind.words()),
            None => kind.words().to_owned(),
        },
    }
}

/// The words that `path` takes: serde lists the variants when given an unknown one.
fn words_of(schema: &Schema, path: &str) -> Option<&'static [&'static str]> {
    match dialect().from_str::<Scene>(&schema.text_with(path, "no_such_word")?).err()?.code {
        ron::Error::NoSuchEnumVariant { expected, .. } => Some(expected),
        _ => None,
    }
}

/// The value that was probably meant by one of the wrong type.
fn proposal(value: &str, kind: Kind) -> Option<(String, &'static str)> {
    let bare = value.trim_matches('"');
    let is_number = |text: &str| text.parse::<f64>().is_ok_and(f64::is_finite);
    match kind {
        Kind::OptionalCount | Kind::OptionalGroup if bare.eq_ignore_ascii_case("none") => {
            Some(("None".to_owned(), "with a capital letter"))
        }
        Kind::Number if bare != value && is_number(bare) => Some((bare.to_owned(), "without quotes")),
        Kind::Count | Kind::OptionalCount if bare.parse::<u32>().is_ok() => {
            Some((bare.to_owned(), "without quotes"))
        }
        Kind::Count | Kind::OptionalCount => {
            let count = bare.parse::<f64>().ok().filter(|count| (1.0..1e6).contains(count))?;
            Some((number(count.round()), "rounded"))
        }
        Kind::Text if bare.chars().all(|c| c.is_ascii_alphanumeric() || c == '_') && !bare.is_empty() => {
            Some((format!("\"{bare}\""), "in quotes"))
        }
        _ => None,
    }
}

/// Hint on the place where RON stopped.
fn hint(text: &str, at: usize) -> &'static str {
    let before = text[..at].trim_end();
    let rest = text[at..].trim_start();
    let next = rest.trim_start_matches(|c: char| c.is_ascii_alphanumeric() || "_ ".contains(c));
    if rest.starts_with('{') || before.ends_with('{') {
        "a group stands in round brackets: `( … )`"
    } else if rest.starts_with('=') || next.starts_with('=') {
        "a value follows a colon: `name: value`"
    } else if rest.starts_with('"') && !before.ends_with(':') {
        "names of fields are written without quotes: `name: value`"
    } else if rest.starts_with('#') {
        "`//` begins a comment"
    } else if rest.starts_with('(') && before.ends_with("Some(") {
        "leave `Some` out: `name: ( … )`"
    } else {
        "look for a missing comma, bracket or quote near the mark"
    }
}
