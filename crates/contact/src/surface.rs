//! A boundary polyline that can touch others.

use crate::error::Error;

/// Vertices that turn by more than this are corners: they get a contact point of their own [rad].
const CORNER_ANGLE: f64 = 0.35;

/// An oriented boundary polyline: walking along it the solid lies on the left, the outward normal points right.
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
}

impl Surface {
    /// From slots and reference positions [m] by slot.
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
        let facets = if closed { n } else { n - 1 };
        let along = |f: usize| {
            let (a, b) = (slots[f] as usize, slots[(f + 1) % n] as usize);
            [x[b] - x[a], y[b] - y[a]]
        };
        let length: Vec<f64> = (0..facets).map(|f| along(f)[0].hypot(along(f)[1])).collect();
        if !length.iter().all(|&l| l > 0.0 && l.is_finite()) {
            return Err(Error::BadSurface { name, reason: "has a facet of no length" });
        }
        let corner = (0..n)
            .map(|v| {
                if !closed && (v == 0 || v == n - 1) {
                    return true;
                }
                let (p, q) = (along((v + facets - 1) % facets), along(v % facets));
                let turn = (p[0] * q[1] - p[1] * q[0]).atan2(p[0] * q[0] + p[1] * q[1]);
                turn.abs() > CORNER_ANGLE
            })
            .collect();
        Ok(Self { name, slots, closed, length, corner })
    }

    /// Number of facets.
    pub fn facets(&self) -> usize {
        self.length.len()
    }

    /// Mean facet length [m].
    pub fn mean_length(&self) -> f64 {
        self.length.iter().sum::<f64>() / self.facets() as f64
    }

    /// Slots of the two ends of a facet.
    #[inline(always)]
    pub(crate) fn ends(&self, facet: usize) -> (usize, usize) {
        let next = if facet + 1 == self.slots.len() { 0 } else { facet + 1 };
        (self.slots[facet] as usize, self.slots[next] as usize)
    }

    /// The facet after (`+1`) or before (`−1`), if there is one.
    #[inline(always)]
    pub(crate) fn neighbour(&self, facet: usize, forward: bool) -> Option<usize> {
        let last = self.facets() - 1;
        match (forward, self.closed) {
            (true, _) if facet < last => Some(facet + 1),
            (false, _) if facet > 0 => Some(facet - 1),
            (true, true) => Some(0),
            (false, true) => Some(last),
            _ => None,
        }
    }

    /// True when either end of the facet is a corner.
    #[inline(always)]
    pub(crate) fn meets_corner(&self, facet: usize) -> bool {
        let next = if facet + 1 == self.slots.len() { 0 } else { facet + 1 };
        self.corner[facet] || self.corner[next]
    }

    /// Length that belongs to each vertex [m]: half of each facet that meets there.
    pub(crate) fn tributary(&self) -> Vec<f64> {
        let mut v = vec![0.0; self.slots.len()];
        for (f, l) in self.length.iter().enumerate() {
            v[f] += 0.5 * l;
            let next = if f + 1 == v.len() { 0 } else { f + 1 };
            v[next] += 0.5 * l;
        }
        v
    }
}
