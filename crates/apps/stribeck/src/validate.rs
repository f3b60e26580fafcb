//! `stribeck validate`: the same starts of a scene by the full and by the reduced model, compared.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result, bail};
use stribeck_analysis::agreement::{Agreement, FINE_S, FROM_S, LEAST_S, Row};
use stribeck_report as report;
use stribeck_scene::ensemble::{folder_name, start};
use stribeck_scene::scene::{ModelScene, RollerProfile, Scene};
use stribeck_store::run_dir::{Run, check_folder};
use stribeck_store::run_info::Status;

use crate::interrupt::{self, Interrupt};
use crate::out::{say, tell};
use crate::place::{Place, shown};
use crate::side_by_side::{Due, Jobs, Shop, outstanding};
use crate::simulate::{jobs, threads};

/// Flags of `validate`.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// Scene file, with either model
    scene: PathBuf,
    /// Overrides a field of the scene, for example --set operation.load_n=30000; may be repeated
    #[arg(long = "set", value_name = "FIELD=VALUE")]
    set: Vec<String>,
    /// Starts, each by both models
    #[arg(long, value_name = "N", default_value_t = 4, value_parser = clap::value_parser!(u16).range(1..=1000))]
    starts: u16,
    /// Seed of the starts
    #[arg(long, value_name = "SEED", default_value_t = 1)]
    seed: u64,
    /// Runs that go side by side [default: as many as cores]
    #[arg(long, value_name = "N", value_parser = jobs)]
    jobs: Option<usize>,
    /// Worker threads of all runs together [default: all cores]; the results do not depend on it
    #[arg(long, value_name = "N", value_parser = threads)]
    threads: Option<usize>,
    /// Folder of the runs and of the page [default: runs/NAME-validation]; the same command continues
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Folder of the runs of the full model, for example that of another validation: other modes or another
    /// step need no other ones. Those that are missing are made there, those that are too short are made
    /// longer [default: `full` in the folder of the page]
    #[arg(long, value_name = "DIR")]
    full: Option<PathBuf>,
}

/// Files that mark the folder of a validation, also of an interrupted one.
const MARKS: [&str; 3] = ["validation.json", "full/start-001", "reduced/start-001"];
/// By this the folder of its runs of one model.
const MARK: &str = "start-001";

pub(crate) fn run(options: &Options, place: &Place) -> Result<ExitCode> {
    let scene = place.scene(Some(&options.scene), &options.set)?;
    if 1e-3 * scene.solver.duration_ms < LEAST_S {
        bail!(
            "`solver.duration_ms` is {}; at least {} to compare models, which is done from {} ms on. Take a \
             longer run: --set solver.duration_ms=30",
            scene.solver.duration_ms,
            1e3 * LEAST_S,
            1e3 * FROM_S
        );
    }
    let models = models(&scene)?;
    let out = options.out.clone().unwrap_or_else(|| place.runs().join(format!("{}-validation", scene.name)));
    check_folder(&out, &MARKS)?;
    let folders = [options.full.clone().unwrap_or_else(|| out.join("full")), out.join("reduced")];
    if let Some(full) = &options.full {
        check_folder(full, &[MARK])?;
        if *full == folders[1] {
            bail!(
                "`--full` is where runs of the reduced model go: `{}`. Give a folder of its own",
                shown(full)
            );
        }
    }
    std::fs::create_dir_all(&out).with_context(|| format!("cannot make `{}`", shown(&out)))?;
    let planned = || plan(&folders, &models, options);
    let due = outstanding(planned())?;
    let jobs = Jobs::of(options.jobs, options.threads, due.len());
    tell!(
        "{}: {} starts of {} ms by both models, {} runs to make, {} → {}",
        scene.name,
        options.starts,
        scene.solver.duration_ms,
        due.len(),
        jobs.shown(),
        shown(&out)
    );
    let interrupt = Interrupt::listen()?;
    let why = Shop::new("run", &due, jobs, &interrupt).run(&|_, _, _| {});
    let left = outstanding(planned())?.len();
    if left > 0 {
        why.say((left, 2 * usize::from(options.starts)), "run", "The same command goes on with them");
        return Ok(ExitCode::from(if interrupt.is_pressed() { interrupt::EXIT_CODE } else { 1 }));
    }
    let mut pairs = Vec::new();
    for number in 1..=usize::from(options.starts) {
        let read = |folder: &Path| -> Result<Run> {
            let folder = folder.join(folder_name(number));
            let run = Run::read(&folder)?;
            if run.info.status != Status::Complete {
                let why = run.info.stop_reason.as_deref().unwrap_or("it was stopped");
                bail!("`{}` did not come to its end, and cannot be compared: {why}", shown(&folder));
            }
            Ok(run)
        };
        pairs.push([read(&folders[0])?, read(&folders[1])?]);
    }
    let agreement = Agreement::of(&models[1], &pairs)?;
    report::write_agreement(&out, &agreement)?;
    print(&agreement);
    say!("page: {}", shown(&out.join("report.html")));
    Ok(ExitCode::SUCCESS)
}

/// Samples of a run of the full model, at most: 140 MB, a quarter of a second.
const SAMPLES: f64 = 131_072.0;

/// The scene by the full and by the reduced model, with straight rollers, which both have. The full one is sampled
/// more often, unless it is long, and makes no pictures.
fn models(scene: &Scene) -> Result<[Scene; 2]> {
    let by = |model: ModelScene| -> Result<Scene> {
        let mut scene = Scene { model, ..scene.clone() };
        scene.bearing.roller_profile = RollerProfile::Straight;
        scene.validate()?;
        Ok(scene)
    };
    let reduced = match &scene.model {
        ModelScene::Reduced(reduced) => ModelScene::Reduced(reduced.clone()),
        ModelScene::Full => ModelScene::Reduced(Default::default()),
    };
    let mut full = by(ModelScene::Full)?;
    let interval_us = full.output.interval_us;
    let samples = 1e3 * full.solver.duration_ms / interval_us;
    let parts = (1e-6 * interval_us / FINE_S - 1e-9).ceil().min((SAMPLES / samples).floor()).max(1.0);
    full.output.interval_us = interval_us / parts;
    full.output.frames = None;
    Ok([full, by(reduced)?])
}

/// All runs, a pair after the other, each with the flag that gives another folder.
fn plan<'a>(
    folders: &'a [PathBuf; 2],
    models: &'a [Scene; 2],
    options: &'a Options,
) -> impl Iterator<Item = (Due, &'static str)> + 'a {
    let flags = [if options.full.is_some() { "--full" } else { "--out" }, "--out"];
    let pair = move |number: usize| {
        [0, 1].map(|model| {
            let folder = folders[model].join(folder_name(number));
            let scene = start(&models[model], options.seed, number);
            (Due::new(2 * number - 1 + model, scene, folder), flags[model])
        })
    };
    (1..=usize::from(options.starts)).flat_map(pair)
}

fn print(agreement: &Agreement) {
    let [full, reduced, times] = agreement.cost();
    say!(
        "{}: {} starts of {:.0} ms; reduced less full, mean and 95 % interval (dB: mean, least and most of \
         the bands)",
        agreement.scene,
        agreement.starts,
        agreement.simulated_ms
    );
    for row in &agreement.rows {
        let verdict = match row.verdict(agreement.starts) {
            _ if row.decided && row.within => "kept".to_owned(),
            _ if row.decided => "NOT KEPT".to_owned(),
            open => open,
        };
        say!("  {:<58} {}; {verdict}", row.quantity, words(row));
    }
    for c in &agreement.correlations {
        let interval = c.value.low.zip(c.value.high);
        let interval = interval.map_or(String::new(), |(low, high)| format!(" ({low:.3} to {high:.3})"));
        let what = format!("correlation at {}, y, below {:.1} kHz", c.sensor, 1e-3 * c.below_hz);
        say!("  {what:<58} {:.3}{interval}", c.value.mean);
    }
    for p in &agreement.peaks {
        let what = format!("largest acceleration at {} below {:.0} kHz [g]", p.sensor, 1e-3 * p.below_hz);
        let [full, reduced] = p.levels();
        say!("  {what:<58} full {full}, reduced {reduced}; {}", p.difference());
    }
    for note in &agreement.notes {
        say!("  note: {note}");
    }
    say!("  processor time of a simulated millisecond: full {full}, reduced {reduced}, {times}");
}

/// The difference and its limit.
fn words(row: &Row) -> String {
    let range = row.range().map_or(String::new(), |[low, high]| format!(" ({low:+.3} to {high:+.3})"));
    format!("{:+.3}{range} {}, limit {}", row.difference.mean, row.scale.unit(), row.limit)
}
