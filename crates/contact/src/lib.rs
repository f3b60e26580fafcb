//! Stribeck contact.
