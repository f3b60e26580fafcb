//! `stribeck fmu`: the reduced bearing of a scene for rotor programs, as an FMU for co-simulation by FMI 3.0.

mod description;

use std::borrow::Cow;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result, ensure};
use stribeck_reduced::shaft::{BearingOnShaft, OnShaft, ShaftPoint, variables::RESOURCE};
use stribeck_scene::scene::{ModelScene, Scene};
use stribeck_simulation::reduced::on_shaft;
use stribeck_simulation::reduction::dense;
use zip::{CompressionMethod, ZipWriter, write::SimpleFileOptions};

use crate::out::say;
use crate::place::{Place, shown};

/// Flags of `fmu`.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// Scene file, of the reduced model
    scene: PathBuf,
    /// Overrides a field of the scene, for example --set 'housing=rigid(mass_kg: 5)'; may be repeated
    #[arg(long = "set", value_name = "FIELD=VALUE")]
    overrides: Vec<String>,
    /// The FMU [default: NAME.fmu in the working folder]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// The shared library that FMI calls, built by `cargo xtask fmu` [default: the one that the program was
    /// built with, or that lies beside it]
    #[arg(long, value_name = "FILE")]
    library: Option<PathBuf>,
}

impl Options {
    /// With a library that was just built, unless the user named one.
    pub fn with_library(mut self, library: PathBuf) -> Self {
        self.library.get_or_insert(library);
        self
    }
}

/// Name of the shared library, which FMI asks for as the identifier of the model.
const IDENTIFIER: &str = "stribeck_fmu";

/// Folder of the library for this machine, as FMI 3.0 names it.
const PLATFORM: &str = if cfg!(windows) {
    "x86_64-windows"
} else if cfg!(target_os = "macos") {
    if cfg!(target_arch = "aarch64") { "aarch64-darwin" } else { "x86_64-darwin" }
} else if cfg!(target_arch = "aarch64") {
    "aarch64-linux"
} else {
    "x86_64-linux"
};

/// Communication steps of the trial, and their length [s].
const TRIAL: (usize, f64) = (100, 20e-6);

pub(crate) fn run(options: &Options, place: &Place) -> Result<ExitCode> {
    let library = library(options.library.as_deref())?;
    let scene = place.scene(Some(&options.scene), &options.overrides)?;
    ensure!(
        scene.model != ModelScene::Full,
        "`model` is full, and an FMU holds the reduced bearing: take --set 'model=reduced()'"
    );
    let out = options.out.clone().unwrap_or_else(|| PathBuf::from(format!("{}.fmu", scene.name)));
    let folder = out.parent().filter(|folder| !folder.as_os_str().is_empty());
    if let Some(folder) = folder {
        ensure!(folder.is_dir(), "there is no folder `{}` for the FMU", shown(folder));
    }
    let bearing = on_shaft(&scene.resolve(), Some(&place.runs()))?;
    try_it(&bearing)?;
    let bytes = archive(&scene, &bearing, &library)?;
    std::fs::write(&out, &bytes).with_context(|| format!("cannot write `{}`", shown(&out)))?;
    say!(
        "{} ({:.2} MB, {PLATFORM}): communication steps from {:.2} µs on",
        shown(&out),
        1e-6 * bytes.len() as f64,
        2e6 * bearing.time_step
    );
    Ok(ExitCode::SUCCESS)
}

/// Runs the bearing for a moment on a shaft in the middle, to refuse here what would go wrong there.
fn try_it(bearing: &OnShaft) -> Result<()> {
    let mut motion = BearingOnShaft::start(bearing.clone(), ShaftPoint::default(), &dense::solve)?;
    let (steps, length) = TRIAL;
    for _ in 0..steps {
        motion.advance(length.max(2.0 * bearing.time_step), ShaftPoint::default())?;
    }
    Ok(())
}

/// The library that this program was built with, if it was (`build.rs`).
fn embedded() -> Option<&'static [u8]> {
    #[cfg(fmu_embedded)]
    return Some(include_bytes!(env!("STRIBECK_FMU_EMBEDDED")));
    #[cfg(not(fmu_embedded))]
    None
}

/// The library: the one that was named, the one that the program carries, or one beside it.
fn library(named: Option<&Path>) -> Result<Cow<'static, [u8]>> {
    if let (None, Some(library)) = (named, embedded()) {
        return Ok(Cow::Borrowed(library));
    }
    let file = format!("{}{IDENTIFIER}{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    let beside = || std::env::current_exe().ok().map(|program| program.with_file_name(&file));
    let found = named.map(Path::to_owned).or_else(|| beside().filter(|file| file.is_file()));
    let found = found.with_context(|| {
        format!(
            "this program was built without {file}, which rotor programs call. In the repository of Stribeck \
             `cargo xtask fmu` builds it and makes the FMU. Elsewhere put the file beside the program, or name \
             it with --library"
        )
    })?;
    let bytes = std::fs::read(&found).with_context(|| format!("cannot read `{}`", shown(&found)))?;
    Ok(Cow::Owned(bytes))
}

/// The archive: description, library, bearing and scene.
fn archive(scene: &Scene, bearing: &OnShaft, library: &[u8]) -> Result<Vec<u8>> {
    let binary = format!("binaries/{PLATFORM}/{IDENTIFIER}{}", std::env::consts::DLL_SUFFIX);
    let resource = format!("resources/{RESOURCE}");
    let files = [
        ("modelDescription.xml", description::xml(scene, bearing).into_bytes().into()),
        (binary.as_str(), Cow::Borrowed(library)),
        (resource.as_str(), postcard::to_stdvec(bearing)?.into()),
        ("resources/scene.ron", scene.to_ron().into_bytes().into()),
    ];
    let mut zip = ZipWriter::new(std::io::Cursor::new(Vec::new()));
    // Equal scenes give equal bytes: no time of the day.
    let plain = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .last_modified_time(zip::DateTime::default());
    for (name, bytes) in files {
        zip.start_file(name, plain)?;
        zip.write_all(&bytes)?;
    }
    Ok(zip.finish()?.into_inner())
}
