//! Cepstral pre-whitening: all lines of a record's spectrum become equally strong, which leaves its impulses.

use rustfft::num_complex::Complex;

use crate::Result;
use crate::error::check_signal;

/// `signal` with every line of its transform divided by its magnitude: `irfft(X/|X|)`, whose cepstrum is zero
/// but at quefrency zero. Lines of zero stay zero.
///
/// Source: N. Sawalhi and R. B. Randall, Proc. COMADEM (2011).
///
/// # Errors
/// [`TooShort`](crate::Error::TooShort) for fewer than two samples, [`NotFinite`](crate::Error::NotFinite).
pub fn cepstral_prewhitening(signal: &[f64]) -> Result<Vec<f64>> {
    check_signal(signal, 2, "pre-whitening")?;
    let count = signal.len();
    let mut planner = realfft::RealFftPlanner::<f64>::new();
    let (forward, inverse) = (planner.plan_fft_forward(count), planner.plan_fft_inverse(count));
    let mut lines = forward.make_output_vec();
    forward.process(&mut signal.to_vec(), &mut lines).expect("both buffers have the plan's lengths");
    for line in &mut lines {
        let magnitude = line.norm_sqr().sqrt();
        *line = if magnitude > 0.0 { *line / magnitude } else { Complex::default() };
    }
    let mut whitened = inverse.make_output_vec();
    inverse.process(&mut lines, &mut whitened).expect("the ends of the spectrum are real");
    whitened.iter_mut().for_each(|x| *x /= count as f64);
    Ok(whitened)
}
