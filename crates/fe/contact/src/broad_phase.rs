//! Broad phase: which facets of two surfaces are near each other.
//!
//! The bounding-volume trees are those of [parry2d](https://parry.rs): built once for a surface, refitted at
//! every search, and walked two at a time for the facets whose boxes overlap. Boxes are grown by half a skin,
//! so that a search holds for as many steps as two points need to cross the skin (THEORY §4.1). Tracking from
//! step to step is our own, see [`narrow_phase`](crate::narrow_phase).

use parry2d_f64::{
    bounding_volume::Aabb,
    math::Vector,
    partitioning::{Bvh, BvhBuildStrategy, BvhNode},
};

use stribeck_surface::Surface;

/// Bounding-volume tree over the facets of one surface, each box grown by half a skin.
pub(crate) struct Tree {
    tree: Bvh,
}

impl std::fmt::Debug for Tree {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Tree").field("facets", &self.tree.leaf_count()).finish()
    }
}

fn facet_box(surface: &Surface, facet: usize, x: &[f64], y: &[f64], grow: f64) -> Aabb {
    let (a, b) = surface.ends(facet);
    Aabb::new(
        Vector::new(x[a].min(x[b]) - grow, y[a].min(y[b]) - grow),
        Vector::new(x[a].max(x[b]) + grow, y[a].max(y[b]) + grow),
    )
}

impl Tree {
    pub(crate) fn new(surface: &Surface, x: &[f64], y: &[f64], grow: f64) -> Self {
        let boxes: Vec<Aabb> = (0..surface.facets()).map(|f| facet_box(surface, f, x, y, grow)).collect();
        Self { tree: Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes) }
    }

    /// Follows the surface to new positions.
    pub(crate) fn update(&mut self, surface: &Surface, x: &[f64], y: &[f64], grow: f64) {
        for f in 0..surface.facets() {
            self.tree.insert_or_update_partially(facet_box(surface, f, x, y, grow), f as u32, 0.0);
        }
        self.tree.refit_without_opt();
    }

    /// Pairs of facets whose boxes overlap, ascending: the order must not depend on the tree's shape.
    pub(crate) fn pairs(&self, other: &Self, found: &mut Vec<(u32, u32)>) {
        found.clear();
        let touch = |a: &BvhNode, b: &BvhNode| a.intersects(b);
        for (a, b) in self.tree.leaf_pairs(&other.tree, touch) {
            // `leaf_pairs` does not test the children of the roots (parry 0.31).
            let near = match (self.tree.leaf_node(a), other.tree.leaf_node(b)) {
                (Some(p), Some(q)) => p.intersects(q),
                _ => false,
            };
            if near {
                found.push((a, b));
            }
        }
        found.sort_unstable();
    }
}
