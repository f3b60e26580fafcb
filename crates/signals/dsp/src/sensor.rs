//! A signal as a sensor and its recorder record it: mounting resonance, anti-alias filter, rate, noise,
//! range, steps.

use std::f64::consts::{PI, TAU};

use realfft::RealFftPlanner;
use rustfft::num_complex::Complex;

use crate::error::{check_positive, check_signal};
use crate::{Error, Result};

/// A sensor on a recorder. Units are those of the signal.
#[derive(Debug, Clone, PartialEq)]
pub struct Sensor {
    /// Sample rate of the recorder [Hz], at most that of the signal. Its filter passes up to 0.4 of it and
    /// nothing from half of it on, with a cosine between and without delay, as oversampling converters do.
    pub rate_hz: f64,
    /// Resonance of the mounted sensor [Hz] and its quality factor.
    pub resonance: Option<(f64, f64)>,
    /// Density of the noise [unit/√Hz], white.
    pub noise_density: f64,
    /// Largest magnitude that is recorded; beyond it the record is clipped.
    pub range: f64,
    /// Bits of the converter: steps are the range over 2^(bits − 1). `None` for none.
    pub bits: Option<u32>,
    /// Seed of the noise.
    pub seed: u64,
}

impl Sensor {
    /// A recorder that adds nothing: no resonance, no noise, no limit, no steps.
    pub fn ideal(rate_hz: f64) -> Self {
        Self { rate_hz, resonance: None, noise_density: 0.0, range: f64::INFINITY, bits: None, seed: 0 }
    }

    /// The record of `signal`, which is sampled at `sample_rate_hz`; both begin at the same time.
    ///
    /// # Errors
    /// [`Error::NotPositive`], [`Error::TooShort`] for fewer than 16 samples, [`Error::NotFinite`],
    /// [`Error::Undefined`] for a rate above that of the signal, or one that is in no ratio of whole numbers
    /// below 20 000 to it, or steps without a range.
    pub fn record(&self, signal: &[f64], sample_rate_hz: f64) -> Result<Vec<f64>> {
        check_positive("sample_rate_hz", sample_rate_hz)?;
        check_positive("rate_hz", self.rate_hz)?;
        check_signal(signal, 16, "a sensor")?;
        if let Some((hz, quality)) = self.resonance {
            check_positive("resonance", hz)?;
            check_positive("quality", quality)?;
        }
        let undefined = |why| Err(Error::Undefined { quantity: "record of the sensor", why });
        if self.rate_hz > sample_rate_hz {
            return undefined("a recorder cannot be faster than the signal; choose a lower rate");
        }
        if self.range.is_nan() || self.range <= 0.0 || (self.bits.is_some() && self.range.is_infinite()) {
            return undefined("the range must be above 0, and finite where there are steps");
        }
        let Some((up, down)) = ratio(self.rate_hz / sample_rate_hz) else {
            return undefined("the rates are in no ratio of small whole numbers; choose a rounder rate");
        };
        let mut recorded = self.filtered(signal, sample_rate_hz, up, down);
        let mut noise = Gaussian(self.seed);
        let scatter = self.noise_density * (0.5 * self.rate_hz).sqrt();
        let step = self.bits.map(|bits| self.range / 2_f64.powi(bits as i32 - 1));
        for x in &mut recorded {
            if scatter > 0.0 {
                *x += scatter * noise.next();
            }
            *x = x.clamp(-self.range, self.range);
            if let Some(step) = step {
                // The positive end is one step lower, as two's complement has it.
                *x = ((*x / step).round() * step).min(self.range - step);
            }
        }
        Ok(recorded)
    }

    /// Resonance and anti-alias filter by the transform of the record, continued by its mirror image on
    /// either side so that its ends do not ring: turned about its last sample instead, it would keep that as
    /// it is, with all that the filter takes elsewhere. Then fewer lines make a slower rate.
    fn filtered(&self, signal: &[f64], sample_rate_hz: f64, up: usize, down: usize) -> Vec<f64> {
        // A whole number of `down` samples becomes a whole number of `up` of them.
        let side = (signal.len() - 1).min(4096).max(down) / down * down;
        let len = (signal.len() + 2 * side).next_multiple_of(down);
        let reach = signal.len() - 1;
        let mut extended: Vec<f64> = (0..len)
            .map(|n| match n.checked_sub(side) {
                None => signal[(side - n).min(reach)],
                Some(n) if n < signal.len() => signal[n],
                Some(n) => signal[reach - (n - reach).min(reach)],
            })
            .collect();
        let mut planner = RealFftPlanner::<f64>::new();
        let forward = planner.plan_fft_forward(len);
        let mut lines = forward.make_output_vec();
        forward.process(&mut extended, &mut lines).expect("both buffers have the plan's lengths");
        for (n, line) in lines.iter_mut().enumerate() {
            *line *= self.response(n as f64 * sample_rate_hz / len as f64, self.rate_hz < sample_rate_hz);
        }
        let short = len / down * up;
        lines.truncate(short / 2 + 1);
        lines[0].im = 0.0;
        if short.is_multiple_of(2) {
            lines[short / 2].im = 0.0;
        }
        let inverse = planner.plan_fft_inverse(short);
        let mut out = inverse.make_output_vec();
        inverse.process(&mut lines, &mut out).expect("the ends of the spectrum are real");
        let kept = (signal.len() - 1) * up / down + 1;
        out[side / down * up..][..kept].iter().map(|x| x / len as f64).collect()
    }

    fn response(&self, hz: f64, filtered: bool) -> Complex<f64> {
        const PASSED: f64 = 0.4;
        let mounted = self.resonance.map_or(Complex::new(1.0, 0.0), |(resonance_hz, quality)| {
            let r = hz / resonance_hz;
            Complex::new(1.0 - r * r, r / quality).inv()
        });
        let flank = ((hz / self.rate_hz - PASSED) / (0.5 - PASSED)).clamp(0.0, 1.0);
        if filtered { mounted * (0.5 + 0.5 * (PI * flank).cos()) } else { mounted }
    }
}

/// A number as a ratio of whole numbers below 20 000, by continued fractions.
fn ratio(x: f64) -> Option<(usize, usize)> {
    let (mut above, mut below) = ((1_u64, 0_u64), (0_u64, 1_u64));
    let mut rest = x;
    for _ in 0..20 {
        let whole = rest.floor();
        let next =
            |(now, before): (u64, u64)| ((whole as u64).saturating_mul(now).saturating_add(before), now);
        (above, below) = (next(above), next(below));
        if below.0 >= 20_000 || above.0 >= 20_000 {
            return None;
        }
        if (above.0 as f64 / below.0 as f64 / x - 1.0).abs() < 1e-12 {
            return Some((above.0 as usize, below.0 as usize));
        }
        rest = 1.0 / (rest - whole);
    }
    None
}

/// Unit Gaussian numbers: splitmix64, then Box and Muller.
struct Gaussian(u64);

impl Gaussian {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (((z ^ (z >> 31)) >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    }

    fn next(&mut self) -> f64 {
        let radius = (-2.0 * self.uniform().ln()).sqrt();
        radius * (TAU * self.uniform()).cos()
    }
}
