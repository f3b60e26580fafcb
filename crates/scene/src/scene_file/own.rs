//! A bearing of one's own: by `rollers`, `roller_diameter_mm` and `pitch_mm`, or both raceways in the place of the
//! latter. The rest follows by one rule ([`Own::bearing`]), and cage, housing, defect, elements and load follow the
//! bearing ([`surround`](super::named::surround)).
//!
//! Without them a scene has the paper's bearing, of which single dimensions may be changed a little.

use super::named::{self, Surrounded, tidy};
use crate::field::wording::number;
use crate::reading::problem::Problem;
use crate::reading::sources::Sources;
use crate::scene::{Assumed, BearingScene, ElementKind, Scene};
use stribeck_theory::catalogue::normal_clearance_mm;

/// Single diameters of the paper's bearing may be others where they leave such a clearance, in diameters of a
/// roller …
const PAPERS_CLEARANCE: [f64; 2] = [-0.005, 0.03];
/// … and all of them where rollers and pitch differ from its own by no more than this part.
const PAPERS_SIZE: f64 = 0.01;
/// Thickness of a ring over the diameter of a rolling element where its bore or outside diameter is not given: 0.37
/// to 0.43 in NU 205 to NU 312.
const RING: f64 = 0.4;
/// Largest clearance that is assumed, in diameters of a rolling element.
const MOST_CLEARANCE: f64 = 0.02;

/// The dimensions of a bearing that are asked for, and those of its boundary, as far as they are given. Lengths in mm.
pub(super) struct Own {
    pub(super) element: ElementKind,
    pub(super) rollers: usize,
    pub(super) roller: f64,
    pub(super) pitch: f64,
    /// Outer and inner raceway, where they are given in the place of the pitch diameter.
    pub(super) raceways: Option<[f64; 2]>,
    pub(super) bore: Option<f64>,
    pub(super) outside: Option<f64>,
    pub(super) width: Option<f64>,
}

impl Own {
    /// The bearing, by the rule of the guide's page on one's own bearing: the clearance is the middle of the normal
    /// group (ISO 5753-1) for the bore; each ring lies between its raceway and bore or outside diameter, or is 0.4
    /// of a rolling element thick; rollers are 0.6 of the width long, or as long as thick; balls have rings as wide
    /// as the width, or a ball over 0.6.
    pub(super) fn bearing(&self) -> BearingScene {
        let Self { element, rollers, roller, pitch, .. } = *self;
        let mut assumed = Vec::new();
        let [outer, inner] = self.raceways.unwrap_or_else(|| {
            assumed.push(Assumed::Clearance);
            let bore = self.bore.unwrap_or(pitch - (1.0 + 2.0 * RING) * roller);
            let clearance = normal_clearance_mm(element.into(), bore).min(MOST_CLEARANCE * roller);
            let apart = roller + 0.5 * clearance;
            [pitch + apart, pitch - apart]
        });
        let mut ring = |across: Option<f64>, what: Assumed| match across {
            Some(across) => 0.5 * across,
            None => {
                assumed.push(what);
                RING * roller
            }
        };
        let outer_ring = ring(self.outside.map(|outside| outside - outer), Assumed::OuterRing);
        let inner_ring = ring(self.bore.map(|bore| inner - bore), Assumed::InnerRing);
        if element == ElementKind::Roller || self.width.is_none() {
            assumed.push(Assumed::Length);
        }
        BearingScene {
            element,
            rollers,
            roller_diameter_mm: tidy(roller),
            outer_race_diameter_mm: tidy(outer),
            inner_race_diameter_mm: tidy(inner),
            outer_ring_thickness_mm: tidy(outer_ring),
            inner_ring_thickness_mm: tidy(inner_ring),
            thickness_mm: tidy(match (self.width, element) {
                (Some(width), of) => named::length_in(width, of.into()),
                (None, ElementKind::Roller) => roller,
                (None, ElementKind::Ball) => roller / named::ROLLER_LENGTH,
            }),
            first_roller_deg: named::first_roller(rollers),
            assumed,
            ..BearingScene::default()
        }
    }
}

/// Whether raceways and rollers are the paper's.
pub(super) fn is_papers(b: &BearingScene) -> bool {
    main(b) == main(&BearingScene::default())
}

/// Raceways and rollers [mm].
fn main(b: &BearingScene) -> [f64; 3] {
    [b.outer_race_diameter_mm, b.inner_race_diameter_mm, b.roller_diameter_mm]
}

/// Whether the paper's bearing is meant by a scene that gives some of the main diameters, and no pitch diameter.
fn may_be_papers(b: &BearingScene, given: usize) -> bool {
    let ([outer, inner, roller], [its_outer, its_inner, its_roller]) =
        (main(b), main(&BearingScene::default()));
    let close = |a: f64, b: f64| (a / b - 1.0).abs() <= PAPERS_SIZE;
    let [least, most] = PAPERS_CLEARANCE;
    match given {
        0 => true,
        3 => close(outer + inner, its_outer + its_inner) && close(roller, its_roller),
        _ => (least..=most).contains(&((outer - inner - 2.0 * roller) / roller)),
    }
}

/// Completes the bearing of a scene and its surroundings, unless it is the paper's. `given` has the paths of
/// the written fields; all others are the paper's.
///
/// # Errors
/// A bearing that lacks one of its numbers, or whose rings do not fit around them.
pub(super) fn complete(scene: &mut Scene, given: &[String], sources: &Sources) -> Result<(), Box<Problem>> {
    let b = &scene.bearing;
    let written = |name: &str| given.iter().any(|path| path.strip_prefix("bearing.") == Some(name));
    let diameters = ["outer_race_diameter_mm", "inner_race_diameter_mm", "roller_diameter_mm"];
    let [has_outer, has_inner, has_roller] = diameters.map(written);
    let count = diameters.into_iter().filter(|name| written(name)).count();
    let around = [
        ("pitch_mm", b.pitch_mm),
        ("bore_mm", b.bore_mm),
        ("outside_mm", b.outside_mm),
        ("width_mm", b.width_mm),
    ];
    let describes = around.iter().find(|(_, mm)| mm.is_some()).map(|(name, _)| *name);
    if describes.is_none() && may_be_papers(b, count) {
        return Ok(());
    }
    // Values out of range are refused elsewhere.
    let all = around.iter().filter_map(|(_, mm)| *mm).chain(main(b));
    if all.into_iter().any(|mm| !(mm > 0.0 && mm < 20_000.0)) || b.rollers < 3 {
        return Ok(());
    }
    let raceways = (has_outer && has_inner).then_some([b.outer_race_diameter_mm, b.inner_race_diameter_mm]);
    let pitch = match (b.pitch_mm, raceways) {
        (Some(pitch), None) if !has_outer && !has_inner => Some(pitch),
        (None, Some([outer, inner])) => Some(0.5 * (outer + inner)),
        _ => None,
    };
    let blamed = describes.or_else(|| diameters.into_iter().find(|name| written(name))).unwrap_or("rollers");
    let refuse = |name: &str, message: String, allowed: String| {
        let field = format!("bearing.{name}");
        Box::new(Problem { allowed, ..Problem::new(message, sources.place(&field)).of(&field) })
    };
    let Some(pitch) = pitch.filter(|_| has_roller && written("rollers")) else {
        let asked = [("rollers", written("rollers")), ("roller_diameter_mm", has_roller)];
        let asked = asked.into_iter().chain([("pitch_mm", b.pitch_mm.is_some() || raceways.is_some())]);
        let lacks: Vec<&str> = asked.filter(|(_, there)| !there).map(|(name, _)| name).collect();
        let message = match lacks.as_slice() {
            [] => "a bearing of one's own has `pitch_mm` or its two raceways, not both".to_owned(),
            _ => format!(
                "a bearing with this `{blamed}` is not the paper's, and of one's own it lacks {}",
                super::list(&lacks)
            ),
        };
        let allowed = "`rollers`, `roller_diameter_mm` and `pitch_mm`, and, where they are known, `bore_mm`, \
                       `outside_mm` and `width_mm`";
        return Err(refuse(blamed, message, allowed.to_owned()));
    };
    let own = Own {
        element: b.element,
        rollers: b.rollers,
        roller: b.roller_diameter_mm,
        pitch,
        raceways,
        bore: b.bore_mm,
        outside: b.outside_mm,
        width: b.width_mm,
    };
    let of_rule = own.bearing();
    let mut bearing =
        BearingScene { pitch_mm: None, bore_mm: None, outside_mm: None, width_mm: None, ..b.clone() };
    [bearing.outer_race_diameter_mm, bearing.inner_race_diameter_mm, bearing.roller_diameter_mm] =
        main(&of_rule);
    let mut assumed = of_rule.assumed;
    for (name, instead, what, value, field) in [
        (
            "outer_ring_thickness_mm",
            own.outside,
            Assumed::OuterRing,
            of_rule.outer_ring_thickness_mm,
            &mut bearing.outer_ring_thickness_mm,
        ),
        (
            "inner_ring_thickness_mm",
            own.bore,
            Assumed::InnerRing,
            of_rule.inner_ring_thickness_mm,
            &mut bearing.inner_ring_thickness_mm,
        ),
        ("thickness_mm", own.width, Assumed::Length, of_rule.thickness_mm, &mut bearing.thickness_mm),
    ] {
        match (written(name), instead) {
            (false, _) => *field = value,
            (true, None) => assumed.retain(|other| *other != what),
            (true, Some(_)) => {
                let message =
                    format!("`bearing.{name}` and bore, outside diameter or width say the same twice");
                return Err(refuse(name, message, "one of them".to_owned()));
            }
        }
    }
    if !assumed.is_empty() {
        bearing.assumed = assumed;
    }
    if !written("first_roller_deg") {
        bearing.first_roller_deg = of_rule.first_roller_deg;
    }
    let [outer, inner, roller] = main(&bearing);
    if inner <= 0.0 {
        let message = format!(
            "rollers of {} mm have no room on a pitch diameter of {} mm",
            number(roller),
            number(pitch)
        );
        return Err(refuse(blamed, message, format!("a pitch diameter of more than {} mm", number(roller))));
    }
    for (name, mm, race, than, left) in [
        ("outside_mm", own.outside, outer, "more", bearing.outer_ring_thickness_mm),
        ("bore_mm", own.bore, inner, "less", bearing.inner_ring_thickness_mm),
    ] {
        if let Some(mm) = mm.filter(|_| left <= 0.0) {
            let message = format!(
                "`bearing.{name}` is {}, which leaves no ring beside its raceway of {} mm",
                number(mm),
                number(race)
            );
            return Err(refuse(name, message, format!("{than} than {} mm", number(race))));
        }
    }
    if !given.iter().any(|path| path == "name") {
        scene.name = match named::plain_name(&bearing.designation) {
            name if name.is_empty() => "own".to_owned(),
            name => name,
        };
    }
    let element = bearing.element.into();
    named::surround(scene, Surrounded { bearing, pitch_mm: 0.5 * (outer + inner), element }, given);
    Ok(())
}
