//! Columns along the circumference of an annulus and rows through its thickness.

use std::f64::consts::TAU;

/// One of the two circles of an annulus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Circle {
    /// The one of the smaller radius.
    Inner,
    /// The one of the larger radius.
    Outer,
}

/// The plain grid of an annulus about the origin.
#[derive(Clone, Copy)]
pub(crate) struct PolarGrid {
    /// Radius of the circle of row 0 [m], the inner one unless rows are counted from outside.
    pub(crate) inner_radius: f64,
    /// Radius of the circle of the last row [m].
    pub(crate) outer_radius: f64,
    pub(crate) facets: usize,
    /// Rows of elements, equally thick.
    pub(crate) layers: usize,
    /// Angle of the first column [rad].
    pub(crate) start_angle: f64,
}

/// Where a node lies in the grid.
#[derive(Clone, Copy)]
pub(crate) struct Place {
    /// Facets from the first column.
    pub(crate) column: usize,
    /// Layers from the inner surface.
    pub(crate) row: f64,
}

impl PolarGrid {
    /// Radius of a row [m]; a row between two layers has a fractional number.
    pub(crate) fn row_radius(&self, row: f64) -> f64 {
        // The last row is written out, so that no rounding moves the outer surface.
        if row == self.layers as f64 {
            return self.outer_radius;
        }
        self.inner_radius + (self.outer_radius - self.inner_radius) * row / self.layers as f64
    }

    /// Angle of a column [rad].
    pub(crate) fn column_angle(&self, column: usize) -> f64 {
        self.start_angle + TAU * column as f64 / self.facets as f64
    }

    /// The same annulus with its rows counted from the outer circle.
    pub(crate) fn seen_from_outside(&self) -> Self {
        Self { inner_radius: self.outer_radius, outer_radius: self.inner_radius, ..*self }
    }

    /// Thickness of a row of elements [m].
    pub(crate) fn layer(&self) -> f64 {
        (self.outer_radius - self.inner_radius).abs() / self.layers as f64
    }

    /// Length of a facet of the circle of row 0 [m].
    pub(crate) fn inner_facet(&self) -> f64 {
        TAU * self.inner_radius / self.facets as f64
    }
}
