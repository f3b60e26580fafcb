//! Pictures of the bearing: its mesh, a roller, who carries what, stresses.

mod mesh;
mod polar;
mod roller;
mod stress;

use std::path::Path;

use stribeck_bearing::assembly::Assembly;
use stribeck_scene::frames::{self, Window};
use stribeck_scene::run_dir::Run;

use crate::Error;
use crate::findings::Findings;
use crate::plot::{Picture, Sheet};

/// All pictures that the run can yield, by the section that shows them.
#[derive(Debug, Default)]
pub(super) struct Pictures {
    pub(super) mesh: Vec<Picture>,
    pub(super) load: Vec<Picture>,
    pub(super) stress: Vec<Picture>,
    /// Why some are missing.
    pub(super) notes: Vec<String>,
}

impl Pictures {
    /// Draws them. `run_dir` is the folder of the run, for its frames.
    pub(super) fn of(run: &Run, findings: &Findings, run_dir: &Path) -> Result<Self, Error> {
        let mut pictures = Self { load: polar::picture(findings).into_iter().collect(), ..Self::default() };
        // The mesh follows from the scene; a run does not keep it in a form that is read again.
        let assembly = match Assembly::new(&run.scene) {
            Ok(assembly) => assembly,
            Err(why) => {
                pictures.notes.push(format!("no picture of the mesh: {why}"));
                return Ok(pictures);
            }
        };
        pictures.mesh = vec![
            mesh::whole(&assembly),
            mesh::defect(&run.scene, &assembly),
            roller::picture(&run.scene, &assembly),
        ];
        let frames = frames::read_all(&run_dir.join("frames"))?;
        let counts = (assembly.model.mesh.x.len(), run.info.mesh.nodes);
        match Window::of(&run.scene) {
            _ if frames.is_empty() => {
                pictures.notes.push("no picture of the stress: the run kept no frames (`output.frames`)".into());
            }
            _ if counts.0 != counts.1 => pictures.notes.push(format!(
                "no picture of the stress: the run's mesh has {} nodes, and this program makes {} of the same scene",
                counts.1, counts.0
            )),
            None => {}
            Some(window) => pictures.stress = stress::pictures(run, findings, &assembly, &window, &frames)?,
        }
        Ok(pictures)
    }
}

/// From metres to pixels: a rectangle of the bearing on a sheet.
#[derive(Debug, Clone, Copy)]
struct View {
    /// Lower left corner [m].
    from: [f64; 2],
    /// Pixels a metre.
    scale: f64,
    /// Upper left corner on the sheet, and its height [px].
    at: [f64; 2],
    height: f64,
}

impl View {
    /// The rectangle from `low` to `high` [m], drawn `width` pixels wide with its upper left corner `at`.
    fn new(low: [f64; 2], high: [f64; 2], at: [f64; 2], width: f64) -> Self {
        let scale = width / (high[0] - low[0]);
        Self { from: low, scale, at, height: scale * (high[1] - low[1]) }
    }

    fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [
            self.at[0] + self.scale * (x - self.from[0]),
            self.at[1] + self.height - self.scale * (y - self.from[1]),
        ]
    }
}

/// A bar with its length in words, its left end at `at` [px].
fn scale_bar(sheet: &mut Sheet, at: [f64; 2], metres: f64, scale: f64, words: &str) {
    let right = [at[0] + metres * scale, at[1]];
    sheet.path(&[at, right], false, "fill:none;stroke:#000;stroke-width:2");
    sheet.text([right[0] + 6.0, at[1] + 4.0], 12.0, crate::plot::Anchor::Start, "#000", words);
}
