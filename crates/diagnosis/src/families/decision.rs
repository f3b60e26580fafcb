//! Which of the families that are there are called a defect.

use stribeck_dsp::BandEnvelope;

use crate::families::controls::MOST_AS_HIGH;
use crate::families::family::{Family, Reason};
use crate::families::limits::{ALPHA, KNOCK};
use crate::families::unexplained::Unexplained;
use crate::families::unrelated::is_the_same;
use crate::words::sentence::probability;
use crate::{Defect, families::element_rhythm};

/// Lines that two families both take for theirs belong to the one that is nearer to its place; to no rolling
/// element, unless the cage modulates them (`modulated`). Where both are expected within a resolution of each
/// other, they are not distinguished.
pub(crate) fn share_out(families: &mut [Family], resolution_hz: f64, modulated: bool) {
    let cannot_be = |family: &Family| family.name == Defect::Bsf && !modulated;
    let comb = |family: &Family| {
        Some((
            family.name.shocks_per_period() * family.measured_hz?,
            (family.measured_hz? / family.expected_hz - 1.0).abs(),
        ))
    };
    let combs: Vec<Option<(f64, f64)>> = families.iter().map(comb).collect();
    let places: Vec<f64> =
        families.iter().map(|family| family.name.shocks_per_period() * family.expected_hz).collect();
    for (at, own) in combs.iter().enumerate() {
        let Some((hz, off)) = own else { continue };
        let shares =
            |other: &Option<(f64, f64)>| other.is_some_and(|(there, _)| (there - hz).abs() < resolution_hz);
        let alike = |n: usize| {
            let told = [at, n].iter().any(|of| cannot_be(&families[*of]));
            n != at && shares(&combs[n]) && (places[n] - places[at]).abs() < resolution_hz && !told
        };
        if let Some(other) = (0..families.len()).find(|n| alike(*n)) {
            families[at].not_told_apart_from = Some(families[other].name);
            families[at].height_db = families[at].height_db.max(families[other].height_db);
            continue;
        }
        let other = combs.iter().enumerate().find_map(|(n, other)| {
            let (_, less) = (*other).filter(|_| n != at && shares(other))?;
            let gives_way = match [at, n].map(|n| cannot_be(&families[n])) {
                [false, false] => less < *off,
                [gives_way, _] => gives_way,
            };
            gives_way.then_some(n)
        });
        let Some(other) = other else { continue };
        let why = if cannot_be(&families[at]) {
            "and they are not modulated by the cage, as it is where a spot on a rolling element comes \
             under the load"
        } else {
            "which are nearer to their place"
        };
        families[at].reason =
            Reason::Decided(format!("its lines are those of {}, {why}", families[other].name));
    }
}

/// The defect that stands for itself, but for the cage: its place and its comb [Hz].
pub(crate) fn claimed_first(families: &[Family]) -> Option<(usize, f64)> {
    let at = families.iter().position(|f| f.claimed && f.name != Defect::Ftf)?;
    Some((at, families[at].name.shocks_per_period() * families[at].measured_hz?))
}

/// The family that knocks and stands highest, but for the cage's and those whose lines are another's.
pub(crate) fn first<'a>(families: impl Iterator<Item = &'a Family>) -> Option<usize> {
    let knocking = families
        .enumerate()
        .filter(|(_, f)| f.name != Defect::Ftf && f.reason == Reason::Undecided && f.knocks());
    knocking.max_by(|a, b| a.1.height_db.total_cmp(&b.1.height_db)).map(|(at, _)| at)
}

/// Which of the families that are there are defects.
pub(crate) fn decide(families: &mut [Family], unexplained: Option<&Unexplained>, modulated: bool) {
    // Every family of rolling defects is modulated by the cage, so the cage is suspected last. A family that
    // stands lower than another is not the first, even if the other one is not believed.
    let first_db = first(families.iter()).map_or(f64::NEG_INFINITY, |at| families[at].height_db);
    for family in families.iter_mut().filter(|f| f.reason == Reason::Undecided) {
        let (p, depth, rank) =
            (family.noise_p_value, family.depth.unwrap_or(0.0), family.rank.unwrap_or(1.0));
        let why = if p >= ALPHA {
            format!("noise of this colour makes as much with a probability of {}", probability(p))
        } else if rank > MOST_AS_HIGH {
            format!("{:.0} % of unrelated combs in this record stand as high", 100.0 * rank)
        } else if depth < KNOCK {
            format!(
                "it is there, but the power of the band swings by {:.0} % only, as sound bearings do",
                100.0 * depth
            )
        } else if family.p_value >= ALPHA {
            format!(
                "it is there, but sound bearings show as much with a probability of {}",
                probability(family.p_value)
            )
        } else if let Some(other) = unexplained.filter(|other| other.height_db > family.height_db) {
            format!(
                "it is there, but a comb at {:.3} times the shaft that is no family of this bearing stands \
                 higher",
                other.order
            )
        } else if let Some(other) = unexplained.filter(|_| family.name == Defect::Ftf) {
            format!(
                "it is there, as the cage's share in a comb at {:.3} times the shaft that is no family of \
                 this bearing",
                other.order
            )
        } else if family.name == Defect::Bsf && !modulated {
            "it is there, and no turn of the cage is in it, as it is where a spot on a rolling element comes \
             under the load"
                .to_owned()
        } else if first_db.is_finite() && family.name == Defect::Ftf {
            "it is there, as the cage's share in a family that stands for itself".to_owned()
        } else if family.height_db < first_db {
            "it is there, but another family stands higher, of which it may be sidebands".to_owned()
        } else {
            family.claimed = true;
            if family.name == Defect::Ftf {
                // One element that is damaged comes under the load once a turn of the cage, too.
                family.not_told_apart_from = Some(Defect::Bsf);
            }
            let raceway = family.not_told_apart_from.filter(|_| family.name != Defect::Ftf);
            let other = raceway.map_or(String::new(), |name| {
                format!(
                    "; the lines of {name} have their places within a resolution of these, and the \
                    record does not tell which it is"
                )
            });
            format!("{} harmonics stand, the power swings by {:.0} %{other}", family.harmonics, 100.0 * depth)
        };
        family.reason = Reason::Decided(why);
    }
}

/// Where something knocks once a turn of the cage and no family of a raceway stands at its place, names a
/// rolling element that knocks twice a spin, by the whole range or by the band in which the cage stands
/// highest.
pub(crate) fn name_the_element(families: &mut [Family], bands: &[BandEnvelope]) {
    let place = |name: Defect| families.iter().position(|family| family.name == name);
    let (Some(element), Some(cage)) = (place(Defect::Bsf), place(Defect::Ftf)) else { return };
    // A spot on a rolling element meets both raceways in a turn.
    let knocks_hz = 2.0 * families[element].expected_hz;
    let is_taken = families.iter().any(|f| f.is_there() && is_the_same(f.expected_hz, knocks_hz));
    if !families[cage].claimed || is_taken {
        return;
    }
    let loudest = |band: &&BandEnvelope| families[cage].band_hz == Some((band.low_hz, band.high_hz));
    let asked = [bands.first(), bands.iter().find(loudest)];
    let told = asked.into_iter().flatten().find_map(|band| {
        let hz = element_rhythm::repeating_hz(band, knocks_hz)?;
        Some(((band.low_hz, band.high_hz), hz))
    });
    let Some((band_hz, hz)) = told else { return };
    let family = &mut families[element];
    family.measured_hz = Some(0.5 * hz);
    family.band_hz = Some(band_hz);
    family.in_passages = true;
    family.claimed = true;
    family.reason = Reason::Decided(format!(
        "something knocks once a turn of the cage, and as it passes at {hz:.1} Hz, twice the spin of an \
         element, which no unrelated rhythm does as much; from turn to turn it loses its phase, so that it \
         has no lines"
    ));
    let cage = &mut families[cage];
    cage.claimed = false;
    cage.not_told_apart_from = None;
    cage.reason =
        "it is there, as the rhythm in which one rolling element passes under the load".to_owned().into();
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::words::sentence::conclude;

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
        let mut families = [found(Defect::Bpfo, 106.328, 106.163), found(Defect::Bsf, 52.304, 53.081)];
        share_out(&mut families, 1.25, true);
        decide(&mut families, None, true);
        assert!(families[0].claimed && !families[1].claimed, "{families:?}");
        assert!(
            families[1].reason.to_string().contains("those of BPFO, which are nearer"),
            "{}",
            families[1].reason
        );
        // A cage that slips takes BPFO to where the element would be; only a turn of the cage makes it one.
        for (modulated, claimed) in [(true, Defect::Bsf), (false, Defect::Bpfo)] {
            let mut families = [found(Defect::Bpfo, 106.328, 105.153), found(Defect::Bsf, 52.304, 52.576)];
            share_out(&mut families, 1.25, modulated);
            decide(&mut families, None, modulated);
            let names: Vec<Defect> = families.iter().filter(|f| f.claimed).map(|f| f.name).collect();
            assert_eq!(names, [claimed], "{families:?}");
        }
        // Diameters of 1 to 5 put twice BSF on BPFO: whatever is measured, the record does not decide.
        for measured_hz in [94.404, 96.3] {
            let mut families = [
                found(Defect::Bpfo, 96.0048, measured_hz),
                found(Defect::Bsf, 48.0104, 0.5 * measured_hz + 0.02),
            ];
            families[0].height_db = 24.9;
            share_out(&mut families, 1.0, true);
            decide(&mut families, None, true);
            let verdict = conclude(&families, None);
            assert!(families.iter().all(|family| family.claimed), "{families:?}");
            assert!(verdict.contains("of the outer raceway or of a rolling element"), "{verdict}");
            assert!(verdict.contains("2 times BSF") && !verdict.contains(" and a defect"), "{verdict}");
            // Without the cage in them, they are the raceway's.
            let mut families =
                [found(Defect::Bpfo, 96.0048, measured_hz), found(Defect::Bsf, 48.0104, 0.5 * measured_hz)];
            share_out(&mut families, 1.0, false);
            decide(&mut families, None, false);
            assert!(families[0].claimed && !families[1].claimed, "{families:?}");
        }
        // Lines of their own are not shared.
        let mut apart = [found(Defect::Bpfo, 106.328, 106.163), found(Defect::Bsf, 52.304, 52.2)];
        share_out(&mut apart, 1.25, true);
        assert!(apart.iter().all(|family| family.reason == Reason::Undecided), "{apart:?}");
    }
}
