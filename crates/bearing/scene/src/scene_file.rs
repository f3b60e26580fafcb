//! From a RON file to a checked [`Scene`], and back.
//!
//! Reading is strict: an unknown field, a wrong type, a number outside its range or bodies that cannot exist
//! are errors that show the line, the field, the value, the allowed ones and a remedy. Missing fields take
//! their defaults, which [`Scene::to_ron`] writes out again, so a run always holds the complete scene.

mod deviations;
mod dialect;
mod exclusions;
mod extent;
mod geometry;
mod named;
mod names;
mod operation;
mod overrides;
mod own;
mod ring_meshes;
mod table;

use std::path::Path;

pub use crate::field::wording::{list, shown};
use crate::fields::tree::Node;
use crate::fields::value::Value;
use crate::fields::{Spot, spot};
use crate::reading::faults;
use crate::reading::finding::Finding;
use crate::reading::load::load;
use crate::reading::problem::MOST_TOLD;
use crate::reading::sources::{SCENE, Sources};
pub use crate::reading::{
    Kind, Place, Problem, SceneError, nearest, offset, place_in_file, read_as, without_mark,
};
use crate::scene::Scene;
use overrides::written_by;

/// Paths of fields that several checks name.
const OUTER_RING_MESH: &str = "outer_ring_mesh";
const INNER_RING_MESH: &str = "inner_ring_mesh";
const SPEED_PROFILE: &str = "operation.speed_profile";
const OUTER_SPEED_PROFILE: &str = "operation.outer_speed_profile";
const LOAD_PROFILE: &str = "operation.load_profile";

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
    pub fn parse(text: &str, file_name: &str) -> Result<Self, SceneError> {
        compose(text, file_name, Path::new(""), &[] as &[&str])
    }

    /// This scene with `overrides` applied, checked. The syntax is that of [`Scene::read_with`]; tables are
    /// looked for from the present folder.
    pub fn with_overrides<S: AsRef<str>>(&self, overrides: &[S]) -> Result<Self, SceneError> {
        let mut sources = Sources::of_scene(self);
        sources.set_all(overrides)?;
        let is_papers = own::is_papers(&self.bearing) && !sources.is_named;
        complete(sources, is_papers.then(|| written_by(overrides)))?.check(Path::new(""))
    }

    /// Checks a scene that was built in memory.
    ///
    /// # Errors
    ///
    /// [`SceneError`] with every number outside its range, or every geometric impossibility.
    pub fn validate(&self) -> Result<(), SceneError> {
        check(self, &Sources::of_scene(self))
    }
}

/// Refuses a scene with a number outside its range, or with bodies or demands that are impossible.
fn check(scene: &Scene, sources: &Sources) -> Result<(), SceneError> {
    let found = findings(scene);
    if found.is_empty() {
        return Ok(());
    }
    Err(SceneError::new(found.into_iter().take(MOST_TOLD).map(|finding| sources.problem(finding)).collect()))
}

/// Relations only of numbers that are in range.
fn findings(scene: &Scene) -> Vec<Finding> {
    let found = names::findings(scene);
    if !found.is_empty() {
        return found;
    }
    let rules = [
        geometry::findings,
        deviations::findings,
        extent::findings,
        exclusions::findings,
        operation::findings,
        ring_meshes::findings,
    ];
    rules.iter().flat_map(|findings| findings(scene)).collect()
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
    let scene = |overrides: &[&str]| Some(understand(text, &file, overrides).ok()?.scene);
    let (Some(before), Some(after)) = (scene(&others), scene(&all)) else { return Vec::new() };
    let in_file = crate::fields::tree::parse(text).map_or_else(|_| Vec::new(), |tree| paths_in(&tree));
    crate::fields::differences(&[Some(&before), Some(&after)])
        .into_iter()
        .filter(|(field, _)| !field.starts_with("bearing") && in_file.contains(field))
        .filter_map(|(field, values)| match values.as_slice() {
            [Some(written), Some(now)] => {
                Some(Replaced { field, written: written.clone(), now: now.clone() })
            }
            _ => None,
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
    let sources = match understand(without_mark(&text), &file, overrides) {
        Ok(understood) if path.is_some() => understood.sources,
        _ => {
            let mut sources = Sources::of_scene(&Scene::singh2014());
            // A scene that could be read before.
            let _ = sources.set_all(overrides);
            sources
        }
    };
    let mut problem = Problem::new(message, sources.place(field));
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
    understand(without_mark(text), file, overrides)?.check(folder)
}

/// A scene as it was read, before its meaning is checked.
struct Understood {
    scene: Scene,
    sources: Sources,
    /// Why the fields of its bearing do not define one.
    refusal: Option<Box<Problem>>,
}

impl Understood {
    /// The scene with its tables in `folder`, if it can be.
    fn check(self, folder: &Path) -> Result<Scene, SceneError> {
        let Self { mut scene, sources, refusal } = self;
        table::read(&mut scene, folder, &sources)?;
        match refusal {
            Some(problem) => Err(problem.into()),
            None => check(&scene, &sources).map(|()| scene),
        }
    }
}

/// The scene with a bearing of its own completed. `given` has the paths of the fields written by the user;
/// `None` where its bearing is another one already.
fn complete(sources: Sources, given: Option<Vec<String>>) -> Result<Understood, SceneError> {
    let mut scene = scene_of(&sources)?;
    let refusal = given.and_then(|given| own::complete(&mut scene, &given, &sources).err());
    Ok(Understood { scene, sources, refusal })
}

/// The values of a tree that the table allows.
fn scene_of(sources: &Sources) -> Result<Scene, SceneError> {
    let too_large = "a number of this scene is too large for this computer";
    sources.scene().ok_or_else(|| Problem::new(too_large, sources.place("")).into())
}

/// Paths of all fields in a tree.
fn paths_in(tree: &Node) -> Vec<String> {
    tree.entries("").into_iter().map(|(path, ..)| path).collect()
}

fn understand<S: AsRef<str>>(text: &str, file: &str, overrides: &[S]) -> Result<Understood, SceneError> {
    let mut sources = Sources::of_text(text, file, &SCENE)?;
    sources.accept_words_of_catalogues();
    let mut given = paths_in(&sources.tree);
    given.extend(written_by(overrides));
    let name = sources.tree.get("bearing").and_then(String::read).filter(|name| !name.contains('"'));
    if name.is_some() {
        sources.open("bearing");
    }
    let found = faults(&sources.tree, Spot::ROOT, "", &sources);
    if !found.is_empty() {
        return Err(SceneError::new(found));
    }
    let mut scene = scene_of(&sources)?;
    named::as_stiff_as_hertz(&mut scene, &given);
    let name = name.or_else(|| named::alone(&scene.bearing, &given));
    if let Some(name) = &name {
        named::put(&mut scene, name, &given).map_err(|why| unknown_bearing(why, sources.place("bearing")))?;
    }
    scene.record_no_faster(&given);
    sources.take(&scene);
    sources.set_all(overrides)?;
    let has_name = name.is_some() || sources.is_named;
    complete(sources, (!has_name).then_some(given))
}

/// Whether the scene file at `path`, or the paper's scene, can be read with `overrides`. Errors that further
/// overrides may repair are not checked: numbers outside their range, bodies that cannot exist, tables that
/// are not there.
pub fn readable<S: AsRef<str>>(path: Option<&Path>, overrides: &[S]) -> Result<Scene, SceneError> {
    match path {
        Some(path) => {
            let text = load(path)?;
            Ok(understand(without_mark(&text), &path.display().to_string(), overrides)?.scene)
        }
        None => {
            let mut sources = Sources::of_scene(&Scene::singh2014());
            sources.set_all(overrides)?;
            scene_of(&sources)
        }
    }
}

/// The error on a field name that no scene has; `None` for one that some scene has.
pub fn unknown_field(path: &str) -> Option<Problem> {
    let nowhere = Place::Unwritten { file: String::new() };
    spot(path, None).is_none().then(|| overrides::unknown(path, nowhere))
}

/// The error on a designation that yields no bearing.
pub(crate) fn unknown_bearing(why: String, place: Place) -> Problem {
    let mut problem = Problem::new(why, place);
    "bearing".clone_into(&mut problem.field);
    problem
}

#[cfg(test)]
mod tests;
