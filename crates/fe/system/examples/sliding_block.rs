//! A block slides to rest under Coulomb friction, after the way v²/(2µg).

use stribeck_contact::Law;
use stribeck_mesh::Rectangle;
use stribeck_solver::{Elastic, NodeMotion};
use stribeck_system::{Pair, Plan, Preload, UndecidedMotion};

/// Relative error of the way to rest [-].
pub(crate) fn error() -> Result<f64, Box<dyn std::error::Error>> {
    let (speed, friction, gravity) = (0.5, 0.3, 9.81);
    let block = Rectangle { x0: 0.0, y0: 0.0, width: 0.04, height: 0.02, columns: 8, rows: 4 }.part()?;
    let floor = Rectangle { x0: -0.01, y0: -0.01, width: 0.14, height: 0.01, columns: 28, rows: 1 }.part()?;
    let steel = Elastic::new(208e9, 0.3, 7800.0)?;
    let mut plan = Plan::new(0.02);
    plan.model.gravity = [0.0, -gravity];
    let body = plan.add("block", &block, steel)?.body;
    plan.add("floor", &floor, steel)?;
    plan.constrain("floor", NodeMotion::Held)?;
    let law = Law::penalty(1e12)?.with_friction(friction)?;
    plan.contact(Pair::new("block.bottom", "floor.top", law))?;

    let mut system = plan.build(1)?;
    // Statics cannot say where on the floor the block stands.
    let undecided = vec![UndecidedMotion { body, along: Some([1.0, 0.0]), rotation: false }];
    system.settle(&Preload { undecided, ..Preload::default() })?;
    system.set_time_step_factor(0.9)?;
    system.launch(body, [speed, 0.0], 0.0);
    let start = system.motion_of(body).centre[0];
    system.run_until(1.2 * speed / (friction * gravity))?;
    let way = system.motion_of(body).centre[0] - start;
    Ok(way / (speed * speed / (2.0 * friction * gravity)) - 1.0)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!("way to rest: {:+.2} % from v²/(2µg)", 100.0 * error()?);
    Ok(())
}
