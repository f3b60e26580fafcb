//! `stribeck simulate`: scene file → run folder → report. Or the rest of a run that ended early.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::Result;
use stribeck_analysis::report;
use stribeck_bearing::simulation::{self, Progress};
use stribeck_scene::run_dir::RunDir;
use stribeck_scene::run_info::{RunInfo, Status, clock};
use stribeck_scene::scene::Scene;

use crate::host;
use crate::interrupt::{self, Interrupt};
use crate::place::{Place, shown};
use crate::progress::Meter;

/// Flags of `simulate`.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// Scene file [default: the bearing of the paper, as in fixtures/scenes/singh2014.ron]
    scene: Option<PathBuf>,
    /// Folder of the run [default: runs/NAME, the name of the scene]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Worker threads [default: all cores]; the results do not depend on it
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Overrides a field of the scene, for example --set mesh.size_mm=1.0; may be repeated
    #[arg(long, value_name = "FIELD=VALUE")]
    set: Vec<String>,
    /// Continues the run in this folder, or in the one of this name below runs/, from its checkpoint
    #[arg(long, value_name = "DIR", conflicts_with_all = ["scene", "out", "set"])]
    resume: Option<PathBuf>,
    /// Writes no report at the end
    #[arg(long)]
    no_report: bool,
}

pub(crate) fn run(options: &Options, place: &Place) -> Result<ExitCode> {
    let threads = options.threads.map_or_else(host::cores, usize::from);
    let (scene, dir) = match &options.resume {
        Some(run) => {
            let dir = RunDir::reopen(place.locate_run(run))?;
            (Scene::read(dir.scene())?, dir)
        }
        None => {
            let scene = place.scene(options.scene.as_deref(), &options.set)?;
            let folder = options.out.clone().unwrap_or_else(|| place.runs().join(&scene.name));
            (scene, RunDir::create(&folder)?)
        }
    };
    eprintln!("{}: {} ms, {} threads → {}", scene.name, scene.solver.duration_ms, threads, shown(dir.path()));

    let interrupt = Interrupt::listen()?;
    let mut meter = Meter::new(scene.solver.duration_ms);
    let mut watch = |progress: &Progress| {
        meter.show(progress);
        interrupt.flow()
    };
    let finished = host::with(threads, |host| match options.resume {
        Some(_) => simulation::resume(&dir, host, &mut watch),
        None => simulation::simulate(&scene, &dir, host, &mut watch),
    });
    meter.finish();

    if let Ok(info) = &finished {
        announce(info);
        if info.status == Status::Interrupted {
            eprintln!("continue it: {} simulate --resume {}", place.program, shown(dir.path()));
        }
    }
    // A run that broke off has a report too: what was computed until then is what shows why.
    if dir.has_started() && !options.no_report {
        match report::write(dir.path()) {
            Ok(_) => println!("report: {}", shown(&dir.report())),
            // The run's own error matters more than that of its report.
            Err(error) if finished.is_err() => eprintln!("warning: no report: {error}"),
            Err(error) => {
                return Err(anyhow::Error::from(error).context("the run is complete, its report is not"));
            }
        }
    }
    let info = finished?;
    Ok(match info.status {
        Status::Complete => ExitCode::SUCCESS,
        Status::Interrupted => ExitCode::from(interrupt::EXIT_CODE),
        Status::Diverged | Status::Running => ExitCode::FAILURE,
    })
}

/// Says how the run ended and what it cost.
fn announce(info: &RunInfo) {
    for warning in &info.warnings {
        eprintln!("warning: {warning}");
    }
    let how = match info.status {
        Status::Complete => "complete",
        Status::Interrupted => "interrupted",
        Status::Diverged => "diverged",
        Status::Running => "still running",
    };
    let elements = (info.mesh.quads + info.mesh.triangles) as f64;
    let element_steps = info.steps as f64 * elements;
    let pace = if element_steps > 0.0 { info.wall_s / element_steps * 1e9 } else { 0.0 };
    println!(
        "{how}: {} steps of {:.2} ns, {} elements, {} (set-up {}), {pace:.2} ns per element-step, energy error {:.3} %",
        info.steps,
        info.time_step_s * 1e9,
        elements,
        clock(info.wall_s),
        clock(info.setup_s),
        info.energy.max_relative_error * 100.0
    );
    if let Some(reason) = &info.stop_reason {
        eprintln!("stopped: {reason}");
    }
}
