//! One roller as meshed, and the deviation of its facets from the circle (the paper's Fig. 4).

use std::f64::consts::PI;

use stribeck_scene::resolved::ResolvedScene;
use stribeck_scene::scene::ContactSurface;
use stribeck_store::mesh_file::RunMesh;

use super::{View, mesh, scale_bar};
use crate::plot::{Anchor, Colour, Picture, Sheet};

const SIZE: [f64; 2] = [900.0, 440.0];
/// Facets in the magnified part.
const FACETS: usize = 4;

/// The roller to scale, and its rim with heights magnified.
pub(super) fn picture(scene: &ResolvedScene, mesh: &RunMesh) -> Picture {
    let facets = scene.written.mesh.roller_facets;
    let radius = 0.5 * scene.written.bearing.roller_diameter_mm;
    let sag_um = 1e3 * radius * (1.0 - (PI / facets as f64).cos());
    let mut sheet = Sheet::new(SIZE[0], SIZE[1]);
    to_scale(&mut sheet, scene, mesh);
    magnified(&mut sheet, radius, facets, sag_um);
    let mut picture = Picture::new("roller", "A polygonised roller", sheet);
    picture.caption = format!(
        "A roller of {facets} facets looks round, and yet each facet lies {sag_um:.2} µm inside the circle \
         in its middle: {}.",
        if scene.written.contact.surface == ContactSurface::Facet {
            "that is what excites the contacts"
        } else {
            "contact on arcs takes that away"
        }
    );
    picture.note = format!(
        "Left: the mesh to scale. Right: {FACETS} facets, heights magnified {:.0} times.",
        HEIGHT_PX / (sag_um * 1e-3) / (WIDTH_PX / (FACETS as f64 * 2.0 * PI * radius / facets as f64))
    );
    picture
}

/// Size of the magnified part [px]: width of all facets, height of the sag.
const WIDTH_PX: f64 = 380.0;
const HEIGHT_PX: f64 = 120.0;

fn to_scale(sheet: &mut Sheet, scene: &ResolvedScene, run_mesh: &RunMesh) {
    let Some(body) = run_mesh.bodies.iter().find(|b| b.name.starts_with("roller ")) else { return };
    let place = |n: &u32| run_mesh.reference[*n as usize];
    let centre = [0, 1].map(|axis| {
        let [low, high] = mesh::range(run_mesh.elements_of(body).flatten().map(|n| place(n)[axis]));
        0.5 * (low + high)
    });
    let reach = 1.1 * scene.roller_radius;
    let view = View::new(centre.map(|c| c - reach), centre.map(|c| c + reach), [10.0, 10.0], 400.0);
    sheet.lines(
        mesh::edges(run_mesh, body).into_iter().map(|e| e.map(|n| view.place(place(&n)))),
        &format!("fill:none;stroke:{};stroke-width:0.6", Colour::Orange.css()),
    );
    scale_bar(sheet, [20.0, 425.0], 0.002, view.scale, "2 mm");
}

fn magnified(sheet: &mut Sheet, radius: f64, facets: usize, sag_um: f64) {
    let (left, top) = (480.0, 170.0);
    let step = 2.0 * PI / facets as f64;
    let place = |angle: f64, depth_um: f64| {
        [left + WIDTH_PX * angle / (step * FACETS as f64), top + HEIGHT_PX * depth_um / sag_um]
    };
    let points = 40 * FACETS;
    let angle = |n: usize| step * FACETS as f64 * n as f64 / points as f64;
    let circle: Vec<[f64; 2]> = (0..=points).map(|n| place(angle(n), 0.0)).collect();
    let polygon: Vec<[f64; 2]> = (0..=points)
        .map(|n| {
            // Distance of the chord from the centre at this angle.
            let from_middle = angle(n).rem_euclid(step) - 0.5 * step;
            let chord = radius * (0.5 * step).cos() / from_middle.cos();
            place(angle(n), 1e3 * (radius - chord))
        })
        .collect();
    sheet.path(&circle, false, "fill:none;stroke:#969aa0;stroke-width:2;stroke-dasharray:6 4");
    sheet.path(&polygon, false, &format!("fill:none;stroke:{};stroke-width:2", Colour::Orange.css()));
    for facet in 0..=FACETS {
        sheet.circle(place(step * facet as f64, 0.0), 4.0, &format!("fill:{}", Colour::Orange.css()));
    }
    let label = |sheet: &mut Sheet, y: f64, words: &str| {
        sheet.text([left + 0.5 * WIDTH_PX, y], 14.0, Anchor::Middle, "#000", words);
    };
    label(sheet, top - 22.0, "circle (dashed) and polygon, seen from the circle");
    label(
        sheet,
        top + HEIGHT_PX + 30.0,
        &format!("facet of {:.4} mm, sag {sag_um:.2} µm", 2.0 * radius * (0.5 * step).sin()),
    );
}
