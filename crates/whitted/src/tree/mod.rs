//! Finding what a ray hits: the builder, the tree, the walks and the brute-force oracle.
//!
//! # Invariants
//! * There is one definition of a hit, in [`geometry`](crate::geometry): every walk offers the same candidates with
//!   bit-equal t to a goal that prefers the smaller (t, primitive), so the answer depends on neither tree, walk,
//!   instruction set nor order.
//! * Boxes are padded so that no candidate is lost to rounding (`fit::PADDING`).
//! * References, depth and memory are bounded for any input.

mod all_hits;
mod bit_set;
mod brute_force;
mod build;
mod cells;
mod crossings;
mod expected_cost;
mod filter;
mod fit;
mod goal;
mod leaf;
mod node;
pub mod policy;
mod query;
mod refit;
mod reorder;
mod validate;
mod walk;
mod wide;

pub use bit_set::BitSet;
pub use build::BuildOptions;
pub(crate) use cells::Cell;
pub(crate) use crossings::CrossingLists;
pub use filter::Filter;
pub use goal::Occlusion;
pub use query::{Counts, Query, Scratch};
pub use refit::RefitError;
pub use wide::{Tree, TreeReport};

pub(crate) use build::{Bounds, Solid};
pub(crate) use fit::Fit;
pub(crate) use goal::{Any, Closest, Goal, Next};
pub(crate) use walk::{offer_crossings, sound};

/// Told what share of a build is done, from any thread, until it is 1; of what is told from several threads at once the
/// greatest holds. True ends the build.
pub type Stop<'a> = &'a (dyn Fn(f32) -> bool + Sync);

/// Which splits the builder may use.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum TreeKind {
    /// No tree: every ray against every primitive.
    None,
    /// Spatial splits only: the cells of a kd-tree, shrunk to their content.
    Kd,
    /// Object splits only: quick to build and refittable.
    Fast,
    /// Object and spatial splits compete; groups of spheres alone take object splits only.
    #[default]
    Best,
}

/// How rays are walked through the tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum WalkKind {
    /// The walk that suits the rays, as [`policy::choose`] says; the rays of a large batch are put in order before where
    /// that pays.
    #[default]
    Auto,
    /// Lists of up to 16 384 rays pushed through the tree together.
    Stream,
    /// One ray after the other.
    Single,
}
