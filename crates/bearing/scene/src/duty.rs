//! Speeds and load of a scene over time, in SI: [`Duty`] (THEORY §6.3).

use stribeck_theory::duty::{Course, Duty};

pub use crate::scene::LONGEST_RUN_S;
use crate::scene::{OperationScene, ProfileScene, Scene};

impl Scene {
    /// Speeds and load over time. A table that was not read counts as the field that it varies.
    pub fn duty(&self) -> Duty {
        let o = &self.operation;
        Duty {
            speed: course(o.speed_rpm, o.speed_profile.as_ref()),
            outer: course(o.outer_speed_rpm, o.outer_speed_profile.as_ref()),
            load: course(o.load_n, o.load_profile.as_ref()),
            rotating: o.rotating_load.as_ref().map(|load| (load.force_n, load.angle_deg.to_radians())),
            along: self.load_direction(),
            guided: !self.housing.takes_any_direction(),
        }
    }

    /// The same, if anything changes in time.
    pub fn varying_duty(&self) -> Option<Duty> {
        self.operation.varies().then(|| self.duty())
    }

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
            let (s, c) = libm::sincos(angle.to_radians());
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

/// A field over time, which a profile may vary.
fn course(field: f64, profile: Option<&ProfileScene>) -> Course {
    match profile {
        None | Some(ProfileScene::Table(_)) => Course::Constant(field),
        Some(ProfileScene::Ramp(ramp)) => {
            Course::lines(&[(1e-3 * ramp.from_ms, field), (1e-3 * ramp.to_ms, ramp.to)])
        }
        Some(ProfileScene::Harmonic(sine)) => Course::Harmonic {
            mean: field,
            amplitude: sine.amplitude,
            omega: std::f64::consts::TAU * sine.hz,
            phase: sine.phase_deg.to_radians(),
        },
        Some(ProfileScene::Points(points)) if points.is_empty() => Course::Constant(field),
        Some(ProfileScene::Points(points)) => {
            Course::lines(&points.iter().map(|(ms, value)| (1e-3 * ms, *value)).collect::<Vec<_>>())
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    /// Sums of some thousand numbers.
    const ROUNDING: f64 = 1e-12;

    fn with(set: &[&str]) -> Duty {
        Scene::default().with_overrides(set).expect("a valid scene").duty()
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
    fn by_hand_a_load_that_turns_with_the_shaft_comes_once_a_turn() {
        let duty = with(&["operation.rotating_load=(force_n: 2000, angle_deg: 270)"]);
        // Downwards at the start, upwards half a turn later, which 500 rpm make in 60 ms.
        close(duty.load_n(0.0), 52_000.0);
        close(duty.load_n(0.06), 48_000.0);
        close(duty.load_n(0.12), 52_000.0);
        assert_eq!(duty.load_range_n(1.0), [48_000.0, 52_000.0]);
        assert_eq!((duty.mean_load_n(1.0), duty.mean_speeds_rpm(1.0)), (50_000.0, [500.0, 0.0]));
    }

    #[test]
    fn by_hand_a_shaft_that_turns_back_has_no_time_for_its_turns() {
        let set =
            ["operation.speed_rpm=-500", "operation.speed_profile=ramp(from_ms: 0, to_ms: 100, to: 500)"];
        let duty = with(&set);
        assert!(!duty.is_one_way(0.1) && duty.is_one_way(0.05));
        close(duty.mean_speeds_rpm(0.1)[0], 250.0);
        assert_eq!(duty.slowest_rpm(0.1), 0.0);
        let constant = Scene::default().duty();
        assert_eq!(Scene::default().varying_duty(), None);
        assert_eq!((constant.speed_rpm(0.3), constant.load_n(0.3)), (500.0, 50_000.0));
        assert_eq!(constant.time_of_turns(5.0, 0.1), None);
    }

    #[test]
    fn by_hand_rings_that_both_change_their_speed() {
        const RIGID: &str = "housing=rigid()";
        // The shaft from 500 to 1500 rpm in 20 ms, the outer ring at −100 rpm: turns against it are the area
        // between the two.
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
        // Both change, and their difference turns between the corners of either: 500 + 100 sin(2π 5 t)
        // against a ramp of 5 rpm/ms. Its derivative, 1000π cos(10πt) − 5000, never vanishes: it falls from
        // 500 to −500 at 200 ms.
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
