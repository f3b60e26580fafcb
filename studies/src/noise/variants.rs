//! Variants of the study of contact noise: one change a row.

use crate::Variant;

pub(crate) const LEAN: &str = "fixtures/scenes/studies/lean.ron";
pub(crate) const UNIFORM: &str = "fixtures/scenes/studies/uniform.ron";
/// One exit and the quiet time until the next entry, no pictures.
const SHORT: [&str; 2] = ["solver.duration_ms=12.0", "output.frames=None"];
/// Three exits, two quiet times.
const LONG: [&str; 2] = ["solver.duration_ms=30.0", "output.frames=None"];
/// One exit and most of the quiet time behind it, at half the element size too.
const EXIT: [&str; 2] = ["solver.duration_ms=11.5", "output.frames=None"];

/// Measured with copies of the roller in one orientation, the default of its time.
pub(crate) const TRANSLATED: &str = "mesh.roller_copies=translated";
pub(crate) const ARC: &str = "contact.surface=arc";
const NAGATA: &str = "contact.surface=nagata";
pub(crate) const SPLINE: &str = "contact.interpolation=spline";
pub(crate) const ONSET: &str = "contact.onset_um=8.0";
/// Hardly wider than points are apart.
const NARROW: &str = "contact.onset_um=3.0";
/// As in `singh2014_smooth.ron`.
pub(crate) const POINTS: &str = "contact.points_per_facet=8";
const STIFF: &str = "contact.penalty_scale=0.7";
/// A stiffer contact sinks in less.
const STIFF_ONSET: &str = "contact.onset_um=0.5";
/// The first roller a little ahead or behind: ten microseconds.
const STARTS: [(&str, &str); 3] = [("", "94.0"), ("-ahead", "93.99"), ("-behind", "94.01")];
/// Elements of half the size under the same contact: stiffness and damping over an area stay.
pub(crate) const FINE: [&str; 6] = [
    "mesh.size_mm=0.25",
    "mesh.roller_facets=224",
    "mesh.grading.fine_layers=4",
    "contact.penalty_scale=0.025",
    "contact.damping_ratio=0.141421356",
    "contact.points_per_facet=6",
];

/// A variant and its purpose.
pub(super) struct Step {
    pub(super) variant: Variant,
    pub(super) shows: &'static str,
}

fn step(name: &str, scene: &'static str, set: &[&str], shows: &'static str) -> Step {
    let variant =
        SHORT.iter().fold(Variant::new(name, scene, set).with(TRANSLATED), |variant, s| variant.with(*s));
    Step { variant, shows }
}

/// From the paper's method to the cure, one change a row, on the graded mesh.
pub(super) fn ablation() -> Vec<Step> {
    let lean = |name: &str, set: &[&str], shows| step(name, LEAN, set, shows);
    vec![
        lean("collocated", &["contact.method=collocated"], "Pressure lumped at nodes instead of integrated."),
        lean("paper", &[], "The default scene\u{2019}s method: chords, sixteen points a facet."),
        lean("one-pass", &["contact.passes=one"], "Points of the rollers alone, with the whole stiffness."),
        lean("arc", &[ARC], "The sag of the chords gone."),
        lean("nagata", &[NAGATA], "The same without knowing the centres of the circles."),
        lean("arc-spline", &[ARC, SPLINE], "The difference of compliance at and between nodes gone."),
        lean("smooth", &[ARC, SPLINE, POINTS, ONSET], "A soft onset, fewer points: the cure."),
        lean("nagata-smooth", &[NAGATA, SPLINE, POINTS, ONSET], "The cure without knowing the centres."),
    ]
}

/// Changes that the cure does not need, and its remaining noise.
pub(super) fn remainder() -> Vec<Step> {
    let cure = |name: &str, set: &[&str], shows| {
        let all: Vec<&str> = [ARC, SPLINE, POINTS, ONSET].into_iter().chain(set.iter().copied()).collect();
        step(name, LEAN, &all, shows)
    };
    vec![
        cure("smooth-12", &["contact.points_per_facet=12"], "More points: what of the residue passes them."),
        cure("smooth-5", &["contact.points_per_facet=5"], "Fewer points."),
        cure(
            "smooth-narrow",
            &[NARROW],
            "A narrower onset, 3 µm: points that come and go sound at eight times the line\u{2019}s \
             frequency, 37.4 kHz, \
             most of all at the seat.",
        ),
        cure("smooth-one-pass", &["contact.passes=one"], "The two half passes against one."),
        cure(
            "smooth-frictionless",
            &["contact.friction=0.0"],
            "Stick and slip at the points: without friction there is none.",
        ),
        cure("smooth-rough", &["contact.friction=0.05"], "The same, ten times as much."),
        cure(
            "smooth-sudden",
            &["solver.start=sudden"],
            "Start-up: load and speed put on at once instead of a preload.",
        ),
        cure(
            "smooth-damped",
            &["contact.damping_ratio=0.5"],
            "Ringing of the contact: five times its damping.",
        ),
        cure(
            "smooth-124",
            &["mesh.roller_facets=124"],
            "Another number of facets: what moves with it is of the mesh.",
        ),
    ]
}

/// A contact as stiff as elements.
pub(super) fn stiff() -> Vec<Step> {
    vec![
        step("stiff", LEAN, &[STIFF], "Chords."),
        step("stiff-arc", LEAN, &[ARC, STIFF], "Arcs."),
        step("stiff-spline", LEAN, &[ARC, STIFF, SPLINE], "Splines."),
        step("stiff-smooth", LEAN, &[ARC, STIFF, SPLINE, POINTS, STIFF_ONSET], "With onset."),
    ]
}

/// The paper's own mesh.
pub(super) fn uniform() -> Vec<Step> {
    vec![
        step("uniform-paper", UNIFORM, &[], "The default scene."),
        step("uniform-smooth", UNIFORM, &[ARC, SPLINE, POINTS, ONSET], "singh2014_smooth.ron."),
    ]
}

/// Both methods for as long as the default scene: the averaged level at the line.
pub(super) fn long() -> Vec<Variant> {
    let of = |name: &str, set: &[&str]| {
        LONG.iter().fold(Variant::new(name, LEAN, set).with(TRANSLATED), |variant, s| variant.with(*s))
    };
    vec![of("paper-long", &[]), of("smooth-long", &[ARC, SPLINE, POINTS, ONSET])]
}

/// The paper's method, the cure, and the cure on elements of half the size, each from several starts.
pub(super) fn converged() -> [Vec<Variant>; 3] {
    let of = |name: &str, set: &[&str]| -> Vec<Variant> {
        let start = |(start, degrees): &(&str, &str)| {
            let variant = Variant::new(format!("{name}{start}"), LEAN, set).with(TRANSLATED);
            let variant = EXIT.iter().fold(variant, |variant, s| variant.with(*s));
            variant.with(format!("bearing.first_roller_deg={degrees}"))
        };
        STARTS.iter().map(start).collect()
    };
    let fine: Vec<&str> = [ARC, SPLINE, ONSET].into_iter().chain(FINE).collect();
    [of("chords", &[]), of("cured", &[ARC, SPLINE, POINTS, ONSET]), of("fine", &fine)]
}
