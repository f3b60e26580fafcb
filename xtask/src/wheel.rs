//! The wheel of the Python module, which needs no Rust where it is installed.

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
const LARGEST: u64 = 10 << 20;

/// Oldest system that a wheel made with zig runs on: glibc 2.17.
const POLICY: &str = "manylinux2014";

/// Builds the wheel, with zig for old systems where it is there and else by the policy of this machine, and
/// says where it is.
pub(crate) fn build(options: &Options) -> Result<ExitCode> {
    let root = workspace::root();
    let out = root.join(&options.out);
    ensure!(
        has(&options.python, "maturin"),
        "`{}` has no maturin: `pip install maturin ziglang`, and name its Python with `--python`",
        options.python
    );
    let zig = has(&options.python, "ziglang");
    let mut maturin = Command::new(&options.python);
    maturin.current_dir(&root).args(["-m", "maturin", "build", "--profile", "dist"]);
    maturin.args(["--compression-level", "9", "--out"]).arg(&out);
    if zig {
        maturin.args(["--zig", "--compatibility", POLICY]);
        // Its zig is a module of that Python, which need not be the one in the path.
        maturin.env("CARGO_ZIGBUILD_PYTHON_PATH", &options.python);
    } else {
        println!("no ziglang: the wheel runs on systems as new as this one");
    }
    let done = maturin.status().context("cannot start maturin")?;
    ensure!(done.success(), "maturin could not build the wheel; see its output above");
    let Some(wheel) = newest(&out)? else { bail!("maturin left no wheel in `{}`", out.display()) };
    let bytes = std::fs::metadata(&wheel).map_or(0, |file| file.len());
    println!("{} ({:.2} MB)", wheel.display(), 1e-6 * bytes as f64);
    ensure!(bytes <= LARGEST, "the wheel has {bytes} bytes; {LARGEST} are allowed");
    Ok(ExitCode::SUCCESS)
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
