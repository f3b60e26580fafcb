//! Probe.
use std::time::Instant;
use stribeck_reduced::{bearing::Bearing, reduction::Reduction, run::Motion};
use stribeck_scene::{Scene, trace::TraceWriter};
fn main() -> Result<(), Box<dyn std::error::Error>> {
    let args: Vec<String> = std::env::args().collect();
    let scene = Scene::read(&args[1])?.with_overrides(&args[4..])?;
    let khz: f64 = args[2].parse()?;
    let t = Instant::now();
    let (red, warning) = Reduction::new(&scene, khz)?;
    println!("reduction {:.2} s, {} modes, {warning:?}", t.elapsed().as_secs_f64(), red.modes);
    println!("f {:?}", red.squares.iter().map(|w| (w.max(0.0).sqrt() / 6.283185307).round()).collect::<Vec<_>>());
    let pre = red.preload.clone();
    for f in [1.0, 10.0, 100.0, 1000.0, 5000.0] {
        println!("C({f}) = {:?} {:?}", red.outer_compliance.approach(f), red.inner_compliance.approach(f));
    }
    let dt = 2e-6;
    let bearing = Bearing::new(&scene, red, dt)?;
    let t = Instant::now();
    let state = bearing.at_start(&scene)?;
    println!("start {:.3} s; q max {:?}", t.elapsed().as_secs_f64(), state.q.iter().fold(0.0f64, |a, b| a.max(b.abs())));
    for i in 0..pre.len() {
        println!("{:2} full {:9.2} reduced outer {:9.2} inner {:9.2}", i + 1, pre[i], state.force[0][i], state.force[1][i]);
    }
    let names = stribeck_bearing::recorder::names(&scene);
    let _ = std::fs::remove_file(&args[3]);
    let mut w = TraceWriter::create(args[3].clone(), &names)?;
    let mut m = Motion::new(bearing, state);
    let n = (scene.solver.duration_ms / 0.01).round() as usize;
    let t = Instant::now();
    let mut first = None;
    let mut worst = 0.0_f64;
    for s in 0..n {
        w.push(m.interval(5))?;
        let e = m.energies();
        let sum = e[..6].iter().sum::<f64>() - e[6] - e[7];
        let first = *first.get_or_insert(sum);
        worst = worst.max((sum - first).abs());
        if s % (n / 10).max(1) == 0 {
            println!("{s} {e:.5?} imbalance {:.2e}", sum - first);
        }
    }
    let sim = n as f64 * 1e-5;
    println!("worst {worst:.3e}; loop {:.3} s for {sim} s: {:.2} s/s", t.elapsed().as_secs_f64(), t.elapsed().as_secs_f64() / sim);
    w.finish()?;
    Ok(())
}
