//! An FMU of the reduced bearing of a scene: FMI 3.0, co-simulation, the shaft's motion in, forces out.

mod description;

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

use anyhow::{Context, Result, ensure};
use stribeck::Place;
use stribeck_reduced::shaft::{BearingOnShaft, OnShaft, ShaftPoint, variables::RESOURCE};
use stribeck_scene::scene::{ModelScene, Scene};
use stribeck_simulation::reduced::on_shaft;
use stribeck_simulation::reduction::dense;
use zip::{CompressionMethod, ZipWriter, write::SimpleFileOptions};

use crate::workspace;

/// Flags of `fmu`.
#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    /// Scene file, of the reduced model
    scene: PathBuf,
    /// Overrides a field of the scene, for example --set 'housing=rigid(mass_kg: 5)'; may be repeated
    #[arg(long = "set", value_name = "FIELD=VALUE")]
    overrides: Vec<String>,
    /// The FMU [default: NAME.fmu in the working folder]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

/// Manifest of the shared library, and its name, which FMI asks for as the identifier of the model.
const MANIFEST: &str = "crates/fmu/Cargo.toml";
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

/// Builds the FMU of a scene and says where it is.
pub(crate) fn build(options: &Options) -> Result<ExitCode> {
    let place = Place::repository("cargo xtask", workspace::root());
    let scene = place.scene(Some(&options.scene), &options.overrides)?;
    ensure!(
        scene.model != ModelScene::Full,
        "`model` is full, and an FMU holds the reduced bearing: take --set 'model=reduced()'"
    );
    let out = options.out.clone().unwrap_or_else(|| PathBuf::from(format!("{}.fmu", scene.name)));
    let folder = out.parent().filter(|folder| !folder.as_os_str().is_empty());
    if let Some(folder) = folder {
        ensure!(folder.is_dir(), "there is no folder `{}` for the FMU", folder.display());
    }
    println!("modes of {} …", scene.name);
    let bearing = on_shaft(&scene.resolve(), Some(&place.runs()))?;
    try_it(&bearing)?;
    println!("library for {PLATFORM} …");
    let library = library()?;
    let bytes = archive(&scene, &bearing, &library)?;
    std::fs::write(&out, &bytes).with_context(|| format!("cannot write `{}`", out.display()))?;
    println!(
        "{} ({:.2} MB): communication steps from {:.2} µs on",
        out.display(),
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

/// The shared library, built beside the program.
fn library() -> Result<PathBuf> {
    let root = workspace::root();
    let folder = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), PathBuf::from);
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.current_dir(&root).args(["build", "--quiet", "--release", "--lib", "--manifest-path", MANIFEST]);
    let done = cargo.arg("--target-dir").arg(&folder).status().context("cannot start cargo")?;
    ensure!(
        done.success(),
        "the library of the FMU cannot be built. Its bindings to FMI are made with libclang: `apt-get \
         install libclang-dev` on Debian"
    );
    let name = format!("{}{IDENTIFIER}{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    Ok(folder.join("release").join(name))
}

/// The archive: description, library, bearing and scene.
fn archive(scene: &Scene, bearing: &OnShaft, library: &Path) -> Result<Vec<u8>> {
    let library = std::fs::read(library).with_context(|| format!("cannot read `{}`", library.display()))?;
    let binary = format!("binaries/{PLATFORM}/{IDENTIFIER}{}", std::env::consts::DLL_SUFFIX);
    let resource = format!("resources/{RESOURCE}");
    let files = [
        ("modelDescription.xml", description::xml(scene, bearing).into_bytes()),
        (binary.as_str(), library),
        (resource.as_str(), postcard::to_stdvec(bearing)?),
        ("resources/scene.ron", scene.to_ron().into_bytes()),
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
