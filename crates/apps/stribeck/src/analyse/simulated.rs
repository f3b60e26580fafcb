//! How far a bearing presses an element together over a spall, by simulating a scene of it: three lengths at
//! either end of the load and of the clearance (THEORY §7.9).

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use stribeck_analysis::findings::Findings;
use stribeck_analysis::record::Record;
use stribeck_analysis::summary::Event;
use stribeck_diagnosis::{Analysis, Defect, Pressed, usual_load_n};
use stribeck_scene::catalogue;
use stribeck_scene::scene::{ModelScene, Scene};
use stribeck_store::run_dir::{Keep, Run};
use stribeck_theory::catalogue::CatalogueBearing;

use super::reading::{Reading, examine};
use crate::interrupt::Interrupt;
use crate::many_runs::{ManyRuns, Share};
use crate::out::tell;
use crate::place::{Place, shown};

/// Passages that are simulated, of which the first ones settle.
const PASSAGES: f64 = 30.0;
/// Turns of the shaft at least: a spall of the inner raceway comes under the load once a turn.
const TURNS: f64 = 12.0;
/// Passages in which an element comes free that tell something, of one scene or of all together.
const LEAST: usize = 3;
/// Shortest spall that is simulated [mm].
const SHORTEST_MM: f64 = 0.5;
/// Dimensions of the scene’s bearing are those of the record’s within this part.
const SAME: f64 = 0.01;

/// A scene of the bearing in its housing, to be simulated with spalls.
pub(super) struct Simulation {
    pub(super) scene: PathBuf,
    pub(super) interrupt: Interrupt,
}

impl Simulation {
    /// The analysis again with the simulated free path; unchanged if no spall length depends on it.
    pub(super) fn again(
        &self,
        analysis: Analysis,
        file: &Path,
        options: &Reading,
        out: &Path,
        place: &Place,
    ) -> Result<Analysis> {
        let Some(length) = analysis.findings.spall_mm else {
            tell!("note: nothing is simulated: the record tells no length of a spall");
            return Ok(analysis);
        };
        let lengths_mm = [length.low, length.value, length.high];
        let scenes = scenes(&analysis, &self.scene, options, lengths_mm)?;
        let pressed = simulate(&scenes, out, &self.interrupt)?;
        examine(file, &Reading { pressed: Some(pressed), ..options.clone() }, place)
    }
}

/// The scenes: every length at the least load and the widest clearance, and at the largest load and the
/// narrowest clearance.
fn scenes(analysis: &Analysis, file: &Path, options: &Reading, lengths_mm: [f64; 3]) -> Result<Vec<Scene>> {
    let findings = &analysis.findings;
    let claimed = findings.families.iter().find(|family| family.claimed).context("no defect is claimed")?;
    let ring = if claimed.name == Defect::Bpfi { "inner" } else { "outer" };
    let rpm = findings.speed_rpm.context("the speed of the shaft is not known")?;
    let hz = claimed.measured_hz.unwrap_or(claimed.expected_hz);
    let named = options.bearing.as_deref().context("name the bearing with `--bearing`")?;
    let known = catalogue::parse(named).map_err(anyhow::Error::msg)?;
    let (least, most) = options.load_n.unwrap_or_else(|| usual_load_n(&known));
    let duration_ms = 1e3 * (PASSAGES / hz).max(TURNS * 60.0 / rpm);
    let mut scenes: Vec<Scene> = Vec::new();
    for (load_n, loose) in [(least, true), (most, false)] {
        for length_mm in lengths_mm.map(|mm| mm.max(SHORTEST_MM)) {
            let set = [
                format!("defect.ring={ring}"),
                format!("defect.length_mm={length_mm:.3}"),
                format!("operation.load_n={load_n:.3}"),
                format!("operation.speed_rpm={rpm:.3}"),
                format!("solver.duration_ms={duration_ms:.1}"),
            ];
            let mut scene = Scene::read_with(file, &set)
                .with_context(|| format!("`{}` with a spall of this record", file.display()))?;
            if let Some((tight_um, loose_um)) = options.clearance_um {
                let um = if loose { loose_um } else { tight_um };
                scene.bearing.clearance_change_um = um - scene.bearing.clearance_um();
            }
            if scenes.iter().all(|other| other.hash() != scene.hash()) {
                scenes.push(scene);
            }
        }
    }
    scenes.iter().try_for_each(|scene| fits(scene, &known, named, file))?;
    Ok(scenes)
}

/// Whether a scene is of this bearing and takes seconds.
fn fits(scene: &Scene, known: &CatalogueBearing, named: &str, file: &Path) -> Result<()> {
    let of_scene = catalogue::of_scene(scene);
    let same = |a: f64, b: f64| (a / b - 1.0).abs() <= SAME;
    ensure!(
        known.elements.is_none_or(|n| of_scene.elements == Some(n))
            && same(of_scene.diameter_mm, known.diameter_mm)
            && same(of_scene.pitch_mm, known.pitch_mm),
        "`{}` is a scene of {of_scene}, and the record is of {named}: `stribeck new` writes a scene of it",
        file.display()
    );
    ensure!(
        matches!(scene.model, ModelScene::Reduced(_)),
        "`{}` is simulated by the full model, in hours: set `model: reduced()` in it",
        file.display()
    );
    Ok(())
}

/// Runs the scenes, and takes from their forces how far the element is pressed together.
fn simulate(scenes: &[Scene], out: &Path, interrupt: &Interrupt) -> Result<Pressed> {
    let runs = ManyRuns(out.join("simulated"));
    let share = Share { jobs: None, threads: None, memory_gb: None };
    runs.make_all(Keep::All, scenes.iter(), (share, interrupt), &|_, jobs| {
        tell!("{} spalls are simulated, {}: {}", scenes.len(), jobs.shown(), shown(&runs.0));
    })?;
    let mut passages = Vec::new();
    for scene in scenes {
        let folder = runs.run(scene);
        let run = Run::read(&folder).with_context(|| format!("no run of it in `{}`", shown(&folder)))?;
        let summary = Findings::of(&Record::whole(&run)?)?.summary;
        let length_mm = scene.defect.as_ref().map_or(0.0, |defect| defect.length_mm);
        passages.push(summary.events.iter().filter_map(|event| of(event, length_mm)).collect());
    }
    pressed(passages).context(
        "no element comes free over a spall of this length in the simulated scene: its rings press it \
         together all the way, and the record’s two events are not its edges, or its load is smaller \
         (`--load-n`)",
    )
}

/// From the passages of each scene: the medians of scenes with enough of them; where no scene has, the
/// passages of all.
fn pressed(mut passages: Vec<Vec<f64>>) -> Option<Pressed> {
    passages.iter_mut().for_each(|each| each.sort_by(f64::total_cmp));
    let enough = passages.iter().filter(|each| each.len() >= LEAST);
    let mut pressed: Vec<f64> = enough.map(|each| each[each.len() / 2]).collect();
    if pressed.is_empty() {
        pressed = passages.concat();
        if pressed.len() < LEAST {
            return None;
        }
    }
    pressed.sort_by(f64::total_cmp);
    let [least_mm, most_mm] = [pressed[0], pressed[pressed.len() - 1]];
    Some(Pressed { expected_mm: pressed[pressed.len() / 2], least_mm, most_mm })
}

/// How much shorter than the spall the path is over which an element is free [mm].
fn of(event: &Event, length_mm: f64) -> Option<f64> {
    let free_ms = event.exit_ms? - event.entry_ms?;
    let over_ms = event.path_exit_ms? - event.path_entry_ms?;
    Some(length_mm * (1.0 - free_ms / over_ms)).filter(|mm| mm.is_finite() && *mm > 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use stribeck_testing::assert_refused;

    #[test]
    fn issue_few_passages_of_each_scene_tell_together() {
        let of = |passages: &[&[f64]]| {
            let pressed = pressed(passages.iter().map(|each| each.to_vec()).collect());
            pressed.map(|p| [p.least_mm, p.expected_mm, p.most_mm])
        };
        assert_eq!(of(&[&[0.4, 0.2, 0.3], &[0.9], &[0.1, 0.2, 0.2, 0.25]]), Some([0.2, 0.3, 0.3]));
        assert_eq!(of(&[&[0.29, 0.26], &[0.21], &[0.28]]), Some([0.21, 0.28, 0.29]));
        assert_eq!(of(&[&[0.3], &[], &[0.2]]), None);
        assert_eq!(of(&[]), None);
    }

    #[test]
    fn refuses_a_scene_of_another_bearing_or_of_the_full_model() {
        let scene = |text: &str| Scene::parse(text, "mine.ron").expect("a scene");
        let file = Path::new("mine.ron");
        let known = CatalogueBearing::parse("6205").expect("in the catalogue");
        let reduced = scene("(bearing: \"6205\", model: reduced(), housing: rigid(), film: None)");
        assert!(fits(&reduced, &known, "6205", file).is_ok());
        let other = scene("(bearing: \"NU 205\", model: reduced(), housing: rigid(), film: None)");
        let why = fits(&other, &known, "6205", file).unwrap_err().to_string();
        assert!(why.contains("mine.ron") && why.contains("6205"), "{why}");
        let full = scene("(bearing: \"6205\", film: None)");
        assert_refused(fits(&full, &known, "6205", file), "model: reduced()");
    }
}
