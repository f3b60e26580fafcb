//! The picture of a record's spectra over time.

use std::fmt::Write;

use crate::plot::{Anchor, Picture, Scale, Sheet, shade_rgb, ticks};
use stribeck_analysis::measured::Course;

/// Decibels from the darkest shade to the brightest.
const RANGE_DB: f64 = 60.0;
/// Shades, and rows of the picture.
const SHADES: usize = 24;
const ROWS: usize = 160;
/// Where it stands on the sheet [px].
const AT: [f64; 2] = [70.0, 14.0];
const SIZE: [f64; 2] = [720.0, 320.0];

pub(super) fn picture(course: &Course, unit: &str) -> Picture {
    let columns = course.values.len() / course.lines;
    let rows = ROWS.min(course.lines);
    let levels: Vec<f64> = (0..columns)
        .flat_map(|column| {
            let of = &course.values[column * course.lines..][..course.lines];
            (0..rows).map(move |row| {
                let (first, end) = (row * of.len() / rows, (row + 1) * of.len() / rows);
                let power = of[first..end].iter().sum::<f64>() / (end - first) as f64;
                10.0 * power.log10()
            })
        })
        .collect();
    let top = levels.iter().copied().filter(|l| l.is_finite()).fold(f64::NEG_INFINITY, f64::max);
    let shade = |level: f64| {
        let part = (level - top) / RANGE_DB + 1.0;
        level.is_finite().then(|| (part.clamp(0.0, 1.0) * (SHADES - 1) as f64).round() as usize)
    };
    let (wide, high) = (SIZE[0] / columns as f64, SIZE[1] / rows as f64);
    let mut paths = vec![String::new(); SHADES];
    for column in 0..columns {
        let mut row = 0;
        while row < rows {
            // Cells of one shade above each other are one rectangle; a hair of overlap hides the seams.
            let of = shade(levels[column * rows + row]);
            let first = row;
            while row < rows && shade(levels[column * rows + row]) == of {
                row += 1;
            }
            if let Some(n) = of {
                let (x, y) = (AT[0] + wide * column as f64, AT[1] + SIZE[1] - high * row as f64);
                let (w, h) = (wide + 0.3, high * (row - first) as f64 + 0.3);
                let _ = write!(paths[n], "M{x:.1} {y:.1}h{w:.1}v{h:.1}h-{w:.1}z");
            }
        }
    }
    let mut sheet = Sheet::new(880.0, 390.0);
    for (n, path) in paths.iter().enumerate().filter(|(_, path)| !path.is_empty()) {
        let [r, g, b] = shade_rgb(n as f64 / (SHADES - 1) as f64);
        sheet.outline(path, &format!("fill:#{r:02x}{g:02x}{b:02x};stroke:none"));
    }
    let end_s = course.step_s * columns as f64;
    let end_hz = course.grid_hz * (course.lines - 1) as f64;
    let (times, step) = ticks(0.0, end_s, 8);
    for t in times {
        let x = AT[0] + SIZE[0] * t / end_s;
        sheet.path(&[[x, AT[1] + SIZE[1]], [x, AT[1] + SIZE[1] + 5.0]], false, "stroke:#14181c");
        let words = Scale::of(end_s).text(t, step, "s");
        sheet.text([x, AT[1] + SIZE[1] + 20.0], 12.0, Anchor::Middle, "#14181c", &words);
    }
    let (frequencies, step) = ticks(0.0, end_hz, 6);
    for f in frequencies {
        let y = AT[1] + SIZE[1] * (1.0 - f / end_hz);
        sheet.path(&[[AT[0] - 5.0, y], [AT[0], y]], false, "stroke:#14181c");
        let words = Scale::of(end_hz).text(f, step, "Hz");
        sheet.text([AT[0] - 8.0, y + 4.0], 12.0, Anchor::End, "#14181c", &words);
    }
    sheet.text([AT[0] + 0.5 * SIZE[0], AT[1] + SIZE[1] + 40.0], 13.0, Anchor::Middle, "#14181c", "Time");
    // The key, brightest at the top.
    let x = AT[0] + SIZE[0] + 16.0;
    let step = SIZE[1] / SHADES as f64;
    for n in 0..SHADES {
        let [r, g, b] = shade_rgb(n as f64 / (SHADES - 1) as f64);
        let y = AT[1] + SIZE[1] - step * (n + 1) as f64;
        let path = format!("M{x:.1} {y:.1}h14v{:.1}h-14z", step + 0.3);
        sheet.outline(&path, &format!("fill:#{r:02x}{g:02x}{b:02x};stroke:none"));
    }
    for (level, y) in [(top, AT[1]), (top - RANGE_DB, AT[1] + SIZE[1])] {
        let words =
            if level.is_finite() { Scale::ONE.text(level.round(), 1.0, "") } else { "–".to_owned() };
        sheet.text([x + 18.0, y + 4.0], 12.0, Anchor::Start, "#14181c", &words);
    }
    let mut picture = Picture::new("spectrogram", "Spectrogram", sheet);
    picture.caption =
        "Horizontal bands are resonances and steady lines, slanted ones follow the speed, vertical ones are knocks and events.".into();
    picture.note = format!(
        "Density in dB re 1 ({unit})²/Hz, lines {:.1} Hz apart, Hann window; each column is the mean over {}.",
        course.grid_hz,
        Scale::of(course.step_s).text(course.step_s, 0.01 * course.step_s, "s")
    );
    picture.dense = true;
    picture
}
