//! The outer raceway of a reduction: normals, forces and modal shapes of its nodes.

use stribeck_reduced::modal::Seat;
use stribeck_solver::state::NodeForces;

use crate::reduction::{extraction::Extraction, structure::Structure};

/// A node of the outer raceway.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RacewayNode {
    pub(crate) slot: u32,
    /// Unit vector towards the outside.
    pub(crate) normal: [f64; 2],
    /// Force of the rollers at the preload, along the normal [N].
    pub(crate) force: f64,
}

/// Nodes of the outer raceway, counter-clockwise.
pub(crate) fn nodes(extraction: &Extraction) -> Vec<RacewayNode> {
    let node = |&n: &u32| {
        let [x, y] = extraction.place(n);
        let [nx, ny] = [x / libm::hypot(x, y), y / libm::hypot(x, y)];
        let [fx, fy] = extraction.contact_forces[n as usize];
        RacewayNode { slot: extraction.slot(n), normal: [nx, ny], force: nx * fx + ny * fy }
    };
    extraction.nodes.outer.iter().map(node).collect()
}

/// Forces of the rollers on the outer raceway at the preload, by slot [N].
pub(crate) fn roller_forces(extraction: &Extraction, count: usize) -> NodeForces {
    let mut pressed = NodeForces::zeros(count);
    for &n in &extraction.nodes.outer {
        let slot = extraction.slot(n) as usize;
        [pressed.fx[slot], pressed.fy[slot]] = extraction.contact_forces[n as usize];
    }
    pressed
}

/// Radial modal displacement at a vertex that tangential springs of the seat cancel [1/√kg].
pub(crate) fn taken_back(seat: Option<&Seat>, modes: usize, vertex: usize) -> impl Iterator<Item = &f64> {
    seat.map_or(&[][..], |seat| &seat.taken_back).iter().skip(vertex * modes).take(modes)
}

/// Displacements of the raceway's vertices by the rollers at the preload beyond the modes [m].
pub(crate) fn dents(
    extraction: &Extraction,
    structure: &mut Structure,
    rollers: NodeForces,
) -> Vec<[f64; 2]> {
    let on_raceway = extraction.slots(&extraction.nodes.outer);
    structure.residuals(&[rollers], &on_raceway).remove(0)
}

/// Largest radial dent [m] away from all rollers, by two fifths of their distance at least: what bends
/// between them in none of the modes, so that no roller feels it of another. Zero where the rollers leave no
/// such room.
pub(crate) fn between_rollers(raceway: &[RacewayNode], dents: &[[f64; 2]], rollers: usize) -> f64 {
    let n = raceway.len();
    let apart = 2 * n / (5 * rollers.max(1));
    let free = |at: usize| (0..=2 * apart).all(|i| raceway[(at + n - apart + i) % n].force == 0.0);
    let radial = |at: usize| {
        let ([nx, ny], [dx, dy]) = (raceway[at].normal, dents[at]);
        (nx * dx + ny * dy).abs()
    };
    (0..n).filter(|at| free(*at)).map(radial).fold(0.0, f64::max)
}

/// Vertices of the raceway without the dents of the rollers, which the local compliance adds again [m].
pub(crate) fn without_dents(extraction: &Extraction, dents: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let without_dent = |(n, [dx, dy]): (&u32, &[f64; 2])| {
        let [x, y] = extraction.place(*n);
        [x - dx, y - dy]
    };
    extraction.nodes.outer.iter().zip(dents).map(without_dent).collect()
}

/// Shapes at the vertices of the raceway [1/√kg], less the part cancelled by the tangential springs of the
/// seat: x of all modes, then y, vertex by vertex.
pub(crate) fn shapes(
    raceway: &[RacewayNode],
    structure: &Structure,
    seat: Option<&Seat>,
    padded: usize,
) -> Vec<f64> {
    let modes = structure.squares().len();
    let mut shapes: Vec<f64> =
        raceway.iter().flat_map(|node| structure.shape_at(node.slot, padded)).collect();
    for (vertex, (shape, node)) in shapes.chunks_exact_mut(2 * padded).zip(raceway).enumerate() {
        let [nx, ny] = node.normal;
        let (x, y) = shape.split_at_mut(padded);
        for ((x, y), back) in x.iter_mut().zip(y).zip(taken_back(seat, modes, vertex)) {
            (*x, *y) = (*x - nx * back, *y - ny * back);
        }
    }
    shapes
}
