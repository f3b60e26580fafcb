//! Making a surface move as a spline: the heights that keep its curve where it is in the reference positions
//! (THEORY §4.5).

use crate::{
    chord::ChordFacet, facet::Facet, narrow_phase::find_foot, patch::Patch, spline::Spline, surface::Surface,
};

impl Surface {
    /// The same curve, moving as a spline of its nodes instead of facet by facet; to be asked for after
    /// [`smoothed`](Self::smoothed), in the same positions.
    pub fn splined(mut self, x: &[f64], y: &[f64]) -> Self {
        self.spline = None;
        let mut spline = Spline::new(&self.slots, &self.corner, self.facets());
        for f in 0..self.facets() {
            let patch = spline.patch(x, y, f);
            let at = [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0].map(|s| height_to(&self, x, y, f, &patch, s));
            spline.set_height(f, at);
        }
        self.spline = Some(spline);
        self.flat = false;
        self.smooth = self.corner.iter().map(|corner| !corner).collect();
        self
    }
}

/// Distance along a patch's normal from its point at `s` to the surface's curve [m].
fn height_to(surface: &Surface, x: &[f64], y: &[f64], facet: usize, patch: &Patch<f64>, s: f64) -> f64 {
    let mut height = 0.0;
    // The curve is all but parallel to the spline: each turn takes out all but a thousandth of the rest.
    for _ in 0..4 {
        let point = patch.point(s, height);
        let mut chord = ChordFacet::new(surface, x, y, facet);
        let Some(foot) = find_foot(&mut chord, surface, x, y, point.at) else { break };
        height -= foot.gap / libm::hypot(foot.normal[0], foot.normal[1]);
    }
    height
}
