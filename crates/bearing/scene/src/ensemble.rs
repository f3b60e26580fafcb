//! Many starts of one scene: the values drawn for each.
//!
//! The initial position of rollers and cage is unknown, and rattling and impacts depend on it. So each start
//! draws it at random, from a seed and the start's number:
//!
//! | drawn | uniform over |
//! |---|---|
//! | angle of roller 1, and of all others with it | from the scene's angle to that after rolling by one facet of a roller |
//! | phase of the rollers' meshes | one facet of a roller |
//! | place of each roller in its pocket | the clearance of the pocket, to either side |
//!
//! A turn by more than a facet would mostly shift the record in time; within one, the same rollers cross the
//! defect in every start, none of them earlier than in the scene, and their events can be compared. All
//! rollers have one phase, so that the copies of their mesh keep the pattern of the scene. The drawn values
//! are in the scene of the start, which makes it a run like any other.

use crate::dice::Dice;
use crate::scene::Scene;

/// Angles are drawn in millionths of a degree, places in thousandths of a micrometre: short to read, and
/// finer than anything that a mesh resolves.
const DIGITS: [f64; 2] = [1e6, 1e3];

/// Longest name of a scene, as [`Scene::validate`] has it.
const MAX_NAME: usize = 64;

/// Name of the folder of start `number`.
pub fn folder_name(number: usize) -> String {
    format!("start-{number:03}")
}

/// Number of the start whose folder has this name.
pub fn number_of(name: &str) -> Option<usize> {
    let digits = name.strip_prefix("start-").filter(|digits| digits.len() >= 3)?;
    digits.parse().ok().filter(|&number| folder_name(number) == name)
}

/// The scene of start `number`, from 1: equal seeds and numbers draw the same.
pub fn start(scene: &Scene, seed: u64, number: usize) -> Scene {
    let mut dice = Dice::stream(seed, number as u64);
    let mut drawn = scene.clone();
    let angle = scene.bearing.first_roller_deg + facet_deg(scene) * dice.share();
    drawn.bearing.first_roller_deg = rounded(angle - if angle > 360.0 { 360.0 } else { 0.0 }, DIGITS[0]);
    drawn.mesh.roller_phase_deg = rounded(360.0 / scene.mesh.roller_facets as f64 * dice.share(), DIGITS[0]);
    if let Some(cage) = &mut drawn.cage {
        let clearance = cage.pocket_clearance_um;
        let place = |_| rounded(clearance * (2.0 * dice.share() - 1.0), DIGITS[1]);
        cage.roller_offsets_um = (0..scene.bearing.rollers).map(place).collect();
    }
    let suffix = format!("-{}", folder_name(number));
    let stem: String = scene.name.chars().take(MAX_NAME - suffix.len()).collect();
    drawn.name = stem + &suffix;
    drawn
}

/// Whether `other` is a start of `scene`: they differ in name and drawn values only.
pub fn is_start_of(other: &Scene, scene: &Scene) -> bool {
    let mut undrawn = other.clone();
    undrawn.name.clone_from(&scene.name);
    undrawn.bearing.first_roller_deg = scene.bearing.first_roller_deg;
    undrawn.mesh.roller_phase_deg = scene.mesh.roller_phase_deg;
    if let (Some(cage), Some(theirs)) = (&mut undrawn.cage, &scene.cage) {
        cage.roller_offsets_um.clone_from(&theirs.roller_offsets_um);
    }
    undrawn == *scene
}

/// Angle by which a roller advances on the outer raceway while it rolls by one of its facets [°].
fn facet_deg(scene: &Scene) -> f64 {
    let b = &scene.bearing;
    360.0 / scene.mesh.roller_facets as f64 * b.roller_diameter_mm / b.outer_race_diameter_mm
}

/// `value` cut to a multiple of one over `digits`, towards zero: a place stays within its clearance.
fn rounded(value: f64, digits: f64) -> f64 {
    (value * digits).trunc() / digits
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(seed: u64, number: usize) -> Scene {
        start(&Scene::default(), seed, number)
    }

    #[test]
    fn invariant_equal_seeds_draw_the_same_and_others_do_not() {
        assert_eq!(of(7, 3).to_ron(), of(7, 3).to_ron());
        let drawn: Vec<Scene> = [(7, 3), (7, 4), (8, 3), (3, 7)].map(|(seed, n)| of(seed, n)).to_vec();
        for (i, scene) in drawn.iter().enumerate() {
            let places = |s: &Scene| s.cage.as_ref().map(|c| c.roller_offsets_um.clone());
            assert!(
                drawn[..i]
                    .iter()
                    .all(|other| other.bearing.first_roller_deg != scene.bearing.first_roller_deg
                        && other.mesh.roller_phase_deg != scene.mesh.roller_phase_deg
                        && places(other) != places(scene))
            );
        }
    }

    #[test]
    fn roundtrip_a_start_is_a_scene_with_the_same_bits() {
        for number in 1..=20 {
            let drawn = of(1, number);
            let read = Scene::parse(&drawn.to_ron(), "start").expect("valid");
            assert_eq!(read, drawn);
            assert!(is_start_of(&read, &Scene::default()));
        }
        let other = Scene::default().with_overrides(&["operation.load_n=40000"]).expect("valid");
        assert!(!is_start_of(&of(1, 1), &other));
        assert_eq!(of(1, 12).name, "oiled_steel-start-012");
        let long = Scene { name: "x".repeat(MAX_NAME), ..Scene::default() };
        assert!(start(&long, 1, 1000).validate().is_ok());
        let turned = Scene::default().with_overrides(&["bearing.first_roller_deg=360"]).expect("valid");
        assert!((1..50).all(|number| start(&turned, 1, number).validate().is_ok()));
    }

    /// Draws are uniform over their ranges: mean and variance of a uniform distribution, (b − a)²/12, within
    /// four standard errors for the number of draws.
    #[test]
    fn invariant_draws_are_even_over_their_ranges() {
        const STARTS: usize = 2000;
        let scenes: Vec<Scene> = (1..=STARTS).map(|number| of(42, number)).collect();
        let evenly = |values: Vec<f64>, low: f64, high: f64| {
            let n = values.len() as f64;
            assert!(values.iter().all(|v| (low..=high).contains(v)));
            let mean = values.iter().sum::<f64>() / n;
            let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0);
            let width = high - low;
            let (deviation, of_variance) = (width / 12_f64.sqrt(), width.powi(2) / 12.0);
            assert!((mean - 0.5 * (low + high)).abs() < 4.0 * deviation / n.sqrt(), "{mean}");
            // The fourth moment of a uniform distribution gives its variance a relative error of √(0.8/n).
            assert!((variance / of_variance - 1.0).abs() < 4.0 * (0.8 / n).sqrt(), "{variance}");
        };
        let all = |of: fn(&Scene) -> f64| scenes.iter().map(of).collect::<Vec<f64>>();
        evenly(all(|s| s.bearing.first_roller_deg), 94.0, 94.0 + 360.0 / 112.0 * 18.0 / 200.0);
        evenly(all(|s| s.mesh.roller_phase_deg), 0.0, 360.0 / 112.0);
        evenly(all(|s| s.cage.as_ref().map_or(0.0, |c| c.roller_offsets_um[0])), -100.0, 100.0);
        evenly(all(|s| s.cage.as_ref().map_or(0.0, |c| c.roller_offsets_um[23])), -100.0, 100.0);
    }

    #[test]
    fn behaves_folders_of_starts_are_numbered() {
        assert_eq!((folder_name(7), folder_name(1000)), ("start-007".into(), "start-1000".into()));
        assert_eq!((number_of("start-007"), number_of("start-1000")), (Some(7), Some(1000)));
        for other in ["start-7", "start-0007", "start-+07", "start-abc", "figures"] {
            assert_eq!(number_of(other), None, "{other}");
        }
    }

    #[test]
    fn behaves_a_bearing_without_a_cage_draws_angle_and_phase() {
        let bare = Scene { cage: None, ..Scene::default() };
        let drawn = start(&bare, 1, 1);
        assert!(drawn.cage.is_none() && drawn.mesh.roller_phase_deg > 0.0 && is_start_of(&drawn, &bare));
    }
}
