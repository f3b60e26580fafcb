//! The sentence under the title, which sums up the simulation.

use std::path::Path;

use stribeck_analysis::duty::DutyFinding;
use stribeck_diagnosis::words::numbers::{kilonewtons, significant};
use stribeck_scene::deviation::DeviationScene;
use stribeck_scene::housing::HousingScene;
use stribeck_scene::resolved::ResolvedScene;
use stribeck_scene::scene::{DefectRing, ModelScene, RingMeshScene};
use stribeck_theory::catalogue::Element;

/// The sentence under the title.
pub(crate) fn lead(scene: &ResolvedScene, duty: Option<&DutyFinding>, simulated_ms: f64) -> String {
    let of_defect = scene.written.defect.as_ref().map(|d| {
        let ring = match d.ring {
            DefectRing::Outer => "outer",
            DefectRing::Inner => "inner",
        };
        format!("a spall of {} × {} mm on the {ring} raceway", d.length_mm, d.depth_mm)
    });
    let all: Vec<String> =
        of_defect.into_iter().chain(scene.written.defects.iter().map(DeviationScene::spoken)).collect();
    let defect = match all.len() {
        0 => "healthy raceways".to_owned(),
        1..=3 => all.join(", "),
        more => format!("{} and {} more deviations", all[..2].join(", "), more - 2),
    };
    let name = match scene.written.bearing.designation.as_str() {
        "" => String::new(),
        name => format!("{name}: "),
    };
    // The page calls them balls where the bearing has balls; those of the reduced model touch in points.
    let meshed = scene.written.element() == Element::Ball && scene.written.model == ModelScene::Full;
    let as_cylinders = if meshed { ", modelled as cylinders," } else { "" };
    format!(
        "{name}{} rollers{as_cylinders}{} under {} at {}, {defect}; {:.1} ms, simulated {}.",
        scene.written.rollers_in_place().count(),
        own_rings(scene) + &housing(scene),
        load(scene, duty),
        speed(scene, duty),
        simulated_ms,
        match scene.written.model {
            ModelScene::Full => "in finite elements",
            ModelScene::Reduced(_) => "by the reduced model",
        }
    )
}

/// Rings from files, in words.
fn own_rings(scene: &ResolvedScene) -> String {
    let rings = [("outer", &scene.written.outer_ring_mesh), ("inner", &scene.written.inner_ring_mesh)];
    let of_file = |(ring, mesh): (&str, &Option<RingMeshScene>)| {
        let file = Path::new(&mesh.as_ref()?.file).file_stem().unwrap_or_default().display().to_string();
        Some(format!(" with an {ring} ring from a file ({file})"))
    };
    rings.into_iter().filter_map(of_file).collect()
}

/// The housing in words, where it is not the adapter.
fn housing(scene: &ResolvedScene) -> String {
    match &scene.written.housing {
        HousingScene::Adapter => String::new(),
        HousingScene::Pedestal(_) => " in a pedestal".to_owned(),
        HousingScene::Mesh(housing) => {
            format!(" in a housing ({})", Path::new(&housing.file).file_stem().unwrap_or_default().display())
        }
        HousingScene::Rigid(_) => " in a rigid housing".to_owned(),
        HousingScene::Machine(_) => " in a machine".to_owned(),
        HousingScene::Springs(springs) => {
            format!(" in a housing on springs of {} N/µm", springs.stiffness_n_um)
        }
    }
}

/// The load in words, with its range on record where it changes.
fn load(scene: &ResolvedScene, duty: Option<&DutyFinding>) -> String {
    match duty {
        Some(duty) if duty.load_n.0 != duty.load_n.1 => {
            format!("{} to {}", significant(1e-3 * duty.load_n.0, 4), kilonewtons(duty.load_n.1))
        }
        _ => kilonewtons(scene.written.operation.load_n),
    }
}

/// The speed in words, with its range on record where it changes, and the sense where it is not the usual
/// one.
fn speed(scene: &ResolvedScene, duty: Option<&DutyFinding>) -> String {
    let o = &scene.written.operation;
    let [inner, outer] = match duty {
        Some(duty) if o.speed_varies() => [duty.speed_rpm, duty.outer_speed_rpm],
        _ => [(o.speed_rpm, o.speed_rpm), (o.outer_speed_rpm, o.outer_speed_rpm)],
    };
    let inner = of_ring(inner);
    if !o.outer_turns() {
        return inner;
    }
    format!("{inner} of the inner and {} of the outer ring", of_ring(outer))
}

/// Least and largest speed of one ring in words.
fn of_ring((least, most): (f64, f64)) -> String {
    let varies = least != most;
    let rpm = |rpm: f64| if varies { significant(rpm, 4) } else { rpm.to_string() };
    let span = |a: f64, b: f64| {
        if varies { format!("{} to {} rpm", rpm(a), rpm(b)) } else { format!("{} rpm", rpm(a)) }
    };
    if most <= 0.0 && least < 0.0 {
        format!("{} counter-clockwise", span(-most, -least))
    } else if least < 0.0 {
        format!("{} (negative: counter-clockwise)", span(least, most).replace('-', "−"))
    } else {
        span(least, most)
    }
}
