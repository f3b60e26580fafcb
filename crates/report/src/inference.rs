//! The page of an inference: the posterior of the unknowns, whether scenes drawn from it reproduce the
//! observations, and which observations no scene reproduces.

mod figures;
mod page;

use std::path::Path;

use serde::Serialize;
use stribeck_store::run_dir::write_atomic;

use crate::Error;
use crate::page::json;

/// A target further off than this, in standard deviations, at the best point of the prior is made by none: 1
/// % of runs lie further off.
const OUT_OF_REACH: f64 = 2.576;

/// Contents of `inference.json`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Answer {
    /// Name of the inference.
    pub name: String,
    /// Version of the program.
    pub version: String,
    /// Commit it was built from.
    pub commit: String,
    /// Seed of all random draws.
    pub seed: u64,
    /// Scenes that were run, without those of the check.
    pub scenes: usize,
    /// Starts of each.
    pub starts: usize,
    /// Rounds.
    pub rounds: usize,
    /// Rows that the emulator was made of: runs, by each of their readings.
    pub runs: usize,
    /// For how many independent draws those of the posterior count.
    pub effective_draws: f64,
    /// Logarithm of the mean likelihood over the prior.
    pub log_evidence: f64,
    /// Every unknown.
    pub fields: Vec<FieldFound>,
    /// Correlations of the unknowns in the posterior, over shares of their priors.
    pub pairs: Vec<Vec<f64>>,
    /// Some draws of the posterior, as shares of the priors.
    #[serde(skip)]
    pub shown: Vec<Vec<f64>>,
    /// Every target; a curve has one for each of its components.
    pub targets: Vec<TargetFound>,
    /// The scene that does best for the worst of all targets.
    pub best_together: Vec<[String; 2]>,
    /// Pairs of targets that can be met one by one but not at once.
    pub excluded: Vec<Excluded>,
    /// How each target moves each unknown.
    pub pulls: Vec<Pulled>,
    /// How well outputs are emulated.
    pub quality: Vec<Quality>,
    /// Scenes of the first round that were inferred each from its own numbers by an emulator of the others; 0
    /// where they are too few.
    pub own_runs: usize,
    /// How often intervals hold truths that were drawn from the prior, by unknown.
    pub calibration: Option<Vec<FieldCalibrated>>,
}

/// Below so many scenes in the first round the 90 % intervals of made truths held 76 to 81 of 100; with 48 they
/// held 90 to 96.
const ENOUGH_SCENES: usize = 40;

impl Answer {
    /// The share of truths that its intervals of 90 % hold, in words.
    pub fn share(&self) -> &'static str {
        if self.own_runs < ENOUGH_SCENES { "about 80 %" } else { "90 %" }
    }

    /// A word on intervals that few scenes make too narrow.
    pub fn too_narrow(&self) -> Option<String> {
        (self.own_runs < ENOUGH_SCENES).then(|| {
            format!(
                "Fewer than {ENOUGH_SCENES} scenes of the first round test the intervals: those of 90 % then \
                 hold about 80 % of the truths. A larger `budget` makes them right"
            )
        })
    }
}

/// Posterior of one unknown.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FieldFound {
    /// Its name.
    pub name: String,
    /// Its prior in words.
    pub prior: String,
    /// Ends of the prior, in the field's unit; `None` for choices.
    pub ends: Option<[f64; 2]>,
    /// Whether the prior is even over the logarithm.
    pub logarithmic: bool,
    /// Median, in the field's unit; `None` for choices.
    pub median: Option<f64>,
    /// 50 % interval.
    pub interval_50: Option<[f64; 2]>,
    /// 90 % interval.
    pub interval_90: Option<[f64; 2]>,
    /// Width of the 90 % interval over that of the prior; of choices the entropy over that of the prior. 1
    /// where nothing was learnt.
    pub width_of_prior: f64,
    /// Probability by equal parts of the prior, or by choice.
    pub bars: Vec<f64>,
    /// Choices with their probabilities; empty for numbers.
    pub choices: Vec<Choice>,
    /// Share of the draws that the 90 % interval takes in: 0.9, or the larger one that holds 90 % of the
    /// scenes of the first round.
    pub level_90: f64,
    /// Share of these scenes in the central 90 % of their draws; `None` where they are too few.
    pub own_runs_in_90: Option<f64>,
    /// Standard deviation that is expected after one more round, over that of now.
    pub expected_narrowing: f64,
    /// The same after any number of further runs: scatter and tolerances remain.
    pub least_narrowing: f64,
}

/// One choice.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Choice {
    /// As it is written.
    pub value: String,
    /// Its probability.
    pub probability: f64,
}

/// One target beside the results of scenes from the posterior.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TargetFound {
    /// Its name.
    pub name: String,
    /// Its path in `summary.json`.
    pub of: String,
    /// Whether differences count by their ratio.
    pub logarithmic: bool,
    /// Observed value, or the score of a curve's component; `None` where the target is that there is no
    /// value.
    pub value: Option<f64>,
    /// How exactly it was read.
    pub tolerance: f64,
    /// Probability that a run of the posterior has it.
    pub exists: f64,
    /// Values below which 5, 25, 50, 75 and 95 % of the emulated runs lie.
    pub predicted: Option<[f64; 5]>,
    /// Share of emulated runs below the target, its tolerance included.
    pub below_target: Option<f64>,
    /// Runs at draws of the posterior.
    pub runs: usize,
    /// Those that have a value.
    pub runs_that_have_it: usize,
    /// Median of these runs.
    pub run_median: Option<f64>,
    /// Their central 90 % interval.
    pub run_interval_90: Option<[f64; 2]>,
    /// All of their values.
    pub run_values: Vec<f64>,
    /// Standard deviations by which the best point of the prior for this target alone misses it; above 0
    /// where the target is larger.
    pub best_alone: f64,
    /// The same at the point that does best for all targets.
    pub best_together: f64,
}

/// Two targets that exclude one another.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Excluded {
    /// Their names.
    pub targets: [String; 2],
    /// The scene that does best for the worse of the two.
    pub best: Vec<[String; 2]>,
    /// How far the worse of them is off there, in standard deviations.
    pub deviations: f64,
}

/// How a target moves an unknown.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Pulled {
    /// The target.
    pub target: String,
    /// The unknown.
    pub field: String,
    /// Shift of its mean by the target, in standard deviations of the posterior.
    pub shift: f64,
    /// Divergence of the posterior from the one without this target [nat].
    pub divergence: f64,
}

/// How well one output is emulated, each point predicted from the others.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Quality {
    /// Its name.
    pub output: String,
    /// Share of runs that yield it.
    pub exists: f64,
    /// Share of the variance that is predicted.
    pub r_squared: Option<f64>,
    /// Share of runs in the 90 % interval of their prediction.
    pub coverage_90: Option<f64>,
    /// Scatter of starts, in the output's unit or relative.
    pub scatter: Option<f64>,
}

/// How often the intervals of one unknown hold the truth.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FieldCalibrated {
    /// Its name.
    pub name: String,
    /// Truths.
    pub truths: usize,
    /// Share of truths in the 50 % interval, with its 95 % Wilson interval.
    pub held_50: [f64; 3],
    /// The same of the 90 % interval.
    pub held_90: [f64; 3],
    /// The same of the central 90 % of the draws.
    pub held_90_of_draws: [f64; 3],
    /// Truths by ten equal ranks in their posterior: even where it is calibrated.
    pub ranks: Vec<usize>,
    /// Probability of ranks as uneven by chance.
    pub p_value: f64,
    /// Standard deviation of the posteriors over that of the prior, on average: 1 where the records carry no
    /// information on it.
    pub width_of_prior: f64,
}

impl Answer {
    /// Targets that no scene of the prior makes.
    pub fn out_of_reach(&self) -> impl Iterator<Item = &TargetFound> {
        self.targets.iter().filter(|target| target.best_alone.abs() > OUT_OF_REACH)
    }
}

/// A number with three significant digits, and no fewer than its integers.
fn short(value: f64) -> String {
    let digits = if value == 0.0 { 0 } else { 2 - value.abs().log10().floor().clamp(-6.0, 2.0) as i32 };
    format!("{value:.*}", digits.max(0) as usize).replace('-', "−")
}

/// Writes `inference.json` and `report.html` into `folder`, which must be there.
pub fn write_inference(folder: &Path, answer: &Answer) -> Result<(), Error> {
    write_atomic(&folder.join("inference.json"), json(answer)?.as_bytes())?;
    write_atomic(&folder.join("report.html"), page::page(answer)?.into_string().as_bytes())?;
    Ok(())
}
