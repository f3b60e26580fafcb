//! Pictures of the rows of a study, as its plan describes them.

use anyhow::Result;
use serde::Deserialize;
use stribeck_report::plot::{Axis, Colour, Figure, Level, Series};

use crate::rows::{Rows, matches};

/// A picture of numbers in the rows.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Drawing {
    /// The file is `STUDY-ID.svg`.
    pub(crate) id: String,
    title: String,
    #[serde(default)]
    caption: String,
    x: Scale,
    y: Scale,
    curves: Vec<Curve>,
    /// Horizontal lines: value, label and the number of the curve whose colour they have.
    #[serde(default)]
    levels: Vec<(f64, String, usize)>,
}

/// An axis: quantity, unit and kind.
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct Scale(String, String, Kind);

#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
enum Kind {
    Plain,
    Prefixed,
    /// Powers of ten.
    Decades,
    /// 20 log₁₀.
    Decibels,
}

/// One curve: the quantities along both axes of some variants of a table, ascending.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Curve {
    pub(crate) name: String,
    pub(crate) table: String,
    /// Names or patterns of them; all where there is none.
    #[serde(default)]
    pub(crate) variants: Vec<String>,
    pub(crate) x: String,
    pub(crate) y: String,
    /// Points that are not joined.
    #[serde(default)]
    points: bool,
    /// Standard errors of y, drawn as bars.
    #[serde(default)]
    error: Option<String>,
}

impl Scale {
    fn axis(&self) -> Axis {
        let Self(label, unit, kind) = self;
        match kind {
            Kind::Plain | Kind::Decibels => Axis::plain(label, unit),
            Kind::Prefixed => Axis::si(label, unit),
            Kind::Decades => Axis::decades(label, unit),
        }
    }

    fn place(&self, value: f64) -> f64 {
        match self.2 {
            Kind::Plain | Kind::Prefixed => value,
            Kind::Decades => value.log10(),
            Kind::Decibels => 20.0 * value.log10(),
        }
    }
}

impl Drawing {
    /// The picture, with the values that there are.
    pub(crate) fn of(&self, rows: &Rows) -> Figure {
        let mut figure =
            Figure::new(&self.id, &self.title, self.x.axis(), self.y.axis()).caption(self.caption.clone());
        let colours = || Colour::FOREGROUNDS.into_iter().chain([Colour::Grey, Colour::Black]).cycle();
        for (curve, colour) in self.curves.iter().zip(colours()) {
            let is_meant = |variant: &str| {
                curve.variants.is_empty() || curve.variants.iter().any(|pattern| matches(pattern, variant))
            };
            let of = rows.column(&curve.table, &curve.x).into_iter().filter(|(variant, _)| is_meant(variant));
            let number = |variant: &str, quantity: &str| rows.number(&curve.table, variant, quantity);
            let mut points = Vec::new();
            for (name, x) in of {
                let Some(y) = number(name, &curve.y) else { continue };
                points.push((self.x.place(x), self.y.place(y)));
                if let Some(error) = curve.error.as_ref().and_then(|error| number(name, error)) {
                    let ends = [y - error, y + error].map(|y| self.y.place(y));
                    figure.series.push(Series::listed("", colour, vec![self.x.place(x); 2], ends.to_vec()));
                }
            }
            points.retain(|(x, y): &(f64, f64)| x.is_finite() && y.is_finite());
            points.sort_by(|a, b| a.0.total_cmp(&b.0));
            let (x, y) = points.into_iter().unzip();
            let series = Series::listed(&curve.name, colour, x, y);
            figure.series.push(if curve.points { series.as_points() } else { series });
        }
        for (value, label, curve) in &self.levels {
            let colour = colours().nth(*curve).unwrap_or(Colour::Grey);
            figure.levels.push(Level { y: self.y.place(*value), label: label.clone(), colour });
        }
        figure.series.retain(|series| !series.y.is_empty());
        figure
    }
}

/// Draws a picture beside the page of a study.
pub(crate) fn draw(study: &str, figure: &Figure) -> Result<()> {
    crate::write(&crate::results().join(format!("{study}-{}.svg", figure.id)), &figure.to_svg()?)
}
