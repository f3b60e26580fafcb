//! Writes a reduced bearing, its state at the start and the state after one step into a file, for
//! `one_step_in_wasm` of `stribeck-reduced`.

use std::{env, error::Error, fs};

use stribeck_reduced::{
    bearing::Bearing,
    motion::{BearingInMotion, Saved},
};
use stribeck_scene::Scene;
use stribeck_simulation::reduction::{ReducedMesh, dense, modal_bearing};

/// A small bearing with a seat that slips, a cage and oil.
const SCENE: &str =
    "(bearing: \"NU 203\", model: reduced(modes_khz: 8), defect: None, operation: (load_n: 500),
    mesh: (size_mm: 1, roller_facets: 48), contact: (surface: arc, penalty_scale: 1, friction: 0.05))";

/// Length of the step [s].
const TIME_STEP: f64 = 2.5e-7;

fn main() -> Result<(), Box<dyn Error>> {
    let file = env::args().nth(1).ok_or("which file? `one_step FILE`")?;
    let scene = Scene::parse(SCENE, "one_step")?;
    let modal = modal_bearing(&scene.resolve(), ReducedMesh::new(&scene.resolve())?.reduction)?;
    let bearing = Bearing::new(modal.clone(), TIME_STEP)?;
    let before = Saved::first(&bearing, bearing.at_start(&dense::solve)?);
    let mut motion = BearingInMotion::new(bearing, before.clone());
    motion.interval(1);
    fs::write(file, postcard::to_stdvec(&(modal, TIME_STEP, before, motion.saved()))?)?;
    Ok(())
}
