//! Pictures of a record's spectra over time, over speed and over the angle of the shaft.

use std::fmt::Write;

use crate::plot::{Anchor, Picture, Scale, Sheet, shade_rgb, ticks};
use stribeck_diagnosis::Course;

/// Decibels from the darkest shade to the brightest.
const RANGE_DB: f64 = 60.0;
/// The same on an order map, each of whose columns is relative to its own mean.
const ORDER_RANGE_DB: f64 = 30.0;
/// Shades, and rows of the picture.
const SHADES: usize = 24;
const ROWS: usize = 160;
/// Where it stands on the sheet [px].
const AT: [f64; 2] = [84.0, 14.0];
const SIZE: [f64; 2] = [700.0, 320.0];
/// Colour of axes and words on white paper.
const INK: &str = "#14181c";

/// An axis of a picture: its words, its end, and the unit of its ticks.
pub(super) struct Span<'a> {
    pub(super) label: &'a str,
    pub(super) end: f64,
    pub(super) unit: &'a str,
    /// Whether ticks take a prefix, as `kHz`.
    pub(super) prefixed: bool,
}

impl Span<'_> {
    fn text(&self, value: f64, step: f64) -> String {
        let scale = if self.prefixed { Scale::of(self.end) } else { Scale::ONE };
        scale.text(value, step, self.unit)
    }
}

pub(super) fn picture(course: &Course, unit: &str) -> Picture {
    let columns = course.values.len() / course.lines;
    let time = Span { label: "Time", end: course.step_s * columns as f64, unit: "s", prefixed: true };
    let end = course.grid_hz * (course.lines - 1) as f64;
    let frequency = Span { label: "Frequency", end, unit: "Hz", prefixed: true };
    let mut picture = heat(course, RANGE_DB, ("spectrogram", "Spectrogram"), &time, &frequency);
    picture.caption =
        "Horizontal bands are resonances and steady lines, slanted ones follow the speed, vertical ones are \
         impacts and events."
            .into();
    picture.note = format!(
        "Density in dB re 1 ({unit})²/Hz, lines {:.1} Hz apart, Hann window; each column is the mean over \
         {}.",
        course.grid_hz,
        Scale::of(course.step_s).text(course.step_s, 0.01 * course.step_s, "s")
    );
    picture
}

/// Orders that an order map shows, in those of the slowest family, and at least.
const ORDERS: f64 = 4.5;
const LEAST_ORDERS: f64 = 12.0;

/// The envelope of a band over the angle: `course` counts turns of the shaft in the place of seconds. Those
/// of `orders` are marked. Each column is relative to its own mean, because levels rise with the speed.
pub(super) fn order_map(course: &Course, band_hz: (f64, f64), orders: &[(String, f64)]) -> Picture {
    // The last one may be empty: the record ends before it.
    let is_filled = |column: &[f64]| column.iter().skip(2).any(|power| *power > 0.0);
    let columns = course.values.chunks_exact(course.lines).rposition(is_filled).map_or(0, |last| last + 1);
    let fastest = orders.iter().map(|(_, order)| *order).fold(0.0, f64::max);
    let lines = ((ORDERS * fastest).max(LEAST_ORDERS) / course.grid_hz).ceil() as usize + 1;
    let lines = lines.min(course.lines);
    // The lower part of each column; slow changes of level fill its first lines.
    let values = course.values.chunks_exact(course.lines).take(columns).flat_map(|column| {
        let known = column[..lines].iter().skip(2);
        let mean = known.clone().sum::<f64>() / known.len() as f64;
        column[..lines].iter().enumerate().map(move |(n, p)| if n < 2 { f64::NAN } else { *p / mean })
    });
    let part = Course { lines, values: values.collect(), ..course.clone() };
    let end = course.step_s * columns as f64;
    let turns = Span { label: "Turns of the shaft", end, unit: "", prefixed: false };
    let top = course.grid_hz * (lines - 1) as f64;
    let axis = Span { label: "Order (impacts a turn)", end: top, unit: "", prefixed: false };
    let mut picture = heat(&part, ORDER_RANGE_DB, ("order-map", "Order map of the envelope"), &turns, &axis);
    // Labels side by side: orders of raceways and elements lie close together.
    for (n, (name, order)) in orders.iter().filter(|(_, order)| *order < top).enumerate() {
        let y = AT[1] + SIZE[1] * (1.0 - order / top);
        let line = [[AT[0], y], [AT[0] + SIZE[0], y]];
        picture.sheet.path(&line, false, "stroke:#fff;stroke-width:1;stroke-dasharray:6 6");
        let words = format!("{name} {order:.2}");
        let (right, wide) =
            (AT[0] + SIZE[0] - 6.0 - 100.0 * n as f64, 7.0 * words.chars().count() as f64 + 6.0);
        let ground = format!("M{:.1} {:.1}h{wide:.1}v-15h-{wide:.1}z", right - wide + 3.0, y - 1.0);
        picture.sheet.outline(&ground, "fill:#ffffffd0;stroke:none");
        picture.sheet.text([right, y - 4.0], 12.0, Anchor::End, INK, &words);
    }
    picture.caption =
        "A source that strikes n times a turn is a horizontal line at order n, whatever the speed; one with a \
         fixed frequency slants."
            .into();
    picture.note = format!(
        "Squared envelope of {:.0} to {:.0} Hz, averaged over equal steps of the shaft's angle; in dB over \
         the mean of each column, lines {:.2} orders apart, Hann window; each column is the mean over {:.2} turns.",
        band_hz.0, band_hz.1, course.grid_hz, course.step_s
    );
    picture
}

fn heat(course: &Course, range_db: f64, (id, title): (&str, &str), x: &Span<'_>, y: &Span<'_>) -> Picture {
    let shades = Shades::of(course, range_db);
    let mut sheet = Sheet::new(880.0, 390.0);
    draw_cells(&mut sheet, &shades);
    draw_axes(&mut sheet, x, y);
    draw_key(&mut sheet, &shades);
    let mut picture = Picture::new(id, title, sheet);
    picture.dense = true;
    picture
}

/// Rows of a waterfall at most.
const ROWS_OF_WATERFALL: usize = 20;
/// Points of a row.
const POINTS: usize = 350;
/// How far each row of a waterfall stands to the right of the one before it and above it [px].
const SHIFT: [f64; 2] = [7.0, 12.0];
/// Height of a row's range of [`RANGE_DB`] [px].
const HIGH: f64 = 110.0;

/// Spectra one behind the other: over the speed where each column has one (`speeds` [1/min]), otherwise over
/// time.
pub(super) fn waterfall(course: &Course, unit: &str, speeds: Option<&[f64]>) -> Option<Picture> {
    let rows = waterfall_rows(course, speeds);
    if rows.len() < 3 {
        return None;
    }
    let count = rows.len() as f64;
    let wide = SIZE[0] - SHIFT[0] * (count - 1.0) - 30.0;
    let high = HIGH + SHIFT[1] * (count - 1.0);
    let mut sheet = Sheet::new(880.0, high + 70.0);
    let end_hz = course.grid_hz * (course.lines - 1) as f64;
    let level = |power: f64| 10.0 * power.log10();
    let top_db = rows.iter().flat_map(|row| &row.1).copied().map(level).filter(|l| l.is_finite());
    let top_db = top_db.fold(f64::NEG_INFINITY, f64::max);
    // From the farthest to the nearest, each on white ground that hides what is behind it.
    for (n, (at, powers)) in rows.iter().enumerate().rev() {
        let (left, foot) = (AT[0] + SHIFT[0] * n as f64, AT[1] + high - SHIFT[1] * n as f64);
        let up = |power: f64| HIGH * ((level(power) - top_db) / RANGE_DB + 1.0).clamp(0.0, 1.0);
        let mut path = format!("M{left:.1} {foot:.1}");
        for point in 0..POINTS {
            let (first, last) = (point * powers.len() / POINTS, (point + 1) * powers.len() / POINTS);
            let highest = powers[first..last.max(first + 1)].iter().copied().fold(0.0, f64::max);
            let x = left + wide * (point as f64 + 0.5) / POINTS as f64;
            let _ = write!(path, "L{x:.1} {:.1}", foot - up(highest));
        }
        let _ = write!(path, "L{:.1} {foot:.1}", left + wide);
        let shade = shade_rgb(0.15 + 0.55 * n as f64 / count);
        let [r, g, b] = shade;
        sheet.outline(&path, &format!("fill:#fff;stroke:#{r:02x}{g:02x}{b:02x};stroke-width:1"));
        if n % 2 == 0 || rows.len() <= 10 {
            sheet.text([left + wide + 6.0, foot + 3.0], 11.0, Anchor::Start, INK, at);
        }
    }
    let (frequencies, step) = ticks(0.0, end_hz, 6);
    let foot = AT[1] + high;
    for f in frequencies {
        let x = AT[0] + wide * f / end_hz;
        sheet.path(&[[x, foot], [x, foot + 5.0]], false, "stroke:#14181c");
        sheet.text([x, foot + 19.0], 12.0, Anchor::Middle, INK, &Scale::of(end_hz).text(f, step, "Hz"));
    }
    sheet.text([AT[0] + 0.5 * wide, foot + 40.0], 13.0, Anchor::Middle, INK, "Frequency");
    // A bar of 20 dB gives the scale of the height.
    let (x, long) = (AT[0] - 26.0, HIGH * 20.0 / RANGE_DB);
    sheet.path(&[[x, foot], [x, foot - long]], false, "stroke:#14181c;stroke-width:2");
    sheet.text([x - 6.0, foot - 0.5 * long + 4.0], 11.0, Anchor::End, INK, "20 dB");
    let over = if speeds.is_some() { "speed" } else { "time" };
    let mut picture = Picture::new("waterfall", &format!("Waterfall: spectra over {over}"), sheet);
    picture.caption = if speeds.is_some() {
        "Peaks that move to the right as the speed rises follow the shaft; those that stay are resonances."
    } else {
        "Peaks that stand one behind the other are steady; what comes and goes stands in some rows only."
    }
    .into();
    picture.note = format!(
        "Density in dB re 1 ({unit})²/Hz over {RANGE_DB:.0} dB, lines {:.1} Hz apart; the nearest row is the \
         {}.",
        course.grid_hz,
        if speeds.is_some() { "slowest" } else { "first" }
    );
    picture.dense = true;
    Some(picture)
}

/// The abscissa of each row, and its mean powers.
fn waterfall_rows(course: &Course, speeds: Option<&[f64]>) -> Vec<(String, Vec<f64>)> {
    let columns: Vec<&[f64]> = course.values.chunks_exact(course.lines).collect();
    let key: Vec<f64> = match speeds {
        Some(speeds) if speeds.len() == columns.len() => speeds.to_vec(),
        Some(_) => return Vec::new(),
        None => (0..columns.len()).map(|n| course.step_s * (n as f64 + 0.5)).collect(),
    };
    let finite = || key.iter().copied().filter(|x| x.is_finite());
    let (low, high) = (finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max));
    if low >= high {
        return Vec::new();
    }
    let rows = ROWS_OF_WATERFALL.min(columns.len());
    let mut sums = vec![(0.0, 0.0, vec![0.0; course.lines]); rows];
    for (at, powers) in key.iter().zip(columns) {
        if !at.is_finite() || powers.iter().any(|p| !p.is_finite()) {
            continue;
        }
        let row = (((at - low) / (high - low) * rows as f64) as usize).min(rows - 1);
        let (count, sum, all) = &mut sums[row];
        *count += 1.0;
        *sum += at;
        all.iter_mut().zip(powers).for_each(|(all, p)| *all += p);
    }
    let told = |at: f64| match speeds {
        Some(_) => format!("{at:.0} rpm"),
        None => Scale::of(high).text(at, 0.01 * high, "s"),
    };
    sums.into_iter()
        .filter(|(count, ..)| *count > 0.0)
        .map(|(count, sum, all)| (told(sum / count), all.iter().map(|p| p / count).collect()))
        .collect()
}

/// Levels of the cells of the picture.
struct Shades {
    /// Cells above each other.
    rows: usize,
    /// Levels [dB re 1 unit²/Hz], one column after the other.
    levels_db: Vec<f64>,
    /// The largest, and from it down to the darkest.
    top_db: f64,
    range_db: f64,
}

impl Shades {
    /// Means of the powers that share a cell.
    fn of(course: &Course, range_db: f64) -> Self {
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
        Self { rows, levels_db, top_db, range_db }
    }

    /// Number of the shade of a level; `None` where the record holds none.
    fn shade(&self, level_db: f64) -> Option<usize> {
        let part = (level_db - self.top_db) / self.range_db + 1.0;
        level_db.is_finite().then(|| (part.clamp(0.0, 1.0) * (SHADES - 1) as f64).round() as usize)
    }
}

/// Colour of a shade as a style.
fn fill(shade: usize) -> String {
    let [r, g, b] = shade_rgb(shade as f64 / (SHADES - 1) as f64);
    format!("fill:#{r:02x}{g:02x}{b:02x};stroke:none")
}

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
                // Upwards, towards higher frequencies.
                let _ = write!(paths[shade], "M{x:.1} {y:.1}h{w:.1}v-{h:.1}h-{w:.1}z");
            }
            row += same.len();
        }
    }
    for (shade, path) in paths.iter().enumerate().filter(|(_, path)| !path.is_empty()) {
        sheet.outline(path, &fill(shade));
    }
}

fn draw_axes(sheet: &mut Sheet, x: &Span<'_>, y: &Span<'_>) {
    let (values, step) = ticks(0.0, x.end, 8);
    for value in values {
        let across = AT[0] + SIZE[0] * value / x.end;
        sheet.path(&[[across, AT[1] + SIZE[1]], [across, AT[1] + SIZE[1] + 5.0]], false, "stroke:#14181c");
        sheet.text([across, AT[1] + SIZE[1] + 20.0], 12.0, Anchor::Middle, INK, &x.text(value, step));
    }
    let (values, step) = ticks(0.0, y.end, 6);
    for value in values {
        let up = AT[1] + SIZE[1] * (1.0 - value / y.end);
        sheet.path(&[[AT[0] - 5.0, up], [AT[0], up]], false, "stroke:#14181c");
        sheet.text([AT[0] - 8.0, up + 4.0], 12.0, Anchor::End, INK, &y.text(value, step));
    }
    sheet.text([AT[0] + 0.5 * SIZE[0], AT[1] + SIZE[1] + 40.0], 13.0, Anchor::Middle, INK, x.label);
    sheet.upright([18.0, AT[1] + 0.5 * SIZE[1]], 13.0, INK, y.label);
}

fn draw_key(sheet: &mut Sheet, &Shades { top_db, range_db, .. }: &Shades) {
    let x = AT[0] + SIZE[0] + 16.0;
    let step = SIZE[1] / SHADES as f64;
    for n in 0..SHADES {
        let y = AT[1] + SIZE[1] - step * (n + 1) as f64;
        sheet.outline(&format!("M{x:.1} {y:.1}h14v{:.1}h-14z", step + 0.3), &fill(n));
    }
    for (level, y) in [(top_db, AT[1] + 4.0), (top_db - range_db, AT[1] + SIZE[1])] {
        let words =
            if level.is_finite() { Scale::ONE.text(level.round(), 1.0, "dB") } else { "–".to_owned() };
        sheet.text([x + 18.0, y + 4.0], 12.0, Anchor::Start, INK, &words);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ten columns of four lines, whose line 1 is strong and moves nowhere.
    fn course() -> Course {
        let column = [1e-6, 1.0, 1e-6, 1e-6];
        Course { step_s: 0.1, grid_hz: 100.0, lines: 4, values: column.repeat(10) }
    }

    #[test]
    fn behaves_rows_of_a_waterfall_go_by_speed_where_there_is_one() {
        let rows = waterfall_rows(&course(), None);
        assert_eq!((rows.len(), rows[0].0.as_str()), (10, "50 ms"));
        // Columns of one speed are one row, whatever their time.
        let speeds = [600.0, 900.0, 600.0, 900.0, 600.0, 900.0, 600.0, 900.0, 1200.0, f64::NAN];
        let rows = waterfall_rows(&course(), Some(&speeds));
        let told: Vec<&str> = rows.iter().map(|row| row.0.as_str()).collect();
        assert_eq!(told, ["600 rpm", "900 rpm", "1200 rpm"]);
        assert!((rows[0].1[1] - 1.0).abs() < 1e-12);
        // A speed that stands makes no rows.
        assert!(waterfall_rows(&course(), Some(&[600.0; 10])).is_empty());
    }

    /// Cells of one shade above each other were drawn downwards from their foot, out of the picture.
    #[test]
    fn issue_cells_of_a_spectrogram_stay_inside_its_axes() {
        let quiet =
            Course { step_s: 0.1, grid_hz: 100.0, lines: 4, values: [1.0, 1e-9, 1e-9, 1e-9].repeat(10) };
        let svg = picture(&quiet, "g").sheet.to_svg();
        // A rectangle: its foot and how far it goes up.
        let cells = svg.match_indices("v-").filter_map(|(at, _)| {
            let from = svg[..at].rfind('M')?;
            let foot: f64 = svg[from + 1..at].split(['h', ' ']).nth(1)?.parse().ok()?;
            let up: f64 = svg[at + 2..].split('h').next()?.parse().ok()?;
            Some((foot, up))
        });
        let cells: Vec<(f64, f64)> = cells.collect();
        assert!(cells.len() >= 20, "{}", cells.len());
        for (foot, up) in cells {
            assert!(foot <= AT[1] + SIZE[1] + 0.1 && foot - up >= AT[1] - 0.5, "{foot} {up}");
        }
    }

    /// A run-up is louder at its end, and the line of a family was lost in the rise of all orders.
    #[test]
    fn issue_a_line_of_an_order_map_has_one_shade_whatever_the_level() {
        let column = [1.0, 1.0, 1.0, 100.0, 1.0, 1.0];
        let louder: Vec<f64> = (0..10).flat_map(|n| column.map(|power| power * 10_f64.powi(n))).collect();
        let course = Course { step_s: 1.0, grid_hz: 2.4, lines: 6, values: louder };
        let drawn = order_map(&course, (0.0, 1.0), &[]).sheet.to_svg();
        // All cells have one of two shades: the line and the rest, beside the key.
        let of = |shade: usize| drawn.matches(&format!("\"{}\"", fill(shade))).count();
        let used: Vec<usize> = (0..SHADES).filter(|shade| of(*shade) > 1).collect();
        assert_eq!(used.len(), 2, "{used:?}");
    }

    #[test]
    fn behaves_pictures_name_their_axes() {
        let svg = |picture: Picture| picture.sheet.to_svg();
        assert!(svg(picture(&course(), "g")).contains(">Frequency<"));
        assert!(svg(order_map(&course(), (0.0, 1.0), &[])).contains(">Turns of the shaft<"));
        assert!(svg(waterfall(&course(), "g", None).expect("rows")).contains(">20 dB<"));
    }
}
