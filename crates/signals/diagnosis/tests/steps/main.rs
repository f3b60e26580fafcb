//! Steps of a diagnosis, a module each: signals that are known, and what is found in them.

mod alarm;
mod ridge;
mod varying;
