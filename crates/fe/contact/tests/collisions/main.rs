//! Bodies that hit each other: momentum, energy, the bar impact. One problem a file.

#[path = "../common/mod.rs"]
mod common;

mod two_bars;

mod oblique_blocks;

mod disc_between_plates;
mod wheel_between_plates;

use stribeck_contact::Law;

use common::*;

/// A penalty as stiff as an element of this size [m].
fn penalty(size: f64) -> Law {
    Law::penalty(steel().plane_strain_modulus() / size).expect("a positive stiffness")
}
