//! The page of spalls that grow: findings of each record of each unit, and estimates of its remaining
//! unit.

use std::path::Path;

use maud::{DOCTYPE, Markup, html};
use serde::Serialize;
use stribeck_analysis::growth::Remaining;
use stribeck_diagnosis::words::numbers::significant;
use stribeck_store::run_dir::write_atomic;

use crate::Error;
use crate::page::{head, json};
use crate::plot::{Axis, Colour, Figure, Mark, Series};

/// Units whose spalls grow.
#[derive(Debug, Serialize)]
pub struct GrowthFindings {
    /// Name of the growth file.
    pub name: String,
    /// The quantity from which the length is estimated, in words.
    pub by: String,
    /// Units.
    pub units: Vec<UnitFindings>,
    /// Intervals that hold the true remaining life, and how many there are: one a record from the first claim
    /// on.
    pub held: [usize; 2],
    /// What limits all this.
    pub notes: Vec<String>,
}

/// One unit.
#[derive(Debug, Serialize)]
pub struct UnitFindings {
    /// Number, from 1.
    pub unit: usize,
    /// Revolutions at which the spall begins in truth.
    pub onset: f64,
    /// Revolutions at the end, in truth.
    pub end: f64,
    /// Revolutions of the first record that claims the defect and whose next one does, too.
    pub claimed_at: Option<f64>,
    /// Revolutions of the first record above the alarm of the root mean square.
    pub alarm_at: Option<f64>,
    /// That alarm [m/s²].
    pub alarm_rms: Option<f64>,
    /// Records, in order.
    pub records: Vec<RecordFindings>,
}

/// One record of a unit.
#[derive(Debug, Clone, Serialize)]
pub struct RecordFindings {
    /// Number of its run.
    pub run: usize,
    /// Revolutions.
    pub revolutions: f64,
    /// Length of the spall in truth [mm]; `null` before its onset.
    pub length_mm: Option<f64>,
    /// Depth in truth [mm].
    pub depth_mm: Option<f64>,
    /// Root mean square [m/s²].
    pub rms: Option<f64>,
    /// Kurtosis.
    pub kurtosis: Option<f64>,
    /// Level of the family of the damaged part [dB].
    pub level_db: Option<f64>,
    /// Families that are claimed in the record, joined by `+`; `none` where there are none.
    pub claimed: Option<String>,
    /// Length by the two events of a passage [mm], as `analyse` has it.
    pub spall_mm: Option<f64>,
    /// Length read from the indicator by the calibration on other units [mm].
    pub read_mm: Option<f64>,
    /// Estimated remaining life [revolutions].
    pub remaining: Option<Remaining>,
    /// True remaining life [revolutions].
    pub remaining_true: f64,
}

/// Writes `growth.html` and `growth.json` into a folder.
///
/// # Errors
/// [`Error::Run`] when a file cannot be written, [`Error::Drawing`].
pub fn write_growth(folder: &Path, findings: &GrowthFindings) -> Result<(), Error> {
    write_atomic(&folder.join("growth.json"), json(findings)?.as_bytes())?;
    write_atomic(&folder.join("growth.html"), page(findings)?.into_string().as_bytes())?;
    Ok(())
}

fn page(of: &GrowthFindings) -> Result<Markup, Error> {
    let all = figures(of).iter().map(Figure::to_html).collect::<Result<Vec<_>, _>>()?;
    let mut lives = Vec::new();
    for unit in &of.units {
        lives.push(life(unit).map(|figure| figure.to_html()).transpose()?);
    }
    let [held, among] = of.held;
    Ok(html! {
        (DOCTYPE)
        html lang="en" {
            (head(&of.name))
            body {
                h1 { (of.name) }
                p class="lead" {
                    (of.units.len()) " units, " (of.units.iter().map(|u| u.records.len()).sum::<usize>())
                    " records. Of " (among) " intervals of 90 % of what is left, " (held) " hold the truth."
                }
                h2 #units { "Units" }
                div class="scroll" { (table(of)) }
                h2 #trends { "Trends" }
                p {
                    "A curve for each unit, a point for each record. Before its onset a unit has no spall: a \
                     length that is read there, by a record that is claimed all the same, is a false one."
                }
                div class="pairs-of-figures" { @for figure in &all { (figure) } }
                h2 #left { "What is left" }
                p {
                    "Length is read from " (of.by) ", calibrated by the records of the other units, and goes on to \
                     the end by the law of growth. Shaded: the interval of 90 %; blue: its median; \
                     orange: the truth."
                }
                div class="pairs-of-figures" { @for figure in lives.iter().flatten() { (figure) } }
                h2 #notes { "Limits" }
                ul class="notes" { @for note in &of.notes { li { (note) } } }
                p {
                    a href="growth.json" { "growth.json" } " and " a href="growth.parquet" { "growth.parquet" }
                    " hold all this with the truth beside it; " a href="index.html" { "index.html" }
                    " is the index of the runs."
                }
            }
        }
    })
}

fn table(of: &GrowthFindings) -> Markup {
    let mega = |x: f64| significant(1e-6 * x, 3);
    let shown = |x: Option<f64>| x.map_or_else(|| "–".to_owned(), mega);
    html! {
        table {
            tr {
                th { "Unit" } th { "Records" } th { "Onset, in truth" } th { "Claimed twice running from" } th { "Alarm" }
                th { "End, in truth" } th { "Left at the last record" } th { "Left in truth" }
            }
            @for unit in &of.units {
                tr {
                    td { (unit.unit) } td { (unit.records.len()) } td { (mega(unit.onset)) }
                    td { (shown(unit.claimed_at)) } td { (shown(unit.alarm_at)) } td { (mega(unit.end)) }
                    @let last = unit.records.last();
                    td {
                        @match last.and_then(|record| record.remaining) {
                            None => "–",
                            Some(left) => { (mega(left.median)) " (" (mega(left.low)) " to " (mega(left.high)) ")" }
                        }
                    }
                    td { (shown(last.map(|record| record.remaining_true))) }
                }
            }
        }
        p class="hint" {
            "Millions of revolutions; intervals of 90 %. Claimed twice running: two records, one after the \
             other, that the verdict calls damaged; before the onset they are a false alarm. Alarm: the first \
             record whose root mean square lies above the limit that the unit's first three records set."
        }
    }
}

/// A quantity over the revolutions, a curve a unit.
fn figures(of: &GrowthFindings) -> Vec<Figure> {
    let curve = |id: &str, title: &str, axis: Axis, value: &dyn Fn(&RecordFindings) -> Option<f64>| {
        let over = Axis::plain("Revolutions", "million");
        let mut figure = Figure::new(id, title, over, axis);
        for (unit, colour) in of.units.iter().zip(Colour::FOREGROUNDS.into_iter().cycle()) {
            let x = unit.records.iter().map(|record| 1e-6 * record.revolutions).collect();
            let y = unit.records.iter().map(|record| value(record).unwrap_or(f64::NAN)).collect();
            figure = figure.with(Series::listed(&format!("unit {}", unit.unit), colour, x, y));
        }
        figure
    };
    vec![
        curve("length", "Length of the spall, in truth", Axis::plain("Length", "mm"), &|r| r.length_mm),
        curve("read", "Length as read", Axis::plain("Length", "mm"), &|r| r.read_mm),
        curve("level", "Level of the family", Axis::plain("Level", "dB"), &|r| r.level_db),
        curve("rms", "Root mean square", Axis::plain("RMS", "m/s²"), &|r| r.rms),
        curve("kurtosis", "Kurtosis", Axis::plain("Kurtosis", ""), &|r| r.kurtosis),
        curve("spall", "Length by two events a passage", Axis::plain("Length", "mm"), &|r| r.spall_mm),
    ]
    .into_iter()
    .filter(|figure| figure.series.iter().any(|series| series.y.iter().filter(|y| y.is_finite()).count() > 1))
    .collect()
}

/// Remaining life of one unit over the revolutions, with its interval and the truth.
fn life(unit: &UnitFindings) -> Option<Figure> {
    let told: Vec<(&RecordFindings, Remaining)> =
        unit.records.iter().filter_map(|record| Some((record, record.remaining?))).collect();
    // A single record is no curve; its numbers are in the table.
    if told.len() < 2 {
        return None;
    }
    let title = format!("Unit {}", unit.unit);
    let over = Axis::plain("Revolutions", "million");
    let mut figure =
        Figure::new(&format!("left-{}", unit.unit), &title, over, Axis::plain("Left", "million"));
    let x: Vec<f64> = told.iter().map(|(record, _)| 1e-6 * record.revolutions).collect();
    let curve = |name: &str, colour, of: &dyn Fn(&RecordFindings, &Remaining) -> f64| {
        let y = told.iter().map(|(record, left)| 1e-6 * of(record, left)).collect();
        Series::listed(name, colour, x.clone(), y)
    };
    figure = figure
        // The upper edge first: the ground between them is drawn downwards from it.
        .with(curve("95 % below", Colour::Blue, &|_, left| left.high).as_edge())
        .with(curve("5 % below", Colour::Blue, &|_, left| left.low).as_edge())
        .with(curve("median", Colour::Blue, &|_, left| left.median))
        .with(curve("truth", Colour::Orange, &|record, _| record.remaining_true));
    if let Some(at) = unit.alarm_at {
        figure.marks.push(Mark { x: 1e-6 * at, label: "alarm".into(), colour: Colour::Red, dashed: false });
    }
    Some(figure)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::Style;

    /// The interval of the remaining life was in the numbers and not in the picture: its area is filled from
    /// the upper edge downwards, and the lower one had been given first.
    #[test]
    fn issue_the_upper_edge_of_an_interval_comes_first() {
        let record = |run: usize, remaining: Option<Remaining>| RecordFindings {
            run,
            revolutions: 1e6 * run as f64,
            length_mm: Some(1.0),
            depth_mm: Some(0.1),
            rms: Some(10.0),
            kurtosis: Some(3.0),
            level_db: None,
            claimed: None,
            spall_mm: None,
            read_mm: None,
            remaining,
            remaining_true: 2e6,
        };
        let left = Remaining { median: 2e6, low: 1e6, high: 4e6 };
        let unit = UnitFindings {
            unit: 1,
            onset: 0.0,
            end: 4e6,
            claimed_at: Some(0.0),
            alarm_at: None,
            alarm_rms: None,
            records: vec![record(1, None), record(2, Some(left)), record(3, Some(left))],
        };
        let figure = life(&unit).expect("two records with something left");
        let edges: Vec<&Series> =
            figure.series.iter().filter(|series| matches!(series.style, Style::Edge)).collect();
        assert_eq!(edges.len(), 2);
        assert!(edges[0].y.iter().zip(&edges[1].y).all(|(upper, lower)| upper > lower));
    }
}
