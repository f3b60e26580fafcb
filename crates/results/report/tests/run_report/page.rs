//! The page: its figures, its order, its words, and that it loads nothing.

use std::fs;

use stribeck_report as report;
use stribeck_scene::housing::{HousingScene, RigidHousingScene};
use stribeck_scene::scene::{ContactSurface, Scene};
use stribeck_store::run_info::Status;

use crate::synthetic;
use crate::{SAMPLES, read, whole};
use stribeck_testing::{Scratch, assert_has};

/// Largest page that mails and reviews still take.
const PAGE_LIMIT_BYTES: u64 = 15_000_000;

/// What the moving bearing of 24 rollers may add to a page: 600 frames of two forces in bytes, 76 of two
/// angles in two bytes each, as text.
const MOVING_LIMIT_BYTES: usize = 60_000;

#[test]
fn behaves_the_page_holds_every_figure_and_needs_no_network() {
    let (folder, _) = whole("page");
    let page = read(folder.path(), "report.html");
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
    ] {
        assert!(page.contains(&format!("<figure id=\"{figure}\"")), "{figure} is not in the page");
        let picture = read(folder.path(), &format!("figures/{figure}.svg"));
        assert!(
            picture.starts_with("<svg") && picture.trim_end().ends_with("</svg>"),
            "{figure}.svg is broken"
        );
        let pixels = fs::read(folder.join(format!("figures/{figure}.png"))).expect("a picture");
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
fn behaves_the_page_begins_with_the_answer() {
    let (folder, _) = whole("answer");
    let page = read(folder.path(), "report.html");
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
fn behaves_a_quiet_sound_bearing_has_digits_and_no_words_on_defects() {
    let folder = Scratch::new("quiet");
    let scene = Scene {
        defect: None,
        housing: HousingScene::Rigid(RigidHousingScene::default()),
        ..Scene::default()
    };
    let scene = scene.with_overrides(&["operation.load_angle_deg=0"]).expect("a valid scene");
    synthetic::write_scene(folder.path(), &scene, Status::Complete, SAMPLES, 1e-3);
    let summary = report::write(folder.path()).expect("a report");
    let page = read(folder.path(), "report.html");
    let gap = summary.levels.phases.gap_g.expect("a level");
    assert!(gap > 0.04 && gap < 0.07, "{gap}");
    assert_has(&page, &["reaches 0.0", "along the radius there"]);
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

/// Facets of other lengths than those that the tone of the record is from: none of theirs stands out.
#[test]
fn behaves_arcs_without_a_facet_tone_have_no_notch_and_the_page_says_why() {
    let of = |name: &str, surface: ContactSurface| {
        let folder = Scratch::new(name);
        let mut scene = Scene::default();
        scene.contact.surface = surface;
        synthetic::write_scene(folder.path(), &scene, Status::Complete, SAMPLES, 1.0);
        let mut info: serde_json::Value =
            serde_json::from_str(&read(folder.path(), "run.json")).expect("JSON");
        for facets in ["roller_facets", "outer_facets", "inner_facets"] {
            let count = info["mesh"][facets].as_u64().expect("a number");
            info["mesh"][facets] = (count + count / 3).into();
        }
        fs::write(folder.join("run.json"), info.to_string()).expect("writable");
        let summary = report::write(folder.path()).expect("a report");
        (read(folder.path(), "report.html"), summary, folder)
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
fn invariant_the_same_directory_gives_the_same_bytes() {
    let (folder, _) = whole("bytes");
    let first = read(folder.path(), "report.html");
    report::write(folder.path()).expect("a second report");
    assert!(first == read(folder.path(), "report.html"), "the page changed");
}

/// A 6205 has balls, and its page and pictures call them so; names of channels and fields stay.
#[test]
fn issue_the_page_of_a_ball_bearing_speaks_of_balls() {
    let folder = Scratch::new("balls");
    let scene = Scene::parse("(bearing: \"6205\", model: full)", "here").expect("a bearing of the catalogue");
    synthetic::write_scene(folder.path(), &scene, Status::Complete, SAMPLES, 1.0);
    report::write(folder.path()).expect("a report");
    let page = read(folder.path(), "report.html");
    let text = page.split("<pre>").next().expect("what is before the scene");
    assert_has(text, &["9 balls, modelled as cylinders,", "Largest ball force", ">Ball</th>"]);
    // What is left are names: of channels, fields, figures and their parts.
    let odd = ["a roller ", "rollers ", " roller 1", "Rollers", "the roller", ">Roller"];
    for words in odd {
        let found =
            text.find(words).map(|at| text[at.saturating_sub(60)..].chars().take(140).collect::<String>());
        assert_eq!(found, None, "{words}");
    }
    let picture = read(folder.path(), "figures/spin.svg");
    assert!(picture.contains("balls") && !picture.contains("rollers"), "the picture's words");
    assert!(page.contains("roller_diameter_mm"), "the scene keeps its fields");
}
