//! `cargo xtask study paper`: which reading of the paper agrees with it best, and whether its hypothesis holds.

use std::process::ExitCode;

use anyhow::Result;
use stribeck_analysis::tones;

use super::{Column, Finished, Flags, Runner, Sheet, Variant};
use crate::workspace;

/// Scene of the variants: the paper's facets, larger elements away from the raceways.
const LEAN: &str = "fixtures/scenes/lean.ron";
/// One exit, and the time from its end to the next entry.
const DURATION: &str = "solver.duration_ms=12.0";

/// Flags of `study paper`.
#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    #[command(flatten)]
    flags: Flags,
}

pub(crate) fn run(options: &Options) -> Result<ExitCode> {
    let runner = Runner::new("paper", &options.flags)?;
    let base = runner.run(&base_variants())?;
    let mut sheet = Sheet::new("paper", "What the paper leaves open");
    sheet.heading("Base case");
    sheet.runs("base", &base.iter().collect::<Vec<_>>(), &LEVELS);
    println!("{}", workspace::shown(&sheet.write()?));
    Ok(ExitCode::SUCCESS)
}

fn base_variants() -> Vec<Variant> {
    let lean = |name: &str, set: &[&str]| Variant::new(name, LEAN, set).with(DURATION);
    vec![
        lean("base", &[]),
        lean("thickness-5", &["bearing.thickness_mm=5.0"]),
        lean("thickness-10", &["bearing.thickness_mm=10.0"]),
        lean("thickness-50", &["bearing.thickness_mm=50.0"]),
        lean("rotated", &["mesh.roller_copies=rotated"]),
    ]
}

const LEVELS: [Column; 5] = [
    Column { name: "tone Hz", decimals: 1, of: |run| tone(run).and_then(|t| t.measured_hz) },
    Column { name: "tone g", decimals: 1, of: |run| tone(run).and_then(|t| t.level_g) },
    Column { name: "impulse g", decimals: 0, of: |run| run.numbers()?.levels.impulse_g },
    Column { name: "between g", decimals: 0, of: |run| run.numbers()?.levels.between_g },
    Column { name: "notched g", decimals: 0, of: |run| run.numbers()?.levels.between_filtered_g },
];

/// The strongest facet line at the leading sensor.
fn tone(run: &Finished) -> Option<&tones::Tone> {
    let summary = run.numbers()?;
    tones::dominant(&summary.tones, summary.levels.sensor.as_deref()?)
}
