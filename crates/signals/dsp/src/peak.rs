//! Lines in a spectrum: where, how strong, and how far above what surrounds them.

use crate::error::check_positive;
use crate::{Error, Result, Spectrum};

/// Highest point of a spectrum in a band.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Peak {
    /// Index of the highest value of the grid.
    pub bin: usize,
    /// Frequency [Hz] of the vertex of the parabola through the decibel values of the highest bin and its
    /// neighbours. Against an isolated line it errs by up to 0.02 resolutions without zero padding;
    /// [`Spectrum::sinusoid`] does not.
    pub frequency_hz: f64,
    /// Level of that vertex [dB re 1 unit²/Hz or 1 unit²].
    pub level_db: f64,
    /// True when the spectrum keeps rising past the band's end: this is the flank of something outside,
    /// nothing is interpolated, and the band should be widened.
    pub at_edge: bool,
}

/// A sinusoid read from a spectrum.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sinusoid {
    /// Frequency [Hz].
    pub frequency_hz: f64,
    /// Peak amplitude [unit of the signal], √2 times the root mean square.
    pub amplitude: f64,
}

impl Spectrum {
    /// Highest point from `low_hz` to `high_hz` (both included), interpolated between grid points.
    ///
    /// # Errors
    /// [`Error::Band`] for a band that leaves the spectrum, [`Error::BandTooNarrow`] for one without a grid
    /// point, [`Error::Undefined`] when the spectrum is zero there.
    pub fn peak(&self, low_hz: f64, high_hz: f64) -> Result<Peak> {
        let mut bin = 0;
        let mut highest = 0.0;
        for candidate in self.band(low_hz, high_hz, 1)? {
            if self.one_sided(candidate) > highest {
                (bin, highest) = (candidate, self.one_sided(candidate));
            }
        }
        if highest == 0.0 {
            let why = "the spectrum is zero in this band; choose another band";
            return Err(Error::Undefined { quantity: "peak", why });
        }
        let [left, centre, right] = self.around(bin).map(decibel);
        let at_edge = left > centre || right > centre;
        let bend = left - 2.0 * centre + right;
        // The parabola needs two finite neighbours and a bend; a line of one single bin is its own vertex.
        let usable = !at_edge && bend.is_finite() && bend < 0.0;
        let offset = if usable { 0.5 * (left - right) / bend } else { 0.0 };
        let rise = if usable { -0.25 * (left - right) * offset } else { 0.0 };
        let grid_hz = self.layout.resolution.grid_hz;
        Ok(Peak { bin, frequency_hz: (bin as f64 + offset) * grid_hz, level_db: centre + rise, at_edge })
    }

    /// Frequency and amplitude of the sinusoid that would make `peak`, corrected for the window.
    ///
    /// The ratio of the two highest values of the grid fixes where between them the line stands, and the
    /// transform of the window gives the factor by which they read too low. For one steady sinusoid without
    /// noise this is exact up to the leakage of its mirror image at the negative frequency. Noise of density
    /// S [unit²/Hz] under the line shakes the amplitude read from one segment by about √(S · noise
    /// bandwidth). An intermittent line reads as the root of its mean power.
    ///
    /// # Errors
    /// [`Error::Undefined`] for a peak at zero or half the sample rate, where a line and its mirror image
    /// coincide, or outside this spectrum.
    pub fn sinusoid(&self, peak: &Peak) -> Result<Sinusoid> {
        let layout = &self.layout;
        if peak.bin >= layout.positive_bins() || layout.is_alone(peak.bin) {
            let why = "the peak lies at zero or half the sample rate; search the band between";
            return Err(Error::Undefined { quantity: "sinusoid amplitude", why });
        }
        let [left, centre, right] = self.around(peak.bin);
        let (neighbour, side) = if right >= left { (right, 1.0) } else { (left, -1.0) };
        let window = layout.resolution.window;
        let spacing = layout.segment as f64 / layout.nfft as f64;
        let response = |grid_steps: f64| window.response(layout.segment, grid_steps * spacing);

        // The ratio of the neighbour's to the centre's response rises with the offset and is 1 at half a
        // step.
        let wanted = (neighbour / centre).sqrt();
        let (mut low, mut high) = (0.0, 0.5);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if response(1.0 - middle)? < wanted * response(middle)? { low = middle } else { high = middle }
        }
        let offset = 0.5 * (low + high);
        let power = centre * self.to_power() * layout.line_bias / response(offset)?.powi(2);
        Ok(Sinusoid {
            frequency_hz: (peak.bin as f64 + side * offset) * layout.resolution.grid_hz,
            amplitude: (2.0 * power).sqrt(),
        })
    }

    /// How far the peak stands above its surroundings [dB]: its level less that of the median of the values
    /// from `low_hz` to `high_hz` that are more than `exclusion_hz` away from it.
    ///
    /// The exclusion should be at least the width at −6 dB, or the line's own skirt counts as surroundings.
    /// Positive when the peak is higher.
    ///
    /// # Errors
    /// [`Error::NotPositive`] for the exclusion, [`Error::Band`] for a band that leaves the spectrum,
    /// [`Error::BandTooNarrow`] when fewer than three values remain, [`Error::Undefined`] when their median
    /// is zero.
    pub fn stands_above_db(&self, peak: &Peak, low_hz: f64, high_hz: f64, exclusion_hz: f64) -> Result<f64> {
        const LEAST: usize = 3;
        check_positive("exclusion_hz", exclusion_hz)?;
        let grid_hz = self.layout.resolution.grid_hz;
        let far = |bin: &usize| (*bin as f64 * grid_hz - peak.frequency_hz).abs() > exclusion_hz;
        let mut around: Vec<f64> =
            self.band(low_hz, high_hz, 1)?.filter(far).map(|bin| self.one_sided(bin)).collect();
        if around.len() < LEAST {
            return Err(Error::BandTooNarrow { low_hz, high_hz, bins: around.len(), least: LEAST, grid_hz });
        }
        let middle = around.len() / 2;
        let (_, &mut median, _) = around.select_nth_unstable_by(middle, f64::total_cmp);
        if median == 0.0 {
            let why = "the median of the surroundings is zero; widen the band";
            return Err(Error::Undefined { quantity: "level above the surroundings", why });
        }
        Ok(peak.level_db - decibel(median))
    }

    /// Values at a bin and its two neighbours; the spectrum is even about zero and half the sample rate.
    fn around(&self, bin: usize) -> [f64; 3] {
        let last = self.layout.positive_bins() - 1;
        let left = if bin == 0 { 1 } else { bin - 1 };
        let right = if bin < last {
            bin + 1
        } else if self.layout.is_alone(bin) {
            last - 1
        } else {
            last
        };
        [left, bin, right].map(|bin| self.one_sided(bin))
    }

    /// Factor from this spectrum's values to a power spectrum.
    fn to_power(&self) -> f64 {
        match self.layout.scaling {
            crate::Scaling::Density => self.layout.resolution.noise_bandwidth_hz,
            crate::Scaling::Spectrum => 1.0,
        }
    }
}

fn decibel(power: f64) -> f64 {
    10.0 * power.log10()
}
