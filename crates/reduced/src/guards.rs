//! What is watched of a reduced run: energy, penetration, support and places, with the limits of the scene.

use std::fmt::{self, Display, Formatter};

use stribeck_scene::{
    advice,
    geometry::Geometry,
    run_info::RunInfo,
    scene::{GuardsScene, Scene},
};
use stribeck_system::Ledger;

use crate::{bearing::Bearing, state::State};

/// What the ledger of a run is off by.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct LedgerError {
    /// By how much [J], and what rings and contacts store now [J].
    imbalance: f64,
    stored: f64,
    /// Over the heat since the start.
    of_heat: f64,
    /// Over the energy of motion.
    of_motion: f64,
}

impl LedgerError {
    pub(crate) fn of(ledger: &Ledger) -> Self {
        let heat = ledger.friction + ledger.damping + ledger.contact_damping + ledger.film;
        let imbalance = ledger.imbalance.abs();
        Self {
            imbalance,
            stored: ledger.strain + ledger.contact,
            of_heat: imbalance / heat.max(f64::MIN_POSITIVE),
            of_motion: imbalance / ledger.kinetic.max(f64::MIN_POSITIVE),
        }
    }

    /// Its share of the most that rings and contacts have stored, which is `most` [J], in per cent. Rings in a rigid housing store next to
    /// nothing, contacts do.
    fn percent(&self, most: f64) -> f64 {
        100.0 * self.imbalance / most.max(f64::MIN_POSITIVE)
    }

    /// Whether the run has come apart, which is off by so many per cent of the most that rings and contacts have stored. One that turns
    /// energy into heat for seconds gathers the error of the time step, one or two thousandths of the heat, and in time exceeds any share
    /// of what is stored; under hardly any load that is some billionths of what is in motion. Neither is a divergence, which exceeds
    /// both other shares at once.
    fn is_divergence(&self, percent: f64, stop_percent: f64) -> bool {
        let apart = percent > stop_percent && self.of_heat > GATHERED && self.of_motion > OF_MOTION;
        apart || percent.is_nan() || self.of_heat.is_nan()
    }

    /// Its share of the heat, in words.
    fn share_of_heat(&self) -> String {
        match 100.0 * self.of_heat {
            percent if percent < 0.1 => format!("{percent:.3} % of all heat"),
            percent if percent < 100.0 => format!("{percent:.1} % of all heat"),
            // A bearing without friction and damping makes no heat to speak of.
            _ => "more than all heat".to_owned(),
        }
    }
}

/// What a run that diverges exceeds: shares of the heat and of the energy of motion.
const GATHERED: f64 = 0.01;
const OF_MOTION: f64 = 1e-6;

/// With fewer modes in a seat none may be among them in which the ring bends: two or three are motions of the whole.
const FEW_MODES: usize = 5;

/// A cage that strays by more than this share of a roller's radius is not held by its pockets.
const ASTRAY: f64 = 0.1;

/// Rollers may leave their annulus by this share of a roller's radius.
const OUT_OF_PLACE: f64 = 0.5;

/// A roller carries something above this share of the load.
const CARRIES: f64 = 1e-3;

/// When something was seen. It is written for few of the samples that are looked at.
struct When {
    step: u64,
    /// [s]
    time: f64,
}

impl Display for When {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "at step {}, t = {:.5} ms", self.step, 1e3 * self.time)
    }
}

/// The limits of one run.
#[derive(Debug, Clone)]
pub(crate) struct Guards {
    limits: GuardsScene,
    element_size: f64,
    /// Numbers of the rollers, from 1.
    numbers: Vec<usize>,
    /// Nearest and farthest place of a roller's centre from the bearing's [m].
    annulus: [f64; 2],
    /// How far the cage's centre may be from it [m].
    pitch_radius: f64,
    roller_radius: f64,
    /// What holds a cage.
    holds_cage: String,
}

impl Guards {
    pub(crate) fn new(scene: &Scene) -> Self {
        let g = Geometry::of(scene);
        let slack = OUT_OF_PLACE * g.roller_radius;
        let depth = scene.spalls().iter().map(|d| 1e-3 * d.depth_mm).fold(0.0, f64::max);
        Self {
            limits: scene.guards.clone(),
            element_size: g.element_size,
            numbers: scene.rollers_in_place().collect(),
            annulus: [
                g.inner_race_radius + g.roller_radius - slack,
                g.outer_race_radius - g.roller_radius + depth + slack,
            ],
            pitch_radius: 0.5 * (g.inner_race_radius + g.outer_race_radius),
            roller_radius: g.roller_radius,
            holds_cage: advice::holds_cage(scene),
        }
    }

    /// What is worth a word before the first step.
    pub(crate) fn before(scene: &Scene, bearing: &Bearing) -> Vec<String> {
        let mut warnings = Vec::new();
        let modes = bearing.reduction.modes;
        if bearing.seat.is_some() && modes < FEW_MODES {
            warnings.push(format!(
                "only {modes} modes of ring and housing lie below `model.modes_khz`, and the ring may bend in none of them: such runs find no \
                 start or gain energy with steps of any length. Take a larger `model.modes_khz`"
            ));
        }
        if scene.output.frames.is_some() {
            warnings.push(
                "no pictures of the stress: the reduced model has no elements beside its modes. `model: full` has them".to_owned(),
            );
        }
        warnings
    }

    /// Looks at a state after a sample, what its energy is off by and the deepest penetration [m].
    pub(crate) fn look(
        &self,
        info: &mut RunInfo,
        state: &State,
        off: LedgerError,
        deepest: f64,
    ) -> Option<String> {
        let when = When { step: info.steps, time: info.steps as f64 * info.time_step_s };
        let limits = &self.limits;
        info.guards.stored_j = info.guards.stored_j.max(off.stored);
        let percent = off.percent(info.guards.stored_j);
        if off.is_divergence(percent, limits.energy_stop_percent) {
            return Some(format!(
                "energy is off by {percent:.3} % of the most that rings and contacts have stored and {} {when}. {}",
                off.share_of_heat(),
                self.advice(state)
            ));
        }
        if percent > limits.energy_warning_percent && !info.guards.energy_warned {
            info.guards.energy_warned = true;
            info.warnings.push(format!(
                "energy was off by {percent:.3} % of the most that rings and contacts have stored and {} {when}: take a smaller `model.step_us`",
                off.share_of_heat()
            ));
        }
        self.penetration(info, deepest, &when).or_else(|| {
            self.support(info, state, &when);
            self.places(state, &when)
        })
    }

    /// What may help a run that has come apart.
    fn advice(&self, state: &State) -> String {
        let astray = state.cage[0].hypot(state.cage[1]);
        if astray > ASTRAY * self.roller_radius {
            return format!(
                "The cage has strayed by {:.2} mm, and a wall of a pocket that goes past the middle of its roller lets go of it all at once. \
                 Nothing holds it there: take {}",
                1e3 * astray,
                self.holds_cage
            );
        }
        "Take a smaller `model.step_us`, a larger `model.modes_khz`, or `model: full` to see which of the two models is wrong".to_owned()
    }

    fn penetration(&self, info: &mut RunInfo, deepest: f64, when: &When) -> Option<String> {
        let share = deepest / self.element_size;
        let before = info.guards.penetration_share;
        info.guards.penetration_share = before.max(share);
        let [warning, stop] =
            [self.limits.penetration_warning_percent, self.limits.penetration_stop_percent].map(|p| 0.01 * p);
        if share > warning && before <= warning {
            info.warnings.push(format!(
                "contact has sunk in by {:.1} % of an element {when}: take a larger `contact.penalty_scale`",
                100.0 * share
            ));
        }
        (share > stop).then(|| {
            format!(
                "contact has sunk in by {:.0} % of an element {when}: take a larger `contact.penalty_scale` or less `operation.load_n`",
                100.0 * share
            )
        })
    }

    fn support(&self, info: &mut RunInfo, state: &State, when: &When) {
        let enough = CARRIES * info.expected_support_n;
        let by_oil = state.films.as_ref().is_some_and(|films| films.carry(enough));
        let carried = by_oil || state.force[0].iter().any(|&force| force > enough);
        let unsupported = 1e-3 * self.limits.unsupported_warning_ms;
        let seen = &mut info.guards;
        seen.unsupported_samples = if carried { 0 } else { seen.unsupported_samples + 1 };
        let time = seen.unsupported_samples as f64 * info.interval_s;
        let is_new = time > unsupported && seen.longest_unsupported_s <= unsupported;
        seen.longest_unsupported_s = seen.longest_unsupported_s.max(time);
        if is_new {
            info.warnings.push(format!(
                "no roller has carried anything for {:.2} ms {when}: the load hangs in the air. Look at `bearing` for a clearance that \
                 the load cannot close",
                1e3 * time
            ));
        }
    }

    fn places(&self, state: &State, when: &When) -> Option<String> {
        let squares = self.annulus.map(|radius| radius * radius);
        for (number, (x, y)) in self.numbers.iter().zip(state.x.iter().zip(&state.y)) {
            if !(squares[0]..=squares[1]).contains(&(x * x + y * y)) {
                let radius = x.hypot(*y);
                let through = if radius < self.annulus[0] { "inner" } else { "outer" };
                return Some(format!(
                    "roller {number} has gone through the {through} raceway: its centre is {:.3} mm from that of the bearing {when}. Take a larger \
                     `contact.penalty_scale`, less `operation.load_n` or a smaller `model.step_us`",
                    1e3 * radius
                ));
            }
        }
        let off = state.cage[0].hypot(state.cage[1]);
        (off > self.pitch_radius).then(|| {
            format!(
                "the cage has left the bearing: its centre is {:.1} mm from that of the bearing {when}. Nothing holds it there: take {}",
                1e3 * off,
                self.holds_cage
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ledger that is off by so many joules, beside heat and energy of motion.
    fn off([imbalance, heat, kinetic]: [f64; 3]) -> LedgerError {
        LedgerError::of(&Ledger { imbalance, kinetic, friction: heat, ..Ledger::default() })
    }

    #[test]
    fn issue_what_gathers_and_what_hardly_any_load_leaves_is_no_divergence() {
        for (numbers, stored, apart) in [
            // A ledger that runs away, before there is any heat to speak of.
            ([0.05, 1e-3, 0.1], 0.1, true),
            // Seconds at a light load: a thousandth of the heat, many times what rings and contacts store.
            ([0.37, 100.0, 0.1], 5e-3, false),
            // 1 N, 0.03 ms: half of what they store, hardly any heat yet.
            ([4e-10, 1e-11, 0.11], 7e-10, false),
            // 193 N in a rigid housing, 4 ms: a quarter of what the rings store, half a hundredth of what contacts do beside them.
            ([8.8e-6, 4.9e-4, 6.2], 1.6e-3, false),
            ([f64::NAN, 1.0, 1.0], 1.0, true),
        ] {
            let off = off(numbers);
            assert_eq!(off.is_divergence(off.percent(stored), 25.0), apart, "{numbers:?}");
        }
    }
}
