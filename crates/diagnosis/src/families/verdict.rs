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
//! shaft and of the cage are nobody's defect (`machine_lines.rs`), and where a comb that is no family's
//! stands higher than all that are, nothing weaker is claimed (`unexplained.rs`).

use stribeck_dsp::{BandEnvelope, Whitened};
use stribeck_theory::catalogue::DefectOrders;

use crate::families::comb_at_half::comb_at_half;
use crate::families::controls::{controls, part_as_high, rank};
use crate::families::decision::{claimed_first, decide, first, name_the_element, share_out};
use crate::families::family::{Family, Reason};
use crate::families::limits::{ALPHA, decibel};
use crate::families::machine_lines::OwnLines;
use crate::families::sidebands::is_modulated_by_the_cage;
use crate::families::standing::{Standing, deepen, look};
use crate::families::unexplained::{self, Known, Unexplained};
use crate::families::unrelated::SLIP;
use crate::words::sentence::conclude;
use crate::{Defect, Machine};

/// Families and conclusion.
pub(crate) struct Verdicts {
    pub(crate) families: Vec<Family>,
    pub(crate) verdict: String,
    pub(crate) notes: Vec<String>,
    /// The defect that stands highest, if there is one.
    pub(crate) first: Option<First>,
    /// A comb that is no family's and stands higher.
    pub(crate) unexplained: Option<Unexplained>,
}

/// The first defect, as the search for a second one needs it.
pub(crate) struct First {
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
/// Least and largest part by which a cage that skids is slower than rolling without slip.
const SKID: (f64, f64) = (SLIP, 0.06);

/// Knowledge of the speed beside the machine's.
pub(crate) struct KnownSpeed {
    /// The speed by the lines of the record, which places multiples of the shaft better than one that is
    /// given [Hz].
    pub(crate) sharp_hz: Option<f64>,
    /// The lines of the shaft stand at the speed of the machine, so that only slip can move a family.
    pub(crate) by_its_lines: bool,
}

/// The families, of which one at most is claimed; [`Verdicts::conclude`] says the rest.
pub(crate) fn judge(
    bands: &[BandEnvelope],
    machine: &Machine,
    known: &KnownSpeed,
    record_s: f64,
    segment_s: f64,
) -> Verdicts {
    let (orders, shaft_hz) = match orders_and_speed(machine) {
        Ok(both) => both,
        Err(note) => return Verdicts::without_families(note),
    };
    // A band without noise (a simulated record, a filter) has no background to stand above.
    let whitened: Vec<(&BandEnvelope, Whitened)> = bands
        .iter()
        .filter_map(|b| Some((b, Whitened::new(&b.values, b.grid_hz, b.segments).ok()?)))
        .collect();
    // Load and sensor stand still, so the cage's frequency is that of its rotation in space.
    let cage_hz = (orders.ftf * shaft_hz + machine.outer_speed_rpm / 60.0).abs();
    let mut own = own_lines(machine, known.sharp_hz.unwrap_or(shaft_hz), OWN_LINES / segment_s);
    let places = [orders.bpfo * shaft_hz, orders.bpfi * shaft_hz, orders.bsf * shaft_hz, cage_hz];
    // Turns of another shaft may stand where the cage turns.
    let cage = look(Defect::Ftf, cage_hz, &whitened, &own, record_s, segment_s);
    own.cage_hz = cage.1.as_ref().filter(|_| cage.0.noise_p_value < ALPHA).map(|s| s.comb.fundamental_hz);
    let mut looked: Vec<Looked> = Defect::ALL[..3]
        .iter()
        .zip(places)
        .map(|(name, hz)| look(*name, hz, &whitened, &own, record_s, segment_s))
        .collect();
    looked.push(cage);
    let cage_hz = own.cage_hz.unwrap_or(cage_hz);
    for (family, standing) in &mut looked {
        if let Some(standing) = standing {
            deepen(family, standing, &whitened, cage_hz);
        }
    }
    let highest_hz = places[..2].iter().fold(0.0_f64, |most, hz| most.max(*hz));
    let there = above_noise(&looked[..3]);
    let of_others = |hz: f64| machine.around.may_be(hz / shaft_hz);
    let stranger = unexplained::strongest(&whitened, &own, cage_hz, highest_hz, &there, &of_others);
    let first = first(looked.iter().map(|(family, _)| family));
    let halved = first.and_then(|at| halve(&mut looked[at], &whitened, &own));
    let first_db = first.map_or(f64::NEG_INFINITY, |at| looked[at].0.height_db);
    let first_hz = first.and_then(|at| Some(looked[at].1.as_ref()?.comb.fundamental_hz));
    let mut families: Vec<Family> =
        looked.into_iter().map(|looked| beside_controls(looked, &whitened, &own, first_hz)).collect();
    let modulated = is_modulated_by_the_cage(&families, &whitened);
    share_out(&mut families, 1.0 / segment_s, modulated);
    let (mut notes, mut unexplained) = (Vec::new(), halved);
    if let Some(found) = stranger.filter(|s| decibel(s.comb.height) > first_db) {
        match known.by_its_lines.then(|| skidding(&families, &found)).flatten() {
            Some(at) => notes.push(take_skidding(&mut families[at], &found, &whitened, &own)),
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

/// A family, and the band in which its comb is highest, if there is one.
type Looked = (Family, Option<Standing>);

/// Orders of the families, and the speed of the shaft [Hz]; a note on what is missing for them.
fn orders_and_speed(machine: &Machine) -> Result<(DefectOrders, f64), String> {
    let bearing = machine.bearing.as_ref();
    let bearing = bearing.ok_or("no bearing was given: `--bearing \"6205\"`, or its numbers")?;
    let shaft_hz = machine.speed_rpm.map(|rpm| rpm / 60.0).filter(|hz| *hz > 0.0 && hz.is_finite());
    let shaft_hz =
        shaft_hz.ok_or("no speed was given: `--speed-rpm`, or `--tacho` with the channel of a tachometer")?;
    Ok((bearing.orders()?, shaft_hz))
}

/// Lines of the machine besides its defects, at this speed of the shaft; the cage is not known yet.
fn own_lines(machine: &Machine, shaft_hz: f64, width_hz: f64) -> OwnLines {
    let in_hz = |orders: &[f64]| orders.iter().map(|order| order * shaft_hz).collect();
    OwnLines {
        shaft_hz,
        cage_hz: None,
        elements: f64::from(machine.bearing.as_ref().and_then(|bearing| bearing.elements).unwrap_or(0)),
        width_hz,
        shafts_hz: in_hz(&machine.around.shafts),
        meshes_hz: in_hz(&machine.around.meshes),
    }
}

/// The combs of families that are more than noise.
fn above_noise(looked: &[Looked]) -> Vec<Known> {
    looked
        .iter()
        .filter(|(family, _)| family.noise_p_value < ALPHA)
        .filter_map(|(family, standing)| {
            let turns = family.name == Defect::Bpfi;
            let Standing { comb, comb_hz, .. } = standing.as_ref()?;
            let [low_hz, high_hz] = [1.0 - SLIP, 1.0 + SLIP].map(|part| part * comb_hz);
            Some(Known { comb_hz: comb.fundamental_hz, low_hz, high_hz, turns, height: comb.height })
        })
        .collect()
}

/// Decides that a raceway is not what knocks where the comb stands at half its frequency, too; that comb.
fn halve(
    (family, standing): &mut Looked,
    whitened: &[(&BandEnvelope, Whitened)],
    own: &OwnLines,
) -> Option<Unexplained> {
    let Standing { band, comb, .. } = standing.as_ref().filter(|_| family.name != Defect::Bsf)?;
    let half = comb_at_half(comb, &whitened[*band].1, own)?;
    family.reason = Reason::Decided(format!(
        "its lines are every second one of a comb at {:.2} Hz: what knocks comes half as often as elements \
         pass",
        half.hz
    ));
    Some(half)
}

/// Ranks a family among unrelated combs of its band, and gives it its probability of a false alarm.
fn beside_controls(
    (mut family, standing): Looked,
    whitened: &[(&BandEnvelope, Whitened)],
    own: &OwnLines,
    first_hz: Option<f64>,
) -> Family {
    if let Some(Standing { band, comb, comb_hz, times, .. }) = standing {
        let controls = controls(&comb, comb_hz, &whitened[band].1, first_hz, Some(own));
        family.rank = part_as_high(&comb, &controls);
        family.controls = controls.iter().map(|c| (c.fundamental_hz, decibel(c.height))).collect();
        if family.is_there() {
            family.measured_hz = Some(comb.fundamental_hz / times);
        }
    }
    family.calibrate();
    family
}

/// Takes a comb for this family although it is farther from its place than slip allows; the note on it.
fn take_skidding(
    family: &mut Family,
    found: &unexplained::Found,
    whitened: &[(&BandEnvelope, Whitened)],
    own: &OwnLines,
) -> String {
    let (band, spectrum) = &whitened[found.band];
    let comb_hz = found.comb.fundamental_hz;
    let rank = rank(&found.comb, comb_hz, spectrum, None, Some(own));
    family.take(found, rank, (band.low_hz, band.high_hz));
    let place_hz = family.name.shocks_per_period() * family.expected_hz;
    format!(
        "{} stands {:+.1} % from its place, farther than rolling without slip allows: beside the speed that \
         the lines of the shaft give, the cage skids, as it does under little load",
        family.name,
        100.0 * (comb_hz / place_hz - 1.0)
    )
}

impl Verdicts {
    /// No families, with a note on what is missing for them.
    fn without_families(note: String) -> Self {
        let verdict = "No verdict: speed and bearing are needed to say where a defect would show.".to_owned();
        Self { families: Vec::new(), verdict, notes: vec![note], first: None, unexplained: None }
    }

    /// The verdict over all families; `bands` are those that were judged.
    pub(crate) fn conclude(&mut self, bands: &[BandEnvelope]) {
        if !self.families.is_empty() {
            name_the_element(&mut self.families, bands);
            self.verdict = conclude(&self.families, self.unexplained.as_ref());
        }
    }
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
