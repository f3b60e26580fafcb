//! Which of the families that are there are called a defect.

use stribeck_dsp::{BandEnvelope, Whitened};

use crate::families::controls::MOST_AS_HIGH;
use crate::families::family::{Family, Reason, SOUND_DEPTHS};
use crate::families::limits::{ALPHA, IMPACT, IMPACT_OF_ELEMENT};
use crate::families::sidebands::is_modulated;
use crate::families::sound::BesideSound;
use crate::families::unexplained::{Unexplained, UnexplainedComb};
use crate::families::unrelated::{SLIP, is_the_same};
use crate::words::numbers::chance;
use crate::words::sentence::probability;
use crate::{Defect, families::element_rhythm};

/// Lines that two families both take for theirs belong to the one that is nearer to its place; to no rolling
/// element, unless the cage modulates them (`modulated`). Where both are expected within a resolution of each
/// other, they are not distinguished.
pub(crate) fn shared_out(families: Vec<Family>, resolution_hz: f64, modulated: bool) -> Vec<Family> {
    let cannot_be = |family: &Family| family.name == Defect::Bsf && !modulated;
    let shocks = |family: &Family| family.name.shocks_per_period();
    let place = |at: usize| shocks(&families[at]) * families[at].expected_hz;
    let comb = |at: usize| Some(shocks(&families[at]) * families[at].measured_hz?);
    let off =
        |at: usize| (families[at].measured_hz.unwrap_or(f64::NAN) / families[at].expected_hz - 1.0).abs();
    let share = |a: usize, b: usize| {
        a != b && comb(a).zip(comb(b)).is_some_and(|(a, b)| (b - a).abs() < resolution_hz)
    };
    let alike = |a: usize, b: usize| {
        let excluded = cannot_be(&families[a]) || cannot_be(&families[b]);
        share(a, b) && (place(b) - place(a)).abs() < resolution_hz && !excluded
    };
    let gives_way = |a: usize, b: usize| match [a, b].map(|n| cannot_be(&families[n])) {
        [false, false] => off(b) < off(a),
        [gives_way, _] => gives_way,
    };
    let mut heights: Vec<f64> = families.iter().map(|family| family.height_db).collect();
    let mut out = Vec::new();
    for (at, family) in families.iter().enumerate() {
        let all = || 0..families.len();
        if let Some(other) = all().find(|n| alike(at, *n)) {
            heights[at] = heights[at].max(heights[other]);
            let not_told_apart_from = Some(families[other].name);
            out.push(Family { not_told_apart_from, height_db: heights[at], ..family.clone() });
            continue;
        }
        let why = if cannot_be(family) {
            "and they are not modulated by the cage, as it is where a spot on a rolling element comes \
             under the load"
        } else {
            "which are nearer to their place"
        };
        let owner = all().find(|n| share(at, *n) && gives_way(at, *n));
        let words = |n: usize| format!("its lines are those of {}, {why}", families[n].name);
        out.push(match owner {
            Some(owner) => family.clone().refused("shared lines", words(owner)),
            None => family.clone(),
        });
    }
    out
}

/// The defect that stands for itself, but for the cage: its place and its comb [Hz].
pub(crate) fn claimed_first(families: &[Family]) -> Option<(usize, f64)> {
    let at = families.iter().position(|f| f.claimed && f.name != Defect::Ftf)?;
    Some((at, families[at].name.shocks_per_period() * families[at].measured_hz?))
}

/// The family that strikes and stands highest, but for the cage's and those whose lines are another's.
pub(crate) fn first<'a>(families: impl Iterator<Item = &'a Family>) -> Option<usize> {
    let striking = families
        .enumerate()
        .filter(|(_, f)| f.name != Defect::Ftf && f.reason == Reason::Undecided && f.has_impacts());
    striking.max_by(|a, b| a.1.height_db.total_cmp(&b.1.height_db)).map(|(at, _)| at)
}

/// A family of the inner raceway and twice the spin of an element may be a turn of the shaft apart, and one is
/// then the sideband of the other: twice BSF is the inner raceway's but where the cage modulates it and the
/// shaft does not modulate the raceway.
pub(crate) fn without_mirrored(
    families: Vec<Family>,
    shaft_hz: f64,
    modulated: bool,
    bands: &[(&BandEnvelope, Whitened)],
) -> Vec<Family> {
    let comb_of = |name: Defect| {
        let family = families.iter().find(|family| family.name == name && family.has_impacts())?;
        Some((family, name.shocks_per_period() * family.measured_hz?))
    };
    let (Some((inner, inner_hz)), Some((element, element_hz))) =
        (comb_of(Defect::Bpfi), comb_of(Defect::Bsf))
    else {
        return families;
    };
    let band = bands.iter().find(|(band, _)| inner.band_hz == Some((band.low_hz, band.high_hz)));
    let Some((_, spectrum)) = band else { return families };
    let width_hz = SAME_LINES * spectrum.grid_hz();
    if ((inner_hz - element_hz).abs() - shaft_hz).abs() >= width_hz {
        return families;
    }
    let is_element = modulated && !is_modulated(spectrum, inner_hz, shaft_hz);
    let (loser, winner) = if is_element { (inner, element) } else { (element, inner) };
    let (loser, winner) = (loser.name, winner.name.shocks_name());
    let why = format!("its lines are those of {winner}, a turn of the shaft away");
    let of = |family: Family| {
        if family.name == loser { family.refused("a turn of the shaft away", why.clone()) } else { family }
    };
    families.into_iter().map(of).collect()
}

/// Turns of the cage by which sidebands of an element's family lie at the place of a raceway: in a 6205 those at −3 and
/// +2 are within slip of BPFO and BPFI.
const CAGES: i32 = 3;

/// A spot on an element comes under the load once a turn of the cage, so twice its spin has sidebands at the cage's
/// distance. A raceway's first line that is one of them, of which all that are nearer to `element_hz` stand higher, is
/// not the raceway's.
pub(crate) fn without_sidebands_of_elements(
    families: Vec<Family>,
    element_hz: f64,
    cage_hz: f64,
    bands: &[(&BandEnvelope, Whitened)],
) -> Vec<Family> {
    let turns_away = |family: &Family| {
        let hz = family.measured_hz.filter(|_| matches!(family.name, Defect::Bpfo | Defect::Bpfi))?;
        let (_, spectrum) =
            bands.iter().find(|(band, _)| family.band_hz == Some((band.low_hz, band.high_hz)))?;
        let side = if element_hz > hz { 1.0 } else { -1.0 };
        let stands = |turns: i32| {
            let at = |slip: f64| spectrum.at(hz + side * f64::from(turns) * cage_hz * (1.0 + slip));
            let highest = [-SLIP, -0.5 * SLIP, 0.0, 0.5 * SLIP, SLIP].map(at).into_iter().fold(0.0, f64::max);
            highest > spectrum.at(hz) && spectrum.line_p_value(highest) < ALPHA
        };
        let centre = |turns: i32| hz + side * f64::from(turns) * cage_hz;
        let turns = (1..=CAGES).find(|turns| (centre(*turns) / element_hz - 1.0).abs() < SLIP)?;
        (1..=turns).all(stands).then_some(turns)
    };
    let of = |family: Family| {
        match turns_away(&family) {
        Some(turns) => family.refused(
            "sideband of an element",
            format!(
                "its lines are sidebands of 2×BSF, {turns} times the frequency of the cage away, and those nearer to \
                 it stand higher"
            ),
        ),
        None => family,
    }
    };
    families.into_iter().map(of).collect()
}

/// The combs of a record that are no family's, and what they may have for sidebands.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Around<'a> {
    /// The highest of each band, of those that have one.
    pub(crate) foreign: &'a [UnexplainedComb],
    /// The one at half the frequency of the raceway that stands highest.
    pub(crate) at_half: Option<&'a Unexplained>,
    /// The farthest that rolling puts the outer raceway's family above its place, and the inner one's below,
    /// as parts of it, where the lines of the shaft give the speed.
    pub(crate) rolling: Option<(f64, f64)>,
    /// Turns of the shaft [Hz].
    pub(crate) shaft_hz: f64,
    /// Frequencies nearer than this to one another are one [Hz].
    pub(crate) width_hz: f64,
}

/// Largest probability of a false alarm at which a family is claimed while something else strikes louder.
const BESIDE_OTHERS: f64 = 1e-4;
/// Lines within which two combs, each by its own place, are one.
const SAME_LINES: f64 = 2.0;
/// Multiples and sidebands of the shaft by which a foreign comb may account for a family.
const MULTIPLES: u32 = 3;
const SIDEBANDS: i32 = 4;

impl Around<'_> {
    /// The comb that is no family's and may be what the family's lines are: a higher one that stands in the same
    /// band, too, or accounts for them from another one. Elements and cages modulate whatever strikes, so for
    /// their families any band counts.
    fn instead_of(&self, family: &Family) -> Option<Unexplained> {
        let is_raceway = matches!(family.name, Defect::Bpfo | Defect::Bpfi);
        let comb_hz = family.name.shocks_per_period() * family.measured_hz.unwrap_or(family.expected_hz);
        let counts = |other: &&UnexplainedComb| {
            !is_raceway
                || other.is_in(family.band_hz)
                || self.accounts_for(comb_hz, other.comb.fundamental_hz)
        };
        let foreign = self.foreign.iter().filter(counts).map(|other| other.report(self.shaft_hz));
        let higher = foreign.chain(self.at_half.copied()).filter(|other| other.height_db > family.height_db);
        higher.max_by(|a, b| a.height_db.total_cmp(&b.height_db))
    }

    /// Whether lines of a comb at `hz` are multiples of another one's, or its sidebands by the shaft.
    fn accounts_for(&self, hz: f64, other_hz: f64) -> bool {
        (1..=MULTIPLES).any(|m| {
            (-SIDEBANDS..=SIDEBANDS)
                .any(|k| (hz - f64::from(m) * other_hz - f64::from(k) * self.shaft_hz).abs() < self.width_hz)
        })
    }
}

/// What the rules ask beside a family.
pub(crate) struct Case<'a> {
    /// The combs that are no family's.
    around: Around<'a>,
    /// The family that stands farthest above unrelated combs, beside healthy records of the machine.
    sound: Option<BesideSound>,
    /// Whether the cage modulates the impacts of a rolling element.
    pub(crate) modulated: bool,
    /// Height of the family that strikes and stands highest [dB]; −∞ without one.
    first_db: f64,
}

/// Why a family is refused; `None` where this rule does not refuse it.
type Rule = fn(&Family, &Case<'_>) -> Option<String>;

/// The rules by name, in their order: the first that refuses a family says why. Every family of rolling defects is
/// modulated by the cage, so the cage is suspected last.
const RULES: [(&str, Rule); 10] = [
    ("noise", noise_makes_as_much),
    ("unrelated combs", unrelated_combs_stand_as_high),
    ("depth of an impact", swings_as_in_sound_bearings),
    ("depth in healthy bearings", sound_bearings_show_as_much),
    ("rolling", no_cage_rolls_so_fast),
    ("unexplained comb", unexplained_comb_stands_higher),
    ("louder source in another band", something_else_strikes_louder),
    ("cage in an element", element_without_the_cage),
    ("share of the cage", cage_shares_in_a_family),
    ("higher family", another_family_stands_higher),
];

fn noise_makes_as_much(family: &Family, _: &Case<'_>) -> Option<String> {
    let p = family.noise_p_value;
    (p >= ALPHA)
        .then(|| format!("noise of the same spectrum reaches this with a probability of {}", probability(p)))
}

fn unrelated_combs_stand_as_high(family: &Family, _: &Case<'_>) -> Option<String> {
    let rank = family.rank.unwrap_or(1.0);
    (rank > MOST_AS_HIGH)
        .then(|| format!("{:.0} % of combs at other spacings stand as high in this record", 100.0 * rank))
}

fn swings_as_in_sound_bearings(family: &Family, case: &Case<'_>) -> Option<String> {
    let depth = family.depth.unwrap_or(0.0);
    let impact = if family.name == Defect::Bsf && case.modulated { IMPACT_OF_ELEMENT } else { IMPACT };
    (depth < impact && case.beyond_sound(family).is_none()).then(|| {
        format!(
            "it is there, but the power of its band varies by {:.0} % of its mean, where impacts vary it by {:.0} %; \
             families of healthy bearings reach that with a probability of {}",
            100.0 * depth,
            100.0 * impact,
            chance((-SOUND_DEPTHS * depth).exp())
        )
    })
}

fn sound_bearings_show_as_much(family: &Family, case: &Case<'_>) -> Option<String> {
    (family.p_value >= ALPHA && case.beyond_sound(family).is_none()).then(|| {
        format!(
            "it is there, but healthy bearings show as much with a probability of {}",
            probability(family.p_value)
        )
    })
}

/// Slip makes the outer raceway's family slower and the inner one's faster; an axial load that steepens the
/// contact, the other way, a little.
fn no_cage_rolls_so_fast(family: &Family, case: &Case<'_>) -> Option<String> {
    let (most_outer, least_inner) = case.around.rolling?;
    let times = family.measured_hz? / family.expected_hz;
    let is_beyond = match family.name {
        Defect::Bpfo => times > most_outer,
        Defect::Bpfi => times < least_inner,
        Defect::Bsf | Defect::Ftf => false,
    };
    is_beyond.then(|| {
        format!(
            "it is there, {} % off the frequency at the speed of the shaft's lines, more than slip or an axial \
             load explains: another bearing's",
            format!("{:+.1}", 100.0 * (times - 1.0)).replace('-', "−")
        )
    })
}

fn unexplained_comb_stands_higher(family: &Family, case: &Case<'_>) -> Option<String> {
    let other = case.around.instead_of(family)?;
    Some(format!(
        "it is there, but a comb at {:.3} times the shaft that is no family of this bearing stands higher",
        other.order
    ))
}

/// A record with a source of its own in other bands asks for more certainty in the family's.
fn something_else_strikes_louder(family: &Family, case: &Case<'_>) -> Option<String> {
    let mut louder = case.around.foreign.iter().map(|other| other.report(case.around.shaft_hz));
    let other = louder.find(|other| other.height_db > family.height_db)?;
    (family.p_value >= BESIDE_OTHERS && case.beyond_sound(family).is_none()).then(|| {
        format!(
            "it is there, but something that is no family of this bearing has stronger impacts in another band, at \
             {:.3} times the shaft, and healthy bearings show as much with a probability of {}",
            other.order,
            probability(family.p_value)
        )
    })
}

fn element_without_the_cage(family: &Family, case: &Case<'_>) -> Option<String> {
    (family.name == Defect::Bsf && !case.modulated).then(|| {
        "it is there, and no turn of the cage is in it, as it is where a spot on a rolling element comes under \
         the load"
            .to_owned()
    })
}

fn cage_shares_in_a_family(family: &Family, case: &Case<'_>) -> Option<String> {
    (case.first_db.is_finite() && family.name == Defect::Ftf)
        .then(|| "it is there, as the cage's share in a family that stands for itself".to_owned())
}

/// A family that stands lower than another is not the first, even if the other one is not believed.
fn another_family_stands_higher(family: &Family, case: &Case<'_>) -> Option<String> {
    (family.height_db < case.first_db)
        .then(|| "it is there, but another family stands higher, of which it may be sidebands".to_owned())
}

/// Which of the families that are there are defects.
pub(crate) fn decide(
    families: Vec<Family>,
    around: Around<'_>,
    sound: Option<BesideSound>,
    modulated: bool,
) -> Vec<Family> {
    let first_db = first(families.iter()).map_or(f64::NEG_INFINITY, |at| families[at].height_db);
    let case = Case { around, sound, modulated, first_db };
    let decided = |family: Family| {
        let is_decided = family.reason != Reason::Undecided;
        if is_decided && family.refused_by.is_empty() {
            return family;
        }
        let refusals = RULES.iter().filter_map(|(name, rule)| Some((*name, rule(&family, &case)?)));
        let (names, why): (Vec<_>, Vec<_>) = refusals.unzip();
        let refused_by = [family.refused_by.clone(), names].concat();
        match why.into_iter().next() {
            Some(why) if !is_decided => Family { reason: why.into(), refused_by, ..family },
            None if !is_decided => claimed(family, &case),
            _ => Family { refused_by, ..family },
        }
    };
    families.into_iter().map(decided).collect()
}

impl Case<'_> {
    /// What healthy records of the machine say of a family, where it stands beyond them: they know this machine,
    /// and take the place of what healthy bearings of other rigs show.
    fn beyond_sound(&self, family: &Family) -> Option<BesideSound> {
        self.sound.filter(|sound| sound.name == family.name && sound.is_beyond())
    }
}

/// A family that no rule refuses.
fn claimed(family: Family, case: &Case<'_>) -> Family {
    if let Some(sound) =
        case.beyond_sound(&family).filter(|_| family.p_value >= ALPHA || !family.has_impacts())
    {
        return beyond_sound_records(family, &sound);
    }
    let is_cage = family.name == Defect::Ftf;
    let other = family.not_told_apart_from.filter(|_| !is_cage).map_or(String::new(), |name| {
        format!(
            "; the lines of {name} have their places within a resolution of these, and the record does not \
             tell which it is"
        )
    });
    let depth = family.depth.unwrap_or(0.0);
    let why = format!(
        "{} harmonics stand out, and its power varies by {:.0} % of its mean{other}",
        family.harmonics,
        100.0 * depth
    );
    // One element that is damaged comes under the load once a turn of the cage, too.
    let not_told_apart_from = if is_cage { Some(Defect::Bsf) } else { family.not_told_apart_from };
    Family { claimed: true, not_told_apart_from, reason: Reason::Decided(why), ..family }
}

/// A family that is claimed by what the machine showed when it was healthy.
fn beyond_sound_records(family: Family, sound: &BesideSound) -> Family {
    let why = format!(
        "{} harmonics stand, {:.1} dB above combs at other spacings, where the highest of {} records of the healthy machine \
         has {:.1} dB; by their scatter such a record has as much with a probability of {}",
        family.harmonics,
        sound.score_db,
        sound.records,
        sound.highest_db,
        chance(sound.p_value)
    );
    let p_value = sound.p_value.max(family.noise_p_value);
    // A damaged element, too, makes elements pass the load more unevenly: three of four on the rig UESTC.
    let or_element = (family.name == Defect::Bpfo && sound.is_above_few()).then_some(Defect::Bsf);
    let not_told_apart_from = family.not_told_apart_from.or(or_element);
    Family { claimed: true, p_value, not_told_apart_from, reason: Reason::Decided(why), ..family }
}

/// Where something strikes once a turn of the cage and no family of a raceway stands at its place, names a
/// rolling element that strikes twice a spin, by the whole range or by the band in which the cage stands
/// highest.
pub(crate) fn with_element(families: Vec<Family>, bands: &[BandEnvelope]) -> Vec<Family> {
    let Some((band_hz, hz)) = element_by_the_cage(&families, bands) else { return families };
    let named = |family: Family| match family.name {
        Defect::Bsf => Family {
            measured_hz: Some(0.5 * hz),
            band_hz: Some(band_hz),
            in_passages: true,
            claimed: true,
            reason: Reason::Decided(format!(
                "something strikes once a turn of the cage, and as it passes at {hz:.1} Hz, twice the spin of an \
                 element, which no unrelated rhythm does as much; from turn to turn it loses its phase, so that \
                 it has no lines"
            )),
            ..family
        },
        Defect::Ftf => family.refused(
            "element once a turn of the cage",
            "it is there, as the rhythm in which one rolling element passes under the load".to_owned(),
        ),
        _ => family,
    };
    families.into_iter().map(named).collect()
}

/// The band [Hz] and the rhythm [Hz] of an element that strikes twice a spin, once a turn of the cage.
fn element_by_the_cage(families: &[Family], bands: &[BandEnvelope]) -> Option<((f64, f64), f64)> {
    let of = |name: Defect| families.iter().find(|family| family.name == name);
    let (element, cage) = (of(Defect::Bsf)?, of(Defect::Ftf)?);
    // A spot on a rolling element meets both raceways in a turn.
    let impacts_hz = 2.0 * element.expected_hz;
    let is_taken = families.iter().any(|f| f.is_there() && is_the_same(f.expected_hz, impacts_hz));
    (cage.claimed && !is_taken).then_some(())?;
    let loudest = |band: &&BandEnvelope| cage.band_hz == Some((band.low_hz, band.high_hz));
    let asked = [bands.first(), bands.iter().find(loudest)];
    asked.into_iter().flatten().find_map(|band| {
        let hz = element_rhythm::repeating_hz(band, impacts_hz)?;
        Some(((band.low_hz, band.high_hz), hz))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Conclusion;
    use crate::words::sentence::{Told, conclude};

    /// Found at `measured_hz`, far above noise and anything else.
    fn found(name: Defect, expected_hz: f64, measured_hz: f64) -> Family {
        Family {
            measured_hz: Some(measured_hz),
            harmonics: 5,
            level_db: Some(25.0),
            p_value: 1e-9,
            noise_p_value: 1e-12,
            rank: Some(0.0),
            depth: Some(1.5),
            height_db: 25.0,
            ..Family::expected(name, expected_hz)
        }
    }

    /// A NU 203 at 1500 rpm has BPFO at 106.3 Hz and twice BSF at 104.6 Hz, nearer than slip of 2 % may move
    /// either.
    #[test]
    fn planted_one_line_is_claimed_for_one_family() {
        let families = vec![found(Defect::Bpfo, 106.328, 106.163), found(Defect::Bsf, 52.304, 53.081)];
        let families = decide(shared_out(families, 1.25, true), Around::default(), None, true);
        assert!(families[0].claimed && !families[1].claimed, "{families:?}");
        assert!(
            families[1].reason.to_string().contains("those of BPFO, which are nearer"),
            "{}",
            families[1].reason
        );
        // A cage that slips takes BPFO to where the element would be; only a turn of the cage makes it one.
        for (modulated, claimed) in [(true, Defect::Bsf), (false, Defect::Bpfo)] {
            let families = vec![found(Defect::Bpfo, 106.328, 105.153), found(Defect::Bsf, 52.304, 52.576)];
            let families = decide(shared_out(families, 1.25, modulated), Around::default(), None, modulated);
            let names: Vec<Defect> = families.iter().filter(|f| f.claimed).map(|f| f.name).collect();
            assert_eq!(names, [claimed], "{families:?}");
        }
        // Diameters of 1 to 5 put twice BSF on BPFO: whatever is measured, the record does not decide.
        for measured_hz in [94.404, 96.3] {
            let mut families = vec![
                found(Defect::Bpfo, 96.0048, measured_hz),
                found(Defect::Bsf, 48.0104, 0.5 * measured_hz + 0.02),
            ];
            families[0].height_db = 24.9;
            let families = decide(shared_out(families, 1.0, true), Around::default(), None, true);
            let verdict = conclude(&families, None, Told::of(&Conclusion::default()));
            assert!(families.iter().all(|family| family.claimed), "{families:?}");
            assert!(verdict.contains("of the outer raceway or of a rolling element"), "{verdict}");
            assert!(verdict.contains("2 times BSF") && !verdict.contains(" and a defect"), "{verdict}");
            // Without the cage in them, they are the raceway's.
            let families = vec![
                found(Defect::Bpfo, 96.0048, measured_hz),
                found(Defect::Bsf, 48.0104, 0.5 * measured_hz),
            ];
            let families = decide(shared_out(families, 1.0, false), Around::default(), None, false);
            assert!(families[0].claimed && !families[1].claimed, "{families:?}");
        }
        // Lines of their own are not shared.
        let apart = vec![found(Defect::Bpfo, 106.328, 106.163), found(Defect::Bsf, 52.304, 52.2)];
        let apart = shared_out(apart, 1.25, true);
        assert!(apart.iter().all(|family| family.reason == Reason::Undecided), "{apart:?}");
    }
}
