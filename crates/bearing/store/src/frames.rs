//! Frames: positions of the nodes about the defect at chosen times, one file each, for pictures of the
//! stress.
//!
//! `frames/000042.npy` belongs to sample 42. Its rows are the nodes in a window, with their displacements
//! from the stress-free mesh that the scene makes; its first column repeats the time. A run continued from a
//! checkpoint writes the later frames again, to the same bytes.

use std::f64::consts::FRAC_PI_2;
use std::path::{Path, PathBuf};

use crate::error::Error;
use crate::trace::Trace;
use stribeck_scene::resolved::ResolvedScene;

/// Columns of a frame.
pub const COLUMNS: [&str; 4] = ["time_s", "node", "ux_m", "uy_m"];

/// A square beside the outer raceway: one side lies along the raceway's tangent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Window {
    /// Its centre [m], where the centre of a roller passes.
    pub centre: [f64; 2],
    /// Unit vector away from the bearing's centre.
    pub outward: [f64; 2],
    /// Half of its side [m].
    pub half: f64,
}

/// Nodes of a window at one time.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// Time [s].
    pub time_s: f64,
    /// Numbers of the nodes in the scene's mesh, ascending.
    pub nodes: Vec<u32>,
    /// Their displacements from the stress-free mesh [m].
    pub displacement: Vec<[f64; 2]>,
}

impl Window {
    /// The window of a scene that asks for frames.
    pub fn of(scene: &ResolvedScene) -> Option<Self> {
        let half = scene.frame_half_width?;
        let angle = scene.written.leading_spall().map_or(FRAC_PI_2, |defect| defect.angle_deg.to_radians());
        let outward = [angle.cos(), angle.sin()];
        let centre = outward.map(|c| scene.path_radius() * c);
        Some(Self { centre, outward, half })
    }

    /// Place of a point in the window [m]: along the raceway, clockwise, and outward.
    pub fn place(&self, x: f64, y: f64) -> [f64; 2] {
        let (dx, dy) = (x - self.centre[0], y - self.centre[1]);
        let [nx, ny] = self.outward;
        [dx * ny - dy * nx, dx * nx + dy * ny]
    }

    /// Whether it holds a point [m].
    pub fn holds(&self, x: f64, y: f64) -> bool {
        self.place(x, y).iter().all(|c| c.abs() <= self.half)
    }
}

/// All frames in the folder, in the order of time; none when there is no such folder.
///
/// # Errors
/// The error of the first file that cannot be read.
pub fn read_all(folder: &Path) -> Result<Vec<Frame>, Error> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Ok(Vec::new()) };
    let mut files: Vec<PathBuf> =
        entries.flatten().map(|e| e.path()).filter(|p| p.extension().is_some_and(|e| e == "npy")).collect();
    files.sort();
    let mut frames = Vec::new();
    for file in files {
        let table = Trace::read(&file)?;
        let column = |name: &str| table.get(name).unwrap_or_default();
        let Some(&time_s) = column("time_s").first() else { continue };
        let (ux, uy) = (column("ux_m"), column("uy_m"));
        frames.push(Frame {
            time_s,
            nodes: column("node").iter().map(|&n| n as u32).collect(),
            displacement: ux.iter().zip(uy).map(|(&x, &y)| [x, y]).collect(),
        });
    }
    Ok(frames)
}
