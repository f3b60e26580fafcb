//! Measured speeds of cage and rollers, beside rolling without slip.

use std::borrow::Cow;
use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use stribeck_theory::kinematics::Kinematics;

use crate::record::{Record, Roller};
use stribeck_diagnosis::quantities;

/// A roller counts as loaded when its mean force exceeds this fraction of the largest mean.
const LOADED: f64 = 0.05;

quantities! {
    /// Measured frequencies [Hz], each beside the value for rolling without slip. All positive.
    #[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
    pub struct KinematicsFinding {
        /// Shaft.
        pub shaft_hz: f64,
        /// Outer ring; zero where it stands still.
        #[serde(default)]
        pub outer_ring_hz: f64,
        /// The rings against each other.
        #[serde(default)]
        pub relative_hz: f64,
        /// Cage; without one, the mean orbital frequency of the rollers.
        pub cage_hz: Option<f64> => "speed of the cage" at 8,
        /// Cage, no slip (fundamental train frequency).
        pub expected_cage_hz: f64,
        /// Cage as seen from the outer ring, measured and without slip.
        #[serde(default)]
        pub cage_on_outer_hz: [Option<f64>; 2],
        /// Number of pockets times the measured frequency of the cage as seen from the outer ring.
        pub bpfo_hz: Option<f64> => "BPFO of the recorded motion" at 7,
        /// Ball pass frequency of the outer raceway, no slip.
        pub expected_bpfo_hz: f64,
        /// Spin of a roller relative to the cage: mean over rollers and samples, weighted by the force of
        /// the outer raceway.
        pub roller_spin_hz: Option<f64> => "spin of loaded rollers" at 9,
        /// Spin of a roller relative to the cage, no slip.
        pub expected_roller_spin_hz: f64,
        /// Spin relative to the cage, mean of all rollers.
        pub roller_spin_all_hz: Option<f64>,
        /// Every roller.
        pub rollers: Vec<RollerMotion>,
    }
}

quantities! {
    /// Measured motion of one roller.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    pub struct RollerMotion {
        /// Number, from 1.
        pub roller: usize,
        /// Orbital frequency [Hz], positive.
        pub orbit_hz: f64,
        /// Spin relative to the cage [Hz], positive.
        pub spin_hz: f64,
        /// True when it carries load on average.
        pub loaded: bool,
    }
}

impl KinematicsFinding {
    /// Recorded over slip-free frequency of the facet line called `name`; `None` when that motion was not
    /// recorded.
    pub fn ratio(&self, name: &str) -> Option<f64> {
        let [cage, expected] = self.cage_on_outer_hz;
        let (cage, expected) = (cage?, expected?);
        let ratio = match name {
            "roller_vertices" => self.roller_spin_hz? / self.expected_roller_spin_hz,
            "outer_race_nodes" => cage / expected,
            "inner_race_nodes" => (self.relative_hz - cage) / (self.relative_hz - expected),
            _ => return None,
        };
        Some(ratio).filter(|r| r.is_finite())
    }
}

/// How rollers turn, one after the other.
#[derive(Debug)]
pub struct Turning<'a> {
    time_s: Cow<'a, [f64]>,
    /// By how much the outer ring is ahead of its mean speed at each time [rad], where its angle was
    /// recorded.
    ahead: Option<Vec<f64>>,
    /// Cage, where its angle was recorded [rad/s].
    guided: Option<f64>,
    rollers: Vec<Turned>,
    /// Spin [rad] and time [s], both weighted by the force of the outer raceway.
    under_load: [f64; 2],
}

/// How one of them does.
#[derive(Debug)]
struct Turned {
    number: usize,
    /// [rad/s]
    orbit: Option<f64>,
    /// [rad/s]
    spin: Option<f64>,
    /// Mean force of the outer raceway [N].
    load: f64,
}

impl<'a> Turning<'a> {
    /// Before the first roller of a record.
    pub fn new(record: &'a Record<'_>, expected: &Kinematics) -> Self {
        let time_s = clock(record, expected);
        let ahead = record.channel("outer_ring.angle_rad").map(|angle| {
            angle.iter().zip(&*time_s).map(|(angle, time)| angle - expected.outer_rad_s * time).collect()
        });
        let mut turning = Self { time_s, ahead, guided: None, rollers: Vec::new(), under_load: [0.0; 2] };
        let cage = record.channel("cage.angle_rad");
        turning.guided = cage.and_then(|angle| rate(&turning.time_s, &turning.steadied(angle)));
        turning
    }

    /// An angle as it would be if the outer ring had its mean speed: rollers and cage move relative to it.
    fn steadied<'b>(&self, angle: &'b [f64]) -> Cow<'b, [f64]> {
        match &self.ahead {
            Some(ahead) => angle.iter().zip(ahead).map(|(angle, ahead)| angle - ahead).collect(),
            None => Cow::Borrowed(angle),
        }
    }

    /// One roller more, with its orbital angle [rad] and the normal force of the outer raceway [N] at every
    /// sample.
    pub fn add(&mut self, roller: &Roller<'_>, orbit: &[f64], outer_normal: &[f64]) {
        let time = &self.time_s[..];
        let (orbit, spin) = (self.steadied(orbit), self.steadied(roller.spin));
        let turned = Turned {
            number: roller.number,
            orbit: rate(time, &orbit),
            spin: rate(time, &spin),
            load: mean(outer_normal.iter().copied()).unwrap_or(0.0),
        };
        self.rollers.push(turned);
        let [turned, weight] = &mut self.under_load;
        for n in 1..time.len() {
            let load = (outer_normal[n - 1] + outer_normal[n]).max(0.0);
            *turned += load * (spin[n] - spin[n - 1]);
            *weight += load * (time[n] - time[n - 1]);
        }
    }

    /// The recorded motion beside the one `expected` without slip; the cage has `pockets` pockets.
    pub fn finding(self, expected: &Kinematics, pockets: usize) -> KinematicsFinding {
        let rollers = &self.rollers;
        let cage = self.guided.or_else(|| mean(rollers.iter().filter_map(|r| r.orbit)));
        let largest = rollers.iter().map(|r| r.load).fold(0.0, f64::max);
        let motion = |roller: &Turned| {
            Some(RollerMotion {
                roller: roller.number,
                orbit_hz: roller.orbit?.abs() / TAU,
                spin_hz: (roller.spin? - cage?).abs() / TAU,
                loaded: roller.load > LOADED * largest,
            })
        };
        let motions: Vec<RollerMotion> = rollers.iter().filter_map(motion).collect();
        let [turned, weight] = self.under_load;
        let spin_under_load = (weight > 0.0).then(|| turned / weight);
        let on_outer = cage.map(|rate| (rate - expected.outer_rad_s).abs() / TAU);
        KinematicsFinding {
            shaft_hz: expected.shaft_hz,
            cage_hz: cage.map(|rate| rate.abs() / TAU),
            expected_cage_hz: expected.cage_hz,
            bpfo_hz: on_outer.filter(|_| !rollers.is_empty()).map(|hz| hz * pockets as f64),
            cage_on_outer_hz: [on_outer, Some(expected.cage_on_outer_hz)],
            outer_ring_hz: expected.outer_ring_hz,
            relative_hz: relative_hz(expected),
            expected_bpfo_hz: expected.bpfo_hz,
            roller_spin_hz: spin_under_load.zip(cage).map(|(s, c)| (s - c).abs() / TAU),
            expected_roller_spin_hz: expected.roller_spin_hz,
            roller_spin_all_hz: mean(motions.iter().map(|m| m.spin_hz)),
            rollers: motions,
        }
    }
}

impl KinematicsFinding {
    /// Places for rollers in the cage, from which rollers pass a raceway; not a number for a bearing that
    /// rests.
    pub(crate) fn pockets(&self) -> f64 {
        let [_, cage_hz] = self.cage_on_outer_hz;
        (self.expected_bpfo_hz / cage_hz.unwrap_or(f64::NAN)).round()
    }
}

/// Times [s], or, where the angle of the shaft was recorded, the times at which rings of constant speed would
/// have had the same relative angle: rates then refer to that speed.
fn clock<'a>(record: &'a Record<'_>, expected: &Kinematics) -> Cow<'a, [f64]> {
    let against = expected.shaft_rad_s - expected.outer_rad_s;
    match record.relative_angle() {
        Some(angle) if against != 0.0 => angle.iter().map(|rad| rad / against).collect(),
        _ => Cow::Borrowed(record.time_s()),
    }
}

/// Rate [rad/s] of the straight line of least squares through `angle` [rad]; `None` for fewer than two times.
pub fn rate(time_s: &[f64], angle: &[f64]) -> Option<f64> {
    let (t0, a0) = (mean(time_s.iter().copied())?, mean(angle.iter().copied())?);
    let (mut moment, mut spread) = (0.0, 0.0);
    for (t, a) in time_s.iter().zip(angle) {
        moment += (t - t0) * (a - a0);
        spread += (t - t0) * (t - t0);
    }
    (spread > 0.0).then(|| moment / spread)
}

/// The rings against each other [Hz], positive.
pub(crate) fn relative_hz(expected: &Kinematics) -> f64 {
    (expected.shaft_rad_s - expected.outer_rad_s).abs() / TAU
}

/// Arithmetic mean; `None` of nothing.
pub(crate) fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (sum, count) = values.fold((0.0, 0usize), |(sum, count), v| (sum + v, count + 1));
    (count > 0).then(|| sum / count as f64)
}

#[cfg(test)]
mod tests {
    use stribeck_scene::scene::BearingScene;

    use super::*;

    #[test]
    fn by_hand_a_slow_cage_slows_the_outer_and_speeds_the_inner_line() {
        let motion = KinematicsFinding {
            relative_hz: 8.0,
            cage_on_outer_hz: [Some(3.9), Some(4.0)],
            ..KinematicsFinding::default()
        };
        assert!((motion.ratio("outer_race_nodes").unwrap() - 0.975).abs() < 1e-12);
        assert!((motion.ratio("inner_race_nodes").unwrap() - 1.025).abs() < 1e-12);
        assert_eq!((motion.ratio("roller_vertices"), motion.ratio("else")), (None, None));
    }

    #[test]
    fn by_hand_only_loaded_time_counts_for_the_spin() {
        // Loaded for the first half at 40 rad/s, free for the second, where it slows down.
        let time: Vec<f64> = (0..=100).map(|n| 0.01 * f64::from(n)).collect();
        let spin: Vec<f64> =
            time.iter().map(|t| if *t < 0.5 { 40.0 * t } else { 20.0 + 10.0 * (t - 0.5) }).collect();
        let force: Vec<f64> = time.iter().map(|t| if *t < 0.499 { -7.0 } else { 0.0 }).collect();
        let (one, none) = (vec![1.0; 101], vec![0.0; 101]);
        let roller = Roller {
            number: 1,
            x: &one,
            y: &none,
            spin: &spin,
            outer_fx: &force,
            outer_fy: &none,
            inner_fx: &none,
            inner_fy: &none,
            films: None,
        };
        let turning = || Turning {
            time_s: Cow::Borrowed(&time),
            ahead: None,
            guided: Some(0.0),
            rollers: Vec::new(),
            under_load: [0.0; 2],
        };
        let expected = Kinematics::new(&BearingScene::default(), 60.0);
        let mut one = turning();
        one.add(&roller, &none, &roller.outer_normal());
        let found_hz = one.finding(&expected, 24).roller_spin_hz.unwrap();
        assert!((TAU * found_hz - 40.0).abs() < 1e-9, "{found_hz}");
        assert_eq!(turning().finding(&expected, 24).roller_spin_hz, None);
    }

    #[test]
    fn planted_rate_of_a_wobbling_rotation() {
        // Whole wobbles leave the slope of least squares within 6A/(π N) of the mean rate over N wobbles.
        let time: Vec<f64> = (0..3000).map(|n| n as f64 * 1e-5).collect();
        let wobble = |t: f64| 1e-4 * (TAU * 1000.0 * t).sin();
        let angle: Vec<f64> = time.iter().map(|t| 1.0 - 23.585 * t + wobble(*t)).collect();
        let found = rate(&time, &angle).unwrap();
        assert!((found + 23.585).abs() < 23.585e-3, "{found}");
        assert_eq!(rate(&[0.0], &[1.0]), None);
        assert_eq!(rate(&[], &[]), None);
    }
}
