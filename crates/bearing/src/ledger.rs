//! The energy ledger: what is in the model, what has left it, what came in (THEORY §2.5).

use serde::{Deserialize, Serialize};

/// Columns of `energy.npy`.
pub(crate) const COLUMNS: [&str; 11] = [
    "time_s",
    "kinetic_j",
    "strain_j",
    "hourglass_j",
    "contact_j",
    "friction_j",
    "damping_j",
    "contact_damping_j",
    "external_j",
    "drive_j",
    "relative_error",
];

/// Energies at one moment [J].
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Ledger {
    pub(crate) kinetic: f64,
    pub(crate) strain: f64,
    pub(crate) hourglass: f64,
    pub(crate) contact: f64,
    pub(crate) friction: f64,
    pub(crate) damping: f64,
    pub(crate) contact_damping: f64,
    pub(crate) external: f64,
    pub(crate) drive: f64,
}

impl Ledger {
    /// What is in the model and what has left it, less what came in.
    pub(crate) fn balance(&self) -> f64 {
        self.kinetic
            + self.strain
            + self.hourglass
            + self.contact
            + self.friction
            + self.damping
            + self.contact_damping
            - self.external
            - self.drive
    }

    /// One record of `energy.npy`.
    pub(crate) fn row(&self, time: f64, error: f64) -> [f64; COLUMNS.len()] {
        [
            time,
            self.kinetic,
            self.strain,
            self.hourglass,
            self.contact,
            self.friction,
            self.damping,
            self.contact_damping,
            self.external,
            self.drive,
            error,
        ]
    }
}

/// What the ledger counts from: it must balance against the first step, not against nothing.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Reference {
    /// Balance at the first step [J]; none before it.
    pub(crate) balance: Option<f64>,
    /// Work of gravity at the start [J].
    pub(crate) gravity_work: f64,
}
