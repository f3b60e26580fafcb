//! A simulator with six fields, eight outputs and scatter that depends on the point; its last field does
//! nothing.

use stribeck_infer::{Output, Prior, Runs, Scale, Truth, sobol};
use stribeck_testing::Noise;

/// Fields of the simulator.
pub(crate) const FIELDS: usize = 6;

/// The field without influence.
pub(crate) const IDLE: usize = 5;

/// Outputs of the simulator.
pub(crate) const OUTPUTS: usize = 8;

/// Every field is uniform in the unit interval.
pub(crate) const PRIORS: [Prior; FIELDS] = [Prior::Uniform { from: 0.0, to: 1.0 }; FIELDS];

pub(crate) fn columns() -> Vec<Output> {
    let scale = |i| if i == 0 || i == 3 { Scale::Logarithmic } else { Scale::Linear };
    (0..OUTPUTS).map(|i| Output { name: format!("y{i}"), scale: scale(i) }).collect()
}

/// Standard deviation of starts at a point, but for a factor that each output has: it grows with the second
/// field.
pub(crate) fn scatter(x: &[f64]) -> f64 {
    0.05 + 0.15 * x[1]
}

/// One start at a point, with `times` the scatter. The last two outputs err together; the fifth is missing
/// more often the smaller the first field is.
pub(crate) fn run(x: &[f64], times: f64, noise: &mut Noise) -> Vec<Option<f64>> {
    // The sum of twelve numbers with variance 1/3, halved: normal but for its far tails.
    let mut normal = || 0.5 * (0..12).map(|_| noise.uniform()).sum::<f64>();
    let scatter = times * scatter(x);
    let together = scatter * normal();
    let exists = normal() < 4.0 * x[0] - 0.8;
    let mut with = |mean: f64, size: f64| mean + scatter * size * normal();
    vec![
        Some(with(1.5 * x[0] + 0.6 * x[1] * x[1], 1.0).exp()),
        Some(with((3.0 * x[1]).sin() + x[2], 1.0)),
        Some(with(2.0 * x[2] * x[3], 1.0)),
        Some(with(x[3] - x[0] * x[4], 1.0).exp()),
        exists.then(|| with(x[4] * x[4] + 0.5 * x[0], 0.7)),
        Some(with((2.0 * x[4] + x[3]).cos(), 1.0)),
        Some(with(x[0] + x[2], 0.5) + together),
        Some(with(x[1] - x[4], 0.5) + together),
    ]
}

/// Runs on a Sobol design, several starts at each point.
pub(crate) fn runs(seed: u64, points: usize, starts: usize) -> Runs {
    let mut noise = Noise::new(seed);
    let mut runs = Runs::default();
    for point in sobol(seed, FIELDS, 0, points).unwrap() {
        for _ in 0..starts {
            runs.outputs.push(run(&point, 1.0, &mut noise));
            runs.points.push(point.clone());
        }
    }
    runs
}

/// Runs of one start on a Sobol design, each read several times: all readings of a run have the same outputs,
/// at points that differ in the field without influence.
pub(crate) fn readings(seed: u64, points: usize, each: usize) -> Runs {
    let mut noise = Noise::new(seed);
    let mut runs = Runs::default();
    for (simulation, point) in sobol(seed, FIELDS, 0, points).unwrap().into_iter().enumerate() {
        let outputs = run(&point, 1.0, &mut noise);
        for reading in 0..each {
            let mut point = point.clone();
            point[IDLE] = (point[IDLE] + reading as f64 / each as f64).fract();
            runs.points.push(point);
            runs.outputs.push(outputs.clone());
            runs.simulations.push(simulation);
        }
    }
    runs
}

pub(crate) fn only(runs: Runs, kept: &[usize]) -> Runs {
    let outputs = runs.outputs.iter().map(|row| kept.iter().map(|&output| row[output]).collect()).collect();
    Runs { outputs, ..runs }
}

/// Points drawn from the prior with one start each, with `times` the scatter.
pub(crate) fn truths(seed: u64, count: usize, times: f64) -> Vec<Truth> {
    let mut noise = Noise::new(seed);
    let one = |_| {
        let point: Vec<f64> = (0..FIELDS).map(|_| 0.5 + 0.5 * noise.uniform()).collect();
        Truth { outputs: run(&point, times, &mut noise), point }
    };
    (0..count).map(one).collect()
}
