//! The static form of a figure, for print, for readers without scripts and for the `figures` folder.

use plotters::coord::Shift;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::{Axis, Colour, Figure, Scale, Style, Ticks, decimate, labels, ticks};
use crate::Error;

/// Drawing units a pixel: the library rounds coordinates to whole units, which would turn gentle slopes into
/// stairs.
const FINE: u32 = 4;
/// Height of every picture, without rows of labels [units].
const HEIGHT: u32 = 400 * FINE;
/// Points drawn of one series: two a pixel of the widest chart.
const POINTS: usize = 1800;
/// Height of a text row above the chart [units].
const ROW: u32 = 16 * FINE;
/// Mean width of a character of the 12 px labels [units], measured on Latin text.
const CHARACTER: f64 = 6.3 * FINE as f64;
/// Space left of the chart [units].
const LEFT: u32 = 92 * FINE;
/// Space right of the chart [units].
const RIGHT: u32 = 26 * FINE;
/// Strength of a shaded ground between two series.
const SHADE: f64 = 0.25;
/// Room of a tick and its text on the horizontal axis [units].
const ROOM: i32 = px(84);
/// Space below the chart [units].
const BELOW: u32 = 56 * FINE;

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Chart<'a, 'b> = ChartContext<'b, SVGBackend<'a>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

impl Figure {
    /// The figure as a self-contained SVG document, at most about 1800 points a series (extremes kept).
    pub fn to_svg(&self) -> Result<String, Error> {
        let mut text = String::new();
        let height = self
            .draw(&mut text)
            .map_err(|why| Error::Drawing { figure: self.id.clone(), why: why.to_string() })?;
        let drawn = format!("width=\"{}\" height=\"{height}\"", self.width());
        let shown = format!("width=\"{}\" height=\"{}\"", self.width_px, height / FINE);
        Ok(text.replacen(&drawn, &shown, 1))
    }

    /// Width [units].
    fn width(&self) -> u32 {
        self.width_px * FINE
    }

    /// Draws into `into` and returns the height [units].
    fn draw(&self, into: &mut String) -> Result<u32, Box<dyn std::error::Error>> {
        let (x, y) = (self.x_range(), self.y_range());
        let placed = self.place_labels(x);
        let label_rows = placed.iter().map(|l| l.1 + 1).max().unwrap_or(0) as u32;
        let top = 34 * FINE + ROW * (1 + label_rows);
        let height = HEIGHT + ROW * label_rows;

        let root = SVGBackend::with_string(into, (self.width(), height)).into_drawing_area();
        root.fill(&WHITE)?;
        text(&root, &self.title, (LEFT as i32, px(10)), 17, HPos::Left, &BLACK)?;
        let mut chart = ChartBuilder::on(&root)
            .margin_top(top)
            .margin_left(LEFT)
            .margin_right(RIGHT)
            .margin_bottom(BELOW)
            .build_cartesian_2d(x.0..x.1, y.0..y.1)?;

        self.draw_bands(&chart, x, y)?;
        draw_grid(&root, &chart, (&self.x, x), (&self.y, y))?;
        self.draw_marks(&root, &chart, &placed, y)?;
        self.draw_series(&mut chart, x)?;
        self.draw_levels(&root, &chart, x, y)?;
        self.draw_legend(&root)?;
        root.present()?;
        Ok(height)
    }

    /// Index, row and pixel position of every mark inside the horizontal range `x`.
    fn place_labels(&self, x: (f64, f64)) -> Vec<(usize, usize, f64)> {
        let width = f64::from(self.width() - LEFT - RIGHT);
        let inside: Vec<usize> =
            (0..self.marks.len()).filter(|&i| (x.0..=x.1).contains(&self.marks[i].x)).collect();
        let boxes: Vec<(f64, f64)> = inside
            .iter()
            .map(|&i| {
                let centre = f64::from(LEFT) + width * (self.marks[i].x - x.0) / (x.1 - x.0);
                (centre, CHARACTER * self.marks[i].label.chars().count() as f64 + f64::from(px(8)))
            })
            .collect();
        let rows = labels::rows(&boxes);
        inside.iter().zip(rows).zip(boxes).map(|((&i, row), (centre, _))| (i, row, centre)).collect()
    }

    fn draw_bands(
        &self,
        chart: &Chart<'_, '_>,
        x: (f64, f64),
        y: (f64, f64),
    ) -> Result<(), Box<dyn std::error::Error>> {
        for band in &self.bands {
            let (from, to) = (band.from.max(x.0), band.to.min(x.1));
            if from < to {
                let shade =
                    Rectangle::new([(from, y.0), (to, y.1)], RGBColor(120, 120, 120).mix(0.13).filled());
                chart.plotting_area().draw(&shade)?;
            }
        }
        Ok(())
    }

    fn draw_marks(
        &self,
        root: &Area<'_>,
        chart: &Chart<'_, '_>,
        placed: &[(usize, usize, f64)],
        y: (f64, f64),
    ) -> Result<(), Box<dyn std::error::Error>> {
        let label_y = |row: usize, top: i32| top - px(3) - (ROW as i32) * row as i32;
        for &(i, row, _) in placed {
            let mark = &self.marks[i];
            let (at, top) = chart.backend_coord(&(mark.x, y.1));
            let (_, bottom) = chart.backend_coord(&(mark.x, y.0));
            let from = label_y(row, top);
            let dash = if mark.dashed { px(5) } else { bottom - from };
            for start in (from..bottom).step_by((dash + px(4)).max(1) as usize) {
                let line = [(at, start), (at, (start + dash).min(bottom))];
                root.draw(&PathElement::new(line, mark.colour.rgb().stroke_width(FINE)))?;
            }
        }
        // Labels come after all lines, on ground of their own, so that no line crosses a word.
        for &(i, row, centre) in placed.iter().filter(|p| !self.marks[p.0].label.is_empty()) {
            let mark = &self.marks[i];
            let (_, top) = chart.backend_coord(&(mark.x, y.1));
            let half = (0.5 * CHARACTER * mark.label.chars().count() as f64) as i32;
            let at = (centre as i32).clamp(half + px(4), self.width() as i32 - half - px(4));
            let above = label_y(row, top) - px(14);
            let ground = [(at - half, above), (at + half, above + px(14))];
            root.draw(&Rectangle::new(ground, WHITE.filled()))?;
            text(root, &mark.label, (at, above + px(1)), 12, HPos::Center, &mark.colour.rgb())?;
        }
        Ok(())
    }

    fn draw_series(
        &self,
        chart: &mut Chart<'_, '_>,
        x: (f64, f64),
    ) -> Result<(), Box<dyn std::error::Error>> {
        let edges: Vec<_> = self.series.iter().filter(|s| s.style == Style::Edge).collect();
        for edges in edges.chunks_exact(2) {
            let [one, other] = [0, 1].map(|n| decimate::runs(edges[n], x.0, x.1, POINTS));
            for (there, back) in one.into_iter().zip(other) {
                let ring: Vec<(f64, f64)> = there.into_iter().chain(back.into_iter().rev()).collect();
                let paint = edges[0].colour.rgb().mix(SHADE).filled();
                chart.draw_series(std::iter::once(Polygon::new(ring, paint)))?;
            }
        }
        for series in self.series.iter().filter(|s| s.style != Style::Edge) {
            let colour = series.colour.rgb();
            for run in decimate::runs(series, x.0, x.1, POINTS) {
                match series.style {
                    Style::Line | Style::Edge => {
                        chart.draw_series(LineSeries::new(run, colour.stroke_width(FINE)))?;
                    }
                    Style::Points => {
                        chart.draw_series(run.into_iter().map(|p| Circle::new(p, px(3), colour.filled())))?;
                    }
                }
            }
        }
        Ok(())
    }

    fn draw_levels(
        &self,
        root: &Area<'_>,
        chart: &Chart<'_, '_>,
        x: (f64, f64),
        y: (f64, f64),
    ) -> Result<(), Box<dyn std::error::Error>> {
        for level in self.levels.iter().filter(|l| (y.0..=y.1).contains(&l.y)) {
            let (left, up) = chart.backend_coord(&(x.0, level.y));
            let (right, _) = chart.backend_coord(&(x.1, level.y));
            for start in (left..right).step_by(px(9) as usize) {
                let line = [(start, up), ((start + px(5)).min(right), up)];
                root.draw(&PathElement::new(line, level.colour.rgb().stroke_width(FINE)))?;
            }
        }
        Ok(())
    }

    /// Names of series, bands and levels in one row that ends at the chart's right edge.
    fn draw_legend(&self, root: &Area<'_>) -> Result<(), Box<dyn std::error::Error>> {
        let lines = self.series.iter().map(|s| (s.name.as_str(), s.colour.rgb()));
        let bands = self.bands.iter().map(|b| (b.label.as_str(), RGBColor(205, 205, 205)));
        let levels = self.levels.iter().map(|l| (l.label.as_str(), l.colour.rgb()));
        let whole = lines.chain(bands).map(|(name, colour)| (name, colour, false));
        let mut entries: Vec<(&str, RGBColor, bool)> = Vec::new();
        for entry in whole.chain(levels.map(|(name, colour)| (name, colour, true))) {
            if !entry.0.is_empty() && entries.iter().all(|e| e.0 != entry.0) {
                entries.push(entry);
            }
        }
        let width = |name: &str| (CHARACTER * name.chars().count() as f64) as i32 + px(34);
        let right = (self.width() - RIGHT) as i32;
        let sum = |entries: &[(&str, RGBColor, bool)]| entries.iter().map(|e| width(e.0)).sum::<i32>();
        // The page names below the figure what has no room.
        while sum(&entries) > right {
            entries.pop();
        }
        let mut left = right - sum(&entries);
        for (name, colour, dashed) in entries {
            // A level's key is dashed and fine, as its line.
            let (parts, upper, lower) = if dashed { (2, 39, 41) } else { (1, 38, 42) };
            for part in 0..parts {
                let from = left + px(14) + part * px(9);
                let key = [(from, px(upper)), (from + px(14 / (2 * parts - 1)), px(lower))];
                root.draw(&Rectangle::new(key, colour.filled()))?;
            }
            text(root, name, (left + px(33), px(34)), 12, HPos::Left, &BLACK)?;
            left += width(name);
        }
        Ok(())
    }
}

impl Colour {
    /// On white paper.
    fn rgb(self) -> RGBColor {
        match self {
            Self::Grey => RGBColor(150, 154, 160),
            Self::Blue => RGBColor(0, 94, 162),
            Self::Orange => RGBColor(200, 80, 0),
            Self::Green => RGBColor(0, 128, 96),
            Self::Purple => RGBColor(134, 70, 156),
            Self::Red => RGBColor(179, 32, 44),
            Self::Teal => RGBColor(0, 128, 154),
            Self::Brown => RGBColor(122, 92, 46),
            Self::Pink => RGBColor(194, 64, 143),
            Self::Black => RGBColor(20, 24, 28),
        }
    }
}

/// Ticks, grid lines, frame and axis names. The library's own mesh cannot carry one SI prefix for a whole
/// axis.
fn draw_grid(
    root: &Area<'_>,
    chart: &Chart<'_, '_>,
    (x_axis, x): (&Axis, (f64, f64)),
    (y_axis, y): (&Axis, (f64, f64)),
) -> Result<(), Box<dyn std::error::Error>> {
    let (frame, grid) = (RGBColor(90, 90, 90), RGBColor(226, 226, 226));
    let (left, top) = chart.backend_coord(&(x.0, y.1));
    let (right, bottom) = chart.backend_coord(&(x.1, y.0));
    for (at, name) in tick_texts(x_axis, x, ((right - left) / ROOM) as usize) {
        let (across, _) = chart.backend_coord(&(at, y.0));
        root.draw(&PathElement::new([(across, top), (across, bottom)], grid.stroke_width(FINE)))?;
        text(root, &name, (across, bottom + px(7)), 12, HPos::Center, &BLACK)?;
    }
    for (at, name) in tick_texts(y_axis, y, 7) {
        let (_, up) = chart.backend_coord(&(x.0, at));
        root.draw(&PathElement::new([(left, up), (right, up)], grid.stroke_width(FINE)))?;
        text(root, &name, (left - px(7), up - px(6)), 12, HPos::Right, &BLACK)?;
    }
    root.draw(&Rectangle::new([(left, top), (right, bottom)], frame.stroke_width(FINE)))?;
    text(root, &axis_name(x_axis), ((left + right) / 2, bottom + px(28)), 13, HPos::Center, &BLACK)?;
    let style = ("sans-serif", 13 * FINE).into_font().transform(FontTransform::Rotate270).color(&BLACK);
    let name = axis_name(y_axis);
    root.draw(&Text::new(name, (px(10), (top + bottom) / 2), style.pos(Pos::new(HPos::Center, VPos::Top))))?;
    Ok(())
}

/// Positions and texts of the ticks of one axis.
fn tick_texts(axis: &Axis, (low, high): (f64, f64), wanted: usize) -> Vec<(f64, String)> {
    let written = |(at, step): (Vec<f64>, f64), scale: Scale, unit: &str| -> Vec<(f64, String)> {
        at.into_iter().map(|v| (v, scale.text(v, step, unit))).collect()
    };
    match axis.ticks {
        Ticks::Decades => decade_texts(low, high),
        Ticks::Angle => written(twelfths_of_a_turn(low, high), Scale::ONE, ""),
        Ticks::Counted if !axis.names.is_empty() => {
            axis.names.iter().enumerate().map(|(n, name)| (n as f64 + 1.0, name.clone())).collect()
        }
        Ticks::Counted => written(whole_ticks(low, high, wanted), Scale::ONE, ""),
        Ticks::Plain => written(ticks(low, high, wanted), Scale::ONE, ""),
        Ticks::Prefixed => {
            let ticks = ticks(low, high, wanted);
            let largest = ticks.0.iter().fold(0.0f64, |m, v| m.max(v.abs()));
            written(ticks, Scale::of(largest), &axis.unit)
        }
    }
}

/// Angles [°] are read in twelfths of a turn, not in fifties: those between two, and their step.
fn twelfths_of_a_turn(low: f64, high: f64) -> (Vec<f64>, f64) {
    const STEP_DEG: f64 = 30.0;
    let all = (0..=12).map(|n| STEP_DEG * f64::from(n));
    (all.filter(|a| (low..=high).contains(a)).collect(), STEP_DEG)
}

/// Whole numbers between two, and their step: between two things there is none.
fn whole_ticks(low: f64, high: f64, wanted: usize) -> (Vec<f64>, f64) {
    let (at, step) = ticks(low, high, wanted.min((high - low) as usize).max(1));
    (at.into_iter().filter(|v| v.fract() == 0.0).collect(), step.max(1.0))
}

/// Ticks of a logarithmic axis: powers of ten, and twice and five times them where there are few.
fn decade_texts(low: f64, high: f64) -> Vec<(f64, String)> {
    let steps: &[f64] = if high - low > 4.0 { &[1.0] } else { &[1.0, 2.0, 5.0] };
    let decades = low.floor() as i32..=high.ceil() as i32;
    let values = decades.flat_map(|n| steps.iter().map(move |step| step * 10_f64.powi(n)));
    // Twelve digits: powers of ten are not exact.
    let tick = |value: f64| (value.log10(), format!("{}", (value * 1e12).round() / 1e12));
    values.map(tick).filter(|(at, _)| (low..=high).contains(at)).collect()
}

/// Quantity with its unit in brackets where ticks do not carry the unit already.
fn axis_name(axis: &Axis) -> String {
    if axis.ticks == Ticks::Prefixed || axis.unit.is_empty() {
        axis.label.clone()
    } else {
        format!("{} [{}]", axis.label, axis.unit)
    }
}

/// Conversion of pixels to units.
const fn px(pixels: i32) -> i32 {
    pixels * FINE as i32
}

/// Writes one line of `size` pixels with its upper edge at `at` [units].
fn text(
    root: &Area<'_>,
    words: &str,
    at: (i32, i32),
    size: u32,
    anchor: HPos,
    colour: &impl Color,
) -> Result<(), Box<dyn std::error::Error>> {
    let style = TextStyle::from(("sans-serif", size * FINE)).color(colour).pos(Pos::new(anchor, VPos::Top));
    root.draw(&Text::new(words.to_owned(), at, style))?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn invariant_ticks_of_counted_things_are_whole() {
        for count in [1, 2, 3, 7, 40] {
            let axis = Axis::counted("Record", count);
            let ticks = tick_texts(&axis, axis.range.unwrap(), 8);
            assert!(
                !ticks.is_empty() && ticks.iter().all(|(at, text)| *text == format!("{at}")),
                "{ticks:?}"
            );
        }
    }
}
