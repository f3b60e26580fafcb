//! An elastic material, and the moduli that follow from it.

/// A linear elastic, isotropic material in plane strain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Material {
    /// Young's modulus E [Pa].
    pub youngs_modulus: f64,
    /// Poisson's ratio ν [-].
    pub poissons_ratio: f64,
    /// Density ρ [kg/m³].
    pub density: f64,
}

impl Material {
    /// Modulus of two touching bodies of this material, E* = E/(2(1 − ν²)) [Pa].
    pub fn contact_modulus(&self) -> f64 {
        self.youngs_modulus / (2.0 * (1.0 - self.poissons_ratio.powi(2)))
    }

    /// Bulk modulus K = E/(3(1 − 2ν)) [Pa].
    pub fn bulk_modulus(&self) -> f64 {
        self.youngs_modulus / (3.0 * (1.0 - 2.0 * self.poissons_ratio))
    }

    /// Speed of dilatational waves √((λ + 2µ)/ρ) [m/s].
    pub fn dilatational_speed(&self) -> f64 {
        let nu = self.poissons_ratio;
        (self.youngs_modulus * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu)) / self.density).sqrt()
    }

    /// Shear modulus G = E/(2(1 + ν)) [Pa].
    pub fn shear_modulus(&self) -> f64 {
        self.youngs_modulus / (2.0 * (1.0 + self.poissons_ratio))
    }
}
