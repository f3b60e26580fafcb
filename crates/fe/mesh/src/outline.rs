//! Boundaries of meshes that no generator of ours has made: oriented polylines, found from the elements.

use std::collections::{BTreeMap, BTreeSet};

use crate::{Part, Surface};

impl Part {
    /// The pieces of boundary whose facets have both ends among `nodes`, each as long as it goes: oriented,
    /// the solid on the left. In the order of the lowest numbers of their first nodes.
    pub fn boundary_along(&self, nodes: &[u32]) -> Vec<Surface> {
        let wanted: BTreeSet<u32> = nodes.iter().copied().collect();
        // A facet of the boundary belongs to one element, which walks along it in its own sense.
        let mut facets: BTreeMap<[u32; 2], usize> = BTreeMap::new();
        let quads = self.quads.iter().flat_map(|q| (0..4).map(move |i| [q[i], q[(i + 1) % 4]]));
        let triangles = self.triangles.iter().flat_map(|t| (0..3).map(move |i| [t[i], t[(i + 1) % 3]]));
        for facet in quads.chain(triangles) {
            *facets.entry(facet).or_default() += 1;
        }
        let on_boundary = |[a, b]: &[u32; 2]| !facets.contains_key(&[*b, *a]);
        let along =
            facets.keys().filter(|facet| on_boundary(facet) && facet.iter().all(|n| wanted.contains(n)));
        let mut next: BTreeMap<u32, u32> = along.map(|[a, b]| (*a, *b)).collect();
        let mut pieces = Vec::new();
        while let Some(start) = first_of(&next) {
            let mut nodes = vec![start];
            let mut closed = false;
            let mut at = start;
            while let Some(to) = next.remove(&at) {
                closed = to == start;
                if closed {
                    break;
                }
                nodes.push(to);
                at = to;
            }
            pieces.push(Surface { nodes, closed });
        }
        pieces
    }
}

/// Where a piece begins: a node that no facet leads to, or any of a closed one.
fn first_of(next: &BTreeMap<u32, u32>) -> Option<u32> {
    let reached: BTreeSet<u32> = next.values().copied().collect();
    next.keys().find(|node| !reached.contains(node)).or(next.keys().next()).copied()
}

#[cfg(test)]
mod tests {
    use crate::{Annulus, Rectangle};

    #[test]
    fn by_hand_the_boundary_of_a_ring_and_of_a_block() {
        let (facets, layers) = (24, 3);
        let ring = Annulus {
            inner_radius: 1.0,
            outer_radius: 1.5,
            facets,
            layers,
            start_angle: 0.0,
            grooves: Vec::new(),
        };
        let ring = ring.part().expect("a ring");
        let all: Vec<u32> = (0..ring.x.len() as u32).collect();
        let both = ring.boundary_along(&all);
        assert!(both.len() == 2 && both.iter().all(|s| s.closed && s.facets() == facets));
        let inner = ring.surface("inner").expect("named");
        let found = ring.boundary_along(&inner.nodes);
        assert_eq!(found.len(), 1);
        // The same walk, from another node on.
        let from = inner.nodes.iter().position(|n| *n == found[0].nodes[0]).expect("one of its nodes");
        let turned: Vec<u32> = inner.nodes[from..].iter().chain(&inner.nodes[..from]).copied().collect();
        assert_eq!(found[0].nodes, turned);

        let block = Rectangle { x0: 0.0, y0: 0.0, width: 4.0, height: 2.0, columns: 4, rows: 2 };
        let block = block.part().expect("a block");
        let low: Vec<u32> = (0..block.x.len() as u32).filter(|n| block.y[*n as usize] == 0.0).collect();
        let base = block.boundary_along(&low);
        assert!(base.len() == 1 && !base[0].closed && base[0].facets() == 4);
        assert!(base[0].nodes.windows(2).all(|pair| block.x[pair[0] as usize] < block.x[pair[1] as usize]));
        assert!(block.boundary_along(&[]).is_empty());
    }
}
