//! Where a run stops: the limits of the scene, with the words of the program.
//!
//! The program's own stand in `stribeck-simulation`, which read scenes and files and so
//! are not in a page; `issue_a_run_that_stops_says_what_the_program_says` holds both beside each other.

use serde::{Deserialize, Serialize};
use stribeck_reduced::motion::{BearingInMotion, Energies};

/// Limits of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Limits {
    /// Imbalance over the most that rings and contacts have stored [%].
    pub energy_percent: f64,
    /// Penetration over the size of an element [%].
    pub penetration_percent: f64,
    /// Size of an element [m].
    pub element_size: f64,
    /// Smallest and largest distance of a roller's centre from that of the outer ring [m].
    pub annulus: [f64; 2],
    /// Numbers of the rollers in the scene, from 1.
    pub numbers: Vec<usize>,
    /// Radius of a roller [m].
    pub roller_radius: f64,
    /// Offset at which the cage has cut through a ring, if there is a cage, and the one at which it touches
    /// [m]; the latter is infinite where its dimensions leave it no room from the start.
    pub cage: Option<[f64; 2]>,
    /// What else holds the cage, in words.
    pub holds_cage: String,
}

/// Why a run stops, in words.
#[derive(Debug, Clone, PartialEq)]
pub enum Stop {
    /// It has diverged.
    Diverged(String),
    /// Its cage has moved to where the model has nothing that guides it.
    CageLeft(String),
}

/// Besides its share of the stored energy a divergence exceeds these shares of the heat and of the kinetic
/// energy.
const OF_HEAT: f64 = 0.01;
const OF_MOTION: f64 = 1e-6;

/// A cage that strays by more than this share of a roller's radius is not held by its pockets.
const ASTRAY: f64 = 0.1;

impl Limits {
    /// Why a run stops, if it does: at energies whose imbalance is `imbalance` [J] where rings and contacts
    /// have stored `most_stored` [J] at most.
    pub(crate) fn reason(
        &self,
        motion: &BearingInMotion,
        energies: &Energies,
        [imbalance, most_stored]: [f64; 2],
    ) -> Option<Stop> {
        self.energy(motion, energies, [imbalance.abs(), most_stored])
            .or_else(|| self.penetration(motion))
            .or_else(|| self.rollers(motion))
            .map(Stop::Diverged)
            .or_else(|| self.cage(motion).map(Stop::CageLeft))
    }

    fn energy(&self, motion: &BearingInMotion, e: &Energies, [off, most_stored]: [f64; 2]) -> Option<String> {
        let over = |energy: f64| off / energy.max(f64::MIN_POSITIVE);
        let of_heat = over(e.friction + e.damping + e.contact_damping + e.film);
        let percent = 100.0 * over(most_stored);
        let apart = percent > self.energy_percent && of_heat > OF_HEAT && over(e.kinetic) > OF_MOTION;
        if !apart && !percent.is_nan() && !of_heat.is_nan() {
            return None;
        }
        let share = match 100.0 * of_heat {
            percent if percent < 0.1 => format!("{percent:.3} % of all heat"),
            percent if percent < 100.0 => format!("{percent:.1} % of all heat"),
            _ => "more than all heat".to_owned(),
        };
        Some(format!(
            "energy is off by {percent:.3} % of the most that rings and contacts have stored and {share} {}. \
             {}",
            when(motion),
            self.advice(motion)
        ))
    }

    fn advice(&self, motion: &BearingInMotion) -> String {
        let astray = motion.cage_offset().map_or(0.0, |[x, y]| x.hypot(y));
        if astray > ASTRAY * self.roller_radius {
            return format!(
                "The cage has strayed by {:.2} mm, and a wall of a pocket that goes past the middle of its \
                 roller lets go of it all at once. Nothing holds it there: take {}",
                1e3 * astray,
                self.holds_cage
            );
        }
        "Take a smaller `model.step_us`, a larger `model.modes_khz`, or `model: full` to see which of the \
         two models is wrong"
            .to_owned()
    }

    fn penetration(&self, motion: &BearingInMotion) -> Option<String> {
        let share = motion.deepest() / self.element_size;
        (share > 0.01 * self.penetration_percent).then(|| {
            format!(
                "the penetration of a contact has reached {:.0} % of an element's size {}: take a larger `contact.penalty_scale` or \
                 less `operation.load_n`",
                100.0 * share,
                when(motion)
            )
        })
    }

    fn rollers(&self, motion: &BearingInMotion) -> Option<String> {
        self.numbers.iter().zip(motion.rollers()).find_map(|(number, roller)| {
            let radius = roller.centre[0].hypot(roller.centre[1]);
            // A place that is no number lies in no range either.
            (!(self.annulus[0]..=self.annulus[1]).contains(&radius)).then(|| {
                let through = if radius < self.annulus[0] { "inner" } else { "outer" };
                format!(
                    "roller {number} has gone through the {through} raceway: its centre is {:.3} mm from \
                     that of the outer ring {}. Take a larger `contact.penalty_scale`, less `operation.load_n` or a \
                     smaller `model.step_us`",
                    1e3 * radius,
                    when(motion)
                )
            })
        })
    }

    fn cage(&self, motion: &BearingInMotion) -> Option<String> {
        let [stop, touches] = self.cage?;
        let off = motion.cage_offset().map(|[x, y]| x.hypot(y))?;
        (off > stop).then(|| {
            let room = if touches.is_finite() { format!("{:.2}", 1e3 * touches) } else { "no".to_owned() };
            format!(
                "the cage has cut through a ring: its centre is {:.2} mm from that of the outer ring {}, \
                 and between the raceways it has {room} mm of room. Nothing holds it there: take {}",
                1e3 * off,
                when(motion),
                self.holds_cage
            )
        })
    }
}

fn when(motion: &BearingInMotion) -> String {
    format!("at step {}, t = {:.5} ms", motion.steps(), 1e3 * motion.time())
}
