//! Contact and oil: method, penalty, damping, friction, and the lubricant.

use crate::{group, words};

/// Largest coefficient of friction that a scene may have.
pub(crate) const MOST_FRICTION: f64 = 2.0;

group! {
    /// Contact method and laws.
    pub struct ContactScene {
        /// Points at which the penalty acts.
        pub method: ContactMethod = ContactMethod::Integrated;
        /// Curve that the facets of raceways, rollers and seats represent.
        pub surface: ContactSurface = ContactSurface::Facet;
        /// How the surfaces of raceways and rollers move with their nodes.
        pub interpolation: ContactInterpolation = ContactInterpolation::Linear;
        /// Integration points on a facet (`integrated` only).
        pub points_per_facet: usize = 16, within(1.0, 16.0);
        /// Whose points are evaluated where rollers touch.
        pub passes: ContactPasses = ContactPasses::Two;
        /// Formula of stiffness and critical damping, for squares of the size of the mesh.
        pub formula: ContactFormula = ContactFormula::ElementLayer, before("element_layer");
        /// Penalty stiffness as a multiple of that of the formula [-].
        pub penalty_scale: f64 = 0.05, positive(1_000.0);
        /// Gap at which contact of rollers sets in [µm]: up to as deep a penetration the pressure rises as a
        /// parabola, beyond it in proportion. Zero for a sharp corner.
        pub onset_um: f64 = 0.0, within(0.0, 20.0);
        /// Normal contact damping as a fraction of critical [-].
        pub damping_ratio: f64 = 0.1, within(0.0, 1.0);
        /// Coulomb coefficient of rollers on raceways and cage [-].
        pub friction: f64 = 0.005, within(0.0, MOST_FRICTION);
        /// Coulomb coefficient of the adapter on the outer ring [-].
        pub seat_friction: f64 = 0.1, within(0.0, 2.0);
    }
}

words! {
    /// Formula of the stiffness and the critical damping of contact, for squares of the mesh's size.
    pub enum ContactFormula: Copy, Eq {
        /// As soft as the raceways of a steel bearing: penalty and mesh together give way under the largest
        /// static force as Hertz's contacts do (THEORY §6.2), times 1/`penalty_scale`, which is 1 here.
        /// That of every bearing but the paper's.
        Hertz = "hertz",
        /// `penalty_scale` × E / element size; critical damping of two equal surface layers on that spring.
        ElementLayer = "element_layer",
    }
}

words! {
    /// Curve that the facets of raceways, rollers and seats represent. Corners (walls of the defect, cage) stay
    /// sharp in any case.
    pub enum ContactSurface: Copy, Eq {
        /// The chords themselves.
        Facet = "facet",
        /// Arcs about the centre of the ring or roller.
        Arc = "arc",
        /// Nagata patches, from the directions of neighbouring facets alone.
        Nagata = "nagata",
    }
}

words! {
    /// How a contact surface moves with its nodes.
    pub enum ContactInterpolation: Copy, Eq {
        /// Every facet with its own two nodes.
        Linear = "linear",
        /// As a cubic spline of smoothed nodes, six to a facet: a rolling load does not depend on its
        /// position between nodes.
        Spline = "spline",
    }
}

words! {
    /// Whose points are evaluated where rollers touch. The seat takes both sides in any case.
    pub enum ContactPasses: Copy, Eq {
        /// Those of both bodies, each with half of the stiffness.
        Two = "two",
        /// Those of the roller alone, with the whole stiffness: half the work, for points that stand closer
        /// than the features of a raceway.
        One = "one",
    }
}

words! {
    /// Where the contact penalty acts.
    pub enum ContactMethod: Copy, Eq {
        /// At the nodes of both surfaces against the facets of the other (two-pass node-to-segment).
        Collocated = "collocated",
        /// Integrated over the facets of both surfaces.
        Integrated = "integrated",
    }
}

group! {
    /// Oil between rollers and raceways, fully flooded.
    pub struct FilmScene {
        /// Dynamic viscosity of the oil at the temperature of the bearing and ambient pressure [Pa s].
        pub viscosity_pa_s: f64 = 0.05, within(1e-4, 10.0);
        /// Pressure–viscosity coefficient α [1/GPa].
        pub pressure_viscosity_per_gpa: f64 = 22.0, within(1.0, 100.0);
        /// Composite roughness of roller and raceway, √(Rq₁² + Rq₂²) [µm].
        pub roughness_um: f64 = 0.3, within(0.01, 10.0);
        /// What the oil takes from the motion (reduced model); `None`: films push apart, and nothing else.
        pub resistance: Option<ResistanceScene> = None, omitted();
    }
}

group! {
    /// Resistance of oil to rolling and sliding, and its drag on rollers: what makes a lightly loaded bearing
    /// skid.
    pub struct ResistanceScene {
        /// Largest traction of a loaded contact over its normal force [-], in the place of `contact.friction`.
        pub limiting_traction: f64 = 0.05, within(1e-3, 0.2);
        /// Part of the space between the rings that oil fills [%]: rollers push as much of it along.
        pub oil_percent: f64 = 10.0, within(0.0, 100.0);
    }
}
