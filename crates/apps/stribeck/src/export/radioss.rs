//! A scene, or the scene of a run, as decks for Radioss: the preloaded start of the full model, set rolling.

use std::path::PathBuf;

use anyhow::{Context, Result, bail, ensure};
use stribeck_mesh::decks::radioss::{HOURGLASS_SCALE, Motion, Touching};
use stribeck_scene::housing::HousingScene;
use stribeck_scene::resolved::ResolvedScene;
use stribeck_scene::scene::{ContactSurface, DampingFrame, ModelScene, Start};
use stribeck_simulation::bearing::assembly::{Assembly, BearingSystem};
use stribeck_simulation::bearing::start::preload;
use stribeck_store::run_dir::write_atomic;

use crate::out::caution;

/// End of the name of a starter deck; an engine deck has `_0001.rad` in its place.
const STARTER: &str = "_0000.rad";

/// Writes the starter deck to `path` and the engine decks beside it.
pub(super) fn write(scene: &ResolvedScene, title: &str, path: PathBuf) -> Result<PathBuf> {
    let name = path.file_name().and_then(|name| name.to_str()).and_then(|name| name.strip_suffix(STARTER));
    let name = name.filter(|name| !name.is_empty()).with_context(|| {
        format!(
            "`--out {}`: Radioss reads a starter deck from a name that ends in `{STARTER}`",
            path.display()
        )
    })?;
    refuse(scene)?;
    let assembly = Assembly::new(scene)?;
    let mut bearing = assembly.build(scene, 1)?;
    if scene.written.solver.start == Start::Preloaded
        && let Some(words) = preload(&mut bearing, scene, &assembly.kinematics)?
    {
        caution!("{words}");
    }
    let motion = motion(scene, &assembly, &bearing);
    write_atomic(&path, motion.starter(name, title).as_bytes())?;
    for (run, engine) in (1..).zip(motion.engines(name)) {
        write_atomic(&path.with_file_name(format!("{name}_000{run}.rad")), engine.as_bytes())?;
    }
    Ok(path)
}

/// Refuses scenes of which the deck would be another experiment.
fn refuse(scene: &ResolvedScene) -> Result<()> {
    let s = &scene.written;
    let o = &s.operation;
    if let ModelScene::Reduced(_) = s.model {
        bail!("`model: reduced`: a deck has elements, and the reduced model has modes. Use `model: full`");
    }
    ensure!(
        s.contact.surface == ContactSurface::Facet,
        "`contact.surface`: contact in Radioss is between facets, and smooth surfaces have other tones. Use \
         `surface: facet`"
    );
    ensure!(
        !matches!(s.housing, HousingScene::Springs(_)) && !s.housing.is_rigid(),
        "`housing`: decks have housings of elements: adapter, pedestal or mesh; springs and rigid rings are \
         not written"
    );
    ensure!(
        o.speed_profile.is_none()
            && o.load_profile.is_none()
            && o.rotating_load.is_none()
            && !o.outer_turns(),
        "`operation`: decks have one speed of the shaft and one load, not profiles, a rotating load or a \
         turning outer ring"
    );
    Ok(())
}

fn motion<'a>(scene: &ResolvedScene, assembly: &'a Assembly, bearing: &BearingSystem) -> Motion<'a> {
    let (s, system) = (&scene.written, &bearing.system);
    let nodes = 0..system.node_count() as u32;
    let critical = system.critical_time_step();
    let steps = (scene.interval / (s.solver.time_step_factor * critical)).ceil().max(1.0);
    let [x, y] = s.load_direction();
    let load = scene.duty.load_n(0.0);
    let sensors = bearing.nodes_on_back(&scene.sensor_angles).into_iter().zip(&s.output.sensors);
    let sensors = sensors.map(|(node, sensor)| (format!("sensor {}", sensor.name), node));
    let kept_of_rollers = bearing.rollers.iter().flat_map(|r| {
        let part = |of: &str, node| (format!("{of} of roller {}", r.pocket + 1), node);
        [part("centre", r.centre), part("rim", r.rim)]
    });
    let standing = std::iter::once(bearing.outer).chain(bearing.housing);
    let rollers = bearing.rollers.iter().map(|roller| roller.body);
    let rollers = rollers.filter(|_| s.solver.damping_frame == DampingFrame::Absolute);
    let damped =
        if s.solver.damping_frame == DampingFrame::RigidMotion { 0.0 } else { s.solver.mass_damping_per_s };
    Motion {
        mesh: &assembly.model.mesh,
        absent: bearing.cage.into_iter().collect(),
        youngs_modulus: scene.material.youngs_modulus,
        poissons_ratio: scene.material.poissons_ratio,
        density: scene.material.density,
        thickness: scene.thickness,
        contacts: assembly
            .touching()
            .into_iter()
            .map(|(name, surfaces)| Touching { name, surfaces, stiffness: scene.penalty_stiffness })
            .collect(),
        gravity: [0.0, -s.operation.gravity_m_s2],
        load: (assembly.loaded(), [load * x, load * y]),
        guided: assembly.guided(),
        turning: (assembly.turned_by_the_shaft(), assembly.kinematics.shaft_rad_s),
        damping: (standing.chain(rollers).collect(), damped),
        position: nodes.map(|n| system.position(n)).collect(),
        rolling: rolling(assembly, bearing),
        duration: scene.duration,
        time_step: scene.interval / steps,
        interval: scene.interval,
        kept: sensors.chain(kept_of_rollers).collect(),
        remarks: remarks(scene, assembly),
    }
}

/// How each body moves in rolling without slip.
fn rolling(assembly: &Assembly, bearing: &BearingSystem) -> Vec<([f64; 2], f64)> {
    let k = &assembly.kinematics;
    let mut rolling = vec![([0.0; 2], 0.0); assembly.model.mesh.bodies.len()];
    rolling[bearing.inner].1 = k.shaft_rad_s;
    for roller in &bearing.rollers {
        let [x, y] = bearing.system.position(roller.centre);
        // The centre runs around the origin, and the roller turns about it.
        let less = k.cage_rad_s - k.roller_rad_s;
        rolling[roller.body] = ([-less * y, less * x], k.roller_rad_s);
    }
    rolling
}

/// How far the deck is another model than the scene.
fn remarks(scene: &ResolvedScene, assembly: &Assembly) -> Vec<String> {
    let s = &scene.written;
    let (c, v) = (&s.contact, &s.solver);
    let damped = v.mass_damping_per_s > 0.0;
    let rough = c.friction > 0.0 || c.seat_friction > 0.0;
    let all = [
        (s.cage.is_some(), "the cage: rollers keep their distances by inertia alone"),
        (s.film.is_some(), "oil films"),
        (rough, "friction: that of Radioss in the plane does not reach the limit of sliding"),
        (c.damping_ratio > 0.0, "contact damping"),
        (
            scene.element_share() != 1.0,
            "the length of balls: they are as long as their rings are wide, and heavier",
        ),
        (c.onset_um > 0.0, "the rounded onset of contact"),
        (v.structural_damping.is_some(), "structural damping"),
        (v.stiffness_damping_ns > 0.0, "stiffness damping"),
        (damped && v.damping_frame == DampingFrame::Rolling, "mass damping of rollers across their track"),
        (damped && v.damping_frame == DampingFrame::RigidMotion, "mass damping, which spares rigid motion"),
    ];
    let left_out = all.into_iter().filter(|(there, _)| *there).map(|(_, what)| format!("left out: {what}"));
    let mut remarks: Vec<String> = left_out.collect();
    remarks.push(
        "contact: nodes against facets in two passes, as with `contact.method: collocated`; facets of two \
         surfaces had better be as long, and those of the seat in the same places, as in a graded mesh"
            .into(),
    );
    remarks.push(format!(
        "hourglassing of squares is resisted as with `solver.hourglass_scale: {HOURGLASS_SCALE}`; the \
         scene has {}",
        v.hourglass_scale
    ));
    if !assembly.model.mesh.triangles.is_empty() {
        remarks.push(
            "triangles are quadrilaterals with their last node twice, which has half of their mass".into(),
        );
    }
    remarks
}
