//! A block that sits on a circle.

use crate::error::{count, elements, positive};
use crate::rectangle::push_sides;
use crate::rows::{self, NextRow};
use crate::{Error, Part};

/// A block with a flat top whose bottom is a concave arc about the origin.
///
/// The arc's crown is at (0, `seat_radius`) and the top edge at y = `seat_radius + height`; the block lies
/// between x = ±`width`/2. Columns are vertical and equally wide; each is divided equally between seat and
/// top. Nodes are numbered row by row from the seat, each row from left to right. Surfaces, all open and
/// sharing their corner nodes: `seat`, `right`, `top`, `left`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeatedBlock {
    /// Extent along x [m]; less than the diameter of the seat.
    pub width: f64,
    /// Height above the crown of the seat [m].
    pub height: f64,
    /// Radius of the seat [m].
    pub seat_radius: f64,
    /// Elements along x, equal to the facets of the seat.
    pub columns: usize,
    /// Elements between seat and top.
    pub rows: usize,
}

impl SeatedBlock {
    /// Makes the mesh.
    ///
    /// # Errors
    /// A dimension that is not positive, a count of zero, a block wider than 99 % of the seat's diameter
    /// (its corners would become needles).
    pub fn part(&self) -> Result<Part, Error> {
        const SHAPE: &str = "seated block";
        positive(SHAPE, "width", self.width)?;
        positive(SHAPE, "height", self.height)?;
        positive(SHAPE, "seat_radius", self.seat_radius)?;
        count(SHAPE, "columns", self.columns, 1, "divide the width by the element size")?;
        count(SHAPE, "rows", self.rows, 1, "divide the height by the element size")?;
        elements(SHAPE, "rows", self.rows, self.columns)?;
        let limit = 0.99 * 2.0 * self.seat_radius;
        if self.width > limit {
            let (field, value, relation) = ("width", self.width, "at most");
            let advice = "keep it below 99 % of the diameter of the seat, or enlarge `seat_radius`";
            return Err(Error::OutOfRange { shape: SHAPE, field, value, relation, limit, advice });
        }
        let mut part = Part::default();
        let top = self.seat_radius + self.height;
        for row in 0..=self.rows {
            let up = row as f64 / self.rows as f64;
            for column in 0..=self.columns {
                let x = self.width * (column as f64 / self.columns as f64 - 0.5);
                let seat = (self.seat_radius * self.seat_radius - x * x).sqrt();
                part.push_node(x, seat + (top - seat) * up);
            }
        }
        part.quads = rows::quads(0, self.rows, self.columns + 1, false, NextRow::Above);
        push_sides(&mut part, self.rows, self.columns, ["seat", "right", "top", "left"]);
        Ok(part)
    }
}
