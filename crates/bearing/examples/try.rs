use std::ops::ControlFlow;
use stribeck_bearing::{run_dir::RunDir, scene::Scene, simulation::*};
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let threads: usize = args[2].parse().unwrap();
    let scene = Scene::default().with_overrides(&args[3..]).unwrap_or_else(|e| {
        println!("{e}");
        std::process::exit(1)
    });
    let _ = std::fs::remove_dir_all(&args[1]);
    let dir = RunDir::create(&args[1]).unwrap();
    let t = std::time::Instant::now();
    let wall = || t.elapsed().as_secs_f64();
    let host = Host {
        threads,
        version: "t".into(),
        commit: "t".into(),
        machine: "t".into(),
        wall_s: &wall,
        cpu_s: &wall,
    };
    let mut n = 0;
    let r = simulate(&scene, &dir, &host, &mut |p| {
        n += 1;
        if n % 20 == 0 || n < 5 {
            println!(
                "{:.1} {p:?} {:.2} ns",
                t.elapsed().as_secs_f64(),
                t.elapsed().as_secs_f64() * 1e9 / (p.step as f64 * p.elements as f64)
            );
        }
        ControlFlow::Continue(())
    });
    match r {
        Ok(i) => println!("{i:#?}"),
        Err(e) => println!("{e}"),
    }
}
