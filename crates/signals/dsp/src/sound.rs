//! A signal as a loudspeaker plays it.

use std::f64::consts::PI;

use crate::error::{check_positive, check_signal};
use crate::{Error, Result, resample_poly};

/// Largest sample over full scale: a decibel of headroom for the player.
const LOUDEST: f64 = 0.891;
/// Fade at either end [s], so that neither clicks.
const FADE_S: f64 = 5e-3;
/// Largest part of the ratio of the two rates, which is rounded to it: pitches are off by less than a
/// millionth.
const MOST: u64 = 4_000;

/// A signal without its mean, at the rate of a sound card, scaled to 16 bits.
#[derive(Debug, Clone, PartialEq)]
pub struct Sound {
    /// Samples a second [Hz].
    pub rate_hz: u32,
    /// The samples.
    pub samples: Vec<i16>,
    /// Value of a sample at full scale [unit].
    pub full_scale: f64,
}

impl Sound {
    /// Of a signal sampled `sample_rate_hz` times a second, `slow` times as long: a line at f moves to
    /// f/slow.
    ///
    /// # Errors
    /// [`Error::NotPositive`] for a rate or `slow`, [`Error::TooShort`] for an empty signal,
    /// [`Error::NotFinite`], [`Error::Undefined`] for a constant one, or for rates whose ratio is above 4000.
    pub fn of(signal: &[f64], sample_rate_hz: f64, rate_hz: u32, slow: f64) -> Result<Self> {
        check_signal(signal, 1, "a sound")?;
        check_positive("sample_rate_hz", sample_rate_hz)?;
        check_positive("rate_hz", f64::from(rate_hz))?;
        check_positive("slow", slow)?;
        let undefined = |why| Error::Undefined { quantity: "sound", why };
        let (up, down) = nearest_ratio(f64::from(rate_hz) * slow / sample_rate_hz)
            .ok_or_else(|| undefined("the rates differ too much; slow it less, or choose a lower rate"))?;
        let mean = signal.iter().sum::<f64>() / signal.len() as f64;
        let centred: Vec<f64> = signal.iter().map(|x| x - mean).collect();
        let mut played = resample_poly(&centred, up, down)?;
        let fade = ((FADE_S * f64::from(rate_hz)) as usize).min(played.len() / 2);
        for n in 0..fade {
            let part = 0.5 - 0.5 * (PI * n as f64 / fade as f64).cos();
            let last = played.len() - 1 - n;
            played[n] *= part;
            played[last] *= part;
        }
        let peak = played.iter().fold(0.0_f64, |most, x| x.abs().max(most));
        if peak == 0.0 {
            return Err(undefined("the signal is constant"));
        }
        let full_scale = peak / LOUDEST;
        let most = f64::from(i16::MAX);
        let samples = played.iter().map(|x| (x / full_scale * most).round() as i16).collect();
        Ok(Self { rate_hz, samples, full_scale })
    }

    /// How long it is [s].
    pub fn duration_s(&self) -> f64 {
        self.samples.len() as f64 / f64::from(self.rate_hz)
    }
}

/// The last convergent of a number's continued fraction whose parts are at most [`MOST`]; `None` for a number
/// above that or below its inverse.
fn nearest_ratio(x: f64) -> Option<(usize, usize)> {
    let (mut above, mut below) = ((1_u64, 0_u64), (0_u64, 1_u64));
    let (mut rest, mut found) = (x, None);
    for _ in 0..40 {
        let whole = rest.floor();
        if !whole.is_finite() || whole > MOST as f64 {
            break;
        }
        let next = |(now, before): (u64, u64)| (whole as u64 * now + before, now);
        (above, below) = (next(above), next(below));
        if above.0 > MOST || below.0 > MOST {
            break;
        }
        if above.0 > 0 {
            found = Some((above.0 as usize, below.0 as usize));
        }
        // Rounding would turn a finite decimal into an endless one.
        if (above.0 as f64 / below.0 as f64 / x - 1.0).abs() < 1e-12 {
            break;
        }
        rest = 1.0 / (rest - whole);
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_hand_rates_are_rounded_to_small_ratios() {
        assert_eq!(nearest_ratio(48_000.0 / 100_000.0), Some((12, 25)));
        assert_eq!(nearest_ratio(10.0), Some((10, 1)));
        let (up, down) = nearest_ratio(48_000.0 / 25_601.0).unwrap();
        assert!((up as f64 / down as f64 * 25_601.0 / 48_000.0 - 1.0).abs() < 1e-6, "{up}/{down}");
    }
}
