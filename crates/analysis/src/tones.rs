//! Predicted facet-passing lines, and the levels of the spectrum at their frequencies.
//!
//! Lines closer than the resolution are searched as one and marked so: a record of 30 ms merges lines
//! within 67 Hz, and the passing of roller vertices and of raceway nodes often is.

use serde::{Deserialize, Serialize};
use stribeck_dsp::{Peak, Resolution, Spectrum};

use crate::Error;

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
    /// Frequency of the highest line within reach of the prediction [Hz]; `None` when no peak there stands at
    /// least [`LEAST_PROMINENCE_DB`] above its surroundings.
    pub measured_hz: Option<f64>,
    /// Peak amplitude of the measured line [g].
    pub level_g: Option<f64>,
    /// How far the highest peak within reach stands above the median of its surroundings [dB], line or not.
    pub prominence_db: Option<f64>,
    /// Other predicted lines that this spectrum does not resolve from this one.
    pub unresolved_from: Vec<String>,
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
///
/// # Errors
/// [`Error::Signal`] when the spectrum cannot be searched.
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

#[cfg(test)]
mod tests {
    use super::*;
    use stribeck_dsp::Welch;

    const SAMPLE_RATE_HZ: f64 = 100_000.0;

    fn paper_lines() -> Vec<PredictedLine> {
        let of = |name: &str, hz| (name.to_owned(), hz);
        harmonics(
            &[of("roller vertices", 4671.7), of("outer nodes", 4719.0), of("inner nodes", 4716.0)],
            3,
            5e4,
        )
    }

    fn spectrum_of(signal: &[f64]) -> Spectrum {
        Welch::for_grid(SAMPLE_RATE_HZ, signal.len(), 3.0).unwrap().estimate(signal).unwrap()
    }

    fn tone_in_noise(samples: usize) -> Vec<f64> {
        let mut seed = 7u64;
        (0..samples)
            .map(|n| {
                seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                let noise = (seed >> 40) as f64 / (1u64 << 24) as f64 - 0.5;
                40.0 * (std::f64::consts::TAU * 4674.0 * n as f64 / SAMPLE_RATE_HZ).sin() + 20.0 * noise
            })
            .collect()
    }

    #[test]
    fn example_a_tone_in_noise_is_measured_and_merged() {
        // Uniform noise of ±10 g has a density of 33.3/50 000 g²/Hz: under 50 Hz it moves 40 g by about 0.4
        // g.
        const LEVEL_TOLERANCE_G: f64 = 1.5;
        let tones = measure("side", &paper_lines(), &spectrum_of(&tone_in_noise(3000))).unwrap();
        let roller = &tones[0];
        assert!((roller.measured_hz.unwrap() - 4674.0).abs() < 2.0, "{roller:?}");
        assert!((roller.level_g.unwrap() - 40.0).abs() < LEVEL_TOLERANCE_G, "{roller:?}");
        assert!(roller.prominence_db.unwrap() > 30.0, "{roller:?}");
        assert_eq!(roller.unresolved_from, ["inner nodes ×1", "outer nodes ×1"]);
        // 4674 Hz is out of reach of the raceway lines: hidden, not measured.
        assert_eq!((tones[1].measured_hz, tones[2].measured_hz), (None, None));
        // The third harmonics lie 133 Hz apart: resolved, except the two raceways.
        assert!(tones[6].unresolved_from.is_empty() && tones[7].unresolved_from.len() == 1);
        assert_eq!(dominant(&tones, "side"), Some(&tones[0]));
        assert_eq!((dominant(&tones, "bottom"), clearest(&tones)), (None, Some(&tones[0])));
    }

    #[test]
    fn example_a_long_record_splits_the_lines() {
        // 0.3 s resolve 3.3 Hz: the line 2.3 Hz above the prediction belongs to the rollers alone.
        let tones = measure("side", &paper_lines(), &spectrum_of(&tone_in_noise(30_000))).unwrap();
        assert!(tones[0].unresolved_from.is_empty());
        assert!((tones[0].measured_hz.unwrap() - 4674.0).abs() < 0.5);
        assert!(tones[0].level_g.unwrap() > 20.0 * tones[1].level_g.unwrap_or(0.0), "{:?}", &tones[..3]);
    }

    #[test]
    fn example_recorded_motion_claims_a_line_that_slip_has_moved() {
        // Rollers 1 % slower than rolling: the line is out of reach of the prediction without slip.
        let mut lines = harmonics(&[("roller vertices".into(), 4721.2)], 1, 5e4);
        let signal = tone_in_noise(30_000);
        assert_eq!(measure("side", &lines, &spectrum_of(&signal)).unwrap()[0].measured_hz, None);
        lines[0].from_motion_hz = Some(4674.5);
        let found = measure("side", &lines, &spectrum_of(&signal)).unwrap()[0].measured_hz;
        assert!((found.unwrap() - 4674.0).abs() < 0.5, "{found:?}");
    }

    /// 36 g at 4775 Hz, 104 Hz away and out of reach, 12 g at 4655 Hz, and 4 g at five times the latter, in
    /// noise of ±10 g.
    #[test]
    fn example_the_nearest_line_beside_a_stronger_one() {
        let line = |hz: f64, t: f64| (std::f64::consts::TAU * hz * t).sin();
        let noise = tone_in_noise(3000);
        let signal: Vec<f64> = (0..3000)
            .map(|n| (n as f64 / SAMPLE_RATE_HZ, noise[n] - 40.0 * line(4674.0, n as f64 / SAMPLE_RATE_HZ)))
            .map(|(t, rest)| 36.0 * line(4775.0, t) + 12.0 * line(4655.0, t) + 4.0 * line(23_275.0, t) + rest)
            .collect();
        let spectrum = spectrum_of(&signal);
        let found = nearest(&spectrum, 4671.0).unwrap();
        // Noise of 0.0007 g²/Hz under 50 Hz moves a frequency by a few hertz and 12 g by some tenths.
        assert!((found.hz.unwrap() - 4655.0).abs() < 5.0, "{found:?}");
        assert!((found.level_g.unwrap() - 12.0).abs() < 1.0, "{found:?}");
        assert!(found.above_db.unwrap() > 20.0, "{found:?}");
        let fifth = nearest(&spectrum, 5.0 * 4655.0).unwrap();
        assert!((fifth.hz.unwrap() - 23_275.0).abs() < 10.0 && fifth.above_db.unwrap() > 10.0, "{fifth:?}");
        // No line elsewhere; the height of the highest peak is returned nevertheless.
        let none = nearest(&spectrum, 11_000.0).unwrap();
        assert!(none.hz.is_none() && none.above_db.is_some_and(|db| db < 10.0), "{none:?}");
        let silence = spectrum_of(&vec![0.0; 3000]);
        assert_eq!(nearest(&silence, 4671.0).unwrap(), NearestLine::default());
        assert_eq!(nearest(&spectrum, 90_000.0).unwrap(), NearestLine::default());
    }

    #[test]
    fn example_silence_measures_nothing() {
        let tones = measure("side", &paper_lines(), &spectrum_of(&vec![0.0; 3000])).unwrap();
        assert!(tones.iter().all(|t| t.measured_hz.is_none() && t.level_g.is_none()));
        assert_eq!((dominant(&tones, "side"), clearest(&tones)), (None, None));
    }

    #[test]
    fn invariant_no_harmonic_reaches_half_the_sample_rate() {
        let lines = harmonics(&[("a".into(), 20_000.0)], 6, 50_000.0);
        assert_eq!(lines.iter().map(|l| l.harmonic).collect::<Vec<_>>(), [1, 2]);
    }
}
