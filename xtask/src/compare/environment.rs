//! The Python environment of the peers, below `target/peers`: made once, never part of the workspace.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, bail, ensure};

/// Where peers are installed and run.
#[derive(Debug)]
pub(super) struct Environment {
    /// `target/peers`.
    pub(super) folder: PathBuf,
    /// `fixtures/peers`.
    pub(super) scripts: PathBuf,
}

impl Environment {
    /// Makes the virtual environment with the given interpreter unless it is there.
    pub(super) fn prepare(root: &Path, interpreter: &str) -> Result<Self> {
        let folder = root.join("target/peers");
        let environment = Self { scripts: root.join("fixtures/peers"), folder };
        if !environment.python().exists() {
            std::fs::create_dir_all(&environment.folder)
                .with_context(|| format!("cannot make `{}`", environment.folder.display()))?;
            let venv = environment.folder.join("venv");
            let status = Command::new(interpreter).args(["-m", "venv"]).arg(&venv).status();
            let made = status.with_context(|| {
                format!("cannot start `{interpreter}`: install Python 3, or name it with --python")
            })?;
            ensure!(made.success(), "`{interpreter} -m venv` failed: install Python's venv module");
        }
        Ok(environment)
    }

    pub(super) fn python(&self) -> PathBuf {
        self.folder.join("venv/bin/python")
    }

    /// Installs packages in the versions of `requirements.txt`; quick when they are there.
    pub(super) fn install(&self, packages: &[&str]) -> Result<()> {
        let output = Command::new(self.python())
            .args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--constraint"])
            .arg(self.scripts.join("requirements.txt"))
            .args(packages)
            .output()
            .context("cannot start pip")?;
        if !output.status.success() {
            let text = String::from_utf8_lossy(&output.stderr);
            let line = text.lines().rfind(|line| line.contains("ERROR")).unwrap_or("pip failed");
            bail!("cannot be installed: {}", line.trim());
        }
        Ok(())
    }
}
