//! Whether the load keeps rollers rolling.

use std::f64::consts::PI;

use stribeck_scene::geometry::Geometry;
use stribeck_scene::kinematics::Kinematics;
use stribeck_scene::scene::Scene;

use crate::kinematics::KinematicsFinding;
use crate::prediction::StaticCurve;

/// Loaded rollers or a cage that are slower than rolling by more than this slide; at full load they lose some tenths of a
/// per cent.
const SLIDING: f64 = 0.02;

/// The support [N] under which one passage of the load zone just spins a roller up from rest, when `support_n` gives the
/// distribution `curve` (THEORY §5.4): under less, rollers that have lost their spin do not roll again. `None` when nothing
/// turns or nothing is loaded, infinite without friction.
pub fn least_support_n(scene: &Scene, curve: &StaticCurve, support_n: f64) -> Option<f64> {
    let (geometry, motion) = (Geometry::of(scene), Kinematics::at_mean_speed(scene));
    let radius = geometry.roller_radius;
    let inertia = 0.5 * PI * geometry.material.density * geometry.thickness * radius.powi(4);
    let pairs = curve.angle_deg.windows(2).zip(curve.force_n.windows(2));
    let over_angle: f64 = pairs.map(|(a, q)| 0.5 * (q[0] + q[1]) * (a[1] - a[0]).to_radians()).sum();
    let impulse = over_angle / motion.cage_rad_s.abs();
    // Both contacts push a roller without spin the same way round.
    let share = 2.0 * scene.contact.friction * radius * impulse / (inertia * motion.roller_rad_s.abs());
    (share.is_finite() && over_angle > 0.0).then(|| support_n / share)
}

/// What to say of a load that does not keep rollers rolling, or of rollers that were seen to slide.
pub fn warnings(support_n: f64, least_n: Option<f64>, motion: &KinematicsFinding) -> Vec<String> {
    let mut said = Vec::new();
    if let Some(least_n) = least_n.filter(|least_n| support_n < *least_n) {
        let enough = if least_n.is_finite() {
            format!("{:.2} kN would", 1e-3 * least_n)
        } else {
            "no load would, without friction".into()
        };
        said.push(format!(
            "{:.2} kN do not keep the rollers rolling: one passage of the load zone does not spin a roller up ({enough}), so events \
             come late and facet lines stand low",
            1e-3 * support_n
        ));
    }
    let slower = |measured: Option<f64>, expected: f64| {
        let lag = measured.filter(|_| expected > 0.0).map(|hz| 1.0 - hz / expected);
        lag.filter(|lag| *lag > SLIDING).map(|lag| 100.0 * lag)
    };
    for (what, percent) in [
        ("loaded rollers spin", slower(motion.roller_spin_hz, motion.expected_roller_spin_hz)),
        ("the cage turns", slower(motion.cage_on_outer_hz[0], motion.cage_on_outer_hz[1].unwrap_or(0.0))),
    ] {
        said.extend(percent.map(|p| format!("{what} {p:.1} % slower than rolling: they slide")));
    }
    said
}

/// How far a cage may stray, in clearances of its pockets: pockets with corners let it go four or five times as far.
const STRAYS: f64 = 10.0;

/// What to say of a cage that nothing holds across: `x` and `y` are where its centre was [m].
pub fn straying(scene: &Scene, x: &[f64], y: &[f64]) -> Option<String> {
    let room_um = scene.cage.as_ref()?.pocket_clearance_um;
    let (first_x, first_y) = (x.first()?, y.first()?);
    let far = x.iter().zip(y).map(|(x, y)| (x - first_x).hypot(y - first_y)).fold(0.0, f64::max);
    let far_um = 1e6 * far;
    (room_um > 0.0 && far_um > STRAYS * room_um).then(|| {
        format!(
            "the cage strays by {far_um:.0} µm, where its pockets leave {room_um:.0} µm: straight walls do not hold it across, and rollers bunch. \
             `cage.pocket: corners`, on a cage outside of the pitch circle, holds it"
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::prediction::Prediction;
    use stribeck_scene::run_info::MeshInfo;

    #[test]
    fn example_a_cage_that_strays_is_named() {
        // Pockets of 100 µm.
        let scene = Scene::default();
        let path = |far: f64| straying(&scene, &[1e-3, 1e-3 + 0.6 * far, 1e-3], &[0.0, 0.8 * far, 0.0]);
        assert!(path(0.9e-3).is_none());
        assert!(
            path(1.2e-3)
                .expect("twelve clearances")
                .contains("strays by 1200 µm, where its pockets leave 100 µm")
        );
        assert!(straying(&Scene { cage: None, ..scene.clone() }, &[0.0, 1.0], &[0.0, 0.0]).is_none());
    }

    /// The paper's bearing by hand: 0.3 N m s² … I = ½ m r² with m = 7850 · π · 9² · 30 mm³ = 59.9 g.
    #[test]
    fn example_the_paper_s_load_spins_rollers_up_many_times_over() {
        let scene = Scene::default();
        let mesh = MeshInfo {
            nodes: 0,
            quads: 0,
            triangles: 0,
            roller_facets: 112,
            outer_facets: 1257,
            inner_facets: 1030,
        };
        let curve = Prediction::of(&scene, &mesh).static_curve(&scene, 50e3).unwrap();
        let least_n = least_support_n(&scene, &curve, 50e3).unwrap();
        // The spin in space is 2π · 37.96 Hz = 238.5 rad/s, so I ω = 5.79e-4 N m s. A roller's passage gives at most 2 · 0.005 ·
        // 9 mm times its load over time. All rollers carry 50 kN along y; by the cosine the mean load of a place times the
        // 24 rollers is 4/π · 50 kN or less, so a turn of 266 ms gives a roller 600 to 710 N s, and 53 to 64 mN m s.
        assert!((430.0..560.0).contains(&least_n), "{least_n}");
        let rolling = KinematicsFinding {
            expected_roller_spin_hz: 41.7,
            roller_spin_hz: Some(41.6),
            ..Default::default()
        };
        assert_eq!(warnings(50e3, Some(least_n), &rolling), [""; 0]);
        let sliding = KinematicsFinding { roller_spin_hz: Some(30.0), ..rolling };
        let said = warnings(100.0, Some(least_n), &sliding);
        assert!(said[0].contains("0.10 kN do not keep") && said[1].contains("28.1 % slower"), "{said:?}");
        let smooth = Scene {
            contact: stribeck_scene::scene::ContactScene { friction: 0.0, ..scene.contact },
            ..scene
        };
        assert_eq!(least_support_n(&smooth, &curve, 50e3), Some(f64::INFINITY));
    }
}
