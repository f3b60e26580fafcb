//! Compared numbers: those of a signal, whether simulated or measured, and the main ones of the run behind it.

use super::side::Member;
use stribeck_diagnosis::Defect;

/// A number of a signal.
#[derive(Debug)]
pub struct OfSignal {
    /// Stable name, the unit at its end where it has one of its own.
    pub name: &'static str,
    /// In words.
    pub words: &'static str,
    /// Its unit, empty for none; `None` for that of the signal.
    pub unit: Option<&'static str>,
    /// Where a campaign has it of the leading sensor.
    pub path: Option<&'static str>,
    pub(super) of: fn(&Member) -> Option<f64>,
}

/// All of them.
pub const OF_SIGNAL: [OfSignal; 9] = [
    level("rms", "root mean square", "levels.record.rms_g", |m| Some(m.shape?.rms)),
    level("peak", "peak", "levels.record.peak_g", |m| Some(m.shape?.peak)),
    shape("crest_factor", "crest factor", "levels.record.crest_factor", |m| m.shape.map(|s| s.peak / s.rms)),
    shape("kurtosis", "kurtosis", "levels.record.kurtosis", |m| Some(m.shape?.kurtosis)),
    OfSignal {
        name: "velocity_mm_s",
        words: "velocity, 10 to 1000 Hz",
        unit: Some("mm/s"),
        path: None,
        of: |m| m.velocity_mm_s,
    },
    family("bpfo_db", "BPFO in the envelope", "diagnosis.bpfo_level_db", |m| m.level_db(Defect::Bpfo)),
    family("bpfi_db", "BPFI in the envelope", "diagnosis.bpfi_level_db", |m| m.level_db(Defect::Bpfi)),
    family("bsf_db", "BSF in the envelope", "diagnosis.bsf_level_db", |m| m.level_db(Defect::Bsf)),
    family("ftf_db", "FTF in the envelope", "diagnosis.ftf_level_db", |m| m.level_db(Defect::Ftf)),
];

type Of = fn(&Member) -> Option<f64>;

const fn level(name: &'static str, words: &'static str, path: &'static str, of: Of) -> OfSignal {
    OfSignal { name, words, unit: None, path: Some(path), of }
}

const fn shape(name: &'static str, words: &'static str, path: &'static str, of: Of) -> OfSignal {
    OfSignal { name, words, unit: Some(""), path: Some(path), of }
}

const fn family(name: &'static str, words: &'static str, path: &'static str, of: Of) -> OfSignal {
    OfSignal { name, words, unit: Some("dB"), path: Some(path), of }
}
