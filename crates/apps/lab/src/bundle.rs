//! A scene as the page holds it: the numbers of its bearing, what a person reads of it, and the first
//! milliseconds of its run to compare with.

use std::path::Path;

use serde_json::{Value, json};
use stribeck_reduced::modal::{
    Parameters,
    parameters::{Oil, Speeds},
};
use stribeck_reduced::motion::{BearingInMotion, Saved};
use stribeck_scene::{
    advice,
    housing::HousingScene,
    resolved::ResolvedScene,
    scene::{
        ContactSurface, DampingFrame, DefectRing, FilmScene, ModelScene, ReducedScene, Scene, SensorScene,
    },
};
use stribeck_simulation::reduced::{Prepared, prepared};
use stribeck_simulation::reduction::modal_bearing;
use stribeck_simulation::run::guards::OUT_OF_PLACE;
use stribeck_theory::catalogue::Element;
use stribeck_theory::kinematics::Kinematics;

use crate::{
    content::{Content, Rates},
    error::Error,
    handles::{HANDLES, Handles, at},
    limits::Limits,
    spall::Spall,
};

/// Angle between two sensors around the ring [°].
const BETWEEN_SENSORS_DEG: usize = 15;

/// Time that the check compares [s], and how often.
const CHECKED_S: f64 = 0.01;
const CHECKS: usize = 100;

/// Number of these at which the page restarts from the program's own state.
const STATES: usize = 10;

/// Data of a scene in the page.
pub(crate) struct Bundled {
    /// Its numbers.
    pub(crate) content: Content,
    /// Values for the scripts.
    pub(crate) facts: Value,
    /// Forces on all rollers at [`CHECKS`] places of the first milliseconds, as the program computes them,
    /// after the samples from one to the next.
    pub(crate) reference: Vec<f64>,
    /// States of that run from which the page goes on, [`STATES`] in all, as bytes.
    pub(crate) states: Vec<Vec<u8>>,
}

/// The scene as it runs in a page: in modes, without pictures, with sensors all around the ring after its
/// own.
pub(crate) fn in_modes(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    if scene.model == ModelScene::Full {
        scene.model = ModelScene::Reduced(ReducedScene::default());
    }
    scene.output.frames = None;
    scene
}

fn with_sensors(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    for angle in (0..360).step_by(BETWEEN_SENSORS_DEG) {
        let name = format!("at {angle}°");
        scene.output.sensors.push(SensorScene { name, angle_deg: angle as f64 });
    }
    scene
}

/// Prepares a scene. `runs` is where its reduction may be kept.
pub(crate) fn bundle(written: &Scene, runs: Option<&Path>) -> Result<Bundled, Error> {
    let own = in_modes(written);
    let scene = with_sensors(&own);
    let resolved = scene.resolve();
    let Prepared { modal, steps_per_sample, bearing, start } = prepared(&resolved, runs)?;
    let spall = spall(&resolved)?;
    let rates = rates(&scene, &modal)?;
    let time_step = bearing.time_step;
    let start = Saved::first(&bearing, start);
    let handles = handles(&resolved, &modal.parameters, spall.as_ref(), [time_step, rates.oil.viscosity]);
    let reduction = &modal.reduction;
    let facts = facts(&own, &resolved, reduction, &handles, time_step);
    let (reference, states) =
        reference(&resolved, steps_per_sample, BearingInMotion::new(bearing, start.clone()))?;
    let content = Content {
        modal,
        interval: resolved.interval,
        steps_per_sample,
        start,
        handles,
        spall,
        rates,
        limits: limits(&resolved),
    };
    Ok(Bundled { content, facts, reference, states })
}

/// The first milliseconds of a run: its forces, and states of it.
fn reference(
    scene: &ResolvedScene,
    steps_per_sample: usize,
    mut motion: BearingInMotion,
) -> Result<(Vec<f64>, Vec<Vec<u8>>), Error> {
    let every = ((CHECKED_S / scene.interval).round() as usize / CHECKS).max(1);
    let (mut reference, mut states) = (vec![every as f64], Vec::new());
    for check in 0..CHECKS {
        if check % (CHECKS / STATES) == 0 {
            states.push(postcard::to_stdvec(&motion.saved().state)?);
        }
        (0..every).for_each(|_| {
            motion.interval(steps_per_sample);
        });
        reference.extend(motion.rollers().flat_map(|roller| [roller.outer, roller.inner].concat()));
    }
    Ok((reference, states))
}

/// The spall with steep walls, which the mesh has.
fn spall(scene: &ResolvedScene) -> Result<Option<Spall>, Error> {
    let [groove] = &scene.grooves[..] else {
        return match scene.grooves.len() {
            0 => Ok(None),
            more => Err(Error::Unsuited(format!(
                "the scene has {more} spalls with steep walls, and a lab moves one: leave one of \
                 them in `defect` or `defects`"
            ))),
        };
    };
    Ok(Some(Spall {
        inner: groove.ring == DefectRing::Inner,
        angle: groove.angle,
        length: groove.length,
        depth: groove.depth,
        slope: groove.edge_slope,
    }))
}

fn rates(scene: &Scene, modal: &stribeck_reduced::modal::ModalBearing) -> Result<Rates, Error> {
    let of = |inner: f64, outer: f64| {
        let k = Kinematics::between(&scene.bearing, inner, outer);
        Speeds { shaft: k.shaft_rad_s, outer: k.outer_rad_s, cage: k.cage_rad_s, roller: k.roller_rad_s }
    };
    // With oil, a damping ratio of one and a speed, whatever the scene has: what grows with these handles.
    let mut reference = scene.clone();
    reference.film.get_or_insert_with(FilmScene::default);
    reference.contact.damping_ratio = 1.0;
    let duty = scene.duty();
    if duty.speed_rpm(0.0) == duty.outer_speed_rpm(0.0) {
        reference.operation.speed_rpm = duty.outer_speed_rpm(0.0) + 500.0;
    }
    let resolved = reference.resolve();
    let Parameters { contact, oil, .. } = modal_bearing(&resolved, modal.reduction.clone())?.parameters;
    let films = resolved.loaded_films().map_err(stribeck_simulation::Error::from)?;
    let (Some(oil), Some(films)) = (oil, films) else {
        return Err(Error::Unsuited(
            "the scene has no loaded roller: `operation.load_n` is too small".to_owned(),
        ));
    };
    let rigid = scene.housing.is_rigid() || scene.solver.damping_frame == DampingFrame::RigidMotion;
    Ok(Rates {
        speeds: [of(1.0, 0.0), of(0.0, 1.0)],
        outer_rpm: duty.outer_speed_rpm(0.0),
        contact_damping: contact.damping,
        along: duty.along,
        guided: duty.guided,
        damps_modes: !rigid,
        oil: Oil { ..oil },
        oil_rpm: resolved.duty.speed_rpm(0.0),
        thickness: films.map(|film| film.thickness),
        roughness: resolved.film.map_or(0.0, |film| film.roughness),
    })
}

/// Where the program stops a run of the scene.
fn limits(scene: &ResolvedScene) -> Limits {
    let (written, radius) = (&scene.written, scene.roller_radius);
    let [inner, outer] = [scene.inner_race_radius, scene.outer_race_radius];
    let depth = written.spalls().iter().map(|spall| 1e-3 * spall.depth_mm).fold(0.0, f64::max);
    let cage = scene.cage.as_ref().map(|cage| {
        let room = (outer - cage.outer_radius).min(cage.outer_radius - cage.thickness - inner);
        let pitch = 0.5 * (inner + outer);
        if room > 0.0 { [(room + cage.thickness).min(pitch), room] } else { [pitch, f64::INFINITY] }
    });
    Limits {
        energy_percent: written.guards.energy_stop_percent,
        penetration_percent: written.guards.penetration_stop_percent,
        element_size: scene.element_size,
        annulus: [inner + radius - OUT_OF_PLACE * radius, outer - radius + depth + OUT_OF_PLACE * radius],
        numbers: written.rollers_in_place().collect(),
        roller_radius: radius,
        cage,
        holds_cage: advice::holds_cage(written),
    }
}

/// Where the handles stand in the scene.
fn handles(
    scene: &ResolvedScene,
    parameters: &Parameters,
    spall: Option<&Spall>,
    [time_step, _]: [f64; 2],
) -> Handles {
    let written = &scene.written;
    let mut handles = [0.0; HANDLES.len()];
    handles[at::LOAD] = parameters.load_at_start;
    handles[at::SPEED] = scene.duty.speed_rpm(0.0);
    handles[at::FRICTION] = written.contact.friction;
    handles[at::CONTACT_DAMPING] = written.contact.damping_ratio;
    handles[at::MASS_DAMPING] = written.solver.mass_damping_per_s;
    handles[at::VISCOSITY] = written.film.as_ref().map_or(0.0, |film| film.viscosity_pa_s);
    handles[at::ARCS] = f64::from(u8::from(written.contact.surface != ContactSurface::Facet));
    handles[at::FACETS] = parameters.outlines.rims[0].len() as f64;
    let usual = Spall {
        inner: false,
        angle: written.load_zone_deg().to_radians(),
        length: 0.05 * scene.outer_race_radius,
        depth: 0.002 * scene.outer_race_radius,
        slope: 90_f64.to_radians(),
    };
    let shown = spall.unwrap_or(&usual);
    handles[at::SPALL_RING] = spall.map_or(0.0, |spall| if spall.inner { 2.0 } else { 1.0 });
    handles[at::SPALL_ANGLE] = shown.angle.to_degrees();
    handles[at::SPALL_LENGTH] = 1e3 * shown.length;
    handles[at::SPALL_DEPTH] = 1e3 * shown.depth;
    handles[at::SPALL_SLOPE] = shown.slope.to_degrees();
    // The roller that is nearest to the spall and comes to it: rollers go clockwise at a positive speed.
    let sense = if scene.duty.speed_rpm(0.0) < 0.0 { -1.0 } else { 1.0 };
    let before = |angle: f64| (sense * (angle - shown.angle)).rem_euclid(std::f64::consts::TAU);
    let rollers = parameters.rollers.iter().enumerate();
    let first = rollers.min_by(|a, b| before(a.1.angle).total_cmp(&before(b.1.angle)));
    handles[at::ROLLER] = first.map_or(0.0, |(n, _)| n as f64);
    handles[at::STEP] = 1e6 * time_step;
    handles
}

fn facts(
    scene: &Scene,
    resolved: &ResolvedScene,
    reduction: &stribeck_reduced::modal::Reduction,
    handles: &Handles,
    time_step: f64,
) -> Value {
    let unit = Kinematics::between(&scene.bearing, 1.0, 0.0);
    let title = match scene.bearing.designation.as_str() {
        "" => scene.name.clone(),
        name => name.to_owned(),
    };
    let sensors: Vec<Value> = resolved
        .written
        .output
        .sensors
        .iter()
        .map(|s| json!({ "name": s.name, "deg": s.angle_deg }))
        .collect();
    let cage = resolved.cage.as_ref().map(|cage| {
        let path = resolved.path_radius();
        let [inner, outer] = cage.walls(path, resolved.roller_radius);
        json!({
            "inner": inner, "outer": outer, "radii": cage.radii(), "clearance": cage.pocket_clearance,
            "pockets": (0..resolved.rollers).map(|i| resolved.pocket_angle(i)).collect::<Vec<_>>(),
        })
    });
    let housing = match &scene.housing {
        HousingScene::Adapter => {
            json!({ "kind": "adapter", "width": resolved.adapter_width, "height": resolved.adapter_height })
        }
        HousingScene::Pedestal(p) => json!({
            "kind": "pedestal", "width": 1e-3 * p.width_mm, "base": 1e-3 * p.base_mm, "top": 1e-3 * p.top_mm,
        }),
        HousingScene::Mesh(_) => json!({ "kind": "mesh" }),
        HousingScene::Rigid(_) | HousingScene::Machine(_) => json!({ "kind": "rigid" }),
        HousingScene::Springs(_) => json!({ "kind": "springs" }),
    };
    json!({
        "name": scene.name,
        "title": title,
        "rollers": resolved.rollers,
        "balls": scene.element() == Element::Ball,
        "outer": resolved.outer_race_radius, "outerThickness": resolved.outer_ring_thickness,
        "inner": resolved.inner_race_radius, "innerThickness": resolved.inner_ring_thickness,
        "roller": resolved.roller_radius, "width": resolved.thickness, "clearance": resolved.clearance,
        "cage": cage, "housing": housing, "sensors": sensors, "ownSensors": scene.output.sensors.len(),
        "along": resolved.duty.along, "guided": resolved.duty.guided,
        "weight": 9.81_f64.min(resolved.gravity) * reduction.structure_mass, "gravity": resolved.gravity,
        "hzPerRpm": {
            "shaft": unit.shaft_hz, "ftf": unit.cage_hz, "bpfo": unit.bpfo_hz, "bpfi": unit.bpfi_hz,
            "bsf": unit.bsf_hz, "spin": unit.roller_spin_hz,
        },
        "outerRpm": resolved.duty.outer_speed_rpm(0.0),
        "facets": { "outer": reduction.outer.len(), "inner": reduction.inner.len() },
        "handles": handles, "specs": HANDLES,
        "interval": resolved.interval, "timeStep": time_step,
        "modes": reduction.modes,
        "highestHz": reduction.squares.iter().copied().fold(0.0, f64::max).sqrt() / std::f64::consts::TAU,
        "varies": resolved.varying_duty().is_some(),
        "ron": scene.to_ron(),
        "fixed": fixed(scene),
    })
}

/// What changes the reduction: its name in the page, how it stands in the scene, and a field that changes it
/// with an example of a value.
fn fixed(scene: &Scene) -> Value {
    let (bearing, mesh) = (&scene.bearing, &scene.mesh);
    let housing = match &scene.housing {
        HousingScene::Adapter => "adapter",
        HousingScene::Pedestal(_) => "pedestal",
        HousingScene::Mesh(_) => "from a mesh",
        HousingScene::Rigid(_) => "rigid",
        HousingScene::Machine(_) => "of a machine",
        HousingScene::Springs(_) => "springs",
    };
    let highest = match &scene.model {
        ModelScene::Reduced(reduced) => format!("{} kHz", reduced.modes_khz),
        ModelScene::Full => String::new(),
    };
    json!([
        [
            if scene.element() == Element::Ball { "Balls" } else { "Rollers" },
            format!("{} of {} mm", bearing.rollers, bearing.roller_diameter_mm),
            "bearing.rollers=20"
        ],
        [
            "Raceways",
            format!("{} / {:.2} mm", bearing.outer_race_diameter_mm, bearing.inner_race_diameter_mm),
            "bearing.outer_race_diameter_mm=200.02",
        ],
        ["Elements", format!("{} mm", mesh.size_mm), "mesh.size_mm=1"],
        ["Housing", housing, "'housing=rigid(mass_kg: 3)'"],
        ["Modes below", highest, "'model=reduced(modes_khz: 20)'"],
    ])
}
