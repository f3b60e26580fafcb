//! Long runs: a free spinning roller, vibration without end, a thousand bounces, a long stick; loads that go away.

use anyhow::Result;
use stribeck_analysis::plot::{Axis, Colour, Figure, Series};
use stribeck_contact::Method;
use stribeck_mesh::Disc;
use stribeck_solver::Motion;

use super::{Case, Chapter};
use crate::rig::{Plan, Rig, THICKNESS, penalty, rectangle, steel};

/// Drift that is allowed without contact and dissipation [-].
const DRIFT: f64 = 1e-6;

/// Rim radius [m] of the spinning roller and its speed [rad/s]: about that of the paper's rollers.
const ROLLER: (f64, f64) = (9e-3, 262.0);

/// The paper's roller, coarse, spinning free for 10⁷ steps.
fn spinning(figure: &mut Figure) -> Result<Case> {
    let (radius, spin) = ROLLER;
    let mut plan = Plan::default();
    let body = plan.add(&Disc { radius, facets: 16, size: 4e-3, rotation: 0.0 }.part()?);
    let rim = plan.nodes(body, "rim").nodes.clone();
    let mut rig = plan.lay_out(&plan.model(steel())?)?;
    rig.set_step(0.9)?;
    // Velocities half a step before the start.
    let (sin, cos) = (-0.5 * spin * rig.dynamics.time_step()).sin_cos();
    let s = &mut rig.dynamics.state;
    for &n in &rig.bodies[body] {
        let n = n as usize;
        let (x, y) = (cos * s.x[n] - sin * s.y[n], sin * s.x[n] + cos * s.y[n]);
        (s.vx[n], s.vy[n]) = (-spin * y, spin * x);
    }
    let size = |rig: &Rig| {
        let s = &rig.dynamics.state;
        let all = rim.iter().map(|&n| s.x[rig.slot(n)].hypot(s.y[rig.slot(n)]));
        all.sum::<f64>() / rim.len() as f64
    };
    // Momenta are taken per step from the velocities there; the moment about the centre with positions half a step on.
    let spun = |rig: &Rig| angular(rig, &rig.bodies[0]);
    // The mesh's centre of mass lies a few nanometres beside the axis: the roller drifts on a straight line from there.
    let (start, first) = ([size(&rig), spun(&rig)], rig.dynamics.rigid_motion(&rig.bodies[0]));
    let (mut radius_drift, mut spin_drift, mut centre_drift) = (0.0_f64, 0.0_f64, 0.0_f64);
    let mut history = [Vec::new(), Vec::new(), Vec::new()];
    let (steps, every) = (10_000_000, 10_000);
    let stop = rig.run(steps, every, |rig, energies| {
        let grown = (size(rig) / start[0] - 1.0).abs();
        let turned = (spun(rig) / start[1] - 1.0).abs();
        let at = rig.dynamics.rigid_motion(&rig.bodies[0]).centre;
        radius_drift = radius_drift.max(grown);
        spin_drift = spin_drift.max(turned);
        let t = rig.dynamics.state.time;
        let off = [0, 1].map(|i| at[i] - first.centre[i] - first.velocity[i] * t);
        centre_drift = centre_drift.max(off[0].hypot(off[1]) / radius);
        let off = energies.balance.abs() / energies.kinetic;
        history[0].push(1e-6 * rig.dynamics.state.step as f64);
        history[1].push(off.max(1e-17).log10());
        history[2].push(turned.max(1e-17).log10());
    });
    let [time, energy, momentum] = history;
    figure.series.push(Series::listed("energy", Colour::Blue, time.clone(), energy));
    figure.series.push(Series::listed("angular momentum", Colour::Orange, time, momentum));
    let right = rig.worst < DRIFT && spin_drift < 1e-9 && radius_drift < 1e-5 && centre_drift < 1e-6;
    let seen = format!(
        "{:.2} turns; angular momentum kept to {spin_drift:.0e}, its straight line to {centre_drift:.0e} radii, radius to {radius_drift:.0e} (it \
         breathes)",
        spin * rig.dynamics.state.time / std::f64::consts::TAU
    );
    Ok(Case::of("10⁷ steps of a free spinning roller", rig.worst, stop, right, seen))
}

/// Angular momentum about the centre of mass: position and velocity of a node at the same half step.
fn angular(rig: &Rig, slots: &[u32]) -> f64 {
    let (d, half) = (&rig.dynamics, 0.5 * rig.dynamics.time_step());
    let s = &d.state;
    let moment = slots.iter().map(|&n| {
        let n = n as usize;
        // x at the half step of the velocity; x × v does not change by this for the sum of central forces.
        let (x, y) = (s.x[n] - half * s.vx[n], s.y[n] - half * s.vy[n]);
        d.mass()[n] * (x * s.vy[n] - y * s.vx[n])
    });
    moment.sum()
}

/// A block that vibrates without dissipation or contact for 10⁶ steps.
fn vibrating() -> Result<Case> {
    let mut plan = Plan::default();
    plan.add(&rectangle([0.0; 2], [0.01, 0.008], [5, 4])?);
    let mut rig = plan.lay_out(&plan.model(steel())?)?;
    rig.set_step(0.45)?;
    rig.stir(1e-3);
    let stop = rig.run(1_000_000, 100, |_, _| {});
    let right = rig.worst < DRIFT;
    let seen = "no dissipation, no contact; every mode excited, half the critical step".to_owned();
    Ok(Case::of("10⁶ steps of a vibrating block", rig.worst, stop, right, seen))
}

/// A disc between two fixed blocks, a thousand times to and fro without gravity.
fn bouncing() -> Result<Case> {
    let (radius, gap, speed) = (5e-3, 5e-6, 1.0);
    let mut plan = Plan::default();
    let disc = Disc { radius, facets: 48, size: 1.5e-3, rotation: 0.0 }.part()?;
    let ball = plan.add(&disc);
    let [low, high] = [-radius - gap - 1e-3, radius + gap];
    let below = plan.add(&rectangle([-4e-3, low], [8e-3, 1e-3], [12, 2])?);
    let above = plan.add(&rectangle([-4e-3, high], [8e-3, 1e-3], [12, 2])?);
    let (law, method) = (penalty(&steel(), 0.65e-3, 1.0)?, Method::Integrated { points: 4 });
    plan.touch((ball, "rim"), (below, "top"), law, method);
    plan.touch((ball, "rim"), (above, "bottom"), law, method);
    let mut model = plan.model(steel())?;
    for body in [below, above] {
        for n in model.mesh.bodies[body].nodes.clone() {
            model.motion[n] = Motion::Held;
        }
    }
    let mut rig = plan.lay_out(&model)?;
    rig.set_step(0.9)?;
    rig.launch(ball, [0.0, -speed]);
    let (mut bounces, mut touching) = (0, false);
    let mut stop = None;
    let mut rounds = 0;
    while bounces < 1000 && stop.is_none() && rounds < 60_000 {
        stop = rig.run(50, 25, |rig, _| {
            let now = rig.contacts.resultants().any(|r| r.force != [0.0; 2]);
            bounces += usize::from(now && !touching);
            touching = now;
        });
        rounds += 1;
    }
    let sideways = rig.velocity(ball)[0].abs() / speed;
    let place = rig.dynamics.rigid_motion(&rig.bodies[ball]).centre;
    let right = bounces >= 1000 && place[1].abs() < 3.0 * gap && place[0].abs() < radius;
    let seen = format!(
        "{bounces} bounces in {} steps; still between its walls, {:.1} µm off the middle line, sideways speed {sideways:.0e} of the first",
        rig.dynamics.state.step,
        1e6 * place[0]
    );
    Ok(Case::of("a thousand bounces of an elastic disc", rig.worst, stop, right, seen))
}

/// A block on a slope below the angle of friction, for 10⁶ steps.
fn sticking() -> Result<Case> {
    let (slope, friction) = (10_f64.to_radians(), 0.2);
    let mut plan = Plan::default();
    let ground = plan.add(&rectangle([-5e-3, -2e-3], [0.03, 2e-3], [15, 1])?);
    let block = plan.add(&rectangle([0.0, 0.0], [0.01, 5e-3], [5, 3])?);
    // Soft enough for a long time in few steps; damped, so that the sudden weight comes to rest.
    let law =
        penalty(&steel(), 2e-3, 1e-3)?.with_friction(friction)?.with_damping(0.2, 0.5 * 7800.0 * 2e-3)?;
    plan.touch((block, "bottom"), (ground, "top"), law, Method::Integrated { points: 3 });
    let mut model = plan.model(steel())?;
    for n in model.mesh.bodies[ground].nodes.clone() {
        model.motion[n] = Motion::Held;
    }
    model.gravity = [9.81 * slope.sin(), -9.81 * slope.cos()];
    let mut rig = plan.lay_out(&model)?;
    rig.set_step(0.9)?;
    let place = |rig: &Rig| rig.dynamics.rigid_motion(&rig.bodies[block]).centre[0];
    let start = place(&rig);
    let stop = rig.run(200_000, 100, |_, _| {});
    let early = place(&rig);
    let stop = stop.or_else(|| rig.run(800_000, 100, |_, _| {}));
    let crept = (place(&rig) - early).abs();
    // What a sliding block would have done in that time under the hundredth of its weight that friction leaves over.
    let time = 0.8 * rig.dynamics.state.time;
    let free = 0.5 * 9.81 * slope.sin() * time * time;
    let right = crept < 1e-3 * free;
    let seen = format!(
        "creeps {:.1e} m in {:.0} ms, after {:.1e} m to begin with (free it would have slid {free:.1e} m)",
        crept,
        1e3 * time,
        (early - start).abs()
    );
    Ok(Case::of("10⁶ steps of sticking on a slope of 10° with µ = 0.2", rig.worst, stop, right, seen))
}

pub(super) fn chapter() -> Result<Chapter> {
    let mut figure = Figure::new(
        "spin",
        "A free spinning roller over 10⁷ steps",
        Axis::plain("Steps", "10⁶"),
        Axis::plain("log₁₀ of the relative drift", ""),
    )
    .caption("What drifts is rounding.");
    let cases = vec![vibrating()?, spinning(&mut figure)?, bouncing()?, sticking()?];
    Ok(Chapter {
        title: "Long runs",
        words: "Drift where nothing should drift: energy to 10⁻⁶, momenta to rounding.",
        cases,
        figures: vec![figure],
    })
}

/// Loads that vanish or turn round while a block is pressed on another.
pub(super) fn loads() -> Result<Chapter> {
    let mut cases = Vec::new();
    for (done, factor) in [("removed", 0.0), ("reversed", -1.0), ("ten times as large at once", 10.0)] {
        let size = [8e-3, 4e-3];
        let mut plan = Plan::default();
        let lower = plan.add(&rectangle([0.0, -size[1]], size, [8, 4])?);
        let upper = plan.add(&rectangle([1.2e-3, 1e-9], [0.7 * size[0], size[1]], [6, 4])?);
        let method = Method::Integrated { points: 4 };
        plan.touch((upper, "bottom"), (lower, "top"), penalty(&steel(), 1e-3, 1.0)?, method);
        let mut model = plan.model(steel())?;
        for &n in &plan.nodes(lower, "bottom").nodes {
            model.motion[n as usize] = Motion::Held;
        }
        let mut rig = plan.lay_out(&model)?;
        let force = 100e6 * 0.7 * size[0] * THICKNESS;
        rig.push(&plan.nodes(upper, "top").nodes, [0.0, -force]);
        rig.settle(1.0)?;
        rig.set_step(0.9)?;
        let stop = rig.run(500, 5, |_, _| {});
        rig.scale_loads(factor);
        let stop = stop.or_else(|| rig.run(1500, 5, |_, _| {}));
        let leaves = rig.velocity(upper)[1];
        let touching = rig.contacts.resultants().any(|r| r.force != [0.0; 2]);
        let right =
            if factor > 0.0 { rig.contacts.resultants().all(|r| r.penetration < 1e-4) } else { leaves > 0.0 };
        let seen = format!(
            "the block {} at {leaves:.3} m/s, {}",
            if leaves > 0.0 { "rises" } else { "sinks" },
            if touching { "touching" } else { "free" }
        );
        cases.push(Case::of(
            format!("100 MPa between two blocks, the load {done} in mid-run"),
            rig.worst,
            stop,
            right,
            seen,
        ));
    }
    Ok(Chapter {
        title: "Loads that change in mid-run",
        words: "A block pressed on another in static equilibrium; after 500 steps the load changes at once.",
        cases,
        figures: Vec::new(),
    })
}
