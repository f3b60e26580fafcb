//! A column sinks under its own weight, and stays in equilibrium when time begins.
//!
//! # Goal
//!
//! Gravity in statics, and a run that starts from equilibrium without ringing.
//!
//! # Mesh
//!
//! ```text
//!      60──61──62   top: sinks by u
//!    ▷  │   │   │  ◁
//!      57──58──59        ↓ g
//!    ▷  │   │   │  ◁
//!       ⋮   ⋮   ⋮         H = 200 mm, 20 rows
//!    ▷  │   │   │  ◁
//!       0───1───2
//!       ▧   ▧   ▧        20 mm, 2 columns
//! ```
//!
//! # Boundary conditions
//!
//! The base is held. In statics all other nodes are held in x, as between walls without friction (uniaxial
//! strain); in the run in time the sides are free.
//!
//! # Parameters
//!
//! g = 9.81 m/s², E = 208 GPa, ν = 0.3, ρ = 7800 kg/m³.
//!
//! # Expected
//!
//! u = ρ g H²/(2 (λ + 2µ)), with lumped masses exactly. In time nothing moves.

use stribeck_solver::NodeMotion;
use stribeck_testing::assert_close;

use crate::ROUNDING;
use crate::common::*;

/// The top's 7 nm are a difference of positions of 0.2 m, which round to 3e-17 m, and of forces balanced to
/// [`ROUNDING`], beside a weight of 2 N.
const SINKS: f64 = 1e-5;

/// Without preload the top would swing by twice its static 7 nm [m].
const MOVED: f64 = 1e-12;

#[test]
fn by_hand_column_under_its_weight() {
    let height = 0.2;
    let mut model = body(&rectangle(0.02, height, 2, 20));
    model.gravity = [0.0, -9.81];
    for n in 0..model.mesh.x.len() {
        model.motion[n] = if n < 3 { NodeMotion::Held } else { NodeMotion::HeldX };
    }
    let mut d = lay_out(&model);
    equilibrate(&mut d, &mut [], Vec::new(), ROUNDING).expect("a held column");
    let s = steel();
    let sinks = s.density() * 9.81 * height * height / (2.0 * (s.lame() + 2.0 * s.shear()));
    let top = slot(&d, model.mesh.x.len() - 1);
    assert_close(height - d.state.y[top], sinks, SINKS, "the top sinks");
}

#[test]
fn behaves_a_run_from_equilibrium_does_not_ring() {
    let mut model = body(&rectangle(0.02, 0.2, 2, 20));
    model.gravity = [0.0, -9.81];
    for n in 0..3 {
        model.motion[n] = NodeMotion::Held;
    }
    let mut d = ready(&model, 0.9);
    equilibrate(&mut d, &mut [], Vec::new(), ROUNDING).expect("a held column");
    let before = d.state.y.clone();
    run(&mut d, &mut [], 5000);
    let moved = d.state.y.iter().zip(&before).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
    assert!(moved < MOVED, "{moved:e} m");
}
