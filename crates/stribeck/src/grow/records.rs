//! Findings of the records of a growth, unit by unit.

use std::path::Path;

use anyhow::{Context, Result};
use stribeck_analysis::growth::{Calibration, Known, Law, Record, remaining};
use stribeck_analysis::records::normal;
use stribeck_diagnosis::record::alarm::{LEAST_RECORDS, Limit, Quantity};
use stribeck_diagnosis::{Analysis, Defect, Machine, MeasuredFindings};
use stribeck_formats::{Channel, Recording};
use stribeck_plans::campaign::{Campaign, Variant};
use stribeck_plans::growth::{Growth, Indicator};
use stribeck_report::{GrowthFindings, RecordFindings, UnitFindings};
use stribeck_scene::catalogue;
use stribeck_scene::dice::Dice;
use stribeck_scene::scene::DefectRing;
use stribeck_store::run_dir::RunDir;

use super::Planned;
use crate::many_runs::ManyRuns;

/// All units with the findings of their records, and the estimated remaining life of each.
pub(super) fn judged(
    growth: &Growth,
    law: &Law,
    planned: &[Planned],
    campaign: &Campaign,
    out: &Path,
) -> Result<GrowthFindings> {
    let runs = ManyRuns(out.to_owned());
    let mut notes = vec![
        format!(
            "The law of the growth, with its scatter, is the one that made the units: {} until the onset, {} \
             from there to the end in the median. Real spalls follow no law that is known beforehand, and \
             intervals are then as right as it is.",
            millions(law.onset.0),
            millions(law.life.0)
        ),
        "Lengths of a unit are estimated with a calibration by the records of the other units, whose lengths \
         are known."
            .to_owned(),
    ];
    let mut records = Vec::with_capacity(planned.len());
    for (plan, variant) in planned.iter().zip(&campaign.runs) {
        let found = match findings(growth, variant, &runs) {
            Ok(found) => Some(found),
            Err(why) => {
                notes.push(format!("run {} has no record: {why:#}", variant.number));
                None
            }
        };
        records.push(record(growth, plan, variant.number, found.as_ref()));
    }
    let mut units = Vec::with_capacity(growth.units);
    for unit in 1..=growth.units {
        let of_unit = |n: &usize| planned[*n].unit == unit;
        let own: Vec<usize> = (0..planned.len()).filter(of_unit).collect();
        let others: Vec<Known> = (0..planned.len())
            .filter(|n| !of_unit(n))
            .filter_map(|n| {
                let record = shows(growth, &records[n])?;
                Some(Known { unit: planned[n].unit, length_mm: records[n].length_mm, record })
            })
            .collect();
        let own = own.into_iter().map(|n| records[n].clone()).collect();
        let first = planned.iter().find(|plan| plan.unit == unit);
        let (onset, end) = first.map_or((f64::NAN, f64::NAN), |plan| (plan.onset, plan.end));
        units.push(unit_findings(growth, law, unit, (onset, end), own, &others));
    }
    if units.iter().all(|unit| unit.records.iter().all(|record| record.remaining.is_none())) {
        notes.push(
            "Nothing is said of what is left: a unit needs a claim of its own and six records of others \
             with a spall; take more units, or records at shorter intervals."
                .to_owned(),
        );
    }
    let told = units.iter().flat_map(|unit| &unit.records);
    let told: Vec<bool> = told
        .filter_map(|record| {
            Some((record.remaining?.low..=record.remaining?.high).contains(&record.remaining_true))
        })
        .collect();
    let held = [told.iter().filter(|held| **held).count(), told.len()];
    Ok(GrowthFindings { name: growth.name.clone(), by: words(growth.by).to_owned(), units, held, notes })
}

/// The family of the defect.
fn defect(growth: &Growth) -> Defect {
    match growth.on {
        DefectRing::Outer => Defect::Bpfo,
        DefectRing::Inner => Defect::Bpfi,
    }
}

fn words(indicator: Indicator) -> &'static str {
    match indicator {
        Indicator::Rms => "the logarithm of the root mean square",
        Indicator::Kurtosis => "the logarithm of the kurtosis",
        Indicator::Level => "the level of the family",
        Indicator::Spall => "the logarithm of the length between the two events of a passage",
    }
}

fn millions(revolutions: f64) -> String {
    format!("{:.3} million revolutions", 1e-6 * revolutions)
}

/// Findings of a run's record with the machine's noise added.
fn findings(growth: &Growth, variant: &Variant, runs: &ManyRuns) -> Result<MeasuredFindings> {
    let scene = variant.scene.as_ref().map_err(|why| anyhow::anyhow!("{why}"))?;
    let dir = RunDir::open(runs.run(scene))?;
    let path = if dir.signals().exists() { dir.signals() } else { dir.trace() };
    let recording = Recording::open(&path)?;
    let leading = |c: &&Channel| c.name.starts_with("sensor.") && c.name.ends_with(".ay_m_s2");
    let channel = recording.channels.iter().find(leading).context("the run recorded no sensor")?;
    let rate_hz = channel.rate_hz.context("the run has no sample rate")?;
    let mut dice = Dice::stream(growth.seed ^ 0x0bad_5eed, variant.number as u64);
    let noisy = channel.read()?.into_iter().map(|x| x + growth.noise_m_s2 * normal(&mut dice)).collect();
    let noisy = Channel::held(&channel.name, noisy).at_rate(Some(rate_hz)).in_unit(Some("m/s^2".to_owned()));
    let machine = Machine {
        speed_rpm: Some((scene.operation.speed_rpm - scene.operation.outer_speed_rpm).abs()),
        outer_speed_rpm: stribeck_analysis::diagnosis::outer_speed_rpm(scene),
        bearing: Some(catalogue::of_scene(scene)),
        speed_is_exact: true,
        ..Machine::default()
    };
    Ok(Analysis::of(&noisy, rate_hz, &machine)?.findings)
}

fn record(growth: &Growth, plan: &Planned, run: usize, found: Option<&MeasuredFindings>) -> RecordFindings {
    let claimed = found.map(|found| {
        let names: Vec<&str> = found.families.iter().filter(|f| f.claimed).map(|f| f.name.name()).collect();
        if names.is_empty() { "none".to_owned() } else { names.join("+") }
    });
    let family = found.and_then(|found| found.families.iter().find(|f| f.name == defect(growth)));
    RecordFindings {
        run,
        revolutions: plan.revolutions,
        length_mm: plan.length_mm,
        depth_mm: plan.depth_mm,
        rms: found.map(|found| found.health.rms),
        kurtosis: found.map(|found| found.health.kurtosis),
        level_db: family.and_then(|family| family.level_db),
        claimed,
        spall_mm: found.and_then(|found| found.spall_mm).map(|spall| spall.value),
        read_mm: None,
        remaining: None,
        remaining_true: plan.end - plan.revolutions,
    }
}

/// What a record shows; `None` where there is none.
fn shows(growth: &Growth, record: &RecordFindings) -> Option<Record> {
    let name = defect(growth).name();
    if !record.claimed.as_ref()?.split('+').any(|claimed| claimed == name) {
        return Some(Record::Sound);
    }
    let indicator = match growth.by {
        Indicator::Rms => record.rms.map(f64::ln),
        Indicator::Kurtosis => record.kurtosis.map(f64::ln),
        Indicator::Level => record.level_db,
        Indicator::Spall => record.spall_mm.map(f64::ln),
    };
    Some(indicator.filter(|x| x.is_finite()).map_or(Record::Damaged, Record::Indicates))
}

fn unit_findings(
    growth: &Growth,
    law: &Law,
    unit: usize,
    (onset, end): (f64, f64),
    mut records: Vec<RecordFindings>,
    others: &[Known],
) -> UnitFindings {
    let shown: Vec<Option<Record>> = records.iter().map(|record| shows(growth, record)).collect();
    if let Some(calibration) = Calibration::of(others) {
        let left = remaining(law, &shown, &calibration, growth.seed ^ unit as u64);
        for ((record, shown), left) in records.iter_mut().zip(&shown).zip(left) {
            if let Some(Record::Indicates(x)) = shown {
                record.read_mm = Some(calibration.length_mm(*x));
            }
            record.remaining = left;
        }
    }
    let first: Vec<f64> = records.iter().take(LEAST_RECORDS).filter_map(|record| record.rms).collect();
    let alarm = Limit::from_reference(Quantity::Rms, &first).map(|limit| limit.alarm);
    let above =
        |record: &&RecordFindings| alarm.is_some_and(|alarm| record.rms.is_some_and(|rms| rms >= alarm));
    UnitFindings {
        unit,
        onset,
        end,
        claimed_at: shown
            .windows(2)
            .position(|two| two.iter().all(|shown| shown.is_some_and(|shown| shown != Record::Sound)))
            .map(|first| records[first].revolutions),
        alarm_at: records.iter().skip(LEAST_RECORDS).find(above).map(|r| r.revolutions),
        alarm_rms: alarm,
        records,
    }
}
