//! `cargo xtask simulate`: scene file → run folder → report. Or the rest of a run that ended early.

use std::ops::ControlFlow;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use anyhow::{Context, Result};
use stribeck_scene::run_dir::RunDir;
use stribeck_scene::run_info::{RunInfo, Status};
use stribeck_scene::scene::Scene;

use crate::engine::{self, Progress};
use crate::progress::{Meter, clock};
use crate::workspace;

/// What a shell reports for a program ended by Ctrl-C.
const EXIT_INTERRUPTED: u8 = 130;

/// Flags of `simulate`.
#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    /// Scene file [default: fixtures/scenes/singh2014.ron]
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

pub(crate) fn run(options: &Options) -> Result<ExitCode> {
    let threads = options.threads.map_or_else(available_threads, usize::from);
    let (scene, dir) = match &options.resume {
        Some(run) => {
            let dir = RunDir::reopen(workspace::locate_run(run))?;
            (Scene::read(dir.scene())?, dir)
        }
        None => {
            let file = options.scene.as_deref().map_or_else(workspace::default_scene, workspace::locate);
            let scene = Scene::read_with(&file, &options.set)?;
            let folder = options.out.clone().unwrap_or_else(|| workspace::runs().join(&scene.name));
            (scene, RunDir::create(&folder)?)
        }
    };
    eprintln!(
        "{}: {} ms, {} threads → {}",
        scene.name,
        scene.solver.duration_ms,
        threads,
        workspace::shown(dir.path())
    );

    let interrupted = listen_for_interrupt()?;
    let mut meter = Meter::new(scene.solver.duration_ms);
    let mut watch = |progress: &Progress| {
        meter.show(progress);
        if interrupted.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let finished = match options.resume {
        Some(_) => engine::resume(&dir, threads, &mut watch),
        None => engine::simulate(&scene, &dir, threads, &mut watch),
    };
    meter.finish();

    if let Ok(info) = &finished {
        announce(info);
        if info.status == Status::Interrupted {
            eprintln!("continue it: cargo xtask simulate --resume {}", workspace::shown(dir.path()));
        }
    }
    // A run that broke off has a report too: what was computed until then is what shows why.
    if dir.has_started() && !options.no_report {
        match engine::write_report(dir.path()) {
            Ok(()) => println!("report: {}", workspace::shown(&dir.report())),
            // The run's own error matters more than that of its report.
            Err(error) if finished.is_err() => eprintln!("warning: no report: {error}"),
            Err(error) => return Err(error.context("the run is complete, its report is not")),
        }
    }
    let info = finished?;
    Ok(match info.status {
        Status::Complete => ExitCode::SUCCESS,
        Status::Interrupted => ExitCode::from(EXIT_INTERRUPTED),
        Status::Diverged | Status::Running => ExitCode::FAILURE,
    })
}

pub(crate) fn available_threads() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// The first Ctrl-C asks the run to end after its step, the second ends the program.
pub(crate) fn listen_for_interrupt() -> Result<Arc<AtomicBool>> {
    let flag = Arc::new(AtomicBool::new(false));
    let seen = Arc::clone(&flag);
    ctrlc::set_handler(move || {
        if seen.swap(true, Ordering::Relaxed) {
            std::process::exit(i32::from(EXIT_INTERRUPTED));
        }
        eprintln!("\ninterrupted: finishing the step; press Ctrl-C again to stop at once");
    })
    .context("cannot listen for Ctrl-C")?;
    Ok(flag)
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
