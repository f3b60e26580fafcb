//! The penalty with which raceways give way as Hertz's do, and cylinders that stand for balls (THEORY §6.2).

use stribeck_theory::bearing::Bearing;
use stribeck_theory::contact_law::{ContactLaw, ContactLawKind};
use stribeck_theory::line_contact::LineContacts;
use stribeck_theory::static_load::RigidRings;

use crate::resolved::ResolvedScene;
use crate::scene::{ContactInterpolation, ModelScene};

/// Penalty stiffness [Pa/m] with which contacts give way as Hertz's do under `REFERENCE` times the force of the
/// most loaded roller, at the largest load of the run: the mesh gives way by the rest. At most `STIFFEST` layers of elements.
pub(crate) fn as_hertz(scene: &ResolvedScene) -> f64 {
    let [_, load_n] = scene.duty.load_range_n(scene.duration);
    let bearing = Bearing::from(scene);
    let largest_n = match scene.contact_law {
        ContactLawKind::Ball => STRIBECK * load_n / scene.rollers as f64,
        law => RigidRings::new(bearing, law)
            .distribute(load_n, &scene.written.angles_to_load_deg())
            .map_or(load_n, |load| load.max_roller_n()),
    };
    let force = REFERENCE * largest_n;
    let w = force / scene.thickness;
    let wanted = match scene.contact_law {
        ContactLawKind::Ball => ContactLaw::of(bearing, ContactLawKind::Ball).both(force),
        _ => LineContacts::of(bearing).approach(w).0,
    };
    let meshed = scene.meshed_contacts();
    let facet = scene.element_size * widened_by_splines(scene);
    let on_mesh = |side: usize, stiffness: f64| meshed.approach_on_mesh(side, w, facet, stiffness);
    let layer = scene.material.youngs_modulus / scene.element_size;
    let (mut soft, mut stiff) = (1e-4_f64, STIFFEST);
    for _ in 0..60 {
        let middle = (soft * stiff).sqrt();
        if on_mesh(0, middle * layer) + on_mesh(1, middle * layer) > wanted {
            soft = middle;
        } else {
            stiff = middle;
        }
    }
    soft * layer
}

/// How much wider contacts are by splines than by linear facets, over the length of a facet. Of the spread of a force on a
/// facet over nodes √5 (variances of ⅓ of the cubic and ½ of the smoothed nodes, over ⅙ of a hat; THEORY §4.5), and the
/// rest as surfaces that are smoothed follow the other's less; fitted to forces between rigid rings. The reduced
/// model's contacts are those of linear facets.
fn widened_by_splines(scene: &ResolvedScene) -> f64 {
    const BY_SPLINES: f64 = 3.5;
    let full = scene.written.model == ModelScene::Full;
    if full && scene.written.contact.interpolation == ContactInterpolation::Spline { BY_SPLINES } else { 1.0 }
}

/// Length of cylinders [m] that let the raceways approach each other at the most loaded place as balls would; at
/// most that of their rings.
pub(crate) fn length_of_balls(scene: &ResolvedScene) -> f64 {
    let load = STRIBECK * scene.written.operation.load_n / scene.rollers as f64;
    let wanted = ContactLaw::of(scene, ContactLawKind::Ball).both(load);
    let length = LineContacts::of(scene).load(wanted).map(|(line_load, _)| load / line_load);
    length.map_or(scene.thickness, |length| length.min(scene.thickness))
}

/// Share of the load that the most loaded element carries, times their number: Stribeck's number for balls.
const STRIBECK: f64 = 4.37;

/// The law of a penalty bends more than Hertz's: equal approaches under this multiple of the largest force make
/// the distribution over the rollers equal.
const REFERENCE: f64 = 1.5;

/// Stiffest penalty of the formula, in layers of elements.
const STIFFEST: f64 = 10.0;
