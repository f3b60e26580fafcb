//! A bearing given by its own fields: missing dimensions follow from the given ones, as for a bearing of the
//! catalogue; those that cannot follow are requested.
//!
//! Fields that the user did not give are the paper's. Where the given ones contradict them, the bearing is
//! completed from the given ones alone, and its cage, housing, defect, elements and load follow it
//! ([`surround`](super::named::surround)).

use super::named::{self, Surrounded, tidy};
use super::problem::{Place, Problem};
use super::sources::{self, Sources};
use super::wording::number;
use crate::scene::{Assumed, BearingScene, ElementKind, Scene};
use stribeck_theory::catalogue;

/// Diameters of the paper's bearing of which some are given are still its own where its other ones leave such
/// a clearance, in diameters of a roller …
const PAPERS_CLEARANCE: [f64; 2] = [-0.005, 0.03];
/// … and all of them where rollers and pitch differ from its own by no more than this part.
const PAPERS_SIZE: f64 = 0.01;
/// Given diameters that should agree may differ by this part of the pitch.
const AGREE: f64 = 0.01;
/// Thickness of a ring over the diameter of a roller where the user did not give it: 0.37 to 0.43 in NU 205
/// to NU 312.
const RING: f64 = 0.4;
/// An assumed ring is at most this part of its raceway's radius thick.
const OF_RADIUS: f64 = 0.8;

/// Why given fields do not define a bearing.
#[derive(Debug)]
pub(super) struct Refusal {
    /// The problem, not yet at its place.
    problem: Problem,
    /// Whether a field is given that no scene of the paper's bearing has.
    pub(super) is_of_another: bool,
}

impl Refusal {
    fn new(field: &str, message: String, allowed: String, suggestion: String) -> Self {
        let problem = Problem::new(message, Place::Unwritten { file: String::new() });
        let problem = Problem { field: format!("bearing.{field}"), allowed, suggestion, ..problem };
        Self { problem, is_of_another: false }
    }

    /// With a value of its field that makes it a bearing again.
    fn repaired_by(mut self, value: Option<String>) -> Self {
        self.problem.repair = value.map(|value| format!("{}={value}", self.problem.field));
        self
    }

    pub(super) fn problem(&self, sources: &Sources) -> Problem {
        Problem { place: sources.place(&self.problem.field), ..self.problem.clone() }
    }

    /// Addition to a message on the paper's bearing with a field that it cannot have.
    pub(super) fn hint(&self) -> String {
        format!("; the other numbers are the paper's, because nobody gave them: {}", self.problem.suggestion)
    }
}

/// A scene as it was written, before its bearing was completed, which its fields define.
#[derive(Debug)]
pub(crate) struct Written {
    pub(super) scene: Scene,
    /// Paths of the written fields.
    pub(super) given: Vec<String>,
}

impl Written {
    /// Whether its fields define no bearing any more with the override `argument` of `field`.
    pub(super) fn is_refused_with(&self, field: &str, argument: &str) -> bool {
        let Some(mut scene) = sources::with(&self.scene, argument) else { return true };
        let given: Vec<String> = self.given.iter().cloned().chain([field.to_owned()]).collect();
        complete(&mut scene, &given).is_err()
    }
}

/// The given main dimensions [mm].
#[derive(Debug, Clone, Copy)]
struct Given {
    outer: Option<f64>,
    inner: Option<f64>,
    roller: Option<f64>,
    pitch: Option<f64>,
    bore: Option<f64>,
    outside: Option<f64>,
    width: Option<f64>,
}

/// Raceways and rollers [mm].
#[derive(Debug, Clone, Copy)]
struct Diameters {
    outer: f64,
    inner: f64,
    roller: f64,
}

impl Diameters {
    fn clearance(self) -> f64 {
        self.outer - self.inner - 2.0 * self.roller
    }

    fn pitch(self) -> f64 {
        0.5 * (self.outer + self.inner)
    }
}

/// Whether raceways and rollers are the paper's.
pub(super) fn is_papers(b: &BearingScene) -> bool {
    let paper = BearingScene::default();
    let main = |b: &BearingScene| [b.outer_race_diameter_mm, b.inner_race_diameter_mm, b.roller_diameter_mm];
    main(b) == main(&paper)
}

/// Completes the bearing of a scene and its surroundings, unless it is the paper's. `given` has the paths of
/// the written fields; all others are the paper's.
pub(super) fn complete(scene: &mut Scene, given: &[String]) -> Result<(), Box<Refusal>> {
    let written = |name: &str| given.iter().any(|path| path.strip_prefix("bearing.") == Some(name));
    let b = &scene.bearing;
    let main = Given {
        outer: written("outer_race_diameter_mm").then_some(b.outer_race_diameter_mm),
        inner: written("inner_race_diameter_mm").then_some(b.inner_race_diameter_mm),
        roller: written("roller_diameter_mm").then_some(b.roller_diameter_mm),
        pitch: b.pitch_mm,
        bore: b.bore_mm,
        outside: b.outside_mm,
        width: b.width_mm,
    };
    if main.may_be_the_papers() {
        return Ok(());
    }
    // Values out of range are refused elsewhere.
    let all = [main.outer, main.inner, main.roller, main.pitch, main.bore, main.outside, main.width];
    if all.into_iter().flatten().any(|mm| !(mm > 0.0 && mm < 20_000.0)) || b.rollers < 3 {
        return Ok(());
    }
    let bearing = bearing(&scene.bearing, main, &written)
        .map_err(|refusal| Box::new(Refusal { is_of_another: main.describes_another(), ..*refusal }))?;
    let pitch_mm = 0.5 * (bearing.outer_race_diameter_mm + bearing.inner_race_diameter_mm);
    if !given.iter().any(|path| path == "name") {
        scene.name = match named::plain_name(&bearing.designation) {
            name if name.is_empty() => "own".to_owned(),
            name => name,
        };
    }
    let element = bearing.element.into();
    named::surround(scene, Surrounded { bearing, pitch_mm, element }, given);
    Ok(())
}

/// The completed bearing.
fn bearing(
    b: &BearingScene,
    main: Given,
    written: &dyn Fn(&str) -> bool,
) -> Result<BearingScene, Box<Refusal>> {
    let mut assumed = Vec::new();
    let mut assume = |what: Assumed| {
        if !assumed.contains(&what) {
            assumed.push(what);
        }
    };
    main.agree()?;
    // The clearance depends on the bore, which may follow from the raceway in turn.
    let without = main.diameters(0.0).ok_or_else(|| main.lacks())?;
    let bore = main.bore.unwrap_or(without.inner - 2.0 * RING * without.roller);
    let usual = catalogue::normal_clearance_mm(b.element.into(), bore);
    let usual = usual.min(0.02 * without.roller.max(0.0));
    let d = main.diameters(usual).ok_or_else(|| main.lacks())?;
    if !(d.roller > 0.0 && d.inner > 0.0) {
        return Err(main.impossible(d));
    }
    if (main.outer, main.inner, main.roller) != (Some(d.outer), Some(d.inner), Some(d.roller)) {
        assume(Assumed::Clearance);
        if main.pitch.is_none() && main.raceways() == 0 {
            assume(Assumed::Pitch);
        }
    }
    let outer_ring = main.ring(b, d, written("outer_ring_thickness_mm"), Side::Outer)?;
    let inner_ring = main.ring(b, d, written("inner_ring_thickness_mm"), Side::Inner)?;
    for (ring, what) in [(outer_ring, Assumed::OuterRing), (inner_ring, Assumed::InnerRing)] {
        if ring.is_none() {
            assume(what);
        }
    }
    let rollers = if written("rollers") {
        b.rollers
    } else {
        assume(Assumed::Rollers);
        match b.element {
            ElementKind::Roller => catalogue::usual_elements(d.pitch(), d.roller).max(3),
            ElementKind::Ball => catalogue::filled(d.pitch(), d.roller).max(3),
        }
    };
    let length = if written("thickness_mm") {
        b.thickness_mm
    } else {
        if b.element == ElementKind::Roller || main.width.is_none() {
            assume(Assumed::Length);
        }
        match (main.width, b.element) {
            (Some(width), of) => named::length_in(width, of.into()),
            (None, ElementKind::Roller) => d.roller,
            (None, ElementKind::Ball) => d.roller / named::ROLLER_LENGTH,
        }
    };
    let first = if written("first_roller_deg") { b.first_roller_deg } else { named::first_roller(rollers) };
    let thickest = |radius: f64| (RING * d.roller).min(OF_RADIUS * radius);
    Ok(BearingScene {
        designation: b.designation.clone(),
        outer_race_diameter_mm: tidy(d.outer),
        outer_ring_thickness_mm: tidy(outer_ring.unwrap_or(thickest(0.5 * d.outer))),
        inner_race_diameter_mm: tidy(d.inner),
        inner_ring_thickness_mm: tidy(inner_ring.unwrap_or(thickest(0.5 * d.inner))),
        element: b.element,
        rollers,
        roller_diameter_mm: tidy(d.roller),
        quality: b.quality,
        diameter_variation_um: b.diameter_variation_um,
        diameter_seed: b.diameter_seed,
        roller_profile: b.roller_profile,
        thickness_mm: tidy(length),
        first_roller_deg: first,
        clearance_change_um: b.clearance_change_um,
        pitch_mm: None,
        bore_mm: None,
        outside_mm: None,
        width_mm: None,
        assumed: if assumed.is_empty() { b.assumed.clone() } else { assumed },
    })
}

/// One of the rings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Side {
    Outer,
    Inner,
}

impl Given {
    /// Whether the paper's bearing with these dimensions is meant: its other dimensions are consistent with
    /// the given ones.
    fn may_be_the_papers(self) -> bool {
        if self.describes_another() {
            return false;
        }
        let paper = BearingScene::default();
        let of = Diameters {
            outer: self.outer.unwrap_or(paper.outer_race_diameter_mm),
            inner: self.inner.unwrap_or(paper.inner_race_diameter_mm),
            roller: self.roller.unwrap_or(paper.roller_diameter_mm),
        };
        let own = Diameters {
            outer: paper.outer_race_diameter_mm,
            inner: paper.inner_race_diameter_mm,
            roller: paper.roller_diameter_mm,
        };
        let close = |a: f64, b: f64| (a / b - 1.0).abs() <= PAPERS_SIZE;
        match (self.outer, self.inner, self.roller) {
            (None, None, None) => true,
            (Some(_), Some(_), Some(_)) => close(of.pitch(), own.pitch()) && close(of.roller, own.roller),
            _ => {
                let [least, most] = PAPERS_CLEARANCE;
                (least..=most).contains(&(of.clearance() / of.roller))
            }
        }
    }

    /// Whether a field is given that no scene of the paper's bearing has.
    fn describes_another(self) -> bool {
        [self.pitch, self.bore, self.outside, self.width].iter().any(Option::is_some)
    }

    /// Number of given raceways.
    fn raceways(self) -> usize {
        [self.outer, self.inner].iter().flatten().count()
    }

    /// All diameters, with the diametral clearance [mm] where it does not follow from given ones; `None`
    /// where too few are given.
    fn diameters(self, clearance: f64) -> Option<Diameters> {
        let between =
            |outer: f64, inner: f64| Diameters { outer, inner, roller: 0.5 * (outer - inner - clearance) };
        let pitch = self.pitch.or_else(|| Some(0.5 * (self.bore? + self.outside?)));
        Some(match (self.outer, self.inner, self.roller) {
            (Some(outer), Some(inner), Some(roller)) => Diameters { outer, inner, roller },
            (Some(outer), Some(inner), None) => between(outer, inner),
            (Some(outer), None, Some(roller)) => {
                Diameters { outer, inner: outer - 2.0 * roller - clearance, roller }
            }
            (None, Some(inner), Some(roller)) => {
                Diameters { outer: inner + 2.0 * roller + clearance, inner, roller }
            }
            (None, None, Some(roller)) => {
                let pitch = pitch?;
                let apart = roller + 0.5 * clearance;
                Diameters { outer: pitch + apart, inner: pitch - apart, roller }
            }
            (Some(outer), None, None) => between(outer, 2.0 * self.pitch? - outer),
            (None, Some(inner), None) => between(2.0 * self.pitch? - inner, inner),
            (None, None, None) => return None,
        })
    }

    /// Refuses dimensions that are given twice and differ.
    fn agree(self) -> Result<(), Box<Refusal>> {
        let Some(pitch) = self.pitch else { return Ok(()) };
        let without = Self { pitch: None, bore: None, outside: None, ..self };
        let Some(found) = without.diameters(0.0).map(Diameters::pitch) else { return Ok(()) };
        if (found / pitch - 1.0).abs() <= AGREE {
            return Ok(());
        }
        Err(Box::new(Refusal::new(
            "pitch_mm",
            format!(
                "`bearing.pitch_mm` is {}, and raceways and rollers make a pitch diameter of {} mm",
                number(pitch),
                number(tidy(found))
            ),
            format!("{} mm, or nothing: the diameters say it", number(tidy(found))),
            "leave `pitch_mm` out, or a raceway".to_owned(),
        )))
    }

    /// Thickness of a ring [mm] by the given dimensions; `None` without any.
    fn ring(
        self,
        b: &BearingScene,
        d: Diameters,
        written: bool,
        side: Side,
    ) -> Result<Option<f64>, Box<Refusal>> {
        let (boundary, name, thickness, field, name_of_ring) = match side {
            Side::Outer => {
                (self.outside, "outside_mm", b.outer_ring_thickness_mm, "outer_ring_thickness_mm", "outer")
            }
            Side::Inner => {
                (self.bore, "bore_mm", b.inner_ring_thickness_mm, "inner_ring_thickness_mm", "inner")
            }
        };
        let race = if side == Side::Outer { d.outer } else { d.inner };
        let left = boundary.map(|mm| 0.5 * if side == Side::Outer { mm - race } else { race - mm });
        match (left, written) {
            (None, false) => Ok(None),
            (None, true) => Ok(Some(thickness)),
            (Some(left), true) if (left - thickness).abs() <= AGREE * d.pitch() => Ok(Some(thickness)),
            (Some(left), false) if left > 0.0 => Ok(Some(left)),
            (Some(left), _) => {
                let (limit, than) = match side {
                    Side::Outer => (tidy(race + 0.5 * d.roller), "more"),
                    Side::Inner => (tidy(race - 0.5 * d.roller), "less"),
                };
                let also = if written {
                    format!(", and `{field}` says {}", number(thickness))
                } else {
                    String::new()
                };
                let refusal = Refusal::new(
                    name,
                    format!(
                        "`bearing.{name}` is {}, which leaves the {name_of_ring} ring {} mm beside its \
                         raceway of {} mm{also}",
                        number(boundary.unwrap_or(0.0)),
                        number(tidy(left)),
                        number(tidy(race)),
                    ),
                    format!("{than} than {} mm", number(tidy(race))),
                    format!("`{name}: {}`, or leave it out", number(limit)),
                );
                let is_alone = !written && limit > 0.0;
                Err(Box::new(refusal.repaired_by(is_alone.then(|| number(limit)))))
            }
        }
    }

    /// Missing dimensions, in words.
    fn lacks(self) -> Box<Refusal> {
        let fields = [
            ("roller_diameter_mm", self.roller),
            ("inner_race_diameter_mm", self.inner),
            ("outer_race_diameter_mm", self.outer),
            ("pitch_mm", self.pitch),
            ("bore_mm", self.bore),
            ("outside_mm", self.outside),
            ("width_mm", self.width),
        ];
        let given: Vec<&str> = fields.iter().filter(|(_, mm)| mm.is_some()).map(|(name, _)| *name).collect();
        let (missing, instead) = if self.roller.is_some() {
            ("where the rollers run", "`pitch_mm`, the diameter of a raceway, or `bore_mm` and `outside_mm`")
        } else if self.raceways() > 0 {
            ("the size of the rollers", "`roller_diameter_mm`, `pitch_mm` or the other raceway")
        } else {
            ("the size of the rollers", "`roller_diameter_mm`, and beside it `pitch_mm` or a raceway")
        };
        let first = given.first().copied().unwrap_or("roller_diameter_mm");
        let names: Vec<String> = given.iter().map(|name| format!("`{name}`")).collect();
        let paper = BearingScene::default();
        // One field of the paper's bearing that is not its own can be its own again.
        let papers = match (given.as_slice(), first) {
            ([_], "roller_diameter_mm") => Some(paper.roller_diameter_mm),
            ([_], "inner_race_diameter_mm") => Some(paper.inner_race_diameter_mm),
            ([_], "outer_race_diameter_mm") => Some(paper.outer_race_diameter_mm),
            _ => None,
        };
        let again = papers.map(|mm| format!("; `{first}: {}` is the paper's bearing", number(mm)));
        let refusal = Refusal::new(
            first,
            format!(
                "a bearing with {} is not the paper's, and of one's own it lacks {missing}",
                names.join(" and ")
            ),
            "a bearing by its `rollers` and two of `roller_diameter_mm`, `pitch_mm`, \
             `inner_race_diameter_mm` and `outer_race_diameter_mm`, or by its name"
                .to_owned(),
            format!("give {instead}, too{}", again.unwrap_or_default()),
        );
        Box::new(refusal.repaired_by(papers.map(number)))
    }

    /// Diameters that leave no room for rollers.
    fn impossible(self, d: Diameters) -> Box<Refusal> {
        let field = if self.pitch.is_some() {
            "pitch_mm"
        } else if self.roller.is_some() {
            "roller_diameter_mm"
        } else {
            "inner_race_diameter_mm"
        };
        Box::new(Refusal::new(
            field,
            format!(
                "these diameters make no bearing: raceways of {} and {} mm, rollers of {} mm",
                number(tidy(d.outer)),
                number(tidy(d.inner)),
                number(tidy(d.roller))
            ),
            "an outer raceway beyond the inner one, with the rollers between them".to_owned(),
            "check the diameters, in mm".to_owned(),
        ))
    }
}
