//! Meshes that no generator would make: an answer, never a panic.

mod common;

use common::*;
use proptest::prelude::*;
use stribeck_mesh::{Body, Mesh};
use stribeck_solver::{Dynamics, Error, Model};

/// Any coordinate, good and bad.
fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        8 => -1.0_f64..1.0,
        1 => prop_oneof![Just(f64::NAN), Just(f64::INFINITY), Just(0.0), Just(1e300), Just(-1e-300), Just(f64::MAX)],
    ]
}

/// Lists and ranges of any kind, mostly small.
fn mesh() -> impl Strategy<Value = Mesh> {
    let corner = 0_u32..14;
    let end = 0_usize..14;
    let body = (end.clone(), end.clone(), end.clone(), end.clone(), end.clone(), end);
    (
        prop::collection::vec(coordinate(), 0..12),
        prop::collection::vec(coordinate(), 0..12),
        prop::collection::vec(prop::array::uniform4(corner.clone()), 0..6),
        prop::collection::vec(prop::array::uniform3(corner), 0..6),
        prop::collection::vec(body, 0..3),
        any::<bool>(),
    )
        .prop_map(|(x, y, quads, triangles, bodies, plausible)| {
            let mut mesh = Mesh { x, y, quads, triangles, bodies: Vec::new() };
            if plausible {
                // One body of everything, so that the fault is reached.
                mesh.y.resize(mesh.x.len(), 0.5);
                mesh.bodies.push(Body {
                    name: "body".into(),
                    nodes: 0..mesh.x.len(),
                    quads: 0..mesh.quads.len(),
                    triangles: 0..mesh.triangles.len(),
                });
            } else {
                mesh.bodies = bodies
                    .into_iter()
                    .map(|(a, b, c, d, e, f)| Body {
                        name: "body".into(),
                        nodes: a..b,
                        quads: c..d,
                        triangles: e..f,
                    })
                    .collect();
            }
            mesh
        })
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(4000) })]

    #[test]
    fn survives_any_mesh_with_an_answer(mesh in mesh(), loaded in 0_usize..14) {
        let nodes = mesh.x.len();
        if let Ok(model) = Model::new(mesh, steel(), THICKNESS) {
            let loaded = vec![true; if loaded > 2 { nodes } else { loaded }];
            if let Ok(mut d) = Dynamics::new(&model, &loaded, 1) {
                let critical = d.critical_time_step(&[], 0.0).time_step;
                if d.set_time_step(0.9 * critical).is_ok() {
                    run(&mut d, &mut [], 3);
                }
                let _ = (d.elastic_energy(), d.distortion());
            }
        }
    }
}

#[test]
fn refuses_foreign_nodes_and_bodies_by_name() {
    let sound = body(&rectangle(1e-3, 1e-3, 2, 2));
    let refused = |change: &dyn Fn(&mut Model)| {
        let mut model = sound.clone();
        change(&mut model);
        Dynamics::new(&model, &[true; 9], 1).expect_err("it must be refused")
    };
    assert!(matches!(refused(&|m| m.mesh.quads[3][1] = 9), Error::BadNode { element: 3, .. }));
    assert!(matches!(refused(&|m| m.mesh.bodies[0].quads = 1..4), Error::BadBody { .. }));
    assert!(matches!(refused(&|m| m.mesh.bodies[0].nodes = 0..10), Error::BadBody { .. }));
    let words = refused(&|m| m.mesh.bodies[0].quads = 0..3).to_string();
    assert!(words.contains("quadrilaterals of all bodies = 3"), "{words}");
    let words = refused(&|m| m.mesh.y.truncate(8)).to_string();
    assert!(words.contains("ordinates"), "{words}");
}

#[test]
fn by_hand_distortion_tells_area_and_stretch() {
    let mut d = ready(&body(&rectangle(2e-3, 1e-3, 4, 2)), 0.9);
    let rest = d.distortion();
    assert!((rest.least_area - 1.0).abs() < 1e-12 && (rest.largest_stretch - 1.0).abs() < 1e-12, "{rest:?}");
    for s in massive(&d) {
        // Stretched by 1.2, squeezed to 0.5 and turned.
        let (x, y) = (1.2 * d.state.x[s], 0.5 * d.state.y[s]);
        (d.state.x[s], d.state.y[s]) = (0.6 * x - 0.8 * y, 0.8 * x + 0.6 * y);
    }
    let now = d.distortion();
    assert!((now.least_area - 0.6).abs() < 1e-12 && (now.largest_stretch - 1.2).abs() < 1e-12, "{now:?}");
    for s in massive(&d) {
        d.state.x[s] = -d.state.x[s];
    }
    assert!((d.distortion().least_area + 0.6).abs() < 1e-12, "mirrored: inside out");
    let one = massive(&d)[4];
    d.state.x[one] = f64::NAN;
    assert!(d.distortion().least_area.is_nan());
}
