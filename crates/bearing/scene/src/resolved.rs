//! A scene in SI units: the one place where the millimetres, degrees and gigapascals of a file are converted
//! into the numbers that the program computes with.
//!
//! A scene is resolved once, where it enters: when a run begins or continues, when its folder is read, by a
//! command that plans or exports. From there on a [`ResolvedScene`] is passed.
//!
//! Where the rounding of a quotient may change a bit of a result, the numbers as written are used instead:
//! the ratios of diameters in [`Kinematics`](stribeck_theory::kinematics::Kinematics), the samples at which frames are written.

use std::f64::consts::{PI, TAU};

use stribeck_theory::catalogue::Element;
use stribeck_theory::contact_law::ContactLawKind;
use stribeck_theory::duty::Duty;
use stribeck_theory::lubrication::Oil;
use stribeck_theory::material::Material;

use crate::contact_formula::{as_hertz, length_of_balls};
use crate::deviation::{Relief, RollingSurface};
use crate::dice::Dice;
use crate::faults::rolling_circle;
use crate::scene::{
    BearingScene, CageScene, ContactFormula, DefectRing, DefectScene, FilmScene, PocketWalls, Scene,
    StructuralDampingScene,
};

/// A scene in SI: dimensions, material, mesh, contact, load and times, and the scene as written, for fields
/// without a unit to convert. Lengths are [m], angles [rad], counter-clockwise from the x axis.
///
/// ```
/// let scene = stribeck_scene::Scene::default().resolve();
/// assert_eq!(scene.written.bearing.roller_diameter_mm, 18.0);
/// assert!((scene.roller_radius - 9e-3).abs() < 1e-12);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct ResolvedScene {
    /// The scene as written: names, choices and counts.
    pub written: Scene,
    /// Speeds and load over time.
    pub duty: Duty,
    /// Radius of the outer raceway [m].
    pub outer_race_radius: f64,
    /// Radial thickness of the outer ring [m].
    pub outer_ring_thickness: f64,
    /// Law of the contacts of rolling elements and raceways.
    pub contact_law: ContactLawKind,
    /// Radius of the inner raceway [m].
    pub inner_race_radius: f64,
    /// Radial thickness of the inner ring [m].
    pub inner_ring_thickness: f64,
    /// Number of rolling elements.
    pub rollers: usize,
    /// Radius of a rolling element [m].
    pub roller_radius: f64,
    /// Out-of-plane thickness [m].
    pub thickness: f64,
    /// Length of the contacts of rolling elements [m]: of rollers the thickness, of balls that of cylinders which
    /// give way as they do under the load at the start.
    pub contact_length: f64,
    /// Diametral clearance [m]; below zero, rollers are pressed between the raceways.
    pub clearance: f64,
    /// Angle of the middle of the pocket of roller 1 [rad].
    pub first_roller_angle: f64,
    /// How far each roller starts from the middle of its pocket along its path, counter-clockwise [m]; empty:
    /// not at all.
    pub roller_offsets: Vec<f64>,
    /// Angle by which the meshes of all rollers are turned about their own centres [rad].
    pub roller_phase: f64,
    /// The cage, if there is one.
    pub cage: Option<CageGeometry>,
    /// Width of the adapter [m].
    pub adapter_width: f64,
    /// Height of the adapter above the crown of its seat [m].
    pub adapter_height: f64,
    /// Spalls with steep walls, which meshes of raceways are cut with.
    pub grooves: Vec<DefectGeometry>,
    /// Relief of the outer raceway: its deviations from round.
    pub outer_relief: Option<Relief>,
    /// The same of the inner raceway, at the start.
    pub inner_relief: Option<Relief>,
    /// Rolling elements that are not round, from 0, with their reliefs at the start.
    pub roller_reliefs: Vec<(usize, Relief)>,
    /// Material of every body.
    pub material: Material,
    /// Element edge [m].
    pub element_size: f64,
    /// Element edge that a graded mesh does not exceed [m]; `None` for a mesh of one size.
    pub coarse_size: Option<f64>,
    /// Penalty stiffness of contact [Pa/m].
    pub penalty_stiffness: f64,
    /// The same between the outer ring and its seat, which is no softer where balls are [Pa/m].
    pub seat_stiffness: f64,
    /// Mass of a surface layer on either side of a contact [kg/m²], for which its damping is reckoned.
    pub contact_layer_mass: f64,
    /// Gap at which contact of rollers sets in [m].
    pub contact_onset: f64,
    /// Oil between rollers and raceways, if there is any.
    pub film: Option<Oil>,
    /// Stiffness-proportional damping β [s].
    pub stiffness_damping: f64,
    /// Structural damping, if there is some.
    pub structural_damping: Option<DampedBand>,
    /// Gravity, downwards [m/s²].
    pub gravity: f64,
    /// Mass of the housing whose weight a foundation carries [kg].
    pub on_foundation: f64,
    /// Simulated time [s].
    pub duration: f64,
    /// Sampling interval [s].
    pub interval: f64,
    /// Angles of the sensors [rad], in the order of the scene.
    pub sensor_angles: Vec<f64>,
    /// Half the side of the square that frames keep [m]; `None` when no frames are kept.
    pub frame_half_width: Option<f64>,
}

/// How far straight walls of pockets reach beyond the path of the rollers' centres, in radii of a roller:
/// several facets, and farther than a roller that floats across its clearance or stands in a defect.
const BEYOND_PITCH_CIRCLE: f64 = 0.2;

/// The rigid cage.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CageGeometry {
    /// Outer radius [m].
    pub outer_radius: f64,
    /// Radial thickness [m].
    pub thickness: f64,
    /// Gap between a centred roller and its pocket wall [m].
    pub pocket_clearance: f64,
    /// Which part of a roller the walls of its pocket touch.
    pub pocket: PocketWalls,
}

/// The spall on a raceway.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DefectGeometry {
    /// Ring on whose raceway it lies.
    pub ring: DefectRing,
    /// Circumferential length [m], measured on the raceway.
    pub length: f64,
    /// Depth [m].
    pub depth: f64,
    /// Angle of its centre at the start [rad].
    pub angle: f64,
    /// Angle between its edges and the raceway [rad].
    pub edge_slope: f64,
}

/// A damping ratio over a band of frequencies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DampedBand {
    /// Damping ratio [-].
    pub ratio: f64,
    /// Ends of the band [Hz].
    pub band: [f64; 2],
}

impl Scene {
    /// The scene in SI.
    pub fn resolve(&self) -> ResolvedScene {
        ResolvedScene::of(self)
    }
}

impl ResolvedScene {
    /// Speeds and load over time where one of them varies.
    pub fn varying_duty(&self) -> Option<&Duty> {
        self.written.operation.varies().then_some(&self.duty)
    }

    /// The grooves in the raceway of this ring.
    pub fn grooves_of(&self, ring: DefectRing) -> impl Iterator<Item = &DefectGeometry> {
        self.grooves.iter().filter(move |groove| groove.ring == ring)
    }

    /// Facets that a whole turn of the raceway of `ring` would have at the mean spacing outside its grooves,
    /// of all its `facets`: floors are meshed as finely as the raceway, in two facets at least, and upright
    /// walls take no angle.
    pub fn facets_around(&self, ring: DefectRing, facets: usize) -> f64 {
        let radius = match ring {
            DefectRing::Outer => self.outer_race_radius,
            DefectRing::Inner => self.inner_race_radius,
        };
        let (mut rest, mut free) = (facets as f64, 1.0);
        for groove in self.grooves_of(ring) {
            let part = groove.length / (TAU * radius);
            rest -= (part * facets as f64).round().max(2.0) + 2.0;
            free -= part;
        }
        (rest / free).max(0.0)
    }

    fn of(scene: &Scene) -> Self {
        let mut resolved = Self::with_stated_contact(scene);
        let layer = resolved.penalty_stiffness;
        if scene.contact.formula == ContactFormula::Hertz {
            resolved.penalty_stiffness = scene.contact.penalty_scale * as_hertz(&resolved);
        } else if scene.element() == Element::Ball {
            resolved.penalty_stiffness *= resolved.contact_length / resolved.thickness;
        }
        resolved.seat_stiffness =
            if resolved.contact_law == ContactLawKind::Ball { layer } else { resolved.penalty_stiffness };
        resolved
    }

    fn with_stated_contact(scene: &Scene) -> Self {
        let b = &scene.bearing;
        let material = Material::from(&scene.material);
        let element_size = 1e-3 * scene.mesh.size_mm;
        let deviations = scene.deviations();
        let relief = |on: RollingSurface| {
            let [diameter_mm, facet_mm] = rolling_circle(scene, on);
            Relief::of(&deviations, on, 0.5e-3 * diameter_mm, facet_mm)
        };
        let larger = larger_by(b, scene.diameter_variation_um());
        let of_roller = |i: usize| {
            let formed = relief(RollingSurface::Roller(i + 1));
            let relief = match larger.get(i) {
                None => formed?,
                Some(by) => formed.unwrap_or(Relief::round(0.5e-3 * b.roller_diameter_mm)).raised(*by),
            };
            Some((i, relief))
        };
        let mut resolved = Self {
            written: scene.clone(),
            duty: scene.duty(),
            outer_race_radius: 0.5e-3 * b.outer_race_diameter_mm,
            outer_ring_thickness: 1e-3 * b.outer_ring_thickness_mm,
            contact_law: scene.contact_law(),
            inner_race_radius: 0.5e-3 * b.inner_race_diameter_mm - 0.5e-6 * b.clearance_change_um,
            inner_ring_thickness: 1e-3 * b.inner_ring_thickness_mm,
            rollers: b.rollers,
            roller_radius: 0.5e-3 * b.roller_diameter_mm,
            thickness: 1e-3 * b.thickness_mm,
            contact_length: 1e-3 * b.thickness_mm,
            clearance: 1e-6 * (b.clearance_um() + b.clearance_change_um),
            first_roller_angle: b.first_roller_deg.to_radians(),
            roller_offsets: scene
                .cage
                .iter()
                .flat_map(|c| &c.roller_offsets_um)
                .map(|um| 1e-6 * um)
                .collect(),
            roller_phase: scene.mesh.roller_phase_deg.to_radians(),
            cage: scene.cage.as_ref().map(CageGeometry::of),
            adapter_width: 1e-3 * scene.adapter.width_mm,
            adapter_height: 1e-3 * scene.adapter.height_mm,
            grooves: scene.grooves().iter().map(DefectGeometry::of).collect(),
            outer_relief: relief(RollingSurface::Outer),
            inner_relief: relief(RollingSurface::Inner),
            roller_reliefs: (0..b.rollers).filter_map(of_roller).collect(),
            element_size,
            coarse_size: scene.mesh.grading.as_ref().map(|grading| 1e-3 * grading.coarse_mm),
            penalty_stiffness: scene.contact.penalty_scale * material.youngs_modulus / element_size,
            seat_stiffness: scene.contact.penalty_scale * material.youngs_modulus / element_size,
            // Half an element deep: the mass of a surface's nodes.
            contact_layer_mass: 0.5 * material.density * element_size,
            contact_onset: 1e-6 * scene.contact.onset_um,
            film: scene.film.as_ref().map(oil),
            stiffness_damping: 1e-9 * scene.solver.stiffness_damping_ns,
            structural_damping: scene.solver.structural_damping.as_ref().map(DampedBand::of),
            gravity: scene.operation.gravity_m_s2,
            on_foundation: scene.housing.on_foundation_kg(b),
            duration: 1e-3 * scene.solver.duration_ms,
            interval: 1e-6 * scene.output.interval_us,
            sensor_angles: scene.output.sensors.iter().map(|sensor| sensor.angle_deg.to_radians()).collect(),
            frame_half_width: scene.output.frames.as_ref().map(|frames| 1e-3 * frames.half_width_mm),
            material,
        };
        if scene.element() == Element::Ball {
            resolved.contact_length = length_of_balls(&resolved);
            resolved.contact_layer_mass *= resolved.contact_length / resolved.thickness;
        }
        for (groove, defect) in
            scene.grooves().iter().enumerate().filter(|(_, defect)| defect.width_mm.is_some())
        {
            resolved.grooves[groove].depth = resolved.depth_of(defect);
        }
        resolved
    }

    /// Penetration over the element size above which a run warns that contact is too soft [%]: where it is as soft
    /// as balls, it does not before the run stops.
    pub fn soft_percent(&self) -> f64 {
        let guards = &self.written.guards;
        match self.contact_law {
            ContactLawKind::Ball => guards.penetration_stop_percent,
            _ => guards.penetration_warning_percent,
        }
    }

    /// Radius of the circle on which the centres of rollers run that touch the outer raceway [m].
    pub fn path_radius(&self) -> f64 {
        self.outer_race_radius - self.roller_radius
    }

    /// Angle of the middle of the pocket of roller `i`, from 0, at the start [rad].
    pub fn pocket_angle(&self, i: usize) -> f64 {
        self.first_roller_angle + TAU * i as f64 / self.rollers as f64
    }

    /// Angle of the centre of roller `i`, from 0, at the start [rad].
    pub fn roller_angle(&self, i: usize) -> f64 {
        let offset = self.roller_offsets.get(i).map_or(0.0, |along| along / self.path_radius());
        self.pocket_angle(i) + offset
    }

    /// Effective radius of a roller in the outer raceway, 1/(1/r − 1/R_o) [m].
    pub fn outer_contact_radius(&self) -> f64 {
        1.0 / (1.0 / self.roller_radius - 1.0 / self.outer_race_radius)
    }

    /// Effective radius of a roller on the inner raceway, 1/(1/r + 1/R_i) [m].
    pub fn inner_contact_radius(&self) -> f64 {
        1.0 / (1.0 / self.roller_radius + 1.0 / self.inner_race_radius)
    }
}

/// By how much the radius of each rolling element exceeds the nominal one [m]; none where all are alike.
fn larger_by(bearing: &BearingScene, variation_um: f64) -> Vec<f64> {
    let half = 0.5e-6 * variation_um;
    let mut dice = Dice::new(bearing.diameter_seed);
    let count = if half > 0.0 { bearing.rollers } else { 0 };
    (0..count).map(|_| half * (dice.share() - 0.5)).collect()
}

impl CageGeometry {
    /// A cage in SI.
    pub fn of(cage: &CageScene) -> Self {
        Self {
            outer_radius: 0.5e-3 * cage.outer_diameter_mm,
            thickness: 1e-3 * cage.thickness_mm,
            pocket_clearance: 1e-6 * cage.pocket_clearance_um,
            pocket: cage.pocket,
        }
    }

    /// Inner and outer radius of the cage itself [m].
    pub fn radii(&self) -> [f64; 2] {
        [self.outer_radius - self.thickness, self.outer_radius]
    }

    /// Radii between which the walls of pockets reach [m], for rollers of the radius `roller` whose centres
    /// run on the radius `path`.
    pub fn walls(&self, path: f64, roller: f64) -> [f64; 2] {
        let [inner, outer] = self.radii();
        match self.pocket {
            PocketWalls::Corners => [inner, outer],
            PocketWalls::Straight => {
                let beyond = BEYOND_PITCH_CIRCLE * roller;
                [inner.min(path - beyond), outer.max(path + beyond)]
            }
        }
    }
}

/// Half width of a pocket whose walls come within `reach` of the centre of a roller on radius `path`.
pub fn pocket_half_width(inner: f64, outer: f64, path: f64, reach: f64) -> f64 {
    if (inner..=outer).contains(&path) {
        return reach;
    }
    // The corner nearest to the pitch circle touches first: |corner − centre| = reach with the corner on
    // `edge`.
    let edge = if path < inner { inner } else { outer };
    let height = (edge * edge + path * path - reach * reach) / (2.0 * path);
    (edge * edge - height * height).max(0.0).sqrt().min(PI * edge)
}

impl DefectGeometry {
    /// A spall in SI.
    pub fn of(defect: &DefectScene) -> Self {
        // A right angle is one, whatever the rounding of its degrees.
        let upright = defect.edge_slope_deg == 90.0;
        Self {
            ring: defect.ring,
            length: 1e-3 * defect.length_mm,
            depth: 1e-3 * defect.depth_mm,
            angle: defect.angle_deg.to_radians(),
            edge_slope: if upright { 0.25 * TAU } else { defect.edge_slope_deg.to_radians() },
        }
    }
}

impl DampedBand {
    fn of(damping: &StructuralDampingScene) -> Self {
        Self { ratio: 1e-2 * damping.ratio_percent, band: [1e3 * damping.from_khz, 1e3 * damping.to_khz] }
    }
}

fn oil(film: &FilmScene) -> Oil {
    Oil {
        viscosity: film.viscosity_pa_s,
        pressure_viscosity: 1e-9 * film.pressure_viscosity_per_gpa,
        roughness: 1e-6 * film.roughness_um,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A product or two, and a decimal fraction that binary does not have.
    const ROUNDING: f64 = 1e-15;

    #[test]
    fn analytic_the_papers_bearing_in_si() {
        let scene = Scene::default();
        let g = scene.resolve();
        let defect = g.grooves[0];
        for (ours, theirs) in [
            (g.outer_race_radius, 0.1),
            (g.inner_race_radius, 0.08198),
            (g.roller_radius, 0.009),
            (g.path_radius(), 0.091),
            (g.element_size, 0.5e-3),
            (g.interval, 10e-6),
            (g.duration, 30e-3),
            (g.material.youngs_modulus, 200e9),
            // 0.05 · 200 GPa / 0.5 mm.
            (g.penalty_stiffness, 2e13),
            (defect.length, 10e-3),
            (defect.angle, 0.25 * TAU),
            (g.roller_angle(23), 79.0 / 360.0 * TAU + TAU),
        ] {
            assert!((ours / theirs - 1.0).abs() < ROUNDING, "{ours} instead of {theirs}");
        }
        // Table 1 leaves 40 µm; a difference of diameters has lost four digits.
        assert!((g.clearance / 40e-6 - 1.0).abs() < 1e4 * ROUNDING, "{}", g.clearance);
        // Johnson, Contact Mechanics (1985), §4.1: 9.89 mm in the outer raceway.
        assert!((g.outer_contact_radius() - 9.890e-3).abs() < 1e-6, "{}", g.outer_contact_radius());
        assert!((g.inner_contact_radius() - 8.110e-3).abs() < 1e-6, "{}", g.inner_contact_radius());
        let mut moved = scene.clone();
        moved.cage.iter_mut().for_each(|cage| cage.roller_offsets_um = vec![91.0; 24]);
        moved.mesh.roller_phase_deg = 90.0;
        let m = moved.resolve();
        // 91 µm on a path of 91 mm are a milliradian.
        assert!((m.roller_angle(5) - g.roller_angle(5) - 1e-3).abs() < 1e-12);
        assert_eq!((m.pocket_angle(5), m.roller_phase), (g.pocket_angle(5), 0.25 * TAU));
        let bare = Scene { cage: None, defect: None, ..scene };
        let bare = bare.resolve();
        assert!(bare.cage.is_none() && bare.grooves.is_empty());
    }

    /// Source: ISO 3290-1 (2014), V_DwL: the largest less the smallest mean diameter of a lot.
    #[test]
    fn analytic_diameters_lie_within_their_variation() {
        let with = |fields: &str| {
            let scene = Scene::default().with_overrides(&[fields.to_owned()]).expect("a scene");
            let reliefs = scene.resolve().roller_reliefs;
            reliefs.iter().map(|(_, relief)| relief.larger_by().expect("round")).collect::<Vec<f64>>()
        };
        let radii = with("bearing=(diameter_variation_um: 2.0)");
        let [low, high] =
            [radii.iter().copied().fold(1.0, f64::min), radii.iter().copied().fold(-1.0, f64::max)];
        assert_eq!(radii.len(), 24);
        assert!(2.0 * (high - low) <= 2e-6 && 2.0 * (high - low) > 1.5e-6, "{low} to {high}");
        assert_eq!(radii, with("bearing=(diameter_variation_um: 2.0)"));
        assert_ne!(radii, with("bearing=(diameter_variation_um: 2.0, diameter_seed: 2)"));
        assert!(with("bearing=(diameter_variation_um: 0.0)").is_empty());
    }
}
