//! The report in a real browser: no error in its console, every figure drawn.
//!
//! Needs Chromium. Where it is absent the test says so and checks nothing; under `STRIBECK_NEED_BROWSER`,
//! which `.ci/run` sets, it fails instead.

mod synthetic;

use std::path::{Path, PathBuf};
use std::process::Command;

use stribeck_diagnosis::series::Series;
use stribeck_diagnosis::{Analysis, Machine, MeasuredFindings};
use stribeck_dsp::channel::Channel;
use stribeck_report as report;
use stribeck_store::run_info::Status;
use stribeck_testing::Noise;
use stribeck_testing::Scratch;
use stribeck_theory::catalogue::CatalogueBearing;

/// Time that scripts get [ms of the browser's own clock].
const BUDGET_MS: u32 = 20_000;

/// Names under which Chromium is installed.
const NAMES: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "chrome"];

/// Appended to the page: opens what is folded up, counts the drawn elements and writes their number into the title, where
/// `--dump-dom` shows it.
const PROBE: &str = r#"<script>
addEventListener("load", () => document.querySelectorAll("details").forEach((fold) => { fold.open = true; }));
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
    title_in(browser, page, profile, dark, "1200,900")
}

/// The same in a window of this size.
fn title_in(browser: &Path, page: &Path, profile: &Path, dark: bool, size: &str) -> String {
    let mut command = Command::new(browser);
    command
        .args(["--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run"])
        .arg(format!("--user-data-dir={}", profile.display()))
        .arg(format!("--virtual-time-budget={BUDGET_MS}"))
        .arg(format!("--window-size={size}"));
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
fn behaves_a_browser_draws_every_figure_without_an_error() {
    let Some(browser) = browser() else { return };
    let folder = Scratch::new("browser");
    synthetic::write(folder.path(), Status::Complete, 3000);
    report::write(folder.path()).expect("a report");
    draws_all(&browser, &folder);
}

#[test]
fn behaves_a_browser_draws_every_figure_of_an_ensemble() {
    let Some(browser) = browser() else { return };
    let folder = Scratch::new("browser-ensemble");
    synthetic::write_ensemble(folder.path(), &[0.8, 1.0, 1.2], 3);
    report::write_ensemble(folder.path()).expect("a report");
    draws_all(&browser, &folder);
}

/// Impacts of an outer raceway of a 6205 at 1200 rpm, that ring at 3 kHz.
fn impacts(height: f64) -> Channel {
    impacts_and_shaft(height, 0.0)
}

/// The same with a line of the shaft.
fn impacts_and_shaft(height: f64, shaft: f64) -> Channel {
    let mut noise = Noise::new(7);
    let samples = (0..65_536).map(|n| {
        let time = f64::from(n) / 12_800.0;
        let since = time.rem_euclid(1.0 / 71.7);
        let turned = (std::f64::consts::TAU * 20.0 * time).sin();
        let ringing = (-since / 1e-3).exp() * (std::f64::consts::TAU * 3_000.0 * since).sin();
        noise.uniform() + height * ringing + shaft * turned
    });
    Channel::held("housing", samples.collect()).in_unit(Some("g".to_owned()))
}

/// A measured record over one of the healthy machine: kurtogram, spectrogram, waterfall, both curves.
#[test]
fn behaves_a_browser_draws_every_figure_of_a_measured_record() {
    let folder = Scratch::new("browser-measured");
    let machine = Machine {
        speed_rpm: Some(1200.0),
        bearing: Some(CatalogueBearing::parse("6205").expect("known")),
        ..Machine::default()
    };
    let of = |height: f64| Analysis::of(&impacts(height), 12_800.0, &machine).expect("a signal");
    let baseline = report::Baseline { name: "sound.mat".to_owned(), analysis: of(0.0) };
    report::write_measured(folder.path(), "damaged.mat", &of(2.0), Some(&baseline)).expect("a page");
    let page = std::fs::read_to_string(folder.join("report.html")).expect("a page");
    for words in
        ["id=\"kurtogram\"", "id=\"waterfall\"", "In grey behind it: sound.mat", "new since sound.mat"]
    {
        assert!(page.contains(words), "{words}");
    }
    let Some(browser) = browser() else { return };
    draws_all(&browser, &folder);
    let hands = probed(&folder, HANDS_ON_A_SPECTRUM);
    let said = title_of(&browser, &hands, &folder.join("profile"), false);
    assert_eq!(said, "failed= errors=");
    // On a phone nothing stands out beyond the screen, wide tables move by themselves.
    let phone = probed(&folder, HANDS_ON_A_PHONE);
    let said = title_in(&browser, &phone, &folder.join("profile"), false, "390,844");
    assert_eq!(said, "failed= errors=");
}

/// The verdict for whoever decides: a defect, a healthy bearing, one that cannot be told, and a series.
#[test]
fn behaves_the_verdict_is_one_sheet_of_paper() {
    /// Longer than a line of the sheet.
    const FILE: &str = "a record of the third pump in hall seven, drive end, taken before the stop of the spring, \
                        second copy.mat";
    let machine = Machine {
        speed_rpm: Some(1200.0),
        bearing: Some(CatalogueBearing::parse("6205").expect("known")),
        ..Machine::default()
    };
    let of =
        |samples: &Channel, machine: &Machine| Analysis::of(samples, 12_800.0, machine).expect("a signal");
    let damaged = of(&impacts(2.0), &machine);
    let (open, healthy) = (of(&impacts(0.0), &machine), of(&impacts_and_shaft(0.0, 2.0), &machine));
    let unknown = of(&impacts(2.0), &Machine::default());
    let scratch = Scratch::create("sheet");
    let mut folders = Vec::new();
    for (analysis, headline) in [
        (&damaged, "Defect of the outer raceway"),
        (&healthy, "No defect of a raceway"),
        (&open, "Cannot tell whether the bearing is damaged"),
        (&unknown, "No verdict: speed or bearing is not known"),
    ] {
        let folder = scratch.join(headline);
        std::fs::create_dir_all(&folder).expect("room");
        report::write_brief(&folder, FILE, analysis, None).expect("a sheet");
        folders.push((folder, headline));
    }
    let records = || [&healthy, &healthy, &damaged, &damaged, &damaged].map(|of| of.findings.clone());
    let series = Series::of(&records().iter().map(Some).collect::<Vec<_>>(), 0, &[]);
    let record = |(n, findings): (usize, MeasuredFindings)| report::SeriesRecord {
        file: format!("{n} {FILE}"),
        folder: None,
        findings: Some(findings),
        error: None,
        alarms: Vec::new(),
    };
    let all =
        report::SeriesFindings { series, records: records().into_iter().enumerate().map(record).collect() };
    let folder = scratch.join("series");
    std::fs::create_dir_all(&folder).expect("room");
    report::write_series_brief(&folder, &all).expect("a sheet");
    folders.push((folder, "Defect of the outer raceway"));
    for (folder, headline) in &folders {
        let page = std::fs::read_to_string(folder.join(report::SHEET)).expect("a sheet");
        for words in [headline, "How sure", "Not seen", "Next", "Program", "<svg"] {
            assert!(page.contains(words), "{words}: {}", folder.display());
        }
        assert_eq!(page.contains("How long"), headline.starts_with("Defect"), "{}", folder.display());
    }
    let Some(browser) = browser() else { return };
    for (folder, headline) in folders {
        let page = std::fs::read_to_string(folder.join(report::SHEET)).expect("a sheet");
        let probed = folder.join("probed.html");
        std::fs::write(&probed, page.replacen("</body>", &format!("{FITS}</body>"), 1)).expect("room");
        assert_eq!(title_of(&browser, &probed, &folder.join("profile"), false), "fits", "{headline}");
        let pdf = folder.join("sheet.pdf");
        let printed = Command::new(&browser)
            .args([
                "--headless",
                "--no-sandbox",
                "--disable-gpu",
                "--disable-dev-shm-usage",
                "--no-pdf-header-footer",
            ])
            .arg(format!("--user-data-dir={}", folder.join("profile").display()))
            .arg(format!("--print-to-pdf={}", pdf.display()))
            .arg(format!("file://{}", folder.join(report::SHEET).display()))
            .output();
        printed.expect("an installed browser starts");
        let bytes = std::fs::read(&pdf).expect("a file that was printed");
        let pages = String::from_utf8_lossy(&bytes).matches("/Type /Page\n").count();
        assert_eq!(pages, 1, "{headline}");
    }
}

/// Whether nothing on a sheet is cut off, and its picture is tall enough to be read [px].
const FITS: &str = r##"<script>
addEventListener("load", () => {
  const sheet = document.body, picture = document.querySelector("svg").getBoundingClientRect().height;
  const fits = sheet.scrollHeight <= sheet.clientHeight && picture > 150;
  document.title = "PROBE " + (fits ? "fits" : `${sheet.scrollHeight} in ${sheet.clientHeight}, picture ${picture}`) + " END";
});
</script>"##;

/// Buttons, keys and clicks on the page of a run: the bearing plays, goes by frames, follows a click on a
/// trace; tabs, the whole band and files of figures.
#[test]
fn behaves_buttons_keys_and_clicks_move_the_page_of_a_run() {
    let Some(browser) = browser() else { return };
    let folder = Scratch::new("browser-hands");
    synthetic::write(folder.path(), Status::Complete, 3000);
    report::write(folder.path()).expect("a report");
    let probed = probed(&folder, HANDS_ON_A_RUN);
    let said = title_of(&browser, &probed, &folder.join("profile"), false);
    assert_eq!(said, "failed= errors=");
}

/// What both pairs of hands need: a place for what failed, clicks and keys.
const HANDS: &str = r##"<script>
const failed = [];
const check = (what, holds) => { if (!holds) failed.push(what); };
const key = (on, name, more = {}) => on.dispatchEvent(new KeyboardEvent("keydown", { key: name, bubbles: true, cancelable: true, ...more }));
const clickAt = (over, part, more = {}) => {
  const box = over.getBoundingClientRect(), at = { clientX: box.left + part * box.width, clientY: box.top + 0.5 * box.height, bubbles: true, ...more };
  // All that a mouse does: uPlot takes a click without the rest for the end of a drag.
  over.dispatchEvent(new MouseEvent("mousemove", at));
  over.dispatchEvent(new PointerEvent("pointerdown", at));
  for (const name of ["mousedown", "mouseup", "click"]) over.dispatchEvent(new MouseEvent(name, at));
};
const saved = [];
HTMLAnchorElement.prototype.click = function () { saved.push(this.download); };
addEventListener("load", () => setTimeout(() => {
  try { hands(); } catch (why) { failed.push(String(why)); }
  document.title = "PROBE failed=" + failed.join(";") + " errors=" + window.seenErrors.join(";") + " END";
}, 500));
</script>"##;

const HANDS_ON_A_RUN: &str = r##"<script>
const hands = () => {
  const bearing = document.querySelector("figure.moving-bearing");
  const play = bearing.querySelector(".play"), scrubber = bearing.querySelector("input[type=range]"), said = bearing.querySelector("output");
  play.click(); check("plays", play.textContent.includes("Stop"));
  play.click(); check("stops", play.textContent.includes("Play"));
  key(bearing, "Home"); check("home", scrubber.value === "0");
  key(bearing, "ArrowRight"); check("right", scrubber.value === "1");
  key(bearing, "ArrowRight", { shiftKey: true }); check("right by ten", scrubber.value === "11");
  key(bearing, "ArrowLeft"); check("left", scrubber.value === "10");
  key(bearing, "End"); check("end", scrubber.value === scrubber.max);
  key(bearing, " "); check("space plays", play.textContent.includes("Stop"));
  key(bearing, " ");
  scrubber.value = "5"; scrubber.dispatchEvent(new Event("input")); check("scrubs", said.textContent.includes("ms"));
  const before = said.textContent;
  clickAt(bearing.querySelector("canvas.strips"), 0.75); check("strip", said.textContent !== before);
  // A click on a trace goes to that time, and the bearing shows its time on every trace.
  const trace = document.querySelector("#acceleration .u-over") || document.querySelector("figure.plot .playhead").parentElement;
  clickAt(trace, 0.25); const quarter = parseFloat(said.textContent);
  clickAt(trace, 0.5); const half = parseFloat(said.textContent);
  check(`click-to-time ${quarter} ${half}`, half > 1.5 * quarter && quarter > 0);
  check("playhead", [...document.querySelectorAll(".playhead")].some((line) => line.style.display === "block"));
  const tabs = document.querySelector(".tabs.live"), [one, two] = tabs.querySelectorAll('[role="tab"]');
  two.click(); check("second tab", two.getAttribute("aria-selected") === "true" && tabs.querySelectorAll(".panel")[1].classList.contains("on"));
  key(two, "ArrowLeft"); check("back by key", one.getAttribute("aria-selected") === "true");
  const wide = document.querySelector("button.wide");
  wide.click(); check("whole band", wide.textContent.startsWith("Only")); wide.click();
  document.querySelectorAll("figure .save button").forEach((button) => { if (button.textContent === "SVG" || button.textContent === "PNG") button.click(); });
  check("saves SVG", saved.some((name) => name.endsWith(".svg")));
  const spectrum = document.querySelector("#spectrum");
  const [harmonics] = spectrum.querySelectorAll(".cursors button");
  harmonics.click(); check("harmonics of a run", spectrum.querySelector(".cursors output").textContent.includes("×"));
};
</script>"##;

const HANDS_ON_A_SPECTRUM: &str = r##"<script>
const hands = () => {
  const figure = [...document.querySelectorAll("figure.plot")].find((one) => one.id.startsWith("envelope"));
  const [harmonics, sidebands] = figure.querySelectorAll(".cursors button");
  const said = figure.querySelector(".cursors output"), [carrier, base] = figure.querySelectorAll(".cursors input");
  const over = figure.querySelector(".u-over"), holder = figure.querySelector(".chart");
  check("off at first", said.hidden && base.closest("label").hidden);
  harmonics.click();
  check("pressed", harmonics.getAttribute("aria-pressed") === "true" && said.textContent.startsWith("1× "));
  const known = figure.querySelector(".cursors select");
  known.value = known.options[1].value; known.dispatchEvent(new Event("change"));
  check("known " + base.value, Math.abs(base.value - 71.7) < 1);
  const before = Number(base.value);
  key(holder, "ArrowRight"); check("finer by key", Number(base.value) > before && Number(base.value) < before + 1);
  base.value = "20"; base.dispatchEvent(new Event("input")); check("by hand", said.textContent.includes("1× 20 Hz"));
  // A click takes the line that is there: 71.7 Hz lies at a fifth of 5.6 times itself.
  clickAt(over, 1 / 5.6); check("clicked " + base.value, Math.abs(base.value - 71.7) < 1.5);
  clickAt(over, 3 / 5.6, { shiftKey: true }); check("third by Shift " + base.value, Math.abs(base.value - 71.7) < 0.5);
  sidebands.click();
  clickAt(over, 2 / 5.6); check("carrier " + carrier.value, Math.abs(carrier.value - 143.4) < 2);
  check("sidebands", said.textContent.includes("carrier") && said.textContent.includes("+1"));
  sidebands.click(); check("off again", said.hidden);
};
</script>"##;

const HANDS_ON_A_PHONE: &str = r##"<script>
const hands = () => {
  check(`a phone, ${innerWidth} wide`, innerWidth <= 520);
  const wide = document.scrollingElement.scrollWidth;
  check(`page of ${wide} in ${innerWidth}`, wide <= innerWidth);
};
</script>"##;

/// The report in `folder` with scripts that watch it and do what hands would.
fn probed(folder: &Scratch, hands: &str) -> PathBuf {
    let page = std::fs::read_to_string(folder.join("report.html")).expect("a page");
    let watched = page.replacen("<head>", &format!("<head>{WATCH}"), 1).replacen(
        "</body>",
        &format!("{hands}{}</body>", if hands == PROBE { "" } else { HANDS }),
        1,
    );
    assert_ne!(watched.len(), page.len());
    // Snap's Chromium sees no hidden folders and no /tmp of ours; the folder of the run is as good as any.
    let probed = folder.join("probed.html");
    std::fs::write(&probed, watched).expect("a writable folder");
    probed
}

/// Opens the report in `folder`, by day and by night.
fn draws_all(browser: &Path, folder: &Scratch) {
    let page = std::fs::read_to_string(folder.join("report.html")).expect("a page");
    let figures = page.matches("<figure id=").count();
    let probed = probed(folder, PROBE);
    for dark in [false, true] {
        let said = title_of(browser, &probed, &folder.join("profile"), dark);
        assert_eq!(said, format!("figures={figures} undrawn= errors="), "dark: {dark}");
    }
}
