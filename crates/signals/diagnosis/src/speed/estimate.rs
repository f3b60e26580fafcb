//! The speed of a shaft from nothing but the record and its bearing.
//!
//! Multiples of the shaft in the spectrum, and in the envelope spectra the multiples of the shaft, a family
//! and its sidebands, all follow from one speed. Each line that stands is evidence for the speeds that have a
//! line there, each that is missing is a little against them. A single comb is consistent with several
//! speeds; combs of shaft and bearing together are not, because their ratio is no whole number
//! (THEORY §7.9).

use stribeck_dsp::{BandEnvelope, Welch, WelchOptions, Whitened};
use stribeck_theory::catalogue::CatalogueBearing;

/// Speeds that are looked at [Hz].
pub(crate) const FROM_HZ: f64 = 5.0;
pub(crate) const TO_HZ: f64 = 70.0;
/// Narrowest band that is looked at [Hz].
const NARROWEST_HZ: f64 = 600.0;
/// Multiples of the shaft in the spectrum and in the envelopes, harmonics of a family, and of those the ones
/// whose sidebands count.
const SHAFT: u32 = 8;
const SHAFT_OF_ENVELOPE: u32 = 4;
const HARMONICS: u32 = 5;
const BESIDE: u32 = 3;
/// Mean height of a line of the speed over the background; a lower line counts as absent.
const STANDS: f64 = 20.0;
/// Probability that it is not there.
const MISSING: f64 = 0.5;
/// The evidence of a single line ends here [nats], but for the logarithm of its height over that from which
/// it does: many lines must agree.
const MOST: f64 = 5.0;
const MOST_FROM: f64 = 8.0;
/// Multiples of a family that may be taken for one of the shaft's.
pub(crate) const OF_FAMILY: u32 = 2;
/// Slip of a family, either way, and steps in which it is tried.
const SLIP: f64 = 0.02;
const SLIP_STEPS: i32 = 20;
/// Least lead over all other speeds, except simple multiples of the best one, with which it is accepted
/// [nats]: on every second record of bearings 6205 no wrong one leads by more than 17.
pub(crate) const LEAST_LEAD: f64 = 20.0;
/// Speeds nearer to one another than this part are one.
const SAME: f64 = 0.02;
/// Speeds that are looked at one by one, and how far a ratio of two may be off a whole number.
const PEAKS: usize = 10;
const WHOLE: f64 = 0.01;
/// Evidence of the lines between those of a speed, and part of them that must stand, for it to be a multiple
/// of the true one, and what the true one may lack as a whole [nats].
const BETWEEN: f64 = 4.0;
const PART_BETWEEN: f64 = 0.6;
const LACKS: f64 = 40.0;
/// How far a half or a third of a speed is looked for about its place, and in which steps.
const ABOUT: f64 = 1e-3;
const ABOUT_STEPS: i32 = 5;

/// How far a given speed may be off, either way, and speeds that are one about it.
pub(crate) const REACH: f64 = 0.07;
const SAME_NEAR: f64 = 0.006;
/// The lead over all others within reach from which a given speed is corrected [nats].
const LEAST_LEAD_NEAR: f64 = 20.0;
/// Least evidence of the shaft's own multiples in the spectrum with which a speed is accepted [nats], three
/// lines that stand: a comb of the bearing alone is consistent with any speed from which slip, or another
/// bearing, makes it a family.
const LEAST_OF_SHAFT: f64 = 15.0;
/// Turns that a record must hold: with fewer, the multiples of neighbouring speeds are not resolved.
const TURNS: f64 = 50.0;
const TURNS_NEAR: f64 = 100.0;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SpeedEstimate {
    pub(crate) hz: f64,
    /// Half of the resolution over the highest multiple of the shaft that was looked at [Hz].
    pub(crate) uncertainty_hz: f64,
    /// How far it leads other speeds [nats].
    pub(crate) lead: f64,
    /// The speed that comes next [Hz].
    pub(crate) next_hz: f64,
    /// Whether it leads far enough, and the shaft itself shows.
    pub(crate) is_accepted: bool,
}

impl SpeedEstimate {
    fn of(
        hz: f64,
        score: f64,
        next: (f64, f64),
        (spectrum, clear): (&Evidence, &Clear),
        least_lead: f64,
    ) -> Self {
        let shaft_shows = clear.comb(spectrum, hz, SHAFT) >= LEAST_OF_SHAFT;
        Self {
            hz,
            uncertainty_hz: uncertainty_hz(spectrum),
            lead: score - next.1,
            next_hz: next.0,
            is_accepted: shaft_shows && score - next.1 >= least_lead,
        }
    }
}

/// A speed that the lines of a record support.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Supported {
    pub(crate) hz: f64,
    /// Half of the resolution over the highest multiple of the shaft that was looked at [Hz].
    pub(crate) uncertainty_hz: f64,
    /// Its evidence [nats].
    pub(crate) score: f64,
}

/// The speed with the largest evidence; `None` for a record too short to search.
pub(crate) fn without_any_given(
    samples: &[f64],
    rate_hz: f64,
    bands: &[BandEnvelope],
    bearing: &CatalogueBearing,
) -> Option<SpeedEstimate> {
    search(samples, rate_hz, bands, bearing).map(|(found, _)| found)
}

/// The same, and all speeds that no other one outweighs, the one with the largest evidence first.
pub(crate) fn search(
    samples: &[f64],
    rate_hz: f64,
    bands: &[BandEnvelope],
    bearing: &CatalogueBearing,
) -> Option<(SpeedEstimate, Vec<Supported>)> {
    let spectrum = Evidence::of_samples(samples, rate_hz)?;
    let clear = Clear::of(bearing, None)?;
    let scored = Scored::between((FROM_HZ, TO_HZ), &spectrum, bands, bearing, &clear)?;
    let found = scored.highest(|_| true)?;
    let hz = scored.lowest_of(&spectrum, found);
    let next = scored.highest(|other| !is_simple(other / hz))?;
    let holds = |hz: f64| samples.len() as f64 / rate_hz * hz >= TURNS;
    let supported = scored.supported(&spectrum, &clear).into_iter().filter(|speed| holds(speed.hz)).collect();
    let best = SpeedEstimate::of(hz, found.1, next, (&spectrum, &clear), LEAST_LEAD);
    holds(hz).then_some((best, supported))
}

/// The speed near a given one with the largest evidence; `None` for a record too short to search.
pub(crate) fn near(
    samples: &[f64],
    rate_hz: f64,
    bands: &[BandEnvelope],
    bearing: &CatalogueBearing,
    given_hz: f64,
) -> Option<SpeedEstimate> {
    (samples.len() as f64 / rate_hz * given_hz >= TURNS_NEAR).then_some(())?;
    let spectrum = Evidence::of_samples(samples, rate_hz)?;
    let reach = ((1.0 - REACH) * given_hz, (1.0 + REACH) * given_hz);
    let clear = Clear::of(bearing, Some(given_hz))?;
    let scored = Scored::between(reach, &spectrum, bands, bearing, &clear)?;
    let (hz, score) = scored.highest(|_| true)?;
    let next = scored.highest(|other| (other / hz - 1.0).abs() > SAME_NEAR)?;
    Some(SpeedEstimate::of(hz, score, next, (&spectrum, &clear), LEAST_LEAD_NEAR))
}

/// Whether lines of the shaft stand at a speed and between its even multiples, which are all that twice the
/// speed has.
pub(crate) fn stands_at_half(samples: &[f64], rate_hz: f64, hz: f64) -> bool {
    Evidence::of_samples(samples, rate_hz).is_some_and(|spectrum| spectrum.stands_between(hz, 2))
}

/// Speeds [Hz] and the evidence for each [nats].
struct Scored {
    speeds: Vec<f64>,
    scores: Vec<f64>,
}

impl Scored {
    fn between(
        (from_hz, to_hz): (f64, f64),
        spectrum: &Evidence,
        bands: &[BandEnvelope],
        bearing: &CatalogueBearing,
        clear: &Clear,
    ) -> Option<Self> {
        let orders = bearing.orders().ok()?;
        let wide = bands.iter().filter(|band| band.high_hz - band.low_hz >= NARROWEST_HZ);
        let envelopes: Vec<Evidence> = wide.filter_map(Evidence::of_envelope).collect();
        // A tenth of a line: half a line at the fifth harmonic.
        let step_hz = 0.1 * spectrum.grid_hz;
        let count = ((to_hz - from_hz) / step_hz) as usize;
        let speeds: Vec<f64> = (0..=count).map(|n| from_hz + n as f64 * step_hz).collect();
        let families = [
            Rates { order: orders.bpfo, beside: None },
            Rates { order: orders.bpfi, beside: Some(1.0) },
            Rates { order: 2.0 * orders.bsf, beside: Some(orders.ftf) },
        ];
        let mut best = vec![f64::NEG_INFINITY; speeds.len()];
        for envelope in &envelopes {
            let shaft: Vec<f64> =
                speeds.iter().map(|hz| clear.comb(envelope, *hz, SHAFT_OF_ENVELOPE)).collect();
            for family in &families {
                family.add(envelope, &speeds, &shaft, &mut best);
            }
        }
        let scores =
            speeds.iter().zip(&best).map(|(hz, best)| best + clear.comb(spectrum, *hz, SHAFT)).collect();
        Some(Self { speeds, scores })
    }

    /// The speed with the highest score among those that are asked, and its score.
    fn highest(&self, asked: impl Fn(f64) -> bool) -> Option<(f64, f64)> {
        let all = self.speeds.iter().copied().zip(self.scores.iter().copied());
        all.filter(|(hz, score)| asked(*hz) && score.is_finite()).max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// The highest speeds at which the shaft itself shows, and which none of the others leads by
    /// [`LEAST_LEAD`], except whole multiples: these have lines at every second or third multiple of theirs.
    fn supported(&self, spectrum: &Evidence, clear: &Clear) -> Vec<Supported> {
        let mut peaks: Vec<(f64, f64)> = Vec::new();
        while let Some(peak) = (peaks.len() < PEAKS)
            .then(|| self.highest(|hz| peaks.iter().all(|(other, _)| (hz / other - 1.0).abs() > SAME)))
            .flatten()
        {
            peaks.push(peak);
        }
        let leads = |hz: f64, score: f64| {
            peaks.iter().all(|(other, best)| is_whole(other / hz) || best - score < LEAST_LEAD)
        };
        let supported = peaks
            .iter()
            .filter(|(hz, score)| clear.comb(spectrum, *hz, SHAFT) >= LEAST_OF_SHAFT && leads(*hz, *score));
        let uncertainty_hz = uncertainty_hz(spectrum);
        supported.map(|(hz, score)| Supported { hz: *hz, uncertainty_hz, score: *score }).collect()
    }

    /// A half or a third of a speed, as often as its lines between stand: twice a speed has the lines of
    /// every second multiple.
    fn lowest_of(&self, spectrum: &Evidence, found: (f64, f64)) -> f64 {
        let mut hz = found.0;
        while let Some(lower) = [2, 3].into_iter().find_map(|parts| {
            let lower = hz / f64::from(parts);
            let score = self.highest(|other| (other / lower - 1.0).abs() < 3.0 * ABOUT)?.1;
            (spectrum.stands_between(lower, parts) && score > found.1 - LACKS).then_some(lower)
        }) {
            hz = lower;
        }
        hz
    }
}

/// Multiples of the shaft at which no line of the bearing can be, by a speed or by the one that is given: in a
/// 6203 BPFO is 3.05 times the shaft and BPFI 4.95 times.
struct Clear {
    orders: Vec<f64>,
    given_hz: Option<f64>,
}

impl Clear {
    fn of(bearing: &CatalogueBearing, given_hz: Option<f64>) -> Option<Self> {
        let orders = bearing.orders().ok()?;
        let combs = [orders.bpfo, orders.bpfi, 2.0 * orders.bsf];
        Some(Self {
            orders: (1..=OF_FAMILY).flat_map(|m| combs.map(|order| f64::from(m) * order)).collect(),
            given_hz,
        })
    }

    /// Evidence of the first multiples of a speed.
    fn comb(&self, spectrum: &Evidence, hz: f64, multiples: u32) -> f64 {
        let is_of_a_family = |line_hz: f64| {
            [Some(hz), self.given_hz].into_iter().flatten().any(|shaft_hz| {
                self.orders.iter().any(|order| (line_hz / (order * shaft_hz) - 1.0).abs() < SLIP)
            })
        };
        let lines = (1..=multiples).map(|n| f64::from(n) * hz).filter(|line| !is_of_a_family(*line));
        lines.map(|line| spectrum.at(line)).sum()
    }
}

/// Half of the resolution over the highest multiple of the shaft that is looked at [Hz].
fn uncertainty_hz(spectrum: &Evidence) -> f64 {
    0.5 * spectrum.grid_hz / f64::from(SHAFT)
}

/// Whether a ratio of two speeds is a whole number above 1.
fn is_whole(ratio: f64) -> bool {
    let whole = ratio.round();
    whole > 1.0 && (ratio / whole - 1.0).abs() < WHOLE
}

/// Whether lines of the shaft alone cannot distinguish two speeds of this ratio.
fn is_simple(ratio: f64) -> bool {
    [0.25, 1.0 / 3.0, 0.5, 1.0, 2.0, 3.0, 4.0].iter().any(|simple| (ratio / simple - 1.0).abs() < SAME)
}

/// A family over the speed of the shaft, and the distance of its sidebands.
struct Rates {
    order: f64,
    beside: Option<f64>,
}

impl Rates {
    /// Raises the scores of speeds to those with this family in an envelope, wherever slip puts it.
    fn add(&self, envelope: &Evidence, speeds: &[f64], shaft: &[f64], best: &mut [f64]) {
        let step_hz = 0.1 * envelope.grid_hz;
        let (Some(first), Some(last)) = (speeds.first(), speeds.last()) else { return };
        let from_hz = first * self.order * (1.0 - SLIP);
        let count = ((last * self.order * (1.0 + SLIP) - from_hz) / step_hz) as usize + 1;
        let combs: Vec<f64> =
            (0..count).map(|n| envelope.comb(from_hz + n as f64 * step_hz, HARMONICS)).collect();
        for ((hz, shaft), best) in speeds.iter().zip(shaft).zip(best) {
            let slips = (-SLIP_STEPS..=SLIP_STEPS).filter_map(|n| {
                let comb_hz = hz * self.order * (1.0 + SLIP * f64::from(n) / f64::from(SLIP_STEPS));
                let at = ((comb_hz - from_hz) / step_hz).round().max(0.0) as usize;
                Some((*combs.get(at)?, comb_hz))
            });
            let Some((comb, comb_hz)) = slips.max_by(|a, b| a.0.total_cmp(&b.0)) else { continue };
            let beside = self.beside.map_or(0.0, |part| envelope.sidebands(comb_hz, part * hz));
            *best = best.max(comb + beside + shaft);
        }
    }
}

/// What each line of a spectrum says for a speed that has a line there [nats].
struct Evidence {
    grid_hz: f64,
    lines: Vec<f64>,
}

impl Evidence {
    fn of(spectrum: &Whitened) -> Self {
        let of = |n: usize| {
            let ratio = spectrum.at((n as f64 + 0.5) * spectrum.grid_hz());
            // Noise is exponential with a mean of 1; a line has a mean of `STANDS`, or is not there.
            let there = (ratio * (1.0 - 1.0 / STANDS)).min(2.0 * MOST + STANDS).exp() / STANDS;
            (MISSING + (1.0 - MISSING) * there).ln().min(MOST) + (ratio / MOST_FROM).max(1.0).ln()
        };
        // The lines next to zero hold the residue of the removal of the mean.
        let lines = (0..spectrum.ratios().len()).map(|n| if n < 3 { 0.0 } else { of(n) }).collect();
        Self { grid_hz: spectrum.grid_hz(), lines }
    }

    fn of_envelope(band: &BandEnvelope) -> Option<Self> {
        // Averaged segments scatter less; their lines are taken as those of one, which is on the safe side.
        Some(Self::of(&Whitened::new(&band.values, band.grid_hz, 1).ok()?))
    }

    /// Of the spectrum of the samples, as far as the multiples of the shaft reach.
    fn of_samples(samples: &[f64], rate_hz: f64) -> Option<Self> {
        let mut welch = Welch::new(rate_hz, samples.len(), &WelchOptions::new(samples.len())).ok()?;
        let spectrum = welch.estimate(samples).ok()?;
        let grid_hz = rate_hz / samples.len() as f64;
        let lines = (f64::from(SHAFT + 1) * TO_HZ / grid_hz) as usize;
        let values = spectrum.values();
        Some(Self::of(&Whitened::new(&values[..lines.min(values.len())], grid_hz, 1).ok()?))
    }

    fn at(&self, hz: f64) -> f64 {
        self.lines.get((hz / self.grid_hz) as usize).copied().unwrap_or(0.0)
    }

    fn comb(&self, hz: f64, harmonics: u32) -> f64 {
        (1..=harmonics).map(|n| self.at(f64::from(n) * hz)).sum()
    }

    fn sidebands(&self, comb_hz: f64, spacing_hz: f64) -> f64 {
        let beside = |n: u32| [-1.0, 1.0].map(|side| self.at(f64::from(n) * comb_hz + side * spacing_hz));
        (1..=BESIDE).flat_map(beside).sum()
    }

    /// Whether there are lines at multiples of `hz` that are not multiples of `parts` times it.
    fn stands_between(&self, hz: f64, parts: u32) -> bool {
        let asked: Vec<u32> =
            (1..4 * parts).filter(|n| !n.is_multiple_of(parts)).take(2 * parts as usize).collect();
        let tried =
            (-ABOUT_STEPS..=ABOUT_STEPS).map(|n| hz * (1.0 + ABOUT * f64::from(n) / f64::from(ABOUT_STEPS)));
        let of = |hz: f64| -> Vec<f64> { asked.iter().map(|n| self.at(f64::from(*n) * hz)).collect() };
        let best = tried.map(of).max_by(|a, b| a.iter().sum::<f64>().total_cmp(&b.iter().sum()));
        best.is_some_and(|lines| {
            let standing = lines.iter().filter(|line| **line > 0.0).count() as f64;
            lines.iter().sum::<f64>() > BETWEEN && standing >= PART_BETWEEN * lines.len() as f64
        })
    }
}
