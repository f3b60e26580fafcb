//! Readable names for the folders of runs, which are named by the hashes of their scenes.
//!
//! Scripts and further parts use `runs/HASH`; `by_name/3-load_n=2000` is a link to it. The names are a
//! convenience: where links cannot be made there are none.

use std::path::{Path, PathBuf};

use stribeck_store::campaign::{Campaign, Variant};

use super::Folder;

/// Folder of the names.
pub(super) const BY_NAME: &str = "by_name";
/// A name is no longer than this [bytes]: file systems take 255.
const LONGEST: usize = 120;

/// Makes links to all runs that have a folder, and removes earlier ones, which may belong to a former text of
/// the campaign.
pub(super) fn link(folder: &Folder, campaign: &Campaign) {
    let names = folder.path().join(BY_NAME);
    remove_links(&names);
    for variant in &campaign.runs {
        let Ok(scene) = &variant.scene else { continue };
        let run = folder.0.run(scene);
        if let (true, Some(hash)) = (run.is_dir(), run.file_name()) {
            std::fs::create_dir_all(&names).ok();
            let to: PathBuf = ["..".as_ref(), "runs".as_ref(), hash].iter().collect();
            symlink(&to, &names.join(name(campaign, variant)));
        }
    }
}

/// Removes the links that are there, and nothing else.
fn remove_links(names: &Path) {
    for entry in std::fs::read_dir(names).into_iter().flatten().flatten() {
        if entry.file_type().is_ok_and(|kind| kind.is_symlink()) {
            std::fs::remove_file(entry.path()).ok();
        }
    }
}

#[cfg(unix)]
fn symlink(to: &Path, name: &Path) {
    // Another part may have made it.
    std::os::unix::fs::symlink(to, name).ok();
}

#[cfg(not(unix))]
fn symlink(_to: &Path, _name: &Path) {}

/// Number, values and start: `03-load_n=2000-start2`.
fn name(campaign: &Campaign, variant: &Variant) -> String {
    let digits = campaign.runs.len().to_string().len();
    let mut name = format!("{:0digits$}", variant.number);
    for (field, value) in campaign.fields.iter().zip(&variant.values) {
        let last = field.rsplit('.').next().unwrap_or(field);
        name += &format!("-{last}={}", plain(value));
    }
    let several = campaign.runs.iter().any(|other| other.start != variant.start);
    // At a boundary of a letter.
    while name.len() > LONGEST {
        name.pop();
    }
    if several {
        name += &format!("-start{}", variant.start);
    }
    name
}

/// A value without characters that are special to shells and file systems.
fn plain(value: &str) -> String {
    let kept = |c: char| c.is_ascii_alphanumeric() || "._+-".contains(c);
    let text: String = value.trim_matches('"').chars().map(|c| if kept(c) { c } else { '_' }).collect();
    text.trim_matches('_').to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn behaves_names_say_number_values_and_start() {
        let text = "(name: \"a\", starts: 2, variants: grid([(field: \"operation.load_n\", values: [2000, 1e4]), \
                    (field: \"bearing\", values: [\"NU 205\"])]))";
        let campaign = Campaign::parse(text, "here", Path::new("")).expect("a campaign");
        let names: Vec<String> = campaign.runs.iter().map(|run| name(&campaign, run)).collect();
        assert_eq!(names[0], "1-load_n=2000-bearing=NU_205-start1");
        assert_eq!(names.len(), 4);
        assert!(
            names.iter().all(|name| names.iter().filter(|other| *other == name).count() == 1),
            "{names:?}"
        );
        assert_eq!(plain("reduced(modes_khz: 20)"), "reduced_modes_khz__20");
    }
}
