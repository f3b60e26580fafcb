//! Facets of splines, one at a time.

use crate::{
    facet::{Closest, Facet},
    foot::{FacetPoint, Foot, Push},
    patch::{Patch, within_patch},
    polynomial::{Coefficients, Polynomial},
    surface::Surface,
};

/// Corrections of single feet at most: far from the facet, where the walk goes on, they are given up.
const MOST_CORRECTIONS: usize = 6;

/// A facet of a spline.
#[derive(Debug, Clone, Copy)]
pub struct SplineFacet {
    number: usize,
    /// Its curve in present positions.
    pub patch: Patch<f64>,
}

impl Facet for SplineFacet {
    type Coefficients = Polynomial<f64, 4>;

    #[inline(always)]
    fn new(surface: &Surface, x: &[f64], y: &[f64], number: usize) -> Self {
        let spline = surface.spline.as_ref().expect("only surfaces with a spline are seen as patches");
        Self { number, patch: spline.patch(x, y, number) }
    }

    #[inline(always)]
    fn number(&self) -> usize {
        self.number
    }

    #[inline(always)]
    fn point(&self, place: f64, height: f64) -> FacetPoint<f64> {
        self.patch.point(place, height)
    }

    #[inline(always)]
    fn foot(&self, p: [f64; 2]) -> Foot<f64> {
        self.patch.foot(p, 1.0, MOST_CORRECTIONS).0
    }

    #[inline]
    fn closest(&self, p: [f64; 2]) -> Closest {
        let foot = self.foot(p);
        let inside = (0.0..=1.0).contains(&foot.place);
        let end = self.patch.curve.value(foot.place.clamp(0.0, 1.0));
        let distance = if inside { foot.gap.abs() } else { libm::hypot(p[0] - end[0], p[1] - end[1]) };
        Closest { foot, distance, inside }
    }

    #[inline(always)]
    fn holds(&self, foot: &Foot<f64>) -> bool {
        within_patch(foot.place, 1.0) > 0.0
    }

    #[inline]
    fn is_past(&self, foot: &Foot<f64>, _other: &Self, forward: bool, _p: [f64; 2]) -> bool {
        if forward { foot.place > 1.0 } else { foot.place < 0.0 }
    }

    #[inline(always)]
    fn gather(&self, surface: &Surface, x: &[f64], y: &[f64]) -> Polynomial<f64, 4> {
        match &surface.spline {
            Some(spline) => spline.gather(x, y, self.number),
            None => Polynomial::zero(0.0),
        }
    }

    #[inline(always)]
    fn scatter(&self, surface: &Surface, forces: &Polynomial<f64, 4>, push: &mut Vec<Push>) {
        if let Some(spline) = &surface.spline {
            spline.scatter(self.number, forces, push);
        }
    }
}
