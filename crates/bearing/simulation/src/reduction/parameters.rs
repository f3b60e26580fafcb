//! The numbers that a scene adds to a reduction, and the tables of a step rounded for them.

use crate::bearing::assembly::CAGE_ELEMENT_MM;
use stribeck_mesh::{Circle, FormDeviation};
use stribeck_reduced::modal::{
    ModalBearing, Parameters, Reduction,
    outline::per_angle,
    parameters::{
        Branch, Contact, Damping, DampingFrame, Film, Oil, Outlines, Pockets, Radii, Ragged, Resistance,
        RollerStart, Speeds,
    },
};
use stribeck_scene::{
    deviation::{DeviationScene, FormScene, Relief, RollingSurface},
    resolved::{ResolvedScene, pocket_half_width},
    scene::{ContactMethod, ContactSurface, DampingFrame as SceneFrame, RollerCopies},
};
use stribeck_solver::structural_damping::StructuralDamping;
use stribeck_surface::Law;
use stribeck_theory::kinematics::Kinematics;

use crate::error::Error;
use crate::reduction::seat;

/// Density of mineral oil [kg/m³].
const OIL_DENSITY: f64 = 870.0;

/// The bearing of a scene whose mesh has been reduced.
///
/// # Errors
/// When contact's law has impossible numbers, the structural damping cannot be fitted, or films have no
/// loaded contact to follow from.
pub fn modal_bearing(scene: &ResolvedScene, reduction: Reduction) -> Result<ModalBearing, Error> {
    let parameters = parameters(scene, &reduction)?;
    let mut reduction = reduction;
    prepare(&mut reduction, &parameters);
    Ok(ModalBearing { reduction, parameters })
}

/// Rounds the tables that a step looks up to single precision, once for all that is computed from them, and
/// equalises what cannot differ: on a roller that passes over a wall both ends have the same height. Mass
/// damping does not act on a frame.
fn prepare(reduction: &mut Reduction, parameters: &Parameters) {
    let per_angle = per_angle(&parameters.outlines.outer);
    level_walls(&mut reduction.shapes, &per_angle);
    round(&mut reduction.shapes);
    if let Some(seat) = &mut reduction.springs {
        level_walls(&mut seat.by_rollers, &per_angle);
        [&mut seat.tension, &mut seat.by_rollers, &mut seat.stiffness]
            .into_iter()
            .for_each(|table| round(table));
        seat.flexibility = seat::flexibility(seat);
    }
    let Some(frame) = &reduction.frame else { return };
    let damped = parameters.damping.mass_of_modes * frame.mass;
    for shape in frame.shape.chunks_exact(reduction.padded) {
        for (row, a) in reduction.dampers.chunks_exact_mut(reduction.padded).zip(shape) {
            row.iter_mut().zip(shape).for_each(|(sum, b)| *sum -= damped * a * b);
        }
    }
}

/// Gives both ends of each wall the mean of their values, vertex by vertex.
fn level_walls(of_vertices: &mut [f64], per_angle: &[f64]) {
    let n = per_angle.len();
    let width = of_vertices.len() / n;
    for (a, _) in per_angle.iter().enumerate().filter(|(_, angle)| **angle == 0.0) {
        let b = (a + 1) % n;
        for k in 0..width {
            let mean = 0.5 * (of_vertices[a * width + k] + of_vertices[b * width + k]);
            (of_vertices[a * width + k], of_vertices[b * width + k]) = (mean, mean);
        }
    }
}

/// Rounds to single precision.
fn round(table: &mut [f64]) {
    table.iter_mut().for_each(|number| *number = f64::from(*number as f32));
}

fn parameters(scene: &ResolvedScene, reduction: &Reduction) -> Result<Parameters, Error> {
    let law = Law::penalty(scene.penalty_stiffness)
        .and_then(|law| law.with_damping(scene.written.contact.damping_ratio, scene.contact_layer_mass))?;
    let numbers: Vec<usize> = scene.written.rollers_in_place().map(|number| number - 1).collect();
    let rollers = rollers(scene, &numbers);
    Ok(Parameters {
        outlines: outlines(scene, reduction, &numbers, &rollers),
        radii: Radii {
            outer: scene.outer_race_radius,
            inner: scene.inner_race_radius,
            roller: scene.roller_radius,
        },
        thickness: scene.thickness,
        rollers,
        contact: Contact {
            stiffness: law.stiffness,
            damping: law.damping,
            friction: scene.written.contact.friction,
        },
        damping: damping(scene)?,
        gravity: scene.gravity,
        speeds: speeds(&scene.written.kinematics()),
        outer_turns: scene.written.operation.outer_turns(),
        load_at_start: scene.duty.load_n(0.0),
        duty: scene.varying_duty().cloned(),
        seat_friction: scene.written.contact.seat_friction,
        pockets: pockets(scene, &numbers),
        oil: oil(scene)?,
        ragged: [RollingSurface::Outer, RollingSurface::Inner].map(|on| ragged(scene, on)),
    })
}

/// The most ragged spall of a raceway.
fn ragged(scene: &ResolvedScene, on: RollingSurface) -> Ragged {
    let of = |deviation: &DeviationScene| match &deviation.form {
        FormScene::Spall(spall) if deviation.on == on => Some(Ragged {
            by: 1e-6 * spall.ragged_um.min(1e3 * spall.depth_mm),
            at: deviation.angle_deg.to_radians(),
            seed: scene.written.bearing.diameter_seed,
        }),
        _ => None,
    };
    let all = scene.written.defects.iter().filter_map(of);
    all.max_by(|a, b| a.by.total_cmp(&b.by)).unwrap_or_default()
}

/// Rollers of these pockets, from 0, at the start.
fn rollers(scene: &ResolvedScene, numbers: &[usize]) -> Vec<RollerStart> {
    let roller = |&number: &usize| {
        let angle = scene.roller_angle(number);
        let vertex_angle = match scene.written.mesh.roller_copies {
            RollerCopies::Translated => scene.roller_phase,
            RollerCopies::Rotated => angle + scene.roller_phase,
        };
        RollerStart { angle, vertex_angle }
    };
    numbers.iter().map(roller).collect()
}

fn outlines(
    scene: &ResolvedScene,
    reduction: &Reduction,
    numbers: &[usize],
    rollers: &[RollerStart],
) -> Outlines {
    let (mut rims, mut rim_of) = (vec![reduction.roller.clone()], vec![0; numbers.len()]);
    let mut larger = vec![0.0; numbers.len()];
    let arcs = scene.written.contact.surface != ContactSurface::Facet;
    for (of, relief) in &scene.roller_reliefs {
        let Some(i) = numbers.iter().position(|number| number == of) else { continue };
        if let Some(by) = relief.larger_by().filter(|_| arcs) {
            larger[i] = by;
            continue;
        }
        rim_of[i] = rims.len() as u32;
        // A rim is seen from its vertex 0.
        let relief = relief.turned(-rollers[i].vertex_angle);
        rims.push(formed(&reduction.roller, Some(&relief), Circle::Outer));
    }
    Outlines {
        outer: formed(&reduction.outer, scene.outer_relief.as_ref(), Circle::Inner),
        inner: formed(&reduction.inner, scene.inner_relief.as_ref(), Circle::Outer),
        rims,
        rim_of,
        larger,
        arcs,
    }
}

/// An outline with its deviation from round.
fn formed(outline: &[[f64; 2]], relief: Option<&Relief>, circle: Circle) -> Vec<[f64; 2]> {
    let mut vertices = outline.to_vec();
    if let Some(relief) = relief {
        let (depth, corners) = (|angle: f64| relief.depth(angle), relief.corners());
        FormDeviation { depth: &depth, corners: &corners, circle }.of_polygon(&mut vertices);
    }
    vertices
}

fn damping(scene: &ResolvedScene) -> Result<Damping, Error> {
    let band = scene.structural_damping;
    let branch =
        band.map(|band| StructuralDamping::over_band(band.ratio, band.band, Vec::new())).transpose()?;
    let branch = branch.map(|damping| damping.branch());
    let branch = branch.map(|b| Branch { stiffness: b.stiffness, relaxation_time: b.relaxation_time });
    let branches = branch.into_iter().collect();
    let frame = match scene.written.solver.damping_frame {
        SceneFrame::Rolling => DampingFrame::Rolling,
        // Its rollers do not deform: their own motion is all of theirs.
        SceneFrame::Standing | SceneFrame::RigidMotion => DampingFrame::RigidMotion,
        SceneFrame::Absolute => DampingFrame::Absolute,
    };
    let mass = scene.written.solver.mass_damping_per_s;
    // As in the full model, mass damping does not act on bodies that move as one piece.
    let mass_of_modes = match scene.written.housing.mass(&scene.written.bearing) {
        Some(rigid) => rigid.damping_per_s,
        None if scene.written.solver.damping_frame == SceneFrame::RigidMotion => 0.0,
        None => mass,
    };
    Ok(Damping { mass, mass_of_modes, frame, stiffness: scene.stiffness_damping, branches })
}

fn speeds(kinematics: &Kinematics) -> Speeds {
    Speeds {
        shaft: kinematics.shaft_rad_s,
        outer: kinematics.outer_rad_s,
        cage: kinematics.cage_rad_s,
        roller: kinematics.roller_rad_s,
    }
}

/// Pockets of the cage for rollers of these numbers, from 0.
fn pockets(scene: &ResolvedScene, numbers: &[usize]) -> Option<Pockets> {
    let cage = scene.cage.as_ref()?;
    let path = scene.path_radius();
    let [inner, outer] = cage.walls(path, scene.roller_radius);
    let rows = (1e3 * (outer - inner) / CAGE_ELEMENT_MM).round().max(1.0);
    Some(Pockets {
        ends: [inner, outer],
        path,
        half_width: pocket_half_width(inner, outer, path, scene.roller_radius + cage.pocket_clearance),
        angles: numbers.iter().map(|&number| scene.pocket_angle(number)).collect(),
        facet: (outer - inner) / rows,
        points_per_facet: match scene.written.contact.method {
            ContactMethod::Integrated => Some(scene.written.contact.points_per_facet),
            ContactMethod::Collocated => None,
        },
    })
}

fn oil(scene: &ResolvedScene) -> Result<Option<Oil>, Error> {
    let (Some(oil), Some([outer, inner])) = (scene.film, scene.loaded_films()?) else { return Ok(None) };
    let [outer, inner] = [outer, inner].map(|film| Film { least: film.least, speed: film.speed });
    let resistance = scene.written.film.as_ref().and_then(|film| film.resistance.as_ref());
    let resistance = resistance.map(|resistance| Resistance {
        limiting_traction: resistance.limiting_traction,
        pressure_viscosity: oil.pressure_viscosity,
        contact_modulus: scene.material.contact_modulus(),
        density: 1e-2 * resistance.oil_percent * OIL_DENSITY,
    });
    Ok(Some(Oil { viscosity: oil.viscosity, length: scene.contact_length, outer, inner, resistance }))
}
