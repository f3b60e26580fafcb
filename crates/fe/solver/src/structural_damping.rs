//! Structural damping: a damping ratio that is nearly the same over a band of frequencies (THEORY §2.8).

use std::f64::consts::TAU;

use crate::error::{Error, check};

/// A spring and a dashpot in series, beside every element: it adds to the element's stiffness at frequencies
/// far above 1/(2πτ), adds nothing far below, and takes most energy in between.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Branch {
    /// Stiffness of the spring over that of the element [-].
    pub stiffness: f64,
    /// Relaxation time τ [s]: dashpot over spring.
    pub relaxation_time: f64,
}

/// Structural damping of some bodies: a Maxwell branch beside all of their elements.
#[derive(Debug, Clone, PartialEq)]
pub struct StructuralDamping {
    branch: Branch,
    bodies: Vec<usize>,
}

/// Frequencies at which a fit looks at the band, spaced evenly in the logarithm.
const SAMPLES: usize = 100;

impl StructuralDamping {
    /// This branch beside the elements of the bodies named by their numbers in the mesh.
    ///
    /// # Errors
    /// When stiffness or relaxation time is not positive and finite.
    pub fn new(branch: Branch, bodies: Vec<usize>) -> Result<Self, Error> {
        let Branch { stiffness, relaxation_time } = branch;
        check("stiffness of a branch [-]", stiffness, stiffness > 0.0, "positive")?;
        check("relaxation time of a branch [s]", relaxation_time, relaxation_time > 0.0, "positive")?;
        Ok(Self { branch, bodies })
    }

    /// The damping whose ratio is nearest to `ratio` between two frequencies [Hz]: least squares of its
    /// relative deviation, evenly over the logarithm of the frequency. Source: Emmerich and Korn 1987.
    ///
    /// # Errors
    /// When the ratio is not between 0 and 0.1, or the band is empty or too wide for a branch.
    pub fn over_band(ratio: f64, [from, to]: [f64; 2], bodies: Vec<usize>) -> Result<Self, Error> {
        check(
            "structural damping ratio [-]",
            ratio,
            ratio > 0.0 && ratio <= 0.1,
            "more than 0, at most 0.1",
        )?;
        check("lower end of the damped band [Hz]", from, from > 0.0, "positive")?;
        check("upper end of the damped band [Hz]", to, to > from, "above the lower end")?;
        let relaxation_time = 1.0 / (TAU * (from * to).sqrt());
        // Loss factor 2ζ asks for g (lost − 2ζ stored) = 2ζ.
        let loss = 2.0 * ratio;
        let [square, sum] = frequencies([from, to]).fold([0.0; 2], |[square, sum], frequency| {
            let [stored, lost] = relaxed(TAU * frequency * relaxation_time);
            let row = (lost - loss * stored) / loss;
            [square + row * row, sum + row]
        });
        check("upper end of the damped band [Hz]", to, sum > 0.0, "closer to the lower end")?;
        Self::new(Branch { stiffness: sum / square, relaxation_time }, bodies)
    }

    /// The branch.
    pub fn branch(&self) -> Branch {
        self.branch
    }

    /// Numbers of the damped bodies in the mesh.
    pub fn bodies(&self) -> &[usize] {
        &self.bodies
    }

    /// Damping ratio of a vibration at `frequency` [Hz]: half of its loss factor.
    pub fn ratio(&self, frequency: f64) -> f64 {
        let [real, imaginary] = self.branch.modulus(TAU * frequency);
        0.5 * imaginary / real
    }

    /// Stiffness at `frequency` [Hz] over that of the elements alone [-]; it grows from 1 at rest. Infinity
    /// is a frequency.
    pub fn stiffening(&self, frequency: f64) -> f64 {
        if frequency.is_infinite() {
            return 1.0 + self.branch.stiffness;
        }
        self.branch.modulus(TAU * frequency)[0]
    }

    /// Steps of `dt` [s] from an evaluation of the branch at `step` to the next: a fifth of the relaxation time
    /// at most, and half of that more or less, by chance.
    ///
    /// Evaluations at even distances would see a vibration of their own frequency, or of a multiple of it,
    /// stand still, and some such vibrations grow. At uneven ones every vibration loses what (2.37) says.
    pub(crate) fn steps_until_next(&self, dt: f64, step: u64) -> u64 {
        let mean = ((self.branch.relaxation_time / (EVALUATIONS * dt)) as u64).clamp(1, MOST_STEPS);
        let spread = mean / 2;
        mean - spread + scrambled(step) % (2 * spread + 1)
    }
}

/// Least number of evaluations in a relaxation time.
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

impl Branch {
    /// Real and imaginary part of the stiffness at an angular frequency [rad/s] over that of the elements alone.
    fn modulus(self, omega: f64) -> [f64; 2] {
        let [stored, lost] = relaxed(omega * self.relaxation_time);
        [1.0 + self.stiffness * stored, self.stiffness * lost]
    }
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

#[cfg(test)]
mod tests;
