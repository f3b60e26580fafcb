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

const SHAPE: &str = "seated block";

impl SeatedBlock {
    /// Makes the mesh.
    ///
    /// # Errors
    /// A dimension that is not positive, a count of zero, a block wider than 99 % of the seat's diameter
    /// (its corners would become needles).
    pub fn part(&self) -> Result<Part, Error> {
        self.check()?;
        let abscissa = |column: usize| self.width * (column as f64 / self.columns as f64 - 0.5);
        Ok(self.divided((0..=self.columns).map(abscissa)))
    }

    /// Makes a mesh whose columns end where the caller wants, for example at the nodes of the body in the seat.
    ///
    /// `inner` are the abscissae [m] of the lines between the columns, ascending, one fewer than `columns`.
    ///
    /// # Errors
    /// Those of [`SeatedBlock::part`]; lines that are not `columns` − 1 or do not ascend between the sides.
    pub fn part_with_lines(&self, inner: &[f64]) -> Result<Part, Error> {
        self.check()?;
        if inner.len() + 1 != self.columns {
            let (field, value) = ("columns", self.columns);
            let (least, most) = (inner.len() + 1, inner.len() + 1);
            let advice = "a line stands between two columns";
            return Err(Error::Count { shape: SHAPE, field, value, least, most, advice });
        }
        let half = 0.5 * self.width;
        let lines: Vec<f64> = [-half].into_iter().chain(inner.iter().copied()).chain([half]).collect();
        for pair in lines.windows(2) {
            // Written so that NaN is refused too.
            let ascending = pair[1] > pair[0];
            if !ascending {
                let (field, value, limit) = ("inner", pair[1], pair[0]);
                let advice = "sort the lines and keep them between the sides";
                return Err(Error::OutOfRange {
                    shape: SHAPE,
                    field,
                    value,
                    relation: "above",
                    limit,
                    advice,
                });
            }
        }
        Ok(self.divided(lines.into_iter()))
    }

    /// Rows of nodes over the given abscissae.
    fn divided(&self, abscissae: impl Iterator<Item = f64> + Clone) -> Part {
        let mut part = Part::default();
        let top = self.seat_radius + self.height;
        for row in 0..=self.rows {
            let up = row as f64 / self.rows as f64;
            for x in abscissae.clone() {
                let seat = (self.seat_radius * self.seat_radius - x * x).sqrt();
                part.push_node(x, seat + (top - seat) * up);
            }
        }
        part.quads = rows::quads(0, self.rows, self.columns + 1, false, NextRow::Above);
        push_sides(&mut part, self.rows, self.columns, ["seat", "right", "top", "left"]);
        part
    }

    fn check(&self) -> Result<(), Error> {
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
        Ok(())
    }
}
