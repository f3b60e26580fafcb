//! `cargo xtask study spall_size`: does the force at the exit of a spall grow with its depth and its width?
//!
//! The question is that of Li, Yan and others (J. Vibroengineering 2022, doi 10.21595/jve.2022.22773): an
//! explicit model in the plane of shaft, bearing and pedestal, and an indicator, the contact force with a
//! defect over that without.

use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use stribeck_analysis::record::Record;
use stribeck_analysis::summary::Summary;
use stribeck_plans::campaign::Campaign;
use stribeck_report::plot::{Axis, Colour, Figure, Series};
use stribeck_scene::scene::Scene;
use stribeck_store::run_dir::Run;

use crate::impulse::statistics::Sample;
use crate::table::number;
use crate::{Answer, Flags, Host, Runner, Sheet, Variant};

/// Flags of `study spall_size`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[command(flatten)]
    flags: Flags,
}

/// The spalls.
const CAMPAIGN: &str = "fixtures/campaigns/spall_size.ron";
/// The scene of that campaign, for the bearing without a spall, and what it sets.
const HEALTHY: &str = "fixtures/scenes/studies/loop.ron";
/// Starts of the bearing without a spall: places of the first ball [°].
const HEALTHY_AT: [f64; 3] = [90.0, 103.0, 117.0];
/// The blow is looked for so far behind the trailing edge, and the force before the spall as far before the
/// leading one, but not nearer to it than the second, where a ball gives way to the edge [mm].
const REACH_MM: [f64; 2] = [1.5, 0.3];
/// Passages count from here on, when the bearing has settled [s].
const FROM_S: f64 = 0.03;

/// The passages over one place, and how they went.
#[derive(Default)]
struct Passages {
    /// Mean force of the ball on the outer raceway before the place in each, and the largest behind it [N].
    forces_n: Vec<[f64; 2]>,
    /// Events of the spall, those in which the ball comes free, and in which it touches the floor.
    events: usize,
    free: usize,
    floor: usize,
}

/// A spall, with the passages of all starts.
struct Size {
    length_mm: f64,
    depth_mm: f64,
    sagitta_mm: f64,
    passages: Passages,
    /// Mean of the largest forces at the same place of the bearing without a spall [N].
    healthy_n: f64,
    /// Largest forces behind the spall over that, and over the means before it.
    ratios: [Sample; 2],
}

pub(crate) fn run(options: &Options, host: &dyn Host) -> Result<Answer> {
    let campaign = Campaign::read(&host.root().join(CAMPAIGN))?;
    let out = host.root().join("runs/study/spall_size");
    if !options.flags.runs_nothing() {
        let mut command = host.stribeck()?;
        command.arg("campaign").arg(host.root().join(CAMPAIGN)).arg("--out").arg(out.join("campaign"));
        let done = command.args(options.flags.of_a_command()).status();
        let done = done.context("`stribeck campaign` does not start")?;
        ensure!(done.success(), "`stribeck campaign {CAMPAIGN}` did not come to its end: see above");
    }
    let first = campaign.runs.iter().find_map(|run| run.scene.as_ref().ok()).context("no scene")?;
    let healthy = healthy(options, host, first)?;
    let like = first.defect.as_ref().context("a spall")?.angle_deg;
    let mut sizes: Vec<Size> = Vec::new();
    for variant in &campaign.runs {
        let Ok(scene) = &variant.scene else { continue };
        let spall = scene.defect.as_ref().context("a spall")?;
        let folder = out.join("campaign/runs").join(scene.hash());
        let place = |size: &Size| size.length_mm == spall.length_mm && size.depth_mm == spall.depth_mm;
        let at = sizes.iter().position(place).unwrap_or(sizes.len());
        if at == sizes.len() {
            sizes.push(Size {
                length_mm: spall.length_mm,
                depth_mm: spall.depth_mm,
                sagitta_mm: sagitta_mm(scene, spall.length_mm),
                passages: Passages::default(),
                healthy_n: f64::NAN,
                ratios: [(); 2].map(|()| Sample::of(&[])),
            });
        }
        sizes[at].passages.read(&folder, like, spall.length_mm)?;
        sizes[at].passages.count(&folder)?;
    }
    for size in &mut sizes {
        let mut without = Passages::default();
        for folder in &healthy {
            without.read(folder, like, size.length_mm)?;
        }
        let behind = |of: &Passages| of.forces_n.iter().map(|pair| pair[1]).collect::<Vec<f64>>();
        size.healthy_n = Sample::of(&behind(&without)).mean;
        let over_without: Vec<f64> =
            behind(&size.passages).iter().map(|force| force / size.healthy_n).collect();
        let over_before: Vec<f64> =
            size.passages.forces_n.iter().map(|[before, behind]| behind / before).collect();
        size.ratios = [over_without, over_before].map(|ratios| Sample::of(&ratios));
    }
    let mut sheet =
        Sheet::new(host.root(), "spall_size", "The force at the exit by depth and width of a spall");
    introduce(&mut sheet, first, &sizes);
    table(&mut sheet, &sizes);
    pictures(&mut sheet, &sizes)?;
    answers(&mut sheet, &sizes);
    Ok(Answer::on(sheet.write()?))
}

/// Folders of the runs of the same bearing without a spall.
fn healthy(options: &Options, host: &dyn Host, like: &Scene) -> Result<Vec<PathBuf>> {
    let variants = HEALTHY_AT.map(|degrees| {
        Variant::new(format!("healthy-{degrees:.0}"), HEALTHY, &["defect=None"])
            .with(format!("operation.load_n={}", like.operation.load_n))
            .with(format!("operation.speed_rpm={}", like.operation.speed_rpm))
            .with(format!("solver.duration_ms={}", like.solver.duration_ms))
            .with(format!("bearing.first_roller_deg={degrees}"))
    });
    let runs = Runner::new("spall_size", &options.flags, host).run(&variants)?;
    ensure!(!runs.is_empty(), "the bearing without a spall has not been run");
    Ok(runs.into_iter().map(|run| run.folder).collect())
}

impl Passages {
    /// Adds the forces of a run behind a place as wide as this.
    fn read(&mut self, folder: &Path, degrees: f64, length_mm: f64) -> Result<()> {
        let run = Run::read(folder)?;
        let record = Record::whole(&run)?;
        for roller in record.rollers() {
            let orbit = roller.orbit();
            let ahead = if orbit.last() < orbit.first() { -1e3 } else { 1e3 } * run.scene.outer_race_radius;
            let past_mm: Vec<f64> =
                orbit.iter().map(|at| ahead * around(at - degrees.to_radians())).collect();
            let from = record.time_s().iter().position(|t| *t >= FROM_S).unwrap_or(past_mm.len());
            let force = roller.outer_normal();
            self.forces_n.extend(forces(&past_mm[from..], &force[from..], 0.5 * length_mm));
        }
        Ok(())
    }

    /// Adds how the passages over the spall of a run of the campaign went.
    fn count(&mut self, folder: &Path) -> Result<()> {
        let path = folder.join("summary.json");
        let text =
            std::fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
        let summary: Summary = serde_json::from_str(&text).context("summary.json")?;
        self.events += summary.events.len();
        self.free += summary.events.iter().filter(|event| event.free_ms.is_some()).count();
        self.floor += summary.events.iter().filter(|event| event.floor_n.is_some()).count();
        Ok(())
    }
}

/// An angle within half a turn of 0.
fn around(angle: f64) -> f64 {
    angle - TAU * (angle / TAU).round()
}

/// Mean force before a place of this half width and the largest behind it, of each passage that is wholly on
/// record. `past_mm` is how far the ball is past the middle.
fn forces(past_mm: &[f64], force: &[f64], half_mm: f64) -> Vec<[f64; 2]> {
    let [far, near] = REACH_MM;
    let mut all = Vec::new();
    let (mut sum, mut count, mut largest) = (0.0, 0, 0.0_f64);
    for (past, force) in past_mm.iter().zip(force) {
        if *past < -half_mm - far || *past > half_mm + far {
            if count > 0 && largest > 0.0 {
                all.push([sum / f64::from(count), largest]);
            }
            (sum, count, largest) = (0.0, 0, 0.0);
        } else if *past < -half_mm - near {
            sum += force;
            count += 1;
        } else if *past > half_mm {
            largest = largest.max(*force);
        }
    }
    all
}

/// Depth [mm] from which on a ball that does not give rests on both edges of a spall this wide and cannot
/// reach its floor: the sagitta of the ball's circle less that of the raceway's.
fn sagitta_mm(scene: &Scene, length_mm: f64) -> f64 {
    let sagitta = |diameter_mm: f64| 0.5 * (diameter_mm - (diameter_mm.powi(2) - length_mm.powi(2)).sqrt());
    sagitta(scene.bearing.roller_diameter_mm) - sagitta(scene.bearing.outer_race_diameter_mm)
}

fn introduce(sheet: &mut Sheet, scene: &Scene, sizes: &[Size]) {
    let operation = &scene.operation;
    sheet.say(&format!(
        "Li, Yan and others (J. Vibroengineering 2022, doi 10.21595/jve.2022.22773) have an explicit model \
         in the plane of shaft, bearing and pedestal, with a defect on the outer raceway. By its abstract, an \
         indicator, the contact force with the defect over that without, grows with the depth of the defect \
         and with its width. Their numbers were not at hand, so the *trend* alone is compared, with a bearing \
         of ours and nothing fitted: a 6205 in a pedestal by the reduced model, {} N, {} rpm, rectangular \
         spalls in the middle of the loaded half of the outer raceway (`{CAMPAIGN}`), three starts each.",
        operation.load_n, operation.speed_rpm,
    ));
    let healthy: Vec<f64> = sizes.iter().map(|size| size.healthy_n).collect();
    let ends = [f64::min, f64::max].map(|end| healthy.iter().copied().reduce(end).unwrap_or(f64::NAN));
    let [far, near] = REACH_MM;
    sheet.say(&format!(
        "Two indicators, both of the largest force between ball and outer raceway from the trailing edge to \
         {far} mm behind it: *over the bearing without*, as the abstract has it, over the mean of the largest \
         force at the same place of the bearing without a spall, {} to {} N by the width; *over before*, over \
         the mean force from {far} to {near} mm before the leading edge in the same passage, where the place \
         is symmetric to the other. *Free* are the passages in which the ball loses its load, *floor* those \
         in which it touches the floor; *sagitta* is the depth from which on a ball that does not give rests \
         on both edges and cannot reach the floor.",
        number(ends[0], 0),
        number(ends[1], 0),
    ));
    sheet.say(
        "Until the reduced model pressed the ring of a pedestal where a ball has come to since its preload \
         (docs/notes/reduced.md), bearings with and without a spall could not be compared: the second \
         indicator was chosen then, after the first had been seen to compare two errors.",
    );
    for width in values(sizes, WIDTH) {
        let healthy = sizes.iter().find(|size| size.length_mm == width).map(|size| size.healthy_n);
        sheet.value("healthy", &format!("{width} mm"), "force N", healthy);
    }
}

fn table(sheet: &mut Sheet, sizes: &[Size]) {
    sheet.heading("Every size");
    let rows: Vec<Vec<String>> = sizes
        .iter()
        .map(|size| {
            let Passages { events, free, floor, forces_n } = &size.passages;
            vec![
                size.length_mm.to_string(),
                size.depth_mm.to_string(),
                number(size.sagitta_mm, 3),
                with_error(&size.ratios[0]),
                with_error(&size.ratios[1]),
                number(size.ratios[1].scatter, 3),
                forces_n.len().to_string(),
                format!("{free} of {events}"),
                format!("{floor} of {events}"),
            ]
        })
        .collect();
    sheet.table(
        &[
            "width, mm",
            "depth, mm",
            "sagitta, mm",
            "over the bearing without",
            "over before",
            "its standard deviation of a passage",
            "passages",
            "free",
            "floor",
        ],
        &rows,
    );
    for size in sizes {
        let name = format!("{} × {} mm", size.length_mm, size.depth_mm);
        let shares =
            [size.passages.free, size.passages.floor].map(|n| n as f64 / size.passages.events as f64);
        let values = [
            ("over the bearing without", size.ratios[0].mean),
            ("its standard error", size.ratios[0].error()),
            ("over before", size.ratios[1].mean),
            ("its standard error, over before", size.ratios[1].error()),
            ("standard deviation, over before", size.ratios[1].scatter),
            ("share free", shares[0]),
            ("share that touches the floor", shares[1]),
        ];
        for (quantity, value) in values {
            sheet.value("sizes", &name, quantity, Some(value).filter(|value| value.is_finite()));
        }
    }
}

/// A mean and its standard error.
fn with_error(of: &Sample) -> String {
    format!("{} ± {}", number(of.mean, 4), number(of.error(), 4))
}

/// The different values of a number of all sizes, ascending.
fn values(sizes: &[Size], of: fn(&Size) -> f64) -> Vec<f64> {
    let mut all: Vec<f64> = sizes.iter().map(of).collect();
    all.sort_by(f64::total_cmp);
    all.dedup();
    all
}

/// The sizes with one value of a number, ascending by another.
fn line(sizes: &[Size], fixed: fn(&Size) -> f64, value: f64, along: fn(&Size) -> f64) -> Vec<&Size> {
    let mut all: Vec<&Size> = sizes.iter().filter(|size| fixed(size) == value).collect();
    all.sort_by(|a, b| along(a).total_cmp(&along(b)));
    all
}

const DEPTH: fn(&Size) -> f64 = |size| size.depth_mm;
const WIDTH: fn(&Size) -> f64 = |size| size.length_mm;

/// What the indicators are over, in their order.
const OVER: [&str; 2] = ["the bearing without", "before"];

fn pictures(sheet: &mut Sheet, sizes: &[Size]) -> Result<()> {
    let curves =
        |id: &str, title: &str, x: &str, fixed: fn(&Size) -> f64, along: fn(&Size) -> f64, of: &str| {
            let axes = (
                Axis::decades(x, "mm"),
                Axis::plain("largest force behind the spall over that of the bearing without", ""),
            );
            let mut figure = Figure::new(id, title, axes.0, axes.1);
            for (value, colour) in values(sizes, fixed).into_iter().zip(Colour::FOREGROUNDS) {
                let sizes = line(sizes, fixed, value, along);
                let at = sizes.iter().map(|size| along(size).log10()).collect();
                let ratios = sizes.iter().map(|size| size.ratios[0].mean).collect();
                figure = figure.with(Series::listed(&format!("{of} {value} mm"), colour, at, ratios));
            }
            figure
        };
    let by_depth = curves("depth", "The force behind a spall over depth", "depth", WIDTH, DEPTH, "width");
    sheet.picture(&by_depth.caption("Means of all passages; their standard errors are in the table."))?;
    let by_width = curves("width", "The force behind a spall over width", "width", DEPTH, WIDTH, "depth");
    sheet.picture(&by_width)
}

/// How an indicator goes along a line of sizes: where it is largest, and whether it rises to there and falls
/// from there on by more than two standard errors.
struct Course {
    largest: usize,
    rises: bool,
    falls: bool,
}

impl Course {
    fn of(means: &[&Sample]) -> Self {
        let last = means.len() - 1;
        let largest = (0..=last).max_by(|a, b| means[*a].mean.total_cmp(&means[*b].mean)).unwrap_or(last);
        let apart = |end: usize| {
            (means[largest].mean - means[end].mean) / means[largest].error().hypot(means[end].error())
        };
        let [rises, falls] = [0, last].map(|end| end != largest && apart(end) > 2.0);
        Self { largest, rises, falls }
    }

    fn in_words(&self, means: &[&Sample], largest_mm: f64) -> String {
        let at = |n: usize| number(means[n].mean, 3);
        let (first, last) = (at(0), at(means.len() - 1));
        let top = format!("{} at {largest_mm} mm", at(self.largest));
        match (self.rises, self.falls) {
            (true, false) => format!("grows from {first} to {top}"),
            (true, true) => format!("grows from {first} to {top}, then falls to {last}"),
            (false, true) => format!("falls from {first} to {last}"),
            (false, false) => format!("stays, {first} to {last}"),
        }
    }
}

fn answers(sheet: &mut Sheet, sizes: &[Size]) {
    sheet.heading("Does it grow?");
    sheet.say(
        "Means that differ by more than two of their standard errors count as different; passages of one \
         start are taken as independent.",
    );
    let mut rows = Vec::new();
    let lines = [("depth", "width", WIDTH, DEPTH), ("width", "depth", DEPTH, WIDTH)];
    let mut grown = [[0; 2]; 2];
    for (l, (what, of, fixed, along)) in lines.into_iter().enumerate() {
        for value in values(sizes, fixed) {
            let sizes = line(sizes, fixed, value, along);
            let mut row = vec![what.to_owned(), format!("{of} {value} mm")];
            for (indicator, grown) in grown.iter_mut().enumerate() {
                let means: Vec<&Sample> = sizes.iter().map(|size| &size.ratios[indicator]).collect();
                let course = Course::of(&means);
                grown[l] += usize::from(course.rises);
                row.push(course.in_words(&means, along(sizes[course.largest])));
            }
            rows.push(row);
        }
    }
    let over = OVER.map(|over| format!("over {over}"));
    sheet.table(&["with", "at", &over[0], &over[1]], &rows);
    let counts = [values(sizes, WIDTH).len(), values(sizes, DEPTH).len()];
    let ends = |indicator: usize| {
        let means = sizes.iter().map(|size| size.ratios[indicator].mean);
        [f64::min, f64::max].map(|end| number(means.clone().reduce(end).unwrap_or(f64::NAN), 3))
    };
    for (indicator, [with_depth, with_width]) in grown.into_iter().enumerate() {
        let [least, most] = ends(indicator);
        sheet.say(&format!(
            "Over {} the largest force behind a spall is {least} to {most} at this load and speed; with \
             depth it grows at {with_depth} of {} widths, with width at {with_width} of {} depths.",
            OVER[indicator], counts[0], counts[1],
        ));
    }
    let touched = sizes.iter().filter(|size| size.passages.floor > 0);
    let deepest = touched.map(|size| size.depth_mm).fold(0.0, f64::max);
    sheet.say(&format!(
        "No ball touches a floor deeper than {deepest} mm, whatever the sagitta: it is caught by the \
         trailing edge before it gets there, and a floor that is not reached cannot be felt."
    ));
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ball of 7.94 mm over 2 mm of a raceway of 46.98 mm: c²/8 (1/r − 1/R) = 0.105 mm for short chords.
    #[test]
    fn by_hand_sagitta_of_a_ball_over_a_spall() {
        let set = ["bearing=6205".to_owned()];
        let scene = Scene::singh2014().with_overrides(&set).expect("a scene");
        assert!((sagitta_mm(&scene, 2.0) - 0.105).abs() < 2e-3, "{}", sagitta_mm(&scene, 2.0));
    }

    #[test]
    fn by_hand_forces_before_and_behind_of_passages_that_are_wholly_on_record() {
        let past: Vec<f64> = (0..81).map(|n| 0.1 * (f64::from(n) - 40.5)).collect();
        let force: Vec<f64> = past.iter().map(|x| if *x < 0.0 { 2.0 } else { 3.0 + x }).collect();
        let [pair] = forces(&past, &force, 1.0)[..] else { panic!("one passage") };
        assert!((pair[0] - 2.0).abs() < 1e-12 && (pair[1] - 5.45).abs() < 1e-12, "{pair:?}");
        // One that begins over the place, and one that ends there.
        assert!(forces(&past[40..], &force[40..], 1.0).is_empty());
        assert!(forces(&past[..40], &force[..40], 1.0).is_empty());
    }
}
