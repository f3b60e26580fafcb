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
    let shades = Shades::of(course);
    let mut sheet = Sheet::new(880.0, 390.0);
    draw_cells(&mut sheet, &shades);
    let columns = shades.levels_db.len() / shades.rows;
    draw_axes(&mut sheet, course.step_s * columns as f64, course.grid_hz * (course.lines - 1) as f64);
    draw_key(&mut sheet, shades.top_db);
    let mut picture = Picture::new("spectrogram", "Spectrogram", sheet);
    picture.caption =
        "Horizontal bands are resonances and steady lines, slanted ones follow the speed, vertical ones are \
         knocks and events."
            .into();
    picture.note = format!(
        "Density in dB re 1 ({unit})²/Hz, lines {:.1} Hz apart, Hann window; each column is the mean over \
         {}.",
        course.grid_hz,
        Scale::of(course.step_s).text(course.step_s, 0.01 * course.step_s, "s")
    );
    picture.dense = true;
    picture
}

/// Levels of the cells of the picture.
struct Shades {
    /// Cells above each other.
    rows: usize,
    /// Levels [dB re 1 unit²/Hz], one column after the other.
    levels_db: Vec<f64>,
    /// The largest.
    top_db: f64,
}

impl Shades {
    /// Means of the powers that share a cell.
    fn of(course: &Course) -> Self {
        let rows = ROWS.min(course.lines);
        let level = |powers: &[f64], row: usize| {
            let (first, end) = (row * powers.len() / rows, (row + 1) * powers.len() / rows);
            10.0 * (powers[first..end].iter().sum::<f64>() / (end - first) as f64).log10()
        };
        let columns = course.values.chunks_exact(course.lines);
        let levels_db: Vec<f64> =
            columns.flat_map(|powers| (0..rows).map(move |row| level(powers, row))).collect();
        let finite = levels_db.iter().copied().filter(|l| l.is_finite());
        let top_db = finite.fold(f64::NEG_INFINITY, f64::max);
        Self { rows, levels_db, top_db }
    }

    /// Number of the shade of a level; `None` where the record holds none.
    fn shade(&self, level_db: f64) -> Option<usize> {
        let part = (level_db - self.top_db) / RANGE_DB + 1.0;
        level_db.is_finite().then(|| (part.clamp(0.0, 1.0) * (SHADES - 1) as f64).round() as usize)
    }
}

/// Colour of a shade as a style.
fn fill(shade: usize) -> String {
    let [r, g, b] = shade_rgb(shade as f64 / (SHADES - 1) as f64);
    format!("fill:#{r:02x}{g:02x}{b:02x};stroke:none")
}

/// The cells, one path a shade.
fn draw_cells(sheet: &mut Sheet, shades: &Shades) {
    let columns = shades.levels_db.len() / shades.rows;
    let (wide, high) = (SIZE[0] / columns as f64, SIZE[1] / shades.rows as f64);
    let mut paths = vec![String::new(); SHADES];
    for (column, levels) in shades.levels_db.chunks_exact(shades.rows).enumerate() {
        let cells: Vec<Option<usize>> = levels.iter().map(|level| shades.shade(*level)).collect();
        let mut row = 0;
        // Cells of one shade above each other are one rectangle; a hair of overlap hides the seams.
        for same in cells.chunk_by(|a, b| a == b) {
            if let Some(shade) = same[0] {
                let (x, y) = (AT[0] + wide * column as f64, AT[1] + SIZE[1] - high * row as f64);
                let (w, h) = (wide + 0.3, high * same.len() as f64 + 0.3);
                let _ = write!(paths[shade], "M{x:.1} {y:.1}h{w:.1}v{h:.1}h-{w:.1}z");
            }
            row += same.len();
        }
    }
    for (shade, path) in paths.iter().enumerate().filter(|(_, path)| !path.is_empty()) {
        sheet.outline(path, &fill(shade));
    }
}

/// Ticks of time and frequency.
fn draw_axes(sheet: &mut Sheet, end_s: f64, end_hz: f64) {
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
}

/// The key, brightest at the top.
fn draw_key(sheet: &mut Sheet, top_db: f64) {
    let x = AT[0] + SIZE[0] + 16.0;
    let step = SIZE[1] / SHADES as f64;
    for n in 0..SHADES {
        let y = AT[1] + SIZE[1] - step * (n + 1) as f64;
        sheet.outline(&format!("M{x:.1} {y:.1}h14v{:.1}h-14z", step + 0.3), &fill(n));
    }
    for (level, y) in [(top_db, AT[1]), (top_db - RANGE_DB, AT[1] + SIZE[1])] {
        let words =
            if level.is_finite() { Scale::ONE.text(level.round(), 1.0, "") } else { "–".to_owned() };
        sheet.text([x + 18.0, y + 4.0], 12.0, Anchor::Start, "#14181c", &words);
    }
}
