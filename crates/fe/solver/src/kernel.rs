//! The hot loops of a step, and how nodes and elements lie in memory for them. Results depend on it by
//! rounding only; the equations are in `element.rs` and THEORY §2.
//!
//! | Question | File |
//! |---|---|
//! | Where do nodes and elements lie in memory? | `layout.rs`; for one tile, ready to run, `tile.rs` and `varying_references.rs` |
//! | What happens to a tile in a step? | `sweep.rs` |
//! | How are forces of elements computed and summed? | in strips `strip.rs`, elsewhere `gather.rs` and `batch.rs`; one element `quad_forms.rs` |
//! | How do nodes move? | `advance.rs`; with mass damping `frames.rs` and `mass_sums.rs`, with stiffness damping `stiffness_damping.rs`, with structural damping `structural_damping.rs` |
//! | Which thread does which tile? | `parallel.rs`, on parts of the `fields.rs` |

pub mod layout;

pub(crate) mod advance;
pub(crate) mod batch;
pub(crate) mod fields;
pub(crate) mod frames;
mod gather;
pub(crate) mod mass_sums;
pub(crate) mod parallel;
mod quad_forms;
pub(crate) mod stiffness_damping;
mod strip;
pub(crate) mod structural_damping;
pub(crate) mod sweep;
pub(crate) mod tile;
mod varying_references;
