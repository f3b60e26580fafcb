//! One damped element vibrates; halving the time step quarters the error.
//!
//! THEORY §2.8, (2.35) for one node; leapfrog is of second order: Hairer, Lubich and Wanner, *Acta Numerica*
//! 12 (2003).
//!
//! # Goal
//!
//! The observed order of the time integration with the springs of damping in it.
//!
//! # Mesh
//!
//! ```text
//!    ▧ 2──────3  → vx   ▽△
//!    ▧ │      │         L = 2 mm, one square
//!    ▧ 0──────1  → vx   ▽△
//! ```
//!
//! # Boundary conditions
//!
//! Nodes 0 and 2 are held in x and y, nodes 1 and 3 in y: two nodes on one spring.
//!
//! # Parameters
//!
//! v = 1 mm/s, E = 208 GPa, ν = 0.3, ρ = 7800 kg/m³; one branch of g = 0.3 and τ = 0.45/ω; to t = 20/ω in
//! 100, 200 and 400 steps, each of which evaluates the branch.
//!
//! # Expected
//!
//! x' = v, v' = −ω² (x + g u), u' = v − u/τ with ω² = 2c²/L² for half the mass of the element, integrated by
//! the classical Runge–Kutta method in 40 000 steps.

use stribeck_solver::{NodeMotion, structural_damping::Branch};
use stribeck_testing::orders;

use crate::common::*;
use crate::damp;

/// How far an order may be from two: the coarsest step, 0.2 of a radian, has a term of fourth order beside
/// that of second.
const ORDER: f64 = 0.1;

#[test]
fn converges_with_the_square_of_the_time_step() {
    let length = 2e-3;
    let mut model = body(&rectangle(length, length, 1, 1));
    for n in 0..4 {
        model.motion[n] = if model.mesh.x[n] > 0.5 * length { NodeMotion::HeldY } else { NodeMotion::Held };
    }
    let omega = 2.0_f64.sqrt() * steel().dilatational_speed() / length;
    let branch = Branch { stiffness: 0.3, relaxation_time: 0.45 / omega };
    let (end, speed) = (20.0 / omega, 1e-3);
    // x' = v, v' = −ω²(x + g u), u' = v − u/τ by the classical Runge–Kutta method in steps too small to
    // matter.
    let rate = |[x, v, u]: [f64; 3]| {
        [v, -omega * omega * (x + branch.stiffness * u), v - u / branch.relaxation_time]
    };
    let mut exact = [0.0, speed, 0.0];
    let small = end / 40_000.0;
    for _ in 0..40_000 {
        let at = |k: [f64; 3], h: f64| std::array::from_fn(|i| exact[i] + h * k[i]);
        let k1 = rate(exact);
        let k2 = rate(at(k1, 0.5 * small));
        let k3 = rate(at(k2, 0.5 * small));
        let k4 = rate(at(k3, small));
        exact = std::array::from_fn(|i| exact[i] + small / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
    }
    let errors: Vec<f64> = [100, 200, 400]
        .into_iter()
        .map(|steps| {
            let mut d = lay_out(&model);
            damp(&mut d, branch, vec![0], 0.5);
            d.set_time_step(end / f64::from(steps)).expect("a positive step");
            let right = (0..4).find(|&n| model.motion[n] == NodeMotion::HeldY).expect("two nodes are free");
            let n = slot(&d, right);
            let free: Vec<usize> = massive(&d).into_iter().filter(|&s| d.state.x[s] > 0.5 * length).collect();
            free.into_iter().for_each(|s| d.state.vx[s] = speed);
            run(&mut d, &mut [], steps as usize);
            (d.state.x[n] - length - exact[0]).abs() / (speed / omega)
        })
        .collect();
    println!("errors {errors:?}, orders {:?}", orders(&errors));
    assert!(orders(&errors).into_iter().all(|order| (order - 2.0).abs() < ORDER), "{errors:?}");
}
