//! Relations of rings from files: their raceways are those of the files, so other fields must not change
//! them.

use super::{INNER_RING_MESH, OUTER_RING_MESH};
use crate::field::wording::number;
use crate::reading::finding::{Finding, Remedy};
use crate::scene::{DefectRing, DeviationScene, Scene};

/// Everything that does not go together with a ring from a file.
pub(crate) fn findings(scene: &Scene) -> Vec<Finding> {
    let rings = [
        (DefectRing::Outer, OUTER_RING_MESH, scene.outer_ring_mesh.is_some()),
        (DefectRing::Inner, INNER_RING_MESH, scene.inner_ring_mesh.is_some()),
    ];
    let mut found: Vec<Finding> = Vec::new();
    for (ring, field, _) in rings.into_iter().filter(|(_, _, there)| *there) {
        found.extend(walls(scene, ring, field));
        found.extend(facets(scene, ring, field));
        found.extend(clearance(scene, ring, field));
    }
    found
}

fn generated(field: &str) -> Remedy {
    Remedy::new(field, "`None`, a ring that the program meshes").value("None", "")
}

/// Steep walls are meshed with their ring.
fn walls(scene: &Scene, ring: DefectRing, field: &str) -> Option<Finding> {
    let mut or = "";
    let (path, remedy) = if scene.defect.as_ref().is_some_and(|defect| defect.ring == ring) {
        or = ", and `defect: None` in the scene";
        ("defect".to_owned(), Remedy::new("defect", "`None`").value("None", "a healthy raceway"))
    } else {
        let steep = |deviation: &DeviationScene| deviation.groove().is_some_and(|groove| groove.ring == ring);
        let at = scene.defects.iter().position(steep)?;
        let path = format!("defects[{at}]");
        (path.clone(), Remedy::new(format!("{path}.form.edge"), "`sloped` or `rounded`").value("sloped", ""))
    };
    let message = format!(
        "`{path}` has steep walls on a ring whose mesh is that of `{field}.file`: such a spall has to be in \
         the file{or}"
    );
    Some(Finding::new(message, vec![remedy, generated(field)]))
}

/// The file has its facets.
fn facets(scene: &Scene, ring: DefectRing, field: &str) -> Option<Finding> {
    let (name, count) = match ring {
        DefectRing::Outer => ("mesh.outer_facets", scene.mesh.outer_facets),
        DefectRing::Inner => ("mesh.inner_facets", scene.mesh.inner_facets),
    };
    let message =
        format!("`{name}` is {}, and the facets of that raceway are those of `{field}.file`", count?);
    let remedy = Remedy::new(name, "`None`").value("None", "as in the file");
    Some(Finding::new(message, vec![remedy, generated(field)]))
}

/// The inner raceway of a file lies where it lies.
fn clearance(scene: &Scene, ring: DefectRing, field: &str) -> Option<Finding> {
    let change = scene.bearing.clearance_change_um;
    if ring == DefectRing::Outer || change == 0.0 {
        return None;
    }
    let message = format!(
        "`bearing.clearance_change_um` is {}, and the inner raceway is that of `{field}.file`: let the file \
         have it",
        number(change)
    );
    let remedy = Remedy::new("bearing.clearance_change_um", "0").value("0", "as in the file");
    Some(Finding::new(message, vec![remedy, generated(field)]))
}
