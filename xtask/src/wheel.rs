//! The wheel of the Python module, which needs no Rust where it is installed.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

use anyhow::{Context, Result, bail, ensure};

use crate::workspace;

/// Flags of `wheel`.
#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    /// Folder for the wheel
    #[arg(long, value_name = "DIR", default_value = "target/wheels")]
    out: PathBuf,
    /// Python that has maturin, and ziglang for a wheel of other machines
    #[arg(long, default_value = "python3")]
    python: String,
}

/// Largest size of a wheel [bytes]. That of `.ci/run`, which shares its libraries with the tests, is larger.
const LARGEST: u64 = 14_000_000;

/// Oldest system that a wheel made with zig runs on: glibc 2.17.
const POLICY: &str = "manylinux2014";

/// What Python looks up in the module on Windows, and what maturin has the linker export instead of it: the module's
/// whole name.
const WINDOWS_EXPORTS: &str = r#".globl "PyInit_stribeck._stribeck"
"PyInit_stribeck._stribeck":
    jmp PyInit__stribeck
.section .drectve,"yni"
.ascii " -export:PyInit__stribeck"
"#;

/// Builds the wheel of this machine and says where it is.
pub(crate) fn build(options: &Options) -> Result<ExitCode> {
    let wheel = make(&workspace::root().join(&options.out), &options.python, None, &[])?;
    let bytes = std::fs::metadata(&wheel).map_or(0, |file| file.len());
    println!("{} ({:.2} MB)", wheel.display(), 1e-6 * bytes as f64);
    Ok(ExitCode::SUCCESS)
}

/// Builds a wheel, with zig for old systems where it is there and else by the policy of this machine.
pub(crate) fn make(
    out: &Path,
    python: &str,
    target: Option<&str>,
    environment: &[(String, OsString)],
) -> Result<PathBuf> {
    ensure!(
        has(python, "maturin"),
        "`{python}` has no maturin: `pip install maturin ziglang`, and name its Python with `--python`"
    );
    let mut maturin = Command::new(python);
    maturin.current_dir(workspace::root()).args(["-m", "maturin", "build", "--quiet", "--profile", "dist"]);
    maturin.args(["--compression-level", "9", "--out"]).arg(out).envs(environment.iter().cloned());
    maturin.args(target.into_iter().flat_map(|target| ["--target", target]));
    if has(python, "ziglang") {
        maturin.arg("--zig");
        if target.is_none_or(|target| target.contains("linux")) {
            maturin.args(["--compatibility", POLICY]);
        }
        // Its zig is a module of that Python, which need not be the one in the path.
        maturin.env("CARGO_ZIGBUILD_PYTHON_PATH", python);
    } else {
        println!("no ziglang: the wheel runs on systems as new as this one");
    }
    if target.is_some_and(|target| target.contains("windows")) {
        let exports = workspace::target().join("windows_exports.s");
        std::fs::write(&exports, WINDOWS_EXPORTS)
            .with_context(|| format!("cannot write `{}`", exports.display()))?;
        maturin.args(["--", "-C", &format!("link-arg={}", exports.display())]);
    }
    let done = maturin.status().context("cannot start maturin")?;
    ensure!(done.success(), "maturin could not build the wheel; see its output above");
    let Some(wheel) = newest(out)? else { bail!("maturin left no wheel in `{}`", out.display()) };
    let bytes = std::fs::metadata(&wheel).map_or(0, |file| file.len());
    ensure!(bytes <= LARGEST, "the wheel has {bytes} bytes; {LARGEST} are allowed");
    Ok(wheel)
}

/// Whether a Python has a module.
fn has(python: &str, module: &str) -> bool {
    let found = Command::new(python).args(["-c", &format!("import {module}")]).output();
    found.is_ok_and(|output| output.status.success())
}

/// The wheel that was written last.
fn newest(folder: &Path) -> Result<Option<PathBuf>> {
    let entries = std::fs::read_dir(folder).with_context(|| format!("cannot read `{}`", folder.display()))?;
    let wheels =
        entries.flatten().map(|entry| entry.path()).filter(|p| p.extension().is_some_and(|e| e == "whl"));
    let at = |path: &PathBuf| std::fs::metadata(path).and_then(|file| file.modified()).ok();
    Ok(wheels.max_by_key(at))
}
