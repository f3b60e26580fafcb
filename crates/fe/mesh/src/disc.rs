//! Discs of quadrilaterals and triangles of nearly equal size.

use std::f64::consts::TAU;

use crate::core_grid::CoreGrid;
use crate::error::{count, finite, positive};
use crate::gap::{self, Gap};
use crate::rows::{self, NextRow};
use crate::smoothing::{inside_out, raise_critical_step};
use crate::{Error, Part};

/// A disc about the origin with a regular polygon as its boundary.
///
/// Up to two polar layers of quadrilaterals follow the rim, a grid of squares fills the core, and triangles
/// close the gap between them. The squares have sides of nearly `size`, never more than 0.4 of the radius of
/// the gap; the layers are as thick as the facets are long, and are left out where that would fill the disc.
/// Nodes are numbered ring by ring from the rim inwards, then row by row in the core.
///
/// Surface `rim`: closed, counter-clockwise, its first node at the angle `rotation`, all nodes on the circle.
/// Mark `centre`: the node at the origin. The whole mesh turns with `rotation`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc {
    /// Radius of the circle through the rim nodes [m].
    pub radius: f64,
    /// Facets of the rim.
    pub facets: usize,
    /// Side of the squares in the core [m].
    pub size: f64,
    /// Angle of the first rim node [rad].
    pub rotation: f64,
}

const SHAPE: &str = "disc";
const SIZE_ADVICE: &str = "choose `size` nearer to the length of a facet";

/// Largest side of the squares, relative to the radius of the gap.
const LARGEST_SIDE: f64 = 0.4;

/// Squares between the gap and those that stay exactly square.
const MOVING_SQUARES: i64 = 4;

/// Poisson's ratio for which the cells of the gap are shaped; the best shape hardly depends on it.
const POISSON: f64 = 0.3;

/// Passes of the pattern search.
const SWEEPS: usize = 60;

/// Sides of the squares that are tried, relative to `size`.
const SIDES: [f64; 9] = [1.0, 0.99, 1.01, 0.98, 1.02, 0.97, 1.03, 0.96, 1.04];

/// Narrowest gaps that are tried, relative to the longer of side and facet.
const GAPS: [f64; 8] = [0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.2, 1.5];

impl Disc {
    /// Makes the mesh.
    ///
    /// # Errors
    /// A radius or size that is not positive, fewer than 8 facets, a size below a 5000th of the radius, and
    /// sizes so far from the length of a facet that triangles between them turn inside out.
    pub fn part(&self) -> Result<Part, Error> {
        self.check()?;
        let layers = match self.radius / self.facet() {
            ratio if ratio >= 8.0 => 2,
            ratio if ratio >= 3.0 => 1,
            _ => 0,
        };
        self.filled(layers, 1)
    }

    /// Makes a mesh with a given number of polar layers, for a fine rim around a core of larger squares.
    ///
    /// All layers but the last are as thick as the facets are long; [`Disc::part`] lets them grow where that
    /// makes the smallest cells larger.
    pub fn part_with_layers(&self, layers: usize) -> Result<Part, Error> {
        self.check()?;
        let most = self.most_layers();
        if layers > most {
            let advice = "leave half of the radius to the core";
            return Err(Error::Count {
                shape: SHAPE,
                field: "layers",
                value: layers,
                least: 0,
                most,
                advice,
            });
        }
        self.filled(layers, layers.max(1))
    }

    /// Most polar layers: those that leave half of the radius to the core.
    pub fn most_layers(&self) -> usize {
        // The cast turns NaN into zero.
        (0.5 * self.radius / self.facet()) as usize
    }

    /// Length of a facet [m].
    fn facet(&self) -> f64 {
        2.0 * self.radius * libm::sin(0.5 * TAU / self.facets as f64)
    }

    /// Rim, core and the triangles between them; the first `fixed` rows of nodes, at least one, stay where
    /// they are.
    fn filled(&self, layers: usize, fixed: usize) -> Result<Part, Error> {
        let mut part = self.rim(layers);
        let ring = part.x.len() - self.facets;
        let (grid, gap) = self.best_core(&part, ring)?;
        let mut movable = vec![false; fixed * self.facets];
        movable.resize(part.x.len(), true);
        let core = push_core(&mut part, &grid, &mut movable);
        let inner: Vec<u32> = grid.outline().into_iter().map(core).collect();
        let node = |i: usize| if i < self.facets { (ring + i) as u32 } else { inner[i - self.facets] };
        part.triangles = gap.triangles.iter().map(|t| t.map(node)).collect();
        let filled = part.clone();
        raise_critical_step(&mut part, &movable, POISSON, SWEEPS);
        if inside_out(&part).is_some() {
            // With squares far smaller or larger than the facets the search can lose its way; the filling
            // that it started from is in order, though its cells are needles.
            part = filled;
        }
        if let Some((element, area)) = inside_out(&part) {
            return Err(Error::Tangled { shape: SHAPE, element, area, advice: SIZE_ADVICE });
        }
        // Whole turns change nothing, and a large angle would round away the digits of the columns' angles.
        let rotation = self.rotation % TAU;
        let mut part = part.rotated(rotation);
        self.place_rim(&mut part, rotation);
        Ok(part)
    }

    /// Polar layers, not yet turned.
    fn rim(&self, layers: usize) -> Part {
        let (n, facet) = (self.facets, self.facet());
        let mut part = Part::default();
        for row in 0..=layers {
            let radius = self.radius - row as f64 * facet;
            for column in 0..n {
                let (sin, cos) = libm::sincos(TAU * column as f64 / n as f64);
                part.push_node(radius * cos, radius * sin);
            }
        }
        part.quads = rows::quads(0, layers, n, true, NextRow::Inwards);
        part.push_surface("rim", (0..n as u32).collect(), true);
        part
    }

    /// Writes the rim nodes out at their final angles, so that they stay on the circle to the last digit.
    fn place_rim(&self, part: &mut Part, rotation: f64) {
        for column in 0..self.facets {
            let (sin, cos) = libm::sincos(rotation + TAU * column as f64 / self.facets as f64);
            (part.x[column], part.y[column]) = (self.radius * cos, self.radius * sin);
        }
    }

    /// The core whose gap can be filled best, among several sides and widths of the gap.
    fn best_core(&self, part: &Part, ring: usize) -> Result<(CoreGrid, Gap), Error> {
        let outer: Vec<[f64; 2]> = (ring..part.x.len()).map(|i| [part.x[i], part.y[i]]).collect();
        let radius = outer[0][0];
        let facet = TAU * radius / self.facets as f64;
        let side = self.size.min(LARGEST_SIDE * radius);
        let mut best: Option<(CoreGrid, Gap)> = None;
        for factor in SIDES {
            for width in GAPS {
                let side = factor * side;
                let Some(grid) = CoreGrid::new(radius - width * side.max(facet), side) else { continue };
                let inner: Vec<[f64; 2]> =
                    grid.outline().iter().map(|p| p.map(|i| side * i as f64)).collect();
                let Some(gap) = gap::fill(&outer, &inner) else { continue };
                if best.as_ref().is_none_or(|(_, other)| gap.worst > other.worst) {
                    best = Some((grid, gap));
                }
            }
        }
        best.ok_or(Error::OutOfRange {
            shape: SHAPE,
            field: "size",
            value: self.size,
            relation: "near",
            limit: facet,
            advice: SIZE_ADVICE,
        })
    }

    fn check(&self) -> Result<(), Error> {
        positive(SHAPE, "radius", self.radius)?;
        positive(SHAPE, "size", self.size)?;
        finite(SHAPE, "rotation", self.rotation)?;
        count(SHAPE, "facets", self.facets, 8, "divide the circumference by the element size")?;
        let limit = self.radius / 5000.0;
        if self.size < limit {
            let (field, value, relation) = ("size", self.size, "at least");
            let advice = "use larger squares: these would be more than seventy million";
            return Err(Error::OutOfRange { shape: SHAPE, field, value, relation, limit, advice });
        }
        Ok(())
    }
}

/// Adds nodes and squares of the core row by row and marks its centre; gives the node at a grid point.
///
/// Only the squares near the gap may move, which keeps the others exactly square.
fn push_core(part: &mut Part, grid: &CoreGrid, movable: &mut Vec<bool>) -> impl Fn([i64; 2]) -> u32 + use<> {
    let rows: Vec<(i64, i64)> = grid.point_rows().collect();
    let top = rows[rows.len() - 1].0;
    let fixed = (top - MOVING_SQUARES) as f64;
    // The middle column of each row, from which the others are counted.
    let mut middle = Vec::with_capacity(rows.len());
    for (y, half_width) in rows.iter().copied() {
        for x in -half_width..=half_width {
            let node = part.push_node(grid.side * x as f64, grid.side * y as f64);
            let from_centre = libm::hypot(x as f64, y as f64);
            movable.push(from_centre > 0.0 && from_centre > fixed);
            if x == 0 {
                middle.push(node);
            }
        }
    }
    let node = move |[x, y]: [i64; 2]| (i64::from(middle[(y + top) as usize]) + x) as u32;
    for y in -top..top {
        let half_width = grid.squares_above(y);
        for x in -half_width..half_width {
            part.quads.push([node([x, y]), node([x + 1, y]), node([x + 1, y + 1]), node([x, y + 1])]);
        }
    }
    part.marks.push(("centre".to_owned(), node([0, 0])));
    node
}
