//! A polyline in given positions: which vertices and facets follow one another, and where they are.

/// Vertices of a polyline in given positions.
pub struct Vertices<'a> {
    /// Slots of its nodes, in walking order.
    pub slots: &'a [u32],
    /// True when the last node is joined to the first.
    pub closed: bool,
    /// Positions [m] by slot.
    pub x: &'a [f64],
    /// See `x`.
    pub y: &'a [f64],
}

impl Vertices<'_> {
    /// Number of facets.
    #[inline]
    pub fn facets(&self) -> usize {
        if self.closed { self.slots.len() } else { self.slots.len() - 1 }
    }

    /// Numbers of the two vertices of a facet.
    #[inline]
    pub fn vertices(&self, f: usize) -> (usize, usize) {
        (f, if f + 1 == self.slots.len() { 0 } else { f + 1 })
    }

    /// Positions of the two ends of a facet [m].
    #[inline]
    pub fn ends(&self, f: usize) -> ([f64; 2], [f64; 2]) {
        let at = |v: usize| {
            let slot = self.slots[v] as usize;
            [self.x[slot], self.y[slot]]
        };
        let (a, b) = self.vertices(f);
        (at(a), at(b))
    }

    /// The facet before another, if there is one.
    pub fn before(&self, f: usize) -> Option<usize> {
        neighbour(self.facets(), self.closed, f, false)
    }

    /// The facet after another, if there is one.
    pub fn after(&self, f: usize) -> Option<usize> {
        neighbour(self.facets(), self.closed, f, true)
    }
}

/// The facet after (`forward`) or before another, if there is one.
#[inline(always)]
pub fn neighbour(facets: usize, closed: bool, facet: usize, forward: bool) -> Option<usize> {
    let last = facets - 1;
    match (forward, closed) {
        (true, _) if facet < last => Some(facet + 1),
        (false, _) if facet > 0 => Some(facet - 1),
        (true, true) => Some(0),
        (false, true) => Some(last),
        _ => None,
    }
}
