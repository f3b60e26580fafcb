//! Steps of an analysis, a module each: signals and scenes that are known, and what is found in them.

mod comparison;
mod differences;
mod duty;
mod ensemble;
mod enveloping;
mod events;
mod families;
mod filtering;
mod levels;
mod loudest;
mod noise;
mod paper_figures;
mod prediction;
mod rolling;
mod tones;
