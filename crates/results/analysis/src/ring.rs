//! Bending modes of a free thin ring: where structural resonances are to be expected.
//!
//! Source: A. E. H. Love, *A Treatise on the Mathematical Theory of Elasticity*, §293, in plane strain. The
//! bearing's ring sits in its adapter and on its rollers, and is not thin: its own frequencies differ, so
//! these only suggest where to look.

use std::f64::consts::PI;

use stribeck_scene::resolved::ResolvedScene;

/// Frequency [Hz] of the in-plane bending mode with `n` waves around a free ring, n ≥ 2.
///
/// Mean radius and radial thickness in [m], Young's modulus in [Pa], density in [kg/m³].
pub fn bending_mode_hz(n: u32, radius: f64, thickness: f64, modulus: f64, poisson: f64, density: f64) -> f64 {
    let n = f64::from(n);
    // I/A of a rectangle is h²/12; a ring that is long out of the plane bends with E/(1 − ν²).
    let stiffness = modulus / (1.0 - poisson * poisson) * thickness * thickness / 12.0;
    n * (n * n - 1.0) / (2.0 * PI * radius * radius) * (stiffness / (density * (n * n + 1.0))).sqrt()
}

/// Modes n = 2 … `last` of the scene's outer ring, free of everything else [Hz]; empty for a rigid
/// ring.
pub fn outer_ring_modes(scene: &ResolvedScene, last: u32) -> Vec<(u32, f64)> {
    if scene.written.housing.is_rigid() {
        return Vec::new();
    }
    let (thickness, m) = (scene.outer_ring_thickness, &scene.material);
    let radius = scene.outer_race_radius + 0.5 * thickness;
    let mode = |n| (n, bending_mode_hz(n, radius, thickness, m.youngs_modulus, m.poissons_ratio, m.density));
    (2..=last).map(mode).collect()
}

/// Wavelength of bending waves in a bar as thick as the outer ring at `frequency_hz`, in elements: the
/// paper's "elements per wavelength". c_B = √(1.8 c_L h f) with the plate speed c_L.
pub fn elements_per_wavelength(scene: &ResolvedScene, frequency_hz: f64) -> f64 {
    let m = &scene.material;
    let plate = (m.youngs_modulus / (m.density * (1.0 - m.poissons_ratio.powi(2)))).sqrt();
    let bending = (1.8 * plate * scene.outer_ring_thickness * frequency_hz).sqrt();
    bending / frequency_hz / scene.element_size
}

#[cfg(test)]
mod tests {
    use stribeck_scene::housing::{HousingScene, RigidHousingScene};

    use super::*;
    use stribeck_scene::scene::Scene;

    #[test]
    fn analytic_modes_and_waves_of_the_paper_ring() {
        let scene = Scene::default();
        // Love's formula evaluated by hand for R = 105 mm, h = 10 mm, plane strain [Hz].
        for ((n, hz), expected) in
            outer_ring_modes(&scene.resolve(), 5).into_iter().zip([592.0, 1673.0, 3209.0, 5189.0])
        {
            assert!((hz / expected - 1.0).abs() < 1e-3, "n = {n}: {hz}");
        }
        let rigid = Scene { housing: HousingScene::Rigid(RigidHousingScene::default()), ..scene.clone() };
        assert_eq!(outer_ring_modes(&rigid.resolve(), 5), []);
        // The paper has 97.
        let waves = elements_per_wavelength(&scene.resolve(), 40_000.0);
        assert!((waves - 97.6).abs() < 0.1, "{waves}");
    }
}
