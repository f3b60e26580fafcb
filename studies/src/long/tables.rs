//! Numbers of a long record.

use stribeck_analysis::artefacts::{Artefact, Origin};
use stribeck_analysis::findings::Findings;
use stribeck_analysis::summary::Summary;
use stribeck_store::run_dir::Run;

use crate::Sheet;
use crate::table::number;
use stribeck_store::run_info::clock;

/// BPFO as the paper computes it and as it reads it from its trace [Hz].
const PAPER_BPFO_HZ: [f64; 2] = [90.07, 90.91];
/// Above this a length estimate belongs to another event [mm].
const ODD_SPALL_MM: f64 = 15.0;

fn cell(value: Option<f64>, decimals: usize) -> String {
    value.filter(|v| v.is_finite()).map_or("–".to_owned(), |v| number(v, decimals))
}

/// The run and its cost.
pub(super) fn cost(sheet: &mut Sheet, run: &Run, summary: &Summary) {
    let (info, cost) = (&run.info, &summary.run);
    let elements = info.mesh.quads + info.mesh.triangles;
    sheet.say(&format!(
        "Scene `{}`: {elements} elements, {:.0} ms of bearing time in {} steps of {:.2} ns, threads: {}; {} \
         after a set-up of {}, {} of \
         processor time; {:.2} ns of wall clock for one element and one step. {}, commit {}. Largest energy \
         imbalance {:.2} % of the peak \
         strain energy.",
        summary.scene,
        cost.simulated_ms,
        info.steps,
        cost.time_step_ns,
        info.threads,
        clock(info.wall_s),
        clock(info.setup_s),
        clock(info.cpu_s),
        cost.ns_per_element_step.unwrap_or(f64::NAN),
        info.machine,
        info.commit,
        100.0 * summary.energy.max_relative_error
    ));
    let gained = |column: &str| {
        let values = run.energy.channel(column).ok()??;
        Some(values.last()? - values.first()?)
    };
    if let (Some(load), Some(drive)) = (gained("external_j"), gained("drive_j")) {
        let missing = summary.energy.max_relative_error * summary.energy.peak_strain_j;
        sheet.say(&format!(
            "The imbalance is counted against the strain energy, {:.2} J at most; over this time load and \
             drive supplied {:.2} J, of which \
             it is {:.2} %.",
            summary.energy.peak_strain_j,
            load + drive,
            100.0 * missing / (load + drive).abs().max(f64::MIN_POSITIVE)
        ));
    }
    for warning in &info.warnings {
        sheet.say(&format!("Warning of the run: {warning}."));
    }
    for (quantity, value) in [
        ("elements", elements as f64),
        ("steps", info.steps as f64),
        ("time step ns", cost.time_step_ns),
        ("simulated ms", cost.simulated_ms),
        ("threads", info.threads as f64),
        ("wall s", info.wall_s),
        ("setup s", info.setup_s),
        ("cpu s", info.cpu_s),
        ("energy error", summary.energy.max_relative_error),
    ] {
        sheet.value("cost", &summary.scene, quantity, Some(value));
    }
}

/// Resolution of the spectra, and whether they are padded.
pub(super) fn resolution(sheet: &mut Sheet, findings: &Findings) {
    let Some(spectrum) = findings.sensors.first().and_then(|s| s.raw_density.as_ref()) else { return };
    let resolution = spectrum.resolution();
    sheet.heading("Resolution");
    sheet.say(&format!(
        "Welch: {resolution}. {}",
        if resolution.zero_padded {
            "The grid is finer than what is resolved."
        } else {
            "Grid and resolution are the same: nothing is padded."
        }
    ));
    sheet.value("resolution", &findings.summary.scene, "resolution Hz", Some(resolution.resolution_hz));
    sheet.value("resolution", &findings.summary.scene, "grid Hz", Some(resolution.grid_hz));
}

/// The ledger of lines at the leading sensor, and the fundamentals at every sensor.
pub(super) fn lines(sheet: &mut Sheet, findings: &Findings) {
    let summary = &findings.summary;
    let Some(sensor) = findings.sensors.first().map(|s| s.name.as_str()) else { return };
    sheet.heading("Lines and verdicts");
    sheet.say(&format!(
        "At the sensor `{sensor}`. *Predicted* is rolling without slip, *by motion* follows the recorded \
         motion of cage and rollers. A \
         line counts when it stands 10 dB above its surroundings."
    ));
    let origin = |family: Origin| match family {
        Origin::Mesh | Origin::Beat => "mesh",
        Origin::Defect => "defect",
        Origin::Ring => "ring",
    };
    let row = |a: &Artefact| {
        vec![
            origin(a.family).to_owned(),
            format!("{} ×{}", a.name.replace('_', " "), a.harmonic),
            number(a.predicted_hz, 1),
            cell(a.from_motion_hz, 1),
            cell(a.measured_hz, 1),
            cell(a.level_g, 2),
            a.verdict.clone(),
        ]
    };
    let rows: Vec<Vec<String>> = summary.artefacts.iter().map(row).collect();
    sheet.table(&["origin", "line", "predicted Hz", "by motion Hz", "measured Hz", "g", "verdict"], &rows);
    for a in &summary.artefacts {
        let name = format!("{} ×{}", a.name, a.harmonic);
        sheet.value("lines", &name, "predicted Hz", Some(a.predicted_hz));
        sheet.value("lines", &name, "measured Hz", a.measured_hz);
        sheet.value("lines", &name, "g", a.level_g);
    }
    sheet.say("Fundamentals of the facet lines at every sensor:");
    let fundamentals = summary.tones.iter().filter(|t| t.harmonic == 1);
    let rows: Vec<Vec<String>> = fundamentals
        .map(|t| {
            vec![
                t.sensor.clone(),
                t.name.replace('_', " "),
                cell(t.measured_hz, 1),
                cell(t.level_g, 2),
                cell(t.prominence_db, 0),
                if t.unresolved_from.is_empty() {
                    "by itself".to_owned()
                } else {
                    t.unresolved_from.join(", ").replace('_', " ")
                },
            ]
        })
        .collect();
    sheet.table(&["sensor", "line", "measured Hz", "g", "above surroundings dB", "merged with"], &rows);
}

/// The defect's family in the envelope.
pub(super) fn envelope(sheet: &mut Sheet, findings: &Findings) {
    sheet.heading("Envelope spectrum");
    let Some(finding) = &findings.summary.envelope else {
        let why = findings.summary.notes.iter().find(|n| n.contains("envelope"));
        sheet.say(why.map_or("There is none.", String::as_str));
        return;
    };
    sheet.say(&format!(
        "Squared envelope of {:.0} to {:.0} Hz, the whole record with a Hann window: {:.2} Hz are resolved, \
         {:.1} periods of BPFO are on \
         record. The paper computes {} Hz and reads {} Hz from its trace; without slip these dimensions give \
         {:.2} Hz, and the \
         recorded cage {} Hz.",
        finding.band_hz.0,
        finding.band_hz.1,
        finding.resolution_hz,
        finding.periods,
        PAPER_BPFO_HZ[0],
        PAPER_BPFO_HZ[1],
        findings.summary.kinematics.expected_bpfo_hz,
        cell(findings.summary.kinematics.bpfo_hz, 2)
    ));
    let rows: Vec<Vec<String>> = finding
        .lines
        .iter()
        .map(|l| {
            let name = format!("BPFO ×{}", l.harmonic);
            sheet.value("envelope", &name, "measured Hz", l.measured_hz);
            sheet.value("envelope", &name, "above background dB", l.prominence_db);
            vec![
                format!("×{}", l.harmonic),
                number(l.predicted_hz, 1),
                cell(l.measured_hz, 1),
                cell(l.prominence_db, 1),
                if l.measured_hz.is_some() { "found" } else { "not 10 dB above its background" }.to_owned(),
            ]
        })
        .collect();
    sheet.table(&["BPFO", "predicted Hz", "measured Hz", "above background dB", "verdict"], &rows);
}

/// Every passage over the defect, in mean and spread.
pub(super) fn passages(sheet: &mut Sheet, summary: &Summary) {
    sheet.heading("Passages over the defect");
    let events = &summary.events;
    let late = |e: &stribeck_analysis::summary::Event| Some(e.exit_ms? - e.path_exit_ms?);
    let columns: [(&str, Vec<f64>, usize); 4] = [
        ("impulse g", events.iter().filter_map(|e| e.impulse_g).collect(), 0),
        ("spall mm", events.iter().filter_map(|e| e.spall_mm).filter(|s| *s < ODD_SPALL_MM).collect(), 2),
        ("exit picked after the centre has passed the edge, ms", events.iter().filter_map(late).collect(), 3),
        (
            "exit picked after the exit without slip, ms",
            events.iter().filter_map(|e| Some(e.exit_ms? - e.expected_exit_ms)).collect(),
            3,
        ),
    ];
    sheet.say(&format!("{} passages.", events.len()));
    let rows: Vec<Vec<String>> = columns
        .into_iter()
        .filter(|(_, values, _)| !values.is_empty())
        .map(|(name, values, decimals)| {
            let n = values.len() as f64;
            let mean = values.iter().sum::<f64>() / n;
            let spread = (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / n).sqrt();
            let least = values.iter().copied().fold(f64::INFINITY, f64::min);
            let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            sheet.value("passages", name, "mean", Some(mean));
            sheet.value("passages", name, "standard deviation", Some(spread));
            let mut row = vec![name.to_owned(), values.len().to_string()];
            row.extend([mean, spread, least, most].map(|v| number(v, decimals)));
            row
        })
        .collect();
    sheet.table(&["quantity", "passages", "mean", "standard deviation", "least", "most"], &rows);
}
