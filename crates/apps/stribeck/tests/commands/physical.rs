//! The contacts of `fixtures/scenes/physical.ron` are Hertz's: pressed by the preload, held against closed
//! forms.

use std::f64::consts::PI;

use stribeck_analysis::stress::{Stress, elastic};
use stribeck_scene::resolved::ResolvedScene;
use stribeck_scene::scene::Scene;
use stribeck_simulation::bearing::assembly::Assembly;
use stribeck_simulation::bearing::start::preload;
use stribeck_testing::ledger;

/// Elements of a tenth of a millimetre average the stress, and contact sinks in by a thirtieth of the
/// approach.
const TOLERANCE: f64 = 0.05;

/// Line contact of half-width a: the von Mises stress is largest at this depth over a, with this share of the
/// peak pressure, for ν = 0.3 in plane strain (Johnson 1985, §4.2, from (4.49)).
const DEEPEST: [f64; 2] = [0.704, 0.5575];

/// Nodes about a contact whose elements are looked at [m].
const NEAR: f64 = 0.5e-3;

/// A line contact by Johnson 1985: (4.43) and (4.45); the approach of a cylinder's axis to it, half of
/// (5.57).
struct Hertz {
    half_width: f64,
    peak: f64,
    approach: f64,
}

impl Hertz {
    fn new(g: &ResolvedScene, line_load: f64, effective_radius: f64) -> Self {
        let modulus = g.material.youngs_modulus / (1.0 - g.material.poissons_ratio.powi(2));
        let half_width = (8.0 * line_load * effective_radius / (PI * modulus)).sqrt();
        let approach = line_load / (PI * modulus) * (2.0 * (4.0 * g.roller_radius / half_width).ln() - 1.0);
        Self { half_width, peak: 2.0 * line_load / (PI * half_width), approach }
    }
}

/// Half-width and largest pressure [m, Pa] that forces on nodes stand for, given as place along the surface
/// and force a length out of plane [m, N/m].
///
/// The mean of x² under p₀ √(1 − x²/a²) is a²/4. Forces on nodes that are h apart have h²/6 more: each stands
/// for a straight-line share of the pressure, and between two nodes x² lies below its chord by h²/6 in the
/// mean.
fn pressure(forces: &[(f64, f64)]) -> [f64; 2] {
    let sum: f64 = forces.iter().map(|(_, f)| f).sum();
    let middle = forces.iter().map(|(x, f)| x * f).sum::<f64>() / sum;
    let square = forces.iter().map(|(x, f)| (x - middle).powi(2) * f).sum::<f64>() / sum;
    let h = (forces[forces.len() - 1].0 - forces[0].0) / (forces.len() - 1) as f64;
    let most = forces.iter().map(|(_, f)| *f).fold(0.0, f64::max);
    [2.0 * (square - h * h / 6.0).sqrt(), most / h]
}

/// Johnson 1985, §4.2 and §5.6.
#[test]
fn analytic_contacts_of_the_physical_scene_are_hertzian() {
    let text = include_str!("../../../../../fixtures/scenes/physical.ron");
    let mut scene = Scene::parse(text, "physical.ron").expect("a valid scene");
    // One roller stands in the middle of the load.
    (scene.defect, scene.output.frames) = (None, None);
    scene.bearing.first_roller_deg = 90.0;
    let g = scene.resolve();
    let assembly = Assembly::new(&g).expect("a mesh");
    let mut machine = assembly.build(&g, 2).expect("a machine");
    preload(&mut machine, &g, &assembly.kinematics).expect("an equilibrium");

    let mesh = &assembly.model.mesh;
    let reference = |n: u32| [mesh.x[n as usize], mesh.y[n as usize]];
    let system = &mut machine.system;
    let forces = system.contact_forces();
    let now = |n: u32| system.position(n);
    let roller = &machine.rollers[0];
    let centre = [reference(roller.centre), now(roller.centre)];
    // It stands at the top: outwards is up.
    for (ring, outward, radius) in
        [("outer", 1.0, g.outer_contact_radius()), ("inner", -1.0, g.inner_contact_radius())]
    {
        let touch = [0.0, centre[0][1] + outward * g.roller_radius];
        let near = |n: u32| (0..2).all(|c| (reference(n)[c] - touch[c]).abs() < NEAR);
        let height = |n: u32| outward * (now(n)[1] - centre[1][1]);

        let pushed = mesh.bodies[roller.body].nodes.clone().map(|n| n as u32);
        let mut pushed: Vec<(f64, f64)> = pushed
            .filter(|&n| near(n) && forces[n as usize] != [0.0; 2])
            .map(|n| (now(n)[0], -outward * forces[n as usize][1] / g.thickness))
            .collect();
        pushed.sort_by(|a, b| a.0.total_cmp(&b.0));
        let load = pushed.iter().map(|(_, f)| f).sum();
        let hertz = Hertz::new(&g, load, radius);
        let [half_width, peak] = pressure(&pushed);

        // The rim where it touches: the node whose reference lies on the line of centres.
        let body = &mesh.bodies[roller.body];
        let rim = body.nodes.clone().map(|n| n as u32).filter(|&n| near(n)).max_by(|&a, &b| {
            let out = |n: u32| height(n) - reference(n)[0].abs();
            out(a).total_cmp(&out(b))
        });
        let rim = height(rim.expect("a node"));
        let material = elastic(&g.material);
        let quads = mesh.quads[body.quads.clone()].iter().map(|quad| &quad[..]);
        let elements = quads.chain(mesh.triangles[body.triangles.clone()].iter().map(|corners| &corners[..]));
        let stressed = elements.filter(|corners| corners.iter().all(|&n| near(n))).map(|corners| {
            let at = |place: &dyn Fn(u32) -> [f64; 2]| corners.iter().map(|&n| place(n)).collect::<Vec<_>>();
            let middle = corners.iter().map(|&n| height(n)).sum::<f64>() / corners.len() as f64;
            (Stress::of(&material, &at(&reference), &at(&now)).von_mises(), rim - middle)
        });
        let (worst, depth) = stressed.max_by(|a, b| a.0.total_cmp(&b.0)).expect("elements");

        let approach = g.roller_radius - rim;
        let [deep, share] = DEEPEST;
        for (what, unit, ours, theirs, source) in [
            ("half-width", "m", half_width, hertz.half_width, "Johnson 1985, (4.43)"),
            ("peak pressure", "Pa", peak, hertz.peak, "Johnson 1985, (4.45)"),
            ("approach", "m", approach, hertz.approach, "Johnson 1985, (5.57)"),
            ("largest von Mises stress", "Pa", worst, share * hertz.peak, "Johnson 1985, (4.49)"),
        ] {
            let quantity = format!("physical scene, {what} at the {ring} raceway");
            ledger::compare(&quantity, source, unit, ours, theirs, TOLERANCE);
        }
        // Elements say where it is to half their height.
        assert!(
            (depth - deep * hertz.half_width).abs() < 0.5 * g.element_size,
            "{ring}: {depth} m below the rim"
        );
    }
}
