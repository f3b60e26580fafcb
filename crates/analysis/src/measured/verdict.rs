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

use stribeck_dsp::{BandEnvelope, Whitened};

use super::controls::{controls, part_as_high, rank};
use super::decision::{claimed_first, decide, first, share_out, tell_the_element};
use super::family::Family;
use super::limits::{ALPHA, decibel};
use super::own::OwnLines;
use super::sentence::conclude;
use super::sidebands::is_modulated_by_the_cage;
use super::standing::{Standing, deepen, look};
use super::unexplained::{self, Known, Unexplained};
use super::unrelated::SLIP;
use super::{Defect, Machine};

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
    // Turns of another shaft may stand where the cage turns.
    let cage = look(Defect::Ftf, cage_hz, &whitened, &own, record_s, segment_s);
    own.cage_hz = cage.1.as_ref().filter(|_| cage.0.noise_p_value < ALPHA).map(|s| s.comb.fundamental_hz);
    let mut looked: Vec<(Family, Option<Standing>)> = Defect::ALL[..3]
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
    let there: Vec<Known> = looked[..3]
        .iter()
        .filter(|(family, _)| family.noise_p_value < ALPHA)
        .filter_map(|(family, standing)| {
            let turns = family.name == Defect::Bpfi;
            let Standing { comb, comb_hz, .. } = standing.as_ref()?;
            let [low_hz, high_hz] = [1.0 - SLIP, 1.0 + SLIP].map(|part| part * comb_hz);
            Some(Known { comb_hz: comb.fundamental_hz, low_hz, high_hz, turns, height: comb.height })
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
