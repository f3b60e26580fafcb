//! The range of every number and the spelling of every name.

use std::fmt;

use super::finding::{Finding, Remedy};
use super::wording::{number, shown};
use crate::advice::MOST_FRICTION;
use crate::deviation::{DeviationScene, FormScene, RollingSurface};
use crate::duty::LONGEST_RUN_S;
use crate::housing::HousingScene;
use crate::scene::{
    FilmScene, GradingScene, HarmonicScene, ModelScene, ProfileScene, RampScene, RecordsScene, ReducedScene,
    RingMeshScene, RotatingLoadScene, Scene, StructuralDampingScene,
};

/// Longest run [ms].
const LONGEST_MS: f64 = 1e3 * LONGEST_RUN_S;
/// Longest name of a scene or sensor: they become folder and channel names.
const MAX_NAME: usize = 64;
/// Most sensors: each adds a handful of channels to every sample.
const MAX_SENSORS: usize = 64;

/// An interval of valid values.
#[derive(Debug, Clone, Copy)]
struct Range {
    low: f64,
    low_included: bool,
    high: f64,
    high_included: bool,
}

/// 0 < x ≤ high.
const fn positive(high: f64) -> Range {
    Range { low: 0.0, low_included: false, high, high_included: true }
}

/// low ≤ x ≤ high.
const fn within(low: f64, high: f64) -> Range {
    Range { low, low_included: true, high, high_included: true }
}

impl Range {
    fn contains(self, x: f64) -> bool {
        let above = if self.low_included { x >= self.low } else { x > self.low };
        let below = if self.high_included { x <= self.high } else { x < self.high };
        above && below
    }
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (low, high) = (number(self.low), number(self.high));
        match (self.low_included, self.high_included) {
            (true, true) => write!(f, "{low} to {high}"),
            (true, false) => write!(f, "{low} or more, less than {high}"),
            (false, true) => write!(f, "more than {low}, at most {high}"),
            (false, false) => write!(f, "more than {low}, less than {high}"),
        }
    }
}

/// Everything outside its range.
pub(crate) fn findings(scene: &Scene) -> Vec<Finding> {
    let mut found: Vec<Finding> = numbers(scene).iter().filter_map(Number::finding).collect();
    found.extend(names(scene));
    found
}

/// Range of the number at `path`, `3 to 400`; `None` for a field that is no number.
pub(crate) fn allowed(path: &str) -> Option<String> {
    let mut scene = with_everything();
    allowed_in(&scene, path).or_else(|| {
        HousingScene::of_every_form().into_iter().find_map(|housing| {
            scene.housing = housing;
            allowed_in(&scene, path)
        })
    })
}

/// The same in a scene that has the field.
pub(crate) fn allowed_in(scene: &Scene, path: &str) -> Option<String> {
    numbers(scene).iter().find(|number| number.path == path).map(Number::allowed)
}

/// A scene in which no optional number is absent.
fn with_everything() -> Scene {
    let mut scene = Scene { model: ModelScene::Reduced(ReducedScene::default()), ..Scene::default() };
    scene.mesh.outer_facets = Some(1257);
    scene.mesh.inner_facets = Some(1030);
    scene.mesh.grading = Some(GradingScene::default());
    scene.solver.structural_damping = Some(StructuralDampingScene::default());
    scene.cage.iter_mut().for_each(|cage| cage.roller_offsets_um.push(0.0));
    scene.defects = DeviationScene::of_every_form();
    scene.film = Some(FilmScene::default());
    scene.output.records = Some(RecordsScene::default());
    scene.outer_ring_mesh = Some(RingMeshScene::default());
    scene.inner_ring_mesh = Some(RingMeshScene::default());
    // Between them they have the numbers of both kinds of profile.
    scene.operation.speed_profile = Some(ProfileScene::Ramp(RampScene::default()));
    scene.operation.load_profile = Some(ProfileScene::Harmonic(HarmonicScene::default()));
    scene.operation.outer_speed_profile.clone_from(&scene.operation.speed_profile);
    scene.operation.rotating_load = Some(RotatingLoadScene::default());
    // Not written where they have their defaults.
    (scene.operation.load_angle_deg, scene.operation.outer_speed_rpm) = (90.0, 100.0);
    scene.bearing.clearance_change_um = -10.0;
    let b = &mut scene.bearing;
    (b.pitch_mm, b.bore_mm, b.outside_mm, b.width_mm) = (Some(65.0), Some(50.0), Some(90.0), Some(20.0));
    scene
}

/// Ranges of speeds [rpm] and loads [N].
const SPEED: Range = within(-100_000.0, 100_000.0);
const LOAD: Range = positive(1e9);

/// Range of the values of the profile at `path`, in words, where `value` is outside.
pub(crate) fn refuses_in_profile(path: &str, value: f64) -> Option<String> {
    let (range, unit) = if path == LOAD_PROFILE { (LOAD, "N") } else { (SPEED, "rpm") };
    (!range.contains(value)).then(|| format!("{range} {unit}"))
}

/// Paths of the profiles.
pub(crate) const OUTER_RING_MESH: &str = "outer_ring_mesh";
pub(crate) const INNER_RING_MESH: &str = "inner_ring_mesh";
pub(crate) const SPEED_PROFILE: &str = "operation.speed_profile";
pub(crate) const OUTER_SPEED_PROFILE: &str = "operation.outer_speed_profile";
pub(crate) const LOAD_PROFILE: &str = "operation.load_profile";

/// The numbers of a profile.
fn in_profile(
    path: &str,
    profile: &ProfileScene,
    (range, unit): (Range, &'static str),
    add: &mut dyn FnMut(&str, f64, Range, &'static str),
) {
    match profile {
        ProfileScene::Ramp(ramp) => {
            add(&format!("{path}.from_ms"), ramp.from_ms, within(0.0, LONGEST_MS), "ms");
            add(&format!("{path}.to_ms"), ramp.to_ms, within(0.0, LONGEST_MS), "ms");
            add(&format!("{path}.to"), ramp.to, range, unit);
        }
        ProfileScene::Harmonic(sine) => {
            add(&format!("{path}.amplitude"), sine.amplitude, within(0.0, range.high), unit);
            add(&format!("{path}.hz"), sine.hz, positive(1e5), "Hz");
            add(&format!("{path}.phase_deg"), sine.phase_deg, within(-360.0, 360.0), "°");
        }
        ProfileScene::Points(points) => {
            for (i, (_, value)) in points.iter().enumerate() {
                add(&format!("{path}[{i}]"), *value, range, unit);
            }
        }
        ProfileScene::Table(_) => {}
    }
}

/// One number of the scene and its range.
struct Number {
    path: String,
    value: f64,
    range: Range,
    unit: &'static str,
}

impl Number {
    fn allowed(&self) -> String {
        format!("{} {}", self.range, self.unit).trim_end().to_owned()
    }

    fn finding(&self) -> Option<Finding> {
        let Self { path, value, range, unit } = self;
        if range.contains(*value) {
            return None;
        }
        let message = if value.is_finite() {
            format!("`{path}` is {}, outside its range", number(*value))
        } else {
            format!("`{path}` is {value}, which is not a finite number")
        };
        let mut remedy = Remedy::new(path, self.allowed());
        if *unit == "°" {
            remedy = remedy.number(value % 360.0, "the same angle");
        } else if *value < 0.0 && range.contains(-value) {
            remedy = remedy.number(-value, "without the minus sign");
        }
        Some(Finding::new(message, vec![remedy]))
    }
}

/// Takes a number of the scene: path, value, range, unit.
type Add<'a> = dyn FnMut(&str, f64, Range, &'static str) + 'a;

/// Every number of the scene, subject by subject. A test compares this list with the fields of [`Scene`].
fn numbers(scene: &Scene) -> Vec<Number> {
    let mut list = Vec::new();
    let mut add = |path: &str, value: f64, range: Range, unit: &'static str| {
        list.push(Number { path: path.to_owned(), value, range, unit });
    };
    let subjects = [
        numbers_of_model_and_bearing,
        numbers_of_housing,
        numbers_of_defects,
        numbers_of_mesh,
        numbers_of_operation,
        numbers_of_contact,
        numbers_of_solver,
        numbers_of_output,
    ];
    subjects.iter().for_each(|of| of(scene, &mut add));
    list
}

/// Numbers of the model, the bearing and its cage.
#[rustfmt::skip]
fn numbers_of_model_and_bearing(scene: &Scene, add: &mut Add<'_>) {
    let b = &scene.bearing;
    if let ModelScene::Reduced(reduced) = &scene.model {
        add("model.modes_khz", reduced.modes_khz, within(2.0, 300.0), "kHz");
        add("model.step_us", reduced.step_us, within(0.05, 5.0), "µs");
    }
    add("bearing.outer_race_diameter_mm", b.outer_race_diameter_mm, positive(20_000.0), "mm");
    add("bearing.outer_ring_thickness_mm", b.outer_ring_thickness_mm, positive(5_000.0), "mm");
    add("bearing.inner_race_diameter_mm", b.inner_race_diameter_mm, positive(20_000.0), "mm");
    add("bearing.inner_ring_thickness_mm", b.inner_ring_thickness_mm, positive(5_000.0), "mm");
    add("bearing.clearance_change_um", b.clearance_change_um, within(-1_000.0, 1_000.0), "µm");
    add("bearing.rollers", b.rollers as f64, within(3.0, 400.0), "");
    add("bearing.roller_diameter_mm", b.roller_diameter_mm, positive(5_000.0), "mm");
    add("bearing.thickness_mm", b.thickness_mm, positive(10_000.0), "mm");
    add("bearing.first_roller_deg", b.first_roller_deg, within(-360.0, 360.0), "°");
    let others = [("pitch", b.pitch_mm), ("bore", b.bore_mm), ("outside", b.outside_mm), ("width", b.width_mm)];
    for (name, mm) in others {
        if let Some(mm) = mm {
            add(&format!("bearing.{name}_mm"), mm, positive(20_000.0), "mm");
        }
    }
    if let Some(cage) = &scene.cage {
        add("cage.outer_diameter_mm", cage.outer_diameter_mm, positive(20_000.0), "mm");
        add("cage.thickness_mm", cage.thickness_mm, positive(5_000.0), "mm");
        add("cage.pocket_clearance_um", cage.pocket_clearance_um, within(0.0, 10_000.0), "µm");
        for (i, offset) in cage.roller_offsets_um.iter().enumerate() {
            add(&format!("cage.roller_offsets_um[{i}]"), *offset, within(-10_000.0, 10_000.0), "µm");
        }
    }
}

/// Numbers of the adapter or another housing, and of rings from files.
#[rustfmt::skip]
fn numbers_of_housing(scene: &Scene, add: &mut Add<'_>) {
    let adapter = &scene.adapter;
    add("adapter.width_mm", adapter.width_mm, positive(50_000.0), "mm");
    add("adapter.height_mm", adapter.height_mm, positive(50_000.0), "mm");
    match &scene.housing {
        HousingScene::Pedestal(pedestal) => {
            add("housing.width_mm", pedestal.width_mm, positive(50_000.0), "mm");
            add("housing.base_mm", pedestal.base_mm, positive(50_000.0), "mm");
            add("housing.top_mm", pedestal.top_mm, positive(50_000.0), "mm");
        }
        HousingScene::Rigid(rigid) => add("housing.mass_kg", rigid.mass_kg, within(0.0, 1e6), "kg"),
        HousingScene::Springs(springs) => {
            add("housing.stiffness_n_um", springs.stiffness_n_um, positive(1e6), "N/µm");
            add("housing.damping_n_s_m", springs.damping_n_s_m, within(0.0, 1e9), "N s/m");
            add("housing.mass_kg", springs.mass_kg, within(1e-3, 1e6), "kg");
        }
        HousingScene::Mesh(mesh) => add("housing.unit_mm", mesh.unit_mm, positive(1e6), "mm"),
        HousingScene::Adapter => {}
    }
    for (path, mesh) in [(OUTER_RING_MESH, &scene.outer_ring_mesh), (INNER_RING_MESH, &scene.inner_ring_mesh)] {
        if let Some(mesh) = mesh {
            add(&format!("{path}.unit_mm"), mesh.unit_mm, positive(1e6), "mm");
        }
    }
}

/// Numbers of the spall and of other deviations from round.
#[rustfmt::skip]
fn numbers_of_defects(scene: &Scene, add: &mut Add<'_>) {
    let b = &scene.bearing;
    if let Some(defect) = &scene.defect {
        add("defect.length_mm", defect.length_mm, positive(20_000.0), "mm");
        add("defect.depth_mm", defect.depth_mm, positive(5_000.0), "mm");
        add("defect.angle_deg", defect.angle_deg, within(-360.0, 360.0), "°");
        add("defect.edge_slope_deg", defect.edge_slope_deg, within(5.0, 90.0), "°");
    }
    for (i, deviation) in scene.defects.iter().enumerate() {
        let mut add = |name: &str, value: f64, range: Range, unit: &'static str| {
            add(&format!("defects[{i}].{name}"), value, range, unit);
        };
        if let RollingSurface::Roller(roller) = deviation.on {
            add("on", roller as f64, within(1.0, b.rollers as f64), "");
        }
        add("angle_deg", deviation.angle_deg, within(-360.0, 360.0), "°");
        match &deviation.form {
            FormScene::Spall(spall) => {
                add("form.length_mm", spall.length_mm, positive(20_000.0), "mm");
                add("form.depth_mm", spall.depth_mm, positive(5_000.0), "mm");
                add("form.edge_mm", spall.edge_mm, within(0.0, 5_000.0), "mm");
            }
            FormScene::Dent(dent) => {
                add("form.length_mm", dent.length_mm, positive(20_000.0), "mm");
                add("form.depth_mm", dent.depth_mm, positive(5_000.0), "mm");
                add("form.rim_um", dent.rim_um, within(0.0, 10_000.0), "µm");
            }
            FormScene::Profile(profile) => {
                for (k, point) in profile.points.iter().enumerate() {
                    add(&format!("form.points[{k}].at_mm"), point.at_mm, within(-20_000.0, 20_000.0), "mm");
                    add(&format!("form.points[{k}].depth_um"), point.depth_um, within(-10_000.0, 1e6), "µm");
                }
            }
            FormScene::Waviness(waviness) => {
                add("form.order", waviness.order as f64, within(1.0, 10_000.0), "");
                add("form.amplitude_um", waviness.amplitude_um, within(0.0, 1_000.0), "µm");
            }
            FormScene::Roughness(roughness) => {
                add("form.rq_um", roughness.rq_um, within(0.0, 100.0), "µm");
                add("form.longest_mm", roughness.longest_mm, positive(20_000.0), "mm");
                add("form.shortest_mm", roughness.shortest_mm, positive(20_000.0), "mm");
                add("form.seed", roughness.seed as f64, within(0.0, 1e9), "");
                add("form.slope", roughness.slope, within(0.0, 6.0), "");
            }
            FormScene::Diameter(diameter) => {
                add("form.larger_um", diameter.larger_um, within(-1_000.0, 1_000.0), "µm");
            }
            FormScene::Missing => {}
        }
    }
}

/// Numbers of material and mesh.
#[rustfmt::skip]
fn numbers_of_mesh(scene: &Scene, add: &mut Add<'_>) {
    let (material, mesh) = (&scene.material, &scene.mesh);
    add("material.youngs_modulus_gpa", material.youngs_modulus_gpa, positive(10_000.0), "GPa");
    let poisson = Range { low: 0.0, low_included: true, high: 0.5, high_included: false };
    add("material.poissons_ratio", material.poissons_ratio, poisson, "");
    add("material.density_kg_m3", material.density_kg_m3, positive(1e5), "kg/m³");
    add("mesh.size_mm", mesh.size_mm, positive(1_000.0), "mm");
    add("mesh.roller_facets", mesh.roller_facets as f64, within(8.0, 100_000.0), "");
    add("mesh.roller_phase_deg", mesh.roller_phase_deg, within(-360.0, 360.0), "°");
    if let Some(facets) = mesh.outer_facets {
        add("mesh.outer_facets", facets as f64, within(16.0, 1e6), "");
    }
    if let Some(facets) = mesh.inner_facets {
        add("mesh.inner_facets", facets as f64, within(16.0, 1e6), "");
    }
    if let Some(grading) = &mesh.grading {
        add("mesh.grading.coarse_mm", grading.coarse_mm, positive(1_000.0), "mm");
        add("mesh.grading.fine_layers", grading.fine_layers as f64, within(1.0, 1_000.0), "");
    }
}

/// Numbers of load, speed and their profiles.
#[rustfmt::skip]
fn numbers_of_operation(scene: &Scene, add: &mut Add<'_>) {
    let operation = &scene.operation;
    add("operation.load_n", operation.load_n, LOAD, "N");
    add("operation.load_angle_deg", operation.load_angle_deg, within(-360.0, 360.0), "°");
    add("operation.speed_rpm", operation.speed_rpm, SPEED, "rpm");
    add("operation.outer_speed_rpm", operation.outer_speed_rpm, SPEED, "rpm");
    add("operation.gravity_m_s2", operation.gravity_m_s2, within(0.0, 1_000.0), "m/s²");
    if let Some(profile) = &operation.speed_profile {
        in_profile(SPEED_PROFILE, profile, (SPEED, "rpm"), add);
    }
    if let Some(profile) = &operation.outer_speed_profile {
        in_profile(OUTER_SPEED_PROFILE, profile, (SPEED, "rpm"), add);
    }
    if let Some(profile) = &operation.load_profile {
        in_profile(LOAD_PROFILE, profile, (LOAD, "N"), add);
    }
    if let Some(rotating) = &operation.rotating_load {
        add("operation.rotating_load.force_n", rotating.force_n, LOAD, "N");
        add("operation.rotating_load.angle_deg", rotating.angle_deg, within(-360.0, 360.0), "°");
    }
}

/// Numbers of contact and oil.
#[rustfmt::skip]
fn numbers_of_contact(scene: &Scene, add: &mut Add<'_>) {
    let contact = &scene.contact;
    add("contact.points_per_facet", contact.points_per_facet as f64, within(1.0, 16.0), "");
    add("contact.penalty_scale", contact.penalty_scale, positive(1_000.0), "");
    add("contact.onset_um", contact.onset_um, within(0.0, 20.0), "µm");
    add("contact.damping_ratio", contact.damping_ratio, within(0.0, 1.0), "");
    add("contact.friction", contact.friction, within(0.0, MOST_FRICTION), "");
    add("contact.seat_friction", contact.seat_friction, within(0.0, 2.0), "");
    if let Some(film) = &scene.film {
        // From petrol to honey.
        add("film.viscosity_pa_s", film.viscosity_pa_s, within(1e-4, 10.0), "Pa s");
        add("film.pressure_viscosity_per_gpa", film.pressure_viscosity_per_gpa, within(1.0, 100.0), "1/GPa");
        add("film.roughness_um", film.roughness_um, within(0.01, 10.0), "µm");
    }
}

/// Numbers of time integration and damping.
#[rustfmt::skip]
fn numbers_of_solver(scene: &Scene, add: &mut Add<'_>) {
    let solver = &scene.solver;
    add("solver.duration_ms", solver.duration_ms, positive(LONGEST_MS), "ms");
    // Above 1 a run diverges and is stopped: used by studies of stability.
    add("solver.time_step_factor", solver.time_step_factor, positive(1.5), "");
    add("solver.hourglass_scale", solver.hourglass_scale, positive(10.0), "");
    add("solver.mass_damping_per_s", solver.mass_damping_per_s, within(0.0, 1e6), "1/s");
    add("solver.stiffness_damping_ns", solver.stiffness_damping_ns, within(0.0, 1e4), "ns");
    if let Some(damping) = &solver.structural_damping {
        add("solver.structural_damping.ratio_percent", damping.ratio_percent, positive(10.0), "%");
        add("solver.structural_damping.from_khz", damping.from_khz, positive(1e4), "kHz");
        add("solver.structural_damping.to_khz", damping.to_khz, positive(1e5), "kHz");
        add("solver.structural_damping.branches", damping.branches as f64, within(1.0, 3.0), "");
    }
}

/// Numbers of output and guards.
#[rustfmt::skip]
fn numbers_of_output(scene: &Scene, add: &mut Add<'_>) {
    let (output, guards) = (&scene.output, &scene.guards);
    add("output.interval_us", output.interval_us, within(0.01, 1e6), "µs");
    add("guards.energy_warning_percent", guards.energy_warning_percent, positive(1e6), "%");
    add("guards.energy_stop_percent", guards.energy_stop_percent, positive(1e6), "%");
    add("guards.hourglass_warning_percent", guards.hourglass_warning_percent, positive(1e6), "%");
    add("guards.penetration_warning_percent", guards.penetration_warning_percent, positive(200.0), "%");
    add("guards.penetration_stop_percent", guards.penetration_stop_percent, positive(200.0), "%");
    add("guards.area_stop_percent", guards.area_stop_percent, within(0.0, 99.0), "%");
    add("guards.unsupported_warning_ms", guards.unsupported_warning_ms, positive(LONGEST_MS), "ms");
    for (i, sensor) in output.sensors.iter().enumerate() {
        add(&format!("output.sensors[{i}].angle_deg"), sensor.angle_deg, within(-360.0, 360.0), "°");
    }
    if let Some(frames) = &output.frames {
        add("output.frames.from_ms", frames.from_ms, within(0.0, LONGEST_MS), "ms");
        add("output.frames.to_ms", frames.to_ms, within(0.0, LONGEST_MS), "ms");
        add("output.frames.every_us", frames.every_us, positive(1e6), "µs");
        add("output.frames.half_width_mm", frames.half_width_mm, positive(20_000.0), "mm");
    }
    if let Some(records) = &output.records {
        add("output.records.rate_hz", records.rate_hz, within(100.0, 1e6 / output.interval_us), "Hz");
        for (i, noise) in records.noise_db.iter().enumerate() {
            add(&format!("output.records.noise_db[{i}]"), *noise, within(-100.0, 60.0), "dB");
        }
    }
}

/// Names that cannot be folders or channels, and sensors that share one.
fn names(scene: &Scene) -> Vec<Finding> {
    const NAME: &str = "letters, digits, `_` and `-`, a letter or digit first, at most 64 characters";
    const SENSOR: &str = "letters, digits and `_`, a letter first, at most 64 characters";
    let mut found = Vec::new();
    let plain = |name: &str, extra: &str| {
        name.len() <= MAX_NAME && name.chars().all(|c| c.is_ascii_alphanumeric() || extra.contains(c))
    };
    if !(plain(&scene.name, "_-") && scene.name.starts_with(|c: char| c.is_ascii_alphanumeric())) {
        found.push(bad_name("name".to_owned(), &scene.name, NAME));
    }
    let sensors = &scene.output.sensors;
    if sensors.is_empty() || sensors.len() > MAX_SENSORS {
        let remedy = Remedy::new("output.sensors", format!("1 to {MAX_SENSORS} sensors"))
            .value("[(name: \"side\", angle_deg: 0.0)]", "the report needs one acceleration at least");
        found.push(Finding::new(format!("`output.sensors` has {} entries", sensors.len()), vec![remedy]));
    }
    for (i, sensor) in sensors.iter().enumerate() {
        let path = format!("output.sensors[{i}].name");
        if !(plain(&sensor.name, "_") && sensor.name.starts_with(|c: char| c.is_ascii_alphabetic())) {
            found.push(bad_name(path, &sensor.name, SENSOR));
        } else if let Some(first) = sensors[..i].iter().position(|other| other.name == sensor.name) {
            let message = format!("sensors {first} and {i} are both called `{}`", sensor.name);
            let remedies = [path, format!("output.sensors[{first}].name")];
            found.push(Finding::new(message, remedies.map(|field| another_name(field, &sensor.name)).into()));
        }
    }
    found
}

/// Most names that are tried in search of a free one.
const NAMES_TRIED: usize = 9;

/// A name beside `name`; whether it is free is tried later.
fn another_name(field: String, name: &str) -> Remedy {
    let stem: String = name.chars().take(MAX_NAME - 2).collect();
    let remedy = Remedy::new(field, "a name of its own for each sensor");
    (2..=NAMES_TRIED).fold(remedy, |remedy, n| remedy.value(format!("\"{stem}_{n}\""), ""))
}

fn bad_name(path: String, name: &str, allowed: &str) -> Finding {
    let mut kept: String = name.chars().filter(|c| c.is_ascii_alphanumeric() || *c == '_').take(20).collect();
    if !kept.starts_with(|c: char| c.is_ascii_alphabetic()) {
        kept.insert(0, 's');
    }
    let message = format!("`{path}` is \"{}\", which cannot name a folder or a channel", shown(name));
    let remedy = Remedy::new(path, allowed).value(format!("\"{kept}\""), "");
    let remedy = (2..=NAMES_TRIED).fold(remedy, |remedy, n| remedy.value(format!("\"{kept}_{n}\""), ""));
    Finding::new(message, vec![remedy])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn behaves_every_number_of_a_scene_has_a_range() {
        for housing in HousingScene::of_every_form() {
            let scene = Scene { housing, ..with_everything() };
            let text = scene.to_ron();
            let outline = super::super::outline::Outline::of(&text);
            let listed: Vec<String> = numbers(&scene).into_iter().map(|number| number.path).collect();
            for entry in &outline.entries {
                let is_number = text[entry.value.clone()].parse::<f64>().is_ok();
                assert_eq!(is_number, listed.contains(&entry.path), "{}", entry.path);
            }
            for path in &listed {
                assert!(outline.get(path).is_some(), "{path} is not a field");
            }
        }
    }

    #[test]
    fn behaves_the_defaults_are_in_range() {
        assert_eq!(findings(&Scene::default()).len(), 0);
    }
}
