//! A ring that bends, a thick cylinder under pressure.

use std::f64::consts::TAU;

use anyhow::{Context, Result};
use stribeck_mesh::{Annulus, Circle, Grading};
use stribeck_solver::Elastic;

use super::waves::{Way, limit, model, ways};
use super::{Curve, Problem, timed};
use crate::Host;
use crate::integrators::Trajectory;
use crate::reference::{Reference, Rule};
use crate::rig::steel;
use crate::stability::{cylinder as bore, cylinder_of, split};

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

pub(super) fn ring(host: &dyn Host) -> Result<Problem> {
    let mut curves = Vec::new();
    for way in ways() {
        // The scheme and the precision matter little for so slow a motion; the comparison is of elements.
        if way.2.bulk_viscosity > 0.0 || (way.2.rule == Rule::OnePoint && way.0.starts_with("Noh")) {
            continue;
        }
        let layers = [1, 2, 4];
        let points = layers.iter().map(|&n| timed(host, || bending(&way, n, 0.9), RING[1] / n as f64));
        curves.push(Curve {
            name: way.0.into(),
            refined: "element size",
            points: points.collect::<Result<_>>()?,
        });
    }
    Ok(Problem {
        id: "ring",
        title: "Bending mode of a ring",
        words: "Two lobes of a free ring of radius 100 mm and thickness 4 mm, with 1, 2 and 4 layers of \
            square cells: f = n(n² − 1)/(2πR²) \
                √(E'I/(ρA(n² + 1))) (Love, *Mathematical Theory of Elasticity*, 1927, §293; the benchmark \
                Code_Aster V2.03.109). Shear and \
                rotary inertia, which the formula leaves out, lower the true value by some n²(h/R)²/3 = 0.2 \
                %: that is where the good \
                curves end. One layer of one-point quadrilaterals bends right because its hourglass \
                stiffness is that of bending; full \
                integration and triangles are too stiff."
            .into(),
        work: "element evaluations",
        curves,
    })
}

pub(super) fn cylinder(host: &dyn Host) -> Result<Problem> {
    let mut curves = Vec::new();
    let sizes = [(24, 3), (48, 6), (96, 12), (192, 24)];
    for (name, poisson) in
        [("one-point quadrilaterals", 0.3), ("one-point quadrilaterals, ν = 0.4999", 0.4999)]
    {
        let steel = Elastic::new(208e9, poisson, 7800.0)?;
        let points = sizes.iter().map(|&(facets, layers)| {
            timed(
                host,
                || Ok(((facets * layers) as f64, (bore(steel, facets, layers)? - 1.0).abs())),
                0.05 / layers as f64,
            )
        });
        curves.push(Curve {
            name: name.into(),
            refined: "element size",
            points: points.collect::<Result<_>>()?,
        });
    }
    for (name, poisson) in [("triangles", 0.3), ("triangles, ν = 0.4999", 0.4999)] {
        let steel = Elastic::new(208e9, poisson, 7800.0)?;
        let points = sizes.iter().map(|&(facets, layers)| {
            let ring = ring_of(facets, layers);
            timed(
                host,
                || {
                    let part = split(ring.part()?);
                    let elements = part.triangles.len() as f64;
                    Ok((elements, (cylinder_of(&part, steel, facets)? - 1.0).abs()))
                },
                0.05 / layers as f64,
            )
        });
        curves.push(Curve {
            name: name.into(),
            refined: "element size",
            points: points.collect::<Result<_>>()?,
        });
    }
    // Three facets become one away from the bore.
    let points = [(81, 10), (162, 20), (324, 40)].map(|(facets, layers)| {
        let ring = ring_of(facets, layers);
        let grading = Grading { fine: Circle::Inner, fine_layers: layers / 10 + 1, transitions: 1 };
        timed(
            host,
            || {
                let part = ring.graded_part(&grading)?;
                let elements = (part.quads.len() + part.triangles.len()) as f64;
                Ok((elements, (cylinder_of(&part, steel(), facets)? - 1.0).abs()))
            },
            TAU * 0.05 / facets as f64,
        )
    });
    let points = points.into_iter().collect::<Result<_>>()?;
    curves.push(Curve { name: "graded from the bore".into(), refined: "element size", points });
    Ok(Problem {
        id: "cylinder",
        title: "Thick cylinder under pressure",
        words:
            "Bore of 50 mm, rim of 100 mm, displacement of the bore: u = (1 + ν) p a²/(E (b² − a²)) [(1 − \
            2ν) a + b²/a] (Timoshenko and \
             Goodier, *Theory of Elasticity*, 1970, §28). Static. Near ν = ½ triangles lock and one-point \
             quadrilaterals do not."
                .into(),
        work: "elements",
        curves,
    })
}

fn ring_of(facets: usize, layers: usize) -> Annulus {
    Annulus { inner_radius: 0.05, outer_radius: 0.1, facets, layers, start_angle: 0.0, grooves: Vec::new() }
}
