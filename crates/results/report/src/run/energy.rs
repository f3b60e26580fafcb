//! The ledger of energy, and its imbalance.

use stribeck_store::run_dir::Run;

use crate::Error;
use crate::page::{Section, charts};
use crate::plot::{Axis, Colour, Figure, Series};

/// Rows of the ledger that are drawn, at most: of a longer one every second, or third …
const LEDGER_ROWS: usize = 1 << 21;

pub(super) fn section(run: &Run) -> Result<Section, Error> {
    Ok(Section::new("energy", "Energy")
        .folded("Is it conserved, and what takes it?")
        .figures(charts(figures(run)?), "No energy was recorded."))
}

fn figures(run: &Run) -> Result<Vec<Figure>, Error> {
    let energy = run.energy.read_thinned(LEDGER_ROWS)?;
    let Some(time) = energy.get("time_s").filter(|t| !t.is_empty()) else { return Ok(Vec::new()) };
    let parts = [
        ("kinetic_j", "kinetic", Colour::Blue),
        ("strain_j", "strain", Colour::Orange),
        ("hourglass_j", "hourglass", Colour::Brown),
        ("contact_j", "contact", Colour::Green),
        ("friction_j", "friction", Colour::Red),
        ("damping_j", "damping", Colour::Purple),
        ("contact_damping_j", "contact damping", Colour::Teal),
        ("film_j", "oil films", Colour::Pink),
        ("external_j", "supplied by load", Colour::Grey),
        ("drive_j", "supplied by drive", Colour::Black),
    ];
    let mut ledger = Figure::new(
        "energy",
        "Energy ledger, change since the start",
        Axis::si("Time", "s"),
        Axis::si("Energy", "J"),
    )
    .synced("time")
    .caption(format!(
        "What load and drive supply is found again as motion, strain and heat, but for {}.",
        run.info.energy.in_words()
    ))
    .note("Friction, damping and contact damping only grow; kinetic and strain energy go up and down.");
    for (channel, name, colour) in parts {
        if let Some(values) = energy.get(channel).filter(|v| v.iter().any(|&e| e != 0.0)) {
            let first = values.first().copied().unwrap_or(0.0);
            let change = values.iter().map(|e| e - first).collect();
            ledger = ledger.with(Series::listed(name, colour, time.to_vec(), change));
        }
    }
    Ok(vec![ledger])
}
