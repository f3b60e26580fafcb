//! Pictures of the mesh, a roller and stresses.

mod mesh;
mod roller;
mod stresses;

use std::path::Path;

use stribeck_analysis::findings::Findings;
use stribeck_analysis::record::Record;

use stribeck_scene::housing::HousingScene;
use stribeck_store::frames::{self, Window};
use stribeck_store::mesh_file::RunMesh;
use stribeck_store::run_dir::{Run, RunDir};

use crate::Error;
use crate::page::{Section, drawn};
use crate::plot::{Picture, Sheet};

/// The section, and why some of its pictures are missing.
pub(super) fn section(
    record: &Record<'_>,
    findings: &Findings,
    folder: &Path,
) -> Result<(Section, Vec<String>), Error> {
    let run = record.run();
    let section =
        Section::new("stress", "Mesh and stress").folded("How is it meshed, and where is it stressed?");
    let otherwise = "No frames were kept: see the notes.";
    let dir = RunDir::open(folder)?;
    let mesh = match mesh_of(run, &dir) {
        Ok(mesh) => mesh,
        Err(why) => {
            let note = format!("no pictures of the mesh and of the stress: {why}");
            return Ok((section.figures([], otherwise), vec![note]));
        }
    };
    let mut pictures = meshes(run, findings, &mesh);
    let frames = frames::read_all(&dir.frames())?;
    let note = match Window::of(&run.scene).filter(|_| !frames.is_empty()) {
        Some(window) => {
            let of_stress = stresses::pictures(record, findings, &mesh, &window, &frames)?;
            let missing = of_stress.iter().all(|picture| picture.id != "stress");
            pictures.extend(of_stress);
            missing.then_some(
                "no picture of the stress under a roller: none that crosses the spall stands in the window \
                 while frames are kept (`output.frames`)",
            )
        }
        None => Some("no picture of the stress: the run kept no frames (`output.frames`)"),
    };
    Ok((section.figures(drawn(pictures), otherwise), note.map(str::to_owned).into_iter().collect()))
}

/// The mesh, whole and about the defect, and a roller; of the paper's bearing with its numbers of figures.
fn meshes(run: &Run, findings: &Findings, mesh: &RunMesh) -> Vec<Picture> {
    let mut pictures =
        [mesh::whole(&run.scene, mesh), mesh::defect(&run.scene, mesh), roller::picture(&run.scene, mesh)];
    if findings.of_paper {
        for (picture, number) in pictures.iter_mut().zip(["Fig. 1a: ", "Fig. 1b: ", "Fig. 4: "]) {
            picture.title = format!("{number}{}", picture.title);
        }
        pictures[2].note += " The paper draws a schematic of 15 edges and counts 113 in its model.";
    }
    pictures.into()
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
        HousingScene::Rigid(_) | HousingScene::Springs(_) | HousingScene::Machine(_) => 2.0 * ring,
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
