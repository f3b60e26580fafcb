//! How nodes and elements lie in memory (design: PERFORMANCE.md).
//!
//! Nodes live in **slots**. A **tile** is a run of slots that one thread works on: its own nodes, then
//! *ghosts*, copies of neighbours' nodes that its seam elements read. A tile computes every element that
//! touches one of its own nodes, so no two tiles write to the same node and the sum at a node has one fixed
//! order whatever the number of threads.
//!
//! Two kinds of tile: a piece of one body, whose quadrilaterals form strips; and eight congruent bodies side
//! by side, node by node, so that one instruction works on the same element of all eight.

use std::{collections::HashSet, ops::Range};

use stribeck_mesh::{Body, Mesh, strips::find_strips};

use crate::{
    element::{QuadReference, TriangleReference},
    model::{Behaviour, Model, NodeMotion},
};
use stribeck_simd::lanes::LANES;

/// Shorter runs of quadrilaterals go through the gather path.
pub(crate) const SHORTEST_STRIP: usize = 4;

/// Most nodes of one body in one tile: about 0.5 MB of fields, which stays in a second-level cache.
const TILE_NODES: usize = 8000;

/// Cost of an element across a seam, relative to one of a strip: its nodes are gathered from lines of cache
/// that are not prefetched.
const ACROSS: usize = 10;

/// No slot.
const NONE: u32 = u32::MAX;

/// Where every node lives.
#[derive(Debug, Clone)]
pub struct Layout {
    /// Slot of each mesh node.
    pub slot_of_node: Vec<u32>,
    /// Mesh node of each slot; ghosts name the node that they copy, padding names `None`.
    pub node_of_slot: Vec<Option<u32>>,
    /// Runs of ghosts and the first slot of the run that they copy, ascending.
    pub(crate) ghosts: Vec<(Range<usize>, usize)>,
    pub(crate) tiles: Vec<TileLayout>,
}

/// One tile, in local slot numbers (relative to `slots.start`).
#[derive(Debug, Clone, Default)]
pub(crate) struct TileLayout {
    /// Slots: own, ghosts, padding.
    pub(crate) slots: Range<usize>,
    /// How many of them are own, padding between them included.
    pub(crate) own: usize,
    /// Which slots are padding.
    pub(crate) padding: Vec<bool>,
    /// The body of the (first) elements; all elements of a tile share one material.
    pub(crate) body: usize,
    /// Its bodies: one, or up to [`LANES`] congruent ones.
    pub(crate) bodies: Vec<usize>,
    /// Quadrilaterals, local corners, and their number in the mesh. In a tile of congruent bodies those of
    /// the first body, whose corners are multiples of [`LANES`].
    pub(crate) quads: Vec<([u32; 4], usize)>,
    /// Triangles, likewise.
    pub(crate) triangles: Vec<([u32; 3], usize)>,
    /// True for a tile of congruent bodies.
    pub(crate) congruent: bool,
}

/// Lays a model out.
pub(crate) fn lay_out(model: &Model, quads: &[QuadReference], triangles: &[TriangleReference]) -> Layout {
    let mesh = &model.mesh;
    let mut layout = Layout {
        slot_of_node: vec![NONE; mesh.x.len()],
        node_of_slot: Vec::new(),
        ghosts: Vec::new(),
        tiles: Vec::new(),
    };
    let groups = congruent_groups(model, quads, triangles);
    let alone_or_together = groups.iter().flat_map(|group| group.chunks(LANES)).collect();
    let elements = |bodies: &&[usize]| {
        let elastic = bodies.iter().filter(|b| model.behaviour[**b].is_elastic());
        elastic.map(|&b| mesh.bodies[b].quads.len() + mesh.bodies[b].triangles.len()).sum()
    };
    for bodies in small_ones_inwards(alone_or_together, elements) {
        match bodies {
            [body] => layout.add_body(model, *body),
            bodies => layout.add_congruent(mesh, bodies),
        }
    }
    layout
}

/// Deals items to two sides, the largest first, each to the side with less work, and joins these where the
/// small ones are: two threads that begin at either end then have equal work left where they meet, and little
/// of it.
fn small_ones_inwards<T>(mut items: Vec<T>, work: impl Fn(&T) -> usize) -> impl Iterator<Item = T> {
    items.sort_by_key(|item| std::cmp::Reverse(work(item)));
    let [mut left, mut right] = [(0, Vec::new()), (0, Vec::new())];
    for item in items {
        let side = if left.0 <= right.0 { &mut left } else { &mut right };
        side.0 += work(&item);
        side.1.push(item);
    }
    left.1.into_iter().chain(right.1.into_iter().rev())
}

impl Layout {
    /// Number of slots.
    pub fn len(&self) -> usize {
        self.node_of_slot.len()
    }

    /// Copies the values of a field from nodes to their ghosts.
    pub(crate) fn copy_to_ghosts(&self, field: &mut [f64]) {
        for (ghosts, owner) in &self.ghosts {
            match ghosts.len() {
                // Across seams runs are of one node, which is not worth a call.
                1 => field[ghosts.start] = field[*owner],
                n => field.copy_within(*owner..owner + n, ghosts.start),
            }
        }
    }

    /// Tiles and lanes that a body lies in; a body that is alone in its tiles has all lanes of them.
    pub(crate) fn places(&self, body: usize) -> Vec<(usize, usize)> {
        let lanes = self.tiles.iter().enumerate().flat_map(|(t, tile)| {
            let owner = |lane: usize| tile.bodies.get(if tile.congruent { lane } else { 0 });
            (0..LANES).filter(move |&lane| owner(lane) == Some(&body)).map(move |lane| (t, lane))
        });
        lanes.collect()
    }

    /// True when there is no slot.
    pub fn is_empty(&self) -> bool {
        self.node_of_slot.is_empty()
    }

    /// Leaves slots free until the next one begins a line of cache.
    fn pad(&mut self) {
        let padding = self.len().next_multiple_of(LANES) - self.len();
        self.node_of_slot.extend(std::iter::repeat_n(None, padding));
    }

    fn add_congruent(&mut self, mesh: &Mesh, bodies: &[usize]) {
        let first = &mesh.bodies[bodies[0]];
        let start = self.len();
        for n in 0..first.nodes.len() {
            for lane in 0..LANES {
                let node = bodies.get(lane).map(|&b| mesh.bodies[b].nodes.start + n);
                if let Some(node) = node {
                    self.slot_of_node[node] = self.len() as u32;
                }
                self.node_of_slot.push(node.map(|n| n as u32));
            }
        }
        let local = |n: u32| (n - first.nodes.start as u32) * LANES as u32;
        self.tiles.push(TileLayout {
            slots: start..self.len(),
            own: self.len() - start,
            // Padding lanes move with the others.
            padding: vec![false; self.len() - start],
            body: bodies[0],
            bodies: bodies.to_vec(),
            quads: first.quads.clone().map(|e| (mesh.quads[e].map(local), e)).collect(),
            triangles: first.triangles.clone().map(|e| (mesh.triangles[e].map(local), e)).collect(),
            congruent: true,
        });
    }

    fn add_body(&mut self, model: &Model, b: usize) {
        let mesh = &model.mesh;
        let body = &mesh.bodies[b];
        let tile_of_node = match model.behaviour[b] {
            Behaviour::Elastic => bisect(mesh, body),
            Behaviour::Rigid | Behaviour::Turning { .. } => vec![0; body.nodes.len()],
        };
        let tiles = tile_of_node.iter().max().map_or(0, |&t| t + 1);
        let of = |n: u32| tile_of_node[n as usize - body.nodes.start];

        // Own nodes of all tiles first, so that ghosts can name them.
        let mut own: Vec<Vec<u32>> = vec![Vec::new(); tiles];
        for n in body.nodes.clone() {
            own[of(n as u32)].push(n as u32);
        }
        let mut quads: Vec<Vec<usize>> = vec![Vec::new(); tiles];
        let mut triangles: Vec<Vec<usize>> = vec![Vec::new(); tiles];
        if model.behaviour[b].is_elastic() {
            for e in body.quads.clone() {
                each_tile(&mesh.quads[e].map(of), |t| quads[t].push(e));
            }
            for e in body.triangles.clone() {
                each_tile(&mesh.triangles[e].map(of), |t| triangles[t].push(e));
            }
        }
        let mut local = vec![NONE; body.nodes.len()];
        for t in 0..tiles {
            let start = self.len();
            // Rows begin with the first own node: elements across a seam between columns are in no strip.
            let row_starts_of = |all: bool| {
                let inside = |e: &&usize| all || mesh.quads[**e].iter().all(|&n| of(n) == t);
                row_starts(&quads[t].iter().filter(inside).map(|&e| mesh.quads[e]).collect::<Vec<_>>())
            };
            let (rows, ghost_rows) = (row_starts_of(false), row_starts_of(true));
            for &n in &own[t] {
                if rows.contains(&n) {
                    self.pad();
                }
                self.slot_of_node[n as usize] = self.len() as u32;
                local[n as usize - body.nodes.start] = (self.len() - start) as u32;
                self.node_of_slot.push(Some(n));
            }
            let own_slots = self.len() - start;
            let mut ghosts = Vec::new();
            let corner_lists = quads[t]
                .iter()
                .flat_map(|&e| mesh.quads[e])
                .chain(triangles[t].iter().flat_map(|&e| mesh.triangles[e]));
            for n in corner_lists {
                let entry = &mut local[n as usize - body.nodes.start];
                if *entry == NONE {
                    *entry = 0;
                    ghosts.push(n);
                }
            }
            // In their own order, so that rows of ghosts are rows.
            ghosts.sort_unstable();
            for &n in &ghosts {
                if ghost_rows.contains(&n) {
                    self.pad();
                }
                local[n as usize - body.nodes.start] = (self.len() - start) as u32;
                self.node_of_slot.push(Some(n));
            }
            if model.behaviour[b].is_elastic() {
                // A kernel may read and write a whole group of lanes from the last node on.
                self.node_of_slot.extend([None; LANES]);
                self.pad();
            }
            let at = |n: u32| local[n as usize - body.nodes.start];
            self.tiles.push(TileLayout {
                slots: start..self.len(),
                own: own_slots,
                padding: self.node_of_slot[start..].iter().map(Option::is_none).collect(),
                body: b,
                bodies: vec![b],
                quads: quads[t].iter().map(|&e| (mesh.quads[e].map(at), e)).collect(),
                triangles: triangles[t].iter().map(|&e| (mesh.triangles[e].map(at), e)).collect(),
                congruent: false,
            });
            for n in own[t].iter().chain(&ghosts) {
                local[*n as usize - body.nodes.start] = NONE;
            }
            self.pad();
        }
        for tile in &self.tiles[self.tiles.len() - tiles..] {
            for ghost in tile.slots.start + tile.own..tile.slots.end {
                let Some(node) = self.node_of_slot[ghost] else { continue };
                let owner = self.slot_of_node[node as usize] as usize;
                match self.ghosts.last_mut() {
                    Some((run, first)) if run.end == ghost && *first + run.len() == owner => run.end += 1,
                    _ => self.ghosts.push((ghost..ghost + 1, owner)),
                }
            }
        }
    }
}

/// First nodes of the rows along strips of a list of quadrilaterals; none of them lies within the row of
/// another strip.
fn row_starts(quads: &[[u32; 4]]) -> HashSet<u32> {
    let (mut first, mut within) = (HashSet::new(), HashSet::new());
    for strip in find_strips(quads).into_iter().filter(|s| s.len >= SHORTEST_STRIP) {
        for corners in [[strip.corners[0], strip.corners[1]], [strip.corners[3], strip.corners[2]]] {
            let start = corners[0].min(corners[1]);
            first.insert(start);
            within.extend(start + 1..=start + strip.len as u32);
        }
    }
    &first - &within
}

/// Calls `f` once for each distinct tile.
fn each_tile(tiles: &[usize], mut f: impl FnMut(usize)) {
    for (i, &t) in tiles.iter().enumerate() {
        if !tiles[..i].contains(&t) {
            f(t);
        }
    }
}

/// Tile of each node of a body: recursive bisection until a tile is small enough, across the longer side or
/// between two rows, whichever costs less. Within a tile nodes keep their order, so rows stay rows.
fn bisect(mesh: &Mesh, body: &Body) -> Vec<usize> {
    let first = body.nodes.start;
    let mut tile = vec![0; body.nodes.len()];
    let mut upper = vec![false; body.nodes.len()];
    let mut next = 1;
    // Tiles that may be too large: number, nodes, and the quadrilaterals that have only such nodes.
    let mut todo = vec![(0, body.nodes.clone().collect::<Vec<_>>(), mesh.quads[body.quads.clone()].to_vec())];
    while let Some((t, members, quads)) = todo.pop() {
        if members.len() <= TILE_NODES {
            continue;
        }
        let extent = |v: &[f64]| {
            let (lo, hi) = members
                .iter()
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), &n| (lo.min(v[n]), hi.max(v[n])));
            hi - lo
        };
        let along = if extent(&mesh.x) >= extent(&mesh.y) { &mesh.x } else { &mesh.y };
        let middle = members.len() / 2;
        let mut across = members.clone();
        across.sort_by(|&a, &b| along[a].total_cmp(&along[b]).then(a.cmp(&b)));
        across.drain(..middle);
        let rows = row_starts(&quads);
        let starts = (middle / 2..3 * middle / 2).filter(|&i| rows.contains(&(members[i] as u32)));
        let between = starts.min_by_key(|i| i.abs_diff(middle)).map(|i| &members[i..]);
        // Elements on a seam are computed twice: those along it in a strip, those across it one by one.
        let mut crossing = |part: &[usize]| {
            members.iter().for_each(|n| upper[n - first] = false);
            part.iter().for_each(|n| upper[n - first] = true);
            let sides = |e: &[u32; 4]| e.map(|n| upper[n as usize - first]);
            quads.iter().map(sides).filter(|s| s.contains(&true) && s.contains(&false)).count()
        };
        let cost = ACROSS * crossing(&across);
        // `upper` holds the part of the last call, and that part is taken.
        if between.is_none_or(|between| crossing(between) >= cost) {
            crossing(&across);
        }
        let (above, below): (Vec<_>, Vec<_>) = members.into_iter().partition(|n| upper[n - first]);
        above.iter().for_each(|n| tile[n - first] = next);
        let of = |t: usize| -> Vec<[u32; 4]> {
            let inside = |e: &&[u32; 4]| e.iter().all(|n| tile[*n as usize - first] == t);
            quads.iter().filter(inside).copied().collect()
        };
        let (quads_below, quads_above) = (of(t), of(next));
        todo.push((t, below, quads_below));
        todo.push((next, above, quads_above));
        next += 1;
    }
    tile
}

/// Elastic bodies grouped by equal shape, connectivity and material; every other body is alone.
fn congruent_groups(
    model: &Model,
    quads: &[QuadReference],
    triangles: &[TriangleReference],
) -> Vec<Vec<usize>> {
    let bodies = &model.mesh.bodies;
    let congruent = |a: usize, b: usize| {
        let (p, q) = (&bodies[a], &bodies[b]);
        let same_corner = |m: u32, n: u32| m - p.nodes.start as u32 == n - q.nodes.start as u32;
        model.behaviour[a].is_elastic()
            && model.behaviour[b].is_elastic()
            && model.materials[a] == model.materials[b]
            && p.nodes.len() == q.nodes.len()
            && p.nodes.clone().chain(q.nodes.clone()).all(|n| model.motion[n] == NodeMotion::Free)
            && p.nodes.len() * LANES <= 4 * TILE_NODES
            && p.quads.len() == q.quads.len()
            && p.triangles.len() == q.triangles.len()
            && p.quads.clone().zip(q.quads.clone()).all(|(e, f)| {
                let (c, d) = (model.mesh.quads[e], model.mesh.quads[f]);
                c.into_iter().zip(d).all(|(m, n)| same_corner(m, n)) && quads[e].is_congruent(&quads[f])
            })
            && p.triangles.clone().zip(q.triangles.clone()).all(|(e, f)| {
                let (c, d) = (model.mesh.triangles[e], model.mesh.triangles[f]);
                c.into_iter().zip(d).all(|(m, n)| same_corner(m, n))
                    && triangles[e].is_congruent(&triangles[f])
            })
    };
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for b in 0..bodies.len() {
        match groups.iter_mut().find(|g| congruent(g[0], b)) {
            Some(group) => group.push(b),
            None => groups.push(vec![b]),
        }
    }
    groups
}
