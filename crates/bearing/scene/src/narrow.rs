//! Pits narrower than the contact: an element over one loses the part of its contact that the pit takes, and is
//! borne by the rest.
//!
//! In the plane a pit takes the whole contact. One of width w across the raceway takes the part s of the load
//! that the middle of the contact bears, and as much less is borne at the same approach δ. With a force that grows
//! as δ^(3/2) a whole pit of the depth δ (1 − (1 − s)^(2/3)) does the same, and that is how deep it is made at the
//! place of the largest load at rest (THEORY §6.4).

use stribeck_theory::catalogue::Element;
use stribeck_theory::point_contact::{self, CONFORMITY};
use stribeck_theory::static_load::RigidRings;

use crate::resolved::ResolvedScene;
use crate::scene::{DefectRing, DefectScene};

/// Part of the load of a point contact that a strip across its middle bears, of a width over that of the contact:
/// the integral of the pressure over the strip, ∫(1 − y²)dy (Johnson 1985, *Contact Mechanics*, eq. 3.58).
fn part_of_point(share: f64) -> f64 {
    let y = share.min(1.0);
    0.5 * y * (3.0 - y * y)
}

impl ResolvedScene {
    /// Depth [m] of the whole pit that stands for a narrow one; that of the pit itself where it is shallower, or
    /// has no width.
    pub(crate) fn depth_of(&self, defect: &DefectScene) -> f64 {
        let depth = 1e-3 * defect.depth_mm;
        let bridged = defect.width_mm.and_then(|width_mm| self.bridged(defect.ring, 1e-3 * width_mm));
        bridged.map_or(depth, |bridged| bridged.min(depth))
    }

    /// `None` for one that takes the whole contact, and without an equilibrium.
    fn bridged(&self, ring: DefectRing, width: f64) -> Option<f64> {
        let from_load: Vec<f64> = (0..self.rollers)
            .map(|n| 360.0 * n as f64 / self.rollers as f64)
            .map(|deg| deg.min(360.0 - deg))
            .collect();
        let load =
            RigidRings::new(self, self.contact_law).distribute(self.duty.load_n(0.0), &from_load).ok()?;
        let part = match self.written.element() {
            Element::Ball => {
                let across = match ring {
                    DefectRing::Outer => -self.outer_race_radius,
                    DefectRing::Inner => self.inner_race_radius,
                };
                let modulus = self.material.youngs_modulus / (1.0 - self.material.poissons_ratio.powi(2));
                let groove = 2.0 * CONFORMITY * self.roller_radius;
                let half = point_contact::half_width(
                    self.roller_radius,
                    across,
                    groove,
                    load.max_roller_n(),
                    modulus,
                );
                part_of_point(width / (2.0 * half))
            }
            Element::Roller => width / self.thickness,
        };
        // Contacts of both rings share the approach.
        let one = 0.5 * load.max_approach_m();
        (part < 1.0).then(|| one * (1.0 - (1.0 - part).powf(2.0 / 3.0)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    fn depth_um(width: &str, load_n: f64) -> f64 {
        let scene = format!(
            "(bearing: \"6205\", model: reduced(), housing: rigid(), film: None, operation: (load_n: {load_n:?}), \
             defect: (length_mm: 0.5, depth_mm: 0.1, width_mm: {width}))"
        );
        1e6 * Scene::parse(&scene, "narrow.ron").expect("a scene").resolve().grooves[0].depth
    }

    /// Source: the pressure of an elliptic contact is an ellipsoid; a strip of its middle has (3η − η³)/2 of it.
    #[test]
    fn analytic_a_strip_bears_its_part_of_an_ellipsoid() {
        let sum: f64 = (0..1000).map(|n| 1.0 - (0.3 * (f64::from(n) + 0.5) / 1000.0).powi(2)).sum();
        assert!((part_of_point(0.3) - 0.3 * sum / 1000.0 / (2.0 / 3.0)).abs() < 1e-6);
        assert_eq!((part_of_point(0.0), part_of_point(1.0), part_of_point(2.0)), (0.0, 1.0, 1.0));
    }

    #[test]
    fn invariant_a_narrow_pit_is_shallow_and_a_wide_one_is_itself() {
        assert_eq!(depth_um("None", 200.0), 100.0);
        assert_eq!(depth_um("Some(5.0)", 200.0), 100.0);
        let depths = [0.05, 0.1, 0.2, 0.4].map(|mm| depth_um(&format!("{mm:?}"), 200.0));
        assert!(depths.windows(2).all(|pair| pair[0] < pair[1]) && depths[3] < 3.0, "{depths:?}");
        // A larger load widens the contact, and presses it deeper.
        assert!(depth_um("0.1", 2000.0) > depth_um("0.1", 200.0));
    }
}
