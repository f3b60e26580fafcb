//! Annuli that are fine along one of their circles and coarse away from it.

use std::f64::consts::TAU;

use crate::annulus::Annulus;
use crate::error::{count, elements};
use crate::groove;
use crate::polar_grid::{Circle, Place};
use crate::smoothing::{enough, sound};
use crate::{Error, Part};

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
/// Where three do not divide the facets, one or two such groups have two facets, and a triangle instead of
/// the upper cell; these are the only triangles. The nodes t, i, i, t, i, i, … are numbered one after the
/// other: the cells below that zigzag are a strip, and only those above it and the first coarse row are not.
///
/// In a transition away from a groove no quadrilateral has a smaller characteristic length than a fine
/// square, so the critical time step is that of the fine mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Grading {
    /// The circle that stays fine.
    pub fine: Circle,
    /// Layers of full fineness along it, at least one.
    pub fine_layers: usize,
    /// How often three facets become one; zero gives cells of one size.
    pub transitions: usize,
}

/// Fine facets that become one in a transition.
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
        let advice = "use fewer `transitions` or more facets";
        count(SHAPE, "facets", annulus.facets, 8 * self.ratio(), advice)?;
        let advice = "use fewer `fine_layers` or `transitions`, or finer layers";
        count(SHAPE, "layers", annulus.layers, self.layers_needed(), advice)?;
        if annulus.grooves.iter().any(|groove| groove.circle != self.fine) {
            let (field, other) = ("grooves", "fine");
            let advice = "a groove lies in the fine circle";
            return Err(Error::Conflict { shape: SHAPE, field, other, advice });
        }
        elements(SHAPE, "layers", annulus.layers, annulus.facets)
    }
}

impl Annulus {
    /// Makes a graded mesh.
    ///
    /// `layers` is what the annulus would have if all cells were fine; it sets the thickness of the fine
    /// layers. Nodes are numbered in rows from the fine circle to the coarse one. Surfaces are those of
    /// [`Annulus::part`]; the coarse one has a third of the facets after each transition, rounded up.
    ///
    /// # Errors
    /// Those of [`Annulus::part`]; fewer than 8 coarse facets, fewer layers than [`Grading::layers_needed`],
    /// and a groove in the coarse circle.
    pub fn graded_part(&self, grading: &Grading) -> Result<Part, Error> {
        self.check()?;
        grading.check(self)?;
        let (grid, lattice) = (self.grid(), Lattice::new(self, grading));
        let mut part = Part::default();
        for Place { column, row } in &lattice.places {
            let radius = grid.row_radius(*row);
            let (sin, cos) = libm::sincos(grid.column_angle(*column));
            part.push_node(radius * cos, radius * sin);
        }
        (part.quads, part.triangles) = (lattice.quads, lattice.triangles);
        let front: Vec<u32> = (0..self.facets as u32).collect();
        let (mut inner, outer) = match grading.fine {
            Circle::Inner => (front, lattice.back.nodes),
            Circle::Outer => (lattice.back.nodes, front),
        };
        inner.reverse();
        part.push_surface("inner", inner, true);
        part.push_surface("outer", outer, true);
        let facet = match grading.fine {
            Circle::Inner => grid.inner_facet(),
            Circle::Outer => grid.seen_from_outside().inner_facet(),
        };
        let finest = facet.min(grid.layer());
        groove::cut(&grid, &self.grooves, &lattice.places, Some(enough(finest)), &mut part)?;
        sound("annulus", part)
    }
}

/// A closed row of nodes.
struct Row {
    nodes: Vec<u32>,
    /// Place of each node, in fine facets.
    columns: Vec<usize>,
}

impl Row {
    fn node(&self, i: usize) -> u32 {
        self.nodes[i % self.nodes.len()]
    }
}

/// The graded annulus unrolled.
struct Lattice {
    places: Vec<Place>,
    quads: Vec<[u32; 4]>,
    triangles: Vec<[u32; 3]>,
    fine: Circle,
    /// Layers of the annulus.
    layers: f64,
    /// The coarse circle.
    back: Row,
}

impl Lattice {
    fn new(annulus: &Annulus, grading: &Grading) -> Self {
        let mut lattice = Self {
            places: Vec::new(),
            quads: Vec::new(),
            triangles: Vec::new(),
            fine: grading.fine,
            layers: annulus.layers as f64,
            back: Row { nodes: Vec::new(), columns: Vec::new() },
        };
        let mut row = lattice.push_row((0..annulus.facets).collect(), |_| 0.0);
        let (mut depth, mut cell) = (0, 1);
        for level in 0..grading.transitions {
            for _ in 0..grading.straight_rows(level) {
                depth += cell;
                row = lattice.add_row(&row, |_| depth as f64);
            }
            row = lattice.add_transition(&row, depth, cell);
            depth += 2 * cell;
            cell *= RATIO;
        }
        let rows = coarse_rows(annulus, grading, depth, row.nodes.len());
        let rest = (annulus.layers - depth) as f64;
        for i in 1..=rows {
            // The last depth is exact, so that no rounding moves the coarse circle.
            let below = if i == rows { rest } else { rest * i as f64 / rows as f64 };
            row = lattice.add_row(&row, |_| depth as f64 + below);
        }
        lattice.back = row;
        lattice
    }

    /// A row of nodes, no cells yet. Depths are layers below the fine circle.
    fn push_row(&mut self, columns: Vec<usize>, depth: impl Fn(usize) -> f64) -> Row {
        let first = self.places.len() as u32;
        for (i, &column) in columns.iter().enumerate() {
            let row = match self.fine {
                Circle::Inner => depth(i),
                Circle::Outer => self.layers - depth(i),
            };
            self.places.push(Place { column, row });
        }
        Row { nodes: (first..self.places.len() as u32).collect(), columns }
    }

    fn add_row(&mut self, near: &Row, depth: impl Fn(usize) -> f64) -> Row {
        let far = self.push_row(near.columns.clone(), depth);
        for i in 0..near.nodes.len() {
            self.add_quad([near.node(i), near.node(i + 1)], [far.node(i), far.node(i + 1)]);
        }
        far
    }

    /// The zigzag and the cells on both of its sides; gives the coarse row that its peaks are.
    fn add_transition(&mut self, near: &Row, depth: usize, cell: usize) -> Row {
        let groups = groups(near.nodes.len());
        let mut is_peak = vec![false; near.nodes.len()];
        groups.iter().for_each(|(first, _)| is_peak[*first] = true);
        let height = |i: usize| if is_peak[i] { 2 * cell } else { cell };
        let zigzag = self.add_row(near, |i| (depth + height(i)) as f64);
        let mut peaks = Row { nodes: Vec::new(), columns: Vec::new() };
        for (first, len) in groups {
            let corners = [zigzag.node(first), zigzag.node(first + len)];
            match len {
                RATIO => self.add_quad([zigzag.node(first + 1), zigzag.node(first + 2)], corners),
                _ => self.add_triangle(zigzag.node(first + 1), corners),
            }
            peaks.nodes.push(zigzag.nodes[first]);
            peaks.columns.push(zigzag.columns[first]);
        }
        peaks
    }

    /// A cell between two neighbouring nodes and the two beyond them, counter-clockwise.
    fn add_quad(&mut self, near: [u32; 2], far: [u32; 2]) {
        self.quads.push(match self.fine {
            Circle::Inner => [far[0], far[1], near[1], near[0]],
            Circle::Outer => [near[0], near[1], far[1], far[0]],
        });
    }

    /// A cell between a node and the two beyond it, counter-clockwise.
    fn add_triangle(&mut self, near: u32, far: [u32; 2]) {
        self.triangles.push(match self.fine {
            Circle::Inner => [far[0], far[1], near],
            Circle::Outer => [near, far[1], far[0]],
        });
    }
}

/// First facet and length of the groups that become one facet each: threes, and one or two twos at the end.
fn groups(facets: usize) -> Vec<(usize, usize)> {
    let pairs = (RATIO - facets % RATIO) % RATIO;
    let threes = (facets - 2 * pairs) / RATIO;
    let from_pairs = (0..pairs).map(|i| (RATIO * threes + 2 * i, 2));
    (0..threes).map(|i| (RATIO * i, RATIO)).chain(from_pairs).collect()
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
