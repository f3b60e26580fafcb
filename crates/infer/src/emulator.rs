//! Outputs as functions of the point, learned from runs: a Gaussian process each, with the scatter of runs,
//! the probability that the output exists, and the correlation of residuals.

mod correlation;
mod existence;
mod hyper;
mod kernel;
mod regression;
mod scatter;
mod tails;

use faer::Mat;
use serde::{Deserialize, Serialize};

use self::{
    existence::Existence,
    hyper::{Hyper, Sample},
    regression::Regression,
    scatter::{Scatter, Spread},
};
pub(crate) use hyper::members;
pub(crate) use tails::Tails;

use crate::{
    error::Error,
    runs::{Output, Runs, Scale, check_point},
};

/// An output that fewer points than these yield is not emulated.
const LEAST_VALUES: usize = 4;

/// All outputs of a simulation as functions of its point.
#[derive(Debug, Clone)]
pub struct Emulator {
    dimensions: usize,
    columns: Vec<Column>,
    /// Of the residuals, as normal deviates.
    correlations: Mat<f64>,
}

/// Prediction of one output at one point, in the output's unit. Where it is emulated on a logarithmic scale,
/// `mean` is its median, and the deviations are those of the logarithm times the mean.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Prediction {
    /// Probability that a run there yields it.
    pub exists: f64,
    /// Its mean over starts. NaN where too few runs yield the output for it to be emulated.
    pub mean: f64,
    /// Standard deviation of that mean, which more runs reduce.
    pub sd_of_mean: f64,
    /// Standard deviation of single starts about the mean, which no further run reduces.
    pub scatter: f64,
}

/// How well an output is emulated, each point predicted from the others.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Quality {
    /// Name of the output.
    pub output: String,
    /// Runs that yield it.
    pub runs: usize,
    /// Share of runs that yield it.
    pub exists: f64,
    /// Share of the variance of runs that the other points predict, on the output's scale: 1 where runs
    /// follow a smooth function without scatter, 0 where they do not depend on the point. NaN without an
    /// emulator.
    pub r_squared: f64,
    /// Share of runs within the 90 % interval of their prediction.
    pub coverage_90: f64,
    /// Root mean square of the predicted scatter, in the output's unit, or relative on a logarithmic scale.
    pub scatter: f64,
}

/// One output.
#[derive(Debug, Clone)]
struct Column {
    output: Output,
    existence: Existence,
    value: Option<Value>,
    quality: Quality,
}

/// An output where it exists, on its scale.
#[derive(Debug, Clone)]
struct Value {
    centre: f64,
    spread: f64,
    regression: Regression,
    /// Variance of a run in units of the output's variance, times the exponential of the function below.
    noise: f64,
    scatter: Option<Regression>,
    tails: Tails,
    /// Magnitudes of the cross-validated residuals in units of their predicted scale, sorted.
    magnitudes: Vec<f64>,
}

/// A prediction on the output's scale, with scales of the Student distribution in place of deviations.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Scaled {
    pub(crate) mean: f64,
    /// Of the mean.
    pub(crate) uncertainty: f64,
    /// Of a run about it.
    pub(crate) scatter: f64,
}

impl Scaled {
    /// Of a run about the predicted mean.
    pub(crate) fn scale(&self) -> f64 {
        self.uncertainty.hypot(self.scatter)
    }
}

/// Points with their runs.
struct Grouped<'a> {
    runs: &'a Runs,
    groups: Vec<Vec<usize>>,
    /// Number of the block of each group: readings of the same simulations.
    blocks: Vec<usize>,
}

impl Emulator {
    /// Learns every output from runs. The seed is there for a later choice of method; the fit of today draws
    /// nothing.
    ///
    /// # Errors
    /// When rows and columns do not fit together, a number is out of its range, or there are fewer different
    /// points than dimensions + 2.
    pub fn fit(runs: &Runs, outputs: &[Output], _seed: u64) -> Result<Self, Error> {
        runs.check(outputs)?;
        let groups = runs.groups();
        let grouped = Grouped { runs, blocks: runs.blocks(&groups), groups };
        let (points, dimensions) = (grouped.groups.len(), runs.dimensions());
        let least = dimensions + 2;
        if points < least || dimensions == 0 {
            return Err(Error::FewRuns { points, dimensions, least });
        }
        let fitted = in_parallel(outputs.len(), |number| Column::fit(&grouped, &outputs[number], number));
        let fitted: Vec<(Column, Vec<Option<f64>>)> = fitted.into_iter().collect::<Result<_, _>>()?;
        let (columns, residuals): (Vec<_>, Vec<_>) = fitted.into_iter().unzip();
        let simulations: Vec<usize> = (0..runs.points.len()).map(|row| runs.simulation(row)).collect();
        let correlations = correlation::correlations(&residuals, &simulations);
        Ok(Self { dimensions, columns, correlations })
    }

    /// Dimensions of a point.
    pub fn dimensions(&self) -> usize {
        self.dimensions
    }

    /// The outputs, in the order of the columns.
    pub fn outputs(&self) -> impl ExactSizeIterator<Item = &Output> {
        self.columns.iter().map(|column| &column.output)
    }

    /// How well each output is emulated.
    pub fn quality(&self) -> Vec<Quality> {
        self.columns.iter().map(|column| column.quality.clone()).collect()
    }

    /// Correlation of the residuals of two outputs, after shrinkage, −1 … 1.
    pub fn correlation(&self, a: usize, b: usize) -> f64 {
        self.correlations[(a, b)]
    }

    /// All outputs at a point of the unit cube.
    ///
    /// # Errors
    /// When the point has other dimensions, or lies outside.
    pub fn predict(&self, point: &[f64]) -> Result<Vec<Prediction>, Error> {
        Ok(self.predict_all(&[point.to_vec()])?.remove(0))
    }

    /// All outputs at many points (`[point][output]`), which is faster than one by one.
    ///
    /// # Errors
    /// When a point has other dimensions, or lies outside.
    pub fn predict_all(&self, points: &[Vec<f64>]) -> Result<Vec<Vec<Prediction>>, Error> {
        self.check(points)?;
        let mut rows = vec![Vec::with_capacity(self.columns.len()); points.len()];
        for (number, column) in self.columns.iter().enumerate() {
            let exists = self.exists(number, points);
            let scaled = self.scaled(number, points);
            for (j, row) in rows.iter_mut().enumerate() {
                let at = scaled.as_ref().map(|all| all[j]);
                row.push(column.prediction(exists[j], at));
            }
        }
        Ok(rows)
    }

    /// The interval around the prediction that holds `share` (above 0, below 1) of runs at a point, in the
    /// output's unit: as wide as it had to be for the runs themselves, each predicted from the others (a
    /// conformal interval). None where the output is not emulated.
    ///
    /// # Errors
    /// When the point has other dimensions or lies outside, there is no such output, or the share is out of
    /// range.
    pub fn interval(&self, point: &[f64], output: usize, share: f64) -> Result<Option<[f64; 2]>, Error> {
        let points = [point.to_vec()];
        self.check(&points)?;
        if !(share > 0.0 && share < 1.0) {
            return Err(Error::Option { option: "share", value: share, expected: "above 0 and below 1" });
        }
        let Some(column) = self.columns.get(output) else {
            let expected = "the number of an output";
            return Err(Error::Option { option: "output", value: output as f64, expected });
        };
        let (Some(value), Some(scaled)) = (&column.value, self.scaled(output, &points)) else {
            return Ok(None);
        };
        let half = value.magnitude(share) * scaled[0].scale();
        let ends = [scaled[0].mean - half, scaled[0].mean + half];
        Ok(Some(ends.map(|end| column.output.scale.back(end))))
    }

    pub(crate) fn check(&self, points: &[Vec<f64>]) -> Result<(), Error> {
        for (row, point) in points.iter().enumerate() {
            if point.len() != self.dimensions {
                let (found, expected) = (point.len(), self.dimensions);
                return Err(Error::Shape { what: "point", number: row, found, expected });
            }
            check_point(point, row)?;
        }
        Ok(())
    }

    pub(crate) fn exists(&self, output: usize, points: &[Vec<f64>]) -> Vec<f64> {
        self.columns[output].existence.predict(points)
    }

    /// An output at points, on its scale; none where it is not emulated.
    pub(crate) fn scaled(&self, output: usize, points: &[Vec<f64>]) -> Option<Vec<Scaled>> {
        let value = self.columns[output].value.as_ref()?;
        let logarithms = value.scatter.as_ref().map(|function| function.means(points));
        let one = |(j, [mean, variance]): (usize, [f64; 2])| {
            let factor = logarithms.as_ref().map_or(1.0, |all| all[j].clamp(-12.0, 12.0).exp());
            let unit = value.spread * value.tails.scale;
            Scaled {
                mean: value.centre + value.spread * mean,
                uncertainty: unit * variance.max(0.0).sqrt(),
                scatter: unit * (value.noise * factor).sqrt(),
            }
        };
        Some(value.regression.predict(points).into_iter().enumerate().map(one).collect())
    }

    /// The share of the mean's uncertainty that remains at points after runs at further ones, one start each.
    /// None where the output is not emulated.
    pub(crate) fn left_after(
        &self,
        output: usize,
        points: &[Vec<f64>],
        further: &[Vec<f64>],
    ) -> Option<Vec<f64>> {
        let value = self.columns[output].value.as_ref()?;
        let noise = self.scaled(output, further)?.into_iter().map(|at| at.scatter * at.scatter);
        let unit = value.spread * value.tails.scale;
        let noise: Vec<f64> = noise.map(|square| square / (unit * unit)).collect();
        Some(value.regression.left_after(points, further, &noise))
    }

    pub(crate) fn tails(&self, output: usize) -> Option<Tails> {
        self.columns[output].value.as_ref().map(|value| value.tails)
    }

    pub(crate) fn scale_of(&self, output: usize) -> Scale {
        self.columns[output].output.scale
    }
}

impl Value {
    /// How many scales from the mean the interval of a share ends.
    fn magnitude(&self, share: f64) -> f64 {
        let n = self.magnitudes.len();
        let rank = ((n as f64 + 1.0) * share).ceil() as usize;
        match self.magnitudes.get(rank.max(1) - 1) {
            Some(&magnitude) => magnitude,
            None => self.tails.quantile(0.5 + 0.5 * share).max(self.magnitudes[n - 1]),
        }
    }
}

impl Column {
    /// Fits an output; with it the residual of every run as a normal deviate.
    fn fit(grouped: &Grouped, output: &Output, number: usize) -> Result<(Self, Vec<Option<f64>>), Error> {
        let all = |row: usize| grouped.runs.outputs[row][number];
        let points: Vec<Vec<f64>> =
            grouped.groups.iter().map(|group| grouped.runs.points[group[0]].clone()).collect();
        let runs: Vec<f64> = grouped.groups.iter().map(|group| group.len() as f64).collect();
        let count = |group: &Vec<usize>| group.iter().filter(|&&row| all(row).is_some()).count() as f64;
        let have: Vec<f64> = grouped.groups.iter().map(count).collect();
        let existence = Existence::fit(&points, &have, &runs, &grouped.blocks)?;

        let total = grouped.runs.points.len();
        let with: usize = (0..total).filter(|&row| all(row).is_some()).count();
        let mut quality = Quality {
            output: output.name.clone(),
            runs: with,
            exists: with as f64 / total as f64,
            r_squared: f64::NAN,
            coverage_90: f64::NAN,
            scatter: f64::NAN,
        };
        let mut residuals = vec![None; total];
        let mut value = None;
        if have.iter().filter(|&&some| some > 0.0).count() >= LEAST_VALUES {
            let rows: Vec<(usize, f64)> =
                (0..total).filter_map(|row| Some((row, output.scale.forward(all(row)?)))).collect();
            value = Some(Value::fit(grouped, &rows, &mut residuals, &mut quality)?);
        }
        Ok((Self { output: output.clone(), existence, value, quality }, residuals))
    }

    fn prediction(&self, exists: f64, at: Option<Scaled>) -> Prediction {
        let (Some(at), Some(value)) = (at, &self.value) else {
            return Prediction { exists, mean: f64::NAN, sd_of_mean: f64::NAN, scatter: f64::NAN };
        };
        let mean = self.output.scale.back(at.mean);
        let unit = self.output.scale.slope(mean) * value.tails.deviation();
        Prediction { exists, mean, sd_of_mean: unit * at.uncertainty, scatter: unit * at.scatter }
    }
}

impl Value {
    /// Fits the values of runs (row, value on the output's scale).
    fn fit(
        grouped: &Grouped,
        rows: &[(usize, f64)],
        residuals: &mut [Option<f64>],
        quality: &mut Quality,
    ) -> Result<Self, Error> {
        let n = rows.len() as f64;
        let centre = rows.iter().map(|row| row.1).sum::<f64>() / n;
        let variance = rows.iter().map(|row| (row.1 - centre).powi(2)).sum::<f64>() / n;
        // A constant output has no unit of its own; rounding must not become one.
        let spread = variance.sqrt().max(1e-12 * centre.abs()).max(f64::MIN_POSITIVE.sqrt());
        let mut of_row = vec![None; grouped.runs.points.len()];
        for (row, value) in rows {
            of_row[*row] = Some((value - centre) / spread);
        }
        let mut points = Vec::new();
        let mut members: Vec<Vec<usize>> = Vec::new();
        let (mut values, mut spreads, mut blocks) = (Vec::new(), Vec::new(), Vec::new());
        for (group, &block) in grouped.groups.iter().zip(&grouped.blocks) {
            let those: Vec<usize> = group.iter().copied().filter(|&row| of_row[row].is_some()).collect();
            let numbers: Vec<f64> = those.iter().filter_map(|&row| of_row[row]).collect();
            if numbers.is_empty() {
                continue;
            }
            let runs = numbers.len() as f64;
            let mean = numbers.iter().sum::<f64>() / runs;
            spreads.push(Spread { squares: numbers.iter().map(|x| (x - mean).powi(2)).sum(), runs });
            values.push(mean);
            points.push(grouped.runs.points[group[0]].clone());
            members.push(those);
            blocks.push(block);
        }
        let mut repeats = vec![1.0; points.len()];
        if let Some(kept) = hyper::representatives(&blocks, &values) {
            repeats = kept.iter().map(|(_, block)| block.len() as f64).collect();
            members = kept
                .iter()
                .map(|(_, block)| block.iter().flat_map(|&i| members[i].clone()).collect())
                .collect();
            values = kept.iter().map(|(i, _)| values[*i]).collect();
            points = kept.iter().map(|(i, _)| points[*i].clone()).collect();
            spreads = kept
                .iter()
                .map(|(i, _)| Spread { squares: spreads[*i].squares, runs: spreads[*i].runs })
                .collect();
            blocks = kept.iter().map(|(i, _)| blocks[*i]).collect();
        }
        let fit = Fit::of(&points, &values, &spreads, &blocks)?;
        let mut standardised = Vec::new();
        let mut weights = Vec::new();
        let mut unexplained = 0.0;
        let mut size = std::collections::BTreeMap::<usize, f64>::new();
        blocks.iter().for_each(|block| *size.entry(*block).or_default() += 1.0);
        for (i, those) in members.iter().enumerate() {
            let scale = (fit.left_out[i].variance + fit.noise * fit.scatter.left_out[i]).sqrt();
            for &row in those {
                let residual = of_row[row].unwrap_or_default() - fit.left_out[i].mean;
                unexplained += residual * residual;
                standardised.push((row, residual / scale));
                weights.push(1.0 / (repeats[i] * (1.0 + (size[&blocks[i]] - 1.0) * fit.shared)));
            }
        }
        let numbers: Vec<f64> = standardised.iter().map(|pair| pair.1).collect();
        let tails = Tails::fit(&numbers, &weights);
        for (row, z) in &standardised {
            residuals[*row] = Some(tails.normal(z / tails.scale));
        }
        let mut magnitudes: Vec<f64> = numbers.iter().map(|z| z.abs() / tails.scale).collect();
        magnitudes.sort_by(f64::total_cmp);
        let bound = tails.quantile(0.95);
        let mean_factor = fit.scatter.factors.iter().sum::<f64>() / points.len() as f64;
        quality.r_squared = 1.0 - unexplained / n;
        quality.coverage_90 = magnitudes.iter().filter(|&&t| t <= bound).count() as f64 / n;
        quality.scatter = spread * tails.scale * tails.deviation() * (fit.noise * mean_factor).sqrt();
        let (regression, noise, scatter) = (fit.regression, fit.noise, fit.scatter.function);
        Ok(Self { centre, spread, regression, noise, scatter, tails, magnitudes })
    }
}

/// A regression with its scatter, and each point predicted from the others.
struct Fit {
    regression: Regression,
    left_out: Vec<regression::LeftOut>,
    noise: f64,
    /// Share of the noise that readings of one simulation have in common.
    shared: f64,
    scatter: Scatter,
}

impl Fit {
    /// The scatter follows from residuals, and the regression from the scatter: two rounds.
    fn of(points: &[Vec<f64>], values: &[f64], spreads: &[Spread], blocks: &[usize]) -> Result<Self, Error> {
        let linear = points.len() >= points[0].len() + 3;
        let mut scatter = Scatter::even(points.len());
        let mut hyper: Option<Hyper> = None;
        for round in 0.. {
            let factors: Vec<f64> = scatter.factors.iter().zip(spreads).map(|(f, s)| f / s.runs).collect();
            let sample = Sample { points, values, factors: &factors, blocks, linear };
            let found = match hyper {
                Some(found) if round == 2 => found,
                start => Hyper::fit(&sample, start.as_ref()),
            };
            let (noise, shared) = (found.noise, found.shared);
            let (regression, left_out) = Regression::fit(&sample, &found)?;
            if round == 2 {
                return Ok(Self { regression, left_out, noise, shared, scatter });
            }
            scatter = Scatter::fit(&sample, spreads, noise, &scatter.factors, &left_out)?;
            hyper = Some(found);
        }
        unreachable!("the third round returns")
    }
}

/// Results of numbered tasks, in their order, whichever thread does which.
fn in_parallel<T: Send>(tasks: usize, task: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let threads = std::thread::available_parallelism().map_or(1, usize::from).min(tasks.max(1));
    let next = std::sync::atomic::AtomicUsize::new(0);
    let work = || {
        let take = || next.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        let numbers = std::iter::repeat_with(take).take_while(|&number| number < tasks);
        numbers.map(|number| (number, task(number))).collect::<Vec<_>>()
    };
    let mut done: Vec<(usize, T)> = std::thread::scope(|scope| {
        let others: Vec<_> = (1..threads).map(|_| scope.spawn(work)).collect();
        let mut own = work();
        for other in others {
            own.extend(other.join().expect("a task that does not panic"));
        }
        own
    });
    done.sort_by_key(|pair| pair.0);
    done.into_iter().map(|pair| pair.1).collect()
}
