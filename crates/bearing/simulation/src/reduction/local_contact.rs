//! The local contact problem: two surfaces pressed together at a place, each with the flexibility of its
//! nodes (THEORY §9.3).

/// Two surfaces that are pressed together.
#[derive(Debug, Clone)]
pub struct LocalContact<'a> {
    /// Distance of the nodes of raceway and roller [m].
    pub spacing: [f64; 2],
    /// Displacement of node i by a unit force at node j [m/N], square, by rows; the middle node lies under
    /// the contact.
    pub flexibility: [&'a [Vec<f64>]; 2],
    /// Relative radius of curvature [m].
    pub radius: f64,
    /// Penalty stiffness times thickness [N/m²].
    pub penalty: f64,
}

/// An integration point: the gap between the undeformed surfaces [m], and the nodes whose displacements
/// change it, with their shares: two of each surface.
struct Point {
    gap: f64,
    nodes: [(usize, f64); 4],
}

/// Integration points on a facet, or on half the contact where that is shorter.
const POINTS: usize = 16;

/// Most Newton iterations, and the unbalanced share of the force at which they end.
const ITERATIONS: usize = 60;
const BALANCED: f64 = 1e-10;

impl LocalContact<'_> {
    /// Force [N] at the approach `delta` [m], with the middle nodes off the contact's middle by these shares
    /// of a facet.
    pub fn force(&self, delta: f64, phase: [f64; 2]) -> f64 {
        let touching = (2.0 * self.radius * delta).sqrt();
        let step = (self.spacing[0].min(self.spacing[1]).min(touching)) / POINTS as f64;
        let points = self.points(touching, step, phase);
        let weight = self.penalty * step;
        // Newton's method for the nodal forces f: surfaces move by A f, and f follows from the gaps.
        let mut f = vec![0.0; self.nodes()];
        let mut result = 0.0;
        for _ in 0..ITERATIONS {
            let moved = self.moved(&f);
            let (total, load, tangent) = integrate(&points, &moved, delta, weight);
            result = total;
            let matrix = self.newton(&f, &load, &tangent);
            let unbalanced = matrix.iter().map(|row| row[f.len()].abs()).fold(0.0_f64, f64::max);
            if unbalanced <= BALANCED * result.max(1e-9) {
                break;
            }
            f.iter_mut().zip(eliminate(matrix)).for_each(|(f, df)| *f += df);
        }
        result
    }

    /// Approach of rigid surfaces on the penalty alone at a force [m]: q = k ∫(δ − x²/2R) dx = (4/3) k δ
    /// √(2Rδ).
    pub fn rigid(&self, force: f64) -> f64 {
        libm::pow(0.75 * force / (self.penalty * (2.0 * self.radius).sqrt()), 2.0 / 3.0)
    }

    /// Nodes of both surfaces.
    fn nodes(&self) -> usize {
        self.flexibility.iter().map(|of| of.len()).sum()
    }

    /// Number of the first node of each surface, and how many it has.
    fn bodies(&self) -> [(usize, usize, usize); 2] {
        let [a, b] = self.flexibility.map(<[_]>::len);
        [(0, 0, a), (1, a, b)]
    }

    /// Integration points over the contact and one step [m] beyond it.
    fn points(&self, touching: f64, step: f64, phase: [f64; 2]) -> Vec<Point> {
        let half = touching + step;
        let points = (2.0 * half / step).ceil() as usize;
        let shares = |(body, first, n): (usize, usize, usize), x: f64| {
            let at = x / self.spacing[body] - phase[body] + (n / 2) as f64;
            let i = (at.floor().max(0.0) as usize).min(n.saturating_sub(2));
            let t = (at - i as f64).clamp(0.0, 1.0);
            [(first + i, 1.0 - t), (first + i + 1, t)]
        };
        let [raceway, roller] = self.bodies();
        let point = |x: f64| {
            let ([a, b], [c, d]) = (shares(raceway, x), shares(roller, x));
            Point { gap: x * x / (2.0 * self.radius), nodes: [a, b, c, d] }
        };
        (0..points).map(|i| point((i as f64 + 0.5) * step - half)).collect()
    }

    /// Displacements of all nodes under nodal forces [m].
    fn moved(&self, f: &[f64]) -> Vec<f64> {
        let mut moved = vec![0.0; f.len()];
        for (body, first, n) in self.bodies() {
            for i in 0..n {
                moved[first + i] = (0..n).map(|j| self.flexibility[body][i][j] * f[first + j]).sum();
            }
        }
        moved
    }

    /// The system of a Newton step with its right-hand side in the last column. load(f) − f = 0 with d load =
    /// −T A df: (1 + T A) df = load − f.
    fn newton(&self, f: &[f64], load: &[f64], tangent: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let total = f.len();
        let mut matrix = vec![vec![0.0; total + 1]; total];
        for i in 0..total {
            for (body, first, n) in self.bodies() {
                for j in 0..n {
                    matrix[i][first + j] =
                        (0..n).map(|k| tangent[i][first + k] * self.flexibility[body][k][j]).sum();
                }
            }
            matrix[i][i] += 1.0;
            matrix[i][total] = load[i] - f[i];
        }
        matrix
    }
}

/// Total force [N], nodal forces [N] and their derivatives by nodal displacements [N/m], where surfaces have
/// moved at their nodes.
fn integrate(points: &[Point], moved: &[f64], delta: f64, weight: f64) -> (f64, Vec<f64>, Vec<Vec<f64>>) {
    let total = moved.len();
    let (mut force, mut load) = (0.0, vec![0.0; total]);
    let mut tangent = vec![vec![0.0; total]; total];
    for Point { gap, nodes } in points {
        let given: f64 = nodes.iter().map(|&(i, s)| s * moved[i]).sum();
        let depth = delta - gap - given;
        if depth <= 0.0 {
            continue;
        }
        force += weight * depth;
        for &(i, s) in nodes {
            load[i] += weight * s * depth;
            for &(j, r) in nodes {
                tangent[i][j] += weight * s * r;
            }
        }
    }
    (force, load, tangent)
}

/// Gaussian elimination with partial pivoting; the last column is the right-hand side.
fn eliminate(mut a: Vec<Vec<f64>>) -> Vec<f64> {
    let n = a.len();
    for c in 0..n {
        let pivot = (c..n).max_by(|&i, &j| a[i][c].abs().total_cmp(&a[j][c].abs())).unwrap_or(c);
        a.swap(c, pivot);
        let (above, below) = a.split_at_mut(c + 1);
        let row = &above[c];
        for other in below {
            let factor = other[c] / row[c];
            if factor != 0.0 {
                other[c..].iter_mut().zip(&row[c..]).for_each(|(o, r)| *o -= factor * r);
            }
        }
    }
    let mut x = vec![0.0; n];
    for i in (0..n).rev() {
        let known: f64 = (i + 1..n).map(|j| a[i][j] * x[j]).sum();
        x[i] = (a[i][n] - known) / a[i][i];
    }
    x
}
