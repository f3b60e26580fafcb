//! From a RON file to a checked [`Scene`], and back.
//!
//! Reading is strict: an unknown field, a wrong type, a number outside its range or bodies that cannot exist are errors
//! that show the line, the field, the value, what is allowed and what to try. Missing fields take their defaults, which
//! [`Scene::to_ron`] writes out again, so a run always holds the complete scene.

mod geometry;
mod limits;
mod origin;
mod outline;
mod overrides;
mod problem;
mod suggest;
mod syntax;

use std::path::Path;

use ron::extensions::Extensions;
use ron::ser::PrettyConfig;

use crate::scene::Scene;
use origin::Origin;
pub use problem::{Place, Problem, SceneError};

/// A scene file holds some fifty numbers; a megabyte is something else.
const MAX_BYTES: u64 = 1 << 20;

/// The dialect of scene files: `cage: (…)` means `cage: Some((…))`.
fn dialect() -> ron::Options {
    let extensions =
        Extensions::IMPLICIT_SOME | Extensions::UNWRAP_NEWTYPES | Extensions::UNWRAP_VARIANT_NEWTYPES;
    ron::Options::default().with_default_extension(extensions)
}

impl Scene {
    /// Reads and checks the scene file at `path`.
    ///
    /// # Errors
    ///
    /// [`SceneError`] when the file cannot be read, is no scene, or describes an impossible one.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, SceneError> {
        Self::read_with(path, &[] as &[&str])
    }

    /// Reads the scene file at `path`, applies `overrides` (`field.path=value`, in order), then checks the result.
    ///
    /// The check comes last, so an override may repair a file. Its values are RON: `mesh.size_mm=1.0`, `cage=None`,
    /// `contact.method=collocated`, `output.sensors[0].angle_deg=30`.
    ///
    /// # Errors
    ///
    /// As [`Scene::read`]; an error in an override points at the command line.
    pub fn read_with<S: AsRef<str>>(path: impl AsRef<Path>, overrides: &[S]) -> Result<Self, SceneError> {
        let path = path.as_ref();
        let text = load(path)?;
        compose(&text, &path.display().to_string(), overrides)
    }

    /// Checks the scene in `text`; `file_name` is what errors call it.
    ///
    /// # Errors
    ///
    /// As [`Scene::read`].
    pub fn parse(text: &str, file_name: &str) -> Result<Self, SceneError> {
        compose(text, file_name, &[] as &[&str])
    }

    /// This scene with `overrides` applied, checked. The syntax is that of [`Scene::read_with`].
    ///
    /// # Errors
    ///
    /// As [`Scene::read_with`].
    pub fn with_overrides<S: AsRef<str>>(&self, overrides: &[S]) -> Result<Self, SceneError> {
        let (scene, set) = overrides::apply(self.clone(), overrides)?;
        check(&scene, &Origin::in_memory(set))?;
        Ok(scene)
    }

    /// Checks a scene that was built in memory.
    ///
    /// # Errors
    ///
    /// [`SceneError`] with every number outside its range, or every geometric impossibility.
    pub fn validate(&self) -> Result<(), SceneError> {
        check(self, &Origin::in_memory(Vec::new()))
    }

    /// The complete scene, every default included, as a scene file that reads back to an equal scene.
    pub fn to_ron(&self) -> String {
        let pretty = PrettyConfig::new().indentor("    ").new_line("\n");
        // The structs hold only text, numbers and lists, which RON can always write.
        let body = dialect().to_string_pretty(self, pretty).unwrap_or_default();
        body + "\n"
    }

    /// Name of the scene's content: FNV-1a, 64 bits, of [`Scene::to_ron`], 16 hexadecimal digits.
    ///
    /// Two files with the same fields have the same hash, whatever their comments and omitted defaults. A field that came
    /// after the first scenes counts where it is used: their hashes stay, and so do their runs and checkpoints.
    pub fn hash(&self) -> String {
        const LATER: [&str; 1] = ["stiffness_damping_ns: 0.0,"];
        const OFFSET_BASIS: u64 = 0xcbf2_9ce4_8422_2325;
        const PRIME: u64 = 0x0000_0100_0000_01b3;
        let fold = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(PRIME);
        let text = self.to_ron();
        let lines = text.split_inclusive('\n').filter(|line| !LATER.contains(&line.trim()));
        format!("{:016x}", lines.flat_map(str::bytes).fold(OFFSET_BASIS, fold))
    }
}

/// Text → scene, overrides, check.
fn compose<S: AsRef<str>>(text: &str, file: &str, overrides: &[S]) -> Result<Scene, SceneError> {
    // Some editors put a byte order mark in front; RON knows none.
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let scene = syntax::parse(text, file)?;
    let (scene, set) = overrides::apply(scene, overrides)?;
    check(&scene, &Origin::in_file(file, text, set))?;
    Ok(scene)
}

/// Ranges first; geometry only of numbers that are in range.
fn check(scene: &Scene, origin: &Origin<'_>) -> Result<(), SceneError> {
    for findings in [limits::findings, geometry::findings] {
        let problems: Vec<Problem> = findings(scene).into_iter().map(|found| origin.problem(found)).collect();
        if !problems.is_empty() {
            return Err(SceneError::new(problems));
        }
    }
    Ok(())
}

/// What to do about a file that the system does not give.
fn advice(refusal: std::io::ErrorKind) -> &'static str {
    match refusal {
        std::io::ErrorKind::PermissionDenied => "you may not read it: ask its owner, or `chmod +r` it",
        _ => "check the path; `fixtures/scenes/` holds examples",
    }
}

/// The text of a scene file, refused when it cannot be one.
fn load(path: &Path) -> Result<String, SceneError> {
    let shown = path.display();
    let fail = |message: String, suggestion: &str| problem::whole_file(path, message, suggestion);
    let cannot = |e: std::io::Error| fail(format!("cannot read scene `{shown}`: {e}"), advice(e.kind()));
    let about = std::fs::metadata(path).map_err(cannot)?;
    if about.is_dir() {
        return Err(fail(
            format!("`{shown}` is a folder, not a scene file"),
            "name the `.ron` file inside it",
        ));
    }
    // Reading stops one byte past the limit, so that a device or a growing file cannot fill the memory.
    let file = std::fs::File::open(path).map_err(cannot)?;
    let mut bytes = Vec::new();
    std::io::Read::read_to_end(&mut std::io::Read::take(file, MAX_BYTES + 1), &mut bytes).map_err(cannot)?;
    if bytes.len() as u64 > MAX_BYTES {
        let message = format!("`{shown}` is larger than {MAX_BYTES} bytes, the limit for a scene");
        return Err(fail(message, "a scene is a short text; is this another kind of file?"));
    }
    let binary = |at: usize| {
        let message = format!("`{shown}` is not text: byte {at} is not UTF-8 or is a control character");
        fail(message, "a scene is a RON text; is this another kind of file?")
    };
    let text = String::from_utf8(bytes).map_err(|e| binary(e.utf8_error().valid_up_to()))?;
    match text.bytes().position(|b| b < b' ' && !b"\n\r\t".contains(&b)) {
        Some(at) => Err(binary(at)),
        None => Ok(text),
    }
}

#[cfg(test)]
mod tests;
