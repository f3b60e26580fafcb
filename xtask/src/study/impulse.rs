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
use stribeck_analysis::signal::{smoothed_peak, smoothed_rms};
use stribeck_bearing::run_dir::Run;

use self::statistics::{Sample, correlation_within, ratio};
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
#[derive(Clone, Copy)]
struct Quantity {
    name: &'static str,
    decimals: usize,
    of: fn(&Impulse) -> f64,
}

/// Running means over these times leave what is slower than 8.9, 4.4 and 2.1 kHz (−3 dB) [s].
const MEANS_S: [f64; 3] = [50e-6, 100e-6, 210e-6];

/// The first blow: so long from the first contact behind the groove on. Then the load comes back, and the cage runs into
/// the roller.
const BLOW_S: f64 = 0.3e-3;

/// A roller that the outer raceway pushes by so much has met it [N].
const MET_N: f64 = 20.0;

/// The first contact is looked for from so long before the exit [s].
const BEFORE_S: f64 = 0.8e-3;

/// The impulse of one start at one sensor.
struct Impulse {
    whole: noise::Impulse,
    /// Largest magnitude of each running mean.
    means_g: [f64; 3],
    /// RMS of the first blow, and of two of its running means.
    blow_g: [f64; 3],
    roller: Roller,
}

/// Roller 1 and its cage.
#[derive(Clone, Copy)]
struct Roller {
    /// How far behind the middle of its pocket the roller is when it meets the raceway [µm].
    behind_um: f64,
    /// Largest force of the cage on it within the millisecond from then on [N].
    cage_n: f64,
}

const QUANTITIES: [Quantity; 8] = [
    Quantity { name: "peak g", decimals: 0, of: |i| i.whole.peak_g },
    Quantity { name: "peak below 8.9 kHz g", decimals: 1, of: |i| i.means_g[0] },
    Quantity { name: "peak below 4.4 kHz g", decimals: 1, of: |i| i.means_g[1] },
    Quantity { name: "peak below 2.1 kHz g", decimals: 1, of: |i| i.means_g[2] },
    Quantity { name: "root of the energy, g √ms", decimals: 1, of: |i| i.whole.energy_g2_ms.sqrt() },
    Quantity { name: "first blow, RMS g", decimals: 1, of: |i| i.blow_g[0] },
    Quantity { name: "first blow below 8.9 kHz, RMS g", decimals: 1, of: |i| i.blow_g[1] },
    Quantity { name: "first blow below 2.1 kHz, RMS g", decimals: 2, of: |i| i.blow_g[2] },
];

/// What happens to the roller, the same at all sensors.
const OF_ROLLER: [Quantity; 2] = [
    Quantity { name: "behind the middle of its pocket, µm", decimals: 0, of: |i| i.roller.behind_um },
    Quantity { name: "largest force of the cage, N", decimals: 0, of: |i| i.roller.cage_n },
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
        sheet.heading(&format!("Sensor {sensor}"));
        table(&mut sheet, sensor, &QUANTITIES, &impulses);
        if number == 0 {
            picture(&mut sheet, sensor, &impulses)?;
            sheet.heading("Roller 1 and its cage");
            table(&mut sheet, "roller 1", &OF_ROLLER, &impulses);
            what_scatters(&mut sheet, sensor, &impulses);
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
         and 210 µs leaves what is slower than 8.9, 4.4 and 2.1 kHz. The first blow is the 0.3 ms from where the roller meets \
         the raceway again.",
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
fn table(sheet: &mut Sheet, sensor: &str, quantities: &[Quantity], groups: &[(&str, Vec<Impulse>)]) {
    let Some((reference, others)) = groups.split_last() else { return };
    let heads: Vec<String> = groups.iter().map(|g| g.0.to_owned()).collect();
    let offs: Vec<String> = others.iter().map(|g| format!("{} − {} %", g.0, reference.0)).collect();
    let names: Vec<&str> = std::iter::once("mean ± standard error (scatter)")
        .chain(heads.iter().chain(&offs).map(String::as_str))
        .collect();
    let mut rows = Vec::new();
    for &Quantity { name, decimals, of } in quantities {
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

/// Why starts differ: where the roller lies in its pocket, and what the cage does to it.
fn what_scatters(sheet: &mut Sheet, sensor: &str, groups: &[(&str, Vec<Impulse>)]) {
    let slow = QUANTITIES[3];
    let correlation = |one: fn(&Impulse) -> f64, other: fn(&Impulse) -> f64| {
        let pairs = |impulses: &Vec<Impulse>| impulses.iter().map(|i| [one(i), other(i)]).collect();
        correlation_within(&groups.iter().map(|(_, impulses)| pairs(impulses)).collect::<Vec<_>>())
    };
    let [behind, cage] = OF_ROLLER.map(|quantity| correlation(quantity.of, slow.of));
    let blow = correlation(|i| i.blow_g[2], slow.of);
    let words = [("place in the pocket", behind), ("force of the cage", cage), ("first blow", blow)];
    for (word, value) in words {
        sheet.value(sensor, "all", &format!("correlation of {} with {word}", slow.name), Some(value));
    }
    sheet.say(&format!(
        "Within a mesh the peak below 2.1 kHz at the sensor {sensor} goes with where the roller lies in its pocket when it \
         meets the raceway (correlation {behind:.2}) and with the force of the cage on it ({cage:.2}), less with the first blow \
         ({blow:.2}): the edge brakes the roller, the cage runs into it from behind, and pushes the other rollers. A roller \
         that lies against its pocket before takes it softly.",
    ));
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
    let interval = record.interval_s();
    let all = record.acceleration_g(name, "ay")?;
    let vertical = all.get(impulse_span(record.time_s(), exit_s))?;
    let mean = |width| smoothed_peak(vertical, interval, width);
    let met = meets(&record, exit_s)?;
    let blow = |width| smoothed_rms(&all, interval, met, BLOW_S, width);
    Some(Impulse {
        whole: noise::impulse(&record, name, exit_s)?,
        means_g: [mean(MEANS_S[0])?, mean(MEANS_S[1])?, mean(MEANS_S[2])?],
        blow_g: [blow(interval)?, blow(MEANS_S[0])?, blow(MEANS_S[2])?],
        roller: roller(&record, met)?,
    })
}

/// Sample in which roller 1 meets the raceway behind the groove.
fn meets(record: &Record<'_>, exit_s: f64) -> Option<usize> {
    let (roller, from) = (record.roller(1)?, exit_s - BEFORE_S);
    let pushed = roller.outer_fx.iter().zip(roller.outer_fy).map(|(x, y)| x.hypot(*y));
    record.time_s().iter().zip(pushed).position(|(&time, force)| time >= from && force > MET_N)
}

/// Roller 1 in its pocket when it meets the raceway in sample `met`.
fn roller(record: &Record<'_>, met: usize) -> Option<Roller> {
    let (roller, cage) = (record.roller(1)?, record.channel("cage.angle_rad")?);
    let [fx, fy] = ["roller.1.cage_fx_n", "roller.1.cage_fy_n"].map(|name| record.channel(name));
    // It starts in the middle; bearings turn clockwise.
    let [start, now] = [0, met].map(|i| (roller.x[i], roller.y[i], cage[i]));
    let turned = (start.0 * now.1 - start.1 * now.0).atan2(start.0 * now.0 + start.1 * now.1);
    let behind = turned - (now.2 - start.2);
    let within = met..met + (1e-3 / record.interval_s()).round() as usize;
    let forces = fx?.get(within.clone())?.iter().zip(fy?.get(within)?).map(|(x, y)| x.hypot(*y));
    Some(Roller { behind_um: 1e6 * behind * now.0.hypot(now.1), cage_n: forces.fold(0.0, f64::max) })
}
