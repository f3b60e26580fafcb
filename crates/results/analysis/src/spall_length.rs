//! Length of a defect, from the times at which a roller is unloaded and loaded again.
//!
//! Between the two the contact has travelled `v (t_exit − t_entry)`. That is too short: a roller with the
//! approach δ is not free when its centre is over the edge. The rings hold the sum of all approaches; with
//! the centre at the distance s behind the edge the contact with the spall's raceway is a strip that ends at
//! the edge,
//!
//! ```text
//! δ(Q) = e(q) + d_i(q) + d            d_i(q) = (3q / (4k √(2R_i)))^⅔ at the other raceway
//! q = k ∫ (d − x²/2R) dx              x from −√(2Rd) to −s
//! ```
//!
//! with the line load q = Q/t, the penalty stiffness k, e the elastic approach of both contacts (THEORY
//! §6.2), and R the effective radii. The event is taken at half of the load; that is at s½. The same holds in
//! front of the other edge, so the estimate is
//!
//! ```text
//! L = v (t_exit − t_entry) + 2 s½
//! ```
//!
//! The corner of the edge is taken as stiff as the raceway, which it is not quite (own).

use stribeck_scene::resolved::ResolvedScene;
use stribeck_scene::scene::DefectRing;
use stribeck_theory::static_load::RigidRings;

/// Halvings of the bracket: beyond rounding.
const HALVINGS: usize = 60;

/// Geometry and stiffness that the estimate needs.
#[derive(Debug, Clone, Copy)]
pub struct Edge {
    rings: RigidRings,
    /// Effective radii at the raceway with the spall and at the other one [m].
    radius: [f64; 2],
    /// Penalty stiffness [Pa/m].
    stiffness: f64,
    /// Out-of-plane thickness [m].
    thickness: f64,
}

impl Edge {
    /// Of a spall on the raceway of `ring`.
    pub fn of(scene: &ResolvedScene, ring: DefectRing) -> Self {
        let (outer, inner) = (scene.outer_contact_radius(), scene.inner_contact_radius());
        Self {
            rings: RigidRings::new(scene, scene.contact_law),
            radius: match ring {
                DefectRing::Outer => [outer, inner],
                DefectRing::Inner => [inner, outer],
            },
            stiffness: scene.penalty_stiffness,
            thickness: scene.thickness,
        }
    }

    /// Penetration [m] of a whole strip of effective radius `radius` under the line load `load` [N/m].
    fn penetration(&self, load: f64, radius: f64) -> f64 {
        (0.75 * load / (self.stiffness * (2.0 * radius).sqrt())).powf(2.0 / 3.0)
    }

    /// Line load [N/m] of a strip penetrated by `depth` that ends at the distance `cut` before its middle.
    fn cut_strip(&self, depth: f64, cut: f64) -> f64 {
        let half = (2.0 * self.radius[0] * depth).sqrt();
        if cut >= half {
            return 0.0;
        }
        self.stiffness * (depth * (half - cut) - (half.powi(3) - cut.powi(3)) / (6.0 * self.radius[0]))
    }

    /// Distance [m] of the roller's centre behind an edge at which a roller that carried `load_n` carries
    /// half of it.
    pub fn half_load_m(&self, load_n: f64) -> f64 {
        if load_n <= 0.0 {
            return 0.0;
        }
        let held = |load_n: f64| {
            let line = load_n / self.thickness;
            self.rings.approach_m(load_n) + self.penetration(line, self.radius[1])
        };
        let whole = held(load_n) + self.penetration(load_n / self.thickness, self.radius[0]);
        let depth = whole - held(0.5 * load_n);
        let wanted = 0.5 * load_n / self.thickness;
        let half = (2.0 * self.radius[0] * depth).sqrt();
        let (mut low, mut high) = (-half, half);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if self.cut_strip(depth, middle) > wanted { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    }

    /// Distance [m] of its centre from an edge within which a roller cannot touch a floor `depth_m` below the
    /// raceway.
    pub fn floor_m(&self, depth_m: f64) -> f64 {
        (2.0 * self.radius[0] * depth_m).sqrt()
    }

    /// Length of the defect [m]: `run_m` between the two picks, by a roller that carried `load_n`.
    pub fn length_m(&self, run_m: f64, load_n: f64) -> f64 {
        run_m + 2.0 * self.half_load_m(load_n)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use stribeck_scene::scene::Scene;

    #[test]
    fn analytic_a_stiff_contact_rolls_over_a_sharp_edge() {
        // Without penalty compliance the roller sinks by s²/2R, so half of its load remains at √(2R (δ(Q) −
        // δ(Q/2))).
        let mut scene = Scene::default();
        scene.bearing.thickness_mm = 20.0;
        scene.contact.penalty_scale = 1e4;
        let edge = Edge::of(&scene.resolve(), DefectRing::Outer);
        let sunk = edge.rings.approach_m(10_400.0) - edge.rings.approach_m(5_200.0);
        let expected = (2.0 * 9.890e-3 * sunk).sqrt();
        let s = edge.half_load_m(10_400.0);
        // Remainder of penetration and strip at 10⁴ E/h.
        assert!((s / expected - 1.0).abs() < 0.02, "{s} {expected}");
        assert!((edge.length_m(9e-3, 10_400.0) - 9e-3 - 2.0 * s).abs() < 1e-15);
        assert_eq!(edge.half_load_m(0.0), 0.0);
    }

    #[test]
    fn analytic_a_strip_cut_in_its_middle_carries_half() {
        let edge = Edge::of(&Scene::default().resolve(), DefectRing::Outer);
        let depth = edge.penetration(5e5, edge.radius[0]);
        let half = (2.0 * edge.radius[0] * depth).sqrt();
        assert!((edge.cut_strip(depth, -half) / 5e5 - 1.0).abs() < 1e-9);
        assert!((edge.cut_strip(depth, 0.0) / 2.5e5 - 1.0).abs() < 1e-9);
        assert_eq!(edge.cut_strip(depth, half), 0.0);
    }
}
