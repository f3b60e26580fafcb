//! Runs, ensembles and measured records beside each other: which fields of their scenes differ, which numbers
//! differ, and whether the scatter of starts explains that.

mod contrast;
mod fields;
mod quantity;
mod side;

use serde::Serialize;
use stribeck_dsp::BandEnvelope;

use crate::Error;
use crate::ensemble::Merged;
use crate::quantity::Quantity;
use crate::statistic::{Statistic, band};
use crate::summary::Summary;
pub use contrast::{Contrast, Verdict};
pub use fields::{FieldDifference, differences};
pub use quantity::{OF_SIGNAL, OfSignal};
pub use side::{Kind, Member, Sampled, Side};

/// Contents of `compare.json`.
#[derive(Debug, Clone, Serialize)]
pub struct Comparison {
    /// The compared sides; the first is the reference of the others.
    pub sides: Vec<Side>,
    /// Fields in which the scenes differ.
    pub fields: Vec<FieldDifference>,
    /// The main numbers.
    pub rows: Vec<Row>,
    /// The strongest line that facets make in each side, where it has one.
    #[serde(skip_serializing_if = "no_lines")]
    pub mesh_lines: Vec<Option<MeshLine>>,
    /// All other numbers of the runs' summaries in which they differ, by their path.
    pub numbers: Vec<Row>,
    /// Cautions.
    pub notes: Vec<String>,
}

/// A line that facets make.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct MeshLine {
    /// Its frequency [Hz].
    pub hz: f64,
    /// Its peak amplitude [g].
    pub level_g: f64,
}

fn no_lines(lines: &[Option<MeshLine>]) -> bool {
    lines.iter().all(Option::is_none)
}

impl MeshLine {
    /// The strongest fundamental at any sensor of the first start.
    fn of(side: &Side) -> Option<Self> {
        let tones = side.members.first()?.summary.get("tones")?.as_array()?;
        let number =
            |tone: &serde_json::Value, name: &str| tone.get(name).and_then(serde_json::Value::as_f64);
        let lines = tones.iter().filter(|tone| number(tone, "harmonic") == Some(1.0)).filter_map(|tone| {
            Some(Self { hz: number(tone, "measured_hz")?, level_g: number(tone, "level_g")? })
        });
        lines.max_by(|a, b| a.level_g.total_cmp(&b.level_g))
    }
}

/// One number of every side.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Row {
    /// Stable name, or the path in `summary.json`.
    pub name: String,
    /// In words.
    pub quantity: String,
    /// Unit; empty for none.
    pub unit: String,
    /// Of each side; `None` where it has none.
    pub values: Vec<Option<Statistic>>,
    /// Of each side but the first, against that; `None` where one of them has none.
    pub against_first: Vec<Option<Contrast>>,
}

impl Row {
    fn of(name: &str, quantity: &str, unit: &str, values: Vec<Option<Statistic>>) -> Option<Self> {
        values.iter().any(Option::is_some).then(|| {
            let contrast = |other: &Option<Statistic>| {
                let first = values.first().copied().flatten()?;
                Some(Contrast::of(&first, other.as_ref()?))
            };
            let against_first = values.iter().skip(1).map(contrast).collect();
            let (name, quantity, unit) = (name.to_owned(), quantity.to_owned(), unit.to_owned());
            Self { name, quantity, unit, values, against_first }
        })
    }

    /// Whether some side differs from the first by more than the scatter.
    pub fn differs(&self) -> bool {
        self.against_first.iter().flatten().any(|contrast| contrast.verdict == Verdict::Differs)
    }
}

impl Comparison {
    /// Of two or more sides.
    ///
    /// # Errors
    /// [`Error::Summary`] when a summary cannot be read as numbers.
    pub fn of(mut sides: Vec<Side>) -> Result<Self, Error> {
        let scenes: Vec<_> = sides.iter().map(|side| side.scene.as_ref()).collect();
        let fields = differences(&scenes);
        name_by_fields(&mut sides, &fields);
        let units: Vec<&str> = sides.iter().map(|side| side.unit.as_str()).collect();
        let one_unit = units.windows(2).all(|pair| pair[0] == pair[1]);
        let row = |name: &str, words: &str, unit: &str, of: &dyn Fn(&Member) -> Option<f64>| {
            let values = sides.iter().map(|side| {
                let values = side.members.iter().filter_map(|member| of(member).filter(|x| x.is_finite()));
                Statistic::of(&values.collect::<Vec<_>>(), side.members.len())
            });
            Row::of(name, words, unit, values.collect())
        };
        // Volts and g have no difference.
        let of_signal = OF_SIGNAL.iter().filter(|q| one_unit || q.unit.is_some()).filter_map(|q| {
            let unit = q.unit.unwrap_or(units.first().copied().unwrap_or(""));
            row(q.name, q.words, unit, &q.of)
        });
        let of_run = Summary::main_quantities().into_iter().filter_map(|q| {
            let of = |member: &Member| q.number(&member.summary);
            // By itself `mean_n` does not say of what.
            let name = if q.path == "load.mean_n" { "support_n" } else { q.name() };
            row(name, q.words.unwrap_or(&q.path), q.unit(), &of)
        });
        let rows = of_signal.chain(of_run).collect();
        let numbers = numbers(&sides)?;
        let notes = notes(&sides, one_unit);
        let mesh_lines = sides.iter().map(MeshLine::of).collect();
        Ok(Self { sides, fields, rows, mesh_lines, numbers, notes })
    }

    /// Whether the scenes differ in the surfaces of contact, so that lines of the mesh come or go.
    pub fn is_of_surfaces(&self) -> bool {
        self.fields.iter().any(|field| field.field == "contact.surface" || field.field.ends_with("_facets"))
    }

    /// Band whose envelope is compared [Hz]: that in which the first side with a claim has its highest
    /// family, else the band of the first side that has the strongest impacts.
    pub fn band_hz(&self) -> Option<(f64, f64)> {
        let claimed = self.sides.iter().flat_map(|side| side.members.first()).find_map(|member| {
            let level = |f: &&stribeck_diagnosis::Family| f.level_db.unwrap_or(f64::NEG_INFINITY);
            member.claimed().max_by(|a, b| level(a).total_cmp(&level(b)))?.band_hz
        });
        claimed.or_else(|| {
            let bands = &self.sides.first()?.members.first()?.bands;
            let most = bands.iter().max_by(|a, b| a.kurtosis.total_cmp(&b.kurtosis))?;
            Some((most.low_hz, most.high_hz))
        })
    }

    /// Whether all sides whose speed is known turn equally fast, so that equal bearings have equal defect
    /// frequencies.
    pub fn is_of_one_speed(&self) -> bool {
        const SAME: f64 = 1e-3;
        let known: Vec<f64> = self.sides.iter().filter_map(|side| side.shaft_hz).collect();
        let equal = |pair: &[f64]| (pair[1] - pair[0]).abs() <= SAME * pair[0];
        known.len() < self.sides.len() || known.windows(2).all(equal)
    }
}

/// Fields by which runs of a campaign are called, whose folders have the names of their scenes' hashes.
const CALLED_BY: usize = 2;

/// Calls runs of a campaign by what differs in their scenes: `load_n 200`.
fn name_by_fields(sides: &mut [Side], fields: &[FieldDifference]) {
    let is_hash = |label: &str| label.len() == 16 && label.chars().all(|c| c.is_ascii_hexdigit());
    if !(1..=CALLED_BY).contains(&fields.len()) || !sides.iter().all(|side| is_hash(&side.label)) {
        return;
    }
    for (at, side) in sides.iter_mut().enumerate() {
        let of = |field: &FieldDifference| {
            let name = field.field.rsplit('.').next().unwrap_or_default();
            format!("{name} {}", field.values[at].as_deref().unwrap_or("–"))
        };
        side.label = fields.iter().map(of).collect::<Vec<_>>().join(", ");
    }
}

impl Side {
    /// Envelope spectrum of the band nearest to `band_hz`, mean over the signals, with the band's ends [Hz];
    /// `None` where no signal is long enough.
    pub fn envelope(&self, band_hz: (f64, f64)) -> Option<(Sampled, (f64, f64))> {
        let distance =
            |b: &BandEnvelope| (b.low_hz / band_hz.0).ln().abs() + (b.high_hz / band_hz.1).ln().abs();
        let nearest = |member: &'_ Member| {
            let place = (0..member.bands.len())
                .min_by(|a, b| distance(&member.bands[*a]).total_cmp(&distance(&member.bands[*b])));
            place.map(|place| member.bands[place].clone())
        };
        let bands: Vec<BandEnvelope> = self.members.iter().filter_map(nearest).collect();
        let first = bands.first()?;
        let curves: Vec<&[f64]> = bands.iter().map(|band| band.values.as_slice()).collect();
        let mean = Sampled { start: 0.0, step: first.grid_hz, values: mean(&curves) };
        Some((mean, (first.low_hz, first.high_hz)))
    }

    /// Power spectral density [unit²/Hz], mean over the signals; `None` where none is long enough.
    pub fn density(&self) -> Option<Sampled> {
        let first = self.members.iter().find_map(|member| member.density.as_ref())?;
        Some(Sampled { values: mean(&self.densities()), ..first.clone() })
    }

    /// Densities that hold the middle 80 % of the signals, point by point; `None` of a single signal.
    pub fn density_band(&self) -> Option<[Vec<f64>; 2]> {
        let all = self.densities();
        (all.len() > 1).then(|| band(&all))
    }

    fn densities(&self) -> Vec<&[f64]> {
        self.members.iter().filter_map(|member| Some(member.density.as_ref()?.values.as_slice())).collect()
    }

    /// Mean force on a roller by angle [°, N], mean over the starts that have one there; `None` for a record.
    pub fn load_distribution(&self) -> Option<(Vec<f64>, Vec<f64>)> {
        let first = self.members.first().filter(|m| m.distribution.mean_n.iter().any(|f| f.is_finite()))?;
        let curves: Vec<&[f64]> = self.members.iter().map(|m| m.distribution.mean_n.as_slice()).collect();
        Some((first.distribution.angle_deg.clone(), mean(&curves)))
    }
}

/// Mean of curves as long as the shortest, point by point; values that are not finite do not count.
fn mean(curves: &[&[f64]]) -> Vec<f64> {
    let length = curves.iter().map(|curve| curve.len()).min().unwrap_or(0);
    let at = |n: usize| {
        let known = curves.iter().map(|curve| curve[n]).filter(|value| value.is_finite());
        let (sum, count) = known.fold((0.0, 0), |(sum, count), value| (sum + value, count + 1));
        if count == 0 { f64::NAN } else { sum / f64::from(count) }
    };
    (0..length).map(at).collect()
}

/// Numbers outside of lists in the summaries of all runs that are not equal in all; numbers in lists are on
/// the runs' own pages.
fn numbers(sides: &[Side]) -> Result<Vec<Row>, Error> {
    let merged: Vec<Merged> = sides.iter().map(Side::merged).collect::<Result<_, _>>()?;
    let mut all = Summary::quantities();
    // The cost of a run depends on the computer.
    all.retain(|quantity| !quantity.is_listed && !quantity.path.starts_with("run."));
    all.sort_by(|a, b| a.path.cmp(&b.path));
    let rows = all.iter().filter_map(|Quantity { path, .. }| {
        let values: Vec<Option<Statistic>> =
            merged.iter().map(|merged| merged.number(path).copied()).collect();
        let means: Vec<f64> = values.iter().flatten().map(|s| s.mean).collect();
        let differ = means.windows(2).any(|pair| pair[0] != pair[1]);
        differ.then(|| Row::of(path, path, "", values)).flatten()
    });
    Ok(rows.collect())
}

fn notes(sides: &[Side], one_unit: bool) -> Vec<String> {
    let mut notes = Vec::new();
    if !one_unit {
        let units = sides.iter().map(|side| match side.unit.as_str() {
            "" => format!("{} has no unit", side.label),
            unit => format!("{} is in {unit}", side.label),
        });
        notes.push(format!(
            "levels are not compared, and traces are drawn over their own root mean square: {}. `--unit` \
             and `--scale` say what a sample of a record is",
            units.collect::<Vec<_>>().join(", ")
        ));
    }
    if sides.iter().all(|side| side.signals == 1) {
        notes.push(
            "every side is a single signal, and its scatter is unknown: a peak changes by tens \
             of per cent from one start to another. `stribeck simulate SCENE --starts 8` makes a side with a \
             scatter"
                .to_owned(),
        );
    } else {
        notes.push(
            "of twenty numbers that are the same in truth, one is outside its interval of 95 % by chance"
                .to_owned(),
        );
    }
    let shortest = sides.iter().map(|side| side.duration_s).fold(f64::INFINITY, f64::min);
    let longest = sides.iter().map(|side| side.duration_s).fold(0.0, f64::max);
    if longest > 1.5 * shortest {
        notes.push(format!(
            "the records are {shortest:.3} to {longest:.3} s long: peaks grow with the length, and families \
             stand out more in a longer one"
        ));
    }
    let unlike = |of: &dyn Fn(&Side) -> f64| {
        let values: Vec<f64> = sides.iter().map(of).collect();
        values.windows(2).any(|pair| (pair[1] / pair[0] - 1.0).abs() > 1e-6)
    };
    if unlike(&|side| side.rate_hz) {
        notes.push(
            "the sample rates differ: peaks and root mean squares are those of different bands".to_owned(),
        );
    }
    for side in sides {
        notes.extend(side.notes.iter().map(|note| format!("{}: {note}", side.label)));
    }
    notes
}
