//! Arrays of numbers that are aligned to lines of cache.

use std::ops::{Deref, DerefMut};

use aligned_vec::{AVec, ConstAlign};
use serde::{Deserialize, Serialize};

/// Bytes of a line of cache, and of eight numbers.
const LINE: usize = 64;

/// An array of f64 whose first number begins a line of cache, and so does every eighth one after it: a vector
/// loaded at a multiple of its length never spans two lines. It reads and writes as a slice.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Field(AVec<f64, ConstAlign<LINE>>);

impl Field {
    /// `n` zeros.
    pub fn zeros(n: usize) -> Self {
        std::iter::repeat_n(0.0, n).collect()
    }

    /// Adds a value at the end.
    pub fn push(&mut self, value: f64) {
        self.0.push(value);
    }

    /// Changes the length to `n`; new values are zero.
    pub fn resize(&mut self, n: usize) {
        self.0.resize(n, 0.0);
    }

    /// Removes all values and keeps the memory.
    pub fn clear(&mut self) {
        self.0.clear();
    }
}

impl Default for Field {
    fn default() -> Self {
        Self(AVec::new(LINE))
    }
}

impl FromIterator<f64> for Field {
    fn from_iter<I: IntoIterator<Item = f64>>(values: I) -> Self {
        Self(AVec::from_iter(LINE, values))
    }
}

impl Deref for Field {
    type Target = [f64];

    fn deref(&self) -> &[f64] {
        &self.0
    }
}

impl DerefMut for Field {
    fn deref_mut(&mut self) -> &mut [f64] {
        &mut self.0
    }
}

impl<'a> IntoIterator for &'a Field {
    type Item = &'a f64;
    type IntoIter = std::slice::Iter<'a, f64>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl From<Vec<f64>> for Field {
    fn from(values: Vec<f64>) -> Self {
        values.into_iter().collect()
    }
}
