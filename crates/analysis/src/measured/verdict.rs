//! Which defect families a record holds, and which of them may be called a defect.
//!
//! Three questions, all of which must be answered with yes (THEORY §7.9):
//!
//! 1. Is it more than noise? The comb test of [`stribeck_dsp::CombTest`] over all bands, with the probability
//!    of a false alarm under noise of the record's own colour.
//! 2. Is it more than the record's other lines? Machines are full of lines; the family must stand higher than
//!    combs of unrelated fundamentals in the same spectrum.
//! 3. Is it a knock? Sound bearings modulate noise a little as their elements pass under the load. The power
//!    of a band must swing by 60 % of its mean.
//!
//! The highest that passes is claimed; `second.rs` looks for a second defect beside it. Multiples of the
//! shaft and of the cage are nobody's defect (`own.rs`), and where a comb that is no family's stands higher
//! than all that are, nothing weaker is claimed (`unexplained.rs`).

use std::fmt;

use serde::{Serialize, Serializer};
use stribeck_dsp::{BandEnvelope, Comb, CombTest, Whitened};

use super::limits::{ALPHA, KNOCK, decibel};
use super::own::OwnLines;
use super::unexplained::{self, Known, Unexplained};
use super::unrelated::{SLIP, is_the_same, unrelated_hz};
use super::{Defect, HIGHEST_HZ, LOWEST, Machine, passage};

/// One defect family.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Family {
    /// Whose family it is.
    pub name: Defect,
    /// Frequency without slip [Hz].
    pub expected_hz: f64,
    /// Frequency at which the family stands highest [Hz]; `null` when it is not there.
    pub measured_hz: Option<f64>,
    /// Harmonics of five that noise would not make.
    pub harmonics: usize,
    /// Height of its first harmonic above the background of the envelope spectrum [dB].
    pub level_db: Option<f64>,
    /// Probability that the record of a sound bearing shows a family as high and as deep: the largest of
    /// `noise_p_value`, of `rank`, and of the part of sound bearings whose power swings as much at a family.
    pub p_value: f64,
    /// Probability that noise of the record's own colour makes a family as high; an upper bound.
    pub noise_p_value: f64,
    /// Part of unrelated combs in the same spectrum that stand as high.
    pub rank: Option<f64>,
    /// How deep the power is modulated in the band where it is deepest, of those in which the family stands:
    /// 0 not at all, 1 to zero, 2 short knocks. That of a rolling element counts its sidebands of the cage.
    pub depth: Option<f64>,
    /// That band [Hz].
    pub depth_band_hz: Option<(f64, f64)>,
    /// Band in which it stands highest [Hz].
    pub band_hz: Option<(f64, f64)>,
    /// Whether its knocks keep their phase while an element passes under the load only, so that it has no
    /// lines ([`BandEnvelope::autocorrelation`]).
    pub in_passages: bool,
    /// The family that stands higher, over whose period everything that is said of this one is taken
    /// ([`BandEnvelopes::over_period`](stribeck_dsp::BandEnvelopes::over_period)).
    pub over: Option<Defect>,
    /// The family whose lines stand at the same places, so that the record cannot distinguish them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub not_told_apart_from: Option<Defect>,
    /// Whether this is called a defect.
    pub claimed: bool,
    /// Why, or why not.
    pub reason: Reason,
    /// Height of the family [dB], for comparison with others.
    #[serde(skip)]
    height_db: f64,
    /// The unrelated combs of the same spectrum that it must stand above: fundamental [Hz] and height [dB];
    /// for pictures.
    #[serde(skip)]
    pub controls: Vec<(f64, f64)>,
}

/// Why a family is called a defect, or not; text in files.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Reason {
    /// It has not been judged yet.
    Undecided,
    /// In words.
    Decided(String),
}

impl fmt::Display for Reason {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Undecided => Ok(()),
            Self::Decided(why) => out.write_str(why),
        }
    }
}

impl Serialize for Reason {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl From<String> for Reason {
    fn from(why: String) -> Self {
        Self::Decided(why)
    }
}

/// Families and conclusion.
pub(super) struct Verdicts {
    pub(super) families: Vec<Family>,
    pub(super) verdict: String,
    pub(super) notes: Vec<String>,
    /// The defect that stands highest, if there is one.
    pub(super) first: Option<First>,
    /// A comb that is no family's and stands higher.
    pub(super) unexplained: Option<Unexplained>,
}

/// The first defect, as the search for a second one needs it.
pub(super) struct First {
    /// Its place among the families.
    pub(super) at: usize,
    /// Its comb [Hz].
    pub(super) comb_hz: f64,
    /// Turns of the shaft [Hz], whose lines are left where it modulates the first family.
    pub(super) shaft_hz: f64,
    /// Turns of the cage without slip [Hz].
    pub(super) cage_hz: f64,
    /// One over the length of a segment [Hz].
    pub(super) resolution_hz: f64,
}

/// Largest part of unrelated combs that may stand as high.
pub(super) const MOST_AS_HIGH: f64 = 0.1;
/// Families of sound bearings are deeper than d in a part exp(−d times this) of all: fitted to the 108 of the
/// same records.
const SOUND_DEPTHS: f64 = 11.4;
/// Periods that a segment must hold.
const PERIODS: f64 = 10.0;
/// Lines about a multiple of the shaft or the cage that are its own: half the width of a Hann window’s lobe.
const OWN_LINES: f64 = 1.5;
/// Least and largest part by which a cage that skids is slower than rolling without slip.
const SKID: (f64, f64) = (SLIP, 0.06);

/// What is known of the speed beside that of the machine.
pub(super) struct KnownSpeed {
    /// The speed by the lines of the record, which places multiples of the shaft better than one that is
    /// given [Hz].
    pub(super) sharp_hz: Option<f64>,
    /// The lines of the shaft stand at the speed of the machine, so that only slip can move a family.
    pub(super) by_its_lines: bool,
}

/// The families, of which one at most is claimed; [`Verdicts::conclude`] says the rest.
pub(super) fn judge(
    bands: &[BandEnvelope],
    machine: &Machine,
    known: &KnownSpeed,
    record_s: f64,
    segment_s: f64,
) -> Verdicts {
    let mut notes = Vec::new();
    let nothing = |notes: Vec<String>| {
        let verdict = "No verdict: speed and bearing are needed to say where a defect would show.".to_owned();
        Verdicts { families: Vec::new(), verdict, notes, first: None, unexplained: None }
    };
    let Some(bearing) = &machine.bearing else {
        notes.push("no bearing was given: `--bearing \"6205\"`, or its numbers".to_owned());
        return nothing(notes);
    };
    let Some(shaft_hz) = machine.speed_rpm.map(|rpm| rpm / 60.0).filter(|hz| *hz > 0.0 && hz.is_finite())
    else {
        notes.push(
            "no speed was given: `--speed-rpm`, or `--tacho` with the channel of a tachometer".to_owned(),
        );
        return nothing(notes);
    };
    let orders = match bearing.orders() {
        Ok(orders) => orders,
        Err(why) => {
            notes.push(why);
            return nothing(notes);
        }
    };
    // A band without noise (a simulated record, a filter) has no background to stand above.
    let whitened: Vec<(&BandEnvelope, Whitened)> = bands
        .iter()
        .filter_map(|b| Some((b, Whitened::new(&b.values, b.grid_hz, b.segments).ok()?)))
        .collect();
    // Load and sensor stand still, so the cage's frequency is that of its rotation in space.
    let cage_hz = (orders.ftf * shaft_hz + machine.outer_speed_rpm / 60.0).abs();
    let width_hz = OWN_LINES / segment_s;
    let sharp_hz = known.sharp_hz.unwrap_or(shaft_hz);
    let around = &machine.around;
    let in_hz = |orders: &[f64]| orders.iter().map(|order| order * sharp_hz).collect();
    let mut own = OwnLines {
        shaft_hz: sharp_hz,
        cage_hz: None,
        elements: f64::from(bearing.elements.unwrap_or(0)),
        width_hz,
        shafts_hz: in_hz(&around.shafts),
        meshes_hz: in_hz(&around.meshes),
    };
    let places = [orders.bpfo * shaft_hz, orders.bpfi * shaft_hz, orders.bsf * shaft_hz, cage_hz];
    let cage = look(Defect::Ftf, cage_hz, &whitened, None, record_s, segment_s);
    own.cage_hz = cage.1.as_ref().filter(|_| cage.0.noise_p_value < ALPHA).map(|s| s.comb.fundamental_hz);
    let mut looked: Vec<(Family, Option<Standing>)> = Defect::ALL[..3]
        .iter()
        .zip(places)
        .map(|(name, hz)| look(*name, hz, &whitened, Some(&own), record_s, segment_s))
        .collect();
    looked.push(cage);
    let cage_hz = own.cage_hz.unwrap_or(cage_hz);
    for (family, standing) in &mut looked {
        if let Some(standing) = standing {
            deepen(family, standing, &whitened, cage_hz);
        }
    }
    let highest_hz = places[..2].iter().fold(0.0_f64, |most, hz| most.max(*hz));
    let there: Vec<Known> = looked[..3]
        .iter()
        .filter(|(family, _)| family.noise_p_value < ALPHA)
        .filter_map(|(_, standing)| {
            let comb = &standing.as_ref()?.comb;
            Some(Known { comb_hz: comb.fundamental_hz, height: comb.height })
        })
        .collect();
    let of_others = |hz: f64| around.may_be(hz / shaft_hz);
    let stranger = unexplained::strongest(&whitened, &own, cage_hz, highest_hz, &there, &of_others);
    let first = first(looked.iter().map(|(family, _)| family));
    let first_db = first.map_or(f64::NEG_INFINITY, |at| looked[at].0.height_db);
    let first_hz = first.and_then(|at| Some(looked[at].1.as_ref()?.comb.fundamental_hz));
    let mut families: Vec<Family> = looked
        .into_iter()
        .map(|(mut family, standing)| {
            if let Some(Standing { band, comb, comb_hz, times, .. }) = standing {
                let controls = controls(&comb, comb_hz, &whitened[band].1, first_hz, Some(&own));
                family.rank = part_as_high(&comb, &controls);
                family.controls = controls.iter().map(|c| (c.fundamental_hz, decibel(c.height))).collect();
                if family.is_there() {
                    family.measured_hz = Some(comb.fundamental_hz / times);
                }
            }
            family.calibrate();
            family
        })
        .collect();
    let modulated = is_modulated_by_the_cage(&families, &whitened);
    share_out(&mut families, 1.0 / segment_s, modulated);
    let higher = stranger.filter(|s| decibel(s.comb.height) > first_db);
    let mut unexplained = None;
    if let Some(found) = higher {
        let skids = known.by_its_lines.then(|| skidding(&families, &found)).flatten();
        match skids {
            Some(at) => {
                let rank =
                    rank(&found.comb, found.comb.fundamental_hz, &whitened[found.band].1, None, Some(&own));
                let band = whitened[found.band].0;
                families[at].take(&found, rank, (band.low_hz, band.high_hz));
                notes.push(format!(
                    "{} stands {:+.1} % from its place, farther than rolling without slip allows: beside the \
                     speed that the lines of the shaft tell, the cage skids, as it does under little load",
                    families[at].name,
                    100.0
                        * (found.comb.fundamental_hz
                            / (families[at].name.shocks_per_period() * families[at].expected_hz)
                            - 1.0)
                ));
            }
            None => unexplained = Some(found.report(shaft_hz)),
        }
    }
    decide(&mut families, unexplained.as_ref(), modulated);
    let first = claimed_first(&families).map(|(at, comb_hz)| First {
        at,
        comb_hz,
        shaft_hz,
        cage_hz,
        resolution_hz: 1.0 / segment_s,
    });
    Verdicts { families, verdict: String::new(), notes, first, unexplained }
}

impl Verdicts {
    /// The verdict over all families; `bands` are those that were judged.
    pub(super) fn conclude(&mut self, bands: &[BandEnvelope]) {
        if !self.families.is_empty() {
            tell_the_element(&mut self.families, bands);
            self.verdict = conclude(&self.families, self.unexplained.as_ref());
        }
    }
}

/// Where a family stands highest.
struct Standing {
    /// Number of the band.
    band: usize,
    comb: Comb,
    /// Fundamental without slip [Hz].
    comb_hz: f64,
    /// The same over the frequency of the name.
    times: f64,
    /// Bands that were searched.
    searched: f64,
}

/// Looks for one family in all bands.
fn look(
    name: Defect,
    expected_hz: f64,
    bands: &[(&BandEnvelope, Whitened)],
    own: Option<&OwnLines>,
    record_s: f64,
    segment_s: f64,
) -> (Family, Option<Standing>) {
    let times = name.shocks_per_period();
    let comb_hz = times * expected_hz;
    let mut family = Family {
        name,
        expected_hz,
        measured_hz: None,
        harmonics: 0,
        level_db: None,
        p_value: 1.0,
        noise_p_value: 1.0,
        rank: None,
        depth: None,
        depth_band_hz: None,
        band_hz: None,
        in_passages: false,
        over: None,
        not_told_apart_from: None,
        claimed: false,
        reason: Reason::Undecided,
        height_db: f64::NEG_INFINITY,
        controls: Vec::new(),
    };
    if segment_s * comb_hz < PERIODS {
        family.reason = Reason::Decided(format!(
            "the record of {record_s:.2} s holds {:.1} periods; {:.1} s would hold the ten that are needed",
            record_s * comb_hz,
            PERIODS / comb_hz
        ));
        return (family, None);
    }
    let (low, high) = ((1.0 - SLIP) * comb_hz, (1.0 + SLIP) * comb_hz);
    let ranges = own.map_or_else(|| vec![(low, high)], |own| own.ranges_without(low, high));
    if ranges.is_empty() {
        family.reason = Reason::Decided(
            "its place is within a resolution of a multiple of the shaft or the cage; a longer record would \
             tell them apart"
                .to_owned(),
        );
        return (family, None);
    }
    let found: Vec<(usize, Comb)> = bands
        .iter()
        .enumerate()
        .flat_map(|(n, band)| ranges.iter().map(move |range| (n, band, *range)))
        .filter_map(|(n, (_, spectrum), (low, high))| {
            Some((n, CombTest::FOUR_OF_FIVE.search(spectrum, low, high).ok()?))
        })
        .collect();
    let searched = found.len() as f64;
    let Some((n, comb)) = found.into_iter().max_by(|a, b| a.1.height.total_cmp(&b.1.height)) else {
        family.reason = Reason::Decided(too_narrow(comb_hz, !bands.is_empty()));
        return (family, None);
    };
    let (band, spectrum) = &bands[n];
    family.noise_p_value = (comb.p_value * searched).min(1.0);
    family.band_hz = Some((band.low_hz, band.high_hz));
    family.height_db = decibel(comb.height);
    family.level_db = Some(decibel(comb.ratios[0]));
    family.harmonics = comb.ratios.iter().filter(|r| spectrum.line_p_value(**r) < ALPHA).count();
    family.depth = Some(band.depth(comb.fundamental_hz));
    family.depth_band_hz = family.band_hz;
    (family, Some(Standing { band: n, comb, comb_hz, times, searched }))
}

/// The depth of a family in the band where it is deepest, of those in which its comb stands; that of a
/// rolling element with its sidebands of the cage.
fn deepen(family: &mut Family, standing: &Standing, bands: &[(&BandEnvelope, Whitened)], cage_hz: f64) {
    let hz = standing.comb.fundamental_hz;
    for (band, spectrum) in bands {
        let near = CombTest::FOUR_OF_FIVE.search(spectrum, hz - 0.5 * band.grid_hz, hz + 0.5 * band.grid_hz);
        let stands = near.is_ok_and(|comb| comb.p_value * standing.searched < ALPHA);
        let depth = depth_of(family.name, band, hz, cage_hz);
        if stands && family.depth.is_none_or(|deepest| depth > deepest) {
            family.depth = Some(depth);
            family.depth_band_hz = Some((band.low_hz, band.high_hz));
        }
    }
}

/// Depth of the modulation at a comb; the power of an element's knocks is in the sidebands of the cage, too.
fn depth_of(name: Defect, band: &BandEnvelope, comb_hz: f64, cage_hz: f64) -> f64 {
    const BESIDE: i32 = 2;
    if name != Defect::Bsf {
        return band.depth(comb_hz);
    }
    let lines = (-BESIDE..=BESIDE).map(|k| band.depth(comb_hz + f64::from(k) * cage_hz).powi(2));
    lines.sum::<f64>().sqrt()
}

/// The raceway whose family a comb would be if the cage skids: slower, so that the outer raceway’s comes down
/// and the inner one’s goes up by what that takes.
fn skidding(families: &[Family], found: &unexplained::Found) -> Option<usize> {
    let place = |name: Defect| families.iter().find(|f| f.name == name).map(|f| f.expected_hz);
    let (outer_hz, inner_hz) = (place(Defect::Bpfo)?, place(Defect::Bpfi)?);
    let hz = found.comb.fundamental_hz;
    let slower = |by_hz: f64| (SKID.0..=SKID.1).contains(&(by_hz / outer_hz));
    if slower(outer_hz - hz) {
        families.iter().position(|f| f.name == Defect::Bpfo)
    } else if slower(hz - inner_hz) {
        families.iter().position(|f| f.name == Defect::Bpfi)
    } else {
        None
    }
}

/// Why no band holds a comb, and which sample rate would suffice.
fn too_narrow(comb_hz: f64, any: bool) -> String {
    let harmonics = CombTest::FOUR_OF_FIVE.needed;
    let highest_hz = harmonics as f64 * (1.0 + SLIP) * comb_hz;
    // The widest band, with a hundredth to spare for its last lines, in tens of hertz.
    let rate_hz = 10.0 * (0.1 * 1.01 * 2.0 * highest_hz / (1.0 - LOWEST)).ceil();
    if !any {
        return "no band holds noise that lines could stand above".to_owned();
    }
    let advice = if highest_hz > HIGHEST_HZ {
        format!("spectra end at {HIGHEST_HZ:.0} Hz, whatever the rate: run the machine slower")
    } else {
        format!("sample at {rate_hz:.0} Hz or faster")
    };
    format!("no band is wide enough for {harmonics} harmonics of {comb_hz:.1} Hz: {advice}")
}

/// Part of the unrelated combs that stand as high as this one; `None` when none can be tried.
pub(super) fn rank(
    comb: &Comb,
    comb_hz: f64,
    spectrum: &Whitened,
    first_hz: Option<f64>,
    own: Option<&OwnLines>,
) -> Option<f64> {
    part_as_high(comb, &controls(comb, comb_hz, spectrum, first_hz, own))
}

fn part_as_high(comb: &Comb, controls: &[Comb]) -> Option<f64> {
    let as_high = controls.iter().filter(|control| control.height >= comb.height).count();
    (!controls.is_empty()).then(|| as_high as f64 / controls.len() as f64)
}

/// The highest combs about fundamentals that are unrelated to a comb's, which share what is not the bearing's
/// with it. Those of the `first` family [Hz], of the machine itself (`own`) and sidebands of this one are
/// none of them, and one that is found from several sides is one.
fn controls(
    comb: &Comb,
    comb_hz: f64,
    spectrum: &Whitened,
    first_hz: Option<f64>,
    own: Option<&OwnLines>,
) -> Vec<Comb> {
    let width_hz = 1.5 * spectrum.grid_hz();
    let of_the_first = |hz: f64| first_hz.is_some_and(|first_hz| is_the_same(hz, first_hz));
    let beside = |hz: f64| {
        let spacings = own.iter().flat_map(|own| [Some(own.shaft_hz), own.cage_hz]).flatten();
        let mut sidebands =
            spacings.flat_map(|spacing| [-2.0, -1.0, 1.0, 2.0].map(|k| comb.fundamental_hz + k * spacing));
        sidebands.any(|sideband| (hz - sideband).abs() < width_hz)
    };
    let mut found: Vec<Comb> = unrelated_hz(comb_hz)
        .filter(|hz| !of_the_first(*hz))
        .filter_map(|hz| CombTest::FOUR_OF_FIVE.search(spectrum, (1.0 - SLIP) * hz, (1.0 + SLIP) * hz).ok())
        .filter(|control| own.is_none_or(|own| !own.holds(control.fundamental_hz)))
        .filter(|control| !beside(control.fundamental_hz))
        .collect();
    found.sort_by(|a, b| a.fundamental_hz.total_cmp(&b.fundamental_hz));
    found.dedup_by(|a, b| (a.fundamental_hz - b.fundamental_hz).abs() < width_hz);
    found
}

/// Harmonics whose sidebands are looked for, and how many of both sides of all make a family modulated.
const HARMONICS: usize = 3;
const MODULATED: usize = 3;

/// Number of sidebands above the noise, of the six beside the first three harmonics of a family.
pub(crate) fn sidebands_seen(spectrum: &Whitened, fundamental_hz: f64, spacing_hz: f64) -> usize {
    let beside =
        (1..=HARMONICS).flat_map(|n| [-1.0, 1.0].map(|side| n as f64 * fundamental_hz + side * spacing_hz));
    beside.filter(|hz| spectrum.line_p_value(spectrum.at(*hz)) < ALPHA).count()
}

/// Whether the shocks at twice BSF are modulated at the cage's frequency, as those of a spot on a rolling
/// element must be.
fn is_modulated_by_the_cage(families: &[Family], bands: &[(&BandEnvelope, Whitened)]) -> bool {
    let of = |name: Defect| families.iter().find(|family| family.name == name);
    let (Some(element), Some(cage)) = (of(Defect::Bsf), of(Defect::Ftf)) else { return false };
    let Some(hz) = element.measured_hz else { return false };
    let band = bands.iter().find(|(band, _)| element.band_hz == Some((band.low_hz, band.high_hz)));
    let spacing_hz = cage.measured_hz.unwrap_or(cage.expected_hz);
    band.is_some_and(|(_, spectrum)| is_modulated(spectrum, 2.0 * hz, spacing_hz))
}

/// Spacings of sidebands over that of the cage at which no part of a bearing has any.
const UNRELATED_SPACINGS: [f64; 8] = [0.6, 0.7, 0.8, 0.9, 1.1, 1.2, 1.3, 1.4];
/// Lines by which sidebands of two spacings must differ to be others.
const OTHER_LINES: f64 = 2.0;

/// Whether a comb has sidebands at a spacing [Hz], and more of them than at any unrelated one: beside a comb
/// that is another part's, lines stand at any.
pub(super) fn is_modulated(spectrum: &Whitened, comb_hz: f64, spacing_hz: f64) -> bool {
    let seen = sidebands_seen(spectrum, comb_hz, spacing_hz);
    let mut others = UNRELATED_SPACINGS
        .iter()
        .filter(|part| (*part - 1.0).abs() * spacing_hz > OTHER_LINES * spectrum.grid_hz());
    seen >= MODULATED && others.all(|part| sidebands_seen(spectrum, comb_hz, part * spacing_hz) < seen)
}

/// Lines that two families both take for theirs belong to the one that is nearer to its place; to no rolling
/// element, unless the cage modulates them (`modulated`). Where both have their places within a resolution,
/// neither is told from the other.
fn share_out(families: &mut [Family], resolution_hz: f64, modulated: bool) {
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
            "and no turn of the cage is heard in them, as it is where a spot on a rolling element comes \
             under the load"
        } else {
            "which are nearer to their place"
        };
        families[at].reason =
            Reason::Decided(format!("its lines are those of {}, {why}", families[other].name));
    }
}

/// The defect that stands for itself, but for the cage: its place and its comb [Hz].
fn claimed_first(families: &[Family]) -> Option<(usize, f64)> {
    let at = families.iter().position(|f| f.claimed && f.name != Defect::Ftf)?;
    Some((at, families[at].name.shocks_per_period() * families[at].measured_hz?))
}

/// The family that knocks and stands highest, but for the cage's and those whose lines are another's.
fn first<'a>(families: impl Iterator<Item = &'a Family>) -> Option<usize> {
    let knocking = families
        .enumerate()
        .filter(|(_, f)| f.name != Defect::Ftf && f.reason == Reason::Undecided && f.knocks());
    knocking.max_by(|a, b| a.1.height_db.total_cmp(&b.1.height_db)).map(|(at, _)| at)
}

/// Which of the families that are there are defects.
fn decide(families: &mut [Family], unexplained: Option<&Unexplained>, modulated: bool) {
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
fn tell_the_element(families: &mut [Family], bands: &[BandEnvelope]) {
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
        let hz = passage::rhythm(band, knocks_hz)?;
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
         element, which no unrelated rhythm \
         does as much; from turn to turn it loses its phase, so that it has no lines"
    ));
    let cage = &mut families[cage];
    cage.claimed = false;
    cage.not_told_apart_from = None;
    cage.reason =
        "it is there, as the rhythm in which one rolling element passes under the load".to_owned().into();
}

/// The verdict in words.
pub(super) fn conclude(families: &[Family], unexplained: Option<&Unexplained>) -> String {
    // Two families that cannot be distinguished are reported under the name of the first.
    let spoken_for = |at: usize, family: &Family| {
        families[..at].iter().any(|f| f.claimed && f.not_told_apart_from == Some(family.name))
    };
    let claimed: Vec<String> = families
        .iter()
        .enumerate()
        .filter(|(at, f)| f.claimed && !spoken_for(*at, f))
        .map(|(_, f)| {
            let hz = f.measured_hz.unwrap_or(f.expected_hz);
            let off = 100.0 * (hz / f.expected_hz - 1.0);
            let other = families.iter().find(|other| f.not_told_apart_from == Some(other.name));
            match other {
                Some(_) if f.name == Defect::Ftf => format!(
                    "a defect of the cage or of one rolling element, which it does not tell apart (something \
                     knocks once a turn of the cage, {} at {hz:.2} Hz, {off:+.1} % from its place)",
                    f.name
                ),
                None => format!(
                    "a defect of {} ({} at {hz:.2} Hz, {off:+.1} % from its \
                    place)",
                    f.name.part(),
                    f.name
                ),
                Some(other) => format!(
                    "a defect of {} or of {}, which it does not tell apart ({} at {hz:.2} Hz, {off:+.1} % \
                     from its place, and {} times {} \
                     stand within a resolution)",
                    f.name.part(),
                    other.name.part(),
                    f.name,
                    other.name.shocks_per_period() / f.name.shocks_per_period(),
                    other.name
                ),
            }
        })
        .collect();
    if !claimed.is_empty() {
        return format!("The record shows {}.", claimed.join(" and "));
    }
    if let Some(other) = unexplained {
        return format!(
            "The record knocks at {:.2} Hz, {:.3} times the shaft, which is no family of this bearing: slip, \
             speed or bearing is not what was given, or another part of the machine knocks.",
            other.hz, other.order
        );
    }
    let highest = families.iter().filter(|f| f.knocks()).max_by(|a, b| a.height_db.total_cmp(&b.height_db));
    if let Some(highest) = highest {
        return format!(
            "The record knocks, and does not say where: {} stands highest, but unrelated combs stand as \
             high. A longer record, or one \
             nearer to the bearing, may tell.",
            highest.name
        );
    }
    let weak: Vec<&str> = families.iter().filter(|f| f.is_there()).map(|f| f.name.name()).collect();
    let unheard: Vec<&str> = families.iter().filter(|f| f.band_hz.is_none()).map(|f| f.name.name()).collect();
    if unheard.len() == families.len() {
        return "The record cannot tell whether there is a defect: it is too short, or sampled too slowly, \
            for every family. The reasons \
                say which length or rate would do."
            .to_owned();
    }
    let mut verdict = "The record shows no defect.".to_owned();
    if !weak.is_empty() {
        verdict += &format!(" {} can be seen, without knocks: watch the trend.", weak.join(" and "));
    }
    if !unheard.is_empty() {
        verdict += &format!(" It cannot speak of {}.", unheard.join(" and "));
    }
    verdict
}

impl Family {
    /// Whether the family is there, defect or not.
    pub fn is_there(&self) -> bool {
        self.noise_p_value < ALPHA && self.rank.is_some_and(|rank| rank <= MOST_AS_HIGH)
    }

    /// Height of the family's comb above the background [dB]: that of the fourth highest of five harmonics,
    /// by which families are compared; −∞ where none was looked for.
    pub fn score_db(&self) -> f64 {
        self.height_db
    }

    /// Takes a comb that stands farther from its place than slip of little load allows.
    fn take(&mut self, found: &unexplained::Found, rank: Option<f64>, band_hz: (f64, f64)) {
        let comb = &found.comb;
        self.measured_hz = Some(comb.fundamental_hz / self.name.shocks_per_period());
        self.noise_p_value = found.p_value();
        self.height_db = decibel(comb.height);
        self.level_db = Some(decibel(comb.ratios[0]));
        self.harmonics = comb.ratios.iter().filter(|r| **r >= comb.height).count();
        self.depth = Some(found.depth);
        self.depth_band_hz = Some(band_hz);
        self.band_hz = Some(band_hz);
        self.rank = rank;
        self.controls.clear();
        self.not_told_apart_from = None;
        self.reason = Reason::Undecided;
        self.calibrate();
    }

    /// The probability of a false alarm on a sound bearing, from noise, unrelated combs and depth.
    pub(super) fn calibrate(&mut self) {
        let by_depth = self.depth.map_or(1.0, |depth| (-SOUND_DEPTHS * depth).exp());
        self.p_value = by_depth.max(self.noise_p_value).max(self.rank.unwrap_or(1.0)).min(1.0);
    }

    /// The probability of a false alarm in words. Far beyond any test of the noise only a bound is given.
    pub fn false_alarm(&self) -> String {
        if self.p_value < 1e-9 { "< 1e-9".to_owned() } else { format!("{:.1e}", self.p_value) }
    }

    /// Whether it is more than noise and as deep as knocks, whoever makes them.
    fn knocks(&self) -> bool {
        self.noise_p_value < ALPHA && self.depth.is_some_and(|depth| depth >= KNOCK)
    }
}

/// A probability in words: one that is 1 says no more than that.
fn probability(p: f64) -> String {
    if p >= 0.1 { format!("{p:.1}") } else { format!("{p:.3}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Found at `measured_hz`, far above noise and anything else.
    fn found(name: Defect, expected_hz: f64, measured_hz: f64) -> Family {
        Family {
            name,
            expected_hz,
            measured_hz: Some(measured_hz),
            harmonics: 5,
            level_db: Some(25.0),
            p_value: 1e-9,
            noise_p_value: 1e-12,
            rank: Some(0.0),
            depth: Some(1.5),
            depth_band_hz: None,
            band_hz: None,
            in_passages: false,
            over: None,
            not_told_apart_from: None,
            claimed: false,
            reason: Reason::Undecided,
            height_db: 25.0,
            controls: Vec::new(),
        }
    }

    /// A NU 203 at 1500 rpm has BPFO at 106.3 Hz and twice BSF at 104.6 Hz, nearer than slip of 2 % may move
    /// either.
    #[test]
    fn example_one_line_is_claimed_for_one_family() {
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
        // Diameters of 1 to 5 put twice BSF on BPFO: whatever is measured, the record does not tell.
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
