//! Changes to a record before it is judged, and the outcome.

use stribeck_diagnosis::{Analysis, Conclusion, Defect, Family, Interval, Machine};
use stribeck_dsp::resample_poly;
use stribeck_formats::Channel;
use stribeck_scene::dice::Dice;
use stribeck_theory::catalogue::CatalogueBearing;

use super::records::Labelled;

/// A change to a record, or to the user's statements on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Change {
    None,
    /// Stated speed over the true one.
    Speed(f64),
    /// No speed is stated.
    NoSpeed,
    /// The stated speed is exact, so that no line corrects it.
    ExactSpeed,
    /// A bearing that none of the test rigs has.
    Bearing(&'static str),
    /// Only the first seconds [s].
    First(f64),
    /// Half of the sample rate.
    HalfRate,
    /// White noise of this rms over that of the record.
    Noise(f64),
    /// Bits of the converter, whose range is the record's.
    Bits(u32),
    /// From the end to the beginning.
    Reversed,
}

/// The change by which the speed has to be found.
pub(super) const WITHOUT_SPEED: &str = "no speed";

/// All changes, with their names and whether claims about them may be right.
pub(super) const CHANGES: [(&str, Change); 16] = [
    ("as it is", Change::None),
    ("speed −1.5 %", Change::Speed(0.985)),
    ("speed +1.5 %", Change::Speed(1.015)),
    ("speed −3 %", Change::Speed(0.97)),
    ("speed +3 %", Change::Speed(1.03)),
    ("speed × 2", Change::Speed(2.0)),
    (WITHOUT_SPEED, Change::NoSpeed),
    ("no correction of the speed", Change::ExactSpeed),
    ("6305 given", Change::Bearing("6305")),
    ("6306 with 8 balls given", Change::Bearing("6306, elements=8")),
    ("first 1 s", Change::First(1.0)),
    ("first 0.5 s", Change::First(0.5)),
    ("half the sample rate", Change::HalfRate),
    ("noise of the same rms", Change::Noise(1.0)),
    ("8 bits", Change::Bits(8)),
    ("reversed in time", Change::Reversed),
];

/// The stated speed after a change, by its name; none where none is stated.
pub(super) fn given_rpm(name: &str, rpm: f64) -> Option<f64> {
    match CHANGES.iter().find(|(of, _)| *of == name)?.1 {
        Change::NoSpeed => None,
        Change::Speed(factor) => Some(factor * rpm),
        _ => Some(rpm),
    }
}

/// Findings of `analyse` on a record.
#[derive(Debug, Clone)]
pub(super) struct Outcome {
    /// Families that are claimed; a second name for one claim in `or`.
    pub(super) claimed: Vec<Defect>,
    /// Families that a claim names as possible beside the first one.
    pub(super) or: Vec<Defect>,
    /// Score of each family [dB] ([`score`]).
    pub(super) scores: [f64; 4],
    /// The part that is named where one must be ([`choice`]).
    pub(super) choice: Defect,
    pub(super) p_values: [f64; 4],
    /// How far the family that stands farthest above unrelated combs does so [dB].
    pub(super) score_db: Option<f64>,
    /// The speed that was taken, or found [1/min].
    pub(super) speed_rpm: Option<f64>,
    pub(super) spall_mm: Option<Interval>,
    pub(super) conclusion: Conclusion,
    /// Rules by which "no defect" of a raceway is not said; none where it is.
    pub(super) open: Vec<&'static str>,
    /// Families that one rule alone refuses.
    pub(super) refused_alone: Vec<(Defect, &'static str)>,
    /// Peak of the impacts of each family over the root mean square of the record.
    pub(super) shown_over_rms: [Option<f64>; 4],
}

/// How an outcome stands to the truth.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Standing {
    Right,
    Wrong,
    Silent,
}

impl Outcome {
    pub(super) fn standing(&self, truth: Option<Defect>) -> Standing {
        if self.claimed.is_empty() {
            return Standing::Silent;
        }
        let holds = |name: &Defect| Some(*name) == truth;
        // One claim with two names is right with either.
        let one = self.claimed.len() == 1 || self.claimed.iter().skip(1).all(|name| self.or.contains(name));
        let right =
            if one { self.claimed.iter().chain(&self.or).any(holds) } else { self.claimed.iter().all(holds) };
        if right { Standing::Right } else { Standing::Wrong }
    }

    /// The same where a rule claims what it alone refuses.
    pub(super) fn without(&self, rule: &str) -> Self {
        let freed = self.refused_alone.iter().filter(|(_, by)| *by == rule).map(|(name, _)| *name);
        Self { claimed: self.claimed.iter().copied().chain(freed).collect(), ..self.clone() }
    }
}

/// Judges a record after a change; `None` where it is refused.
pub(super) fn judge(record: &Labelled, change: Change) -> Option<Outcome> {
    judge_beside(record, change, &[])
}

/// The same with the scores of records of the healthy machine [dB].
pub(super) fn judge_beside(record: &Labelled, change: Change, sound_db: &[f64]) -> Option<Outcome> {
    let (mut rate_hz, mut speed_rpm, mut bearing) =
        (record.rate_hz, record.speed_rpm, record.bearing.clone());
    let mut samples = record.samples.clone();
    match change {
        Change::None | Change::NoSpeed | Change::ExactSpeed => {}
        Change::Speed(factor) => speed_rpm *= factor,
        Change::Bearing(name) => bearing = CatalogueBearing::parse(name).ok()?,
        Change::First(s) => samples.truncate((s * rate_hz) as usize),
        Change::HalfRate => {
            samples = resample_poly(&samples, 1, 2).ok()?;
            rate_hz *= 0.5;
        }
        Change::Noise(share) => add_noise(&mut samples, share),
        Change::Bits(bits) => round(&mut samples, bits),
        Change::Reversed => samples.reverse(),
    }
    let machine = Machine {
        speed_rpm: (change != Change::NoSpeed).then_some(speed_rpm),
        bearing: Some(bearing),
        load_n: record.load_n,
        speed_is_exact: change == Change::ExactSpeed,
        sound_db: sound_db.to_vec(),
        ..Machine::default()
    };
    let analysis = Analysis::of(&Channel::held(record.name.clone(), samples), rate_hz, &machine).ok()?;
    let families = &analysis.findings.families;
    let of = |value: fn(&Family) -> f64, none: f64| {
        Defect::ALL.map(|name| families.iter().find(|f| f.name == name).map_or(none, value))
    };
    let scores = of(score, f64::NEG_INFINITY);
    let claims = families.iter().filter(|f| f.claimed);
    let alone =
        families.iter().filter_map(|f| Some((f.name, <[_; 1]>::try_from(f.refused_by.as_slice()).ok()?[0])));
    Some(Outcome {
        claimed: claims.clone().map(|f| f.name).collect(),
        or: claims.filter_map(|f| f.not_told_apart_from).collect(),
        scores,
        choice: choice(&scores),
        p_values: of(|f| f.p_value, 1.0),
        score_db: analysis.findings.score_db,
        speed_rpm: analysis.findings.speed_rpm,
        spall_mm: analysis.findings.spall_mm,
        conclusion: analysis.findings.conclusion,
        open: analysis.findings.open(),
        refused_alone: alone.collect(),
        shown_over_rms: Defect::ALL
            .map(|name| families.iter().find(|f| f.name == name).and_then(|f| f.shown_over_rms)),
    })
}

/// Score of a family where one must be named [dB]. The cage modulates whatever strikes, so a family that
/// impacts comes first, the highest of several, and the cage is not among them; of those that do not, the one
/// that stands farthest above unrelated combs, because elements of healthy bearings pass under the load, too.
fn score(family: &Family) -> f64 {
    /// More than any comb stands above its background [dB].
    const IMPACTS_DB: f64 = 100.0;
    if family.has_impacts() && family.name != Defect::Ftf {
        IMPACTS_DB + family.score_db()
    } else {
        family.above_unrelated_db().unwrap_or(f64::NEG_INFINITY)
    }
}

/// The part whose family has the highest score. One rolling element that is damaged comes under the load once
/// a turn of the cage, and cages fail more rarely: the cage's family is read as a rolling element.
pub(super) fn choice(scores: &[f64; 4]) -> Defect {
    let best = (0..4).max_by(|a, b| scores[*a].total_cmp(&scores[*b])).unwrap_or(0);
    if Defect::ALL[best] == Defect::Ftf { Defect::Bsf } else { Defect::ALL[best] }
}

/// Adds normal noise, whose rms is `share` of the record's.
fn add_noise(samples: &mut [f64], share: f64) {
    let mean = samples.iter().sum::<f64>() / samples.len() as f64;
    let power = samples.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / samples.len() as f64;
    let mut dice = Dice::new(samples.len() as u64);
    // The sum of twelve even numbers has the variance of one.
    let mut normal = || (0..12).map(|_| dice.share()).sum::<f64>() - 6.0;
    samples.iter_mut().for_each(|x| *x += share * power.sqrt() * normal());
}

/// Rounds to the steps of a converter.
fn round(samples: &mut [f64], bits: u32) {
    let largest = samples.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let step = largest / f64::from(1_u32 << (bits - 1));
    samples.iter_mut().for_each(|x| *x = (*x / step).round() * step);
}
