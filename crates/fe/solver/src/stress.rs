//! Stress at the centre of an element, from the positions of its nodes.
//!
//! The deformation gradient there (THEORY §2.1), the second Piola–Kirchhoff stress of the St. Venant–Kirchhoff
//! material, pushed forward to Cauchy stress. Plane strain: σ_zz is λ times the trace of the strain.

use crate::material::Elastic;

/// Cauchy stress in the axes of the plane [Pa], tension positive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stress {
    /// Along x.
    pub xx: f64,
    /// Along y.
    pub yy: f64,
    /// Out of the plane.
    pub zz: f64,
    /// Shear.
    pub xy: f64,
}

impl Stress {
    /// At the centre of an element of three or four corners, from their places free of stress and now [m], both
    /// counter-clockwise.
    pub fn of(material: &Elastic, reference: &[[f64; 2]], now: &[[f64; 2]]) -> Self {
        Self::of_gradient(material, gradient(reference, now))
    }

    /// Of the deformation gradient `f`, rows first.
    pub fn of_gradient(material: &Elastic, f: [[f64; 2]; 2]) -> Self {
        let strain = |i: usize, j: usize| {
            let unit = if i == j { 1.0 } else { 0.0 };
            0.5 * (f[0][i] * f[0][j] + f[1][i] * f[1][j] - unit)
        };
        let (xx, yy, xy) = (strain(0, 0), strain(1, 1), strain(0, 1));
        let (pressure, shear) = (material.lame() * (xx + yy), material.shear());
        let s = [
            [pressure + 2.0 * shear * xx, 2.0 * shear * xy],
            [2.0 * shear * xy, pressure + 2.0 * shear * yy],
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
        Self { xx: cauchy(0, 0), yy: cauchy(1, 1), zz: pressure / area, xy: cauchy(0, 1) }
    }

    /// Von Mises stress [Pa].
    pub fn von_mises(&self) -> f64 {
        let Self { xx, yy, zz, xy } = self;
        let squares = (xx - yy).powi(2) + (yy - zz).powi(2) + (zz - xx).powi(2);
        (0.5 * squares + 3.0 * xy * xy).sqrt()
    }
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

    fn steel() -> Elastic {
        Elastic::new(200e9, 0.3, 7850.0).unwrap()
    }

    #[test]
    fn by_hand_uniaxial_strain_and_shear() {
        // ε_xx = 1e-6 alone: σ = (λ+2µ, λ, λ) ε, so the von Mises stress is 2µ ε.
        let (steel, e) = (steel(), 1e-6);
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let stress = Stress::of(&steel, &square, &square.map(|[x, y]| [(1.0 + e) * x, y]));
        assert!((stress.xx / ((steel.lame() + 2.0 * steel.shear()) * e) - 1.0).abs() < 1e-5, "{stress:?}");
        assert!((stress.zz / (steel.lame() * e) - 1.0).abs() < 1e-5, "{stress:?}");
        assert!((stress.von_mises() / (2.0 * steel.shear() * e) - 1.0).abs() < 1e-5, "{stress:?}");
        // Simple shear γ: √3 µ γ.
        let stress = Stress::of_gradient(&steel, [[1.0, e], [0.0, 1.0]]).von_mises();
        assert!((stress / (3f64.sqrt() * steel.shear() * e) - 1.0).abs() < 1e-5, "{stress}");
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
            let stress = Stress::of(&steel(), &corners, &turned).von_mises();
            assert!(stress < 1.0, "{stress} Pa");
        }
    }
}
