//! The cause of a measured record: inference of a spall from the signature of its passages, which does not
//! depend on the path, and from its level where the machine is known.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};
use stribeck_analysis::load::support;
use stribeck_analysis::machine;
use stribeck_analysis::record::Record;
use stribeck_analysis::records::{PassageSignature, duration_s, normal, rhythm};
use stribeck_diagnosis::{Analysis, Defect, Family, usual_load_n};
use stribeck_dsp::{Rhythm, Signature, Sound, at_rate, coloured_like, statistics};
use stribeck_formats::wav::{Whole, pcm};
use stribeck_formats::{Channel, uff58};
use stribeck_plans::inference::{Inference, Values};
use stribeck_scene::catalogue;
use stribeck_scene::dice::Dice;
use stribeck_scene::machine::MachineScene;
use stribeck_scene::scene::{DefectRing, HousingScene, RecordsScene, Scene};
use stribeck_store::run_dir::{Keep, Run, check_folder, write_atomic};
use stribeck_theory::catalogue::CatalogueBearing;

use super::answer::Known;
use super::rounds::{Point, Rounds};
use super::{FILE, Options};
use crate::analyse::{Reading, examine, in_m_s2};
use crate::compare;
use crate::interrupt::Interrupt;
use crate::machine_fit::{State, scene_of};
use crate::many_runs::ManyRuns;
use crate::place::{Place, shown};

/// Scene on which the unknowns are set.
const BASE: &str = "scene.ron";
/// Noise over the rest of the record [dB].
const NOISE_DB: [f64; 6] = [-30.0, -20.0, -10.0, -5.0, 0.0, 5.0];
/// Lengths [mm] from this on, up to [`LONGEST`] of the distance of two elements.
const SHORTEST_MM: f64 = 0.3;
const LONGEST: f64 = 0.45;
/// Depths [mm]: a pit that an element bridges, to one whose floor it never touches.
const DEPTH_MM: (f64, f64) = (0.01, 0.3);
/// Slopes of the edges [°].
const SLOPE_DEG: (f64, f64) = (25.0, 90.0);
/// Default clearance [µm].
const CLEARANCE_UM: (f64, f64) = (0.0, 20.0);
/// The record that is made for comparison [s].
const SYNTHETIC_S: f64 = 2.0;
/// Standard deviation of the time between two events from that by force: a tenth and less for simulated
/// spalls from 3 mm on; entries of 2 mm are found late by up to a fifth of it (docs/results/spalls.md).
const FREE_TOLERANCE: f64 = 0.1;
/// Standard deviation of a record's level from that of its machine, over it: the median of 11 to 17 records is 4 dB
/// (docs/results/machine.md), that of a normal deviate of 6 dB.
const LEVEL_TOLERANCE: f64 = 0.7;
/// Samples a second of sounds [Hz].
const PLAYED_HZ: u32 = 48_000;

/// A record and the inference that was made of it.
pub(super) struct Measured {
    /// File of the inference, in its folder.
    pub(super) file: PathBuf,
    analysis: Analysis,
    rhythm: Rhythm,
    /// Unit of its samples [m/s²]; 1 where its level is not compared.
    in_m_s2: f64,
}

/// Properties of a damaged raceway.
struct Claim<'a> {
    ring: DefectRing,
    family: &'a Family,
    passing_hz: f64,
}

/// What a record tells of its passages.
struct Told {
    signature: PassageSignature,
    /// Time between its two events, where it shows two [ms].
    free_ms: Option<f64>,
    /// Root mean square [m/s²], where the machine is known.
    level_m_s2: Option<f64>,
}

/// Analyses a record and writes the inference that it asks for into `out`.
pub(super) fn prepare(record: &Path, options: &Options, out: &Path, place: &Place) -> Result<Measured> {
    let reading = &options.reading;
    let analysis = examine(record, reading, place)?;
    let bearing = reading.bearing.as_deref().context(
        "a record is inferred by simulating its bearing: name it with `--bearing`, for example 6205",
    )?;
    let known = catalogue::parse(bearing).map_err(anyhow::Error::msg)?;
    let machine =
        options.machine.as_deref().map(|file| MachineScene::read(&place.locate(file))).transpose()?;
    let findings = &analysis.findings;
    let in_m_s2 = match machine {
        Some(_) => in_m_s2(findings.unit.as_deref(), record)?,
        None => 1.0,
    };
    let rpm = findings.speed_rpm.context("give the speed of the shaft with `--speed-rpm`")?;
    let claim = claim(&analysis)?;
    let cage_hz = family(&analysis, Defect::Ftf).map_or(0.4 * rpm / 60.0, |family| family.expected_hz);
    let rhythm = rhythm(claim.passing_hz, rpm / 60.0, cage_hz);
    let signature = Signature::of(&analysis.beginning, findings.rate_hz, rhythm)
        .with_context(|| format!("`{}` cannot be held against simulated records", record.display()))?;
    let level = machine::level(&analysis.beginning)?;
    let told = Told {
        signature: PassageSignature::of(&signature),
        free_ms: findings.event_spacing_ms,
        level_m_s2: machine.is_some().then_some(in_m_s2 * level),
    };
    check_folder(out, &[FILE])?;
    let load_n = reading.load_n.unwrap_or_else(|| usual_load_n(&known));
    let base = base(bearing, &claim, (load_n, rpm), (rhythm, findings.rate_hz), machine)?;
    let text = text(record, (&base, &known), &claim, reading, &told, options.runs);
    std::fs::create_dir_all(out).with_context(|| format!("cannot make `{}`", shown(out)))?;
    write_once(&out.join(BASE), &base.to_ron())?;
    write_once(&out.join(FILE), &text)?;
    Ok(Measured { file: out.join(FILE), analysis, rhythm, in_m_s2 })
}

/// Writes a file, or finds the same one.
fn write_once(path: &Path, text: &str) -> Result<()> {
    match std::fs::read_to_string(path) {
        Ok(there) => ensure!(
            there == text,
            "`{}` is of another record, or of other options: give a folder with `--out`",
            shown(path)
        ),
        Err(_) => write_atomic(path, text.as_bytes())?,
    }
    Ok(())
}

fn family(analysis: &Analysis, name: Defect) -> Option<&Family> {
    analysis.findings.families.iter().find(|family| family.name == name)
}

/// The raceway that the record shows to be damaged.
fn claim(analysis: &Analysis) -> Result<Claim<'_>> {
    let claimed: Vec<&Family> = analysis.findings.families.iter().filter(|f| f.claimed).collect();
    let [family] = claimed[..] else {
        bail!(
            "{} What made a record can be inferred where one raceway is damaged",
            analysis.findings.verdict
        );
    };
    let ring = match family.name {
        Defect::Bpfo => DefectRing::Outer,
        Defect::Bpfi => DefectRing::Inner,
        Defect::Bsf | Defect::Ftf => bail!(
            "{} Spalls are inferred on raceways: of a rolling element or a cage there is no such model",
            analysis.findings.verdict
        ),
    };
    Ok(Claim { ring, family, passing_hz: family.measured_hz.unwrap_or(family.expected_hz) })
}

/// The scene, as `machine` fits a path on it: the bearing in its machine, or in a mass as heavy, with one spall under
/// the load.
fn base(
    bearing: &str,
    claim: &Claim<'_>,
    ((least_n, most_n), rpm): ((f64, f64), f64),
    (rhythm, rate_hz): (Rhythm, f64),
    machine: Option<MachineScene>,
) -> Result<Scene> {
    let state = State { spall: Some((claim.ring, 1.0)), width_mm: None };
    let set = ["name=record".to_owned(), format!("solver.duration_ms={:.1}", 1e3 * duration_s(rhythm))];
    let mut scene = scene_of(bearing, ((least_n * most_n).sqrt(), rpm), state, (rate_hz, 1.0), &set)?;
    scene.housing = match (machine, scene.housing.mass(&scene.bearing)) {
        (Some(mut machine), _) => {
            machine.sensor.rate_hz = rate_hz;
            HousingScene::Machine(machine)
        }
        (None, mass) => HousingScene::Rigid(mass.unwrap_or_default()),
    };
    scene.output.records = Some(RecordsScene { rate_hz, noise_db: NOISE_DB.to_vec() });
    scene.validate()?;
    Ok(scene)
}

/// The inference: unknowns of the spall, and targets from the record.
fn text(
    record: &Path,
    (base, known): (&Scene, &CatalogueBearing),
    claim: &Claim<'_>,
    reading: &Reading,
    told: &Told,
    runs: usize,
) -> String {
    let across = known.diameter_mm * known.angle_deg.to_radians().cos();
    let is_outer = claim.ring == DefectRing::Outer;
    let raceway_mm = if is_outer { known.pitch_mm + across } else { known.pitch_mm - across };
    let elements = f64::from(known.elements.unwrap_or(9).max(3));
    let longest_mm = LONGEST * std::f64::consts::PI * raceway_mm / elements;
    let load = reading.load_n.unwrap_or_else(|| usual_load_n(known));
    let (tight_um, loose_um) = reading.clearance_um.unwrap_or(CLEARANCE_UM);
    let bought_um = base.bearing.clearance_um();
    let noise: Vec<String> = NOISE_DB.iter().map(|db| format!("\"{db}\"")).collect();
    let stem = record.file_stem().map_or_else(|| "record".into(), |name| name.to_string_lossy());
    let name: String =
        stem.chars().map(|c| if c.is_ascii_alphanumeric() || c == '-' { c } else { '_' }).collect();
    let ranges = [
        ("defect.length_mm", (SHORTEST_MM, longest_mm), true),
        ("defect.depth_mm", DEPTH_MM, true),
        ("defect.edge_slope_deg", SLOPE_DEG, false),
        ("operation.load_n", load, true),
        ("bearing.clearance_change_um", (tight_um - bought_um, loose_um - bought_um), false),
    ];
    // A field given as one number is not an unknown.
    let set: Vec<String> = ranges
        .iter()
        .filter(|(_, (from, to), _)| from >= to)
        .map(|(field, (value, _), _)| format!("\"{field}={value}\""))
        .collect();
    let mut text = format!(
        "// What made the passages of `{}`: {}.\n(\n    name: \"{name}\",\n    scene: \"{BASE}\",\n    set: \
         [{}],\n    seed: 1,\n    starts: 1,\n    unknowns: [\n",
        record.file_name().unwrap_or_default().to_string_lossy(),
        claim.family.reason,
        set.join(", "),
    );
    for (field, (from, to), log) in ranges.iter().filter(|(_, (from, to), _)| from < to) {
        let log = if *log { ", log: true" } else { "" };
        let _ = writeln!(text, "        (field: \"{field}\", from: {from:.4}, to: {to:.4}{log}),");
    }
    let _ = writeln!(
        text,
        "        (name: \"noise_db\", readings: [{}]),\n    ],\n    targets: [",
        noise.join(", ")
    );
    for (name, of, value, tolerance) in targets(told) {
        let _ = writeln!(text, "        (name: \"{name}\", of: \"{of}\", {value}, tolerance: {tolerance}),");
    }
    let first = runs / 2;
    let _ = writeln!(
        text,
        "    ],\n    budget: (runs: {runs}, first: {first}, round: {}, check: 8),\n)",
        (runs / 10).max(1)
    );
    text
}

/// Targets of the record: name, number of the summary, value, tolerance. The time between two events is
/// compared with the force of the simulated element, which loses and regains its load at the edges: behind a
/// path most simulated records have only a hump there.
fn targets(told: &Told) -> Vec<(&'static str, String, String, f64)> {
    let of = |number: &str| format!("records[noise_db={{noise_db}}].{number}");
    let value = |value: f64| format!("value: {value:.5}");
    let Told { signature, free_ms, level_m_s2 } = told;
    let within: Vec<String> = signature.within.iter().map(|value| format!("{value:.4}")).collect();
    let within = format!("values: [{}]", within.join(", "));
    let level = |level: f64| {
        ("level, m/s²", of("level_m_s2"), format!("value: {level:e}, log: true"), LEVEL_TOLERANCE * level)
    };
    let free = |ms: f64| {
        let (name, of) = ("time between the edges, ms", "median(events.free_ms)");
        (name, of.to_owned(), format!("value: {ms:.4}"), FREE_TOLERANCE * ms)
    };
    let mut targets = vec![
        ("correlation within a passage", of("within"), within, 0.03),
        ("passages repeat", of("repeats"), value(signature.repeats), 0.02),
        ("ten passages later", of("repeats_later"), value(signature.repeats_later), 0.02),
        ("sidebands of the shaft, dB", of("by_shaft_db"), value(signature.by_shaft_db), 1.0),
        ("sidebands of the cage, dB", of("by_cage_db"), value(signature.by_cage_db), 1.0),
        ("swing of the power", of("swing"), value(signature.swing), 0.02),
    ];
    targets.extend(free_ms.map(free));
    targets.extend(level_m_s2.map(level));
    targets
}

impl Measured {
    /// A record of the likeliest scene, with the spectrum of the measured one, and both side by side below
    /// `out/beside`; where Ctrl-C was pressed nothing.
    pub(super) fn beside(
        &self,
        known: &Known<'_>,
        options: &Options,
        out: &Path,
        place: &Place,
        interrupt: &Interrupt,
    ) -> Result<Option<PathBuf>> {
        let Some((scene, noise_db)) = likeliest(known)? else { return Ok(None) };
        let runs = ManyRuns(out.join("synthetic"));
        let point = Point { shares: Vec::new(), scenes: Ok(vec![scene.clone()]) };
        let points = [point];
        let due = runs.due(Keep::All, Rounds::wanted(&points), interrupt)?;
        runs.make(Keep::All, &due, options.share, interrupt, &|_| ());
        let folder = runs.run(&scene);
        if interrupt.is_pressed() || !folder.join("trace.npy").exists() {
            return Ok(None);
        }
        let samples = self.synthetic(&folder, noise_db)?;
        let findings = &self.analysis.findings;
        let (measured, synthetic) = (out.join("measured.uff"), out.join("synthetic.uff"));
        for (path, samples) in [(&measured, &self.analysis.beginning), (&synthetic, &samples)] {
            let mut channel = Channel::held(findings.channel.clone(), samples.clone());
            (channel.rate_hz, channel.unit) = (Some(findings.rate_hz), findings.unit.clone());
            uff58::write(path, &[channel], &[])?;
            let sound = Sound::of(samples, findings.rate_hz, PLAYED_HZ, 1.0)?;
            let heard = sound.samples.iter().map(|x| f64::from(*x) / 32_768.0).collect();
            let bytes =
                pcm(sound.rate_hz, Whole::Of16, &[heard], &[]).context("a sound longer than 4 GiB")?;
            write_atomic(&path.with_extension("wav"), &bytes)?;
        }
        let page = out.join("beside");
        compare::write(&[measured, synthetic], &options.reading.of_one_channel(), &page, place)?;
        Ok(Some(page.join("report.html")))
    }

    /// The record of a run's machine. Without one its force behind a path with the spectrum of the measured record, in
    /// noise of the same spectrum, at the level of that record.
    fn synthetic(&self, folder: &Path, noise_db: f64) -> Result<Vec<f64>> {
        let findings = &self.analysis.findings;
        let run = Run::read(folder)?;
        if let Some(record) = machine::of_run(&run)? {
            return Ok(record.samples.into_iter().map(|x| x / self.in_m_s2).collect());
        }
        let record = Record::whole(&run)?;
        let force = support(&record, run.scene.written.load_direction());
        let start = (5.0 / self.rhythm.passing_hz * record.sample_rate_hz()) as usize;
        let force = at_rate(&force[start.min(force.len() / 2)..], record.sample_rate_hz(), findings.rate_hz)?;
        let density = &self.analysis.density.1;
        let heard = coloured_like(&force, density)?;
        let mut dice = Dice::new(1);
        let white: Vec<f64> = force.iter().map(|_| normal(&mut dice)).collect();
        let noise = coloured_like(&white, density)?;
        let level = statistics::rms(&heard)? / statistics::rms(&noise)? * 10_f64.powf(noise_db / 20.0);
        let sum: Vec<f64> = heard.iter().zip(&noise).map(|(x, n)| x + level * n).collect();
        let scale = statistics::rms(&self.analysis.beginning)? / statistics::rms(&sum)?;
        Ok(sum.into_iter().map(|x| scale * x).collect())
    }
}

/// The scene of the likeliest draw, for some seconds, and its noise [dB].
fn likeliest(known: &Known<'_>) -> Result<Option<(Scene, f64)>> {
    let posterior = &known.posterior;
    let best = (0..posterior.draws.len())
        .max_by(|a, b| posterior.log_likelihoods[*a].total_cmp(&posterior.log_likelihoods[*b]));
    let Some(best) = best else { return Ok(None) };
    let values: Vec<f64> = known
        .priors
        .iter()
        .zip(&posterior.draws[best])
        .map(|(prior, share)| prior.quantile(*share))
        .collect();
    let noise =
        known.inference.unknowns.iter().zip(&values).find_map(|(unknown, value)| match unknown.values {
            Values::Readings(_) => unknown.written(*value).parse().ok(),
            _ => None,
        });
    let mut scene = known.inference.scene(&values)?;
    scene.solver.duration_ms = scene.solver.duration_ms.max(1e3 * SYNTHETIC_S);
    scene.output.records = None;
    Ok(Some((scene, noise.unwrap_or(f64::NEG_INFINITY))))
}

/// The length that was found, in words; `None` where the inference has none.
pub(super) fn in_words(inference: &Inference, answer: &stribeck_report::inference::Answer) -> Option<String> {
    let at = inference.unknowns.iter().position(|unknown| unknown.name == "defect.length_mm")?;
    let field = &answer.fields[at];
    let (median, [low, high]) = (field.median?, field.interval_90?);
    let share = answer.share();
    Some(format!("the spall is {median:.2} mm long, {share} between {low:.2} and {high:.2} mm"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;
    use stribeck_testing::Scratch;

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        reading: Reading,
    }

    /// A record like those of `analyse`'s example: knocks at BPFO of a 6205.
    fn analysis() -> Analysis {
        let mut dice = Dice::new(1);
        let knocks = |n: usize| {
            let since = (n as f64 / 12_800.0).rem_euclid(1.0 / 71.7);
            2.0 * (-since / 1e-3).exp() * (std::f64::consts::TAU * 3_000.0 * since).sin()
        };
        let samples = (0..65_536).map(|n| knocks(n) + dice.share() - 0.5).collect();
        let machine = stribeck_diagnosis::Machine {
            speed_rpm: Some(1200.0),
            bearing: Some(CatalogueBearing::parse("6205").expect("in the catalogue")),
            ..Default::default()
        };
        Analysis::of(&Channel::held("housing", samples), 12_800.0, &machine).expect("long enough")
    }

    #[test]
    fn behaves_the_inference_of_a_record_can_be_read_and_its_scenes_simulated() {
        let analysis = analysis();
        let claim = claim(&analysis).expect("one raceway");
        assert_eq!(claim.ring, DefectRing::Outer);
        let rhythm = rhythm(claim.passing_hz, 20.0, 8.0);
        let signature = Signature::of(&analysis.beginning, 12_800.0, rhythm).expect("long enough");
        let known = CatalogueBearing::parse("6205").expect("in the catalogue");
        let line = Line::parse_from(["x", "--load-n", "50..150", "--clearance-um", "5"]);
        let folder = Scratch::create("infer-record");
        let at = |name: &str| folder.join(name);
        let fitted = MachineScene { seed: 7, ..MachineScene::default() };
        for (machine, last) in [(None, "time between the edges, ms"), (Some(fitted), "level, m/s²")] {
            let is_known = machine.is_some();
            let signature = PassageSignature::of(&signature);
            let told = Told { signature, free_ms: Some(1.5), level_m_s2: is_known.then_some(0.2) };
            let base = base("6205", &claim, ((50.0, 150.0), 1200.0), (rhythm, 12_800.0), machine);
            let base = base.expect("a scene");
            std::fs::write(at(BASE), base.to_ron()).expect("room");
            let text = text(Path::new("a record.csv"), (&base, &known), &claim, &line.reading, &told, 60);
            std::fs::write(at(FILE), &text).expect("room");
            let inference = Inference::read(&at(FILE)).unwrap_or_else(|why| panic!("{why}\n{text}"));
            let names: Vec<&str> = inference.unknowns.iter().map(|unknown| unknown.name.as_str()).collect();
            // A given clearance is not an unknown.
            assert_eq!(
                names,
                [
                    "defect.length_mm",
                    "defect.depth_mm",
                    "defect.edge_slope_deg",
                    "operation.load_n",
                    "noise_db"
                ]
            );
            assert_eq!(inference.targets.last().expect("targets").name, last);
            let scene = inference.scene(&[2.0, 0.1, 60.0, 100.0, 1.0]).expect("a scene");
            // It is the clearance in operation, not a change of the one as bought.
            let of = &scene.bearing;
            assert!((of.clearance_um() + of.clearance_change_um - 5.0).abs() < 1e-3, "{of:?}");
            assert_eq!(scene.housing.machine().map(|m| m.sensor.rate_hz), is_known.then_some(12_800.0));
            let records = scene.output.records.expect("records");
            assert_eq!((records.rate_hz, records.noise_db.len()), (12_800.0, NOISE_DB.len()));
            assert!(scene.solver.duration_ms > 30.0 / 71.7 * 1e3);
        }
    }

    #[test]
    fn refuses_records_that_name_no_raceway() {
        let mut analysis = analysis();
        analysis.findings.families.iter_mut().for_each(|family| family.claimed = false);
        let why = claim(&analysis).err().expect("nothing claimed").to_string();
        assert!(why.contains("one raceway"), "{why}");
        let ball = analysis.findings.families.iter_mut().find(|family| family.name == Defect::Bsf);
        ball.expect("a family").claimed = true;
        let why = claim(&analysis).err().expect("no raceway").to_string();
        assert!(why.contains("rolling element"), "{why}");
    }
}
