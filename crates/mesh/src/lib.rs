//! Stribeck mesh.
