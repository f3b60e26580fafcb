//! The characteristic length of an element: its own critical time step as a length.

use crate::part::signed_area;

/// Length L [m] such that the critical time step of the element alone is L / c_p.
///
/// c_p = √((λ + 2µ)/ρ) is the speed of pressure waves and 2/ω_max the critical step of central differences.
/// L = 2 c_p / ω_max therefore depends only on the shape and on Poisson's ratio.
///
/// With B the strain–displacement matrix at the centre (three strains, plane strain), A the area and a
/// quarter (third) of the mass at each node of a one-point quadrilateral (constant-strain triangle), the
/// stiffness is A BᵀCB and ω² = (4/ρ) λ_max(BᵀCB), or 3/ρ for the triangle. BᵀCB has the nonzero eigenvalues
/// of C·BBᵀ, and BBᵀ holds only the sums s_xx, s_yy, s_xy of products of the shape function gradients. In
/// the axes in which s_xy vanishes, with p and q the two values left, the three eigenvalues are
///
/// ```text
/// µ (p + q)    and    ½ [ M (p + q) ± √( M² (p − q)² + 4 λ² p q ) ],    M = λ + 2µ
/// ```
///
/// and p + q, (p − q)² and p q are invariants, so no axes need to be found. A square of side h has
/// L = h √(1 − ν), an equilateral triangle L = a √(2 (1 − ν) / 3). Assembling elements never gives a
/// frequency above that of the worst element, so the smallest L bounds the step of the whole mesh. Hourglass
/// stiffness is not counted: its coefficient must keep it below ω_max.
///
/// `corners` are three or four points [m] in counter-clockwise order, `poisson` lies between −1 and 0.5.
/// The length is zero when the area is not positive, and NaN for any other number of corners.
///
/// Source: Flanagan and Belytschko, *A uniform strain hexahedron and quadrilateral with orthogonal hourglass
/// control*, Int. J. Numer. Meth. Engng 17 (1981) 679–706, who bound the same eigenvalue from above.
pub fn characteristic_length(corners: &[[f64; 2]], poisson: f64) -> f64 {
    let nodes = corners.len();
    if !(nodes == 3 || nodes == 4) {
        return f64::NAN;
    }
    let area = signed_area(corners);
    if area.is_nan() || area <= 0.0 {
        return 0.0;
    }
    // Sums of products of the gradients, times 4A². Opposite corners of the quadrilateral have opposite
    // gradients made of the other diagonal; a gradient of the triangle is made of the opposite side.
    let (mut xx, mut yy, mut xy) = (0.0, 0.0, 0.0);
    for i in 0..nodes {
        let [x1, y1] = corners[(i + 1) % nodes];
        let [x2, y2] = corners[(i + nodes - 1) % nodes];
        let (bx, by) = (y1 - y2, x2 - x1);
        xx += bx * bx;
        yy += by * by;
        xy += bx * by;
    }
    let trace = xx + yy;
    let difference = (xx - yy) * (xx - yy) + 4.0 * xy * xy;
    let product = xx * yy - xy * xy;
    // Moduli divided by M.
    let lambda = poisson / (1.0 - poisson);
    let mu = 0.5 * (1.0 - lambda);
    let pressure = 0.5 * (trace + (difference + 4.0 * lambda * lambda * product).sqrt());
    let largest = pressure.max(mu * trace);
    2.0 * area * (4.0 / (nodes as f64 * largest)).sqrt()
}

/// Smallest sine of the corner angles: 1 for a rectangle, zero or less when a corner is flat or turned over.
pub(crate) fn smallest_sine(corners: &[[f64; 2]]) -> f64 {
    let n = corners.len();
    let mut smallest = f64::INFINITY;
    for i in 0..n {
        let ([x, y], [x1, y1], [x2, y2]) = (corners[i], corners[(i + 1) % n], corners[(i + n - 1) % n]);
        let (ax, ay, bx, by) = (x1 - x, y1 - y, x2 - x, y2 - y);
        let lengths = ((ax * ax + ay * ay) * (bx * bx + by * by)).sqrt();
        smallest = smallest.min((ax * by - ay * bx) / lengths.max(f64::MIN_POSITIVE));
    }
    smallest
}
