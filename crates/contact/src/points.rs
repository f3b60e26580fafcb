//! Contact points of a secondary surface: where the penalty is evaluated, and how much surface each stands for.

use stribeck_solver::lanes::LANES;

use crate::surface::Surface;

/// Where the penalty acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// At the nodes (two-pass node-to-segment).
    Collocated,
    /// At this many points on every facet, equal weights, and at corners.
    Integrated {
        /// Points on a facet.
        points: usize,
    },
}

impl Method {
    /// Most points on a facet: a point on every thirtieth of a facet sees nothing new.
    pub const MOST_POINTS: usize = 32;
}

/// Contact points, facet by facet. Fields of points go on beyond the last one, so that whole vectors can be read.
#[derive(Debug, Clone)]
pub(crate) struct Points {
    /// Place on the facet, 0 … 1.
    pub(crate) place: Vec<f64>,
    /// Height of the curve above the chord there [m].
    pub(crate) height: Vec<f64>,
    /// Length of surface that the point stands for [m].
    pub(crate) weight: Vec<f64>,
    /// First point of each facet; one more entry than facets.
    pub(crate) first: Vec<u32>,
}

impl Points {
    pub(crate) fn new(surface: &Surface, method: Method) -> Self {
        let mut points = Self { place: Vec::new(), height: Vec::new(), weight: Vec::new(), first: vec![0] };
        let tributary = surface.tributary();
        for f in 0..surface.facets() {
            match method {
                Method::Collocated => points.push(0.0, tributary[f]),
                Method::Integrated { points: n } => {
                    let share = surface.length[f] / n as f64;
                    if surface.corner[f] {
                        points.push(0.0, 0.5 * share);
                    }
                    (0..n).for_each(|i| points.push((i as f64 + 0.5) / n as f64, share));
                }
            }
            // The last node of an open surface begins no facet.
            if !surface.closed && f + 1 == surface.facets() {
                let weight = match method {
                    Method::Collocated => tributary[f + 1],
                    Method::Integrated { points: n } => 0.5 * surface.length[f] / n as f64,
                };
                points.push(1.0, weight);
            }
            let new = points.height.len()..points.place.len();
            points.height.extend(points.place[new].iter().map(|&s| surface.height(f, s)));
            points.first.push(points.place.len() as u32);
        }
        let padded = points.len() + LANES;
        for field in [&mut points.place, &mut points.height, &mut points.weight] {
            field.resize(padded, 0.0);
        }
        points
    }

    fn push(&mut self, place: f64, weight: f64) {
        self.place.push(place);
        self.weight.push(weight);
    }

    pub(crate) fn len(&self) -> usize {
        self.first.last().map_or(0, |&last| last as usize)
    }

    /// Length of surface that the points deal out to each node [m], with the margin that shares of both signs need.
    pub(crate) fn on_nodes(&self, surface: &Surface) -> Vec<f64> {
        let mut dealt = vec![0.0; surface.slots.len()];
        for f in 0..surface.facets() {
            for i in self.of_facet(f) {
                // (Σ s u)² ≤ Σ|s| · Σ |s| u².
                let shares = surface.shares(f, self.place[i]);
                let sum: f64 = shares.iter().map(|(_, s)| s.abs()).sum();
                shares.iter().for_each(|(v, s)| dealt[*v] += sum * s.abs() * self.weight[i]);
            }
        }
        dealt
    }

    /// Longest length of surface that one point stands for [m].
    pub(crate) fn largest_weight(&self) -> f64 {
        self.weight.iter().copied().fold(0.0, f64::max)
    }

    pub(crate) fn of_facet(&self, facet: usize) -> std::ops::Range<usize> {
        self.first[facet] as usize..self.first[facet + 1] as usize
    }
}
