//! Annuli that are fine along one of their circles and coarse away from it.

use std::f64::consts::TAU;

use crate::annulus::{Annulus, Place};
use crate::characteristic_length;
use crate::error::{count, elements};
use crate::groove;
use crate::{Error, Part};

/// One of the two circles of an annulus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Circle {
    /// The one of the smaller radius.
    Inner,
    /// The one of the larger radius.
    Outer,
}

/// How an annulus coarsens away from one of its circles.
///
/// The fine circle keeps the `facets` of the annulus, and `fine_layers` of its `layers` follow. Then three
/// facets become one, as often as `transitions` says, and nearly square cells fill the rest:
///
/// ```text
/// t ────────────── t     one facet after the transition
/// │ ╲            ╱ │
/// │   i ────── i   │     height of two fine cells
/// │   │        │   │
/// b ─ b ────── b ─ b     three facets before it
/// ```
///
/// No cell of a transition has a smaller characteristic length than a fine square, so the critical time step
/// is that of the fine mesh. There are no triangles. The nodes t, i, i, t, i, i, … are numbered one after the
/// other: the cells below that zigzag are a strip, and only those above it and the first coarse row are not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Grading {
    /// The circle that stays fine.
    pub fine: Circle,
    /// Layers of full fineness along it, at least one.
    pub fine_layers: usize,
    /// How often three facets become one; zero gives cells of one size.
    pub transitions: usize,
}

/// What the columns of one transition become.
const RATIO: usize = 3;

impl Grading {
    /// Most transitions: 3¹⁰ fine facets for a coarse one are more than any ring has.
    pub const MOST_TRANSITIONS: usize = 10;

    /// Fine facets that one coarse facet replaces.
    pub fn ratio(&self) -> usize {
        RATIO.pow(self.transitions.min(Self::MOST_TRANSITIONS) as u32)
    }

    /// Fewest `layers` of an annulus in which this grading has room.
    pub fn layers_needed(&self) -> usize {
        // Half a coarse cell may be stretched to a whole one, or a little more.
        self.depth() + self.ratio().div_ceil(2)
    }

    /// Layers between the fine circle and the coarse rows.
    fn depth(&self) -> usize {
        let transition =
            |level: usize| 2 * RATIO.pow(level as u32) + self.straight_rows(level) * RATIO.pow(level as u32);
        match self.transitions.min(Self::MOST_TRANSITIONS) {
            0 => self.fine_layers,
            transitions => (0..transitions).map(transition).sum(),
        }
    }

    /// Rows of equal cells before a transition. One row between two of them keeps their corners apart.
    fn straight_rows(&self, level: usize) -> usize {
        if level == 0 { self.fine_layers } else { 1 }
    }

    fn check(&self, annulus: &Annulus) -> Result<(), Error> {
        const SHAPE: &str = "graded annulus";
        let advice = "the fine circle needs one layer of fine cells";
        count(SHAPE, "fine_layers", self.fine_layers, 1, advice)?;
        let refuse = |field, value, least, most, advice| {
            Err(Error::Count { shape: SHAPE, field, value, least, most, advice })
        };
        if self.transitions > Self::MOST_TRANSITIONS {
            return refuse(
                "transitions",
                self.transitions,
                0,
                Self::MOST_TRANSITIONS,
                "use a finer coarse mesh",
            );
        }
        let (ratio, facets) = (self.ratio(), annulus.facets);
        if !facets.is_multiple_of(ratio) {
            let (shape, field, value) = (SHAPE, "facets", facets);
            return Err(Error::NotMultiple {
                shape,
                field,
                value,
                of: ratio,
                nearest: nearest_multiple(facets, ratio),
            });
        }
        let advice = "use fewer `transitions` or more facets";
        count(SHAPE, "facets", facets, 8 * ratio, advice)?;
        let advice = "use fewer `fine_layers` or `transitions`, or finer layers";
        count(SHAPE, "layers", annulus.layers, self.layers_needed(), advice)?;
        if self.fine == Circle::Outer && annulus.groove.is_some() {
            let (field, other) = ("groove", "fine: Circle::Outer");
            let advice = "a groove lies in the inner circle, so that one must be the fine one";
            return Err(Error::Conflict { shape: SHAPE, field, other, advice });
        }
        elements(SHAPE, "layers", annulus.layers, facets)
    }
}

/// The positive multiple of `of` that is nearest to `value`.
fn nearest_multiple(value: usize, of: usize) -> usize {
    ((value + of / 2) / of).max(1) * of
}

impl Annulus {
    /// Makes a graded mesh.
    ///
    /// `layers` is what the annulus would have if all cells were fine; it sets the thickness of the fine layers.
    /// Nodes are numbered in rows from the fine circle to the coarse one. Surfaces are those of
    /// [`Annulus::part`]; the coarse one has `facets` divided by [`Grading::ratio`].
    ///
    /// # Errors
    /// Those of [`Annulus::part`]; facets that are no multiple of the ratio or leave fewer than 8 coarse ones,
    /// fewer layers than [`Grading::layers_needed`], and a groove in the coarse circle.
    pub fn graded_part(&self, grading: &Grading) -> Result<Part, Error> {
        self.check()?;
        grading.check(self)?;
        let lattice = Lattice::new(self, grading);
        let mut part = Part::default();
        for Place { column, row } in &lattice.places {
            let radius = self.row_radius(*row);
            let (sin, cos) = self.column_angle(*column).sin_cos();
            part.push_node(radius * cos, radius * sin);
        }
        part.quads = lattice.quads;
        let circle = |row: Row| (0..row.columns).map(move |c| row.node(c));
        let (front, back) = (lattice.front, lattice.back);
        let (inner, outer) = match grading.fine {
            Circle::Inner => (front, back),
            Circle::Outer => (back, front),
        };
        part.push_surface("inner", circle(inner).rev().collect(), true);
        part.push_surface("outer", circle(outer).collect(), true);
        if let Some(groove) = &self.groove {
            groove::cut(self, groove, &lattice.places, enough(self), &mut part)?;
        }
        Ok(part)
    }
}

/// Length at which the cells around a groove stop growing, relative to a fine square: a little more, so that the
/// worst of them, which falls short of it, is no smaller than in a mesh of fine cells only.
const ENOUGH: f64 = 1.05;

/// Characteristic length that the cells around a groove should reach [m].
fn enough(annulus: &Annulus) -> f64 {
    let facet = TAU * annulus.inner_radius / annulus.facets as f64;
    let side = facet.min((annulus.outer_radius - annulus.inner_radius) / annulus.layers as f64);
    let square = [[0.0, 0.0], [side, 0.0], [side, side], [0.0, side]];
    ENOUGH * characteristic_length(&square, groove::POISSON)
}

/// A closed row of nodes.
#[derive(Clone, Copy)]
struct Row {
    first: u32,
    columns: usize,
    /// Step of the node numbers from column to column.
    stride: usize,
}

impl Row {
    fn node(&self, column: usize) -> u32 {
        self.first + (self.stride * (column % self.columns)) as u32
    }
}

/// The graded annulus unrolled.
struct Lattice {
    places: Vec<Place>,
    quads: Vec<[u32; 4]>,
    fine: Circle,
    /// Layers of the annulus.
    layers: f64,
    front: Row,
    back: Row,
}

impl Lattice {
    fn new(annulus: &Annulus, grading: &Grading) -> Self {
        let front = Row { first: 0, columns: annulus.facets, stride: 1 };
        let (fine, layers) = (grading.fine, annulus.layers as f64);
        let mut lattice = Self { places: Vec::new(), quads: Vec::new(), fine, layers, front, back: front };
        lattice.push_row(front.columns, |_| 0.0);
        let (mut row, mut depth, mut cell) = (front, 0, 1);
        for level in 0..grading.transitions {
            for _ in 0..grading.straight_rows(level) {
                depth += cell;
                row = lattice.add_row(row, |_| depth as f64);
            }
            row = lattice.add_transition(row, depth, cell);
            depth += 2 * cell;
            cell *= RATIO;
        }
        let rows = coarse_rows(annulus, grading, depth, row.columns);
        let rest = (annulus.layers - depth) as f64;
        for i in 1..=rows {
            // The last depth is exact, so that no rounding moves the coarse circle.
            let below = if i == rows { rest } else { rest * i as f64 / rows as f64 };
            row = lattice.add_row(row, |_| depth as f64 + below);
        }
        lattice.back = row;
        lattice
    }

    /// A row of nodes, no cells yet. Depths are layers below the fine circle.
    fn push_row(&mut self, columns: usize, depth: impl Fn(usize) -> f64) -> Row {
        let first = self.places.len() as u32;
        let spacing = self.front.columns / columns;
        for c in 0..columns {
            let row = match self.fine {
                Circle::Inner => depth(c),
                Circle::Outer => self.layers - depth(c),
            };
            self.places.push(Place { column: spacing * c, row });
        }
        Row { first, columns, stride: 1 }
    }

    /// A row of nodes and the cells between it and the one before.
    fn add_row(&mut self, near: Row, depth: impl Fn(usize) -> f64) -> Row {
        let far = self.push_row(near.columns, depth);
        for c in 0..near.columns {
            self.add_quad([near.node(c), near.node(c + 1)], [far.node(c), far.node(c + 1)]);
        }
        far
    }

    /// The zigzag and the cells on both of its sides; gives the coarse row that its peaks are.
    fn add_transition(&mut self, near: Row, depth: usize, cell: usize) -> Row {
        let height = |c: usize| if c.is_multiple_of(RATIO) { 2 * cell } else { cell };
        let zigzag = self.add_row(near, |c| (depth + height(c)) as f64);
        for c in (0..near.columns).step_by(RATIO) {
            let [peak, valley, other_valley, other_peak] = [0, 1, 2, 3].map(|i| zigzag.node(c + i));
            self.add_quad([valley, other_valley], [peak, other_peak]);
        }
        Row { first: zigzag.first, columns: near.columns / RATIO, stride: RATIO }
    }

    /// A cell between two neighbouring nodes and the two beyond them, counter-clockwise.
    fn add_quad(&mut self, near: [u32; 2], far: [u32; 2]) {
        self.quads.push(match self.fine {
            Circle::Inner => [far[0], far[1], near[1], near[0]],
            Circle::Outer => [near[0], near[1], far[1], far[0]],
        });
    }
}

/// Rows of nearly square cells between `depth` and the coarse circle.
fn coarse_rows(annulus: &Annulus, grading: &Grading, depth: usize, columns: usize) -> usize {
    let rest = (annulus.outer_radius - annulus.inner_radius) * (annulus.layers - depth) as f64
        / annulus.layers as f64;
    if grading.transitions == 0 {
        return annulus.layers - depth;
    }
    let middle = match grading.fine {
        Circle::Inner => annulus.outer_radius - 0.5 * rest,
        Circle::Outer => annulus.inner_radius + 0.5 * rest,
    };
    ((rest * columns as f64 / (TAU * middle)).round() as usize).max(1)
}
