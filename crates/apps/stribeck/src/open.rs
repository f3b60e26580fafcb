//! `stribeck open`: the page of a run in a browser.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, Result, bail};

use crate::out::say;
use crate::place::{Place, shown};
use crate::shelf::{Kind, all_items, find};

/// Flags of `open`.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// Run, ensemble, campaign or analysis: its folder, or its name below runs/ [default: the newest that has
    /// a page]
    run: Option<PathBuf>,
    /// Prints the path of the page, and opens nothing
    #[arg(long)]
    print: bool,
}

pub(crate) fn run(options: &Options, place: &Place) -> Result<ExitCode> {
    let page = match &options.run {
        Some(run) => {
            let item = find(run, place)?;
            match item.page() {
                Some(page) => page,
                None if matches!(item.kind, Kind::Run | Kind::Ensemble) => bail!(
                    "`{0}` has no page yet, it is {2}: `{1} report {0}` writes one{3}",
                    shown(&item.path),
                    place.program,
                    item.state,
                    match item.next().filter(|next| next.starts_with("simulate")) {
                        Some(next) =>
                            format!(" of what there is, `{} {next}` brings the run on", place.program),
                        None => String::new(),
                    }
                ),
                None => bail!("`{}` has no page: it is {}", shown(&item.path), item.state),
            }
        }
        None => {
            let newest = all_items(place).into_iter().find_map(|item| item.page());
            newest.with_context(|| {
                format!(
                    "nothing in `{}` has a page: start a run with `{} simulate`, or name a folder",
                    shown(&place.runs()),
                    place.program
                )
            })?
        }
    };
    say!("{}", shown(&page));
    if options.print {
        return Ok(ExitCode::SUCCESS);
    }
    let page = std::path::absolute(&page).unwrap_or(page);
    open::that_detached(&page).with_context(|| {
        format!(
            "no browser could be started: open `{}` in one, or copy the file to where there is one; it needs \
             no network",
            page.display()
        )
    })?;
    Ok(ExitCode::SUCCESS)
}
