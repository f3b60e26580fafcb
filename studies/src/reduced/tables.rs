//! The tables of the page, one function each.

use stribeck_analysis::agreement::{BAND_LIMIT_DB, Octaves, Row, Scale};

use super::Compared;
use crate::table::{figures, number};
use crate::{Finished, Sheet};

/// The scenes, and the computing time of both models.
pub(super) fn scenes(sheet: &mut Sheet, all: &[Compared]) {
    sheet.heading("The scenes");
    let rows: Vec<Vec<String>> = all
        .iter()
        .map(|Compared { case, words, agreement, .. }| {
            let [full_s, reduced_s] = agreement.cpu_s_per_ms;
            let changed: Vec<String> = case.set.iter().map(|set| format!("`{set}`")).collect();
            vec![
                words.clone(),
                format!("`{}`", case.scene.rsplit('/').next().unwrap_or(case.scene)),
                changed.join(", "),
                number(agreement.simulated_ms, 1),
                agreement.starts.to_string(),
                figures(full_s, 3),
                figures(reduced_s, 2),
            ]
        })
        .collect();
    let names = ["scene", "file", "changed", "ms", "starts", "full, s/ms", "reduced, s/ms"];
    sheet.table(&names, &rows);
    sheet.say(
        "The last two columns are processor time of a simulated millisecond, of as many runs side by \
        side as there were cores.",
    );
}

/// Forces on rollers, times of events, and the speed of the cage.
pub(super) fn forces(sheet: &mut Sheet, all: &[Compared]) {
    sheet.heading("Forces, events, cage");
    let of = |Compared { words, agreement, .. }: &Compared| {
        let by_name = |name: &str| agreement.rows.iter().find(|row| row.name == name);
        let events = agreement.rows.iter().filter(|row| row.scale == Scale::EventTime);
        let size = |row: &Row| row.difference.mean.abs();
        let worst = events.max_by(|a, b| size(a).total_cmp(&size(b)));
        let alike = |below_hz: f64| {
            let found = agreement.correlations.iter().find(|c| c.below_hz == below_hz);
            found.map_or(NONE.to_owned(), |c| number(c.value.mean, 3))
        };
        vec![
            words.clone(),
            by_name("forces_percent").map_or(NONE.to_owned(), |row| cell(row, 2)),
            by_name("load_percent").map_or(NONE.to_owned(), |row| cell(row, 4)),
            worst.map_or(NONE.to_owned(), |row| cell(row, 3)),
            by_name("cage_percent").map_or(NONE.to_owned(), |row| cell(row, 2)),
            alike(500.0),
            alike(2000.0),
        ]
    };
    let names = [
        "scene",
        "forces, rms, % of the largest",
        "mean load, %",
        "worst mean of unloading and reloading, ms",
        "cage, %",
        "correlation below 0.5 kHz",
        "below 2 kHz",
    ];
    sheet.table(&names, &all.iter().map(of).collect::<Vec<_>>());
    sheet.say(
        "Limits: 1 %, 0.1 %, 0.05 ms, 0.2 %. Forces are means over 0.25 ms, of every roller; correlations \
         those of the vertical acceleration \
         at the first sensor, start by start.",
    );
}

const NONE: &str = "–";

/// A mean over the starts with half its interval.
fn cell(row: &Row, decimals: usize) -> String {
    let d = &row.difference;
    let half = d.high.map_or(String::new(), |high| format!(" ± {}", number(high - d.mean, decimals)));
    marked(format!("{}{half}", number(d.mean, decimals)), row.decided && !row.within)
}

fn marked(text: String, outside: bool) -> String {
    if outside { format!("**{text}**") } else { text }
}

/// A third octave: how far it is off, with its standard error [dB].
struct Band<'a> {
    sensor: &'a str,
    hz: f64,
    off_db: f64,
    error_db: Option<f64>,
}

impl Band<'_> {
    fn all_of(octaves: &Octaves) -> impl Iterator<Item = Band<'_>> {
        octaves.centres_hz.iter().enumerate().map(|(band, &hz)| Band {
            sensor: &octaves.sensor,
            hz,
            off_db: octaves.reduced_db[band] - octaves.full_db[band],
            error_db: octaves.error_db.get(band).copied(),
        })
    }

    fn is_outside(&self) -> bool {
        self.off_db.abs() > BAND_LIMIT_DB
    }

    /// Whether that is more than chance.
    fn is_certain(&self) -> bool {
        self.error_db.is_some_and(|error| self.off_db.abs() - 2.0 * error > BAND_LIMIT_DB)
    }

    fn off(&self) -> String {
        let error = self.error_db.map_or(String::new(), |error| format!(" ± {}", number(error, 1)));
        marked(format!("{}{error}", number(self.off_db, 1)), self.is_certain())
    }

    fn place(&self) -> String {
        format!("{}, {} kHz", self.sensor, figures(1e-3 * self.hz, 2))
    }
}

/// Third octaves of all sensors.
pub(super) fn accelerations(sheet: &mut Sheet, all: &[Compared]) {
    sheet.heading("Accelerations in third octaves, 0.5 to 10 kHz");
    let mut rows = Vec::new();
    for Compared { words, agreement, .. } in all.iter().filter(|c| !c.agreement.sensors.is_empty()) {
        let bands = || agreement.sensors.iter().flat_map(Band::all_of);
        let within = bands().filter(|band| !band.is_outside()).count();
        let mut errors: Vec<f64> = bands().filter_map(|band| band.error_db).collect();
        errors.sort_by(f64::total_cmp);
        let mut row = vec![words.clone(), format!("{within} of {}", bands().count())];
        row.extend(agreement.sensors.iter().map(|sensor| {
            let farthest = Band::all_of(sensor).max_by(|a, b| a.off_db.abs().total_cmp(&b.off_db.abs()));
            farthest.map_or(NONE.to_owned(), |band| {
                format!("{} at {} kHz", band.off(), figures(1e-3 * band.hz, 2))
            })
        }));
        row.push(errors.get(errors.len() / 2).map_or(NONE.to_owned(), |error| number(*error, 2)));
        rows.push(row);
    }
    let names = [
        "scene",
        "within 1.5 dB",
        "farthest at side, dB",
        "shoulder, dB",
        "seat, dB",
        "bottom, dB",
        "median standard error, dB",
    ];
    sheet.table(&names, &rows);
    sheet.say(
        "Levels of the mean power over the starts, both components together. One band in twenty is off by \
         two standard errors by chance. \
         In a rigid housing all sensors move as one.",
    );
}

/// Lines of BPFO.
pub(super) fn lines(sheet: &mut Sheet, all: &[Compared]) {
    sheet.heading("Lines of BPFO at the first sensor");
    let row_of = |Compared { words, agreement, .. }: &Compared| {
        let of = |n: usize| agreement.rows.iter().find(|row| row.name == format!("bpfo_{n}_percent"));
        of(1)?;
        let cells = (1..=5).map(|n| of(n).map_or(NONE.to_owned(), |row| cell(row, 1)));
        Some([words.clone()].into_iter().chain(cells).collect())
    };
    let rows: Vec<Vec<String>> = all.iter().filter_map(row_of).collect();
    sheet.table(&["scene", "line 1, %", "2, %", "3, %", "4, %", "5, %"], &rows);
    sheet.say("Of records of ten passages or more. Limit: 10 %.");
}

/// Largest accelerations, which have no limit.
pub(super) fn peaks(sheet: &mut Sheet, all: &[Compared]) {
    sheet.heading("Largest accelerations below 10 kHz");
    let row_of = |Compared { words, agreement, .. }: &Compared| {
        let cells = agreement.peaks.iter().map(|peak| peak.difference().replace('-', "−"));
        [words.clone()].into_iter().chain(cells).collect()
    };
    let rows: Vec<Vec<String>> = all.iter().filter(|c| !c.agreement.peaks.is_empty()).map(row_of).collect();
    sheet.table(&["scene", "side", "shoulder", "seat", "bottom"], &rows);
    sheet.say(
        "Means of the largest of each start, with one standard error. They have no limit: each is that \
        of a single impact.",
    );
}

/// Effects that are left out, and differences that are not resolved.
pub(super) fn outside(sheet: &mut Sheet, all: &[Compared]) {
    sheet.heading("What is not kept, and what cannot be told");
    let mut rows = Vec::new();
    for Compared { words, agreement, .. } in all {
        let kept = agreement.rows.iter().filter(|row| row.decided && row.within).count();
        let failed = agreement.rows.iter().filter(|row| !row.over_bands() && row.decided && !row.within);
        let mut outside: Vec<String> =
            failed.map(|row| format!("{}: {} {}", row.quantity, cell(row, 3), row.scale.unit())).collect();
        let bands = || agreement.sensors.iter().flat_map(Band::all_of).filter(Band::is_outside);
        let of_band = |band: Band<'_>| format!("{}: {} dB", band.place(), band.off());
        outside.extend(bands().filter(Band::is_certain).map(of_band));
        let mut open: Vec<String> = agreement
            .open()
            .filter(|row| !row.over_bands() && !row.within)
            .map(|row| format!("{}: {} {}", row.quantity, cell(row, 3), row.scale.unit()))
            .collect();
        open.extend(bands().filter(|band| !band.is_certain()).map(of_band));
        let said = |list: Vec<String>| if list.is_empty() { NONE.to_owned() } else { list.join("; ") };
        rows.push(vec![
            words.clone(),
            format!("{kept} of {}", agreement.rows.len()),
            said(outside),
            said(open),
        ]);
    }
    let names = [
        "scene",
        "kept for certain, of all quantities",
        "outside its limit",
        "beyond it, by no more than chance may do",
    ];
    sheet.table(&names, &rows);
    sheet.say(
        "Third octaves of a sensor are one quantity, and kept when each of their bands is. Over ten passages \
         the difference of the cages has \
         its time: rollers come the later, the farther they are behind. What the reduced model leaves out is \
         in \
         THEORY §9.6; of the NU 205 the band at 3.2 kHz holds the tone of the full model\u{2019}s mesh, \
         which it has not.",
    );
}

/// Energy imbalance of long runs.
pub(super) fn balance(sheet: &mut Sheet, ledgers: &[Finished]) {
    sheet.heading("Energy over seconds");
    let row_of = |run: &Finished| {
        let (summary, info) = run.numbers().zip(run.info.as_ref())?;
        let energy = &summary.energy;
        Some(vec![
            number(info.simulated_s, 0),
            figures(1e6 * info.time_step_s, 1),
            figures(100.0 * energy.max_relative_error, 2),
            energy.share_of_heat.map_or(NONE.to_owned(), |share| figures(100.0 * share, 2)),
            figures(info.loop_cpu_s / info.simulated_s, 2),
        ])
    };
    let rows: Vec<Vec<String>> = ledgers.iter().filter_map(row_of).collect();
    let names = [
        "simulated, s",
        "step, µs",
        "missing, % of the peak strain energy",
        "missing, % of the heat",
        "processor time, s a simulated second",
    ];
    sheet.table(&names, &rows);
    sheet.say(
        "`reduced.ron` with samples every 100 µs. The error of the step adds up with the heat, and \
        goes as the square of the step.",
    );
    for run in ledgers {
        let energy = run.numbers().map(|summary| &summary.energy);
        sheet.value("energy", &run.variant.name, "of strain energy", energy.map(|e| e.max_relative_error));
        sheet.value("energy", &run.variant.name, "of heat", energy.and_then(|e| e.share_of_heat));
    }
}

/// Every number.
pub(super) fn values(sheet: &mut Sheet, all: &[Compared]) {
    for Compared { name, agreement, .. } in all {
        for row in &agreement.rows {
            let d = &row.difference;
            sheet.value("difference", name, &row.name, Some(d.mean));
            sheet.value("low", name, &row.name, d.low);
            sheet.value("high", name, &row.name, d.high);
        }
        for band in agreement.sensors.iter().flat_map(Band::all_of) {
            let what = format!("octave_{}_{:.0}_hz_db", band.sensor, band.hz);
            sheet.value("difference", name, &what, Some(band.off_db));
            sheet.value("error", name, &what, band.error_db);
        }
        for peak in &agreement.peaks {
            let (off, error) = peak.difference_percent();
            let what = format!("peak_{}_percent", peak.sensor);
            sheet.value("difference", name, &what, Some(off));
            sheet.value("error", name, &what, error);
        }
        for (which, seconds) in ["full", "reduced"].into_iter().zip(agreement.cpu_s_per_ms) {
            sheet.value("processor_s_per_ms", name, which, Some(seconds));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_hand_a_band_is_outside_where_two_standard_errors_leave_no_other_answer() {
        let band = |off_db, error_db| Band { sensor: "seat", hz: 6349.6, off_db, error_db };
        let sure = band(-2.9, Some(0.6));
        assert!(sure.is_outside() && sure.is_certain());
        assert_eq!((sure.off(), sure.place()), ("**−2.9 ± 0.6**".to_owned(), "seat, 6.3 kHz".to_owned()));
        let chance = band(-1.9, Some(0.7));
        assert!(chance.is_outside() && !chance.is_certain());
        assert_eq!(chance.off(), "−1.9 ± 0.7");
        // One start has no scatter, and decides nothing.
        assert!(!band(9.0, None).is_certain());
    }
}
