//! `stribeck fields`: the fields of a scene, from the table by which scenes are read.

use std::process::ExitCode;

use anyhow::{Result, ensure};
use stribeck_scene::fields::{json_schema, page};

use crate::out::say;

/// Flags of `fields`.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// A field or a group by its path, as operation or operation.load_n, or a part of names [default: all]
    path: Option<String>,
    /// Prints all fields as a JSON schema
    #[arg(long, conflicts_with = "path")]
    schema: bool,
}

pub(crate) fn run(options: &Options) -> Result<ExitCode> {
    if options.schema {
        say!("{:#}", json_schema());
        return Ok(ExitCode::SUCCESS);
    }
    let page = page();
    let shown = options.path.as_deref().map_or_else(|| page.clone(), |path| chosen(&page, path));
    ensure!(
        !shown.is_empty(),
        "no field of a scene has `{}` in its path: `stribeck fields` lists all",
        options.path.as_deref().unwrap_or_default()
    );
    say!("{}", shown.trim_end());
    Ok(ExitCode::SUCCESS)
}

/// The section of a group, or each field whose path has `asked` in it, with its words.
fn chosen(page: &str, asked: &str) -> String {
    let (mut group, mut is_shown) = ("", false);
    let mut shown = String::new();
    for line in page.lines() {
        if let Some(title) = line.strip_prefix("## `") {
            (group, is_shown) = (title.trim_end_matches('`'), false);
        } else if let Some((name, rest)) = line.strip_prefix("- `").and_then(|line| line.split_once('`')) {
            let path = if group.is_empty() { name.to_owned() } else { format!("{group}.{name}") };
            is_shown = group == asked || path.contains(asked);
            if is_shown {
                shown += &format!("{path}{rest}\n");
            }
        } else if is_shown && line.starts_with("  ") {
            shown += &format!("{line}\n");
        }
    }
    shown
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn behaves_a_field_is_found_by_its_path_or_a_part_of_it() {
        let of = |asked| chosen(&page(), asked);
        let load = of("operation.load_n");
        assert!(load.starts_with("operation.load_n = `") && load.contains(" N"), "{load}");
        assert_eq!(load.lines().count(), 1, "{load}");
        assert!(of("operation").lines().count() > 3);
        assert!(of("duration").contains("solver.duration_ms") && of("surface").contains("`arc`"));
        assert_eq!(of("nothing_of_it"), "");
    }
}
