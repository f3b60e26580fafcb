//! Whether the load keeps rollers rolling.

use std::f64::consts::PI;

use stribeck_scene::deviation::{FormScene, RollingSurface, SpallScene};
use stribeck_scene::kinematics::Kinematics;
use stribeck_scene::resolved::{ResolvedScene, pocket_half_width};
use stribeck_scene::scene::PocketWalls;
use stribeck_scene::static_load::RigidRings;

use crate::kinematics::KinematicsFinding;
use crate::prediction::StaticCurve;
use crate::words::significant;

/// Loaded rollers or a cage that are slower than rolling by more than this slide; at full load they lose some
/// tenths of a per cent.
const SLIDING: f64 = 0.02;

/// The support [N] under which one passage of the load zone just spins a roller up from rest, where `curve`
/// is the distribution under `support_n` (THEORY §5.4): under less, rollers that have lost their spin do not
/// roll again. `None` when nothing turns or nothing is loaded, infinite without friction.
pub fn least_support_n(scene: &ResolvedScene, curve: &StaticCurve, support_n: f64) -> Option<f64> {
    let motion = Kinematics::at_mean_speed(&scene.written);
    let radius = scene.roller_radius;
    let inertia = 0.5 * PI * scene.material.density * scene.thickness * radius.powi(4);
    let pairs = curve.angle_deg.windows(2).zip(curve.force_n.windows(2));
    let over_angle: f64 = pairs.map(|(a, q)| 0.5 * (q[0] + q[1]) * (a[1] - a[0]).to_radians()).sum();
    let impulse = over_angle / motion.cage_rad_s.abs();
    // Both contacts push a roller without spin the same way round.
    let share =
        2.0 * scene.written.contact.friction * radius * impulse / (inertia * motion.roller_rad_s.abs());
    (share.is_finite() && over_angle > 0.0).then(|| support_n / share)
}

/// A roller slower than this share of rolling has lost its spin.
const STOPPED: f64 = 0.5;

/// The friction that slowly turns a roller over the edge of a `spall` under `force_n` [-], contact as stiff
/// as the bodies (THEORY §5.4). Where there is less, and its own spin does not carry it over, it slides on
/// the spall.
pub fn friction_over_edge(scene: &ResolvedScene, spall: &SpallScene, force_n: f64) -> f64 {
    let radius = scene.roller_radius;
    let lifted = RigidRings::new(scene).approach_m(force_n).min(1e-3 * spall.depth_mm);
    let half_angle = 0.5e-3 * spall.length_mm / radius;
    0.5 * (2.0 * lifted / radius).sqrt().min(half_angle)
}

/// Notes on spalls on rollers that the friction of a scene may not turn over their edges, when the fullest
/// roller carries `force_n`.
pub fn flats(scene: &ResolvedScene, force_n: f64) -> Vec<String> {
    let spalls = scene.written.defects.iter().filter_map(|defect| match (defect.on, &defect.form) {
        (RollingSurface::Roller(roller), FormScene::Spall(spall)) => Some((roller, spall)),
        _ => None,
    });
    let needed = spalls.map(|(roller, spall)| (roller, friction_over_edge(scene, spall, force_n)));
    let friction = scene.written.contact.friction;
    needed
        .filter(|(_, needed)| friction < *needed)
        .map(|(roller, needed)| {
            format!(
                "roller {roller} may stop on its spall: friction turns it over the edge under {:.1} kN from \
                 about {needed:.3} on, \
                 and `contact.friction` is {friction}. A roller that slides has no BSF; less load or a \
                 softer spall helps, too",
                1e-3 * force_n
            )
        })
        .collect()
}

/// Warnings of a load too small to keep rollers rolling, and of rollers that slid.
pub fn warnings(support_n: f64, least_n: Option<f64>, motion: &KinematicsFinding) -> Vec<String> {
    let mut said = Vec::new();
    if let Some(least_n) = least_n.filter(|least_n| support_n < *least_n) {
        let enough = if least_n.is_finite() {
            format!("{:.2} kN would", 1e-3 * least_n)
        } else {
            "no load would, without friction".into()
        };
        said.push(format!(
            "{:.2} kN do not keep the rollers rolling: one passage of the load zone does not spin a roller \
             up ({enough}), so events \
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
    let least_hz = STOPPED * motion.expected_roller_spin_hz;
    if let Some(others_hz) = motion.roller_spin_hz.filter(|hz| *hz > least_hz) {
        let stopped = motion.rollers.iter().filter(|roller| roller.spin_hz < least_hz);
        said.extend(stopped.map(|roller| {
            format!(
                "roller {} has lost its spin: {:.1} Hz in the mean where loaded rollers have {others_hz:.1} \
                 Hz. Friction does not turn it over \
                 what is missing from its surface, or it is not loaded; a defect on it strikes at no BSF",
                roller.roller, roller.spin_hz
            )
        }));
    }
    said
}

/// How far a cage may stray, in clearances of its pockets: pockets with corners let it go four or five times
/// as far.
const STRAYS: f64 = 10.0;

/// A note on a cage without radial guidance: `x` and `y` are the positions of its centre [m].
pub fn straying(scene: &ResolvedScene, x: &[f64], y: &[f64]) -> Option<String> {
    let room_um = scene.written.cage.as_ref()?.pocket_clearance_um;
    let (first_x, first_y) = (x.first()?, y.first()?);
    let far = x.iter().zip(y).map(|(x, y)| (x - first_x).hypot(y - first_y)).fold(0.0, f64::max);
    let far_um = 1e6 * far;
    (room_um > 0.0 && far_um > STRAYS * room_um).then(|| {
        format!(
            "the cage strays by {}, where its pockets leave {room_um:.0} µm: {}",
            if far_um < 1e4 {
                format!("{far_um:.0} µm")
            } else {
                format!("{} mm", significant(1e-3 * far_um, 3))
            },
            why_it_strays(scene)
        )
    })
}

/// Clearances and guidance of a cage.
fn why_it_strays(scene: &ResolvedScene) -> String {
    let corners = scene.cage.as_ref().filter(|cage| cage.pocket == PocketWalls::Corners);
    let Some(cage) = corners else {
        return "straight walls do not hold it across, and rollers bunch. `cage.pocket: corners`, on a cage \
            outside of the pitch circle, \
                holds it"
            .to_owned();
    };
    let [inner, outer] = cage.radii();
    let path = scene.path_radius();
    let wide = 2.0 * pocket_half_width(inner, outer, path, scene.roller_radius + cage.pocket_clearance);
    let (wide_mm, roller_mm) = (1e3 * wide, 2e3 * scene.roller_radius);
    if wide_mm < roller_mm {
        return format!(
            "the corners of its pockets, {wide_mm:.2} mm wide, hold rollers of {roller_mm:.2} mm from one \
             side only, and it has left them, so \
             that they bunch. A smaller `cage.pocket_clearance_um`, or a cage farther from the pitch circle \
             of {:.2} mm, holds it better",
            2e3 * path
        );
    }
    format!(
        "they are {wide_mm:.2} mm wide between their corners, and rollers of {roller_mm:.2} mm go through, \
         so that nothing holds it across, and \
         rollers bunch. A cage that lies farther outside of the pitch circle of {:.2} mm, by \
         `cage.outer_diameter_mm` and `cage.thickness_mm`, \
         holds it",
        2e3 * path
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::RollerMotion;
    use crate::prediction::Prediction;
    use stribeck_scene::deviation::DeviationScene;
    use stribeck_scene::run_info::MeshInfo;
    use stribeck_scene::scene::CageScene;
    use stribeck_scene::scene::Scene;

    /// By hand: a roller of 6 mm in radius whose raceways approach each other by δ = 16 µm takes ½ √(2 ·
    /// 16/6000) = 0.037 to turn over the edge of a deep spall, ½ √(2 · 5/6000) = 0.020 over one of 5 µm, and
    /// no more than a quarter of 0.3 mm over 6 mm, 0.0125, over a short one.
    #[test]
    fn example_friction_that_turns_a_roller_over_an_edge() {
        let scene = Scene::default();
        let geometry = ResolvedScene { roller_radius: 6e-3, ..scene.resolve() };
        let rings = RigidRings::new(&geometry);
        let (mut low, mut high): (f64, f64) = (0.0, 1e6);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if rings.approach_m(middle) < 16e-6 { low = middle } else { high = middle }
        }
        let needs = |length_mm: f64, depth_mm: f64| {
            friction_over_edge(&geometry, &SpallScene { length_mm, depth_mm, ..SpallScene::default() }, low)
        };
        for (found, by_hand) in
            [(needs(4.0, 0.25), 0.0365), (needs(4.0, 5e-3), 0.0204), (needs(0.3, 0.25), 0.0125)]
        {
            assert!((found - by_hand).abs() < 1e-4, "{found}, {by_hand}");
        }
        let spall = FormScene::Spall(SpallScene { length_mm: 4.0, depth_mm: 0.25, ..SpallScene::default() });
        let mut spalled = Scene {
            defects: vec![DeviationScene {
                on: RollingSurface::Roller(5),
                form: spall,
                ..DeviationScene::default()
            }],
            ..scene
        };
        spalled.contact.friction = 0.005;
        assert!(
            flats(&spalled.resolve(), 10e3)[0].contains("roller 5 may stop on its spall"),
            "{:?}",
            flats(&spalled.resolve(), 10e3)
        );
        spalled.contact.friction = 0.2;
        assert_eq!(flats(&spalled.resolve(), 10e3), [""; 0]);
    }

    #[test]
    fn example_a_roller_that_has_stopped_is_named() {
        let of = |roller: usize, spin_hz: f64| RollerMotion { roller, orbit_hz: 8.0, spin_hz, loaded: true };
        let motion = KinematicsFinding {
            expected_roller_spin_hz: 52.9,
            roller_spin_hz: Some(52.8),
            rollers: vec![of(4, 52.8), of(5, 3.1)],
            ..Default::default()
        };
        let said = warnings(8e3, None, &motion);
        assert!(said.len() == 1 && said[0].contains("roller 5 has lost its spin: 3.1 Hz"), "{said:?}");
    }

    #[test]
    fn example_a_cage_that_strays_is_named() {
        // Pockets of 100 µm.
        let scene = Scene::default();
        let path =
            |far: f64| straying(&scene.resolve(), &[1e-3, 1e-3 + 0.6 * far, 1e-3], &[0.0, 0.8 * far, 0.0]);
        assert!(path(0.9e-3).is_none());
        assert!(
            path(1.2e-3)
                .expect("twelve clearances")
                .contains("strays by 1200 µm, where its pockets leave 100 µm")
        );
        // Rollers of 18 mm on a pitch circle of 182 mm: corners on a diameter of 184 mm are 18.2 mm apart,
        // those on 188 mm 17.5 mm.
        for (inner_mm, words) in [(184.0, "go through"), (188.0, "from one side only")] {
            let cage = CageScene {
                pocket: PocketWalls::Corners,
                outer_diameter_mm: inner_mm + 8.0,
                thickness_mm: 4.0,
                ..CageScene::default()
            };
            let said =
                straying(&Scene { cage: Some(cage), ..scene.clone() }.resolve(), &[0.0, 0.9], &[0.0, 0.0]);
            assert!(
                said.as_ref().is_some_and(|said| said.contains(words) && said.contains("900 mm")),
                "{said:?}"
            );
        }
        assert!(
            straying(&Scene { cage: None, ..scene.clone() }.resolve(), &[0.0, 1.0], &[0.0, 0.0]).is_none()
        );
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
        let curve = Prediction::of(&scene.resolve(), &mesh).static_curve(&scene.resolve(), 50e3).unwrap();
        let least_n = least_support_n(&scene.resolve(), &curve, 50e3).unwrap();
        // The spin in space is 2π · 37.96 Hz = 238.5 rad/s, so I ω = 5.79e-4 N m s. A roller's passage adds
        // at most 2 · 0.005 · 9 mm times its load over time. All rollers carry 50 kN along y; by the cosine
        // the mean load of a place times the 24 rollers is 4/π · 50 kN or less, so in a turn of 266 ms a
        // roller has 600 to 710 N s, and 53 to 64 mN m s.
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
        assert_eq!(least_support_n(&smooth.resolve(), &curve, 50e3), Some(f64::INFINITY));
    }
}
