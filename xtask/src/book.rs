//! The documents as a book, with a lab in its guide.

use std::{
    fs,
    process::{Command, ExitCode},
};

use anyhow::{Context, Result, ensure};
use clap::Parser;
use stribeck::Place;

use crate::{Cli, lab, workspace};

/// Scene of the lab in the book: the paper's bearing with larger elements, whose page is small.
const SCENE: &str = "fixtures/scenes/lab.ron";

/// The page of the guide below the book, the lab beside its pictures, and the place in the page for it.
const PAGE: &str = "target/book/guide/src/lab.html";
const LAB: &str = "target/book/guide/src/lab/lab.html";
const ROOM: &str = "<div id=\"lab-here\"></div>";

/// Builds the book with mdBook, makes the lab, and puts it into the page.
pub(crate) fn run() -> Result<ExitCode> {
    let root = workspace::root();
    let built = Command::new("mdbook").arg("build").arg(root.join("docs")).status();
    let built = built.context("cannot start mdbook, which `cargo install mdbook` provides")?;
    ensure!(built.success(), "mdbook cannot build the book");
    let [out, scene] = [LAB, SCENE].map(|file| root.join(file).display().to_string());
    let made = Cli::try_parse_from(["cargo xtask", "lab", &scene, "--out", &out])?;
    if let crate::Command::Program(command) = made.command {
        lab::with_module(command)?.run(&Place::repository("cargo xtask", root.clone()))?;
    }
    let page = root.join(PAGE);
    let text = fs::read_to_string(&page).with_context(|| format!("cannot read {}", page.display()))?;
    fs::write(&page, with_lab(&text)?).with_context(|| format!("cannot write {}", page.display()))?;
    println!("book: {}", root.join("target/book/index.html").display());
    Ok(ExitCode::SUCCESS)
}

/// The page with the lab in its place.
fn with_lab(page: &str) -> Result<String> {
    ensure!(page.matches(ROOM).count() == 1, "the page of the lab has no `{ROOM}`");
    let frame = "<iframe src=\"lab/lab.html\" title=\"The lab\" loading=\"lazy\" style=\"width: 100%; height: 90vh; \
                 border: 1px solid\"></iframe><p><a href=\"lab/lab.html\">The lab by itself</a></p>";
    Ok(page.replace(ROOM, frame))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn behaves_the_guide_has_one_place_for_the_lab() {
        let guide = include_str!("../../docs/guide/src/lab.md");
        assert!(with_lab(guide).is_ok_and(|page| page.contains("<iframe src=\"lab/lab.html\"")));
        assert!(with_lab("no place").is_err_and(|why| why.to_string().contains("has no")));
    }

    #[test]
    fn behaves_the_scene_of_the_book_is_there() {
        assert!(workspace::root().join(SCENE).is_file());
    }
}
