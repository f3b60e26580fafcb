//! A run of closed forms through the whole report: every number must come back, and every figure must be
//! there.

mod synthetic;

use std::fs;
use std::path::Path;

use stribeck_analysis::summary::Summary;
use stribeck_report as report;
use stribeck_scene::housing::{HousingScene, RigidHousingScene};
use stribeck_scene::lubrication::loaded_films;
use stribeck_scene::run_info::Status;
use stribeck_scene::scene::{ContactSurface, FilmScene, Scene};
use synthetic::{
    ENTRY_LAG_S, EXIT_LEAD_S, FLOATING_M, IMPULSE_G, INTERVAL_S, NOISE_G, OIL_W, SLIP, SUPPORT_N, Scratch,
    TONE_G, TONE_HZ, WEIGHT_N,
};

/// The whole record of the paper, 30 ms at 100 kHz.
const SAMPLES: usize = 3000;
/// Largest page that mails and reviews still take.
const PAGE_LIMIT_BYTES: u64 = 15_000_000;

/// What the moving bearing of 24 rollers may add to a page: 600 frames of two forces in bytes, 76 of two
/// angles in two bytes each, as text.
const MOVING_LIMIT_BYTES: usize = 60_000;

fn close(found: Option<f64>, wanted: f64, tolerance: f64, what: &str) {
    let found = found.unwrap_or_else(|| panic!("{what} is missing"));
    assert!((found - wanted).abs() <= tolerance, "{what}: {found} instead of {wanted} ± {tolerance}");
}

fn read(folder: &Path, name: &str) -> String {
    fs::read_to_string(folder.join(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
}

fn whole(name: &str) -> (Scratch, Summary) {
    let folder = Scratch::new(name);
    synthetic::write(&folder.0, Status::Complete, SAMPLES);
    let summary = report::write(&folder.0).expect("a report");
    (folder, summary)
}

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
    }

    // 30 ms hold 140.2 periods of the ripple of 10 %: the rest averages to less than 0.1/(2π·140).
    close(summary.load.mean_n, SUPPORT_N, 2e-4 * SUPPORT_N, "vertical force");
    close(summary.load.inner_mean_n, SUPPORT_N + 24.0 * WEIGHT_N, 2e-4 * SUPPORT_N, "vertical force, inner");
    assert!(summary.load.max_roller_n < summary.load.max_roller_peak_n);
}

#[test]
fn example_tone_levels_and_notch_of_the_synthetic_run() {
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
    let text = read(&folder.0, "summary.json");
    let json: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    for path in [
        "/mesh/nodes",
        "/mesh/quads",
        "/mesh/triangles",
        "/mesh/roller_facets",
        "/mesh/outer_facets",
        "/mesh/inner_facets",
        "/run/steps",
        "/run/time_step_ns",
        "/run/wall_s",
        "/run/cpu_s",
        "/run/threads",
        "/run/ns_per_element_step",
        "/energy/max_relative_error",
        "/kinematics/cage_hz",
        "/kinematics/bpfo_hz",
        "/kinematics/roller_spin_hz",
        "/kinematics/expected_cage_hz",
        "/kinematics/expected_bpfo_hz",
        "/kinematics/expected_roller_spin_hz",
        "/events/2/roller",
        "/events/2/entry_ms",
        "/events/2/exit_ms",
        "/events/2/expected_entry_ms",
        "/events/2/expected_exit_ms",
        "/load/mean_n",
        "/load/expected_n",
        "/load/max_roller_n",
        "/tones/0/name",
        "/tones/0/predicted_hz",
        "/tones/0/measured_hz",
        "/tones/0/level_g",
        "/events/2/compensation_n",
        "/levels/impulse_g",
        "/levels/start_g",
        "/levels/start_rms_g",
        "/levels/entry_g",
        "/levels/entry_rms_g",
        "/levels/defect_g",
        "/levels/defect_rms_g",
        "/levels/exit_g",
        "/levels/exit_rms_g",
        "/levels/gap_g",
        "/levels/gap_rms_g",
        "/levels/sensors/3/sensor",
        "/levels/sensors/3/gap_rms_g",
        "/levels/sensors/3/components/0/component",
        "/levels/sensors/3/components/1/exit_g",
        "/families/2/name",
        "/families/2/predicted_hz",
        "/families/0/carrier_hz",
        "/families/0/offset_resolutions",
        "/families/0/found",
        "/families/0/level_g",
        "/families/0/lines/0/sideband",
        "/families/0/lines/0/predicted_hz",
        "/families/0/lines/0/sensor",
        "/families/0/lines/0/component",
        "/levels/between_g",
        "/levels/between_filtered_g",
        "/notch/centre_hz",
        "/notch/q",
        "/notch/attenuation_db",
        "/notch/attenuation_4545_db",
        "/spectrum/record_s",
        "/spectrum/resolution_hz",
        "/spectrum/grid_hz",
        "/spectrum/window",
        "/spectrum/segments",
    ] {
        assert!(json.pointer(path).is_some_and(|v| !v.is_null()), "{path} is missing");
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
fn example_the_page_holds_every_figure_and_needs_no_network() {
    let (folder, _) = whole("page");
    let page = read(&folder.0, "report.html");
    assert!((page.len() as u64) < PAGE_LIMIT_BYTES, "{} bytes", page.len());
    for figure in [
        "acceleration",
        "acceleration-notched",
        "acceleration-shoulder",
        "acceleration-seat",
        "acceleration-bottom",
        "acceleration-instant",
        "mesh",
        "mesh-defect",
        "roller",
        "paper-2",
        "paper-3",
        "beat",
        "beat-zoom",
        "paper-6",
        "paper-7a",
        "paper-7b",
        "paper-8a",
        "paper-8b",
        "paper-8c",
        "spectrum",
        "spectrum-notched",
        "spectrum-zoom",
        "spectrum-sensors",
        "spectrum-low",
        "load-distribution",
        "load-polar",
        "load-sum",
        "spin",
        "orbit",
        "energy",
        "energy-error",
    ] {
        assert!(page.contains(&format!("<figure id=\"{figure}\"")), "{figure} is not in the page");
        let picture = read(&folder.0, &format!("figures/{figure}.svg"));
        assert!(
            picture.starts_with("<svg") && picture.trim_end().ends_with("</svg>"),
            "{figure}.svg is broken"
        );
        let pixels = fs::read(folder.0.join(format!("figures/{figure}.png"))).expect("a picture");
        assert!(pixels.starts_with(b"\x89PNG"), "{figure}.png is broken");
    }
    // The moving bearing is no file of its own.
    let moving = page.split("<figure id=\"moving\"").nth(1).expect("a moving bearing");
    let data = moving.split("<script type=\"application/json\">").nth(1).expect("its data");
    let data = data.split("</script>").next().expect("an end");
    assert!(data.len() < MOVING_LIMIT_BYTES, "{} bytes of motion", data.len());
    let motion: serde_json::Value = serde_json::from_str(data).expect("JSON");
    assert_eq!(motion["rollers"].as_array().map(Vec::len), Some(24));
    assert_eq!((motion["frames"].as_u64(), motion["spalls"].as_array().map(Vec::len)), (Some(600), Some(1)));
    // Addresses may be named (a namespace, a comment), never loaded.
    for loading in ["src=\"http", "href=\"http", "url(http", "@import", "fetch(", "<link rel=\"stylesheet\""]
    {
        assert!(!page.contains(loading), "the page loads something: {loading}");
    }
    assert!(!page.contains("role=\"alert\""), "a complete run has no banner");
}

#[test]
fn invariant_a_run_whose_mesh_cannot_be_read_has_a_report_without_its_pictures() {
    let folder = Scratch::new("no-mesh");
    synthetic::write(&folder.0, Status::Complete, 500);
    let file = folder.0.join("mesh.vtu");
    let sound = fs::read(&file).expect("readable");
    let with = |old: &str, new: &str| -> Vec<u8> {
        let at = sound.windows(old.len()).position(|window| window == old.as_bytes()).expect("it is there");
        [&sound[..at], new.as_bytes(), &sound[at + old.len()..]].concat()
    };
    let points = format!("NumberOfPoints=\"{}\"", synthetic::info(Status::Complete, 500).mesh.nodes);
    // A node far out, and all of them in one place, would ask for a picture of any size.
    let far = [&sound[..sound.len() / 2], &1e300_f64.to_le_bytes().repeat(sound.len() / 16)].concat();
    for (bytes, words) in [
        (None, "cannot read"),
        (Some(with("reference_m", "positions_m")), "no `reference_m`: a version"),
        (Some(sound[..sound.len() / 2].to_vec()), "it ends before"),
        (Some(with(&points, "NumberOfPoints=\"9\"")), "does not fit its counts"),
        (Some(far), "mesh.vtu"),
        (Some(sound.clone()), ""),
    ] {
        match &bytes {
            Some(bytes) => fs::write(&file, bytes).expect("writable"),
            None => fs::remove_file(&file).expect("it is there"),
        }
        let summary = report::write(&folder.0).expect("a report");
        let note = summary.notes.iter().find(|note| note.contains("no pictures of the mesh"));
        let page = read(&folder.0, "report.html");
        assert_eq!(note.is_some(), !words.is_empty(), "{words}: {:?}", summary.notes);
        assert!(note.is_none_or(|note| note.contains(words)), "{note:?} instead of {words}");
        assert_eq!(page.contains("<figure id=\"mesh\""), words.is_empty(), "{words}");
    }
    // The mesh of another run.
    let mut info = synthetic::info(Status::Complete, 500);
    info.mesh.nodes += 1;
    fs::write(folder.0.join("run.json"), serde_json::to_vec(&info).expect("JSON")).expect("writable");
    let summary = report::write(&folder.0).expect("a report");
    assert!(
        summary.notes.iter().any(|note| note.contains("it belongs to another run")),
        "{:?}",
        summary.notes
    );
}

#[test]
fn example_every_number_of_the_paper_has_a_row_without_a_blank() {
    let (folder, summary) = whole("paper");
    let page = read(&folder.0, "report.html");
    for row in &summary.paper {
        for cell in [&row.quantity, &row.paper, &row.ours, &row.difference, &row.why] {
            assert!(!cell.trim().is_empty(), "{row:?}");
        }
    }
    // As the paper prints them, in the order in which it does.
    let printed = [
        "200 mm",
        "163.96 mm",
        "196 mm",
        "18 mm",
        "160 mm",
        "40 mm",
        "0.2 mm",
        "7850 kg/m³",
        "200 GPa",
        "0.3",
        "0.5 mm",
        "97",
        "5",
        "113",
        "15",
        "4 °",
        "15 °",
        "50 kN",
        "500 rpm",
        "0.1",
        "0.005",
        "2 %",
        "30 ms",
        "0.01 ms",
        "100 kHz",
        "90.07 Hz",
        "0.011 s",
        "90.91 Hz",
        "0.9 %",
        "180 g",
        "50 g",
        "20 g",
        "3 Hz",
        "4671 Hz",
        "23 kHz",
        "4712 Hz",
        "3864 Hz",
        "0.8 %",
        "4545 Hz",
        "17 %",
        "10–15 ms",
        "5–16 ms, less 17–28 ms",
        "25 dB",
        "4 dB",
        "4–6 kHz",
        "≈ 5 ms",
        "16–17 ms",
        "≈ 28 ms",
    ];
    for number in printed {
        assert!(summary.paper.iter().any(|row| row.paper == number), "{number} has no row");
        assert!(page.contains(number), "{number} is not in the page");
    }
    let ours = |quantity: &str| &summary.paper.iter().find(|r| r.quantity == quantity).expect("a row").ours;
    assert_eq!(ours("Taken at 4545 Hz"), "3.96 dB");
    assert_eq!(ours("Elements per bending wavelength at 40 kHz"), "97.59");
}

/// The sensors have 1, 1.4, 0.7 and 2 times the paper's impulse; the one at the bottom is the most radial
/// outside the seat, and its levels are twice the paper's.
#[test]
fn example_the_paper_is_answered_figure_by_figure() {
    let (folder, summary) = whole("figures");
    let page = read(&folder.0, "report.html");
    let section = &page[page.find("id=\"numbers\"").expect("a section")..];
    assert!(section.contains("ours is “bottom” at 270°"), "the sensor is not said");
    let bottom = summary.levels.sensors.iter().find(|s| s.sensor == "bottom").expect("a sensor at 270°");
    close(bottom.tone_hz, TONE_HZ, 2.0, "tone at the bottom");
    close(bottom.tone_g, 2.0 * TONE_G, 0.05 * 2.0 * TONE_G, "its amplitude");
    assert!(bottom.tone_db > Some(15.0) && bottom.fifth_hz.is_none() && bottom.fifth_db < Some(10.0));
    // Filtered at its own tone, as the leading sensor is.
    close(bottom.notch_hz, TONE_HZ, 2.0, "its notch");
    let leading = &summary.levels.sensors[0];
    let notch = summary.notch.as_ref().expect("a notch");
    assert_eq!((leading.notch_hz, leading.notch_db), (Some(notch.centre_hz), notch.attenuation_db));
    // What differs stands first: no fifth harmonic and no touch of the floor are farther off than any level.
    let verdict = &section[section.find("Different by more than").expect("a verdict")..];
    let place = |words: &str| verdict.find(words).unwrap_or_else(|| panic!("`{words}` is missing"));
    let order = ["its fifth harmonic", "is not found", "between the impulses, peak", "The other ", "<table"];
    assert!(order.map(place).is_sorted(), "{:?}", order.map(place));
    assert!(place("#2, the roller strikes the floor: 0 passages") < place("The other "));
    // In the order of the paper.
    let figures = ["paper-2", "paper-3", "beat", "beat-zoom", "paper-6", "paper-7a", "paper-7b", "paper-8a"];
    let at = figures.map(|id| page.find(&format!("<figure id=\"{id}\"")).expect("a figure"));
    assert!(at.is_sorted(), "{at:?}");
}

#[test]
fn example_the_ledger_tells_mesh_from_physics() {
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
fn invariant_the_same_directory_gives_the_same_bytes() {
    let (folder, _) = whole("bytes");
    let first = read(&folder.0, "report.html");
    report::write(&folder.0).expect("a second report");
    assert!(first == read(&folder.0, "report.html"), "the page changed");
}

#[test]
fn invariant_a_stretch_of_a_record_shows_what_the_whole_shows_there() {
    /// A median is cut off where the record is, and a path has no crossing before.
    const BY_ENDS_MS: f64 = 0.01;
    let (folder, all) = whole("stretch");
    let from_ms = all.events[0].exit_ms.expect("it leaves the defect") + 1.0;
    let part = report::write_between(&folder.0, 1e-3 * from_ms..f64::INFINITY).expect("a report");
    assert_eq!(part.run.samples, SAMPLES - (1e-3 * from_ms / INTERVAL_S).ceil() as usize);
    assert_eq!(part.events.iter().map(|e| e.roller).collect::<Vec<_>>(), [2, 3]);
    for (found, wanted) in part.events.iter().zip(&all.events[1..]) {
        close(found.entry_ms, wanted.entry_ms.expect("an entry"), BY_ENDS_MS, "entry");
        close(found.exit_ms, wanted.exit_ms.expect("an exit"), BY_ENDS_MS, "exit");
    }
    close(part.kinematics.cage_hz, all.kinematics.cage_hz.expect("a cage"), 1e-6, "cage");
    assert!(part.notes[..].iter().any(|n| n.contains("--from-s")), "{:?}", part.notes);
    assert!(all.notes.iter().all(|n| !n.contains("--from-s")), "{:?}", all.notes);
    close(Some(part.run.simulated_ms), 1e3 * INTERVAL_S * part.run.samples as f64, 1e-6, "time on record");
}

#[test]
fn refuses_a_stretch_that_holds_nothing_and_keeps_the_report() {
    let (folder, _) = whole("beyond");
    let before = read(&folder.0, "report.html");
    for (from_s, to_s, words) in [
        (5.0, f64::INFINITY, "is 0.02999 s long and holds nothing from 5 s on"),
        (f64::NEG_INFINITY, -1.0, "up to -1 s"),
        (5.0, 6.0, "from 5 to 6 s"),
    ] {
        let why = report::write_between(&folder.0, from_s..to_s).expect_err("refused").to_string();
        assert!(why.contains(words), "{why}");
    }
    assert!(before == read(&folder.0, "report.html"), "the page changed");
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
        .expect("a sound scene");
    synthetic::write_scene(&folder.0, &scene, Status::Complete, SAMPLES, 1.0);
    let load = report::write(&folder.0).expect("a report").load;
    let wanted = SUPPORT_N + 10e3 * std::f64::consts::FRAC_2_PI;
    close(Some(load.expected_n), wanted, SAMPLED * wanted, "load and weight");
    close(load.relative_error, SUPPORT_N / wanted - 1.0, SAMPLED, "difference");
    assert!(
        read(&folder.0, "report.html").contains(" rollers under 50.01 to 60 kN at "),
        "the range on record"
    );
}

#[test]
fn example_a_quiet_sound_bearing_has_digits_and_no_words_on_defects() {
    let folder = Scratch::new("quiet");
    let scene = Scene {
        defect: None,
        housing: HousingScene::Rigid(RigidHousingScene::default()),
        ..Scene::default()
    };
    let scene = scene.with_overrides(&["operation.load_angle_deg=0"]).expect("a sound scene");
    synthetic::write_scene(&folder.0, &scene, Status::Complete, SAMPLES, 1e-3);
    let summary = report::write(&folder.0).expect("a report");
    let page = read(&folder.0, "report.html");
    let gap = summary.levels.phases.gap_g.expect("a level");
    assert!(gap > 0.04 && gap < 0.07, "{gap}");
    for words in ["reaches 0.0", "along the radius there"] {
        assert!(page.contains(words), "{words}");
    }
    for words in [
        "reaches 0 g",
        "to 0 g",
        "over the defect",
        "over a spall",
        "no roller leaves",
        "edges of an adapter",
        "elastic outer ring",
        "ring n = 2",
        "brown: modes",
        "red: the defect",
        "rings with the mesh",
    ] {
        assert!(!page.contains(words), "{words}");
    }
}

#[test]
fn example_a_diverged_run_is_reported_with_a_banner_and_nothing_invented() {
    let folder = Scratch::new("diverged");
    // 4 ms: roller 1 has entered the defect and not left it.
    synthetic::write(&folder.0, Status::Diverged, 400);
    let summary = report::write(&folder.0).expect("a report");
    let page = read(&folder.0, "report.html");
    assert!(page.contains("This run diverged") && page.contains("near roller 1"), "no banner");
    assert_eq!(summary.events.len(), 1);
    assert!(summary.events[0].entry_ms.is_some() && summary.events[0].exit_ms.is_none());
    assert_eq!((summary.levels.impulse_g, summary.levels.between_filtered_g), (None, None));
    assert!(summary.notes.iter().any(|n| n.contains("until the record ends")), "{:?}", summary.notes);
    assert!(summary.notes.iter().any(|n| n.contains("no impulse level")), "{:?}", summary.notes);
}

/// Facets of other lengths than those that the tone of the record is from: none of theirs stands out.
#[test]
fn example_arcs_without_a_facet_tone_have_no_notch_and_the_page_says_why() {
    let of = |name: &str, surface: ContactSurface| {
        let folder = Scratch::new(name);
        let mut scene = Scene::default();
        scene.contact.surface = surface;
        synthetic::write_scene(&folder.0, &scene, Status::Complete, SAMPLES, 1.0);
        let mut info: serde_json::Value = serde_json::from_str(&read(&folder.0, "run.json")).expect("JSON");
        for facets in ["roller_facets", "outer_facets", "inner_facets"] {
            let count = info["mesh"][facets].as_u64().expect("a number");
            info["mesh"][facets] = (count + count / 3).into();
        }
        fs::write(folder.0.join("run.json"), info.to_string()).expect("writable");
        let summary = report::write(&folder.0).expect("a report");
        (read(&folder.0, "report.html"), summary, folder)
    };
    let (page, summary, _folder) = of("arcs", ContactSurface::Arc);
    assert!(summary.notch.is_none() && summary.levels.between_filtered_g.is_none());
    assert!(
        summary.notes.iter().any(|n| n.contains("no notch: with `contact.surface: arc`")),
        "{:?}",
        summary.notes
    );
    assert!(!summary.notes.iter().any(|n| n.contains("transient")), "{:?}", summary.notes);
    for figure in ["acceleration-notched", "spectrum-notched", "spectrum-zoom"] {
        assert!(!page.contains(&format!("id=\"{figure}\"")), "{figure}");
    }
    assert!(
        page.contains("id=\"spectrum\"")
            && page.contains("so that a filter there would take nothing of them away")
    );
    let (page, summary, _folder) = of("chords", ContactSurface::Facet);
    assert!(summary.notch.is_some() && page.contains("id=\"spectrum-notched\""));
}

#[test]
fn roundtrip_oil_films_of_the_synthetic_run() {
    /// Of decimal numbers in binary.
    const ROUNDING: f64 = 1e-9;
    let folder = Scratch::new("dry");
    let scene = Scene { film: None, ..Scene::default() };
    synthetic::write_scene(&folder.0, &scene, Status::Complete, SAMPLES, 1.0);
    assert!(report::write(&folder.0).expect("a report").film.is_none());
    let folder = Scratch::new("oil");
    let scene = Scene { film: Some(FilmScene::default()), ..Scene::default() };
    synthetic::write_scene(&folder.0, &scene, Status::Complete, SAMPLES, 1.0);
    let film = report::write(&folder.0).expect("a report").film.expect("oil");
    for (ring, what) in ["outer", "inner"].into_iter().enumerate() {
        close(film.floating_um[ring], 1e6 * FLOATING_M[ring], ROUNDING, what);
        close(film.largest_n[ring], [0.0, WEIGHT_N][ring], ROUNDING, what);
        let loaded = loaded_films(&scene.resolve()).expect("a load").expect("oil")[ring];
        close(Some(film.loaded_um[ring]), 1e6 * loaded.thickness, ROUNDING, what);
        close(Some(film.lambda[ring]), loaded.thickness / 0.3e-6, ROUNDING, what);
    }
    close(film.heat_j, OIL_W * (SAMPLES - 1) as f64 * INTERVAL_S, ROUNDING, "heat");
    let page = read(&folder.0, "report.html");
    for words in ["Oil film of rollers without load", "30.0 and 45.0 µm", "0.0 and 0.4 N"] {
        assert!(page.contains(words), "{words}");
    }
}

#[test]
fn example_the_page_begins_with_the_answer() {
    let (folder, _) = whole("answer");
    let page = read(&folder.0, "report.html");
    let places = [
        "The defect. ",
        "The mesh. ",
        "How far to trust it. ",
        "id=\"numbers\"",
        "id=\"acceleration\"",
        "id=\"spectrum\"",
        "id=\"forces\"",
    ]
    .map(|what| page.find(what).unwrap_or_else(|| panic!("{what} is not in the page")));
    assert!(places.is_sorted(), "{places:?}");
    // The forces stand once, as the paper's figure 8.
    assert!(page.contains("id=\"paper-8a\"") && !page.contains("id=\"force-1\""));
    for odd in ["Ball pass", "Notch takes", "The same above"] {
        assert!(!page.contains(odd), "{odd}");
    }
}

#[test]
fn survives_a_trace_cut_inside_a_row_or_of_no_row() {
    for (name, samples, cut) in [("cut", 500, 12_345), ("none", 0, 0), ("one", 1, 0)] {
        let folder = Scratch::new(name);
        synthetic::write(&folder.0, Status::Interrupted, samples);
        let trace = folder.0.join("trace.npy");
        let length = fs::metadata(&trace).expect("a trace").len();
        let file = fs::OpenOptions::new().write(true).open(&trace).expect("a trace");
        file.set_len(length - cut).expect("a shorter trace");
        let summary = report::write(&folder.0).expect("a report");
        assert!(summary.run.samples + usize::from(cut > 0) <= samples, "{name}: {}", summary.run.samples);
        assert!(read(&folder.0, "report.html").contains("was interrupted"), "{name}");
        if samples < 2 {
            assert_eq!((summary.kinematics.cage_hz, summary.spectrum), (None, None), "{name}");
        }
    }
}

#[test]
fn survives_samples_after_a_bad_number() {
    let folder = Scratch::new("nan");
    synthetic::write(&folder.0, Status::Diverged, 300);
    let trace = folder.0.join("trace.npy");
    let mut bytes = fs::read(&trace).expect("a trace");
    // The last value of the last row but nine.
    let channels = 1 + 4 * 4 + 24 * 11 + 5;
    let at = bytes.len() - 9 * channels * 8 - 8;
    bytes[at..at + 8].copy_from_slice(&f64::NAN.to_le_bytes());
    fs::write(&trace, bytes).expect("a writable folder");
    let summary = report::write(&folder.0).expect("a report");
    assert_eq!(summary.run.samples, 290);
    assert!(summary.notes.iter().any(|n| n.contains("10 samples")), "{:?}", summary.notes);
}

#[test]
fn refuses_what_is_no_run_with_advice() {
    let folder = Scratch::new("absent");
    let error = report::write(&folder.0).expect_err("nothing there").to_string();
    assert!(error.contains("is not a run") && error.contains("`scene.ron` is missing"), "{error}");
    synthetic::write(&folder.0, Status::Complete, 10);
    fs::write(folder.0.join("trace.npy"), "no trace").expect("a writable folder");
    let error = report::write(&folder.0).expect_err("no trace").to_string();
    assert!(error.contains("trace.npy"), "{error}");
    assert!(!folder.0.join("report.html").exists());
}
