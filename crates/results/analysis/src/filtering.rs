//! The notch at the facet tone: its attenuation, and the length of its transient.

use serde::{Deserialize, Serialize};
use stribeck_dsp::{Notch, Welch, WelchOptions, Window};

use crate::Error;
use stribeck_diagnosis::quantities;

/// Quality factor of the paper's notch.
pub const QUALITY: f64 = 15.0;
/// Centre of the paper's notch [Hz].
pub const PAPER_CENTRE_HZ: f64 = 4671.0;
/// The other tone that the paper reads from its trace [Hz]: a cursor artefact, 100 kHz / 22.
pub const PAPER_BEAT_HZ: f64 = 4545.0;
/// The transient counts as over when the filter's ringing has fallen by this much [dB].
const SETTLED_DB: f64 = 60.0;

quantities! {
    /// Attenuation of a tone by the notch, for the summary.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    pub struct NotchFinding {
        /// Centre [Hz]: the measured dominant facet tone, or the predicted one when none
        /// is measured anywhere.
        pub centre_hz: f64,
        /// Centre of the paper's notch [Hz]; this and the numbers at 4545 Hz exist for the
        /// paper's scene only.
        pub paper_centre_hz: Option<f64>,
        /// Quality factor.
        pub q: f64,
        /// Full width at −3 dB [Hz].
        pub width_hz: f64,
        /// Time constant of the ringing [s].
        pub time_constant_s: f64,
        /// Time until the ringing has fallen by 60 dB [s]: earlier samples are partly the filter's own.
        pub transient_s: f64,
        /// Drop of the density at the centre [dB]: Hann window, whole record, transient included. The number
        /// to set beside the paper's 25 dB.
        pub attenuation_db: Option<f64>,
        /// The same with the transient left out.
        pub attenuation_settled_db: Option<f64>,
        /// The same with a boxcar window, transient included.
        pub attenuation_boxcar_db: Option<f64>,
        /// The same with a boxcar window, transient left out.
        pub attenuation_boxcar_settled_db: Option<f64>,
        /// Attenuation of a steady 4545 Hz [dB], from the transfer function.
        pub attenuation_4545_db: Option<f64>,
        /// The same of the paper's own notch, centred at 4671 Hz: −20 log |H(4545 Hz)| from the coefficients.
        pub paper_4545_db: Option<f64>,
    }
}

/// A notch made for one record.
#[derive(Debug, Clone, Copy)]
pub struct Filter {
    notch: Notch,
    settled: usize,
}

impl Filter {
    /// A notch at `centre_hz` with the paper's quality factor.
    ///
    /// # Errors
    /// [`Error::Signal`] when the centre does not lie below half the sample rate.
    pub fn new(sample_rate_hz: f64, centre_hz: f64) -> Result<Self, Error> {
        let notch = Notch::new(sample_rate_hz, centre_hz, QUALITY).map_err(Error::Signal)?;
        let settled = notch.transient_samples(SETTLED_DB).map_err(Error::Signal)?;
        Ok(Self { notch, settled })
    }

    /// Centre [Hz].
    pub fn centre_hz(&self) -> f64 {
        self.notch.centre_hz()
    }

    /// Length of the transient [s].
    pub fn transient_s(&self) -> f64 {
        self.settled as f64 / self.notch.sample_rate_hz()
    }

    /// An acceleration behind the notch, from rest.
    ///
    /// # Errors
    /// [`Error::Signal`] for a record that is empty or not finite.
    pub fn acceleration(&self, signal: &[f64]) -> Result<Vec<f64>, Error> {
        self.notch.filter(signal).map_err(Error::Signal)
    }

    /// A force behind the notch, which starts as if the first value had always been there: a preloaded
    /// contact has.
    ///
    /// # Errors
    /// [`Error::Signal`] for a record that is empty or not finite.
    pub fn force(&self, signal: &[f64]) -> Result<Vec<f64>, Error> {
        self.notch.filter_from_first(signal).map_err(Error::Signal)
    }

    /// Drop of the density at the centre [dB] from `raw` to `filtered`, its filtered form: Hann window, whole
    /// record, transient included. `None` for a record of less than eight periods.
    pub fn attenuation_db(&self, raw: &[f64], filtered: &[f64]) -> Option<f64> {
        self.drop_db(Window::Hann, raw, filtered)
    }

    /// The same with any window.
    fn drop_db(&self, window: Window, raw: &[f64], filtered: &[f64]) -> Option<f64> {
        let level_db = |signal| at_centre(self.notch.sample_rate_hz(), self.centre_hz(), window, signal);
        Some(level_db(raw)? - level_db(filtered)?)
    }

    /// Effect of the notch on `raw`, whose filtered form is `filtered`; whether it is a record of the paper's
    /// scene.
    pub fn finding(&self, raw: &[f64], filtered: &[f64], of_paper: bool) -> NotchFinding {
        let rate = self.notch.sample_rate_hz();
        let drop = |window, from: usize| self.drop_db(window, raw.get(from..)?, filtered.get(from..)?);
        let taken = |notch: &Notch| {
            let db = notch.magnitude_db(PAPER_BEAT_HZ).ok().filter(|_| of_paper)?;
            Some(-db).filter(|db| db.is_finite())
        };
        NotchFinding {
            centre_hz: self.centre_hz(),
            paper_centre_hz: of_paper.then_some(PAPER_CENTRE_HZ),
            q: self.notch.quality(),
            width_hz: self.notch.width_hz(),
            time_constant_s: self.notch.time_constant_s(),
            transient_s: self.transient_s(),
            attenuation_db: drop(Window::Hann, 0),
            attenuation_settled_db: drop(Window::Hann, self.settled),
            attenuation_boxcar_db: drop(Window::Boxcar, 0),
            attenuation_boxcar_settled_db: drop(Window::Boxcar, self.settled),
            attenuation_4545_db: taken(&self.notch),
            paper_4545_db: Notch::new(rate, PAPER_CENTRE_HZ, QUALITY).ok().as_ref().and_then(taken),
        }
    }
}

/// Highest density [dB] within half a resolution of `centre_hz`, the record as one segment, padded fourfold.
fn at_centre(sample_rate_hz: f64, centre_hz: f64, window: Window, signal: &[f64]) -> Option<f64> {
    // Least number of periods of a tone that count as a line.
    const LEAST_PERIODS: f64 = 8.0;
    let samples = signal.len();
    if (samples as f64) < LEAST_PERIODS * sample_rate_hz / centre_hz {
        return None;
    }
    let options = WelchOptions { window, nfft: 4 * samples, ..WelchOptions::new(samples) };
    let spectrum = Welch::new(sample_rate_hz, samples, &options).ok()?.estimate(signal).ok()?;
    let half = 0.5 * sample_rate_hz / samples as f64;
    let peak = spectrum.peak(centre_hz - half, centre_hz + half).ok()?;
    Some(10.0 * spectrum.values().get(peak.bin)?.log10()).filter(|db| db.is_finite())
}
