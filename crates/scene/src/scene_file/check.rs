//! What a scene means: ranges first, then what must fit together. Every value that is proposed has been tried.

use super::finding::Finding;
use super::origin::Origin;
use super::overrides;
use super::problem::SceneError;
use super::schema::Schema;
use super::{extent, geometry, limits};
use crate::scene::Scene;

/// Refuses a scene with a number outside its range, or with bodies or demands that are impossible.
pub(crate) fn check(scene: &Scene, origin: &Origin<'_>) -> Result<(), SceneError> {
    let mut found = findings(scene);
    if found.is_empty() {
        return Ok(());
    }
    let schema = Schema::new();
    for remedy in found.iter_mut().flat_map(|finding| &mut finding.remedies) {
        if let Some(default) = schema.plain_default(&remedy.field) {
            *remedy = remedy.clone().value(default, "the default");
        }
    }
    let problem = |finding: &Finding| {
        let repairs = |field: &str, value: &str| repairs(scene, &found, finding, field, value);
        origin.problem(finding.clone(), repairs)
    };
    Err(SceneError::new(found.iter().map(problem).collect()))
}

/// Geometry only of numbers that are in range.
fn findings(scene: &Scene) -> Vec<Finding> {
    let found = limits::findings(scene);
    if !found.is_empty() {
        return found;
    }
    let mut found = geometry::findings(scene);
    found.extend(extent::findings(scene));
    found
}

/// Whether `value` at `field` removes `finding` from those `found`, and brings no other.
fn repairs(scene: &Scene, found: &[Finding], finding: &Finding, field: &str, value: &str) -> bool {
    let Ok((repaired, _)) = overrides::apply(scene.clone(), &[format!("{field}={value}")]) else {
        return false;
    };
    let known = |left: &Finding| found.iter().any(|old| old.is_about_the_same_as(left));
    findings(&repaired).iter().all(|left| !left.is_about_the_same_as(finding) && known(left))
}
