//! Stiffness of many pieces on the same nodes, summed before the matrix is assembled.

use faer::sparse::Triplet;

/// Sum of rank-one pieces on the same nodes, such as the contact points of one facet against another: summed here, they
/// are far fewer numbers to sort.
#[derive(Debug, Default)]
pub(crate) struct Block {
    nodes: Vec<u32>,
    sum: Vec<f64>,
}

impl Block {
    pub(crate) fn nodes(&self) -> &[u32] {
        &self.nodes
    }

    /// Forgets everything and takes these nodes.
    pub(crate) fn begin(&mut self, nodes: &[u32]) {
        self.nodes.clear();
        self.nodes.extend(nodes);
        self.sum.clear();
        self.sum.resize(4 * nodes.len() * nodes.len(), 0.0);
    }

    /// Adds k · d dᵀ, x and y of each node in turn.
    pub(crate) fn add(&mut self, direction: &[f64], k: f64) {
        for (row, &a) in self.sum.chunks_exact_mut(direction.len()).zip(direction) {
            row.iter_mut().zip(direction).for_each(|(sum, &b)| *sum += k * a * b);
        }
    }

    /// Pushes what is not zero of the lower triangle, given the equation of a component of the nodes.
    pub(crate) fn hand_over(
        &self,
        equation: impl Fn(&[u32], usize) -> Option<usize>,
        out: &mut Vec<Triplet<usize, usize, f64>>,
    ) {
        let n = 2 * self.nodes.len();
        let numbers: Vec<Option<usize>> = (0..n).map(|i| equation(&self.nodes, i)).collect();
        for (i, row) in numbers.iter().enumerate() {
            for (j, col) in numbers.iter().enumerate() {
                let val = self.sum[n * i + j];
                if let (&Some(row), &Some(col)) = (row, col)
                    && row >= col
                    && val != 0.0
                {
                    out.push(Triplet { row, col, val });
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_sum_of_two_springs() {
        let mut block = Block::default();
        block.begin(&[7, 3]);
        block.add(&[1.0, 0.0, -1.0, 0.0], 2.0);
        block.add(&[0.0, 1.0, 0.0, -1.0], 3.0);
        let mut out = Vec::new();
        // Node 7 has equations 2 and 3, node 3 has 0 for x alone.
        let equation = |nodes: &[u32], i: usize| match (nodes[i / 2], i % 2) {
            (7, c) => Some(2 + c),
            (_, 0) => Some(0),
            _ => None,
        };
        block.hand_over(equation, &mut out);
        let found: Vec<_> = out.iter().map(|t| (t.row, t.col, t.val)).collect();
        assert_eq!(found, [(2, 2, 2.0), (2, 0, -2.0), (3, 3, 3.0), (0, 0, 2.0)]);
    }
}
