//! The page of all fields, in Markdown.

use std::fmt::Write as _;

use super::tree::{Content, join};
use super::value::Value;
use super::{Field, Group, Shape, Spot};
use crate::scene::Scene;

/// Every field of a scene with its default, range and description.
pub fn page() -> String {
    let text = String::from(
        "# Every field of a scene\n\nWritten by `cargo xtask write-fields` from the table by which scenes are \
         read. `stribeck fields load` prints those with `load` in their path, `stribeck fields --schema` all \
         as a JSON schema, for editors and other programs. What a scene does not say has the default behind \
         the field; a number outside its range is refused with its line. *Up to* begins above 0.\n",
    );
    let mut page = Page { text, described: Vec::new() };
    // Writing to a text cannot fail.
    let _ = page.section(Spot::ROOT, "");
    page.text
}

/// The page as far as it is written.
struct Page {
    text: String,
    /// Comment of every kind of value that is described, and its path.
    described: Vec<(&'static [&'static str], String)>,
}

impl Page {
    /// The fields of the group at a path, and what stands behind its words.
    fn section(&mut self, spot: Spot, path: &str) -> std::fmt::Result {
        match spot.shape.there() {
            Shape::Group(group) => {
                if !path.is_empty() {
                    write!(self.text, "\n## `{path}`\n\n")?;
                    if let Some(before) = self.described(group.about, path) {
                        return writeln!(self.text, "As `{before}`.");
                    }
                    writeln!(self.text, "{}", sentence(group.about))?;
                }
                self.fields(spot, group, path)
            }
            Shape::Words(words) if self.described(words.about, path).is_none() => {
                for word in words.words {
                    if let Some(Shape::Group(group)) = word.inside {
                        write!(self.text, "\n## `{path}: {}(…)`\n", word.word)?;
                        self.fields(spot, group, path)?;
                    }
                }
                Ok(())
            }
            Shape::List(item) => self.section(spot.with(*item), &format!("{path}[0]")),
            _ => Ok(()),
        }
    }

    /// The other path at which this was described before; notes this one where there is none.
    fn described(&mut self, about: &'static [&'static str], path: &str) -> Option<String> {
        let before = self.described.iter().find(|(described, _)| *described == about);
        if let Some((_, before)) = before {
            return (before != path).then(|| before.clone());
        }
        self.described.push((about, path.to_owned()));
        None
    }

    /// A line for each field of a group with the words that it may have, and what is inside of them.
    fn fields(&mut self, spot: Spot, group: &'static Group, path: &str) -> std::fmt::Result {
        let mut shown: Vec<&'static Field> = group.fields.iter().collect();
        shown.retain(|field| !field.is_internal);
        self.text.push('\n');
        for field in &shown {
            writeln!(self.text, "{}", line(spot, group, field))?;
            self.words(spot.at(group, field), &join(path, field.name))?;
        }
        for field in shown {
            self.section(spot.at(group, field), &join(path, field.name))?;
        }
        Ok(())
    }

    /// The words that a field may have, under its line.
    fn words(&mut self, spot: Spot, path: &str) -> std::fmt::Result {
        let words = match spot.shape.there() {
            Shape::Words(words) => words,
            Shape::List(item) => return self.words(spot.with(*item), &format!("{path}[0]")),
            _ => return Ok(()),
        };
        if let Some(before) = self.described(words.about, path) {
            return writeln!(self.text, "  - as `{before}`");
        }
        // What the field's own sentence does not say.
        if let Some((_, more)) = sentence(words.about).split_once(". ") {
            writeln!(self.text, "  {more}")?;
        }
        for word in words.words {
            let brackets = if word.inside.is_some() { "(…)" } else { "" };
            writeln!(self.text, "  - `{}{brackets}`: {}", word.word, sentence(word.about))?;
        }
        Ok(())
    }
}

/// `` - `length_mm` = `10.0`, up to 20000 mm: Circumferential length. ``
fn line(spot: Spot, group: &'static Group, field: &'static Field) -> String {
    let at = spot.at(group, field);
    let mut line = format!("- `{}`", field.name);
    if let Some(Content::Atom(atom)) = at.default().map(|node| node.content) {
        line += &format!(" = `{atom}`");
    }
    let mut about = sentence(field.about);
    if let Some((range, unit)) = at.range {
        let words =
            range.in_words(unit, &Scene::default().write()).replace("more than 0, at most ", "up to ");
        line += &format!(", {words}");
        // The range has its unit, which the sentence says in brackets.
        let unit = if unit.is_empty() { "-" } else { unit };
        about = about.replace(&format!(" [{unit}]"), "");
    }
    format!("{line}: {about}")
}

/// A comment on one line without links to code.
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
    use stribeck_testing::assert_has;

    #[test]
    fn invariant_every_number_of_a_scene_is_on_the_page_with_its_range() {
        assert_eq!(
            sentence(&[" see [`Scene`](crate::scene)", " and [m/s²], a|b"]),
            "see `Scene` and [m/s²], a\\|b"
        );
        let text = page();
        assert_has(
            &text,
            &[
                "- `length_mm` = `10.0`, up to 20000 mm: Circumferential length, measured on the raceway.\n",
                "- `stiffness_n_um` = `1000.0`, up to 1000000 N/µm: ",
                "- `poissons_ratio` = `0.3`, 0 or more, less than 0.5: Poisson's ratio.\n",
                "## `inner_ring_mesh`\n\nAs `outer_ring_mesh`.\n",
                "- `collocated`:",
                "## `housing: springs(…)`",
                "## `defects[0].form: spall(…)`",
                "- `amplitude` = `50.0`, 0 to 100000 rpm: Amplitude.\n",
            ],
        );
    }
}
