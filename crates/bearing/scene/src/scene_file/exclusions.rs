//! Choices that exclude each other: two kinds of damping, oil over gentle edges, a sudden start of the
//! reduced model, relieved rollers where there is a mesh; and bands and lists of damping that must not be empty.

use crate::deviation::{DeviationScene, FormScene, RollingSurface};
use crate::faults::rolling_circle;
use crate::field::wording::number;
use crate::reading::finding::{Finding, Remedy};
use crate::scene::{ContactFormula, DefectRing, ModelScene, RollerProfile, Scene, Start};
use stribeck_theory::catalogue::Element;

/// Upper over lower end of the narrowest band of structural damping.
const NARROWEST_BAND: f64 = 2.0;

/// A vertex is a corner when it turns by this angle [°] …
const CORNER_DEG: f64 = 20.1;

/// … and an edge of a defect turns by its slope less half of the raceway's turn from facet to facet, up
/// to a few degrees. None slopes less under oil [°].
const LEAST_EDGE_DEG: f64 = 22.0;

/// Every choice that excludes another, in a scene whose numbers are in range.
pub(crate) fn findings(scene: &Scene) -> Vec<Finding> {
    let groups = [
        damped_band,
        damped_bodies,
        damped_twice,
        oiled_edges,
        resisting_oil,
        reduced_starts,
        profiles,
        ragged_edges,
    ];
    groups.iter().filter_map(|group| group(scene)).collect()
}

/// A band of structural damping wide enough for its branches.
fn damped_band(scene: &Scene) -> Option<Finding> {
    const FROM: &str = "solver.structural_damping.from_khz";
    const TO: &str = "solver.structural_damping.to_khz";
    let damping = scene.solver.structural_damping.as_ref()?;
    let (from, to) = (damping.from_khz, damping.to_khz);
    if to >= NARROWEST_BAND * from {
        return None;
    }
    let message = format!(
        "`{TO}` is {}, less than {NARROWEST_BAND} times `{FROM}` ({} kHz): the damped band is too narrow",
        number(to),
        number(from)
    );
    let (least, most) = (NARROWEST_BAND * from, to / NARROWEST_BAND);
    Some(Finding::new(
        message,
        vec![
            Remedy::new(TO, format!("at least {} kHz", number(least))),
            Remedy::new(FROM, format!("at most {} kHz", number(most))),
        ],
    ))
}

/// Structural damping of at least one body, and of none twice.
fn damped_bodies(scene: &Scene) -> Option<Finding> {
    const BODIES: &str = "solver.structural_damping.bodies";
    let bodies = &scene.solver.structural_damping.as_ref()?.bodies;
    let twice = (1..bodies.len()).any(|i| bodies[..i].contains(&bodies[i]));
    let message = match (bodies.is_empty(), twice) {
        (true, _) => format!("`{BODIES}` is empty: nothing would be damped"),
        (_, true) => format!("`{BODIES}` names a body twice"),
        _ => return None,
    };
    let allowed = "`outer_ring`, `inner_ring`, `adapter`, `rollers`, each once";
    let remedy =
        Remedy::new(BODIES, allowed.to_owned()).value("[outer_ring, inner_ring, adapter]", "the default");
    Some(Finding::new(message, vec![remedy]))
}

/// Structural or stiffness damping: both let elements see other positions than those of the nodes.
fn damped_twice(scene: &Scene) -> Option<Finding> {
    const STRUCTURAL: &str = "solver.structural_damping";
    const STIFFNESS: &str = "solver.stiffness_damping_ns";
    let solver = &scene.solver;
    if solver.structural_damping.is_none() || solver.stiffness_damping_ns == 0.0 {
        return None;
    }
    let message = format!(
        "`{STRUCTURAL}` and `{STIFFNESS}` = {} exclude each other",
        number(solver.stiffness_damping_ns)
    );
    Some(Finding::new(
        message,
        vec![
            Remedy::new(STIFFNESS, "0 ns".to_owned()).value("0.0", "structural damping alone"),
            Remedy::new(STRUCTURAL, "`None`".to_owned()).value("None", "stiffness damping alone"),
        ],
    ))
}

/// Oil ends at the edges of a defect: walls that a surface turns into more gently are no end, and a film
/// would lie across them.
fn oiled_edges(scene: &Scene) -> Option<Finding> {
    scene.film.as_ref()?;
    let defect = scene.defect.as_ref()?;
    let ring = match defect.ring {
        DefectRing::Outer => RollingSurface::Outer,
        DefectRing::Inner => RollingSurface::Inner,
    };
    let [diameter, facet] = rolling_circle(scene, ring);
    let least = LEAST_EDGE_DEG.max((CORNER_DEG + (facet / diameter).to_degrees()).ceil());
    if defect.edge_slope_deg >= least {
        return None;
    }
    let message = format!(
        "`film` is there, and the edges of `defect` slope by {}°: oil needs edges of {least}° or more on \
         facets of {} mm",
        number(defect.edge_slope_deg),
        number(facet)
    );
    let slope = Remedy::new("defect.edge_slope_deg", format!("{least}° or more"));
    let dry = Remedy::new("film", "`None`").value("None", "dry");
    Some(Finding::new(message, vec![slope, dry]))
}

/// Only the reduced model has the resistance of oil.
fn resisting_oil(scene: &Scene) -> Option<Finding> {
    const RESISTANCE: &str = "film.resistance";
    let resists = scene.film.as_ref().is_some_and(|film| film.resistance.is_some());
    if !resists || scene.model != ModelScene::Full {
        return None;
    }
    let message = format!("`{RESISTANCE}` is there, and the full model has none");
    let reduced = Remedy::new("model", "`reduced()`".to_owned()).value("reduced()", "");
    Some(Finding::new(message, vec![reduced, Remedy::new(RESISTANCE, "`None`".to_owned()).value("None", "")]))
}

/// Only the reduced model relieves rollers towards their ends, as a part of steel's contact.
fn profiles(scene: &Scene) -> Option<Finding> {
    const PROFILE: &str = "bearing.roller_profile";
    if scene.bearing.roller_profile == RollerProfile::Straight {
        return None;
    }
    let (why, other) = if scene.element() == Element::Ball {
        ("balls have none", None)
    } else if scene.model == ModelScene::Full {
        let reduced = Remedy::new("model", "`reduced()`".to_owned()).value("reduced()", "");
        ("the full model meshes cylinders: it is `straight` there, or take `model: reduced()`", Some(reduced))
    } else if scene.contact.formula != ContactFormula::Hertz {
        let hertz = Remedy::new("contact.formula", "`hertz`".to_owned()).value("hertz", "");
        ("`contact.formula` is another than that of steel rollers", Some(hertz))
    } else {
        return None;
    };
    let straight = Remedy::new(PROFILE, "`straight`".to_owned()).value("straight", "");
    let remedies = std::iter::once(straight).chain(other).collect();
    Some(Finding::new(format!("`{PROFILE}` is `logarithmic`, and {why}"), remedies))
}

/// Only the reduced model has ragged edges, and only of walls of raceways.
fn ragged_edges(scene: &Scene) -> Option<Finding> {
    let ragged = |deviation: &DeviationScene| match &deviation.form {
        FormScene::Spall(spall) if spall.ragged_um > 0.0 => Some(deviation.groove().is_some()),
        _ => None,
    };
    let (n, is_groove) = scene.defects.iter().enumerate().find_map(|(n, of)| Some((n, ragged(of)?)))?;
    let why = if scene.model == ModelScene::Full {
        "the full model meshes straight edges"
    } else if !is_groove {
        "only rectangular edges of raceways are ragged"
    } else {
        return None;
    };
    let field = format!("defects[{n}].form.ragged_um");
    Some(Finding::new(
        format!("`{field}` is there, and {why}"),
        vec![Remedy::new(&field, "0".to_owned()).value("0.0", "")],
    ))
}

/// The reduced model is made about the preload.
fn reduced_starts(scene: &Scene) -> Option<Finding> {
    if scene.model == ModelScene::Full || scene.solver.start == Start::Preloaded {
        return None;
    }
    let message =
        "`solver.start` is `sudden`, and the reduced model has small motions about the preload only"
            .to_owned();
    Some(Finding::new(
        message,
        vec![
            Remedy::new("solver.start", "`preloaded`".to_owned()).value("preloaded", ""),
            Remedy::new("model", "`full`".to_owned()).value("full", ""),
        ],
    ))
}
