//! Compared quantities: of one signal, and of the run behind it.

use serde_json::Value;

use super::side::Member;
use stribeck_diagnosis::Defect;

/// Unit of the signal itself.
pub(super) const OF_SIGNAL: &str = "signal";

/// A number that a side may have.
pub(super) struct Quantity {
    /// Stable name, the unit at its end where it has one of its own.
    pub(super) name: &'static str,
    /// In words.
    pub(super) words: &'static str,
    /// Its unit, [`OF_SIGNAL`] for that of the signal, empty for none.
    pub(super) unit: &'static str,
    of: Of,
}

/// Where it is taken from.
enum Of {
    Member(fn(&Member) -> Option<f64>),
    /// Level of a family that is there [dB].
    Level(Defect),
    /// Path in `summary.json` of a run.
    Summary(&'static str),
}

impl Quantity {
    /// Its value in one signal, where that has one.
    pub(super) fn of(&self, member: &Member) -> Option<f64> {
        let value = match self.of {
            Of::Member(of) => of(member),
            Of::Level(defect) => member.level_db(defect),
            Of::Summary(path) => member.summary.pointer(path).and_then(Value::as_f64),
        };
        value.filter(|value| value.is_finite())
    }
}

const fn quantity(name: &'static str, words: &'static str, unit: &'static str, of: Of) -> Quantity {
    Quantity { name, words, unit, of }
}

/// All of them, in the order of the table.
pub(super) const ALL: [Quantity; 20] = [
    quantity("rms", "root mean square", OF_SIGNAL, Of::Member(|m| m.shape.map(|s| s.rms))),
    quantity("peak", "peak", OF_SIGNAL, Of::Member(|m| m.shape.map(|s| s.peak))),
    quantity("crest_factor", "crest factor", "", Of::Member(|m| m.shape.map(|s| s.peak / s.rms))),
    quantity("kurtosis", "kurtosis", "", Of::Member(|m| m.shape.map(|s| s.kurtosis))),
    quantity("velocity_mm_s", "velocity, 10 to 1000 Hz", "mm/s", Of::Member(|m| m.velocity_mm_s)),
    quantity("bpfo_db", "BPFO in the envelope", "dB", Of::Level(Defect::Bpfo)),
    quantity("bpfi_db", "BPFI in the envelope", "dB", Of::Level(Defect::Bpfi)),
    quantity("bsf_db", "BSF in the envelope", "dB", Of::Level(Defect::Bsf)),
    quantity("ftf_db", "FTF in the envelope", "dB", Of::Level(Defect::Ftf)),
    quantity("exit_g", "peak at exits from the defect", "g", Of::Summary("/levels/exit_g")),
    quantity("entry_g", "peak at entries to the defect", "g", Of::Summary("/levels/entry_g")),
    quantity("gap_g", "peak between passages", "g", Of::Summary("/levels/gap_g")),
    quantity("gap_rms_g", "root mean square between passages", "g", Of::Summary("/levels/gap_rms_g")),
    quantity("support_n", "mean force of all rollers on the outer ring", "N", Of::Summary("/load/mean_n")),
    quantity("max_roller_n", "largest force on a roller", "N", Of::Summary("/load/max_roller_n")),
    quantity("bpfo_hz", "BPFO of the recorded motion", "Hz", Of::Summary("/kinematics/bpfo_hz")),
    quantity("cage_hz", "cage", "Hz", Of::Summary("/kinematics/cage_hz")),
    quantity("roller_spin_hz", "spin of loaded rollers", "Hz", Of::Summary("/kinematics/roller_spin_hz")),
    quantity("spall_mm", "length of the spall by its events", "mm", Of::Member(Member::spall_mm)),
    quantity("heat_j", "heat of friction and damping", "J", Of::Summary("/energy/heat_j")),
];
