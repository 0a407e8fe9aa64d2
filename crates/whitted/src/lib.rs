//! A fast, exact, deterministic Whitted-style ray tracer and ray-query library for the CPU.
//!
//! # What this crate knows
//! Rays, primitives, trees, surfaces, scenes and the render loop, in this order of layers:
//! [`math`] ← [`ray`] ← [`geometry`] ← { [`tree`], [`shading`] } ← { [`scene`], [`query`], [`classic`] } ← [`render`].
//!
//! # Where to begin
//! * To ask what rays hit: [`query::RayScene`].
//! * To render: [`scene::Scene`], [`scene::Prepared`], [`render::render`].
//!
//! # Invariants
//! * It opens no file, prints nothing, reads no environment and asks no clock.
//! * A pixel depends on scene, [`scene::Settings`] and its coordinates only: never on threads, regions, batch order,
//!   walk, instruction set or tree ([`render::Execution`]).
//! * No `unsafe`; no platform math library (`simd::math` has portable functions).

#![forbid(unsafe_code)]
#![cfg_attr(not(test), deny(clippy::disallowed_methods, clippy::print_stdout, clippy::print_stderr))]

pub mod classic;
pub mod geometry;
pub mod math;
pub mod query;
pub mod ray;
pub mod render;
pub mod scene;
pub mod shading;
pub mod tree;

/// The README's example is a test.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;

/// So are those of the guide to ray queries.
#[cfg(doctest)]
#[doc = include_str!("../../../docs/queries.md")]
struct Queries;
