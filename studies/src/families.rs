//! `cargo xtask study families`: whether the family of lines of N_v facets is named rightly, for counts that
//! were not used to choose the threshold, and how often a comb that is not there would be.

use anyhow::Result;
use stribeck_analysis::families::{Candidate, FamilyFinding, Source, identify};
use stribeck_analysis::findings::Findings;
use stribeck_analysis::record::Record;
use stribeck_scene::dice::Dice;

use crate::{Finished, Plan, Rows, Runner};

/// False combs that are tried on each record, and the seed of them.
const FALSE_COMBS: usize = 24;
const SEED: u64 = 19;
/// They stand up to this far from the true one, in BPFO.
const FALSE_REACH: f64 = 3.0;

pub(crate) fn measure(runner: &Runner<'_>, rows: &mut Rows) -> Result<()> {
    let plan = Plan::read(runner.study)?;
    let groups = plan.run(runner, &[], rows)?;
    for (group, runs) in plan.groups.iter().zip(groups) {
        for run in &runs {
            let Some(summary) = run.numbers() else { continue };
            for (family, of) in summary.families.iter().zip(["verdict", "outer raceway", "inner raceway"]) {
                rows.word(&group.table, &run.variant.name, of, &in_a_word(family));
            }
            let scatter = summary.families.first().and_then(|f| f.offset_scatter_resolutions);
            rows.value(&group.table, &run.variant.name, "± channels", scatter);
        }
        if group.table != "arc" {
            let tried = try_false_combs(&runs)?;
            rows.value("false", &group.table, "records", runs.len() as f64);
            rows.values("false", &group.table, tried);
        }
    }
    Ok(())
}

fn in_a_word(family: &FamilyFinding) -> String {
    match (family.found, family.not_told_apart_from.is_empty(), family.lead) {
        (true, _, _) => "found".into(),
        (_, false, _) => format!("or {}", family.not_told_apart_from.join(" or ").replace('_', " ")),
        (_, _, Some(lead)) if family.is_open() => format!("open ({lead:.1})"),
        (_, _, Some(lead)) => format!("absent ({lead:.1})"),
        (_, _, None) => "not judged".into(),
    }
}

/// Offers combs beside the vertices of each record, one at a time: nodes of a raceway in numbers that the
/// bearing does not have.
fn try_false_combs(runs: &[Finished]) -> Result<[(&'static str, f64); 4]> {
    let (mut combs, mut found, mut unsure, mut highest) = (0.0, 0.0, 0.0, f64::NEG_INFINITY);
    for run in runs {
        let Some(read) = run.trace() else { continue };
        let findings = Findings::of(&Record::new(&read)?)?;
        let (motion, accelerations) = &findings.family_signals;
        let kinematics = &findings.prediction.kinematics;
        let count = findings.summary.mesh.roller_facets;
        let vertices =
            Candidate { name: "roller_vertices".into(), source: Source::RotatedVertices(count as f64) };
        let Some(true_hz) = findings.summary.families.first().and_then(|f| f.predicted_hz) else { continue };
        let mut dice = Dice::new(SEED + count as u64);
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
            combs += 1.0;
            found += f64::from(u8::from(family.found));
            unsure += f64::from(u8::from(!family.not_told_apart_from.is_empty()));
            highest = highest.max(family.lead.unwrap_or(f64::NEG_INFINITY));
        }
    }
    Ok([("combs", combs), ("found", found), ("not told apart", unsure), ("highest lead", highest)])
}
