//! `stribeck machine`: the path from a bearing to a sensor, and the background, from measured records of known
//! state.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result, bail, ensure};
use stribeck_analysis::machine::agreement::{MachineAgreement, Measured, beside};
use stribeck_analysis::machine::fit::{Known, fit};
use stribeck_analysis::machine::{Force, interval_us};
use stribeck_diagnosis::{Defect, usual_load_n};
use stribeck_scene::catalogue;
use stribeck_scene::machine::MachineScene;
use stribeck_scene::scene::{DefectRing, Scene};
use stribeck_store::run_dir::{Keep, Run, write_atomic};
use stribeck_store::run_info::Status;

use crate::analyse::{Accelerations, Reading, accelerations};
use crate::interrupt::Interrupt;
use crate::many_runs::{ManyRuns, Share};
use crate::new;
use crate::out::{caution, say, tell};
use crate::place::{Place, shown};

/// Longest record that is simulated [s]; of a longer one the beginning is taken.
const LONGEST_S: f64 = 2.0;
/// Beginning of a run that is left out [s].
const SETTLES_S: f64 = 0.05;

/// Flags of `machine`.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// Records of the machine at a steady speed
    #[arg(required = true, value_name = "RECORD")]
    records: Vec<PathBuf>,
    /// State of each record, in their order: "none" for a healthy bearing, or the raceway of a spall and its length
    /// in mm, such as outer:0.53; outer:0.18x0.18 for a pit of that width across the raceway
    #[arg(long = "defect", required = true, value_name = "STATE", value_parser = State::parse)]
    states: Vec<State>,
    #[command(flatten)]
    reading: Reading,
    /// Mass that moves with the outer ring [kg] [default: 10 (outside diameter/52 mm)²]
    #[arg(long, value_name = "KG")]
    mass_kg: Option<f64>,
    /// Overrides a field of the simulated scenes, as `simulate` has it; may be repeated
    #[arg(long, value_name = "FIELD=VALUE")]
    set: Vec<String>,
    /// File to write
    #[arg(long, default_value = "machine.ron")]
    out: PathBuf,
    #[command(flatten)]
    share: Share,
}

/// State of a bearing.
#[derive(Debug, Clone, Copy, PartialEq)]
struct State {
    /// Raceway and length of its spall [mm]; `None` for a sound one.
    spall: Option<(DefectRing, f64)>,
    /// Its width across the raceway [mm]; `None` for one that takes the whole contact.
    width_mm: Option<f64>,
}

impl State {
    fn parse(text: &str) -> Result<Self, String> {
        if text.trim().eq_ignore_ascii_case("none") {
            return Ok(Self { spall: None, width_mm: None });
        }
        let wrong = || {
            format!(
                "`{text}` is no state: none, or outer:LENGTH or inner:LENGTH in mm, such as outer:0.53, with \
                 xWIDTH behind it for a narrow pit. Damaged \
                 rolling elements spin about an axis that wanders, and fit no path"
            )
        };
        let (ring, length) = text.split_once(':').ok_or_else(wrong)?;
        let ring = match ring.trim() {
            "outer" => DefectRing::Outer,
            "inner" => DefectRing::Inner,
            _ => return Err(wrong()),
        };
        let (length, width) = length.split_once('x').map_or((length, None), |(l, w)| (l, Some(w)));
        let number = |text: &str| text.trim().parse::<f64>().ok().filter(|mm| mm.is_finite() && *mm > 0.0);
        let width_mm = width.map(|width| number(width).ok_or_else(wrong)).transpose()?;
        Ok(Self { spall: Some((ring, number(length).ok_or_else(wrong)?)), width_mm })
    }

    /// The family of its defect.
    fn family(self) -> Option<Defect> {
        self.spall.map(|(ring, _)| match ring {
            DefectRing::Outer => Defect::Bpfo,
            DefectRing::Inner => Defect::Bpfi,
        })
    }
}

/// The scene of a bearing in such a state, whose force makes a record of `duration_s` at `rate_hz`.
fn scene_of(
    bearing: &str,
    (load_n, speed_rpm): (f64, f64),
    state: State,
    (rate_hz, duration_s): (f64, f64),
    set: &[String],
) -> Result<Scene> {
    let scene = new::scene(bearing, load_n, speed_rpm, state.spall.map(|(ring, _)| ring))?;
    let mut all = vec![
        format!("solver.duration_ms={:.1}", 1e3 * (duration_s.min(LONGEST_S) + SETTLES_S)),
        format!("output.interval_us={:?}", interval_us(rate_hz)),
        "output.frames=None".to_owned(),
    ];
    all.extend(state.spall.map(|(_, mm)| format!("defect.length_mm={mm:?}")));
    all.extend(state.width_mm.map(|mm| format!("defect.width_mm={mm:?}")));
    all.extend_from_slice(set);
    Ok(scene.with_overrides(&all)?)
}

/// A record with its state and the scene of its bearing.
struct Given {
    name: String,
    state: State,
    record: Accelerations,
    scene: Scene,
}

pub(crate) fn run(options: &Options, place: &Place) -> Result<ExitCode> {
    options.reading.limits.apply();
    ensure!(
        options.records.len() == options.states.len(),
        "{} records and {} states: give one `--defect` for each record, in their order",
        options.records.len(),
        options.states.len()
    );
    ensure!(
        options.states.iter().any(|state| state.spall.is_some()),
        "all records are of healthy bearings, which hardly excite the path: add one with a spall of known length, \
         `--defect outer:0.53`"
    );
    let bearing =
        options.reading.bearing.as_deref().context("name the bearing with `--bearing`, such as 6205")?;
    let mut set = options.set.clone();
    set.extend(options.mass_kg.map(|kg| format!("housing.mass_kg={kg:?}")));
    let given = options
        .records
        .iter()
        .zip(&options.states)
        .map(|(file, state)| one(file, *state, bearing, options, &set, place))
        .collect::<Result<Vec<_>>>()?;
    if given.iter().all(|g| g.state.spall.is_some()) {
        caution!("no record of the sound machine: the fitted machine has no background");
    }
    let stem = options.out.file_stem().map_or_else(|| "machine".into(), |stem| stem.to_string_lossy());
    let folder = place.runs().join(format!("{stem}-bearings"));
    let scenes: Vec<&Scene> = given.iter().map(|g| &g.scene).collect();
    let forces = forces(&scenes, folder, options.share)?;
    let known: Vec<Known> = given
        .iter()
        .zip(&forces)
        .map(|(g, force)| Known {
            rate_hz: g.record.rate_hz,
            measured: g.record.samples.clone(),
            force: force.clone(),
            is_sound: g.state.spall.is_none(),
        })
        .collect();
    let machine = MachineScene { mass_kg: options.mass_kg, ..fit(&known)? };
    write_atomic(&options.out, text(&machine, &given).as_bytes())?;
    for (g, force) in given.iter().zip(&forces) {
        let measured = Measured {
            samples: &g.record.samples,
            rate_hz: g.record.rate_hz,
            known: &g.record.machine,
            defect: g.state.family(),
        };
        say!("{}: {}", g.name, words(&beside(&machine, &g.scene.bearing, force, measured)?));
    }
    say!("{}", shown(&options.out));
    say!(
        "a scene takes it as `housing: machine(file: \"{}\")`",
        options.out.file_name().unwrap_or_default().display()
    );
    Ok(ExitCode::SUCCESS)
}

fn one(
    file: &Path,
    state: State,
    bearing: &str,
    options: &Options,
    set: &[String],
    place: &Place,
) -> Result<Given> {
    let record = accelerations(file, &options.reading, place)?;
    let rpm = record.machine.speed_rpm.with_context(|| {
        format!("`{}` does not say how fast the shaft turned: give `--speed-rpm`", file.display())
    })?;
    let (least, most) = match options.reading.load_n {
        Some(load) => load,
        None => usual_load_n(&catalogue::parse(bearing).map_err(anyhow::Error::msg)?),
    };
    let duration_s = record.samples.len() as f64 / record.rate_hz;
    if duration_s < 1.0 {
        bail!("`{}` is {duration_s:.2} s long: a second at least is needed", file.display());
    }
    let scene = scene_of(bearing, ((least * most).sqrt(), rpm), state, (record.rate_hz, duration_s), set)?;
    let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
    Ok(Given { name, state, record, scene })
}

/// The vertical force on the housing in each scene; equal scenes are run once, and those in `folder` not again.
fn forces(scenes: &[&Scene], folder: PathBuf, share: Share) -> Result<Vec<Force>> {
    let interrupt = Interrupt::listen()?;
    let runs = ManyRuns(folder);
    runs.make_all(Keep::All, scenes.iter().copied(), (share, &interrupt), &|count, jobs| {
        tell!("{count} bearings are simulated, {}: {}", jobs.shown(), shown(&runs.0));
    })?;
    let force = |scene: &&Scene| {
        let folder = runs.run(scene);
        let run = Run::read(&folder).with_context(|| format!("no run in `{}`", shown(&folder)))?;
        if let (true, Some(why)) = (run.info.status != Status::Complete, &run.info.stop_reason) {
            bail!("the bearing of a record could not be simulated: {why}. `--set` changes its scene");
        }
        Ok(Force::of_run(&run, MachineScene::default().direction_deg)?)
    };
    scenes.iter().map(force).collect()
}

/// The file: what it is from, and the machine.
fn text(machine: &MachineScene, given: &[Given]) -> String {
    let of = |g: &Given| match g.state.spall {
        None => format!("`{}`, sound", g.name),
        Some((ring, mm)) => {
            let ring = if ring == DefectRing::Outer { "outer" } else { "inner" };
            format!("`{}`, {mm} mm on the {ring} raceway", g.name)
        }
    };
    let from: Vec<String> = given.iter().map(of).collect();
    format!(
        "// The machine about a bearing, fitted by `stribeck machine` on {}.\n// A scene takes it as `housing: \
         machine(file: \"…\")`.\n{}",
        from.join("; "),
        machine.to_ron()
    )
}

fn words(a: &MachineAgreement) -> String {
    let height = match a.height_db {
        [Some(ours), Some(theirs)] => format!(", height of the family {ours:.0} and {theirs:.0} dB"),
        _ => String::new(),
    };
    format!(
        "third octaves off by {:.1} dB (median), RMS {} and {} m/s² measured, kurtosis {:.1} and {:.1}{height}",
        a.octaves_db,
        three_digits(a.rms_m_s2[0]),
        three_digits(a.rms_m_s2[1]),
        a.kurtosis[0],
        a.kurtosis[1]
    )
}

/// A level, however small.
fn three_digits(level: f64) -> String {
    let decimals = if level > 0.0 { 2.0 - level.log10().floor() } else { 2.0 };
    format!("{level:.*}", decimals.clamp(0.0, 12.0) as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refuses_states_that_are_none() {
        let spall = |text| State::parse(text).map(|state| state.spall);
        assert_eq!(spall("none"), Ok(None));
        assert_eq!(spall("outer:0.53"), Ok(Some((DefectRing::Outer, 0.53))));
        assert_eq!(spall("inner: 2"), Ok(Some((DefectRing::Inner, 2.0))));
        assert_eq!(State::parse("outer:0.18x0.2").map(|state| state.width_mm), Ok(Some(0.2)));
        for text in ["outer", "roller:1", "outer:-1", "outer:wide", "inner:inf", "outer:1x", "outer:1x0"] {
            assert!(spall(text).unwrap_err().contains("outer:0.53"), "{text}");
        }
    }

    #[test]
    fn by_hand_levels_have_three_digits() {
        let shown = [0.0, 0.000_432_1, 0.0999, 1.234, 123.4].map(three_digits);
        assert_eq!(shown, ["0.00", "0.000432", "0.0999", "1.23", "123"]);
    }

    #[test]
    fn behaves_the_scene_of_a_state_has_its_spall_and_rate() {
        let state = State { spall: Some((DefectRing::Inner, 0.7)), width_mm: None };
        let scene = scene_of("6205", (200.0, 1797.0), state, (48_828.0, 9.0), &[]).expect("a scene");
        let defect = scene.defect.expect("a spall");
        assert_eq!((defect.ring, defect.length_mm), (DefectRing::Inner, 0.7));
        assert!((1e6 / scene.output.interval_us / 48_828.0 - 2.0).abs() < 1e-12);
        assert!((scene.solver.duration_ms - 2050.0).abs() < 1.0);
    }
}
