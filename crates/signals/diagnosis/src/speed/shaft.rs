//! The speed of the shaft by its own lines, near the one that is given.
//!
//! Unbalance, misalignment and looseness make lines at multiples of the shaft's speed in the spectrum of the
//! record. A nominal speed may be some per cent off, which is more than a family's place can be: where the
//! lines stand, they correct it (THEORY §7.9).

use stribeck_dsp::{CombTest, Welch, WelchOptions, Whitened};
use stribeck_theory::catalogue::CatalogueBearing;

use crate::families::unrelated::SLIP;
use crate::speed::estimate::OF_FAMILY;

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
/// Multiples of the shaft among which lines are sought that are no family's, and how many of them must stand.
const CLEAR: u32 = 8;
const SUPPORT: usize = 2;
/// Speeds closer to one another than this number of lines are one.
const SAME_LINES: f64 = 3.0;
/// Corrections below this part are taken without a word.
const CORRECTED: f64 = 2e-3;

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
    /// Enough of its lines are no family's, and more than stand at the given speed.
    pub(crate) is_supported: bool,
}

impl Shaft {
    /// Whether it is distinct from all other combs in reach.
    pub(crate) fn is_distinct(&self) -> bool {
        self.height_db >= LEAST_DB && self.lead_db >= LEAST_LEAD_DB && self.is_supported
    }
}

/// Whether a speed lies farther from the given one than need not be corrected.
pub(crate) fn is_correction(hz: f64, given_hz: f64) -> bool {
    (hz / given_hz - 1.0).abs() > CORRECTED
}

/// The shaft's comb near `given_hz`; `None` for a record that does not resolve it. Multiples at which lines of
/// the bearing may stand, by this speed or by the given one, do not support it: in a 6203 BPFO is 3.05 times
/// the shaft and BPFI 4.95 times.
pub(crate) fn near(
    samples: &[f64],
    rate_hz: f64,
    given_hz: f64,
    bearing: Option<&CatalogueBearing>,
) -> Option<Shaft> {
    if samples.len() as f64 / rate_hz * given_hz < TURNS {
        return None;
    }
    let mut welch = Welch::new(rate_hz, samples.len(), &WelchOptions::new(samples.len())).ok()?;
    let spectrum = welch.estimate(samples).ok()?;
    let grid_hz = rate_hz / samples.len() as f64;
    let highest_hz = f64::from(CLEAR + 1) * (1.0 + REACH) * given_hz;
    let lines = ((highest_hz / grid_hz) as usize).min(spectrum.values().len());
    let whitened = Whitened::new(&spectrum.values()[..lines], grid_hz, 1).ok()?;
    let search = |low: f64, high: f64| LINES.search(&whitened, low, high).ok();
    let (low, high) = ((1.0 - REACH) * given_hz, (1.0 + REACH) * given_hz);
    let best = search(low, high)?;
    let hz = best.fundamental_hz;
    let others = [search(low, hz - SAME_LINES * grid_hz), search(hz + SAME_LINES * grid_hz, high)];
    let next = others.into_iter().flatten().map(|c| c.height).fold(1.0, f64::max);
    let height_db = 10.0 * best.height.max(1e-30).log10();
    let orders = bearing.and_then(|bearing| bearing.orders().ok());
    let families: Vec<f64> = orders.iter().flat_map(|o| [o.bpfo, o.bpfi, 2.0 * o.bsf]).collect();
    let is_of_a_family = |line_hz: f64, shaft_hz: f64| {
        let mut multiples = families.iter().flat_map(|o| (1..=OF_FAMILY).map(move |m| f64::from(m) * o));
        multiples.any(|order| (line_hz / (order * shaft_hz) - 1.0).abs() < SLIP)
    };
    let least = 10.0_f64.powf(0.1 * LEAST_DB);
    let support = |shaft_hz: f64| {
        let lines = (1..=CLEAR).map(|k| f64::from(k) * shaft_hz);
        let clear = lines.filter(|line| !is_of_a_family(*line, hz) && !is_of_a_family(*line, given_hz));
        clear.filter(|line| whitened.at(*line) >= least).count()
    };
    let (here, there) = (support(hz), support(given_hz));
    // The lines of speeds so near to one another are the same.
    let is_near = (hz - given_hz).abs() < SAME_LINES * grid_hz || !is_correction(hz, given_hz);
    let is_supported = here >= SUPPORT && (here > there || is_near);
    Some(Shaft {
        is_supported,
        hz,
        uncertainty_hz: 0.5 * grid_hz / LINES.harmonics as f64,
        height_db,
        lead_db: height_db - 10.0 * next.log10(),
    })
}
