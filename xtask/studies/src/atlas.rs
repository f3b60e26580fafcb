//! `cargo xtask study atlas`: many bearings, many defects: whether each record is diagnosed correctly.

use std::fmt::Write;

use anyhow::Result;
use stribeck::new;
use stribeck_analysis::diagnosis::{DiagnosedFamily, DiagnosisFinding};
use stribeck_analysis::summary::{EnergyFinding, Summary};
use stribeck_diagnosis::Defect;
use stribeck_scene::scene::Scene;
use stribeck_theory::kinematics::off_multiple;

use crate::{Finished, Rows, Runner, Variant};

/// Rollers of light and medium series, and balls.
const BEARINGS: [&str; 12] = [
    "NU 203", "NU 205", "NU 206", "NU 208", "NU 210", "NU 212", "NU 305", "NU 308", "6203", "6205", "6305",
    "6307",
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
/// Energy that may be missing, of what contacts dissipate: more is warned of (`guards.energy_warning_percent`).
const LEDGER: f64 = 0.1;
/// Sidebands of six that make the right ones.
const SIDEBANDS: usize = 3;
/// Resolution of the repetition rate within a passage: impacts last about 1 ms, and three follow the first
/// one.
const RHYTHM: f64 = 0.04;

pub(crate) fn measure(runner: &Runner<'_>, rows: &mut Rows) -> Result<()> {
    let (mut cases, mut variants) = (Vec::new(), Vec::new());
    for bearing in BEARINGS {
        let short = bearing.to_lowercase().replace(' ', "");
        // The paths of scenes are below the root, and an absolute one is itself.
        let file = runner.folder.join(format!("{short}.ron"));
        std::fs::create_dir_all(&runner.folder)?;
        std::fs::write(&file, new::sound(bearing)?)?;
        for (defect, list, wanted) in DEFECTS {
            let scene = Variant::new(format!("{short}-{defect}"), &file.to_string_lossy(), &[]);
            cases.push((bearing, defect, wanted));
            variants.push(with_defect(scene, &Scene::read(&file)?, defect, list));
        }
    }
    let finished = runner.run(&variants)?;
    let (mut right, mut rightly) = (0, 0);
    for ((bearing, defect, wanted), variant) in cases.into_iter().zip(&variants) {
        let Some(run) = finished.iter().find(|run| run.variant.name == variant.name) else { continue };
        put(rows, run);
        let faults = faults(run, wanted);
        let said = run.numbers().and_then(|summary| summary.diagnosis.as_ref()).map(claimed);
        rows.word("claims", bearing, defect, &shown(said.as_deref(), faults.is_empty()));
        if !faults.is_empty() {
            rows.word("faults", &variant.name, "what", &faults.join("; "));
        }
        right += usize::from(faults.is_empty());
        rightly += usize::from(said.as_deref() == Some(wanted));
    }
    rows.values("matrix", "all", [("right", right as f64), ("claimed rightly", rightly as f64)]);
    Ok(())
}

/// The scene of a healthy bearing with a defect in proportion to its elements.
fn with_defect(mut variant: Variant, sound: &Scene, defect: &str, list: &str) -> Variant {
    if defect == "roller-spall" {
        let k = sound.kinematics();
        let apart_ms = 1e3 * RESOLUTIONS / off_multiple(2.0 * k.bsf_hz, k.shaft_hz);
        let duration_ms = apart_ms.ceil().clamp(ROLLER_MS, LONGEST_MS);
        variant = variant.with(format!("solver.duration_ms={duration_ms}"));
    }
    variant.with(format!("defects=[{}]", in_diameters(list, sound.bearing.roller_diameter_mm)))
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
fn faults(run: &Finished, wanted: &[&str]) -> Vec<String> {
    let summary = match &run.summary {
        Ok(summary) => summary,
        Err(why) => return vec![why.clone()],
    };
    let mut faults = Vec::new();
    let missing = imbalance(&summary.energy);
    if missing > LEDGER {
        faults.push(format!("{:.1} % of the energy is missing", 100.0 * missing));
    }
    let Some(diagnosis) = &summary.diagnosis else {
        faults.push("no diagnosis".to_owned());
        return faults;
    };
    for family in diagnosis.families.iter().filter(|family| family.name != Defect::Ftf) {
        match (wanted.contains(&family.name.name()), family.claimed) {
            (true, false) => faults.push(format!("{} not claimed", family.name)),
            (false, true) => faults.push(format!("{} wrongly claimed", family.name)),
            (true, true) => faults.extend(misplaced(family, summary, diagnosis.resolution_hz)),
            (false, false) => {}
        }
    }
    faults
}

/// Energy that is missing, of what contacts dissipate.
fn imbalance(energy: &EnergyFinding) -> f64 {
    energy.share_of_contacts.unwrap_or(energy.max_relative_error)
}

/// A family that is claimed at another place than the motion has it, or without its sidebands. Impacts of a spot
/// follow the spin of its element over all the record, or that under load where it slides elsewhere.
fn misplaced(family: &DiagnosedFamily, summary: &Summary, resolution_hz: f64) -> Option<String> {
    let measured = family.measured_hz?;
    let under_load = summary.kinematics.roller_spin_hz.filter(|_| family.name == Defect::Bsf);
    // A spot on a rolling element strikes twice a turn.
    let times = family.name.shocks_per_period();
    let resolution_hz = if family.in_passages { RHYTHM * times * measured } else { resolution_hz };
    let off = [family.from_motion_hz, under_load].into_iter().flatten();
    let off = off.map(|motion| times * (measured - motion) / resolution_hz);
    let off = off.min_by(|a, b| a.abs().total_cmp(&b.abs()))?;
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

fn put(rows: &mut Rows, run: &Finished) {
    let name = &run.variant.name;
    rows.value("ledger", name, "missing", run.numbers().map(|summary| imbalance(&summary.energy)));
    rows.value("load", name, "off", off_load(run));
    let Some(diagnosis) = run.numbers().and_then(|s| s.diagnosis.as_ref()) else { return };
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
    for (table, quantity) in [("ledger", "missing"), ("load", "off")] {
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
