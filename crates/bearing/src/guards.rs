//! Guard rails: what is watched at every sample, when a run carries a warning, when it stops.
//!
//! | watched | warning | stop |
//! |---|---|---|
//! | imbalance of energy over the peak strain energy; no number at all | `energy_warning_percent` | `energy_stop_percent` |
//! | hourglass over strain energy | `hourglass_warning_percent` | |
//! | penetration over element size | `penetration_warning_percent` | `penetration_stop_percent` |
//! | penetration over what a bearing gives way by itself | above 1 | |
//! | area of an element over its area at rest | | `area_stop_percent` |
//! | time step over the critical one, at the start and as elements deform | above 1 | |
//! | critical time step over that of a square cell | below [`SMALL_STEP`] | |
//! | time without a roller that carries anything | `unsupported_warning_ms` | |
//! | rollers and housing out of their place | | [`OUT_OF_PLACE`] |
//! | the cage's centre from that of the bearing | | the radius of the pitch circle |
//!
//! The fields are those of `guards` in the scene. [`System::look`] watches what can go wrong with any bodies in motion and
//! says it in the scene's words ([`arm`]); before the first step, for the penetration in the fourth row, and for the last three rows, it is said here. A warning is
//! given once, at the first sample above its limit. What has been seen is in checkpoints and in
//! [`GuardInfo`](stribeck_scene::run_info::GuardInfo): a continued run warns as an unbroken one does.

use stribeck_solver::Elastic;
use stribeck_system::{Limits, Scale, System, Words};

use crate::assembly::{Assembly, Machine};
use stribeck_scene::{
    advice,
    geometry::Geometry,
    run_info::RunInfo,
    scene::{GuardsScene, Scene},
    static_load::{RigidRings, angles_to_load_deg},
};

/// A critical time step that is this share of that of a square cell of the scene's size is worth a word.
const SMALL_STEP: f64 = 0.25;

/// Elements are looked at every so many samples: the look costs as much as two steps.
const LOOK_EVERY: u64 = 10;

/// Rollers may leave their annulus, and the housing the outer ring, by this share of a roller's radius.
const OUT_OF_PLACE: f64 = 0.5;

/// Contact that sinks in by more than this share of the defect's depth moves its edges.
const OF_DEPTH: f64 = 0.5;

/// A roller carries something above this share of the load.
const CARRIES: f64 = 1e-3;

/// The limits of one run.
#[derive(Debug, Clone)]
pub(crate) struct Guards {
    /// Time without support above which there is a warning [s].
    unsupported: f64,
    soft: Softness,
    /// Nearest and farthest place of a roller's centre from that of the outer ring [m].
    annulus: [f64; 2],
    /// How far the middle of the cage may be from there [m].
    pitch_radius: f64,
    /// What else holds the cage, in words.
    holds_cage: String,
    /// How far the housing may leave the ring [m].
    seat: f64,
    /// Height of the housing above the outer ring at rest [m], if there is one.
    housing_height: Option<f64>,
}

/// What a penetration is to be compared with [m]: a contact that sinks in by more is softer than the bearing itself.
#[derive(Debug, Clone, Copy)]
struct Softness {
    /// Half of the diametral clearance.
    radial_clearance: f64,
    /// Approach of one contact of the most loaded roller between rigid rings, by Hertz.
    hertz: f64,
    /// Depth of the shallowest spall; infinite without one.
    depth: f64,
}

impl Softness {
    fn of(scene: &Scene, g: &Geometry) -> Self {
        // Rollers that carry nothing in equilibrium leave the clearance alone.
        let [_, most] = scene.duty().load_range_n(g.duration);
        let load = RigidRings::new(g).distribute(most, &angles_to_load_deg(scene));
        let hertz = load.map_or(0.0, |load| 0.5 * load.max_approach_m());
        let depth = scene.spalls().iter().map(|d| 1e-3 * d.depth_mm).fold(f64::INFINITY, f64::min);
        Self { radial_clearance: 0.5 * g.clearance, hertz, depth }
    }

    fn limit(&self) -> f64 {
        self.radial_clearance.max(self.hertz).min(OF_DEPTH * self.depth)
    }

    fn warning(&self, penetration: f64, info: &RunInfo) -> String {
        let um = |length: f64| format!("{:.1} µm", 1e6 * length);
        let depth = if self.depth.is_finite() {
            format!(", the defect is {} deep", um(self.depth))
        } else {
            String::new()
        };
        format!(
            "contact has sunk in by {} {}: it is softer than the bearing, which has {} of radial clearance and by Hertz gives way by {} at a \
             contact{depth}. Load zone, times and impulses are those of a softer bearing; a larger `contact.penalty_scale` is nearer to steel",
            um(penetration),
            when(info),
            um(self.radial_clearance),
            um(self.hertz),
        )
    }
}

impl Guards {
    pub(crate) fn new(scene: &Scene, assembly: &Assembly, machine: &Machine) -> Self {
        let g = Geometry::of(scene);
        let radius = g.roller_radius;
        let depth = scene.spalls().iter().map(|d| 1e-3 * d.depth_mm).fold(0.0, f64::max);
        let slack = OUT_OF_PLACE * radius;
        let mesh = &assembly.model.mesh;
        let height = |body: usize| mean(mesh.y[mesh.bodies[body].nodes.clone()].iter().copied());
        Self {
            soft: Softness::of(scene, &g),
            unsupported: 1e-3 * scene.guards.unsupported_warning_ms,
            annulus: [g.inner_race_radius + radius - slack, g.outer_race_radius - radius + depth + slack],
            pitch_radius: 0.5 * (g.inner_race_radius + g.outer_race_radius),
            holds_cage: advice::holds_cage(scene),
            seat: slack,
            housing_height: machine.housing.map(|housing| height(housing) - height(machine.outer)),
        }
    }

    /// What is worth a word before the first step.
    pub(crate) fn before(scene: &Scene, steel: &Elastic, info: &RunInfo) -> Vec<String> {
        let mut warnings = Vec::new();
        let (step, critical) = (info.time_step_s, info.critical_time_step_s);
        if step > critical {
            warnings.push(format!(
                "the time step of {:.2} ns is {:.3} times the critical one: the run may diverge. Take a `solver.time_step_factor` \
                 below 1",
                1e9 * step,
                step / critical
            ));
        }
        let facet = std::f64::consts::PI * scene.bearing.roller_diameter_mm / scene.mesh.roller_facets as f64;
        let size = 1e-3 * scene.mesh.size_mm.min(facet);
        // A regular mesh of squares of side a has ω = (2/a) √((λ + 2µ)/ρ) at most for plane waves along a row.
        let square = size / steel.dilatational_speed();
        if critical < SMALL_STEP * square {
            warnings.push(format!(
                "the critical time step of {:.2} ns is {:.1} % of the {:.1} ns of square cells of {:.2} mm: some cell is very small, or the \
                 contact very stiff, or stiffness damping strong. Look at `defect.depth_mm`, `mesh.roller_facets`, `contact.penalty_scale` and \
                 `solver.stiffness_damping_ns`, or expect a run {:.0} \
                 times as long",
                1e9 * critical,
                100.0 * critical / square,
                1e9 * square,
                1e3 * size,
                square / critical
            ));
        }
        warnings
    }

    /// Looks at the machine after a sample: adds warnings to `info`; the reason to stop, if there is one.
    pub(crate) fn look(&self, info: &mut RunInfo, machine: &mut Machine) -> Option<String> {
        let mut stop = None;
        for finding in machine.system.look() {
            if finding.stops {
                // The first reason is the one given.
                stop.get_or_insert(finding.message);
            } else {
                info.warnings.push(finding.message);
            }
        }
        let size = machine.system.limits.element_size.unwrap_or(0.0);
        let before = size * info.guards.penetration_share;
        let (seen, guards) = (machine.system.seen(), &mut info.guards);
        guards.energy_warned = seen.energy_warned;
        guards.hourglass_share = seen.hourglass_share;
        guards.penetration_share = seen.penetration_share;
        guards.least_area = seen.least_area;
        guards.strain_checked = seen.strain_checked;
        let (deepest, limit) = (size * info.guards.penetration_share, self.soft.limit());
        if before <= limit && deepest > limit {
            info.warnings.push(self.soft.warning(deepest, info));
        }
        self.support(info, machine);
        stop.or(self.places(info, machine))
    }

    fn support(&self, info: &mut RunInfo, machine: &Machine) {
        let force: Vec<[f64; 2]> = machine.system.resultants().map(|r| r.force).collect();
        let enough = CARRIES * info.expected_support_n;
        let outer = (0..machine.rollers.len()).map(|i| force[machine.pairs.outer(i)]);
        let carried = outer.map(|[fx, fy]| fx.hypot(fy)).any(|f| f > enough);
        let seen = &mut info.guards;
        seen.unsupported_samples = if carried { 0 } else { seen.unsupported_samples + 1 };
        let time = seen.unsupported_samples as f64 * info.interval_s;
        let is_new = time > self.unsupported && seen.longest_unsupported_s <= self.unsupported;
        seen.longest_unsupported_s = seen.longest_unsupported_s.max(time);
        if is_new {
            info.warnings.push(format!(
                "no roller has carried anything for {:.2} ms {}: the load hangs in the air. Start `preloaded`, or look at \
                 `bearing` for a clearance that the load cannot close",
                1e3 * time,
                when(info)
            ));
        }
    }

    fn places(&self, info: &RunInfo, machine: &Machine) -> Option<String> {
        let system = &machine.system;
        let middle = |body: usize, c: usize| mean(system.nodes_of(body).map(|n| system.position(n)[c]));
        let ring = [middle(machine.outer, 0), middle(machine.outer, 1)];
        for roller in &machine.rollers {
            let [x, y] = system.position(roller.centre);
            let radius = (x - ring[0]).hypot(y - ring[1]);
            if radius < self.annulus[0] || radius > self.annulus[1] {
                let through = if radius < self.annulus[0] { "inner" } else { "outer" };
                return Some(format!(
                    "roller {} has gone through the {through} raceway: its centre is {:.3} mm from that of the outer ring {}. Take a \
                     larger `contact.penalty_scale`, less `operation.load_n` or a smaller `solver.time_step_factor`",
                    roller.pocket + 1,
                    1e3 * radius,
                    when(info)
                ));
            }
        }
        if let Some(cage) = machine.cage {
            let off = (middle(cage, 0) - ring[0]).hypot(middle(cage, 1) - ring[1]);
            if off > self.pitch_radius {
                return Some(format!(
                    "the cage has left the bearing: its centre is {:.1} mm from that of the outer ring {}. Nothing holds it there: take {}",
                    1e3 * off,
                    when(info),
                    self.holds_cage
                ));
            }
        }
        let off = middle(machine.housing?, 1) - ring[1] - self.housing_height?;
        (off.abs() > self.seat).then(|| {
            format!(
                "the housing has left the outer ring by {:.3} mm {}: take a larger `contact.penalty_scale`, or less \
                 `operation.load_n`",
                1e3 * off,
                when(info)
            )
        })
    }
}

/// Sets what the system watches, and what its messages call the fields of the scene.
pub(crate) fn arm(scene: &Scene, system: &mut System) {
    let GuardsScene {
        energy_warning_percent,
        energy_stop_percent,
        hourglass_warning_percent,
        penetration_warning_percent,
        penetration_stop_percent,
        area_stop_percent,
        unsupported_warning_ms: _,
    } = scene.guards;
    system.limits = Limits {
        // All that turns would hide what matters.
        energy_scale: Scale::StrainEnergy,
        energy_warning_percent,
        energy_stop_percent,
        hourglass_warning_percent,
        penetration_warning_percent,
        penetration_stop_percent,
        area_stop_percent,
        element_size: Some(Geometry::of(scene).element_size),
        elements_every: LOOK_EVERY,
    };
    system.words = Words {
        time_step_factor: "`solver.time_step_factor`",
        penalty: "`contact.penalty_scale`",
        element_size: "`mesh.size_mm`",
        hourglass_scale: "`solver.hourglass_scale`",
        thickness: "`bearing.thickness_mm`",
        load: "`operation.load_n`",
        preloaded: "`preloaded`",
    };
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let n = values.len() as f64;
    values.sum::<f64>() / n
}

fn when(info: &RunInfo) -> String {
    format!("at step {}, t = {:.5} ms", info.steps, 1e3 * info.steps as f64 * info.time_step_s)
}
