//! The paper, figure by figure: its numbers beside those of a run or of many starts, differences first, and
//! its figures redrawn on its axes.

mod beating;
mod figures;
mod numbers;

use maud::{Markup, html};
use stribeck_analysis::findings::{Findings, SensorSignal};
use stribeck_analysis::paper::{self, Beside};
use stribeck_analysis::statistic::Statistic;
use stribeck_analysis::summary::{SensorLevels, Summary};
use stribeck_diagnosis::words::numbers::significant;
use stribeck_scene::scene::{ContactFormula, ContactSurface, Scene};

use crate::page::{self, Section, cell, charts, grouped, wide_table};

pub(super) fn section(case: &PaperCase<'_>, summary: &Summary) -> Section {
    case.section(html! { (numbers::table(summary)) (numbers::readings(summary)) })
}

/// Why peaks of a contact by a penalty differ from the paper's: the study `paper` varies its stiffness.
const SOFT: &str = "The paper does not print the stiffness of its contact, and peaks follow it: six times as high where \
    the penalty is 30 times as stiff. This run has a penalty, not the contact of steel by Hertz.";

/// A run of the paper's bearing, or many starts of it of which one is drawn.
pub(crate) struct PaperCase<'a> {
    /// All starts; of a single run that one.
    starts: Vec<&'a Findings>,
    /// The start that is drawn, and its number where there are several.
    drawn: &'a Findings,
    number: Option<usize>,
    /// The sensor whose a_y is shown, in the drawn start.
    levels: &'a SensorLevels,
    sensor: &'a SensorSignal,
    beside: Vec<Beside>,
    /// What the stiffness of its contact does to peaks, in a sentence.
    softness: &'static str,
    /// Whether the record is shorter than the paper's: a missing event may then lie after its end.
    short: bool,
    /// Whether contact is with arcs, and the tone of the mesh is gone with the facets.
    cured: bool,
    /// Whether contact is with facets.
    faceted: bool,
    /// Starts that are kept with the program, beside a single run.
    kept: usize,
}

impl<'a> PaperCase<'a> {
    /// Of a single run; `None` for another bearing than the paper's, or without a sensor.
    pub(crate) fn of_run(scene: &'a Scene, findings: &'a Findings) -> Option<Self> {
        Self::new(scene, vec![findings], findings, None)
    }

    /// Of many starts, of which number `number` is drawn.
    pub(crate) fn of_starts(
        scene: &'a Scene,
        starts: Vec<&'a Findings>,
        (number, drawn): (usize, &'a Findings),
    ) -> Option<Self> {
        Self::new(scene, starts, drawn, Some(number))
    }

    fn new(
        scene: &'a Scene,
        starts: Vec<&'a Findings>,
        drawn: &'a Findings,
        number: Option<usize>,
    ) -> Option<Self> {
        let levels = paper::sensor(scene, &drawn.summary.levels.sensors).filter(|_| drawn.of_paper)?;
        let sensor = drawn.sensors.iter().find(|sensor| sensor.name == levels.sensor)?;
        let of_start = |start: &&Findings| {
            let here = start.summary.levels.sensors.iter().find(|other| other.sensor == levels.sensor)?;
            Some(paper::shown(&start.summary, here))
        };
        let numbers: Vec<_> = starts.iter().filter_map(of_start).collect();
        let end_s = drawn.start_s + drawn.interval_s * sensor.raw_g.len() as f64;
        let short = end_s < figures::RECORD_S.1 - 2.0 * drawn.interval_s;
        let softness = if scene.contact.formula == ContactFormula::Hertz { "" } else { SOFT };
        let beside = paper::beside(&numbers);
        let faceted = scene.contact.surface == ContactSurface::Facet;
        // The fundamental is the first of its numbers.
        let tone = beside.iter().find(|b| b.shown.is_of_tone());
        let cured = !faceted && tone.is_some_and(|tone| tone.ours.is_none());
        let kept = beside.iter().filter_map(|b| Some(b.kept?.of)).max().unwrap_or(0);
        Some(Self { starts, drawn, number, levels, sensor, beside, softness, short, cured, faceted, kept })
    }

    /// Whether a number is missing because the record ends before it can show.
    fn is_behind_the_end(&self, b: &Beside) -> bool {
        self.short && b.ours.is_none_or(|ours| ours.mean == 0.0)
    }

    /// Whether a number is one of the tone that contact on arcs has taken away.
    fn is_cured(&self, b: &Beside) -> bool {
        self.cured && b.shown.is_of_tone()
    }

    /// What became of the tone of the mesh, and the scene that shows the other case.
    pub(crate) fn of_tone(&self) -> &'static str {
        match (self.cured, self.faceted) {
            (true, _) => {
                "The tone of the mesh at 4.7 kHz is gone, as contact on arcs predicts; `singh2014.ron` has it."
            }
            (_, true) => {
                "The tone is one of the mesh: `singh2014_smooth.ron` is the same run with contact on arcs."
            }
            _ => "",
        }
    }

    /// The section: differences, numbers, the paper's figures in its order, and `more` folded up behind them.
    pub(crate) fn section(&self, more: Markup) -> Section {
        let mut figures = figures::all(self);
        // Its figure 5 is drawn without a run.
        if self.number.is_none() {
            let sixth = figures.iter().position(|figure| figure.id == "paper-6").unwrap_or(figures.len());
            figures.splice(sixth..sixth, beating::figures());
        }
        let before = html! {
            p { (self.verdict()) }
            p { (page::with_code(self.of_tone())) }
            (self.table())
            p class="hint" { (page::with_code(&self.about())) }
        };
        let after = html! { details { summary { "Each number of the paper, and ours" } (more) } };
        Section::new("numbers", "The paper, figure by figure")
            .linked("The paper")
            .before(before)
            .figures(charts(figures), "")
            .after(after)
    }

    /// The numbers whose event is on record.
    fn on_record(&self) -> impl Iterator<Item = &Beside> {
        self.beside.iter().filter(|b| !self.is_behind_the_end(b) && !self.is_cured(b))
    }

    /// How many numbers of the paper's figures are met.
    pub(crate) fn headline(&self) -> String {
        let [all, met] = [self.on_record().count(), self.on_record().filter(|b| !b.differs()).count()];
        let scatter = if self.starts.len() > 1 { "starts scatter" } else { "one start may scatter" };
        format!("{met} of {all} numbers that Singh et al. (2014) print are met within what {scatter}.")
    }

    /// The four numbers that the paper is about, and why peaks are not those of steel where they are not.
    pub(crate) fn main_numbers(&self) -> Markup {
        let main: Vec<&Beside> = self.beside.iter().filter(|b| b.shown.is_main()).collect();
        let has_off_peaks = main.iter().any(|b| b.shown.unit == "g" && b.differs() && !self.is_cured(b));
        html! {
            table class="main" {
                tr {
                    th { "" } th class="n" { "Paper" } th class="n" { "Ours" }
                    @if self.kept > 0 { th class="n" { (self.kept) " starts" } }
                    th { "" }
                }
                @for b in main {
                    tr {
                        td { (b.shown.quantity) " (Fig. " (b.shown.figure) ")" }
                        td class="n" { (printed(b)) }
                        (cell(ours(b)))
                        @if self.kept > 0 { (cell(b.kept.map(|s| with_scatter(&s)))) }
                        td { (self.judged(b)) }
                    }
                }
            }
            @if has_off_peaks && !self.softness.is_empty() { p class="hint" { (self.softness) } }
        }
    }

    fn judged(&self, b: &Beside) -> Markup {
        html! {
            @if self.is_cured(b) { "gone with the facets" }
            @else if self.is_behind_the_end(b) { "not on record" }
            @else if b.differs() { strong { "differs" } }
            @else { "agrees" }
        }
    }

    /// Quantities that differ by more than the scatter, the largest difference first, then the others.
    fn verdict(&self) -> String {
        let missing = self.beside.iter().filter(|b| self.is_behind_the_end(b) && !self.is_cured(b)).count();
        let mut off: Vec<&Beside> = self.on_record().filter(|b| b.differs()).collect();
        off.sort_by(|a, b| b.distance().total_cmp(&a.distance()));
        let differing: Vec<String> =
            off.iter().map(|b| format!("{} (Fig. {})", told(b), b.shown.figure)).collect();
        let all = self.on_record().count();
        let alike = all - off.len();
        let short = if missing > 0 {
            format!(
                " {missing} more are not on record: it is shorter than the paper's {:.0} ms.",
                1e3 * figures::RECORD_S.1
            )
        } else {
            String::new()
        };
        let scatter = if self.starts.len() > 1 { "starts scatter" } else { "one start may scatter" };
        if differing.is_empty() {
            return format!(
                "None of {all} numbers of its figures differs from ours by more than {scatter}.{short}"
            );
        }
        format!(
            "Different by more than {scatter}: {}. The other {alike} of {all} numbers agree.{short}",
            differing.join("; ")
        )
    }

    /// Paper and ours, in the order of the figures.
    fn table(&self) -> Markup {
        let several = self.starts.len() > 1;
        let head = html! {
            th { "Figure" } th { "What it shows" } th class="n" { "Paper" }
            th class="n" { @if several { "Ours, mean ± 95 %" } @else { "Ours" } }
            @if several { th class="n" { "Single starts" } }
            @if self.kept > 0 { th class="n" { (self.kept) " starts of singh2014.ron" } }
            th { "Beyond the scatter" }
        };
        let row = |(first, b): (bool, &Beside)| {
            html! {
                td { @if first { (b.shown.figure) } }
                td { (b.shown.quantity) }
                td class="n" { (printed(b)) }
                (cell(ours(b)))
                @if several { (cell(b.ours.map(|s| format!("{} to {}", number(s.least), number(s.most))))) }
                @if self.kept > 0 { (cell(b.kept.map(|s| with_scatter(&s)))) }
                td { (self.judged(b)) }
            }
        };
        wide_table(
            Some("numbers"),
            &head,
            grouped(&self.beside, |a, b| a.shown.figure == b.shown.figure).map(row),
        )
    }

    /// Sources of the numbers, and the limits of the comparison.
    fn about(&self) -> String {
        let radial = 100.0 * self.levels.angle_deg.to_radians().sin().abs();
        let scatter = if self.starts.len() > 1 {
            format!(
                "The paper is one start: its number differs where it lies farther from the mean of {} starts \
                 than a further one would in 95 % of cases.",
                self.starts.len()
            )
        } else if self.kept > 0 {
            format!(
                "A single run does not show the scatter of starts: it is granted that of {} starts of singh2014.ron, \
                 whose means and standard deviations stand beside it. `--starts 12` measures that of this scene.",
                self.kept
            )
        } else {
            "A single run does not show the scatter of starts: levels are granted 30 %, the notch 2 dB, \
             the tone 10 Hz. `--starts 12` measures it."
                .to_owned()
        };
        format!(
            "Singh et al. (2014), Numerical noise generation in modelled bearing vibration signals. Its \
             sensor is a node on the outer ring; ours is “{}” at {:.0}°, whose a_y is the more radial one \
             ({radial:.0} % of the outward direction). Impulses and levels are peaks by the rules of \
             THEORY §7.4. {scatter} The paper prints neither thickness, contact stiffness, cage pockets, \
             damping nor the place of its sensor, so a level that agrees is no test of this model.",
            self.levels.sensor, self.levels.angle_deg
        )
    }
}

/// A number with three digits, or as many as a frequency needs.
fn number(value: f64) -> String {
    if value.abs() >= 1000.0 { format!("{value:.0}") } else { significant(value, 3) }.replace('-', "−")
}

/// Mean and standard deviation.
fn with_scatter(s: &Statistic) -> String {
    let scatter =
        s.deviation.filter(|d| *d > 0.0).map_or(String::new(), |d| format!(" ± {}", significant(d, 2)));
    let missing = if s.count < s.of { format!(", in {} of {}", s.count, s.of) } else { String::new() };
    number(s.mean) + &scatter + &missing
}

/// The paper's number as it prints it.
fn printed(b: &Beside) -> String {
    let shown = &b.shown;
    let about = if matches!(shown.unit, "ms" | "kHz") { "≈ " } else { "" };
    match shown.unit {
        _ if shown.at_least => "indicated".to_owned(),
        "g" => format!("± {} g", number(shown.paper)),
        unit => format!("{about}{} {unit}", number(shown.paper)),
    }
}

/// Ours with the interval of its mean; a count out of all passages; `None` where no start has one.
fn ours(b: &Beside) -> Option<String> {
    let ours = b.ours?;
    let interval = ours.high.map_or(String::new(), |high| format!(" ± {}", significant(high - ours.mean, 2)));
    let missing = if ours.count < b.of { format!(", in {} of {}", ours.count, b.of) } else { String::new() };
    let unit = if ours.mean == 1.0 && b.shown.unit == "passages" { "passage" } else { b.shown.unit };
    Some(format!("{}{interval} {unit}{missing}", number(ours.mean)))
}

/// A quantity within a sentence.
fn lower_case(quantity: &str) -> String {
    quantity[..1].to_lowercase() + &quantity[1..]
}

/// A difference in a sentence.
fn told(b: &Beside) -> String {
    let quantity = lower_case(&b.shown.quantity);
    match ours(b) {
        Some(ours) if b.shown.at_least => format!("{quantity}: {ours}"),
        Some(ours) => format!("{quantity} {ours} instead of {}", printed(b).trim_start_matches("≈ ")),
        None => format!("{quantity}, {} in the paper, is not found", printed(b)),
    }
}
