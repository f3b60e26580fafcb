//! The mesh, whole and about the defect (the paper's Fig. 1).

use std::f64::consts::FRAC_PI_2;

use stribeck_scene::resolved::{DefectGeometry, ResolvedScene};
use stribeck_scene::scene::DefectRing;
use stribeck_store::mesh_file::{Body, RunMesh};

use super::{View, scale_bar};
use crate::plot::{Anchor, Colour, Picture, Sheet};
use stribeck_diagnosis::words::numbers::significant;

/// Width of the pictures [px].
const WIDTH: f64 = 900.0;
const EDGE: &str = "fill:none;stroke-linejoin:round;stroke:";

/// Edges of the elements of one body, each once, as node numbers.
pub(super) fn edges(mesh: &RunMesh, body: &Body) -> Vec<[u32; 2]> {
    let around = |corners: &[u32]| -> Vec<[u32; 2]> {
        (0..corners.len())
            .map(|n| {
                let (a, b) = (corners[n], corners[(n + 1) % corners.len()]);
                [a.min(b), a.max(b)]
            })
            .collect()
    };
    let mut edges: Vec<[u32; 2]> = mesh.elements_of(body).flat_map(around).collect();
    edges.sort_unstable();
    edges.dedup();
    edges
}

/// Least and largest of some coordinates.
pub(super) fn range(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| [low.min(value), high.max(value)])
}

/// Names of bodies that hold the outer ring.
const HOLDING: [&str; 4] = ["adapter", "pedestal", "housing", "frame"];

fn colour(body: &str) -> Colour {
    match body {
        "outer ring" => Colour::Blue,
        "inner ring" => Colour::Green,
        name if HOLDING.contains(&name) => Colour::Brown,
        "cage" => Colour::Red,
        _ => Colour::Orange,
    }
}

fn draw(sheet: &mut Sheet, mesh: &RunMesh, view: &View, width: f64, seen: impl Fn([f64; 2]) -> bool) {
    for body in &mesh.bodies {
        let at = |n: u32| mesh.reference[n as usize];
        let lines = edges(mesh, body).into_iter().map(|e| e.map(at)).filter(|e| e.iter().any(|p| seen(*p)));
        let paint = format!("{EDGE}{};stroke-width:{width}", colour(&body.name).css());
        sheet.lines(lines.map(|e| e.map(|p| view.place(p))), &paint);
    }
}

/// All bodies.
pub(super) fn whole(scene: &ResolvedScene, mesh: &RunMesh) -> Picture {
    let [[x0, x1], [y0, y1]] = [0, 1].map(|axis| {
        let [low, high] = range(mesh.reference.iter().map(|at| at[axis]));
        [low - 0.004, high + 0.004]
    });
    let view = View::new([x0, y0], [x1, y1], [0.0, 0.0], WIDTH);
    let mut sheet = Sheet::new(WIDTH, view.height.ceil());
    draw(&mut sheet, mesh, &view, 0.25, |_| true);
    let outside = scene.outer_race_radius + scene.outer_ring_thickness;
    let holds = mesh.bodies.iter().map(|body| body.name.as_str()).find(|name| HOLDING.contains(name));
    let named = [
        holds.map(|name| (name, [0.0, 0.5 * (y1 - 0.004 + outside)])),
        Some(("outer ring", [0.0, -0.5 * (outside + scene.outer_race_radius)])),
        Some(("inner ring", [0.0, scene.inner_race_radius - 0.5 * scene.inner_ring_thickness])),
        Some(("roller", [scene.path_radius(), 0.0])),
    ];
    for (name, at) in named.into_iter().flatten() {
        let at = view.place(at);
        let half = 4.0 * name.len() as f64;
        let ground = [
            [at[0] - half, at[1] - 12.0],
            [at[0] + half, at[1] - 12.0],
            [at[0] + half, at[1] + 5.0],
            [at[0] - half, at[1] + 5.0],
        ];
        sheet.path(&ground, true, "fill:#fff;fill-opacity:0.85");
        sheet.text(at, 14.0, Anchor::Middle, "#000", name);
    }
    scale_bar(&mut sheet, [20.0, view.height - 20.0], 0.02, view.scale, "20 mm");
    let mut picture = Picture::new("mesh", "The mesh", sheet);
    picture.caption = format!(
        "{}uter ring, {} rollers, cage and inner ring: {} elements.",
        holds.map_or("O".to_owned(), |name| format!("{}{}, o", name[..1].to_uppercase(), &name[1..])),
        mesh.bodies.iter().filter(|b| b.name.starts_with("roller")).count(),
        mesh.elements()
    );
    picture.note = "Undeformed, before the load.".into();
    picture
}

/// Two rollers and the defect between them.
pub(super) fn defect(scene: &ResolvedScene, mesh: &RunMesh) -> Picture {
    let spall = scene.written.leading_spall().as_ref().map(DefectGeometry::of);
    let angle = spall.map_or(FRAC_PI_2, |defect| defect.angle);
    let ring = spall.map_or(DefectRing::Outer, |defect| defect.ring);
    let (radius, outwards) = match ring {
        DefectRing::Outer => (scene.outer_race_radius, 1.0),
        DefectRing::Inner => (scene.inner_race_radius, -1.0),
    };
    let centre = [radius * angle.cos(), radius * angle.sin()];
    let half = [0.014, 0.0075];
    let low = [centre[0] - half[0], centre[1] - 1.25 * half[1]];
    let high = [centre[0] + half[0], centre[1] + 0.75 * half[1]];
    let view = View::new(low, high, [0.0, 0.0], WIDTH);
    let mut sheet = Sheet::new(WIDTH, view.height.ceil());
    let seen = |p: [f64; 2]| (0..2).all(|c| (low[c]..=high[c]).contains(&p[c]));
    sheet.clipped("defect-window", [0.0, 0.0], [WIDTH, view.height], |sheet| {
        draw(sheet, mesh, &view, 0.8, seen);
        for (direction, paint) in [(angle, "#000"), (scene.first_roller_angle, Colour::Red.css())] {
            let ray = [0.8, 1.3]
                .map(|r: f64| view.place([r * radius * direction.cos(), r * radius * direction.sin()]));
            sheet.path(
                &ray,
                false,
                &format!("fill:none;stroke:{paint};stroke-width:1.5;stroke-dasharray:6 4"),
            );
        }
        if let Some(defect) = &spall {
            let reach = 0.5 * defect.length;
            let ring: Vec<[f64; 2]> = (0..60)
                .map(|n| {
                    let t = std::f64::consts::TAU * f64::from(n) / 60.0;
                    let (along, out) = (1.2 * reach * t.cos(), 0.0009 * t.sin() + outwards * 0.0001);
                    let (r, a) = (radius + out, angle + along / radius);
                    view.place([r * a.cos(), r * a.sin()])
                })
                .collect();
            sheet.path(&ring, true, "fill:none;stroke:#b3202c;stroke-width:2");
        }
    });
    let offset =
        (scene.written.bearing.first_roller_deg - angle.to_degrees() + 180.0).rem_euclid(360.0) - 180.0;
    let ground = [[WIDTH - 370.0, 8.0], [WIDTH - 8.0, 8.0], [WIDTH - 8.0, 30.0], [WIDTH - 370.0, 30.0]];
    sheet.path(&ground, true, "fill:#fff;fill-opacity:0.9");
    let middle = if spall.is_some() {
        "the middle of the defect".to_owned()
    } else {
        format!("{} °", significant(angle.to_degrees(), 4))
    };
    let words = format!("roller 1 stands {} ° from {middle}", (100.0 * offset.abs()).round() / 100.0);
    sheet.text([WIDTH - 14.0, 23.0], 13.0, Anchor::End, Colour::Red.css(), &words);
    scale_bar(&mut sheet, [20.0, view.height - 16.0], 0.002, view.scale, "2 mm");
    let mut picture = Picture::new(
        "mesh-defect",
        if spall.is_some() { "The mesh about the defect" } else { "The mesh between the rings" },
        sheet,
    );
    picture.caption = match &scene.written.leading_spall() {
        Some(d) => format!(
            "The defect, {} mm long and {} mm deep, is made by nodes that are moved {}; no element is left \
             out.",
            d.length_mm,
            d.depth_mm,
            if outwards > 0.0 { "outwards" } else { "inwards" }
        ),
        None => "No spall lies on a raceway.".into(),
    };
    picture.note =
        format!("Undeformed, before the load. Dashed: {middle} and roller 1, or its empty pocket.");
    picture
}
