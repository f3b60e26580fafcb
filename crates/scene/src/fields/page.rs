//! The page of all fields, in Markdown.

use std::fmt::Write as _;

use super::tree::{Content, join};
use super::{Group, Shape, Spot, Words};
use crate::scene::Scene;

/// Every field of a scene with its default, range and description.
pub fn page() -> String {
    let mut text = String::from(
        "# Every field of a scene\n\nWritten by `cargo xtask fields` from the table by which scenes are \
         read; `cargo xtask fields --schema` prints the same as a JSON schema, for editors and other \
         programs. What a scene does not say has its default; a number outside its range is refused with its \
         line.\n",
    );
    // Writing to a text cannot fail.
    let _ = section(&mut text, Spot::ROOT, "");
    text
}

/// The fields or words at a path, then those inside.
fn section(text: &mut String, spot: Spot, path: &str) -> std::fmt::Result {
    match spot.shape.there() {
        Shape::Group(group) => {
            if !path.is_empty() {
                write!(text, "\n## `{path}`\n\n{}\n", sentence(group.about))?;
            }
            rows(text, spot, group)?;
            for field in group.fields {
                let at = join(path, field.name);
                section(text, spot.at(group, field), &at)?;
            }
            Ok(())
        }
        Shape::Words(words) => of_words(text, spot, words, path),
        Shape::List(item) => section(text, spot.with(*item), &format!("{path}[0]")),
        _ => Ok(()),
    }
}

/// The words at a path, and the fields behind each.
fn of_words(text: &mut String, spot: Spot, words: &Words, path: &str) -> std::fmt::Result {
    write!(text, "\n## `{path}`\n\n{} One of\n\n", sentence(words.about))?;
    for word in words.words {
        let brackets = if word.inside.is_some() { "(…)" } else { "" };
        writeln!(text, "- `{}{brackets}`: {}", word.word, sentence(word.about))?;
    }
    for word in words.words {
        if let Some(Shape::Group(group)) = word.inside {
            write!(text, "\n### `{path}: {}(…)`\n", word.word)?;
            rows(text, spot, group)?;
            for field in group.fields {
                section(text, spot.at(group, field), &format!("{path}.{}", field.name))?;
            }
        }
    }
    Ok(())
}

/// A table of fields.
fn rows(text: &mut String, spot: Spot, group: &'static Group) -> std::fmt::Result {
    text.push_str("\n| field | default | range | |\n|---|---|---|---|\n");
    for field in group.fields {
        let at = spot.at(group, field);
        let default = match at.default().map(|node| node.content) {
            Some(Content::Atom(atom)) => format!("`{atom}`"),
            _ => String::new(),
        };
        let range =
            at.range.map_or_else(String::new, |(range, unit)| range.in_words(unit, &Scene::default()));
        writeln!(text, "| `{}` | {default} | {range} | {} |", field.name, sentence(field.about))?;
    }
    Ok(())
}

/// A comment on one line without links to code, ready for a cell of a table.
pub(super) fn sentence(about: &[&str]) -> String {
    let lines: Vec<&str> = about.iter().map(|line| line.trim()).collect();
    let text = lines.join(" ");
    let mut out = String::new();
    let mut rest = text.trim();
    while let Some(at) = rest.find("](") {
        let Some(end) = rest[at..].find(')') else { break };
        out += &rest[..=at];
        rest = &rest[at + end + 1..];
    }
    out += rest;
    // `[`Name`]` → `Name`; a unit keeps its brackets.
    out.replace("[`", "`").replace("`]", "`").replace('|', "\\|")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn invariant_every_number_of_a_scene_is_on_the_page_with_its_range() {
        assert_eq!(
            sentence(&[" see [`Scene`](crate::scene)", " and [m/s²], a|b"]),
            "see `Scene` and [m/s²], a\\|b"
        );
        let text = page();
        for line in [
            "| `length_mm` | `10.0` | more than 0, at most 20000 mm | Circumferential length [mm], measured \
             on the raceway. |",
            "| `stiffness_n_um` | `1000.0` | more than 0, at most 1000000 N/µm |",
            "- `collocated`:",
            "### `housing: springs(…)`",
            "### `defects[0].form: spall(…)`",
            "| `amplitude` | `50.0` | 0 to 1e9 N | Amplitude. |",
        ] {
            assert!(text.contains(line), "{line}\n{text}");
        }
    }
}
