//! `stribeck analyse` as studies call it: a process of its own, whose findings are read from its file.

use std::path::Path;

use anyhow::{Context, Result, ensure};
use serde_json::Value;
use stribeck_scene::scene::DefectRing;

use crate::page::decimals;
use crate::{Finished, Host, Rows};

/// Findings of `stribeck analyse` on a record.
#[derive(Debug, Clone, Default)]
pub(crate) struct Found {
    pub(crate) claimed: Vec<String>,
    /// Length of the spall from two events a passage: value, lower and upper end [mm].
    pub(crate) spall_mm: Option<[f64; 3]>,
    /// The same of a spall longer than half of the distance of two elements, in the same rhythm [mm].
    pub(crate) otherwise_mm: Option<[f64; 3]>,
    /// Time between these events [s].
    pub(crate) spacing_s: Option<f64>,
    /// Bound of the length from one event a passage [mm].
    pub(crate) below_mm: Option<f64>,
    /// Frequency of the family that is there [Hz].
    pub(crate) hz: Option<f64>,
}

/// Runs `stribeck analyse` and reads its findings.
pub(crate) fn analyse(host: &Host, file: &Path, words: &[String], out: &Path, family: &str) -> Result<Found> {
    let mut command = host.stribeck()?;
    let done = command.arg("analyse").arg(file).args(words).arg("--out").arg(out).output();
    let done = done.context("`stribeck analyse` does not start")?;
    ensure!(done.status.success(), "{}: {}", file.display(), String::from_utf8_lossy(&done.stderr).trim());
    let path = out.join("findings.json");
    let text = std::fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
    let findings: Value = serde_json::from_str(&text).context("findings.json")?;
    let families = findings["families"].as_array().cloned().unwrap_or_default();
    let name = |f: &Value| f["name"].as_str().unwrap_or_default().to_owned();
    let interval = |name: &str| {
        let [value, low, high] = ["value", "low", "high"].map(|key| findings[name][key].as_f64());
        Some([value?, low?, high?])
    };
    Ok(Found {
        claimed: families.iter().filter(|f| f["claimed"] == true).map(name).collect(),
        spall_mm: interval("spall_mm"),
        otherwise_mm: interval("spall_otherwise_mm"),
        spacing_s: findings["event_spacing_ms"].as_f64().map(|ms| 1e-3 * ms),
        below_mm: findings["spall_below_mm"].as_f64(),
        hz: families.iter().find(|f| name(f) == family).and_then(|f| f["measured_hz"].as_f64()),
    })
}

/// Of the passages over a spall on the outer raceway: how many there are, in how many the element unloads and
/// is loaded again, in how many it touches the floor; and the median time from half of its load to half of it
/// [s].
pub(crate) fn passages(run: &Finished) -> ([usize; 3], Option<f64>) {
    let events = run.numbers().map(|summary| summary.events.as_slice()).unwrap_or_default();
    let events: Vec<_> = events.iter().filter(|event| event.ring == DefectRing::Outer).collect();
    let lasted = events.iter().filter_map(|e| Some(1e-3 * (e.exit_ms? - e.entry_ms?)));
    let mut lasted: Vec<f64> = lasted.collect();
    lasted.sort_by(f64::total_cmp);
    let floor = events.iter().filter(|e| e.floor_ms.is_some()).count();
    ([events.len(), lasted.len(), floor], lasted.get(lasted.len() / 2).copied())
}

/// Adds the true length, an estimate and its interval to the rows.
pub(crate) fn put_length(rows: &mut Rows, name: &str, true_mm: f64, found: Option<[f64; 3]>) {
    rows.value("lengths", name, "true mm", true_mm);
    for (n, what) in ["estimate mm", "low mm", "high mm"].into_iter().enumerate() {
        rows.value("lengths", name, what, found.map(|all| all[n]));
    }
}

/// How far each length is off, its interval, and whether that holds the true one.
pub(crate) fn derive(rows: &mut Rows) {
    for name in rows.variants("lengths") {
        let number = |what: &str| rows.number("lengths", &name, what);
        let Some(truth) = number("true mm") else { continue };
        let off = number("estimate mm").map(|value| value / truth - 1.0);
        let ends = number("low mm").zip(number("high mm"));
        let (interval, held) = ends.map_or(("–".to_owned(), "–"), |(low, high)| {
            let held = if (low..=high).contains(&truth) { "yes" } else { "**no**" };
            (format!("{} to {}", decimals(low, 2), decimals(high, 2)), held)
        });
        rows.value("lengths", &name, "off", off);
        rows.word("lengths", &name, "interval", &interval);
        rows.word("lengths", &name, "held", held);
    }
}

/// The middle one of some numbers.
pub(crate) fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}
