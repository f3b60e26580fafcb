//! The reduced model of a scene beside the full one: the same starts by both, quantity by quantity.
//!
//! Each quantity has a limit, up to which a user of the reduced model must expect differences, and a verdict.
//! Pairs of runs have the same start, so they differ by the model and by chance, because small differences
//! grow: the waveform of one impact is chaotic, which is why accelerations are compared by the power of third
//! octaves over all starts.

mod octaves;
mod row;
mod side;
mod thirds;
mod waveform;

use serde::{Deserialize, Serialize};
use stribeck_scene::scene::{ContactSurface, Scene};
use stribeck_store::run_dir::Run;

use crate::Error;
use crate::statistic::Statistic;
use crate::summary::Event;
pub use octaves::Octaves;
pub use row::{Row, Scale};
use side::{LINES, PERIODS, Side};
use stribeck_diagnosis::words::numbers::significant;
pub use waveform::{Correlation, Peak};

/// The record is compared from here on [s]: before, both models still settle.
pub const FROM_S: f64 = 1e-3;
/// Forces are means over this time [s], a low pass that is 3 dB down at 1.8 kHz.
pub const MEAN_S: f64 = 0.25e-3;
/// Fewest means that a record must hold.
const LEAST_MEANS: usize = 4;
/// Shortest record [s].
pub const LEAST_S: f64 = FROM_S + LEAST_MEANS as f64 * MEAN_S;
/// Samples of the full model that are no farther apart than this leave its third octaves as they are [s].
/// Nodes of the seat ring above 50 kHz, and the mean over an interval of 10 µs folds a part of that down
/// (THEORY §9.1).
pub const FINE_S: f64 = 2e-6;
/// Largest difference of a third octave that is agreement [dB].
pub const BAND_LIMIT_DB: f64 = 1.5;
/// Systems count processor time in ticks of this length [s].
const TICK_S: f64 = 0.01;

/// The models of one scene beside each other; contents of `validation.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Agreement {
    /// Name of the scene.
    pub scene: String,
    /// Hash of the scene with the reduced model.
    pub scene_hash: String,
    /// Pairs of runs.
    pub starts: usize,
    /// Time on record [ms].
    pub simulated_ms: f64,
    /// Time step of the reduced model [µs].
    pub step_us: f64,
    /// Processor time of a simulated millisecond [s], the median over the starts: full, reduced.
    pub cpu_s_per_ms: [f64; 2],
    /// Every quantity.
    pub rows: Vec<Row>,
    /// Third octaves of every sensor.
    pub sensors: Vec<Octaves>,
    /// How alike the waveforms of the first sensor are.
    #[serde(default)]
    pub correlations: Vec<Correlation>,
    /// Largest accelerations of every sensor.
    #[serde(default)]
    pub peaks: Vec<Peak>,
    /// Quantities that could not be compared, with the reason.
    pub notes: Vec<String>,
}

impl Agreement {
    /// Of pairs of runs, full and reduced, of the same starts of `scene`.
    ///
    /// # Errors
    /// [`Error::NoSignal`] without a pair or when records are too short, [`Error::Signal`] when one cannot be
    /// processed.
    pub fn of(scene: &Scene, pairs: &[[Run; 2]]) -> Result<Self, Error> {
        let Some([_, first]) = pairs.first() else {
            return Err(Error::NoSignal("no pair of runs".to_owned()));
        };
        let mut sides = Vec::new();
        for [full, reduced] in pairs {
            let interval_s = full.info.interval_s.max(reduced.info.interval_s);
            sides.push([Side::of(full, interval_s)?, Side::of(reduced, interval_s)?]);
        }
        let sensors = octaves::of_sensors(&sides);
        let lines: Vec<Row> = (0..LINES).filter_map(|n| line(n, &sides)).collect();
        let notes = [
            fold_down_note(pairs[0][0].info.interval_s),
            (scene.contact.surface == ContactSurface::Arc).then(|| TONE_OF_ARCS.to_owned()),
            sides[0][0].centres_hz.is_empty().then(octaves_note),
            lines.is_empty().then(|| lines_note(sides[0][0].summary.kinematics.expected_bpfo_hz)),
        ];
        let mut rows: Vec<Row> = [
            forces(&sides),
            share("load", "mean load on the rollers", 0.1, &sides, |s| Some(s.support_n)),
            share("cage", "speed of the cage", 0.2, &sides, |s| s.summary.kinematics.cage_hz),
        ]
        .into_iter()
        .flatten()
        .collect();
        rows.extend(events(&sides));
        rows.extend(sensors.iter().filter_map(Octaves::row));
        rows.extend(lines);
        let cost = |which: usize| {
            let all: Vec<f64> = sides.iter().map(|pair| pair[which].cpu_s_per_ms).collect();
            Statistic::of(&all, all.len()).map_or(f64::NAN, |s| s.median)
        };
        Ok(Self {
            scene: scene.name.clone(),
            scene_hash: scene.hash(),
            starts: pairs.len(),
            simulated_ms: sides[0][1].summary.run.simulated_ms,
            step_us: 1e6 * first.info.time_step_s,
            cpu_s_per_ms: [cost(0), cost(1)],
            rows,
            sensors,
            correlations: waveform::BELOW_HZ
                .into_iter()
                .filter_map(|hz| waveform::correlated(hz, &sides))
                .collect(),
            peaks: waveform::peaks(&sides),
            notes: notes
                .into_iter()
                .flatten()
                .chain(
                    first.info.warnings.iter().map(|warning| format!("the reduced model warns: {warning}")),
                )
                .collect(),
        })
    }

    /// Processor time of a simulated millisecond in words: by the full model, by the reduced one, and their
    /// ratio. A time below one tick of the clock is given as a bound.
    pub fn cost(&self) -> [String; 3] {
        let tick_s = TICK_S / self.simulated_ms;
        let [full, reduced] = self.cpu_s_per_ms;
        let said = |cost_s: f64, digits: usize| match cost_s < tick_s {
            true => format!("less than {} s", significant(tick_s, 2)),
            false => format!("{cost_s:.digits$} s"),
        };
        let times = match (full < tick_s, reduced < tick_s) {
            (true, _) => "too little to compare".to_owned(),
            (false, true) => format!("more than {:.0} times less", (full / tick_s).floor()),
            (false, false) => format!("{:.0} times less", full / reduced),
        };
        [said(full, 3), said(reduced, 4), times]
    }

    /// Rows that do not keep their limit.
    pub fn failures(&self) -> impl Iterator<Item = &Row> {
        self.rows.iter().filter(|row| row.decided && !row.within)
    }

    /// Rows for which the starts do not suffice for a verdict.
    pub fn open(&self) -> impl Iterator<Item = &Row> {
        self.rows.iter().filter(|row| !row.decided)
    }
}

/// Where levels of a quiet bearing differ by the full model's mesh.
const TONE_OF_ARCS: &str = "on arcs the nodes of the full model's raceways make a tone that the reduced model \
    does not have (THEORY §9.6): in a bearing without impacts levels of the full model are its mesh's";

/// A note where samples of the full model lie so far apart that aliases enter its third octaves; `None`
/// elsewhere.
fn fold_down_note(sampled_s: f64) -> Option<String> {
    (sampled_s > 1.01 * FINE_S).then(|| {
        format!(
            "samples of the full model every {:.3} µs fold down what nodes ring with above {:.0} kHz, at the \
             seat above all: its third octaves are higher than they should be. A shorter record is sampled \
             every {:.0} µs",
            1e6 * sampled_s,
            5e-4 / sampled_s,
            1e6 * FINE_S
        )
    })
}

/// Which records hold third octaves.
fn octaves_note() -> String {
    let [first_ms, all_ms] = thirds::shortest_records_ms();
    format!(
        "third octaves are compared on records of {first_ms:.1} ms at least, all of them of {all_ms:.0} ms"
    )
}

/// Which records hold lines of BPFO.
fn lines_note(bpfo_hz: f64) -> String {
    format!(
        "lines of BPFO are compared on records of {PERIODS:.0} periods: {:.0} ms",
        1e3 * PERIODS / bpfo_hz
    )
}

/// Statistic of the finite values among those of `of` starts.
fn over_starts(values: impl Iterator<Item = Option<f64>>, of: usize) -> Option<Statistic> {
    let there: Vec<f64> = values.flatten().filter(|v| v.is_finite()).collect();
    Statistic::of(&there, of)
}

/// Root mean square, over rollers and time, of the difference of forces, over the largest force [-].
fn forces(sides: &[[Side; 2]]) -> Option<Row> {
    let off = |[full, reduced]: &[Side; 2]| {
        let (mut sum, mut count) = (0.0, 0.0);
        for (a, b) in full.forces.iter().zip(&reduced.forces) {
            for component in 0..2 {
                for (a, b) in a[component].iter().zip(&b[component]) {
                    (sum, count) = (sum + (a - b).powi(2), count + 0.5);
                }
            }
        }
        Some(100.0 * (sum / f64::max(count, 1.0)).sqrt() / full.largest_n)
    };
    let difference = over_starts(sides.iter().map(off), sides.len())?;
    let quantity = format!("forces on the rollers, rms, means over {:.2} ms", 1e3 * MEAN_S);
    Some(Row::of_starts("forces_percent".to_owned(), quantity, Scale::OfLargestForce, difference, 1.0))
}

/// A relative difference [%].
fn share(
    name: &str,
    quantity: &str,
    limit: f64,
    sides: &[[Side; 2]],
    of: impl Fn(&Side) -> Option<f64>,
) -> Option<Row> {
    let off = |[full, reduced]: &[Side; 2]| Some(100.0 * (of(reduced)? / of(full)? - 1.0));
    let difference = over_starts(sides.iter().map(off), sides.len())?;
    Some(Row::of_starts(format!("{name}_percent"), quantity.to_owned(), Scale::Relative, difference, limit))
}

/// When rollers unload and reload.
fn events(sides: &[[Side; 2]]) -> Vec<Row> {
    const LIMIT_MS: f64 = 0.05;
    let mut rows = Vec::new();
    let Some([full, _]) = sides.first() else { return rows };
    for (n, event) in full.summary.events.iter().enumerate() {
        let twice = full.summary.events[..n].iter().filter(|e| e.roller == event.roller).count();
        let again = if twice > 0 { format!(", passage {}", twice + 1) } else { String::new() };
        let suffix = if twice > 0 { format!("_{}", twice + 1) } else { String::new() };
        type Of = fn(&Event) -> Option<f64>;
        let kinds: [(&str, Of); 2] = [("unloads", |e| e.entry_ms), ("reloads", |e| e.exit_ms)];
        for (what, of) in kinds {
            let off = |[full, reduced]: &[Side; 2]| {
                let at =
                    |s: &Side| of(s.summary.events.iter().filter(|e| e.roller == event.roller).nth(twice)?);
                Some(at(reduced)? - at(full)?)
            };
            let Some(difference) = over_starts(sides.iter().map(off), sides.len()) else { continue };
            let name = format!("roller_{}{suffix}_{what}_ms", event.roller);
            let quantity = format!("roller {} {what}{again}", event.roller);
            rows.push(Row::of_starts(name, quantity, Scale::EventTime, difference, LIMIT_MS));
        }
    }
    rows
}

/// A line of BPFO at the first sensor.
fn line(number: usize, sides: &[[Side; 2]]) -> Option<Row> {
    let of = |s: &Side| s.lines_g.as_ref()?.get(number).copied();
    let order = number + 1;
    share(&format!("bpfo_{order}"), &format!("line at {order} × BPFO, first sensor, y"), 10.0, sides, of)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A short run of the reduced model took no tick of the clock, and its page said that it takes "inf times
    /// less".
    #[test]
    fn issue_less_than_a_tick_of_the_clock_is_no_division_by_zero() {
        let of = |cpu_s_per_ms| {
            let agreement = Agreement {
                scene: String::new(),
                scene_hash: String::new(),
                starts: 1,
                simulated_ms: 5.0,
                step_us: 2.0,
                cpu_s_per_ms,
                rows: Vec::new(),
                sensors: Vec::new(),
                correlations: Vec::new(),
                peaks: Vec::new(),
                notes: Vec::new(),
            };
            agreement.cost()
        };
        assert_eq!(of([0.8, 0.004]), ["0.800 s", "0.0040 s", "200 times less"]);
        assert_eq!(of([0.8, 0.0]), ["0.800 s", "less than 0.002 s", "more than 400 times less"]);
        assert_eq!(of([0.0, 0.0])[2], "too little to compare");
    }
}
