//! `cargo xtask study atlas`: many bearings, many defects.

use std::fmt::Write;

use anyhow::Result;
use stribeck_analysis::defect::Defect;
use stribeck_analysis::diagnosis::{DiagnosedFamily, DiagnosisFinding, analysis_in_noise};
use stribeck_analysis::record::Record;
use stribeck_scene::scene::Scene;
use stribeck_store::run_dir::Run;

use crate::table::number;
use crate::{Answer, Finished, Flags, Host, Runner, Sheet, Variant};

/// Flags of `study atlas`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[command(flatten)]
    flags: Flags,
}

/// Fields that all cases share.
const SCENE: &str = "fixtures/scenes/atlas.ron";

/// The paper's bearing, rollers of light and medium series, and balls; `""` is the paper's.
const BEARINGS: [&str; 12] = [
    "", "NU 203", "NU 205", "NU 206", "NU 208", "NU 210", "NU 212", "NU 305", "NU 308", "6203", "6205",
    "6305",
];

/// Defects of the columns: the name, the list of `defects` by lengths in diameters of a roller (thousandths
/// where a field has micrometres), and the families they have.
const DEFECTS: [(&str, &str, &[&str]); 8] = [
    ("outer-spall", "(on: outer, form: spall(length_mm: {0.4}, depth_mm: {0.008}))", &["BPFO"]),
    ("inner-spall", "(on: inner, form: spall(length_mm: {0.4}, depth_mm: {0.008}))", &["BPFI"]),
    ("roller-spall", "(on: roller(1), form: spall(length_mm: {0.25}, depth_mm: {0.004}))", &["BSF"]),
    ("outer-dent", "(on: outer, form: dent(length_mm: {0.25}, depth_mm: {0.005}, rim_um: {0.3}))", &["BPFO"]),
    ("inner-dent", "(on: inner, form: dent(length_mm: {0.25}, depth_mm: {0.005}, rim_um: {0.3}))", &["BPFI"]),
    (
        "rounded",
        "(on: outer, form: spall(length_mm: {0.5}, depth_mm: {0.008}, edge_mm: {0.12}, edge: rounded))",
        &["BPFO"],
    ),
    (
        "two",
        "(on: outer, form: spall(length_mm: {0.4}, depth_mm: {0.008})), (on: inner, form: spall(length_mm: \
         {0.4}, depth_mm: {0.008}))",
        &["BPFO", "BPFI"],
    ),
    (
        "waves",
        "(on: outer, form: waviness(order: 7, amplitude_um: {0.06})), (on: inner, form: waviness(order: 9, \
         amplitude_um: {0.06})), \
         (on: roller(2), form: diameter(larger_um: {-0.1}))",
        &[],
    ),
];

/// Bearing time for a spot on one rolling element, which is under the load a part of every turn of the cage
/// only [ms].
const ROLLER_MS: f64 = 2400.0;

/// Passages of rollers over the outer raceway in a run of the full model.
const PASSAGES: f64 = 1.5;

/// One field of the matrix.
struct Cell<'a> {
    bearing: &'static str,
    defect: &'static str,
    wanted: &'static [&'static str],
    reduced: &'a Finished,
    full: Option<&'a Finished>,
}

pub(crate) fn run(options: &Options, host: &dyn Host) -> Result<Answer> {
    let runner = Runner::new("atlas", &options.flags, host);
    let (mut reduced, mut full) = (Vec::new(), Vec::new());
    for bearing in BEARINGS {
        for (name, list, _) in DEFECTS {
            let variant = variant(host, bearing, name, list)?;
            let passage_ms = 1e3 * PASSAGES / variant.1.kinematics().bpfo_hz;
            let short = format!("solver.duration_ms={}", (100.0 * passage_ms).ceil() / 100.0);
            let own = Variant { name: format!("{}-full", variant.0.name), ..variant.0.clone() };
            full.push(own.with("model=full").with(short));
            reduced.push(variant.0);
        }
    }
    let long = runner.run(&reduced)?;
    let short = runner.run(&full)?;
    let cells: Vec<Cell<'_>> = BEARINGS
        .iter()
        .flat_map(|bearing| DEFECTS.map(|(defect, _, wanted)| (*bearing, defect, wanted)))
        .filter_map(|(bearing, defect, wanted)| {
            let name = name_of(bearing, defect);
            let found = |all: &'_ [Finished], name: &str| all.iter().position(|run| run.variant.name == name);
            let reduced = &long[found(&long, &name)?];
            let full = found(&short, &format!("{name}-full")).map(|at| &short[at]);
            Some(Cell { bearing, defect, wanted, reduced, full })
        })
        .collect();
    let mut sheet = Sheet::new(host.root(), "atlas", "An atlas of bearings and defects");
    introduce(&mut sheet);
    matrix(&mut sheet, &cells);
    failures(&mut sheet, &cells);
    noise(&mut sheet, &cells);
    balance(&mut sheet, &cells);
    values(&mut sheet, &cells);
    Ok(Answer::on(sheet.write()?))
}

fn spoken(bearing: &'static str) -> &'static str {
    if bearing.is_empty() { "the paper\u{2019}s" } else { bearing }
}

fn name_of(bearing: &str, defect: &str) -> String {
    let bearing =
        if bearing.is_empty() { "paper".to_owned() } else { bearing.to_lowercase().replace(' ', "") };
    format!("{bearing}-{defect}")
}

/// A bearing with a defect in proportion to its rollers.
fn variant(host: &dyn Host, bearing: &str, defect: &str, list: &str) -> Result<(Variant, Scene)> {
    let mut variant = Variant::new(name_of(bearing, defect), SCENE, &[]);
    if !bearing.is_empty() {
        variant = variant.with(format!("bearing={bearing}"));
    }
    if defect == "roller-spall" {
        variant = variant.with(format!("solver.duration_ms={ROLLER_MS}"));
    }
    let plain = Scene::read_with(host.root().join(SCENE), &variant.set)?;
    let roller = plain.bearing.roller_diameter_mm;
    // A cage of the paper's proportions: its corners touch rollers above their middles, so that they guide
    // it.
    let cage = 0.22 * roller;
    let digits = |mm: f64| (1e3 * mm).round() / 1e3;
    variant = variant
        .with(format!("cage.outer_diameter_mm={}", digits(plain.bearing.outer_race_diameter_mm - cage)))
        .with(format!("cage.thickness_mm={}", digits(cage)))
        .with(format!("defects=[{}]", in_diameters(list, roller)));
    let scene = Scene::read_with(host.root().join(SCENE), &variant.set)?;
    Ok((variant, scene))
}

/// The text with every number in braces, in diameters of a roller, in millimetres; thousandths of a diameter,
/// in micrometres.
fn in_diameters(list: &str, roller_mm: f64) -> String {
    let mut text = String::new();
    let mut rest = list;
    while let Some((before, after)) = rest.split_once('{') {
        let (share, after) = after.split_once('}').unwrap_or((after, ""));
        let share: f64 = share.parse().unwrap_or(f64::NAN);
        let _ = write!(text, "{before}{:.4}", share * roller_mm);
        rest = after;
    }
    text + rest
}

/// Faults of a field; empty when there are none.
fn faults(cell: &Cell<'_>) -> Vec<String> {
    let mut faults = Vec::new();
    for (model, run) in [("reduced", cell.reduced)].into_iter().chain(cell.full.map(|full| ("full", full))) {
        match run.numbers() {
            None => {
                let why = run.summary.as_ref().err().map_or("", String::as_str);
                faults.push(format!("{model}: {why}"));
            }
            Some(summary) if summary.energy.max_relative_error > LEDGER => {
                faults.push(format!(
                    "{model}: ledger {} %",
                    number(100.0 * summary.energy.max_relative_error, 1)
                ));
            }
            _ => {}
        }
    }
    let Some(summary) = cell.reduced.numbers() else { return faults };
    let Some(diagnosis) = &summary.diagnosis else {
        faults.push("no diagnosis".to_owned());
        return faults;
    };
    for family in diagnosis.families.iter().filter(|family| family.name != Defect::Ftf) {
        let wanted = cell.wanted.contains(&family.name.name());
        match (wanted, family.claimed) {
            (true, false) => faults.push(format!("{} not claimed: {}", family.name, family.reason)),
            (false, true) => faults.push(format!("{} claimed, and there is none", family.name)),
            (true, true) => faults.extend(misplaced(family, diagnosis)),
            (false, false) => {}
        }
    }
    faults
}

/// Energy that may be missing from a run that is all right.
const LEDGER: f64 = 0.01;

/// Sidebands of six that make the right ones.
const SIDEBANDS: usize = 3;

/// Resolution of the repetition rate within a passage: knocks last about 1 ms, and three follow the first
/// one.
const RHYTHM: f64 = 0.04;

/// A family that is claimed at another place than the motion has it, or without its sidebands.
fn misplaced(family: &DiagnosedFamily, diagnosis: &DiagnosisFinding) -> Option<String> {
    let (measured, motion) = family.measured_hz.zip(family.from_motion_hz)?;
    // A spot on a rolling element strikes twice a turn.
    let times = family.name.shocks_per_period();
    let resolution_hz = if family.in_passages { RHYTHM * times * measured } else { diagnosis.resolution_hz };
    let off = times * (measured - motion) / resolution_hz;
    if off.abs() > 1.0 {
        return Some(format!("{} {} resolutions from the motion", family.name, number(off, 1)));
    }
    let sides = family.sidebands.as_ref()?;
    (sides.seen < SIDEBANDS)
        .then(|| format!("{} of 6 sidebands of the {} beside {}", sides.seen, sides.of, family.name))
}

fn introduce(sheet: &mut Sheet) {
    sheet.say(
        "Does a defect in a scene come out as what it is? Every bearing runs with every defect, in \
         proportion to its rollers: 0.8 s at \
         1500 rpm by the reduced model, 2.4 s with a spot on one rolling element, which is loaded a part of \
         every turn of the cage only, and one and a half passages of a roller by the full one. The record of \
         the first sensor is then judged as \
         one from a machine would be, without the scene (`stribeck analyse`, THEORY §7.9): it is right when \
         it claims every family of the scene's defects \
         and no other, each within one resolution of the recorded motion and, for BPFI and BSF, with three \
         of the six sidebands at the shaft\u{2019}s and \
         the cage\u{2019}s distance (a BSF that is told by the rhythm of its knocks within a passage has no \
         lines, and its frequency is to be within \
         4 % of the motion\u{2019}s), and when each model that has run it ends with less than 1 % of the \
         energy missing. *waves* have no defect: two raceways with \
         waviness and a roller that is too small.",
    );
}

fn matrix(sheet: &mut Sheet, cells: &[Cell<'_>]) {
    sheet.heading("The matrix");
    fields(sheet, cells, short);
    let right = cells.iter().filter(|cell| faults(cell).is_empty()).count();
    let claims = cells.iter().filter(|cell| claimed_rightly(cell)).count();
    let full = cells.iter().filter(|cell| cell.full.is_some()).count();
    sheet.value("matrix", "all", "right", Some(right as f64));
    sheet.value("matrix", "all", "by the full model, too", Some(full as f64));
    sheet.value("matrix", "all", "claimed rightly", Some(claims as f64));
    sheet.say(&format!(
        "In each field what the record was said to show; **bold** where something is wrong, which the next \
         table names. Of {} fields {claims} \
         claim what is there and nothing else, and {right} are right in everything; {full} have been run by \
         the full model, too.",
        cells.len()
    ));
}

/// A table of all fields.
fn fields(sheet: &mut Sheet, cells: &[Cell<'_>], say: impl Fn(&Cell<'_>) -> String) {
    let names: Vec<&str> = std::iter::once("bearing").chain(DEFECTS.iter().map(|d| d.0)).collect();
    let rows: Vec<Vec<String>> = BEARINGS
        .iter()
        .map(|bearing| {
            let mut row = vec![spoken(bearing).to_owned()];
            row.extend(DEFECTS.map(|(defect, ..)| {
                let cell = cells.iter().find(|c| c.bearing == *bearing && c.defect == defect);
                cell.map_or("–".to_owned(), &say)
            }));
            row
        })
        .collect();
    sheet.table(&names, &rows);
}

/// The claimed family of a record.
fn short(cell: &Cell<'_>) -> String {
    let claimed = |d: &DiagnosisFinding| {
        let names: Vec<&str> = d.families.iter().filter(|f| f.claimed).map(|f| f.name.name()).collect();
        listed(&names)
    };
    let diagnosis = cell.reduced.numbers().and_then(|summary| summary.diagnosis.as_ref());
    let said = diagnosis.map_or("no run".to_owned(), claimed);
    if faults(cell).is_empty() { said } else { format!("**{said}**") }
}

fn listed(names: &[&str]) -> String {
    if names.is_empty() { "none".to_owned() } else { names.join(" + ") }
}

/// White noise that is laid over records, its rms over that of the record.
const NOISE: f64 = 0.5;

/// The claims in the noise that a machine would have.
fn noise(sheet: &mut Sheet, cells: &[Cell<'_>]) {
    sheet.heading("In noise");
    let said: Vec<(&Cell<'_>, Option<Vec<&'static str>>)> =
        cells.iter().map(|cell| (cell, claimed_in_noise(cell))).collect();
    let right = |cell: &Cell<'_>, names: &Vec<&str>| names.as_slice() == cell.wanted;
    let all = said.iter().filter(|(cell, names)| names.as_ref().is_some_and(|n| right(cell, n))).count();
    let false_ones = said.iter().filter(|(cell, names)| {
        names.as_ref().is_some_and(|names| names.iter().any(|name| !cell.wanted.contains(name)))
    });
    sheet.value("noise", "all", "claimed rightly", Some(all as f64));
    let false_ones = false_ones.count();
    sheet.value("noise", "all", "claimed falsely", Some(false_ones as f64));
    sheet.say(&format!(
        "A run has no noise but its bearing's, and what elements rattle as they come under the load is then \
         all there is: it swings the power of \
         a sound bearing's record as knocks do. A machine has more. With white noise over the record, its \
         rms {} % of the record's own, the claims are \
         those below: {all} of {} fields claim what is there and nothing else, and {false_ones} claim \
         something that is not there.",
        number(100.0 * NOISE, 0),
        cells.len()
    ));
    fields(sheet, cells, |cell| {
        let found = said.iter().find(|(c, _)| c.bearing == cell.bearing && c.defect == cell.defect);
        match found.and_then(|(_, names)| names.as_ref()) {
            None => "no run".to_owned(),
            Some(names) if right(cell, names) => listed(names),
            Some(names) => format!("**{}**", listed(names)),
        }
    });
}

fn claimed_in_noise(cell: &Cell<'_>) -> Option<Vec<&'static str>> {
    let run = cell.reduced;
    let channel = &run.numbers()?.diagnosis.as_ref()?.channel;
    let read = Run::read(&run.folder).ok()?;
    let record = Record::new(&read).ok()?;
    let expected = run.scene.written.kinematics();
    let judged = analysis_in_noise(&run.scene, &record, &expected, channel, NOISE).ok()??;
    Some(judged.findings.families.iter().filter(|f| f.claimed).map(|f| f.name.name()).collect())
}

fn claimed_rightly(cell: &Cell<'_>) -> bool {
    let diagnosis = cell.reduced.numbers().and_then(|summary| summary.diagnosis.as_ref());
    diagnosis.is_some_and(|d| d.families.iter().all(|f| f.claimed == cell.wanted.contains(&f.name.name())))
}

fn failures(sheet: &mut Sheet, cells: &[Cell<'_>]) {
    sheet.heading("What is wrong");
    let rows: Vec<Vec<String>> = cells
        .iter()
        .map(|cell| (cell, faults(cell)))
        .filter(|(_, faults)| !faults.is_empty())
        .map(|(cell, faults)| {
            vec![spoken(cell.bearing).to_owned(), cell.defect.to_owned(), faults.join("; ")]
        })
        .collect();
    if rows.is_empty() {
        sheet.say("Nothing.");
    } else {
        sheet.table(&["bearing", "defect", "what"], &rows);
    }
}

/// Energy and load of each bearing, its worst over the defects.
fn balance(sheet: &mut Sheet, cells: &[Cell<'_>]) {
    sheet.heading("Energy and load");
    sheet.say(
        "The worst over the defects of each bearing: energy that is missing at the end or on the way, over \
         the largest strain energy; and the mean force \
         through the rollers against load and weight.",
    );
    let rows: Vec<Vec<String>> = BEARINGS
        .iter()
        .map(|bearing| {
            let of = |run: fn(&Cell<'_>) -> Option<f64>| {
                let all = cells.iter().filter(|cell| cell.bearing == *bearing).filter_map(run);
                all.reduce(f64::max).map_or("–".to_owned(), |v| number(100.0 * v, 2))
            };
            vec![
                spoken(bearing).to_owned(),
                of(|cell| cell.reduced.numbers().map(|s| s.energy.max_relative_error)),
                of(|cell| cell.full?.numbers().map(|s| s.energy.max_relative_error)),
                of(|cell| off_load(cell.reduced)),
            ]
        })
        .collect();
    sheet.table(&["bearing", "ledger reduced, %", "ledger full, %", "load reduced, %"], &rows);
}

/// Difference of the mean load on the rollers from their static load.
fn off_load(run: &Finished) -> Option<f64> {
    let load = &run.numbers()?.load;
    Some((load.mean_n? / load.expected_n - 1.0).abs())
}

fn values(sheet: &mut Sheet, cells: &[Cell<'_>]) {
    for cell in cells {
        let name = &cell.reduced.variant.name;
        for (model, run) in [("reduced", Some(cell.reduced)), ("full", cell.full)] {
            let error = run.and_then(Finished::numbers).map(|s| s.energy.max_relative_error);
            sheet.value("ledger", name, model, error);
        }
        sheet.value("load", name, "off", off_load(cell.reduced));
        let Some(diagnosis) = cell.reduced.numbers().and_then(|s| s.diagnosis.as_ref()) else { continue };
        for family in &diagnosis.families {
            let what = |quantity: &str| format!("{} {quantity}", family.name);
            sheet.value("families", name, &what("expected Hz"), Some(family.expected_hz));
            sheet.value("families", name, &what("by motion Hz"), family.from_motion_hz);
            sheet.value("families", name, &what("measured Hz"), family.measured_hz);
            sheet.value("families", name, &what("height dB"), family.level_db);
            sheet.value("families", name, &what("claimed"), Some(f64::from(u8::from(family.claimed))));
            sheet.value(
                "families",
                name,
                &what("in passages"),
                Some(f64::from(u8::from(family.in_passages))),
            );
            let seen = family.sidebands.as_ref().map(|sides| sides.seen as f64);
            sheet.value("families", name, &what("sidebands of six"), seen);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_hand_lengths_are_written_in_the_unit_of_their_field() {
        let list = "(on: outer, form: dent(length_mm: {0.25}, depth_mm: {0.005}, rim_um: {0.3}))";
        let written = in_diameters(list, 8.0);
        assert_eq!(written, "(on: outer, form: dent(length_mm: 2.0000, depth_mm: 0.0400, rim_um: 2.4000))");
    }
}
