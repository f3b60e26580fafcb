//! Advice on fields of a scene for a run that went wrong; only changes that the scene does not have yet.

use crate::scene::{PocketWalls, Scene};

/// Largest coefficient of friction that a scene may have.
pub(crate) const MOST_FRICTION: f64 = 2.0;

/// What guides a cage that has left the bearing, as the object of "take".
pub fn holds_cage(scene: &Scene) -> String {
    let corners = scene.cage.as_ref().is_some_and(|cage| cage.pocket == PocketWalls::Corners);
    let pockets = if corners {
        "a smaller `cage.pocket_clearance_um`, or another `cage.outer_diameter_mm`, so that its pockets are \
         narrower than rollers"
    } else {
        "`cage.pocket: corners` with pockets narrower than rollers"
    };
    let friction = if scene.contact.friction < MOST_FRICTION { "more `contact.friction`, " } else { "" };
    format!("{pockets}, {friction}or `cage: None`")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A run that had friction at its limit and a cage with corners was advised to take both.
    #[test]
    fn issue_a_cage_that_left_is_not_advised_what_the_scene_has_already() {
        let told = holds_cage(&Scene::default());
        assert!(
            told.starts_with("`cage.pocket: corners`") && told.contains("more `contact.friction`, or"),
            "{told}"
        );
        let mut scene = Scene::default();
        scene.cage.as_mut().expect("the paper's").pocket = PocketWalls::Corners;
        scene.contact.friction = MOST_FRICTION;
        let told = holds_cage(&scene);
        assert!(!told.contains("corners") && !told.contains("friction"), "{told}");
        assert!(told.contains("pocket_clearance_um") && told.ends_with("or `cage: None`"), "{told}");
    }
}
