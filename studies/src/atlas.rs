//! `cargo xtask study atlas`: many bearings, many defects: whether each record is diagnosed correctly.

use std::fmt::Write;

use anyhow::Result;
use stribeck_analysis::diagnosis::{DiagnosedFamily, DiagnosisFinding, analysis_in_noise};
use stribeck_analysis::record::Record;
use stribeck_diagnosis::Defect;
use stribeck_scene::scene::Scene;

use crate::{Finished, Host, Rows, Runner, Variant};

/// Fields that all cases share.
const SCENE: &str = "fixtures/scenes/atlas.ron";
/// Rollers of light and medium series, and balls; the first is the paper's bearing, which the scene has.
const BEARINGS: [&str; 12] = [
    "the paper’s",
    "NU 203",
    "NU 205",
    "NU 206",
    "NU 208",
    "NU 210",
    "NU 212",
    "NU 305",
    "NU 308",
    "6203",
    "6205",
    "6305",
];
/// Defects: the name, the list of `defects` by lengths in diameters of a roller (thousandths where a field
/// has micrometres), and the families they have.
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
        "(on: outer, form: spall(length_mm: {0.4}, depth_mm: {0.008})), \
         (on: inner, form: spall(length_mm: {0.4}, depth_mm: {0.008}))",
        &["BPFO", "BPFI"],
    ),
    (
        "waves",
        "(on: outer, form: waviness(order: 7, amplitude_um: {0.06})), \
         (on: inner, form: waviness(order: 9, amplitude_um: {0.06})), \
         (on: roller(2), form: diameter(larger_um: {-0.1}))",
        &[],
    ),
];
/// Bearing time for a spot on one rolling element, which is under the load a part of every turn of the cage
/// only [ms].
const ROLLER_MS: f64 = 2400.0;
/// Resolutions between a family and a multiple of the shaft, by which a record with slip tells them apart, and the
/// longest record that is made for them [ms].
const RESOLUTIONS: f64 = 2.0;
const LONGEST_MS: f64 = 8000.0;
/// Passages of rollers over the outer raceway in a run of the full model.
const PASSAGES: f64 = 1.5;
/// White noise that is laid over records, its rms over that of the record.
const NOISE: f64 = 0.5;
/// Energy that may be missing from a run that is all right.
const LEDGER: f64 = 0.01;
/// Sidebands of six that make the right ones.
const SIDEBANDS: usize = 3;
/// Resolution of the repetition rate within a passage: knocks last about 1 ms, and three follow the first
/// one.
const RHYTHM: f64 = 0.04;

pub(crate) fn measure(runner: &Runner<'_>, rows: &mut Rows) -> Result<()> {
    let (mut cases, mut reduced, mut full) = (Vec::new(), Vec::new(), Vec::new());
    for bearing in BEARINGS {
        for (defect, list, wanted) in DEFECTS {
            let (variant, scene) = variant(runner.host, bearing, defect, list)?;
            let passage_ms = 1e3 * PASSAGES / scene.kinematics().bpfo_hz;
            let short = format!("solver.duration_ms={}", (100.0 * passage_ms).ceil() / 100.0);
            let own = Variant { name: format!("{}-full", variant.name), ..variant.clone() };
            full.push(own.with("model=full").with(short));
            cases.push((bearing, defect, wanted, variant.name.clone()));
            reduced.push(variant);
        }
    }

    let (reduced, full) = (runner.run(&reduced)?, runner.run(&full)?);
    let (mut right, mut rightly, mut by_full, mut in_noise, mut falsely) = (0, 0, 0, 0, 0);
    for (bearing, defect, wanted, name) in cases {
        let Some(run) = reduced.iter().find(|run| run.variant.name == name) else { continue };
        let full = full.iter().find(|run| run.variant.name == format!("{name}-full"));
        put(rows, &name, run, full);
        let faults = faults(run, full, wanted);
        let diagnosis = run.numbers().and_then(|summary| summary.diagnosis.as_ref());
        let said = diagnosis.map(claimed);
        rows.word("claims", bearing, defect, &shown(said.as_deref(), faults.is_empty()));
        if !faults.is_empty() {
            rows.word("faults", &name, "what", &faults.join("; "));
        }
        let noisy = claimed_in_noise(run);
        let is_right = noisy.as_deref() == Some(wanted);
        rows.word("claims in noise", bearing, defect, &shown(noisy.as_deref(), is_right));
        right += usize::from(faults.is_empty());
        rightly += usize::from(said.as_deref() == Some(wanted));
        by_full += usize::from(full.is_some());
        in_noise += usize::from(is_right);
        falsely += usize::from(noisy.is_some_and(|names| names.iter().any(|name| !wanted.contains(name))));
    }
    let counts = [("right", right), ("by the full model, too", by_full), ("claimed rightly", rightly)];
    rows.values("matrix", "all", counts.map(|(what, n)| (what, n as f64)));
    rows.values("noise", "all", [("claimed rightly", in_noise as f64), ("claimed falsely", falsely as f64)]);
    Ok(())
}

/// A bearing with a defect in proportion to its rollers.
fn variant(host: &Host, bearing: &str, defect: &str, list: &str) -> Result<(Variant, Scene)> {
    let is_papers = bearing == BEARINGS[0];
    let short = if is_papers { "paper".to_owned() } else { bearing.to_lowercase().replace(' ', "") };
    let mut variant = Variant::new(format!("{short}-{defect}"), SCENE, &[]);
    if !is_papers {
        variant = variant.with(format!("bearing={bearing}"));
    }
    let plain = Scene::read_with(host.root().join(SCENE), &variant.set)?;
    let k = plain.kinematics();
    let (least_ms, knocks_hz) = match defect {
        "roller-spall" => (ROLLER_MS, vec![2.0 * k.bsf_hz]),
        _ => (plain.solver.duration_ms, vec![k.bpfo_hz, k.bpfi_hz]),
    };
    let off_shaft = |hz: &f64| (hz - (hz / k.shaft_hz).round() * k.shaft_hz).abs();
    let nearest_hz = knocks_hz.iter().map(off_shaft).fold(f64::INFINITY, f64::min);
    let duration_ms = (1e3 * RESOLUTIONS / nearest_hz).ceil().min(LONGEST_MS).max(least_ms);
    variant = variant.with(format!("solver.duration_ms={duration_ms}"));
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

/// Faults of a case; empty when there are none.
fn faults(reduced: &Finished, full: Option<&Finished>, wanted: &[&str]) -> Vec<String> {
    let mut faults = Vec::new();
    for (model, run) in [("reduced", Some(reduced)), ("full", full)] {
        match run.map(|run| &run.summary) {
            Some(Err(why)) => faults.push(format!("{model}: {why}")),
            Some(Ok(summary)) if summary.energy.max_relative_error > LEDGER => {
                faults.push(format!("{model}: ledger {:.1} %", 100.0 * summary.energy.max_relative_error));
            }
            _ => {}
        }
    }
    let Some(summary) = reduced.numbers() else { return faults };
    let Some(diagnosis) = &summary.diagnosis else {
        faults.push("no diagnosis".to_owned());
        return faults;
    };
    for family in diagnosis.families.iter().filter(|family| family.name != Defect::Ftf) {
        match (wanted.contains(&family.name.name()), family.claimed) {
            (true, false) => faults.push(format!("{} not claimed", family.name)),
            (false, true) => faults.push(format!("{} wrongly claimed", family.name)),
            (true, true) => faults.extend(misplaced(family, diagnosis)),
            (false, false) => {}
        }
    }
    faults
}

/// A family that is claimed at another place than the motion has it, or without its sidebands.
fn misplaced(family: &DiagnosedFamily, diagnosis: &DiagnosisFinding) -> Option<String> {
    let (measured, motion) = family.measured_hz.zip(family.from_motion_hz)?;
    // A spot on a rolling element strikes twice a turn.
    let times = family.name.shocks_per_period();
    let resolution_hz = if family.in_passages { RHYTHM * times * measured } else { diagnosis.resolution_hz };
    let off = times * (measured - motion) / resolution_hz;
    if off.abs() > 1.0 {
        return Some(format!("{} {off:.1} resolutions from the motion", family.name));
    }
    let sides = family.sidebands.as_ref()?;
    (sides.seen < SIDEBANDS)
        .then(|| format!("{} of 6 sidebands of the {} beside {}", sides.seen, sides.of, family.name))
}

fn claimed(diagnosis: &DiagnosisFinding) -> Vec<&'static str> {
    diagnosis.families.iter().filter(|f| f.claimed).map(|f| f.name.name()).collect()
}

fn claimed_in_noise(run: &Finished) -> Option<Vec<&'static str>> {
    let channel = &run.numbers()?.diagnosis.as_ref()?.channel;
    let read = run.trace()?;
    let record = Record::new(&read).ok()?;
    let expected = run.written.kinematics();
    let judged = analysis_in_noise(&run.scene, &record, &expected, channel, NOISE).ok()??;
    Some(judged.findings.families.iter().filter(|f| f.claimed).map(|f| f.name.name()).collect())
}

/// What is claimed, bold where something is wrong.
fn shown(names: Option<&[&str]>, is_right: bool) -> String {
    let said = match names {
        None => "no run".to_owned(),
        Some([]) => "none".to_owned(),
        Some(names) => names.join(" + "),
    };
    if is_right { said } else { format!("**{said}**") }
}

/// Difference of the mean load on the rollers from their static load.
fn off_load(run: &Finished) -> Option<f64> {
    let load = &run.numbers()?.load;
    Some((load.mean_n? / load.expected_n - 1.0).abs())
}

fn put(rows: &mut Rows, name: &str, reduced: &Finished, full: Option<&Finished>) {
    let error = |run: Option<&Finished>| Some(run?.numbers()?.energy.max_relative_error);
    rows.values("ledger", name, [("reduced", error(Some(reduced))), ("full", error(full))]);
    rows.value("load", name, "off", off_load(reduced));
    let Some(diagnosis) = reduced.numbers().and_then(|s| s.diagnosis.as_ref()) else { return };
    for family in &diagnosis.families {
        let flag = |of: bool| Some(f64::from(u8::from(of)));
        let values = [
            ("expected Hz", Some(family.expected_hz)),
            ("by motion Hz", family.from_motion_hz),
            ("measured Hz", family.measured_hz),
            ("height dB", family.level_db),
            ("claimed", flag(family.claimed)),
            ("in passages", flag(family.in_passages)),
            ("sidebands of six", family.sidebands.as_ref().map(|sides| sides.seen as f64)),
        ];
        rows.values("families", name, values.map(|(what, value)| (format!("{} {what}", family.name), value)));
    }
}

/// The worst over all cases: energy that is missing, and how far the load is off.
pub(crate) fn derive(rows: &mut Rows) {
    for (table, quantity) in [("ledger", "reduced"), ("ledger", "full"), ("load", "off")] {
        let worst = rows.column(table, quantity).into_iter().map(|(_, value)| value).reduce(f64::max);
        rows.value("worst", table, quantity, worst);
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
