//! Temporary folders.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

/// A folder of its own for a test, removed with all that is in it when this goes out of scope.
#[derive(Debug)]
pub struct Scratch(PathBuf);

impl Scratch {
    /// A path that ends in `name` and at which nothing is yet.
    pub fn new(name: &str) -> Self {
        static COUNT: AtomicUsize = AtomicUsize::new(0);
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let path = std::env::temp_dir().join(format!("stribeck-{}-{number}-{name}", std::process::id()));
        // An earlier process of the same number may have been killed.
        std::fs::remove_dir_all(&path).ok();
        Self(path)
    }

    /// An empty folder whose path ends in `name`.
    ///
    /// # Panics
    /// If it cannot be made.
    pub fn create(name: &str) -> Self {
        let scratch = Self::new(name);
        std::fs::create_dir_all(&scratch.0).expect("temporary folders can be made");
        scratch
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.0
    }

    /// Path of a file or folder in it.
    pub fn join(&self, name: impl AsRef<Path>) -> PathBuf {
        self.0.join(name)
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        std::fs::remove_dir_all(&self.0).ok();
    }
}

#[cfg(test)]
mod tests {
    use super::Scratch;

    #[test]
    fn behaves_a_folder_goes_with_what_is_in_it() {
        let (one, other) = (Scratch::new("x"), Scratch::create("x"));
        assert!(!one.path().exists() && one.path() != other.path());
        std::fs::write(other.join("file"), "text").expect("writable");
        let path = other.path().to_owned();
        drop(other);
        assert!(!path.exists());
    }
}
