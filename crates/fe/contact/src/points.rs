//! Contact points of a secondary surface: where the penalty is evaluated, and the area of each.

use std::ops::Range;

use serde::{Deserialize, Serialize};
use stribeck_simd::lanes::LANES;

use stribeck_surface::Surface;

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
    /// Most points on a facet: more than thirty resolve nothing new.
    pub const MOST_POINTS: usize = 32;
}

/// Facets with more points than this fill vectors of their own; others share vectors with their neighbours.
pub(crate) const FEW_POINTS: usize = 4;

/// Contact points. Facets with points of equal places and weights share a pattern, so that data of all rows
/// stay in cache. After the last one each field is padded for a vector.
#[derive(Debug)]
pub(crate) struct Points {
    /// Place on the facet, 0 … 1.
    pub(crate) place: Vec<f64>,
    /// Height of the curve above the chord there [m].
    pub(crate) height: Vec<f64>,
    /// Length of surface that the point stands for [m].
    pub(crate) weight: Vec<f64>,
    pub(crate) of_facet: Vec<Pattern>,
    /// Most points of one facet.
    pub(crate) most: usize,
}

/// Which points a facet has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Pattern {
    pub(crate) first: u32,
    pub(crate) points: u32,
}

/// A point of a facet: place, height, weight.
type Point = [f64; 3];

/// Facets are alike when their points agree to this part of a facet's length.
const ALIKE: f64 = 1e-9;

/// A facet is compared with this many patterns before it gets one of its own.
const COMPARED: usize = 8;

impl Points {
    pub(crate) fn new(surface: &Surface, method: Method) -> Self {
        let mut all =
            Self { place: Vec::new(), height: Vec::new(), weight: Vec::new(), of_facet: Vec::new(), most: 0 };
        let tributary = surface.tributary();
        let mut patterns: Vec<Pattern> = Vec::new();
        let mut points: Vec<Point> = Vec::new();
        for f in 0..surface.facets() {
            points.clear();
            let mut push = |place: f64, weight: f64| points.push([place, surface.height(f, place), weight]);
            match method {
                Method::Collocated => push(0.0, tributary[f]),
                Method::Integrated { points: n } => {
                    let share = surface.lengths()[f] / n as f64;
                    if surface.corners()[f] {
                        push(0.0, 0.5 * share);
                    }
                    (0..n).for_each(|i| push((i as f64 + 0.5) / n as f64, share));
                }
            }
            // The last node of an open surface begins no facet.
            if !surface.closed && f + 1 == surface.facets() {
                let weight = match method {
                    Method::Collocated => tributary[f + 1],
                    Method::Integrated { points: n } => 0.5 * surface.lengths()[f] / n as f64,
                };
                push(1.0, weight);
            }
            let alike = |pattern: &&Pattern| all.agrees(**pattern, &points, surface.lengths()[f]);
            let pattern = patterns.iter().rev().take(COMPARED).find(alike).copied();
            let pattern = pattern.unwrap_or_else(|| {
                let new = Pattern { first: all.place.len() as u32, points: points.len() as u32 };
                for &[place, height, weight] in &points {
                    all.place.push(place);
                    all.height.push(height);
                    all.weight.push(weight);
                }
                patterns.push(new);
                new
            });
            all.of_facet.push(pattern);
            all.most = all.most.max(points.len());
        }
        let padded = all.place.len() + LANES;
        for field in [&mut all.place, &mut all.height, &mut all.weight] {
            field.resize(padded, 0.0);
        }
        all
    }

    /// Whether these points of a facet of this length are those of a pattern.
    fn agrees(&self, pattern: Pattern, points: &[Point], length: f64) -> bool {
        let near = |(i, [place, height, weight]): (usize, &Point)| {
            self.place[i] == *place
                && (self.height[i] - height).abs() <= ALIKE * length
                && (self.weight[i] - weight).abs() <= ALIKE * length
        };
        pattern.points as usize == points.len() && pattern.range().zip(points).all(near)
    }

    /// Whether these points, of facets of the given mean length [m], are those of another surface.
    pub(crate) fn are_alike(&self, other: &Self, length: f64) -> bool {
        let agree = |a: &[f64], b: &[f64]| {
            a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() <= ALIKE * length)
        };
        self.of_facet == other.of_facet
            && self.place == other.place
            && agree(&self.height, &other.height)
            && agree(&self.weight, &other.weight)
    }

    /// Length of surface that the points deal out to each node [m], with the margin that shares of both signs
    /// need.
    pub(crate) fn on_nodes(&self, surface: &Surface) -> Vec<f64> {
        let mut dealt = vec![0.0; surface.slots.len()];
        for (f, pattern) in self.of_facet.iter().enumerate() {
            for i in pattern.range() {
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
}

impl Pattern {
    /// Room that its points take in memory: whole vectors where they are done row by row.
    #[inline(always)]
    pub(crate) fn room(self) -> u32 {
        if self.points as usize > FEW_POINTS {
            self.points.next_multiple_of(LANES as u32)
        } else {
            self.points
        }
    }

    #[inline(always)]
    pub(crate) fn range(self) -> Range<usize> {
        self.first as usize..(self.first + self.points) as usize
    }
}
