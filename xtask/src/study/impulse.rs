//! `cargo xtask study impulse`: whether the impulse at the exit is that of a finer mesh. A single impulse says little: rollers
//! without load rattle, and two starts that differ by a microsecond differ by a factor. Their distributions are compared.

mod statistics;
mod variants;

use std::process::ExitCode;

use anyhow::Result;
use stribeck_analysis::levels::impulse_span;
use stribeck_analysis::noise;
use stribeck_analysis::plot::{Axis, Colour, Figure, Series};
use stribeck_analysis::prediction::Prediction;
use stribeck_analysis::record::Record;
use stribeck_analysis::signal::smoothed_peak;
use stribeck_bearing::run_dir::Run;

use self::statistics::{Sample, ratio};
use super::table::number;
use super::{Finished, Flags, Runner, Sheet};
use crate::workspace;

/// Flags of `study impulse`.
#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    #[command(flatten)]
    flags: Flags,
    /// Starts of each mesh, 0.01° of the cage apart
    #[arg(long, value_name = "N", default_value_t = 16, value_parser = clap::value_parser!(u16).range(2..=1000))]
    starts: u16,
}

/// A number of one start.
struct Quantity {
    name: &'static str,
    decimals: usize,
    of: fn(&Impulse) -> f64,
}

/// Running means over these times leave what is slower than 8.9, 4.4 and 2.1 kHz (−3 dB) [s].
const MEANS_S: [f64; 3] = [50e-6, 100e-6, 210e-6];

/// The impulse of one start at one sensor.
struct Impulse {
    whole: noise::Impulse,
    /// Largest magnitude of each running mean.
    means_g: [f64; 3],
}

const QUANTITIES: [Quantity; 5] = [
    Quantity { name: "peak g", decimals: 0, of: |i| i.whole.peak_g },
    Quantity { name: "peak below 8.9 kHz g", decimals: 1, of: |i| i.means_g[0] },
    Quantity { name: "peak below 4.4 kHz g", decimals: 1, of: |i| i.means_g[1] },
    Quantity { name: "peak below 2.1 kHz g", decimals: 1, of: |i| i.means_g[2] },
    Quantity { name: "root of the energy, g √ms", decimals: 1, of: |i| i.whole.energy_g2_ms.sqrt() },
];

pub(crate) fn run(options: &Options) -> Result<ExitCode> {
    let runner = Runner::new("impulse", &options.flags)?;
    let mut groups = Vec::new();
    for (group, shows, list) in variants::groups(options.starts) {
        groups.push((group, shows, runner.run(&list)?));
    }
    let mut sheet = Sheet::new("impulse", "The impulse at the exit against finer meshes");
    introduce(&mut sheet, &groups);
    let scene = groups.iter().flat_map(|(_, _, runs)| runs).map(|run| &run.scene).next();
    let sensors = scene.map_or(&[][..], |scene| &scene.output.sensors);
    for (number, sensor) in sensors.iter().map(|sensor| &sensor.name).enumerate() {
        let impulses: Vec<(&str, Vec<Impulse>)> = groups
            .iter()
            .map(|(group, _, runs)| (*group, runs.iter().filter_map(|run| impulse(run, number)).collect()))
            .filter(|(_, impulses): &(&str, Vec<Impulse>)| impulses.len() > 1)
            .collect();
        table(&mut sheet, sensor, &impulses);
        if number == 0 {
            picture(&mut sheet, sensor, &impulses)?;
        }
    }
    println!("{}", workspace::shown(&sheet.write()?));
    Ok(ExitCode::SUCCESS)
}

fn introduce(sheet: &mut Sheet, groups: &[(&str, &str, Vec<Finished>)]) {
    sheet.say(
        "The first impulse of the bearing: vertical acceleration within 1 ms of the exit of roller 1, from starts 0.01° of the \
         cage (10 µs) apart. The impulse of a single start says little, for rollers without load rattle, and what each of \
         them does in the exit's millisecond differs from start to start by more than meshes do. So means over the \
         starts are compared, with their standard errors. Differences of more than \
         two of their standard errors are bold; of the others one cannot say that there is any. A running mean over 50, 100 \
         and 210 µs leaves what is slower than 8.9, 4.4 and 2.1 kHz.",
    );
    let rows: Vec<Vec<String>> = groups
        .iter()
        .map(|(group, shows, runs)| {
            let complete = runs.iter().filter(|run| run.numbers().is_some()).count();
            vec![(*group).to_owned(), (*shows).to_owned(), complete.to_string()]
        })
        .collect();
    sheet.table(&["mesh", "what it is", "starts"], &rows);
    for run in groups.iter().flat_map(|(_, _, runs)| runs) {
        if let Err(why) = &run.summary {
            sheet.say(&format!("`{}`: no numbers. {why}", run.variant.name));
        }
    }
}

/// Means of each group, and how far each is off the last but for chance.
fn table(sheet: &mut Sheet, sensor: &str, groups: &[(&str, Vec<Impulse>)]) {
    let Some((reference, others)) = groups.split_last() else { return };
    sheet.heading(&format!("Sensor {sensor}"));
    let heads: Vec<String> = groups.iter().map(|g| g.0.to_owned()).collect();
    let offs: Vec<String> = others.iter().map(|g| format!("{} − {} %", g.0, reference.0)).collect();
    let names: Vec<&str> = std::iter::once("mean ± standard error (scatter)")
        .chain(heads.iter().chain(&offs).map(String::as_str))
        .collect();
    let mut rows = Vec::new();
    for Quantity { name, decimals, of } in QUANTITIES {
        let samples: Vec<Sample> = groups
            .iter()
            .map(|(_, impulses)| Sample::of(&impulses.iter().map(of).collect::<Vec<f64>>()))
            .collect();
        let mut row = vec![name.to_owned()];
        for ((group, _), sample) in groups.iter().zip(&samples) {
            let [mean, error, scatter] =
                [sample.mean, sample.error(), sample.scatter].map(|v| number(v, decimals));
            row.push(format!("{mean} ± {error} ({scatter})"));
            let words =
                [("mean", sample.mean), ("standard error", sample.error()), ("scatter", sample.scatter)];
            for (word, value) in words {
                sheet.value(sensor, group, &format!("{name}, {word}"), Some(value));
            }
        }
        let last = &samples[others.len()];
        for ((group, _), sample) in others.iter().zip(&samples) {
            let [off, error] = ratio(sample, last).map(|v| 100.0 * v);
            let bold = if off.abs() > 2.0 * error { "**" } else { "" };
            row.push(format!("{bold}{} ± {}{bold}", number(off, 1), number(error, 1)));
            sheet.value(sensor, group, &format!("{name}, off {} %", reference.0), Some(off));
            sheet.value(
                sensor,
                group,
                &format!("{name}, off {} %, standard error", reference.0),
                Some(error),
            );
        }
        rows.push(row);
    }
    sheet.table(&names, &rows);
}

/// The part of the starts whose peak is below a level.
fn picture(sheet: &mut Sheet, sensor: &str, groups: &[(&str, Vec<Impulse>)]) -> Result<()> {
    const COLOURS: [Colour; 4] = [Colour::Grey, Colour::Blue, Colour::Orange, Colour::Green];
    for (id, title, of) in [
        ("peaks", "Peak of the impulse", QUANTITIES[0].of),
        ("slow-peaks", "Peak of the impulse below 8.9 kHz", QUANTITIES[1].of),
    ] {
        let mut figure = Figure::new(
            id,
            &format!("{title}, {sensor}"),
            Axis::plain("Peak", "g"),
            Axis::plain("Part of the starts below it", "%"),
        );
        for ((group, impulses), colour) in groups.iter().zip(COLOURS) {
            let mut peaks: Vec<f64> = impulses.iter().map(of).collect();
            peaks.sort_unstable_by(f64::total_cmp);
            let n = peaks.len() as f64;
            let below = (0..peaks.len()).map(|i| 100.0 * (i as f64 + 0.5) / n).collect();
            figure = figure.with(Series::listed(group, colour, peaks, below));
        }
        sheet.picture(&figure)?;
    }
    Ok(())
}

/// The first impulse of a run at one of its sensors.
fn impulse(run: &Finished, sensor: usize) -> Option<Impulse> {
    run.numbers()?;
    let read = Run::read(&run.folder).ok()?;
    let exit_s = Prediction::of(&read.scene, &read.info.mesh).passages.first()?.exit_s;
    let (record, name) = (Record::new(&read), &read.scene.output.sensors.get(sensor)?.name);
    let vertical = record.acceleration_g(name, "ay")?;
    let vertical = vertical.get(impulse_span(record.time_s(), exit_s))?;
    let mean = |width| smoothed_peak(vertical, record.interval_s(), width);
    Some(Impulse {
        whole: noise::impulse(&record, name, exit_s)?,
        means_g: [mean(MEANS_S[0])?, mean(MEANS_S[1])?, mean(MEANS_S[2])?],
    })
}
