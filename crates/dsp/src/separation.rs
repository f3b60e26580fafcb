//! Separation of discrete lines, which repeat exactly, from random parts.

use realfft::RealFftPlanner;
use rustfft::num_complex::Complex;

use crate::error::check_signal;
use crate::{Error, Result, Window};

/// A signal in two parts that add up to it.
#[derive(Debug, Clone, PartialEq)]
pub struct Separated {
    /// Lines: gears, shafts, mains.
    pub discrete: Vec<f64>,
    /// The rest: noise, and sources that slip, as rolling elements do.
    pub random: Vec<f64>,
}

/// Separates `signal` into a predictable part and the rest: an earlier stretch of the signal, through the
/// filter of `filter` taps that predicts best, is its discrete part.
///
/// The filter's response is `⟨X_d* X⟩/⟨|X_d|²⟩` over half-overlapping Hann segments of `filter` samples, X_d
/// being those that end `delay` samples before the others begin: two segments that share samples would
/// predict noise, too. A line of power P in noise whose power within a line of the segment is N keeps P/(P +
/// N) of its amplitude, so a longer filter spares weaker lines; half-way between two lines of the filter's
/// grid it keeps 0.85 to 1.27 of that. The delay must exceed the memory of the noise: the ringing of its
/// resonances. The first `delay + 3/2 filter` samples and the last `filter/2` have only a part of the filter.
///
/// Source: J. Antoni and R. B. Randall, Mech. Syst. Signal Process. 18 (2004) 103–117.
///
/// # Errors
/// [`Error::TooShort`] for a filter below eight taps, no delay, or a record without eight segments behind the
/// delay, [`Error::NotFinite`], [`Error::Undefined`] for a signal of zeros.
pub fn separate(signal: &[f64], filter: usize, delay: usize) -> Result<Separated> {
    const SEGMENTS: usize = 8;
    let short = |field, len, least| Error::TooShort { field, len, least, purpose: "separation" };
    if filter < 8 {
        return Err(short("filter", filter, 8));
    }
    if delay == 0 {
        return Err(short("delay", 0, 1));
    }
    let least = filter.saturating_mul(SEGMENTS / 2 + 2).saturating_add(delay);
    check_signal(signal, least, "separation with this filter and delay")?;
    let delay = filter + delay;
    let (past, present) = (&signal[..signal.len() - delay], &signal[delay..]);
    let window = Window::Hann.samples(filter)?;
    let mut planner = RealFftPlanner::<f64>::new();
    let forward = planner.plan_fft_forward(filter);
    let mut cross = vec![Complex::<f64>::default(); filter / 2 + 1];
    let mut power = vec![0.0; filter / 2 + 1];
    let (mut input, mut of_past, mut of_present) =
        (forward.make_input_vec(), forward.make_output_vec(), forward.make_output_vec());
    let mut transform = |segment: &[f64], out: &mut Vec<Complex<f64>>| {
        for (slot, (x, w)) in input.iter_mut().zip(segment.iter().zip(&window)) {
            *slot = x * w;
        }
        forward.process(&mut input, out).expect("both buffers have the plan's lengths");
    };
    for start in (0..=past.len() - filter).step_by(filter / 2) {
        transform(&past[start..start + filter], &mut of_past);
        transform(&present[start..start + filter], &mut of_present);
        for (n, (a, b)) in of_past.iter().zip(&of_present).enumerate() {
            cross[n] += a.conj() * b;
            power[n] += a.norm_sqr();
        }
    }
    if power.iter().all(|p| *p == 0.0) {
        return Err(Error::Undefined { quantity: "the predicted part", why: "the signal is zero" });
    }
    let mut response: Vec<Complex<f64>> = cross
        .iter()
        .zip(&power)
        .map(|(c, p)| if *p > 0.0 { c / (p * filter as f64) } else { Complex::default() })
        .collect();
    let mut taps = vec![0.0; filter];
    let last = response.len() - 1;
    response[0].im = 0.0;
    if filter.is_multiple_of(2) {
        response[last].im = 0.0;
    }
    planner
        .plan_fft_inverse(filter)
        .process(&mut response, &mut taps)
        .expect("the ends of the response are real");
    let discrete = predicted(signal, &taps, delay);
    let random = signal.iter().zip(&discrete).map(|(x, d)| x - d).collect();
    Ok(Separated { discrete, random })
}

/// `signal`, `delay` samples ago, through `taps` that wrap about: the second half stands before zero.
fn predicted(signal: &[f64], taps: &[f64], delay: usize) -> Vec<f64> {
    let len = signal.len() + taps.len() + delay;
    let len = len.next_power_of_two();
    let mut planner = RealFftPlanner::<f64>::new();
    let (forward, inverse) = (planner.plan_fft_forward(len), planner.plan_fft_inverse(len));
    let mut padded = vec![0.0; len];
    padded[..signal.len()].copy_from_slice(signal);
    let mut lines = forward.make_output_vec();
    forward.process(&mut padded, &mut lines).expect("both buffers have the plan's lengths");
    let half = taps.len().div_ceil(2);
    let mut placed = vec![0.0; len];
    for (n, h) in taps.iter().enumerate() {
        let lag = delay as isize + n as isize - if n >= half { taps.len() as isize } else { 0 };
        placed[lag.rem_euclid(len as isize) as usize] += h;
    }
    let mut response = forward.make_output_vec();
    forward.process(&mut placed, &mut response).expect("both buffers have the plan's lengths");
    lines.iter_mut().zip(&response).for_each(|(x, h)| *x *= h / len as f64);
    let last = lines.len() - 1;
    lines[0].im = 0.0;
    lines[last].im = 0.0;
    inverse.process(&mut lines, &mut padded).expect("the ends of the spectrum are real");
    padded.truncate(signal.len());
    padded
}
