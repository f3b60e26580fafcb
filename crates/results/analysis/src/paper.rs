//! Every number in the paper's text beside ours: quantity, paper, ours, difference, why.
//!
//! The paper: "Numerical noise generation in modelled bearing vibration signals", Inter-Noise 2014. Its
//! numbers are written here once, as it prints them.

mod figures;
mod model;
mod signal;

use stribeck_scene::resolved::ResolvedScene;
use stribeck_scene::scene::{BearingScene, Scene};
use stribeck_store::run_info::MeshInfo;

pub use self::figures::{Beside, Shown, beside, sensor, shown, starts_csv};
use crate::prediction::Prediction;
use crate::summary::{PaperRow, SensorLevels, Summary};

/// The paper's dominant line [Hz].
pub const TONE_HZ: f64 = 4671.0;
/// The line that the paper reads from a pair of peaks [Hz].
pub const CURSOR_HZ: f64 = 4545.0;
/// Its equation (2) for the outer and the inner raceway [Hz], as printed.
pub const EQUATION_2_HZ: (f64, f64) = (4712.0, 3864.0);
/// Peak level of the impulses in its Fig. 2 [g].
pub const IMPULSE_G: f64 = 180.0;
/// Level between the impulses in its Fig. 2 [g].
pub const BETWEEN_G: f64 = 50.0;
/// The same behind the notch, Fig. 6 [g].
pub const FILTERED_G: f64 = 20.0;

/// Whether a scene has the paper's bearing, housing, defect, load and speed, so that its numbers can be set
/// beside the paper's at all.
pub fn is_scene_of(scene: &Scene) -> bool {
    let (b, paper) = (&scene.bearing, Scene::default());
    let p = &paper.bearing;
    let size = |b: &BearingScene| {
        [
            b.outer_race_diameter_mm,
            b.outer_ring_thickness_mm,
            b.inner_race_diameter_mm,
            b.inner_ring_thickness_mm,
            b.roller_diameter_mm,
        ]
    };
    let defect = |s: &Scene| s.defect.as_ref().map(|d| (d.ring, [d.length_mm, d.depth_mm, d.edge_slope_deg]));
    size(b) == size(p)
        && b.rollers == p.rollers
        && defect(scene) == defect(&paper)
        && scene.defects.is_empty()
        && scene.housing == paper.housing
        && [scene.operation.load_n, scene.operation.speed_rpm]
            == [paper.operation.load_n, paper.operation.speed_rpm]
}

/// The run behind the rows.
struct RowInputs<'a> {
    scene: &'a ResolvedScene,
    mesh: &'a MeshInfo,
    prediction: &'a Prediction,
    summary: &'a Summary,
    /// The sensor whose a_y is set beside the paper's.
    sensor: Option<&'a SensorLevels>,
}

/// All rows, in the order of the paper. None is blank: a number that this run cannot yield is stated as such.
pub fn rows(
    scene: &ResolvedScene,
    mesh: &MeshInfo,
    prediction: &Prediction,
    summary: &Summary,
) -> Vec<PaperRow> {
    let sensor = sensor(&scene.written, &summary.levels.sensors);
    let source = RowInputs { scene, mesh, prediction, summary, sensor };
    let mut rows = model::rows(&source);
    rows.extend(signal::rows(&source));
    rows
}

/// A number that both have.
fn number(part: &str, quantity: &str, paper: f64, ours: Option<f64>, unit: &str, why: &str) -> PaperRow {
    let text = |v: f64| format!("{} {unit}", shortest(v)).trim_end().to_owned();
    PaperRow {
        part: part.into(),
        quantity: quantity.into(),
        paper: text(paper),
        ours: ours.map_or("this record cannot tell".into(), text),
        paper_value: Some(paper),
        ours_value: ours,
        unit: unit.into(),
        difference: ours.map_or("–".into(), |ours| difference(paper, ours)),
        why: why.into(),
    }
}

fn words(part: &str, quantity: &str, paper: &str, ours: String, difference: &str, why: &str) -> PaperRow {
    PaperRow {
        part: part.into(),
        quantity: quantity.into(),
        paper: paper.into(),
        ours,
        paper_value: None,
        ours_value: None,
        unit: String::new(),
        difference: difference.into(),
        why: why.into(),
    }
}

impl PaperRow {
    /// A row of words with its number.
    fn telling(self, ours_value: Option<f64>, unit: &str) -> Self {
        Self { ours_value, unit: unit.into(), ..self }
    }
}

/// Ours against the paper's, in per cent or as a factor.
fn difference(paper: f64, ours: f64) -> String {
    let ratio = ours / paper;
    if (ratio - 1.0).abs() < 5e-5 {
        "none".into()
    } else if (0.5..1.5).contains(&ratio) {
        let percent = 100.0 * (ratio - 1.0);
        let decimals = if percent.abs() < 1.0 { 2 } else { 1 };
        format!("{percent:+.decimals$} %").replace('-', "−")
    } else {
        format!("× {ratio:.2}")
    }
}

/// A number with as many decimals as make sense for its size.
fn shortest(value: f64) -> String {
    let size = value.abs();
    let decimals = match size {
        _ if value == value.round() && size < 1e6 => 0,
        s if s >= 1000.0 => 1,
        s if s >= 1.0 => 2,
        _ => 4,
    };
    let text = format!("{value:.decimals$}").replace('-', "−");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn behaves_differences_in_words() {
        assert_eq!(difference(90.07, 90.109), "+0.04 %");
        assert_eq!(difference(50.0, 50.0), "none");
        assert_eq!(difference(180.0, 960.0), "× 5.33");
        assert_eq!(difference(4671.0, 4664.0), "−0.15 %");
        assert_eq!(
            (shortest(4671.0), shortest(163.96), shortest(0.005)),
            ("4671".into(), "163.96".into(), "0.005".into())
        );
    }
}
