//! `cargo xtask study spall_size`: does the force at the exit of a spall grow with its depth and its width?
//!
//! The question is that of Li, Yan and others (J. Vibroengineering 2022, doi 10.21595/jve.2022.22773): an
//! explicit model in the plane of shaft, bearing and pedestal, and an indicator, the contact force with a
//! defect over that without.

use std::f64::consts::TAU;
use std::path::Path;

use anyhow::{Context, Result, ensure};
use stribeck_analysis::record::Record;
use stribeck_analysis::summary::Summary;
use stribeck_report::plot::{Axis, Colour, Figure, Series};
use stribeck_scene::campaign::Campaign;
use stribeck_scene::run_dir::Run;
use stribeck_scene::scene::Scene;

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
/// Width at which the bearing without a spall is read [mm].
const LIKE_MM: f64 = 2.0;
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
    /// Largest forces behind the spall over the means before it.
    ratio: Sample,
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
                ratio: Sample::of(&[]),
            });
        }
        sizes[at].passages.read(&folder)?;
        sizes[at].passages.count(&folder)?;
    }
    for size in &mut sizes {
        let ratios: Vec<f64> =
            size.passages.forces_n.iter().map(|[before, behind]| behind / before).collect();
        size.ratio = Sample::of(&ratios);
    }
    let mut sheet =
        Sheet::new(host.root(), "spall_size", "The force at the exit by depth and width of a spall");
    introduce(&mut sheet, first, &healthy, &sizes);
    table(&mut sheet, &sizes);
    pictures(&mut sheet, &sizes)?;
    answers(&mut sheet, &sizes);
    Ok(Answer::on(sheet.write()?))
}

/// The same bearing without a spall.
fn healthy(options: &Options, host: &dyn Host, like: &Scene) -> Result<Passages> {
    let variants = HEALTHY_AT.map(|degrees| {
        Variant::new(format!("healthy-{degrees:.0}"), HEALTHY, &["defect=None"])
            .with(format!("operation.load_n={}", like.operation.load_n))
            .with(format!("operation.speed_rpm={}", like.operation.speed_rpm))
            .with(format!("solver.duration_ms={}", like.solver.duration_ms))
            .with(format!("bearing.first_roller_deg={degrees}"))
    });
    let mut passages = Passages::default();
    for run in Runner::new("spall_size", &options.flags, host).run(&variants)? {
        passages.read(&run.folder)?;
    }
    ensure!(!passages.forces_n.is_empty(), "the bearing without a spall has not been run");
    Ok(passages)
}

impl Passages {
    /// Adds the forces of a run.
    fn read(&mut self, folder: &Path) -> Result<()> {
        let run = Run::read(folder)?;
        let record = Record::whole(&run)?;
        let spall = run.scene.written.defect.as_ref();
        let (degrees, length_mm) = spall.map_or((90.0, LIKE_MM), |spall| (spall.angle_deg, spall.length_mm));
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

fn introduce(sheet: &mut Sheet, scene: &Scene, healthy: &Passages, sizes: &[Size]) {
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
    let [far, near] = REACH_MM;
    let before = |of: &[[f64; 2]]| of.iter().map(|pair| pair[0]).sum::<f64>() / of.len() as f64;
    let sound = before(&healthy.forces_n);
    let all: Vec<f64> = sizes.iter().map(|size| before(&size.passages.forces_n)).collect();
    let ends = [f64::min, f64::max].map(|end| all.iter().copied().reduce(end).unwrap_or(f64::NAN));
    sheet.say(&format!(
        "The indicator here: the largest force between ball and outer raceway from the trailing edge to \
         {far} mm behind it, over its mean from {far} to {near} mm before the leading edge in the same \
         passage, where the place is symmetric to the other. *Free* are the passages in which the ball loses its load, \
         *floor* those in which it touches the floor; *sagitta* is the depth from which on a ball that does \
         not give rests on both edges and cannot reach the floor.",
    ));
    let behind = |of: &[[f64; 2]]| of.iter().map(|pair| pair[1]).sum::<f64>() / of.len() as f64;
    let over: Vec<f64> = sizes.iter().map(|size| behind(&size.passages.forces_n) / sound).collect();
    let span = [f64::min, f64::max].map(|end| over.iter().copied().reduce(end).unwrap_or(f64::NAN));
    sheet.say(&format!(
        "The force behind the spall over that of the bearing without one was tried first. It is {} to {} and \
         grows with neither, because balls before any spall, the shallowest and shortest too, have {} to {} N \
         at this place where those of the bearing without have {} N: more than the blow makes. That is an \
         error of the reduced model, not of the groove (docs/notes/reduced.md, static loads in a pedestal). \
         The present indicator was chosen after that was seen.",
        number(span[0], 3),
        number(span[1], 3),
        number(ends[0], 0),
        number(ends[1], 0),
        number(sound, 0),
    ));
    sheet.value("healthy", "all starts", "force N", Some(sound));
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
                number(size.ratio.mean, 3),
                number(size.ratio.error(), 3),
                number(size.ratio.scatter, 3),
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
            "indicator, mean",
            "its standard error",
            "standard deviation of a passage",
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
            ("indicator", size.ratio.mean),
            ("standard error", size.ratio.error()),
            ("standard deviation", size.ratio.scatter),
            ("share free", shares[0]),
            ("share that touches the floor", shares[1]),
        ];
        for (quantity, value) in values {
            sheet.value("sizes", &name, quantity, Some(value).filter(|value| value.is_finite()));
        }
    }
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

fn pictures(sheet: &mut Sheet, sizes: &[Size]) -> Result<()> {
    let curves =
        |id: &str, title: &str, x: &str, fixed: fn(&Size) -> f64, along: fn(&Size) -> f64, of: &str| {
            let axes = (
                Axis::decades(x, "mm"),
                Axis::plain("largest force behind the spall over that before it", ""),
            );
            let mut figure = Figure::new(id, title, axes.0, axes.1);
            for (value, colour) in values(sizes, fixed).into_iter().zip(Colour::FOREGROUNDS) {
                let sizes = line(sizes, fixed, value, along);
                let at = sizes.iter().map(|size| along(size).log10()).collect();
                let ratios = sizes.iter().map(|size| size.ratio.mean).collect();
                figure = figure.with(Series::listed(&format!("{of} {value} mm"), colour, at, ratios));
            }
            figure
        };
    let by_depth = curves("depth", "The indicator over depth", "depth", WIDTH, DEPTH, "width");
    sheet.picture(&by_depth.caption("Means of all passages; their standard errors are in the table."))?;
    let by_width = curves("width", "The indicator over width", "width", DEPTH, WIDTH, "depth");
    sheet.picture(&by_width)
}

/// Difference of two means in its standard errors.
fn apart(from: &Size, to: &Size) -> f64 {
    (to.ratio.mean - from.ratio.mean) / to.ratio.error().hypot(from.ratio.error())
}

/// How the indicator goes along a line of sizes: where it is largest, and whether it rises to there and falls
/// from there on by more than two standard errors.
struct Course {
    largest: usize,
    rises: bool,
    falls: bool,
}

impl Course {
    fn of(sizes: &[&Size]) -> Self {
        let last = sizes.len() - 1;
        let mean = |n: usize| sizes[n].ratio.mean;
        let largest = (0..=last).max_by(|a, b| mean(*a).total_cmp(&mean(*b))).unwrap_or(last);
        let [rises, falls] = [(0, largest), (last, largest)]
            .map(|(end, top)| end != top && apart(sizes[end], sizes[top]) > 2.0);
        Self { largest, rises, falls }
    }

    fn in_words(&self, sizes: &[&Size], along: fn(&Size) -> f64) -> String {
        let at = |n: usize| number(sizes[n].ratio.mean, 3);
        let top = format!("{} at {} mm", at(self.largest), along(sizes[self.largest]));
        match (self.rises, self.falls) {
            (true, false) => format!("grows from {} to {top}", at(0)),
            (true, true) => format!("grows from {} to {top}, then falls to {}", at(0), at(sizes.len() - 1)),
            (false, true) => format!("falls from {} to {}", at(0), at(sizes.len() - 1)),
            (false, false) => format!("stays, {} to {}", at(0), at(sizes.len() - 1)),
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
    let mut count = |what: &str, of: &str, fixed: fn(&Size) -> f64, along: fn(&Size) -> f64| {
        let mut grown = 0;
        let all = values(sizes, fixed);
        for value in &all {
            let sizes = line(sizes, fixed, *value, along);
            let course = Course::of(&sizes);
            grown += usize::from(course.rises);
            rows.push(vec![what.to_owned(), format!("{of} {value} mm"), course.in_words(&sizes, along)]);
        }
        format!("with {what} it grows at {grown} of {} {of}s", all.len())
    };
    let told = [count("depth", "width", WIDTH, DEPTH), count("width", "depth", DEPTH, WIDTH)].join(", ");
    sheet.table(&["with", "at", "the indicator"], &rows);
    let touched = sizes.iter().filter(|size| size.passages.floor > 0);
    let deepest = touched.map(|size| size.depth_mm).fold(0.0, f64::max);
    let most = sizes.iter().map(|size| size.ratio.mean).fold(0.0, f64::max);
    sheet.say(&format!(
        "So {told}, by {} % at most at this load and speed: the trend that the paper has, by an indicator of \
         ours. No ball touches a floor deeper than {deepest} mm, whatever the sagitta: it is caught by the \
         trailing edge before it gets there, and a floor that is not reached cannot be felt.",
        number(100.0 * (most - 1.0), 1),
    ));
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ball of 7.94 mm over 2 mm of a raceway of 46.98 mm: c²/8 (1/r − 1/R) = 0.105 mm for short chords.
    #[test]
    fn example_sagitta_of_a_ball_over_a_spall() {
        let set = ["bearing=6205".to_owned()];
        let scene = Scene::singh2014().with_overrides(&set).expect("a scene");
        assert!((sagitta_mm(&scene, 2.0) - 0.105).abs() < 2e-3, "{}", sagitta_mm(&scene, 2.0));
    }

    #[test]
    fn example_forces_before_and_behind_of_passages_that_are_wholly_on_record() {
        let past: Vec<f64> = (0..81).map(|n| 0.1 * (f64::from(n) - 40.5)).collect();
        let force: Vec<f64> = past.iter().map(|x| if *x < 0.0 { 2.0 } else { 3.0 + x }).collect();
        let [pair] = forces(&past, &force, 1.0)[..] else { panic!("one passage") };
        assert!((pair[0] - 2.0).abs() < 1e-12 && (pair[1] - 5.45).abs() < 1e-12, "{pair:?}");
        // One that begins over the place, and one that ends there.
        assert!(forces(&past[40..], &force[40..], 1.0).is_empty());
        assert!(forces(&past[..40], &force[..40], 1.0).is_empty());
    }
}
