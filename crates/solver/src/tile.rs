//! A tile made ready to run: strips, references and the order in which rows of nodes are finished.

use std::ops::Range;

use stribeck_mesh::strips::find_strips;

use crate::{
    damping::LaneFrames,
    element::{QuadMetric, QuadReference, Stiffness, TriangleReference},
    lanes::LANES,
    layout::TileLayout,
    model::Motion,
};

/// Shorter runs of quadrilaterals go through the gather path.
const SHORTEST_STRIP: usize = 4;

/// One tile of work. All node numbers are local to the tile.
#[derive(Debug, Clone)]
pub(crate) struct Tile {
    /// Slots, own nodes first, then ghosts.
    pub(crate) slots: Range<usize>,
    pub(crate) own: usize,
    pub(crate) stiffness: Stiffness,
    pub(crate) strips: Vec<Strip>,
    /// References of strips whose elements differ, one array a component.
    pub(crate) varying: VaryingReferences,
    /// Elements outside strips; in a tile of congruent bodies all elements of the first body.
    pub(crate) quads: Vec<([u32; 4], QuadMetric)>,
    pub(crate) triangles: Vec<([u32; 3], TriangleReference)>,
    pub(crate) congruent: bool,
    /// False for a rigid body, whose nodes this tile does not move.
    pub(crate) elastic: bool,
    /// Nodes that are complete after a strip, in strip order.
    pub(crate) finish: Vec<Finish>,
    /// Own nodes that other forces may push.
    pub(crate) loaded: Vec<u32>,
    /// Time step over mass [s/kg]; zero for nodes without mass.
    pub(crate) step_over_mass: Vec<f64>,
    /// Damping of this tile's bodies, if any.
    pub(crate) damping: Option<TileDamping>,
}

/// Mass-proportional damping of one tile.
#[derive(Debug, Clone)]
pub(crate) struct TileDamping {
    /// Rate [1/s].
    pub(crate) rate: f64,
    pub(crate) frames: LaneFrames,
    /// Mass of each slot [kg], for the heat.
    pub(crate) mass: Vec<f64>,
}

/// A run of quadrilaterals whose corners all advance by one.
#[derive(Debug, Clone)]
pub(crate) struct Strip {
    pub(crate) corners: [u32; 4],
    pub(crate) len: usize,
    pub(crate) references: StripReferences,
    /// The whole row of corners 1 and 2 (or 4 and 3) is free and complete after this strip: it moves with it.
    pub(crate) completes: bool,
    /// It is the row of corners 4 and 3.
    pub(crate) completes_upper: bool,
}

/// References of a strip's elements.
#[derive(Debug, Clone)]
pub(crate) enum StripReferences {
    /// All alike: a ring's row, a square grid.
    Uniform(QuadMetric),
    /// From this position of the tile's [`VaryingReferences`].
    Varying(usize),
}

/// [`QuadReference`]s as a structure of arrays.
#[derive(Debug, Clone, Default)]
pub(crate) struct VaryingReferences {
    pub(crate) b1x: Vec<f64>,
    pub(crate) b1y: Vec<f64>,
    pub(crate) b2x: Vec<f64>,
    pub(crate) b2y: Vec<f64>,
    pub(crate) s1: Vec<f64>,
    pub(crate) s2: Vec<f64>,
    pub(crate) volume: Vec<f64>,
}

/// Consecutive own nodes that move alike and are complete once strip `after` is done, and do not move with it.
#[derive(Debug, Clone)]
pub(crate) struct Finish {
    /// Number of strips that must be done.
    pub(crate) after: usize,
    pub(crate) nodes: Range<usize>,
    pub(crate) motion: Motion,
}

impl VaryingReferences {
    fn push(&mut self, q: &QuadReference) {
        self.b1x.push(q.b1[0]);
        self.b1y.push(q.b1[1]);
        self.b2x.push(q.b2[0]);
        self.b2y.push(q.b2[1]);
        self.s1.push(q.s1);
        self.s2.push(q.s2);
        self.volume.push(q.volume);
    }
}

impl VaryingReferences {
    /// Repeats the last element, so that every strip ends with a whole group of lanes.
    fn pad(&mut self) {
        let Self { b1x, b1y, b2x, b2y, s1, s2, volume } = self;
        for v in [b1x, b1y, b2x, b2y, s1, s2, volume] {
            let last = v.last().copied().unwrap_or(0.0);
            v.resize(v.len() + LANES, last);
        }
    }
}

impl Tile {
    /// Prepares a tile. `motion` and `loaded` have one entry for each of its slots.
    pub(crate) fn new(
        layout: &TileLayout,
        quads: &[QuadReference],
        triangles: &[TriangleReference],
        stiffness: Stiffness,
        motion: &[Motion],
        loaded: &[bool],
    ) -> Self {
        let mut tile = Self {
            slots: layout.slots.clone(),
            own: layout.own,
            stiffness,
            strips: Vec::new(),
            varying: VaryingReferences::default(),
            quads: Vec::new(),
            triangles: layout.triangles.iter().map(|&(c, e)| (c, triangles[e])).collect(),
            congruent: layout.congruent,
            elastic: true,
            finish: Vec::new(),
            loaded: (0..layout.own as u32).filter(|&n| loaded[n as usize]).collect(),
            step_over_mass: Vec::new(),
            damping: None,
        };
        if layout.congruent {
            tile.quads =
                layout.quads.iter().map(|&(c, e)| (c, QuadMetric::new(&quads[e], &stiffness))).collect();
        } else {
            tile.add_strips(layout, quads);
            tile.varying.pad();
        }
        tile.schedule(motion);
        tile
    }

    fn add_strips(&mut self, layout: &TileLayout, quads: &[QuadReference]) {
        let corners: Vec<[u32; 4]> = layout.quads.iter().map(|&(c, _)| c).collect();
        for run in find_strips(&corners) {
            let elements = &layout.quads[run.first_element..run.first_element + run.len];
            // The two rows of corners must not overlap, or a strip would write to one node in two lanes at once.
            let rows_apart = run.corners[0].abs_diff(run.corners[3]) as usize > run.len;
            let pairs = run.corners[1] == run.corners[0] + 1 && run.corners[2] == run.corners[3] + 1;
            if run.len < SHORTEST_STRIP || !rows_apart || !pairs {
                let metric = |&(c, e): &([u32; 4], usize)| (c, QuadMetric::new(&quads[e], &self.stiffness));
                self.quads.extend(elements.iter().map(metric));
                continue;
            }
            let first = quads[elements[0].1];
            let references = if elements.iter().all(|&(_, e)| quads[e].is_congruent(&first)) {
                StripReferences::Uniform(QuadMetric::new(&first, &self.stiffness))
            } else {
                let start = self.varying.b1x.len();
                elements.iter().for_each(|&(_, e)| self.varying.push(&quads[e]));
                StripReferences::Varying(start)
            };
            let (completes, completes_upper) = (false, false);
            self.strips.push(Strip {
                corners: run.corners,
                len: run.len,
                references,
                completes,
                completes_upper,
            });
        }
    }

    /// Lists which nodes are complete after which strip: the last one that reads or pushes them.
    fn schedule(&mut self, motion: &[Motion]) {
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
        let mut with_strip = vec![false; self.own];
        for (s, strip) in self.strips.iter_mut().enumerate() {
            for upper in [false, true] {
                let first = strip.corners[if upper { 3 } else { 0 }] as usize;
                let row = first..first + strip.len + 1;
                if row.end <= self.own && row.clone().all(|n| after[n] == s + 1 && motion[n] == Motion::Free)
                {
                    (strip.completes, strip.completes_upper) = (true, upper);
                    with_strip[row].fill(true);
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
