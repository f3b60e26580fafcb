//! Waves: a pressure pulse along a strip, a standing Rayleigh wave.

use std::f64::consts::PI;

use anyhow::Result;
use stribeck_mesh::{Mesh, Part};
use stribeck_solver::{Dynamics, Model, NodeMotion};

use super::Timer;
use crate::Rows;
use crate::integrators::{Scheme, Trajectory};
use crate::reference::{Choice, Precision, Reference, Rule};
use crate::rig::{THICKNESS, rectangle, steel};
use crate::stability::split;

/// A compared variant: name, triangles or not, element, integrator.
pub(super) type Way = (&'static str, bool, Choice, Scheme);

const CENTRAL: Scheme = Scheme::CentralDifference;

/// All choices of element and integrator.
pub(super) fn ways() -> [Way; 7] {
    let plain = Choice::default();
    [
        ("one-point quadrilaterals, central differences", false, plain, CENTRAL),
        ("2 × 2 points", false, Choice { rule: Rule::Full, ..plain }, CENTRAL),
        ("triangles", true, plain, CENTRAL),
        ("mixed precision", false, Choice { precision: Precision::Mixed, ..plain }, CENTRAL),
        ("bulk viscosity 0.06", false, Choice { bulk_viscosity: 0.06, ..plain }, CENTRAL),
        ("Tchamwa–Wielgosz φ = 1.03", false, plain, Scheme::TchamwaWielgosz { phi: 1.03 }),
        ("Noh–Bathe p = 0.54", false, plain, Scheme::NohBathe { p: 0.54 }),
    ]
}

pub(super) fn model(part: &Part) -> Result<Model> {
    let mut mesh = Mesh::new();
    mesh.add("body", part);
    Ok(Model::new(mesh, steel(), THICKNESS)?)
}

/// Longest stable step of a way [s].
pub(super) fn limit(model: &Model, (_, _, choice, scheme): &Way) -> Result<f64> {
    let d = Dynamics::new(model, &vec![false; model.mesh.x.len()], 1)?;
    // Full integration has higher frequencies than one point: its shear and bending modes are stiffer, never
    // its dilatation, which is the highest; a tenth covers distorted cells.
    let stiffer = if choice.rule == Rule::Full { 0.9 } else { 1.0 };
    // Viscosity that lags half a step: Ω² + 2ξΩ = 4 with ξ = b, the damping ratio of the highest mode.
    let b = choice.bulk_viscosity;
    let damped = (1.0 + 0.25 * b * b).sqrt() - 0.5 * b;
    Ok(d.critical_time_step(&[], 0.0).time_step * stiffer * damped * 0.5 * scheme.limit())
}

/// Takes a model from displacements and velocities at 0 to `time` [s]; positions then, and elements
/// evaluated.
pub(super) fn travel(
    model: &Model,
    way: &Way,
    factor: f64,
    time: f64,
    start: &dyn Fn([f64; 2]) -> ([f64; 2], [f64; 2]),
) -> Result<(Vec<f64>, Vec<f64>, f64)> {
    let mut plain = Reference::new(model, way.2)?;
    let steps = (time / (factor * limit(model, way)?)).ceil();
    let dt = time / steps;
    let rest = plain.rest().to_vec();
    let (mut x, mut v) = (rest.clone(), vec![0.0; rest.len()]);
    for n in 0..rest.len() / 2 {
        let (u, w) = start([rest[2 * n], rest[2 * n + 1]]);
        for i in 0..2 {
            x[2 * n + i] += u[i];
            v[2 * n + i] = w[i];
        }
    }
    let mut accelerate = |x: &[f64], v: &[f64], a: &mut [f64]| plain.accelerate(x, v, a);
    let mut t = Trajectory::start(x, v, &mut accelerate);
    (0..steps as usize).for_each(|_| way.3.step(&mut t, dt, &mut accelerate));
    Ok((t.x, rest, plain.evaluations() as f64))
}

/// Root of the mean square of displacement minus `exact`, over that of `exact`.
fn off(x: &[f64], rest: &[f64], exact: &dyn Fn([f64; 2]) -> [f64; 2]) -> f64 {
    let (mut difference, mut size) = (0.0, 0.0);
    for n in 0..rest.len() / 2 {
        let u = exact([rest[2 * n], rest[2 * n + 1]]);
        for i in 0..2 {
            difference += (x[2 * n + i] - rest[2 * n + i] - u[i]).powi(2);
            size += u[i] * u[i];
        }
    }
    (difference / size).sqrt()
}

/// One pulse, `columns` cells long; the error of the displacement after eight widths of travel.
fn pulse(way: &Way, columns: usize, factor: f64) -> Result<(f64, f64)> {
    let (length, width, start, height) = (0.2, 0.01, 0.06, 1e-7);
    let part = rectangle([0.0; 2], [length, length / columns as f64], [columns, 1])?;
    let mut model = model(&if way.1 { split(part) } else { part })?;
    model.motion.fill(NodeMotion::HeldY);
    let c = steel().dilatational_speed();
    let at = |x: f64, t: f64| height * (-((x - start - c * t) / width).powi(2)).exp();
    let speed = |x: f64| 2.0 * c / width * (x - start) / width * at(x, 0.0);
    let time = 8.0 * width / c;
    let (x, rest, work) = travel(&model, way, factor, time, &|p| ([at(p[0], 0.0), 0.0], [speed(p[0]), 0.0]))?;
    Ok((work, off(&x, &rest, &|p| [at(p[0], time), 0.0])))
}

/// A standing Rayleigh wave: half a wavelength between two lines of symmetry.
struct Rayleigh {
    k: f64,
    q: f64,
    s: f64,
    speed: f64,
}

impl Rayleigh {
    /// Achenbach §5.11: (2 − c²/c_T²)² = 4 √(1 − c²/c_L²) √(1 − c²/c_T²).
    fn new(wavelength: f64) -> Self {
        let m = steel();
        let (cl, ct) = (m.dilatational_speed(), (m.shear() / m.density()).sqrt());
        let secular = |c: f64| {
            let (a, b) = ((c / cl).powi(2), (c / ct).powi(2));
            (2.0 - b).powi(2) - 4.0 * ((1.0 - a) * (1.0 - b)).sqrt()
        };
        // Negative below the root, positive between it and c_T.
        let (mut low, mut high) = (0.5 * ct, ct * (1.0 - 1e-12));
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if secular(middle) < 0.0 { low = middle } else { high = middle }
        }
        let k = 2.0 * PI / wavelength;
        let decay = |of: f64| k * (1.0 - (low / of).powi(2)).sqrt();
        Self { k, q: decay(cl), s: decay(ct), speed: low }
    }

    /// Displacement at `x` along and `z` below the surface, at the time of its maximum; y points upwards.
    fn shape(&self, x: f64, z: f64) -> [f64; 2] {
        let Self { k, q, s, .. } = *self;
        let b = 2.0 * k * q / (k * k + s * s);
        let (p, t) = ((-q * z).exp(), (-s * z).exp());
        let amplitude = 1e-7 / k;
        [amplitude * (-k * p + s * b * t) * (k * x).sin(), -amplitude * (-q * p + k * b * t) * (k * x).cos()]
    }
}

fn rayleigh(way: &Way, per_wave: usize, factor: f64) -> Result<(f64, f64)> {
    let wavelength = 0.01;
    let (columns, rows) = (per_wave / 2, 4 * per_wave);
    let depth = 4.0 * wavelength;
    let part = rectangle([0.0, -depth], [0.5 * wavelength, depth], [columns, rows])?;
    let mut model = model(&if way.1 { split(part) } else { part })?;
    for n in 0..model.mesh.x.len() {
        let column = n % (columns + 1);
        if column == 0 || column == columns {
            model.motion[n] = NodeMotion::HeldX;
        }
        if n <= columns {
            model.motion[n] = NodeMotion::Held;
        }
    }
    let wave = Rayleigh::new(wavelength);
    let time = 2.125 * wavelength / wave.speed;
    let (x, rest, work) = travel(&model, way, factor, time, &|p| (wave.shape(p[0], -p[1]), [0.0; 2]))?;
    let phase = (2.125 * 2.0 * PI).cos();
    Ok((work, off(&x, &rest, &|p| wave.shape(p[0], -p[1]).map(|u| phase * u))))
}

pub(super) fn curves(timer: &Timer<'_>, rows: &mut Rows) -> Result<()> {
    for way in ways() {
        timer.curve(
            rows,
            "Pressure wave",
            way.0,
            [100, 200, 400, 800].map(|n| (0.2 / n as f64, n)),
            |n| pulse(&way, n, 0.8),
        )?;
        timer.curve(rows, "Rayleigh wave", way.0, [10, 20, 40].map(|n| (0.01 / n as f64, n)), |n| {
            rayleigh(&way, n, 0.8)
        })?;
    }
    let factors = [0.99, 0.8, 0.5, 0.25].map(|f| (f, f));
    timer.curve(rows, "Pressure wave", "400 cells, Δt factor 0.99 … 0.25", factors, |f| {
        pulse(&ways()[0], 400, f)
    })
}
