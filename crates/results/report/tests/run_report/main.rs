//! A run of closed forms through the whole report: every number must come back, and every figure must be
//! there, and be drawn.

mod drawings;
mod numbers;
mod page;
mod paper;
mod records;
mod schemas;
#[path = "../synthetic/mod.rs"]
mod synthetic;

use std::fs;
use std::path::Path;

use stribeck_analysis::summary::Summary;
use stribeck_report as report;
use stribeck_store::run_info::Status;
use stribeck_testing::Scratch;

/// The whole record of the paper, 30 ms at 100 kHz.
const SAMPLES: usize = 3000;

fn close(found: Option<f64>, wanted: f64, tolerance: f64, what: &str) {
    let found = found.unwrap_or_else(|| panic!("{what} is missing"));
    assert!((found - wanted).abs() <= tolerance, "{what}: {found} instead of {wanted} ± {tolerance}");
}

fn read(folder: &Path, name: &str) -> String {
    fs::read_to_string(folder.join(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
}

fn whole(name: &str) -> (Scratch, Summary) {
    let folder = Scratch::new(name);
    synthetic::write(folder.path(), Status::Complete, SAMPLES);
    let summary = report::write(folder.path()).expect("a report");
    (folder, summary)
}
