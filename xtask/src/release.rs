//! The files of a release, made on this machine without an account: programs, wheels, checksums, licences,
//! installers.
//!
//! Other tools do the work: zig links for each platform, maturin packs wheels, tar and gzip archives. Equal
//! sources give equal bytes: files have the time of the last commit, and no path of this machine; a checkout
//! with changes, of which programs would say so, is refused.

mod archive;
mod dependencies;
mod papers;
mod platform;

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::time::Instant;

use anyhow::{Context, Result, bail, ensure};

use crate::{lab, wheel, workspace};
use platform::Platform;

/// Version of all crates, and of the release.
const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Flags of `release`.
#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    /// Folder for the release [default: target/release-VERSION]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Platform, by the name that Rust has for it; may be repeated [default: Linux on x86-64 and ARM, Windows]
    #[arg(long = "target", value_name = "TARGET")]
    targets: Vec<String>,
    /// Python that has maturin, ziglang and cargo-zigbuild
    #[arg(long, default_value = "python3")]
    python: String,
    /// Leaves out the wheels
    #[arg(long)]
    no_wheels: bool,
}

/// Platforms without `--target`.
const TARGETS: [&str; 3] = ["x86_64-unknown-linux-gnu", "aarch64-unknown-linux-gnu", "x86_64-pc-windows-gnu"];

/// What is made, and what is not, with the reason.
struct Release {
    folder: PathBuf,
    python: String,
    wheels: bool,
    left_out: Vec<String>,
    start: Instant,
}

impl Release {
    /// The result of a part. One that fails is left out, so that the rest is made all the same.
    fn part<T>(&mut self, name: &str, made: Result<T>) -> Option<T> {
        let seconds = self.start.elapsed().as_secs();
        match made {
            Ok(made) => {
                println!("{seconds:5} s  {name}");
                Some(made)
            }
            Err(why) => {
                println!("{seconds:5} s  {name}: LEFT OUT");
                self.left_out.push(format!("{name}: {why:#}"));
                None
            }
        }
    }
}

/// Makes the release and says what is in it.
pub(crate) fn run(options: &Options) -> Result<ExitCode> {
    let root = workspace::root();
    let folder = options.out.clone().unwrap_or_else(|| root.join(format!("target/release-{VERSION}")));
    let empty = !folder.exists() || std::fs::read_dir(&folder)?.next().is_none();
    ensure!(empty, "`{}` has files: name an empty folder with --out, or remove them", folder.display());
    std::fs::create_dir_all(&folder).with_context(|| format!("cannot make `{}`", folder.display()))?;
    let folder = folder.canonicalize()?;
    // Tools that pack files read it.
    let epoch = epoch(&root)?;
    let mut release = Release {
        folder,
        python: options.python.clone(),
        wheels: !options.no_wheels,
        left_out: Vec::new(),
        start: Instant::now(),
    };
    let wanted = options.targets.iter().map(String::as_str);
    let wanted: Vec<&str> = if options.targets.is_empty() { TARGETS.to_vec() } else { wanted.collect() };
    let platforms = wanted.into_iter().map(Platform::new).collect::<Result<Vec<_>>>()?;

    let licences = release.part("licences", dependencies::licences(&root)).unwrap_or_default();
    let module = release.part("lab's module", lab::build());
    let mut archives = Vec::new();
    for platform in &platforms {
        archives.extend(program(&mut release, platform, module.as_deref(), &licences, &epoch));
    }
    let folder = release.folder.clone();
    let bill = dependencies::bill(&root).and_then(|text| papers::write(&folder, &papers::bill(), &text));
    release.part("bill of materials", bill);
    let others = papers::write_all(&root, &folder, &archives);
    release.part("installers, formula, container, notes", others);
    let sums = sums(&folder).and_then(|text| papers::write(&folder, "SHA256SUMS", &text));
    release.part("checksums", sums);
    conclude(&release)
}

/// The archive of one platform, by name and checksum, and its wheel.
fn program(
    release: &mut Release,
    platform: &Platform<'_>,
    module: Option<&Path>,
    licences: &str,
    epoch: &str,
) -> Option<(String, String)> {
    let python = release.python.clone();
    let zig = platform.environment(&python, epoch);
    let mut build = release.part(&format!("{}: tools", platform.target), zig)?;
    let library = release.part(&format!("{}: library of FMUs", platform.target), platform.library(&build));
    build.extend(module.map(|file| ("STRIBECK_LAB_EMBED".to_owned(), file.into())));
    build.extend(library.as_deref().map(|file| ("STRIBECK_FMU_EMBED".to_owned(), file.into())));
    let made = platform
        .program(&build)
        .and_then(|program| archive::pack(&release.folder, platform, &program, licences, epoch));
    let archive = release.part(&format!("{}: program", platform.target), made);
    if release.wheels && platform.wheel {
        let made = wheel::make(&release.folder, &python, Some(platform.target), &build);
        release.part(&format!("{}: wheel", platform.target), made);
    }
    let archive = archive?;
    let sum = checksum(&release.folder, &[archive.as_str()]);
    let sum = release.part(&format!("{}: checksum", platform.target), sum)?;
    Some((archive, sum.split(' ').next()?.to_owned()))
}

/// `SOURCE_DATE_EPOCH`, or else the time of the last commit [s since 1970], if nothing was changed since.
fn epoch(root: &Path) -> Result<String> {
    if let Ok(given) = std::env::var("SOURCE_DATE_EPOCH") {
        return Ok(given);
    }
    let git = |words: &[&str]| {
        let advice = "name the time of the release in SOURCE_DATE_EPOCH";
        output(Command::new("git").current_dir(root).args(words), advice)
    };
    let changes = git(&["status", "--porcelain", "--untracked-files=no"])?;
    ensure!(changes.is_empty(), "a release is made from a commit; commit or stash these changes:\n{changes}");
    Ok(git(&["log", "-1", "--format=%ct"])?.trim().to_owned())
}

fn sums(folder: &Path) -> Result<String> {
    let mut names: Vec<String> = std::fs::read_dir(folder)?
        .flatten()
        .filter_map(|entry| entry.file_name().into_string().ok())
        .collect();
    names.sort();
    checksum(folder, &names.iter().map(String::as_str).collect::<Vec<_>>())
}

fn checksum(folder: &Path, names: &[&str]) -> Result<String> {
    output(Command::new("sha256sum").current_dir(folder).args(names), "it is part of the GNU coreutils")
}

/// What a tool prints; `advice` is for where it is missing.
fn output(command: &mut Command, advice: &str) -> Result<String> {
    let tool = command.get_program().to_string_lossy().into_owned();
    let done = command.output().with_context(|| format!("cannot start `{tool}`: {advice}"))?;
    ensure!(done.status.success(), "{tool}: {}", String::from_utf8_lossy(&done.stderr).trim());
    String::from_utf8(done.stdout).with_context(|| format!("{tool} writes no text"))
}

#[cfg(unix)]
fn set_executable(program: &Path) -> Result<()> {
    use std::os::unix::fs::PermissionsExt;

    Ok(std::fs::set_permissions(program, std::fs::Permissions::from_mode(0o755))?)
}

#[cfg(not(unix))]
fn set_executable(_: &Path) -> Result<()> {
    Ok(())
}

/// Lists the files with their sizes, and what is missing.
fn conclude(release: &Release) -> Result<ExitCode> {
    println!("\n{}", release.folder.display());
    let mut files: Vec<_> = std::fs::read_dir(&release.folder)?.flatten().collect();
    files.sort_by_key(std::fs::DirEntry::file_name);
    for file in files {
        let megabytes = 1e-6 * file.metadata()?.len() as f64;
        println!("{megabytes:8.2} MB  {}", file.file_name().to_string_lossy());
    }
    if release.left_out.is_empty() {
        return Ok(ExitCode::SUCCESS);
    }
    bail!("left out:\n{}", release.left_out.join("\n"))
}
