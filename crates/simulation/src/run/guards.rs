//! Guards of a bearing: quantities checked at every sample, with limits for warnings and limits at which a
//! run stops.
//!
//! | watched | warning | stop |
//! |---|---|---|
//! | penetration over the bearing's own deflection | above 1 | |
//! | time without a loaded roller | `unsupported_warning_ms` | |
//! | rollers out of the space between the raceways | | [`OUT_OF_PLACE`] |
//! | the cage's offset over its clearance to the raceways | above 1 | a cage's thickness beyond |
//!
//! The fields are those of `guards` in the scene. Energy, penetration over element size and other limits that
//! depend on the model are watched by the model. A warning is issued once, at the first sample above its
//! limit. The extremes so far are kept in checkpoints and in
//! [`GuardInfo`](stribeck_store::run_info::GuardInfo): a continued run warns as an unbroken one does.

mod softness;

use std::fmt::{self, Display, Formatter};

use stribeck_scene::{advice, resolved::ResolvedScene};
use stribeck_store::run_info::{RunInfo, Topic};

use softness::Softness;

/// Rollers may leave the space between the raceways, and a housing the outer ring, by this share of a
/// roller's radius.
pub const OUT_OF_PLACE: f64 = 0.5;

/// A roller carries something above this share of the load.
const CARRIES: f64 = 1e-3;

/// Positions of rollers and cage at a sample, and the largest load.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Placed {
    /// Centres of the rollers, in the order of the scene, from that of the outer ring [m].
    pub centres: Vec<[f64; 2]>,
    /// Largest force of the outer raceway on a roller, by contact or oil [N].
    pub carries: f64,
    /// Centre of the cage from that of the outer ring [m], if there is a cage.
    pub cage: Option<[f64; 2]>,
    /// Deepest penetration so far over the element size [-].
    pub penetration_share: f64,
}

/// The limits of one run.
#[derive(Debug, Clone)]
pub struct Guards {
    /// Numbers of the rollers, from 1.
    numbers: Vec<usize>,
    /// Time without support above which there is a warning [s].
    unsupported: f64,
    element_size: f64,
    soft: Softness,
    /// Smallest and largest distance of a roller's centre from that of the outer ring [m].
    annulus: [f64; 2],
    cage: Option<CageRoom>,
    /// What guides the cage in this scene, in words.
    holds_cage: String,
    /// The field that shortens the time step, as messages name it.
    step_field: &'static str,
}

/// How far a cage may move between the raceways, with which the models have no contact of it.
#[derive(Debug, Clone, Copy)]
struct CageRoom {
    /// Until it touches a raceway [m]; infinite where its dimensions leave it no room from the start.
    warning: f64,
    /// Until its whole thickness lies in a ring [m]; the pitch radius at most.
    stop: f64,
}

impl CageRoom {
    fn of(scene: &ResolvedScene) -> Option<Self> {
        let cage = scene.cage.as_ref()?;
        let inside = cage.outer_radius - cage.thickness - scene.inner_race_radius;
        let room = (scene.outer_race_radius - cage.outer_radius).min(inside);
        let pitch_radius = 0.5 * (scene.inner_race_radius + scene.outer_race_radius);
        Some(if room > 0.0 {
            Self { warning: room, stop: (room + cage.thickness).min(pitch_radius) }
        } else {
            Self { warning: f64::INFINITY, stop: pitch_radius }
        })
    }
}

impl Guards {
    /// The limits of a scene; `step_field` is the field that shortens the time step of its model.
    pub fn new(scene: &ResolvedScene, step_field: &'static str) -> Self {
        let radius = scene.roller_radius;
        let depth = scene.written.spalls().iter().map(|d| 1e-3 * d.depth_mm).fold(0.0, f64::max);
        let slack = OUT_OF_PLACE * radius;
        Self {
            numbers: scene.written.rollers_in_place().collect(),
            unsupported: 1e-3 * scene.written.guards.unsupported_warning_ms,
            element_size: scene.element_size,
            soft: Softness::of(scene),
            annulus: [
                scene.inner_race_radius + radius - slack,
                scene.outer_race_radius - radius + depth + slack,
            ],
            cage: CageRoom::of(scene),
            holds_cage: advice::holds_cage(&scene.written),
            step_field,
        }
    }

    /// What guides the cage of this scene, as the object of "take".
    pub fn holds_cage(&self) -> &str {
        &self.holds_cage
    }

    /// Looks at a sample: adds warnings to `info`; the reason to stop, if there is one.
    pub fn look(&self, info: &mut RunInfo, placed: &Placed) -> Option<String> {
        self.softness(info, placed.penetration_share);
        self.support(info, placed.carries);
        let when = When::of(info);
        self.rollers(&placed.centres, &when).or_else(|| self.cage(info, placed.cage?, &when))
    }

    fn softness(&self, info: &mut RunInfo, share: f64) {
        let before = self.element_size * info.guards.penetration_share;
        info.guards.penetration_share = info.guards.penetration_share.max(share);
        let deepest = self.element_size * info.guards.penetration_share;
        if before <= self.soft.limit() && deepest > self.soft.limit() {
            info.warn(Topic::Contact.warning(self.soft.warning(deepest, &When::of(info))));
        }
    }

    fn support(&self, info: &mut RunInfo, carries: f64) {
        let carried = carries > CARRIES * info.expected_support_n;
        let seen = &mut info.guards;
        seen.unsupported_samples = if carried { 0 } else { seen.unsupported_samples + 1 };
        let time = seen.unsupported_samples as f64 * info.interval_s;
        let is_new = time > self.unsupported && seen.longest_unsupported_s <= self.unsupported;
        seen.longest_unsupported_s = seen.longest_unsupported_s.max(time);
        if is_new {
            let when = When::of(info);
            info.warn(Topic::Motion.warning(format!(
                "no roller has carried anything for {:.2} ms {}: the load hangs in the air. Start \
                 `preloaded`, or look at `bearing` for a clearance that the load cannot close",
                1e3 * time,
                when
            )));
        }
    }

    fn rollers(&self, centres: &[[f64; 2]], when: &When) -> Option<String> {
        let [inner, outer] = self.annulus;
        for (number, [x, y]) in self.numbers.iter().zip(centres) {
            // A position that is not a number lies in no range either. The root is taken only for the
            // message.
            if !(inner * inner..=outer * outer).contains(&(x * x + y * y)) {
                let radius = x.hypot(*y);
                let through = if radius < inner { "inner" } else { "outer" };
                return Some(format!(
                    "roller {number} has gone through the {through} raceway: its centre is {:.3} mm from \
                     that of the outer ring {when}. Take a larger `contact.penalty_scale`, less \
                     `operation.load_n` or a smaller {}",
                    1e3 * radius,
                    self.step_field
                ));
            }
        }
        None
    }

    fn cage(&self, info: &mut RunInfo, [x, y]: [f64; 2], when: &When) -> Option<String> {
        let room = self.cage?;
        let off = x.hypot(y);
        let before = info.guards.cage_offset_m;
        info.guards.cage_offset_m = before.max(off);
        if off > room.stop {
            return Some(format!(
                "the cage has cut through a ring: its centre is {:.2} mm from that of the outer ring {when}, \
                 and between the raceways it has {} mm of room. Nothing holds it there: take {}",
                1e3 * off,
                room.in_words(),
                self.holds_cage
            ));
        }
        if off > room.warning && before <= room.warning {
            info.warn(Topic::Motion.warning(format!(
                "the cage has strayed by {:.2} mm {when}, and between the raceways it has {} mm of room: a \
                 real one would rub on a ring, which the model does not have. To hold it, take {}",
                1e3 * off,
                room.in_words(),
                self.holds_cage
            )));
        }
        None
    }
}

impl CageRoom {
    fn in_words(&self) -> String {
        if self.warning.is_finite() { format!("{:.2}", 1e3 * self.warning) } else { "no".to_owned() }
    }
}

/// Time of an observation, formatted only for the few samples that need a message.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct When {
    step: u64,
    /// [s]
    time: f64,
}

impl When {
    /// The last sample of a run.
    pub fn of(info: &RunInfo) -> Self {
        Self { step: info.steps, time: info.steps as f64 * info.time_step_s }
    }
}

impl Display for When {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "at step {}, t = {:.5} ms", self.step, 1e3 * self.time)
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use stribeck_scene::scene::Scene;

    use super::*;

    /// The paper's rollers between their raceways, and one just beyond either end of where they may be, or
    /// nowhere.
    #[test]
    fn refuses_a_roller_that_has_gone_through_a_raceway() {
        let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/scenes/singh2014.ron");
        let scene = Scene::read(scene).expect("the paper's scene").resolve();
        let guards = Guards::new(&scene, "`model.step_us`");
        let when = When { step: 7, time: 14e-6 };
        let [inner, outer] = guards.annulus;
        let at = |number: usize, radius: f64| {
            let (s, c) = (0.3 + number as f64).sin_cos();
            [radius * c, radius * s]
        };
        for third in [inner * (1.0 + 1e-12), 0.5 * (inner + outer), outer * (1.0 - 1e-12)] {
            let centres = [at(0, inner + 1e-6), at(1, outer - 1e-6), at(2, third)];
            assert_eq!(guards.rollers(&centres, &when), None, "{third} m");
        }
        for (third, through) in [
            (inner * (1.0 - 1e-12), "inner"),
            (0.0, "inner"),
            (outer * (1.0 + 1e-12), "outer"),
            (f64::INFINITY, "outer"),
        ] {
            let centres = [at(0, inner + 1e-6), at(1, outer - 1e-6), at(2, third)];
            let stop = guards.rollers(&centres, &when).expect("it is out of place");
            let said = format!("roller 3 has gone through the {through} raceway");
            assert!(stop.starts_with(&said), "{third} m: {stop}");
        }
        let centres = [at(0, inner + 1e-6), [f64::NAN, 0.0]];
        assert!(guards.rollers(&centres, &when).is_some_and(|stop| stop.starts_with("roller 2 ")));
    }
}
