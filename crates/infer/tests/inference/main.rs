//! Answers with a closed form, and synthetic simulators whose truths are known.

mod calibrated;
mod curves;
mod design;
mod gaussian_process;
mod levels;
mod modes;
mod posterior_linear;
mod priors;
mod refusals;
mod simulator;
mod targets;
