//! Readings of a cursor between two sampled peaks: whole numbers of samples only.
//!
//! The paper reads 4545 Hz from the distance of two peaks. At 100 kHz that is 22 samples, and its neighbours
//! are 4348 Hz (23) and 4762 Hz (21): nothing between them can be read.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use stribeck_diagnosis::quantities;

/// How often each distance between neighbouring peaks occurs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Gaps {
    /// Distance [samples] and its share of all distances, ascending.
    pub share: Vec<(usize, f64)>,
    /// Mean distance as a frequency [Hz].
    pub mean_hz: f64,
}

quantities! {
    /// Possible readings behind the paper's 4545 Hz.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    pub struct CursorReading {
        /// Distance of two samples that reads nearest to the paper's number.
        pub samples: usize,
        /// Frequency of that distance [Hz].
        pub reads_hz: f64,
        /// The neighbouring readings [Hz]: one sample more, one sample less.
        pub neighbours_hz: (f64, f64),
        /// Share of peaks of a pure tone at the roller line that are this far apart.
        pub share_in_tone: f64,
        /// The same in the paper's equation (3).
        pub share_in_equation_3: f64,
        /// The most common distance of its peaks [samples] and its share.
        pub equation_3_common: (usize, f64),
        /// Its carrier, the mean of its tones [Hz]: the rate of peaks within a swell. At each node of the
        /// beat there is one more peak, so that peaks are as many as periods of the higher tone.
        pub equation_3_carrier_hz: f64,
    }
}

/// The paper's equation (3): two unit cosines [Hz], sampled.
pub fn equation_3(first_hz: f64, second_hz: f64, sample_rate_hz: f64, samples: usize) -> Vec<f64> {
    let value = |n: usize| {
        let t = n as f64 / sample_rate_hz;
        (TAU * first_hz * t).cos() + (TAU * second_hz * t).cos()
    };
    (0..samples).map(value).collect()
}

/// Distances between neighbouring maxima of a sampled signal.
pub fn gaps(signal: &[f64], sample_rate_hz: f64) -> Option<Gaps> {
    let is_peak = |w: &[f64]| w[1] > w[0] && w[1] >= w[2];
    let peaks: Vec<usize> =
        signal.windows(3).enumerate().filter(|(_, w)| is_peak(w)).map(|(n, _)| n + 1).collect();
    let (first, last) = (peaks.first()?, peaks.last()?);
    if last == first {
        return None;
    }
    let mut counts = std::collections::BTreeMap::new();
    for pair in peaks.windows(2) {
        *counts.entry(pair[1] - pair[0]).or_insert(0usize) += 1;
    }
    let total = (peaks.len() - 1) as f64;
    Some(Gaps {
        share: counts.into_iter().map(|(gap, count)| (gap, count as f64 / total)).collect(),
        mean_hz: sample_rate_hz * total / (last - first) as f64,
    })
}

impl Gaps {
    /// The distance that occurs most often [samples], and its share.
    pub fn most_common(&self) -> (usize, f64) {
        self.share.iter().copied().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((0, 0.0))
    }

    /// Share of one distance [samples].
    pub fn share_of(&self, samples: usize) -> f64 {
        self.share.iter().find(|s| s.0 == samples).map_or(0.0, |s| s.1)
    }
}

impl CursorReading {
    /// How the reading `read_hz` arises at this sample rate, for a tone at `tone_hz` and the paper's pair of
    /// tones.
    pub fn of(read_hz: f64, sample_rate_hz: f64, tone_hz: f64, pair_hz: (f64, f64)) -> Option<Self> {
        // Long enough that shares are those of the tones, not of their phases.
        const SAMPLES: usize = 100_000;
        let samples = (sample_rate_hz / read_hz).round() as usize;
        if samples < 2 {
            return None;
        }
        let tone: Vec<f64> =
            (0..SAMPLES).map(|n| (TAU * tone_hz * n as f64 / sample_rate_hz).cos()).collect();
        let in_tone = gaps(&tone, sample_rate_hz)?;
        let in_pair = gaps(&equation_3(pair_hz.0, pair_hz.1, sample_rate_hz, SAMPLES), sample_rate_hz)?;
        Some(Self {
            samples,
            reads_hz: sample_rate_hz / samples as f64,
            neighbours_hz: (sample_rate_hz / (samples + 1) as f64, sample_rate_hz / (samples - 1) as f64),
            share_in_tone: in_tone.share_of(samples),
            share_in_equation_3: in_pair.share_of(samples),
            equation_3_common: in_pair.most_common(),
            equation_3_carrier_hz: 0.5 * (pair_hz.0 + pair_hz.1),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_hand_a_pure_tone_shows_two_distances_in_proportion() {
        // 100 000/4671 = 21.409 samples: 22 in 40.9 % of the cases, 21 in the others.
        let reading = CursorReading::of(4545.0, 1e5, 4671.0, (4712.0, 3864.0)).unwrap();
        assert_eq!(reading.samples, 22);
        assert!((reading.reads_hz - 4545.45).abs() < 0.01);
        assert!((reading.share_in_tone - 0.409).abs() < 0.002, "{reading:?}");
        // The carrier of equation (3), 4288 Hz, is 23.3 samples long, so most gaps are 23.
        assert_eq!((reading.equation_3_common.0, reading.equation_3_carrier_hz), (23, 4288.0));
        // Zeros of a product add up: 2·4288 of the carrier and 848 of the swell make 4712 peaks a second.
        let peaks = gaps(&equation_3(4712.0, 3864.0, 1e5, 100_000), 1e5).unwrap().mean_hz;
        assert!((peaks - 4712.0).abs() < 1.0, "{peaks}");
    }

    #[test]
    fn behaves_silence_has_no_gaps() {
        assert_eq!(gaps(&[0.0; 50], 1e5), None);
        assert_eq!(gaps(&[], 1e5), None);
    }
}
