//! Ground truth of a run: its defects, in the words of data sets.

use stribeck_scene::deviation::{DeviationScene, FormScene, RollingSurface};
use stribeck_scene::scene::{ModelScene, Scene};

/// The defects of a scene. A fault strikes once a passage: a spall, a dent, a profile, a rolling element that
/// is missing. Waves, roughness and other diameters are deviations.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::campaign) struct Truth {
    /// Where the faults are, `healthy` where there is none.
    pub(in crate::campaign) location: String,
    /// The faults in words; `None` where there is none.
    pub(in crate::campaign) form: Option<String>,
    /// How many there are.
    pub(super) count: usize,
    /// The first of them that has a length, in the order of the scene.
    pub(super) first: Option<Extent>,
    /// The other deviations in words; `None` where there is none.
    pub(in crate::campaign) deviations: Option<String>,
}

/// How large a fault is, and where its middle is at the start.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Extent {
    pub(super) length_mm: f64,
    pub(super) depth_mm: f64,
    pub(super) angle_deg: f64,
}

impl Truth {
    pub(in crate::campaign) fn of(scene: &Scene) -> Self {
        let missing = scene.bearing.rollers - scene.rollers_in_place().count();
        let local: Vec<&DeviationScene> =
            scene.defects.iter().filter(|deviation| deviation.form.length_mm().is_some()).collect();
        // In their order: rollers come last, one beside the other.
        let mut locations: Vec<&str> = scene.faults().iter().map(location).collect();
        let mut forms: Vec<&str> = scene.defect.iter().map(|_| "spall").collect();
        forms.extend(local.iter().map(|deviation| form(&deviation.form)));
        if missing > 0 {
            locations.push("missing_rolling_element");
            forms.push("missing");
        }
        let others = scene.defects.iter().map(|deviation| &deviation.form);
        let others = others.filter(|form| form.length_mm().is_none() && **form != FormScene::Missing);
        let of_defect = scene.defect.as_ref().map(|defect| Extent {
            length_mm: defect.length_mm,
            depth_mm: defect.depth_mm,
            angle_deg: defect.angle_deg,
        });
        Self {
            location: joined(locations).unwrap_or_else(|| "healthy".to_owned()),
            form: joined(forms),
            count: usize::from(scene.defect.is_some()) + local.len() + missing,
            first: of_defect.or_else(|| local.first().and_then(|deviation| Extent::of(deviation))),
            deviations: joined(others.map(form).collect()),
        }
    }
}

impl Extent {
    fn of(deviation: &DeviationScene) -> Option<Self> {
        Some(Self {
            length_mm: deviation.form.length_mm()?,
            depth_mm: deviation.form.depth_mm(),
            angle_deg: deviation.angle_deg,
        })
    }
}

/// Which model runs.
pub(in crate::campaign) fn model(scene: &Scene) -> &'static str {
    match scene.model {
        ModelScene::Full => "full",
        ModelScene::Reduced(_) => "reduced",
    }
}

fn location(on: &RollingSurface) -> &'static str {
    match on {
        RollingSurface::Outer => "outer_race",
        RollingSurface::Inner => "inner_race",
        RollingSurface::Roller(_) => "rolling_element",
    }
}

/// The word of the scene.
fn form(form: &FormScene) -> &'static str {
    match form {
        FormScene::Spall(_) => "spall",
        FormScene::Dent(_) => "dent",
        FormScene::Profile(_) => "profile",
        FormScene::Waviness(_) => "waviness",
        FormScene::Roughness(_) => "roughness",
        FormScene::Diameter(_) => "diameter",
        FormScene::Missing => "missing",
    }
}

/// Each name once, in the order in which they come.
fn joined(names: Vec<&str>) -> Option<String> {
    let mut once: Vec<&str> = Vec::new();
    for name in names {
        if !once.contains(&name) {
            once.push(name);
        }
    }
    (!once.is_empty()).then(|| once.join("+"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn truth(set: &[&str]) -> Truth {
        Truth::of(&Scene::default().with_overrides(set).expect("a scene"))
    }

    #[test]
    fn behaves_several_defects_of_several_forms() {
        let found = truth(&[
            "film=None",
            "defect=None",
            "defects=[(on: roller(3), angle_deg: 20, form: dent(length_mm: 2.2, depth_mm: 0.04)), \
             (on: outer, form: waviness(order: 9)), (on: inner, form: spall(length_mm: 4.0)), (on: \
             roller(5), form: missing)]",
        ]);
        assert_eq!(found.location, "inner_race+rolling_element+missing_rolling_element");
        assert_eq!((found.form.as_deref(), found.count), (Some("dent+spall+missing"), 3));
        // The hollow and half as much of the rim on either side; the first one of the scene.
        assert_eq!(found.first, Some(Extent { length_mm: 4.4, depth_mm: 0.04, angle_deg: 20.0 }));
        assert_eq!(found.deviations.as_deref(), Some("waviness"));
    }

    #[test]
    fn behaves_a_sound_bearing_and_the_papers() {
        let sound = truth(&["defect=None"]);
        assert_eq!(
            (sound.location.as_str(), sound.form, sound.count, sound.first),
            ("healthy", None, 0, None)
        );
        let paper = truth(&["defect.length_mm=8", "defect.depth_mm=0.3", "defect.angle_deg=80"]);
        assert_eq!(
            (paper.location.as_str(), paper.form.as_deref(), paper.count),
            ("outer_race", Some("spall"), 1)
        );
        assert_eq!(paper.first, Some(Extent { length_mm: 8.0, depth_mm: 0.3, angle_deg: 80.0 }));
    }
}
