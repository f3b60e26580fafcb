//! A symmetric matrix whose pattern stays while its values change.

use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};

use super::graph::Graph;

/// Two equations a node, x before y; the lower triangle, column by column.
pub(super) struct Matrix {
    /// Where each node's own begin in `nodes`.
    first: Vec<usize>,
    /// Each node itself, then its neighbours that are eliminated later, ascending.
    nodes: Vec<u32>,
    columns: Vec<usize>,
    rows: Vec<usize>,
    /// Value at each place of the pattern.
    pub(super) values: Vec<f64>,
}

impl Matrix {
    /// Zeros wherever two nodes are neighbours.
    pub(super) fn new(graph: &Graph) -> Self {
        let (mut first, mut nodes) = (vec![0], Vec::new());
        let (mut columns, mut rows) = (vec![0], Vec::new());
        for n in 0..graph.len() as u32 {
            let own = nodes.len();
            nodes.push(n);
            nodes.extend(graph.of(n).iter().filter(|&&m| m > n));
            first.push(nodes.len());
            for component in 0..2 {
                let both = nodes[own..].iter().flat_map(|&m| [2 * m as usize, 2 * m as usize + 1]);
                rows.extend(both.skip(component));
                columns.push(rows.len());
            }
        }
        let values = vec![0.0; rows.len()];
        Self { first, nodes, columns, rows, values }
    }

    /// Adds `block` where the equations of node `row` (first index) and node `column` (second index) meet,
    /// for a row that is not eliminated before the column; of a node with itself, the lower triangle. False
    /// when that place is not in the pattern.
    #[must_use]
    pub(super) fn add(&mut self, row: u32, column: u32, block: [[f64; 2]; 2]) -> bool {
        let n = column as usize;
        let own = &self.nodes[self.first[n]..self.first[n + 1]];
        let Some(at) = own.iter().position(|&m| m == row) else { return false };
        // The second column lacks the row above its diagonal.
        let [left, right] = [self.columns[2 * n] + 2 * at, self.columns[2 * n + 1] + 2 * at];
        self.values[left] += block[0][0];
        self.values[left + 1] += block[1][0];
        if at > 0 {
            self.values[right - 1] += block[0][1];
        }
        self.values[right] += block[1][1];
        true
    }

    /// Adds the product with `u` to `to`.
    pub(super) fn times(&self, u: &[f64], to: &mut [f64]) {
        for (column, span) in self.columns.windows(2).enumerate() {
            let mut sum = 0.0;
            for at in span[0]..span[1] {
                let (row, value) = (self.rows[at], self.values[at]);
                to[row] += value * u[column];
                if row != column {
                    sum += value * u[row];
                }
            }
            to[column] += sum;
        }
    }

    pub(super) fn pattern(&self) -> SymbolicSparseColMatRef<'_, usize> {
        let n = self.columns.len() - 1;
        SymbolicSparseColMatRef::new_checked(n, n, &self.columns, None, &self.rows)
    }

    /// Pattern and values.
    pub(super) fn view(&self) -> SparseColMatRef<'_, usize, f64> {
        SparseColMatRef::new(self.pattern(), &self.values)
    }
}
