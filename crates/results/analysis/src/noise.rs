//! How much of a record is contact noise: the line of the roller vertices and the level where no roller meets
//! the defect.

use std::ops::Range;

use crate::levels::{Visit, gap_spans, impulse_span, level, phases};
use crate::record::Record;
use crate::signal::{amplitude, band_rms, smoothed_peak};
use stribeck_diagnosis::STANDARD_GRAVITY;

/// Levels of one sensor, of the vector of both components. Quiet stretches are those without an event that
/// are nearly as long as the longest; powers are averaged over them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Noise {
    /// Amplitude of the facet line [g].
    pub line_g: f64,
    /// The same measure at neighbouring frequencies, where no line of the mesh lies: root of the mean square
    /// [g].
    pub background_g: f64,
    /// Smallest and largest of these [g].
    pub background_range_g: [f64; 2],
    /// The line at twice the frequency [g].
    pub second_g: f64,
    /// Root mean square [g].
    pub quiet_rms_g: f64,
    /// Root mean square above [`RINGING_HZ`] [g].
    pub ringing_g: f64,
    /// Root mean square before the first event [g].
    pub start_g: f64,
}

/// The first impulse of one sensor: its vertical acceleration within 1 ms of the exit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Impulse {
    /// Largest magnitude [g].
    pub peak_g: f64,
    /// Energy, ∫ a² dt [g² ms].
    pub energy_g2_ms: f64,
    /// Largest magnitude of the mean over [`IMPULSE_MEAN_S`] [g].
    pub mean_g: f64,
}

/// Neighbours of a line lie this many resolutions away: neither their windows nor the line's reach into
/// another.
const NEIGHBOURS: [f64; 4] = [-6.0, -3.0, 3.0, 6.0];

/// Frequencies that elements of 0.5 mm no longer carry well [Hz].
pub const RINGING_HZ: f64 = 20e3;

/// One period of the default scene's facet line [s], so that a running mean takes it and its harmonics out.
pub const IMPULSE_MEAN_S: f64 = 1.0 / 4671.0;

/// A quiet stretch counts when it is at least this part of the longest.
const LONG_ENOUGH: f64 = 0.9;

/// Measures `sensor` where `passages` (entry, exit) [s] are over, about the line `facet_hz`. `None` when the
/// record holds no such stretch.
pub fn measure(record: &Record<'_>, sensor: &str, passages: &[(f64, f64)], facet_hz: f64) -> Option<Noise> {
    let (time, rate) = (record.time_s(), record.sample_rate_hz());
    let components = [record.acceleration_g(sensor, "ax")?, record.acceleration_g(sensor, "ay")?];
    let visits: Vec<Visit> = passages.iter().map(|&(entry, exit)| Visit::between(entry, exit)).collect();
    let all = gap_spans(time, &phases(time, &visits), 0.0);
    let longest = all.iter().map(ExactSizeIterator::len).max()?;
    let least = (LONG_ENOUGH * longest as f64) as usize;
    let quiet: Vec<Range<usize>> = all.iter().filter(|span| span.len() >= least).cloned().collect();
    let both = |spans: &[Range<usize>], of: &dyn Fn(&[f64]) -> Option<f64>| -> Option<f64> {
        let mut power = 0.0;
        for span in spans {
            for component in &components {
                power += of(&component[span.clone()])?.powi(2) / spans.len() as f64;
            }
        }
        Some(power.sqrt())
    };
    let rms = |signal: &[f64]| {
        let mean = signal.iter().sum::<f64>() / signal.len() as f64;
        let centred: Vec<f64> = signal.iter().map(|v| v - mean).collect();
        level(&centred, std::slice::from_ref(&(0..centred.len()))).map(|l| l.rms)
    };
    let line = |hz: f64| both(&quiet, &|s| amplitude(s, rate, hz));
    let resolution = rate / longest as f64;
    let beside: Vec<f64> =
        NEIGHBOURS.iter().map(|n| line(facet_hz + n * resolution)).collect::<Option<_>>()?;
    let power: f64 = beside.iter().map(|g| g * g).sum();
    Some(Noise {
        line_g: line(facet_hz)?,
        background_g: (power / beside.len() as f64).sqrt(),
        background_range_g: [
            beside.iter().copied().fold(f64::INFINITY, f64::min),
            beside.iter().copied().fold(0.0, f64::max),
        ],
        second_g: line(2.0 * facet_hz)?,
        quiet_rms_g: both(&quiet, &rms)?,
        ringing_g: both(&quiet, &|s| band_rms(s, rate, RINGING_HZ, 0.5 * rate))?,
        start_g: both(&all[..1], &rms)?,
    })
}

/// Measures the impulse at `exit_s` [s]; `None` when the record ends before it.
pub fn impulse(record: &Record<'_>, sensor: &str, exit_s: f64) -> Option<Impulse> {
    let vertical = record.acceleration_g(sensor, "ay")?;
    let vertical = vertical.get(impulse_span(record.time_s(), exit_s))?;
    Some(Impulse {
        peak_g: vertical.iter().fold(0.0, |m: f64, a| m.max(a.abs())),
        energy_g2_ms: 1e3 * record.interval_s() * vertical.iter().map(|a| a * a).sum::<f64>(),
        mean_g: smoothed_peak(vertical, record.interval_s(), IMPULSE_MEAN_S)?,
    })
}

/// Ripple of a roller's force in a span of samples: its rms about a cubic in time, over its mean [-].
pub fn force_ripple(force: &[f64]) -> Option<f64> {
    const TERMS: usize = 4;
    if force.len() < 4 * TERMS {
        return None;
    }
    // Legendre's polynomials made orthogonal over the samples, one after the other.
    let n = force.len();
    let mut rest = force.to_vec();
    let mut basis: Vec<Vec<f64>> = Vec::new();
    for k in 0..TERMS {
        let mut p: Vec<f64> =
            (0..n).map(|i| (2.0 * i as f64 / (n - 1) as f64 - 1.0).powi(k as i32)).collect();
        for q in &basis {
            let along: f64 = p.iter().zip(q).map(|(a, b)| a * b).sum();
            p.iter_mut().zip(q).for_each(|(a, b)| *a -= along * b);
        }
        let norm = p.iter().map(|a| a * a).sum::<f64>().sqrt();
        p.iter_mut().for_each(|a| *a /= norm);
        let along: f64 = rest.iter().zip(&p).map(|(a, b)| a * b).sum();
        rest.iter_mut().zip(&p).for_each(|(a, b)| *a -= along * b);
        basis.push(p);
    }
    let mean = force.iter().sum::<f64>() / n as f64;
    let rms = (rest.iter().map(|a| a * a).sum::<f64>() / n as f64).sqrt();
    (mean != 0.0).then(|| rms / mean.abs())
}

/// Amplitude spectrum [g] of a signal [m/s²] at the frequencies given, Hann window.
pub fn spectrum_g(signal: &[f64], sample_rate_hz: f64, frequencies_hz: &[f64]) -> Vec<f64> {
    let n = signal.len();
    let mean = signal.iter().sum::<f64>() / n as f64;
    let tau = std::f64::consts::TAU;
    let window = |i: usize| 1.0 - (tau * i as f64 / n as f64).cos();
    frequencies_hz
        .iter()
        .map(|hz| {
            let (mut c, mut s) = (0.0, 0.0);
            for (i, v) in signal.iter().enumerate() {
                let (sin, cos) = (tau * hz * i as f64 / sample_rate_hz).sin_cos();
                let v = window(i) * (v - mean);
                (c, s) = (c + v * cos, s + v * sin);
            }
            2.0 * c.hypot(s) / n as f64 / STANDARD_GRAVITY
        })
        .collect()
}
