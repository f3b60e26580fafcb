//! `cargo xtask study impulse`: whether the impulse at the exit is that of a finer mesh. A single impulse is
//! no evidence: rollers without load rattle, and two starts that differ by a microsecond differ by a factor.
//! Their distributions are compared.

use anyhow::Result;
use stribeck_analysis::levels::impulse_span;
use stribeck_analysis::noise;
use stribeck_analysis::prediction::Prediction;
use stribeck_analysis::record::Record;
use stribeck_analysis::signal::{smoothed_peak, smoothed_rms};
use stribeck_report::plot::{Axis, Colour, Figure, Series};

use crate::page::decimals;
use crate::sample::{Sample, correlation_within, ratio};
use crate::{Finished, Flags, Host, Plan, Rows, Runner, figure};

/// Flags of `study impulse`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[command(flatten)]
    flags: Flags,
    /// Starts of each mesh, 0.01° of the cage apart; half as many in tight pockets, where they scatter less
    #[arg(long, value_name = "N", default_value_t = 16, value_parser = clap::value_parser!(u16).range(2..=1000))]
    starts: u16,
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

/// Numbers of one start at one sensor.
type Impulse = [f64; 10];

/// Their names; the last two, of roller 1 and its cage, are the same at all sensors.
const QUANTITIES: [&str; 10] = [
    "peak g",
    "peak below 8.9 kHz g",
    "peak below 4.4 kHz g",
    "peak below 2.1 kHz g",
    "root of the energy, g √ms",
    "first blow, RMS g",
    "first blow below 8.9 kHz, RMS g",
    "first blow below 2.1 kHz, RMS g",
    "behind the middle of its pocket, µm",
    "largest force of the cage, N",
];
const SLOW: usize = 3;
const SLOW_BLOW: usize = 7;
const OF_ROLLER: std::ops::Range<usize> = 8..10;

/// Starts of a mesh at one sensor.
type Impulses<'a> = (&'a str, Vec<Impulse>);

pub(crate) fn measure(options: &Options, host: &Host, rows: &mut Rows) -> Result<()> {
    let runner = Runner::new("impulse", &options.flags, host);
    let plan = Plan::read("impulse")?;
    for group in &plan.groups {
        let starts = if group.table == "tight" { (options.starts / 2).max(2) } else { options.starts };
        let mut meshes = Vec::new();
        for variant in plan.variants(group) {
            meshes.push((variant.name.clone(), runner.run(&Plan::starts(&variant, starts))?));
        }
        let Some(first) = meshes.iter().flat_map(|(_, runs)| runs).next() else { continue };
        let sensors: Vec<String> = first.written.output.sensors.iter().map(|s| s.name.clone()).collect();
        for (number, sensor) in sensors.iter().enumerate() {
            let all: Vec<Impulses<'_>> = meshes
                .iter()
                .map(|(name, runs)| {
                    (name.as_str(), runs.iter().filter_map(|run| impulse(run, number)).collect())
                })
                .filter(|(_, impulses): &Impulses<'_>| impulses.len() > 1)
                .collect();
            compare(rows, sensor, 0..OF_ROLLER.start, &all);
            if number == 0 {
                compare(rows, "roller 1", OF_ROLLER, &all);
                for with in OF_ROLLER.chain([SLOW_BLOW]) {
                    let pairs = |(_, of): &Impulses<'_>| of.iter().map(|i| [i[with], i[SLOW]]).collect();
                    let value = correlation_within(&all.iter().map(pairs).collect::<Vec<_>>());
                    rows.value("correlations", &group.table, QUANTITIES[with], value);
                }
                pictures(&runner, &group.table, sensor, &all)?;
            }
        }
    }
    Ok(())
}

/// Means of each mesh, and how far each is off the last.
fn compare(rows: &mut Rows, table: &str, quantities: std::ops::Range<usize>, groups: &[Impulses<'_>]) {
    for (at, name) in quantities.clone().zip(&QUANTITIES[quantities]) {
        let sample = |impulses: &[Impulse]| Sample::of(&impulses.iter().map(|i| i[at]).collect::<Vec<_>>());
        let samples: Vec<Sample> = groups.iter().map(|(_, impulses)| sample(impulses)).collect();
        for ((group, impulses), sample) in groups.iter().zip(&samples) {
            rows.value(table, group, "starts", impulses.len() as f64);
            sample.put(rows, table, group, name);
        }
        let (Some(((reference, _), others)), Some(last)) = (groups.split_last(), samples.last()) else {
            continue;
        };
        if at >= OF_ROLLER.start {
            continue;
        }
        for ((group, _), sample) in others.iter().zip(&samples) {
            let [off, error] = ratio(sample, last).map(|v| 100.0 * v);
            let name = format!("{name}, off {} %", reference.trim_start_matches("tight-"));
            rows.value(table, group, &name, off);
            rows.value(table, group, &format!("{name}, standard error"), error);
        }
    }
}

/// How far meshes are off the finest, bold where it is more than two standard errors.
pub(crate) fn derive(rows: &mut Rows) {
    for table in ["side", "shoulder", "seat", "bottom"] {
        for variant in rows.variants(table) {
            for name in &QUANTITIES[..OF_ROLLER.start] {
                let number = |what: &str| rows.number(table, &variant, &format!("{name}, off fine %{what}"));
                let Some((off, error)) = number("").zip(number(", standard error")) else { continue };
                let bold = if off.abs() > 2.0 * error { "**" } else { "" };
                let word = format!("{bold}{} ± {}{bold}", decimals(off, 0), decimals(error, 0));
                rows.word(table, &variant, &format!("{name}, off"), &word);
            }
        }
    }
}

/// The part of the starts whose peak is below a level.
fn pictures(runner: &Runner<'_>, family: &str, sensor: &str, groups: &[Impulses<'_>]) -> Result<()> {
    let (prefix, room) = if family == "tight" { ("tight-", "0.01") } else { ("", "0.1") };
    for (at, id, title) in
        [(0, "peaks", "Peak of the impulse"), (1, "slow-peaks", "Peak of the impulse below 8.9 kHz")]
    {
        let title = format!("{title}, {sensor}, pockets with {room} mm of room");
        let (x, y) = (Axis::plain("Peak", "g"), Axis::plain("Part of the starts below it", "%"));
        let mut figure = Figure::new(&format!("{prefix}{id}"), &title, x, y);
        for ((group, impulses), colour) in groups.iter().zip(Colour::FOREGROUNDS) {
            let mut peaks: Vec<f64> = impulses.iter().map(|i| i[at]).collect();
            peaks.sort_unstable_by(f64::total_cmp);
            let n = peaks.len() as f64;
            let below = (0..peaks.len()).map(|i| 100.0 * (i as f64 + 0.5) / n).collect();
            figure = figure.with(Series::listed(group, colour, peaks, below));
        }
        figure::draw(runner.study, &figure)?;
    }
    Ok(())
}

fn impulse(run: &Finished, sensor: usize) -> Option<Impulse> {
    let read = run.trace()?;
    let exit_s = Prediction::of(&read.scene, &read.info.mesh).passages().first()?.exit_s;
    let (record, name) = (Record::whole(&read).ok()?, &run.written.output.sensors.get(sensor)?.name);
    let interval = record.interval_s();
    let all = record.acceleration_g(name, "ay")?;
    let vertical = all.get(impulse_span(record.time_s(), exit_s))?;
    let mean = |width| smoothed_peak(vertical, interval, width);
    let met = meets(&record, exit_s)?;
    let blow = |width| smoothed_rms(&all, interval, met, BLOW_S, width);
    let whole = noise::impulse(&record, name, exit_s)?;
    let [behind_um, cage_n] = roller(&record, met)?;
    Some([
        whole.peak_g,
        mean(MEANS_S[0])?,
        mean(MEANS_S[1])?,
        mean(MEANS_S[2])?,
        whole.energy_g2_ms.sqrt(),
        blow(interval)?,
        blow(MEANS_S[0])?,
        blow(MEANS_S[2])?,
        behind_um,
        cage_n,
    ])
}

/// Sample in which roller 1 meets the raceway behind the groove.
fn meets(record: &Record<'_>, exit_s: f64) -> Option<usize> {
    let (roller, from) = (record.roller(1)?, exit_s - BEFORE_S);
    let pushed = roller.outer_fx.iter().zip(roller.outer_fy).map(|(x, y)| x.hypot(*y));
    record.time_s().iter().zip(pushed).position(|(&time, force)| time >= from && force > MET_N)
}

/// Roller 1 when it meets the raceway in sample `met`: how far it is behind the middle of its pocket [µm],
/// and the largest force of the cage on it within the millisecond from then on [N].
fn roller(record: &Record<'_>, met: usize) -> Option<[f64; 2]> {
    let roller = record.roller(1)?;
    let [x, y, angle] = ["x_m", "y_m", "angle_rad"].map(|what| record.channel(&format!("cage.{what}")));
    let (x, y, angle) = (x?, y?, angle?);
    let seen = |i: usize| ([roller.x[i] - x[i], roller.y[i] - y[i]], angle[i]);
    let [fx, fy] = ["roller.1.cage_fx_n", "roller.1.cage_fy_n"].map(|name| record.channel(name));
    let within = met..met + (STRIKES_S / record.interval_s()).round() as usize;
    let forces = fx?.get(within.clone())?.iter().zip(fy?.get(within)?).map(|(x, y)| x.hypot(*y));
    Some([1e6 * behind(seen(0), seen(met)), forces.fold(0.0, f64::max)])
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
