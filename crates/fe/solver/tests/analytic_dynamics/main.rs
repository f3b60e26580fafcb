//! Motion against closed forms: waves, vibration, free fall, rotation; and the order of the time step. One
//! problem a file.

#[path = "../common/mod.rs"]
mod common;

mod pressure_wave;
mod ring_bending;

mod free_fall;

mod block_under_a_couple;
mod block_with_a_changing_rate;
mod block_with_a_prescribed_rate;
mod ring_driven_at_its_bore;

mod time_step_order;
