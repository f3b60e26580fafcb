//! `cargo xtask study run_time`: error against run time of the whole bearing.

use anyhow::{Context, Result};
use stribeck_analysis::noise;
use stribeck_analysis::prediction::Prediction;
use stribeck_analysis::record::Record;
use stribeck_scene::scene::ModelScene;

use crate::sample::{Sample, ratio};
use crate::{Finished, Flags, Host, Plan, Rows, Runner, figure};

/// Flags of `study run_time`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[command(flatten)]
    flags: Flags,
    /// Starts of each choice, 0.01° of the cage apart
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = clap::value_parser!(u16).range(2..=1000))]
    starts: u16,
    /// Elements of the reference at the contacts [mm]: 0.125 takes an hour a start
    #[arg(long, value_name = "MM", default_value = "0.125", value_parser = ["0.125", "0.25"])]
    finest_mm: String,
    /// Starts of the reference
    #[arg(long, value_name = "N", default_value_t = 4, value_parser = clap::value_parser!(u16).range(2..=1000))]
    reference_starts: u16,
}

/// Force is averaged from here on [ms]: before, the bearing still settles.
const FROM_MS: f64 = 1.0;

/// Results of one start.
#[derive(Debug, Clone, Copy)]
struct Measured {
    start: usize,
    /// Processor time of a simulated millisecond [s].
    seconds: f64,
    /// Processor time of one element in one step [ns]; `None` of the reduced model, which has no elements.
    nanoseconds: Option<f64>,
    /// Mean force of the outer raceway on roller 2, which stands beside the defect the whole time [N].
    force_n: f64,
    /// When roller 1 loses the raceway and meets it again [ms].
    events_ms: Option<[f64; 2]>,
    /// Largest acceleration at the first sensor after the exit [g].
    impulse_g: Option<f64>,
}

pub(crate) fn measure(options: &Options, host: &Host, rows: &mut Rows) -> Result<()> {
    let runner = Runner::new("run_time", &options.flags, host);
    let plan = Plan::read("run_time")?;
    let reference_name = format!("graded, {} mm", options.finest_mm);
    let mut choices = Vec::new();
    for group in &plan.groups {
        for variant in plan.variants(group) {
            let is_reference = variant.name == reference_name;
            if variant.name == "graded, 0.125 mm" && !is_reference {
                continue;
            }
            let count = if is_reference { options.reference_starts } else { options.starts };
            let starts = Plan::starts(&variant, count);
            let runs = runner.run(&starts)?;
            let number = |run: &Finished| starts.iter().position(|s| s.name == run.variant.name);
            let measured: Vec<Measured> =
                runs.iter().filter_map(|run| measure_one(number(run)?, run)).collect();
            choices.push((variant.name, group.table.clone(), measured));
        }
    }
    let reference = choices.iter().find(|(name, ..)| *name == reference_name);
    let reference = reference.context("the reference is no choice")?.2.clone();
    for (name, curve, starts) in choices.iter().filter(|(.., starts)| !starts.is_empty()) {
        rows.word("choices", name, "curve", curve);
        put(rows, name, starts, (*name != reference_name).then_some(&reference));
    }
    plan.figures.iter().try_for_each(|drawing| figure::draw("run_time", &drawing.of(rows)))
}

/// Reads the results of a complete run.
fn measure_one(start: usize, finished: &Finished) -> Option<Measured> {
    let (summary, info) = (finished.numbers()?, finished.info.as_ref()?);
    let run = finished.trace()?;
    let record = Record::whole(&run).ok()?;
    let roller = record.roller(2)?;
    let loaded = record.time_s().iter().position(|&t| t >= 1e-3 * FROM_MS)?;
    let pushed = roller.outer_fx.iter().zip(roller.outer_fy).skip(loaded).map(|(x, y)| x.hypot(*y));
    let force_n = Sample::of(&pushed.collect::<Vec<f64>>()).mean;
    let first = summary.events.iter().find(|event| event.roller == 1)?;
    let exit_s = Prediction::of(&run.scene, &run.info.mesh).passages().first()?.exit_s;
    let sensor = &finished.written.output.sensors.first()?.name;
    let elements = (info.mesh.quads + info.mesh.triangles) as f64;
    Some(Measured {
        start,
        seconds: info.loop_cpu_s / finished.written.solver.duration_ms,
        nanoseconds: (finished.written.model == ModelScene::Full)
            .then(|| 1e9 * info.loop_cpu_s / (info.steps as f64 * elements)),
        force_n,
        events_ms: first.entry_ms.zip(first.exit_ms).map(|(entry, exit)| [entry, exit]),
        impulse_g: noise::impulse(&record, sensor, exit_s).map(|i| i.peak_g),
    })
}

/// The numbers of all starts of a choice, beside those of the reference, which has none to be compared with:
/// relative errors are means over the starts that the reference has too.
fn put(rows: &mut Rows, name: &str, starts: &[Measured], reference: Option<&Vec<Measured>>) {
    let pairs = || {
        let twin = move |m: &Measured| reference?.iter().find(|r| r.start == m.start).copied();
        starts.iter().filter_map(move |m| Some((*m, twin(m)?)))
    };
    let force = mean(pairs().map(|(m, r)| (m.force_n / r.force_n - 1.0).abs()));
    let events = mean(pairs().filter_map(|(m, r)| {
        let ([entry, exit], [entry0, exit0]) = (m.events_ms?, r.events_ms?);
        Some((entry - entry0).abs().max((exit - exit0).abs()) / (exit0 - entry0))
    }));
    let impulse = sample(starts);
    let off = impulse.zip(reference.and_then(|r| sample(r))).map(|(a, b)| ratio(&a, &b));
    let least = |of: fn(&Measured) -> Option<f64>| starts.iter().filter_map(of).reduce(f64::min);
    let values = [
        // Other work on the computer only ever adds to the time.
        ("seconds a millisecond", least(|m| Some(m.seconds))),
        ("ns an element-step", least(|m| m.nanoseconds)),
        ("force error", force),
        ("events error", events),
        ("impulse g", impulse.map(|s| s.mean)),
        ("impulse g, standard error", impulse.map(|s| s.error())),
        ("impulse g, scatter", impulse.map(|s| s.scatter)),
        ("impulse off reference", off.map(|[off, _]| off)),
        ("impulse off reference, standard error", off.map(|[_, error]| error)),
    ];
    rows.values("choices", name, values);
    for m in starts {
        let [entry, exit] = m.events_ms.map_or([None; 2], |e| e.map(Some));
        let values = [
            ("seconds a millisecond", Some(m.seconds)),
            ("force N", Some(m.force_n)),
            ("entry ms", entry),
            ("exit ms", exit),
            ("impulse g", m.impulse_g),
        ];
        rows.values("starts", &format!("{name}, start {}", m.start), values);
    }
}

fn sample(starts: &[Measured]) -> Option<Sample> {
    let peaks: Vec<f64> = starts.iter().filter_map(|m| m.impulse_g).collect();
    (peaks.len() > 1).then(|| Sample::of(&peaks))
}

fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), v| (sum + v, count + 1.0));
    (count > 0.0).then(|| sum / count)
}

/// The cheapest choice that is accurate enough and stays so along its curve when it is refined; and how many
/// starts make a mean impulse known, by the median of what single starts scatter, which no mesh reduces.
pub(crate) fn derive(rows: &mut Rows) {
    for (what, quantity) in [("force", "force error"), ("events", "events error")] {
        for share in [0.05, 0.01] {
            let seconds =
                |name: &str| rows.number("choices", name, "seconds a millisecond").unwrap_or(f64::INFINITY);
            let all = rows.column("choices", quantity);
            let curve = |name: &str| rows.get("choices", name, "curve").unwrap_or_default().to_owned();
            let finer = |a: &str, b: &str| curve(a) == curve(b) && seconds(a) >= seconds(b);
            let holds =
                |name: &str| all.iter().filter(|(other, _)| finer(other, name)).all(|(_, e)| *e <= share);
            let good = all.iter().map(|(name, _)| *name).filter(|name| holds(name));
            let best = good.min_by(|a, b| seconds(a).total_cmp(&seconds(b)));
            let best = best.map(|name| (name.to_owned(), seconds(name)));
            let asked = format!("{what} within {} %", 100.0 * share);
            rows.word("in short", &asked, "by", best.as_ref().map_or("", |b| b.0.as_str()));
            rows.value("in short", &asked, "seconds", best.map(|b| b.1));
        }
    }
    let mean = |name: &str| rows.number("choices", name, "impulse g");
    let of = rows.column("choices", "impulse g, scatter");
    let mut scatter: Vec<f64> = of.into_iter().filter_map(|(name, s)| Some(s / mean(name)?)).collect();
    scatter.sort_unstable_by(f64::total_cmp);
    let median = scatter.get(scatter.len() / 2).copied();
    rows.value("in short", "impulse", "scatter of a start", median);
    for wanted in [0.2, 0.1] {
        let starts = median.map(|scatter| (scatter / wanted).powi(2).ceil());
        rows.value("in short", "impulse", &format!("starts for {} %", 100.0 * wanted), starts);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn measured(start: usize, seconds: f64, force_n: f64, exit: f64, impulse: f64) -> Measured {
        let (events_ms, impulse_g) = (Some([1.0, exit]), Some(impulse));
        Measured { start, seconds, nanoseconds: Some(3.0), force_n, events_ms, impulse_g }
    }

    #[test]
    fn by_hand_a_choice_is_held_against_the_same_starts_of_the_reference() {
        let reference = vec![measured(0, 9.0, 100.0, 5.0, 50.0), measured(1, 9.0, 200.0, 6.0, 70.0)];
        // The third start has no twin: its force is not compared.
        let starts = [
            measured(0, 1.0, 101.0, 5.0, 30.0),
            measured(1, 3.0, 194.0, 6.5, 90.0),
            measured(2, 2.0, 1.0, 9.0, 60.0),
        ];
        let mut rows = Rows::default();
        put(&mut rows, "coarse", &starts, Some(&reference));
        put(&mut rows, "fine", &reference, None);
        let of = |name: &str, quantity: &str| rows.number("choices", name, quantity);
        assert_eq!(of("coarse", "seconds a millisecond"), Some(1.0));
        let [force, events] = ["force error", "events error"].map(|q| of("coarse", q).expect("two twins"));
        assert!((force - 0.02).abs() < 1e-12 && (events - 0.05).abs() < 1e-12, "{force} {events}");
        assert_eq!(of("coarse", "impulse off reference"), Some(0.0));
        assert_eq!((of("fine", "force error"), of("fine", "impulse off reference")), (None, None));
    }

    #[test]
    fn behaves_a_choice_that_does_not_stay_accurate_when_refined_is_not_advised() {
        let mut rows = Rows::default();
        for (name, curve, seconds, error) in
            [("lucky", "a", 1.0, 0.001), ("its finer", "a", 2.0, 0.2), ("good", "b", 3.0, 0.01)]
        {
            rows.word("choices", name, "curve", curve);
            rows.values("choices", name, [("seconds a millisecond", seconds), ("force error", error)]);
        }
        derive(&mut rows);
        assert_eq!(rows.get("in short", "force within 5 %", "by"), Some("good"));
    }
}
