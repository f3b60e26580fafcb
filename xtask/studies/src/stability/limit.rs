//! The time step: where instability sets in, per element type and with contact, against the computed limit.

use anyhow::Result;
use stribeck_contact::Method;
use stribeck_mesh::{Annulus, Disc, Part};
use stribeck_report::plot::{Axis, Colour, Figure, Series};
use stribeck_scene::dice::Dice;
use stribeck_system::{Plan, Snapshot, System};

use super::blocks::{pressed, split};
use super::{Case, Verdict};
use crate::rig::{THICKNESS, rectangle, steel, stir};

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
    /// The computed limit of the time step [s].
    limit: f64,
}

impl Bench {
    /// Growth of noise over this number of steps of `factor` times the limit.
    fn growth(&mut self, factor: f64, steps: u64) -> Result<f64> {
        let system = &mut self.system;
        system.set_time_step(factor * self.limit, None)?;
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

    /// The smallest unstable time step over the limit, to 0.1 %.
    fn onset(&mut self, name: &str, note: &str) -> Result<Case> {
        let (mut stable, mut unstable) = (0.5, 1.5);
        while unstable - stable > 1e-3 {
            let middle = 0.5 * (stable + unstable);
            if self.growth(middle, STEPS)? > GROWN { unstable = middle } else { stable = middle }
        }
        let right = (unstable - 1.0_f64).abs() <= SHARP;
        Ok(Case {
            done: name.to_owned(),
            energy: None,
            verdict: if right { Verdict::Right } else { Verdict::Undetected },
            seen: format!("unstable from {unstable:.4} of the limit{note}"),
        })
    }

    /// How noise grows below and above the limit.
    fn curve(&mut self, name: &str, colour: Colour) -> Result<Series> {
        let steps = (0..=24).map(|i| 0.5 + 0.025 * f64::from(i));
        let mut factors: Vec<f64> = steps.chain([0.995, 1.005]).collect();
        factors.sort_by(f64::total_cmp);
        let grown = factors.iter().map(|f| Ok(self.growth(*f, 2000)?.clamp(1e-3, 1e30).log10()));
        let grown = grown.collect::<Result<_>>()?;
        Ok(Series::listed(name, colour, factors, grown))
    }
}

/// Inner nodes moved at random by up to a fifth of a cell.
fn distorted(columns: usize, rows: usize, size: f64) -> Result<Part> {
    let mut part = rectangle([0.0; 2], [columns as f64 * size, rows as f64 * size], [columns, rows])?;
    let mut dice = Dice::new(3);
    for n in (1..rows).flat_map(|row| (1..columns).map(move |column| row * (columns + 1) + column)) {
        part.x[n] += 0.4 * size * (dice.share() - 0.5);
        part.y[n] += 0.4 * size * (dice.share() - 0.5);
    }
    Ok(part)
}

pub(super) fn cases() -> Result<(Vec<Case>, Figure)> {
    let (inner_radius, outer_radius, start_angle, grooves) = (0.02, 0.026, 0.0, Vec::new());
    let ring = Annulus { inner_radius, outer_radius, facets: 60, layers: 4, start_angle, grooves };
    let disc = Disc { radius: 9e-3, facets: 32, size: 2e-3, rotation: 0.1 };
    let bodies: [(&str, Part, Option<Colour>); 5] = [
        ("squares", rectangle([0.0; 2], [8e-3, 6e-3], [8, 6])?, Some(Colour::Blue)),
        ("distorted quadrilaterals", distorted(8, 6, 1e-3)?, None),
        ("triangles", split(distorted(8, 6, 1e-3)?), Some(Colour::Orange)),
        ("disc of quadrilaterals and triangles", disc.part()?, None),
        ("ring in strips", ring.part()?, None),
    ];
    let (x, y) =
        (Axis::plain("Time step over the computed limit", ""), Axis::plain("log₁₀ of the growth", ""));
    let mut figure = Figure::new("limit", "Growth of noise in 2000 steps", x, y);
    let mut cases = Vec::new();
    for (name, part, colour) in bodies {
        let mut plan = Plan::new(THICKNESS);
        plan.add("body", &part, steel())?;
        let system = plan.build(1)?;
        let mut bench = Bench { rest: system.snapshot(), limit: system.critical_time_step(), system };
        cases.push(bench.onset(name, "")?);
        if let Some(colour) = colour {
            figure.series.push(bench.curve(name, colour)?);
        }
    }
    for (name, method) in
        [("collocated", Method::Collocated), ("integrated, 4 points", Method::Integrated { points: 4 })]
    {
        for scale in [1.0, 10.0] {
            let system = pressed(method, scale)?;
            let (limit, bound) = (system.present_critical_time_step(), system.critical_time_step());
            let mut bench = Bench { rest: system.snapshot(), limit, system };
            let note =
                format!("; runs use a bound for any configuration, {:.1} % of it", 100.0 * bound / limit);
            let done = format!("two blocks pressed together, {name} contact, penalty × {scale}");
            cases.push(bench.onset(&done, &note)?);
            if scale == 1.0 && method == Method::Collocated {
                figure.series.push(bench.curve("blocks in contact", Colour::Green)?);
            }
        }
    }
    Ok((cases, figure))
}
