//! Where "no defect" is said: of damaged bearings, which is false reassurance, and of healthy ones; the verdicts that
//! each rule changes; and the impacts that damaged bearings show beside those that their records could have shown.

use stribeck_diagnosis::pool::Pool;
use stribeck_diagnosis::series::Series;
use stribeck_diagnosis::{Analysis, Answer, Concluded, Defect, Machine, MeasuredFindings};
use stribeck_formats::Channel;
use stribeck_theory::catalogue::CatalogueBearing;

use super::counts::{CLASSES, Judged, class, pairs};
use super::records::{Labelled, SETS, SHORT_BEARING, SHORT_RATE_HZ, ShortRecords};
use super::trial::{Outcome, Standing};
use crate::Rows;
use crate::rows::median;

/// The conclusion on the part that is damaged; of a healthy bearing that on its raceways, of which alone it can be
/// said that there is no defect.
fn on_the_part(outcome: &Outcome, truth: Option<Defect>) -> Concluded {
    match truth {
        Some(Defect::Bsf) => outcome.conclusion.elements,
        Some(Defect::Ftf) => outcome.conclusion.cage,
        Some(Defect::Bpfo | Defect::Bpfi) | None => outcome.conclusion.raceways,
    }
}

/// How many of each conclusion; records that are refused conclude nothing.
fn count(rows: &mut Rows, name: &str, answers: &[Option<Answer>]) {
    let of = |answer: Answer| answers.iter().filter(|a| **a == Some(answer)).count();
    let (defect, none) = (of(Answer::Defect), of(Answer::NoDefect));
    let rest = answers.len() - defect - none;
    let values = [("n", answers.len()), ("defect", defect), ("no defect", none), ("cannot tell", rest)];
    rows.values("conclusions", name, values.map(|(what, n)| (what, n as f64)));
}

/// Conclusions by set and class, with the weakest impacts that the records could have shown.
pub(super) fn conclusions(rows: &mut Rows, records: &[Labelled], judged: &[Judged]) {
    let mut put = |name: &str, keep: &dyn Fn(&Labelled) -> bool| {
        let kept: Vec<_> = pairs(records, judged).filter(|(record, _)| keep(record)).collect();
        if kept.is_empty() {
            return;
        }
        let of = |(r, j): &(&Labelled, &Judged)| Some(on_the_part(j.outcome.as_ref()?, r.truth));
        count(rows, name, &kept.iter().map(|pair| Some(of(pair)?.answer)).collect::<Vec<_>>());
        let limits = kept.iter().filter_map(|pair| of(pair)?.limit_over_rms).collect();
        rows.value("conclusions", name, "limit over rms", median(limits));
    };
    let is_raceway = |r: &Labelled| matches!(r.truth, Some(Defect::Bpfo | Defect::Bpfi));
    put("**all, damaged raceways**", &is_raceway);
    put("**all, damaged rolling elements**", &|r| r.truth == Some(Defect::Bsf));
    put("**all, healthy**", &|r| r.truth.is_none());
    for (set, what) in SETS.into_iter().flat_map(|set| CLASSES.map(|class| (set, class))) {
        put(&format!("{set}, {what}"), &|r| r.set == set && class(r) == what);
    }
}

/// The conclusions on a series: those of its records alone, and pooled.
pub(super) struct JudgedSeries {
    alone: Answer,
    pooled: Answer,
}

/// Records of one bearing together; `None` where one is refused.
pub(super) fn judge_series(series: &ShortRecords) -> Option<JudgedSeries> {
    let bearing = CatalogueBearing::parse(SHORT_BEARING).ok();
    let machine = Machine { speed_rpm: Some(series.speed_rpm), bearing, ..Machine::default() };
    let mut pool = Pool::new(series.records.len(), 0);
    let of = |(at, samples): (usize, &Vec<f64>)| {
        let channel = Channel::held(series.name.clone(), samples.clone());
        let analysis = Analysis::of(&channel, SHORT_RATE_HZ, &machine).ok()?;
        pool.add(at, &analysis);
        Some(analysis.findings)
    };
    let findings: Vec<MeasuredFindings> = series.records.iter().enumerate().map(of).collect::<Option<_>>()?;
    let all: Vec<Option<&MeasuredFindings>> = findings.iter().map(Some).collect();
    let answer = |pooled: &[_]| Series::of(&all, 0, pooled).conclusion.raceways.answer;
    Some(JudgedSeries { alone: answer(&[]), pooled: answer(&pool.judged()) })
}

/// Conclusions on the series, late and early.
pub(super) fn count_series(rows: &mut Rows, series: &[ShortRecords], judged: &[Option<JudgedSeries>]) {
    for (is_damaged, name) in [(true, "late, damaged"), (false, "early")] {
        for (how, of) in
            [("pooled", (|j| j.pooled) as fn(&JudgedSeries) -> Answer), ("one by one", |j| j.alone)]
        {
            let kept = series.iter().zip(judged).filter(|(series, _)| series.is_damaged == is_damaged);
            let answers: Vec<_> = kept.map(|(_, judged)| judged.as_ref().map(of)).collect();
            if !answers.is_empty() {
                count(rows, &format!("FEMTO, eight records of 0.1 s, {name}, {how}"), &answers);
            }
        }
    }
    for (series, judged) in series.iter().zip(judged) {
        let claims = judged.as_ref().is_some_and(|judged| judged.pooled == Answer::Defect);
        rows.word("series", &series.name, "pooled", if claims { "claimed" } else { "silent" });
    }
}

/// The verdicts that change where a rule alone is left out: a family that it alone refuses is claimed, and "no
/// defect" is said where it alone keeps that from being said.
pub(super) fn ablation(rows: &mut Rows, records: &[Labelled], judged: &[Judged]) {
    let outcomes: Vec<(&Labelled, &Outcome)> =
        pairs(records, judged).filter_map(|(record, j)| Some((record, j.outcome.as_ref()?))).collect();
    let mut rules: Vec<&str> =
        outcomes.iter().flat_map(|(_, o)| o.refused_alone.iter().map(|(_, rule)| *rule)).collect();
    rules.sort_unstable();
    rules.dedup();
    for rule in rules {
        let [mut right, mut wrong, mut lost, mut alarms] = [0.0; 4];
        for (record, outcome) in &outcomes {
            let [before, after] =
                [outcome.standing(record.truth), outcome.without(rule).standing(record.truth)];
            match (record.truth, before, after) {
                (_, before, after) if before == after => {}
                (None, ..) => alarms += 1.0,
                (Some(_), Standing::Silent, Standing::Right) => right += 1.0,
                (Some(_), Standing::Silent, _) => wrong += 1.0,
                (Some(_), ..) => lost += 1.0,
            }
        }
        let values = [("right", right), ("wrong", wrong), ("right lost", lost), ("false", alarms)];
        rows.values("without a rule of claims", rule, values);
    }
    let mut rules: Vec<&str> = outcomes.iter().flat_map(|(_, o)| o.open.iter().copied()).collect();
    rules.sort_unstable();
    rules.dedup();
    for rule in rules {
        let alone = |of: &dyn Fn(Option<Defect>) -> bool| {
            outcomes.iter().filter(|(r, o)| of(r.truth) && o.open == [rule]).count() as f64
        };
        let values = [
            ("false", alone(&|truth| matches!(truth, Some(Defect::Bpfo | Defect::Bpfi)))),
            ("right", alone(&|truth| truth.is_none())),
        ];
        rows.values("without a rule of no defect", rule, values);
    }
}

/// Impacts of damaged parts that are found, over the root mean square of their records.
pub(super) fn levels(rows: &mut Rows, records: &[Labelled], judged: &[Judged]) {
    for name in [Defect::Bpfo, Defect::Bpfi, Defect::Bsf] {
        let at = Defect::ALL.iter().position(|of| *of == name).unwrap_or(0);
        let of_part = pairs(records, judged).filter(|(record, _)| record.truth == Some(name));
        let found = of_part.filter_map(|(record, judged)| {
            let outcome = judged.outcome.as_ref()?;
            outcome.shown_over_rms[at].filter(|_| outcome.standing(record.truth) == Standing::Right)
        });
        let mut shown: Vec<f64> = found.collect();
        shown.sort_by(f64::total_cmp);
        let quantile = |part: f64| shown.get(((shown.len() as f64 - 1.0) * part).round() as usize).copied();
        let values = [
            ("n", Some(shown.len() as f64)),
            ("10 %", quantile(0.1)),
            ("20 %", quantile(0.2)),
            ("50 %", quantile(0.5)),
            ("90 %", quantile(0.9)),
        ];
        rows.values("levels", name.part(), values);
    }
}

#[cfg(test)]
mod tests {
    use stribeck_diagnosis::FOUND;

    use crate::Rows;

    /// The shares that verdicts quote are those of the part on which no threshold was chosen, to the digits that they
    /// have.
    #[test]
    fn golden_quoted_shares_are_those_of_the_kept_table() {
        const DIGITS: f64 = 0.005;
        let rows = Rows::read(&crate::results().join("verdicts.csv")).expect("the kept table");
        for (part, quoted) in ["raceways", "rolling elements"].iter().zip(FOUND) {
            let of =
                |what: &str| rows.number("verdicts", &format!("**all of the quoted part, {part}**"), what);
            let share =
                of("verdict right").zip(of("verdict n")).map(|(right, n)| right / n).expect("a share");
            assert!(
                (share - quoted).abs() <= DIGITS,
                "{part}: {share} in the table, {quoted} in the verdict"
            );
        }
    }
}
