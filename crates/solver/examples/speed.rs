use stribeck_mesh::*;
use stribeck_solver::*;
fn main() {
    let steel = Elastic::new(200e9, 0.3, 7850.0).unwrap();
    for (c, r) in [(210usize, 125usize), (420, 250)] {
        let mut mesh = Mesh::new();
        let part = Rectangle {
            x0: 0.0,
            y0: 0.0,
            width: c as f64 * 0.5e-3,
            height: r as f64 * 0.5e-3,
            columns: c,
            rows: r,
        }
        .part()
        .unwrap();
        mesh.add("block", &part);
        let model = Model::new(mesh, steel, 0.02).unwrap();
        let n = model.mesh.x.len();
        let mut d = Dynamics::new(&model, &vec![false; n], 1).unwrap();
        d.set_time_step(50e-9).unwrap();
        for i in 0..d.state.x.len() {
            d.state.vx[i] = (i as f64 * 0.37).sin() * 1e-2;
        }
        let steps = 2000;
        for _ in 0..100 {
            d.step(&mut []);
        }
        let t = std::time::Instant::now();
        for _ in 0..steps {
            d.step(&mut []);
        }
        let e = (c * r) as f64;
        println!(
            "{e} quads: {:.3} ns/element-step  x={:e} U={:?}",
            t.elapsed().as_secs_f64() * 1e9 / e / steps as f64,
            d.state.x[17],
            d.elastic_energy()
        );
    }
    let mut mesh = Mesh::new();
    let part = Disc { radius: 9e-3, facets: 112, size: 0.5e-3, rotation: 0.0 }.part().unwrap();
    for i in 0..24 {
        mesh.add(format!("disc{i}"), &part.translated(i as f64 * 0.02, 0.0));
    }
    let e = (mesh.quads.len() + mesh.triangles.len()) as f64;
    let model = Model::new(mesh, steel, 0.02).unwrap();
    let n = model.mesh.x.len();
    let mut d = Dynamics::new(&model, &vec![false; n], 1).unwrap();
    d.set_time_step(30e-9).unwrap();
    let steps = 2000;
    for i in 0..d.state.x.len() {
        d.state.vx[i] = (i as f64 * 0.37).sin() * 1e-2;
    }
    for _ in 0..100 {
        d.step(&mut []);
    }
    let t = std::time::Instant::now();
    for _ in 0..steps {
        d.step(&mut []);
    }
    println!(
        "{e} disc elements: {:.3} ns/element-step {:?}",
        t.elapsed().as_secs_f64() * 1e9 / e / steps as f64,
        d.elastic_energy()
    );
}
