//! `cargo xtask study families`: whether the family of lines of N_v facets is named rightly, for counts that
//! were not used to choose the threshold, and how often a comb that is not there would be.

use anyhow::Result;
use stribeck_analysis::families::{Candidate, FamilyFinding, Source, identify};
use stribeck_analysis::findings::Findings;
use stribeck_analysis::record::Record;
use stribeck_store::run_dir::Run;

use crate::table::number;
use crate::{Answer, Finished, Flags, Host, Runner, Sheet, Variant};
use stribeck_scene::dice::Dice;

/// Scene of all runs: chords, copies turned with the pattern.
const SCENE: &str = "fixtures/scenes/studies/lean.ron";
/// Counts by which the least lead was chosen.
const CALIBRATED: [usize; 5] = [91, 106, 112, 117, 122];
/// Counts that earlier versions of the test were tried on: never drawn.
const SEEN: [usize; 6] = [92, 100, 106, 112, 116, 122];
/// Counts whose carriers stand closest to those of the raceways.
const CLOSEST: [usize; 3] = [113, 114, 115];
/// The range of counts and how many are drawn from it.
const RANGE: std::ops::RangeInclusive<usize> = 90..=130;
const DRAWN: usize = 20;
const SEED: u64 = 19;
/// False combs that are tried on each record.
const FALSE_COMBS: usize = 24;
/// They stand up to this far from the true one, in BPFO.
const FALSE_REACH: f64 = 3.0;

/// Flags of `study families`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[command(flatten)]
    flags: Flags,
}

pub(crate) fn run(options: &Options, host: &dyn Host) -> Result<Answer> {
    let runner = Runner::new("families", &options.flags, host);
    let mut sheet = Sheet::new(host.root(), "families", "Families of facet lines: is the name right?");
    sheet.say(&format!(
        "The scene `lean` for 30 ms with rollers of N_v facets. Lines belong at N_v × spin + m × BPFO; the \
         method and its threshold \
         are those of THEORY §7.7. *Off* is the fitted carrier less the one by the recorded motion, in \
         resolutions of 33 Hz; *lead* \
         how far the comb is ahead of every other, where 0.3 count; the shares are those that the comb \
         explains of the accelerations \
         and of the roller forces in its band. The threshold was chosen on {CALIBRATED:?}. {DRAWN} counts \
         were then drawn from \
         {} to {} by the seed {SEED}; {CLOSEST:?}, whose carriers stand closest to those of the raceways, \
         were added.",
        RANGE.start(),
        RANGE.end()
    ));
    let mut rates = Vec::new();
    let drawn = drawn();
    for (id, title, counts) in [
        ("drawn", "Counts drawn by a seed", drawn.as_slice()),
        ("closest", "Counts next to the raceways\u{2019}", &CLOSEST),
        ("calibrated", "Counts that chose the threshold", &CALIBRATED),
    ] {
        let variants: Vec<Variant> = counts.iter().map(|&count| of_count(count)).collect();
        let runs = runner.run(&variants)?;
        sheet.heading(title);
        verdicts(&mut sheet, id, &runs);
        let tried = tally(&runs)?;
        sheet.value("false", id, "combs", Some(tried.combs as f64));
        sheet.value("false", id, "found", Some(tried.found as f64));
        sheet.value("false", id, "not told apart", Some(tried.unsure as f64));
        rates.push(vec![
            title.to_owned(),
            runs.len().to_string(),
            tried.combs.to_string(),
            tried.found.to_string(),
            tried.unsure.to_string(),
            number(tried.highest, 2),
        ]);
    }
    let arcs = Variant::new(
        "arc112",
        SCENE,
        &["mesh.roller_facets=112", "contact.surface=arc", "solver.duration_ms=30"],
    );
    let arcs = runner.run(&[arcs])?;
    sheet.heading("A record without facets");
    sheet.say("Contact on arcs, 112 facets: the polygons are there, but nothing rolls over their corners.");
    verdicts(&mut sheet, "arc", &arcs);
    sheet.heading("Names that nothing bears");
    sheet.say(&format!(
        "To each record {FALSE_COMBS} combs were offered beside its vertices, one at a time: nodes of an \
         outer or an inner raceway in \
         numbers that the bearing does not have, drawn so that their carriers lie within {FALSE_REACH} BPFO \
         of the true one."
    ));
    sheet.table(&["counts", "records", "false combs", "found", "not told apart", "highest lead"], &rates);
    Ok(Answer::on(sheet.write()?))
}

/// Counts drawn without replacement, ascending.
fn drawn() -> Vec<usize> {
    let mut pool: Vec<usize> = RANGE.filter(|count| !SEEN.contains(count)).collect();
    let mut dice = Dice::new(SEED);
    let mut drawn: Vec<usize> = (0..DRAWN).map(|_| pool.remove(dice.below(pool.len()))).collect();
    drawn.sort_unstable();
    drawn
}

fn of_count(count: usize) -> Variant {
    Variant::new(format!("n{count}"), SCENE, &["solver.duration_ms=30"])
        .with(format!("mesh.roller_facets={count}"))
}

/// One row a record.
fn verdicts(sheet: &mut Sheet, id: &str, runs: &[Finished]) {
    let names = [
        "N_v",
        "predicted Hz",
        "carrier Hz",
        "off",
        "± channels",
        "lead",
        "accelerations %",
        "forces %",
        "verdict",
        "outer raceway",
        "inner raceway",
    ];
    let mut rows = Vec::new();
    for run in runs {
        let Some(summary) = run.numbers() else { continue };
        let Some(family) = summary.families.first() else { continue };
        let cell = |value: Option<f64>, decimals| value.map_or("–".to_owned(), |v| number(v, decimals));
        let percent = |share: Option<f64>| cell(share.map(|s| 100.0 * s), 0);
        let name = &run.variant.name;
        for (quantity, value) in [
            ("predicted Hz", family.predicted_hz),
            ("carrier Hz", family.carrier_hz),
            ("offset resolutions", family.offset_resolutions),
            ("lead", family.lead),
            ("explained", family.explained),
            ("explained forces", family.explained_forces),
        ] {
            sheet.value(id, name, quantity, value);
        }
        let others: Vec<String> = summary.families.iter().skip(1).map(in_a_word).collect();
        sheet.word(id, name, "verdict", &in_a_word(family));
        let mut row = vec![
            name.trim_start_matches(char::is_alphabetic).to_owned(),
            cell(family.predicted_hz, 0),
            cell(family.carrier_hz, 0),
            cell(family.offset_resolutions, 1),
            cell(family.offset_scatter_resolutions, 1),
            cell(family.lead, 2),
            percent(family.explained),
            percent(family.explained_forces),
            in_a_word(family),
        ];
        row.extend(others);
        rows.push(row);
    }
    sheet.table(&names, &rows);
}

fn in_a_word(family: &FamilyFinding) -> String {
    match (family.found, family.not_told_apart_from.is_empty(), family.lead) {
        (true, _, _) => "found".into(),
        (_, false, _) => format!("or {}", family.not_told_apart_from.join(" or ").replace('_', " ")),
        (_, _, Some(lead)) => format!("absent ({})", number(lead, 1)),
        (_, _, None) => "not judged".into(),
    }
}

/// Results for combs that are not there.
#[derive(Default)]
struct Tally {
    combs: usize,
    found: usize,
    unsure: usize,
    highest: f64,
}

fn tally(runs: &[Finished]) -> Result<Tally> {
    let mut tally = Tally { highest: f64::NEG_INFINITY, ..Tally::default() };
    for run in runs.iter().filter(|run| run.numbers().is_some()) {
        let findings = Findings::of(&Record::new(&Run::read(&run.folder)?)?)?;
        let (motion, accelerations) = &findings.family_signals;
        let kinematics = &findings.prediction.kinematics;
        let count = findings.summary.mesh.roller_facets as f64;
        let vertices = Candidate { name: "roller_vertices".into(), source: Source::RotatedVertices(count) };
        let Some(true_hz) = findings.summary.families.first().and_then(|f| f.predicted_hz) else { continue };
        let mut dice = Dice::new(SEED + findings.summary.mesh.roller_facets as u64);
        for number in 0..FALSE_COMBS {
            let hz = true_hz + FALSE_REACH * (2.0 * dice.share() - 1.0) * motion.bpfo_hz;
            let source = if number % 2 == 0 {
                Source::OuterNodes((hz / kinematics.cage_on_outer_hz).round())
            } else {
                Source::InnerNodes((hz / kinematics.cage_on_inner_hz).round())
            };
            let nobody = Candidate { name: "nobody".into(), source };
            let judged = identify(motion, &[vertices.clone(), nobody], accelerations)?;
            let Some(family) = judged.last() else { continue };
            tally.combs += 1;
            tally.found += usize::from(family.found);
            tally.unsure += usize::from(!family.not_told_apart_from.is_empty());
            tally.highest = tally.highest.max(family.lead.unwrap_or(f64::NEG_INFINITY));
        }
    }
    Ok(tally)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn invariant_drawn_counts_were_not_seen() {
        let drawn = drawn();
        assert_eq!(drawn.len(), DRAWN);
        assert!(drawn.windows(2).all(|pair| pair[0] < pair[1]) && drawn.iter().all(|n| RANGE.contains(n)));
        for used in CALIBRATED.iter().chain(&CLOSEST) {
            assert!(!drawn.contains(used), "{used} chose the threshold or is tested anyway");
        }
    }
}
