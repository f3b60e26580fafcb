//! Runs: simulate, continue, read.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use anyhow::{Context, anyhow};
use clap::Parser;
use numpy::{IntoPyArray, PyArray1};
use pyo3::prelude::*;
use stribeck::host;
use stribeck::{Command, Place};
use stribeck_analysis::findings::Findings;
use stribeck_analysis::record::Record;
use stribeck_report as page;
use stribeck_scene::scene::Scene;
use stribeck_simulation as simulation;
use stribeck_simulation::run::host::Progress;
use stribeck_store::run_dir::{Run, RunDir};
use stribeck_store::run_info::RunInfo;

use crate::raise;

/// Interval at which Python is asked whether Ctrl-C was pressed, and gets the progress of a run.
const PACE: Duration = Duration::from_millis(100);

/// The command line of the program.
#[derive(Debug, Parser)]
#[command(name = "stribeck", version = host::VERSION, about = "Simulates rolling element bearings and says \
    how far to believe it")]
struct Line {
    #[command(subcommand)]
    command: Command,
}

/// Runs a command of the program, as in a shell; returns its exit code.
#[pyfunction]
pub(crate) fn command(py: Python<'_>, arguments: Vec<String>) -> i32 {
    py.detach(|| {
        let words = std::iter::once("stribeck".to_owned()).chain(arguments);
        match Line::try_parse_from(words) {
            Ok(line) => {
                let code = stribeck::conclude(line.command.run(&Place::here()));
                i32::from(code != std::process::ExitCode::SUCCESS)
            }
            Err(why) => {
                let _ = why.print();
                why.exit_code()
            }
        }
    })
}

/// Watches a run for Python: checks for signals, reports progress.
struct Watch {
    progress: Option<Py<PyAny>>,
    last: Instant,
    raised: Option<PyErr>,
}

impl Watch {
    fn new(progress: Option<Py<PyAny>>) -> Self {
        Self { progress, last: Instant::now(), raised: None }
    }

    fn see(&mut self, seen: &Progress) -> ControlFlow<()> {
        if self.raised.is_some() {
            return ControlFlow::Break(());
        }
        if self.last.elapsed() < PACE {
            return ControlFlow::Continue(());
        }
        self.last = Instant::now();
        let share = if seen.steps > 0 { seen.step as f64 / seen.steps as f64 } else { 0.0 };
        let told = Python::attach(|py| {
            py.check_signals()?;
            match &self.progress {
                Some(progress) => progress.call1(py, (seen.phase, share, seen.time_s)).map(|_| ()),
                None => Ok(()),
            }
        });
        match told {
            Ok(()) => ControlFlow::Continue(()),
            Err(why) => {
                self.raised = Some(why);
                ControlFlow::Break(())
            }
        }
    }
}

/// The folder of a run that has come to an end, or what stopped it. A run that Python interrupted keeps what
/// it has.
fn ended(watch: Watch, dir: &RunDir, done: anyhow::Result<RunInfo>) -> PyResult<PathBuf> {
    if let Some(why) = watch.raised {
        return Err(why);
    }
    done.map_err(|why| raise(&why))?;
    Ok(dir.path().to_owned())
}

/// What Python asks for: a file, fields that replace its own, and whether it is fields alone, without a file.
type Asked = (Option<PathBuf>, Vec<String>, bool);

/// A scene from a file, from fields alone, or without either the paper's run.
fn read_scene((file, overrides, of_fields): &Asked) -> anyhow::Result<Scene> {
    let place = Place::here();
    if *of_fields { place.scene_of_fields(overrides) } else { place.scene(file.as_deref(), overrides) }
}

/// Simulates; returns the folder of the run.
#[pyfunction]
#[pyo3(signature = (asked, out, overwrite, threads, progress))]
pub(crate) fn simulate(
    py: Python<'_>,
    asked: Asked,
    out: Option<PathBuf>,
    overwrite: bool,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<PathBuf> {
    let mut watch = Watch::new(progress);
    let (dir, done) = py
        .detach(|| -> anyhow::Result<_> {
            let scene = read_scene(&asked)?;
            let folder = out.clone().unwrap_or_else(|| Place::here().runs().join(&scene.name));
            let dir = match (overwrite, &out) {
                (true, _) => RunDir::replace(&folder)?,
                (false, Some(_)) => RunDir::create(&folder)?,
                (false, None) => RunDir::create_numbered(&folder)?,
            };
            let threads = threads.unwrap_or_else(host::cores);
            let done =
                host::with(threads, |host| simulation::simulate(&scene, &dir, host, &mut |p| watch.see(p)));
            let dir = if done.is_ok() && watch.raised.is_none() { dir.take_place()? } else { dir };
            Ok((dir, done.map_err(anyhow::Error::from)))
        })
        .map_err(|why| raise(&why))?;
    ended(watch, &dir, done)
}

/// Continues a run to its end, or to another duration [ms].
#[pyfunction]
#[pyo3(signature = (run, duration_ms, threads, progress))]
pub(crate) fn resume(
    py: Python<'_>,
    run: PathBuf,
    duration_ms: Option<f64>,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<PathBuf> {
    let mut watch = Watch::new(progress);
    let (dir, done) = py
        .detach(|| -> anyhow::Result<_> {
            let dir = RunDir::reopen(&run)?;
            let threads = threads.unwrap_or_else(host::cores);
            let mut see = |p: &Progress| watch.see(p);
            let done = host::with(threads, |host| match duration_ms {
                Some(ms) => simulation::extend(&dir, ms, host, &mut see),
                None => simulation::resume(&dir, host, &mut see),
            });
            Ok((dir, done.map_err(anyhow::Error::from)))
        })
        .map_err(|why| raise(&why))?;
    ended(watch, &dir, done)
}

/// A scene with every default, as RON, and its hash.
#[pyfunction]
pub(crate) fn scene(asked: Asked) -> PyResult<(String, String)> {
    let read = || -> anyhow::Result<(String, String)> {
        let scene = read_scene(&asked)?;
        Ok((scene.to_ron(), scene.hash()))
    };
    read().map_err(|why| raise(&why))
}

fn read(run: &Path) -> PyResult<Run> {
    Run::read(run).map_err(|why| raise(&anyhow!(why)))
}

/// The channels of a run in their order: names, and arrays that own the numbers that were read.
#[pyfunction]
pub(crate) fn channels(py: Python<'_>, run: PathBuf) -> PyResult<Vec<(String, Bound<'_, PyArray1<f64>>)>> {
    let trace = py.detach(|| read(&run)?.trace.read_all().map_err(|why| raise(&anyhow!(why))))?;
    Ok(trace.names.into_iter().zip(trace.columns.into_iter().map(|c| c.into_pyarray(py))).collect())
}

/// Findings of a run, as JSON in the form of `summary.json`.
#[pyfunction]
pub(crate) fn summary(py: Python<'_>, run: PathBuf) -> PyResult<String> {
    py.detach(|| {
        let of = || -> anyhow::Result<String> {
            let findings = Findings::of(&Record::new(&Run::read(&run)?)?)?;
            serde_json::to_string(&findings.summary).context("the summary cannot be written as JSON")
        };
        of().map_err(|why| raise(&why))
    })
}

/// Writes the report of a run; returns its path.
#[pyfunction]
pub(crate) fn report(py: Python<'_>, run: PathBuf) -> PyResult<PathBuf> {
    py.detach(|| {
        page::write(&run).map_err(|why| raise(&anyhow!(why)))?;
        let dir = RunDir::open(&run).map_err(|why| raise(&anyhow!(why)))?;
        Ok(dir.report())
    })
}
