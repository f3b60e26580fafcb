//! From a RON file to a checked [`Scene`], and back.
//!
//! Reading is strict: an unknown field, a wrong type, a number outside its range or bodies that cannot exist
//! are errors that show the line, the field, the value, the allowed ones and a remedy. Missing fields take
//! their defaults, which [`Scene::to_ron`] writes out again, so a run always holds the complete scene.

mod check;
mod deviations;
mod dialect;
mod exclusions;
mod extent;
mod finding;
mod foreign;
mod geometry;
mod limits;
mod load;
mod named;
mod operation;
mod origin;
mod outline;
mod overrides;
mod own;
mod problem;
mod reference;
mod ring_meshes;
mod schema;
mod suggest;
mod syntax;
mod table;
mod wording;

use std::path::Path;

use crate::scene::Scene;
use check::{check, numbers_are_in_range};
pub use dialect::dialect;
use load::load;
use origin::Origin;
pub use outline::{Entry, Outline};
pub use problem::{Place, Problem, SceneError, offset, place_in_file};
pub use reference::{Field, FieldReference};
pub use suggest::nearest;
pub use wording::{list, shown};

impl Scene {
    /// Reads and checks the scene file at `path`.
    ///
    /// # Errors
    ///
    /// [`SceneError`] when the file cannot be read, is no scene, or describes an impossible one.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, SceneError> {
        Self::read_with(path, &[] as &[&str])
    }

    /// Reads the scene file at `path`, applies `overrides` (`field.path=value`, in order), then checks the
    /// result.
    ///
    /// The check comes last, so an override may repair a file. Its values are RON: `mesh.size_mm=1.0`,
    /// `cage=None`, `contact.method=collocated`, `output.sensors[0].angle_deg=30`.
    ///
    /// # Errors
    ///
    /// As [`Scene::read`]; an error in an override points at the command line.
    pub fn read_with<S: AsRef<str>>(path: impl AsRef<Path>, overrides: &[S]) -> Result<Self, SceneError> {
        let path = path.as_ref();
        let text = load(path)?;
        let folder = path.parent().unwrap_or(Path::new(""));
        compose(&text, &path.display().to_string(), folder, overrides)
    }

    /// Checks the scene in `text`; `file_name` is what errors call it. Tables of the scene are looked for
    /// from the present folder.
    ///
    /// # Errors
    ///
    /// As [`Scene::read`].
    pub fn parse(text: &str, file_name: &str) -> Result<Self, SceneError> {
        compose(text, file_name, Path::new(""), &[] as &[&str])
    }

    /// This scene with `overrides` applied, checked. The syntax is that of [`Scene::read_with`]; tables are
    /// looked for from the present folder.
    ///
    /// # Errors
    ///
    /// As [`Scene::read_with`].
    pub fn with_overrides<S: AsRef<str>>(&self, overrides: &[S]) -> Result<Self, SceneError> {
        let (scene, set) = overrides::apply(self.clone(), overrides)?;
        let is_papers = own::is_papers(&self.bearing) && !names_bearing(overrides);
        let understood = complete(scene, set, is_papers.then(|| named::written_by(overrides)));
        understood.check("", "", Path::new(""))
    }

    /// Checks a scene that was built in memory.
    ///
    /// # Errors
    ///
    /// [`SceneError`] with every number outside its range, or every geometric impossibility.
    pub fn validate(&self) -> Result<(), SceneError> {
        check(self, &Origin::in_memory(Vec::new()), None)
    }
}

/// A field of a scene file that the name of another bearing has replaced.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Replaced {
    /// Dotted path.
    pub field: String,
    /// Value in the file.
    pub written: String,
    /// Value in the scene.
    pub now: String,
}

/// Fields of the scene file at `path` that `bearing=NAME` among `overrides` replaces: with another bearing
/// than the file's its surroundings change, except fields that further overrides set. Empty where the scene
/// cannot be read.
pub fn replaced_by_bearing<S: AsRef<str>>(path: &Path, overrides: &[S]) -> Vec<Replaced> {
    let is_bearing = |text: &&str| text.split('=').next().is_some_and(|path| path.trim() == "bearing");
    let all: Vec<&str> = overrides.iter().map(AsRef::as_ref).collect();
    let others: Vec<&str> = all.iter().copied().filter(|text| !is_bearing(text)).collect();
    let Some(text) = load(path).ok().filter(|_| others.len() < all.len()) else { return Vec::new() };
    let (text, file) = (without_mark(&text), path.display().to_string());
    let complete = |overrides: &[&str]| Some(understand(text, &file, overrides).ok()?.scene.to_ron());
    let (Some(before), Some(after)) = (complete(&others), complete(&all)) else { return Vec::new() };
    let [in_file, there] = [&before, &after].map(|text| Outline::of(text));
    let value = |text: &str, outline: &Outline, field: &str| {
        outline.get(field).map(|entry| text[entry.value.clone()].to_owned())
    };
    let fields = named::written(text).into_iter().filter(|field| !field.starts_with("bearing"));
    fields
        .filter_map(|field| {
            let (written, now) = (value(&before, &in_file, &field)?, value(&after, &there, &field)?);
            let group = written.contains(['(', '[']);
            (written != now && !group).then_some(Replaced { field, written, now })
        })
        .collect()
}

/// The error `message` on `field` of the scene file at `path`, or of the paper's scene, under `overrides`,
/// shown where the field was written. For mistakes found after reading, as in the meshes that a scene names.
pub fn refused_at<S: AsRef<str>>(
    path: Option<&Path>,
    overrides: &[S],
    field: &str,
    message: String,
) -> SceneError {
    let text = path.and_then(|path| load(path).ok()).unwrap_or_default();
    let file = path.map_or_else(String::new, |path| path.display().to_string());
    let text = without_mark(&text);
    let set = match understand(text, &file, overrides) {
        Ok(understood) if path.is_some() => understood.set,
        _ => overrides::apply(Scene::singh2014(), overrides).map_or_else(|_| Vec::new(), |(_, set)| set),
    };
    let mut problem = Problem::new(message, Origin::in_file(&file, text, set).place(field));
    field.clone_into(&mut problem.field);
    problem.into()
}

/// Text → scene, overrides, tables in `folder`, check.
fn compose<S: AsRef<str>>(
    text: &str,
    file: &str,
    folder: &Path,
    overrides: &[S],
) -> Result<Scene, SceneError> {
    let text = without_mark(text);
    understand(text, file, overrides)?.check(file, text, folder)
}

/// A scene as it was read, before its meaning is checked.
struct Understood {
    scene: Scene,
    set: Vec<origin::Override>,
    /// Why the fields of its bearing do not define one.
    refusal: Option<Box<own::Refusal>>,
    /// Where its fields were to be completed and define a bearing.
    written: Option<own::Written>,
}

impl Understood {
    /// The scene with its tables in `folder`, if it can be. `text` is that of `file`.
    fn check(self, file: &str, text: &str, folder: &Path) -> Result<Scene, SceneError> {
        let Self { mut scene, set, refusal, written } = self;
        let origin = Origin::in_file(file, text, set);
        table::read(&mut scene, folder, &origin)?;
        if let Some(refusal) = refusal.as_ref().filter(|refusal| refusal.is_of_another()) {
            return Err(refusal.problem(&origin).into());
        }
        match (check(&scene, &origin, written.as_ref()), refusal) {
            (checked, None) => checked.map(|()| scene),
            (Ok(()), Some(refusal)) => Err(refusal.problem(&origin).into()),
            (Err(error), Some(refusal)) => {
                let problem = refusal.problem(&origin);
                if numbers_are_in_range(&scene) {
                    Err(error.about_bearing(&refusal.hint(), problem))
                } else {
                    // Main dimensions are in range, or there would be no refusal.
                    Err(error.and(problem))
                }
            }
        }
    }
}

/// The scene with a bearing of its own completed. `given` has the paths of the fields written by the user;
/// `None` where its bearing is another one already.
fn complete(mut scene: Scene, set: Vec<origin::Override>, given: Option<Vec<String>>) -> Understood {
    let written = given.map(|given| own::Written { scene: scene.clone(), given });
    let own = written.as_ref().map(|written| own::complete(&mut scene, &written.given));
    let refusal = match own {
        Some(own::Own::Refused(refusal)) => Some(refusal),
        _ => None,
    };
    let written = written.filter(|_| refusal.is_none());
    Understood { scene, set, refusal, written }
}

/// Whether one of `overrides` is the name of a bearing.
fn names_bearing<S: AsRef<str>>(overrides: &[S]) -> bool {
    overrides.iter().filter_map(|text| text.as_ref().split_once('=')).any(|(path, value)| {
        path.trim() == "bearing" && (!value.contains('(') || named::designation(value).is_some())
    })
}

/// Some editors write a byte order mark first, which RON does not accept.
pub fn without_mark(text: &str) -> &str {
    text.strip_prefix('\u{feff}').unwrap_or(text)
}

/// Text → scene, overrides.
fn understand<S: AsRef<str>>(text: &str, file: &str, overrides: &[S]) -> Result<Understood, SceneError> {
    let outline = Outline::of(text);
    let in_file = named::take(text, &outline);
    let mut scene = syntax::parse(in_file.as_ref().map_or(text, |(blanked, _)| blanked), text, file)?;
    let mut given = named::written(text);
    given.extend(named::written_by(overrides));
    if let Some((_, name)) = &in_file {
        named::put(&mut scene, name, &given).map_err(|why| {
            let place = outline.get("bearing").map(|entry| place_in_file(file, text, entry.value.clone()));
            unknown_bearing(why, place.unwrap_or(Place::Unwritten { file: file.to_owned() }))
        })?;
    }
    let has_name = in_file.is_some() || names_bearing(overrides);
    let (scene, set) = overrides::apply(scene, overrides)?;
    Ok(complete(scene, set, (!has_name).then_some(given)))
}

/// Whether the scene file at `path`, or the paper's scene, can be read with `overrides`. Errors that further
/// overrides may repair are not checked: numbers outside their range, bodies that cannot exist, tables that
/// are not there.
pub fn readable<S: AsRef<str>>(path: Option<&Path>, overrides: &[S]) -> Result<(), SceneError> {
    match path {
        Some(path) => {
            understand(without_mark(&load(path)?), &path.display().to_string(), overrides).map(drop)
        }
        None => overrides::apply(Scene::singh2014(), overrides).map(drop),
    }
}

/// Those of `overrides` whose value cannot be read as one of its field, with their numbers; none where the
/// scene that they are for cannot be read itself.
pub fn unreadable_values<S: AsRef<str>>(path: Option<&Path>, overrides: &[S]) -> Vec<(usize, Problem)> {
    let scene = match path {
        Some(path) => load(path).and_then(|text| {
            let nothing: &[&str] = &[];
            Ok(understand(without_mark(&text), &path.display().to_string(), nothing)?.scene)
        }),
        None => Ok(Scene::singh2014()),
    };
    scene.map_or_else(|_| Vec::new(), |scene| overrides::unreadable_values(scene, overrides))
}

/// The error on a field name that no scene has; `None` for one that some scene has.
pub fn unknown_field(path: &str) -> Option<Problem> {
    let schema = schema::Schema::get();
    let known = schema.default_of(path).is_some();
    let answer = || overrides::known(path, path, schema, "", &Outline::default()).err();
    if known { None } else { answer().map(|problem| *problem) }
}

/// Whether the field at a path is a whole number.
pub fn is_count(path: &str) -> bool {
    matches!(schema::Schema::get().kind(path), schema::Kind::Count | schema::Kind::OptionalCount)
}

/// The error on a designation that yields no bearing.
pub(crate) fn unknown_bearing(why: String, place: Place) -> Problem {
    let mut problem = Problem::new(why, place);
    "bearing".clone_into(&mut problem.field);
    problem
}

#[cfg(test)]
mod tests;
