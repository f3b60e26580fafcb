//! Output folders of commands that use runs and records: of a validation, a campaign, an analysis.

use std::path::Path;

use super::earlier::Earlier;
use super::{ENSEMBLE, INFO, UNTOUCHED, files, free_name, reservation};
use crate::error::Error;

/// Refuses an output folder unless it is missing, empty, or holds one of `marks`: names of files by which a
/// command recognises its own output, beside which other files may lie.
///
/// # Errors
///
/// [`Error::FolderHoldsRun`] when a run lies there; [`Error::ForeignFolder`] when it holds something else;
/// [`Error::Io`] when it cannot be read.
pub fn check_folder(path: &Path, marks: &[&str]) -> Result<(), Error> {
    if !path.exists() {
        return Ok(());
    }
    let holds = |names: &[&str]| names.iter().any(|name| path.join(name).exists());
    let begun = || holds(&[INFO, ENSEMBLE]).then(|| "a run without samples".to_owned());
    if let Some(found) = Earlier::of(path).map(|run| run.name()).or_else(begun) {
        let free = free_name(path);
        return Err(Error::FolderHoldsRun { path: path.to_owned(), found, ways: Vec::new(), free });
    }
    let names = reservation::visible(path).map_err(|e| files::cannot("read", path, UNTOUCHED, e))?;
    match names.into_iter().next().filter(|_| !holds(marks)) {
        Some(found) => Err(Error::ForeignFolder { path: path.to_owned(), found }),
        None => Ok(()),
    }
}
