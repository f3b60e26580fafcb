//! `stribeck demo`: a bearing with a spall from scene to verdict, by the commands that a user would type.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, Result, ensure};
use clap::Parser;

use crate::Cli;
use crate::out::say;
use crate::place::{Place, shown};

/// Flags of `demo`.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// Folder for all that it makes
    #[arg(default_value = "stribeck-demo")]
    folder: PathBuf,
    /// Opens both pages in the browser
    #[arg(long)]
    open: bool,
}

/// What is made, and by which command; `DIR` is the folder.
const STEPS: [(&str, &[&str]); 5] = [
    (
        "A scene: a 6205 with a spall of 2 mm on its inner raceway.",
        &["new", "DIR/bearing.ron", "--defect", "inner", "--load-n", "500", "--yes"],
    ),
    (
        "It turns for a second, and leaves a page.",
        &["simulate", "DIR/bearing.ron", "--out", "DIR/run", "--quiet"],
    ),
    (
        "How it sounds, ten times slower.",
        &[
            "export",
            "DIR/run",
            "--to",
            "wav",
            "--slow",
            "10",
            "--channel",
            "sensor.side.ay_m_s2",
            "--out",
            "DIR/sound.wav",
        ],
    ),
    (
        "A record of it, as the sensor of a machine takes it: made by this program, not measured.",
        &["export", "DIR/run", "--to", "csv", "--machine", "--out", "DIR/record.csv"],
    ),
    (
        "The verdict on that record, without the scene.",
        &[
            "analyse",
            "DIR/record.csv",
            "--bearing",
            "6205",
            "--speed-rpm",
            "1500",
            "--load-n",
            "500",
            "--out",
            "DIR/verdict",
            "--quiet",
        ],
    ),
];

const PAGES: [&str; 2] = ["run/report.html", "verdict/report.html"];

pub(crate) fn run(options: &Options, place: &Place) -> Result<ExitCode> {
    let folder = &options.folder;
    ensure!(
        !folder.exists(),
        "`{}` is there already and is kept: `{} demo OTHER_FOLDER` makes it elsewhere",
        shown(folder),
        place.program
    );
    std::fs::create_dir_all(folder).with_context(|| format!("cannot make `{}`", shown(folder)))?;
    let dir = folder.to_string_lossy();
    for (what, words) in STEPS {
        let words: Vec<String> = words.iter().map(|word| word.replace("DIR", &dir)).collect();
        say!("\n{what}\n$ {} {}", place.program, line(&words));
        let program = Cli::try_parse_from(["stribeck".to_owned()].into_iter().chain(words))?;
        program.loudness.apply();
        let code = program.command.run(place)?;
        if code != ExitCode::SUCCESS {
            return Ok(code);
        }
    }
    let pages = PAGES.map(|page| folder.join(page));
    say!(
        "\nOpen {} and {}; listen to {}.",
        shown(&pages[0]),
        shown(&pages[1]),
        shown(&folder.join("sound.wav"))
    );
    if options.open {
        for page in &pages {
            let page = std::path::absolute(page).unwrap_or_else(|_| page.clone());
            open::that_detached(&page).with_context(|| format!("no browser opens `{}`", page.display()))?;
        }
    }
    Ok(ExitCode::SUCCESS)
}

/// Words as a shell takes them.
fn line(words: &[String]) -> String {
    let quoted = |word: &String| if word.contains(' ') { format!("\"{word}\"") } else { word.clone() };
    words.iter().map(quoted).collect::<Vec<_>>().join(" ")
}
