//! Contact and oil: method, penalty, damping, friction, and the lubricant.

use serde::{Deserialize, Serialize};

/// Contact method and laws.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ContactScene {
    /// Points at which the penalty acts.
    pub method: ContactMethod,
    /// Curve that the facets of raceways and rollers represent.
    pub surface: ContactSurface,
    /// How the surfaces of raceways and rollers move with their nodes.
    pub interpolation: ContactInterpolation,
    /// Integration points on a facet (`integrated` only).
    pub points_per_facet: usize,
    /// Whose points are evaluated where rollers touch.
    pub passes: ContactPasses,
    /// Formula of stiffness and critical damping.
    pub formula: ContactFormula,
    /// Penalty stiffness as a multiple of that of the formula [-].
    pub penalty_scale: f64,
    /// Gap at which contact of rollers sets in [µm]: up to as deep a penetration the pressure rises as a
    /// parabola, beyond it in proportion. Zero for a sharp corner.
    pub onset_um: f64,
    /// Normal contact damping as a fraction of critical [-].
    pub damping_ratio: f64,
    /// Coulomb coefficient of rollers on raceways and cage [-].
    pub friction: f64,
    /// Coulomb coefficient of the adapter on the outer ring [-].
    pub seat_friction: f64,
}

/// Formula of the stiffness and the critical damping of contact, for squares of the mesh's size.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ContactFormula {
    /// `penalty_scale` × E / element size; critical damping of two equal surface layers on that spring.
    ElementLayer,
    /// LS-DYNA's standard penalty: `penalty_scale` (`SLSFAC` × `SFS`, usually 0.1) × bulk modulus × area² /
    /// volume of the element behind a segment, on each pass. `damping_ratio` is `VDC` / 100, whose critical
    /// damping is 2 m ω.
    LsdynaStandard,
    /// LS-DYNA's segment-based penalty (`SOFT` = 2): `penalty_scale` (likewise) × ½ m₁m₂/(m₁ + m₂) / Δt², of
    /// segments with half an element each. `damping_ratio` as in the standard penalty.
    LsdynaSegment,
}

/// Curve that the facets of raceways and rollers represent. Corners (walls of the defect, cage) stay sharp in
/// any case.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ContactSurface {
    /// The chords themselves.
    Facet,
    /// Arcs about the centre of the ring or roller.
    Arc,
    /// Nagata patches, from the directions of neighbouring facets alone.
    Nagata,
}

/// How a contact surface moves with its nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ContactInterpolation {
    /// Every facet with its own two nodes.
    Linear,
    /// As a cubic spline of smoothed nodes, six to a facet: a rolling load does not depend on its position
    /// between nodes.
    Spline,
}

/// Whose points are evaluated where rollers touch; the seat takes both sides in any case.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ContactPasses {
    /// Those of both bodies, each with half of the stiffness.
    Two,
    /// Those of the roller alone, with the whole stiffness: half the work, for points that stand closer than
    /// the features of a raceway.
    One,
}

/// Where the contact penalty acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ContactMethod {
    /// At the nodes of both surfaces against the facets of the other (two-pass node-to-segment).
    Collocated,
    /// Integrated over the facets of both surfaces.
    Integrated,
}

/// Oil between rollers and raceways, fully flooded.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct FilmScene {
    /// Dynamic viscosity of the oil at the temperature of the bearing and ambient pressure [Pa s].
    pub viscosity_pa_s: f64,
    /// Pressure–viscosity coefficient α [1/GPa].
    pub pressure_viscosity_per_gpa: f64,
    /// Composite roughness of roller and raceway, √(Rq₁² + Rq₂²) [µm].
    pub roughness_um: f64,
}

impl Default for ContactScene {
    fn default() -> Self {
        Self {
            method: ContactMethod::Integrated,
            surface: ContactSurface::Facet,
            interpolation: ContactInterpolation::Linear,
            points_per_facet: 16,
            passes: ContactPasses::Two,
            formula: ContactFormula::ElementLayer,
            penalty_scale: 0.05,
            onset_um: 0.0,
            damping_ratio: 0.1,
            friction: 0.005,
            seat_friction: 0.1,
        }
    }
}

impl Default for FilmScene {
    fn default() -> Self {
        Self { viscosity_pa_s: 0.05, pressure_viscosity_per_gpa: 22.0, roughness_um: 0.3 }
    }
}
