//! A disc in a ring: prints the quality of both and writes a file for ParaView.
//!
//! `cargo run -p stribeck-mesh --example ring_and_disc -- ring_and_disc.vtu`

use std::error::Error;
use std::fs::File;
use std::io::{BufWriter, Write};

use stribeck_mesh::{Annulus, Disc, Mesh, Quality, find_strips, vtu};

/// Steel: Poisson's ratio and the speed of pressure waves [m/s].
const POISSON: f64 = 0.3;
const WAVE_SPEED: f64 = 5857.0;

fn main() -> Result<(), Box<dyn Error>> {
    let ring = Annulus {
        inner_radius: 40e-3,
        outer_radius: 46e-3,
        facets: 500,
        layers: 12,
        start_angle: 0.0,
        grooves: Vec::new(),
    };
    let disc = Disc { radius: 8e-3, facets: 100, size: 0.5e-3, rotation: 0.0 };

    let mut mesh = Mesh::new();
    let outer = mesh.add("ring", &ring.part()?);
    mesh.add("disc", &disc.part()?.translated(0.0, -32e-3));
    let facets = outer.surface("inner").map_or(0, |surface| surface.facets());
    let strips = find_strips(&mesh.quads).len();

    let quality = Quality::of(&mesh, POISSON, WAVE_SPEED);
    println!("{quality}");
    println!("The disc stands on an inner surface of {facets} facets.");
    println!("{} quadrilaterals lie in {strips} strips, which a solver reads as they lie.", mesh.quads.len());
    println!("Central differences need steps below {:.1} ns.", quality.overall.critical_time_step * 1e9);

    if let Some(path) = std::env::args().nth(1) {
        // Every node's distance from the middle, as an example of a field.
        let radius: Vec<f64> = mesh.x.iter().zip(&mesh.y).map(|(x, y)| x.hypot(*y)).collect();
        let mut file = BufWriter::new(File::create(&path)?);
        vtu::write(&mut file, &mesh, &[vtu::Field::scalar("radius", &radius)], &[])?;
        file.flush()?;
        println!("Wrote {path}.");
    }
    Ok(())
}
