//! The program and the library of FMUs, compiled for one platform.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Result, bail, ensure};

use super::{output, set_executable};
use crate::{fmu, workspace};

/// Variables of a build.
pub(super) type Environment = Vec<(String, OsString)>;

/// Oldest C library on which programs for Linux run: that of RHEL 7, as of wheels for manylinux2014.
const GLIBC: &str = "2.17";

pub(super) struct Platform<'a> {
    /// Its name in Rust.
    pub(super) target: &'a str,
    /// File name of the program there, and of the library.
    pub(super) program: &'static str,
    library: &'static str,
    /// Name of a build with zig: with the C library's version.
    zig: String,
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

    /// Variables of each build: compilers and linker of this platform, and no path of this machine in the result.
    /// Programs and wheels that are built with the same ones share what they are made of.
    pub(super) fn environment(&self, python: &str, epoch: &str) -> Result<Environment> {
        let mut build = self.zig(python)?;
        let ours: [(&str, OsString); 3] = [
            ("CARGO_ENCODED_RUSTFLAGS", workspace::flags_without_paths(&[]).into()),
            ("CARGO_INCREMENTAL", "0".into()),
            ("SOURCE_DATE_EPOCH", epoch.into()),
        ];
        build.extend(ours.map(|(name, value)| (name.to_owned(), value)));
        Ok(build)
    }

    /// Builds the program. The wheel's package is named beside it, so that both have the same features.
    pub(super) fn program(&self, build: &Environment) -> Result<PathBuf> {
        let words = ["--profile", "dist", "-p", "stribeck", "-p", "stribeck-python", "--bin", "stribeck"];
        self.build(&words, build)?;
        Ok(workspace::target().join(self.target).join("dist").join(self.program))
    }

    /// Builds the library of FMUs.
    pub(super) fn library(&self, build: &Environment) -> Result<PathBuf> {
        self.build(&["--release", "--lib", "--manifest-path", fmu::MANIFEST], build)?;
        Ok(workspace::target().join(self.target).join("release").join(self.library))
    }

    fn build(&self, words: &[&str], build: &Environment) -> Result<()> {
        let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
        cargo.current_dir(workspace::root()).args(["build", "--quiet", "--target", self.target]).args(words);
        cargo.arg("--target-dir").arg(workspace::target()).envs(build.iter().cloned());
        ensure!(cargo.status()?.success(), "cargo build failed; see its output above");
        Ok(())
    }

    /// The variables with which `cargo zigbuild`, a package of Python, calls cargo: a program of that name lists
    /// them.
    fn zig(&self, python: &str) -> Result<Environment> {
        const ADVICE: &str =
            "name a Python with --python, and `pip install maturin ziglang cargo-zigbuild` in it";
        let added = Command::new("rustup").args(["target", "add", self.target]).output();
        let added = added.is_ok_and(|done| done.status.success());
        ensure!(added, "`rustup target add {}` does not work here", self.target);
        let scripts = "import sysconfig; print(sysconfig.get_path('scripts'))";
        let scripts = output(Command::new(python).args(["-c", scripts]), ADVICE)?;
        let stage = workspace::target().join("release-zig");
        std::fs::create_dir_all(&stage)?;
        std::fs::write(stage.join("cargo"), "#!/bin/sh\nexec env -0\n")?;
        set_executable(&stage.join("cargo"))?;
        let before = std::env::var_os("PATH").unwrap_or_default();
        let path = std::env::join_paths([stage].into_iter().chain(std::env::split_paths(&before)))?;
        let mut zigbuild = Command::new(Path::new(scripts.trim()).join("cargo-zigbuild"));
        zigbuild.args(["zigbuild", "--target", &self.zig]).env_remove("CARGO").env("PATH", path);
        let listed = output(zigbuild.env("CARGO_ZIGBUILD_PYTHON_PATH", python), ADVICE)?;
        let listed = listed.split('\0').filter_map(|line| line.split_once('='));
        let is_new = |(name, value): &(&str, &str)| {
            *name != "PATH" && std::env::var_os(name).is_none_or(|before| before != *value)
        };
        Ok(listed.filter(is_new).map(|(name, value)| (name.to_owned(), value.into())).collect())
    }
}
