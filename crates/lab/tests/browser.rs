//! The page in a real browser, from a file: it steps, answers its handles, and shows numbers that are right.
//!
//! Needs Chromium and the module that `cargo xtask lab-module` builds. Where either is absent the test says
//! so and checks nothing; under `STRIBECK_NEED_BROWSER` and `STRIBECK_NEED_LAB`, which `.ci/run` sets, it
//! fails instead.

#[path = "browser/devtools.rs"]
mod devtools;

use std::path::{Path, PathBuf};

use devtools::Tab;
use serde_json::Value;
use stribeck_lab::page;
use stribeck_scene::scene::{ModelScene, ReducedScene, Scene};
use stribeck_testing::Scratch;

/// Names under which Chromium is installed.
const NAMES: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "chrome"];

/// Where the module is, if it was built.
const MODULE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../target/lab/stribeck_lab.wasm");

/// What is asked of the page while it runs, in words of its own: `lab`, and fields by their names.
const TOOLS: &str = r#"
  const lab = window.stribeckLab, wait = (ms) => new Promise((done) => setTimeout(done, ms));
  const until = async (what) => {
    for (let n = 0; n < 2500 && !what(); n += 1) await wait(20);
    if (!what()) throw new Error(`in vain: ${what}; the page says “${document.getElementById("trouble").textContent}”`);
  };
  const set = (id, value) => { const field = document.getElementById(id); field.value = value; field.dispatchEvent(new Event("change")); };
  const text = (id) => document.getElementById(id).textContent;
  await until(() => (lab && lab.ready) || !document.getElementById("trouble").hidden);
"#;

/// The paper's bearing, coarse.
fn coarse() -> Scene {
    let mut scene = Scene { name: "coarse".into(), ..Scene::default() };
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

/// The page of a scene.
fn page_of(scene: &Scene, module: &[u8]) -> String {
    page::page(std::slice::from_ref(scene), module, None, "stribeck lab").expect("a sound scene").html
}

fn written(folder: &Scratch, name: &str, html: &str) -> PathBuf {
    let file = folder.join(name);
    std::fs::write(&file, html).expect("a writable folder");
    file
}

/// What a page answers to a script, and what its console said of errors.
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
fn example_the_page_runs_and_its_numbers_are_right() {
    let Some((browser, module)) = tools() else { return };
    let folder = Scratch::create("lab-browser");
    let file = written(&folder, "lab.html", &page_of(&coarse(), &module));
    let script = r#"
      await until(() => lab.picture.time > 0.2);
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
      return { started, bpfo: bpfo.hz, above: bpfo.above, predicted, loadedAt, carried: moved.carried, load: moved.load,
        refused, stillLoad: lab.handles.load, guided: lab.checked.guided, close: lab.checked.close, trouble: text("trouble"), worker: lab.engine.worker };
    "#;
    let said = asked(&browser, &folder, &format!("file://{}", file.display()), script);
    assert_eq!(said["trouble"], "", "{said}");
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
fn example_presets_are_links_and_arcs_take_the_tone_away() {
    let Some((browser, module)) = tools() else { return };
    let folder = Scratch::create("lab-presets");
    let file = written(&folder, "lab.html", &page_of(&coarse(), &module));
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

/// A file that was cut short says so, whatever is left of it.
#[test]
fn refuses_a_file_cut_in_half() {
    let Some((browser, module)) = tools() else { return };
    let folder = Scratch::create("lab-cut");
    let html = page_of(&coarse(), &module);
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
    let html =
        page_of(&coarse(), &module).replacen("<head>", "<head><script>delete window.WebAssembly</script>", 1);
    let file = written(&folder, "lab.html", &html);
    let address = format!("file://{}", file.display());
    let said = asked(&browser, &folder, &address, "return text('trouble');");
    assert!(said.as_str().is_some_and(|words| words.contains("runs no WebAssembly")), "{said}");
}
