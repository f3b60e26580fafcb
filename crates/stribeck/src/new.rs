//! `stribeck new`: a scene of one's own, by five answers or by flags, with comments, that runs as it is.

use std::fmt::Display;
use std::io::{BufRead, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result, bail, ensure};
use stribeck_scene::catalogue::CatalogueBearing;
use stribeck_scene::kinematics::Kinematics;
use stribeck_scene::run_dir::write_atomic;
use stribeck_scene::scene::Scene;

use crate::out::say;
use crate::place::{Place, shown};

/// Flags of `new`. What is not given is asked for on a terminal, and has its default elsewhere.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// File to write, for example mine.ron [default: the bearing and its defect]
    file: Option<PathBuf>,
    /// Bearing of the catalogue, for example "NU 205" or 6205 [default: 6205]
    #[arg(long)]
    bearing: Option<String>,
    /// Radial load [N] [default: 1000]
    #[arg(long, value_name = "N", value_parser = positive, allow_hyphen_values = true)]
    load_n: Option<f64>,
    /// Speed of the shaft [1/min] [default: 1500]
    #[arg(long, value_name = "RPM", value_parser = positive, allow_hyphen_values = true)]
    speed_rpm: Option<f64>,
    /// Where a spall is, or none [default: outer]
    #[arg(long, value_enum)]
    defect: Option<Where>,
    /// Length of the record [s] [default: 1]
    #[arg(long, value_name = "S", value_parser = positive, allow_hyphen_values = true)]
    duration_s: Option<f64>,
    /// Asks nothing: what is not given has its default
    #[arg(long, short = 'y')]
    yes: bool,
}

/// Where a spall lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Where {
    /// On the outer raceway
    Outer,
    /// On the inner raceway
    Inner,
    /// On a rolling element
    Roller,
    /// Nowhere: a sound bearing
    None,
}

impl Where {
    fn word(self) -> &'static str {
        match self {
            Self::Outer => "outer",
            Self::Inner => "inner",
            Self::Roller => "roller",
            Self::None => "none",
        }
    }

    fn parse(text: &str) -> Result<Self, String> {
        <Self as clap::ValueEnum>::from_str(text, true)
            .map_err(|_| format!("`{text}` is none of outer, inner, roller and none"))
    }
}

fn positive(text: &str) -> Result<f64, String> {
    let number = text.trim().parse::<f64>().ok().filter(|x| x.is_finite() && *x > 0.0);
    number.ok_or_else(|| format!("`{text}` is no number above 0"))
}

/// A bearing that a scene can name.
fn bearing(text: &str) -> Result<CatalogueBearing, String> {
    let advice = "`stribeck bearings` lists those that are known; for another one write a scene with its \
                  dimensions (`bearing: (rollers: …)`, as the guide's page on your own bearing has it)";
    let text = text.trim().trim_matches('"');
    if text.starts_with(|c: char| c.is_ascii_lowercase()) && text.contains('=') {
        return Err(format!("`{text}` are numbers without a name; {advice}"));
    }
    CatalogueBearing::parse_or_advise(text, advice)
}

/// The five answers.
struct Answers {
    bearing: String,
    load_n: f64,
    speed_rpm: f64,
    defect: Where,
    duration_s: f64,
}

pub(crate) fn run(options: &Options, place: &Place) -> Result<ExitCode> {
    let asks = !options.yes && std::io::stdin().is_terminal() && std::io::stderr().is_terminal();
    if let Some(file) = &options.file {
        ensure!(
            file.extension().is_some_and(|end| end == "ron"),
            "`{}`: a scene is a file that ends in `.ron`, such as `{}.ron`",
            file.display(),
            file.file_stem().unwrap_or(file.as_os_str()).display()
        );
        free(file)?;
    }
    let answers = answers(options, asks)?;
    let name = name(&answers);
    let file = options.file.clone().unwrap_or_else(|| PathBuf::from(format!("{name}.ron")));
    free(&file)?;
    let name = file.file_stem().map_or(name, |stem| {
        stem.to_string_lossy().replace(|c: char| !(c.is_ascii_alphanumeric() || "-_.".contains(c)), "-")
    });
    let text = text(&name, &answers);
    // What is refused here would be refused when it runs; then no file is left.
    let scene = Scene::parse(&text, &shown(&file))?;
    if let Some(folder) = file.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        std::fs::create_dir_all(folder).with_context(|| format!("cannot make `{}`", shown(folder)))?;
    }
    write_atomic(&file, text.as_bytes())?;
    let k = Kinematics::of(&scene);
    say!("{}", shown(&file));
    say!(
        "  BPFO {:.2} Hz, BPFI {:.2} Hz, BSF {:.2} Hz, FTF {:.2} Hz, without slip",
        k.bpfo_hz,
        k.bpfi_hz,
        k.bsf_hz,
        k.cage_hz
    );
    say!("run it: {} simulate {}", place.program, shown(&file));
    Ok(ExitCode::SUCCESS)
}

/// Refuses to write over a file.
fn free(file: &Path) -> Result<()> {
    ensure!(!file.exists(), "`{}` is there already and is kept: give another name", shown(file));
    Ok(())
}

fn answers(options: &Options, asks: bool) -> Result<Answers> {
    let named = |text: &str| bearing(text).map(|b| with_numbers(text, &b));
    let from = |given: Option<String>, question: &str, default: &str| -> Result<String> {
        match given {
            Some(given) => named(&given).map_err(|why| anyhow::anyhow!("--bearing: {why}")),
            None if asks => ask(question, &default, &named),
            None => Ok(named(default).map_err(anyhow::Error::msg)?),
        }
    };
    let number = |given: Option<f64>, question: &str, default: f64| match given {
        Some(given) => Ok(given),
        None if asks => ask(question, &default, &positive),
        None => Ok(default),
    };
    Ok(Answers {
        bearing: from(options.bearing.clone(), "Bearing of the catalogue", "6205")?,
        load_n: number(options.load_n, "Radial load [N]", 1000.0)?,
        speed_rpm: number(options.speed_rpm, "Speed of the shaft [1/min]", 1500.0)?,
        defect: match options.defect {
            Some(given) => given,
            None if asks => ask("Spall: outer, inner, roller or none", &"outer", &Where::parse)?,
            None => Where::Outer,
        },
        duration_s: number(options.duration_s, "Length of the record [s]", 1.0)?,
    })
}

/// The name of a bearing in the catalogue, with the numbers that were given beside it.
fn with_numbers(text: &str, bearing: &CatalogueBearing) -> String {
    let text = text.trim().trim_matches('"');
    match text.split_once(',') {
        Some((_, numbers)) => format!("{}, {}", bearing.name, numbers.trim()),
        None => bearing.name.clone(),
    }
}

/// Asks until an answer can be; an empty one is the default.
fn ask<T>(question: &str, default: &dyn Display, parse: &dyn Fn(&str) -> Result<T, String>) -> Result<T> {
    let (mut stderr, stdin) = (std::io::stderr(), std::io::stdin());
    loop {
        write!(stderr, "{question} [{default}]: ")?;
        stderr.flush()?;
        let mut line = String::new();
        if stdin.lock().read_line(&mut line)? == 0 {
            bail!("no more answers: nothing was written. `--yes` takes the defaults");
        }
        let answer = match line.trim() {
            "" => default.to_string(),
            answer => answer.to_owned(),
        };
        match parse(&answer) {
            Ok(value) => return Ok(value),
            Err(why) => writeln!(stderr, "  {why}")?,
        }
    }
}

/// Name of the scene: the bearing with its defect.
fn name(answers: &Answers) -> String {
    let bearing = answers.bearing.split(',').next().unwrap_or_default();
    let bearing = bearing.to_lowercase().replace(|c: char| !c.is_ascii_alphanumeric(), "");
    match answers.defect {
        Where::None => format!("{bearing}-sound"),
        defect => format!("{bearing}-{}", defect.word()),
    }
}

/// A scene with comments, and marks where the answers go.
const SCENE: &str = include_str!("new/scene.ron");

/// The scene with its comments.
fn text(name: &str, answers: &Answers) -> String {
    let Answers { bearing, load_n, speed_rpm, defect, duration_s } = answers;
    let (state, comment, fields) = match defect {
        Where::None => (
            "sound",
            "A sound bearing. A spall would be: (ring: outer, length_mm: 2, depth_mm: 0.1).",
            "defect: None,".to_owned(),
        ),
        Where::Roller => (
            "with a spall on a rolling element",
            "How long the spall is along the surface, and how deep.",
            "defect: None,\n    defects: [(on: roller(1), form: spall(length_mm: 2, depth_mm: 0.05))],"
                .to_owned(),
        ),
        Where::Outer | Where::Inner => (
            if *defect == Where::Outer {
                "with a spall on the outer raceway"
            } else {
                "with a spall on the inner raceway"
            },
            "How long the spall is along the raceway, and how deep.",
            format!("defect: (ring: {}, length_mm: 2, depth_mm: 0.1),", defect.word()),
        ),
    };
    SCENE
        .replace("<defect>", &format!("    // {comment}\n    {fields}"))
        .replace("<state>", state)
        .replace("<file>", name)
        .replace("<bearing>", bearing)
        .replace("<load>", &format!("{load_n:?}"))
        .replace("<speed>", &format!("{speed_rpm:?}"))
        .replace("<duration>", &format!("{:?}", 1e3 * duration_s))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn answers(bearing: &str, defect: Where) -> Answers {
        Answers { bearing: bearing.to_owned(), load_n: 1000.0, speed_rpm: 1500.0, defect, duration_s: 0.5 }
    }

    #[test]
    fn example_every_answer_makes_a_scene_that_can_be() {
        for bearing in ["6205", "NU 205", "NU 205, elements=12", "6305"] {
            for defect in [Where::Outer, Where::Inner, Where::Roller, Where::None] {
                let of = answers(bearing, defect);
                let scene = Scene::parse(&text(&name(&of), &of), "new.ron").expect(bearing);
                assert_eq!((scene.operation.load_n, scene.solver.duration_ms), (1000.0, 500.0));
                assert_eq!(scene.faults().len(), usize::from(defect != Where::None), "{bearing} {defect:?}");
            }
        }
    }

    #[test]
    fn example_names_are_those_of_bearing_and_defect() {
        assert_eq!(name(&answers("NU 205, elements=12", Where::None)), "nu205-sound");
        assert_eq!(name(&answers("6205", Where::Inner)), "6205-inner");
        let bearing = bearing("SKF 6205-2RS1, elements=8").expect("of the catalogue");
        assert_eq!(with_numbers("SKF 6205-2RS1, elements=8", &bearing), "6205, elements=8");
    }
}
