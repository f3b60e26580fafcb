//! Numbers of the summary: what the synthetic run was made of must come back.

use stribeck_analysis::summary::Summary;
use stribeck_report as report;
use stribeck_scene::scene::{FilmScene, Scene};
use stribeck_store::run_info::Status;

use crate::schemas::agree;
use stribeck_testing::{Scratch, assert_has};

use crate::synthetic::{
    self, ENTRY_LAG_S, EXIT_LEAD_S, FLOATING_M, IMPULSE_G, INTERVAL_S, NOISE_G, OIL_W, SLIP, SUPPORT_N,
    TONE_G, TONE_HZ, WEIGHT_N,
};
use crate::{SAMPLES, close, read, whole};

#[test]
fn roundtrip_every_number_of_the_synthetic_run() {
    // The slope of least squares of exact data is exact to rounding.
    const EXACT: f64 = 1e-6;
    // The median moves a step by less than a tenth of the facet period of 0.21 ms; a slip of 0.1 % moves
    // nothing more.
    const EVENT_MS: f64 = 0.03;
    let (_folder, summary) = whole("numbers");

    let motion = &summary.kinematics;
    close(motion.cage_hz, motion.expected_cage_hz * (1.0 - SLIP), EXACT, "cage");
    close(motion.bpfo_hz, 24.0 * motion.expected_cage_hz * (1.0 - SLIP), 24.0 * EXACT, "BPFO");
    close(motion.roller_spin_hz, motion.expected_roller_spin_hz, EXACT, "spin");

    assert_eq!(summary.events.iter().map(|e| e.roller).collect::<Vec<_>>(), [1, 2, 3]);
    for event in &summary.events {
        close(event.entry_ms, event.expected_entry_ms + 1e3 * ENTRY_LAG_S, EVENT_MS, "entry");
        close(event.exit_ms, event.expected_exit_ms - 1e3 * EXIT_LEAD_S, EVENT_MS, "exit");
        // Slip delays the path: by 0.1 % of the time since the start.
        close(event.path_exit_ms, event.expected_exit_ms * (1.0 + SLIP), 0.01, "path");
        // Three lengths whose times are those of the edges but for steps of the median, 0.07 mm each; t is
        // 4.3 for two degrees of freedom (Student).
        let mm = event.spall_scatter_mm.expect("three passages");
        assert!(mm > 0.0 && mm < 4.31 * 0.07 * (4.0_f64 / 3.0).sqrt(), "{mm}");
    }

    // 30 ms hold 140.2 periods of the ripple of 10 %: the rest averages to less than 0.1/(2π·140).
    close(summary.load.mean_n, SUPPORT_N, 2e-4 * SUPPORT_N, "vertical force");
    close(summary.load.inner_mean_n, SUPPORT_N + 24.0 * WEIGHT_N, 2e-4 * SUPPORT_N, "vertical force, inner");
    assert!(summary.load.max_roller_n < summary.load.max_roller_peak_n);
}

#[test]
fn planted_tone_levels_and_notch_of_the_synthetic_run() {
    let (_folder, summary) = whole("levels");
    let tone = &summary.tones[0];
    assert_eq!((tone.sensor.as_str(), tone.name.as_str(), tone.harmonic), ("side", "roller_vertices", 1));
    // Three impulses of 180 g leak a few g/√Hz into the line: 5 % of its amplitude.
    close(tone.measured_hz, TONE_HZ, 2.0, "tone");
    close(tone.level_g, TONE_G, 0.05 * TONE_G, "amplitude of the tone");
    assert!(tone.prominence_db > Some(15.0), "{:?}", tone.prominence_db);
    let sixth =
        summary.tones.iter().find(|t| t.sensor == "side" && t.harmonic == 6).expect("a sixth harmonic");
    close(sixth.level_g, 0.2 * TONE_G, 0.1 * TONE_G, "sixth harmonic");

    // An impulse rides on tone, harmonic and noise.
    let riding = 1.2 * TONE_G + NOISE_G;
    close(summary.levels.impulse_g, IMPULSE_G, riding, "impulse");
    // What is left of an impulse 2 ms later is 180 g · e⁻⁸, nothing.
    let between = summary.levels.between_g.expect("samples between the events");
    assert!(between > TONE_G && between <= riding + 1e-6, "{between}");
    // Phase by phase: the tone runs through all of them, impulses stand at the exits alone.
    let phases = summary.levels.phases;
    assert_eq!((phases.gap_g, phases.exit_g >= Some(IMPULSE_G - riding)), (Some(between), true));
    for quiet in [phases.start_g, phases.entry_g, phases.defect_g] {
        assert!(quiet.expect("a level") <= riding + 1e-6, "{phases:?}");
    }
    close(
        phases.gap_rms_g,
        (0.5 * (1.04 * TONE_G * TONE_G) + NOISE_G * NOISE_G / 3.0).sqrt(),
        0.5,
        "RMS of the gaps",
    );
    // a_x is 0.3 a_y: at 270° the outward direction is −y and the counter-clockwise one x.
    let bottom = summary.levels.sensors.iter().find(|s| s.sensor == "bottom").expect("a sensor at 270°");
    let component =
        |name: &str| bottom.components.iter().find(|c| c.component == name).expect("a component").phases;
    close(component("radial").exit_g, bottom.phases.exit_g.expect("a level"), 1e-9, "radial at the bottom");
    close(
        component("tangential").gap_g,
        0.3 * bottom.phases.gap_g.expect("a level"),
        1e-9,
        "tangential at the bottom",
    );
    let filtered = summary.levels.between_filtered_g.expect("samples after the transient");
    assert!(filtered < 0.2 * TONE_G + NOISE_G + 8.0, "{filtered}");

    let notch = summary.notch.as_ref().expect("a notch");
    close(Some(notch.centre_hz), TONE_HZ, 2.0, "centre");
    close(notch.attenuation_4545_db, 3.9, 0.3, "attenuation at 4545 Hz");
    assert!(notch.attenuation_db > Some(15.0), "{:?}", notch.attenuation_db);

    let spectrum = summary.spectrum.as_ref().expect("a spectrum");
    close(Some(spectrum.record_s), 0.03, 1e-9, "record");
    close(Some(spectrum.resolution_hz), 33.333, 0.001, "resolution");
    close(Some(spectrum.grid_hz), 3.0, 0.001, "grid");
    assert!(spectrum.zero_padded && spectrum.segments == 1);
    assert!(summary.notes.iter().any(|n| n.contains("envelope")), "{:?}", summary.notes);
}

#[test]
fn golden_the_summary_has_its_stable_names() {
    let (folder, summary) = whole("names");
    let text = read(folder.path(), "summary.json");
    let json: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let declared: Vec<String> = Summary::quantities().into_iter().map(|quantity| quantity.path).collect();
    let page = include_str!("../../../../../docs/guide/src/quantities.md");
    for path in &declared {
        assert!(page.contains(&format!("`{path}`")), "the guide has no {path}: `cargo xtask quantities`");
    }
    let schema = Summary::json_schema();
    agree(&schema, &json, "summary").expect("the schema allows it");
    for (place, wrong) in [("/mesh/nodes", "many".into()), ("/notes", 1.into())] {
        let mut json = json.clone();
        *json.pointer_mut(place).expect("there") = wrong;
        agree(&schema, &json, "summary").expect_err(place);
    }
    for path in ["mesh.nodes", "run.wall_s", "kinematics.bpfo_hz", "load.mean_n", "levels.exit_g", "notch.q"]
    {
        assert!(declared.iter().any(|declared| declared == path), "{path} had another name before");
        let pointer = format!("/{}", path.replace('.', "/"));
        assert!(json.pointer(&pointer).is_some_and(serde_json::Value::is_number), "{path} is missing");
    }
    // No roller of this run touches the floor: the names are there, without a value.
    for path in ["/events/0/floor_ms", "/events/0/floor_n"] {
        assert!(json.pointer(path).is_some_and(serde_json::Value::is_null), "{path} is not null");
    }
    // 300 s over 968 000 steps of 433 elements.
    close(summary.run.ns_per_element_step, 715.74, 0.01, "ns per element and step");
    assert_eq!(serde_json::from_str::<Summary>(&text).expect("a summary"), summary);
}

#[test]
fn planted_the_ledger_tells_mesh_from_physics() {
    use stribeck_analysis::artefacts::Origin;
    let (_, summary) = whole("ledger");
    let of = |family| summary.artefacts.iter().filter(move |a| a.family == family);
    // Six harmonics of three facet lines, three beats, six multiples of BPFO, five modes.
    let counts = [Origin::Mesh, Origin::Beat, Origin::Defect, Origin::Ring].map(|f| of(f).count());
    assert_eq!(counts, [18, 3, 6, 5]);
    let tone = of(Origin::Mesh).next().expect("the roller vertices");
    assert!((tone.measured_hz.expect("a line") - TONE_HZ).abs() < 2.0, "{tone:?}");
    // The tone follows the rollers' spin: one family has it, and the raceways' nodes 35 Hz away do not.
    let found: Vec<&str> = summary.families.iter().filter(|f| f.found).map(|f| f.name.as_str()).collect();
    assert_eq!(found, ["roller_vertices"], "{:#?}", summary.families);
    assert!(summary.families[0].offset_resolutions.expect("fitted").abs() < 0.5, "{:?}", summary.families[0]);
    // A place near a natural frequency makes no line of the ring.
    assert!(of(Origin::Ring).all(|a| a.measured_hz.is_none()));
    assert!(of(Origin::Defect).all(|a| a.measured_hz.is_none() && a.verdict.contains("ten are needed")));
    assert!(summary.artefacts.iter().all(|a| !a.verdict.is_empty()));
}

#[test]
fn roundtrip_oil_films_of_the_synthetic_run() {
    /// Of decimal numbers in binary.
    const ROUNDING: f64 = 1e-9;
    let folder = Scratch::new("dry");
    let scene = Scene { film: None, ..Scene::default() };
    synthetic::write_scene(folder.path(), &scene, Status::Complete, SAMPLES, 1.0);
    assert!(report::write(folder.path()).expect("a report").film.is_none());
    let folder = Scratch::new("oil");
    let scene = Scene { film: Some(FilmScene::default()), ..Scene::default() };
    synthetic::write_scene(folder.path(), &scene, Status::Complete, SAMPLES, 1.0);
    let film = report::write(folder.path()).expect("a report").film.expect("oil");
    for (ring, what) in ["outer", "inner"].into_iter().enumerate() {
        close(film.floating_um[ring], 1e6 * FLOATING_M[ring], ROUNDING, what);
        close(film.largest_n[ring], [0.0, WEIGHT_N][ring], ROUNDING, what);
        let loaded = scene.resolve().loaded_films().expect("a load").expect("oil")[ring];
        close(Some(film.loaded_um[ring]), 1e6 * loaded.thickness, ROUNDING, what);
        close(Some(film.lambda[ring]), loaded.thickness / 0.3e-6, ROUNDING, what);
    }
    close(film.heat_j, OIL_W * (SAMPLES - 1) as f64 * INTERVAL_S, ROUNDING, "heat");
    let page = read(folder.path(), "report.html");
    assert_has(&page, &["Oil film of rollers without load", "30.0 and 45.0 µm", "0.0 and 0.4 N"]);
}

/// A quarter of a turn of a load that turns with the shaft, from where it adds to the other: its mean along
/// that is 2/π of it. Source: mean of a cosine; the load, THEORY §6.3.
#[test]
fn analytic_rollers_carry_what_a_rotating_load_does_over_the_record() {
    /// The mean over samples of 30 ms is off by half a sampling interval at its ends.
    const SAMPLED: f64 = 1e-3;
    let folder = Scratch::new("rotating");
    let scene = Scene::default()
        .with_overrides(&["operation.rotating_load=(force_n: 10000, angle_deg: 270)"])
        .expect("a valid scene");
    synthetic::write_scene(folder.path(), &scene, Status::Complete, SAMPLES, 1.0);
    let load = report::write(folder.path()).expect("a report").load;
    let wanted = SUPPORT_N + 10e3 * std::f64::consts::FRAC_2_PI;
    close(Some(load.expected_n), wanted, SAMPLED * wanted, "load and weight");
    close(load.relative_error, SUPPORT_N / wanted - 1.0, SAMPLED, "difference");
    assert!(
        read(folder.path(), "report.html").contains(" rollers under 50.01 to 60 kN at "),
        "the range on record"
    );
}
