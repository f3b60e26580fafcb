//! Scratch: force at fixed approach over one facet.
#[path = "../tests/common/mod.rs"]
mod common;
use common::*;
use std::f64::consts::TAU;
use stribeck_contact::*;
use stribeck_mesh::Annulus;
use stribeck_solver::{Force, Motion, force::NodalLoad, state::NodeForces};

const R: f64 = 9e-3;

fn force(
    facets: usize,
    spin: f64,
    shift: f64,
    sink: f64,
    smoothing: [Smoothing; 2],
    method: Method,
    scale: f64,
    race: bool,
    spline: bool,
    onset: f64,
) -> f64 {
    let size = TAU * R / facets as f64;
    let mut scene = Scene::default();
    let ground = if race {
        let n = (TAU * 0.1 / 0.5e-3 * (facets as f64 / 112.0)).round() as usize;
        let ring = Annulus {
            inner_radius: 0.1,
            outer_radius: 0.106,
            facets: n,
            layers: (12.0 * facets as f64 / 112.0) as usize,
            start_angle: -TAU / 4.0 + shift * TAU / n as f64,
            groove: None,
        };
        scene.add("ground", &ring.part().unwrap(), "inner")
    } else {
        let columns = (16.0 * facets as f64 / 56.0) as usize;
        let w = columns as f64 * size;
        scene.add(
            "ground",
            &rectangle([-0.5 * w + shift * size, -0.5 * w], w, 0.5 * w, columns, columns / 2),
            "top",
        )
    };
    let centre = if race { [0.0, -0.1 + R - sink] } else { [0.0, R - sink] };
    let d = disc(R, facets, size)
        .rotated(-TAU / 4.0 + spin * TAU / facets as f64)
        .translated(centre[0], centre[1]);
    let roller = scene.add("roller", &d, "rim");
    let law =
        Law::penalty(scale * 208e9 / 0.5e-3 * (facets as f64 / 112.0)).unwrap().with_onset(onset).unwrap();
    scene.pair(roller, ground, law, method);
    let mut model = scene.model();
    for n in 0..model.mesh.x.len() {
        let (x, y) = (model.mesh.x[n], model.mesh.y[n]);
        let in_roller = model.mesh.bodies[roller].nodes.contains(&n);
        let held = if in_roller {
            (x - centre[0]).hypot(y - centre[1]) < 2e-3
        } else if race {
            x.hypot(y) > 0.1059 || y > -0.08 || x.abs() > 0.02
        } else {
            y < -0.49 * 2.0 * 8e-3 * 0.5
        };
        if held {
            model.motion[n] = Motion::Held;
        }
    }
    let (mut d, _) = scene.lay_out(&model);
    let (x, y) = (d.state.x.clone(), d.state.y.clone());
    let centres = [[0.0, 0.0], centre];
    let surfaces = scene
        .surfaces()
        .iter()
        .enumerate()
        .map(|(i, (name, s))| {
            let slots = slots(&d, s.nodes.iter().map(|&n| n as usize));
            let sm = match smoothing[1 - i] {
                Smoothing::Arc { .. } => Smoothing::Arc { centre: centres[i] },
                o => o,
            };
            Surface::new(name.clone(), slots, s.closed, &x, &y)
                .unwrap()
                .smoothed(sm, &x, &y)
                .map(|s| if spline { s.splined(&x, &y) } else { s })
                .unwrap()
        })
        .collect();
    let pair = PairSpec { first: 1, second: 0, law, method, sides: Sides::Both };
    let mut contacts = Contacts::new(surfaces, &[pair], THICKNESS, &x, &y).expect("two surfaces");
    let bodies = [0, 1].map(|b| (format!("b{b}"), of_body(&d, &model, b)));
    let mut load = NodalLoad::new(vec![]);
    preload(&mut d, &mut contacts, &mut load, bodies.to_vec(), &[1e-6, 1e-7, 1e-8, 0.0], 1e-4);
    contacts.set_preload(None);
    let n = d.state.x.len();
    let mut f = NodeForces::zeros(n);
    contacts.accumulate(d.moment(), &mut f);
    contacts.resultants().next().unwrap().force[1] / THICKNESS
}

fn main() {
    let arg: Vec<String> = std::env::args().collect();
    let sink: f64 = arg.get(1).map_or(13e-6, |s| s.parse().unwrap());
    let n: usize = arg.get(2).map_or(8, |s| s.parse().unwrap());
    let arc = Smoothing::Arc { centre: [0.0; 2] };
    let fl = Smoothing::Facet;
    if arg.get(3).is_some() {
        for race in [false, true] {
            for sink in [4e-6, 7e-6, 13e-6] {
                print!("race {race} sink {:.0}: ", sink * 1e6);
                for (facets, spline, scale) in [
                    (112, false, 1.0),
                    (112, true, 1.0),
                    (112, true, 0.75),
                    (112, true, 0.6),
                    (224, false, 1.0),
                    (224, true, 0.75),
                    (336, false, 2.0),
                ] {
                    let m = Method::Integrated { points: 8 };
                    let g = if race { arc } else { fl };
                    print!(
                        " {facets} {spline} {scale}: {:.1}",
                        force(
                            facets,
                            0.3,
                            0.1,
                            sink,
                            [arc, g],
                            m,
                            scale,
                            race,
                            spline,
                            if spline { 0.5e-6 } else { 0.0 }
                        ) / 1e3
                    );
                }
                println!();
            }
        }
        return;
    }
    for race in [false, true] {
        let ground = |s: Smoothing| if race { s } else { Smoothing::Facet };
        let m = |points| Method::Integrated { points };
        for (name, sm, method, scale, spline, onset) in [
            ("chords 4", [fl, fl], m(4), 1.0, false, 0.0),
            ("arc 8", [arc, ground(arc)], m(8), 1.0, false, 0.0),
            ("spline 8", [arc, ground(arc)], m(8), 1.0, true, 0.0),
            ("spline 8 k.75", [arc, ground(arc)], m(8), 0.75, true, 0.0),
            ("spline 8 k.75 e.5", [arc, ground(arc)], m(8), 0.75, true, 0.5e-6),
            ("spline 12 k.75 e.5", [arc, ground(arc)], m(12), 0.75, true, 0.5e-6),
        ] {
            print!("race {race} {name:20}");
            let k = (force(112, 0.0, 0.0, sink + 1e-7, sm, method, scale, race, spline, onset)
                - force(112, 0.0, 0.0, sink, sm, method, scale, race, spline, onset))
                / 1e-7;
            for (what, a, b) in [("spin", 1.0, 0.0), ("nodes", 0.0, 1.0), ("both", 1.0, 1.0)] {
                let f: Vec<f64> = (0..n)
                    .map(|i| {
                        let s = i as f64 / n as f64;
                        force(112, a * s, b * s, sink, sm, method, scale, race, spline, onset)
                    })
                    .collect();
                let mean = f.iter().sum::<f64>() / n as f64;
                let (lo, hi) = f.iter().fold((f64::MAX, f64::MIN), |(a, b), &v| (a.min(v), b.max(v)));
                let harm = |m: f64| {
                    let (mut c, mut s) = (0.0, 0.0);
                    for (i, v) in f.iter().enumerate() {
                        let p = TAU * m * i as f64 / n as f64;
                        c += v * p.cos();
                        s += v * p.sin();
                    }
                    2.0 * (c * c + s * s).sqrt() / n as f64
                };
                print!(
                    " | {what}: F {:.1} kN/m p-p {:.3}% h1 {:.1} nm rest {:.1} nm",
                    mean / 1e3,
                    100.0 * (hi - lo) / mean,
                    harm(1.0) / k * 1e9,
                    (2..=n / 2).map(|m| harm(m as f64)).fold(0.0, f64::max) / k * 1e9
                );
            }
            println!(" K {:.2e}", k);
        }
    }
}
