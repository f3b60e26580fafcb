//! Records of one machine in the order of time: one verdict, the record from which on it holds, and how the
//! defect grows.
//!
//! Damage does not heal. A family is therefore looked for in the last record, the last two, four and so on:
//! whatever the dependence of the records, twice the median of their probabilities is one (L. Rüschendorf,
//! Adv. Appl. Probab. 14 (1982) 623–632; V. Vovk and R. Wang, Biometrika 107 (2020) 791–808), and the number
//! of these choices is paid for (Bonferroni). The onset is the place where the heights of its comb change
//! from a constant to a line, each with normal scatter (THEORY §7.9).

use serde::Serialize;
use statrs::function::gamma::ln_gamma;

use crate::families::limits::ALPHA;
use crate::families::sound::BEYOND_SOUND;
use crate::pool::Pooled;
use crate::quantities;
use crate::words::numbers::chance;
use crate::words::sentence::no_defect;
use crate::{Answer, Concluded, Conclusion, Defect, Family, Interval, MeasuredFindings};

quantities! {
    /// The verdict on a series of records.
    #[derive(Debug, Clone, PartialEq, Serialize)]
    pub struct Series {
        /// Records in all.
        pub records: usize,
        /// Those that could be analysed.
        pub analysed: usize,
        /// The first ones, which are of the healthy machine.
        pub sound: usize,
        /// The defect families; none without speed and bearing.
        pub families: Vec<SeriesFamily>,
        /// Growth of the spall, where two records at least give a length.
        pub growth: Option<Growth>,
        /// The conclusion on each part of the bearing.
        pub conclusion: Conclusion,
        /// The conclusion in one sentence.
        pub verdict: String,
    }
}

quantities! {
    /// One family over the series.
    #[derive(Debug, Clone, PartialEq, Serialize)]
    pub struct SeriesFamily {
        /// Whose family it is.
        pub name: Defect,
        /// Probability that healthy bearings show as much in half of the last `last` records.
        pub p_value: f64,
        /// Records at the end of the series by which it is judged.
        pub last: usize,
        /// Those of them that claim it.
        pub last_claiming: usize,
        /// All records behind those of the healthy machine that claim it.
        pub claiming: usize,
        /// Short records at the end of the series whose mean spectra claim it; `null` where they do not.
        pub pooled: Option<usize>,
        /// The family whose lines these records together cannot distinguish from its own.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub not_told_apart_from: Option<Defect>,
        /// Whether the series is called a defect of this part.
        pub claimed: bool,
        /// The record from which on it stands; `null` where it is not claimed, or the series shows no beginning.
        pub onset: Option<Onset>,
        /// Height of its comb above the background in each record [dB]; `null` where it was not looked for.
        pub height_db: Vec<Option<f64>>,
    }
}

quantities! {
    /// The first record in which a defect stands, from 1 on, with its interval of 90 %.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
    pub struct Onset {
        /// The likeliest record.
        pub record: usize,
        /// First record of the interval.
        pub low: usize,
        /// Last record of the interval.
        pub high: usize,
    }
}

quantities! {
    /// Lengths of the spall at both ends of the series.
    #[derive(Debug, Clone, Copy, PartialEq, Serialize)]
    pub struct Growth {
        /// The first record that gives a length, from 1 on.
        pub from: usize,
        /// Its length [mm].
        pub from_mm: Interval,
        /// The last record that gives one.
        pub to: usize,
        /// Its length [mm].
        pub to_mm: Interval,
        /// Whether the last interval lies above the first.
        pub has_grown: bool,
    }
}

impl Series {
    /// Of records in the order of time, `None` for those that could not be analysed, of which the first `sound`
    /// are of the healthy machine; `pooled` are the short ones together.
    pub fn of(records: &[Option<&MeasuredFindings>], sound: usize, pooled: &[Pooled]) -> Self {
        let signals: Vec<Option<&MeasuredFindings>> =
            records.iter().map(|record| record.filter(|findings| !findings.is_no_signal())).collect();
        let none = records.iter().flatten().count() - signals.iter().flatten().count();
        let records = &signals;
        let analysed = records.iter().flatten().count();
        let names =
            Defect::ALL.into_iter().filter(|name| records.iter().any(|r| family(*r, *name).is_some()));
        let mut families: Vec<SeriesFamily> =
            names.map(|name| SeriesFamily::of(name, records, sound, pooled)).collect();
        highest_alone(&mut families);
        // One claim with two names stands under the first.
        for at in 1..families.len() {
            let other = families[at].not_told_apart_from;
            if families[..at].iter().any(|f| f.claimed && Some(f.name) == other) {
                families[at].claimed = false;
            }
        }
        let growth = growth(records);
        let conclusion = concluded(&families, &records[sound.min(records.len())..]);
        let mut verdict = conclude(&families, growth.as_ref(), (analysed, sound), &conclusion, records);
        let spoilt =
            |record: &&&MeasuredFindings| record.quality.iter().any(|found| found.kind.spoils_verdicts());
        if none > 0 {
            verdict = match analysed {
                0 => format!("No verdict: none of {none} records is a record of a signal."),
                _ => format!("{verdict} No record of a signal: {none} more."),
            };
        }
        match records.iter().flatten().filter(spoilt).count() {
            0 => {}
            some => {
                verdict += &format!(
                    " In {some} of {analysed} records a sensor has spoilt samples: the page of each says how."
                )
            }
        }
        Self { records: records.len(), analysed, sound, families, growth, conclusion, verdict }
    }
}

fn family(record: Option<&MeasuredFindings>, name: Defect) -> Option<&Family> {
    record?.families.iter().find(|family| family.name == name)
}

impl Series {
    /// The same with the alarms of its records, each with its number from 1 on and the name of its level.
    pub fn alarmed(self, alarms: &[(usize, &str)]) -> Self {
        let mut names: Vec<&str> = alarms.iter().map(|(_, name)| *name).collect();
        names.sort_unstable();
        names.dedup();
        let of = |name: &&str| {
            let records: Vec<usize> = alarms.iter().filter(|(_, of)| of == name).map(|(at, _)| *at).collect();
            let (first, last) = (records.first().copied().unwrap_or(0), records.last().copied().unwrap_or(0));
            match records.len() {
                1 => format!("{name} in record {first}"),
                count => format!("{name} in {count} records from {first} to {last}"),
            }
        };
        let words: Vec<String> = names.iter().map(of).collect();
        let alarm = (!words.is_empty()).then(|| format!(" ALARM: {}.", words.join(", ")));
        Self { verdict: self.verdict + &alarm.unwrap_or_default(), ..self }
    }
}

impl SeriesFamily {
    fn of(name: Defect, records: &[Option<&MeasuredFindings>], sound: usize, pooled: &[Pooled]) -> Self {
        let of = |record: &Option<&MeasuredFindings>| family(*record, name).cloned();
        let later: Vec<Family> = records.iter().skip(sound).filter_map(of).collect();
        let limit = if later.iter().any(|f| f.claimed && f.p_value >= ALPHA) { BEYOND_SOUND } else { ALPHA };
        // All records, and the last ones: two chances.
        let limit = 2.0 * limit;
        let End { p_value, last, claiming: last_claiming } = End::of(&later, limit);
        let together = pooled.iter().filter_map(|of| {
            let family = of.families.iter().find(|family| family.name == name && family.claimed)?;
            let p_value = family.p_value * pooled.len() as f64;
            (p_value < ALPHA).then_some((of.last, p_value, family.not_told_apart_from))
        });
        let together = together.max_by_key(|(last, ..)| *last);
        let by_records = p_value < limit && 2 * last_claiming >= last;
        // A mean over records that claim it early and no longer later shows no defect.
        let claims: Vec<bool> = later.iter().map(|family| family.claimed).collect();
        let (early, late) = claims.split_at(claims.len() / 2);
        let count = |part: &[bool]| part.iter().filter(|claims| **claims).count();
        let together = together.filter(|_| count(late) >= count(early));
        let claimed = by_records || together.is_some();
        let p_value = together.filter(|_| !by_records).map_or(p_value, |(_, p_value, _)| p_value);
        let not_told_apart_from = together.filter(|_| !by_records).and_then(|(_, _, other)| other);
        let pooled = together.map(|(last, ..)| last);
        let height_db: Vec<Option<f64>> = records
            .iter()
            .map(|r| family(*r, name).map(Family::score_db).filter(|db| db.is_finite()))
            .collect();
        let claiming = count(&claims);
        // Where all claim it, it was there before the first. It begins no later than a record that claims it, and among the
        // last ones no beginning is told from another.
        let first = records.iter().skip(sound).position(|r| family(*r, name).is_some_and(|f| f.claimed));
        let bounded = |onset: &Onset| {
            let at = first.map(|first| sound + first);
            at.is_none_or(|at| onset.record <= at + 1 && at + LEAST_AFTER <= records.len())
        };
        let onset =
            if claimed && claiming < later.len() { onset(&height_db, sound).filter(bounded) } else { None };
        Self {
            name,
            p_value,
            last,
            last_claiming,
            claiming,
            pooled,
            not_told_apart_from,
            claimed,
            onset,
            height_db,
        }
    }

    /// Its mean height in the records by which it is judged [dB].
    fn height_at_the_end_db(&self) -> f64 {
        let last: Vec<f64> = self.height_db.iter().rev().flatten().take(self.last).copied().collect();
        last.iter().sum::<f64>() / last.len().max(1) as f64
    }
}

/// The end of a series, as many records of it as show a family.
struct End {
    /// Twice the smaller of that of all, and the smallest of the last ones times their choices; each twice the median of
    /// their probabilities.
    p_value: f64,
    last: usize,
    claiming: usize,
}

impl End {
    /// Of the families of all records that are not known to be sound: most of the last ones of which half claim
    /// it, with a probability below `limit`; without such, those that show most.
    fn of(families: &[Family], limit: f64) -> Self {
        let choices: Vec<usize> = std::iter::successors(Some(1), |last| Some(2 * last))
            .take_while(|n| *n <= families.len())
            .collect();
        let at = |last: usize| {
            let end = &families[families.len() - last..];
            let mut p_values: Vec<f64> = end.iter().map(|family| family.p_value).collect();
            p_values.sort_by(f64::total_cmp);
            // One record is its own median; of more, the upper one, and twice.
            let median = p_values[last / 2] * if last == 1 { 1.0 } else { 2.0 };
            let claiming = end.iter().filter(|family| family.claimed).count();
            let choices = if last == families.len() { 1 } else { choices.len() };
            Self { p_value: (2.0 * median * choices as f64).min(1.0), last, claiming }
        };
        let all = (!families.is_empty()).then_some(families.len());
        let all = all.filter(|all| choices.last() != Some(all));
        let ends: Vec<Self> = choices.iter().copied().chain(all).map(at).collect();
        let smallest = ends.iter().min_by(|a, b| a.p_value.total_cmp(&b.p_value));
        let claims = |end: &&Self| end.p_value < limit && 2 * end.claiming >= end.last;
        match (smallest, ends.iter().rev().find(claims)) {
            (Some(smallest), longest) => {
                let Self { last, claiming, .. } = *longest.unwrap_or(smallest);
                Self { p_value: smallest.p_value, last, claiming }
            }
            (None, _) => Self { p_value: 1.0, last: 0, claiming: 0 },
        }
    }
}

/// Of families that different records claim the highest at the end: the others may be its sidebands. A family
/// that stands in the same records beside it is a second defect.
fn highest_alone(families: &mut [SeriesFamily]) {
    let claimed = families.iter().enumerate().filter(|(_, family)| family.claimed);
    let highest = claimed
        .max_by(|a, b| a.1.height_at_the_end_db().total_cmp(&b.1.height_at_the_end_db()))
        .map(|(at, family)| (at, family.last_claiming));
    let Some((first, claiming)) = highest else { return };
    for (at, family) in families.iter_mut().enumerate() {
        if at != first && family.pooled.is_none() && 2 * family.last_claiming < claiming {
            family.claimed = false;
            family.onset = None;
        }
    }
}

/// Least records before and from the onset on: a mean, and a line, need one more for their scatter.
const LEAST_BEFORE: usize = 2;
const LEAST_AFTER: usize = 3;
/// Twice the logarithm of a Bayes factor from which on evidence is very strong.
const VERY_STRONG: f64 = 10.0;
/// Scatter that heights have at least [dB], so that equal ones have one.
const LEAST_SCATTER_DB: f64 = 0.1;
/// Probability on either side of the interval.
const BESIDE: f64 = 0.05;

/// Where heights change from a constant to a line: each place has the marginal likelihood of both parts with
/// unknown levels, slope and scatters under Jeffreys' priors, and the places are equally likely beforehand.
fn onset(heights_db: &[Option<f64>], sound: usize) -> Option<Onset> {
    let known: Vec<(usize, f64)> =
        heights_db.iter().enumerate().filter_map(|(at, db)| Some((at, (*db)?))).collect();
    let first = known.iter().filter(|(at, _)| *at < sound).count().max(LEAST_BEFORE);
    let places = first..(known.len() + 1).saturating_sub(LEAST_AFTER);
    let points: Vec<(f64, f64)> = known.iter().map(|(at, db)| (*at as f64, *db)).collect();
    let mean = |part: &[(f64, f64)]| part.iter().map(|(_, db)| db).sum::<f64>() / part.len() as f64;
    let scored: Vec<(usize, f64)> = places
        .filter(|place| mean(&points[*place..]) > mean(&points[..*place]))
        .map(|place| (place, likelihood(&points[..place], 1) + likelihood(&points[place..], 2)))
        .collect();
    let best = *scored.iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
    // A change needs very strong evidence against one constant or one line over all records: Bayes' criterion, whose
    // parameters are levels, slopes, scatters and the place (R. E. Kass and A. E. Raftery, J. Am. Stat. Assoc. 90 (1995)
    // 773–795, section 3.2).
    let criterion = |parts: &[(&[(f64, f64)], usize)], parameters: f64| {
        let misfit = |(part, of): &(&[(f64, f64)], usize)| {
            part.len() as f64 * (misfit(part, *of) / part.len() as f64).ln()
        };
        parts.iter().map(misfit).sum::<f64>() + parameters * (points.len() as f64).ln()
    };
    let (before, behind) = points.split_at(best.0);
    let unchanged = criterion(&[(&points, 1)], 2.0).min(criterion(&[(&points, 2)], 3.0));
    if unchanged <= VERY_STRONG + criterion(&[(before, 1), (behind, 2)], 6.0) {
        return None;
    }
    let weights: Vec<f64> = scored.iter().map(|(_, score)| (score - best.1).exp()).collect();
    let total: f64 = weights.iter().sum();
    let quantile = |part: f64| {
        let mut sum = 0.0;
        let reached = scored.iter().zip(&weights).find(|(_, weight)| {
            sum += *weight;
            sum >= part * total
        });
        reached.map_or(best.0, |((place, _), _)| *place)
    };
    let record = |place: usize| known[place].0 + 1;
    Some(Onset {
        record: record(best.0),
        low: record(quantile(BESIDE).min(best.0)),
        high: record(quantile(1.0 - BESIDE).max(best.0)),
    })
}

/// Sum of squares [dB²] of points about a constant (`parameters` = 1) or a line (2).
fn misfit(points: &[(f64, f64)], parameters: usize) -> f64 {
    let n = points.len() as f64;
    let (time, level) = centre(points);
    let sum = |of: &dyn Fn(f64, f64) -> f64| points.iter().map(|(t, x)| of(t - time, x - level)).sum::<f64>();
    let (together, square) = (sum(&|t, x| t * x), sum(&|_, x| x * x));
    let rest = if parameters == 1 { square } else { square - together * together / sum(&|t, _| t * t) };
    rest.max(n * LEAST_SCATTER_DB * LEAST_SCATTER_DB)
}

fn centre(points: &[(f64, f64)]) -> (f64, f64) {
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / points.len() as f64;
    (mean(|p| p.0), mean(|p| p.1))
}

/// Logarithm of the marginal likelihood of points on a constant (`parameters` = 1) or a line (2), but for what
/// is the same for all places of the change.
fn likelihood(points: &[(f64, f64)], parameters: usize) -> f64 {
    let n = points.len() as f64;
    let (time, _) = centre(points);
    let spread = points.iter().map(|(t, _)| (t - time).powi(2)).sum::<f64>();
    let determinant = if parameters == 1 { n } else { n * spread };
    let half = 0.5 * (n - parameters as f64);
    ln_gamma(half) - half * (std::f64::consts::PI * misfit(points, parameters)).ln() - 0.5 * determinant.ln()
}

/// The lengths of the first and the last record that give one.
fn growth(records: &[Option<&MeasuredFindings>]) -> Option<Growth> {
    let mut lengths =
        records.iter().enumerate().filter_map(|(at, record)| Some((at + 1, record.as_ref()?.spall_mm?)));
    let ((from, from_mm), (to, to_mm)) = (lengths.next()?, lengths.next_back()?);
    Some(Growth { from, from_mm, to, to_mm, has_grown: to_mm.low > from_mm.high })
}

/// The conclusion on all records: a defect where it is claimed, none where half of the records that are not of the
/// healthy machine show that there is none, and no other impacts at the end.
fn concluded(families: &[SeriesFamily], records: &[Option<&MeasuredFindings>]) -> Conclusion {
    let conclusions: Vec<&Conclusion> = records.iter().flatten().map(|record| &record.conclusion).collect();
    let claimed = |names: &[Defect]| families.iter().any(|f| f.claimed && names.contains(&f.name));
    let of = |names: &[Defect], part: fn(&Conclusion) -> &Concluded| {
        let all: Vec<&Concluded> = conclusions.iter().map(|conclusion| part(conclusion)).collect();
        let count = |answer: Answer| all.iter().filter(|of| of.answer == answer).count();
        let last = all.last().map(|of| of.answer);
        let shows_none = 2 * count(Answer::NoDefect) >= all.len() && last == Some(Answer::NoDefect);
        let answer = if claimed(names) {
            Answer::Defect
        } else if !all.is_empty() && count(Answer::NoSignal) == all.len() {
            Answer::NoSignal
        } else if shows_none {
            Answer::NoDefect
        } else {
            Answer::CannotTell
        };
        let of_last = all.last().copied().copied();
        Concluded { answer, ..of_last.unwrap_or(*part(&Conclusion::default())) }
    };
    Conclusion {
        raceways: of(&[Defect::Bpfo, Defect::Bpfi], |c| &c.raceways),
        elements: of(&[Defect::Bsf, Defect::Ftf], |c| &c.elements),
        cage: of(&[], |c| &c.cage),
    }
}

fn conclude(
    families: &[SeriesFamily],
    growth: Option<&Growth>,
    (analysed, sound): (usize, usize),
    conclusion: &Conclusion,
    records: &[Option<&MeasuredFindings>],
) -> String {
    let claimed: Vec<String> =
        families.iter().filter(|family| family.claimed).map(|family| words(family, sound)).collect();
    if !claimed.is_empty() {
        let growth = growth.map_or_else(String::new, growth_in_words);
        return format!("The series shows {}.{growth}", claimed.join(" and "));
    }
    if families.is_empty() {
        return format!(
            "No verdict on the {analysed} records: without speed and bearing there are no families."
        );
    }
    let single: usize = families.iter().map(|family| family.claiming).sum();
    let lasting = families.iter().filter(|f| f.last_claiming > 0 && 2 * f.last_claiming >= f.last);
    let some = match (single, lasting.map(|f| f.p_value).reduce(f64::min)) {
        (0, _) => String::new(),
        (_, Some(p_value)) => format!(
            " {single} of {analysed} records claim a defect, which together has a false alarm of {}.",
            chance(p_value)
        ),
        (_, None) => format!(
            " {single} of {analysed} records claim a defect, and fewer than half of the last ones: none that lasts to \
             the end."
        ),
    };
    let last = records.iter().rev().flatten().next();
    if conclusion.raceways.answer == Answer::NoDefect {
        let unit = last.and_then(|last| last.unit.as_deref());
        return format!("{}{some}", no_defect(conclusion, unit));
    }
    let could = records.iter().flatten().filter(|r| r.conclusion.raceways.answer == Answer::NoDefect).count();
    let of_last = last.map_or_else(String::new, |last| format!(" Of the last: {}", last.verdict));
    format!(
        "The series of {analysed} records cannot tell whether there is a defect: {could} of them could have shown one \
         of a raceway, and show none.{some}{of_last}"
    )
}

fn words(family: &SeriesFamily, sound: usize) -> String {
    let SeriesFamily { name, p_value, claiming, onset, height_db, pooled, not_told_apart_from, .. } = family;
    let part = match name {
        Defect::Ftf => "the cage or of one rolling element",
        _ => name.part(),
    };
    let part = match not_told_apart_from {
        Some(other) => format!("{part} or of {}, which the records cannot distinguish", other.part()),
        None => part.to_owned(),
    };
    let since = match onset {
        Some(Onset { record, low, high }) if low < high => {
            format!("from record {record} on (90 %: {low} to {high}), ")
        }
        Some(Onset { record, .. }) => format!("from record {record} on, "),
        None if *claiming == height_db.len() => "from the first record on, ".to_owned(),
        None => String::new(),
    };
    let by = match (claiming, height_db.len() - sound) {
        (claiming, of) if *claiming == of => {
            let of_those = if sound > 0 { " that are not of the healthy machine" } else { "" };
            format!("all {of} records{of_those} claim it")
        }
        (0, _) if pooled.is_some() => {
            format!(
                "the mean of the squared envelope spectra of the last {} records claims it",
                pooled.unwrap_or(0)
            )
        }
        (claiming, of) => format!("{claiming} of {of} records claim it"),
    };
    format!("a defect of {part} ({name}): {since}{by}, false alarm {}", chance(*p_value))
}

fn growth_in_words(growth: &Growth) -> String {
    let Growth { from, from_mm, to, to_mm, has_grown } = growth;
    let of = |mm: &Interval| format!("{:.2} mm ({:.2} to {:.2})", mm.value, mm.low, mm.high);
    let [first, last] = [from_mm, to_mm].map(of);
    let grown = if *has_grown {
        ""
    } else {
        "; the load's error, which both intervals contain, moves both lengths alike"
    };
    format!(" The spall is {first} long in record {from} and {last} in record {to}{grown}.")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn heights(values: &[f64]) -> Vec<Option<f64>> {
        values.iter().map(|db| Some(*db)).collect()
    }

    /// A constant of six records, then a line: the place where the line begins.
    #[test]
    fn planted_an_onset_is_where_a_line_leaves_a_constant() {
        let scatter = [0.3, -0.4, 0.1, -0.2, 0.4, -0.3, 0.2, -0.1, 0.3, -0.4, 0.1, -0.2];
        let mut values: Vec<f64> = scatter.iter().map(|by| 5.0 + by).collect();
        for (at, value) in values.iter_mut().enumerate().skip(6) {
            *value += 6.0 + 3.0 * (at - 6) as f64;
        }
        let found = onset(&heights(&values), 0).unwrap();
        assert_eq!((found.record, found.low, found.high), (7, 7, 7));
        // One among the healthy records is excluded, and a slow one is less certain.
        assert!(onset(&heights(&values), 8).is_none_or(|found| found.low > 8));
        let slow = |at: usize| 5.0 + scatter[at % 12] + 0.4 * at.saturating_sub(12) as f64;
        let slow = onset(&heights(&(0..24).map(slow).collect::<Vec<f64>>()), 0).unwrap();
        assert!(slow.high > slow.low && (12..17).contains(&slow.record), "{slow:?}");
        // Records that were not analysed count in the numbering.
        let mut gaps = heights(&values);
        gaps[2] = None;
        assert!(onset(&gaps, 0).is_some());
        assert!(onset(&heights(&values[..4]), 0).is_none(), "too few for either part");
        // Where nothing changes, or the height grows from the first record on, there is none.
        for count in [8, 40, 500] {
            let constant: Vec<f64> = (0..count).map(|at| 12.0 + scatter[at * 7 % 12]).collect();
            assert_eq!(onset(&heights(&constant), 0), None, "{count} records");
            let line: Vec<f64> = constant.iter().enumerate().map(|(at, x)| x + 0.2 * at as f64).collect();
            assert_eq!(onset(&heights(&line), 0), None, "{count} records on a line");
        }
    }

    #[test]
    fn by_hand_the_end_of_a_series() {
        let of = |p_value: f64, claimed: bool| Family {
            p_value,
            claimed,
            ..Family::expected(Defect::Bpfo, 100.0)
        };
        // One of eight records: four choices of 1, 2, 4 and 8, and the last record is its own median.
        let mut families = vec![of(0.5, false); 8];
        families[7] = of(1e-6, true);
        let end = End::of(&families, ALPHA);
        assert_eq!((end.last, end.claiming), (1, 1));
        assert!((end.p_value - 8e-6).abs() < 1e-12);
        // A false alarm in the middle of a valid series is none at its end.
        families.swap(3, 7);
        assert!(End::of(&families, ALPHA).p_value > 0.5);
        // Five of the last eight claim it, of which the upper median is 1e-4: 2 · 2 · 1e-4 is below 1e-3.
        for (at, p_value) in [(4, 1e-4), (5, 1e-7), (6, 1e-5), (7, 1e-7)] {
            families[at] = of(p_value, true);
        }
        let end = End::of(&families, ALPHA);
        assert_eq!((end.last, end.claiming), (8, 5), "the longest end that shows it");
        assert!((end.p_value - 8e-7).abs() < 1e-15, "the smallest probability");
        // Six records that claim it as weakly as one must: all of them are one choice.
        let end = End::of(&[const { 2.2e-4 }; 6].map(|p_value| of(p_value, true)), ALPHA);
        assert_eq!((end.last, end.claiming), (6, 6));
        assert!((end.p_value - 8.8e-4).abs() < 1e-12);
        assert!(End::of(&[], ALPHA).p_value >= 1.0);
    }
}
