//! The law of contact between rollers and raceways: normal forces, damping and friction (THEORY §9.3, §9.4).

mod force;
pub(crate) mod normal_force;
mod raceway_forces;

/// The law of contact, in numbers a metre of contact.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ContactLaw {
    /// Normal and tangential stiffness [N/m²], and damping [N s/m²].
    pub(crate) penalty: f64,
    pub(crate) sticking: f64,
    pub(crate) damping: f64,
    /// Friction coefficient [-].
    pub(crate) friction: f64,
    /// Radius of a roller at which friction acts [m].
    pub(crate) arm: f64,
    /// Time step [s].
    pub(crate) time_step: f64,
    /// How far ahead of a roller its contacts are taken, over the force on it: Δt²/12m (THEORY §9.4); 0 with oil,
    /// whose films push, too [m/N].
    pub(crate) ahead: f64,
    /// Mass of a roller times that: Δt²/12 [s²].
    pub(crate) shadow: f64,
}
