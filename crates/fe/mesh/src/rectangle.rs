//! Rectangles of equal cells.

use crate::error::{count, elements, finite, positive};
use crate::rows::{self, NextRow};
use crate::smoothing::sound;
use crate::{Error, Part};

/// A rectangle of equal cells with sides along the axes.
///
/// [`Rectangle::part`] numbers the nodes row by row from the bottom, each row from left to right. Surfaces,
/// all open and sharing their corner nodes: `bottom`, `right`, `top`, `left`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rectangle {
    /// Abscissa of the lower left corner [m].
    pub x0: f64,
    /// Ordinate of the lower left corner [m].
    pub y0: f64,
    /// Extent along x [m].
    pub width: f64,
    /// Extent along y [m].
    pub height: f64,
    /// Elements along x.
    pub columns: usize,
    /// Elements along y.
    pub rows: usize,
}

impl Rectangle {
    /// Makes the mesh.
    ///
    /// # Errors
    /// A dimension that is not positive, a corner that is not finite, a count of zero.
    pub fn part(&self) -> Result<Part, Error> {
        const SHAPE: &str = "rectangle";
        finite(SHAPE, "x0", self.x0)?;
        finite(SHAPE, "y0", self.y0)?;
        positive(SHAPE, "width", self.width)?;
        positive(SHAPE, "height", self.height)?;
        count(SHAPE, "columns", self.columns, 1, "divide the width by the element size")?;
        count(SHAPE, "rows", self.rows, 1, "divide the height by the element size")?;
        elements(SHAPE, "rows", self.rows, self.columns)?;
        let mut part = Part::default();
        for row in 0..=self.rows {
            let y = self.y0 + self.height * row as f64 / self.rows as f64;
            for column in 0..=self.columns {
                part.push_node(self.x0 + self.width * column as f64 / self.columns as f64, y);
            }
        }
        part.quads = rows::quads(0, self.rows, self.columns + 1, false, NextRow::Above);
        push_sides(&mut part, self.rows, self.columns, ["bottom", "right", "top", "left"]);
        sound(SHAPE, part)
    }
}

/// Names the four sides of a grid whose rows run from left to right and upwards.
pub(crate) fn push_sides(part: &mut Part, rows: usize, columns: usize, names: [&str; 4]) {
    let node = |row, column| rows::node(row, column, columns + 1);
    part.push_surface(names[0], (0..=columns).map(|c| node(0, c)).collect(), false);
    part.push_surface(names[1], (0..=rows).map(|r| node(r, columns)).collect(), false);
    part.push_surface(names[2], (0..=columns).rev().map(|c| node(rows, c)).collect(), false);
    part.push_surface(names[3], (0..=rows).rev().map(|r| node(r, 0)).collect(), false);
}
