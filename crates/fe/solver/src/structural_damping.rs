//! Structural damping: a damping ratio that is nearly the same over a band of frequencies (THEORY §2.8).

use std::f64::consts::TAU;

use crate::error::{Error, check};

/// Most branches that a damping may have. Three are flat within some per cent over a factor of a hundred in
/// frequency.
pub const MAX_BRANCHES: usize = 3;

/// A spring and a dashpot in series, beside every element: it adds to the element's stiffness at frequencies
/// far above 1/(2πτ), adds nothing far below, and takes most energy in between.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Branch {
    /// Stiffness of the spring over that of the element [-].
    pub stiffness: f64,
    /// Relaxation time τ [s]: dashpot over spring.
    pub relaxation_time: f64,
}

/// Structural damping of some bodies: one, two or three Maxwell branches beside all of their elements.
#[derive(Debug, Clone, PartialEq)]
pub struct StructuralDamping {
    branches: Vec<Branch>,
    bodies: Vec<usize>,
}

/// Frequencies at which a fit looks at the band, spaced evenly in the logarithm.
const SAMPLES: usize = 100;

/// How close together the relaxation frequencies of a fit may be: the distance of the outer ones over the
/// width of the band, both in the logarithm.
const LEAST_SPREAD: f64 = 0.2;

/// How far they may reach beyond the band, both ends together, in the logarithm.
const BEYOND: f64 = 2.0;

/// Spreads that a fit tries.
const SPREADS: usize = 100;

impl StructuralDamping {
    /// These branches beside the elements of the bodies named by their numbers in the mesh.
    ///
    /// # Errors
    /// When there are more than [`MAX_BRANCHES`], or none, or a branch is not positive and finite.
    pub fn new(branches: Vec<Branch>, bodies: Vec<usize>) -> Result<Self, Error> {
        check_branches(branches.len())?;
        for b in &branches {
            check("stiffness of a branch [-]", b.stiffness, b.stiffness > 0.0, "positive")?;
            let tau = b.relaxation_time;
            check("relaxation time of a branch [s]", tau, tau > 0.0, "positive")?;
        }
        Ok(Self { branches, bodies })
    }

    /// The damping whose ratio is nearest to `ratio` between two frequencies [Hz]: least squares of its
    /// relative deviation, evenly over the logarithm of the frequency. Source: Emmerich and Korn 1987.
    ///
    /// # Errors
    /// When the ratio is not between 0 and 0.1, the band is empty, or so narrow that fewer branches do.
    pub fn over_band(
        ratio: f64,
        [from, to]: [f64; 2],
        branches: usize,
        bodies: Vec<usize>,
    ) -> Result<Self, Error> {
        check_branches(branches)?;
        check(
            "structural damping ratio [-]",
            ratio,
            ratio > 0.0 && ratio <= 0.1,
            "more than 0, at most 0.1",
        )?;
        check("lower end of the damped band [Hz]", from, from > 0.0, "positive")?;
        check("upper end of the damped band [Hz]", to, to > from, "above the lower end")?;
        let width = libm::log(to / from);
        let (least, most) = (LEAST_SPREAD * width, width + BEYOND);
        let fits = (0..SPREADS).filter_map(|i| {
            let spread = least + (most - least) * i as f64 / (SPREADS - 1) as f64;
            // One branch stands in the middle.
            let place = |b: usize| (b as f64 - 0.5 * (branches - 1) as f64) / (branches - 1).max(1) as f64;
            let frequency = |b: usize| (from * to).sqrt() * libm::exp(spread * place(b));
            let times: Vec<f64> = (0..branches).map(|b| 1.0 / (TAU * frequency(b))).collect();
            fitted(ratio, [from, to], &times)
        });
        let best = fits.min_by(|(a, _), (b, _)| a.total_cmp(b));
        let narrow = "a wider band for so many branches";
        let Some((_, branches)) = best else {
            check("upper end of the damped band [Hz]", to, false, narrow)?;
            return Self::new(Vec::new(), bodies);
        };
        Self::new(branches, bodies)
    }

    /// The branches.
    pub fn branches(&self) -> &[Branch] {
        &self.branches
    }

    /// Numbers of the damped bodies in the mesh.
    pub fn bodies(&self) -> &[usize] {
        &self.bodies
    }

    /// Damping ratio of a vibration at `frequency` [Hz]: half of its loss factor.
    pub fn ratio(&self, frequency: f64) -> f64 {
        let [real, imaginary] = modulus(&self.branches, TAU * frequency);
        0.5 * imaginary / real
    }

    /// Stiffness at `frequency` [Hz] over that of the elements alone [-]; it grows from 1 at rest. Infinity
    /// is a frequency.
    pub fn stiffening(&self, frequency: f64) -> f64 {
        if frequency.is_infinite() {
            return 1.0 + self.branches.iter().map(|b| b.stiffness).sum::<f64>();
        }
        modulus(&self.branches, TAU * frequency)[0]
    }

    /// Largest deviation of the ratio from `ratio` between two frequencies [Hz], relative.
    pub fn ripple(&self, ratio: f64, band: [f64; 2]) -> f64 {
        frequencies(band).map(|f| (self.ratio(f) / ratio - 1.0).abs()).fold(0.0, f64::max)
    }
}

impl StructuralDamping {
    /// Steps of `dt` [s] from an evaluation of the branches at `step` to the next: a fifth of the shortest
    /// relaxation time at most, and half of that more or less, by chance.
    ///
    /// Evaluations at even distances would see a vibration of their own frequency, or of a multiple of it,
    /// stand still, and some such vibrations grow. At uneven ones every vibration loses what (2.37) says.
    pub(crate) fn steps_until_next(&self, dt: f64, step: u64) -> u64 {
        let shortest = self.branches.iter().map(|b| b.relaxation_time).fold(f64::INFINITY, f64::min);
        let mean = ((shortest / (EVALUATIONS * dt)) as u64).clamp(1, MOST_STEPS);
        let spread = mean / 2;
        mean - spread + scrambled(step) % (2 * spread + 1)
    }
}

/// Least number of evaluations in the shortest relaxation time.
const EVALUATIONS: f64 = 5.0;

/// Most steps from one evaluation to the next, on average.
const MOST_STEPS: u64 = 64;

/// A number without any pattern for each step, the same in every run. Source: SplitMix64, Steele, Lea and
/// Flood 2014.
fn scrambled(step: u64) -> u64 {
    let z = step.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

fn check_branches(count: usize) -> Result<(), Error> {
    let possible = (1..=MAX_BRANCHES).contains(&count);
    check("branches of a structural damping", count as f64, possible, "1, 2 or 3")
}

/// Real and imaginary part of the stiffness at an angular frequency [rad/s] over that of the elements alone.
fn modulus(branches: &[Branch], omega: f64) -> [f64; 2] {
    branches.iter().fold([1.0, 0.0], |[real, imaginary], b| {
        let [stored, lost] = relaxed(omega * b.relaxation_time);
        [real + b.stiffness * stored, imaginary + b.stiffness * lost]
    })
}

/// iωτ/(1 + iωτ).
fn relaxed(wt: f64) -> [f64; 2] {
    let below = 1.0 + wt * wt;
    [wt * wt / below, wt / below]
}

/// Frequencies [Hz] over a band, both ends included.
fn frequencies([from, to]: [f64; 2]) -> impl Iterator<Item = f64> {
    (0..SAMPLES).map(move |i| from * libm::pow(to / from, i as f64 / (SAMPLES - 1) as f64))
}

/// The branches with these relaxation times [s] that are nearest to a ratio over a band [Hz], and how far off
/// they are; `None` where one would have to be negative.
///
/// Loss factor 2ζ asks for Σ g (lost − 2ζ stored) = 2ζ, which is linear in the stiffnesses g.
fn fitted(ratio: f64, band: [f64; 2], times: &[f64]) -> Option<(f64, Vec<Branch>)> {
    let loss = 2.0 * ratio;
    let row = |f: f64| -> Vec<f64> {
        let of = |tau: &f64| {
            let [stored, lost] = relaxed(TAU * f * tau);
            (lost - loss * stored) / loss
        };
        times.iter().map(of).collect()
    };
    let n = times.len();
    let mut normal = vec![vec![0.0; n + 1]; n];
    for f in frequencies(band) {
        let row = row(f);
        for (i, line) in normal.iter_mut().enumerate() {
            (0..n).for_each(|j| line[j] += row[i] * row[j]);
            line[n] += row[i];
        }
    }
    let stiffnesses = solved(normal)?;
    if stiffnesses.iter().any(|&g| !(g > 0.0 && g.is_finite())) {
        return None;
    }
    let off = |f: f64| row(f).iter().zip(&stiffnesses).map(|(r, g)| r * g).sum::<f64>() - 1.0;
    let residual = frequencies(band).map(|f| off(f).powi(2)).sum();
    let branch = |(&stiffness, &relaxation_time): (&f64, &f64)| Branch { stiffness, relaxation_time };
    Some((residual, stiffnesses.iter().zip(times).map(branch).collect()))
}

/// Solution of a few linear equations with a symmetric, positive matrix; the right side is the last column.
fn solved(mut rows: Vec<Vec<f64>>) -> Option<Vec<f64>> {
    let n = rows.len();
    for i in 0..n {
        if rows[i][i] <= 0.0 {
            return None;
        }
        let pivot = rows[i].clone();
        for row in &mut rows[i + 1..] {
            let factor = row[i] / pivot[i];
            (i..=n).for_each(|j| row[j] -= factor * pivot[j]);
        }
    }
    let mut found = vec![0.0; n];
    for i in (0..n).rev() {
        let known: f64 = (i + 1..n).map(|j| rows[i][j] * found[j]).sum();
        found[i] = (rows[i][n] - known) / rows[i][i];
    }
    Some(found)
}

#[cfg(test)]
mod tests;
