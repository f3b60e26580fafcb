//! Stribeck analysis.
