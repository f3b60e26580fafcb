//! Slivers, aspect ratios, one very small cell, far away from the origin, very small and very large.

use anyhow::Result;
use stribeck_contact::Method;
use stribeck_mesh::Part;
use stribeck_system::Plan;

use super::limit::split;
use super::stiffness::collide;
use super::{Case, Chapter};
use crate::rig::{THICKNESS, rectangle, steel, stir, stop_reason};

/// Momentum of a stirred free body may drift by this over the sum of its nodes' momenta.
const ROUNDING: f64 = 1e-10;

/// A stirred free body of this shape keeps energy and momentum over 20 000 steps.
fn stirred(done: &str, part: &Part) -> Result<Case> {
    let mut plan = Plan::new(THICKNESS);
    let body = plan.add("block", part, steel())?.body;
    let mut system = plan.build(1)?;
    system.set_time_step_factor(0.9)?;
    stir(&mut system, 0.01);
    let before = system.motion_of(body).velocity;
    let stop = stop_reason(system.run(20_000, 20, |_, _| ())?);
    let after = system.motion_of(body).velocity;
    let drift = (after[0] - before[0]).hypot(after[1] - before[1]) / 0.01;
    let seen = format!("time step {:.3e} s, momentum kept to {drift:.0e}", system.time_step());
    Ok(Case::of(done, system.balance().largest_error, stop, drift < ROUNDING, seen))
}

/// Columns of a rectangle, one of them `narrow` times as wide as the others.
fn one_narrow(narrow: f64) -> Result<Part> {
    let mut part = rectangle([0.0; 2], [0.01, 0.004], [10, 4])?;
    for x in &mut part.x {
        let column = (*x / 1e-3).round();
        *x = if column <= 5.0 { column * 1e-3 } else { (column - 1.0 + narrow) * 1e-3 };
    }
    Ok(part)
}

pub(super) fn chapter() -> Result<Chapter> {
    let mut cases = vec![
        stirred("cells of aspect 100", &rectangle([0.0; 2], [0.01, 0.4e-3], [10, 40])?)?,
        stirred("triangles of aspect 100", &split(rectangle([0.0; 2], [0.01, 0.4e-3], [10, 40])?))?,
        stirred("one column a hundredth as wide", &one_narrow(0.01)?)?,
        stirred("one column a ten-thousandth as wide", &one_narrow(1e-4)?)?,
    ];
    let mut sliver = split(rectangle([0.0; 2], [0.01, 0.004], [10, 4])?);
    // An inner node comes close to the opposite side of one of its triangles.
    let n = 2 * 11 + 5;
    sliver.y[n] -= 0.998e-3;
    cases.push(stirred("a sliver of 2 µm among triangles of 1 mm", &sliver)?);

    let method = Method::Integrated { points: 4 };
    let home = collide([steel(); 2], 1.0, 1.0, method, 0.0, 1.0)?;
    for (done, place, unit) in [
        ("bar impact, 1 km from the origin", 1e3, 1.0),
        ("bar impact, 100 km from the origin", 1e5, 1.0),
        ("bar impact, bars of 20 nm", 0.0, 1e-6),
        ("bar impact, bars of 20 km", 0.0, 1e6),
    ] {
        let c = collide([steel(); 2], 1.0, 1.0, method, place, unit)?;
        let off = (c.after[0] - home.after[0]).abs().max((c.after[1] - home.after[1]).abs());
        let right = off < 2e-3 && c.momentum() < 1e-6;
        let seen = format!(
            "velocities within {off:.1e} m/s of those at home, momentum kept to {:.0e}",
            c.momentum()
        );
        cases.push(Case::of(done, c.energy, c.stop, right, seen));
    }
    Ok(Chapter {
        title: "Shapes, places and units",
        words: "Free blocks whose nodes start with random velocities, 20 000 steps; and the bar impact again \
            elsewhere and in other \
                sizes, where it must come out as at home.",
        cases,
        figures: Vec::new(),
    })
}
