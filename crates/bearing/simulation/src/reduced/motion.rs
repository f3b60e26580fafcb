//! The reduced bearing as the time loop drives it: its readings become samples, its energies a ledger.

use crate::error::Error;
use crate::run::{
    channels::{CageSample, RollerSample, Sample, SensorSample},
    time_loop::Motion,
};
use serde::{Deserialize, Serialize};
use stribeck_reduced::{
    bearing::Bearing, motion::BearingInMotion, motion::Energies, readings::RollerReading,
};
use stribeck_scene::resolved::ResolvedScene;
use stribeck_store::run_info::RunInfo;
use stribeck_system::{Balance, Ledger, Scale};

use super::guards::{Guards, LedgerError};

/// A reduced bearing in motion, its samples, ledger and guards.
pub struct ReducedMotion {
    bearing: BearingInMotion,
    balance: Balance,
    off: LedgerError,
    guards: Guards,
    sample: Sample,
}

/// Its state in a checkpoint.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Saved {
    /// The bearing.
    pub bearing: stribeck_reduced::motion::Saved,
    balance: Balance,
}

impl ReducedMotion {
    /// Before its first step.
    pub fn start(scene: &ResolvedScene, bearing: Bearing, state: stribeck_reduced::state::State) -> Self {
        let saved = stribeck_reduced::motion::Saved::first(&bearing, state);
        Self::go_on(scene, bearing, Saved { bearing: saved, balance: Balance::default() })
    }

    /// From a checkpoint of this bearing.
    pub(crate) fn go_on(scene: &ResolvedScene, bearing: Bearing, saved: Saved) -> Self {
        Self {
            bearing: BearingInMotion::new(bearing, saved.bearing),
            balance: saved.balance,
            off: LedgerError::default(),
            guards: Guards::new(scene),
            sample: Sample::of(scene),
        }
    }
}

impl Motion for ReducedMotion {
    type Saved = Saved;

    fn interval(&mut self, steps: usize) -> Result<Ledger, Error> {
        let mut ledger = ledger(self.bearing.interval(steps));
        self.balance.begin_or_enter(&mut ledger, Scale::StrainEnergy);
        self.off = LedgerError::of(&ledger);
        Ok(ledger)
    }

    fn sample(&mut self) -> &Sample {
        let Self { bearing, sample, .. } = self;
        sample.time = bearing.time();
        for (sensor, reading) in sample.sensors.iter_mut().zip(bearing.sensors()) {
            *sensor = SensorSample { mean: reading.mean, instant: reading.instant };
        }
        for (roller, RollerReading { centre, spin, outer, inner, cage, films }) in
            sample.rollers.iter_mut().zip(bearing.rollers())
        {
            *roller = RollerSample { centre, spin, outer, inner, cage: roller.cage.and(Some(cage)), films };
        }
        if let (Some(cage), Some((centre, angle))) = (&mut sample.cage, bearing.cage()) {
            *cage = CageSample { centre, angle };
        }
        sample.seat = bearing.seat();
        sample
    }

    fn steps(&self) -> u64 {
        self.bearing.steps()
    }

    fn time(&self) -> f64 {
        self.bearing.time()
    }

    fn balance(&self) -> [f64; 2] {
        [self.balance.peak_strain, self.balance.largest_error]
    }

    fn look(&mut self, info: &mut RunInfo) -> Option<String> {
        self.guards.look(info, &self.bearing, self.off)
    }

    fn saved(&self) -> Saved {
        Saved { bearing: self.bearing.saved(), balance: self.balance }
    }
}

/// The ledger of these energies, not entered into a balance yet.
fn ledger(e: Energies) -> Ledger {
    Ledger {
        time: e.time,
        kinetic: e.kinetic,
        strain: e.strain,
        contact: e.contact,
        friction: e.friction,
        damping: e.damping,
        contact_damping: e.contact_damping,
        film: e.film,
        external: e.external,
        drive: e.drive,
        ..Ledger::default()
    }
}
