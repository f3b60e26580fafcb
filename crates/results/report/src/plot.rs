//! Figures as data, apart from how they are drawn. One [`Figure`] becomes an interactive chart in the page
//! and a static SVG beside it.
//!
//! ```
//! use stribeck_report::plot::{Axis, Colour, Figure, Series};
//!
//! let sine = (0..=200).map(|n| (0.1 * n as f64).sin()).collect();
//! let figure = Figure::new("sine", "A measured sine", Axis::si("Time", "s"), Axis::plain("Level", "g"))
//!     .with(Series::sampled("sensor", Colour::Blue, 0.0, 1e-3, sine));
//! let svg = figure.to_svg()?;
//! assert!(svg.contains("A measured sine") && svg.contains("200 ms"));
//! # Ok::<(), stribeck_report::Error>(())
//! ```

pub(crate) mod base64;
mod decimate;
mod interactive;
mod labels;
mod picture;
mod raster;
mod scale;
mod shade;
mod svg;

pub(crate) use base64::bytes as base64_bytes;

pub use interactive::script;
pub use picture::{Anchor, Picture, Sheet};
pub use raster::png;
pub use scale::{Scale, ticks};
use serde::Serialize;
pub use shade::shade_rgb;

/// One chart: an abscissa, an ordinate, the series over them, and a caption.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// Name of the anchor in the page and of the SVG file; letters, digits and `-`.
    pub id: String,
    /// Heading.
    pub title: String,
    /// One sentence that states the finding.
    pub caption: String,
    /// Limits of the figure: resolution, transient, decimation. May be empty.
    pub note: String,
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// Curves, drawn in this order.
    pub series: Vec<Series>,
    /// Vertical lines with a label above the chart.
    pub marks: Vec<Mark>,
    /// Shaded spans of the abscissa.
    pub bands: Vec<Band>,
    /// Horizontal lines with a label at their right end.
    pub levels: Vec<Level>,
    /// Figures with the same key share the cursor.
    pub sync: Option<String>,
    /// Whether the abscissa is the time of the run, which the moving bearing shares.
    pub run_time: bool,
    /// A wider range of the abscissa, one click away.
    pub wide: Option<(f64, f64)>,
    /// Harmonic and sideband cursors of a spectrum.
    pub cursor: Option<Cursor>,
    /// Where it is one of several that stand behind tabs.
    pub tab: Option<Tab>,
    /// Width of its static form [px].
    pub width_px: u32,
}

/// Width of a static figure, unless it says otherwise [px].
const WIDTH_PX: u32 = 960;

/// Cursors of a spectrum, for the reader: lines at multiples of a frequency, or about one at equal distances.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Cursor {
    /// Names and frequencies to choose from [unit of the horizontal axis].
    pub known: Vec<(String, f64)>,
}

/// A place among figures of which a page shows one at a time.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Tab {
    /// Figures of the same group that follow each other share a frame.
    pub group: &'static str,
    /// Words on the tab.
    pub label: String,
}

/// An axis: the quantity, its unit and, when it is fixed, its range.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// Quantity, in words.
    pub label: String,
    /// Unit symbol of the values as stored.
    pub unit: String,
    /// Kind of its values, which decides how ticks are placed and written.
    pub ticks: Ticks,
    /// Range [unit]; `None` follows the data.
    pub range: Option<(f64, f64)>,
    /// Names in place of the numbers 1, 2 and so on; empty without.
    pub names: Vec<String>,
}

/// Kind of an axis's values, which decides how ticks are placed and written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Ticks {
    /// Numbers in a unit that takes no prefix.
    Plain,
    /// Numbers in a coherent SI unit: ticks carry a prefix (`5 ms`, `10 kHz`).
    Prefixed,
    /// Angles [°]: ticks are twelfths of a turn.
    Angle,
    /// Decimal logarithms: ticks are powers of ten, and 2 and 5 times them.
    Decades,
    /// Numbers of things: ticks are whole.
    Counted,
}

/// A curve or a set of points.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// Name in the legend.
    pub name: String,
    /// Where the values stand on the horizontal axis.
    pub x: Abscissa,
    /// Values [unit of the vertical axis]; a value that is not finite is a gap.
    pub y: Vec<f64>,
    /// Colour.
    pub colour: Colour,
    /// How it is drawn.
    pub style: Style,
}

/// Horizontal positions of a series.
#[derive(Debug, Clone, PartialEq)]
pub enum Abscissa {
    /// `start + n · step` [unit of the axis].
    Uniform {
        /// Position of the first value.
        start: f64,
        /// Distance between neighbours, positive.
        step: f64,
    },
    /// One position a value, ascending.
    Listed(Vec<f64>),
}

/// How a series is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Style {
    /// Joined by straight lines.
    Line,
    /// Separate dots.
    Points,
    /// The upper edge of a shaded ground; the next series of this style, at the same positions, is the lower.
    Edge,
}

/// Colours that stay apart for every kind of colour vision, in light and in dark.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Colour {
    /// Background data, drawn behind.
    Grey,
    /// First foreground.
    Blue,
    /// Second foreground.
    Orange,
    /// Third foreground.
    Green,
    /// Fourth foreground.
    Purple,
    /// Fifth foreground.
    Red,
    /// Sixth foreground.
    Teal,
    /// Seventh foreground.
    Brown,
    /// Eighth foreground.
    Pink,
    /// The colour of the text.
    Black,
}

impl Colour {
    /// The foregrounds in their order: curves of one kind take them one after the other.
    pub const FOREGROUNDS: [Self; 8] =
        [Self::Blue, Self::Orange, Self::Green, Self::Purple, Self::Red, Self::Teal, Self::Brown, Self::Pink];
}

/// A vertical line.
#[derive(Debug, Clone, PartialEq)]
pub struct Mark {
    /// Position [unit of the horizontal axis].
    pub x: f64,
    /// Label; an empty one draws the line only.
    pub label: String,
    /// Colour.
    pub colour: Colour,
    /// Dashed lines are predictions, solid ones measurements.
    pub dashed: bool,
}

impl Mark {
    /// A line at `x` with its label.
    pub fn new(x: f64, label: impl Into<String>, colour: Colour, dashed: bool) -> Self {
        Self { x, label: label.into(), colour, dashed }
    }
}

/// A shaded span of the horizontal axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Band {
    /// Left end [unit of the horizontal axis].
    pub from: f64,
    /// Right end [unit of the horizontal axis].
    pub to: f64,
    /// Meaning of the shade, listed in the legend.
    pub label: String,
}

/// A horizontal line, dashed.
#[derive(Debug, Clone, PartialEq)]
pub struct Level {
    /// Position [unit of the vertical axis].
    pub y: f64,
    /// Label; an empty one draws the line only.
    pub label: String,
    /// Colour.
    pub colour: Colour,
}

impl Figure {
    /// An empty chart.
    pub fn new(id: &str, title: &str, x: Axis, y: Axis) -> Self {
        Self {
            id: id.into(),
            title: title.into(),
            caption: String::new(),
            note: String::new(),
            x,
            y,
            series: Vec::new(),
            marks: Vec::new(),
            bands: Vec::new(),
            levels: Vec::new(),
            sync: None,
            run_time: false,
            wide: None,
            cursor: None,
            width_px: WIDTH_PX,
            tab: None,
        }
    }

    /// Adds a series.
    pub fn with(mut self, series: Series) -> Self {
        self.series.push(series);
        self
    }

    /// Sets the caption: one sentence that states the finding.
    pub fn caption(mut self, text: impl Into<String>) -> Self {
        self.caption = text.into();
        self
    }

    /// Sets the note on the figure's limits.
    pub fn note(mut self, text: impl Into<String>) -> Self {
        self.note = text.into();
        self
    }

    /// Shares the cursor with every figure of the same key, and the time of the run with the moving bearing.
    pub fn synced(mut self, key: &str) -> Self {
        self.sync = Some(key.into());
        self.run_time = true;
        self
    }

    /// Puts the figure behind a tab of a group.
    pub fn tabbed(mut self, group: &'static str, label: impl Into<String>) -> Self {
        self.tab = Some(Tab { group, label: label.into() });
        self
    }

    /// Range of the horizontal axis: the fixed one or that of the data, widened when it is a point.
    pub fn x_range(&self) -> (f64, f64) {
        self.x.range.unwrap_or_else(|| {
            let ends = self.series.iter().filter_map(|s| {
                let last = s.y.len().checked_sub(1)?;
                Some([s.position(0), s.position(last)])
            });
            widened(ends.flatten(), 0.0)
        })
    }

    /// Range of the vertical axis: the fixed one or that of the data inside the horizontal range, with a
    /// margin.
    pub fn y_range(&self) -> (f64, f64) {
        self.y.range.unwrap_or_else(|| {
            let (from, to) = self.x_range();
            let seen = self.series.iter().flat_map(|s| {
                (0..s.y.len()).filter(move |&n| (from..=to).contains(&s.position(n))).map(|n| s.y[n])
            });
            widened(seen.chain(self.levels.iter().map(|l| l.y)), 0.04)
        })
    }
}

impl Axis {
    /// An axis in a coherent SI unit, whose ticks carry a prefix.
    pub fn si(label: &str, unit: &str) -> Self {
        Self { ticks: Ticks::Prefixed, ..Self::plain(label, unit) }
    }

    /// An axis whose unit takes no prefix (g, dB, %).
    pub fn plain(label: &str, unit: &str) -> Self {
        Self { label: label.into(), unit: unit.into(), ticks: Ticks::Plain, range: None, names: Vec::new() }
    }

    /// An axis of angles over a whole turn [°].
    pub fn angle(label: &str) -> Self {
        Self { ticks: Ticks::Angle, ..Self::plain(label, "°") }.over(0.0, 360.0)
    }

    /// A logarithmic axis: the figure holds decimal logarithms, its ticks show the numbers themselves.
    pub fn decades(label: &str, unit: &str) -> Self {
        Self { ticks: Ticks::Decades, ..Self::plain(label, unit) }
    }

    /// An axis of numbers of things, counted from 1: records, runs.
    pub fn counted(label: &str, count: usize) -> Self {
        Self { ticks: Ticks::Counted, ..Self::plain(label, "") }.over(0.5, count as f64 + 0.5)
    }

    /// An axis of names, at 1, 2 and so on.
    pub fn named(label: &str, names: Vec<String>) -> Self {
        let counted = Self::counted(label, names.len());
        Self { names, ..counted }
    }

    /// The same axis over a fixed range.
    pub fn over(mut self, from: f64, to: f64) -> Self {
        self.range = Some((from, to));
        self
    }
}

impl Series {
    /// A line through values sampled at a constant step.
    pub fn sampled(name: &str, colour: Colour, start: f64, step: f64, y: Vec<f64>) -> Self {
        Self { name: name.into(), x: Abscissa::Uniform { start, step }, y, colour, style: Style::Line }
    }

    /// A line through listed points; `x` ascends and is as long as `y`.
    pub fn listed(name: &str, colour: Colour, x: Vec<f64>, y: Vec<f64>) -> Self {
        Self { name: name.into(), x: Abscissa::Listed(x), y, colour, style: Style::Line }
    }

    /// The same series as separate dots.
    pub fn as_points(mut self) -> Self {
        self.style = Style::Points;
        self
    }

    /// The same series as an edge of a shaded ground.
    pub fn as_edge(mut self) -> Self {
        self.style = Style::Edge;
        self
    }

    /// Horizontal position of value `n`; not a number past the end of a listed abscissa.
    pub fn position(&self, n: usize) -> f64 {
        match &self.x {
            Abscissa::Uniform { start, step } => start + step * n as f64,
            Abscissa::Listed(x) => x.get(n).copied().unwrap_or(f64::NAN),
        }
    }
}

/// Smallest range that holds the finite `values` and a `margin` of its length on either side; never a point.
fn widened(values: impl Iterator<Item = f64>, margin: f64) -> (f64, f64) {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for v in values.filter(|v| v.is_finite()) {
        low = low.min(v);
        high = high.max(v);
    }
    if low > high {
        return (0.0, 1.0);
    }
    let least = 1e-12 * low.abs().max(high.abs());
    if high - low <= least {
        let half = (0.5 * high.abs()).max(f64::MIN_POSITIVE.sqrt());
        return (low - half, high + half);
    }
    let extra = margin * (high - low);
    (low - extra, high + extra)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn behaves_ranges_are_never_points_and_ignore_gaps() {
        let line = |y: Vec<f64>| {
            Figure::new("f", "f", Axis::plain("x", ""), Axis::plain("y", "g")).with(Series::sampled(
                "s",
                Colour::Blue,
                0.0,
                1.0,
                y,
            ))
        };
        let (low, high) = line(vec![3.0, 3.0]).y_range();
        assert!(low < 3.0 && high > 3.0);
        let (low, high) = line(vec![f64::NAN, -1.0, 2.0]).y_range();
        assert!((low, high) == (-1.12, 2.12), "{low} {high}");
        assert_eq!(line(vec![]).y_range(), (0.0, 1.0));
    }
}
