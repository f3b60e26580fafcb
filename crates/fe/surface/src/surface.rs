//! A boundary polyline that can touch others, and the curve that it stands for.

use crate::{
    error::Error,
    polyline::{Vertices, neighbour},
    smooth::{KINK, Rise, Smoothing, height, rises},
    spline::Spline,
};

/// Vertices that turn by more than this are corners: they get a contact point of their own [rad].
const CORNER_ANGLE: f64 = 0.35;

/// An oriented boundary polyline: walking along it the solid lies on the left, the outward normal points
/// right.
#[derive(Debug, Clone)]
pub struct Surface {
    /// Name, for messages.
    pub name: String,
    /// Slots of its nodes, in walking order.
    pub slots: Vec<u32>,
    /// True when the last node is joined to the first.
    pub closed: bool,
    /// Length of each facet in the reference positions [m].
    pub(crate) length: Vec<f64>,
    /// True for a vertex where the surface turns by a corner in the reference positions.
    pub(crate) corner: Vec<bool>,
    /// True for a facet with a corner at either end.
    pub(crate) beside_corner: Vec<bool>,
    /// How each facet's curve stands off its chord [m].
    pub(crate) rise: Vec<Rise>,
    /// True for a vertex where two smoothed facets join without a kink.
    pub(crate) smooth: Vec<bool>,
    /// True when every facet is its chord, and depends on its own two nodes only.
    pub(crate) flat: bool,
    /// Dependence of the curve on its nodes; `None` when each facet depends on its own two.
    pub(crate) spline: Option<Spline>,
}

impl Surface {
    /// From slots and reference positions [m] by slot; contact is with the chords.
    ///
    /// # Errors
    /// When there is no facet or one has no length.
    pub fn new(
        name: impl Into<String>,
        slots: Vec<u32>,
        closed: bool,
        x: &[f64],
        y: &[f64],
    ) -> Result<Self, Error> {
        let name = name.into();
        let n = slots.len();
        if n < 2 || (closed && n < 3) {
            return Err(Error::BadSurface { name, reason: "needs at least one facet, three when closed" });
        }
        if slots.iter().any(|&s| s as usize >= x.len().min(y.len())) {
            return Err(Error::BadSurface { name, reason: "lists a slot for which there is no position" });
        }
        let at = Vertices { slots: &slots, closed, x, y };
        let along = |f: usize| {
            let ([ax, ay], [bx, by]) = at.ends(f);
            [bx - ax, by - ay]
        };
        let length: Vec<f64> = (0..at.facets()).map(|f| libm::hypot(along(f)[0], along(f)[1])).collect();
        if !length.iter().all(|&l| l > 0.0 && l.is_finite()) {
            return Err(Error::BadSurface { name, reason: "has a facet of no length" });
        }
        let corner: Vec<bool> =
            turns(&at, |f| [along(f); 2]).iter().map(|turn| turn.abs() > CORNER_ANGLE).collect();
        let facets = at.facets();
        let beside_corner =
            (0..facets).map(|f| at.vertices(f)).map(|(a, b)| corner[a] || corner[b]).collect();
        Ok(Self {
            name,
            slots,
            closed,
            length,
            corner,
            beside_corner,
            rise: vec![[0.0; 2]; facets],
            smooth: vec![false; n],
            flat: true,
            spline: None,
        })
    }

    /// The same polyline, standing for a smooth curve through its vertices in the reference positions `x`,
    /// `y` [m] by slot. The curve then moves and turns with each facet's two ends.
    ///
    /// # Errors
    /// When the curve leaves a facet by more than half its length: the polyline is too coarse for it.
    pub fn smoothed(mut self, smoothing: Smoothing, x: &[f64], y: &[f64]) -> Result<Self, Error> {
        let at = Vertices { slots: &self.slots, closed: self.closed, x, y };
        self.spline = None;
        self.rise = rises(smoothing, &at, &self.corner);
        self.flat = self.rise.iter().all(|r| *r == [0.0; 2]);
        let steep = |(r, l): (&Rise, &f64)| r.iter().any(|r| r.is_nan() || r.abs() >= 0.5 * l);
        if self.rise.iter().zip(&self.length).any(steep) {
            let reason = "is too coarse to be smoothed: its curve would leave a chord by more than 27°";
            return Err(Error::BadSurface { name: self.name, reason });
        }
        let ends = |f: usize| {
            let ([ax, ay], [bx, by]) = at.ends(f);
            let (tx, ty) = (bx - ax, by - ay);
            // The normal points right: n L = (ty, −tx).
            let along = |rise: f64| {
                let r = rise / self.length[f];
                [tx + r * ty, ty - r * tx]
            };
            self.rise[f].map(along)
        };
        let kinks = turns(&at, ends);
        let curved = |f: usize| self.rise[f] != [0.0; 2];
        self.smooth = (0..self.slots.len())
            .map(|v| {
                let (before, after) = match v {
                    0 if self.closed => (self.slots.len() - 1, 0),
                    v if !self.closed && (v == 0 || v == self.slots.len() - 1) => return false,
                    v => (v - 1, v),
                };
                curved(before) && curved(after) && kinks[v].abs() < KINK
            })
            .collect();
        Ok(self)
    }

    /// Length of each facet in the reference positions [m].
    #[inline(always)]
    pub fn lengths(&self) -> &[f64] {
        &self.length
    }

    /// Whether the polyline turns by a corner at each vertex, in the reference positions.
    #[inline(always)]
    pub fn corners(&self) -> &[bool] {
        &self.corner
    }

    /// Whether each facet has a corner at either end.
    #[inline(always)]
    pub fn beside_corner(&self) -> &[bool] {
        &self.beside_corner
    }

    /// How each facet's curve rises above its chord [m].
    #[inline(always)]
    pub fn rises(&self) -> &[Rise] {
        &self.rise
    }

    /// The spline that carries the curve; `None` when each facet moves with its own two nodes.
    #[inline(always)]
    pub fn spline(&self) -> Option<&Spline> {
        self.spline.as_ref()
    }

    /// Number of facets.
    #[inline]
    pub fn facets(&self) -> usize {
        self.length.len()
    }

    /// Whether every facet is its chord, and depends on its own two nodes only.
    #[inline]
    pub fn is_flat(&self) -> bool {
        self.flat
    }

    /// Mean facet length [m].
    pub fn mean_length(&self) -> f64 {
        self.length.iter().sum::<f64>() / self.facets() as f64
    }

    /// Largest height of the curve above or below its chords [m].
    pub fn largest_sag(&self) -> f64 {
        let middle = |r: &Rise| height(*r, 0.5).abs();
        let spline = self.spline.as_ref().map_or(0.0, Spline::largest_height);
        self.rise.iter().map(middle).fold(spline, f64::max)
    }

    /// Steepest slope of the curve against its chords [-].
    pub fn steepest(&self) -> f64 {
        let slope = |(r, l): (&Rise, &f64)| r[0].abs().max(r[1].abs()) / l;
        self.rise.iter().zip(&self.length).map(slope).fold(0.0, f64::max)
    }

    /// Height of the curve at a place of a facet, above what moves with the nodes [m].
    #[inline]
    pub fn height(&self, facet: usize, place: f64) -> f64 {
        match &self.spline {
            Some(spline) => spline.height(facet, place),
            None => height(self.rise[facet], place),
        }
    }

    /// Vertices that a point depends on, with their shares.
    #[inline]
    pub fn shares(&self, facet: usize, place: f64) -> [(usize, f64); 6] {
        match &self.spline {
            Some(spline) => spline.shares(facet, place),
            None => {
                let (a, b) = (facet, self.second(facet));
                [(a, 1.0 - place), (b, place), (a, 0.0), (a, 0.0), (a, 0.0), (a, 0.0)]
            }
        }
    }

    /// What shares of both signs add to a bound on forces dealt out to each vertex [-]: one, but beside
    /// corners of a spline.
    pub fn unevenness(&self) -> Vec<f64> {
        let mut most = vec![1.0_f64; self.slots.len()];
        for f in (0..self.facets()).filter(|_| self.spline.is_some()) {
            for s in [0.0, 0.25, 0.5, 0.75, 1.0] {
                let shares = self.shares(f, s);
                let sum: f64 = shares.iter().map(|(_, s)| s.abs()).sum();
                shares.iter().for_each(|&(v, _)| most[v] = most[v].max(sum * sum));
            }
        }
        most
    }

    /// Slots of the two ends of a facet.
    #[inline(always)]
    pub fn ends(&self, facet: usize) -> (usize, usize) {
        (self.slots[facet] as usize, self.slots[self.second(facet)] as usize)
    }

    /// Number of the second vertex of a facet; the first has the facet's number.
    #[inline(always)]
    pub fn second(&self, facet: usize) -> usize {
        if facet + 1 == self.slots.len() { 0 } else { facet + 1 }
    }

    /// The facet after (`+1`) or before (`−1`), if there is one.
    #[inline(always)]
    pub fn neighbour(&self, facet: usize, forward: bool) -> Option<usize> {
        neighbour(self.facets(), self.closed, facet, forward)
    }

    /// Whether two facets are one or have a vertex in common.
    #[inline]
    pub fn adjoin(&self, a: usize, b: usize) -> bool {
        a == b || [true, false].iter().any(|&forward| self.neighbour(a, forward) == Some(b))
    }

    /// Length that belongs to each vertex [m]: half of each facet that meets there.
    pub fn tributary(&self) -> Vec<f64> {
        let mut v = vec![0.0; self.slots.len()];
        for (f, l) in self.length.iter().enumerate() {
            v[f] += 0.5 * l;
            v[self.second(f)] += 0.5 * l;
        }
        v
    }
}

/// Angle by which each vertex turns [rad], from the directions in which facets begin and end; π at open ends.
fn turns(at: &Vertices<'_>, directions: impl Fn(usize) -> [[f64; 2]; 2]) -> Vec<f64> {
    let (n, facets) = (at.slots.len(), at.facets());
    (0..n)
        .map(|v| {
            if !at.closed && (v == 0 || v == n - 1) {
                return std::f64::consts::PI;
            }
            let (p, q) = (directions((v + facets - 1) % facets)[1], directions(v % facets)[0]);
            libm::atan2(p[0] * q[1] - p[1] * q[0], p[0] * q[0] + p[1] * q[1])
        })
        .collect()
}
