//! A free ring in its lowest bending mode, at the frequency f = n (n² − 1)/(2πR²) √(E'I/(ρA(n² + 1))) with n
//! = 2 (Love, *A Treatise on the Mathematical Theory of Elasticity*, 1927, §293; E' is that of plane strain).

use std::f64::consts::TAU;
use stribeck_mesh::Annulus;
use stribeck_solver::Elastic;
use stribeck_system::Plan;

/// Relative error of the frequency [-].
pub(crate) fn error() -> Result<f64, Box<dyn std::error::Error>> {
    let (inner_radius, outer_radius, thickness, grooves) = (0.098, 0.102, 0.004, Vec::new());
    let ring = Annulus { inner_radius, outer_radius, facets: 314, layers: 2, start_angle: 0.0, grooves };
    let steel = Elastic::new(208e9, 0.3, 7800.0)?;
    let mut plan = Plan::new(0.02);
    plan.add("ring", &ring.part()?, steel)?;
    let mut system = plan.build(1)?;
    system.set_time_step_factor(0.9)?;
    // Velocities of the mode: radial cos 2θ, hoop −½ sin 2θ at mid-depth, as cross-sections stay plane.
    for node in system.nodes("ring")? {
        let [x, y] = system.position(node);
        let ((s, c), depth) = (y.atan2(x).sin_cos(), 1.0 - x.hypot(y) / 0.1);
        let (radial, hoop) = (0.01 * (c * c - s * s), -0.01 * s * c * (1.0 - 3.0 * depth));
        system.set_velocity(node, [radial * c - hoop * s, radial * s + hoop * c]);
    }
    let bending = steel.plane_strain_modulus() * thickness * thickness / (12.0 * steel.density());
    let expected = 6.0 / (TAU * 0.01) * (bending / 5.0).sqrt();
    // The node at angle 0 passes its place outwards once a period.
    let (mut passed, mut before) = (Vec::new(), 0.0);
    while passed.len() < 3 {
        system.step()?;
        let outwards = system.position(0)[0] - inner_radius;
        passed.extend((before < 0.0 && outwards >= 0.0).then(|| system.time()));
        before = outwards;
    }
    Ok(2.0 / (passed[2] - passed[0]) / expected - 1.0)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!("frequency: {:+.2} % from Love's", 100.0 * error()?);
    Ok(())
}
