//! Before a run: expected lines of contact noise and their levels, resolution in time and space, cost, and
//! the necessary length of a record. Nothing is simulated.

mod loads;

use std::f64::consts::PI;

use stribeck_dsp::PeriodCount;
use stribeck_scene::deviation::RollingSurface;
use stribeck_scene::resolved::ResolvedScene;
use stribeck_scene::scene::{
    ContactInterpolation, ContactMethod, ContactSurface, DampingFrame, ModelScene, RollerCopies,
};
use stribeck_store::run_info::MeshInfo;
use stribeck_theory::lubrication::LoadedFilm;

use crate::Error;
use crate::defect::Shocks;
use crate::kinematics::KinematicsFinding;
use crate::lumped::Lumped;
use crate::prediction::Prediction;
use crate::rolling;

pub use loads::Loads;

/// Facts of the mesh that a plan needs.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshFacts {
    /// Its counts.
    pub counts: MeshInfo,
    /// Critical time step of its stiffest element alone [s].
    pub element_time_step_s: f64,
}

/// Noise of contact on a mesh.
#[derive(Debug, Clone)]
pub struct ContactNoise {
    /// Predicted lines: name and frequency [Hz].
    pub lines: Vec<(String, f64)>,
    /// The lumped model of the strongest of them on chords.
    pub lumped: Lumped,
    /// Sag of a roller's facets, of the outer and of the inner raceway's [m].
    pub sag_m: [f64; 3],
    /// Hertz half-width under the largest static force at the outer raceway [m].
    pub half_width_m: f64,
    /// Length of a roller's facets [m].
    pub facet_m: f64,
    /// Record that separates the closest two of the lines, Hann window [s]; `None` when they coincide.
    pub separating_s: Option<f64>,
}

/// Expected tones, resolution and cost of a scene.
#[derive(Debug, Clone)]
pub struct Plan {
    /// What the mesh adds to the signal; `None` in the reduced model on arcs, whose contact has no mesh.
    pub noise: Option<ContactNoise>,
    /// Static load sharing.
    pub loads: Loads,
    /// Oil under the most loaded roller, on the outer and on the inner raceway; `None` without oil.
    pub films: Option<[LoadedFilm; 2]>,
    /// Elements, and the time step by the stiffest of them alone [s]; with contact and the whole mesh it may
    /// differ by a fifth either way.
    pub elements: usize,
    /// See `elements`.
    pub time_step_s: f64,
    /// Steps of the whole run.
    pub steps: f64,
    /// Elements in a Rayleigh wave at the half of the sampling rate [-]; `None` where no ring deforms.
    pub elements_per_wavelength: Option<f64>,
    /// Resolution of a spectrum of the whole record [Hz].
    pub resolution_hz: f64,
    /// Family whose ten periods are the least for an envelope, and the record that holds them [s]: that of
    /// the defect, of several the slowest, without one BPFO; `None` where the rings do not turn against each
    /// other.
    pub envelope: Option<(&'static str, f64)>,
    /// Problems to expect, each with its reason.
    pub dangers: Vec<String>,
    /// Recommended changes, each with its reason.
    pub advice: Vec<String>,
}

/// Rayleigh waves run at this share of shear waves (ν = 0.3).
const RAYLEIGH: f64 = 0.9274;

/// A Hann window separates lines that are this many resolutions apart.
const HANN_WIDTHS: f64 = 2.0;

/// An onset over this many steps of the gap from point to point, to either side, leaves a quarter of their
/// line: 8 µm are 1.95 steps in the cured scene, 3 µm are 0.73 (docs/results/noise.md, `smooth` and
/// `smooth-narrow`).
const ONSET_STEPS: f64 = 1.9;

impl ContactNoise {
    fn of(
        scene: &ResolvedScene,
        prediction: &Prediction,
        counts: &MeshInfo,
        largest_n: f64,
    ) -> Result<Self, Error> {
        let sag = |radius: f64, facets: usize| radius * (1.0 - (PI / facets as f64).cos());
        let (radius, facets) = (scene.roller_radius, counts.roller_facets);
        let effective = scene.outer_contact_radius();
        let mut hz: Vec<f64> = prediction.facet_lines.iter().map(|l| l.1).collect();
        hz.sort_by(f64::total_cmp);
        let closest = hz.windows(2).map(|w| w[1] - w[0]).fold(f64::INFINITY, f64::min);
        let width = largest_n / scene.contact_length * effective / (PI * scene.material.contact_modulus());
        Ok(Self {
            lines: prediction.facet_lines.clone(),
            lumped: Lumped::of(scene)?,
            sag_m: [
                sag(radius, facets),
                sag(scene.outer_race_radius, counts.outer_facets),
                sag(scene.inner_race_radius, counts.inner_facets),
            ],
            half_width_m: (4.0 * width).sqrt(),
            facet_m: 2.0 * PI * radius / facets as f64,
            separating_s: (closest > 0.01).then(|| HANN_WIDTHS / closest),
        })
    }

    /// Number, phase and length of facets that are in contact themselves.
    fn on_facets(&self, scene: &ResolvedScene) -> Vec<String> {
        let facets = scene.written.mesh.roller_facets;
        let mut advice = Vec::new();
        if facets.is_multiple_of(2) {
            advice.push(format!(
                "on chords, an odd `mesh.roller_facets` ({}) meets both raceways in turn and nearly cancels \
                 the fundamental",
                facets + 1
            ));
        }
        if scene.written.mesh.roller_copies == RollerCopies::Rotated || facets.is_multiple_of(scene.rollers) {
            advice.push(
                "rollers pass their vertices all in phase: `mesh.roller_copies=translated` with a \
                count that is no multiple of the rollers is quieter"
                    .into(),
            );
        }
        if self.sag_m[0] > 0.1 * self.half_width_m.powi(2) / scene.roller_radius {
            advice.push(format!(
                "facets of {:.2} mm are as long as the contact is wide ({:.2} mm): until they are several \
                 times shorter, refinement does not lower the tone",
                1e3 * self.facet_m,
                2e3 * self.half_width_m
            ));
        }
        advice
    }
}

impl Plan {
    /// The plan of a scene whose mesh is `mesh`.
    ///
    /// # Errors
    /// [`Error::Run`] when the scene has no static load distribution.
    pub fn of(scene: &ResolvedScene, mesh: &MeshFacts) -> Result<Self, Error> {
        let counts = &mesh.counts;
        let prediction = Prediction::of(scene, counts);
        let kinematics = &prediction.kinematics;
        let material = &scene.material;
        let loads = Loads::of(scene)?;
        let is_reduced = scene.written.model != ModelScene::Full;
        let has_no_mesh = is_reduced && scene.written.contact.surface != ContactSurface::Facet;
        let is_rigid = is_reduced && scene.written.housing.is_rigid();
        let (duration_s, interval_s) = (scene.duration, scene.interval);
        let time_step_s = scene.written.solver.time_step_factor * mesh.element_time_step_s;
        let per_sample = (interval_s / time_step_s).ceil().max(1.0);
        let shear = (material.shear_modulus() / material.density).sqrt();
        let families = scene.written.faults().into_iter().map(|on| Shocks::of(on, kinematics));
        let slowest = families.min_by(|a, b| a.hz.total_cmp(&b.hz));
        let slowest = slowest.unwrap_or_else(|| Shocks::of(RollingSurface::Outer, kinematics));
        let noise = || ContactNoise::of(scene, &prediction, counts, loads.largest_n);
        let mut plan = Self {
            noise: if has_no_mesh { None } else { Some(noise()?) },
            dangers: loads::dangers(scene, &loads),
            loads,
            films: scene.loaded_films()?,
            elements: counts.quads + counts.triangles,
            time_step_s: interval_s / per_sample,
            steps: per_sample * (duration_s / interval_s).round(),
            elements_per_wavelength: (!is_rigid)
                .then(|| RAYLEIGH * shear * 2.0 * interval_s / scene.element_size),
            resolution_hz: 1.0 / duration_s,
            envelope: Some(slowest)
                .filter(|shocks| shocks.hz > 0.0)
                .map(|shocks| (shocks.name(), PeriodCount::ENOUGH / shocks.hz)),
            advice: Vec::new(),
        };
        plan.advise(scene);
        let support_n = scene.written.operation.load_n;
        if let Ok(curve) = prediction.static_curve(scene, support_n) {
            let least_n = rolling::least_support_n(scene, &curve, support_n);
            plan.advice.extend(rolling::warnings(support_n, least_n, &KinematicsFinding::default()));
            plan.advice.extend(rolling::flats(scene, curve.largest_sound_n));
        }
        Ok(plan)
    }

    /// How much the gap opens from one contact point to the next at the edge of the most loaded contact of a
    /// roller with the outer raceway [m] (THEORY §4.2).
    fn point_step_m(&self, scene: &ResolvedScene, facet_m: f64, points_per_facet: usize) -> f64 {
        let radius = scene.outer_contact_radius();
        let load = self.loads.largest_n / scene.thickness;
        let depth = (0.75 * load / (scene.penalty_stiffness * (2.0 * radius).sqrt())).powf(2.0 / 3.0);
        (2.0 * depth / radius).sqrt() * facet_m / points_per_facet as f64
    }

    /// Recommendations from the study of contact noise (docs/results/noise.md).
    fn advise(&mut self, scene: &ResolvedScene) {
        let mut advice = self.on_oil(scene);
        if let Some(noise) = &self.noise {
            advice.splice(0..0, self.on_contact(scene, noise));
            if scene.written.contact.surface == ContactSurface::Facet {
                advice.extend(noise.on_facets(scene));
            }
        }
        advice.extend(self.on_spectra(scene));
        self.advice = advice;
    }

    /// Surface, interpolation, method and onset of the contacts.
    fn on_contact(&self, scene: &ResolvedScene, noise: &ContactNoise) -> Vec<String> {
        let c = &scene.written.contact;
        let mut advice = Vec::new();
        if c.surface == ContactSurface::Facet {
            advice.push(
                "`contact.surface=arc` takes the sag of the facets away: the largest single step of \
                the study"
                    .into(),
            );
        }
        if c.interpolation == ContactInterpolation::Linear && c.penalty_scale > 0.2 {
            advice.push(format!(
                "`contact.interpolation=spline`: with a contact as stiff as elements (penalty_scale {}) a \
                 load between two nodes sinks in less than one at a node, and arcs alone leave a third of \
                 the tone",
                c.penalty_scale
            ));
        }
        if c.method == ContactMethod::Collocated {
            advice.push(
                "`contact.method=integrated`: at nodes alone the pressure is lumped, and every node \
                that enters or leaves is a step"
                    .into(),
            );
        }
        let onset_m = ONSET_STEPS * self.point_step_m(scene, noise.facet_m, c.points_per_facet);
        let points_hz = c.points_per_facet as f64 * noise.lumped.frequency_hz;
        let audible = points_hz < 0.5 / scene.interval;
        // The reduced model integrates the penetration exactly, without points.
        let in_points = scene.written.model == ModelScene::Full && c.method == ContactMethod::Integrated;
        if in_points && c.surface != ContactSurface::Facet && audible && scene.contact_onset < onset_m {
            advice.push(format!(
                "`contact.onset_um={:.1}`: points that come into contact and leave it sound at {:.1} kHz \
                 unless their pressure sets in over several of them",
                1e6 * onset_m,
                1e-3 * points_hz
            ));
        }
        advice
    }

    /// Damping beside oil films, and thin ones.
    fn on_oil(&self, scene: &ResolvedScene) -> Vec<String> {
        let Some(films) = &self.films else { return Vec::new() };
        let mut advice = Vec::new();
        if scene.written.solver.mass_damping_per_s > 0.0
            && scene.written.solver.damping_frame == DampingFrame::Rolling
        {
            advice.push(
                "`solver.damping_frame=rigid_motion`, or no mass damping: what damps rollers across \
                the raceways stands for the oil that `film` computes"
                    .into(),
            );
        }
        if films.iter().any(|film| film.lambda < 1.0) {
            advice.push(
                "oil films under load are thinner than `film.roughness_um`: the tips carry, and the \
                films are taken to be as thick as they are high"
                    .into(),
            );
        }
        advice
    }

    /// The resolution of the spectra in frequency and of their top in space.
    fn on_spectra(&self, scene: &ResolvedScene) -> Vec<String> {
        let mut advice = Vec::new();
        if let Some(few) = self.elements_per_wavelength.filter(|n| *n < 8.0) {
            advice.push(format!(
                "{few:.1} elements in a wave at half the sampling rate: a smaller `mesh.size_mm`, or do not \
                 read the top of the spectrum"
            ));
        }
        let separating_s = self.noise.as_ref().and_then(|noise| noise.separating_s);
        if let Some(needed) = separating_s.filter(|s| *s > scene.duration) {
            advice.push(format!(
                "the closest lines merge in {:.0} ms; {:.0} ms separate them",
                1e3 * scene.duration,
                1e3 * needed
            ));
        }
        advice
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use stribeck_scene::scene::FilmScene;
    use stribeck_scene::scene::Scene;

    /// The paper's bearing in elements of 2 mm.
    fn facts() -> MeshFacts {
        let counts = MeshInfo {
            nodes: 17_405,
            quads: 15_600,
            triangles: 200,
            roller_facets: 112,
            outer_facets: 314,
            inner_facets: 258,
        };
        MeshFacts { counts, element_time_step_s: 60e-9 }
    }

    /// Ten periods were those of BPFO whatever the defect, and "inf ms" of a bearing at rest.
    #[test]
    fn issue_ten_periods_are_those_of_the_scenes_own_defect() {
        let envelope =
            |scene: &Scene| Plan::of(&scene.resolve(), &facts()).expect("a load distribution").envelope;
        let mut scene = Scene::default();
        let of = |scene: &Scene| {
            let k = scene.kinematics();
            [("BPFO", 10.0 / k.bpfo_hz), ("BPFI", 10.0 / k.bpfi_hz), ("2×BSF", 5.0 / k.bsf_hz)]
        };
        let [outer, inner, roller] = of(&scene);
        assert_eq!(envelope(&scene), Some(outer));
        let mut inside = scene.clone();
        inside.defect.as_mut().expect("the paper's").ring = stribeck_scene::scene::DefectRing::Inner;
        assert_eq!(envelope(&inside), Some(inner));
        // Of several the slowest, which takes the longest record.
        inside.defects = Scene::default()
            .with_overrides(&[
                "film=None",
                "defects=[(on: roller(1), form: dent(length_mm: 3.0, depth_mm: 0.05))]",
            ])
            .expect("a dent")
            .defects;
        assert_eq!(envelope(&inside), Some(if roller.1 > inner.1 { roller } else { inner }));
        scene.operation.speed_rpm = 0.0;
        assert_eq!(envelope(&scene), None);
    }

    #[test]
    fn by_hand_plan_of_the_paper() {
        let mut scene = Scene::default();
        scene.mesh.size_mm = 2.0;
        scene.mesh.roller_facets = 112;
        let of =
            |scene: &Scene| Plan::of(&scene.resolve(), &facts()).expect("a scene with a load distribution");
        let noise = |plan: &Plan| plan.noise.clone().expect("a mesh");
        let plan = of(&scene);
        // 3.54 µm of sag and 4671.5 Hz at 112 facets, whatever the rest of the mesh.
        assert!((noise(&plan).sag_m[0] - 3.54e-6).abs() < 0.01e-6, "{plan:?}");
        assert!((noise(&plan).lumped.frequency_hz - 4671.7).abs() < 1.0);
        assert!((plan.resolution_hz - 33.3).abs() < 0.1);
        // 10 µs in steps of at most 0.98 · 60 ns: 171 of them, 3000 times.
        assert_eq!((plan.steps, plan.elements), (513_000.0, 15_800));
        assert!(plan.advice.iter().any(|a| a.contains("surface=arc")), "{:?}", plan.advice);
        scene.contact.surface = ContactSurface::Arc;
        scene.contact.interpolation = ContactInterpolation::Spline;
        let smooth = of(&scene);
        assert!(smooth.advice.iter().all(|a| !a.contains("contact.")), "{:?}", smooth.advice);
        // Eight points a facet make a line at 37.4 kHz, below half of 100 kHz; with the proposed onset they
        // do not.
        scene.contact.points_per_facet = 8;
        let sounding = of(&scene);
        assert!(sounding.advice.iter().any(|a| a.contains("onset_um") && a.contains("37.4 kHz")));
        let reduced = Scene { model: ModelScene::Reduced(Default::default()), ..scene.clone() };
        let round = of(&reduced);
        assert!(round.noise.is_none() && round.advice.iter().all(|a| !a.contains("contact.")), "{round:?}");
        let step_m = |plan: &Plan, scene: &Scene| plan.point_step_m(&scene.resolve(), noise(plan).facet_m, 8);
        scene.contact.onset_um = 1.01e6 * ONSET_STEPS * step_m(&sounding, &scene);
        let quiet = of(&scene);
        assert!(quiet.advice.iter().all(|a| !a.contains("contact.")), "{:?}", quiet.advice);
        scene.film = Some(FilmScene { roughness_um: 1.0, ..FilmScene::default() });
        scene.solver.mass_damping_per_s = 5000.0;
        let oiled = of(&scene);
        assert!(
            oiled.films.is_some_and(|[outer, _]| (0.3..0.8).contains(&outer.lambda)),
            "{:?}",
            oiled.films
        );
        for words in ["damping_frame=rigid_motion", "film.roughness_um"] {
            assert!(oiled.advice.iter().any(|a| a.contains(words)), "{:?}", oiled.advice);
        }
        // THEORY §4.2, on the paper's mesh: the penalty is in proportion to its size.
        scene.mesh.size_mm = 0.5;
        let loads = Loads { largest_n: 10950.0, ..quiet.loads.clone() };
        let step = step_m(&Plan { loads, ..quiet }, &scene);
        assert!((step - 4.1e-6).abs() < 0.1e-6, "{step}");
    }
}
