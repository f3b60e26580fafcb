//! The archive of a program: equal files give equal bytes.

use std::io::Write;
use std::path::Path;
use std::process::Command;

use anyhow::{Context, Result};
use zip::{CompressionMethod, ZipWriter, write::SimpleFileOptions};

use super::platform::Platform;
use super::{VERSION, output, set_executable};
use crate::workspace;

/// Files of the repository beside the program.
const BESIDE: [&str; 6] = [
    "README.md",
    "CHANGELOG.md",
    "LICENSE",
    "LICENSE-APACHE",
    "LICENSE-MIT",
    "fixtures/scenes/first_look.ron",
];

/// Packs a program with its licences, and returns the name of the archive.
pub(super) fn pack(
    folder: &Path,
    platform: &Platform<'_>,
    program: &Path,
    licences: &str,
    epoch: &str,
) -> Result<String> {
    let name = format!("stribeck-{VERSION}-{}", platform.target);
    let read = |file: &Path| std::fs::read(file).with_context(|| format!("cannot read `{}`", file.display()));
    let mut files = vec![
        (platform.program.to_owned(), read(program)?),
        ("THIRD-PARTY-LICENSES".to_owned(), licences.as_bytes().to_vec()),
    ];
    for file in BESIDE {
        let name = file.rsplit('/').next().unwrap_or(file);
        files.push((name.to_owned(), read(&workspace::root().join(file))?));
    }
    files.sort();
    if platform.program.ends_with(".exe") {
        zipped(folder, &name, &files)
    } else {
        tarred(folder, &name, &files, epoch)
    }
}

fn zipped(folder: &Path, name: &str, files: &[(String, Vec<u8>)]) -> Result<String> {
    let archive = format!("{name}.zip");
    let mut zip = ZipWriter::new(std::fs::File::create(folder.join(&archive))?);
    let plain = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .compression_level(Some(9))
        .last_modified_time(zip::DateTime::default());
    for (file, bytes) in files {
        zip.start_file(format!("{name}/{file}"), plain)?;
        zip.write_all(bytes)?;
    }
    zip.finish()?;
    Ok(archive)
}

fn tarred(folder: &Path, name: &str, files: &[(String, Vec<u8>)], epoch: &str) -> Result<String> {
    let stage = workspace::target().join("release-stage");
    std::fs::remove_dir_all(&stage).ok();
    std::fs::create_dir_all(stage.join(name))?;
    for (file, bytes) in files {
        std::fs::write(stage.join(name).join(file), bytes)?;
    }
    let archive = folder.join(format!("{name}.tar"));
    let mut tar = Command::new("tar");
    tar.arg("--create")
        .arg("--file")
        .arg(&archive)
        .arg("--directory")
        .arg(&stage)
        .arg(format!("--mtime=@{epoch}"));
    tar.args(["--sort=name", "--owner=0", "--group=0", "--numeric-owner", "--format=ustar"]);
    // Whoever packs may have another mask; the program alone is executed.
    tar.args(["--mode=u=rwX,go=rX", name]);
    set_executable(&stage.join(name).join("stribeck"))?;
    output(&mut tar, "it has to be that of GNU")?;
    output(Command::new("gzip").args(["-9", "--no-name", "--force"]).arg(&archive), "install gzip")?;
    std::fs::remove_dir_all(&stage).ok();
    Ok(format!("{name}.tar.gz"))
}
