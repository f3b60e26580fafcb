//! The program as its users meet it: its words, files and exit codes, one subject a module. What a run computes
//! is tested below, in `stribeck-simulation`.

#![cfg(unix)]

mod common;

mod campaign;
mod data_set;
mod duty;
mod ensemble;
mod everyday;
mod first_hour;
mod fmu;
mod forty;
mod machine;
mod measured;
mod mistakes;
mod physical;
mod quick_run;
mod resume;
mod rotor;
mod same_door;
mod second_round;
mod sources;
mod validate;
mod vectors;
