//! A bar hits an equal one at rest. The compression wave runs to the far end of each and back as tension, so
//! they part after 2L/c (Goldsmith, *Impact*, 1960, §2.2).

use stribeck_contact::Law;
use stribeck_mesh::Rectangle;
use stribeck_solver::{Elastic, NodeMotion};
use stribeck_system::{Pair, Plan};

/// Relative error of the contact time [-].
pub(crate) fn error() -> Result<f64, Box<dyn std::error::Error>> {
    let (length, columns) = (0.1, 400);
    let bar = Rectangle { x0: 0.0, y0: 0.0, width: length, height: 0.001, columns, rows: 4 }.part()?;
    let steel = Elastic::new(208e9, 0.3, 7800.0)?;
    let mut plan = Plan::new(0.02);
    plan.add("striker", &bar.translated(-length, 0.0), steel)?;
    plan.add("bar", &bar, steel)?;
    // Held sides make plane waves, whose speed is c = √((λ + 2µ)/ρ).
    plan.model.motion.fill(NodeMotion::HeldY);
    // As stiff as one cell.
    let law = Law::penalty(steel.plane_strain_modulus() * columns as f64 / length)?;
    plan.contact(Pair::new("striker.right", "bar.left", law))?;

    let mut system = plan.build(1)?;
    system.set_time_step_factor(0.9)?;
    system.launch(system.body("striker")?, [2.0, 0.0], 0.0);
    let expected = 2.0 * length / steel.dilatational_speed();
    let mut touching = 0.0;
    while system.time() < 1.5 * expected {
        system.step()?;
        let force = system.resultant("striker.right and bar.left")?.force[0];
        touching += if force < 0.0 { system.time_step() } else { 0.0 };
    }
    Ok(touching / expected - 1.0)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!("contact time: {:+.2} % from 2L/c", 100.0 * error()?);
    Ok(())
}
