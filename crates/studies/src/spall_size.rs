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
/// The largest force of a passage is looked for so far along the raceway from the middle of the spall, either
/// way: behind the widest spall 1.5 mm are left for the blow [mm].
const REACH_MM: f64 = 4.0;
/// Passages count from here on, when the bearing has settled [s].
const FROM_S: f64 = 0.03;

/// The largest forces of the passages over one place, and how they went.
#[derive(Default)]
struct Passages {
    /// Largest force of the ball on the outer raceway in each [N].
    peaks_n: Vec<f64>,
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
    /// Largest forces over the mean of those without a spall.
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
    let sound = Sample::of(&healthy.peaks_n);
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
    }
    for size in &mut sizes {
        let ratios: Vec<f64> = size.passages.peaks_n.iter().map(|n| n / sound.mean).collect();
        size.ratio = Sample::of(&ratios);
    }
    let mut sheet =
        Sheet::new(host.root(), "spall_size", "The force at the exit by depth and width of a spall");
    introduce(&mut sheet, first, &healthy, &sound);
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
    ensure!(!passages.peaks_n.is_empty(), "the bearing without a spall has not been run");
    Ok(passages)
}

impl Passages {
    /// Adds those of a run.
    fn read(&mut self, folder: &Path) -> Result<()> {
        let run = Run::read(folder)?;
        let record = Record::whole(&run)?;
        let scene = &run.scene;
        let middle = scene.written.defect.as_ref().map_or(90.0, |spall| spall.angle_deg).to_radians();
        let reach = 1e-3 * REACH_MM / scene.outer_race_radius;
        for roller in record.rollers() {
            let off: Vec<f64> = roller.orbit().iter().map(|at| around(at - middle)).collect();
            self.peaks_n.extend(largest(&off, &roller.outer_normal(), reach, record.time_s()));
        }
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

/// The largest force of each passage from `reach` before the middle to `reach` behind it, of those that are
/// wholly on record.
fn largest(off: &[f64], force: &[f64], reach: f64, time: &[f64]) -> Vec<f64> {
    let mut peaks = Vec::new();
    let mut from = None;
    for n in 0..off.len() {
        match (off[n].abs() < reach, from) {
            (true, None) => from = Some(n),
            (false, Some(first)) => {
                let crosses = off[first] * off[n] < 0.0;
                if first > 0 && time[first] >= FROM_S && crosses {
                    peaks.push(force[first..n].iter().copied().fold(0.0, f64::max));
                }
                from = None;
            }
            _ => {}
        }
    }
    peaks
}

/// Depth [mm] from which on a ball that does not give rests on both edges of a spall this wide and cannot reach
/// its floor: the sagitta of the ball's circle less that of the raceway's.
fn sagitta_mm(scene: &Scene, length_mm: f64) -> f64 {
    let sagitta = |diameter_mm: f64| 0.5 * (diameter_mm - (diameter_mm.powi(2) - length_mm.powi(2)).sqrt());
    sagitta(scene.bearing.roller_diameter_mm) - sagitta(scene.bearing.outer_race_diameter_mm)
}

fn introduce(sheet: &mut Sheet, scene: &Scene, healthy: &Passages, sound: &Sample) {
    let operation = &scene.operation;
    sheet.say(&format!(
        "Li, Yan and others (J. Vibroengineering 2022, doi 10.21595/jve.2022.22773) have an explicit model in \
         the plane of shaft, bearing and pedestal, with a defect on the outer raceway. By its abstract, an \
         indicator, the contact force with the defect over that without, grows with the depth of the defect \
         and with its width. Their numbers were not at hand, so the *trend* alone is compared, with a bearing \
         of ours and nothing fitted: a 6205 in a pedestal by the reduced model, {} N, {} rpm, rectangular \
         spalls at the loaded place of the outer raceway (`{CAMPAIGN}`), three starts each.",
        operation.load_n, operation.speed_rpm,
    ));
    sheet.say(&format!(
        "The indicator here: the largest force between ball and outer raceway from {REACH_MM} mm before the \
         middle of the spall to {REACH_MM} mm behind it, over the mean of the same in the bearing without a \
         spall ({} N, standard deviation {} N, {} passages). *Free* are the passages in which the ball loses \
         its load, *floor* those in which it touches the floor; *sagitta* is the depth from which on a ball \
         that does not give rests on both edges and cannot reach the floor.",
        number(sound.mean, 0),
        number(sound.scatter, 0),
        healthy.peaks_n.len(),
    ));
    sheet.value("healthy", "all starts", "mean N", Some(sound.mean));
    sheet.value("healthy", "all starts", "standard deviation N", Some(sound.scatter));
}

fn table(sheet: &mut Sheet, sizes: &[Size]) {
    sheet.heading("Every size");
    let rows: Vec<Vec<String>> = sizes
        .iter()
        .map(|size| {
            let Passages { events, free, floor, peaks_n } = &size.passages;
            vec![
                size.length_mm.to_string(),
                size.depth_mm.to_string(),
                number(size.sagitta_mm, 3),
                number(size.ratio.mean, 3),
                number(size.ratio.error(), 3),
                number(size.ratio.scatter, 3),
                peaks_n.len().to_string(),
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
            let axes = (Axis::decades(x, "mm"), Axis::plain("largest force over that without a spall", ""));
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

/// How the indicator goes along a line of sizes: from where on it stays within two standard errors of its
/// last value, and whether it rises and falls by more than that anywhere on the way.
struct Course {
    same_from: usize,
    rises: bool,
    falls: bool,
}

impl Course {
    fn of(sizes: &[&Size]) -> Self {
        let last = sizes.len() - 1;
        let differs = |n: &usize| apart(sizes[*n], sizes[last]).abs() > 2.0;
        let same_from = (0..last).rev().find(differs).map_or(0, |n| n + 1);
        let steps = || sizes.windows(2).map(|pair| apart(pair[0], pair[1]));
        Self { same_from, rises: apart(sizes[0], sizes[last]) > 2.0, falls: steps().any(|step| step < -2.0) }
    }

    fn in_words(&self, sizes: &[&Size], along: fn(&Size) -> f64) -> String {
        let [first, last] = [sizes[0], sizes[sizes.len() - 1]].map(|size| number(size.ratio.mean, 3));
        let way = match (self.rises, self.falls) {
            (true, false) => "grows",
            (true, true) => "grows, not at every step",
            (false, true) => "does not grow, and falls on the way",
            (false, false) => "stays",
        };
        let same = along(sizes[self.same_from]);
        let end = match self.same_from {
            0 => "no size differs from the largest".to_owned(),
            n if n + 1 < sizes.len() => format!("from {same} mm on all are the same"),
            _ => "the largest differs from the one before".to_owned(),
        };
        format!("{way}, {first} to {last}; {end}")
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
            grown += usize::from(course.rises && !course.falls);
            rows.push(vec![what.to_owned(), format!("{of} {value} mm"), course.in_words(&sizes, along)]);
        }
        format!("with {what} it grows at {grown} of {} {of}s", all.len())
    };
    let told = [count("depth", "width", WIDTH, DEPTH), count("width", "depth", DEPTH, WIDTH)].join(", ");
    sheet.table(&["with", "at", "the indicator"], &rows);
    sheet.say(&format!("So {told}."));
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
    fn example_the_largest_force_of_a_passage_that_is_wholly_on_record() {
        let off: Vec<f64> = (0..41).map(|n| 0.1 * (f64::from(n) - 20.5)).collect();
        let time: Vec<f64> = (0..41).map(|n| FROM_S + 1e-3 * f64::from(n)).collect();
        let force: Vec<f64> = (0..41).map(|n| if n == 22 { 9.0 } else { f64::from(n % 3) }).collect();
        assert_eq!(largest(&off, &force, 0.5, &time), [9.0]);
        // One that begins within reach, and one that turns back.
        assert!(largest(&off[18..], &force[18..], 0.5, &time).is_empty());
        let back: Vec<f64> = off.iter().map(|x| x.abs()).collect();
        assert!(largest(&back, &force, 0.5, &time).is_empty());
    }
}
