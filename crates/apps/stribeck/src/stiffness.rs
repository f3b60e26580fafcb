//! `stribeck stiffness`: stiffness and damping of a bearing over load, speed and the angle of its cage.

use std::fs;
use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, Result, bail, ensure};
use stribeck_analysis::stiffness::{BearingStiffness, Grid};
use stribeck_scene::resolved::ResolvedScene;
use stribeck_store::run_dir::check_folder;
use stribeck_theory::contact_law::ContactLawKind;

use crate::out::{caution, say};
use crate::place::{Place, shown};

/// Flags of `stiffness`.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// Scene file [default: the run of the paper, fixtures/scenes/singh2014.ron]
    scene: Option<PathBuf>,
    /// Overrides a field of the scene, for example --set bearing.clearance_change_um=10; may be repeated
    #[arg(long = "set", value_name = "FIELD=VALUE")]
    overrides: Vec<String>,
    /// Loads [N], separated by commas [default: a half, one and two times that of the scene]
    #[arg(long, value_name = "N,N,…", value_delimiter = ',')]
    loads_n: Vec<f64>,
    /// Speeds of the inner ring [rpm], separated by commas [default: that of the scene, and five from a
    /// quarter to twice as much]
    #[arg(long, value_name = "RPM,RPM,…", value_delimiter = ',', allow_hyphen_values = true)]
    speeds_rpm: Vec<f64>,
    /// Angles of the cage over one pitch of its elements
    #[arg(long, default_value_t = 64, value_name = "COUNT")]
    angles: usize,
    /// Law of contact [default: ball for balls, line for all others]
    #[arg(long, value_enum)]
    contact: Option<Contact>,
    /// Damping over stiffness [µs], C = β K: stated, because nothing here computes it; 2.5 to 25 are measured
    #[arg(long, default_value_t = 8.0, value_name = "US", allow_hyphen_values = true)]
    damping_us: f64,
    /// Folder for the results [default: NAME-stiffness in the working folder]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Prints stiffness.json instead of the table
    #[arg(long)]
    json: bool,
}

/// Laws of contact.
#[derive(Debug, Clone, Copy, clap::ValueEnum)]
enum Contact {
    /// Line contact in plane strain
    Line,
    /// Point contact of balls in grooves of 0.52 diameters
    Ball,
    /// Rollers of finite length, after Palmgren
    Palmgren,
}

/// File that marks the folder.
const MARK: &str = "stiffness.json";

/// Points that are still computed within seconds.
const MOST_POINTS: usize = 2000;

pub(crate) fn run(options: &Options, place: &Place) -> Result<ExitCode> {
    let scene = place.scene(options.scene.as_deref(), &options.overrides)?.resolve();
    let grid = grid(options, &scene)?;
    let out = match &options.out {
        Some(out) => out.clone(),
        None => PathBuf::from(format!("{}-stiffness", stem(options))),
    };
    check_folder(&out, &[MARK])?;
    for left in left_out(&scene) {
        caution!("{left}");
    }
    let found = BearingStiffness::of(&scene, &grid)?;
    fs::create_dir_all(&out).with_context(|| format!("cannot create `{}`", out.display()))?;
    let write = |name: &str, text: String| {
        let path = out.join(name);
        fs::write(&path, text).with_context(|| format!("cannot write `{}`", path.display()))
    };
    write("stiffness.csv", found.csv())?;
    let json = serde_json::to_string_pretty(&found)?;
    write(MARK, json.clone())?;
    for load in &grid.loads_n {
        write(&format!("ross_{load}n.json"), serde_json::to_string_pretty(&found.ross(*load))?)?;
    }
    if options.json {
        say!("{json}");
        return Ok(ExitCode::SUCCESS);
    }
    print(&found);
    say!("{}: stiffness.csv, stiffness.json, and for ROSS a file a load", shown(&out));
    Ok(ExitCode::SUCCESS)
}

fn stem(options: &Options) -> String {
    let stem = options.scene.as_deref().and_then(std::path::Path::file_stem);
    stem.map_or("singh2014".to_owned(), |stem| stem.to_string_lossy().into_owned())
}

/// The requested grid of loads, speeds and angles, checked.
fn grid(options: &Options, scene: &ResolvedScene) -> Result<Grid> {
    let usual = |asked: &[f64], value: f64, parts: &[f64]| {
        if asked.is_empty() { parts.iter().map(|part| part * value).collect() } else { asked.to_vec() }
    };
    let o = &scene.written.operation;
    let loads_n: Vec<f64> = usual(&options.loads_n, o.load_n, &[0.5, 1.0, 2.0]);
    let speeds_rpm: Vec<f64> = usual(&options.speeds_rpm, o.speed_rpm, &[0.25, 0.5, 1.0, 1.5, 2.0]);
    for load in &loads_n {
        ensure!(
            *load > 0.0 && load.is_finite(),
            "`--loads-n` has {load}: loads are above 0 N. A bearing without load has play, and no stiffness"
        );
    }
    for speed in &speeds_rpm {
        ensure!(
            speed.abs() <= 1e5,
            "`--speeds-rpm` has {speed}: speeds lie between -100000 and 100000 rpm, clockwise positive"
        );
    }
    let angles = options.angles;
    ensure!(
        (3..=4096).contains(&angles),
        "`--angles` is {angles}: between 3 and 4096. 64 are enough for six harmonics"
    );
    let points = loads_n.len() * speeds_rpm.len();
    ensure!(
        points <= MOST_POINTS,
        "{points} pairs of load and speed: at most {MOST_POINTS}. Take fewer loads or speeds"
    );
    let beta = options.damping_us;
    ensure!(
        (0.0..=1000.0).contains(&beta),
        "`--damping-us` is {beta}: between 0 and 1000 µs; rolling bearings have 2.5 to 25 (Krämer 1993)"
    );
    let law = match options.contact {
        None => scene.law_of_elements(),
        Some(Contact::Line) => ContactLawKind::Line,
        Some(Contact::Ball) => ContactLawKind::Ball,
        Some(Contact::Palmgren) => ContactLawKind::Palmgren,
    };
    if o.speed_rpm == o.outer_speed_rpm && options.speeds_rpm.is_empty() {
        bail!("the rings of this scene do not turn against each other: give speeds with `--speeds-rpm`");
    }
    Ok(Grid { loads_n, speeds_rpm, angles, law, damping_s: 1e-6 * beta })
}

/// Fields of the scene that the stiffness leaves out.
fn left_out(scene: &ResolvedScene) -> Vec<String> {
    let written = &scene.written;
    let mut left = Vec::new();
    if written.defect.is_some() || !written.defects.is_empty() {
        left.push(
            "the defects of this scene are left out: stiffness is that of a healthy bearing".to_owned(),
        );
    }
    if !written.housing.is_rigid() {
        left.push(
            "rings count as rigid here; the ring and housing of this scene deform and spread the load by 10 \
             to 20 % otherwise"
                .to_owned(),
        );
    }
    left
}

fn print(found: &BearingStiffness) {
    say!("{}", found.scene);
    say!("  {}", found.contact);
    say!(
        "  {} elements, clearance {:.1} µm, load on the shaft towards {}°; C = {:.1} µs × K, stated",
        found.elements,
        found.clearance_um,
        found.load_on_shaft_deg,
        1e6 * found.damping_over_stiffness_s
    );
    say!(
        "{:>9} {:>9} {:>9} {:>7} {:>9} {:>10} {:>10} {:>8} {:>8} {:>10}",
        "load",
        "speed",
        "BPFO",
        "loaded",
        "largest",
        "kxx",
        "kyy",
        "kxx range",
        "kyy range",
        "shift"
    );
    say!(
        "{:>9} {:>9} {:>9} {:>7} {:>9} {:>10} {:>10} {:>8} {:>8} {:>10}",
        "N",
        "rpm",
        "Hz",
        "",
        "N",
        "N/µm",
        "N/µm",
        "%",
        "%",
        "nm"
    );
    for p in &found.points {
        let (k, u) = (&p.stiffness_n_m, &p.shift_m);
        let range = |s: &stribeck_analysis::stiffness::Series| s.most - s.least;
        let loaded = format!("{}–{}", p.loaded[0], p.loaded[1]);
        say!(
            "{:>9} {:>9} {:>9.2} {loaded:>7} {:>9.1} {:>10.3} {:>10.3} {:>8.2} {:>8.2} {:>10.2}",
            p.load_n,
            p.speed_rpm,
            p.bpfo_hz,
            p.largest_n,
            1e-6 * k.xx.mean,
            1e-6 * k.yy.mean,
            100.0 * k.xx.variation(),
            100.0 * k.yy.variation(),
            1e9 * range(&u.x).hypot(range(&u.y))
        );
    }
    say!(
        "range: most less least over a passage of the elements, of the mean; shift: that of the shaft\u{2019}s centre"
    );
}
