//! One run of a bearing, whatever model moves it: samples, energy ledger, guards, checkpoints.
//!
//! A model in motion implements [`Motion`](time_loop::Motion): it takes the steps of a sampling interval and
//! fills a [`Sample`](channels::Sample). [`Run`](time_loop::Run) drives it, writes `trace.npy` and
//! `energy.npy`, stops what diverges and saves checkpoints.
//!
//! | Question | File |
//! |---|---|
//! | What does the program around a run provide? | `host.rs` |
//! | What is known before the first step? | `setup.rs` |
//! | **What is recorded, and in which order?** | `channels.rs` |
//! | What is a sampling interval? | `time_loop.rs` |
//! | What is watched? | `guards.rs`, of contact `softness.rs` |
//! | How does a run continue? | `checkpoint.rs`, `resume.rs` |

pub mod channels;
pub mod checkpoint;
pub mod guards;
pub mod host;
pub mod resume;
pub mod setup;
pub mod time_loop;
