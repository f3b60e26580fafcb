//! Numbers of a scene for the theory of rolling bearings, and what the theory says of the scene.

use std::f64::consts::PI;

use stribeck_theory::bearing::{Bearing, Dimensions, Ring};
use stribeck_theory::catalogue::{self, Element};
use stribeck_theory::kinematics::{Kinematics, Stretch};
use stribeck_theory::line_contact::LineContacts;
use stribeck_theory::lubrication::{self, LoadedFilm};
use stribeck_theory::material::Material;
use stribeck_theory::point_contact::{self, CONFORMITY};
use stribeck_theory::ring_stiffness::TurningRings;
use stribeck_theory::static_load::{RigidRings, StaticLoad};
use stribeck_theory::{Error, contact_law::ContactLawKind, load_rating};

use crate::deviation::RollingSurface;
use crate::duty::LONGEST_RUN_S;
use crate::resolved::ResolvedScene;
use crate::scene::{
    BearingScene, ContactFormula, DefectRing, DefectScene, ElementKind, MaterialScene, ModelScene,
    RollerProfile, Scene,
};

/// Half the sampling rate over the rate of the impacts, below which an envelope has no band for them [-].
const IMPACTS: f64 = 10.0;

impl From<&BearingScene> for Dimensions {
    fn from(bearing: &BearingScene) -> Self {
        Self {
            outer_race_mm: bearing.outer_race_diameter_mm,
            inner_race_mm: bearing.inner_race_diameter_mm,
            roller_mm: bearing.roller_diameter_mm,
            rollers: bearing.rollers,
        }
    }
}

impl From<&ResolvedScene> for Bearing {
    fn from(scene: &ResolvedScene) -> Self {
        Self {
            outer_race_radius: scene.outer_race_radius,
            inner_race_radius: scene.inner_race_radius,
            outer_ring_thickness: scene.outer_gives_way().then_some(scene.outer_ring_thickness),
            inner_ring_thickness: scene.inner_ring_thickness,
            roller_radius: scene.roller_radius,
            rollers: scene.rollers,
            clearance: scene.clearance,
            thickness: scene.contact_length,
            material: scene.material,
        }
    }
}

impl From<&MaterialScene> for Material {
    fn from(material: &MaterialScene) -> Self {
        Self {
            youngs_modulus: 1e9 * material.youngs_modulus_gpa,
            poissons_ratio: material.poissons_ratio,
            density: material.density_kg_m3,
        }
    }
}

impl From<&DefectScene> for Stretch {
    fn from(defect: &DefectScene) -> Self {
        let ring = match defect.ring {
            DefectRing::Outer => Ring::Outer,
            DefectRing::Inner => Ring::Inner,
        };
        Self { ring, length: 1e-3 * defect.length_mm, angle_deg: defect.angle_deg }
    }
}

impl Scene {
    /// Speeds of the bearing at the start.
    pub fn kinematics(&self) -> Kinematics {
        let duty = self.duty();
        Kinematics::between(&self.bearing, duty.speed_rpm(0.0), duty.outer_speed_rpm(0.0))
    }

    /// Speeds of the bearing at the mean speeds over the run: where a speed changes, only ratios of its
    /// frequencies to the relative speed of the rings are meaningful.
    pub fn mean_kinematics(&self) -> Kinematics {
        let duration_s = 1e-3 * self.solver.duration_ms;
        let [inner_rpm, outer_rpm] = self.duty().mean_speeds_rpm(duration_s);
        Kinematics::between(&self.bearing, inner_rpm, outer_rpm)
    }

    /// Angles of the rollers at the start [°], counter-clockwise from the x axis, roller 1 first, and those
    /// where one is missing.
    pub fn roller_angles_deg(&self) -> Vec<f64> {
        let b = &self.bearing;
        let path_mm = 0.5 * (b.outer_race_diameter_mm - b.roller_diameter_mm);
        let offset = |i: usize| self.cage.as_ref().and_then(|cage| cage.roller_offsets_um.get(i));
        let offset_deg = |i: usize| offset(i).map_or(0.0, |um| (1e-3 * um / path_mm).to_degrees());
        let pocket_deg = |i: usize| b.first_roller_deg + 360.0 * i as f64 / b.rollers as f64;
        (0..b.rollers).map(|i| pocket_deg(i) + offset_deg(i)).collect()
    }

    /// Angles of the rollers at the start as seen in a frame whose load comes from above [°], in their order,
    /// without those that are missing: the argument of [`RigidRings::distribute`]. For a load downwards they
    /// are the angles themselves.
    pub fn angles_to_load_deg(&self) -> Vec<f64> {
        let turned = self.load_zone_deg() - 90.0;
        let angles = self.roller_angles_deg();
        self.rollers_in_place().map(|number| angles[number - 1] - turned).collect()
    }

    /// Rolling elements that its cylinders stand for: balls where its fields say so, and in a bearing with the name
    /// of one of the catalogue's ball bearings.
    pub fn element(&self) -> Element {
        if self.bearing.element == ElementKind::Ball {
            return Element::Ball;
        }
        let name = &self.bearing.designation;
        let known = || crate::catalogue::known().unwrap_or_else(|_| catalogue::all().into());
        let is_ball = !name.is_empty()
            && known().iter().any(|known| known.name == *name && known.element == Element::Ball);
        if is_ball { Element::Ball } else { Element::Roller }
    }

    /// Law of the contacts of rolling elements in its model, where they are as in steel: the penalty is that of
    /// balls, and without a mesh relieved rollers touch with their middles. Anything else is plane.
    pub(crate) fn contact_law(&self) -> ContactLawKind {
        match self.law_of_elements() {
            _ if self.contact.formula != ContactFormula::Hertz => ContactLawKind::Line,
            ContactLawKind::Profiled if self.model == ModelScene::Full => ContactLawKind::Line,
            kind => kind,
        }
    }

    /// Law of its rolling elements, whatever the model.
    fn law_of_elements(&self) -> ContactLawKind {
        match (self.element(), self.bearing.roller_profile) {
            (Element::Roller, RollerProfile::Logarithmic) => ContactLawKind::Profiled,
            (element, _) => ContactLawKind::of(element),
        }
    }

    /// Basic static radial load rating by ISO 76 [N]; rollers are as long as the model is thick.
    pub fn static_rating_n(&self) -> f64 {
        load_rating::static_rating_n(&self.bearing, self.element(), self.bearing.thickness_mm)
    }
}

/// Below this static safety rolling elements leave dents (ISO 76 asks for 1.5 and more where it runs
/// quietly).
const SAFE: f64 = 1.0;

impl ResolvedScene {
    /// What to say of a load at which steel would yield: the largest of the run exceeds the static rating.
    pub fn overload(&self) -> Option<String> {
        let (rating_n, [_, load_n]) = (self.written.static_rating_n(), self.duty.load_range_n(self.duration));
        let safety = rating_n / load_n;
        (safety < SAFE).then(|| {
            format!(
                "the load of {load_n:.0} N exceeds the static rating of this bearing, {rating_n:.0} N by ISO 76 \
                 (s₀ = {safety:.2}): steel would yield, which the model does not. Take less `operation.load_n`, \
                 or check `bearing.thickness_mm`, the length of the rollers"
            )
        })
    }

    /// What a run of this scene will not show, each with its reason and remedy: an overload, a spall outside the
    /// load zone or as long as elements stand apart, and samples too far apart.
    pub fn doubts(&self) -> Vec<String> {
        let spalls = self.written.spalls();
        let of_spalls = spalls.iter().flat_map(|spall| [self.idle_spall(spall), self.long_spall(spall)]);
        self.overload().into_iter().chain(of_spalls.flatten()).chain(self.slow_samples()).collect()
    }

    /// A spall that no loaded element reaches, of an outer ring that does not turn.
    fn idle_spall(&self, spall: &DefectScene) -> Option<String> {
        let operation = &self.written.operation;
        let turns = operation.outer_speed_rpm != 0.0 || operation.outer_speed_profile.is_some();
        // By how much a load that turns tilts the one that stands.
        let rotating_n = operation.rotating_load.as_ref().map_or(0.0, |load| load.force_n.abs());
        let tilt_deg = libm::asin(rotating_n / operation.load_n).to_degrees();
        if spall.ring != DefectRing::Outer || turns || tilt_deg.is_nan() {
            return None;
        }
        // Of an angle from the middle of the load zone, and how far from it elements carry: one beside them may
        // stand up to a spacing farther when it is its turn.
        let off_deg = |angle_deg: f64| ((angle_deg + 180.0).rem_euclid(360.0) - 180.0).abs();
        let shared = self.static_load().ok()?;
        let angles = self.written.angles_to_load_deg();
        let loaded = angles.iter().zip(&shared.roller_n).filter(|(_, force)| **force > 0.0);
        let reach_deg = loaded.map(|(angle, _)| off_deg(angle - 90.0)).fold(0.0, f64::max)
            + tilt_deg
            + 360.0 / self.rollers as f64;
        let half_deg = (0.5e-3 * spall.length_mm / self.outer_race_radius).to_degrees();
        let zone_deg = self.written.load_zone_deg();
        (off_deg(spall.angle_deg - zone_deg) - half_deg > reach_deg).then(|| {
            format!(
                "the spall at {}° lies outside of the load zone, {reach_deg:.0}° to either side of {zone_deg:.0}°: \
                 no element carries anything over it. Take `defect.angle_deg` within the zone",
                spall.angle_deg
            )
        })
    }

    /// A spall in which several elements are at once.
    fn long_spall(&self, spall: &DefectScene) -> Option<String> {
        let radius = match spall.ring {
            DefectRing::Outer => self.outer_race_radius,
            DefectRing::Inner => self.inner_race_radius,
        };
        let spacing_mm = 2e3 * PI * radius / self.rollers as f64;
        (spall.length_mm > spacing_mm).then(|| {
            format!(
                "the spall is {} mm long, and elements stand {spacing_mm:.1} mm apart on its raceway: several are in \
                 it at once, and one's exit is not told from another's entry. Take less `defect.length_mm`",
                spall.length_mm
            )
        })
    }

    /// Samples that hold no impact at the rate of the defects.
    fn slow_samples(&self) -> Option<String> {
        let k = self.written.mean_kinematics();
        let hz = |on: RollingSurface| match on {
            RollingSurface::Outer => k.bpfo_hz.abs(),
            RollingSurface::Inner => k.bpfi_hz.abs(),
            RollingSurface::Roller(_) => 2.0 * k.bsf_hz.abs(),
        };
        let faults = self.written.faults();
        let impacts_hz = faults.into_iter().map(hz).fold(0.0, f64::max);
        let half_hz = 0.5 / self.interval;
        (half_hz < IMPACTS * impacts_hz).then(|| {
            format!(
                "{:.0} samples a second (`output.interval_us`) hold nothing above {half_hz:.0} Hz, and the defect is \
                 passed {impacts_hz:.0} times a second: what its impacts ring with lies above, and the record cannot \
                 be judged. Take {:.0} or less",
                1.0 / self.interval,
                (0.5e6 / (IMPACTS * impacts_hz)).floor()
            )
        })
    }

    /// Whether contact with the outer raceway has the compliance of the ring: not where the ring moves as one
    /// piece, unless the penalty stands for it.
    pub fn outer_gives_way(&self) -> bool {
        !self.written.housing.is_rigid() || self.written.contact.formula == ContactFormula::Hertz
    }

    /// Line contacts of what is meshed: a ring that moves as one piece does not give way, and a roller that is
    /// shorter than the rings gives way the more.
    pub fn meshed_contacts(&self) -> LineContacts {
        let bearing = Bearing::from(self);
        let is_rigid = self.written.housing.is_rigid();
        let outer_ring_thickness = bearing.outer_ring_thickness.filter(|_| !is_rigid);
        let contacts = LineContacts::of(Bearing { outer_ring_thickness, ..bearing });
        contacts.with_shorter_rollers(self.element_share())
    }

    /// Length of a rolling element over the thickness: of a roller one, of a ball that of the cylinder with its mass.
    pub fn element_share(&self) -> f64 {
        match self.law_of_elements() {
            ContactLawKind::Ball => 4.0 / 3.0 * self.roller_radius / self.thickness,
            _ => 1.0,
        }
    }

    /// Load distribution at the start, under the load alone (no weights).
    pub fn static_load(&self) -> Result<StaticLoad, Error> {
        RigidRings::new(self, self.contact_law)
            .distribute(self.duty.load_n(0.0), &self.written.angles_to_load_deg())
    }

    /// Films of the most loaded roller on the outer and on the inner raceway; `None` for a scene without oil.
    ///
    /// # Errors
    /// When the scene has no static load distribution.
    pub fn loaded_films(&self) -> Result<Option<[LoadedFilm; 2]>, Error> {
        let Some(oil) = &self.film else { return Ok(None) };
        let load_n = self.static_load()?.max_roller_n();
        let k = self.written.kinematics();
        // The least film is that of the slowest moment of the profile, however long the run: it can be made
        // longer.
        let slowest = self.varying_duty().map_or(1.0, |duty| {
            let slowest = duty.slowest_rpm(LONGEST_RUN_S) / 60.0;
            let at_start = k.cage_on_outer_hz + k.cage_on_inner_hz;
            if at_start > 0.0 { slowest / at_start } else { 0.0 }
        });
        Ok(Some(lubrication::loaded_films(self, oil, &k, slowest, load_n)))
    }

    /// Law of its rolling elements, whatever the model: points for balls, lines for all others, which may be relieved.
    pub fn law_of_elements(&self) -> ContactLawKind {
        self.written.law_of_elements()
    }

    /// Largest pressure of a contact with the outer and with the inner raceway under a force [N] by Hertz [Pa]: of a
    /// point for balls, of a line for all others.
    pub fn pressure_pa(&self, force_n: f64) -> [f64; 2] {
        let (r, modulus) = (self.roller_radius, self.material.contact_modulus());
        if self.law_of_elements() == ContactLawKind::Ball {
            let groove = 2.0 * CONFORMITY * r;
            return [-self.outer_race_radius, self.inner_race_radius]
                .map(|across| point_contact::pressure(r, across, groove, force_n, 2.0 * modulus));
        }
        [self.outer_contact_radius(), self.inner_contact_radius()]
            .map(|radius| (force_n / self.thickness * modulus / (PI * radius)).sqrt())
    }

    /// The bearing between rigid rings, without defects, with its inner ring at `speed_rpm`; the outer one
    /// turns as in the scene.
    pub fn turning_rings(&self, kind: ContactLawKind, speed_rpm: f64) -> TurningRings {
        let outer_rpm = self.written.operation.outer_speed_rpm;
        let k = Kinematics::between(&self.written.bearing, speed_rpm, outer_rpm);
        TurningRings::new(self, kind, &k, self.written.load_zone_deg().to_radians())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{FilmScene, OperationScene};

    /// Eight ratings ran to their end without a word.
    #[test]
    fn issue_a_load_beyond_the_static_rating_is_warned_of() {
        let scene = |load: &str| {
            let scene = Scene::default().with_overrides(&["bearing=NU 205", load]).expect("a scene");
            scene.resolve().overload()
        };
        assert_eq!(scene("operation.load_n=20000"), None);
        let words = scene("operation.load_n=200000").expect("a warning");
        assert!(words.contains("exceeds the static rating") && words.contains("s₀ = 0.1"), "{words}");
    }

    /// Rolling without slip (THEORY §5.1): a roller ahead by s arrives earlier by s over the speed of its
    /// centre.
    #[test]
    fn analytic_a_roller_out_of_the_middle_of_its_pocket_arrives_as_much_later() {
        let mut scene = Scene::default();
        let offsets: Vec<f64> = (0..24).map(|i| 80.0 - 7.0 * f64::from(i)).collect();
        let crossings = |scene: &Scene| {
            scene.kinematics().crossings(
                scene.defect.as_ref().expect("one"),
                &scene.roller_angles_deg(),
                30e-3,
            )
        };
        let centred = crossings(&scene);
        scene.cage.iter_mut().for_each(|cage| cage.roller_offsets_um.clone_from(&offsets));
        for (a, b) in centred.iter().zip(crossings(&scene)) {
            let speed = std::f64::consts::TAU * scene.kinematics().cage_hz * 91e-3;
            let expected = 1e-6 * offsets[a.roller - 1] / speed;
            assert!((b.exit_s - a.exit_s - expected).abs() <= 1e-9 * expected.abs());
        }
    }

    #[test]
    fn by_hand_rough_surfaces_are_held_apart_by_their_tips() {
        let film = Some(FilmScene { roughness_um: 0.1, ..FilmScene::default() });
        let [smooth, _] =
            Scene { film, ..Scene::default() }.resolve().loaded_films().expect("a load").expect("oil");
        assert_eq!(smooth.least, smooth.thickness);
        let film = Some(FilmScene { roughness_um: 2.0, ..FilmScene::default() });
        let [rough, _] =
            Scene { film, ..Scene::default() }.resolve().loaded_films().expect("a load").expect("oil");
        assert!(rough.lambda < 1.0 && (rough.least / 2e-6 - 1.0).abs() < 1e-12, "{rough:?}");
        let still = OperationScene { speed_rpm: 0.0, ..Scene::default().operation };
        let film = Some(FilmScene::default());
        let [still, _] = Scene { film, operation: still, ..Scene::default() }
            .resolve()
            .loaded_films()
            .expect("a load")
            .expect("oil");
        assert_eq!((still.thickness, still.least), (0.0, 0.3e-6));
        let dry = Scene { film: None, ..Scene::default() };
        assert_eq!(dry.resolve().loaded_films().expect("a load"), None);
    }
}
