//! Posterior predictive distribution of the outputs, beside the targets.

use serde::{Deserialize, Serialize};

use crate::{
    emulator::Emulator, error::Error, interval::quantile, posterior::Posterior, random::Random, runs::Target,
};

/// One output over the posterior, with the scatter of starts.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Predictive {
    /// Column of the output.
    pub output: usize,
    /// Probability that a run yields it.
    pub exists: f64,
    /// Values of runs that yield it, one a draw, in the output's unit; empty where it is not emulated.
    pub values: Vec<f64>,
    /// The values below which 5, 25, 50, 75 and 95 % of them lie.
    pub quantiles: [f64; 5],
    /// Share of runs below the target's value, its tolerance included: 0.05 to 0.95 where they agree. None
    /// without a target, or with one that must be missing.
    pub below_target: Option<f64>,
}

impl Predictive {
    /// Of every output, and the first target of each.
    ///
    /// # Errors
    /// When a target is invalid, or draws have other dimensions than the emulator.
    pub fn of(
        emulator: &Emulator,
        posterior: &Posterior,
        targets: &[Target],
        seed: u64,
    ) -> Result<Vec<Self>, Error> {
        emulator.check(&posterior.draws)?;
        let outputs: Vec<_> = emulator.outputs().cloned().collect();
        for (number, target) in targets.iter().enumerate() {
            target.check(number, &outputs)?;
        }
        let one = |output: usize| {
            let target = targets.iter().find(|target| target.output == output);
            Self::one(emulator, &posterior.draws, output, target, seed)
        };
        Ok((0..outputs.len()).map(one).collect())
    }

    fn one(
        emulator: &Emulator,
        draws: &[Vec<f64>],
        output: usize,
        target: Option<&Target>,
        seed: u64,
    ) -> Self {
        let scale = emulator.scale_of(output);
        let exists = emulator.exists(output, draws).iter().sum::<f64>() / draws.len() as f64;
        let mut random = Random::stream(seed, 1000 + output as u64);
        let wanted = target.and_then(|target| Some((target.value?, target.tolerance)));
        let (mut values, mut below) = (Vec::new(), 0.0);
        if let (Some(scaled), Some(tails)) = (emulator.scaled(output, draws), emulator.tails(output)) {
            for at in scaled {
                let deviate = tails.quantile(random.share().clamp(1e-9, 1.0 - 1e-9));
                values.push(scale.back(at.mean + at.scale() * deviate));
                if let Some((value, tolerance)) = wanted {
                    let whole = at.scale().hypot(tolerance / scale.slope(value)).max(f64::MIN_POSITIVE);
                    below += tails.share((scale.forward(value) - at.mean) / whole);
                }
            }
        }
        let quantiles = [0.05, 0.25, 0.5, 0.75, 0.95].map(|share| quantile(&values, share));
        let below_target = wanted.filter(|_| !values.is_empty()).map(|_| below / values.len() as f64);
        Self { output, exists, values, quantiles, below_target }
    }
}
