//! A spall that grows: its law, the units that are drawn from it, and the remaining life of a unit by its
//! records.
//!
//! Progress goes from 0, where the spall begins, to 1, where the unit is at its end: dL/dN ∝ Lᵐ makes
//! L¹⁻ᵐ, or for m = 1 ln L, go evenly over the revolutions N (P. C. Paris and F. Erdogan, J. Basic Eng. 85
//! (1963) 528, with the spall's length in place of a crack's). A unit draws its onset and its rate, and each
//! interval between two records a factor of its own.

mod calibration;
mod remaining;

pub use calibration::{Calibration, Known, Record};
pub use remaining::{Remaining, remaining};
use stribeck_scene::dice::Dice;

use crate::records::normal;

/// How a spall grows. Scatters are standard deviations of the logarithm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Law {
    /// Median revolutions to the onset, and their scatter.
    pub onset: (f64, f64),
    /// Median revolutions from onset to end, and their scatter.
    pub life: (f64, f64),
    /// Scatter of the rate from one record to the next.
    pub wander: f64,
    /// Length at the onset and at the end [mm].
    pub length_mm: (f64, f64),
    /// Exponent m of dL/dN ∝ Lᵐ: 1 is exponential growth.
    pub exponent: f64,
    /// Revolutions between two records.
    pub every: f64,
}

/// One unit on its way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Course {
    onset: f64,
    rate: f64,
    now: f64,
    progress: f64,
    end: Option<f64>,
}

impl Law {
    /// Length [mm] at a progress between 0 and 1.
    pub fn length_mm(&self, progress: f64) -> f64 {
        let (start, end, power) = (self.length_mm.0, self.length_mm.1, 1.0 - self.exponent);
        if power.abs() < 1e-9 {
            return start * (end / start).powf(progress);
        }
        let (a, b) = (start.powf(power), end.powf(power));
        (a + (b - a) * progress).powf(1.0 / power)
    }

    /// A unit at its first record, which is at no revolutions.
    pub fn unit(&self, dice: &mut Dice) -> Course {
        let mut drawn = |(median, scatter): (f64, f64)| median * (scatter * normal(dice)).exp();
        let (onset, life) = (drawn(self.onset), drawn(self.life));
        Course { onset, rate: 1.0 / life, now: 0.0, progress: 0.0, end: None }
    }
}

impl Course {
    /// To the next record; a unit at its end stays there.
    pub fn advance(&mut self, law: &Law, dice: &mut Dice) {
        let rate = self.rate * (law.wander * normal(dice)).exp();
        let (from, to) = (self.now.max(self.onset), self.now + law.every);
        self.now = to;
        if self.end.is_none() && from < to {
            let left = (1.0 - self.progress) / rate;
            if left <= to - from {
                (self.end, self.progress) = (Some(from + left), 1.0);
            } else {
                self.progress += (to - from) * rate;
            }
        }
    }

    /// Revolutions so far.
    pub fn revolutions(&self) -> f64 {
        self.now
    }

    /// Revolutions at which the spall began or will begin.
    pub fn onset(&self) -> f64 {
        self.onset
    }

    /// Revolutions at the end, once it is reached.
    pub fn end(&self) -> Option<f64> {
        self.end
    }

    /// Length [mm]; `None` before the onset.
    pub fn length_mm(&self, law: &Law) -> Option<f64> {
        (self.progress > 0.0).then(|| law.length_mm(self.progress))
    }
}
