//! The meaning of a scene: ranges first, then relations between fields. Every value that is proposed has been
//! tried.

use super::finding::{Finding, Proposal};
use super::origin::Origin;
use super::overrides;
use super::problem::SceneError;
use super::schema::Schema;
use super::{deviations, exclusions, extent, geometry, limits, operation, own, ring_meshes};
use crate::scene::Scene;

/// Refuses a scene with a number outside its range, or with bodies or demands that are impossible. `written`
/// is the scene before its bearing was completed.
pub(crate) fn check(
    scene: &Scene,
    origin: &Origin<'_>,
    written: Option<&own::Written>,
) -> Result<(), SceneError> {
    let found = findings(scene);
    if found.is_empty() {
        return Ok(());
    }
    let schema = Schema::get();
    let problem = |finding: &Finding| origin.problem(tried(finding, &found, scene, schema, written));
    Err(SceneError::new(found.iter().map(problem).collect()))
}

/// Whether every number lies in the range of its field.
pub(crate) fn numbers_are_in_range(scene: &Scene) -> bool {
    limits::findings(scene).is_empty()
}

/// Geometry only of numbers that are in range.
fn findings(scene: &Scene) -> Vec<Finding> {
    let found = limits::findings(scene);
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
fn tried(
    finding: &Finding,
    found: &[Finding],
    scene: &Scene,
    schema: &Schema,
    written: Option<&own::Written>,
) -> Finding {
    let mut finding = finding.clone();
    let this = finding.clone();
    for remedy in &mut finding.remedies {
        let default = schema.plain_default(&remedy.field).map(|value| Proposal::new(value, "the default"));
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
    let (repaired, _) = overrides::apply(scene.clone(), &[argument]).ok()?;
    let left = findings(&repaired);
    let known = |left: &Finding| found.iter().any(|old| old.is_about_the_same_as(left));
    left.iter().all(|left| !left.is_about_the_same_as(finding) && known(left)).then_some(left.len())
}
