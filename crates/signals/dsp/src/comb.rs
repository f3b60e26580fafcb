//! Does a spectrum hold a family of harmonics? A test whose false-alarm rate is known.
//!
//! The spectrum is divided by its own smoothed background, so that noise of any colour gives values with one
//! known distribution: the mean of `n` unit exponential variables for `n` averaged segments. A family stands
//! as high as the weakest of its strongest harmonics, `needed` of `harmonics`: one strong line is no
//! evidence. The frequency is searched, so the probability that noise reaches a height is multiplied by the
//! number of candidates (Bonferroni); neighbours are not independent, so the rate of false alarms stays below
//! it.

use crate::error::{check_positive, check_signal};
use crate::{Error, Result};

/// A spectrum over its background.
#[derive(Debug, Clone, PartialEq)]
pub struct Whitened {
    grid_hz: f64,
    segments: usize,
    ratios: Vec<f64>,
}

/// Definition of a family.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CombTest {
    /// Harmonics looked at.
    pub harmonics: usize,
    /// How many of them must stand out.
    pub needed: usize,
}

/// The best family of a search.
#[derive(Debug, Clone, PartialEq)]
pub struct Comb {
    /// Fundamental [Hz], from all harmonics.
    pub fundamental_hz: f64,
    /// Height over the background of the weakest harmonic that counts.
    pub height: f64,
    /// Height of each harmonic, from the first; 0 beyond the spectrum.
    pub ratios: Vec<f64>,
    /// Probability that noise reaches this height at any frequency of the search; at most 1.
    pub p_value: f64,
}

/// Lines of a block whose median is the background.
const BLOCK: usize = 101;
/// Distance of blocks.
const HOP: usize = 25;
/// Lines next to zero, disturbed by the removal of the mean.
const SKIPPED: usize = 3;

impl Whitened {
    /// Divides `values`, a power spectrum of `segments` averaged segments on a grid from zero, by the median
    /// of the lines around each, which noise exceeds as often as not.
    ///
    /// # Errors
    /// [`Error::TooShort`] for fewer than 101 lines, [`Error::NotFinite`], [`Error::NotPositive`] for the
    /// grid, [`Error::Undefined`] for a spectrum that is zero over a whole block.
    pub fn new(values: &[f64], grid_hz: f64, segments: usize) -> Result<Self> {
        check_positive("grid_hz", grid_hz)?;
        check_signal(values, BLOCK + SKIPPED, "a background of 101 lines")?;
        let used = &values[SKIPPED..];
        let mut sorted = Vec::with_capacity(BLOCK);
        let last = used.len() - BLOCK;
        let starts: Vec<usize> =
            (0..=last).step_by(HOP).chain((!last.is_multiple_of(HOP)).then_some(last)).collect();
        let mut medians = Vec::with_capacity(starts.len());
        for &start in &starts {
            sorted.clear();
            sorted.extend_from_slice(&used[start..start + BLOCK]);
            let (_, median, _) = sorted.select_nth_unstable_by(BLOCK / 2, f64::total_cmp);
            if *median <= 0.0 {
                let why = "it is zero over many lines; the record holds no noise";
                return Err(Error::Undefined { quantity: "background of the spectrum", why });
            }
            medians.push(*median);
        }
        let to_mean = 1.0 / median_over_mean(segments);
        let mut block = 0;
        let background = |n: usize| {
            let place = |b: usize| (starts[b] + BLOCK / 2) as f64;
            while block + 2 < starts.len() && place(block + 1) < n as f64 {
                block += 1;
            }
            if starts.len() == 1 {
                return medians[0];
            }
            let share = ((n as f64 - place(block)) / (place(block + 1) - place(block))).clamp(0.0, 1.0);
            medians[block].powf(1.0 - share) * medians[block + 1].powf(share)
        };
        let backgrounds: Vec<f64> = (0..used.len()).map(background).collect();
        let ratios = used.iter().zip(&backgrounds).map(|(v, b)| v / (b * to_mean));
        Ok(Self { grid_hz, segments, ratios: std::iter::repeat_n(0.0, SKIPPED).chain(ratios).collect() })
    }

    /// Distance of the lines [Hz].
    pub fn grid_hz(&self) -> f64 {
        self.grid_hz
    }

    /// Values over the background, the first at zero; the lines next to zero are 0.
    pub fn ratios(&self) -> &[f64] {
        &self.ratios
    }

    /// The higher of the two lines about a frequency, or 0 beyond the spectrum.
    pub fn at(&self, frequency_hz: f64) -> f64 {
        let below = (frequency_hz / self.grid_hz) as usize;
        self.ratios.get(below..below + 2).map_or(0.0, |two| two[0].max(two[1]))
    }

    /// Probability that noise makes one line as high as `ratio`.
    pub fn line_p_value(&self, ratio: f64) -> f64 {
        // Upper incomplete gamma function of whole order, Σ e^{−x} x^k/k! over k below the segments, term by
        // term in logarithms: e^{−x} alone would vanish.
        let x = self.segments as f64 * ratio;
        if x.is_nan() || x <= 0.0 {
            return 1.0;
        }
        let mut log = -x;
        let mut sum = log.exp();
        for k in 1..self.segments {
            log += (x / k as f64).ln();
            sum += log.exp();
        }
        sum.min(1.0)
    }
}

impl CombTest {
    /// Five harmonics, of which four must stand.
    pub const FOUR_OF_FIVE: Self = Self { harmonics: 5, needed: 4 };

    /// The highest family whose fundamental lies between two frequencies [Hz].
    ///
    /// # Errors
    /// [`Error::Band`] when the frequencies are not ordered or so high that fewer than `needed` harmonics are
    /// held.
    pub fn search(&self, spectrum: &Whitened, low_hz: f64, high_hz: f64) -> Result<Comb> {
        let limit_hz = (spectrum.ratios.len().saturating_sub(2)) as f64 * spectrum.grid_hz;
        let ordered = low_hz > 0.0 && low_hz <= high_hz;
        if !ordered || self.needed as f64 * high_hz > limit_hz {
            return Err(Error::Band { low_hz, high_hz, limit_hz: limit_hz / self.needed as f64 });
        }
        let step = self.step_hz(spectrum);
        let candidates = self.candidates(spectrum, high_hz - low_hz) as usize;
        let mut best = (f64::NEG_INFINITY, low_hz);
        let mut ratios = vec![0.0; self.harmonics];
        for n in 0..candidates {
            let hz = low_hz + n as f64 * step;
            ratios.iter_mut().enumerate().for_each(|(h, r)| *r = spectrum.at((h + 1) as f64 * hz));
            let (_, height, _) = ratios.select_nth_unstable_by(self.harmonics - self.needed, f64::total_cmp);
            if *height > best.0 {
                best = (*height, hz);
            }
        }
        let (height, hz) = best;
        let ratios: Vec<f64> = (1..=self.harmonics).map(|h| spectrum.at(h as f64 * hz)).collect();
        // Below the smallest number a probability is still no certainty.
        let p_value = (candidates as f64 * self.p_value(spectrum, height)).clamp(f64::MIN_POSITIVE, 1.0);
        Ok(Comb { fundamental_hz: self.refined(spectrum, hz), height, ratios, p_value })
    }

    /// Distance of the fundamentals that are tried: half a line at the highest harmonic [Hz].
    fn step_hz(&self, spectrum: &Whitened) -> f64 {
        spectrum.grid_hz / (2 * self.harmonics) as f64
    }

    /// Fundamentals that a search over a range [Hz] tries.
    pub fn candidates(&self, spectrum: &Whitened, range_hz: f64) -> f64 {
        (range_hz / self.step_hz(spectrum)).floor() + 1.0
    }

    /// Probability that noise makes a family of this height at one frequency.
    fn p_value(&self, spectrum: &Whitened, height: f64) -> f64 {
        let line = spectrum.line_p_value(height);
        // Either of two lines; neighbours under a Hann window are alike, so this is an upper bound.
        let either = (2.0 * line - line * line).min(1.0);
        (self.needed..=self.harmonics)
            .map(|k| {
                let ways: f64 = (0..k).map(|i| (self.harmonics - i) as f64 / (i + 1) as f64).product();
                ways * either.powi(k as i32) * (1.0 - either).powi((self.harmonics - k) as i32)
            })
            .sum()
    }

    /// Fundamental from the centres of its harmonics; those that stand higher and those of higher order count
    /// more.
    fn refined(&self, spectrum: &Whitened, hz: f64) -> f64 {
        let (mut sum, mut weights) = (0.0, 0.0);
        for h in 1..=self.harmonics {
            let at = (h as f64 * hz / spectrum.grid_hz).round() as usize;
            let Some(lines) = spectrum.ratios.get(at.saturating_sub(1)..at + 2) else { continue };
            let total: f64 = lines.iter().sum();
            if total <= 0.0 {
                continue;
            }
            let centre = at as f64 + (lines[2] - lines[0]) / total;
            let weight = (1.0 + total).ln() * (h * h) as f64;
            sum += weight * centre * spectrum.grid_hz / h as f64;
            weights += weight;
        }
        if weights > 0.0 { sum / weights } else { hz }
    }
}

/// Median of the mean of `n` unit exponential variables, over their mean.
fn median_over_mean(n: usize) -> f64 {
    match n {
        0 | 1 => std::f64::consts::LN_2,
        // E. B. Wilson and M. M. Hilferty, Proc. Natl. Acad. Sci. 17 (1931) 684–688.
        n => (1.0 - 1.0 / (9.0 * n as f64)).powi(3),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_the_tail_of_averaged_exponentials() {
        // One segment: e^{−r}. Two: e^{−2r}(1 + 2r), the Erlang distribution (A. K. Erlang, 1917).
        let of = |segments| Whitened { grid_hz: 1.0, segments, ratios: Vec::new() };
        assert!((of(1).line_p_value(3.0) - (-3.0_f64).exp()).abs() < 1e-15);
        assert!((of(2).line_p_value(3.0) - (-6.0_f64).exp() * 7.0).abs() < 1e-15);
    }

    /// One segment reaches ln 2 at one line in two, at either of two at three in four; of five harmonics four or
    /// all do at 5 · ¾⁴ · ¼ + ¾⁵.
    #[test]
    fn by_hand_four_harmonics_of_five_by_chance() {
        let noise = Whitened { grid_hz: 1.0, segments: 1, ratios: vec![0.0; 4] };
        let p_value = CombTest::FOUR_OF_FIVE.p_value(&noise, 2.0_f64.ln());
        assert!((p_value - 0.632_812_5).abs() < 1e-14, "{p_value}");
        // Beyond the last line there is nothing.
        assert_eq!((noise.at(2.5), noise.at(3.0), noise.at(1e9)), (0.0, 0.0, 0.0));
    }

    /// Lines of 1, 4 and 3 about 10 Hz have their centre at 10 + 2/8, lines of 1, 2 and 1 about 20 Hz at 20: the
    /// first with the weight ln 9, the second, of half of it, with 4 ln 5.
    #[test]
    fn by_hand_the_fundamental_lies_between_the_centres_of_its_harmonics() {
        let mut ratios = vec![0.0; 30];
        ratios[9..12].copy_from_slice(&[1.0, 4.0, 3.0]);
        ratios[19..22].copy_from_slice(&[1.0, 2.0, 1.0]);
        let spectrum = Whitened { grid_hz: 1.0, segments: 1, ratios };
        let (first, second) = (9.0_f64.ln(), 4.0 * 5.0_f64.ln());
        let expected = (10.25 * first + 10.0 * second) / (first + second);
        let found = CombTest { harmonics: 2, needed: 2 }.refined(&spectrum, 10.1);
        assert!((found - expected).abs() < 1e-12, "{found} Hz, not {expected} Hz");
        // Nothing stands there: the frequency stays.
        assert_eq!(CombTest { harmonics: 2, needed: 2 }.refined(&spectrum, 3.0), 3.0);
    }
}
