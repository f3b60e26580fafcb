//! `bearing: "NU 205"`: all dimensions of a bearing from its designation, and its surroundings unless the
//! file gives them.
//!
//! Dimensions that no catalogue prints are in proportion to the paper's bearing: the mesh has as many facets,
//! contact the same pressure.

use stribeck_theory::catalogue::{
    Boundary, CatalogueBearing, Element, PAPER, beyond_a_plane, normal_clearance_mm, plain,
};

use super::own::{self, Own};
use crate::catalogue;
use crate::housing::{HousingScene, PedestalScene};
use crate::scene::{
    BearingScene, CageScene, ContactFormula, ContactInterpolation, ContactSurface, DefectScene, ElementKind,
    FramesScene, GradingScene, ModelScene, PocketWalls, ReducedScene, Scene,
};

/// Length of a roller over the width of its ring, between flanges.
pub(super) const ROLLER_LENGTH: f64 = 0.6;

/// Thickness of the model [mm] of a bearing with rings of this width: that of rollers, with balls that of the rings.
pub(super) fn length_in(width_mm: f64, element: Element) -> f64 {
    if element == Element::Ball { width_mm } else { ROLLER_LENGTH * width_mm }
}

pub(crate) fn designation(value: &str) -> Option<String> {
    let inner = value.trim().strip_prefix('"')?.strip_suffix('"')?;
    (!inner.contains('"')).then(|| inner.to_owned())
}

/// Room between the outer raceway and a cage with corners, and its thickness, in diameters of a roller: it
/// lies outside of the pitch circle then, as that of the paper's bearing.
pub(super) const OFF_RACE: f64 = 0.22;

/// Friction of steel on steel in oil. With that of the paper's scene, a tenth of it, small bearings skid.
const FRICTION: f64 = 0.05;

/// Sets the bearing of the scene, and its surroundings as far as the user did not write them; `given` has the
/// paths of written fields.
pub(crate) fn put(scene: &mut Scene, name: &str, given: &[String]) -> Result<(), String> {
    let fields = "give it by its fields, `bearing: (rollers: 13, roller_diameter_mm: 7.5, …)`";
    let known = catalogue::parse_or_advise(name, fields)?;
    let paper = Scene::default();
    // Omitted fields are those of the paper's scene.
    if known.name == PAPER {
        let own = catalogue::of_scene(&paper);
        let off = [known.diameter_mm - own.diameter_mm, known.pitch_mm - own.pitch_mm, known.angle_deg];
        if off.iter().any(|off| off.abs() > 1e-6) {
            return Err(
                "the paper's bearing takes `elements` beside its name; give other diameters as fields \
                of `bearing`"
                    .into(),
            );
        }
        scene.bearing.rollers = known.elements.map_or(paper.bearing.rollers, |n| n as usize);
        return Ok(());
    }
    let bearing = beside_the_name(&scene.bearing, of(&known)?, given);
    if !given.iter().any(|path| path == "name") {
        scene.name = plain_name(&known.name);
    }
    surround(scene, Surrounded { bearing, pitch_mm: known.pitch_mm, element: known.element }, given);
    Ok(())
}

/// The designation of a group of fields that gives no dimension: `bearing: (designation: "NU 205",
/// clearance_change_um: -10)` is that bearing of the catalogue.
pub(super) fn alone(bearing: &BearingScene, given: &[String]) -> Option<String> {
    let of_bearing = |path: &String| path.strip_prefix("bearing.").map(str::to_owned);
    let is_named = catalogue::parse(&bearing.designation).is_ok_and(|known| known.name != PAPER);
    let gives_dimensions = || given.iter().filter_map(of_bearing).any(|field| OF_A_NAME.contains(&&*field));
    (is_named && !gives_dimensions()).then(|| bearing.designation.clone())
}

/// Fields of a bearing that follow from its name; all others may stand beside it.
const OF_A_NAME: [&str; 11] = [
    "outer_race_diameter_mm",
    "outer_ring_thickness_mm",
    "inner_race_diameter_mm",
    "inner_ring_thickness_mm",
    "roller_diameter_mm",
    "thickness_mm",
    "pitch_mm",
    "bore_mm",
    "outside_mm",
    "width_mm",
    "assumed",
];

/// A bearing of the catalogue with what a scene says beside its name.
fn beside_the_name(said: &BearingScene, of_name: BearingScene, given: &[String]) -> BearingScene {
    let written = |field: &str| given.iter().any(|path| path.strip_prefix("bearing.") == Some(field));
    let mut bearing = BearingScene {
        designation: of_name.designation,
        element: of_name.element,
        outer_race_diameter_mm: of_name.outer_race_diameter_mm,
        outer_ring_thickness_mm: of_name.outer_ring_thickness_mm,
        inner_race_diameter_mm: of_name.inner_race_diameter_mm,
        inner_ring_thickness_mm: of_name.inner_ring_thickness_mm,
        roller_diameter_mm: of_name.roller_diameter_mm,
        thickness_mm: of_name.thickness_mm,
        pitch_mm: None,
        bore_mm: None,
        outside_mm: None,
        width_mm: None,
        assumed: of_name.assumed,
        ..said.clone()
    };
    if !written("rollers") {
        bearing.rollers = of_name.rollers;
    }
    if !written("first_roller_deg") {
        bearing.first_roller_deg = first_roller(bearing.rollers);
    }
    if !written("clearance_change_um") {
        bearing.clearance_change_um = 0.0;
    }
    bearing
}

/// A designation as the name of a folder.
pub(super) fn plain_name(designation: &str) -> String {
    designation.to_lowercase().replace(|c: char| !c.is_ascii_alphanumeric(), "-")
}

/// A bearing, its pitch diameter [mm], without clearance, and its elements.
pub(super) struct Surrounded {
    pub(super) bearing: BearingScene,
    pub(super) pitch_mm: f64,
    pub(super) element: Element,
}

/// Sets the bearing of a scene and, in proportion to the paper's, all surroundings that the user did not
/// give: cage, housing, defect, elements, contact, load and pictures.
pub(super) fn surround(scene: &mut Scene, of: Surrounded, all: &[String]) {
    let Surrounded { bearing, pitch_mm, element } = of;
    let given = |path: &str| all.iter().any(|written| written == path);
    let paper = Scene::default();
    let size = bearing.roller_diameter_mm / paper.bearing.roller_diameter_mm;
    let outside = |b: &BearingScene| b.outer_race_diameter_mm + 2.0 * b.outer_ring_thickness_mm;
    let across = outside(&bearing) / outside(&paper.bearing);
    let follow = |path: &str, field: &mut f64, value: f64| {
        if !given(path) {
            *field = to_digits(3, value);
        }
    };
    if let Some(cage) = &mut scene.cage {
        let roller = bearing.roller_diameter_mm;
        if !given("cage.pocket") {
            cage.pocket = PocketWalls::Corners;
        }
        // Corners hold a cage across where they touch rollers above their middles, straight walls where they
        // reach to both sides.
        let [outer, thick] = match cage.pocket {
            PocketWalls::Corners => [bearing.outer_race_diameter_mm - OFF_RACE * roller, OFF_RACE * roller],
            PocketWalls::Straight => [pitch_mm + 0.4 * roller, 0.4 * roller],
        };
        follow("cage.outer_diameter_mm", &mut cage.outer_diameter_mm, outer);
        follow("cage.thickness_mm", &mut cage.thickness_mm, thick);
        let room = size * CageScene::default().pocket_clearance_um;
        follow("cage.pocket_clearance_um", &mut cage.pocket_clearance_um, room);
    }
    follow("adapter.width_mm", &mut scene.adapter.width_mm, across * paper.adapter.width_mm);
    follow("adapter.height_mm", &mut scene.adapter.height_mm, across * paper.adapter.height_mm);
    if let Some(defect) = &mut scene.defect {
        let of_paper = DefectScene::default();
        follow("defect.length_mm", &mut defect.length_mm, size * of_paper.length_mm);
        follow("defect.depth_mm", &mut defect.depth_mm, size * of_paper.depth_mm);
    }
    follow("contact.friction", &mut scene.contact.friction, FRICTION);
    // The same pressure where rollers carry the same share; balls as if their rings had rollers.
    let area = |b: &BearingScene| b.rollers as f64 * b.roller_diameter_mm * b.thickness_mm;
    let load = paper.operation.load_n * area(&bearing) / area(&paper.bearing);
    let load = if element == Element::Ball { ROLLER_LENGTH * load } else { load };
    follow("operation.load_n", &mut scene.operation.load_n, load);
    let [least, most] = scene.duty().speed_range_rpm(0.0, 1e-3 * scene.solver.duration_ms);
    if let Some(frames) = &mut scene.output.frames {
        let of_paper = FramesScene::default();
        follow("output.frames.half_width_mm", &mut frames.half_width_mm, size * of_paper.half_width_mm);
        // Roller 1 begins as far before the defect in parts of the pitch, which passes with each roller.
        let passing = |b: &BearingScene, rpm: f64| {
            let pitch = 0.5 * (b.outer_race_diameter_mm + b.inner_race_diameter_mm);
            rpm * b.rollers as f64 * b.inner_race_diameter_mm / pitch
        };
        let fastest = least.abs().max(most.abs());
        // A shaft that stands passes nothing: its pictures are as good at any time.
        let fastest = if fastest > 0.0 { fastest } else { paper.operation.speed_rpm };
        let slower =
            passing(&paper.bearing, paper.operation.speed_rpm) / passing(&bearing, fastest.max(1e-3));
        let until = scene.solver.duration_ms;
        // The reduced model has none, whenever they would begin.
        let latest = if scene.model == ModelScene::Full { until } else { f64::INFINITY };
        follow("output.frames.from_ms", &mut frames.from_ms, (slower * of_paper.from_ms).min(latest));
        let to = (slower * of_paper.to_ms).min(until);
        follow("output.frames.to_ms", &mut frames.to_ms, to);
        let every = (slower * of_paper.every_us).max(scene.output.interval_us);
        follow("output.frames.every_us", &mut frames.every_us, every);
    }
    scene.bearing = bearing;
    elements(scene, &given);
    house(scene, &given);
    modes(scene, &given);
    contact(scene, all);
}

/// Outside diameter of a scene's bearing over that of the paper's.
fn across(scene: &Scene) -> f64 {
    let outside = |b: &BearingScene| b.outer_race_diameter_mm + 2.0 * b.outer_ring_thickness_mm;
    outside(&scene.bearing) / outside(&BearingScene::default())
}

/// What follows from the bearing in a field that an argument has replaced as a whole:
/// `--set housing=pedestal()` is a pedestal of that bearing's size.
/// `holds_size` where the file or the scene so far has another element size than follows from its bearing.
pub(super) fn follow_bearing(scene: &mut Scene, replaced: &str, holds_size: bool, all: &[String]) {
    let given = |path: &str| all.iter().any(|written| written == path);
    let papers = own::is_papers(&scene.bearing);
    let is_hertz = scene.contact.formula == ContactFormula::Hertz;
    match replaced {
        "housing" => {
            house(scene, &given);
            scene.record_no_faster(all);
        }
        "output.interval_us" => scene.record_no_faster(all),
        "model" => modes(scene, &given),
        "mesh" if !papers => elements(scene, &given),
        "mesh.grading" if !papers => {
            elements(scene, &|path| path == SIZE || given(path));
        }
        "mesh.roller_facets" if !papers && !holds_size => {
            elements(scene, &|path| path != SIZE || given(path));
        }
        "contact.formula" => as_stiff_as_hertz(scene, all),
        "contact.penalty_scale" if !given("contact.formula") && is_hertz => {
            scene.contact.formula = ContactFormula::ElementLayer;
        }
        _ => {}
    }
}

/// Field of the element size.
pub(super) const SIZE: &str = "mesh.size_mm";

/// Whether the elements of a scene have the size that follows from its bearing.
pub(super) fn size_follows(scene: &Scene) -> bool {
    let mut same = scene.clone();
    elements(&mut same, &|path| path != SIZE);
    same.mesh.size_mm == scene.mesh.size_mm
}

/// Element sizes, in proportion to rolling elements with that number of facets, where the user gave none.
fn elements(scene: &mut Scene, given: &dyn Fn(&str) -> bool) {
    let paper = Scene::default();
    let size = scene.bearing.roller_diameter_mm / paper.bearing.roller_diameter_mm;
    let facets = paper.mesh.roller_facets as f64 / scene.mesh.roller_facets as f64;
    if !given(SIZE) {
        scene.mesh.size_mm = to_digits(3, size * facets * paper.mesh.size_mm);
    }
    if let Some(grading) = &mut scene.mesh.grading
        && !given("mesh.grading.coarse_mm")
    {
        grading.coarse_mm = to_digits(3, size * GradingScene::default().coarse_mm);
    }
}

/// Dimensions of a pedestal, in proportion to the bearing, where the user gave none.
fn house(scene: &mut Scene, given: &dyn Fn(&str) -> bool) {
    let across = across(scene);
    let HousingScene::Pedestal(pedestal) = &mut scene.housing else { return };
    let of_paper = PedestalScene::default();
    for (path, field, value) in [
        ("housing.width_mm", &mut pedestal.width_mm, of_paper.width_mm),
        ("housing.base_mm", &mut pedestal.base_mm, of_paper.base_mm),
        ("housing.top_mm", &mut pedestal.top_mm, of_paper.top_mm),
    ] {
        if !given(path) {
            *field = to_digits(3, across * value);
        }
    }
}

/// Modes of rings smaller or larger than the paper's, where the user gave none: small bearings with 60 kHz
/// have nearly the forces of the full model (docs/guide/src/reduced.md), and 30 kHz are as good for the paper's.
fn modes(scene: &mut Scene, given: &dyn Fn(&str) -> bool) {
    let across = across(scene);
    if let ModelScene::Reduced(reduced) = &mut scene.model
        && !given("model.modes_khz")
    {
        let khz = ReducedScene::default().modes_khz / across.sqrt();
        reduced.modes_khz = to_digits(2, khz.clamp(2.0, 300.0));
    }
}

/// Contact of any bearing but the paper's, where the user stated none: round, of one compliance at and between nodes,
/// and as soft as steel. A penalty scale alone is that of an element layer.
pub(super) fn contact(scene: &mut Scene, given: &[String]) {
    let written = |path: &str| given.iter().any(|written| written == path);
    if !written("contact.surface") {
        scene.contact.surface = ContactSurface::Arc;
    }
    if !written("contact.interpolation") {
        scene.contact.interpolation = ContactInterpolation::Spline;
    }
    if !written("contact.formula") && !written("contact.penalty_scale") {
        scene.contact.formula = ContactFormula::Hertz;
    }
    as_stiff_as_hertz(scene, given);
}

/// Once the stiffness of Hertz, where the user asked for it and gave no multiple.
pub(super) fn as_stiff_as_hertz(scene: &mut Scene, given: &[String]) {
    let is_given = given.iter().any(|written| written == "contact.penalty_scale");
    if scene.contact.formula == ContactFormula::Hertz && !is_given {
        scene.contact.penalty_scale = 1.0;
    }
}

/// Rings and rolling elements of a bearing in the catalogue.
fn of(known: &CatalogueBearing) -> Result<BearingScene, String> {
    let name = &known.name;
    if let Some(why) = beyond_a_plane(&plain(name)).filter(|_| known.boundary.is_none()) {
        return Err(format!("`{name}` is {why}"));
    }
    if known.angle_deg != 0.0 {
        return Err(format!(
            "`{name}` has a contact angle of {}°, and a plane model has none: its rows share the load along \
             the shaft, too",
            known.angle_deg
        ));
    }
    let (ball, pitch) = (known.diameter_mm, known.pitch_mm);
    let count = known.elements.map_or(known.usual_elements(), |n| n as usize);
    let Some(Boundary { bore_mm, outside_mm, width_mm }) = known.boundary else {
        if known.elements.is_none() {
            return Err(format!("`{name}` lacks the number of its rolling elements: give `elements=…`"));
        }
        let element = if known.element == Element::Ball { ElementKind::Ball } else { ElementKind::Roller };
        let (raceways, bore, outside, width) = (None, None, None, None);
        let own = Own { element, rollers: count, roller: ball, pitch, raceways, bore, outside, width };
        return Ok(BearingScene { designation: name.clone(), ..own.bearing() });
    };
    let clearance = normal_clearance_mm(known.element, bore_mm);
    // The distance of the rings is that of the catalogue; the clearance is taken from the rollers, or from
    // the groove of the outer ring.
    let (roller, outer) = match known.element {
        Element::Roller => (ball - 0.5 * clearance, pitch + ball),
        Element::Ball => (ball, pitch + ball + clearance),
    };
    let inner = pitch - ball;
    Ok(BearingScene {
        designation: name.clone(),
        outer_race_diameter_mm: tidy(outer),
        outer_ring_thickness_mm: tidy(0.5 * (outside_mm - outer)),
        inner_race_diameter_mm: tidy(inner),
        inner_ring_thickness_mm: tidy(0.5 * (inner - bore_mm)),
        rollers: count,
        roller_diameter_mm: tidy(roller),
        thickness_mm: tidy(length_in(width_mm, known.element)),
        first_roller_deg: first_roller(count),
        ..BearingScene::default()
    })
}

/// Angle of roller 1 [°]: as far before the middle of the load zone, in pitches, as in the paper's bearing.
pub(super) fn first_roller(rollers: usize) -> f64 {
    tidy(90.0 + 4.0 * 24.0 / rollers as f64)
}

impl Scene {
    /// Lets the record of a machine have no more samples a second than the run, where the user gave it no rate;
    /// `given` has the paths of written fields.
    pub(crate) fn record_no_faster(&mut self, given: &[String]) {
        let most_hz = 1e6 / self.output.interval_us;
        let HousingScene::Machine(machine) = &mut self.housing else { return };
        // A file that is read later has a rate of its own.
        if machine.file.is_empty() && !given.iter().any(|path| path == "housing.sensor.rate_hz") {
            machine.sensor.rate_hz = machine.sensor.rate_hz.min(most_hz);
        }
    }
}

/// A dimension to a few micrometres.
pub(super) fn tidy(number: f64) -> f64 {
    to_digits(5, number)
}

/// A number rounded as a person would write it into a scene.
fn to_digits(digits: i32, number: f64) -> f64 {
    if number == 0.0 || !number.is_finite() {
        return number;
    }
    let scale = 10_f64.powi(digits - 1 - number.abs().log10().floor() as i32);
    (number * scale).round() / scale
}
