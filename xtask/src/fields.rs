//! `docs/guide/src/fields.md`: every field of a scene, from the types that scenes are read into, with their
//! defaults and ranges.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;
use std::process::ExitCode;

use anyhow::{Context, Result};
use stribeck_scene::scene_file::FieldReference;
use syn::{Attribute, Expr, ExprLit, Fields, GenericArgument, Item, Lit, Meta, PathArguments, Type};

use crate::workspace;

/// Where the types of a scene stand.
const SOURCES: [&str; 10] = [
    "scene.rs",
    "scene/bearing.rs",
    "scene/contact.rs",
    "scene/mesh.rs",
    "scene/operation.rs",
    "scene/output.rs",
    "scene/solver.rs",
    "deviation.rs",
    "housing.rs",
    "ring_mesh.rs",
];

/// The page.
const PAGE: &str = "docs/guide/src/fields.md";

/// Flags of `fields`.
#[derive(Debug, clap::Args)]
pub(crate) struct Options {}

/// Writes the page.
pub(crate) fn run(_: &Options) -> Result<ExitCode> {
    let root = workspace::root();
    std::fs::write(root.join(PAGE), page(&root)?).with_context(|| format!("cannot write {PAGE}"))?;
    println!("{PAGE} says what the types say");
    Ok(ExitCode::SUCCESS)
}

/// Whether the page agrees with the types.
pub(crate) fn check(root: &Path) -> Result<Vec<String>> {
    let text = std::fs::read_to_string(root.join(PAGE)).unwrap_or_default();
    let complaint = || format!("{PAGE} is not what the types say; `cargo xtask fields` writes it anew");
    Ok((text != page(root)?).then(complaint).into_iter().collect())
}

/// The documentation of a type.
struct Described {
    doc: String,
    /// Fields of a structure or words of an enumeration, with the type behind each, if it is one of ours.
    parts: Vec<Part>,
    is_words: bool,
}

struct Part {
    name: String,
    doc: String,
    of: Option<String>,
    is_list: bool,
}

fn page(root: &Path) -> Result<String> {
    let mut types = BTreeMap::new();
    for source in SOURCES {
        let path = root.join("crates/scene/src").join(source);
        let text =
            std::fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
        let file = syn::parse_file(&text).with_context(|| format!("cannot parse {}", path.display()))?;
        for item in &file.items {
            types.extend(described(item));
        }
    }
    let mut text = String::from(
        "# Every field of a scene\n\nWritten by `cargo xtask fields` from the types that scenes are read \
         into. What a scene does not say has its default; a number outside its range is refused with its \
         line.\n",
    );
    section(&types, &FieldReference::new(), "", "Scene", &mut text)?;
    Ok(text)
}

/// A structure or an enumeration among the items of a file.
fn described(item: &Item) -> Option<(String, Described)> {
    match item {
        Item::Struct(of) => {
            let Fields::Named(fields) = &of.fields else { return None };
            let part = |field: &syn::Field| {
                let (of, is_list) = inner(&field.ty);
                Part {
                    name: field.ident.as_ref().map(ToString::to_string).unwrap_or_default(),
                    doc: doc(&field.attrs),
                    of,
                    is_list,
                }
            };
            let parts = fields.named.iter().map(part).collect();
            Some((of.ident.to_string(), Described { doc: doc(&of.attrs), parts, is_words: false }))
        }
        Item::Enum(of) => {
            let part = |variant: &syn::Variant| {
                let of = variant.fields.iter().next().and_then(|field| inner(&field.ty).0);
                Part { name: snake(&variant.ident.to_string()), doc: doc(&variant.attrs), of, is_list: false }
            };
            let parts = of.variants.iter().map(part).collect();
            Some((of.ident.to_string(), Described { doc: doc(&of.attrs), parts, is_words: true }))
        }
        _ => None,
    }
}

/// The type behind `Option<…>` and `Vec<…>`, and whether there is a list on the way.
fn inner(of: &Type) -> (Option<String>, bool) {
    let Type::Path(path) = of else { return (None, false) };
    let Some(last) = path.path.segments.last() else { return (None, false) };
    let name = last.ident.to_string();
    if let PathArguments::AngleBracketed(arguments) = &last.arguments
        && let Some(GenericArgument::Type(of)) = arguments.args.first()
    {
        let (of, is_list) = inner(of);
        return (of, is_list || name == "Vec");
    }
    (Some(name), false)
}

/// The comment of an item as one line.
fn doc(attributes: &[Attribute]) -> String {
    let lines =
        attributes.iter().filter(|attribute| attribute.path().is_ident("doc")).filter_map(|attribute| {
            let Meta::NameValue(meta) = &attribute.meta else { return None };
            let Expr::Lit(ExprLit { lit: Lit::Str(text), .. }) = &meta.value else { return None };
            Some(text.value().trim().to_owned())
        });
    plain(&lines.collect::<Vec<_>>().join(" "))
}

/// A comment without links to code, ready for a cell of a table.
fn plain(text: &str) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some(at) = rest.find("](") {
        let Some(end) = rest[at..].find(')') else { break };
        out.push_str(&rest[..at]);
        out.push(']');
        rest = &rest[at + end + 1..];
    }
    out.push_str(rest);
    // `[`Name`]` → `Name`; a unit keeps its brackets.
    out.replace("[`", "`").replace("`]", "`").replace('|', "\\|")
}

/// `TwoWords` → `two_words`.
fn snake(name: &str) -> String {
    let mut out = String::new();
    for c in name.chars() {
        if c.is_uppercase() && !out.is_empty() {
            out.push('_');
        }
        out.extend(c.to_lowercase());
    }
    out
}

/// The fields of a type at `path`, then those of the types in it.
fn section(
    types: &BTreeMap<String, Described>,
    fields: &FieldReference,
    path: &str,
    name: &str,
    text: &mut String,
) -> Result<()> {
    let Some(of) = types.get(name) else { return Ok(()) };
    if of.is_words {
        return words(types, fields, path, of, text);
    }
    if !path.is_empty() {
        write!(text, "\n## `{path}`\n\n{}\n", of.doc)?;
    }
    text.push_str("\n| field | default | range | |\n|---|---|---|---|\n");
    let at = |part: &Part| if path.is_empty() { part.name.clone() } else { format!("{path}.{}", part.name) };
    for part in &of.parts {
        let field = fields.of(&at(part));
        let shown = field.default.filter(|default| !default.contains(['(', '[', '\n']));
        let default = shown.map(|default| format!("`{default}`")).unwrap_or_default();
        writeln!(
            text,
            "| `{}` | {default} | {} | {} |",
            part.name,
            field.range.unwrap_or_default(),
            part.doc
        )?;
    }
    for part in &of.parts {
        if let Some(inner) = &part.of {
            let item = if part.is_list { format!("{}[0]", at(part)) } else { at(part) };
            section(types, fields, &item, inner, text)?;
        }
    }
    Ok(())
}

/// The words of an enumeration, and the fields behind each.
fn words(
    types: &BTreeMap<String, Described>,
    fields: &FieldReference,
    path: &str,
    of: &Described,
    text: &mut String,
) -> Result<()> {
    write!(text, "\n## `{path}`\n\n{} One of\n\n", of.doc)?;
    for word in &of.parts {
        let group = word.of.as_ref().filter(|name| types.contains_key(*name)).map_or("", |_| "(…)");
        writeln!(text, "- `{}{group}`: {}", word.name, word.doc)?;
    }
    for word in &of.parts {
        let Some(inner) = word.of.as_ref().and_then(|name| types.get(name)) else { continue };
        write!(
            text,
            "\n### `{path}: {}(…)`\n\n| field | default | range | |\n|---|---|---|---|\n",
            word.name
        )?;
        for part in &inner.parts {
            let field = fields.inside(path, &word.name, &part.name);
            let shown = field.default.filter(|default| !default.contains(['(', '[', '\n']));
            let default = shown.map(|default| format!("`{default}`")).unwrap_or_default();
            writeln!(
                text,
                "| `{}` | {default} | {} | {} |",
                part.name,
                field.range.unwrap_or_default(),
                part.doc
            )?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn behaves_comments_become_cells() {
        assert_eq!(plain("see [`Scene`](crate::scene) and [m/s²], a|b"), "see `Scene` and [m/s²], a\\|b");
        assert_eq!(snake("OuterRing"), "outer_ring");
    }

    #[test]
    fn invariant_every_number_of_a_scene_is_on_the_page_with_its_range() {
        let text = page(&workspace::root()).expect("the sources are there");
        for line in [
            "| `length_mm` | `10.0` | more than 0, at most 20000 mm | Circumferential length [mm], measured \
             on the raceway. |",
            "| `stiffness_n_um` | `1000.0` | more than 0, at most 1000000 N/µm |",
            "- `collocated`:",
            "### `housing: springs(…)`",
            "### `defects[0].form: spall(…)`",
        ] {
            assert!(text.contains(line), "{line}\n{text}");
        }
    }
}
