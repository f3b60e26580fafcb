//! `cargo xtask study run_time`: error against run time of the whole bearing.

mod variants;

use anyhow::Result;
use stribeck_analysis::noise;
use stribeck_analysis::prediction::Prediction;
use stribeck_analysis::record::Record;
use stribeck_report::plot::{Axis, Colour, Figure, Series};
use stribeck_scene::scene::ModelScene;
use stribeck_store::run_dir::Run;

use self::variants::{Choice, choices};
use crate::impulse::statistics::{Sample, ratio};
use crate::table::{figures, number};
use crate::{Answer, Finished, Flags, Host, Runner, Sheet};

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
    /// Its number.
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

/// One of the relative errors of a choice.
type Error = fn(&Row) -> Option<f64>;

/// Results of all starts of a choice, beside the reference.
struct Row {
    choice: Choice,
    starts: Vec<Measured>,
    seconds: f64,
    nanoseconds: Option<f64>,
    /// Relative errors, means over the starts that the reference has too.
    force: Option<f64>,
    /// Of the time from entry to exit.
    events: Option<f64>,
    impulse: Option<Sample>,
    /// Relative difference from the reference's mean, and its standard error.
    impulse_off: Option<[f64; 2]>,
}

pub(crate) fn run(options: &Options, host: &dyn Host) -> Result<Answer> {
    let runner = Runner::new("run_time", &options.flags, host);
    let mut measured = Vec::new();
    // The dear ones last, so that an interrupted study has a table.
    let finest = options.finest_mm.parse()?;
    for choice in choices(options.starts, options.reference_starts, finest) {
        let runs = runner.run(&choice.starts)?;
        let starts: Vec<Measured> = runs.iter().filter_map(|run| measure(&choice, run)).collect();
        measured.push((choice, starts));
    }
    let mut sheet = Sheet::new(host.root(), "run_time", "Error against run time of the bearing");
    let Some(reference) = measured.iter().find(|(choice, _)| choice.reference).map(|m| m.1.clone()) else {
        anyhow::bail!("the reference is no choice");
    };
    let rows: Vec<Row> = measured
        .into_iter()
        .filter(|(_, starts)| !starts.is_empty())
        .map(|(choice, starts)| Row::of(choice, starts, &reference))
        .collect();
    introduce(&mut sheet, &rows);
    pictures(&mut sheet, &rows)?;
    table(&mut sheet, &rows);
    answers(&mut sheet, &rows, &reference);
    Ok(Answer::on(sheet.write()?))
}

/// Reads the results of a complete run.
fn measure(choice: &Choice, finished: &Finished) -> Option<Measured> {
    let (summary, info) = (finished.numbers()?, finished.info.as_ref()?);
    let start = choice.starts.iter().position(|v| v.name == finished.variant.name)?;
    let run = Run::read(&finished.folder).ok()?;
    let record = Record::whole(&run).ok()?;
    let roller = record.roller(2)?;
    let loaded = record.time_s().iter().position(|&t| t >= 1e-3 * FROM_MS)?;
    let pushed = roller.outer_fx.iter().zip(roller.outer_fy).skip(loaded).map(|(x, y)| x.hypot(*y));
    let force_n = Sample::of(&pushed.collect::<Vec<f64>>()).mean;
    let first = summary.events.iter().find(|event| event.roller == 1)?;
    let events_ms = first.entry_ms.zip(first.exit_ms).map(|(entry, exit)| [entry, exit]);
    let exit_s = Prediction::of(&run.scene, &run.info.mesh).passages().first()?.exit_s;
    let sensor = &run.scene.written.output.sensors.first()?.name;
    let elements = (info.mesh.quads + info.mesh.triangles) as f64;
    Some(Measured {
        start,
        seconds: info.loop_cpu_s / run.scene.written.solver.duration_ms,
        nanoseconds: (run.scene.written.model == ModelScene::Full)
            .then(|| 1e9 * info.loop_cpu_s / (info.steps as f64 * elements)),
        force_n,
        events_ms,
        impulse_g: noise::impulse(&record, sensor, exit_s).map(|i| i.peak_g),
    })
}

impl Row {
    fn of(choice: Choice, starts: Vec<Measured>, reference: &[Measured]) -> Self {
        let pairs = || {
            let twin = |m: &Measured| reference.iter().find(|r| r.start == m.start).copied();
            starts.iter().filter_map(move |m| Some((*m, twin(m)?)))
        };
        let force = mean(pairs().map(|(m, r)| (m.force_n / r.force_n - 1.0).abs()));
        let events = mean(pairs().filter_map(|(m, r)| {
            let ([entry, exit], [entry0, exit0]) = (m.events_ms?, r.events_ms?);
            Some((entry - entry0).abs().max((exit - exit0).abs()) / (exit0 - entry0))
        }));
        let impulse = sample(&starts);
        let own = choice.reference;
        let impulse_off = impulse.zip(sample(reference)).filter(|_| !own).map(|(a, b)| ratio(&a, &b));
        Self {
            // Other work on the computer only ever adds to the time.
            seconds: least(starts.iter().map(|m| m.seconds)),
            nanoseconds: starts.iter().filter_map(|m| m.nanoseconds).reduce(f64::min),
            force: force.filter(|_| !own),
            events: events.filter(|_| !own),
            impulse,
            impulse_off,
            choice,
            starts,
        }
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

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut all: Vec<f64> = values.collect();
    all.sort_unstable_by(f64::total_cmp);
    all.get(all.len() / 2).copied().unwrap_or(f64::NAN)
}

fn least(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(f64::INFINITY, f64::min)
}

fn introduce(sheet: &mut Sheet, rows: &[Row]) {
    let reference = rows.iter().find(|row| row.choice.reference);
    let (finest, starts) =
        reference.map_or(("no reference", 0), |row| (row.choice.name.as_str(), row.starts.len()));
    sheet.say(&format!(
        "What a simulated millisecond of the paper\u{2019}s bearing costs, and how far the result is from \
         the finest mesh\u{2019}s \
         ({finest} at the contacts and the defect, {starts} starts). Contact keeps its stiffness and its \
         damping over an area on all meshes, so that \
         only the mesh, the step and the way contact is evaluated differ. *Reduced* points have the modes of \
         outer ring and \
         adapter on such a mesh (THEORY §9), at one step or another, with more modes or fewer, on coarser \
         facets or on arcs. *Seconds* are processor time of the time loop, \
         the least over the starts, because other work on the machine only adds to it. *Force* is the mean \
         of the outer raceway on roller 2 from {FROM_MS} to 6.5 ms; *events* are when roller 1 \
         loses the raceway and meets it again, the larger error as a share of the time in between; both \
         start by start. The \
         *impulse* after the exit is chaotic: starts 0.01° of the cage apart differ more than meshes do, so \
         its mean over \
         the starts is compared, with one standard error.",
    ));
}

/// The curves, in the order of their first points.
fn curves(rows: &[Row]) -> Vec<(&'static str, Vec<&Row>)> {
    let mut curves: Vec<(&'static str, Vec<&Row>)> = Vec::new();
    for row in rows {
        match curves.iter_mut().find(|(name, _)| *name == row.choice.curve) {
            Some((_, points)) => points.push(row),
            None => curves.push((row.choice.curve, vec![row])),
        }
    }
    curves.iter_mut().for_each(|(_, points)| points.sort_by(|a, b| a.seconds.total_cmp(&b.seconds)));
    curves
}

const COLOURS: [Colour; 10] = [
    Colour::Grey,
    Colour::Blue,
    Colour::Purple,
    Colour::Orange,
    Colour::Teal,
    Colour::Green,
    Colour::Red,
    Colour::Brown,
    Colour::Pink,
    Colour::Black,
];

fn pictures(sheet: &mut Sheet, rows: &[Row]) -> Result<()> {
    let against = |id: &str, title: &str, quantity: &str, of: &dyn Fn(&Row) -> Option<f64>| {
        let x = Axis::decades("Processor time of a simulated millisecond", "s");
        let mut figure = Figure::new(id, title, x, Axis::decades(quantity, "%"));
        for ((name, points), colour) in curves(rows).into_iter().zip(COLOURS) {
            let found =
                points.iter().filter_map(|row| Some((row.seconds.log10(), (100.0 * of(row)?).log10())));
            let (x, y): (Vec<f64>, Vec<f64>) = found.unzip();
            let joined = Series::listed(name, colour, x.clone(), y.clone());
            figure.series.extend([joined, Series::listed("", colour, x, y).as_points()]);
        }
        figure
    };
    let force = against("force", "Force on a loaded roller", "Error of the force", &|row| row.force);
    let events = against("events", "Entry and exit", "Error of the events", &|row| row.events);
    sheet.picture(&force)?;
    sheet.picture(&events)?;
    let mut impulse = Figure::new(
        "impulse",
        "Impulse after the exit: means and standard errors",
        Axis::decades("Processor time of a simulated millisecond", "s"),
        Axis::plain("Peak at the first sensor", "g"),
    );
    for ((name, points), colour) in curves(rows).into_iter().zip(COLOURS) {
        let found = points.iter().filter_map(|row| Some((row.seconds.log10(), row.impulse?)));
        let found: Vec<(f64, Sample)> = found.collect();
        let at = |x: f64| vec![x, x];
        let bars = found
            .iter()
            .map(|(x, s)| Series::listed("", colour, at(*x), vec![s.mean - s.error(), s.mean + s.error()]));
        impulse.series.extend(bars);
        let (x, y) = found.iter().map(|(x, s)| (*x, s.mean)).unzip();
        impulse.series.push(Series::listed(name, colour, x, y).as_points());
    }
    sheet.picture(&impulse)
}

fn table(sheet: &mut Sheet, rows: &[Row]) {
    sheet.heading("All choices");
    let percent =
        |share: Option<f64>, decimals| share.map_or("–".to_owned(), |v| number(100.0 * v, decimals));
    let cells = rows.iter().map(|row| {
        let name = &row.choice.name;
        let values = [
            ("seconds a millisecond", Some(row.seconds)),
            ("ns an element-step", row.nanoseconds),
            ("force error", row.force),
            ("events error", row.events),
            ("impulse g", row.impulse.map(|s| s.mean)),
            ("impulse g, standard error", row.impulse.map(|s| s.error())),
            ("impulse g, scatter", row.impulse.map(|s| s.scatter)),
            ("impulse off reference", row.impulse_off.map(|[off, _]| off)),
        ];
        values.into_iter().for_each(|(what, value)| sheet.value("choices", name, what, value));
        for m in &row.starts {
            let start = format!("{name}, start {}", m.start);
            let [entry, exit] = m.events_ms.map_or([None; 2], |e| e.map(Some));
            let of_start = [
                ("seconds a millisecond", Some(m.seconds)),
                ("force N", Some(m.force_n)),
                ("entry ms", entry),
                ("exit ms", exit),
                ("impulse g", m.impulse_g),
            ];
            of_start.into_iter().for_each(|(what, value)| sheet.value("starts", &start, what, value));
        }
        let impulse = row.impulse.map_or("–".to_owned(), |s| {
            format!("{} ± {} ({})", number(s.mean, 0), number(s.error(), 0), number(s.scatter, 0))
        });
        let off = row.impulse_off.map_or("–".to_owned(), |[off, error]| {
            format!("{} ± {}", number(100.0 * off, 0), number(100.0 * error, 0))
        });
        vec![
            name.clone(),
            row.choice.shows.to_owned(),
            row.starts.len().to_string(),
            figures(row.seconds, 2),
            row.nanoseconds.map_or("–".to_owned(), |ns| number(ns, 1)),
            percent(row.force, 2),
            percent(row.events, 2),
            impulse,
            off,
        ]
    });
    let cells: Vec<Vec<String>> = cells.collect();
    let names = [
        "choice",
        "what it is",
        "starts",
        "s per ms",
        "ns per element-step",
        "force, %",
        "events, %",
        "impulse g ± standard error (scatter)",
        "off the reference, %",
    ];
    sheet.table(&names, &cells);
}

/// The user's question: the cheapest choice that is accurate enough and stays so when its mesh is refined.
fn answers(sheet: &mut Sheet, rows: &[Row], reference: &[Measured]) {
    sheet.heading("In short");
    let all = curves(rows);
    let holds = |row: &Row, of: Error, share: f64| {
        let finer = all.iter().filter(|(name, _)| *name == row.choice.curve).flat_map(|(_, points)| points);
        finer.filter(|r| r.seconds >= row.seconds).filter_map(|r| of(r)).all(|error| error <= share)
    };
    let mut cells = Vec::new();
    let quantities: [(&str, Error); 2] = [("force", |row| row.force), ("events", |row| row.events)];
    for (what, of) in quantities {
        for share in [0.05, 0.01] {
            let good = rows.iter().filter(|row| of(row).is_some_and(|e| e <= share) && holds(row, of, share));
            let best = good.min_by(|a, b| a.seconds.total_cmp(&b.seconds));
            let asked = format!("{what} within {} %", number(100.0 * share, 0));
            sheet.value("answers", &asked, "seconds a millisecond", best.map(|row| row.seconds));
            cells.push(vec![
                asked,
                best.map_or("none of these".to_owned(), |row| {
                    format!("{} s per ms", figures(row.seconds, 2))
                }),
                best.map_or("–".to_owned(), |row| row.choice.name.clone()),
            ]);
        }
    }
    // Scatter of single starts, over all choices by its median: which no mesh reduces.
    let scatter = median(rows.iter().filter_map(|row| row.impulse.map(|s| s.scatter / s.mean)));
    for wanted in [0.2, 0.1] {
        let starts = (scatter / wanted).powi(2).ceil();
        sheet.value("answers", &format!("impulse within {wanted}"), "starts", Some(starts));
        cells.push(vec![
            format!("mean impulse known to ± {} %", number(100.0 * wanted, 0)),
            format!("{} start{}", number(starts, 0), if starts == 1.0 { "" } else { "s" }),
            format!("a single start scatters by {} %", number(100.0 * scatter, 0)),
        ]);
    }
    sheet.table(&["wanted", "takes", "by"], &cells);
    let lacks = reference.len() < 10;
    if lacks {
        sheet.say(&format!(
            "The reference itself has {} starts, so that its mean impulse is known to ± {} % only.",
            reference.len(),
            sample(reference).map_or("–".to_owned(), |s| number(100.0 * s.error() / s.mean, 0)),
        ));
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
        let reference = [measured(0, 9.0, 100.0, 5.0, 50.0), measured(1, 9.0, 200.0, 6.0, 70.0)];
        let choice = |name: &str, reference| Choice {
            curve: "c",
            name: name.into(),
            shows: "",
            reference,
            starts: Vec::new(),
        };
        // The third start has no twin: its force is not compared.
        let starts = vec![
            measured(0, 1.0, 101.0, 5.0, 30.0),
            measured(1, 3.0, 194.0, 6.5, 90.0),
            measured(2, 2.0, 1.0, 9.0, 60.0),
        ];
        let row = Row::of(choice("coarse", false), starts, &reference);
        assert_eq!(row.seconds, 1.0);
        assert!((row.force.expect("two twins") - 0.02).abs() < 1e-12, "{:?}", row.force);
        assert!((row.events.expect("two twins") - 0.05).abs() < 1e-12, "{:?}", row.events);
        assert_eq!(row.impulse_off.expect("means")[0], 0.0);
        let itself = Row::of(choice("fine", true), reference.to_vec(), &reference);
        assert!(itself.force.is_none() && itself.impulse_off.is_none());
    }
}
