//! Sensors and numbers beside those of the paper.

use stribeck_analysis::paper::{Beside, Shown, beside, sensor};
use stribeck_analysis::summary::SensorLevels;
use stribeck_scene::scene::{AdapterScene, Scene};

fn at(name: &str, angle_deg: f64) -> SensorLevels {
    SensorLevels { sensor: name.into(), angle_deg, ..SensorLevels::default() }
}

/// The report showed a_y of the sensor at the side, which is tangential, and no tone stood in it.
#[test]
fn issue_the_paper_s_sensor_is_one_whose_a_y_is_radial() {
    let scene = Scene::default();
    let chosen = |sensors: &[SensorLevels]| sensor(&scene, sensors).map(|s| s.sensor.clone());
    let usual = [at("side", 0.0), at("shoulder", 22.0), at("seat", 90.0), at("bottom", 270.0)];
    assert_eq!(chosen(&usual), Some("bottom".into()));
    // Whoever puts a radial one first has chosen.
    assert_eq!(chosen(&[at("over", 60.0), at("bottom", 270.0)]), Some("over".into()));
    assert_eq!(chosen(&[at("side", 180.0), at("near", 240.0), at("other", 300.0)]), Some("near".into()));
    // Under the seat rather than none, and a tangential one where there is no other.
    assert_eq!(chosen(&[at("side", 0.0), at("seat", 80.0)]), Some("seat".into()));
    assert_eq!(chosen(&[at("side", 0.0)]), Some("side".into()));
    assert_eq!(chosen(&[]), None);
    // Beside a narrow adapter there is no seat.
    let beside = [at("side", 0.0), at("top", 80.0), at("low", 300.0)];
    assert_eq!(chosen(&beside), Some("low".into()));
    let narrow = Scene { adapter: AdapterScene { width_mm: 20.0, ..scene.adapter }, ..Scene::default() };
    assert_eq!(sensor(&narrow, &beside).map(|s| s.angle_deg), Some(80.0));
}

fn of(paper: f64, ours: &[Option<f64>]) -> Beside {
    let shown = |ours: &Option<f64>| Shown {
        figure: "2",
        quantity: "Impulses, peak".into(),
        unit: "g",
        paper,
        read: 5.0,
        scatter: 30.0,
        at_least: false,
        ours: *ours,
    };
    beside(&ours.iter().map(|ours| vec![shown(ours)]).collect::<Vec<_>>()).remove(0)
}

#[test]
fn by_hand_a_number_differs_beyond_the_scatter_of_starts() {
    // One run is granted 30 g, and 5 g of the print.
    assert!(!of(180.0, &[Some(214.0)]).differs() && of(180.0, &[Some(216.0)]).differs());
    // Three starts, 200 ± 10: by hand, a further one is within 4.303 · 10 · √(4/3) = 49.7 g of the mean.
    let starts = [Some(190.0), Some(200.0), Some(210.0)];
    assert!(!of(146.0, &starts).differs() && of(145.0, &starts).differs());
    assert!((of(145.0, &starts).distance() - 55.0 / 54.7).abs() < 1e-2);
    // Most starts must have it.
    assert!(of(200.0, &[Some(200.0), None, None]).differs() && of(200.0, &[None]).differs());
    assert_eq!(of(200.0, &[None]).distance(), f64::INFINITY);
    assert_eq!(beside(&[]), []);
}
