//! Stiffness and damping of contact by the formula that a scene names, as numbers of one law (THEORY §4.2).

use stribeck_theory::bearing::Bearing;
use stribeck_theory::line_contact::LineContacts;
use stribeck_theory::material::Material;
use stribeck_theory::static_load::RigidRings;

use crate::resolved::ResolvedScene;
use crate::scene::{ContactFormula, ContactPasses, Scene};

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ContactNumbers {
    /// Penalty stiffness of both passes together [Pa/m].
    pub(crate) stiffness: f64,
    /// Mass of the surface layer on either side [kg/m²] for which damping is critical at a ratio of 1.
    pub(crate) layer_mass: f64,
}

impl ContactNumbers {
    /// For squares of the scene's element size.
    pub(crate) fn of(scene: &Scene, material: &Material, size: f64) -> Self {
        let (c, scale) = (&scene.contact, scene.contact.penalty_scale);
        // Half an element deep: the mass of a surface's nodes.
        let layer = 0.5 * material.density * size;
        match c.formula {
            // [`as_hertz`] needs the resolved scene and comes last.
            ContactFormula::Hertz | ContactFormula::ElementLayer => {
                Self { stiffness: scale * material.youngs_modulus / size, layer_mass: layer }
            }
            ContactFormula::LsdynaStandard => {
                // k = f K A²/V over the area A of a segment, on each pass.
                let pass = scale * material.bulk_modulus() / size;
                let passes = match c.passes {
                    ContactPasses::Two => 2.0,
                    ContactPasses::One => 1.0,
                };
                // Critical damping 2 m √(2k/m) of a pass, where two layers on one spring have 2 √(km/2).
                Self { stiffness: passes * pass, layer_mass: 4.0 * passes * layer }
            }
            ContactFormula::LsdynaSegment => {
                // k = ½ f m₁m₂/(m₁ + m₂)/Δt², the masses those of half the elements behind the segments.
                let step = scene.solver.time_step_factor * size / material.dilatational_speed();
                Self { stiffness: 0.5 * scale * 0.5 * layer / (step * step), layer_mass: 4.0 * layer }
            }
        }
    }
}

/// Penalty stiffness [Pa/m] with which contacts give way as Hertz's do under `REFERENCE` times the force of the
/// most loaded roller, at the largest load of the run: the mesh gives way by the rest. At most `STIFFEST` layers of elements.
pub(crate) fn as_hertz(scene: &ResolvedScene) -> f64 {
    let [_, load_n] = scene.duty.load_range_n(scene.duration);
    let bearing = Bearing::from(scene);
    let static_load =
        RigidRings::new(bearing, scene.contact_law).distribute(load_n, &scene.written.angles_to_load_deg());
    let largest_n = static_load.map_or(load_n, |load| load.max_roller_n());
    let w = REFERENCE * largest_n / scene.thickness;
    let wanted = LineContacts::of(bearing).approach(w).0;
    let meshed = scene.meshed_contacts();
    let on_mesh =
        |side: usize, stiffness: f64| meshed.approach_on_mesh(side, w, scene.element_size, stiffness);
    let layer = scene.material.youngs_modulus / scene.element_size;
    let (mut soft, mut stiff) = (1e-4_f64, STIFFEST);
    for _ in 0..60 {
        let middle = (soft * stiff).sqrt();
        if on_mesh(0, middle * layer) + on_mesh(1, middle * layer) > wanted {
            soft = middle;
        } else {
            stiff = middle;
        }
    }
    soft * layer
}

/// The law of a penalty bends more than Hertz's: equal approaches under this multiple of the largest force make
/// the distribution over the rollers equal.
const REFERENCE: f64 = 1.5;

/// Stiffest penalty of the formula, in layers of elements.
const STIFFEST: f64 = 10.0;

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers(formula: ContactFormula, passes: ContactPasses) -> (ContactNumbers, Scene) {
        let mut scene = Scene::default();
        (scene.contact.formula, scene.contact.passes, scene.contact.penalty_scale) = (formula, passes, 0.1);
        let material = Material::from(&scene.material);
        (ContactNumbers::of(&scene, &material, 1e-3 * scene.mesh.size_mm), scene)
    }

    /// Source: Hallquist 2006, LS-DYNA Theory Manual, chapter on contact: standard penalty, segment-based
    /// penalty and contact damping.
    #[test]
    fn analytic_published_formulas_for_a_block_behind_a_segment() {
        // A segment of a by a on a cube of edge a: A²/V = a; its force over the penetration, over its area.
        const ROUNDING: f64 = 1e-14;
        let (e, nu, rho, a) = (200e9, 0.3, 7850.0, 0.5e-3);
        let (bulk, area, volume): (f64, f64, f64) = (e / (3.0 * (1.0 - 2.0 * nu)), a * a, a * a * a);
        let close = |ours: f64, theirs: f64| {
            assert!((ours / theirs - 1.0).abs() < ROUNDING, "{ours} instead of {theirs}");
        };
        for (passes, count) in [(ContactPasses::One, 1.0), (ContactPasses::Two, 2.0)] {
            let (found, _) = numbers(ContactFormula::LsdynaStandard, passes);
            let k = 0.1 * bulk * area * area / volume;
            close(found.stiffness, count * k / area);
            // ξ = 2 m ω with m the smaller mass and ω = √(k (m₁ + m₂)/(m₁ m₂)), for each pass; a node has
            // half a cube.
            let m = 0.5 * rho * volume;
            let critical = 2.0 * m * (k * 2.0 * m / (m * m)).sqrt();
            // The damping of `Law::with_damping` at a ratio of one.
            close(2.0 * (found.stiffness * 0.5 * found.layer_mass).sqrt(), count * critical / area);
        }
        let (found, scene) = numbers(ContactFormula::LsdynaSegment, ContactPasses::Two);
        let speed = (e * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu)) / rho).sqrt();
        let step: f64 = scene.solver.time_step_factor * a / speed;
        let m = 0.5 * rho * volume;
        let k = 0.5 * 0.1 * (m * m / (m + m)) / step.powi(2);
        close(found.stiffness, k / area);
        let critical = 2.0 * m * (k * 2.0 * m / (m * m)).sqrt();
        close(2.0 * (found.stiffness * 0.5 * found.layer_mass).sqrt(), critical / area);
        // In multiples of E/a.
        let (standard, _) = numbers(ContactFormula::LsdynaStandard, ContactPasses::One);
        let in_layers = [standard.stiffness, found.stiffness].map(|k| k * a / e);
        assert!(
            (in_layers[0] - 0.0833).abs() < 1e-4 && (in_layers[1] - 0.0175).abs() < 1e-4,
            "{in_layers:?}"
        );
    }
}
