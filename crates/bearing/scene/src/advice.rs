//! Advice on fields of a scene: for a run that went wrong only changes that the scene does not have yet, and before
//! a run on values that no solid has.

use crate::scene::{MOST_FRICTION, MaterialScene, PocketWalls, Scene};

/// What guides a cage that has left the bearing, as the object of "take".
pub fn holds_cage(scene: &Scene) -> String {
    let corners = scene.cage.as_ref().is_some_and(|cage| cage.pocket == PocketWalls::Corners);
    let pockets = if corners {
        "a smaller `cage.pocket_clearance_um`, or another `cage.outer_diameter_mm`, so that its pockets are \
         narrower than rollers"
    } else {
        "`cage.pocket: corners` with pockets narrower than rollers"
    };
    let friction = if scene.contact.friction < MOST_FRICTION { "more `contact.friction`, " } else { "" };
    format!("{pockets}, {friction}or `cage: None`")
}

/// Young's moduli [GPa] and densities [kg/m³] of solids of which bearings are made: from polymers to hard metal and
/// diamond, from light polymers to tungsten. Source: Ashby, Materials Selection in Mechanical Design (2011), app. A.
const MODULI_GPA: std::ops::RangeInclusive<f64> = 1.0..=1100.0;
const DENSITIES_KG_M3: std::ops::RangeInclusive<f64> = 500.0..=20_000.0;
/// Other units of density [kg/m³].
const DENSITY_UNITS: [(f64, &str); 5] =
    [(1e3, "g/cm³"), (1e9, "kg/mm³"), (1e12, "t/mm³"), (27_679.9, "lb/in³"), (16.0185, "lb/ft³")];

/// Values of the material that no solid of a bearing has, with the likely meaning.
pub fn doubts_of_material(scene: &Scene) -> Vec<String> {
    let MaterialScene { youngs_modulus_gpa, density_kg_m3, .. } = scene.material;
    // Of all usual units only one makes a solid of it, if any.
    let meant = |value: f64, solid: &std::ops::RangeInclusive<f64>, units: &[(f64, &str)]| {
        let unit = units.iter().find(|(factor, _)| solid.contains(&(value * factor)));
        let digits = |x: f64| format!("{x:.3e}").parse().unwrap_or(x);
        unit.map_or(String::new(), |(factor, unit)| {
            format!("; {value} {unit} are {}", digits(value * factor))
        })
    };
    let mut doubts = Vec::new();
    if !MODULI_GPA.contains(&youngs_modulus_gpa) {
        let meant = meant(youngs_modulus_gpa, &MODULI_GPA, &[(1e-3, "MPa"), (1e-9, "Pa"), (1e3, "TPa")]);
        doubts.push(format!(
            "`material.youngs_modulus_gpa` is {youngs_modulus_gpa}: no solid of bearings has {youngs_modulus_gpa} \
             GPa, steel has 200{meant}"
        ));
    }
    if !DENSITIES_KG_M3.contains(&density_kg_m3) {
        let meant = meant(density_kg_m3, &DENSITIES_KG_M3, &DENSITY_UNITS);
        doubts.push(format!(
            "`material.density_kg_m3` is {density_kg_m3}: no solid of bearings has {density_kg_m3} kg/m³, steel has \
             7850{meant}"
        ));
    }
    doubts
}

/// What to say of a housing whose vibration nothing damps but blows themselves, which only steps that are much shorter
/// would resolve.
pub fn undamped_housing(scene: &Scene) -> Option<String> {
    let rigid = scene.housing.mass(&scene.bearing)?;
    let damped = rigid.damping_per_s > 0.0 || scene.solver.mass_damping_per_s > 0.0 || scene.film.is_some();
    (scene.has_edges() && !damped).then(|| {
        "nothing damps the housing, which rings on from blow to blow: its level depends on start and time step, that of \
         5 kg on a 6205 under 200 N by half. Take `damping_per_s` of the housing, 1000 for 5 % at \
         1.6 kHz, `film` or `solver.mass_damping_per_s`"
            .to_owned()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A run that had friction at its limit and a cage with corners was advised to take both.
    #[test]
    fn issue_a_cage_that_left_is_not_advised_what_the_scene_has_already() {
        let told = holds_cage(&Scene::default());
        assert!(
            told.starts_with("`cage.pocket: corners`") && told.contains("more `contact.friction`, or"),
            "{told}"
        );
        let mut scene = Scene::default();
        scene.cage.as_mut().expect("the paper's").pocket = PocketWalls::Corners;
        scene.contact.friction = MOST_FRICTION;
        let told = holds_cage(&scene);
        assert!(!told.contains("corners") && !told.contains("friction"), "{told}");
        assert!(told.contains("pocket_clearance_um") && told.ends_with("or `cage: None`"), "{told}");
    }

    /// 200 N on 5 kg were 5.7 or 16.6 g by the step alone.
    #[test]
    fn issue_an_undamped_housing_is_warned_of() {
        let told = |set: &[&str]| {
            let set: Vec<&str> = ["bearing=NU 205", "film=None"].iter().chain(set).copied().collect();
            undamped_housing(&Scene::default().with_overrides(&set).expect("a scene"))
        };
        assert!(told(&["housing=rigid(mass_kg: 5)"]).is_some_and(|words| words.contains("damping_per_s")));
        for set in [
            &["housing=rigid(mass_kg: 5, damping_per_s: 1000)"][..],
            &["housing=rigid(mass_kg: 5)", "solver.mass_damping_per_s=5000"],
            &["housing=rigid(mass_kg: 5)", "defect=None"],
            &["housing=pedestal()"],
        ] {
            assert_eq!(told(set), None, "{set:?}");
        }
    }

    /// A density in g/cm³ and a modulus in TPa passed without a word.
    #[test]
    fn issue_values_that_no_solid_has_are_doubted() {
        let mut scene = Scene::default();
        assert_eq!(doubts_of_material(&scene), Vec::<String>::new());
        scene.material.density_kg_m3 = 7.85;
        scene.material.youngs_modulus_gpa = 0.21;
        let told = doubts_of_material(&scene).join("; ");
        assert!(told.contains("7.85 g/cm³ are 7850") && told.contains("0.21 TPa are 210"), "{told}");
        for (value, told) in
            [(7.85e-9, "t/mm³ are 7850"), (7.85e-6, "kg/mm³ are 7850"), (0.2836, "lb/in³ are 7850")]
        {
            scene.material.density_kg_m3 = value;
            let all = doubts_of_material(&scene).join("; ");
            assert!(all.contains(told), "{all}");
        }
        // Silicon nitride, and a polymer.
        (scene.material.density_kg_m3, scene.material.youngs_modulus_gpa) = (3200.0, 310.0);
        assert_eq!(doubts_of_material(&scene), Vec::<String>::new());
        (scene.material.density_kg_m3, scene.material.youngs_modulus_gpa) = (1400.0, 3.0);
        assert_eq!(doubts_of_material(&scene), Vec::<String>::new());
    }
}
