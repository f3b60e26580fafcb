//! `cargo xtask study impulse`: whether the impulse at the exit is that of a finer mesh. A single impulse is
//! no evidence: rollers without load rattle, and two starts that differ by a microsecond differ by a factor.
//! Their distributions are compared.

pub(crate) mod statistics;
mod variants;

use anyhow::Result;
use stribeck_analysis::levels::impulse_span;
use stribeck_analysis::noise;
use stribeck_analysis::prediction::Prediction;
use stribeck_analysis::record::Record;
use stribeck_analysis::signal::{smoothed_peak, smoothed_rms};
use stribeck_report::plot::{Axis, Colour, Figure, Series};
use stribeck_store::run_dir::Run;

use self::statistics::{Sample, correlation_within, ratio};
use self::variants::Family;
use crate::table::number;
use crate::{Answer, Finished, Flags, Host, Runner, Sheet};

/// Flags of `study impulse`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[command(flatten)]
    flags: Flags,
    /// Starts of each mesh, 0.01° of the cage apart; half as many in tight pockets
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

/// Widths of running means, which are low-pass filters at 8.9, 4.4 and 2.1 kHz (−3 dB) [s].
const MEANS_S: [f64; 3] = [50e-6, 100e-6, 210e-6];

/// The first blow: so long from the first contact behind the groove on. Then the load comes back, and the
/// cage runs into the roller.
const BLOW_S: f64 = 0.3e-3;

/// Force of the outer raceway above which a roller counts as in contact with it [N].
const MET_N: f64 = 20.0;

/// The cage strikes within so long after the first contact [s].
const STRIKES_S: f64 = 1e-3;

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

/// The peak below 2.1 kHz among them.
const SLOW: usize = 3;

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

/// Quantities of the roller, the same at all sensors.
const OF_ROLLER: [Quantity; 2] = [
    Quantity { name: "behind the middle of its pocket, µm", decimals: 0, of: |i| i.roller.behind_um },
    Quantity { name: "largest force of the cage, N", decimals: 0, of: |i| i.roller.cage_n },
];

/// A mesh and the results of its starts.
struct Group {
    name: &'static str,
    runs: Vec<Finished>,
}

/// Impulses of a mesh at one sensor.
type Impulses = (&'static str, Vec<Impulse>);

pub(crate) fn run(options: &Options, host: &dyn Host) -> Result<Answer> {
    let runner = Runner::new("impulse", &options.flags, host);
    let mut sheet = Sheet::new(host.root(), "impulse", "The impulse at the exit against finer meshes");
    let (mut meshes, mut shown) = (Vec::new(), Vec::new());
    for Family { name, id, meshes: list } in variants::families(options.starts) {
        let mut groups = Vec::new();
        for mesh in list {
            let runs = runner.run(&mesh.starts)?;
            let measured = runs.iter().filter(|run| impulse(run, 0).is_some()).count();
            meshes.push(vec![mesh.name.to_owned(), mesh.shows.to_owned(), measured.to_string()]);
            groups.push(Group { name: mesh.name, runs });
        }
        shown.push((name, id, groups));
    }
    introduce(&mut sheet, &meshes, shown.iter().flat_map(|(.., groups)| groups));
    for (family, id, groups) in &shown {
        show(&mut sheet, family, id, groups)?;
    }
    Ok(Answer::on(sheet.write()?))
}

fn introduce<'a>(sheet: &mut Sheet, meshes: &[Vec<String>], groups: impl Iterator<Item = &'a Group>) {
    sheet.say(
        "The first impulse of the bearing: vertical acceleration within 1 ms of the exit of roller 1, from \
         starts 0.01° of the \
         cage (10 µs) apart. The impulse of a single start says little, for rollers without load rattle, and \
         what each of \
         them does in the exit's millisecond differs from start to start by more than meshes do. So means \
         over the \
         starts are compared, with their standard errors. Differences of more than \
         two of their standard errors are bold; of the others one cannot say that there is any. A running \
         mean over 50, 100 \
         and 210 µs leaves what is slower than 8.9, 4.4 and 2.1 kHz. The first blow is the 0.3 ms from where \
         the roller meets \
         the raceway again.",
    );
    sheet.table(&["mesh", "what it is", "starts"], meshes);
    for run in groups.flat_map(|group| &group.runs) {
        if let Err(why) = &run.summary {
            sheet.say(&format!("`{}`: no numbers. {why}", run.variant.name));
        }
    }
}

/// All sensors under one cage.
fn show(sheet: &mut Sheet, family: &str, id: &str, groups: &[Group]) -> Result<()> {
    let Some(scene) = groups.iter().flat_map(|group| &group.runs).map(|run| &run.scene).next() else {
        return Ok(());
    };
    for (number, sensor) in scene.written.output.sensors.iter().map(|sensor| &sensor.name).enumerate() {
        let impulses: Vec<Impulses> = groups
            .iter()
            .map(|group| (group.name, group.runs.iter().filter_map(|run| impulse(run, number)).collect()))
            .filter(|(_, impulses): &Impulses| impulses.len() > 1)
            .collect();
        if impulses.is_empty() {
            continue;
        }
        sheet.heading(&format!("Sensor {sensor}, {family}"));
        compare(sheet, sensor, &impulses);
        if number == 0 {
            picture(sheet, id, sensor, family, &impulses)?;
            sheet.heading(&format!("Roller 1 and its cage, {family}"));
            of_roller(sheet, sensor, &impulses);
        }
    }
    Ok(())
}

/// Means of each mesh, and how far each is off the last but for chance.
fn compare(sheet: &mut Sheet, sensor: &str, groups: &[Impulses]) {
    let Some((reference, others)) = groups.split_last() else { return };
    let offs: Vec<String> = others.iter().map(|g| format!("{} − {} %", g.0, reference.0)).collect();
    let mut rows = Vec::new();
    for quantity in QUANTITIES {
        let (mut row, samples) = means(sheet, sensor, quantity, groups);
        let last = &samples[others.len()];
        for ((group, _), sample) in others.iter().zip(&samples) {
            let [off, error] = ratio(sample, last).map(|v| 100.0 * v);
            let bold = if off.abs() > 2.0 * error { "**" } else { "" };
            row.push(format!("{bold}{} ± {}{bold}", number(off, 1), number(error, 1)));
            let name = format!("{}, off {} %", quantity.name, reference.0);
            sheet.value(sensor, group, &name, Some(off));
            sheet.value(sensor, group, &format!("{name}, standard error"), Some(error));
        }
        rows.push(row);
    }
    sheet.table(&heads(groups, &offs), &rows);
}

/// Position of the roller in its pocket, force of the cage on it, and correlation of the slow part of the
/// impulse with both.
fn of_roller(sheet: &mut Sheet, sensor: &str, groups: &[Impulses]) {
    let rows: Vec<Vec<String>> =
        OF_ROLLER.iter().map(|&quantity| means(sheet, "roller 1", quantity, groups).0).collect();
    sheet.table(&heads(groups, &[]), &rows);
    let slow = QUANTITIES[SLOW];
    let correlation = |of: fn(&Impulse) -> f64| {
        let pairs = |impulses: &Vec<Impulse>| impulses.iter().map(|i| [of(i), (slow.of)(i)]).collect();
        correlation_within(&groups.iter().map(|(_, impulses)| pairs(impulses)).collect::<Vec<_>>())
    };
    let [behind, cage] = OF_ROLLER.map(|quantity| correlation(quantity.of));
    let blow = correlation(|i| i.blow_g[2]);
    let [behind, cage, blow] = [behind, cage, blow].map(|value| number(value, 2));
    sheet.say(&format!(
        "Correlations within meshes of the peak below 2.1 kHz at the sensor {sensor}: {behind} with the \
         roller's place in its \
         pocket, {cage} with the force of the cage, {blow} with the first blow below 2.1 kHz.",
    ));
}

/// Names of the columns of a table of means, and more.
fn heads<'a>(groups: &[Impulses], more: &'a [String]) -> Vec<&'a str> {
    let names = groups.iter().map(|(name, _)| *name);
    ["mean ± standard error (scatter)"]
        .into_iter()
        .chain(names)
        .chain(more.iter().map(String::as_str))
        .collect()
}

/// The row of means of a quantity.
fn means(
    sheet: &mut Sheet,
    table: &str,
    quantity: Quantity,
    groups: &[Impulses],
) -> (Vec<String>, Vec<Sample>) {
    let Quantity { name, decimals, of } = quantity;
    let sample = |impulses: &Vec<Impulse>| Sample::of(&impulses.iter().map(of).collect::<Vec<f64>>());
    let samples: Vec<Sample> = groups.iter().map(|(_, impulses)| sample(impulses)).collect();
    let mut row = vec![name.to_owned()];
    for ((group, _), sample) in groups.iter().zip(&samples) {
        let [mean, error, scatter] =
            [sample.mean, sample.error(), sample.scatter].map(|v| number(v, decimals));
        row.push(format!("{mean} ± {error} ({scatter})"));
        let words = [("mean", sample.mean), ("standard error", sample.error()), ("scatter", sample.scatter)];
        for (word, value) in words {
            sheet.value(table, group, &format!("{name}, {word}"), Some(value));
        }
    }
    (row, samples)
}

/// The part of the starts whose peak is below a level.
fn picture(sheet: &mut Sheet, prefix: &str, sensor: &str, family: &str, groups: &[Impulses]) -> Result<()> {
    const COLOURS: [Colour; 4] = [Colour::Grey, Colour::Blue, Colour::Orange, Colour::Green];
    for (id, title, of) in [
        ("peaks", "Peak of the impulse", QUANTITIES[0].of),
        ("slow-peaks", "Peak of the impulse below 8.9 kHz", QUANTITIES[1].of),
    ] {
        let mut figure = Figure::new(
            &format!("{prefix}{id}"),
            &format!("{title}, {sensor}, {family}"),
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
    let exit_s = Prediction::of(&read.scene, &read.info.mesh).passages().first()?.exit_s;
    let (record, name) = (Record::whole(&read).ok()?, &read.scene.written.output.sensors.get(sensor)?.name);
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
    let roller = record.roller(1)?;
    let [x, y, angle] = ["x_m", "y_m", "angle_rad"].map(|what| record.channel(&format!("cage.{what}")));
    let (x, y, angle) = (x?, y?, angle?);
    let seen = |i: usize| ([roller.x[i] - x[i], roller.y[i] - y[i]], angle[i]);
    let [fx, fy] = ["roller.1.cage_fx_n", "roller.1.cage_fy_n"].map(|name| record.channel(name));
    let within = met..met + (STRIKES_S / record.interval_s()).round() as usize;
    let forces = fx?.get(within.clone())?.iter().zip(fy?.get(within)?).map(|(x, y)| x.hypot(*y));
    Some(Roller { behind_um: 1e6 * behind(seen(0), seen(met)), cage_n: forces.fold(0.0, f64::max) })
}

/// How far a roller lies behind the middle of its pocket [m], where it was at the start, in a bearing that
/// turns clockwise: from its place seen from the cage's centre [m] and the cage's angle [rad], then and now.
fn behind(([x0, y0], angle0): ([f64; 2], f64), ([x, y], angle): ([f64; 2], f64)) -> f64 {
    let turned = (x0 * y - y0 * x).atan2(x0 * x + y0 * y);
    (turned - (angle - angle0)) * x.hypot(y)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_hand_place_in_a_pocket_of_a_cage_that_has_turned() {
        let at = |angle: f64| [0.09 * angle.cos(), 0.09 * angle.sin()];
        assert!(behind((at(1.6), 0.2), (at(1.5), 0.1)).abs() < 1e-15);
        // Clockwise rotation decreases the angle: the body that has turned less is behind.
        assert!((behind((at(1.6), 0.0), (at(1.501), -0.1)) - 0.09e-3).abs() < 1e-15);
    }
}
