//! Whether the samples of a run fit on the disk.

use std::path::Path;
use std::process::Command;

use stribeck_scene::resolved::ResolvedScene;
use stribeck_simulation::run::channels;

use crate::shelf::in_words;

/// Size of a trace [bytes].
pub(crate) fn trace_bytes(scene: &ResolvedScene) -> f64 {
    8.0 * channels::names(scene).len() as f64 * (scene.duration / scene.interval).round()
}

/// A warning where the trace is larger than the free part of the disk of a folder.
pub(crate) fn too_small(scene: &ResolvedScene, folder: &Path) -> Option<String> {
    let (wanted, free) = (trace_bytes(scene), free_bytes(folder)?);
    (wanted > free).then(|| {
        format!(
            "the trace takes {}, and the disk has {} free: take less `solver.duration_ms` or a longer \
             `output.interval_us`",
            in_words(wanted as u64),
            in_words(free as u64)
        )
    })
}

/// Free bytes on the disk of a folder, or of the nearest one above it that is there; `None` where the system
/// has no `df`.
fn free_bytes(folder: &Path) -> Option<f64> {
    let folder = std::path::absolute(folder).ok()?;
    let there = folder.ancestors().find(|folder| folder.is_dir())?;
    let told = Command::new("df").arg("-Pk").arg(there).output().ok()?;
    let text = String::from_utf8_lossy(&told.stdout).into_owned();
    let kib: f64 = text.lines().nth(1)?.split_whitespace().rev().nth(2)?.parse().ok()?;
    Some(1024.0 * kib)
}
