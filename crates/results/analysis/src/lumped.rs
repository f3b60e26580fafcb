//! Level of a facet tone by the simplest model: rigid rings on springs whose ends follow the polygons.
//!
//! A facet of length ℓ on a roller of radius r leaves a gap whose first harmonic is h₁ = ℓ²/(2π²r) high
//! (THEORY §5.2). A contact of half-width b averages over it; a pressure like √(1 − x²/b²) reduces it to
//!
//! ```text
//! g(u) = (2/π) ∫ √(1 − x²) cos(u x) dx  = 2 J₁(u)/u          u = 2πb/ℓ
//! ```
//!
//! Vertices meet the outer raceway with the phase N_v θ_j at the roller j and the inner one with N_v (θ_j +
//! π): in phase for an even count, in opposite phase for an odd one. Copies in one orientation have the phase
//! N_v θ_j; copies turned with the pattern all have the same. With equal springs under all loaded rollers the
//! outer ring follows
//!
//! ```text
//! y = |Σ sin θ_j g(u_j) (1 + e^{iπN_v}) e^{iN_vθ_j}| h₁ / Σ sin² θ_j          a = (2π f_v)² y
//! ```
//!
//! The ring's bending and mass are neglected: the result compares scenes and does not predict the level at a
//! sensor (own).

use std::f64::consts::{PI, TAU};

use stribeck_scene::resolved::ResolvedScene;
use stribeck_scene::scene::RollerCopies;
use stribeck_theory::Error;

use stribeck_diagnosis::STANDARD_GRAVITY;

/// Strips of the average over the contact.
const STRIPS: usize = 400;

/// Result for one scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lumped {
    /// Frequency of the roller vertices [Hz].
    pub frequency_hz: f64,
    /// First harmonic of the gap under one facet [m].
    pub height_m: f64,
    /// Reduction by the width of the most loaded contact, 0 to 1; negative past the first zero.
    pub smoothing: f64,
    /// Reduction by the phases of all loaded rollers, 0 to 1.
    pub phases: f64,
    /// 2 for an even count of facets, 0 for an odd one.
    pub both_contacts: f64,
    /// Coefficient of friction with which the most loaded roller is turned over its vertices by traction
    /// alone (THEORY §5.4).
    pub friction_to_roll: f64,
    /// Amplitude of the ring's acceleration [g].
    pub level_g: f64,
}

impl Lumped {
    /// Evaluates the model for a scene at its start.
    ///
    /// # Errors
    /// When the scene has no static load distribution.
    pub fn of(scene: &ResolvedScene) -> Result<Self, Error> {
        let load = scene.static_load()?;
        let facets = scene.written.mesh.roller_facets as f64;
        let radius = scene.roller_radius;
        let facet = TAU * radius / facets;
        let height_m = facet * facet / (2.0 * PI * PI * radius);
        let (mut re, mut im, mut springs, mut arms) = (0.0, 0.0, 0.0, 0.0);
        let mut smoothing = 1.0;
        let largest = load.max_roller_n();
        let angles = scene.written.roller_angles_deg();
        let in_place = scene.written.rollers_in_place().map(|number| angles[number - 1]);
        for (force, deg) in load.roller_n.iter().zip(in_place) {
            if *force <= 0.0 {
                continue;
            }
            let angle = deg.to_radians();
            let phase = match scene.written.mesh.roller_copies {
                RollerCopies::Translated => facets * angle,
                RollerCopies::Rotated => 0.0,
            };
            let kept = average(TAU * half_width(scene, *force) / facet);
            if *force == largest {
                smoothing = kept;
            }
            re += angle.sin() * kept * phase.cos();
            im += angle.sin() * kept * phase.sin();
            arms += (angle.sin() * kept).abs();
            springs += angle.sin().powi(2);
        }
        let both_contacts = 1.0 + (PI * facets).cos();
        let frequency_hz = facets * scene.written.mean_kinematics().roller_spin_hz;
        let y = re.hypot(im) * both_contacts * height_m / springs;
        Ok(Self {
            frequency_hz,
            height_m,
            smoothing,
            phases: if arms > 0.0 { re.hypot(im) / arms } else { 0.0 },
            both_contacts,
            friction_to_roll: both_contacts * smoothing.abs() / facets,
            level_g: (TAU * frequency_hz).powi(2) * y / STANDARD_GRAVITY,
        })
    }
}

/// Where the strongest line of the roller vertices stands [Hz] when rollers turn at `spin_hz` against a cage
/// of `cage_hz`.
///
/// Copies turned with the pattern all have the phase of N_v times the spin. For copies in one orientation the
/// tone is a sum over places that repeats whenever a roller takes the place of the next one: lines at the
/// vertices' rate relative to the housing plus multiples of BPFO, strongest where the rate along the load
/// zone is lowest (THEORY §5.5).
pub fn pattern_hz(scene: &ResolvedScene, spin_hz: f64, cage_hz: f64) -> f64 {
    let (facets, rollers) = (scene.written.mesh.roller_facets as f64, scene.written.bearing.rollers as f64);
    match scene.written.mesh.roller_copies {
        RollerCopies::Rotated => facets * spin_hz,
        RollerCopies::Translated => {
            facets * (spin_hz - cage_hz) + (facets / rollers).round() * rollers * cage_hz
        }
    }
}

/// Half-width of the outer contact [m]: that of Hertz and that of the penalty's own indentation, as squares.
fn half_width(scene: &ResolvedScene, force_n: f64) -> f64 {
    let radius = scene.outer_contact_radius();
    let line = force_n / scene.thickness;
    let hertz = 4.0 * line * radius / (PI * scene.material.contact_modulus());
    let indentation = (0.75 * line / (scene.penalty_stiffness * (2.0 * radius).sqrt())).powf(2.0 / 3.0);
    (hertz + 2.0 * radius * indentation).sqrt()
}

/// g(u): the mean of a cosine of phase `u` at the contact's end, weighted like a Hertz pressure.
fn average(u: f64) -> f64 {
    // x = sin t turns the root into a cosine.
    let step = PI / STRIPS as f64;
    let sum: f64 = (0..STRIPS)
        .map(|n| -0.5 * PI + (n as f64 + 0.5) * step)
        .map(|t| t.cos().powi(2) * (u * t.sin()).cos())
        .sum();
    2.0 / PI * sum * step
}

#[cfg(test)]
mod tests {
    use super::*;
    use stribeck_scene::scene::Scene;

    fn scene(facets: usize, copies: RollerCopies) -> Scene {
        let mut scene = Scene::default();
        scene.mesh.roller_facets = facets;
        scene.mesh.roller_copies = copies;
        // Narrow contacts: where they are wider than a facet, the factor g changes its sign from roller to
        // roller.
        scene.operation.load_n = 2000.0;
        scene.contact.penalty_scale = 1.0;
        scene
    }

    #[test]
    fn analytic_average_is_a_bessel_function() {
        // 2 J₁(u)/u from tables: J₁(1) = 0.440 050 6, J₁(3.831 706) = 0.
        assert!((average(1.0) - 2.0 * 0.440_050_6).abs() < 1e-6);
        assert!(average(3.831_706).abs() < 1e-6);
        assert!((average(0.0) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn analytic_few_facets_need_more_friction_than_the_paper_has() {
        // THEORY §5.4: two cosines of amplitude h₁ g under the load Q are climbed by a couple 2 N_v Q h₁ g,
        // against 2µQr.
        let of = |facets| {
            let mut scene = scene(facets, RollerCopies::Translated);
            scene.operation.load_n = 50_000.0;
            Lumped::of(&scene.resolve()).unwrap()
        };
        let (few, many) = (of(56), of(112));
        let couple = 2.0 * 56.0 * few.height_m * few.smoothing.abs();
        assert!((couple / (2.0 * few.friction_to_roll * 9e-3) - 1.0).abs() < 1e-9, "{few:?}");
        assert!((few.friction_to_roll - 0.021).abs() < 5e-4, "{few:?}");
        assert!(many.friction_to_roll < 0.002, "{many:?}");
        assert_eq!(of(113).friction_to_roll, 0.0);
    }

    #[test]
    fn by_hand_copies_in_one_orientation_move_the_line_by_a_part_of_bpfo() {
        // Rollers at 41.7 Hz against a cage of 3.75 Hz, BPFO 90 Hz. 112 facets are 4 2/3 a roller: a third of
        // BPFO is missing to five. 120 are five, and copies that turn with the pattern have no phase at all.
        let at =
            |facets, copies| pattern_hz(&scene(facets, copies).resolve(), 41.7, 3.75) - facets as f64 * 41.7;
        assert!((at(112, RollerCopies::Translated) - 30.0).abs() < 1e-9);
        assert!((at(56, RollerCopies::Translated) + 30.0).abs() < 1e-9);
        assert!(at(120, RollerCopies::Translated).abs() < 1e-9);
        assert!(at(112, RollerCopies::Rotated).abs() < 1e-9);
    }

    #[test]
    fn by_hand_phases_follow_copies_and_parity() {
        let of = |facets, copies| Lumped::of(&scene(facets, copies).resolve()).unwrap();
        // Copies in one orientation: 112 facets make three groups that partly cancel (under nine loaded
        // rollers not all of it), 120 = 5·24 are all in step.
        let (three, all) = (of(112, RollerCopies::Translated), of(120, RollerCopies::Translated));
        assert!(three.phases < 0.5, "{three:?}");
        assert!((all.phases - 1.0).abs() < 1e-9, "{all:?}");
        assert!((of(112, RollerCopies::Rotated).phases - 1.0).abs() < 1e-12);
        assert!(of(113, RollerCopies::Translated).level_g < 1e-9);
        // The height of one facet alone makes 2v²/r = 126 g, whatever the count.
        for facets in [56, 112, 224] {
            let one = of(facets, RollerCopies::Translated);
            let level = (TAU * one.frequency_hz).powi(2) * one.height_m / STANDARD_GRAVITY;
            assert!((level / 126.0 - 1.0).abs() < 0.01, "{level}");
        }
    }
}
