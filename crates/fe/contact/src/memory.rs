//! State of a pass from step to step, and its layout in memory.

use std::ops::Range;

use serde::{Deserialize, Serialize};
use stribeck_simd::{field::Field, lanes::LANES};

use crate::points::Pattern;

/// State of a pass from step to step, of the points of its candidates alone, laid out by its [`Arrangement`],
/// so that data of every step lie close together. Facets of many points have whole vectors, each in a line of
/// cache; after the last point there is padding for a vector.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Memory {
    pub(crate) candidates: Vec<Candidate>,
    /// Facet of the primary surface on which each point was last found.
    pub(crate) nearest: Vec<u32>,
    /// Number of steps after the search during which each point cannot touch; the step that contains its end
    /// evaluates the point again.
    pub(crate) inactive_until: Field,
    /// History of points in contact; `None` without damping and friction.
    pub(crate) history: Option<Histories>,
    /// Largest recent speed at which a point of the pass opened or closed [m/s].
    pub(crate) pace: f64,
    /// Step of the last search.
    pub(crate) searched: u64,
    /// No candidate is active before this step.
    pub(crate) idle_until: u64,
}

/// A facet that may touch.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Candidate {
    /// Not evaluated before this step.
    pub(crate) active_from: u64,
    pub(crate) facet: u32,
    /// First of its points in the state of the pass.
    pub(crate) first: u32,
    pub(crate) pattern: Pattern,
    /// Positions of its end nodes in the arrays of the surface.
    pub(crate) ends: [u32; 2],
}

impl Candidate {
    /// Its points in the state of the pass, where that is row by row.
    #[inline(always)]
    pub(crate) fn range(&self) -> Range<usize> {
        self.first as usize..(self.first + self.pattern.points) as usize
    }
}

/// Layout of the state of points in memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Arrangement {
    /// Facet by facet.
    Rows,
    /// [`LANES`] facets side by side, whatever the instruction set: the first point of each, then the second
    /// of each, and so on.
    Bands {
        /// Points that a facet has room for.
        points: usize,
    },
}

impl Arrangement {
    /// Distance of a facet's points.
    #[inline(always)]
    pub(crate) fn stride(self) -> usize {
        match self {
            Self::Rows => 1,
            Self::Bands { .. } => LANES,
        }
    }

    /// First point of the facet after `before` others that take `taken` places, and places that are taken
    /// with it.
    pub(crate) fn next(self, before: usize, taken: usize, pattern: Pattern) -> (usize, usize) {
        match self {
            Self::Rows => (taken, taken + pattern.room() as usize),
            Self::Bands { points } => {
                let (band, lane) = (before / LANES * LANES * points, before % LANES);
                (band + lane, band + LANES * points)
            }
        }
    }
}

/// History of points in contact from the step before, one array a field.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Histories {
    /// Elastic part of the tangential displacement [m].
    pub(crate) slip: Field,
    /// Damping force [N].
    pub(crate) damping: Field,
}

impl Histories {
    /// Whether there is one for each of `n` points, and padding after them.
    pub(crate) fn serve(&self, n: usize) -> bool {
        self.slip.len() == n + LANES && self.damping.len() == n + LANES
    }
}

/// Steps that a point without a foot is inactive: until the next search.
pub(crate) const NEVER: f64 = 1e9;

impl Memory {
    /// Of no candidates.
    pub(crate) fn new(remembers: bool) -> Self {
        let mut memory = Self { history: remembers.then(Histories::default), ..Self::default() };
        memory.clear();
        memory.pad();
        memory
    }

    pub(crate) fn clear(&mut self) {
        self.candidates.clear();
        self.nearest.clear();
        self.inactive_until.clear();
        if let Some(history) = &mut self.history {
            history.slip.clear();
            history.damping.clear();
        }
    }

    /// Pads the arrays after the last point to whole vectors.
    pub(crate) fn pad(&mut self) {
        let padded = self.nearest.len() + LANES;
        self.inactive_until.resize(padded);
        if let Some(history) = &mut self.history {
            history.slip.resize(padded);
            history.damping.resize(padded);
        }
    }

    /// Makes room for the points of one more candidate; the number of the first.
    pub(crate) fn room_for(&mut self, pattern: Pattern, arrangement: Arrangement) -> usize {
        let (first, taken) = arrangement.next(self.candidates.len(), self.nearest.len(), pattern);
        self.nearest.resize(taken, 0);
        // Places without a point are never active.
        while self.inactive_until.len() < taken {
            self.inactive_until.push(NEVER);
        }
        if let Some(history) = &mut self.history {
            history.slip.resize(taken);
            history.damping.resize(taken);
        }
        first
    }

    /// Sets a point; one that was `known` as number `i` of another memory keeps its history.
    pub(crate) fn set(
        &mut self,
        point: usize,
        nearest: u32,
        inactive_until: f64,
        known: Option<(&Self, usize)>,
    ) {
        (self.nearest[point], self.inactive_until[point]) = (nearest, inactive_until);
        if let (Some(history), Some((memory, i))) = (&mut self.history, known)
            && let Some(past) = &memory.history
        {
            (history.slip[point], history.damping[point]) = (past.slip[i], past.damping[i]);
        }
    }
}
