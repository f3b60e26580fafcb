//! Two bars that meet: contact stiffness from soft to hard, and contrasts between bodies.

use anyhow::Result;
use stribeck_contact::Method;
use stribeck_solver::{Elastic, NodeMotion};
use stribeck_system::Plan;

use super::Case;
use crate::Rows;
use crate::rig::{THICKNESS, pair, penalty, rectangle, steel, stop_reason, touching};

/// Length of a bar [m] and its cells.
const BAR: (f64, usize) = (0.02, 40);
pub(super) const POINTS: Method = Method::Integrated { points: 4 };

/// A collision of two bars and its outcome.
pub(super) struct Collision {
    pub(super) energy: f64,
    pub(super) stop: Option<String>,
    /// Mean velocities before and after [m/s].
    pub(super) before: [f64; 2],
    pub(super) after: [f64; 2],
    mass: [f64; 2],
    /// Time in contact [s].
    time: f64,
    steps: u64,
}

impl Collision {
    /// Drift of momentum over the exchanged momentum.
    pub(super) fn momentum(&self) -> f64 {
        let of = |v: [f64; 2]| self.mass[0] * v[0] + self.mass[1] * v[1];
        let exchanged = self.mass[0] * (self.after[0] - self.before[0]).abs();
        (of(self.after) - of(self.before)).abs() / exchanged.max(f64::MIN_POSITIVE)
    }

    /// Speed of parting over speed of approach.
    fn restitution(&self) -> f64 {
        (self.after[1] - self.after[0]) / (self.before[0] - self.before[1])
    }

    fn words(&self) -> String {
        let (restitution, momentum) = (self.restitution(), self.momentum());
        format!("restitution {restitution:.4}, momentum kept to {momentum:.0e}, {} steps", self.steps)
    }
}

/// Two bars with sides held meet at `speed` [m/s]. `place` is where, `unit` multiplies every length.
pub(super) fn collide(
    materials: [Elastic; 2],
    scale: f64,
    speed: f64,
    method: Method,
    place: f64,
    unit: f64,
) -> Result<Collision> {
    let (length, cells) = (BAR.0 * unit, BAR.1);
    let size = length / cells as f64;
    let mut plan = Plan::new(THICKNESS);
    let block = |x: f64| rectangle([place + x, place], [length, 2.0 * size], [cells, 2]);
    let a = plan.add("a", &block(-length)?, materials[0])?.body;
    let b = plan.add("b", &block(0.02 * size)?, materials[1])?.body;
    let first_is_softer = materials[0].youngs_modulus() < materials[1].youngs_modulus();
    let softer = if first_is_softer { &materials[0] } else { &materials[1] };
    plan.contact(pair("a.right", "b.left", penalty(softer, size, scale)?, method))?;
    plan.constrain("a", NodeMotion::HeldY)?;
    plan.constrain("b", NodeMotion::HeldY)?;
    let mut system = plan.build(1)?;
    system.set_time_step_factor(0.9)?;
    system.launch(a, [speed, 0.0], 0.0);
    let before = [a, b].map(|body| system.motion_of(body).velocity[0]);
    let mass = [a, b].map(|body| system.motion_of(body).mass);
    // Two round trips of the slowest wave, and a period of a soft spring.
    let slowest = materials.iter().map(Elastic::dilatational_speed).fold(f64::INFINITY, f64::min);
    let swing = 4.0 * length / slowest * (1.0 + (0.03 / scale).sqrt() * 2.0);
    let swing = swing * if materials[0].density() == materials[1].density() { 1.0 } else { 3.0 };
    let steps = ((swing + 0.02 * size / speed) / system.time_step()) as u64;
    let (mut touched, dt) = (0_u64, system.time_step());
    let findings = system.run(steps, 5, |system, _| touched += 5 * u64::from(touching(system)))?;
    let (energy, stop) = (system.balance().largest_error, stop_reason(findings));
    let after = [a, b].map(|body| system.motion_of(body).velocity[0]);
    Ok(Collision { energy, stop, before, after, mass, time: touched as f64 * dt, steps })
}

pub(super) fn cases(rows: &mut Rows) -> Result<Vec<Case>> {
    let mut cases = Vec::new();
    for scale in [1e-2, 1e-1, 1.0, 10.0, 100.0, 1e3, 1e4] {
        let c = collide([steel(); 2], scale, 1.0, POINTS, 0.0, 1.0)?;
        let done = format!("bar impact at 1 m/s, penalty × {scale:e}");
        let values = [("penalty scale", scale), ("steps", c.steps as f64)];
        rows.values("Contact stiffness and contrasts", &done, values);
        let theory = 2.0 * BAR.0 / steel().dilatational_speed();
        let right = c.momentum() < 1e-9 && (scale < 0.5 || (c.time / theory - 1.0).abs() < 0.05);
        let seen = format!("in contact for {:.3} × 2L/c, {}", c.time / theory, c.words());
        cases.push(Case::of(done, c.energy, c.stop, right, seen));
    }
    let contrast = |done: &str, second: Elastic, scale: f64, method: Method| -> Result<Case> {
        // A thousandth of the slowest wave: strains of about that.
        let speed = 1e-3 * second.dilatational_speed().min(steel().dilatational_speed());
        let c = collide([steel(), second], scale, speed, method, 0.0, 1.0)?;
        let right = c.momentum() < 1e-6 && (0.0..=1.001).contains(&c.restitution());
        let seen = c.words();
        Ok(Case::of(done, c.energy, c.stop, right, seen))
    };
    let soft = Elastic::new(208e3, 0.3, 7800.0)?;
    for (name, second) in [
        ("E contrast 10⁶", soft),
        ("E contrast 10⁻⁶", Elastic::new(208e15, 0.3, 7800.0)?),
        ("ρ contrast 10⁶", Elastic::new(208e9, 0.3, 7.8e-3)?),
        ("ρ contrast 10⁻⁶", Elastic::new(208e9, 0.3, 7.8e9)?),
    ] {
        cases.push(contrast(&format!("collision of two bars, {name}"), second, 1.0, POINTS)?);
    }
    // A contact 10⁶ times as stiff as one body's cells, as that of a hard body on a soft one would be.
    let done = "hard bar on a soft one (E 10⁶ : 1), contact as stiff as the hard one";
    cases.push(contrast(done, soft, 1e6, Method::Collocated)?);
    Ok(cases)
}
