//! Sampled channels on disk: `trace.npy` and `energy.npy`, NumPy structured arrays of little-endian f64.
//!
//! One record a sample, one named field a channel, so `numpy.load("trace.npy")["sensor.side.ay_m_s2"]` is a
//! time history, whatever the number of channels (`header.rs`, `archive.rs`). Names end in their unit. The
//! files hold nothing but the samples: equal runs write equal bytes.

mod archive;
mod file;
mod header;
mod writer;

use std::path::Path;

pub use file::TraceFile;
pub use writer::TraceWriter;

use crate::error::Error;

/// Channels sampled at a fixed interval, in memory.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Trace {
    /// Channel names, in file order; the first is `time_s`.
    pub names: Vec<String>,
    /// Values of each channel, all of one length.
    pub columns: Vec<Vec<f64>>,
}

impl Trace {
    /// Reads all channels of the trace at `path`. Memory is bounded by the size of the file.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, Error> {
        TraceFile::open(path)?.read_all()
    }

    /// Values of the channel called `name`.
    pub fn get(&self, name: &str) -> Option<&[f64]> {
        let at = self.names.iter().position(|n| n == name)?;
        self.columns.get(at).map(Vec::as_slice)
    }

    /// Values of the channel called `name`, which the trace then has no longer.
    pub fn take(&mut self, name: &str) -> Option<Vec<f64>> {
        let at = self.names.iter().position(|n| n == name)?;
        self.names.remove(at);
        Some(self.columns.remove(at))
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.columns.first().map_or(0, Vec::len)
    }

    /// True when nothing was sampled.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

#[cfg(test)]
mod tests;
