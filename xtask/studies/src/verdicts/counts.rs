//! What is counted over the records: right and wrong verdicts, scores without a threshold, false alarms,
//! lengths, and all of that after changes.

use stribeck_analysis::statistic::Share;
use stribeck_diagnosis::Defect;
use stribeck_diagnosis::families::sound::LEAST_SOUND;
use stribeck_report::plot::{Axis, Colour, Figure, Level, Series};

use super::baseline::{self, Scores};
use super::records::{Labelled, Part, SETS, UESTC};
use super::trial::{self, Outcome, Standing, WITHOUT_SPEED};
use crate::Rows;
use crate::page::decimals;
use crate::rows::median;

/// Results of the verdict and of both baselines for a record.
pub(super) struct Judged {
    pub(super) outcome: Option<Outcome>,
    pub(super) fixed: Option<Scores>,
    pub(super) kurtogram: Option<Scores>,
}

/// Outcomes of all records after a change.
type Changed = (&'static str, Vec<Option<Outcome>>);

/// Right, wrong and undecided.
#[derive(Debug, Clone, Copy, Default)]
struct Counts {
    of: usize,
    right: usize,
    wrong: usize,
    silent: usize,
}

impl Counts {
    fn add(&mut self, standing: Standing) {
        self.of += 1;
        match standing {
            Standing::Right => self.right += 1,
            Standing::Wrong => self.wrong += 1,
            Standing::Silent => self.silent += 1,
        }
    }
}

type Pair<'a> = (&'a Labelled, &'a Judged);

pub(super) fn pairs<'a>(
    records: &'a [Labelled],
    judged: &'a [Judged],
) -> impl Iterator<Item = Pair<'a>> + Clone {
    records.iter().zip(judged)
}

pub(super) fn class(record: &Labelled) -> &'static str {
    match record.truth {
        Some(name) => name.part(),
        None if record.beside => "healthy, the other end damaged",
        None => "healthy",
    }
}

pub(super) const CLASSES: [&str; 5] = [
    "the outer raceway",
    "the inner raceway",
    "a rolling element",
    "healthy",
    "healthy, the other end damaged",
];
const PARTS: [(Part, &str); 2] = [(Part::Chosen, "chosen part"), (Part::Quoted, "quoted part")];

/// The least score that no healthy record of the chosen part has [dB].
fn threshold<'a>(all: impl Iterator<Item = Pair<'a>>, of: fn(&Judged) -> Option<&Scores>) -> f64 {
    let sound = all.filter(|(record, _)| record.part == Part::Chosen && record.truth.is_none());
    let highest = sound.filter_map(|(_, judged)| Some(baseline::choice(of(judged)?).1));
    highest.fold(f64::NEG_INFINITY, f64::max)
}

fn by_threshold(scores: Option<&Scores>, least_db: f64, truth: Option<Defect>) -> Standing {
    match scores.map(baseline::choice).filter(|(_, score)| *score > least_db) {
        None => Standing::Silent,
        Some((name, _)) if Some(name) == truth => Standing::Right,
        Some(_) => Standing::Wrong,
    }
}

/// Right, wrong and undecided by set and class.
pub(super) fn verdicts(rows: &mut Rows, records: &[Labelled], judged: &[Judged]) {
    let all = pairs(records, judged);
    let fixed_db = threshold(all.clone(), |j| j.fixed.as_ref());
    let kurtogram_db = threshold(all.clone(), |j| j.kurtogram.as_ref());
    let mut put = |name: &str, keep: &dyn Fn(&Labelled) -> bool| {
        let mut counts = [Counts::default(); 3];
        for (record, judged) in all.clone().filter(|(record, _)| keep(record)) {
            let own = judged.outcome.as_ref().map_or(Standing::Silent, |o| o.standing(record.truth));
            counts[0].add(own);
            counts[1].add(by_threshold(judged.fixed.as_ref(), fixed_db, record.truth));
            counts[2].add(by_threshold(judged.kurtogram.as_ref(), kurtogram_db, record.truth));
        }
        if counts[0].of == 0 {
            return;
        }
        for (method, c) in ["verdict", "plain envelope", "kurtogram"].iter().zip(counts) {
            let values = [("n", c.of), ("right", c.right), ("wrong", c.wrong), ("silent", c.silent)];
            rows.values("verdicts", name, values.map(|(what, n)| (format!("{method} {what}"), n as f64)));
        }
    };
    for (set, what) in SETS.into_iter().flat_map(|set| CLASSES.map(|class| (set, class))) {
        put(&format!("{set}, {what}"), &|r| r.set == set && class(r) == what);
    }
    for (part, name) in PARTS {
        let raceway = |r: &Labelled| matches!(r.truth, Some(Defect::Bpfo | Defect::Bpfi));
        put(&format!("**all of the {name}, raceways**"), &|r| r.part == part && raceway(r));
        let element = |r: &Labelled| r.truth == Some(Defect::Bsf);
        put(&format!("**all of the {name}, rolling elements**"), &|r| r.part == part && element(r));
        put(&format!("**all of the {name}, healthy**"), &|r| r.part == part && r.truth.is_none());
    }
}

/// The records of rigs of which enough healthy ones are there, each with the scores of all others that are sound
/// [dB].
pub(super) fn sound_of_the_rig<'a>(
    records: &'a [Labelled],
    judged: &[Judged],
) -> Vec<(&'a Labelled, Vec<f64>)> {
    let rig = |record: &Labelled| record.set.split([' ', ',']).next().unwrap_or_default().to_owned();
    let is_sound = |record: &Labelled| record.truth.is_none() && !record.beside;
    let others = |record: &Labelled| -> Vec<f64> {
        let of_rig = pairs(records, judged).filter(|(other, _)| is_sound(other) && rig(other) == rig(record));
        of_rig
            .filter(|(other, _)| other.name != record.name)
            .filter_map(|(_, judged)| judged.outcome.as_ref()?.score_db)
            .collect()
    };
    let with_others = records.iter().map(|record| (record, others(record)));
    with_others.filter(|(_, sound_db)| sound_db.len() >= LEAST_SOUND).collect()
}

/// Right, wrong and undecided beside healthy records of the same rig.
pub(super) fn beside_sound(rows: &mut Rows, records: &[(&Labelled, Vec<f64>)], outcomes: &[Option<Outcome>]) {
    for (set, what) in SETS.into_iter().flat_map(|set| CLASSES.map(|class| (set, class))) {
        let (mut counts, mut fewest) = (Counts::default(), usize::MAX);
        for ((record, sound_db), outcome) in records.iter().zip(outcomes) {
            if record.set == set && class(record) == what {
                counts.add(outcome.as_ref().map_or(Standing::Silent, |o| o.standing(record.truth)));
                fewest = fewest.min(sound_db.len());
            }
        }
        if counts.of > 0 {
            let values = [
                ("n", counts.of),
                ("healthy records", fewest),
                ("right", counts.right),
                ("wrong", counts.wrong),
                ("silent", counts.silent),
            ];
            let values = values.map(|(what, n)| (what, n as f64));
            rows.values("beside healthy", &format!("{set}, {what}"), values);
        }
    }
}

/// Probability that a family that is there scores higher than one that is not.
fn area_under_roc(scores: &[(f64, bool)]) -> Option<f64> {
    let of = |there: bool| scores.iter().filter(move |(_, is)| *is == there).map(|(score, _)| *score);
    let (mut won, mut of_all) = (0.0, 0.0);
    for high in of(true) {
        for low in of(false) {
            of_all += 1.0;
            won += if high > low { 1.0 } else { 0.5 * f64::from(u8::from(high == low)) };
        }
    }
    (of_all > 0.0).then(|| won / of_all)
}

/// Forced choices and areas under the ROC curve.
pub(super) fn choices(rows: &mut Rows, records: &[Labelled], judged: &[Judged]) {
    type Method = (&'static str, fn(&Judged) -> Option<Scores>);
    let methods: [Method; 3] = [
        ("verdict", |j| j.outcome.as_ref().map(|o| o.scores)),
        ("plain envelope", |j| j.fixed),
        ("kurtogram", |j| j.kurtogram),
    ];
    for (part, name) in PARTS {
        for (what, elements) in [("raceways", false), ("rolling elements", true)] {
            let is_asked = |r: &Labelled| r.truth.is_some_and(|t| (t == Defect::Bsf) == elements);
            for (method, of) in methods {
                let (mut right, mut scores) = (0, Vec::new());
                for (record, judged) in pairs(records, judged).filter(|(r, _)| r.part == part) {
                    let Some(own) = of(judged) else { continue };
                    let asked = is_asked(record);
                    right += usize::from(asked && Some(trial::choice(&own)) == record.truth);
                    if asked || record.truth.is_none() {
                        let all = Defect::ALL.into_iter().zip(own);
                        scores.extend(all.map(|(name, score)| (score, Some(name) == record.truth)));
                    }
                }
                let name = format!("{name}, {what}");
                rows.value("choices", &name, &format!("{method} right"), right as f64);
                rows.value("choices", &name, &format!("{method} area"), area_under_roc(&scores));
            }
        }
    }
}

/// False-alarm probabilities of healthy records, observed against claimed.
pub(super) fn false_alarms(rows: &mut Rows, records: &[Labelled], judged: &[Judged]) -> Figure {
    let sound = pairs(records, judged).filter(|(record, _)| record.truth.is_none());
    let mut values: Vec<f64> =
        sound.filter_map(|(_, judged)| judged.outcome.as_ref()).flat_map(|o| o.p_values).collect();
    values.sort_by(f64::total_cmp);
    let of = values.len();
    for p in [0.1, 0.01, 1e-3, 1e-4, 1e-6] {
        let below = values.iter().filter(|v| **v < p).count();
        rows.value("p_value", &format!("{p}"), "observed", below as f64 / of.max(1) as f64);
    }
    for rig in SETS {
        let of_rig = pairs(records, judged).filter(|(r, _)| r.truth.is_none() && r.set == rig);
        let all: Vec<f64> = of_rig.filter_map(|(_, j)| j.outcome.as_ref()).flat_map(|o| o.p_values).collect();
        if !all.is_empty() {
            let below = |p: f64| all.iter().filter(|v| **v < p).count() as f64;
            let values = [("n", all.len() as f64), ("below 0.1", below(0.1)), ("below 0.01", below(0.01))];
            rows.values("p_value by rig", rig, values);
        }
    }
    let claimed: Vec<f64> = values.iter().map(|p| p.max(1e-12).log10()).collect();
    let observed: Vec<f64> = (0..of).map(|n| ((n as f64 + 0.5) / of as f64).log10()).collect();
    let axis = |label: &str| Axis::decades(label, "");
    let (x, y) = (axis("claimed, p_value"), axis("observed: share of families"));
    let mut figure = Figure::new("p", "Observed against claimed", x, y)
        .with(Series::listed("families of healthy records", Colour::Blue, claimed, observed).as_points())
        .with(Series::listed("calibrated", Colour::Grey, vec![-3.0, 0.0], vec![-3.0, 0.0]));
    figure.levels.push(Level { y: -3.0, label: "1 in 1000".into(), colour: Colour::Orange });
    figure
}

/// Lengths of spalls beside the true ones, by sets and raceways.
pub(super) fn lengths(rows: &mut Rows, records: &[Labelled], judged: &[Judged]) {
    let raceways = [Defect::Bpfo, Defect::Bpfi];
    for (set, raceway) in SETS.into_iter().flat_map(|set| raceways.map(|raceway| (set, raceway))) {
        let asked = |r: &Labelled| r.set == set && r.truth == Some(raceway);
        for (record, judged) in pairs(records, judged).filter(|(r, _)| asked(r)) {
            let spall = judged.outcome.as_ref().and_then(|outcome| outcome.spall_mm);
            let (Some(truth), Some(spall)) = (record.length_mm, spall) else { continue };
            let values = [
                ("true mm", truth),
                ("estimate mm", spall.value),
                ("low mm", spall.low),
                ("high mm", spall.high),
            ];
            rows.values("lengths", &record.name, values);
        }
    }
}

/// Right, wrong and undecided after changes.
pub(super) fn robustness(rows: &mut Rows, records: &[Labelled], changed: &[Changed]) {
    for (name, outcomes) in changed {
        let (mut faults, mut sound) = (Counts::default(), Counts::default());
        for (record, outcome) in records.iter().zip(outcomes) {
            let standing = outcome.as_ref().map_or(Standing::Silent, |o| o.standing(record.truth));
            if record.truth.is_some() { faults.add(standing) } else { sound.add(standing) }
        }
        let values = [
            ("n", faults.of),
            ("right", faults.right),
            ("wrong", faults.wrong),
            ("healthy n", sound.of),
            ("false", sound.wrong),
        ];
        rows.values("robustness", name, values.map(|(what, n)| (what, n as f64)));
    }
}

/// How often the speed is found where none is given, and corrected where one is given that is off.
pub(super) fn speeds(rows: &mut Rows, records: &[Labelled], changed: &[Changed]) {
    for (name, outcomes) in
        changed.iter().filter(|(name, _)| *name == WITHOUT_SPEED || name.starts_with("speed"))
    {
        for (part, what) in PARTS {
            let (mut of, mut told, mut right) = (0, 0, 0);
            for (record, outcome) in records.iter().zip(outcomes).filter(|(record, _)| record.part == part) {
                of += 1;
                let given = trial::given_rpm(name, record.speed_rpm);
                let is_new = |rpm: &f64| given.is_none_or(|given| (rpm / given - 1.0).abs() > 2e-3);
                let Some(rpm) = outcome.as_ref().and_then(|o| o.speed_rpm).filter(is_new) else { continue };
                // The speed of UESTC is nominal, up to 6 % off by its own lines.
                let near = if record.set == UESTC { 0.07 } else { 0.01 };
                told += 1;
                right += usize::from((rpm / record.speed_rpm - 1.0).abs() < near);
            }
            let values = [("n", of), ("told", told), ("right", right)];
            rows.values("speeds", &format!("{name}, {what}"), values.map(|(what, n)| (what, n as f64)));
        }
    }
}

/// Every record: truth and claim.
pub(super) fn every_record(rows: &mut Rows, records: &[Labelled], judged: &[Judged]) {
    for (record, judged) in pairs(records, judged) {
        let Some(outcome) = &judged.outcome else {
            rows.word("records", &record.name, "claimed", "refused");
            continue;
        };
        let claimed: Vec<&str> = outcome.claimed.iter().chain(&outcome.or).map(|d| d.name()).collect();
        rows.word("records", &record.name, "set", &record.set);
        rows.word("records", &record.name, "truth", record.truth.map_or("healthy", Defect::name));
        rows.word("records", &record.name, "claimed", &claimed.join("+"));
        rows.word("records", &record.name, "choice", outcome.choice.name());
    }
}

/// Shares with their intervals, records that stay silent after a change, and lengths by set and raceway.
pub(crate) fn derive(rows: &mut Rows) {
    for name in rows.variants("verdicts") {
        let count =
            |what: &str| rows.number("verdicts", &name, &format!("verdict {what}")).unwrap_or(0.0) as usize;
        let good = if name.contains("healthy") { count("silent") } else { count("right") };
        let share = Share::of(good, count("n")).map_or("–".to_owned(), |s| {
            let [share, low, high] = [s.share, s.low, s.high].map(|x| decimals(100.0 * x, 0));
            format!("{share} % ({low} to {high})")
        });
        rows.word("verdicts", &name, "share", &share);
    }
    for name in rows.variants("robustness") {
        let number = |what: &str| rows.number("robustness", &name, what).unwrap_or(0.0);
        let silent = number("n") - number("right") - number("wrong");
        rows.value("robustness", &name, "silent", silent);
    }
    for (set, raceway) in SETS.into_iter().flat_map(|set| [Defect::Bpfo, Defect::Bpfi].map(|r| (set, r))) {
        let (mut held, mut offs, mut widths) = (0.0, Vec::new(), Vec::new());
        for name in rows.variants("lengths") {
            let is = |what: &str, word: &str| rows.get("records", &name, what) == Some(word);
            let number =
                |what: &str| rows.number("lengths", &name, &format!("{what} mm")).unwrap_or(f64::NAN);
            if is("set", set) && is("truth", raceway.name()) {
                let [truth, value, low, high] = ["true", "estimate", "low", "high"].map(number);
                held += f64::from(u8::from((low..=high).contains(&truth)));
                offs.push(value / truth - 1.0);
                widths.push((high - low) / value);
            }
        }
        if !offs.is_empty() {
            let n = offs.len() as f64;
            let sizes = offs.iter().map(|off: &f64| off.abs()).collect();
            let values = [
                ("lengths", Some(n)),
                ("held", Some(held)),
                ("median off", median(offs)),
                ("median size", median(sizes)),
                ("width", median(widths)),
            ];
            rows.values("lengths by set", &format!("{set}, {}", raceway.part()), values);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_hand_the_area_of_a_perfect_and_of_a_blind_score() {
        assert_eq!(area_under_roc(&[(3.0, true), (2.0, false), (1.0, false)]), Some(1.0));
        assert_eq!(area_under_roc(&[(1.0, true), (1.0, false)]), Some(0.5));
        assert_eq!(area_under_roc(&[(1.0, true), (2.0, false), (0.0, false)]), Some(0.5));
        assert_eq!(area_under_roc(&[(1.0, true)]), None);
    }
}
