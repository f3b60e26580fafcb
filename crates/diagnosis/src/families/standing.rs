//! Where a family stands highest of all bands, and how deep its knocks are there.

use stribeck_dsp::{BandEnvelope, Comb, CombTest, Whitened};

use crate::families::family::{Family, Reason};
use crate::families::limits::{ALPHA, decibel};
use crate::families::machine_lines::OwnLines;
use crate::families::unrelated::SLIP;
use crate::{Defect, HIGHEST_HZ, LOWEST};

/// Periods that a segment must hold.
const PERIODS: f64 = 10.0;

/// Where a family stands highest.
pub(crate) struct Standing {
    /// Number of the band.
    pub(crate) band: usize,
    pub(crate) comb: Comb,
    /// Fundamental without slip [Hz].
    pub(crate) comb_hz: f64,
    /// The same over the frequency of the name.
    pub(crate) times: f64,
    /// Bands that were searched.
    pub(crate) searched: f64,
}

/// Looks for one family in all bands.
pub(crate) fn look(
    name: Defect,
    expected_hz: f64,
    bands: &[(&BandEnvelope, Whitened)],
    own: &OwnLines,
    record_s: f64,
    segment_s: f64,
) -> (Family, Option<Standing>) {
    let times = name.shocks_per_period();
    let comb_hz = times * expected_hz;
    let mut family = Family::expected(name, expected_hz);
    if segment_s * comb_hz < PERIODS && record_s * comb_hz >= PERIODS {
        family.reason = Reason::Decided(format!(
            "segments of {segment_s:.2} s, by which the record is judged, hold {:.2} periods, and \
             ten are needed",
            (100.0 * segment_s * comb_hz).floor() / 100.0
        ));
        return (family, None);
    }
    if segment_s * comb_hz < PERIODS {
        family.reason = Reason::Decided(format!(
            "the record of {record_s:.2} s holds {:.2} periods; {:.2} s would hold the ten that are needed",
            (100.0 * record_s * comb_hz).floor() / 100.0,
            (100.0 * PERIODS / comb_hz).ceil() / 100.0
        ));
        return (family, None);
    }
    let (low, high) = ((1.0 - SLIP) * comb_hz, (1.0 + SLIP) * comb_hz);
    let ranges = own.ranges_without(low, high);
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
pub(crate) fn deepen(
    family: &mut Family,
    standing: &Standing,
    bands: &[(&BandEnvelope, Whitened)],
    cage_hz: f64,
) {
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
