//! The time step: where instability sets in, per element type and with contact, against the computed limit.

use anyhow::Result;
use stribeck_contact::Method;
use stribeck_mesh::{Annulus, Disc, Part};
use stribeck_report::plot::{Axis, Colour, Figure, Series};
use stribeck_solver::NodeMotion;
use stribeck_system::{Plan, Preload, Snapshot, System};

use super::{Case, Chapter, Verdict};
use crate::rig::{THICKNESS, pair, penalty, rectangle, steel, stir};

/// Speed of the noise that an instability grows from [m/s].
const NOISE: f64 = 1e-4;
/// Growth that counts as unstable; a stable model's noise wanders by less than ten.
const GROWN: f64 = 1e3;
/// Steps in which an instability 0.1 % above the limit grows by e^350.
const STEPS: u64 = 4000;
/// The onset must lie this close to the computed limit.
const SHARP: f64 = 0.01;

/// A system at rest from which every trial starts.
struct Bench {
    system: System,
    rest: Snapshot,
}

impl Bench {
    fn new(system: System) -> Self {
        let rest = system.snapshot();
        Self { system, rest }
    }

    /// Growth of noise over this number of steps of `dt` [s].
    fn growth(&mut self, dt: f64, steps: u64) -> Result<f64> {
        let system = &mut self.system;
        system.set_time_step(dt, None)?;
        system.restore(self.rest.clone())?;
        stir(system, NOISE);
        let start = system.fastest_node().1;
        let mut grown = 1.0;
        for n in 0..steps {
            system.step()?;
            if n % 200 == 199 {
                grown = system.fastest_node().1 / start;
                // A speed that is no number any more has grown beyond all numbers.
                if grown.is_nan() {
                    grown = f64::INFINITY;
                }
                if grown > 1e30 {
                    break;
                }
            }
        }
        Ok(grown)
    }

    /// Smallest unstable time step over `limit`, to 0.1 %.
    fn onset(&mut self, limit: f64) -> Result<f64> {
        let (mut stable, mut unstable) = (0.5, 1.5);
        while unstable - stable > 1e-3 {
            let middle = 0.5 * (stable + unstable);
            if self.growth(middle * limit, STEPS)? > GROWN { unstable = middle } else { stable = middle }
        }
        Ok(unstable)
    }
}

/// Inner nodes moved at random by up to a fifth of a cell.
fn distorted(columns: usize, rows: usize, size: f64) -> Result<Part> {
    let mut part = rectangle([0.0; 2], [columns as f64 * size, rows as f64 * size], [columns, rows])?;
    let mut seed = 3_u64;
    for row in 1..rows {
        for column in 1..columns {
            let n = row * (columns + 1) + column;
            for of in [&mut part.x[n], &mut part.y[n]] {
                seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                *of += 0.4 * size * ((seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5);
            }
        }
    }
    Ok(part)
}

/// Every quadrilateral as two triangles.
pub(crate) fn split(mut part: Part) -> Part {
    part.triangles = part.quads.drain(..).flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    part
}

fn alone(part: &Part) -> Result<System> {
    let mut plan = Plan::new(THICKNESS);
    plan.add("body", part, steel())?;
    Ok(plan.build(1)?)
}

/// Two blocks pressed together by 100 MPa.
pub(super) fn pressed(method: Method, scale: f64) -> Result<System> {
    let (size, [width, height]) = (1e-3, [8e-3, 4e-3]);
    let mut plan = Plan::new(THICKNESS);
    plan.add("lower", &rectangle([0.0, -height], [width, height], [8, 4])?, steel())?;
    // Narrower, so that no corner sits on the edge of a corner.
    plan.add("upper", &rectangle([1.2e-3, 1e-9], [0.7 * width, height], [6, 4])?, steel())?;
    plan.contact(pair("upper.bottom", "lower.top", penalty(&steel(), size, scale)?, method))?;
    plan.constrain("lower.bottom", NodeMotion::Held)?;
    plan.load("upper.top", [0.0, -100e6 * 0.7 * width * THICKNESS])?;
    let mut system = plan.build(1)?;
    system.settle(&Preload::default())?;
    Ok(system)
}

pub(super) fn chapter() -> Result<Chapter> {
    let ring = Annulus {
        inner_radius: 0.02,
        outer_radius: 0.026,
        facets: 60,
        layers: 4,
        start_angle: 0.0,
        grooves: Vec::new(),
    };
    let bodies: [(&str, Part); 5] = [
        ("squares", rectangle([0.0; 2], [8e-3, 6e-3], [8, 6])?),
        ("distorted quadrilaterals", distorted(8, 6, 1e-3)?),
        ("triangles", split(distorted(8, 6, 1e-3)?)),
        (
            "disc of quadrilaterals and triangles",
            Disc { radius: 9e-3, facets: 32, size: 2e-3, rotation: 0.1 }.part()?,
        ),
        ("ring in strips", ring.part()?),
    ];
    let mut cases = Vec::new();
    let mut figure = Figure::new(
        "limit",
        "Growth of noise in 2000 steps",
        Axis::plain("Time step over the computed limit", ""),
        Axis::plain("log₁₀ of the growth", ""),
    )
    .caption("Below the limit noise stays noise; above it every step multiplies it.");
    let factors: Vec<f64> = (0..=24).map(|i| 0.5 + 0.025 * f64::from(i)).chain([0.995, 1.005]).collect();
    let mut factors = factors;
    factors.sort_by(f64::total_cmp);
    let mut curve = |name: &str, colour, bench: &mut Bench, limit: f64| -> Result<()> {
        let grown =
            factors.iter().map(|f| bench.growth(f * limit, 2000).map(|g| g.clamp(1e-3, 1e30).log10()));
        let series = Series::listed(name, colour, factors.clone(), grown.collect::<Result<_>>()?);
        figure.series.push(series);
        Ok(())
    };
    for (i, (name, part)) in bodies.iter().enumerate() {
        let mut bench = Bench::new(alone(part)?);
        let limit = bench.system.critical_time_step();
        let onset = bench.onset(limit)?;
        cases.push(judged(name, onset, String::new()));
        if i == 0 || i == 2 {
            curve(name, [Colour::Blue, Colour::Blue, Colour::Orange][i], &mut bench, limit)?;
        }
    }
    let methods =
        [("collocated", Method::Collocated), ("integrated, 4 points", Method::Integrated { points: 4 })];
    for (name, method) in methods {
        for scale in [1.0, 10.0] {
            let mut bench = Bench::new(pressed(method, scale)?);
            let limit = bench.system.present_critical_time_step();
            let bound = bench.system.critical_time_step();
            let onset = bench.onset(limit)?;
            let note =
                format!("; runs use a bound for any configuration, {:.1} % of it", 100.0 * bound / limit);
            cases.push(judged(
                &format!("two blocks pressed together, {name} contact, penalty × {scale}"),
                onset,
                note,
            ));
            if scale == 1.0 && method == Method::Collocated {
                curve("blocks in contact", Colour::Green, &mut bench, limit)?;
            }
        }
    }
    Ok(Chapter {
        title: "Onset of instability",
        words: "Time steps from 0.5 to 1.5 times the limit 2/ω_max that the program computes for the model \
            (with contact: for its \
                present stiffness), by bisection: the smallest step at which random noise grows a \
                thousandfold.",
        cases,
        figures: vec![figure],
    })
}

fn judged(name: &str, onset: f64, note: String) -> Case {
    let right = (onset - 1.0).abs() <= SHARP;
    Case {
        done: name.to_owned(),
        energy: None,
        verdict: if right { Verdict::Right } else { Verdict::Undetected },
        seen: format!("unstable from {onset:.4} of the limit{note}"),
    }
}
