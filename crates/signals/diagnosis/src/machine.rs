//! What is known of the machine.

use stribeck_theory::catalogue::CatalogueBearing;

use crate::length::pressed::Pressed;
use crate::sources::Surroundings;

/// No shaft turns slower or faster [1/min]: rings of kilns take minutes for a turn, spindles on air reach some
/// hundred thousand turns a minute.
pub const SPEEDS_RPM: std::ops::RangeInclusive<f64> = 1e-3..=1e6;

/// Speed and bearing of the machine, as far as they are known.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Machine {
    /// Speed of the shaft, against the outer ring where that turns [1/min].
    pub speed_rpm: Option<f64>,
    /// Speed of the outer ring, positive where it turns as the shaft does against it [1/min].
    pub outer_speed_rpm: f64,
    /// Its bearing.
    pub bearing: Option<CatalogueBearing>,
    /// The speed is measured, or that of a run: the lines of the shaft do not correct it.
    pub speed_is_exact: bool,
    /// Radial load, least and most [N]; `None` for the usual loads of such bearings.
    pub load_n: Option<(f64, f64)>,
    /// Radial internal clearance in operation, least and most [µm]; `None` for none.
    pub clearance_um: Option<(f64, f64)>,
    /// Compliance of the outer ring and its housing at the loaded place, least and most [µm/kN]; `None` for a
    /// rigid one.
    pub housing_um_per_kn: Option<(f64, f64)>,
    /// How far an element is pressed together over a spall, by simulation; `None` to compute it for rigid
    /// rings from load, clearance and compliance.
    pub pressed: Option<Pressed>,
    /// Scores of records of this machine when it was healthy ([`MeasuredFindings::score_db`]) [dB].
    ///
    /// [`MeasuredFindings::score_db`]: crate::MeasuredFindings::score_db
    pub sound_db: Vec<f64>,
    /// Combs that stand in records of this machine when it was healthy, at the same speed, and are no family's [Hz]:
    /// those of a converter, of the mains, of another bearing.
    pub shared_hz: Vec<f64>,
    /// Other shafts, gears and bearings.
    pub around: Surroundings,
}
