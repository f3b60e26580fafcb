//! The speed of the shaft by its own lines, near the one that is given.
//!
//! Unbalance, misalignment and looseness make lines at multiples of the shaft's speed in the spectrum of the
//! record. A nominal speed may be some per cent off, which is more than a family's place can be: where the
//! lines stand, they correct it (THEORY §7.9).

use stribeck_dsp::{CombTest, Welch, WelchOptions, Whitened};

/// Largest distance of the given speed from the true one, either way.
const REACH: f64 = 0.07;
/// Multiples looked at, of which as many must stand as `needed` says.
const LINES: CombTest = CombTest { harmonics: 5, needed: 3 };
/// Turns that a record must hold: with fewer, combs in reach are not resolved.
const TURNS: f64 = 100.0;
/// Least height of the comb above the background [dB].
const LEAST_DB: f64 = 13.0;
/// How far it must lead every other comb in reach [dB].
const LEAST_LEAD_DB: f64 = 3.0;
/// Speeds closer to one another than this number of lines are one.
const SAME_LINES: f64 = 3.0;
/// Corrections below this part are within the tolerance of the families as it is.
const CORRECTED: f64 = 2e-3;

/// The shaft by its lines.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Shaft {
    /// Its speed [Hz].
    pub(crate) hz: f64,
    /// Half of the resolution over the highest multiple that was used [Hz].
    pub(crate) uncertainty_hz: f64,
    /// Height of the comb above the background [dB].
    pub(crate) height_db: f64,
    /// How far it leads the next one within reach [dB].
    pub(crate) lead_db: f64,
}

impl Shaft {
    /// Whether it is distinct from all other combs in reach.
    pub(crate) fn is_distinct(&self) -> bool {
        self.height_db >= LEAST_DB && self.lead_db >= LEAST_LEAD_DB
    }
}

/// Whether a speed lies farther from the given one than need not be corrected.
pub(crate) fn is_correction(hz: f64, given_hz: f64) -> bool {
    (hz / given_hz - 1.0).abs() > CORRECTED
}

/// The shaft's comb near `given_hz`; `None` for a record that does not resolve it.
pub(crate) fn near(samples: &[f64], rate_hz: f64, given_hz: f64) -> Option<Shaft> {
    if samples.len() as f64 / rate_hz * given_hz < TURNS {
        return None;
    }
    let mut welch = Welch::new(rate_hz, samples.len(), &WelchOptions::new(samples.len())).ok()?;
    let spectrum = welch.estimate(samples).ok()?;
    let grid_hz = rate_hz / samples.len() as f64;
    let highest_hz = (LINES.harmonics as f64 + 1.0) * (1.0 + REACH) * given_hz;
    let lines = ((highest_hz / grid_hz) as usize).min(spectrum.values().len());
    let whitened = Whitened::new(&spectrum.values()[..lines], grid_hz, 1).ok()?;
    let search = |low: f64, high: f64| LINES.search(&whitened, low, high).ok();
    let (low, high) = ((1.0 - REACH) * given_hz, (1.0 + REACH) * given_hz);
    let best = search(low, high)?;
    let hz = best.fundamental_hz;
    let others = [search(low, hz - SAME_LINES * grid_hz), search(hz + SAME_LINES * grid_hz, high)];
    let next = others.into_iter().flatten().map(|c| c.height).fold(1.0, f64::max);
    let height_db = 10.0 * best.height.max(1e-30).log10();
    Some(Shaft {
        hz,
        uncertainty_hz: 0.5 * grid_hz / LINES.harmonics as f64,
        height_db,
        lead_db: height_db - 10.0 * next.log10(),
    })
}
