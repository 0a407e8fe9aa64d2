//! What nodes and leaves cost.

use super::super::leaf::BLOCK;
use super::{Bounds, BuildOptions};
use simd::Simd;

/// Expected cost of testing `count` primitives.
///
/// The mean of the exact number of blocks and the fraction: a leaf with one primitive costs less than a full one,
/// since it may yet be merged, but more than an eighth.
#[inline(always)]
pub(super) fn leaf(options: &BuildOptions, count: usize) -> f32 {
    options.intersection_cost * 0.5 * (count.div_ceil(BLOCK) as f32 + count as f32 / BLOCK as f32)
}

/// Expected cost of stepping into a wide node, in tests of a block.
///
/// Flat between 0.5 and 2 for the speed of rays (bunny, Sponza, dragon); 3 loses 5 to 10 % on fine meshes, and less than
/// 2 makes trees larger.
pub(super) const WIDE_NODE: f32 = 2.0;

/// Cost of testing a leaf of the finished tree, in tests of a block.
pub(super) fn blocks(count: usize) -> f32 {
    count.div_ceil(BLOCK) as f32
}

/// Expected cost of a node of half area `area` with two children, each a box and a number of references.
#[inline(always)]
pub(super) fn split<S: Simd>(token: S, options: &BuildOptions, area: f32, [left, right]: [(Bounds, usize); 2]) -> f32 {
    let left_side = left.0.half_area_lanes(token) * leaf(options, left.1);
    let right_side = right.0.half_area_lanes(token) * leaf(options, right.1);
    // In a box without area every ray that enters it enters both halves.
    let chance = if area > 0.0 { (left_side + right_side) / area } else { leaf(options, left.1 + right.1) };
    options.traversal_cost + chance
}
