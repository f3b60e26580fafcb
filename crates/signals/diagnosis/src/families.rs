//! The defect families: where each is looked for, how high it stands, and whether it is claimed.

pub(crate) mod candidate;
pub(crate) mod comb_at_half;
pub(crate) mod controls;
pub mod defect;
pub(crate) mod element_rhythm;
pub mod family;
pub(crate) mod halves;
pub(crate) mod limits;
pub(crate) mod machine_lines;
pub(crate) mod power;
pub(crate) mod rules;
pub(crate) mod second;
pub mod sidebands;
pub mod sound;
pub mod unexplained;
pub(crate) mod unknown_bearing;
pub(crate) mod unrelated;
pub(crate) mod verdict;
