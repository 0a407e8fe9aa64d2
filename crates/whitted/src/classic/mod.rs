//! The paper's own structures and walks: what the production tree is measured against.
//!
//! *B. Tóth, "Speed optimized Recursive Ray-tracer with KD-Tree and SSE vector mathematics"*: a kd-tree of 8-byte nodes
//! (§2.3.2) built by the surface area heuristic or by medians (§2.3.1), a uniform grid to compare with, walks by repeated
//! point location or with a stack (§2.3.3), the projected triangle test (§2.2.1). One ray at a time.
//!
//! # Invariants
//! * Nothing of the production walks knows that this exists.
//! * Hits are those of [`geometry`](crate::geometry)'s single definition: every structure and walk here finds, bit by bit,
//!   what brute force finds. Only [`TriangleTest::Projection`] has a definition of its own.
//! * References, depth and memory are bounded for any input.

mod build;
mod cast;
mod grid;
mod kd_tree;
mod math;
mod node;
mod objects;
mod observer;
mod projection;
mod ray;
mod trace;
mod walk;
mod workload;

pub use build::Split;
pub use cast::{Caster, Structure, Walk};
pub use grid::{Grid, GridReport};
pub use kd_tree::{Cell, CellContent, KdReport, KdTree};
pub use math::Math;
pub use node::NodeId;
pub use objects::{Objects, TriangleTest};
pub use observer::{Observer, Steps};
pub use trace::{Event, Trace};
pub use workload::{Alignment, Operation, Workload};
