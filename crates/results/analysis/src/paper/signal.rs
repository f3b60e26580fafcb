//! Results of the paper: frequencies, levels, the notch, the events (its sections 3 to 5).

use super::{BETWEEN_G, CURSOR_HZ, EQUATION_2_HZ, FILTERED_G, IMPULSE_G, RowInputs, TONE_HZ, number, words};
use crate::summary::{Event, PaperRow};

const MOTION: &str = "Kinematics";
const NOISE: &str = "Noise";
const NOTCH: &str = "Notch";
const EVENTS: &str = "Contact forces";

pub(super) fn rows(source: &RowInputs<'_>) -> Vec<PaperRow> {
    let mut rows = motion(source);
    rows.extend(levels(source));
    rows.extend(lines(source));
    rows.extend(beat(source));
    rows.extend(notch(source));
    rows.extend(events(source));
    rows
}

fn motion(source: &RowInputs<'_>) -> Vec<PaperRow> {
    let k = &source.prediction.kinematics;
    let exits: Vec<f64> = source.summary.events.iter().filter_map(|e| e.exit_ms).collect();
    let spacing_s =
        (exits.len() > 1).then(|| 1e-3 * (exits[exits.len() - 1] - exits[0]) / (exits.len() - 1) as f64);
    let b = &source.scene.written.bearing;
    let percent = spacing_s.map(|s| 100.0 * (1.0 / s / k.bpfo_hz - 1.0));
    vec![
        number(
            MOTION,
            "BPFO by equation (1)",
            90.07,
            Some(k.bpfo_hz),
            "Hz",
            "equation (1) with Table 1; its own numbers do not give 90.07",
        ),
        number(
            MOTION,
            "Pitch diameter in it",
            181.98,
            Some(0.5 * (b.outer_race_diameter_mm + b.inner_race_diameter_mm)),
            "mm",
            "not printed; (D_o + D_i)/2",
        ),
        number(
            MOTION,
            "Separation of the impulses",
            0.011,
            spacing_s,
            "s",
            "between the first and the last exit picked from the forces",
        ),
        number(
            MOTION,
            "BPFO from the impulses",
            90.91,
            spacing_s.map(|s| 1.0 / s),
            "Hz",
            "the paper's is 1/0.011 s, read to the millisecond; slip can only lower it",
        ),
        words(
            MOTION,
            "Simulated against analytical BPFO",
            "0.9 %",
            percent.map_or("this record cannot tell".into(), |p| format!("{p:+.2} %").replace('-', "−")),
            "–",
            "the paper's rollers would be too fast, which slip cannot do; ours are slowed by slip",
        )
        .telling(percent, "%"),
    ]
}

fn levels(source: &RowInputs<'_>) -> Vec<PaperRow> {
    let sensor = source.sensor;
    let name = sensor.map_or("none", |sensor| sensor.sensor.as_str());
    let why = |what: &str| {
        format!(
            "{what}; sensor “{name}”, whose a_y is the most radial. The paper states neither thickness, \
             contact stiffness, damping nor the place of its sensor: docs/results/paper.md says what each does"
        )
    };
    vec![
        number(
            NOISE,
            "Impulses, peak",
            IMPULSE_G,
            sensor.and_then(|sensor| sensor.impulse_g),
            "g",
            &why("largest within 1 ms of an exit"),
        ),
        number(
            NOISE,
            "Between impulses, peak",
            BETWEEN_G,
            sensor.and_then(|sensor| sensor.between_g),
            "g",
            &why("largest away from events"),
        ),
        number(
            NOISE,
            "Between impulses, notched, peak",
            FILTERED_G,
            sensor.and_then(|sensor| sensor.between_filtered_g),
            "g",
            &why("the same behind the notch"),
        ),
    ]
}

fn lines(source: &RowInputs<'_>) -> Vec<PaperRow> {
    let summary = source.summary;
    let measured = source.sensor.and_then(|sensor| sensor.tone_hz);
    let carrier = summary.families.iter().filter(|f| f.found).find_map(|f| f.carrier_hz);
    let (outer, inner) = source.prediction.kinematics.paper_noise_hz(source.scene.element_size);
    let inner_right = source.prediction.facet_lines.iter().find(|l| l.0 == "inner_race_nodes").map(|l| l.1);
    let resolution = summary.spectrum.as_ref();
    let record = resolution.map_or("no spectrum".into(), |s| {
        format!("{:.1} Hz, drawn every {:.1} Hz", s.resolution_hz, s.grid_hz)
    });
    let fifth = source.sensor.and_then(|sensor| sensor.fifth_hz);
    let off = measured.map(|hz| 100.0 * (1.0 - hz / EQUATION_2_HZ.0));
    let slip = summary.kinematics.cage_hz.map(|hz| 100.0 * (1.0 - hz / summary.kinematics.expected_cage_hz));
    vec![
        words(
            NOISE,
            "Frequency resolution of the spectrum",
            "3 Hz",
            record,
            "–",
            "30 ms resolve 33 Hz; 3 Hz is the grid of a zero-padded transform. fixtures/scenes/long.ron has \
             a true 3 Hz",
        ),
        number(
            NOISE,
            "Fundamental tone",
            TONE_HZ,
            measured,
            "Hz",
            &format!(
                "{} vertices × {:.3} Hz of spin, without any slip: {:.1} Hz. The carrier of the facet \
                 lines by all sensors and forces: {}",
                source.mesh.roller_facets,
                source.prediction.kinematics.roller_spin_hz,
                source.prediction.facet_lines.first().map_or(0.0, |l| l.1),
                carrier.map_or("none is found".into(), |hz| format!("{hz:.1} Hz"))
            ),
        ),
        words(
            NOISE,
            "Fifth harmonic",
            "23 kHz",
            fifth.map_or("not found".into(), |hz| format!("{:.2} kHz", 1e-3 * hz)),
            "–",
            "\"approximately\" in the paper; ours counts when it stands 10 dB above its \
             surroundings",
        )
        .telling(fifth.map(|hz| 1e-3 * hz), "kHz"),
        number(
            NOISE,
            "Equation (2), outer raceway",
            EQUATION_2_HZ.0,
            Some(outer),
            "Hz",
            "the paper rounds the cage frequency to 3.75 Hz",
        ),
        number(
            NOISE,
            "Equation (2), inner raceway",
            EQUATION_2_HZ.1,
            Some(inner),
            "Hz",
            &format!(
                "as the paper computes it, with the cage's speed. The contact runs over the inner ring at \
                 ω_i − ω_c: {} Hz. Spin is one number, so vertices pass both raceways equally often",
                inner_right.map_or("–".into(), |hz| format!("{hz:.0}"))
            ),
        ),
        words(
            NOISE,
            "Equation (2), outer raceway, against the tone",
            "0.8 %",
            off.map_or("this record cannot tell".into(), |p| format!("{p:.2} %").replace('-', "−")),
            "–",
            "the paper calls it slip; it is 112 instead of 113 edges. Slip is measured on its own, below",
        )
        .telling(off, "%"),
        words(
            NOISE,
            "Slip of the cage",
            "\"a small amount\"",
            slip.map_or("this record cannot tell".into(), |p| format!("{p:.2} %").replace('-', "−")),
            "–",
            "recorded rotation of the cage against rolling without slip",
        )
        .telling(slip, "%"),
    ]
}

fn beat(source: &RowInputs<'_>) -> Vec<PaperRow> {
    let reading = source.summary.cursor.as_ref();
    let gap = 100.0 * (CURSOR_HZ / EQUATION_2_HZ.1 - 1.0);
    let lines = &source.prediction.facet_lines;
    let ours = |name: &str| lines.iter().find(|l| l.0 == name).map_or(f64::NAN, |l| l.1);
    let (a, b) = (ours("roller_vertices"), ours("inner_race_nodes"));
    vec![
        number(
            NOISE,
            "Intermittent tone, read between two peaks",
            CURSOR_HZ,
            reading.map(|r| r.reads_hz),
            "Hz",
            &reading.map_or("needs a sample rate".into(), |r| {
                format!(
                    "{} samples: a cursor reads {:.0}, {:.0} or {:.0} Hz and nothing between. {:.0} % of the \
                     periods of a pure {TONE_HZ:.0} Hz tone are that long. Lines of this run near it: {}",
                    r.samples,
                    r.neighbours_hz.0,
                    r.reads_hz,
                    r.neighbours_hz.1,
                    100.0 * r.share_in_tone,
                    near_cursor(source)
                )
            }),
        ),
        words(
            NOISE,
            "4545 Hz against 3864 Hz",
            "17 %",
            format!("{gap:.1} %"),
            "–",
            "the same two numbers; neither is a line of the bearing",
        ),
        words(
            NOISE,
            "Peaks of equation (3), A₁ = A₂ = 1",
            "4545 Hz",
            reading.map_or("–".into(), |r| {
                let (gap, share) = r.equation_3_common;
                format!(
                    "carrier {:.0} Hz; {:.0} % of the gaps are {gap} samples, {:.0} % read {:.0} \
                    Hz",
                    r.equation_3_carrier_hz,
                    100.0 * share,
                    100.0 * r.share_in_equation_3,
                    r.reads_hz
                )
            }),
            "–",
            "two equal tones swell on the mean of their frequencies; a single pair of cursors reads one of \
             several numbers of samples",
        ),
        words(
            NOISE,
            "Zoom of the beat, Fig. 5b",
            "10–15 ms",
            "10–15 ms".into(),
            "none",
            "drawn with the paper's two frequencies",
        ),
        words(
            NOISE,
            "Beat seen in the acceleration",
            "5–16 ms, less 17–28 ms",
            format!("{a:.0} and {b:.0} Hz beat once in {:.0} ms", 1e3 / (a - b).abs().max(1e-3)),
            "–",
            "3864 and 4712 Hz would beat every 1.2 ms; the lines of the mesh lie tens of hertz apart and \
             beat slower than the gap between impulses",
        ),
    ]
}

/// Lines of the families within a resolution of the paper's 4545 Hz, in words.
fn near_cursor(source: &RowInputs<'_>) -> String {
    let Some(spectrum) = &source.summary.spectrum else { return "no spectrum".into() };
    let near: Vec<String> = source
        .summary
        .families
        .iter()
        .flat_map(|f| f.lines.iter().map(move |l| (f, l)))
        .filter(|(_, l)| l.measured_hz.is_some_and(|hz| (hz - CURSOR_HZ).abs() <= spectrum.resolution_hz))
        .map(|(f, l)| {
            format!(
                "{:.0} Hz ({} {:+}, {} {})",
                l.measured_hz.unwrap_or(0.0),
                f.name.replace('_', " "),
                l.sideband,
                l.sensor,
                l.component
            )
            .replace('-', "−")
        })
        .collect();
    if near.is_empty() { "none of a facet family".into() } else { near.join(", ") }
}

fn notch(source: &RowInputs<'_>) -> Vec<PaperRow> {
    let notch = source.summary.notch.as_ref();
    let db = |v: Option<f64>| v.map_or("–".into(), |v| format!("{v:.1}"));
    let four = notch.map_or("no notch".into(), |n| {
        format!(
            "Hann window, whole record. Of the leading sensor: Hann {} / {} dB, boxcar {} / {} dB with / \
             without the filter's transient; a clean tone gives 29 dB (boxcar) and 56 dB (Hann)",
            db(n.attenuation_db),
            db(n.attenuation_settled_db),
            db(n.attenuation_boxcar_db),
            db(n.attenuation_boxcar_settled_db)
        )
    });
    vec![
        words(NOTCH, "Order of the filter", "2", "2".into(), "none", "infinite impulse response, one pass"),
        number(
            NOTCH,
            "Quality factor Q",
            15.0,
            notch.map(|n| n.q),
            "",
            "width at −3 dB exactly centre/Q, as scipy.signal.iirnotch",
        ),
        number(
            NOTCH,
            "Centre",
            TONE_HZ,
            source.sensor.and_then(|sensor| sensor.notch_hz),
            "Hz",
            "placed on the tone of the same sensor",
        ),
        number(NOTCH, "Taken from the tone", 25.0, source.sensor.and_then(|s| s.notch_db), "dB", &four),
        number(
            NOTCH,
            "Taken at 4545 Hz",
            4.0,
            notch.and_then(|n| n.paper_4545_db),
            "dB",
            &notch.map_or(String::new(), |n| {
                format!(
                    "|H(4545 Hz)| of the paper's notch from its coefficients; {} dB with the centre used \
                     here. A property of the filter, not of a tone",
                    n.attenuation_4545_db.map_or("–".into(), |db| format!("{db:.2}"))
                )
            }),
        ),
        words(
            NOTCH,
            "Zoom of the spectra, Fig. 7b",
            "4–6 kHz",
            if (4000.0..6000.0).contains(&notch.map_or(0.0, |n| n.centre_hz)) {
                "4–6 kHz".into()
            } else {
                "about the tone".into()
            },
            "–",
            "see Spectra",
        ),
    ]
}

fn events(source: &RowInputs<'_>) -> Vec<PaperRow> {
    let events = &source.summary.events;
    let papers = ["≈ 5", "16–17", "≈ 28"];
    let mut rows = vec![number(
        EVENTS,
        "Rollers that cross the defect",
        3.0,
        Some(events.len() as f64),
        "",
        "those that enter within the record",
    )];
    let struck = events.iter().filter(|event| event.impact_ms().is_some()).count();
    let on_oil = match events.iter().filter(|event| event.landing_ms().is_some()).count() {
        0 => String::new(),
        landings => format!("; {landings} land on oil"),
    };
    rows.push(
        words(
            EVENTS,
            "Rollers that strike its floor, event #2",
            "indicated in Fig. 8",
            format!("{struck} of {}{on_oil}", events.len()),
            "–",
            "by metal, with more than twice their centrifugal force and weight (THEORY §7.4)",
        )
        .telling(Some(struck as f64), ""),
    );
    for (event, paper) in events.iter().zip(papers) {
        let ms = |t: Option<f64>| t.map_or("–".into(), |t| format!("{t:.2}"));
        let impulse = words(
            EVENTS,
            &format!("Roller {}: impulse, Fig. 2", event.roller),
            &format!("{paper} ms"),
            format!("{} ms", ms(event.exit_ms)),
            "–",
            &format!("the trailing edge is passed at {:.2} ms without slip", event.expected_exit_ms),
        );
        rows.push(impulse.telling(event.exit_ms, "ms"));
        rows.push(words(
            EVENTS,
            &format!("Roller {}: events #1 to #4, Fig. 8", event.roller),
            "marked",
            format!(
                "#1 {} ms, #2 {}, #3 {}, #4 {} ms",
                ms(event.entry_ms),
                floor(event),
                event.compensation_ms.map_or("no neighbour in the defect".into(), |t| {
                    format!("{t:.2} ms (+{:.0} %)", 100.0 * (event.compensation_gain.unwrap_or(1.0) - 1.0))
                }),
                ms(event.exit_ms)
            ),
            "–",
            "unloading, impact on the floor, load taken over from a neighbour, re-stressing; picked from the \
             forces",
        ));
    }
    rows
}

/// When a roller strikes the floor or lands on the oil above it.
fn floor(event: &Event) -> String {
    let touch = event.floor_ms.zip(event.floor_n).zip(event.floor_by);
    touch.map_or("no touch of the floor".into(), |((at_ms, force_n), by)| {
        format!("{} at {at_ms:.2} ms, {force_n:.0} N", by.in_words())
    })
}
