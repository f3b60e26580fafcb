//! A single facet, whatever its curve: points on it, feet on it, and how node fields and forces map to its
//! coefficients.

use crate::{
    foot::{FacetPoint, Foot, Push},
    polynomial::Coefficients,
    surface::Surface,
};

/// A facet in present positions.
pub trait Facet: Copy {
    /// Coefficients of the facet's polynomial.
    type Coefficients: Coefficients<f64>;

    /// The facet of this number in the positions `x`, `y` [m] by slot.
    fn new(surface: &Surface, x: &[f64], y: &[f64], number: usize) -> Self;

    /// Its number on its surface.
    fn number(&self) -> usize;

    /// The point at a place and a height above the polynomial.
    fn point(&self, place: f64, height: f64) -> FacetPoint<f64>;

    /// Foot of `p` on the facet's curve, which is extended beyond its ends.
    fn foot(&self, p: [f64; 2]) -> Foot<f64>;

    /// The closest point of this facet alone.
    fn closest(&self, p: [f64; 2]) -> Closest;

    /// Whether a foot lies so far within the facet that no neighbour is nearer, unless there is a corner
    /// between.
    fn holds(&self, foot: &Foot<f64>) -> bool;

    /// Whether `p`, whose foot on this facet is `foot`, belongs to the neighbour beyond a joint without a
    /// kink.
    fn is_past(&self, foot: &Foot<f64>, other: &Self, forward: bool, p: [f64; 2]) -> bool;

    /// Coefficients of a node field.
    fn gather(&self, surface: &Surface, x: &[f64], y: &[f64]) -> Self::Coefficients;

    /// Hands forces on coefficients over to the nodes: the transpose of `gather`.
    fn scatter(&self, surface: &Surface, forces: &Self::Coefficients, push: &mut Vec<Push>);
}

/// The closest point of one facet.
#[derive(Debug, Clone, Copy)]
pub struct Closest {
    /// The foot on the facet's curve, which is extended beyond its ends.
    pub foot: Foot<f64>,
    /// Unsigned distance [m].
    pub distance: f64,
    /// False when the closest point is an end.
    pub inside: bool,
}
