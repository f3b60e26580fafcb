//! One sampled quantity, and its samples in blocks, wherever they lie.
//!
//! Analyses take a [`Channel`]; files of many formats become channels in `stribeck-formats`, and what was
//! simulated is one that is held in memory. [`wav`] has the bytes of a sound.
//!
//! ```
//! use stribeck_dsp::channel::Channel;
//!
//! let sine = Channel::held("sine", (0..1000).map(|n| (0.1 * f64::from(n)).sin()).collect());
//! let mut largest = 0.0_f64;
//! sine.at_rate(Some(1000.0)).scaled(2.0).for_each_block(|block| {
//!     largest = block.iter().fold(largest, |largest, x| largest.max(x.abs()));
//!     true
//! })?;
//! assert!((largest - 2.0).abs() < 1e-3);
//! # Ok::<(), stribeck_dsp::channel::Error>(())
//! ```

mod error;

pub mod memory;
pub mod wav;

use std::any::Any;
use std::fmt::Debug;
use std::panic::{RefUnwindSafe, UnwindSafe};
use std::sync::Arc;

pub use error::{Error, Result};

/// Samples of a block that come from memory.
const BLOCK: usize = 1 << 15;

/// Where the samples of a channel lie.
pub trait Samples: Any + Debug + Send + Sync + UnwindSafe + RefUnwindSafe {
    /// Passes the first `len` samples to `take`, a block at a time, in order, until `take` returns false.
    fn for_each_block(&self, len: u64, take: &mut dyn FnMut(&[f64]) -> bool) -> Result<()>;
}

/// Samples in memory.
impl Samples for Vec<f64> {
    fn for_each_block(&self, len: u64, take: &mut dyn FnMut(&[f64]) -> bool) -> Result<()> {
        let len = usize::try_from(len).unwrap_or(usize::MAX).min(self.len());
        for block in self[..len].chunks(BLOCK) {
            if !take(block) {
                break;
            }
        }
        Ok(())
    }
}

/// One sampled quantity.
#[derive(Debug, Clone)]
pub struct Channel {
    /// Its name.
    pub name: String,
    /// Its unit, where it is known.
    pub unit: Option<String>,
    /// Sample rate [Hz], where it is known.
    pub rate_hz: Option<f64>,
    /// Time of its first sample [s], from an origin that all channels of its file share; `None` where the file
    /// does not say it.
    pub start_s: Option<f64>,
    /// Number of samples.
    pub len: u64,
    /// Whether it is the time, or rises as evenly (a count, an angle), and so is no signal.
    pub is_time: bool,
    /// Channels of one group have one clock; empty where the file has no groups.
    pub group: String,
    /// Number of its column, from 1, where the file is a text in columns.
    pub column: Option<usize>,
    /// Factor of values.
    scale: f64,
    samples: Arc<dyn Samples>,
}

impl Channel {
    /// A channel of `len` samples.
    pub fn new(name: impl Into<String>, len: u64, samples: impl Samples) -> Self {
        Self {
            name: name.into(),
            unit: None,
            rate_hz: None,
            start_s: None,
            len,
            is_time: false,
            group: String::new(),
            column: None,
            scale: 1.0,
            samples: Arc::new(samples),
        }
    }

    /// A channel whose samples are in memory.
    pub fn held(name: impl Into<String>, samples: Vec<f64>) -> Self {
        Self::new(name, samples.len() as u64, samples)
    }

    /// The same channel with a sample rate [Hz].
    pub fn at_rate(mut self, rate_hz: Option<f64>) -> Self {
        self.rate_hz = rate_hz;
        self
    }

    /// The same channel with the time of its first sample [s].
    pub fn from_time(mut self, start_s: Option<f64>) -> Self {
        self.start_s = start_s;
        self
    }

    /// The same channel in a unit.
    pub fn in_unit(mut self, unit: Option<String>) -> Self {
        self.unit = unit;
        self
    }

    /// The same channel in a group with a clock of its own.
    pub fn of_group(mut self, group: &str) -> Self {
        group.clone_into(&mut self.group);
        self
    }

    /// The same channel with every sample multiplied.
    pub fn scaled(&self, factor: f64) -> Self {
        Self { scale: self.scale * factor, ..self.clone() }
    }

    /// The same channel with samples that are made of its own by `make`.
    pub fn through<S: Samples>(self, make: impl FnOnce(Arc<dyn Samples>) -> S) -> Self {
        Self { samples: Arc::new(make(self.samples)), ..self }
    }

    /// The samples, where they are an `S`.
    pub fn samples_as<S: Samples>(&self) -> Option<&S> {
        (&*self.samples as &dyn Any).downcast_ref()
    }

    /// Passes all samples to `take`, a block at a time, in order; `take` returns false to stop.
    ///
    /// # Errors
    /// [`Error::Io`], [`Error::Number`], [`Error::Damaged`] for a file that ends early.
    pub fn for_each_block(&self, mut take: impl FnMut(&[f64]) -> bool) -> Result<()> {
        if self.scale == 1.0 {
            return self.samples.for_each_block(self.len, &mut take);
        }
        let mut scaled = Vec::new();
        self.samples.for_each_block(self.len, &mut |block| {
            scaled.clear();
            scaled.extend(block.iter().map(|x| self.scale * x));
            take(&scaled)
        })
    }

    /// All samples.
    ///
    /// # Errors
    /// As [`Channel::for_each_block`]; [`Error::TooLarge`] for more samples than memory may hold.
    pub fn read(&self) -> Result<Vec<f64>> {
        memory::ask(self.name.as_ref(), "all of its samples at once", self.len.saturating_mul(8))?;
        let mut all = Vec::with_capacity(usize::try_from(self.len).unwrap_or(0).min(1 << 28));
        self.for_each_block(|block| {
            all.extend_from_slice(block);
            true
        })?;
        Ok(all)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a channel of a file would do: samples that are made as they are asked for.
    #[derive(Debug)]
    struct Count;

    impl Samples for Count {
        fn for_each_block(&self, len: u64, take: &mut dyn FnMut(&[f64]) -> bool) -> Result<()> {
            let _ = (0..len).all(|n| take(&[n as f64]));
            Ok(())
        }
    }

    #[test]
    fn behaves_blocks_come_in_order_until_nobody_takes_them() {
        let long: Vec<f64> = (0..3 * BLOCK + 5).map(|n| n as f64).collect();
        let held = Channel::held("a", long.clone());
        assert_eq!(held.read().unwrap(), long);
        let mut blocks = 0;
        held.for_each_block(|block| {
            blocks += 1;
            block[0] < BLOCK as f64
        })
        .unwrap();
        assert_eq!(blocks, 2);
        assert_eq!(Channel { len: 3, ..held }.read().unwrap(), [0.0, 1.0, 2.0]);
    }

    #[test]
    fn by_hand_factors_multiply_and_leave_the_samples_where_they_are() {
        let counted = Channel::new("n", 4, Count).scaled(2.0).scaled(0.25);
        assert_eq!(counted.read().unwrap(), [0.0, 0.5, 1.0, 1.5]);
        assert!(counted.samples_as::<Count>().is_some() && counted.samples_as::<Vec<f64>>().is_none());
        let held = counted.through(|_| vec![8.0; 4]);
        assert_eq!(held.read().unwrap(), [4.0; 4]);
    }
}
