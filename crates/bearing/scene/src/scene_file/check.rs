//! The meaning of a scene: ranges first, then relations between fields.

use super::{deviations, exclusions, extent, geometry, names, operation, ring_meshes};
use crate::reading::finding::Finding;
use crate::reading::problem::{MOST_TOLD, SceneError};
use crate::reading::sources::Sources;
use crate::scene::Scene;

/// Refuses a scene with a number outside its range, or with bodies or demands that are impossible.
pub(crate) fn check(scene: &Scene, sources: &Sources) -> Result<(), SceneError> {
    let found = findings(scene);
    if found.is_empty() {
        return Ok(());
    }
    Err(SceneError::new(found.into_iter().take(MOST_TOLD).map(|finding| sources.problem(finding)).collect()))
}

/// Relations only of numbers that are in range.
fn findings(scene: &Scene) -> Vec<Finding> {
    let found = names::findings(scene);
    if !found.is_empty() {
        return found;
    }
    let rules = [
        geometry::findings,
        deviations::findings,
        extent::findings,
        exclusions::findings,
        operation::findings,
        ring_meshes::findings,
    ];
    rules.iter().flat_map(|findings| findings(scene)).collect()
}
