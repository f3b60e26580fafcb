//! Runs that several test files make.
#![allow(dead_code, reason = "each test file uses its own part of it")]

use std::ops::ControlFlow;

use stribeck_bearing::simulation::Host;
use stribeck_reduced::simulation::simulate;
use stribeck_scene::{run_dir::RunDir, run_info::RunInfo, scene::Scene, trace::Trace};
use stribeck_testing::Scratch;

/// A program around the run whose clocks stand still.
pub(crate) fn host(threads: usize) -> Host<'static> {
    Host {
        threads,
        version: "test".into(),
        commit: "test".into(),
        machine: "test".into(),
        wall_s: &|| 0.0,
        cpu_s: &|| 0.0,
        ranks: None,
    }
}

/// A whole run in a folder of its own.
pub(crate) fn run(scene: &Scene, folder: &Scratch, name: &str, threads: usize) -> RunInfo {
    let dir = RunDir::create(folder.join(name)).expect("the folder is new");
    simulate(scene, &dir, &host(threads), &mut |_| ControlFlow::Continue(())).expect("the scene is sound")
}

/// What it recorded.
pub(crate) fn trace(folder: &Scratch, name: &str) -> Trace {
    Trace::read(folder.join(name).join("trace.npy")).expect("a trace")
}
