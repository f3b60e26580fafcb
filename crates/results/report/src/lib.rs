//! The page of a run: figures, tables and words in one file that needs no network.
//!
//! [`write()`] turns a run directory into `report.html`, `summary.json` and `figures/`. The numbers are those
//! of [`stribeck_analysis`]; nothing is concluded here, and nothing simulates. The same directory gives the
//! same bytes.
//!
//! ```no_run
//! let summary = stribeck_report::write("runs/singh2014".as_ref())?;
//! for tone in summary.tones.iter().filter(|tone| tone.level_g.is_some()) {
//!     println!("{}: {} no. {} at {:?} Hz", tone.sensor, tone.name, tone.harmonic, tone.measured_hz);
//! }
//! # Ok::<(), stribeck_report::Error>(())
//! ```
//!
//! | page of | function | files |
//! |---|---|---|
//! | a run, or a stretch of it | [`write()`], [`write_between`] | `report.html`, `summary.json`, `figures/` |
//! | many starts of a scene | [`write_ensemble`] | `report.html`, `summary.json`, `figures/` |
//! | the reduced model beside the full one | [`write_agreement`] | `report.html`, `validation.json` |
//! | runs, ensembles and records beside each other | [`write_comparison`] | `report.html`, `compare.json` |
//! | a campaign | [`write_campaign`] | `index.html` |
//! | the smallest spall that is found | [`write_detection`] | `report.html` |
//! | a measured record | [`write_measured`] | `report.html`, `findings.json` |
//! | a series of measured records | [`write_series`] | `report.html`, `findings.json` |
//! | either on one sheet of paper | [`write_brief`], [`write_series_brief`] | `verdict.html` |
//! | several channels of one machine | [`write_joint`] | `joint.html`, `joint.json` |
//!
//! [`plot`] draws figures of any signal, for a page (zoomable) and for a document (SVG, PNG). The page of a
//! run is the folder `run`: a file or folder a section, in the order of the page. The sentence under its title
//! is in `run/lead.rs`, the paragraphs after it in `run/answer.rs`. It is a crate because a program that needs
//! the numbers alone links no plotting library.

pub mod plot;

mod page;

mod element_words;
mod field_words;

mod course;
mod kurtogram;
mod sound;

mod run;

mod agreement;
mod brief;
mod campaign;
mod comparison;
mod detection;
mod ensemble;
mod joint;
mod measured;
mod series;
mod sources;

mod error;

pub use agreement::write_agreement;
pub use brief::{SHEET, write_brief, write_series_brief};
pub use campaign::{CampaignIndex, write_campaign};
pub use comparison::{
    MOST_COMPARED, answer as comparison_in_words, by_chance, difference, mean, write_comparison,
};
pub use detection::write_detection;
pub use ensemble::write_ensemble;
pub use error::Error;
pub use joint::write_joint;
pub use measured::{Baseline, findings_schema, write_measured};
pub use run::{write, write_between};
pub use series::{SeriesFindings, SeriesRecord, write_series};
pub use sources::{SourceFindings, SourcesFindings, write_sources};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
