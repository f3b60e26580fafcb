//! Arrays of numbers that are aligned to lines of cache.

use std::ops::{Deref, DerefMut};

use aligned_vec::{AVec, ConstAlign};
use serde::{Deserialize, Serialize};

/// Bytes of a line of cache, and of eight numbers.
const LINE: usize = 64;

/// An array of numbers whose first one begins a line of cache: a vector loaded at a multiple of its length
/// never spans two lines. It reads and writes as a slice.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Field<T = f64>(AVec<T, ConstAlign<LINE>>);

impl<T: Copy + Default> Field<T> {
    /// `n` zeros.
    pub fn zeros(n: usize) -> Self {
        std::iter::repeat_n(T::default(), n).collect()
    }

    /// Adds a value at the end.
    pub fn push(&mut self, value: T) {
        self.0.push(value);
    }

    /// Changes the length to `n`; new values are zero.
    pub fn resize(&mut self, n: usize) {
        self.0.resize(n, T::default());
    }

    /// Removes all values and keeps the memory.
    pub fn clear(&mut self) {
        self.0.clear();
    }
}

impl<T> Default for Field<T> {
    fn default() -> Self {
        Self(AVec::new(LINE))
    }
}

impl<T> FromIterator<T> for Field<T> {
    fn from_iter<I: IntoIterator<Item = T>>(values: I) -> Self {
        Self(AVec::from_iter(LINE, values))
    }
}

impl<T> Deref for Field<T> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        &self.0
    }
}

impl<T> DerefMut for Field<T> {
    fn deref_mut(&mut self) -> &mut [T] {
        &mut self.0
    }
}

impl<'a, T> IntoIterator for &'a Field<T> {
    type Item = &'a T;
    type IntoIter = std::slice::Iter<'a, T>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl<T> From<Vec<T>> for Field<T> {
    fn from(values: Vec<T>) -> Self {
        values.into_iter().collect()
    }
}
