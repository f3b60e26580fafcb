//! The contacts of `fixtures/scenes/physical.ron` are Hertz's: pressed by the preload, held against closed forms.

use std::f64::consts::PI;
use std::ops::ControlFlow;

use stribeck_analysis::stress::{Lame, cells};
use stribeck_bearing::simulation::{Host, simulate};
use stribeck_scene::frames::Frame;
use stribeck_scene::geometry::Geometry;
use stribeck_scene::mesh_file::RunMesh;
use stribeck_scene::run_dir::{Run, RunDir};
use stribeck_scene::scene::Scene;
use stribeck_testing::{Scratch, assert_close};

/// Elements of a tenth of a millimetre average the stress, and contact sinks in by a thirtieth of the approach.
const TOLERANCE: f64 = 0.05;

/// Line contact of half-width a: the von Mises stress is largest at this depth over a, with this share of the peak pressure,
/// for ν = 0.3 in plane strain (Johnson 1985, §4.2, from (4.49)).
const DEEPEST: [f64; 2] = [0.704, 0.5575];

/// Nodes about a contact whose elements are looked at [m].
const NEAR: f64 = 0.5e-3;

/// A line contact by Johnson 1985: (4.43) and (4.45); the approach of a cylinder's axis to it, half of (5.57).
struct Hertz {
    half_width: f64,
    peak: f64,
    approach: f64,
}

impl Hertz {
    fn new(g: &Geometry, line_load: f64, effective_radius: f64) -> Self {
        let modulus = g.material.youngs_modulus / (1.0 - g.material.poissons_ratio.powi(2));
        let half_width = (8.0 * line_load * effective_radius / (PI * modulus)).sqrt();
        let approach = line_load / (PI * modulus) * (2.0 * (4.0 * g.roller_radius / half_width).ln() - 1.0);
        Self { half_width, peak: 2.0 * line_load / (PI * half_width), approach }
    }
}

/// Johnson 1985, §4.2 and §5.6.
#[test]
fn analytic_contacts_of_the_physical_scene_are_hertzian() {
    let text = include_str!("../../../fixtures/scenes/physical.ron");
    let mut scene = Scene::parse(text, "physical.ron").expect("a sound scene");
    // One roller stands in the middle of the load, and the first sample says what the preload put on it.
    (scene.defect, scene.output.frames) = (None, None);
    scene.bearing.first_roller_deg = 90.0;
    (scene.solver.duration_ms, scene.output.interval_us) = (0.001, 0.1);
    let folder = Scratch::new("physical");
    let dir = RunDir::create(folder.path()).expect("a free folder");
    let (version, commit, machine) = ("test".to_owned(), "test".to_owned(), "test".to_owned());
    let host = Host { threads: 2, version, commit, machine, wall_s: &|| 0.0, cpu_s: &|| 0.0 };
    simulate(&scene, &dir, &host, &mut |_| ControlFlow::Continue(())).expect("a sound scene");
    drop(dir);

    let g = Geometry::of(&scene);
    let mesh = RunMesh::read(folder.path().join("mesh.vtu")).expect("a mesh");
    let run = Run::read(folder.path()).expect("a run");
    let roller = mesh.bodies.iter().find(|body| body.name == "roller 1").expect("a roller");
    let corners = mesh.quads[roller.quads.clone()].iter().flatten();
    let mut nodes: Vec<u32> =
        corners.chain(mesh.triangles[roller.triangles.clone()].iter().flatten()).copied().collect();
    nodes.sort_unstable();
    nodes.dedup();
    // It stands at the top: outwards is up, and its path says where its centre was without stress.
    let centre = nodes.iter().copied().min_by(|&a, &b| {
        let off =
            |n: u32| mesh.reference[n as usize][0].hypot(mesh.reference[n as usize][1] - g.path_radius());
        off(a).total_cmp(&off(b))
    });
    let centre = centre.expect("a node") as usize;
    for (ring, outward, radius) in
        [("outer", 1.0, g.outer_contact_radius()), ("inner", -1.0, g.inner_contact_radius())]
    {
        let force = |c: &str| run.trace.get(&format!("roller.1.{ring}_f{c}_n")).expect("a channel")[0];
        let hertz = Hertz::new(&g, force("x").hypot(force("y")) / g.thickness, radius);
        let near = |n: &u32| {
            let [x, y] = mesh.reference[*n as usize];
            let top = mesh.reference[centre][1] + outward * g.roller_radius;
            x.abs() < NEAR && (y - top).abs() < NEAR
        };
        let nodes: Vec<u32> = nodes.iter().copied().filter(near).collect();
        let moved = |n: &u32| [0, 1].map(|c| mesh.start[*n as usize][c] - mesh.reference[*n as usize][c]);
        let displacement = nodes.iter().map(moved).collect();
        let frame = Frame { time_s: 0.0, nodes: nodes.clone(), displacement };
        let cells = cells(&mesh, &frame, &Lame::of(&g.material));
        let worst = cells.iter().max_by(|a, b| a.von_mises.total_cmp(&b.von_mises)).expect("elements");
        // The rim where it touches: the node whose reference lies on the line of centres.
        let rim = nodes.iter().max_by(|&&a, &&b| {
            let out = |n: u32| outward * mesh.start[n as usize][1] - mesh.reference[n as usize][0].abs();
            out(a).total_cmp(&out(b))
        });
        let rim = *rim.expect("a node") as usize;
        let height = outward * (mesh.start[rim][1] - mesh.start[centre][1]);
        let depth = height
            - outward
                * (worst.corners.iter().map(|c| c[1]).sum::<f64>() / worst.corners.len() as f64
                    - mesh.start[centre][1]);

        let approach = g.roller_radius - height;
        assert_close(approach, hertz.approach, TOLERANCE, &format!("{ring}: approach of the axis"));
        let [deep, share] = DEEPEST;
        assert_close(
            worst.von_mises,
            share * hertz.peak,
            TOLERANCE,
            &format!("{ring}: largest von Mises stress"),
        );
        // Elements say where it is to half their height.
        assert!(
            (depth - deep * hertz.half_width).abs() < 0.5 * g.element_size,
            "{ring}: {depth} m below the rim"
        );
        println!(
            "{ring}: approach {:.3} µm, Johnson {:.3}; von Mises {:.1} MPa at {:.3} mm, Hertz {:.1} at {:.3}",
            1e6 * approach,
            1e6 * hertz.approach,
            1e-6 * worst.von_mises,
            1e3 * depth,
            1e-6 * share * hertz.peak,
            1e3 * deep * hertz.half_width
        );
    }
}
