//! From stored to physical values: straight lines, polynomials, quotients and tables, one after the other.

use std::ops::RangeInclusive;
use std::sync::Arc;

use stribeck_dsp::channel::Samples;

use crate::{Channel, Result};

/// A law from stored to physical values. LabVIEW and MDF files bring theirs along.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Curve {
    /// Coefficients, that of the constant first.
    Polynomial(Vec<f64>),
    /// Coefficients of numerator and denominator, that of the constant first.
    Quotient([f64; 3], [f64; 3]),
    /// Abscissae, which ascend, and ordinates; linear between them, constant outside.
    Table(Vec<f64>, Vec<f64>),
    /// The ordinate of the nearest abscissa.
    Steps(Vec<f64>, Vec<f64>),
    /// The first is applied first.
    Chain(Vec<Curve>),
}

impl Curve {
    /// `offset + slope · stored`.
    pub(crate) fn linear(offset: f64, slope: f64) -> Self {
        Self::Polynomial(vec![offset, slope])
    }

    /// A table, its pairs in the order of their abscissae; `None` where two abscissae are one or are no
    /// numbers.
    pub(crate) fn table(x: &[f64], y: &[f64], between: bool) -> Option<Self> {
        let mut pairs: Vec<(f64, f64)> = x.iter().copied().zip(y.iter().copied()).collect();
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
        let ascends = pairs.windows(2).all(|w| w[0].0 < w[1].0);
        if pairs.is_empty() || x.len() != y.len() || !ascends {
            return None;
        }
        let (x, y) = pairs.into_iter().unzip();
        Some(if between { Self::Table(x, y) } else { Self::Steps(x, y) })
    }

    /// The physical value of a stored one.
    pub(crate) fn at(&self, x: f64) -> f64 {
        let sum = |all: &[f64]| all.iter().rev().fold(0.0, |sum, c| sum * x + c);
        match self {
            Self::Polynomial(all) => sum(all),
            Self::Quotient(above, below) => sum(above) / sum(below),
            Self::Table(..) | Self::Steps(..) if x.is_nan() => x,
            Self::Table(xs, ys) => {
                let n = xs.partition_point(|at| *at <= x);
                match (n.checked_sub(1), xs.get(n)) {
                    (None, _) => ys[0],
                    (Some(m), None) => ys[m],
                    (Some(m), Some(next)) => ys[m] + (ys[n] - ys[m]) * (x - xs[m]) / (next - xs[m]),
                }
            }
            Self::Steps(xs, ys) => {
                let n = xs.partition_point(|at| *at <= x).min(xs.len() - 1);
                let before = n.saturating_sub(1);
                if (x - xs[before]).abs() <= (xs[n] - x).abs() { ys[before] } else { ys[n] }
            }
            Self::Chain(all) => all.iter().fold(x, |x, curve| curve.at(x)),
        }
    }
}

/// Samples along a law.
#[derive(Debug)]
struct Along {
    stored: Arc<dyn Samples>,
    curve: Curve,
}

impl Samples for Along {
    fn for_each_block(&self, len: u64, take: &mut dyn FnMut(&[f64]) -> bool) -> Result<()> {
        let mut values = Vec::new();
        self.stored.for_each_block(len, &mut |block| {
            values.clear();
            values.extend(block.iter().map(|x| self.curve.at(*x)));
            take(&values)
        })
    }
}

/// `channel` with the law of its stored numbers.
pub(crate) fn along(channel: Channel, curve: Option<Curve>) -> Channel {
    match curve {
        Some(curve) => channel.through(|stored| Along { stored, curve }),
        None => channel,
    }
}

/// Stored values that stand for missing samples: some, and all outside of a range.
#[derive(Debug, Clone)]
pub(crate) struct Marks {
    pub(crate) values: Vec<f64>,
    pub(crate) valid: RangeInclusive<f64>,
}

impl Marks {
    fn are_none(&self) -> bool {
        self.values.is_empty() && self.valid == (f64::NEG_INFINITY..=f64::INFINITY)
    }

    fn has(&self, x: f64) -> bool {
        self.values.contains(&x) || !self.valid.contains(&x)
    }
}

#[derive(Debug)]
struct Marked {
    stored: Arc<dyn Samples>,
    marks: Marks,
}

impl Samples for Marked {
    fn for_each_block(&self, len: u64, take: &mut dyn FnMut(&[f64]) -> bool) -> Result<()> {
        let mut values = Vec::new();
        self.stored.for_each_block(len, &mut |block| {
            values.clear();
            values.extend(block.iter().map(|x| if self.marks.has(*x) { f64::NAN } else { *x }));
            take(&values)
        })
    }
}

/// `channel` with samples that are no numbers in place of those stored values.
pub(crate) fn without(channel: Channel, marks: &Marks) -> Channel {
    if marks.are_none() {
        return channel;
    }
    channel.through(|stored| Marked { stored, marks: marks.clone() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_hand_each_law_at_a_few_places() {
        let line = Curve::linear(0.5, 0.001);
        assert_eq!(line.at(2000.0), 2.5);
        assert_eq!(Curve::Polynomial(vec![1.0, 0.0, 2.0]).at(3.0), 19.0);
        assert_eq!(Curve::Quotient([0.0, 6.0, 0.0], [2.0, 0.0, 0.0]).at(3.0), 9.0);
        let table = Curve::table(&[2.0, 0.0], &[10.0, 0.0], true).unwrap();
        assert_eq!([-1.0, 1.0, 5.0].map(|x| table.at(x)), [0.0, 5.0, 10.0]);
        let steps = Curve::table(&[0.0, 2.0], &[0.0, 10.0], false).unwrap();
        assert_eq!([-1.0, 0.9, 1.5, 5.0].map(|x| steps.at(x)), [0.0, 0.0, 10.0, 10.0]);
        assert_eq!(Curve::Chain(vec![line.clone(), line]).at(0.0), 0.5005);
        assert_eq!(Curve::table(&[1.0, 1.0], &[0.0, 0.0], true), None);
    }
}
