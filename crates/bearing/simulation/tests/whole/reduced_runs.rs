//! Whole runs of the reduced bearing: their files, that they continue to the same bytes, and their distance
//! from the full model.

mod energy;
mod files;
mod motion;

use std::{f64::consts::TAU, fs};

use crate::common::{assert_goes_on_with_the_same_bytes, channel, fine_where_it_rolls, run, trace};
use stribeck_reduced::{
    bearing::Bearing,
    motion::{BearingInMotion, Saved},
};
use stribeck_scene::scene::{
    HarmonicScene, ModelScene, PocketWalls, ProfileScene, RampScene, ReducedScene, RotatingLoadScene, Scene,
};
use stribeck_simulation::bearing::assembly::Assembly;
use stribeck_simulation::reduced::{Prepared, prepared};
use stribeck_simulation::reduction::{ReducedMesh, dense, modal_bearing};
use stribeck_store::{mesh_file::RunMesh, run_info::Status, trace::Trace};
use stribeck_testing::Scratch;
use stribeck_theory::kinematics::Kinematics;

/// The paper's bearing, coarse.
fn coarse(duration_ms: f64) -> Scene {
    let mut scene = Scene { name: "coarse".into(), ..Scene::default() };
    scene.model = ModelScene::Reduced(ReducedScene { modes_khz: 15.0, ..ReducedScene::default() });
    scene.mesh.size_mm = 2.0;
    scene.mesh.roller_facets = 88;
    scene.bearing.thickness_mm = 20.0;
    scene.contact.penalty_scale = 1.0;
    scene.contact.points_per_facet = 4;
    // Dry, and quiet by mass damping.
    scene.film = None;
    (scene.solver.mass_damping_per_s, scene.solver.structural_damping) = (5000.0, None);
    scene.solver.duration_ms = duration_ms;
    scene.output.frames = None;
    scene
}

/// The coarse bearing without a defect, its cage guided by the rollers: pockets with corners keep it from
/// floating away before all rollers run.
fn guided(duration_ms: f64) -> Scene {
    let mut scene = coarse(duration_ms);
    scene.defect = None;
    scene.cage.iter_mut().for_each(|cage| cage.pocket = PocketWalls::Corners);
    scene
}

/// One of the scenes that come with the program, with some fields of its own.
fn of(file: &str, fields: &[&str]) -> Scene {
    let scenes = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../fixtures/scenes/");
    Scene::read_with(format!("{scenes}{file}"), fields).expect("valid")
}
