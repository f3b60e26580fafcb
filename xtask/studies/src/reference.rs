//! Elements assembled one after the other, for comparisons: the arithmetic of the fast kernel, and choices
//! that it does not have. Nothing here is used in a run.
//!
//! Choices: quadrilaterals of one point with hourglass stiffness or of 2 × 2 points, double or mixed
//! precision (forces of an element in single precision from differences of positions in double), linear bulk
//! viscosity.

use anyhow::{Result, ensure};
use stribeck_solver::{
    Behaviour, Dynamics, Model, NodeMotion,
    element::{QuadReference, Stiffness, TriangleReference, quad_forces, triangle_forces},
};

/// How quadrilaterals are integrated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rule {
    /// One point, with hourglass stiffness, as in the kernel.
    OnePoint,
    /// 2 × 2 Gauss points: no hourglass modes, but too stiff in bending and near incompressibility.
    Full,
}

/// Precision of the forces of an element.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Precision {
    /// 64 bits throughout.
    Double,
    /// Differences of positions in 64 bits, everything after that in 32, sums over elements in 64. One-point
    /// quadrilaterals only; other elements stay double.
    Mixed,
}

/// Choices of a reference model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Choice {
    /// Integration of quadrilaterals.
    pub rule: Rule,
    /// Precision of element forces.
    pub precision: Precision,
    /// Coefficient b of the linear bulk viscosity: a pressure b ρ c √A ε̇ against the rate of volume change;
    /// 0 for none, 0.06 is customary.
    pub bulk_viscosity: f64,
}

impl Default for Choice {
    fn default() -> Self {
        Self { rule: Rule::OnePoint, precision: Precision::Double, bulk_viscosity: 0.0 }
    }
}

/// Shape gradients [1/m] and volume [m³] of one Gauss point.
#[derive(Debug, Clone, Copy, Default)]
struct GaussPoint {
    gradient: [[f64; 2]; 4],
    volume: f64,
}

#[derive(Debug, Clone)]
struct Quad {
    nodes: [usize; 4],
    reference: QuadReference,
    points: [GaussPoint; 4],
    body: usize,
}

#[derive(Debug, Clone)]
struct Triangle {
    nodes: [usize; 3],
    reference: TriangleReference,
    body: usize,
}

/// Constants of one body.
#[derive(Debug, Clone, Copy)]
struct Constants {
    stiffness: Stiffness,
    /// b ρ c over √thickness: times √volume it is b ρ c √A [Pa s].
    viscosity: f64,
}

/// A model of elastic bodies as a plain list of elements. Vectors hold x and y of each mesh node in turn.
#[derive(Debug, Clone)]
pub struct Reference {
    choice: Choice,
    quads: Vec<Quad>,
    triangles: Vec<Triangle>,
    constants: Vec<Constants>,
    inverse_mass: Vec<f64>,
    rest: Vec<f64>,
    evaluations: u64,
}

impl Reference {
    /// Takes the model's bodies; held components do not move.
    pub fn new(model: &Model, choice: Choice) -> Result<Self> {
        let viscosity = choice.bulk_viscosity;
        ensure!(
            viscosity.is_finite() && viscosity >= 0.0,
            "bulk viscosity = {viscosity}: must be zero or positive"
        );
        ensure!(!model.behaviour.contains(&Behaviour::Rigid), "a reference model has no rigid bodies");
        let turning = |m: &NodeMotion| matches!(m, NodeMotion::Rotating { .. });
        ensure!(!model.motion.iter().any(turning), "a reference model has no rotating nodes");
        let mesh = &model.mesh;
        // The solver checks the model and computes the masses.
        let dynamics = Dynamics::new(model, &vec![false; mesh.x.len()], 1)?;
        let slots = &dynamics.layout().slot_of_node;
        let mass: Vec<f64> = slots.iter().map(|&slot| dynamics.mass()[slot as usize]).collect();
        let (mut quads, mut triangles) = (Vec::<Quad>::new(), Vec::new());
        for (body, b) in mesh.bodies.iter().enumerate() {
            for e in b.quads.clone() {
                let corners = corners(model, &mesh.quads[e]);
                let new = QuadReference::new(&corners, model.thickness).map_err(no_area(&b.name, e))?;
                // Like the kernel: quadrilaterals of one shape that follow one another share their reference.
                let before = quads.last().map(|q| q.reference).filter(|before| before.is_congruent(&new));
                quads.push(Quad {
                    nodes: mesh.quads[e].map(|n| n as usize),
                    reference: before.unwrap_or(new),
                    points: gauss_points(&corners, model.thickness),
                    body,
                });
            }
            for e in b.triangles.clone() {
                let corners = corners(model, &mesh.triangles[e]);
                let reference =
                    TriangleReference::new(&corners, model.thickness).map_err(no_area(&b.name, e))?;
                triangles.push(Triangle { nodes: mesh.triangles[e].map(|n| n as usize), reference, body });
            }
        }
        let constants = (0..mesh.bodies.len()).map(|b| {
            let m = &model.materials[b];
            let impedance = m.density() * m.dilatational_speed();
            let viscosity = choice.bulk_viscosity * impedance / model.thickness.sqrt();
            Constants { stiffness: model.stiffness(b), viscosity }
        });
        let inverse_mass = mass.iter().zip(&model.motion).flat_map(|(m, motion)| {
            let [x, y] = match motion {
                NodeMotion::Free => [1.0, 1.0],
                NodeMotion::HeldX => [0.0, 1.0],
                NodeMotion::HeldY => [1.0, 0.0],
                NodeMotion::Held | NodeMotion::Rotating { .. } => [0.0, 0.0],
            };
            [x / m, y / m]
        });
        Ok(Self {
            choice,
            quads,
            triangles,
            constants: constants.collect(),
            inverse_mass: inverse_mass.collect(),
            rest: mesh.x.iter().zip(&mesh.y).flat_map(|(x, y)| [*x, *y]).collect(),
            evaluations: 0,
        })
    }

    /// Positions at rest [m].
    pub fn rest(&self) -> &[f64] {
        &self.rest
    }

    /// Elements evaluated so far: the measure of work that does not depend on the machine.
    pub fn evaluations(&self) -> u64 {
        self.evaluations
    }

    /// Accelerations [m/s²] at positions `x` [m] and velocities `v` [m/s].
    pub fn accelerate(&mut self, x: &[f64], v: &[f64], a: &mut [f64]) {
        a.fill(0.0);
        self.evaluations += (self.quads.len() + self.triangles.len()) as u64;
        let mut add = |n: usize, f: [f64; 2]| {
            a[2 * n] += f[0];
            a[2 * n + 1] += f[1];
        };
        for q in &self.quads {
            let c = &self.constants[q.body];
            let (px, py) = (q.nodes.map(|n| x[2 * n]), q.nodes.map(|n| x[2 * n + 1]));
            let force = match (self.choice.rule, self.choice.precision) {
                (Rule::Full, _) => full_forces(px, py, &q.points, &c.stiffness),
                (Rule::OnePoint, Precision::Double) => quad_forces(px, py, &q.reference, &c.stiffness),
                (Rule::OnePoint, Precision::Mixed) => single_forces(px, py, &q.reference, &c.stiffness),
            };
            (0..4).for_each(|k| add(q.nodes[k], force[k]));
            if c.viscosity > 0.0 {
                let r = &q.reference;
                let d = |w: &[f64], i: usize, j: usize| {
                    let [i, j] = [q.nodes[i], q.nodes[j]];
                    [w[2 * i] - w[2 * j], w[2 * i + 1] - w[2 * j + 1]]
                };
                let at = [d(x, 0, 2), d(x, 1, 3)];
                let [f, g] = viscous(at, [d(v, 0, 2), d(v, 1, 3)], [r.b1, r.b2], r.volume, c.viscosity);
                for (k, f) in [f, g, [-f[0], -f[1]], [-g[0], -g[1]]].into_iter().enumerate() {
                    add(q.nodes[k], f);
                }
            }
        }
        for t in &self.triangles {
            let c = &self.constants[t.body];
            let (px, py) = (t.nodes.map(|n| x[2 * n]), t.nodes.map(|n| x[2 * n + 1]));
            let [mut f, mut g] = triangle_forces(px, py, &t.reference, &c.stiffness);
            if c.viscosity > 0.0 {
                let r = &t.reference;
                let d = |w: &[f64], i: usize| {
                    let [i, j] = [t.nodes[i], t.nodes[2]];
                    [w[2 * i] - w[2 * j], w[2 * i + 1] - w[2 * j + 1]]
                };
                let at = [d(x, 0), d(x, 1)];
                let [p, q] = viscous(at, [d(v, 0), d(v, 1)], [r.b1, r.b2], r.volume, c.viscosity);
                (f, g) = ([f[0] + p[0], f[1] + p[1]], [g[0] + q[0], g[1] + q[1]]);
            }
            for (k, f) in [f, g, [-f[0] - g[0], -f[1] - g[1]]].into_iter().enumerate() {
                add(t.nodes[k], f);
            }
        }
        a.iter_mut().zip(&self.inverse_mass).for_each(|(a, w)| *a *= w);
    }
}

/// Corner positions of an element [m].
fn corners<const N: usize>(model: &Model, nodes: &[u32; N]) -> [[f64; 2]; N] {
    nodes.map(|n| [model.mesh.x[n as usize], model.mesh.y[n as usize]])
}

fn no_area(body: &str, element: usize) -> impl FnOnce(f64) -> anyhow::Error + use<'_> {
    move |area| anyhow::anyhow!("element {element} of body `{body}` has area {area:e} m²")
}

/// 2 × 2 Gauss points of a quadrilateral (Belytschko, Liu and Moran 2000, §4.5 and appendix 3).
fn gauss_points(corners: &[[f64; 2]; 4], thickness: f64) -> [GaussPoint; 4] {
    const SIGNS: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let place = 1.0 / 3.0_f64.sqrt();
    SIGNS.map(|at| {
        let (xi, eta) = (place * at[0], place * at[1]);
        let slope = SIGNS.map(|s| [0.25 * s[0] * (1.0 + s[1] * eta), 0.25 * s[1] * (1.0 + s[0] * xi)]);
        let mut j = [[0.0; 2]; 2];
        for (corner, n) in corners.iter().zip(&slope) {
            for i in 0..2 {
                for k in 0..2 {
                    j[i][k] += corner[i] * n[k];
                }
            }
        }
        let determinant = j[0][0] * j[1][1] - j[0][1] * j[1][0];
        let gradient = slope.map(|n| {
            [(n[0] * j[1][1] - n[1] * j[1][0]) / determinant, (n[1] * j[0][0] - n[0] * j[0][1]) / determinant]
        });
        GaussPoint { gradient, volume: determinant * thickness }
    })
}

/// Second Piola–Kirchhoff stress (xx, yy, xy) [Pa] of a deformation gradient.
fn stress(f: [[f64; 2]; 2], k: &Stiffness) -> [f64; 3] {
    let exx = 0.5 * (f[0][0] * f[0][0] + f[1][0] * f[1][0] - 1.0);
    let eyy = 0.5 * (f[0][1] * f[0][1] + f[1][1] * f[1][1] - 1.0);
    let exy = 0.5 * (f[0][0] * f[0][1] + f[1][0] * f[1][1]);
    let pressure = k.lame * (exx + eyy);
    [pressure + k.two_shear * exx, pressure + k.two_shear * eyy, k.two_shear * exy]
}

fn full_forces(x: [f64; 4], y: [f64; 4], points: &[GaussPoint; 4], k: &Stiffness) -> [[f64; 2]; 4] {
    let mut force = [[0.0; 2]; 4];
    for point in points {
        let mut f = [[0.0; 2]; 2];
        for a in 0..4 {
            let g = point.gradient[a];
            f[0][0] += x[a] * g[0];
            f[0][1] += x[a] * g[1];
            f[1][0] += y[a] * g[0];
            f[1][1] += y[a] * g[1];
        }
        let [sxx, syy, sxy] = stress(f, k);
        for a in 0..4 {
            let g = point.gradient[a];
            let t = [sxx * g[0] + sxy * g[1], sxy * g[0] + syy * g[1]];
            force[a][0] -= point.volume * (f[0][0] * t[0] + f[0][1] * t[1]);
            force[a][1] -= point.volume * (f[1][0] * t[0] + f[1][1] * t[1]);
        }
    }
    force
}

/// [`quad_forces`] in single precision, from differences in double. Strains are found from the displacement
/// gradient of the diagonals' inner products, as far as single precision allows.
fn single_forces(x: [f64; 4], y: [f64; 4], q: &QuadReference, k: &Stiffness) -> [[f64; 2]; 4] {
    let s = |v: f64| v as f32;
    let p = [s(x[0] - x[2]), s(y[0] - y[2])];
    let r = [s(x[1] - x[3]), s(y[1] - y[3])];
    let (b1, b2) = (q.b1.map(s), q.b2.map(s));
    let f = [
        [p[0] * b1[0] + r[0] * b2[0], p[0] * b1[1] + r[0] * b2[1]],
        [p[1] * b1[0] + r[1] * b2[0], p[1] * b1[1] + r[1] * b2[1]],
    ];
    let exx = 0.5 * (f[0][0] * f[0][0] + f[1][0] * f[1][0]) - 0.5;
    let eyy = 0.5 * (f[0][1] * f[0][1] + f[1][1] * f[1][1]) - 0.5;
    let exy = 0.5 * (f[0][0] * f[0][1] + f[1][0] * f[1][1]);
    let (lame, shear, volume) = (s(k.lame), s(k.two_shear), s(q.volume));
    let pressure = lame * (exx + eyy);
    let [sxx, syy, sxy] = [pressure + shear * exx, pressure + shear * eyy, shear * exy].map(|v| volume * v);
    let along = |b: [f32; 2]| {
        let t = [sxx * b[0] + sxy * b[1], sxy * b[0] + syy * b[1]];
        [-(f[0][0] * t[0] + f[0][1] * t[1]), -(f[1][0] * t[0] + f[1][1] * t[1])]
    };
    let (g1, g2, s1, s2) = (along(b1), along(b2), s(q.s1), s(q.s2));
    let hourglass =
        |z: [f64; 4], i: usize| s(k.hourglass) * (s((z[0] + z[2]) - (z[1] + z[3])) - s1 * p[i] - s2 * r[i]);
    let w = [hourglass(x, 0), hourglass(y, 1)];
    let t1 = [g1[0] + s1 * w[0], g1[1] + s1 * w[1]];
    let t2 = [g2[0] + s2 * w[0], g2[1] + s2 * w[1]];
    [
        [t1[0] - w[0], t1[1] - w[1]],
        [t2[0] + w[0], t2[1] + w[1]],
        [-t1[0] - w[0], -t1[1] - w[1]],
        [w[0] - t2[0], w[1] - t2[1]],
    ]
    .map(|f| f.map(f64::from))
}

/// Viscous forces on the first two shape functions: the pressure b ρ c √A tr D on the present sides of the
/// element.
fn viscous(
    at: [[f64; 2]; 2],
    rate: [[f64; 2]; 2],
    b: [[f64; 2]; 2],
    volume: f64,
    viscosity: f64,
) -> [[f64; 2]; 2] {
    let gradient = |p: [f64; 2], r: [f64; 2]| {
        [
            [p[0] * b[0][0] + r[0] * b[1][0], p[0] * b[0][1] + r[0] * b[1][1]],
            [p[1] * b[0][0] + r[1] * b[1][0], p[1] * b[0][1] + r[1] * b[1][1]],
        ]
    };
    let (f, fdot) = (gradient(at[0], at[1]), gradient(rate[0], rate[1]));
    // Cofactors: the derivative of the area by the gradient.
    let c = [[f[1][1], -f[1][0]], [-f[0][1], f[0][0]]];
    let j = f[0][0] * f[1][1] - f[0][1] * f[1][0];
    let growth = (0..4).map(|i| c[i / 2][i % 2] * fdot[i / 2][i % 2]).sum::<f64>() / j;
    let tension = viscosity * volume.sqrt() * growth * volume;
    b.map(|b| [0, 1].map(|i| -tension * (c[i][0] * b[0] + c[i][1] * b[1])))
}
