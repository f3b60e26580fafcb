//! Stribeck dsp.
