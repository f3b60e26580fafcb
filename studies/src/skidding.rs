//! `cargo xtask study skidding`: how far the cage and the rollers of a lightly loaded bearing lag behind.

use std::f64::consts::TAU;

use anyhow::Result;
use stribeck_analysis::record::Record;
use stribeck_store::run_dir::Run;

use crate::plan::Kernel;
use crate::{Finished, Plan, Rows, Runner, figure};

/// Slip is that over the last part of a record, and has settled if it was the same in the part before.
const PARTS: usize = 4;

const KERNELS: &[Kernel] = &[
    ("cage", |run| Some(cage_percent(run)?[1])),
    ("cage_before", |run| Some(cage_percent(run)?[0])),
    ("rollers", |run| {
        let k = &run.summary.as_ref().ok()?.kinematics;
        Some(100.0 * (1.0 - k.roller_spin_all_hz? / k.expected_roller_spin_hz))
    }),
    ("power_w", |run| Some(run.info.as_ref()?.energy.heat_j / run.scene.duration)),
    ("palmgren_w", |run| Some(palmgren_w(run))),
    ("energy", |run| Some(100.0 * run.info.as_ref()?.energy.of_larger())),
    ("load_n", |run| Some(run.scene.written.operation.load_n)),
    ("speed_rpm", |run| Some(run.scene.duty.speed_rpm(0.0))),
    ("viscosity", |run| Some(1e3 * run.scene.film?.viscosity)),
    ("clearance_um", |run| Some(1e6 * run.scene.clearance)),
];

pub(crate) fn measure(runner: &Runner<'_>, rows: &mut Rows) -> Result<()> {
    let plan = Plan::read(runner.study)?;
    plan.run(runner, KERNELS, rows)?;
    plan.figures.iter().try_for_each(|drawing| figure::draw(runner.study, &drawing.of(rows)))
}

/// By how much the cage lags in the last two parts of a record [%].
fn cage_percent(run: &Finished) -> Option<[f64; 2]> {
    let kept = Run::read(&run.folder).ok()?;
    let record = Record::whole(&kept).ok()?;
    let angle = record.channel("cage.angle_rad")?;
    let part = angle.len() / PARTS;
    let expected = TAU * run.written.kinematics().cage_hz * record.interval_s() * part as f64;
    let end = angle.len() - 1;
    Some([2, 1].map(|n| {
        let turned = angle[end + part - n * part] - angle[end - n * part];
        100.0 * (1.0 - turned.abs() / expected)
    }))
}

/// Power that the lubricant of a bearing takes by A. Palmgren (Grundlagen der Wälzlagertechnik, 3rd ed.,
/// Franckh 1964): f₀ (νn)^⅔ d_m³ 10⁻⁷ N mm, with f₀ = 2 for cylindrical rollers in little oil, ν in mm²/s
/// and n in rpm.
fn palmgren_w(run: &Finished) -> f64 {
    let viscosity = run.scene.film.map_or(0.0, |film| film.viscosity);
    let rpm = run.scene.duty.speed_rpm(0.0);
    let moment =
        2.0 * (1e6 * viscosity / 870.0 * rpm).powf(2.0 / 3.0) * (2e3 * run.scene.path_radius()).powi(3);
    1e-10 * moment * TAU * rpm / 60.0
}
