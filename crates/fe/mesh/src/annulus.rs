//! Rings, with or without grooves in one of their surfaces.

use crate::error::{count, elements, finite, positive};
use crate::groove::{self, Groove};
use crate::polar_grid::{Circle, Place, PolarGrid};
use crate::rows::{self, NextRow};
use crate::smoothing::sound;
use crate::{Error, Part};

/// An annulus about the origin, made of quadrilaterals in circumferential rows.
///
/// Row 0 of the nodes is the inner surface, the last row the outer one, or the other way round where grooves
/// are cut into the outer one; each row runs counter-clockwise and node = row × `facets` + column. Surfaces,
/// both closed: `inner` (walked clockwise) and `outer` (counter-clockwise, its first node at `start_angle`,
/// or two facets or so beside it where there are grooves).
#[derive(Clone, Debug, PartialEq)]
pub struct Annulus {
    /// Radius of the inner circle [m].
    pub inner_radius: f64,
    /// Radius of the outer circle [m].
    pub outer_radius: f64,
    /// Facets of each of the two surfaces.
    pub facets: usize,
    /// Elements through the thickness, equally thick where there are no grooves.
    pub layers: usize,
    /// Angle of the first node of every row [rad]; grooves move nodes along the circumference.
    pub start_angle: f64,
    /// Grooves in one of the surfaces, in any order.
    pub grooves: Vec<Groove>,
}

impl Annulus {
    /// Makes the mesh.
    ///
    /// # Errors
    /// Radii that are not positive or not in order, fewer than 8 facets, no layer; for a groove see
    /// [`Groove`].
    pub fn part(&self) -> Result<Part, Error> {
        sound("annulus", self.made(true)?)
    }

    /// As [`part`](Self::part), with cells beside grooves as they fall, some of them inside out: for a ring that
    /// does not deform, whose surfaces and mass alone count. It takes a hundredth of the time.
    ///
    /// # Errors
    /// As [`part`](Self::part), but for elements that are inside out.
    pub fn unshaped_part(&self) -> Result<Part, Error> {
        self.made(false)
    }

    fn made(&self, shaped: bool) -> Result<Part, Error> {
        self.check()?;
        let (grid, n, layers) = (self.grid(), self.facets, self.layers);
        let from = groove::circle_of(&self.grooves)?.unwrap_or(Circle::Inner);
        let mut part = Part::default();
        let mut places = Vec::with_capacity(n * (layers + 1));
        for i in 0..=layers {
            let row = match from {
                Circle::Inner => i,
                Circle::Outer => layers - i,
            };
            let radius = grid.row_radius(row as f64);
            for column in 0..n {
                let (sin, cos) = libm::sincos(grid.column_angle(column));
                part.push_node(radius * cos, radius * sin);
                places.push(Place { column, row: row as f64 });
            }
        }
        let near: Vec<u32> = (0..n as u32).collect();
        let far: Vec<u32> = (0..n).map(|c| rows::node(layers, c, n)).collect();
        let (next, mut inner, outer) = match from {
            Circle::Inner => (NextRow::Outwards, near, far),
            Circle::Outer => (NextRow::Inwards, far, near),
        };
        inner.reverse();
        part.quads = rows::quads(0, layers, n, true, next);
        part.push_surface("inner", inner, true);
        part.push_surface("outer", outer, true);
        groove::cut(&grid, &self.grooves, &places, shaped.then_some(f64::INFINITY), &mut part)?;
        Ok(part)
    }

    /// Its columns and rows, without grooves.
    pub(crate) fn grid(&self) -> PolarGrid {
        let &Self { inner_radius, outer_radius, facets, layers, start_angle, .. } = self;
        PolarGrid { inner_radius, outer_radius, facets, layers, start_angle }
    }

    pub(crate) fn check(&self) -> Result<(), Error> {
        const SHAPE: &str = "annulus";
        positive(SHAPE, "inner_radius", self.inner_radius)?;
        positive(SHAPE, "outer_radius", self.outer_radius)?;
        finite(SHAPE, "start_angle", self.start_angle)?;
        count(SHAPE, "facets", self.facets, 8, "divide the circumference by the element size")?;
        count(SHAPE, "layers", self.layers, 1, "divide the thickness by the element size")?;
        elements(SHAPE, "layers", self.layers, self.facets)?;
        if self.outer_radius <= self.inner_radius {
            let (field, value, limit) = ("outer_radius", self.outer_radius, self.inner_radius);
            let advice = "swap the radii or check them";
            return Err(Error::OutOfRange { shape: SHAPE, field, value, relation: "above", limit, advice });
        }
        Ok(())
    }
}
