//! The page and its tables.

use maud::{Markup, html};

use super::{Answer, FieldCalibrated, FieldFound, OUT_OF_REACH, TargetFound, figures, short};
use crate::Error;
use crate::field_words::FieldWords;
use crate::page::{document, with_code};

pub(super) fn page(answer: &Answer) -> Result<Markup, Error> {
    let [priors, pairs, targets, pulls] = [
        figures::marginals(answer),
        figures::pairs(answer),
        figures::targets(answer),
        figures::pulls(answer),
    ]
    .map(|picture| picture.to_html());
    Ok(document(
        &answer.name,
        html! {
            h1 { (answer.name) }
            div class="top" {
                p class="headline" { (headline(answer)) }
                div class="picture" { (priors?) }
                div class="answer" {
                    @for field in by_width(answer).into_iter().skip(1) { p { (found(field, answer.share())) } }
                }
            }
            aside class="limits" { p {
                strong { "How far to trust it. " } (lead(answer))
                @if let Some(words) = answer.too_narrow() { " " (with_code(&words)) "." }
            } }
            h2 #unknowns { "Unknowns" }
            div class="scroll" { (unknowns(answer)) }
            (pairs?)
            h2 #targets { "Targets, and what such scenes make" }
            div class="scroll" { (targets_table(answer)) }
            (targets?)
            h2 #reach { "What no scene makes" }
            (reach(answer))
            h2 #pulls { "What each target contributes" }
            (pulls?)
            h2 #trust { "How far to believe it" }
            (trust(answer))
            @if let Some(calibration) = &answer.calibration { (calibrated(calibration)?) }
        },
    ))
}

/// The unknowns, those first of which the targets say most.
fn by_width(answer: &Answer) -> Vec<&FieldFound> {
    let mut fields: Vec<&FieldFound> = answer.fields.iter().collect();
    fields.sort_by(|a, b| a.width_of_prior.total_cmp(&b.width_of_prior));
    fields
}

/// Wider than this part of its prior, an unknown stays unknown.
const UNKNOWN: f64 = 0.8;

/// What was found of the unknown of which the targets say most.
fn headline(answer: &Answer) -> String {
    let Some(field) = by_width(answer).first().copied() else {
        return "Nothing was unknown.".to_owned();
    };
    match field.width_of_prior {
        width if width > UNKNOWN => format!("The targets hardly tell. {}", found(field, answer.share())),
        _ => found(field, answer.share()),
    }
}

/// What was found of one unknown, in words.
fn found(field: &FieldFound, share: &str) -> String {
    let FieldWords { words, unit } = FieldWords::of(&field.name);
    let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
    match (field.median, field.interval_90) {
        (Some(median), Some([low, high])) => {
            format!(
                "{words}: {}{unit}, {share} between {} and {}{unit}.",
                short(median),
                short(low),
                short(high)
            )
        }
        _ => format!("{words}: {}.", likeliest(field).join(", ")),
    }
}

fn lead(answer: &Answer) -> String {
    let Answer { scenes, starts, rounds, fields, targets, .. } = answer;
    let lost = answer.out_of_reach().count();
    let reach = match (lost, answer.excluded.len()) {
        (0, 0) => "Each observed number lies within what some scene makes.".to_owned(),
        (0, pairs) => {
            format!("Each observed number is made by some scene, {pairs} pairs of them not by one.")
        }
        (lost, _) => format!("{lost} of the observed numbers are made by no scene."),
    };
    let told = fields.iter().filter(|field| field.width_of_prior < 0.5).count();
    format!(
        "{} unknowns, {} targets; {scenes} scenes with {starts} start{} each in {rounds} rounds. {reach} \
         {told} of the unknowns are known to within half of their prior.",
        fields.len(),
        targets.len(),
        if *starts == 1 { "" } else { "s" }
    )
}

fn between([low, high]: [f64; 2]) -> String {
    format!("{} … {}", short(low), short(high))
}

/// Choices that the table shows of an unknown, the likeliest first.
const SHOWN: usize = 5;

/// The likeliest choices of an unknown, a line each, and how many others there are.
fn likeliest(field: &FieldFound) -> Vec<String> {
    let mut choices: Vec<_> = field.choices.iter().collect();
    choices.sort_by(|a, b| b.probability.total_cmp(&a.probability));
    let rest = &choices[SHOWN.min(choices.len())..];
    let mut lines: Vec<String> = choices
        .iter()
        .take(SHOWN)
        .map(|choice| format!("{:.0} %  {}", 100.0 * choice.probability, choice.value))
        .collect();
    if !rest.is_empty() {
        let sum: f64 = rest.iter().map(|choice| choice.probability).sum();
        let others = if rest.len() == 1 { "other" } else { "others" };
        lines.push(format!("{:.0} %  {} {others}", 100.0 * sum, rest.len()));
    }
    lines
}

fn unknowns(answer: &Answer) -> Markup {
    let fields = &answer.fields;
    html! {
        table {
            tr { th { "Unknown" } th { "Prior" } th { "Median, or choices" } th { "50 %" } th { (answer.share()) } th { "Width, of the prior" } th { "Expected width after one more round" } th { "Narrowest by more rounds" } }
            @for field in fields {
                tr {
                    td title=(field.name) { (FieldWords::of(&field.name).words) }
                    td { (field.prior) }
                    @match field.median {
                        Some(median) => td { (short(median)) },
                        None => td { @for line in likeliest(field) { div { (line) } } },
                    }
                    td { (field.interval_50.map_or_else(String::new, between)) }
                    td { (field.interval_90.map_or_else(String::new, between)) }
                    td { (format!("{:.0} %", 100.0 * field.width_of_prior)) }
                    td { (format!("× {:.2}", field.expected_narrowing)) }
                    td { (format!("× {:.2}", field.least_narrowing)) }
                }
            }
        }
    }
}

fn targets_table(answer: &Answer) -> Markup {
    let seen = |target: &TargetFound| match target.value {
        Some(value) => format!("{} ± {}", short(value), short(target.tolerance)),
        None => "none".to_owned(),
    };
    html! {
        table {
            tr { th { "Target" } th { "Seen" } th { "Emulated: median, 90 %" } th { "Has it" } th { "Run at draws: median, 90 %" } th { "Have it" } th { "Below the target" } th { "Off at best: alone, with all" } }
            @for target in &answer.targets {
                tr {
                    td title=(target.of) { (target.name) }
                    td { (seen(target)) }
                    td { (target.predicted.map_or_else(String::new, |q| format!("{}, {}", short(q[2]), between([q[0], q[4]])))) }
                    td { (format!("{:.0} %", 100.0 * target.exists)) }
                    td {
                        @if let Some(median) = target.run_median {
                            (short(median)) (target.run_interval_90.map_or_else(String::new, |interval| format!(", {}", between(interval))))
                        }
                    }
                    td { @if target.runs > 0 { (format!("{} of {}", target.runs_that_have_it, target.runs)) } }
                    td { (target.below_target.map_or_else(String::new, |share| format!("{:.0} %", 100.0 * share))) }
                    td { (format!("{:+.1}, {:+.1} σ", target.best_alone, target.best_together)) }
                }
            }
        }
        p { "“Off at best” is how far a target lies from the prediction at the point of the prior that comes \
            nearest, in standard deviations of scatter, tolerance and the emulator's doubt. A target seen \
            below 5 % or above 95 % of emulated runs contradicts the other targets." }
    }
}

fn scene(values: &[[String; 2]]) -> Markup {
    html! { code { (values.iter().map(|[name, value]| format!("{name}={value}")).collect::<Vec<_>>().join("  ")) } }
}

fn reach(answer: &Answer) -> Markup {
    html! {
        ul {
            @for target in answer.out_of_reach() {
                li { (target.name) ": the nearest scene is " (format!("{:+.1}", target.best_alone)) " standard deviations off." }
            }
            @for pair in &answer.excluded {
                li {
                    (pair.targets[0]) " and " (pair.targets[1]) ": each can be met, both at once are missed \
                        by "
                    (format!("{:.1}", pair.deviations)) " standard deviations at best, at " (scene(&pair.best))
                }
            }
            @if answer.out_of_reach().next().is_none() && answer.excluded.is_empty() {
                li {
                    "Every target, and every pair of them, is made by some scene within "
                    (format!("{OUT_OF_REACH}")) " standard deviations."
                }
            }
        }
        p { "Nearest to all targets at once: " (scene(&answer.best_together)) }
    }
}

fn trust(answer: &Answer) -> Markup {
    let percent =
        |share: Option<f64>| share.map_or_else(|| "–".to_owned(), |share| format!("{:.0} %", 100.0 * share));
    html! {
        @if answer.own_runs > 0 { (own_runs(answer)) }
        p { (format!("The draws of the posterior count for {:.0} independent ones. Outputs are emulated by \
            Gaussian processes; each run, with all of its readings, is predicted from the others:", answer.effective_draws)) }
        div class="scroll" {
            table {
                tr { th { "Output" } th { "Runs that have it" } th { "Variance that is predicted" } th { "Runs in their 90 % interval" } th { "Scatter of starts" } }
                @for quality in &answer.quality {
                    tr {
                        td { (quality.output) }
                        td { (format!("{:.0} %", 100.0 * quality.exists)) }
                        td { (percent(quality.r_squared)) }
                        td { (percent(quality.coverage_90)) }
                        td { (quality.scatter.map_or_else(|| "–".to_owned(), short)) }
                    }
                }
            }
        }
    }
}

/// What the runs themselves say of the intervals.
fn own_runs(answer: &Answer) -> Markup {
    let percent = |share: f64| format!("{:.0} %", 100.0 * share);
    html! {
        p { (format!(
            "Each of the {} scenes of the first round was inferred from its own numbers by an emulator of \
             the others. Where the central 90 % of an unknown's draws hold fewer than 90 % of them, the \
             intervals of this page take in as large a share of the draws as does.",
            answer.own_runs
        )) }
        div class="scroll" {
            table {
                tr { th { "Unknown" } th { "Scenes in the central 90 % of draws" } th { "Share of draws in the 90 % interval" } }
                @for field in &answer.fields {
                    tr {
                        td { (field.name) }
                        td { (field.own_runs_in_90.map_or_else(|| "–".to_owned(), percent)) }
                        td { (format!("{:.1} %", 100.0 * field.level_90)) }
                    }
                }
            }
        }
    }
}

fn calibrated(fields: &[FieldCalibrated]) -> Result<Markup, Error> {
    let share = |[share, low, high]: [f64; 3]| {
        format!("{:.0} % ({:.0} … {:.0})", 100.0 * share, 100.0 * low, 100.0 * high)
    };
    let ranks = figures::ranks(fields).to_html()?;
    Ok(html! {
        h2 #calibration { "Calibration" }
        p { (format!(
            "{} scenes were drawn from the prior, run, and inferred from their own numbers, each with a \
             random error of its target's tolerance. A 90 % interval is one if it holds the truth in 90 % \
             of them.",
            fields.first().map_or(0, |field| field.truths)
        )) }
        div class="scroll" {
            table {
                tr { th { "Unknown" } th { "In the 50 % interval" } th { "In the 90 % interval" } th { "In the central 90 % of draws" } th { "Ranks even, p" } th { "Width, of the prior" } }
                @for field in fields {
                    tr {
                        td { (field.name) } td { (share(field.held_50)) } td { (share(field.held_90)) } td { (share(field.held_90_of_draws)) }
                        td { (format!("{:.3}", field.p_value)) } td { (format!("{:.0} %", 100.0 * field.width_of_prior)) }
                    }
                }
            }
        }
        (ranks)
    })
}
