//! Guard rails: limits that are checked at every look, with warnings and stops.
//!
//! | watched | warning | stop |
//! |---|---|---|
//! | imbalance of energy; no number at all | `energy_warning_percent` | `energy_stop_percent` |
//! | hourglass over strain energy | `hourglass_warning_percent` | |
//! | penetration over element size | `penetration_warning_percent` | `penetration_stop_percent` |
//! | area of an element over its area at rest | | `area_stop_percent` |
//! | time step over the critical one as elements deform | above 1 | |
//!
//! A warning is given once, at the first check above its limit. [`Seen`] holds the warnings given so far and
//! is part of snapshots: a continued system warns as an uninterrupted one does.

use serde::{Deserialize, Serialize};

use crate::{ledger::Scale, system::System};

/// The critical time step is computed again each time the largest strain has grown by this much [-];
/// stretched by one per cent, elements are stiffer by one and a half.
const STRAIN_STEP: f64 = 0.01;

/// Strain energy below this share of its peak makes no hourglass share: noise over noise.
const STRAINED: f64 = 0.01;

/// Nor does strain energy below this share of the kinetic energy: that of a first touch, where the peak is no more
/// than itself.
const TOUCHED: f64 = 1e-6;

/// When to warn and when to stop.
#[derive(Debug, Clone, PartialEq)]
pub struct Limits {
    /// Reference of the imbalance of energy.
    pub energy_scale: Scale,
    /// Imbalance of energy above which there is a warning [%], over the heat where that is more than its
    /// reference.
    pub energy_warning_percent: f64,
    /// … and above which to stop [%].
    pub energy_stop_percent: f64,
    /// Hourglass energy over strain energy above which there is a warning [%].
    pub hourglass_warning_percent: f64,
    /// Penetration over the element size above which there is a warning [%].
    pub penetration_warning_percent: f64,
    /// … and above which to stop [%]; at 200 % contact takes a point for one on the far side of a body and
    /// opens.
    pub penetration_stop_percent: f64,
    /// Area of an element over its area at rest below which to stop [%].
    pub area_stop_percent: f64,
    /// The element size [m]; `None` takes the shortest facet of all contact surfaces.
    pub element_size: Option<f64>,
    /// Elements are checked, and a small imbalance is warned of, once in this many looks: checking all
    /// elements costs as much as two steps.
    pub elements_every: u64,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            energy_scale: Scale::TotalEnergy,
            energy_warning_percent: 1.0,
            energy_stop_percent: 25.0,
            hourglass_warning_percent: 10.0,
            penetration_warning_percent: 10.0,
            penetration_stop_percent: 100.0,
            area_stop_percent: 20.0,
            element_size: None,
            elements_every: 1,
        }
    }
}

/// The user's names for the fields in messages.
#[derive(Debug, Clone, PartialEq)]
pub struct Words {
    /// Time step over the critical one.
    pub time_step_factor: &'static str,
    /// Penalty stiffness of contact.
    pub penalty: &'static str,
    /// Size of elements.
    pub element_size: &'static str,
    /// Scale of the hourglass stiffness.
    pub hourglass_scale: &'static str,
    /// Out-of-plane thickness.
    pub thickness: &'static str,
    /// The load.
    pub load: &'static str,
    /// Follows "start".
    pub preloaded: &'static str,
}

impl Default for Words {
    fn default() -> Self {
        Self {
            time_step_factor: "time step factor",
            penalty: "penalty stiffness",
            element_size: "element size",
            hourglass_scale: "hourglass scale",
            thickness: "thickness",
            load: "load",
            preloaded: "from equilibrium",
        }
    }
}

/// Extremes of all looks.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Seen {
    /// Looks so far.
    pub looks: u64,
    /// The imbalance of energy has been warned of.
    pub energy_warned: bool,
    /// Largest hourglass energy over strain energy [-].
    pub hourglass_share: f64,
    /// Deepest penetration over the element size [-].
    pub penetration_share: f64,
    /// Least area of an element over its area at rest [-]; infinite before it was looked at.
    pub least_area: f64,
    /// Largest strain for which the critical time step has been computed again [-].
    pub strain_checked: f64,
}

impl Default for Seen {
    fn default() -> Self {
        Self {
            looks: 0,
            energy_warned: false,
            hourglass_share: 0.0,
            penetration_share: 0.0,
            least_area: f64::INFINITY,
            strain_checked: 0.0,
        }
    }
}

/// Quantities under guard.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Watched {
    /// The balance of energy, and that all numbers are numbers.
    Energy,
    /// Energy in the hourglass stiffness.
    Hourglass,
    /// Penetration of contact surfaces.
    Penetration,
    /// The area of elements.
    Distortion,
    /// The time step of the deformed mesh.
    TimeStep,
}

/// Something beyond its limit.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// Quantity.
    pub watched: Watched,
    /// Whether to go on would be of no use.
    pub stops: bool,
    /// Message: value, time, place and remedy.
    pub message: String,
}

impl std::fmt::Display for Finding {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.message)
    }
}

impl System {
    /// Checks the ledger of [`System::step_with_ledger`]: returns the quantities beyond their limits, in the
    /// order of the table above. Every guard is evaluated, so that the worst of each is known.
    pub fn look(&mut self) -> Vec<Finding> {
        let mut seen = *self.seen();
        seen.looks += 1;
        let found = [
            self.look_at_energy(&mut seen),
            self.look_at_hourglass(&mut seen),
            self.look_at_penetration(&mut seen),
            self.look_at_elements(&mut seen),
        ];
        self.seen = seen;
        found.into_iter().flatten().collect()
    }

    fn look_at_energy(&self, seen: &mut Seen) -> Option<Finding> {
        let Limits { energy_scale, energy_warning_percent, energy_stop_percent, elements_every, .. } =
            self.limits;
        let [warning, stop] = [energy_warning_percent, energy_stop_percent].map(|p| 0.01 * p);
        let (error, over, words) = (self.last_ledger().relative_error, energy_scale.words(), &self.words);
        let (time_step_factor, penalty, when) = (words.time_step_factor, words.penalty, self.when());
        let found = |stops, message| Some(Finding { watched: Watched::Energy, stops, message });
        if error > stop {
            let what = if error.is_finite() {
                format!(
                    "energy is out of balance by {:.1} % of the {over} (limit {energy_stop_percent} %)",
                    100.0 * error
                )
            } else {
                "a position or a velocity is no number any more".to_owned()
            };
            return found(
                true,
                format!(
                    "{what} {when}; the fastest node is {}. Try a smaller {time_step_factor}, a smaller \
                     {penalty}, or look for bodies that overlap",
                    self.fastest()
                ),
            );
        }
        // A load that comes suddenly is soon larger than the energy of the first looks.
        // Relative to the larger of both: over a long run the heat grows beyond any constant limit.
        if error.min(self.of_heat()) > warning
            && !seen.energy_warned
            && seen.looks.is_multiple_of(elements_every.max(1))
        {
            seen.energy_warned = true;
            return found(
                false,
                format!(
                    "energy is out of balance by {:.2} % of the {over} (limit {energy_warning_percent} %){} \
                     {when}: take a smaller {time_step_factor}, a smaller {penalty}, or start {}",
                    100.0 * error,
                    self.share_of_heat(),
                    words.preloaded
                ),
            );
        }
        None
    }

    /// Heat so far [J].
    fn heat(&self) -> f64 {
        let ledger = self.last_ledger();
        ledger.friction + ledger.damping + ledger.contact_damping + ledger.film
    }

    /// The imbalance over the heat [-]; infinite where there is none.
    fn of_heat(&self) -> f64 {
        if self.heat() > 0.0 { self.last_ledger().imbalance.abs() / self.heat() } else { f64::INFINITY }
    }

    /// The imbalance as a share of the heat, in words, where that is more than was ever stored as strain.
    ///
    /// Fast bodies that slide or shear oil turn much more energy into heat than they store, and the error of
    /// the time step grows with it.
    fn share_of_heat(&self) -> String {
        let times = self.heat() / self.balance().peak_strain;
        if times <= 1.0 {
            return String::new();
        }
        let share = 100.0 * self.of_heat();
        format!(", {share:.3} % of the heat, which has grown to {times:.1} times what is stored,")
    }

    fn look_at_hourglass(&self, seen: &mut Seen) -> Option<Finding> {
        let (ledger, limit) = (self.last_ledger(), self.limits.hourglass_warning_percent);
        let least = (STRAINED * self.balance().peak_strain).max(TOUCHED * ledger.kinetic);
        if ledger.strain.is_nan() || ledger.strain <= least {
            return None;
        }
        let share = ledger.hourglass / ledger.strain;
        let is_new = passes(share, &mut seen.hourglass_share, 0.01 * limit);
        is_new.then(|| Finding {
            watched: Watched::Hourglass,
            stops: false,
            message: format!(
                "hourglass energy is {:.1} % of the strain energy (limit {limit} %) {}: elements bend more \
                 than they stretch. Take a smaller {}, or another {}",
                100.0 * share,
                self.when(),
                self.words.element_size,
                self.words.hourglass_scale
            ),
        })
    }

    fn look_at_penetration(&self, seen: &mut Seen) -> Option<Finding> {
        let deepest = self.resultants().enumerate().map(|(pair, r)| (pair, r.penetration)).max_by(|a, b| {
            // The first of equals.
            a.1.total_cmp(&b.1).then(b.0.cmp(&a.0))
        });
        let (pair, depth) = deepest?;
        let share = depth / self.limits.element_size.unwrap_or(self.shortest_facet);
        let Limits { penetration_warning_percent, penetration_stop_percent, .. } = self.limits;
        let is_new = passes(share, &mut seen.penetration_share, 0.01 * penetration_warning_percent);
        let stops = share > 0.01 * penetration_stop_percent;
        let limit = if stops { penetration_stop_percent } else { penetration_warning_percent };
        (stops || is_new).then(|| Finding {
            watched: Watched::Penetration,
            stops,
            message: format!(
                "{} penetrate each other by {:.1} µm, {:.0} % of the element size (limit {limit} %) {}: take \
                 a larger {}, a larger {} or less {}",
                self.pairs[pair],
                1e6 * depth,
                100.0 * share,
                self.when(),
                self.words.penalty,
                self.words.thickness,
                self.words.load
            ),
        })
    }

    fn look_at_elements(&self, seen: &mut Seen) -> Option<Finding> {
        if !seen.looks.is_multiple_of(self.limits.elements_every.max(1)) {
            return None;
        }
        let (now, words) = (self.dynamics.distortion(), &self.words);
        seen.least_area = seen.least_area.min(now.least_area);
        if now.least_area < 0.01 * self.limits.area_stop_percent {
            let message = format!(
                "an element at x = {:.3} mm, y = {:.3} mm has {:.1} % of its area left (limit {} %) {}: it \
                 is about to turn inside out, beyond what a linear material means. Take less {}, a larger \
                 {}, or start {}",
                1e3 * now.place[0],
                1e3 * now.place[1],
                100.0 * now.least_area,
                self.limits.area_stop_percent,
                self.when(),
                words.load,
                words.thickness,
                words.preloaded
            );
            return Some(Finding { watched: Watched::Distortion, stops: true, message });
        }
        let strain = (now.largest_stretch - 1.0).max(1.0 - now.least_area);
        if strain <= seen.strain_checked + STRAIN_STEP {
            return None;
        }
        seen.strain_checked = strain;
        let (step, critical) = (self.time_step(), self.critical_time_step());
        (step > critical).then(|| {
            let advice = match self.reference_time_step {
                Some(first) => format!("take a {} below {:.2}", words.time_step_factor, critical / first),
                None => "take a smaller one".to_owned(),
            };
            Finding {
                watched: Watched::TimeStep,
                stops: false,
                message: format!(
                    "the time step of {:.3} ns is above the critical one of the deformed mesh, {:.3} ns, {}: \
                     {advice}",
                    1e9 * step,
                    1e9 * critical,
                    self.when()
                ),
            }
        })
    }

    fn when(&self) -> String {
        format!("at step {}, t = {:.5} ms", self.steps(), 1e3 * self.time())
    }

    /// Where the fastest node is; one whose velocity is no number is faster than all others.
    fn fastest(&self) -> String {
        let (node, speed) = self.fastest_node();
        let [x, y] = self.position(node);
        format!(
            "in the {} at x = {:.3} mm, y = {:.3} mm with {speed:.3e} m/s",
            self.body_of(node),
            1e3 * x,
            1e3 * y
        )
    }
}

/// Notes the largest value so far; true when it is the first above `limit`.
fn passes(value: f64, largest: &mut f64, limit: f64) -> bool {
    let first = value > limit && *largest <= limit;
    *largest = largest.max(value);
    first
}
