//! The verdict for whoever decides: in a few words, how sure it is, how long the spall is, what would not have
//! shown, and what to do next.

use crate::conclusion::LEAST_TURNS;
use crate::families::limits::ALPHA;
use crate::series::{Series, SeriesFamily};
use crate::words::numbers::{chance, significant};
use crate::words::sentence::strength;
use crate::{Answer, Concluded, Conclusion, Defect, Family, Interval, MeasuredFindings};

/// Answers to the questions of whoever decides.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Brief {
    /// The conclusion in a few words.
    pub headline: String,
    /// How probable a mistake is.
    pub sure: String,
    /// Length of the spall, or the bound of it; `None` where no defect is claimed.
    pub length: Option<String>,
    /// The damage that would not have shown.
    pub unseen: String,
    /// The next step.
    pub next: String,
}

impl Brief {
    /// On one record.
    pub fn of(findings: &MeasuredFindings) -> Self {
        let claimed: Vec<&Family> = findings.families.iter().filter(|f| f.claimed).collect();
        let parts: Vec<(Defect, Option<Defect>)> =
            claimed.iter().map(|f| (f.name, f.not_told_apart_from)).collect();
        Self {
            headline: headline(&parts, findings),
            sure: match claimed.iter().map(|f| f.p_value).reduce(f64::max) {
                Some(p) => sure_of_a_defect(p, findings),
                None => sure_of_none(findings),
            },
            length: (!claimed.is_empty()).then(|| length(findings, &claimed)),
            unseen: unseen(&findings.conclusion, findings.unit.as_deref()),
            next: next(&parts, findings),
        }
    }

    /// On a series, of which `last` is the last record that could be analysed.
    pub fn of_series(series: &Series, last: &MeasuredFindings) -> Self {
        let claimed: Vec<&SeriesFamily> = series.families.iter().filter(|f| f.claimed).collect();
        let parts: Vec<(Defect, Option<Defect>)> =
            claimed.iter().map(|f| (f.name, f.not_told_apart_from)).collect();
        // The last record by itself may claim what the series does not.
        let of_last = MeasuredFindings { conclusion: series.conclusion, ..last.clone() };
        Self {
            headline: headline(&parts, &of_last),
            sure: match claimed.iter().map(|f| f.p_value).reduce(f64::max) {
                Some(p) => sure_of_a_defect(p, last),
                None => sure_of_none(&of_last),
            },
            length: (!claimed.is_empty()).then(|| match series.growth {
                Some(growth) => format!("{} in record {}.", interval(&growth.to_mm), growth.to),
                None => length(last, &last.families.iter().filter(|f| f.claimed).collect::<Vec<_>>()),
            }),
            unseen: unseen(&series.conclusion, last.unit.as_deref()),
            next: next(&parts, &of_last),
        }
    }
}

/// Parts that are claimed, two that are not distinguished as one.
fn damaged(parts: &[(Defect, Option<Defect>)]) -> String {
    let is_second = |at: usize| parts[..at].iter().any(|(_, other)| *other == Some(parts[at].0));
    let names = parts.iter().enumerate().filter(|(at, _)| !is_second(*at)).map(|(_, (name, other))| {
        let other = if *name == Defect::Ftf { Some(Defect::Bsf) } else { *other };
        other.map_or(name.part().to_owned(), |other| format!("{} or {}", name.part(), other.part()))
    });
    names.collect::<Vec<_>>().join(" and ")
}

fn headline(parts: &[(Defect, Option<Defect>)], findings: &MeasuredFindings) -> String {
    let raceways = findings.conclusion.raceways.answer;
    if !parts.is_empty() {
        format!("Defect of {}", damaged(parts))
    } else if raceways == Answer::NoSignal {
        "No verdict: the samples are not those of the machine".to_owned()
    } else if raceways == Answer::NoDefect {
        "No defect of a raceway".to_owned()
    } else if findings.families.is_empty() {
        "No verdict: speed or bearing is not known".to_owned()
    } else if findings.unexplained.is_some() {
        "No bearing defect claimed".to_owned()
    } else {
        "Cannot tell whether the bearing is damaged".to_owned()
    }
}

/// A claim rests on its probability, or on records of the healthy machine that show less.
fn sure_of_a_defect(p_value: f64, findings: &MeasuredFindings) -> String {
    let alone = format!("Probability that a healthy bearing shows as much: {}.", chance(p_value));
    match findings.sound_as_high.filter(|_| p_value >= ALPHA) {
        Some(sound) => format!(
            "{} of {} records of the healthy machine show as much. Without them: {}",
            sound.as_high,
            sound.records,
            alone.replacen('P', "p", 1)
        ),
        None => alone,
    }
}

fn sure_of_none(findings: &MeasuredFindings) -> String {
    let found = |of: &Concluded| of.share.map_or("–".to_owned(), chance);
    let Conclusion { raceways, elements, .. } = &findings.conclusion;
    match raceways.answer {
        Answer::NoSignal => "No probability follows from such samples.".to_owned(),
        Answer::NoDefect => format!(
            "Of measured bearings with a damaged raceway {} were found, of those with a damaged rolling element {}.",
            found(raceways),
            found(elements)
        ),
        Answer::Defect | Answer::CannotTell => {
            let looked = findings.families.iter().filter(|f| f.rank.is_some());
            let nearest = looked.min_by(|a, b| a.p_value.total_cmp(&b.p_value));
            match nearest {
                Some(family) => format!(
                    "It decides neither way. Nearest to a claim is {} ({}): probability that a healthy bearing \
                     shows as much: {}.",
                    family.name.part(),
                    family.name,
                    chance(family.p_value)
                ),
                None => "It decides neither way: no family could be looked for.".to_owned(),
            }
        }
    }
}

fn interval(mm: &Interval) -> String {
    format!("{:.2} mm (90 %: {:.2} to {:.2} mm)", mm.value, mm.low, mm.high)
}

/// One event a passage bounds no length: it may be the only one.
fn length(findings: &MeasuredFindings, claimed: &[&Family]) -> String {
    if let Some(spall) = &findings.spall_mm {
        let otherwise = findings.spall_otherwise_mm.map_or(String::new(), |other| {
            format!("; a spall of {:.1} mm would have impacts in the same rhythm", other.value)
        });
        return format!("{}{otherwise}.", interval(spall));
    }
    if let Some(below) = findings.spall_below_mm {
        return format!(
            "Not determined: one impact a passage. Below {below:.1} mm if entry and exit both make one; otherwise \
             up to the distance of two elements."
        );
    }
    let on_a_raceway = claimed.iter().all(|f| matches!(f.name, Defect::Bpfo | Defect::Bpfi));
    let why = match claimed.len() {
        0 | 1 if on_a_raceway => "no second impact stands out of each passage",
        0 | 1 => "it is estimated on raceways only",
        _ => "more than one part is claimed",
    };
    format!("Not determined: {why}. The bound is the distance of two elements.")
}

fn unseen(conclusion: &Conclusion, unit: Option<&str>) -> String {
    let of = |part: &Concluded| {
        let (peak, band_hz) = part.limit.zip(part.limit_band_hz)?;
        let over = part
            .limit_over_rms
            .map_or(String::new(), |over| format!(", {} times the RMS of the record", significant(over, 2)));
        Some(format!("impacts below {}{over}", strength(peak, band_hz, unit)))
    };
    let Conclusion { raceways, elements, .. } = conclusion;
    let none = || "none of their impacts would have shown".to_owned();
    let one_in = elements.share.map_or(f64::NAN, |share| (1.0 / share).round());
    format!(
        "Raceways: {}. Rolling elements: {}; of damaged ones this method finds one in {one_in}. Cage: never \
         measured.",
        of(raceways).unwrap_or_else(none),
        of(elements).unwrap_or_else(none)
    )
}

fn next(parts: &[(Defect, Option<Defect>)], findings: &MeasuredFindings) -> String {
    let is_sought = findings.speed_uncertainty_rpm.is_some();
    let rpm = findings.speed_rpm.unwrap_or(f64::NAN);
    let raceways = findings.conclusion.raceways.answer;
    if let Some(spoilt) = findings.quality.iter().find(|found| found.kind.spoils_verdicts()) {
        return format!("Mend the measurement ({}) and record again.", spoilt.kind.name());
    }
    if !parts.is_empty() {
        let speed = if is_sought { "Measure the speed, which was sought in the record. " } else { "" };
        return format!(
            "{speed}Plan an inspection of {}. Until then record again at this place and speed: a series of records \
             shows whether the defect grows.",
            damaged(parts)
        );
    }
    if raceways == Answer::NoDefect {
        return "Nothing for the raceways. Record again at the usual interval: damage of a rolling element may have \
                gone unseen."
            .to_owned();
    }
    if findings.families.is_empty() {
        return "Give the bearing (`--bearing`) and the speed of its shaft (`--speed-rpm`).".to_owned();
    }
    if is_sought {
        return "Measure the speed: it was sought in the record.".to_owned();
    }
    if let Some(other) = &findings.unexplained {
        return format!(
            "Find what has impacts at {:.2} Hz: the converter, a gear or another bearing. Records of the healthy \
             machine (`--baseline`) set aside what stands in them, too.",
            other.hz
        );
    }
    if findings.duration_s * rpm / 60.0 < LEAST_TURNS {
        return format!(
            "Record {} s or more, {LEAST_TURNS:.0} turns of the shaft.",
            significant(LEAST_TURNS * 60.0 / rpm, 2)
        );
    }
    "Make a longer record, or one nearer to the bearing, or give records of the healthy machine (`--baseline`)."
        .to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Analysis, Machine};
    use stribeck_dsp::channel::Channel;
    use stribeck_testing::Noise;
    use stribeck_theory::catalogue::CatalogueBearing;

    const RATE_HZ: f64 = 12_800.0;

    /// Noise of a 6205 at 1200 rpm, a line of its shaft, and impacts at `hz` that ring at 3 kHz.
    fn record(shaft: f64, hz: f64, height: f64, seconds: f64) -> MeasuredFindings {
        let mut noise = Noise::new(7);
        let samples = (0..(seconds * RATE_HZ) as u32).map(|n| {
            let since = (f64::from(n) / RATE_HZ).rem_euclid(1.0 / hz);
            let turned = (std::f64::consts::TAU * 20.0 * f64::from(n) / RATE_HZ).sin();
            let ringing = (-since / 1e-3).exp() * (std::f64::consts::TAU * 3e3 * since).sin();
            noise.uniform() + shaft * turned + height * ringing
        });
        let channel = Channel::held("housing", samples.collect()).in_unit(Some("g".to_owned()));
        let machine = Machine {
            speed_rpm: Some(1200.0),
            bearing: Some(CatalogueBearing::parse("6205").expect("known")),
            ..Machine::default()
        };
        Analysis::of(&channel, RATE_HZ, &machine).expect("a signal").findings
    }

    #[test]
    fn planted_a_defect_has_its_probability_and_a_bound_of_its_length() {
        let brief = Brief::of(&record(0.0, 71.7, 2.0, 5.0));
        assert_eq!(brief.headline, "Defect of the outer raceway");
        assert!(brief.sure.starts_with("Probability that a healthy bearing shows as much: "), "{brief:?}");
        assert!(brief.length.as_ref().is_some_and(|mm| mm.starts_with("Not determined: ")), "{brief:?}");
        assert!(brief.next.contains("inspection of the outer raceway"), "{brief:?}");
    }

    #[test]
    fn planted_noise_has_no_defect_and_says_what_it_would_not_show() {
        // Beside the line of the shaft the weakest impacts that would show are weak.
        let brief = Brief::of(&record(2.0, 71.7, 0.0, 5.0));
        assert_eq!((brief.headline.as_str(), brief.length), ("No defect of a raceway", None));
        assert!(brief.unseen.starts_with("Raceways: impacts below ") && brief.unseen.contains(" g (peak"));
    }

    #[test]
    fn planted_a_comb_of_no_family_is_no_claim_and_a_short_record_says_how_long() {
        let other = record(0.0, 52.5, 2.0, 5.0);
        assert_eq!(Brief::of(&other).headline, "No bearing defect claimed");
        assert!(other.verdict.starts_with("No bearing defect claimed: "), "{}", other.verdict);
        let short = Brief::of(&record(2.0, 71.7, 0.0, 0.9));
        assert_eq!(short.headline, "Cannot tell whether the bearing is damaged");
        assert_eq!(short.next, "Record 1 s or more, 20 turns of the shaft.");
    }
}
