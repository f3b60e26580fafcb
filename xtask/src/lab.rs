//! The module of the lab: `crates/apps/lab`, compiled for `wasm32-unknown-unknown`.

use std::path::PathBuf;
use std::process::{Command, ExitCode};

use anyhow::{Context, Result, ensure};
use stribeck::lab::MODULE;

use crate::workspace;

/// Its target.
const TARGET: &str = "wasm32-unknown-unknown";

/// Where a build of `crates/apps/lab` finds it, below the root.
const EMBEDDED: &str = "crates/apps/lab/assets/module";

/// Flags of `lab-module`.
#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    /// Puts it where the next build of the program takes it along, for `cargo install` and `cargo package`
    #[arg(long)]
    embed: bool,
}

/// The command whose page opens in the browser, too: a page of the source is for whoever made it.
pub(crate) fn opened(command: stribeck::Command) -> stribeck::Command {
    match command {
        stribeck::Command::Lab(options) => stribeck::Command::Lab(options.opened()),
        other => other,
    }
}

/// The command of the program, with a module that is built before it where it makes a lab.
pub(crate) fn with_module(command: stribeck::Command) -> Result<stribeck::Command> {
    Ok(match command {
        stribeck::Command::Lab(options) => stribeck::Command::Lab(options.with_module(build()?)),
        stribeck::Command::Report(options) if options.makes_lab() => {
            stribeck::Command::Report(options.with_module(build()?))
        }
        other => other,
    })
}

pub(crate) fn build_module(options: &Options) -> Result<ExitCode> {
    let mut module = build()?;
    if options.embed {
        let folder = workspace::root().join(EMBEDDED);
        let embedded = folder.join(MODULE);
        std::fs::copy(&module, &embedded).with_context(|| format!("cannot write to {}", folder.display()))?;
        module = embedded;
    }
    let bytes = std::fs::metadata(&module).map_or(0, |file| file.len());
    println!("{} ({:.2} MB)", module.display(), 1e-6 * bytes as f64);
    Ok(ExitCode::SUCCESS)
}

/// Has rustup add the target, which takes no network where it is there; without rustup cargo says what it lacks.
fn add_target(root: &std::path::Path) {
    let words = ["--quiet", "target", "add", TARGET];
    // No answer counts: a compiler of a distribution may have the target without it.
    drop(Command::new("rustup").current_dir(root).args(words).status());
}

/// The module, built where a build finds the same name again.
pub(crate) fn build() -> Result<PathBuf> {
    let root = workspace::root();
    add_target(&root);
    // A folder of its own: cargo would wait for the one that runs this command.
    let folder = workspace::target().join("lab");
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo
        .current_dir(&root)
        .args([
            "rustc",
            "--quiet",
            "--profile",
            "dist",
            "-p",
            "stribeck-lab",
            "--lib",
            "--crate-type",
            "cdylib",
        ])
        .args(["--target", TARGET, "--target-dir"])
        .arg(&folder)
        .env("CARGO_ENCODED_RUSTFLAGS", workspace::flags_without_paths(&["-Ctarget-feature=+simd128"]));
    let done = cargo.status().context("cannot start cargo")?;
    ensure!(
        done.success(),
        "the module of the lab cannot be built. Its target comes by `rustup target add {TARGET}`, or on \
         Debian with `apt-get install rustc-web lld`"
    );
    let built = folder.join(TARGET).join("dist").join(MODULE);
    let module = root.join("target").join("lab").join(MODULE);
    let place = module.parent().unwrap_or(&root);
    std::fs::create_dir_all(place).with_context(|| format!("cannot make {}", place.display()))?;
    std::fs::copy(&built, &module).with_context(|| format!("cannot read {}", built.display()))?;
    Ok(module)
}
