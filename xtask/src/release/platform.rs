//! The program and the library of FMUs, compiled for one platform.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Result, bail, ensure};

use super::output;
use crate::{fmu, workspace};

/// Variables of a build.
pub(super) type Environment = Vec<(&'static str, OsString)>;

/// Oldest C library on which programs for Linux run: that of RHEL 7, as of wheels for manylinux2014.
const GLIBC: &str = "2.17";

/// A platform.
pub(super) struct Platform<'a> {
    /// Its name in Rust.
    pub(super) target: &'a str,
    /// File name of the program there, and of the library.
    pub(super) program: &'static str,
    library: &'static str,
    /// Name of a build with zig: with the C library's version.
    zig: String,
    /// Whether it has a wheel.
    pub(super) wheel: bool,
}

impl<'a> Platform<'a> {
    pub(super) fn new(target: &'a str) -> Result<Self> {
        let of = |program, library, zig, wheel| Self { target, program, library, zig, wheel };
        Ok(match target.split('-').nth(2) {
            Some("linux") if target.ends_with("gnu") => {
                of("stribeck", "libstribeck_fmu.so", format!("{target}.{GLIBC}"), true)
            }
            Some("linux") => of("stribeck", "libstribeck_fmu.so", target.to_owned(), false),
            Some("darwin") => of("stribeck", "libstribeck_fmu.dylib", target.to_owned(), false),
            Some("windows") => of("stribeck.exe", "stribeck_fmu.dll", target.to_owned(), true),
            _ => bail!(
                "--target {target}: must be one of Linux, Windows or macOS, as x86_64-unknown-linux-gnu"
            ),
        })
    }

    /// What keeps paths of this machine out of a build.
    pub(super) fn environment(&self, epoch: &str) -> Environment {
        vec![
            ("CARGO_ENCODED_RUSTFLAGS", workspace::flags_without_paths(&[]).into()),
            ("CARGO_INCREMENTAL", "0".into()),
            ("SOURCE_DATE_EPOCH", epoch.into()),
        ]
    }

    /// Builds the program with its variables.
    pub(super) fn program(&self, python: &str, build: &Environment) -> Result<PathBuf> {
        self.build(python, &["--profile", "dist", "-p", "stribeck", "--bin", "stribeck"], build)?;
        Ok(workspace::target().join(self.target).join("dist").join(self.program))
    }

    /// Builds the library of FMUs.
    pub(super) fn library(&self, python: &str) -> Result<PathBuf> {
        let build = self.environment("0");
        self.build(python, &["--release", "--lib", "--manifest-path", fmu::MANIFEST], &build)?;
        Ok(workspace::target().join(self.target).join("release").join(self.library))
    }

    /// `cargo zigbuild`, which is a package of Python.
    fn build(&self, python: &str, words: &[&str], build: &Environment) -> Result<()> {
        const ADVICE: &str =
            "name a Python with --python, and `pip install maturin ziglang cargo-zigbuild` in it";
        let scripts = "import sysconfig; print(sysconfig.get_path('scripts'))";
        let scripts = output(Command::new(python).args(["-c", scripts]), ADVICE)?;
        let zigbuild = Path::new(scripts.trim()).join("cargo-zigbuild");
        ensure!(
            zigbuild.with_extension(std::env::consts::EXE_EXTENSION).is_file(),
            "no cargo-zigbuild: {ADVICE}"
        );
        let rustup = Command::new("rustup").args(["target", "add", self.target]).output();
        ensure!(
            rustup.is_ok_and(|done| done.status.success()),
            "`rustup target add {}` does not work here",
            self.target
        );
        let mut cargo = Command::new(zigbuild);
        cargo.current_dir(workspace::root()).args(["zigbuild", "--quiet", "--target", &self.zig]).args(words);
        cargo.arg("--target-dir").arg(workspace::target()).envs(build.iter().cloned());
        cargo.env("CARGO_ZIGBUILD_PYTHON_PATH", python);
        let done = cargo.status()?;
        ensure!(done.success(), "cargo zigbuild failed; see its output above");
        Ok(())
    }
}
