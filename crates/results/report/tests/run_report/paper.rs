//! The paper's numbers and figures, beside those of the run.

use stribeck_analysis::comparison::{Comparison, Side};
use stribeck_report as report;
use stribeck_scene::scene::{ContactSurface, Scene};
use stribeck_store::run_info::Status;
use stribeck_testing::Scratch;

use crate::synthetic::{self, TONE_G, TONE_HZ};
use crate::{SAMPLES, close, read, whole};

#[test]
fn behaves_every_number_of_the_paper_has_a_row_without_a_blank() {
    let (folder, summary) = whole("paper");
    let page = read(folder.path(), "report.html");
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
fn planted_the_paper_is_answered_figure_by_figure() {
    let (folder, summary) = whole("figures");
    let page = read(folder.path(), "report.html");
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

/// The scene without the tone was told as a failure, 6 of 14 numbers met, and a comparison of both did not name the
/// line that comes and goes.
#[test]
fn issue_a_tone_that_arcs_take_away_is_told_as_that() {
    let folder = Scratch::create("cured");
    let mut arcs = Scene::default();
    let page = |name: &str, scene: &Scene| {
        let run = folder.join(name);
        synthetic::write_scene(&run, scene, Status::Complete, SAMPLES, 1.0);
        report::write(&run).expect("a report");
        (read(&run, "report.html"), Side::of_folder(name, &run, None).expect("a run"))
    };
    let (of_facets, facets) = page("facets", &arcs);
    assert!(of_facets.contains("singh2014_smooth.ron") && !of_facets.contains("gone with the facets"));
    arcs.contact.surface = ContactSurface::Arc;
    let (of_arcs, arcs) = page("arcs", &arcs);
    assert!(
        of_arcs.contains("is gone, as contact on arcs predicts") && of_arcs.contains("gone with the facets")
    );
    assert!(!of_arcs.contains("is not found"), "a number of the tone is told as missing");
    let comparison = Comparison::of(vec![facets, arcs]).expect("two runs");
    let words = report::comparison_in_words(&comparison);
    assert!(words[0].contains("facets has it at 46") && words[0].ends_with("arcs has none."), "{words:?}");
    let line = comparison.mesh_lines[0].expect("a line");
    close(Some(line.hz), TONE_HZ, 2.0, "the line of the mesh");
}
