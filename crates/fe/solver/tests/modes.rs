//! Natural modes by Lanczos iteration: against a dense solution of the same mesh, and against Love's ring.

use std::f64::consts::TAU;

use faer::{Mat, Side};
use stribeck_mesh::{Annulus, Mesh};
use stribeck_solver::{
    Dynamics, Elastic, Model,
    statics::{SmallMotions, modes_below},
};
use stribeck_testing::ledger::compare;

/// (2π · 200 Hz)².
const SHIFT: f64 = 1.6e6;

fn ring(facets: usize, layers: usize, inner: f64, outer: f64) -> (Dynamics, Elastic) {
    let ring = Annulus {
        inner_radius: inner,
        outer_radius: outer,
        facets,
        layers,
        start_angle: 0.0,
        grooves: Vec::new(),
    };
    let mut mesh = Mesh::new();
    mesh.add("ring", &ring.part().expect("a ring"));
    let steel = Elastic::new(208e9, 0.3, 7800.0).expect("steel");
    let model = Model::new(mesh, steel, 0.02).expect("a model");
    let loaded = vec![false; model.mesh.x.len()];
    (Dynamics::new(&model, &loaded, 1).expect("a ring can move"), steel)
}

fn motions(dynamics: &Dynamics) -> SmallMotions {
    let slots: Vec<u32> =
        (0..dynamics.state.x.len() as u32).filter(|&n| dynamics.mass()[n as usize] > 0.0).collect();
    SmallMotions::new(dynamics, &slots, &[], SHIFT).expect("definite with the shift")
}

/// Every eigenvalue of the whole matrix, by a dense solution: none is missing, none is there twice, and each
/// is right to 1e-8.
#[test]
fn invariant_modes_are_those_of_the_whole_matrix() {
    const TOLERANCE: f64 = 1e-8;
    let (dynamics, _) = ring(32, 2, 0.08, 0.1);
    let mut motions = motions(&dynamics);
    let n = motions.equations();
    let root: Vec<f64> = motions.mass().iter().map(|m| m.sqrt()).collect();
    let columns: Vec<Vec<f64>> = (0..n)
        .map(|i| {
            let mut unit = vec![0.0; n];
            unit[i] = 1.0 / root[i];
            motions.stiffness_times(&unit)
        })
        .collect();
    let matrix = Mat::from_fn(n, n, |i, j| columns[j][i] / root[i]);
    // Values alone: with vectors faer 0.24.4 misses one of each pair of this matrix by up to 4e-4, and the
    // matrix itself by 2e-4.
    let values = matrix.self_adjoint_eigenvalues(Side::Lower).expect("symmetric");
    let limit = 20e3;
    let dense: Vec<f64> = values.iter().copied().filter(|s| s.max(0.0).sqrt() < TAU * limit).collect();
    let found = modes_below(&mut motions, limit).expect("modes");
    assert_eq!(found.squares.len(), dense.len());
    for (ours, theirs) in found.squares.iter().zip(&dense).skip(3) {
        assert!((ours / theirs - 1.0).abs() < TOLERANCE, "{ours} {theirs}");
    }
    // The rigid motions have none, but for rounding against the highest.
    let highest = values.iter().copied().fold(0.0, f64::max);
    assert!(found.squares[..3].iter().all(|s| s.abs() < 1e-12 * highest), "{:?}", &found.squares[..3]);
    for (i, a) in found.shapes.iter().enumerate() {
        for (j, b) in found.shapes.iter().enumerate() {
            let product: f64 = a.iter().zip(b).zip(motions.mass()).map(|((a, b), m)| a * b * m).sum();
            assert!(
                (product - f64::from(u8::from(i == j))).abs() < TOLERANCE,
                "modes {i} and {j}: {product}"
            );
        }
    }
}

/// All motions of a mesh so small that the last block has no room for as many vectors as the others: each is
/// there once.
#[test]
fn invariant_all_modes_of_a_small_mesh_are_found() {
    let (dynamics, _) = ring(9, 2, 0.08, 0.1);
    let mut motions = motions(&dynamics);
    let n = motions.equations();
    assert_eq!(n % 4, 2, "{n} equations");
    let found = modes_below(&mut motions, 1e9).expect("modes");
    assert_eq!(found.squares.len(), n);
    for (i, a) in found.shapes.iter().enumerate() {
        for (k, b) in found.shapes.iter().enumerate() {
            let product: f64 = a.iter().zip(b).zip(motions.mass()).map(|((a, b), m)| a * b * m).sum();
            assert!((product - f64::from(u8::from(i == k))).abs() < 1e-8, "{i}, {k}: {product}");
        }
    }
}

/// A thin free ring bends at f = n (n² − 1)/(2πR²) √(E'I/(ρA(n² + 1))) (Love, *A Treatise on the Mathematical
/// Theory of Elasticity*, 1944, §293).
///
/// ```text
///              . ─ ─ ─ ─ .
///          ╱ ╱             ╲ ╲          628 × 4 squares of 1 mm, bore 98 mm, outside 102 mm
///        ╱ ╱     mode n = 2   ╲ ╲
///       │ │    ←  ─  ┼  ─  →   │ │      free: three rigid motions, then pairs of n = 2, 3, 4
///        ╲ ╲                  ╱ ╱
///          ╲ ╲             ╱ ╱          E = 208 GPa, ν = 0.3, ρ = 7800 kg/m³, E' = E/(1 − ν²)
///              ' ─ ─ ─ ─ '
/// ```
#[test]
fn analytic_a_free_ring_has_the_frequencies_of_love() {
    /// Shear and rotary inertia, which Love leaves out, lower a frequency by about n² (h/R)²/3 = 0.9 % for n
    /// = 4.
    const TOLERANCE: f64 = 0.01;
    let (dynamics, steel) = ring(628, 4, 0.098, 0.102);
    let found = modes_below(&mut motions(&dynamics), 3000.0).expect("modes");
    let frequency = |k: usize| found.squares[k].sqrt() / TAU;
    let bending = steel.plane_strain_modulus() * 0.004_f64.powi(2) / (12.0 * steel.density());
    for n in 2..=4 {
        let order = f64::from(n);
        let love = order * (order * order - 1.0) / (TAU * 0.01) * (bending / (order * order + 1.0)).sqrt();
        // Three rigid motions, then pairs.
        let at = 3 + 2 * (n as usize - 2);
        compare(
            &format!("free thin ring, mode {n} by Lanczos iteration"),
            "Love 1944, §293",
            "Hz",
            frequency(at),
            love,
            TOLERANCE,
        );
        assert!((frequency(at + 1) / frequency(at) - 1.0).abs() < 1e-4, "a pair");
    }
}
