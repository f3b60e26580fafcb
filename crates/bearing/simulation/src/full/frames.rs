//! Frames: positions of the nodes about the defect at chosen times ([`stribeck_store::frames`]).

use std::path::PathBuf;

use stribeck_scene::resolved::ResolvedScene;
use stribeck_store::frames::{COLUMNS, Window};
use stribeck_store::trace::TraceWriter;

use crate::bearing::assembly::{Assembly, BearingSystem};
use crate::error::Error;

/// Samples that become frames, and the nodes in them.
#[derive(Debug)]
pub(super) struct Frames {
    folder: PathBuf,
    /// First and last sample, and the distance between two frames [samples].
    first: usize,
    last: usize,
    stride: usize,
    window: Window,
}

impl Frames {
    /// The frames of a scene; `None` without any.
    pub(super) fn of(scene: &ResolvedScene, folder: PathBuf) -> Option<Self> {
        let wanted = scene.written.output.frames.as_ref()?;
        // Of the numbers as written: a quotient of seconds may fall short of a whole number of samples.
        let samples = |us: f64| us / scene.written.output.interval_us;
        Some(Self {
            folder,
            first: samples(1e3 * wanted.from_ms).ceil().max(1.0) as usize,
            last: samples(1e3 * wanted.to_ms).floor() as usize,
            stride: samples(wanted.every_us).round().max(1.0) as usize,
            window: Window::of(scene)?,
        })
    }

    /// Whether sample `sample`, from 1, becomes a frame.
    pub(super) fn is_due(&self, sample: usize) -> bool {
        (self.first..=self.last).contains(&sample) && (sample - self.first).is_multiple_of(self.stride)
    }

    /// Writes the frame of a sample.
    pub(super) fn write(
        &self,
        sample: usize,
        assembly: &Assembly,
        bearing: &BearingSystem,
    ) -> Result<(), Error> {
        std::fs::create_dir_all(&self.folder).map_err(|source| stribeck_store::Error::Io {
            action: "create",
            path: self.folder.clone(),
            kept: "Samples are safe; free the disk, or set `output.frames: None`".into(),
            source,
        })?;
        let (mesh, system) = (&assembly.model.mesh, &bearing.system);
        let mut file = TraceWriter::create(self.folder.join(format!("{sample:06}.npy")), &COLUMNS)?;
        for node in 0..mesh.x.len() {
            let [x, y] = system.position(node as u32);
            if self.window.holds(x, y) {
                file.push(&[system.time(), node as f64, x - mesh.x[node], y - mesh.y[node]])?;
            }
        }
        Ok(file.finish()?)
    }
}
