//! The page in a real browser, from a file: it steps, answers its handles, and shows numbers that are right.
//!
//! Needs Chromium and the module that `cargo xtask lab-module` builds. Where either is absent the test says
//! so and checks nothing; under `STRIBECK_NEED_BROWSER` and `STRIBECK_NEED_LAB`, which `.ci/run` sets, it
//! fails instead.

#[path = "browser/devtools.rs"]
mod devtools;

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use devtools::Tab;
use serde_json::Value;
use stribeck_lab::page;
use stribeck_scene::scene::{
    ContactSurface, DefectRing, DefectScene, ModelScene, PocketWalls, ReducedScene, Scene,
};
use stribeck_testing::Scratch;

/// Names under which Chromium is installed.
const NAMES: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "chrome"];

/// Where the module is, if it was built.
const MODULE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../target/lab/stribeck_lab.wasm");

/// What is asked of the page while it runs, in words of its own: `lab`, and fields by their names.
const TOOLS: &str = r#"
  const lab = window.stribeckLab, wait = (ms) => new Promise((done) => setTimeout(done, ms));
  const until = async (what) => {
    for (let n = 0; n < 2500 && !what(); n += 1) await wait(20);
    if (!what()) throw new Error(`in vain: ${what}; the page says “${document.getElementById("trouble").textContent}”`);
  };
  const set = (id, value) => { const field = document.getElementById(id); field.value = value; field.dispatchEvent(new Event("change")); };
  // Saved files and played sounds are kept here.
  const saved = [], played = [], urlOf = URL.createObjectURL.bind(URL);
  URL.createObjectURL = (blob) => { saved.push(blob); return urlOf(blob); };
  HTMLAnchorElement.prototype.click = () => {};
  const start = AudioBufferSourceNode.prototype.start;
  AudioBufferSourceNode.prototype.start = function (...with_) { played.push(this.buffer); return start.apply(this, with_); };
  const press = async (id) => { const before = saved.length; document.getElementById(id).click(); await until(() => saved.length > before); return saved[before]; };
  const text = (id) => document.getElementById(id).textContent;
  await until(() => (lab && lab.ready && lab.picture) || !document.getElementById("trouble").hidden);
"#;

/// The paper's bearing, coarse, with a cage that its rollers hold.
fn coarse() -> Scene {
    let mut scene = Scene { name: "coarse".into(), ..Scene::default() };
    scene.cage.as_mut().expect("the paper's").pocket = PocketWalls::Corners;
    scene.model = ModelScene::Reduced(ReducedScene { modes_khz: 15.0, step_us: 2.0 });
    scene.mesh.size_mm = 2.0;
    scene.mesh.roller_facets = 88;
    scene.contact.penalty_scale = 0.2;
    scene
}

fn missing(what: &str, variable: &str) {
    assert!(std::env::var_os(variable).is_none(), "{variable} is set, and there is no {what}");
    eprintln!("SKIPPED: no {what}, so the lab was not opened in a browser");
}

/// A browser and the module, if both are here.
fn tools() -> Option<(PathBuf, Vec<u8>)> {
    let path = std::env::var_os("PATH").unwrap_or_default();
    let browser = std::env::split_paths(&path)
        .flat_map(|folder| NAMES.map(|name| folder.join(name)))
        .find(|candidate| candidate.is_file());
    let module = std::env::var_os("STRIBECK_LAB_MODULE").map_or_else(|| PathBuf::from(MODULE), PathBuf::from);
    let module = std::fs::read(module).ok();
    if browser.is_none() {
        missing("Chromium", "STRIBECK_NEED_BROWSER");
    }
    if module.is_none() {
        missing("module of the lab (`cargo xtask lab-module`)", "STRIBECK_NEED_LAB");
    }
    browser.zip(module)
}

/// The page of the coarse bearing, made once for all tests.
fn coarse_page(module: &[u8]) -> &'static str {
    static MADE: OnceLock<String> = OnceLock::new();
    MADE.get_or_init(|| page_of(&coarse(), module))
}

fn page_of(scene: &Scene, module: &[u8]) -> String {
    page::page(std::slice::from_ref(scene), module, None, "stribeck lab").expect("a valid scene").html
}

fn written(folder: &Scratch, name: &str, html: &str) -> PathBuf {
    let file = folder.join(name);
    std::fs::write(&file, html).expect("a writable folder");
    file
}

/// Result of a script in a page, and errors of its console.
fn asked(browser: &Path, folder: &Scratch, address: &str, script: &str) -> Value {
    let mut tab = Tab::open(browser, &folder.join("profile"));
    tab.go_to(address);
    let answer = tab.answer(&format!("(async () => {{ {TOOLS} {script} }})()"));
    assert_eq!(tab.errors(), Vec::<String>::new(), "in the console");
    answer
}

fn number(answer: &Value, name: &str) -> f64 {
    answer[name].as_f64().unwrap_or_else(|| panic!("no number `{name}` in {answer}"))
}

/// The page runs 200 ms, its load and its spall are moved, and it checks itself.
#[test]
fn behaves_the_page_runs_and_its_numbers_are_right() {
    let Some((browser, module)) = tools() else { return };
    let folder = Scratch::create("lab-browser");
    let file = written(&folder, "lab.html", coarse_page(&module));
    let script = r#"
      await until(() => lab.picture.time > 0.05);
      const memory = lab.memory;
      await until(() => lab.picture.time > 0.2);
      const grown = lab.memory - memory;
      const started = lab.balance.off, bpfo = { ...lab.spectra.bpfo }, predicted = lab.spectra.bpfoHz;
      set("handle-load", "30000");
      await until(() => lab.handles.load === 30000);
      const loadedAt = lab.picture.time;
      set("handle-spallAngle", "100");
      await until(() => lab.handles.spallAngle === 100 && lab.picture.time > 0.05);
      await wait(900);
      const moved = lab.balance;
      set("handle-load", "nonsense");
      await wait(100);
      const refused = document.querySelector("[data-key=load] .why").textContent;
      document.getElementById("run").click();
      document.getElementById("check").click();
      await until(() => lab.checked);
      return { started, bpfo: bpfo.hz, above: bpfo.above, predicted, loadedAt, carried: moved.carried, load: moved.load, grown,
        refused, stillLoad: lab.handles.load, guided: lab.checked.guided, close: lab.checked.close, trouble: text("trouble"), worker: lab.engine.worker };
    "#;
    let said = asked(&browser, &folder, &format!("file://{}", file.display()), script);
    assert_eq!(said["trouble"], "", "{said}");
    assert_eq!(number(&said, "grown"), 0.0, "memory while it steps: {said}");
    assert!(number(&said, "loadedAt") > 0.2, "the load is turned while the bearing runs: {said}");
    // Forces sum to the load and the weight, before and after.
    assert!(number(&said, "started").abs() < 1e-3, "{said}");
    let off = number(&said, "carried") / number(&said, "load") - 1.0;
    assert!(off.abs() < 1e-3 && number(&said, "load") < 31e3, "{said}");
    // A line of a record of 200 ms is 8 Hz wide.
    assert!((number(&said, "bpfo") - number(&said, "predicted")).abs() < 8.0, "{said}");
    assert!(number(&said, "above") > 6.0, "{said}");
    let refused = said["refused"].as_str().expect("words");
    assert!(refused.contains("must be a number between 1 and 1000000 N"), "{refused}");
    assert_eq!(said["stillLoad"], 30000.0);
    // The step is the program's.
    assert!(number(&said, "guided") < 1e-9, "{said}");
    assert!(number(&said, "close") > 3e-3, "{said}");
}

/// A preset is reached by its link; arcs take the tone of the facets away. Without a worker the page steps
/// itself.
#[test]
fn behaves_presets_are_links_and_arcs_take_the_tone_away() {
    let Some((browser, module)) = tools() else { return };
    let folder = Scratch::create("lab-presets");
    let file = written(&folder, "lab.html", coarse_page(&module));
    let script = r#"
      await until(() => lab.picture.time > 0.1 && lab.spectra.tone);
      const facets = lab.spectra.corners.level, words = text("words"), alone = !lab.engine.worker;
      const hz = Number(/= ([\d.]+) kHz/.exec(words)[1]) * 1000, f = lab.handles.facets;
      location.hash = "arcs";
      await until(() => lab.handles.arcs === 1 && lab.picture.time > 0.08 && lab.record.count > 7000);
      await wait(900);
      const arcs = lab.spectra.corners.level;
      return { facets, arcs, tone: lab.spectra.tone, hz, f, alone, trouble: text("trouble") };
    "#;
    let said = asked(&browser, &folder, &format!("file://{}?alone#facets", file.display()), script);
    assert_eq!((&said["trouble"], &said["alone"]), (&Value::from(""), &Value::from(true)), "{said}");
    // 68 facets at 41.7 Hz.
    assert!((number(&said, "hz") - 41.7 * number(&said, "f")).abs() < 30.0, "{said}");
    assert_eq!(said["tone"], Value::Null, "{said}");
    assert!(number(&said, "arcs") < 0.3 * number(&said, "facets"), "{said}");
}

/// Every control has a name for screen readers, arrow keys do what a mouse does, text that is no number is
/// refused, and a phone shows the page without scrolling sideways, but for the rows of buttons.
#[test]
fn behaves_a_phone_has_room_and_controls_have_names() {
    let Some((browser, module)) = tools() else { return };
    let folder = Scratch::create("lab-phone");
    let file = written(&folder, "lab.html", coarse_page(&module));
    let mut tab = Tab::open(&browser, &folder.join("profile"));
    let phone = serde_json::json!({ "width": 390, "height": 844, "deviceScaleFactor": 2, "mobile": true });
    tab.call("Emulation.setDeviceMetricsOverride", phone);
    tab.go_to(&format!("file://{}", file.display()));
    let script = r#"
      await until(() => lab.picture.time > 0.03);
      const key = (id, name) => document.getElementById(id).dispatchEvent(new KeyboardEvent("keydown", { key: name }));
      const sensor = lab.handles.sensor, roller = lab.handles.roller;
      key("stage", "ArrowLeft");
      await until(() => lab.handles.sensor !== sensor && text("told") !== "");
      const told = text("told");
      const spoken = () => document.getElementById("spectrum").getAttribute("aria-valuetext");
      await until(() => { key("spectrum", "ArrowRight"); return spoken().includes("Hz"); });
      const read = spoken();
      const refused = {};
      for (const value of ["NaN", "", "1e999", "-3"]) { set("handle-load", value); refused[value] = document.querySelector("[data-key=load] .why").textContent; }
      document.getElementById("run").click();
      const beyond = [...document.querySelectorAll("body *")].filter((e) => e.offsetParent && !e.closest("nav, .bar") && e.getBoundingClientRect().right > innerWidth + 1).map((e) => e.id || e.className || e.tagName);
      return { told, read, refused, load: lab.handles.load, wide: document.scrollingElement.scrollWidth, beyond, trouble: text("trouble") };
    "#;
    let said = tab.answer(&format!("(async () => {{ {TOOLS} {script} }})()"));
    assert_eq!(tab.errors(), Vec::<String>::new(), "in the console");
    assert_eq!(said["trouble"], "", "{said}");
    assert!(said["told"].as_str().is_some_and(|words| words.starts_with("Sensor at ")), "{said}");
    assert!(said["read"].as_str().is_some_and(|words| words.contains("Hz")), "{said}");
    for (given, why) in said["refused"].as_object().expect("answers") {
        let why = why.as_str().expect("words");
        assert!(why.contains("must be a number between 1 and 1000000 N"), "{given}: {why}");
    }
    assert_eq!(number(&said, "load"), coarse().operation.load_n);
    assert!(number(&said, "wide") <= 390.0 && said["beyond"] == serde_json::json!([]), "{said}");
    let tree = tab.call("Accessibility.getFullAXTree", serde_json::json!({}));
    let controls: Vec<&Value> =
        tree["nodes"].as_array().expect("a tree").iter().filter(|node| is_control(node)).collect();
    assert!(controls.len() > 40, "{} controls", controls.len());
    let nameless = |node: &&&Value| node["name"]["value"].as_str().is_none_or(|name| name.trim().is_empty());
    let nameless: Vec<_> = controls.iter().filter(nameless).collect();
    assert!(nameless.is_empty(), "without a name: {nameless:?}");
}

/// Whether a node of the tree that screen readers are given takes the keyboard, the page itself aside.
fn is_control(node: &Value) -> bool {
    let focusable = |property: &Value| property["name"] == "focusable" && property["value"]["value"] == true;
    node["role"]["value"] != "RootWebArea"
        && node["properties"].as_array().is_some_and(|properties| properties.iter().any(focusable))
}

/// A file that was cut short says so, whatever is left of it.
#[test]
fn refuses_a_file_cut_in_half() {
    let Some((browser, module)) = tools() else { return };
    let folder = Scratch::create("lab-cut");
    let html = coarse_page(&module);
    let file = written(&folder, "half.html", &html[..html.len() / 2]);
    let mut tab = Tab::open(&browser, &folder.join("profile"));
    tab.go_to(&format!("file://{}", file.display()));
    let said = tab.answer("(async () => { const p = document.getElementById('incomplete'); return p.offsetHeight > 0 ? p.textContent : ''; })()");
    assert!(said.as_str().is_some_and(|words| words.contains("the file is not complete")), "{said}");
}

/// A browser without WebAssembly gets a sentence.
#[test]
fn refuses_a_browser_without_web_assembly() {
    let Some((browser, module)) = tools() else { return };
    let folder = Scratch::create("lab-without");
    let html = coarse_page(&module).replacen("<head>", "<head><script>delete window.WebAssembly</script>", 1);
    let file = written(&folder, "lab.html", &html);
    let address = format!("file://{}", file.display());
    let said = asked(&browser, &folder, &address, "return text('trouble');");
    assert!(said.as_str().is_some_and(|words| words.contains("runs no WebAssembly")), "{said}");
}

/// A browser without vectors in WebAssembly gets a sentence.
#[test]
fn refuses_a_browser_without_vectors() {
    let Some((browser, module)) = tools() else { return };
    let folder = Scratch::create("lab-scalar");
    let off = "<head><script>WebAssembly.validate = () => false</script>";
    let file = written(&folder, "lab.html", &coarse_page(&module).replacen("<head>", off, 1));
    let address = format!("file://{}", file.display());
    let said = asked(&browser, &folder, &address, "return text('trouble');");
    assert!(said.as_str().is_some_and(|words| words.contains("no vectors in WebAssembly (SIMD)")), "{said}");
}

/// A diverging run stops with the program's message, and restarts from valid handles.
#[test]
fn refuses_to_go_on_with_a_run_that_goes_wrong() {
    let Some((browser, module)) = tools() else { return };
    let folder = Scratch::create("lab-wrong");
    let mut scene = coarse();
    scene.model = ModelScene::Reduced(ReducedScene { modes_khz: 15.0, step_us: 5.0 });
    let file = written(&folder, "lab.html", &page_of(&scene, &module));
    let script = r#"
      set("handle-speed", "20000");
      await until(() => text("trouble") !== "");
      const stopped = text("trouble"), running = lab.running;
      set("handle-speed", "500");
      document.getElementById("restart").click();
      await until(() => lab.running && lab.picture.time > 0.01 && lab.picture.time < 0.5);
      return { stopped, running, after: text("trouble") };
    "#;
    let said = asked(&browser, &folder, &format!("file://{}", file.display()), script);
    let stopped = said["stopped"].as_str().expect("words");
    assert!(stopped.contains("The run has stopped: energy is off by"), "{stopped}");
    assert!(stopped.contains("Take a smaller `model.step_us`"), "{stopped}");
    assert_eq!((&said["running"], &said["after"]), (&Value::from(false), &Value::from("")), "{said}");
}

/// Three bearings in one page: each runs with its own rollers, and is itself again when it is chosen again.
#[test]
fn behaves_a_page_with_three_bearings_goes_from_one_to_another() {
    let Some((browser, module)) = tools() else { return };
    let folder = Scratch::create("lab-three");
    let small = |designation: &str| {
        let text = format!(
            "(name: \"{}\", bearing: \"{designation}\", model: reduced(modes_khz: 15.0), mesh: \
             (size_mm: 1.5))",
            designation.replace(' ', "")
        );
        Scene::parse(&text, "a scene").expect("a bearing of the catalogue")
    };
    let scenes = [coarse(), small("NU 205"), small("6205")];
    let rollers = scenes.each_ref().map(|scene| scene.bearing.rollers as f64);
    let html = page::page(&scenes, &module, None, "stribeck lab").expect("sound scenes").html;
    let file = written(&folder, "lab.html", &html);
    let script = r#"
      const pick = document.getElementById("bearing"), seen = [];
      for (const n of [1, 2, 0, 2, 1]) {
        set("bearing", n);
        await until(() => lab.opened === n && lab.picture && lab.picture.time > 0.02 && lab.record.count > 100);
        seen.push({ n, title: lab.facts.title, rollers: lab.picture.rollers.length, load: lab.handles.load,
          largest: Math.max(...lab.picture.rollers.map((r) => r.outer)), lead: text("lead"), running: lab.running,
          watched: document.getElementById("roller").parentElement.textContent.trim(), force: text("force-name") });
      }
      // From one to the next before the first is there.
      set("bearing", 0); set("bearing", 1); set("bearing", 2);
      await until(() => lab.opened === 2 && lab.picture && lab.picture.time > 0.01);
      return { seen, shown: !document.getElementById("bearing-label").hidden, names: [...pick.options].map((o) => o.textContent),
        trouble: text("trouble"), errors: lab.errors, last: lab.picture.rollers.length };
    "#;
    let said = asked(&browser, &folder, &format!("file://{}", file.display()), script);
    assert_eq!((&said["trouble"], &said["shown"]), (&Value::from(""), &Value::from(true)), "{said}");
    assert_eq!(said["names"], serde_json::json!(["coarse", "NU 205", "6205"]));
    for seen in said["seen"].as_array().expect("a list") {
        let n = number(seen, "n") as usize;
        assert_eq!(number(seen, "rollers"), rollers[n], "{seen}");
        // The most loaded roller has more than its share of the load and less than all of it.
        let share = number(seen, "largest") / number(seen, "load");
        assert!(share > 1.0 / rollers[n] && share < 1.2, "{seen}");
        assert!(
            seen["lead"].as_str().is_some_and(|words| words.starts_with(["coarse:", "NU 205:", "6205:"][n])),
            "{seen}"
        );
        assert_eq!(seen["running"], true);
        // A 6205 has balls.
        let element = if n == 2 { "ball" } else { "roller" };
        let words = [&seen["watched"], &seen["force"], &seen["lead"]].map(|text| text.as_str().unwrap_or(""));
        assert!(words[0] == element && words.iter().all(|text| text.contains(element)), "{seen}");
    }
    assert_eq!(number(&said, "last"), rollers[2]);
}

/// What is saved is what is shown: samples, a picture, and the scene with its handles, which is read again.
#[test]
fn roundtrip_what_is_saved_and_what_is_heard() {
    let Some((browser, module)) = tools() else { return };
    let folder = Scratch::create("lab-saved");
    let scene = coarse();
    let file = written(&folder, "lab.html", coarse_page(&module));
    let script = r#"
      const handles = { load: 41000, speed: 612.5, friction: 0.011, contactDamping: 0.25, massDamping: 120, clearance: 12,
        viscosity: 0, arcs: 1, facets: 96, spallRing: 2, spallAngle: 77, spallLength: 8.5, spallDepth: 0.15, spallSlope: 60, step: 1.25 };
      for (const [key, value] of Object.entries(handles)) { set(`handle-${key}`, String(value)); await until(() => lab.handles[key] === value || text("trouble")); }
      await until(() => lab.picture.time > 0.05 && lab.record.count > 4000);
      document.getElementById("listen").click();
      const sounding = document.getElementById("listen").getAttribute("aria-pressed"), words = text("listen");
      document.getElementById("listen").click();
      document.getElementById("run").click();
      await wait(300);
      const csv = await (await press("csv")).text(), ron = await (await press("ron")).text(), png = await press("png");
      const bitmap = await createImageBitmap(png), sound = played[0], data = sound.getChannelData(0);
      set("handle-spallRing", "0");
      await until(() => lab.handles.spallRing === 0);
      set("handle-viscosity", "0.08");
      await until(() => lab.handles.viscosity === 0.08);
      const oiled = await (await press("ron")).text();
      return { csv: csv.slice(0, 600), rows: csv.trim().split("\n").length - 1, count: lab.record.count, ron, oiled, trouble: text("trouble"),
        last: csv.trim().split("\n").at(-1).split(",").map(Number), time: lab.picture.time,
        wide: bitmap.width, high: bitmap.height, type: png.type, sounding, words,
        seconds: sound.duration, rate: sound.sampleRate, loudest: data.reduce((most, v) => Math.max(most, Math.abs(v)), 0) };
    "#;
    let said = asked(&browser, &folder, &format!("file://{}", file.display()), script);
    assert_eq!(said["trouble"], "", "{said}");
    let csv = said["csv"].as_str().expect("text");
    assert!(csv.starts_with("time_s,acceleration_x_m_s2,acceleration_y_m_s2,"), "{csv}");
    assert!(number(&said, "rows") > 4000.0, "{said}");
    let last = said["last"].as_array().expect("a row");
    assert_eq!(last.len(), 10);
    assert!(last.iter().all(|n| n.as_f64().is_some_and(f64::is_finite)), "{last:?}");
    assert!(number(&said, "wide") > 1000.0 && number(&said, "high") > 500.0, "{said}");
    assert_eq!((&said["type"], &said["sounding"]), (&Value::from("image/png"), &Value::from("true")));
    assert!(said["words"].as_str().is_some_and(|words| words.contains("at true pitch")), "{said}");
    // As long as what was recorded, at its rate or half of it, and not clipped.
    assert!(number(&said, "seconds") > 0.03 && number(&said, "rate") >= 25e3, "{said}");
    assert!((0.1..=1.0).contains(&number(&said, "loudest")), "{said}");
    let read = |ron: &Value| {
        let file = written(&folder, "saved.ron", ron.as_str().expect("text"));
        Scene::read(&file).unwrap_or_else(|error| panic!("{error}\n{ron}"))
    };
    let mut wanted = scene.clone();
    wanted.output.frames = None;
    wanted.operation.load_n = 41_000.0;
    wanted.operation.speed_rpm = 612.5;
    wanted.contact.friction = 0.011;
    wanted.contact.damping_ratio = 0.25;
    wanted.solver.mass_damping_per_s = 120.0;
    wanted.bearing.inner_race_diameter_mm -= 0.012;
    wanted.film = None;
    wanted.contact.surface = ContactSurface::Arc;
    wanted.mesh.roller_facets = 96;
    wanted.model = ModelScene::Reduced(ReducedScene { modes_khz: 15.0, step_us: 1.25 });
    wanted.defect = Some(DefectScene {
        ring: DefectRing::Inner,
        length_mm: 8.5,
        depth_mm: 0.15,
        angle_deg: 77.0,
        edge_slope_deg: 60.0,
        width_mm: None,
    });
    assert_eq!(read(&said["ron"]).to_ron(), wanted.to_ron());
    let oiled = read(&said["oiled"]);
    assert_eq!(oiled.defect, None);
    assert_eq!(oiled.film.map(|film| film.viscosity_pa_s), Some(0.08));
}

/// The page steps two scenes as the program does: forces from ten states of its run, a millisecond each,
/// differ by rounding alone; in one piece they do until something strikes (docs/guide/src/lab.md).
#[test]
fn invariant_the_page_steps_as_the_program_does() {
    // What vectors of another width and products that are rounded leave before anything strikes; balls that are
    // struck on contacts as stiff as steel make of it 6e-9 within a millisecond, with forces solved to the last
    // digit.
    const ROUNDING: f64 = 1e-9;
    const STRUCK: f64 = 1e-7;
    let Some((browser, module)) = tools() else { return };
    let folder = Scratch::create("lab-check");
    let read = |name: &str| {
        let file = format!(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../fixtures/scenes/{}.ron"), name);
        Scene::read(file).expect("a scene of the repository")
    };
    let scenes = ["quick", "deep_groove"].map(read);
    let html = page::page(&scenes, &module, None, "stribeck lab").expect("sound scenes").html;
    let file = written(&folder, "lab.html", &html);
    let script = r#"
      const all = [];
      for (const n of [0, 1]) {
        set("bearing", n);
        await until(() => lab.opened === n && lab.picture);
        document.getElementById("run").click();
        document.getElementById("check").click();
        await until(() => lab.checked);
        all.push({ guided: lab.checked.guided, first: Math.max(...lab.checked.course.slice(0, 30)), words: text("checked") });
      }
      return { all, trouble: text("trouble") };
    "#;
    let said = asked(&browser, &folder, &format!("file://{}", file.display()), script);
    assert_eq!(said["trouble"], "", "{said}");
    for checked in said["all"].as_array().expect("a list") {
        assert!(number(checked, "guided") < STRUCK, "{checked}");
        assert!(number(checked, "first") < ROUNDING, "{checked}");
        assert!(checked["words"].as_str().is_some_and(|words| words.contains("from 10 states")), "{checked}");
    }
}
