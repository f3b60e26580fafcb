//! Pictures that are no charts: a mesh, a roller, a polar plot, stresses. Plain SVG on white paper.

use std::fmt::Write;

use maud::{Markup, PreEscaped, html};

use super::{Colour, Tab};

/// One picture with its caption.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// Name of the anchor in the page and of the files; letters, digits and `-`.
    pub id: String,
    /// Heading.
    pub title: String,
    /// One sentence that states the finding.
    pub caption: String,
    /// Limits of the picture. May be empty.
    pub note: String,
    /// The drawing.
    pub sheet: Sheet,
    /// Where it is one of several that stand behind tabs.
    pub tab: Option<Tab>,
}

/// A drawing in pixels, x to the right and y down.
#[derive(Debug, Clone, PartialEq)]
pub struct Sheet {
    width: f64,
    height: f64,
    body: String,
}

/// Where a text stands relative to its point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Anchor {
    /// The point is its left end.
    Start,
    /// The point is its middle.
    Middle,
    /// The point is its right end.
    End,
}

impl Sheet {
    /// An empty drawing.
    pub fn new(width: f64, height: f64) -> Self {
        Self { width, height, body: String::new() }
    }

    /// A line through points; `closed` joins its ends. `paint` is a CSS style: `fill:none;stroke:#000`.
    pub fn path(&mut self, points: &[[f64; 2]], closed: bool, paint: &str) {
        let _ = write!(self.body, "<path d=\"");
        self.points(points);
        let _ = write!(self.body, "{}\" style=\"{paint}\"/>", if closed { "z" } else { "" });
    }

    /// An outline as SVG writes it: `M0 0h5v3h-5z`.
    pub fn outline(&mut self, data: &str, paint: &str) {
        let _ = write!(self.body, "<path d=\"{data}\" style=\"{paint}\"/>");
    }

    /// Many separate lines in one element, each end relative to the one before it and to a tenth of a pixel: a
    /// mesh has hundreds of thousands.
    pub fn lines(&mut self, lines: impl IntoIterator<Item = [[f64; 2]; 2]>, paint: &str) {
        let _ = write!(self.body, "<path d=\"");
        let mut pen = [0; 2];
        for point in lines.into_iter().flat_map(|[from, to]| [('m', from), ('l', to)]) {
            let (command, at) = (point.0, point.1.map(|x| (10.0 * x).round() as i64));
            let [dx, dy] = [0, 1].map(|axis| (at[axis] - pen[axis]) as f64 / 10.0);
            let _ = write!(self.body, "{command}{dx} {dy}");
            pen = at;
        }
        let _ = write!(self.body, "\" style=\"{paint}\"/>");
    }

    fn points(&mut self, points: &[[f64; 2]]) {
        for (n, [x, y]) in points.iter().enumerate() {
            let _ = write!(self.body, "{}{x:.2} {y:.2}", if n == 0 { "M" } else { "L" });
        }
    }

    /// A circle.
    pub fn circle(&mut self, [x, y]: [f64; 2], radius: f64, paint: &str) {
        let _ =
            write!(self.body, "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"{radius:.2}\" style=\"{paint}\"/>");
    }

    /// One line of text.
    pub fn text(&mut self, [x, y]: [f64; 2], size: f64, anchor: Anchor, colour: &str, words: &str) {
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let words = words.replace('&', "&amp;").replace('<', "&lt;");
        let _ = write!(
            self.body,
            "<text x=\"{x:.1}\" y=\"{y:.1}\" font-family=\"sans-serif\" font-size=\"{size}\" \
             text-anchor=\"{anchor}\" fill=\"{colour}\">{words}</text>"
        );
    }

    /// One line of text from below upwards, its middle at the point.
    pub fn upright(&mut self, [x, y]: [f64; 2], size: f64, colour: &str, words: &str) {
        let words = words.replace('&', "&amp;").replace('<', "&lt;");
        let _ = write!(
            self.body,
            "<text transform=\"translate({x:.1} {y:.1}) rotate(-90)\" font-family=\"sans-serif\" \
             font-size=\"{size}\" text-anchor=\"middle\" fill=\"{colour}\">{words}</text>"
        );
    }

    /// Clips the drawing of `draw` to a rectangle.
    pub fn clipped(&mut self, name: &str, at: [f64; 2], size: [f64; 2], draw: impl FnOnce(&mut Self)) {
        let ([x, y], [w, h]) = (at, size);
        let _ = write!(
            self.body,
            "<clipPath id=\"{name}\"><rect x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\"/></clipPath><g \
             clip-path=\"url(#{name})\">"
        );
        draw(self);
        self.body.push_str("</g>");
    }

    /// The drawing as a self-contained SVG document.
    pub fn to_svg(&self) -> String {
        let (w, h) = (self.width, self.height);
        format!(
            "<svg width=\"{w}\" height=\"{h}\" viewBox=\"0 0 {w} {h}\" xmlns=\"http://www.w3.org/2000/svg\">\
             <rect width=\"{w}\" height=\"{h}\" fill=\"#fff\"/>{}</svg>\n",
            self.body
        )
    }
}

impl Picture {
    /// A picture of `sheet`.
    pub fn new(id: &str, title: &str, sheet: Sheet) -> Self {
        Self {
            id: id.into(),
            title: title.into(),
            caption: String::new(),
            note: String::new(),
            sheet,
            tab: None,
        }
    }

    /// Puts the picture behind a tab of a group.
    pub fn tabbed(mut self, group: &'static str, label: impl Into<String>) -> Self {
        self.tab = Some(Tab { group, label: label.into() });
        self
    }

    /// The picture for the page: drawing, caption and note.
    pub fn to_html(&self) -> Markup {
        html! {
            figure id=(self.id) class="picture" {
                h3 { (self.title) }
                p class="caption" { (self.caption) }
                div class="drawing" { (PreEscaped(self.sheet.to_svg())) }
                @if !self.note.is_empty() { p class="note" { (self.note) } }
            }
        }
    }
}

impl Colour {
    /// The colour on white paper, as CSS writes it.
    pub fn css(self) -> &'static str {
        match self {
            Self::Grey => "#969aa0",
            Self::Blue => "#005ea2",
            Self::Orange => "#c85000",
            Self::Green => "#008060",
            Self::Purple => "#86469c",
            Self::Red => "#b3202c",
            Self::Teal => "#00809a",
            Self::Brown => "#7a5c2e",
            Self::Pink => "#c2408f",
            Self::Black => "#14181c",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn behaves_a_sheet_is_well_formed_and_its_words_are_escaped() {
        let mut sheet = Sheet::new(100.0, 50.0);
        sheet.clipped("c", [0.0, 0.0], [50.0, 50.0], |s| {
            s.path(&[[0.0, 0.0], [10.0, 5.0]], true, "fill:none")
        });
        sheet.text([5.0, 5.0], 12.0, Anchor::Middle, "#000", "a < b & c");
        let svg = sheet.to_svg();
        assert!(svg.contains("a &lt; b &amp; c") && svg.contains("M0.00 0.00L10.00 5.00z"), "{svg}");
        assert_eq!(svg.matches("<g").count(), svg.matches("</g>").count());
    }
}
