//! Stribeck solver.
