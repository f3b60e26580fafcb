//! `stribeck new`: a scene of one's own, by six answers or by flags, with comments, that runs as it is.

use std::f64::consts::TAU;
use std::fmt::Display;
use std::io::{BufRead, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result, bail, ensure};
use stribeck_scene::catalogue;
use stribeck_scene::deviation::HOLLOW_FACETS;
#[cfg(feature = "full")]
use stribeck_scene::scene::DefectRing;
use stribeck_scene::scene::Scene;
use stribeck_store::run_dir::write_atomic;
use stribeck_theory::catalogue::{CatalogueBearing, Element};
use stribeck_theory::fits::mounted_clearance_change_um;
use stribeck_theory::kinematics::off_multiple;

use crate::out::say;
use crate::place::{Place, shown};

/// Flags of `new`. A missing one is asked for on a terminal, and has its default elsewhere.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// File to write, for example mine.ron [default: the bearing and its defect]
    file: Option<PathBuf>,
    /// Bearing of the catalogue, for example "NU 205", or "elements=9, diameter_mm=7.94, pitch_mm=39.04" [default: 6205]
    #[arg(long)]
    bearing: Option<String>,
    /// Radial load [N] [default: 1000, or a tenth of the static rating where that is less]
    #[arg(long, value_name = "N", value_parser = positive, allow_hyphen_values = true)]
    load_n: Option<f64>,
    /// Speed of the shaft [1/min] [default: 1500]
    #[arg(long, value_name = "RPM", value_parser = positive, allow_hyphen_values = true)]
    speed_rpm: Option<f64>,
    /// Where a spall is, or none [default: outer]
    #[arg(long, value_enum)]
    defect: Option<Where>,
    /// Length of the spall along its surface [mm] [default: 2, more on a large rolling element]
    #[arg(long, value_name = "MM", value_parser = positive, allow_hyphen_values = true)]
    length_mm: Option<f64>,
    /// Length of the record [s] [default: 1, longer where twenty passages over a defect take longer]
    #[arg(long, value_name = "S", value_parser = positive, allow_hyphen_values = true)]
    duration_s: Option<f64>,
    /// Asks nothing: missing flags have their defaults
    #[arg(long, short = 'y')]
    yes: bool,
}

impl Options {
    /// Whether missing answers are asked for: on a terminal, and of lines that are led into a command without a
    /// flag.
    fn asks(&self) -> bool {
        let is_bare = self.bearing.is_none()
            && self.load_n.is_none()
            && self.speed_rpm.is_none()
            && self.defect.is_none()
            && self.length_mm.is_none()
            && self.duration_s.is_none();
        let is_terminal = std::io::stdin().is_terminal();
        !self.yes && (is_terminal && std::io::stderr().is_terminal() || !is_terminal && is_bare)
    }
}

/// Where a spall lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Where {
    /// On the outer raceway
    Outer,
    /// On the inner raceway
    Inner,
    /// On a rolling element
    Roller,
    /// Nowhere: a healthy bearing
    None,
}

impl Where {
    fn word(self) -> &'static str {
        match self {
            Self::Outer => "outer",
            Self::Inner => "inner",
            Self::Roller => "roller",
            Self::None => "none",
        }
    }

    fn parse(text: &str) -> Result<Self, String> {
        <Self as clap::ValueEnum>::from_str(text, true)
            .map_err(|_| format!("`{text}` is none of outer, inner, roller and none"))
    }
}

fn positive(text: &str) -> Result<f64, String> {
    let number = text.trim().parse::<f64>().ok().filter(|x| x.is_finite() && *x > 0.0);
    number.ok_or_else(|| format!("`{text}` is no number above 0"))
}

/// A bearing by its name or its numbers.
fn bearing(text: &str) -> Result<CatalogueBearing, String> {
    let advice = "`stribeck bearings` lists those that are known; another one is given by its numbers, \
                  `elements=9, diameter_mm=7.94, pitch_mm=39.04`";
    catalogue::parse_or_advise(text.trim().trim_matches('"'), advice)
}

/// The six answers.
struct Answers {
    bearing: String,
    load_n: f64,
    speed_rpm: f64,
    defect: Where,
    /// Length of its spall [mm]; `None` for the usual one.
    length_mm: Option<f64>,
    duration_s: f64,
}

pub(crate) fn run(options: &Options, place: &Place) -> Result<ExitCode> {
    let asks = options.asks();
    if let Some(file) = &options.file {
        ensure!(
            file.extension().is_some_and(|end| end == "ron"),
            "`{}`: a scene is a file that ends in `.ron`, such as `{}.ron`",
            file.display(),
            file.file_stem().unwrap_or(file.as_os_str()).display()
        );
        free(file)?;
    }
    let answers = answers(options, asks)?;
    let name = name(&answers);
    let file = options.file.clone().unwrap_or_else(|| PathBuf::from(format!("{name}.ron")));
    free(&file)?;
    let name = file.file_stem().map_or(name, |stem| {
        stem.to_string_lossy().replace(|c: char| !(c.is_ascii_alphanumeric() || "-_.".contains(c)), "-")
    });
    let text = text(&name, &answers);
    // A scene that would be refused when it runs is refused here, and no file is written.
    let scene = Scene::parse(&text, &shown(&file))?;
    if let Some(folder) = file.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        std::fs::create_dir_all(folder).with_context(|| format!("cannot make `{}`", shown(folder)))?;
    }
    write_atomic(&file, text.as_bytes())?;
    let k = scene.kinematics();
    say!("{}", shown(&file));
    say!(
        "  BPFO {:.2} Hz, BPFI {:.2} Hz, BSF {:.2} Hz, FTF {:.2} Hz, without slip",
        k.bpfo_hz,
        k.bpfi_hz,
        k.bsf_hz,
        k.cage_hz
    );
    say!("run it: {} simulate {}", place.program, shown(&file));
    Ok(ExitCode::SUCCESS)
}

/// Check of a number: the number, or the reason in words why it is refused.
type Limit<'a> = dyn Fn(f64) -> Result<f64, String> + 'a;

/// Default radial load [N].
const USUAL_N: f64 = 1000.0;

/// Limits of a first scene of a bearing; values beyond can be written into the file by hand.
#[derive(Debug, Clone, Copy)]
struct Limits {
    /// Static rating by ISO 76 [N].
    rating_n: f64,
    /// Pitch diameter [mm].
    pitch_mm: f64,
    /// Defects pass as often in a turn, the slowest of inner and outer raceway and of the elements.
    passing: f64,
    /// Turns between the family of a raceway and the nearest multiple of the shaft.
    off_shaft: f64,
}

/// Pitch diameter times speed [mm/min] of the fastest bearings, of machine tools.
const FASTEST_MM_RPM: f64 = 2.0e6;
/// Pitch diameter times speed [mm/min] of the slowest, of slewing rings.
const SLOWEST_MM_RPM: f64 = 10.0;
/// Periods of the defect in a record, the least for an envelope, and the longest record [s].
const PERIODS: f64 = 10.0;
const LONGEST_S: f64 = 100.0;
/// Resolutions between a family and a multiple of the shaft, twice those that the verdict asks for, and the longest
/// record that is made for them [s].
const RESOLUTIONS: f64 = 3.0;
const PATIENCE_S: f64 = 5.0;

impl Limits {
    fn of(bearing: &str) -> Result<Self> {
        let scene = Scene::parse(&format!("(bearing: {bearing:?})"), bearing)?;
        let k = scene.kinematics();
        Ok(Self {
            rating_n: scene.static_rating_n(),
            pitch_mm: 0.5 * (scene.bearing.outer_race_diameter_mm + scene.bearing.inner_race_diameter_mm),
            passing: k.bpfo_hz.min(k.bpfi_hz).min(2.0 * k.bsf_hz) / k.shaft_hz,
            off_shaft: [k.bpfo_hz, k.bpfi_hz]
                .map(|hz| off_multiple(hz / k.shaft_hz, 1.0))
                .into_iter()
                .fold(f64::INFINITY, f64::min),
        })
    }

    /// 1000 N, or a tenth of a smaller bearing's static rating [N].
    fn usual_load_n(self) -> f64 {
        let tenth = 0.1 * self.rating_n;
        let digits = 10_f64.powf(tenth.max(1e-9).log10().floor() - 1.0);
        if tenth < USUAL_N { (tenth / digits).round() * digits } else { USUAL_N }
    }

    /// A second, or longer where twenty passages take it, or where a raceway's family lies so near to a multiple
    /// of the shaft that a second does not tell them apart [s].
    fn usual_duration_s(self, speed_rpm: f64) -> f64 {
        let turn_s = 60.0 / speed_rpm;
        let apart_s = (RESOLUTIONS * turn_s / self.off_shaft).min(PATIENCE_S);
        (2.0 * PERIODS * turn_s / self.passing).max(apart_s).ceil().clamp(1.0, LONGEST_S)
    }

    /// Whether the bearing carries a load.
    fn load(self, load_n: f64) -> Result<f64, String> {
        let Self { rating_n, .. } = self;
        if load_n <= rating_n {
            return Ok(load_n);
        }
        Err(format!(
            "{load_n} N: more than 0, at most {:.0} N, the bearing's static rating by ISO 76; above it steel \
             yields, which the model does not. A tenth of it, {:.0} N, is a usual load",
            rating_n.floor(),
            0.1 * rating_n
        ))
    }

    /// Whether a bearing of this size turns so fast.
    fn speed(self, speed_rpm: f64) -> Result<f64, String> {
        let [slowest, fastest] = [SLOWEST_MM_RPM, FASTEST_MM_RPM].map(|limit| limit / self.pitch_mm);
        let slowest = slowest.max(PERIODS * 60.0 / (self.passing * LONGEST_S));
        if (slowest..=fastest).contains(&speed_rpm) {
            return Ok(speed_rpm);
        }
        Err(format!(
            "{speed_rpm} rpm: {slowest:.1} to {fastest:.0} rpm at a pitch diameter of {:.1} mm. A slower \
             shaft has no ten passages over a defect in {LONGEST_S} s, a faster one is faster than those of \
             machine tools. 1500 rpm is usual",
            self.pitch_mm,
        ))
    }

    /// Whether a record shows something.
    fn duration(self, speed_rpm: f64, duration_s: f64) -> Result<f64, String> {
        let least_s = (1e3 * PERIODS * 60.0 / (self.passing * speed_rpm)).ceil() / 1e3;
        if (least_s..=LONGEST_S).contains(&duration_s) {
            return Ok(duration_s);
        }
        Err(format!(
            "{duration_s} s: {least_s} to {LONGEST_S} s. The shortest record holds ten passages over a \
             defect at {speed_rpm} rpm, the least for an envelope spectrum; the longest takes some 10 GB"
        ))
    }
}

/// Refuses to write over a file.
fn free(file: &Path) -> Result<()> {
    ensure!(!file.exists(), "`{}` is there already and is kept: give another name", shown(file));
    Ok(())
}

fn answers(options: &Options, asks: bool) -> Result<Answers> {
    let named = |text: &str| bearing(text).map(|b| with_numbers(text, &b));
    let from = |given: Option<String>, question: &str, default: &str| -> Result<String> {
        match given {
            Some(given) => named(&given).map_err(|why| anyhow::anyhow!("--bearing: {why}")),
            None if asks => ask(question, &default, &named),
            None => Ok(named(default).map_err(anyhow::Error::msg)?),
        }
    };
    let number = |flag: &str, given: Option<f64>, question: &str, default: f64, limit: &Limit<'_>| match given
    {
        Some(given) => limit(given).map_err(|why| anyhow::anyhow!("{flag}: {why}")),
        None if asks => ask(question, &default, &|text: &str| limit(positive(text)?)),
        None => limit(default).map_err(|why| anyhow::anyhow!("{flag}, by default: {why}")),
    };
    let bearing = from(options.bearing.clone(), "Bearing of the catalogue", "6205")?;
    let limits = Limits::of(&bearing)?;
    let usual_n = limits.usual_load_n();
    let load_n = number("--load-n", options.load_n, "Radial load [N]", usual_n, &|n| limits.load(n))?;
    let speed_rpm = number("--speed-rpm", options.speed_rpm, "Speed of the shaft [1/min]", 1500.0, &|rpm| {
        limits.speed(rpm)
    })?;
    let defect = match options.defect {
        Some(given) => given,
        None if asks => ask("Spall: outer, inner, roller or none", &"outer", &Where::parse)?,
        None => Where::Outer,
    };
    let length_mm = match options.length_mm {
        Some(given) => Some(given),
        None if asks && defect != Where::None => {
            Some(ask("Length of the spall [mm]", &USUAL_SPALL_MM, &positive)?)
        }
        None => None,
    };
    Ok(Answers {
        bearing,
        load_n,
        speed_rpm,
        defect,
        length_mm,
        duration_s: number(
            "--duration-s",
            options.duration_s,
            "Length of the record [s]",
            limits.usual_duration_s(speed_rpm),
            &|s| limits.duration(speed_rpm, s),
        )?,
    })
}

/// The name of a bearing in the catalogue, with the dimensions given beside it.
fn with_numbers(text: &str, bearing: &CatalogueBearing) -> String {
    let text = text.trim().trim_matches('"');
    match text.split_once(',') {
        // Its numbers are its name.
        _ if bearing.name.contains('=') => bearing.name.clone(),
        Some((_, numbers)) => format!("{}, {}", bearing.name, numbers.trim()),
        None => bearing.name.clone(),
    }
}

/// Asks until an answer can be; an empty one is the default.
fn ask<T>(question: &str, default: &dyn Display, parse: &dyn Fn(&str) -> Result<T, String>) -> Result<T> {
    let (mut stderr, stdin) = (std::io::stderr(), std::io::stdin());
    loop {
        write!(stderr, "{question} [{default}]: ")?;
        stderr.flush()?;
        let mut line = String::new();
        if stdin.lock().read_line(&mut line)? == 0 {
            if stdin.is_terminal() {
                bail!("no more answers: nothing was written. `--yes` takes the defaults");
            }
            // Lines that are led into the command may end before its questions.
            writeln!(stderr)?;
        }
        let answer = match line.trim() {
            "" => default.to_string(),
            answer => answer.to_owned(),
        };
        match parse(&answer) {
            Ok(value) => return Ok(value),
            Err(why) => writeln!(stderr, "  {why}")?,
        }
    }
}

/// The text of the scene of a healthy bearing in the catalogue, every answer the usual one.
///
/// # Errors
/// When the catalogue has no such bearing.
pub fn sound(bearing: &str) -> Result<String> {
    let options = Options {
        file: None,
        bearing: Some(bearing.to_owned()),
        load_n: None,
        speed_rpm: None,
        defect: Some(Where::None),
        length_mm: None,
        duration_s: None,
        yes: true,
    };
    let answers = answers(&options, false)?;
    Ok(text(&name(&answers), &answers))
}

/// The scene of a bearing with a spall of a raceway, or a healthy one, as `new` writes it.
#[cfg(feature = "full")]
pub(crate) fn scene(bearing: &str, load_n: f64, speed_rpm: f64, ring: Option<DefectRing>) -> Result<Scene> {
    let limits = Limits::of(bearing)?;
    limits.load(load_n).and_then(|_| limits.speed(speed_rpm)).map_err(anyhow::Error::msg)?;
    let defect = match ring {
        None => Where::None,
        Some(DefectRing::Outer) => Where::Outer,
        Some(DefectRing::Inner) => Where::Inner,
    };
    let (bearing, length_mm) = (bearing.to_owned(), None);
    let answers = Answers { bearing, load_n, speed_rpm, defect, length_mm, duration_s: 1.0 };
    Ok(Scene::parse(&text(&name(&answers), &answers), "the scene of the record")?)
}

/// Name of the scene: the bearing with its defect.
fn name(answers: &Answers) -> String {
    let bearing = answers.bearing.split(',').next().unwrap_or_default();
    let bearing = match bearing.contains('=') {
        true => "own".to_owned(),
        false => bearing.to_lowercase().replace(|c: char| !c.is_ascii_alphanumeric(), ""),
    };
    match answers.defect {
        Where::None => format!("{bearing}-sound"),
        defect => format!("{bearing}-{}", defect.word()),
    }
}

/// A scene with comments, and marks where the answers go.
const SCENE: &str = include_str!("new/scene.ron");

/// Usual length of a spall [mm].
const USUAL_SPALL_MM: f64 = 2.0;

/// Length of a spall on a rolling element [mm]: the usual one, or as many facets as make a hollow in a large one.
fn spall_of_an_element_mm(answers: &Answers) -> f64 {
    if let Some(given) = answers.length_mm {
        return given;
    }
    let sound = Answers { bearing: answers.bearing.clone(), defect: Where::None, ..*answers };
    let least = Scene::parse(&text("sound", &sound), "sound.ron").map_or(0.0, |scene| {
        let facet_mm =
            std::f64::consts::PI * scene.bearing.roller_diameter_mm / scene.mesh.roller_facets as f64;
        HOLLOW_FACETS * facet_mm
    });
    f64::max(USUAL_SPALL_MM, (10.0 * least).ceil() / 10.0)
}

/// A force that turns with the shaft [N]: the unbalance of a rotor whose weight is the load, of the grade (ISO
/// 21940-11) of general machinery, above 3000 rpm of turbines, and above 15 000 rpm of spindles.
fn unbalance_n(load_n: f64, speed_rpm: f64) -> f64 {
    let grade_mm_s = match speed_rpm {
        ..=3000.0 => 6.3,
        ..=15_000.0 => 2.5,
        _ => 1.0,
    };
    let share = 1e-3 * grade_mm_s * TAU / 60.0 * speed_rpm / 9.81;
    (10.0 * share * load_n).round().max(1.0) / 10.0
}

/// A scene of a bearing in the catalogue, with all else by default.
fn of_bearing(bearing: &str) -> Scene {
    Scene::parse(&format!("(bearing: {bearing:?})"), bearing).unwrap_or_default()
}

/// What fit and warmth usually take of a bearing's clearance [µm].
fn clearance_change_um(bearing: &str) -> f64 {
    let b = of_bearing(bearing).bearing;
    let inner_mm = b.inner_race_diameter_mm;
    let pitch_mm = 0.5 * (b.outer_race_diameter_mm + inner_mm);
    mounted_clearance_change_um(inner_mm - 2.0 * b.inner_ring_thickness_mm, inner_mm, pitch_mm).round()
}

/// What a scene of balls or rollers says of bearing and operation besides.
fn of_element(bearing: &str) -> [&'static str; 2] {
    match of_bearing(bearing).element() {
        Element::Ball => [
            "",
            "\n        // Oil floats the cage. The weight of a dry one would shift the balls.\n        \
             gravity_m_s2: 0,",
        ],
        Element::Roller => [
            "\n        // Ends relieved as those of real rollers. Straight ones enter the load with an impact.\n        \
             roller_profile: logarithmic,",
            "",
        ],
    }
}

/// The scene with its comments.
fn text(name: &str, answers: &Answers) -> String {
    let Answers { bearing, load_n, speed_rpm, defect, length_mm, duration_s } = answers;
    let length_mm = length_mm.unwrap_or(USUAL_SPALL_MM);
    let (state, comment, spall) = match defect {
        Where::None => (
            "sound",
            "A healthy bearing. A spall would be: (ring: outer, length_mm: 2, depth_mm: 0.1).",
            "None".to_owned(),
        ),
        Where::Roller => (
            "with a spall on a rolling element",
            "How long the spall is along the surface, and how deep, stands among `defects`.",
            "None".to_owned(),
        ),
        Where::Outer | Where::Inner => (
            if *defect == Where::Outer {
                "with a spall on the outer raceway"
            } else {
                "with a spall on the inner raceway"
            },
            "How long the spall is along the raceway, and how deep.",
            format!("(ring: {}, length_mm: {length_mm:?}, depth_mm: 0.1)", defect.word()),
        ),
    };
    let of_an_element = if *defect == Where::Roller {
        format!(
            "\n    defects: [(on: roller(1), form: spall(length_mm: {}, depth_mm: 0.05))],",
            spall_of_an_element_mm(answers)
        )
    } else {
        String::new()
    };
    let [profile, weights] = of_element(bearing);
    SCENE
        .replace("<defect>", &format!("    // {comment}\n    defect: {spall},{of_an_element}"))
        .replace("<state>", state)
        .replace("<file>", name)
        .replace("<bearing>", bearing)
        .replace("<profile>", profile)
        .replace("<weights>", weights)
        .replace("<change>", &format!("{:?}", clearance_change_um(bearing)))
        .replace("<unbalance>", &format!("{:?}", unbalance_n(*load_n, *speed_rpm)))
        .replace("<load>", &format!("{load_n:?}"))
        .replace("<speed>", &format!("{speed_rpm:?}"))
        .replace("<duration>", &format!("{:?}", 1e3 * duration_s))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn answers(bearing: &str, defect: Where) -> Answers {
        Answers {
            bearing: bearing.to_owned(),
            load_n: 1000.0,
            speed_rpm: 1500.0,
            defect,
            length_mm: None,
            duration_s: 0.5,
        }
    }

    #[test]
    fn behaves_every_answer_makes_a_scene_that_can_be() {
        for bearing in [
            "6205",
            "NU 205",
            "NU 205, elements=12",
            "6305",
            "6322",
            "NU 2320",
            "elements=9, diameter_mm=7.94, pitch_mm=39.04",
        ] {
            for defect in [Where::Outer, Where::Inner, Where::Roller, Where::None] {
                let of = answers(bearing, defect);
                let scene = Scene::parse(&text(&name(&of), &of), "new.ron").expect(bearing);
                assert_eq!((scene.operation.load_n, scene.solver.duration_ms), (1000.0, 500.0));
                assert_eq!(scene.faults().len(), usize::from(defect != Where::None), "{bearing} {defect:?}");
            }
        }
    }

    /// A load of 1e9 N was answered with a thickness of the bearing, and one of 20 kN on a 6205, which
    /// carries 7.9 kN, was written.
    #[test]
    fn issue_numbers_that_no_bearing_has_are_refused_with_their_range() {
        let limits = Limits::of("6205").expect("known");
        assert!((7_800.0..8_000.0).contains(&limits.rating_n), "{limits:?}");
        let says = |refused: Result<f64, String>, words: &str| {
            let why = refused.expect_err(words);
            assert!(why.contains(words), "{why}");
        };
        assert_eq!(limits.load(7_000.0), Ok(7_000.0));
        says(limits.load(20_000.0), "at most 7886 N");
        says(limits.load(1e9), "static rating");
        says(limits.speed(1e6), "to 51221 rpm");
        says(limits.speed(0.1), "1.7 to");
        says(limits.duration(1500.0, 0.01), "0.112 to 100 s");
        says(limits.duration(1500.0, 1e9), "0.112 to 100 s");
        // BPFO of a 6203 is 3.05 turns: of a second of 25 turns a spectrum does not tell it from the third
        // multiple of the shaft.
        assert_eq!(limits.usual_duration_s(1500.0), 1.0);
        assert_eq!(Limits::of("6203").expect("known").usual_duration_s(1500.0), 3.0);
        // A scene written without flags is valid for small and slow bearings, too.
        let small = Limits::of("6000").expect("known");
        assert!(small.load(small.usual_load_n()).is_ok(), "{small:?}");
        assert!(limits.duration(20.0, limits.usual_duration_s(20.0)).is_ok());
    }

    #[test]
    fn behaves_names_are_those_of_bearing_and_defect() {
        assert_eq!(name(&answers("NU 205, elements=12", Where::None)), "nu205-sound");
        assert_eq!(name(&answers("6205", Where::Inner)), "6205-inner");
        let bearing = bearing("SKF 6205-2RS1, elements=8").expect("of the catalogue");
        assert_eq!(with_numbers("SKF 6205-2RS1, elements=8", &bearing), "6205, elements=8");
        let numbers = "elements=9, element_diameter_mm=7.94, pitch_diameter_mm=39.04";
        let bearing = super::bearing(numbers).expect("numbers");
        assert_eq!(with_numbers(numbers, &bearing), numbers);
        assert_eq!(name(&answers(numbers, Where::Inner)), "own-inner");
    }
}
