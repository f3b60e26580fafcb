//! The squares inside a disc.

/// More rows than any disc that is allowed has.
const MOST_ROWS: f64 = 1e5;

/// The squares of a grid about the origin whose corners all lie within a circle.
///
/// The set has the symmetry of the square; grid points are counted in sides from the origin.
pub(crate) struct CoreGrid {
    /// Side of the squares [m].
    pub(crate) side: f64,
    /// Squares on each side of the y axis, for the rows above the x axis in turn.
    half_widths: Vec<i64>,
}

impl CoreGrid {
    /// The squares within `radius` [m]; none if four do not fit.
    pub(crate) fn new(radius: f64, side: f64) -> Option<CoreGrid> {
        // In whole numbers, so that rounding cannot break the symmetry.
        let ratio = radius / side;
        // The ratio of dimensions close to the smallest number may be NaN or infinite.
        if !(ratio > 0.0 && ratio < MOST_ROWS) {
            return None;
        }
        let squared = ratio.powi(2) as i64;
        let half_width = |row: i64| (squared - (row + 1) * (row + 1)).max(0).isqrt();
        let half_widths: Vec<i64> = (0..).map(half_width).take_while(|w| *w > 0).collect();
        (!half_widths.is_empty()).then_some(CoreGrid { side, half_widths })
    }

    /// Rows of grid points from the bottom: ordinate and half width, in sides.
    pub(crate) fn point_rows(&self) -> impl Iterator<Item = (i64, i64)> + '_ {
        let top = self.half_widths.len() as i64;
        (-top..=top).map(|row| (row, self.half_widths[(row.abs() - 1).max(0) as usize]))
    }

    /// Half width, in sides, of the row of squares above the grid points of ordinate `row`.
    pub(crate) fn squares_above(&self, row: i64) -> i64 {
        self.half_widths[if row < 0 { -row - 1 } else { row } as usize]
    }

    /// Grid points of the boundary, counter-clockwise from the positive x axis.
    pub(crate) fn outline(&self) -> Vec<[i64; 2]> {
        let mut quarter = Vec::new();
        let rows = self.half_widths.len();
        for (row, half_width) in self.half_widths.iter().enumerate() {
            quarter.push([*half_width, row as i64]);
            // The tread of the step, from this row of squares in to the next one.
            let inner = if row + 1 < rows { self.half_widths[row + 1] } else { 0 };
            quarter.extend((inner + 1..=*half_width).rev().map(|x| [x, row as i64 + 1]));
        }
        let mut outline = Vec::with_capacity(4 * quarter.len());
        for _ in 0..4 {
            outline.extend_from_slice(&quarter);
            quarter.iter_mut().for_each(|[x, y]| (*x, *y) = (-*y, *x));
        }
        outline
    }
}
