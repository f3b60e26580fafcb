//! Static loads of a bearing, and problems to expect in motion.

use stribeck_scene::{
    advice::holds_cage,
    resolved::ResolvedScene,
    scene::{ModelScene, PocketWalls},
};

use crate::Error;

/// Static load distribution between rigid rings, with approaches and pressures.
#[derive(Debug, Clone, PartialEq)]
pub struct Loads {
    /// Diametral clearance [m]; below zero, rollers are pressed between the raceways.
    pub clearance_m: f64,
    /// Largest force on a roller [N].
    pub largest_n: f64,
    /// Rollers that carry something.
    pub loaded: usize,
    /// Largest pressure under it by Hertz, at the outer and at the inner raceway [Pa]: of a ball's point contact,
    /// or of a line contact.
    pub pressure_pa: [f64; 2],
    /// Basic static load rating by ISO 76 [N].
    pub static_rating_n: f64,
    /// Largest load over the whole run [N].
    pub load_n: f64,
}

impl Loads {
    /// Of a scene at its start; its largest load is that of the whole run.
    ///
    /// # Errors
    /// [`Error::Run`] when the scene has no static load distribution.
    pub fn of(scene: &ResolvedScene) -> Result<Self, Error> {
        let shared = scene.static_load()?;
        let largest_n = shared.max_roller_n();
        let [_, most] = scene.duty.load_range_n(scene.duration);
        Ok(Self {
            clearance_m: scene.clearance,
            largest_n,
            loaded: shared.loaded_rollers(),
            pressure_pa: scene.pressure_pa(largest_n),
            static_rating_n: scene.written.static_rating_n(),
            load_n: most.max(scene.written.operation.load_n),
        })
    }

    /// Static safety s₀ = C₀/P₀ [-].
    pub fn static_safety(&self) -> f64 {
        self.static_rating_n / self.load_n
    }
}

/// A cage without guidance has fallen through its clearance after this many times a free fall over it.
const FALLS: f64 = 3.0;

/// Problems to expect, each with its reason and remedy.
pub(super) fn dangers(scene: &ResolvedScene, loads: &Loads) -> Vec<String> {
    scene.doubts().into_iter().chain(cage(scene)).chain(penetration(scene, loads)).collect()
}

/// How far the cage moves across before corners of its pockets stop it [m]; infinite where none does.
fn play(scene: &ResolvedScene) -> Option<f64> {
    let cage = scene.cage.as_ref()?;
    let [inner, outer] = cage.radii();
    let path = scene.path_radius();
    // A corner stops the cage where it lies above or below the middle of its roller: r c/y for a corner at
    // the height y, to first order of the clearance c.
    let height = (inner - path).max(path - outer);
    let held = cage.pocket == PocketWalls::Corners && height > 0.0;
    Some(if held { scene.roller_radius * cage.pocket_clearance / height } else { f64::INFINITY })
}

fn cage(scene: &ResolvedScene) -> Option<String> {
    let (play, cage) = (play(scene)?, scene.cage.as_ref()?);
    let [inner, outer] = cage.radii();
    let room = (scene.outer_race_radius - outer).min(inner - scene.inner_race_radius);
    if play <= room {
        return None;
    }
    let fall_s = (2.0 * room.max(0.0) / scene.gravity.max(f64::MIN_POSITIVE)).sqrt();
    // A cage held by pocket corners with a large clearance is as free until they touch.
    if scene.duration <= FALLS * fall_s {
        return None;
    }
    let holds = if play.is_finite() {
        format!("the corners of its pockets stop it after {:.2} mm", 1e3 * play)
    } else {
        "no corner of its pockets lies above or below the middle of a roller".to_owned()
    };
    Some(format!(
        "nothing holds the cage between the raceways, where it has {:.2} mm of room: {holds}, and in a free \
         fall it is through after {:.0} ms. In {:.0} ms it will stray, and may stop the run. Take {}; \
         without `cage.outer_diameter_mm` and `cage.thickness_mm` it gets the ones that hold it where the \
         bearing is named or one's own",
        1e3 * room,
        1e3 * fall_s,
        1e3 * scene.duration,
        holds_cage(&scene.written)
    ))
}

/// A contact so soft that it sinks in by as much as guards allow.
fn penetration(scene: &ResolvedScene, loads: &Loads) -> Option<String> {
    let w = loads.largest_n / scene.thickness;
    let radius = scene.inner_contact_radius();
    // A parabola of penetration on a bed of springs: w = ⁴⁄₃ k √(2R) δ^1.5.
    let depth = (0.75 * w / (scene.penalty_stiffness * (2.0 * radius).sqrt())).powf(2.0 / 3.0);
    let percent = 100.0 * depth / scene.element_size;
    let guards = &scene.written.guards;
    let ends = match percent {
        p if p > guards.penetration_stop_percent => "which stops the run",
        p if p > scene.soft_percent() => "which the run will warn of",
        _ => return None,
    };
    let model = if scene.written.model == ModelScene::Full { "full" } else { "reduced" };
    Some(format!(
        "under its largest force the penetration of a contact is some {percent:.0} % of an element's size, {ends} ({model} \
         model): take a larger `contact.penalty_scale`, or less `operation.load_n`"
    ))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use stribeck_scene::scene::Scene;

    fn of(text: &str) -> (Loads, Vec<String>) {
        let scene = Scene::parse(text, "here").unwrap_or_else(|why| panic!("{why}")).resolve();
        let loads = Loads::of(&scene).expect("a load distribution");
        let dangers = dangers(&scene, &loads);
        (loads, dangers)
    }

    /// Johnson, Contact Mechanics (1985), §4.2(c): p₀ = √(w E*/(π R)), E* = E/(2(1 − ν²)) of like bodies.
    #[test]
    fn analytic_pressure_and_safety_of_the_papers_bearing() {
        let (loads, dangers) = of("()");
        let w: f64 = loads.largest_n / 30e-3;
        let expected = (w * 200e9 / (2.0 * 0.91) / (PI * 8.110e-3)).sqrt();
        assert!((loads.pressure_pa[1] / expected - 1.0).abs() < 1e-3, "{loads:?}");
        assert!((loads.clearance_m - 40e-6).abs() < 1e-9);
        // 44 (1 − 18/181.98) 24 · 30 · 18 = 513.8 kN.
        assert!((loads.static_safety() - 10.28).abs() < 0.02, "{}", loads.static_safety());
        assert!(dangers.is_empty(), "{dangers:?}");
    }

    /// Spalls that no run shows, and 1000 samples a second, were planned and simulated without a word.
    #[test]
    fn issue_what_a_run_will_not_show_is_said_beforehand() {
        for (text, said) in [
            ("defect: (angle_deg: 270)", "outside of the load zone"),
            (
                "defect: (angle_deg: 270), operation: (rotating_load: (force_n: 6000))",
                "outside of the load zone",
            ),
            ("defect: (length_mm: 60)", "stand 26.2 mm apart"),
            ("output: (interval_us: 1000), film: None", "1000 samples a second"),
        ] {
            let (_, dangers) = of(&format!("({text})"));
            assert!(dangers.len() == 1 && dangers[0].contains(said), "{text}: {dangers:?}");
        }
        // At the edge of the load zone, the load turned to the spall, and one that turns and is the larger.
        for text in [
            "defect: (angle_deg: 40)",
            "defect: (angle_deg: 270), operation: (load_angle_deg: 90)",
            "defect: (angle_deg: 270), operation: (rotating_load: (force_n: 60000))",
        ] {
            let (_, dangers) = of(&format!("(model: reduced(), housing: rigid(), film: None, {text})"));
            assert!(dangers.is_empty(), "{text}: {dangers:?}");
        }
    }

    /// An NU 2210 by fields, with the cage that a message had proposed for it, diverged after 377 ms; a plan
    /// saw nothing.
    #[test]
    fn issue_a_cage_that_will_stray_is_seen_beforehand() {
        let bearing = "rollers: 17, roller_diameter_mm: 11, pitch_mm: 70.5, bore_mm: 50, outside_mm: 90, \
                       width_mm: 23";
        let scene = |cage: &str| {
            of(&format!(
                "(bearing: ({bearing}), {cage} model: reduced(), film: None, solver: (duration_ms: 1000))"
            ))
        };
        let (_, dangers) = scene("cage: (outer_diameter_mm: 74.5, thickness_mm: 4, pocket: straight),");
        assert!(dangers.len() == 1 && dangers[0].contains("no corner"), "{dangers:?}");
        let (_, dangers) = scene("");
        assert!(dangers.is_empty(), "{dangers:?}");
    }

    #[test]
    fn behaves_loads_that_no_bearing_carries_are_warned_of() {
        let (loads, dangers) = of("(bearing: \"NU 205\", operation: (load_n: 60000))");
        assert!(loads.static_safety() < 1.0 && dangers[0].contains("ISO 76"), "{dangers:?}");
    }
}
