//! Guards of a bearing: quantities checked at every sample, with limits for warnings and limits at which a
//! run stops.
//!
//! | watched | warning | stop |
//! |---|---|---|
//! | penetration over the bearing's own deflection | above 1 | |
//! | time without a loaded roller | `unsupported_warning_ms` | |
//! | rollers out of the space between the raceways | | [`OUT_OF_PLACE`] |
//! | the cage's offset over its clearance to the raceways | above 1 | a cage's thickness beyond |
//! | the cage's offset over the clearance of its pockets | above [`OUT_OF_POCKETS`] | |
//! | the cage's force on a roller over the load | above 1 | |
//! | time in which the cage turns at less than half its speed, over that from roller to roller | above 1 | |
//!
//! The fields are those of `guards` in the scene. Energy, penetration over element size and other limits that
//! depend on the model are watched by the model. A warning is issued once, at the first sample above its
//! limit. The extremes so far are kept in checkpoints and in
//! [`GuardInfo`](stribeck_store::run_info::GuardInfo): a continued run warns as an unbroken one does.

mod softness;

use std::{
    f64::consts::TAU,
    fmt::{self, Display, Formatter},
};

use stribeck_scene::{advice, resolved::ResolvedScene};
use stribeck_store::run_info::{RunInfo, Topic};
use stribeck_theory::duty::Duty;

use softness::Softness;

/// Rollers may leave the space between the raceways, and a housing the outer ring, by this share of a
/// roller's radius.
pub const OUT_OF_PLACE: f64 = 0.5;

/// A roller carries something above this share of the load.
const CARRIES: f64 = 1e-3;

/// A cage that is off its place by this many times the clearance of its pockets is guided by nothing.
pub const OUT_OF_POCKETS: f64 = 10.0;

/// Share of the static load rating that counts as a light load on one roller.
const JAMMING: f64 = 0.01;

/// A cage below this share of its speed without slip slides.
const SLOW: f64 = 0.5;

/// Positions of rollers and cage at a sample, and the largest load.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Placed {
    /// Centres of the rollers, in the order of the scene, from that of the outer ring [m].
    pub centres: Vec<[f64; 2]>,
    /// Largest force of the outer raceway on a roller, by contact or oil [N].
    pub carries: f64,
    /// The cage, if there is one.
    pub cage: Option<PlacedCage>,
    /// Deepest penetration so far over the element size [-].
    pub penetration_share: f64,
}

/// Place, speed and largest force of a cage at a sample.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PlacedCage {
    /// Its centre from that of the outer ring [m].
    pub offset: [f64; 2],
    /// Its angular velocity in space [rad/s], counter-clockwise positive.
    pub spin: f64,
    /// Its largest force on a roller [N].
    pub push: f64,
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
    duty: Duty,
    /// The cage pushes no roller that has not jammed with more than this [N].
    jamming: f64,
    /// What guides the cage in this scene, in words.
    holds_cage: String,
    /// The field that shortens the time step, as messages name it.
    step_field: &'static str,
}

/// How far a cage may move between the raceways, with which the models have no contact of it, and in its
/// pockets.
#[derive(Debug, Clone, Copy)]
struct CageRoom {
    /// Until it touches a raceway [m]; infinite where its dimensions leave it no room from the start.
    touches: f64,
    /// Until its whole thickness lies in a ring [m]; the pitch radius at most.
    stop: f64,
    /// Clearance of its pockets [m].
    pockets: f64,
    /// Its speed over that of the inner ring, both relative to the outer one, without slip [-].
    share: f64,
    /// Angle from roller to roller [rad].
    spacing: f64,
}

impl CageRoom {
    fn of(scene: &ResolvedScene) -> Option<Self> {
        let cage = scene.cage.as_ref()?;
        let inside = cage.outer_radius - cage.thickness - scene.inner_race_radius;
        let room = (scene.outer_race_radius - cage.outer_radius).min(inside);
        let pitch_radius = 0.5 * (scene.inner_race_radius + scene.outer_race_radius);
        let [touches, stop] = if room > 0.0 {
            [room, (room + cage.thickness).min(pitch_radius)]
        } else {
            [f64::INFINITY, pitch_radius]
        };
        let share = scene.inner_race_radius / (scene.inner_race_radius + scene.outer_race_radius);
        let spacing = TAU / scene.written.bearing.rollers as f64;
        Some(Self { touches, stop, pockets: cage.pocket_clearance, share, spacing })
    }

    /// Offset above which there is a warning [m].
    fn warning(&self) -> f64 {
        self.touches.min(OUT_OF_POCKETS * self.pockets)
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
            jamming: scene.duty.load_range_n(scene.duration)[1]
                .max(JAMMING * scene.written.static_rating_n()),
            duty: scene.duty.clone(),
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
                let radius = libm::hypot(*x, *y);
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

    fn cage(&self, info: &mut RunInfo, cage: PlacedCage, when: &When) -> Option<String> {
        let room = self.cage?;
        self.jam(info, cage.push, when);
        self.slip(info, &room, cage.spin, when);
        let off = libm::hypot(cage.offset[0], cage.offset[1]);
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
        if off > room.warning() && before <= room.warning() {
            info.warn(Topic::Motion.warning(format!(
                "the cage has strayed by {:.2} mm {when}, with {:.0} µm of clearance in its pockets and {} mm \
                 of room between the raceways: a real one would be stopped by its pockets or rub on a ring, \
                 which the model does not have. To hold it, take {}",
                1e3 * off,
                1e6 * room.pockets,
                room.in_words(),
                self.holds_cage
            )));
        }
        None
    }

    /// A cage that pushes a roller with more than the bearing's load has jammed it, unless all loads are
    /// light: rollers that skid strike at it.
    fn jam(&self, info: &mut RunInfo, push: f64, when: &When) {
        let before = info.guards.cage_push_n;
        info.guards.cage_push_n = before.max(push);
        if push > self.jamming && before <= self.jamming {
            info.warn(Topic::Motion.warning(format!(
                "the cage pushes a roller with {:.1} kN {when}, more than {:.1} kN, the load or {:.0} % of the \
                 static rating: a roller has jammed between its pocket and a raceway or the edge of a defect, \
                 and what follows is no motion of a bearing. Take a larger `cage.pocket_clearance_um`, edges \
                 that slope, or `cage: None`",
                1e-3 * push,
                1e-3 * self.jamming,
                1e2 * JAMMING
            )));
        }
    }

    /// A cage that turns at less than half its speed for longer than it should take from roller to roller.
    fn slip(&self, info: &mut RunInfo, room: &CageRoom, spin: f64, when: &When) {
        let [from, to] = [when.time - info.interval_s, when.time];
        let outer = self.duty.mean_outer_rad_s(from, to);
        let expected = room.share * (self.duty.mean_shaft_rad_s(from, to) - outer);
        let is_slow = (spin - outer) * expected < SLOW * expected * expected;
        let seen = &mut info.guards;
        seen.cage_slow_s = if is_slow { seen.cage_slow_s + info.interval_s } else { 0.0 };
        let is_long = |time: f64| time * expected.abs() > room.spacing;
        let is_new = is_long(seen.cage_slow_s) && !is_long(seen.longest_cage_slow_s);
        seen.longest_cage_slow_s = seen.longest_cage_slow_s.max(seen.cage_slow_s);
        if is_new {
            info.warn(Topic::Motion.warning(format!(
                "the cage turns at {:.0} % of its speed without slip {when}, and has been below half of it \
                 for longer than from one roller to the next: rollers slide, and families of a defect lie \
                 lower than predicted or nowhere. Take more `operation.load_n` or `contact.friction`, or look \
                 for a roller that has jammed",
                100.0 * (spin - outer) / expected
            )));
        }
    }
}

impl CageRoom {
    fn in_words(&self) -> String {
        if self.touches.is_finite() { format!("{:.2}", 1e3 * self.touches) } else { "no".to_owned() }
    }
}

/// The largest of forces [N].
pub fn largest(forces: impl Iterator<Item = [f64; 2]>) -> f64 {
    forces.map(|[x, y]| libm::hypot(x, y)).fold(0.0, f64::max)
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
    use stribeck_store::run_info::MeshInfo;

    use crate::run::{host::Host, setup::Setup};

    use super::*;

    /// `run.json` before the first step of a run with one step a sample.
    fn started(scene: &ResolvedScene) -> RunInfo {
        let setup = Setup {
            time_step: scene.interval,
            critical_time_step: scene.interval,
            steps_per_sample: 1,
            mesh: MeshInfo::default(),
            reduced: None,
            wall_s: 0.0,
            carried_mass: 0.0,
            notes: Vec::new(),
            warnings: Vec::new(),
        };
        let [version, commit, machine] = [const { String::new() }; 3];
        let clock = || 0.0;
        setup.info(scene, &Host { threads: 1, version, commit, machine, wall_s: &clock, cpu_s: &clock })
    }

    /// A cage with 40 µm of clearance strayed by 0.75 mm in 30 ms, one that a roller had jammed pushed with 1 MN
    /// and stood still, and no run said so.
    #[test]
    fn issue_a_cage_that_strays_jams_or_stops_is_warned_of_once() {
        let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../fixtures/scenes/singh2014.ron");
        let scene = Scene::read(scene).expect("the paper's scene").resolve();
        let guards = Guards::new(&scene, "`model.step_us`");
        // Without slip it turns at 23.59 rad/s, clockwise, and from roller to roller in 11.1 ms.
        let rolling = PlacedCage { offset: [0.2e-3, -0.2e-3], spin: -23.6, push: 40e3 };
        let warned = |cage: PlacedCage, samples: u64| {
            let mut info = started(&scene);
            for step in 1..=samples {
                info.steps = step;
                let when = When::of(&info);
                assert_eq!(guards.cage(&mut info, cage, &when), None);
            }
            info.warnings
        };
        assert_eq!(warned(rolling, 2000), [""; 0]);
        for (cage, says) in [
            (PlacedCage { offset: [0.3e-3, 0.3e-3], ..rolling }, "the cage has strayed by 0.42 mm"),
            (PlacedCage { push: 1e6, ..rolling }, "the cage pushes a roller with 1000.0 kN"),
            (PlacedCage { spin: -2.0, ..rolling }, "the cage turns at 8 % of its speed"),
        ] {
            let warnings = warned(cage, 2000);
            assert!(warnings.len() == 1 && warnings[0].starts_with(says), "{warnings:?}");
        }
        assert_eq!(warned(PlacedCage { spin: 0.0, ..rolling }, 1000), [""; 0], "10 ms are no standstill");
    }

    /// The paper's rollers between their raceways, and one just beyond either end of where they may be, or
    /// nowhere.
    #[test]
    fn refuses_a_roller_that_has_gone_through_a_raceway() {
        let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../fixtures/scenes/singh2014.ron");
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
