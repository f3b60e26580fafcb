//! `cargo xtask study machine`: a machine fitted on one record of a damaged bearing a rig, and the other records
//! of that rig beside those that it makes.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use serde::Deserialize;
use stribeck::machine_fit::{State, known_of, scene_of};
use stribeck_analysis::machine::Force;
use stribeck_analysis::machine::agreement::{MachineAgreement, Measured, beside};
use stribeck_analysis::machine::fit::{Known, fit};
use stribeck_formats::Recording;
use stribeck_scene::machine::MachineScene;
use stribeck_scene::scene::{BearingScene, DefectRing, Scene};
use stribeck_store::run_dir::Run;
use stribeck_store::run_info::Status;

use crate::host::Job;
use crate::rows::median;
use crate::{Host, Rows};

/// Flags of `study machine`.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// Folder of the records: `cwru`, `cwru-more`, `hit-sm`, `paderborn`, those that are there
    #[arg(value_name = "FOLDER")]
    folder: Option<PathBuf>,
    /// Overrides a field of all scenes, to try another model; may be repeated
    #[arg(long, value_name = "FIELD=VALUE")]
    set: Vec<String>,
}

/// The list of rigs.
#[derive(Debug, Deserialize)]
struct List {
    rigs: Vec<Rig>,
}

/// A machine with its records.
#[derive(Debug, Deserialize)]
struct Rig {
    name: String,
    /// Numbers of the program were chosen on it.
    built: bool,
    bearing: String,
    fitted: Vec<Entry>,
    predicted: Vec<Entry>,
}

/// File, channel, defect, length and width [mm], speed [1/min], load [N], sample rate [Hz].
#[derive(Debug, Clone, Deserialize)]
struct Entry(String, String, String, f64, f64, f64, f64, f64);

/// A record with the force of its simulated bearing.
struct Pair {
    name: String,
    samples: Vec<f64>,
    force: Force,
    bearing: BearingScene,
}

/// Lines of the goal: third octaves and level [dB], factor of the kurtosis, height [dB].
const OCTAVES_DB: f64 = 4.0;
const LEVEL_DB: f64 = 4.0;
const FACTOR: f64 = 2.0;
const HEIGHT_DB: f64 = 6.0;

pub(crate) fn measure(options: &Options, host: &Host, rows: &mut Rows) -> Result<()> {
    let folder = options.folder.as_ref().context("give the folder of the records")?;
    let path = crate::package().join("data/machine.ron");
    let text = std::fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
    let list: List = ron::from_str(&text).with_context(|| path.display().to_string())?;
    let mut any = false;
    for rig in list.rigs.iter().filter(|rig| folder.join(&rig.fitted[0].0).exists()) {
        host.say(&rig.name);
        any = true;
        of_rig(rig, folder, options, host, rows)?;
    }
    ensure!(
        any,
        "`{}` holds no record: give a folder with `cwru`, `hit-sm` or `paderborn` in it",
        folder.display()
    );
    Ok(())
}

fn of_rig(rig: &Rig, folder: &Path, options: &Options, host: &Host, rows: &mut Rows) -> Result<()> {
    let all: Vec<&Entry> = rig.fitted.iter().chain(&rig.predicted).collect();
    let pairs =
        host.each(&all, stribeck::host::cores(), |entry| pair(rig, entry, folder, &options.set, host))?;
    // A bearing whose run did not end is told, and left out.
    let (mut all_kept, mut kept) = (Vec::new(), Vec::new());
    for (entry, pair) in all.into_iter().zip(pairs) {
        match pair {
            Ok(pair) => {
                all_kept.push(entry);
                kept.push(pair);
            }
            Err(why) => host.say(&format!("{}: {why:#}", entry.0)),
        }
    }
    let (all, pairs) = (all_kept, kept);
    let is_fitted = |entry: &Entry| rig.fitted.iter().any(|fitted| fitted.0 == entry.0);
    ensure!(
        all.iter().filter(|entry| is_fitted(entry)).count() == rig.fitted.len(),
        "{}: a bearing on which the machine is fitted did not run",
        rig.name
    );
    let known: Vec<Known> = rig
        .fitted
        .iter()
        .zip(&pairs)
        .map(|(entry, pair)| Known {
            rate_hz: entry.7,
            measured: pair.samples.clone(),
            force: pair.force.clone(),
            is_sound: entry.state().spall.is_none(),
        })
        .collect();
    let machine = fit(&known)?;
    let judged: Vec<(&Entry, &Pair)> = all.into_iter().zip(&pairs).collect();
    let judged = host
        .each(&judged, stribeck::host::cores(), |(entry, pair)| beside_record(rig, entry, pair, &machine))?;
    let judged = judged.into_iter().collect::<Result<Vec<MachineAgreement>>>()?;
    for ((pair, a), fitted) in pairs.iter().zip(&judged).zip((0..).map(|n| n < rig.fitted.len())) {
        put(rows, &rig.name, &pair.name, fitted, a);
    }
    let (table, of) = (if rig.built { "built" } else { "quoted" }, &judged[rig.fitted.len()..]);
    summary(rows, table, &rig.name, of);
    Ok(())
}

impl Entry {
    fn state(&self) -> State {
        let ring = match self.2.as_str() {
            "outer" => Some(DefectRing::Outer),
            "inner" => Some(DefectRing::Inner),
            _ => None,
        };
        State {
            spall: ring.map(|ring| (ring, self.3)),
            width_mm: Some(self.4).filter(|mm| ring.is_some() && *mm > 0.0),
        }
    }
}

/// Reads a record and simulates its bearing.
fn pair(rig: &Rig, entry: &Entry, folder: &Path, set: &[String], host: &Host) -> Result<Pair> {
    let Entry(file, channel, _, _, _, rpm, load_n, rate_hz) = entry;
    let path = folder.join(file);
    let recording = Recording::open(&path)?;
    let chosen = if channel.is_empty() {
        recording.channels.iter().max_by_key(|c| c.len)
    } else {
        recording.channels.iter().find(|c| c.name.ends_with(channel.as_str()))
    };
    let samples = chosen.with_context(|| format!("{}: no such channel", path.display()))?.read()?;
    let duration_s = samples.len() as f64 / rate_hz;
    let scene = scene_of(&rig.bearing, (*load_n, *rpm), entry.state(), (*rate_hz, duration_s), set)?;
    let run = run(&scene, host)?;
    let name = Path::new(file).file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let force = Force::of_run(&run, MachineScene::default().direction_deg)?;
    Ok(Pair { name, samples, force, bearing: scene.bearing })
}

/// The run of a scene, in a folder by its hash.
fn run(scene: &Scene, host: &Host) -> Result<Run> {
    let folder = host.root().join("runs/study/machine").join(scene.hash());
    let is_done = |run: &Run| run.info.status == Status::Complete;
    if let Some(run) = Run::read(&folder).ok().filter(is_done) {
        return Ok(run);
    }
    let begun = folder.join("checkpoint").exists();
    host.run(&Job { scene, folder: &folder, begun, threads: Some(1), alone: false })?;
    let run = Run::read(&folder)?;
    let why = run.info.stop_reason.as_deref().unwrap_or("the run did not end");
    ensure!(is_done(&run), "{}: {why}", folder.display());
    Ok(run)
}

fn beside_record(rig: &Rig, entry: &Entry, pair: &Pair, machine: &MachineScene) -> Result<MachineAgreement> {
    let known = known_of(&rig.bearing, entry.5, entry.6)?;
    let measured =
        Measured { samples: &pair.samples, rate_hz: entry.7, known: &known, defect: entry.state().family() };
    Ok(beside(machine, &pair.bearing, &pair.force, measured)?)
}

fn put(rows: &mut Rows, rig: &str, name: &str, fitted: bool, a: &MachineAgreement) {
    let variant = format!("{name}{}", if fitted { ", fitted" } else { "" });
    rows.word(rig, &variant, "record", name);
    let values = [
        ("octaves", Some(a.octaves_db)),
        ("level", Some(a.level_db())),
        ("kurtosis simulated", Some(a.kurtosis[0])),
        ("kurtosis measured", Some(a.kurtosis[1])),
        ("height simulated", a.height_db[0]),
        ("height measured", a.height_db[1]),
        ("claimed simulated", Some(f64::from(u8::from(a.claimed[0])))),
        ("claimed measured", Some(f64::from(u8::from(a.claimed[1])))),
    ];
    rows.values(rig, &variant, values);
}

/// How many of the predicted records meet each line of the goal.
fn summary(rows: &mut Rows, table: &str, rig: &str, of: &[MachineAgreement]) {
    let share = |meets: &dyn Fn(&MachineAgreement) -> Option<bool>| {
        let met: Vec<bool> = of.iter().filter_map(meets).collect();
        (!met.is_empty()).then(|| met.iter().filter(|yes| **yes).count() as f64 / met.len() as f64)
    };
    let factor = |a: &MachineAgreement| (a.kurtosis[0] / a.kurtosis[1]).ln().abs().exp();
    let height = |a: &MachineAgreement| Some((a.height_db[0]? - a.height_db[1]?).abs());
    let middle = median;
    let values = [
        ("n", Some(of.len() as f64)),
        ("octaves", middle(of.iter().map(|a| a.octaves_db).collect())),
        ("octaves met", share(&|a| Some(a.octaves_db <= OCTAVES_DB))),
        ("level", middle(of.iter().map(|a| a.level_db().abs()).collect())),
        ("level met", share(&|a| Some(a.level_db().abs() <= LEVEL_DB))),
        ("kurtosis factor", middle(of.iter().map(factor).collect())),
        ("kurtosis met", share(&|a| Some(factor(a) <= FACTOR))),
        ("height", middle(of.iter().filter_map(height).collect())),
        ("height met", share(&|a| Some(height(a)? <= HEIGHT_DB))),
        ("claimed alike", share(&|a| Some(a.claimed[0] == a.claimed[1]))),
    ];
    rows.values(table, rig, values);
}
