//! Duty: speeds and load over time, and the angles of the rings that follow (THEORY §6.3).
//!
//! A ring follows the angle of its profile, θ(t) = −∫ω dt with the speed ω clockwise positive. What turns it in steps
//! is given the mean speed of each step, whose sum is that angle: nothing drifts. The mean is formed within the step and
//! not as a difference of two angles, whose rounding would shake the ring.
//!
//! Rollers follow the difference of both speeds: what is said here of the rings *against each other* is, beside an outer ring that
//! stands still, said of the shaft.

use std::f64::consts::TAU;

use crate::scene::{OperationScene, ProfileScene, Scene};

/// Samples over which the mean magnitude of a speed that changes its sign is taken, and the extremes of a difference of speeds.
const SAMPLES: u32 = 10_000;

/// Halvings of a bracket: beyond rounding.
const HALVINGS: usize = 80;

/// Speeds and load of a scene over time.
#[derive(Debug, Clone, PartialEq)]
pub struct Duty {
    /// Of the inner ring [rpm], clockwise positive.
    speed: Course,
    /// Of the outer ring, likewise.
    outer: Course,
    /// [N], without what rotates.
    load: Course,
    /// Force that turns with the shaft [N] and its angle at the start [rad].
    rotating: Option<(f64, f64)>,
    /// Direction of the load.
    along: [f64; 2],
    /// Whether the housing moves in that direction alone.
    guided: bool,
}

/// Longest run that a scene may ask for [s].
pub const LONGEST_RUN_S: f64 = 3600.0;

/// A number over time.
#[derive(Debug, Clone, PartialEq)]
enum Course {
    Constant(f64),
    /// Angular frequency [rad/s] and phase [rad].
    Harmonic {
        mean: f64,
        amplitude: f64,
        omega: f64,
        phase: f64,
    },
    /// Times [s], ascending, values, and the integral from the first time on.
    Lines {
        time: Vec<f64>,
        value: Vec<f64>,
        integral: Vec<f64>,
    },
}

impl Duty {
    /// Of a scene. A table that was not read counts as the field that it varies.
    pub fn of(scene: &Scene) -> Self {
        let o = &scene.operation;
        Self {
            speed: Course::of(o.speed_rpm, o.speed_profile.as_ref()),
            outer: Course::of(o.outer_speed_rpm, o.outer_speed_profile.as_ref()),
            load: Course::of(o.load_n, o.load_profile.as_ref()),
            rotating: o.rotating_load.as_ref().map(|load| (load.force_n, load.angle_deg.to_radians())),
            along: scene.load_direction(),
            guided: !scene.housing.takes_any_direction(),
        }
    }

    /// The same, if anything changes in time.
    pub fn varying(scene: &Scene) -> Option<Self> {
        scene.operation.varies().then(|| Self::of(scene))
    }

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

    /// By what angle the inner ring has turned at a time [s] since the start [rad], counter-clockwise positive.
    pub fn shaft_rad(&self, time_s: f64) -> f64 {
        -TAU / 60.0 * self.speed.integral(time_s)
    }

    /// Angular velocity of the outer ring [rad/s], as [`Self::mean_shaft_rad_s`].
    pub fn mean_outer_rad_s(&self, from_s: f64, to_s: f64) -> f64 {
        -TAU / 60.0 * self.outer.mean(from_s, to_s)
    }

    /// By what angle the outer ring has turned at a time [s] since the start [rad], counter-clockwise positive.
    pub fn outer_rad(&self, time_s: f64) -> f64 {
        -TAU / 60.0 * self.outer.integral(time_s)
    }

    /// Load on the housing at a time [s] in its direction [N]: with the part along it of what turns with the shaft.
    pub fn load_n(&self, time_s: f64) -> f64 {
        self.load.value(time_s) + self.rotating_along(self.along, time_s).unwrap_or(0.0)
    }

    /// The part of what turns with the shaft that acts a quarter of a turn ahead of the load at a time [s] [N]; `None` where
    /// nothing turns, and where the housing is guided: the guide takes it then.
    pub fn load_across_n(&self, time_s: f64) -> Option<f64> {
        let [x, y] = self.along;
        self.rotating_along([-y, x], time_s).filter(|_| !self.guided)
    }

    /// What turns with the shaft, along a direction [N].
    fn rotating_along(&self, [x, y]: [f64; 2], time_s: f64) -> Option<f64> {
        self.rotating.map(|(force, angle)| {
            let (s, c) = (angle + self.shaft_rad(time_s)).sin_cos();
            force * (c * x + s * y)
        })
    }

    /// Mean load until a time [s] [N]; what rotates has none.
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

    /// Least and largest load until a time [s] [N]; what rotates is taken as if it stood along the load once.
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

    /// Mean speeds of the inner and of the outer ring until a time [s] [rpm]. Of rings that turn both ways against each other the
    /// difference has the sign of the way that they turn longer and the mean magnitude.
    pub fn mean_speeds_rpm(&self, until_s: f64) -> [f64; 2] {
        let [inner, outer] = [&self.speed, &self.outer].map(|course| course.mean(0.0, until_s));
        if self.is_one_way(until_s) {
            return [inner, outer];
        }
        let sum: f64 = samples(0.0, until_s).map(|t| self.relative_rpm(t).abs()).sum();
        [outer + (sum / f64::from(SAMPLES)).copysign(inner - outer), outer]
    }

    /// When rings that turn one way against each other have made so many turns [s], within `until_s` [s]; a negative number of
    /// turns counts back from the start at the mean speed. `None` for rings that do not come so far.
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

impl Scene {
    /// Unit vector of the load on the housing, counter-clockwise from the x axis; exact for the four axes.
    pub fn load_direction(&self) -> [f64; 2] {
        direction(self.operation.load_angle_deg)
    }

    /// Middle of the load zone [°], 0 to 360: opposite to the way that the load pushes the housing.
    pub fn load_zone_deg(&self) -> f64 {
        (self.operation.load_angle_deg + 180.0).rem_euclid(360.0)
    }
}

/// Unit vector at an angle, exact on the axes.
fn direction(angle_deg: f64) -> [f64; 2] {
    match angle_deg.rem_euclid(360.0) {
        0.0 => [1.0, 0.0],
        90.0 => [0.0, 1.0],
        180.0 => [-1.0, 0.0],
        270.0 => [0.0, -1.0],
        angle => {
            let (s, c) = angle.to_radians().sin_cos();
            [c, s]
        }
    }
}

impl OperationScene {
    /// Whether a speed changes in time.
    pub fn speed_varies(&self) -> bool {
        self.speed_profile.is_some() || self.outer_speed_profile.is_some()
    }

    /// Whether the inner ring turns at some time.
    pub fn inner_turns(&self) -> bool {
        self.speed_rpm != 0.0 || self.speed_profile.is_some()
    }

    /// Whether the outer ring does.
    pub fn outer_turns(&self) -> bool {
        self.outer_speed_rpm != 0.0 || self.outer_speed_profile.is_some()
    }

    /// Whether the load changes in time.
    pub fn load_varies(&self) -> bool {
        self.load_profile.is_some() || self.rotating_load.is_some()
    }

    /// Whether anything changes in time.
    pub fn varies(&self) -> bool {
        self.speed_varies() || self.load_varies()
    }
}

impl Course {
    fn of(field: f64, profile: Option<&ProfileScene>) -> Self {
        match profile {
            None | Some(ProfileScene::Table(_)) => Self::Constant(field),
            Some(ProfileScene::Ramp(ramp)) => {
                Self::lines(&[(1e-3 * ramp.from_ms, field), (1e-3 * ramp.to_ms, ramp.to)])
            }
            Some(ProfileScene::Harmonic(sine)) => Self::Harmonic {
                mean: field,
                amplitude: sine.amplitude,
                omega: TAU * sine.hz,
                phase: sine.phase_deg.to_radians(),
            },
            Some(ProfileScene::Points(points)) if points.is_empty() => Self::Constant(field),
            Some(ProfileScene::Points(points)) => {
                Self::lines(&points.iter().map(|(ms, value)| (1e-3 * ms, *value)).collect::<Vec<_>>())
            }
        }
    }

    fn lines(points: &[(f64, f64)]) -> Self {
        let (time, value): (Vec<f64>, Vec<f64>) = points.iter().copied().unzip();
        let mut integral = vec![0.0];
        for n in 1..time.len() {
            let area = 0.5 * (value[n] + value[n - 1]) * (time[n] - time[n - 1]);
            integral.push(integral[n - 1] + area);
        }
        Self::Lines { time, value, integral }
    }

    fn value(&self, at: f64) -> f64 {
        match self {
            Self::Constant(value) => *value,
            Self::Harmonic { mean, amplitude, omega, phase } => mean + amplitude * (omega * at + phase).sin(),
            Self::Lines { time, value, .. } => {
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

    /// From 0 to a time.
    fn integral(&self, to: f64) -> f64 {
        match self {
            Self::Constant(value) => value * to,
            Self::Harmonic { mean, amplitude, omega, phase } => {
                // cos φ − cos(ωt + φ) as a product, which does not cancel.
                let half = 0.5 * omega * to;
                mean * to + 2.0 * amplitude / omega * half.sin() * (half + phase).sin()
            }
            Self::Lines { time, value, integral } => {
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

    /// Mean between two times, to the last digits also of a short interval.
    fn mean(&self, from: f64, to: f64) -> f64 {
        let width = to - from;
        match self {
            Self::Constant(value) => *value,
            _ if width <= 0.0 => self.value(from),
            Self::Harmonic { mean, amplitude, omega, phase } => {
                let half = 0.5 * omega * width;
                let flattened = if half > 0.0 { half.sin() / half } else { 1.0 };
                mean + amplitude * flattened * (omega * (from + 0.5 * width) + phase).sin()
            }
            Self::Lines { time, .. } => {
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
            Self::Lines { time, .. } => {
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

    /// Sums of some thousand numbers.
    const ROUNDING: f64 = 1e-12;

    fn with(set: &[&str]) -> Duty {
        Duty::of(&Scene::default().with_overrides(set).expect("a sound scene"))
    }

    fn close(ours: f64, theirs: f64) {
        assert!((ours - theirs).abs() <= ROUNDING * theirs.abs().max(1.0), "{ours} instead of {theirs}");
    }

    /// Source: a motion of constant acceleration, θ = ω₀t + ½αt²; of a sine, θ = (A/ω)(cos φ − cos(ωt + φ)).
    #[test]
    fn analytic_angles_of_a_ramp_and_of_a_sine() {
        let ramp = with(&["operation.speed_profile=ramp(from_ms: 10, to_ms: 30, to: 1500)"]);
        close(ramp.speed_rpm(0.005), 500.0);
        close(ramp.speed_rpm(0.02), 1000.0);
        close(ramp.speed_rpm(0.05), 1500.0);
        // 10 ms at 500, 20 ms at 1000 in the mean, 20 ms at 1500 rpm.
        let turns = (0.01 * 500.0 + 0.02 * 1000.0 + 0.02 * 1500.0) / 60.0;
        close(ramp.shaft_rad(0.05), -TAU * turns);
        close(ramp.time_of_turns(turns, 0.1).expect("in time"), 0.05);
        let sine = with(&["operation.speed_profile=harmonic(amplitude: 100, hz: 5, phase_deg: 30)"]);
        let (omega, phase, t): (f64, f64, f64) = (TAU * 5.0, TAU / 12.0, 0.137);
        let way = 500.0 * t + 100.0 / omega * (phase.cos() - (omega * t + phase).cos());
        close(sine.shaft_rad(t), -TAU * way / 60.0);
        close(sine.speed_rpm(0.0), 550.0);
        assert_eq!(sine.speed_range_rpm(0.0, 1.0).map(f64::round), [400.0, 600.0]);
        close(sine.speed_range_rpm(0.0, 0.01)[0], 550.0);
        // Of a stretch behind its crest at 1/30 s.
        close(sine.speed_range_rpm(0.05, 0.1)[1], sine.speed_rpm(0.05));
        close(ramp.speed_range_rpm(0.02, 0.025)[0], 1000.0);
    }

    #[test]
    fn invariant_means_of_steps_add_up_to_the_angle() {
        for set in [
            "operation.speed_profile=ramp(from_ms: 1.7, to_ms: 4.03, to: -700)",
            "operation.speed_profile=harmonic(amplitude: 300, hz: 170, phase_deg: 40)",
            "operation.speed_profile=points([(0.5, 0), (0.501, 900), (2.2, 900), (6, 20)])",
        ] {
            let duty = with(&[set]);
            let dt = 0.7e-6;
            let at = |n: u32| f64::from(n) * dt;
            let sum: f64 = (0..8000).map(|n| dt * duty.mean_shaft_rad_s(at(n), at(n + 1))).sum();
            close(sum, duty.shaft_rad(at(8000)));
        }
    }

    #[test]
    fn example_a_load_that_turns_with_the_shaft_comes_once_a_turn() {
        let duty = with(&["operation.rotating_load=(force_n: 2000, angle_deg: 270)"]);
        // Downwards at the start, upwards half a turn later, which 500 rpm make in 60 ms.
        close(duty.load_n(0.0), 52_000.0);
        close(duty.load_n(0.06), 48_000.0);
        close(duty.load_n(0.12), 52_000.0);
        assert_eq!(duty.load_range_n(1.0), [48_000.0, 52_000.0]);
        assert_eq!((duty.mean_load_n(1.0), duty.mean_speeds_rpm(1.0)), (50_000.0, [500.0, 0.0]));
    }

    #[test]
    fn example_a_shaft_that_turns_back_has_no_time_for_its_turns() {
        let set =
            ["operation.speed_rpm=-500", "operation.speed_profile=ramp(from_ms: 0, to_ms: 100, to: 500)"];
        let duty = with(&set);
        assert!(!duty.is_one_way(0.1) && duty.is_one_way(0.05));
        close(duty.mean_speeds_rpm(0.1)[0], 250.0);
        assert_eq!(duty.slowest_rpm(0.1), 0.0);
        let constant = Duty::of(&Scene::default());
        assert_eq!(Duty::varying(&Scene::default()), None);
        assert_eq!((constant.speed_rpm(0.3), constant.load_n(0.3)), (500.0, 50_000.0));
        assert_eq!(constant.time_of_turns(5.0, 0.1), None);
    }

    #[test]
    fn example_rings_that_both_change_their_speed() {
        const RIGID: &str = "housing=rigid()";
        // The shaft from 500 to 1500 rpm in 20 ms, the outer ring at −100 rpm: turns against it are the area between the two.
        let ramp = "operation.speed_profile=ramp(from_ms: 0, to_ms: 20, to: 1500)";
        let beside = with(&[RIGID, ramp, "operation.outer_speed_rpm=-100"]);
        assert_eq!(beside.relative_range_rpm(0.0, 0.02), [600.0, 1600.0]);
        assert_eq!(beside.slowest_rpm(0.02), 600.0);
        let turns = (0.02 * 1100.0 + 0.004 * 1600.0) / 60.0;
        close(beside.relative_turns(0.024), turns);
        close(beside.time_of_turns(turns, 0.1).expect("in time"), 0.024);
        close(beside.outer_rad(0.03), TAU * 0.03 * 100.0 / 60.0);
        let [inner, outer] = beside.mean_speeds_rpm(0.02);
        assert_eq!([inner, outer].map(f64::round), [1000.0, -100.0]);
        // Both change, and their difference turns between the corners of either: 500 + 100 sin(2π 5 t) against a ramp of
        // 5 rpm/ms. Its derivative, 1000π cos(10πt) − 5000, never vanishes: it falls from 500 to −500 at 200 ms.
        let both = with(&[
            RIGID,
            "operation.speed_profile=harmonic(amplitude: 100, hz: 5)",
            "operation.outer_speed_profile=ramp(to_ms: 200, to: 1000)",
        ]);
        close(both.relative_range_rpm(0.0, 0.2)[0], -500.0);
        assert!(!both.is_one_way(0.2) && both.is_one_way(0.05));
        // At 2000 rpm/s the derivative vanishes where cos(10πt) = 2/π.
        let both = with(&[
            RIGID,
            "operation.speed_profile=harmonic(amplitude: 100, hz: 5)",
            "operation.outer_speed_profile=ramp(to_ms: 200, to: 400)",
        ]);
        let at = (2.0 / std::f64::consts::PI).acos() / (10.0 * std::f64::consts::PI);
        let largest = 500.0 + 100.0 * (TAU * 5.0 * at).sin() - 2000.0 * at;
        assert!((both.relative_range_rpm(0.0, 0.2)[1] - largest).abs() < 1e-4, "{largest}");
    }
}
