//! Frequency responses between a place and a sensor, in modes or by gains, applied to a signal.
//!
//! A response multiplies the lines of the signal's transform by its own values at their frequencies, so a
//! causal response stays one, and phases are those of the response. A response of acceleration to force says
//! nothing of a constant force: the mean of the signal is taken away first. Before its first sample and
//! behind its last one the signal is continued by its mirror image, for as long as the response rings, so
//! that it does not begin with a blow.

use std::f64::consts::TAU;

use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

use crate::error::{check_positive, check_signal};
use crate::least_delay::least_delay;
use crate::{Error, Result};

/// A ringing has ended when it has fallen to this part.
const ENDED: f64 = 1e-3;
/// Lines of a causal response: those of 12.8 kHz are 3 Hz apart.
const CAUSAL_LINES: usize = 4096;

/// One mode of a structure: acceleration of a sensor by a force.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mode {
    mass_kg: f64,
    stiffness_n_m: f64,
    damping_ratio: f64,
    /// −1 where the sensor moves against the place of the force.
    sense: f64,
}

impl Mode {
    /// A mass on a spring of this stiffness [N/m], with a damping ratio above 0 and below 1.
    ///
    /// # Errors
    /// [`Error::NotPositive`], [`Error::Undefined`] for a damping ratio of 1 or more.
    pub fn new(mass_kg: f64, stiffness_n_m: f64, damping_ratio: f64) -> Result<Self> {
        check_positive("mass", mass_kg)?;
        check_positive("stiffness", stiffness_n_m)?;
        check_positive("damping", damping_ratio)?;
        if damping_ratio >= 1.0 {
            let why = "damping is the ratio to the critical one, above 0 and below 1, such as 0.02";
            return Err(Error::Undefined { quantity: "mode", why });
        }
        Ok(Self { mass_kg, stiffness_n_m, damping_ratio, sense: 1.0 })
    }

    /// The same with the sensor moving against the place of the force.
    #[must_use]
    pub fn against(self) -> Self {
        Self { sense: -self.sense, ..self }
    }

    /// Its natural frequency without damping [Hz].
    pub fn hz(&self) -> f64 {
        (self.stiffness_n_m / self.mass_kg).sqrt() / TAU
    }

    /// Acceleration over force [m/s²/N] at a frequency: −ω²/(k − ω²m + 2iζω√(km)).
    /// Meirovitch, Fundamentals of Vibrations, McGraw-Hill 2001, §3.2.
    pub fn accelerance(&self, hz: f64) -> Complex<f64> {
        let omega = TAU * hz;
        let (m, k) = (self.mass_kg, self.stiffness_n_m);
        let below = Complex::new(k - omega * omega * m, 2.0 * self.damping_ratio * omega * (k * m).sqrt());
        Complex::new(-self.sense * omega * omega, 0.0) / below
    }

    /// How long it rings [s].
    fn rings_s(&self) -> f64 {
        (1.0 / ENDED).ln() / (TAU * self.damping_ratio * self.hz())
    }
}

/// From a place to a sensor.
#[derive(Debug, Clone, PartialEq)]
pub struct Response(Form);

#[derive(Debug, Clone, PartialEq)]
enum Form {
    Modes(Vec<Mode>),
    /// At even steps of the frequency from 0 on.
    Causal {
        grid_hz: f64,
        values: Vec<Complex<f64>>,
    },
    Sum(Vec<Response>),
    /// The first, and an all-pass behind it that dies away with this time constant [s].
    Ringing(Box<Response>, f64),
}

impl Response {
    /// The sum of some modes.
    ///
    /// # Errors
    /// [`Error::TooShort`] for none.
    pub fn of_modes(modes: Vec<Mode>) -> Result<Self> {
        let least = 1;
        if modes.is_empty() {
            return Err(Error::TooShort { field: "modes", len: 0, least, purpose: "a response" });
        }
        Ok(Self(Form::Modes(modes)))
    }

    /// The causal response of least delay that has these gains at these frequencies [Hz], which ascend: straight
    /// between them in logarithms, the same beyond the first and the last one, up to `highest_hz`.
    ///
    /// # Errors
    /// [`Error::TooShort`] without a gain, [`Error::WrongLength`], [`Error::NotPositive`], [`Error::NotAscending`].
    pub fn of_gains(hz: &[f64], gains: &[f64], highest_hz: f64) -> Result<Self> {
        check_positive("highest_hz", highest_hz)?;
        check_signal(hz, 1, "a response by gains")?;
        if gains.len() != hz.len() {
            return Err(Error::WrongLength { field: "gains", len: gains.len(), planned: hz.len() });
        }
        for (hz, gain) in hz.iter().zip(gains) {
            check_positive("frequency of a gain", *hz)?;
            check_positive("gain", *gain)?;
        }
        if let Some(n) = (1..hz.len()).find(|n| hz[*n] <= hz[*n - 1]) {
            return Err(Error::NotAscending { line: n + 1, hz: hz[n], before_hz: hz[n - 1] });
        }
        let grid_hz = highest_hz / CAUSAL_LINES as f64;
        let points: Vec<(f64, f64)> = hz.iter().zip(gains).map(|(hz, gain)| (hz.ln(), gain.ln())).collect();
        let density: Vec<f64> = (0..=CAUSAL_LINES)
            .map(|n| (2.0 * between(&points, (n as f64).max(0.5).ln() + grid_hz.ln())).exp())
            .collect();
        Ok(Self(Form::Causal { grid_hz, values: least_delay(&density) }))
    }

    /// The same with ringing behind it that dies away to 1/e in `decay_s` [s] and leaves every magnitude as it is: what
    /// the many modes of a structure do to an impact. Four all-passes of delays that are in no simple ratio (M. R.
    /// Schroeder, Natural sounding artificial reverberation, J. Audio Eng. Soc. 10 (1962) 219–223).
    pub fn ringing(self, decay_s: f64) -> Result<Self> {
        check_positive("decay_s", decay_s)?;
        Ok(Self(Form::Ringing(Box::new(self), decay_s)))
    }

    /// The sum of several: paths side by side.
    pub fn sum(of: Vec<Self>) -> Self {
        Self(Form::Sum(of))
    }

    /// Its value at a frequency.
    pub fn at(&self, hz: f64) -> Complex<f64> {
        match &self.0 {
            Form::Modes(modes) => modes.iter().map(|mode| mode.accelerance(hz)).sum(),
            Form::Sum(all) => all.iter().map(|one| one.at(hz)).sum(),
            Form::Ringing(of, decay_s) => of.at(hz) * all_passes(hz, *decay_s),
            Form::Causal { grid_hz, values } => {
                let at = (hz / grid_hz).clamp(0.0, (values.len() - 1) as f64);
                let n = (at as usize).min(values.len() - 2);
                values[n] * (n as f64 + 1.0 - at) + values[n + 1] * (at - n as f64)
            }
        }
    }

    /// How long it rings [s].
    fn rings_s(&self) -> f64 {
        match &self.0 {
            Form::Modes(modes) => modes.iter().map(Mode::rings_s).fold(0.0, f64::max),
            Form::Causal { grid_hz, .. } => 0.5 / grid_hz,
            Form::Sum(all) => all.iter().map(Self::rings_s).fold(0.0, f64::max),
            Form::Ringing(of, decay_s) => of.rings_s() + (1.0 / ENDED).ln() * decay_s,
        }
    }

    /// The signal as the sensor records it.
    ///
    /// # Errors
    /// [`Error::NotPositive`], [`Error::TooShort`], [`Error::NotFinite`].
    pub fn through(&self, signal: &[f64], sample_rate_hz: f64) -> Result<Vec<f64>> {
        check_positive("sample_rate_hz", sample_rate_hz)?;
        check_signal(signal, 16, "a response")?;
        let mean = signal.iter().sum::<f64>() / signal.len() as f64;
        let reach = signal.len() - 1;
        let pad = ((self.rings_s() * sample_rate_hz).ceil() as usize).clamp(1, reach);
        let at = |n: usize| match n.checked_sub(pad) {
            None => signal[pad - n],
            Some(n) if n <= reach => signal[n],
            Some(n) => signal[(2 * reach).saturating_sub(n)],
        };
        let count = signal.len() + 2 * pad;
        let mut lines: Vec<Complex<f64>> = (0..count).map(|n| Complex::new(at(n) - mean, 0.0)).collect();
        let mut planner = FftPlanner::new();
        planner.plan_fft_forward(count).process(&mut lines);
        let scale = 1.0 / count as f64;
        lines[0] = Complex::default();
        for n in 1..=count / 2 {
            let h = self.at(n as f64 * sample_rate_hz * scale) * scale;
            if 2 * n == count {
                // Half the sample rate has no phase.
                lines[n] *= h.re;
            } else {
                lines[n] *= h;
                lines[count - n] = lines[n].conj();
            }
        }
        planner.plan_fft_inverse(count).process(&mut lines);
        Ok(lines[pad..pad + signal.len()].iter().map(|z| z.re).collect())
    }
}

/// Delays of the all-passes over the time in which they die away.
const DELAYS: [f64; 4] = [0.13, 0.21, 0.34, 0.55];

/// The product of the all-passes at a frequency; its magnitude is 1.
fn all_passes(hz: f64, decay_s: f64) -> Complex<f64> {
    let one = |share: f64| {
        let (kept, late) = ((-share).exp(), Complex::from_polar(1.0, -TAU * hz * share * decay_s));
        (late - kept) / (1.0 - kept * late)
    };
    DELAYS.into_iter().map(one).product()
}

/// The value of a line through ascending points, level beyond them.
fn between(points: &[(f64, f64)], x: f64) -> f64 {
    let after = points.partition_point(|(at, _)| *at <= x);
    match (after.checked_sub(1).map(|n| points[n]), points.get(after)) {
        (Some((a, from)), Some((b, to))) => from + (to - from) * (x - a) / (b - a),
        (Some((_, last)), None) => last,
        (None, Some((_, first))) => *first,
        (None, None) => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The magnitudes are those given, and what the response does begins with its cause: of a blow in the middle
    /// of a record nothing stands before it.
    #[test]
    fn invariant_a_response_by_gains_has_them_and_is_causal() {
        let (hz, gains) = ([200.0, 1000.0, 4000.0], [0.01, 1.0, 0.2]);
        let response = Response::of_gains(&hz, &gains, 10_000.0).expect("gains");
        for (hz, gain) in hz.iter().zip(gains) {
            // Aliasing of the cepstrum.
            assert!(
                (response.at(*hz).norm() / gain - 1.0).abs() < 0.02,
                "{hz} Hz: {}",
                response.at(*hz).norm()
            );
        }
        let half_way = (1.0_f64 * 0.2).sqrt();
        assert!((response.at(2000.0).norm() / half_way - 1.0).abs() < 0.01);
        let mut blow = vec![0.0; 20_000];
        blow[10_000] = 1.0;
        let rung = response.through(&blow, 20_000.0).expect("long enough");
        let energy = |of: &[f64]| of.iter().map(|x| x * x).sum::<f64>();
        assert!(energy(&rung[..9_999]) < 1e-3 * energy(&rung));
    }

    /// Ringing keeps every magnitude, is causal, and dies away with its time constant: of four all-passes in a row the
    /// energy behind eight of them is below a hundredth.
    #[test]
    fn invariant_ringing_keeps_gains_and_dies_away() {
        let plain = Response::of_gains(&[200.0, 4000.0], &[0.1, 0.3], 10_000.0).expect("gains");
        let rung = plain.clone().ringing(2e-3).expect("positive");
        for hz in [150.0, 1234.5, 3999.0] {
            assert!((rung.at(hz).norm() / plain.at(hz).norm() - 1.0).abs() < 1e-12);
        }
        let mut blow = vec![0.0; 20_000];
        blow[10_000] = 1.0;
        let heard = rung.through(&blow, 20_000.0).expect("long enough");
        let energy = |of: &[f64]| of.iter().map(|x| x * x).sum::<f64>();
        let all = energy(&heard);
        assert!(energy(&heard[..9_999]) < 1e-3 * all);
        // 2 ms are 40 samples.
        assert!(energy(&heard[10_040..]) > 0.1 * all && energy(&heard[10_320..]) < 0.01 * all);
        stribeck_testing::assert_refused(plain.ringing(0.0), "decay_s");
    }

    #[test]
    fn refuses_gains_that_are_none() {
        for (hz, gains, words) in [
            (&[][..], &[][..], "a response by gains needs at least 1"),
            (&[1.0, 2.0], &[1.0], "gains: 1 values"),
            (&[1.0, 2.0], &[1.0, 0.0], "gain = 0"),
            (&[2.0, 1.0], &[1.0, 1.0], "frequencies must ascend"),
        ] {
            stribeck_testing::assert_refused(Response::of_gains(hz, gains, 1e4), words);
        }
    }
}
