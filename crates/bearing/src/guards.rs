//! Guard rails: what is watched at every sample, when a run carries a warning, when it stops.
//!
//! | watched | warning | stop |
//! |---|---|---|
//! | imbalance of energy over the peak strain energy; no number at all | `energy_warning_percent` | `energy_stop_percent` |
//! | hourglass over strain energy | `hourglass_warning_percent` | |
//! | penetration over element size | `penetration_warning_percent` | `penetration_stop_percent` |
//! | area of an element over its area at rest | | `area_stop_percent` |
//! | time step over the critical one, at the start and as elements deform | above 1 | |
//! | critical time step over that of a square cell | below [`SMALL_STEP`] | |
//! | time without a roller that carries anything | `unsupported_warning_ms` | |
//! | rollers and adapter out of their place | | [`OUT_OF_PLACE`] |
//!
//! The fields are those of `guards` in the scene. A warning is given once, at the first sample above its limit. What has
//! been seen is in [`GuardInfo`](stribeck_scene::run_info::GuardInfo), and so in checkpoints: a continued run warns as an unbroken
//! one does.

use stribeck_solver::Elastic;

use crate::{
    assembly::{Assembly, Machine},
    ledger::Ledger,
    simulation::critical_time_step,
};
use stribeck_scene::{
    run_info::RunInfo,
    scene::{GuardsScene, Scene},
};

/// A critical time step that is this share of that of a square cell of the scene's size is worth a word.
const SMALL_STEP: f64 = 0.25;

/// Elements are looked at every so many samples: the look costs as much as two steps.
const LOOK_EVERY: usize = 10;

/// The critical time step is computed again each time the largest strain has grown by this much [-]; stretched by one per
/// cent, elements are stiffer by one and a half.
const STRAIN_STEP: f64 = 0.01;

/// Rollers may leave their annulus, and the adapter its seat, by this share of a roller's radius.
const OUT_OF_PLACE: f64 = 0.5;

/// A roller carries something above this share of the load.
const CARRIES: f64 = 1e-3;

/// Strain energy below this share of its peak makes no hourglass share: noise over noise.
const STRAINED: f64 = 0.01;

/// The limits of one run.
#[derive(Debug, Clone)]
pub(crate) struct Guards {
    limits: GuardsScene,
    /// Element size [m].
    size: f64,
    /// Nearest and farthest place of a roller's centre from that of the outer ring [m].
    annulus: [f64; 2],
    /// How far the adapter may leave its seat [m].
    seat: f64,
    /// Height of the adapter above the outer ring at rest [m].
    adapter_height: f64,
}

impl Guards {
    pub(crate) fn new(scene: &Scene, assembly: &Assembly, machine: &Machine) -> Self {
        let b = &scene.bearing;
        let radius = 0.5e-3 * b.roller_diameter_mm;
        let depth = scene.defect.as_ref().map_or(0.0, |d| 1e-3 * d.depth_mm);
        let slack = OUT_OF_PLACE * radius;
        let mesh = &assembly.model.mesh;
        let [outer, adapter] = machine.standing_bodies.map(|body| {
            let nodes = mesh.bodies[body].nodes.clone();
            mean(mesh.y[nodes].iter().copied())
        });
        Self {
            limits: scene.guards.clone(),
            size: 1e-3 * scene.mesh.size_mm,
            annulus: [
                0.5e-3 * b.inner_race_diameter_mm + radius - slack,
                0.5e-3 * b.outer_race_diameter_mm - radius + depth + slack,
            ],
            seat: slack,
            adapter_height: adapter - outer,
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

    /// Looks at the machine after a sample: adds warnings to `info`; the reason to stop, if there is one. `error` is the
    /// imbalance of energy over the peak strain energy.
    pub(crate) fn look(
        &self,
        info: &mut RunInfo,
        assembly: &Assembly,
        machine: &Machine,
        ledger: &Ledger,
        error: f64,
    ) -> Option<String> {
        let stop = self.energy(info, assembly, machine, error);
        self.hourglass(info, ledger);
        // Each look is taken, so that the worst of each is known; the first reason is the one given.
        let stop = stop.or(self.penetration(info, machine));
        let stop = stop.or(self.elements(info, machine));
        self.support(info, machine);
        stop.or(self.places(info, machine))
    }

    fn energy(
        &self,
        info: &mut RunInfo,
        assembly: &Assembly,
        machine: &Machine,
        error: f64,
    ) -> Option<String> {
        let [warning, stop] =
            [self.limits.energy_warning_percent, self.limits.energy_stop_percent].map(|p| 0.01 * p);
        if error > stop {
            let worst = fastest(assembly, machine);
            let what = if error.is_finite() {
                format!(
                    "energy is out of balance by {:.1} % of the peak strain energy (limit {:.0} %)",
                    100.0 * error,
                    100.0 * stop
                )
            } else {
                "a position or a velocity is no number any more".to_owned()
            };
            return Some(format!(
                "{what} {}; the fastest node is {worst}. Try a smaller `solver.time_step_factor`, a smaller \
                 `contact.penalty_scale`, or look for bodies that overlap",
                when(info)
            ));
        }
        // A load that comes suddenly is soon larger than the strain energy of the first samples.
        if error > warning && !info.guards.energy_warned && info.samples.is_multiple_of(LOOK_EVERY) {
            info.guards.energy_warned = true;
            info.warnings.push(format!(
                "energy is out of balance by {:.2} % of the peak strain energy (limit {} %) {}: take a smaller \
                 `solver.time_step_factor`, a smaller `contact.penalty_scale`, or start `preloaded`",
                100.0 * error,
                self.limits.energy_warning_percent,
                when(info)
            ));
        }
        None
    }

    fn hourglass(&self, info: &mut RunInfo, ledger: &Ledger) {
        if ledger.strain.is_nan() || ledger.strain <= STRAINED * info.energy.peak_strain_j {
            return;
        }
        let share = ledger.hourglass / ledger.strain;
        if passes(share, &mut info.guards.hourglass_share, 0.01 * self.limits.hourglass_warning_percent) {
            info.warnings.push(format!(
                "hourglass energy is {:.1} % of the strain energy (limit {} %) {}: elements bend more than they stretch. Take a \
                 smaller `mesh.size_mm`, or another `solver.hourglass_scale`",
                100.0 * share,
                self.limits.hourglass_warning_percent,
                when(info)
            ));
        }
    }

    fn penetration(&self, info: &mut RunInfo, machine: &Machine) -> Option<String> {
        let deepest =
            machine.contacts.resultants().enumerate().map(|(pair, r)| (pair, r.penetration)).max_by(
                |a, b| {
                    // The first of equals.
                    a.1.total_cmp(&b.1).then(b.0.cmp(&a.0))
                },
            );
        let (pair, depth) = deepest?;
        let share = depth / self.size;
        let warning = 0.01 * self.limits.penetration_warning_percent;
        let is_new = passes(share, &mut info.guards.penetration_share, warning);
        let where_ = pair_name(machine, pair);
        let said = format!(
            "{where_} penetrate each other by {:.1} µm, {:.0} % of the element size",
            1e6 * depth,
            100.0 * share
        );
        let advice = "take a larger `contact.penalty_scale`, a larger `bearing.thickness_mm` or less `operation.load_n`";
        if share > 0.01 * self.limits.penetration_stop_percent {
            let limit = self.limits.penetration_stop_percent;
            return Some(format!("{said} (limit {limit} %) {}: {advice}", when(info)));
        }
        if is_new {
            let limit = self.limits.penetration_warning_percent;
            info.warnings.push(format!("{said} (limit {limit} %) {}: {advice}", when(info)));
        }
        None
    }

    fn elements(&self, info: &mut RunInfo, machine: &Machine) -> Option<String> {
        if !info.samples.is_multiple_of(LOOK_EVERY) {
            return None;
        }
        let now = machine.dynamics.distortion();
        info.guards.least_area = info.guards.least_area.min(now.least_area);
        if now.least_area < 0.01 * self.limits.area_stop_percent {
            return Some(format!(
                "an element at x = {:.3} mm, y = {:.3} mm has {:.1} % of its area left (limit {} %) {}: it is about to turn inside \
                 out, beyond what a linear material means. Take less `operation.load_n`, a larger `bearing.thickness_mm`, or start \
                 `preloaded`",
                1e3 * now.place[0],
                1e3 * now.place[1],
                100.0 * now.least_area,
                self.limits.area_stop_percent,
                when(info)
            ));
        }
        let strain = (now.largest_stretch - 1.0).max(1.0 - now.least_area);
        if strain > info.guards.strain_checked + STRAIN_STEP {
            info.guards.strain_checked = strain;
            let critical = critical_time_step(machine);
            if info.time_step_s > critical {
                info.warnings.push(format!(
                    "the time step of {:.3} ns is above the critical one of the deformed mesh, {:.3} ns, {}: take a \
                     `solver.time_step_factor` below {:.2}",
                    1e9 * info.time_step_s,
                    1e9 * critical,
                    when(info),
                    critical / info.critical_time_step_s
                ));
            }
        }
        None
    }

    fn support(&self, info: &mut RunInfo, machine: &Machine) {
        let force: Vec<[f64; 2]> = machine.contacts.resultants().map(|r| r.force).collect();
        let enough = CARRIES * info.expected_support_n;
        let outer = (0..machine.rollers.len()).map(|i| force[machine.pairs.outer(i)]);
        let carried = outer.map(|[fx, fy]| fx.hypot(fy)).any(|f| f > enough);
        let seen = &mut info.guards;
        seen.unsupported_samples = if carried { 0 } else { seen.unsupported_samples + 1 };
        let time = seen.unsupported_samples as f64 * info.interval_s;
        let limit = 1e-3 * self.limits.unsupported_warning_ms;
        if passes(time, &mut seen.longest_unsupported_s, limit) {
            info.warnings.push(format!(
                "no roller has carried anything for {:.2} ms {}: the load hangs in the air. Start `preloaded`, or look at \
                 `bearing` for a clearance that the load cannot close",
                1e3 * time,
                when(info)
            ));
        }
    }

    fn places(&self, info: &RunInfo, machine: &Machine) -> Option<String> {
        let state = &machine.dynamics.state;
        let middle = |slots: &[u32], of: &[f64]| mean(slots.iter().map(|&n| of[n as usize]));
        let ring = [middle(&machine.outer, &state.x), middle(&machine.outer, &state.y)];
        for (i, roller) in machine.rollers.iter().enumerate() {
            let centre = roller.centre as usize;
            let radius = (state.x[centre] - ring[0]).hypot(state.y[centre] - ring[1]);
            if radius < self.annulus[0] || radius > self.annulus[1] {
                let through = if radius < self.annulus[0] { "inner" } else { "outer" };
                return Some(format!(
                    "roller {} has gone through the {through} raceway: its centre is {:.3} mm from that of the outer ring {}. Take a \
                     larger `contact.penalty_scale`, less `operation.load_n` or a smaller `solver.time_step_factor`",
                    i + 1,
                    1e3 * radius,
                    when(info)
                ));
            }
        }
        let height = middle(&machine.adapter, &state.y) - ring[1];
        let off = height - self.adapter_height;
        (off.abs() > self.seat).then(|| {
            format!(
                "the adapter has left its seat by {:.3} mm {}: take a larger `contact.penalty_scale`, or less \
                 `operation.load_n`",
                1e3 * off,
                when(info)
            )
        })
    }
}

/// Notes the largest value so far; true when it is the first above `limit`.
fn passes(value: f64, largest: &mut f64, limit: f64) -> bool {
    let first = value > limit && *largest <= limit;
    *largest = largest.max(value);
    first
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let n = values.len() as f64;
    values.sum::<f64>() / n
}

fn when(info: &RunInfo) -> String {
    format!("at step {}, t = {:.5} ms", info.steps, 1e3 * info.steps as f64 * info.time_step_s)
}

fn pair_name(machine: &Machine, pair: usize) -> String {
    let pairs = &machine.pairs;
    if pair == pairs.seat() {
        return "the adapter and the outer ring".to_owned();
    }
    let with = |i: usize, what: &str| format!("roller {} and the {what}", i + 1);
    (0..machine.rollers.len())
        .find_map(|i| match () {
            () if pairs.outer(i) == pair => Some(with(i, "outer raceway")),
            () if pairs.inner(i) == pair => Some(with(i, "inner raceway")),
            () if pairs.cage(i).contains(&pair) => Some(with(i, "cage")),
            () => None,
        })
        .unwrap_or_else(|| format!("the surfaces of pair {pair}"))
}

/// Where the fastest node is; one whose velocity is no number is faster than all others.
fn fastest(assembly: &Assembly, machine: &Machine) -> String {
    let d = &machine.dynamics;
    let s = &d.state;
    let speed = |n: usize| s.vx[n].hypot(s.vy[n]);
    let worse = |a: usize, b: usize| if speed(a) >= speed(b) || speed(a).is_nan() { a } else { b };
    let worst = (0..s.x.len()).filter(|&n| d.mass()[n] > 0.0).reduce(worse).unwrap_or(0);
    let node = d.layout().node_of_slot[worst].unwrap_or(0) as usize;
    let mesh = &assembly.model.mesh;
    let body = mesh.bodies.iter().find(|b| b.nodes.contains(&node)).map_or("", |b| b.name.as_str());
    format!(
        "in the {body} at x = {:.3} mm, y = {:.3} mm with {:.3e} m/s",
        1e3 * s.x[worst],
        1e3 * s.y[worst],
        speed(worst)
    )
}
