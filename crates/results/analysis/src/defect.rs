//! The family of lines that a defect on a surface of a scene makes.

use stribeck_diagnosis::Defect;
use stribeck_scene::deviation::RollingSurface;
use stribeck_theory::kinematics::Kinematics;

/// Whose frequency a defect on `surface` has.
pub fn on(surface: RollingSurface) -> Defect {
    match surface {
        RollingSurface::Outer => Defect::Bpfo,
        RollingSurface::Inner => Defect::Bpfi,
        RollingSurface::Roller(_) => Defect::Bsf,
    }
}

/// How often the shocks of a defect come.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shocks {
    /// The damaged part.
    pub defect: Defect,
    /// Shocks a second [Hz]: twice BSF for a rolling element.
    pub hz: f64,
}

impl Shocks {
    /// Shocks of a defect on `surface` without slip.
    pub fn of(surface: RollingSurface, kinematics: &Kinematics) -> Self {
        let defect = on(surface);
        let hz = match defect {
            Defect::Bpfo => kinematics.bpfo_hz,
            Defect::Bpfi => kinematics.bpfi_hz,
            Defect::Bsf => kinematics.bsf_hz,
            Defect::Ftf => kinematics.cage_hz,
        };
        Self { defect, hz: defect.shocks_per_period() * hz }
    }

    /// Name of their frequency.
    pub fn name(self) -> &'static str {
        self.defect.shocks_name()
    }
}
