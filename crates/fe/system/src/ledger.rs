//! The energy ledger: energy stored, dissipated and supplied (THEORY §2.5).

use serde::{Deserialize, Serialize};

/// Imbalance is never measured against less than this share of the kinetic energy: where nothing is strained,
/// the rounding of a large kinetic energy is no imbalance.
const ROUNDING: f64 = 1e-9;

/// Energies at the positions before the last step [J].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Ledger {
    /// When that was [s].
    pub time: f64,
    /// Kinetic energy.
    pub kinetic: f64,
    /// Strain energy.
    pub strain: f64,
    /// Energy in the hourglass stiffness.
    pub hourglass: f64,
    /// Stored in contact, and in its springs under oil films.
    pub contact: f64,
    /// Stored by forces that the user has added.
    pub further: f64,
    /// Heat of friction since the start.
    pub friction: f64,
    /// Heat of mass, stiffness and structural damping since the start, and the energy of the latter's
    /// springs.
    pub damping: f64,
    /// Heat of damping in contact, and in forces that the user has added, since the start.
    pub contact_damping: f64,
    /// Heat of oil films since the start.
    pub film: f64,
    /// Work of loads and of gravity since the first step.
    pub external: f64,
    /// Work of prescribed motions since the start.
    pub drive: f64,
    /// By how much the balance differs from that of the first step.
    pub imbalance: f64,
    /// |imbalance| over the energy that the limits name ([`Scale`]) [-]; infinite when an energy is no number.
    pub relative_error: f64,
}

impl Ledger {
    /// Kinetic and stored energy [J].
    pub fn inside(&self) -> f64 {
        self.kinetic + self.strain + self.hourglass + self.contact + self.further
    }

    /// Energy stored and dissipated less energy supplied [J]: constant but for the error of the time step.
    pub fn balance(&self) -> f64 {
        self.kinetic
            + self.strain
            + self.hourglass
            + self.contact
            + self.further
            + self.friction
            + self.damping
            + self.contact_damping
            + self.film
            - self.external
            - self.drive
    }
}

/// Reference of an imbalance of energy.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Scale {
    /// The largest energy in the model so far, kinetic energy included.
    #[default]
    TotalEnergy,
    /// The largest strain energy so far, where a large kinetic energy would hide what matters.
    StrainEnergy,
}

impl Scale {
    pub(crate) fn words(self) -> &'static str {
        match self {
            Self::TotalEnergy => "largest energy",
            Self::StrainEnergy => "peak strain energy",
        }
    }
}

/// Origin of the ledger, and its extremes.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Balance {
    /// Balance at the first step [J]; none before it. It must balance against that step, not against nothing.
    pub(crate) reference: Option<f64>,
    /// Work of gravity at the start [J].
    pub(crate) gravity_work: Option<f64>,
    /// Largest energy of the ledgers so far [J].
    pub peak_energy: f64,
    /// Largest strain energy of the ledgers so far [J].
    pub peak_strain: f64,
    /// Largest relative error of the ledgers so far [-].
    pub largest_error: f64,
}

impl Balance {
    /// Enters a ledger, and completes it; the first one is the reference where nothing was entered before.
    pub fn begin_or_enter(&mut self, ledger: &mut Ledger, scale: Scale) {
        self.reference.get_or_insert(ledger.balance());
        self.enter(ledger, scale);
    }

    /// Enters a ledger, and completes it.
    pub(crate) fn enter(&mut self, ledger: &mut Ledger, scale: Scale) {
        self.peak_strain = self.peak_strain.max(ledger.strain);
        self.peak_energy = self.peak_energy.max(ledger.inside());
        ledger.imbalance = ledger.balance() - self.reference.unwrap_or(0.0);
        let peak = match scale {
            Scale::TotalEnergy => self.peak_energy,
            Scale::StrainEnergy => self.peak_strain,
        };
        let over = peak.max(ROUNDING * ledger.kinetic.abs());
        let over = if over > 0.0 { over } else { 1.0 };
        let imbalance = ledger.imbalance.abs();
        ledger.relative_error = if imbalance.is_finite() { imbalance / over } else { f64::INFINITY };
        self.largest_error = self.largest_error.max(ledger.relative_error);
    }
}
