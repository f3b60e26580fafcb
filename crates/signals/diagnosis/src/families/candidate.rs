//! Where a family stands highest of all bands, and how deep its impacts are there.

use stribeck_dsp::{BandEnvelope, Comb, CombTest, Whitened};
use stribeck_theory::kinematics::off_multiple;

use crate::Defect;
use crate::families::family::{Family, Reason};
use crate::families::limits::{ALPHA, IMPACT, decibel};
use crate::families::machine_lines::OwnLines;
use crate::families::unexplained::UnexplainedComb;
use crate::families::unrelated::SLIP;
use crate::record::bands::{HIGHEST_HZ, LOWEST};

/// Periods that a segment must hold.
const PERIODS: f64 = 10.0;

/// The longest record that is asked for [s].
const LONGEST_S: f64 = 100.0;

/// Where a family stands highest.
pub(crate) struct Standing {
    pub(crate) band: usize,
    pub(crate) comb: Comb,
    /// Fundamental without slip [Hz].
    pub(crate) comb_hz: f64,
    /// The same over the frequency of the name.
    pub(crate) times: f64,
    /// Bands that were searched.
    pub(crate) searched: f64,
}

/// A family as it stands in the record, before the rules.
pub(crate) struct Candidate {
    pub(crate) family: Family,
    /// The band in which its comb is highest, if there is one.
    pub(crate) standing: Option<Standing>,
    /// Its highest comb in each band.
    found: Vec<(usize, Comb)>,
}

/// Looks for one family in all bands.
pub(crate) fn search(
    name: Defect,
    expected_hz: f64,
    bands: &[(&BandEnvelope, Whitened)],
    own: &OwnLines,
    record_s: f64,
    segment_s: f64,
) -> Candidate {
    let times = name.shocks_per_period();
    let comb_hz = times * expected_hz;
    let expected = Family::expected(name, expected_hz);
    let refused = |why: String| {
        let family = Family { reason: Reason::Decided(why), ..Family::expected(name, expected_hz) };
        Candidate { family, standing: None, found: Vec::new() }
    };
    if segment_s * comb_hz < PERIODS && record_s * comb_hz >= PERIODS {
        return refused(format!(
            "segments of {segment_s:.2} s, by which the record is judged, hold {:.2} periods, and \
             ten are needed",
            (100.0 * segment_s * comb_hz).floor() / 100.0
        ));
    }
    if segment_s * comb_hz < PERIODS {
        return refused(format!(
            "the record of {record_s:.2} s holds {:.2} periods; {:.2} s would hold the ten that are needed",
            (100.0 * record_s * comb_hz).floor() / 100.0,
            (100.0 * PERIODS / comb_hz).ceil() / 100.0
        ));
    }
    let (low, high) = ((1.0 - SLIP) * comb_hz, (1.0 + SLIP) * comb_hz);
    // The lines of such a family lie beyond all spectra; their places would be many.
    if CombTest::FOUR_OF_FIVE.needed as f64 * low > HIGHEST_HZ {
        return refused(too_narrow(comb_hz, !bands.is_empty()));
    }
    let ranges = own.ranges_without(low, high);
    if ranges.is_empty() || own.holds(comb_hz) {
        let needed_s = segment_s * own.width_hz / off_multiple(comb_hz, own.shaft_hz);
        let longer = if own.is_of_shaft(comb_hz) && (record_s..LONGEST_S).contains(&needed_s) {
            format!("one of {:.1} s", (10.0 * needed_s).ceil() / 10.0)
        } else {
            "a longer one".to_owned()
        };
        let hidden = Family { undecided: true, ..expected };
        return Candidate { family: hidden, standing: None, found: Vec::new() }.because(format!(
            "undecided: a record so short does not tell its place from a multiple of the shaft or the cage; {longer} \
             would"
        ));
    }
    let found: Vec<(usize, Comb)> = bands
        .iter()
        .enumerate()
        .flat_map(|(n, band)| ranges.iter().map(move |range| (n, band, *range)))
        .filter_map(|(n, (_, spectrum), (low, high))| {
            Some((n, CombTest::FOUR_OF_FIVE.search(spectrum, low, high).ok()?))
        })
        .collect();
    let Some((n, comb)) = found.iter().max_by(|a, b| a.1.height.total_cmp(&b.1.height)).cloned() else {
        return refused(too_narrow(comb_hz, !bands.is_empty()));
    };
    // What stands in the rest of the place, the flank of a family that is a little off the shaft's multiple
    // among it, is judged as any other.
    let searched = found.len() as f64;
    let strikes = comb.p_value * searched < ALPHA && bands[n].0.depth(comb.fundamental_hz) >= IMPACT;
    if let Some(hidden) = hidden(bands, own, (low, high), comb.height).filter(|_| !strikes) {
        let family = Family { undecided: true, ..expected };
        return Candidate { family, standing: None, found }.because(format!(
            "undecided: something strikes at {:.2} Hz, {:.0} times the shaft, where its place is, too; a measured \
             speed or a longer record would tell them apart",
            hidden.fundamental_hz,
            hidden.fundamental_hz / own.shaft_hz
        ));
    }
    Candidate { family: expected, standing: None, found }.standing_in(n, comb, comb_hz, bands)
}

/// A comb of the shaft within the place of a family that strikes and stands higher than all that are not the
/// machine's own there.
fn hidden(
    bands: &[(&BandEnvelope, Whitened)],
    own: &OwnLines,
    (low, high): (f64, f64),
    height: f64,
) -> Option<Comb> {
    let of = |(band, spectrum): &(&BandEnvelope, Whitened)| {
        let comb = CombTest::FOUR_OF_FIVE.search(spectrum, low, high).ok()?;
        let strikes = band.depth(comb.fundamental_hz) >= IMPACT;
        let is_its = own.is_of_shaft(comb.fundamental_hz) && comb.height > height;
        (is_its && strikes && comb.p_value * (bands.len() as f64) < ALPHA).then_some(comb)
    };
    bands.iter().filter_map(of).max_by(|a, b| a.height.total_cmp(&b.height))
}

impl Candidate {
    /// The same, decided.
    fn because(self, why: String) -> Self {
        Self { family: Family { reason: Reason::Decided(why), ..self.family }, ..self }
    }

    /// The same with the numbers of its comb in one of the bands.
    fn standing_in(self, n: usize, comb: Comb, comb_hz: f64, bands: &[(&BandEnvelope, Whitened)]) -> Self {
        let searched = self.found.len() as f64;
        let (band, spectrum) = &bands[n];
        let band_hz = Some((band.low_hz, band.high_hz));
        let family = Family {
            noise_p_value: (comb.p_value * searched).min(1.0),
            band_hz,
            height_db: decibel(comb.height),
            level_db: Some(decibel(comb.ratios[0])),
            harmonics: comb.ratios.iter().filter(|r| spectrum.line_p_value(**r) < ALPHA).count(),
            depth: Some(depth_of_comb(band, spectrum, comb.fundamental_hz)),
            depth_band_hz: band_hz,
            ..self.family
        };
        let times = family.name.shocks_per_period();
        Self { family, standing: Some(Standing { band: n, comb, comb_hz, times, searched }), ..self }
    }

    /// The same in the band where its comb is highest of those in which it is more than noise and no foreign
    /// comb that stands higher is: a machine has other sources, each in bands of its own. Where there is no such
    /// band it stays.
    pub(crate) fn beside_foreign(
        self,
        foreign: &[UnexplainedComb],
        bands: &[(&BandEnvelope, Whitened)],
    ) -> Self {
        let is_higher = |n: usize, comb: &Comb| {
            let band_hz = Some((bands[n].0.low_hz, bands[n].0.high_hz));
            foreign.iter().any(|other| other.comb.height > comb.height && other.is_in(band_hz))
        };
        let Some(Standing { band, comb, comb_hz, searched, .. }) = &self.standing else { return self };
        if !is_higher(*band, comb) {
            return self;
        }
        let clear =
            self.found.iter().filter(|(n, comb)| comb.p_value * searched < ALPHA && !is_higher(*n, comb));
        let (highest, comb_hz) = (clear.max_by(|a, b| a.1.height.total_cmp(&b.1.height)).cloned(), *comb_hz);
        match highest {
            Some((n, comb)) => self.standing_in(n, comb, comb_hz, bands),
            None => self,
        }
    }

    /// The same with its depth in the band where it is deepest, of those in which its comb stands; that of a
    /// rolling element with its sidebands of the cage.
    pub(crate) fn at_its_deepest(self, bands: &[(&BandEnvelope, Whitened)], cage_hz: f64) -> Self {
        let Self { family, standing: Some(standing), found } = self else { return self };
        let hz = standing.comb.fundamental_hz;
        let stands = |(band, spectrum): &&(&BandEnvelope, Whitened)| {
            let (low, high) = (hz - 0.5 * band.grid_hz, hz + 0.5 * band.grid_hz);
            let near = CombTest::FOUR_OF_FIVE.search(spectrum, low, high);
            near.is_ok_and(|comb| comb.p_value * standing.searched < ALPHA)
        };
        let start = (family.depth, family.depth_band_hz);
        let (depth, depth_band_hz) = bands.iter().filter(stands).fold(start, |deepest, (band, spectrum)| {
            let depth = depth_of(family.name, (band, spectrum), hz, cage_hz);
            let is_deeper = deepest.0.is_none_or(|deepest| depth > deepest);
            if is_deeper { (Some(depth), Some((band.low_hz, band.high_hz))) } else { deepest }
        });
        Self { family: Family { depth, depth_band_hz, ..family }, standing: Some(standing), found }
    }
}

/// Impacts slower than this [Hz] are short beside their period, and up to that frequency their lines are as high.
pub(crate) const SLOW_HZ: f64 = 5.0;
pub(crate) const LINES_TO_HZ: f64 = 100.0;

/// Depth of the modulation at a comb. The power of slow impacts is a small part of the noise's, and in as many more
/// lines: theirs are added, less the background.
fn depth_of_comb(band: &BandEnvelope, spectrum: &Whitened, comb_hz: f64) -> f64 {
    if comb_hz >= SLOW_HZ {
        return band.depth(comb_hz);
    }
    let above_background = |n: u32| {
        let hz = f64::from(n) * comb_hz;
        let ratio = spectrum.at(hz);
        band.depth(hz).powi(2) * (1.0 - 1.0 / ratio.max(1.0))
    };
    (1..=(LINES_TO_HZ / comb_hz) as u32).map(above_background).sum::<f64>().sqrt()
}

/// Depth of the modulation at a comb; the power of an element's impacts is in the sidebands of the cage, too.
fn depth_of(name: Defect, (band, spectrum): (&BandEnvelope, &Whitened), comb_hz: f64, cage_hz: f64) -> f64 {
    const BESIDE: i32 = 2;
    if name != Defect::Bsf {
        return depth_of_comb(band, spectrum, comb_hz);
    }
    let lines = (-BESIDE..=BESIDE).map(|k| band.depth(comb_hz + f64::from(k) * cage_hz).powi(2));
    lines.sum::<f64>().sqrt()
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
