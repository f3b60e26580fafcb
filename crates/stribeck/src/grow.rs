//! `stribeck grow`: spalls of several units grow by a law, and each unit is recorded at intervals: a
//! campaign, whose trends and remaining lives get a page of their own.

mod records;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result};
use stribeck_analysis::growth::Law;
use stribeck_analysis::records::normal;
use stribeck_formats::parquet::{Column, Values, write_table};
use stribeck_plans::campaign::Campaign;
use stribeck_plans::growth::Growth;
use stribeck_report::{GrowthFindings, write_growth};
use stribeck_scene::dice::Dice;
use stribeck_scene::scene::Scene;
use stribeck_store::run_dir::{check_folder, write_atomic};

use crate::campaign::{CAMPAIGN, GROWTH_TABLE as TABLE, MARKS, carry_out};
use crate::many_runs::Share;
use crate::out::{say, tell};
use crate::place::{Place, shown};
use crate::sweep::relative;

/// Flags of `grow`.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// Growth file, such as fixtures/growth/quick.ron
    file: PathBuf,
    /// Folder [default: runs/NAME, the name in the file]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    share: Share,
}

/// One record that is to be made.
struct Planned {
    unit: usize,
    revolutions: f64,
    length_mm: Option<f64>,
    depth_mm: Option<f64>,
    speed_rpm: f64,
    load_n: f64,
    onset: f64,
    end: f64,
}

pub(crate) fn run(options: &Options, place: &Place) -> Result<ExitCode> {
    let path = place.locate(&options.file);
    let growth = Growth::read(&path)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let base = growth.scene.as_ref().map(|scene| folder.join(scene));
    let scene = match &base {
        Some(base) => Scene::read_with(base, &growth.set)?,
        None => Scene::singh2014().with_overrides(&growth.set)?,
    };
    let law = law_of(&growth);
    let planned = planned(&growth, &law, &scene)?;
    let out = options.out.clone().unwrap_or_else(|| place.runs().join(&growth.name));
    check_folder(&out, &MARKS)?;
    std::fs::create_dir_all(&out).with_context(|| format!("cannot make `{}`", shown(&out)))?;
    let base = base.map(|base| relative(&base, &out)).transpose()?;
    let text = campaign(&growth, base.as_deref());
    let rows = table(&growth, &planned);
    match std::fs::read_to_string(out.join(TABLE)) {
        Ok(there) => anyhow::ensure!(
            there == rows,
            "`{}` holds another growth, or an earlier text of this one: give a folder with `--out`",
            shown(&out)
        ),
        Err(_) => write_atomic(&out.join(TABLE), rows.as_bytes())?,
    }
    let campaign = Campaign::parse(&text, &shown(&out.join(CAMPAIGN)), &out)?;
    tell!("{} units, {} records until the last of them is at its end", growth.units, planned.len());
    let code = carry_out(&campaign, out.clone(), options.share, None)?;
    if !out.join(MARKS[1]).exists() {
        return Ok(code);
    }
    let findings = records::judged(&growth, &law, &planned, &campaign, &out)?;
    write_growth(&out, &findings)?;
    write_table(&out.join("growth.parquet"), &columns(&findings), &[])?;
    let [held, among] = findings.held;
    say!("{held} of {among} intervals of 90 % of what is left hold the truth");
    say!("page: {}", shown(&out.join("growth.html")));
    Ok(code)
}

/// The law by which its spalls grow.
fn law_of(growth: &Growth) -> Law {
    Law {
        onset: (growth.onset.revolutions, growth.onset.scatter),
        life: (growth.life.revolutions, growth.life.scatter),
        wander: growth.wander,
        length_mm: (growth.length_mm.from, growth.length_mm.to),
        exponent: growth.exponent,
        every: growth.every_revolutions,
    }
}

/// Most records of all units together.
const MOST_RECORDS: usize = 100_000;

/// The records of all units, from the first revolution to the last record before the end.
fn planned(growth: &Growth, law: &Law, scene: &Scene) -> Result<Vec<Planned>> {
    let mut all = Vec::new();
    for unit in 1..=growth.units {
        let mut dice = Dice::stream(growth.seed, unit as u64);
        // Of operation apart, so that more scatter there does not grow other spalls.
        let mut of_operation = Dice::stream(growth.seed ^ 0x5eed, unit as u64);
        let mut course = law.unit(&mut dice);
        let first = all.len();
        while course.end().is_none() {
            let mut scattered = |x: f64| x * (growth.operation_scatter * normal(&mut of_operation)).exp();
            let length_mm = course.length_mm(law).map(|mm| round(mm, 1e-3));
            all.push(Planned {
                unit,
                revolutions: course.revolutions(),
                length_mm,
                depth_mm: length_mm.map(|mm| round(growth.depth_mm(mm), 1e-4)),
                speed_rpm: round(scattered(scene.operation.speed_rpm), 1e-2),
                load_n: round(scattered(scene.operation.load_n), 1e-2),
                onset: course.onset(),
                end: f64::NAN,
            });
            anyhow::ensure!(
                all.len() <= MOST_RECORDS,
                "the units make more than {MOST_RECORDS} records: take fewer `units`, or a longer \
                 `every_revolutions`, which is {}",
                law.every
            );
            course.advance(law, &mut dice);
        }
        let end = course.end().unwrap_or(f64::NAN);
        all[first..].iter_mut().for_each(|record| record.end = end);
    }
    Ok(all)
}

fn round(x: f64, to: f64) -> f64 {
    let per = (1.0 / to).round();
    (x * per).round() / per
}

/// The campaign that makes the records.
fn campaign(growth: &Growth, base: Option<&Path>) -> String {
    let mut text = format!("// Written by `stribeck grow`.\n(\n    name: {:?},\n", growth.name);
    if let Some(base) = base {
        text += &format!("    scene: {:?},\n", base.display().to_string());
    }
    text += &format!("    set: {:?},\n    seed: {},\n    keep: signals,\n", growth.set, growth.seed);
    text + &format!("    variants: table({TABLE:?}),\n)\n")
}

fn table(growth: &Growth, planned: &[Planned]) -> String {
    let mut text = "operation.speed_rpm, operation.load_n, defects\n".to_owned();
    for record in planned {
        let defects = match (record.length_mm, record.depth_mm) {
            (Some(length), Some(depth)) => format!(
                "[(on: {}, angle_deg: {:?}, form: spall(length_mm: {length:?}, depth_mm: {depth:?}))]",
                growth.on.name(),
                growth.angle_deg
            ),
            _ => "[]".to_owned(),
        };
        text += &format!("{:?}, {:?}, \"{defects}\"\n", record.speed_rpm, record.load_n);
    }
    text
}

/// A row a record, with the truth.
fn columns(findings: &GrowthFindings) -> Vec<Column> {
    let rows =
        || findings.units.iter().flat_map(|unit| unit.records.iter().map(move |record| (unit, record)));
    macro_rules! column {
        ($name:literal, $kind:ident, $of:expr) => {
            Column { name: $name.to_owned(), values: Values::$kind(rows().map($of).collect()) }
        };
    }
    vec![
        column!("unit", Count, |(u, _)| i64::try_from(u.unit).ok()),
        column!("run", Count, |(_, r)| i64::try_from(r.run).ok()),
        column!("revolutions", Number, |(_, r)| Some(r.revolutions)),
        column!("onset_revolutions", Number, |(u, _)| Some(u.onset)),
        column!("end_revolutions", Number, |(u, _)| Some(u.end)),
        column!("length_mm", Number, |(_, r)| r.length_mm),
        column!("depth_mm", Number, |(_, r)| r.depth_mm),
        column!("rms_m_s2", Number, |(_, r)| r.rms),
        column!("kurtosis", Number, |(_, r)| r.kurtosis),
        column!("level_db", Number, |(_, r)| r.level_db),
        column!("claimed", Text, |(_, r)| r.claimed.clone()),
        column!("spall_mm", Number, |(_, r)| r.spall_mm),
        column!("read_mm", Number, |(_, r)| r.read_mm),
        column!("remaining_median", Number, |(_, r)| r.remaining.map(|left| left.median)),
        column!("remaining_low", Number, |(_, r)| r.remaining.map(|left| left.low)),
        column!("remaining_high", Number, |(_, r)| r.remaining.map(|left| left.high)),
        column!("remaining_true", Number, |(_, r)| Some(r.remaining_true)),
    ]
}
