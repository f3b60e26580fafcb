//! Several channels of one machine at one time: one verdict.
//!
//! Channels record the same bearing through the same machine, so that noise may do the same in all of them:
//! their probabilities are not independent and must not be multiplied. The smallest, times the number of
//! channels, is a bound whatever their dependence (Bonferroni; V. Vovk and R. Wang, Biometrika 107 (2020)
//! 791–808). Where a defect sits follows from how strong its impacts are in each channel (THEORY §7.9).

use serde::Serialize;
use stribeck_dsp::BandEnvelope;

use crate::families::limits::ALPHA;
use crate::words::sentence::no_defect;
use crate::{Analysis, Answer, Defect, Family, MeasuredFindings};

/// The verdict on several channels.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Joint {
    /// Names of the channels, in their order.
    pub channels: Vec<String>,
    /// The defect families.
    pub families: Vec<JointFamily>,
    /// The conclusion in one sentence.
    pub verdict: String,
    /// Limits of the conclusion.
    pub notes: Vec<String>,
}

/// One family over all channels.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct JointFamily {
    /// Whose family it is.
    pub name: Defect,
    /// Probability that healthy bearings show as much in any of the channels: the smallest of theirs times
    /// their number.
    pub p_value: f64,
    /// Whether this is called a defect.
    pub claimed: bool,
    /// What each channel says, in their order.
    pub channels: Vec<ChannelEvidence>,
    /// The channel in which its impacts are strongest, where they are [`NEARER_DB`] above all others.
    pub nearest: Option<String>,
}

/// What one channel says of a family.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ChannelEvidence {
    /// Whether the channel claims it by itself.
    pub claimed: bool,
    /// Probability of a false alarm in this channel.
    pub p_value: f64,
    /// Height of the family above the background [dB]; `null` where it was not looked for.
    pub height_db: Option<f64>,
    /// Its part of the power that swings with the family in all channels; `null` where their units differ.
    pub share: Option<f64>,
}

/// Least level of the impacts at the nearest sensor above that at any other [dB].
pub const NEARER_DB: f64 = 3.0;
/// Harmonics whose swing counts.
const HARMONICS: u32 = 3;
/// Lines beside a harmonic that hold the background of its swing.
const BESIDE: [f64; 4] = [7.0, 11.0, 15.0, 19.0];

impl Joint {
    /// Of channels that were recorded at one time, with their names. `None` for fewer than two.
    pub fn of(channels: &[(String, &Analysis)]) -> Option<Self> {
        if channels.len() < 2 {
            return None;
        }
        let (channels, mut notes) = without_copies(channels);
        let channels = &channels[..];
        let unit = &channels[0].1.findings.unit;
        let alike = channels.iter().all(|(_, analysis)| analysis.findings.unit == *unit);
        if !alike {
            notes.push("the units of the channels differ: their shares are not compared".to_owned());
        }
        let mut families: Vec<JointFamily> =
            Defect::ALL.into_iter().filter_map(|name| JointFamily::of(name, channels, alike)).collect();
        decide(&mut families, &mut notes);
        let names: Vec<String> = channels.iter().map(|(name, _)| name.clone()).collect();
        let none: Vec<String> = (channels.iter())
            .filter(|(_, analysis)| analysis.findings.is_no_signal())
            .map(|(name, _)| format!("`{name}`"))
            .collect();
        let verdict = match none.len() {
            0 => conclude(&families, channels),
            all if all == channels.len() => "No verdict: no channel is a record of a signal.".to_owned(),
            _ => format!("{} No record of a signal: {}.", conclude(&families, channels), none.join(", ")),
        };
        Some(Self { channels: names, families, verdict, notes })
    }
}

/// Samples of each channel that are compared.
const COMPARED: usize = 1 << 14;
/// Samples by which a channel may come after another one that it copies.
const LATER: usize = 64;
/// What a copy has beside the samples of the other, as a part of the power of its steps.
const OWN: f64 = 1e-4;

/// Whether one beginning is the other one, perhaps later, turned round, amplified, or with a little noise. Steps are compared,
/// since two sensors on one machine may share their low frequencies.
fn is_copy(one: &[f64], other: &[f64]) -> bool {
    let steps =
        |x: &[f64]| x[..x.len().min(COMPARED)].windows(2).map(|pair| pair[1] - pair[0]).collect::<Vec<f64>>();
    let (one, other) = (steps(one), steps(other));
    let length = one.len().min(other.len()).saturating_sub(LATER);
    let power = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>();
    let alike = |early: &[f64], late: &[f64]| {
        let early = &early[..length];
        (0..=LATER).any(|lag| {
            let late = &late[lag..lag + length];
            let both = early.iter().zip(late).map(|(a, b)| a * b).sum::<f64>();
            let all = power(early) * power(late);
            all > 0.0 && both * both >= (1.0 - OWN) * all
        })
    };
    length > LATER && (alike(&one, &other) || alike(&other, &one))
}

/// The channels but for those with the samples of another one, and a note on each of these.
fn without_copies<'a>(channels: &[(String, &'a Analysis)]) -> (Vec<(String, &'a Analysis)>, Vec<String>) {
    let mut own: Vec<(String, &Analysis)> = Vec::new();
    let mut notes = Vec::new();
    for (name, analysis) in channels {
        match own.iter().find(|(_, other)| is_copy(&other.beginning, &analysis.beginning)) {
            Some((other, _)) => notes
                .push(format!("channels `{other}` and `{name}` hold the same samples: they are one witness")),
            None => own.push((name.clone(), *analysis)),
        }
    }
    (own, notes)
}

impl JointFamily {
    fn of(name: Defect, channels: &[(String, &Analysis)], alike: bool) -> Option<Self> {
        let of = |analysis: &Analysis| analysis.findings.families.iter().position(|f| f.name == name);
        let families: Vec<Option<&Family>> = channels
            .iter()
            .map(|(_, analysis)| of(analysis).map(|at| &analysis.findings.families[at]))
            .collect();
        let all = || families.iter().flatten();
        let smallest = all().map(|f| f.p_value).reduce(f64::min)?;
        // The place of the comb is that of the channel in which it stands highest.
        let highest = all().max_by(|a, b| a.score_db().total_cmp(&b.score_db()))?;
        let comb_hz = name.shocks_per_period() * highest.measured_hz.unwrap_or(highest.expected_hz);
        let swings: Vec<f64> =
            channels.iter().map(|(_, a)| a.bands.first().map_or(0.0, |band| swing(band, comb_hz))).collect();
        let total: f64 = swings.iter().sum();
        let share = |at: usize| (alike && total > 0.0).then(|| swings[at] / total);
        let evidence = families.iter().enumerate().map(|(at, family)| ChannelEvidence {
            claimed: family.is_some_and(|f| f.claimed),
            p_value: family.map_or(1.0, |f| f.p_value),
            height_db: family.map(|f| f.score_db()).filter(|db| db.is_finite()),
            share: share(at),
        });
        let nearest = alike.then(|| loudest(&swings)).flatten().map(|at| channels[at].0.clone());
        Some(Self {
            name,
            p_value: (channels.len() as f64 * smallest).min(1.0),
            claimed: false,
            channels: evidence.collect(),
            nearest,
        })
    }

    /// Its greatest height in the channels that claim it [dB].
    fn claimed_at_db(&self) -> f64 {
        let claims = self.channels.iter().filter(|evidence| evidence.claimed);
        claims.filter_map(|evidence| evidence.height_db).fold(f64::NEG_INFINITY, f64::max)
    }
}

/// How much the power of a band swings with a comb, in the square of its unit: its mean power times the depth
/// of the modulation beyond that of the lines around.
fn swing(band: &BandEnvelope, comb_hz: f64) -> f64 {
    let of = |n: u32| {
        let hz = f64::from(n) * comb_hz;
        let beside = BESIDE.iter().flat_map(|k| [-1.0, 1.0].map(|side| hz + side * k * band.grid_hz));
        let background = beside.map(|hz| band.depth(hz).powi(2)).sum::<f64>() / (2 * BESIDE.len()) as f64;
        (band.depth(hz).powi(2) - background).max(0.0)
    };
    band.rms.powi(2) * (1..=HARMONICS).map(of).sum::<f64>().sqrt()
}

/// The place of the largest value, where it leads all others.
fn loudest(swings: &[f64]) -> Option<usize> {
    let at = (0..swings.len()).max_by(|a, b| swings[*a].total_cmp(&swings[*b]))?;
    let others = swings.iter().enumerate().filter(|(n, _)| *n != at).map(|(_, swing)| *swing);
    let next = others.fold(0.0, f64::max);
    (swings[at] > 0.0 && swings[at] >= next * 10.0_f64.powf(0.1 * NEARER_DB)).then_some(at)
}

/// Claims a family that one channel claims and all channels together confirm. Of families that different
/// channels claim, the highest one: a lower one may be its sidebands, which a distant channel cannot
/// distinguish.
fn decide(families: &mut [JointFamily], notes: &mut Vec<String>) {
    let bears_out = |f: &JointFamily| f.p_value < ALPHA && f.channels.iter().any(|evidence| evidence.claimed);
    let candidates: Vec<usize> = (0..families.len()).filter(|at| bears_out(&families[*at])).collect();
    let by_height =
        |a: &&usize, b: &&usize| families[**a].claimed_at_db().total_cmp(&families[**b].claimed_at_db());
    let Some(first) = candidates.iter().max_by(by_height).copied() else { return };
    // A channel that contains both distinguishes them.
    let beside = |at: usize| {
        let both = families[first].channels.iter().zip(&families[at].channels);
        both.into_iter().any(|(a, b)| a.claimed && b.claimed)
    };
    let claimed: Vec<bool> =
        (0..families.len()).map(|at| at == first || candidates.contains(&at) && beside(at)).collect();
    for at in candidates.into_iter().filter(|at| !claimed[*at]) {
        notes.push(format!(
            "{} is claimed by a channel in which {} does not stand for itself; it is lower, and left out",
            families[at].name, families[first].name
        ));
    }
    families.iter_mut().zip(claimed).for_each(|(family, claimed)| family.claimed = claimed);
}

fn conclude(families: &[JointFamily], channels: &[(String, &Analysis)]) -> String {
    let of = |family: &JointFamily| {
        let by = family.channels.iter().zip(channels).filter(|(evidence, _)| evidence.claimed);
        let by: Vec<&str> = by.map(|(_, (name, _))| name.as_str()).collect();
        let shares: Vec<String> = family
            .channels
            .iter()
            .zip(channels)
            .filter_map(|(evidence, (name, _))| Some(format!("{name} {:.0} %", 100.0 * evidence.share?)))
            .collect();
        let place = match (&family.nearest, shares.is_empty()) {
            (_, true) => String::new(),
            (Some(nearest), _) => format!(
                "; of its impacts {}: {nearest} is nearest to it, if the ways to all sensors are alike",
                shares.join(", ")
            ),
            (None, _) => format!("; of its impacts {}: none is clearly nearer", shares.join(", ")),
        };
        format!(
            "a defect of {} ({}, claimed by {}{place})",
            family.name.part(),
            family.name,
            by.join(" and ")
        )
    };
    let claimed: Vec<String> = families.iter().filter(|f| f.claimed).map(of).collect();
    if !claimed.is_empty() {
        let who = match channels.len() {
            1 => "The one channel shows".to_owned(),
            count => format!("The {count} channels together show"),
        };
        return format!("{who} {}.", claimed.join(" and "));
    }
    let single = families.iter().any(|f| f.channels.iter().any(|evidence| evidence.claimed));
    if single {
        return format!(
            "The {} channels together cannot tell: one of them claims a defect by itself, which several make more \
             likely by chance.",
            channels.len()
        );
    }
    // What the channel with the least limit says of a raceway holds for all.
    let shows_none = channels.iter().map(|(_, analysis)| &analysis.findings);
    let shows_none = shows_none.filter(|findings| findings.conclusion.raceways.answer == Answer::NoDefect);
    let limit = |findings: &&MeasuredFindings| findings.conclusion.raceways.limit.unwrap_or(f64::INFINITY);
    match shows_none.min_by(|a, b| limit(a).total_cmp(&limit(b))) {
        Some(findings) => no_defect(&findings.conclusion, findings.unit.as_deref()),
        None => format!("None of the {} channels can tell whether there is a defect.", channels.len()),
    }
}
