//! A block that sits on a circle.

use crate::error::{count, elements, positive};
use crate::rectangle::push_sides;
use crate::rows::{self, NextRow};
use crate::smoothing::sound;
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
        let seat_at = |x: f64| [x, (self.seat_radius * self.seat_radius - x * x).sqrt()];
        let abscissa = |column: usize| self.width * (column as f64 / self.columns as f64 - 0.5);
        let seat: Vec<[f64; 2]> = (0..=self.columns).map(|column| seat_at(abscissa(column))).collect();
        sound(SHAPE, self.over(&seat))
    }

    /// Makes a mesh whose seat is a given polyline, for example through the nodes of the body that sits in
    /// it.
    ///
    /// `seat` are its nodes [m] from left to right, one more than `columns`, from x = −`width`/2 to
    /// `width`/2. Columns stand on them, as wide as they are apart; `seat_radius` gives the height of the top
    /// edge only.
    ///
    /// # Errors
    /// Those of [`SeatedBlock::part`]; a number of nodes that does not fit the columns, nodes that do not go
    /// from side to side, and nodes above the top edge.
    pub fn part_on(&self, seat: &[[f64; 2]]) -> Result<Part, Error> {
        self.check()?;
        if seat.len() != self.columns + 1 {
            let (field, value, most) = ("columns", self.columns, seat.len().saturating_sub(1));
            let advice = "one column stands between two nodes of the seat";
            return Err(Error::Count { shape: SHAPE, field, value, least: most, most, advice });
        }
        let refuse = |value, relation, limit, advice| {
            Err(Error::OutOfRange { shape: SHAPE, field: "seat", value, relation, limit, advice })
        };
        let half = 0.5 * self.width;
        for (end, side) in [(seat[0], -half), (seat[self.columns], half)] {
            if end[0] != side {
                return refuse(end[0], "at", side, "the seat goes from one side of the block to the other");
            }
        }
        for [[left, _], [right, _]] in seat.windows(2).map(|pair| [pair[0], pair[1]]) {
            // Written so that NaN is refused too.
            let ascending = right > left;
            if !ascending {
                return refuse(right, "above", left, "sort the nodes of the seat from left to right");
            }
        }
        let top = self.seat_radius + self.height;
        for [_, y] in seat {
            let below = *y < top;
            if !below {
                return refuse(*y, "below", top, "the seat lies under the top edge");
            }
        }
        sound(SHAPE, self.over(seat))
    }

    /// Rows of nodes between a seat and the top edge.
    fn over(&self, seat: &[[f64; 2]]) -> Part {
        let mut part = Part::default();
        let top = self.seat_radius + self.height;
        for row in 0..=self.rows {
            let up = row as f64 / self.rows as f64;
            for [x, y] in seat {
                part.push_node(*x, y + (top - y) * up);
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
