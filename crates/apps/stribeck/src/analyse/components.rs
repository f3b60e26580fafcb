//! `stribeck analyse --component`: several bearings and gears in one record.

use std::path::Path;
use std::process::ExitCode;

use anyhow::{Result, ensure};
use stribeck_diagnosis::sources;
use stribeck_report::write_sources;
use stribeck_store::run_dir::check_folder;

use super::{Options, add_zone, default_folder, print_families};
use crate::out::say;
use crate::place::{Place, shown};

/// Analyses a record for the components of the command line.
pub(super) fn run(options: &Options, place: &Place) -> Result<ExitCode> {
    let [file] = &options.files[..] else {
        anyhow::bail!(
            "`--component` takes one record at a time, and {} were given: analyse them one by one",
            options.files.len()
        );
    };
    let out = options.out.clone().unwrap_or_else(|| default_folder(file));
    check_folder(&out, &["findings.json"])?;
    let read = super::reading::read(file, &options.reading, place)?;
    ensure!(
        read.machine.speed_rpm.is_some(),
        "no speed is known of the shaft whose ratio is 1: give `--speed-rpm`, or `--tacho` with the channel \
         of a tachometer"
    );
    let mut found = sources::analyse(&read.signal, read.rate_hz, &read.machine, &options.components)?;
    for (_, analysis) in &mut found.bearings {
        analysis.findings.notes.splice(0..0, read.notes.iter().cloned());
        add_zone(options, analysis);
    }
    let name = file.file_name().map_or_else(|| "record".into(), |n| n.to_string_lossy());
    write_sources(&out, &name, &options.components, &found)?;
    if options.json {
        say!("{}", std::fs::read_to_string(Path::new(&out).join("findings.json"))?.trim_end());
        return Ok(ExitCode::SUCCESS);
    }
    for (component, analysis) in &found.bearings {
        say!("{component}: {}", analysis.findings.verdict);
        print_families(analysis);
    }
    say!("report: {}", shown(&out.join("report.html")));
    Ok(ExitCode::SUCCESS)
}
