//! Prediction for a scene from rolling without slip and rigid rings: frequencies, facet lines, passages of
//! rollers over the defect, and the load distribution.

use stribeck_scene::resolved::{DefectGeometry, ResolvedScene};
use stribeck_scene::scene::{DefectRing, DefectScene, RollerCopies};
use stribeck_store::run_info::MeshInfo;
use stribeck_theory::kinematics::{Crossing, FacetCounts, Kinematics};
use stribeck_theory::static_load::RigidRings;

use crate::Error;
use crate::defect::Shocks;
use crate::families::{Candidate, Source};
use stribeck_diagnosis::Defect;

/// Steps of the cage over one roller spacing in the static distribution.
const CAGE_STEPS: usize = 30;

/// How much more often than without slip rollers may pass a spall that turns.
const EARLY: f64 = 0.01;

/// Everything that geometry and speed predict.
#[derive(Debug, Clone, PartialEq)]
pub struct Prediction {
    /// Frequencies without slip, at the mean speed where it changes.
    pub kinematics: Kinematics,
    /// Names and frequencies [Hz] of the fundamental facet-passing lines, from the actual mesh counts.
    pub facet_lines: Vec<(String, f64)>,
    /// Spalls of raceways, in the order of [`Scene::spalls`](stribeck_scene::scene::Scene::spalls).
    pub spalls: Vec<SpallCourse>,
    /// Shocks of the first defect; `None` where the speed changes, so that they have no frequency.
    pub shocks: Option<Shocks>,
}

/// A spall of a raceway, and the expected passages of rollers over it.
#[derive(Debug, Clone, PartialEq)]
pub struct SpallCourse {
    /// The spall.
    pub spall: DefectScene,
    /// Its edges at the start; they turn with its ring.
    pub edges: DefectEdges,
    /// Whether its ring turns.
    pub turns: bool,
    /// Passages that begin in the simulated time or little later, in order of entry.
    pub passages: Vec<Crossing>,
}

/// Angles [°] between which a roller's centre is over a spall, counter-clockwise from the x axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DefectEdges {
    /// Where rollers arrive.
    pub leading_deg: f64,
    /// Its middle.
    pub middle_deg: f64,
    /// Where rollers leave.
    pub trailing_deg: f64,
}

/// Roller force by angle between rigid rings, gathered over one roller spacing of cage positions, or over a
/// turn of the cage where a roller is missing.
#[derive(Debug, Clone, PartialEq)]
pub struct StaticCurve {
    /// Angles [°], 0 to 360, ascending.
    pub angle_deg: Vec<f64>,
    /// Radial force on a roller there [N], the mean over the positions of the cage with a roller there; zero
    /// over the defect.
    pub force_n: Vec<f64>,
    /// Largest force on a roller [N].
    pub largest_n: f64,
    /// The same without a defect [N].
    pub largest_sound_n: f64,
    /// Loaded rollers at the start.
    pub loaded_rollers: usize,
}

impl Prediction {
    /// Predicts from the resolved scene and the counts of the mesh that was run.
    pub fn of(scene: &ResolvedScene, mesh: &MeshInfo) -> Self {
        let kinematics = scene.written.mean_kinematics();
        let counts = FacetCounts {
            roller: mesh.roller_facets,
            outer: scene.facets_around(DefectRing::Outer, mesh.outer_facets),
            inner: scene.facets_around(DefectRing::Inner, mesh.inner_facets),
        };
        let facet_lines = kinematics.facet_tones(counts).map(|tone| (tone.name.to_owned(), tone.hz)).to_vec();
        let edges = |defect: &DefectScene| {
            // Rollers pass either raceway from opposite sides.
            let (diameter_mm, ahead) = match defect.ring {
                DefectRing::Outer => (scene.written.bearing.outer_race_diameter_mm, kinematics.sense()),
                DefectRing::Inner => (scene.written.bearing.inner_race_diameter_mm, -kinematics.sense()),
            };
            let ahead_deg = ahead * (defect.length_mm / diameter_mm).to_degrees();
            DefectEdges {
                leading_deg: defect.angle_deg + ahead_deg,
                middle_deg: defect.angle_deg,
                trailing_deg: defect.angle_deg - ahead_deg,
            }
        };
        let turns = |defect: &DefectScene| match defect.ring {
            DefectRing::Outer => scene.written.operation.outer_turns(),
            DefectRing::Inner => scene.written.operation.inner_turns(),
        };
        let passages = |defect: &DefectScene| {
            if scene.written.operation.speed_varies() {
                return over_turns(scene, defect);
            }
            // On the inner raceway the contact is as fast: rollers do not slip.
            let traverse_s = DefectGeometry::of(defect).length / kinematics.contact_speed_m_s;
            // A cage that slips meets a ring that turns earlier. A roller that enters before the end leaves
            // at most one traverse later.
            let early = if turns(defect) { EARLY } else { 0.0 };
            let until_s = (1.0 + early) * scene.duration + traverse_s;
            kinematics.crossings(defect, &scene.written.roller_angles_deg(), until_s)
        };
        let in_place = |defect: &DefectScene| {
            let mut passages = passages(defect);
            passages
                .retain(|passage| scene.written.rollers_in_place().any(|number| number == passage.roller));
            passages
        };
        let course = |spall: DefectScene| SpallCourse {
            edges: edges(&spall),
            turns: turns(&spall),
            passages: in_place(&spall),
            spall,
        };
        Self {
            facet_lines,
            spalls: scene.written.spalls().into_iter().map(course).collect(),
            shocks: scene
                .written
                .faults()
                .first()
                .filter(|_| !scene.written.operation.speed_varies())
                .map(|on| Shocks::of(*on, &kinematics)),
            kinematics,
        }
    }

    /// Edges of the first spall, when it stands still on the outer raceway.
    pub fn standing(&self) -> Option<DefectEdges> {
        let standing = |course: &&SpallCourse| course.spall.ring == DefectRing::Outer && !course.turns;
        self.spalls.first().filter(standing).map(|course| course.edges)
    }

    /// Edges of all spalls that stand still on the outer raceway.
    pub fn standing_spalls(&self) -> impl Iterator<Item = DefectEdges> {
        let standing = |course: &&SpallCourse| course.spall.ring == DefectRing::Outer && !course.turns;
        self.spalls.iter().filter(standing).map(|course| course.edges)
    }

    /// Passages over the first spall.
    pub fn passages(&self) -> &[Crossing] {
        self.spalls.first().map_or(&[], |spall| &spall.passages)
    }

    /// The defect's frequency in a bearing whose rollers passed the outer raceway at `bpfo_hz`: the rates of
    /// passing both raceways add up to the relative speed of the rings times the number of rollers.
    pub fn moved(&self, bpfo_hz: Option<f64>) -> Option<f64> {
        let k = &self.kinematics;
        let shocks = self.shocks?;
        bpfo_hz.map(|hz| match shocks.defect {
            Defect::Bpfi => k.bpfo_hz + k.bpfi_hz - hz,
            // A rolling element turns in proportion to its way along the outer raceway.
            Defect::Bsf => 2.0 * k.bsf_hz * hz / k.bpfo_hz,
            Defect::Bpfo | Defect::Ftf => hz,
        })
    }

    /// The combs that facets can make: rollers, nodes of the outer and of the inner raceway.
    pub fn candidates(&self, scene: &ResolvedScene, mesh: &MeshInfo) -> Vec<Candidate> {
        let vertices = mesh.roller_facets as f64;
        let sources = [
            match scene.written.mesh.roller_copies {
                RollerCopies::Rotated => Source::RotatedVertices(vertices),
                RollerCopies::Translated => Source::TranslatedVertices(vertices),
            },
            Source::OuterNodes(scene.facets_around(DefectRing::Outer, mesh.outer_facets)),
            Source::InnerNodes(scene.facets_around(DefectRing::Inner, mesh.inner_facets)),
        ];
        let named = |((name, _), source): (&(String, f64), Source)| Candidate { name: name.clone(), source };
        self.facet_lines.iter().zip(sources).map(named).collect()
    }

    /// Longest of the facet periods [s]: a median over it removes every facet line. Zero without facets or
    /// motion.
    pub fn facet_period_s(&self) -> f64 {
        let slowest = self.facet_lines.iter().map(|l| l.1).filter(|&hz| hz > 0.0).reduce(f64::min);
        slowest.map_or(0.0, |hz| 1.0 / hz)
    }

    /// Static distribution of `support_n`, the vertical force through the rollers [N], rollers over the
    /// defect left out.
    ///
    /// # Errors
    /// [`Error::Run`] when the rings find no equilibrium.
    pub fn static_curve(&self, scene: &ResolvedScene, support_n: f64) -> Result<StaticCurve, Error> {
        let rings = RigidRings::new(scene, scene.contact_law);
        // The rings see the load from above.
        let turned_by = scene.written.load_zone_deg() - 90.0;
        let start = scene.written.angles_to_load_deg();
        // After a spacing the bearing is the same again, or after a turn where a roller is missing.
        let rollers = scene.written.bearing.rollers;
        let alike = if start.len() == rollers { rollers } else { 1 };
        let (period, steps) = (360.0 / alike as f64, CAGE_STEPS * rollers / alike);
        let mut points: Vec<(f64, f64)> = Vec::new();
        let mut largest_sound_n = 0.0f64;
        for step in 0..steps {
            let turned = period * step as f64 / steps as f64;
            let all: Vec<f64> = start.iter().map(|a| (a - turned).rem_euclid(360.0)).collect();
            let (inside, carrying): (Vec<f64>, Vec<f64>) =
                all.iter().partition(|&&a| self.over_defect(a + turned_by));
            largest_sound_n = largest_sound_n.max(rings.distribute(support_n, &all)?.max_roller_n());
            let load = rings.distribute(support_n, &carrying)?;
            points.extend(carrying.into_iter().zip(load.roller_n));
            points.extend(inside.into_iter().map(|a| (a, 0.0)));
        }
        let largest_n = points.iter().map(|point| point.1).fold(0.0, f64::max);
        if turned_by != 0.0 {
            points.iter_mut().for_each(|point| point.0 = (point.0 + turned_by).rem_euclid(360.0));
        }
        let (angle_deg, force_n) = by_place(points).into_iter().unzip();
        Ok(StaticCurve {
            largest_n,
            largest_sound_n,
            loaded_rollers: rings.distribute(support_n, &start)?.loaded_rollers(),
            angle_deg,
            force_n,
        })
    }

    /// Width of the running median [s] for a defect that takes `traverse_s` to cross: one facet period, but
    /// on a coarse mesh not more than a tenth of the traverse.
    pub fn smoothing_s(&self, traverse_s: f64) -> f64 {
        self.facet_period_s().min(0.1 * traverse_s)
    }

    fn over_defect(&self, angle_deg: f64) -> bool {
        self.standing_spalls().any(|d| {
            let from_middle = (angle_deg - d.middle_deg + 180.0).rem_euclid(360.0) - 180.0;
            from_middle.abs() < (d.leading_deg - d.middle_deg).abs()
        })
    }
}

/// Points (angle [°], force) in the order of their angles, those of one place as their mean: where a roller
/// is missing, others carry there more or less by how near to the gap they are.
fn by_place(mut points: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    /// Angles of one place differ by their rounding [°].
    const ROUNDING_DEG: f64 = 1e-6;
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let same = |a: &(f64, f64), b: &(f64, f64)| b.0 - a.0 < ROUNDING_DEG;
    let mean = |place: &[(f64, f64)]| {
        let sum: f64 = place.iter().map(|point| point.1).sum();
        (place[0].0, sum / place.len() as f64)
    };
    points.chunk_by(same).map(mean).collect()
}

/// Passages over a defect where a speed changes: they follow the angle of the rings against each other. None
/// where these turn back on the way.
fn over_turns(scene: &ResolvedScene, defect: &DefectScene) -> Vec<Crossing> {
    let (duty, until_s) = (&scene.duty, scene.duration);
    if !duty.is_one_way(until_s) {
        return Vec::new();
    }
    let all = duty.relative_turns(until_s);
    // At a turn a second times are turns.
    let (rpm, all) = (60.0_f64.copysign(all), all.abs());
    let mut crossings = Kinematics::new(&scene.written.bearing, rpm).crossings(
        defect,
        &scene.written.roller_angles_deg(),
        all,
    );
    crossings.retain_mut(|c| {
        let times = [c.entry_s, c.centre_s, c.exit_s].map(|turns| duty.time_of_turns(turns, until_s));
        let [Some(entry), Some(centre), Some(exit)] = times else { return false };
        [c.entry_s, c.centre_s, c.exit_s] = [entry, centre, exit];
        true
    });
    crossings
}
