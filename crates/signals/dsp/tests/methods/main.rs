//! Methods of this crate, a module each: signals that are known, and what is found in them.

mod angle;
mod averages;
mod band_envelopes;
mod comb;
mod cyclic;
mod envelope;
mod prewhitened;
mod resample;
mod ridge;
mod sensor;
mod sound;
mod spacing;
mod welch;
