//! The velocity level of a machine, 10 to 1000 Hz.

use stribeck_dsp::{Welch, WelchOptions};

use crate::Error;
use crate::record::unit::MotionUnit;

/// Ends of the band [Hz], those of ISO 20816 for most machines.
const BAND_HZ: (f64, f64) = (10.0, 1_000.0);
/// Length of a segment [s]: lines 1 Hz apart.
const SEGMENT_S: f64 = 1.0;

/// Why there is no velocity level of a record of `duration_s`; `None` where there is one.
pub fn missing(unit: Option<&str>, rate_hz: f64, duration_s: f64) -> Option<String> {
    match unit.map(|unit| (unit, MotionUnit::parse(unit))) {
        None => Some(
            "the unit of the samples is not known: give `--unit`, such as `g`, `m/s²` or `mm/s`".to_owned(),
        ),
        Some((unit, None)) => Some(format!(
            "`{unit}` is no unit of acceleration or velocity: give `--scale` and `--unit`, such as `g` or `mm/s`"
        )),
        _ if 0.5 * rate_hz < BAND_HZ.1 => Some(format!(
            "its band goes up to {} Hz, and {rate_hz} samples a second hold half of that rate",
            BAND_HZ.1
        )),
        _ if duration_s < SEGMENT_S => {
            Some(format!("it needs {SEGMENT_S} s, and the record has {duration_s:.2} s"))
        }
        _ => None,
    }
}

/// A level averaged over everything that was added.
pub(crate) struct VelocityLevel {
    welch: Welch,
    unit: MotionUnit,
    sum: f64,
    count: usize,
}

impl VelocityLevel {
    /// For segments of `segment` samples in `unit`; `None` where that is no acceleration or velocity, or
    /// the record too short or sampled too slowly for the band.
    pub(crate) fn new(rate_hz: f64, segment: usize, unit: Option<MotionUnit>) -> Result<Option<Self>, Error> {
        let Some(unit) = unit else { return Ok(None) };
        let part = (SEGMENT_S * rate_hz) as usize;
        if part > segment || 0.5 * rate_hz < BAND_HZ.1 {
            return Ok(None);
        }
        let welch = Welch::new(rate_hz, segment, &WelchOptions::new(part)).map_err(Error::Signal)?;
        Ok(Some(Self { welch, unit, sum: 0.0, count: 0 }))
    }

    pub(crate) fn add(&mut self, samples: &[f64]) -> Result<(), stribeck_dsp::Error> {
        let spectrum = self.welch.estimate(samples)?;
        let rms = match self.unit {
            MotionUnit::Acceleration(unit) => unit.in_m_s2() * spectrum.velocity_rms(BAND_HZ.0, BAND_HZ.1)?,
            MotionUnit::Velocity(m_s) => m_s * spectrum.band_rms(BAND_HZ.0, BAND_HZ.1)?,
        };
        self.sum += rms * rms;
        self.count += 1;
        Ok(())
    }

    /// Root mean square [mm/s].
    pub(crate) fn finish(&self) -> Option<f64> {
        (self.count > 0).then(|| 1e3 * (self.sum / self.count as f64).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn by_hand_one_g_at_a_hundred_hertz() {
        let rate_hz = 5_000.0;
        let samples: Vec<f64> = (0..20_000).map(|n| (TAU * 100.0 * f64::from(n) / rate_hz).sin()).collect();
        let level = |unit: &str| {
            let unit = MotionUnit::parse(unit);
            let mut level = VelocityLevel::new(rate_hz, samples.len(), unit).unwrap()?;
            level.add(&samples).unwrap();
            level.finish()
        };
        // 9.80665/(200π) m/s peak is 11.04 mm/s RMS; the line's width of 1.5 Hz at 100 Hz, squared.
        assert!((level("g").unwrap() / 11.036 - 1.0).abs() < 5e-4, "{:?}", level("g"));
        assert!((level("m/s²").unwrap() * 9.806_65 / level("g").unwrap() - 1.0).abs() < 1e-12);
        // A sine of 1 mm/s has an RMS of 0.7071 mm/s.
        assert!((level("mm/s").unwrap() / 0.5_f64.sqrt() - 1.0).abs() < 5e-4, "{:?}", level("mm/s"));
        assert!((level("ips").unwrap() / level("mm/s").unwrap() / 25.4 - 1.0).abs() < 1e-12);
        assert_eq!(level("V"), None);
        assert!(VelocityLevel::new(1_500.0, 20_000, MotionUnit::parse("g")).unwrap().is_none());
    }
}
