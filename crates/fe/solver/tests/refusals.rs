//! Inputs that the solver refuses, and its messages.

mod common;

use common::*;
use stribeck_mesh::{Mesh, Part};
use stribeck_solver::{Behaviour, Dynamics, Elastic, Error, Model, NodeMotion, force::NodalLoad};
use stribeck_testing::{assert_close, refuses};

#[test]
fn refuses_impossible_materials() {
    refuses(Elastic::new(-1.0, 0.3, 7800.0), &["Young's modulus [Pa]", "-1", "positive"]);
    refuses(Elastic::new(0.0, 0.3, 7800.0), &["Young's modulus [Pa]"]);
    refuses(Elastic::new(f64::NAN, 0.3, 7800.0), &["Young's modulus [Pa]", "NaN"]);
    refuses(Elastic::new(f64::INFINITY, 0.3, 7800.0), &["Young's modulus [Pa]", "inf"]);
    refuses(Elastic::new(2e11, 0.5, 7800.0), &["Poisson's ratio", "0.5"]);
    refuses(Elastic::new(2e11, -1.0, 7800.0), &["Poisson's ratio", "-1"]);
    refuses(Elastic::new(2e11, 0.3, 0.0), &["density [kg/m³]"]);
    assert!(Elastic::new(2e11, 0.0, 1.0).is_ok() && Elastic::new(2e11, -0.5, 1.0).is_ok());
}

#[test]
fn by_hand_moduli_of_steel() {
    // E = 208 GPa, ν = 0.3: µ = E/2.6, λ = E·0.3/(1.3·0.4), E' = E/0.91.
    let s = steel();
    assert_close(s.shear(), 80e9, 1e-12, "µ");
    assert_close(s.lame(), 120e9, 1e-12, "λ");
    assert_close(s.plane_strain_modulus(), 208e9 / 0.91, 1e-12, "E'");
    assert_close(s.dilatational_speed(), (280e9_f64 / 7800.0).sqrt(), 1e-12, "c");
}

/// Lays out the model of a unit rectangle after a change.
fn after(change: impl FnOnce(&mut Model)) -> Result<Dynamics, Error> {
    let mut model = body(&rectangle(1.0, 1.0, 2, 2));
    change(&mut model);
    Dynamics::new(&model, &vec![true; model.mesh.x.len()], 1)
}

#[test]
fn refuses_impossible_models() {
    let mut mesh = Mesh::new();
    mesh.add("plate", &rectangle(1.0, 1.0, 2, 2));
    for thickness in [0.0, -0.01, f64::NAN] {
        refuses(Model::new(mesh.clone(), steel(), thickness), &["thickness [m]", "positive"]);
    }
    refuses(after(|m| m.thickness = -1.0), &["thickness [m] = -1"]);
    refuses(after(|m| m.hourglass_scale = -0.1), &["hourglass scale", "-0.1"]);
    refuses(after(|m| m.gravity = [0.0, f64::NAN]), &["gravity y", "NaN"]);
    refuses(
        after(|m| m.motion[0] = NodeMotion::Rotating { centre: [0.0; 2], rate: f64::NAN }),
        &["rotation rate"],
    );
    assert!(after(|_| ()).is_ok());
}

#[test]
fn refuses_lists_that_do_not_fit_the_mesh() {
    refuses(after(|m| m.motion.truncate(3)), &["number of motions = 3", "each node"]);
    refuses(after(|m| m.materials.clear()), &["number of materials = 0", "each body"]);
    refuses(after(|m| m.behaviour.push(Behaviour::Rigid)), &["number of behaviours = 2", "each body"]);
    let model = body(&rectangle(1.0, 1.0, 2, 2));
    refuses(Dynamics::new(&model, &[true; 4], 1), &["`loaded` = 4", "each node"]);
}

#[test]
fn refuses_elements_without_area() {
    let bad = ["element 2", "body `body`", "counter-clockwise"];
    refuses(after(|m| m.mesh.quads[2].reverse()), &bad);
    refuses(after(|m| m.mesh.quads[2] = [0, 1, 1, 0]), &bad);
    refuses(after(|m| m.mesh.x[6] = f64::NAN), &bad);
    let model = body(&split(rectangle(1.0, 1.0, 2, 2)));
    let mut turned = model.clone();
    turned.mesh.triangles[2].reverse();
    refuses(Dynamics::new(&turned, &[true; 9], 1), &bad);
}

#[test]
fn refuses_nodes_without_mass() {
    let mut part: Part = rectangle(1.0, 1.0, 2, 2);
    part.x.push(3.0);
    part.y.push(3.0);
    let model = body(&part);
    refuses(Dynamics::new(&model, &[true; 10], 1), &["node 9", "body `body`", "no mass"]);
    // A rigid body may have nodes that only carry contact, as the message says, but not nothing else.
    let mut rigid = model.clone();
    rigid.behaviour[0] = Behaviour::Rigid;
    assert!(Dynamics::new(&rigid, &[true; 10], 1).is_ok());
    part.quads.clear();
    let mut empty = body(&part);
    empty.behaviour[0] = Behaviour::Rigid;
    refuses(Dynamics::new(&empty, &[true; 10], 1), &["no mass"]);
}

#[test]
fn refuses_a_time_step_that_is_not_positive() {
    let mut d = lay_out(&body(&rectangle(1.0, 1.0, 2, 2)));
    for dt in [0.0, -1e-9, f64::NAN, f64::INFINITY] {
        refuses(d.set_time_step(dt), &["time step [s]", "positive"]);
    }
}

#[test]
fn refuses_statics_without_support() {
    // A free plate under a load has no equilibrium; the error names body, place and advice.
    let model = body(&rectangle(1.0, 1.0, 2, 2));
    let mut d = lay_out(&model);
    let mut load = NodalLoad::new(vec![(slot(&d, 4) as u32, 1000.0, 0.0)]);
    let result = equilibrate(&mut d, &mut [&mut load], Vec::new(), 1e-6);
    refuses(
        result,
        &["did not converge", "iterations", "body `body`", "check that the load can reach a support"],
    );
}

#[test]
fn refuses_statics_of_what_is_not_a_number() {
    let mut model = body(&rectangle(1.0, 1.0, 2, 2));
    for n in 0..3 {
        model.motion[n] = NodeMotion::Held;
    }
    let mut d = lay_out(&model);
    let mut load = NodalLoad::new(vec![(slot(&d, 4) as u32, f64::NAN, 0.0)]);
    refuses(equilibrate(&mut d, &mut [&mut load], Vec::new(), 1e-6), &["NaN"]);
}

#[test]
fn invariant_a_held_body_is_already_in_equilibrium() {
    let mut model = body(&rectangle(1.0, 1.0, 2, 2));
    model.motion.fill(NodeMotion::Held);
    let mut d = lay_out(&model);
    let mut load = NodalLoad::new(vec![(slot(&d, 4) as u32, 1000.0, 0.0)]);
    let found = equilibrate(&mut d, &mut [&mut load], Vec::new(), 1e-6).expect("nothing can move");
    assert_eq!(found.iterations, 0);
}
