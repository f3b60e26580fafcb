//! The load zone as a polar plot: what each place of the outer raceway carries, at rest and in motion.

use stribeck_scene::housing::HousingScene;
use stribeck_scene::resolved::ResolvedScene;

use crate::plot::{Anchor, Colour, Picture, Sheet};
use stribeck_analysis::findings::Findings;
use stribeck_analysis::words::kilonewtons;

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
    let largest = finite(&dynamic.mean_n).max(at_rest.unwrap_or(0.0));
    if largest <= 0.0 {
        return None;
    }
    let middle = [0.5 * SIZE, 0.5 * SIZE];
    let at = |deg: f64, force: f64| {
        let radius = RACE + REACH * force / largest;
        let (sin, cos) = deg.to_radians().sin_cos();
        [middle[0] + radius * cos, middle[1] - radius * sin]
    };
    let mut sheet = Sheet::new(SIZE, SIZE);
    let step = round_step(largest);
    let mut level = 0.0;
    while level <= largest {
        sheet.circle(middle, RACE + REACH * level / largest, "fill:none;stroke:#d8dde2");
        let words = kilonewtons(level);
        sheet.text(
            [middle[0] + 4.0, middle[1] + RACE + REACH * level / largest - 3.0],
            11.0,
            Anchor::Start,
            "#5c6670",
            &words,
        );
        level += step;
    }
    for deg in (0..360).step_by(30) {
        let deg = f64::from(deg);
        sheet.path(&[at(deg, 0.0), at(deg, largest)], false, "fill:none;stroke:#e6e9ec");
        let end = at(deg, 1.09 * largest);
        sheet.text([end[0], end[1] + 4.0], 12.0, Anchor::Middle, "#5c6670", &format!("{deg:.0} °"));
    }
    for edges in findings.prediction.standing_spalls() {
        let span = |n: usize| edges.trailing_deg + (edges.leading_deg - edges.trailing_deg) * n as f64 / 12.0;
        let mut sector: Vec<[f64; 2]> = (0..=12).map(|n| at(span(n), largest)).collect();
        sector.extend((0..=12).rev().map(|n| at(span(n), 0.0)));
        sheet.path(&sector, true, "fill:#b3202c;fill-opacity:0.12");
    }
    if let Some(curve) = static_curve {
        let points: Vec<[f64; 2]> =
            curve.angle_deg.iter().zip(&curve.force_n).map(|(a, f)| at(*a, *f)).collect();
        sheet.path(&points, true, &format!("fill:none;stroke:{};stroke-width:2", Colour::Orange.css()));
    }
    let known = dynamic.angle_deg.iter().zip(&dynamic.mean_n).filter(|(_, f)| f.is_finite());
    let points: Vec<[f64; 2]> = known.map(|(a, f)| at(*a, f.max(0.0))).collect();
    sheet.path(&points, true, &format!("fill:none;stroke:{};stroke-width:2", Colour::Blue.css()));
    let spalled = findings.prediction.standing_spalls().next().is_some();
    let names = [
        ("in motion, mean", Colour::Blue),
        ("at rest, rigid rings", Colour::Orange),
        ("defect", Colour::Red),
    ];
    for (n, (words, colour)) in names.into_iter().take(if spalled { 3 } else { 2 }).enumerate() {
        let y = 20.0 + 18.0 * n as f64;
        sheet.path(
            &[[14.0, y], [38.0, y]],
            false,
            &format!("fill:none;stroke:{};stroke-width:3", colour.css()),
        );
        sheet.text([44.0, y + 4.0], 12.0, Anchor::Start, "#000", words);
    }
    let mut picture = Picture::new("load-polar", "Load zone", sheet);
    picture.caption = format!(
        "The side towards the load carries it{}. Largest mean in motion {}, at rest {}.",
        if spalled { "; over a spall less is carried, and the neighbours take it over" } else { "" },
        kilonewtons(finite(&dynamic.mean_n)),
        at_rest.map_or("–".into(), kilonewtons)
    );
    let elastic = match &scene.written.housing {
        HousingScene::Rigid(_) => "",
        HousingScene::Adapter => {
            "; an elastic ring, which bears on the edges of an adapter, spreads the load otherwise"
        }
        _ => "; an elastic ring spreads the load otherwise",
    };
    picture.note = format!(
        "In motion: mean over all rollers and samples in bins of 1°. At rest: Stribeck and Sjövall, rigid rings with clearance{elastic}."
    );
    Some(picture)
}

/// A round step that gives two to five circles.
fn round_step(largest: f64) -> f64 {
    let power = 10f64.powf(largest.log10().floor());
    [0.2, 0.5, 1.0, 2.0].map(|m| m * power).into_iter().find(|s| largest / s <= 5.0).unwrap_or(2.0 * power)
}
