//! The interactive form of a figure: its data as JSON for uPlot, which the page carries along.

use maud::{Markup, PreEscaped, html};
use serde::Serialize;

use super::{Abscissa, Axis, Colour, Cursor, Figure, Series, Style, Ticks, base64, decimate};
use crate::Error;

/// Points sent to the page for one series; beyond that extremes are kept and the figure says so.
pub(super) const POINT_LIMIT: usize = 10_000;

/// Data that `plot.js` reads.
#[derive(Serialize)]
struct Sent<'a> {
    x: SentAxis<'a>,
    y: SentAxis<'a>,
    series: Vec<SentSeries<'a>>,
    marks: Vec<SentMark<'a>>,
    bands: Vec<(f64, f64)>,
    levels: Vec<SentLevel>,
    sync: Option<&'a str>,
    run_time: bool,
    wide: Option<(f64, f64)>,
    cursor: Option<&'a Cursor>,
}

#[derive(Serialize)]
struct SentAxis<'a> {
    label: &'a str,
    unit: &'a str,
    ticks: Ticks,
    range: Option<(f64, f64)>,
    names: &'a [String],
}

#[derive(Serialize)]
struct SentSeries<'a> {
    name: &'a str,
    colour: &'static str,
    points: bool,
    edge: bool,
    /// Start and step, when uniform.
    uniform: Option<(f64, f64)>,
    /// Listed positions less `origin`, base64 f32.
    x: Option<String>,
    origin: f64,
    /// Values, base64 f32.
    y: String,
}

#[derive(Serialize)]
struct SentMark<'a> {
    x: f64,
    label: &'a str,
    colour: &'static str,
    dashed: bool,
}

#[derive(Serialize)]
struct SentLevel {
    y: f64,
    colour: &'static str,
}

impl Figure {
    /// The figure for the page: chart, static picture for print, caption, note and data.
    pub fn to_html(&self) -> Result<Markup, Error> {
        let still = self.to_svg()?;
        let data = self.data()?;
        let shortened = self.series.iter().any(|s| s.y.len() > POINT_LIMIT);
        Ok(html! {
            figure id=(self.id) class="plot" {
                h3 { (self.title) }
                p class="caption" { (self.caption) }
                div class="chart" tabindex="0" role="img" aria-label=(self.title) {}
                div class="still" { (PreEscaped(still)) }
                @if !self.bands.is_empty() || self.levels.iter().any(|level| !level.label.is_empty()) {
                    p class="key" {
                        @for band in &self.bands { span class="shade" {} (band.label) " " }
                        @for level in self.levels.iter().filter(|level| !level.label.is_empty()) {
                            span class="level" style=(format!("border-color: var({})", level.colour.name())) {} (level.label) " "
                        }
                    }
                }
                @if !self.note.is_empty() || shortened {
                    p class="note" {
                        (self.note)
                        @if shortened { " Of the samples of each pixel the highest and the lowest are drawn." }
                    }
                }
                script type="application/json" { (PreEscaped(data)) }
            }
        })
    }

    /// JSON that is safe inside a script element.
    fn data(&self) -> Result<String, Error> {
        let sent = Sent {
            x: SentAxis::of(&self.x),
            y: SentAxis::of(&self.y),
            series: self.series.iter().map(SentSeries::of).collect(),
            marks: self
                .marks
                .iter()
                .map(|m| SentMark { x: m.x, label: &m.label, colour: m.colour.name(), dashed: m.dashed })
                .collect(),
            bands: self.bands.iter().map(|b| (b.from, b.to)).collect(),
            levels: self.levels.iter().map(|l| SentLevel { y: l.y, colour: l.colour.name() }).collect(),
            sync: self.sync.as_deref(),
            run_time: self.run_time,
            wide: self.wide,
            cursor: self.cursor.as_ref(),
        };
        let text = serde_json::to_string(&sent)
            .map_err(|why| Error::Drawing { figure: self.id.clone(), why: why.to_string() })?;
        // "</script" inside a label would end the element.
        Ok(text.replace('<', "\\u003c"))
    }
}

impl<'a> SentAxis<'a> {
    fn of(axis: &'a Axis) -> Self {
        Self {
            label: &axis.label,
            unit: &axis.unit,
            ticks: axis.ticks,
            range: axis.range,
            names: &axis.names,
        }
    }
}

impl<'a> SentSeries<'a> {
    fn of(series: &'a Series) -> Self {
        let (name, colour) = (series.name.as_str(), series.colour.name());
        let (points, edge) = (series.style == Style::Points, series.style == Style::Edge);
        match &series.x {
            Abscissa::Uniform { start, step } if series.y.len() <= POINT_LIMIT => Self {
                name,
                colour,
                points,
                edge,
                uniform: Some((*start, *step)),
                x: None,
                origin: 0.0,
                y: base64::floats(&series.y),
            },
            _ => {
                let kept = thinned(series);
                let origin = kept.first().map_or(0.0, |p| p.0);
                let (x, y): (Vec<f64>, Vec<f64>) = kept.iter().map(|p| (p.0 - origin, p.1)).unzip();
                Self {
                    name,
                    colour,
                    points,
                    edge,
                    uniform: None,
                    x: Some(base64::floats(&x)),
                    origin,
                    y: base64::floats(&y),
                }
            }
        }
    }
}

/// The points to send, a gap between runs marked by a value that is not a number.
fn thinned(series: &Series) -> Vec<(f64, f64)> {
    let mut kept: Vec<(f64, f64)> = Vec::new();
    for run in decimate::runs(series, f64::NEG_INFINITY, f64::INFINITY, POINT_LIMIT) {
        if let (Some(last), Some(first)) = (kept.last(), run.first()) {
            kept.push((0.5 * (last.0 + first.0), f64::NAN));
        }
        kept.extend(run);
    }
    kept
}

impl Colour {
    /// Name of the CSS variable that holds it in the current theme.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Grey => "--c-grey",
            Self::Blue => "--c-blue",
            Self::Orange => "--c-orange",
            Self::Green => "--c-green",
            Self::Purple => "--c-purple",
            Self::Red => "--c-red",
            Self::Teal => "--c-teal",
            Self::Brown => "--c-brown",
            Self::Pink => "--c-pink",
            Self::Black => "--ink",
        }
    }
}

/// Style sheets and scripts that a page with figures needs: uPlot (MIT) and the code that feeds it.
pub fn script() -> Markup {
    html! {
        // The licence asks for its text in every copy, and every page is one.
        (PreEscaped(concat!("<!-- uPlot:\n", include_str!("../../assets/uPlot.LICENSE"), "-->")))
        style { (PreEscaped(include_str!("../../assets/uPlot.min.css"))) }
        script { (PreEscaped(include_str!("../../assets/uPlot.iife.min.js"))) }
        script { (PreEscaped(include_str!("../../assets/cursors.js"))) }
        script { (PreEscaped(include_str!("../../assets/plot.js"))) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn behaves_a_label_cannot_end_the_script() {
        let figure = Figure::new("x", "t", Axis::plain("</script>", ""), Axis::plain("y", ""))
            .with(Series::sampled("s", Colour::Blue, 0.0, 1.0, vec![1.0, 2.0]));
        assert!(!figure.data().unwrap().contains("</script>"));
    }
}
