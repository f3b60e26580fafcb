//! Predicted facet-passing lines, and the levels of the spectrum at their frequencies.
//!
//! Lines closer than the resolution are searched as one and marked so: a record of 30 ms merges lines
//! within 67 Hz, and the passing of roller vertices and of raceway nodes often is.

use serde::{Deserialize, Serialize};
use stribeck_dsp::{Peak, Resolution, Spectrum};

use crate::Error;
use stribeck_diagnosis::quantities;

/// A line that follows from the geometry.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PredictedLine {
    /// Facets and the place that they pass, in words.
    pub name: String,
    /// Multiple of the fundamental, from 1.
    pub harmonic: usize,
    /// Predicted frequency without slip [Hz].
    pub predicted_hz: f64,
    /// The same from the recorded motion, when there is one [Hz].
    pub from_motion_hz: Option<f64>,
}

quantities! {
    /// A predicted line beside its measurement at one sensor.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    pub struct Tone {
        /// Sensor.
        pub sensor: String,
        /// Facets and the place that they pass, in words.
        pub name: String,
        /// Multiple of the fundamental, from 1.
        pub harmonic: usize,
        /// Predicted frequency without slip [Hz].
        pub predicted_hz: f64,
        /// The same from the recorded motion of cage and rollers [Hz].
        pub from_motion_hz: Option<f64>,
        /// Frequency of the highest line within reach of the prediction [Hz]; `None` when no peak there
        /// stands at least [`LEAST_PROMINENCE_DB`] above its surroundings.
        pub measured_hz: Option<f64>,
        /// Peak amplitude of the measured line [g].
        pub level_g: Option<f64>,
        /// How far the highest peak within reach stands above the median of its surroundings [dB],
        /// line or not.
        pub prominence_db: Option<f64>,
        /// Other predicted lines that this spectrum does not resolve from this one.
        pub unresolved_from: Vec<String>,
    }
}

/// A prediction, without slip or from the recorded motion, holds for a measured line within this fraction of
/// it.
pub const REACH: f64 = 0.005;
/// A peak counts as a line when it stands this far above its surroundings [dB]: noise of the same mean
/// reaches it in about one band of a hundred.
pub const LEAST_PROMINENCE_DB: f64 = 10.0;
/// Half width of the band that counts as the surroundings of a line, in widths of a line at −6 dB.
const SURROUNDINGS_WIDTHS: f64 = 12.0;
/// The highest side lobe of Hann's window is 31 dB below its main lobe (F. J. Harris, Proc. IEEE 66 (1978)).
const SIDE_LOBES_DB: f64 = 30.0;
/// Half width that is excluded about a line when its surroundings are judged, in widths at −6 dB.
const EXCLUDED_WIDTHS: f64 = 1.5;

/// Harmonics 1 to `most` of each fundamental `(name, frequency in Hz)`, as far as they lie below `limit_hz`.
pub fn harmonics(fundamentals: &[(String, f64)], most: usize, limit_hz: f64) -> Vec<PredictedLine> {
    (1..=most)
        .flat_map(|harmonic| {
            fundamentals.iter().map(move |(name, hz)| PredictedLine {
                name: name.clone(),
                harmonic,
                predicted_hz: harmonic as f64 * hz,
                from_motion_hz: None,
            })
        })
        .filter(|line| line.predicted_hz > 0.0 && line.predicted_hz < limit_hz)
        .collect()
}

/// Lines in groups that a spectrum of this resolution cannot split: neighbours closer than the width at −6
/// dB. Groups and their members ascend.
pub fn unresolved(lines: &[PredictedLine], resolution: &Resolution) -> Vec<Vec<usize>> {
    let mut order: Vec<usize> = (0..lines.len()).collect();
    order.sort_by(|&a, &b| lines[a].predicted_hz.total_cmp(&lines[b].predicted_hz));
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for at in order {
        let near = |group: &Vec<usize>| {
            let last = group.last().map_or(f64::NEG_INFINITY, |&l| lines[l].predicted_hz);
            lines[at].predicted_hz - last < resolution.width_6db_hz
        };
        match groups.last_mut() {
            Some(group) if near(group) => group.push(at),
            _ => groups.push(vec![at]),
        }
    }
    groups
}

/// Measures every line in `spectrum`, a density [g²/Hz] of the signal of `sensor`; one tone a line, in their
/// order.
///
/// # Errors
/// None for an absent line, whose tone is `None`. [`Error::Signal`] when the spectrum cannot be searched.
pub fn measure(sensor: &str, lines: &[PredictedLine], spectrum: &Spectrum) -> Result<Vec<Tone>, Error> {
    let resolution = spectrum.resolution();
    let mut tones: Vec<Tone> = lines.iter().map(|line| Tone::unmeasured(sensor, line)).collect();
    for group in unresolved(lines, resolution) {
        let expected = group.iter().flat_map(|&at| lines[at].expected_hz());
        let (lowest, highest) =
            expected.fold((f64::INFINITY, 0.0), |(low, high): (f64, f64), hz| (low.min(hz), high.max(hz)));
        // A short record cannot place a line better than half a resolution.
        let reach = |f: f64| (REACH * f).max(0.5 * resolution.resolution_hz);
        let limit = 0.5 * spectrum.sample_rate_hz();
        let (from, to) = ((lowest - reach(lowest)).max(0.0), (highest + reach(highest)).min(limit));
        for &at in &group {
            let others = group.iter().filter(|&&o| o != at);
            tones[at].unresolved_from =
                others.map(|&o| format!("{} ×{}", lines[o].name, lines[o].harmonic)).collect();
        }
        let Ok(peak) = spectrum.peak(from, to) else { continue };
        if peak.at_edge {
            continue;
        }
        // At zero and at half the sample rate a line has no amplitude: it was not measured.
        let Ok(line) = spectrum.sinusoid(&peak) else { continue };
        let prominence = prominence_db(spectrum, &peak, (lowest, highest));
        for &at in &group {
            let near = |hz: f64| (line.frequency_hz - hz).abs() <= reach(hz);
            if !lines[at].expected_hz().any(near) {
                continue;
            }
            tones[at].prominence_db = prominence;
            if prominence.is_some_and(|db| db >= LEAST_PROMINENCE_DB) {
                tones[at].measured_hz = Some(line.frequency_hz);
                tones[at].level_g = Some(line.amplitude);
            }
        }
    }
    Ok(tones)
}

/// The line of a spectrum that is nearest to a frequency.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct NearestLine {
    /// Its frequency [Hz]; `None` where no peak within reach stands [`LEAST_PROMINENCE_DB`] above its
    /// surroundings.
    pub hz: Option<f64>,
    /// Its peak amplitude [g].
    pub level_g: Option<f64>,
    /// How far it stands above the median of its surroundings [dB]; without a line, the highest peak within
    /// reach.
    pub above_db: Option<f64>,
}

/// The line of `spectrum`, a density [g²/Hz], that is nearest to `expected_hz`, whatever makes it: within
/// [`REACH`], or within the width of a line at −6 dB where that is more. Peaks as far below the
/// highest one as the side lobes of its window do not count as lines.
pub fn nearest(spectrum: &Spectrum, expected_hz: f64) -> Result<NearestLine, Error> {
    let grid_hz = spectrum.resolution().grid_hz;
    let reach = (REACH * expected_hz).max(spectrum.resolution().width_6db_hz);
    let last_hz = 0.5 * spectrum.sample_rate_hz() - grid_hz;
    let bins = ((expected_hz - reach) / grid_hz).ceil().max(1.0) as usize
        ..=((expected_hz + reach).min(last_hz) / grid_hz).floor().max(0.0) as usize;
    let values = spectrum.values();
    let is_peak = |bin: &usize| values[*bin] >= values[bin - 1] && values[*bin] > values[bin + 1];
    let peak = |bin: usize| spectrum.peak((bin as f64 - 0.5) * grid_hz, (bin as f64 + 0.5) * grid_hz).ok();
    let peaks: Vec<Peak> = bins.filter(is_peak).filter_map(peak).collect();
    let Some(highest) = peaks.iter().max_by(|a, b| a.level_db.total_cmp(&b.level_db)) else {
        return Ok(NearestLine::default());
    };
    // Lobes of a line out of reach may be within it.
    let [from, to] = [expected_hz - 2.0 * reach, expected_hz + 2.0 * reach].map(|hz| hz.clamp(0.0, last_hz));
    let about_db = spectrum.peak(from, to).map_or(highest.level_db, |peak| peak.level_db);
    let above_db = |peak: &Peak| prominence_db(spectrum, peak, (peak.frequency_hz, peak.frequency_hz));
    let is_line = |peak: &&Peak| {
        peak.level_db > about_db - SIDE_LOBES_DB && above_db(peak).is_some_and(|db| db >= LEAST_PROMINENCE_DB)
    };
    let off = |peak: &Peak| (peak.frequency_hz - expected_hz).abs();
    let Some(found) = peaks.iter().filter(is_line).min_by(|a, b| off(a).total_cmp(&off(b))) else {
        return Ok(NearestLine { above_db: above_db(highest), ..NearestLine::default() });
    };
    let line = spectrum.sinusoid(found).map_err(Error::Signal)?;
    Ok(NearestLine { hz: Some(line.frequency_hz), level_g: Some(line.amplitude), above_db: above_db(found) })
}

/// Level of a peak above the median on both sides of its group, the group itself left out.
fn prominence_db(spectrum: &Spectrum, peak: &Peak, (lowest, highest): (f64, f64)) -> Option<f64> {
    let width = spectrum.resolution().width_6db_hz;
    let limit = 0.5 * spectrum.sample_rate_hz();
    let half = (SURROUNDINGS_WIDTHS * width).max(0.1 * peak.frequency_hz);
    let (from, to) = ((peak.frequency_hz - half).max(0.0), (peak.frequency_hz + half).min(limit));
    let to_group = (peak.frequency_hz - lowest).abs().max((highest - peak.frequency_hz).abs());
    spectrum.stands_above_db(peak, from, to, EXCLUDED_WIDTHS * width + to_group).ok()
}

/// The strongest measured fundamental at `sensor`, if any line was measured there.
pub fn dominant<'a>(tones: &'a [Tone], sensor: &str) -> Option<&'a Tone> {
    let here = tones.iter().filter(|t| t.sensor == sensor && t.harmonic == 1 && t.measured_hz.is_some());
    here.max_by(|a, b| a.level_g.unwrap_or(0.0).total_cmp(&b.level_g.unwrap_or(0.0)))
}

/// The measured fundamental that stands out most at any sensor.
pub fn clearest(tones: &[Tone]) -> Option<&Tone> {
    let measured = tones.iter().filter(|t| t.harmonic == 1 && t.measured_hz.is_some());
    measured.max_by(|a, b| a.prominence_db.unwrap_or(0.0).total_cmp(&b.prominence_db.unwrap_or(0.0)))
}

impl PredictedLine {
    /// Expected frequencies of the line [Hz]: without slip and, when known, by the recorded motion.
    fn expected_hz(&self) -> impl Iterator<Item = f64> {
        [Some(self.predicted_hz), self.from_motion_hz].into_iter().flatten()
    }
}

impl Tone {
    fn unmeasured(sensor: &str, line: &PredictedLine) -> Self {
        Self {
            sensor: sensor.into(),
            name: line.name.clone(),
            harmonic: line.harmonic,
            predicted_hz: line.predicted_hz,
            from_motion_hz: line.from_motion_hz,
            measured_hz: None,
            level_g: None,
            prominence_db: None,
            unresolved_from: Vec::new(),
        }
    }
}
