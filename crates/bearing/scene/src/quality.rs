//! Surfaces of a bearing by its tolerance class: waves of the raceways, and diameters of the rolling elements.
//!
//! No standard limits the waviness of a raceway. Waves of all orders from the oval on fall as 1/n, as those of
//! ground and honed surfaces do, and their root mean square is a fiftieth of the radial runout that ISO 492 allows
//! the class: of a 6205 a roundness of about 1 µm, and 0.05 µm in waves below 4 mm (own). Raceways of rollers, which
//! are less finely finished, have twice as much (own).

use stribeck_theory::catalogue::Element;

use crate::deviation::{DeviationScene, FormScene, RollingSurface, RoughnessScene};
use crate::scene::{BearingScene, Quality, Scene};

/// Radial runout of the inner ring of an assembled bearing, K_ia [µm], of the classes Normal, 6 and 5, up to a bore
/// [mm] (ISO 492, as catalogues of makers print it).
const RUNOUT_UM: [(f64, [f64; 3]); 9] = [
    (10.0, [10.0, 6.0, 4.0]),
    (18.0, [10.0, 7.0, 4.0]),
    (30.0, [13.0, 8.0, 4.0]),
    (50.0, [15.0, 10.0, 5.0]),
    (80.0, [20.0, 10.0, 5.0]),
    (120.0, [25.0, 13.0, 6.0]),
    (180.0, [30.0, 18.0, 8.0]),
    (250.0, [40.0, 20.0, 10.0]),
    (f64::INFINITY, [50.0, 25.0, 13.0]),
];
/// Root mean square of a raceway's waves over the runout.
const OF_RUNOUT: f64 = 0.02;
/// Elements of the mesh in the shortest wave.
const WAVE_ELEMENTS: f64 = 4.5;

impl Quality {
    /// Root mean square of the waves of a raceway [µm].
    fn raceway_um(self, bearing: &BearingScene, element: Element) -> f64 {
        let bore_mm = bearing.inner_race_diameter_mm - 2.0 * bearing.inner_ring_thickness_mm;
        let of_size = RUNOUT_UM.iter().find(|(most_mm, _)| bore_mm <= *most_mm);
        let runout_um = of_size.map_or(0.0, |(_, classes)| classes[self as usize]);
        runout_um * OF_RUNOUT * if element == Element::Ball { 1.0 } else { 2.0 }
    }

    /// Variation of the diameters within a set [µm]: balls of grade 10 or 5 (ISO 3290-1), rollers of grade 2 or 1
    /// (ISO 12297-1).
    fn elements_um(self, element: Element) -> f64 {
        match (element, self) {
            (Element::Ball, Self::Normal | Self::P6) => 0.5,
            (Element::Ball, Self::P5) => 0.25,
            (Element::Roller, Self::Normal | Self::P6) => 2.0,
            (Element::Roller, Self::P5) => 1.0,
        }
    }
}

impl Scene {
    /// What deviates from round: what the scene lists, and the waves of the raceways of its class.
    pub(crate) fn deviations(&self) -> Vec<DeviationScene> {
        let mut all = self.defects.clone();
        let Some(quality) = self.bearing.quality else { return all };
        let b = &self.bearing;
        let raceways = [
            (RollingSurface::Outer, b.outer_race_diameter_mm),
            (RollingSurface::Inner, b.inner_race_diameter_mm),
        ];
        for ((on, diameter_mm), number) in raceways.into_iter().zip(0..) {
            let waves = RoughnessScene {
                rq_um: quality.raceway_um(b, self.element()),
                // Between those of the orders 1 and 2.
                longest_mm: 0.75 * std::f64::consts::PI * diameter_mm,
                shortest_mm: WAVE_ELEMENTS * self.mesh.size_mm,
                seed: (2 * b.diameter_seed + number).wrapping_sub(1),
                ..RoughnessScene::default()
            };
            all.push(DeviationScene { on, form: FormScene::Roughness(waves), ..DeviationScene::default() });
        }
        all
    }

    /// Variation of the diameters of its rolling elements [µm]: what the scene gives, or that of its class.
    pub(crate) fn diameter_variation_um(&self) -> f64 {
        let given_um = self.bearing.diameter_variation_um;
        let of_class = self.bearing.quality.map_or(0.0, |quality| quality.elements_um(self.element()));
        if given_um > 0.0 { given_um } else { of_class }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene(bearing: &str) -> Scene {
        Scene::parse(&format!("(bearing: ({bearing}), defect: None, film: None, model: reduced())"), "q.ron")
            .expect("a scene")
    }

    /// Root mean square of the waves of a raceway [µm], and amplitude of the lowest order over the next.
    fn waves(bearing: &str) -> (f64, f64) {
        let relief = scene(bearing).resolve().outer_relief.expect("waves");
        let n = 20_000;
        let depth = |i: usize| 1e6 * relief.depth(std::f64::consts::TAU * i as f64 / n as f64);
        let of_order = |order: f64| {
            let (mut c, mut s) = (0.0, 0.0);
            for i in 0..n {
                let (sin, cos) = (order * std::f64::consts::TAU * i as f64 / n as f64).sin_cos();
                (c, s) = (c + depth(i) * cos, s + depth(i) * sin);
            }
            c.hypot(s)
        };
        let square: f64 = (0..n).map(|i| depth(i).powi(2)).sum::<f64>() / n as f64;
        assert!(of_order(1.0) < 1e-6 * of_order(2.0), "a raceway is centred");
        (square.sqrt(), of_order(2.0) / of_order(3.0))
    }

    /// Source: ISO 492 (2014) allows a bore of 25 mm 13, 8 and 4 µm of runout, one of 100 mm 25 µm.
    #[test]
    fn analytic_waves_follow_the_class_and_the_bore() {
        for (bearing, rq_um) in [
            ("designation: \"6205\", quality: normal", 0.26),
            ("designation: \"6205\", quality: p6", 0.16),
            ("designation: \"6205\", quality: p5", 0.08),
            ("designation: \"6320\", quality: normal", 0.5),
            ("designation: \"NU 205\", quality: normal", 0.52),
        ] {
            let (found_um, ratio) = waves(bearing);
            // Samples of sines whose orders divide no count of them.
            assert!((found_um / rq_um - 1.0).abs() < 1e-3, "{bearing}: {found_um} µm");
            assert!((ratio - 1.5).abs() < 1e-3, "{bearing}: {ratio}");
        }
    }

    #[test]
    fn behaves_the_scene_stands_before_the_class() {
        let um = |bearing: &str| scene(&format!("designation: \"6205\", {bearing}")).diameter_variation_um();
        assert_eq!([um("rollers: 9"), um("quality: normal"), um("quality: p5")], [0.0, 0.5, 0.25]);
        assert_eq!(um("quality: p5, diameter_variation_um: 3"), 3.0);
        let outer = |text: &str| scene(&format!("designation: \"6205\", {text}")).resolve().outer_relief;
        assert_ne!(outer("quality: p5"), outer("quality: p5, diameter_seed: 2"));
        assert!(outer("rollers: 9").is_none());
    }
}
