//! Pictures of the bearing: its mesh, a roller, the load zone, stresses.

mod mesh;
mod polar;
mod roller;
mod stress;

use std::path::Path;

use stribeck_scene::housing::HousingScene;
use stribeck_store::frames::{self, Window};
use stribeck_store::mesh_file::RunMesh;
use stribeck_store::run_dir::{Run, RunDir};

use crate::Error;
use crate::plot::{Picture, Sheet};
use stribeck_analysis::findings::Findings;
use stribeck_analysis::record::Record;

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
    /// Draws them. `run_dir` is the folder of the run, for its mesh and its frames.
    pub(super) fn of(record: &Record<'_>, findings: &Findings, run_dir: &Path) -> Result<Self, Error> {
        let run = record.run();
        let mut pictures =
            Self { load: polar::picture(&run.scene, findings).into_iter().collect(), ..Self::default() };
        let dir = RunDir::open(run_dir)?;
        let mesh = match mesh_of(run, &dir) {
            Ok(mesh) => mesh,
            Err(why) => {
                pictures.notes.push(format!("no pictures of the mesh and of the stress: {why}"));
                return Ok(pictures);
            }
        };
        pictures.mesh = vec![
            mesh::whole(&run.scene, &mesh),
            mesh::defect(&run.scene, &mesh),
            roller::picture(&run.scene, &mesh),
        ];
        if findings.of_paper {
            let numbers = ["Fig. 1a: ", "Fig. 1b: ", "Fig. 4: "];
            for (picture, number) in pictures.mesh.iter_mut().zip(numbers) {
                picture.title = format!("{number}{}", picture.title);
            }
            if let Some(roller) = pictures.mesh.last_mut() {
                roller.note += " The paper draws a schematic of 15 edges and counts 113 in its model.";
            }
        }
        let frames = frames::read_all(&dir.frames())?;
        match Window::of(&run.scene).filter(|_| !frames.is_empty()) {
            Some(window) => {
                pictures.stress = stress::pictures(record, findings, &mesh, &window, &frames)?;
                if pictures.stress.iter().all(|picture| picture.id != "stress") {
                    pictures.notes.push(
                        "no picture of the stress under a roller: none that crosses the spall stands in the \
                         window while frames are kept \
                         (`output.frames`)"
                            .into(),
                    );
                }
            }
            None => pictures
                .notes
                .push("no picture of the stress: the run kept no frames (`output.frames`)".into()),
        }
        Ok(pictures)
    }
}

/// The mesh that the run has kept, or why it cannot be drawn.
fn mesh_of(run: &Run, dir: &RunDir) -> Result<RunMesh, String> {
    let mesh = RunMesh::read(dir.mesh()).map_err(|why| why.to_string())?;
    let (counts, expected) = ([mesh.reference.len(), mesh.quads.len(), mesh.triangles.len()], &run.info.mesh);
    if counts != [expected.nodes, expected.quads, expected.triangles] {
        return Err(
            "`mesh.vtu` and `run.json` count other nodes and elements: it belongs to another run".into()
        );
    }
    // A picture as large as a forged mesh would take all memory.
    let ring = run.scene.outer_race_radius + run.scene.outer_ring_thickness;
    let reach = match &run.scene.written.housing {
        HousingScene::Adapter => 2.0 * (ring + run.scene.adapter_width + run.scene.adapter_height),
        HousingScene::Pedestal(p) => 2e-3 * (p.width_mm + p.base_mm + p.top_mm),
        HousingScene::Mesh(_) => LARGEST_HOUSING * ring,
        HousingScene::Rigid(_) | HousingScene::Springs(_) => 2.0 * ring,
    };
    let fits = [0, 1].into_iter().all(|axis| {
        let [low, high] = mesh::range(mesh.reference.iter().map(|at| at[axis]));
        low >= -reach && high <= reach && high - low >= ring
    });
    fits.then_some(mesh).ok_or_else(|| "`mesh.vtu` is not as large as the scene's bearing".into())
}

/// A housing from a file is taken for one up to this many times as large as the ring.
const LARGEST_HOUSING: f64 = 50.0;

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
