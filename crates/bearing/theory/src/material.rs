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

    /// Shear modulus G = E/(2(1 + ν)) [Pa].
    pub fn shear_modulus(&self) -> f64 {
        self.youngs_modulus / (2.0 * (1.0 + self.poissons_ratio))
    }
}
