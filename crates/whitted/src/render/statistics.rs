//! What a render did, counted.

use crate::tree::Counts;
use std::ops::AddAssign;

/// Counts of one render. Times and memory are the caller's to measure.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Statistics {
    /// Camera rays, supersampling included.
    pub camera_rays: u64,
    /// Shadow rays.
    pub shadow_rays: u64,
    /// Reflected rays.
    pub reflected_rays: u64,
    /// Refracted rays.
    pub refracted_rays: u64,
    /// Camera rays that hit something.
    pub camera_hits: u64,
    /// Primitives tested against a ray, unused places of leaf blocks included; exempt from the determinism of pictures.
    pub primitive_tests: u64,
    /// Nodes visited by a ray; exempt from the determinism of pictures.
    pub node_steps: u64,
    /// Pixels that were supersampled.
    pub supersampled_pixels: u64,
    /// Secondary rays not traced because of their weight.
    pub cut_by_weight: u64,
    /// Secondary rays not traced because of the depth limit.
    pub cut_by_depth: u64,
    /// Secondary rays not traced because their sample had no rays left.
    pub cut_by_budget: u64,
    /// Refracted rays inside more nested media than are kept.
    pub media_overflows: u64,
}

impl Statistics {
    /// All rays.
    pub fn rays(&self) -> u64 {
        self.camera_rays + self.shadow_rays + self.reflected_rays + self.refracted_rays
    }
}

impl AddAssign for Statistics {
    fn add_assign(&mut self, other: Self) {
        self.camera_rays += other.camera_rays;
        self.shadow_rays += other.shadow_rays;
        self.reflected_rays += other.reflected_rays;
        self.refracted_rays += other.refracted_rays;
        self.camera_hits += other.camera_hits;
        self.primitive_tests += other.primitive_tests;
        self.node_steps += other.node_steps;
        self.supersampled_pixels += other.supersampled_pixels;
        self.cut_by_weight += other.cut_by_weight;
        self.cut_by_depth += other.cut_by_depth;
        self.cut_by_budget += other.cut_by_budget;
        self.media_overflows += other.media_overflows;
    }
}

impl AddAssign<Counts> for Statistics {
    fn add_assign(&mut self, counts: Counts) {
        self.primitive_tests += counts.primitive_tests;
        self.node_steps += counts.node_steps;
    }
}
