//! The calls into the crates that do the work.

use std::ops::ControlFlow;
use std::path::Path;

use anyhow::Result;
use stribeck_analysis::report;
use stribeck_bearing::simulation;
use stribeck_scene::run_dir::RunDir;
use stribeck_scene::run_info::RunInfo;
use stribeck_scene::scene::Scene;

use crate::host;

pub(crate) use stribeck_bearing::simulation::Progress;

/// Runs `scene` into `dir`; `watch` may end it after any sample.
pub(crate) fn simulate(
    scene: &Scene,
    dir: &RunDir,
    threads: usize,
    watch: &mut dyn FnMut(&Progress) -> ControlFlow<()>,
) -> Result<RunInfo> {
    Ok(host::with(threads, |host| simulation::simulate(scene, dir, host, watch))?)
}

/// Continues the run in `dir` from its checkpoint; `watch` may end it again.
pub(crate) fn resume(
    dir: &RunDir,
    threads: usize,
    watch: &mut dyn FnMut(&Progress) -> ControlFlow<()>,
) -> Result<RunInfo> {
    Ok(host::with(threads, |host| simulation::resume(dir, host, watch))?)
}

/// Writes report, summary and figures of the run in `dir`.
pub(crate) fn write_report(dir: &Path) -> Result<()> {
    report::write(dir)?;
    Ok(())
}
