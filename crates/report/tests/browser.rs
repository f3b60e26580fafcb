//! The report in a real browser: no error in its console, every figure drawn.
//!
//! Needs Chromium. Where it is absent the test says so and checks nothing; under `STRIBECK_NEED_BROWSER`,
//! which `.ci/run` sets, it fails instead.

mod synthetic;

use std::path::{Path, PathBuf};
use std::process::Command;

use stribeck_report as report;
use stribeck_scene::run_info::Status;
use synthetic::Scratch;

/// Time that scripts get [ms of the browser's own clock].
const BUDGET_MS: u32 = 20_000;

/// Names under which Chromium is installed.
const NAMES: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "chrome"];

/// Appended to the page: counts what was drawn and writes it into the title, where `--dump-dom` shows it.
const PROBE: &str = r#"<script>
addEventListener("load", () => setTimeout(() => {
  const undrawn = [];
  for (const figure of document.querySelectorAll("figure")) {
    const canvas = figure.querySelector("canvas");
    if (figure.matches(".plot, .moving-bearing")) {
      if (!canvas || !canvas.width || !canvas.height) { undrawn.push(figure.id + ": no canvas"); continue; }
      const pixels = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
      const colours = new Set();
      for (let i = 0; i < pixels.length; i += 4) if (pixels[i + 3]) colours.add(pixels[i] << 16 | pixels[i + 1] << 8 | pixels[i + 2]);
      if (colours.size < 3) undrawn.push(figure.id + ": " + colours.size + " colours");
    } else if (figure.matches(".sound")) {
      // The header of a WAV file alone is shorter.
      if (figure.querySelector("audio").src.length < 100) undrawn.push(figure.id + ": silent");
    } else {
      const image = figure.querySelector("img"), drawing = figure.querySelector("svg");
      if (image ? !(image.complete && image.naturalWidth > 0) : !(drawing && drawing.childElementCount > 2)) undrawn.push(figure.id + ": empty");
    }
  }
  const count = document.querySelectorAll("figure").length;
  document.title = "PROBE figures=" + count + " undrawn=" + undrawn.join(";") + " errors=" + window.seenErrors.join(";") + " END";
}, 500));
</script>"#;

/// Prepended: collects everything that goes wrong.
const WATCH: &str = r#"<script>
window.seenErrors = [];
addEventListener("error", (e) => window.seenErrors.push(String(e.message || e.target.src || e.type)), true);
addEventListener("unhandledrejection", (e) => window.seenErrors.push(String(e.reason)));
const told = console.error;
console.error = (...words) => { window.seenErrors.push(words.join(" ")); told(...words); };
</script>"#;

/// A browser, or the reason why there is none to test with.
fn browser() -> Option<PathBuf> {
    let path = std::env::var_os("PATH")?;
    let found = std::env::split_paths(&path)
        .flat_map(|folder| NAMES.map(|name| folder.join(name)))
        .find(|candidate| candidate.is_file());
    if found.is_none() {
        assert!(
            std::env::var_os("STRIBECK_NEED_BROWSER").is_none(),
            "STRIBECK_NEED_BROWSER is set and none of {NAMES:?} is installed"
        );
        eprintln!("SKIPPED: none of {NAMES:?} is installed, so the report was not opened in a browser");
    }
    found
}

/// What the page says after its scripts have run, in a browser of its own, `dark` or not.
fn title_of(browser: &Path, page: &Path, profile: &Path, dark: bool) -> String {
    let mut command = Command::new(browser);
    command
        .args(["--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run"])
        .arg(format!("--user-data-dir={}", profile.display()))
        .arg(format!("--virtual-time-budget={BUDGET_MS}"))
        .arg("--window-size=1200,900");
    if dark {
        command.arg("--force-dark-mode").arg("--blink-settings=preferredColorScheme=0");
    }
    let output = command
        .arg("--dump-dom")
        .arg(format!("file://{}", page.display()))
        .output()
        .expect("an installed browser starts");
    let dom = String::from_utf8_lossy(&output.stdout).into_owned();
    let probe = dom.split("PROBE ").nth(1).and_then(|rest| rest.split(" END").next());
    probe.map_or_else(
        || panic!("the page's scripts did not finish: {}", String::from_utf8_lossy(&output.stderr)),
        str::to_owned,
    )
}

#[test]
fn example_a_browser_draws_every_figure_without_an_error() {
    let Some(browser) = browser() else { return };
    let folder = Scratch::new("browser");
    synthetic::write(&folder.0, Status::Complete, 3000);
    report::write(&folder.0).expect("a report");
    draws_all(&browser, &folder);
}

#[test]
fn example_a_browser_draws_every_figure_of_an_ensemble() {
    let Some(browser) = browser() else { return };
    let folder = Scratch::new("browser-ensemble");
    synthetic::write_ensemble(&folder.0, &[0.8, 1.0, 1.2], 3);
    report::write_ensemble(&folder.0).expect("a report");
    draws_all(&browser, &folder);
}

/// Opens the report in `folder`, by day and by night.
fn draws_all(browser: &Path, folder: &Scratch) {
    let page = std::fs::read_to_string(folder.0.join("report.html")).expect("a page");
    let figures = page.matches("<figure id=").count();
    let watched = page.replacen("<head>", &format!("<head>{WATCH}"), 1).replacen(
        "</body>",
        &format!("{PROBE}</body>"),
        1,
    );
    assert_ne!(watched.len(), page.len());
    // Snap's Chromium sees no hidden folders and no /tmp of ours; the folder of the run is as good as any.
    let probed = folder.0.join("probed.html");
    std::fs::write(&probed, watched).expect("a writable folder");
    for dark in [false, true] {
        let said = title_of(browser, &probed, &folder.0.join("profile"), dark);
        assert_eq!(said, format!("figures={figures} undrawn= errors="), "dark: {dark}");
    }
}
