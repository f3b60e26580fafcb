//! How long a defect is, from the times at which a roller is unloaded and loaded again.
//!
//! Between the two the contact has run `v (t_exit − t_entry)`. That is too short: a roller pressed together by δ is not
//! free when its centre stands over the edge. It rolls over the edge and sinks, at the distance s behind it, by
//!
//! ```text
//! d(s) = s²/(2R)          1/R = 1/r − 1/r_race
//! ```
//!
//! and carries half of its load when d takes so much of the approach that half is left, d = δ(Q) − δ(Q/2). The same
//! happens in front of the other edge, so the estimate is
//!
//! ```text
//! L = v (t_exit − t_entry) + 2 √(2R (δ(Q) − δ(Q/2)))
//! ```
//!
//! with δ of two line contacts (THEORY §6.2) and of the two penalty springs in series with them.

use std::f64::consts::PI;

use stribeck_bearing::scene::Scene;
use stribeck_bearing::static_load::RigidRings;

/// What the estimate needs of a bearing.
#[derive(Debug, Clone, Copy)]
pub struct Edge {
    rings: RigidRings,
    /// Effective radius at the outer raceway [m].
    radius: f64,
    /// Softness of the two penalty springs: approach [m] = this · √(line load [N/m]).
    penalty: f64,
    /// Out-of-plane thickness [m].
    thickness: f64,
}

impl Edge {
    /// From a scene.
    pub fn of(scene: &Scene) -> Self {
        let (b, m) = (&scene.bearing, &scene.material);
        let (r, race) = (0.5e-3 * b.roller_diameter_mm, 0.5e-3 * b.outer_race_diameter_mm);
        let radius = 1.0 / (1.0 / r - 1.0 / race);
        let stiffness =
            scene.contact.penalty_scale * 1e9 * m.youngs_modulus_gpa / (1e-3 * scene.mesh.size_mm);
        let modulus = 1e9 * m.youngs_modulus_gpa / (2.0 * (1.0 - m.poissons_ratio.powi(2)));
        // Largest Hertz pressure 2w/(πb) with b² = 4wR/(πE*), divided by the penalty stiffness; two contacts.
        let penalty = 2.0 * (2.0 / PI) * (PI * modulus / (4.0 * radius)).sqrt() / stiffness;
        Self { rings: RigidRings::new(b, m), radius, penalty, thickness: 1e-3 * b.thickness_mm }
    }

    /// Approach of the raceways [m] at a roller under `load_n`.
    fn approach(&self, load_n: f64) -> f64 {
        self.rings.approach_m(load_n) + self.penalty * (load_n / self.thickness).max(0.0).sqrt()
    }

    /// Distance [m] behind an edge at which a roller that carried `load_n` carries half of it.
    pub fn half_load_m(&self, load_n: f64) -> f64 {
        (2.0 * self.radius * (self.approach(load_n) - self.approach(0.5 * load_n)).max(0.0)).sqrt()
    }

    /// Distance [m] of its centre from an edge within which a roller cannot touch a floor `depth_m` below the raceway.
    pub fn floor_m(&self, depth_m: f64) -> f64 {
        (2.0 * self.radius * depth_m).sqrt()
    }

    /// Length of the defect [m]: `run_m` between the two picks, by a roller that carried `load_n`.
    pub fn length_m(&self, run_m: f64, load_n: f64) -> f64 {
        run_m + 2.0 * self.half_load_m(load_n)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_half_load_is_reached_where_geometry_says() {
        // δ(10.4 kN) − δ(5.2 kN) is a little less than half of the 26.5 µm approach; R = 9.890 mm.
        let edge = Edge::of(&Scene::default());
        let s = edge.half_load_m(10_400.0);
        let expected = (2.0f64 * 9.890e-3 * 13e-6).sqrt();
        assert!((s / expected - 1.0).abs() < 0.07, "{s} {expected}");
        assert!((edge.length_m(9e-3, 10_400.0) - 9e-3 - 2.0 * s).abs() < 1e-15);
        assert_eq!(edge.half_load_m(0.0), 0.0);
    }

    #[test]
    fn invariant_softer_contacts_unload_later() {
        let mut scene = Scene::default();
        let stiff = Edge::of(&scene).half_load_m(10_000.0);
        scene.contact.penalty_scale = 0.1;
        assert!(Edge::of(&scene).half_load_m(10_000.0) > stiff);
    }
}
