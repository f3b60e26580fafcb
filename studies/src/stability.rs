//! `cargo xtask study stability`: stiff and extreme cases, energy balance, and whether the program stopped or
//! warned.

mod geometry;
mod limit;
mod long;
mod materials;
mod passages;
mod scenes;
mod stiffness;

pub(super) use limit::split;
pub(super) use materials::{cylinder, cylinder_of};

use anyhow::Result;
use stribeck_report::plot::Figure;

use crate::{Answer, Flags, Host, Runner, Sheet};

/// Flags of `study stability`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[command(flatten)]
    flags: Flags,
}

/// Imbalance of energy above which a run carries a warning [-], as in `guards`.
const ENERGY_WARNING: f64 = 0.005;

/// How a case ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Verdict {
    /// It ended with a right answer.
    Right,
    /// It ended, with a warning.
    Warned,
    /// A guard stopped it.
    Stopped,
    /// It was refused before it began.
    Refused,
    /// It ended with a wrong result and without a warning.
    Undetected,
}

impl Verdict {
    fn word(self) -> &'static str {
        match self {
            Self::Right => "right",
            Self::Warned => "warned",
            Self::Stopped => "stopped",
            Self::Refused => "refused",
            Self::Undetected => "**undetected**",
        }
    }
}

/// One row of the atlas.
#[derive(Debug, Clone)]
struct Case {
    /// The case.
    done: String,
    /// Largest imbalance of energy over the peak energy [-].
    energy: Option<f64>,
    verdict: Verdict,
    /// The observation.
    seen: String,
}

impl Case {
    /// A rig that ran: `stop` is why it ended early, `right` whether its answer is right.
    fn of(done: impl Into<String>, energy: f64, stop: Option<String>, right: bool, seen: String) -> Self {
        let (verdict, seen) = match stop {
            Some(why) => (Verdict::Stopped, why),
            None if energy > ENERGY_WARNING => (Verdict::Warned, seen),
            None if right => (Verdict::Right, seen),
            None => (Verdict::Undetected, seen),
        };
        Self { done: done.into(), energy: Some(energy), verdict, seen }
    }
}

/// A group of cases with its words and pictures.
#[derive(Default)]
struct Chapter {
    title: &'static str,
    words: &'static str,
    cases: Vec<Case>,
    figures: Vec<Figure>,
}

pub(crate) fn run(options: &Options, host: &dyn Host) -> Result<Answer> {
    let runner = Runner::new("stability", &options.flags, host);
    let rigs: [fn() -> Result<Chapter>; 6] = [
        limit::chapter,
        stiffness::chapter,
        materials::chapter,
        geometry::chapter,
        long::chapter,
        long::loads,
    ];
    let mut chapters = Vec::new();
    for rig in rigs {
        let chapter = rig()?;
        host.say(&format!("{}: {} cases", chapter.title, chapter.cases.len()));
        chapters.push(chapter);
    }
    chapters.push(scenes::chapter(&runner, &options.flags, host)?);
    chapters.push(passages::chapter(&runner, &options.flags, host)?);

    let mut sheet = Sheet::new(host.root(), "stability", "Stability atlas");
    let all = || chapters.iter().flat_map(|c| &c.cases);
    let count = |v: Verdict| all().filter(|c| c.verdict == v).count();
    sheet.say(&format!(
        "{} stiff and extreme cases: {} end with a right answer, {} with a warning that says what to change, \
         {} were stopped by a guard, \
         {} refused before they began, **{} ended wrong and undetected**. *Energy* is the largest imbalance \
         over the peak of the energy in \
         the model (strain energy for bearings); a run warns above 0.5 % (from its tenth sample on: a load \
         that comes at once is measured against a strain energy that has just begun) and stops above 25 %. \
         Rigs are small models of bodies, \
         contacts and loads under the same limits; bearings are whole scenes.",
        all().count(),
        count(Verdict::Right),
        count(Verdict::Warned),
        count(Verdict::Stopped),
        count(Verdict::Refused),
        count(Verdict::Undetected),
    ));
    for chapter in &chapters {
        sheet.heading(chapter.title);
        sheet.say(chapter.words);
        let rows: Vec<Vec<String>> = chapter.cases.iter().map(row).collect();
        sheet.table(&["case", "energy", "ended", "seen"], &rows);
        for case in &chapter.cases {
            sheet.value(chapter.title, &case.done, "energy imbalance", case.energy);
            sheet.word(chapter.title, &case.done, "ended", case.verdict.word());
        }
        for figure in &chapter.figures {
            sheet.picture(figure)?;
        }
    }
    let undetected = count(Verdict::Undetected);
    let failure = (undetected > 0).then(|| format!("{undetected} cases ended wrong and undetected"));
    Ok(Answer { failure, ..Answer::on(sheet.write()?) })
}

fn row(case: &Case) -> Vec<String> {
    let energy = match case.energy {
        None => "–".to_owned(),
        Some(e) if !e.is_finite() => "∞".to_owned(),
        Some(e) if e < 1e-4 => format!("{:.0e}", e),
        Some(e) => format!("{:.2} %", 100.0 * e),
    };
    vec![
        case.done.clone(),
        energy,
        case.verdict.word().to_owned(),
        case.seen.replace('\n', " ").replace('|', "/"),
    ]
}
