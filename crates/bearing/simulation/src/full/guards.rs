//! Guards of the full model besides [the guards of all models](crate::run::guards).
//!
//! | watched | warning | stop |
//! |---|---|---|
//! | imbalance of energy over the peak strain energy; no number at all | at the end of the run | `energy_stop_percent` |
//! | hourglass over strain energy | `hourglass_warning_percent` | |
//! | penetration over element size | `penetration_warning_percent` | `penetration_stop_percent` |
//! | area of an element over its area at rest | | `area_stop_percent` |
//! | time step over the critical one, at the start and as elements deform | above 1 | |
//! | critical time step over that of a square cell | below [`SMALL_STEP`] | |
//! | the housing's height above the outer ring | | [`OUT_OF_PLACE`] |
//!
//! [`System::look`] watches the limits that apply to any bodies in motion, with messages in the scene's words
//! ([`arm`]).

use crate::bearing::assembly::{Assembly, BearingSystem};
use crate::run::guards::{self, OUT_OF_PLACE, Placed, PlacedCage, When, largest};
use stribeck_scene::{resolved::ResolvedScene, scene::GuardsScene};
use stribeck_solver::Elastic;
use stribeck_store::run_info::{RunInfo, Topic, Warning};
use stribeck_system::{Limits, Scale, System, Watched, Words};

/// A critical time step that is this share of that of a square cell of the scene's size is worth a warning.
const SMALL_STEP: f64 = 0.25;

/// Samples between two looks at the elements: a look costs as much as two steps.
const LOOK_EVERY: u64 = 10;

#[derive(Debug, Clone)]
pub(super) struct Guards {
    shared: guards::Guards,
    placed: Placed,
    /// How far the housing may leave the ring [m].
    seat: f64,
    /// Height of the housing above the outer ring at rest [m], if there is one.
    housing_height: Option<f64>,
}

impl Guards {
    pub(super) fn new(scene: &ResolvedScene, assembly: &Assembly, bearing: &BearingSystem) -> Self {
        let mesh = &assembly.model.mesh;
        let height = |body: usize| mean(mesh.y[mesh.bodies[body].nodes.clone()].iter().copied());
        Self {
            shared: guards::Guards::new(scene, "`solver.time_step_factor`"),
            placed: Placed { centres: vec![[0.0; 2]; bearing.rollers.len()], ..Placed::default() },
            seat: OUT_OF_PLACE * scene.roller_radius,
            housing_height: bearing.housing.map(|housing| height(housing) - height(bearing.outer)),
        }
    }

    /// Warnings before the first step.
    pub(super) fn before(scene: &ResolvedScene, steel: &Elastic, info: &RunInfo) -> Vec<Warning> {
        let mut warnings = Vec::new();
        let (step, critical) = (info.time_step_s, info.critical_time_step_s);
        if step > critical {
            warnings.push(Topic::TimeStep.warning(format!(
                "the time step of {:.2} ns is {:.3} times the critical one: the run may diverge. Take a \
                 `solver.time_step_factor` below 1",
                1e9 * step,
                step / critical
            )));
        }
        let facet = std::f64::consts::PI * scene.written.bearing.roller_diameter_mm
            / scene.written.mesh.roller_facets as f64;
        let size = 1e-3 * scene.written.mesh.size_mm.min(facet);
        // A regular mesh of squares of side a has ω = (2/a) √((λ + 2µ)/ρ) at most for plane waves along a
        // row.
        let square = size / steel.dilatational_speed();
        if critical < SMALL_STEP * square {
            warnings.push(Topic::TimeStep.warning(format!(
                "the critical time step of {:.2} ns is {:.1} % of the {:.1} ns of square cells of {:.2} mm: \
                 some cell is very small, or the contact very stiff, or stiffness damping strong. Look at \
                 `defect.depth_mm`, `mesh.roller_facets`, `contact.penalty_scale` and \
                 `solver.stiffness_damping_ns`, or expect a run {:.0} times as long",
                1e9 * critical,
                100.0 * critical / square,
                1e9 * square,
                1e3 * size,
                square / critical
            )));
        }
        warnings
    }

    /// Looks at the bearing after a sample: adds warnings to `info`; the reason to stop, if there is one.
    pub(super) fn look(&mut self, info: &mut RunInfo, bearing: &mut BearingSystem) -> Option<String> {
        let mut stop = None;
        for finding in bearing.system.look() {
            if finding.stops {
                // The first reason is reported.
                stop.get_or_insert(finding.message);
            } else {
                let topic = match finding.watched {
                    Watched::Energy => Topic::Energy,
                    Watched::Hourglass | Watched::Distortion => Topic::Elements,
                    Watched::Penetration => Topic::Contact,
                    Watched::TimeStep => Topic::TimeStep,
                };
                info.warn(topic.warning(finding.message));
            }
        }
        let (seen, guards) = (bearing.system.seen(), &mut info.guards);
        guards.hourglass_share = seen.hourglass_share;
        guards.least_area = seen.least_area;
        guards.strain_checked = seen.strain_checked;
        self.place(bearing);
        let place = self.shared.look(info, &self.placed);
        stop.or(place).or_else(|| self.housing(info, bearing))
    }

    /// Positions of rollers and cage, and the largest load.
    fn place(&mut self, bearing: &BearingSystem) {
        let system = &bearing.system;
        let ring = centre(system, bearing.outer);
        let from_ring = |[x, y]: [f64; 2]| [x - ring[0], y - ring[1]];
        for (place, roller) in self.placed.centres.iter_mut().zip(&bearing.rollers) {
            *place = from_ring(system.position(roller.centre));
        }
        let pockets = bearing.pairs.cage(0).start..bearing.pairs.cage(bearing.rollers.len()).start;
        let pushes = system.resultants().skip(pockets.start).take(pockets.len());
        self.placed.cage = bearing.cage.map(|cage| PlacedCage {
            offset: from_ring(centre(system, cage)),
            spin: system.rigid(cage).map_or(0.0, |cage| cage.spin),
            push: largest(pushes.map(|wall| wall.force)),
        });
        let by_contact = system.resultants().skip(bearing.pairs.outer(0)).take(bearing.rollers.len());
        // Of each roller on the outer and on the inner raceway in turn.
        let by_oil = system.films().step_by(2);
        let forces = by_contact.map(|pair| pair.force).chain(by_oil.map(|film| film.force));
        self.placed.carries = largest(forces);
        self.placed.penetration_share = system.seen().penetration_share;
    }

    fn housing(&self, info: &RunInfo, bearing: &BearingSystem) -> Option<String> {
        let [housing, ring] = [bearing.housing?, bearing.outer].map(|body| centre(&bearing.system, body)[1]);
        let off = housing - ring - self.housing_height?;
        (off.abs() > self.seat).then(|| {
            format!(
                "the housing has left the outer ring by {:.3} mm {}: take a larger `contact.penalty_scale`, \
                 or less `operation.load_n`",
                1e3 * off,
                When::of(info)
            )
        })
    }
}

/// Sets the limits of the system's guards, and the scene's field names for its messages.
pub(super) fn arm(scene: &ResolvedScene, system: &mut System) {
    let GuardsScene {
        energy_warning_percent: _,
        energy_stop_percent,
        hourglass_warning_percent,
        penetration_warning_percent: _,
        penetration_stop_percent,
        area_stop_percent,
        unsupported_warning_ms: _,
    } = scene.written.guards;
    system.limits = Limits {
        // The kinetic energy of the rotating bodies would hide an imbalance.
        energy_scale: Scale::StrainEnergy,
        // The run compares it with what contacts dissipate, when it ends.
        energy_warning_percent: f64::INFINITY,
        energy_stop_percent,
        hourglass_warning_percent,
        penetration_warning_percent: scene.soft_percent(),
        penetration_stop_percent,
        area_stop_percent,
        element_size: Some(scene.element_size),
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

/// Mean place of a body's nodes [m].
fn centre(system: &System, body: usize) -> [f64; 2] {
    let nodes = system.nodes_of(body);
    let count = nodes.len() as f64;
    let places = nodes.map(|n| system.position(n));
    places.fold([0.0; 2], |sum, [x, y]| [sum[0] + x, sum[1] + y]).map(|sum| sum / count)
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let n = values.len() as f64;
    values.sum::<f64>() / n
}
