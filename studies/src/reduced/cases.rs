//! The scenes that run by both models.

use std::path::Path;

use anyhow::{Context, Result};
use stribeck_scene::scene::Scene;

/// A scene by both models.
pub(super) struct Case {
    /// Name of its folder.
    pub(super) name: &'static str,
    /// In words.
    pub(super) what: &'static str,
    pub(super) scene: &'static str,
    pub(super) set: &'static [&'static str],
    pub(super) starts: usize,
    /// Reduced models of it: in words, with overrides of the scene.
    pub(super) models: &'static [Model],
}

/// A name and overrides.
pub(super) type Model = (&'static str, &'static [&'static str]);

const AT_2_US: Model = ("2 µs", &["model.step_us=2"]);
const AT_5_US: Model = ("5 µs", &["model.step_us=5"]);

const SCENE: &str = "fixtures/scenes/reduced_30ms.ron";
const GRADED: &str = "mesh.grading=(coarse_mm: 2.0, fine_layers: 2)";

pub(super) const CASES: &[Case] = &[
    Case {
        name: "paper",
        what: "the paper\u{2019}s",
        scene: SCENE,
        set: &[GRADED],
        starts: 32,
        models: &[AT_2_US, AT_5_US],
    },
    Case {
        name: "load",
        what: "30 kN, 700 rpm",
        scene: SCENE,
        set: &["mesh.size_mm=1.0", "operation.load_n=30000", "operation.speed_rpm=700"],
        starts: 32,
        models: &[AT_2_US, AT_5_US],
    },
    Case {
        name: "rollers",
        what: "20 rollers",
        scene: SCENE,
        set: &[GRADED, "bearing.rollers=20"],
        starts: 32,
        models: &[AT_2_US, AT_5_US],
    },
    Case {
        name: "rigid",
        what: "20 rollers, rigid housing",
        scene: SCENE,
        set: &[GRADED, "bearing.rollers=20", "housing=rigid(mass_kg: 10)"],
        starts: 12,
        models: &[AT_2_US],
    },
    Case {
        name: "arcs",
        what: "contact on arcs",
        scene: SCENE,
        set: &[GRADED, "contact.surface=arc"],
        starts: 8,
        models: &[AT_2_US],
    },
    Case {
        name: "spall",
        what: "20 mm thick, spall of 6 × 0.1 mm",
        scene: SCENE,
        set: &[GRADED, "bearing.thickness_mm=20", "defect.length_mm=6", "defect.depth_mm=0.1"],
        starts: 8,
        models: &[AT_2_US],
    },
    Case {
        name: "inner",
        what: "spall on the inner raceway",
        scene: SCENE,
        set: &["mesh.size_mm=1.0", "defect.ring=inner", "solver.duration_ms=10"],
        starts: 8,
        models: &[AT_2_US],
    },
    Case {
        name: "oil",
        what: "oil, 2 % of structural damping",
        scene: "fixtures/scenes/oiled_steel.ron",
        set: &[GRADED, "model=reduced(modes_khz: 30.0)"],
        starts: 16,
        models: &[AT_2_US],
    },
    Case {
        name: "physical",
        what: "contacts as stiff as Hertz\u{2019}s, with oil",
        scene: "fixtures/scenes/physical.ron",
        set: &["solver.duration_ms=2.1"],
        starts: 2,
        models: &[("0.9 µs", &["model.step_us=2"])],
    },
    Case {
        name: "small",
        what: "NU 205, 1500 rpm",
        scene: "fixtures/scenes/atlas.ron",
        set: &[
            "bearing=NU 205",
            "mesh.size_mm=0.5",
            "mesh.roller_facets=112",
            "defects=[(on: outer, form: spall(length_mm: 2, depth_mm: 0.05))]",
            "solver.duration_ms=10",
        ],
        starts: 8,
        models: &[
            ("30 kHz", &["model.modes_khz=30", "model.step_us=0.5"]),
            ("60 kHz", &["model.modes_khz=60", "model.step_us=0.5"]),
        ],
    },
    Case {
        name: "paper-long",
        what: "the paper\u{2019}s, ten passages",
        scene: SCENE,
        set: &[GRADED, "solver.duration_ms=120"],
        starts: 12,
        models: &[AT_2_US],
    },
    Case {
        name: "load-long",
        what: "30 kN, 700 rpm, ten passages",
        scene: SCENE,
        set: &[
            "mesh.size_mm=1.0",
            "operation.load_n=30000",
            "operation.speed_rpm=700",
            "solver.duration_ms=85",
        ],
        starts: 12,
        models: &[AT_2_US],
    },
    Case {
        name: "rollers-long",
        what: "20 rollers, ten passages",
        scene: SCENE,
        set: &[GRADED, "bearing.rollers=20", "solver.duration_ms=140"],
        starts: 6,
        models: &[AT_2_US],
    },
];

impl Case {
    /// Its folder with one of the reduced models.
    pub(super) fn folder(&self, (words, _): &Model) -> String {
        format!("{}-{}", self.name, words.replace(' ', "").replace('µ', "u").replace('.', "_").to_lowercase())
    }

    /// Overrides of its scene.
    pub(super) fn set(&self, (_, own): &Model) -> Vec<String> {
        self.set.iter().chain(*own).map(|set| (*set).to_owned()).collect()
    }

    pub(super) fn scene(&self, root: &Path, model: &Model) -> Result<Scene> {
        let scene = Scene::read_with(root.join(self.scene), &self.set(model));
        scene.with_context(|| format!("case `{}` is not a scene", self.name))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A field that is misspelt here would come to light after hours.
    #[test]
    fn behaves_every_case_is_a_scene_of_both_models() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        for case in CASES {
            for model in case.models {
                let scene = case.scene(&root, model).expect("a scene");
                assert!(scene.with_overrides(&["model=full".to_owned()]).is_ok(), "{}", case.name);
            }
        }
    }
}
