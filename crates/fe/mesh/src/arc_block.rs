//! A piece of an annulus between two parallel-walled gaps.

use std::f64::consts::TAU;

use crate::error::{count, elements, finite, positive};
use crate::rows::{self, NextRow};
use crate::smoothing::sound;
use crate::{Error, Part};

/// A piece of an annulus about the origin whose two ends are straight walls.
///
/// Each wall is parallel to a radial line at the distance `half_width` from it, on the side of the piece,
/// so that two neighbouring pieces leave a gap of parallel walls between them. Left is the
/// counter-clockwise end, as seen from the centre: at radius r the piece reaches from
/// `right_line_angle + asin(half_width / r)` to `left_line_angle − asin(half_width / r)`.
///
/// Nodes are numbered in circumferential rows from the inner arc outwards, each row counter-clockwise.
/// Surfaces: `boundary` (closed, each corner node once), and its open pieces `outer`, `left`, `inner`,
/// `right`, which share their corner nodes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArcBlock {
    /// Radius of the inner arc [m].
    pub inner_radius: f64,
    /// Radius of the outer arc [m].
    pub outer_radius: f64,
    /// Angle of the line that the left (counter-clockwise) wall is parallel to [rad].
    pub left_line_angle: f64,
    /// Angle of the line that the right (clockwise) wall is parallel to [rad].
    pub right_line_angle: f64,
    /// Distance from each line to its wall [m]; zero puts the walls on the lines.
    pub half_width: f64,
    /// Elements through the thickness.
    pub rows: usize,
    /// Elements along the circumference.
    pub columns: usize,
}

impl ArcBlock {
    /// Makes the mesh.
    ///
    /// # Errors
    /// Radii that are not positive or not in order, line angles that are not in order or more than a turn
    /// apart, a half width that leaves nothing of the piece, a count of zero.
    pub fn part(&self) -> Result<Part, Error> {
        self.check()?;
        let (rows, columns) = (self.rows, self.columns);
        let mut part = Part::default();
        for row in 0..=rows {
            let along = row as f64 / rows as f64;
            let radius = self.inner_radius + (self.outer_radius - self.inner_radius) * along;
            let (from, to) = self.span(radius);
            for column in 0..=columns {
                let (sin, cos) = libm::sincos(from + (to - from) * column as f64 / columns as f64);
                part.push_node(radius * cos, radius * sin);
            }
        }
        part.quads = rows::quads(0, rows, columns + 1, false, NextRow::Outwards);
        self.push_surfaces(&mut part);
        sound("arc block", part)
    }

    /// First and last angle of the piece at a radius [rad].
    fn span(&self, radius: f64) -> (f64, f64) {
        let half = libm::asin(self.half_width / radius);
        (self.right_line_angle + half, self.left_line_angle - half)
    }

    fn push_surfaces(&self, part: &mut Part) {
        let (rows, columns) = (self.rows, self.columns);
        let node = |row, column| rows::node(row, column, columns + 1);
        let outer: Vec<u32> = (0..=columns).map(|c| node(rows, c)).collect();
        let left: Vec<u32> = (0..=rows).rev().map(|r| node(r, columns)).collect();
        let inner: Vec<u32> = (0..=columns).rev().map(|c| node(0, c)).collect();
        let right: Vec<u32> = (0..=rows).map(|r| node(r, 0)).collect();
        let sides = [("outer", outer), ("left", left), ("inner", inner), ("right", right)];
        let boundary = sides.iter().flat_map(|(_, side)| &side[..side.len() - 1]).copied().collect();
        part.push_surface("boundary", boundary, true);
        for (name, side) in sides {
            part.push_surface(name, side, false);
        }
    }

    fn check(&self) -> Result<(), Error> {
        const SHAPE: &str = "arc block";
        positive(SHAPE, "inner_radius", self.inner_radius)?;
        positive(SHAPE, "outer_radius", self.outer_radius)?;
        finite(SHAPE, "left_line_angle", self.left_line_angle)?;
        finite(SHAPE, "right_line_angle", self.right_line_angle)?;
        finite(SHAPE, "half_width", self.half_width)?;
        count(SHAPE, "rows", self.rows, 1, "divide the thickness by the element size")?;
        count(SHAPE, "columns", self.columns, 1, "divide the arc length by the element size")?;
        elements(SHAPE, "rows", self.rows, self.columns)?;
        let fail = |field, value, relation, limit, advice| {
            Err(Error::OutOfRange { shape: SHAPE, field, value, relation, limit, advice })
        };
        if self.outer_radius <= self.inner_radius {
            let advice = "swap the radii or check them";
            return fail("outer_radius", self.outer_radius, "above", self.inner_radius, advice);
        }
        let turn = self.left_line_angle - self.right_line_angle;
        if turn <= 0.0 {
            let advice = "left is the counter-clockwise end: swap the angles or add a turn to the left one";
            return fail("left_line_angle", self.left_line_angle, "above", self.right_line_angle, advice);
        }
        if turn > TAU {
            let advice = "the piece is longer than a whole turn";
            return fail(
                "left_line_angle",
                self.left_line_angle,
                "at most",
                self.right_line_angle + TAU,
                advice,
            );
        }
        // The walls come nearest to each other on the inner arc.
        let limit = self.inner_radius * libm::sin(0.5 * turn.min(TAU / 2.0));
        if self.half_width < 0.0 {
            return fail("half_width", self.half_width, "at least", 0.0, "a distance has no sign");
        }
        if self.half_width >= limit {
            let advice = "nothing is left of the piece: make the gap narrower or the lines farther apart";
            return fail("half_width", self.half_width, "below", limit, advice);
        }
        Ok(())
    }
}
