//! A real run of the coarse bearing through the report: what the events and the pictures are made of is simulated here.

use std::ops::ControlFlow;
use std::path::PathBuf;

use stribeck_analysis::report;
use stribeck_bearing::simulation::{Host, simulate};
use stribeck_scene::run_dir::RunDir;
use stribeck_scene::run_info::Status;
use stribeck_scene::scene::Scene;

/// A folder that is removed at the end.
struct Scratch(PathBuf);

impl Drop for Scratch {
    fn drop(&mut self) {
        std::fs::remove_dir_all(&self.0).ok();
    }
}

/// Events may be this far from the centre over the edge: contacts have a width.
const EVENT_MS: f64 = 0.5;
/// Length of the defect from the events.
const LENGTH: f64 = 0.05;

#[test]
fn example_a_simulated_passage_gives_events_length_and_pictures() {
    let scene =
        Scene::parse(include_str!("../../../fixtures/scenes/quick.ron"), "quick.ron").expect("a sound scene");
    let folder = Scratch(std::env::temp_dir().join(format!("stribeck-quick-{}", std::process::id())));
    let dir = RunDir::create(&folder.0).expect("a free folder");
    let host = Host {
        threads: 1,
        version: "test".into(),
        commit: "test".into(),
        machine: "test".into(),
        wall_s: &|| 0.0,
        cpu_s: &|| 0.0,
    };
    let info = simulate(&scene, &dir, &host, &mut |_| ControlFlow::Continue(())).expect("a sound scene");
    assert_eq!(info.status, Status::Complete);
    drop(dir);
    let summary = report::write(&folder.0).expect("a report");

    let [event] = &summary.events[..] else { panic!("{:?}", summary.events) };
    assert_eq!(event.roller, 1);
    for (found, truth) in [(event.entry_ms, event.expected_entry_ms), (event.exit_ms, event.expected_exit_ms)]
    {
        let found = found.expect("an event");
        assert!((found - truth).abs() < EVENT_MS, "{found} ms instead of {truth} ms");
    }
    let (length, truth) = (event.spall_mm.expect("a length"), scene.defect.expect("a defect").length_mm);
    assert!((length / truth - 1.0).abs() < LENGTH, "{length} mm instead of {truth} mm");

    // Frames from 0.2 to 5.6 ms, every 0.1 ms.
    let frames = std::fs::read_dir(folder.0.join("frames")).expect("frames").count();
    assert_eq!(frames, 55);
    let page = std::fs::read_to_string(folder.0.join("report.html")).expect("a page");
    for picture in ["stress", "crossing"] {
        assert!(
            page.contains(&format!("<figure id=\"{picture}\"")),
            "{picture} is missing: {:?}",
            summary.notes
        );
    }
    let moving = std::fs::read(folder.0.join("figures/crossing.gif")).expect("an animation");
    assert!(moving.starts_with(b"GIF89a"));
}
