//! Stress of an element, as the program keeps it: in a frame that turns with the element.

/// Cauchy stress at the middle of a quadrilateral [Pa]: along both axes of its frame, across the plane, and
/// shear, for a St. Venant–Kirchhoff material of this Young's modulus [Pa] and Poisson's ratio in plane strain.
pub(super) fn stress(rest: &[[f64; 2]; 4], now: &[[f64; 2]; 4], [youngs, nu]: [f64; 2]) -> [f64; 4] {
    let f = gradient(rest, now);
    let (lame, shear) = (youngs * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), youngs / (2.0 * (1.0 + nu)));
    let green =
        |i: usize, j: usize| 0.5 * (f[0][i] * f[0][j] + f[1][i] * f[1][j] - if i == j { 1.0 } else { 0.0 });
    let out = lame * (green(0, 0) + green(1, 1));
    let s = |i: usize, j: usize| 2.0 * shear * green(i, j) + if i == j { out } else { 0.0 };
    let jacobian = f[0][0] * f[1][1] - f[0][1] * f[1][0];
    let cauchy = |i: usize, j: usize| {
        let sum = (0..2).flat_map(|k| (0..2).map(move |l| (k, l)));
        sum.map(|(k, l)| f[i][k] * s(k, l) * f[j][l]).sum::<f64>() / jacobian
    };
    let [c, n] = axis(now);
    let (xx, yy, xy) = (cauchy(0, 0), cauchy(1, 1), cauchy(0, 1));
    [
        c * c * xx + 2.0 * c * n * xy + n * n * yy,
        n * n * xx - 2.0 * c * n * xy + c * c * yy,
        out / jacobian,
        (c * c - n * n) * xy + c * n * (yy - xx),
    ]
}

/// Deformation gradient in the middle [-].
fn gradient(rest: &[[f64; 2]; 4], now: &[[f64; 2]; 4]) -> [[f64; 2]; 2] {
    let between = |of: &[[f64; 2]; 4], a: usize, b: usize| [of[a][0] - of[b][0], of[a][1] - of[b][1]];
    // Diagonals at rest, d and e, and now: F d = d', F e = e'.
    let (d, e) = (between(rest, 2, 0), between(rest, 3, 1));
    let (moved_d, moved_e) = (between(now, 2, 0), between(now, 3, 1));
    let cross = d[0] * e[1] - d[1] * e[0];
    let row = |i: usize| {
        [(moved_d[i] * e[1] - moved_e[i] * d[1]) / cross, (moved_e[i] * d[0] - moved_d[i] * e[0]) / cross]
    };
    [row(0), row(1)]
}

/// First axis of the frame of an element: halfway between the lines that join the middles of opposite sides,
/// the second turned back by a right angle.
fn axis(now: &[[f64; 2]; 4]) -> [f64; 2] {
    let half = |i: usize, signs: [f64; 4]| 0.5 * (0..4).map(|n| signs[n] * now[n][i]).sum::<f64>();
    let s = [0, 1].map(|i| half(i, [-1.0, 1.0, 1.0, -1.0]));
    let t = [0, 1].map(|i| half(i, [-1.0, -1.0, 1.0, 1.0]));
    let longer = t[0].hypot(t[1]) / s[0].hypot(s[1]);
    let both = [s[0] * longer + t[1], s[1] * longer - t[0]];
    let length = both[0].hypot(both[1]);
    both.map(|v| v / length)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// E = 2.5, ν = ¼ has λ = μ = 1. Stretched by 1.2 along x: Γ = ½(1.44 − 1) = 0.22, S = (0.66, 0.22, 0.22),
    /// σ = (1.2² · 0.66, 0.22, 0.22)/1.2. Turned by any angle, the frame turns with it.
    #[test]
    fn by_hand_stress_of_a_stretched_and_turned_square() {
        let rest = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        for angle in [0.0, 0.4, 2.5] {
            let (n, c) = f64::sin_cos(angle);
            let now = rest.map(|[x, y]| [c * 1.2 * x - n * y, n * 1.2 * x + c * y]);
            let found = stress(&rest, &now, [2.5, 0.25]);
            let expected = [1.2 * 0.66, 0.22 / 1.2, 0.22 / 1.2, 0.0];
            let off = found.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(off < 1e-14, "{angle}: {found:?}");
        }
        // Simple shear of 1 %, a triangle with its last corner twice: σ_xy = μγ to the first order, in a frame
        // that lies halfway, where it is the same.
        let rest = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.0, 1.0]];
        let found = stress(&rest, &rest.map(|[x, y]| [x + 1e-6 * y, y]), [2.5, 0.25]);
        let frame = 2.0 * axis(&rest)[1].atan2(axis(&rest)[0]);
        assert!((found[3] - 1e-6 * frame.cos()).abs() < 1e-11, "{found:?}");
        assert!((found[0] - 1e-6 * frame.sin()).abs() < 1e-11, "{found:?}");
    }
}
