//! Reduced meshes of earlier runs, kept beside their folders: one serves every start, speed and duration of
//! the same mesh under the same load, and every load and spall where the outer ring does not deform.

use std::f64::consts::PI;
use std::fs;
use std::path::{Path, PathBuf};

use stribeck_scene::{
    duty::LONGEST_RUN_S,
    machine::MachineScene,
    scene::{
        CageScene, ContactScene, DefectRing, DefectScene, GuardsScene, HousingScene, ModelScene,
        OperationScene, OutputScene, ReducedScene, Scene, SolverScene,
    },
};
use stribeck_store::run_dir::write_atomic;

use crate::error::Error;
use crate::reduction::{reduce::ReducedMesh, structure::modes_khz};

/// Folder of the reductions, in the parent of a run's folder.
const FOLDER: &str = ".reduced";

/// First bytes of the file, with the version of its content.
const MAGIC: &[u8; 20] = b"stribeck reduced vM\n";

/// The scene from which the reduction of `scene` is made: fields that change neither mesh nor preload have
/// their defaults. Rollers lie symmetrically about the first groove, as few as may be in it. A ring that does not
/// deform has neither groove nor preload: its load is as large as the bearing may carry, for which contacts are wide.
pub fn reference(scene: &Scene) -> Scene {
    // Facets are linear in any case: so are the contacts of the reduced model.
    let ContactScene { method, surface, points_per_facet, passes, formula, penalty_scale, onset_um, .. } =
        scene.contact.clone();
    let solver = SolverScene { hourglass_scale: scene.solver.hourglass_scale, ..SolverScene::default() };
    let is_rigid = scene.housing.is_rigid();
    let groove = scene.grooves().into_iter().next().filter(|_| !is_rigid);
    let middle = groove.as_ref().map_or(scene.load_zone_deg(), |groove| groove.angle_deg);
    let mut bearing = scene.bearing.clone();
    // With two of them as far from the middle as they can be, or with one in it.
    let is_over_one = groove.is_some_and(|groove| spacings(scene, &groove) % 2.0 >= 1.0);
    bearing.quality = None;
    bearing.first_roller_deg = middle + if is_over_one { 0.0 } else { 180.0 / bearing.rollers as f64 };
    let mut mesh = scene.mesh.clone();
    mesh.roller_phase_deg = 0.0;
    Scene {
        name: "reduction".to_owned(),
        model: ModelScene::Reduced(ReducedScene { modes_khz: modes_khz(scene), ..ReducedScene::default() }),
        bearing,
        cage: scene.cage.clone().map(|cage| CageScene { roller_offsets_um: Vec::new(), ..cage }),
        adapter: scene.adapter.clone(),
        // The path of a machine changes nothing of the bearing.
        housing: match scene.housing.machine() {
            Some(machine) => HousingScene::Machine(MachineScene {
                mass_kg: Some(machine.mass(&scene.bearing).mass_kg),
                damping_per_s: machine.damping_per_s,
                ..MachineScene::default()
            }),
            None => scene.housing.clone(),
        },
        outer_ring_mesh: scene.outer_ring_mesh.clone(),
        inner_ring_mesh: scene.inner_ring_mesh.clone(),
        defect: scene.defect.clone().filter(|_| !is_rigid),
        // All others change places, hardly the rings' stiffness: outlines get them later.
        defects: scene.defects.iter().filter(|d| !is_rigid && d.groove().is_some()).cloned().collect(),
        material: scene.material.clone(),
        mesh,
        operation: at_rest(scene),
        contact: ContactScene {
            method,
            surface,
            points_per_facet,
            passes,
            formula,
            penalty_scale,
            onset_um,
            seat_friction: if scene.contact.seat_friction > 0.0 { 1.0 } else { 0.0 },
            ..ContactScene::default()
        },
        film: None,
        solver,
        output: OutputScene { sensors: scene.output.sensors.clone(), frames: None, ..OutputScene::default() },
        guards: GuardsScene::default(),
    }
}

/// Length of a groove in spacings of the rollers over its raceway.
fn spacings(scene: &Scene, groove: &DefectScene) -> f64 {
    let bearing = &scene.bearing;
    let race_mm = match groove.ring {
        DefectRing::Outer => bearing.outer_race_diameter_mm,
        DefectRing::Inner => bearing.inner_race_diameter_mm,
    };
    groove.length_mm * bearing.rollers as f64 / (PI * race_mm)
}

/// Load [N] that the reduction of a scene is for: half-way between the least and the largest one of a profile, so that
/// it errs least over all of them.
pub(crate) fn preload_n(scene: &Scene) -> f64 {
    match scene.varying_duty() {
        Some(duty) => duty.load_range_n(LONGEST_RUN_S).iter().sum::<f64>() * 0.5,
        None => scene.operation.load_n,
    }
}

/// At rest. The speed adds a few newtons by which idle rollers press outwards; they are in the equilibrium that a run
/// starts from, so that one reduction serves all speeds.
fn at_rest(scene: &Scene) -> OperationScene {
    let load_n = match scene.housing.is_rigid() {
        true => scene.static_rating_n().max(scene.duty().load_range_n(LONGEST_RUN_S)[1]),
        false => preload_n(scene),
    };
    OperationScene {
        load_n,
        speed_rpm: 0.0,
        outer_speed_rpm: 0.0,
        speed_profile: None,
        outer_speed_profile: None,
        load_profile: None,
        rotating_load: None,
        ..scene.operation.clone()
    }
}

/// The reduced mesh of a scene, and whether it was cached. `runs` is the parent of the run's folder. Of
/// several processes that ask for the same one at once, the first makes it and the others wait.
///
/// # Errors
/// When it cannot be made. One that cannot be cached is made again next time.
pub fn reduced_mesh(scene: &Scene, runs: Option<&Path>) -> Result<(ReducedMesh, bool), Error> {
    let (reference, resolved) = (reference(scene), scene.resolve());
    let (healthy, from_cache) = reference_mesh(&reference, runs)?;
    Ok((healthy.of_scene(&resolved)?, from_cache))
}

fn reference_mesh(reference: &Scene, runs: Option<&Path>) -> Result<(ReducedMesh, bool), Error> {
    let make = || ReducedMesh::of_reference(&reference.resolve());
    let Some(file) = runs.map(|runs| file(runs, &reference.hash())) else {
        return Ok((make()?, false));
    };
    if let Some(found) = read(&file) {
        return Ok((found, true));
    }
    // Without a cache or a lock it takes longer; the result is the same.
    let _ = fs::create_dir_all(file.parent().unwrap_or(&file));
    let lock = file.with_extension("lock");
    let locked = acquire(&lock);
    if let Some(found) = locked.as_ref().and_then(|_| read(&file)) {
        return Ok((found, true));
    }
    let made = make();
    if let Some(bytes) = made.as_ref().ok().and_then(|made| postcard::to_extend(made, MAGIC.to_vec()).ok()) {
        let checksum = crc32fast::hash(&bytes[MAGIC.len()..]);
        let _ = write_atomic(&file, &[bytes, checksum.to_le_bytes().to_vec()].concat());
    }
    if locked.is_some() {
        // Waiting processes still acquire the lock, and find the file.
        let _ = fs::remove_file(lock);
    }
    Ok((made?, false))
}

/// Locks a file until the returned handle is dropped or the process ends.
fn acquire(lock: &Path) -> Option<fs::File> {
    let file = fs::File::create(lock).ok()?;
    file.lock().ok()?;
    Some(file)
}

fn file(runs: &Path, hash: &str) -> PathBuf {
    runs.join(FOLDER).join(format!("{hash}.modes"))
}

/// Content of the file, if it is complete.
fn read(file: &Path) -> Option<ReducedMesh> {
    let bytes = fs::read(file).ok()?;
    let (content, checksum) = bytes.strip_prefix(MAGIC)?.split_last_chunk()?;
    if crc32fast::hash(content) != u32::from_le_bytes(*checksum) {
        return None;
    }
    match postcard::take_from_bytes(content) {
        Ok((reduction, [])) => Some(reduction),
        _ => None,
    }
}
