//! `--set field.path=value`: writes one value into the text of the complete scene and reads that text again.
//!
//! Working on the text keeps RON's own rules for enums, options and numbers: an override means exactly what
//! the same words would mean in the file.

use super::limits::{LOAD_PROFILE, OUTER_SPEED_PROFILE, SPEED_PROFILE};
use super::origin::{Override, command_line};
use super::outline::{Outline, is_single_value};
use super::problem::{Place, Problem, SceneError};
use super::schema::Schema;
use super::syntax::deserialize;
use super::wording::{list, shown};
use super::{foreign, named, suggest};
use crate::catalogue::CatalogueBearing;
use crate::scene::Scene;

/// Applies `arguments` in order; the result is not yet checked for meaning.
pub(crate) fn apply<S: AsRef<str>>(
    mut scene: Scene,
    arguments: &[S],
) -> Result<(Scene, Vec<Override>), SceneError> {
    let schema = Schema::get();
    let mut set = Vec::with_capacity(arguments.len());
    let given = named::written_by(arguments);
    for argument in arguments {
        let (next, by) = apply_one(&scene, argument.as_ref(), schema, &given)?;
        scene = next;
        set.push(by);
    }
    Ok((scene, set))
}

/// Those of `arguments` whose value no reading of their field takes: words that are not its words, numbers of
/// another type, names of no bearing. The others are applied as far as they go, so each value meets the scene
/// that it is written for. Ranges and relations to other fields are not checked.
pub(crate) fn unreadable_values<S: AsRef<str>>(mut scene: Scene, arguments: &[S]) -> Vec<(usize, Problem)> {
    let schema = Schema::get();
    let given = named::written_by(arguments);
    let mut unreadable = Vec::new();
    for (index, argument) in arguments.iter().map(AsRef::as_ref).enumerate() {
        match apply_one(&scene, argument, schema, &given) {
            Ok((next, _)) => scene = next,
            Err(problem) if is_of_value(&scene, argument, schema) => unreadable.push((index, *problem)),
            Err(_) => {}
        }
    }
    unreadable
}

/// Whether an argument that the scene refuses names a field of it and no bearing that is known: its value is
/// to blame.
fn is_of_value(scene: &Scene, argument: &str, schema: &Schema) -> bool {
    let Some((path, value)) = argument.split_once('=') else { return false };
    let path = path.trim();
    let bearing = (path == "bearing").then(|| named::designation(value).or_else(|| bare_designation(value)));
    match bearing.flatten() {
        Some(name) => CatalogueBearing::parse(&name).is_err(),
        None => {
            let text = scene.to_ron();
            known(path, argument, schema, &text, &Outline::of(&text)).is_ok()
        }
    }
}

fn apply_one(
    scene: &Scene,
    argument: &str,
    schema: &Schema,
    given: &[String],
) -> Result<(Scene, Override), Box<Problem>> {
    let whole = command_line(argument, 0, argument.len());
    let Some((path, value)) = argument.split_once('=') else {
        let example = "write `--set field=value`, for example `--set mesh.size_mm=1.0`";
        return Err(refuse("", format!("`{}` has no `=`", shown(argument)), example.to_owned(), whole));
    };
    let path = path.trim();
    let text = scene.to_ron();
    let outline = Outline::of(&text);
    let by = Override { path: path.to_owned(), argument: argument.to_owned() };
    known(path, argument, schema, &text, &outline)?;

    if path == "bearing"
        && let Some(name) = named::designation(value).or_else(|| bare_designation(value))
    {
        // Another bearing than the file's: its surroundings follow, except fields on the command line.
        let mut scene = scene.clone();
        return match named::put(&mut scene, &name, given) {
            Ok(()) => Ok((scene, by)),
            Err(why) => Err(Box::new(super::unknown_bearing(why, by.place_of_value()))),
        };
    }
    let value = quoted(value.trim(), schema.default_of(path));
    if !is_single_value(&value) {
        return Err(incomplete(path, &value, schema, by.place_of_value()));
    }
    let text = write(&text, &outline, path, &value);
    match deserialize(&text) {
        Ok(mut scene) => {
            named::follow_bearing(&mut scene, path, given);
            Ok((scene, by))
        }
        Err(fault) => Err(Box::new(fault.problem(by.place_of_value()))),
    }
}

/// A designation without its quotes, which shells take away.
fn bare_designation(value: &str) -> Option<String> {
    let value = value.trim();
    (!value.is_empty() && !value.contains(['(', ')', '"'])).then(|| value.to_owned())
}

/// Refuses a value that is not one value: a bracket is missing, or something follows.
fn incomplete(path: &str, value: &str, schema: &Schema, place: Place) -> Box<Problem> {
    let mut problem = Problem::new("", place);
    problem.field = path.to_owned();
    if foreign::comma_number(value) == Some(value.len()) {
        problem.message = format!("`{path}` is given `{}`, with a decimal comma", shown(value));
        problem.propose(path, &foreign::with_point(value), foreign::comma_note(value));
        return Box::new(problem);
    }
    problem.message = match value {
        "" => format!("`{path}` is given no value"),
        _ => format!("`{path}` is given `{}`, which is not one complete value", shown(value)),
    };
    match schema.plain_default(path) {
        Some(default) => problem.propose(path, default, "the default"),
        None => problem.suggestion = format!("`{path}` takes {}", schema.kind(path).words()),
    }
    Box::new(problem)
}

/// Refuses a path that no scene has.
pub(crate) fn known(
    path: &str,
    argument: &str,
    schema: &Schema,
    text: &str,
    outline: &Outline,
) -> Result<(), Box<Problem>> {
    let mark = command_line(argument, 0, argument.find('=').unwrap_or(argument.len()));
    if schema.default_of(path).is_some() && (outline.get(path).is_some() || !path.contains('[')) {
        return Ok(());
    }
    if absent_in_its_form(path, schema, text, outline) {
        return Ok(());
    }
    if let Some((list, _)) = path.split_once('[')
        && schema.default_of(path).is_some()
    {
        let count = (0..).take_while(|i| outline.get(&format!("{list}[{i}]")).is_some()).count();
        let message = format!("`{path}` does not exist: `{list}` has {count} items, numbered from 0");
        let all = format!("give the whole list: `{list}=[ … ]`");
        return Err(refuse(path, message, all, mark));
    }
    // The longest prefix that exists is the section; the rest is the unknown name.
    let mut section = path;
    while let Some((parent, _)) = section.rsplit_once('.') {
        section = parent;
        if !schema.names_in(section).is_empty() {
            break;
        }
    }
    if !path.contains('.') || schema.names_in(section).is_empty() {
        section = "";
    }
    let name = path.strip_prefix(section).unwrap_or(path).trim_start_matches('.');
    let siblings = schema.names_in(section);
    let full: Vec<&str> = schema.paths();
    let leaf = path.rsplit_once('.').map_or(path, |(_, leaf)| leaf);
    let named = |p: &&&str| p.rsplit_once('.').is_some_and(|(_, name)| suggest::same_quantity(name, leaf));
    let suggestion = match full.iter().find(named) {
        // Right name, wrong section or none: the most common slip. A slip of the unit deserves the factor.
        Some(home) if !home.starts_with(&format!("{section}.")) => Some(format!("did you mean `{home}`?")),
        _ => match suggest::nearest(path, &full).filter(|near| near.contains('.')) {
            Some(near) if section.is_empty() => Some(format!("did you mean `{near}`?")),
            _ => suggest::field(name, &siblings, &full).map(|words| with_section(words, section, &siblings)),
        },
    };
    let message = match path {
        "" => "the name of a field is missing in front of `=`".to_owned(),
        _ => format!("no field `{}` in a scene", shown(path)),
    };
    let mut problem = refuse(path, message, suggestion.unwrap_or_default(), mark);
    problem.allowed = with_section(list(&siblings), section, &siblings);
    Err(problem)
}

/// Whether `path` is a field that an item of a list may have in the form that it has, and that its text
/// leaves out.
fn absent_in_its_form(path: &str, schema: &Schema, text: &str, outline: &Outline) -> bool {
    let form = || {
        let (group, name) = path.rsplit_once('.').filter(|(group, _)| group.contains('['))?;
        let (word, _) = text[outline.get(group)?.value.clone()].split_once('(')?;
        schema.behind(group, word, name)
    };
    form().is_some()
}

/// Writes the names in a text with their section, as `--set` takes them.
fn with_section(text: String, section: &str, names: &[&str]) -> String {
    if section.is_empty() {
        return text;
    }
    let full = |text: String, name: &&str| text.replace(&format!("`{name}`"), &format!("`{section}.{name}`"));
    names.iter().fold(text, full)
}

/// Quotes a bare word for a text field: the shell has already eaten the user's quotes.
fn quoted(value: &str, default: Option<&str>) -> String {
    let wants_text = default.is_some_and(|default| default.starts_with('"'));
    let is_quoted = ["\"", "r\"", "r#"].iter().any(|quote| value.starts_with(quote));
    if wants_text && !is_quoted {
        return format!("{value:?}");
    }
    value.to_owned()
}

/// The complete scene's text with `value` at `path`. A section that is `None` is opened first.
fn write(text: &str, outline: &Outline, path: &str, value: &str) -> String {
    if let Some(entry) = outline.get(path) {
        let (start, end) = (entry.value.start, entry.value.end);
        return format!("{}{value}{}", &text[..start], &text[end..]);
    }
    let group = |section: &str| {
        let value = outline.get(section)?.value.clone();
        // Behind the word of a form, where the form of an item of a list is not another one.
        let bracket = text[value.clone()].find('(')?;
        (bracket == 0 || section.contains('[')).then_some(value.start + bracket + 1)
    };
    match path.rsplit_once('.') {
        // A field that a section may lack beside others.
        Some((section, name)) if group(section).is_some() => {
            let inside = group(section).unwrap_or_default();
            format!("{}{name}: {value}, {}", &text[..inside], &text[inside..])
        }
        // A profile of another kind than the one that has such fields.
        Some((SPEED_PROFILE | OUTER_SPEED_PROFILE | LOAD_PROFILE, name)) => {
            let (section, kind) = (path.rsplit_once('.').map_or("", |(section, _)| section), kind_with(name));
            write(text, outline, section, &format!("{kind}({name}: {value})"))
        }
        // The other model than the one that has such fields is a word, not a group.
        Some(("model", name)) => write(text, outline, "model", &format!("reduced({name}: {value})")),
        // A housing of another form than the one that has such fields.
        Some((HOUSING, name)) => {
            write(text, outline, HOUSING, &format!("{}({name}: {value})", housing_with(name)))
        }
        Some((section, name)) => write(text, outline, section, &format!("({name}: {value})")),
        // A field that the scene lacks beside others.
        None => {
            let inside = text.find('(').map_or(0, |at| at + 1);
            format!("{}{path}: {value}, {}", &text[..inside], &text[inside..])
        }
    }
}

const HOUSING: &str = "housing";

/// The form of housing that has a field of this name.
fn housing_with(name: &str) -> &'static str {
    match name {
        "width_mm" | "base_mm" | "top_mm" => "pedestal",
        "stiffness_n_um" | "damping_n_s_m" => "springs",
        "mass_kg" => "rigid",
        _ => "mesh",
    }
}

/// The kind of profile that has a field of this name.
fn kind_with(name: &str) -> &'static str {
    if ["amplitude", "hz", "phase_deg"].contains(&name) { "harmonic" } else { "ramp" }
}

fn refuse(field: &str, message: String, suggestion: String, place: Place) -> Box<Problem> {
    let mut problem = Problem::new(message, place);
    problem.field = field.to_owned();
    problem.suggestion = suggestion;
    Box::new(problem)
}
