//! `cargo xtask study stability`: stiff and extreme cases, energy balance, and whether the program stopped or
//! warned.

mod bars;
mod bearings;
mod blocks;
mod limit;
mod long;

pub(super) use blocks::{cylinder, ring, split};

use anyhow::Result;

use crate::{Answer, Plan, Rows, Runner, figure};

/// Imbalance of energy above which a run carries a warning [-], as in `guards`.
const ENERGY_WARNING: f64 = 0.005;

/// Groups of cases; the last two are whole bearings.
const CHAPTERS: [&str; 8] = [
    "Onset of instability",
    "Contact stiffness and contrasts",
    "Poisson's ratio",
    "Shapes, places and units",
    "Long runs",
    "Loads that change in mid-run",
    "Whole bearings",
    "Through the defect",
];

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

/// One case of a chapter.
#[derive(Debug, Clone)]
struct Case {
    done: String,
    /// Largest imbalance of energy over the peak energy [-].
    energy: Option<f64>,
    verdict: Verdict,
    /// The observation.
    seen: String,
}

impl Case {
    /// A small model that ran: `stop` is why it ended early, `right` whether its answer is right.
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

fn put(rows: &mut Rows, chapter: &str, cases: Vec<Case>) {
    for Case { done, energy, verdict, seen } in cases {
        rows.value(chapter, &done, "energy imbalance", energy);
        let ended = match verdict {
            Verdict::Right => "right",
            Verdict::Warned => "warned",
            Verdict::Stopped => "stopped",
            Verdict::Refused => "refused",
            Verdict::Undetected => "**undetected**",
        };
        rows.word(chapter, &done, "ended", ended);
        rows.word(chapter, &done, "seen", &seen.replace('|', "/"));
    }
}

pub(crate) fn measure(runner: &Runner<'_>, rows: &mut Rows) -> Result<Answer> {
    let (onset, growth) = limit::cases()?;
    let (long, spin) = long::cases()?;
    let bars = bars::cases(rows)?;
    let small = [onset, bars, blocks::poisson()?, blocks::shapes()?, long, blocks::loads()?];
    CHAPTERS.into_iter().zip(small).for_each(|(chapter, cases)| put(rows, chapter, cases));
    runner.host.say("small models are done");
    let plan = Plan::read(runner.study)?;
    for group in &plan.groups {
        put(rows, &group.table, bearings::cases(runner, &plan, group)?);
    }
    let drawn = plan.figures.iter().map(|drawing| drawing.of(rows));
    for picture in [growth, spin].into_iter().chain(drawn) {
        figure::draw(runner.study, &picture)?;
    }
    let mut all = rows.clone();
    derive(&mut all);
    let is_undetected = |case: &&String| all.get("cases", case, "ended") == Some("**undetected**");
    let undetected = all.variants("cases").iter().filter(is_undetected).count();
    let failure = (undetected > 0).then(|| format!("{undetected} cases ended wrong and undetected"));
    Ok(Answer { failure, ..Answer::default() })
}

/// All cases in one table, and how many of each chapter ended how.
pub(crate) fn derive(rows: &mut Rows) {
    for chapter in CHAPTERS {
        let cases = rows.variants(chapter);
        let ended = |case: &String| rows.get(chapter, case, "ended").unwrap_or_default().to_owned();
        let endings: Vec<String> = cases.iter().map(ended).collect();
        for (case, ended) in cases.iter().zip(&endings) {
            rows.word("cases", &format!("{chapter}: {case}"), "ended", ended);
        }
        rows.value("chapters", chapter, "all", cases.len() as f64);
        for word in ["right", "warned", "stopped", "refused"] {
            let count = endings.iter().filter(|ended| *ended == word).count();
            rows.value("chapters", chapter, word, count as f64);
        }
    }
}
