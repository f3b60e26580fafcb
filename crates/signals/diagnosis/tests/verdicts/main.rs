//! Verdicts on records whose truth is known.

mod combs;
mod elements;
mod families;
mod given;
mod joint;
mod lengths;
mod power;
mod records;
mod signals;
mod sound;
mod sources;
mod speed;
