//! A bearing with oil: it runs, is continued to the same bits, and a dry one has nothing of it.

use std::ops::ControlFlow;

use crate::common::{assert_goes_on_with_the_same_bytes, coarse, host};
use stribeck_scene::scene::{FilmScene, Scene};
use stribeck_simulation::simulate;
use stribeck_store::{
    run_dir::{Run, RunDir},
    run_info::{RunInfo, Status},
};
use stribeck_testing::Scratch;

/// The coarse bearing with oil, and nothing else across the track.
fn oiled(duration_ms: f64) -> Scene {
    let mut scene = coarse(duration_ms);
    scene.film = Some(FilmScene::default());
    scene.solver.mass_damping_per_s = 0.0;
    scene
}

fn run(scene: &Scene, folder: &Scratch, threads: usize) -> (RunInfo, Run) {
    let dir = RunDir::create(folder.path()).expect("the folder is new");
    let info =
        simulate(scene, &dir, &host(threads), &mut |_| ControlFlow::Continue(())).expect("a valid scene");
    (info, Run::read(folder.path()).expect("what was just written"))
}

#[test]
fn behaves_rollers_float_and_loaded_contacts_are_dry() {
    /// Of the peak strain energy.
    const LEDGER: f64 = 1e-4;
    let folder = Scratch::new("film");
    let (info, run) = run(&oiled(0.5), &folder, 1);
    assert_eq!(info.status, Status::Complete, "{info:?}");
    assert!(info.energy.max_relative_error < LEDGER, "{:?}", info.energy);
    let channel =
        |name: String| run.trace.channel(&name).expect("readable").expect("a channel of a scene with oil");
    let of = |roller: usize, what: &str| channel(format!("roller.{roller}.{what}"));
    // Roller 14 stands at the bottom, in the middle of its clearance: 40 µm less the deflection under the
    // load.
    for ring in ["outer", "inner"] {
        assert!(of(14, &format!("{ring}_film_m")).iter().all(|h| (5e-6..80e-6).contains(h)), "{ring}");
        let force = of(14, &format!("{ring}_fy_n"));
        assert!(force.iter().all(|f| f.abs() > 0.3 && f.abs() < 30.0), "{ring}: {force:?}");
    }
    assert!(of(14, "outer_fy_n").iter().all(|f| *f > 0.0));
    assert!(of(14, "inner_fy_n").iter().all(|f| *f < 0.0));
    // Roller 24 carries a fifth of the load.
    let least = of(24, "outer_film_m")[0];
    assert!((0.2e-6..1e-6).contains(&least), "{least}");
    assert!(of(24, "outer_film_m").iter().all(|h| *h == least));
    let heat = run.energy.channel("film_j").expect("readable").expect("a column of a scene with oil");
    assert!(heat.iter().all(|heat| heat.is_finite()) && heat.last() != Some(&0.0));
    // NumPy reads longer headers only with `max_header_size`.
    let file = std::fs::read(folder.path().join("trace.npy")).expect("what was just written");
    assert!(u16::from_le_bytes([file[8], file[9]]) < 10_000);
}

#[test]
fn invariant_oil_goes_on_with_the_same_bits() {
    assert_goes_on_with_the_same_bytes(&oiled(0.3), &Scratch::create("film"), 15);
}

#[test]
fn invariant_a_dry_bearing_has_nothing_of_oil() {
    let folder = Scratch::new("film");
    let (_, run) = run(&Scene { film: None, ..coarse(0.05) }, &folder, 1);
    let names = run.trace.names().iter().chain(run.energy.names());
    assert!(names.clone().count() > 20 && names.clone().all(|name| !name.contains("film")));
}
