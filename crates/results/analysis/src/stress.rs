//! Von Mises stress of every element, from the positions of its nodes.
//!
//! The deformation gradient at the centre of an element (THEORY §2.1), the second Piola–Kirchhoff stress of
//! the St. Venant–Kirchhoff material, pushed forward to Cauchy stress. Plane strain: σ_zz is λ times the
//! trace of the strain.

use std::collections::HashMap;

use stribeck_store::frames::Frame;
use stribeck_store::mesh_file::RunMesh;
use stribeck_theory::material::Material;

/// Lamé's constants [Pa].
#[derive(Debug, Clone, Copy)]
pub struct Lame {
    lambda: f64,
    mu: f64,
}

/// One element of a frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Cell {
    /// Its corners now [m], counter-clockwise.
    pub corners: Vec<[f64; 2]>,
    /// Von Mises stress at its centre [Pa].
    pub von_mises: f64,
}

impl Lame {
    /// From Young's modulus and Poisson's ratio.
    pub fn of(material: &Material) -> Self {
        let (e, nu) = (material.youngs_modulus, material.poissons_ratio);
        Self { lambda: e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), mu: e / (2.0 * (1.0 + nu)) }
    }

    /// Von Mises stress [Pa] of the deformation gradient `f`, rows first.
    pub fn von_mises(&self, f: [[f64; 2]; 2]) -> f64 {
        let strain = |i: usize, j: usize| {
            let unit = if i == j { 1.0 } else { 0.0 };
            0.5 * (f[0][i] * f[0][j] + f[1][i] * f[1][j] - unit)
        };
        let (xx, yy, xy) = (strain(0, 0), strain(1, 1), strain(0, 1));
        let pressure = self.lambda * (xx + yy);
        let s = [
            [pressure + 2.0 * self.mu * xx, 2.0 * self.mu * xy],
            [2.0 * self.mu * xy, pressure + 2.0 * self.mu * yy],
        ];
        let area = f[0][0] * f[1][1] - f[0][1] * f[1][0];
        // σ = F S Fᵀ / J; out of the plane F is 1.
        let cauchy = |i: usize, j: usize| {
            let sum: f64 = (0..2)
                .flat_map(|a| (0..2).map(move |b| (a, b)))
                .map(|(a, b)| f[i][a] * s[a][b] * f[j][b])
                .sum();
            sum / area
        };
        let (xx, yy, zz, xy) = (cauchy(0, 0), cauchy(1, 1), pressure / area, cauchy(0, 1));
        let squares = (xx - yy).powi(2) + (yy - zz).powi(2) + (zz - xx).powi(2);
        (0.5 * squares + 3.0 * xy * xy).sqrt()
    }
}

/// Elements whose corners are all in the frame. Elements of the cage, which is rigid, are left out.
pub fn cells(mesh: &RunMesh, frame: &Frame, lame: &Lame) -> Vec<Cell> {
    let place: HashMap<u32, [f64; 2]> =
        frame.nodes.iter().copied().zip(frame.displacement.iter().copied()).collect();
    let mut cells = Vec::new();
    for body in mesh.bodies.iter().filter(|b| b.name != "cage") {
        for element in mesh.elements_of(body) {
            let reference: Vec<[f64; 2]> = element.iter().map(|&n| mesh.reference[n as usize]).collect();
            let moved: Option<Vec<[f64; 2]>> = element
                .iter()
                .zip(&reference)
                .map(|(n, at)| place.get(n).map(|u| [at[0] + u[0], at[1] + u[1]]))
                .collect();
            if let Some(corners) = moved {
                let von_mises = von_mises(&reference, &corners, lame);
                cells.push(Cell { corners, von_mises });
            }
        }
    }
    cells
}

/// Von Mises stress [Pa] at the centre of an element with three or four corners, from their places free of
/// stress and now [m].
pub fn von_mises(reference: &[[f64; 2]], now: &[[f64; 2]], lame: &Lame) -> f64 {
    lame.von_mises(gradient(reference, now))
}

/// Deformation gradient at the centre of an element with three or four corners.
fn gradient(reference: &[[f64; 2]], now: &[[f64; 2]]) -> [[f64; 2]; 2] {
    // Two directions span the element: the diagonals of a quadrilateral, two edges of a triangle.
    let spans = |p: &[[f64; 2]]| match p {
        [a, b, c, d] => [[a[0] - c[0], a[1] - c[1]], [b[0] - d[0], b[1] - d[1]]],
        [a, b, c] => [[a[0] - c[0], a[1] - c[1]], [b[0] - c[0], b[1] - c[1]]],
        _ => [[1.0, 0.0], [0.0, 1.0]],
    };
    let ([p, q], [a, b]) = (spans(reference), spans(now));
    let det = p[0] * q[1] - p[1] * q[0];
    // F maps p to a and q to b.
    let row = |i: usize| [(a[i] * q[1] - b[i] * p[1]) / det, (b[i] * p[0] - a[i] * q[0]) / det];
    [row(0), row(1)]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn steel() -> Lame {
        Lame::of(&Material { youngs_modulus: 200e9, poissons_ratio: 0.3, density: 7850.0 })
    }

    #[test]
    fn by_hand_uniaxial_strain_and_shear() {
        // ε_xx = 1e-6 alone: σ = (λ+2µ, λ, λ) ε, so the von Mises stress is 2µ ε.
        let (lame, e) = (steel(), 1e-6);
        let stress = lame.von_mises([[1.0 + e, 0.0], [0.0, 1.0]]);
        assert!((stress / (2.0 * lame.mu * e) - 1.0).abs() < 1e-5, "{stress}");
        // Simple shear γ: √3 µ γ.
        let stress = lame.von_mises([[1.0, e], [0.0, 1.0]]);
        assert!((stress / (3f64.sqrt() * lame.mu * e) - 1.0).abs() < 1e-5, "{stress}");
    }

    #[test]
    fn invariant_rotation_is_without_stress() {
        let turn = |p: [f64; 2]| [0.6 * p[0] - 0.8 * p[1] + 3.0, 0.8 * p[0] + 0.6 * p[1]];
        for corners in
            [vec![[0.0, 0.0], [1.0, 0.1], [1.2, 1.0], [-0.1, 0.9]], vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]]
        {
            let turned: Vec<[f64; 2]> = corners.iter().copied().map(turn).collect();
            let f = gradient(&corners, &turned);
            assert!((f[0][0] - 0.6).abs() < 1e-12 && (f[1][0] - 0.8).abs() < 1e-12, "{f:?}");
            assert!(steel().von_mises(f) < 1.0, "{} Pa", steel().von_mises(f));
        }
    }
}
