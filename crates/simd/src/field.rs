//! One value for each slot, where whole groups of lanes lie in one line of cache.

use std::ops::{Deref, DerefMut};

use aligned_vec::{AVec, ConstAlign};
use serde::{Deserialize, Serialize};

/// Bytes of a line of cache, and of eight numbers.
const LINE: usize = 64;

/// A flat array of numbers; it begins with a line of cache, so that every eighth number does.
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

    /// Makes it `n` values long; new ones are zero.
    pub fn resize(&mut self, n: usize) {
        self.0.resize(n, 0.0);
    }

    /// Forgets all values and keeps their room.
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
