//! The duty of a rolling bearing: speeds and load over time, and the angles of the rings that follow (THEORY
//! §6.3).
//!
//! ```
//! use stribeck_theory::duty::{Course, Duty};
//!
//! // From 500 to 1500 rpm between 10 and 30 ms, under 50 kN that point downwards.
//! let duty = Duty {
//!     speed: Course::lines(&[(0.01, 500.0), (0.03, 1500.0)]),
//!     outer: Course::Constant(0.0),
//!     load: Course::Constant(50e3),
//!     rotating: None,
//!     along: [0.0, -1.0],
//!     guided: false,
//! };
//! assert!((duty.speed_rpm(0.02) - 1000.0).abs() < 1e-9);
//! assert!((duty.relative_turns(0.03) - (0.01 * 500.0 + 0.02 * 1000.0) / 60.0).abs() < 1e-12);
//! ```
//!
//! A ring follows the angle of its profile, θ(t) = −∫ω dt with the speed ω clockwise positive. Whoever
//! rotates it in steps uses the mean speed of each step, the sum of which is that angle, so that nothing
//! drifts. The mean is formed within the step and not as a difference of two angles, whose rounding would
//! shake the ring.
//!
//! Rollers follow the difference of both speeds. Functions of the rings *against each other* give that
//! difference; with an outer ring that stands still it is the speed of the shaft.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

/// Samples over which the mean magnitude of a speed that changes its sign is taken, and the extremes of a
/// difference of speeds.
const SAMPLES: u32 = 10_000;

/// Halvings of a bracket: beyond rounding.
const HALVINGS: usize = 80;

/// Speeds and load over time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Duty {
    /// Speed of the inner ring [rpm], clockwise positive.
    pub speed: Course,
    /// Speed of the outer ring [rpm], clockwise positive.
    pub outer: Course,
    /// Load on the housing [N], without the part that rotates.
    pub load: Course,
    /// Force that turns with the shaft [N] and its angle at the start [rad].
    pub rotating: Option<(f64, f64)>,
    /// Unit vector of the load.
    pub along: [f64; 2],
    /// Whether the housing moves in the direction of the load alone: a guide takes the rest.
    pub guided: bool,
}

/// A number over time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Course {
    /// The same all the time.
    Constant(f64),
    /// mean + amplitude · sin(omega t + phase).
    Harmonic {
        /// Value about which it swings.
        mean: f64,
        /// Largest departure from the mean.
        amplitude: f64,
        /// Angular frequency [rad/s].
        omega: f64,
        /// Phase at the start [rad].
        phase: f64,
    },
    /// Straight lines between points; see [`Course::lines`].
    Lines(Lines),
}

/// Straight lines between points in time, with the first and the last value before and behind them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Lines {
    /// Times [s], ascending.
    time: Vec<f64>,
    /// Values at these times.
    value: Vec<f64>,
    /// Integral from the first time to each of them.
    integral: Vec<f64>,
}

impl Duty {
    /// Speed of the inner ring at a time [s], clockwise positive [rpm].
    pub fn speed_rpm(&self, time_s: f64) -> f64 {
        self.speed.value(time_s)
    }

    /// The same of the outer ring.
    pub fn outer_speed_rpm(&self, time_s: f64) -> f64 {
        self.outer.value(time_s)
    }

    /// Angular velocity of the inner ring [rad/s], counter-clockwise positive, mean between two times [s].
    pub fn mean_shaft_rad_s(&self, from_s: f64, to_s: f64) -> f64 {
        -TAU / 60.0 * self.speed.mean(from_s, to_s)
    }

    /// Angle of rotation of the inner ring [rad] since the start at a time [s], counter-clockwise positive.
    pub fn shaft_rad(&self, time_s: f64) -> f64 {
        -TAU / 60.0 * self.speed.integral(time_s)
    }

    /// Angular velocity of the outer ring [rad/s], as [`Self::mean_shaft_rad_s`].
    pub fn mean_outer_rad_s(&self, from_s: f64, to_s: f64) -> f64 {
        -TAU / 60.0 * self.outer.mean(from_s, to_s)
    }

    /// Angle of rotation of the outer ring [rad] since the start at a time [s], counter-clockwise positive.
    pub fn outer_rad(&self, time_s: f64) -> f64 {
        -TAU / 60.0 * self.outer.integral(time_s)
    }

    /// Load on the housing at a time [s] in its direction [N]: including the component of a rotating load
    /// along it.
    pub fn load_n(&self, time_s: f64) -> f64 {
        self.load.value(time_s) + self.rotating_along(self.along, time_s).unwrap_or(0.0)
    }

    /// Component [N] of the rotating load a quarter of a turn ahead of the static load, at a time [s]; `None`
    /// without a rotating load, and where the housing is guided: the guide then takes that component.
    pub fn load_across_n(&self, time_s: f64) -> Option<f64> {
        let [x, y] = self.along;
        self.rotating_along([-y, x], time_s).filter(|_| !self.guided)
    }

    /// Component of the rotating load along a direction [N].
    fn rotating_along(&self, [x, y]: [f64; 2], time_s: f64) -> Option<f64> {
        self.rotating.map(|(force, angle)| {
            let (s, c) = libm::sincos(angle + self.shaft_rad(time_s));
            force * (c * x + s * y)
        })
    }

    /// Mean load until a time [s] [N]; a rotating load has a mean of zero.
    pub fn mean_load_n(&self, until_s: f64) -> f64 {
        self.load.mean(0.0, until_s)
    }

    /// Least and largest speed between two times [s], clockwise positive [rpm].
    pub fn speed_range_rpm(&self, from_s: f64, until_s: f64) -> [f64; 2] {
        self.speed.range(from_s, until_s)
    }

    /// The same of the outer ring.
    pub fn outer_speed_range_rpm(&self, from_s: f64, until_s: f64) -> [f64; 2] {
        self.outer.range(from_s, until_s)
    }

    /// The same of the inner ring against the outer one.
    pub fn relative_range_rpm(&self, from_s: f64, until_s: f64) -> [f64; 2] {
        let mut at = self.speed.extremes(from_s, until_s);
        at.extend(self.outer.extremes(from_s, until_s));
        if ![&self.speed, &self.outer].iter().any(|course| matches!(course, Course::Constant(_))) {
            // Where both change, their difference may have its extremes anywhere.
            at.extend(samples(from_s, until_s));
        }
        least_and_largest(at.into_iter().map(|t| self.relative_rpm(t)))
    }

    /// Speed of the inner ring against the outer one [rpm].
    fn relative_rpm(&self, time_s: f64) -> f64 {
        self.speed.value(time_s) - self.outer.value(time_s)
    }

    /// Turns of the inner ring against the outer one until a time [s], clockwise positive.
    pub fn relative_turns(&self, time_s: f64) -> f64 {
        (self.speed.integral(time_s) - self.outer.integral(time_s)) / 60.0
    }

    /// Least and largest load until a time [s] [N]; a rotating load counts with its whole amplitude, as if it
    /// were along the load once.
    pub fn load_range_n(&self, until_s: f64) -> [f64; 2] {
        let [least, most] = self.load.range(0.0, until_s);
        let rotating = self.rotating.map_or(0.0, |(force, _)| force);
        [least - rotating, most + rotating]
    }

    /// Whether the rings turn one way against each other all the time until a time [s].
    pub fn is_one_way(&self, until_s: f64) -> bool {
        let [least, most] = self.relative_range_rpm(0.0, until_s);
        least * most >= 0.0
    }

    /// Mean speeds of the inner and of the outer ring until a time [s] [rpm]. Of rings that turn both ways
    /// against each other the difference has the sign of the way that they turn longer and the mean
    /// magnitude.
    pub fn mean_speeds_rpm(&self, until_s: f64) -> [f64; 2] {
        let [inner, outer] = [&self.speed, &self.outer].map(|course| course.mean(0.0, until_s));
        if self.is_one_way(until_s) {
            return [inner, outer];
        }
        let sum: f64 = samples(0.0, until_s).map(|t| self.relative_rpm(t).abs()).sum();
        [outer + (sum / f64::from(SAMPLES)).copysign(inner - outer), outer]
    }

    /// Time [s], within `until_s` [s], at which the rings have made this many turns relative to each other,
    /// in one direction; a negative number of turns counts back from the start at the mean speed. `None` for
    /// rings that make fewer.
    pub fn time_of_turns(&self, turns: f64, until_s: f64) -> Option<f64> {
        let made = |time_s: f64| self.relative_turns(time_s).abs();
        let all = made(until_s);
        if !(turns <= all && all > 0.0) {
            return None;
        }
        if turns < 0.0 {
            return Some(turns / all * until_s);
        }
        let (mut low, mut high) = (0.0, until_s);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if made(middle) < turns { low = middle } else { high = middle }
        }
        Some(0.5 * (low + high))
    }

    /// Slowest magnitude of the speed of the rings against each other until a time [s] [rpm].
    pub fn slowest_rpm(&self, until_s: f64) -> f64 {
        let [least, most] = self.relative_range_rpm(0.0, until_s);
        if least * most <= 0.0 { 0.0 } else { least.abs().min(most.abs()) }
    }
}

impl Course {
    /// Straight lines between points (time [s], value) in ascending order; without any point it is zero.
    pub fn lines(points: &[(f64, f64)]) -> Self {
        if points.is_empty() {
            return Self::Constant(0.0);
        }
        let (time, value): (Vec<f64>, Vec<f64>) = points.iter().copied().unzip();
        let mut integral = vec![0.0];
        for n in 1..time.len() {
            let area = 0.5 * (value[n] + value[n - 1]) * (time[n] - time[n - 1]);
            integral.push(integral[n - 1] + area);
        }
        Self::Lines(Lines { time, value, integral })
    }

    /// Value at a time [s].
    pub fn value(&self, at: f64) -> f64 {
        match self {
            Self::Constant(value) => *value,
            Self::Harmonic { mean, amplitude, omega, phase } => {
                mean + amplitude * libm::sin(omega * at + phase)
            }
            Self::Lines(Lines { time, value, .. }) => {
                let after = time.partition_point(|t| *t <= at);
                match (after.checked_sub(1), value.get(after)) {
                    (None, _) => value[0],
                    (Some(before), None) => value[before],
                    (Some(before), Some(next)) => {
                        let share = (at - time[before]) / (time[after] - time[before]);
                        value[before] + share * (next - value[before])
                    }
                }
            }
        }
    }

    /// Integral from 0 to a time [s].
    pub fn integral(&self, to: f64) -> f64 {
        match self {
            Self::Constant(value) => value * to,
            Self::Harmonic { mean, amplitude, omega, phase } => {
                // cos φ − cos(ωt + φ) as a product, which does not cancel.
                let half = 0.5 * omega * to;
                mean * to + 2.0 * amplitude / omega * libm::sin(half) * libm::sin(half + phase)
            }
            Self::Lines(Lines { time, value, integral }) => {
                let from_first = |at: f64| {
                    let after = time.partition_point(|t| *t <= at);
                    match after.checked_sub(1) {
                        None => value[0] * (at - time[0]),
                        Some(n) => integral[n] + 0.5 * (value[n] + self.value(at)) * (at - time[n]),
                    }
                };
                from_first(to) - from_first(0.0)
            }
        }
    }

    /// Mean between two times [s], to the last digits also of a short interval.
    pub fn mean(&self, from: f64, to: f64) -> f64 {
        let width = to - from;
        match self {
            Self::Constant(value) => *value,
            _ if width <= 0.0 => self.value(from),
            Self::Harmonic { mean, amplitude, omega, phase } => {
                let half = 0.5 * omega * width;
                let flattened = if half > 0.0 { libm::sin(half) / half } else { 1.0 };
                mean + amplitude * flattened * libm::sin(omega * (from + 0.5 * width) + phase)
            }
            Self::Lines(Lines { time, .. }) => {
                // Whole lines by their middle; a corner inside cuts the interval.
                let mut sum = 0.0;
                let mut at = from;
                let first = time.partition_point(|t| *t <= from);
                for corner in time[first..].iter().copied().take_while(|t| *t < to).chain([to]) {
                    sum += self.value(0.5 * (at + corner)) * (corner - at);
                    at = corner;
                }
                sum / width
            }
        }
    }

    /// Least and largest value between two times.
    fn range(&self, from: f64, until: f64) -> [f64; 2] {
        least_and_largest(self.extremes(from, until).into_iter().map(|t| self.value(t)))
    }

    /// Times from one to another among which it is least and largest.
    fn extremes(&self, from: f64, until: f64) -> Vec<f64> {
        let mut at = vec![from, until];
        match self {
            Self::Constant(_) => {}
            Self::Harmonic { omega, phase, .. } => {
                // The first four of its extremes hold both kinds.
                let first = (((omega * from + phase) / std::f64::consts::PI - 0.5).ceil()) as i64;
                let extreme = |n: i64| ((n as f64 + 0.5) * std::f64::consts::PI - phase) / omega;
                at.extend((first..first + 4).map(extreme).filter(|t| (from..=until).contains(t)));
            }
            Self::Lines(Lines { time, .. }) => {
                at.extend(time.iter().copied().filter(|t| (from..=until).contains(t)))
            }
        }
        at
    }
}

/// Times all over a span.
fn samples(from_s: f64, until_s: f64) -> impl Iterator<Item = f64> {
    (0..SAMPLES).map(move |n| from_s + (until_s - from_s) * (f64::from(n) + 0.5) / f64::from(SAMPLES))
}

fn least_and_largest(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], v| [least.min(v), most.max(v)])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The mean of a course over adjacent intervals adds up to its integral, to the rounding of some thousand
    /// sums.
    #[test]
    fn invariant_means_of_adjacent_intervals_add_up_to_the_integral() {
        const ROUNDING: f64 = 1e-12;
        let courses = [
            Course::Constant(3.0),
            Course::Harmonic { mean: 2.0, amplitude: 1.0, omega: 700.0, phase: 0.3 },
            Course::lines(&[(1e-3, 1.0), (2e-3, -4.0), (5e-3, 2.0)]),
        ];
        for course in courses {
            let (dt, steps) = (7e-7, 9000);
            let at = |n: i32| dt * f64::from(n);
            let sum: f64 = (0..steps).map(|n| dt * course.mean(at(n), at(n + 1))).sum();
            let whole = course.integral(at(steps));
            assert!((sum - whole).abs() < ROUNDING, "{course:?}: {sum} and {whole}");
        }
    }
}
