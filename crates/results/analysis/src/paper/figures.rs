//! Numbers read from the paper's figures, beside ours: in their order, with the scatter of starts.
//!
//! The paper is one start, so its number *differs* where it lies farther from the mean of our starts than a
//! further start would in 95 % of cases, plus the reading error of the print. A single run has no scatter and
//! is granted that of the starts which are kept with the program, or [`Shown::scatter`].

use std::f64::consts::FRAC_1_SQRT_2;
use std::fmt::Write;

use stribeck_scene::housing::HousingScene;
use stribeck_scene::scene::Scene;

use super::{BETWEEN_G, FILTERED_G, IMPULSE_G, TONE_HZ};
use crate::statistic::Statistic;
use crate::summary::{SensorLevels, Summary};

/// The paper's impulses in its Fig. 2 [ms], read to half a millisecond.
const IMPULSES_MS: [f64; 3] = [5.0, 16.5, 28.0];
/// The multiple of the tone that the paper names.
const FIFTH: f64 = 5.0;
/// Scatter of a peak level from start to start that a single run is granted [-].
const OF_A_LEVEL: f64 = 0.3;

/// A number that a figure of the paper shows, and ours of one run.
#[derive(Debug, Clone, PartialEq)]
pub struct Shown {
    /// Number of the figure.
    pub figure: &'static str,
    /// Quantity.
    pub quantity: String,
    /// Unit of all numbers.
    pub unit: &'static str,
    /// The paper's.
    pub paper: f64,
    /// How far off it may be read.
    pub read: f64,
    /// Assumed deviation of one start where the scatter is unknown.
    pub scatter: f64,
    /// A larger value is no difference: the paper states an occurrence, not a number.
    pub at_least: bool,
    /// Ours; `None` where the run has none.
    pub ours: Option<f64>,
}

/// A number of the paper beside those of one run or of many starts.
#[derive(Debug, Clone, PartialEq)]
pub struct Beside {
    /// The number, without ours.
    pub shown: Shown,
    /// Over the starts; of a single run its number alone. `None` where no start has one.
    pub ours: Option<Statistic>,
    /// Starts.
    pub of: usize,
    /// Over the starts that are kept with the program, beside those of a single run.
    pub kept: Option<Statistic>,
}

/// The sensor whose a_y is set beside the paper's: the leading one where that is more radial than tangential,
/// otherwise the most radial one that does not lie in the seat of the adapter, whose contact chatters.
///
/// The paper's a_y holds the tone, which facets drive along the radius, so that its node lies near the
/// vertical axis.
pub fn sensor<'a>(scene: &Scene, sensors: &'a [SensorLevels]) -> Option<&'a SensorLevels> {
    // Places that mirror each other are alike to rounding.
    let share = |sensor: &SensorLevels| (1e9 * sensor.angle_deg.to_radians().sin().abs()).round() * 1e-9;
    let seated = |sensor: &SensorLevels| {
        let b = &scene.bearing;
        let outside_mm = 0.5 * b.outer_race_diameter_mm + b.outer_ring_thickness_mm;
        let half = (0.5 * scene.adapter.width_mm / outside_mm).min(1.0).asin();
        let from_top = (sensor.angle_deg - 90.0).to_radians();
        scene.housing == HousingScene::Adapter && from_top.sin().atan2(from_top.cos()).abs() <= half
    };
    if let Some(leading) = sensors.first().filter(|sensor| share(sensor) > FRAC_1_SQRT_2) {
        return Some(leading);
    }
    let most = |seats: bool| {
        let candidates = sensors.iter().filter(|sensor| seats || !seated(sensor));
        // Of equal ones the first.
        candidates.rev().max_by(|a, b| share(a).total_cmp(&share(b)))
    };
    most(false).filter(|sensor| share(sensor) > FRAC_1_SQRT_2).or_else(|| most(true))
}

/// Numbers of the paper's figures 2, 3, 6, 7 and 8 with those of one run at a sensor.
pub fn shown(summary: &Summary, sensor: &SensorLevels) -> Vec<Shown> {
    let number = |figure, quantity: &str, unit, paper, read, scatter, ours| Shown {
        figure,
        quantity: quantity.into(),
        unit,
        paper,
        read,
        scatter,
        at_least: false,
        ours,
    };
    let level = |figure, quantity: &str, paper: f64, ours| {
        number(figure, quantity, "g", paper, 0.05 * paper, OF_A_LEVEL * paper, ours)
    };
    let events = &summary.events;
    let mut all = vec![
        level("2", MAIN[1], IMPULSE_G, impulse_g(summary, sensor)),
        level("2", MAIN[2], BETWEEN_G, sensor.between_g),
    ];
    for (at, paper_ms) in IMPULSES_MS.into_iter().enumerate() {
        let quantity = format!("Impulse {}", at + 1);
        let ours = events.get(at).and_then(|event| event.left_ms());
        all.push(number("2", &quantity, "ms", paper_ms, 0.5, 0.1, ours));
    }
    let khz = |hz: Option<f64>| hz.map(|hz| 1e-3 * hz);
    all.extend([
        number("3", TONE[0], "Hz", TONE_HZ, 3.0, 10.0, sensor.tone_hz),
        number("3", TONE[1], "kHz", 23.0, 0.5, 0.1, khz(fifth_hz(summary, sensor))),
        level("6", TONE[2], FILTERED_G, sensor.between_filtered_g),
        number("7", TONE[3], "dB", 25.0, 0.5, 2.0, sensor.notch_db),
    ]);
    let of_filter = summary.notch.as_ref().and_then(|notch| notch.paper_4545_db);
    all.push(number("7", TONE[4], "dB", 4.0, 0.5, 0.0, of_filter));
    let seen = |has: fn(&crate::summary::Event) -> bool| {
        (!events.is_empty()).then(|| events.iter().filter(|event| has(event)).count() as f64)
    };
    let happens = |quantity: &str, ours| Shown {
        at_least: true,
        ..number("8", quantity, "passages", 1.0, 0.0, 0.0, ours)
    };
    all.extend([
        happens("#1, the roller unloads", seen(|e| e.entry_ms.is_some())),
        happens("#2, the roller strikes the floor", seen(|e| e.impact_ms().is_some())),
        happens("#3, it carries for a neighbour", seen(|e| e.compensation_ms.is_some())),
        happens("#4, it is loaded again", seen(|e| e.exit_ms.is_some())),
    ]);
    all
}

/// Mean of the peaks of all impulses [g]: the largest of a few is a matter of chance. Single ones are kept of the
/// leading sensor alone; of another one it is the largest.
fn impulse_g(summary: &Summary, sensor: &SensorLevels) -> Option<f64> {
    let leads = summary.levels.sensor.as_ref() == Some(&sensor.sensor);
    let peaks: Vec<f64> =
        summary.events.iter().filter(|_| leads).filter_map(|event| event.impulse_g).collect();
    Statistic::of(&peaks, peaks.len()).map_or(sensor.impulse_g, |peaks| Some(peaks.mean))
}

/// The peak at five times the tone [Hz], where it lies within half a resolution of that: beside it stands another line.
fn fifth_hz(summary: &Summary, sensor: &SensorLevels) -> Option<f64> {
    let half_hz = 0.5 * summary.spectrum.as_ref()?.resolution_hz;
    let tone_hz = sensor.tone_hz?;
    sensor.fifth_hz.filter(|hz| (hz - FIFTH * tone_hz).abs() <= half_hz)
}

/// The numbers of many starts of `fixtures/scenes/singh2014.ron`, in full, as `cargo xtask study starts` wrote them: a
/// line each, a column a start, blank where a start has none.
const STARTS: &str = include_str!("starts.csv");

/// The same numbers of the starts that are kept with the program.
fn kept_starts(shown: &[Shown]) -> Vec<Vec<Shown>> {
    from_csv(STARTS, shown)
}

fn from_csv(text: &str, shown: &[Shown]) -> Vec<Vec<Shown>> {
    let rows: Vec<Vec<&str>> = text.lines().map(|line| line.split(';').collect()).collect();
    let starts = rows.first().map_or(0, Vec::len);
    let of_start = |at: usize, one: &Shown| {
        let row = rows.iter().find(|row| row[0] == one.quantity);
        let ours = row.and_then(|row| row.get(at)?.parse().ok());
        Shown { ours, ..one.clone() }
    };
    (1..starts).map(|at| shown.iter().map(|one| of_start(at, one)).collect()).collect()
}

/// The table of starts that is kept with the program.
pub fn starts_csv(starts: &[Vec<Shown>]) -> String {
    let mut text = String::from("quantity");
    for number in 1..=starts.len() {
        let _ = write!(text, ";start {number}");
    }
    for (at, one) in starts.first().into_iter().flatten().enumerate() {
        let _ = write!(text, "\n{}", one.quantity);
        for start in starts {
            let _ = write!(text, ";{}", start[at].ours.map_or(String::new(), |ours| format!("{ours:.6}")));
        }
    }
    text + "\n"
}

/// The paper's numbers beside those of `starts`, in the order of the figures.
pub fn beside(starts: &[Vec<Shown>]) -> Vec<Beside> {
    let Some(first) = starts.first() else { return Vec::new() };
    let over = |starts: &[Vec<Shown>], at: usize| {
        let ours: Vec<f64> = starts.iter().filter_map(|start| start.get(at)?.ours).collect();
        Statistic::of(&ours, starts.len())
    };
    let kept = if starts.len() == 1 { kept_starts(first) } else { Vec::new() };
    let one = |(at, shown): (usize, &Shown)| Beside {
        shown: Shown { ours: None, ..shown.clone() },
        ours: over(starts, at),
        of: starts.len(),
        kept: over(&kept, at),
    };
    first.iter().enumerate().map(one).collect()
}

/// The tone of facets, its fundamental first, and what a notch there takes away.
const TONE: [&str; 5] = [
    "Fundamental tone",
    "Its fifth harmonic",
    "Between the impulses, notched, peak",
    "Taken from the tone by the notch",
    "Taken at 4545 Hz by the paper\u{2019}s notch",
];

/// What the paper is about: the tone, the impulses, and the level between them before and behind the notch.
const MAIN: [&str; 4] = [TONE[0], "Impulses, peak, mean of all", "Between the impulses, peak", TONE[2]];

impl Shown {
    /// Whether it is one of the four numbers that the paper is about.
    pub fn is_main(&self) -> bool {
        MAIN.contains(&self.quantity.as_str())
    }

    /// Whether it is a number of the tone that facets make, which contact on arcs does not have.
    pub fn is_of_tone(&self) -> bool {
        TONE.contains(&self.quantity.as_str())
    }
}

impl Beside {
    /// How far one start may lie from the mean.
    fn granted(&self) -> f64 {
        let scatter = |starts: Option<Statistic>| starts?.of_a_further_one();
        scatter(self.ours).or(scatter(self.kept)).unwrap_or(self.shown.scatter)
    }

    /// Whether the paper's number differs from ours by more than the scatter of starts and its own print; a
    /// number that most starts lack differs.
    pub fn differs(&self) -> bool {
        let Some(ours) = self.ours.filter(|s| 2 * s.count > self.of) else { return true };
        let shown = &self.shown;
        if shown.at_least {
            return ours.mean < 0.5 * shown.paper;
        }
        (ours.mean - shown.paper).abs() > self.granted() + shown.read
    }

    /// Difference of the means over its limit [-]; infinite where ours is missing. Sorts the differences.
    pub fn distance(&self) -> f64 {
        let Some(ours) = self.ours.filter(|s| 2 * s.count > self.of) else { return f64::INFINITY };
        let granted = self.granted() + self.shown.read;
        (ours.mean - self.shown.paper).abs() / granted.max(f64::MIN_POSITIVE)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn level(ours: Option<f64>) -> Shown {
        Shown {
            figure: "2",
            quantity: MAIN[1].into(),
            unit: "g",
            paper: IMPULSE_G,
            read: 9.0,
            scatter: 54.0,
            at_least: false,
            ours,
        }
    }

    #[test]
    fn invariant_starts_are_read_as_they_were_written() {
        let starts: Vec<Vec<Shown>> = [Some(139.25), None, Some(-1e-3)].map(|ours| vec![level(ours)]).into();
        assert_eq!(from_csv(&starts_csv(&starts), &[level(None)]), starts);
    }

    /// A single run is granted what starts scatter by, not a share that was assumed.
    #[test]
    fn behaves_a_single_run_is_judged_by_the_starts_that_are_kept() {
        let one = &beside(&[vec![level(Some(140.0))]])[0];
        let kept = one.kept.expect("starts in the table");
        assert!(kept.of >= 4 && (one.granted() - kept.of_a_further_one().expect("scatter")).abs() < 1e-9);
    }
}
