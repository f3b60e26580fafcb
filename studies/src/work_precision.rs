//! `cargo xtask study work_precision`: error against work, one curve a choice.

mod contact;
mod vibration;
mod waves;

use anyhow::Result;
use stribeck_report::plot::{Axis, Colour, Figure, Series};

use crate::{Answer, Host, Sheet};

/// Where the bearing as a whole is.
const BEARING: &str = "The whole bearing has no known answer. What a simulated millisecond costs, and how \
    far it then is from the finest \
     mesh, is in [run_time](run_time.md), by the full model and by the reduced one: its modes, its step, its \
     facets.\n\n\
     ![Error of the force on a loaded roller against processor time](run_time-force.svg)";

/// One calculation.
#[derive(Debug, Clone, Copy)]
struct Point {
    /// Refined parameter: element size [m], or time step over the limit.
    size: f64,
    /// Elements evaluated, or unknowns of a static problem.
    work: f64,
    /// Seconds on this machine.
    seconds: f64,
    /// Relative error [-].
    error: f64,
}

/// One choice, from coarse to fine.
#[derive(Debug, Clone)]
struct Curve {
    /// The choice.
    name: String,
    /// Refined parameter, in words.
    refined: &'static str,
    points: Vec<Point>,
}

/// One problem with a known answer.
#[derive(Debug, Clone)]
struct Problem {
    id: &'static str,
    title: &'static str,
    /// The problem, the answer and its source.
    words: String,
    /// Measure of work.
    work: &'static str,
    curves: Vec<Curve>,
}

impl Curve {
    /// Order of convergence over the refined quantity, by least squares in the logarithms.
    fn order(&self) -> Option<f64> {
        let points: Vec<(f64, f64)> = self
            .points
            .iter()
            .filter(|p| p.error > 0.0 && p.error.is_finite())
            .map(|p| (p.size.ln(), p.error.ln()))
            .collect();
        if points.len() < 2 {
            return None;
        }
        let n = points.len() as f64;
        let [mx, my] =
            [points.iter().map(|p| p.0).sum::<f64>() / n, points.iter().map(|p| p.1).sum::<f64>() / n];
        let cross: f64 = points.iter().map(|p| (p.0 - mx) * (p.1 - my)).sum();
        let square: f64 = points.iter().map(|p| (p.0 - mx).powi(2)).sum();
        (square > 0.0).then(|| cross / square)
    }
}

impl Problem {
    /// Every point with the name of its curve, cheapest first.
    fn by_work(&self) -> Vec<(&str, Point)> {
        let mut all: Vec<(&str, Point)> =
            self.curves.iter().flat_map(|c| c.points.iter().map(|p| (c.name.as_str(), *p))).collect();
        all.retain(|(_, p)| p.error.is_finite());
        all.sort_by(|a, b| a.1.work.total_cmp(&b.1.work).then(a.1.error.total_cmp(&b.1.error)));
        all
    }

    /// Points that no other one beats in both work and error (Pareto front).
    fn front(&self) -> Vec<(&str, Point)> {
        let mut best = f64::INFINITY;
        let mut front = self.by_work();
        front.retain(|(_, p)| {
            let better = p.error < best;
            best = best.min(p.error);
            better
        });
        front
    }

    /// A sentence a target: the cheapest choice that reaches it and stays below it when it is refined
    /// further, so that no lucky cancellation is recommended; the finest point of a curve needs half the
    /// error.
    fn advice(&self) -> Vec<String> {
        let holds = |name: &str, point: &Point, share: f64| {
            let Some(curve) = self.curves.iter().find(|c| c.name == name) else { return false };
            let finer = || curve.points.iter().filter(|p| p.size < point.size);
            let margin = if finer().next().is_none() { 0.5 } else { 1.0 };
            point.error <= margin * share && finer().all(|p| p.error <= share)
        };
        let target = |share: f64| {
            let found = self.by_work().into_iter().find(|(name, p)| holds(name, p, share));
            found.map(|(name, p)| {
                format!("for {} % take *{name}* ({}: {:.2e})", 100.0 * share, self.work, p.work)
            })
        };
        [0.05, 0.01, 0.001].into_iter().filter_map(target).collect()
    }

    fn figure(&self) -> Figure {
        const COLOURS: [Colour; 8] = [
            Colour::Blue,
            Colour::Orange,
            Colour::Green,
            Colour::Purple,
            Colour::Red,
            Colour::Teal,
            Colour::Brown,
            Colour::Grey,
        ];
        let mut figure = Figure::new(
            self.id,
            self.title,
            Axis::plain(&format!("log₁₀ of the {}", self.work), ""),
            Axis::plain("log₁₀ of the relative error", ""),
        );
        let line = |name: &str, colour, mut points: Vec<Point>| {
            points.retain(|p| p.error > 0.0 && p.error.is_finite());
            points.sort_by(|a, b| a.work.total_cmp(&b.work));
            let x = points.iter().map(|p| p.work.log10()).collect();
            Series::listed(name, colour, x, points.iter().map(|p| p.error.log10()).collect())
        };
        for (i, curve) in self.curves.iter().enumerate() {
            figure.series.push(line(&curve.name, COLOURS[i % COLOURS.len()], curve.points.clone()));
        }
        let front = self.front().into_iter().map(|(_, p)| p).collect();
        figure.series.push(line("Pareto front", Colour::Black, front).as_points());
        figure.series.retain(|s| !s.y.is_empty());
        figure
    }

    fn write(&self, sheet: &mut Sheet) -> Result<()> {
        sheet.heading(self.title);
        sheet.say(&self.words);
        let front = self.front();
        let rows = self.curves.iter().map(|curve| {
            let list =
                |of: &dyn Fn(&Point) -> String| curve.points.iter().map(of).collect::<Vec<_>>().join(", ");
            let marked = |p: &Point| {
                let on = front
                    .iter()
                    .any(|(name, q)| *name == curve.name && q.work == p.work && q.error == p.error);
                if on { format!("**{}**", percent(p.error)) } else { percent(p.error) }
            };
            vec![
                curve.name.clone(),
                curve.refined.to_owned(),
                curve.order().map_or("–".to_owned(), |o| format!("{o:.2}")),
                list(&|p| format!("{:.1e}", p.work)),
                list(&marked),
            ]
        });
        let rows: Vec<Vec<String>> = rows.collect();
        sheet.table(&["choice", "refined", "order", self.work, "error (on the front: bold)"], &rows);
        for curve in &self.curves {
            for p in &curve.points {
                let at = format!("{} at {:e}", curve.name, p.size);
                for (what, value) in [("work", p.work), ("seconds", p.seconds), ("error", p.error)] {
                    sheet.value(self.title, &at, what, Some(value).filter(|v| v.is_finite()));
                }
            }
        }
        sheet.picture(&self.figure())?;
        let advice = self.advice();
        if !advice.is_empty() {
            sheet.say(&format!("**Advice:** {}.", advice.join("; ")));
        }
        Ok(())
    }
}

/// A share in per cent, three digits.
fn percent(share: f64) -> String {
    if !share.is_finite() {
        return "–".to_owned();
    }
    let value = 100.0 * share;
    let decimals = if value > 0.0 { (2.0 - value.log10().floor()).clamp(0.0, 6.0) as usize } else { 0 };
    format!("{value:.decimals$} %")
}

/// Runs a calculation and notes its time.
fn timed(host: &dyn Host, work: impl FnOnce() -> Result<(f64, f64)>, size: f64) -> Result<Point> {
    let began = host.seconds();
    let (work, error) = work()?;
    Ok(Point { size, work, seconds: host.seconds() - began, error })
}

pub(crate) fn run(host: &dyn Host) -> Result<Answer> {
    let mut sheet = Sheet::new(host.root(), "work_precision", "Work and precision");
    sheet.say(
        "Error against work for problems with a known answer, one curve a choice. Work is counted in \
         elements evaluated \
         (element-steps; Noh–Bathe evaluates twice a step), which does not depend on the machine; seconds of \
         this machine are in the \
         table of values. A static problem counts its elements. The one-point quadrilateral in double \
         precision under central \
         differences is what runs do. *Full integration, mixed precision, bulk viscosity, Tchamwa–Wielgosz \
         and Noh–Bathe exist for \
         this study only* (`studies/src/reference.rs`, `integrators.rs`): a plain path without \
         strips, so that their seconds \
         compare with each other and not with those of a run. On the Pareto front lies what nothing else \
         beats in both; \
         advice leaves out points whose curve does not stay below the error when it is refined further.",
    );
    let problems: [fn(&dyn Host) -> Result<Problem>; 8] = [
        waves::pressure_wave,
        waves::rayleigh_wave,
        vibration::ring,
        vibration::cylinder,
        contact::bar_impact,
        contact::hertz,
        contact::rolling,
        contact::sliding,
    ];
    let mut all = Vec::new();
    for problem in problems {
        let problem = problem(host)?;
        host.say(&format!("{}: {} curves", problem.title, problem.curves.len()));
        all.push(problem);
    }
    for problem in &all {
        problem.write(&mut sheet)?;
    }
    sheet.heading("The bearing");
    sheet.say(BEARING);
    sheet.heading("In short");
    for problem in &all {
        if let Some(words) = problem.advice().into_iter().rev().find(|a| a.starts_with("for 1 %")) {
            sheet.say(&format!("- {}: {words}.", problem.title));
        }
    }
    Ok(Answer::on(sheet.write()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(size: f64, work: f64, error: f64) -> Point {
        Point { size, work, seconds: 0.0, error }
    }

    #[test]
    fn by_hand_order_front_and_advice() {
        let curve = |name: &str, points: Vec<Point>| Curve { name: name.into(), refined: "h", points };
        let problem = Problem {
            id: "x",
            title: "x",
            words: String::new(),
            work: "elements",
            curves: vec![
                curve("a", vec![point(1.0, 10.0, 0.04), point(0.5, 40.0, 0.01), point(0.25, 160.0, 0.0025)]),
                curve("b", vec![point(1.0, 20.0, 0.05), point(0.5, 80.0, 0.005)]),
            ],
        };
        assert!((problem.curves[0].order().expect("three points") - 2.0).abs() < 1e-12);
        let front: Vec<f64> = problem.front().iter().map(|(_, p)| p.work).collect();
        assert_eq!(front, [10.0, 40.0, 80.0, 160.0]);
        let advice = problem.advice();
        assert_eq!(advice.len(), 2, "a thousandth is reached by none: {advice:?}");
        assert!(advice[1].contains("for 1 % take *a*") && advice[1].contains("4.00e1"), "{advice:?}");
        assert_eq!((percent(0.01234), percent(1.5e-5)), ("1.23 %".into(), "0.00150 %".into()));
    }
}
