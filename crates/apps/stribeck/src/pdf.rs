//! A page as PDF, printed by the Chromium of the machine.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context, Result, bail, ensure};

/// Names under which Chromium and its kin are installed.
const NAMES: [&str; 6] =
    ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome", "microsoft-edge"];
/// Time that the page's scripts get before it is printed [ms of the browser's own clock].
const BUDGET_MS: u32 = 20_000;

/// Prints `page` as A4 beside it, `report.html` as `report.pdf`, and returns the new file.
///
/// The browser is that of `STRIBECK_BROWSER`, or the first of [`NAMES`] on the path. It runs with a profile
/// of its own, which is removed, and needs no network.
pub(crate) fn print(page: &Path) -> Result<PathBuf> {
    let browser = browser(std::env::var_os("STRIBECK_BROWSER").map(PathBuf::from), page)?;
    let page = page.canonicalize().with_context(|| format!("cannot read {}", page.display()))?;
    let pdf = page.with_extension("pdf");
    let profile = page.with_extension("browser");
    // An older file must not pass for the new one.
    if pdf.exists() {
        std::fs::remove_file(&pdf).with_context(|| format!("cannot replace {}", pdf.display()))?;
    }
    let output = Command::new(&browser)
        .args(["--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run"])
        .args(["--disable-quic", "--disable-background-networking", "--disable-component-update"])
        .args(["--disable-sync", "--no-pdf-header-footer", "--force-color-profile=srgb"])
        .arg(format!("--virtual-time-budget={BUDGET_MS}"))
        .arg(format!("--user-data-dir={}", profile.display()))
        .arg(format!("--print-to-pdf={}", pdf.display()))
        .arg(format!("file://{}", page.display()))
        .stdin(Stdio::null())
        .output();
    let _ = std::fs::remove_dir_all(&profile);
    let output = output.with_context(|| format!("cannot start the browser `{}`", browser.display()))?;
    if !pdf.is_file() {
        let said = String::from_utf8_lossy(&output.stderr);
        let last = said.lines().last().unwrap_or("it said nothing");
        bail!(
            "`{}` wrote no {}: {last}. Open the page in any browser and print it to a file instead",
            browser.display(),
            pdf.display()
        );
    }
    Ok(pdf)
}

/// The browser that somebody chose, or one on the path, to print `page`.
fn browser(chosen: Option<PathBuf>, page: &Path) -> Result<PathBuf> {
    if let Some(chosen) = chosen {
        ensure!(
            chosen.is_file(),
            "STRIBECK_BROWSER = `{}` is no file; it must be the program of Chromium, Chrome or Edge",
            chosen.display()
        );
        return Ok(chosen);
    }
    let path = std::env::var_os("PATH").unwrap_or_default();
    let found = std::env::split_paths(&path)
        .flat_map(|folder| NAMES.map(|name| folder.join(name)))
        .find(|candidate| candidate.is_file());
    found.with_context(|| {
        format!(
            "--pdf needs Chromium, Chrome or Edge to print the page, and none of {} is on the path. Install \
             one, name its program in STRIBECK_BROWSER, or open {} in any browser and print it to a file",
            NAMES.join(", "),
            page.display()
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refuses_a_browser_that_is_no_file() {
        let why =
            browser(Some("/nowhere/chromium".into()), Path::new("report.html")).unwrap_err().to_string();
        assert!(why.contains("STRIBECK_BROWSER") && why.contains("/nowhere/chromium"), "{why}");
    }
}
