//! A ring that bends, a thick cylinder under pressure.

use std::f64::consts::TAU;

use anyhow::{Context, Result};
use stribeck_mesh::{Annulus, Circle, Grading, Part};
use stribeck_solver::Elastic;

use super::Timer;
use super::waves::{Way, limit, model, ways};
use crate::Rows;
use crate::integrators::Trajectory;
use crate::reference::{Reference, Rule};
use crate::rig::steel;
use crate::stability::{cylinder, ring as bore_ring, split};

/// Mean radius and thickness of the ring [m].
const RING: [f64; 2] = [0.1, 0.004];

/// Frequency of the lowest bending mode by its first return through zero, over Love's.
fn bending(way: &Way, layers: usize, factor: f64) -> Result<(f64, f64)> {
    let [mean, thickness] = RING;
    let facets = 4 * ((TAU * mean / thickness).round() as usize * layers / 4);
    let ring = Annulus {
        inner_radius: mean - 0.5 * thickness,
        outer_radius: mean + 0.5 * thickness,
        facets,
        layers,
        start_angle: 0.0,
        grooves: Vec::new(),
    };
    let part = ring.part()?;
    let model = model(&if way.1 { split(part) } else { part })?;
    let mut plain = Reference::new(&model, way.2)?;
    let rest = plain.rest().to_vec();
    let k = 2.0;
    let mode = |x: f64, y: f64| {
        let (angle, r) = (y.atan2(x), x.hypot(y) / mean);
        let radial = (k * angle).cos();
        let hoop = -(k * angle).sin() / k * (1.0 + (1.0 - k * k) * (1.0 - r));
        [radial * angle.cos() - hoop * angle.sin(), radial * angle.sin() + hoop * angle.cos()]
    };
    let shape: Vec<f64> = rest.chunks(2).flat_map(|p| mode(p[0], p[1])).collect();
    let m = steel();
    let expected = k * (k * k - 1.0) / (TAU * mean * mean)
        * (m.plane_strain_modulus() * thickness * thickness / (12.0 * m.density() * (k * k + 1.0))).sqrt();
    let steps = (0.5 / expected / (factor * limit(&model, way)?)).ceil();
    let dt = 0.5 / expected / steps;
    let mut accelerate = |x: &[f64], v: &[f64], a: &mut [f64]| plain.accelerate(x, v, a);
    let v = shape.iter().map(|s| 0.01 * s).collect();
    let mut t = Trajectory::start(rest.clone(), v, &mut accelerate);
    let amplitude =
        |t: &Trajectory| -> f64 { t.x.iter().zip(&rest).zip(&shape).map(|((x, r), s)| (x - r) * s).sum() };
    let mut before = (0.0, 0.0);
    let mut crossing = None;
    for _ in 0..(2.0 * steps) as usize {
        way.3.step(&mut t, dt, &mut accelerate);
        let now = (t.time, amplitude(&t));
        if now.1 <= 0.0 {
            crossing = Some(before.0 + (now.0 - before.0) * before.1 / (before.1 - now.1));
            break;
        }
        before = now;
    }
    let half = crossing.context("the ring did not come back")?;
    let theory = 1.0 / (2.0 * half) / expected;
    Ok((plain.evaluations() as f64, (theory - 1.0).abs()))
}

pub(super) fn curves(timer: &Timer<'_>, rows: &mut Rows) -> Result<()> {
    // The scheme and the precision matter little for so slow a motion; the comparison is of elements.
    let is_left_out =
        |way: &Way| way.2.bulk_viscosity > 0.0 || (way.2.rule == Rule::OnePoint && way.0.starts_with("Noh"));
    for way in ways().iter().filter(|way| !is_left_out(way)) {
        let layers = [1, 2, 4].map(|n| (RING[1] / n as f64, n));
        timer.curve(rows, "Bending mode of a ring", way.0, layers, |n| bending(way, n, 0.9))?;
    }
    let sizes = [(24, 3), (48, 6), (96, 12), (192, 24)].map(|of| (0.05 / of.1 as f64, of));
    for (name, triangles, poisson) in [
        ("one-point quadrilaterals", false, 0.3),
        ("one-point quadrilaterals, ν = 0.4999", false, 0.4999),
        ("triangles", true, 0.3),
        ("triangles, ν = 0.4999", true, 0.4999),
    ] {
        let steel = Elastic::new(208e9, poisson, 7800.0)?;
        timer.curve(rows, CYLINDER, name, sizes, |(facets, layers)| {
            let part = bore_ring(facets, layers).part()?;
            pressed(&if triangles { split(part) } else { part }, steel, facets)
        })?;
    }
    // Three facets become one away from the bore.
    let sizes = [(81, 10), (162, 20), (324, 40)].map(|of| (TAU * 0.05 / of.0 as f64, of));
    timer.curve(rows, CYLINDER, "graded from the bore", sizes, |(facets, layers)| {
        let grading = Grading { fine: Circle::Inner, fine_layers: layers / 10 + 1, transitions: 1 };
        pressed(&bore_ring(facets, layers).graded_part(&grading)?, steel(), facets)
    })
}

const CYLINDER: &str = "Thick cylinder under pressure";

/// Elements of a thick cylinder under pressure, and the error of its bore.
fn pressed(part: &Part, material: Elastic, facets: usize) -> Result<(f64, f64)> {
    let elements = (part.quads.len() + part.triangles.len()) as f64;
    Ok((elements, (cylinder(part, material, facets)? - 1.0).abs()))
}
