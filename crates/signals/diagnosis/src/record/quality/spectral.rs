//! Findings in the spectrum: lines of the mains, and content just below half the sample rate.

use stribeck_dsp::Spectrum;

use super::{Kind, Quality, percent};

/// Frequencies of the mains [Hz].
const MAINS_HZ: [f64; 2] = [50.0, 60.0];
/// How far the mains may lie from them [Hz].
const OFF_HZ: f64 = 0.2;
/// Height of the line over its surroundings, and of a further one [dB].
const HIGH_DB: f64 = 20.0;
const FURTHER_DB: f64 = 12.0;
/// Share of the power from which on the lines matter, as they raise the rms by a fortieth, and from which on one
/// needs no harmonics to be named.
const SOME: f64 = 0.05;
const MUCH: f64 = 0.2;
/// A shaft whose lines are as near as this part is a reason of its own.
const SHAFT: f64 = 0.01;

/// Lines of the mains in a density; `shaft_hz` where the speed is known.
pub(crate) fn hum(spectrum: &Spectrum, shaft_hz: Option<f64>) -> Option<Quality> {
    let (frequencies_hz, density) = (spectrum.frequencies_hz(), spectrum.values());
    let grid = frequencies_hz.get(1)? - frequencies_hz[0];
    // The main lobe of a window is four lines wide: harmonics of a slow shaft must lie outside it.
    if grid > 1.0 {
        return None;
    }
    let total: f64 = density.iter().skip((2.0 / grid) as usize).sum::<f64>() * grid;
    let line = |hz: f64, reach: f64| -> Option<(f64, f64)> {
        let of = |hz: f64| (hz / grid).round() as usize;
        let near = density.get(of(hz - reach)..=of(hz + reach))?;
        let top = near.iter().copied().fold(0.0, f64::max);
        let (low, high) =
            (density.get(of(hz - 12.0)..of(hz - 4.0))?, density.get(of(hz + 4.0)..of(hz + 12.0))?);
        let around = super::median(&[low, high].concat())?;
        Some((10.0 * (top / around).log10(), near.iter().sum::<f64>() * grid))
    };
    MAINS_HZ.into_iter().find_map(|mains| {
        let turns = shaft_hz.is_some_and(|hz| {
            (1..=8).any(|k| (f64::from(k) * hz / mains - 1.0).abs() < SHAFT)
        });
        let lobe = 1.5 * grid;
        let reach = OFF_HZ.max(lobe);
        let (high_db, power) = line(mains, reach)?;
        // Harmonics lie where the first line says, not at any line of the machine nearby.
        let is_hz = spectrum.peak(mains - reach, mains + reach).ok()?.frequency_hz;
        let odd = [3.0, 5.0].into_iter().filter_map(|k| line(k * is_hz, lobe)).filter(|of| of.0 > FURTHER_DB);
        let share = (power + odd.clone().map(|of| of.1).sum::<f64>()) / total;
        let is_hum = high_db > HIGH_DB && share > SOME && !turns && (odd.count() > 0 || share > MUCH);
        is_hum.then(|| Quality {
            kind: Kind::Hum,
            share: 1.0,
            first_s: 0.0,
            words: format!(
                "mains hum: the line at {mains} Hz stands {high_db:.0} dB above its surroundings, and holds {} of \
                 the power with its odd harmonics; a loop of the cable's shield picks it up, unless the shaft \
                 turns as fast. Levels hold it, too: ground the shield at one end only",
                percent(share)
            ),
        })
    })
}

/// From which part of half the sample rate on a filter leaves nothing, and the share of power there that shows
/// that there was none.
const TOP: f64 = 0.9;
const FOLDED: f64 = 0.35;

/// Power just below half the sample rate.
pub(crate) fn folded(frequencies_hz: &[f64], density: &[f64]) -> Option<Quality> {
    let last = *frequencies_hz.last()?;
    let from = frequencies_hz.partition_point(|hz| *hz < TOP * last);
    let total: f64 = density.iter().skip(1).sum();
    let share = density[from..].iter().sum::<f64>() / total;
    (share > FOLDED).then(|| Quality {
        kind: Kind::Aliased,
        share: 1.0,
        first_s: 0.0,
        words: format!(
            "aliasing: {} of the power lie in the highest tenth of the band, above {:.0} Hz, where an anti-alias \
             filter leaves little: what is there was probably folded down from above {last:.0} Hz, and so may be \
             lines anywhere. Sample faster, or with a filter",
            percent(share), TOP * last
        ),
    })
}
