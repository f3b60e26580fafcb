//! `SHA256SUMS` of a data set, which `sha256sum --check` reads.

use std::fmt::Write;
use std::fs::File;
use std::path::Path;

use anyhow::Result;
use sha2::{Digest, Sha256};

pub(super) const CHECKSUMS: &str = "SHA256SUMS";

/// A line for each of these files in a folder.
pub(super) fn text(folder: &Path, files: &[String]) -> Result<String> {
    let mut lines = String::new();
    for name in files {
        writeln!(lines, "{}  {name}", of_file(&folder.join(name))?)?;
    }
    Ok(lines)
}

fn of_file(path: &Path) -> Result<String> {
    let mut file = File::open(path)?;
    let mut hash = Sha256::new();
    std::io::copy(&mut file, &mut hash)?;
    Ok(hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect())
}

#[cfg(test)]
mod tests {
    use stribeck_testing::Scratch;

    use super::*;

    /// Source: the digest of "abc" in FIPS 180-4 (2015), as `sha256sum` prints it.
    #[test]
    fn peer_the_lines_are_those_of_sha256sum() {
        let folder = Scratch::create("checksums");
        std::fs::write(folder.join("a.parquet"), "abc").expect("a file");
        let line = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad  a.parquet\n";
        assert_eq!(text(folder.path(), &["a.parquet".to_owned()]).expect("a digest"), line);
    }
}
