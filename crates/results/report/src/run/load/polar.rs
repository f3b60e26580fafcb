//! The load zone as a polar plot: force at each angle of the outer raceway, at rest and in motion.

use stribeck_scene::housing::HousingScene;
use stribeck_scene::resolved::ResolvedScene;

use crate::plot::{Anchor, Colour, Picture, Sheet};
use stribeck_analysis::findings::Findings;
use stribeck_diagnosis::words::numbers::kilonewtons;

const SIZE: f64 = 620.0;
/// Radius of the raceway and of the largest force above it [px].
const RACE: f64 = 90.0;
const REACH: f64 = 180.0;

/// Static beside dynamic; `None` without recorded rollers.
pub(super) fn picture(scene: &ResolvedScene, findings: &Findings) -> Option<Picture> {
    let dynamic = &findings.distribution;
    let finite = |values: &[f64]| values.iter().copied().filter(|v| v.is_finite()).fold(0.0, f64::max);
    let static_curve = findings.static_curve.as_ref();
    let at_rest = static_curve.map(|c| finite(&c.force_n));
    let largest_n = finite(&dynamic.mean_n).max(at_rest.unwrap_or(0.0));
    if largest_n <= 0.0 {
        return None;
    }
    let mut polar = Polar { largest_n, sheet: Sheet::new(SIZE, SIZE) };
    polar.draw_grid();
    for edges in findings.prediction.standing_spalls() {
        polar.draw_sector(edges.trailing_deg, edges.leading_deg);
    }
    if let Some(curve) = static_curve {
        polar.draw_curve(curve.angle_deg.iter().zip(&curve.force_n), Colour::Orange);
    }
    let known = dynamic.angle_deg.iter().zip(&dynamic.mean_n).filter(|(_, f)| f.is_finite());
    polar.draw_curve(known, Colour::Blue);
    let spalled = findings.prediction.standing_spalls().next().is_some();
    polar.draw_key(spalled);
    let mut picture = Picture::new("load-polar", "Load zone", polar.sheet);
    picture.caption = format!(
        "The side towards the load carries it{}. Largest mean in motion {}, at rest {}.",
        if spalled { "; over a spall less is carried, and the neighbours take it over" } else { "" },
        kilonewtons(finite(&dynamic.mean_n)),
        at_rest.map_or("–".into(), kilonewtons)
    );
    let elastic = match &scene.written.housing {
        HousingScene::Rigid(_) | HousingScene::Machine(_) => "",
        HousingScene::Adapter => {
            "; an elastic ring, which bears on the edges of an adapter, spreads the load otherwise"
        }
        _ => "; an elastic ring spreads the load otherwise",
    };
    picture.note = format!(
        "In motion: mean over all rollers and samples in bins of 1°. At rest: Stribeck and Sjövall, rigid \
         rings with clearance{elastic}."
    );
    Some(picture)
}

/// A polar diagram of forces above the raceway.
struct Polar {
    /// Force at the rim [N].
    largest_n: f64,
    sheet: Sheet,
}

impl Polar {
    /// Middle of the diagram [px].
    const MIDDLE: [f64; 2] = [0.5 * SIZE, 0.5 * SIZE];

    /// Radius of a force [px].
    fn radius(&self, force_n: f64) -> f64 {
        RACE + REACH * force_n / self.largest_n
    }

    /// Place of a force at an angle, counter-clockwise from the x axis [px].
    fn at(&self, deg: f64, force_n: f64) -> [f64; 2] {
        let (sin, cos) = deg.to_radians().sin_cos();
        let radius = self.radius(force_n);
        [Self::MIDDLE[0] + radius * cos, Self::MIDDLE[1] - radius * sin]
    }

    /// Circles of equal force and rays of equal angle.
    fn draw_grid(&mut self) {
        let step = round_step(self.largest_n);
        let mut level = 0.0;
        while level <= self.largest_n {
            let radius = self.radius(level);
            self.sheet.circle(Self::MIDDLE, radius, "fill:none;stroke:#d8dde2");
            let at = [Self::MIDDLE[0] + 4.0, Self::MIDDLE[1] + radius - 3.0];
            self.sheet.text(at, 11.0, Anchor::Start, "#5c6670", &kilonewtons(level));
            level += step;
        }
        for deg in (0..360).step_by(30).map(f64::from) {
            let ray = [self.at(deg, 0.0), self.at(deg, self.largest_n)];
            self.sheet.path(&ray, false, "fill:none;stroke:#e6e9ec");
            let end = self.at(deg, 1.09 * self.largest_n);
            let words = format!("{deg:.0} °");
            self.sheet.text([end[0], end[1] + 4.0], 12.0, Anchor::Middle, "#5c6670", &words);
        }
    }

    /// The angles over a spall.
    fn draw_sector(&mut self, from_deg: f64, to_deg: f64) {
        let span = |n: usize| from_deg + (to_deg - from_deg) * n as f64 / 12.0;
        let mut sector: Vec<[f64; 2]> = (0..=12).map(|n| self.at(span(n), self.largest_n)).collect();
        sector.extend((0..=12).rev().map(|n| self.at(span(n), 0.0)));
        self.sheet.path(&sector, true, "fill:#b3202c;fill-opacity:0.12");
    }

    /// Forces by angle; a pull counts as nothing.
    fn draw_curve<'a>(&mut self, points: impl Iterator<Item = (&'a f64, &'a f64)>, colour: Colour) {
        let points: Vec<[f64; 2]> = points.map(|(a, f)| self.at(*a, f.max(0.0))).collect();
        self.sheet.path(&points, true, &format!("fill:none;stroke:{};stroke-width:2", colour.css()));
    }

    /// Which curve is which.
    fn draw_key(&mut self, spalled: bool) {
        let names = [
            ("in motion, mean", Colour::Blue),
            ("at rest, rigid rings", Colour::Orange),
            ("defect", Colour::Red),
        ];
        for (n, (words, colour)) in names.into_iter().take(if spalled { 3 } else { 2 }).enumerate() {
            let y = 20.0 + 18.0 * n as f64;
            let style = format!("fill:none;stroke:{};stroke-width:3", colour.css());
            self.sheet.path(&[[14.0, y], [38.0, y]], false, &style);
            self.sheet.text([44.0, y + 4.0], 12.0, Anchor::Start, "#000", words);
        }
    }
}

/// A round step that gives two to five circles.
fn round_step(largest: f64) -> f64 {
    let power = 10f64.powf(largest.log10().floor());
    [0.2, 0.5, 1.0, 2.0].map(|m| m * power).into_iter().find(|s| largest / s <= 5.0).unwrap_or(2.0 * power)
}
