//! The Whitted ray tracer.
