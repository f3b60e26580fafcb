//! Simulation-based calibration: do intervals hold the truths that they should (Talts and others, *Validating
//! Bayesian inference algorithms with simulation-based calibration*, arXiv 1804.06788)?

use std::cell::OnceCell;

use serde::{Deserialize, Serialize};
use statrs::distribution::{ChiSquared, ContinuousCDF};

use crate::{
    design,
    emulator::Emulator,
    error::Error,
    interval::{rank, weighted_moments},
    likelihood::{Likelihood, Predictions},
    posterior::{self, Posterior, PosteriorOptions},
    prior::{Prior, snapped},
    random::{Random, normal_quantile},
    runs::{Output, Scale, Target},
};

/// Points of the prior that all truths share: few, and more for a posterior with too few of them. One with
/// too few of these is sampled on its own.
const POOLS: [usize; 2] = [8192, 32_768];

/// Least effective number of points from the pool.
const ENOUGH: f64 = 200.0;

/// Bins of rank histograms.
pub const BINS: usize = 10;

/// A point, and the outputs of one run there.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Truth {
    /// In the unit cube.
    pub point: Vec<f64>,
    /// As in a row of [`crate::Runs`].
    pub outputs: Vec<Option<f64>>,
}

/// A share of truths, with the interval in which it would lie over many more (Wilson, 95 %).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Share {
    /// Share of the truths.
    pub share: f64,
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

/// Calibration of one field.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FieldCalibration {
    /// Share of truths within the central 50 % interval.
    pub coverage_50: Share,
    /// Share of truths within the central 90 % interval.
    pub coverage_90: Share,
    /// How many truths have their rank among the draws in each tenth.
    pub ranks: [usize; BINS],
    /// χ² of that histogram against an even one.
    pub chi_squared: f64,
    /// Probability of a χ² as large where ranks are even.
    pub p_value: f64,
    /// Mean standard deviation of the posterior over that of the prior: 1 where the outputs carry no
    /// information.
    pub width: f64,
}

/// Whether an inference is calibrated, field by field.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Calibration {
    /// Number of truths.
    pub truths: usize,
    /// In the order of the coordinates.
    pub fields: Vec<FieldCalibration>,
    /// Share of the draws below each truth (`[field][truth]`).
    pub ranks: Vec<Vec<f64>>,
}

/// Result of one truth: rank of each coordinate, and its posterior standard deviation.
struct Answer {
    ranks: Vec<f64>,
    deviations: Vec<f64>,
}

impl Calibration {
    /// Infers every truth from its own outputs. `columns` are those that count, each with its tolerance, and
    /// every output gets a random error of that size: what the posterior takes for granted.
    ///
    /// # Errors
    /// When there are no truths, their shapes do not fit, or a target is invalid.
    pub fn of(
        emulator: &Emulator,
        priors: &[Prior],
        truths: &[Truth],
        columns: &[(usize, f64)],
        options: PosteriorOptions,
    ) -> Result<Self, Error> {
        posterior::check(emulator, priors)?;
        if truths.is_empty() {
            let expected = "1 at least; 200 for 90 % intervals to ±5 %";
            return Err(Error::Option { option: "truths", value: 0.0, expected });
        }
        let points: Vec<Vec<f64>> = truths.iter().map(|truth| truth.point.clone()).collect();
        emulator.check(&points)?;
        let pools = POOLS.map(|size| Pool { size, known: OnceCell::new() });
        let asked: Vec<usize> = columns.iter().map(|column| column.0).collect();
        let mut random = Random::stream(options.seed, 2);
        let mut errors = Random::stream(options.seed, 5);
        let outputs: Vec<Output> = emulator.outputs().cloned().collect();
        let mut answers = Vec::with_capacity(truths.len());
        for (number, truth) in truths.iter().enumerate() {
            let targets = targets(&outputs, &truth.outputs, columns, number, &mut errors)?;
            let likelihood = Likelihood::new(emulator, &targets)?;
            let seed = options.seed;
            let known = pools.iter().find_map(|pool| pool.weighted(&likelihood, priors, &asked, seed));
            answers.push(if let Some((points, weights)) = known {
                Answer::of(truth, points, &weights, &mut random)
            } else {
                let options = PosteriorOptions { seed: seed.wrapping_add(number as u64), ..options };
                let draws = Posterior::of(emulator, priors, &targets, options)?.draws;
                let even = vec![1.0 / draws.len() as f64; draws.len()];
                Answer::of(truth, &draws, &even, &mut random)
            });
        }
        let prior = |field: usize| {
            let points = design::points(options.seed ^ 0xca11, priors.len(), 0..POOLS[0]);
            let column: Vec<f64> = points.iter().map(|point| snapped(priors, point)[field]).collect();
            weighted_moments(&column, &vec![1.0 / column.len() as f64; column.len()])[1]
        };
        let ranks: Vec<Vec<f64>> = (0..priors.len())
            .map(|field| answers.iter().map(|answer| answer.ranks[field]).collect())
            .collect();
        let field = |field: usize| {
            let width = answers.iter().map(|answer| answer.deviations[field]).sum::<f64>();
            FieldCalibration::of(&ranks[field], width / (truths.len() as f64 * prior(field).max(1e-12)))
        };
        let fields = (0..priors.len()).map(field).collect();
        Ok(Self { truths: truths.len(), fields, ranks })
    }
}

/// The outputs of a truth, each with an error of its tolerance, on the scale of the output.
pub(crate) fn targets(
    outputs: &[Output],
    values: &[Option<f64>],
    columns: &[(usize, f64)],
    number: usize,
    errors: &mut Random,
) -> Result<Vec<Target>, Error> {
    let target = |&(output, tolerance): &(usize, f64)| match values.get(output) {
        Some(&value) => {
            let scale = outputs.get(output).map_or(Scale::Linear, |column| column.scale);
            let with_error = |value: f64| {
                scale.back(scale.forward(value) + errors.normal() * tolerance / scale.slope(value))
            };
            let value = if tolerance > 0.0 { value.map(with_error) } else { value };
            Ok(Target { output, value, tolerance })
        }
        None => {
            let found = values.len();
            Err(Error::Shape { what: "outputs of truth", number, found, expected: output + 1 })
        }
    };
    columns.iter().map(target).collect()
}

/// Points of the prior whose predictions are computed once for all truths, when the first of them asks.
struct Pool {
    size: usize,
    known: OnceCell<(Vec<Vec<f64>>, Predictions)>,
}

impl Pool {
    /// Points with the weights of a posterior; none where too few of them count.
    fn weighted(
        &self,
        likelihood: &Likelihood<'_>,
        priors: &[Prior],
        outputs: &[usize],
        seed: u64,
    ) -> Option<(&[Vec<f64>], Vec<f64>)> {
        let (points, predictions) = self.known.get_or_init(|| {
            let points: Vec<Vec<f64>> = design::points(seed ^ 0xca11, priors.len(), 0..self.size)
                .iter()
                .map(|point| snapped(priors, point))
                .collect();
            let predictions = likelihood.predictions(outputs, &points);
            (points, predictions)
        });
        let (weights, _) = posterior::weights(&likelihood.at_predicted(predictions), 1.0);
        (posterior::effective(&weights) >= ENOUGH).then_some((points, weights))
    }
}

impl Answer {
    fn of(truth: &Truth, points: &[Vec<f64>], weights: &[f64], random: &mut Random) -> Self {
        let mut answer = Self { ranks: Vec::new(), deviations: Vec::new() };
        for (field, value) in truth.point.iter().enumerate() {
            let column: Vec<f64> = points.iter().map(|point| point[field]).collect();
            answer.ranks.push(rank(*value, &column, weights, random.share()));
            answer.deviations.push(weighted_moments(&column, weights)[1]);
        }
        answer
    }
}

impl FieldCalibration {
    /// From ranks of truths among their draws, 0 … 1.
    pub fn of(ranks: &[f64], width: f64) -> Self {
        let within = |share: f64| {
            let half = 0.5 * (1.0 - share);
            let held = ranks.iter().filter(|&&rank| rank >= half && rank <= 1.0 - half).count();
            Share::of(held, ranks.len())
        };
        let mut histogram = [0; BINS];
        for rank in ranks {
            histogram[((rank * BINS as f64) as usize).min(BINS - 1)] += 1;
        }
        let even = ranks.len() as f64 / BINS as f64;
        let chi_squared: f64 = histogram.iter().map(|&n| (n as f64 - even).powi(2) / even).sum();
        let p_value = ChiSquared::new(BINS as f64 - 1.0).map_or(f64::NAN, |chi| chi.sf(chi_squared));
        Self {
            coverage_50: within(0.5),
            coverage_90: within(0.9),
            ranks: histogram,
            chi_squared,
            p_value,
            width,
        }
    }
}

impl Share {
    /// `held` of `all`, with Wilson's interval of 95 % (J. American Statistical Association 22, 1927).
    pub fn of(held: usize, all: usize) -> Self {
        let (n, z) = (all as f64, normal_quantile(0.975));
        let share = held as f64 / n;
        let middle = (share + z * z / (2.0 * n)) / (1.0 + z * z / n);
        let half = z / (1.0 + z * z / n) * (share * (1.0 - share) / n + z * z / (4.0 * n * n)).sqrt();
        Self { share, low: (middle - half).max(0.0), high: (middle + half).min(1.0) }
    }
}
