//! A ring that spins, in the frame that turns with it.
//!
//! Timoshenko and Goodier, *Theory of Elasticity* (1970), §32, the rotating disc with a hole.
//!
//! # Goal
//!
//! Body forces in statics: accelerations that are given node by node.
//!
//! # Mesh
//!
//! ```text
//!                  ↑
//!              . ─ ─ ─ ─ ─ .
//!          ╱       .─.       ╲
//!        ╱       ╱     ╲       ╲       96 × 12 cells
//!     ← │       (   ↺ ω )       │ →    node 0 on the bore at θ = 0, rows outwards
//!        ╲       ╲     ╱       ╱
//!          ╲       '─'       ╱
//!              ' ─ ─ ─ ─ ─ '
//!                  ↓
//!        a = 50 mm       b = 100 mm
//! ```
//!
//! # Boundary conditions
//!
//! The acceleration of each node is −ω² r; both surfaces are free.
//!
//! # Parameters
//!
//! ω = 500 rad/s, E = 208 GPa, ν = 0.3, ρ = 7800 kg/m³.
//!
//! # Expected
//!
//! In plane stress σ_θ = ρω²/8 [(3 + ν)(a² + b² + a² b²/r²) − (1 + 3ν) r²], and u = r σ_θ/E where σ_r
//! vanishes, at r = a and r = b. Plane strain by E → E/(1 − ν²), ν → ν/(1 − ν).

use stribeck_testing::ledger;

use crate::common::*;
use crate::{INNER, OUTER, ROUNDING, growth, ring};

/// Of second order with 12 layers, as the thick cylinder; the load lies farther outside, on the lumped masses
/// of the polygon.
const DISPLACEMENT: f64 = 4e-3;

#[test]
fn analytic_spinning_ring() {
    let rate = 500.0;
    let s = steel();
    let (e, nu) = (s.plane_strain_modulus(), s.poissons_ratio() / (1.0 - s.poissons_ratio()));
    let (a2, b2) = (INNER * INNER, OUTER * OUTER);
    let q = s.density() * rate * rate / 8.0;
    let exact = |r: f64| {
        let hoop = q * ((3.0 + nu) * (a2 + b2 + a2 * b2 / (r * r)) - (1.0 + 3.0 * nu) * r * r);
        r * hoop / e
    };
    let (facets, layers) = (96, 12);
    let model = ring(facets, layers);
    let mut d = lay_out(&model);
    let inward = |n: usize| [-rate * rate * d.state.x[n], -rate * rate * d.state.y[n]];
    let acceleration: Vec<_> = (0..d.state.x.len()).map(inward).collect();
    equilibrate(&mut d, &mut [], acceleration, ROUNDING).expect("a balanced load");

    let source = "Timoshenko and Goodier 1970, §32";
    let bore = growth(&d, &model, 0, facets);
    ledger::compare("spinning ring, bore", source, "m", bore, exact(INNER), DISPLACEMENT);
    let rim = growth(&d, &model, layers * facets, facets);
    ledger::compare("spinning ring, rim", source, "m", rim, exact(OUTER), DISPLACEMENT);
}
