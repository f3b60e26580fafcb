//! From handles to the numbers of a bearing.

use std::f64::consts::TAU;

use stribeck_reduced::modal::{
    ModalBearing, Reduction,
    parameters::{Oil, Speeds},
};
use stribeck_theory::duty::{Course, Duty};

use crate::{
    content::{Content, Rates},
    error::Error,
    handles::{Handles, at},
    limits::Limits,
    spall::{self, Spall},
};

/// Time in which the bearing comes to another speed, and to another load [s]: neither is a blow.
const SPEED_RAMP: f64 = 0.02;
const LOAD_RAMP: f64 = 0.002;

/// Exponent of viscosity and speed in the thickness of a film (Dowson and Higginson; `lubrication.rs` of
/// `stribeck-scene`).
const OF_FILMS: f64 = 0.7;

pub(crate) fn spall(handles: &Handles) -> Option<Spall> {
    let ring = handles[at::SPALL_RING].round();
    (ring > 0.0).then(|| Spall {
        inner: ring > 1.0,
        angle: handles[at::SPALL_ANGLE].to_radians(),
        length: 1e-3 * handles[at::SPALL_LENGTH],
        depth: 1e-3 * handles[at::SPALL_DEPTH],
        slope: handles[at::SPALL_SLOPE].to_radians(),
    })
}

/// The bearing of some handles, under a load and at a speed that follow `duty`. A handle that stands where
/// the scene has it changes no bit.
///
/// # Errors
/// When a raceway has no room for the spall.
pub(crate) fn modal(content: &Content, to: &Handles, duty: Option<Duty>) -> Result<ModalBearing, Error> {
    let mut modal = content.modal.clone();
    let was = &content.handles;
    let turned = |handle: usize| to[handle] != was[handle];
    let ModalBearing { reduction, parameters } = &mut modal;
    keep_sensor(reduction, to[at::SENSOR] as usize);
    parameters.outlines.arcs = to[at::ARCS] > 0.5;
    if turned(at::FACETS) {
        parameters.outlines.rims[0] = polygon(parameters.radii.roller, to[at::FACETS] as usize);
    }
    if turned(at::FRICTION) {
        parameters.contact.friction = to[at::FRICTION];
    }
    if turned(at::CONTACT_DAMPING) {
        parameters.contact.damping = to[at::CONTACT_DAMPING] * content.rates.contact_damping;
    }
    if turned(at::MASS_DAMPING) {
        parameters.damping.mass = to[at::MASS_DAMPING];
        parameters.damping.mass_of_modes = if content.rates.damps_modes { to[at::MASS_DAMPING] } else { 0.0 };
    }
    if turned(at::SPEED) {
        parameters.speeds = speeds(&content.rates, to[at::SPEED]);
    }
    if turned(at::VISCOSITY) || turned(at::SPEED) {
        parameters.oil = oil(&content.rates, to);
    }
    move_spall(content, to, &mut modal)?;
    let ModalBearing { reduction, parameters } = &mut modal;
    if turned(at::CLEARANCE) {
        let nearer = 0.5e-6 * (to[at::CLEARANCE] - was[at::CLEARANCE]);
        parameters.radii.inner -= nearer;
        for vertex in &mut parameters.outlines.inner {
            let share = 1.0 - nearer / vertex[0].hypot(vertex[1]);
            *vertex = vertex.map(|place| share * place);
        }
    }
    if turned(at::DIRECTION) {
        turn_load(reduction, to[at::DIRECTION].to_radians());
    }
    if turned(at::LOAD) {
        parameters.load_at_start = to[at::LOAD];
    }
    if turned(at::LOAD) || turned(at::SPEED) {
        parameters.duty = duty;
    }
    Ok(modal)
}

/// Where a run of some handles stops: rollers go as deep as the spall is, and in as the inner raceway goes.
pub(crate) fn limits(content: &Content, to: &Handles) -> Limits {
    let mut limits = content.limits.clone();
    let depth = |spall: Option<Spall>| spall.map_or(0.0, |spall| spall.depth);
    limits.annulus[0] -= (0.5e-6 * (to[at::CLEARANCE] - content.handles[at::CLEARANCE])).max(0.0);
    limits.annulus[1] += (depth(spall(to)) - depth(content.spall)).max(0.0);
    limits
}

/// Leaves one sensor: others cost time.
fn keep_sensor(reduction: &mut Reduction, sensor: usize) {
    let sensor = sensor.min(reduction.sensors.len().saturating_sub(1));
    reduction.sensors = reduction.sensors.drain(..).skip(sensor).take(1).collect();
    if let Some(seat) = &mut reduction.springs {
        seat.at_sensors = seat.at_sensors.drain(..).skip(sensor).take(1).collect();
    }
}

/// Vertices of a roller from its centre [m].
fn polygon(radius: f64, facets: usize) -> Vec<[f64; 2]> {
    let vertex = |i: usize| {
        let (s, c) = (TAU * i as f64 / facets as f64).sin_cos();
        [radius * c, radius * s]
    };
    (0..facets).map(vertex).collect()
}

/// Speeds without slip at this speed of the inner ring [rpm].
fn speeds(rates: &Rates, rpm: f64) -> Speeds {
    let [inner, outer] = &rates.speeds;
    let of = |a: f64, b: f64| a * rpm + b * rates.outer_rpm;
    Speeds {
        shaft: of(inner.shaft, outer.shaft),
        outer: of(inner.outer, outer.outer),
        cage: of(inner.cage, outer.cage),
        roller: of(inner.roller, outer.roller),
    }
}

/// Oil of some viscosity at some speed; its films carry the load that they carry in the scene.
fn oil(rates: &Rates, to: &Handles) -> Option<Oil> {
    let viscosity = to[at::VISCOSITY];
    if viscosity <= 0.0 {
        return None;
    }
    let faster = ((to[at::SPEED] - rates.outer_rpm) / (rates.oil_rpm - rates.outer_rpm)).abs();
    let mut oil = rates.oil;
    let thicker = (viscosity / oil.viscosity * faster).powf(OF_FILMS);
    oil.viscosity = viscosity;
    for (film, thickness) in [&mut oil.outer, &mut oil.inner].into_iter().zip(rates.thickness) {
        film.speed *= faster;
        film.least = (thickness * thicker).max(rates.roughness);
    }
    Some(oil)
}

/// Moves the spall from where the scene has it.
fn move_spall(content: &Content, to: &Handles, modal: &mut ModalBearing) -> Result<(), Error> {
    let (was, is) = (content.spall, spall(to));
    if was == is {
        return Ok(());
    }
    let on = |spall: Option<Spall>, inner: bool| spall.filter(|spall| spall.inner == inner);
    let ModalBearing { reduction, parameters } = modal;
    let [old, new] = [on(was, false), on(is, false)];
    if old != new {
        let outline = parameters.outlines.outer.clone();
        parameters.outlines.outer = spall::move_outer(reduction, &outline, old.as_ref(), new.as_ref())?;
    }
    let [old, new] = [on(was, true), on(is, true)];
    if old != new {
        parameters.outlines.inner =
            spall::moved(&parameters.outlines.inner, old.as_ref(), new.as_ref(), -1.0)?;
    }
    Ok(())
}

/// Turns the load of the preload about the centre.
fn turn_load(reduction: &mut Reduction, by: f64) {
    let (s, c) = by.sin_cos();
    let load = &mut reduction.load;
    let (along, across) = (load.along.clone(), load.across.clone());
    for k in 0..along.len() {
        load.along[k] = c * along[k] + s * across[k];
        load.across[k] = c * across[k] - s * along[k];
        let change = load.along[k] - along[k];
        reduction.constant[k] += change;
        reduction.external[k] += change;
    }
}

/// Speed and load that go from what they are at the time `now` [s] to those of the handles.
pub(crate) fn course(content: &Content, from: [f64; 2], to: &Handles, now: f64) -> Duty {
    let line = |from: f64, to: f64, takes: f64| {
        if from == to { Course::Constant(to) } else { Course::lines(&[(now, from), (now + takes, to)]) }
    };
    let scene = content.modal.parameters.duty.as_ref();
    Duty {
        speed: line(from[1], to[at::SPEED], SPEED_RAMP),
        outer: scene.map_or(Course::Constant(content.rates.outer_rpm), |duty| duty.outer.clone()),
        load: line(from[0], to[at::LOAD], LOAD_RAMP),
        rotating: scene.and_then(|duty| duty.rotating),
        along: content.rates.along,
        guided: content.rates.guided,
    }
}
