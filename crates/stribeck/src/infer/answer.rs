//! Results of an inference, for the page and `inference.json`.

use std::path::Path;

use anyhow::Result;
use stribeck_formats::parquet::{Column, Values as Cells, write_table};
use stribeck_infer::{
    Calibration, Conflict, Emulator, FieldLevels, Levels, NextOptions, Posterior, PosteriorOptions,
    Predictive, Prior, Share, Truth, expected_gain, interval, next, pulls, quantile,
};
use stribeck_plans::inference::{Inference, Seen, Unknown};
use stribeck_report::inference::{
    Answer, Choice, Excluded, FieldCalibrated, FieldFound, Pulled, Quality, TargetFound,
};

use super::outputs::{Found, Row, Table};
use super::{DRAWS_OF_ROUND, FILLING};
use crate::out::say;

/// Inference from all runs.
pub(super) struct Known<'a> {
    pub(super) inference: &'a Inference,
    pub(super) priors: Vec<Prior>,
    pub(super) scenes: usize,
    pub(super) rounds: usize,
    pub(super) table: Table,
    pub(super) emulator: Emulator,
    pub(super) levels: Option<Levels>,
    pub(super) posterior: Posterior,
    /// Runs at draws of the posterior.
    pub(super) check: Vec<Row>,
    /// Runs of scenes drawn from the prior, for the calibration.
    pub(super) truths: Option<Vec<Row>>,
}

/// Bars of a drawn distribution.
const BARS: usize = 24;

/// Draws that a plot of two unknowns shows.
const SHOWN: usize = 400;

pub(super) fn of(known: &Known<'_>) -> Result<Answer> {
    let Known { inference, priors, table, emulator, posterior, .. } = known;
    let seed = inference.seed;
    let predictive = Predictive::of(emulator, posterior, &table.targets, seed)?;
    let conflict = Conflict::of(emulator, priors, &table.targets, Some(posterior), seed)?;
    let options = PosteriorOptions { draws: DRAWS_OF_ROUND, seed };
    let pulls = pulls(emulator, priors, &table.targets, posterior, options)?;
    let further = NextOptions { count: inference.budget.round, filling: FILLING, filled: 0, seed: seed ^ 1 };
    let further = next(emulator, priors, &table.targets, posterior, further)?;
    let gains = expected_gain(emulator, priors, &table.targets, posterior, &further)?;
    let name = |target: usize| table.outputs[table.targets[target].output].name.clone();
    let fields = (0..priors.len()).map(|field| {
        let mut found = field_found(known, field);
        found.expected_narrowing = gains[field].after / gains[field].deviation.max(1e-12);
        found.least_narrowing = gains[field].limit / gains[field].deviation.max(1e-12);
        found
    });
    let targets = (0..table.targets.len()).map(|target| {
        let mut found = target_found(known, target, &predictive[table.targets[target].output]);
        let reach = &conflict.reaches[target];
        (found.best_alone, found.best_together) = (reach.deviations, reach.deviations_together);
        found
    });
    let best = |point: &[f64]| written(known, point);
    Ok(Answer {
        name: inference.name.clone(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        commit: crate::host::COMMIT.to_owned(),
        seed,
        scenes: known.scenes,
        starts: inference.starts,
        rounds: known.rounds,
        runs: known.table.runs.points.len(),
        effective_draws: posterior.effective_sample_size,
        log_evidence: posterior.log_evidence,
        fields: fields.collect(),
        pairs: pairs(posterior),
        shown: posterior.draws.iter().step_by((posterior.draws.len() / SHOWN).max(1)).cloned().collect(),
        targets: targets.collect(),
        best_together: best(&conflict.best_point),
        excluded: conflict
            .exclusions
            .iter()
            .map(|pair| Excluded {
                targets: pair.targets.map(name),
                best: best(&pair.point),
                deviations: pair.deviations,
            })
            .collect(),
        pulls: pulls
            .iter()
            .map(|pull| Pulled {
                target: name(pull.target),
                field: inference.unknowns[pull.field].name.clone(),
                shift: pull.shift,
                divergence: pull.divergence,
            })
            .collect(),
        quality: emulator
            .quality()
            .into_iter()
            .map(|quality| Quality {
                output: quality.output,
                exists: quality.exists,
                r_squared: Some(quality.r_squared).filter(|x| x.is_finite()),
                coverage_90: Some(quality.coverage_90).filter(|x| x.is_finite()),
                scatter: Some(quality.scatter).filter(|x| x.is_finite()),
            })
            .collect(),
        own_runs: known.levels.as_ref().map_or(0, |levels| levels.truths),
        calibration: known.truths.as_deref().map(|truths| calibration(known, truths)).transpose()?,
    })
}

/// One unknown: its distribution, as a number or by choices.
fn field_found(known: &Known<'_>, field: usize) -> FieldFound {
    let (unknown, prior) = (&known.inference.unknowns[field], &known.priors[field]);
    let shares = known.posterior.column(field);
    let values: Vec<f64> = shares.iter().map(|&share| prior.quantile(share)).collect();
    let mut bars = vec![0.0; unknown.choices().unwrap_or(BARS)];
    let count = bars.len();
    for share in &shares {
        bars[((share * count as f64) as usize).min(count - 1)] += 1.0 / shares.len() as f64;
    }
    let choices = unknown.choices().map_or_else(Vec::new, |count| {
        (0..count).map(|n| Choice { value: unknown.written(n as f64), probability: bars[n] }).collect()
    });
    let number = unknown.choices().is_none();
    let levels = level_of(known, field);
    let [low, high] = interval(&shares, levels.level_90);
    FieldFound {
        name: unknown.name.clone(),
        prior: prior_in_words(unknown, prior),
        ends: number.then(|| [prior.quantile(0.0), prior.quantile(1.0)]),
        logarithmic: matches!(prior, Prior::LogUniform { .. }),
        median: number.then(|| quantile(&values, 0.5)),
        interval_50: number.then(|| interval(&values, levels.level_50)),
        interval_90: number.then(|| interval(&values, levels.level_90)),
        // Evenly over the prior 90 % would take 0.9 of it.
        width_of_prior: if number { (high - low) / 0.9 } else { entropy(&bars) / (count as f64).ln() },
        bars,
        choices,
        level_90: levels.level_90,
        own_runs_in_90: known.levels.as_ref().map(|_| levels.held_90),
        expected_narrowing: 1.0,
        least_narrowing: 1.0,
    }
}

/// Shares of the draws that intervals of an unknown take in.
fn level_of(known: &Known<'_>, field: usize) -> FieldLevels {
    let plain = FieldLevels { held_90: f64::NAN, level_50: 0.5, level_90: 0.9 };
    known.levels.as_ref().map_or(plain, |levels| levels.fields[field])
}

fn entropy(shares: &[f64]) -> f64 {
    -shares.iter().filter(|share| **share > 0.0).map(|share| share * share.ln()).sum::<f64>()
}

fn prior_in_words(unknown: &Unknown, prior: &Prior) -> String {
    match prior {
        Prior::Uniform { from, to } => format!("{from} to {to}"),
        Prior::LogUniform { from, to } => format!("{from} to {to}, by factors"),
        Prior::Normal { mean, sd, from, to } => format!("{mean} ± {sd}, from {from} to {to}"),
        _ => format!("{} choices", unknown.choices().unwrap_or(1)),
    }
}

/// Correlations of all pairs of unknowns, row by row.
fn pairs(posterior: &Posterior) -> Vec<Vec<f64>> {
    let columns: Vec<Vec<f64>> =
        (0..posterior.draws.first().map_or(0, Vec::len)).map(|field| posterior.column(field)).collect();
    let moments: Vec<[f64; 2]> = (0..columns.len()).map(|field| posterior.moments(field)).collect();
    let one = |a: usize, b: usize| {
        let [[mean_a, sd_a], [mean_b, sd_b]] = [moments[a], moments[b]];
        let product =
            columns[a].iter().zip(&columns[b]).map(|(x, y)| (x - mean_a) * (y - mean_b)).sum::<f64>();
        let spread = sd_a * sd_b * columns[a].len() as f64;
        if spread > 0.0 { (product / spread).clamp(-1.0, 1.0) } else { 0.0 }
    };
    (0..columns.len()).map(|a| (0..columns.len()).map(|b| one(a, b)).collect()).collect()
}

fn target_found(known: &Known<'_>, number: usize, predictive: &Predictive) -> TargetFound {
    let table = &known.table;
    let target = &table.targets[number];
    let of = &known.inference.targets[table.of[number]];
    // Components of curves have no number of a run by themselves.
    let checked: Vec<Option<f64>> = match of.seen {
        Seen::Curve(_) => Vec::new(),
        _ => known
            .check
            .iter()
            .map(|row| match row.seen[table.of[number]] {
                Found::Number(number) => number,
                Found::Curve(_) => None,
            })
            .collect(),
    };
    let there: Vec<f64> = checked.iter().flatten().copied().collect();
    let within = |share: f64| (there.len() > 2).then(|| interval(&there, share));
    TargetFound {
        name: table.outputs[target.output].name.clone(),
        of: of.of.to_string(),
        logarithmic: of.log,
        value: target.value,
        tolerance: target.tolerance,
        exists: predictive.exists,
        predicted: (!predictive.values.is_empty()).then_some(predictive.quantiles),
        below_target: predictive.below_target,
        runs: checked.len(),
        runs_that_have_it: there.len(),
        run_median: (!there.is_empty()).then(|| quantile(&there, 0.5)),
        run_interval_90: within(0.9),
        run_values: there,
        best_alone: 0.0,
        best_together: 0.0,
    }
}

/// Values of all unknowns at a point, as the file of a scene has them.
fn written(known: &Known<'_>, point: &[f64]) -> Vec<[String; 2]> {
    let of = |((unknown, prior), &share): ((&Unknown, &Prior), &f64)| {
        let value = prior.quantile(share);
        let short =
            if unknown.choices().is_some() { value } else { format!("{value:.3e}").parse().unwrap_or(value) };
        [unknown.name.clone(), unknown.written(short)]
    };
    known.inference.unknowns.iter().zip(&known.priors).zip(point).map(of).collect()
}

/// How often intervals hold the truths.
fn calibration(known: &Known<'_>, truths: &[Row]) -> Result<Vec<FieldCalibrated>> {
    let rows = Table::rows_like(known.inference, &known.table, truths);
    let truths: Vec<Truth> =
        truths.iter().zip(rows).map(|(row, outputs)| Truth { point: row.point.clone(), outputs }).collect();
    let columns = known.table.columns();
    let options = PosteriorOptions { draws: DRAWS_OF_ROUND, seed: known.inference.seed };
    let calibration = Calibration::of(&known.emulator, &known.priors, &truths, &columns, options)?;
    let named = known.inference.unknowns.iter().zip(calibration.fields).enumerate();
    let of = |share: Share| [share.share, share.low, share.high];
    let within = |field: usize, level: f64| {
        let ranks = &calibration.ranks[field];
        let held = ranks.iter().filter(|rank| (2.0 * **rank - 1.0).abs() <= level).count();
        of(Share::of(held, ranks.len()))
    };
    Ok(named
        .map(|(number, (unknown, field))| FieldCalibrated {
            name: unknown.name.clone(),
            truths: calibration.truths,
            held_50: within(number, level_of(known, number).level_50),
            held_90: within(number, level_of(known, number).level_90),
            held_90_of_draws: of(field.coverage_90),
            ranks: field.ranks.to_vec(),
            p_value: field.p_value,
            width_of_prior: field.width,
        })
        .collect())
}

/// `posterior.parquet`: a row for each draw, a column for each unknown in its unit, choices as they are
/// written.
pub(super) fn write_draws(path: &Path, known: &Known<'_>) -> Result<()> {
    let mut columns: Vec<Column> = known
        .inference
        .unknowns
        .iter()
        .enumerate()
        .map(|(field, unknown)| {
            let values =
                known.posterior.column(field).into_iter().map(|share| known.priors[field].quantile(share));
            let values = if unknown.choices().is_some() {
                Cells::Text(values.map(|value| Some(unknown.written(value))).collect())
            } else {
                Cells::Number(values.map(Some).collect())
            };
            Column { name: unknown.name.clone(), values }
        })
        .collect();
    columns.push(Column::numbers("log_likelihood", known.posterior.log_likelihoods.clone()));
    let notes = vec![
        ("inference".to_owned(), known.inference.text.clone()),
        ("stribeck".to_owned(), env!("CARGO_PKG_VERSION").to_owned()),
    ];
    Ok(write_table(path, &columns, &notes)?)
}

/// The answer in the terminal.
pub(super) fn tell(answer: &Answer) {
    for field in &answer.fields {
        match (field.median, field.interval_90) {
            (Some(median), Some([low, high])) => say!(
                "{}: {median:.4}, {} between {low:.4} and {high:.4} ({:.0} % of the prior)",
                field.name,
                answer.share(),
                100.0 * field.width_of_prior
            ),
            _ => {
                let mut choices: Vec<&Choice> = field.choices.iter().collect();
                choices.sort_by(|a, b| b.probability.total_cmp(&a.probability));
                let few = choices.iter().take(3);
                let told = few.map(|choice| format!("{} {:.0} %", choice.value, 100.0 * choice.probability));
                say!("{}: {}", field.name, told.collect::<Vec<_>>().join(", "));
            }
        }
    }
    if let Some(words) = answer.too_narrow() {
        eprintln!("warning: {words}");
    }
    for target in answer.out_of_reach() {
        say!(
            "no scene of the prior makes `{}`: the nearest is {:+.1} standard deviations off",
            target.name,
            target.best_alone
        );
    }
    for pair in &answer.excluded {
        say!(
            "`{}` and `{}` exclude one another: {:.1} standard deviations at best",
            pair.targets[0],
            pair.targets[1],
            pair.deviations
        );
    }
}
