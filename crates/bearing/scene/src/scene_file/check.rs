//! The meaning of a scene: ranges first, then relations between fields. Every value that is proposed has been
//! tried.

use super::finding::{Finding, Proposal};
use super::problem::{MOST_TOLD, SceneError};
use super::sources::{self, Sources};
use super::{deviations, exclusions, extent, geometry, operation, own, ranges, ring_meshes};
use crate::fields::{Shape, Spot, spot};
use crate::scene::Scene;

/// Refuses a scene with a number outside its range, or with bodies or demands that are impossible. `written`
/// is the scene before its bearing was completed.
pub(crate) fn check(
    scene: &Scene,
    sources: &Sources,
    written: Option<&own::Written>,
) -> Result<(), SceneError> {
    let found = findings(scene);
    if found.is_empty() {
        return Ok(());
    }
    let problem = |finding: &Finding| sources.problem(tried(finding, &found, scene, written));
    Err(SceneError::new(found.iter().take(MOST_TOLD).map(problem).collect()))
}

/// Whether every number lies in the range of its field.
pub(crate) fn numbers_are_in_range(scene: &Scene) -> bool {
    ranges::findings(scene).is_empty()
}

/// Geometry only of numbers that are in range.
fn findings(scene: &Scene) -> Vec<Finding> {
    let found = ranges::findings(scene);
    if !found.is_empty() {
        return found;
    }
    let mut found = geometry::findings(scene);
    found.extend(deviations::findings(scene));
    found.extend(extent::findings(scene));
    found.extend(exclusions::findings(scene));
    found.extend(operation::findings(scene));
    found.extend(ring_meshes::findings(scene));
    found
}

/// The finding with at most one value in each remedy: the one that leaves fewest of those `found`, this one
/// not.
fn tried(finding: &Finding, found: &[Finding], scene: &Scene, written: Option<&own::Written>) -> Finding {
    let mut finding = finding.clone();
    let this = finding.clone();
    for remedy in &mut finding.remedies {
        // Leaving a group out is a remedy of its own, and the dimensions of the paper's bearing are none of
        // another.
        let is_plain = |spot: &Spot| spot.shape.counts() || !matches!(spot.shape, Shape::Optional(_));
        let of_another = remedy.field.starts_with("bearing.") && !scene.bearing.designation.is_empty();
        let at = spot(&remedy.field, None)
            .filter(|spot| is_plain(spot) && !remedy.field.contains('[') && !of_another);
        let default = at.and_then(Spot::plain_default).map(|value| Proposal::new(value, "the default"));
        let values = remedy.values.drain(..).chain(default);
        let left = |value: &Proposal| {
            let argument = format!("{}={}", remedy.field, value.value);
            let refused = written.is_some_and(|written| written.is_refused_with(&remedy.field, &argument));
            if refused { None } else { left_by(&argument, &this, found, scene) }
        };
        let passing = values.filter_map(|value| Some((left(&value)?, value)));
        remedy.values = passing.min_by_key(|(left, _)| *left).map(|(_, value)| value).into_iter().collect();
    }
    finding
}

/// How many findings are left with the override `argument`; `None` when `finding` is among them, or a new
/// one.
fn left_by(argument: &str, finding: &Finding, found: &[Finding], scene: &Scene) -> Option<usize> {
    let left = findings(&sources::with(scene, argument)?);
    let known = |left: &Finding| found.iter().any(|old| old.is_about_the_same_as(left));
    left.iter().all(|left| !left.is_about_the_same_as(finding) && known(left)).then_some(left.len())
}
