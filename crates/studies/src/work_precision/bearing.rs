//! The bearing itself, against its finest run.

use anyhow::Result;
use stribeck_analysis::summary::Summary;
use stribeck_scene::run_dir::Run;

use super::{Curve, Point, Problem};
use crate::{Finished, Host, Runner, Variant};

const LEAN: &str = "fixtures/scenes/lean.ron";
/// Copies of the roller in one orientation, the default when this was first measured.
const COPIES: &str = "mesh.roller_copies=translated";
const PAPER: &str = "fixtures/scenes/singh2014.ron";
/// Until the roller has left the defect and has rung for a millisecond.
const DURATION: &str = "solver.duration_ms=5.8";

/// Curve, name of the variant, scene, overrides, what is refined.
type Row = (&'static str, &'static str, &'static str, &'static [&'static str], f64);

/// The run that the others are held against.
const FINEST: Row = ("", "finest", PAPER, &["solver.time_step_factor=0.5"], 0.5);

const ROWS: [Row; 12] = [
    ("uniform mesh", "uniform-20", PAPER, &["mesh.size_mm=2.0"], 2.0),
    ("uniform mesh", "uniform-10", PAPER, &["mesh.size_mm=1.0"], 1.0),
    ("uniform mesh", "uniform-05", PAPER, &[], 0.5),
    ("graded mesh", "lean-10", LEAN, &["mesh.size_mm=1.0", "mesh.grading.coarse_mm=3.0"], 1.0),
    ("graded mesh", "lean-05", LEAN, &[], 0.5),
    ("graded, Δt factor", "lean-dt-07", LEAN, &["solver.time_step_factor=0.7"], 0.7),
    ("graded, Δt factor", "lean-dt-04", LEAN, &["solver.time_step_factor=0.4"], 0.4),
    ("graded, penalty", "lean-penalty-02", LEAN, &["contact.penalty_scale=0.2"], 0.2),
    ("graded, penalty", "lean-penalty-3", LEAN, &["contact.penalty_scale=3.0"], 3.0),
    ("graded, collocated", "lean-collocated", LEAN, &["contact.method=collocated"], 0.5),
    ("graded, contact points", "lean-points-1", LEAN, &["contact.points_per_facet=1"], 1.0),
    ("graded, contact points", "lean-points-8", LEAN, &["contact.points_per_facet=8"], 8.0),
];

/// A quantity of a run, and how much of it is the whole.
type Quantity = (&'static str, &'static str, &'static str, fn(&Finished) -> Option<Vec<f64>>);

const QUANTITIES: [Quantity; 4] = [
    (
        "bearing-force",
        "Bearing: force on the most loaded roller",
        "Mean force of roller 2 on the outer raceway.",
        force,
    ),
    (
        "bearing-events",
        "Bearing: times of the events",
        "When roller 1 enters the defect and leaves it.",
        events,
    ),
    (
        "bearing-impulse",
        "Bearing: impulse at the exit",
        "Largest acceleration at the leading sensor after the exit.",
        impulse,
    ),
    (
        "bearing-tone",
        "Bearing: facet tone",
        "Level of the strongest facet line at the leading sensor between impulses.",
        tone,
    ),
];

pub(super) fn problems(runner: &Runner<'_>, host: &dyn Host) -> Result<Vec<Problem>> {
    let variant =
        |(_, name, scene, set, _): &Row| Variant::new(*name, scene, set).with(DURATION).with(COPIES);
    let mut rows: Vec<Row> = ROWS.to_vec();
    rows.push(FINEST);
    let runs = runner.run(&rows.iter().map(variant).collect::<Vec<_>>())?;
    let find = |name: &str| runs.iter().find(|r| r.variant.name == name);
    let Some(finest) = find(FINEST.1) else {
        host.say("the finest run is missing; no table of the bearing");
        return Ok(Vec::new());
    };
    let mut problems = Vec::new();
    for (id, title, what, of) in QUANTITIES {
        let Some(truth) = of(finest) else {
            host.say(&format!("{title}: the finest run does not yield it"));
            continue;
        };
        let mut curves: Vec<Curve> = Vec::new();
        for row in ROWS {
            let Some((run, found)) = find(row.1).and_then(|run| Some((run, of(run)?))) else { continue };
            let Some(info) = &run.info else { continue };
            let worst = found.iter().zip(&truth).map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max);
            let elements = (info.mesh.quads + info.mesh.triangles) as f64;
            let point =
                Point { size: row.4, work: info.steps as f64 * elements, seconds: info.wall_s, error: worst };
            match curves.iter_mut().find(|c| c.name == row.0) {
                Some(curve) => curve.points.push(point),
                None => {
                    curves.push(Curve { name: row.0.into(), refined: "see the name", points: vec![point] })
                }
            }
        }
        let words = format!(
            "{what} Against the finest run: 0.5 mm everywhere and half the critical step. The first 5.8 ms of the paper's scene; a chaotic \
             part (which roller touches which corner when) does not converge, so that errors level off."
        );
        problems.push(Problem { id, title, words, work: "element-steps", curves });
    }
    Ok(problems)
}

fn numbers(run: &Finished) -> Option<&Summary> {
    run.numbers()
}

fn force(run: &Finished) -> Option<Vec<f64>> {
    let run = Run::read(&run.folder).ok()?;
    let [x, y] = ["x", "y"].map(|c| run.trace.get(&format!("roller.2.outer_f{c}_n")).map(<[f64]>::to_vec));
    let (x, y) = (x?, y?);
    // Roller 2 stands beside the defect the whole time.
    Some(vec![x.iter().zip(&y).map(|(x, y)| x.hypot(*y)).sum::<f64>() / x.len() as f64])
}

fn events(run: &Finished) -> Option<Vec<f64>> {
    let first = numbers(run)?.events.iter().find(|event| event.roller == 1)?;
    Some(vec![first.entry_ms?, first.exit_ms?])
}

fn impulse(run: &Finished) -> Option<Vec<f64>> {
    Some(vec![numbers(run)?.levels.impulse_g?])
}

fn tone(run: &Finished) -> Option<Vec<f64>> {
    let summary = numbers(run)?;
    let line = stribeck_analysis::tones::dominant(&summary.tones, summary.levels.sensor.as_deref()?)?;
    Some(vec![line.level_g?])
}
