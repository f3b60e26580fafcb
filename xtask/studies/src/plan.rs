//! The data of a study, `plans/STUDY.ron`: its scenes with their overrides, the numbers of its table, and
//! its pictures.

use anyhow::{Context, Result};
use serde::Deserialize;
use serde_json::Value;

use crate::figure::Drawing;
use crate::rows::Rows;
use crate::{Finished, Runner, Variant, package};

/// A study whose runs are scenes with overrides.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Plan {
    /// Scene of all groups that name none, below the root of the repository.
    #[serde(default)]
    pub(crate) scene: String,
    /// Overrides of every run.
    #[serde(default)]
    set: Vec<String>,
    /// Runs that share a table.
    pub(crate) groups: Vec<Group>,
    #[serde(default)]
    pub(crate) figures: Vec<Drawing>,
}

/// Runs that share a table and its columns.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Group {
    /// The table that they are in.
    pub(crate) table: String,
    /// Their scene; `{}` is the name of each variant.
    #[serde(default)]
    scene: Option<String>,
    /// Beginning of all names.
    #[serde(default)]
    prefix: String,
    #[serde(default)]
    set: Vec<String>,
    /// Name and own overrides of each; `set` of [`Plan`] and of the group come before them.
    pub(crate) variants: Vec<(String, Vec<String>)>,
    /// Columns: the heading with its unit, and where the number is found ([`number`]).
    #[serde(default)]
    columns: Vec<(String, String)>,
    /// The runs are starts of one variant, which has this name in the table; its numbers are mean, smallest
    /// and largest of theirs.
    #[serde(default)]
    starts_of: Option<String>,
}

/// A number that the summary of a run does not hold, and its name in a plan.
pub(crate) type Kernel = (&'static str, fn(&Finished) -> Option<f64>);

impl Plan {
    /// Reads the plan of a study.
    pub(crate) fn read(study: &str) -> Result<Self> {
        let path = package().join("plans").join(format!("{study}.ron"));
        let text =
            std::fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
        ron::from_str(&text).with_context(|| path.display().to_string())
    }

    pub(crate) fn variants(&self, group: &Group) -> Vec<Variant> {
        let variant = |(name, own): &(String, Vec<String>)| Variant {
            name: format!("{}{name}", group.prefix),
            scene: group.scene.as_ref().unwrap_or(&self.scene).replace("{}", name),
            set: self.set.iter().chain(&group.set).chain(own).cloned().collect(),
        };
        group.variants.iter().map(variant).collect()
    }

    /// A variant from several starts, 0.01° of the cage (10 µs) apart, to either side in turn, so that more
    /// starts keep those that there are.
    pub(crate) fn starts(of: &Variant, count: u16) -> Vec<Variant> {
        let start = |number: u16| {
            let hundredths = i32::from(number.div_ceil(2)) * if number.is_multiple_of(2) { 1 } else { -1 };
            let degrees = 94.0 + 0.01 * f64::from(hundredths);
            let variant = Variant { name: format!("{}-{number:03}", of.name), ..of.clone() };
            variant.with(format!("bearing.first_roller_deg={degrees:.3}"))
        };
        (0..count).map(start).collect()
    }

    /// Runs all groups and puts the numbers of their columns into `rows`; the runs of each group.
    pub(crate) fn run(
        &self,
        runner: &Runner<'_>,
        kernels: &[Kernel],
        rows: &mut Rows,
    ) -> Result<Vec<Vec<Finished>>> {
        let mut all = Vec::new();
        for group in &self.groups {
            let runs = runner.run(&self.variants(group))?;
            let mut columns = vec![Vec::new(); group.columns.len()];
            for run in &runs {
                let known = run.tree();
                for ((heading, place), column) in group.columns.iter().zip(&mut columns) {
                    let found = number(run, &known, kernels, place)?.filter(|v| v.is_finite());
                    column.extend(found);
                    if group.starts_of.is_none() {
                        rows.value(&group.table, &run.variant.name, heading, found);
                    }
                }
                if let Err(why) = &run.summary {
                    rows.word(&group.table, &run.variant.name, "no numbers", why);
                }
            }
            for (name, ((heading, _), values)) in group
                .starts_of
                .iter()
                .flat_map(|name| group.columns.iter().zip(&columns).map(move |c| (name, c)))
            {
                let mean = values.iter().sum::<f64>() / values.len() as f64;
                let ends = [f64::min, f64::max].map(|end| values.iter().copied().reduce(end));
                let all = [("mean", ends[0].map(|_| mean)), ("smallest", ends[0]), ("largest", ends[1])];
                all.into_iter().for_each(|(word, value)| {
                    rows.value(&group.table, name, &format!("{heading}, {word}"), value);
                });
            }
            all.push(runs);
        }
        Ok(all)
    }
}

/// A number of a run: `levels.impulse_g` of its summary, `info.time_step_s` of its `run.json`,
/// `scene.mesh.size_mm` of its scene, `=name` of a kernel; `1e9 * info.time_step_s` is in another unit.
fn number(run: &Finished, known: &Value, kernels: &[Kernel], place: &str) -> Result<Option<f64>> {
    let (factor, place) = match place.split_once(" * ") {
        Some((factor, place)) => (factor.parse::<f64>().context("a factor")?, place),
        None => (1.0, place),
    };
    let found = match place.strip_prefix('=') {
        Some(name) => {
            let kernel = kernels.iter().find(|(known, _)| *known == name);
            kernel.with_context(|| format!("no kernel is called `{name}`"))?.1(run)
        }
        None => {
            let root =
                if place.starts_with("info.") || place.starts_with("scene.") { "" } else { "/summary" };
            known.pointer(&format!("{root}/{}", place.replace('.', "/"))).and_then(Value::as_f64)
        }
    };
    Ok(found.map(|value| factor * value))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::runner::scene_name;
    use stribeck_scene::scene::Scene;

    /// A field that is misspelt here would come to light after hours.
    #[test]
    fn behaves_every_plan_has_scenes_with_fields_that_exist() {
        let mut scenes = 0;
        for entry in std::fs::read_dir(package().join("plans")).expect("plans") {
            let path = entry.expect("a plan").path();
            let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            // Scenes of this study are meant to be refused, too.
            if name == "stability" {
                continue;
            }
            let plan = Plan::read(&name).unwrap_or_else(|error| panic!("{error:#}"));
            for variant in plan.groups.iter().flat_map(|group| plan.variants(group)) {
                let scene = Scene::read_with(crate::root().join(&variant.scene), &variant.set);
                let scene = scene.unwrap_or_else(|error| panic!("{name}, {}: {error}", variant.name));
                // A run is read back from the scene that it keeps.
                let kept = Scene { name: scene_name(&variant.name), ..scene }.to_ron();
                Scene::parse(&kept, "kept")
                    .unwrap_or_else(|error| panic!("{name}, {}: {error}", variant.name));
                scenes += 1;
            }
        }
        assert!(scenes > 50, "{scenes} scenes");
    }
}
