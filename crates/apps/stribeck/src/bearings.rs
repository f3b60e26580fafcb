//! `stribeck bearings`: the bearings that a scene or a measured record can name.

use std::process::ExitCode;

use anyhow::{Result, anyhow};
use serde_json::{Value, json};
use stribeck_scene::catalogue;
use stribeck_theory::catalogue::{CatalogueBearing, beyond_a_plane, plain};

use crate::out::say;

/// Flags of `bearings`.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// A bearing by name, or by name and numbers as in "NU 205, elements=13"; the beginning of names, as NU
    /// or 62, lists those [default: all that have a name]
    name: Option<String>,
    /// Writes them as JSON
    #[arg(long)]
    json: bool,
}

/// Remedy where a name is unknown.
const NUMBERS: &str = "give its numbers, `\"elements=9, diameter_mm=7.94, pitch_mm=39.04, angle_deg=0\"`";

pub(crate) fn run(options: &Options) -> Result<ExitCode> {
    let all = match &options.name {
        None => catalogue::known().map_err(|why| anyhow!(why))?,
        Some(name) => match catalogue::parse_or_advise(name, NUMBERS) {
            Ok(bearing) if options.json => return print(&as_json(&bearing)),
            Ok(bearing) => {
                one(&bearing);
                return Ok(ExitCode::SUCCESS);
            }
            Err(why) => match catalogue::beginning_with(name).map_err(|why| anyhow!(why))? {
                none if none.is_empty() => return Err(anyhow!(why)),
                some => some.into(),
            },
        },
    };
    if options.json {
        return print(&all.iter().map(as_json).collect());
    }
    list(&all);
    Ok(ExitCode::SUCCESS)
}

fn print(json: &Value) -> Result<ExitCode> {
    say!("{}", serde_json::to_string_pretty(json)?);
    Ok(ExitCode::SUCCESS)
}

/// Frequencies of defects in multiples of the shaft's, `null` where the number of elements is not known.
fn as_json(bearing: &CatalogueBearing) -> Value {
    let [diameter_mm, pitch_mm] = bearing.shown_mm();
    let orders = bearing.orders().ok();
    json!({
        "name": bearing.name,
        "elements": bearing.elements,
        "diameter_mm": diameter_mm,
        "pitch_mm": pitch_mm,
        "angle_deg": bearing.angle_deg,
        "bore_mm": bearing.boundary.map(|b| b.bore_mm),
        "outside_mm": bearing.boundary.map(|b| b.outside_mm),
        "width_mm": bearing.boundary.map(|b| b.width_mm),
        "bpfo": orders.as_ref().map(|o| o.bpfo),
        "bpfi": orders.as_ref().map(|o| o.bpfi),
        "bsf": orders.as_ref().map(|o| o.bsf),
        "ftf": orders.as_ref().map(|o| o.ftf),
        "source": bearing.source,
    })
}

fn list(bearings: &[CatalogueBearing]) {
    say!(
        "{:<9} {:>5} {:>9} {:>9} {:>6} {:>15} {:>7} {:>7} {:>7} {:>7}",
        "name",
        "count",
        "element",
        "pitch",
        "angle",
        "bore out width",
        "BPFO",
        "BPFI",
        "BSF",
        "FTF"
    );
    for bearing in bearings {
        say!("{}", row(bearing));
    }
    say!(
        "Lengths in mm; frequencies in multiples of the shaft\u{2019}s, outer ring at rest. `?`: makers fit \
         different numbers; a scene assumes one and says so. `stribeck bearings NAME` says where the numbers are \
         from; `bearings.ron` in the working folder adds your own."
    );
}

fn row(bearing: &CatalogueBearing) -> String {
    let count = bearing.elements.map_or("?".to_owned(), |n| n.to_string());
    let boundary = bearing
        .boundary
        .map_or("?".to_owned(), |b| format!("{} × {} × {}", b.bore_mm, b.outside_mm, b.width_mm));
    let orders = bearing.orders().map_or_else(
        |_| String::new(),
        |o| format!(" {:>7.4} {:>7.4} {:>7.4} {:>7.4}", o.bpfo, o.bpfi, o.bsf, o.ftf),
    );
    let [diameter, pitch] = bearing.shown_mm();
    format!(
        "{:<9} {count:>5} {diameter:>9} {pitch:>9} {:>5}° {boundary:>15}{orders}",
        bearing.name, bearing.angle_deg
    )
}

fn one(bearing: &CatalogueBearing) {
    say!("{}: {bearing}", bearing.name);
    if let Some(b) = bearing.boundary {
        say!("  bore {} mm, outside {} mm, width {} mm", b.bore_mm, b.outside_mm, b.width_mm);
    }
    match bearing.orders() {
        Ok(o) => say!(
            "  BPFO {:.4}, BPFI {:.4}, BSF {:.4} (a spot strikes twice as often), FTF {:.4} times the \
             shaft\u{2019}s frequency",
            o.bpfo,
            o.bpfi,
            o.bsf,
            o.ftf
        ),
        Err(_) => say!(
            "  makers fit different numbers of rolling elements: count them, and give `\"{}, elements=…\"`",
            bearing.name
        ),
    }
    say!("  source: {}", bearing.source);
    if let Some(why) = beyond_a_plane(&plain(&bearing.name)).filter(|_| bearing.boundary.is_none()) {
        say!("  its frequencies alone: it is {why}");
    }
}
