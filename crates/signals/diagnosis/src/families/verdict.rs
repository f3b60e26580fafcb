//! Which defect families a record holds, and which of them may be called a defect.
//!
//! Three questions, all of which must be answered with yes (THEORY §7.9):
//!
//! 1. Is it more than noise? The comb test of [`stribeck_dsp::CombTest`] over all bands, with the probability
//!    of a false alarm under noise of the record's own colour.
//! 2. Is it more than the record's other lines? Machines are full of lines; the family must stand higher than
//!    combs of unrelated fundamentals in the same spectrum.
//! 3. Is it an impact? Healthy bearings modulate noise a little as their elements pass under the load. The power
//!    of a band must swing by 60 % of its mean.
//!
//! The highest that passes is claimed; `second.rs` looks for a second defect beside it. Multiples of the
//! shaft and of the cage are nobody's defect (`machine_lines.rs`), and where a comb that is no family's
//! stands higher than all that are, nothing weaker is claimed (`unexplained.rs`).

use stribeck_dsp::{BandEnvelope, CombTest, Whitened};
use stribeck_theory::catalogue::{CatalogueBearing, DefectOrders, Element};

use crate::families::candidate::{Candidate, Standing, search};
use crate::families::comb_at_half::comb_at_half;
use crate::families::controls::{controls, part_as_high, rank};
use crate::families::family::Family;
use crate::families::limits::{ALPHA, decibel};
use crate::families::machine_lines::OwnLines;
use crate::families::power;
use crate::families::rules::{
    Around, claimed_first, decide, first, shared_out, without_mirrored, without_sidebands_of_elements,
};
use crate::families::sidebands::is_modulated_by_the_cage;
use crate::families::sound::{BesideSound, farthest};
use crate::families::unexplained::{self, AboveNoise, Unexplained, UnexplainedComb};
use crate::families::unknown_bearing;
use crate::families::unrelated::SLIP;
use crate::record::pass::Record;
use crate::{Defect, Machine};

/// The families as they stand in a record, before the rules.
pub(crate) struct Candidates {
    pub(crate) families: Vec<Family>,
    /// A comb that is no family's and stands higher.
    pub(crate) unexplained: Option<Unexplained>,
    /// The machine's own lines.
    own: OwnLines,
    /// The combs of all bands that are no family's, and one at half the frequency of a raceway.
    foreign: Vec<UnexplainedComb>,
    at_half: Option<Unexplained>,
    rolling: Option<(f64, f64)>,
    /// How far the family that stands farthest above unrelated combs does so [dB].
    score_db: Option<f64>,
    /// The same beside healthy records of the machine.
    sound: Option<BesideSound>,
    /// Whether the cage modulates the impacts of a rolling element.
    modulated: bool,
    notes: Vec<String>,
    /// Turns of the shaft and of the cage [Hz].
    shaft_hz: f64,
    cage_hz: f64,
    /// One over the length of a segment [Hz].
    resolution_hz: f64,
}

/// The families after the rules, of which one at most is claimed.
pub(crate) struct Decided {
    pub(crate) families: Vec<Family>,
    pub(crate) notes: Vec<String>,
    /// The defect that stands highest, if there is one.
    pub(crate) first: Option<FirstDefect>,
    /// How far the family that stands farthest above unrelated combs does so [dB].
    pub(crate) score_db: Option<f64>,
    /// The same beside healthy records of the machine.
    pub(crate) sound: Option<BesideSound>,
    /// A comb that is no family's and stands higher.
    pub(crate) unexplained: Option<Unexplained>,
    /// The machine's own lines; none without families.
    own: Option<OwnLines>,
}

/// The first defect, as the search for a second one needs it.
pub(crate) struct FirstDefect {
    /// Its place among the families.
    pub(crate) at: usize,
    /// Its comb [Hz].
    pub(crate) comb_hz: f64,
    /// Turns of the shaft [Hz], whose lines are left where it modulates the first family.
    pub(crate) shaft_hz: f64,
    /// Turns of the cage without slip [Hz].
    pub(crate) cage_hz: f64,
    /// One over the length of a segment [Hz].
    pub(crate) resolution_hz: f64,
}

/// Lines about a multiple of the shaft or the cage that are its own: half the width of a Hann window’s lobe.
const OWN_LINES: f64 = 1.5;
/// Width of these lines over the frequency of the shaft from which a record is short: they cover half of all
/// places.
const SHORT: f64 = 0.25;
/// Largest radial clearance of ball bearings with a bore of 24 to 40 mm of group 3, which is usual in motors
/// [mm] (ISO 5753-1), and the sum of the curvatures of both grooves over the diameter of a ball, radii of 52 %
/// each: by both a load along the shaft steepens the contact (T. A. Harris, Rolling Bearing Analysis, 4th ed.,
/// Wiley 2001, section 2.4).
const CLEARANCE_MM: f64 = 0.028;
const CURVATURE: f64 = 0.04;
/// Part by which makers' sizes move the families' places.
const SIZES_DIFFER: f64 = 0.003;
/// Least and largest part by which a cage that skids is slower than rolling without slip.
const SKID: (f64, f64) = (SLIP, 0.06);

impl Candidates {
    /// The families of a machine in a record. `lines_hz` is the speed by the lines of the record, which places
    /// multiples of the shaft better than one that is given; `by_shaft`: the lines of the shaft stand at the
    /// speed of the machine, so that only slip can move a family.
    pub(crate) fn of(
        record: &Record,
        machine: &Machine,
        lines_hz: Option<f64>,
        by_shaft: bool,
    ) -> Result<Self, String> {
        let (orders, shaft_hz) = orders_and_speed(machine).map_err(|why| {
            let impacts = machine.speed_rpm.filter(|_| machine.bearing.is_none()).and_then(|rpm| {
                let own = own_lines(machine, rpm / 60.0, OWN_LINES / record.segment_s());
                unknown_bearing::sentence(&whitened(record), &own)
            });
            [Some(why), impacts].into_iter().flatten().collect::<Vec<_>>().join(". ")
        })?;
        let (record_s, segment_s) = (record.duration_s(), record.segment_s());
        let whitened = whitened(record);
        // Load and sensor stand still, so the cage's frequency is that of its rotation in space.
        let place_of_cage_hz = (orders.ftf * shaft_hz + machine.outer_speed_rpm / 60.0).abs();
        let places = [orders.bpfo, orders.bpfi, orders.bsf].map(|order| order * shaft_hz);
        let shaft_lines = own_lines(machine, lines_hz.unwrap_or(shaft_hz), OWN_LINES / segment_s);
        let is_short = shaft_lines.width_hz > SHORT * shaft_hz;
        let shaft_counts = !is_short || shaft_stands(&whitened, shaft_lines.shaft_hz, &places[..2]);
        let shaft_lines = OwnLines { shaft_counts, ..shaft_lines };
        let look =
            |name: Defect, hz: f64, own: &OwnLines| search(name, hz, &whitened, own, record_s, segment_s);
        // Turns of another shaft may stand where the cage turns.
        let cage = look(Defect::Ftf, place_of_cage_hz, &shaft_lines);
        let standing_cage = cage.standing.as_ref().filter(|_| cage.family.noise_p_value < ALPHA);
        let own = OwnLines { cage_hz: standing_cage.map(|cage| cage.comb.fundamental_hz), ..shaft_lines };
        let cage_hz = own.cage_hz.unwrap_or(place_of_cage_hz);
        let rolling = Defect::ALL[..3].iter().zip(places).map(|(name, hz)| look(*name, hz, &own));
        let looked: Vec<Candidate> = rolling.collect::<Vec<_>>().into_iter().chain([cage]).collect();
        let highest_hz = places[..2].iter().fold(0.0_f64, |most, hz| most.max(*hz));
        let there = above_noise(&looked[..3]);
        let width_hz = own.width_hz;
        let of_others = |hz: f64| {
            machine.around.may_be(hz / shaft_hz)
                || machine.shared_hz.iter().any(|of| is_part(hz, *of, width_hz))
        };
        let combs = unexplained::of_each_band(&whitened, &own, cage_hz, highest_hz, &there, &of_others);
        let in_its_band = |candidate: Candidate| match candidate.family.name {
            Defect::Bpfo | Defect::Bpfi => candidate.beside_foreign(&combs, &whitened),
            Defect::Bsf | Defect::Ftf => candidate,
        };
        let candidates: Vec<Candidate> = looked
            .into_iter()
            .map(|candidate| in_its_band(candidate).at_its_deepest(&whitened, cage_hz))
            .collect();
        let highest = combs.iter().max_by(|a, b| a.comb.height.total_cmp(&b.comb.height));
        let first = first(candidates.iter().map(|candidate| &candidate.family));
        let first_db = first.map_or(f64::NEG_INFINITY, |at| candidates[at].family.height_db);
        let first_hz = first.and_then(|at| Some(candidates[at].standing.as_ref()?.comb.fundamental_hz));
        let halved = first.and_then(|at| Some((at, comb_at_half_of(&candidates[at], &whitened, &own)?)));
        let measured: Vec<Family> = candidates
            .into_iter()
            .enumerate()
            .map(|(at, candidate)| {
                let half = halved.filter(|(first, _)| *first == at).map(|(_, half)| half);
                beside_controls(candidate, half, &whitened, &own, first_hz)
            })
            .collect();
        let modulated = is_modulated_by_the_cage(&measured, &whitened);
        let resolution_hz = 1.0 / segment_s;
        let measured: Vec<Family> = measured
            .into_iter()
            .map(|f| if f.name == Defect::Bsf && modulated { f.beside_the_cage() } else { f })
            .collect();
        let measured = without_sidebands_of_elements(measured, 2.0 * places[2], cage_hz, &whitened);
        let apart = without_mirrored(measured, shaft_hz, modulated, &whitened);
        let shared = shared_out(apart, resolution_hz, modulated);
        let score_db = farthest(&shared).map(|(_, score_db)| score_db);
        let sound = BesideSound::of(&shared, &machine.sound_db);
        let of_sound = sound.as_ref().map(BesideSound::note);
        let set_aside = machine.shared_hz.iter().map(|hz| {
            format!("the comb at {hz:.2} Hz stands in records of the healthy machine, too, and is left aside")
        });
        let at_half = halved.map(|(_, half)| half);
        let found = highest.filter(|found| decibel(found.comb.height) > first_db);
        let skids = found.filter(|_| by_shaft).and_then(|found| skidding(&shared, found));
        let (families, unexplained, notes) = match (found, skids) {
            (Some(found), Some(name)) => {
                let families = with_skidding(shared, name, found, &whitened, &own);
                let note = skidding_note(families.iter().find(|f| f.name == name), found);
                (families, at_half, note.into_iter().collect::<Vec<_>>())
            }
            (Some(found), None) => (shared, Some(found.report(shaft_hz)), Vec::new()),
            (None, _) => (shared, at_half, Vec::new()),
        };
        let notes = of_sound.into_iter().chain(set_aside).chain(notes).collect();
        Ok(Self {
            families,
            unexplained,
            own,
            foreign: if skids.is_some() { Vec::new() } else { combs },
            at_half,
            score_db,
            sound,
            rolling: machine.bearing.as_ref().filter(|_| by_shaft).map(reach_of_rolling),
            modulated,
            notes,
            shaft_hz,
            cage_hz,
            resolution_hz,
        })
    }

    /// What the rules say of them.
    pub(crate) fn decide(self) -> Decided {
        let Self {
            families,
            unexplained,
            own,
            foreign,
            at_half,
            rolling,
            score_db,
            sound,
            modulated,
            notes,
            shaft_hz,
            cage_hz,
            resolution_hz,
        } = self;
        let width_hz = OWN_LINES * resolution_hz;
        let around = Around { foreign: &foreign, at_half: at_half.as_ref(), rolling, shaft_hz, width_hz };
        let decided = decide(families, around, sound, modulated);
        let first = claimed_first(&decided).map(|(at, comb_hz)| FirstDefect {
            at,
            comb_hz,
            shaft_hz,
            cage_hz,
            resolution_hz,
        });
        Decided { families: decided, notes, first, score_db, sound, unexplained, own: Some(own) }
    }
}

impl Decided {
    /// The same families with the impacts that the record would have shown, and those that it shows.
    pub(crate) fn with_power(&self, families: Vec<Family>, record: &Record) -> Vec<Family> {
        let Some(own) = &self.own else { return families };
        let whitened = whitened(record);
        let of = |family: Family| match family.band_hz {
            Some(_) => power::with_power(family, &whitened, own, record),
            None => family,
        };
        families.into_iter().map(of).collect()
    }

    /// Whether a raceway would stand where the highest comb is that is no family's, or its second or third line, at a
    /// speed within `reach` of the given one, and nothing is claimed.
    pub(crate) fn asks_for_a_speed(&self, reach: f64) -> bool {
        let is_raceway = |family: &&Family| matches!(family.name, Defect::Bpfo | Defect::Bpfi);
        let near = |hz: f64, family: &Family| {
            let times = hz / family.expected_hz;
            (times / times.round().clamp(1.0, 3.0) - 1.0).abs() < reach
        };
        let is_silent = !self.families.iter().any(|family| family.claimed);
        let comb = self.unexplained.filter(|_| is_silent);
        comb.is_some_and(|comb| self.families.iter().filter(is_raceway).any(|family| near(comb.hz, family)))
    }
    /// No families, with a note on what is missing for them.
    pub(crate) fn without_families(note: String) -> Self {
        let (families, notes) = (Vec::new(), vec![note]);
        Self { families, notes, first: None, score_db: None, sound: None, unexplained: None, own: None }
    }
}

/// Orders of the families, and the speed of the shaft [Hz]; a note on what is missing for them.
pub(crate) fn orders_and_speed(machine: &Machine) -> Result<(DefectOrders, f64), String> {
    let bearing = machine.bearing.as_ref();
    let bearing = bearing.ok_or("no bearing was given: `--bearing \"6205\"`, or its numbers")?;
    let shaft_hz = machine.speed_rpm.map(|rpm| rpm / 60.0).filter(|hz| *hz > 0.0 && hz.is_finite());
    let shaft_hz =
        shaft_hz.ok_or("no speed was given: `--speed-rpm`, or `--tacho` with the channel of a tachometer")?;
    let orders = bearing.orders().map_err(|why| {
        let places = |elements: u32| {
            let of = CatalogueBearing { elements: Some(elements), ..bearing.clone() };
            let orders = of.orders().ok()?;
            let [outer, inner] = [orders.bpfo, orders.bpfi].map(|order| order * shaft_hz);
            Some(format!("{elements} make BPFO {outer:.1} Hz and BPFI {inner:.1} Hz"))
        };
        format!(
            "{why}; {}",
            bearing.possible_elements().into_iter().filter_map(places).collect::<Vec<_>>().join(", ")
        )
    })?;
    Ok((orders, shaft_hz))
}

/// The family of the outer raceway over its place in a bearing whose contact a load along the shaft steepens,
/// and that of the inner one.
fn reach_of_rolling(bearing: &CatalogueBearing) -> (f64, f64) {
    let flat = bearing.angle_deg.to_radians().cos();
    let steeper = match bearing.element {
        Element::Ball => (flat - 0.5 * CLEARANCE_MM / (CURVATURE * bearing.diameter_mm)).max(0.0),
        Element::Roller => flat,
    };
    let [least, most] = [steeper, flat].map(|cosine| bearing.diameter_mm / bearing.pitch_mm * cosine);
    let off = SIZES_DIFFER;
    ((1.0 - least) / (1.0 - most) + off, (1.0 + least) / (1.0 + most) - off)
}

/// Lines of the machine besides its defects, at this speed of the shaft; the cage is not known yet.
fn own_lines(machine: &Machine, shaft_hz: f64, width_hz: f64) -> OwnLines {
    let in_hz = |orders: &[f64]| orders.iter().map(|order| order * shaft_hz).collect();
    OwnLines {
        shaft_hz,
        shaft_counts: true,
        cage_hz: None,
        elements: f64::from(machine.bearing.as_ref().and_then(|bearing| bearing.elements).unwrap_or(0)),
        width_hz,
        shafts_hz: in_hz(&machine.around.shafts),
        meshes_hz: in_hz(&machine.around.meshes),
    }
}

/// The bands with their spectra over the background; one without noise (a simulated record, a filter) has no
/// background to stand above.
fn whitened(record: &Record) -> Vec<(&BandEnvelope, Whitened)> {
    let bands = record.bands.iter();
    bands.filter_map(|b| Some((b, Whitened::new(&b.values, b.grid_hz, b.segments).ok()?))).collect()
}

/// Whether a comb at `hz` shares lines with another one: a fraction of small numbers of it.
fn is_part(hz: f64, of_hz: f64, width_hz: f64) -> bool {
    const MOST: u32 = 5;
    (1..=MOST).any(|p| (1..=MOST).any(|q| (f64::from(q) * hz - f64::from(p) * of_hz).abs() < width_hz))
}

/// Whether multiples of the shaft stand as high as the first lines of the raceways between them, by their places
/// [Hz]: where a raceway stands between lower ones, its lines are not the shaft's.
fn shaft_stands(whitened: &[(&BandEnvelope, Whitened)], shaft_hz: f64, places: &[f64]) -> bool {
    const LINES: u32 = 2;
    let raceway_stands_out = |hz: &f64| {
        let (low_hz, high_hz) = ((1.0 - SLIP) * hz, (1.0 + SLIP) * hz);
        let combs = whitened.iter().filter_map(|(_, spectrum)| {
            Some((CombTest::FOUR_OF_FIVE.search(spectrum, low_hz, high_hz).ok()?, spectrum))
        });
        let highest = combs.max_by(|a, b| a.0.height.total_cmp(&b.0.height));
        highest.is_some_and(|(comb, spectrum)| {
            let grid_hz = spectrum.grid_hz();
            (1..=LINES).all(|n| {
                let hz = f64::from(n) * comb.fundamental_hz;
                let below = (hz / shaft_hz).floor() * shaft_hz;
                let multiples = [below, below + shaft_hz].into_iter().filter(|of| (of - hz).abs() > grid_hz);
                let line = |hz: f64| spectrum.ratios().get((hz / grid_hz).round() as usize).copied();
                multiples.filter_map(line).all(|ratio| ratio < spectrum.at(hz))
            })
        })
    };
    !places.iter().any(raceway_stands_out)
}

/// The combs of families that are more than noise.
fn above_noise(candidates: &[Candidate]) -> Vec<AboveNoise> {
    candidates
        .iter()
        .filter(|candidate| candidate.family.noise_p_value < ALPHA)
        .filter_map(|candidate| {
            let turns = candidate.family.name == Defect::Bpfi;
            let Standing { comb, comb_hz, .. } = candidate.standing.as_ref()?;
            let [low_hz, high_hz] = [1.0 - SLIP, 1.0 + SLIP].map(|part| part * comb_hz);
            Some(AboveNoise { comb_hz: comb.fundamental_hz, low_hz, high_hz, turns, height: comb.height })
        })
        .collect()
}

/// The comb at half the frequency of a raceway, where one stands: then the raceway is not what strikes.
fn comb_at_half_of(
    candidate: &Candidate,
    whitened: &[(&BandEnvelope, Whitened)],
    own: &OwnLines,
) -> Option<Unexplained> {
    let is_element = candidate.family.name == Defect::Bsf;
    let Standing { band, comb, .. } = candidate.standing.as_ref().filter(|_| !is_element)?;
    comb_at_half(comb, &whitened[*band], own)
}

/// Ranks a family among unrelated combs of its band, and gives it its probability of a false alarm; `half` is
/// a comb at half its frequency.
fn beside_controls(
    candidate: Candidate,
    half: Option<Unexplained>,
    whitened: &[(&BandEnvelope, Whitened)],
    own: &OwnLines,
    first_hz: Option<f64>,
) -> Family {
    let Candidate { family, standing, .. } = candidate;
    let judged = match half {
        Some(half) => family.refused(
            "half the rate",
            format!(
                "its lines are every second one of a comb at {:.2} Hz: what strikes comes half as often as elements \
                 pass",
                half.hz
            ),
        ),
        None => family,
    };
    let Some(Standing { band, comb, comb_hz, times, .. }) = standing else {
        return judged.calibrated();
    };
    let controls = controls(&comb, comb_hz, &whitened[band].1, first_hz, Some(own));
    let ranked = Family {
        rank: part_as_high(&comb, &controls),
        controls: controls.iter().map(|c| (c.fundamental_hz, decibel(c.height))).collect(),
        ..judged
    };
    let measured_hz = ranked.is_there().then_some(comb.fundamental_hz / times);
    Family { measured_hz, ..ranked }.calibrated()
}

/// The families, of which one is at a comb that is farther from its place than slip allows.
fn with_skidding(
    families: Vec<Family>,
    name: Defect,
    found: &UnexplainedComb,
    whitened: &[(&BandEnvelope, Whitened)],
    own: &OwnLines,
) -> Vec<Family> {
    let (_, spectrum) = &whitened[found.band];
    let rank = rank(&found.comb, found.comb.fundamental_hz, spectrum, None, Some(own));
    let skid = |family: Family| if family.name == name { family.at(found, rank) } else { family };
    families.into_iter().map(skid).collect()
}

/// The note on such a family.
fn skidding_note(family: Option<&Family>, found: &UnexplainedComb) -> Option<String> {
    let family = family?;
    let place_hz = family.name.shocks_per_period() * family.expected_hz;
    Some(format!(
        "{} is {:+.1} % off its expected frequency, more than rolling without slip allows: beside the speed that \
         the lines of the shaft give, the cage skids, as it does under little load",
        family.name,
        100.0 * (found.comb.fundamental_hz / place_hz - 1.0)
    ))
}

/// The raceway whose family a comb would be if the cage skids: slower, so that the outer raceway’s comes down
/// and the inner one’s goes up by what that takes.
fn skidding(families: &[Family], found: &UnexplainedComb) -> Option<Defect> {
    let place = |name: Defect| families.iter().find(|f| f.name == name).map(|f| f.expected_hz);
    let (outer_hz, inner_hz) = (place(Defect::Bpfo)?, place(Defect::Bpfi)?);
    let hz = found.comb.fundamental_hz;
    let slower = |by_hz: f64| (SKID.0..=SKID.1).contains(&(by_hz / outer_hz));
    if slower(outer_hz - hz) {
        Some(Defect::Bpfo)
    } else if slower(hz - inner_hz) {
        Some(Defect::Bpfi)
    } else {
        None
    }
}
