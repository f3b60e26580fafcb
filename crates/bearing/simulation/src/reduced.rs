//! The reduced bearing: its reduction, its steps, its start.

pub mod motion;
mod on_shaft;

mod guards;

use std::{f64::consts::TAU, ops::ControlFlow, path::Path};

use crate::bearing::{assembly::Assembly, own_mesh};
use crate::reduction::{ReducedMesh, cache, dense, modal_bearing};
use crate::run::{host::Progress, setup::Setup};
use stribeck_reduced::modal::ModalBearing;
use stribeck_reduced::{bearing::Bearing, state::State};
use stribeck_scene::{
    housing::HousingScene,
    resolved::ResolvedScene,
    scene::{ContactSurface, ModelScene, ReducedScene},
};
use stribeck_store::run_info::{ReducedInfo, RunInfo, Topic, Warning};
use stribeck_theory::kinematics::Kinematics;

use crate::{
    error::Error,
    mesh_file::mesh_file,
    model::{Misfit, Model, Preparation},
};
use guards::Guards;
use motion::{ReducedMotion, Saved};
pub use on_shaft::on_shaft;

/// A reduced bearing before its first step.
pub(crate) struct Reduced {
    assembly: Assembly,
    bearing: Bearing,
    /// Displacements of the nodes of rings and housing at the preload [m].
    moved: Vec<[f64; 2]>,
    /// Equilibrium to start from; none where a checkpoint has the state.
    start: Option<State>,
}

impl Model for Reduced {
    type Saved = Saved;
    type Motion = ReducedMotion;

    /// A step is too short to share: further threads would wait, and keep their cores busy with it.
    const SHARED: bool = false;

    fn prepare(
        with: &mut Preparation<'_>,
        watch: &mut dyn FnMut(&Progress) -> ControlFlow<()>,
    ) -> Result<(Self, Setup), Error> {
        let started = (with.host.wall_s)();
        let (ReducedMesh { reduction, parts, moved, between_rollers, warning, .. }, from_cache) =
            cache::reduced_mesh(&with.scene.written, with.runs())?;
        with.enter("preload", watch);
        let scene = with.scene;
        let (modes, highest) = (reduction.modes, reduction.squares.iter().copied().fold(0.0, f64::max));
        let assembly = Assembly::of(scene, &parts)?;
        let carried_mass = reduction.structure_mass;
        let wanted = wanted(scene);
        let (bearing, steps_per_sample, step_of) =
            in_steps(scene, &wanted, modal_bearing(scene, reduction)?)?;
        let state = bearing.at_start(&dense::solve)?;
        let (time_step, critical_time_step) = (bearing.time_step, bearing.critical_time_step());
        let mut warnings = Vec::from_iter(warning.map(|words| Topic::Start.warning(words)));
        warnings.extend(too_few_modes(scene, &wanted, between_rollers));
        warnings.extend(shorter_steps(scene, &wanted, time_step, &step_of));
        let setup = Setup {
            time_step,
            critical_time_step,
            steps_per_sample,
            mesh: assembly.mesh_info(),
            reduced: Some(ReducedInfo { modes, highest_hz: highest.sqrt() / TAU, from_cache, step_of }),
            wall_s: (with.host.wall_s)() - started,
            carried_mass,
            notes: own_mesh::notes(&scene.written),
            warnings,
        };
        Ok((Self { assembly, bearing, moved, start: Some(state) }, setup))
    }

    fn prepare_again(with: &mut Preparation<'_>, info: &RunInfo) -> Result<Self, Error> {
        let (mesh, _) = cache::reduced_mesh(&with.scene.written, with.runs())?;
        let assembly = Assembly::of(with.scene, &mesh.parts)?;
        let bearing = Bearing::new(modal_bearing(with.scene, mesh.reduction)?, info.time_step_s)?;
        Ok(Self { assembly, bearing, moved: mesh.moved, start: None })
    }

    fn warnings(&self, scene: &ResolvedScene, info: &RunInfo) -> Vec<Warning> {
        let mut warnings = Guards::before(scene, &self.bearing);
        warnings.extend(fast_facets(scene, &self.assembly, info.time_step_s));
        warnings
    }

    /// Rings and housing deformed by the preload of the reduction; rollers and cage, which are rigid, at
    /// their positions.
    fn mesh_file(&self, scene: &ResolvedScene) -> Result<Vec<u8>, Error> {
        let mesh = &self.assembly.model.mesh;
        let mut moved = self.moved.clone();
        moved.resize(mesh.x.len(), [0.0; 2]);
        let rollers = mesh.bodies.iter().filter(|body| body.name.starts_with("roller "));
        let centres = self.start.iter().flat_map(|state| state.x.iter().zip(&state.y));
        for ((body, pocket), (x, y)) in rollers.zip(scene.written.rollers_in_place()).zip(centres) {
            let path = scene.outer_race_radius - scene.roller_radius;
            let (s, c) = libm::sincos(scene.roller_angle(pocket - 1));
            moved[body.nodes.clone()].fill([x - path * c, y - path * s]);
        }
        mesh_file(&self.assembly, &|node| {
            let n = node as usize;
            [mesh.x[n] + moved[n][0], mesh.y[n] + moved[n][1]]
        })
    }

    fn start(self, with: &Preparation<'_>) -> ReducedMotion {
        let state = self.start.unwrap_or_else(|| self.bearing.rest());
        ReducedMotion::start(with.scene, self.bearing, state)
    }

    fn go_on(self, with: &Preparation<'_>, info: &RunInfo, saved: Saved) -> Result<ReducedMotion, Misfit> {
        if info.mesh != self.assembly.mesh_info() || !saved.bearing.fits(&self.bearing) {
            return Err(Misfit::other_model());
        }
        Ok(ReducedMotion::go_on(with.scene, self.bearing, saved))
    }
}

/// The scene's settings of the reduced model.
fn wanted(scene: &ResolvedScene) -> ReducedScene {
    match &scene.written.model {
        ModelScene::Reduced(reduced) => reduced.clone(),
        ModelScene::Full => ReducedScene::default(),
    }
}

/// Share of the approach of the most loaded roller that may bend between rollers in none of the modes; beyond
/// it forces of rollers are off by per cents (docs/guide/src/reduced.md).
const LEFT_OUT: f64 = 0.15;

/// A warning where the raceway bends between rollers in more than the modes, by some length [m] at the
/// preload.
fn too_few_modes(scene: &ResolvedScene, wanted: &ReducedScene, between_rollers: f64) -> Option<Warning> {
    let approach = scene.static_load().ok()?.max_approach_m();
    let share = between_rollers / approach;
    (share > LEFT_OUT).then(|| {
        Topic::Modes.warning(format!(
            "the modes below {} kHz leave out {:.2} µm by which the outer ring bends between the rollers, \
             {:.0} % of the approach under the most loaded one: forces of rollers may be off by some per \
             cent. Take `model.modes_khz` of {:.0}, or as much more as it takes",
            wanted.modes_khz,
            1e6 * between_rollers,
            1e2 * share,
            (2.0 * wanted.modes_khz).min(300.0)
        ))
    })
}

/// A warning where steps are shorter than those that a scene asks for, with the cause; the default is no wish.
fn shorter_steps(scene: &ResolvedScene, wanted: &ReducedScene, time_step: f64, why: &str) -> Option<Warning> {
    let is_asked = wanted.step_us != ReducedScene::default().step_us;
    // A whole number of them fits into a sample in any case.
    let is_shorter = steps_per_sample(scene, time_step) > steps_per_sample(scene, 1e-6 * wanted.step_us);
    (is_asked && is_shorter).then(|| {
        Topic::TimeStep.warning(format!(
            "`model.step_us` is {}, and steps are {:.3} µs: a whole number of them in a sample, none longer than {why}",
            wanted.step_us,
            1e6 * time_step
        ))
    })
}

/// A warning where facets pass their contacts in so few steps that the force between two of them is not
/// resolved: the energy is then off by an error that grows with the square of the time step [s].
fn fast_facets(scene: &ResolvedScene, assembly: &Assembly, time_step: f64) -> Option<Warning> {
    if scene.written.contact.surface != ContactSurface::Facet {
        return None;
    }
    let (duty, duration) = (&scene.duty, scene.duration);
    let [inner, outer] = [duty.speed_range_rpm(0.0, duration), duty.outer_speed_range_rpm(0.0, duration)];
    let fastest = inner.into_iter().flat_map(|inner| outer.map(|outer| [inner, outer]));
    let hz = fastest.flat_map(|[inner, outer]| {
        Kinematics::between(&scene.written.bearing, inner, outer)
            .facet_tones(assembly.facets)
            .map(|tone| tone.hz)
    });
    let hz = hz.fold(0.0, f64::max);
    let steps = 1.0 / (hz * time_step);
    (steps < STEPS_A_FACET).then(|| {
        Topic::TimeStep.warning(format!(
            "at this speed a facet passes its contact in {steps:.1} steps of {:.2} µs ({:.1} kHz), and the \
             energy is off by an error that grows with the square of the step: take `model.step_us` below \
             {:.2}, fewer `mesh.roller_facets`, or `contact.surface: arc`",
            1e6 * time_step,
            1e-3 * hz,
            1e6 / (hz * STEPS_A_FACET)
        ))
    })
}

/// With as many steps a facet the energy is off by about 1 % of the peak strain energy in 3 ms, with half as
/// many by 2 to 4 %: the paper's bearing at 5000, 15 000 and 30 000 rpm (`--set operation.speed_rpm=… --set
/// model.step_us=…` on `reduced_30ms.ron`).
const STEPS_A_FACET: f64 = 20.0;

/// Makes the modes of the scene, which has a reduced model, and keeps them where `runs` says that the folder
/// of the run will lie. Whether they had to be made: an earlier run may have left them there.
///
/// # Errors
/// When the scene cannot be meshed, preloaded or reduced.
pub fn make_modes(scene: &ResolvedScene, runs: Option<&Path>) -> Result<bool, Error> {
    let (_, from_cache) = cache::reduced_mesh(&scene.written, runs)?;
    Ok(!from_cache)
}

/// The bearing of a scene before its first step, as a run of the scene takes it.
#[derive(Debug)]
pub struct Prepared {
    /// Its numbers.
    pub modal: ModalBearing,
    /// Steps in a sample.
    pub steps_per_sample: usize,
    /// The bearing, and its equilibrium to start from.
    pub bearing: Bearing,
    /// See `bearing`.
    pub start: State,
}

/// Prepares the bearing of a scene, which has a reduced model, for a program with its own time loop. `runs`
/// as for [`steps_in_a_sample`].
///
/// # Errors
/// When the scene cannot be meshed, preloaded or reduced, or has no equilibrium to start from.
pub fn prepared(scene: &ResolvedScene, runs: Option<&Path>) -> Result<Prepared, Error> {
    let (mesh, _) = cache::reduced_mesh(&scene.written, runs)?;
    let modal = modal_bearing(scene, mesh.reduction)?;
    let (bearing, steps_per_sample, _) = in_steps(scene, &wanted(scene), modal.clone())?;
    let start = bearing.at_start(&dense::solve)?;
    Ok(Prepared { modal, steps_per_sample, bearing, start })
}

/// Longest step over the critical one where rolling elements strike edges of spalls: contacts that
/// are taken ahead (THEORY §9.4) strike as hard in such steps as in short ones, and close the ledger better than steps
/// of 0.35 did without.
const OVER_EDGES: f64 = 0.8;

/// The same where oil takes the energy of the blows: films are not taken ahead, and at 0.8 a 6205 is off by 15 % of the
/// heat.
const OVER_EDGES_OILED: f64 = 0.35;

/// The same where neither oil nor mass damping takes the energy of the blows, and contacts that open from blow to blow
/// are all that a run consists of: at 0.35 an NU 205 in a rigid housing under 500 N is off by 1.4 % of its little heat,
/// and its guard stops it; so by 0.3 to 0.5 % under 200 to 2000 N.
const OVER_EDGES_UNDAMPED: f64 = 0.2;

/// The bearing with steps of the scene's length, or shorter where the critical time step or edges demand it; the number
/// of steps in a sample; and what has set their length, in words.
fn in_steps(
    scene: &ResolvedScene,
    wanted: &ReducedScene,
    modal: ModalBearing,
) -> Result<(Bearing, usize, String), Error> {
    let interval = scene.interval;
    let steps = steps_per_sample(scene, 1e-6 * wanted.step_us);
    let bearing = Bearing::new(modal.clone(), interval / steps as f64)?;
    let (oiled, damped) = (scene.film.is_some(), scene.written.solver.mass_damping_per_s > 0.0);
    let (share, why) = match (scene.written.has_edges(), oiled, damped) {
        (false, ..) => (1.0, ""),
        (true, true, _) => (OVER_EDGES_OILED, " where rolling elements strike edges through oil"),
        (true, false, true) => (OVER_EDGES, " where rolling elements strike edges"),
        (true, false, false) => (OVER_EDGES_UNDAMPED, " where nothing damps the blows of edges"),
    };
    let critical = bearing.critical_time_step();
    if bearing.time_step <= share * critical {
        let least = steps == LEAST_STEPS && 1e-6 * wanted.step_us > bearing.time_step;
        let why = if least { "two in a sample" } else { "`model.step_us`" };
        return Ok((bearing, steps, why.to_owned()));
    }
    let of_critical = if share < 1.0 { format!("{share} of the") } else { "the".to_owned() };
    let dampers = match &scene.written.housing {
        HousingScene::Springs(springs) if springs.damping_n_s_m > 0.0 => {
            " of contacts, modes and the dampers of `housing.damping_n_s_m`"
        }
        _ => "",
    };
    let (critical_us, places) = (1e6 * critical, if critical < 1e-7 { 4 } else { 2 });
    let why = format!("{of_critical} critical {critical_us:.places$} µs{dampers}{why}");
    let steps = steps_per_sample(scene, share * critical);
    Ok((Bearing::new(modal, interval / steps as f64)?, steps, why))
}

/// The quasi-static part of a sensor's acceleration is a difference between two steps of a sample.
const LEAST_STEPS: usize = 2;

/// A whole number of steps, none longer than `longest` [s].
fn steps_per_sample(scene: &ResolvedScene, longest: f64) -> usize {
    // A quotient of 5.000…1 is no sixth step.
    ((1e-6 * scene.written.output.interval_us / longest - 1e-9).ceil() as usize).max(LEAST_STEPS)
}
