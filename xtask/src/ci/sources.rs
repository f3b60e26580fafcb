//! Words that general crates must not use, and calls that libraries must not make.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};

use super::layers;

/// Crates that must be of use outside bearings.
const GENERAL: [&str; 9] =
    ["mesh", "simd", "solver", "surface", "contact", "system", "dsp", "formats", "infer"];
/// Words of bearings.
const WORDS: [&str; 5] = ["bearing", "roller", "raceway", "cage", "spall"];

/// Crates that may print and read the clock: the program, a module that others are written with, and what
/// tests share.
const LOUD: [&str; 3] = ["python", "stribeck", "testing"];
/// What prints or reads the clock.
const NOISES: [&str; 6] =
    ["print!(", "println!(", "eprint!(", "eprintln!(", "Instant::now(", "SystemTime::now("];

/// All Rust files below `folder`, sorted.
pub(crate) fn rust_files(folder: &Path) -> Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        let entries =
            std::fs::read_dir(&folder).with_context(|| format!("cannot read {}", folder.display()))?;
        for path in entries.flatten().map(|entry| entry.path()) {
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                found.push(path);
            }
        }
    }
    found.sort();
    Ok(found)
}

pub(crate) fn check_words(root: &Path) -> Result<Vec<String>> {
    let mut complaints = Vec::new();
    for name in GENERAL {
        for file in rust_files(&root.join("crates").join(name).join("src"))? {
            let text =
                std::fs::read_to_string(&file).with_context(|| format!("cannot read {}", file.display()))?;
            for (number, line) in text.lines().enumerate() {
                if let Some(word) = word_of_bearings(line) {
                    let file = file.strip_prefix(root).unwrap_or(&file).display();
                    complaints.push(format!("{file}:{}: `{word}` is a word of bearings", number + 1));
                }
            }
        }
    }
    Ok(complaints)
}

/// Libraries never print and never read the clock.
pub(crate) fn check_silence(root: &Path) -> Result<Vec<String>> {
    let mut complaints = Vec::new();
    for name in layers::crates(root)?.iter().filter(|name| !LOUD.contains(&name.as_str())) {
        for file in rust_files(&root.join("crates").join(name).join("src"))? {
            let text =
                std::fs::read_to_string(&file).with_context(|| format!("cannot read {}", file.display()))?;
            for (number, line) in text.lines().enumerate() {
                if let Some(noise) = noise(line) {
                    let file = file.strip_prefix(root).unwrap_or(&file).display();
                    complaints.push(format!("{file}:{}: `{noise}…)` in a library", number + 1));
                }
            }
        }
    }
    Ok(complaints)
}

/// The macro or function with which a line of code prints or reads the clock, comments apart.
fn noise(line: &str) -> Option<&'static str> {
    let code = line.split("//").next().unwrap_or_default();
    NOISES.into_iter().find(|noise| code.contains(noise))
}

/// The first word of bearings in a line, also as part of an identifier (`roller_count`, `CageBody`).
fn word_of_bearings(line: &str) -> Option<&'static str> {
    // A keyword of LS-DYNA.
    let line = line.replace("ELEMENT_BEARING", "");
    let mut spaced = String::with_capacity(line.len() + 8);
    for c in line.chars() {
        // A capital begins a new word, so that `BlockAge` is no cage.
        if c.is_uppercase() || !c.is_alphabetic() {
            spaced.push(' ');
        }
        if c.is_alphabetic() {
            spaced.extend(c.to_lowercase());
        }
    }
    // In `ROLLER` every letter would be a word of its own, so capitals are also looked at as they stand.
    let lower = line.to_lowercase();
    let words = spaced.split(' ').chain(lower.split(|c: char| !c.is_alphabetic()));
    let singular =
        |word: &str| WORDS.iter().copied().find(|w| *w == word || word.strip_suffix('s') == Some(*w));
    words.into_iter().find_map(singular)
}

#[cfg(test)]
mod tests {
    use super::{noise, word_of_bearings};

    #[test]
    fn behaves_words_are_found_in_prose_and_identifiers() {
        for line in [
            "the rollers turn",
            "a bearing's",
            "let roller_count = 1;",
            "struct CageBody;",
            "const ROLLER: f64",
            "Spalls!",
        ] {
            assert!(word_of_bearings(line).is_some(), "{line}");
        }
        for line in [
            "a package",
            "the controller",
            "let blockage = 1;",
            "BlockAge",
            "scrollers",
            "race way",
            "\"ELEMENT_BEARING\",",
        ] {
            assert_eq!(word_of_bearings(line), None, "{line}");
        }
    }

    #[test]
    fn behaves_what_prints_or_asks_the_clock_is_found() {
        for line in ["    println!(\"x\");", "let t = std::time::Instant::now();", "eprint!(\"x\"); // once"]
        {
            assert!(noise(line).is_some(), "{line}");
        }
        for line in ["//! println!(\"{quality}\");", "figure(\"Instantaneous\")", "writeln!(out)?"] {
            assert_eq!(noise(line), None, "{line}");
        }
    }
}
