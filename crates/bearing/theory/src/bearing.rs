//! A bearing as plain numbers: circles in millimetres, from which its speeds follow, and rings, rolling elements
//! and material in SI, which give way under load.

use crate::material::Material;

/// One of the two rings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ring {
    /// The outer ring.
    Outer,
    /// The inner ring, which turns with the shaft.
    Inner,
}

/// Circles that roll on each other, in mm as catalogues print them: ratios of them keep their last digits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dimensions {
    /// Diameter of the outer raceway [mm].
    pub outer_race_mm: f64,
    /// Diameter of the inner raceway [mm].
    pub inner_race_mm: f64,
    /// Diameter of a rolling element [mm].
    pub roller_mm: f64,
    /// Number of rolling elements.
    pub rollers: usize,
}

/// Rings, rolling elements and material of a bearing in a plane [m].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bearing {
    /// Radius of the outer raceway [m].
    pub outer_race_radius: f64,
    /// Radius of the inner raceway [m].
    pub inner_race_radius: f64,
    /// Radial thickness of the outer ring [m]; `None` for one that does not deform.
    pub outer_ring_thickness: Option<f64>,
    /// Radial thickness of the inner ring [m].
    pub inner_ring_thickness: f64,
    /// Radius of a rolling element [m].
    pub roller_radius: f64,
    /// Number of rolling elements.
    pub rollers: usize,
    /// Diametral clearance [m], below zero where elements are pressed: to the last digit, which a difference of
    /// radii loses.
    pub clearance: f64,
    /// Length of the line contacts, out of plane [m].
    pub thickness: f64,
    /// Material of rings and rolling elements.
    pub material: Material,
}

impl Dimensions {
    /// Pitch diameter [mm]: half-way between the raceways.
    pub fn pitch_mm(&self) -> f64 {
        0.5 * (self.outer_race_mm + self.inner_race_mm)
    }
}

impl Bearing {
    /// Effective radius of a roller in the outer raceway, 1/(1/r − 1/R_o) [m].
    pub fn outer_contact_radius(&self) -> f64 {
        1.0 / (1.0 / self.roller_radius - 1.0 / self.outer_race_radius)
    }

    /// Effective radius of a roller on the inner raceway, 1/(1/r + 1/R_i) [m].
    pub fn inner_contact_radius(&self) -> f64 {
        1.0 / (1.0 / self.roller_radius + 1.0 / self.inner_race_radius)
    }
}

/// The bearing of Singh et al. 2014, table 1, on which tests try the theory.
#[cfg(test)]
pub(crate) mod singh2014 {
    use super::{Bearing, Dimensions, Material};

    pub(crate) const DIMENSIONS: Dimensions =
        Dimensions { outer_race_mm: 200.0, inner_race_mm: 163.96, roller_mm: 18.0, rollers: 24 };

    pub(crate) const BEARING: Bearing = Bearing {
        outer_race_radius: 0.1,
        inner_race_radius: 0.08198,
        outer_ring_thickness: Some(10e-3),
        inner_ring_thickness: 10e-3,
        roller_radius: 9e-3,
        rollers: 24,
        clearance: 40e-6,
        thickness: 30e-3,
        material: Material { youngs_modulus: 200e9, poissons_ratio: 0.3, density: 7850.0 },
    };
}
