//! The text of a scene file, or the reason why it cannot be read.

use std::io::{ErrorKind, Read};
use std::path::Path;

use super::problem::{Place, Problem, SceneError};
use super::suggest;
use stribeck_theory::catalogue::CatalogueBearing;

/// A scene file holds some fifty numbers, and that of a run the mesh of a housing, too; more is something
/// else.
const MAX_BYTES: u64 = 8 << 20;

/// The text of the scene file at `path`, refused when it cannot be one.
pub(crate) fn load(path: &Path) -> Result<String, SceneError> {
    let shown = path.display();
    let unreadable = |error: std::io::Error| {
        let reason = reason(&error);
        refuse(path, format!("cannot read `{shown}`: {reason}"), advice(&error, path))
    };
    if std::fs::metadata(path).map_err(unreadable)?.is_dir() {
        return Err(refuse(path, format!("`{shown}` is a folder, not a scene file"), inside(path)));
    }
    // Reading stops one byte past the limit, so that a device or a growing file cannot fill the memory.
    let file = std::fs::File::open(path).map_err(unreadable)?;
    let mut bytes = Vec::new();
    file.take(MAX_BYTES + 1).read_to_end(&mut bytes).map_err(unreadable)?;
    if bytes.len() as u64 > MAX_BYTES {
        let message = format!("`{shown}` is larger than {MAX_BYTES} bytes, the limit for a scene");
        return Err(refuse(path, message, "name a scene file; a scene is a short text".to_owned()));
    }
    text(bytes).map_err(|NoText { message, suggestion }| {
        refuse(path, format!("`{shown}` {message}"), suggestion.to_owned())
    })
}

/// The operating system's error in words; its own text for rare ones.
fn reason(error: &std::io::Error) -> String {
    match error.kind() {
        ErrorKind::NotFound => "there is no such file".to_owned(),
        ErrorKind::PermissionDenied => "you are not permitted to read it".to_owned(),
        ErrorKind::NotADirectory => "a part of this path is a file, not a folder".to_owned(),
        _ => error.to_string(),
    }
}

/// Remedy for an error of the operating system.
fn advice(error: &std::io::Error, path: &Path) -> String {
    match error.kind() {
        ErrorKind::NotFound if names_a_bearing(path) => {
            format!("`stribeck new --bearing {}` writes a scene of this bearing", path.display())
        }
        ErrorKind::NotFound => match neighbour(path) {
            Some(near) => format!("did you mean `{near}`?"),
            None => "check the path, which counts from the present folder".to_owned(),
        },
        ErrorKind::PermissionDenied => {
            "`ls -l` shows who may read it, and `chmod` changes that for a file of your own; its folders \
             must be open to you, too"
                .to_owned()
        }
        ErrorKind::NotADirectory => "check the path".to_owned(),
        _ => "the path is right, but the system cannot read from it; try a copy of the file".to_owned(),
    }
}

/// Whether a path is the name of a bearing, such as 6205.
fn names_a_bearing(path: &Path) -> bool {
    path.to_str().is_some_and(|name| !name.ends_with(".ron") && CatalogueBearing::parse(name).is_ok())
}

/// The scene file beside `path` whose name is most like it.
fn neighbour(path: &Path) -> Option<String> {
    let name = path.file_name()?.to_str()?;
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let scenes = scenes_in(folder.unwrap_or(Path::new(".")));
    let names: Vec<&str> = scenes.iter().map(String::as_str).collect();
    let near = suggest::nearest(name, &names)?;
    Some(folder.map_or_else(|| near.to_owned(), |folder| folder.join(near).display().to_string()))
}

/// Message on a folder: a scene inside it.
fn inside(folder: &Path) -> String {
    match scenes_in(folder).first() {
        Some(scene) => format!("name the file inside it: `{}`", folder.join(scene).display()),
        None => "name a scene file; this folder holds no `.ron` file".to_owned(),
    }
}

/// Names of the scene files in a folder, sorted; none when it cannot be listed.
fn scenes_in(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let names = entries.filter_map(|entry| entry.file_name().into_string().ok());
    let mut names: Vec<String> = names.filter(|name| name.ends_with(".ron")).collect();
    names.sort();
    names
}

/// Why bytes are no text.
struct NoText {
    message: String,
    suggestion: &'static str,
}

fn text(bytes: Vec<u8>) -> Result<String, NoText> {
    let binary = |bytes: &[u8], at: usize| NoText {
        message: format!("is not a text file: byte {at} is 0x{:02x}", bytes.get(at).copied().unwrap_or(0)),
        suggestion: "name a scene file; this one holds something else",
    };
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        let message = "is written in UTF-16".to_owned();
        return Err(NoText { message, suggestion: "save it as UTF-8 in your editor" });
    }
    let control = bytes.iter().position(|b| *b < b' ' && !b"\n\r\t".contains(b));
    if let Some(at) = control {
        return Err(binary(&bytes, at));
    }
    String::from_utf8(bytes).map_err(|error| {
        let (at, bytes) = (error.utf8_error().valid_up_to(), error.as_bytes());
        let line = bytes[..at].iter().filter(|b| **b == b'\n').count() + 1;
        NoText {
            message: format!("is not UTF-8 text: byte 0x{:02x} in line {line}", bytes[at]),
            suggestion: "save it as UTF-8 in your editor, or remove accented letters",
        }
    })
}

/// A problem with the file as a whole.
fn refuse(path: &Path, message: String, suggestion: String) -> SceneError {
    let mut problem = Problem::new(message, Place::Unwritten { file: path.display().to_string() });
    problem.suggestion = suggestion;
    problem.into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn invariant_advice_fits_the_systems_answer() {
        let path = Path::new("no/such/folder/x.ron");
        for (kind, words) in [
            (ErrorKind::NotFound, "check the path"),
            (ErrorKind::PermissionDenied, "chmod"),
            (ErrorKind::NotADirectory, "check the path"),
            (ErrorKind::TimedOut, "a copy of the file"),
        ] {
            let error = std::io::Error::from(kind);
            assert!(advice(&error, path).contains(words), "{kind:?}");
            let of_bearing = advice(&error, Path::new("NU205")).contains("stribeck new --bearing NU205");
            assert_eq!(of_bearing, kind == ErrorKind::NotFound);
            assert_eq!(kind == ErrorKind::PermissionDenied, reason(&error).contains("not permitted"));
        }
    }
}
