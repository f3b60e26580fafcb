//! A tile made ready to run: strips, references and the order in which rows of nodes are finished.

use std::ops::Range;

use stribeck_mesh::strips::find_strips;

use crate::{
    element::{QuadReference, Stiffness, TriangleReference},
    kernel::{
        frames::LaneFrames,
        layout::{SHORTEST_STRIP, TileLayout},
        mass_sums::LaneSums,
        quad_forms::{QuadMetric, QuadShape},
        varying_references::VaryingReferences,
    },
    model::NodeMotion,
};
use stribeck_simd::{field::Field, lanes::LANES};

/// One tile of work. All node numbers are local to the tile.
#[derive(Debug, Clone)]
pub(crate) struct Tile {
    /// Slots, own nodes first, then ghosts.
    pub(crate) slots: Range<usize>,
    pub(crate) own: usize,
    pub(crate) stiffness: Stiffness,
    pub(crate) strips: Vec<Strip>,
    /// References of elements of strips that are not alike, and of those outside strips.
    pub(crate) varying: VaryingReferences,
    /// Quadrilaterals outside strips; their references stand in `varying` from group `first_gathered` on.
    pub(crate) quads: Vec<[u32; 4]>,
    pub(crate) first_gathered: usize,
    /// Quadrilaterals of congruent bodies: runs, and the right corners (2, 3) of each element in the first
    /// body.
    pub(crate) runs: Vec<CongruentRun>,
    pub(crate) quads_of_runs: Vec<([u32; 2], QuadMetric)>,
    /// Triangles; in a tile of congruent bodies those of the first body.
    pub(crate) triangles: Vec<([u32; 3], TriangleReference)>,
    pub(crate) congruent: bool,
    /// False for a rigid body, whose nodes this tile does not move.
    pub(crate) elastic: bool,
    /// Nodes that are complete after a strip, in strip order.
    pub(crate) finish: Vec<Finish>,
    /// About how long a step takes, in arbitrary units.
    pub(crate) work: usize,
    /// Runs of own nodes that other forces may push.
    pub(crate) loaded: Vec<Range<usize>>,
    /// Time step over mass [s/kg]; zero for nodes without mass.
    pub(crate) step_over_mass: Field,
    /// Mass damping of this tile's bodies, if any.
    pub(crate) damping: Option<TileDamping>,
    /// Structural damping of this tile's bodies, if any.
    pub(crate) structural: Option<TileStructural>,
}

/// Mass-proportional damping of one tile.
#[derive(Debug, Clone)]
pub(crate) struct TileDamping {
    /// Rate [1/s].
    pub(crate) rate: f64,
    pub(crate) frames: LaneFrames,
    /// Mass of each slot [kg], for the heat.
    pub(crate) mass: Field,
    /// Mass and momentum of each lane when the frames were last placed here.
    pub(crate) sums: LaneSums,
}

#[derive(Debug, Clone)]
pub(crate) struct TileStructural {
    /// Mass of each slot [kg].
    pub(crate) mass: Field,
    /// Mass and momentum of each lane when spins were last measured.
    pub(crate) sums: LaneSums,
    /// Angular velocity of the body in each lane [rad/s]; all alike in a tile of one body.
    pub(crate) spin: [f64; LANES],
}

/// Runs of entries that are true.
fn runs(flags: &[bool]) -> Vec<Range<usize>> {
    let mut at = 0;
    let mut runs = Vec::new();
    for run in flags.chunk_by(|a, b| a == b) {
        if run[0] {
            runs.push(at..at + run.len());
        }
        at += run.len();
    }
    runs
}

/// Fewer elements that are alike are not worth a loop of their own.
const LEAST_ALIKE: usize = 4 * LANES;

/// The longest run of `n` elements that are the same, in groups of lanes: it begins with one and ends with
/// one or with the last element. Empty where no run is long and not all are the same.
fn alike(n: usize, same: impl Fn(usize, usize) -> bool) -> Range<usize> {
    let (mut longest, mut from) = (0..0, 0);
    for end in 1..=n {
        if end < n && same(from, end) {
            continue;
        }
        let to = if end == n { n } else { end - end % LANES };
        let run = from.next_multiple_of(LANES)..to;
        if run.len() > longest.len() {
            longest = run;
        }
        from = end;
    }
    if longest.len() < LEAST_ALIKE.min(n) { 0..0 } else { longest }
}

/// A run of quadrilaterals whose corners all advance by one.
#[derive(Debug, Clone)]
pub(crate) struct Strip {
    pub(crate) corners: [u32; 4],
    pub(crate) len: usize,
    /// Neighbours that are all alike, as on a square grid or along a ring's row: whole groups of lanes, the
    /// last one perhaps shorter.
    pub(crate) alike: Range<usize>,
    /// Reference of those.
    pub(crate) metric: QuadMetric,
    /// References of all others: from this group of the tile's [`VaryingReferences`] on.
    pub(crate) varying: usize,
    /// The whole row of corners 1 and 2 is free and complete after this strip: it moves with it.
    pub(crate) completes: bool,
}

/// Quadrilaterals of congruent bodies, each of which has its left side in common with the right one of the
/// one before.
#[derive(Debug, Clone)]
pub(crate) struct CongruentRun {
    /// Corners 1 and 4 of the first element.
    pub(crate) left: [u32; 2],
    pub(crate) quads: Range<usize>,
}

/// Consecutive own nodes that move alike and are complete once strip `after` is done, and do not move with
/// it.
#[derive(Debug, Clone)]
pub(crate) struct Finish {
    /// Number of strips that must be done.
    pub(crate) after: usize,
    pub(crate) nodes: Range<usize>,
    pub(crate) motion: NodeMotion,
}

impl Strip {
    /// Renumbers the corners 4, 3, 2, 1: the upper row becomes the lower one.
    fn turn_over(&mut self, varying: &mut VaryingReferences) {
        self.corners.reverse();
        self.metric = self.metric.turned_over();
        varying.turn_over(self.varying, self.len - self.alike.len());
    }
}

impl Tile {
    /// Makes all elements stiffer by a factor.
    pub(crate) fn stiffen(&mut self, factor: f64) {
        let k = &mut self.stiffness;
        [&mut k.lame, &mut k.two_shear, &mut k.hourglass].into_iter().for_each(|k| *k *= factor);
        self.strips.iter_mut().for_each(|strip| strip.metric.stiffen(factor));
        self.quads_of_runs.iter_mut().for_each(|(_, metric)| metric.stiffen(factor));
        self.varying.stiffen(factor);
    }

    /// About how many bytes a step reads here.
    pub(crate) fn bytes(&self) -> usize {
        // Positions, velocities, time step over mass.
        const FIELDS: usize = 5;
        size_of::<f64>() * FIELDS * self.slots.len() + self.varying.bytes()
    }

    /// Prepares a tile. `motion` and `loaded` have one entry for each of its slots.
    pub(crate) fn new(
        layout: &TileLayout,
        quads: &[QuadReference],
        triangles: &[TriangleReference],
        stiffness: Stiffness,
        motion: &[NodeMotion],
        loaded: &[bool],
    ) -> Self {
        let mut tile = Self {
            slots: layout.slots.clone(),
            own: layout.own,
            stiffness,
            strips: Vec::new(),
            varying: VaryingReferences::default(),
            quads: Vec::new(),
            first_gathered: 0,
            runs: Vec::new(),
            quads_of_runs: Vec::new(),
            triangles: layout.triangles.iter().map(|&(c, e)| (c, triangles[e])).collect(),
            congruent: layout.congruent,
            elastic: true,
            finish: Vec::new(),
            work: 0,
            loaded: runs(&loaded[..layout.own]),
            step_over_mass: Field::default(),
            damping: None,
            structural: None,
        };
        if layout.congruent {
            tile.add_runs(layout, quads);
        } else {
            tile.add_strips(layout, quads);
        }
        tile.schedule(layout, motion);
        let strips: usize = tile.strips.iter().map(|s| s.len).sum();
        let congruent = LANES * (tile.quads_of_runs.len() + tile.triangles.len());
        tile.work = 1 + 3 * strips + 2 * congruent + 12 * tile.quads.len();
        tile
    }

    fn add_runs(&mut self, layout: &TileLayout, quads: &[QuadReference]) {
        let mut right = None;
        for (at, &([a, b, c, d], e)) in layout.quads.iter().enumerate() {
            if right != Some([a, d]) {
                self.runs.push(CongruentRun { left: [a, d], quads: at..at });
            }
            right = Some([b, c]);
            self.quads_of_runs.push(([b, c], QuadMetric::new(&quads[e], &self.stiffness)));
            if let Some(run) = self.runs.last_mut() {
                run.quads.end = at + 1;
            }
        }
    }

    fn add_strips(&mut self, layout: &TileLayout, quads: &[QuadReference]) {
        let stiffness = self.stiffness;
        let shape = |e: usize| QuadShape::new(&quads[e], &stiffness);
        let mut gathered = Vec::new();
        let corners: Vec<[u32; 4]> = layout.quads.iter().map(|&(c, _)| c).collect();
        for run in find_strips(&corners) {
            let elements = &layout.quads[run.first_element..run.first_element + run.len];
            // The two rows of corners must not overlap, or a strip would write to one node in two lanes at
            // once.
            let rows_apart = run.corners[0].abs_diff(run.corners[3]) as usize > run.len;
            let pairs = run.corners[1] == run.corners[0] + 1 && run.corners[2] == run.corners[3] + 1;
            if run.len < SHORTEST_STRIP || !rows_apart || !pairs {
                self.quads.extend(elements.iter().map(|&(corners, _)| corners));
                gathered.extend(elements.iter().map(|&(_, e)| e));
                continue;
            }
            let alike = alike(elements.len(), |i, j| quads[elements[i].1] == quads[elements[j].1]);
            let metric = QuadMetric::new(&quads[elements[alike.start].1], &self.stiffness);
            let others = elements[..alike.start].iter().chain(&elements[alike.end..]);
            let others: Vec<QuadShape> = others.map(|&(_, e)| shape(e)).collect();
            let varying = if others.is_empty() { 0 } else { self.varying.push(others.into_iter()) };
            let (corners, len) = (run.corners, run.len);
            self.strips.push(Strip { corners, len, alike, metric, varying, completes: false });
        }
        self.first_gathered = self.varying.push(gathered.into_iter().map(shape));
    }

    /// Lists which nodes are complete after which strip: the last one that reads or pushes them.
    fn schedule(&mut self, layout: &TileLayout, motion: &[NodeMotion]) {
        let mut after = vec![0; self.own];
        for (s, strip) in self.strips.iter().enumerate() {
            for corner in strip.corners {
                for n in corner as usize..corner as usize + strip.len {
                    if n < self.own {
                        after[n] = s + 1;
                    }
                }
            }
        }
        // Padding never moves.
        let mut with_strip: Vec<bool> = layout.padding[..self.own].to_vec();
        for s in 0..self.strips.len() {
            for turned in [false, true] {
                let strip = &mut self.strips[s];
                let first = strip.corners[if turned { 3 } else { 0 }] as usize;
                let row = first..first + strip.len + 1;
                let done = |n: usize| after[n] == s + 1 && motion[n] == NodeMotion::Free;
                if row.end <= self.own && row.clone().all(done) {
                    strip.completes = true;
                    with_strip[row].fill(true);
                    if turned {
                        strip.turn_over(&mut self.varying);
                    }
                    break;
                }
            }
        }
        let mut start = 0;
        let alike = |a: usize, b: usize| {
            after[a] == after[b] && motion[a] == motion[b] && with_strip[a] == with_strip[b]
        };
        for n in 1..=self.own {
            if n == self.own || !alike(n, start) {
                if !with_strip[start] {
                    let nodes = start..n;
                    self.finish.push(Finish { after: after[start], nodes, motion: motion[start] });
                }
                start = n;
            }
        }
        self.finish.sort_by_key(|f| (f.after, f.nodes.start));
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use stribeck_mesh::{Annulus, Groove, Mesh};

    use super::*;
    use crate::{Dynamics, Elastic, Model};

    #[test]
    fn by_hand_elements_that_are_alike_are_whole_groups_or_the_last() {
        let of = |shapes: &[(u8, usize)]| {
            let shapes: Vec<u8> = shapes.iter().flat_map(|&(shape, n)| vec![shape; n]).collect();
            alike(shapes.len(), |i, j| shapes[i] == shapes[j])
        };
        for (shapes, expected) in [
            (&[(0, 5)][..], 0..5),
            (&[(0, 100)], 0..100),
            (&[(0, 3), (1, 100)], 8..103),
            (&[(0, 100), (1, 3)], 0..96),
            (&[(0, 96), (1, 1)], 0..96),
            (&[(0, 40), (1, 1), (0, 60)], 48..101),
            (&[(0, 64), (1, 1), (0, 40)], 0..64),
            (&[(0, 9), (1, 38), (2, 9)], 0..0),
            (&[(0, 9), (1, 40), (2, 9)], 16..48),
            (&[(0, 9), (1, 47), (2, 9)], 16..56),
            (&[(0, 1), (1, 1), (2, 1)], 0..0),
        ] {
            assert_eq!(of(shapes), expected, "{shapes:?}");
        }
    }

    #[test]
    fn behaves_strips_of_a_grooved_ring_are_mostly_alike() {
        let grooves = vec![Groove::rectangular(0.5 * PI, 0.01, 0.2e-3)];
        let ring = Annulus {
            inner_radius: 0.1,
            outer_radius: 0.11,
            facets: 1257,
            layers: 20,
            start_angle: 0.0,
            grooves,
        };
        let mut mesh = Mesh::new();
        mesh.add("ring", &ring.part().expect("a ring that can be made"));
        let steel = Elastic::new(200e9, 0.3, 7850.0).expect("steel is a possible material");
        let model = Model::new(mesh, steel, 0.02).expect("a positive thickness");
        let d = Dynamics::new(&model, &vec![false; model.mesh.x.len()], 1).expect("a model that can run");
        let strips: Vec<&Strip> = d.tiles.iter().flat_map(|tile| &tile.strips).collect();
        let elements: usize = strips.iter().map(|s| s.len).sum();
        let alike: usize = strips.iter().map(|s| s.alike.len()).sum();
        assert!(elements > 9 * model.mesh.quads.len() / 10, "{elements} elements in strips");
        // The groove and two thicknesses on either side of it are a thirteenth of the ring; a part of a group
        // of lanes is lost beside them.
        assert!(20 * alike > 17 * elements, "{alike} of {elements} are alike");
    }
}
