//! Linear elastic, isotropic material in plane strain.

use crate::error::{Error, check};

/// Linear elastic, isotropic material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Elastic {
    youngs_modulus: f64,
    poissons_ratio: f64,
    density: f64,
}

impl Elastic {
    /// Young's modulus [Pa], Poisson's ratio [-] and density [kg/m³].
    ///
    /// # Errors
    /// When the modulus or the density is not positive, or the ratio lies outside (−1, 0.5).
    pub fn new(youngs_modulus: f64, poissons_ratio: f64, density: f64) -> Result<Self, Error> {
        check("Young's modulus [Pa]", youngs_modulus, youngs_modulus > 0.0, "positive")?;
        let in_range = poissons_ratio > -1.0 && poissons_ratio < 0.5;
        check("Poisson's ratio", poissons_ratio, in_range, "between -1 and 0.5, both excluded")?;
        check("density [kg/m³]", density, density > 0.0, "positive")?;
        Ok(Self { youngs_modulus, poissons_ratio, density })
    }

    /// Young's modulus E [Pa].
    pub fn youngs_modulus(&self) -> f64 {
        self.youngs_modulus
    }

    /// Poisson's ratio ν [-].
    pub fn poissons_ratio(&self) -> f64 {
        self.poissons_ratio
    }

    /// Density ρ [kg/m³].
    pub fn density(&self) -> f64 {
        self.density
    }

    /// First Lamé parameter λ [Pa].
    pub fn lame(&self) -> f64 {
        let nu = self.poissons_ratio;
        self.youngs_modulus * nu / ((1.0 + nu) * (1.0 - 2.0 * nu))
    }

    /// Shear modulus µ [Pa].
    pub fn shear(&self) -> f64 {
        self.youngs_modulus / (2.0 * (1.0 + self.poissons_ratio))
    }

    /// Plane-strain modulus E' = E / (1 − ν²) [Pa].
    pub fn plane_strain_modulus(&self) -> f64 {
        self.youngs_modulus / (1.0 - self.poissons_ratio * self.poissons_ratio)
    }

    /// Speed of dilatational waves √((λ + 2µ)/ρ) [m/s].
    pub fn dilatational_speed(&self) -> f64 {
        ((self.lame() + 2.0 * self.shear()) / self.density).sqrt()
    }
}
