//! Load of the rollers: their sum against the load, the largest of them, and the distribution around the
//! bearing.

use serde::{Deserialize, Serialize};
use stribeck_dsp::running_mean;

use crate::kinematics::mean;
use crate::record::{Record, Roller};
use stribeck_diagnosis::quantities;

/// Width of an angular bin of the distribution [°].
const BIN_DEG: f64 = 1.0;

quantities! {
    /// Forces on the rollers.
    #[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
    pub struct LoadFinding {
        /// Mean over the record of the force between rollers and outer ring along the load [N], positive when
        /// it supports the load.
        pub mean_n: Option<f64> => "mean force of load and weight on the outer ring" at 5,
        /// Expected value: the load, its mean over the record where it changes, plus the weight that
        /// rests on the rollers along it [N].
        pub expected_n: f64,
        /// `mean_n / expected_n − 1`.
        pub relative_error: Option<f64> => "mean load off the applied one",
        /// The same sum at the inner ring [N]: larger by the weight of the rollers.
        pub inner_mean_n: Option<f64>,
        /// Mean force of the housing on the outer ring along the load [N], where the ring sits in one.
        pub seat_mean_n: Option<f64>,
        /// Largest outer-raceway force of any roller, averaged over one facet period [N], so that the facet
        /// tone does not set it. Load compensation next to an unloaded roller and impacts at the exit
        /// are in it.
        pub max_roller_n: Option<f64> => "largest force on a roller" at 6,
        /// Largest single sample of the same force [N].
        pub max_roller_peak_n: Option<f64>,
        /// Largest roller force between rigid rings at rest, healthy raceway [N].
        pub static_max_roller_n: Option<f64>,
        /// The same with the rollers over the defect left out: their neighbours carry more [N].
        pub static_max_roller_defect_n: Option<f64>,
        /// Rollers loaded in the static distribution.
        pub static_loaded_rollers: Option<usize>,
        /// Below this support rollers that have lost their spin do not roll again [N].
        pub least_rolling_n: Option<f64>,
    }
}

/// Mean force by angle.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Distribution {
    /// Angles [°], 0 to 360 counter-clockwise from the x axis, ascending.
    pub angle_deg: Vec<f64>,
    /// Mean normal force of the outer raceway [N] there; not a number where no roller came.
    pub mean_n: Vec<f64>,
}

/// Loads of rollers, read one after the other.
#[derive(Debug)]
pub struct Carried {
    /// Direction of the load.
    along: [f64; 2],
    /// Samples in a facet period.
    width: usize,
    /// Mean force between rollers and each ring along the load [N]; `None` without a sample.
    outer_n: Option<f64>,
    inner_n: Option<f64>,
    /// Largest force of the outer raceway, and the same averaged over a facet period [N].
    peak_n: Option<f64>,
    largest_n: Option<f64>,
    support_n: Vec<f64>,
    /// Sum of the forces of the outer raceway [N] and their number in each bin of angle.
    bins: Vec<(f64, usize)>,
    rollers: usize,
}

impl Carried {
    /// Before the first roller of a record, under a load `along` this direction.
    pub fn new(record: &Record<'_>, along: [f64; 2], facet_period_s: f64) -> Self {
        Self {
            along,
            width: (facet_period_s / record.interval_s()).round().max(1.0) as usize,
            outer_n: Some(0.0),
            inner_n: Some(0.0),
            peak_n: None,
            largest_n: None,
            support_n: vec![0.0; record.len()],
            bins: vec![(0.0, 0); (360.0 / BIN_DEG) as usize],
            rollers: 0,
        }
    }

    /// One roller more, with the normal force of the outer raceway [N] at every sample.
    pub fn add(&mut self, roller: &Roller<'_>, outer_normal: &[f64]) {
        let more = |sum: Option<f64>, x, y| Some(sum? + dot(mean_vector(x, y)?, self.along));
        self.outer_n = more(self.outer_n, roller.outer_fx, roller.outer_fy);
        self.inner_n = more(self.inner_n, roller.inner_fx, roller.inner_fy);
        let larger = |a: Option<f64>, of: &[f64]| a.into_iter().chain(of.iter().copied()).reduce(f64::max);
        self.peak_n = larger(self.peak_n, outer_normal);
        self.largest_n = larger(self.largest_n, &running_mean(outer_normal, self.width));
        let forces = roller.outer_fx.iter().zip(roller.outer_fy);
        for (sum, (fx, fy)) in self.support_n.iter_mut().zip(forces) {
            *sum += dot([*fx, *fy], self.along);
        }
        let last = self.bins.len() - 1;
        for (force, (x, y)) in outer_normal.iter().zip(roller.x.iter().zip(roller.y)) {
            let angle = y.atan2(*x).to_degrees().rem_euclid(360.0);
            // The remainder of a tiny negative angle rounds to 360 itself.
            let (sum, count) = &mut self.bins[((angle / BIN_DEG) as usize).min(last)];
            *sum += force;
            *count += 1;
        }
        self.rollers += 1;
    }

    /// Sums and extremes over the record; the static figures are left empty.
    pub fn finding(&self, record: &Record<'_>, expected_n: f64) -> LoadFinding {
        let present = self.rollers > 0 && !record.is_empty();
        let supported = |total: Option<f64>, sign: f64| total.filter(|_| present).map(|f| sign * f);
        let mean_n = supported(self.outer_n, 1.0);
        LoadFinding {
            mean_n,
            expected_n,
            relative_error: mean_n.filter(|_| expected_n > 0.0).map(|f| f / expected_n - 1.0),
            inner_mean_n: supported(self.inner_n, -1.0),
            seat_mean_n: record
                .channel("seat.fx_n")
                .zip(record.channel("seat.fy_n"))
                .and_then(|(x, y)| mean_vector(x, y))
                .map(|force| dot(force, self.along)),
            max_roller_n: self.largest_n,
            max_roller_peak_n: self.peak_n,
            static_max_roller_n: None,
            static_max_roller_defect_n: None,
            static_loaded_rollers: None,
            least_rolling_n: None,
        }
    }

    /// Mean outer-raceway force by angle over all rollers and samples, in bins of one degree.
    pub fn distribution(&self) -> Distribution {
        let mean = |(sum, count): &(f64, usize)| if *count > 0 { sum / *count as f64 } else { f64::NAN };
        Distribution {
            angle_deg: (0..self.bins.len()).map(|b| (b as f64 + 0.5) * BIN_DEG).collect(),
            mean_n: self.bins.iter().map(mean).collect(),
        }
    }

    /// Force of all rollers on the outer ring against the load at every sample [N]: positive when it supports
    /// the load; empty where no roller was recorded.
    pub fn into_support(self) -> Vec<f64> {
        if self.rollers > 0 { self.support_n } else { Vec::new() }
    }
}

/// Force of all rollers on the outer ring against the load, whose direction is `along`, at every sample [N]:
/// positive when it supports the load.
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
