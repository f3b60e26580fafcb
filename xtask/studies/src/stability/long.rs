//! Long runs: a free spinning roller, vibration without end, a thousand bounces, a long stick.

use anyhow::Result;
use stribeck_mesh::Disc;
use stribeck_report::plot::{Axis, Colour, Figure, Series};
use stribeck_solver::NodeMotion;
use stribeck_system::{Plan, System};

use super::Case;
use super::bars::POINTS;
use crate::rig::{THICKNESS, pair, penalty, rectangle, steel, stir, stop_reason, touching};

/// Drift that is allowed without contact and dissipation [-].
const DRIFT: f64 = 1e-6;

/// Rim radius [m] of the spinning roller and its speed [rad/s]: about that of the paper's rollers.
const ROLLER: (f64, f64) = (9e-3, 262.0);

/// The paper's roller, coarse, spinning free for 10⁷ steps.
fn spinning(figure: &mut Figure) -> Result<Case> {
    let (radius, spin) = ROLLER;
    let mut plan = Plan::new(THICKNESS);
    let disc = Disc { radius, facets: 16, size: 4e-3, rotation: 0.0 }.part()?;
    let body = plan.add("roller", &disc, steel())?.body;
    let rim = plan.nodes("roller.rim")?;
    let mut system = plan.build(1)?;
    system.set_time_step_factor(0.9)?;
    // Velocities half a step before the start.
    let (sin, cos) = (-0.5 * spin * system.time_step()).sin_cos();
    for node in system.nodes_of(body) {
        let [x, y] = system.position(node);
        let (x, y) = (cos * x - sin * y, sin * x + cos * y);
        system.set_velocity(node, [-spin * y, spin * x]);
    }
    let size = |system: &System| {
        let all = rim.iter().map(|&n| system.position(n)).map(|[x, y]| x.hypot(y));
        all.sum::<f64>() / rim.len() as f64
    };
    // Momenta are taken per step from the velocities there; the moment about the centre with positions half a
    // step on.
    let spun = |system: &System| angular(system, body);
    // The mesh's centre of mass lies a few nanometres beside the axis: the roller drifts on a straight line
    // from there.
    let (start, first) = ([size(&system), spun(&system)], system.motion_of(body));
    let (mut radius_drift, mut spin_drift, mut centre_drift) = (0.0_f64, 0.0_f64, 0.0_f64);
    let mut history = [Vec::new(), Vec::new(), Vec::new()];
    let (steps, every) = (10_000_000, 10_000);
    let findings = system.run(steps, every, |system, ledger| {
        let grown = (size(system) / start[0] - 1.0).abs();
        let turned = (spun(system) / start[1] - 1.0).abs();
        let at = system.motion_of(body).centre;
        radius_drift = radius_drift.max(grown);
        spin_drift = spin_drift.max(turned);
        let t = system.time();
        let off = [0, 1].map(|i| at[i] - first.centre[i] - first.velocity[i] * t);
        centre_drift = centre_drift.max(off[0].hypot(off[1]) / radius);
        let off = ledger.imbalance.abs() / ledger.kinetic;
        history[0].push(1e-6 * system.steps() as f64);
        history[1].push(off.max(1e-17).log10());
        history[2].push(turned.max(1e-17).log10());
    })?;
    let [time, energy, momentum] = history;
    figure.series.push(Series::listed("energy", Colour::Blue, time.clone(), energy));
    figure.series.push(Series::listed("angular momentum", Colour::Orange, time, momentum));
    let worst = system.balance().largest_error;
    let right = worst < DRIFT && spin_drift < 1e-9 && radius_drift < 1e-5 && centre_drift < 1e-6;
    let seen = format!(
        "{:.2} turns; angular momentum kept to {spin_drift:.0e}, its straight line to {centre_drift:.0e} \
         radii, radius to {radius_drift:.0e} (it breathes)",
        spin * system.time() / std::f64::consts::TAU
    );
    Ok(Case::of("10⁷ steps of a free spinning roller", worst, stop_reason(findings), right, seen))
}

/// Angular momentum about the centre of mass: position and velocity of a node at the same half step.
fn angular(system: &System, body: usize) -> f64 {
    let half = 0.5 * system.time_step();
    let moment = system.nodes_of(body).map(|n| {
        let ([x, y], [vx, vy]) = (system.position(n), system.velocity(n));
        // x at the half step of the velocity; x × v does not change by this for the sum of central forces.
        let (x, y) = (x - half * vx, y - half * vy);
        system.mass(n) * (x * vy - y * vx)
    });
    moment.sum()
}

/// A block that vibrates without dissipation or contact for 10⁶ steps.
fn vibrating() -> Result<Case> {
    let mut plan = Plan::new(THICKNESS);
    plan.add("block", &rectangle([0.0; 2], [0.01, 0.008], [5, 4])?, steel())?;
    let mut system = plan.build(1)?;
    system.set_time_step_factor(0.45)?;
    stir(&mut system, 1e-3);
    let stop = stop_reason(system.run(1_000_000, 100, |_, _| ())?);
    let worst = system.balance().largest_error;
    let right = worst < DRIFT;
    let seen = "no dissipation, no contact; every mode excited, half the critical step".to_owned();
    Ok(Case::of("10⁶ steps of a vibrating block", worst, stop, right, seen))
}

/// A disc between two fixed blocks, a thousand times to and fro without gravity.
fn bouncing() -> Result<Case> {
    let (radius, gap, speed) = (5e-3, 5e-6, 1.0);
    let mut plan = Plan::new(THICKNESS);
    let disc = Disc { radius, facets: 48, size: 1.5e-3, rotation: 0.0 }.part()?;
    let ball = plan.add("ball", &disc, steel())?.body;
    let (law, method) = (penalty(&steel(), 0.65e-3, 1.0)?, POINTS);
    for (wall, y, side) in [("below", -radius - gap - 1e-3, "top"), ("above", radius + gap, "bottom")] {
        plan.add(wall, &rectangle([-4e-3, y], [8e-3, 1e-3], [12, 2])?, steel())?;
        plan.constrain(wall, NodeMotion::Held)?;
        plan.contact(pair("ball.rim", &format!("{wall}.{side}"), law, method))?;
    }
    let mut system = plan.build(1)?;
    system.set_time_step_factor(0.9)?;
    system.launch(ball, [0.0, -speed], 0.0);
    let (mut bounces, mut touched) = (0, false);
    let mut stop = None;
    let mut rounds = 0;
    while bounces < 1000 && stop.is_none() && rounds < 60_000 {
        let findings = system.run(50, 25, |system, _| {
            let now = touching(system);
            bounces += usize::from(now && !touched);
            touched = now;
        })?;
        stop = stop_reason(findings);
        rounds += 1;
    }
    let motion = system.motion_of(ball);
    let (place, sideways) = (motion.centre, motion.velocity[0].abs() / speed);
    let right = bounces >= 1000 && place[1].abs() < 3.0 * gap && place[0].abs() < radius;
    let seen = format!(
        "{bounces} bounces in {} steps; still between its walls, {:.1} µm off the middle line, sideways \
         speed {sideways:.0e} of the first",
        system.steps(),
        1e6 * place[0]
    );
    Ok(Case::of("a thousand bounces of an elastic disc", system.balance().largest_error, stop, right, seen))
}

/// A block on a slope below the angle of friction, for 10⁶ steps.
fn sticking() -> Result<Case> {
    let (slope, friction) = (10_f64.to_radians(), 0.2);
    let mut plan = Plan::new(THICKNESS);
    plan.add("ground", &rectangle([-5e-3, -2e-3], [0.03, 2e-3], [15, 1])?, steel())?;
    let block = plan.add("block", &rectangle([0.0, 0.0], [0.01, 5e-3], [5, 3])?, steel())?.body;
    // Soft enough for a long time in few steps; damped, so that the sudden weight comes to rest.
    let law =
        penalty(&steel(), 2e-3, 1e-3)?.with_friction(friction)?.with_damping(0.2, 0.5 * 7800.0 * 2e-3)?;
    plan.contact(pair(
        "block.bottom",
        "ground.top",
        law,
        stribeck_contact::Method::Integrated { points: 3 },
    ))?;
    plan.constrain("ground", NodeMotion::Held)?;
    plan.model.gravity = [9.81 * slope.sin(), -9.81 * slope.cos()];
    let mut system = plan.build(1)?;
    system.set_time_step_factor(0.9)?;
    let place = |system: &System| system.motion_of(block).centre[0];
    let start = place(&system);
    let mut stop = stop_reason(system.run(200_000, 100, |_, _| ())?);
    let early = place(&system);
    if stop.is_none() {
        stop = stop_reason(system.run(800_000, 100, |_, _| ())?);
    }
    let crept = (place(&system) - early).abs();
    // Path of a sliding block in that time under the hundredth of its weight that friction does not balance.
    let time = 0.8 * system.time();
    let free = 0.5 * 9.81 * slope.sin() * time * time;
    let right = crept < 1e-3 * free;
    let seen = format!(
        "creeps {:.1e} m in {:.0} ms, after {:.1e} m to begin with (free it would have slid {free:.1e} m)",
        crept,
        1e3 * time,
        (early - start).abs()
    );
    Ok(Case::of(
        "10⁶ steps of sticking on a slope of 10° with µ = 0.2",
        system.balance().largest_error,
        stop,
        right,
        seen,
    ))
}

pub(super) fn cases() -> Result<(Vec<Case>, Figure)> {
    let (x, y) = (Axis::plain("Steps", "10⁶"), Axis::plain("log₁₀ of the relative drift", ""));
    let mut figure = Figure::new("spin", "A free spinning roller over 10⁷ steps", x, y);
    let cases = vec![vibrating()?, spinning(&mut figure)?, bouncing()?, sticking()?];
    Ok((cases, figure))
}
