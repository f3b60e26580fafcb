//! A disc pressed between two rigid plates. Its centre comes nearer to each by δ = a²/(4R) (2 ln(4R/a) − 1),
//! where the line load P makes the half-width a = √(4PR/(πE*)) (Johnson, *Contact Mechanics*, 1985, §4.2 and
//! §5.6).

use std::f64::consts::PI;
use stribeck_contact::{Law, Smoothing};
use stribeck_mesh::{Disc, Rectangle};
use stribeck_solver::{Elastic, NodeMotion};
use stribeck_system::{Pair, Plan, Preload, UndecidedMotion};

/// Relative error of the approach under the load that was found [-].
pub(crate) fn error() -> Result<f64, Box<dyn std::error::Error>> {
    let (radius, approach, thickness) = (0.01, 15e-6, 0.02);
    let disc = Disc { radius, facets: 720, size: 4e-4, rotation: 0.0 }.part()?;
    let plate = Rectangle { x0: -2e-3, y0: 0.0, width: 4e-3, height: 1e-3, columns: 20, rows: 5 }.part()?;
    let steel = Elastic::new(208e9, 0.3, 7800.0)?;
    let mut plan = Plan::new(thickness);
    let body = plan.add("disc", &disc, steel)?.body;
    plan.smooth("disc.rim", Smoothing::Arc { centre: [0.0; 2] }, false)?;
    plan.constrain("disc.centre", NodeMotion::HeldX)?;
    let law = Law::penalty(20.0 * steel.plane_strain_modulus() / 1e-4)?;
    let reach = radius - approach;
    for (name, y, side) in [("floor", -reach - 1e-3, "top"), ("roof", reach, "bottom")] {
        plan.add(name, &plate.translated(0.0, y), steel)?;
        plan.constrain(name, NodeMotion::Held)?;
        plan.contact(Pair::new("disc.rim", &format!("{name}.{side}"), law))?;
    }

    let mut system = plan.build(1)?;
    let undecided = vec![UndecidedMotion { body, along: None, rotation: true }];
    system.settle(&Preload { undecided, load: Some(1e4), ..Preload::default() })?;
    let load = system.resultant("disc.rim and floor.top")?.force[1] / thickness;
    let half_width = (4.0 * load * radius / (PI * steel.plane_strain_modulus())).sqrt();
    let expected = half_width * half_width / (4.0 * radius) * (2.0 * (4.0 * radius / half_width).ln() - 1.0);
    Ok(approach / expected - 1.0)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!("approach: {:+.2} % from Johnson's", 100.0 * error()?);
    Ok(())
}
