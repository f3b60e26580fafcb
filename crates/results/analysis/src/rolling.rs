//! Whether the load keeps rollers rolling.

use std::f64::consts::PI;

use stribeck_scene::deviation::{FormScene, RollingSurface, SpallScene};
use stribeck_scene::resolved::{ResolvedScene, pocket_half_width};
use stribeck_scene::scene::PocketWalls;
use stribeck_theory::contact_law::ContactLawKind;
use stribeck_theory::static_load::RigidRings;

use crate::kinematics::KinematicsFinding;
use crate::prediction::StaticCurve;
use stribeck_diagnosis::words::numbers::significant;

/// Loaded rollers or a cage that are slower than rolling by more than this slide; at full load they lose some
/// tenths of a per cent.
const SLIDING: f64 = 0.02;

/// The support [N] under which one passage of the load zone just spins a roller up from rest, where `curve`
/// is the distribution under `support_n` (THEORY §5.4): under less, rollers that have lost their spin do not
/// roll again. `None` when nothing turns or nothing is loaded, infinite without friction.
pub fn least_support_n(scene: &ResolvedScene, curve: &StaticCurve, support_n: f64) -> Option<f64> {
    let motion = scene.written.mean_kinematics();
    let radius = scene.roller_radius;
    let length = scene.thickness * scene.element_share();
    let shape = if scene.contact_law == ContactLawKind::Ball { 0.4 } else { 0.5 };
    let inertia = shape * PI * scene.material.density * length * radius.powi(4);
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
    let lifted = RigidRings::new(scene, scene.contact_law).approach_m(force_n).min(1e-3 * spall.depth_mm);
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
                 about {needed:.3} on, and `contact.friction` is {friction}. A roller that slides has no \
                 BSF; less load or a softer spall helps, too",
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
             up ({enough}), so events come late and facet lines stand low",
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
                 Hz. Friction does not turn it over what is missing from its surface, or it is not loaded; a \
                 defect on it strikes at no BSF",
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
            outside of the pitch circle, holds it"
            .to_owned();
    };
    let [inner, outer] = cage.radii();
    let path = scene.path_radius();
    let wide = 2.0 * pocket_half_width(inner, outer, path, scene.roller_radius + cage.pocket_clearance);
    let (wide_mm, roller_mm) = (1e3 * wide, 2e3 * scene.roller_radius);
    if wide_mm < roller_mm {
        return format!(
            "the corners of its pockets, {wide_mm:.2} mm wide, hold rollers of {roller_mm:.2} mm from one \
             side only, and it has left them, so that they bunch. A smaller `cage.pocket_clearance_um`, or a \
             cage farther from the pitch circle of {:.2} mm, holds it better",
            2e3 * path
        );
    }
    format!(
        "they are {wide_mm:.2} mm wide between their corners, and rollers of {roller_mm:.2} mm go through, \
         so that nothing holds it across, and rollers bunch. A cage that lies farther outside of the pitch \
         circle of {:.2} mm, by `cage.outer_diameter_mm` and `cage.thickness_mm`, holds it",
        2e3 * path
    )
}
