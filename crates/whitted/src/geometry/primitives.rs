//! All primitives.
