//! The figures of the report, in the order in which the page shows them.

mod acceleration;
mod beating;
mod duty;
mod forces;
mod motion;
mod spectra;

use maud::Markup;
use stribeck_scene::resolved::ResolvedScene;
use stribeck_store::run_dir::Run;

pub(super) use self::forces::{DRAWN as CROSSINGS, crossings as crossing_figures};
pub(super) use self::spectra::{about_the_tone, density, loudest_in_words};
use super::course;
use super::pictures::Pictures;
use crate::Error;
use crate::plot::{Axis, Band, Colour, Figure, Mark, Picture, Series, Tab};
use stribeck_analysis::duty::{DutyFinding, turns as duty_turns};
use stribeck_analysis::findings::Findings;
use stribeck_analysis::measured::{Course, Varying};
use stribeck_analysis::record::Record;

/// Shortest record with a spectrogram [s].
const SPECTROGRAM_S: f64 = 0.1;

/// Rows of the ledger that are drawn, at most: of a longer one every second, or third …
const LEDGER_ROWS: usize = 1 << 21;

/// A chart or a picture.
#[derive(Debug)]
pub(super) enum Item {
    Chart(Box<Figure>),
    Picture(Picture),
}

impl Item {
    pub(super) fn id(&self) -> &str {
        match self {
            Self::Chart(figure) => &figure.id,
            Self::Picture(picture) => &picture.id,
        }
    }

    pub(super) fn to_svg(&self) -> Result<String, Error> {
        match self {
            Self::Chart(figure) => figure.to_svg(),
            Self::Picture(picture) => Ok(picture.sheet.to_svg()),
        }
    }

    pub(super) fn to_html(&self) -> Result<Markup, Error> {
        match self {
            Self::Chart(figure) => figure.to_html(),
            Self::Picture(picture) => picture.to_html(),
        }
    }

    /// Its place among figures behind tabs.
    pub(super) fn tab(&self) -> Option<&Tab> {
        match self {
            Self::Chart(figure) => figure.tab.as_ref(),
            Self::Picture(picture) => picture.tab.as_ref(),
        }
    }

    /// How reliable it is.
    pub(super) fn note(&self) -> &str {
        match self {
            Self::Chart(figure) => &figure.note,
            Self::Picture(picture) => &picture.note,
        }
    }

    /// The form for the page with another note.
    pub(super) fn with_note(&self, note: String) -> Result<Markup, Error> {
        match self {
            Self::Chart(figure) => figure.clone().note(note).to_html(),
            Self::Picture(picture) => Picture { note, ..picture.clone() }.to_html(),
        }
    }

    /// The moving form, when there is one.
    pub(super) fn animation(&self) -> Option<&[u8]> {
        match self {
            Self::Chart(_) => None,
            Self::Picture(picture) => picture.animation.as_deref(),
        }
    }
}

/// All figures that the run can yield, grouped by section.
#[derive(Debug, Default)]
pub(super) struct Figures {
    pub(super) acceleration: Vec<Item>,
    pub(super) duty: Vec<Item>,
    pub(super) spectra: Vec<Item>,
    pub(super) forces: Vec<Item>,
    pub(super) bearing: Vec<Item>,
    pub(super) stress: Vec<Item>,
    pub(super) energy: Vec<Item>,
    /// Those that only the paper's argument needs.
    pub(super) paper: Vec<Item>,
}

impl Figures {
    pub(super) fn of(record: &Record<'_>, findings: &Findings, pictures: Pictures) -> Result<Self, Error> {
        let paper = if findings.of_paper { charts(beating::figures()).collect() } else { Vec::new() };
        Ok(Self {
            acceleration: charts(acceleration::raw(findings))
                .chain(charts(acceleration::others(record, findings)?))
                .chain(charts(acceleration::notched(findings)))
                .collect(),
            duty: charts(duty::figures(record, findings)).collect(),
            spectra: charts(spectra::raw(findings))
                .chain(charts(spectra::notched(findings)))
                .chain(charts(spectra::others(findings)))
                .chain(drawn(over_time(record, findings)?))
                .collect(),
            forces: charts(forces::crossings(findings)).collect(),
            bearing: drawn(pictures.load)
                .chain(charts(load(&record.run().scene, findings)))
                .chain(charts(forces::sums(record, findings)))
                .chain(charts(motion::figures(record, findings)?))
                .collect(),
            stress: drawn(pictures.mesh).chain(drawn(pictures.stress)).collect(),
            energy: charts(energy(record.run())?).collect(),
            paper,
        })
    }

    pub(super) fn all(&self) -> impl Iterator<Item = &Item> {
        [
            &self.acceleration,
            &self.duty,
            &self.spectra,
            &self.forces,
            &self.bearing,
            &self.stress,
            &self.energy,
            &self.paper,
        ]
        .into_iter()
        .flatten()
    }
}

/// Spectra of the leading sensor over time, of a record that is long enough to have a course; where the speed
/// changes over speed and angle, too.
fn over_time(record: &Record<'_>, findings: &Findings) -> Result<Vec<Picture>, Error> {
    const TABS: &str = "course";
    let Some(leading) = findings.sensors.first() else { return Ok(Vec::new()) };
    let rate_hz = 1.0 / findings.interval_s;
    if findings.interval_s * (leading.raw_g.len() as f64) < SPECTROGRAM_S {
        return Ok(Vec::new());
    }
    let varying = varying(record, findings, &leading.raw_g, rate_hz)?;
    let course = match &varying {
        Some(varying) => varying.course.clone(),
        None => Course::of(&leading.raw_g, rate_hz)?,
    };
    let mut picture = course::picture(&course, "g").tabbed(TABS, "spectrogram");
    picture.title = format!("Spectrogram of a_y at sensor “{}”", leading.name);
    // The picture begins at zero, where a stretch of a record does not.
    if findings.start_s > findings.interval_s {
        picture.note += &format!(" Time counts from {:.3} s of the run.", findings.start_s);
    }
    let mut pictures = vec![picture];
    let speeds = varying.as_ref().map(|varying| varying.speeds_rpm.as_slice());
    pictures.extend(course::waterfall(&course, "g", speeds).map(|picture| picture.tabbed(TABS, "waterfall")));
    let orders = findings.summary.duty.as_ref().map_or(&[][..], |duty| &duty.orders);
    pictures.extend(varying.as_ref().and_then(|varying| {
        let map = course::order_map(varying.orders.as_ref()?, varying.band_hz, orders);
        Some(map.tabbed(TABS, "order map"))
    }));
    Ok(pictures)
}

/// Spectra over speed and angle, of a shaft that changes its speed and does not turn back.
fn varying(
    record: &Record<'_>,
    findings: &Findings,
    signal: &[f64],
    rate_hz: f64,
) -> Result<Option<Varying>, Error> {
    let unsteady = findings.summary.duty.as_ref().is_some_and(DutyFinding::is_unsteady);
    let Some(turns) = duty_turns(record).filter(|turns| unsteady && turns.len() == signal.len()) else {
        return Ok(None);
    };
    if turns.windows(2).any(|pair| pair[1] < pair[0]) {
        return Ok(None);
    }
    let band_hz = findings.summary.duty.as_ref().and_then(|duty| Some(duty.envelope.as_ref()?.band_hz));
    Ok(Some(Varying::of(signal, rate_hz, &turns, band_hz.unwrap_or((0.05 * rate_hz, 0.45 * rate_hz)))?))
}

fn charts(figures: impl IntoIterator<Item = Figure>) -> impl Iterator<Item = Item> {
    figures.into_iter().map(|figure| Item::Chart(Box::new(figure)))
}

fn drawn(pictures: Vec<Picture>) -> impl Iterator<Item = Item> {
    pictures.into_iter().map(Item::Picture)
}

fn load(scene: &ResolvedScene, findings: &Findings) -> Vec<Figure> {
    let dynamic = &findings.distribution;
    if dynamic.mean_n.iter().all(|f| f.is_nan()) {
        return Vec::new();
    }
    let spalled = findings.prediction.standing_spalls().next().is_some();
    let mut figure = Figure::new(
        "load-distribution",
        "Load distribution",
        Axis::angle("Angle from the x axis, counter-clockwise"),
        Axis::si("Outer-raceway force", "N"),
    )
    .with(Series::listed(
        "dynamic, mean by angle",
        Colour::Blue,
        dynamic.angle_deg.clone(),
        dynamic.mean_n.clone(),
    ))
    .caption(format!(
        "Mean force on a roller by its place{} beside rigid rings at rest.",
        if spalled {
            ": over the defect it carries less, its neighbours take over, and elsewhere it can be set"
        } else {
            ","
        }
    ))
    .note(format!(
        "Dynamic: mean over all rollers and samples in bins of one degree. Static: rigid rings{}, mean over \
         {} of cage positions{}.{}",
        if scene.written.operation.load_varies() { " under the mean load" } else { "" },
        if scene.written.rollers_in_place().count() < scene.written.bearing.rollers {
            "a whole turn"
        } else {
            "one roller spacing"
        },
        if spalled { "; a roller over the defect is left out" } else { "" },
        if scene.written.housing.is_rigid() { "" } else { " An elastic outer ring differs by 10 to 20 %." }
    ));
    if let Some(curve) = &findings.static_curve {
        let (angle_deg, force_n) = (curve.angle_deg.clone(), curve.force_n.clone());
        figure = figure.with(Series::listed("static, rigid rings", Colour::Orange, angle_deg, force_n));
    }
    for edges in findings.prediction.standing_spalls() {
        let label = "defect".into();
        let (one, other) = (edges.trailing_deg, edges.leading_deg);
        figure.bands.push(Band { from: one.min(other), to: one.max(other), label });
    }
    vec![figure]
}

fn energy(run: &Run) -> Result<Vec<Figure>, Error> {
    let energy = run.energy.read_thinned(LEDGER_ROWS)?;
    let Some(time) = energy.get("time_s").filter(|t| !t.is_empty()) else { return Ok(Vec::new()) };
    let parts = [
        ("kinetic_j", "kinetic", Colour::Blue),
        ("strain_j", "strain", Colour::Orange),
        ("hourglass_j", "hourglass", Colour::Brown),
        ("contact_j", "contact", Colour::Green),
        ("friction_j", "friction", Colour::Red),
        ("damping_j", "damping", Colour::Purple),
        ("contact_damping_j", "contact damping", Colour::Teal),
        ("film_j", "oil films", Colour::Pink),
        ("external_j", "supplied by load", Colour::Grey),
        ("drive_j", "supplied by drive", Colour::Black),
    ];
    let mut ledger = Figure::new(
        "energy",
        "Energy ledger, change since the start",
        Axis::si("Time", "s"),
        Axis::si("Energy", "J"),
    )
    .synced("time")
    .caption(format!(
        "What load and drive supply is found again as motion, strain and heat, within {}.",
        run.info.energy.in_words()
    ))
    .note("Friction, damping and contact damping only grow; kinetic and strain energy go up and down.");
    for (channel, name, colour) in parts {
        if let Some(values) = energy.get(channel).filter(|v| v.iter().any(|&e| e != 0.0)) {
            let first = values.first().copied().unwrap_or(0.0);
            let change = values.iter().map(|e| e - first).collect();
            ledger = ledger.with(Series::listed(name, colour, time.to_vec(), change));
        }
    }
    let mut figures = vec![ledger];
    if let Some(error) = energy.get("relative_error") {
        let percent = error.iter().map(|e| 100.0 * e).collect();
        figures.push(
            Figure::new(
                "energy-error",
                "Energy imbalance",
                Axis::si("Time", "s"),
                Axis::plain("Imbalance / peak strain energy", "%"),
            )
            .synced("time")
            .with(Series::listed("imbalance", Colour::Red, time.to_vec(), percent))
            .caption(format!(
                "The largest imbalance is {}; a run stops when its limit is passed.",
                run.info.energy.in_words()
            )),
        );
    }
    Ok(figures)
}

pub(super) fn sampled(findings: &Findings, name: &str, colour: Colour, values: &[f64]) -> Series {
    Series::sampled(name, colour, findings.start_s, findings.interval_s, values.to_vec())
}

pub(super) fn mark(x: f64, label: &str, colour: Colour, dashed: bool) -> Mark {
    Mark { x, label: label.into(), colour, dashed }
}

pub(super) fn transient(findings: &Findings) -> Vec<Band> {
    let length = findings.transient_s();
    if length == 0.0 {
        return Vec::new();
    }
    let label = format!("transient of the notch, {:.1} ms", 1e3 * length);
    vec![Band { from: findings.start_s, to: findings.start_s + length, label }]
}

/// A stable name as words.
pub(super) fn spoken(name: &str) -> String {
    name.replace('_', " ")
}
