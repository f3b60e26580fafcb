//! The kernels for elements outside strips: one by one, or the same element of congruent bodies at a time.

use crate::{
    element::triangle_forces,
    lanes::{LANES, Lanes, lanes, lanes_mut},
    tile::Tile,
};

/// The gather path: elements one by one.
#[inline(always)]
pub(crate) fn single_elements(tile: &Tile, x: &[f64], y: &[f64], fx: &mut [f64], fy: &mut [f64]) {
    for (corners, metric) in &tile.quads {
        let c = corners.map(|c| c as usize);
        let f = metric.forces(c.map(|c| x[c]), c.map(|c| y[c]));
        for (c, f) in c.into_iter().zip(f) {
            fx[c] += f[0];
            fy[c] += f[1];
        }
    }
    for (corners, reference) in &tile.triangles {
        let c = corners.map(|c| c as usize);
        let [f1, f2] = triangle_forces(c.map(|c| x[c]), c.map(|c| y[c]), reference, &tile.stiffness);
        fx[c[0]] += f1[0];
        fy[c[0]] += f1[1];
        fx[c[1]] += f2[0];
        fy[c[1]] += f2[1];
        fx[c[2]] -= f1[0] + f2[0];
        fy[c[2]] -= f1[1] + f2[1];
    }
}

#[inline(always)]
fn add_lanes(v: &mut [f64], at: usize, f: &Lanes) {
    let v = lanes_mut(v, at);
    for l in 0..LANES {
        v[l] += f[l];
    }
}

/// The same quadrilateral of [`LANES`] congruent bodies at a time.
#[inline(always)]
pub(crate) fn congruent_quads(tile: &Tile, x: &[f64], y: &[f64], fx: &mut [f64], fy: &mut [f64]) {
    for (corners, metric) in &tile.quads {
        let c = [corners[0] as usize, corners[1] as usize, corners[2] as usize, corners[3] as usize];
        // Spelled out: a closure is not sure to be compiled for the wide registers.
        let xs = [lanes(x, c[0]), lanes(x, c[1]), lanes(x, c[2]), lanes(x, c[3])];
        let ys = [lanes(y, c[0]), lanes(y, c[1]), lanes(y, c[2]), lanes(y, c[3])];
        let ([mut f1x, mut f2x, mut f3x, mut f4x], [mut f1y, mut f2y, mut f3y, mut f4y]) =
            ([[0.0; LANES]; 4], [[0.0; LANES]; 4]);
        for l in 0..LANES {
            let px = [xs[0][l], xs[1][l], xs[2][l], xs[3][l]];
            let py = [ys[0][l], ys[1][l], ys[2][l], ys[3][l]];
            let [f1, f2, f3, f4] = metric.forces(px, py);
            [f1x[l], f2x[l], f3x[l], f4x[l]] = [f1[0], f2[0], f3[0], f4[0]];
            [f1y[l], f2y[l], f3y[l], f4y[l]] = [f1[1], f2[1], f3[1], f4[1]];
        }
        for (c, f) in c.into_iter().zip([&f1x, &f2x, &f3x, &f4x]) {
            add_lanes(fx, c, f);
        }
        for (c, f) in c.into_iter().zip([&f1y, &f2y, &f3y, &f4y]) {
            add_lanes(fy, c, f);
        }
    }
}

/// The same triangle of [`LANES`] congruent bodies at a time.
#[inline(always)]
pub(crate) fn congruent_triangles(tile: &Tile, x: &[f64], y: &[f64], fx: &mut [f64], fy: &mut [f64]) {
    let k = tile.stiffness;
    for (corners, reference) in &tile.triangles {
        let c = corners.map(|c| c as usize);
        let xs = [lanes(x, c[0]), lanes(x, c[1]), lanes(x, c[2])];
        let ys = [lanes(y, c[0]), lanes(y, c[1]), lanes(y, c[2])];
        let ([mut f1x, mut f2x, mut f3x], [mut f1y, mut f2y, mut f3y]) =
            ([[0.0; LANES]; 3], [[0.0; LANES]; 3]);
        for l in 0..LANES {
            let px = [xs[0][l], xs[1][l], xs[2][l]];
            let py = [ys[0][l], ys[1][l], ys[2][l]];
            let [f1, f2] = triangle_forces(px, py, reference, &k);
            [f1x[l], f2x[l], f3x[l]] = [f1[0], f2[0], -f1[0] - f2[0]];
            [f1y[l], f2y[l], f3y[l]] = [f1[1], f2[1], -f1[1] - f2[1]];
        }
        for (c, f) in c.into_iter().zip([&f1x, &f2x, &f3x]) {
            add_lanes(fx, c, f);
        }
        for (c, f) in c.into_iter().zip([&f1y, &f2y, &f3y]) {
            add_lanes(fy, c, f);
        }
    }
}
