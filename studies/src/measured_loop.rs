//! `cargo xtask study loop`: measured spalls, their lengths, and whether simulated spalls of these lengths
//! have the signature of the measured ones.

use std::f64::consts::PI;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use stribeck_theory::catalogue::CatalogueBearing;

use crate::analyse::{Found, analyse, median, passages, put_length};
use crate::{Flags, Host, Rows, Runner, Variant};

/// Flags of `study loop`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[command(flatten)]
    flags: Flags,
    /// Folder of the records of HIT-SM (`OR5_900.mat` …), or one that holds it as `hit-sm`
    #[arg(value_name = "FOLDER")]
    folder: Option<PathBuf>,
}

/// Fields that all runs share.
const SCENE: &str = "fixtures/scenes/studies/loop.ron";
const BEARING: &str = "6205";
/// Sample rate of the records [Hz].
const RATE_HZ: f64 = 51_200.0;
/// Raceways: in file names, in scenes, the family of their defects, and their diameters [mm].
const RACEWAYS: [(&str, &str, &str, f64); 2] =
    [("OR", "outer", "BPFO", 46.98), ("IR", "inner", "BPFI", 31.10)];
/// Speeds of the shaft [1/min].
const SPEEDS: [u32; 3] = [600, 900, 1200];
/// Sizes of the spalls [° of arc].
const SIZES: [u32; 3] = [2, 5, 8];
/// Speed at which the loop is closed [1/min].
const LOOPED_RPM: u32 = 900;
/// Time simulated, in turns of the shaft: six hold 22 passages, too few for a second event to show for
/// certain.
const TURNS: f64 = 24.0;
/// How far the simulated spacing may be from the measured one.
const ALLOWED: f64 = 0.05;

/// A measured record, or a simulated one that stands for it.
struct Pass {
    /// Of the measured record.
    name: String,
    raceway: usize,
    /// Length of the simulated spall [mm].
    length_mm: f64,
    /// Findings on the measured record.
    measured: Found,
    /// Time between the events of the simulated sensor's record [s], or why there is none.
    simulated_s: Result<f64, String>,
    /// Time from unloading to loading of simulated elements, the median [s].
    by_load_s: Option<f64>,
}

pub(crate) fn measure(options: &Options, host: &Host, rows: &mut Rows) -> Result<()> {
    let folder = options.folder.as_ref().context("give the folder of the records of HIT-SM")?;
    let within = folder.join("hit-sm");
    let folder = if within.is_dir() { &within } else { folder };
    let first = folder.join("OR2_600.mat");
    ensure!(
        first.exists(),
        "`{}` is not there: give the folder of the HIT-SM records, github.com/hitwzc/Bearing-datasets",
        first.display()
    );
    let out = host.root().join("runs/study/loop");
    let mut first = lengths(host, folder, &out, rows)?;
    let runner = Runner::new("loop", &options.flags, host);
    simulate(&runner, &out, &mut first, "first", rows)?;
    // A spall longer by the path of the contact in the missing time.
    let again = |pass: Pass| {
        let missing_s = pass.measured.spacing_s? - pass.simulated_s.as_ref().ok()?;
        let elements = CatalogueBearing::parse(BEARING).ok()?.elements?;
        let speed_mm_s = PI * RACEWAYS[pass.raceway].3 * pass.measured.hz? / f64::from(elements);
        Some(Pass { length_mm: pass.length_mm + speed_mm_s * missing_s, ..pass })
    };
    let mut second: Vec<Pass> = first.into_iter().filter_map(again).collect();
    simulate(&runner, &out, &mut second, "second", rows)
}

/// Estimated lengths beside the true ones; the records of which a spall is simulated.
fn lengths(host: &Host, folder: &Path, out: &Path, rows: &mut Rows) -> Result<Vec<Pass>> {
    let (mut passes, mut errors, mut covered, mut unordered) = (Vec::new(), Vec::new(), 0, 0);
    for (raceway, (letters, _, family, diameter_mm)) in RACEWAYS.into_iter().enumerate() {
        for rpm in SPEEDS {
            let mut estimates = Vec::new();
            for size in SIZES {
                let name = format!("{letters}{size}_{rpm}");
                let words = [
                    format!("--rate-hz={RATE_HZ}"),
                    format!("--bearing={BEARING}"),
                    format!("--speed-rpm={rpm}"),
                ];
                let file = folder.join(format!("{name}.mat"));
                let found = analyse(host, &file, &words, &out.join(format!("{name}-measured")), family)?;
                let truth_mm = f64::from(size) / 360.0 * PI * diameter_mm;
                put_length(rows, &name, truth_mm, found.spall_mm);
                rows.word("lengths", &name, "claimed", &found.claimed.join(" + "));
                let Some([value, low, high]) = found.spall_mm else { continue };
                estimates.push(value);
                errors.push((value / truth_mm - 1.0).abs());
                covered += usize::from((low..=high).contains(&truth_mm));
                // Only lengths from a second event have a spacing.
                if rpm == LOOPED_RPM && found.spacing_s.is_some() {
                    let simulated_s = Err("not run".to_owned());
                    passes.push(Pass {
                        name,
                        raceway,
                        length_mm: value,
                        measured: found,
                        simulated_s,
                        by_load_s: None,
                    });
                }
            }
            let ordered = estimates.len() == SIZES.len() && estimates.is_sorted_by(|a, b| a < b);
            unordered += usize::from(!ordered);
        }
    }
    let values = [
        ("median error", median(errors)),
        ("covered", Some(covered as f64)),
        ("unordered", Some(unordered as f64)),
    ];
    rows.values("all lengths", "all", values);
    Ok(passes)
}

/// Runs the scenes of one pass, analyses what their sensors recorded, and adds it to the rows.
fn simulate(runner: &Runner<'_>, out: &Path, passes: &mut [Pass], name: &str, rows: &mut Rows) -> Result<()> {
    let rpm = LOOPED_RPM;
    let variant = |pass: &Pass| {
        Variant::new(format!("{}-{name}", pass.name), SCENE, &[])
            .with(format!("operation.speed_rpm={rpm}"))
            .with(format!("solver.duration_ms={}", TURNS * 60_000.0 / f64::from(rpm)))
            .with(format!("defect.ring={}", RACEWAYS[pass.raceway].1))
            .with(format!("defect.length_mm={:.3}", pass.length_mm))
    };
    let variants: Vec<Variant> = passes.iter().map(variant).collect();
    let runs = runner.run(&variants)?;
    let mut closed = 0;
    for (pass, variant) in passes.iter_mut().zip(&variants) {
        let Some(run) = runs.iter().find(|run| run.variant.name == variant.name) else { continue };
        (pass.simulated_s, pass.by_load_s) = match &run.summary {
            Err(why) => (Err(why.clone()), None),
            Ok(_) => {
                let folder = out.join(format!("{}-simulated", variant.name));
                let found = analyse(runner.host, &run.folder, &[], &folder, RACEWAYS[pass.raceway].2)?;
                let none = if found.claimed.is_empty() { "no defect is claimed" } else { "no second event" };
                (found.spacing_s.ok_or_else(|| none.to_owned()), passages(run).1)
            }
        };
        let (measured_s, simulated_s) = (pass.measured.spacing_s, pass.simulated_s.as_ref().ok().copied());
        let off = simulated_s.zip(measured_s).map(|(simulated, measured)| simulated / measured - 1.0);
        closed += usize::from(off.is_some_and(|off| off.abs() <= ALLOWED));
        let values = [
            ("length mm", Some(pass.length_mm)),
            ("measured spacing s", measured_s),
            ("simulated spacing s", simulated_s),
            ("by load s", pass.by_load_s),
            ("off", off),
        ];
        rows.values("loop", &variant.name, values);
        if let Err(why) = &pass.simulated_s {
            rows.word("loop", &variant.name, "why", why);
        }
    }
    rows.value("closed", name, "closed", closed as f64);
    rows.value("closed", name, "of", passes.len() as f64);
    Ok(())
}
