//! Pictures with a dot for every start: levels by phase, times of events.

use super::tables::PHASES;
use crate::plot::{Anchor, Colour, Picture, Sheet, ticks};
use stribeck_analysis::ensemble::EnsembleFindings;
use stribeck_analysis::findings::Findings;
use stribeck_analysis::paper;
use stribeck_analysis::statistic::Statistic;
use stribeck_analysis::summary::{Event, PhaseLevels};

const WIDTH: f64 = 960.0;
const COLOURS: [Colour; 6] =
    [Colour::Blue, Colour::Orange, Colour::Green, Colour::Purple, Colour::Red, Colour::Teal];
/// Radius of a dot [px].
const DOT: f64 = 3.0;
const FAINT: &str = "#5c6670";

/// A dot a start, side by side where values coincide; `along` runs over the values.
fn strip(sheet: &mut Sheet, values: &[f64], colour: Colour, place: impl Fn(f64, f64) -> [f64; 2]) {
    let paint = format!("fill:{};fill-opacity:0.55", colour.css());
    for (n, value) in values.iter().enumerate() {
        // Thirds of a golden turn fill the width evenly, whatever the number of starts.
        let aside = (n as f64 * 0.618_034).fract() - 0.5;
        sheet.circle(place(*value, aside), DOT, &paint);
    }
    let Some(s) = Statistic::of(values, values.len()) else { return };
    let line = |at: f64, half: f64| [place(at, -half), place(at, half)];
    sheet
        .lines([line(s.median, 0.75)], &format!("fill:none;stroke:{};stroke-width:2.5", Colour::Black.css()));
    if let (Some(low), Some(high)) = (s.low, s.high) {
        let thin = format!("fill:none;stroke:{};stroke-width:1.2", Colour::Black.css());
        sheet.lines([[place(low, 0.0), place(high, 0.0)], line(low, 0.3), line(high, 0.3)], &thin);
    }
}

/// Peaks by phase at every sensor.
pub(super) fn levels(findings: &EnsembleFindings) -> Option<Picture> {
    const HEIGHT: f64 = 420.0;
    const LEFT: f64 = 70.0;
    const RIGHT: f64 = 20.0;
    const TOP: f64 = 44.0;
    const BELOW: f64 = 46.0;
    let (_, first) = findings.complete.first()?;
    let sensors = &first.summary.levels.sensors;
    let of_phase =
        |l: &PhaseLevels, phase: usize| [l.start_g, l.entry_g, l.defect_g, l.exit_g, l.gap_g][phase];
    let values = |sensor: usize, phase: usize| -> Vec<f64> {
        let of = |f: &Findings| of_phase(&f.summary.levels.sensors.get(sensor)?.phases, phase);
        findings.complete.iter().filter_map(|(_, f)| of(f)).collect()
    };
    let all = (0..sensors.len()).flat_map(|s| (0..PHASES.len()).flat_map(move |p| [(s, p)]));
    let highest = all.flat_map(|(s, p)| values(s, p)).fold(0.0, f64::max);
    if highest <= 0.0 {
        return None;
    }
    let of_paper = first.of_paper;
    let top = 1.05 * if of_paper { highest.max(paper::IMPULSE_G) } else { highest };
    let up = |g: f64| HEIGHT - BELOW - (HEIGHT - TOP - BELOW) * g / top;
    let mut sheet = Sheet::new(WIDTH, HEIGHT);
    let (at, step) = ticks(0.0, top, 7);
    for g in at {
        sheet.path(&[[LEFT, up(g)], [WIDTH - RIGHT, up(g)]], false, "fill:none;stroke:#e2e2e2");
        let decimals = usize::from(step < 1.0);
        sheet.text([LEFT - 8.0, up(g) + 4.0], 12.0, Anchor::End, "#000", &format!("{g:.decimals$}"));
    }
    sheet.text([LEFT - 8.0, TOP - 12.0], 12.0, Anchor::End, FAINT, "g");
    let column = (WIDTH - LEFT - RIGHT) / PHASES.len() as f64;
    let lane = column / (sensors.len() as f64 + 1.0);
    for (p, (_, words)) in PHASES.iter().enumerate() {
        let left = LEFT + column * p as f64;
        sheet.path(&[[left, TOP], [left, HEIGHT - BELOW]], false, "fill:none;stroke:#e2e2e2");
        sheet.text([left + 0.5 * column, HEIGHT - BELOW + 20.0], 13.0, Anchor::Middle, "#000", words);
        for s in 0..sensors.len() {
            let middle = left + lane * (s as f64 + 1.0);
            strip(&mut sheet, &values(s, p), COLOURS[s % COLOURS.len()], |g, aside| {
                [middle + 0.7 * lane * aside, up(g)]
            });
        }
    }
    let dashed = format!("fill:none;stroke:{};stroke-width:1.5;stroke-dasharray:6 4", Colour::Red.css());
    if of_paper {
        for (phase, g) in [(3.0, paper::IMPULSE_G), (4.0, paper::BETWEEN_G)] {
            let (from, to) = (LEFT + column * phase, LEFT + column * (phase + 1.0));
            sheet.path(&[[from, up(g)], [to, up(g)]], false, &dashed);
        }
        let x = LEFT + 120.0 * sensors.len() as f64;
        sheet.path(&[[x, 18.0], [x + 28.0, 18.0]], false, &dashed);
        let words =
            format!("the paper: impulses {} g, between them {} g", paper::IMPULSE_G, paper::BETWEEN_G);
        sheet.text([x + 34.0, 22.0], 12.0, Anchor::Start, "#000", &words);
    }
    for (s, sensor) in sensors.iter().enumerate() {
        let x = LEFT + 120.0 * s as f64;
        sheet.circle([x + 6.0, 18.0], 5.0, &format!("fill:{}", COLOURS[s % COLOURS.len()].css()));
        sheet.text([x + 16.0, 22.0], 12.0, Anchor::Start, "#000", &sensor.sensor);
    }
    let mut picture = Picture::new("levels", "Peaks of a_y by phase, a dot for every start", sheet);
    picture.caption =
        "How much one start differs from the next, at every sensor. A single run is one of these dots."
            .into();
    picture.note =
        "Thick: median. Thin: the mean's 95 % interval. Start-up counts with none of the others.".into();
    Some(picture)
}

/// A time of an event [ms].
pub(super) type Time = fn(&Event) -> Option<f64>;

/// When each roller unloads, strikes the floor or lands on oil there, and is loaded again.
pub(super) fn events(findings: &EnsembleFindings) -> Option<Picture> {
    const LEFT: f64 = 190.0;
    const RIGHT: f64 = 24.0;
    const TOP: f64 = 40.0;
    const BELOW: f64 = 50.0;
    const LANE: f64 = 34.0;
    const KINDS: [(&str, Colour, Time); 4] = [
        ("#1 unloads", Colour::Orange, |e| e.entry_ms),
        ("#2 strikes the floor", Colour::Purple, Event::impact_ms),
        ("lands on oil there", Colour::Blue, Event::landing_ms),
        ("#4 is loaded again", Colour::Green, |e| e.exit_ms),
    ];
    let (_, first) = findings.complete.first()?;
    let passages = first.summary.first_passages();
    let expected = passages.first()?;
    let traverse = expected.expected_exit_ms - expected.expected_entry_ms;
    let rollers: Vec<usize> = passages.iter().map(|e| e.roller).collect();
    let times = |roller: usize, of: Time| -> Vec<f64> {
        let of = |f: &Findings| {
            let event = f.summary.first_passages().into_iter().find(|e| e.roller == roller)?;
            Some(of(event)? - event.expected_entry_ms)
        };
        findings.complete.iter().filter_map(|(_, f)| of(f)).collect()
    };
    let height = TOP + BELOW + LANE * (KINDS.len() * rollers.len()) as f64;
    let (from, to) = (-0.15 * traverse, 1.25 * traverse);
    let across = |ms: f64| LEFT + (WIDTH - LEFT - RIGHT) * ((ms - from) / (to - from)).clamp(0.0, 1.0);
    let mut sheet = Sheet::new(WIDTH, height);
    let (at, step) = ticks(from, to, 10);
    for ms in at {
        sheet.path(&[[across(ms), TOP], [across(ms), height - BELOW]], false, "fill:none;stroke:#e2e2e2");
        let decimals = usize::from(step < 1.0);
        let words = super::tables::shown(ms, decimals);
        sheet.text([across(ms), height - BELOW + 18.0], 12.0, Anchor::Middle, "#000", &words);
    }
    let words = "Time after the centre stands over the leading edge without slip [ms]";
    sheet.text([0.5 * (LEFT + WIDTH - RIGHT), height - 12.0], 13.0, Anchor::Middle, "#000", words);
    for (ms, words) in [(0.0, "leading edge"), (traverse, "trailing edge")] {
        let paint = format!("fill:none;stroke:{};stroke-dasharray:6 4", Colour::Red.css());
        sheet.path(&[[across(ms), TOP - 6.0], [across(ms), height - BELOW]], false, &paint);
        sheet.text([across(ms), TOP - 12.0], 12.0, Anchor::Middle, Colour::Red.css(), words);
    }
    let of = findings.complete.len();
    for (r, roller) in rollers.iter().enumerate() {
        for (k, (words, colour, kind)) in KINDS.iter().enumerate() {
            let middle = TOP + LANE * ((r * KINDS.len() + k) as f64 + 0.5);
            let times = times(*roller, *kind);
            let words = format!("roller {roller} {words}, {}/{of}", times.len());
            sheet.text([LEFT - 10.0, middle + 4.0], 12.0, Anchor::End, "#000", &words);
            strip(&mut sheet, &times, *colour, |ms, aside| [across(ms), middle + 0.7 * LANE * aside]);
        }
        let below = TOP + LANE * (KINDS.len() * (r + 1)) as f64;
        sheet.path(&[[12.0, below], [WIDTH - RIGHT, below]], false, "fill:none;stroke:#c8ced4");
    }
    let mut picture = Picture::new("events", "Events, a dot for every start", sheet);
    picture.caption = "Whether the contact forces show an event, and when.".into();
    picture.note =
        "Each start on its own clock, so that its start angle moves nothing. Thick: median. Thin: \
        the mean's 95 % interval."
            .into();
    Some(picture)
}

/// The course of a roller's passage over the defect, in a sentence.
pub(super) fn story(findings: &EnsembleFindings, roller: usize) -> String {
    let of = findings.complete.len();
    let count = |what: fn(&Event) -> Option<f64>| {
        findings.over_events(&roller.to_string(), what).map_or(0, |s| s.count)
    };
    format!(
        "It unloads in {} of {of} starts, strikes the floor in {}, lands on oil there in {} and is loaded \
         again in {}.",
        count(|e| e.entry_ms),
        count(Event::impact_ms),
        count(Event::landing_ms),
        count(|e| e.exit_ms)
    )
}
