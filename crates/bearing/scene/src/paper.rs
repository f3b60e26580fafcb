//! The paper's run, which is simulated where no scene file is named.

use crate::scene::Scene;

/// The text of `fixtures/scenes/singh2014.ron`.
pub const SINGH2014_RON: &str = include_str!("singh2014.ron");

impl Scene {
    /// The bearing of Singh et al., Inter-Noise 2014, as `fixtures/scenes/singh2014.ron` spells it out.
    ///
    /// [`Scene::default`] is the same bearing in oil, without any value that is inferred from the paper's
    /// figures.
    pub fn singh2014() -> Self {
        Self::parse(SINGH2014_RON, "singh2014.ron").expect("a scene that a test reads")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn invariant_the_paper_s_run_is_that_of_the_fixture() {
        let file = include_str!("../../../../fixtures/scenes/singh2014.ron");
        assert!(
            file == SINGH2014_RON,
            "crates/bearing/scene/src/singh2014.ron is another text than fixtures/scenes/singh2014.ron: copy that one"
        );
        let scene = Scene::singh2014();
        assert_eq!(scene.name, "singh2014");
        assert!(scene.validate().is_ok());
    }

    /// Fields that the paper gives have its values, whatever the others are: Table 1, load, speed, defect.
    #[test]
    fn invariant_the_paper_s_run_has_what_the_paper_gives() {
        let (paper, oiled) = (Scene::singh2014(), Scene::default());
        let (b, expected) = (&paper.bearing, &oiled.bearing);
        assert_eq!(b.outer_race_diameter_mm, expected.outer_race_diameter_mm);
        assert_eq!(b.outer_ring_thickness_mm, expected.outer_ring_thickness_mm);
        assert_eq!(b.inner_race_diameter_mm, expected.inner_race_diameter_mm);
        assert_eq!(b.inner_ring_thickness_mm, expected.inner_ring_thickness_mm);
        assert_eq!((b.rollers, b.roller_diameter_mm), (expected.rollers, expected.roller_diameter_mm));
        assert_eq!((&paper.adapter, &paper.defect), (&oiled.adapter, &oiled.defect));
        assert_eq!((&paper.material, &paper.operation), (&oiled.material, &oiled.operation));
        let friction = |scene: &Scene| (scene.contact.friction, scene.contact.seat_friction);
        assert_eq!(friction(&paper), friction(&oiled));
        assert_eq!(paper.solver.duration_ms, oiled.solver.duration_ms);
        assert_eq!(paper.output.interval_us, oiled.output.interval_us);
    }
}
