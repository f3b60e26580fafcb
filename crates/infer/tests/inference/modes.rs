//! A posterior in two regions far apart, of unequal weight.

use stribeck_infer::{Emulator, Output, Posterior, PosteriorOptions, Prior, Runs, Scale, Target, sobol};

const DIMENSIONS: usize = 5;
const PRIORS: [Prior; DIMENSIONS] = [Prior::Uniform { from: 0.0, to: 1.0 }; DIMENSIONS];

fn functions(x: &[f64]) -> [f64; 3] {
    [4.0 * (x[0] - 0.5) * (x[0] - 0.5), x[0], x[1] + x[2]]
}

/// y₀ = 4 (x₀ − ½)² = 0.36 ± 0.03 holds at 0.2 and at 0.8, with nothing between; y₁ = x₀ = 0.46 ± 0.5 prefers
/// the first a little, and y₂ ties two other fields. Weights of the regions by quadrature over x₀.
#[test]
fn planted_both_regions_are_found_with_their_weights() {
    let points = sobol(1, DIMENSIONS, 0, 128).unwrap();
    let outputs = points.iter().map(|x| functions(x).map(Some).to_vec()).collect();
    let columns = ["y0", "y1", "y2"].map(|name| Output { name: name.to_owned(), scale: Scale::Linear });
    let emulator = Emulator::fit(&Runs { points, outputs, ..Runs::default() }, &columns, 0).unwrap();
    let asked = [(0.36, 0.03), (0.3, 0.4), (1.2, 0.02)];
    let targets: Vec<Target> = asked
        .iter()
        .enumerate()
        .map(|(output, &(value, tolerance))| Target { output, value: Some(value), tolerance })
        .collect();

    let mut weights = [0.0; 2];
    for i in 0..10_000 {
        let x = (i as f64 + 0.5) / 1e4;
        let y = functions(&[x, 0.0, 0.0]);
        let z = |k: usize| (y[k] - asked[k].0) / asked[k].1;
        weights[usize::from(x < 0.5)] += (-0.5 * (z(0) * z(0) + z(1) * z(1))).exp();
    }
    let expected = weights[1] / (weights[0] + weights[1]);
    assert!((0.6..0.75).contains(&expected), "the problem has unequal weights: {expected}");

    for seed in 1..=2 {
        let options = PosteriorOptions { draws: 2000, seed };
        let posterior = Posterior::of(&emulator, &PRIORS, &targets, options).unwrap();
        let first: Vec<f64> = posterior.column(0);
        let share = first.iter().filter(|&&x| x < 0.5).count() as f64 / first.len() as f64;
        // Four standard deviations of a share of 500 independent draws.
        assert!(
            (share - expected).abs() < 4.0 * (expected * (1.0 - expected) / 500.0).sqrt(),
            "seed {seed}: {share}"
        );
        assert!(first.iter().all(|x| (x - 0.5).abs() > 0.2), "seed {seed}: a draw between the regions");
    }
}
