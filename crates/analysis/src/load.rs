//! What the rollers carry: their sum against the load, the largest of them, and the distribution around the bearing.

use serde::{Deserialize, Serialize};

use crate::kinematics::mean;
use crate::record::{Record, Roller};

/// Width of an angular bin of the distribution [°].
const BIN_DEG: f64 = 1.0;

/// Forces on the rollers.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct LoadFinding {
    /// Mean over the record of the force between rollers and outer ring along the load [N], positive when it supports the
    /// load.
    pub mean_n: Option<f64>,
    /// What it must be: the load plus the weight of housing and outer ring along it [N].
    pub expected_n: f64,
    /// `mean_n / expected_n − 1`.
    pub relative_error: Option<f64>,
    /// The same sum at the inner ring [N]: larger by the weight of the rollers.
    pub inner_mean_n: Option<f64>,
    /// Mean force of the housing on the outer ring along the load [N], where the ring sits in one.
    pub seat_mean_n: Option<f64>,
    /// Largest outer-raceway force of any roller, averaged over one facet period [N], so that the facet tone does not
    /// set it. Load compensation next to an unloaded roller and impacts at the exit are in it.
    pub max_roller_n: Option<f64>,
    /// Largest single sample of the same force [N].
    pub max_roller_peak_n: Option<f64>,
    /// Largest roller force between rigid rings at rest, sound raceway [N].
    pub static_max_roller_n: Option<f64>,
    /// The same with the rollers over the defect left out: their neighbours carry more [N].
    pub static_max_roller_defect_n: Option<f64>,
    /// Rollers loaded in the static distribution.
    pub static_loaded_rollers: Option<usize>,
    /// Below this support rollers that have lost their spin do not roll again [N].
    pub least_rolling_n: Option<f64>,
}

/// Mean force by angle.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Distribution {
    /// Angles [°], 0 to 360 counter-clockwise from the x axis, ascending.
    pub angle_deg: Vec<f64>,
    /// Mean normal force of the outer raceway [N] there; not a number where no roller came.
    pub mean_n: Vec<f64>,
}

/// Sums and extremes over the record; the static figures are left empty. `along` is the direction of the load.
pub fn measure(record: &Record<'_>, along: [f64; 2], expected_n: f64, facet_period_s: f64) -> LoadFinding {
    let rollers = record.rollers();
    let samples = (facet_period_s / record.interval_s()).round().max(1.0) as usize;
    let sum = |of: fn(&Roller<'_>) -> Option<[f64; 2]>| -> Option<f64> {
        rollers.iter().map(of).try_fold(0.0, |sum, f| Some(sum + dot(f?, along)))
    };
    let present = !rollers.is_empty() && !record.is_empty();
    let supported = |total: Option<f64>, sign: f64| total.filter(|_| present).map(|f| sign * f);
    let largest = |of: &dyn Fn(&Roller<'_>) -> Vec<f64>| {
        rollers.iter().flat_map(of).reduce(f64::max).filter(|_| present)
    };
    let mean_n = supported(sum(|r| mean_vector(r.outer_fx, r.outer_fy)), 1.0);
    LoadFinding {
        mean_n,
        expected_n,
        relative_error: mean_n.filter(|_| expected_n > 0.0).map(|f| f / expected_n - 1.0),
        inner_mean_n: supported(sum(|r| mean_vector(r.inner_fx, r.inner_fy)), -1.0),
        seat_mean_n: record
            .channel("seat.fx_n")
            .zip(record.channel("seat.fy_n"))
            .and_then(|(x, y)| mean_vector(x, y))
            .map(|force| dot(force, along)),
        max_roller_n: largest(&|r| running_mean(&r.outer_normal(), samples)),
        max_roller_peak_n: largest(&|r| r.outer_normal()),
        static_max_roller_n: None,
        static_max_roller_defect_n: None,
        static_loaded_rollers: None,
        least_rolling_n: None,
    }
}

/// Force of all rollers on the outer ring against the load, whose direction is `along`, at every sample [N]: positive when it
/// supports the load.
pub fn support(record: &Record<'_>, along: [f64; 2]) -> Vec<f64> {
    let rollers = record.rollers();
    let at = |n: usize| rollers.iter().map(|r| dot([r.outer_fx[n], r.outer_fy[n]], along)).sum();
    (0..record.len()).map(at).collect()
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn mean_vector(x: &[f64], y: &[f64]) -> Option<[f64; 2]> {
    Some([mean(x.iter().copied())?, mean(y.iter().copied())?])
}

/// Mean outer-raceway force by angle over all rollers and samples, in bins of one degree.
pub fn distribution(record: &Record<'_>) -> Distribution {
    let bins = (360.0 / BIN_DEG) as usize;
    let (mut sum, mut count) = (vec![0.0; bins], vec![0usize; bins]);
    for roller in record.rollers() {
        let force = roller.outer_normal();
        for n in 0..force.len() {
            let angle = roller.y[n].atan2(roller.x[n]).to_degrees().rem_euclid(360.0);
            // The remainder of a tiny negative angle rounds to 360 itself.
            let bin = ((angle / BIN_DEG) as usize).min(bins - 1);
            sum[bin] += force[n];
            count[bin] += 1;
        }
    }
    let mean = |b: usize| if count[b] > 0 { sum[b] / count[b] as f64 } else { f64::NAN };
    Distribution {
        angle_deg: (0..bins).map(|b| (b as f64 + 0.5) * BIN_DEG).collect(),
        mean_n: (0..bins).map(mean).collect(),
    }
}

/// Mean over every whole window of `width` samples; the mean of all when there are fewer.
pub fn running_mean(values: &[f64], width: usize) -> Vec<f64> {
    values
        .windows(width.clamp(1, values.len().max(1)))
        .map(|w| w.iter().sum::<f64>() / w.len() as f64)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn example_running_mean_removes_a_whole_period() {
        let tone: Vec<f64> =
            (0..400).map(|n| 10.0 + (std::f64::consts::TAU * n as f64 / 20.0).sin()).collect();
        assert!(running_mean(&tone, 20).iter().all(|v| (v - 10.0).abs() < 1e-12));
        assert_eq!(running_mean(&[1.0, 3.0], 5), [2.0]);
        assert!(running_mean(&[], 5).is_empty());
    }
}
