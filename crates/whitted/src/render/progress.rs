//! Telling the caller how far the work is, and being told to stop.

use super::region::PixelRect;
use crate::math::Vec3f;
use std::sync::atomic::{AtomicBool, Ordering};

/// Receives the picture region by region, from any thread.
pub trait Progress: Sync {
    /// Phase 1 (all regions once) or 2 (flagged pixels) has finished `done` of `total` regions.
    fn regions_done(&self, phase: u32, done: usize, total: usize);

    /// The first samples of all pixels of `rect` have these linear colours, row by row. Comes before the count of the
    /// region to which they belong. Pixels around a rectangle that is rendered alone are not told.
    fn painted(&self, _rect: &PixelRect, _colors: &mut dyn Iterator<Item = Vec3f>) {}

    /// Supersampled pixels have these final linear colours.
    fn refined(&self, _pixels: &mut dyn Iterator<Item = ([u32; 2], Vec3f)>) {}
}

/// A sink that ignores everything.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Progress for Silent {
    fn regions_done(&self, _: u32, _: usize, _: usize) {}
}

/// The picture was not finished because its [`Cancel`] was set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the render was cancelled")]
pub struct Cancelled;

/// A flag that stops a render within one batch of rays per thread.
#[derive(Debug, Default)]
pub struct Cancel(AtomicBool);

impl Cancel {
    /// A flag that is not set.
    pub const fn new() -> Self {
        Self(AtomicBool::new(false))
    }

    /// Ask the render to stop.
    pub fn cancel(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// True once [`cancel`](Self::cancel) was called.
    pub fn is_cancelled(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}
