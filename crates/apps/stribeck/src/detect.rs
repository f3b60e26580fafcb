//! `stribeck detect`: the smallest spall that the verdict finds in nine of ten records of a machine.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result, bail, ensure};
use stribeck_analysis::detection::{CAUTION, Detection, OfLength, VERSION, in_words, smallest};
use stribeck_analysis::machine::{CHANNEL, assumed};
use stribeck_analysis::statistic::Share as Found;
use stribeck_diagnosis::{Analysis, Defect, Machine};
use stribeck_formats::Recording;
use stribeck_report::write_detection;
use stribeck_scene::scene::{DefectRing, HousingScene, ModelScene, Scene};
use stribeck_scene::{catalogue, ensemble, machine::MachineScene};
use stribeck_store::run_dir::{Keep, RunDir, check_folder, write_atomic};
use stribeck_store::run_info::Status;

use crate::interrupt::Interrupt;
use crate::many_runs::{ManyRuns, Share};
use crate::out::{caution, say, tell};
use crate::place::{Place, shown};

/// Flags of `detect`.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// Scene of the bearing by the reduced model, with a spall on a raceway
    scene: PathBuf,
    /// A machine that `stribeck machine` wrote [default: that of the scene]
    #[arg(long, value_name = "FILE")]
    machine: Option<PathBuf>,
    /// Shortest and longest spall [mm]
    #[arg(long, value_name = "MM..MM", default_value = "0.3..5", value_parser = lengths)]
    lengths: (f64, f64),
    /// How many lengths, evenly over their logarithm
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u32).range(2..=100))]
    points: u32,
    /// Records of each length, and of the healthy bearing
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = clap::value_parser!(u32).range(5..=1000))]
    records: u32,
    /// Overrides a field of the scene, as `simulate` has it; may be repeated
    #[arg(long, value_name = "FIELD=VALUE")]
    set: Vec<String>,
    /// Seed of the starts and of the background: equal seeds find the same
    #[arg(long, default_value_t = 1)]
    seed: u32,
    /// Folder for detect.json, report.html and the runs [default: runs/NAME-detect]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    share: Share,
}

/// The numbers, in the folder of the answer.
const NUMBERS: &str = "detect.json";

fn lengths(text: &str) -> Result<(f64, f64), String> {
    let number = |text: &str| text.trim().parse::<f64>().ok().filter(|mm| mm.is_finite() && *mm > 0.0);
    let both = text.split_once("..").and_then(|(low, high)| Some((number(low)?, number(high)?)));
    both.filter(|(low, high)| low <= high)
        .ok_or_else(|| format!("`{text}` is no range of lengths in mm, such as 0.3..5"))
}

/// One record that is made.
struct Made {
    /// Length of its spall [mm]; `None` of a healthy bearing.
    length_mm: Option<f64>,
    scene: Scene,
}

pub(crate) fn run(options: &Options, place: &Place) -> Result<ExitCode> {
    let base = base(options, place)?;
    let defect = base.defect.as_ref().context(
        "the scene has no spall on a raceway, whose length is to be varied: `defect: (ring: outer)`",
    )?;
    let family = if defect.ring == DefectRing::Outer { Defect::Bpfo } else { Defect::Bpfi };
    let out = options.out.clone().unwrap_or_else(|| place.runs().join(format!("{}-detect", base.name)));
    check_folder(&out, &[NUMBERS, "runs"])?;
    let all = scenes(&base, options)?;
    if let Some(assumed) = assumed(&base) {
        tell!("note: {assumed}");
    }
    let runs = ManyRuns(out.clone());
    let interrupt = Interrupt::listen()?;
    let scenes = all.iter().map(|made| &made.scene);
    runs.make_all(Keep::Signals, scenes, (options.share, &interrupt), &|count, jobs| {
        tell!("{} records, {count} of them to be made, {}: {}", all.len(), jobs.shown(), shown(&out));
    })?;
    let known = known(&base);
    let mut found = Vec::new();
    let mut record_s = 0.0;
    let mut diverged = 0;
    for made in &all {
        let folder = runs.run(&made.scene);
        if RunDir::open(&folder)?.read_info()?.status != Status::Complete {
            diverged += 1;
            continue;
        }
        let (seen, long_s) = judge(&folder, &known, family)?;
        record_s = long_s;
        found.push((made.length_mm, seen));
    }
    if diverged > 0 {
        caution!(
            "{diverged} of {} runs diverged and are left out; a smaller `model.step_us` may help",
            all.len()
        );
    }
    let detection = conclude(&base, family, &found, record_s, options)?;
    write_atomic(&out.join(NUMBERS), (serde_json::to_string_pretty(&detection)? + "\n").as_bytes())?;
    write_detection(&out, &detection)?;
    say!("{}", in_words(&detection));
    say!("  {CAUTION}");
    if let Some(sound) = detection.sound {
        say!("  of the healthy bearing the same is claimed in {} of {} records", sound.count, sound.of);
    }
    for one in &detection.lengths {
        say!(
            "  {:5.2} mm: {:2} of {}, {:.0} to {:.0} % (95 %)",
            one.length_mm,
            one.found.count,
            one.found.of,
            100.0 * one.found.low,
            100.0 * one.found.high
        );
    }
    say!("page: {}", shown(&out.join("report.html")));
    Ok(ExitCode::SUCCESS)
}

/// The scene with its machine.
fn base(options: &Options, place: &Place) -> Result<Scene> {
    let mut scene = place.scene(Some(&options.scene), &options.set)?;
    if let Some(file) = &options.machine {
        scene.housing = HousingScene::Machine(MachineScene::read(&place.locate(file))?);
        scene.sample_for_machine();
    }
    if scene.housing.machine().is_none() {
        bail!(
            "the scene `{}` has no machine, whose sensor would record it: name one with `--machine FILE`, which \
             `{} machine` fits to records, or write `housing: machine()` for a usual one",
            scene.name,
            place.program
        );
    }
    ensure!(
        matches!(scene.model, ModelScene::Reduced(_)),
        "the scene `{}` is of the full model, which takes hours for so many records: set `model: reduced()`",
        scene.name
    );
    scene.output.frames = None;
    scene.validate()?;
    Ok(scene)
}

/// Starts of the healthy bearing, then of every length.
fn scenes(base: &Scene, options: &Options) -> Result<Vec<Made>> {
    let (shortest, longest) = options.lengths;
    let points = if shortest < longest { options.points } else { 1 };
    let last = f64::from((points - 1).max(1));
    let length = |n: u32| 1e-3 * (1e3 * shortest * (longest / shortest).powf(f64::from(n) / last)).round();
    let mut all = Vec::new();
    for length_mm in std::iter::once(None).chain((0..points).map(|n| Some(length(n)))) {
        let mut scene = base.clone();
        match (length_mm, &mut scene.defect) {
            (Some(mm), Some(defect)) => defect.length_mm = mm,
            _ => scene.defect = None,
        }
        scene.validate().with_context(|| {
            format!("a spall of {} mm; choose other `--lengths`", length_mm.unwrap_or(0.0))
        })?;
        for number in 1..=options.records as usize {
            let mut scene = ensemble::start(&scene, u64::from(options.seed), number);
            if let HousingScene::Machine(machine) = &mut scene.housing {
                machine.seed = (1000 * u64::from(options.seed) + number as u64) % 1_000_000_000;
            }
            all.push(Made { length_mm, scene });
        }
    }
    Ok(all)
}

/// What a monitoring system knows of the machine.
fn known(scene: &Scene) -> Machine {
    Machine {
        speed_rpm: Some((scene.operation.speed_rpm - scene.operation.outer_speed_rpm).abs()),
        bearing: Some(catalogue::of_scene(scene)),
        load_n: Some((scene.operation.load_n, scene.operation.load_n)),
        ..Machine::default()
    }
}

/// Whether the record of a run shows the family, and how long it is [s].
fn judge(folder: &Path, known: &Machine, family: Defect) -> Result<(bool, f64)> {
    let file = RunDir::open(folder)?.machine();
    let recording = Recording::open(&file)
        .with_context(|| format!("no record of the machine in `{}`: its run did not end", shown(folder)))?;
    let channel = recording.channel(CHANNEL)?.clone().in_unit(Some("m/s^2".to_owned()));
    let rate_hz = channel.rate_hz.context("the record has no rate")?;
    let findings = Analysis::of(&channel, rate_hz, known)?.findings;
    let seen = findings.families.iter().any(|f| f.name == family && f.claimed);
    Ok((seen, channel.len as f64 / rate_hz))
}

fn conclude(
    base: &Scene,
    family: Defect,
    found: &[(Option<f64>, bool)],
    record_s: f64,
    options: &Options,
) -> Result<Detection> {
    let share = |length_mm: Option<f64>| {
        let of: Vec<bool> = found.iter().filter(|(mm, _)| *mm == length_mm).map(|(_, seen)| *seen).collect();
        Found::of(of.iter().filter(|seen| **seen).count(), of.len())
    };
    let mut lengths: Vec<f64> = found.iter().filter_map(|(mm, _)| *mm).collect();
    lengths.dedup();
    let shares: Vec<(f64, Found)> = lengths.iter().filter_map(|mm| Some((*mm, share(Some(*mm))?))).collect();
    let counts: Vec<(f64, usize, usize)> = shares.iter().map(|(mm, s)| (*mm, s.count, s.of)).collect();
    let (curve, smallest) = smallest(&counts, u64::from(options.seed)).context("no length was tried")?;
    let sensor_hz = base.housing.machine().map_or(0.0, |machine| machine.sensor.rate_hz);
    Ok(Detection {
        version: VERSION,
        scene: base.name.clone(),
        family: family.name().to_owned(),
        of: format!(
            "sampled at {:.1} kHz, of a {} at {} rpm under {} N",
            1e-3 * sensor_hz,
            if base.bearing.designation.is_empty() { "bearing" } else { &base.bearing.designation },
            base.operation.speed_rpm,
            base.operation.load_n
        ),
        record_s,
        seed: u64::from(options.seed),
        lengths: shares
            .into_iter()
            .map(|(length_mm, found)| OfLength { length_mm, found, by_curve: curve.at(length_mm) })
            .collect(),
        sound: share(None),
        silent: base.housing.machine().is_some_and(MachineScene::is_silent),
        smallest,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refuses_ranges_that_are_none() {
        assert_eq!((lengths("0.3..5"), lengths("2..2")), (Ok((0.3, 5.0)), Ok((2.0, 2.0))));
        for text in ["5", "5..0.3", "0..1", "a..b", "-1..2"] {
            assert!(lengths(text).unwrap_err().contains("0.3..5"), "{text}");
        }
    }
}
