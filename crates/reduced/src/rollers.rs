//! Rollers in groups of eight, one number of each side by side, and the raceway under them.

pub(crate) mod block;
pub(crate) mod raceway_motion;
pub(crate) mod row;
