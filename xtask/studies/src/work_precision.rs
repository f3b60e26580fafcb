//! `cargo xtask study work_precision`: error against work, one curve a choice.

mod contact;
mod vibration;
mod waves;

use anyhow::Result;
use stribeck_report::plot::{Axis, Colour, Figure, Series};

use crate::{Host, Rows, figure};

/// The problems with their measure of work and the name of their picture.
const PROBLEMS: [(&str, &str, &str); 8] = [
    ("Pressure wave", "element evaluations", "pressure"),
    ("Rayleigh wave", "element evaluations", "rayleigh"),
    ("Bending mode of a ring", "element evaluations", "ring"),
    ("Thick cylinder under pressure", "elements", "cylinder"),
    ("Impact of two bars", "element evaluations", "impact"),
    ("Hertz line contact", "elements", "hertz"),
    ("From sliding to rolling", "contact points × steps", "rolling"),
    ("A block slides to a stop", "steps", "sliding"),
];

/// Takes the time of calculations.
struct Timer<'a>(&'a Host);

impl Timer<'_> {
    /// Adds the points of one choice, each at a size, from work and error that a calculation returns. One
    /// that finds no answer has no point there.
    fn curve<T, const N: usize>(
        &self,
        rows: &mut Rows,
        problem: &str,
        choice: &str,
        sizes: [(f64, T); N],
        calculate: impl Fn(T) -> Result<(f64, f64)>,
    ) -> Result<()> {
        for (size, of) in sizes {
            let began = self.0.seconds();
            match calculate(of) {
                Ok((work, error)) => {
                    let values = [("work", work), ("seconds", self.0.seconds() - began), ("error", error)];
                    let values = values.map(|(what, value)| (what, Some(value).filter(|v| v.is_finite())));
                    rows.values(problem, &format!("{choice} at {size:e}"), values);
                }
                Err(error) => self.0.say(&format!("{problem}, {choice} at {size:e}: {error:#}")),
            }
        }
        Ok(())
    }
}

pub(crate) fn measure(host: &Host, rows: &mut Rows) -> Result<()> {
    let timer = Timer(host);
    waves::curves(&timer, rows)?;
    vibration::curves(&timer, rows)?;
    contact::curves(&timer, rows)?;
    PROBLEMS.iter().try_for_each(|problem| figure::draw("work_precision", &picture(rows, *problem)))
}

/// One calculation.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Point {
    /// Refined parameter: element size [m], or time step over the limit.
    size: f64,
    /// Elements evaluated, or unknowns of a static problem.
    work: f64,
    /// Relative error [-].
    error: f64,
}

/// The choices of a problem with their points, from coarse to fine.
fn curves(rows: &Rows, problem: &str) -> Vec<(String, Vec<Point>)> {
    let mut curves: Vec<(String, Vec<Point>)> = Vec::new();
    for (variant, error) in rows.column(problem, "error") {
        let Some((choice, size)) = variant.rsplit_once(" at ") else { continue };
        let (Ok(size), Some(work)) = (size.parse(), rows.number(problem, variant, "work")) else { continue };
        let point = Point { size, work, error };
        match curves.iter_mut().find(|(name, _)| name == choice) {
            Some((_, points)) => points.push(point),
            None => curves.push((choice.to_owned(), vec![point])),
        }
    }
    curves
}

/// Every point with the name of its curve, cheapest first.
fn by_work(curves: &[(String, Vec<Point>)]) -> Vec<(&str, Point)> {
    let mut all: Vec<(&str, Point)> =
        curves.iter().flat_map(|(name, points)| points.iter().map(|p| (name.as_str(), *p))).collect();
    all.sort_by(|a, b| a.1.work.total_cmp(&b.1.work).then(a.1.error.total_cmp(&b.1.error)));
    all
}

/// Points that no other one beats in both work and error (Pareto front).
fn front(curves: &[(String, Vec<Point>)]) -> Vec<(&str, Point)> {
    let mut best = f64::INFINITY;
    let mut front = by_work(curves);
    front.retain(|(_, p)| {
        let better = p.error < best;
        best = best.min(p.error);
        better
    });
    front
}

/// Order of convergence over the refined quantity, by least squares in the logarithms.
fn order(points: &[Point]) -> Option<f64> {
    let logs = points.iter().filter(|p| p.error > 0.0).map(|p| (p.size.ln(), p.error.ln()));
    let logs: Vec<(f64, f64)> = logs.collect();
    let n = logs.len() as f64;
    let (mx, my) = (logs.iter().map(|p| p.0).sum::<f64>() / n, logs.iter().map(|p| p.1).sum::<f64>() / n);
    let cross: f64 = logs.iter().map(|p| (p.0 - mx) * (p.1 - my)).sum();
    let square: f64 = logs.iter().map(|p| (p.0 - mx).powi(2)).sum();
    (logs.len() > 1 && square > 0.0).then(|| cross / square)
}

/// The cheapest choice that reaches a share of error and stays below it when it is refined further, so that
/// no lucky cancellation is recommended; the finest point of a curve needs half the error.
fn cheapest(curves: &[(String, Vec<Point>)], share: f64) -> Option<(&str, Point)> {
    let holds = |name: &str, point: &Point| {
        let Some((_, points)) = curves.iter().find(|(of, _)| of == name) else { return false };
        let finer = || points.iter().filter(|p| p.size < point.size);
        let margin = if finer().next().is_none() { 0.5 } else { 1.0 };
        point.error <= margin * share && finer().all(|p| p.error <= share)
    };
    by_work(curves).into_iter().find(|(name, p)| holds(name, p))
}

/// The order of each choice with its last error; and the cheapest choice for each error.
pub(crate) fn derive(rows: &mut Rows) {
    for (problem, work, _) in PROBLEMS {
        let curves = curves(rows, problem);
        for (name, points) in &curves {
            let table = format!("{problem}, choices");
            let last = points.last();
            let values =
                [("order", order(points)), ("work", last.map(|p| p.work)), ("error", last.map(|p| p.error))];
            rows.values(&table, name, values);
        }
        for share in [0.05, 0.01, 0.001] {
            let best = cheapest(&curves, share);
            let word = best.map_or("–".to_owned(), |(name, p)| format!("{name}, {:.1e} {work}", p.work));
            rows.word("advice", problem, &format!("{} %", 100.0 * share), &word);
        }
    }
}

fn picture(rows: &Rows, (title, work, id): (&str, &str, &str)) -> Figure {
    let curves = curves(rows, title);
    let axis = |label: &str| Axis::decades(label, "");
    let mut figure = Figure::new(id, title, axis(work), axis("relative error"));
    let line = |name: &str, colour, mut points: Vec<Point>| {
        points.retain(|p| p.error > 0.0);
        points.sort_by(|a, b| a.work.total_cmp(&b.work));
        let x = points.iter().map(|p| p.work.log10()).collect();
        Series::listed(name, colour, x, points.iter().map(|p| p.error.log10()).collect())
    };
    for ((name, points), colour) in curves.iter().zip(Colour::FOREGROUNDS.into_iter().cycle()) {
        figure.series.push(line(name, colour, points.clone()));
    }
    let front = front(&curves).into_iter().map(|(_, p)| p).collect();
    figure.series.push(line("Pareto front", Colour::Black, front).as_points());
    figure.series.retain(|s| !s.y.is_empty());
    figure
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_hand_order_front_and_advice() {
        let mut rows = Rows::default();
        for (name, points) in [
            ("a", vec![(1.0, 10.0, 0.04), (0.5, 40.0, 0.01), (0.25, 160.0, 0.0025)]),
            ("b", vec![(1.0, 20.0, 0.05), (0.5, 80.0, 0.005)]),
        ] {
            for (size, work, error) in points {
                rows.values("x", &format!("{name} at {size:e}"), [("work", work), ("error", error)]);
            }
        }
        let curves = curves(&rows, "x");
        assert!((order(&curves[0].1).expect("three points") - 2.0).abs() < 1e-12);
        let works: Vec<f64> = front(&curves).iter().map(|(_, p)| p.work).collect();
        assert_eq!(works, [10.0, 40.0, 80.0, 160.0]);
        let best = cheapest(&curves, 0.01).map(|(name, p)| (name, p.work));
        assert_eq!((best, cheapest(&curves, 0.001)), (Some(("a", 40.0)), None));
    }
}
